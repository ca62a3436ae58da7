//! Derivative along x of a row of counts.
//!
//! Four schemes for ∂N/∂x on a grid of pixels, with what each makes of a sinusoid of ω rad/pixel
//! ([`Derivative::response`], relative to the true iω; 1 is exact):
//!
//! * central difference, (N[x+1] − N[x−1])/2: sin ω/ω. No value in 1 column at either end; exact for quadratics.
//! * five taps of Farid and Simoncelli, Σ d_k N[x+k] with d = (−0.109604, −0.276691, 0, 0.276691, 0.109604): D/ω with
//!   D = 2(0.276691 sin ω + 0.109604 sin 2ω). It is meant as the derivative of the image smoothed by their prefilter
//!   p = (0.037659, 0.249153, 0.426375, 0.249153, 0.037659): relative to that, D/(ωP), with P = 0.426375 + 2(0.249153
//!   cos ω + 0.037659 cos 2ω), near 1 up to ω ≈ 2. The counts it is divided by are not smoothed here, nor is anything
//!   along y. No value in 2 columns at either end.
//! * derivative at the knots of the interpolating cubic spline, whose third derivative is continuous at the second
//!   and last but one knot (not-a-knot: exact for cubics): 3 sin ω/(ω(2 + cos ω)), the influence of the ends falling
//!   by 2 − √3 per pixel. A value in every column; the tridiagonal system is eliminated, 5 operations per sample.
//! * Fourier: trigonometric interpolation of the row followed by its mirror image (half a pixel beyond its ends),
//!   which has no jump where the row's own periodic continuation would have one: 1 up to the Nyquist frequency π.
//!   What is left is a kink at each end, unless the row is level there: near the ends the derivative tends to 0 and
//!   rings. A value in every column.
//!
//! Source: H. Farid, E. P. Simoncelli, IEEE Trans. Image Process. 13, 496 (2004), doi:10.1109/TIP.2004.823819,
//! first derivative with five taps; C. de Boor, A Practical Guide to Splines (1978), chapter IV; the rest is elementary.

mod fourier;
mod spline;
#[cfg(test)]
mod tests;

use crate::error::{Error, Result, check};
use fourier::Fourier;
use spline::Spline;
use std::f64::consts::PI;

crate::base::named::named! {
    /// How ∂N/∂x is taken on a grid of pixels.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Derivative {
        /// (N[x+1] − N[x−1])/2.
        #[default]
        Central = "central",
        /// Five taps, Farid and Simoncelli.
        Simoncelli = "simoncelli",
        /// Of the interpolating cubic spline.
        CubicSpline = "cubic-spline",
        /// Of the trigonometric interpolation.
        Fourier = "fourier",
    }
    /// The name in a scenario.
    name
}

/// Farid and Simoncelli's first derivative, of the pixels at a distance of 1 and 2 to the right.
const TAPS: [f64; 2] = [0.276_691, 0.109_604];

impl Derivative {
    /// Columns at either end of a row that have no value.
    ///
    /// ```
    /// use hadar::ranging::derivative::Derivative;
    /// assert_eq!(Derivative::ALL.map(Derivative::margin), [1, 2, 0, 0]);
    /// ```
    #[must_use]
    pub const fn margin(self) -> usize {
        match self {
            Self::Central => 1,
            Self::Simoncelli => 2,
            Self::CubicSpline | Self::Fourier => 0,
        }
    }

    /// The narrowest image it can be taken of.
    const fn least_columns(self) -> usize {
        match self {
            Self::Central => 3,
            Self::Simoncelli => 5,
            Self::CubicSpline => 4,
            Self::Fourier => 2,
        }
    }

    /// Whether a row of so many columns has a derivative.
    pub(super) fn check_columns(self, columns: usize) -> Result<()> {
        let least = self.least_columns();
        if columns >= least {
            return Ok(());
        }
        let found = format!("an image of {columns} columns for the derivative {}", self.name());
        Err(Error::malformed(found, format!("it takes at least {least}")))
    }

    /// What it gives for exp(iωx), over the true iω exp(iωx): real, 1 where exact. ω in rad/pixel, up to π.
    ///
    /// ```
    /// use hadar::ranging::derivative::Derivative;
    /// // Eight pixels per period: 10 % too little by differences, 1 % by the spline.
    /// let omega = std::f64::consts::TAU / 8.0;
    /// assert!((Derivative::Central.response(omega)? - 0.900).abs() < 1e-3);
    /// assert!((Derivative::CubicSpline.response(omega)? - 0.998).abs() < 1e-3);
    /// # Ok::<(), hadar::Error>(())
    /// ```
    ///
    /// # Errors
    /// A frequency that is negative or beyond π.
    pub fn response(self, omega_rad_per_pixel: f64) -> Result<f64> {
        let omega = frequency(omega_rad_per_pixel)?;
        let (sin, cos) = libm::sincos(omega);
        let over_omega = |slope: f64, limit: f64| if omega == 0.0 { limit } else { slope / omega };
        Ok(match self {
            Self::Central => over_omega(sin, 1.0),
            Self::Simoncelli => {
                let [one, two] = TAPS;
                // sin 2ω = 2 sin ω cos ω
                over_omega(2.0 * sin * (2.0 * two).mul_add(cos, one), 4.0f64.mul_add(two, 2.0 * one))
            }
            Self::CubicSpline => over_omega(3.0 * sin / (2.0 + cos), 1.0),
            Self::Fourier if omega < PI => 1.0,
            Self::Fourier => 0.0,
        })
    }

    /// Error of the derivative of a sinusoid over its true amplitude: response − 1, negative where it comes out too
    /// small.
    ///
    /// # Errors
    /// A frequency that is negative or beyond π.
    pub fn relative_error(self, omega_rad_per_pixel: f64) -> Result<f64> {
        Ok(self.response(omega_rad_per_pixel)? - 1.0)
    }
}

fn frequency(omega: f64) -> Result<f64> {
    check::non_negative("frequency", omega, "rad/pixel")?;
    if omega <= PI {
        return Ok(omega);
    }
    let expected = "at most pi, the Nyquist frequency";
    Err(Error::out_of_range("frequency", omega, "rad/pixel", expected))
}

/// Takes the derivative of rows of a certain number of columns.
#[derive(Debug, Clone)]
pub struct Differentiator {
    columns: usize,
    margin: usize,
    scheme: Scheme,
}

#[derive(Debug, Clone)]
enum Scheme {
    Central,
    Simoncelli,
    Spline(Spline),
    Fourier(Fourier),
}

impl Differentiator {
    /// For rows of `columns` pixels.
    ///
    /// # Errors
    /// Too few columns: central differences take 3, five taps 5, a spline 4, a Fourier series 2.
    pub fn new(derivative: Derivative, columns: usize) -> Result<Self> {
        derivative.check_columns(columns)?;
        let scheme = match derivative {
            Derivative::Central => Scheme::Central,
            Derivative::Simoncelli => Scheme::Simoncelli,
            Derivative::CubicSpline => Scheme::Spline(Spline::new(columns)),
            Derivative::Fourier => Scheme::Fourier(Fourier::new(columns)),
        };
        Ok(Self { columns, margin: derivative.margin(), scheme })
    }

    /// ∂N/∂x, pixel⁻¹, of a row \[column\]\[band\]; `slope` \[column\]\[band\] has no room for the columns without a value
    /// ([`Derivative::margin`] at either end).
    ///
    /// ```
    /// use hadar::ranging::derivative::{Derivative, Differentiator};
    /// let mut slope = [0.0; 3];
    /// Differentiator::new(Derivative::Central, 5)?.apply(&[0.0, 1.0, 4.0, 9.0, 16.0], 1, &mut slope)?;
    /// assert_eq!(slope, [2.0, 4.0, 6.0]);
    /// # Ok::<(), hadar::Error>(())
    /// ```
    ///
    /// # Errors
    /// Lengths that do not fit.
    pub fn apply(&mut self, row: &[f64], bands: usize, slope: &mut [f64]) -> Result<()> {
        let fits = |what: &str, found: usize, columns: usize| match columns.checked_mul(bands) {
            Some(expected) if expected == found && bands > 0 => Ok(()),
            expected => {
                Err(Error::Length { what: what.to_owned(), found, expected: expected.unwrap_or(usize::MAX) })
            }
        };
        fits("counts of a row", row.len(), self.columns)?;
        fits("slopes of a row", slope.len(), self.columns - 2 * self.margin)?;
        match &mut self.scheme {
            Scheme::Central => {
                for (slope, (before, after)) in slope.iter_mut().zip(row.iter().zip(&row[2 * bands..])) {
                    *slope = 0.5 * (after - before);
                }
            }
            Scheme::Simoncelli => {
                let far = row.iter().zip(&row[4 * bands..]);
                let near = row[bands..].iter().zip(&row[3 * bands..]);
                for (slope, ((l2, r2), (l1, r1))) in slope.iter_mut().zip(far.zip(near)) {
                    *slope = TAPS[0].mul_add(r1 - l1, TAPS[1] * (r2 - l2));
                }
            }
            Scheme::Spline(spline) => spline.apply(row, bands, slope),
            Scheme::Fourier(fourier) => fourier.apply(row, bands, slope),
        }
        Ok(())
    }
}
