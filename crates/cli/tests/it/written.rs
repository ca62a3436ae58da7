//! What is written, and where: folders that are the old report or the new one, whose they are, and one page of it all.

use crate::support::folder::{Folder, SCENARIO};
use crate::support::page::{Element, elements};
use crate::support::rules::rule;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

fn bytes(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap());
    entries.map(|e| (e.file_name().into_string().unwrap(), fs::read(e.path()).unwrap())).collect()
}

fn manifest(folder: &Path) -> Value {
    serde_json::from_slice(&fs::read(folder.join("hadar.json")).unwrap()).unwrap()
}

#[test]
fn a_folder_of_the_user_is_refused_and_stays_as_it_is() {
    let folder = Folder::with(SCENARIO);
    folder.file("scenario.toml", SCENARIO);
    folder.file("README.md", "mine");
    fs::create_dir(folder.path().join("old")).unwrap();
    folder.file("old/pairs.csv", "of a version without a manifest");
    let before = bytes_of_files(&folder);
    for arguments in [
        ["size", "scenario.toml", "--out", "."].as_slice(),
        &["identify", "scenario.toml", "--out", "."],
        &["rule", "scenario.toml", "--out", "."],
        &["size", "scenario.toml", "--out", "old"],
        &["materials", "plot", "gold", "--out", "old/pairs.csv"],
    ] {
        let said = folder.refusal(arguments);
        assert!(
            said.contains("name another folder") || said.contains("this is a file; name a folder"),
            "{said}"
        );
    }
    // Whoever means it keeps what is not in the way; an input is in nobody's way.
    let said = folder.refusal(&["size", "scenario.toml", "--out", ".", "--force"]);
    assert!(said.contains("`scenario.toml` in it is read by this run"), "{said}");
    assert_eq!(bytes_of_files(&folder), before);
    assert_eq!(folder.run(&["size", "a.toml", "--out", "old", "--force"]).code, 0);
    assert!(bytes(&folder.path().join("old")).contains_key("report.html"));
    // The report's own scenario is asked again into another folder.
    let said = folder.refusal(&["size", "old/scenario.toml", "--out", "old"]);
    assert!(said.contains("is read by this run"), "{said}");
    assert_eq!(folder.run(&["size", "old/scenario.toml", "--out", "new"]).code, 0);
}

fn bytes_of_files(folder: &Folder) -> Vec<(String, Option<Vec<u8>>)> {
    folder.files().into_iter().map(|name| (name.clone(), fs::read(folder.path().join(name)).ok())).collect()
}

#[test]
fn the_manifest_says_who_made_what_of_what() {
    let folder = Folder::with(&SCENARIO.replace("\"aluminium\"", "\"brass-rough\", \"own.csv\", \"lib\""));
    folder.file("own.csv", "wavenumber_cm1,emissivity\n600,0.5\n1400,0.6\n");
    folder.file("lib.csv", "wavenumber_cm1,lib,unused\n600,0.5,0.1\n1400,0.7,0.1\n");
    let ask = ["identify", "a.toml", "--library", "lib.csv", "--seed", "7", "--out"];
    for out in ["one", "two"] {
        let outcome =
            folder.run(&[ask.as_slice(), &[out, "--threads", if out == "one" { "1" } else { "2" }]].concat());
        assert_eq!(outcome.code, 0, "{}", outcome.stderr);
        assert!(outcome.stderr.contains(&format!("files to {out}/")), "{}", outcome.stderr);
        assert_eq!(fs::read_to_string(folder.path().join(out).join("answer.txt")).unwrap(), outcome.stdout);
    }
    let one = bytes(&folder.path().join("one"));
    assert!(
        one == bytes(&folder.path().join("two")),
        "the same program, command and inputs make the same bytes"
    );
    let made = manifest(&folder.path().join("one"));
    assert_eq!(made["hadar"], env!("CARGO_PKG_VERSION"));
    assert!(made["schema"].is_u64() && made["seed"] == 7);
    let command: Vec<&str> =
        made["command"].as_array().unwrap().iter().map(|word| word.as_str().unwrap()).collect();
    assert_eq!(command, ["hadar", "identify", "a.toml", "--library", "lib.csv", "--seed", "7"]);
    let commit = made["commit"].as_str().unwrap().trim_end_matches("-dirty");
    assert!(commit == "unknown" || commit.len() >= 7, "{commit}");
    let inputs: Vec<&str> =
        made["inputs"].as_array().unwrap().iter().map(|input| input["path"].as_str().unwrap()).collect();
    assert_eq!(
        inputs,
        [
            "a.toml",
            "lib.csv",
            "own.csv",
            "built-in: camera flir-a325sc",
            "built-in: material brass-rough",
            "built-in: material skin"
        ]
    );
    assert!(
        made["inputs"].as_array().unwrap().iter().all(|input| input["sha256"].as_str().unwrap().len() == 64)
    );
    // Every file but the list itself, and no other.
    let listed: Vec<&str> =
        made["files"].as_array().unwrap().iter().map(|f| f["name"].as_str().unwrap()).collect();
    assert_eq!(listed.len() + 1, one.len());
    assert!(listed.iter().all(|name| one.contains_key(*name)));
    // A spectrum that changes changes its hash, and no other.
    folder.file("own.csv", "wavenumber_cm1,emissivity\n600,0.5\n1400,0.61\n");
    assert_eq!(folder.run(&[ask.as_slice(), &["one"]].concat()).code, 0);
    let changed = manifest(&folder.path().join("one"));
    for (i, input) in inputs.iter().enumerate() {
        assert_eq!(made["inputs"][i] == changed["inputs"][i], *input != "own.csv", "{input}");
    }
}

#[test]
fn a_run_leaves_nothing_of_the_one_before() {
    let folder = Folder::with(SCENARIO);
    assert_eq!(folder.run(&["size", "a.toml", "--out", "out"]).code, 0);
    assert_eq!(folder.run(&["identify", "a.toml", "--out", "out"]).code, 0);
    let out = folder.path().join("out");
    let names: Vec<String> = bytes(&out).into_keys().collect();
    assert_eq!(names.len(), manifest(&out)["files"].as_array().unwrap().len() + 1, "{names:?}");
    for of_size in ["requirement.csv", "solve_for.csv", "sensitivity.csv"] {
        assert!(!names.iter().any(|name| name == of_size), "{names:?}");
    }
    // A library grows by what is imported.
    for name in ["a", "b"] {
        folder.file(&format!("{name}.csv"), "wavenumber_cm1,emissivity\n600,0.5\n1400,0.6\n");
        assert_eq!(folder.run(&["materials", "import", &format!("{name}.csv"), "--out", "lib"]).code, 0);
    }
    let names: Vec<String> = bytes(&folder.path().join("lib")).into_keys().collect();
    assert_eq!(names, ["a.csv", "b.csv", "hadar.json"]);
}

/// Killed by the system where a file exceeds so many blocks, the program leaves the old report, and the next run clears what is left
/// beside it. What it leaves between any two calls, `crates/report/src/folder/tests/killed.rs` tries.
#[test]
#[cfg(unix)]
fn a_killed_run_leaves_the_old_report_or_the_new_one() {
    use std::os::unix::process::ExitStatusExt as _;
    let folder = Folder::with(SCENARIO);
    let ask = |temperature: &str| {
        folder.file("a.toml", &SCENARIO.replace("37 degC", temperature).replace("5 cm^-1", "20 cm^-1"));
    };
    ask("37 degC");
    assert_eq!(folder.run(&["size", "a.toml", "--out", "out"]).code, 0);
    let old = bytes(&folder.path().join("out"));
    ask("36 degC");
    let limited = |blocks: u64| {
        let script = format!("ulimit -c 0; ulimit -f {blocks}; exec \"$0\" \"$@\"");
        let program = assert_cmd::cargo::cargo_bin!("hadar");
        let mut shell = Command::new("sh");
        shell.args(["-c", &script]).arg(program).args(["size", "a.toml", "--out", "out", "-q"]);
        shell.current_dir(folder.path()).stdout(Stdio::null()).stderr(Stdio::null()).status().unwrap()
    };
    let mut staging = Vec::new();
    for blocks in [0, 2, 8, 32] {
        let status = limited(blocks);
        assert!(status.signal().is_some(), "{blocks} blocks: {status}");
        assert!(bytes(&folder.path().join("out")) == old, "{blocks} blocks");
        let left = |name: &String| name.starts_with(".hadar-") && !name.contains('/');
        staging.push(folder.files().iter().filter(|name| left(name)).count());
    }
    // Each run cleared what the one before had left.
    assert_eq!(staging, [1; 4]);
    assert_eq!(limited(1 << 20).code(), Some(0));
    let (made, found) = (manifest(&folder.path().join("out")), bytes(&folder.path().join("out")));
    assert_eq!(made["files"].as_array().unwrap().len() + 1, found.len());
    assert!(found["scenario.toml"] != old["scenario.toml"] && found["report.html"] != old["report.html"]);
    let beside: Vec<String> = folder.files().into_iter().filter(|name| !name.starts_with("out")).collect();
    assert_eq!(beside, ["a.toml"]);
}

#[test]
fn every_json_says_its_version() {
    let folder = Folder::with(SCENARIO);
    folder.file("rule.toml", &rule("ideal-pnrd"));
    let range = "[scene]\nsize = [12, 40]\n[bands]\nstart = \"800 cm^-1\"\nstop = \"1200 cm^-1\"\nstep = \"100 cm^-1\"\n\
                 [camera]\npreset = \"flir-a325sc\"\n[stereo]\nbaseline = \"1 m\"\nwindow = [3, 3]\n";
    folder.file("range.toml", range);
    for arguments in [
        ["size", "a.toml"].as_slice(),
        &["size", "a.toml", "--no-skip"],
        &["identify", "a.toml"],
        &["identify", "a.toml", "--matrix", "--bands", "2"],
        &["rule", "rule.toml"],
        &[
            "simulate",
            "a.toml",
            "--spectra",
            "40",
            "--classifiers",
            "likelihood-ratio",
            "--save-models",
            "models",
        ],
        &["simulate", "a.toml", "--spectra", "4", "--thermometry", "300 K"],
        &["materials", "list"],
        &["materials", "show", "skin"],
        &["cameras", "list"],
        &["cameras", "show", "ideal-pnrd"],
        &["cameras", "compare", "ideal-pnrd", "flir-a325sc"],
    ] {
        let json = folder.json(arguments);
        assert_eq!(json["hadar"], env!("CARGO_PKG_VERSION"), "{arguments:?}");
        assert!(json["schema"].is_u64(), "{arguments:?}");
    }
    for (name, content) in bytes(&folder.path().join("models")) {
        let json: Value = serde_json::from_slice(&content).unwrap();
        assert!(json["hadar"].is_string() && json["schema"].is_u64(), "{name}");
    }
}

#[test]
fn what_writes_nothing_takes_no_folder() {
    let folder = Folder::with(SCENARIO);
    for arguments in [
        ["materials", "list"].as_slice(),
        &["materials", "show", "skin"],
        &["cameras", "list"],
        &["cameras", "show", "ideal-pnrd"],
        &["cameras", "compare", "ideal-pnrd", "flir-a325sc"],
    ] {
        let outcome = folder.run(&[arguments, &["--out", "out"]].concat());
        assert_eq!(outcome.code, 2, "{arguments:?}");
        assert!(
            outcome.stderr.contains("takes no `--out`; what takes it: size, identify"),
            "{}",
            outcome.stderr
        );
    }
    let said = folder.refusal(&["identify", "a.toml", "--check", "--out", "out"]);
    assert!(said.contains("has nothing to write into --out"), "{said}");
}

#[test]
fn a_check_is_a_line_a_camera() {
    let folder = Folder::with(&rule("ideal-pnrd\", \"flir-a325sc"));
    let outcome = folder.run(&["rule", "a.toml", "--check"]);
    assert_eq!(outcome.code, 3, "{}", outcome.stderr);
    let lines: Vec<&str> = outcome.stdout.lines().collect();
    assert_eq!(lines.len(), 2, "{}", outcome.stdout);
    assert!(
        lines[0].starts_with("ideal-pnrd: yes, if ")
            && lines[0].contains("calibrated): proved: at least ")
            && lines[0].ends_with(" times the demand everywhere"),
        "{}",
        lines[0]
    );
    assert!(
        lines[1].starts_with("flir-a325sc: not met: 0.")
            && lines[1].ends_with("it cannot distinguish skin from aluminium"),
        "{}",
        lines[1]
    );
    let json = folder.json(&["rule", "a.toml"]);
    let (bound, required) = (&json["cameras"][0]["lower_bound"], &json["requirement"]["distance"]);
    let proved = bound.as_f64().unwrap() / required.as_f64().unwrap();
    let (_, said) = lines[0].split_once("at least ").unwrap();
    let said: f64 = said.split(' ').next().unwrap().parse().unwrap();
    // A check ends at the first bound that decides.
    assert!((1.0..=proved).contains(&said), "{said} of {proved}");
}

#[test]
fn models_and_report_have_a_folder_each() {
    let folder = Folder::with(SCENARIO);
    let ask = [
        "simulate",
        "a.toml",
        "--spectra",
        "40",
        "--classifiers",
        "likelihood-ratio",
        "--out",
        "out",
        "--save-models",
    ];
    let said = folder.refusal(&[ask.as_slice(), &["./out"]].concat());
    assert!(said.contains("name one folder"), "{said}");
    for _ in 0..2 {
        assert_eq!(folder.run(&[ask.as_slice(), &["out/models"]].concat()).code, 0);
    }
    let out = folder.path().join("out");
    assert!(out.join("models/hadar.json").exists() && out.join("report.html").exists());
}

fn names_of<'e>(page: &'e [Element], attribute: &str) -> Vec<&'e str> {
    page.iter().filter_map(|element| element.attributes.get(attribute)).map(String::as_str).collect()
}

/// Read strictly, the page is well formed, needs nothing from elsewhere, and everything in it has a name.
#[test]
fn the_page_is_one_file_that_anyone_can_read() {
    let evil = "<script>alert(1)</script> & \\\"quotes\\\"";
    let scenario = format!("title = \"{evil}\"\n{SCENARIO}");
    let folder = Folder::with(&scenario);
    let with_rule = format!("{}[rule]\nname = \"{evil}\"\n", rule("flir-a325sc"));
    folder.file("rule.toml", &with_rule);
    for (arguments, pictures) in [
        (["size", "a.toml"].as_slice(), 6),
        (&["identify", "a.toml", "--matrix", "--bands", "2"], 3),
        (&["rule", "rule.toml"], 1),
        (&["simulate", "a.toml", "--spectra", "40", "--classifiers", "likelihood-ratio"], 1),
        (&["materials", "plot", "gold", "brass"], 1),
    ] {
        let outcome = folder.run(&[arguments, &["--out", "out"]].concat());
        assert_eq!(outcome.code, 0, "{}", outcome.stderr);
        let whole = fs::read_to_string(folder.path().join("out/report.html")).unwrap();
        // Its one script is the program's own, which asks nobody for anything.
        let (before, after) = whole.split_once("<script>\n").unwrap();
        let (script, after) = after.split_once("</script>\n").unwrap();
        assert!(
            script.strip_prefix(hadar_report::READINGS).is_some_and(|call| call.lines().count() == 1),
            "{script}"
        );
        for asks in ["fetch", "XMLHttpRequest", "import", "eval", "innerHTML", ".src", ".href", "location"] {
            assert!(!script.contains(asks), "{asks}");
        }
        let text = format!("{before}{after}");
        let page = elements(&text);
        let all = |name: &str| page.iter().filter(|element| element.name == name).collect::<Vec<_>>();
        assert!(
            all("script").is_empty() && !text.contains("http://") && !text.contains("url("),
            "{arguments:?}"
        );
        for attribute in ["href", "src"] {
            for target in names_of(&page, attribute) {
                assert!(target.starts_with('#') || target.starts_with("data:image/png;base64,"), "{target}");
            }
        }
        let ids = names_of(&page, "id");
        let mut once = ids.clone();
        once.sort_unstable();
        once.dedup();
        assert_eq!(once.len(), ids.len(), "{ids:?}");
        for reference in names_of(&page, "aria-labelledby") {
            let named =
                page.iter().find(|element| element.attributes.get("id").is_some_and(|id| id == reference));
            assert!(named.is_some_and(|element| !element.text.is_empty()), "{arguments:?}: {reference}");
        }
        assert!(all("svg").len() >= pictures, "{arguments:?}: {}", all("svg").len());
        for svg in all("svg") {
            assert!(svg.attributes.contains_key("aria-labelledby") && svg.attributes["role"] == "img");
        }
        assert_eq!(all("table").len(), all("caption").len());
        assert!(all("th").iter().all(|head| head.attributes.contains_key("scope")));
        assert_eq!((all("h1").len(), all("html")[0].attributes["lang"].as_str()), (1, "en"));
        let sections: Vec<&str> =
            all("section").iter().map(|section| section.attributes["id"].as_str()).collect();
        assert_eq!(sections.last(), Some(&"provenance"), "{sections:?}");
        if arguments[0] == "size" {
            let expected = [
                "assumptions",
                "pictures",
                "answer",
                "warnings",
                "more-pictures-section",
                "tables-section",
                "question-section",
                "provenance",
            ];
            assert_eq!(sections, expected);
            // What the warning means and what to do, which no text says.
            assert!(text.contains("What to do:"));
            let verdict = outcome.stdout.lines().next().unwrap();
            assert!(text.contains(&verdict.replace('\'', "&#39;")), "{verdict}");
            fs::remove_dir_all(folder.path().join("out")).unwrap();
            continue;
        }
        fs::remove_dir_all(folder.path().join("out")).unwrap();
    }
}
