//! A material where the bands look at it.

/// A material on the nodes of the bands.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    /// Name.
    pub name: String,
    /// Emissivity at the nodes.
    pub emissivity: Vec<f64>,
}
