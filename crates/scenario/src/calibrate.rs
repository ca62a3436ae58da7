//! Calibration scenarios: one kind a file, told by the table that it has of its own.

pub mod blackbodies;
pub mod blackbody;
pub mod frames;
pub mod noise;
pub mod response;
pub mod stripes;

pub use blackbody::BlackbodyScenario;
pub use frames::Frames;
pub use noise::{NoiseScenario, NoiseSpec};
pub use response::ResponseScenario;
pub use stripes::StripesScenario;
