//! Files of a user's: only those with an end. A pipe that nobody writes would be waited for, a device has no end.

use crate::hash::sha256;
use crate::hash::stamp;
use hadar::error::{Error, Result};
use hadar::inputs::{self, Held};
use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::Path;

/// What reading a material is called in messages.
pub const READ_SPECTRUM: &str = "read the spectrum";

/// The longest file that is taken for text, bytes.
const LONGEST_FILE: u64 = 1 << 26;

/// Opens an ordinary file to be read part by part, and notes it as it is now.
///
/// # Errors
/// No such file, a directory, a pipe or device, no permission; the message says what `action` could not be done.
pub fn open(path: &Path, action: &str) -> Result<File> {
    let file = opened(path, action)?;
    let found = file.metadata().map_err(|error| Error::file(action, path, error.kind()))?;
    inputs::file(path, Held::Since(stamp(&found)));
    Ok(file)
}

fn opened(path: &Path, action: &str) -> Result<File> {
    let refused = |reason: &str| Error::file(action, path, reason);
    let failed = |error: std::io::Error| match error.kind() {
        ErrorKind::NotFound => refused("there is no such file; check its name and folder"),
        kind => refused(&format!("{kind}; check that it may be read")),
    };
    // Asked before it is opened, which alone may take forever.
    let found = std::fs::metadata(path).map_err(failed)?;
    if found.is_dir() {
        return Err(refused("this is a directory; name a file"));
    }
    if !found.is_file() {
        return Err(refused("this is no ordinary file but a pipe or a device; copy its content to one"));
    }
    File::open(path).map_err(failed)
}

/// All bytes of an ordinary file, which are noted by their hash.
///
/// # Errors
/// As [`open`]; a file of more than `most` bytes.
pub fn bytes(path: &Path, action: &str, most: u64) -> Result<Vec<u8>> {
    let bytes = read(opened(path, action)?, path, action, most)?;
    inputs::file(path, Held::Sha256(sha256(&bytes)));
    Ok(bytes)
}

/// All bytes of what can be read only once, such as standard input, and notes that it was read; `name` stands for a path.
///
/// # Errors
/// What cannot be read; more than `most` bytes.
pub fn stream(from: impl Read, name: &str, action: &str, most: u64) -> Result<Vec<u8>> {
    let bytes = read(from, Path::new(name), action, most)?;
    inputs::stream(name, &bytes);
    Ok(bytes)
}

fn read(from: impl Read, path: &Path, action: &str, most: u64) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let read = from.take(most + 1).read_to_end(&mut bytes);
    read.map_err(|error| Error::file(action, path, format!("{}; check that it may be read", error.kind())))?;
    if bytes.len() as u64 > most {
        let mebibytes = most >> 20;
        let reason = format!("it is longer than {mebibytes} MiB, more than such a file needs");
        return Err(Error::file(action, path, reason));
    }
    Ok(bytes)
}

/// Text of a file: UTF-16 where it begins with the mark of that, else UTF-8, else Latin-1.
///
/// # Errors
/// As [`bytes`]; the message says what `action` could not be done.
pub fn text_of_file(path: &Path, action: &str) -> Result<String> {
    text_within(path, action, LONGEST_FILE)
}

/// The same of a file that is no table but parsed as a whole, which takes up to a hundred times its size: of at most `most` bytes.
pub(crate) fn text_within(path: &Path, action: &str, most: u64) -> Result<String> {
    Ok(text(self::bytes(path, action, most)?))
}

/// All bytes of a file that may be text.
///
/// # Errors
/// As [`bytes`].
pub(crate) fn short_bytes(path: &Path, action: &str) -> Result<Vec<u8>> {
    if action == READ_SPECTRUM && path.is_dir() {
        return Err(Error::file(action, path, "this is a directory; name a file, or give it to --library"));
    }
    bytes(path, action, LONGEST_FILE)
}

/// Text of bytes, as of a file ([`text_of_file`]).
pub(crate) fn text(bytes: Vec<u8>) -> String {
    if let Some(text) = utf_16(&bytes) {
        return text;
    }
    // Latin-1 is the first 256 code points
    String::from_utf8(bytes).unwrap_or_else(|error| error.as_bytes().iter().map(|&b| char::from(b)).collect())
}

/// Text that a byte-order mark says to be UTF-16, as Excel writes `Unicode text`.
fn utf_16(bytes: &[u8]) -> Option<String> {
    let (big, units) = match bytes {
        [0xff, 0xfe, units @ ..] => (false, units),
        [0xfe, 0xff, units @ ..] => (true, units),
        _ => return None,
    };
    let (units, _) = units.as_chunks::<2>();
    let units =
        units.iter().map(|&unit| if big { u16::from_be_bytes(unit) } else { u16::from_le_bytes(unit) });
    Some(char::decode_utf16(units).map(|char| char.unwrap_or(char::REPLACEMENT_CHARACTER)).collect())
}
