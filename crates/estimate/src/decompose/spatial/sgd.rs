//! The paper's TeX-SGD: the cost of a pixel is that of its counts and a penalty on temperatures that stand out of their window.
//!
//! C = C_local + p |t − median(N)|/std(N), C_local = ‖S̃ − S‖, N the temperatures of the 3 × 3 window around the pixel, p = 0.1.
//!
//! The paper leaves open, and here it is: the norm of C_local is the root of the deviance (each band in deviations of its noise); N
//! is of the sweep before and holds the pixel itself; at the border it is what there is of it; std is that of the sample, and where
//! it is 0, or fewer than three pixels are there, there is no penalty; sweeps over the whole image until nothing changes, at most
//! twenty. For each material the deviance is D + (t − T)²/σ², T and σ those of its fit, so the temperature of least cost lies
//! δ = q √D/√(1 − q²/σ²) from T towards the median, q = p σ²/std, or at it.
//!
//! Posterior, candidates and deviations stay those of the pixel's own counts: this cost is no probability.
//!
//! Source: paper, supplement SIII B.

use super::kept::{EIGHT, Kept, beside};
use rayon::prelude::*;

const MOST_SWEEPS: usize = 20;
/// Temperatures that differ by less are the same, K.
const SAME_K: f64 = 1e-3;

/// Materials and temperatures of least cost.
#[derive(Debug)]
pub(super) struct Found {
    pub(super) places: Vec<usize>,
    pub(super) temperatures_k: Vec<f64>,
    pub(super) sweeps: usize,
    pub(super) settled: bool,
}

/// Sweeps over an image of so many columns with a penalty p.
pub(super) fn minimised(kept: &Kept, columns: usize, penalty: f64) -> Found {
    let pixels = kept.pixels();
    let own = |i: usize| kept.of(i).first().map_or(f64::NAN, |best| best.temperature_k.into());
    let mut found = Found {
        places: vec![0; pixels],
        temperatures_k: (0..pixels).map(own).collect(),
        sweeps: 0,
        settled: false,
    };
    while !found.settled && found.sweeps < MOST_SWEEPS {
        let map = &found.temperatures_k;
        let next: Vec<(usize, f64)> =
            (0..pixels).into_par_iter().map(|i| least(kept, map, i, columns, penalty)).collect();
        let same = |((place, t), (before, k)): (&(usize, f64), (&usize, &f64))| {
            place == before && ((t - k).abs() <= SAME_K || t.is_nan())
        };
        found.settled = next.iter().zip(found.places.iter().zip(map)).all(same);
        (found.places, found.temperatures_k) = next.into_iter().unzip();
        found.sweeps += 1;
    }
    found
}

/// The candidate and temperature of least cost of pixel `i`.
fn least(kept: &Kept, map: &[f64], i: usize, columns: usize, penalty: f64) -> (usize, f64) {
    hadar::stop::check();
    let mut window: Vec<f64> = beside(i, columns, map.len(), &EIGHT)
        .map(|(_, j)| j)
        .chain([i])
        .filter_map(|j| map.get(j).copied())
        .filter(|t| t.is_finite())
        .collect();
    let (median, std) = spread(&mut window);
    let mut best = (0, map.get(i).copied().unwrap_or(f64::NAN), f64::INFINITY);
    for (place, candidate) in kept.of(i).iter().enumerate().filter(|(_, candidate)| candidate.kind.is_some())
    {
        let (own_k, sigma_k) = (f64::from(candidate.temperature_k), f64::from(candidate.sigma_k));
        let deviance = (kept.deviance(i) - 2.0 * f64::from(candidate.log_odds)).max(0.0);
        let (mut at_k, mut cost) = (own_k, deviance.sqrt());
        if std > 0.0 {
            let away = own_k - median;
            let q = penalty * sigma_k * sigma_k / std;
            let rest = 1.0 - (q / sigma_k).powi(2);
            let by = if rest > 0.0 { q * (deviance / rest).sqrt() } else { f64::INFINITY };
            at_k -= by.min(away.abs()).copysign(away);
            let square = deviance + ((at_k - own_k) / sigma_k).powi(2);
            cost = square.sqrt() + penalty * (at_k - median).abs() / std;
        }
        if cost < best.2 {
            best = (place, at_k, cost);
        }
    }
    (best.0, best.1)
}

/// Median and standard deviation of a sample; the latter 0 of fewer than three.
fn spread(values: &mut [f64]) -> (f64, f64) {
    values.sort_by(f64::total_cmp);
    let count = values.len();
    let at = |place: usize| values.get(place).copied().unwrap_or(f64::NAN);
    let median = 0.5 * (at(count.saturating_sub(1) / 2) + at(count / 2));
    if count < 3 {
        return (median, 0.0);
    }
    let mean = values.iter().sum::<f64>() / count as f64;
    let square: f64 = values.iter().map(|t| (t - mean).powi(2)).sum();
    (median, (square / (count - 1) as f64).sqrt())
}

#[cfg(test)]
mod tests {
    use super::super::kept::Candidate;
    use super::*;

    /// The cost on a fine grid of temperatures has its least where the closed form says, for penalties from little to all.
    #[test]
    fn temperatures_of_least_cost_are_those_of_a_grid() {
        let at = |kind: u16, log_odds: f32, temperature_k: f32, sigma_k: f32| Candidate {
            kind: Some(kind),
            log_odds,
            temperature_k,
            sigma_k,
        };
        let around = |t: f32| vec![at(0, 0.0, t, 1.0)];
        let mut pixels: Vec<Vec<Candidate>> =
            [301.0, 299.5, 300.2, 300.9, 0.0, 299.0, 300.4, 301.8, 300.1].map(around).to_vec();
        pixels[4] = vec![at(0, 0.0, 306.0, 1.5), at(1, -0.2, 299.0, 0.8)];
        let kept = Kept::of_pixels(&pixels, 20.0);
        let map: Vec<f64> = pixels.iter().map(|own| own[0].temperature_k.into()).collect();
        let (median, std) = spread(&mut map.clone());
        for penalty in [0.03, 0.1, 0.6, 3.0] {
            let mut least = (f64::INFINITY, 0, 0.0);
            for (place, own) in pixels[4].iter().enumerate() {
                let (t, sigma) = (f64::from(own.temperature_k), f64::from(own.sigma_k));
                for at in (0..20_000).map(|i| 290.0 + 1e-3 * f64::from(i)) {
                    let deviance = 20.0 - 2.0 * f64::from(own.log_odds) + ((at - t) / sigma).powi(2);
                    let cost = deviance.sqrt() + penalty * (at - median).abs() / std;
                    if cost < least.0 {
                        least = (cost, place, at);
                    }
                }
            }
            let (place, found) = super::least(&kept, &map, 4, 3, penalty);
            assert!(
                place == least.1 && (found - least.2).abs() < 2e-3,
                "{penalty}: {place} {found} {least:?}"
            );
        }
    }
}
