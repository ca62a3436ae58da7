//! What a line is off by in the bands beside: the scene, which bands have in common, and what is left for a stripe.

use super::fit::{Fitted, median};
use super::found::Stripe;
use super::scan::Band;

/// Deviations above which a line is off.
const OFF: f64 = 6.0;
/// Errors over those that clean lines have: lines beside may be striped by less than is seen. On twins without it intervals of 95 % hold
/// 90 % (little texture, a tenth of the lines striped) to 99 %.
const UNSEEN: f64 = 1.25;
/// Bands on each side that are looked at, and the fewest of them together.
const BESIDE: usize = 3;
const FEWEST: usize = 3;
/// Deviations above which what they say counts.
const TOLD: f64 = 3.0;
/// A normal deviate's deviation over its median absolute value; error of a median over that of a mean.
const PER_MEDIAN: f64 = 1.482_602;
const OF_MEDIAN: f64 = 1.253_314;

/// A line of a band: what is left of how far it is off, with the errors of its fit alone.
#[derive(Debug, Clone, Copy)]
struct Left {
    fit: Fitted,
    off: f64,
    sigma: f64,
    sigma_slope: f64,
}

/// What was found in a band.
#[derive(Debug)]
pub(super) struct Told {
    pub(super) stripes: Vec<Stripe>,
    /// Lines that look striped, clean ones however different from each other.
    pub(super) at_first_sight: usize,
    /// Least that a line must be off to be seen.
    pub(super) detectable: f64,
}

/// Lines that look clean in a band and are off from their neighbours all along by what the bands beside do not show.
pub(super) fn overlooked(bands: &[Band], band: usize) -> Vec<usize> {
    let Some(own) = bands.get(band) else { return Vec::new() };
    let left = left_of(bands, band, true);
    let of_line = inflation(clean(&left, own).map(|left| left.off / left.sigma).collect());
    let is = |(line, left): (usize, &Option<Left>)| {
        let left = (*left)?;
        let clean = own.candidate.get(line) == Some(&false);
        (clean && left.off.abs() > OFF * of_line * left.sigma && own.is_ridge(line)).then_some(line)
    };
    left.iter().enumerate().filter_map(is).collect()
}

/// The lines that look clean.
fn clean<'a>(left: &'a [Option<Left>], own: &'a Band) -> impl Iterator<Item = &'a Left> {
    let lines = left.iter().zip(&own.candidate).filter(|(_, candidate)| !**candidate);
    lines.filter_map(|(left, _)| left.as_ref())
}

/// What is left of every line of a band.
fn left_of(bands: &[Band], band: usize, shared: bool) -> Vec<Option<Left>> {
    let Some(own) = bands.get(band) else { return Vec::new() };
    let one = |(line, fit): (usize, &Option<Fitted>)| {
        let fit = (*fit)?;
        let [off, var] = if shared { beside(bands, band, line) } else { [0.0; 2] };
        let scatter = fit.scatter.max(own.least);
        let sigma = (scatter * scatter * fit.unit[0] + var).sqrt();
        Some(Left { fit, off: fit.off - off, sigma, sigma_slope: scatter * fit.unit[1].sqrt() })
    };
    own.fits.iter().enumerate().map(one).collect()
}

/// The stripes of a band; what bands beside have in common is the scene's, unless that is not to be.
pub(super) fn told(bands: &[Band], band: usize, shared: bool) -> Option<Told> {
    let own = bands.get(band)?;
    let left = left_of(bands, band, shared);
    let of_line = inflation(clean(&left, own).map(|left| left.off / left.sigma).collect());
    let of_slope = inflation(clean(&left, own).map(|left| left.fit.slope / left.sigma_slope).collect());
    let mut found = Told { stripes: Vec::new(), at_first_sight: 0, detectable: 0.0 };
    let mut errors = Vec::new();
    for (line, left) in left.iter().enumerate() {
        let Some(left) = left else { continue };
        // The prior holds the gain however much clean lines differ.
        let sigma_gain = |inflation: f64| (inflation * left.sigma_slope).min(own.prior);
        let off = |line: f64, slope: f64| {
            (left.off / (line * left.sigma)).hypot(left.fit.slope / sigma_gain(slope))
        };
        errors.push(of_line * left.sigma);
        if !own.candidate.get(line).copied().unwrap_or(false) {
            continue;
        }
        found.at_first_sight += usize::from(off(1.0, 1.0) > OFF);
        if off(of_line, of_slope) > OFF {
            let (sigma, sigma_gain, level) =
                (UNSEEN * of_line * left.sigma, sigma_gain(of_slope), left.fit.level);
            found.stripes.push(Stripe {
                line,
                band,
                gain: 1.0 + left.fit.slope,
                sigma_gain,
                offset: left.off - left.fit.slope * level,
                sigma_offset: sigma.hypot(sigma_gain * level),
                level,
                off: left.off,
                sigma,
            });
        }
    }
    found.detectable = OFF * median(&mut errors);
    Some(found)
}

/// How far the bands beside say that a line is off by what it shows, and the variance of that.
fn beside(bands: &[Band], band: usize, line: usize) -> [f64; 2] {
    let range = band.saturating_sub(BESIDE)..(band + BESIDE + 1).min(bands.len());
    let fit = |other: &Band| other.fits.get(line).copied().flatten().map(|fit| (fit, other.level));
    let others: Vec<(Fitted, f64)> =
        range.filter(|other| *other != band).filter_map(|other| bands.get(other).and_then(fit)).collect();
    let level = bands.get(band).map_or(0.0, |own| own.level);
    if others.len() < FEWEST {
        return [0.0; 2];
    }
    let relative: Vec<f64> = others.iter().map(|(fit, level)| fit.off / level).collect();
    let middle = median(&mut relative.clone());
    let mut apart: Vec<f64> = relative.iter().map(|x| (x - middle).abs()).collect();
    let mut formal: Vec<f64> =
        others.iter().map(|(fit, level)| fit.scatter * fit.unit[0].sqrt() / level.abs()).collect();
    let scatter = (PER_MEDIAN * median(&mut apart)).max(median(&mut formal));
    let sigma = OF_MEDIAN * scatter / (others.len() as f64).sqrt();
    match middle.abs() > TOLD * sigma {
        true => [middle * level, (sigma * level).powi(2)],
        false => [0.0; 2],
    }
}

/// How much more values scatter than by 1: what is widest of their middle and their tails.
fn inflation(mut values: Vec<f64>) -> f64 {
    values.iter_mut().for_each(|value| *value = value.abs());
    values.retain(|value| value.is_finite());
    if values.len() < 5 {
        return 1.0;
    }
    let middle = median(&mut values) * PER_MEDIAN;
    let place = (values.len() * 95 / 100).min(values.len() - 1);
    let far = *values.select_nth_unstable_by(place, f64::total_cmp).1 / 1.96;
    middle.max(far).max(1.0)
}
