//! Where refinements start: the minima over a grid of temperatures, the other unknowns fitted at each.

use super::{Linearised, NearestSolver, REFINED, Target};
use crate::fisher::Nuisance;
use crate::planck;
use crate::scene::{Parameter, State};
use crate::simd::{Aligned, dispatched};
use crate::sum::{dot, sum};
use nalgebra::{DMatrix, DVector};

/// Temperatures of the grid.
const GRID: usize = 32;
/// About as many nodes are enough to tell how much a surface emits.
const FEW: usize = 32;
/// Halvings of the range of ln T that ends of the grid are found by: to 3e-4.
const HALVINGS: usize = 16;

impl NearestSolver<'_> {
    /// The best minima of the temperature grid, and the target's own state brought into the range.
    pub(super) fn starts(&mut self, target: &Target<'_>) -> Vec<State> {
        let own = self.brought_into_range(target.state);
        if !self.unknowns.contains(Nuisance::Temperature) {
            return vec![own];
        }
        let temperatures_k = self.temperature_grid(target);
        let grid = if self.is_linear() {
            self.fit_lighting(target, &own, &temperatures_k)
        } else {
            temperatures_k.iter().map(|&temperature_k| self.fit_at(target, &own, temperature_k)).collect()
        };
        let cost = |i: usize| grid.get(i).map_or(f64::INFINITY, |point| point.0);
        let mut minima: Vec<&(f64, State)> = (0..grid.len())
            .filter(|&i| cost(i).is_finite() && cost(i) <= cost(i.wrapping_sub(1)) && cost(i) <= cost(i + 1))
            .map(|i| &grid[i])
            .collect();
        minima.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut starts: Vec<State> =
            minima.into_iter().take(REFINED).map(|(_, state)| state.clone()).collect();
        starts.push(own);
        starts
    }

    /// Whether the signal is linear in all unknowns but T′, none of which has a prior.
    fn is_linear(&self) -> bool {
        let linear = |p: &Parameter| matches!(p, Parameter::Temperature | Parameter::Lighting(_));
        !self.unknowns.has_priors() && self.parameters.iter().all(linear)
    }

    /// Cost and state after three Gauss–Newton steps in the other unknowns, T′ held: they are (bi)linear.
    fn fit_at(&mut self, target: &Target<'_>, own: &State, temperature_k: f64) -> (f64, State) {
        let mut state = State { temperature_k, ..own.clone() };
        let mut cost = f64::INFINITY;
        for _ in 0..3 {
            let at = self.linearise(target, &state);
            cost = at.cost;
            let Some(step) = self.step(&at, &state, 1e-9, true) else { break };
            state = self.moved(&state, &step);
        }
        (cost, state)
    }

    /// Cost and state at every temperature, with the lighting that fits best in the noise of the target.
    ///
    /// S − S′ = R − G′e′B(T′) − Σ(Vₖ′ − Vₖ)∂S′/∂Vₖ with R = S − [S′(T, V) − G′e′B(T)] and ∂S′/∂Vₖ the same for
    /// all T′: one small quadratic problem for each.
    fn fit_lighting(
        &mut self,
        target: &Target<'_>,
        own: &State,
        temperatures_k: &[f64],
    ) -> Vec<(f64, State)> {
        let total_known = self.unknowns.known_lighting_total().is_some();
        self.surface.evaluate(target.alternative, target.alternative, own, &self.parameters, total_known);
        let n = self.parameters.len();
        slopes_into(target.counts, &self.target_root, &mut self.slope);
        for i in 0..n {
            self.surface.scale_column(i, &self.slope);
        }
        let bands = self.target.bands();
        let mut remainder = Aligned::zeros(bands.len());
        self.emission(target, own, None);
        for ((remainder, signal), (other, emitted)) in remainder
            .iter_mut()
            .zip(self.target.signal())
            .zip(self.surface.signal().iter().zip(self.separation.iter()))
        {
            *remainder = signal - (other - emitted);
        }
        let fixed = |i: usize| self.parameters[i] == Parameter::Temperature;
        let hessian = DMatrix::from_fn(n, n, |i, j| match (fixed(i) || fixed(j), i == j) {
            (false, _) => dot(self.surface.column(i), self.surface.column(j)),
            (true, diagonal) => f64::from(u8::from(diagonal)),
        });
        let fixed: Vec<bool> = (0..n).map(fixed).collect();
        temperatures_k
            .iter()
            .map(|&temperature_k| {
                let state = State { temperature_k, ..own.clone() };
                self.emission(target, &state, Some(temperature_k));
                misfit_into(&remainder, &self.slope, &mut self.separation);
                let gradient = DVector::from_fn(n, |i, _| {
                    if fixed[i] { 0.0 } else { dot(self.surface.column(i), &self.separation) }
                });
                let cost = dot(&self.separation, &self.separation);
                let at = Linearised { cost, gradient, hessian: hessian.clone() };
                let Some(step) = self.step(&at, &state, 1e-9, true) else { return (cost, state) };
                for (i, change) in step.iter().enumerate().filter(|(i, _)| !fixed[*i]) {
                    add_into(*change, self.surface.column(i), &mut self.separation);
                }
                straighten(&self.target_root, &mut self.separation);
                (dot(&self.separation, &self.separation), self.moved(&state, &step))
            })
            .collect()
    }

    /// G′e′B(T′) of each band into `separation`; without a temperature that of the last evaluation.
    fn emission(&mut self, target: &Target<'_>, state: &State, temperature_k: Option<f64>) {
        let bands = self.target.bands();
        match temperature_k {
            Some(temperature_k) => {
                planck::photon_radiance_into(bands.nodes_cm1(), temperature_k, &mut self.spectrum);
            }
            None => self.spectrum.copy_from_slice(self.surface.radiance()),
        }
        product_into(state.gain, target.alternative, &self.spectrum, &mut self.node);
        bands.weigh_into(&self.node, &mut self.separation);
    }

    /// Temperatures between which the alternative's own emission can match the target's photons.
    fn temperature_grid(&mut self, target: &Target<'_>) -> Vec<f64> {
        let bands = self.target.bands();
        let every = (bands.nodes_cm1().len() / FEW).max(1);
        let nodes: Vec<f64> = bands.nodes_cm1().iter().copied().step_by(every).collect();
        let shares: Vec<f64> =
            bands.weights_cm1().iter().zip(target.alternative).map(|(w, e)| w * e).step_by(every).collect();
        let mut spectrum = vec![0.0; nodes.len()];
        let mut emitted = |temperature_k: f64| {
            planck::photon_radiance_into(&nodes, temperature_k, &mut spectrum);
            every as f64 * dot(&spectrum, &shares)
        };
        let signal = sum(self.target.signal());
        let [low, high] = self.range.temperature_k;
        let mut solve = |goal: f64| {
            let (mut a, mut b) = (low.ln(), high.ln());
            for _ in 0..HALVINGS {
                let middle = 0.5 * (a + b);
                if emitted(middle.exp()) < goal { a = middle } else { b = middle }
            }
            0.5 * (a + b)
        };
        let bottom = solve(1e-5 * signal);
        let top = solve(4.0 * signal).max(bottom);
        (0..GRID).map(|i| (bottom + (top - bottom) * i as f64 / (GRID - 1) as f64).exp()).collect()
    }
}

dispatched! {
    fn product_into<'a>(factor: f64, a: &'a [f64], b: &'a [f64], out: &'a mut [f64]) {
        for ((out, a), b) in out.iter_mut().zip(a).zip(b) {
            *out = factor * (a * b);
        }
    }
}

dispatched! {
    /// −κ/(2√(N + σ²)), from the roots.
    fn slopes_into<'a>(counts: f64, roots: &'a [f64], out: &'a mut [f64]) {
        for (out, root) in out.iter_mut().zip(roots) {
            *out = if *root > 0.0 { -0.5 * counts / root } else { 0.0 };
        }
    }
}

dispatched! {
    fn add_into<'a>(factor: f64, a: &'a [f64], to: &'a mut [f64]) {
        for (to, a) in to.iter_mut().zip(a) {
            *to = factor.mul_add(*a, *to);
        }
    }
}

dispatched! {
    /// From (N − N′)/(2√(N + σ²)), linear in S′, to √(N + σ²) − √(N′ + σ²).
    fn straighten<'a>(target_root: &'a [f64], residual: &'a mut [f64]) {
        for (residual, root) in residual.iter_mut().zip(target_root) {
            let double = 2.0 * root * *residual;
            let sum = root + root.mul_add(*root, -double).max(0.0).sqrt();
            *residual = if sum > 0.0 { double / sum } else { 0.0 };
        }
    }
}

dispatched! {
    /// What is left of the remainder without the emission, in units of the noise.
    fn misfit_into<'a>(remainder: &'a [f64], slope: &'a [f64], emission: &'a mut [f64]) {
        for ((out, remainder), slope) in emission.iter_mut().zip(remainder).zip(slope) {
            *out = -slope * (remainder - *out);
        }
    }
}
