//! Rules beside each other, and what their clauses share.

use crate::support::answers::same;
use crate::support::folder::Folder;
use crate::support::rules::{NIGHT, close};
use serde_json::Value;

/// Three clauses, of which the last two differ from the first by speed and by materials.
fn three() -> String {
    let clause = |name: &str, more: &str| format!("[[clause]]\nname = \"{name}\"\n{more}\n");
    let fast = "[clause.stop]\nspeed = \"61 km/h\"\nlatency = \"0.5 s\"\ndeceleration = \"5 m/s^2\"\nstart = \"4.0 s\"";
    let same = fast.replace("61", "60");
    NIGHT.to_owned()
        + &clause("own", "")
        + &clause("same", &same)
        + &clause("faster", fast)
        + &clause("other", "[clause.alternatives]\nmaterials = [\"pmma\"]")
}

fn without_stats(mut answer: Value) -> Value {
    answer.as_object_mut().unwrap().remove("stats");
    answer
}

/// What clauses share is what each finds alone.
#[test]
fn what_clauses_share_changes_no_figure() {
    let folder = Folder::with("");
    folder.file("a.toml", &three());
    let shared = folder.json(&["rule", "a.toml", "-q"]);
    let each = folder.json(&["rule", "a.toml", "-q", "--no-skip"]);
    assert!(shared["stats"]["worst_cases"]["spared"]["shared"] == 1, "{}", shared["stats"]);
    same(&without_stats(shared.clone()), &without_stats(each), "");
    let alone = |name: &str| {
        let text = three();
        let (head, clauses) = text.split_once("[[clause]]\n").unwrap();
        let own = clauses.split("[[clause]]\n").find(|one| one.contains(name)).unwrap();
        let file = format!("{name}.toml");
        folder.file(&file, &format!("{head}[[clause]]\n{own}"));
        folder.json(&["rule", &file, "-q"])["clauses"][0].clone()
    };
    for (index, name) in ["own", "same", "faster", "other"].into_iter().enumerate() {
        let (together, alone) = (&shared["clauses"][index], alone(name));
        assert_eq!(together["cameras"][0]["margin"], alone["cameras"][0]["margin"], "{name}");
        let fraction = |clause: &Value| clause["not_identifiable"]["fraction"].as_f64().unwrap();
        assert!(close(fraction(together), fraction(&alone), 1e-12), "{name}");
    }
}

/// Every cell says what the rule alone says of the camera; none says 'yes' of a rule that is not in force or of a condition.
#[test]
fn rules_side_by_side_say_what_each_says_alone() {
    let folder = Folder::with("");
    let about = "[rule]\nname = \"R\"\nfrom = 2030-01-01\n[target]";
    let ideal = NIGHT.replace("[\"flir-a325sc\"]", "[\"flir-a325sc\", \"ideal-pnrd\"]");
    folder.file("a.toml", &ideal.replace("60 km/h", "6 km/h"));
    folder.file("b.toml", &ideal.replace("[target]", about).replace("60 km/h", "6 km/h"));
    folder.file("c.toml", &NIGHT.replace("\"aluminium\"", "\"pmma\""));
    let asked = ["rule", "a.toml", "b.toml", "c.toml", "--on", "2026-11-29", "--out", "out"];
    let both = folder.run(&asked);
    assert_eq!(both.code, 0, "{}", both.stderr);
    assert!(both.stdout.starts_with("None of 2 cameras meets all 3 rules."), "{}", both.stdout);
    let table = std::fs::read_to_string(folder.path().join("out/laws.csv")).unwrap();
    let rows: Vec<Vec<&str>> = table.lines().skip(1).map(|line| line.splitn(8, ',').collect()).collect();
    assert_eq!(rows.len(), 5, "{table}");
    for row in rows {
        let alone = folder.json(&["rule", row[0], "--on", "2026-11-29", "-q"]);
        let cameras = alone["cameras"].as_array().unwrap();
        let own = cameras.iter().find(|camera| camera["name"] == row[1]).unwrap();
        let open = own["conditions"].as_array().unwrap().iter().any(|one| one["favourable"] == true);
        let expected = match (row[0], own["verdict"].as_str().unwrap(), open) {
            ("b.toml", "meets", true) => "as if in force: yes, if",
            ("b.toml", "meets", false) => "as if in force: yes",
            (_, "meets", true) => "yes, if",
            (_, "meets", false) => "yes",
            (_, "undecided", _) => "undecided",
            _ => "no",
        };
        assert_eq!(row[2], expected, "{row:?}");
        assert!(close(row[3].parse().unwrap(), own["margin"].as_f64().unwrap(), 1e-12), "{row:?}");
        assert_eq!(row[4], own["grade"].as_str().unwrap());
    }
    // One camera before all, and what has no answer.
    let judged = folder.run(&["rule", "a.toml", "c.toml", "--judge", "ideal-pnrd"]);
    assert!(
        judged.stdout.contains(" of 1 cameras") || judged.stdout.contains("alone of"),
        "{}",
        judged.stdout
    );
    assert!(!judged.stdout.contains("flir-a325sc"), "{}", judged.stdout);
    assert!(folder.refusal(&["rule", "a.toml", "--judge", "flir-a325"]).contains("--judge cameras[0]: "));
    assert!(
        folder
            .refusal(&["rule", "a.toml", "--judge", "ideal-pnrd", "--set", "cameras=[\"flir-a325sc\"]"])
            .contains("--judge")
    );
    // One name, two cameras: neither meets both.
    let own = |figure: &str| {
        NIGHT.replace("cameras = [\"flir-a325sc\"]\n", "").replace("60 km/h", "6 km/h")
            + &format!("[[camera]]\nname = \"B\"\npreset = \"ideal-pnrd\"\n{figure}\n")
    };
    folder.file("d.toml", &own(""));
    folder.file("e.toml", &own("flicker_fraction = 0.4"));
    let twice = folder.run(&["rule", "d.toml", "e.toml"]);
    assert!(twice.stdout.starts_with("None of 2 cameras meets all 2 rules."), "{}", twice.stdout);
    assert!(
        twice.stdout.contains("B (of d.toml)") && twice.stdout.contains("B (of e.toml)"),
        "{}",
        twice.stdout
    );
    let missing = folder.run(&["rule", "a.toml", "c.toml", "none.toml"]);
    assert_eq!(missing.code, 1);
    assert!(missing.stdout.contains("2 of 3 rules that have an answer"), "{}", missing.stdout);
}

/// A thing of what people are made of is taken for one, whatever else people are made of; a target that is left out of its alternatives is a condition.
#[test]
fn the_same_material_is_never_told_in_silence() {
    let things = NIGHT.replace(
        "[stop]",
        "[[clause]]\nname = \"things\"\nkind = \"false-alarm\"\nthings = [\"fabric\"]\n[clause.envelope]\nmaterials_\n\
         temperature = [\"30 degC\", \"35 degC\"]\n[clause.requirement]\ndetection_probability = 0.9\nfalse_alarm_probability = 0.1\n[clause.stop]",
    );
    let things = things
        .replace("materials_\n", "")
        .replace("[envelope]\n", "[envelope]\nmaterials = [\"skin\", \"fabric\"]\n");
    let folder = Folder::with("");
    for nuisances in ["[]", "[\"temperature\", \"lighting\"]"] {
        folder.file(
            "a.toml",
            &things.replace("[envelope]\nm", &format!("[unknown]\nnuisances = {nuisances}\n[envelope]\nm")),
        );
        let camera = folder.json(&["rule", "a.toml", "-q"])["clauses"][0]["cameras"][0].clone();
        assert_eq!(
            (&camera["verdict"], camera["margin"].as_f64()),
            (&"fails".into(), Some(0.0)),
            "{nuisances}"
        );
    }
    let with =
        NIGHT.replace("[\"aluminium\"]", "[\"skin\", \"aluminium\"]").replace("flir-a325sc", "ideal-pnrd");
    folder.file("b.toml", &with.replace("60 km/h", "6 km/h"));
    let camera = folder.json(&["rule", "b.toml", "-q"])["cameras"][0].clone();
    let codes = camera["conditions"].as_array().unwrap().iter().map(|one| one["code"].as_str().unwrap());
    assert!(
        camera["verdict"] != "meets" || codes.clone().any(|code| code == "materials-left-out"),
        "{camera}"
    );
}

/// A black target of 300.5 K before black walls of at most 299.5 K, seen with 50 mK of noise: a kelvin is ten times two deviations apart.
#[test]
fn contrast_is_the_kelvins_over_twice_the_noise() {
    let text = |warmest: &str, more: &str| {
        format!(
            "[target]\nmaterial = \"black.csv\"\ntemperature = \"300.5 K\"\n[[environment]]\ntemperature = \"290 K\"\nlighting = 1.0\n\
             [bands]\nranges = [[\"8 um\", \"12 um\"]]\n[[clause]]\nname = \"there\"\nkind = \"contrast\"\nbehind = [\"black.csv\"]\n{more}\
             [clause.alternatives]\ntemperature = [\"280 K\", \"{warmest}\"]\n[[camera]]\nname = \"c\"\nspectral_range = [\"8 um\", \"12 um\"]\n\
             pixel = \"12 um\"\nf_number = 1.0\nfocal_length = \"18 mm\"\nnetd = \"50 mK\"\nnetd_temperature = \"300 K\"\nnetd_f_number = 1.0\n\
             exposure = \"16 ms\"\n"
        )
    };
    let black = "wavenumber_cm1,emissivity\n600,1\n1500,1\n";
    let folder = Folder::with("");
    folder.file("black.csv", black);
    let distance = |warmest: &str| {
        folder.file("a.toml", &text(warmest, ""));
        let answer = folder.json(&["rule", "a.toml", "-q"]);
        answer["clauses"][0]["cameras"][0]["statistical_distance"]
            .as_f64()
            .unwrap_or_else(|| panic!("{answer}"))
    };
    assert!(close(distance("299.5 K"), 10.0, 0.01), "{}", distance("299.5 K"));
    assert!(close(distance("297.5 K"), 30.0, 0.02));
    // A wall as warm as the target hides it.
    assert_eq!(distance("301 K"), 0.0);
    folder.file(
        "a.toml",
        &text("299.5 K", "").replace("[clause.alternatives]\ntemperature = [\"280 K\", \"299.5 K\"]\n", ""),
    );
    assert!(
        folder
            .refusal(&["rule", "a.toml"])
            .contains("the temperature of what is behind the target is not stated")
    );
    // What is behind may be of the target's own material, in company too, and is then no warmer than its range.
    folder.file("white.csv", "wavenumber_cm1,emissivity\n600,0.5\n1500,0.5\n");
    let both = text("299.5 K", "").replace("behind = [", "behind = [\"white.csv\", ");
    folder.file("a.toml", &both.replace("299.5 K", "301 K"));
    assert_eq!(folder.json(&["rule", "a.toml", "-q"])["clauses"][0]["cameras"][0]["verdict"], "fails");
    folder.file("a.toml", &both.replace("[[clause]]", "[unknown]\nnuisances = [\"lighting\"]\n[[clause]]"));
    assert!(folder.refusal(&["rule", "a.toml"]).contains("taken as known, and is not"));
    folder.file("a.toml", &both.replace("[[clause]]", "[unknown.priors]\ntemperature = \"1 K\"\n[[clause]]"));
    assert!(folder.refusal(&["rule", "a.toml"]).contains("unknown.priors.temperature: a prior says"));
    folder.file("a.toml", &text("299.5 K", "").replace("behind = [\"black.csv\"]\n", ""));
    assert!(folder.refusal(&["rule", "a.toml"]).contains("behind"));
    // What is said of it is said by its own key.
    let unknown = text("299.5 K", "").replace("behind = [\"black.csv\"]", "behind = [\"concreet\"]");
    folder.file("a.toml", &unknown);
    assert!(folder.refusal(&["rule", "a.toml"]).starts_with("a.toml:12: behind[0]: there is no material"));
}
