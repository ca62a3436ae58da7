//! Remarks are made last and nothing reads them back: no code matches on a warning but that which makes it and that which words it.
//!
//! Read are the sources of what answers, without their tests. A warning is read where it stands in a pattern (`matches!`, an arm, `if let`)
//! or where a code is compared with another; it is made where its name stands in an expression.

use std::fs;
use std::path::{Path, PathBuf};

const FOLDERS: [&str; 5] =
    ["crates/study/src", "crates/report/src", "crates/cli/src", "crates/serve/src", "python/src"];

/// Where warnings are what it is about: their table, and their words.
const THEIRS: [&str; 4] = [
    "crates/study/src/warning.rs",
    "crates/study/src/warning/",
    "crates/report/src/words/warnings.rs",
    "crates/report/src/words/warnings/",
];

/// What prints one remark in another place than the others.
const PRINTED: [(&str, &str); 1] =
    [("crates/report/src/words/rule/stand_in.rs", "that the rule does not hold stands above the answer")];

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|end| end == "rs")
            && path.file_stem() != Some("tests".as_ref())
        {
            found.push(path);
        }
    }
}

/// Code without comments and without the tests at its end, on one line.
fn code(text: &str) -> String {
    let text = text.split("#[cfg(test)]\nmod ").next().unwrap_or_default();
    let lines = text.lines().map(|line| line.split("//").next().unwrap_or_default().trim());
    lines.collect::<Vec<_>>().join(" ")
}

/// What follows a name and the braces or parentheses behind it.
fn behind(text: &str) -> &str {
    let text = text.trim_start_matches(|char: char| char.is_alphanumeric() || char == '_').trim_start();
    let (open, close) = match text.chars().next() {
        Some('{') => ('{', '}'),
        Some('(') => ('(', ')'),
        _ => return text,
    };
    let mut depth = 0;
    for (at, char) in text.char_indices() {
        depth += i32::from(char == open) - i32::from(char == close);
        if depth == 0 {
            return text[at + 1..].trim_start();
        }
    }
    ""
}

/// Places at which warnings are read back, as so many characters of the code about them.
fn read_back(code: &str) -> Vec<&str> {
    let is_name = |at: usize| code[..at].ends_with(|char: char| char.is_alphanumeric() || char == '_');
    let about = |at: usize| {
        let (mut from, mut to) = (at.saturating_sub(60), (at + 60).min(code.len()));
        while !code.is_char_boundary(from) {
            from -= 1;
        }
        while !code.is_char_boundary(to) {
            to += 1;
        }
        &code[from..to]
    };
    let mut found = Vec::new();
    for (at, name) in code.match_indices("Warning::").filter(|(at, _)| !is_name(*at)) {
        let rest = &code[at + name.len()..];
        if !rest.starts_with(char::is_uppercase) {
            continue;
        }
        let after = behind(rest);
        let is_pattern = after.starts_with("=>")
            || after.starts_with("if ")
            || after.starts_with('|')
            || (after.starts_with('=') && !after.starts_with("=="));
        let before = &code[..at];
        let in_matches = before.rfind("matches!(").is_some_and(|start| !before[start..].contains([';', '{']));
        if is_pattern || in_matches {
            found.push(about(at));
        }
    }
    let codes = code.match_indices("Code::").filter(|(at, _)| !is_name(*at));
    found.extend(codes.filter(|(at, _)| !code[at + 6..].starts_with("ALL")).map(|(at, _)| about(at)));
    for compared in [".code() ==", ".code() !="] {
        found.extend(code.match_indices(compared).map(|(at, _)| about(at)));
    }
    found
}

#[test]
fn nothing_reads_remarks_back() {
    let root = hadar_testing::repository();
    let mut all = Vec::new();
    FOLDERS.iter().for_each(|folder| sources(&root.join(folder), &mut all));
    assert!(all.len() > 300, "{}", all.len());
    let (mut wrong, mut raised) = (Vec::new(), 0);
    for path in all {
        let name = path.strip_prefix(root).unwrap().to_string_lossy().replace('\\', "/");
        if THEIRS.iter().any(|theirs| name.starts_with(theirs)) {
            continue;
        }
        let code = code(&fs::read_to_string(&path).unwrap());
        raised += code.matches("Warning::").count();
        if PRINTED.iter().all(|(printed, _)| *printed != name) {
            wrong.extend(read_back(&code).into_iter().map(|place| format!("{name}: … {place} …")));
        }
    }
    assert!(raised > 100, "{raised}");
    assert!(wrong.is_empty(), "compute the fact as data, and make the remark of it:\n{}", wrong.join("\n"));
}

/// Whatever serialises an answer by itself loses its sentences.
#[test]
fn the_json_of_answers_is_written_in_one_place() {
    let root = hadar_testing::repository();
    let mut all = Vec::new();
    FOLDERS.iter().for_each(|folder| sources(&root.join(folder), &mut all));
    let writes = |path: &PathBuf| code(&fs::read_to_string(path).unwrap()).contains("serde_json::to_");
    let found: Vec<_> =
        all.iter().filter(|path| writes(path)).map(|path| path.strip_prefix(root).unwrap()).collect();
    let expected = ["crates/report/src/json.rs", "crates/study/src/sweep/part.rs"].map(Path::new);
    assert!(found.len() == 2 && expected.iter().all(|one| found.contains(one)), "{found:?}");
}

#[test]
fn what_reads_a_remark_is_seen() {
    for read in [
        "if warnings.iter().any(|warning| matches!(warning, Warning::PixelFull { .. })) { fails = true; }",
        "warnings.iter().find_map(|one| match *one { Warning::FramesInMotion(proviso) => Some(proviso), _ => None })",
        "if let Some(Warning::NotProved) = last { grade = 1 } if let Warning::Blind = one {}",
        "match warning { Warning::Blind | Warning::Identical => 1, _ => 0 }",
        "match warning { Warning::FullWell { counts, .. } if *counts > 1.0 => 1, _ => 0 }",
        "warnings.iter().any(|one| one.code() == wanted)",
        "codes.contains(&Code::NotInForce)",
    ] {
        assert!(!read_back(&code(read)).is_empty(), "{read}");
    }
    for made in [
        "warnings.push(Warning::PixelFull { counts, full_well }); let a = 1;",
        "(fill < 1.0).then_some(Warning::TargetSmallerThanPixel { fill })",
        "warnings.extend(frames.map(Warning::FramesInMotion)); match x { CapCode::Motion => 1 }",
        "Why::InPart => Warning::LinesOffInPart { axis, lines }, Why::Dead => Warning::LinesDead { axis, lines },",
        "Code::ALL.iter(); ExitCode::SUCCESS",
    ] {
        assert!(read_back(&code(made)).is_empty(), "{made}");
    }
}
