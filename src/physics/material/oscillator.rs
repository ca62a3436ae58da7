//! Permittivity of free carriers and of lattice or molecular vibrations.
//!
//! With ν the wavenumber and all parameters in cm⁻¹ except the dimensionless ε∞ and S:
//!
//! - Drude (metals): ε = ε∞ − ν_p²/(ν² + iνν_τ);
//! - Lorentz (polymers): ε = ε∞ + Σ Sⱼνⱼ²/(νⱼ² − ν² − iγⱼν);
//! - factorised, "four-parameter semi-quantum" (crystals): ε = ε∞ Π (ν_LO² − ν² − iγ_LO ν)/(ν_TO² − ν² − iγ_TO ν).
//!
//! Sources: Ordal et al., Appl. Opt. 24, 4493 (1985), doi:10.1364/AO.24.004493, for the Drude form and
//! its units; Gervais and Piriou, Phys. Rev. B 11, 3944 (1975), doi:10.1103/PhysRevB.11.3944, for the factorised one.

use crate::error::{Error, Result, check};
use nalgebra::Complex;
use serde::Deserialize;

/// Free carriers.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(try_from = "DrudeParameters")]
pub(super) struct Drude(DrudeParameters);

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct DrudeParameters {
    high_frequency: f64,
    plasma_cm1: f64,
    damping_cm1: f64,
}

impl TryFrom<DrudeParameters> for Drude {
    type Error = Error;

    fn try_from(parameters: DrudeParameters) -> Result<Self> {
        check::positive("high_frequency", parameters.high_frequency, "")?;
        check::positive("plasma_cm1", parameters.plasma_cm1, "cm^-1")?;
        check::positive("damping_cm1", parameters.damping_cm1, "cm^-1")?;
        Ok(Self(parameters))
    }
}

impl Drude {
    pub(super) fn permittivity(&self, wavenumber_cm1: f64) -> Complex<f64> {
        let DrudeParameters { high_frequency, plasma_cm1, damping_cm1 } = self.0;
        let carriers = plasma_cm1 / (wavenumber_cm1 * wavenumber_cm1 + damping_cm1 * damping_cm1);
        Complex::new(
            high_frequency - plasma_cm1 * carriers,
            plasma_cm1 * carriers * damping_cm1 / wavenumber_cm1,
        )
    }
}

/// Classical oscillators.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(try_from = "LorentzParameters")]
pub(super) struct Lorentz(LorentzParameters);

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct LorentzParameters {
    high_frequency: f64,
    resonance_cm1: Vec<f64>,
    strength: Vec<f64>,
    damping_cm1: Vec<f64>,
}

impl TryFrom<LorentzParameters> for Lorentz {
    type Error = Error;

    fn try_from(parameters: LorentzParameters) -> Result<Self> {
        check::positive("high_frequency", parameters.high_frequency, "")?;
        let lines = parameters.resonance_cm1.len();
        all_positive("resonance_cm1", &parameters.resonance_cm1, lines)?;
        all_positive("strength", &parameters.strength, lines)?;
        all_positive("damping_cm1", &parameters.damping_cm1, lines)?;
        Ok(Self(parameters))
    }
}

impl Lorentz {
    pub(super) fn permittivity(&self, wavenumber_cm1: f64) -> Complex<f64> {
        let LorentzParameters { high_frequency, resonance_cm1, strength, damping_cm1 } = &self.0;
        let lines = resonance_cm1.iter().zip(strength).zip(damping_cm1);
        lines.fold(Complex::from(*high_frequency), |sum, ((&resonance, &strength), &damping)| {
            sum + strength * resonance * resonance / pole(resonance, damping, wavenumber_cm1)
        })
    }
}

/// Pairs of transverse and longitudinal modes.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(try_from = "FactorisedParameters")]
pub(super) struct Factorised(FactorisedParameters);

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct FactorisedParameters {
    high_frequency: f64,
    transverse_cm1: Vec<f64>,
    transverse_damping_cm1: Vec<f64>,
    longitudinal_cm1: Vec<f64>,
    longitudinal_damping_cm1: Vec<f64>,
}

impl TryFrom<FactorisedParameters> for Factorised {
    type Error = Error;

    fn try_from(parameters: FactorisedParameters) -> Result<Self> {
        check::positive("high_frequency", parameters.high_frequency, "")?;
        let modes = parameters.transverse_cm1.len();
        all_positive("transverse_cm1", &parameters.transverse_cm1, modes)?;
        all_positive("transverse_damping_cm1", &parameters.transverse_damping_cm1, modes)?;
        all_positive("longitudinal_cm1", &parameters.longitudinal_cm1, modes)?;
        all_positive("longitudinal_damping_cm1", &parameters.longitudinal_damping_cm1, modes)?;
        Ok(Self(parameters))
    }
}

impl Factorised {
    pub(super) fn permittivity(&self, wavenumber_cm1: f64) -> Complex<f64> {
        let modes = &self.0;
        let transverse = modes.transverse_cm1.iter().zip(&modes.transverse_damping_cm1);
        let longitudinal = modes.longitudinal_cm1.iter().zip(&modes.longitudinal_damping_cm1);
        transverse.zip(longitudinal).fold(
            Complex::from(modes.high_frequency),
            |product, ((&to, &to_damping), (&lo, &lo_damping))| {
                product * pole(lo, lo_damping, wavenumber_cm1) / pole(to, to_damping, wavenumber_cm1)
            },
        )
    }
}

/// ν₀² − ν² − iγν, written so that it keeps its digits near the resonance.
fn pole(resonance_cm1: f64, damping_cm1: f64, wavenumber_cm1: f64) -> Complex<f64> {
    Complex::new(
        (resonance_cm1 - wavenumber_cm1) * (resonance_cm1 + wavenumber_cm1),
        -damping_cm1 * wavenumber_cm1,
    )
}

/// A list of `count` numbers, all above 0.
pub(super) fn all_positive(quantity: &str, values: &[f64], count: usize) -> Result<()> {
    if values.len() != count {
        return Err(Error::Length { what: quantity.to_owned(), found: values.len(), expected: count });
    }
    values.iter().try_for_each(|&value| check::positive(quantity, value, "").map(drop))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Far above every mode only ε∞ is left; far below, the Lyddane–Sachs–Teller relation holds.
    #[test]
    fn the_limits_of_a_crystal_are_its_two_permittivities() {
        let crystal = Factorised::try_from(FactorisedParameters {
            high_frequency: 6.7,
            transverse_cm1: vec![793.0],
            transverse_damping_cm1: vec![4.76],
            longitudinal_cm1: vec![969.0],
            longitudinal_damping_cm1: vec![4.76],
        })
        .unwrap();
        let high = crystal.permittivity(1e8);
        assert!((high - 6.7).norm() < 1e-8, "{high}");
        let low = crystal.permittivity(1e-6);
        assert!((low - 6.7 * (969.0f64 / 793.0).powi(2)).norm() < 1e-7, "{low}");
    }

    /// One factorised mode with equal dampings is one Lorentz line of strength ε∞(ν_LO²/ν_TO² − 1).
    #[test]
    fn a_factorised_mode_with_equal_dampings_is_a_lorentz_line() {
        let (to, lo, damping, high_frequency): (f64, f64, f64, f64) = (793.0, 969.0, 4.76, 6.7);
        let factorised = Factorised::try_from(FactorisedParameters {
            high_frequency,
            transverse_cm1: vec![to],
            transverse_damping_cm1: vec![damping],
            longitudinal_cm1: vec![lo],
            longitudinal_damping_cm1: vec![damping],
        })
        .unwrap();
        let lorentz = Lorentz::try_from(LorentzParameters {
            high_frequency,
            resonance_cm1: vec![to],
            strength: vec![high_frequency * ((lo / to).powi(2) - 1.0)],
            damping_cm1: vec![damping],
        })
        .unwrap();
        for wavenumber in [500.0, 790.0, 793.0, 900.0, 1400.0] {
            let (a, b) = (factorised.permittivity(wavenumber), lorentz.permittivity(wavenumber));
            assert!((a - b).norm() < 1e-12 * a.norm(), "{wavenumber}: {a} {b}");
        }
    }

    /// Below the damping a metal obeys Ohm's law: Im ε → ν_p²/(ν ν_τ), Re ε → ε∞ − (ν_p/ν_τ)².
    #[test]
    fn a_slow_field_sees_a_conductor() {
        let metal =
            Drude::try_from(DrudeParameters { high_frequency: 1.0, plasma_cm1: 1.19e5, damping_cm1: 660.0 })
                .unwrap();
        let slow = metal.permittivity(1e-3);
        assert!((slow.im / (1.19e5f64.powi(2) / (1e-3 * 660.0)) - 1.0).abs() < 1e-11, "{slow}");
        assert!((slow.re / (1.0 - (1.19e5f64 / 660.0).powi(2)) - 1.0).abs() < 1e-11, "{slow}");
    }

    #[test]
    fn lists_of_unequal_length_and_negative_dampings_are_refused() {
        let parameters = LorentzParameters {
            high_frequency: 2.0,
            resonance_cm1: vec![700.0, 800.0],
            strength: vec![0.1],
            damping_cm1: vec![5.0, 5.0],
        };
        assert!(matches!(Lorentz::try_from(parameters.clone()), Err(Error::Length { .. })));
        let negative =
            LorentzParameters { strength: vec![0.1, 0.1], damping_cm1: vec![5.0, -5.0], ..parameters };
        assert!(matches!(Lorentz::try_from(negative), Err(Error::OutOfRange { .. })));
    }
}
