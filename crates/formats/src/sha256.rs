//! SHA-256 of what was read, by which a file is known wherever it is, and found again.

use sha2::{Digest, Sha256};
use std::fs::File;
use std::io::Read as _;
use std::path::{Path, PathBuf};

/// SHA-256 (FIPS 180-4) in hexadecimal digits.
#[must_use]
pub fn sha256(bytes: &[u8]) -> String {
    digits(Sha256::new_with_prefix(bytes))
}

/// That of a file's content; `None` of what is no ordinary file, which may have been read up.
///
/// # Errors
/// A file that cannot be read.
pub fn sha256_of_file(path: &Path) -> std::io::Result<Option<String>> {
    if !path.metadata()?.is_file() {
        return Ok(None);
    }
    let (mut file, mut hash, mut part) = (File::open(path)?, Sha256::new(), vec![0; 1 << 16]);
    loop {
        match file.read(&mut part)? {
            0 => return Ok(Some(digits(hash))),
            read => hash.update(&part[..read]),
        }
    }
}

/// The folder nearest to `start` that is the one looked for: `start`, those above it, nearest first, each before the folders directly in it.
/// Who asks for one by the content of its files finds again what was moved along with a report.
#[must_use]
pub fn nearest_folder(start: &Path, is_it: impl Fn(&Path) -> bool) -> Option<PathBuf> {
    let below = |folder: &Path| {
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        let real = entries.filter(|entry| entry.file_type().is_ok_and(|kind| kind.is_dir()));
        let mut folders: Vec<PathBuf> = real.map(|entry| entry.path()).collect();
        folders.sort_unstable();
        folders
    };
    start.ancestors().find_map(|folder| {
        std::iter::once(folder.to_owned()).chain(below(folder)).find(|folder| is_it(folder))
    })
}

fn digits(hash: Sha256) -> String {
    hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// FIPS 180-4, example of one block.
    #[test]
    fn the_hash_is_that_of_the_standard() {
        let expected = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(sha256(b"abc"), expected);
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("abc"), "abc").unwrap();
        assert_eq!(sha256_of_file(&folder.path().join("abc")).unwrap().unwrap(), expected);
        assert_eq!(sha256_of_file(folder.path()).unwrap(), None);
    }

    #[test]
    fn a_folder_is_found_above_and_beside() {
        let root = tempfile::tempdir().unwrap();
        let [report, inputs] = ["a/b/report", "a/inputs"].map(|name| root.path().join(name));
        for folder in [&report, &inputs] {
            std::fs::create_dir_all(folder).unwrap();
        }
        let with = |name: &'static str| nearest_folder(&report, move |folder| folder.join(name).is_file());
        std::fs::write(inputs.join("cube"), "1").unwrap();
        assert_eq!(with("cube"), Some(inputs));
        // What is nearer is taken.
        for folder in [root.path().join("a"), root.path().join("a/b"), report.clone()] {
            std::fs::write(folder.join("cube"), "1").unwrap();
            assert_eq!(with("cube"), Some(folder));
        }
        assert_eq!(with("nowhere"), None);
    }
}
