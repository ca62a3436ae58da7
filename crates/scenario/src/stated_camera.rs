//! A camera of one's own, as a file states it.

use hadar::instrument::presets::Cooling;
use hadar::instrument::{CameraSpec, Price};

/// A camera as a file states it.
#[derive(Debug, Clone, PartialEq)]
pub struct StatedCamera {
    /// Its name.
    pub name: String,
    /// What it is.
    pub description: String,
    /// The document that was read.
    pub document: Option<String>,
    /// Where its figures are from.
    pub provenance: Vec<String>,
    /// Whether its array is cooled.
    pub kind: Option<Cooling>,
    /// What one piece costs.
    pub price: Option<Price>,
    /// Its figures.
    pub spec: CameraSpec,
}
