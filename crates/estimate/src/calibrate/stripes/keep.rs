//! What looks striped and may be the scene's: left as it is, with the reason.

use super::found::{Kept, Stripe, Why};
use super::scan::Band;
use super::steps::{own_steps, steps};

/// Lines from a step within which nothing is a stripe: those that the lines at the step are compared with.
const NEAR: usize = 3;

/// Lines that hold nothing of the scene, and those that nothing is left to compare with.
pub(super) fn without_scene(bands: &[Band], lines: usize) -> Vec<Kept> {
    let of_band = |(band, own): (usize, &Band)| {
        let why = |line: usize| {
            let there = own.means(line).iter().filter(|mean| mean.is_finite()).count();
            if own.dead.get(line) == Some(&true) {
                return Some(Why::Dead);
            }
            if own.is_alone(line) {
                return Some(Why::WithoutReference);
            }
            (2 * there < own.means(line).len()).then_some(Why::Missing)
        };
        let kept = |line: usize| Some(Kept { line, band, why: why(line)?, off: f64::NAN });
        (0..lines).filter_map(kept).collect::<Vec<Kept>>()
    };
    bands.iter().enumerate().flat_map(of_band).collect()
}

/// Moves what does not follow a gain and an offset along its whole line.
pub(super) fn in_part(bands: &[Band], stripes: &mut Vec<Stripe>, kept: &mut Vec<Kept>) {
    let part = |stripe: &Stripe| {
        bands.get(stripe.band).is_some_and(|band| band.follows.get(stripe.line) == Some(&false))
    };
    keep(stripes, kept, Why::InPart, part);
}

/// Moves what is off the same way in bands side by side, as a feature of a material is; `stripes` by line and band.
pub(super) fn of_neighbouring_bands(stripes: &mut Vec<Stripe>, kept: &mut Vec<Kept>) {
    let mut off: Vec<(usize, usize, bool)> =
        stripes.iter().map(|one| (one.line, one.band, one.off > 0.0)).collect();
    off.extend(
        kept.iter().filter(|one| one.why == Why::InPart).map(|one| (one.line, one.band, one.off > 0.0)),
    );
    let alike = |stripe: &Stripe| {
        let beside = [stripe.band.checked_sub(1), Some(stripe.band + 1)];
        let same = |band: usize| off.contains(&(stripe.line, band, stripe.off > 0.0));
        beside.into_iter().flatten().any(same)
    };
    keep(stripes, kept, Why::NeighbouringBands, alike);
}

/// Moves what lies beside a step of its band that nothing explains, and names the lines at the step.
pub(super) fn beside_steps(
    bands: &[Band],
    lines: usize,
    left: &[usize],
    stripes: &mut Vec<Stripe>,
    kept: &mut Vec<Kept>,
) {
    let all: Vec<Vec<f64>> = (0..bands.len())
        .map(|own| {
            let taken: Vec<&Stripe> = stripes.iter().filter(|stripe| stripe.band == own).collect();
            let mut out = left.to_vec();
            out.extend(kept.iter().filter(|kept| kept.band == own).map(|kept| kept.line));
            bands.get(own).map_or_else(Vec::new, |band| steps(band, lines, &taken, &out))
        })
        .collect();
    for band in 0..bands.len() {
        let at = own_steps(&all, band);
        keep(stripes, kept, Why::BesideStep, |stripe| {
            stripe.band == band && at.iter().any(|l| stripe.line <= l + 1 + NEAR && stripe.line + NEAR >= *l)
        });
        for line in at.iter().flat_map(|l| [*l, l + 1]) {
            if !kept.iter().any(|kept| (kept.line, kept.band) == (line, band)) {
                kept.push(Kept { line, band, why: Why::BesideStep, off: f64::NAN });
            }
        }
    }
}

fn keep(stripes: &mut Vec<Stripe>, kept: &mut Vec<Kept>, why: Why, is: impl Fn(&Stripe) -> bool) {
    stripes.retain(|stripe| {
        let keeps = is(stripe);
        if keeps {
            kept.push(Kept { line: stripe.line, band: stripe.band, why, off: stripe.off });
        }
        !keeps
    });
}
