//! The program explains itself: keys, warnings, answers, commands; the schema of its files; files to begin with.

use crate::support::documented;
use crate::support::folder::{Folder, SCENARIO};
use hadar_report::explain;
use hadar_report::words::warnings;
use hadar_scenario::keys::{self, Silent, Value};
use hadar_study::warning::Code;
use serde_json::Value as Json;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What stands in `results.tsv` is what the fields say in the sources; `HADAR_WRITE=1` writes it anew.
#[test]
fn keys_of_answers_are_told_as_in_the_sources() {
    let path = hadar_testing::repository().join("crates/report/src/explain/results.tsv");
    let told = documented::keys();
    if std::env::var_os("HADAR_WRITE").is_some() {
        fs::write(&path, &told).unwrap();
    }
    let written = fs::read_to_string(&path).unwrap();
    assert!(told == written, "run this test with HADAR_WRITE=1 in the environment, and commit results.tsv");
}

/// An explanation is a sentence that says what the number is, and of what: 'Which ones.' is none.
#[test]
fn no_explanation_is_of_fewer_than_five_words() {
    let short: Vec<_> = explain::results().filter(|one| one.meaning.split_whitespace().count() < 5).collect();
    assert!(short.is_empty(), "write out the documentation of these fields: {short:#?}");
}

/// Tables whose keys are names of somebody's own: materials, reasons, files.
const NAMES: [&str; 9] =
    ["classes", "confusion", "elasticities", "hues", "scenario", "rule", "decisions", "priors", "solve_for"];

fn walk(value: &Json, path: &str, found: &mut BTreeSet<(String, String)>) {
    match value {
        Json::Object(entries) => {
            let own = NAMES.iter().any(|name| path.ends_with(&format!(".{name}")));
            for (key, value) in entries {
                if !own {
                    found.insert((key.clone(), path.to_owned()));
                }
                let is_of_choice = path.starts_with("find.") && key == "scenario";
                if !is_of_choice && (!["scenario", "rule"].contains(&key.as_str()) || path.contains('.')) {
                    walk(value, &format!("{path}.{key}"), found);
                }
            }
        }
        Json::Array(items) => items.iter().take(20).for_each(|item| walk(item, path, found)),
        _ => {}
    }
}

const RULE: &str = "cameras = [\"flir-a325sc\", \"ideal-pnrd\"]\n[target]\nmaterial = \"skin\"\ntemperature = \"33 degC\"\n\
    [[environment]]\ntemperature = \"10 degC\"\nlighting = 0.5\n[alternatives]\nmaterials = [\"aluminium\"]\n[bands]\nstep = \"20 cm^-1\"\n\
    [envelope]\ntemperature = [\"30 degC\", \"36 degC\"]\n[stop]\nspeed = \"10 km/h\"\nlatency = \"0.5 s\"\ndeceleration = \"5 m/s^2\"\n";

#[test]
fn every_key_of_real_answers_is_explained() {
    let folder = Folder::with(SCENARIO);
    folder.file("rule.toml", RULE);
    let mut found = BTreeSet::new();
    let mut see = |arguments: &[&str]| walk(&folder.json(arguments), arguments[0], &mut found);
    see(&["size", "a.toml"]);
    see(&["identify", "a.toml", "--matrix", "--exact", "--scaling", "--half-width", "0.05"]);
    see(&["rule", "rule.toml", "--on", "2026-01-01"]);
    see(&["cameras", "list"]);
    see(&["cameras", "show", "flir-a325sc"]);
    see(&["cameras", "compare", "flir-a325sc", "nicolet-is50"]);
    see(&["materials", "list"]);
    see(&["materials", "show", "skin"]);
    see(&["simulate", "a.toml", "--spectra", "200", "--photons", "100"]);
    let priors = "[unknown]\npriors = { temperature = \"1 K\", lighting = 0.1 }\n[camera]";
    folder.file("priors.toml", &SCENARIO.replace("[camera]", priors));
    see(&["identify", "priors.toml", "--average"]);
    see(&["simulate", "priors.toml", "--average", "--spectra", "50"]);
    see(&["simulate", "a.toml", "--thermometry", "30 degC..40 degC", "--spectra", "50"]);
    see(&["explain", "temperature"]);
    see(&["explain"]);
    see(&["init", "find"]);
    let question = fs::read_to_string(folder.path().join("find.toml")).unwrap();
    for (name, camera) in [("meets.toml", "flir-boson-plus-640"), ("fails.toml", "flir-boson-320")] {
        folder.file(name, &question.replace("\"*\"", &format!("{camera:?}")));
        see(&["find", name]);
    }
    see(&["init", "range"]);
    see(&["init", "air"]);
    see(&["init", "decompose"]);
    see(&["init", "library"]);
    // Smaller pictures have the same keys.
    for (file, size) in [("range.toml", "size = [90, 120]"), ("scene.toml", "size = [60, 80]")] {
        let path = folder.path().join(file);
        let text = fs::read_to_string(&path).unwrap();
        assert!(text.contains(size), "{text}");
        fs::write(path, text.replace(size, "size = [24, 32]")).unwrap();
    }
    see(&["range", "range.toml"]);
    see(&["range", "air.toml"]);
    see(&["render", "scene.toml", "--out", "scene"]);
    see(&["decompose", "decompose.toml"]);
    see(&["library", "library.toml"]);
    see(&["render", "scene.toml", "--out", "again", "--seed", "2"]);
    see(&["calibrate", "noise", "scene/counts.npy", "again/counts.npy"]);
    see(&["calibrate", "stripes", "scene/counts.npy"]);
    let known: BTreeSet<&str> = explain::results().map(|one| one.key).collect();
    let unknown: Vec<_> = found.iter().filter(|(key, _)| !known.contains(key.as_str())).collect();
    assert!(found.len() > 500, "{}", found.len());
    assert!(unknown.is_empty(), "no explanation in results.tsv or named.tsv: {unknown:?}");
}

#[test]
fn every_word_is_explained() {
    let folder = Folder::with(SCENARIO);
    for (word, said) in [
        ("target.temperature", "above 0 K (-273.15 degC)"),
        ("noise_bandwidth", "noise power NEP sqrt(bandwidth)"),
        ("lighting_total", "constraint on V (S48)"),
        ("priors", "prior information"),
        ("[envelope]", "surroundings"),
        ("environment[0].lighting", "they add up to at most 1"),
        ("nearest-at-edge", "requirement"),
        ("rule", "hadar rule: Which cameras meet a rule"),
        ("calibrate noise", "hadar calibrate noise"),
        ("distance_nearest", "Nearest distance of the two materials, per"),
        ("temperature resolution", "NETD\n  means      Noise-equivalent temperature difference"),
        ("V", "thermal lighting factor, V_k\n"),
        ("s29", "S29\n"),
        ("cramer-rao bound", "Smallest variance that any unbiased estimator can have"),
    ] {
        let outcome = folder.run(&["explain", word]);
        assert_eq!((outcome.code, outcome.stderr.as_str()), (0, ""), "{word}");
        if word != "nearest-at-edge" {
            assert!(outcome.stdout.contains(said), "{word}: {}", outcome.stdout);
        }
        assert_eq!(folder.json(&["explain", word])["word"], word);
    }
    let code = Code::NearestAtEdge;
    assert!(folder.run(&["explain", code.name()]).stdout.contains(warnings::of_code(code).remedy));
    let shown = folder.json(&["explain", "camera.noise_bandwidth"]);
    assert_eq!(shown["keys"][0]["paths"][0], "camera.noise_bandwidth");
    assert_eq!(shown["keys"][0]["example"], "noise_bandwidth = \"175 kHz\"");
    let line = folder.refusal(&["explain", "noise_bandwith"]);
    assert!(line.contains("`noise_bandwidth`"), "{line}");
    let line = folder.refusal(&["explain", "NETTD"]);
    assert!(line.contains("`NETD`"), "{line}");
    let line = folder.refusal(&["explain", "size.toml"]);
    assert_eq!(line.matches("`size`").count(), 1, "{line}");
    let line = folder.refusal(&["explain", "!!!"]);
    assert!(line.contains("`hadar explain` gives an overview"), "{line}");
    let demand = folder.json(&["explain", "clause.requirement"]);
    let inside = demand["keys"][0]["inside"].to_string();
    assert!(inside.contains("detection_probability") && inside.contains("depth_error"), "{inside}");
    let all = folder.run(&["explain"]).stdout;
    assert!(all.contains("hadar size, identify, simulate") && all.contains("stand_in"), "{all}");
}

#[test]
fn all_of_it_is_what_is_said_of_each() {
    let folder = Folder::with(SCENARIO);
    let (reference, text) = (folder.json(&["explain", "--all"]), folder.run(&["explain", "--all"]).stdout);
    let items = |part: &str| reference[part].as_array().unwrap().clone();
    assert_eq!(items("keys").len(), keys::all().len());
    assert_eq!(items("warnings").len(), Code::ALL.len());
    assert_eq!(items("results").len(), explain::results().count());
    for (key, word) in items("keys").iter().step_by(29).map(|key| (key, key["paths"][0].as_str().unwrap())) {
        let alone = folder.json(&["explain", word]);
        assert!(alone["keys"].as_array().unwrap().contains(key), "{word}");
        assert!(text.contains(&format!("\n{word}\n  means      {}\n", key["meaning"].as_str().unwrap())));
    }
    assert_eq!(items("terms").len(), explain::terms().count());
    for part in ["terms", "keys", "warnings", "results"] {
        let told = items(part).iter().all(|item| {
            let meaning = item["meaning"].as_str().unwrap();
            text.contains(meaning)
        });
        assert!(told, "{part}");
    }
    let silent = |path: &str| {
        let key = items("keys").into_iter().find(|key| key["paths"][0] == path).unwrap();
        [key["required"].clone(), key["default"].clone(), key["silent"].clone()]
    };
    assert_eq!(silent("target.temperature"), [true.into(), Json::Null, Json::Null]);
    assert_eq!(silent("title"), [false.into(), Json::Null, "no heading".into()]);
    let outcome = folder.run(&["explain", "--all", "skin"]);
    assert_eq!(outcome.code, 2, "{}", outcome.stderr);
}

#[test]
fn explanations_in_words() {
    let folder = Folder::with(SCENARIO);
    for (name, word) in [("key", "target.temperature"), ("table", "envelope"), ("code", "nearest-at-edge")] {
        let outcome = folder.run(&["explain", word]);
        insta::assert_snapshot!(format!("explain_{name}"), outcome.stdout);
    }
}

#[test]
fn every_key_has_all_that_is_to_be_said() {
    let all = keys::all();
    assert!(all.len() > 250, "{}", all.len());
    for place in &all {
        let key = place.key;
        let path = &place.paths[0];
        assert!(key.meaning.ends_with(['.', ')']), "{path}");
        assert!(!key.enters.is_empty() && !key.example.is_empty() && !place.commands.is_empty(), "{path}");
        assert!(!key.enters.ends_with('.'), "{path}");
        if let Silent::Is(value) = key.silent {
            toml::from_str::<toml::Table>(&format!("{} = {value}", key.name)).unwrap();
        }
    }
}

/// Python's own validator, or a line that it is not there.
fn is_valid(schema: &Path, files: &[PathBuf], wrong: &[PathBuf]) {
    let program = "import json, sys, tomllib, jsonschema\n\
        schema = json.load(open(sys.argv[1]))\n\
        jsonschema.Draft202012Validator.check_schema(schema)\n\
        check = jsonschema.Draft202012Validator(schema)\n\
        half = sys.argv.index('--')\n\
        load = lambda path: json.loads(json.dumps(tomllib.load(open(path, 'rb')), default=str))\n\
        for path in sys.argv[2:half]:\n\
        \x20   errors = [e for error in check.iter_errors(load(path)) for e in [error, *(error.context or [])]]\n\
        \x20   assert not errors, (path, [(list(e.absolute_path), e.message[:200]) for e in errors])\n\
        for path in sys.argv[half + 1:]:\n\
        \x20   assert list(check.iter_errors(load(path))), 'accepted: ' + open(path).read()\n";
    let there = Command::new("python3").args(["-c", "import jsonschema, tomllib"]).output();
    if !there.is_ok_and(|there| there.status.success()) {
        println!("skipped: there is no python3 with jsonschema and tomllib");
        return;
    }
    let mut command = Command::new("python3");
    command.args(["-c", program]).arg(schema).args(files).arg("--").args(wrong);
    let ran = command.output().unwrap();
    assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stderr));
}

fn toml_files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            toml_files(&path, found);
        } else if path.extension().is_some_and(|end| end == "toml") {
            found.push(path);
        }
    }
}

#[test]
fn the_schema_holds_for_all_files_there_are_and_not_for_wrong_ones() {
    let root = hadar_testing::repository();
    let mut files = Vec::new();
    for folder in ["examples", "rules", "reports"] {
        toml_files(&root.join(folder), &mut files);
    }
    assert!(files.len() > 40, "{}", files.len());
    let folder = Folder::with(SCENARIO);
    let schema = folder.file("schema.json", &folder.run(&["schema"]).stdout);
    let wrong: Vec<PathBuf> = [
        SCENARIO.replace("temperature = \"37 degC\"", "temperatur = \"37 degC\""),
        SCENARIO.replace("\"37 degC\"", "\"37 kg\""),
        format!("{SCENARIO}pixel = \"12 xm\"\n"),
        SCENARIO.replace("\"37 degC\"", "37"),
        SCENARIO.replace("0.5", "1.5"),
        SCENARIO.replace("0.5", "\"0.5\""),
        SCENARIO.replace("[\"aluminium\"]", "\"aluminium\""),
        SCENARIO.replace("material = \"skin\"\n", ""),
        format!("{SCENARIO}readout = \"sequentially\"\n"),
        format!("{SCENARIO}frames = 0\n"),
        format!("{SCENARIO}[unknown]\nnuisances = [\"temperatures\"]\n"),
        format!("{SCENARIO}[unknown.priors]\ntemperature = 2\n"),
        RULE.replace("\"10 km/h\"", "\"10 km\""),
        RULE.replace("latency = \"0.5 s\"\n", ""),
    ]
    .iter()
    .enumerate()
    .map(|(index, text)| {
        assert!(text != SCENARIO && text != RULE, "{index}");
        folder.file(&format!("wrong_{index}.toml"), text)
    })
    .collect();
    // Whatever looks like micro.
    files.extend(["12 um", "12\u{b5}m", "12 \u{3bc}m"].iter().enumerate().map(|(index, pixel)| {
        folder.file(&format!("micro_{index}.toml"), &format!("{SCENARIO}pixel = \"{pixel}\"\n"))
    }));
    is_valid(&schema, &files, &wrong);
    let of_rules = folder.file("rule.json", &folder.run(&["schema", "rule"]).stdout);
    let mut rules = Vec::new();
    toml_files(&root.join("rules"), &mut rules);
    is_valid(
        &of_rules,
        &rules,
        &[folder.path().join("a.toml")].map(|path| {
            let text = fs::read_to_string(&path).unwrap();
            folder.file("other.toml", &format!("cube = 1\n{text}"))
        }),
    );
    let outcome = folder.run(&["schema", "sizes"]);
    assert!(
        outcome.code == 2 && outcome.stderr.contains("similar value exists: 'size'"),
        "{}",
        outcome.stderr
    );
}

/// The words that a choice takes are read; a quantity and a number that are written as the example are.
#[test]
fn examples_are_what_the_reader_takes() {
    for place in keys::all() {
        let key = place.key;
        if key.value.table().is_some() || key.example.contains(" or ") {
            continue;
        }
        let text = format!("{} = {}", key.name, key.example);
        let table: toml::Table = toml::from_str(&text).unwrap_or_else(|error| panic!("{text}: {error}"));
        let value = &table[key.name];
        match key.value {
            Value::Quantity(dimension, allowed) => {
                let number = dimension.parse(value.as_str().unwrap()).unwrap();
                assert!(allowed.allows(number), "{text}");
            }
            Value::Number(allowed) | Value::NumberOrFile(allowed) => {
                let number = value.as_float().or(value.as_integer().map(|whole| whole as f64)).unwrap();
                assert!(allowed.allows(number), "{text}");
            }
            Value::Count([least, most]) => {
                let whole = u32::try_from(value.as_integer().unwrap()).unwrap();
                assert!((least..=most).contains(&whole), "{text}");
            }
            Value::Flag => assert!(value.is_bool(), "{text}"),
            Value::Choice(names) => assert!(names.contains(&value.as_str().unwrap()), "{text}"),
            Value::Pair(_) => assert_eq!(value.as_array().map(Vec::len), Some(2), "{text}"),
            Value::List(_) => assert!(value.is_array(), "{text}"),
            _ => {}
        }
    }
}

#[test]
fn templates_run_as_they_are_and_nothing_is_overwritten() {
    for (command, head) in [
        ("size", "No: "),
        ("identify", "No: "),
        ("rule", "1 of 2 cameras meets the rule"),
        ("range", "Yes, if "),
        ("air", "Yes, if "),
        ("render", "Rendered one view"),
        ("decompose", "of 4 800 pixels"),
        ("library", "emissivities found in 4 800 pixels"),
    ] {
        let folder = Folder::with(SCENARIO);
        let written = folder.json(&["init", command]);
        let mut last = String::new();
        for line in written["commands"].as_array().unwrap() {
            let arguments: Vec<&str> = line.as_str().unwrap().split(' ').skip(1).collect();
            let outcome = folder.run(&arguments);
            assert_eq!(outcome.code, 0, "{command}: {line}: {}", outcome.stderr);
            last = outcome.stdout;
        }
        assert!(last.lines().next().is_some_and(|line| line.contains(head)), "{command}: {last}");
        let line = folder.refusal(&["init", command]);
        assert!(line.contains("there is such a file"), "{line}");
        // The comments are those of the table.
        let file = written["files"].as_array().unwrap().last().unwrap().as_str().unwrap();
        let text = fs::read_to_string(folder.path().join(file)).unwrap();
        let keys = text.lines().filter(|line| !line.starts_with(['#', '[']) && line.contains(" = ")).count();
        let comments = text.lines().filter(|line| line.starts_with('#')).count();
        assert!(comments >= keys, "{text}");
    }
    let folder = Folder::with(SCENARIO);
    folder.json(&["init", "simulate", "mine.toml"]);
    let outcome = folder.run(&["simulate", "mine.toml", "--spectra", "200"]);
    assert!(
        outcome.code == 0 && outcome.stdout.contains("No classifier beats the limit"),
        "{}",
        outcome.stdout
    );
}
