//! How a material of several categories is given to one.

use serde::Serialize;

/// How the pixels of a material that is in several categories get one of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Rule {
    /// Algorithm 4 of the paper, pixel by pixel: the category of the neighbour to the left or above where the material can be in it,
    /// else the category where the material is not enclosed.
    ///
    /// What the paper leaves open: where both neighbours can be meant and differ, the one of the same material counts, or the left one;
    /// of several categories where the material is not enclosed, the one listed first; where there is none, the neighbours to the right
    /// and below are asked in a pass from the end; what then has no category, and what has no material, is [`NO_CATEGORY`](super::categories::NO_CATEGORY).
    Raster,
    /// Connected pixels of one material as one region: it belongs to the category that encloses it (three quarters of its border or more)
    /// if the material is enclosed there, else to one where it is not, of several to that along which it has the longest border.
    #[default]
    Regions,
}
