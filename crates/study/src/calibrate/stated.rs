//! What is said of blackbodies whose uncertainty or emissivity is not.

use crate::Warning;
use hadar::planck;
use hadar_scenario::calibrate::blackbodies::BlackbodySpec;

/// Temperatures that are taken as exact since nothing is said of them.
pub(super) fn uncertainty_not_stated(specs: &[BlackbodySpec]) -> Option<Warning> {
    let silent: Vec<usize> = (0..specs.len()).filter(|k| specs[*k].uncertainty_k.is_none()).collect();
    (!silent.is_empty()).then_some(Warning::UncertaintyNotStated { blackbodies: silent, of: specs.len() })
}

/// Emissivity that tells what an unknown one may cost.
const GREY: f64 = 0.98;

/// Blackbodies that are taken as black since nothing is said of it, and what an emissivity of [`GREY`] of the warmest would be worth at
/// this wavenumber, were it to reflect what the coldest sends, K.
pub(super) fn taken_as_black(specs: &[BlackbodySpec], wavenumber_cm1: f64) -> Option<Warning> {
    let silent: Vec<usize> = (0..specs.len()).filter(|k| specs[*k].emissivity.is_none()).collect();
    let ends = |of: fn(f64, f64) -> f64| specs.iter().map(|spec| spec.temperature_k).reduce(of);
    let (cold_k, warm_k) = (ends(f64::min)?, ends(f64::max)?);
    let radiance = |t: f64| planck::photon_radiance(wavenumber_cm1, t);
    let colder_k = (1.0 - GREY) * (radiance(warm_k) - radiance(cold_k))
        / planck::photon_radiance_slope(wavenumber_cm1, warm_k);
    (!silent.is_empty()).then_some(Warning::BlackbodiesTakenAsBlack {
        blackbodies: silent,
        of: specs.len(),
        emissivity: GREY,
        warm_k,
        colder_k,
    })
}
