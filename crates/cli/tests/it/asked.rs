//! How a question reaches the program: by standard input, with values set, by flags that mean something, several at once.

use crate::support::folder::{Folder, SCENARIO};
use crate::support::rules::rule;
use serde_json::Value;

const NOISELESS: &str = r#"[camera]
exposure = "1 s"
pixel = "12 um"
f_number = 1.3
focal_length = "18 mm"
noise_electrons = 0
"#;

#[test]
fn standard_input_is_read_as_a_file_is() {
    let folder = Folder::with(SCENARIO);
    let mut piped: Value =
        serde_json::from_str(&folder.fed(SCENARIO, &["size", "-", "--json"]).stdout).unwrap();
    let mut named = folder.json(&["size", "a.toml"]);
    for answer in [&mut piped, &mut named] {
        answer["stats"] = Value::Null;
    }
    assert_eq!(piped, named);
    let wrong = folder.fed(&SCENARIO.replace("\"skin\"", "\"skn\""), &["size", "-"]);
    assert!(
        wrong.code == 1 && wrong.stderr.contains("<stdin>:2: target.material: there is no material `skn`")
    );
    let long = folder.fed(&format!("{SCENARIO}#{}", "x".repeat(1 << 20)), &["size", "-"]);
    assert!(long.code == 1 && long.stderr.contains("longer than 1 MiB"), "{}", long.stderr);
    let kind = folder.fed(SCENARIO, &["rule", "-"]);
    assert!(kind.stderr.contains("hadar size -"), "{}", kind.stderr);

    // Files that it names are of the folder in which the program runs; the report holds the hash of what was read.
    folder.file("my.csv", "wavenumber_cm1,emissivity\n700,0.9\n1300,0.8\n");
    let with_file = SCENARIO.replace("\"skin\"", "\"my.csv\"");
    let made = folder.fed(&with_file, &["identify", "-", "--out", "out"]);
    assert_eq!(made.code, 0, "{}", made.stderr);
    let manifest: Value =
        serde_json::from_str(&std::fs::read_to_string(folder.path().join("out/hadar.json")).unwrap())
            .unwrap();
    let paths: Vec<&str> =
        manifest["inputs"].as_array().unwrap().iter().map(|input| input["path"].as_str().unwrap()).collect();
    assert_eq!(&paths[..2], ["<stdin>", "my.csv"]);
    assert_eq!(
        manifest["inputs"][0]["sha256"],
        hadar_report::manifest::sha256(with_file.as_bytes()).as_str()
    );
}

/// A figure at conditions that are none comes to no noise at all: refused, and no 'yes' of an ideal camera.
#[test]
fn a_noise_that_vanishes_is_refused() {
    let own = SCENARIO.replace(
        "preset = \"flir-a325sc\"",
        "exposure = \"10 ms\"\npixel = \"12 um\"\nf_number = 1.0\nfocal_length = \"24 mm\"\nnetd = \"30 mK\"",
    );
    let folder = Folder::with(&own);
    for set in [
        "camera.netd_f_number=1e200",
        "camera.netd_pixel=1e-200 m",
        "camera.netd=1e-320 K",
        "camera.noise_exposure=1e-300 s",
    ] {
        let said = folder.refusal(&["size", "a.toml", "--set", set]);
        assert!(said.contains("the noise that is stated comes to"), "{set}: {said}");
    }
    assert!(
        folder
            .refusal(&["size", "a.toml", "--set", "camera.netd_temperature=30 K"])
            .contains("from 50 K to 5000 K")
    );
    // The best detectors there are, and one of liquid nitrogen, are computed.
    for set in ["camera.netd=1 mK", "camera.netd_temperature=77 K", "camera.noise_exposure=1 us"] {
        assert_eq!(folder.run(&["size", "a.toml", "--set", set]).code, 0, "{set}");
    }
}

/// By the letter of the file its noise holds for whatever exposure it has: whoever turns one sees no effect, and must know why.
#[test]
fn a_figure_that_takes_the_noise_along_is_warned_of() {
    let own = SCENARIO.replace(
        "preset = \"flir-a325sc\"",
        "exposure = \"10 ms\"\npixel = \"12 um\"\nf_number = 1.0\nfocal_length = \"24 mm\"\nnetd = \"30 mK\"",
    );
    assert_ne!(own, SCENARIO);
    let folder = Folder::with(&own);
    folder.file("stated.toml", &own.replace("netd = ", "noise_exposure = \"10 ms\"\nnetd = "));
    let asked = |file: &str, set: &[&str]| {
        let answer = folder.json(&[&["size", file], set].concat());
        let codes = answer["warnings"].as_array().unwrap().iter();
        let said = codes.filter(|one| one["code"] == "noise-moves-with-figure").count();
        (said, answer["verdict"]["statistical_distance"].as_f64().unwrap())
    };
    let longer = ["--set", "camera.exposure=40 ms"];
    let (said, before) = asked("a.toml", &[]);
    assert_eq!(said, 0);
    let (said, moved) = asked("a.toml", &longer);
    assert!(said == 1 && (moved / before - 1.0).abs() < 0.01, "{moved} {before}");
    // Stated for an exposure the noise grows as its root, and the distance as the signal over it.
    let (said, stated) = asked("stated.toml", &longer);
    assert!(said == 0 && (stated / before / 2.0 - 1.0).abs() < 0.02, "{stated} {before}");
    assert_eq!(asked("a.toml", &["--set", "camera.f_number=1.4", "--set", "camera.pixel=15 um"]).0, 2);
}

#[test]
fn what_is_set_is_as_if_the_file_said_it() {
    let folder = Folder::with(SCENARIO);
    folder.file("b.toml", &SCENARIO.replace("\"37 degC\"", "\"60 degC\"").replace("0.5", "0.3"));
    let set = ["--set", "target.temperature=60 degC", "--set", "environment[0].lighting=0.3"];
    let mut of_set = folder.json(&[&["size", "a.toml"], &set[..]].concat());
    let said = of_set["set"].take();
    assert_eq!((&said[0]["key"], &said[0]["value"]), (&"target.temperature".into(), &"60 degC".into()));
    let mut of_file = folder.json(&["size", "b.toml"]);
    of_set.as_object_mut().unwrap().remove("set");
    for answer in [&mut of_set, &mut of_file] {
        answer["stats"] = Value::Null;
    }
    assert_eq!(of_set, of_file);

    // The report can be made again: its scenario has the value, its command the flag, its text says it.
    folder.json(&[&["identify", "a.toml", "--out", "out"], &set[..]].concat());
    let read = |name: &str| std::fs::read_to_string(folder.path().join("out").join(name)).unwrap();
    assert!(read("scenario.toml").contains("temperature = \"60 degC\""));
    assert!(read("hadar.json").contains("target.temperature=60 degC"));
    let line =
        "in the place of the file's values: target.temperature = 60 degC; environment[0].lighting = 0.3";
    assert!(
        read("answer.txt").contains(line) && read("report.html").contains("target.temperature = 60 degC")
    );

    for (set, said) in [
        ("target.temperature=5", "--set target.temperature: `5` is a number without a unit"),
        ("target.temprature=5 K", "--set target.temprature: there is no key `temprature`"),
        ("environment[3].lighting=0.1", "--set environment[3].lighting: there is no environment[3]"),
        ("clouds.height=3 m", "--set clouds.height: there is no key `clouds`"),
        (
            "object[0].height=3 m",
            "--set object[0].height: there is no object[0]; write it into the file first",
        ),
    ] {
        let refused = folder.refusal(&["identify", "a.toml", "--set", set]);
        assert!(refused.starts_with(said), "{refused}");
    }
    let twice = ["size", "a.toml", "--set", "target.size=1 m", "--set", "target.size=2 m"];
    assert!(folder.refusal(&twice).starts_with("--set target.size: it is set twice"));
    let both = ["sweep", "a.toml", "--out", "o", "--set", "target.size=1 m", "--vary", "target.size=1 m,2 m"];
    assert!(folder.refusal(&both).starts_with("--set target.size: it is varied too"));
    assert_eq!(folder.run(&["size", "a.toml", "--set", "target.size"]).code, 2);
}

#[test]
fn a_certificate_of_a_rule_with_values_set_is_found_again() {
    let folder = Folder::with(&rule("ideal-pnrd"));
    let made = folder.run(&["rule", "a.toml", "--set", "target.temperature=36 degC", "--out", "out"]);
    assert_eq!(made.code, 0, "{}", made.stderr);
    let verified = folder.run(&["rule", "--verify", "out/certificate.json"]);
    assert!(verified.code == 0 && verified.stdout.starts_with("Verified"), "{}", verified.stderr);
    let set = ["rule", "--verify", "out/certificate.json", "--set", "target.temperature=36 degC"];
    assert!(folder.refusal(&set).contains("a certificate has no keys"));
}

#[test]
fn a_flag_that_means_nothing_to_a_command_is_refused_with_those_that_take_it() {
    let folder = Folder::with(SCENARIO);
    for (arguments, said) in [
        (
            &["cameras", "list", "--seed", "3"][..],
            "`hadar cameras list` takes no `--seed`; what takes it: identify, rule",
        ),
        (&["size", "a.toml", "--matrix"], "`hadar size` takes no `--matrix`; what takes it: identify"),
        (&["cameras", "list", "--out=x"], "`hadar cameras list` takes no `--out`"),
        (&["calibrate", "noise", "a.npy", "--library", "x"], "`hadar calibrate noise` takes no `--library`"),
        (&["--json", "completions", "bash"], "`hadar completions` takes no `--json`"),
        (&["--seed", "3", "identify", "a.toml"], "write `--seed` behind `hadar identify`, not before"),
        (&["size", "a.toml", "--nonsense"], "unexpected argument '--nonsense'"),
    ] {
        let outcome = folder.run(arguments);
        assert_eq!((outcome.code, outcome.stdout.as_str()), (2, ""), "{arguments:?}");
        assert!(outcome.stderr.contains(said), "{arguments:?}: {}", outcome.stderr);
    }
    assert!(folder.run(&["--json", "cameras", "list"]).stdout.starts_with('{'));
    assert_eq!(folder.run(&["-q", "--threads", "1", "size", "a.toml", "--check"]).code, 3);
}

#[test]
fn several_scenarios_are_a_table_with_their_mistakes_in_it() {
    let folder = Folder::with(SCENARIO);
    let good = SCENARIO.replace("[camera]\npreset = \"flir-a325sc\"\n", NOISELESS);
    folder.file("good.toml", &good);
    folder.file("wrong.toml", &SCENARIO.replace("\"skin\"", "\"skn\""));
    let ask = ["size", "a.toml", "good.toml", "wrong.toml", "--check"];
    let outcome = folder.run(&ask);
    assert_eq!(outcome.code, 1, "an error is the worst: {}", outcome.stderr);
    let lines: Vec<&str> = outcome.stdout.lines().collect();
    assert!(lines[0].starts_with("scenario    verdict"), "{}", outcome.stdout);
    assert!(
        lines[1].starts_with("a.toml      no ") && lines[2].starts_with("good.toml   yes "),
        "{}",
        outcome.stdout
    );
    assert!(lines[3].starts_with("wrong.toml  error: wrong.toml:2: target.material"), "{}", outcome.stdout);
    assert_eq!(folder.run(&["size", "a.toml", "good.toml", "--check"]).code, 3);
    assert_eq!(folder.run(&["identify", "a.toml", "good.toml"]).code, 0);

    // Each answer is that of the scenario alone, and so is each report.
    let all: Value = serde_json::from_str(
        &folder.run(&["identify", "a.toml", "good.toml", "--json", "--out", "out"]).stdout,
    )
    .unwrap();
    let mut alone = folder.json(&["identify", "good.toml", "--out", "alone"]);
    let mut among = all["answers"][1]["answer"].clone();
    for answer in [&mut alone, &mut among] {
        answer["stats"] = Value::Null;
    }
    assert_eq!((alone, &all["answers"][1]["exit_code"]), (among, &0.into()));
    let read = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    for name in ["hadar.json", "answer.txt", "pairs.csv", "report.html", "scenario.toml"] {
        assert!(read(&format!("out/good/{name}")) == read(&format!("alone/{name}")), "{name}");
    }
    assert!(String::from_utf8(read("out/scenarios.csv")).unwrap().lines().count() == 3);
    // And again into the same folder.
    assert_eq!(folder.run(&["identify", "a.toml", "good.toml", "--out", "out"]).code, 0);
    assert!(folder.refusal(&["size", "-", "-"]).contains("standard input is named twice"));
}

#[test]
fn several_rules_are_a_table() {
    let folder = Folder::with(&rule("ideal-pnrd"));
    folder.file("b.toml", &rule("flir-a325sc"));
    let outcome = folder.run(&["rule", "a.toml", "b.toml", "--check"]);
    assert_eq!(outcome.code, 3, "{}", outcome.stderr);
    assert!(
        outcome.stdout.contains("flir-a325sc") && outcome.stdout.contains("0 of 1"),
        "{}",
        outcome.stdout
    );
    assert!(folder.refusal(&["rule", "a.toml", "b.toml", "--test"]).contains("--test is asked of 2 rules"));
}
