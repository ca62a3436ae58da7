//! Two classes of materials: the distance from any member of the one to any member of the other.
//!
//! With d_ab the nearest distance from member a of the target's class to member b of the alternative's, what is asked of the
//! classes is: the worst pair min d_ab; the same without any one member; which pairs reach a distance R that is required; the
//! average of Φ(d_ab). Most pairs decide none of it, and are left at a proof that they are beyond
//!
//! t = max(d_1, d_2, d_3, R, 4),
//!
//! d_1 the distance of the pair that looks nearest in the target's own state, d_2 and d_3 those of the nearest-looking ones without
//! the first's target and without its alternative. Without member m there is always one of the three left, so that no least
//! distance, of all or without any one member, is above t; whoever is beyond it is none of them. Φ(4) misses 1 by 3·10⁻⁵.
//!
//! The proofs are those of [`super::decide`]: bounds in every n-th band, then in all of them. A pair that is not proved beyond t
//! is searched in full and proved.
//!
//! Without a camera distances are per √photon of the target: those of a camera that counts one photon in all, by shot noise.

use super::decide::{Few, Question};
use super::{LibraryScene, Progress};
use crate::demand::{self, Skipping, Thing};
use crate::error::{Error, Result, check};
use crate::fisher::Counting;
use crate::identifiability::nearest::NearestSolver;
use crate::parallel;
use crate::sum;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Statistical distance beyond which an error is nothing to an average.
const BEYOND: f64 = 4.0;
/// Pairs after which it is told how many are done.
const OFTEN: usize = 20;

/// The members of two classes in one scene.
#[derive(Debug, Clone, Copy)]
pub struct Classes<'c> {
    /// What they share.
    pub scene: &'c LibraryScene<'c>,
    /// Emissivities of the members that may be there.
    pub targets: &'c [&'c [f64]],
    /// Emissivities of the members that they must be told from.
    pub alternatives: &'c [&'c [f64]],
}

/// What is known of the distance of a pair of members.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MemberPair {
    /// The distance, where it was asked for.
    pub distance: Option<f64>,
    /// What is proved of it.
    pub lower: f64,
    /// Relative rounding error of the distance.
    pub relative_error: f64,
}

/// Distances between the members of two classes, target by target.
#[derive(Debug, Clone, PartialEq)]
pub struct ClassDistances {
    /// Members of the alternative's class.
    pub alternatives: usize,
    /// Pair (a, b) at a · alternatives + b.
    pub pairs: Vec<MemberPair>,
}

impl Classes<'_> {
    /// Distances of all pairs of members, as far as anything depends on them: statistical ones with a camera's `counting` of every
    /// target, else per √photon. `required` is what pairs must be known to reach or not; `progress` is told the pairs done.
    ///
    /// # Errors
    /// As [`LibraryScene::told_apart`].
    pub fn distances(
        &self,
        counting: Option<&[Counting]>,
        required: Option<f64>,
        skipping: Skipping,
        progress: Progress<'_>,
    ) -> Result<ClassDistances> {
        let width = self.alternatives.len();
        if let Some(each) = counting.filter(|each| each.len() != self.targets.len()) {
            let (found, expected) = (each.len(), self.targets.len());
            return Err(Error::Length { what: "countings of the targets".into(), found, expected });
        }
        let rows = (0..self.targets.len())
            .map(|a| self.row(a, counting.map(|each| &each[a]), skipping))
            .collect::<Result<Vec<Row<'_>>>>()?;
        let all: Vec<(usize, usize)> =
            (0..rows.len()).flat_map(|a| (0..width).map(move |b| (a, b))).collect();
        let own_state = |solver: &mut NearestSolver<'_>, i: usize| {
            let (a, b) = all[i];
            let (own, other) = (self.targets[a], self.alternatives[b]);
            solver.own_state_distance(own, other, self.scene.state, &rows[a].counting)
        };
        let own_states = parallel::try_map_with(all.len(), || self.scene.solver(), own_state)?;
        demand::computed(Thing::OwnStateDistances, all.len() as u64);
        let in_full = |a: usize, b: usize| -> Result<MemberPair> {
            let (own, other) = (self.targets[a], self.alternatives[b]);
            demand::computed(Thing::NearestSearches, 1);
            let found = self.scene.solver().with_counting(own, other, self.scene.state, &rows[a].counting)?;
            Ok(MemberPair {
                distance: Some(found.distance),
                lower: found.lower,
                relative_error: found.relative_error,
            })
        };
        let mut pairs: Vec<Option<MemberPair>> = vec![None; all.len()];
        let mut beyond = match counting {
            Some(_) => required.unwrap_or(0.0).max(BEYOND),
            None => 0.0,
        };
        // Those that look nearest: of all, without the first's target, without its alternative.
        let nearest_looking = |kept: &dyn Fn(usize, usize) -> bool| {
            let kept = all.iter().zip(&own_states).filter(|((a, b), _)| kept(*a, *b));
            kept.min_by(|x, y| x.1.total_cmp(y.1)).map(|(pair, _)| *pair)
        };
        if let Some((a0, b0)) = nearest_looking(&|_, _| true) {
            for kept in [&|_, _| true, &|a, _| a != a0, &|_, b| b != b0] as [&dyn Fn(usize, usize) -> bool; 3]
            {
                let Some((a, b)) = nearest_looking(kept) else { continue };
                let slot = &mut pairs[a * width + b];
                let found = match slot {
                    Some(found) => *found,
                    None => *slot.insert(in_full(a, b)?),
                };
                beyond = beyond.max(found.distance.unwrap_or(f64::INFINITY));
            }
        }
        let done = AtomicUsize::new(0);
        let open: Vec<usize> = (0..all.len()).filter(|i| pairs[*i].is_none()).collect();
        let known = |i: usize| -> Result<MemberPair> {
            let (a, b) = all[i];
            let told = done.fetch_add(1, Ordering::Relaxed) + 1;
            if told.is_multiple_of(OFTEN) {
                progress(told, open.len());
            }
            if skipping.skips() && beyond.is_finite() && beyond > 0.0 {
                let row = &rows[a];
                let question =
                    Question::new(self.scene, &row.emissivities, &row.counting, beyond, row.few.as_ref());
                let mut solvers = question.solvers();
                if question.reaches(&mut solvers, skipping, 0, b + 1, Some(own_states[i]))? {
                    return Ok(MemberPair { distance: None, lower: beyond, relative_error: 0.0 });
                }
            }
            in_full(a, b)
        };
        let found = parallel::booked(open.len(), |i| known(open[i]))?;
        for (i, pair) in open.into_iter().zip(found) {
            pairs[i] = Some(pair);
        }
        Ok(ClassDistances { alternatives: width, pairs: pairs.into_iter().flatten().collect() })
    }

    fn row(&self, a: usize, counting: Option<&Counting>, skipping: Skipping) -> Result<Row<'_>> {
        let target = self.targets[a];
        let counting = counting.cloned().map_or_else(|| self.one_photon(target), Ok)?;
        let emissivities: Vec<&[f64]> =
            std::iter::once(target).chain(self.alternatives.iter().copied()).collect();
        let few = if skipping.skips() { Few::of(self.scene, &emissivities, &counting)? } else { None };
        Ok(Row { emissivities, counting, few })
    }

    /// A camera that counts one photon of a target.
    fn one_photon(&self, target: &[f64]) -> Result<Counting> {
        let LibraryScene { bands, surroundings, state, .. } = self.scene;
        let photons = sum::sum(&bands.weigh(&surroundings.signal(target, state)));
        check::positive("photons of the target", photons, "")?;
        Ok(Counting { counts_per_radiance: 1.0 / photons, var_added: Vec::new() })
    }
}

/// A target with all alternatives behind it.
struct Row<'r> {
    emissivities: Vec<&'r [f64]>,
    counting: Counting,
    few: Option<Few>,
}

impl ClassDistances {
    /// Members of the target's class.
    #[must_use]
    pub fn targets(&self) -> usize {
        self.pairs.len() / self.alternatives.max(1)
    }

    /// The pair of least distance by `decisive`, among those that are kept; `None` if none is.
    #[must_use]
    pub fn worst(
        &self,
        decisive: impl Fn(&MemberPair) -> f64,
        kept: impl Fn(usize, usize) -> bool,
    ) -> Option<(usize, usize)> {
        let place = |i: usize| (i / self.alternatives, i % self.alternatives);
        let kept = (0..self.pairs.len()).filter(|i| kept(place(*i).0, place(*i).1));
        kept.min_by(|x, y| decisive(&self.pairs[*x]).total_cmp(&decisive(&self.pairs[*y]))).map(place)
    }

    /// What is known of a pair.
    #[must_use]
    pub fn pair(&self, a: usize, b: usize) -> Option<&MemberPair> {
        self.pairs.get(a * self.alternatives + b).filter(|_| b < self.alternatives)
    }
}
