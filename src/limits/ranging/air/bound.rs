//! The least error of a distance that is read from the air on the path.
//!
//! With the scores s_i = ∂N/∂θ_i/√(N + σ²) of the counts, a row 1/σ_p for each prior, the deviation of any unbiased estimate of z
//! is at least 1/‖P⊥ s_z‖, P⊥ removing the span of the scores of all other unknowns ([`crate::fisher`]). What is left of
//! s_z in a band, squared, is the information that the band holds of z (m⁻²); their sum and that of the priors is 1/σ_z². Nothing is
//! inverted.
//!
//! A target that looks like the air, at its temperature among surroundings at its temperature, has ∂N/∂z = 0; unknowns may imitate any
//! change of z. Then there is no number, but the direction in which nothing changes.
//!
//! Assumptions: those of [`crate::fisher::precision`]: unbiased estimates, no range; with a prior the error averaged over it.

use super::{AirParameter, AirScene, AirState, AirUnknowns, SmoothModes};
use crate::error::{Error, Result};
use crate::fisher::precision::Sight;
use crate::fisher::{Counting, Projector};
use crate::identifiability::selection::Scores;
use crate::units::times_power_of_two;

/// Share of a score below which what is left of it is the rounding of its own elements.
const NOTHING: f64 = 1e-14;
/// Share of a change of the distance that an unknown imitates, below which it is not named.
const IMITATES: f64 = 1e-9;

/// Cramér–Rao bound of a distance.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct AirBound {
    /// Least deviation of an unbiased estimate, m; infinite unless it is seen.
    pub sigma_m: f64,
    /// The same with all else known, m.
    pub sigma_others_known_m: f64,
    /// Whether the distance is seen, and why not.
    pub sight: Sight,
    /// Change of the other unknowns that hides a change of the distance by 1 m; empty if it is seen.
    pub blind_direction: Vec<(AirParameter, f64)>,
    /// Other unknowns that change nothing, or nothing that the rest does not.
    pub dropped: Vec<AirParameter>,
    /// Estimated bound on the relative rounding error of the deviation.
    pub relative_error: f64,
    /// Ratio of the largest to the smallest singular value of the scores, scaled to unit length.
    pub condition_number: f64,
    /// What each band tells of the distance, m⁻²; their sum and that of the priors is 1/σ².
    pub information_per_m2: Vec<f64>,
    /// What the priors tell, m⁻².
    pub information_of_priors_per_m2: f64,
    /// What is unknown besides, in the order of the scores.
    pub unknowns: Vec<AirParameter>,
}

/// Computes bounds in one scene.
///
/// ```
/// use hadar::atmosphere::Atmosphere;
/// use hadar::fisher::{Counting, Nuisance, Unknowns};
/// use hadar::ranging::air::{AirScene, AirSolver, AirState, AirUnknowns};
/// use hadar::scene::{EnvironmentObject, Surroundings};
/// use hadar::spectrum::Bands;
/// let bands = Bands::uniform(770.0, 1250.0, 2.0)?;
/// let sky = EnvironmentObject { temperature_k: 250.0, emissivity: None };
/// let surroundings = Surroundings::new(bands.nodes_cm1(), vec![sky])?;
/// let air = Atmosphere::embedded("midlatitude-summer")?;
/// let paint = vec![0.9; bands.len()];
/// let scene = AirScene { bands: &bands, surroundings: &surroundings, emissivity: &paint, air: &air };
/// let counting = Counting { counts_per_radiance: 1e-11, var_added: vec![1e8; bands.len()] };
/// let state = AirState { distance_m: 100.0, target: surroundings.state(310.0, &[0.6])?, air_k: 294.2 };
/// let sigma_m = |scene_unknowns: &[Nuisance]| {
///     let scene_unknowns = Unknowns::new(scene_unknowns.iter().copied())?;
///     let unknowns = AirUnknowns { scene: scene_unknowns, ..AirUnknowns::default() };
///     AirSolver::new(scene, unknowns)?.bound(&state, &counting).map(|bound| bound.sigma_m)
/// };
/// let (known, unknown) = (sigma_m(&[])?, sigma_m(&[Nuisance::Temperature, Nuisance::Lighting])?);
/// assert!(known > 0.0 && unknown > known);
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct AirSolver<'a> {
    pub(super) scene: AirScene<'a>,
    pub(super) unknowns: AirUnknowns,
    modes: Option<SmoothModes>,
}

/// Scores of a state: the other unknowns, then the distance.
pub(super) struct AirScores {
    /// All but the distance.
    pub(super) unknowns: Vec<AirParameter>,
    /// Deviations of their priors.
    pub(super) priors: Vec<Option<f64>>,
    /// ∂N/∂θ of them and of the distance.
    pub(super) columns: Vec<Vec<f64>>,
    /// N.
    pub(super) counts: Vec<f64>,
    pub(super) var_added: Vec<f64>,
}

impl<'a> AirSolver<'a> {
    /// A solver for one scene and what is unknown in it.
    ///
    /// # Errors
    /// A deviation or correlation of the emissivity, or a prior, that is not positive.
    pub fn new(scene: AirScene<'a>, unknowns: AirUnknowns) -> Result<Self> {
        if let Some(Some(sigma_k)) = unknowns.air_temperature {
            crate::error::check::positive("prior on the temperature of the air", sigma_k, "K")?;
        }
        let modes = unknowns.emissivity.map(|errors| SmoothModes::new(scene.bands, errors)).transpose()?;
        Ok(Self { scene, unknowns, modes })
    }

    /// The modes of the errors of the emissivity that matter in a state; none where it is known.
    ///
    /// # Errors
    /// As [`AirSolver::bound`].
    pub fn modes(&self, state: &AirState, counting: &Counting) -> Result<&[Vec<f64>]> {
        let Some(modes) = &self.modes else { return Ok(&[]) };
        let one = [vec![1.0; self.scene.bands.len()]];
        let asked = [AirParameter::Emissivity(0)];
        let seen = self.scene.evaluate(self.scene.emissivity, state, &asked, &one, false)?;
        let kappa = counting.counts_per_radiance;
        let reach: Vec<f64> = seen
            .columns
            .iter()
            .flatten()
            .zip(&seen.signal)
            .enumerate()
            .map(|(w, (change, signal))| kappa * change / (kappa * signal + counting.var_added(w)).sqrt())
            .map(|reach| if reach.is_finite() { reach } else { 0.0 })
            .collect();
        Ok(modes.that_matter(&reach))
    }

    /// What is unknown besides the distance where the emissivity has so many modes, with the deviations of the priors.
    #[must_use]
    pub fn parameters(&self, modes: usize) -> Vec<(AirParameter, Option<f64>)> {
        let objects = self.scene.surroundings.objects().len();
        let scene = self.unknowns.scene.parameters(objects).into_iter();
        scene
            .map(|parameter| (AirParameter::Scene(parameter), self.unknowns.scene.sigma_prior(parameter)))
            .chain(self.unknowns.air_temperature.map(|prior| (AirParameter::AirTemperature, prior)))
            .chain((0..modes).map(|mode| (AirParameter::Emissivity(mode), Some(1.0))))
            .collect()
    }

    /// The scene.
    #[must_use]
    pub fn scene(&self) -> &AirScene<'a> {
        &self.scene
    }

    /// Whether the total of the lighting is known, and what it is.
    #[must_use]
    pub fn known_lighting_total(&self) -> Option<f64> {
        self.unknowns.scene.known_lighting_total()
    }

    pub(super) fn scores(&self, state: &AirState, counting: &Counting) -> Result<AirScores> {
        let scene = &self.scene;
        scene.check(state)?;
        counting.check(scene.bands.len())?;
        let modes = self.modes(state, counting)?;
        let (unknowns, priors): (Vec<_>, Vec<_>) = self.parameters(modes.len()).into_iter().unzip();
        let asked: Vec<AirParameter> = unknowns.iter().copied().chain([AirParameter::Distance]).collect();
        let total_known = self.known_lighting_total().is_some();
        let found = scene.evaluate(scene.emissivity, state, &asked, modes, total_known)?;
        let kappa = counting.counts_per_radiance;
        let scaled = |values: Vec<f64>| -> Vec<f64> { values.into_iter().map(|x| kappa * x).collect() };
        Ok(AirScores {
            unknowns,
            priors,
            columns: found.columns.into_iter().map(scaled).collect(),
            counts: scaled(found.signal),
            var_added: (0..scene.bands.len()).map(|w| counting.var_added(w)).collect(),
        })
    }

    /// The least error of the distance in `state`.
    ///
    /// # Errors
    /// A state that does not fit the scene, distances or bands that the air does not cover, noise that is none; scores that are no numbers.
    pub fn bound(&self, state: &AirState, counting: &Counting) -> Result<AirBound> {
        let scores = self.scores(state, counting)?;
        let bands = scores.counts.len();
        let with_prior: Vec<(usize, f64)> =
            scores.priors.iter().enumerate().filter_map(|(i, prior)| prior.map(|sigma| (i, sigma))).collect();
        let rows = bands + with_prior.len();
        let mut columns = Vec::with_capacity(rows * scores.columns.len());
        let mut powers = Vec::with_capacity(scores.columns.len());
        for (i, column) in scores.columns.iter().enumerate() {
            let whitened = column.iter().zip(&scores.counts).zip(&scores.var_added).map(|((d, n), var)| {
                // A band without counts or noise tells nothing.
                if n + var > 0.0 { d / (n + var).sqrt() } else { 0.0 }
            });
            let of_priors =
                with_prior.iter().map(|(owner, sigma)| if *owner == i { 1.0 / sigma } else { 0.0 });
            let values: Vec<f64> = whitened.chain(of_priors).collect();
            let largest = values.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
            if !largest.is_finite() || values.iter().any(|value| value.is_nan()) {
                let expected = "finite: fewer counts, or a wider prior";
                return Err(Error::out_of_range("score of a parameter", largest, "", expected));
            }
            let power = if largest > 0.0 { largest.log2().floor().clamp(-1000.0, 1000.0) as i32 } else { 0 };
            powers.push(power);
            columns.extend(values.iter().map(|value| times_power_of_two(*value, -power)));
        }
        let found = Projector::default().project(&mut columns, &vec![1.0; rows], 1.0);
        let scale = f64::from(powers.last().copied().unwrap_or(0)).exp2();
        let sight = if found.norm == 0.0 {
            Sight::Unchanged
        } else if found.residual * (1.0 + found.relative_error) <= NOTHING * found.norm
            || found.relative_error >= 1.0
        {
            // Where rounding leaves nothing, nothing is said.
            Sight::Imitated
        } else {
            Sight::Seen
        };
        let seen = sight == Sight::Seen;
        let left = columns.get(rows * (scores.columns.len() - 1)..).unwrap_or_default();
        let squares = left.iter().map(|x| if seen { (x * scale) * (x * scale) } else { 0.0 });
        let information: Vec<f64> = squares.collect();
        let (of_bands, of_priors) = information.split_at(bands.min(information.len()));
        let direction = |(i, c): (usize, &f64)| {
            let power = powers.last().copied().unwrap_or(0) - powers.get(i).copied().unwrap_or(0);
            // Of scores that are all about 1.
            let change = (c.abs() > IMITATES).then(|| -times_power_of_two(*c, power))?;
            Some((*scores.unknowns.get(i)?, change))
        };
        let sigma = |length: f64| if length > 0.0 { 1.0 / length / scale } else { f64::INFINITY };
        Ok(AirBound {
            sigma_m: if seen { sigma(found.residual) } else { f64::INFINITY },
            sigma_others_known_m: sigma(found.norm),
            sight,
            blind_direction: match sight {
                Sight::Imitated => found.coefficients.iter().enumerate().filter_map(direction).collect(),
                Sight::Seen | Sight::Unchanged => Vec::new(),
            },
            dropped: found.dropped.iter().filter_map(|&i| scores.unknowns.get(i).copied()).collect(),
            relative_error: if seen { found.relative_error } else { 0.0 },
            condition_number: found.condition_number(),
            information_per_m2: of_bands.to_vec(),
            information_of_priors_per_m2: crate::sum::sum(of_priors),
            unknowns: scores.unknowns,
        })
    }

    /// Derivatives and noise of the counts, the distance last, as choices of bands take them.
    pub(super) fn selection_scores(&self, state: &AirState, counting: &Counting) -> Result<Scores> {
        let AirScores { mut columns, counts, var_added, priors, .. } = self.scores(state, counting)?;
        let distance = columns.pop().unwrap_or_default();
        let priors = priors.iter().enumerate().filter_map(|(i, prior)| prior.map(|sigma| (i, sigma)));
        Scores::from_columns(columns, distance, counts, var_added)?.with_priors(priors)
    }
}
