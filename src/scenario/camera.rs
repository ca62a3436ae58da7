//! The `[camera]` of a scenario: a preset, and the fields that override it.

/// The camera as written (`[camera]`). A field that is `None` is the preset's.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CameraSpec {
    /// Name of a known camera, e.g. `flir-a325sc`.
    pub preset: Option<String>,
    /// Exposure time of a frame, s; above 0.
    pub exposure_s: Option<f64>,
    /// Side of a square pixel, m; above 0.
    pub pixel_m: Option<f64>,
    /// f-number F; at least 0.5.
    pub f_number: Option<f64>,
    /// Focal length, m; above 0.
    pub focal_length_m: Option<f64>,
    /// Share of the photons that the optics let through, in (0, 1].
    pub optics_efficiency: Option<f64>,
    /// Noise-equivalent temperature difference of one frame, K; above 0. At most one of the three noises.
    pub netd_k: Option<f64>,
    /// Temperature of the blackbody at which the NETD is stated, K; above 0.
    pub netd_temperature_k: Option<f64>,
    /// f-number at which the NETD is stated; at least 0.5.
    pub netd_f_number: Option<f64>,
    /// Specific detectivity D*, cm √Hz W⁻¹; above 0. At most one of the three noises.
    pub detectivity_cm_hz05_w: Option<f64>,
    /// Standard deviation of a band reading's electronic noise, in counts; 0 or above. At most one of the three.
    pub noise_electrons: Option<f64>,
    /// Share of the electronic noise variance that is flicker, in [0, 1].
    pub flicker_fraction: Option<f64>,
    /// Counts at which a pixel is full; above 0.
    pub full_well: Option<f64>,
    /// Whether all bands are read in one exposure or one after the other.
    pub readout: Option<Readout>,
    /// Number of frames that are averaged; at least 1.
    pub frames: Option<u32>,
    /// Full field of view across, rad; between 0 and π, both excluded.
    pub field_of_view_rad: Option<f64>,
    /// Pixels across the field of view; at least 1.
    pub pixels: Option<u32>,
}

/// When the bands are exposed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Readout {
    /// All in the same exposure.
    Simultaneous,
    /// One after the other, an exposure each.
    Sequential,
}

impl Readout {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Simultaneous, Self::Sequential];

    /// The name in a scenario.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Simultaneous => "simultaneous",
            Self::Sequential => "sequential",
        }
    }
}
