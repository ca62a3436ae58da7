//! What diffraction leaves of the position of a point source.
//!
//! One photon that falls at (x, y) with density h(x − x₀, y − y₀) tells J = ∬ (∂ₓh)²/h dx dy of x₀ (m⁻²); N photons
//! tell N J, and the deviation that diffraction leaves is σ_d = 1/√J per photon. Never the second moment of h, which
//! is infinite for an Airy disk; for a Gaussian the two agree.
//!
//! * Gaussian of deviation σ: J = 1/σ², σ_d = σ.
//! * Airy disk h = a² of a circular aperture without aberrations or obstruction: (∂ₓh)²/h = 4(∂ₓa)², so that by
//!   Parseval J = 4⟨kₓ²⟩ over the pupil, a disk of radius k = π/(λF) in spatial frequency: ⟨kₓ²⟩ = k²/4,
//!   J = (π/λF)² = (πDν/f)², σ_d = λF/π, with λ = 1/ν (m), F = f/D, focal length f and aperture D (m).
//!   Of J, all but J₀² + 2J₁² + J₂² at v = πr/(λF) comes from within the radius r.
//!
//! **Bands** that are counted apart: J is the mean of their J, weighted with their photons; added up before they are
//! counted, they tell at most that (J is convex in h).
//!
//! Assumptions: no background, flux known or not (it does not change with x₀ to first order for a symmetric h), no
//! electronic noise (that is γ in [`super::depth`]), pixels that are fine beside the point spread, far target (image in the focal plane).
//!
//! Source: paper S41–S43.

#[cfg(test)]
mod tests;

use crate::error::{Error, Result, check};
use std::f64::consts::PI;

/// Image of a point source, normalised to one photon.
///
/// ```
/// use hadar::ranging::psf::PointSpread;
/// // 769 cm⁻¹ (13 µm) through f/1.4: σ_d = λF/π.
/// let airy = PointSpread::airy(1.4, 769.0)?;
/// assert!((airy.sigma_m() / 5.795e-6 - 1.0).abs() < 1e-3);
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointSpread {
    shape: Shape,
    /// σ of a Gaussian, λF of an Airy disk, m.
    scale_m: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Shape {
    Gaussian,
    Airy,
}

impl PointSpread {
    /// A Gaussian of deviation `sigma_m` (m) along x and along y.
    ///
    /// # Errors
    /// A deviation that is not positive.
    pub fn gaussian(sigma_m: f64) -> Result<Self> {
        Self { shape: Shape::Gaussian, scale_m: check::positive("sigma of the point spread", sigma_m, "m")? }
            .checked()
    }

    /// The Airy disk of a lens of f-number `f_number` at `wavenumber_cm1` (cm⁻¹).
    ///
    /// # Errors
    /// A number that is not positive.
    pub fn airy(f_number: f64, wavenumber_cm1: f64) -> Result<Self> {
        check::positive("f_number", f_number, "")?;
        check::positive("wavenumber", wavenumber_cm1, "cm^-1")?;
        Self { shape: Shape::Airy, scale_m: 0.01 * f_number / wavenumber_cm1 }.checked()
    }

    /// The Airy disk of an aperture of `aperture_m` (m) before a focal length of `focal_length_m` (m).
    ///
    /// # Errors
    /// A number that is not positive.
    pub fn airy_of_aperture(aperture_m: f64, focal_length_m: f64, wavenumber_cm1: f64) -> Result<Self> {
        check::positive("aperture", aperture_m, "m")?;
        check::positive("focal_length", focal_length_m, "m")?;
        Self::airy(focal_length_m / aperture_m, wavenumber_cm1)
    }

    /// Its squares and their inverses must be numbers.
    fn checked(self) -> Result<Self> {
        if (1e-150..1e150).contains(&self.scale_m) {
            return Ok(self);
        }
        Err(Error::out_of_range("width of the point spread", self.scale_m, "m", "between 1e-150 and 1e150 m"))
    }

    /// σ_d = 1/√J, m: the least deviation of x₀ from one photon whose place is seen exactly.
    #[must_use]
    pub fn sigma_m(&self) -> f64 {
        match self.shape {
            Shape::Gaussian => self.scale_m,
            Shape::Airy => self.scale_m / PI,
        }
    }

    /// σ_d² = 1/J, m².
    #[must_use]
    pub fn var_m2(&self) -> f64 {
        self.sigma_m() * self.sigma_m()
    }

    /// J, m⁻² per photon.
    #[must_use]
    pub fn information_per_m2(&self) -> f64 {
        1.0 / self.var_m2()
    }
}

/// σ_d² = 1/J (m²) of bands that are counted apart: point spread and photons (any unit) of each, J = Σ N J/Σ N.
///
/// # Errors
/// No bands, photons that are negative or no numbers, or none at all.
///
/// ```
/// use hadar::ranging::psf::{PointSpread, bands_var_m2};
/// let [low, high] = [800.0, 1200.0].map(|nu| PointSpread::airy(1.3, nu));
/// let (low, high) = (low?, high?);
/// let both = bands_var_m2(&[(low, 3.0), (high, 1.0)])?;
/// // J ∝ ν².
/// let exact = 0.75 * low.information_per_m2() + 0.25 * high.information_per_m2();
/// assert!((both * exact - 1.0).abs() < 1e-14);
/// # Ok::<(), hadar::Error>(())
/// ```
pub fn bands_var_m2(bands: &[(PointSpread, f64)]) -> Result<f64> {
    for (_, photons) in bands {
        check::non_negative("photons of a band", *photons, "")?;
    }
    let total = check::positive("photons of all bands", bands.iter().map(|band| band.1).sum(), "")?;
    Ok(1.0 / bands.iter().map(|(spread, photons)| photons / total * spread.information_per_m2()).sum::<f64>())
}
