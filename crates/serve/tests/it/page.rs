//! The page as a client sees it, byte by byte: its own requests are answered as by the engine, all others are refused, and nothing
//! that is sent brings it down.

use crate::support::{SCENARIO, get, paths_of_files, post, post_with, sent, server};
use hadar::material::Library;
use hadar_scenario::Scenario;
use hadar_scenario::keys::FILES;
use hadar_serve::Engine;
use hadar_study::Study;
use serde_json::{Value as Json, json};
use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};

fn asked(body: &Json) -> Json {
    let (status, answer) = post("/ask", body);
    assert_eq!(status, 200, "{answer}");
    serde_json::from_str(&answer).unwrap()
}

#[test]
fn the_answer_is_that_of_the_engine() {
    let (status, answer) = post("/json", &json!({ "scenario": SCENARIO }));
    assert_eq!(status, 200, "{answer}");
    let answer: Json = serde_json::from_str(&answer).unwrap();
    let library = Library::embedded().unwrap();
    let study = Study::new(&Scenario::from_toml(SCENARIO, None).unwrap(), &library).unwrap();
    let own = hadar_report::json::value(&study.size_with_curves().unwrap()).unwrap();
    for key in ["verdict", "requirement", "camera", "pairs", "solve_for", "trade_offs", "sensitivity"] {
        assert_eq!(answer[key], own[key], "{key}");
    }
    let shown = asked(&json!({ "scenario": SCENARIO, "full": true }));
    assert_eq!(shown["answer"]["sentence"], own["verdict"]["sentence"]);
    assert_eq!(shown["answer"]["met"], own["verdict"]["met"]);
    // What follows a slider has the same verdict without the rest.
    let moving = asked(&json!({ "scenario": SCENARIO }));
    for key in ["met", "sentence", "numbers", "solved", "pairs"] {
        assert_eq!(moving["answer"][key], shown["answer"][key], "{key}");
    }
    let (status, report) = post("/report", &json!({ "scenario": SCENARIO }));
    assert_eq!(status, 200);
    assert!(report.starts_with("<!DOCTYPE html>") && report.contains("scenario.toml"), "{}", report.len());
    assert!(report.matches("<figure>").count() >= 4);
}

#[test]
fn a_field_that_is_set_is_in_the_text_and_in_the_answer() {
    let set = |value: &str| json!([{ "do": "set", "key": "camera.netd", "value": value }]);
    let moved = asked(&json!({ "scenario": SCENARIO, "edits": set("20 mK") }));
    let text = moved["scenario"].as_str().unwrap();
    assert_eq!(text, format!("{SCENARIO}netd = \"20 mK\"\n"));
    assert_eq!(asked(&json!({ "scenario": text }))["answer"], moved["answer"]);
    // What is wrong is told with its key; there is no answer beside it.
    let wrong = asked(&json!({ "scenario": SCENARIO, "edits": set("20 kg") }));
    assert_eq!(wrong["error"]["key"], "camera.netd");
    assert!(wrong["answer"].is_null() && wrong["form"].is_object());
    let broken = asked(&json!({ "scenario": "[target" }));
    assert!(
        broken["answer"].is_null() && broken["form"].is_null() && broken["error"]["line"] == 1,
        "{broken}"
    );
}

/// The cameras that meet a scenario are those of `hadar find`; a choice that is taken is answered as the list says.
#[test]
fn cameras_are_searched_for_the_scene_of_the_page() {
    let text = SCENARIO.replace("[camera]\npreset = \"flir-a325sc\"\n", "")
        + "[find]\ncameras = [\"flir-lepton*\", \"flir-a325sc\"]\n";
    let searched = |scenario: &str| -> Json {
        let (status, answer) = post("/find", &json!({ "scenario": scenario }));
        assert_eq!(status, 200, "{answer}");
        serde_json::from_str(&answer).unwrap()
    };
    let found = searched(&text);
    let rows = found["answer"]["rows"].as_array().unwrap();
    assert!(rows.iter().any(|row| row["camera"] == "flir-lepton-3.5"), "{found}");
    let open = Scenario::from_toml(&text.replace("[bands]\nstep = \"20 cm^-1\"\n", ""), None).unwrap();
    let library = Library::embedded().unwrap();
    let own = hadar_study::find::find(&open, &Default::default(), &library, Default::default()).unwrap();
    assert_eq!(found["answer"]["sentence"], hadar_report::find::sentence(&own));
    // The camera and the bands of the page are left open, and its other tables stay.
    assert_eq!(searched(&format!("{text}[camera]\npreset = \"flir-a325sc\"\n")), found);
    let met = |row: &Json| row["told"].as_str().is_some_and(|told| told.starts_with("meets"));
    for row in rows {
        let Some(scenario) = row["scenario"].as_str() else { continue };
        let answer = asked(&json!({ "scenario": scenario }));
        assert_eq!(answer["answer"]["met"], met(row), "{row}");
    }
    for wrong in ["[target", "", "[target]\nmaterial = \"skin\"\n[find.filters]\nfrom = \"/etc/passwd\"\n"] {
        let answer = searched(wrong);
        assert!(answer["answer"].is_null() && answer["error"]["message"].is_string(), "{answer}");
        assert!(!answer["error"]["message"].as_str().unwrap().contains("root"), "{answer}");
    }
}

/// Whether a file is there or not, readable or not, cannot be told from outside: no key of a scenario reaches one.
#[test]
fn no_key_reads_a_file() {
    let root = FILES.iter().find(|kind| kind.commands.contains(&"size")).unwrap().root;
    let mut keys = Vec::new();
    paths_of_files(root, "", &mut keys);
    assert!(keys.len() >= 12, "{keys:?}");
    let there = std::env::current_exe().unwrap().display().to_string();
    let begin = SCENARIO.replace("step = \"20 cm^-1\"\n", "")
        + "[background]\ntemperature = \"5 degC\"\n[class.own]\nmaterials = [\"skin\"]\n\
           [envelope]\ntemperature = [\"30 degC\", \"40 degC\"]\n[atmosphere]\nmodel = \"us-standard\"\n\
           [find.filters]\nfrom = \"catalogue\"\n";
    for (key, list) in keys {
        let said = [there.as_str(), "/nowhere/at-all.csv", "../Cargo.toml", "C:\\x.csv"].map(|path| {
            let value = if list { json!([path]).to_string() } else { path.to_owned() };
            let set = json!({ "do": "set", "key": key, "value": value });
            // A table stands in the place of a model.
            let edits = match key.as_str() {
                "atmosphere.table" => json!([{ "do": "remove", "key": "atmosphere.model" }, set]),
                _ => json!([set]),
            };
            let answered = asked(&json!({ "scenario": begin, "edits": edits }));
            let message = answered["error"]["message"].as_str().unwrap_or("an answer").to_owned();
            assert!(message.contains("no files are read here"), "{key} = {path}: {message}");
            message.replace(path, "PATH")
        });
        assert!(said.iter().all(|one| *one == said[0]), "{key}: {said:?}");
    }
}

#[test]
fn strangers_are_refused() {
    let body = json!({ "scenario": SCENARIO }).to_string();
    let here = format!("Host: {}\r\n", server());
    let json = "Content-Type: application/json\r\n";
    for (headers, status) in [
        (format!("{here}{json}Origin: http://{}\r\n", server()), 200),
        (format!("{here}{json}Origin: https://evil.example\r\n"), 403),
        (format!("{here}{json}Origin: null\r\n"), 403),
        (format!("{here}{json}Sec-Fetch-Site: cross-site\r\n"), 403),
        (format!("Host: evil.example\r\n{json}"), 403),
        (format!("{here}{here}{json}"), 400),
        (json.to_owned(), 400),
        (format!("{here}Content-Type: text/plain\r\n"), 415),
        (here.clone(), 415),
    ] {
        let (found, answer) = post_with("/ask", &headers, &body);
        assert_eq!(found, status, "{headers}: {answer}");
        assert_eq!(answer.contains("sentence"), status == 200, "{headers}");
    }
    // What the page may do in a browser is said with every answer.
    let (_, page) = get("/");
    for header in [
        "content-security-policy: default-src 'none'",
        "x-content-type-options: nosniff",
        "cross-origin-resource-policy: same-origin",
        "frame-ancestors 'none'",
    ] {
        assert!(page.contains(header), "{header}");
    }
    assert!(!page.to_lowercase().contains("access-control-allow"));
}

#[test]
fn there_is_nothing_but_the_page() {
    for path in [
        "/",
        "/page.js",
        "/form.js",
        "/past.js",
        "/page.css",
        "/start",
        "/explain/camera.netd",
        "/explain/diffraction",
    ] {
        assert_eq!(get(path).0, 200, "{path}");
    }
    for path in [
        "/etc/passwd",
        "/../Cargo.toml",
        "/%2e%2e/Cargo.toml",
        "/explain/",
        "/explain/../page.js",
        "/explain/%3Cb%3E",
        "//x",
        "/ask",
    ] {
        assert_eq!(get(path).0, 404, "{path}");
    }
    assert_eq!(post("/elsewhere", &json!({ "scenario": "" })).0, 404);
    let host = server();
    for (method, status) in [("DELETE", 405), ("PUT", 405), ("OPTIONS", 405), ("HEAD", 200)] {
        let asked = format!("{method} / HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n");
        assert_eq!(sent(asked.as_bytes()).0, status, "{method}");
    }
}

#[test]
fn what_is_malformed_or_too_large_is_refused_and_the_next_one_answered() {
    let host = server();
    let refused: [Vec<u8>; 9] = [
        format!("GET http://evil.example/ HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n")
            .into_bytes(),
        b"\r\n\r\n\r\n".to_vec(),
        b"GET\r\n\r\n".to_vec(),
        b"\x16\x03\x01\x02\x00\x01\x00\x01".to_vec(),
        vec![0xff; 4096],
        format!("GET / HTTP/9.9\r\nHost: {host}\r\n\r\n").into_bytes(),
        format!("GET / HTTP/1.1\r\nHost: {host}\r\nX: {}\r\n\r\n", "a".repeat(1 << 20)).into_bytes(),
        format!("GET /{} HTTP/1.1\r\nHost: {host}\r\n\r\n", "a".repeat(1 << 20)).into_bytes(),
        format!("POST /ask HTTP/1.1\r\nHost: {host}\r\nContent-Length: -1\r\n\r\n").into_bytes(),
    ];
    for bytes in refused {
        let (status, answer) = sent(&bytes);
        assert!(status == 0 || (400..=505).contains(&status), "{status}: {answer}");
    }
    let long = json!({ "scenario": "#".repeat(300 << 10) });
    assert_eq!(post("/ask", &long).0, 413);
    for body in ["", "[]", "{}", "{\"scenario\": 1}", "{\"scenario\": \"\", \"other\": 1}", "\u{0}"] {
        let headers = format!("Host: {host}\r\nContent-Type: application/json\r\n");
        assert_eq!(post_with("/ask", &headers, body).0, 400, "{body}");
    }
    // Questions without an answer have a message.
    for scenario in ["", "[target]", "\u{feff}", "a = 1", &"[".repeat(5000), &"a.".repeat(5000)] {
        assert!(asked(&json!({ "scenario": scenario }))["error"]["message"].is_string(), "{scenario:.20}");
    }
    let many = "[bands]\nstep = \"0.001 cm^-1\"\n";
    let heavy = SCENARIO.replace("[bands]\nstep = \"20 cm^-1\"\n", many);
    let answered = asked(&json!({ "scenario": heavy }));
    assert!(
        answered["error"]["message"].as_str().unwrap().contains("more than this page computes"),
        "{answered}"
    );
    assert_eq!(get("/").0, 200);
}

#[test]
fn a_hundred_at_once_are_answered_beside_clients_that_never_finish() {
    let idle: Vec<TcpStream> = (0..50)
        .map(|_| {
            let mut stream = TcpStream::connect(server()).unwrap();
            stream.write_all(b"POST /ask HTTP/1.1\r\nHost: x\r\nContent-").unwrap();
            stream
        })
        .collect();
    let expected = asked(&json!({ "scenario": SCENARIO }))["answer"]["sentence"].clone();
    assert!(expected.is_string());
    std::thread::scope(|scope| {
        for number in 0..100 {
            let expected = &expected;
            scope.spawn(move || {
                // Some go away before they are answered.
                if number % 10 == 9 {
                    let body = json!({ "scenario": SCENARIO }).to_string();
                    let head = format!(
                        "POST /ask HTTP/1.1\r\nHost: {}\r\nContent-Type: application/json\r\n",
                        server()
                    );
                    let mut stream = TcpStream::connect(server()).unwrap();
                    let _ = write!(stream, "{head}Content-Length: {}\r\n\r\n{body}", body.len());
                    return;
                }
                // Little work in all: the last is answered within the page's own limit, whatever else the machine does.
                if number % 5 != 0 {
                    return assert!(asked(&json!({ "scenario": "[target" }))["error"].is_object());
                }
                assert_eq!(asked(&json!({ "scenario": SCENARIO }))["answer"]["sentence"], *expected);
            });
        }
    });
    drop(idle);
}

/// A question of minutes: eight surroundings of unknown temperatures.
fn heavy() -> String {
    let object = |i: usize| {
        let material =
            ["concrete", "asphalt", "grass-dry", "brick-red", "pmma", "steel-rough", "skin", "fabric"][i];
        format!(
            "[[environment]]\ntemperature = \"{} degC\"\nlighting = 0.1125\nmaterial = \"{material}\"\n",
            5 + 7 * i
        )
    };
    let surroundings: String = (0..8).map(object).collect();
    SCENARIO
        .replace("[[environment]]\ntemperature = \"20 degC\"\nlighting = 0.5\n", &surroundings)
        .replace("20 cm^-1", "0.1 cm^-1")
        + "[unknown]\nnuisances = [\"temperature\", \"lighting\", \"gain\", \"environment-temperature\"]\n"
}

/// Ten of the heaviest take no more than their own places, and give those back when nobody waits for them any more.
#[test]
fn the_heaviest_keep_nobody_waiting() {
    let body = json!({ "scenario": heavy() }).to_string();
    let waiting: Vec<TcpStream> = (0..10)
        .map(|_| {
            let mut stream = TcpStream::connect(server()).unwrap();
            let head =
                format!("POST /ask HTTP/1.1\r\nHost: {}\r\nContent-Type: application/json\r\n", server());
            write!(stream, "{head}Content-Length: {}\r\n\r\n{body}", body.len()).unwrap();
            stream
        })
        .collect();
    let beside = asked(&json!({ "scenario": SCENARIO }));
    assert!(beside["answer"]["sentence"].is_string(), "{beside}");
    for mut stream in &waiting {
        stream.set_nonblocking(true).unwrap();
        assert!(
            stream.read(&mut [0; 1]).is_err(),
            "a question of minutes was answered: the test shows nothing"
        );
    }
    drop(waiting);
    // One that is no quick one, with four surroundings, gets the place that they had.
    let object = "[[environment]]\ntemperature = \"10 degC\"\nlighting = 0.1\n";
    let other = asked(
        &json!({ "scenario": SCENARIO.replace("[alternatives]", &(object.repeat(3) + "[alternatives]")) }),
    );
    assert!(other["answer"]["sentence"].is_string(), "{other}");
}

#[test]
fn only_this_machine_is_listened_to() {
    let engine = Engine {
        library: Library::empty(),
        cameras: Default::default(),
        begin: String::new(),
        begin_rule: None,
        commit: String::new(),
        limits: Default::default(),
    };
    let Ok(listener) = TcpListener::bind("0.0.0.0:0") else {
        return println!("skipped: no address but this machine's own");
    };
    let error = hadar_serve::serve(engine, listener).unwrap_err().to_string();
    assert!(error.contains("can be reached from other machines"), "{error}");
}
