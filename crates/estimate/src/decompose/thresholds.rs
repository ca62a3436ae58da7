//! From when on a material counts, fits, or is none.

use super::possible::Members;

/// Deviance beyond the best one at which a material no longer counts: its posterior is e⁻¹² of the best one's.
pub(super) const CUT: f64 = 24.0;
/// Deviance of a kind without the handicap of its prior, beyond the best one with it, from which on it no longer counts: neither in the
/// posterior nor, where there are categories, for what the counts leave.
pub(super) fn beyond(handicap: f64, members: Option<&Members>) -> f64 {
    (CUT - handicap).max(members.map_or(f64::NEG_INFINITY, |members| members.cut))
}
/// Below this p-value no material of the library fits.
pub const NO_FIT: f64 = 1e-4;
/// The material of a pixel that has none.
pub const NO_MATERIAL: u16 = u16::MAX;
