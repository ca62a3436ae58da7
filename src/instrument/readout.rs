//! When the bands of a camera are exposed.

/// When the bands are exposed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Readout {
    /// All in the same exposure.
    #[default]
    Simultaneous,
    /// One after the other, an exposure each: a wheel of filters, a scanned monochromator.
    Sequential,
    /// All at once through an interferometer, as many mirror positions as bands, an exposure each.
    FourierTransform,
    /// All in the same exposure, side by side behind a slit: an image is made line by line.
    Dispersive,
}

impl Readout {
    /// All of them.
    pub const ALL: [Self; 4] =
        [Self::Simultaneous, Self::Sequential, Self::FourierTransform, Self::Dispersive];

    /// The name in a scenario.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Simultaneous => "simultaneous",
            Self::Sequential => "sequential",
            Self::FourierTransform => "fourier-transform",
            Self::Dispersive => "dispersive",
        }
    }

    /// Exposures until all of so many bands are known.
    #[must_use]
    pub const fn exposures(self, bands: usize) -> usize {
        match self {
            Self::Simultaneous | Self::Dispersive => 1,
            Self::Sequential | Self::FourierTransform => bands,
        }
    }
}
