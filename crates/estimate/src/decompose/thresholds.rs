//! From when on a material counts, fits, or is none.

/// Deviance beyond the best one at which a material no longer counts: its posterior is e⁻¹² of the best one's.
pub(super) const CUT: f64 = 24.0;
/// Below this p-value no material of the library fits.
pub const NO_FIT: f64 = 1e-4;
/// The material of a pixel that has none.
pub const NO_MATERIAL: u16 = u16::MAX;
