//! Every mistake about many materials: exit code, one line that says what was found and what to write instead, nothing
//! written; and odd scenes that are no mistakes, which every flag must answer.

use crate::support::folder::{Folder, SCENARIO};
use serde_json::Value;
use std::fs;

const NO_CAMERA: &str = "[camera]\npreset = \"flir-a325sc\"\n";
const STEP: &str = "step = \"5 cm^-1\"";
const ALTERNATIVES: &str = "[\"aluminium\"]";

/// What `identify` says, its report's folder left out.
#[track_caller]
fn refused(scenario: &str, more: &[&str]) -> String {
    let folder = Folder::with(scenario);
    folder.file("grey.csv", "wavenumber_cm1,emissivity\n600,0.5\n1400,0.6\n");
    folder.file("short.csv", "wavenumber_cm1,emissivity\n800,0.5\n1400,0.6\n");
    folder.file("skin.csv", "wavenumber_cm1,emissivity\n600,0.5\n1400,0.9\n");
    fs::create_dir_all(folder.path().join("empty")).unwrap();
    for name in ["one", "two"] {
        fs::create_dir_all(folder.path().join(name)).unwrap();
    }
    folder.file("one/paint.csv", "wavenumber_cm1,emissivity\n600,0.5\n1400,0.6\n");
    folder.file("two/paint.csv", "wavenumber_cm1,emissivity\n600,0.6\n1400,0.5\n");
    folder.refusal(&[&["identify", "a.toml", "--out", "report"], more].concat())
}

#[test]
fn every_mistake_about_libraries_and_alternatives_is_one_line() {
    let all = SCENARIO.replace("[alternatives]\nmaterials = [\"aluminium\"]\n", "");
    let with = |materials: &str| SCENARIO.replace(ALTERNATIVES, materials);
    for (scenario, flags, said) in [
        (
            SCENARIO.to_owned(),
            vec!["--only-library"],
            "the library is empty; add spectra with --library DIR, or leave out --only-library",
        ),
        (SCENARIO.to_owned(), vec!["--library", "empty"], "empty: the directory holds no spectra; put .csv"),
        (
            all.clone(),
            vec!["--library", "skin.csv", "--only-library"],
            "the library has no other material than the target; name alternatives.materials",
        ),
        (
            with("[\"skin\"]"),
            vec!["--matrix"],
            "a.toml:7: alternatives: `skin` is the only material; name at least one other",
        ),
        (
            with("[\"aluminium\", \"pmma\", \"aluminium\"]"),
            vec!["--matrix"],
            "a.toml:8: alternatives.materials[2]: the same is already in the list; name it once",
        ),
        (
            with("[\"one/paint.csv\", \"two/paint.csv\"]"),
            vec!["--matrix"],
            "two different spectra are called `paint`; rename one of them",
        ),
        (
            with("[\"skin.csv\"]"),
            vec!["--apart"],
            "two different spectra are called `skin`; rename one of them",
        ),
        (
            with("[\"grey.csv\", \"short.csv\"]"),
            vec!["--matrix"],
            "alternatives.materials[1]: `short` is known from 800 to 1400 cm^-1 but is needed at 715 cm^-1; narrow",
        ),
        (
            all.clone(),
            vec!["--library", "short.csv"],
            "alternatives do not cover the bands (715 to 1250 cm^-1): short; leave them out with --skip-uncovered",
        ),
        (
            with("[\"short.csv\"]"),
            vec!["--skip-uncovered"],
            "1 of 1 alternatives do not cover the bands (715 to 1250 cm^-1): short; choose bands that",
        ),
    ] {
        let said_now = refused(&scenario, &flags);
        assert!(said_now.contains(said), "{flags:?}: {said_now}");
    }
}

#[test]
fn every_mistake_in_a_flag_is_one_line_that_names_it() {
    let without = SCENARIO.replace(NO_CAMERA, "");
    let no_camera =
        "camera: without a camera nothing decides which materials can be distinguished; add a [camera]";
    for (scenario, flags, said) in [
        (&without, vec!["--apart"], no_camera),
        (
            &without,
            vec!["--exact", "--statistics", "gaussian"],
            "there is none; add a [camera] with noise, or use --statistics poisson",
        ),
        (
            &SCENARIO.replace("preset = \"flir-a325sc\"", "preset = \"ideal-pnrd\""),
            vec!["--exact", "--statistics", "gaussian"],
            "there is none; add a [camera] with noise, or use --statistics poisson",
        ),
        (&without, vec!["--bands", "0"], "--bands is 0; it must be from 1 to the number of bands, 108"),
        (&without, vec!["--bands", "109"], "--bands is 109; it must be from 1 to the number of bands, 108"),
        (&without, vec!["--filters", "0"], "--filters is 0; it must be from 1 to the number of bands, 108"),
        (
            &without,
            vec!["--filters", "999"],
            "--filters is 999; it must be from 1 to the number of bands, 108",
        ),
        (
            &without,
            vec!["--exact", "--half-width", "0"],
            "--half-width: half width is 0; it must be above 0 and below 0.5",
        ),
        (
            &without,
            vec!["--exact", "--half-width", "1"],
            "--half-width: half width is 1; it must be above 0 and below 0.5",
        ),
        (&without, vec!["--exact", "--half-width", "-1"], "half width is -1; it must be above 0"),
        (&without, vec!["--exact", "--half-width", "nan"], "half width is NaN; it must be above 0"),
        (&without, vec!["--exact", "--trials", "0"], "--trials: limit of trials is 0; it must be at least 1"),
        (&without, vec!["--exact", "--photons", "-1"], "--photons is -1; it must be a finite number above 0"),
        (&without, vec!["--exact", "--photons", "0"], "--photons is 0; it must be a finite number above 0"),
        (
            &without,
            vec!["--exact", "--photons", "nan"],
            "--photons is NaN; it must be a finite number above 0",
        ),
        (
            &without,
            vec!["--exact", "--photons", "1e30"],
            "1.00e30 photons are too many to draw; ask for at most 1e18 with --photons",
        ),
    ] {
        let said_now = refused(scenario, &flags);
        assert!(said_now.contains(said), "{flags:?}: {said_now}");
    }
    let folder = Folder::with(&without);
    let said = folder.refusal(&["identify", "a.toml", "--check"]);
    assert!(said.contains(no_camera), "{said}");
    let folder = Folder::with(SCENARIO);
    let said = folder.refusal(&["identify", "a.toml", "--check", "--out", "report"]);
    assert!(said.starts_with("--check, which answers yes or no, has nothing to write"), "{said}");
    let dark = SCENARIO.replace("37 degC", "0.1 K").replace("lighting = 0.5", "lighting = 0");
    for flags in [&["--matrix"][..], &["--exact"], &["--scaling"], &["--bands", "3"]] {
        let said = refused(&dark, flags);
        assert!(said.contains("photon radiance of the target is 0 photons"), "{said}");
    }
}

#[test]
fn flags_that_do_not_go_together_end_with_2() {
    let folder = Folder::with(SCENARIO);
    for flags in [
        vec!["--photons", "5"],
        vec!["--statistics", "poisson"],
        vec!["--half-width", "0.1"],
        vec!["--trials", "5"],
        vec!["--matrix", "--apart"],
        vec!["--check", "--matrix"],
        vec!["--check", "--exact"],
        vec!["--bands"],
        vec!["--bands", "-1"],
        vec!["--bands", "many"],
        vec!["--exact", "--statistics", "bose"],
        vec!["--exact", "--trials", "1.5"],
        vec!["--seed", "-1"],
        vec!["--by", "farthest"],
    ] {
        let outcome = folder.run(&[&["identify", "a.toml", "--out", "report"], &flags[..]].concat());
        assert_eq!((outcome.code, outcome.stdout.as_str()), (2, ""), "{flags:?}");
        assert!(outcome.stderr.starts_with("error: "), "{flags:?}: {}", outcome.stderr);
        assert!(!folder.path().join("report").exists());
    }
}

const EVERYTHING: [&str; 5] = ["--matrix", "--scaling", "--exact", "--trials", "128"];

/// All flags on a scene: no panic, no number that is none, files of every kind.
#[track_caller]
fn answered(what: &str, scenario: &str, flags: &[&str]) -> Value {
    let folder = Folder::with(scenario);
    folder.file("black.csv", "wavenumber_cm1,emissivity\n600,1\n1400,1\n");
    folder.file("grey.csv", "wavenumber_cm1,emissivity\n600,0.5\n1400,0.5\n");
    folder.file("grey2.csv", "wavenumber_cm1,emissivity\n600,0.5\n1400,0.5\n");
    folder.file(
        "filters.csv",
        "wavenumber_cm1,a,b,c,d\n800,0,0,0,0\n850,1,0,0,0\n900,0,0,0,0\n950,0,1,0,0\n1000,0,0,0,0\n1050,0,0,1,0\n1100,0,0,0,0\n1150,0,0,0,1\n1200,0,0,0,0\n",
    );
    let outcome = folder.run(&[&["identify", "a.toml", "--json", "--out", "report"], flags].concat());
    assert_eq!(outcome.code, 0, "{what}: {}", outcome.stderr);
    for entry in fs::read_dir(folder.path().join("report")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "csv") {
            let content = fs::read_to_string(&path).unwrap();
            assert!(!content.contains("NaN"), "{what}: {}", path.display());
        }
    }
    let text = folder.run(&[&["identify", "a.toml"], flags].concat());
    assert_eq!(text.code, 0, "{what}");
    assert!(!text.stdout.contains("NaN") && !text.stdout.contains("inf "), "{what}:\n{}", text.stdout);
    assert!(!text.stdout.contains("0.00e0"), "{what}:\n{}", text.stdout);
    serde_json::from_str(&outcome.stdout).unwrap()
}

#[test]
fn odd_scenes_are_answered_by_every_flag() {
    let scenario = SCENARIO.replace("5 cm^-1", "10 cm^-1");
    let three = scenario.replace(ALTERNATIVES, "[\"aluminium\", \"pmma\"]");
    let equilibrium = three.replace("37 degC", "20 degC").replace("lighting = 0.5", "lighting = 1");
    let found = answered("equilibrium", &equilibrium, &EVERYTHING);
    assert!(found["pairs"].as_array().unwrap().iter().all(|pair| pair["status"] == "equilibrium"));
    assert_eq!(found["matrix"]["apart"]["told_apart"], Value::Array(Vec::new()));
    assert_eq!(found["scaling"]["library"]["whole_library"], 0.0);
    assert_eq!(found["exact"]["pairs"][0]["limit"], 0.5);
    let said = refused(&equilibrium, &["--bands", "3"]);
    assert!(
        said.contains("not even all bands distinguish the target from any alternative; change the scene"),
        "{said}"
    );

    let black = three.replace("\"skin\"", "\"black.csv\"");
    let found = answered("black target", &black, &[&EVERYTHING[..], &["--bands", "3"]].concat());
    assert!(found["identifiability"]["distance_minimum"].as_f64().unwrap() > 0.0);

    let alone = three.replace("[[environment]]\ntemperature = \"20 degC\"\nlighting = 0.5\n", "");
    answered("no environment", &alone, &[&EVERYTHING[..], &["--filters", "3"]].concat());

    let same = scenario.replace("\"skin\"", "\"grey.csv\"").replace(ALTERNATIVES, "[\"grey2.csv\"]");
    let found = answered("identical materials", &same, &EVERYTHING);
    assert_eq!(found["pairs"][0]["status"], "identical");
    assert_eq!(found["matrix"]["apart"]["clusters"][0].as_array().unwrap().len(), 2);
    assert_eq!(found["identifiability"]["identifiable"], false);

    let unknown = |what: &str| three.replace("[camera]", &format!("[unknown]\n{what}\n[camera]"));
    let priors = unknown("priors = { temperature = \"1 K\", lighting = 0.1 }");
    let found = answered("priors", &priors, &[&EVERYTHING[..], &["--by", "local", "--average"]].concat());
    let side = |key: &str| found["prior_average"][key].as_f64().unwrap();
    assert!(
        side("photons_required_lower") > 0.0
            && side("photons_required_lower") <= side("photons_required_upper")
    );
    assert!(side("probability_lower") >= 0.5 && side("probability_lower") <= side("probability_upper"));
    let gain = unknown("nuisances = [\"temperature\", \"lighting\", \"gain\"]");
    answered("unknown gain", &gain, &[&EVERYTHING[..], &["--bands", "4"]].concat());
    let environment = unknown("nuisances = [\"temperature\", \"environment-temperature\"]");
    let found = answered("environment temperature", &environment, &["--matrix"]);
    assert!(found["pairs"][0]["nearest_state"]["environment_temperature_k"].is_array());
    answered("nothing unknown", &unknown("nuisances = []"), &[&EVERYTHING[..], &["--bands", "1"]].concat());

    let filters = three.replace("step = \"10 cm^-1\"", "filters = \"filters.csv\"");
    answered("filters", &filters, &[&EVERYTHING[..], &["--bands", "3", "--filters", "4"]].concat());
    let two = unknown("nuisances = [\"temperature\"]")
        .replace("step = \"10 cm^-1\"", "ranges = [[\"8 um\", \"10 um\"], [\"10 um\", \"14 um\"]]");
    let found = answered("two bands", &two, &[&EVERYTHING[..], &["--bands", "1", "--filters", "1"]].concat());
    assert_eq!(found["bands_that_matter"]["bands"]["distance"], 0.0);
    assert_eq!(found["bands_that_matter"]["bands"]["fewest"], 2);
    let one = two.replace("[\"temperature\"]", "[]").replace("[\"8 um\", \"10 um\"], ", "");
    answered("one band", &one, &[&EVERYTHING[..], &["--bands", "1"]].concat());
}

/// The drawing of all against all shows the distance that decides, without a camera as well.
#[test]
fn the_matrix_drawn_is_that_of_the_distance_that_decides() {
    let scenario = SCENARIO.replace(NO_CAMERA, "").replace(ALTERNATIVES, "[\"aluminium\", \"pmma\"]");
    for (by, key) in [
        ("nearest", "distance_nearest"),
        ("local", "distance_local"),
        ("local-unknown-gain", "distance_local_unknown_gain"),
    ] {
        let folder = Folder::with(&scenario);
        let result = folder.json(&["identify", "a.toml", "--matrix", "--by", by, "--out", "report"]);
        let drawn = fs::read_to_string(folder.path().join("report/distance_matrix.csv")).unwrap();
        let row = drawn.lines().nth(1).unwrap().split(',').skip(2);
        let pairs = result["pairs"].as_array().unwrap();
        for (cell, pair) in row.zip(pairs) {
            let (cell, expected) = (cell.parse::<f64>().unwrap(), pair[key].as_f64().unwrap());
            assert!((cell / expected - 1.0).abs() < 1e-8, "{by}: {cell:e} {expected:e}");
        }
    }
}

/// A hundred thousand bands by mistake in a unit: still an answer.
#[test]
fn a_hundred_thousand_bands_are_no_reason_to_give_up() {
    let scenario =
        SCENARIO.replace(STEP, "step = \"0.0053 cm^-1\"").replace(ALTERNATIVES, "[\"aluminium\", \"pmma\"]");
    let found =
        Folder::with(&scenario).json(&["identify", "a.toml", "--matrix", "--scaling", "--bands", "3"]);
    let bands: Vec<u64> =
        found["scaling"]["bands"]["bands"].as_array().unwrap().iter().map(|n| n.as_u64().unwrap()).collect();
    assert_eq!((bands[0], bands[bands.len() - 1]), (4, 100_944), "{bands:?}");
    // Found in the same scene with 536 bands; a step of 1 cm⁻¹ is fine enough for these smooth spectra.
    let distance = found["pairs"][0]["distance_nearest"].as_f64().unwrap();
    assert!((distance / 8.82e-4 - 1.0).abs() < 2e-3, "{distance:e}");
}
