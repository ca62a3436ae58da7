//! How well a figure of a camera is known.

/// How well a figure is known.
#[derive(Debug, Clone, PartialEq)]
pub enum Known {
    /// It has an error.
    Within(Uncertainty),
    /// It is no larger than is stated.
    AtMost,
}

/// The error of a figure.
#[derive(Debug, Clone, PartialEq)]
pub struct Uncertainty {
    /// Its standard uncertainty, in the unit used inside; not negative.
    pub sigma: f64,
    /// Whether it is anything within √3 of that, and no more; else Gaussian.
    pub rectangular: bool,
    /// What has the same error, so many deviations of its own.
    pub same: Option<String>,
}
