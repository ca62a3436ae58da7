//! A camera with what is stated of it, what is missing and what follows; two of them side by side.

use crate::json::value;
use hadar::error::{Error, Result};
use hadar::instrument::comparison::{Comparison, SCENE_K, compare};
use hadar::instrument::presets::{Missing, Preset};
use hadar::instrument::{Camera, Equivalents, Figures, NoiseLine};
use hadar::spectrum::Bands;
use serde_json::{Map, Value};

/// Wavelength at which diffraction is quoted, m.
const DIFFRACTION_M: f64 = 10e-6;

/// All that is known of a camera, and what follows where enough is.
#[derive(Debug, Clone)]
pub struct Sheet {
    /// What documents state.
    pub preset: Preset,
    /// What they do not and a scenario must give.
    pub missing: Missing,
    /// What follows; none where something is missing.
    pub worked: Option<Worked>,
}

/// What follows from the figures of a camera.
#[derive(Debug, Clone)]
pub struct Worked {
    /// The camera.
    pub camera: Camera,
    /// One exposure of a blackbody at its reference temperature.
    pub figures: Figures,
    /// Its electronic noise in every way of stating it.
    pub equivalents: Equivalents,
    /// The noise of an average band of 1 cm⁻¹ before a blackbody at 300 K.
    pub noise_budget: Vec<NoiseLine>,
    /// Exposures at which the well is full before a blackbody at 300 K, s: in the brightest band of 1 cm⁻¹, and in the
    /// whole range at once.
    pub full_well_exposures_s: Option<[f64; 2]>,
}

/// Two cameras side by side.
#[derive(Debug, Clone)]
pub struct SideBySide {
    /// The first one.
    pub a: Sheet,
    /// The second one.
    pub b: Sheet,
    /// Both before the same scene, where both are complete.
    pub comparison: Option<Comparison>,
    /// F-number and focal length, m, of the lens that was put before a camera of which no document names one: that of the other, else
    /// f/1 of 14 mm.
    pub lens: Option<[f64; 2]>,
}

/// F-number and focal length, m, of the lens of two cameras without one.
const LENS: [f64; 2] = [1.0, 14e-3];

impl SideBySide {
    /// The two side by side.
    ///
    /// # Errors
    /// As [`compare`].
    pub fn of(a: Sheet, b: Sheet) -> Result<Self> {
        let own = |sheet: &Sheet| {
            let figures = &sheet.preset.figures;
            Some([figures.f_number?, figures.focal_length_m?])
        };
        let lens = own(&a).or_else(|| own(&b)).unwrap_or(LENS);
        let lacks = [a.lacks_a_lens(), b.lacks_a_lens()].contains(&true);
        let (a, b) = (a.behind(lens)?, b.behind(lens)?);
        let lens = lacks.then_some(lens);
        let comparison = match (&a.worked, &b.worked) {
            (Some(a), Some(b)) => Some(compare(&a.camera, &b.camera)?),
            _ => None,
        };
        Ok(Self { a, b, comparison, lens })
    }
}

impl Sheet {
    /// What is stated of a camera and what is missing, with nothing worked out.
    #[must_use]
    pub fn stated(preset: Preset) -> Self {
        Self { missing: preset.camera().err().unwrap_or_default(), preset, worked: None }
    }

    /// The sheet of a known camera.
    ///
    /// # Errors
    /// Figures that make no camera.
    pub fn of(preset: Preset) -> Result<Self> {
        let worked = match preset.camera() {
            Ok(camera) => Some(Worked::of(camera.checked()?)?),
            Err(_) => None,
        };
        Ok(Self { worked, ..Self::stated(preset) })
    }

    /// Whether it would be a camera with a lens before it.
    fn lacks_a_lens(&self) -> bool {
        let is_of_lens = |key: &&str| ["f_number", "focal_length"].contains(key);
        !self.missing.0.is_empty() && self.missing.0.iter().all(is_of_lens)
    }

    /// The same behind a lens of that f-number and focal length, m, where it lacks nothing else.
    fn behind(self, [f_number, focal_length_m]: [f64; 2]) -> Result<Self> {
        if !self.lacks_a_lens() {
            return Ok(self);
        }
        let mut preset = self.preset;
        preset.figures.f_number.get_or_insert(f_number);
        preset.figures.focal_length_m.get_or_insert(focal_length_m);
        Self::of(preset)
    }

    /// λF over the pixel at 10 µm: the blur of diffraction in pixels.
    #[must_use]
    pub fn diffraction_pixels(&self) -> Option<f64> {
        let figures = &self.preset.figures;
        figures.f_number.zip(figures.pixel_m).map(|(f_number, pixel)| DIFFRACTION_M * f_number / pixel)
    }

    /// Everything under one key each, in SI units; null for what is not stated or does not follow.
    ///
    /// # Errors
    /// What cannot be written as JSON.
    pub fn json(&self) -> Result<Map<String, Value>> {
        let mut all = object(&self.preset)?;
        if let Some(worked) = &self.worked {
            all.append(&mut object(&worked.camera)?);
            all.append(&mut object(&worked.figures)?);
        }
        let worked = self.worked.as_ref();
        let full = worked.and_then(|worked| worked.full_well_exposures_s);
        let missing: Vec<Value> = self
            .missing
            .0
            .iter()
            .zip(self.missing.lines())
            .map(|(key, line)| serde_json::json!({ "key": key, "write": line }))
            .collect();
        all.insert("missing".into(), missing.into());
        all.insert("equivalents".into(), value(&worked.map(|worked| &worked.equivalents))?);
        all.insert("noise_budget".into(), value(&worked.map(|worked| &worked.noise_budget))?);
        all.insert("noise_budget_temperature_k".into(), SCENE_K.into());
        all.insert("diffraction_pixels".into(), value(&self.diffraction_pixels())?);
        all.insert("full_well_exposure_of_a_band_s".into(), value(&full.map(|full| full[0]))?);
        all.insert("full_well_exposure_of_the_range_s".into(), value(&full.map(|full| full[1]))?);
        Ok(all)
    }
}

impl Worked {
    fn of(camera: Camera) -> Result<Self> {
        let bands = camera.own_bands()?;
        let [low, high] = camera.spectral_range_cm1;
        let whole = Bands::from_ranges(&[(low, high)])?;
        let of_band = camera.full_well_exposure_s(&bands, SCENE_K);
        let of_range = camera.full_well_exposure_s(&whole, SCENE_K);
        Ok(Self {
            figures: camera.figures()?,
            equivalents: camera.equivalents()?,
            noise_budget: camera.budget_of_blackbody(&bands, SCENE_K),
            full_well_exposures_s: of_band.zip(of_range).map(|(band, range)| [band, range]),
            camera,
        })
    }
}

fn object(of: &impl serde::Serialize) -> Result<Map<String, Value>> {
    match value(of)? {
        Value::Object(object) => Ok(object),
        other => Err(Error::malformed(format!("{other} is no object"), "report this as a bug")),
    }
}
