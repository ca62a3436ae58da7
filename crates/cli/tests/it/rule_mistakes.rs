//! Every mistake in a rule file: one line with file, line and key, and what to write instead; nothing written.

use crate::support::folder::Folder;

const RULE: &str = r#"cameras = ["flir-a325sc", "ideal-pnrd"]
[target]
material = "skin"
temperature = "33 degC"
[[environment]]
temperature = "10 degC"
lighting = 0.5
[alternatives]
materials = ["aluminium"]
[bands]
step = "100 cm^-1"
[requirement]
distance = 1.0
[envelope]
temperature = ["25 degC", "37 degC"]
lighting = [0.2, 0.8]
surroundings = ["-10 degC", "15 degC"]
distance = ["5 m", "15 m"]
materials = ["skin", "fabric"]
"#;

#[test]
fn every_mistake_in_a_rule_is_one_line_with_file_line_and_key() {
    let cameras = "cameras = [\"flir-a325sc\", \"ideal-pnrd\"]";
    for (line, instead, said) in [
        (
            "\"flir-a325sc\"",
            "\"flir-a325\"",
            "a.toml:1: cameras[0]: there is no camera `flir-a325`; the nearest are `flir-a325sc`",
        ),
        (
            cameras,
            "",
            "a.toml: the rule has no camera to check; write cameras = [\"flir-a325sc\"] above the first [table], or a [[camera]] table",
        ),
        (
            cameras,
            "cameras = []",
            "a.toml:1: cameras: the rule has no camera to check; write cameras = [\"flir-a325sc\"]",
        ),
        (
            "\"ideal-pnrd\"",
            "\"flir-a325sc\"",
            "a.toml:1: cameras[1]: the same is already in the list; name it once",
        ),
        (
            cameras,
            "cameras = \"flir-a325sc\"",
            "a.toml:1: cameras: the text \"flir-a325sc\" was found; write cameras = [",
        ),
        (
            "[alternatives]",
            "[camera]\npreset = \"flir-a325sc\"\n[alternatives]",
            "a.toml:8: camera: a table was found; write each camera as [[camera]], in double brackets",
        ),
        (
            "[alternatives]",
            "[[camera]]\npreset = \"flir-a325\"\n[alternatives]",
            "a.toml:9: camera[0].preset: there is no camera `flir-a325`",
        ),
        (
            "[alternatives]",
            "[[camera]]\npreset = \"flir-a325sc\"\nexposre = \"1 ms\"\n[alternatives]",
            "a.toml:10: camera[0]: there is no key `exposre`; the nearest are `exposure`",
        ),
        (
            "[alternatives]",
            "[[camera]]\npreset = \"flir-a325sc\"\n[alternatives]",
            "a.toml:8: camera[0].name: another camera is called flir-a325sc too; give it a name of its own",
        ),
        (
            "[\"25 degC\", \"37 degC\"]",
            "[\"37 degC\", \"25 degC\"]",
            "a.toml:15: envelope.temperature: the range goes from 37 degC to 25 degC; write the lower end first: \
             [\"25 degC\", \"37 degC\"]",
        ),
        (
            "[\"25 degC\", \"37 degC\"]",
            "[\"25 degC\"]",
            "a.toml:15: envelope.temperature: a range has two ends, but the list has 1",
        ),
        (
            "[\"25 degC\", \"37 degC\"]",
            "[25, 37]",
            "a.toml:15: envelope.temperature[0]: `25` is a number without a unit",
        ),
        (
            "[0.2, 0.8]",
            "[0.8, 0.2]",
            "a.toml:16: envelope.lighting: the range goes from 0.8 to 0.2; write the lower",
        ),
        (
            "[0.2, 0.8]",
            "[0.2, 1.2]",
            "a.toml:16: envelope.lighting[1]: lighting is 1.2; it must be between 0 and 1",
        ),
        (
            "lighting = [0.2, 0.8]",
            "lighting = [[0.2, 0.8], [0.1, 0.2]]",
            "a.toml:16: envelope.lighting: there are 2 ranges for 1 environment objects; write one for each [[environment]]",
        ),
        (
            "[alternatives]",
            "[[environment]]\ntemperature = \"0 degC\"\nlighting = 0.1\n[alternatives]",
            "", // fine: the pair holds for both
        ),
        (
            "lighting = [0.2, 0.8]",
            "lighting = []",
            "a.toml:16: envelope.lighting: a range has two ends, but the list has 0",
        ),
        (
            "[\"-10 degC\", \"15 degC\"]",
            "[\"15 degC\", \"-10 degC\"]",
            "a.toml:17: envelope.surroundings: the range goes from 15 degC to -10 degC; write",
        ),
        (
            "[\"5 m\", \"15 m\"]",
            "[\"0 m\", \"15 m\"]",
            "a.toml:18: envelope.distance[0]: `0 m` is out of range; it must be above 0",
        ),
        ("[\"skin\", \"fabric\"]", "[]", "a.toml:19: envelope.materials: the list is empty; name some"),
        (
            "[\"skin\", \"fabric\"]",
            "[\"skin\", \"fabrc\"]",
            "a.toml:19: envelope.materials[1]: there is no material `fabrc`; the nearest are `fabric`",
        ),
        ("[envelope]", "[envelop]", "a.toml:14: there is no key `envelop`; the nearest are `envelope`"),
        (
            "distance = 1.0",
            "distance = 1.0\nby = \"local\"",
            "a.toml:14: requirement.by: an envelope is searched by the nearest distance only",
        ),
        (
            "distance = 1.0",
            "distance = 1.0\ntime = \"1 us\"",
            "a.toml:14: requirement.time: a time in the requirement of a rule, which would not be judged; write start = ",
        ),
        (
            "[envelope]",
            "[rule]\nname = 1\n[envelope]",
            "a.toml:15: rule.name: the number 1 was found; write text in quotes",
        ),
    ] {
        assert!(RULE.contains(line), "{line}");
        let folder = Folder::with(&RULE.replacen(line, instead, 1));
        if said.is_empty() {
            assert_eq!(folder.accepting(&["rule", "a.toml", "--check", "--any"]).code, 0, "{instead}");
            continue;
        }
        let message = folder.refusal(&["rule", "a.toml", "--out", "report"]);
        assert!(message.starts_with(said), "{instead}\n{message}\n{said}");
    }
}

#[test]
fn the_least_lighting_of_all_objects_must_leave_room() {
    let two = "[[environment]]\ntemperature = \"0 degC\"\nlighting = 0.1\n[alternatives]";
    let text = RULE.replace("[alternatives]", two).replace("[0.2, 0.8]", "[0.6, 0.8]");
    let message = Folder::with(&text).refusal(&["rule", "a.toml"]);
    assert_eq!(
        message,
        "a.toml:19: envelope.lighting: the envelope is empty: the least lighting of all objects adds up to 1.2; lower the \
         first ends to a sum of at most 1, as the objects share one hemisphere"
    );
    let none = RULE.replace("[[environment]]\ntemperature = \"10 degC\"\nlighting = 0.5\n", "");
    let message = Folder::with(&none).refusal(&["rule", "a.toml"]);
    assert!(
        message.contains("envelope.lighting: there is no [[environment]] whose range this could be"),
        "{message}"
    );
}

/// Where the total of the lighting is known, scenes that are lit otherwise would be told apart by that alone, of the same materials.
#[test]
fn scenes_are_lit_as_much_as_is_known() {
    let known = |lighting: &str| {
        RULE.replace("lighting = 0.5\n", "").replace("lighting = [0.2, 0.8]\n", lighting).replace(
            "[requirement]",
            "[unknown]\nnuisances = [\"temperature\", \"lighting\"]\nlighting_total = 0.7\n[requirement]",
        )
    };
    let said = |text: &str| Folder::with(text).refusal(&["rule", "a.toml"]);
    for lighting in ["[0.2, 0.8]", "[0.7, 0.8]", "[0.2, 0.7]", "[0.6, 0.6]"] {
        let message = said(&known(&format!("lighting = {lighting}\n")));
        let found = "envelope.lighting: there are scenes whose lighting does not add up to lighting_total = 0.7; write";
        assert!(message.starts_with("a.toml:18: ") && message.contains(found), "{message}");
    }
    for lighting in ["", "lighting = [0.7, 0.7]\n"] {
        let folder = Folder::with(&known(lighting));
        assert_eq!(folder.accepting(&["rule", "a.toml", "--check", "--any"]).code, 0, "{lighting}");
    }
    // Two objects that make up the total in every scene, and two that do not, before a camera and before a stand-in.
    let two = |lighting: &str| {
        let first = "[[environment]]\ntemperature = \"0 degC\"\nlighting = 0.3\n[[environment]]";
        known(&format!("lighting = {lighting}\n")).replace("[[environment]]", first)
    };
    assert_eq!(
        Folder::with(&two("[[0.3, 0.3], [0.4, 0.4]]"))
            .accepting(&["rule", "a.toml", "--check", "--any"])
            .code,
        0
    );
    let apart = Folder::with(&two("[[0.2, 0.3], [0.4, 0.5]]"));
    assert!(apart.refusal(&["rule", "a.toml", "--stand-in"]).contains("envelope.lighting: there are scenes"));
    // A clause with an envelope of its own.
    let own = known("") + "[[clause]]\nname = \"a\"\n[clause.envelope]\nlighting = [0.1, 0.8]\n";
    assert!(said(&own).contains("envelope.lighting: there are scenes"));
}

#[test]
fn a_rule_is_no_scenario_and_the_other_way_round() {
    let folder = Folder::with(RULE);
    assert!(folder.refusal(&["size", "a.toml"]).starts_with("a.toml:1: this is a rule; hadar rule a.toml"));
    folder.file("b.toml", &RULE.replace("cameras = [\"flir-a325sc\", \"ideal-pnrd\"]\n", ""));
    assert!(folder.refusal(&["rule", "b.toml"]).starts_with("b.toml: the rule has no camera to check"));
    assert!(folder.refusal(&["rule", "none.toml"]).contains("there is no such file"));
}

/// All that a known camera lacks, as the table to write instead of its name.
#[test]
fn a_camera_that_no_document_completes_is_a_table_to_fill_in() {
    let text = RULE.replace("\"ideal-pnrd\"", "\"flir-boson-320\"");
    let outcome = Folder::with(&text).run(&["rule", "a.toml"]);
    assert_eq!((outcome.code, outcome.stdout.as_str()), (1, ""));
    let (head, block) = outcome.stderr.split_once('\n').unwrap();
    let found = "error: a.toml:1: cameras[1]: no document that was read states f_number, focal_length of flir-boson-320; write";
    assert!(head.starts_with(found), "{head}");
    let filled = text.replace(", \"flir-boson-320\"", "") + &block.replace('…', "16");
    assert_eq!(Folder::with(&filled).run(&["rule", "a.toml"]).code, 0, "{filled}");
}
