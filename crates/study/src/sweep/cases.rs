//! Cases: a CSV table whose header names keys and whose rows are values that go together.
//!
//! Commas stand between cells; where the header has none, semicolons or tabs, as spreadsheets write them in some languages. A table that
//! a sweep has written is asked again: what it varied stands between its columns `row` and `status`, with its unit in the head
//! (`camera.exposure_ms`).

use super::axis::with_unit;
use hadar::error::{Error, Result};
use hadar::units::Dimension;
use hadar_formats::file;
use hadar_scenario::keys;
use std::ops::Range;
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
    /// let swept = "row,target.material,target.distance_m,status,message,verdict.met\n0,skin,5,ok,,true\n1,pmma,,ok,,true\n";
    /// assert_eq!(Cases::parse(swept)?, cases);
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
        let header: Vec<String> = reader.headers().map_err(refused)?.iter().map(str::to_owned).collect();
        let cells = header.len();
        let varied = varied_by_a_sweep(&header);
        let (keys, units): (Vec<String>, Vec<&str>) = match &varied {
            Some(varied) => {
                header.iter().take(varied.end).skip(varied.start).map(|head| parted(head)).unzip()
            }
            None => header.into_iter().map(|key| (key, "")).unzip(),
        };
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
            if record.len() != cells {
                let found = format!("{} cells where the header has {cells}", record.len());
                let instead = "write one for every key, an empty one to leave what the scenario says";
                let line = record.position().map_or(0, csv::Position::line);
                return Err(Error::malformed(found, instead).on_line(usize::try_from(line).unwrap_or(0)));
            }
            let first = varied.as_ref().map_or(0, |varied| varied.start);
            let values = record.iter().skip(first).zip(&units).map(|(cell, unit)| match (cell, *unit) {
                (cell, "") if varied.is_some() => as_given(cell).to_owned(),
                ("", _) | (_, "") => cell.to_owned(),
                (number, unit) => format!("{number} {unit}"),
            });
            rows.push(values.collect());
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

/// Which columns a sweep has varied, of a table that one has written.
fn varied_by_a_sweep(header: &[String]) -> Option<Range<usize>> {
    let end = header.iter().position(|head| head == "status")?;
    (header.first()? == "row" && header.get(end + 1)? == "message").then_some(1..end)
}

/// A key and the unit of its column. What is a key as it stands has no unit.
fn parted(head: &str) -> (String, &'static str) {
    let is_key = |path: &str| !keys::find(path).is_empty();
    let units = Dimension::ALL.into_iter().flat_map(Dimension::spellings);
    let key = |unit: &'static str| Some((head.strip_suffix(&with_unit("", unit))?, unit));
    let mut found: Vec<(&str, &str)> =
        if is_key(head) { Vec::new() } else { units.filter_map(key).collect() };
    // `speed_m_s` is a speed and no time.
    found.sort_by_key(|(key, _)| key.len());
    let known = found.iter().find(|(key, _)| is_key(key)).or(found.first());
    known.map_or((head.to_owned(), ""), |(key, unit)| ((*key).to_owned(), *unit))
}

/// A text before a sweep has put an apostrophe before it, so that no spreadsheet computes it.
fn as_given(cell: &str) -> &str {
    let computed = |rest: &&str| rest.trim_start_matches('\'').starts_with(['=', '@', '+', '-']);
    cell.strip_prefix('\'').filter(computed).unwrap_or(cell)
}

/// What stands between the cells of the header: keys have neither commas nor semicolons nor tabs.
fn delimiter(text: &str) -> u8 {
    let is_header = |line: &&str| !line.trim().is_empty() && !line.starts_with('#');
    let header = text.lines().find(is_header).unwrap_or_default();
    [b',', b';', b'\t'].into_iter().find(|sign| header.as_bytes().contains(sign)).unwrap_or(b',')
}

#[cfg(test)]
mod tests {
    use super::*;
    use hadar_scenario::keys::Value;

    /// Every key with every unit that it takes is found again by the head of its column, and every key without a unit.
    #[test]
    fn heads_of_columns_are_keys_with_their_units() {
        fn dimensions(value: Value) -> Vec<Dimension> {
            match value {
                Value::Quantity(dimension, _) => vec![dimension],
                Value::Spectral => vec![Dimension::Wavenumber, Dimension::Wavelength],
                Value::Either(kinds) => kinds.iter().flat_map(|kind| dimensions(*kind)).collect(),
                _ => Vec::new(),
            }
        }
        let mut found = 0;
        for place in keys::all() {
            for path in &place.paths {
                assert_eq!(parted(path), (path.clone(), ""));
                for dimension in dimensions(place.key.value) {
                    for unit in dimension.spellings() {
                        let (key, read) = parted(&with_unit(path, unit));
                        assert_eq!(key, *path, "{unit}");
                        let of = |unit: &str| dimension.parse(&format!("2 {unit}")).unwrap();
                        assert_eq!(of(read), of(unit), "{path} {unit} {read}");
                        found += 1;
                    }
                }
            }
        }
        assert!(found > 500, "{found}");
        assert_eq!(parted("environment[1].temperature_degC"), ("environment[1].temperature".into(), "degC"));
    }

    #[test]
    fn a_text_that_a_sweep_has_marked_is_as_it_was() {
        let swept = "row,target.material,status,message\n0,'=a.csv,ok,\n1,'tis.csv,error,why\n";
        assert_eq!(Cases::parse(swept).unwrap().rows, [["=a.csv"], ["'tis.csv"]]);
        // Without its columns it is a table like any other.
        assert_eq!(Cases::parse("row,target.material\n0,skin\n").unwrap().keys, ["row", "target.material"]);
    }
}
