//! Probabilities and information against extended precision, and exact errors against sums over all counts.

use super::draw::Draw;
use super::findings::Findings;
use crate::reference::Extended;
use crate::reference::probability::{information_bits, mutual_information_bits, normal_tail, poisson_error};
use hadar::error::Result;
use hadar::identifiability::detection;
use hadar::identifiability::ratio::RatioLaw;
use hadar::statistics::Statistics;

/// Largest distance whose miss probability is not below all doubles.
const FARTHEST: f64 = 37.5;

/// Distances from 0 to [`FARTHEST`].
pub(super) fn detection(draw: &mut Draw, found: &mut Findings) {
    let d = match draw.below(8) {
        0 => 0.0,
        1 | 2 => draw.scale(1e-300, 1e-3),
        _ => draw.between(0.0, FARTHEST),
    };
    let bound = 1e-15 * (10.0 + d * d);
    let (miss, hit) = (normal_tail(d), normal_tail(-d));
    let answers = [
        ("detection probability", detection::probability(d), hit),
        ("miss probability", detection::miss_probability(d), miss.clone()),
        ("information", detection::information_bits(d), information_bits(d)),
        ("mutual information", detection::mutual_information_bits(d), mutual_information_bits(d)),
    ];
    for (what, value, exact) in answers {
        found.require(value.is_finite(), || format!("{what} is {value}"));
        if exact.abs().to_f64() < 1e-290 {
            // What is lost here is lost to doubles.
            found.require(value.abs() <= 1e-290, || format!("{what} is {value:e} where it is nothing"));
            continue;
        }
        let error = Extended::from(value).relative_error_to(&exact);
        found.check(&format!("{what} at d = {d:e}"), error, bound);
    }
    let bracket = detection::error_bracket(d);
    let miss = miss.to_f64();
    found.require(bracket.lower <= miss * (1.0 + bound) && miss <= bracket.upper * (1.0 + bound), || {
        format!("{bracket:?} does not hold {miss:e}")
    });
    back(draw, found);
}

/// From a probability to its distance and back: the miss probability must be the one that was asked for.
fn back(draw: &mut Draw, found: &mut Findings) {
    let probability =
        if draw.chance(0.5) { draw.between(0.5, 1.0) } else { 1.0 - 0.5 * draw.scale(1e-15, 1.0) };
    match detection::distance_for_probability(probability) {
        Ok(distance) => {
            let asked = Extended::one() - Extended::from(probability);
            let error = normal_tail(distance).relative_error_to(&asked);
            let bound = 1e-14 * (10.0 + distance * distance);
            found.check(&format!("distance of probability {probability:e}"), error, bound);
        }
        Err(error) => {
            let outside = !(probability > 0.5 && probability < 1.0);
            found.require(outside, || format!("no distance of probability {probability}: {error}"));
        }
    }
}

/// Two states of one to three bands with few counts.
pub(super) fn exact(draw: &mut Draw, found: &mut Findings) -> Result<()> {
    let most_bands = if draw.chance(0.1) { 3 } else { 2 };
    let bands = 1 + draw.below(most_bands);
    let most = [300.0, 30.0, 2.0][bands - 1];
    let mut means = Vec::new();
    let mut others = Vec::new();
    for _ in 0..bands {
        let mean = if draw.chance(0.1) { 0.0 } else { draw.scale(1e-3, most) };
        means.push(mean);
        others.push(match draw.below(4) {
            0 => mean,
            1 => mean * (1.0 + draw.scale(1e-12, 0.5)),
            _ => draw.scale(1e-3, most),
        });
    }
    let found_error = RatioLaw::new(&means, &others, &Statistics::Poisson)?.error();
    let exact = poisson_error(&means, &others);
    let numbers = [found_error.error, found_error.ln_error, found_error.first, found_error.second];
    found.require(numbers.iter().all(|number| number.is_finite()), || format!("not finite: {numbers:?}"));
    let error = Extended::from(found_error.error).relative_error_to(&exact);
    let bound = found_error.numerical + 2.0 * f64::EPSILON;
    found.check(&format!("error of {means:?} against {others:?}"), error, bound);
    Ok(())
}
