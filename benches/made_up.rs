//! Materials and counts that are made up, the same in `numpy_peer.py`.

/// Numbers between 0 and 1 that are spread evenly (Weyl).
fn spread(place: usize, irrational: f64) -> f64 {
    ((place + 1) as f64 * irrational).fract()
}

/// Emissivities of so many smooth materials at these wavenumbers.
#[allow(dead_code, reason = "not every bench has both")]
pub(crate) fn library(nodes_cm1: &[f64], count: usize) -> Vec<Vec<f64>> {
    let emissivity = |m: usize, nu: f64| {
        let wave = (nu / (20.0 + 100.0 * spread(m, 3f64.sqrt())) + 6.0 * spread(m, 5f64.sqrt())).sin();
        (0.3 + 0.68 * spread(m, 2f64.sqrt()) + 0.1 * wave).clamp(0.02, 0.99)
    };
    (0..count).map(|m| nodes_cm1.iter().map(|&nu| emissivity(m, nu)).collect()).collect()
}

/// Some 10⁴ counts in every sample of a cube of so many bands, with strong texture.
#[allow(dead_code, reason = "not every bench has both")]
pub(crate) fn counts(samples: usize, bands: usize) -> Vec<f32> {
    let count = |place: usize| 1e4 + 4096.0 * spread(place, 2f64.sqrt()) + (place % bands) as f64;
    (0..samples).map(|place| count(place) as f32).collect()
}
