//! Calibration as it is done: estimates of response and offset from readings, and instruments of known truth that draw them.
//!
//! * [`response`]: a camera's response from blackbodies behind filters, smooth (paper S51, SIV C);
//! * [`vignette`]: the relative transmittance of a filter wheel over the image (SIV B), and the reference taken off;
//! * [`spectrometer`]: response and offset of a spectrometer, radiance, emissivity and surroundings (S52–S58);
//! * [`twin`]: a filter-wheel camera and a spectrometer whose truth is known;
//! * [`coverage`]: how often intervals of these estimates hold it.
//!
//! Bounds are in [`crate::calibration`], which uses none of this.

pub mod coverage;
pub mod response;
pub mod spectrometer;
pub mod twin;
pub mod vignette;
