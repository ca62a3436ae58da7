//! What a camera falls short of.

hadar::named! {
    /// What a camera does not meet, or what a value of a quantity that would do spoils instead.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Shortfall {
        /// The statistical distance is below that demanded.
        Distance = "distance",
        /// Too few pixels lie across the target.
        Pixels = "pixels",
        /// The temperature cannot be known as well as demanded.
        TemperatureError = "temperature-error",
        /// The distance cannot be known as well as demanded.
        DepthError = "depth-error",
        /// Its frames are read later than the decision must stand.
        DecisionTime = "decision-time",
        /// Something moves by a pixel or more while all bands are exposed.
        MotionBlur = "motion-blur",
        /// A speed is demanded, and without a distance nothing can be said of the blur: what cannot be said is not met.
        MotionUnknown = "motion-unknown",
        /// The target, on its way across, is not in the view in time for the decision.
        OutOfView = "out-of-view",
        /// A reading of the brightest scene does not fit into the full well.
        FullWell = "full-well",
        /// The exposure is longer than a frame.
        FrameRate = "frame-rate",
        /// The lens blurs a point over more than the pixel.
        Diffraction = "diffraction",
        /// No camera is built or used like that.
        Impractical = "impractical",
        /// Read noise and steps of the converter leave more noise than that, whatever the detector.
        LowestNoise = "lowest-noise",
    }
    /// Stable code, e.g. `motion-blur`.
    code
}
