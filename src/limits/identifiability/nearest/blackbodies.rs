//! Blackbody spectra at temperatures that come again from pair to pair.
//!
//! Proofs look at the ends of intervals. These are multiples of a power of two, so that pairs of one scene share them; what a spectrum
//! is does not hang on who asked for it first.

use crate::planck;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Numbers that are kept at most.
const ROOM: usize = 1 << 20;

/// B and ∂B/∂T at the nodes.
pub(super) type Blackbody = Arc<[Vec<f64>; 2]>;

/// The spectra known so far.
#[derive(Debug, Default)]
pub(super) struct Blackbodies {
    known: Mutex<HashMap<u64, Blackbody>>,
}

impl Blackbodies {
    /// The spectrum of a temperature, kept for others.
    pub(super) fn at(&self, nodes_cm1: &[f64], temperature_k: f64) -> Blackbody {
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(found) = known.get(&temperature_k.to_bits()) {
            return Arc::clone(found);
        }
        let made = Self::once(nodes_cm1, temperature_k);
        if (known.len() + 1) * 2 * nodes_cm1.len() > ROOM {
            known.clear();
        }
        known.insert(temperature_k.to_bits(), Arc::clone(&made));
        made
    }

    /// The spectrum of a temperature that hardly comes again.
    pub(super) fn once(nodes_cm1: &[f64], temperature_k: f64) -> Blackbody {
        let [mut value, mut slope] = [(); 2].map(|()| vec![0.0; nodes_cm1.len()]);
        planck::photon_radiance_and_slope_into(nodes_cm1, temperature_k, &mut value, &mut slope);
        Arc::new([value, slope])
    }
}

/// The multiple of a power of two next to a temperature on the side of another one: no coarser than a quarter of what is between them.
pub(super) fn rounded(temperature_k: f64, towards_k: f64) -> f64 {
    let step = (0.25 * (towards_k - temperature_k).abs()).log2().floor().exp2();
    if !(step > 0.0 && step.is_finite()) {
        return temperature_k;
    }
    let multiple = temperature_k / step;
    step * if towards_k > temperature_k { multiple.ceil() } else { multiple.floor() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn round_temperatures_lie_on_the_nearer_side_and_come_again() {
        let mut seen = std::collections::HashSet::new();
        for i in 0..2000 {
            let own_k = 250.0 + 0.05 * f64::from(i);
            for half_k in [7.0, 7.9] {
                for end in [own_k - half_k, own_k + half_k] {
                    let round = rounded(end, own_k);
                    let share = (round - own_k).abs() / half_k;
                    assert!(share > 0.7 && share < 1.0 + 1e-12, "{end} {round}");
                    seen.insert(round.to_bits());
                }
            }
        }
        // Eight thousand ends, a degree apart over 116 K.
        assert!(seen.len() < 120, "{}", seen.len());
        assert_eq!(rounded(300.0, 300.0), 300.0);
        assert_eq!(rounded(f64::INFINITY, 300.0), f64::INFINITY);
    }

    #[test]
    fn a_spectrum_is_the_same_whoever_asked_first() {
        let nodes: Vec<f64> = (0..100).map(|i| 700.0 + 5.0 * f64::from(i)).collect();
        let known = Blackbodies::default();
        let before = known.at(&nodes, 311.0);
        for i in 0..20_000 {
            known.at(&nodes, 200.0 + f64::from(i) / 64.0);
        }
        assert_eq!(known.at(&nodes, 311.0), before);
        assert!(known.known.lock().unwrap().len() * 200 <= ROOM);
    }
}
