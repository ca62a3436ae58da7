//! The state of a material that explains given counts best: maximum likelihood within the physical range.
//!
//! Counts n_w of band w scatter about N_w = κS_w(θ) by a law of [`Statistics`], κ counts per unit of band signal; θ are
//! the material's free parameters (T, V, ln gain, Tₖ: those that are unknown). Minimised is −ln L + ½Σ((θ − θ₀)/σ_p)²,
//! the sum over the parameters that have a prior, θ₀ their known value; without priors it is plain maximum likelihood.
//!
//! From each start Newton's steps within the range (`space`), with the exact second derivatives where these are
//! positive definite and the Fisher matrix elsewhere (scoring). Temperature and lighting are often nearly degenerate,
//! and the likelihood a narrow ridge that bends: a step that leaves it is led back by a second one with T held, which
//! needs no new radiances, and shortened if that does not help. It ends when what another step may gain in ln L is
//! below [`GAIN`], which no decision between materials can feel.
//!
//! ln L is counted from a value that depends on the counts alone (`terms`), so that two materials fitted to the same
//! counts can be compared however many photons there are.
//!
//! Source: Fisher scoring as in McCullagh and Nelder, 'Generalized Linear Models' (1989), section 2.5.

mod quadratic;
mod terms;

pub(crate) use self::terms::Terms;

use self::quadratic::{Scratch, quadratic};
use super::nearest::StateRange;
use super::space::{Quadratic, StateSpace, set, value};
use crate::aligned::Aligned;
use crate::error::{Result, check};
use crate::few::Few;
use crate::fisher::Unknowns;
use crate::scene::{Jacobian, Parameter, State, Surroundings};
use crate::spectrum::Bands;
use crate::statistics::Statistics;

/// A fit ends when another step is expected to raise ln L by less than this.
pub const GAIN: f64 = 1e-9;
/// Share of ln L itself that rounding may hide.
const ROUNDING: f64 = 1e-14;
/// Iterations from one start.
const ITERATIONS: usize = 80;
/// A step and parts of it that are tried, each a share of the one before, and the share of the expected gain that is
/// enough at once.
const SHARES: [f64; 5] = [1.0, 0.3, 0.3, 0.3, 0.1];
const SUFFICIENT: f64 = 0.3;
/// Damping for a singular matrix, for one whose steps do not go down, and where no step is worth trying.
const SINGULAR: f64 = 1e-12;
const UPHILL: f64 = 1e-3;
const HOPELESS: f64 = 1e12;

/// The best state of one material.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// ln L, less a term of the counts alone: 0 where every mean equals its count (Poisson, negative binomial without
    /// priors), or as in [`Statistics::log_likelihood`] (Gaussian).
    pub log_likelihood: f64,
    /// Where it is reached.
    pub state: State,
    /// Whether no step would have raised it any more.
    pub converged: bool,
    /// Iterations from all starts together.
    pub iterations: usize,
}

/// Fits states in fixed bands and surroundings.
///
/// ```
/// use hadar::fisher::{Nuisance, Unknowns};
/// use hadar::identifiability::likelihood::MaximumLikelihood;
/// use hadar::identifiability::nearest::StateRange;
/// use hadar::scene::{EnvironmentObject, Surroundings};
/// use hadar::spectrum::Bands;
/// use hadar::statistics::Statistics;
///
/// let bands = Bands::uniform(720.0, 1250.0, 10.0)?;
/// let ambient = EnvironmentObject { temperature_k: 293.15, emissivity: None };
/// let surroundings = Surroundings::new(bands.nodes_cm1(), vec![ambient])?;
/// let skin = vec![0.95; bands.len()];
/// let truth = surroundings.state(310.15, &[0.5])?;
/// // Counts without any scatter are explained best by the truth.
/// let counts: Vec<f64> = bands.weigh(&surroundings.signal(&skin, &truth)).iter().map(|s| 1e-17 * s).collect();
/// let unknowns = Unknowns::new([Nuisance::Temperature])?;
/// let range = StateRange::default();
/// let mut fits = MaximumLikelihood::new(&bands, &surroundings, unknowns, range, 1e-17, Statistics::Poisson)?;
/// let fit = fits.fit(&skin, &counts, &truth, &[surroundings.state(290.0, &[0.5])?]);
/// assert!(fit.converged && (fit.state.temperature_k - 310.15).abs() < 1e-3);
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct MaximumLikelihood<'a> {
    space: StateSpace,
    /// Whether temperature is free beside something else.
    bends: bool,
    surface: Jacobian<'a>,
    statistics: Statistics,
    counts_per_radiance: f64,
    terms: Terms,
    scratch: Scratch,
}

impl<'a> MaximumLikelihood<'a> {
    /// Fits for one set of bands, surroundings, unknowns and ranges; `counts_per_radiance` is κ, m² sr s.
    ///
    /// # Errors
    /// κ not above 0, or statistics for another number of bands.
    pub fn new(
        bands: &'a Bands,
        surroundings: &'a Surroundings,
        unknowns: Unknowns,
        range: StateRange,
        counts_per_radiance: f64,
        statistics: Statistics,
    ) -> Result<Self> {
        check::positive("counts per unit of band signal", counts_per_radiance, "m^2 sr s")?;
        statistics.check_bands(bands.len())?;
        let space = StateSpace::new(unknowns, range, surroundings.objects().len());
        Ok(Self {
            bends: space.parameters.len() > 1 && space.parameters.contains(&Parameter::Temperature),
            space,
            surface: Jacobian::new(bands, surroundings),
            statistics,
            counts_per_radiance,
            terms: Terms::new(bands.len()),
            scratch: Scratch {
                node: Aligned::zeros(surroundings.nodes_cm1().len()),
                band: Aligned::zeros(bands.len()),
            },
        })
    }

    /// The best of the fits from every one of `starts` (from `known` if there are none) of a material of
    /// `emissivity` (at the nodes) to `counts` (of each band). What is not unknown has its value in `known`, which
    /// is also the centre of priors.
    pub fn fit(&mut self, emissivity: &[f64], counts: &[f64], known: &State, starts: &[State]) -> Fit {
        let task = Task { emissivity, counts, known };
        let (first, others) = starts.split_first().map_or((known, starts), |(first, others)| (first, others));
        let mut best = self.climb(&task, first);
        for start in others {
            let fit = self.climb(&task, start);
            let iterations = best.iterations + fit.iterations;
            if fit.log_likelihood > best.log_likelihood {
                best = fit;
            }
            best.iterations = iterations;
        }
        best
    }

    /// Newton's method within the bounds.
    fn climb(&mut self, task: &Task<'_>, start: &State) -> Fit {
        let mut state = task.known.clone();
        for parameter in &self.space.parameters {
            set(&mut state, *parameter, value(start, *parameter));
        }
        state = self.space.within_range(&state);
        let mut loss = self.loss(task, &state);
        let (mut damping, mut iterations, mut converged) = (0.0, 0, self.space.parameters.is_empty());
        let mut at = self.quadratic(task, &state);
        while !converged && iterations < ITERATIONS && damping < HOPELESS {
            iterations += 1;
            let Some(step) = self.space.step(&at, &state, damping, false) else {
                damping = (100.0 * damping).max(SINGULAR);
                continue;
            };
            // At least this much by the quadratic model, and at most twice as much.
            let gain = -0.5 * at.gradient.dot(&step);
            let enough = ROUNDING.mul_add(loss.abs(), GAIN);
            converged = gain < enough;
            if converged {
                break;
            }
            match self.search(task, (&state, loss), step, gain) {
                Some(found) => (state, loss, at) = found,
                // Rounding decides whether so small a step goes down.
                None if gain < 1e3 * enough => converged = true,
                None => damping = (100.0 * damping).max(UPHILL),
            }
        }
        Fit { log_likelihood: -loss, state, converged, iterations }
    }

    /// A lower place along a step, the loss there and the loss to second order.
    fn search(
        &mut self,
        task: &Task<'_>,
        (state, loss): (&State, f64),
        mut step: Few,
        gain: f64,
    ) -> Option<(State, f64, Quadratic)> {
        for share in SHARES {
            step.iter_mut().for_each(|change| *change *= share);
            let moved = self.space.moved(state, &step);
            let next = self.loss(task, &moved);
            if next < loss - SUFFICIENT * gain {
                let at = self.quadratic(task, &moved);
                return Some((moved, next, at));
            }
            // The step has left a narrow valley that bends: back into it with T held.
            if self.bends {
                let at = self.quadratic(task, &moved);
                let back = self.space.step(&at, &moved, 0.0, true);
                let inside = back.map_or_else(|| moved.clone(), |back| self.space.moved(&moved, &back));
                let next = self.loss(task, &inside);
                if next < loss {
                    let at = self.quadratic(task, &inside);
                    return Some((inside, next, at));
                }
            } else if next < loss {
                let at = self.quadratic(task, &moved);
                return Some((moved, next, at));
            }
        }
        None
    }

    /// What is minimised, at a state.
    fn loss(&mut self, task: &Task<'_>, state: &State) -> f64 {
        crate::stop::check();
        let total_known = self.space.unknowns.known_lighting_total().is_some();
        let (e, parameters) = (task.emissivity, &self.space.parameters);
        self.surface.evaluate(e, e, state, parameters, total_known);
        let signal = self.surface.signal();
        let bands = self.terms.evaluate(&self.statistics, self.counts_per_radiance, signal, task.counts);
        bands + self.priors(task, state).map(|(_, off, sigma)| 0.5 * (off / sigma).powi(2)).sum::<f64>()
    }

    /// It to second order, at the state of the last [`Self::loss`].
    fn quadratic(&mut self, task: &Task<'_>, state: &State) -> Quadratic {
        crate::stop::check();
        let mut at = quadratic(&self.surface, task.emissivity, state, &self.terms, &mut self.scratch);
        for (i, off, sigma) in self.priors(task, state) {
            at.gradient[i] += off / (sigma * sigma);
            at.gauss_newton[(i, i)] += 1.0 / (sigma * sigma);
            at.hessian[(i, i)] += 1.0 / (sigma * sigma);
        }
        at
    }

    /// (index, θ − θ₀, σ_p) of every parameter with a prior.
    fn priors(&self, task: &Task<'_>, state: &State) -> impl Iterator<Item = (usize, f64, f64)> {
        let row = |(i, parameter): (usize, &Parameter)| {
            let sigma = self.space.unknowns.sigma_prior(*parameter)?;
            Some((i, value(state, *parameter) - value(task.known, *parameter), sigma))
        };
        let rows: Vec<_> = self.space.parameters.iter().enumerate().filter_map(row).collect();
        rows.into_iter()
    }
}

/// What is fitted.
struct Task<'t> {
    emissivity: &'t [f64],
    counts: &'t [f64],
    known: &'t State,
}

#[cfg(test)]
mod tests;
