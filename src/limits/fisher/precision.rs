//! How precisely a state can be read from one spectrum: the Cramér–Rao bound of temperature, lighting and the like.
//!
//! With scores s_i = ∂N/∂θ_i/√(N + σ²) (mean counts N and electronic variance σ² of each band, counts²), the deviation
//! of any unbiased estimate of θ_i is at least
//!
//! σ_i = 1/‖P⊥ s_i‖,
//!
//! P⊥ removing the span of the scores of all other unknown parameters: √[J⁻¹]_ii without J or its inverse
//! (`bound`). A Gaussian prior of deviation σ_p adds the row 1/σ_p; the bound is then one on the error averaged over
//! that prior. All parameters at once: J = RᵀR, R the triangular factor of the scores ([`JointBound`]).
//!
//! Units: K for temperatures, 1 for lighting and ln gain. The emissivity is known.
//!
//! Assumptions: unbiased estimates of parameters that no range restricts. At the edge of a range (0 ≤ V ≤ 1), or where
//! σ_i is not small beside it, an estimate is biased and may err less than this. Information in the variance itself,
//! ½(∂N)²/(N + σ²)² of Gaussian counts, is left out: a share of at most ½/(N + σ²), and none of Poisson counts. A
//! band without counts or noise tells nothing.
//!
//! Source: paper S24–S27 and Methods 'HADAR thermography'; Kay, 'Fundamentals of Statistical Signal Processing' (1993),
//! chapter 3; for priors van Trees, 'Detection, Estimation, and Modulation Theory' I (1968), section 2.4.

mod joint;
#[cfg(test)]
mod tests;

pub use joint::JointBound;

use super::{CarefulProjector, Counting, Noise, Projection, Projector, Unknowns};
use crate::error::{Error, Result};
use crate::scene::{Asked, Columns, Jacobian, Parameter, State, Surroundings, check_emissivity};
use crate::spectrum::Bands;
use crate::units::times_power_of_two;

/// Whether a spectrum tells anything of a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Sight {
    /// It does.
    Seen,
    /// The parameter changes nothing in any band: the lighting of a black target, say.
    Unchanged,
    /// The other unknowns can imitate any change of it.
    Imitated,
}

/// Cramér–Rao bound of one parameter.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Precision {
    /// Which one.
    pub parameter: Parameter,
    /// Least deviation of an unbiased estimate, in the parameter's unit; infinite unless it is [`Sight::Seen`].
    pub sigma: f64,
    /// The same with all other parameters known (its own prior still counts).
    pub sigma_others_known: f64,
    /// Estimated bound on the relative rounding error of `sigma`.
    pub relative_error: f64,
    /// Why `sigma` is infinite, if it is.
    pub sight: Sight,
    /// Other unknowns that change nothing, or nothing that the rest does not.
    pub dropped: Vec<Parameter>,
}

/// Cramér–Rao bounds of all unknown parameters together.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct JointPrecision {
    /// One by one, in the order of [`Unknowns::parameters`].
    pub each: Vec<Precision>,
    /// Their covariance; `None` if one of them is not seen.
    pub joint: Option<JointBound>,
}

/// Computes bounds in fixed bands and surroundings.
///
/// ```
/// use hadar::fisher::precision::PrecisionSolver;
/// use hadar::fisher::{Counting, Nuisance, Unknowns};
/// use hadar::scene::{EnvironmentObject, Parameter, Surroundings};
/// use hadar::spectrum::Bands;
///
/// let bands = Bands::uniform(715.0, 1250.0, 1.0)?;
/// let ambient = EnvironmentObject { temperature_k: 293.15, emissivity: None };
/// let surroundings = Surroundings::new(bands.nodes_cm1(), vec![ambient])?;
/// let skin = vec![0.97; bands.len()];
/// let state = surroundings.state(310.15, &[0.5])?;
/// let counting = Counting { counts_per_radiance: 1e-12, var_added: vec![1e12; bands.len()] };
/// let sigma_k = |unknown: &[Nuisance]| {
///     let unknowns = Unknowns::new(unknown.iter().copied())?;
///     let mut solver = PrecisionSolver::new(&bands, &surroundings, unknowns);
///     solver.bound(&skin, &state, &counting, Parameter::Temperature).map(|bound| bound.sigma)
/// };
/// let (known, unknown) = (sigma_k(&[Nuisance::Temperature])?, sigma_k(&[Nuisance::Temperature, Nuisance::Lighting])?);
/// assert!(known > 0.0 && unknown > known);
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct PrecisionSolver<'a> {
    unknowns: Unknowns,
    parameters: Vec<Parameter>,
    jacobian: Jacobian<'a>,
    projector: Projector,
    careful: CarefulProjector<'a>,
    scores: Vec<Score>,
    columns: Vec<f64>,
    ones: Vec<f64>,
}

/// Score of one parameter over bands and rows of priors, divided by a power of two that makes it about 1.
#[derive(Debug, Clone)]
struct Score {
    values: Vec<f64>,
    scale: f64,
}

impl<'a> PrecisionSolver<'a> {
    /// A solver for one set of bands, surroundings and unknown parameters.
    #[must_use]
    pub fn new(bands: &'a Bands, surroundings: &'a Surroundings, unknowns: Unknowns) -> Self {
        Self {
            parameters: unknowns.parameters(surroundings.objects().len()),
            unknowns,
            jacobian: Jacobian::new(bands, surroundings),
            projector: Projector::default(),
            careful: CarefulProjector::new(bands, surroundings),
            scores: Vec::new(),
            columns: Vec::new(),
            ones: Vec::new(),
        }
    }

    /// The bound of one unknown parameter of a surface of `emissivity` (at the nodes) in `state`.
    ///
    /// # Errors
    /// A parameter that is not among the unknowns; an emissivity, state or noise that does not fit the scene.
    pub fn bound(
        &mut self,
        emissivity: &[f64],
        state: &State,
        counting: &Counting,
        parameter: Parameter,
    ) -> Result<Precision> {
        let Some(own) = self.parameters.iter().position(|p| *p == parameter) else {
            let found = format!("a bound of {parameter:?}, which is not among the unknowns");
            return Err(Error::malformed(found, "add it to the unknowns"));
        };
        self.evaluate(emissivity, state, counting)?;
        Ok(self.one(own, emissivity, state, counting).0)
    }

    /// The bounds of all unknown parameters.
    ///
    /// # Errors
    /// No unknown parameters at all; otherwise as [`PrecisionSolver::bound`].
    pub fn joint(
        &mut self,
        emissivity: &[f64],
        state: &State,
        counting: &Counting,
    ) -> Result<JointPrecision> {
        let Some(last) = self.parameters.len().checked_sub(1) else {
            return Err(Error::malformed("a bound without unknown parameters", "name at least one unknown"));
        };
        self.evaluate(emissivity, state, counting)?;
        let mut each = Vec::with_capacity(last + 1);
        let mut joint = None;
        for own in 0..=last {
            let (precision, projection, scales) = self.one(own, emissivity, state, counting);
            // The last one has all columns in their own order.
            if own == last {
                let (triangle, norms) = projection.factor();
                joint = Some(JointBound::from_factor(triangle, norms, &scales));
            }
            each.push(precision);
        }
        let seen = each.iter().all(|precision| precision.sight == Sight::Seen);
        Ok(JointPrecision { each, joint: joint.filter(|_| seen) })
    }

    fn evaluate(&mut self, emissivity: &[f64], state: &State, counting: &Counting) -> Result<()> {
        let surroundings = self.jacobian.surroundings();
        check_emissivity(emissivity, surroundings.nodes_cm1().len())?;
        surroundings.check(state)?;
        counting.check(self.jacobian.bands().len())?;
        let total_known = self.unknowns.known_lighting_total().is_some();
        self.jacobian.evaluate(emissivity, emissivity, state, &self.parameters, total_known);
        let counts = counting.counts_per_radiance;
        let reciprocal_sigma: Vec<f64> = (self.jacobian.signal().iter().enumerate())
            .map(|(band, signal)| {
                let var = counts * signal + counting.var_added(band);
                if var > 0.0 { counts / var.sqrt() } else { 0.0 }
            })
            .collect();
        let priors: Vec<Option<f64>> =
            self.parameters.iter().map(|parameter| self.unknowns.sigma_prior(*parameter)).collect();
        self.scores.clear();
        for i in 0..self.parameters.len() {
            let of_bands = self.jacobian.column(i).iter().zip(&reciprocal_sigma).map(|(d, r)| d * r);
            let of_priors = priors
                .iter()
                .enumerate()
                .filter_map(|(owner, sigma)| sigma.map(|sigma| if owner == i { 1.0 / sigma } else { 0.0 }));
            let mut values: Vec<f64> = of_bands.chain(of_priors).collect();
            let largest = values.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
            if !largest.is_finite() {
                let expected = "finite: fewer counts or a wider prior";
                return Err(Error::out_of_range("score of a parameter", largest, "", expected));
            }
            let scale =
                if largest > 0.0 { largest.log2().floor().clamp(-1000.0, 1000.0).exp2() } else { 1.0 };
            values.iter_mut().for_each(|value| *value /= scale);
            self.scores.push(Score { values, scale });
        }
        Ok(())
    }

    /// What is left of one score when those of all other parameters are taken off it, and what the columns were divided by.
    fn one(
        &mut self,
        own: usize,
        emissivity: &[f64],
        state: &State,
        counting: &Counting,
    ) -> (Precision, Projection, Vec<f64>) {
        self.columns.clear();
        let others = (0..self.scores.len()).filter(|&i| i != own);
        let order: Vec<usize> = others.clone().chain(std::iter::once(own)).collect();
        let mut scales = Vec::with_capacity(order.len());
        for score in order.iter().filter_map(|&i| self.scores.get(i)) {
            self.columns.extend_from_slice(&score.values);
            scales.push(score.scale);
        }
        let rows = self.scores.get(own).map_or(0, |score| score.values.len());
        self.ones.resize(rows, 1.0);
        let columns = Columns { values: &mut self.columns, stride: rows };
        let mut found = self.projector.reduce(columns, &self.ones, 1.0);
        if self.careful.loses_light(state) || self.projector.in_doubt(found, |_| false) {
            let parameters: Vec<Parameter> =
                order.iter().filter_map(|&i| self.parameters.get(i).copied()).collect();
            let asked = Asked {
                emissivity,
                alternative: emissivity,
                state,
                parameters: &parameters,
                lighting_total_known: self.unknowns.known_lighting_total().is_some(),
            };
            let careful = self.careful.project(asked, Noise::Counting(counting), &self.unknowns);
            scales = careful.powers.iter().map(|&power| times_power_of_two(1.0, power)).collect();
            found = self.projector.adopt_scaled(careful);
        }
        let scale = scales.last().copied().unwrap_or(1.0);
        let projection = self.projector.projection(found);
        let sight = if projection.norm == 0.0 {
            Sight::Unchanged
        } else if found.is_nothing() {
            Sight::Imitated
        } else {
            Sight::Seen
        };
        let others: Vec<Parameter> = others.filter_map(|i| self.parameters.get(i).copied()).collect();
        let sigma = |length: f64| if length > 0.0 { 1.0 / length / scale } else { f64::INFINITY };
        let precision = Precision {
            parameter: self.parameters.get(own).copied().unwrap_or(Parameter::Temperature),
            sigma: if sight == Sight::Seen { sigma(projection.residual) } else { f64::INFINITY },
            sigma_others_known: sigma(projection.norm),
            relative_error: if sight == Sight::Seen { projection.relative_error } else { 0.0 },
            sight,
            dropped: projection.dropped.iter().filter_map(|&i| others.get(i).copied()).collect(),
        };
        (precision, projection, scales)
    }
}
