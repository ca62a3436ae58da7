//! ENVI spectral libraries: a header (`.hdr`) and a file of samples (`.sli`), a line of them for each spectrum.
//!
//! The header's `wavelength`, `wavelength units` and `spectra names` say what they are; whether emissivity or reflectance, the second of
//! `z plot titles` (`{Wavelength, Emissivity}`), or `reflectance scale factor`, by which samples are divided. Where nothing does it
//! is asked for. Channels that are bad (`bbl`) or not known (`data ignore value`) are left out at the ends of a spectrum; between
//! others they are no number: an error once a band needs them, as values below 0 or above 1 are.

use super::checked::{Checked, checked};
use super::content::{Content, joined, of_all, stem};
use super::header::{self, Axis, Meaning, Quantity, Values};
use super::layout::MOST_SPECTRA;
use super::reading::Reading;
use super::samples::{most_beyond, of_known, unknown};
use crate::envi_header::{EnviHeader, Layout, data_of, header_of};
use crate::file;
use crate::file::READ_SPECTRUM;
use crate::spectral_unit::SpectralUnit;
use hadar::error::{Error, Result, check};
use hadar::material::Material;
use hadar::material::Provenance;
use hadar::words::{kebab_case, one_line};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// The longest file of samples, bytes.
const LONGEST: u64 = 1 << 26;
/// Endings of spectral libraries, whose header must be there.
const LIBRARIES: [&str; 2] = ["sli", "sc"];
/// The keys that say what the samples are.
const TITLES: &str = "z plot titles";
const SCALE: &str = "reflectance scale factor";

/// Header and data, if the path is one of the two of a spectral library.
///
/// # Errors
/// A header without data, a spectral library without its header.
pub(super) fn files(path: &Path) -> Result<Option<(PathBuf, PathBuf)>> {
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default();
    if !path.is_file() {
        return Ok(None);
    }
    if ending == "hdr" {
        return Ok(Some((path.to_owned(), data_of(path)?)));
    }
    match header_of(path) {
        Some(header) if LIBRARIES.contains(&ending.as_str()) => Ok(Some((header, path.to_owned()))),
        None if LIBRARIES.contains(&ending.as_str()) => {
            let found = "the header of this spectral library is not beside it";
            Err(Error::malformed(found, "put it there under the same name with .hdr").in_file(path))
        }
        _ => Ok(None),
    }
}

/// All spectra of a library. `columns` say what the samples are where the header does not.
pub(super) fn read(header_path: &Path, data: &Path, reading: &Reading) -> Result<Content> {
    let header = EnviHeader::from_file(header_path)?;
    if !header.is_spectral_library() {
        let found = "this is the header of an image, which has no spectra of materials";
        let instead = "name a file of type `ENVI Spectral Library`";
        return Ok(Content::NoEmissivity(Error::malformed(found, instead).in_file(header_path)));
    }
    let layout = header.layout().map_err(|error| error.in_file(header_path))?;
    if layout.lines > MOST_SPECTRA {
        let expected = format!("at most {MOST_SPECTRA}: write them into several files");
        return Err(Error::out_of_range("spectra", layout.lines as f64, "", expected).in_file(header_path));
    }
    let bytes = file::bytes(data, READ_SPECTRUM, LONGEST)?;
    if layout.bands != 1 || layout.bytes() != Some(bytes.len() as u64) {
        let due = layout.bytes().map_or_else(|| "more".to_owned(), |due| due.to_string());
        let found =
            format!("{} bytes where the header announces {due} in {} bands", bytes.len(), layout.bands);
        let instead = "keep header and data together: samples are channels, lines are spectra, in one band";
        return Err(Error::malformed(found, instead).in_file(data));
    }
    let offset = usize::try_from(layout.header_offset).unwrap_or(usize::MAX);
    let samples = layout.data_type.samples(bytes.get(offset..).unwrap_or_default(), layout.byte_order);
    of(&header, &samples, &layout, data, reading).map_err(|error| error.in_file(header_path))
}

fn of(
    header: &EnviHeader,
    samples: &[f64],
    layout: &Layout,
    source: &Path,
    reading: &Reading,
) -> Result<Content> {
    let columns = reading.columns_said();
    let channels = layout.samples;
    let Some(axis) = header.numbers_for("wavelength", channels, "channels")? else {
        return Err(Error::malformed(
            "the header has no `wavelength`",
            "write wavelength = {…} and wavelength units",
        ));
    };
    let unit = unit(header, &axis, columns)?;
    let (quantity, scale) = match quantity(header, columns)? {
        Ok(known) => known,
        Err(other) => return Ok(Content::NoEmissivity(other)),
    };
    let ignored = header.ignored()?.map(|value| layout.data_type.stored(value));
    let good = header.good_bands(channels)?;
    let wavenumber = |&value: &f64| {
        check::positive("wavelength", value, unit.name())
            .and_then(|value| check::positive("wavenumber", unit.wavenumber_cm1(value), "cm^-1"))
            .map_err(|error| header.wrong("wavelength", error))
    };
    let wavenumbers_cm1 = axis.iter().map(wavenumber).collect::<Result<Vec<f64>>>()?;
    let clip = reading.clip();
    let library = Library { header, source, unit, wavenumbers_cm1, quantity, scale, good, ignored, clip };
    let spectra: Vec<&[f64]> = samples.chunks_exact(channels).collect();
    let names = names(header, spectra.len(), source)?;
    let mut materials = Vec::with_capacity(spectra.len());
    let mut unknown = Vec::new();
    for (name, spectrum) in names.iter().zip(spectra) {
        match library.material(name, spectrum)? {
            Some(material) => materials.push(material),
            None => unknown.push(format!("`{}`", one_line(name))),
        }
    }
    if unknown.is_empty() {
        return Ok(Content::Materials(materials));
    }
    let unknown = format!("of {} less than 2 channels are good and known", unknown.join(", "));
    if materials.is_empty() {
        let instead = "correct `bbl` and `data ignore value`, or use another library";
        return Err(Error::malformed(unknown, instead));
    }
    let left_out = |material: Material| material.warn([format!("left out of the same file: {unknown}")]);
    Ok(Content::Materials(materials.into_iter().map(left_out).collect()))
}

/// What the header says of all spectra.
struct Library<'a> {
    header: &'a EnviHeader,
    source: &'a Path,
    unit: SpectralUnit,
    wavenumbers_cm1: Vec<f64>,
    quantity: Quantity,
    /// What samples are divided by.
    scale: f64,
    good: Option<Vec<bool>>,
    ignored: Option<f64>,
    clip: Option<f64>,
}

impl Library<'_> {
    /// The samples as fractions, those of channels that are bad or not known no numbers.
    fn fractions(&self, spectrum: &[f64]) -> impl Iterator<Item = f64> {
        spectrum.iter().enumerate().map(|(channel, sample)| {
            let is_good = self.good.as_ref().is_none_or(|good| good.get(channel).copied().unwrap_or(false));
            let known = is_good && self.ignored != Some(*sample) && sample.is_finite();
            if known { sample / self.scale } else { f64::NAN }
        })
    }

    /// One material; `None` where less than two channels are good and known.
    fn material(&self, name: &str, spectrum: &[f64]) -> Result<Option<Material>> {
        let (channels, quantity, scale) = (spectrum.len(), self.quantity, self.scale);
        if let Some(most) = most_beyond(self.fractions(spectrum)) {
            let found =
                format!("{} of `{}` up to {most} where 1 is all there is", quantity.name(), one_line(name));
            let instead =
                format!("write `{SCALE} = 100` where samples are percent, or the factor that is true");
            return Err(self.header.wrong(SCALE, Error::malformed(found, instead)));
        }
        let fractions = self.wavenumbers_cm1.iter().zip(self.fractions(spectrum));
        let rows: Vec<(f64, [f64; 1])> =
            fractions.map(|(&wavenumber, value)| (wavenumber, [quantity.emissivity(value)])).collect();
        let usable = rows.iter().filter(|(_, [e])| !e.is_nan()).count();
        if usable < 2 && usable < channels {
            return Ok(None);
        }
        let known = of_known(rows).map_err(|error| self.header.wrong("wavelength", error))?;
        let Checked { table, warnings: mut said, note } = checked(known, self.clip)?;
        let left = table.rows().filter(|(_, [e])| e.is_nan()).count();
        said.extend(unknown(channels - usable, channels, left));
        let most = self.fractions(spectrum).fold(0.0, f64::max);
        said.extend(of_all(quantity.name(), most * scale, scale));
        let share = if scale == 1.0 { String::new() } else { format!(" times {scale}") };
        let read_as = format!(
            "ENVI spectral library, {} in {}, {}{share}",
            self.unit.quantity(),
            self.unit.name(),
            quantity.name()
        );
        let source = self.source.display().to_string();
        let note = joined(&[quantity.note(), &note], "; ");
        let provenance = Provenance::of_file(one_line(name), source, &note);
        let material = Material::of_table(kebab_case(name), provenance, table);
        Ok(Some(material.reading(read_as).warn(said)))
    }
}

fn unit(header: &EnviHeader, axis: &[f64], columns: Option<&[String]>) -> Result<SpectralUnit> {
    if let Some(unit) = header.wavelength_unit()? {
        return Ok(unit);
    }
    if let Some(Axis { unit: Some(unit), .. }) =
        columns.and_then(|columns| columns.first()).map(|cell| header::axis(cell)).transpose()?.flatten()
    {
        return Ok(unit);
    }
    let range = axis
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &value| (low.min(value), high.max(value)));
    header::unit_of_range("wavelength", range).ok_or_else(|| {
        let found = "nothing says in which unit the wavelengths are, and more than one is possible";
        let instead = "write `wavelength units = Micrometers`, Nanometers or Wavenumber, whichever is true";
        header.wrong("wavelength units", Error::malformed(found, instead))
    })
}

/// What the samples are and what they are to be divided by; or why there is no emissivity in them.
fn quantity(
    header: &EnviHeader,
    columns: Option<&[String]>,
) -> Result<std::result::Result<(Quantity, f64), Error>> {
    let factor = header.number(SCALE)?;
    if let Some(factor) = factor.filter(|factor| *factor <= 0.0) {
        let error =
            Error::malformed(format!("a factor of {factor}"), "write what samples are to be divided by");
        return Err(header.wrong(SCALE, error));
    }
    let titles = header.list(TITLES);
    let title = columns.and_then(|columns| columns.get(1)).map(String::as_str);
    let title = title.or_else(|| titles.as_ref().and_then(|titles| titles.get(1).copied()));
    let scale = |percent: bool| factor.unwrap_or(if percent { 100.0 } else { 1.0 });
    match title.map(header::values) {
        Some(Meaning::Values(Values { quantity: Some(quantity), percent, .. })) => {
            Ok(Ok((quantity, scale(percent))))
        }
        Some(Meaning::Other) => {
            let found = format!("`{}`, from which no emissivity follows", title.unwrap_or_default());
            let instead = "use emissivity, or the hemispherical reflectance of opaque samples";
            Ok(Err(header.wrong(TITLES, Error::malformed(found, instead))))
        }
        _ if factor.is_some() => Ok(Ok((Quantity::Reflectance, scale(false)))),
        _ => {
            let found = "nothing says whether the samples are emissivity or reflectance";
            let instead = "write `z plot titles = {Wavelength, Emissivity}` or `{Wavelength, Reflectance}` into the header";
            Err(header.wrong(TITLES, Error::malformed(found, instead)))
        }
    }
}

/// A name for every spectrum, each only once in kebab-case.
fn names(header: &EnviHeader, count: usize, source: &Path) -> Result<Vec<String>> {
    const KEY: &str = "spectra names";
    let wrong = |found: String| {
        let instead = format!("write {KEY} = {{…}} with a name of its own for each spectrum");
        Err(header.wrong(KEY, Error::malformed(found, instead)))
    };
    let names: Vec<String> = match header.list(KEY) {
        None if count == 1 => return Ok(vec![stem(source)]),
        None => return wrong(format!("{count} spectra without names")),
        Some(names) => names.into_iter().map(str::to_owned).collect(),
    };
    if names.len() != count {
        return wrong(format!("{} names for {count} spectra", names.len()));
    }
    let mut seen = BTreeSet::new();
    match names.iter().find(|name| kebab_case(name).is_empty() || !seen.insert(kebab_case(name))) {
        Some(name) => wrong(format!("`{}` is there twice or no name", one_line(name))),
        None => Ok(names),
    }
}
