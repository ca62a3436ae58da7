//! The certificate as data: its form by a validator that is not ours, and that it is refused where anything was changed.

use crate::support::folder::Folder;
use std::fs;
use std::process::Command;

const RULE: &str = r#"cameras = ["flir-a325sc", "ideal-pnrd"]
[rule]
name = "People and robots"
until = 2030-01-01
[target]
material = "coat.csv"
temperature = "33 degC"
[[environment]]
temperature = "10 degC"
lighting = 0.5
[alternatives]
materials = ["aluminium"]
[bands]
ranges = [["8 um", "9 um"], ["9 um", "10 um"], ["10 um", "11 um"]]
[envelope]
temperature = ["30 degC", "36 degC"]
[stop]
speed = ["5 mph", "10 mph"]
latency = "0.5 s"
deceleration = "2 m/s^2"
start = "6 s"
[[clause]]
name = "people"
[[clause]]
name = "shape"
kind = "resolution"
[clause.requirement]
pixels = 4
size = "0.5 m"
[[source]]
keys = ["target", "environment", "alternatives", "bands", "envelope", "stop", "clause[1].requirement"]
choice = "a test"
[[camera]]
name = "ours"
preset = "flir-a325sc"
f_number = { value = 1.0, u = 0.05 }
[sensitivity]
emissivity_error = 0.0001
[[source]]
keys = ["sensitivity"]
document = "a document"
clause = "1"
quote = "its words"
date = 2024-05-09
mark = "seen"
"#;

/// The same without the spectra that are varied, which take most of its time.
fn brief() -> &'static str {
    RULE.split("[sensitivity]").next().unwrap()
}

const COAT: &str = "wavenumber_cm1,emissivity\n700,0.9\n1000,0.95\n1300,0.92\n";

/// The rule without its errors of emissivities, which are three quarters of the work and are verified by the other tests.
fn without_sensitivity() -> String {
    let (before, after) = RULE.split_once("[sensitivity]").unwrap();
    assert!(after.contains("keys = [\"sensitivity\"]"));
    before.to_owned()
}

fn certified() -> Folder {
    of_rule(RULE)
}

fn of_rule(rule: &str) -> Folder {
    let folder = Folder::with(rule);
    folder.file("coat.csv", COAT);
    let outcome = folder.run(&["rule", "a.toml", "--out", "out", "--on", "2030-06-01", "-q"]);
    assert_eq!((outcome.code, outcome.stderr.as_str()), (0, ""));
    folder
}

fn text(folder: &Folder) -> String {
    fs::read_to_string(folder.path().join("out/certificate.json")).unwrap()
}

#[test]
fn its_form_is_that_of_the_schema() {
    let folder = certified();
    let schema = hadar_testing::repository().join("schemas/certificate.schema.json");
    let program = "import json, sys, jsonschema\n\
        schema, found = (json.load(open(path)) for path in sys.argv[1:3])\n\
        jsonschema.Draft202012Validator.check_schema(schema)\n\
        jsonschema.Draft202012Validator(schema).validate(found)\n\
        found['clauses'][0]['lines'][0]['verdict'] = 'passes'\n\
        assert list(jsonschema.Draft202012Validator(schema).iter_errors(found))\n";
    let there = Command::new("python3").args(["-c", "import jsonschema"]).output();
    if !there.is_ok_and(|there| there.status.success()) {
        println!("skipped: there is no python3 with jsonschema");
        return;
    }
    let certificate = folder.path().join("out/certificate.json");
    let ran = Command::new("python3").args(["-c", program]).arg(schema).arg(certificate).output().unwrap();
    assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stderr));
}

#[test]
fn the_statement_is_about_the_certificate() {
    let folder = certified();
    let statement: serde_json::Value =
        serde_json::from_slice(&fs::read(folder.path().join("out/certificate.intoto.json")).unwrap())
            .unwrap();
    assert_eq!(statement["_type"], "https://in-toto.io/Statement/v1");
    assert_eq!(statement["predicateType"], "https://in-toto.io/attestation/test-result/v0.1");
    let hash = statement["subject"][0]["digest"]["sha256"].as_str().unwrap().to_owned();
    let manifest: serde_json::Value =
        serde_json::from_slice(&fs::read(folder.path().join("out/hadar.json")).unwrap()).unwrap();
    let listed = manifest["files"].as_array().unwrap().iter().find(|file| file["name"] == "certificate.json");
    assert_eq!(listed.unwrap()["sha256"], hash);
    let tests = |key: &str| statement["predicate"][key].as_array().unwrap().len();
    assert_eq!(tests("passedTests") + tests("warnedTests") + tests("failedTests"), 6);
    assert_eq!(statement["predicate"]["configuration"][0]["name"], "a.toml");
}

/// A rule that is not in force demands nothing: nothing is passed, and the first sentence says so, whatever is asked.
#[test]
fn a_rule_that_is_not_in_force_is_no_pass() {
    let folder = Folder::with(
        &(brief().to_owned()
            + "[[test]]\ncamera = \"ours\"\nclause = \"shape\"\nverdict = \"fails\"\n[stand_in]\nemissivity = [0.0]\n[[source]]\nkeys = [\"stand_in\"]\nchoice = \"a test\"\n"),
    );
    folder.file("coat.csv", COAT);
    let idle = "the rule does not hold on 2030-06-01, it held until 2030-01-01";
    for (day, told, result) in [("2030-06-01", true, "WARNED"), ("2029-06-01", false, "FAILED")] {
        let run = |more: &[&str]| folder.run(&[&["rule", "a.toml", "--on", day], more].concat()).stdout;
        let text = run(&["--out", "out", "--force"]);
        assert_eq!(
            text.starts_with(&format!("Nothing is required: {idle}. If it were in force: ")),
            told,
            "{text}"
        );
        let statement = fs::read_to_string(folder.path().join("out/certificate.intoto.json")).unwrap();
        assert!(statement.contains(&format!("\"result\": \"{result}\"")), "{statement}");
        for option in ["--check", "--test", "--stand-in"] {
            assert_eq!(
                run(&[option]).starts_with(&format!("{idle}\n")),
                told,
                "{option}: {}",
                run(&[option])
            );
        }
        let answer: serde_json::Value = serde_json::from_str(&run(&["--json"])).unwrap();
        assert_eq!(answer["in_force"], !told);
        for option in ["--test", "--stand-in"] {
            let json: serde_json::Value = serde_json::from_str(&run(&[option, "--json"])).unwrap();
            assert_eq!(json["warnings"][0]["code"] == "not-in-force", told, "{option}");
        }
    }
}

/// Made with spectra beside the rule's folder, and verified from anywhere: files are where they are from the rule.
#[test]
fn a_certificate_is_verified_from_any_folder() {
    let folder = Folder::with("");
    for name in ["rules", "spectra", "else"] {
        fs::create_dir(folder.path().join(name)).unwrap();
    }
    folder.file("rules/r.toml", &brief().replace("\"coat.csv\"", "\"coat\""));
    folder.file("spectra/coat.csv", COAT);
    let made = folder.run(&["rule", "rules/r.toml", "--library", "spectra", "--out", "rules/out", "-q"]);
    assert_eq!((made.code, made.stderr.as_str()), (0, ""));
    let text = fs::read_to_string(folder.path().join("rules/out/certificate.json")).unwrap();
    assert!(text.contains("\"path\": \"coat.csv\""), "{text}");
    let from = |there: &str, certificate: &str, library: &str| {
        let output = Command::new(assert_cmd::cargo::cargo_bin!("hadar"))
            .current_dir(folder.path().join(there))
            .args(["rule", "--verify", certificate, "--library", library])
            .output()
            .unwrap();
        assert!(output.status.success(), "{there}: {}", String::from_utf8_lossy(&output.stderr));
    };
    from("", "rules/out/certificate.json", "spectra");
    from("else", "../rules/out/certificate.json", "../spectra");
    from("rules/out", "certificate.json", "../../spectra");
    folder.file("spectra/coat.csv", &COAT.replace("0.92", "0.91"));
    let changed = folder.run(&["rule", "--verify", "rules/out/certificate.json", "--library", "spectra"]);
    assert!(
        changed.code == 1 && changed.stderr.contains("coat.csv is another one than the certificate's"),
        "{}",
        changed.stderr
    );
}

/// The same bytes for any number of threads, and verified; a byte of any input, or of what it says, is told with its name.
#[test]
fn what_was_changed_is_named() {
    let rule = without_sensitivity();
    let folder = of_rule(&rule);
    let own = text(&folder);
    let threads =
        folder.run(&["rule", "a.toml", "--out", "one", "--on", "2030-06-01", "--threads", "1", "-q"]);
    assert_eq!(threads.code, 0);
    assert_eq!(own, fs::read_to_string(folder.path().join("one/certificate.json")).unwrap());
    let verify = |file: &str| folder.run(&["rule", "--verify", file]);
    let verified = verify("out/certificate.json");
    assert_eq!(verified.code, 0, "{}", verified.stderr);
    assert!(verified.stdout.contains("was found again, to the last digit"), "{}", verified.stdout);
    // Of its text.
    let verdict = "\"verdict\": \"fails\"";
    assert!(own.contains(verdict));
    for (changed, named) in [
        (own.replacen(verdict, "\"verdict\": \"meets\"", 1), "verdict"),
        (
            own.replacen(verdict, "\"verdict\": \"meets\",\n      \"verdict\": \"fails\"", 1),
            "its form is not that of a certificate",
        ),
        (own.replace("a test", "a law"), "sources[0].choice"),
        (own.replacen("\"evidence\": \"proved\"", "\"evidence\": \"searched\"", 1), "evidence"),
        (
            own.replacen(
                "\"kind\": \"tell-apart\"",
                "\"hadar\": \"approved\",\n      \"kind\": \"tell-apart\"",
                1,
            ),
            "clauses[0].hadar",
        ),
        (own.replace("\"path\": \"a.toml\"", "\"path\": \"law/a.toml\""), "law/a.toml"),
        (own.replacen("\"schema\": 2", "\"schema\": 3", 1), "schema"),
        (own.replacen("\"path\": \"coat.csv\"", "\"path\": \"cote.csv\"", 1), "cote.csv"),
        (own.replacen("2030-06-01", "2029-06-01", 1), "reasons"),
        (own.replace('{', "["), "this is not JSON"),
        // What nobody can accept by `--accept`.
        (own.replacen("\"accepted\": []", "\"accepted\": [\n    \"x\"\n  ]", 1), "there is no condition `x`"),
        (own.replacen("\"accepted\": []", "\"accepted\": \"x\"", 1), "what it accepts"),
    ] {
        assert_ne!(changed, own, "{named}");
        folder.file("changed.json", &changed);
        let outcome = verify("changed.json");
        assert_eq!(outcome.code, 1, "{named}: {}", outcome.stdout);
        let own_words = outcome.stderr.contains(named)
            || (named.starts_with("on ") && outcome.stderr.contains("sentence"));
        assert!(own_words && outcome.stderr.lines().count() == 1, "{named}: {}", outcome.stderr);
    }
    // Of its numbers, by less than anyone would round them.
    let number = |key: &str| {
        let at = own.find(&format!("\"{key}\": ")).unwrap() + key.len() + 4;
        let end = at + own[at..].find([',', '\n']).unwrap();
        let value: f64 = own[at..end].parse().unwrap();
        format!("{}{:?}{}", &own[..at], value * 1.000_01, &own[end..])
    };
    for key in ["margin", "temperature_k"] {
        folder.file("changed.json", &number(key));
        let outcome = verify("changed.json");
        assert!(
            outcome.code == 1 && outcome.stderr.contains(key),
            "{key}: {}{}",
            outcome.stdout,
            outcome.stderr
        );
    }
    // Of an input, though the rule as it was is in a folder beside it too.
    fs::create_dir(folder.path().join("before")).unwrap();
    folder.file("before/a.toml", &rule);
    for (file, content) in [("coat.csv", COAT.replace("0.92", "0.91")), ("a.toml", format!("{rule}\n"))] {
        let before = fs::read_to_string(folder.path().join(file)).unwrap();
        folder.file(file, &content);
        let outcome = verify("out/certificate.json");
        assert_eq!(outcome.code, 1, "{}", outcome.stdout);
        assert!(outcome.stderr.contains(&format!("{file}: the file was changed")), "{}", outcome.stderr);
        folder.file(file, &before);
    }
    assert_eq!(verify("out/certificate.json").code, 0);
}
