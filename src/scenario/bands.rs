//! The `[bands]` of a scenario: an even grid, ranges, or a file of rows or filters.

use std::path::PathBuf;

use crate::units::Spectral;

/// The most bands a grid may have.
pub const MOST_BANDS: f64 = 1e6;

/// The spectral bands and how a band is evaluated (`[bands]`).
#[derive(Debug, Clone, PartialEq)]
pub struct BandsSpec {
    /// Where the bands come from.
    pub source: BandSource,
    /// Whether the spectrum is integrated over each band; else its value at the centre counts.
    pub integrate: bool,
    /// Relative tolerance of that integral.
    pub tolerance: f64,
}

/// Where the bands come from. File paths are absolute.
#[derive(Debug, Clone, PartialEq)]
pub enum BandSource {
    /// Band centres `start`, `start + step`, … up to and including `stop`; a band is one `step` wide.
    /// All three in wavenumber or all three in wavelength; `0 < start < stop`, `0 < step ≤ stop − start`.
    Grid {
        /// First band centre.
        start: Spectral,
        /// End of the grid, itself a centre if a whole number of steps away.
        stop: Spectral,
        /// Distance of the centres.
        step: Spectral,
    },
    /// CSV with one column of transmission per filter.
    Filters(PathBuf),
    /// CSV with a row per band: its centre and optionally its width.
    Rows(PathBuf),
    /// Bands from edge to edge, both of one kind, lower first.
    Ranges(Vec<[Spectral; 2]>),
}

impl Default for BandsSpec {
    fn default() -> Self {
        Self {
            source: BandSource::Grid {
                start: Spectral::Wavenumber(715.0),
                stop: Spectral::Wavenumber(1250.0),
                step: Spectral::Wavenumber(1.0),
            },
            integrate: false,
            tolerance: 1e-9,
        }
    }
}
