//! Headers of ENVI files: text beside raw binary, one for images and one for spectral libraries.
//!
//! The first line is `ENVI`; then `key = value`, keys in any case, lists and long texts in `{ … }` over several lines, lines that
//! begin with `;` are comments. Keys that nobody asks for are passed over; one that is asked for and wrong is an error with
//! its line.
//!
//! Source: NV5 Geospatial, ENVI Header Files (documentation of ENVI).

mod beside;
mod layout;

pub use beside::{data_of, header_of};
pub use layout::{ByteOrder, DataType, Interleave, Layout};

use crate::file::text_of_file;
use crate::spectral_unit::SpectralUnit;
use hadar::error::{Error, Result};
use hadar::grid::number;
use std::collections::BTreeMap;
use std::path::Path;

/// What the first line is.
const MAGIC: &str = "ENVI";
/// A header, its values still text.
///
/// ```
/// use hadar_formats::envi_header::{EnviHeader, Interleave};
/// let text = "ENVI\nsamples = 640\nlines = 480\nbands = 3\ndata type = 4\ninterleave = bil\nbyte order = 0\n\
///             wavelength units = Micrometers\nwavelength = {8.0,\n 9.5, 11.0}\n";
/// let header = EnviHeader::parse(text)?;
/// assert_eq!(header.layout()?.interleave, Interleave::Bil);
/// assert_eq!(header.numbers("wavelength")?, Some(vec![8.0, 9.5, 11.0]));
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EnviHeader {
    entries: BTreeMap<String, Entry>,
}

/// A value with the line it begins on; in braces it keeps its line breaks.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Entry {
    line: usize,
    text: String,
}

impl Entry {
    /// Items between commas, each with its line; none of an empty list.
    fn items(&self) -> impl Iterator<Item = (usize, &str)> {
        let mut line = self.line;
        let items = if self.text.trim().is_empty() { None } else { Some(self.text.split(',')) };
        items.into_iter().flatten().map(move |item| {
            let breaks = |part: &str| part.matches('\n').count();
            let blank = item.len() - item.trim_start().len();
            let at = line + breaks(item.get(..blank).unwrap_or_default());
            line += breaks(item);
            (at, item.trim())
        })
    }
}

impl EnviHeader {
    /// Whether a file begins as a header does.
    #[must_use]
    pub fn is_one(text: &str) -> bool {
        text.trim_start_matches('\u{feff}').lines().next().is_some_and(|line| line.trim() == MAGIC)
    }

    /// Reads the header of a file.
    ///
    /// # Errors
    /// A file that cannot be read, and as [`EnviHeader::parse`].
    pub fn from_file(path: &Path) -> Result<Self> {
        Self::parse(&text_of_file(path, "read the ENVI header")?).map_err(|error| error.in_file(path))
    }

    /// Reads the text of a header.
    ///
    /// # Errors
    /// Another first line than `ENVI`, a line that is no `key = value`, a key that is there twice and differs, braces that do
    /// not close.
    pub fn parse(text: &str) -> Result<Self> {
        if !Self::is_one(text) {
            let instead = "name the .hdr file that belongs to the data";
            return Err(Error::malformed("the first line is not `ENVI`", instead).on_line(1));
        }
        let mut entries: BTreeMap<String, Entry> = BTreeMap::new();
        let mut lines = text.lines().enumerate().skip(1).map(|(index, line)| (index + 1, line.trim()));
        while let Some((line, content)) = lines.next() {
            if content.is_empty() || content.starts_with(';') {
                continue;
            }
            let Some((key, value)) = content.split_once('=') else {
                let found = "this is no `key = value`";
                return Err(Error::malformed(found, "delete the line, or begin it with `;`").on_line(line));
            };
            let key = key.split_whitespace().collect::<Vec<_>>().join(" ").to_lowercase();
            let value = value.trim();
            let text = match value.strip_prefix('{') {
                None => value.to_owned(),
                Some(first) => {
                    braced(first, &mut lines).map_err(|error| error.for_key(key.as_str()).on_line(line))?
                }
            };
            let entry = Entry { line, text };
            match entries.get(&key) {
                Some(before) if before.text != entry.text => {
                    let found = format!("this key is there already on line {}", before.line);
                    return Err(Error::malformed(found, "keep one of the two").for_key(key).on_line(line));
                }
                _ => entries.insert(key, entry),
            };
        }
        Ok(Self { entries })
    }

    fn entry(&self, key: &str) -> Option<&Entry> {
        self.entries.get(key).filter(|entry| !entry.text.trim().is_empty())
    }

    /// The text of a key, which is written in lower case here; none of an empty value.
    #[must_use]
    pub fn text(&self, key: &str) -> Option<&str> {
        self.entry(key).map(|entry| entry.text.trim())
    }

    /// All keys, in lower case, with their texts.
    pub(crate) fn all(&self) -> impl Iterator<Item = (&str, &str)> {
        self.entries.iter().map(|(key, entry)| (key.as_str(), entry.text.trim()))
    }

    /// The items of a list.
    #[must_use]
    pub fn list(&self, key: &str) -> Option<Vec<&str>> {
        Some(self.entry(key)?.items().map(|(_, item)| item).collect())
    }

    /// A list of finite numbers, such as `wavelength`, `fwhm`, `data gain values` and `data offset values`.
    ///
    /// # Errors
    /// An item that is no finite number.
    pub fn numbers(&self, key: &str) -> Result<Option<Vec<f64>>> {
        let Some(entry) = self.entry(key) else { return Ok(None) };
        // A comma after the last number is no number that is missing.
        let mut items: Vec<(usize, &str)> = entry.items().collect();
        items.pop_if(|(_, item)| item.is_empty());
        let read =
            |(line, item): (usize, &str)| number(item).map_err(|error| error.for_key(key).on_line(line));
        items.into_iter().map(read).collect::<Result<Vec<f64>>>().map(Some)
    }

    /// A finite number, such as `data ignore value` or `reflectance scale factor`.
    ///
    /// # Errors
    /// Another value.
    pub fn number(&self, key: &str) -> Result<Option<f64>> {
        let read = |text: &str| number(text).map_err(|error| self.wrong(key, error));
        self.text(key).map(read).transpose()
    }

    /// The `data ignore value`, which samples that are missing have; none where nothing is said or it is NaN, which no number is.
    ///
    /// # Errors
    /// Another text.
    pub fn ignored(&self) -> Result<Option<f64>> {
        const KEY: &str = "data ignore value";
        match self.text(KEY) {
            Some(text) if text.eq_ignore_ascii_case("nan") => Ok(None),
            _ => self.number(KEY),
        }
    }

    /// A list of as many finite numbers as there are `count` of `what` (bands, channels).
    ///
    /// # Errors
    /// As [`EnviHeader::numbers`], and another length.
    pub fn numbers_for(&self, key: &str, count: usize, what: &str) -> Result<Option<Vec<f64>>> {
        match self.numbers(key)? {
            Some(numbers) if numbers.len() != count => {
                let found = format!("{} numbers for {count} {what}", numbers.len());
                Err(self.wrong(key, Error::malformed(found, format!("write one for each of the {what}"))))
            }
            numbers => Ok(numbers),
        }
    }

    /// Which bands are good (`bbl`: 1 is good, 0 is bad); none where nothing is said.
    ///
    /// # Errors
    /// Another number than 0 and 1, or another length.
    pub fn good_bands(&self, count: usize) -> Result<Option<Vec<bool>>> {
        let Some(numbers) = self.numbers_for("bbl", count, "bands")? else { return Ok(None) };
        match numbers.iter().find(|&&number| number != 0.0 && number != 1.0) {
            None => Ok(Some(numbers.iter().map(|&number| number == 1.0).collect())),
            Some(other) => {
                let found = format!("`{other}` in the list of bad bands");
                Err(self.wrong("bbl", Error::malformed(found, "write 1 for a good band and 0 for a bad one")))
            }
        }
    }

    /// The unit of `wavelength` and `fwhm`; none where nothing is said or it is `Unknown`.
    ///
    /// # Errors
    /// A unit that is not one of a spectral axis (`Index` too).
    pub fn wavelength_unit(&self) -> Result<Option<SpectralUnit>> {
        const KEY: &str = "wavelength units";
        match self.text(KEY) {
            None => Ok(None),
            Some(text) if text.eq_ignore_ascii_case("unknown") => Ok(None),
            Some(text) => match SpectralUnit::spelt(text) {
                Some(unit) => Ok(Some(unit)),
                None => {
                    let found = format!("`{text}` is not a unit of wavelengths");
                    let instead = "write Micrometers, Nanometers, Wavenumber, GHz or THz";
                    Err(self.wrong(KEY, Error::malformed(found, instead)))
                }
            },
        }
    }

    /// Whether `file type` says that it is a spectral library.
    #[must_use]
    pub fn is_spectral_library(&self) -> bool {
        self.text("file type").is_some_and(|text| text.to_lowercase().contains("spectral library"))
    }

    fn needed(&self, key: &str, instead: &str) -> Result<&str> {
        self.text(key).ok_or_else(|| {
            let error = Error::malformed(format!("the header has no `{key}`"), instead);
            match self.entries.get(key) {
                Some(entry) => error.on_line(entry.line),
                None => error,
            }
        })
    }

    /// An error of a key's value, at its place.
    #[must_use]
    pub fn wrong(&self, key: &str, error: Error) -> Error {
        match self.entries.get(key) {
            Some(entry) => error.for_key(key).on_line(entry.line),
            None => error.for_key(key),
        }
    }
}

/// What stands in braces, up to the one that closes the first; line breaks are kept.
fn braced<'a>(first: &'a str, lines: &mut impl Iterator<Item = (usize, &'a str)>) -> Result<String> {
    let (mut text, mut rest, mut depth) = (String::new(), first, 1_usize);
    loop {
        // A comment may stand between the items.
        let content = if rest.starts_with(';') { "" } else { rest };
        for (at, char) in content.char_indices() {
            match char {
                '{' => depth += 1,
                '}' => depth -= 1,
                _ => {}
            }
            if depth == 0 {
                let (inside, after) = content.split_at(at);
                text.push_str(inside);
                if after.trim_start_matches('}').trim().is_empty() {
                    return Ok(text);
                }
                let found = "there is text after the closing `}`";
                return Err(Error::malformed(found, "put it on a line of its own"));
            }
        }
        text.push_str(content);
        text.push('\n');
        match lines.next() {
            Some((_, next)) => rest = next,
            None => return Err(Error::malformed("the `{` is not closed", "write `}` after its last item")),
        }
    }
}

#[cfg(test)]
mod tests;
