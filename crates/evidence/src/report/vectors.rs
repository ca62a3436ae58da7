//! Test vectors: their files, the page that defines them, and what there is of them in a few lines.

use crate::vectors::{Topic, VERSION};
use hadar_report::bundle::Bundle;
use hadar_report::table::markdown;

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
    let row = |topic: &Topic| {
        let [vectors, answers] = [topic.vectors.len(), topic.answers()].map(|count| count.to_string());
        [topic.name.to_string(), vectors, answers, topic.title.to_string()]
    };
    let table = markdown(&["topic", "questions", "answers", "about"], topics.iter().map(row));
    format!("Test vectors, version {VERSION}: {vectors} questions with {answers} answers\n\n{table}")
}

fn page(topics: &[Topic]) -> String {
    let row = |Topic { name, title, catches, vectors, .. }: &Topic| {
        let file = format!("[{name}.json]({name}.json)");
        [file, vectors.len().to_string(), title.to_string(), catches.to_string()]
    };
    let table = markdown(&["file", "vectors", "about", "tells of"], topics.iter().map(row));
    let table = table.trim_end();
    PAGE.replace("{version}", &VERSION.to_string()).replace("{topics}", table)
}
