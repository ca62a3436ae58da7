//! One hardware quantity solved for, the others held: the value at which the task is just met.
//!
//! The statistical distance d is a monotone function of each quantity; it is evaluated exactly, with the
//! camera's noise at every trial value, and its crossing with d_req is found in the logarithm of the
//! quantity to the last bits. What limits a quantity is told as a reason: the flicker floor
//! (d → d_∞ as t → ∞), shot noise (d at zero electronic noise), or the fastest lens in air. What the statistical
//! distance does not know of (diffraction, full well, motion, frames) is told beside the value as [`super::caps`].

mod distance;
mod quantity;
mod solution;
mod task;

pub use quantity::{Quantity, Trial};
pub use solution::{Cap, CapCode, Solution};
pub use task::CameraTask;

use self::solution::NEVER;
use super::motion::Motion;
use crate::error::Result;
use crate::instrument::FASTEST_F_NUMBER;
use crate::root::crossing_between;

/// Factors between 10⁻³⁰ and 10³⁰ of the camera's own value are searched.
const LOG_RANGE: f64 = 69.0;
/// What of an array stays.
const LASTING: &str = "fixed patterns, row and column noise";
/// Relative step by which a solution may be moved so that it meets the demand in spite of rounding.
const SAFE_SIDE: f64 = 1e-11;
/// Share by which a speed stays below that of a whole pixel.
const SHORT: f64 = 1e-9;

impl CameraTask<'_> {
    /// Solves for `quantity`; `distance` evaluates the statistical distance of a trial.
    ///
    /// # Errors
    /// An error of `distance`.
    pub fn solve(
        &self,
        quantity: Quantity,
        mut distance: impl FnMut(&Trial) -> Result<f64>,
    ) -> Result<Solution> {
        match quantity {
            Quantity::Frames => return self.solve_frames(distance),
            Quantity::Distance => return distance::solve(self, distance),
            Quantity::Speed => return self.solve_speed(distance),
            // A larger pixel sees more photons, and fewer pixels see the object.
            Quantity::Pixel if self.of_object && self.size_m.is_some() => {
                let reason =
                    "the number of pixels on the object depends on their size: try other sizes".to_owned();
                return Ok(Solution::new(None, self.camera.pixel_m, f64::NAN, Some(reason)));
            }
            Quantity::Exposure | Quantity::Pixel | Quantity::FNumber | Quantity::Noise => {}
        }
        let camera = self.value(quantity);
        if quantity == Quantity::Noise && camera == 0.0 {
            let reached = distance(&self.own())?;
            let reason = (reached < self.required).then(|| "the detector has no electronic noise".to_owned());
            let value = reason.is_none().then_some(0.0);
            return Ok(Solution::new(value, camera, reached, reason));
        }
        // d as a function of how much better the quantity is than the camera's, as a logarithm.
        let mut at = |log: f64| distance(&self.forward(quantity, self.scaled(quantity, log.exp())));
        let best = match quantity {
            Quantity::FNumber => (self.camera.f_number / FASTEST_F_NUMBER).ln(),
            // A larger pixel sees more of what is behind the target, not more of the target.
            Quantity::Pixel => self.filled_pixel_m().map_or(LOG_RANGE, |pixel| (pixel / camera).ln()),
            _ => LOG_RANGE,
        };
        let ceiling = at(best)?;
        if ceiling < self.required {
            let reason = match quantity {
                _ if ceiling == 0.0 => NEVER.into(),
                Quantity::FNumber => format!("no lens in air is faster than f/{FASTEST_F_NUMBER}"),
                Quantity::Exposure if self.camera.pattern.has_fixed() => {
                    format!("{LASTING} grow as fast as the signal: no exposure is long enough")
                }
                Quantity::Exposure if self.camera.flicker_fraction > 0.0 => {
                    "flicker noise grows as fast as the signal: no exposure is long enough".into()
                }
                Quantity::Noise if !self.camera.pattern.is_none() => {
                    "shot noise, patterns of the array and other noise are too large: no detector is quiet enough"
                        .into()
                }
                Quantity::Exposure => "no exposure that was tried is long enough".into(),
                Quantity::Noise => "shot noise alone is too much: no detector is quiet enough".into(),
                _ if self.size_m.is_some() => "the largest pixel that the target fills is too small".into(),
                _ => "no pixel is large enough".into(),
            };
            return Ok(Solution::new(None, camera, ceiling, Some(reason)));
        }
        let floor = at(-LOG_RANGE)?;
        if floor >= self.required {
            // Any value does: the pair differs without limit.
            let value = self.scaled(quantity, (-LOG_RANGE).exp());
            return Ok(Solution::new(Some(value), camera, self.required, None));
        }
        let excess = |d: f64| (d / self.required).ln().max(-1e3);
        let log = crossing_between([-LOG_RANGE, excess(floor)], [best, excess(ceiling)], |log| {
            at(log).map(excess)
        })?;
        // On the side that meets the demand, by a few units in the last place if need be.
        let (mut value, mut more) = (self.scaled(quantity, log.exp()), f64::EPSILON);
        let mut reached = distance(&self.forward(quantity, value))?;
        while reached < self.required && more < SAFE_SIDE {
            value = self.scaled(quantity, (log + more).min(best).exp());
            reached = distance(&self.forward(quantity, value))?;
            more *= 2.0;
        }
        Ok(Solution::new(Some(value), camera, reached, None))
    }

    /// The least whole number of frames that will do, since more of them are never worse: d grows as the root of the frames where nothing
    /// lasts from one to the next, and every third step is by halves.
    fn solve_frames(&self, mut distance: impl FnMut(&Trial) -> Result<f64>) -> Result<Solution> {
        let camera = f64::from(self.camera.frames);
        let mut at = |frames: u32| distance(&self.forward(Quantity::Frames, f64::from(frames)));
        // Rounding alone does not make one more of them.
        let enough = |d: f64| d >= self.required * (1.0 - 1e-9);
        let ceiling = at(u32::MAX)?;
        if !enough(ceiling) {
            let why = match ceiling {
                0.0 => NEVER,
                _ if self.camera.pattern.has_fixed() => {
                    "fixed patterns, row and column noise do not average out: no number of frames is enough"
                }
                _ if self.camera.flicker_fraction > 0.0 => {
                    "flicker noise does not average out: no number of frames is enough"
                }
                _ => "not even four thousand million frames are enough",
            };
            return Ok(Solution::new(None, camera, ceiling, Some(why.to_owned())));
        }
        let (mut few, mut many, mut reached) = (0, u32::MAX, ceiling);
        let (mut frames, mut d) = (self.camera.frames, at(self.camera.frames)?);
        for step in 0.. {
            if enough(d) && frames <= many {
                (many, reached) = (frames, d);
            } else {
                few = few.max(frames);
            }
            if many - few <= 1 {
                break;
            }
            let guess = f64::from(frames) * (self.required * (1.0 - 1e-9) / d).powi(2);
            let next = if step % 3 == 2 { few.midpoint(many) } else { guess.ceil() as u32 };
            frames = next.clamp(few + 1, many - 1);
            d = at(frames)?;
        }
        Ok(Solution::new(Some(f64::from(many)), camera, reached, None))
    }

    /// The speed at which the least exposure that will do moves the target by one pixel.
    fn solve_speed(&self, distance: impl FnMut(&Trial) -> Result<f64>) -> Result<Solution> {
        let camera = self.value(Quantity::Speed);
        let Some(motion) = Motion::of(self.camera, self.distance_m) else {
            let reason = "target.distance is not stated".to_owned();
            return Ok(Solution::new(None, camera, f64::NAN, Some(reason)));
        };
        let exposure = self.solve(Quantity::Exposure, distance)?;
        // A whole pixel is too much.
        let value =
            exposure.value.map(|exposure_s| (1.0 - SHORT) * motion.fastest_m_s(self.time_s(exposure_s)));
        let reason = exposure.reason.map(|reason| format!("not even at rest: {reason}"));
        let exposure_s = exposure.value;
        Ok(Solution { exposure_s, ..Solution::new(value, camera, exposure.statistical_distance, reason) })
    }
}

#[cfg(test)]
mod tests;
