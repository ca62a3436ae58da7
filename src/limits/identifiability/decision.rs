//! TEMPORARY.
use crate::error::Result;
/// By what.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum DecisionLaw {
    /// Φ(d).
    Gaussian,
    /// Exact.
    Exact,
    /// Bracket.
    Bracket,
}
/// Bounds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DecisionBounds {
    /// At least.
    pub lower: f64,
    /// At most.
    pub upper: f64,
    /// By what.
    pub law: DecisionLaw,
}
/// Bounds.
/// # Errors
/// None.
pub fn decision_bounds(
    _counts: &[f64],
    _alternative: &[f64],
    _added: &[f64],
    _modes: Option<&[f64]>,
) -> Result<DecisionBounds> {
    Ok(DecisionBounds { lower: 0.5, upper: 1.0, law: DecisionLaw::Gaussian })
}
