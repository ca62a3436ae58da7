//! Sentences that people read have the field's terms: home-made ones of an earlier time do not come back.
//!
//! Read are the words of the report, the help of every command, the guide and the README without code, and the explanations of JSON keys. Keys, flags and
//! values keep their names; they are code, in backticks, braces or brackets.

use crate::house::{literals, sources};
use crate::support::folder::{Folder, SCENARIO};
use hadar_report::explain;
use std::path::Path;

/// Home-made, and the term of the field. `~` is any word of the same clause, or none.
const HOME_MADE: [(&str, &str); 26] = [
    ("tell ~ apart", "distinguish"),
    ("tells ~ apart", "distinguishes"),
    ("told apart", "distinguished"),
    ("telling ~ apart", "distinguishing"),
    ("tell ~ from", "distinguish from"),
    ("tells ~ from", "distinguishes from"),
    ("told from", "distinguished from"),
    ("telling ~ from", "distinguishing from"),
    ("reliability", "probability of a correct decision"),
    ("what would meet", "value that meets the requirement"),
    ("silent", "default, not stated"),
    ("enters", "is used in"),
    ("envelope", "operating envelope"),
    ("envelopes", "operating envelopes"),
    ("stand-in", "surrogate target"),
    ("stand-ins", "surrogate targets"),
    ("fills the well", "saturates"),
    ("nearest state", "closest confuser"),
    ("so many", "the number"),
    ("as far as", "where, to the extent that"),
    ("hangs on", "depends on"),
    ("of its own", "cut"),
    ("of their own", "cut"),
    ("beside", "in addition to, compared with"),
    ("besides", "in addition"),
    ("stands", "is"),
];

/// Where one of them is meant as it is written.
const MEANT: [(&str, &str); 2] = [
    // Of a signature (DSSE).
    ("dsse envelope", "envelope"),
    ("operating envelope", "envelope"),
];

/// Keys and tables as they are written in a file.
const KEYS: [&str; 2] = ["[envelope]", "envelope.distance"];

/// Words of a clause, without code.
fn words(clause: &str) -> Vec<String> {
    let is_part = |letter: char| letter.is_alphanumeric() || "-_".contains(letter);
    let words = clause.split(|letter| !is_part(letter)).filter(|word| !word.is_empty());
    words.filter(|word| !word.starts_with("--")).map(str::to_lowercase).collect()
}

/// The text without what is code: in backticks, braces, brackets and fences.
fn without_code(text: &str) -> String {
    let mut fenced = false;
    let mut out = String::new();
    for line in text.lines() {
        if line.trim_start().starts_with("```") {
            fenced = !fenced;
        } else if !fenced {
            out.push_str(line);
            out.push('\n');
        }
    }
    let mut plain = String::new();
    for (index, part) in out.split('`').enumerate() {
        if index % 2 == 0 {
            plain.push_str(part);
        }
        plain.push(' ');
    }
    let (mut depth, mut kept) = (0_usize, String::new());
    for letter in plain.chars() {
        match letter {
            '{' => depth += 1,
            '}' => depth = depth.saturating_sub(1),
            letter if depth == 0 => kept.push(letter),
            _ => {}
        }
    }
    kept
}

fn has(clause: &[String], phrase: &str) -> bool {
    let (before, after) = phrase.split_once(" ~ ").unwrap_or((phrase, ""));
    let [before, after] =
        [before, after].map(|part| part.split(' ').filter(|word| !word.is_empty()).collect::<Vec<_>>());
    let is_at =
        |start: usize, part: &[&str]| clause.get(start..start + part.len()).is_some_and(|here| here == part);
    (0..clause.len()).any(|start| {
        let end = start + before.len();
        is_at(start, &before) && (after.is_empty() || (end..clause.len()).any(|later| is_at(later, &after)))
    })
}

/// What is home-made in a text.
fn home_made(text: &str) -> Vec<&'static str> {
    let mut found = Vec::new();
    let text = KEYS.iter().fold(without_code(text), |text, key| text.replace(key, ""));
    for clause in text.split(['.', ';', ':']) {
        let clause = words(clause);
        let mut plain = clause.join(" ");
        for (meant, word) in MEANT {
            plain = plain.replace(meant, &meant.replace(word, "-"));
        }
        let clause: Vec<String> = plain.split(' ').map(str::to_owned).collect();
        found.extend(HOME_MADE.iter().map(|(phrase, _)| *phrase).filter(|phrase| has(&clause, phrase)));
    }
    found
}

fn pages(folder: &Path, found: &mut Vec<(String, String)>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            pages(&path, found);
        } else if path.extension().is_some_and(|kind| kind == "md") {
            found.push((path.display().to_string(), std::fs::read_to_string(&path).unwrap()));
        }
    }
}

/// The help of a command and of those below it.
fn help(folder: &Folder, command: &[&str], found: &mut Vec<(String, String)>) {
    let arguments: Vec<&str> = command.iter().copied().chain(["--help"]).collect();
    let text = folder.run(&arguments).stdout;
    if let Some((_, below)) = text.split_once("\nCommands:\n") {
        let names = below.lines().take_while(|line| line.starts_with("  "));
        let names =
            names.filter(|line| !line.starts_with("   ")).filter_map(|line| line.split_whitespace().next());
        for name in names.filter(|name| *name != "help") {
            let command: Vec<&str> = command.iter().copied().chain([name]).collect();
            help(folder, &command, found);
        }
    }
    found.push((format!("hadar {} --help", command.join(" ")), text));
}

#[test]
fn sentences_have_the_terms_of_the_field() {
    let root = hadar_testing::repository();
    let mut texts = Vec::new();
    for (name, text) in sources("report").into_iter().filter(|(name, _)| name.starts_with("words")) {
        let said = literals(&text).into_iter();
        texts
            .extend(said.map(|literal| (format!("crates/report/src/{name}:{}", literal.line), literal.text)));
    }
    let before = texts.len();
    help(&Folder::with(SCENARIO), &[], &mut texts);
    assert!(texts.len() > before + 20, "{}", texts.len() - before);
    pages(&root.join("docs/src"), &mut texts);
    texts.push(("README.md".into(), std::fs::read_to_string(root.join("README.md")).unwrap()));
    let results = explain::results();
    texts.extend(
        results.map(|one| (format!("results.tsv, {}", one.key), format!("{}. {}", one.of, one.meaning))),
    );
    texts.extend(explain::terms().map(|term| (format!("terms.tsv, {}", term.name), term.meaning.to_owned())));
    assert!(texts.len() > 3000, "{}", texts.len());
    let found: Vec<String> = texts
        .iter()
        .flat_map(|(place, text)| {
            home_made(text).into_iter().map(move |phrase| format!("{place}: `{phrase}` in {text:?}"))
        })
        .map(|line| line.chars().take(300).collect())
        .collect();
    assert!(
        found.is_empty(),
        "{} sentences, write the term instead ({HOME_MADE:?}):\n{}",
        found.len(),
        found.join("\n")
    );
}

#[test]
fn home_made_terms_are_found() {
    for (text, expected) in [
        ("It cannot tell skin from pmma.", &["tell ~ from"][..]),
        ("Pairs that are told apart", &["told apart"]),
        ("the scenes of the envelope", &["envelope"]),
        ("the operating envelope; `envelope` in the file", &[]),
        ("What tells. From there", &[]),
        ("with 84 % {reliability} of `reliability`", &[]),
        ("a Stand-In", &["stand-in"]),
    ] {
        assert_eq!(home_made(text), expected, "{text}");
    }
}
