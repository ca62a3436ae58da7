//! What the reader of a result must know, with stable codes.

mod camera;

use super::identify::PairResult;
use super::{Study, Warning};
use crate::scenario::DistanceKind;
use hadar::fisher::Nuisance;
use hadar::identifiability::Status;
use hadar::identifiability::local::LocalDistance;
use hadar::identifiability::nearest::{NearestDistance, StateRange};
use hadar::instrument::{Camera, Readout};
use hadar::planck;
use hadar::scene::{Parameter, State};

/// Ratio of local and nearest distance beyond which the linear picture has failed.
const LINEAR_FACTOR: f64 = 2.0;
/// Share of a distance that emissivity errors of 0.1 % can make up before a word of caution is due.
pub(super) const FRAGILE_RATIO: f64 = 50.0;
/// Photons per mode beyond which bunching is no longer negligible.
const OCCUPANCY: f64 = 0.1;

/// Warnings on one pair.
pub(super) fn of_pair(
    pair: &PairResult,
    local: &LocalDistance,
    nearest: &NearestDistance,
    kind: DistanceKind,
    range: &StateRange,
) -> Vec<Warning> {
    let mut warnings = Vec::new();
    let mut warn = |code, message: String| {
        warnings.push(Warning::new(code, format!("{} against {}: {message}", pair.target, pair.alternative)));
    };
    match pair.status {
        Status::Ok => {}
        Status::Identical => warn("identical", "the two emissivities are equal in every band".into()),
        Status::Equilibrium => warn(
            "equilibrium",
            "target and surroundings are in thermal equilibrium; every material looks like a blackbody"
                .into(),
        ),
        Status::Blind => {
            warn("blind", "a change of the unknowns looks exactly like the change of material".into());
        }
    }
    // Where physics ends there is no further state to be asked for.
    let chosen: Vec<String> = nearest
        .at_edge
        .iter()
        .filter(|parameter| stands_where_asked(**parameter, &nearest.state, range))
        .map(|parameter| in_words(*parameter, nearest.state.lighting.len()))
        .collect();
    if !chosen.is_empty() && pair.status == Status::Ok {
        let message = format!(
            "the nearest state stands at the edge of its range ({}); the range decides the answer",
            chosen.join(", ")
        );
        warn("nearest-at-edge", message);
    }
    if !nearest.converged {
        warn("nearest-not-converged", "the search for the nearest state stopped early".into());
    }
    let (d_local, d_nearest) = (pair.distance_local, pair.distance_nearest);
    let ratio = (d_local / d_nearest).max(d_nearest / d_local);
    if pair.status == Status::Ok && ratio > LINEAR_FACTOR {
        let message = format!(
            "local ({d_local:.2e}) and nearest ({d_nearest:.2e}) distance differ by a factor {ratio:.1}; \
             only the nearest one is a limit"
        );
        warn("local-differs", message);
    }
    if pair.status == Status::Ok && local.distance_no_nuisance > FRAGILE_RATIO * pair.distance(kind) {
        warn(
            "fragile",
            "the spectra are nearly featureless: errors of 0.1 % in the emissivities can change this distance several times over".into(),
        );
    }
    if !local.dropped.is_empty() && pair.status == Status::Ok {
        let objects = nearest.state.lighting.len();
        let names: Vec<String> =
            local.dropped.iter().map(|parameter| in_words(*parameter, objects)).collect();
        let change = if names.len() == 1 { "changes" } else { "change" };
        warn("unknown-without-effect", format!("{} {change} nothing in this scene", names.join(", ")));
    }
    warnings
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

/// A parameter as a reader calls it.
fn in_words(parameter: Parameter, objects: usize) -> String {
    let of = |what: &str, k: usize| {
        if objects > 1 {
            format!("{what} of environment[{k}]")
        } else {
            format!("{what} of the surroundings")
        }
    };
    match parameter {
        Parameter::Temperature => "temperature".into(),
        Parameter::Lighting(k) => of("lighting", k),
        Parameter::Gain => "gain".into(),
        Parameter::EnvironmentTemperature(k) => of("temperature", k),
        Parameter::Material => "material".into(),
    }
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
            let what = if included {
                "bunching raises the noise of the light that is counted, which is included"
            } else {
                "bunching, which is neglected (camera.photon_bunching), raises the noise by as much"
            };
            let message = format!("{occupancy:.2} photons per mode at {low:.0} cm^-1: {what}");
            warnings.push(Warning::new("bunching", message));
        }
        if self.is_unknown(Nuisance::EnvironmentTemperature) {
            let message = "with the temperatures of the surroundings unknown there are many similar states; the search \
                           for the nearest one missed it in up to a quarter of random scenes, so the nearest distance may be too large";
            warnings.push(Warning::new("nearest-search", message));
        } else if self.is_unknown(Nuisance::Gain) {
            let message = "with the gain unknown the search for the nearest state missed it in one of 200 random scenes, by up to 3 %";
            warnings.push(Warning::new("nearest-search", message));
        }
        if let Some(camera) = &self.camera {
            warnings.extend(sequential(camera, self.bands.len()));
        }
        warnings
    }
}

fn sequential(camera: &Camera, bands: usize) -> Option<Warning> {
    (camera.readout == Readout::Sequential && bands > 1).then(|| {
        let message = format!(
            "bands are read one after the other: {:.3e} s until all {bands} are there, during which nothing may change",
            camera.acquisition_s(bands)
        );
        Warning::new("sequential-readout", message)
    })
}
