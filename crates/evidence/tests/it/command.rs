//! The program itself: its words, its JSON and its exit codes; what it measures is tested elsewhere.

use crate::support::folder::{Folder, SCENARIO};
use crate::support::page::elements;
use std::process::Command;

/// Names that are not there, times that cannot be, and what a run says of itself.
#[test]
fn the_command_says_what_is_wrong_and_what_it_did() {
    let hadar = |arguments: &[&str]| {
        let output = Command::new(crate::PROGRAM).args(arguments).output().unwrap();
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        (output.status.code(), text(output.stdout), text(output.stderr))
    };
    let (code, _, error) = hadar(&["accuracy", "speed"]);
    assert_eq!(code, Some(1));
    assert!(
        error.contains("unknown computation `speed`") && error.contains("skipping, stress, all"),
        "{error}"
    );
    let (code, _, error) = hadar(&["accuracy", "stress", "--cases", "0"]);
    assert!(code == Some(1) && error.contains("stress cases is 0"), "{error}");
    let (code, text, _) = hadar(&["accuracy", "brute-force", "--scene", "1", "--seed", "7", "-q"]);
    assert!(
        code == Some(0) && text.contains("1 scenes of seed 7") && text.contains("| lighting | 1 |"),
        "{text}"
    );
    // Each number to its own computation: in a list of them none is multiplied by mistake.
    let (code, _, error) = hadar(&["accuracy", "brute-force", "--cases", "9"]);
    assert!(code == Some(1) && error.contains("`--cases 9`, which is for `stress`"), "{error}");
    let (code, _, error) = hadar(&["accuracy", "stress", "--scene", "9"]);
    assert!(code == Some(1) && error.contains("`--scene 9`, which is for `brute-force`"), "{error}");
    // Vectors are no measurement: all of them, and nothing else.
    for (arguments, said) in [
        (["accuracy", "vectors", "planck"].as_slice(), "`vectors` beside other names"),
        (&["accuracy", "vectors", "--quick"], "`--quick` with `vectors`"),
        (&["accuracy", "vectors", "--scenes", "3"], "`--scenes 3`, which is for `brute-force`"),
    ] {
        let (code, _, error) = hadar(arguments);
        assert!(code == Some(1) && error.contains(said), "{error}");
    }
    let (code, _, error) = hadar(&["accuracy", "all", "planck"]);
    assert!(code == Some(1) && error.contains("`all` alone"), "{error}");

    let (code, text, _) = hadar(&["accuracy", "stress", "continuum", "--quick", "--cases", "300", "-q"]);
    assert_eq!(code, Some(0));
    assert!(text.starts_with("No failure in 300 cases") && text.contains("| skin | aluminium |"), "{text}");
    let (_, json, _) = hadar(&["accuracy", "nearest", "--quick", "-q", "--json"]);
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["stats"]["sections"]["computed"], 1);
    assert_eq!(json["charts"][0]["measured"][0]["method"], "search alone");
}

/// Ledger and versions, as every command has them.
#[test]
fn answers_have_what_every_answer_has() {
    let folder = Folder::with(SCENARIO);
    for arguments in [["reproduce", "tabs2"].as_slice(), &["accuracy", "planck", "--quick"]] {
        let json = folder.json(arguments);
        assert_eq!(json["hadar"], env!("CARGO_PKG_VERSION"), "{arguments:?}");
        assert!(json["schema"].is_u64() && json["stats"].is_object(), "{arguments:?}");
        let ledger = folder.run(&[arguments, &["--stats"]].concat()).stderr;
        assert!(ledger.contains("possible  computed"), "{arguments:?}: {ledger}");
        assert_eq!(folder.run(&[arguments, &["--stats", "-q"]].concat()).stderr, "", "{arguments:?}");
    }
}

/// Signed as `hadar` would sign it; a folder of its own for each item.
#[test]
fn a_report_is_one_of_hadar() {
    let folder = Folder::with(SCENARIO);
    folder.file("kept", "mine");
    let said = folder.refusal(&["reproduce", "tabs2", "--out", "kept"]);
    assert!(said.contains("part of the path is a file"), "{said}");
    let outcome = folder.run(&["--quiet", "reproduce", "tabs2", "--out", "out", "--threads", "1"]);
    assert_eq!((outcome.code, outcome.stderr.as_str()), (0, ""));
    let page = std::fs::read_to_string(folder.path().join("out/tabs2/report.html")).unwrap();
    assert!(elements(&page).iter().any(|one| one.name == "code" && one.text == "hadar reproduce tabs2"));
}

#[test]
fn usage_has_its_exit_code_and_another_build_is_refused() {
    let folder = Folder::with(SCENARIO);
    for arguments in [["size", "a.toml"].as_slice(), &["accuracy", "--cameras", "a.toml"], &[]] {
        assert_eq!(folder.run(arguments).code, 2, "{arguments:?}");
    }
    let output = Command::new(crate::PROGRAM)
        .args(["reproduce", "tabs2"])
        .env("HADAR_HANDED_OVER_BY", "0.0.9, commit abc")
        .output()
        .unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.code() == Some(1) && output.stdout.is_empty(), "{said}");
    assert!(said.contains("`hadar` that asks it is 0.0.9, commit abc; build both again"), "{said}");
}
