//! A camera in front of a task, and the same with one quantity changed.

use super::quantity::{Quantity, Trial};
use crate::instrument::Camera;
use crate::policy::motion::Motion;
use crate::spectrum::Bands;

/// Where the frames alone take longer than a speed allows, an exposure of no time, s.
const SHORTEST_S: f64 = 1e-30;

/// A camera in front of a task.
#[derive(Debug, Clone)]
pub struct CameraTask<'a> {
    /// The camera.
    pub camera: &'a Camera,
    /// Bands, as the camera receives them.
    pub bands: &'a Bands,
    /// Statistical distance d_req that the task demands.
    pub required: f64,
    /// Distance of the target, m; infinitely far where `None`.
    pub distance_m: Option<f64>,
    /// The farthest distance of which anything is known, m: the longest path in a table of the air.
    pub farthest_m: Option<f64>,
    /// Side of the target, m; it fills the pixel, however large, where `None`.
    pub size_m: Option<f64>,
    /// Whether all pixels that it fills count together.
    pub of_object: bool,
}

impl CameraTask<'_> {
    /// Side of the largest pixel that the target fills, m.
    pub(super) fn filled_pixel_m(&self) -> Option<f64> {
        Some(self.size_m? * self.camera.focal_length_m / self.distance_m?)
    }

    /// Time until all bands are exposed once, s.
    pub(super) fn time_s(&self, exposure_s: f64) -> f64 {
        Camera { exposure_s, ..self.camera.clone() }.sweep_s(self.bands.len())
    }

    /// The camera as it is, where it is.
    #[must_use]
    pub fn own(&self) -> Trial {
        Trial { camera: self.camera.clone(), distance_m: self.distance_m }
    }

    /// The same with one quantity set to a value; a speed sets the exposure in which it moves the target by one pixel.
    #[must_use]
    pub fn forward(&self, quantity: Quantity, value: f64) -> Trial {
        let mut trial = self.own();
        let camera = &mut trial.camera;
        match quantity {
            Quantity::Exposure => camera.exposure_s = value,
            Quantity::Pixel => camera.pixel_m = value,
            Quantity::FNumber => camera.f_number = value,
            Quantity::Noise => {
                let now = self.value(Quantity::Noise);
                camera.noise = camera.noise_scaled(if now > 0.0 { value / now } else { 0.0 });
            }
            // A cast saturates: more frames than fit are as good as endless.
            Quantity::Frames => camera.frames = (value as u32).max(1),
            Quantity::Distance => trial.distance_m = value.is_finite().then_some(value),
            Quantity::Speed => {
                if let Some(motion) = Motion::of(self.camera, self.distance_m) {
                    let time_s = motion.longest_s(value);
                    camera.exposure_s =
                        self.camera.exposure_of_sweep_s(self.bands.len(), time_s).max(SHORTEST_S);
                }
            }
        }
        trial
    }

    /// The value that is `factor` times better than the camera's.
    pub(super) fn scaled(&self, quantity: Quantity, factor: f64) -> f64 {
        let now = self.value(quantity);
        if quantity.is_least() { now * factor } else { now / factor }
    }

    /// The camera's own value of a quantity: infinite for a distance that is not stated, no number for a speed that
    /// the scenario does not tell enough for.
    #[must_use]
    pub fn value(&self, quantity: Quantity) -> f64 {
        match quantity {
            Quantity::Exposure => self.camera.exposure_s,
            Quantity::Pixel => self.camera.pixel_m,
            Quantity::FNumber => self.camera.f_number,
            Quantity::Frames => f64::from(self.camera.frames),
            // Of one reading, as it is stated and as a detector is bought, however many frames there are.
            Quantity::Noise => self.camera.electronic_noise_counts(self.bands),
            Quantity::Distance => self.distance_m.unwrap_or(f64::INFINITY),
            Quantity::Speed => Motion::of(self.camera, self.distance_m)
                .map_or(f64::NAN, |motion| motion.fastest_m_s(self.time_s(self.camera.exposure_s))),
        }
    }
}
