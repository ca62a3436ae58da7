//! Files by their content: SHA-256 (FIPS 180-4) of what was read, in hexadecimal digits, taken as it was read.
//!
//! A file that is read whole is hashed then. One that is read part by part is hashed afterwards, and only if nobody has touched it
//! since it was opened ([`Stamp`]): a hash never is that of other bytes than those that an answer rests on. By its hash a file is known
//! wherever it is, and found again.

use hadar::error::{Error, Result};
use hadar::inputs::{FileRead, Held, Inputs, Stamp};
use sha2::{Digest as _, Sha256};
use std::collections::HashMap;
use std::fs::{File, Metadata};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// That of bytes.
#[must_use]
pub fn sha256(bytes: &[u8]) -> String {
    digits(Sha256::new_with_prefix(bytes))
}

/// That of what is read to its end.
///
/// # Errors
/// What cannot be read.
pub fn sha256_of(mut from: impl Read) -> io::Result<String> {
    let (mut hash, mut part) = (Sha256::new(), vec![0; 1 << 16]);
    loop {
        match from.read(&mut part)? {
            0 => return Ok(digits(hash)),
            read => hash.update(&part[..read]),
        }
    }
}

/// By which an open file is known.
pub(crate) fn stamp(found: &Metadata) -> Stamp {
    #[cfg(unix)]
    let known_by = {
        use std::os::unix::fs::MetadataExt as _;
        [found.dev().into(), found.ino().into(), found.ctime().into(), found.ctime_nsec().into()]
    };
    #[cfg(not(unix))]
    let known_by = [0; 4];
    Stamp { length: found.len(), modified: found.modified().ok(), known_by }
}

/// That of a file as it is now; `None` of what is no ordinary file, which may have been read up.
///
/// # Errors
/// A file that cannot be read.
pub fn sha256_of_file(path: &Path) -> io::Result<Option<String>> {
    if !path.metadata()?.is_file() {
        return Ok(None);
    }
    sha256_of(File::open(path)?).map(Some)
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

/// That of what a job read of a file.
///
/// # Errors
/// A file that can no longer be read, or that was changed since it was opened.
pub fn sha256_of_read(read: &FileRead) -> Result<String> {
    let stamp = match &read.held {
        Held::Sha256(hash) => return Ok(hash.clone()),
        Held::Since(stamp) => *stamp,
    };
    let failed = |error: io::Error| Error::file("read for its hash", &read.path, error.kind());
    let file = File::open(&read.path).map_err(failed)?;
    let is_same = || file.metadata().map(|found| self::stamp(&found) == stamp).map_err(failed);
    if !is_same()? {
        return Err(changed(&read.path));
    }
    let hash = sha256_of(&file).map_err(failed)?;
    if is_same()? { Ok(hash) } else { Err(changed(&read.path)) }
}

/// The files that a job read, each with the hash of what was read.
///
/// # Errors
/// As [`sha256_of_read`]; a file that held one thing and then another.
pub fn of_all_read(inputs: &Inputs) -> Result<Vec<(PathBuf, String)>> {
    let mut all: Vec<(PathBuf, String)> = Vec::with_capacity(inputs.files.len());
    let mut places: HashMap<&Path, usize> = HashMap::new();
    for read in &inputs.files {
        let hash = sha256_of_read(read)?;
        match places.get(read.path.as_path()).and_then(|place| all.get(*place)) {
            Some((_, known)) if *known != hash => return Err(changed(&read.path)),
            Some(_) => {}
            None => {
                places.insert(&read.path, all.len());
                all.push((read.path.clone(), hash));
            }
        }
    }
    Ok(all)
}

fn changed(path: &Path) -> Error {
    Error::file("take as an input", path, "it was changed while it was read; run this again")
}

fn digits(hash: Sha256) -> String {
    let digit = |half: u8| char::from_digit(half.into(), 16).unwrap_or('0');
    hash.finalize().iter().flat_map(|byte| [digit(byte >> 4), digit(byte & 15)]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::file;
    use hadar::inputs::inputs_of;

    /// FIPS 180-4, example of one block.
    const ABC: &str = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";

    #[test]
    fn the_hash_is_that_of_the_standard() {
        assert_eq!(sha256(b"abc"), ABC);
        assert_eq!(sha256_of(&b"abc"[..]).unwrap(), ABC);
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("abc"), "abc").unwrap();
        assert_eq!(sha256_of_file(&folder.path().join("abc")).unwrap().unwrap(), ABC);
        assert_eq!(sha256_of_file(folder.path()).unwrap(), None);
    }

    /// Whatever is done to a file after it was read, its hash is that of what was read, or there is none.
    #[test]
    fn a_hash_is_that_of_the_bytes_that_were_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        let changes: [&dyn Fn(); 4] = [
            &|| {},
            &|| std::fs::write(&path, "xyz").unwrap(),
            &|| {
                std::fs::write(folder.path().join("b"), "abc").unwrap();
                std::fs::rename(folder.path().join("b"), &path).unwrap();
            },
            // Away and back again, with another content between.
            &|| {
                let kept = folder.path().join("kept");
                std::fs::rename(&path, &kept).unwrap();
                std::fs::write(&path, "xyz").unwrap();
                std::fs::rename(&kept, &path).unwrap();
            },
        ];
        for (at, change) in changes.iter().enumerate() {
            std::fs::write(&path, "abc").unwrap();
            let (whole, noted) = inputs_of(|| file::bytes(&path, "read", 9));
            let (opened, in_parts) = inputs_of(|| file::open(&path, "read"));
            // Clocks of files tick slower than this test runs.
            std::thread::sleep(std::time::Duration::from_millis(20));
            change();
            assert!(whole.is_ok() && opened.is_ok());
            assert_eq!(of_all_read(&noted).unwrap(), [(path.clone(), ABC.to_owned())], "{at}");
            let hash = of_all_read(&in_parts);
            if at == 0 {
                assert_eq!(hash.unwrap(), [(path.clone(), ABC.to_owned())]);
            } else if cfg!(unix) {
                let message = hash.unwrap_err().to_string();
                assert!(message.contains("it was changed while it was read; run this again"), "{message}");
            }
        }
        let (_, twice) = inputs_of(|| {
            let first = file::bytes(&path, "read", 9);
            std::fs::write(&path, "xyz").unwrap();
            (first, file::bytes(&path, "read", 9))
        });
        assert!(of_all_read(&twice).is_err(), "one thing and then another");
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
