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

/// A camera of one's own with a noise for which no condition is stated.
fn own_camera() -> String {
    let own =
        "exposure = \"10 ms\"\npixel = \"12 um\"\nf_number = 1.0\nfocal_length = \"24 mm\"\nnetd = \"30 mK\"";
    let text = SCENARIO.replace("preset = \"flir-a325sc\"", own);
    assert_ne!(text, SCENARIO);
    text
}

const CONDITIONS: &str = "netd_temperature = \"30 degC\"\nnetd_f_number = 1.0\nnetd = ";

/// A figure at conditions that are none comes to no noise at all: refused, and no 'yes' of an ideal camera.
#[test]
fn a_noise_that_vanishes_is_refused() {
    let folder = Folder::with(&own_camera().replace("netd = ", CONDITIONS));
    for set in ["camera.netd_f_number=1e200", "camera.netd_pixel=1e-200 m"] {
        let said = folder.refusal(&["size", "a.toml", "--set", set]);
        assert!(said.contains("the noise that is stated comes to"), "{set}: {said}");
    }
    assert!(
        folder
            .refusal(&["size", "a.toml", "--set", "camera.netd_temperature=30 K"])
            .contains("from 50 K to 5000 K")
    );
    // Good detectors are computed.
    for set in ["camera.netd=2 mK", "camera.noise_exposure=1 ms"] {
        assert_eq!(folder.run(&["size", "a.toml", "--set", set]).code, 0, "{set}");
    }
}

/// No camera measures less than the shot noise of the photons: which is least is said, and that much is allowed.
#[test]
fn a_netd_below_its_shot_noise_is_refused_with_the_least() {
    let folder = Folder::with(&own_camera().replace("netd = ", CONDITIONS));
    // A blackbody of 77 K sends 1e-5 of the photons of one of 303 K into the band: the least is 28.7 mK there, and 34.4 mK at f/1.2.
    for set in [
        "camera.netd_temperature=76 K",
        "camera.netd=1 mK",
        "camera.netd=1e-320 K",
        "camera.noise_exposure=1 us",
        "camera.netd_f_number=200",
    ] {
        let said = folder.refusal(&["size", "a.toml", "--set", set]);
        assert!(said.contains("camera.netd") && said.contains("it must be at least"), "{set}: {said}");
        assert!(said.contains("a measured NETD contains"), "{set}: {said}");
        let least = said.split_once("at least ").unwrap().1.split_once(" mK").unwrap().0;
        let allowed = format!("camera.netd={least} mK");
        let again = match set.starts_with("camera.netd=") {
            true => folder.run(&["size", "a.toml", "--set", &allowed]),
            false => folder.run(&["size", "a.toml", "--set", set, "--set", &allowed]),
        };
        assert_eq!(again.code, 0, "{set} {least}: {}", again.stderr);
    }
    let slow =
        ["size", "a.toml", "--set", "camera.netd_temperature=77 K", "--set", "camera.netd_f_number=1.2"];
    assert!(folder.refusal(&slow).contains("at least 34.4"));
    // sqrt(N)/(dN/dT) of 12 um, f/1, 10 ms, 715 to 1250 cm^-1: 1.14 mK.
    let said = folder.refusal(&["size", "a.toml", "--set", "camera.netd=1 mK"]);
    assert!(said.contains("at least 1.14"), "{said}");
}

/// Half of what a noise is stated for is asked for; all of it or none is not.
#[test]
fn a_noise_with_half_of_its_conditions_is_refused() {
    let folder = Folder::with(SCENARIO);
    let asked = |conditions: &str| {
        folder.file("a.toml", &own_camera().replace("netd = ", &format!("{conditions}\nnetd = ")));
        folder.run(&["size", "a.toml"])
    };
    for (conditions, key, missing) in [
        ("netd_temperature = \"30 degC\"", "netd_temperature", "netd_f_number"),
        ("netd_f_number = 1.0", "netd_f_number", "netd_temperature"),
        ("netd_pixel = \"12 um\"", "netd_pixel", "netd_temperature"),
        ("noise_exposure = \"10 ms\"", "noise_exposure", "netd_temperature"),
        ("noise_exposure = \"10 ms\"\nnetd_temperature = \"30 degC\"", "netd_temperature", "netd_f_number"),
    ] {
        let said = asked(conditions);
        assert_eq!(said.code, 1, "{conditions}");
        let found = format!("camera.{key}: {key} beside a noise without its {missing}");
        assert!(
            said.stderr.contains(&found) && said.stderr.contains(&format!("write {missing} = ")),
            "{}",
            said.stderr
        );
    }
    for conditions in ["", "netd_temperature = \"30 degC\"\nnetd_f_number = 1.0"] {
        assert_eq!(asked(conditions).code, 0, "{conditions}");
    }
}

/// Whatever is moved over the file, its noise is the one that the file states; `--vary` and the solver agree with `--set`.
#[test]
fn a_noise_keeps_the_conditions_of_its_file() {
    let folder = Folder::with(&own_camera());
    folder.file(
        "stated.toml",
        &own_camera()
            .replace("netd = ", &format!("noise_exposure = \"10 ms\"\nnetd_pixel = \"12 um\"\n{CONDITIONS}")),
    );
    let reached = |file: &str, set: &[&str]| {
        let answer = folder.json(&[&["size", file], set].concat());
        answer["verdict"]["statistical_distance"].as_f64().unwrap()
    };
    let close = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-12;
    let before = reached("a.toml", &[]);
    assert!(close(before, reached("stated.toml", &[])));
    // The noise grows as the root of the exposure, and the distance as the signal over it.
    let longer = ["--set", "camera.exposure=40 ms"];
    assert!((reached("a.toml", &longer) / before / 2.0 - 1.0).abs() < 0.02);
    for set in [
        &longer[..],
        &["--set", "camera.f_number=1.4"],
        &["--set", "camera.pixel=15 um"],
        &["--set", "camera.optics_efficiency=0.5"],
        &["--set", "camera.f_number=2", "--set", "camera.exposure=3 ms", "--set", "camera.netd=60 mK"],
    ] {
        let moved = reached("a.toml", set);
        assert!(close(moved, reached("stated.toml", set)), "{set:?}");
        assert!(!close(moved, before), "{set:?}");
        // The report's scenario is that question again.
        folder.json(&[&["size", "a.toml", "--out", "out"], set].concat());
        assert!((reached("out/scenario.toml", &[]) / moved - 1.0).abs() < 1e-9, "{set:?}");
    }
    // The solver's own exposure, set, meets the requirement exactly.
    let asked = ["--set", "requirement.distance=0.5"];
    let answer = folder.json(&[&["size", "a.toml"], &asked[..]].concat());
    let exposure = answer["solve_for"]["exposure_s"]["value"].as_f64().unwrap();
    let set = format!("camera.exposure={exposure:e} s");
    assert!((reached("a.toml", &[&asked[..], &["--set", &set]].concat()) / 0.5 - 1.0).abs() < 1e-7);
    folder.json(&["sweep", "a.toml", "--out", "table", "--vary", "camera.exposure=10 ms,40 ms"]);
    let table = std::fs::read_to_string(folder.path().join("table/sweep.csv")).unwrap();
    let column = table
        .lines()
        .next()
        .unwrap()
        .split(',')
        .position(|head| head.ends_with("statistical_distance"))
        .unwrap();
    let last: f64 = table.lines().last().unwrap().split(',').nth(column).unwrap().parse().unwrap();
    assert!((last / reached("a.toml", &longer) - 1.0).abs() < 1e-9, "{table}");
}

/// A noise of the preset's kind written again is another value under the preset's conditions; another kind is a noise of its own.
#[test]
fn a_noise_written_again_is_one_of_the_preset() {
    let folder = Folder::with(SCENARIO);
    let reached = |figures: &str| {
        let camera = format!(
            "preset = \"flir-boson-640-14mm\"\nf_number = 2.0\nreadout = \"sequential\"\nrow_noise = \"0 mK\"\n\
                 column_noise = \"0 mK\"\n{figures}"
        );
        folder.file("a.toml", &SCENARIO.replace("preset = \"flir-a325sc\"", &camera));
        folder.json(&["size", "a.toml"])["verdict"]["statistical_distance"].as_f64().unwrap()
    };
    let own = reached("");
    assert!((reached("netd = \"40 mK\"") / own - 1.0).abs() < 1e-12);
    // Electronic noise, which it is for all but 1e-3 of its variance, is as NETD.
    assert!((reached("netd = \"80 mK\"") / own * 2.0 - 1.0).abs() < 5e-3);
    let conditions = "netd = \"40 mK\"\nnetd_temperature = \"30 degC\"\nnetd_f_number = 2.0";
    assert!((reached(conditions) / own / 4.0 - 1.0).abs() < 2e-2);
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
    // What was set is said among the conditions.
    let set_in: Vec<Value> = of_set["verdict"]["conditions"].as_array().unwrap().clone();
    assert!(set_in.iter().any(|one| one["code"] == "setting" && one["figure"] == "target.temperature"));
    for answer in [&mut of_set, &mut of_file] {
        answer["verdict"]["conditions"] = Value::Null;
    }
    assert_eq!(of_set, of_file);

    // The report can be made again: its scenario has the value, its command the flag, its text says it.
    folder.json(&[&["identify", "a.toml", "--out", "out"], &set[..]].concat());
    let read = |name: &str| std::fs::read_to_string(folder.path().join("out").join(name)).unwrap();
    assert!(read("scenario.toml").contains("temperature = \"60 degC\""));
    assert!(read("hadar.json").contains("target.temperature=60 degC"));
    let line =
        "values that replace those of the file: target.temperature = 60 degC; environment[0].lighting = 0.3";
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
        lines[1].starts_with("a.toml      no ") && lines[2].starts_with("good.toml   yes, if "),
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
