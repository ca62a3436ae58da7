//! Integral of a sharp spectrum over a band: sums of values at centres against adaptive quadrature.
//!
//! B(ν, 300 K) times a Lorentzian line of 1 cm⁻¹ half width at 903 cm⁻¹, over 850 to 950 cm⁻¹. The reference is the
//! tanh-sinh rule in extended precision, each half of the band apart.

use super::chart::{Chart, Measured};
use super::item::off;
use super::quadrature::integral;
use super::timing::{Budget, seconds_of};
use super::{Item, Order};
use crate::reference::Extended;
use crate::reference::planck::photon_radiance_at;
use hadar::error::Result;
use hadar::planck::photon_radiance_into;
use hadar::spectrum::{Bands, INTEGRATION_TOLERANCE};

const RANGE_CM1: [f64; 2] = [850.0, 950.0];
const LINE_CM1: f64 = 903.0;
const TEMPERATURE_K: f64 = 300.0;
const STEPS_CM1: [f64; 9] = [50.0, 20.0, 10.0, 5.0, 1.0, 0.5, 0.25, 0.125, 0.1];
/// The paper's step, and the crate's where nothing else is asked for.
const DEFAULT_STEP_CM1: f64 = 1.0;
const TOLERANCES: [f64; 6] = [1e-1, 1e-3, 1e-5, 1e-7, INTEGRATION_TOLERANCE, 1e-12];

fn spectrum(nodes: &[f64]) -> Vec<f64> {
    let mut values = vec![0.0; nodes.len()];
    photon_radiance_into(nodes, TEMPERATURE_K, &mut values);
    for (value, node) in values.iter_mut().zip(nodes) {
        *value /= 1.0 + (node - LINE_CM1).powi(2);
    }
    values
}

pub(super) fn measure(order: Order) -> Result<Chart> {
    let [low, high] = RANGE_CM1;
    let temperature = Extended::from(TEMPERATURE_K);
    let exact = |node: &Extended| {
        let away = node - Extended::from(LINE_CM1);
        let line = Extended::one() + away.square();
        photon_radiance_at(node, &temperature) / line
    };
    let truth = integral(exact, &[low, LINE_CM1, high]);
    let mut measured = Vec::new();
    for step in order.some(&STEPS_CM1) {
        let count = ((high - low) / step).round();
        let sum = || -> Result<f64> {
            let rows = (0..count as usize).map(|i| (low + (i as f64 + 0.5) * step, step));
            let bands = Bands::from_rows(rows)?;
            Ok(hadar::sum::sum(&bands.weigh(&spectrum(bands.nodes_cm1()))))
        };
        let error = off(sum()?, &truth);
        let seconds = seconds_of(Budget::of(order.quick), sum);
        let one = Measured::new("values at centres (step, cm^-1)", step, seconds, error);
        measured.push(one.default_if(step == DEFAULT_STEP_CM1));
    }
    let whole = Bands::from_rows([(0.5 * (low + high), high - low)])?;
    for tolerance in order.some(&TOLERANCES) {
        let adaptive = || -> Result<f64> {
            let fine = whole.integrated(&[], tolerance, |nodes| Ok(vec![spectrum(nodes)]))?;
            Ok(fine.weigh(&spectrum(fine.nodes_cm1()))[0])
        };
        let error = off(adaptive()?, &truth);
        let seconds = seconds_of(Budget::of(order.quick), adaptive);
        let one = Measured::new("adaptive (tolerance)", tolerance, seconds, error);
        measured.push(one.default_if(tolerance == INTEGRATION_TOLERANCE).reporting(tolerance));
    }
    Ok(Chart {
        name: Item::BandIntegrals.name(),
        title: "A sharp line integrated over a band",
        timed: "one integral",
        effort: "step (cm^-1), or tolerance",
        error: "relative error of the integral",
        reference: "tanh-sinh rule in extended precision",
        measured,
        remark: "The step of 1 cm^-1 is the paper's and the default; `integrate = true` under [bands] asks for the \
                 adaptive rule, whose default tolerance is 1e-9."
            .into(),
    })
}
