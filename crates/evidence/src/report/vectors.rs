//! Test vectors: their files, the page that defines them, and what there is of them in a few lines.

use crate::vectors::{Topic, VERSION};
use hadar_report::bundle::Bundle;

/// Definitions, how to read, what a tolerance means.
const PAGE: &str = include_str!("vectors/page.md");

/// The files of the folder, the page among them.
#[must_use]
pub fn vectors_bundle(topics: &[Topic]) -> Bundle {
    let mut bundle = Bundle::about(Some("Test vectors"));
    bundle.add("README.md", page(topics));
    for (name, content) in topics.iter().flat_map(Topic::written) {
        bundle.add(name, content);
    }
    bundle
}

/// How many there are about what.
#[must_use]
pub fn vectors_text(topics: &[Topic]) -> String {
    let vectors: usize = topics.iter().map(|topic| topic.vectors.len()).sum();
    let answers: usize = topics.iter().map(Topic::answers).sum();
    let mut text = format!(
        "Test vectors, version {VERSION}: {vectors} questions with {answers} answers\n\n| topic | questions | answers | about |\n|---|---|---|---|\n"
    );
    for topic in topics {
        let Topic { name, title, vectors, .. } = topic;
        text.push_str(&format!("| {name} | {} | {} | {title} |\n", vectors.len(), topic.answers()));
    }
    text
}

fn page(topics: &[Topic]) -> String {
    let mut table = String::from("| file | vectors | about | tells of |\n|---|---|---|---|");
    for Topic { name, title, catches, vectors, .. } in topics {
        table
            .push_str(&format!("\n| [{name}.json]({name}.json) | {} | {title} | {catches} |", vectors.len()));
    }
    PAGE.replace("{version}", &VERSION.to_string()).replace("{topics}", &table)
}
