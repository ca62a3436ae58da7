//! Photon radiance of a blackbody: value by value, spectrum by spectrum, and as textbooks write it.

use super::chart::{Chart, Measured};
use super::item::off;
use super::timing::{Budget, seconds_of};
use super::{Item, Order};
use crate::reference::planck as reference;
use hadar::error::Result;
use hadar::planck::{mode_density, photon_radiance, photon_radiance_and_slope_into, photon_radiance_into};
use hadar::units::SECOND_RADIATION_CM_K;

const COUNTS: [usize; 5] = [1, 8, 64, 536, 4096];
const TEMPERATURES_K: [f64; 3] = [77.0, 310.15, 2000.0];
/// Wavenumbers of the errors, cm⁻¹: as many as the largest spectrum has.
const RANGE_CM1: [f64; 2] = [100.0, 4000.0];

pub(super) fn measure(order: Order) -> Result<Chart> {
    type Method = fn(&[f64], f64, &mut [f64], &mut [f64]);
    let one_by_one: Method = |nodes, temperature_k, out, _| {
        for (out, node) in out.iter_mut().zip(nodes) {
            *out = photon_radiance(*node, temperature_k);
        }
    };
    let spectrum: Method = |nodes, temperature_k, out, _| photon_radiance_into(nodes, temperature_k, out);
    let textbook: Method = |nodes, temperature_k, out, _| {
        for (out, node) in out.iter_mut().zip(nodes) {
            *out = mode_density(*node) / ((SECOND_RADIATION_CM_K * node / temperature_k).exp() - 1.0);
        }
    };
    let mut measured = Vec::new();
    for (name, method, is_default) in [
        ("one by one", one_by_one, false),
        ("spectrum at once", spectrum, true),
        ("spectrum with its slope", photon_radiance_and_slope_into as Method, false),
        ("textbook, exp(x) - 1", textbook, false),
    ] {
        for count in order.some(&COUNTS) {
            let step = (RANGE_CM1[1] - RANGE_CM1[0]) / count as f64;
            let nodes: Vec<f64> = (0..count).map(|i| RANGE_CM1[0] + (i as f64 + 0.37) * step).collect();
            let (mut out, mut slope) = (vec![0.0; count], vec![0.0; count]);
            let mut worst: f64 = 0.0;
            for temperature_k in TEMPERATURES_K {
                method(&nodes, temperature_k, &mut out, &mut slope);
                for (value, node) in out.iter().zip(&nodes).step_by(count.div_ceil(64)) {
                    worst = worst.max(off(*value, &reference::photon_radiance(*node, temperature_k)));
                }
            }
            let seconds = seconds_of(Budget::of(order.quick), || {
                method(&nodes, TEMPERATURES_K[1], &mut out, &mut slope);
            });
            let one = Measured::new(name, count as f64, seconds / count as f64, worst);
            measured.push(one.answering(format!("{count} at once")).default_if(is_default));
        }
    }
    Ok(Chart {
        name: Item::Planck.name(),
        title: "Photon radiance of a blackbody",
        timed: "one wavenumber",
        effort: "wavenumbers at once",
        error: "largest relative error at 77, 310 and 2000 K from 100 to 4000 cm^-1",
        reference: "Planck's formula in extended precision",
        measured,
        remark: "With few wavenumbers the errors are of few values.".into(),
    })
}
