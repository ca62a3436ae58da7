//! Counts of the members of two classes in one scene, and their nearest mixtures at one temperature of the alternative.

use super::super::multi::LibraryScene;
use super::hull::{Hulls, Mixed, Plane};
use crate::scene::State;

/// Counts of members.
#[derive(Clone)]
pub(super) struct Side {
    pub(super) counts: Vec<Vec<f64>>,
    /// What a distance is divided by: 1, or their photons.
    pub(super) photons: Vec<f64>,
}

/// All that a search needs.
#[derive(Clone)]
pub(super) struct Scene<'s> {
    pub(super) library: &'s LibraryScene<'s>,
    pub(super) own: Side,
    pub(super) alternatives: &'s [&'s [f64]],
    /// Lightings that are the corners of all possible ones.
    pub(super) lightings: Vec<Vec<f64>>,
    /// εB(T) of the surroundings at the nodes.
    pub(super) light: Vec<Vec<f64>>,
    pub(super) kappa: f64,
    pub(super) var_added: Vec<f64>,
}

impl Scene<'_> {
    /// Counts of the alternative's members in a lighting.
    pub(super) fn counts(&self, lighting: &[f64], temperature_k: f64) -> Vec<Vec<f64>> {
        let LibraryScene { bands, surroundings, state, .. } = self.library;
        let state = State { temperature_k, lighting: lighting.to_vec(), gain: 1.0, ..(*state).clone() };
        let of = |emissivity: &&[f64]| {
            let counts = bands.weigh(&surroundings.signal(emissivity, &state));
            counts.iter().map(|m| self.kappa * m).collect()
        };
        self.alternatives.iter().map(of).collect()
    }

    /// The nearest mixtures with the alternative at a temperature, and the plane that touches there.
    pub(super) fn at(&self, temperature_k: f64, start: Mixed) -> (Mixed, Plane) {
        let per_lighting: Vec<Vec<Vec<f64>>> =
            self.lightings.iter().map(|lighting| self.counts(lighting, temperature_k)).collect();
        let alternatives: Vec<Vec<f64>> = (0..self.alternatives.len())
            .flat_map(|j| per_lighting.iter().map(move |members| members[j].clone()))
            .collect();
        let hulls = Hulls {
            targets: &self.own.counts,
            photons: &self.own.photons,
            alternatives: &alternatives,
            var_added: &self.var_added,
        };
        // The nearest of a start that is given, and of the pure members.
        let pure = (0..self.own.counts.len())
            .flat_map(|i| (0..alternatives.len()).map(move |j| (i, j)))
            .map(|(i, j)| hulls.pure(i, j));
        let pure = pure.min_by(|a, b| a.cost.total_cmp(&b.cost));
        let start = match pure {
            Some(pure) if !start.cost.is_finite() || pure.cost < start.cost => pure,
            _ => start,
        };
        hulls.nearest(start)
    }
}
