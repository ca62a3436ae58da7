//! What a demanded depth error asks of the stereo camera: one quantity solved for, the others held.
//!
//! * **Distance**, texture follows the image (every window looks as it does, however far): δd is fixed, δz ∝ z².
//! * **Distance**, texture fixed on the object, and a window that always covers the same part of it: N ∝ 1/z², σ_c ∝ 1/z
//!   in the image, σ_d fixed, γ fixed; with u = z/z₀ the variance of disparity is A + B u² (A texture, B diffraction,
//!   m²), so δz/z ≤ ρ is a quadratic equation in z². Of a measured image B is 0 and its blur shrinks with the texture:
//!   beyond z₀ the solution is then too far, before z₀ too near. The window must still cover a few pixels.
//! * **Baseline**: δz ∝ 1/b.
//! * **Aperture** D: photons ∝ D², the electronic noise is the detector's, σ_d(D) as it is given; no lens in air is
//!   faster than f/0.5 (D = 2f). Of a measured image the blur stays as it was measured.
//! * **Exposure** t: photons ∝ t, Johnson variance ∝ t, flicker variance ∝ t².
//! * **Noise** per reading: σ² as it may be at most.
//!
//! The last three are monotone; their J is summed anew at every trial, and the crossing found to the last bits.
//!
//! Assumptions: far target (étendue independent of z), linear response, scene constant while it is exposed.

use super::{Image, StereoGeometry, WindowInformation, WindowSamples};
use crate::error::{Error, Result, check};
use crate::instrument::{FASTEST_F_NUMBER, noise};
use crate::root::{crossing, crossing_between};

/// Factors between 10⁻³⁰ and 10³⁰ of the camera's own value are searched.
const LOG_RANGE: f64 = 69.0;
/// Why no longer exposure, or wider lens, will do.
#[must_use]
pub fn well_is_full(by_exposure: bool, full_well: f64) -> String {
    let what = if by_exposure { "with so long an exposure" } else { "with so wide a lens" };
    format!("{what} the brightest pixel holds more than its well, {full_well:.3e} photons")
}

/// Why no longer exposure will do.
#[must_use]
pub fn frame_is_over(frame_s: f64) -> String {
    format!("a frame lasts {frame_s} s, and no exposure is longer")
}

const NO_TEXTURE: &str = "the window has no texture: it holds no information on its position";

/// How good depth must be.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Demand {
    /// δz at most this, m.
    Absolute(f64),
    /// δz/z at most this.
    Relative(f64),
}

impl Demand {
    fn checked(self) -> Result<Self> {
        match self {
            Self::Absolute(error_m) => check::positive("demanded depth error", error_m, "m")?,
            Self::Relative(share) => check::positive("demanded relative depth error", share, "")?,
        };
        Ok(self)
    }

    /// The largest δz it allows at a distance, m.
    #[must_use]
    pub fn at(self, distance_m: f64) -> f64 {
        match self {
            Self::Absolute(error_m) => error_m,
            Self::Relative(share) => share * distance_m,
        }
    }
}

/// How the electronic noise of the window grows with the exposure.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct ExposureNoise {
    /// Exposure that the window's counts and noise are of, s.
    pub exposure_s: f64,
    /// Exposure at which the flicker share is stated, s.
    pub noise_exposure_s: f64,
    /// Share of the noise variance at that exposure which is flicker, in [0, 1].
    pub flicker_fraction: f64,
}

/// The value of a quantity at which the demand is just met, or why there is none.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct DepthSolution {
    /// The value (largest distance or noise, least of the others), in the unit of `camera`; `None` if none suffices.
    pub value: Option<f64>,
    /// The camera's own value: m, s, or counts.
    pub camera: f64,
    /// δz at that value, or the least that the quantity alone can reach, m.
    pub sigma_z_m: f64,
    /// Why no value meets the requirement, in words.
    pub reason: Option<String>,
}

/// A window before a stereo camera, and what is demanded of its depth.
///
/// ```
/// use hadar::ranging::depth::{Demand, DepthTask, Image, StereoGeometry, WindowSamples};
/// let window = WindowSamples::new(vec![1e4, 1.2e4, 1e4], vec![1e3, 0.0, -1e3], vec![4e4; 3])?;
/// let task = DepthTask {
///     geometry: StereoGeometry::new(0.2, 0.014, 12e-6)?,
///     distance_m: 30.0,
///     views: [&window, &window],
///     image: Image::Measured,
///     demand: Demand::Absolute(0.3),
/// };
/// let baseline = task.baseline()?;
/// let met = StereoGeometry::new(baseline.value.unwrap_or(1.0), 0.014, 12e-6)?;
/// assert!((DepthTask { geometry: met, ..task }.bound()?.sigma_z_m - 0.3).abs() < 1e-13);
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct DepthTask<'a> {
    /// The cameras.
    pub geometry: StereoGeometry,
    /// Distance of the window, m.
    pub distance_m: f64,
    /// The window in the left and the right view (the same twice where only one is known).
    pub views: [&'a WindowSamples; 2],
    /// What the samples are of.
    pub image: Image,
    /// What is demanded.
    pub demand: Demand,
}

impl DepthTask<'_> {
    /// δz as things are.
    ///
    /// # Errors
    /// A distance that is not positive.
    pub fn bound(&self) -> Result<super::DepthBound> {
        self.geometry.depth_bound(self.distance_m, self.windows(1.0, 1.0)?, self.image)
    }

    /// The largest distance at which the demand is met, if every window goes on looking as it does here.
    ///
    /// # Errors
    /// A distance or a demand that is not positive; an answer that is no number.
    pub fn distance_texture_in_image(&self) -> Result<DepthSolution> {
        self.distance(|content_px, diffraction_px, scale| {
            let metres = scale / content_px.hypot(diffraction_px);
            Ok(match self.demand {
                Demand::Absolute(error_m) => (error_m * metres).sqrt(),
                Demand::Relative(share) => share * metres,
            })
        })
    }

    /// The largest distance at which the demand is met, if texture and window stay on the object.
    ///
    /// # Errors
    /// A distance or a demand that is not positive; an answer that is no number.
    pub fn distance_texture_on_object(&self) -> Result<DepthSolution> {
        self.distance(|content_px, diffraction_px, scale| {
            // δd² = A + B u², u = z/z₀, pixel².
            let (a, b) = (content_px * content_px, diffraction_px * diffraction_px);
            let target = scale / self.distance_m * self.demand.at(self.distance_m) / self.distance_m;
            let c = target * target;
            let square = match self.demand {
                // u²(A + B u²) = C, by the root that does not cancel.
                Demand::Relative(_) => 2.0 * c / (a + (a * a + 4.0 * b * c).sqrt()),
                // u⁴(A + B u²) = C, between half of what either term alone allows and all that the first does.
                Demand::Absolute(_) => {
                    let high = 0.5 * libm::log(c / a);
                    let low = (0.5 * libm::log(0.5 * c / a)).min(libm::log(0.5 * c / b) / 3.0);
                    let excess =
                        |log: f64| Ok((2.0 * log - libm::log(c)) + libm::log(a + b * libm::exp(log)));
                    libm::exp(crossing(low - 1e-9, high + 1e-9, excess)?)
                }
            };
            Ok(self.distance_m * square.sqrt())
        })
    }

    /// The least baseline, m.
    ///
    /// # Errors
    /// A distance or a demand that is not positive; an answer that is no number.
    pub fn baseline(&self) -> Result<DepthSolution> {
        let allowed = self.allowed_m()?;
        let now = self.bound()?.sigma_z_m;
        let camera = self.geometry.baseline_m;
        if now.is_infinite() {
            return Ok(without_texture(camera));
        }
        let value = check::positive("least baseline", camera * (now / allowed), "m")?;
        Ok(DepthSolution { value: Some(value), camera, sigma_z_m: allowed, reason: None })
    }

    /// The least aperture, m, of a camera that now has `aperture_m`; `var_diffraction_m2` is σ_d² (m²) at an aperture (m), not
    /// asked for of a measured image.
    ///
    /// For a circular aperture before fine pixels σ_d² is that of [`super::super::psf::PointSpread::airy_of_aperture`].
    ///
    /// # Errors
    /// An aperture, distance or demand that is not positive, an aperture wider than f/0.5; an error of
    /// `var_diffraction_m2`.
    pub fn aperture(
        &self,
        aperture_m: f64,
        mut var_diffraction_m2: impl FnMut(f64) -> Result<f64>,
    ) -> Result<DepthSolution> {
        check::positive("aperture", aperture_m, "m")?;
        let widest = self.geometry.focal_length_m / FASTEST_F_NUMBER;
        if aperture_m > widest * (1.0 + 1e-12) {
            let expected = format!("at most {widest} m: no lens in air is faster than f/{FASTEST_F_NUMBER}");
            return Err(Error::out_of_range("aperture", aperture_m, "m", expected));
        }
        let best = libm::log(widest / aperture_m);
        let reason = format!("no lens in air is faster than f/{FASTEST_F_NUMBER}");
        let at = |log: f64| {
            let factor = libm::exp(log);
            let image = match self.image {
                Image::Measured => Image::Measured,
                Image::Ideal { .. } => {
                    Image::Ideal { var_diffraction_m2: var_diffraction_m2(aperture_m * factor)? }
                }
            };
            Ok((self.windows(factor * factor, 1.0)?, image))
        };
        self.solve(aperture_m, best, 1.0, &reason, at)
    }

    /// The least exposure, s.
    ///
    /// # Errors
    /// An exposure, distance or demand that is not positive, a flicker share outside [0, 1].
    pub fn exposure(&self, noise: ExposureNoise) -> Result<DepthSolution> {
        check::positive("exposure", noise.exposure_s, "s")?;
        check::positive("noise exposure", noise.noise_exposure_s, "s")?;
        check::unit_interval("flicker_fraction", noise.flicker_fraction)?;
        let stretch = noise.exposure_s / noise.noise_exposure_s;
        let growth = |factor: f64| noise::growth(stretch * factor, noise.flicker_fraction);
        let reason = "flicker noise grows as fast as the signal: no exposure is long enough";
        let at = |log: f64| {
            let factor = libm::exp(log);
            Ok((self.windows(factor, growth(factor) / growth(1.0))?, self.image))
        };
        self.solve(noise.exposure_s, LOG_RANGE, 1.0, reason, at)
    }

    /// The largest electronic noise of a sample, counts (root mean square over the left view's window; the same factor
    /// for all samples).
    ///
    /// # Errors
    /// A distance or demand that is not positive.
    pub fn noise(&self) -> Result<DepthSolution> {
        let camera = self.views[0].noise_counts();
        let at = |log: f64| Ok((self.windows(1.0, libm::exp(-2.0 * log))?, self.image));
        if self.views.iter().all(|view| view.noise_counts() == 0.0) {
            let (sigma_z_m, met) = (self.bound()?.sigma_z_m, self.allowed_m()?);
            if sigma_z_m.is_infinite() {
                return Ok(without_texture(camera));
            }
            let reason = (sigma_z_m > met).then(|| "the detector has no electronic noise".to_owned());
            let value = reason.is_none().then_some(0.0);
            return Ok(DepthSolution { value, camera, sigma_z_m, reason });
        }
        let reason = "shot noise alone is too much: no detector is quiet enough";
        self.solve(camera, LOG_RANGE, -1.0, reason, at)
    }

    /// Solves for the logarithm of how much better a quantity must be; its value is the camera's times that to the `power`.
    fn solve(
        &self,
        camera: f64,
        best: f64,
        power: f64,
        reason: &str,
        mut at: impl FnMut(f64) -> Result<([WindowInformation; 2], Image)>,
    ) -> Result<DepthSolution> {
        let allowed = self.allowed_m()?;
        let mut error_at = |log: f64| {
            let (windows, image) = at(log)?;
            Ok(self.geometry.depth_bound(self.distance_m, windows, image)?.sigma_z_m)
        };
        let least = error_at(best)?;
        if least.is_infinite() {
            return Ok(without_texture(camera));
        }
        // At the limit itself the demand may be met but for rounding.
        if least > allowed * (1.0 + 4.0 * f64::EPSILON) {
            return Ok(DepthSolution {
                value: None,
                camera,
                sigma_z_m: least,
                reason: Some(reason.to_owned()),
            });
        }
        let log = if least >= allowed {
            best
        } else {
            let most = error_at(-LOG_RANGE)?;
            let excess = |error: f64| libm::log(allowed / error).max(-1e3);
            if most <= allowed {
                -LOG_RANGE
            } else {
                crossing_between([-LOG_RANGE, excess(most)], [best, excess(least)], |log| {
                    error_at(log).map(excess)
                })?
            }
        };
        let value = Some(camera * libm::exp(power * log));
        Ok(DepthSolution { value, camera, sigma_z_m: error_at(log)?, reason: None })
    }

    /// Solves for the distance; `largest` has the deviations of disparity from texture and diffraction, and b f/p (pixels
    /// and pixel metres).
    fn distance(&self, largest: impl Fn(f64, f64, f64) -> Result<f64>) -> Result<DepthSolution> {
        self.allowed_m()?;
        let bound = self.bound()?;
        let camera = self.distance_m;
        if bound.sigma_z_m.is_infinite() {
            return Ok(without_texture(camera));
        }
        let scale = self.geometry.baseline_m * self.geometry.focal_length_m / self.geometry.pitch_m;
        let found = largest(bound.sigma_content_px, bound.sigma_diffraction_px, scale)?;
        let value = check::positive("largest distance", found, "m")?;
        Ok(DepthSolution { value: Some(value), camera, sigma_z_m: self.demand.at(value), reason: None })
    }

    /// The largest δz that is allowed, m.
    fn allowed_m(&self) -> Result<f64> {
        check::positive("distance", self.distance_m, "m")?;
        check::positive("demanded depth error", self.demand.checked()?.at(self.distance_m), "m")
    }

    fn windows(&self, photon_factor: f64, noise_factor: f64) -> Result<[WindowInformation; 2]> {
        let [left, right] = self.views;
        Ok([left.window_at(photon_factor, noise_factor)?, right.window_at(photon_factor, noise_factor)?])
    }
}

fn without_texture(camera: f64) -> DepthSolution {
    DepthSolution { value: None, camera, sigma_z_m: f64::INFINITY, reason: Some(NO_TEXTURE.to_owned()) }
}
