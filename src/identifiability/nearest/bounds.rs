//! Bounds of the alternative's state, and steps within them.

use super::{EDGE, Linearised, NearestSolver};
use crate::fisher::Nuisance;
use crate::identifiability::step::BoundedStep;
use crate::scene::{Parameter, State};
use nalgebra::{DMatrix, DVector};

/// Largest factor by which a step may change a temperature.
const LEAP: f64 = 1.5;

impl NearestSolver<'_> {
    /// Step that minimises the damped quadratic model within the bounds; T′ may be held where it is.
    pub(super) fn step(
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
            let [mut low, mut high] = self.bounds(*parameter);
            if matches!(parameter, Parameter::Temperature | Parameter::EnvironmentTemperature(_)) {
                // Not too far at once: where nothing is emitted there is no slope that leads back.
                (low, high) = (low.max(now / LEAP), high.min(now * LEAP));
            }
            if !(hold_temperature && *parameter == Parameter::Temperature) && at.hessian[(i, i)] > 0.0 {
                let unit = unit(state, *parameter);
                (lower[i], upper[i]) = (((low - now) / unit).min(0.0), ((high - now) / unit).max(0.0));
            }
            if matches!(parameter, Parameter::Lighting(_)) {
                summed[i] = true;
                lit += now;
            }
        }
        let sum_limit = (self.lighting_sum() - lit).max(0.0);
        if let [alone] = (0..n).filter(|&i| summed[i]).collect::<Vec<_>>()[..] {
            // The sum of one is that one: no multiplier is needed.
            upper[alone] = upper[alone].min(sum_limit);
            summed[alone] = false;
        }
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

    pub(super) fn bounds(&self, parameter: Parameter) -> [f64; 2] {
        match parameter {
            Parameter::Temperature => self.range.temperature_k,
            Parameter::Lighting(_) => self.range.lighting,
            Parameter::Gain => [1e-6, 1e6],
            Parameter::EnvironmentTemperature(_) => [0.1, 1e6],
            Parameter::Material => [0.0, 0.0],
        }
    }

    pub(super) fn lighting_sum(&self) -> f64 {
        self.unknowns.known_lighting_total().unwrap_or(self.range.lighting_sum)
    }

    pub(super) fn moved(&self, state: &State, step: &DVector<f64>) -> State {
        let mut moved = state.clone();
        for (parameter, change) in self.parameters.iter().zip(step.iter()) {
            let [low, high] = self.bounds(*parameter);
            let to = unit(state, *parameter).mul_add(*change, value(state, *parameter));
            set(&mut moved, *parameter, to.clamp(low, high));
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

    pub(super) fn brought_into_range(&self, state: &State) -> State {
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

    pub(super) fn relative_size(&self, step: &DVector<f64>, state: &State) -> f64 {
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

    pub(super) fn edges(&self, state: &State) -> Vec<Parameter> {
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

/// What a step of 1 adds to a parameter: steps of the gain are relative, as its derivative is.
pub(super) fn unit(state: &State, parameter: Parameter) -> f64 {
    if parameter == Parameter::Gain { state.gain } else { 1.0 }
}

/// Value of a parameter.
pub(super) fn value(state: &State, parameter: Parameter) -> f64 {
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
