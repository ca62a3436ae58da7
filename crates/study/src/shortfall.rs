//! What a camera falls short of.

/// What a camera does not meet, or what a value of a quantity that would do spoils instead.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Shortfall {
    /// The statistical distance is below that demanded.
    Distance,
    /// Too few pixels lie across the target.
    Pixels,
    /// The temperature cannot be known as well as demanded.
    TemperatureError,
    /// The distance cannot be known as well as demanded.
    DepthError,
    /// Its frames are read later than the decision must stand.
    DecisionTime,
    /// Something moves by a pixel or more while all bands are exposed.
    MotionBlur,
    /// A speed is demanded, and without a distance nothing can be said of the blur: what cannot be said is not met.
    MotionUnknown,
    /// A reading of the brightest scene does not fit into the full well.
    FullWell,
    /// The exposure is longer than a frame.
    FrameRate,
    /// The lens blurs a point over more than the pixel.
    Diffraction,
    /// No camera is built or used like that.
    Impractical,
    /// Read noise and steps of the converter leave more noise than that, whatever the detector.
    LowestNoise,
}

impl Shortfall {
    /// Stable code, e.g. `motion-blur`.
    #[must_use]
    pub const fn code(self) -> &'static str {
        match self {
            Self::Distance => "distance",
            Self::Pixels => "pixels",
            Self::TemperatureError => "temperature-error",
            Self::DepthError => "depth-error",
            Self::DecisionTime => "decision-time",
            Self::MotionBlur => "motion-blur",
            Self::MotionUnknown => "motion-unknown",
            Self::FullWell => "full-well",
            Self::FrameRate => "frame-rate",
            Self::Diffraction => "diffraction",
            Self::Impractical => "impractical",
            Self::LowestNoise => "lowest-noise",
        }
    }
}
