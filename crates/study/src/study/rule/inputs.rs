//! What an answer rests on, by its content: the rule, every file that it names, the entries of known cameras.
//!
//! SHA-256 (FIPS 180-4) of the bytes of a file; of an embedded camera, of its entry as JSON, so that it changes when a figure
//! or its provenance does, and not when another camera is added.

use super::results::FileHash;
use crate::scenario::{AtmosphereSource, BandSource, MaterialRef, Rule};
use hadar::error::{Error, Result};
use hadar::instrument::figures::TABLE;
use hadar::instrument::presets;
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};

/// Hashes of everything that a rule rests on, the rule first.
pub(super) fn of(rule: &Rule) -> Result<Vec<FileHash>> {
    let source = &rule.scenario.source;
    let name =
        source.path.as_deref().and_then(Path::file_name).map(|name| name.to_string_lossy().into_owned());
    let name = name.unwrap_or_else(|| "the rule".to_owned());
    let mut hashes = vec![FileHash { path: name, sha256: sha256(rule.text.as_bytes()) }];
    for path in files(rule) {
        let bytes =
            std::fs::read(&path).map_err(|error| Error::file("read for its hash", &path, error.kind()))?;
        // As it was written, as far as it lies beside the rule.
        let beside = std::path::absolute(source.directory()).ok();
        let shown = beside.as_deref().and_then(|folder| path.strip_prefix(folder).ok()).unwrap_or(&path);
        hashes.push(FileHash { path: shown.display().to_string(), sha256: sha256(&bytes) });
    }
    let mut named: Vec<&str> =
        rule.cameras.iter().filter_map(|camera| camera.spec.preset.as_deref()).collect();
    named.sort_unstable();
    named.dedup();
    for name in named {
        let entry = serde_json::to_vec(&presets::find(name)?)
            .map_err(|error| Error::malformed(error.to_string(), "report this as a bug"))?;
        hashes.push(FileHash { path: format!("camera {name}, embedded"), sha256: sha256(&entry) });
    }
    Ok(hashes)
}

/// SHA-256 in hexadecimal digits.
fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The files that a rule names, each once, in the order of the alphabet.
fn files(rule: &Rule) -> Vec<PathBuf> {
    let scenario = &rule.scenario;
    let mut files: Vec<&Path> = Vec::new();
    let envelope = scenario.envelope.iter().flat_map(|envelope| envelope.materials.iter().flatten());
    let materials = std::iter::once(&scenario.target.material)
        .chain(scenario.background.iter().filter_map(|background| background.material.as_ref()))
        .chain(scenario.environment.iter().filter_map(|object| object.material.as_ref()))
        .chain(scenario.alternatives.materials.iter().flatten())
        .chain(envelope);
    files.extend(materials.filter_map(|material| match material {
        MaterialRef::File(path) => Some(path.as_path()),
        MaterialRef::Name(_) => None,
    }));
    match &scenario.bands.source {
        BandSource::Filters(path) | BandSource::Rows(path) => files.push(path),
        _ => {}
    }
    if let Some(AtmosphereSource::Table(path)) = scenario.atmosphere.as_ref().map(|air| &air.source) {
        files.push(path);
    }
    let own = rule.cameras.iter().flat_map(|camera| TABLE.iter().filter_map(|row| row.file(&camera.spec)));
    let mut files: Vec<PathBuf> = files.into_iter().chain(own).map(Path::to_owned).collect();
    files.sort();
    files.dedup();
    files
}

#[cfg(test)]
mod tests {
    use super::sha256;

    /// FIPS 180-4, example of one block.
    #[test]
    fn the_hash_is_that_of_the_standard() {
        let expected = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(sha256(b"abc"), expected);
    }
}
