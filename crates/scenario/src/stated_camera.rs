//! A camera of one's own, as a file states it.

use hadar::instrument::CameraSpec;

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
    /// Its figures.
    pub spec: CameraSpec,
}
