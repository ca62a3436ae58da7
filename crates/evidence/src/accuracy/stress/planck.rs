//! Photon radiance and its differences against the textbook's formula in extended precision.

use super::draw::Draw;
use super::findings::Findings;
use crate::reference::{Extended, planck as exact};
use hadar::planck as fast;

/// hcν/kT beyond which B is exactly 0.
const DARK: f64 = 708.0;

/// The documented bound 2e-16·(10 + x).
fn bound(x: f64) -> f64 {
    2e-16 * (10.0 + x)
}

/// B, ∂B/∂T, ∂ln B/∂T and B(T) − B(T₀) at random wavenumbers and temperatures.
pub(super) fn judge(draw: &mut Draw, found: &mut Findings) {
    let temperature_k = draw.scale(1.0, 1e5);
    let count = 1 + draw.below(4);
    let nodes: Vec<f64> = (0..count)
        .map(|_| {
            // Half of them where there is light.
            let thermal = temperature_k * 0.695 * draw.scale(1e-4, 50.0);
            let anywhere = draw.scale(1e-3, 1e5);
            if draw.chance(0.7) { thermal.clamp(1e-3, 1e5) } else { anywhere }
        })
        .collect();
    let zeros = || vec![0.0; count];
    let (mut values, mut slopes, mut alone) = (zeros(), zeros(), zeros());
    fast::photon_radiance_and_slope_into(&nodes, temperature_k, &mut values, &mut slopes);
    fast::photon_radiance_into(&nodes, temperature_k, &mut alone);
    found.require(alone == values, || "B alone differs from B with its slope".into());
    let temperature = Extended::from(temperature_k);
    let blackbody = exact::Blackbody::new(&nodes, &temperature);
    let x_of = |node: f64, t: f64| 1.438_776_877_503_933_8 * node / t;
    for (i, &node) in nodes.iter().enumerate() {
        let x = x_of(node, temperature_k);
        compare(found, "B", values[i], &blackbody.values[i], x);
        compare(found, "dB/dT", slopes[i], &blackbody.slopes[i], x);
        let logarithmic = &blackbody.slopes[i] / &blackbody.values[i];
        let error = Extended::from(fast::log_derivative(node, temperature_k)).relative_error_to(&logarithmic);
        found.check("dlnB/dT", error, bound(0.0));
    }
    let difference_k = difference(draw, temperature_k);
    let mut differences = zeros();
    fast::photon_radiance_difference_into(&nodes, temperature_k, difference_k, &values, &mut differences);
    let warmer = &temperature + Extended::from(difference_k);
    let there = exact::Blackbody::new(&nodes, &warmer);
    for (i, &node) in nodes.iter().enumerate() {
        let x = x_of(node, temperature_k.min(temperature_k + difference_k));
        compare(found, "B(T) - B(T0)", differences[i], &(&there.values[i] - &blackbody.values[i]), x);
    }
}

/// A difference of temperature: from 10⁵ K to less than the last bit.
fn difference(draw: &mut Draw, temperature_k: f64) -> f64 {
    let size = match draw.below(6) {
        0 => return draw.some_bits_from(temperature_k) - temperature_k,
        1 => return 0.0,
        2 => draw.scale(1e-3 * temperature_k, 1e5),
        _ => temperature_k * draw.scale(1e-17, 1.0),
    };
    if draw.chance(0.5) && size < 0.98 * temperature_k { -size } else { size }
}

/// A value against the exact one, where it need not be dark.
fn compare(found: &mut Findings, what: &str, value: f64, exact: &Extended, x: f64) {
    found.require(value.is_finite(), || format!("{what} is {value}"));
    if x > DARK - 1.0 && exact.abs().to_f64() < 1e-280 {
        let size = exact.abs().to_f64();
        found.require(value.abs() <= 1.001 * size + 1e-280, || format!("{what} is {value:e} in the dark"));
        return;
    }
    found.check(what, Extended::from(value).relative_error_to(exact), bound(x));
}
