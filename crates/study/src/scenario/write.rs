//! Writes a scenario with every default filled in, as TOML and, in the same structure, for JSON.
//!
//! Quantities are strings in the unit used inside, with all digits, so that reading gives the same bits back.

use std::path::Path;

use serde::Serialize;
use serde::ser::{SerializeMap, Serializer};
use toml::Value;

use super::read::is_path;
use super::{
    Alternatives, AtmosphereSource, AtmosphereSpec, Background, BandSource, BandsSpec, CameraSpec,
    Efficiency, EnvironmentObject, Extrapolation, MaterialRef, Nuisance, Reliability, Requirement, Scenario,
    Target, Unknown,
};
use hadar::units::Dimension;

/// One entry of the document.
pub(super) enum Part {
    Value(Value),
    Table(Entries),
    Tables(Vec<Entries>),
}

/// Keys in the order in which they are written; a silent one is not there.
#[derive(Default)]
pub(super) struct Entries(Vec<(&'static str, Value)>);

/// How file paths are written.
#[derive(Clone, Copy)]
pub(super) struct Paths<'a> {
    pub(super) beside: Option<&'a Path>,
}

/// The parts of a scenario in the order in which they are written.
pub(super) type Document = Vec<(&'static str, Part)>;

impl Scenario {
    /// The scenario as TOML, every default filled in; reading it gives an equal scenario. What stays silent
    /// has no value (a distance, an atmosphere, a camera) or one that others know (a preset's fields, the library's
    /// materials). Paths of files are absolute, so that it may be put anywhere on the same machine.
    ///
    /// ```
    /// use hadar_study::scenario::Scenario;
    /// let text = "[target]\nmaterial = \"skin\"\ntemperature = \"37 degC\"";
    /// let scenario = Scenario::from_toml(text, None).unwrap();
    /// let filled = scenario.to_toml();
    /// assert!(filled.contains("nuisances = [\"temperature\", \"lighting\"]"));
    /// assert_eq!(Scenario::from_toml(&filled, None).unwrap(), scenario);
    /// ```
    #[must_use]
    pub fn to_toml(&self) -> String {
        self.text(Paths { beside: None })
    }

    /// As [`Scenario::to_toml`], for a file in `directory` that may be moved along with its neighbours: paths
    /// below `directory` are written relative to it, others absolute.
    #[must_use]
    pub fn to_toml_beside(&self, directory: &Path) -> String {
        let absolute = std::path::absolute(directory).ok();
        self.text(Paths { beside: absolute.as_deref() })
    }

    fn text(&self, paths: Paths<'_>) -> String {
        text(self.document(paths))
    }

    pub(super) fn document(&self, paths: Paths<'_>) -> Document {
        let mut document = Vec::new();
        if let Some(title) = &self.title {
            document.push(("title", Part::Value(title.as_str().into())));
        }
        document.push(("target", Part::Table(target(&self.target, paths))));
        if let Some(behind) = &self.background {
            document.push(("background", Part::Table(background(behind, paths))));
        }
        let objects = self.environment.iter().map(|object| environment(object, paths)).collect();
        document.push(("environment", Part::Tables(objects)));
        document.push(("alternatives", Part::Table(alternatives(&self.alternatives, paths))));
        if let Some(spec) = &self.atmosphere {
            document.push(("atmosphere", Part::Table(atmosphere(spec, paths))));
        }
        document.push(("bands", Part::Table(bands(&self.bands, paths))));
        document.push(("unknown", Part::Table(unknown(&self.unknown))));
        if let Some(spec) = &self.camera {
            document.push(("camera", Part::Table(camera(spec, paths))));
        }
        document.push(("requirement", Part::Table(requirement(&self.requirement))));
        if let Some(envelope) = &self.envelope {
            document.push(("envelope", Part::Table(envelope.written(paths))));
        }
        if let Some(spec) = self.sensitivity {
            document.push(("sensitivity", Part::Table(spec.entries())));
        }
        document
    }
}

/// The same keys and values as the TOML, with absolute paths.
impl Serialize for Scenario {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        entries(self.document(Paths { beside: None }), serializer)
    }
}

/// A document as TOML.
pub(super) fn text(document: Document) -> String {
    let mut text = String::new();
    for (name, part) in document {
        match part {
            Part::Value(value) => text.push_str(&format!("{name} = {value}\n")),
            Part::Table(entries) => entries.write(&mut text, &format!("[{name}]")),
            Part::Tables(tables) => {
                tables.iter().for_each(|entries| entries.write(&mut text, &format!("[[{name}]]")));
            }
        }
    }
    text
}

/// A document as a map.
pub(super) fn entries<S: Serializer>(document: Document, serializer: S) -> Result<S::Ok, S::Error> {
    let mut map = serializer.serialize_map(None)?;
    for (name, part) in document {
        match part {
            Part::Value(value) => map.serialize_entry(name, &value)?,
            Part::Table(entries) => map.serialize_entry(name, &entries)?,
            Part::Tables(tables) => map.serialize_entry(name, &tables)?,
        }
    }
    map.end()
}

impl Serialize for Entries {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(key, value)| (key, value)))
    }
}

impl Entries {
    pub(super) fn put(mut self, key: &'static str, value: impl Into<Value>) -> Self {
        self.0.push((key, value.into()));
        self
    }

    pub(super) fn put_if(self, key: &'static str, value: Option<impl Into<Value>>) -> Self {
        match value {
            Some(value) => self.put(key, value),
            None => self,
        }
    }

    pub(super) fn put_quantity(self, key: &'static str, dimension: Dimension, value: Option<f64>) -> Self {
        self.put_if(key, value.map(|value| dimension.format(value)))
    }

    /// These, then others.
    pub(super) fn and(mut self, other: Self) -> Self {
        self.0.extend(other.0);
        self
    }

    fn write(&self, text: &mut String, header: &str) {
        if !text.is_empty() {
            text.push('\n');
        }
        text.push_str(&format!("{header}\n"));
        for (key, value) in &self.0 {
            text.push_str(&format!("{key} = {value}\n"));
        }
    }
}

impl Paths<'_> {
    pub(super) fn file(self, path: &Path) -> String {
        let inside = self.beside.and_then(|directory| path.strip_prefix(directory).ok());
        let text = inside.unwrap_or(path).to_string_lossy().into_owned();
        // A bare `skin` would be read as a name of the library, and a blank at the beginning would be lost.
        if is_path(&text) && !text.starts_with(char::is_whitespace) { text } else { format!("./{text}") }
    }

    pub(super) fn material(self, material: &MaterialRef) -> String {
        match material {
            MaterialRef::Name(name) => name.clone(),
            MaterialRef::File(path) => self.file(path),
        }
    }
}

fn target(target: &Target, paths: Paths<'_>) -> Entries {
    Entries::default()
        .put("material", paths.material(&target.material))
        .put_quantity("temperature", Dimension::Temperature, Some(target.temperature_k))
        .put_quantity("distance", Dimension::Length, target.distance_m)
        .put_quantity("size", Dimension::Length, target.size_m)
        .put_if("extrapolate", target.extrapolate.map(Extrapolation::name))
}

fn background(behind: &Background, paths: Paths<'_>) -> Entries {
    Entries::default()
        .put_quantity("temperature", Dimension::Temperature, Some(behind.temperature_k))
        .put_if("material", behind.material.as_ref().map(|material| paths.material(material)))
        .put_if("extrapolate", behind.extrapolate.map(Extrapolation::name))
}

fn environment(object: &EnvironmentObject, paths: Paths<'_>) -> Entries {
    Entries::default()
        .put_quantity("temperature", Dimension::Temperature, Some(object.temperature_k))
        .put("lighting", object.lighting)
        .put_if("material", object.material.as_ref().map(|material| paths.material(material)))
        .put_if("extrapolate", object.extrapolate.map(Extrapolation::name))
}

fn alternatives(alternatives: &Alternatives, paths: Paths<'_>) -> Entries {
    let names = |materials: &Vec<MaterialRef>| -> Vec<String> {
        materials.iter().map(|material| paths.material(material)).collect()
    };
    let kelvins = |range: [f64; 2]| range.map(|end| Dimension::Temperature.format(end)).to_vec();
    Entries::default()
        .put_if("materials", alternatives.materials.as_ref().map(names))
        .put_if("temperature", alternatives.temperature_range_k.map(kelvins))
        .put_if("lighting", alternatives.lighting_range.map(|range| range.to_vec()))
        .put_if("extrapolate", alternatives.extrapolate.map(Extrapolation::name))
        .put_if("skip_uncovered", alternatives.skip_uncovered.then_some(true))
}

fn atmosphere(atmosphere: &AtmosphereSpec, paths: Paths<'_>) -> Entries {
    let entries = match &atmosphere.source {
        AtmosphereSource::Model(name) => Entries::default().put("model", name.as_str()),
        AtmosphereSource::Table(path) => Entries::default().put("table", paths.file(path)),
    };
    entries.put_quantity("temperature", Dimension::Temperature, atmosphere.temperature_k)
}

pub(super) fn bands(bands: &BandsSpec, paths: Paths<'_>) -> Entries {
    let entries = Entries::default();
    let entries = match &bands.source {
        BandSource::Grid { start, stop, step } => {
            entries.put("start", start.format()).put("stop", stop.format()).put("step", step.format())
        }
        BandSource::Filters(path) => entries.put("filters", paths.file(path)),
        BandSource::Rows(path) => entries.put("rows", paths.file(path)),
        BandSource::Ranges(ranges) => {
            let pairs: Vec<Vec<String>> =
                ranges.iter().map(|range| range.map(|end| end.format()).to_vec()).collect();
            entries.put("ranges", pairs)
        }
    };
    entries.put("integrate", bands.integrate).put("tolerance", bands.tolerance)
}

fn unknown(unknown: &Unknown) -> Entries {
    let names: Vec<&str> = unknown.nuisances.iter().map(|nuisance| nuisance.name()).collect();
    let prior = |(nuisance, sigma): (&Nuisance, &f64)| {
        let value = match nuisance {
            Nuisance::Temperature | Nuisance::EnvironmentTemperature => {
                Dimension::TemperatureDifference.format(*sigma).into()
            }
            Nuisance::Lighting | Nuisance::Gain => Value::from(*sigma),
        };
        (nuisance.name().to_owned(), value)
    };
    let priors: toml::Table = unknown.priors.iter().map(prior).collect();
    Entries::default()
        .put("nuisances", names)
        .put("priors", priors)
        .put_if("lighting_total", unknown.lighting_total)
}

pub(super) fn camera(camera: &CameraSpec, paths: Paths<'_>) -> Entries {
    let efficiency = |efficiency: &Option<Efficiency>| match efficiency {
        Some(Efficiency::Number(value)) => Some(Value::from(*value)),
        Some(Efficiency::File(path)) => Some(Value::from(paths.file(path))),
        None => None,
    };
    Entries::default()
        .put_if("preset", camera.preset.as_deref())
        .put_quantity("exposure", Dimension::Time, camera.exposure_s)
        .put_quantity("pixel", Dimension::Length, camera.pixel_m)
        .put_if("f_number", camera.f_number)
        .put_quantity("focal_length", Dimension::Length, camera.focal_length_m)
        .put_if("optics_efficiency", efficiency(&camera.optics_efficiency))
        .put_if("quantum_efficiency", efficiency(&camera.quantum_efficiency))
        .put_quantity("netd", Dimension::TemperatureDifference, camera.netd_k)
        .put_quantity("netd_temperature", Dimension::Temperature, camera.netd_temperature_k)
        .put_if("netd_f_number", camera.netd_f_number)
        .put_quantity("netd_pixel", Dimension::Length, camera.netd_pixel_m)
        .put_quantity("detectivity", Dimension::Detectivity, camera.detectivity_cm_hz05_w)
        .put_quantity("nep", Dimension::NoiseEquivalentPower, camera.nep_w_hz05)
        .put_quantity("nesr", Dimension::SpectralRadiance, camera.nesr_microflick)
        .put_if("noise_electrons", camera.noise_electrons)
        .put_if("noise_table", camera.noise_table.as_ref().map(|path| paths.file(path)))
        .put_quantity("noise_bandwidth", Dimension::Frequency, camera.noise_bandwidth_hz)
        .put_quantity("noise_exposure", Dimension::Time, camera.noise_exposure_s)
        .put_if("flicker_fraction", camera.flicker_fraction)
        .put_quantity("dark_rate", Dimension::Rate, camera.dark_rate_per_s)
        .put_if("read_noise", camera.read_noise)
        .put_if("quantisation_bits", camera.quantisation_bits)
        .put_if("full_well", camera.full_well)
        .put_if("photon_bunching", camera.photon_bunching)
        .put_if("readout", camera.readout.map(|readout| readout.name()))
        .put_if("frames", camera.frames)
        .put_quantity("frame_rate", Dimension::Frequency, camera.frame_rate_hz)
        .put_quantity("sensor_temperature", Dimension::Temperature, camera.sensor_temperature_k)
        .put_quantity("filter_temperature", Dimension::Temperature, camera.filter_temperature_k)
        .put_quantity("field_of_view", Dimension::Angle, camera.field_of_view_rad)
        .put_if("pixels", camera.pixels)
}

fn requirement(requirement: &Requirement) -> Entries {
    let entries = match requirement.reliability {
        Reliability::DetectionProbability(value) => Entries::default().put("detection_probability", value),
        Reliability::Distance(value) => Entries::default().put("distance", value),
    };
    entries.put("by", requirement.by.name()).put_quantity("speed", Dimension::Speed, requirement.speed_m_s)
}
