//! The most probable materials of a pixel, in their order.

use super::pixel::{NO_MATERIAL, Task};

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

impl Task {
    /// Of kinds in their order, each with the posterior of one of its materials: those that are equal share it.
    pub(super) fn ranked(&self, order: impl Iterator<Item = (usize, f64)>) -> Ranked {
        let equal = |kind: usize| {
            let all = (self.kinds[kind]..self.kind_of.len()).filter(move |m| self.kind_of[*m] == kind);
            all.take(self.alike[kind])
        };
        Ranked::of(order.flat_map(|(kind, posterior)| equal(kind).map(move |m| (m, posterior))))
    }
}
