//! Temperatures of neighbours of one material taken together.
//!
//! Within a material the temperature changes from a pixel to the next by a deviation of τ, over d pixels by τ d. Of a pixel and the
//! neighbours of its window of 3 × 3 that are of its material and whose temperatures do not contradict it (by more than three
//! deviations, an edge), the temperature of least variance is
//!
//! T̂ = (T₀/σ₀² + Σⱼ wⱼ Tⱼ)/(1/σ₀² + Σⱼ wⱼ),  wⱼ = 1/(σⱼ² + τ² dⱼ²),  with the variance 1/(1/σ₀² + Σⱼ wⱼ).
//!
//! More of the image would tell more, so this variance is no smaller than what the prior allows.
//!
//! τ, where it is not stated, is that with which half of the differences between neighbours of one material lie within the quartiles
//! of their deviations, √(σᵢ² + σⱼ² + τ²), taken two standard errors too large: rather too little is smoothed.
//!
//! Assumption: differences to the neighbours are independent of each other. On a slope those of one side are not, which the others
//! balance but at an edge.

use super::super::pixel::{NO_MATERIAL, Pixel};
use super::kept::{EIGHT, FOUR, Kept, beside};
use rayon::prelude::*;

/// Deviations beyond which two temperatures are of two things.
const EDGE: f64 = 3.0;
/// Median of χ² with one degree of freedom, and its probability density there.
const MEDIAN: f64 = 0.454_936_423_119_572_7;
const DENSITY: f64 = 0.471_1;
/// Standard errors that τ is taken too large by.
const RATHER: f64 = 2.0;

/// Temperature and deviation of every pixel with its neighbours, K.
pub(super) fn levelled(pixels: &[Pixel], columns: usize, step_k: f64) -> Vec<(f64, f64)> {
    let together = |i: usize| {
        let Some(own) = pixels.get(i) else { return (f64::NAN, f64::NAN) };
        let mut precision = own.sigma_k.powi(-2);
        let mut sum = precision * own.temperature_k;
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
        (sum / precision, precision.sqrt().recip())
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
    let standard_error = 0.5 / (DENSITY * (pairs.len() as f64).sqrt());
    let aim = MEDIAN - RATHER * standard_error;
    if aim.is_nan() || aim <= 0.0 {
        return f64::INFINITY;
    }
    // The median falls with τ.
    let median = |tau: f64| {
        let mut all: Vec<f64> = pairs.iter().map(|(square, var)| square / (var + tau * tau)).collect();
        let middle = all.len() / 2;
        *all.select_nth_unstable_by(middle, f64::total_cmp).1
    };
    let (mut low, mut high) = (1e-6f64, 1e3f64);
    for _ in 0..50 {
        let middle = (low * high).sqrt();
        if median(middle) > aim { low = middle } else { high = middle }
    }
    high
}
