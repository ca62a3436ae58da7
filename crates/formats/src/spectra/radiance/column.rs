//! A column of a table of radiances.

use crate::cube::TemperatureUnit;
use hadar::radiance_unit::RadianceUnit;

/// What the numbers of a column are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Unit {
    /// Photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹, as nothing says another.
    Silent,
    /// A unit that is stated.
    Stated(RadianceUnit),
    /// Temperatures of a blackbody that sends as much.
    Brightness(TemperatureUnit),
}

/// A column of wavenumbers, cm⁻¹, and values.
pub(super) struct Column {
    pub(super) name: String,
    pub(super) unit: Unit,
    /// The line each stands on.
    pub(super) lines: Vec<usize>,
    pub(super) rows: Vec<(f64, f64)>,
}
