//! Depth bound: δz, and what a demanded δz asks of the stereo camera.
//!
//! Parallel cameras a baseline b (m) apart, focal length f (m), pixel pitch p (m): a point at depth z (m) has the
//! disparity d = b f/(z p) pixels, so that δz = z²/(b f)·p·δd (S36).
//!
//! * δd ≥ √(1/J_left + 1/J_right) pixels, J (pixel⁻²) what each view tells of the window's position (S41);
//! * S43: δz ≥ z²/(b f)·√(2(σ_c² + σ_d²)(1 + γ)/N) with N photons of the window in one view, γ = ΣΣσ²/N, and the
//!   position variances of one photon, both m² in the image: σ_c² = p² N/(J (1 + γ)) of the texture, σ_d² of
//!   diffraction and pixel ([`super::psf`]). Views that differ add their halves. The paper's eq. 3 leaves z²/(b f) out,
//!   which is not of order 1 (3.2e5 at 30 m for b = 0.2 m, f = 14 mm).
//! * Which image J is of ([`Image`]): in a measured (or blurred) one the blur has already lessened J, and σ_d would count
//!   it twice; to an ideal one σ_d is added. By Stam's inequality 1/J(blurred) ≥ 1/J(ideal) + 1/J_PSF, with
//!   equality for Gaussians: S43 stays below the true bound, and the measured image's own J is the closer one.
//!
//! Assumptions: calibrated and rectified cameras; **vergent cameras are out of scope**; the window's depth is one
//! number; unbiased matching (no bias bound); δz ≪ z. An infinite bound means that nothing tells the position.
//!
//! Source: paper eq. 3, S35–S43; Stam, Inf. Control 2, 101 (1959), doi:10.1016/S0019-9958(59)90348-1.

mod solve;
#[cfg(test)]
mod tests;
mod window;

pub use solve::{Demand, DepthSolution, DepthTask, ExposureNoise, frame_is_over, well_is_full};
pub use window::{WindowInformation, WindowSamples};

use crate::error::{Error, Result, check};

/// Two parallel cameras.
///
/// ```
/// use hadar::ranging::depth::{StereoGeometry, disparity_bound_px};
/// let stereo = StereoGeometry::new(0.2, 0.014, 12e-6)?;
/// let disparity = stereo.disparity_px(30.0)?;
/// assert!((disparity - 0.2 * 0.014 / (30.0 * 12e-6)).abs() < 1e-12);
/// assert!((stereo.depth_m(disparity)? - 30.0).abs() < 1e-12);
/// // 1/100 of a pixel in each view: 5.5 cm at 30 m.
/// let sigma_px = disparity_bound_px(1e4, None)?;
/// assert!((stereo.depth_error_m(30.0, sigma_px)? / 0.054_55 - 1.0).abs() < 1e-3);
/// assert!(StereoGeometry::new(0.0, 0.014, 12e-6).is_err());
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct StereoGeometry {
    baseline_m: f64,
    focal_length_m: f64,
    pitch_m: f64,
}

impl StereoGeometry {
    /// Cameras `baseline_m` apart, of one focal length and pixel pitch (m).
    ///
    /// # Errors
    /// A length that is not positive.
    pub fn new(baseline_m: f64, focal_length_m: f64, pitch_m: f64) -> Result<Self> {
        if baseline_m == 0.0 {
            return Err(Error::malformed(
                "the two cameras stand in the same place (baseline 0 m), from where depth cannot be determined",
                "give the distance between their centres, e.g. baseline = \"0.2 m\"",
            ));
        }
        check::positive("baseline", baseline_m, "m")?;
        check::positive("focal_length", focal_length_m, "m")?;
        check::positive("pixel", pitch_m, "m")?;
        check::positive("baseline times focal length", baseline_m * focal_length_m, "m^2")?;
        Ok(Self { baseline_m, focal_length_m, pitch_m })
    }

    /// b, m.
    #[must_use]
    pub const fn baseline_m(&self) -> f64 {
        self.baseline_m
    }

    /// f, m.
    #[must_use]
    pub const fn focal_length_m(&self) -> f64 {
        self.focal_length_m
    }

    /// p, m.
    #[must_use]
    pub const fn pitch_m(&self) -> f64 {
        self.pitch_m
    }

    /// Disparity d = x_left − x_right of a point at depth `distance_m`, pixels.
    ///
    /// # Errors
    /// A depth that is not positive, or so small that the disparity is no number.
    pub fn disparity_px(&self, distance_m: f64) -> Result<f64> {
        check::positive("distance", distance_m, "m")?;
        let disparity = self.baseline_m * self.focal_length_m / distance_m / self.pitch_m;
        check::positive("disparity", disparity, "pixels")
    }

    /// Depth of a point of disparity `disparity_px`, m.
    ///
    /// # Errors
    /// A disparity that is not positive (0 is infinitely far), or so small that the depth is no number.
    pub fn depth_m(&self, disparity_px: f64) -> Result<f64> {
        check::positive("disparity", disparity_px, "pixels")?;
        check::positive("depth", self.baseline_m * self.focal_length_m / disparity_px / self.pitch_m, "m")
    }

    /// δz = z²/(b f)·p·δd, m, of an error `sigma_px` of disparity (pixels) at depth `distance_m`; infinite for an infinite
    /// one.
    ///
    /// # Errors
    /// A depth that is not positive, an error that is negative or NaN.
    pub fn depth_error_m(&self, distance_m: f64, sigma_px: f64) -> Result<f64> {
        check::positive("distance", distance_m, "m")?;
        if sigma_px.is_nan() || sigma_px < 0.0 {
            return Err(Error::out_of_range("error of disparity", sigma_px, "pixels", "0 or above"));
        }
        Ok(self.metres_per_pixel(distance_m) * sigma_px)
    }

    /// S43 for a window seen in two `views`, left and right (the same twice where only one is known).
    ///
    /// # Errors
    /// A depth that is not positive.
    ///
    /// ```
    /// use hadar::ranging::depth::{Image, StereoGeometry, WindowInformation};
    /// use hadar::ranging::psf::PointSpread;
    /// let stereo = StereoGeometry::new(0.2, 0.014, 12e-6)?;
    /// // J = 2e3 pixel⁻² from 1e5 photons, in a scene computed without blur.
    /// let window = WindowInformation::new(2e3, 1e5, 0.0)?;
    /// let airy = Image::Ideal { var_diffraction_m2: PointSpread::airy(1.4, 769.0)?.var_m2() };
    /// let sharp = stereo.depth_bound(30.0, [window; 2], Image::Measured)?;
    /// let blurred = stereo.depth_bound(30.0, [window; 2], airy)?;
    /// assert!(blurred.sigma_z_m > sharp.sigma_z_m);
    /// assert!((sharp.sigma_disparity_px - 1e-3_f64.sqrt()).abs() < 1e-15);
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn depth_bound(
        &self,
        distance_m: f64,
        views: [WindowInformation; 2],
        image: Image,
    ) -> Result<DepthBound> {
        let var_diffraction_m2 = image.checked()?.var_diffraction_m2();
        let sum = |of: &dyn Fn(&WindowInformation) -> f64| views.iter().map(of).sum::<f64>();
        let var_content = sum(&|view| 1.0 / view.information_px2());
        let var_diffraction_px2 = var_diffraction_m2 / self.pitch_m / self.pitch_m;
        let var_diffraction = sum(&|view| view.var_diffraction_px2(var_diffraction_px2));
        let sigma_disparity_px = (var_content + var_diffraction).sqrt();
        let sigma_z_m = self.depth_error_m(distance_m, sigma_disparity_px)?;
        Ok(DepthBound {
            sigma_z_m,
            relative: sigma_z_m / distance_m,
            sigma_disparity_px,
            sigma_content_px: var_content.sqrt(),
            sigma_diffraction_px: var_diffraction.sqrt(),
        })
    }

    /// z²/(b f)·p.
    pub fn metres_per_pixel(&self, distance_m: f64) -> f64 {
        distance_m / self.baseline_m * (distance_m / self.focal_length_m) * self.pitch_m
    }
}

/// What the information J of a window was computed from.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Image {
    /// An image that went through the optics, or was computed with their blur: its J has the blur in it.
    Measured,
    /// A scene before the optics, at the pitch of the pixels.
    Ideal {
        /// σ_d² of one photon, m² in the image.
        var_diffraction_m2: f64,
    },
}

impl Image {
    fn checked(self) -> Result<Self> {
        check::non_negative("sigma_d^2", self.var_diffraction_m2(), "m^2")?;
        Ok(self)
    }

    fn var_diffraction_m2(self) -> f64 {
        match self {
            Self::Measured => 0.0,
            Self::Ideal { var_diffraction_m2 } => var_diffraction_m2,
        }
    }
}

/// Least error of a window's depth. Infinite where nothing tells the position.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct DepthBound {
    /// Least error δz of the depth, m.
    pub sigma_z_m: f64,
    /// Least error of the depth over the depth, δz/z.
    pub relative: f64,
    /// Least error δd of the disparity, pixels.
    pub sigma_disparity_px: f64,
    /// Its part from the texture (σ_c), pixels; for a measured image all of it.
    pub sigma_content_px: f64,
    /// Its part from diffraction (σ_d), pixels; the two add in square.
    pub sigma_diffraction_px: f64,
}

/// δd = √(1/J_left + 1/J_right), pixels (S41); √(2/J) where one view is known. Infinite where a J is 0.
///
/// # Errors
/// A J that is negative or no number.
pub fn disparity_bound_px(j_left: f64, j_right: Option<f64>) -> Result<f64> {
    let left = check::non_negative("information J of the left view", j_left, "pixel^-2")?;
    let right = check::non_negative("information J of the right view", j_right.unwrap_or(left), "pixel^-2")?;
    Ok((1.0 / left + 1.0 / right).sqrt())
}
