//! Calibration as it is done: estimates from readings of blackbodies and out of the cube itself, and instruments of known truth.
//!
//! * [`response`]: a camera's response from blackbodies behind filters, smooth (paper S51, SIV C);
//! * [`vignette`]: the relative transmittance of a filter wheel over the image (SIV B), and the reference taken off;
//! * [`spectrometer`]: response and offset of a spectrometer, radiance, emissivity and surroundings (S52–S58);
//! * [`photon_transfer`]: variance against mean, of repeated frames or of neighbours in one frame;
//! * [`noise_correlations`]: whether that noise is independent from frame to frame and pixel to pixel;
//! * [`three_dimensional`]: what pixels, rows, columns and frames have in common;
//! * [`find_stripes`]: lines whose gain and offset are off, which [`Destriped::corrected`] takes out;
//! * [`twin`]: a filter-wheel camera and a spectrometer whose truth is known.
//!
//! Bounds are in [`hadar::calibration`], which uses none of this.

mod noise;
pub mod response;
pub mod spectrometer;
mod spread;
mod stripes;
mod three_dimensional;
pub mod twin;
pub mod vignette;

pub use noise::{Asked, Correlation, Line, OfBand, Transfer, noise_correlations, photon_transfer};
pub use stripes::{Apart, Axis, Destriped, Kept, Sought, Stripe, Why, find_stripes};
pub use three_dimensional::{Component, three_dimensional};
