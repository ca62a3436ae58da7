//! Stand-ins that pass for people: what is known by hand, what other ways to the same distance say, and what no classifier exceeds.

use crate::support::folder::Folder;
use serde_json::Value;

const RULE: &str = r#"cameras = ["flir-a325sc"]
[target]
material = "skin"
temperature = "33 degC"
[[environment]]
temperature = "0 degC"
lighting = 0.5
[alternatives]
materials = ["aluminium"]
[bands]
ranges = [["8 um", "9 um"], ["9 um", "10 um"], ["10 um", "11 um"], ["11 um", "12 um"], ["12 um", "13 um"]]
[requirement]
detection_probability = 0.9
[envelope]
temperature = ["30 degC", "36 degC"]
lighting = [0.1, 0.8]
surroundings = ["0 degC", "15 degC"]
distance = ["5 m", "5 m"]
[stand_in]
materials = ["skin", "pmma", "aluminium"]
emissivity = [0.0, 0.02]
"#;

const DEMANDED: f64 = 1.281_551_565_544_600_5;

fn rows(folder: &Folder, file: &str) -> Vec<Value> {
    folder.json(&["rule", file, "--stand-in"])["rows"].as_array().unwrap().clone()
}

fn number(row: &Value, key: &str) -> f64 {
    row[key].as_f64().unwrap_or_else(|| panic!("{key}: {row}"))
}

/// At the edge the distance is that demanded, the proof reaches nearly there, and exactness can only be asked for more of.
#[test]
fn the_edge_of_a_tolerance_is_the_demand() {
    let folder = Folder::with(RULE);
    let found = rows(&folder, "a.toml");
    assert_eq!(found.len(), 6);
    for row in &found {
        if row["material"] == "aluminium" {
            // A robot of bare metal is no person, however warm.
            assert!(row["temperature_tolerance_k"].is_null() && number(row, "distance") > DEMANDED, "{row}");
            continue;
        }
        assert!((number(row, "distance") / DEMANDED - 1.0).abs() < 1e-6, "{row}");
        let (edge, proved) =
            (number(row, "temperature_tolerance_k"), number(row, "temperature_tolerance_proved_k"));
        assert!(proved < edge && proved > 0.98 * edge, "{row}");
    }
    for pair in found.chunks(2).take(2) {
        let [exact, loose] = [&pair[0], &pair[1]].map(|row| number(row, "temperature_tolerance_k"));
        assert!(loose < exact, "{pair:?}");
    }
    // Before people of more temperatures more passes, and a stricter demand of cameras is a looser one of stand-ins.
    folder.file("more.toml", &RULE.replace("\"30 degC\", \"36 degC\"", "\"28 degC\", \"38 degC\""));
    folder.file("surer.toml", &RULE.replace("0.9\n", "0.99\n"));
    for file in ["more.toml", "surer.toml"] {
        for (less, more) in found.iter().zip(rows(&folder, file)).take(4) {
            let [less, more] = [less, &more].map(|row| number(row, "temperature_tolerance_k"));
            assert!(less < more, "{file}: {less} {more}");
        }
    }
}

/// The farthest stand-in as a scenario of its own: `identify` finds the same distance, `simulate` no classifier above the limit.
#[test]
fn no_classifier_tells_the_farthest_from_a_person_more_often() {
    let folder = Folder::with(RULE);
    let found = rows(&folder, "a.toml");
    for row in
        found.iter().filter(|row| row["material"] == "pmma" && number(row, "emissivity_tolerance") == 0.0)
    {
        let there = &row["farthest"];
        let scenario = format!(
            "[target]\nmaterial = \"pmma\"\ntemperature = \"{:e} K\"\ndistance = \"5 m\"\n[[environment]]\ntemperature = \"{:e} K\"\n\
             lighting = {:e}\n[alternatives]\nmaterials = [\"skin\"]\ntemperature = [\"30 degC\", \"36 degC\"]\nlighting = [0.1, 0.8]\n[bands]\n\
             ranges = [[\"8 um\", \"9 um\"], [\"9 um\", \"10 um\"], [\"10 um\", \"11 um\"], [\"11 um\", \"12 um\"], [\"12 um\", \"13 um\"]]\n\
             [camera]\npreset = \"flir-a325sc\"\n",
            number(there, "temperature_k"),
            there["surroundings_k"][0].as_f64().unwrap(),
            there["lighting"][0].as_f64().unwrap()
        );
        folder.file("edge.toml", &scenario);
        let identified = folder.json(&["identify", "edge.toml"]);
        let distance = identified["pairs"][0]["statistical_distance"].as_f64().unwrap();
        assert!((distance / DEMANDED - 1.0).abs() < 1e-6, "{distance}");
        let outcome = folder.run(&["simulate", "edge.toml", "--check"]);
        assert_eq!(outcome.code, 0, "{}{}", outcome.stdout, outcome.stderr);
    }
}

/// No camera within its uncertain figures tells what passes: the tolerance is that of a camera with all of them on their good side. Errors
/// of emissivities are said to be left out, and no more is said than is known.
#[test]
fn what_passes_passes_before_the_best_of_the_camera() {
    let folder = Folder::with("");
    let with = |figures: &str| {
        let text = RULE
            .replace("cameras = [\"flir-a325sc\"]\n", "")
            .replace("\"skin\", \"pmma\", \"aluminium\"", "\"skin\"");
        folder.file(
            "b.toml",
            &format!("{text}[[camera]]\nname = \"ours\"\npreset = \"ideal-pnrd\"\n{figures}"),
        );
        number(&rows(&folder, "b.toml")[0], "temperature_tolerance_k")
    };
    let uncertain =
        with("f_number = { value = 1.3, u = 0.1 }\nexposure = { value = \"10 ms\", u = \"1 ms\" }\n");
    let [best, nominal] = ["1.1", "1.3"].map(|f_number| {
        let exposure = if f_number == "1.1" { 12 } else { 10 };
        with(&format!("f_number = {f_number}\nexposure = \"{exposure} ms\"\n"))
    });
    assert!((uncertain / best - 1.0).abs() < 1e-6 && best < nominal, "{uncertain} {best} {nominal}");
    let text = RULE.replace("\"skin\", \"pmma\", \"aluminium\"", "\"skin\"");
    folder.file("exact.toml", &text);
    folder.file("errors.toml", &(text + "[sensitivity]\nemissivity_error = 0.01\n"));
    let said = |file: &str| folder.run(&["rule", file, "--stand-in"]).stdout;
    assert!(said("exact.toml").starts_with("No camera distinguishes any of these 2 surrogate targets"));
    let errors = said("errors.toml");
    assert!(!errors.contains("No camera") && errors.contains("if spectra are exact"), "{errors}");
    assert!(errors.contains("[emissivity-errors-left-out]"), "{errors}");
    let warnings = folder.json(&["rule", "errors.toml", "--stand-in"])["warnings"].clone();
    assert_eq!(warnings[0]["code"], "emissivity-errors-left-out");
    assert_eq!(folder.json(&["rule", "exact.toml", "--stand-in"])["warnings"], serde_json::json!([]));
}

/// Of several clauses that tell people apart one is named, and each has tolerances of its own.
#[test]
fn the_clause_that_is_turned_round_is_named() {
    let folder = Folder::with("");
    let clauses = RULE.replace("[stand_in]", "[[clause]]\nname = \"warm\"\n[[clause]]\nname = \"surer\"\n[clause.requirement]\ndetection_probability = 0.99\n[stand_in]");
    folder.file("both.toml", &clauses);
    assert_eq!(
        folder.refusal(&["rule", "both.toml", "--stand-in"]).split_once(": ").unwrap().1,
        "stand_in: 2 clauses distinguish people: \"warm\", \"surer\"; write clause = \"warm\" in [stand_in], or another of them"
    );
    let named = |name: &str| clauses.replace("[stand_in]", &format!("[stand_in]\nclause = {name:?}"));
    for (name, probability) in [("warm", 0.9), ("surer", 0.99)] {
        folder.file("one.toml", &named(name));
        let found = folder.json(&["rule", "one.toml", "--stand-in"]);
        assert_eq!(found["clause"], name);
        assert!((number(&found, "detection_probability") / probability - 1.0).abs() < 1e-12);
        assert!(
            folder
                .run(&["rule", "one.toml", "--stand-in"])
                .stdout
                .contains(&format!("clause {name:?}: a surrogate target at"))
        );
    }
    folder.file("one.toml", &named("sure"));
    let message = folder.refusal(&["rule", "one.toml", "--stand-in"]);
    assert!(
        message.contains(
            "stand_in.clause: no clause `sure` distinguishes people; write one of \"warm\", \"surer\""
        ),
        "{message}"
    );
    folder.file("none.toml", &RULE.replace("[stand_in]", "[stand_in]\nclause = \"warm\""));
    assert!(
        folder
            .refusal(&["rule", "none.toml", "--stand-in"])
            .contains("stand_in.clause: the rule has no [[clause]]")
    );
}

#[test]
fn mistakes_in_stand_ins() {
    let folder = Folder::with("");
    for (text, message) in [
        (
            RULE.replace("[0.0, 0.02]", "[0.0, 1.0]"),
            "stand_in.emissivity[1]: emissivity is 1; it must be from 0 to below 1",
        ),
        (RULE.replace("[0.0, 0.02]", "[]"), "a list of 0 tolerances"),
        (RULE.replace("\"pmma\", ", "\"pmna\", "), "`pmna`"),
        (
            RULE.replace("emissivity =", "temperature = \"33\"\nemissivity ="),
            "stand_in.temperature: `33` is a number without a unit",
        ),
        (RULE.replace("[stand_in]", "[standin]"), "there is no key `standin`"),
    ] {
        folder.file("b.toml", &text);
        let outcome = folder.run(&["rule", "b.toml", "--stand-in"]);
        assert_eq!(outcome.code, 1, "{}", outcome.stdout);
        assert!(
            outcome.stderr.contains(message) && outcome.stderr.lines().count() == 1,
            "{}",
            outcome.stderr
        );
    }
}

/// Where the temperature is known, a stand-in that is no person's is told; people are lit as the envelope says, and what is known of them
/// beforehand is refused; from between two distances a camera may count more than from either.
#[test]
fn people_are_as_the_rule_says_they_are() {
    let folder = Folder::with(RULE);
    let free = number(&rows(&folder, "a.toml")[0], "temperature_tolerance_k");
    for known in ["[]", "[\"lighting\"]"] {
        folder.file("known.toml", &format!("{RULE}[unknown]\nnuisances = {known}\n"));
        let tolerance = number(&rows(&folder, "known.toml")[0], "temperature_tolerance_k");
        assert!(tolerance <= 3.0 + 1e-9, "{known}: {tolerance}");
        folder
            .file("hot.toml", &format!("{RULE}temperature = \"37 degC\"\n[unknown]\nnuisances = {known}\n"));
        assert!(rows(&folder, "hot.toml")[0]["temperature_tolerance_k"].is_null(), "{known}");
    }
    for row in rows(&folder, "a.toml") {
        let lighting = row["farthest"]["person_lighting"][0].as_f64().unwrap();
        assert!((0.1 - 1e-9..=0.8 + 1e-9).contains(&lighting), "{row}");
        let kelvin = number(&row["farthest"], "person_temperature_k");
        assert!((303.15 - 1e-6..=309.15 + 1e-6).contains(&kelvin), "{row}");
    }
    folder.file("prior.toml", &format!("{RULE}[unknown]\npriors = {{ lighting = 0.01 }}\n"));
    let outcome = folder.run(&["rule", "prior.toml", "--stand-in"]);
    assert!(outcome.code == 1 && outcome.stderr.contains("unknown.priors"), "{}", outcome.stderr);
    let far = RULE.replace("[\"5 m\", \"5 m\"]", "[\"0.2 m\", \"1 km\"]");
    let small = far.replace("33 degC\"\n", "33 degC\"\nsize = \"1 cm\"\n")
        + "[background]\ntemperature = \"10 degC\"\n";
    folder.file("small.toml", &small);
    let found = rows(&folder, "small.toml");
    assert!(found.iter().all(|row| row["temperature_tolerance_proved_k"].is_null()), "{found:?}");
    assert!(free > 3.0);
}

/// Of a stand-in whose spectrum is off by errors the tolerance is one that 95 % of such spectra have: of sixty drawn here, by another walk along the
/// wavenumber and as files, no more than six may be below.
#[test]
fn nearly_all_spectra_of_a_shape_have_its_tolerance() {
    let folder = Folder::with("");
    let text = RULE.replace(
        "[\"skin\", \"pmma\", \"aluminium\"]\nemissivity = [0.0, 0.02]",
        "[\"grey.csv\"]\nemissivity = [0.0]",
    );
    let spectrum = |values: &dyn Fn(f64) -> f64| {
        let rows = (0..=600).map(|step| {
            let cm1 = 700.0 + f64::from(step);
            format!("{cm1},{}\n", values(cm1))
        });
        "wavenumber_cm1,emissivity\n".to_owned() + &rows.collect::<String>()
    };
    let level = |cm1: f64| 0.97 - 0.01 * ((cm1 - 1000.0) / 300.0);
    folder.file("grey.csv", &spectrum(&level));
    let edge = |name: &str, more: &str| {
        folder.file(name, &(text.clone() + more));
        number(&rows(&folder, name)[0], "temperature_tolerance_k")
    };
    let exact = edge("exact.toml", "");
    let [fine, rough] = ["0.0005", "0.003"].map(|error| {
        edge("shape.toml", &format!("emissivity_error = {error}\ncorrelation = \"20 cm^-1\"\n"))
    });
    assert!(rough < fine && fine < exact && fine > 0.9 * exact, "{rough} {fine} {exact}");

    // Sums of 64 waves of random phase, whose wavenumbers are Cauchy's, have the correlation exp(-|Δν|/ℓ).
    let mut state = 7_u64;
    let mut uniform = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((state >> 11) as f64 + 0.5) / (1u64 << 53) as f64
    };
    let mut names = Vec::new();
    for index in 0..60 {
        let waves: Vec<[f64; 3]> = (0..64)
            .map(|_| {
                let gauss = (-2.0 * uniform().ln()).sqrt();
                [
                    gauss,
                    (std::f64::consts::PI * (uniform() - 0.5)).tan() / 20.0,
                    std::f64::consts::TAU * uniform(),
                ]
            })
            .collect();
        let error = |cm1: f64| {
            let sum: f64 = waves.iter().map(|[a, k, phase]| a * (k * cm1 + phase).cos()).sum();
            0.003 * sum / 64f64.sqrt()
        };
        let name = format!("drawn{index}.csv");
        folder.file(&name, &spectrum(&|cm1| (level(cm1) + error(cm1)).clamp(0.0, 1.0)));
        names.push(format!("\"{name}\""));
    }
    folder.file("drawn.toml", &text.replace("\"grey.csv\"", &names.join(", ")));
    let below = rows(&folder, "drawn.toml")
        .iter()
        .filter(|row| row["temperature_tolerance_k"].as_f64().is_none_or(|own| own < rough))
        .count();
    assert!(below <= 6, "{below} of 60 below {rough}");
    folder.file("bad.toml", &(text + "correlation = \"20 cm^-1\"\n"));
    assert!(folder.refusal(&["rule", "bad.toml", "--stand-in"]).contains("stand_in.emissivity_error"));
}
