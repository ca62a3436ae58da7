//! What a study of ranging by air finds, as data.

use crate::{Condition, Warning};
use hadar::demand::Work;
use hadar::fisher::precision::Sight;
use hadar::ranging::depth::Demand;
use hadar_scenario::AirRangingScenario;
use hadar_simulate::efficiency::{Errors, Verdict};
use hadar_simulate::sequential::Interval;
use serde::Serialize;

/// The whole answer.
#[derive(Debug, Clone, Serialize)]
#[non_exhaustive]
pub struct AirRanging {
    /// What was asked, defaults filled in.
    pub scenario: AirRangingScenario,
    /// The answer in a sentence.
    pub verdict: AirVerdict,
    /// Name of the material of the target.
    pub target: String,
    /// Name of the camera that looks at it.
    pub camera: String,
    /// Name of the model of the air, or of its file.
    pub air: String,
    /// Temperature of the air along the path, K.
    pub air_temperature_k: f64,
    /// Whether the distance is seen at all.
    pub sight: AirSight,
    /// At the target's own distance.
    pub at: AirPoint,
    /// Over the distances asked for.
    pub curve: Vec<AirPoint>,
    /// Distances between which what is demanded is met, m.
    pub met_between_m: Option<[f64; 2]>,
    /// Distance beyond which the air tells more than a second camera, m.
    pub stereo_crossing_m: Option<f64>,
    /// What each band tells at the target's own distance.
    pub bands: Vec<AirBand>,
    /// The few best bands, where they are asked for.
    pub best_bands: Option<AirBest>,
    /// An estimator compared with its bound.
    pub witness: Vec<AirWitness>,
    /// Spectra at each of its distances.
    pub trials: usize,
    /// Seed from which the spectra were drawn.
    pub seed: u64,
    /// What the reader must know.
    pub warnings: Vec<Warning>,
    /// What was computed and what was skipped, with the time.
    pub stats: Work,
}

/// The answer.
#[derive(Debug, Clone, Serialize)]
pub struct AirVerdict {
    /// Whether what is demanded is met at the target's own distance; `None` where nothing is.
    pub met: Option<bool>,
    /// What is said, in JSON a sentence.
    pub sentence: AirFinding,
    /// What a 'yes' rests on, hardest first; of a 'no' what was taken on the unfavourable side.
    pub conditions: Vec<Condition>,
    /// Codes of conditions that whoever asks accepts.
    pub accepted: Vec<String>,
}

/// What the answer says.
#[derive(Debug, Clone, PartialEq)]
pub enum AirFinding {
    /// The distance is seen.
    Seen {
        /// Distance, m.
        distance_m: f64,
        /// Its least error, m.
        sigma_m: f64,
        /// What is unknown besides.
        unknown: Vec<String>,
        /// What is demanded, whether that is met, and between which distances.
        demand: Option<(Demand, bool, Option<[f64; 2]>)>,
        /// Photons of the brightest reading and of the full well, where they do not fit: nothing is met then.
        overfull: Option<[f64; 2]>,
        /// What a 'yes' rests on, hardest first.
        conditions: Vec<Condition>,
    },
    /// It changes nothing.
    Unchanged {
        /// Distance, m.
        distance_m: f64,
    },
    /// Other unknowns imitate it.
    Imitated {
        /// Distance, m.
        distance_m: f64,
        /// Which, and how.
        by: Vec<BlindChange>,
    },
}

/// How an unknown hides a change of the distance.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BlindChange {
    /// Name of the unknown that changes with the distance.
    pub unknown: String,
    /// Its change for 1 m.
    pub change_per_m: f64,
}

/// Whether and how well the distance is seen at the target's place.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AirSight {
    /// Whether it is seen, and why not.
    pub status: Sight,
    /// Changes of the unknowns that imitate a change of the distance.
    pub blind_direction: Vec<BlindChange>,
    /// Unknowns that change nothing, or nothing that others do not.
    pub without_effect: Vec<String>,
    /// What is unknown in addition to the distance.
    pub unknown: Vec<String>,
    /// Modes of the errors of the emissivity.
    pub emissivity_modes: usize,
    /// Estimated bound on the relative rounding error of the least error.
    pub relative_error: f64,
    /// Condition number of the scores.
    pub condition_number: f64,
    /// What priors tell of the distance, as a share.
    pub share_of_priors: f64,
}

/// One distance. Errors are `None` where the distance is not seen, or nobody asked.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AirPoint {
    /// Distance of the target from the camera, m.
    pub distance_m: f64,
    /// Least error of the distance, m.
    pub sigma_m: Option<f64>,
    /// The same as a share of the distance.
    pub relative_sigma: Option<f64>,
    /// The same with the emissivity known, m.
    pub sigma_emissivity_known_m: Option<f64>,
    /// The same with the lighting known, m.
    pub sigma_lighting_known_m: Option<f64>,
    /// The same with all else known, m.
    pub sigma_others_known_m: Option<f64>,
    /// What a model without sky finds too much, without noise, m.
    pub bias_without_sky_m: Option<f64>,
    /// Whether it ends at the end of the table of the air.
    pub without_sky_at_edge: bool,
    /// The least error of a whole window of a second camera's size, by air, m.
    pub sigma_window_m: Option<f64>,
    /// That of stereo with such a window, m.
    pub sigma_stereo_m: Option<f64>,
    /// Expected counts of all bands together.
    pub counts: f64,
}

/// One band at the target's own distance.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AirBand {
    /// Wavenumber at the centre of the band, cm⁻¹.
    pub center_cm1: f64,
    /// Share of the target's light that the air lets through.
    pub transmittance: f64,
    /// Expected counts of the band at that distance.
    pub counts: f64,
    /// Share of them that the path itself sends.
    pub share_of_path: f64,
    /// What it tells of the distance, all unknowns left to be fitted, m⁻².
    pub information_per_m2: f64,
    /// The same with all else known, m⁻².
    pub information_others_known_per_m2: f64,
}

/// The few best bands.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AirBest {
    /// Number of bands that was asked for.
    pub count: usize,
    /// Wavenumbers of the centres of the chosen bands, cm⁻¹.
    pub centers_cm1: Vec<f64>,
    /// Least error with them, m.
    pub sigma_m: Option<f64>,
    /// No choice of as many has a smaller one, m: proved.
    pub sigma_proved_m: Option<f64>,
    /// Least error of the distance with all bands, m.
    pub sigma_all_bands_m: Option<f64>,
    /// Whether the choice is proved to be the best.
    pub exact: bool,
}

/// Estimates at one distance compared with their bound.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AirWitness {
    /// True distance of the target, m.
    pub distance_m: f64,
    /// Least standard deviation of an unbiased estimate of the distance, m.
    pub bound_m: f64,
    /// Number of spectra that were drawn.
    pub trials: usize,
    /// Bias and errors of the estimates of the distance, m.
    pub errors: Errors,
    /// Root mean square error over the bound.
    pub rmse_over_bound: f64,
    /// Confidence interval of the root mean square error over the bound.
    pub rmse_over_bound_interval: Interval,
    /// Whether the estimator reaches its bound, as the interval shows.
    pub verdict: Verdict,
    /// Share of the fits that ended at an end of the table of the air.
    pub at_edge: f64,
    /// Fits that did not converge.
    pub unconverged: usize,
}

/// The distance beyond which the air is more precise than stereo, by the line between two points of the curve on logarithmic axes.
pub(super) fn crossing(curve: &[AirPoint]) -> Option<f64> {
    let lead = |point: &AirPoint| Some((point.sigma_window_m? / point.sigma_stereo_m?).ln());
    curve.windows(2).rev().find_map(|pair| {
        let (near, far) = (lead(&pair[0])?, lead(&pair[1])?);
        (near > 0.0 && far <= 0.0).then(|| {
            let share = near / (near - far);
            pair[0].distance_m * (pair[1].distance_m / pair[0].distance_m).powf(share)
        })
    })
}
