//! Every number of every example at the ends of what a number can be, key by key.
//!
//! The numbers are found in the files, those of lines that are off included, so that a new key is covered as soon as an
//! example has it. `HADAR_EXTREMES=all` tries every end at every number; otherwise each number gets some of them in turn.

use crate::support::sound::{all, fault};
use hadar_testing::repository;
use std::ops::Range;

const EXTREMES: [&str; 7] = ["5e-324", "1e308", "0", "-1", "nan", "inf", "1e-9"];
/// Extremes that a number gets where nothing is said.
const SOME: usize = 1;

/// What makes an example quick without making it another one.
const SMALLER: &[(&str, &str)] = &[
    ("step = \"1 cm^-1\"", "step = \"40 cm^-1\""),
    ("step = \"0.48 cm^-1\"", "step = \"40 cm^-1\""),
    ("step = \"10 cm^-1\"", "step = \"130 cm^-1\""),
    ("# size = [480, 640]", "size = [24, 32]"),
    ("size = [480, 640]", "size = [24, 32]"),
    ("lines = [300]", "lines = [15]"),
    ("lines = [330]", "lines = [15]"),
    ("pixel = \"12 um\"\nf_number = 1.4", "pixel = \"240 um\"\nf_number = 1.4"),
];

/// Places of numbers in a line: at its beginning, or after a blank, a quote, a bracket or a comma.
fn numbers(line: &str) -> Vec<Range<usize>> {
    let code = line.split(" # ").next().unwrap_or(line);
    let Some(value) = code.find('=').map(|at| at + 1) else { return ends(code, 0) };
    ends(code, value)
}

fn ends(code: &str, from: usize) -> Vec<Range<usize>> {
    let bytes = code.as_bytes();
    let mut found = Vec::new();
    let mut at = from;
    while at < bytes.len() {
        let before = if at == 0 { b' ' } else { bytes[at - 1] };
        let starts = bytes[at].is_ascii_digit()
            || (bytes[at] == b'-' && bytes.get(at + 1).is_some_and(u8::is_ascii_digit));
        if starts && b" \"[,={(".contains(&before) {
            let rest = &bytes[at + 1..];
            let len = rest.iter().position(|byte| !(byte.is_ascii_digit() || b".e+-".contains(byte)));
            let end = at + 1 + len.unwrap_or(rest.len());
            found.push(at..end);
            at = end;
        } else {
            at += 1;
        }
    }
    found
}

/// A file with one number replaced, for every number of every example.
fn cases() -> Vec<(String, String)> {
    let mut cases = Vec::new();
    let mut names: Vec<_> = std::fs::read_dir(repository().join("examples"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    names.retain(|path| path.extension().is_some_and(|end| end == "toml"));
    names.sort();
    let every = std::env::var("HADAR_EXTREMES").is_ok_and(|value| value == "all");
    for path in names {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let mut text = std::fs::read_to_string(&path).unwrap();
        for (large, small) in SMALLER {
            text = text.replace(large, small);
        }
        let lines: Vec<&str> = text.lines().collect();
        for (index, line) in lines.iter().enumerate() {
            // A line that is off is turned on.
            let on = line
                .strip_prefix("# ")
                .filter(|rest| rest.split_once(" = ").is_some_and(|(key, _)| !key.contains(' ')));
            let own = on.unwrap_or(line);
            if own.starts_with("title") || own.starts_with('#') {
                continue;
            }
            for place in numbers(own) {
                let turn = cases.len();
                let count = if every { EXTREMES.len() } else { SOME };
                for extreme in (0..count).map(|i| EXTREMES[(turn + i) % EXTREMES.len()]) {
                    let changed = format!("{}{extreme}{}", &own[..place.start], &own[place.end..]);
                    let mut file = lines.clone();
                    file[index] = &changed;
                    cases.push((format!("{name}:{}: {changed}", index + 1), file.join("\n")));
                }
            }
        }
    }
    cases
}

#[test]
fn every_number_of_an_example_may_be_at_the_end_of_all_numbers() {
    let cases = cases();
    assert!(cases.len() > 150, "{} numbers were found", cases.len());
    all(cases.len(), |number| {
        let (what, text) = &cases[number];
        let folder = tempfile::tempdir_in(env!("CARGO_TARGET_TMPDIR")).unwrap();
        std::fs::write(folder.path().join("a.toml"), text).unwrap();
        let command = if text.contains("[envelope]") {
            "rule"
        } else if text.contains("[stereo]") {
            "range"
        } else {
            "size"
        };
        // Of a rule the answer alone: all else of it is that of `size`.
        let flags: &[&str] = if command == "rule" { &["--check", "--json"] } else { &["--json"] };
        let arguments: Vec<String> =
            [command, "a.toml"].iter().chain(flags).map(|part| (*part).to_owned()).collect();
        fault(folder.path(), &arguments).map(|fault| format!("{what}: {fault}"))
    });
}
