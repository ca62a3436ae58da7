//! What clauses of a rule have in common: one that differs from an earlier one by speeds alone asks for the same worst scenes, and for the same
//! scenes of the ideal camera.
//!
//! The same is what is bit by bit the same: bands, surroundings, spectra, what is unknown, ranges, counts and noise. Distances of the ideal
//! camera, which has no noise but that of its photons, grow as √κ: those of one exposure are those of every other.

use super::apart::{Candidate, TellApart};
use super::envelope::{Estimate, Sighted};
use super::ideal::Scenes;
use super::pairs::Searched;
use crate::Study;

/// The worst of all pairs, and what each has come to.
pub(super) type Worst = (Searched, Vec<Estimate>);

/// What one clause asked and found.
pub(super) struct Earlier<'a> {
    pub(super) apart: &'a TellApart,
    /// Of every camera, and whether no more than a verdict was asked for.
    pub(super) worst: Vec<(bool, Worst)>,
    pub(super) ideal: Option<Scenes<'a>>,
}

impl Earlier<'_> {
    /// The worst of a camera, if it was asked for in the same words.
    pub(super) fn worst(&self, of: &TellApart, index: usize, alone: bool) -> Option<&Worst> {
        let (candidate, known) = (of.candidates.get(index)?, self.apart.candidates.get(index)?);
        let (was_alone, worst) = self.worst.get(index)?;
        let asked = |of: &TellApart, candidate: &Candidate| (of.required, of.decisive(candidate));
        let same = alone == *was_alone
            && asked(of, candidate) == asked(self.apart, known)
            && candidate.share == known.share
            && candidate.between.is_empty()
            && known.between.is_empty()
            && candidate.sighted.len() == known.sighted.len()
            && candidate.sighted.iter().zip(&known.sighted).all(|(one, other)| one.sees_as(other));
        same.then_some(worst)
    }
}

impl Sighted {
    /// Whether all that is searched here is what is searched there.
    fn sees_as(&self, other: &Self) -> bool {
        self.counting == other.counting && self.ranges == other.ranges && self.study.asks_as(&other.study)
    }
}

impl Study {
    /// Whether the same states of the same materials are compared in the same bands.
    pub(super) fn asks_as(&self, other: &Self) -> bool {
        self.bands == other.bands
            && self.surroundings == other.surroundings
            && self.target == other.target
            && self.alternatives == other.alternatives
            && self.unknowns == other.unknowns
            && self.range == other.range
            && self.air == other.air
    }
}
