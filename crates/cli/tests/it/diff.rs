//! `hadar diff`: two reports or answers held against each other.

use crate::support::folder::{Folder, Outcome, SCENARIO};
use serde_json::Value;

fn parsed(outcome: &Outcome) -> Value {
    serde_json::from_str(&outcome.stdout).unwrap_or_else(|error| panic!("{error}: {}", outcome.stderr))
}

#[test]
fn two_reports_differ_in_what_was_changed() {
    let folder = Folder::with(SCENARIO);
    folder.file("same.toml", &format!("# another file that asks the same\n{SCENARIO}"));
    for (name, more) in
        [("a", &["a.toml"][..]), ("b", &["same.toml"]), ("c", &["a.toml", "--set", "camera.exposure=3 ms"])]
    {
        let made = folder.run(&[&["identify", "--out", name, "-q"], more].concat());
        assert_eq!(made.code, 0, "{}", made.stderr);
    }
    let same = folder.run(&["diff", "a", "b"]);
    assert!(same.code == 0 && same.stdout.starts_with("Same: "), "{}{}", same.stdout, same.stderr);
    let other = folder.run(&["diff", "a", "c"]);
    assert!(
        other.code == 1 && other.stdout.contains("camera.exposure: 0.012 s -> 3 ms"),
        "{}{}",
        other.stdout,
        other.stderr
    );
    let json = parsed(&folder.run(&["diff", "a", "c", "--json"]));
    let figures = json["figures"].as_array().unwrap();
    let of = |part: &str| figures.iter().find(|one| one["figure"].as_str().unwrap().ends_with(part));
    // Noise of a bolometer that integrates less falls less than its signal; the distance per photon stays what it is.
    let d = of("].statistical_distance_camera").unwrap_or_else(|| panic!("{figures:?}"));
    assert!(d["relative_change"].as_f64().unwrap() < -0.1, "{d}");
    assert!(of("].distance_nearest_per_sqrt_photon").is_none(), "{figures:?}");
    assert_eq!((json["same"].as_bool(), json["question"].as_array().unwrap().len()), (Some(false), 1));
}

#[test]
fn two_answers_differ_in_figures_within_their_errors_and_beyond() {
    let folder = Folder::with(SCENARIO);
    let answer = folder.json(&["identify", "a.toml"]);
    let with = |change: &dyn Fn(&mut Value)| {
        let mut changed = answer.clone();
        change(&mut changed);
        changed.to_string()
    };
    folder.file("a.json", &answer.to_string());
    assert_eq!(folder.run(&["diff", "a.json", "a.json"]).code, 0);
    let nearest = answer["pairs"][0]["distance_nearest"].as_f64().unwrap();
    let share = answer["pairs"][0]["relative_error_nearest"].as_f64().unwrap();
    for (times, within) in [(1.0 + share, true), (1.0 + 4.0 * share, false)] {
        folder.file(
            "b.json",
            &with(&|answer| answer["pairs"][0]["distance_nearest"] = (nearest * times).into()),
        );
        let outcome = folder.run(&["diff", "a.json", "b.json", "--json"]);
        let found = parsed(&outcome);
        assert_eq!((outcome.code, found["figures"].as_array().unwrap().len()), (1, 1), "{found}");
        assert_eq!(found["figures"][0]["figure"], "pairs[aluminium].distance_nearest");
        assert_eq!(found["figures"][0]["within_error"], within, "{found}");
    }
    folder.file(
        "b.json",
        &with(&|answer| {
            answer["warnings"] = serde_json::json!([{ "code": "new", "message": "it is" }]);
            answer["identifiability"]["identifiable"] = true.into();
            answer["scenario"]["target"]["distance"] = "3 m".into();
        }),
    );
    let found = parsed(&folder.run(&["diff", "a.json", "b.json", "--json"]));
    assert_eq!(
        (&found["verdict_changed"], &found["warnings_came"][0]["code"]),
        (&true.into(), &"new".into())
    );
    assert_eq!(found["question"][0]["key"], "target.distance");
}

#[test]
fn what_cannot_be_compared_is_trouble() {
    let folder = Folder::with(SCENARIO);
    folder.file("a.json", "{}");
    assert_eq!(folder.run(&["identify", "a.toml", "--out", "out"]).code, 0);
    folder.json(&["init", "air"]);
    assert_eq!(folder.run(&["range", "air.toml", "--out", "air"]).code, 0);
    let print = |name: &str, arguments: &[&str]| {
        let outcome = folder.run(&[arguments, &["--json"]].concat());
        folder.file(name, &outcome.stdout);
    };
    print("size.json", &["size", "a.toml"]);
    print("check.json", &["size", "a.toml", "--check"]);
    print("air.json", &["range", "air.toml"]);
    // A check that fails is the whole answer in JSON.
    assert_eq!(folder.run(&["diff", "size.json", "check.json"]).code, 0);
    for (pair, said) in [
        (["a.json", "out"], "this is no answer"),
        (["out", "nowhere"], "there is no such file"),
        (["a.toml", "out"], "this is no JSON of an answer"),
        (["out", "."], "there is no report in this folder"),
        (["out", "air"], "answers to different questions"),
        (["size.json", "air.json"], "answers to different questions"),
    ] {
        let outcome = folder.run(&["diff", pair[0], pair[1]]);
        assert_eq!((outcome.code, outcome.stdout.as_str()), (2, ""), "{pair:?}");
        assert!(outcome.stderr.contains(said), "{pair:?}: {}", outcome.stderr);
    }
    let table = folder.path().join("out/pairs.csv");
    std::fs::write(&table, std::fs::read_to_string(&table).unwrap().replace("skin", "skim")).unwrap();
    let changed = folder.run(&["diff", "out", "out"]);
    assert!(
        changed.code == 2 && changed.stderr.contains("pairs.csv: the file was changed since"),
        "{}",
        changed.stderr
    );
}
