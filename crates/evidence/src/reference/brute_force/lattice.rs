//! Temperatures that a brute force begins from.
//!
//! A spectrum's share of the signal changes with d ln B/d ln T = x/(1 − e⁻ˣ), x = hcν/kT: points are so close that no band
//! that still counts changes by more than a quarter of an e-fold from one to the next, and none farther apart than 5 %.
//! Around temperatures of the scene they close in by decades, as two of them may differ by a last bit. Below a temperature
//! at which every band has lost e⁻⁷⁴ of what it sends at the scene's hottest nothing changes any more, and where every band has gained as much nothing is near.

use super::model::second_radiation_cm_k;

/// Change of ln B from one point to the next.
const STEP: f64 = 0.25;
/// Largest change of ln T.
const WIDEST: f64 = 0.05;
/// What a band may lose before it does not count, in e-folds: 1e-20 of the signal, and both ends of the gain; in lattices
/// of several dimensions, from which the way down leads farther, less.
const FAINT: f64 = 74.0;
const FAINT_COARSE: f64 = 45.0;
/// Decades by which points close in on a temperature of the scene.
const DECADES: i32 = 14;

/// Temperatures (K) of one axis, ascending.
///
/// `coarse` times as far apart as said above; `scene_k` are temperatures of the scene to close in on, `hottest_k` the hottest
/// that is seen, `reach_cm1` the least and the largest wavenumber.
pub(super) fn axis(
    limits_k: [f64; 2],
    scene_k: &[f64],
    hottest_k: f64,
    reach_cm1: [f64; 2],
    coarse: f64,
) -> Vec<f64> {
    let [cold, hot] = limits_k;
    let [low, high] = reach_cm1.map(|nu| second_radiation_cm_k::<f64>() * nu);
    let mut temperatures = vec![cold, hot];
    let faint = if coarse > 1.0 { FAINT_COARSE } else { FAINT };
    // Hotter than this every band is brighter than the scene by as much.
    let dazzling = low / (low / hottest_k - faint);
    let mut temperature = if dazzling > 0.0 { hot.min(dazzling) } else { hot };
    loop {
        // The band that changes fastest among those that count.
        let fastest = (high / temperature).min(high / hottest_k + faint);
        temperature *= (-coarse * (STEP / fastest.max(1.0)).min(WIDEST)).exp();
        if temperature <= cold || low / temperature > low / hottest_k + faint {
            break;
        }
        temperatures.push(temperature);
    }
    for &near in scene_k {
        temperatures.push(near);
        for decade in 1..=DECADES {
            let apart = near * 10f64.powi(-decade);
            temperatures.extend([near - apart, near + apart]);
        }
    }
    temperatures.retain(|t| (cold..=hot).contains(t));
    temperatures.sort_by(f64::total_cmp);
    temperatures.dedup();
    temperatures
}

/// Places of a lattice of `sides` that are no higher than all beside them along its axes, lowest first.
pub(super) fn low_places(sides: &[usize], values: &[f64], most: usize) -> Vec<usize> {
    let strides: Vec<usize> =
        (0..sides.len()).map(|axis| sides[axis + 1..].iter().product::<usize>()).collect();
    let is_low = |place: &usize| {
        sides.iter().zip(&strides).all(|(&side, &stride)| {
            let along = place / stride % side;
            let below = |other: usize| values[*place] <= values[other];
            (along == 0 || below(place - stride)) && (along + 1 == side || below(place + stride))
        })
    };
    let mut places: Vec<usize> = (0..values.len()).filter(is_low).collect();
    places.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    places.truncate(most);
    places
}
