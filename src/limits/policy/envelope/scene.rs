//! What an envelope is laid around: a pair of materials, the objects about them, and a camera.

use crate::error::Result;
use crate::fisher::{Counting, Unknowns};
use crate::identifiability::nearest::{NearestSolver, StateRange};
use crate::scene::{Surroundings, check_emissivity};
use crate::spectrum::Bands;

/// One pair of materials and one camera, whose worst scene is looked for.
#[derive(Debug, Clone, Copy)]
pub struct EnvelopeScene<'a> {
    /// The bands of the camera.
    pub bands: &'a Bands,
    /// The objects around the target with their emissivities; their temperatures are those of the envelope.
    pub surroundings: &'a Surroundings,
    /// Emissivity of the target at the nodes of the bands.
    pub emissivity: &'a [f64],
    /// Emissivity of the alternative at the nodes of the bands.
    pub alternative: &'a [f64],
    /// Counts per radiance and added noise.
    pub counting: &'a Counting,
    /// What is not known of the alternative's state.
    pub unknowns: &'a Unknowns,
    /// Within what limits the alternative's state may be.
    pub range: StateRange,
}

impl<'a> EnvelopeScene<'a> {
    pub(super) fn check(&self) -> Result<()> {
        self.range.check()?;
        self.counting.check(self.bands.len())?;
        check_emissivity(self.emissivity, self.bands.nodes_cm1().len())?;
        check_emissivity(self.alternative, self.bands.nodes_cm1().len())
    }

    pub(super) fn solver(&self) -> NearestSolver<'a> {
        NearestSolver::new(self.bands, self.surroundings, self.unknowns.clone(), self.range)
    }
}
