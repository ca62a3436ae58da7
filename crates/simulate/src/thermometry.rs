//! Temperatures read from noisy spectra, by maximum likelihood and as thermal imaging does, by Monte Carlo.
//!
//! A target of known emissivity in a known true state is looked at again and again; every spectrum of counts (N +
//! noise, `draws`) is read by
//!
//! * maximum likelihood over the unknown parameters within their physical range ([`ThermometryScene::fits`]), from a
//!   start that knows the counts alone;
//! * the sum of its counts with a stated emissivity ([`ThermometryScene::readings`], [`Conventional`]).
//!
//! All of them read the same spectra: trial i of a run has the stream of random numbers run·2⁴⁰ + i of its own, whose
//! first draws are the counts. A parameter with a prior has the prior's centre drawn about its true value in every
//! trial, since that is what the bound with a prior is an average over.
//!
//! Assumptions: known emissivity, surroundings' temperature and response, as far as they are not among the unknowns.
//! Photons are drawn exactly (Poisson), electronic noise is normal; likelihoods take their sum for normal of variance
//! N + σ², counts without electronic noise for Poisson.
//!
//! Source: paper, Methods 'HADAR thermography' and Extended Data Fig. 9e, f.

mod conventional;
#[cfg(test)]
mod tests;

pub use conventional::{Conventional, Reading};

use super::draws::{Draws, STREAMS, generator};
use hadar::error::{Error, Result, check};
use hadar::fisher::precision::{JointPrecision, PrecisionSolver};
use hadar::fisher::{Counting, Unknowns};
use hadar::identifiability::likelihood::MaximumLikelihood;
use hadar::identifiability::nearest::StateRange;
use hadar::scene::{Parameter, State, Surroundings, check_emissivity};
use hadar::spectrum::Bands;
use hadar::statistics::Statistics;
use rand::rngs::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;

/// Temperatures that a fit starts from, K, if the counts suggest none.
const NO_READING_K: f64 = 300.0;
/// Share of its range within which a parameter counts as held by it.
const EDGE: f64 = 1e-9;

/// A target of known material, its surroundings and the camera that looks at it.
///
/// ```
/// use hadar::fisher::{Counting, Nuisance, Unknowns};
/// use hadar::identifiability::nearest::StateRange;
/// use hadar::scene::{EnvironmentObject, Parameter, Surroundings};
/// use hadar_simulate::efficiency::Errors;
/// use hadar_simulate::thermometry::{Run, ThermometryScene};
/// use hadar::spectrum::Bands;
///
/// let bands = Bands::uniform(720.0, 1250.0, 53.0)?;
/// let ambient = EnvironmentObject { temperature_k: 293.15, emissivity: None };
/// let surroundings = Surroundings::new(bands.nodes_cm1(), vec![ambient])?;
/// let paint = vec![0.9; bands.len()];
/// let scene = ThermometryScene {
///     bands: &bands,
///     surroundings: &surroundings,
///     emissivity: &paint,
///     range: StateRange::default(),
///     counting: &Counting { counts_per_radiance: 1e-14, var_added: Vec::new() },
/// };
/// let unknowns = Unknowns::new([Nuisance::Temperature])?;
/// let state = surroundings.state(310.0, &[0.5])?;
/// let sigma_k = scene.bound(&unknowns, &state)?.each[0].sigma;
/// let fits = scene.fits(&unknowns, &state, Run { index: 0, trials: 200, seed: 1 })?;
/// let errors = Errors::of(&fits.of(Parameter::Temperature), 310.0, 0.95)?;
/// assert!((errors.rmse / sigma_k - 1.0).abs() < 0.2);
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct ThermometryScene<'a> {
    /// Bands.
    pub bands: &'a Bands,
    /// Surroundings.
    pub surroundings: &'a Surroundings,
    /// The target's emissivity at the nodes of the bands, known.
    pub emissivity: &'a [f64],
    /// What is physically possible for its state; the true one must lie within it.
    pub range: StateRange,
    /// The camera's counts and electronic noise.
    pub counting: &'a Counting,
}

/// Which spectra are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Run {
    /// Number of the run, below 2²⁴: runs of different numbers share no random numbers.
    pub index: u32,
    /// Spectra.
    pub trials: usize,
    /// Seed.
    pub seed: u64,
}

/// Maximum-likelihood estimates of all trials of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Fits {
    /// What was fitted.
    pub parameters: Vec<Parameter>,
    /// Estimates, trial after trial, each in the order of the parameters.
    pub estimates: Vec<f64>,
    /// True values.
    pub truth: Vec<f64>,
    /// Fits that did not converge (their best state so far counts).
    pub unconverged: usize,
    /// Fits with a parameter at the edge of its range: the bound for unbiased estimates does not hold for them.
    pub at_edge: usize,
    /// Trials.
    pub trials: usize,
}

impl Fits {
    /// Estimates of one parameter; none if it was not fitted.
    #[must_use]
    pub fn of(&self, parameter: Parameter) -> Vec<f64> {
        let Some(own) = self.parameters.iter().position(|p| *p == parameter) else { return Vec::new() };
        self.estimates.iter().skip(own).step_by(self.parameters.len()).copied().collect()
    }
}

/// What a fit starts from.
struct Fitter {
    parameters: Vec<Parameter>,
    truth: Vec<f64>,
    /// Deviations of the priors.
    priors: Vec<Option<f64>>,
    lighting_total: Option<f64>,
}

/// What a fit found.
struct Estimates {
    values: Vec<f64>,
    converged: bool,
    at_edge: bool,
}

impl ThermometryScene<'_> {
    /// Mean counts of each band in `state`.
    ///
    /// # Errors
    /// An emissivity, state or noise that does not fit the scene.
    pub fn means(&self, state: &State) -> Result<Vec<f64>> {
        check_emissivity(self.emissivity, self.surroundings.nodes_cm1().len())?;
        self.surroundings.state(state.temperature_k, &state.lighting)?;
        self.counting.check(self.bands.len())?;
        let counts = self.counting.counts_per_radiance;
        let signal = self.bands.weigh(&self.surroundings.signal(self.emissivity, state));
        Ok(signal.iter().map(|signal| counts * signal).collect())
    }

    /// How counts scatter: normal with electronic noise, else Poisson.
    ///
    /// # Errors
    /// Impossible noise.
    pub fn statistics(&self) -> Result<Statistics> {
        let var = &self.counting.var_added;
        if var.iter().all(|&var| var == 0.0) {
            Ok(Statistics::Poisson)
        } else {
            Statistics::gaussian(var.clone())
        }
    }

    /// Cramér–Rao bounds of all that is unknown.
    ///
    /// # Errors
    /// No unknowns; an emissivity, state or noise that does not fit the scene.
    pub fn bound(&self, unknowns: &Unknowns, state: &State) -> Result<JointPrecision> {
        let mut solver = PrecisionSolver::new(self.bands, self.surroundings, unknowns.clone());
        solver.joint(self.emissivity, state, self.counting)
    }

    /// Maximum-likelihood estimates of what is unknown from every spectrum of a run in `state`.
    ///
    /// # Errors
    /// No unknowns, a state outside of the range, or one that does not fit the scene; too many photons to draw.
    pub fn fits(&self, unknowns: &Unknowns, state: &State, run: Run) -> Result<Fits> {
        let (mut fits, _) = self.read(&[unknowns], &[], state, run)?;
        fits.pop().ok_or_else(|| Error::malformed("a fit without an outcome", "report this as a bug"))
    }

    /// What a thermal imager reads from the sum of the counts of every spectrum of a run in `state`.
    ///
    /// # Errors
    /// A state that does not fit the scene; too many photons to draw.
    pub fn readings(&self, conventional: &Conventional, state: &State, run: Run) -> Result<Vec<Reading>> {
        let (_, mut readings) = self.read(&[], &[conventional], state, run)?;
        Ok(readings.pop().unwrap_or_default())
    }

    /// What each fit and each imager makes of the spectra of a run in `state`, which are drawn once for all of them: the
    /// same as [`ThermometryScene::fits`] and [`ThermometryScene::readings`] one by one.
    ///
    /// # Errors
    /// As those.
    pub fn read(
        &self,
        unknowns: &[&Unknowns],
        imagers: &[&Conventional],
        state: &State,
        run: Run,
    ) -> Result<(Vec<Fits>, Vec<Vec<Reading>>)> {
        self.range.check()?;
        let grey = Conventional::with_surroundings(0.95, self.surroundings)?;
        let fitters =
            unknowns.iter().map(|unknowns| self.fitter(unknowns, state)).collect::<Result<Vec<_>>>()?;
        let draws = self.draws(state)?;
        let workspace = unknowns.iter().map(|unknowns| self.likelihood(unknowns));
        let workspace = workspace.collect::<Result<Vec<_>>>()?;
        let most = fitters.iter().map(|fitter| fitter.parameters.len()).max().unwrap_or(0);
        let each = self.trials(&draws, run, workspace, |likelihoods, rng, counts| {
            // The noise of the priors: every fit has the same, as if it were alone.
            let normals: Vec<f64> = (0..most).map(|_| StandardNormal.sample(rng)).collect();
            let fits = fitters.iter().zip(likelihoods);
            let fits = fits
                .map(|(fitter, likelihood)| self.fit(fitter, likelihood, (state, &grey), &normals, counts));
            let fits: Vec<Estimates> = fits.collect();
            let total = hadar::sum::sum(counts);
            let readings: Vec<Reading> = imagers.iter().map(|imager| self.reading(imager, total)).collect();
            (fits, readings)
        });
        let fits = fitters.into_iter().enumerate().map(|(i, fitter)| {
            let own = || each.iter().filter_map(|(fits, _)| fits.get(i));
            Fits {
                unconverged: own().filter(|fit| !fit.converged).count(),
                at_edge: own().filter(|fit| fit.at_edge).count(),
                trials: each.len(),
                estimates: own().flat_map(|fit| fit.values.iter().copied()).collect(),
                parameters: fitter.parameters,
                truth: fitter.truth,
            }
        });
        let readings = (0..imagers.len()).map(|i| each.iter().map(|(_, readings)| readings[i]).collect());
        Ok((fits.collect(), readings.collect()))
    }

    fn fitter(&self, unknowns: &Unknowns, state: &State) -> Result<Fitter> {
        let parameters = unknowns.parameters(self.surroundings.objects().len());
        if parameters.is_empty() {
            return Err(Error::malformed("a fit without unknown parameters", "name at least one unknown"));
        }
        let truth: Vec<f64> = parameters.iter().map(|p| value(state, *p)).collect();
        for (parameter, truth) in parameters.iter().zip(&truth) {
            self.check_within(*parameter, *truth)?;
        }
        Ok(Fitter {
            priors: parameters.iter().map(|p| unknowns.sigma_prior(*p)).collect(),
            lighting_total: unknowns.known_lighting_total(),
            parameters,
            truth,
        })
    }

    fn likelihood(&self, unknowns: &Unknowns) -> Result<MaximumLikelihood<'_>> {
        MaximumLikelihood::new(
            self.bands,
            self.surroundings,
            unknowns.clone(),
            self.range,
            self.counting.counts_per_radiance,
            self.statistics()?,
        )
    }

    /// One spectrum fitted.
    fn fit(
        &self,
        fitter: &Fitter,
        likelihood: &mut MaximumLikelihood<'_>,
        (state, grey): (&State, &Conventional),
        normals: &[f64],
        counts: &[f64],
    ) -> Estimates {
        let middle = 0.5 * (self.range.lighting[0] + self.range.lighting[1]);
        let share = middle.min(self.range.lighting_sum / state.lighting.len().max(1) as f64);
        let Fitter { parameters, priors, lighting_total, .. } = fitter;
        let mut known = state.clone();
        let mut start = state.clone();
        for ((parameter, sigma), noise) in parameters.iter().zip(priors).zip(normals) {
            // Without a prior what is unknown is not looked at there.
            let centre = value(state, *parameter) + sigma.unwrap_or(0.0) * noise;
            set(&mut known, *parameter, centre);
            if sigma.is_some() {
                set(&mut start, *parameter, centre);
            } else {
                set(&mut start, *parameter, self.guess(*parameter, grey, counts, share, *lighting_total));
            }
        }
        let fit = likelihood.fit(self.emissivity, counts, &known, &[start]);
        Estimates {
            values: parameters.iter().map(|p| value(&fit.state, *p)).collect(),
            converged: fit.converged,
            at_edge: self.at_edge(&fit.state, parameters, *lighting_total),
        }
    }

    fn draws(&self, state: &State) -> Result<Draws> {
        let photons = Draws::new(&Statistics::Poisson, &self.means(state)?)?;
        match self.statistics()? {
            Statistics::Gaussian { var_added } => photons.with_electronic_noise(&var_added),
            Statistics::Poisson | Statistics::NegativeBinomial { .. } => Ok(photons),
        }
    }

    /// Every trial's outcome, in their order.
    fn trials<W: Clone + Send + Sync, T: Send>(
        &self,
        draws: &Draws,
        run: Run,
        workspace: W,
        outcome: impl Fn(&mut W, &mut ChaCha8Rng, &[f64]) -> T + Sync,
    ) -> Vec<T> {
        let first = u64::from(run.index).wrapping_mul(STREAMS);
        (0..run.trials)
            .into_par_iter()
            .with_min_len(16)
            .map_init(
                || (workspace.clone(), vec![0.0; draws.bands()]),
                |(workspace, counts), trial| {
                    hadar::stop::check();
                    let mut rng = generator(run.seed, first.wrapping_add(trial as u64));
                    draws.draw_into(&mut rng, counts);
                    outcome(workspace, &mut rng, counts)
                },
            )
            .collect()
    }

    /// Where a fit starts: a guess from the counts alone, within the range.
    fn guess(
        &self,
        parameter: Parameter,
        grey: &Conventional,
        counts: &[f64],
        share: f64,
        lighting_total: Option<f64>,
    ) -> f64 {
        let [low, high] = self.range.temperature_k;
        match parameter {
            Parameter::Temperature => match self.reading(grey, hadar::sum::sum(counts)) {
                Reading::Kelvin(temperature_k) => temperature_k.clamp(low, high),
                Reading::TooDark | Reading::TooBright => NO_READING_K.clamp(low, high),
            },
            Parameter::Lighting(_) => {
                lighting_total.map_or(share, |total| total / self.surroundings.objects().len().max(1) as f64)
            }
            Parameter::EnvironmentTemperature(k) => {
                self.surroundings.objects().get(k).map_or(NO_READING_K, |object| object.temperature_k)
            }
            Parameter::Gain | Parameter::Material => 0.0,
        }
    }

    fn check_within(&self, parameter: Parameter, truth: f64) -> Result<()> {
        let (what, [low, high], unit) = match parameter {
            Parameter::Temperature => ("true temperature", self.range.temperature_k, "K"),
            Parameter::Lighting(_) => ("true thermal lighting factor", self.range.lighting, ""),
            _ => return check::finite("true value", truth, "").map(drop),
        };
        if (low..=high).contains(&truth) {
            return Ok(());
        }
        Err(Error::out_of_range(what, truth, unit, format!("within its range, {low} to {high}")))
    }

    fn at_edge(&self, state: &State, parameters: &[Parameter], lighting_total: Option<f64>) -> bool {
        let held = |value: f64, [low, high]: [f64; 2]| {
            let margin = EDGE * (high - low).min(value.abs().max(1.0));
            value <= low + margin || value >= high - margin
        };
        let lit: f64 = state.lighting.iter().sum();
        let full = lighting_total.is_none() && lit >= self.range.lighting_sum * (1.0 - EDGE);
        parameters.iter().any(|parameter| match parameter {
            Parameter::Temperature => held(state.temperature_k, self.range.temperature_k),
            Parameter::Lighting(_) => full || held(value(state, *parameter), self.range.lighting),
            _ => false,
        })
    }
}

/// A parameter's value in a state; ln G for the gain.
pub(crate) fn value(state: &State, parameter: Parameter) -> f64 {
    match parameter {
        Parameter::Temperature => state.temperature_k,
        Parameter::Lighting(k) => state.lighting.get(k).copied().unwrap_or(f64::NAN),
        Parameter::Gain => state.gain.ln(),
        Parameter::EnvironmentTemperature(k) => state.environment_k.get(k).copied().unwrap_or(f64::NAN),
        Parameter::Material => 0.0,
    }
}

fn set(state: &mut State, parameter: Parameter, to: f64) {
    match parameter {
        Parameter::Temperature => state.temperature_k = to,
        Parameter::Lighting(k) => state.lighting.iter_mut().skip(k).take(1).for_each(|v| *v = to),
        Parameter::Gain => state.gain = to.exp(),
        Parameter::EnvironmentTemperature(k) => {
            state.environment_k.iter_mut().skip(k).take(1).for_each(|t| *t = to);
        }
        Parameter::Material => {}
    }
}
