//! What priors do: the hybrid Cramér–Rao bound, and how often a decision between two classes is right on average over
//! them.
//!
//! **Decisions.** Two equally likely materials, the state θ of either drawn from its own prior: Gaussian about the nominal
//! state, cut at its range and renormalised. The best test, of the ratio of the two mixtures E_θ[p(n | θ)], is right with
//! P* = ½ + ½ TV. It is bounded from both sides, by averages over lattices of states that meet as these grow (`mixture`): a
//! test that is told which lattice the states lie on is right at least as often, one that knows another lattice no more often.
//! Either has its numerical error, three deviations, added on the safe side. Photons likewise: fewer than the lower number
//! are not enough for any test, the upper number is enough for one.
//!
//! * What is unknown and has no prior is the adversary's: in the alternative it may be anything, whatever the rest of the
//!   state, and is taken nearest to the target's state with the same θ. That bounds every test; what one reaches against all
//!   of it is not known, and has no lower bound here.
//! * Counts are normal, with noise that does not change along a small step; below 300 photons in all, where that fails, the
//!   limit is the rigorous ½(1 + √(1 − ρ²)) of states with the same θ, and the lower bound is not given.
//! * Without priors, or with priors so narrow that all is known, P* = Φ(d).
//!
//! **Estimates.** Nuisances θ with a Gaussian prior are random, the material fraction g and nuisances without a prior are
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
//!   is inverted, so that d_B² is at least the mean of the local d² over the prior.
//!
//! Its average is over lattices of states within 7σ_p and the range; of a single prior over a product rule,
//! Gauss–Legendre on either side of the mean, so that a kink there, as at equilibrium, costs nothing.
//!
//! Sources: decisions, design of the project; hybrid bound: van Trees, 'Detection, Estimation, and Modulation Theory', part I
//! (1968), section 2.4; Rockah and Schultheiss, IEEE Trans. Acoust. Speech Signal Process. 35, 286 (1987); Messer, 'The hybrid
//! Cramér–Rao lower bound: from practice to theory', IEEE SAM (2006). Equilibrium singularity: paper, SII
//! A.

mod cells;
mod mixture;
mod prior;
mod stack;

use self::mixture::{Missed, Mixtures, Scene};
use self::prior::Node;
pub use self::prior::{Lattice, PriorSpace};
pub use self::stack::{BayesianDistance, Pair};
use self::stack::{MAX_STACK, Stack};
use super::detection;
use super::nearest::StateRange;
use crate::error::{Error, Result, check};
use crate::fisher::{Counting, Unknowns};
use crate::root::crossing_between;
use crate::scene::{Jacobian, Surroundings};
use crate::spectrum::Bands;
use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;
use std::cell::RefCell;

/// Photon numbers between e^−69 and e^69 are searched, 10⁻³⁰ to 10³⁰; from 10⁶ on.
const LOG_PHOTONS: f64 = 69.0;
/// See [`LOG_PHOTONS`].
const FIRST_LOG_PHOTONS: f64 = 13.8;
/// To what share photons are found, and how much more than the least that may do is looked at, in ln N.
const PHOTONS_APART: f64 = 0.01;
/// See [`PHOTONS_APART`].
const FARTHEST: f64 = 9.2;
/// Fewer photons than this in all have no normal law.
const FEW_PHOTONS: f64 = 300.0;
/// States of each lattice of a class, try by try; the last with one prior or two, the first two where something has none.
const LATTICES: [usize; 3] = [128, 512, 2048];
/// See [`LATTICES`].
const MANY_AXES: usize = 2;
/// See [`LATTICES`].
const LATTICES_OF_NEAREST: [usize; 2] = [64, 256];
/// States of each lattice and their number, and order of the product rule of a single prior, of the hybrid bound.
const HYBRID_STATES: usize = 64;
/// See [`HYBRID_STATES`].
const HYBRID_LATTICES: usize = 8;
/// See [`HYBRID_STATES`].
const HYBRID_ORDER: usize = 32;

/// How often decisions are right at best, averaged over two classes and the priors of their states, bounded from both sides.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct AverageProbability {
    /// A test is right at least so often; `None` where that is not known: a nuisance without a prior, or few photons.
    pub lower: Option<f64>,
    /// No test is right more often.
    pub upper: f64,
    /// Number of states of each class that represent its priors.
    pub states: usize,
}

/// Photons of the nominal state at which decisions are right as often as required, bounded from both sides.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct AveragePhotons {
    /// Fewer are not enough for any test.
    pub lower: f64,
    /// This number of photons is enough for a test; none where no such number is known.
    pub upper: Option<f64>,
    /// Number of states of each class that represent its priors.
    pub states: usize,
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
    range: StateRange,
    order: Option<usize>,
}

impl<'a> BayesianBound<'a> {
    /// Bounds for `unknowns`, whose priors are centred at the nominal state of each call.
    #[must_use]
    pub fn new(bands: &'a Bands, surroundings: &'a Surroundings, unknowns: Unknowns) -> Self {
        Self { bands, surroundings, unknowns, range: StateRange::default(), order: None }
    }

    /// The same with the alternative's state within `range`.
    #[must_use]
    pub fn within(self, range: StateRange) -> Self {
        Self { range, ..self }
    }

    /// The same with the hybrid bound by a product rule with `order` nodes on either side of the mean of each prior, instead of
    /// by lattices.
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

    /// How often decisions between the two classes are right at best, with counts as `counting` makes them.
    ///
    /// # Errors
    /// A scene without photons; a prior outside the alternative's range; counts or noise that are impossible.
    pub fn average_probability(&self, pair: Pair<'_>, counting: &Counting) -> Result<AverageProbability> {
        counting.check(self.bands.len())?;
        let photons = self.photon_radiance(pair)? * counting.counts_per_radiance;
        self.for_scene(pair, |scene, tries| {
            let mut found = None;
            for &points in tries {
                let mixtures = Mixtures::new(scene, counting, points)?;
                let miss = mixtures.missed(1.0);
                let [few, error] = mixtures.least_of_few(1.0);
                let least = if photons < FEW_PHOTONS { few - error } else { miss.least - miss.errors[0] };
                let reached = miss.reached.filter(|_| photons >= FEW_PHOTONS * (1.0 - 1e-9));
                let lower = reached.map(|reached| (1.0 - reached - miss.errors[1]).max(0.5));
                let upper = 1.0 - least.clamp(0.0, 0.5);
                found = Some(AverageProbability { lower, upper, states: mixtures.states() });
                if miss.is_settled() {
                    break;
                }
            }
            found.ok_or_else(nothing)
        })
    }

    /// Photons of the nominal state at which decisions between the two classes are right with `probability`, in (½, 1), in
    /// shot noise; `None` if no number suffices. `progress` is told how many lattices of how many were looked at.
    ///
    /// # Errors
    /// As [`BayesianBound::average_probability`], or a probability outside (½, 1).
    pub fn photons_for_average(
        &self,
        pair: Pair<'_>,
        probability: f64,
        progress: &dyn Fn(usize, usize),
    ) -> Result<Option<AveragePhotons>> {
        detection::distance_for_probability(probability)?;
        let counting =
            Counting { counts_per_radiance: 1.0 / self.photon_radiance(pair)?, var_added: Vec::new() };
        let wrong = 1.0 - probability;
        self.for_scene(pair, |scene, tries| {
            let few_log = FEW_PHOTONS.ln();
            let (mut lower, mut upper, mut states) = (-LOG_PHOTONS, None, 0);
            let (mut start, mut step) = ([FIRST_LOG_PHOTONS; 2], 0.7);
            for (i, &points) in tries.iter().enumerate() {
                let mixtures = Mixtures::new(scene, &counting, points)?;
                let looked = RefCell::new(Vec::<(f64, Missed)>::new());
                let at = |log: f64| {
                    if let Some((_, miss)) =
                        looked.borrow().iter().find(|(before, _)| before.to_bits() == log.to_bits())
                    {
                        return *miss;
                    }
                    let miss = mixtures.missed((0.5 * log).exp());
                    looked.borrow_mut().push((log, miss));
                    miss
                };
                let limit = around(start[0], step, LOG_PHOTONS, |log| {
                    let miss = at(log);
                    wrong - (miss.least - miss.errors[0])
                });
                if limit.above.is_none() {
                    return Ok(None);
                }
                let mut below = limit.below.unwrap_or(-LOG_PHOTONS);
                start[0] = below;
                let settled = at(below).is_settled();
                if below < few_log {
                    let few = around(below, step, few_log, |log| {
                        let [miss, error] = mixtures.least_of_few((0.5 * log).exp());
                        wrong - (miss - error)
                    });
                    below = below.min(few.below.unwrap_or(-LOG_PHOTONS));
                }
                lower = lower.max(below);
                let least = start[0].max(few_log);
                let reached =
                    around(if i == 0 { least } else { start[1].max(least) }, step, least + FARTHEST, |log| {
                        let miss = at(log);
                        miss.reached.map_or(-1.0, |reached| wrong - (reached + miss.errors[1]))
                    });
                if let Some(above) = reached.above {
                    start[1] = above;
                    let above = above.max(few_log);
                    upper = Some(upper.map_or(above, |upper: f64| upper.min(above)));
                }
                states = mixtures.states();
                progress(i + 1, tries.len());
                if settled && (upper.is_some() || !scene.free.nuisances().is_empty()) {
                    break;
                }
                step = 0.05;
            }
            Ok(Some(AveragePhotons {
                lower: lower.exp(),
                upper: upper.map(|upper| upper.max(lower).exp()),
                states,
            }))
        })
    }

    /// Asks `of` about the two classes, with the lattices to be tried.
    fn for_scene<T>(&self, pair: Pair<'_>, of: impl FnOnce(Scene<'_>, &[usize]) -> Result<T>) -> Result<T> {
        let objects = self.surroundings.objects().len();
        let total = self.unknowns.known_lighting_total();
        let free = Unknowns::new(self.unknowns.without_prior(objects))?.lighting_total(total)?;
        let own = PriorSpace::new(&self.unknowns, pair.state, &StateRange::default())?;
        let priors = [own, PriorSpace::new(&self.unknowns, pair.state, &self.range)?];
        let scene = Scene {
            bands: self.bands,
            surroundings: self.surroundings,
            pair,
            priors: &priors,
            free: &free,
            range: self.range,
            total_known: total.is_some(),
        };
        match (priors[0].axes(), free.nuisances().is_empty()) {
            (0, _) => of(scene, &[1]),
            (axes, true) => of(scene, &LATTICES[..if axes > MANY_AXES { 2 } else { 3 }]),
            (_, false) => of(scene, &LATTICES_OF_NEAREST),
        }
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
        let space = PriorSpace::new(&self.unknowns, pair.state, &StateRange::default())?;
        let order = match self.order {
            None if space.axes() > 1 => None,
            order => Some(order.unwrap_or(HYBRID_ORDER)),
        };
        let [fine, coarse] = if let Some(order) = order {
            [order, order / 2].map(|order| space.product(order, most))
        } else {
            let states = HYBRID_STATES.min(most / HYBRID_LATTICES).max(1);
            let lattices = space.lattices(HYBRID_LATTICES, states, &mut ChaCha8Rng::seed_from_u64(20))?;
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

fn nothing() -> Error {
    Error::malformed("an average over no states", "report this as a bug")
}

/// The last point found below the crossing of an increasing function, and the first above it.
#[derive(Debug, Clone, Copy, Default)]
struct Ends {
    below: Option<f64>,
    above: Option<f64>,
}

/// Encloses where `of` crosses zero between −[`LOG_PHOTONS`] and `most` to [`PHOTONS_APART`], from `start` on by ever longer
/// steps.
fn around(start: f64, mut step: f64, most: f64, of: impl Fn(f64) -> f64) -> Ends {
    let (mut x, mut below, mut above) = (start.min(most), None, None);
    let (below, above) = loop {
        let value = of(x);
        let next = if value < 0.0 {
            below = Some((x, value));
            (x + step).min(most)
        } else {
            above = Some((x, value));
            (x - step).max(-LOG_PHOTONS)
        };
        if let (Some(below), Some(above)) = (below, above) {
            break (below, above);
        }
        if next == x {
            return Ends { below: below.map(|end| end.0), above: above.map(|end| end.0) };
        }
        x = next;
        step *= 2.0;
    };
    let (mut below, mut above) = (below, above);
    while above.0 - below.0 > PHOTONS_APART {
        let root = below.0 + (above.0 - below.0) * below.1 / (below.1 - above.1);
        // To the other side of where it is likely, seen from the end that is farther.
        let beyond = if root - below.0 > above.0 - root {
            root - 0.4 * PHOTONS_APART
        } else {
            root + 0.4 * PHOTONS_APART
        };
        let margin = 0.05 * (above.0 - below.0);
        let x = beyond.clamp(below.0 + margin, above.0 - margin);
        let value = of(x);
        if value < 0.0 { below = (x, value) } else { above = (x, value) }
    }
    Ends { below: Some(below.0), above: Some(above.0) }
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
