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

/// The vectors name keys of what the command itself prints, and what it prints is right.
#[test]
fn the_command_answers_the_scenarios_of_the_vectors() {
    let folder = hadar_testing::repository().join("vectors");
    let file = std::fs::read_to_string(folder.join("identify.json")).unwrap();
    let file: serde_json::Value = serde_json::from_str(&file).unwrap();
    let mut numbers = 0;
    for vector in file["vectors"].as_array().unwrap() {
        let command: Vec<&str> = vector["inputs"]["command"].as_str().unwrap().split(' ').skip(1).collect();
        let output =
            assert_cmd::Command::cargo_bin("hadar").unwrap().args(&command).current_dir(&folder).output();
        let said: serde_json::Value = serde_json::from_slice(&output.unwrap().stdout).unwrap();
        for (key, answer) in vector["answers"].as_object().unwrap() {
            let (found, value) = (said.pointer(key).unwrap(), &answer["value"]);
            let Some(exact) = value.as_str().and_then(|digits| digits.parse::<f64>().ok()) else {
                assert!(found == value || value.is_array(), "{command:?} {key}: {found}");
                continue;
            };
            let allowed = |key: &str| answer[key].as_f64().unwrap_or(0.0);
            let tolerance = (allowed("relative_tolerance") * exact.abs()).max(allowed("absolute_tolerance"));
            let found = found.as_f64().unwrap();
            assert!((found - exact).abs() <= tolerance, "{command:?} {key}: {found}, not {exact}");
            numbers += 1;
        }
    }
    assert!(numbers > 50, "{numbers}");
}
