//! What solving for a quantity comes to: its value, or why there is none, and the limits that the value breaks.

use super::quantity::Quantity;

/// Why no value suffices where the distance is 0.
pub(super) const NEVER: &str = "nothing distinguishes the two";

crate::base::named::named! {
    /// Which limit it is; in the order of the codes' letters, in which several are listed.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum CapCode {
        /// All bands of all frames are read later than the decision must stand.
        DecisionTime = "decision-time",
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

impl CapCode {
    /// Why no value of a quantity meets the task that does not change what breaks a limit; `None` stands for a motion that is not known.
    #[must_use]
    pub const fn whatever(broken: Option<Self>) -> &'static str {
        match broken {
            Some(Self::Motion) => "the target moves by a pixel at any value",
            Some(Self::FullWell) => "the pixel saturates at any value",
            Some(Self::FrameRate) => "the exposure required is longer than a frame",
            Some(_) => "not all is read within the required time at any value",
            None => "how far the target moves is not known without target.distance",
        }
    }

    /// Whether a camera that breaks the limit does not meet the task; the others are told of and no more.
    #[must_use]
    pub const fn decides(self) -> bool {
        matches!(self, Self::DecisionTime | Self::FrameRate | Self::FullWell | Self::Motion)
    }
}

/// A limit that a value breaks.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Cap {
    /// Code of the limit that is broken.
    pub code: CapCode,
    /// The limit, in the unit of the quantity.
    pub limit: f64,
    /// Whether no value meets the task within the limit; else one on the other side of the limit meets it too.
    pub blocks: bool,
    /// Why the value breaks the limit, in words.
    pub reason: String,
}

/// The value of a quantity at which the task is just met, or why there is none.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Solution {
    /// The value (largest f-number, noise, distance or speed, least of the others) that is proved to suffice; `None` if none is.
    pub value: Option<f64>,
    /// The value without which it surely does not: what states that were found ask for. `None` if no value suffices.
    pub necessary: Option<f64>,
    /// The camera's own value; infinite or no number where it has none (`null` in JSON).
    pub camera: f64,
    /// Statistical distance at that value, or the best that the quantity alone can reach.
    pub statistical_distance: f64,
    /// Of a speed, the exposure that it holds at, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub exposure_s: Option<f64>,
    /// Why no value suffices, or what limits it apart from the statistical distance.
    pub reason: Option<String>,
    /// Limits that shot noise does not know and the value breaks.
    pub caps: Vec<Cap>,
}

impl Solution {
    /// The same where what was found suffices and nothing is proved to.
    #[must_use]
    pub fn not_proved(self) -> Self {
        Self { value: None, reason: Some("none is proved to suffice".into()), ..self }
    }

    /// The harder of this and another one of the same quantity: what suffices for both.
    #[must_use]
    pub fn or_harder(self, other: Self, quantity: Quantity) -> Self {
        let farther = |a: Option<f64>, b: Option<f64>| match (a, b) {
            (Some(a), Some(b)) => Some(if quantity.is_least() { a.max(b) } else { a.min(b) }),
            _ => None,
        };
        let necessary = farther(self.necessary, other.necessary);
        let value = farther(self.value, other.value);
        let kept = if self.value == value { self } else { other };
        Self { necessary, ..kept }
    }

    pub(super) fn new(
        value: Option<f64>,
        camera: f64,
        statistical_distance: f64,
        reason: Option<String>,
    ) -> Self {
        Self {
            value,
            necessary: value,
            camera,
            statistical_distance,
            exposure_s: None,
            reason,
            caps: Vec::new(),
        }
    }
}
