//! Temperatures of random pixels against their Cramér–Rao bound.

use crate::reproduce::pixels::{Street, rms};
use hadar::error::Result;
use hadar_estimate::decompose::{Method, flag};

const PIXELS: usize = 2000;
/// Deviations that hold 95 %.
const NINETY_FIVE: f64 = 1.959_963_984_540_054;

/// How good temperatures are at one number of photons.
#[derive(Debug, Clone, Copy)]
pub(super) struct Read {
    pub(super) photons: f64,
    /// Share of pixels of right material within all limits, and those of right material that a limit holds.
    pub(super) open: f64,
    pub(super) held: f64,
    /// Of the open ones: error over the bound at the truth, rms; share of intervals that hold the truth.
    pub(super) over_bound: f64,
    pub(super) covered: f64,
    /// Share of intervals of those that a limit holds.
    pub(super) covered_held: f64,
    /// Of pixels of any material: rms error and rms bound of their own, K.
    pub(super) rmse_k: f64,
    pub(super) bound_k: f64,
}

pub(super) fn read(street: &Street, photons: f64, seed: u64, stream: u64) -> Result<Read> {
    let pixels = street.pixels(PIXELS, seed.wrapping_add(1))?;
    let counts = street.drawn(&pixels, photons, seed, stream)?;
    let maps = street.decomposed(Method::Ml, &street.library, counts, photons)?;
    let bounds = street.bounds_k(&pixels, photons)?;
    let off = |i: usize| f64::from(maps.temperature_k[i]) - pixels[i].state.temperature_k;
    let is_right = |i: &usize| usize::from(maps.material[*i]) == pixels[*i].material;
    let unknown = |i: &usize| maps.flags[*i] & flag::TEMPERATURE_UNKNOWN != 0;
    let right: Vec<usize> = (0..PIXELS).filter(|i| is_right(i) && !unknown(i)).collect();
    let limits = flag::LIGHTING_AT_LIMIT | flag::TEMPERATURE_AT_LIMIT;
    let (held, open): (Vec<usize>, Vec<usize>) =
        right.into_iter().partition(|i| maps.flags[*i] & limits != 0);
    let covered = |of: &[usize]| {
        let within = |i: &&usize| off(**i).abs() <= NINETY_FIVE * f64::from(maps.temperature_sigma_k[**i]);
        of.iter().filter(within).count() as f64 / of.len() as f64
    };
    Ok(Read {
        photons,
        open: open.len() as f64 / PIXELS as f64,
        held: held.len() as f64 / PIXELS as f64,
        over_bound: rms(open.iter().map(|i| off(*i) / bounds[*i])),
        covered: covered(&open),
        covered_held: covered(&held),
        rmse_k: rms((0..PIXELS).map(off)),
        bound_k: rms(bounds.iter().copied()),
    })
}
