//! The study is silent: it answers in numbers and codes, and what it has to say is said by the report, in its words.
//!
//! Read is the text of files without tests and comments. In the study no type has a `Display`, and a literal of several words stands only where an
//! error is made: in the statement of one of [`ERRORS`], or in a variable of [`PARTS`], which is handed to one. In the report,
//! outside of `words`, such a literal is an error's too, or, in a file that draws, the name of a picture, an axis or a curve.

use std::path::{Path, PathBuf};

/// Words from which on a literal is a sentence.
const SENTENCE: usize = 4;

/// What makes an error, or takes the words of one.
const ERRORS: [&str; 15] = [
    "Error::malformed(",
    "Error::out_of_range(",
    "Error::unknown_name(",
    "Error::file(",
    "Error::Length",
    "Error::Incomplete",
    "for_key(",
    "refuse(",
    "refused(",
    "wrong(",
    "check::",
    "check_memory(",
    "memory::",
    "positive(",
    "text_of_file(",
];

/// Variables that hold what was found wrong and what to write instead.
const PARTS: [&str; 6] = ["found", "instead", "expected", "header", "quantity", "sizes"];

/// Other literals, each with why it is none of an answer's words.
const ALLOWED: [(&str, &str); 11] = [
    // Names of unknowns, of distances, of signals and of lines of a budget, by which JSON and tables call them.
    ("air_ranging/point.rs", "temperature of the surroundings"),
    ("air_ranging/point.rs", "temperature of the air"),
    ("air_ranging/warn.rs", "least error of the distance"),
    ("warn.rs", "local distance with unknown gain"),
    ("range/results.rs", "scattered, as if measured"),
    ("sight.rs", "light from the path"),
    ("sight.rs", "light from behind the target"),
    ("sight.rs", "sensor emission thrown back by filters"),
    // Why a lint is off.
    ("warning/table.rs", "fields are told with their variant"),
    // What to write instead, of several errors.
    ("camera_bands.rs", "write at most {own} of them"),
    ("sweep/axis.rs", "write KEY=FROM..TO:COUNT"),
];

/// What makes an error of a report, or takes the words of one, and variables that hold them.
const ERRORS_OF_REPORT: [&str; 2] = ["told(", "another("];
const PARTS_OF_REPORT: [&str; 1] = ["reason"];

/// Other literals of the report outside of its words, each with why it is none of an answer's.
const ALLOWED_IN_REPORT: [(&str, &str); 2] = [
    // What an error says that could not be done, and what to write instead.
    ("diff/side.rs", "read what is to be compared"),
    ("rule/record.rs", "name the certificate.json of a report"),
];

/// A literal, and the statements that it stands in, the outermost first.
pub(crate) struct Literal {
    pub(crate) line: usize,
    pub(crate) text: String,
    within: Vec<String>,
}

impl Literal {
    /// Words that are read, without what is filled in.
    fn words(&self) -> usize {
        let mut depth = 0_usize;
        let plain: String = self
            .text
            .chars()
            .map(|character| {
                match character {
                    '{' => depth += 1,
                    '}' => depth = depth.saturating_sub(1),
                    _ if depth == 0 => return character,
                    _ => {}
                }
                ' '
            })
            .collect();
        plain.split_whitespace().filter(|word| word.chars().filter(|c| c.is_alphabetic()).count() > 1).count()
    }

    /// Whether it stands in a statement with one of `calls`, or in one that binds one of `variables`.
    fn is_of(&self, calls: &[&str], variables: &[&str]) -> bool {
        self.within.iter().any(|statement| {
            let statement = statement.trim_start();
            let bound = variables.iter().any(|variable| {
                let rest = statement.strip_prefix("let ").and_then(|rest| rest.strip_prefix(variable));
                rest.is_some_and(|rest| rest.starts_with([' ', ':']))
            });
            bound || calls.iter().any(|call| statement.contains(call))
        })
    }

    fn is_of_an_error(&self) -> bool {
        self.is_of(&ERRORS, &PARTS)
    }

    /// Whether it goes on like a sentence, which no name does.
    fn has_stops(&self) -> bool {
        self.text.ends_with('.') || [". ", "; "].iter().any(|stop| self.text.contains(stop))
    }
}

/// The literals of a file.
pub(crate) fn literals(source: &str) -> Vec<Literal> {
    let source = source.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
    let characters: Vec<char> = source.chars().collect();
    let at = |i: usize| characters.get(i).copied().unwrap_or('\0');
    let mut found = Vec::new();
    // Of every bracket that is open, the statement so far.
    let mut open = vec![String::new()];
    let (mut i, mut line) = (0, 1);
    while i < characters.len() {
        let character = at(i);
        line += usize::from(character == '\n');
        match character {
            '/' if at(i + 1) == '/' => {
                while i < characters.len() && at(i) != '\n' {
                    i += 1;
                }
                continue;
            }
            '\'' if at(i + 1) == '\\' || at(i + 2) == '\'' => {
                i += if at(i + 1) == '\\' { 3 } else { 2 };
                while at(i) != '\'' && at(i) != '\0' {
                    i += 1;
                }
            }
            '"' => {
                let start = line;
                let mut text = String::new();
                i += 1;
                while i < characters.len() && at(i) != '"' {
                    line += usize::from(at(i) == '\n');
                    if at(i) == '\\' {
                        i += 1;
                        line += usize::from(at(i) == '\n');
                    }
                    text.push(at(i));
                    i += 1;
                }
                found.push(Literal { line: start, text, within: open.clone() });
            }
            '(' | '[' | '{' => {
                if let Some(statement) = open.last_mut() {
                    statement.push(character);
                }
                open.push(String::new());
            }
            ')' | ']' | '}' => {
                open.pop();
                // What follows a block begins anew, unless it goes on with it.
                let rest = &characters[i + 1..];
                let next = rest.iter().find(|next| !next.is_whitespace());
                let goes_on = next.is_some_and(|next| ".,)?;]".contains(*next))
                    || rest.iter().take(40).collect::<String>().trim_start().starts_with("else");
                let ends = character == '}' && !goes_on;
                match open.last_mut() {
                    Some(statement) if ends => statement.clear(),
                    Some(statement) => statement.push(character),
                    None => open.push(String::new()),
                }
            }
            ';' => {
                if let Some(statement) = open.last_mut() {
                    statement.clear();
                }
            }
            _ => {
                if let Some(statement) = open.last_mut() {
                    statement.push(character);
                }
            }
        }
        i += 1;
    }
    found
}

/// The files of a folder, without tests.
fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.file_stem().is_some_and(|name| name == "tests") {
            continue;
        } else if path.is_dir() {
            files(&path, found);
        } else if path.extension().is_some_and(|kind| kind == "rs") {
            found.push(path);
        }
    }
}

/// The names and texts of the files of a package.
pub(crate) fn sources(package: &str) -> Vec<(String, String)> {
    let folder = hadar_testing::repository().join("crates").join(package).join("src");
    let mut found = Vec::new();
    files(&folder, &mut found);
    found.sort();
    let name = |path: &PathBuf| path.strip_prefix(&folder).unwrap().to_string_lossy().replace('\\', "/");
    found.iter().map(|path| (name(path), std::fs::read_to_string(path).unwrap())).collect()
}

/// That no file of a package says anything but what is `fine` or allowed.
fn is_silent(package: &str, fine: impl Fn(&str, &str, &Literal) -> bool, allowed: &[(&str, &str)]) {
    let mut said = Vec::new();
    let mut unused: Vec<(&str, &str)> = allowed.to_vec();
    for (name, text) in sources(package) {
        for literal in literals(&text) {
            if literal.words() < SENTENCE || literal.is_of_an_error() || fine(&name, &text, &literal) {
                continue;
            }
            let is_it = |(file, start): &(&str, &str)| *file == name && literal.text.starts_with(start);
            if allowed.iter().any(is_it) {
                unused.retain(|one| !is_it(one));
            } else {
                said.push(format!("crates/{package}/src/{name}:{}: {:?}", literal.line, literal.text));
            }
        }
    }
    let words = "which belong to crates/report/src/words";
    assert!(said.is_empty(), "{} sentences, {words}:\n{}", said.len(), said.join("\n"));
    assert!(unused.is_empty(), "allowed, but not there: {unused:?}");
}

#[test]
fn no_answer_has_words_of_its_own() {
    for (name, text) in sources("study") {
        let own: Vec<&str> = text.lines().filter(|line| line.contains("Display for")).collect();
        assert!(own.is_empty(), "crates/study/src/{name} puts answers into words: {own:?}");
    }
}

#[test]
fn the_study_has_no_sentence_but_those_of_errors() {
    is_silent("study", |_, _, _| false, &ALLOWED);
}

/// Elements of a page are no words.
#[test]
fn the_report_has_its_sentences_in_its_words() {
    let fine = |name: &str, text: &str, literal: &Literal| {
        let draws = name.starts_with("plot/") || text.contains("::plot::");
        name.starts_with("words/")
            // The scan leaves the letter of `\n`.
            || literal.text.trim_start_matches('n').starts_with('<')
            || (draws && !literal.has_stops())
            || literal.is_of(&ERRORS_OF_REPORT, &PARTS_OF_REPORT)
    };
    is_silent("report", fine, &ALLOWED_IN_REPORT);
}

#[test]
fn a_sentence_is_told_from_the_words_of_an_error() {
    let of = |text: &str| {
        let found = literals(text);
        (found.len(), found.iter().filter(|one| one.words() >= SENTENCE && !one.is_of_an_error()).count())
    };
    for (text, expected) in [
        ("fn f() -> String { format!(\"{a} distinguishes {b} from {c} at best\") }", (1, 1)),
        (
            "// \"a comment has many words\"\nconst A: &str = \"three words only {but many more here}\";",
            (1, 0),
        ),
        ("fn f() { return Err(Error::malformed(\"this is not what it is\", x)); }", (1, 0)),
        (
            "fn f() { let found = match x { 1 => \"one of many words\", _ => \"none of the words\" }; g(found) }",
            (2, 0),
        ),
        ("fn f() { let found = 1; let said = \"one of many words\"; }", (1, 1)),
        ("fn f() { let c = '\"'; let said = \"one of \\\"many\\\" words\"; }", (1, 1)),
        ("fn f() { e(Error::file(x)); say(\"one of many words\") }", (1, 1)),
    ] {
        assert_eq!(of(text), expected, "{text}");
    }
}
