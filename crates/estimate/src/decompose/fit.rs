//! Maximum likelihood of one material for one pixel: steps of Fisher scoring within the range of the unknowns.
//!
//! A step solves the quadratic form of the information at hand ([`super::step`]); one that makes the deviance larger is halved. The
//! information is that of a perfect fit: where a material fits badly, or its temperature and lighting hardly differ, steps come out
//! too long or too short by the same factor each time, which two of them tell (Aitken). The last step is short and taken without
//! another look: what is left of it is its square.
//!
//! Where a surface sends what it would reflect, its temperature changes the counts as its lighting does: the information of the
//! temperature beside it goes to 0, steps promise gains that are not there however near the best state is, and do not end. What does
//! not end soon is searched along the temperature, with the best mixture at each (`along`).

mod along;
mod best;

pub(super) use self::best::Fit;

use super::kernel::{Asked, Sums, sums};
use super::model::{MOST, Model};
use super::step::{Limits, State, Step};

/// Length of the last step, squared, in deviations: of a fit that is only compared with others, and of the one that is told.
pub(super) const COMPARED: f64 = 0.1;
pub(super) const TOLD: f64 = 1e-6;
/// Lengths from which a step is looked back at.
const LONG: f64 = 1e-2;
const MOST_LOOKS: usize = 20;
/// Share of the step before that is worth a correction.
const NOTABLE: f64 = 0.05;

impl State {
    /// A temperature with nothing held and no lighting yet.
    pub(super) fn at(temperature_k: f64) -> Self {
        Self { temperature_k, mixture: [0.0; MOST], free: [true; MOST], held: false }
    }

    /// Holds the weights that are 0.
    pub(super) fn clear(&mut self, vertices: usize) {
        for j in 0..vertices {
            self.mixture[j] = self.mixture[j].max(0.0);
            self.free[j] = self.mixture[j] > 0.0;
        }
    }
}

/// A start where no space of few dimensions holds material `m`: the best of some temperatures, each with its best mixture.
pub(super) fn scan(model: &Model, m: usize, shifted: &[f64], at: &mut Sums, looks: &mut u64) -> State {
    hadar::stop::check();
    let [low, high] = model.range_k;
    let mut best = (f64::INFINITY, State::at(low));
    let count = 8;
    for i in 0..=count {
        let mut state = State::at(low + (high - low) * f64::from(i) / f64::from(count));
        state.mixture[..model.vertices].fill(1.0 / model.vertices as f64);
        for _ in 0..2 {
            let (temperature_k, mixture) = (state.temperature_k, &state.mixture[..model.vertices]);
            sums(model, Asked { m, shifted, temperature_k, mixture }, at);
            *looks += 1;
            if at.deviance < best.0 {
                best = (at.deviance, state);
            }
            if !state.step(at, &model.limits()).square.is_finite() {
                break;
            }
        }
    }
    best.1
}

/// The best state of material `m` from a start, and how many looks that took. `at` is left near it.
pub(super) fn fit(
    model: &Model,
    m: usize,
    shifted: &[f64],
    start: State,
    short: f64,
    at: &mut Sums,
) -> (Fit, usize) {
    let limits = model.limits();
    let mut state = start;
    let mut before: Option<Fit> = None;
    let mut last: Option<Step> = None;
    let mut looks = 0;
    loop {
        hadar::stop::check();
        let mixture = &state.mixture[..model.vertices];
        sums(model, Asked { m, shifted, temperature_k: state.temperature_k, mixture }, at);
        looks += 1;
        let here = Fit { state, deviance: at.deviance, chi_square: at.chi_square };
        if let Some(from) = before.filter(|from| here.deviance.is_nan() || here.deviance > from.deviance) {
            state = from.state.halfway(&state, model.vertices);
            last = None;
            if from.state.is_near(&state) {
                return (from, looks);
            }
            if looks >= MOST_LOOKS {
                return along::temperature(model, (m, shifted), from, at, looks);
            }
            continue;
        }
        let mut next = state;
        let step = next.step(at, &limits);
        if step.square.is_nan() || step.square < short {
            return (here.after(next, step), looks);
        }
        if looks >= MOST_LOOKS {
            return along::temperature(model, (m, shifted), here, at, looks);
        }
        let share = last.and_then(|last| step.share_of(&last, at, limits.unknowns)).unwrap_or(0.0);
        if share.abs() > NOTABLE {
            // What follows is no longer the step that was foreseen.
            next.stretch(&step, (1.0 - share.min(0.9)).recip(), &limits);
            last = None;
        } else {
            last = Some(step);
        }
        before = (step.square > LONG).then_some(here);
        state = next;
    }
}

impl State {
    fn halfway(&self, to: &Self, vertices: usize) -> Self {
        let mut middle = *to;
        middle.temperature_k = 0.5 * (self.temperature_k + to.temperature_k);
        for j in 0..vertices {
            middle.mixture[j] = 0.5 * (self.mixture[j] + to.mixture[j]);
            middle.free[j] = middle.mixture[j] > 0.0;
        }
        middle.held = self.held && to.held;
        middle
    }

    fn is_near(&self, to: &Self) -> bool {
        let apart = (0..MOST).map(|j| (self.mixture[j] - to.mixture[j]).abs()).fold(0.0, f64::max);
        (self.temperature_k - to.temperature_k).abs() < 1e-9 * self.temperature_k && apart < 1e-9
    }
}

impl Model {
    pub(super) fn limits(&self) -> Limits {
        Limits {
            range_k: self.range_k,
            vertices: self.vertices,
            gain: self.gain,
            unknowns: self.unknowns(),
            at_temperature: false,
        }
    }
}

#[cfg(test)]
mod tests;
