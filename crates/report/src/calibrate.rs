//! Calibrations as text and files. A kind a file.

pub mod blackbody;
pub mod noise;
pub mod response;
pub mod stripes;
