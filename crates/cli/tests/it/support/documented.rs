//! Keys of answers as the sources document them: fields of what is serialized, and kinds and reasons of the ledger.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

const FOLDERS: [&str; 9] = [
    "src",
    "crates/formats/src",
    "crates/estimate/src",
    "crates/simulate/src",
    "crates/scenario/src",
    "crates/study/src",
    "crates/evidence/src",
    "crates/report/src",
    "crates/cli/src",
];
const LEDGER: &str = "src/base/demand/ledger.rs";
/// Where two structs of a camera have their fields: stated, and in the camera behind `=>` and in `@Camera`.
const FIGURES: &str = "src/instrument/figures/list.rs";
const STATED: &str = "What is stated of a camera; what is not is none";
const CAMERA: &str = "A spectral thermal camera";

/// Lines `key`, part of an answer, meaning, with tabs between.
pub(crate) fn keys() -> String {
    let root = hadar_testing::repository();
    let mut rows = BTreeSet::new();
    for folder in FOLDERS {
        for path in sources(&root.join(folder)) {
            let text = fs::read_to_string(&path).unwrap();
            if path.ends_with(FIGURES) {
                of_figures(&text, &mut rows);
            } else {
                of_source(&text, path.ends_with(LEDGER), &mut rows);
            }
        }
    }
    rows.into_iter().map(|[key, of, meaning]| format!("{key}\t{of}\t{meaning}\n")).collect()
}

fn sources(folder: &Path) -> Vec<std::path::PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|end| end == "rs") {
            found.push(path);
        }
    }
    found
}

fn of_source(text: &str, ledger: bool, rows: &mut BTreeSet<[String; 3]>) {
    let (mut doc, mut attributes) = (String::new(), String::new());
    let (mut of, mut is_told) = (String::new(), false);
    for line in text.lines().map(str::trim) {
        if let Some(more) = line.strip_prefix("///") {
            doc = format!("{doc} {}", more.trim());
            continue;
        }
        if line.starts_with("#[") {
            attributes.push_str(line);
            continue;
        }
        let bare = without_visibility(line);
        if let Some(rest) = bare.strip_prefix("struct ").or_else(|| bare.strip_prefix("enum ")) {
            let name: String = rest.chars().take_while(|char| char.is_alphanumeric()).collect();
            of = plain(&doc).split(". ").next().unwrap_or_default().trim_end_matches('.').to_owned();
            is_told =
                attributes.contains("Serialize") || text.contains(&format!("impl Serialize for {name}"));
        } else if let Some(key) = field(bare).filter(|_| is_told && !doc.is_empty())
            && !attributes.contains("serde(skip)")
            && !attributes.contains("flatten")
        {
            let renamed = attributes.split("rename = \"").nth(1).and_then(|rest| rest.split('"').next());
            rows.insert([renamed.unwrap_or(key).to_owned(), of.clone(), plain(&doc)]);
        } else if let Some(variant) = line.strip_suffix(',').filter(|_| ledger && !doc.is_empty()) {
            rows.insert([snake_case(variant), of.clone(), plain(&doc)]);
        }
        doc.clear();
        attributes.clear();
    }
}

fn of_figures(text: &str, rows: &mut BTreeSet<[String; 3]>) {
    let (mut doc, mut attributes, mut name, mut of) = (String::new(), String::new(), "", STATED);
    for line in text.lines().map(str::trim) {
        if let Some(more) = line.strip_prefix("///") {
            doc = format!("{doc} {}", more.trim());
        } else if line.starts_with("#[") {
            attributes.push_str(line);
        } else {
            if ["@Camera {", "}"].contains(&line) {
                of = if line == "}" { STATED } else { CAMERA };
            }
            let (is_kept, its) = (line.starts_with("=>"), field(line));
            name = its.unwrap_or(name);
            if (is_kept || its.is_some()) && !doc.is_empty() && !attributes.contains("serde(skip)") {
                let of = if is_kept { CAMERA } else { of };
                rows.insert([name.to_owned(), of.to_owned(), plain(&doc)]);
            }
            doc.clear();
            attributes.clear();
        }
    }
}

fn without_visibility(line: &str) -> &str {
    let Some(rest) = line.strip_prefix("pub") else { return line };
    let rest = match rest.strip_prefix('(') {
        Some(inner) => inner.split_once(')').map_or(rest, |(_, rest)| rest),
        None => rest,
    };
    rest.trim_start()
}

/// The name of a field that a line declares.
fn field(line: &str) -> Option<&str> {
    let (name, _) = line.split_once(": ")?;
    let is_name = !name.is_empty()
        && name.chars().all(|char| char.is_ascii_lowercase() || char.is_ascii_digit() || char == '_');
    is_name.then_some(name)
}

/// Documentation as text: links are their words, and what an answer leaves out or has as null is none.
fn plain(doc: &str) -> String {
    let doc = doc.trim().replace("[`", "`").replace("`None`", "none").replace('\t', " ");
    let mut links = doc.split("`]");
    let first = links.next().unwrap_or_default().to_owned();
    links.fold(first, |text, rest| {
        let target = rest.strip_prefix('(').and_then(|inner| inner.split_once(')'));
        format!("{text}`{}", target.map_or(rest, |(_, rest)| rest))
    })
}

fn snake_case(name: &str) -> String {
    let mut written = String::new();
    for letter in name.chars() {
        if letter.is_uppercase() && !written.is_empty() {
            written.push('_');
        }
        written.extend(letter.to_lowercase());
    }
    written
}
