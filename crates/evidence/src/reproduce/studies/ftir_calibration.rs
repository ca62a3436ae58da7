//! Calibration of a spectrometer by blackbodies (paper SVI): its errors held against drawn experiments, and the best temperatures to choose.
//!
//! * Response, offset, radiance, emissivity and surroundings of a twin of known truth, drawn: how often their 95 % intervals hold;
//! * the error that blackbodies of two temperatures leave in a radiance, over both, and the best of 2 to 6;
//! * the error of an emissivity from two temperatures of a surface (S57), over both: noise against the change of the emissivity.

mod choice;
mod files;
mod shown;
mod text;

use crate::reproduce::coverage::{Experiment, spectrometer};
use crate::reproduce::order::{Effort, Order, Progress};
use choice::{Wanted, WantedSurface, best_blackbodies, emissivity_error, radiance_error};
use hadar::error::Result;
use hadar::material::Library;
use hadar::planck;
use hadar_estimate::calibrate::twin::SpectrometerTwin;
use hadar_report::bundle::Bundle;
use shown::{
    Best, EMISSIVITY, Held, Plane, READINGS, SLOPE_PER_K, SURROUNDINGS_K, Shown, TEMPERATURE_ERROR_K,
    WANTED_K,
};

/// Scenes whose radiance is to be measured, K.
const SCENES_K: [f64; 6] = [270.0, 280.0, 290.0, 300.0, 310.0, 320.0];
/// Temperatures that blackbodies may have: with a cooled one, and without.
const COOLED_K: [f64; 2] = [250.0, 400.0];
const HEATED_K: [f64; 2] = [300.0, 400.0];
const COUNTS: [usize; 4] = [2, 3, 4, 6];
const EXPERIMENTS: usize = 2000;
const QUICK_EXPERIMENTS: usize = 200;

const SETS: [(&[f64], &[f64]); 3] = [
    (&[283.15, 333.15], &[0.0, 0.0]),
    (&[283.15, 333.15], &[0.03, 0.05]),
    (&[278.15, 303.15, 328.15, 353.15], &[0.05, 0.03, 0.05, 0.1]),
];

pub(super) fn make(order: Order, _: &Library, progress: Progress<'_>) -> Result<(Bundle, String)> {
    let twin = SpectrometerTwin::new();
    let experiments = if order.effort == Effort::Full { EXPERIMENTS } else { QUICK_EXPERIMENTS };
    let total = SETS.len() + 3;
    let mut held = Vec::new();
    for (i, (blackbodies_k, errors_k)) in SETS.into_iter().enumerate() {
        let of = Experiment {
            blackbodies_k,
            errors_k,
            surface_k: &[300.0, 330.0],
            surface_errors_k: &[0.02, 0.04],
            emissivity: 0.7,
            surroundings_k: 275.0,
            scene_k: 310.0,
        };
        held.push(Held {
            blackbodies_k,
            errors_k,
            coverage: spectrometer(&twin, of, experiments, order.seed)?,
        });
        progress(i + 1, total);
    }
    let wanted = Wanted {
        sigma: vec![twin.sigma / READINGS.sqrt(); twin.wavenumbers_cm1.len()],
        wavenumbers_cm1: twin.wavenumbers_cm1.clone(),
        response: twin.response.clone(),
        temperature_error_k: TEMPERATURE_ERROR_K,
        scenes_k: SCENES_K.to_vec(),
    };
    let axis = |[low, high]: [f64; 2], step: f64| -> Vec<f64> {
        (0..=((high - low) / step).round() as usize).map(|i| low + step * i as f64).collect()
    };
    let pairs = Plane::over(axis(COOLED_K, 5.0), |a, b| radiance_error(&wanted, &[a, b]))?;
    progress(SETS.len() + 1, total);
    let mut best = Vec::new();
    for within_k in [COOLED_K, HEATED_K] {
        for count in COUNTS {
            let (temperatures_k, error) = best_blackbodies(&wanted, &axis(within_k, 10.0), count)?;
            best.push(Best { within_k, temperatures_k, error });
        }
    }
    progress(SETS.len() + 2, total);
    let errors_k = vec![TEMPERATURE_ERROR_K; 2];
    let surface = WantedSurface {
        emissivity: vec![EMISSIVITY; twin.wavenumbers_cm1.len()],
        surroundings: twin
            .wavenumbers_cm1
            .iter()
            .map(|nu| planck::photon_radiance(*nu, SURROUNDINGS_K))
            .collect(),
        slope_per_k: SLOPE_PER_K,
        wanted_k: WANTED_K,
        blackbodies: twin.readings(&[283.15, 353.15], &errors_k)?,
        spectrometer: wanted,
    };
    let spacing = (0..14).map(|i| {
        let apart = 0.5 * 1.45f64.powi(i);
        let pair = [WANTED_K + 0.5 * apart, WANTED_K - 0.5 * apart];
        Ok((apart, emissivity_error(&surface, pair)?))
    });
    let shown = Shown {
        experiments,
        held,
        pairs,
        best,
        spacing: spacing.collect::<Result<Vec<_>>>()?,
        surface: Plane::over(axis([250.0, 400.0], 2.5), |a, b| emissivity_error(&surface, [b, a]))?,
    };
    progress(total, total);
    let mut bundle = Bundle::default();
    bundle.add_table("coverage.csv", files::coverage(&shown))?;
    bundle.add_table("best.csv", files::best(&shown))?;
    bundle.add_plots(&[files::pairs(&shown), files::surface(&shown), files::spacing(&shown)])?;
    bundle.add("README.md", text::readme(&shown, order.seed));
    Ok((bundle, text::finding(&shown)))
}
