//! Complex refractive index m = n + ik of a medium, from a table or from its permittivity.
//!
//! Time convention exp(−iωt): an absorbing medium has k > 0 and Im ε > 0; m² = ε. Wavenumber ν and
//! every oscillator parameter are in cm⁻¹.
//!
//! - table: n and k linear in ν between rows;
//! - [`Drude`], [`Lorentz`], [`Factorised`]: see `oscillator`;
//! - [`Gaussian`]: see `gaussian`.

use super::gaussian::Gaussian;
use super::oscillator::{Drude, Factorised, Lorentz};
use super::table::Table;
use crate::error::{Error, Result, check};
use nalgebra::Complex;

/// What the optical constants of a medium are computed from.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Dielectric {
    Constants(OpticalConstants),
    Drude(Drude),
    Lorentz(Lorentz),
    Factorised(Factorised),
    Gaussian(Gaussian),
}

/// A table of refractive index n > 0 and extinction index k ≥ 0.
#[derive(Debug, Clone, PartialEq)]
pub struct OpticalConstants(Table<2>);

impl OpticalConstants {
    /// The constants of rows (wavenumber in cm⁻¹, [n, k]) in any order.
    ///
    /// # Errors
    /// Rows that are no table (see [`Table::new`]), n ≤ 0 or k < 0.
    pub fn new(rows: &[(f64, [f64; 2])]) -> Result<Self> {
        for (_, [n, k]) in rows {
            check::positive("refractive index n", *n, "")?;
            check::non_negative("extinction index k", *k, "")?;
        }
        Table::new(rows).map(Self)
    }
}

impl Dielectric {
    /// Complex refractive index at a wavenumber in cm⁻¹.
    ///
    /// # Errors
    /// Outside the table's rows or in a gap of them; a model that would amplify.
    pub(super) fn index(&self, wavenumber_cm1: f64) -> Result<Complex<f64>> {
        let permittivity = match self {
            Self::Constants(OpticalConstants(table)) => {
                table.check_gap(wavenumber_cm1)?;
                let [n, k] = table.at(wavenumber_cm1).ok_or_else(|| {
                    let (low, high) = table.range_cm1().unwrap_or((f64::NAN, f64::NAN));
                    Error::out_of_range(
                        "wavenumber of the optical constants",
                        wavenumber_cm1,
                        "cm^-1",
                        format!("between {low} and {high} cm^-1"),
                    )
                })?;
                return Ok(Complex::new(n, k));
            }
            Self::Drude(drude) => drude.permittivity(wavenumber_cm1),
            Self::Lorentz(lorentz) => lorentz.permittivity(wavenumber_cm1),
            Self::Factorised(factorised) => factorised.permittivity(wavenumber_cm1),
            Self::Gaussian(gaussian) => gaussian.permittivity(wavenumber_cm1),
        };
        // with unequal dampings a factorised model can have Im ε < 0, which no passive medium has
        check::non_negative("imaginary part of the permittivity", permittivity.im, "")?;
        Ok(square_root(permittivity))
    }

    /// Rows of the table, if it is one.
    pub(super) fn table(&self) -> Option<&Table<2>> {
        match self {
            Self::Constants(OpticalConstants(table)) => Some(table),
            _ => None,
        }
    }
}

/// The root with n ≥ 0 and k ≥ 0 of a number with Im ≥ 0. The smaller of n and k comes from the imaginary part, so that
/// neither loses digits to the other (a metal has k ≫ n, a window n ≫ k).
fn square_root(permittivity: Complex<f64>) -> Complex<f64> {
    let Complex { re, im } = permittivity;
    let larger = ((re.hypot(im) + re.abs()) / 2.0).sqrt();
    if larger == 0.0 {
        Complex::new(0.0, 0.0)
    } else if re >= 0.0 {
        Complex::new(larger, im / (2.0 * larger))
    } else {
        Complex::new(im / (2.0 * larger), larger)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_root_keeps_its_small_part() {
        // 1e-9 beside 1e3: a root through polar form would keep four digits of n
        let root = square_root(Complex::new(1e-9f64.powi(2) - 1e6, 2.0 * 1e-9 * 1e3));
        assert!((root.re / 1e-9 - 1.0).abs() < 1e-15, "{root}");
        assert!((root.im / 1e3 - 1.0).abs() < 1e-15, "{root}");
        let root = square_root(Complex::new(5.0, 12.0));
        assert!((root - Complex::new(3.0, 2.0)).norm() < 1e-15, "{root}");
    }

    #[test]
    fn unphysical_constants_are_refused() {
        assert!(OpticalConstants::new(&[(800.0, [0.0, 1.0]), (900.0, [1.0, 1.0])]).is_err());
        assert!(OpticalConstants::new(&[(800.0, [1.0, -1.0]), (900.0, [1.0, 1.0])]).is_err());
        let medium = Dielectric::Constants(
            OpticalConstants::new(&[(800.0, [1.0, 2.0]), (900.0, [2.0, 4.0])]).unwrap(),
        );
        assert_eq!(medium.index(850.0).unwrap(), Complex::new(1.5, 3.0));
        assert!(medium.index(950.0).is_err());
        let rows: Vec<_> = (0..30).chain(60..90).map(|i| (800.0 + 4.0 * f64::from(i), [1.5, 0.1])).collect();
        let medium = Dielectric::Constants(OpticalConstants::new(&rows).unwrap());
        for (at, is_known) in [(916.0, true), (917.0, false), (1039.0, false), (1040.0, true), (1041.0, true)]
        {
            assert_eq!(medium.index(at).is_ok(), is_known, "{at}");
        }
    }
}
