//! Blackbody spectra at temperatures that come again from pair to pair.
//!
//! Proofs look at the ends of intervals. These are multiples of a power of two, so that pairs of one scene share them; what a spectrum
//! is does not hang on who asked for it first.

use super::proof::by_place;
use crate::aligned::Aligned;
use crate::planck;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// Numbers that are kept at most.
const ROOM: usize = 1 << 20;

/// B and ∂B/∂T at the nodes.
#[derive(Debug)]
pub(super) struct Blackbody {
    pub(super) radiance: [Aligned; 2],
    /// The same by place, and in groups of how many neighbours.
    by_place: OnceLock<(usize, [Aligned; 2])>,
}

impl Blackbody {
    /// The spectrum of a temperature that hardly comes again.
    pub(super) fn of(nodes_cm1: &[f64], temperature_k: f64) -> Self {
        let [mut value, mut slope] = [(); 2].map(|()| Aligned::unset(nodes_cm1.len()));
        planck::photon_radiance_and_slope_into(nodes_cm1, temperature_k, &mut value, &mut slope);
        Self { radiance: [value, slope], by_place: OnceLock::new() }
    }

    /// Both by place in groups of so many neighbours, as all that ask of one scene have them; `None` where others were asked for first.
    pub(super) fn by_place(&self, count: usize) -> Option<&[Aligned; 2]> {
        let placed = || (count, self.radiance.each_ref().map(|radiance| by_place(radiance, count)));
        let (of, placed) = self.by_place.get_or_init(placed);
        (*of == count).then_some(placed)
    }
}

/// The spectra known so far.
#[derive(Debug, Default)]
pub(super) struct Blackbodies {
    known: Mutex<HashMap<u64, Arc<Blackbody>>>,
}

impl Blackbodies {
    /// The spectrum of a temperature, kept for others.
    pub(super) fn at(&self, nodes_cm1: &[f64], temperature_k: f64) -> Arc<Blackbody> {
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(found) = known.get(&temperature_k.to_bits()) {
            return Arc::clone(found);
        }
        let made = Arc::new(Blackbody::of(nodes_cm1, temperature_k));
        if (known.len() + 1) * 4 * nodes_cm1.len() > ROOM {
            known.clear();
        }
        known.insert(temperature_k.to_bits(), Arc::clone(&made));
        made
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
        assert_eq!(
            known.at(&nodes, 311.0).radiance.each_ref().map(|x| x.to_vec()),
            before.radiance.each_ref().map(|x| x.to_vec())
        );
        assert!(known.known.lock().unwrap().len() * 200 <= ROOM);
    }
}
