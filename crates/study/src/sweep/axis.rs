//! A key and the values that it takes: `camera.exposure=1 ms..100 ms:40:log`, or `target.material=skin,aluminium`.
//!
//! Of a range of n values from a to b the i-th (from 0) is a + i (b − a)/(n − 1), and a (b/a)^(i/(n − 1)) of a logarithmic one; its ends
//! are a and b to the last bit, the others have 15 digits, so that 0.3 is 0.3.

use super::cell::Cell;
use hadar::error::{Error, Result};
use hadar::units::{Dimension, decimal_comma, parts, with_plain_micro};
use hadar_formats::cube::{cubes_in, is_zarr};
use std::path::{Path, PathBuf};

/// Values of a key at most; more are no table that anybody reads.
pub(super) const MOST_VALUES: usize = 1_000_000;
const EXAMPLE: &str =
    "write KEY=FROM..TO:COUNT, as in --vary camera.exposure=\"1 ms..100 ms:40:log\", or KEY=A,B,C";

/// A key and the values that it takes.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// The key, e.g. `camera.exposure`.
    pub key: String,
    /// The values, as they would be written into the file.
    pub values: Vec<String>,
    /// Whether they are spread logarithmically.
    pub logarithmic: bool,
}

impl Axis {
    /// Reads a flag's text.
    ///
    /// # Errors
    /// No key, no value, a range without its number of values or with ends that do not differ, one from zero or below on a
    /// logarithmic scale, ends of different units.
    ///
    /// ```
    /// use hadar_study::sweep::Axis;
    /// assert_eq!(Axis::parse("target.distance=10 m..30 m:3")?.values, ["10 m", "20 m", "30 m"]);
    /// assert_eq!(Axis::parse("camera.exposure=1 ms..100 ms:3:log")?.values, ["1 ms", "10 ms", "100 ms"]);
    /// assert_eq!(Axis::parse("target.material=skin, pmma")?.values, ["skin", "pmma"]);
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn parse(text: &str) -> Result<Self> {
        let refused = || Error::malformed(format!("`{text}` is no key with values"), EXAMPLE);
        let (key, values) = text.split_once('=').ok_or_else(refused)?;
        let (key, values) = (key.trim().to_owned(), values.trim());
        if key.is_empty() || values.is_empty() {
            return Err(refused());
        }
        let named = |error: Error| error.for_key(format!("--vary {key}"));
        let (values, logarithmic) = match range(values).map_err(named)? {
            Some(range) => range,
            None => (listed(values).map_err(named)?, false),
        };
        Ok(Self { key, values, logarithmic })
    }
}

/// Keys of cubes, which a folder of them may be given for.
const CUBES: [&str; 2] = ["cube.data", "cube.left"];

impl Axis {
    /// The same with the cubes of a folder in the place of it: of a key of a cube whose only value names a folder, from that of the
    /// file; none of one that is a cube itself, as a Zarr array or a scene of the HADAR database is.
    ///
    /// # Errors
    /// A folder without cubes.
    pub fn with_cubes_of_folder(self, home: &Path) -> Result<Self> {
        let [folder] = self.values.as_slice() else { return Ok(self) };
        let path = home.join(folder.trim());
        let is_cube = is_zarr(&path) || path.join("HeatCubes").is_dir();
        if !CUBES.contains(&self.key.as_str()) || !path.is_dir() || is_cube {
            return Ok(self);
        }
        let cubes = cubes_in(&path)?;
        if cubes.is_empty() {
            let error = Error::malformed(
                "the folder has no cube",
                "name a folder of NPY, ENVI, HDF5 or other files of cubes",
            );
            return Err(error.in_file(&path).for_key(format!("--vary {}", self.key)));
        }
        let named = |cube: &PathBuf| {
            let name = cube.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
            format!("{}/{name}", folder.trim().trim_end_matches(['/', '\\']))
        };
        Ok(Self { values: cubes.iter().map(named).collect(), ..self })
    }
}

/// Number and unit at an end of a range.
type End<'t> = (f64, &'t str);

/// The values of a range; none of what begins as none does.
fn range(text: &str) -> Result<Option<(Vec<String>, bool)>> {
    let Some((from, rest)) = text.split_once("..").filter(|(from, rest)| is_number(from) && is_number(rest))
    else {
        return Ok(None);
    };
    let mut rest = rest.split(':');
    let (to, count, scale, more) = (rest.next().unwrap_or_default(), rest.next(), rest.next(), rest.next());
    let logarithmic = match scale.map(str::trim) {
        None => false,
        Some("log") if more.is_none() => true,
        Some(_) => {
            let found = format!("`{text}` ends in something unknown");
            return Err(Error::malformed(found, "write FROM..TO:COUNT or FROM..TO:COUNT:log"));
        }
    };
    let Some(count) = count.map(str::trim) else {
        let found = format!("`{text}` does not say how many values");
        return Err(Error::malformed(found, format!("write it, as in \"{text}:20\"")));
    };
    let allowed = |count: &usize| (2..=MOST_VALUES).contains(count);
    let Some(count) = count.parse::<usize>().ok().filter(allowed) else {
        let found = format!("`{count}` values of a range");
        return Err(Error::malformed(found, format!("write a whole number from 2 to {MOST_VALUES}")));
    };
    let ((low, unit), (high, unit_of_end)) = (end(from)?, end(to)?);
    if with_plain_micro(unit) != with_plain_micro(unit_of_end) {
        let found = format!("the range goes from `{}` to `{}`, in two units", from.trim(), to.trim());
        return Err(Error::malformed(found, "write both ends with the same unit"));
    }
    if low >= high {
        let found = format!("the range goes from {} to {}", from.trim(), to.trim());
        return Err(Error::malformed(found, "write the lower end first, and two that differ"));
    }
    if logarithmic && low <= 0.0 {
        let found = format!("`{}` on a logarithmic scale", from.trim());
        return Err(Error::malformed(found, "begin above 0, or leave :log out"));
    }
    if ["degC", "°C", "degF", "°F"].contains(&unit) && logarithmic {
        let found = format!("degrees of {unit} on a logarithmic scale, whose zero is arbitrary");
        return Err(Error::malformed(found, "write both ends in K, or leave :log out"));
    }
    let last = (count - 1) as f64;
    let value = |i: usize| {
        let share = i as f64 / last;
        match (i, logarithmic) {
            (0, _) => low,
            (i, _) if i + 1 == count => high,
            (_, true) => {
                let value = low * (high / low).powf(share);
                rounded(value, value)
            }
            (i, false) => {
                rounded((low * (last - i as f64) + high * i as f64) / last, low.abs().max(high.abs()))
            }
        }
    };
    let written = |i: usize| match unit {
        "" => value(i).to_string(),
        unit => format!("{} {unit}", value(i)),
    };
    // Whole numbers stay such, so that a count may be varied.
    Ok(Some(((0..count).map(written).collect(), logarithmic)))
}

/// A number without what rounding has added to its digits: 15 of them, counted from the first of `size`.
fn rounded(value: f64, size: f64) -> f64 {
    const DIGITS: i32 = 15;
    let decimals = (DIGITS - 1).saturating_sub(size.abs().log10().floor() as i32);
    // Beyond the decimals that a number can have, or without any, it stays as it is.
    match usize::try_from(decimals) {
        Ok(decimals) if (1..300).contains(&decimals) => {
            format!("{value:.decimals$}").parse().map_or(value, |value: f64| value + 0.0)
        }
        _ => value,
    }
}

/// Whether a text begins as a number does.
fn is_number(text: &str) -> bool {
    text.trim_start().trim_start_matches(['-', '+', '.']).starts_with(|first: char| first.is_ascii_digit())
}

fn end(text: &str) -> Result<End<'_>> {
    if let Some(error) = decimal_comma(text) {
        return Err(error);
    }
    let (number, unit) = parts(text.trim());
    match number.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok((number, unit)),
        _ => {
            Err(Error::malformed(format!("`{}` is no end of a range", text.trim()), "write a finite number"))
        }
    }
}

/// The values of a list; commas within quotes, brackets and braces do not part it.
fn listed(text: &str) -> Result<Vec<String>> {
    let (mut values, mut value, mut quote, mut depth) = (Vec::new(), String::new(), None, 0_usize);
    for char in text.chars() {
        match char {
            ',' if quote.is_none() && depth == 0 => values.push(std::mem::take(&mut value)),
            _ => {
                match (char, quote) {
                    ('"' | '\'', None) => quote = Some(char),
                    (char, Some(open)) if char == open => quote = None,
                    ('[' | '{', None) => depth += 1,
                    (']' | '}', None) => depth = depth.saturating_sub(1),
                    _ => {}
                }
                value.push(char);
            }
        }
    }
    values.push(value);
    let values: Vec<String> = values.iter().map(|value| value.trim().to_owned()).collect();
    if let Some(place) = values.iter().position(String::is_empty) {
        let found = format!("the list has nothing at place {}", place + 1);
        return Err(Error::malformed(found, "write values between commas, as in skin,aluminium"));
    }
    // 37,5 is a number with a decimal comma as often as it is two.
    if let Some(twice) = (1..values.len()).find(|i| values[..*i].contains(&values[*i])) {
        return Err(Error::malformed(format!("`{}` stands there twice", values[twice]), "write it once"));
    }
    Ok(values)
}

/// Values as cells of one column: numbers with their unit where all have one and the same, or can be said in that of the first;
/// else the texts.
pub(super) fn column<'v>(key: &str, values: impl Iterator<Item = &'v str> + Clone) -> (String, Vec<Cell>) {
    let read = |text: &'v str| {
        let (number, unit) = parts(text.trim());
        number.parse::<f64>().ok().filter(|number| number.is_finite()).map(|number| (number, unit))
    };
    let given = values.clone().filter(|text| !text.is_empty());
    let unit = given.clone().next().and_then(read).map_or("", |(_, unit)| unit);
    let same =
        |text: &'v str| read(text).is_some_and(|(_, own)| with_plain_micro(own) == with_plain_micro(unit));
    let plain = |text: &'v str| match read(text) {
        Some((number, _)) if number.fract() == 0.0 && unit.is_empty() && number.abs() < 1e15 => {
            Cell::Integer(number as i64)
        }
        Some((number, _)) => Cell::Number(number),
        None => Cell::Empty,
    };
    let text = |text: &'v str| match text {
        "" => Cell::Empty,
        text => Cell::Text(text.into()),
    };
    if given.clone().next().is_some() && given.clone().all(same) {
        return (unit.to_owned(), values.map(plain).collect());
    }
    match dimension(key, unit, given) {
        None => (String::new(), values.map(text).collect()),
        Some(dimension) => {
            let cell = |text: &'v str| match (text, dimension.parse(text)) {
                (text, _) if same(text) => plain(text),
                (_, Ok(value)) => dimension
                    .in_unit(value, unit)
                    .map_or(Cell::Empty, |number| Cell::Number(rounded(number, number))),
                (_, Err(_)) => Cell::Empty,
            };
            (unit.to_owned(), values.map(cell).collect())
        }
    }
}

/// What values of several units measure; none where some are no quantity, or where it matters which of several they are: 20 degC
/// may be a temperature or a difference.
fn dimension<'v>(key: &str, unit: &str, values: impl Iterator<Item = &'v str> + Clone) -> Option<Dimension> {
    let fits = |dimension: &Dimension| values.clone().all(|text| dimension.parse(text).is_ok());
    let fitting: Vec<Dimension> = Dimension::ALL.into_iter().filter(fits).collect();
    let (first, others) = fitting.split_first()?;
    let in_unit = |dimension: &Dimension, text: &str| dimension.in_unit(dimension.parse(text).ok()?, unit);
    let agree = |other: &Dimension| {
        values.clone().all(|text| match (in_unit(first, text), in_unit(other, text)) {
            (Some(a), Some(b)) => (a - b).abs() <= 1e-9 * a.abs().max(b.abs()),
            _ => false,
        })
    };
    if others.iter().all(agree) {
        return Some(*first);
    }
    fitting.into_iter().find(|known| *known == Dimension::Temperature && key.ends_with("temperature"))
}

/// The head of a column as the program writes units: `camera.exposure_ms`, `requirement.speed_m_s`, `bands.step_cm1`.
pub(super) fn with_unit(key: &str, unit: &str) -> String {
    let mut name = key.to_owned();
    if !unit.is_empty() {
        name.push('_');
    }
    for char in with_plain_micro(unit).chars() {
        match char {
            '°' => name.push_str("deg"),
            '/' | ' ' => name.push('_'),
            char if char.is_alphanumeric() || char == '.' => name.push(char),
            _ => {}
        }
    }
    name
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(text: &str) -> Vec<String> {
        Axis::parse(&format!("key={text}")).unwrap().values
    }

    #[test]
    fn round_values_are_round_and_ends_exact() {
        let tenths: Vec<String> = (1..10).map(|tenth| format!("0.{tenth}")).collect();
        assert_eq!(values("0.1..0.9:9"), tenths);
        assert_eq!(values("-0.1..0.3:5"), ["-0.1", "0", "0.1", "0.2", "0.3"]);
        assert_eq!(values("0.01..10:4:log"), ["0.01", "0.1", "1", "10"]);
        assert_eq!(values("1 \u{b5}s..3 \u{3bc}s:3"), ["1 \u{b5}s", "2 \u{b5}s", "3 \u{b5}s"]);
        assert_eq!(values("0..1:4")[1].parse::<f64>().unwrap(), 0.333_333_333_333_33);
        for text in ["0.1234567890123456789..1e300:3", "1e-320..2e-320:3", "-1e308..1e308:3"] {
            let found = values(text);
            let (from, to) = text.trim_end_matches(":3").split_once("..").unwrap();
            assert_eq!(found[0].parse::<f64>(), from.parse(), "{text}");
            assert_eq!(found[2].parse::<f64>(), to.parse(), "{text}");
        }
    }

    #[test]
    fn units_that_measure_the_same_make_one_column() {
        let of = |key: &str, values: &[&str]| column(key, values.iter().copied());
        let numbers = |values: &[f64]| values.iter().map(|value| Cell::Number(*value)).collect::<Vec<_>>();
        let texts =
            |values: &[&str]| values.iter().map(|text| Cell::Text((*text).into())).collect::<Vec<_>>();
        assert_eq!(of("t", &["1 ms", "0.003 s", "7 \u{3bc}s"]), ("ms".into(), numbers(&[1.0, 3.0, 0.007])));
        assert_eq!(of("l", &["8 um", "9000 nm"]), ("um".into(), numbers(&[8.0, 9.0])));
        assert_eq!(of("a.temperature", &["20 degC", "300 K"]), ("degC".into(), numbers(&[20.0, 26.85])));
        // What matters is not guessed, nor what is no quantity at all.
        for mixed in [&["20 degC", "300 K"][..], &["1 ms", "2 m"], &["1 ms", "skin"], &["1", "2 m"]] {
            assert_eq!(of("a.other", mixed), (String::new(), texts(mixed)));
        }
        let gap = of("t", &["1 ms", "", "1 s"]);
        assert_eq!(gap.1, [Cell::Number(1.0), Cell::Empty, Cell::Number(1000.0)]);
    }
}
