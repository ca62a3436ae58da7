//! What may be otherwise than it is told, as one number for the whole cube, and what a unit of it changes in a pixel's counts.
//!
//! N_w = κ_w ∫ [e B(T) + (1 − e) Σₖ Vₖ Sₖ] over band w. Its slope along a cause θ, at the fit of a pixel:
//!
//! | cause | unit of θ | ∂N_w/∂θ |
//! |---|---|---|
//! | gain | | N_w, without light that was itself counted |
//! | wavelength shift | cm⁻¹ | κ_w Δ_w ∂(N_w/κ_w Δ_w)/∂ν, over the band and its two neighbours |
//! | scale of light k | | Vₖ Cₖ, Cₖ the counts that are scattered of it at V = 1 |
//! | tilt of light k | | Vₖ Cₖ x_w, x from −1 to 1 over the bands |
//! | temperature of light k | K | κ_w Vₖ (1 − e) ∂Sₖ/∂T |
//! | sum of the lighting factors | | Σ Vₖ Cₖ/ΣVₖ, where it is told |
//! | a light that is missing | | κ_w (1 − e) B(T_x), its V |
//! | air on the path | m | −α_w (N_w − κ_w B(T_air)), α the optical depth of a metre |
//! | one band | | N_w in it |
//!
//! Assumption: to first order. Source: paper S44; the score test is C. R. Rao's, Proc. Camb. Phil. Soc. 44, 50 (1948),
//! doi:10.1017/S0305004100023987.

use super::model::Setting;
use super::tangent::{Tangent, Tangents};
use hadar::planck::photon_radiance_into;

/// Something that may be otherwise than it is told.
#[derive(Debug, Clone, PartialEq)]
pub enum Cause {
    /// All counts are larger by this share.
    Gain,
    /// The bands lie so many cm⁻¹ higher than told.
    WavelengthShift,
    /// A light is stronger by this share in all bands.
    LightScale(usize),
    /// A light is stronger by this share at the upper end of the bands, and weaker as much at the lower one.
    LightTilt(usize),
    /// A light is so many kelvin warmer; with the slope of its radiance at the nodes, photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹ and K.
    LightTemperature {
        /// Which of the surroundings.
        light: usize,
        /// ∂S/∂T at the nodes.
        slope: Vec<f64>,
    },
    /// The sum of the lighting factors is larger by this.
    LightingTotal,
    /// There is a light besides, a blackbody of a temperature, with this lighting factor.
    LightMissing {
        /// Its temperature, K.
        temperature_k: f64,
    },
    /// So many metres of air are before the camera.
    Air {
        /// Optical depth of one metre at the nodes.
        depth_per_m: Vec<f64>,
        /// Temperature of the air, K.
        temperature_k: f64,
    },
    /// One band, counted from 0 in rising wavenumber, is stronger by this share.
    Band(usize),
}

/// A cause with what of it is the same for all pixels, in the bands that count.
#[derive(Debug)]
pub(super) struct Effect {
    cause: Cause,
    /// Radiance in each band: of the light that a unit of it adds, or of the air.
    radiance: Vec<f64>,
    /// x_w of a tilt, α_w of the air.
    share: Vec<f64>,
}

impl Effect {
    pub(super) fn new(cause: &Cause, setting: &Setting<'_>, tangents: &Tangents<'_>) -> Self {
        let bands = setting.bands;
        let pick = |all: Vec<f64>| -> Vec<f64> { tangents.used.iter().map(|band| all[*band]).collect() };
        let radiance = match cause {
            Cause::LightTemperature { slope, .. } => pick(bands.weigh(slope)),
            Cause::LightMissing { temperature_k } | Cause::Air { temperature_k, .. } => {
                let mut radiance = vec![0.0; bands.nodes_cm1().len()];
                photon_radiance_into(bands.nodes_cm1(), *temperature_k, &mut radiance);
                pick(bands.weigh(&radiance))
            }
            _ => Vec::new(),
        };
        let share = match cause {
            Cause::LightTilt(_) => tilt(&tangents.centres_cm1),
            Cause::Air { depth_per_m, .. } => {
                let depth = pick(bands.weigh(depth_per_m));
                depth.iter().zip(&tangents.widths_cm1).map(|(depth, width)| depth / width).collect()
            }
            _ => Vec::new(),
        };
        Self { cause: cause.clone(), radiance, share }
    }

    /// Slope of the counts of a pixel of material `m` along the cause, in deviations of each band, into `to`.
    pub(super) fn slope(
        &self,
        tangents: &Tangents<'_>,
        (m, lighting): (usize, &[f64]),
        tangent: &Tangent,
        to: &mut Vec<f64>,
    ) {
        let kappa = &tangents.counts_per_radiance;
        let mean = &tangent.mean;
        let scattered = |k: usize| tangents.scattered_of(m, k);
        let v = |k: usize| lighting.get(k).copied().unwrap_or(0.0);
        to.clear();
        match &self.cause {
            Cause::Gain => {
                to.extend(mean);
                for k in (0..lighting.len()).filter(|k| tangents.is_counted(*k)) {
                    to.iter_mut().zip(scattered(k)).for_each(|(d, c)| *d -= v(k) * c);
                }
            }
            Cause::WavelengthShift => {
                let (nu, width) = (&tangents.centres_cm1, &tangents.widths_cm1);
                let unit: Vec<f64> =
                    mean.iter().zip(kappa).zip(width).map(|((n, k), width)| n / (k * width)).collect();
                let last = unit.len().saturating_sub(1);
                to.extend((0..unit.len()).map(|w| {
                    let (low, high) = (w.saturating_sub(1), (w + 1).min(last));
                    let rise = nu[high] - nu[low];
                    if rise > 0.0 { kappa[w] * width[w] * (unit[high] - unit[low]) / rise } else { 0.0 }
                }));
            }
            Cause::LightScale(k) => to.extend(scattered(*k).iter().map(|c| v(*k) * c)),
            Cause::LightTilt(k) => {
                to.extend(scattered(*k).iter().zip(&self.share).map(|(c, x)| v(*k) * c * x));
            }
            Cause::LightTemperature { light, .. } => {
                to.extend(tangents.reflected[m].iter().zip(&self.radiance).map(|(r, s)| v(*light) * r * s));
            }
            Cause::LightingTotal => {
                let total: f64 = lighting.iter().sum();
                to.resize(mean.len(), 0.0);
                for k in 0..lighting.len() {
                    let share = if total > 0.0 { v(k) / total } else { 0.0 };
                    to.iter_mut().zip(scattered(k)).for_each(|(d, c)| *d += share * c);
                }
            }
            Cause::LightMissing { .. } => {
                to.extend(tangents.reflected[m].iter().zip(&self.radiance).map(|(r, s)| r * s));
            }
            Cause::Air { .. } => {
                let sent = mean.iter().zip(kappa).zip(&self.radiance);
                to.extend(sent.zip(&self.share).map(|(((n, k), b), depth)| -depth * (n - k * b)));
            }
            Cause::Band(band) => {
                let own = tangents.used.iter().position(|one| one == band);
                to.extend(mean.iter().enumerate().map(|(w, n)| if Some(w) == own { *n } else { 0.0 }));
            }
        }
        to.iter_mut().zip(&tangent.sigma).for_each(|(d, sigma)| *d /= sigma);
    }
}

/// From −1 at the first to 1 at the last.
fn tilt(nu: &[f64]) -> Vec<f64> {
    let (Some(low), Some(high)) = (nu.first(), nu.last()) else { return Vec::new() };
    let half = 0.5 * (high - low);
    nu.iter().map(|nu| if half > 0.0 { (nu - low) / half - 1.0 } else { 0.0 }).collect()
}
