//! What stands for figures of a camera that nobody stated.

/// The range in which the paper counts photons, cm⁻¹.
pub const PAPER_RANGE_CM1: [f64; 2] = [715.0, 1250.0];

/// A figure of a camera that nobody stated, and the value taken for it.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct Assumed {
    /// Key of the figure that nobody stated.
    pub figure: &'static str,
    /// The value that was taken for it, with its unit.
    pub taken: String,
    /// Whether the camera may be worse than with that.
    pub favourable: bool,
}

impl Assumed {
    /// Keys of all figures that something may stand for, those first that a 'yes' hangs on most.
    pub const FIGURES: &'static [&'static str] = &[
        "flicker_fraction",
        "fixed_pattern",
        "spectral_range",
        "netd_f_number",
        "exposure",
        "optics_efficiency",
        "netd_temperature",
        "readout",
        "frame_rate",
        "quantum_efficiency",
        "full_well",
        "noise_exposure",
        "netd_pixel",
        "netd_optics_efficiency",
        "spectral_bands",
        "dark_rate",
        "read_noise",
        "quantisation_bits",
        "pixels",
    ];

    /// A camera that nobody stated to be like that may be worse.
    #[must_use]
    pub fn favourable(figure: &'static str, taken: impl Into<String>) -> Self {
        Self { figure, taken: taken.into(), favourable: true }
    }

    /// No camera is worse than with that.
    pub(super) fn worst(figure: &'static str, taken: impl Into<String>) -> Self {
        Self { figure, taken: taken.into(), favourable: false }
    }
}
