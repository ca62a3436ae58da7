//! The folder of test vectors is what the command makes of the reference, byte by byte.

use hadar_evidence::report::vectors_bundle;
use hadar_evidence::vectors::{VERSION, topics};
use hadar_report::bundle::About;
use hadar_report::folder::{Folder, Strangers};
use hadar_report::manifest::Provenance;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;

/// A file is the result of one version of the questions; whoever changes an answer sees it here. Made by one thread, where the
/// files in the repository are made by all.
#[test]
fn the_files_are_those_that_are_made() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let topics = pool.install(topics).unwrap();
    let made = tempfile::tempdir().unwrap();
    let folder = Folder::new(made.path().join("vectors"), Strangers::Refuse);
    let about = About { answer: "", provenance: &Provenance::default(), inputs: &[] };
    vectors_bundle(&topics).write_files(&folder, &about).unwrap();
    let [made, committed] =
        [&made.path().join("vectors"), &hadar_testing::repository().join("vectors")].map(|path| files(path));
    assert_eq!(made.keys().collect::<Vec<_>>(), committed.keys().collect::<Vec<_>>());
    let renew = "make them again with `hadar accuracy vectors --out vectors`, and raise VERSION if an answer changed beyond its tolerance";
    for (name, content) in &made {
        // The list of hashes names the commit too.
        let same = match name.as_str() {
            "hadar.json" => list(content) == list(&committed[name]),
            name => *content == committed[name],
        };
        assert!(same, "vectors/{name} is not what is made: {renew}");
    }
    let page = String::from_utf8(made["README.md"].clone()).unwrap();
    for topic in &topics {
        assert!(page.contains(&format!("\n### {}.json\n", topic.name)), "no definitions of {}", topic.name);
        assert!(topic.vectors.len() <= 20 && !topic.catches.is_empty());
    }
    assert!(
        page.contains(&format!("\n| {VERSION} | ")) && !page.contains("{topics}"),
        "no line for the version"
    );
    let size: usize = committed.values().map(Vec::len).sum();
    assert!(size < 300_000, "{size} bytes");
}

fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = std::fs::read_dir(folder).unwrap().map(Result::unwrap);
    entries
        .map(|entry| (entry.file_name().into_string().unwrap(), std::fs::read(entry.path()).unwrap()))
        .collect()
}

fn list(manifest: &[u8]) -> Value {
    serde_json::from_slice::<Value>(manifest).unwrap()["files"].clone()
}
