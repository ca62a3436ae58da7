//! `hadar serve` as it is started: it says where it is, answers as `hadar size` does, and refuses what it cannot serve.

use crate::support::folder::{Folder, SCENARIO};
use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};

/// A program that is ended with its test.
struct Served(Child, String);

impl Served {
    fn with(folder: &Folder, arguments: &[&str]) -> Self {
        Self::of(folder, arguments, &[])
    }

    fn of(folder: &Folder, arguments: &[&str], variables: &[(&str, &str)]) -> Self {
        let mut child = Command::new(assert_cmd::cargo::cargo_bin!("hadar"))
            .args(["serve", "--port", "0", "--quiet"])
            .args(arguments)
            .envs(variables.iter().copied())
            .current_dir(folder.path())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut line = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut line).unwrap();
        let host = line.trim().strip_prefix("http://").unwrap().trim_end_matches('/').to_owned();
        Self(child, host)
    }

    fn asked(&self, method: &str, path: &str, body: &str) -> String {
        let host = &self.1;
        let mut stream = TcpStream::connect(host).unwrap();
        write!(
            stream,
            "{method} {path} HTTP/1.1\r\nHost: {host}\r\nContent-Type: application/json\r\nConnection: close\r\nContent-Length: {}\r\n\r\n{body}",
            body.len()
        )
        .unwrap();
        let mut answer = String::new();
        stream.read_to_string(&mut answer).unwrap();
        assert!(answer.starts_with("HTTP/1.1 200"), "{answer}");
        answer.split_once("\r\n\r\n").unwrap().1.to_owned()
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

#[test]
fn the_page_gives_the_json_of_the_command() {
    let folder = Folder::with(SCENARIO);
    folder.file("mine.csv", "wavenumber_cm1,emissivity\n600,0.9\n1400,0.8\n");
    folder.file("ours.toml", "[[camera]]\nname = \"ours\"\nexposure = \"10 ms\"\npixel = \"12 um\"\nf_number = 1.0\nnetd = \"30 mK\"\n");
    let served = Served::with(&folder, &["--library", "mine.csv", "--cameras", "ours.toml", "a.toml"]);
    let start: Value = serde_json::from_str(&served.asked("GET", "/start", "")).unwrap();
    assert_eq!(start["scenario"], SCENARIO);
    let named =
        |list: &str, name: &str| start[list].as_array().unwrap().iter().any(|one| one["name"] == name);
    assert!(named("materials", "mine") && named("materials", "skin"));
    assert!(named("cameras", "ours") && named("cameras", "flir-a325sc"));

    let question = SCENARIO.replace("aluminium", "mine");
    assert_ne!(question, SCENARIO);
    let page = served.asked("POST", "/json", &json!({ "scenario": question }).to_string());
    let command = folder.fed(&question, &["size", "-", "--json", "--library", "mine.csv"]);
    assert_eq!(command.code, 0, "{}", command.stderr);
    let (mut page, mut command): (Value, Value) =
        (serde_json::from_str(&page).unwrap(), serde_json::from_str(&command.stdout).unwrap());
    // The page keeps its library from question to question, and counts what it has read of it once.
    let work = [&mut page, &mut command].map(|json| json["stats"].take());
    assert!(work.iter().all(|stats| !stats.is_null()));
    assert_eq!(page, command);
}

#[test]
fn the_page_for_rules_gives_the_json_of_the_command() {
    let folder = Folder::with(SCENARIO);
    let served = Served::with(&folder, &[]);
    let start: Value = serde_json::from_str(&served.asked("GET", "/rules/start", "")).unwrap();
    let packs = start["packs"].as_array().unwrap();
    let text = |file: &str| packs.iter().find(|one| one["file"] == file).unwrap()["text"].as_str().unwrap();
    for (file, on) in [("fever_screening.toml", "2030-01-01"), ("un_r152_pedestrian.toml", "1990-01-01")] {
        let question = json!({ "rule": text(file), "on": on }).to_string();
        let page: Value = serde_json::from_str(&served.asked("POST", "/rule", &question)).unwrap();
        let command = folder.fed(text(file), &["rule", "-", "--json", "--on", on]);
        assert_eq!(command.code, 0, "{}", command.stderr);
        let mut page: Value = serde_json::from_str(page["answer"]["json"].as_str().unwrap()).unwrap();
        let mut command: Value = serde_json::from_str(&command.stdout).unwrap();
        // Standard input has another name, and the page keeps its library.
        for json in [&mut page, &mut command] {
            assert!(!json["stats"].take().is_null() && !json["inputs"][0]["path"].take().is_null());
        }
        assert_eq!(page, command, "{file}");
    }
}

/// Questions come from threads that are none of the pool's: it has to work for them, even if it is of one thread, or if there is no
/// thread but the first (a stack that no machine has is a thread that cannot be started).
#[test]
fn a_pool_of_one_thread_answers_the_page() {
    let folder = Folder::with(SCENARIO);
    let question = json!({ "scenario": SCENARIO, "full": true }).to_string();
    let answers = |arguments: &[&str], variables: &[(&str, &str)]| {
        let served = Served::of(&folder, arguments, variables);
        // A second question finds the pool as the first did.
        ["/ask", "/json", "/ask"].map(|path| served.asked("POST", path, &question))
    };
    let of_two = answers(&["--threads", "2"], &[]);
    assert_eq!(of_two[0], of_two[2]);
    assert!(answers(&["--threads", "1"], &[]) == of_two, "one thread");
    assert!(answers(&[], &[("RAYON_NUM_THREADS", "1")]) == of_two, "one thread of the environment");
    #[cfg(target_os = "linux")]
    assert!(answers(&[], &[("RUST_MIN_STACK", "100000000000000")]) == of_two, "no thread but the first");
}

#[test]
fn what_cannot_be_served_is_one_line() {
    let folder = Folder::with(SCENARIO);
    let served = Served::with(&folder, &[]);
    let port = served.1.rsplit(':').next().unwrap();
    let taken = folder.refusal(&["serve", "--port", port]);
    assert!(taken.contains("cannot be taken") && taken.contains("another --port"), "{taken}");
    assert!(folder.refusal(&["serve", "nowhere.toml"]).contains("nowhere.toml"));
    assert_eq!(folder.run(&["serve", "--port", "70000"]).code, 2);
    assert_eq!(folder.run(&["serve", "--out", "x"]).code, 2);
}
