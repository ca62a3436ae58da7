//! What a window tells of its position: as numbers, or as samples from which it is computed at other exposures.

use crate::error::{Error, Result, check};
use crate::sum::Compensated;

/// Information and photons of one window in one view.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct WindowInformation {
    information_px2: f64,
    photons: f64,
    var_added: f64,
}

impl WindowInformation {
    /// J (pixel⁻²) of a window of `photons` photons in all, with electronic noise ΣΣσ² (counts²).
    ///
    /// # Errors
    /// A number that is negative or none; information without photons.
    pub fn new(information_px2: f64, photons: f64, var_added: f64) -> Result<Self> {
        check::non_negative("information J of a window", information_px2, "pixel^-2")?;
        check::non_negative("photons of a window", photons, "")?;
        check::non_negative("electronic noise of a window", var_added, "counts^2")?;
        // Dark pixels beside bright ones have a slope, which electronic noise makes finite information of.
        if information_px2 > 0.0 && photons == 0.0 && var_added == 0.0 {
            return Err(Error::malformed(
                format!("a window of information {information_px2} pixel^-2 without photons"),
                "give the photons it was counted from",
            ));
        }
        Ok(Self { information_px2, photons, var_added })
    }

    /// J, pixel⁻².
    #[must_use]
    pub const fn information_px2(&self) -> f64 {
        self.information_px2
    }

    /// N.
    #[must_use]
    pub const fn photons(&self) -> f64 {
        self.photons
    }

    /// γ = ΣΣσ²/N; infinite without photons.
    #[must_use]
    pub fn gamma(&self) -> f64 {
        if self.photons > 0.0 { self.var_added / self.photons } else { f64::INFINITY }
    }

    /// σ_c² = N/(J(1 + γ)), pixel²: position variance that one photon without noise would have; infinite where J is 0.
    #[must_use]
    pub fn var_content_px2(&self) -> f64 {
        if self.information_px2 == 0.0 {
            return f64::INFINITY;
        }
        1.0 / (self.information_px2 * self.var_of_one_photon())
    }

    /// σ_d²(1 + γ)/N, pixel²: what diffraction of `var_one_photon_px2` = σ_d² (pixel²) adds; infinite without photons.
    #[must_use]
    pub fn var_diffraction_px2(&self, var_one_photon_px2: f64) -> f64 {
        if var_one_photon_px2 == 0.0 { 0.0 } else { var_one_photon_px2 * self.var_of_one_photon() }
    }

    /// Variance of the window's position in this view, pixel² (half of S43's): 1/J + σ_d²(1 + γ)/N.
    #[must_use]
    pub fn var_position_px2(&self, var_one_photon_px2: f64) -> f64 {
        1.0 / self.information_px2 + self.var_diffraction_px2(var_one_photon_px2)
    }

    /// (1 + γ)/N: by what N photons with their noise divide the variance of one.
    fn var_of_one_photon(&self) -> f64 {
        if self.photons > 0.0 { (1.0 + self.var_added / self.photons) / self.photons } else { f64::INFINITY }
    }
}

/// Samples of one window in one view: pixels and bands, or what they are joined to ([`super::super::noise::Joined`]).
///
/// J(k, q) = Σ (k ∂N)²/(k N + q σ²) when photons grow k-fold and the variance of the noise q-fold.
///
/// ```
/// use hadar::ranging::depth::WindowSamples;
/// let window = WindowSamples::new(vec![100.0, 80.0], vec![5.0, -4.0], vec![25.0, 25.0])?;
/// let now = window.information_at(1.0, 1.0)?;
/// assert!((now - (25.0 / 125.0 + 16.0 / 105.0)).abs() < 1e-15);
/// assert!(window.information_at(4.0, 1.0)? > 4.0 * now);
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct WindowSamples {
    counts: Vec<f64>,
    derivative: Vec<f64>,
    var_added: Vec<f64>,
}

impl WindowSamples {
    /// Expected counts N, ∂N/∂x (pixel⁻¹) and σ² (counts²; empty for none) of every sample.
    ///
    /// # Errors
    /// No samples, lists that differ in length, counts or noise that are negative or no numbers.
    pub fn new(counts: Vec<f64>, derivative: Vec<f64>, var_added: Vec<f64>) -> Result<Self> {
        let expected = counts.len();
        if expected == 0 {
            return Err(Error::malformed(
                "a window without samples",
                "give the counts of at least one pixel",
            ));
        }
        let length = |what: &str, found| Err(Error::Length { what: what.to_owned(), found, expected });
        if derivative.len() != expected {
            return length("derivatives of a window's counts", derivative.len());
        }
        if !var_added.is_empty() && var_added.len() != expected {
            return length("noise variances of a window", var_added.len());
        }
        for &value in &counts {
            check::non_negative("counts of a sample", value, "")?;
        }
        for &value in &derivative {
            check::finite("derivative of counts", value, "counts per pixel")?;
        }
        for &value in &var_added {
            check::non_negative("noise variance", value, "counts^2")?;
        }
        Ok(Self { counts, derivative, var_added })
    }

    /// J with `photon_factor` times the photons and `noise_factor` times the variance of the electronic noise, pixel⁻². A
    /// sample without counts or noise tells nothing.
    ///
    /// # Errors
    /// A factor that is negative or no number; a J that is none.
    pub fn information_at(&self, photon_factor: f64, noise_factor: f64) -> Result<f64> {
        check::non_negative("factor of the photons", photon_factor, "")?;
        check::non_negative("factor of the noise", noise_factor, "")?;
        let mut information = Compensated::default();
        for (i, (counts, slope)) in self.counts.iter().zip(&self.derivative).enumerate() {
            let var = photon_factor * counts + noise_factor * self.var_added.get(i).copied().unwrap_or(0.0);
            if var > 0.0 {
                let score = photon_factor * slope / var.sqrt();
                information.add(score * score);
            }
        }
        check::non_negative("information J of a window", information.value(), "pixel^-2")
    }

    /// Information and photons with these factors.
    ///
    /// # Errors
    /// As [`WindowSamples::information_at`].
    pub fn window_at(&self, photon_factor: f64, noise_factor: f64) -> Result<WindowInformation> {
        WindowInformation::new(
            self.information_at(photon_factor, noise_factor)?,
            photon_factor * crate::sum::sum(&self.counts),
            noise_factor * crate::sum::sum(&self.var_added),
        )
    }

    /// Root mean square σ of the electronic noise of a sample, counts.
    #[must_use]
    pub fn noise_counts(&self) -> f64 {
        (crate::sum::sum(&self.var_added) / self.counts.len() as f64).sqrt()
    }
}
