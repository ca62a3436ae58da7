//! The best temperature of a material by search, with the best mixture at each: counts are linear in the mixture, so that there the
//! deviance is convex and a few steps end.
//!
//! From the best state known the minimum is bracketed by steps that double, and narrowed by the golden section. Assumption: no other
//! valley lies between; other ones are the business of other starts.

use super::super::kernel::{Asked, Sums, sums};
use super::super::model::Model;
use super::super::step::{Limits, State};
use super::best::Fit;
use hadar::minimum::golden_section;
use std::convert::Infallible;

/// First step, and length to which a bracket is narrowed, K: a tenth and less of what any pixel tells of its temperature where steps do
/// not end.
const FIRST_K: f64 = 0.25;
const NARROW_K: f64 = 1e-4;
/// Steps of a mixture at most, and length of the last one, squared, in deviations.
const MOST_STEPS: usize = 8;
const SHORT: f64 = 1e-8;

/// The best state of material `m` before counts n′ from one that is known, and how many looks there are then.
pub(super) fn temperature(
    model: &Model,
    (m, shifted): (usize, &[f64]),
    known: Fit,
    at: &mut Sums,
    mut looks: usize,
) -> (Fit, usize) {
    let limits = Limits { at_temperature: true, ..model.limits() };
    let mut best = known;
    let mut look = |state: &State, at: &mut Sums| {
        let (temperature_k, mixture) = (state.temperature_k, &state.mixture[..model.vertices]);
        sums(model, Asked { m, shifted, temperature_k, mixture }, at);
        looks += 1;
    };
    let mut least = |temperature_k: f64| {
        hadar::stop::check();
        let mut state = State { temperature_k, held: true, ..best.state };
        let mut lowest = f64::INFINITY;
        for _ in 0..MOST_STEPS {
            look(&state, at);
            let here = Fit { state, deviance: at.deviance, chi_square: at.chi_square };
            let step = state.step(at, &limits);
            let is_last = step.square.is_nan() || step.square < SHORT;
            let here = if is_last { here.after(state, step) } else { here };
            if here.deviance < best.deviance {
                best = here;
            }
            lowest = lowest.min(here.deviance);
            if is_last {
                break;
            }
        }
        lowest
    };
    let bracket = bracket(known.state.temperature_k, model.range_k, &mut least);
    let narrowings = ((bracket[1] - bracket[0]) / NARROW_K).max(1.0).ln() / 1.618_034_f64.ln();
    let Ok(_) = golden_section(bracket, narrowings.ceil() as usize, |t| Ok::<_, Infallible>(least(t)));
    let [low, high] = model.range_k;
    best.state.held = best.state.temperature_k <= low || best.state.temperature_k >= high;
    look(&best.state, at);
    (best, looks)
}

/// Temperatures about a minimum of `least` within a range, from one on downhill.
fn bracket(from_k: f64, [low, high]: [f64; 2], least: &mut impl FnMut(f64) -> f64) -> [f64; 2] {
    let here = least(from_k);
    let sides = [FIRST_K, -FIRST_K].map(|by| {
        let to = (from_k + by).clamp(low, high);
        (by, to, if to == from_k { f64::INFINITY } else { least(to) })
    });
    let Some(&(mut by, mut to, mut lowest)) = sides.iter().find(|(_, _, found)| *found < here) else {
        return [sides[1].1, sides[0].1];
    };
    let mut before = from_k;
    loop {
        by *= 2.0;
        let next = (to + by).clamp(low, high);
        let found = if next == to { f64::INFINITY } else { least(next) };
        if found.is_nan() || found >= lowest {
            return [before.min(next), before.max(next)];
        }
        (before, to, lowest) = (to, next, found);
    }
}
