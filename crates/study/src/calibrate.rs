//! Calibrations answered: cubes opened, and what they tell of the camera. A kind a file.

mod blackbody;
mod left_out;
mod noise;
mod opened;
mod response;
mod scene_radiance;
mod stated;
mod stripes;
mod whole;

pub use blackbody::{BlackbodyFound, BlackbodyStudy, ChannelRow, Worst};
pub use noise::{NoiseFound, NoiseStudy, PhotonNoise};
pub use response::{FilterRadiances, LeftOutFilter, ResponseFound, ResponseRow, ResponseStudy};
pub use scene_radiance::SceneFound;
pub use stripes::{Samples, StripesFound, StripesStudy};
