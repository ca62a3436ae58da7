//! Calibration out of the cube itself: the noise of its samples, stripes of its lines.
//!
//! * [`photon_transfer`]: variance against mean, of repeated frames or of neighbours in one frame.

mod noise;

pub use noise::{Asked, Line, OfBand, Transfer, photon_transfer};
