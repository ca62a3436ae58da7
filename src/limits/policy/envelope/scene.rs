//! What an envelope is laid around: a pair of materials, the objects about them, and a camera at a distance or along a stretch of
//! distances.

use crate::error::{Error, Result, check};
use crate::fisher::{Counting, Unknowns};
use crate::identifiability::nearest::{NearestSolver, StateRange};
use crate::scene::{Surroundings, check_emissivity};
use crate::spectrum::Bands;

/// By how much of itself a weight may rise for rounding, where transmittances stay what they are: a part of what bounds allow for it.
const ROUNDING: f64 = 1e-13;

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

    pub(crate) fn solver(&self) -> NearestSolver<'a> {
        NearestSolver::new(self.bands, self.surroundings, self.unknowns.clone(), self.range)
    }
}

/// What the bands let through along a stretch of distances.
#[derive(Debug, Clone, Copy)]
pub struct Stretch<'a> {
    /// The bands as they are at the far end, nowhere more than those of the scene.
    pub far: &'a Bands,
    /// The same at the geometric mean of the two distances.
    pub middle: &'a Bands,
    /// The same bands with the share that transmittances may be off a parabola of ln z at each node.
    pub sag: &'a Bands,
}

impl Stretch<'_> {
    pub(super) fn check(&self, near: &Bands) -> Result<()> {
        for bands in [self.far, self.middle, self.sag] {
            if bands.nodes_cm1() != near.nodes_cm1() {
                let what = "nodes of the bands at the far end".into();
                let (found, expected) = (bands.nodes_cm1().len(), near.nodes_cm1().len());
                return Err(Error::Length { what, found, expected });
            }
            bands.weights_cm1().iter().try_for_each(|&weight| {
                check::non_negative("weight of a band along a stretch of distances", weight, "cm^-1")
                    .map(drop)
            })?;
        }
        for (near, far) in [(near, self.middle), (self.middle, self.far)] {
            let rises = |(near, far): &(&f64, &f64)| **far > **near * (1.0 + ROUNDING);
            let rises = near.weights_cm1().iter().zip(far.weights_cm1()).find(rises);
            if let Some((_, &far)) = rises {
                let expected = "at most its weight from nearer";
                return Err(Error::out_of_range("weight of a band from afar", far, "cm^-1", expected));
            }
        }
        Ok(())
    }
}
