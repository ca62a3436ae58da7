//! Messages as they leave the program: the command a file is for, units of the author, colour.

use crate::support::folder::{Folder, SCENARIO};
use assert_cmd::Command;

const RANGE: &str = "[scene]\n[camera]\npreset = \"flir-a325sc\"\n[stereo]\nbaseline = \"0.2 m\"\n";
const RULE: &str = "cameras = [\"flir-a325sc\"]\n[target]\nmaterial = \"skin\"\ntemperature = \"37 degC\"\n";

/// Every kind of file to every command that wants another one.
#[test]
fn a_file_for_another_command_is_sent_there() {
    let folder = Folder::with(SCENARIO);
    for (name, text) in [
        ("range.toml", RANGE),
        ("rule.toml", RULE),
        (
            "tables.toml",
            "[target]\nmaterial = \"skin\"\ntemperature = \"37 degC\"\n[[camera]]\npreset = \"flir-a325sc\"\n",
        ),
        ("materials.toml", "version = 1\n[[material]]\nname = \"skin\"\n"),
        ("cameras.toml", "[[camera]]\nname = \"ours\"\npixel_m = 12e-6\n"),
        ("stereo.toml", "[stereo]\nbaseline = \"0.2 m\"\n"),
    ] {
        folder.file(name, text);
    }
    let ranging = "this is a ranging scenario; hadar range ";
    let scenario = "this is a scenario of a target; hadar size a.toml";
    for (command, file, line, said) in [
        ("size", "range.toml", 1, ranging),
        ("identify", "range.toml", 1, ranging),
        ("simulate", "range.toml", 1, ranging),
        ("rule", "range.toml", 1, ranging),
        ("size", "stereo.toml", 1, ranging),
        ("size", "rule.toml", 1, "this is a rule; hadar rule rule.toml"),
        ("range", "rule.toml", 1, "this is a rule; hadar rule rule.toml"),
        ("identify", "tables.toml", 4, "this is a rule; hadar rule tables.toml"),
        ("range", "a.toml", 1, scenario),
        ("rule", "a.toml", 1, scenario),
        ("size", "materials.toml", 2, "this is a manifest of materials; name a scenario"),
        ("rule", "cameras.toml", 1, "this is a list of cameras; write one as [camera]"),
        ("size", "cameras.toml", 1, "this is a list of cameras; write one as [camera]"),
    ] {
        let message = folder.refusal(&[command, file]);
        assert!(message.starts_with(&format!("{file}:{line}: {said}")), "{command} {file}: {message}");
    }
    // Keys of several kinds: the one that does not belong is named.
    folder.file("both.toml", &format!("{RANGE}[target]\nmaterial = \"skin\"\n"));
    assert!(folder.refusal(&["range", "both.toml"]).contains("there is no key `target`"));
}

#[test]
fn answers_and_the_scenario_that_is_written_speak_in_the_units_of_their_author() {
    let text = SCENARIO
        .replace("\"37 degC\"", "\"98.6 °F\"\ndistance = \"3000 ft\"")
        .replace("\"20 degC\"", "\"68 °F\"")
        .replace("flir-a325sc", "ideal-pnrd");
    let folder = Folder::with(&format!("{text}[requirement]\nspeed = \"30 mph\"\n"));
    let outcome = folder.run(&["size", "a.toml", "--out", "out"]);
    assert_eq!(outcome.code, 0, "{}", outcome.stderr);
    for unit in [" mph", " °F", " ft"] {
        assert!(outcome.stdout.contains(unit), "{unit}: {}", outcome.stdout);
    }
    assert!(!outcome.stdout.contains("degC") && !outcome.stdout.contains(" m/s"), "{}", outcome.stdout);
    let written = std::fs::read_to_string(folder.path().join("out/scenario.toml")).unwrap();
    for quantity in ["\"98.6 °F\"", "\"3000 ft\"", "\"68 °F\"", "\"30 mph\""] {
        assert!(written.contains(quantity), "{written}");
    }
}

#[test]
fn numbers_of_an_answer_are_of_one_style() {
    let folder = Folder::with(SCENARIO);
    for command in ["size", "identify"] {
        let text = folder.run(&[command, "a.toml"]).stdout;
        for word in text.split(|c: char| c.is_whitespace() || c == '(' || c == ')') {
            let Some((digits, power)) = word.split_once('e') else { continue };
            if let (Ok(_), Ok(power)) = (digits.parse::<f64>(), power.parse::<i32>()) {
                assert!(!(-3..5).contains(&power), "{word} in\n{text}");
            }
        }
    }
}

#[test]
fn colour_is_for_terminals_and_for_those_who_ask() {
    let folder = Folder::with(SCENARIO);
    let run = |arguments: &[&str], variables: &[(&str, &str)]| {
        let mut command = Command::new(assert_cmd::cargo::cargo_bin!("hadar"));
        command
            .current_dir(folder.path())
            .args(arguments)
            .env_remove("NO_COLOR")
            .env_remove("CLICOLOR_FORCE");
        let output = command.envs(variables.iter().copied()).output().unwrap();
        [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap())
    };
    let forced = [("CLICOLOR_FORCE", "1")];
    let (plain, coloured) = (run(&["size", "a.toml"], &[]), run(&["size", "a.toml"], &forced));
    assert!(!plain.concat().contains('\u{1b}') && plain[0].starts_with("No: "), "{plain:?}");
    assert!(coloured[0].starts_with("\u{1b}[31m\u{1b}[1mNo\u{1b}[0m: "), "{:?}", coloured[0]);
    assert!(!run(&["size", "a.toml", "--json"], &forced)[0].contains('\u{1b}'));
    let [_, error] = run(&["size", "none.toml"], &forced);
    assert!(error.starts_with("\u{1b}[31m\u{1b}[1merror:\u{1b}[0m none.toml: "), "{error:?}");
    assert!(run(&["size", "none.toml"], &[])[1].starts_with("error: none.toml: "));
}

#[test]
fn a_decimal_comma_in_a_flag_is_named() {
    let folder = Folder::with(SCENARIO);
    let outcome = folder.run(&["identify", "a.toml", "--exact", "--half-width", "0,02"]);
    assert_eq!(outcome.code, 2);
    assert!(outcome.stderr.contains("`0,02` has a decimal comma; write 0.02"), "{}", outcome.stderr);
    let message = folder.refusal(&["simulate", "a.toml", "--thermometry", "37,5 degC"]);
    assert!(message.contains("write 37.5, as in \"37.5 degC\""), "{message}");
    let reversed = folder.refusal(&["simulate", "a.toml", "--thermometry", "60 degC..20 degC"]);
    assert!(
        reversed.contains("the range goes from 60 degC to 20 degC; write the lower end first"),
        "{reversed}"
    );
    folder.file("own.csv", "wavenumber_cm1,emissivity\n715,0,95\n");
    let message = folder.refusal(&["materials", "import", "own.csv"]);
    assert!(message.contains("with a decimal point: 0.95, not 0,95"), "{message}");
}
