//! A server of the test program, and its clients, byte by byte.

use hadar::material::Library;
use hadar_scenario::keys::{Table, Value};
use hadar_serve::Engine;
use serde_json::Value as Json;
use std::io::{Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::OnceLock;
use std::time::Duration;

pub(crate) const SCENARIO: &str = "[target]\nmaterial = \"skin\"\ntemperature = \"37 degC\"\n\
    [[environment]]\ntemperature = \"20 degC\"\nlighting = 0.5\n\
    [alternatives]\nmaterials = [\"aluminium\"]\n[bands]\nstep = \"20 cm^-1\"\n\
    [camera]\npreset = \"flir-a325sc\"\n";

/// A server of this process.
pub(crate) fn server() -> SocketAddr {
    static SERVER: OnceLock<SocketAddr> = OnceLock::new();
    *SERVER.get_or_init(|| {
        let engine = Engine {
            library: Library::embedded().unwrap(),
            cameras: Default::default(),
            begin: SCENARIO.to_owned(),
            begin_rule: None,
            commit: "test".to_owned(),
            limits: Default::default(),
        };
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = listener.local_addr().unwrap();
        std::thread::spawn(move || hadar_serve::serve(engine, listener));
        address
    })
}

/// What comes back for some bytes, as its status and all of it.
pub(crate) fn sent(bytes: &[u8]) -> (u16, String) {
    let mut stream = TcpStream::connect(server()).unwrap();
    // Only ends a test that hangs.
    stream.set_read_timeout(Some(Duration::from_secs(600))).unwrap();
    // It may be refused before it is read to its end.
    let _ = stream.write_all(bytes);
    let mut answer = Vec::new();
    let _ = stream.read_to_end(&mut answer);
    let answer = String::from_utf8_lossy(&answer).into_owned();
    (answer.split(' ').nth(1).and_then(|status| status.parse().ok()).unwrap_or(0), answer)
}

pub(crate) fn get(path: &str) -> (u16, String) {
    sent(format!("GET {path} HTTP/1.1\r\nHost: {}\r\nConnection: close\r\n\r\n", server()).as_bytes())
}

pub(crate) fn post_with(path: &str, headers: &str, body: &str) -> (u16, String) {
    let head = format!(
        "POST {path} HTTP/1.1\r\nContent-Length: {}\r\nConnection: close\r\n{headers}\r\n",
        body.len()
    );
    let (status, answer) = sent(format!("{head}{body}").as_bytes());
    (status, answer.split_once("\r\n\r\n").map_or_else(String::new, |(_, body)| body.to_owned()))
}

pub(crate) fn post(path: &str, body: &Json) -> (u16, String) {
    let headers = format!("Host: {}\r\nContent-Type: application/json\r\n", server());
    post_with(path, &headers, &body.to_string())
}

/// The paths of all keys of a table at which a file may be named, with what to write there.
pub(crate) fn paths_of_files(table: &Table, above: &str, found: &mut Vec<(String, bool)>) {
    fn names_files(value: &Value) -> Option<bool> {
        match value {
            Value::File | Value::Material | Value::NumberOrFile(_) => Some(false),
            Value::List(of) | Value::Pair(of) => names_files(of).map(|_| true),
            Value::Either(kinds) => kinds.iter().find_map(names_files),
            _ => None,
        }
    }
    for key in table.keys() {
        let path = format!("{above}{}", key.name);
        if let Some(list) = names_files(&key.value) {
            found.push((path.clone(), list));
        }
        match (key.value.table(), key.value) {
            (Some(inner), Value::Tables(_)) => paths_of_files(inner, &format!("{path}[0]."), found),
            (Some(inner), Value::Named(_)) => paths_of_files(inner, &format!("{path}.own."), found),
            (Some(inner), _) => paths_of_files(inner, &format!("{path}."), found),
            _ => {}
        }
    }
}
