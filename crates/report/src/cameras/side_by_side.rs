//! Two cameras side by side: their figures, and what each does before the same scene.

use super::Sheet;
use crate::json::value;
use hadar::error::Result;
use hadar::instrument::comparison::{Comparison, SCENE_K, compare};
use hadar::instrument::{Camera, Equivalents, Readout};
use hadar::words::{quantity, significant};
use serde_json::{Map, Value};

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
        let counts: fn(f64) -> String = |counts| format!("{} counts", significant(counts, 3));
        vec![
            row("exposure_s", "exposure", |s| quantity(s, "s"), &|sheet| {
                camera(sheet, |camera| camera.exposure_s).or(sheet.preset.figures.exposure_s)
            }),
            row("pixel_m", "pixel", |m| quantity(m, "m"), &|sheet| sheet.preset.figures.pixel_m),
            row("f_number", "f-number", |f| format!("f/{f}"), &|sheet| sheet.preset.figures.f_number),
            row("focal_length_m", "focal length", |m| quantity(m, "m"), &|sheet| {
                sheet.preset.figures.focal_length_m
            }),
            row(
                "etendue_m2_sr",
                "etendue of a pixel",
                |e| format!("{} m^2 sr", significant(e, 3)),
                &|sheet| camera(sheet, |camera| camera.etendue_m2_sr(None)),
            ),
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
            row("detectivity_cm_hz05_w", "D*", |d| format!("{} cm Hz^0.5/W", significant(d, 3)), &|sheet| {
                noise(sheet, |noise| noise.detectivity_cm_hz05_w)
            }),
            row(
                "nesr_microflick",
                "NESR of 1 cm^-1",
                |l| format!("{} uflick", significant(l, 3)),
                &|sheet| noise(sheet, |noise| Some(noise.nesr_microflick)),
            ),
            row(
                "gamma_per_band",
                "gamma of a band at its reference",
                |gamma| significant(gamma, 3),
                &|sheet| sheet.worked.as_ref().map(|worked| worked.figures.gamma_per_band),
            ),
            row(
                "hardware_m2_s",
                "t A_p / ((1+gamma) F^2)",
                |h| format!("{} m^2 s", significant(h, 3)),
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
            row("photons", "photons, all bands", [a.photons, b.photons], |photons| significant(photons, 3)),
            row(
                "noise_counts",
                "noise of a band beside its photons",
                [a.noise_counts, b.noise_counts],
                |counts| format!("{} counts", significant(counts, 3)),
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
                let keys = &sheet.missing.0;
                all.push(format!("{name}: not stated, to be given in a scenario: {}", keys.join(", ")));
            }
            let figures = &sheet.preset.figures;
            match (figures.spectral_bands, figures.readout) {
                (Some(1), None | Some(Readout::Sequential)) => all.push(format!(
                    "{name} has one band of its own: a spectrum takes filters, one after the other, here without loss"
                )),
                (Some(1), Some(readout)) => all.push(format!(
                    "{name} has one band of its own and is modelled as if it read a whole spectrum, {}",
                    readout.name()
                )),
                _ => {}
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
            "caveats": value(&self.caveats())?,
        }))
    }
}
