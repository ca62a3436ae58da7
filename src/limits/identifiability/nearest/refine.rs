//! Downhill from a start to the minimum of the valley that it lies in.
//!
//! Where a band of the alternative is dark, its root √N′ rises with infinite slope as light is let in, which no step of Newton's sees:
//! a descent that has ended where a band is as good as dark is tried with more light, and goes on where that is nearer.

use super::residual::{Comparison, NO_GAIN, Target};
use crate::identifiability::space::{set, value};
use crate::scene::{Parameter, State};

/// Iterations of a refinement.
const ITERATIONS: usize = 100;
/// Relative step at which a refinement has converged.
const STEP_TOLERANCE: f64 = 1e-9;
/// To what share of the step before one must have shrunk for the next one to be taken to shrink as much.
const SHRINKS: f64 = 1e-2;
/// What the last step may still promise, as a share of the cost.
const GAIN_TOLERANCE: f64 = 1e-9;
/// Relative separation at which two refinements have come to the same minimum.
const SAME_MINIMUM: f64 = 1e-5;
/// By a quarter each time, how much light is tried in bands that are dark: down to 10⁻³⁰ of what makes them as bright as the target.
const HALVINGS: usize = 50;

/// The nearest state of the alternative and its distance.
#[derive(Debug, Clone, PartialEq)]
pub struct NearestDistance {
    /// Half the separation in units of the noise: d₀ per √photon, or d, as asked for.
    pub distance: f64,
    /// Proved: no state of the alternative within its range is nearer. 0 where nothing is proved.
    pub lower: f64,
    /// Estimated relative error of `distance` as the separation of the nearest state, by rounding; 0 where it is 0.
    pub relative_error: f64,
    /// The nearest state.
    pub state: State,
    /// Parameters that stand at the edge of their range.
    pub at_edge: Vec<Parameter>,
    /// Iterations of all refinements together.
    pub iterations: usize,
    /// Whether the refinement of the nearest state converged.
    pub converged: bool,
}

impl NearestDistance {
    /// Whether no state is nearer than the distance less this share of it.
    #[must_use]
    pub fn is_proved_to(&self, share: f64) -> bool {
        self.lower >= (1.0 - share) * self.distance
    }
}

/// Downhill within the bounds. It ends early where it has come to a minimum that is `known`, or nearer than `enough`.
pub(super) fn refine(
    comparison: &mut Comparison<'_>,
    target: &Target<'_>,
    start: State,
    known: Option<&NearestDistance>,
    enough: f64,
) -> NearestDistance {
    let mut found = newton(comparison, target, start, known, enough);
    // Each time one more source is lit.
    for _ in 0..=found.state.lighting.len() {
        let Some(lit) = lit(comparison, target, &found) else { break };
        let next = newton(comparison, target, lit, known, enough);
        if next.distance >= found.distance {
            break;
        }
        found = NearestDistance { iterations: found.iterations + next.iterations, ..next };
    }
    found
}

/// A state nearer than `found` with more light in bands that are as good as dark there, if there is one.
fn lit(comparison: &mut Comparison<'_>, target: &Target<'_>, found: &NearestDistance) -> Option<State> {
    let dark = comparison.dark(target, &found.state);
    if dark.is_empty() {
        return None;
    }
    let cost = found.distance * found.distance;
    let lights = comparison.space.parameters.iter().copied().enumerate();
    let lights: Vec<_> = lights.filter(|(_, one)| matches!(one, Parameter::Lighting(_))).collect();
    let (mut best, mut least) = (None, cost * (1.0 - GAIN_TOLERANCE));
    for (place, light) in lights {
        let Some(mut more) = comparison.lighting_of(target, &found.state, place, &dark) else { continue };
        for _ in 0..HALVINGS {
            let mut tried = found.state.clone();
            set(&mut tried, light, value(&found.state, light) + more);
            let tried = comparison.space.within_range(&tried);
            let cost = comparison.cost(target, &tried);
            if cost < least {
                (best, least) = (Some(tried), cost);
            } else if best.is_some() {
                break;
            }
            more *= 0.25;
        }
    }
    best
}

/// Newton's method, damped as by Levenberg and Marquardt.
fn newton(
    comparison: &mut Comparison<'_>,
    target: &Target<'_>,
    start: State,
    known: Option<&NearestDistance>,
    enough: f64,
) -> NearestDistance {
    let mut state = comparison.space.within_range(&start);
    let mut at = comparison.linearise(target, &state);
    let mut before = 0.0;
    let (mut damping, mut converged, mut iterations) = (1e-7, comparison.space.parameters.is_empty(), 0);
    while !converged && iterations < ITERATIONS && at.cost >= enough * enough {
        iterations += 1;
        let Some(step) = comparison.space.step(&at.quadratic, &state, damping, false) else { break };
        let moved = comparison.space.moved(&state, &step);
        let size = comparison.space.relative_size(&step, &state);
        // What the step promises, of half the cost. Nearly identical materials need it however small the step is.
        let promised = at.quadratic.gradient.dot(&step).abs();
        if promised <= NO_GAIN * at.cost {
            // It is not taken: the cost is that of this state to the last bit, and a step that promises nothing may yet lead
            // elsewhere, along a source that sends next to nothing, say.
            converged = true;
            break;
        }
        // By what the steps shrink the next one is known before it is computed, Newton's shrink ever faster.
        let shrinks = size / before;
        let next_is_last = shrinks < SHRINKS
            && size * shrinks < STEP_TOLERANCE
            && promised * shrinks * shrinks <= GAIN_TOLERANCE * at.cost;
        let is_last = size < STEP_TOLERANCE && promised <= GAIN_TOLERANCE * at.cost;
        if is_last || next_is_last {
            // The last step, whether it is taken or only rounding: the cost tells.
            let cost = comparison.cost(target, &moved);
            let falls = cost <= at.cost;
            if falls {
                (state, at.cost) = (moved.clone(), cost);
            }
            if is_last || falls {
                converged = true;
                break;
            }
        }
        if known.is_some_and(|known| {
            known.distance * known.distance <= at.cost
                && comparison.space.separation(&moved, &known.state) < SAME_MINIMUM
        }) {
            break;
        }
        let next = comparison.linearise(target, &moved);
        if next.cost <= at.cost {
            (state, at, before) = (moved, next, size);
            damping = (damping * 0.05).max(1e-15);
        } else {
            // What follows is shorter because it is damped.
            before = 0.0;
            // Below this the cost changes only by rounding.
            converged = size < 10.0 * STEP_TOLERANCE;
            damping = (damping * 20.0).max(1e-9);
            if damping > 1e12 {
                break;
            }
        }
    }
    let at_edge = comparison.space.edges(&state);
    NearestDistance {
        distance: at.cost.sqrt(),
        lower: 0.0,
        relative_error: 0.0,
        state,
        at_edge,
        iterations,
        converged,
    }
}
