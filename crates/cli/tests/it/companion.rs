//! The companion table in the answer, the JSON and the folder of `hadar size`.

use crate::support::folder::{Folder, SCENARIO};

/// Few bands, for what is asked does not hang on them.
fn coarse() -> String {
    SCENARIO.replace("5 cm^-1", "60 cm^-1")
}

/// A head at 30 m, 20 mm of it in a pixel; in an even scene also what is behind and around is as warm as it is.
fn sized(temperature: &str, lighting: &str) -> String {
    coarse()
        .replace(
            "temperature = \"37 degC\"",
            &format!("temperature = \"{temperature}\"\ndistance = \"30 m\"\nsize = \"0.25 m\""),
        )
        .replace("[[environment]]", "[background]\ntemperature = \"20 degC\"\n[[environment]]")
        .replace("lighting = 0.5", &format!("lighting = {lighting}"))
}

#[test]
fn a_target_of_a_size_has_its_companion_everywhere() {
    let folder = Folder::with(&sized("37 degC", "0.5"));
    let json = folder.json(&["size", "a.toml", "--out", "out", "-q"]);
    let written = |name: &str| std::fs::read_to_string(folder.path().join("out").join(name)).unwrap();
    let answer = written("answer.txt");
    let at = |text: &str| answer.find(text).unwrap_or_else(|| panic!("{text}: {answer}"));
    // One after the other, before the assumptions; 12.5 pixels by the lens and another angle by the field of view.
    let in_order = [
        "\nRules of thumb of sizing practice, for comparison with the bound, of 250 mm at 30.0 m\n",
        "  rule of thumb   pixels across it                12.5 (6.25 cycles)\n",
        "field of view and focal length contradict each other",
        "\n  observer model  ",
        "\n  bound           d of a pixel, at most ",
        "  Shape and material are different questions",
        "(ASTM E1543)",
        "\nAssumptions\n",
    ];
    assert!(in_order.map(at).is_sorted(), "{answer}");
    let table = written("companion.csv");
    assert!(table.starts_with("camera,kind,code,task,quantity,value,conditions,caveat,unknown\n"), "{table}");
    assert!(written("report.html").contains("(companion.csv)"));
    let rows = json["companion"]["rows"].as_array().unwrap();
    let bound = rows.iter().find(|row| row["code"] == "material").unwrap();
    assert_eq!(bound["values"]["statistical_distance"], json["verdict"]["statistical_distance_nearest"]);
}

#[test]
fn at_one_temperature_practice_says_what_it_always_says() {
    let (warm, still) = (Folder::with(&sized("37 degC", "1.0")), Folder::with(&sized("20 degC", "1.0")));
    let lines = |folder: &Folder| -> Vec<String> {
        let outcome = folder.run(&["size", "a.toml", "-q"]);
        let from = outcome.stdout.find("Rules of thumb of sizing practice").unwrap();
        outcome.stdout[from..].lines().take_while(|line| !line.is_empty()).map(str::to_owned).collect()
    };
    let (warm, still) = (lines(&warm), lines(&still));
    for (before, after) in warm.iter().zip(&still) {
        assert_eq!(before == after, !before.contains("  d of "), "{before}\n{after}");
    }
    let nothing =
        still.iter().filter(|line| line.contains("0: distinguished from aluminium with probability 0.5000"));
    assert_eq!(nothing.count(), 2, "{still:?}");
}

#[test]
fn without_a_size_or_a_camera_there_is_none() {
    let cameraless = sized("37 degC", "0.5").replace("[camera]\npreset = \"flir-a325sc\"\n", "");
    for scenario in [coarse(), cameraless] {
        let folder = Folder::with(&scenario);
        let outcome = folder.run(&["size", "a.toml", "-q"]);
        assert_eq!(outcome.code, 0, "{}", outcome.stderr);
        assert!(!outcome.stdout.contains("sizing practice"), "{}", outcome.stdout);
    }
}
