//! Cameras as the reports show them: what is stated, what is missing, and what follows.

use crate::error::{Error, Result};
use crate::instrument::comparison::{Comparison, SCENE_K, compare};
use crate::instrument::presets::{Missing, Preset};
use crate::instrument::{Camera, Equivalents, Figures, NoiseLine};
use crate::spectrum::Bands;
use crate::words::{quantity, significant};
use serde_json::{Map, Value};

/// Wavelength at which diffraction is quoted, m.
const DIFFRACTION_M: f64 = 10e-6;

/// All that is known of a camera, and what follows where enough is.
#[derive(Debug, Clone)]
pub struct Sheet {
    /// What documents state.
    pub preset: Preset,
    /// What they do not and a scenario must give.
    pub missing: Vec<Missing>,
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

impl Sheet {
    /// What is stated of a camera and what is missing, with nothing worked out.
    #[must_use]
    pub fn stated(preset: Preset) -> Self {
        Self { missing: missing(&preset), preset, worked: None }
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

    /// λF over the pixel at 10 µm: the blur of diffraction in pixels.
    #[must_use]
    pub fn diffraction_pixels(&self) -> Option<f64> {
        self.preset
            .f_number
            .zip(self.preset.pixel_m)
            .map(|(f_number, pixel)| DIFFRACTION_M * f_number / pixel)
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
            .iter()
            .map(|missing| serde_json::json!({ "key": missing.key, "example": missing.example }))
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

/// Everything that a scenario must give before the camera can be used.
fn missing(preset: &Preset) -> Vec<Missing> {
    let mut given = preset.clone();
    let mut all = Vec::new();
    while let Err(missing) = given.camera() {
        match missing.key {
            "exposure" => given.exposure_s = Some(1.0),
            "pixel" => given.pixel_m = Some(1.0),
            "f_number" => given.f_number = Some(1.0),
            "focal_length" => given.focal_length_m = Some(1.0),
            "netd" => given.noise = Some(crate::instrument::presets::StatedNoise::None),
            // Nothing else is missing yet; without this a new key would be asked for ever.
            _ => {
                all.push(missing);
                break;
            }
        }
        all.push(missing);
    }
    all
}

/// A figure of two cameras side by side.
#[derive(Debug, Clone)]
pub struct Row {
    /// Its key in JSON.
    pub key: &'static str,
    /// Its name.
    pub label: &'static str,
    /// Of A and of B.
    pub values: [Option<f64>; 2],
    /// How it is written.
    pub shown: fn(f64) -> String,
}

impl Row {
    /// B over A.
    #[must_use]
    pub fn ratio(&self) -> Option<f64> {
        let [a, b] = self.values;
        a.zip(b).filter(|(a, _)| *a != 0.0).map(|(a, b)| b / a)
    }
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
}

impl SideBySide {
    /// The two side by side.
    ///
    /// # Errors
    /// As [`compare`].
    pub fn of(a: Sheet, b: Sheet) -> Result<Self> {
        let comparison = match (&a.worked, &b.worked) {
            (Some(a), Some(b)) => Some(compare(&a.camera, &b.camera)?),
            _ => None,
        };
        Ok(Self { a, b, comparison })
    }

    /// The figures of each, without the scene.
    #[must_use]
    pub fn figures(&self) -> Vec<Row> {
        let row = |key, label, shown: fn(f64) -> String, of: &dyn Fn(&Sheet) -> Option<f64>| Row {
            key,
            label,
            values: [of(&self.a), of(&self.b)],
            shown,
        };
        let camera = |sheet: &Sheet, of: fn(&Camera) -> f64| sheet.worked.as_ref().map(|w| of(&w.camera));
        let noise = |sheet: &Sheet, of: fn(&Equivalents) -> Option<f64>| {
            sheet.worked.as_ref().and_then(|worked| of(&worked.equivalents))
        };
        let counts: fn(f64) -> String = |counts| format!("{} counts", exponential(counts));
        vec![
            row("exposure_s", "exposure", |s| quantity(s, "s"), &|sheet| {
                camera(sheet, |camera| camera.exposure_s).or(sheet.preset.exposure_s)
            }),
            row("pixel_m", "pixel", |m| quantity(m, "m"), &|sheet| sheet.preset.pixel_m),
            row("f_number", "f-number", |f| format!("f/{f}"), &|sheet| sheet.preset.f_number),
            row("focal_length_m", "focal length", |m| quantity(m, "m"), &|sheet| sheet.preset.focal_length_m),
            row("etendue_m2_sr", "etendue of a pixel", |e| format!("{} m^2 sr", exponential(e)), &|sheet| {
                camera(sheet, |camera| camera.etendue_m2_sr(None))
            }),
            row("efficiency", "efficiency, optics x quantum", |share| significant(share, 3), &|sheet| {
                camera(sheet, |camera| camera.optics_efficiency * camera.quantum_efficiency)
            }),
            row(
                "diffraction_pixels",
                "diffraction at 10 um",
                |p| format!("{} pixels", significant(p, 2)),
                &|sheet| sheet.diffraction_pixels(),
            ),
            row("sigma_counts", "electronic noise of a reading", counts, &|sheet| {
                noise(sheet, |noise| Some(noise.sigma_counts))
            }),
            row("netd_k", "NETD, all of its range", |k| quantity(k, "K"), &|sheet| {
                noise(sheet, |noise| Some(noise.netd_k))
            }),
            row("detectivity_cm_hz05_w", "D*", |d| format!("{} cm Hz^0.5/W", exponential(d)), &|sheet| {
                noise(sheet, |noise| noise.detectivity_cm_hz05_w)
            }),
            row(
                "nesr_microflick",
                "NESR of 1 cm^-1",
                |l| format!("{} uflick", significant(l, 3)),
                &|sheet| noise(sheet, |noise| Some(noise.nesr_microflick)),
            ),
            row("gamma_per_band", "gamma of a band at its reference", exponential, &|sheet| {
                sheet.worked.as_ref().map(|worked| worked.figures.gamma_per_band)
            }),
            row(
                "hardware_m2_s",
                "t A_p / ((1+gamma) F^2)",
                |h| format!("{} m^2 s", exponential(h)),
                &|sheet| sheet.worked.as_ref().map(|worked| worked.figures.hardware_m2_s),
            ),
        ]
    }

    /// What each does before the common scene; empty where it cannot be told.
    #[must_use]
    pub fn in_scene(&self) -> Vec<Row> {
        let Some(both) = &self.comparison else { return Vec::new() };
        let row = |key, label, values: [f64; 2], shown: fn(f64) -> String| Row {
            key,
            label,
            values: values.map(Some),
            shown,
        };
        let (a, b) = (&both.a, &both.b);
        let (bands_a, bands_b) = (a.bands as f64, b.bands as f64);
        vec![
            row("acquisition_s", "time for all bands", [a.acquisition_s, b.acquisition_s], |s| {
                quantity(s, "s")
            }),
            row("photons", "photons, all bands", [a.photons, b.photons], exponential),
            row(
                "noise_counts",
                "noise of a band beside its photons",
                [a.noise_counts, b.noise_counts],
                |counts| format!("{} counts", exponential(counts)),
            ),
            row(
                "noise_over_photons",
                "that over the photons of a band",
                [a.noise_counts * bands_a / a.photons, b.noise_counts * bands_b / b.photons],
                |share| significant(share, 3),
            ),
            row(
                "distance",
                "d of 1 % in one band",
                [0.01 * a.figure_of_merit, 0.01 * b.figure_of_merit],
                |d| significant(d, 3),
            ),
        ]
    }

    /// What the comparison rests on.
    #[must_use]
    pub fn caveats(&self) -> Vec<String> {
        let mut all = Vec::new();
        for sheet in [&self.a, &self.b] {
            let name = &sheet.preset.name;
            for assumed in sheet.worked.iter().flat_map(|worked| &worked.camera.assumed) {
                all.push(format!("{name}: {assumed}"));
            }
            if sheet.worked.is_none() {
                let keys: Vec<&str> = sheet.missing.iter().map(|missing| missing.key).collect();
                all.push(format!("{name}: not stated, to be given in a scenario: {}", keys.join(", ")));
            }
            if sheet.preset.filters_needed {
                all.push(format!(
                    "{name} has one band of its own: a spectrum takes filters, here without loss"
                ));
            }
            if self.b.preset.name == self.a.preset.name {
                break;
            }
        }
        if self.comparison.is_some() {
            all.push(
                "d is for spectra that differ by the same small share in every band and fill a pixel; pixels, and what they \
                 see at a distance, are not of the same size"
                    .into(),
            );
        }
        all
    }

    /// Everything as JSON; ratios are of B over A.
    ///
    /// # Errors
    /// What cannot be written as JSON.
    pub fn json(&self, sentence: &str) -> Result<Value> {
        let mut ratios = Map::new();
        for row in self.figures().iter().chain(&self.in_scene()) {
            ratios.insert(row.key.into(), value(&row.ratio())?);
        }
        let both = self.comparison.as_ref();
        ratios.insert("photons_in_same_time".into(), value(&both.map(|both| both.photons_in_same_time))?);
        ratios.insert("distance_in_same_time".into(), value(&both.map(|both| both.distance_in_same_time))?);
        let (mut a, mut b) = (self.a.json()?, self.b.json()?);
        a.insert("in_scene".into(), value(&both.map(|both| &both.a))?);
        b.insert("in_scene".into(), value(&both.map(|both| &both.b))?);
        Ok(serde_json::json!({
            "sentence": sentence,
            "scene_temperature_k": SCENE_K,
            "common_range_cm1": both.map(|both| both.range_cm1),
            "a": a,
            "b": b,
            "ratios": ratios,
            "caveats": self.caveats(),
        }))
    }
}

fn exponential(value: f64) -> String {
    if value == 0.0 { "0".into() } else { format!("{value:.2e}") }
}

fn value(of: &impl serde::Serialize) -> Result<Value> {
    serde_json::to_value(of).map_err(|error| Error::malformed(error.to_string(), "report this as a bug"))
}

fn object(of: &impl serde::Serialize) -> Result<Map<String, Value>> {
    match value(of)? {
        Value::Object(object) => Ok(object),
        other => Err(Error::malformed(format!("{other} is no object"), "report this as a bug")),
    }
}
