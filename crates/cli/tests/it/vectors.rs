//! The scenarios in `vectors/`: what the command prints of them is within the tolerances of their answers.

/// The vectors name keys of what the command itself prints, and what it prints is right.
#[test]
fn the_command_answers_the_scenarios_of_the_vectors() {
    let folder = hadar_testing::repository().join("vectors");
    let file = std::fs::read_to_string(folder.join("identify.json")).unwrap();
    let file: serde_json::Value = serde_json::from_str(&file).unwrap();
    let mut numbers = 0;
    for vector in file["vectors"].as_array().unwrap() {
        let command: Vec<&str> = vector["inputs"]["command"].as_str().unwrap().split(' ').skip(1).collect();
        let output = std::process::Command::new(crate::PROGRAM).args(&command).current_dir(&folder).output();
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
