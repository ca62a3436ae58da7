//! What errors of the calibration leave of the information of a cube.

pub mod stripes;
