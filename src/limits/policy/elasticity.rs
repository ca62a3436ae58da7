//! Elasticities: by how many percent the statistical distance changes with one percent more of a quantity.
//!
//! ε_q = ∂ln d/∂ln q, by central differences in ln q extrapolated to a vanishing step (Ridders), whose last change is the
//! error estimate. d is smooth in ln q where the nearest state is followed; at a kink (a target that just fills the
//! pixel) the estimate says so. In closed form: shot noise alone d ∝ √(t n η) a/F; noise alone d ∝ t n a²/(F² σ), with
//! flicker alone independent of t and n.
//!
//! Frames are a whole number: n averaged frames of exposure t are one of n t, whose read noise and quantisation come n
//! times; in that form n is varied.
//!
//! Source: C. J. F. Ridders, Adv. Eng. Softw. 4, 75 (1982), doi:10.1016/S0141-1195(82)80057-0.

use super::solve::Trial;
use crate::error::Result;

/// First step in ln q, and the factor from one to the next.
const STEP: f64 = 0.2;
const SHRINK: f64 = 1.6;
/// Steps at most.
const STEPS: usize = 9;

crate::base::named::named! {
    /// A quantity whose part in a verdict is asked for.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum Lever {
        /// Exposure of a frame.
        Exposure = "exposure",
        /// Side of the pixel.
        Pixel = "pixel",
        /// f-number.
        FNumber = "f_number",
        /// Electronic noise of a reading.
        Noise = "noise",
        /// Number of averaged frames.
        Frames = "frames",
        /// Share of the photons that the optics pass.
        OpticsEfficiency = "optics_efficiency",
        /// Distance of the target.
        Distance = "distance",
    }
    /// Key in the JSON.
    key
}

impl Lever {
    /// Name in a sentence.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::FNumber => "f-number",
            Self::OpticsEfficiency => "optics",
            _ => self.key(),
        }
    }

    /// The trial with `factor` times as much of it.
    fn pulled(self, trial: &Trial, factor: f64) -> Trial {
        let mut trial = trial.clone();
        let camera = &mut trial.camera;
        match self {
            Self::Exposure => camera.exposure_s *= factor,
            Self::Pixel => camera.pixel_m *= factor,
            Self::FNumber => camera.f_number *= factor,
            Self::Noise => camera.noise = camera.noise_scaled(factor),
            Self::Frames => {
                let step = camera.quantisation_step_counts().unwrap_or(0.0);
                let var = camera.read_noise_counts.powi(2) + step * step / 12.0;
                camera.read_noise_counts = (var * factor).sqrt();
                camera.quantisation_bits = None;
                camera.exposure_s *= factor;
            }
            Self::OpticsEfficiency => camera.optics_efficiency *= factor,
            Self::Distance => trial.distance_m = trial.distance_m.map(|distance| distance * factor),
        }
        trial
    }
}

/// ∂ln d/∂ln q with an estimate of its error.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Elasticity {
    /// Relative change of d over the relative change of the quantity.
    pub value: f64,
    /// Estimate of its numerical error.
    pub error: f64,
}

/// The elasticity of the statistical distance that `distance` evaluates; `None` where the two cannot be told apart.
///
/// # Errors
/// An error of `distance`.
///
/// ```
/// use hadar::policy::elasticity::{Lever, elasticity};
/// use hadar::policy::Trial;
/// let trial = Trial { camera: hadar::instrument::presets::get("ideal-pnrd")?, distance_m: None };
/// // Shot noise: d grows as the root of the exposure.
/// let found = elasticity(Lever::Exposure, &trial, |trial| Ok(trial.camera.exposure_s.sqrt()))?;
/// assert!(found.is_some_and(|found| (found.value - 0.5).abs() < 1e-10));
/// # Ok::<(), hadar::Error>(())
/// ```
pub fn elasticity(
    lever: Lever,
    trial: &Trial,
    mut distance: impl FnMut(&Trial) -> Result<f64>,
) -> Result<Option<Elasticity>> {
    let mut slope = |step: f64| -> Result<f64> {
        let more = distance(&lever.pulled(trial, step.exp()))?;
        let less = distance(&lever.pulled(trial, (-step).exp()))?;
        Ok((more / less).ln() / (2.0 * step))
    };
    let mut step = STEP;
    let mut row = vec![slope(step)?];
    if !row[0].is_finite() {
        return Ok(None);
    }
    let mut best = Elasticity { value: row[0], error: f64::INFINITY };
    for _ in 1..STEPS {
        step /= SHRINK;
        let mut next = vec![slope(step)?];
        let mut power = 1.0;
        for (i, coarse) in row.iter().enumerate() {
            // Each column takes out one more power of the squared step.
            power *= SHRINK * SHRINK;
            let value = (power * next[i] - coarse) / (power - 1.0);
            let error = (value - next[i]).abs().max((value - coarse).abs());
            if error < best.error {
                best = Elasticity { value, error };
            }
            next.push(value);
        }
        let grown = match (next.last(), row.last()) {
            (Some(a), Some(b)) => (a - b).abs() > 2.0 * best.error,
            _ => false,
        };
        row = next;
        if grown || best.error == 0.0 {
            break;
        }
    }
    Ok(best.value.is_finite().then_some(best))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::instrument::{Camera, NoiseSpec, View, presets};
    use crate::spectrum::Bands;

    /// d = 10⁻³ N/√(N + σ²) of one band, whose elasticities are known.
    fn one_band(trial: &Trial) -> Result<f64> {
        let bands = Bands::from_rows([(900.0, 1.0)]).unwrap();
        let counting = trial.camera.counting(&bands, &View::at(trial.distance_m));
        let photons = counting.counts_per_radiance * 1e21;
        Ok(1e-3 * photons / (photons + counting.var_added(0)).sqrt())
    }

    fn of(lever: Lever, camera: Camera, distance_m: Option<f64>) -> f64 {
        let found = elasticity(lever, &Trial { camera, distance_m }, one_band).unwrap().unwrap();
        assert!(found.error < 1e-9, "{lever:?}: {found:?}");
        found.value
    }

    /// 1e-9: a difference quotient of a function that is good to 1e-16.
    #[track_caller]
    fn close(found: f64, exact: f64) {
        assert!((found - exact).abs() < 1e-9, "{found} {exact}");
    }

    #[test]
    fn shot_noise_alone() {
        let camera = presets::get("ideal-pnrd").unwrap();
        let levers =
            [(Lever::Exposure, 0.5), (Lever::Pixel, 1.0), (Lever::FNumber, -1.0), (Lever::Noise, 0.0)];
        for (lever, exact) in levers {
            close(of(lever, camera.clone(), None), exact);
        }
        for lever in [Lever::Frames, Lever::OpticsEfficiency] {
            close(of(lever, camera.clone(), None), 0.5);
        }
        // Étendue π a²/(4F² + (f/z)²): d ∝ its root.
        let near = (camera.focal_length_m / 0.05).powi(2);
        let exact = near / (4.0 * camera.f_number.powi(2) + near);
        close(of(Lever::Distance, camera, Some(0.05)), exact);
    }

    #[test]
    fn flicker_alone_and_a_mixture() {
        let mut camera = presets::get("flir-a325sc").unwrap();
        camera.noise = NoiseSpec::Counts { sigma_counts: 1e12 };
        camera.flicker_fraction = 1.0;
        for (lever, exact) in
            [(Lever::Exposure, 0.0), (Lever::Frames, 0.0), (Lever::Pixel, 2.0), (Lever::Noise, -1.0)]
        {
            // What is left of shot noise: N/σ² = 1e-17.
            close(of(lever, camera.clone(), None), exact);
        }
        // d = N/√(N + σ²), N ∝ t, σ² ∝ (1−φ)t + φt²: ε_t = 1 − (N + (1−φ)σ² + 2φσ²)/(2(N + σ²)) at t = t₀.
        camera.flicker_fraction = 0.3;
        camera.noise = NoiseSpec::Counts { sigma_counts: 3e3 };
        (camera.frames, camera.read_noise_counts) = (1, 2e3);
        let bands = Bands::from_rows([(900.0, 1.0)]).unwrap();
        let photons = camera.counting(&bands, &View::at(None)).counts_per_radiance * 1e21;
        let (var, read) = (9e6, 4e6);
        let total = photons + var + read;
        close(of(Lever::Exposure, camera.clone(), None), 1.0 - (photons + 1.3 * var) / (2.0 * total));
        // Read noise comes with every frame.
        close(of(Lever::Frames, camera.clone(), None), 1.0 - (photons + 1.3 * var + read) / (2.0 * total));
        close(of(Lever::Noise, camera, None), -var / total);
    }

    #[test]
    fn nothing_is_said_of_what_cannot_be_told_apart() {
        let trial = Trial { camera: presets::get("ideal-pnrd").unwrap(), distance_m: None };
        assert_eq!(elasticity(Lever::Pixel, &trial, |_| Ok(0.0)).unwrap(), None);
    }
}
