//! What all kinds of files share: how a file is opened, checked, read, and written again.
//!
//! A type of a kind of file reads its root (`of_root`) and lays out its tables (`document`); [`file`] gives it the functions that follow.

use super::camera;
use super::keys::Table;
use super::kind::Kind;
use super::parsed::parse;
use super::section::Section;
use super::setting::Setting;
use super::source::Source;
use super::written::Written;
use hadar::error::{Error, Result};

/// `from_file` and `from_toml` of a type that has `from_written`.
macro_rules! from_file_and_text {
    ($type:ident) => {
        impl $type {
            /// Reads a file. Relative paths in it start from its directory.
            ///
            /// # Errors
            /// The first thing that is wrong, in one line with file, line and key: the file itself (missing, a
            /// directory, not UTF-8), its syntax, an unknown or missing key, a value of the wrong type, without its
            /// unit or outside its range, or values that contradict each other.
            pub fn from_file(path: &std::path::Path) -> hadar::error::Result<Self> {
                Self::from_written(&$crate::Written::from_file(path)?)
            }

            /// Reads a text. `path` is the file it is from, which messages name and relative paths
            /// start from; without it they start from the current directory.
            ///
            /// # Errors
            /// As `from_file`, except those of the file itself.
            pub fn from_toml(text: &str, path: Option<&std::path::Path>) -> hadar::error::Result<Self> {
                Self::from_written(&$crate::Written::of(text, path))
            }
        }
    };
}

/// The functions of a kind of file: `file!(Type, where.its.source, (kind, minimum, keys))`.
macro_rules! file {
    ($type:ident, $($source:ident).+, $kind:expr) => {
        $crate::reader::from_file_and_text!($type);

        impl $type {
            /// Reads it with values in the place of its own.
            ///
            /// # Errors
            /// As `from_file`, except those of the file itself.
            pub fn from_written(written: &$crate::Written) -> hadar::error::Result<Self> {
                let (mut read, source) = $crate::reader::open(written, $kind, Self::of_root)?;
                read.$($source).+ = source;
                Ok(read)
            }

            /// Where `key` stands (`target.material`, `environment[0].material`), to be put on an error with
            /// [`hadar::Error::at`]. A key that was not written has the line of its table.
            #[must_use]
            pub fn place(&self, key: &str) -> hadar::error::Place {
                self.$($source).+.place(key)
            }

            /// The file again as TOML, every default filled in; reading it gives the same question. What stays silent
            /// has no value (a distance, an atmosphere, a camera) or one that others know (a preset's fields, the
            /// library's materials). Paths of files are those of the file, from its folder, so that it may be put beside it;
            /// a file that was named with its whole path outside of that folder has its name alone.
            #[must_use]
            pub fn to_toml(&self) -> String {
                let source = &self.$($source).+;
                $crate::paths::from_home(source, |paths| $crate::entries::text(self.document(paths), source))
            }
        }

        /// The same keys as the TOML, quantities in the units used inside.
        impl serde::Serialize for $type {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
                $crate::paths::from_home(&self.$($source).+, |paths| {
                    $crate::entries::entries(self.document(paths), serializer)
                })
            }
        }
    };
}

pub(super) use {file, from_file_and_text};

/// The command that answers a file, if there is one for its kind.
///
/// # Errors
/// What is no TOML.
pub fn command_for(written: &Written) -> Result<Option<&'static str>> {
    Ok(Kind::command_for(&parse(&written.text, &written.source())?))
}

/// Whether a file is a rule: by the keys of one, or by an envelope of scenes.
///
/// # Errors
/// What is no TOML.
pub fn is_rule(written: &Written) -> Result<bool> {
    let document = parse(&written.text, &written.source())?;
    Ok(Kind::command_for(&document) == Some("rule") || document.contains_key("envelope"))
}

/// Reads a file that is of a kind, has its least in it and only its keys; and where it was read from.
pub(super) fn open<T>(
    written: &Written,
    (kind, minimum, keys): (Kind, &str, &'static Table),
    read: impl FnOnce(&Section<'_>) -> Result<T>,
) -> Result<(T, Source)> {
    let text = &*written.text;
    let mut source = written.source();
    if text.trim().is_empty() {
        return Err(Error::malformed("the file is empty", minimum).at(source.place("")));
    }
    let mut document = match written.parsed_before() {
        Some(parsed) => parsed.document(&mut source),
        None => {
            let document = parse(text, &source)?;
            source.note_lines(text, &document);
            document
        }
    };
    kind.check(&document, &source)?;
    if written.settings.iter().any(camera::moves_noise) {
        let others = || written.settings.iter().filter(|setting| !camera::moves_noise(setting));
        let filed = || {
            let mut filed = document.clone();
            others().try_for_each(|setting| setting.put(&mut filed))?;
            let root = Section::open(&filed, "", &source, keys);
            Ok(root.map(|root| camera::filed(&root)).unwrap_or_default())
        };
        let is_in_camera = |setting: &Setting| setting.covers("camera") || setting.is_in("camera");
        source.filed = match source.kept.as_ref().filter(|_| !others().any(is_in_camera)) {
            Some(kept) => kept.or_read("camera", filed)?,
            None => filed()?,
        };
    }
    for setting in &written.settings {
        setting.put(&mut document)?;
        source.note_setting(setting);
    }
    let read = read(&Section::open(&document, "", &source, keys)?)?;
    Ok((read, source))
}
