//! Permittivity of a glass: absorption bands of Gaussian shape with their Kramers–Kronig partners.
//!
//! ε(ν) = ε∞ + Σⱼ [ gⱼ(ν) + i αⱼ( e^{−x₋²} − e^{−x₊²} ) ],
//! gⱼ(ν) = (2αⱼ/√π)( D(x₊) − D(x₋) ),  x± = 2√(ln 2)(ν ± νⱼ)/σⱼ,
//! with D the Dawson function, νⱼ the centre and σⱼ the full width at half maximum in cm⁻¹, αⱼ the
//! height. The odd extension to −ν makes Im ε(0) = 0.
//!
//! Source: Kitamura, Pilon and Jonasz, Appl. Opt. 46, 8118 (2007), doi:10.1364/AO.46.008118. The paper
//! prints 2αⱼ/π before the Dawson functions; the Hilbert transform of a Gaussian has 2αⱼ/√π, which is used here.

use super::oscillator::all_positive;
use crate::error::{Error, Result, check};
use errorfunctions::RealErrorFunctions;
use nalgebra::Complex;
use serde::Deserialize;
use std::f64::consts::{LN_2, PI};

/// Gaussian absorption bands.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(try_from = "Parameters")]
pub(super) struct Gaussian(Parameters);

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct Parameters {
    high_frequency: f64,
    centre_cm1: Vec<f64>,
    height: Vec<f64>,
    width_cm1: Vec<f64>,
}

impl TryFrom<Parameters> for Gaussian {
    type Error = Error;

    fn try_from(parameters: Parameters) -> Result<Self> {
        check::positive("high_frequency", parameters.high_frequency, "")?;
        let bands = parameters.centre_cm1.len();
        all_positive("centre_cm1", &parameters.centre_cm1, bands)?;
        all_positive("height", &parameters.height, bands)?;
        all_positive("width_cm1", &parameters.width_cm1, bands)?;
        Ok(Self(parameters))
    }
}

impl Gaussian {
    pub(super) fn permittivity(&self, wavenumber_cm1: f64) -> Complex<f64> {
        let Parameters { high_frequency, centre_cm1, height, width_cm1 } = &self.0;
        let bands = centre_cm1.iter().zip(height).zip(width_cm1);
        bands.fold(Complex::from(*high_frequency), |sum, ((&centre, &height), &width)| {
            let scale = 2.0 * LN_2.sqrt() / width;
            let (below, above) = (scale * (wavenumber_cm1 - centre), scale * (wavenumber_cm1 + centre));
            sum + Complex::new(
                2.0 * height / PI.sqrt() * (above.dawson() - below.dawson()),
                height * ((-below * below).exp() - (-above * above).exp()),
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The library function against its Taylor and asymptotic series and a table value
    /// (Abramowitz and Stegun, table 7.5: D(1) = 0.53807 95069).
    #[test]
    fn the_dawson_function_is_trustworthy() {
        assert!((1.0f64.dawson() - 0.538_079_506_912_768_4).abs() < 1e-15);
        for step in 1..400 {
            let x = f64::from(step) * 0.01;
            // D(x) = e^{-x²} Σ x^{2k+1}/(k!(2k+1)): all terms positive, no cancellation
            let (mut power, mut sum) = (x, 0.0);
            for k in 0..200 {
                sum += power / f64::from(2 * k + 1);
                power *= x * x / f64::from(k + 1);
            }
            let series = (-x * x).exp() * sum;
            assert!((x.dawson() / series - 1.0).abs() < 1e-13, "{x}");
            assert_eq!((-x).dawson(), -x.dawson());
        }
        let x = 60.0f64;
        let asymptotic = (1.0 + 0.5 / x.powi(2) + 0.75 / x.powi(4) + 1.875 / x.powi(6)) / (2.0 * x);
        assert!((x.dawson() / asymptotic - 1.0).abs() < 1e-12);
    }

    /// Sum rule: ε(0) − ε∞ = (2/π)∫ Im ε/ν dν, here by the midpoint rule.
    #[test]
    fn real_and_imaginary_part_obey_kramers_and_kronig() {
        let band = Gaussian::try_from(Parameters {
            high_frequency: 2.0,
            centre_cm1: vec![1000.0],
            height: vec![3.0],
            width_cm1: vec![100.0],
        })
        .unwrap();
        let integral: f64 = (0..20_000)
            .map(|i| (f64::from(i) + 0.5) * 0.1)
            .map(|wavenumber| band.permittivity(wavenumber).im / wavenumber * 0.1)
            .sum();
        let at_rest = band.permittivity(1e-6).re - 2.0;
        assert!((at_rest / (2.0 / PI * integral) - 1.0).abs() < 1e-9, "{at_rest} {integral}");
    }
}
