//! Mean likelihood of a pixel's counts over all states of one surface, or of two that share the pixel (Laplace's method).
//!
//! N = Σₚ fₚ [A(Tₚ) + Σⱼ uₚⱼ Cⱼ] of one or two parts p ([`super::super::model`]), f the share of the first, 1 − f that of the other. Priors are
//! uniform: T in its range, u over all mixtures of the vertices, f between [`LEAST_SHARE`] and the rest. In coordinates z,
//!
//! * T = low + (high − low) s(z), f = least + (1 − 2 least) s(z), s(z) = 1/(1 + e⁻ᶻ), of density s(1 − s);
//! * uⱼ = e^{zⱼ}/Σₖ e^{zₖ}, z₀ = 0, of density (J − 1)! Πⱼ uⱼ for J vertices,
//!
//! nothing has a limit, and the density of the posterior falls off on every side, also where likelihoods are largest at a limit. With
//! Φ = D − 2 ln (density) at its least, H half its bend (Fisher's information and that of the density), n coordinates:
//!
//! −2 ln (mean likelihood) = Φ + ln det H − n ln 2π.
//!
//! That is right within 12 % of the likelihood for a coordinate of which nothing is known, within 8 % beside a limit, and exact far from it.
//! The way there is taken in T and the weights wₚⱼ = fₚuₚⱼ, in which N is linear but for T: Newton's steps, which the logarithms of
//! the density keep off the limits.
//!
//! | symbol | unit | what |
//! |---|---|---|
//! | D | | deviance of the counts |
//! | T | K | temperature of a part |
//! | f | | its share of the pixel |
//! | u | | weights of the vertices of its lighting |
//!
//! Assumptions: the gain is known; one mode holds most of the posterior.

mod factor;
mod way;

use crate::decompose::kernel::{compare, dot, emit, far_deviance, is_far, weighted};
use crate::decompose::model::{Hermite, MOST, Model};
use factor::{Factor, on_both_sides};
use hadar::simd::{Chunk, LANES, Largest, added, dispatched, fold, product};
use std::f64::consts::TAU;
use way::Way;

/// The smaller of two parts is at least so large.
pub(in crate::decompose) const LEAST_SHARE: f64 = 0.1;
/// Coordinates at most: a share, and temperature and lighting of two parts.
const MOST_COORDINATES: usize = 2 * MOST - 1;
/// Squared length, in deviations, of the last step.
const SHORT: f64 = 1e-2;
/// The same of a fit that costs nearly too much: so much less than that.
const ROUGH: f64 = 1.0;
const LITTLE: f64 = 12.0;
/// A share of a step that is no way any more.
const TINY: f64 = 1e-6;
/// A start is so far inside the range of temperatures, as a share of it.
const INSIDE: f64 = 1e-2;
const MOST_LOOKS: usize = 40;
/// After so many looks a fit that promises too little is given up.
const PATIENCE: usize = 4;
/// How often over what a step promises, or the last one brought, Φ may still fall, and what ln det H may besides.
const HOPE: f64 = 8.0;
const SLACK: f64 = 6.0;

/// One of the surfaces in a pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::decompose) struct Part {
    /// Its material in the model.
    pub(in crate::decompose) m: usize,
    pub(in crate::decompose) share: f64,
    pub(in crate::decompose) sigma_share: f64,
    pub(in crate::decompose) temperature_k: f64,
    pub(in crate::decompose) sigma_k: f64,
    mixture: [f64; MOST],
}

/// The posterior at its most.
#[derive(Debug, Clone, Copy)]
pub(in crate::decompose) struct Found {
    /// The second one is of no share for a single surface.
    pub(in crate::decompose) parts: [Part; 2],
    pub(in crate::decompose) deviance: f64,
    /// −2 ln of the mean likelihood.
    pub(in crate::decompose) cost: f64,
}

/// A number for each coordinate.
type Point = [f64; MOST_COORDINATES];
/// Rows of a symmetric matrix.
type Square = [Point; MOST_COORDINATES];

/// Room for the work, and what was seen at the last look.
#[derive(Debug, Default)]
pub(in crate::decompose) struct Room {
    planes: Vec<f64>,
    /// Slope and information of the first one's share, then of T and u but the first of each part.
    slope: Point,
    information: Square,
    pub(super) looks: u64,
}

impl Part {
    fn weight(&self, j: usize) -> f64 {
        self.share * self.mixture[j]
    }

    /// Where its temperature is in the range, as a share of it.
    fn place(&self, model: &Model) -> f64 {
        let [low, high] = model.range_k;
        (self.temperature_k - low) / (high - low)
    }
}

/// Parts of equal shares, each lit by the middle of what is possible.
pub(super) fn start<const P: usize>(model: &Model, ms: [usize; P], temperatures_k: [f64; P]) -> [Part; P] {
    let [low, high] = model.range_k;
    std::array::from_fn(|p| {
        let mut mixture = [0.0; MOST];
        mixture[..model.vertices].fill(1.0 / model.vertices as f64);
        let within = INSIDE * (high - low);
        Part {
            m: ms[p],
            share: 1.0 / P as f64,
            sigma_share: 0.0,
            temperature_k: temperatures_k[p].clamp(low + within, high - within),
            sigma_k: 0.0,
            mixture,
        }
    })
}

/// Where the share of the first part is between its limits.
fn place_of(share: f64) -> f64 {
    (share - LEAST_SHARE) / (1.0 - 2.0 * LEAST_SHARE)
}

dispatched! {
    /// χ² and deviance at a state, slope and information into `room`; the largest |n′ − N′|/(n′ + N′).
    fn accumulate<'a>(model: &'a Model, parts: &'a [Part], counts: &'a [f64], room: &'a mut Room) -> (f64, f64) {
        let (width, vertices) = (model.width, model.vertices);
        let count = parts.len() - 1 + parts.len() * vertices;
        room.planes.resize(width * (5 + count), 0.0);
        let (mean, rest) = room.planes.split_at_mut(width);
        let (weight, rest) = rest.split_at_mut(width);
        let (relative, rest) = rest.split_at_mut(width);
        let (series, rest) = rest.split_at_mut(width);
        let (sent, columns) = rest.split_at_mut(width);
        mean.copy_from_slice(&model.var_added);
        if parts.len() > 1 {
            columns[..width].fill(0.0);
        }
        for (p, part) in parts.iter().enumerate() {
            let place = model.place(part.temperature_k);
            let hermite = Hermite::at(place.share);
            let emission = model.emission(part.m, place.row);
            emit(hermite.value, emission, sent);
            for (j, u) in part.mixture[..vertices].iter().enumerate() {
                sent.iter_mut().zip(model.scattered_of(part.m, j)).for_each(|(n, c)| *n = u.mul_add(*c, *n));
            }
            mean.iter_mut().zip(&*sent).for_each(|(mean, n)| *mean = part.share.mul_add(*n, *mean));
            if parts.len() > 1 {
                let sign: f64 = if p == 0 { 1.0 } else { -1.0 };
                columns[..width].iter_mut().zip(&*sent).for_each(|(to, n)| *to = sign.mul_add(*n, *to));
            }
            let at = parts.len() - 1 + p * vertices;
            let own = &mut columns[at * width..(at + vertices) * width];
            let (slope, lights) = own.split_at_mut(width);
            emit(hermite.slope, emission, slope);
            let per_kelvin = part.share / place.step_k;
            slope.iter_mut().for_each(|slope| *slope *= per_kelvin);
            for (to, from) in lights.chunks_exact_mut(width).zip(model.columns(part.m)) {
                to.iter_mut().zip(from).for_each(|(to, c)| *to = part.share * c);
            }
        }
        compare(counts, mean, weight, relative, series);
        let mut worst = Largest::default();
        let mut total = [0.0; LANES];
        let chunks = mean.as_chunks::<LANES>().0.iter().zip(series.as_chunks::<LANES>().0);
        let (counts, relatives) = (counts.as_chunks::<LANES>().0, relative.as_chunks::<LANES>().0);
        for ((mean, s), (n, t)) in chunks.zip(counts.iter().zip(relatives)) {
            let residual: Chunk = std::array::from_fn(|i| n[i] - mean[i]);
            worst.see(std::array::from_fn(|i| residual[i] / (n[i] + mean[i])));
            total = added(product(residual, *t), *s, total);
        }
        for i in 0..count {
            let column = &columns[i * width..][..width];
            room.slope[i] = dot(column, relative);
            for j in 0..=i {
                let each = weighted(column, &columns[j * width..][..width], weight);
                (room.information[i][j], room.information[j][i]) = (each, each);
            }
        }
        (worst.value(), fold(&total))
    }
}

/// Deviance at a state.
fn look(model: &Model, parts: &[Part], counts: &[f64], room: &mut Room) -> f64 {
    room.looks += 1;
    let (worst, deviance) = accumulate(model, parts, counts, room);
    if is_far(worst) { far_deviance(counts, &room.planes[..model.width]) } else { deviance }
}

/// Coordinates of parts: the share of the first of two, then the temperature and the lighting of each.
fn temperature_at(model: &Model, parts: &[Part], p: usize) -> usize {
    parts.len() - 1 + p * model.vertices
}

/// −ln of the density in the coordinates z.
fn improbable(model: &Model, parts: &[Part]) -> f64 {
    let of_share = (parts.len() > 1).then(|| place_of(parts[0].share));
    let places = parts.iter().map(|part| part.place(model)).chain(of_share);
    let of_places: f64 = places.map(|s| libm::log(s * (1.0 - s))).sum();
    let lights = |part: &Part| -> f64 {
        // Of (J − 1)! one factor each.
        let each = part.mixture[..model.vertices].iter().enumerate();
        each.map(|(j, u)| libm::log(u * j.max(1) as f64)).sum()
    };
    -of_places - parts.iter().map(lights).sum::<f64>()
}

/// H in the coordinates z, and ∂f/∂z, ∂T/∂z.
fn bend(model: &Model, parts: &[Part], seen: &Room) -> (Factor, Point) {
    let (vertices, besides) = (model.vertices, parts.len() - 1);
    let count = besides + parts.len() * vertices;
    let [low, high] = model.range_k;
    let (mut rate, mut whole) = ([0.0; MOST_COORDINATES], seen.information);
    let mut of_density = [0.0; MOST_COORDINATES];
    let temperatures = parts
        .iter()
        .enumerate()
        .map(|(p, part)| (temperature_at(model, parts, p), part.place(model), high - low));
    let of_share = (besides > 0).then(|| (0, place_of(parts[0].share), 1.0 - 2.0 * LEAST_SHARE));
    for (at, s, width) in temperatures.chain(of_share) {
        (rate[at], of_density[at]) = (width * s * (1.0 - s), 2.0 * s * (1.0 - s));
    }
    // From f, T and u to z.
    let turn = |x: &mut Point| {
        for (at, rate) in rate.iter().enumerate().filter(|(_, rate)| **rate > 0.0) {
            x[at] *= rate;
        }
        for (p, part) in parts.iter().enumerate() {
            let at = temperature_at(model, parts, p);
            let mean: f64 = (1..vertices).map(|j| part.mixture[j] * x[at + j]).sum();
            (1..vertices).for_each(|j| x[at + j] = part.mixture[j] * (x[at + j] - mean));
        }
    };
    on_both_sides(&mut whole, count, turn);
    (0..count).for_each(|i| whole[i][i] += of_density[i]);
    for (p, part) in parts.iter().enumerate() {
        let at = temperature_at(model, parts, p);
        for j in 1..vertices {
            whole[at + j][at + j] += vertices as f64 * part.mixture[j];
            for k in 1..vertices {
                whole[at + j][at + k] -= vertices as f64 * part.mixture[j] * part.mixture[k];
            }
        }
    }
    (Factor::new(&whole, count), rate)
}

/// The most probable state of one or two parts from a start; nothing once it will cost more than `enough`.
pub(super) fn most_probable(
    model: &Model,
    start: &[Part],
    counts: &[f64],
    enough: f64,
    room: &mut Room,
) -> Option<Found> {
    hadar::stop::check();
    let (mut own, mut before) = ([start[0], start[start.len() - 1]], None);
    let mut looks = 0;
    loop {
        let parts = &mut own[..start.len()];
        let deviance = look(model, parts, counts, room);
        let phi = 2.0f64.mul_add(improbable(model, parts), deviance);
        looks += 1;
        if let Some((from, way, share, least)) = &mut before
            && (phi.is_nan() || phi > *least)
            && looks < MOST_LOOKS
            && *share > TINY
        {
            // A step too long: half of it.
            *share *= 0.5;
            let (from, way): (&[Part; 2], &Way) = (from, way);
            own = *from;
            way.go(model.vertices, &mut own[..start.len()], *share);
            continue;
        }
        let way = Way::new(model, parts, room);
        if way.gain.is_nan() {
            return None;
        }
        let mut ends = way.gain < SHORT || looks >= MOST_LOOKS;
        if ends || looks >= PATIENCE {
            let (factor, rate) = bend(model, parts, room);
            let volume = factor.logarithm() - factor.count as f64 * libm::log(TAU);
            let last = before.as_ref().map_or(f64::INFINITY, |(_, _, _, from)| from - phi);
            if HOPE.mul_add(-way.gain.max(last), phi) + volume > enough + SLACK {
                return None;
            }
            // What counts little need not be known well.
            ends |= way.gain < ROUGH && phi + volume > enough - LITTLE;
            if ends {
                let sigma = |at: usize| rate[at] * factor.sigma(at);
                for (p, part) in own[..start.len()].iter_mut().enumerate() {
                    part.sigma_k = sigma(temperature_at(model, start, p));
                    part.sigma_share = if start.len() > 1 { sigma(0) } else { 0.0 };
                }
                // What the last step brings, if it is short.
                let rest = if way.gain < ROUGH { way.gain.max(0.0) } else { 0.0 };
                return Some(Found { parts: own, deviance, cost: phi - rest + volume });
            }
        }
        let share = way.within(model, parts);
        let from = own;
        way.go(model.vertices, &mut own[..start.len()], share);
        before = Some((from, way, share, phi));
    }
}
