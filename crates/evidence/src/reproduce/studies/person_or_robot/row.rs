//! What came of one question of the study.

use hadar_study::ClassAnswer;

/// A camera whose figures are the paper's, and one that counts every photon.
pub(super) const CAMERAS: [&str; 2] = ["flir-a325sc", "ideal-pnrd"];

/// What came of one question.
pub(super) struct Row {
    pub(super) what: String,
    /// Per √photon; nothing is nearer than the second.
    pub(super) distance: f64,
    pub(super) lower: f64,
    pub(super) photons: Option<f64>,
    /// Statistical distance that each camera surely reaches.
    pub(super) reached: Vec<f64>,
    /// Where there are classes, by photons and before each camera.
    pub(super) classes: Vec<ClassAnswer>,
}
