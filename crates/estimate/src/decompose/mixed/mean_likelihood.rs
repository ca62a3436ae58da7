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

use super::factor::{Factor, on_both_sides};
use super::parts::{LEAST_SHARE, MOST_COORDINATES, Part, Point, Room, look, place_of, temperature_at};
use super::way::Way;
use crate::decompose::model::Model;
use std::f64::consts::TAU;

/// Squared length, in deviations, of the last step.
const SHORT: f64 = 1e-2;
/// The same of a fit that costs nearly too much: so much less than that. At 12 instead of 6 some pairs count too little at few counts.
const ROUGH: f64 = 1.0;
const LITTLE: f64 = 6.0;
/// A share of a step that is no way any more.
const TINY: f64 = 1e-6;
const MOST_LOOKS: usize = 40;
/// After so many looks a fit that promises too little is given up.
const PATIENCE: usize = 4;
/// How often over what a step promises, or the last one brought, Φ may still fall, and what ln det H may besides.
const HOPE: f64 = 8.0;
const SLACK: f64 = 6.0;

/// The posterior at its most.
#[derive(Debug, Clone, Copy)]
pub(in crate::decompose) struct Found {
    /// The second one is of no share for a single surface.
    pub(in crate::decompose) parts: [Part; 2],
    /// Pearson's χ².
    pub(in crate::decompose) chi_square: f64,
    /// −2 ln of the mean likelihood.
    pub(in crate::decompose) cost: f64,
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
                return Some(Found { parts: own, chi_square: room.chi_square, cost: phi - rest + volume });
            }
        }
        let share = way.within(model, parts);
        let from = own;
        way.go(model.vertices, &mut own[..start.len()], share);
        before = Some((from, way, share, phi));
    }
}
