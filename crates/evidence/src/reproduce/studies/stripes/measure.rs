//! Bounds and errors at one share of striped lines.

use super::information::{LineKnown, LineSample, information};
use super::twin::{BANDS, COLUMNS, Put, ROWS, Twin};
use hadar::error::Result;
use hadar_estimate::calibrate::{Axis, Destriped, Sought, Stripe, find_stripes};
use std::collections::BTreeMap;

pub(super) const SOUGHT: Sought = Sought { axis: Axis::Rows, gain_deviation: 0.1, in_all_bands: false };
/// Pixels of a window along each axis, and between two windows.
const WINDOW: usize = 15;
const STEP: usize = 18;
/// Every such pixel is read as a temperature.
const PIXELS: usize = 3;

/// What was measured.
#[derive(Debug, Clone, Default)]
pub(super) struct Row {
    pub(super) share: f64,
    pub(super) put: usize,
    pub(super) found: usize,
    pub(super) wrong: usize,
    /// Share of the found ones whose 95 % interval holds how far they are off.
    pub(super) held: f64,
    /// Root mean square of how far striped lines are off over their level, before and after.
    pub(super) off: [f64; 2],
    /// Information over the clean one, along and across the lines: unknown lines, destriped.
    pub(super) unknown: [f64; 2],
    pub(super) destriped: [f64; 2],
    /// The same where every line is unknown.
    pub(super) all_unknown: [f64; 2],
    /// Root mean square errors of estimated positions over the clean bound's, along and across: clean, striped, destriped cube.
    pub(super) position: [[f64; 3]; 2],
    /// Deviation of the temperature of a pixel by the bound, K: clean, unknown, destriped.
    pub(super) temperature_bound_k: [f64; 3],
    /// Root mean square errors of it, K: clean, striped, destriped cube.
    pub(super) temperature_k: [f64; 3],
}

/// What is known of each line.
type Known = BTreeMap<(usize, usize), Stripe>;

pub(super) fn measured(twin: &Twin, share: f64, cubes: u64, seed: u64, stream: u64) -> Result<Row> {
    let mut row = Row { share, ..Row::default() };
    let mut sums = Sums::default();
    for cube in 0..cubes {
        let clean = twin.drawn(seed, stream + 4 * cube)?;
        let (samples, put) = twin.striped(&clean, share, seed, stream + 4 * cube + 1);
        let cube = twin.cube(samples.clone())?;
        let seen = find_stripes(&cube, &SOUGHT)?;
        let corrected = seen.corrected(&cube)?;
        let known: Known = seen.stripes.iter().map(|one| ((one.line, one.band), *one)).collect();
        lines(twin, &put, &seen, &known, &mut row, &mut sums);
        let cubes = [clean.as_slice(), &samples, &corrected];
        positions(twin, &put, &known, cubes, &mut sums);
        temperatures(twin, &put, &known, cubes, &mut sums);
    }
    row.held = sums.held / (row.found - row.wrong).max(1) as f64;
    row.off = sums.off.map(|sum| (sum / sums.lines.max(1.0)).sqrt());
    let windows = sums.windows;
    for axis in 0..2 {
        row.unknown[axis] = sums.ratio[axis][0] / windows;
        row.destriped[axis] = sums.ratio[axis][1] / windows;
        row.all_unknown[axis] = sums.ratio[axis][2] / windows;
        row.position[axis] = sums.position[axis].map(|sum| (sum / windows).sqrt());
    }
    row.temperature_bound_k = sums.bound_k2.map(|sum| (sum / sums.pixels).sqrt());
    row.temperature_k = sums.error_k2.map(|sum| (sum / sums.pixels).sqrt());
    Ok(row)
}

#[derive(Debug, Default)]
struct Sums {
    held: f64,
    off: [f64; 2],
    lines: f64,
    windows: f64,
    ratio: [[f64; 3]; 2],
    position: [[f64; 3]; 2],
    pixels: f64,
    bound_k2: [f64; 3],
    error_k2: [f64; 3],
}

fn lines(twin: &Twin, put: &[Put], seen: &Destriped, known: &Known, row: &mut Row, sums: &mut Sums) {
    row.put += put.len();
    row.found += seen.stripes.len();
    let there = |one: &Stripe| put.iter().any(|put| (put.line, put.band) == (one.line, one.band));
    row.wrong += seen.stripes.iter().filter(|one| !there(one)).count();
    for put in put {
        let level = twin.level[put.band];
        let own = known.get(&(put.line, put.band));
        let at = own.map_or(level, |one| one.level);
        let before = put.gain * at + put.offset - at;
        let after = own.map_or(before, |one| one.corrected(at + before) - at);
        sums.off[0] += (before / level).powi(2);
        sums.off[1] += (after / level).powi(2);
        sums.lines += 1.0;
        if let Some(one) = own {
            sums.held += f64::from(u8::from(after.abs() <= 1.96 * one.sigma_common(at)));
        }
    }
}

/// Information of a shift of each window, and what a shift is estimated to be where there is none.
fn positions(twin: &Twin, put: &[Put], known: &Known, cubes: [&[f64]; 3], sums: &mut Sums) {
    let striped: std::collections::BTreeSet<(usize, usize)> =
        put.iter().map(|put| (put.line, put.band)).collect();
    let place = |row: usize, column: usize, band: usize| (row * COLUMNS + column) * BANDS + band;
    for top in (2..ROWS - WINDOW - 2).step_by(STEP) {
        for left in (2..COLUMNS - WINDOW - 2).step_by(STEP) {
            sums.windows += 1.0;
            for axis in 0..2 {
                let [mut whole, mut unknown, mut destriped, mut all] = [0.0; 4];
                let mut score = [0.0; 3];
                for row in top..top + WINDOW {
                    for band in 0..BANDS {
                        let mut line = Vec::with_capacity(WINDOW);
                        for column in left..left + WINDOW {
                            let i = place(row, column, band);
                            let derivative = match axis {
                                0 => {
                                    0.5 * (twin.mean[place(row, column + 1, band)]
                                        - twin.mean[place(row, column - 1, band)])
                                }
                                _ => {
                                    0.5 * (twin.mean[place(row + 1, column, band)]
                                        - twin.mean[place(row - 1, column, band)])
                                }
                            };
                            let sample = LineSample { mean: twin.mean[i], derivative, var: twin.var(i) };
                            for (score, cube) in score.iter_mut().zip(cubes) {
                                *score += derivative * (cube[i] - sample.mean) / sample.var;
                            }
                            line.push(sample);
                        }
                        let key = (row, band);
                        let full = information(&line, LineKnown::ALL);
                        let none = information(&line, LineKnown::NOTHING);
                        whole += full;
                        all += none;
                        unknown += if striped.contains(&key) { none } else { full };
                        destriped += match known.get(&key) {
                            Some(one) => information(&line, line_known(one)),
                            None => full,
                        };
                    }
                }
                for (sum, left) in sums.ratio[axis].iter_mut().zip([unknown, destriped, all]) {
                    *sum += left / whole;
                }
                // δ = score/J, over the bound's deviation 1/√J.
                for (sum, score) in sums.position[axis].iter_mut().zip(score) {
                    *sum += score * score / whole;
                }
            }
        }
    }
}

fn line_known(one: &Stripe) -> LineKnown {
    LineKnown { sigma_gain: one.sigma_gain, sigma_offset: one.sigma, level: one.level }
}

/// Temperatures of pixels, from all bands, each weighed by its noise and what its line may be off by.
fn temperatures(twin: &Twin, put: &[Put], known: &Known, cubes: [&[f64]; 3], sums: &mut Sums) {
    let striped: std::collections::BTreeSet<(usize, usize)> =
        put.iter().map(|put| (put.line, put.band)).collect();
    for row in 0..ROWS {
        for column in (row % PIXELS..COLUMNS).step_by(PIXELS) {
            sums.pixels += 1.0;
            let (mut whole, mut unknown, mut destriped) = (0.0, 0.0, 0.0);
            let (mut plain, mut weighed) = ([0.0; 2], 0.0);
            for band in 0..BANDS {
                let i = (row * COLUMNS + column) * BANDS + band;
                let (mean, slope, var) = (twin.mean[i], twin.per_kelvin[i], twin.var(i));
                let own = known.get(&(row, band)).map_or(0.0, |one| one.sigma_common(mean).powi(2));
                whole += slope * slope / var;
                unknown += if striped.contains(&(row, band)) { 0.0 } else { slope * slope / var };
                destriped += slope * slope / (var + own);
                plain[0] += slope * (cubes[0][i] - mean) / var;
                plain[1] += slope * (cubes[1][i] - mean) / var;
                weighed += slope * (cubes[2][i] - mean) / (var + own);
            }
            let bounds = [whole, unknown, destriped].map(f64::recip);
            sums.bound_k2.iter_mut().zip(bounds).for_each(|(sum, bound)| *sum += bound);
            let errors = [plain[0] / whole, plain[1] / whole, weighed / destriped];
            sums.error_k2.iter_mut().zip(errors).for_each(|(sum, error)| *sum += error * error);
        }
    }
}
