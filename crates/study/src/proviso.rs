//! What a 'yes' hangs on where a camera adds up frames while something moves.
//!
//! Motion blur counts the frames one by one ([`hadar::policy::Motion`]): it takes them to be laid over each other before they are added.

use hadar::instrument::Camera;

/// Frames that must be registered. In JSON it completes 'yes, if '.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Proviso {
    /// Frames that must be laid over each other.
    pub frames: u32,
    /// Time until all are read, s.
    pub time_s: f64,
    /// Way at the demanded speed meanwhile, m.
    pub way_m: f64,
}

impl Proviso {
    /// Stable code of what must hold.
    pub const CODE: &'static str = "registered-frames";

    /// Of a camera that reads so many bands at a speed; `None` where one frame is all it takes.
    pub(crate) fn of(camera: &Camera, bands: usize, speed_m_s: f64) -> Option<Self> {
        let time_s = camera.acquisition_s(bands);
        let proviso = Self { frames: camera.frames, time_s, way_m: time_s * speed_m_s };
        (camera.frames > 1 && speed_m_s > 0.0).then_some(proviso)
    }
}
