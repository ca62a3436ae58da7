//! Temperatures of neighbours of one material taken together.
//!
//! Within a material the temperature changes from a pixel to the next by a deviation of τ, over d pixels by τ d. Of a pixel and the
//! neighbours of its window of 3 × 3 that are of its material and whose temperatures do not contradict it (by more than three
//! deviations, an edge), the temperature of least variance is
//!
//! T̂ = (T₀/σ₀² + Σⱼ wⱼ Tⱼ)/(1/σ₀² + Σⱼ wⱼ),  wⱼ = 1/(σⱼ² + τ² dⱼ²),  with the variance 1/(1/σ₀² + Σⱼ wⱼ).
//!
//! Where T₀ is off what the neighbours say together by more than 2½ deviations, it stays as it is: a spot of one pixel. One that
//! is fainter is taken for noise, and its interval may miss it: at two deviations in three cases of ten.
//!
//! More of the image would tell more, so this variance is no smaller than what the prior allows.
//!
//! τ, where it is not stated, is that with which 80 % of the differences between neighbours of one material lie within 1.28 of their
//! deviations, √(σᵢ² + σⱼ² + τ²), taken two standard errors too large: rather too little is smoothed. The largest differences are
//! edges, and no matter.
//!
//! Assumption: differences to the neighbours are independent of each other. On a slope those of one side are not, which the others
//! balance but at an edge.

use super::super::pixel::{NO_MATERIAL, Pixel};
use super::kept::{EIGHT, FOUR, Kept, beside};
use rayon::prelude::*;

/// Deviations beyond which two temperatures are of two things.
const EDGE: f64 = 3.0;
/// Deviations from all of its neighbours beyond which a pixel is a thing of its own.
const SPOT: f64 = 2.5;
/// Share of the differences that are taken for those within a thing; what χ² of one degree of freedom falls below with that
/// probability, and its probability density there.
const WITHIN: f64 = 0.8;
const QUANTILE: f64 = 1.642_374_415_149_816;
const DENSITY: f64 = 0.136_94;
/// Standard errors that τ is taken too large by.
const RATHER: f64 = 2.0;
/// A step that says nothing, K.
const LARGEST_K: f64 = 1e3;

/// Temperature and deviation of every pixel with its neighbours, K.
pub(super) fn levelled(pixels: &[Pixel], columns: usize, step_k: f64) -> Vec<(f64, f64)> {
    let together = |i: usize| {
        hadar::stop::check();
        let Some(own) = pixels.get(i) else { return (f64::NAN, f64::NAN) };
        let (mut precision, mut sum) = (0.0, 0.0);
        for (place, j) in beside(i, columns, pixels.len(), &EIGHT) {
            let Some(other) = pixels.get(j).filter(|other| other.material == own.material) else { continue };
            let far = EIGHT.get(place).map_or(1.0, |(down, right)| (down * down + right * right) as f64);
            let var = other.sigma_k.powi(2) + step_k * step_k * far;
            let apart = other.temperature_k - own.temperature_k;
            if apart * apart <= EDGE * EDGE * (var + own.sigma_k.powi(2)) {
                precision += 1.0 / var;
                sum += other.temperature_k / var;
            }
        }
        let apart = own.temperature_k - sum / precision;
        let (own_var, var) = (own.sigma_k.powi(2), 1.0 / precision);
        // Without a neighbour nothing is apart.
        if apart.is_nan() || apart * apart > SPOT * SPOT * (own_var + var) {
            return (own.temperature_k, own.sigma_k);
        }
        let share = own_var / (own_var + var);
        (share.mul_add(-apart, own.temperature_k), (own_var * (1.0 - share)).sqrt())
    };
    let is_told = |pixel: &Pixel| pixel.material != NO_MATERIAL && pixel.sigma_k.is_finite();
    let told = |(i, pixel): (usize, &Pixel)| match is_told(pixel) {
        true => together(i),
        false => (pixel.temperature_k, pixel.sigma_k),
    };
    pixels.par_iter().enumerate().map(told).collect()
}

/// τ of an image, K; infinite where there are no neighbours of one material.
pub(super) fn step_k(kept: &Kept, columns: usize) -> f64 {
    let best = |i: usize| kept.of(i).first().filter(|best| best.sigma_k.is_finite());
    let mut pairs: Vec<(f64, f64)> = Vec::new();
    for i in 0..kept.pixels() {
        for (_, j) in beside(i, columns, kept.pixels(), &[FOUR[1], FOUR[3]]) {
            let Some((a, b)) = best(i).zip(best(j)).filter(|(a, b)| a.kind == b.kind) else { continue };
            let apart = f64::from(a.temperature_k) - f64::from(b.temperature_k);
            pairs.push((apart * apart, f64::from(a.sigma_k).powi(2) + f64::from(b.sigma_k).powi(2)));
        }
    }
    let error = RATHER * (WITHIN * (1.0 - WITHIN) / pairs.len() as f64).sqrt() / DENSITY;
    if pairs.is_empty() || error >= QUANTILE {
        return f64::INFINITY;
    }
    let at = |values: &mut [f64], share: f64| {
        let place = (share * values.len() as f64) as usize;
        *values.select_nth_unstable_by(place, f64::total_cmp).1
    };
    // Where deviations alone explain more than the differences are, τ is what so many pairs would not tell from nothing.
    let median = at(&mut pairs.iter().map(|(_, var)| *var).collect::<Vec<_>>(), 0.5);
    let (mut low, mut high) = ((median * error / QUANTILE).sqrt(), LARGEST_K);
    for _ in 0..50 {
        let middle = (low * high).sqrt();
        let mut all: Vec<f64> = pairs.iter().map(|(square, var)| square / (var + middle * middle)).collect();
        // The quantile falls with τ.
        match at(&mut all, WITHIN) > QUANTILE - error {
            true => low = middle,
            false => high = middle,
        }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::decompose::flag;

    fn pixel(temperature_k: f64, sigma_k: f64, material: u16) -> Pixel {
        Pixel { temperature_k, sigma_k, material, flags: flag::UNDECIDED, ..Pixel::SKIPPED }
    }

    /// By hand: 1/σ² = 1 and 1/(4 + 1) beside each other; another material and an edge tell nothing.
    #[test]
    fn neighbours_of_one_material_are_taken_together() {
        let row = [pixel(300.0, 1.0, 0), pixel(303.0, 2.0, 0), pixel(303.0, 1.0, 1), pixel(323.0, 1.0, 1)];
        let found = levelled(&row, 4, 1.0);
        assert!((found[0].0 - 300.5).abs() < 1e-12 && (found[0].1 - 1.2f64.sqrt().recip()).abs() < 1e-12);
        assert_eq!((found[2], found[3]), ((303.0, 1.0), (323.0, 1.0)));
    }
}
