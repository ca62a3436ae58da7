//! Steps of one band from line to line, which neither its stripes nor the bands beside explain.
//!
//! Lines that are striped side by side leave two steps, at their first and at their last, as an edge of a material along the whole line
//! does; their own neighbours are as striped as they are, and no fit to these shows anything. A step is what the line has over the line
//! before, median over its segments, without the stripes that were found, over the level of the band. It counts where it is beyond those
//! of the bands beside (±3), by their range and half of their median more, and far beyond what the steps of other lines scatter by.

use super::fit::{median, scatter};
use super::found::Stripe;
use super::scan::Band;

/// Bands on each side, and the fewest of them.
const BESIDE: usize = 3;
const FEWEST: usize = 3;
/// Deviations above which a step counts.
const STEP: f64 = 8.0;
/// Share of the steps that is not striped, and the normal deviate of it.
const MOST: (usize, f64) = (80, 1.281_552);

/// Steps of a band, NaN where a line is not there or not to be looked at; that from line l to l + 1 is the l-th.
pub(super) fn steps(band: &Band, lines: usize, stripes: &[&Stripe], kept: &[usize]) -> Vec<f64> {
    let line = |line: usize| -> Vec<f64> {
        if kept.contains(&line) {
            return Vec::new();
        }
        let own = stripes.iter().find(|stripe| stripe.line == line);
        let mean = |mean: &f64| own.map_or(*mean, |stripe| stripe.corrected(*mean));
        band.means(line).iter().map(mean).collect()
    };
    let step = |l: usize| {
        let (before, after) = (line(l), line(l + 1));
        let mut apart: Vec<f64> = before
            .iter()
            .zip(&after)
            .map(|(before, after)| after - before)
            .filter(|d| d.is_finite())
            .collect();
        median(&mut apart) / band.level.abs()
    };
    (0..lines.saturating_sub(1)).map(step).collect()
}

/// Lines after which a band has a step of its own, of the steps of all bands.
pub(super) fn own_steps(steps: &[Vec<f64>], band: usize) -> Vec<usize> {
    let Some(own) = steps.get(band) else { return Vec::new() };
    let others = band.saturating_sub(BESIDE)..(band + BESIDE + 1).min(steps.len());
    let beside = |l: usize| -> Vec<f64> {
        let others = others.clone().filter(|other| *other != band);
        others.filter_map(|other| steps.get(other)?.get(l).copied()).filter(|step| step.is_finite()).collect()
    };
    let apart: Vec<[f64; 2]> = own
        .iter()
        .enumerate()
        .map(|(l, own)| {
            let mut beside = beside(l);
            if beside.len() < FEWEST || !own.is_finite() {
                return [f64::NAN; 2];
            }
            let middle = median(&mut beside);
            let low = beside.iter().copied().fold(f64::INFINITY, f64::min) - 0.5 * middle.abs();
            let high = beside.iter().copied().fold(f64::NEG_INFINITY, f64::max) + 0.5 * middle.abs();
            [own - middle, own - own.max(low).min(high)]
        })
        .collect();
    let mut sizes: Vec<f64> = apart.iter().map(|apart| apart[0]).filter(|apart| apart.is_finite()).collect();
    if sizes.is_empty() {
        return Vec::new();
    }
    let middle = scatter(&sizes);
    sizes.iter_mut().for_each(|size| *size = size.abs());
    sizes.sort_by(f64::total_cmp);
    let far = sizes.get(sizes.len() * MOST.0 / 100).copied().unwrap_or(0.0) / MOST.1;
    let sigma = middle.max(far);
    let is = |(l, apart): (usize, &[f64; 2])| {
        (apart[0].abs() > STEP * sigma && apart[1].abs() > 0.5 * STEP * sigma).then_some(l)
    };
    apart.iter().enumerate().filter_map(is).collect()
}
