//! What the reader of a result must know, with stable codes.

mod camera;

pub(super) use camera::{assumed, contradiction};

use super::identify::{NearestProof, PairResult};
use super::{Study, Warning};
use hadar::identifiability::Status;
use hadar::identifiability::local::LocalDistance;
use hadar::identifiability::nearest::{NearestDistance, StateRange};
use hadar::instrument::{Camera, Readout};
use hadar::planck;
use hadar::scene::{Parameter, State};
use hadar_scenario::DistanceKind;

/// Ratio of local and nearest distance beyond which the linear picture has failed.
const LINEAR_FACTOR: f64 = 2.0;
/// Share of a distance that emissivity errors of 0.1 % can make up before a word of caution is due.
pub(super) const FRAGILE_RATIO: f64 = 50.0;
/// Relative error that three printed digits stand for.
const PRINTED: f64 = 1e-3;
/// The widest band that may be taken at its centre without a word, cm⁻¹: features of solids are wider.
const SAMPLED_CM1: f64 = 10.0;
/// How wide a person is, m.
const PERSON_M: f64 = 0.5;
/// Photons per mode beyond which bunching is no longer negligible.
const OCCUPANCY: f64 = 0.1;

/// Warnings on one pair.
pub(super) fn of_pair(
    pair: &PairResult,
    local: &LocalDistance,
    nearest: &NearestDistance,
    kind: DistanceKind,
    range: &StateRange,
    priors: bool,
) -> Vec<Warning> {
    let mut warnings = Vec::new();
    let mut warn = |warning: Warning| {
        let (target, alternative) = (pair.target.clone(), pair.alternative.clone());
        warnings.push(Warning::OfPair { target, alternative, warning: Box::new(warning) });
    };
    match pair.status {
        Status::Ok => {}
        Status::Identical => warn(Warning::Identical),
        Status::Equilibrium => warn(Warning::Equilibrium),
        Status::Blind => warn(Warning::Blind),
    }
    let objects = nearest.state.lighting.len();
    // Where physics ends there is no further state to be asked for.
    let chosen = |parameter: &Parameter| stands_where_asked(*parameter, &nearest.state, range);
    let parameters: Vec<Parameter> = nearest.at_edge.iter().copied().filter(chosen).collect();
    if !parameters.is_empty() && pair.status == Status::Ok {
        warn(Warning::NearestAtEdge { parameters, objects });
    }
    if pair.proof == NearestProof::Searched {
        warn(Warning::NearestSearch { distance: nearest.distance, lower: nearest.lower, priors });
    }
    let errors = [
        ("nearest distance", pair.relative_error_nearest),
        ("return distance", pair.relative_error_return),
        ("local distance", pair.relative_error),
        ("local distance with unknown gain", pair.relative_error_unknown_gain),
    ];
    errors.into_iter().filter_map(few_digits).for_each(&mut warn);
    let (d_local, d_nearest) = (pair.distance_local, pair.distance_nearest);
    let ratio = (d_local / d_nearest).max(d_nearest / d_local);
    if pair.status == Status::Ok && ratio > LINEAR_FACTOR {
        warn(Warning::LocalDiffers { local: d_local, nearest: d_nearest, ratio });
    }
    if pair.status == Status::Ok && local.distance_no_nuisance > FRAGILE_RATIO * pair.distance(kind) {
        warn(Warning::Fragile);
    }
    if !local.dropped.is_empty() && pair.status == Status::Ok {
        warn(Warning::UnknownWithoutEffect { parameters: local.dropped.clone(), objects });
    }
    warnings
}

/// Where more of a distance is printed than rounding has left.
fn few_digits((distance, relative_error): (&'static str, f64)) -> Option<Warning> {
    // Or not a number.
    let known = relative_error <= PRINTED;
    (!known).then_some(Warning::FewDigits { distance, relative_error })
}

/// Whether a parameter at the edge of its range stands at an end that the scenario set, not physics.
fn stands_where_asked(parameter: Parameter, state: &State, range: &StateRange) -> bool {
    let physical = StateRange::default();
    let (value, asked, physical) = match parameter {
        Parameter::Temperature => (state.temperature_k, range.temperature_k, physical.temperature_k),
        Parameter::Lighting(k) => {
            let Some(factor) = state.lighting.get(k) else { return false };
            (*factor, range.lighting, physical.lighting)
        }
        Parameter::Gain | Parameter::EnvironmentTemperature(_) | Parameter::Material => return false,
    };
    // Not at either end where it is the sum of the lighting that is full.
    let near = |end: f64| (value - end).abs() <= 1e-6 * end.abs().max(1e-3);
    asked.into_iter().zip(physical).any(|(asked, physical)| asked != physical && near(asked))
}

impl Study {
    /// Warnings that hold for every pair.
    pub(super) fn camera_warnings(&self) -> Vec<Warning> {
        let mut warnings = Vec::new();
        let hottest = self.state.environment_k.iter().copied().fold(self.state.temperature_k, f64::max);
        let (low, _) = self.bands.range_cm1();
        // Occupancy of a mode: 1/(eˣ − 1) = B/(2cν²).
        let occupancy = planck::occupancy(low, hottest);
        if occupancy > OCCUPANCY {
            let included = self.camera.as_ref().is_some_and(|camera| camera.photon_bunching);
            warnings.push(Warning::Bunching { occupancy, wavenumber_cm1: low, included });
        }
        warnings.extend(self.sampled_cm1().map(|width_cm1| Warning::BandsSampled { width_cm1 }));
        if self.surroundings.objects().is_empty() {
            warnings.push(Warning::NoSurroundings);
        }
        if let Some(camera) = &self.camera {
            warnings.extend(sequential(camera, self.bands.len()));
        }
        warnings
    }

    /// Width of the widest band that is sampled at its centre, cm⁻¹, where that is too wide.
    pub(super) fn sampled_cm1(&self) -> Option<f64> {
        self.integration.sampled_cm1.filter(|width_cm1| *width_cm1 > SAMPLED_CM1)
    }

    /// Where a target of no stated size is taken to fill a pixel that sees more than a person from a distance.
    pub(super) fn size_unknown(&self, camera: &Camera, distance_m: Option<f64>) -> Option<Warning> {
        let footprint_m = camera.footprint_m(distance_m?);
        (self.scenario.target.size_m.is_none() && footprint_m > PERSON_M)
            .then_some(Warning::TargetSizeUnknown { footprint_m })
    }
}

fn sequential(camera: &Camera, bands: usize) -> Option<Warning> {
    (camera.readout == Readout::Sequential && bands > 1)
        .then(|| Warning::SequentialReadout { acquisition_s: camera.acquisition_s(bands), bands })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_that_are_printed_and_not_known_are_told() {
        assert_eq!(few_digits(("local distance", 0.0)), None);
        assert_eq!(few_digits(("local distance", 9e-4)), None);
        for error in [2e-2, 1e300, f64::NAN] {
            assert!(few_digits(("local distance", error)).is_some(), "{error}");
        }
    }
}
