//! What solving for a quantity comes to: its value, or why there is none, and the limits that the value breaks.

/// Why no value suffices where the distance is 0.
pub(super) const NEVER: &str = "nothing tells the two apart";

crate::base::named::named! {
    /// Which limit it is; in the order of the codes' letters, in which several are listed.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum CapCode {
        /// The lens blurs a point over more than the pixel.
        Diffraction = "diffraction",
        /// An exposure is longer than a frame.
        FrameRate = "frame-rate",
        /// The fullest reading does not fit into the well.
        FullWell = "full-well",
        /// No camera is built or used like that.
        Impractical = "impractical",
        /// Read noise and steps of the converter stay.
        LowestNoise = "lowest-noise",
        /// The target moves by a pixel until all bands are exposed.
        Motion = "motion",
    }
    /// The code, e.g. `full-well`.
    name
}

/// A limit that a value breaks.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Cap {
    /// Which.
    pub code: CapCode,
    /// The limit, in the unit of the quantity.
    pub limit: f64,
    /// Whether no value meets the task within the limit; else one on the other side of the limit meets it too.
    pub blocks: bool,
    /// The reason in words.
    pub reason: String,
}

/// The value of a quantity at which the task is just met, or why there is none.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Solution {
    /// The value (largest f-number, noise, distance or speed, least of the others); `None` if no value suffices.
    pub value: Option<f64>,
    /// The camera's own value; infinite or no number where it has none (`null` in JSON).
    pub camera: f64,
    /// Statistical distance at that value, or the best that the quantity alone can reach.
    pub statistical_distance: f64,
    /// Why no value suffices.
    pub reason: Option<String>,
    /// Limits that shot noise does not know and the value breaks.
    pub caps: Vec<Cap>,
}

impl Solution {
    pub(super) fn new(
        value: Option<f64>,
        camera: f64,
        statistical_distance: f64,
        reason: Option<String>,
    ) -> Self {
        Self { value, camera, statistical_distance, reason, caps: Vec::new() }
    }
}
