//! Counts drawn exactly, or from the normal law that is quicker.
//!
//! The error is the largest distance between the distribution function of the draws and Poisson's. What n draws of the
//! exact law show of it is chance, beyond 1.36/√n in one case of twenty (Kolmogorov): below that nothing can be told.

use super::chart::{Chart, Measured};
use super::timing::{Budget, seconds_of};
use super::{Item, Order};
use hadar::error::Result;
use hadar::statistics::Statistics;
use hadar_simulate::draws::{Draws, generator};

const DRAWS: usize = 400_000;
const QUICK_DRAWS: usize = 50_000;
/// Counts drawn at once: bands of a spectrum.
const BANDS: usize = 500;
const MEANS: [f64; 7] = [1.0, 5.0, 20.0, 100.0, 1e3, 1e4, 1e5];

pub(super) fn measure(order: Order) -> Result<Chart> {
    let number = if order.quick { QUICK_DRAWS } else { DRAWS };
    let mut measured = Vec::new();
    for (name, is_default) in [("exact (Poisson)", true), ("normal of the same variance", false)] {
        for mean in order.some(&MEANS) {
            let means = vec![mean; BANDS];
            let law = if is_default {
                Statistics::Poisson
            } else {
                Statistics::Gaussian { var_added: vec![0.0; BANDS] }
            };
            let draws = Draws::new(&law, &means)?;
            let mut counts = vec![0.0; BANDS];
            let mut all = Vec::with_capacity(number);
            for spectrum in 0..number.div_ceil(BANDS) {
                draws.draw_into(&mut generator(order.seed, spectrum as u64), &mut counts);
                all.extend_from_slice(&counts);
            }
            let error = distance_to_poisson(&mut all, mean);
            let mut rng = generator(order.seed, 0);
            let seconds = seconds_of(Budget::of(order.quick), || draws.draw_into(&mut rng, &mut counts));
            measured.push(
                Measured::new(name, mean, seconds / BANDS as f64, error)
                    .answering(format!("mean {mean}"))
                    .default_if(is_default)
                    .reporting(1.36 / (all.len() as f64).sqrt()),
            );
        }
    }
    Ok(Chart {
        name: Item::Draws.name(),
        title: "Counts drawn",
        timed: "one count",
        effort: "mean counts of a band",
        error: "largest distance of the distribution function from Poisson's",
        reference: "Poisson's law",
        measured,
        remark: format!(
            "Draws of the exact law differ from it by chance alone, up to {:.1e} in 19 of 20 cases with {number} draws: \
             where the normal law is off the front, exactness costs that much more time and is the default all the same.",
            1.36 / (number as f64).sqrt()
        ),
    })
}

/// Largest distance between the distribution function of `draws` and that of Poisson's law of this mean.
fn distance_to_poisson(draws: &mut [f64], mean: f64) -> f64 {
    draws.sort_by(f64::total_cmp);
    let reach = 12.0 * mean.sqrt() + 40.0;
    let (low, high) = ((mean - reach).floor().max(0.0), (mean + reach).ceil());
    let share = |count: usize| count as f64 / draws.len() as f64;
    let (mut below, mut largest) = (0.0, 0.0_f64);
    let mut k = low;
    while k <= high {
        let probability = (k * mean.ln() - mean - libm::lgamma(k + 1.0)).exp();
        // Just before the step at k, and on it.
        largest = largest.max((share(draws.partition_point(|draw| *draw < k)) - below).abs());
        below += probability;
        largest = largest.max((share(draws.partition_point(|draw| *draw <= k)) - below).abs());
        k += 1.0;
    }
    largest
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Half of the draws 0, half 2, of mean 1: e⁻¹ is 0.3679, so that the step at 0 is 0.1321 too high and at 2 the rest
    /// below is 0.7358 against 0.5.
    #[test]
    fn the_distance_is_the_largest_at_any_step() {
        let distance = distance_to_poisson(&mut [0.0, 2.0, 0.0, 2.0], 1.0);
        assert!((distance - (2.0 * (-1.0_f64).exp() - 0.5)).abs() < 1e-12, "{distance}");
    }
}
