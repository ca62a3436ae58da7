//! Text files of the USGS spectral libraries, versions 6 and 7.
//!
//! Version 7 has one column: a title (`splib07a Record=5932: Kaolinite CM5 BECKb AREF`), then a value for each channel. Wavelengths are in
//! a file of their own, one for each spectrometer (`splib07a_Wavelengths_BECK_Beckman_0.2-3.0_microns.txt`), which is looked for
//! beside the spectrum and in the folder above. Version 6 has three columns below some lines of text: wavelength in µm, value, deviation.
//!
//! Values are reflectances, absolute (AREF) or relative to a white panel (RREF); -1.23e34 stands for a deleted channel.
//!
//! Source: Kokaly et al., USGS Data Series 1035 (2017), doi:10.3133/ds1035; Clark et al., USGS Data Series 231 (2007).

use super::bytes::FETCH_AGAIN;
use super::content::{Content, short_name, stem};
use super::header::{self, Quantity};
use super::reading::Reading;
use super::samples::{Origin, Samples};
use crate::file::{READ_SPECTRUM, text_of_file};
use crate::spectral_unit::SpectralUnit;
use hadar::error::{Error, Result};
use hadar::grid::number;
use hadar::words::{kebab_case, one_line};
use std::path::{Path, PathBuf};

/// Numbers below this are deleted channels.
const DELETED: f64 = -1e30;
/// How version 6 begins.
const VERSION_6: &str = "USGS Digital Spectral Library";
/// Spectrometers as titles and names of files call them.
const SPECTROMETERS: [&str; 4] = ["BECK", "ASD", "NIC4", "AVIRIS"];

/// Whether the text looks like one: its first line is a title with the number of a record, or that of version 6.
pub(super) fn is_one(text: &str) -> bool {
    let first = first_line(text);
    first.starts_with(VERSION_6) || record(first).is_some()
}

fn first_line(text: &str) -> &str {
    text.lines().map(str::trim).find(|line| !line.is_empty()).unwrap_or_default()
}

/// What follows the number of the record in a title.
fn record(title: &str) -> Option<&str> {
    let (library, rest) = title.split_once("Record=")?;
    let (number, rest) = rest.split_once(':')?;
    let is_title = library.split_whitespace().count() == 1 && number.trim().parse::<u32>().is_ok();
    is_title.then(|| rest.trim())
}

/// A spectrum; `beside` is the folder where its wavelengths are looked for.
pub(super) fn parse(text: &str, source: &Path, beside: Option<&Path>, reading: &Reading) -> Result<Content> {
    if first_line(text).starts_with(VERSION_6) {
        return version_6(text, source, reading);
    }
    let (title, values) = column(text)?;
    let title = record(&title).unwrap_or_default().to_owned();
    let lower = title.to_lowercase();
    if lower.starts_with("wavelength") || lower.contains("bandpass") || lower.contains("error") {
        let found = format!("`{}`, what belongs to spectra and is none", one_line(&title));
        let instead = "name the file of a spectrum, whose title ends in AREF or RREF";
        return Ok(Content::NoEmissivity(Error::malformed(found, instead).on_line(1)));
    }
    let remark = match remark(&title) {
        Ok(remark) => remark,
        Err(error) => return Ok(Content::NoEmissivity(error.on_line(1))),
    };
    let (file, axis, unit) = wavelengths(&title, values.len(), beside)?;
    let points = axis.into_iter().zip(values).collect();
    let format = format!("USGS library, wavelengths of {}", file.display());
    Ok(Content::Materials(vec![material(&title, points, unit, (&format, remark), source, reading)?]))
}

/// What a title's last word says of a reflectance; other than one is refused.
fn remark(title: &str) -> Result<&'static str> {
    match title.split_whitespace().next_back() {
        Some("AREF") => Ok(""),
        Some("RREF") => Ok(
            "relative to a white panel (RREF), not absolute: emissivity is 1 - reflectance as far as the panel reflects all",
        ),
        last => {
            let found = match last {
                Some("TRAN") => "transmittance (`TRAN`), from which no emissivity follows".to_owned(),
                other => format!("a title that ends in `{}`", one_line(other.unwrap_or_default())),
            };
            Err(Error::malformed(found, "use a spectrum whose title ends in AREF or RREF"))
        }
    }
}

fn material(
    title: &str,
    points: Vec<(f64, f64)>,
    unit: SpectralUnit,
    (format, remark): (&str, &str),
    source: &Path,
    reading: &Reading,
) -> Result<hadar::material::Material> {
    // The words at the end are the spectrometer's and the kind of reflectance.
    let words: Vec<&str> = title.split_whitespace().collect();
    let own = words.get(..words.len().saturating_sub(2)).unwrap_or_default().join(" ");
    let name = short_name(&kebab_case(&own));
    let name = if name.is_empty() { stem(source) } else { name };
    let origin = Origin { name, description: title.to_owned(), format, source, remark };
    Samples { unit, quantity: Quantity::Reflectance, percent: false, points }.material(origin, reading)
}

/// The title and the numbers of a file of one column, deleted ones as no numbers.
fn column(text: &str) -> Result<(String, Vec<f64>)> {
    let mut lines =
        text.lines().enumerate().map(|(at, line)| (at + 1, line.trim())).filter(|(_, line)| !line.is_empty());
    let title = lines.next().map_or("", |(_, line)| line).to_owned();
    let values = lines.map(|(line, cell)| value(cell).map_err(|error| error.on_line(line)));
    Ok((title, values.collect::<Result<Vec<f64>>>()?))
}

/// A number; none where a channel is deleted.
fn value(cell: &str) -> Result<f64> {
    number(cell).map(|value| if value < DELETED { f64::NAN } else { value })
}

/// The file of the wavelengths of a spectrum, what is in it and in which unit.
fn wavelengths(
    title: &str,
    channels: usize,
    beside: Option<&Path>,
) -> Result<(PathBuf, Vec<f64>, SpectralUnit)> {
    let instrument = title.split_whitespace().rev().nth(1).unwrap_or_default().to_uppercase();
    let family = SPECTROMETERS.into_iter().find(|known| instrument.starts_with(known));
    // Another spectrometer has wavelengths of its own, called after it.
    let letters: String = instrument.chars().take_while(char::is_ascii_alphabetic).collect();
    let family = family.map_or(letters, str::to_owned);
    let wanted = format!("splib07a_Wavelengths_{family}_….txt");
    let missing = |found: String| {
        let instead =
            format!("put the file of its spectrometer's wavelengths, {wanted} of the library, beside it");
        Err(Error::malformed(found, instead))
    };
    let mut found = Vec::new();
    let folders = beside
        .into_iter()
        .flat_map(|own| [Some(own.to_owned()), own.join("..").canonicalize().ok()])
        .flatten();
    for folder in folders {
        for file in named_wavelengths(&folder) {
            let (title, axis) =
                column(&text_of_file(&file, READ_SPECTRUM)?).map_err(|error| error.in_file(&file))?;
            let is_axis = record(&title).is_some_and(|title| title.to_lowercase().contains("wavelength"));
            let names =
                format!("{title} {}", file.file_name().unwrap_or_default().to_string_lossy()).to_uppercase();
            if is_axis && !family.is_empty() && names.contains(&family) {
                found.push((file, title, axis));
            }
        }
        if !found.is_empty() {
            break;
        }
    }
    if found.is_empty() {
        return missing(format!(
            "its {channels} values have their wavelengths in another file, which is not here"
        ));
    }
    let lengths: Vec<String> = found.iter().map(|(_, _, axis)| axis.len().to_string()).collect();
    found.retain(|(_, _, axis)| axis.len() == channels);
    if found.len() > 1 {
        let files: Vec<String> = found.iter().map(|(file, ..)| file.display().to_string()).collect();
        let found = format!("{channels} wavelengths are in {}", files.join(" and in "));
        return Err(Error::malformed(found, "leave only that of its spectrometer beside it"));
    }
    let Some((file, title, axis)) = found.pop() else {
        return missing(format!("{channels} values where its wavelengths are {}", lengths.join(" or ")));
    };
    let unit = axis_unit(&title, &file, &axis).map_err(|error| error.in_file(&file))?;
    Ok((file.file_name().map_or_else(|| file.clone(), PathBuf::from), axis, unit))
}

/// Files of a folder that are called as those of wavelengths are, in the order of their names.
fn named_wavelengths(folder: &Path) -> Vec<PathBuf> {
    let entries =
        std::fs::read_dir(folder).into_iter().flatten().filter_map(|entry| Some(entry.ok()?.path()));
    let is_named = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
        name.contains("wavelength") && name.ends_with(".txt") && !name.starts_with("._") && path.is_file()
    };
    let mut files: Vec<PathBuf> = entries.filter(is_named).collect();
    files.sort();
    files
}

/// The unit of wavelengths: what the title or the name of their file says, else the only one that is possible.
fn axis_unit(title: &str, file: &Path, axis: &[f64]) -> Result<SpectralUnit> {
    let names = format!("{title} {}", file.file_name().unwrap_or_default().to_string_lossy()).to_lowercase();
    if names.contains("micron") || names.contains("micrometer") {
        return Ok(SpectralUnit::Micrometre);
    }
    let range = axis.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), &x| (low.min(x), high.max(x)));
    header::unit_of_range("wavelength", range).ok_or_else(|| {
        let found = "nothing says in which unit the wavelengths are";
        Error::malformed(found, "write `microns` into its title, if that is true").on_line(1)
    })
}

/// Three columns below a line of hyphens, the title and the history.
fn version_6(text: &str, source: &Path, reading: &Reading) -> Result<Content> {
    let mut below = text
        .lines()
        .enumerate()
        .map(|(at, line)| (at + 1, line.trim()))
        .skip_while(|(_, line)| !line.starts_with("-----"))
        .skip(1);
    let Some((line, title)) = below.next().filter(|(_, title)| !title.is_empty()) else {
        return Err(Error::malformed("there is no title below a line of hyphens", FETCH_AGAIN));
    };
    let remark = match remark(title) {
        Ok(remark) => remark,
        Err(error) => return Ok(Content::NoEmissivity(error.on_line(line))),
    };
    let mut points = Vec::new();
    // The history stands between title and rows.
    for (line, row) in below.skip(1).filter(|(_, row)| !row.is_empty()) {
        let cells: Vec<&str> = row.split_whitespace().collect();
        let [wavelength, reflectance, _] = cells[..] else {
            let found = format!("{} cells where wavelength, reflectance and deviation are due", cells.len());
            return Err(Error::malformed(found, FETCH_AGAIN).on_line(line));
        };
        let row = value(wavelength).and_then(|wavelength| Ok((wavelength, value(reflectance)?)));
        points.push(row.map_err(|error| error.on_line(line))?);
    }
    // A deleted channel of some files has no wavelength either.
    points.retain(|(wavelength, _): &(f64, f64)| wavelength.is_finite() && *wavelength > 0.0);
    let about = ("USGS library", remark);
    Ok(Content::Materials(vec![material(title, points, SpectralUnit::Micrometre, about, source, reading)?]))
}

#[cfg(test)]
mod tests;
