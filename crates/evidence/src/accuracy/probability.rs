//! Error of the best test between two known states: exact laws, brackets, simulation.
//!
//! Two bands, some hundred photons, d near 1: small enough that the sum over all counts can be made in extended
//! precision.

use super::chart::{Chart, Measured};
use super::timing::{Budget, seconds_of};
use super::{Item, Order};
use crate::reference::probability::poisson_error;
use hadar::error::Result;
use hadar::identifiability::bracket::KnownStates;
use hadar::identifiability::detection;
use hadar::identifiability::ratio::{RatioLaw, Route, State};
use hadar::statistics::Statistics;
use hadar_simulate::draws::{Draws, generator};
use hadar_simulate::ratio::RatioDraws;

const MEANS: [f64; 2] = [150.3, 121.7];
const OTHERS: [f64; 2] = [171.9, 108.2];
const TRIALS: [f64; 5] = [1e2, 1e3, 1e4, 1e5, 1e6];
const SEEDS: u64 = 8;

pub(super) fn measure(order: Order) -> Result<Chart> {
    let law = Statistics::Poisson;
    let truth = poisson_error(&MEANS, &OTHERS).to_f64();
    let off = |error: f64| (error / truth - 1.0).abs();
    let budget = Budget::of(order.quick);
    let mut measured = Vec::new();
    let ratio = RatioLaw::new(&MEANS, &OTHERS, &law)?;

    let exact = || RatioLaw::new(&MEANS, &OTHERS, &law).map(|law| law.error());
    let found = exact()?;
    let default = Measured::new(
        "law of the ratio: the first route that settles",
        f64::NAN,
        seconds_of(budget, exact),
        off(found.error),
    );
    measured.push(default.default_if(true).reporting(found.numerical));
    for (route, name) in [
        (Route::Sum, "law of the ratio: sum over counts"),
        (Route::Integral, "law of the ratio: integral"),
        (Route::Lattice, "law of the ratio: lattice"),
    ] {
        if let Some(found) = ratio.error_by(route) {
            let seconds =
                seconds_of(budget, || RatioLaw::new(&MEANS, &OTHERS, &law).map(|law| law.error_by(route)));
            measured
                .push(Measured::new(name, f64::NAN, seconds, off(found.error)).reporting(found.numerical));
        }
    }

    let bracket = || KnownStates::new(&MEANS, &OTHERS, &law).map(|states| states.bracket());
    let found = bracket()?;
    let middle = 0.5 * (found.lower + found.upper);
    let half = 0.5 * (found.upper - found.lower) / middle;
    measured.push(
        Measured::new("middle of the bracket", f64::NAN, seconds_of(budget, bracket), off(middle))
            .reporting(half),
    );

    let normal = || {
        let squares = MEANS.iter().zip(&OTHERS).map(|(a, b): (&f64, &f64)| (a.sqrt() - b.sqrt()).powi(2));
        detection::miss_probability(squares.sum::<f64>().sqrt())
    };
    measured.push(Measured::new("normal limit", f64::NAN, seconds_of(budget, normal), off(normal())));

    let most = if order.quick { 1e4 } else { 1e6 };
    for trials in TRIALS.into_iter().filter(|trials| *trials <= most) {
        for (name, draw) in [("spectra drawn", spectra as Simulation), ("ratio drawn", ratios as Simulation)]
        {
            let mut squares = 0.0;
            for seed in 0..SEEDS {
                squares += off(draw(trials as usize, order.seed + seed)?).powi(2);
            }
            let seconds =
                super::timing::one_thread(|| seconds_of(Budget::QUICK, || draw(trials as usize, order.seed)));
            let expected = ((1.0 - truth) / truth / trials).sqrt();
            measured.push(
                Measured::new(name, trials, seconds, (squares / SEEDS as f64).sqrt()).reporting(expected),
            );
        }
    }
    Ok(Chart {
        name: Item::Probability.name(),
        title: "Error of the best test between two known states",
        timed: "one probability",
        effort: "trials",
        error: "relative error of the probability (of simulations: root mean square over 8 seeds)",
        reference: "sum over all counts in extended precision",
        measured,
        remark: "The default takes the first route that settles: the sum over counts here, the integral in many bands."
            .into(),
    })
}

type Simulation = fn(usize, u64) -> Result<f64>;

/// Half of the trials with each state true, every band drawn.
fn spectra(trials: usize, seed: u64) -> Result<f64> {
    let steps: Vec<f64> = MEANS.iter().zip(&OTHERS).map(|(a, b): (&f64, &f64)| (b / a).ln()).collect();
    let offset: f64 = OTHERS.iter().sum::<f64>() - MEANS.iter().sum::<f64>();
    let mut wrong = 0.0;
    for (class, means) in [MEANS, OTHERS].iter().enumerate() {
        let draws = Draws::new(&Statistics::Poisson, means)?;
        let mut rng = generator(seed, class as u64);
        let mut counts = [0.0; 2];
        for _ in 0..trials / 2 {
            draws.draw_into(&mut rng, &mut counts);
            let ratio = counts.iter().zip(&steps).map(|(n, step)| n * step).sum::<f64>() - offset;
            wrong += f64::from(u8::from((ratio > 0.0) == (class == 0)));
        }
    }
    Ok(wrong / (trials / 2 * 2) as f64)
}

/// The same, of the ratio itself.
fn ratios(trials: usize, seed: u64) -> Result<f64> {
    let mut wrong = 0.0;
    for (state, stream) in [(State::First, 0), (State::Second, 1)] {
        let draws = RatioDraws::new(&MEANS, &OTHERS, &Statistics::Poisson, state)?;
        for value in draws.values(seed, stream, trials / 2) {
            wrong += f64::from(u8::from((value > 0.0) == (state == State::First)));
        }
    }
    Ok(wrong / (trials / 2 * 2) as f64)
}
