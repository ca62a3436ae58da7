//! A ranging scenario with everything it names looked up: what its answers start from.

use super::subject::Resolved;
use hadar::demand::Work;
use hadar::instrument::Camera;
use hadar::ranging::depth::StereoGeometry;
use hadar::spectrum::Bands;
use hadar_scenario::RangeScenario;

/// Sections of an answer: verdict, objects, cells, what would have to change, lines, and views matched.
pub(super) const SECTIONS: u64 = 6;

/// A ranging scenario with everything it names looked up and checked.
#[derive(Debug)]
pub struct RangeStudy {
    pub(super) scenario: RangeScenario,
    pub(super) camera: Option<Camera>,
    pub(super) bands: Option<Bands>,
    pub(super) geometry: StereoGeometry,
    pub(super) subject: Resolved,
    /// What it took to look everything up.
    pub(super) looked_up: Work,
}
