//! One hardware quantity solved for, the others held: the value at which the task is just met.
//!
//! The statistical distance d is a monotone function of each quantity; it is evaluated exactly, with the
//! camera's noise at every trial value, and its crossing with d_req is found in the logarithm of the
//! quantity to the last bits. What limits a quantity is told as a reason: the flicker floor
//! (d → d_∞ as t → ∞), shot noise (d at zero electronic noise), or the fastest lens in air.

use crate::error::Result;
use crate::instrument::{Camera, FASTEST_F_NUMBER};
use crate::root::crossing;
use crate::spectrum::Bands;

/// Factors between 10⁻³⁰ and 10³⁰ of the camera's own value are searched.
const LOG_RANGE: f64 = 69.0;
/// Why no value suffices where the distance is 0.
const NEVER: &str = "the two cannot be told apart";

/// A quantity that can be solved for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Exposure of a frame, s.
    Exposure,
    /// Side of the pixel, m.
    Pixel,
    /// f-number.
    FNumber,
    /// Electronic noise of a band reading in one frame, counts at the camera's exposure.
    Noise,
    /// Number of averaged frames.
    Frames,
}

impl Quantity {
    /// All of them, in the order of reports.
    pub const ALL: [Self; 5] = [Self::Exposure, Self::Pixel, Self::FNumber, Self::Noise, Self::Frames];

    /// Key in the JSON, with its unit.
    #[must_use]
    pub const fn key(self) -> &'static str {
        match self {
            Self::Exposure => "exposure_s",
            Self::Pixel => "pixel_m",
            Self::FNumber => "f_number",
            Self::Noise => "noise_counts",
            Self::Frames => "frames",
        }
    }

    /// Name in a sentence.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Exposure => "exposure",
            Self::Pixel => "pixel",
            Self::FNumber => "f-number",
            Self::Noise => "noise per reading",
            Self::Frames => "frames",
        }
    }
}

/// The value of a quantity at which the task is just met, or why there is none.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Solution {
    /// The value (largest f-number or noise, least of the others); `None` if no value suffices.
    pub value: Option<f64>,
    /// The camera's own value.
    pub camera: f64,
    /// Statistical distance at that value, or the best that the quantity alone can reach.
    pub statistical_distance: f64,
    /// Why no value suffices.
    pub reason: Option<String>,
}

/// A camera in front of a task.
#[derive(Debug, Clone)]
pub struct CameraTask<'a> {
    /// The camera.
    pub camera: &'a Camera,
    /// Bands, as the camera receives them.
    pub bands: &'a Bands,
    /// Statistical distance d_req that the task demands.
    pub required: f64,
}

impl CameraTask<'_> {
    /// Solves for `quantity`; `distance` evaluates the statistical distance of a camera.
    ///
    /// # Errors
    /// An error of `distance`.
    pub fn solve(
        &self,
        quantity: Quantity,
        mut distance: impl FnMut(&Camera) -> Result<f64>,
    ) -> Result<Solution> {
        let camera = self.value(quantity);
        if quantity == Quantity::Noise && camera == 0.0 {
            let reached = distance(self.camera)?;
            let reason = (reached < self.required).then(|| "the detector has no electronic noise".to_owned());
            let value = reason.is_none().then_some(0.0);
            return Ok(Solution { value, camera, statistical_distance: reached, reason });
        }
        if quantity == Quantity::Frames {
            return self.solve_frames(distance);
        }
        // d as a function of how much better the quantity is than the camera's, as a logarithm.
        let mut at = |log: f64| distance(&self.forward(quantity, self.scaled(quantity, log.exp())));
        let fastest = quantity == Quantity::FNumber;
        let best = if fastest { (self.camera.f_number / FASTEST_F_NUMBER).ln() } else { LOG_RANGE };
        let ceiling = at(best)?;
        if ceiling < self.required {
            let reason = match quantity {
                _ if ceiling == 0.0 => NEVER.into(),
                Quantity::FNumber => format!("no lens in air is faster than f/{FASTEST_F_NUMBER}"),
                Quantity::Exposure => {
                    "flicker noise grows as fast as the signal: no exposure is long enough".into()
                }
                Quantity::Noise => "shot noise alone is too much: no detector is quiet enough".into(),
                Quantity::Frames | Quantity::Pixel => NEVER.into(),
            };
            return Ok(Solution { value: None, camera, statistical_distance: ceiling, reason: Some(reason) });
        }
        if at(-LOG_RANGE)? >= self.required {
            // Any value does: the pair differs without limit.
            let value = self.scaled(quantity, (-LOG_RANGE).exp());
            return Ok(Solution {
                value: Some(value),
                camera,
                statistical_distance: self.required,
                reason: None,
            });
        }
        let log = crossing(-LOG_RANGE, best, |log| Ok((at(log)? / self.required).ln().max(-1e3)))?;
        let value = self.scaled(quantity, log.exp());
        let reached = distance(&self.forward(quantity, value))?;
        Ok(Solution { value: Some(value), camera, statistical_distance: reached, reason: None })
    }

    /// The least whole number of frames that will do: by halving, since more of them are never worse.
    fn solve_frames(&self, mut distance: impl FnMut(&Camera) -> Result<f64>) -> Result<Solution> {
        let camera = f64::from(self.camera.frames);
        let mut at = |frames: u32| distance(&self.forward(Quantity::Frames, f64::from(frames)));
        // Rounding alone does not make one more of them.
        let enough = |d: f64| d >= self.required * (1.0 - 1e-9);
        let ceiling = at(u32::MAX)?;
        if !enough(ceiling) {
            let why = if ceiling == 0.0 {
                NEVER
            } else {
                "flicker noise does not average out: no number of frames is enough"
            };
            let reason = Some(why.to_owned());
            return Ok(Solution { value: None, camera, statistical_distance: ceiling, reason });
        }
        let (mut few, mut many, mut reached) = (0, u32::MAX, ceiling);
        while many - few > 1 {
            let middle = few + (many - few) / 2;
            let d = at(middle)?;
            if enough(d) {
                (many, reached) = (middle, d);
            } else {
                few = middle;
            }
        }
        let value = Some(f64::from(many));
        Ok(Solution { value, camera, statistical_distance: reached, reason: None })
    }

    /// The camera with one quantity set to a value.
    #[must_use]
    pub fn forward(&self, quantity: Quantity, value: f64) -> Camera {
        let mut camera = self.camera.clone();
        match quantity {
            Quantity::Exposure => camera.exposure_s = value,
            Quantity::Pixel => camera.pixel_m = value,
            Quantity::FNumber => camera.f_number = value,
            Quantity::Noise => {
                let now = self.value(Quantity::Noise);
                camera.noise = camera.noise.scaled(if now > 0.0 { value / now } else { 0.0 });
            }
            // A cast saturates: more frames than fit are as good as endless.
            Quantity::Frames => camera.frames = (value as u32).max(1),
        }
        camera
    }

    /// The value that is `factor` times better than the camera's.
    fn scaled(&self, quantity: Quantity, factor: f64) -> f64 {
        let now = self.value(quantity);
        match quantity {
            Quantity::Exposure | Quantity::Pixel | Quantity::Frames => now * factor,
            Quantity::FNumber | Quantity::Noise => now / factor,
        }
    }

    /// The camera's own value of a quantity.
    #[must_use]
    pub fn value(&self, quantity: Quantity) -> f64 {
        match quantity {
            Quantity::Exposure => self.camera.exposure_s,
            Quantity::Pixel => self.camera.pixel_m,
            Quantity::FNumber => self.camera.f_number,
            Quantity::Frames => f64::from(self.camera.frames),
            // Of one reading, as it is stated and as a detector is bought, however many frames there are.
            Quantity::Noise => self.camera.electronic_noise_counts(self.bands),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fisher::Counting;
    use crate::instrument::{View, presets};

    /// d² = N²/(N + σ²)·10⁻⁶ for one band: closed form of every solution.
    fn one_band(camera: &Camera) -> Result<f64> {
        let counting = seen(camera);
        let photons = counting.counts_per_radiance * 1e21;
        Ok(1e-3 * photons / (photons + counting.var_added(0)).sqrt())
    }

    fn seen(camera: &Camera) -> Counting {
        let bands = Bands::from_rows([(900.0, 1.0)]).unwrap();
        camera.counting(&bands, &View::at(Some(30.0)))
    }

    fn task<'a>(camera: &'a Camera, bands: &'a Bands, required: f64) -> CameraTask<'a> {
        CameraTask { camera, bands, required }
    }

    #[test]
    fn every_solution_fed_forward_gives_the_demanded_distance() {
        let mut camera = presets::get("flir-a325sc").unwrap();
        camera.flicker_fraction = 0.01;
        let bands = Bands::from_rows([(900.0, 1.0)]).unwrap();
        let now = one_band(&camera).unwrap();
        for required in [0.2 * now, now, 1.3 * now] {
            let task = task(&camera, &bands, required);
            for quantity in Quantity::ALL {
                let solution = task.solve(quantity, one_band).unwrap();
                let value = solution.value.unwrap_or_else(|| panic!("{quantity:?}: {solution:?}"));
                let camera = task.forward(quantity, value);
                let reached = one_band(&camera).unwrap();
                if quantity == Quantity::Frames {
                    assert!(reached >= required * (1.0 - 1e-9));
                } else {
                    assert!((reached / required - 1.0).abs() < 1e-9, "{quantity:?} {reached} {required}");
                }
            }
        }
    }

    #[test]
    fn the_flicker_floor_is_found_exactly() {
        let camera = presets::get("flir-a325sc").unwrap();
        let bands = Bands::from_rows([(900.0, 1.0)]).unwrap();
        // t → ∞: d → 10⁻³ N/σ_F, σ_F² = φσ² at the stated exposure.
        let counting = camera.counting(&bands, &View::at(Some(30.0)));
        let floor = 1e-3 * counting.counts_per_radiance * 1e21 / (0.5 * counting.var_added(0)).sqrt();
        let below = task(&camera, &bands, 0.999_999 * floor).solve(Quantity::Exposure, one_band).unwrap();
        assert!(below.value.is_some());
        let above = task(&camera, &bands, 1.000_001 * floor).solve(Quantity::Exposure, one_band).unwrap();
        assert!(above.value.is_none() && above.reason.unwrap().contains("flicker"));
        assert!((above.statistical_distance / floor - 1.0).abs() < 1e-9);
    }

    #[test]
    fn what_cannot_be_told_apart_is_said_to_be_so() {
        let camera = presets::get("flir-a325sc").unwrap();
        let bands = Bands::from_rows([(900.0, 1.0)]).unwrap();
        for quantity in Quantity::ALL {
            let solution = task(&camera, &bands, 1.0).solve(quantity, |_| Ok(0.0)).unwrap();
            assert_eq!((solution.value, solution.reason.as_deref()), (None, Some(NEVER)), "{quantity:?}");
        }
    }

    /// d² = N²/(N + σ²)·10⁻⁶ of n frames: N = nN₁ and, without flicker, σ² = nσ₁².
    #[test]
    fn noise_is_that_of_one_reading() {
        let mut camera = presets::get("flir-a325sc").unwrap();
        (camera.flicker_fraction, camera.frames) = (0.0, 100);
        let bands = Bands::from_rows([(900.0, 1.0)]).unwrap();
        let photons = camera.counting(&bands, &View::at(Some(30.0))).counts_per_radiance * 1e21;
        let required = 1e-3 * (photons / 5.0).sqrt();
        let solution = task(&camera, &bands, required).solve(Quantity::Noise, one_band).unwrap();
        // N²/(N + nσ₁²) = N/5, so σ₁² = 4N/n.
        let exact = (4.0 * photons / 100.0).sqrt();
        assert!((solution.value.unwrap() / exact - 1.0).abs() < 1e-9, "{solution:?} {exact}");
        assert!((solution.camera / 1.769e6 - 1.0).abs() < 1e-3);
    }

    #[test]
    fn no_lens_is_faster_than_half() {
        let camera = presets::get("ideal-pnrd").unwrap();
        let bands = Bands::from_rows([(900.0, 1.0)]).unwrap();
        let now = one_band(&camera).unwrap();
        // d ∝ 1/F for shot noise: f/1.3 → f/0.5 gains 2.6.
        let solution = task(&camera, &bands, 2.7 * now).solve(Quantity::FNumber, one_band).unwrap();
        assert!(solution.value.is_none() && solution.reason.unwrap().contains("f/0.5"));
        let solution = task(&camera, &bands, 2.0 * now).solve(Quantity::FNumber, one_band).unwrap();
        assert!((solution.value.unwrap() / 0.65 - 1.0).abs() < 1e-6);
    }
}
