//! The papers of the house: their paths exist, their links lead somewhere, and the README is short and true.

use crate::support::folder::{Folder, SCENARIO};
use std::fs;
use std::path::{Path, PathBuf};

/// The most that the README may have, bytes.
const MOST_README: usize = 8000;
const MAIN_EXAMPLE: &str = "examples/human_vs_robot.toml";

/// The README, CONTRIBUTING.md and what is in `docs/dev`, each with its folder.
fn papers() -> Vec<(PathBuf, String)> {
    let root = hadar_testing::repository();
    let mut papers = vec![root.join("README.md"), root.join("CONTRIBUTING.md")];
    papers.extend(fs::read_dir(root.join("docs/dev")).unwrap().map(|entry| entry.unwrap().path()));
    papers.into_iter().map(|path| (path.clone(), fs::read_to_string(path).unwrap())).collect()
}

/// What stands between `open` and `close`, outside of blocks of code.
fn between<'a>(text: &'a str, open: &str, close: &str) -> Vec<&'a str> {
    let prose = text.split("\n```").step_by(2);
    prose.flat_map(|part| part.split(open).skip(1).filter_map(|rest| rest.split(close).next())).collect()
}

/// Whether a word in backticks is a path of the repository: `src/base/sum.rs`, `docs/check`, `Cargo.toml`.
fn is_path(word: &str) -> bool {
    let plain = |char: char| char.is_ascii_alphanumeric() || "._-/".contains(char);
    let ends = [".rs", ".toml", ".md", ".py", ".js", ".csv"];
    word.chars().all(plain)
        && !word.starts_with('/')
        && (word.contains('/') || ends.iter().any(|end| word.ends_with(end)))
}

#[test]
fn every_path_of_the_papers_exists() {
    let root = hadar_testing::repository();
    let (mut paths, mut missing) = (0, Vec::new());
    // The README names files that a reader will have, such as those of a report.
    for (paper, text) in papers().into_iter().skip(1) {
        // Words in backticks are every second piece of a line.
        let lines = text.split("\n```").step_by(2).flat_map(str::lines);
        for word in lines.flat_map(|line| line.split('`').skip(1).step_by(2)).filter(|word| is_path(word)) {
            paths += 1;
            if !root.join(word).exists() {
                missing.push(format!("{}: {word}", paper.display()));
            }
        }
    }
    assert!(paths > 100, "{paths}");
    assert!(missing.is_empty(), "{} paths are not there:\n{}", missing.len(), missing.join("\n"));
}

#[test]
fn every_link_of_the_papers_leads_to_a_file_and_a_title() {
    let mut wrong = Vec::new();
    for (paper, text) in papers() {
        for link in between(&text, "](", ")").into_iter().filter(|link| !link.starts_with("http")) {
            let (file, title) =
                link.split_once('#').map_or((link, None), |(file, title)| (file, Some(title)));
            let path = if file.is_empty() { paper.clone() } else { paper.parent().unwrap().join(file) };
            if !path.exists() || title.is_some_and(|title| !has_title(&path, title)) {
                wrong.push(format!("{}: {link}", paper.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "{} links lead nowhere:\n{}", wrong.len(), wrong.join("\n"));
}

/// Whether a page has the title of an anchor, as forges and mdBook make anchors of titles.
fn has_title(page: &Path, anchor: &str) -> bool {
    let made = |title: &str| -> String {
        let kept = title.to_lowercase();
        let kept = kept.chars().filter(|char| char.is_alphanumeric() || " -_".contains(*char));
        kept.map(|char| if char == ' ' { '-' } else { char }).collect()
    };
    let text = fs::read_to_string(page).unwrap();
    text.lines().any(|line| line.starts_with('#') && made(line.trim_start_matches('#').trim()) == anchor)
}

#[test]
fn the_readme_is_short_and_says_what_its_first_command_answers() {
    let root = hadar_testing::repository();
    let text = fs::read_to_string(root.join("README.md")).unwrap();
    assert!(text.len() <= MOST_README, "{} bytes", text.len());
    let commands =
        format!("```sh\ncargo run --release -- size {MAIN_EXAMPLE} --out out\ncargo test --release\n```\n");
    assert!(text.contains(&commands), "the two commands");
    let outcome = Folder::with(SCENARIO).run(&["size", root.join(MAIN_EXAMPLE).to_str().unwrap()]);
    let answer = outcome.stdout.lines().next().unwrap();
    assert!(text.contains(&format!("```text\n{answer}\n```\n")), "the answer: {answer}");
}
