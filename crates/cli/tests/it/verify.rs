//! Reports made again: those of every command are the same, byte by byte, and nothing that is changed in one goes unseen.

use crate::support::folder::{Folder, SCENARIO};
use hadar_testing::repository;
use std::fs;
use std::path::Path;

/// What a report says that it was made by, and what it has in its folder.
const COMMANDS: &[&[&str]] = &[
    &["size", "a.toml"],
    &["size", "completed.toml", "--set", "camera.frames=8"],
    &["size", "../work/a.toml", "--library", "mine"],
    &["identify", "a.toml", "--matrix"],
    &["identify", "a.toml", "--seed", "3", "--by", "local"],
    &["simulate", "a.toml", "--spectra", "40"],
    &["range", "examples/street.toml", "--set", "scene.size=[48, 64]", "--set", "stereo.lines=[30]"],
    &["materials", "plot", "skin"],
    &["sweep", "a.toml", "--vary", "target.distance=5 m,6 m", "--columns", "verdict"],
    &["rule", "examples/stand_in.toml"],
    &["rule", "examples/rule_delivery_robots_at_night.toml"],
];

fn work() -> (Folder, String) {
    let folder = Folder::with("");
    for part in ["work/mine", "work/examples"] {
        fs::create_dir_all(folder.path().join(part)).unwrap();
    }
    // Found by its content, by which it is no other test's.
    let own = format!("{SCENARIO}# {}\n", folder.path().display());
    folder.file("work/a.toml", &own);
    folder.file("work/mine/own.csv", "wavenumber_cm1,emissivity\n500,0.5\n2000,0.6\n");
    // A camera that is completed by figures that nobody states.
    let completed = "preset = \"flir-boson-640-14mm\"\nf_number = 1.0\nreadout = \"sequential\"\n";
    folder.file("work/completed.toml", &SCENARIO.replace("preset = \"flir-a325sc\"\n", completed));
    for example in ["street.toml", "stand_in.toml", "rule_delivery_robots_at_night.toml"] {
        fs::copy(
            repository().join("examples").join(example),
            folder.path().join("work/examples").join(example),
        )
        .unwrap();
    }
    let home = folder.path().join("work").to_str().unwrap().to_owned();
    (folder, home)
}

/// Makes a report from the folder `work`, where its files are named from.
fn made(folder: &Folder, command: &[&str], out: &Path) {
    let mut program = assert_cmd::Command::new(crate::PROGRAM);
    let program = program.current_dir(folder.path().join("work")).args(command).arg("--out").arg(out);
    let output = program.output().unwrap();
    assert!(output.status.success(), "{command:?}: {}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn the_report_of_every_command_is_made_again_byte_by_byte() {
    let (folder, _) = work();
    for (index, command) in COMMANDS.iter().enumerate() {
        let out = folder.path().join(format!("work/report-{index}"));
        made(&folder, command, &out);
        // From another folder: its inputs are found near by.
        let outcome = folder.run(&["verify", out.to_str().unwrap()]);
        assert!(outcome.code == 0, "{command:?}: {}{}", outcome.stdout, outcome.stderr);
        assert!(outcome.stdout.starts_with("Verified: all "), "{}", outcome.stdout);
    }
    // Found without being told where.
    let said = folder.json(&["verify", "work/report-0"]);
    assert_eq!((&said["verified"], &said["inputs"]), (&true.into(), &4.into()), "{said}");
    // Away from its inputs a report has its own scenario.
    fs::rename(folder.path().join("work/report-0"), folder.path().join("alone")).unwrap();
    let rule = COMMANDS.iter().position(|command| command[1].starts_with("examples/rule")).unwrap();
    fs::rename(folder.path().join(format!("work/report-{rule}")), folder.path().join("rule")).unwrap();
    fs::remove_dir_all(folder.path().join("work")).unwrap();
    // A rule has it with its sources, and so its hash.
    let said = folder.json(&["verify", "rule"]);
    assert_eq!((&said["verified"], &said["inputs"]), (&true.into(), &12.into()), "{said}");
    let outcome = folder.run(&["rule", "--verify", "rule/certificate.json"]);
    assert!(outcome.code == 0, "{}", outcome.stderr);
    // Nor is another one taken for it because the list of the report was changed as well.
    let [copy, list] = ["rule/rule_as_read.toml", "rule/hadar.json"].map(|name| folder.path().join(name));
    let (before, listed) = (fs::read_to_string(&copy).unwrap(), fs::read_to_string(&list).unwrap());
    let after = before.clone() + "# 1\n";
    fs::write(&copy, &after).unwrap();
    assert_eq!(folder.run(&["verify", "rule"]).code, 1);
    let mut forged: serde_json::Value = serde_json::from_str(&listed).unwrap();
    let files = forged["files"].as_array_mut().unwrap();
    let own = files.iter_mut().find(|file| file["name"] == "rule_as_read.toml").unwrap();
    own["sha256"] = hadar_report::manifest::sha256(after.as_bytes()).into();
    fs::write(&list, serde_json::to_string_pretty(&forged).unwrap() + "\n").unwrap();
    assert_eq!(folder.run(&["verify", "rule"]).code, 1);
    fs::write(folder.path().join("rule.toml"), &before).unwrap();
    assert_eq!(folder.run(&["verify", "rule", "--inputs", "."]).code, 1);
    assert_eq!(folder.run(&["rule", "--verify", "rule/certificate.json"]).code, 1);
    let said = folder.json(&["verify", "alone"]);
    assert_eq!((&said["verified"], &said["inputs"]), (&true.into(), &3.into()), "{said}");
    assert_eq!(said["question_compared"], false);
    assert!(folder.run(&["verify", "alone"]).stdout.contains("the file of the question is not here"));
}

/// Whatever file of a report is changed, alone or with its hash in the list, and whatever it rests on.
#[test]
fn nothing_that_is_changed_goes_unseen() {
    let (folder, home) = work();
    let command = ["size", "a.toml", "--library", "mine", "--set", "alternatives.materials=[\"own\"]"];
    let out = folder.path().join("work/report");
    made(&folder, &command, &out);
    let verified = || folder.run(&["verify", out.to_str().unwrap(), "--inputs", &home]);
    assert_eq!(verified().code, 0);
    let list = out.join("hadar.json");
    let written = fs::read_to_string(&list).unwrap();
    let whole: serde_json::Value = serde_json::from_str(&written).unwrap();
    let is_seen = |what: &str, part: &str| {
        let outcome = verified();
        assert_eq!(outcome.code, 1, "{what}: {}", outcome.stdout);
        let said = outcome.stdout + &outcome.stderr;
        assert!(said.contains(part), "{what}: {said}");
        assert!(!said.contains("Verified"), "{what}: {said}");
    };
    let put = |list_now: &serde_json::Value| {
        fs::write(&list, serde_json::to_string_pretty(list_now).unwrap() + "\n").unwrap();
    };
    for (index, file) in whole["files"].as_array().unwrap().iter().enumerate() {
        let name = file["name"].as_str().unwrap();
        let path = out.join(name);
        let before = fs::read(&path).unwrap();
        // A comment, where it would be read.
        let after = [&before[..], b"# 1\n"].concat();
        fs::write(&path, &after).unwrap();
        is_seen(name, &format!("{name}: it was changed since"));
        // Every kind of file there is, not every one.
        if index % 4 != 0 && !["answer.txt", "scenario.toml", "report.html"].contains(&name) {
            fs::write(&path, before).unwrap();
            continue;
        }
        let forged = hadar_report::manifest::sha256(&after);
        fs::write(&list, written.replace(file["sha256"].as_str().unwrap(), &forged)).unwrap();
        is_seen(name, &format!("{name}: made again it has another content"));
        fs::write(&path, before).unwrap();
        let mut forged = whole.clone();
        forged["files"].as_array_mut().unwrap().remove(index);
        put(&forged);
        is_seen(name, &format!("{name}: the command makes it, and the report does not list it"));
        fs::write(&list, &written).unwrap();
    }
    assert_eq!(verified().code, 0);
    // A copy of another question, and all that follows from it, under the name and hash of the one near by.
    let other = folder.path().join("work/other.toml");
    let own = fs::read_to_string(folder.path().join("work/a.toml")).unwrap();
    fs::write(&other, own.clone() + "# other\n[sensitivity]\nemissivity_error = 0.01\n").unwrap();
    let forged = folder.path().join("work/forged");
    made(
        &folder,
        &["size", "other.toml", "--library", "mine", "--set", "alternatives.materials=[\"own\"]"],
        &forged,
    );
    let hash = |text: &str| hadar_report::manifest::sha256(text.as_bytes());
    let lies = |text: String| {
        let other = fs::read_to_string(&other).unwrap();
        text.replace(&hash(&other), &hash(&own)).replace("other.toml", "a.toml")
    };
    let page = lies(fs::read_to_string(forged.join("report.html")).unwrap());
    let was = hash(&fs::read_to_string(forged.join("report.html")).unwrap());
    let text = lies(fs::read_to_string(forged.join("hadar.json")).unwrap()).replace(&was, &hash(&page));
    fs::write(forged.join("report.html"), page).unwrap();
    fs::write(forged.join("hadar.json"), text).unwrap();
    let outcome = folder.run(&["verify", forged.to_str().unwrap(), "--inputs", &home]);
    assert!(
        outcome.code == 1 && outcome.stdout.starts_with("Not verified"),
        "{}{}",
        outcome.stdout,
        outcome.stderr
    );
    // What the list says of the program, of the command and of what it rests on.
    for (key, value, part) in [
        ("seed", serde_json::json!(2), ""),
        ("command", serde_json::json!(["hadar", "size", "a.toml"]), ""),
        (
            "command",
            serde_json::json!(["hadar", "size", "a.toml", "--out", "x"]),
            "which a report never does",
        ),
        ("command", serde_json::json!(["hadar", "serve", "--port", "1"]), "cannot be given again"),
        ("command", serde_json::json!(["hadar", "rule", "--verify", "x"]), "cannot be given again"),
        (
            "command",
            serde_json::json!(["hadar", "simulate", "a.toml", "--save-models", "x"]),
            "cannot be given again",
        ),
        ("command", serde_json::json!(["sh", "-c", "touch x"]), "is none of this program"),
        ("command", serde_json::json!([]), "is none of this program"),
        ("inputs", serde_json::json!([]), "input a.toml: its SHA-256 was none"),
    ] {
        let mut forged = whole.clone();
        forged[key] = value;
        put(&forged);
        is_seen(key, part);
    }
    assert!(!folder.path().join("work/x").exists());
    for (from, to) in [
        ("\"schema\": 2", "\"schema\": 1"),
        ("\"seed\"", "\"more\": \"PASSED\",\n  \"seed\""),
        ("\n}", "\n} "),
    ] {
        assert!(written.contains(from));
        fs::write(&list, written.replace(from, to)).unwrap();
        is_seen(to, "hadar.json: made again it has another content");
    }
    fs::write(&list, &written).unwrap();
    fs::write(folder.path().join("work/mine/own.csv"), "wavenumber_cm1,emissivity\n500,0.5\n2000,0.7\n")
        .unwrap();
    is_seen("a spectrum", "input mine/own.csv: its SHA-256 was ");
    let refusal = folder.refusal(&["verify", "work"]);
    assert!(
        refusal.contains("there is no report in this folder; name a folder that --out made"),
        "{refusal}"
    );
}
