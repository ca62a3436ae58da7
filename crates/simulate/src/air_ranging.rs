//! Distances read from the air on the path, by maximum likelihood: does an estimator reach the bound, and what does one lose that
//! leaves out the sky?
//!
//! Counts x of variance N + σ² are fitted by the distance and all unknowns of an [`AirSolver`]: the greatest
//!
//! Σ_w [(x + σ²) ln(N + σ²) − (N + σ²)] − ½Σ ((θ − c)/σ_p)²
//!
//! over θ, c the centres of the priors. That is the likelihood of photon counts shifted by σ², whose information is that of the bound.
//! The search is Fisher's scoring in ln z and θ with a damping that grows where a step does not help; it starts from a few distances
//! along the table, each with the temperature that the clearest band shows, goes on from the best, and so does not know the truth. Distances
//! stay within the table; lighting and temperatures are not held to their ranges, as the bound does not.
//!
//! The model may be another one than that of the counts: with no lighting at all it is that of a target without sky.
//!
//! Source: Kay, 'Fundamentals of Statistical Signal Processing' (1993), section 7.7 (scoring); shifted Poisson counts: Snyder, Hammoud
//! and White, J. Opt. Soc. Am. A 10, 1014 (1993), doi:10.1364/JOSAA.10.001014.

#[cfg(test)]
mod tests;

use super::draws::{Draws, STREAMS, generator};
use super::thermometry::value;
use hadar::error::{Error, Result};
use hadar::fisher::Counting;
use hadar::parallel;
use hadar::planck;
use hadar::ranging::air::{AirParameter, AirSolver, AirState};
use hadar::scene::Parameter;
use hadar::statistics::Statistics;
use nalgebra::{DMatrix, DVector};
use rand_distr::{Distribution, StandardNormal};

/// Distance that a search begins with at least, and the factor from one beginning to the next.
const FIRST_M: f64 = 3.0;
const NEXT: f64 = 3.0;
/// Shortest distance that is looked at, m.
const SHORTEST_M: f64 = 0.1;
/// Steps from each beginning, and from the best.
const FEW_STEPS: usize = 12;
const MOST_STEPS: usize = 200;
/// Gain of the logarithm of the likelihood below which a fit has ended: its square root is in deviations of the estimate.
const ENOUGH: f64 = 1e-9;
/// Damping to begin with, and beyond which nothing helps.
const DAMPING: (f64, f64) = (1e-4, 1e9);
/// How near to the end of the distances a fit stands at it, of ln z.
const AT_EDGE: f64 = 1e-6;

/// One fit.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct AirFit {
    /// Distance, m.
    pub distance_m: f64,
    /// Target, surroundings and air.
    pub state: AirState,
    /// Logarithm of the likelihood and the priors, but for what does not depend on the fit.
    pub log_likelihood: f64,
    /// Whether the last step gained nothing more.
    pub converged: bool,
    /// Whether it ended at the shortest or the longest distance.
    pub at_edge: bool,
}

/// Fits counts of one scene.
#[derive(Debug, Clone)]
pub struct AirFitter<'a> {
    solver: &'a AirSolver<'a>,
    counting: &'a Counting,
    modes: &'a [Vec<f64>],
    parameters: Vec<(AirParameter, Option<f64>)>,
    ln_range: [f64; 2],
}

/// Where a fit stands: values of the parameters and, last, ln z.
struct Place {
    values: Vec<f64>,
    objective: f64,
}

impl<'a> AirFitter<'a> {
    /// A fitter whose errors of the emissivity have the modes that matter in `state`.
    ///
    /// # Errors
    /// A state or noise that does not fit the scene.
    pub fn new(solver: &'a AirSolver<'a>, state: &AirState, counting: &'a Counting) -> Result<Self> {
        solver.scene().check(state)?;
        counting.check(solver.scene().bands.len())?;
        let modes = solver.modes(state, counting)?;
        let longest_m = solver.scene().air.longest_m();
        Ok(Self {
            solver,
            counting,
            modes,
            parameters: solver.parameters(modes.len()),
            ln_range: [SHORTEST_M.min(0.5 * longest_m).ln(), longest_m.ln()],
        })
    }

    /// Mean counts of a state.
    ///
    /// # Errors
    /// A distance or bands that the air does not cover.
    pub fn means(&self, state: &AirState) -> Result<Vec<f64>> {
        let scene = self.solver.scene();
        let seen = scene.evaluate(scene.emissivity, state, &[], &[], false)?;
        Ok(seen.signal.iter().map(|signal| self.counting.counts_per_radiance * signal).collect())
    }

    /// The fit of `counts`, with all that is not unknown as in `known` (whose distance is not looked at) and the priors about `centres`, one
    /// number for each parameter.
    ///
    /// # Errors
    /// Counts or centres of another length.
    pub fn fit(&self, counts: &[f64], known: &AirState, centres: &[f64]) -> Result<AirFit> {
        for (what, found, expected) in [
            ("counts of a spectrum", counts.len(), self.solver.scene().bands.len()),
            ("centres of priors", centres.len(), self.parameters.len()),
        ] {
            if found != expected {
                return Err(Error::Length { what: what.into(), found, expected });
            }
        }
        let mut best: Option<Place> = None;
        let mut beginning = FIRST_M.ln().max(self.ln_range[0]);
        while beginning < self.ln_range[1] {
            let mut place = self.beginning(counts, known, centres, beginning)?;
            // Without errors of the emissivity first.
            self.climb(&mut place, counts, known, centres, (FEW_STEPS, false))?;
            if best.as_ref().is_none_or(|best| place.objective > best.objective) {
                best = Some(place);
            }
            beginning += NEXT.ln();
        }
        let mut place = match best {
            Some(best) => best,
            None => self.beginning(counts, known, centres, 0.5 * (self.ln_range[0] + self.ln_range[1]))?,
        };
        let converged = self.climb(&mut place, counts, known, centres, (MOST_STEPS, true))?;
        let state = self.state(&place.values, known);
        let ln_z = state.distance_m.ln();
        Ok(AirFit {
            distance_m: state.distance_m,
            state,
            log_likelihood: place.objective,
            converged,
            at_edge: ln_z <= self.ln_range[0] + AT_EDGE || ln_z >= self.ln_range[1] - AT_EDGE,
        })
    }

    /// Values of the parameters in a state; errors of the emissivity are none.
    #[must_use]
    pub fn values(&self, state: &AirState) -> Vec<f64> {
        let one = |(parameter, _): &(AirParameter, Option<f64>)| match parameter {
            AirParameter::Scene(parameter) => value(&state.target, *parameter),
            AirParameter::AirTemperature => state.air_k,
            AirParameter::Emissivity(_) => 0.0,
            AirParameter::Distance => state.distance_m,
        };
        self.parameters.iter().map(one).collect()
    }

    /// The estimates of the distance from `trials` spectra of `state`, m, with what became of the fits. Trial k takes stream k of the run.
    /// Priors are centred at random about the truth, so that errors are averaged over them as those of the bound are.
    ///
    /// # Errors
    /// Counts that cannot be drawn.
    pub fn trials(&self, state: &AirState, index: u32, trials: usize, seed: u64) -> Result<Vec<AirFit>> {
        let means = self.means(state)?;
        let mut draws = Draws::new(&Statistics::Poisson, &means)?;
        if !self.counting.var_added.is_empty() {
            draws = draws.with_electronic_noise(&self.counting.var_added)?;
        }
        let truth = self.values(state);
        let first = u64::from(index).wrapping_mul(STREAMS);
        let one = |trial: usize| {
            let mut rng = generator(seed, first.wrapping_add(trial as u64));
            let mut counts = vec![0.0; means.len()];
            draws.draw_into(&mut rng, &mut counts);
            let centres: Vec<f64> = (truth.iter().zip(&self.parameters))
                .map(|(truth, (_, prior))| match prior {
                    Some(sigma) => {
                        let off: f64 = StandardNormal.sample(&mut rng);
                        truth + sigma * off
                    }
                    None => *truth,
                })
                .collect();
            self.fit(&counts, state, &centres)
        };
        parallel::try_map(trials, one)
    }

    /// A place to begin at, at a distance.
    fn beginning(&self, counts: &[f64], known: &AirState, centres: &[f64], ln_z: f64) -> Result<Place> {
        let temperature_k = self.clearest_band_k(counts, known, ln_z.exp())?;
        let objects = self.solver.scene().surroundings.objects().len().max(1) as f64;
        let total = self.solver.known_lighting_total().unwrap_or(0.5);
        let guess = |((parameter, prior), centre): (&(AirParameter, Option<f64>), &f64)| match parameter {
            _ if prior.is_some() => *centre,
            AirParameter::Scene(Parameter::Temperature) => temperature_k,
            AirParameter::Scene(Parameter::Lighting(_)) => total / objects,
            AirParameter::Scene(Parameter::EnvironmentTemperature(k)) => self
                .solver
                .scene()
                .surroundings
                .objects()
                .get(*k)
                .map_or(known.air_k, |object| object.temperature_k),
            AirParameter::AirTemperature => known.air_k,
            _ => 0.0,
        };
        let mut values: Vec<f64> = self.parameters.iter().zip(centres).map(guess).collect();
        values.push(ln_z);
        Ok(Place { values, objective: f64::NEG_INFINITY })
    }

    /// Temperature of a blackbody that shows in the band through which the air at that distance lets most.
    fn clearest_band_k(&self, counts: &[f64], known: &AirState, distance_m: f64) -> Result<f64> {
        let bands = self.solver.scene().bands;
        let tau = self.solver.scene().air.transmittance(bands.nodes_cm1(), distance_m)?;
        let widths = bands.widths_cm1();
        let open: Vec<f64> =
            bands.weigh(&tau).iter().zip(&widths).map(|(seen, width)| seen / width).collect();
        let clearest =
            open.iter().enumerate().fold(0, |best, (w, tau)| if *tau > open[best] { w } else { best });
        let (Some(band), Some(width), Some(count)) =
            (bands.bands().get(clearest), widths.get(clearest), counts.get(clearest))
        else {
            return Ok(known.air_k);
        };
        let radiance = count / (self.counting.counts_per_radiance * width);
        Ok(match radiance > 0.0 {
            true => planck::brightness_temperature(band.center_cm1, radiance)
                .clamp(0.5 * known.air_k, 3.0 * known.air_k),
            false => known.air_k,
        })
    }

    /// Goes uphill for so many steps, with or without errors of the emissivity; whether the last step gained nothing more.
    fn climb(
        &self,
        place: &mut Place,
        counts: &[f64],
        known: &AirState,
        centres: &[f64],
        (steps, emissivity): (usize, bool),
    ) -> Result<bool> {
        let mut damping = DAMPING.0;
        let (mut here, mut slope, mut information) = self.look(&place.values, counts, known, centres)?;
        place.objective = here;
        if !here.is_finite() {
            return Ok(false);
        }
        for _ in 0..steps {
            let ln_z = place.values.last().copied().unwrap_or(0.0);
            loop {
                let free = |i: usize| match self.parameters.get(i) {
                    Some((AirParameter::Emissivity(_), _)) => emissivity,
                    Some(_) => true,
                    // The distance, unless it would leave the table.
                    None => {
                        let at_end = (ln_z <= self.ln_range[0] && slope[i] < 0.0)
                            || (ln_z >= self.ln_range[1] && slope[i] > 0.0);
                        !at_end
                    }
                };
                let (step, promised) = damped(&slope, &information, damping, free);
                let mut next = place.values.clone();
                next.iter_mut().zip(step.iter()).for_each(|(value, step)| *value += step);
                if let Some(ln_z) = next.last_mut() {
                    *ln_z = ln_z.clamp(self.ln_range[0], self.ln_range[1]);
                }
                let there = match self.is_possible(&next) {
                    true => self.look(&next, counts, known, centres)?,
                    false => (f64::NEG_INFINITY, Vec::new(), DMatrix::zeros(0, 0)),
                };
                if there.0 >= here {
                    let gained = there.0 - here;
                    (here, slope, information) = there;
                    place.values = next;
                    place.objective = here;
                    damping = (0.1 * damping).max(1e-12);
                    if gained <= ENOUGH && promised <= ENOUGH {
                        return Ok(true);
                    }
                    break;
                }
                // Rounding of a sum of many counts hides what is left to gain.
                if promised <= ENOUGH {
                    return Ok(true);
                }
                damping *= 10.0;
                if damping.is_nan() || damping > DAMPING.1 {
                    return Ok(false);
                }
            }
        }
        Ok(false)
    }

    /// Whether temperatures are above 0 and all is a number.
    fn is_possible(&self, values: &[f64]) -> bool {
        let possible = |((parameter, _), value): (&(AirParameter, Option<f64>), &f64)| match parameter {
            AirParameter::Scene(Parameter::Temperature | Parameter::EnvironmentTemperature(_))
            | AirParameter::AirTemperature => *value > 1.0 && *value < 1e5,
            AirParameter::Scene(Parameter::Gain) => value.abs() < 50.0,
            _ => value.is_finite(),
        };
        self.parameters.iter().zip(values).all(possible)
    }

    /// Objective, its slope and the information, ln z last.
    fn look(
        &self,
        values: &[f64],
        counts: &[f64],
        known: &AirState,
        centres: &[f64],
    ) -> Result<(f64, Vec<f64>, DMatrix<f64>)> {
        let scene = self.solver.scene();
        let state = self.state(values, known);
        let asked: Vec<AirParameter> =
            self.parameters.iter().map(|(parameter, _)| *parameter).chain([AirParameter::Distance]).collect();
        let mut emissivity = scene.emissivity.to_vec();
        let mut error = vec![0.0; scene.bands.len()];
        for ((parameter, _), size) in self.parameters.iter().zip(values) {
            if let AirParameter::Emissivity(mode) = parameter
                && let Some(mode) = self.modes.get(*mode)
            {
                error.iter_mut().zip(mode).for_each(|(error, mode)| *error += size * mode);
            }
        }
        emissivity.iter_mut().zip(scene.bands.spread(&error)).for_each(|(e, error)| *e += error);
        let total_known = self.solver.known_lighting_total().is_some();
        let seen = scene.evaluate(&emissivity, &state, &asked, self.modes, total_known)?;
        let kappa = self.counting.counts_per_radiance;
        let mut objective = 0.0;
        let (mut pull, mut weight) = (Vec::with_capacity(counts.len()), Vec::with_capacity(counts.len()));
        for (w, (count, signal)) in counts.iter().zip(&seen.signal).enumerate() {
            let var_added = self.counting.var_added(w);
            let (mean, shifted) = (kappa * signal + var_added, count + var_added);
            if mean.is_nan() || mean <= 0.0 {
                return Ok((f64::NEG_INFINITY, Vec::new(), DMatrix::zeros(0, 0)));
            }
            // Less what it is at its best, so that little is lost of what differs.
            let off = (mean - shifted) / shifted.max(f64::MIN_POSITIVE);
            objective +=
                if shifted > 0.0 { shifted * (off.ln_1p() - off) } else { shifted * mean.ln() - mean };
            pull.push(shifted / mean - 1.0);
            weight.push(1.0 / mean);
        }
        let distance = seen.columns.last().map_or(0.0, |_| kappa * state.distance_m);
        let columns: Vec<Vec<f64>> = seen
            .columns
            .iter()
            .enumerate()
            .map(|(i, column)| {
                let factor = if i == self.parameters.len() { distance } else { kappa };
                column.iter().map(|x| factor * x).collect()
            })
            .collect();
        let n = columns.len();
        let mut slope: Vec<f64> = columns.iter().map(|column| hadar::sum::dot(column, &pull)).collect();
        let mut information = DMatrix::zeros(n, n);
        for i in 0..n {
            let weighed: Vec<f64> = columns[i].iter().zip(&weight).map(|(x, u)| x * u).collect();
            for j in 0..=i {
                let product = hadar::sum::dot(&weighed, &columns[j]);
                (information[(i, j)], information[(j, i)]) = (product, product);
            }
        }
        for (i, ((_, prior), centre)) in self.parameters.iter().zip(centres).enumerate() {
            if let Some(sigma) = prior {
                let off = (values[i] - centre) / sigma;
                objective -= 0.5 * off * off;
                slope[i] -= off / sigma;
                information[(i, i)] += 1.0 / (sigma * sigma);
            }
        }
        Ok((objective, slope, information))
    }

    /// The state that the values stand for.
    fn state(&self, values: &[f64], known: &AirState) -> AirState {
        let mut state = known.clone();
        for ((parameter, _), value) in self.parameters.iter().zip(values) {
            match parameter {
                AirParameter::Scene(Parameter::Temperature) => state.target.temperature_k = *value,
                AirParameter::Scene(Parameter::Lighting(k)) => set(&mut state.target.lighting, *k, *value),
                AirParameter::Scene(Parameter::EnvironmentTemperature(k)) => {
                    set(&mut state.target.environment_k, *k, *value);
                }
                AirParameter::Scene(Parameter::Gain) => state.target.gain = value.exp(),
                AirParameter::AirTemperature => state.air_k = *value,
                AirParameter::Scene(Parameter::Material)
                | AirParameter::Emissivity(_)
                | AirParameter::Distance => {}
            }
        }
        if let Some(total) = self.solver.known_lighting_total()
            && let Some((last, others)) = state.target.lighting.split_last_mut()
        {
            *last = total - others.iter().sum::<f64>();
        }
        let ln_z = values.last().copied().unwrap_or(0.0);
        state.distance_m = ln_z.exp().min(self.solver.scene().air.longest_m());
        state
    }
}

fn set(values: &mut [f64], k: usize, to: f64) {
    values.iter_mut().skip(k).take(1).for_each(|value| *value = to);
}

/// The step of scoring with its diagonal raised, of the free parameters alone, and what of the objective it promises.
fn damped(
    slope: &[f64],
    information: &DMatrix<f64>,
    damping: f64,
    free: impl Fn(usize) -> bool,
) -> (Vec<f64>, f64) {
    let mut step = vec![0.0; slope.len()];
    let free: Vec<usize> = (0..slope.len()).filter(|&i| free(i) && information[(i, i)] > 0.0).collect();
    let scale: Vec<f64> = free.iter().map(|&i| information[(i, i)].sqrt()).collect();
    let matrix = DMatrix::from_fn(free.len(), free.len(), |i, j| {
        let own = information[(free[i], free[j])] / (scale[i] * scale[j]);
        if i == j { own + damping } else { own }
    });
    let pull = DVector::from_fn(free.len(), |i, _| slope[free[i]] / scale[i]);
    let Some(factor) = matrix.cholesky() else { return (step, f64::INFINITY) };
    let solved = factor.solve(&pull);
    for (i, &at) in free.iter().enumerate() {
        step[at] = solved[i] / scale[i];
    }
    (step, 0.5 * pull.dot(&solved))
}
