//! The most probable materials of a pixel, in their order.

use super::thresholds::NO_MATERIAL;

/// Materials of a pixel that are ranked at most.
pub const MOST_RANKED: usize = 16;

/// The most probable materials of a pixel with their posteriors, the best first; [`NO_MATERIAL`] of 0 after the last that counts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ranked {
    /// Places in the library.
    pub materials: [u16; MOST_RANKED],
    /// The posterior of each.
    pub posteriors: [f32; MOST_RANKED],
}

impl Ranked {
    /// Without a material.
    pub(super) const NOTHING: Self =
        Self { materials: [NO_MATERIAL; MOST_RANKED], posteriors: [0.0; MOST_RANKED] };

    /// Of materials in their order.
    pub(super) fn of(order: impl Iterator<Item = (usize, f64)>) -> Self {
        let mut ranked = Self::NOTHING;
        let to = ranked.materials.iter_mut().zip(&mut ranked.posteriors);
        to.zip(order)
            .for_each(|((m, p), (material, posterior))| (*m, *p) = (material as u16, posterior as f32));
        ranked
    }
}
