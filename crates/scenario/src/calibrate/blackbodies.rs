//! Blackbodies that were read (`[[blackbody]]`), the noise of a sample (`[noise]`) and the cube to be calibrated (`[scene]`).

use super::super::decompose::read::bad_bands;
use super::super::entries::Entries;
use super::super::paths::{Paths, axes, file, variable};
use super::super::section::{Entry, Section};
use hadar::calibration::sent::{Deviations, Sent};
use hadar::error::{Error, Result};
use hadar::units::Dimension;
use hadar::words::quantity;
use hadar_formats::cube::Axes;
use std::path::PathBuf;

const EXAMPLE: &str = "[[blackbody]] with temperature = \"10 degC\" and data = \"cold.npy\", twice or more";

/// Temperatures that differ by fewer of their deviations calibrate nothing.
const APART: f64 = 3.0;
/// Deviations of a sample beyond which squares of what follows from them are no numbers any more.
const RANGE: [f64; 2] = [1e-60, 1e60];

/// A blackbody that was read.
#[derive(Debug, Clone, PartialEq)]
pub struct BlackbodySpec {
    /// Its temperature, K.
    pub temperature_k: f64,
    /// Deviation of that temperature, K; none where nothing is said of it, and then it is taken as exact.
    pub uncertainty_k: Option<f64>,
    /// Its emissivity; none where nothing is said of it, and then it is taken as black.
    pub emissivity: Option<f64>,
    /// Deviation of that emissivity.
    pub emissivity_error: f64,
    /// Temperature of what it reflects, K; of one that is black none is needed.
    pub surroundings_k: Option<f64>,
    /// Deviation of that temperature, K.
    pub surroundings_error_k: f64,
    /// Its cube.
    pub data: CubeFile,
}

/// A cube in a file. Paths are absolute.
#[derive(Debug, Clone, PartialEq)]
pub struct CubeFile {
    /// Samples `[row][column][band]`.
    pub path: PathBuf,
    /// Name of the array in a file of several.
    pub variable: Option<String>,
    /// Which of its dimensions is which.
    pub axes: Option<Axes>,
    /// Bands that are left out of all cubes, counted from 0 in the order of this file.
    pub bad_bands: Vec<usize>,
}

impl CubeFile {
    pub(super) fn read(section: &Section<'_>) -> Result<Self> {
        Ok(Self {
            path: file(&section.require("data")?)?,
            variable: variable(section)?,
            axes: axes(section)?,
            bad_bands: bad_bands(section)?,
        })
    }

    fn written_bands(&self) -> Vec<i64> {
        self.bad_bands.iter().map(|band| *band as i64).collect()
    }

    pub(super) fn written(&self, paths: Paths<'_>) -> Entries {
        Entries::default()
            .put("data", paths.file(&self.path))
            .put_if("variable", self.variable.clone())
            .put_if("axes", self.axes.map(|axes| axes.to_string()))
            .put_if("bad_bands", (!self.bad_bands.is_empty()).then(|| self.written_bands()))
    }
}

impl BlackbodySpec {
    fn read(entry: &Entry<'_>) -> Result<Self> {
        let section = entry.section()?;
        let temperature = section.require("temperature")?;
        let uncertainty = section.quantity("uncertainty")?;
        let emissivity = section.number("emissivity")?;
        let emissivity_error = section.number("emissivity_error")?.unwrap_or(0.0);
        let surroundings_k = section.quantity("surroundings")?;
        let surroundings_error_k = section.quantity("surroundings_uncertainty")?.unwrap_or(0.0);
        let reflects = emissivity_error > 0.0 || surroundings_k.is_some() || surroundings_error_k > 0.0;
        if emissivity.is_none() && reflects {
            let found = "an emissivity that is not stated has no error, and reflects nothing";
            return Err(section.fail("emissivity", Error::malformed(found, "write emissivity = 0.98")));
        }
        if surroundings_k.is_none() && (reflects || emissivity.is_some_and(|e| e < 1.0)) {
            let found = "the surroundings that a blackbody of emissivity below 1 reflects are missing";
            let instead = "write surroundings = \"22 degC\", the temperature of what stands around it";
            return Err(section.fail("surroundings", Error::malformed(found, instead)));
        }
        Ok(Self {
            temperature_k: temperature.quantity()?,
            uncertainty_k: uncertainty,
            emissivity,
            emissivity_error,
            surroundings_k,
            surroundings_error_k,
            data: CubeFile::read(&section)?,
        })
    }

    pub(super) fn written(&self, paths: Paths<'_>) -> Entries {
        let entries = self.data.written(paths);
        let entries = entries.put_quantity("temperature", Dimension::Temperature, Some(self.temperature_k));
        let above_0 = |value: f64| Some(value).filter(|value| *value > 0.0);
        entries
            .put_quantity("uncertainty", Dimension::TemperatureDifference, self.uncertainty_k)
            .put_if("emissivity", self.emissivity)
            .put_if("emissivity_error", above_0(self.emissivity_error))
            .put_quantity("surroundings", Dimension::Temperature, self.surroundings_k)
            .put_quantity(
                "surroundings_uncertainty",
                Dimension::TemperatureDifference,
                above_0(self.surroundings_error_k),
            )
    }

    /// What it sends.
    #[must_use]
    pub fn sent(&self) -> Sent {
        Sent {
            temperature_k: self.temperature_k,
            emissivity: self.emissivity.unwrap_or(1.0),
            surroundings_k: self.surroundings_k.unwrap_or(self.temperature_k),
        }
    }

    /// Deviations of its temperature, emissivity and surroundings.
    #[must_use]
    pub fn deviations(&self) -> Deviations {
        [self.error_k(), self.emissivity_error, self.surroundings_error_k]
    }

    /// Deviation of its temperature as it is reckoned with, K.
    #[must_use]
    pub fn error_k(&self) -> f64 {
        self.uncertainty_k.unwrap_or(0.0)
    }
}

/// `[[blackbody]]`, two of them or more, of which two temperatures differ.
pub(super) fn blackbodies(root: &Section<'_>) -> Result<Vec<BlackbodySpec>> {
    let Some(list) = root.get("blackbody") else {
        let found = Error::malformed("no blackbody is named", format!("write {EXAMPLE}"));
        return Err(root.fail("blackbody", found));
    };
    let entries = list.items("[[blackbody]]")?;
    let specs = entries.iter().map(BlackbodySpec::read).collect::<Result<Vec<_>>>()?;
    let (Some(first), Some(second)) = (specs.first(), specs.get(1)) else {
        let found = Error::malformed(
            "one temperature does not determine response and offset",
            format!("write {EXAMPLE}, at temperatures that differ"),
        );
        return Err(list.fail(found));
    };
    if specs.iter().all(|spec| spec.temperature_k == first.temperature_k) {
        let found = format!(
            "blackbody[0] and blackbody[1] are both at {}",
            Dimension::Temperature.format(second.temperature_k)
        );
        let error = Error::malformed(found, "give two temperatures that differ");
        return Err(root.fail("blackbody[1].temperature", error));
    }
    apart(&specs).map_err(|error| root.fail("blackbody", error))?;
    Ok(specs)
}

/// Whether some two temperatures differ beyond what they are uncertain by.
fn apart(specs: &[BlackbodySpec]) -> Result<()> {
    let pairs =
        specs.iter().enumerate().flat_map(|(k, one)| specs[..k].iter().map(move |other| (one, other)));
    let ratio = |(one, other): (&BlackbodySpec, &BlackbodySpec)| {
        let apart = (one.temperature_k - other.temperature_k).abs();
        let error = one.error_k().hypot(other.error_k());
        (if apart > 0.0 { apart / error } else { 0.0 }, apart, error)
    };
    let best = pairs.map(ratio).max_by(|a, b| a.0.total_cmp(&b.0));
    let Some((_, apart, error)) = best.filter(|(ratio, ..)| *ratio < APART) else {
        return Ok(());
    };
    let kelvin = |value: f64| quantity(value, "K");
    let found = format!("temperatures differ by {} that is known to {} only", kelvin(apart), kelvin(error));
    let instead = format!("give blackbodies that are {} apart or more", kelvin(APART * error));
    Err(Error::malformed(found, instead))
}

/// `[noise] sample`.
pub(super) fn noise(root: &Section<'_>) -> Result<f64> {
    const INSTEAD: &str = "write [noise] with sample = 1.5, the deviation of one sample in the unit of the cubes (hadar calibrate noise finds it)";
    let stated = root.read("noise", |entry| {
        let section = entry.section()?;
        let sample = section.number("sample")?;
        if let Some(value) = sample.filter(|value| !(RANGE[0]..=RANGE[1]).contains(value)) {
            let error = Error::out_of_range(
                "noise of a sample",
                value,
                "",
                "from 1e-60 to 1e60: give the cubes in counts",
            );
            return Err(section.fail("sample", error));
        }
        Ok(sample)
    })?;
    stated.flatten().ok_or_else(|| {
        root.fail("noise", Error::malformed("the noise of the samples is not stated", INSTEAD))
    })
}
