//! Calibrations answered: cubes opened, and what they tell of the camera. A kind a file.

mod noise;
mod opened;

pub use noise::{NoiseFound, NoiseStudy};
