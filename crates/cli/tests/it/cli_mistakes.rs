//! Every mistake on the command line and in its files: exit code, one line that says where and what instead, nothing
//! written.

use crate::support::folder::{Folder, SCENARIO};
use std::fs;

/// What `size` says about the scenario with one line changed; the report's folder must not appear.
#[track_caller]
fn with_line(line: &str, instead: &str) -> String {
    assert!(SCENARIO.contains(line));
    let folder = Folder::with(&SCENARIO.replace(line, instead));
    folder.refusal(&["size", "a.toml", "--out", "report"])
}

/// What `size` says with the target's spectrum in `my.csv`, its folder left out.
#[track_caller]
fn with_spectrum(content: &str) -> String {
    let folder = Folder::with(&SCENARIO.replace("\"skin\"", "\"my.csv\""));
    folder.file("my.csv", content);
    let said = folder.refusal(&["size", "a.toml", "--out", "report"]);
    let at = said.find("my.csv").unwrap_or_else(|| panic!("{said}"));
    said[at..].to_owned()
}

#[test]
fn every_mistake_in_a_scenario_is_one_line_with_file_line_and_key() {
    for (line, instead, said) in [
        (
            "\"skin\"",
            "\"skn\"",
            "a.toml:2: target.material: there is no material `skn`; the nearest are `skin`",
        ),
        (
            "aluminium",
            "aluminum",
            "a.toml:8: alternatives.materials[0]: there is no material `aluminum`; the nearest are `aluminium`",
        ),
        ("37 degC", "37", "a.toml:3: target.temperature: `37` is a number without a unit; write \"37 degC\""),
        (
            "\"37 degC\"",
            "37",
            "a.toml:3: target.temperature: `37` is a number without a unit; write \"37 degC\"",
        ),
        (
            "37 degC",
            "37 m",
            "a.toml:3: target.temperature: `m` is not a unit of temperature; write \"37 degC\"",
        ),
        ("5 cm^-1", "5 K", "a.toml:10: bands.step: `K` is not a unit of"),
        ("37 degC", "0 K", "a.toml:3: target.temperature: `0 K` is out of range; it must be above 0 K"),
        (
            "37 degC",
            "-300 degC",
            "a.toml:3: target.temperature: `-300 degC` is out of range; it must be above 0 K",
        ),
        (
            "20 degC",
            "-1 K",
            "a.toml:5: environment[0].temperature: `-1 K` is out of range; it must be above 0 K",
        ),
        ("37 degC", "1e-300 K", "a.toml:3: target.temperature: temperature is 1e-300 K; it must be between"),
        (
            "lighting = 0.5",
            "lighting = -0.1",
            "a.toml:6: environment[0].lighting: lighting is -0.1; it must be between 0 and 1",
        ),
        (
            "lighting = 0.5",
            "lighting = 1.5",
            "a.toml:6: environment[0].lighting: lighting is 1.5; it must be between 0 and 1",
        ),
        (
            "lighting = 0.5",
            "lighting = 0.5\n[[environment]]\ntemperature = \"0 degC\"\nlighting = 0.6",
            "a.toml:9: environment[1].lighting: the lighting factors add up to 1.1; lower them",
        ),
        (
            "step = \"5 cm^-1\"",
            "start = \"100 cm^-1\"",
            "a.toml:8: alternatives.materials[0]: `aluminium` is known from 690 to 1362 cm^-1",
        ),
        (
            "lighting = 0.5",
            "lightning = 0.5",
            "a.toml:6: environment[0]: there is no key `lightning`; did you mean `lighting`?",
        ),
        ("[camera]", "[kamera]", "a.toml:11: there is no key `kamera`; the nearest are `camera`"),
        (
            "flir-a325sc",
            "flir-a325",
            "a.toml:12: camera.preset: there is no camera `flir-a325`; the nearest are `flir-a325sc`, `flir-a325sc-25um`, `flir-a655sc`",
        ),
        (
            "preset = \"flir-a325sc\"",
            "preset = \"flir-a325sc\"\nexposure = \"1e200 s\"",
            "a.toml:11: camera: the camera would count",
        ),
        (
            "[bands]",
            "[requirement]\ndistance = 1e300\n[bands]",
            "a.toml:10: requirement.distance: statistical distance is 1e300; it must be between",
        ),
        ("[target]", "[target", "a.toml:1: this is not TOML"),
    ] {
        let said_now = with_line(line, instead);
        assert!(said_now.starts_with(said), "{instead}: {said_now}");
    }
    let dark = SCENARIO.replace("37 degC", "0.1 K").replace("lighting = 0.5", "lighting = 0");
    let said = Folder::with(&dark).refusal(&["size", "a.toml", "--out", "report"]);
    assert!(
        said.starts_with("a.toml:3: target.temperature: photon radiance of the target is 0 photons"),
        "{said}"
    );
}

#[test]
fn every_mistake_in_a_spectrum_is_one_line_with_file_line_and_column() {
    let header = "wavenumber_cm1,emissivity\n";
    for (rows, said) in [
        (
            "700,0.5\n1300,1.2\n",
            "my.csv:3: emissivity: emissivity is 1.2; it must be a fraction between 0 and 1",
        ),
        (
            "700,0.5\n1300,-0.1\n",
            "my.csv:3: emissivity: emissivity is -0.1; it must be a fraction between 0 and 1",
        ),
        (
            "700,0.5\n900,high\n1300,0.5\n",
            "my.csv:3: emissivity: `high` is not a finite number; write a number",
        ),
        (
            "700,0.5\n900,NaN\n1300,0.5\n",
            "my.csv:3: emissivity: `NaN` is not a finite number; write a number",
        ),
        (
            "700,0.5\nnan,0.5\n1300,0.5\n",
            "my.csv:3: wavenumber_cm1: `nan` is not a finite number; write a number",
        ),
        ("700,0.5\n900,\n1300,0.5\n", "my.csv:3: emissivity: the cell is empty; write a number"),
        (
            "700,0.5\n900,0.5\n700,0.6\n1300,0.5\n",
            "my.csv:4: wavenumber_cm1: 700 cm^-1 is there already on line 2; keep one",
        ),
        ("0,0.5\n1300,0.6\n", "my.csv:2: wavenumber_cm1: wavenumber_cm1 is 0 cm^-1; it must be"),
        ("", "my.csv: there are no rows below the header; a spectrum needs at least 2"),
    ] {
        let said_now = with_spectrum(&format!("{header}{rows}"));
        assert!(said_now.starts_with(said), "{rows}: {said_now}");
    }
    assert!(
        with_spectrum("").starts_with("my.csv: the file has no rows; begin the file with a line such as")
    );
    assert!(with_spectrum("700,0.5\n1300,0.5\n").contains("there is no header, only numbers"));
    // Too short for the bands: that is the scenario's choice, so its line is named.
    let folder = Folder::with(&SCENARIO.replace("\"skin\"", "\"my.csv\""));
    folder.file("my.csv", &format!("{header}800,0.5\n1300,0.6\n"));
    let said = folder.refusal(&["size", "a.toml"]);
    let expected =
        "a.toml:2: target.material: `my` is known from 800 to 1300 cm^-1 but is needed at 715 cm^-1; narrow";
    assert!(said.starts_with(expected), "{said}");
}

#[test]
fn files_that_are_not_there_or_are_folders_are_named() {
    for (arguments, said) in [
        (vec!["size", "none.toml"], "none.toml: cannot read the scenario: there is no such file"),
        (vec!["size", "."], ".: cannot read the scenario: it is a directory; name the .toml file inside it"),
        (vec!["identify", "empty.toml"], "empty.toml: the file is empty; write [target]"),
        (
            vec!["materials", "import", "none.csv"],
            "none.csv: cannot read the spectrum: there is no such file",
        ),
        (vec!["materials", "import", "a.toml"], "a.toml:1: this is not the header of a spectrum"),
        (vec!["materials", "list", "--library", "none"], "none: cannot read"),
        (
            vec!["materials", "show", "aluminum"],
            "there is no material `aluminum`; the nearest are `aluminium`",
        ),
        (vec!["materials", "plot", "skin"], "there is no folder to draw into; add --out DIR"),
        (vec!["materials", "plot", "skn", "--out", "drawn"], "there is no material `skn`"),
        (
            vec!["cameras", "show", "flir-a325"],
            "there is no camera `flir-a325`; the nearest are `flir-a325sc`",
        ),
    ] {
        let folder = Folder::with(SCENARIO);
        folder.file("empty.toml", "");
        let said_now = folder.refusal(&arguments);
        assert!(said_now.starts_with(said), "{arguments:?}: {said_now}");
    }
    for (key, said) in [
        (
            "rows = \"none.csv\"",
            "none.csv: cannot read the bands: there is no such file; check its name and folder",
        ),
        (
            "filters = \"none.csv\"",
            "none.csv: cannot read the filters: there is no such file; check its name and folder",
        ),
    ] {
        let said_now = with_line("step = \"5 cm^-1\"", key);
        assert!(said_now.ends_with(said), "{said_now}");
    }
    assert!(with_line("step = \"5 cm^-1\"", "filters = \".\"").ends_with("this is a directory; name a file"));
}

/// As root every folder may be written to; what cannot be one even then is below a file, a file, or in /proc.
#[test]
fn a_folder_that_cannot_be_written_to_is_refused_before_any_work() {
    let folder = Folder::with(SCENARIO);
    for (out, said) in [
        ("a.toml", "a.toml: cannot write the report: this is a file; name a folder"),
        ("a.toml/below", "a.toml/below: cannot write the report: part of the path is a file; name a folder"),
        ("/proc/hadar", "/proc/hadar: cannot write the report: "),
    ] {
        for command in ["size", "identify"] {
            let said_now = folder.refusal(&[command, "a.toml", "--out", out]);
            assert!(said_now.starts_with(said) && said_now.contains("name a folder"), "{said_now}");
        }
    }
    fs::create_dir_all(folder.path().join("report/pairs.csv")).unwrap();
    let said = folder.refusal(&["size", "a.toml", "--out", "report", "--force"]);
    assert!(said.contains("its `pairs.csv` is a folder"), "{said}");
}

#[test]
fn wrong_usage_ends_with_2() {
    let folder = Folder::with(SCENARIO);
    for arguments in [
        vec!["siz", "a.toml"],
        vec!["size"],
        vec!["size", "a.toml", "--by", "farthest"],
        vec!["size", "a.toml", "--threads", "many"],
        vec!["cameras", "show"],
        vec![],
    ] {
        let outcome = folder.run(&arguments);
        assert_eq!((outcome.code, outcome.stdout.as_str()), (2, ""), "{arguments:?}");
        assert!(!outcome.stderr.is_empty());
    }
}
