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
//! Search: a grid of T′ with the lighting fitted at each (a convex problem for the target's own weights),
//! then Levenberg–Marquardt within the bounds from the best few and from the target's own state. The search
//! is dense, not a proof: a narrower minimum between grid points would be missed.
//!
//! Source: design of the project; Algorithm 1 of the paper is its exact counterpart on a lattice.

use super::step::BoundedStep;
use crate::error::{Error, Result};
use crate::fisher::{Counting, Nuisance, Unknowns};
use crate::planck;
use crate::scene::{Jacobian, Parameter, State, Surroundings};
use crate::spectrum::Bands;
use nalgebra::{DMatrix, DVector};

/// Temperatures of the grid.
const GRID: usize = 24;
/// Minima of the grid that are refined.
const REFINED: usize = 3;
/// Iterations of a refinement.
const ITERATIONS: usize = 100;
/// Relative step at which a refinement has converged.
const STEP_TOLERANCE: f64 = 1e-11;
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
    node: Vec<f64>,
    separation: Vec<f64>,
    spectrum: Vec<f64>,
    difference: Vec<f64>,
}

/// The target as every candidate state is compared with it.
struct Target<'t> {
    emissivity: &'t [f64],
    alternative: &'t [f64],
    state: &'t State,
    counts: f64,
    metric: Metric<'t>,
}

/// Cost, gradient and Gauss–Newton matrix at a candidate state.
struct Linearised {
    cost: f64,
    gradient: DVector<f64>,
    hessian: DMatrix<f64>,
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
        let nodes = surroundings.nodes_cm1().len();
        Self {
            unknowns,
            range,
            parameters,
            surface: Jacobian::new(bands, surroundings),
            target: Jacobian::new(bands, surroundings),
            node: vec![0.0; nodes],
            separation: vec![0.0; bands.len()],
            spectrum: vec![0.0; nodes],
            difference: vec![0.0; nodes],
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
        match best {
            Some(best) => Ok(NearestDistance { iterations, ..best }),
            None => Err(Error::malformed("the alternative has no state in its range", "widen the range")),
        }
    }

    /// The target's own state brought into the range, and the best minima of the temperature grid.
    fn starts(&mut self, target: &Target<'_>) -> Vec<State> {
        let own = self.into_range(target.state);
        let mut starts = vec![own.clone()];
        if !self.unknowns.contains(Nuisance::Temperature) || self.parameters.is_empty() {
            return starts;
        }
        let grid: Vec<(f64, State)> = self
            .temperature_grid(target)
            .into_iter()
            .map(|temperature_k| {
                let mut state = State { temperature_k, ..own.clone() };
                let mut cost = f64::INFINITY;
                // Two Gauss–Newton steps in the other unknowns, T′ held: they are (bi)linear.
                for _ in 0..2 {
                    let at = self.linearise(target, &state);
                    cost = at.cost;
                    let Some(step) = self.step(&at, &state, 1e-9, true) else { break };
                    state = self.moved(&state, &step);
                }
                (cost, state)
            })
            .collect();
        let mut minima: Vec<&(f64, State)> = (0..grid.len())
            .filter(|&i| {
                let cost = grid[i].0;
                cost.is_finite()
                    && (i == 0 || cost <= grid[i - 1].0)
                    && (i + 1 == grid.len() || cost <= grid[i + 1].0)
            })
            .map(|i| &grid[i])
            .collect();
        minima.sort_by(|a, b| a.0.total_cmp(&b.0));
        starts.extend(minima.into_iter().take(REFINED).map(|(_, state)| state.clone()));
        starts
    }

    /// Temperatures between which the alternative's own emission can match the target's photons.
    fn temperature_grid(&mut self, target: &Target<'_>) -> Vec<f64> {
        let bands = self.target.bands();
        let signal = crate::sum::sum(self.target.signal());
        let nu = self.target.surroundings().nodes_cm1();
        let mut emitted = |temperature_k: f64| {
            planck::photon_radiance_into(nu, temperature_k, &mut self.spectrum);
            for (value, e) in self.spectrum.iter_mut().zip(target.alternative) {
                *value *= e;
            }
            crate::sum::sum(&bands.weigh(&self.spectrum))
        };
        let [low, high] = self.range.temperature_k;
        let solve = |emitted: &mut dyn FnMut(f64) -> f64, goal: f64| {
            let (mut a, mut b) = (low.ln(), high.ln());
            for _ in 0..40 {
                let middle = 0.5 * (a + b);
                if emitted(middle.exp()) < goal { a = middle } else { b = middle }
            }
            0.5 * (a + b)
        };
        let bottom = solve(&mut emitted, 1e-3 * signal);
        let top = solve(&mut emitted, 4.0 * signal).max(bottom);
        (0..GRID).map(|i| (bottom + (top - bottom) * i as f64 / (GRID - 1) as f64).exp()).collect()
    }

    /// Levenberg–Marquardt within the bounds.
    fn refine(&mut self, target: &Target<'_>, start: State) -> NearestDistance {
        let mut state = self.into_range(&start);
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

    /// Cost ‖r‖², gradient and Gauss–Newton matrix of half the cost at a state of the alternative.
    fn linearise(&mut self, target: &Target<'_>, state: &State) -> Linearised {
        let total_known = self.unknowns.known_lighting_total().is_some();
        self.surface.evaluate(target.alternative, target.alternative, state, &self.parameters, total_known);
        self.separate(target, state);
        let n = self.parameters.len();
        let bands = self.separation.len();
        let electronic = |band: usize| match target.metric {
            Metric::PerPhoton { .. } => 0.0,
            Metric::Counting(counting) => counting.var_electronic(band),
        };
        let mut cost = crate::sum::Compensated::default();
        let mut roots = Vec::with_capacity(bands);
        let mut residuals = Vec::with_capacity(bands);
        for (band, (signal, other)) in self.target.signal().iter().zip(self.surface.signal()).enumerate() {
            let noise = electronic(band);
            let root = (target.counts * other + noise).sqrt();
            let sum = (target.counts * signal + noise).sqrt() + root;
            let residual = if sum > 0.0 { target.counts * self.separation[band] / sum } else { 0.0 };
            cost.add(residual * residual);
            residuals.push(residual);
            // ∂r/∂θ = −∂N′/(2√(N′+σ²)).
            roots.push(if root > 0.0 { -0.5 * target.counts / root } else { 0.0 });
        }
        let mut gradient = DVector::zeros(n);
        let mut hessian = DMatrix::zeros(n, n);
        for i in 0..n {
            let weighted: Vec<f64> = self.surface.column(i).iter().zip(&roots).map(|(c, w)| c * w).collect();
            gradient[i] = crate::sum::dot(&weighted, &residuals);
            let squared: Vec<f64> = weighted.iter().zip(&roots).map(|(c, w)| c * w).collect();
            for j in i..n {
                hessian[(i, j)] = crate::sum::dot(&squared, self.surface.column(j));
                hessian[(j, i)] = hessian[(i, j)];
            }
            self.add_prior(i, target, state, &mut cost, &mut gradient, &mut hessian);
        }
        Linearised { cost: cost.value(), gradient, hessian }
    }

    /// The row (θ′ − θ)/(2σ_p) of a prior.
    fn add_prior(
        &self,
        i: usize,
        target: &Target<'_>,
        state: &State,
        cost: &mut crate::sum::Compensated,
        gradient: &mut DVector<f64>,
        hessian: &mut DMatrix<f64>,
    ) {
        let Some(sigma) = self.unknowns.sigma_prior(self.parameters[i]) else { return };
        let weight = match target.metric {
            Metric::PerPhoton { photons } => 0.5 / (sigma * photons.sqrt()),
            Metric::Counting(_) => 0.5 / sigma,
        };
        let row = weight * (value(state, self.parameters[i]) - value(target.state, self.parameters[i]));
        cost.add(row * row);
        gradient[i] += weight * row;
        hessian[(i, i)] += weight * weight;
    }

    /// Band integrals of S − S′ from differences that lose no digits.
    fn separate(&mut self, target: &Target<'_>, state: &State) {
        let surroundings = self.target.surroundings();
        let nu = surroundings.nodes_cm1();
        let own = target.state;
        let warmer = own.temperature_k - state.temperature_k;
        planck::photon_radiance_difference_into(
            nu,
            state.temperature_k,
            warmer,
            self.surface.radiance(),
            &mut self.difference,
        );
        self.target.lighting_difference_into(own, &self.surface, state, &mut self.spectrum);
        let lighting = &self.spectrum;
        let contrast = self.target.contrast();
        for (j, out) in self.node.iter_mut().enumerate() {
            let (e, other) = (target.emissivity[j], target.alternative[j]);
            *out = own.gain
                * ((e - other) * contrast[j] + other * self.difference[j] + (1.0 - other) * lighting[j]);
        }
        self.target.bands().weigh_into(&self.node, &mut self.separation);
        let gain = state.gain - own.gain;
        for (separation, other) in self.separation.iter_mut().zip(self.surface.signal()) {
            // S = G s and S′ = G′ s′: S − S′ = G(s − s′) − (G′ − G)s′.
            *separation -= gain * other / state.gain;
        }
    }

    fn step(
        &self,
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
            (0..n).map(|i| at.hessian[(i, i)].sqrt()).map(|s| if s > 0.0 { s } else { 1.0 }).collect();
        let mut lit = 0.0;
        for (i, parameter) in self.parameters.iter().enumerate() {
            let now = value(state, *parameter);
            let [low, high] = self.bounds(*parameter);
            if !(hold_temperature && *parameter == Parameter::Temperature) && at.hessian[(i, i)] > 0.0 {
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
        let mut hessian = DMatrix::from_fn(n, n, |i, j| at.hessian[(i, j)] / (scale[i] * scale[j]));
        for i in 0..n {
            hessian[(i, i)] += damping * hessian[(i, i)].max(f64::EPSILON);
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
            Parameter::Gain => [1e-6, 1e6],
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

    fn into_range(&self, state: &State) -> State {
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
                    Parameter::Lighting(_) => 1.0,
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
        Parameter::Gain => state.gain,
        Parameter::EnvironmentTemperature(k) => state.environment_k[k],
        Parameter::Material => 0.0,
    }
}

fn set(state: &mut State, parameter: Parameter, to: f64) {
    match parameter {
        Parameter::Temperature => state.temperature_k = to,
        Parameter::Lighting(k) => state.lighting[k] = to,
        Parameter::Gain => state.gain = to,
        Parameter::EnvironmentTemperature(k) => state.environment_k[k] = to,
        Parameter::Material => {}
    }
}
