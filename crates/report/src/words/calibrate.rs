//! Calibrations in words, a kind a file.

pub(crate) mod blackbody;
pub(crate) mod noise;
pub(crate) mod response;
pub(crate) mod stripes;
