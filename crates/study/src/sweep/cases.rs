//! Cases: a CSV table whose header names keys and whose rows are values that go together.
//!
//! Commas stand between cells; where the header has none, semicolons or tabs, as spreadsheets write them in some languages.

use hadar::error::{Error, Result};
use hadar_formats::file;
use std::path::Path;

/// The longest table of cases, bytes.
const LONGEST_FILE: u64 = 1 << 26;

/// Values of keys that change together, row by row. An empty one leaves the file's own.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Cases {
    /// The keys.
    pub keys: Vec<String>,
    /// The values of each row, in the order of the keys.
    pub rows: Vec<Vec<String>>,
}

impl Cases {
    /// Reads a table of cases.
    ///
    /// # Errors
    /// A file that cannot be read, a header without keys or with one twice, a row of another length, no row at all.
    pub fn from_file(path: &Path) -> Result<Self> {
        let bytes = file::bytes(path, "read the cases", LONGEST_FILE)?;
        let text = String::from_utf8(bytes).map_err(|_| {
            Error::malformed("the file is not UTF-8 text", "name a CSV file, saved as UTF-8").in_file(path)
        })?;
        Self::parse(&text).map_err(|error| error.in_file(path))
    }

    /// Reads the text of a table.
    ///
    /// # Errors
    /// As [`Cases::from_file`], except those of the file itself.
    ///
    /// ```
    /// use hadar_study::sweep::Cases;
    /// let cases = Cases::parse("target.material,target.distance\nskin,5 m\npmma,\n")?;
    /// assert_eq!(cases.rows[1], ["pmma", ""]);
    /// assert_eq!(Cases::parse("target.material;target.distance\nskin;5 m\npmma;\n")?, cases);
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn parse(text: &str) -> Result<Self> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let mut reader = csv::ReaderBuilder::new()
            .trim(csv::Trim::All)
            .comment(Some(b'#'))
            .flexible(true)
            .delimiter(delimiter(text))
            .from_reader(text.as_bytes());
        let refused = |error: csv::Error| {
            Error::malformed(format!("this is no CSV table: {error}"), "write commas between the cells")
        };
        let keys: Vec<String> = reader.headers().map_err(refused)?.iter().map(str::to_owned).collect();
        let header = "name keys in the first line, as in target.material,target.distance";
        if keys.iter().any(String::is_empty) {
            return Err(Error::malformed("a column has no key", header).on_line(1));
        }
        if let Some(twice) = (1..keys.len()).find(|i| keys[..*i].contains(&keys[*i])) {
            let found = format!("two columns of the key `{}`", keys[twice]);
            return Err(Error::malformed(found, "keep one of them").on_line(1));
        }
        let mut rows = Vec::new();
        for record in reader.records() {
            let record = record.map_err(refused)?;
            if record.len() != keys.len() {
                let found = format!("{} cells where the header has {}", record.len(), keys.len());
                let instead = "write one for every key, an empty one to leave what the scenario says";
                let line = record.position().map_or(0, csv::Position::line);
                return Err(Error::malformed(found, instead).on_line(usize::try_from(line).unwrap_or(0)));
            }
            rows.push(record.iter().map(str::to_owned).collect());
        }
        if rows.is_empty() {
            return Err(Error::malformed(
                "the table has no cases",
                "write them below the header, a line each",
            ));
        }
        Ok(Self { keys, rows })
    }
}

/// What stands between the cells of the header: keys have neither commas nor semicolons nor tabs.
fn delimiter(text: &str) -> u8 {
    let is_header = |line: &&str| !line.trim().is_empty() && !line.starts_with('#');
    let header = text.lines().find(is_header).unwrap_or_default();
    [b',', b';', b'\t'].into_iter().find(|sign| header.as_bytes().contains(sign)).unwrap_or(b',')
}
