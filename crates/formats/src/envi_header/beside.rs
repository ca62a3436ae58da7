//! Which header belongs to which data file: those of one name in one folder, as ENVI and GDAL look for them.

use hadar::error::{Error, Result};
use std::path::{Path, PathBuf};

/// Endings of data files; the first is none.
const DATA_ENDINGS: [&str; 10] = ["", "img", "dat", "bsq", "bil", "bip", "raw", "sli", "sc", "bin"];

/// The header of a data file: `name.img.hdr`, else `name.hdr`; none where neither is there.
#[must_use]
pub fn header_of(data: &Path) -> Option<PathBuf> {
    let appended = |ending: &str| {
        let mut name = data.as_os_str().to_owned();
        name.push(".");
        name.push(ending);
        PathBuf::from(name)
    };
    let replaced = |ending: &str| data.with_extension(ending);
    [appended("hdr"), appended("HDR"), replaced("hdr"), replaced("HDR")]
        .into_iter()
        .find(|path| path != data && path.is_file())
}

/// The data file of a header: the same name without `.hdr`, or with `.img`, `.dat`, `.bsq`, `.bil`, `.bip`, `.raw`, `.sli`, `.sc`, `.bin`.
///
/// # Errors
/// None of them is there, or several.
pub fn data_of(header: &Path) -> Result<PathBuf> {
    let at = |ending: &str| header.with_extension(ending);
    let there = |path: &PathBuf| path != header && path.is_file();
    let mut found: Vec<PathBuf> = DATA_ENDINGS.iter().map(|ending| at(ending)).filter(there).collect();
    if found.is_empty() {
        found = DATA_ENDINGS.iter().skip(1).map(|ending| at(&ending.to_uppercase())).filter(there).collect();
    }
    let one = found.pop();
    match (one, found.last()) {
        (Some(path), None) => Ok(path),
        (Some(a), Some(b)) => {
            let shown = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let found = format!("`{}` and `{}` may both be the data", shown(b), shown(&a));
            Err(Error::malformed(found, "name the one that is meant instead of the header").in_file(header))
        }
        (None, _) => {
            let endings = DATA_ENDINGS.get(1..).unwrap_or_default().join(", .");
            let found = "the data that belong to the header are not beside it";
            let instead = format!("put them there under the same name without .hdr, or with .{endings}");
            Err(Error::malformed(found, instead).in_file(header))
        }
    }
}
