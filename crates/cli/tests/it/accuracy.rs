//! `hadar accuracy`: its words and its JSON; what it measures is tested beside it.

/// Names that are not there, times that cannot be, and what a run says of itself.
#[test]
fn the_command_says_what_is_wrong_and_what_it_did() {
    let hadar = |arguments: &[&str]| {
        let output = assert_cmd::Command::cargo_bin("hadar").unwrap().args(arguments).output().unwrap();
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
