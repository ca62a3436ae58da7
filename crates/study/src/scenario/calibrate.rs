//! Calibration scenarios: one kind a file, told by the table that it has beside `[cube]`.

pub mod frames;
pub mod noise;
pub mod stripes;

pub use frames::Frames;
pub use noise::NoiseScenario;
pub use stripes::StripesScenario;
