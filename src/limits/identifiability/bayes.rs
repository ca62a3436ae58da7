//! What priors do: the hybrid Cramér–Rao bound, and the detection probability averaged over a prior.
//!
//! Nuisances θ with a Gaussian prior are random, the material fraction g and nuisances without a prior are
//! not. The information about both, per photon of the nominal state, is
//!
//! J_H = Σ_k w_k Σ_w ∂S_w(θ_k) ∂S_w(θ_k)ᵀ/[S_w(θ_k) ΣS(θ₀)] + diag(1/(N σ_p²)),
//!
//! the Fisher matrix averaged over the prior of the target's state (nodes θ_k, weights w_k, nominal state
//! θ₀) plus the prior's own precision, σ_p the deviations, N the photons. No unbiased estimate of g has a
//! variance below [J_H⁻¹]_gg/N, and d_B = ½/√[J_H⁻¹]_gg is the distance per √photon that goes with it. J_H
//! is never formed: the columns of all nodes stand under each other, weighted by w_k, with one row more per
//! prior, and the material's is projected off the others ([`crate::fisher`]).
//!
//! * Without priors, or with priors so narrow that a parameter is known, d_B is the local distance.
//! * At thermal equilibrium (T = T₀, V = 1) the local distance is 0, for any number of photons. With a
//!   prior of deviation σ_T the target is a little off equilibrium nearly always, ∂S/∂g ∝ T − T₀, so
//!   d_B ∝ σ_T and the photons needed ∝ 1/σ_T²: large but finite.
//! * It bounds estimates of g, not decisions, and is optimistic as a bound: information is averaged before it
//!   is inverted, so that d_B² is at least the mean of the local d² over the prior. The other average says what
//!   a user will see: P̄(N) = E[Φ(d(θ))], d the local or nearest statistical distance of each state. Near equilibrium d = c|T − T₀| and P̄ = ½ +
//!   arctan(cσ_T)/π.
//!
//! Averages: Gauss–Legendre on either side of the mean, within 7σ_p and the physical range (T > 0, 0 ≤ V,
//! ΣV ≤ 1), so that a kink at the mean, as at equilibrium, costs nothing. The prior is truncated to that
//! range and renormalised, not reflected. Where several lighting factors have a prior, nodes of the product
//! rule with ΣV > 1 are left out, which converges slowly; every result tells its change from a rule of half
//! the order.
//!
//! Sources: van Trees, 'Detection, Estimation, and Modulation Theory', part I (1968), section 2.4; Rockah
//! and Schultheiss, IEEE Trans. Acoust. Speech Signal Process. 35, 286 (1987); Messer, 'The hybrid
//! Cramér–Rao lower bound: from practice to theory', IEEE SAM (2006). Equilibrium singularity: paper, SII
//! A.

mod prior;
mod stack;

use self::prior::Node;
pub use self::stack::{BayesianDistance, Pair};
use self::stack::{MAX_STACK, Stack};
use super::detection;
use super::local::LocalSolver;
use super::nearest::{NearestSolver, StateRange};
use crate::error::{Error, Result, check};
use crate::fisher::{Counting, Unknowns};
use crate::root::crossing;
use crate::scene::{Jacobian, State, Surroundings};
use crate::spectrum::Bands;
use crate::sum::Compensated;
use rayon::prelude::*;

/// Photon numbers between e^−69 and e^69 are searched, 10⁻³⁰ to 10³⁰.
const LOG_PHOTONS: f64 = 69.0;

/// The detection probability averaged over the prior.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct AverageProbability {
    /// P̄ = E[Φ(d)].
    pub probability: f64,
    /// 1 − P̄, to full relative precision.
    pub miss_probability: f64,
    /// Nodes of the average.
    pub nodes: usize,
    /// Change of P̄ from a rule of half the order.
    pub quadrature_change: f64,
}

/// Which distance of a state its detection probability is taken from. A prior counts in it as one more
/// reading, centred at that state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Distances {
    /// The paper's local distance.
    Local,
    /// The nearest distance, over this range of the alternative's state.
    Nearest(StateRange),
}

/// Bounds with priors in fixed bands, surroundings and unknowns.
///
/// ```
/// use hadar::fisher::{Nuisance, Unknowns};
/// use hadar::identifiability::bayes::{BayesianBound, Pair};
/// use hadar::scene::{EnvironmentObject, Surroundings};
/// use hadar::spectrum::Bands;
///
/// // A closed room: everything at one temperature, known to 2 K.
/// let bands = Bands::uniform(750.0, 1250.0, 10.0)?;
/// let wall = EnvironmentObject { temperature_k: 293.15, emissivity: None };
/// let surroundings = Surroundings::new(bands.nodes_cm1(), vec![wall])?;
/// let (skin, fabric) = (vec![0.95; bands.len()], vec![0.88; bands.len()]);
/// let state = surroundings.state(293.15, &[1.0])?;
/// let unknowns = Unknowns::new([Nuisance::Temperature])?.prior(Nuisance::Temperature, 2.0)?;
/// let pair = Pair { emissivity: &skin, alternative: &fabric, state: &state };
/// let bound = BayesianBound::new(&bands, &surroundings, unknowns);
/// let photons = bound.photons_required(pair, 1.0)?;
/// assert!(photons.is_some_and(|photons| photons > 1e4 && photons < 1e12));
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct BayesianBound<'a> {
    bands: &'a Bands,
    surroundings: &'a Surroundings,
    unknowns: Unknowns,
    order: Option<usize>,
}

impl<'a> BayesianBound<'a> {
    /// Bounds for `unknowns`, whose priors are centred at the nominal state of each call.
    #[must_use]
    pub fn new(bands: &'a Bands, surroundings: &'a Surroundings, unknowns: Unknowns) -> Self {
        Self { bands, surroundings, unknowns, order: None }
    }

    /// The same with `order` nodes on either side of the mean of each prior. Where silent it is 32 for one
    /// parameter with a prior, 16 for two, 8 for three and 4 for more.
    ///
    /// # Errors
    /// An order below 2 or above 512.
    pub fn with_order(self, order: usize) -> Result<Self> {
        if !(2..=512).contains(&order) {
            return Err(Error::out_of_range(
                "order of the average over a prior",
                order as f64,
                "",
                "2 to 512",
            ));
        }
        Ok(Self { order: Some(order), ..self })
    }

    /// d_B per √photon when the nominal state sends `photons`; infinitely many leave the prior's own
    /// precision out, but not the average.
    ///
    /// # Errors
    /// A scene without photons, photons that are not positive, or more nodes than can be held.
    pub fn distance(&self, pair: Pair<'_>, photons: f64) -> Result<BayesianDistance> {
        if photons.is_nan() || photons <= 0.0 {
            return Err(Error::out_of_range("photons", photons, "counts", "above 0"));
        }
        let order = self.order(pair.state);
        let fine = self.stack(pair, order)?.project(photons);
        let coarse = self.stack(pair, order / 2)?.project(photons);
        let change = (fine.distance - coarse.distance).abs();
        let quadrature_change = if change > 0.0 { change / fine.distance } else { 0.0 };
        Ok(BayesianDistance { quadrature_change, ..fine })
    }

    /// Photons of the nominal state for √N d_B(N) = `required`; `None` if no number suffices.
    ///
    /// # Errors
    /// As [`BayesianBound::distance`], or a requirement that is not positive.
    pub fn photons_required(&self, pair: Pair<'_>, required: f64) -> Result<Option<f64>> {
        check::positive("required statistical distance", required, "")?;
        let stack = self.stack(pair, self.order(pair.state))?;
        photons_where(|photons| Ok(photons.sqrt() * stack.project(photons).distance - required))
    }

    /// P̄ when the nominal state sends `photons`, at the same exposure for all states.
    ///
    /// # Errors
    /// As [`BayesianBound::distance`] and the solver of the distances.
    pub fn average_probability(
        &self,
        pair: Pair<'_>,
        photons: f64,
        distances: Distances,
    ) -> Result<AverageProbability> {
        check::positive("photons", photons, "counts")?;
        let order = self.order(pair.state);
        let (miss, nodes) = self.average_miss(pair, photons, distances, order)?;
        let (coarse, _) = self.average_miss(pair, photons, distances, order / 2)?;
        Ok(AverageProbability {
            probability: 1.0 - miss,
            miss_probability: miss,
            nodes,
            quadrature_change: (miss - coarse).abs(),
        })
    }

    /// Photons of the nominal state at which P̄ is `probability`, in (½, 1); `None` if no number suffices.
    ///
    /// # Errors
    /// As [`BayesianBound::average_probability`], or a probability outside (½, 1).
    pub fn photons_for_average(
        &self,
        pair: Pair<'_>,
        probability: f64,
        distances: Distances,
    ) -> Result<Option<f64>> {
        detection::distance_for_probability(probability)?;
        let order = self.order(pair.state);
        photons_where(|photons| {
            let (miss, _) = self.average_miss(pair, photons, distances, order)?;
            Ok((1.0 - probability) - miss)
        })
    }

    fn order(&self, state: &State) -> usize {
        let parameters = self.unknowns.parameters(state.lighting.len());
        let priors = parameters.iter().filter(|&&p| self.unknowns.sigma_prior(p).is_some()).count();
        self.order.unwrap_or(match priors {
            0 | 1 => 32,
            2 => 16,
            3 => 8,
            _ => 4,
        })
    }

    fn average_miss(
        &self,
        pair: Pair<'_>,
        photons: f64,
        distances: Distances,
        order: usize,
    ) -> Result<(f64, usize)> {
        let nodes = prior::nodes(&self.unknowns, pair.state, order, MAX_STACK)?;
        let total = self.photon_radiance(pair)?;
        let counting = Counting { counts_per_radiance: photons / total, var_added: Vec::new() };
        let (own, other) = (pair.emissivity, pair.alternative);
        let found: Result<Vec<f64>> = match distances {
            Distances::Local => nodes
                .par_iter()
                .map_init(
                    || LocalSolver::new(self.bands, self.surroundings, self.unknowns.clone()),
                    |solver, node| Ok(solver.with_counting(own, other, &node.state, &counting)?.distance),
                )
                .collect(),
            Distances::Nearest(range) => nodes
                .par_iter()
                .map_init(
                    || NearestSolver::new(self.bands, self.surroundings, self.unknowns.clone(), range),
                    |solver, node| Ok(solver.with_counting(own, other, &node.state, &counting)?.distance),
                )
                .collect(),
        };
        // In the order of the nodes, so that the number of threads changes no bit.
        let mut sum = Compensated::default();
        for (Node { weight, .. }, distance) in nodes.iter().zip(found?) {
            sum.add(weight * detection::miss_probability(distance));
        }
        Ok((sum.value(), nodes.len()))
    }

    /// ΣS of the nominal state.
    fn photon_radiance(&self, pair: Pair<'_>) -> Result<f64> {
        let mut jacobian = Jacobian::new(self.bands, self.surroundings);
        jacobian.evaluate(pair.emissivity, pair.alternative, pair.state, &[], false);
        let total = crate::sum::sum(jacobian.signal());
        // Squares of what is beyond would not be numbers.
        if (1e-100..1e100).contains(&total) {
            return Ok(total);
        }
        Err(Error::out_of_range(
            "photon radiance of the target",
            total,
            "photons s^-1 m^-2 sr^-1",
            "within 1e-100 to 1e100: a warmer scene, or bands at lower wavenumbers",
        ))
    }

    fn stack(&self, pair: Pair<'_>, order: usize) -> Result<Stack> {
        let total = self.photon_radiance(pair)?;
        Stack::new(self.bands, self.surroundings, &self.unknowns, pair, total, order)
    }
}

/// Where an increasing function of the photons crosses zero; `None` if it does not.
fn photons_where(mut excess: impl FnMut(f64) -> Result<f64>) -> Result<Option<f64>> {
    let mut at = |log: f64| excess(log.exp());
    if at(LOG_PHOTONS)? < 0.0 {
        return Ok(None);
    }
    if at(-LOG_PHOTONS)? >= 0.0 {
        return Ok(Some((-LOG_PHOTONS).exp()));
    }
    crossing(-LOG_PHOTONS, LOG_PHOTONS, at).map(|log| Some(log.exp()))
}

#[cfg(test)]
mod tests;
