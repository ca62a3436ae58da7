//! `[[category]] safety = true` in a task and in a rule: where a person cannot be excluded, and that it costs a verdict nothing.

use crate::support::folder::Folder;
use serde_json::Value;

/// A camera with so many electrons of noise, before a robot that may be a person.
fn task(exposure: &str, category: &str) -> String {
    format!(
        "[target]\nmaterial = \"aluminium\"\ntemperature = \"30 degC\"\ndistance = \"10 m\"\n\
         [[environment]]\ntemperature = \"20 degC\"\nlighting = 0.5\n\
         [alternatives]\nmaterials = [\"skin\", \"brick-red\"]\n\
         [bands]\nstart = \"715 cm^-1\"\nstop = \"1250 cm^-1\"\nstep = \"50 cm^-1\"\n\
         [camera]\nexposure = \"{exposure}\"\npixel = \"64 um\"\nf_number = 1.4\nfocal_length = \"14 mm\"\n\
         noise_electrons = 3000\nnoise_exposure = \"2 ms\"\nreadout = \"simultaneous\"\n{category}"
    )
}

const PERSON: &str = "[[category]]\nname = \"person\"\nmaterials = [\"skin\"]\nsafety = true\n";

fn without_safety(mut answer: Value) -> Value {
    for key in ["safety", "scenario", "stats"] {
        answer.as_object_mut().unwrap().remove(key);
    }
    answer
}

/// The probability that skin is left is Φ(2.326 − 2d), by an error function of 9 digits that is not the program's.
#[test]
fn a_person_is_excluded_only_where_that_is_proved() {
    let phi = |x: f64| {
        // ½ + (1/√2π) ∫ e^(−t²/2) dt by Simpson.
        let steps = 4000;
        let f = |i: usize| (-(x * i as f64 / steps as f64).powi(2) / 2.0).exp();
        let sum: f64 = (0..=steps)
            .map(|i| {
                f(i) * if i == 0 || i == steps {
                    1.0
                } else if i % 2 == 1 {
                    4.0
                } else {
                    2.0
                }
            })
            .sum();
        0.5 + sum * x / steps as f64 / 3.0 / std::f64::consts::TAU.sqrt()
    };
    let mut said = Vec::new();
    for exposure in ["0.1 us", "20 us", "20 ms"] {
        let folder = Folder::with(&task(exposure, PERSON));
        let answer = folder.json(&["identify", "a.toml"]);
        let text = folder.run(&["identify", "a.toml"]).stdout;
        let found = &answer["safety"][0];
        let pair =
            answer["pairs"].as_array().unwrap().iter().find(|pair| pair["alternative"] == "skin").unwrap();
        let [lower, upper] = [0, 1].map(|i| pair["statistical_distance_bounds"][i].as_f64().unwrap());
        let left = found["materials"][0]["probability_left_at_least"].as_f64().unwrap();
        assert!((left - phi(2.326_347_874 - 2.0 * upper)).abs() < 1e-6, "{left} at {upper}");
        assert_eq!(found["excluded"], lower >= 2.326_347_874 && pair["told"] == "yes", "{found:#}");
        let sentence =
            if found["excluded"] == true { "A person is excluded" } else { "A person cannot be excluded" };
        assert!(text.contains(sentence), "{text}");
        // Skin is one number in the library: an exclusion says that it rests on it.
        assert_eq!(found["constants"], serde_json::json!(["skin"]));
        assert_eq!(
            text.contains("if real surfaces are as the one number of skin."),
            found["excluded"] == true,
            "{text}"
        );
        said.push(found["excluded"] == true);
        // Without the key nothing else changes, and nothing is said to be excluded.
        let bare = Folder::with(&task(exposure, "")).json(&["identify", "a.toml"]);
        assert!(bare.get("safety").is_none());
        assert_eq!(without_safety(bare), without_safety(answer));
    }
    assert!(!said[0] && said[2], "{said:?}");
}

#[test]
fn what_was_not_compared_or_not_seen_excludes_nothing() {
    let more = PERSON.replace("[\"skin\"]", "[\"skin\", \"fabric\"]");
    let folder = Folder::with(&task("20 ms", &more));
    let found = folder.json(&["identify", "a.toml"])["safety"][0].clone();
    assert_eq!((&found["excluded"], &found["materials"][1]["compared"]), (&false.into(), &false.into()));
    assert!(folder.run(&["identify", "a.toml"]).stdout.contains("fabric is not among the alternatives"));
    let own = PERSON.replace("\"skin\"", "\"aluminium\"");
    let found = Folder::with(&task("20 ms", &own)).json(&["identify", "a.toml"])["safety"][0].clone();
    assert_eq!((&found["excluded"], &found["is_target"]), (&false.into(), &true.into()));
    let text = task("20 ms", PERSON);
    let (head, tail) = text.split_once("[camera]").unwrap();
    let blind = format!("{head}{}", &tail[tail.find("[[category]]").unwrap()..]);
    assert_eq!(Folder::with(&blind).json(&["identify", "a.toml"])["safety"][0]["excluded"], false);
}

/// A rule says it of every camera; its verdicts are the same without the key.
#[test]
fn a_rule_says_where_a_person_cannot_be_excluded() {
    let rule = |category: &str| {
        task("20 ms", category).replace("[camera]", "[[camera]]\nname = \"core\"")
            + "[requirement]\ndetection_probability = 0.9\n[envelope]\ntemperature = [\"25 degC\", \"35 degC\"]\n"
    };
    let folder = Folder::with(&rule(PERSON));
    let answer = folder.json(&["rule", "a.toml"]);
    let safety = &answer["safety"][0];
    // Skin is compared with the target, and not with brick on its own side.
    assert_eq!((&safety["excluded"], &safety["category"]), (&false.into(), &"person".into()), "{safety}");
    assert_eq!(safety["not_compared_with"], serde_json::json!(["brick-red"]));
    assert!(folder.run(&["rule", "a.toml"]).stdout.contains("it is not compared with brick-red"));
    let bare = Folder::with(&rule("")).json(&["rule", "a.toml"]);
    assert!(!bare.to_string().contains("\"safety\":["));
    assert_eq!(bare["sentence"], answer["sentence"]);
    let unknown = Folder::with(&rule(&PERSON.replace("\"skin\"", "\"skin\", \"fabric\"")));
    assert!(
        unknown
            .run(&["rule", "a.toml"])
            .stdout
            .contains("cannot be excluded by core: fabric is not compared")
    );
}

/// An error that says what it is of is read as that or refused; a bare number keeps the sense of its table.
#[test]
fn an_error_of_an_emissivity_says_what_it_is_of() {
    let with = |value: &str| {
        Folder::with(&(task("20 ms", "") + &format!("[sensitivity]\nemissivity_error = {value}\n")))
    };
    let read = |value: &str| {
        with(value).json(&["identify", "a.toml"])["scenario"]["sensitivity"]["emissivity_error"].clone()
    };
    assert_eq!(read("\"0.004 absolute\""), read("0.004"));
    for (value, said) in [
        ("\"1 %\"", "is a share of the emissivity"),
        ("\"0.01 relative\"", "\"0.01 absolute\""),
        ("\"0.01\"", "does not say what it is of"),
        ("\"2 absolute\"", "out of range"),
    ] {
        let refused = with(value).refusal(&["identify", "a.toml"]);
        assert!(refused.contains(said) && refused.contains("sensitivity.emissivity_error"), "{refused}");
    }
}

/// Every row of the matrix is what a task of its own with that target says, and no row is excluded on less.
#[test]
fn a_matrix_says_it_of_every_material() {
    for exposure in ["0.1 us", "20 ms"] {
        let more =
            PERSON.to_owned() + "[[category]]\nname = \"oven\"\nmaterials = [\"fabric\"]\nsafety = true\n";
        let text = task(exposure, &more);
        let folder = Folder::with(&text);
        let answer = folder.json(&["identify", "a.toml", "--matrix"]);
        let rows = answer["matrix"]["safety"].as_array().unwrap();
        assert_eq!(rows.len(), 6);
        let names: Vec<&str> = answer["matrix"]["materials"]
            .as_array()
            .unwrap()
            .iter()
            .map(|name| name.as_str().unwrap())
            .collect();
        for target in &names {
            let others: Vec<String> =
                names.iter().filter(|name| *name != target).map(|name| format!("\"{name}\"")).collect();
            let own = text
                .replace("material = \"aluminium\"", &format!("material = \"{target}\""))
                .replace("[\"skin\", \"brick-red\"]", &format!("[{}]", others.join(", ")));
            let alone = Folder::with(&own).json(&["identify", "a.toml"])["safety"].clone();
            let of_matrix: Vec<&Value> = rows.iter().filter(|row| row["target"] == *target).collect();
            assert_eq!(serde_json::json!(of_matrix), alone, "{target}");
        }
        let person: Vec<&Value> = rows.iter().filter(|row| row["category"] == "person").collect();
        assert!(person.iter().any(|row| row["is_target"] == true && row["excluded"] == false));
        let excluded = person.iter().filter(|row| row["excluded"] == true).count();
        let of_target = person.iter().find(|row| row["target"] == "aluminium").unwrap();
        assert_eq!(of_target["excluded"], exposure == "20 ms", "{person:#?}");
        // Fabric is in no row.
        assert!(rows.iter().all(|row| row["category"] == "person" || row["excluded"] == false));
        let said = folder.run(&["identify", "a.toml", "--matrix", "--out", "out"]).stdout;
        let left = 3 - excluded;
        let start = match left {
            3 => "A person cannot be excluded where any of the 3 materials is, at 99 %".to_owned(),
            left => format!("A person cannot be excluded where {left} of the 3 materials are, at 99 %"),
        };
        assert!(
            said.contains(&start) && said.contains("  A person cannot be excluded: skin is of it."),
            "{said}"
        );
        assert!(said.contains("An oven cannot be excluded where any of the 3 materials is"), "{said}");
        let table = std::fs::read_to_string(folder.path().join("out/matrix_safety.csv")).unwrap();
        assert_eq!(table.lines().count(), 7, "{table}");
        assert!(table.contains("person,skin,yes,no,skin,no,no,"), "{table}");
        // Only a distance that is proved excludes.
        let local = folder.json(&["identify", "a.toml", "--matrix", "--by", "local"]);
        let rows = local["matrix"]["safety"].as_array().unwrap();
        assert!(rows.iter().all(|row| row["excluded"] == false));
    }
}

/// Of a class with a member that is of the category, the category is there.
#[test]
fn a_class_that_may_be_a_person_excludes_none() {
    let class = "[class.surface]\nmaterials = [\"aluminium\", \"skin\"]\n";
    let text = task("20 ms", PERSON)
        .replace("material = \"aluminium\"", "material = \"surface\"")
        .replace("[\"skin\", \"brick-red\"]", "[\"brick-red\", \"fabric\"]");
    let folder = Folder::with(&(text + class));
    let found = folder.json(&["identify", "a.toml"])["safety"][0].clone();
    assert_eq!((&found["is_target"], &found["excluded"]), (&true.into(), &false.into()), "{found:#}");
    assert_eq!(found["target"], "surface");
    // As one of the matrix the member is it by the name of its material.
    let found = folder.json(&["identify", "a.toml", "--matrix"])["matrix"]["safety"].clone();
    let of =
        |target: &str| found.as_array().unwrap().iter().find(|row| row["target"] == target).unwrap().clone();
    assert_eq!(of("surface/skin")["is_target"], true);
    assert_eq!(of("brick-red")["materials"][0]["compared"], true);
}

/// What other commands say of a target is what `identify` says; where it means nothing the key is refused with its line.
#[test]
fn other_commands_say_the_same_or_refuse() {
    for exposure in ["20 us", "20 ms"] {
        let folder = Folder::with(&task(exposure, PERSON));
        let said = folder.json(&["identify", "a.toml"])["safety"].clone();
        let text = folder.run(&["identify", "a.toml"]).stdout;
        let sentence = text.lines().find(|line| line.starts_with("A person ")).unwrap();
        let few = ["--classifiers", "likelihood-ratio", "--spectra", "400"];
        for (command, flags) in [("size", &[][..]), ("simulate", &few[..])] {
            let asked = [&[command, "a.toml"][..], flags].concat();
            assert_eq!(folder.json(&asked)["safety"], said, "{command}");
            let text = folder.run(&[&asked[..], &["--out", command]].concat()).stdout;
            assert!(text.contains(sentence), "{text}");
            let table = std::fs::read_to_string(folder.path().join(command).join("safety.csv")).unwrap();
            assert!(table.lines().count() == 2 && table.contains("person,aluminium,no,"), "{table}");
        }
        let line = task(exposure, PERSON).lines().position(|line| line.starts_with("safety")).unwrap() + 1;
        let refused = folder.refusal(&["simulate", "a.toml", "--thermometry", "30 degC"]);
        assert!(refused.contains(&format!("a.toml:{line}: category[0].safety: thermometry")), "{refused}");
    }
    let bare = Folder::with(&task("20 ms", ""));
    assert!(bare.json(&["size", "a.toml"]).get("safety").is_none());
}

/// The certificate of a rule has the sentence of its text.
#[test]
fn a_certificate_says_where_a_person_cannot_be_excluded() {
    for exposure in ["20 us", "200 ms"] {
        let text = task(exposure, PERSON).replace("[camera]", "[[camera]]\nname = \"core\"")
            + "[requirement]\ndetection_probability = 0.9\n[envelope]\ntemperature = [\"25 degC\", \"35 degC\"]\n";
        let folder = Folder::with(&text);
        let said = folder.run(&["rule", "a.toml", "--out", "out"]).stdout;
        let sentence = said.lines().find(|line| line.starts_with("A person ")).unwrap();
        let page = std::fs::read_to_string(folder.path().join("out/certificate.md")).unwrap();
        assert!(page.contains(&format!("\n- {sentence}\n")), "{page}");
    }
}
