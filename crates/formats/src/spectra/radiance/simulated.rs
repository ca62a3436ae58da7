//! What programs of radiative transfer write: tape7 of MODTRAN 4 to 6 (`tape7`, `.tp7`, `.7sc`) and the text files of LBLRTM.
//!
//! tape7 begins with the cards of the run; below the names of the columns, the first of which is `FREQ`, stand the rows, and a row of -9999
//! ends a run. By wavenumber radiances are W cm⁻² sr⁻¹ per cm⁻¹. Runs without the sun leave their columns empty. LBLRTM writes a line
//! `WAVENUMBER RADIANCE` above its rows, in the same unit, or `TEMPERATURE`, which is a brightness temperature.
//!
//! Source: Berk et al., MODTRAN 5.3 User's Manual (2013), tape7; Clough et al., LBLRTM, output of PLTLBL, and its table of units.

use super::column::{Column, Unit};
use crate::cube::TemperatureUnit;
use crate::spectra::bytes::FETCH_AGAIN;
use hadar::error::{Error, Result, check};
use hadar::grid::number;
use hadar::radiance_unit::RadianceUnit;

/// The unit of both programs.
const UNIT: &str = "W cm^-2 sr^-1 (cm^-1)^-1";
/// Columns that are radiances.
const RADIANCES: [&str; 10] = [
    "PTH_THRML",
    "THRML_EM",
    "THRML_SCT",
    "SURF_EMIS",
    "SOL_SCAT",
    "MULT_SCAT",
    "SING_SCAT",
    "GRND_RFLT",
    "DRCT_RFLT",
    "TOTAL_RAD",
];
/// Columns that are empty where the sun is not in the run.
const OF_THE_SUN: [&str; 7] =
    ["SOL_SCAT", "MULT_SCAT", "SING_SCAT", "DRCT_RFLT", "REF_SOL", "SOL@OBS", "TOA_SUN"];
/// Names of two words, as MODTRAN 4 writes them, and what begins them.
const TWO_WORDS: [&str; 10] = ["REF", "TOT", "PTH", "THRML", "SURF", "SOL", "SING", "GRND", "DRCT", "TOTAL"];
/// The column of brightness temperatures.
const BRIGHTNESS: &str = "BBODY_T[K]";
/// What ends a run.
const END: f64 = -9999.0;

/// The column of a file of these programs; none where it is another's.
pub(super) fn column(text: &str, wanted: &str) -> Result<Option<Column>> {
    let lines: Vec<(usize, &str)> =
        text.lines().enumerate().map(|(at, line)| (at + 1, line.trim())).collect();
    let at = |is_one: fn(&str) -> bool| lines.iter().position(|(_, line)| is_one(line));
    match (at(is_names), at(is_lblrtm), at(is_names_with_commas)) {
        (Some(at), _, _) => modtran(&lines, at, wanted).map(Some),
        (None, Some(at), _) => lblrtm(&lines, at, wanted).map(Some),
        (None, None, Some(at)) => Err(Error::malformed(
            "this is a table of MODTRAN 6 with commas, of whose columns and units there is no public description",
            "give the .tp7 of the same run; or, in Python, import pandas and keep two columns under a header that says the unit: \
             t = pandas.read_csv(FILE, skiprows=LINES, header=None); t[[0, 9]][:-1].to_csv(\"sky.csv\", index=False, \
             header=[\"wavenumber_cm1\", \"sky [W cm^-2 sr^-1 (cm^-1)^-1]\"])",
        )
        .on_line(at + 1)),
        (None, None, None) => Ok(None),
    }
}

/// The program that wrote a text.
pub(super) fn program(text: &str) -> Option<&'static str> {
    if text.lines().any(|line| is_names(line) || is_names_with_commas(line)) {
        return Some("MODTRAN");
    }
    text.lines().any(is_lblrtm).then_some("LBLRTM")
}

/// Whether a line names the columns of a text of LBLRTM.
fn is_lblrtm(line: &str) -> bool {
    let words: Vec<&str> = line.trim().trim_start_matches('0').split_whitespace().collect();
    matches!(words[..], ["WAVENUMBER", _] | ["WAVENUMBER", _, _]) && !line.contains(',')
}

/// Whether a line names the columns of tape7.
fn is_names(line: &str) -> bool {
    let first = line.split_whitespace().next().unwrap_or_default();
    !line.contains(',')
        && (first.starts_with("FREQ") || first.starts_with("WAVLEN"))
        && (line.contains("THRML") || line.contains("TRAN") || line.contains("COMBIN"))
}

/// Whether a line names the columns of what MODTRAN 6 writes with commas.
fn is_names_with_commas(line: &str) -> bool {
    let mut cells = line.split(',').map(|cell| cell.trim().to_lowercase().replace(['_', '-'], " "));
    let first = cells.next().unwrap_or_default();
    let of_paths = [
        "total rad",
        "path emiss",
        "pth thrml",
        "path thermal scat",
        "surf emis",
        "surface emiss",
        "combin trans",
    ];
    first.starts_with("freq") && cells.any(|cell| of_paths.contains(&cell.as_str()))
}

/// Names of columns, of two words with a line between them.
fn names(line: &str) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    let words: Vec<&str> = line.split_whitespace().collect();
    let mut at = 0;
    while let Some(word) = words.get(at) {
        let next = words.get(at + 1).copied().unwrap_or_default();
        let is_split =
            TWO_WORDS.contains(word) && !next.is_empty() && !next.contains(['_', '@']) && next != "DEPTH";
        names.push(if is_split { format!("{word}_{next}") } else { (*word).to_owned() });
        at += if is_split { 2 } else { 1 };
    }
    names
}

fn modtran(lines: &[(usize, &str)], at: usize, wanted: &str) -> Result<Column> {
    let (header_line, header) = lines.get(at).copied().unwrap_or((0, ""));
    let wrong = |found: String, instead: &str| Err(Error::malformed(found, instead).on_line(header_line));
    let mut names = names(header);
    let first = names.first().cloned().unwrap_or_default();
    if !first.starts_with("FREQ") {
        let found = format!("radiances of MODTRAN by `{first}`, whose unit the file does not say");
        return wrong(found, "run it by wavenumber (FREQ), or write a table with the unit in its header");
    }
    if names.iter().any(|name| name == "LOS") {
        return wrong("several lines of sight in one file".into(), "run MODTRAN for one of them");
    }
    let wanted = wanted.trim();
    if !names.iter().skip(1).any(|name| name == wanted) {
        let known = names.iter().skip(1).map(String::as_str);
        return Err(Error::unknown_name("column", wanted, known).for_key("column"));
    }
    let unit = if wanted == BRIGHTNESS {
        Unit::Brightness(TemperatureUnit::KELVIN)
    } else if RADIANCES.contains(&wanted) {
        Unit::Stated(RadianceUnit::spelt(UNIT)?)
    } else {
        let found = format!("the column `{wanted}` of MODTRAN, which is no radiance");
        return wrong(found, "name TOTAL_RAD, or another of its radiances");
    };
    let below = lines.get(at + 1..).unwrap_or_default();
    let mut below = below.iter().filter(|(_, line)| !line.is_empty());
    let (mut axis, mut values, mut on, mut ended) = (Vec::new(), Vec::new(), Vec::new(), false);
    // Columns of the sun are empty in all rows of a run without it.
    let of_the_sun = names.iter().filter(|name| OF_THE_SUN.contains(&name.as_str())).count();
    let first = below.clone().next().map_or(0, |(_, row)| row.split_whitespace().count());
    if first + of_the_sun == names.len() {
        names.retain(|name| !OF_THE_SUN.contains(&name.as_str()));
    }
    for (line, row) in below.by_ref() {
        let cells = row.split_whitespace().map(number).collect::<Result<Vec<f64>>>();
        let cells = cells.map_err(|error| error.on_line(*line))?;
        if cells.first() == Some(&END) {
            ended = true;
            break;
        }
        if cells.len() != names.len() {
            let found = format!("{} numbers where {} columns are named", cells.len(), names.len());
            return Err(Error::malformed(found, FETCH_AGAIN).on_line(*line));
        }
        let Some(column) = names.iter().position(|name| name == wanted) else {
            let found = format!("`{wanted}` is empty in a run without the sun");
            return Err(Error::malformed(found, "name TOTAL_RAD, or run MODTRAN with the sun").on_line(*line));
        };
        let nu = cells.first().copied().unwrap_or(f64::NAN);
        axis.push(check::positive("wavenumber", nu, "cm^-1").map_err(|error| error.on_line(*line))?);
        values.push(cells.get(column).copied().unwrap_or(f64::NAN));
        on.push(*line);
    }
    if !ended {
        return wrong("the row of -9999 that ends a run is missing".into(), FETCH_AGAIN);
    }
    if let Some((line, _)) = below.find(|(_, line)| is_names(line)) {
        let found = format!("another run begins on line {line}");
        return wrong(found, "keep one run in the file");
    }
    Ok(Column { name: wanted.to_owned(), unit, lines: on, rows: axis.into_iter().zip(values).collect() })
}

fn lblrtm(lines: &[(usize, &str)], at: usize, wanted: &str) -> Result<Column> {
    let (header_line, header) = lines.get(at).copied().unwrap_or((0, ""));
    let name = header.split_once("WAVENUMBER").map_or("", |(_, rest)| rest.trim());
    let unit = match name {
        "RADIANCE" => Unit::Stated(RadianceUnit::spelt(UNIT)?),
        "TEMPERATURE" => Unit::Brightness(TemperatureUnit::KELVIN),
        other => {
            let found = format!("`{other}` of LBLRTM, which is no radiance");
            return Err(Error::malformed(found, "write its radiance out (TAPE27)").on_line(header_line));
        }
    };
    if wanted != name {
        return Err(Error::unknown_name("column", wanted, [name]).for_key("column"));
    }
    let (mut on, mut rows) = (Vec::new(), Vec::new());
    for (line, row) in lines.get(at + 1..).unwrap_or_default().iter().filter(|(_, line)| !line.is_empty()) {
        let cells = row.split_whitespace().map(number).collect::<Result<Vec<f64>>>();
        let [nu, value] = cells.map_err(|error| error.on_line(*line))?[..] else {
            let found = "this line is not a wavenumber and a value";
            return Err(Error::malformed(found, FETCH_AGAIN).on_line(*line));
        };
        rows.push((check::positive("wavenumber", nu, "cm^-1").map_err(|error| error.on_line(*line))?, value));
        on.push(*line);
    }
    Ok(Column { name: name.to_owned(), unit, lines: on, rows })
}

/// Refuses records of Fortran, as LBLRTM writes its TAPE12.
///
/// # Errors
/// A file whose first record has its length before and behind it.
pub(super) fn refuse_unformatted(bytes: &[u8]) -> Result<()> {
    let word = |at: usize| Some(u32::from_le_bytes(*bytes.get(at..)?.first_chunk::<4>()?));
    let length = word(0)
        .and_then(|length| usize::try_from(length).ok())
        .filter(|length| (8..1 << 20).contains(length));
    match length.is_some_and(|length| word(length + 4) == word(0)) {
        true => Err(Error::malformed(
            "this is an unformatted file of Fortran, such as TAPE12 of LBLRTM",
            "write it out as text: JPLOT and TAPE27 of LBLRTM, or a table wavenumber_cm1,sky [W cm^-2 sr^-1 (cm^-1)^-1]",
        )),
        false => Ok(()),
    }
}
