//! The alternative's own free state: which parameters it has, their physical range, and steps within it.
//!
//! Parameters are T′ (K), Vₖ′, ln G′ and Tₖ′ (K), as far as they are unknown. A step minimises the quadratic model
//! ½ pᵀHp + gᵀp of a cost within the box and ΣV ≤ limit (`step`), its diagonal raised by a damping as by
//! Levenberg and Marquardt; parameters of any unit are made comparable by the diagonal of the positive
//! definite part.

use crate::box_least_squares::BoxLeastSquares;
use crate::error::{Error, Result, check};
use crate::few::{Few, FewColumns};
use crate::fisher::{Nuisance, Unknowns};
use crate::scene::{Parameter, State};

/// Largest |ln G′|, and the range of Tₖ′ (K): of searches and of what is proved of them.
pub(in crate::limits) const LARGEST_LN_GAIN: f64 = 14.0;
pub(in crate::limits) const ENVIRONMENT_K: [f64; 2] = [0.1, 1e6];
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
        Self { temperature_k: [0.1, HOTTEST_K], lighting: [0.0, 1.0], lighting_sum: 1.0 }
    }
}

/// Hotter than anything, K: what is looked at begins and ends with a temperature.
const HOTTEST_K: f64 = 1e6;

impl StateRange {
    /// Makes sure that there is something within the range.
    ///
    /// # Errors
    /// Ends that are no numbers, in the wrong order, or beyond what is physical.
    pub fn check(&self) -> Result<()> {
        let [[cold, hot], [dim, bright]] = [self.temperature_k, self.lighting];
        check::positive("lowest temperature of the range", cold, "K")?;
        check::positive("highest temperature of the range", hot, "K")?;
        if hot > HOTTEST_K {
            return Err(Error::out_of_range("highest temperature of the range", hot, "K", "at most 1e6 K"));
        }
        check::non_negative("least lighting of the range", dim, "")?;
        check::non_negative("most lighting of the range", bright, "")?;
        check::non_negative("sum of the lighting", self.lighting_sum, "")?;
        if cold <= hot && dim <= bright {
            return Ok(());
        }
        let found = format!("a range of {cold} to {hot} K and of {dim} to {bright} in lighting");
        Err(Error::malformed(found, "give the lower end first"))
    }
}

/// Half a cost to second order at a state: gradient, positive semidefinite part, and all of the second derivatives.
#[derive(Debug, Clone)]
pub(super) struct Quadratic {
    pub(super) gradient: Few,
    pub(super) gauss_newton: FewColumns,
    pub(super) hessian: FewColumns,
}

/// What is free in the alternative's state, and how far.
#[derive(Debug, Clone)]
pub(super) struct StateSpace {
    pub(super) unknowns: Unknowns,
    pub(super) range: StateRange,
    pub(super) parameters: Vec<Parameter>,
    /// The range of a lighting factor, its lower end where all at once can have it.
    lighting: [f64; 2],
}

impl StateSpace {
    pub(super) fn new(unknowns: Unknowns, range: StateRange, objects: usize) -> Self {
        let parameters = unknowns.parameters(objects);
        let sum = unknowns.known_lighting_total().unwrap_or(range.lighting_sum);
        let [low, high] = range.lighting;
        let lighting = [low.min(sum / objects.max(1) as f64), high];
        Self { unknowns, range, parameters, lighting }
    }

    /// Newton's step within the bounds, or where the second derivatives are not positive definite, Gauss's.
    pub(super) fn step(
        &self,
        at: &Quadratic,
        state: &State,
        damping: f64,
        hold_temperature: bool,
    ) -> Option<Few> {
        self.damped(&at.hessian, at, state, damping, hold_temperature)
            .or_else(|| self.damped(&at.gauss_newton, at, state, damping, hold_temperature))
    }

    fn damped(
        &self,
        matrix: &FewColumns,
        at: &Quadratic,
        state: &State,
        damping: f64,
        hold_temperature: bool,
    ) -> Option<Few> {
        let n = self.parameters.len();
        let (mut lower, mut upper) = (Few::zeros(n), Few::zeros(n));
        let mut summed = Few::filled(false, n);
        // Unit diagonal: parameters of any unit become comparable.
        let scale: Few =
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
        let shared = scale.iter().zip(&*summed).filter(|(_, s)| **s).map(|(s, _)| *s).fold(0.0, f64::max);
        let scale: Few = scale.iter().zip(&*summed).map(|(s, lit)| if *lit { shared } else { *s }).collect();
        let mut hessian = FewColumns::from_fn(n, n, |i, j| matrix[(i, j)] / (scale[i] * scale[j]));
        for i in 0..n {
            let own = at.gauss_newton[(i, i)] / (scale[i] * scale[i]);
            hessian[(i, i)] += damping * own.max(f64::EPSILON);
        }
        let gradient: Few = (0..n).map(|i| at.gradient[i] / scale[i]).collect();
        for i in 0..n {
            lower[i] *= scale[i];
            upper[i] *= scale[i];
        }
        let problem = BoxLeastSquares {
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

    /// What is free as in `start`, what is known as in `known`.
    pub(super) fn free_of(&self, start: &State, known: &State) -> State {
        let mut state = known.clone();
        for parameter in &self.parameters {
            set(&mut state, *parameter, value(start, *parameter));
        }
        self.close_total(&mut state);
        state
    }

    pub(super) fn bounds(&self, parameter: Parameter) -> [f64; 2] {
        match parameter {
            Parameter::Temperature => self.range.temperature_k,
            Parameter::Lighting(_) => self.lighting,
            Parameter::Gain => [-LARGEST_LN_GAIN, LARGEST_LN_GAIN],
            Parameter::EnvironmentTemperature(_) => ENVIRONMENT_K,
            Parameter::Material => [0.0, 0.0],
        }
    }

    pub(super) fn lighting_sum(&self) -> f64 {
        self.unknowns.known_lighting_total().unwrap_or(self.range.lighting_sum)
    }

    pub(super) fn moved(&self, state: &State, step: &[f64]) -> State {
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

    pub(super) fn within_range(&self, state: &State) -> State {
        let mut inside = state.clone();
        for parameter in &self.parameters {
            let [low, high] = self.bounds(*parameter);
            set(&mut inside, *parameter, value(state, *parameter).clamp(low, high));
        }
        // What is above the lower ends is scaled down to what the sum leaves for it.
        let least = self.lighting[0];
        let (mut above, mut room) = (0.0, self.lighting_sum());
        for parameter in &self.parameters {
            if matches!(parameter, Parameter::Lighting(_)) {
                above += value(&inside, *parameter) - least;
                room -= least;
            }
        }
        if above > room {
            for parameter in &self.parameters {
                if matches!(parameter, Parameter::Lighting(_)) {
                    let own = value(&inside, *parameter) - least;
                    set(&mut inside, *parameter, least + own * (room.max(0.0) / above));
                }
            }
        }
        self.close_total(&mut inside);
        inside
    }

    /// Largest relative change that a step makes.
    pub(super) fn relative_size(&self, step: &[f64], state: &State) -> f64 {
        let changes = self.parameters.iter().zip(step.iter());
        changes.map(|(parameter, change)| relative(*parameter, *change, state)).fold(0.0, f64::max)
    }

    /// Largest relative difference between two states in what is free.
    pub(super) fn separation(&self, a: &State, b: &State) -> f64 {
        let changes =
            self.parameters.iter().map(|parameter| (*parameter, value(b, *parameter) - value(a, *parameter)));
        changes.map(|(parameter, change)| relative(parameter, change, a)).fold(0.0, f64::max)
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

/// Size of a change of a parameter: relative for temperatures, as it is for lighting and ln G.
fn relative(parameter: Parameter, change: f64, state: &State) -> f64 {
    let size = match parameter {
        Parameter::Lighting(_) | Parameter::Gain => 1.0,
        other => value(state, other).abs(),
    };
    (change / size).abs()
}

pub(super) fn value(state: &State, parameter: Parameter) -> f64 {
    match parameter {
        Parameter::Temperature => state.temperature_k,
        Parameter::Lighting(k) => state.lighting[k],
        // The columns are derivatives along ln G.
        Parameter::Gain => state.gain.ln(),
        Parameter::EnvironmentTemperature(k) => state.environment_k[k],
        Parameter::Material => 0.0,
    }
}

pub(super) fn set(state: &mut State, parameter: Parameter, to: f64) {
    match parameter {
        Parameter::Temperature => state.temperature_k = to,
        Parameter::Lighting(k) => state.lighting[k] = to,
        Parameter::Gain => state.gain = to.exp(),
        Parameter::EnvironmentTemperature(k) => state.environment_k[k] = to,
        Parameter::Material => {}
    }
}
