//! Calibrations as text and files. A kind a file.

pub mod noise;
pub mod stripes;
