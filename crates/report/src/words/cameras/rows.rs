//! The figures of two cameras side by side, and what each does before the same scene: what they are called and how they are written.

use crate::cameras::{Sheet, SideBySide};
use hadar::instrument::{Camera, Equivalents};
use hadar::words::{quantity, significant};

/// A figure of two cameras side by side.
#[derive(Debug, Clone)]
pub(crate) struct Row {
    /// Its key in JSON.
    pub(crate) key: &'static str,
    /// Its name.
    pub(crate) label: &'static str,
    /// Of A and of B.
    pub(crate) values: [Option<f64>; 2],
    /// How it is written.
    pub(crate) shown: fn(f64) -> String,
}

impl Row {
    /// B over A.
    #[must_use]
    pub(crate) fn ratio(&self) -> Option<f64> {
        let [a, b] = self.values;
        a.zip(b).filter(|(a, _)| *a != 0.0).map(|(a, b)| b / a)
    }
}

/// The figures of each, without the scene.
#[must_use]
pub(crate) fn alone(both: &SideBySide) -> Vec<Row> {
    let row = |key, label, shown: fn(f64) -> String, of: &dyn Fn(&Sheet) -> Option<f64>| Row {
        key,
        label,
        values: [of(&both.a), of(&both.b)],
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
        row("etendue_m2_sr", "etendue of a pixel", |e| format!("{} m^2 sr", significant(e, 3)), &|sheet| {
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
        row("detectivity_cm_hz05_w", "D*", |d| format!("{} cm Hz^0.5/W", significant(d, 3)), &|sheet| {
            noise(sheet, |noise| noise.detectivity_cm_hz05_w)
        }),
        row("nesr_microflick", "NESR of 1 cm^-1", |l| format!("{} uflick", significant(l, 3)), &|sheet| {
            noise(sheet, |noise| Some(noise.nesr_microflick))
        }),
        row("gamma_per_band", "gamma of a band at its reference", |gamma| significant(gamma, 3), &|sheet| {
            sheet.worked.as_ref().map(|worked| worked.figures.gamma_per_band)
        }),
        row(
            "hardware_m2_s",
            "H = t A_p / ((1+gamma) F^2)",
            |h| format!("{} m^2 s", significant(h, 3)),
            &|sheet| sheet.worked.as_ref().map(|worked| worked.figures.hardware_m2_s),
        ),
    ]
}

/// What each does before the common scene; empty where it cannot be told.
#[must_use]
pub(crate) fn in_scene(both: &SideBySide) -> Vec<Row> {
    let Some(ratios) = &both.comparison else { return Vec::new() };
    let row = |key, label, values: [f64; 2], shown: fn(f64) -> String| Row {
        key,
        label,
        values: values.map(Some),
        shown,
    };
    let (a, b) = (&ratios.a, &ratios.b);
    let (bands_a, bands_b) = (a.bands as f64, b.bands as f64);
    vec![
        row("acquisition_s", "time for all bands", [a.acquisition_s, b.acquisition_s], |s| quantity(s, "s")),
        row("photons", "photons, all bands", [a.photons, b.photons], |photons| significant(photons, 3)),
        row(
            "noise_counts",
            "noise of a band without shot noise",
            [a.noise_counts, b.noise_counts],
            |counts| format!("{} counts", significant(counts, 3)),
        ),
        row(
            "noise_over_photons",
            "that over the photons of a band",
            [a.noise_counts * bands_a / a.photons, b.noise_counts * bands_b / b.photons],
            |share| significant(share, 3),
        ),
        row("distance", "d of 1 % in one band", [0.01 * a.figure_of_merit, 0.01 * b.figure_of_merit], |d| {
            significant(d, 3)
        }),
    ]
}
