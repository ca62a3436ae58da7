//! The ways down from one candidate: gain and lighting alone, some temperatures with them, or all in 31 digits.

use super::descent::{Constraint, Descent, Each, MOST};
use super::model::{LOG_GAIN, Model, Spectrum};
use crate::reference::double_double::{DoubleDouble, Real};
use hadar::scene::State;

/// Longest step of the logarithm of a temperature.
const LONGEST: f64 = 0.5;

/// The least that was found.
#[derive(Debug, Clone)]
pub struct Found {
    /// Half the separation in units of the noise, per √photon or with a camera's counts.
    pub distance: DoubleDouble,
    /// Where it is, rounded.
    pub state: State,
}

/// A state on the way down: logarithms of all temperatures, then gain and Cₖ.
#[derive(Debug, Clone)]
pub(super) struct Candidate {
    pub(super) cost: f64,
    pub(super) temperatures: Each<f64>,
    pub(super) rest: Each<f64>,
}

/// A pair on the way down, in numbers of one kind.
#[derive(Debug)]
pub(super) struct Search<'a, R> {
    pub(super) model: Model<'a, R>,
    /// What limits gain and lighting.
    linear: Vec<Constraint<R>>,
}

impl Search<'_, f64> {
    /// The least over gain and lighting where the spectra are these.
    pub(super) fn convex(&self, start: &Each<f64>, spectra: &[&Spectrum<f64>]) -> (Each<f64>, f64) {
        let descent = Descent {
            unknowns: self.model.layout.unknowns(0),
            constraints: &self.linear,
            longest: [f64::INFINITY; MOST],
            settled: 1e-7,
            nothing: 1e-29,
            steps: 60,
        };
        descent.run(*start, |z| self.model.evaluate(z, &[], spectra))
    }

    /// The same at these temperatures, their spectra still to be computed.
    pub(super) fn at(&self, temperatures: &Each<f64>, start: &Each<f64>, free: &[usize]) -> Candidate {
        self.follow(&Candidate { cost: f64::INFINITY, temperatures: *temperatures, rest: *start }, free)
    }

    pub(super) fn follow(&self, from: &Candidate, free: &[usize]) -> Candidate {
        let (temperatures, rest, cost) = self.down(&from.temperatures, &from.rest, free, [1e-12, 1e-29], 60);
        Candidate { cost, temperatures, rest }
    }
}

impl Search<'_, DoubleDouble> {
    /// Logarithms of temperatures, within their limits where they are free and as they are known where not.
    pub(super) fn within_limits(&self, temperatures: &Each<DoubleDouble>) -> Each<DoubleDouble> {
        let mut all = logarithms(self.model.own);
        for &s in &self.model.layout.temperatures {
            let [low, high] =
                self.model.layout.limits_k(s).map(|limit| DoubleDouble::from(limit).logarithm());
            all[s] = temperatures[s].larger(low).smaller(high);
        }
        all
    }

    /// Gain and Cₖ that are within the range but for rounding.
    pub(super) fn lit_within_limits(&self, mut rest: Each<DoubleDouble>) -> Each<DoubleDouble> {
        let layout = self.model.layout;
        let mut gain = DoubleDouble::from(self.model.own.gain);
        if layout.gain {
            let [low, high] = [-LOG_GAIN, LOG_GAIN].map(|limit| DoubleDouble::from(limit).exponential());
            gain = rest[0].larger(low).smaller(high);
            rest[0] = gain;
        }
        if layout.lighting {
            let factors = &mut rest[usize::from(layout.gain)..][..layout.objects];
            let [low, high] = layout.range.lighting.map(|limit| gain * DoubleDouble::from(limit));
            for factor in factors.iter_mut() {
                *factor = factor.larger(low).smaller(high);
            }
            let limit = gain * DoubleDouble::from(layout.total.unwrap_or(layout.range.lighting_sum));
            let room = limit - factors.iter().copied().sum::<DoubleDouble>();
            if layout.total.is_some() || room < DoubleDouble::from(0.0) {
                let largest = factors.iter_mut().max_by(|a, b| a.to_f64().total_cmp(&b.to_f64()));
                largest.into_iter().for_each(|factor| *factor = *factor + room);
            }
        }
        rest
    }

    /// The end of a way down, with everything free.
    pub(super) fn polish(
        &self,
        temperatures: &Each<DoubleDouble>,
        rest: &Each<DoubleDouble>,
        free: &[usize],
    ) -> Found {
        let layout = self.model.layout;
        let (temperatures, rest, cost) = self.down(temperatures, rest, free, [1e-24, 1e-59], 200);
        let factors = self.model.factors(&rest, 0);
        let kelvin = |s: usize| {
            if free.contains(&s) {
                temperatures[s].exponential().to_f64()
            } else {
                temperature_k(self.model.own, s)
            }
        };
        let state = State {
            temperature_k: kelvin(0),
            lighting: (1..=layout.objects)
                .map(|k| {
                    if layout.lighting {
                        (factors[k] / factors[0]).to_f64()
                    } else {
                        self.model.own.lighting[k - 1]
                    }
                })
                .collect(),
            gain: factors[0].to_f64(),
            environment_k: (1..=layout.objects).map(kelvin).collect(),
        };
        Found { distance: (cost * self.model.scale).root(), state }
    }
}

impl<'a, R: Real> Search<'a, R> {
    pub(super) fn new(model: Model<'a, R>) -> Self {
        let linear = model.constraints(&[]);
        Self { model, linear }
    }

    /// Temperatures, gain and Cₖ at the end of the way down from there, the temperatures in `free` and all else free.
    pub(super) fn down(
        &self,
        temperatures: &Each<R>,
        rest: &Each<R>,
        free: &[usize],
        [settled, nothing]: [f64; 2],
        steps: usize,
    ) -> (Each<R>, Each<R>, R) {
        let objects = self.model.layout.objects;
        let fixed: Vec<Spectrum<R>> =
            (0..=objects).map(|s| self.model.spectrum(s, temperatures[s], false)).collect();
        let constraints = self.model.constraints(free);
        let mut longest = [f64::INFINITY; MOST];
        longest[..free.len()].fill(LONGEST);
        let unknowns = self.model.layout.unknowns(free.len());
        let descent = Descent { unknowns, constraints: &constraints, longest, settled, nothing, steps };
        let mut start = [R::from(0.0); MOST];
        for (start, &s) in start.iter_mut().zip(free) {
            *start = temperatures[s];
        }
        let others = unknowns - free.len();
        start[free.len()..unknowns].copy_from_slice(&rest[..others]);
        let (z, cost) = descent.run(start, |z| {
            let moved: Vec<Spectrum<R>> =
                free.iter().zip(z).map(|(&s, &t)| self.model.spectrum(s, t, true)).collect();
            let mut spectra: Vec<&Spectrum<R>> = fixed.iter().collect();
            for (&s, spectrum) in free.iter().zip(&moved) {
                spectra[s] = spectrum;
            }
            self.model.evaluate(z, free, &spectra)
        });
        let (mut end, mut end_rest) = (*temperatures, *rest);
        for (&s, z) in free.iter().zip(&z) {
            end[s] = *z;
        }
        end_rest[..others].copy_from_slice(&z[free.len()..unknowns]);
        (end, end_rest, cost)
    }
}

pub(super) fn temperature_k(state: &State, spectrum: usize) -> f64 {
    spectrum.checked_sub(1).map_or(state.temperature_k, |k| state.environment_k[k])
}

/// Logarithms of all temperatures of a state.
pub(super) fn logarithms<R: Real>(state: &State) -> Each<R> {
    let mut all = [R::from(0.0); MOST];
    for (s, value) in all.iter_mut().enumerate().take(state.environment_k.len() + 1) {
        *value = R::from(temperature_k(state, s)).logarithm();
    }
    all
}
