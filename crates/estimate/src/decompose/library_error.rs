//! Maximum likelihood where the emissivities of the library are themselves not exact.
//!
//! With errors δ of the emissivity in each band, of covariance Σ, a pixel's counts have the covariance
//! C = diag(N′) + D Σ D, D_w = κ_w ∫ (B(T) − X) over band w: what a change of the emissivity changes. The cost is the Gaussian
//! rᵀC⁻¹r + ln det C, C at the state at hand, without any mode left out ([`filter`]).
//!
//! Σ_vw = s² e_v e_w (1 + x + x²/3) e⁻ˣ, x = 3.55 |ν_v − ν_w|/ℓ (Matérn, 5/2): errors of laboratory spectra are smooth, but not
//! without an end. s: root mean square error as a share of the emissivity e, ℓ: where the correlation has fallen to a quarter.
//!
//! What is stated of s is the most that a spectrum is off; one material's may be better than another's. Among materials each is
//! therefore worth what its cost is at the best s between 0 and the stated one ([`LADDER`]): else a library that is better than its user
//! says would lose, by ln det C, against a mirror of surroundings that are taken for exact. Temperature, deviations and χ² are those at
//! the stated s. As χ² is least with all of the errors and ln det C without any, χ² + Σ ln N′ at the stated s is what a material costs at
//! least: one that costs more even so is fitted at no other.
//!
//! Assumptions: the errors of the materials are Gaussian and independent of each other; each pixel is taken for itself, so that what
//! pixels of one material share of an error does not average out in them.

mod filter;
mod other;
mod with_errors;

use super::fit::{COMPARED, Fit};
use super::kernel::Sums;
use super::model::{Hermite, Model};
use super::screen::MOST_STARTS;
use super::step::State;
use super::thresholds::NO_FIT;
use filter::{BEFORE, Found, Law, filter, logarithm_of_all, room_for};
use hadar::aligned::Aligned;
use hadar::correlation::matern;
use hadar::error::{Error, Result, check};
use hadar::simd::{LANES, dispatched};
use hadar::statistics::chi_square_survival;
pub(super) use other::Other;

/// Shares of the stated error at which materials are compared, besides all of it.
const LADDER: [f64; 5] = [0.5, 0.25, 0.125, 0.0625, 0.0];
/// Cost beyond what still counts from which on the share of the errors is no matter.
const BESIDE: f64 = 6.0;
/// Cost beyond what a material has at another share from which on a share is not looked at again: more than steps still bring.
const WORSE: f64 = 10.0;
/// Share of the χ² that a step promises which all further steps leave: C is that of the state at hand, and its contrast may grow.
const HOPE: f64 = 0.25;
/// Length of the last step, squared, in deviations, of the fit that is told.
const TOLD: f64 = 1e-3 * COMPARED;
/// Looks of a fit at most.
const MOST_LOOKS: usize = 60;
/// Fewest counts of a model.
const FEWEST: f64 = 1e-6;

/// How wrong the emissivities of a library may be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LibraryError {
    /// Root mean square error s of an emissivity, as a share of it.
    pub relative: f64,
    /// Difference ℓ of wavenumbers at which the correlation of errors has fallen to a quarter, cm⁻¹.
    pub correlation_cm1: f64,
}

/// A [`LibraryError`] in the bands that count.
#[derive(Debug)]
pub(super) struct Errors {
    relative: f64,
    law: Law,
    /// No eigenvalue of the covariance of the relative errors is larger.
    pub(super) largest: f64,
    /// χ² from which on nothing fits, of each number of degrees of freedom.
    misfits: Vec<f64>,
}

impl Errors {
    pub(super) fn new(model: &Model, error: LibraryError) -> Result<Self> {
        let LibraryError { relative, correlation_cm1 } = error;
        check::positive("error of the emissivities", relative, "")?;
        check::positive("correlation of the errors of the emissivities", correlation_cm1, "cm^-1")?;
        let misfits = (0..=model.used.len()).map(misfit).collect();
        let nu = &model.centres_cm1;
        let row = |a: &f64| nu.iter().map(|b| matern(a - b, correlation_cm1)).sum::<f64>();
        let largest = relative * relative * nu.iter().map(row).fold(0.0, f64::max);
        Ok(Self { relative, law: Law::new(nu, correlation_cm1), largest, misfits })
    }
}

/// χ² whose p-value is [`NO_FIT`]; none without a degree of freedom.
fn misfit(freedom: usize) -> f64 {
    if freedom == 0 {
        return f64::INFINITY;
    }
    let (mut low, mut high) = (0.0, 100.0 + 10.0 * freedom as f64);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        let side = if chi_square_survival(middle, freedom as f64) < NO_FIT { &mut high } else { &mut low };
        *side = middle;
    }
    high
}

/// A fit that is asked for.
#[derive(Debug, Clone, Copy)]
struct Asked {
    kind: usize,
    m: usize,
    /// Of the stated errors.
    share: f64,
    start: State,
    /// The last step is this short, squared.
    short: f64,
    /// What a material must not cost at least, of which χ² may still lose most, to be looked at again.
    beside: f64,
    /// What it must not cost.
    worse: f64,
}

/// A fit under way.
#[derive(Debug, Clone, Copy)]
struct Lane {
    asked: Asked,
    state: State,
    best: Option<Fit>,
    looks: usize,
}

/// Room for one pixel's work.
#[derive(Debug, Default)]
pub(super) struct Workplace {
    queue: Vec<Asked>,
    lanes: [Option<Lane>; LANES],
    /// Fits that came to their end, with Σ ln N′ there.
    done: Vec<(Asked, Fit, f64)>,
    /// What each kind costs at least.
    floors: Vec<f64>,
    /// One state, `[…][band]`: N′, reach, r and the columns.
    state: Aligned,
    /// All lanes: `[N′, reach, r, columns][band][lane]`.
    rows: Aligned,
    found: Found,
}

dispatched! {
    /// N′, what the errors reach, r and the columns at a state, one after the other.
    fn describe<'a>(model: &'a Model, asked: &'a Asked, state: &'a State, size: f64, shifted: &'a [f64], to: &'a mut [f64]) {
        let (m, width) = (asked.m, model.width);
        let mixture = &state.mixture[..model.vertices];
        let place = model.place(state.temperature_k);
        let hermite = Hermite::at(place.share);
        let scale = model.scale(mixture);
        let (mean, rest) = to.split_at_mut(width);
        let (reach, rest) = rest.split_at_mut(width);
        let (residual, columns) = rest.split_at_mut(width);
        let (slope, columns) = columns.split_at_mut(width);
        mix(hermite.value, model.emission_of_blackbody(place.row), reach);
        reach.iter_mut().for_each(|reach| *reach *= scale);
        for (j, u) in mixture.iter().enumerate() {
            reach.iter_mut().zip(model.light(j)).for_each(|(reach, light)| *reach = (-u).mul_add(*light, *reach));
        }
        let factor = size * asked.share;
        reach.iter_mut().zip(model.emissivity(m)).for_each(|(reach, e)| *reach *= factor * e);
        let [v0, s0, v1, s1, factor] = model.emission(m, place.row);
        mix(hermite.value, [v0, s0, v1, s1], mean);
        mix(hermite.slope, [v0, s0, v1, s1], slope);
        let per_kelvin = scale / place.step_k;
        for ((mean, slope), factor) in mean.iter_mut().zip(slope).zip(factor) {
            (*mean, *slope) = (*mean * factor, *slope * factor * per_kelvin);
        }
        for (to, from) in columns.chunks_exact_mut(width).zip(model.columns(m)) {
            match model.gain {
                true => to.iter_mut().zip(from.iter().zip(&*mean)).for_each(|(to, (c, value))| *to = c + value),
                false => to.copy_from_slice(from),
            }
        }
        mean.iter_mut().zip(&*model.var_added).for_each(|(mean, var)| *mean = scale.mul_add(*mean, *var));
        for (j, u) in mixture.iter().enumerate() {
            mean.iter_mut().zip(model.scattered_of(m, j)).for_each(|(mean, c)| *mean = u.mul_add(*c, *mean));
        }
        for ((mean, residual), n) in mean.iter_mut().zip(residual).zip(shifted) {
            *mean = if *mean > FEWEST { *mean } else { FEWEST };
            *residual = n - *mean;
        }
    }
}

/// Values or slopes of the table, mixed in these shares.
#[inline(always)]
fn mix(shares: [f64; 4], [a, b, c, d]: [&[f64]; 4], to: &mut [f64]) {
    let [p, q, r, s] = shares;
    for ((to, a), (b, (c, d))) in to.iter_mut().zip(a).zip(b.iter().zip(c.iter().zip(d))) {
        *to = p.mul_add(*a, q.mul_add(*b, r.mul_add(*c, s * d)));
    }
}

impl Workplace {
    /// The best state of a material from a start, with the stated errors; `to` is what was seen at the last look.
    pub(super) fn fit(
        &mut self,
        model: &Model,
        errors: &Errors,
        m: usize,
        shifted: &[f64],
        start: State,
        to: &mut Sums,
    ) -> (Fit, usize) {
        let none = f64::INFINITY;
        self.queue.push(Asked { kind: 0, m, share: 1.0, start, short: TOLD, beside: none, worse: none });
        let looks = self.run(model, errors, shifted, to);
        let nothing = Fit { state: start, deviance: f64::INFINITY, chi_square: f64::INFINITY };
        (self.done.pop().map_or(nothing, |(_, fit, _)| fit), looks)
    }

    /// Brings all that is queued to its end; how many looks that took.
    fn run(&mut self, model: &Model, errors: &Errors, shifted: &[f64], to: &mut Sums) -> usize {
        let (width, count) = (model.width, model.unknowns());
        let vectors = room_for(count + 1);
        let plane = width * LANES;
        if self.rows.len() != (BEFORE + vectors) * plane {
            self.state = Aligned::zeros(width * (BEFORE + count + 1));
            self.rows = Aligned::zeros((BEFORE + vectors) * plane);
            // What an idle lane holds must be numbers.
            self.rows[..plane].fill(1.0);
        }
        let rows: &mut [f64] = &mut self.rows;
        let described: &mut [f64] = &mut self.state;
        let mut looks = 0;
        loop {
            hadar::stop::check();
            for (i, lane) in self.lanes.iter_mut().enumerate() {
                if lane.is_none() {
                    *lane = self.queue.pop().map(|asked| Lane {
                        asked,
                        state: asked.start,
                        best: None,
                        looks: 0,
                    });
                }
                let Some(Lane { asked, state, looks, .. }) = lane else { continue };
                describe(model, asked, state, errors.relative, shifted, described);
                // What a lighting changes does not depend on the state of a calibrated camera.
                let changed = if model.gain || *looks == 0 { BEFORE + 1 + count } else { BEFORE + 2 };
                let planes = rows.chunks_exact_mut(plane).zip(described.chunks_exact(width));
                for (plane, values) in planes.take(changed) {
                    for (chunk, value) in plane.as_chunks_mut::<LANES>().0.iter_mut().zip(values) {
                        chunk[i] = *value;
                    }
                }
            }
            if self.lanes.iter().all(Option::is_none) {
                return looks;
            }
            filter(&errors.law, rows, vectors, &mut self.found);
            for i in 0..LANES {
                let Some(mut lane) = self.lanes[i] else { continue };
                let least = take(&self.found, i, count, to);
                looks += 1;
                lane.looks += 1;
                self.lanes[i] = match lane.step(model, least, to) {
                    Some(fit) => {
                        self.done.push((lane.asked, fit, least));
                        None
                    }
                    None => Some(lane),
                };
            }
        }
    }
}

impl Workplace {
    /// Takes what is done into the fits of the kinds, the cost of each the least of any share.
    fn collect(&mut self, handicap: &[f64], fits: &mut [(usize, Fit)]) {
        for (Asked { kind, share, .. }, fit, least) in self.done.drain(..) {
            let (deviance, (_, best)) = (fit.deviance + handicap[kind], &mut fits[kind]);
            if share == 1.0 {
                self.floors[kind] = self.floors[kind].min(fit.chi_square + least + handicap[kind]);
                if deviance < best.deviance {
                    *best = Fit { deviance, ..fit };
                }
            } else {
                best.deviance = best.deviance.min(deviance);
            }
        }
    }
}

/// The sums of a lane; Σ ln N′.
fn take(found: &Found, lane: usize, count: usize, to: &mut Sums) -> f64 {
    let (whole, least) = found.logarithms(lane);
    to.chi_square = found.products[0][0][lane];
    to.deviance = to.chi_square + whole;
    for i in 0..count {
        to.slope[i] = found.products[0][i + 1][lane];
        for j in i..count {
            let each = found.products[i + 1][j + 1][lane];
            (to.information[i][j], to.information[j][i]) = (each, each);
        }
    }
    least
}

impl Lane {
    /// Goes on from what was seen; the fit where that is its end. The sums stay those before the last step.
    fn step(&mut self, model: &Model, least: f64, seen: &Sums) -> Option<Fit> {
        let mut next = self.state;
        let step = next.step(seen, &model.limits());
        let less = step.square.max(0.0);
        let here = Fit { state: next, deviance: seen.deviance - less, chi_square: seen.chi_square - less };
        let short = step.square.is_nan() || step.square < self.asked.short;
        let hopeless =
            HOPE.mul_add(here.chi_square, least) > self.asked.beside || here.deviance > self.asked.worse;
        let worse = self.best.is_some_and(|best| seen.deviance > best.deviance + 1.0);
        if short || worse || self.looks >= MOST_LOOKS || hopeless {
            // C is that of the state at hand: where a step raises the cost, what was found before it stays.
            return Some(self.best.filter(|best| best.deviance < here.deviance).unwrap_or(here));
        }
        self.best = Some(Fit { state: self.state, deviance: seen.deviance, chi_square: seen.chi_square });
        self.state = next;
        None
    }
}

#[cfg(test)]
pub(in crate::decompose) mod tests;
