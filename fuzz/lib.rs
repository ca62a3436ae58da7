//! What the fuzz targets share: the harness that `cargo test` runs too.

#[path = "../crates/study/tests/it/support/harness.rs"]
mod harness;

/// Checks one file's worth of bytes with the reader of that name.
///
/// # Panics
/// Where the reader does not do what it should.
pub fn check(name: &str, bytes: &[u8]) {
    let reader = harness::READERS.iter().find(|reader| reader.name == name).expect("a target has a reader");
    reader.check(bytes);
}
