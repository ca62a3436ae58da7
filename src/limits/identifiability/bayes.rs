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
//! Averages: lattices of states within 7σ_p and the physical range (T > 0, 0 ≤ V, ΣV ≤ 1), whose number does not
//! multiply with the priors, doubled until the error of their mean is no more than is asked for (10⁻³ of a probability
//! where silent): three deviations by the scatter of the lattices, and for what may stand between n states, which is
//! about 1/n of the prior and off by ¼ in the mean, 1/(4n). The prior is truncated to that range and renormalised, not
//! reflected. An order asked for is that of a product rule, and so is the hybrid bound of a single prior:
//! Gauss–Legendre on either side of the mean, so that a kink there, as at equilibrium, costs nothing.
//!
//! Photons for an average: d(θ, N) of every state is √N times what hardly depends on N, so that the distances found at one
//! N tell P̄ at all N but for what the priors' weight among the photons changes. Each step finds N from the distances of
//! the last.
//!
//! Sources: van Trees, 'Detection, Estimation, and Modulation Theory', part I (1968), section 2.4; Rockah
//! and Schultheiss, IEEE Trans. Acoust. Speech Signal Process. 35, 286 (1987); Messer, 'The hybrid
//! Cramér–Rao lower bound: from practice to theory', IEEE SAM (2006). Equilibrium singularity: paper, SII
//! A.

mod average;
mod prior;
mod stack;

pub use self::average::Distances;
use self::average::{Average, LOG_PHOTONS, States};
use self::prior::Node;
pub use self::stack::{BayesianDistance, Pair};
use self::stack::{MAX_STACK, Stack};
use super::detection;
use crate::error::{Error, Result, check};
use crate::fisher::Unknowns;
use crate::root::crossing_between;
use crate::scene::{Jacobian, Surroundings};
use crate::spectrum::Bands;

/// Where the search for photons begins: 10⁶.
const FIRST_LOG_PHOTONS: f64 = 13.8;
/// Error of an averaged probability where none is asked for.
const TOLERANCE: f64 = 1e-3;
/// States of each lattice, try by try: few to be near the photons that are sought, then as many as an error of 10⁻³ takes.
const LATTICES: [usize; 7] = [8, 64, 128, 256, 512, 1024, 2048];
/// States of each lattice, and order of the product rule of a single prior, of the hybrid bound.
const HYBRID_STATES: usize = 64;
const HYBRID_ORDER: usize = 32;

/// The detection probability averaged over the prior.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct AverageProbability {
    /// P̄ = E[Φ(d)].
    pub probability: f64,
    /// 1 − P̄, to full relative precision.
    pub miss_probability: f64,
    /// States of the average.
    pub nodes: usize,
    /// Three deviations of P̄, by the scatter of its lattices; for a product rule its change from half the order.
    pub error: f64,
}

/// Photons at which an averaged detection probability is reached.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct AveragePhotons {
    /// Photons of the nominal state.
    pub photons: f64,
    /// What the error of the average makes of them.
    pub relative_error: f64,
    /// States of the last average.
    pub nodes: usize,
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
    tolerance: f64,
}

impl<'a> BayesianBound<'a> {
    /// Bounds for `unknowns`, whose priors are centred at the nominal state of each call.
    #[must_use]
    pub fn new(bands: &'a Bands, surroundings: &'a Surroundings, unknowns: Unknowns) -> Self {
        Self { bands, surroundings, unknowns, order: None, tolerance: TOLERANCE }
    }

    /// The same by a product rule with `order` nodes on either side of the mean of each prior, instead of by lattices.
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

    /// The same with averaged probabilities to this error, if 16 384 states suffice for it.
    ///
    /// # Errors
    /// A tolerance that is not positive.
    pub fn with_tolerance(self, tolerance: f64) -> Result<Self> {
        Ok(Self { tolerance: check::positive("error of an averaged probability", tolerance, "")?, ..self })
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
        let [fine, coarse] = self.stacks(pair)?.map(|stack| stack.project(photons));
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
        let [stack, _] = self.stacks(pair)?;
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
        let mut average = self.average(pair, distances, &|_, _| ())?;
        for states in self.tries() {
            average.take(states)?;
            average.look(photons)?;
            if average.error(0.0) <= self.tolerance {
                break;
            }
        }
        let (miss, error) = (average.miss(0.0), average.error(0.0));
        let nodes = average.nodes.len();
        Ok(AverageProbability { probability: 1.0 - miss, miss_probability: miss, nodes, error })
    }

    /// Photons of the nominal state at which P̄ is `probability`, in (½, 1); `None` if no number suffices. `progress` is told
    /// how many states of how many were looked at, as far as is known.
    ///
    /// # Errors
    /// As [`BayesianBound::average_probability`], or a probability outside (½, 1).
    pub fn photons_for_average(
        &self,
        pair: Pair<'_>,
        probability: f64,
        distances: Distances,
        progress: &dyn Fn(usize, usize),
    ) -> Result<Option<AveragePhotons>> {
        detection::distance_for_probability(probability)?;
        let mut average = self.average(pair, distances, progress)?;
        let (mut log, mut found) = (FIRST_LOG_PHOTONS, None);
        for states in self.tries() {
            average.take(states)?;
            // What is left to the steps is nothing beside the error of the average.
            let enough =
                if self.order.is_some() { [1e-13; 2] } else { [0.02 * self.tolerance, 3.0 * self.tolerance] };
            let Some(met) = average.solve(log, 1.0 - probability, enough)? else { return Ok(None) };
            log = met.log;
            let shift = met.shift;
            let error = average.error(shift);
            // dP̄/d ln N.
            let slope = (average.miss(shift - 0.01) - average.miss(shift + 0.01)) / 0.02;
            let relative_error = if error > 0.0 { error / slope } else { 0.0 };
            let nodes = average.nodes.len();
            found = Some(AveragePhotons { photons: log.exp(), relative_error, nodes });
            if error <= self.tolerance {
                break;
            }
        }
        Ok(found)
    }

    /// The averages that are tried one after the other.
    fn tries(&self) -> Vec<States> {
        match self.order {
            Some(order) => vec![States::Product(order)],
            None => LATTICES.map(States::Lattices).to_vec(),
        }
    }

    fn average<'b>(
        &'b self,
        pair: Pair<'b>,
        distances: Distances,
        progress: &'b dyn Fn(usize, usize),
    ) -> Result<Average<'b>> {
        let total = self.photon_radiance(pair)?;
        Ok(Average {
            bands: self.bands,
            surroundings: self.surroundings,
            unknowns: &self.unknowns,
            pair,
            distances,
            progress,
            total,
            nodes: Vec::new(),
            ends: Vec::new(),
            found: Vec::new(),
            looked: 0,
            share: None,
        })
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

    /// The stack of all states, and one of half as many.
    fn stacks(&self, pair: Pair<'_>) -> Result<[Stack; 2]> {
        let total = self.photon_radiance(pair)?;
        let columns = self.unknowns.parameters(self.surroundings.objects().len()).len() + 1;
        let most = MAX_STACK / (self.bands.len() * columns).max(1);
        let order = match self.order {
            None if prior::count(&self.unknowns, pair.state) > 1 => None,
            order => Some(order.unwrap_or(HYBRID_ORDER)),
        };
        let [fine, coarse] = if let Some(order) = order {
            [order, order / 2].map(|order| prior::product(&self.unknowns, pair.state, order, most))
        } else {
            let states = HYBRID_STATES.min(most / prior::SHIFTS).max(1);
            let lattices = prior::lattices(&self.unknowns, pair.state, states)?;
            let half = lattices.len() / 2;
            [&lattices[..], &lattices[..half]].map(|lattices| Ok(pooled(lattices)))
        };
        let stack =
            |nodes: Vec<Node>| Stack::new(self.bands, self.surroundings, &self.unknowns, pair, total, &nodes);
        Ok([stack(fine?)?, stack(coarse?)?])
    }
}

/// All states of some lattices, with weights that add up to 1.
fn pooled(lattices: &[Vec<Node>]) -> Vec<Node> {
    let all: Vec<Node> = lattices.iter().flatten().cloned().collect();
    let weight = 1.0 / all.len().max(1) as f64;
    all.into_iter().map(|node| Node { weight, ..node }).collect()
}

/// Where an increasing function of the photons crosses zero; `None` if it does not.
fn photons_where(mut excess: impl FnMut(f64) -> Result<f64>) -> Result<Option<f64>> {
    let mut at = |log: f64| excess(log.exp());
    let most = at(LOG_PHOTONS)?;
    if most < 0.0 {
        return Ok(None);
    }
    let least = at(-LOG_PHOTONS)?;
    if least >= 0.0 {
        return Ok(Some((-LOG_PHOTONS).exp()));
    }
    crossing_between([-LOG_PHOTONS, least], [LOG_PHOTONS, most], at).map(|log| Some(log.exp()))
}

#[cfg(test)]
mod tests;
