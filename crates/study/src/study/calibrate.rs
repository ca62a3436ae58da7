//! Calibrations answered: cubes opened, and what they tell of the camera. A kind a file.

mod noise;
mod opened;
mod stripes;

pub use noise::{NoiseFound, NoiseStudy};
pub use stripes::{Samples, StripesFound, StripesStudy};
