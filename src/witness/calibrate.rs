//! Calibration out of the cube itself: the noise of its samples, stripes of its lines.
//!
//! * [`photon_transfer`]: variance against mean, of repeated frames or of neighbours in one frame;
//! * [`find_stripes`]: lines whose gain and offset are off, which [`Destriped::corrected`] takes out.

mod noise;
mod stripes;

pub use noise::{Asked, Line, OfBand, Transfer, photon_transfer};
pub use stripes::{Axis, Destriped, Kept, Sought, Stripe, Why, find_stripes};
