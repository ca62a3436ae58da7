//! `--cameras`: cameras of one's own beside those of the program.

use crate::support::folder::{Folder, SCENARIO};
use crate::support::rules::rule;
use serde_json::Value;

const MINE: &str = r#"[[camera]]
name = "ours"
description = "our bolometer"
preset = "flir-a325sc"
exposure = "5 ms"

[[camera]]
name = "bare"
pixel = "12 um"
"#;

#[test]
fn a_camera_of_ones_own_is_as_if_the_scenario_said_it() {
    let folder = Folder::with(&SCENARIO.replace("\"flir-a325sc\"", "\"ours\""));
    folder.file("my.toml", MINE);
    folder.file("b.toml", &format!("{SCENARIO}exposure = \"5 ms\"\n"));
    let own = folder.json(&["identify", "a.toml", "--cameras", "my.toml"]);
    let said = folder.json(&["identify", "b.toml"]);
    assert_eq!(own["pairs"], said["pairs"]);
    assert!(folder.refusal(&["identify", "a.toml"]).contains("there is no camera `ours`"));
    folder.file("rule.toml", &rule("ours"));
    let rule = folder.json(&["rule", "rule.toml", "--cameras", "my.toml"]);
    assert_eq!(rule["cameras"][0]["name"], "ours");

    // The report names the file by its content.
    assert_eq!(folder.run(&["identify", "a.toml", "--cameras", "my.toml", "--out", "out"]).code, 0);
    let manifest: Value =
        serde_json::from_str(&std::fs::read_to_string(folder.path().join("out/hadar.json")).unwrap())
            .unwrap();
    assert_eq!(
        (&manifest["inputs"][0]["path"], &manifest["inputs"][1]["path"]),
        (&"a.toml".into(), &"my.toml".into())
    );
}

#[test]
fn it_is_listed_with_its_file_and_asked_for_what_it_lacks() {
    let folder = Folder::with(&SCENARIO.replace("\"flir-a325sc\"", "\"bare\""));
    folder.file("my.toml", MINE);
    let list = folder.run(&["cameras", "list", "--cameras", "my.toml"]).stdout;
    let own = list.split_once("Of your own\n").expect("a heading").1;
    assert!(own.contains("ours ") && own.contains("(my.toml)"), "{list}");
    assert!(!folder.run(&["cameras", "list"]).stdout.contains("Of your own"));
    let json = folder.json(&["cameras", "list", "--cameras", "my.toml"]);
    let all = json["cameras"].as_array().unwrap();
    assert_eq!((&all[all.len() - 1]["file"], all[0].get("file")), (&"my.toml".into(), None));
    let shown = folder.json(&["cameras", "show", "ours", "--cameras", "my.toml"]);
    assert!((shown["exposure_s"].as_f64().unwrap() - 5e-3).abs() < 1e-15, "{shown}");
    let outcome = folder.run(&["identify", "a.toml", "--cameras", "my.toml"]);
    assert!(outcome.code == 1 && outcome.stderr.contains("f_number"), "{}", outcome.stderr);
}

/// One round of questions: what is wrong, what else is missing, and how it is written.
#[test]
fn messages_say_what_to_write() {
    let folder = Folder::with(&SCENARIO.replace("\"flir-a325sc\"", "\"FLIR A325SC\""));
    assert!(folder.refusal(&["size", "a.toml"]).contains("`flir-a325sc`"));
    folder.file("b.toml", &format!("frames = 2\n{SCENARIO}"));
    let line = folder.refusal(&["size", "b.toml"]);
    assert!(
        line.contains(
            "there is no key `frames`; it is a key of another table: write `find.frames` or `camera.frames`"
        ),
        "{line}"
    );
    let own = SCENARIO.replace("preset = \"flir-a325sc\"", "detectivity = \"4.7e10 cm Hz^0.5/W\"");
    folder.file("c.toml", &own);
    let outcome = folder.run(&["size", "c.toml"]);
    for part in
        ["detectivity without a bandwidth", "are missing as well", "\n  exposure = ", "\n  f_number = "]
    {
        assert!(outcome.code == 1 && outcome.stderr.contains(part), "{part}: {}", outcome.stderr);
    }
    let vary = ["sweep", "a.toml", "--vary", "camera.exposure", "1 ms..10 ms:3", "--out", "rows"];
    let outcome = folder.run(&vary);
    let said = "join key and value by `=`: --vary camera.exposure=\"1 ms..10 ms:3\"";
    assert!(outcome.code == 2 && outcome.stderr.contains(said), "{}", outcome.stderr);
}

#[test]
fn mistakes_are_told_by_file_line_and_key() {
    let folder = Folder::with(SCENARIO);
    for (old, new, said) in [
        ("\"ours\"", "\"ideal-pnrd\"", "my.toml:2: camera[0].name: the program has a camera `ideal-pnrd`"),
        ("\"bare\"", "\"ours\"", "my.toml:8: camera[1].name: another camera is called `ours` too"),
        ("\"5 ms\"", "5", "my.toml:5: camera[0].exposure: `5` is a number without a unit"),
        ("pixel", "pixl", "my.toml:9: camera[1]: there is no key `pixl`"),
        ("[[camera]]\nname = \"bare\"", "[target]\nmaterial = \"skin\"", "my.toml"),
    ] {
        folder.file("my.toml", &MINE.replace(old, new));
        let refused = folder.refusal(&["identify", "a.toml", "--cameras", "my.toml"]);
        assert!(refused.starts_with(said), "{refused}");
    }
    folder.file("my.toml", SCENARIO);
    assert!(
        folder
            .refusal(&["cameras", "list", "--cameras", "my.toml"])
            .contains("this is a scenario of a target")
    );
}
