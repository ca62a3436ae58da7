//! Half the separation between the target's state and the nearest state of the alternative.
//!
//! d = min ‖√(N + σ²) − √(N′ + σ²)‖ over the alternative's own free state θ′ (T′, V′, gain′, Tₖ′: those that
//! are unknown, within their physical range). 2√(N + σ²) has unit variance, so d is half the separation in
//! units of the noise, and no test, averaged over the two states, is right more often than Φ(d) (large N).
//!
//! Per band r = (N − N′)/(√(N+σ²) + √(N′+σ²)), with
//! S − S′ = (e − e′)C + e′[B(T) − B(T′)] + (1 − e′)(X − X′) formed from differences that are exact to a few
//! ulp (C contrast, X lighting; see [`crate::scene`]): nothing is lost as the materials become equal.
//! A prior of deviation σ_p on a parameter adds the row (θ′ − θ)/(2σ_p), whose tangent is the local bound's.
//!
//! Search: where T′ is free, a dense grid of it with the other unknowns fitted at each point; between two
//! points the derivative of the fitted cost along T′ tells of a minimum (`search`). Every minimum is then
//! refined by damped Newton steps within the bounds (`residual`), and so is the target's own state. The search is
//! dense, not a proof: two extremes between neighbouring points would be missed together. (Of 3000 random
//! pairs with temperature, lighting and in a fifth of them gain unknown, one ended above a brute-force lattice of
//! starts by more than 1e-6 and none by 1e-5. With unknown environment temperatures up to a quarter do.)
//!
//! Source: design of the project; Algorithm 1 of the paper is its exact counterpart on a lattice.

mod residual;
mod search;

use self::residual::{Linearised, Target, Workspace};
use super::step::BoundedStep;
use crate::error::{Error, Result};
use crate::fisher::{Counting, Nuisance, Unknowns};
use crate::scene::{Jacobian, Parameter, State, Surroundings};
use crate::spectrum::Bands;
use nalgebra::{DMatrix, DVector};

/// Iterations of a refinement.
const ITERATIONS: usize = 100;
/// Relative step at which a refinement has converged.
const STEP_TOLERANCE: f64 = 1e-11;
/// Share of the separation at the target's own state below which a distance is rounding noise.
const ROUNDING: f64 = 1e-14;
/// Largest |ln G′|.
const LOG_GAIN: f64 = 14.0;
/// Share of its range within which a parameter counts as standing at the edge.
const EDGE: f64 = 1e-9;

/// The physical range of the alternative's state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StateRange {
    /// Lowest and highest temperature T′, K.
    pub temperature_k: [f64; 2],
    /// Lowest and highest lighting factor of each environment object.
    pub lighting: [f64; 2],
    /// Largest sum of the lighting factors.
    pub lighting_sum: f64,
}

impl Default for StateRange {
    /// All that physics allows: any temperature, 0 ≤ V, ΣV ≤ 1.
    fn default() -> Self {
        Self { temperature_k: [0.1, 1e6], lighting: [0.0, 1.0], lighting_sum: 1.0 }
    }
}

/// The nearest state of the alternative and its distance.
#[derive(Debug, Clone, PartialEq)]
pub struct NearestDistance {
    /// Half the separation in units of the noise: d₀ per √photon, or d, as asked for.
    pub distance: f64,
    /// The nearest state.
    pub state: State,
    /// Parameters that stand at the edge of their range.
    pub at_edge: Vec<Parameter>,
    /// Iterations of all refinements together.
    pub iterations: usize,
    /// Whether the refinement of the nearest state converged.
    pub converged: bool,
}

/// What the counts are compared in.
#[derive(Debug, Clone, Copy)]
enum Metric<'a> {
    /// Shot noise per √photon, the photons being those of the target; priors as among `photons`.
    PerPhoton { photons: f64 },
    /// Counts with the camera's noise.
    Counting(&'a Counting),
}

/// Finds nearest states in fixed bands and surroundings.
#[derive(Debug, Clone)]
pub struct NearestSolver<'a> {
    unknowns: Unknowns,
    range: StateRange,
    parameters: Vec<Parameter>,
    surface: Jacobian<'a>,
    target: Jacobian<'a>,
    work: Workspace,
}

impl<'a> NearestSolver<'a> {
    /// A solver for one set of bands, surroundings, unknowns and ranges of the alternative's state.
    #[must_use]
    pub fn new(
        bands: &'a Bands,
        surroundings: &'a Surroundings,
        unknowns: Unknowns,
        range: StateRange,
    ) -> Self {
        let parameters = unknowns.parameters(surroundings.objects().len());
        Self {
            unknowns,
            range,
            parameters,
            surface: Jacobian::new(bands, surroundings),
            target: Jacobian::new(bands, surroundings),
            work: Workspace::new(bands.len(), surroundings.nodes_cm1().len()),
        }
    }

    /// Nearest distance per √photon in the limit of shot noise. Priors count as among `photons` photons.
    ///
    /// # Errors
    /// A scene without photons.
    pub fn per_photon(
        &mut self,
        emissivity: &[f64],
        alternative: &[f64],
        state: &State,
        photons: f64,
    ) -> Result<NearestDistance> {
        self.search(emissivity, alternative, state, Metric::PerPhoton { photons }, None)
    }

    /// Nearest statistical distance d with the camera's own noise.
    ///
    /// # Errors
    /// A scene without photons.
    pub fn with_counting(
        &mut self,
        emissivity: &[f64],
        alternative: &[f64],
        state: &State,
        counting: &Counting,
    ) -> Result<NearestDistance> {
        self.search(emissivity, alternative, state, Metric::Counting(counting), None)
    }

    /// As [`NearestSolver::with_counting`], but only refined from a state known to be near the answer.
    ///
    /// # Errors
    /// A scene without photons.
    pub fn refine_with_counting(
        &mut self,
        emissivity: &[f64],
        alternative: &[f64],
        state: &State,
        counting: &Counting,
        start: &State,
    ) -> Result<NearestDistance> {
        self.search(emissivity, alternative, state, Metric::Counting(counting), Some(start))
    }

    fn search(
        &mut self,
        emissivity: &[f64],
        alternative: &[f64],
        state: &State,
        metric: Metric<'_>,
        start: Option<&State>,
    ) -> Result<NearestDistance> {
        self.target.evaluate(emissivity, alternative, state, &[], false);
        let total = crate::sum::sum(self.target.signal());
        if !(total > 0.0 && total.is_finite()) {
            return Err(Error::out_of_range(
                "photon radiance of the target",
                total,
                "photons s^-1 m^-2 sr^-1",
                "above 0: a warmer scene, or bands at lower wavenumbers",
            ));
        }
        let counts = match metric {
            Metric::PerPhoton { .. } => 1.0 / total,
            Metric::Counting(counting) => counting.counts_per_radiance,
        };
        let target = Target { emissivity, alternative, state, counts, metric };
        self.work.weigh_target(&target, self.target.signal());
        let starts = match start {
            Some(start) => vec![start.clone()],
            None => self.starts(&target),
        };
        let mut best: Option<NearestDistance> = None;
        let mut iterations = 0;
        for start in starts {
            let candidate = self.refine(&target, start);
            iterations += candidate.iterations;
            if best.as_ref().is_none_or(|best| candidate.distance < best.distance) {
                best = Some(candidate);
            }
        }
        // What is left of the separation at the target's own state when only rounding is left of it.
        let own = self.linearise(&target, state).cost.sqrt();
        match best {
            Some(best) => {
                let distance = if best.distance <= ROUNDING * own { 0.0 } else { best.distance };
                Ok(NearestDistance { distance, iterations, ..best })
            }
            None => Err(Error::malformed("the alternative has no state in its range", "widen the range")),
        }
    }

    /// Newton's method within the bounds, damped as by Levenberg and Marquardt.
    fn refine(&mut self, target: &Target<'_>, start: State) -> NearestDistance {
        let mut state = self.within_range(&start);
        let mut at = self.linearise(target, &state);
        let (mut damping, mut converged, mut iterations) = (1e-7, self.parameters.is_empty(), 0);
        while !converged && iterations < ITERATIONS {
            iterations += 1;
            let Some(step) = self.step(&at, &state, damping, false) else { break };
            let moved = self.moved(&state, &step);
            let size = self.relative_size(&step, &state);
            let next = self.linearise(target, &moved);
            if next.cost <= at.cost {
                (state, at) = (moved, next);
                damping = (damping * 0.05).max(1e-15);
                converged = size < STEP_TOLERANCE;
            } else {
                // Below this the cost changes only by rounding.
                converged = size < 1e3 * STEP_TOLERANCE;
                damping = (damping * 20.0).max(1e-9);
                if damping > 1e12 {
                    break;
                }
            }
        }
        let at_edge = self.edges(&state);
        NearestDistance { distance: at.cost.sqrt(), state, at_edge, iterations, converged }
    }

    /// Newton's step within the bounds, or where the second derivatives are not positive definite, Gauss's.
    fn step(
        &self,
        at: &Linearised,
        state: &State,
        damping: f64,
        hold_temperature: bool,
    ) -> Option<DVector<f64>> {
        self.damped(&at.hessian, at, state, damping, hold_temperature)
            .or_else(|| self.damped(&at.gauss_newton, at, state, damping, hold_temperature))
    }

    fn damped(
        &self,
        matrix: &DMatrix<f64>,
        at: &Linearised,
        state: &State,
        damping: f64,
        hold_temperature: bool,
    ) -> Option<DVector<f64>> {
        let n = self.parameters.len();
        let (mut lower, mut upper) = (vec![0.0; n], vec![0.0; n]);
        let mut summed = vec![false; n];
        // Unit diagonal: parameters of any unit become comparable.
        let scale: Vec<f64> =
            (0..n).map(|i| at.gauss_newton[(i, i)].sqrt()).map(|s| if s > 0.0 { s } else { 1.0 }).collect();
        let mut lit = 0.0;
        for (i, parameter) in self.parameters.iter().enumerate() {
            let now = value(state, *parameter);
            let [low, high] = self.bounds(*parameter);
            if !(hold_temperature && *parameter == Parameter::Temperature) && at.gauss_newton[(i, i)] > 0.0 {
                (lower[i], upper[i]) = ((low - now).min(0.0), (high - now).max(0.0));
            }
            if matches!(parameter, Parameter::Lighting(_)) {
                summed[i] = true;
                lit += now;
            }
        }
        let sum_limit = (self.lighting_sum() - lit).max(0.0);
        // The sum constraint is written for unscaled steps, so all lighting columns share one scale.
        let shared = scale.iter().zip(&summed).filter(|(_, s)| **s).map(|(s, _)| *s).fold(0.0, f64::max);
        let scale: Vec<f64> =
            scale.iter().zip(&summed).map(|(s, lit)| if *lit { shared } else { *s }).collect();
        let mut hessian = DMatrix::from_fn(n, n, |i, j| matrix[(i, j)] / (scale[i] * scale[j]));
        for i in 0..n {
            let own = at.gauss_newton[(i, i)] / (scale[i] * scale[i]);
            hessian[(i, i)] += damping * own.max(f64::EPSILON);
        }
        let gradient = DVector::from_fn(n, |i, _| at.gradient[i] / scale[i]);
        for i in 0..n {
            lower[i] *= scale[i];
            upper[i] *= scale[i];
        }
        let problem = BoundedStep {
            hessian: &hessian,
            gradient: &gradient,
            lower: &lower,
            upper: &upper,
            summed: &summed,
            sum_limit: sum_limit * shared,
        };
        let mut step = problem.solve()?;
        for i in 0..n {
            step[i] /= scale[i];
        }
        step.iter().all(|value| value.is_finite()).then_some(step)
    }

    fn bounds(&self, parameter: Parameter) -> [f64; 2] {
        match parameter {
            Parameter::Temperature => self.range.temperature_k,
            Parameter::Lighting(_) => self.range.lighting,
            Parameter::Gain => [-LOG_GAIN, LOG_GAIN],
            Parameter::EnvironmentTemperature(_) => [0.1, 1e6],
            Parameter::Material => [0.0, 0.0],
        }
    }

    fn lighting_sum(&self) -> f64 {
        self.unknowns.known_lighting_total().unwrap_or(self.range.lighting_sum)
    }

    fn moved(&self, state: &State, step: &DVector<f64>) -> State {
        let mut moved = state.clone();
        for (parameter, change) in self.parameters.iter().zip(step.iter()) {
            let [low, high] = self.bounds(*parameter);
            set(&mut moved, *parameter, (value(state, *parameter) + change).clamp(low, high));
        }
        self.close_total(&mut moved);
        moved
    }

    /// With a known total the last factor is what the others leave of it.
    fn close_total(&self, state: &mut State) {
        if !self.unknowns.contains(Nuisance::Lighting) {
            return;
        }
        if let (Some(total), [others @ .., last]) =
            (self.unknowns.known_lighting_total(), state.lighting.as_mut_slice())
        {
            *last = (total - others.iter().sum::<f64>()).max(0.0);
        }
    }

    fn within_range(&self, state: &State) -> State {
        let mut inside = state.clone();
        for parameter in &self.parameters {
            let [low, high] = self.bounds(*parameter);
            set(&mut inside, *parameter, value(state, *parameter).clamp(low, high));
        }
        if self.unknowns.contains(Nuisance::Lighting) {
            let sum: f64 = inside.lighting.iter().sum();
            if sum > self.lighting_sum() {
                inside.lighting.iter_mut().for_each(|factor| *factor *= self.lighting_sum() / sum);
            }
        }
        self.close_total(&mut inside);
        inside
    }

    fn relative_size(&self, step: &DVector<f64>, state: &State) -> f64 {
        self.parameters
            .iter()
            .zip(step.iter())
            .map(|(parameter, change)| {
                let size = match parameter {
                    Parameter::Lighting(_) | Parameter::Gain => 1.0,
                    other => value(state, *other).abs(),
                };
                (change / size).abs()
            })
            .fold(0.0, f64::max)
    }

    fn edges(&self, state: &State) -> Vec<Parameter> {
        let lit: f64 = state.lighting.iter().sum();
        let full =
            self.unknowns.known_lighting_total().is_none() && lit >= self.lighting_sum() * (1.0 - EDGE);
        let at_edge = |parameter: &&Parameter| {
            let [low, high] = self.bounds(**parameter);
            let now = value(state, **parameter);
            let margin = EDGE * now.abs().max((high - low).min(1.0));
            now <= low + margin
                || now >= high - margin
                || (full && matches!(parameter, Parameter::Lighting(_)))
        };
        self.parameters.iter().filter(at_edge).copied().collect()
    }
}

fn value(state: &State, parameter: Parameter) -> f64 {
    match parameter {
        Parameter::Temperature => state.temperature_k,
        Parameter::Lighting(k) => state.lighting[k],
        // The columns are derivatives along ln G.
        Parameter::Gain => state.gain.ln(),
        Parameter::EnvironmentTemperature(k) => state.environment_k[k],
        Parameter::Material => 0.0,
    }
}

fn set(state: &mut State, parameter: Parameter, to: f64) {
    match parameter {
        Parameter::Temperature => state.temperature_k = to,
        Parameter::Lighting(k) => state.lighting[k] = to,
        Parameter::Gain => state.gain = to.exp(),
        Parameter::EnvironmentTemperature(k) => state.environment_k[k] = to,
        Parameter::Material => {}
    }
}
