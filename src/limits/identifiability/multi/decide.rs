//! Which materials can be told apart, with no more work than the answer needs.
//!
//! Two materials are told apart if the nearest statistical distance reaches the requirement with either of them as the
//! target. A pair is decided by the first of these that proves it:
//!
//! 0. sums that all pairs of the target share bound the distance from below ([`super::beyond`], in every n-th band as 3);
//! 1. the alternative in the target's own state is nearer than required: a distance to any state is an upper
//!    bound (to first order this is ½‖s_g‖, the distance with no nuisance);
//! 2. a descent from there comes to a state that is nearer than required;
//! 3. every n-th band alone reaches the requirement: fewer bands never carry more information, since each band adds a
//!    square to the separation at every state of the alternative, hence to the least of them;
//! 4. the search in all bands, which ends at the first state that is nearer than required.
//!
//! Whether 1 and 2 are worth trying the local distance in every n-th band tells (times √n it is about that in all): it proves
//! nothing, and is only a guess at what will. Before 3 a descent in the few bands shows cheaply where they fail.
//!
//! One direction that fails decides the pair. That no state is nearer is proved by branch and bound (see
//! [`NearestSolver::nearer_than`]); where the effort does not suffice for a proof the two are not told apart.

use super::beyond::{Beyond, Seen};
use super::count::check_count;
use super::{LibraryScene, Progress};
use crate::demand::{self, Attempt, Proof, Reason, Skipping, Thing};
use crate::error::{Error, Result, check};
use crate::fisher::Counting;
use crate::identifiability::local::LocalSolver;
use crate::identifiability::nearest::{Nearer, NearestDistance, NearestSolver};
use crate::order;
use crate::parallel;
use crate::scene::{EnvironmentObject, Surroundings, check_emissivity};
use crate::spectrum::Bands;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Pairs after which it is told how many are decided.
const OFTEN: usize = 100;
/// Bands that are enough for a first look.
const FEW_BANDS: usize = 64;

/// A local distance in few bands below this many times what is required leaves little hope that they suffice.
const CLOSE: f64 = 2.0;

/// What deciding a distance takes at most, with skipping, and what it takes where bands are few already.
const THINGS: [Thing; 6] = [
    Thing::SharedBounds,
    Thing::FewBandEstimates,
    Thing::OwnStateDistances,
    Thing::Descents,
    Thing::FewBandSearches,
    Thing::NearestSearches,
];
const THINGS_OF_FEW: [Thing; 3] = [Thing::SharedBounds, Thing::OwnStateDistances, Thing::NearestSearches];

/// Which pairs of materials can be told apart.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Decisions {
    count: usize,
    /// Row-major, symmetric; true on the diagonal.
    apart: Vec<bool>,
}

impl Decisions {
    /// Whether materials a and b can be told apart; false for one that is not there.
    #[must_use]
    pub fn told_apart(&self, a: usize, b: usize) -> bool {
        b < self.count && self.apart.get(a * self.count + b).is_some_and(|told| *told)
    }
}

/// A solver in all bands, and one in few.
pub(super) struct Solvers<'s> {
    pub(super) all: NearestSolver<'s>,
    few: Option<(LocalSolver<'s>, NearestSolver<'s>)>,
    /// The local distance in few bands of the pair at hand.
    estimate: f64,
    /// Where a descent in all bands ended.
    minimum: Option<NearestDistance>,
}

/// The scene in every n-th band.
pub(super) struct Few {
    bands: Bands,
    surroundings: Surroundings,
    counting: Counting,
    emissivities: Vec<Vec<f64>>,
    /// Every so many bands are kept.
    stride: usize,
}

impl Few {
    pub(super) fn of(
        scene: &LibraryScene<'_>,
        emissivities: &[&[f64]],
        counting: &Counting,
    ) -> Result<Option<Self>> {
        let nodes = scene.surroundings.nodes_cm1().len();
        emissivities.iter().try_for_each(|emissivity| check_emissivity(emissivity, nodes))?;
        let stride = scene.bands.len() / FEW_BANDS;
        if stride < 2 {
            return Ok(None);
        }
        let (bands, places) = scene.bands.every(stride);
        let kept = |values: &[f64]| -> Vec<f64> { places.iter().map(|&j| values[j]).collect() };
        let objects = scene.surroundings.objects().iter().map(|object| EnvironmentObject {
            temperature_k: object.temperature_k,
            emissivity: object.emissivity.as_deref().map(kept),
        });
        let surroundings = Surroundings::new(bands.nodes_cm1(), objects.collect())?;
        let counting = Counting {
            counts_per_radiance: counting.counts_per_radiance,
            var_added: counting.var_added.iter().copied().step_by(stride).collect(),
        };
        let emissivities = emissivities.iter().map(|emissivity| kept(emissivity)).collect();
        Ok(Some(Self { bands, surroundings, counting, emissivities, stride }))
    }
}

impl LibraryScene<'_> {
    /// Which of these materials a camera tells apart: whether the nearest statistical distance reaches
    /// `required` both ways. `progress` is told the pairs decided.
    ///
    /// # Errors
    /// As [`NearestSolver::with_counting`], for the first pair that fails.
    pub fn told_apart(
        &self,
        emissivities: &[&[f64]],
        counting: &Counting,
        required: f64,
        skipping: Skipping,
        progress: Progress<'_>,
    ) -> Result<Decisions> {
        check::positive("required distance", required, "")?;
        let count = emissivities.len();
        check_count(count)?;
        let few = match skipping {
            Skipping::On => Few::of(self, emissivities, counting)?,
            Skipping::Off => None,
        };
        let mut question = Question::new(self, emissivities, counting, required, few.as_ref());
        if skipping.skips() && count > 1 {
            // A pair that is looked at makes sure of these itself.
            self.range.check()?;
            counting.check(self.bands.len())?;
            question.bound_all()?;
        }
        let all = count * count.saturating_sub(1) / 2;
        let is_open = |(a, b): &(usize, usize)| !(question.is_beyond(*a, *b) && question.is_beyond(*b, *a));
        let pairs: Vec<(usize, usize)> =
            (0..count).flat_map(|a| (a + 1..count).map(move |b| (a, b))).filter(is_open).collect();
        let sure = all - pairs.len();
        if sure > 0 {
            demand::computed(Thing::SharedBounds, 2 * sure as u64);
            let rest = question.things()[1..].iter();
            rest.for_each(|thing| demand::spared(*thing, Reason::ProvedAbove, 2 * sure as u64));
            progress(sure, all);
        }
        let done = AtomicUsize::new(sure);
        let is_told = |solvers: &mut Solvers<'_>, (a, b)| {
            let nearer = skipping.until([(a, b), (b, a)], question.things(), |(a, b)| {
                let reached = question.reaches(solvers, skipping, a, b, None)?;
                Ok((!reached).then_some(()))
            })?;
            let decided = done.fetch_add(1, Ordering::Relaxed) + 1;
            if decided.is_multiple_of(OFTEN) {
                progress(decided, all);
            }
            Ok(nearer.is_none())
        };
        let answers =
            parallel::booked_with(pairs.len(), || question.solvers(), |own, i| is_told(own, pairs[i]))?;
        let mut apart = vec![true; count * count];
        for (&(a, b), told) in pairs.iter().zip(answers) {
            (apart[a * count + b], apart[b * count + a]) = (told, told);
        }
        Ok(Decisions { count, apart })
    }
}

impl LibraryScene<'_> {
    /// The first alternative found that a camera does not tell from `target`; `None` if it tells all. Those that
    /// look most like it in its own state are asked first, and the first proof ends the work.
    ///
    /// # Errors
    /// As [`NearestSolver::with_counting`].
    pub fn first_not_told_from(
        &self,
        target: usize,
        emissivities: &[&[f64]],
        counting: &Counting,
        required: f64,
        skipping: Skipping,
    ) -> Result<Option<usize>> {
        check::positive("required distance", required, "")?;
        if target >= emissivities.len() {
            let found = emissivities.len();
            return Err(Error::Length { what: "materials".into(), found, expected: target + 1 });
        }
        let few = match skipping {
            Skipping::On => Few::of(self, emissivities, counting)?,
            Skipping::Off => None,
        };
        let question = Question::new(self, emissivities, counting, required, few.as_ref());
        let mut solvers = question.solvers();
        let mut ranked = Vec::new();
        for other in (0..emissivities.len()).filter(|&other| other != target) {
            let (own, other_e) = (emissivities[target], emissivities[other]);
            let distance = solvers.all.own_state_distance(own, other_e, self.state, counting)?;
            demand::computed(Thing::OwnStateDistances, 1);
            ranked.push((distance, other));
        }
        order::ascending(&mut ranked, |a| a.0);
        // These stand in the ranking already.
        let mut things = question.things().to_vec();
        things.retain(|thing| *thing != Thing::OwnStateDistances);
        skipping.until(ranked, &things, |(distance, other)| {
            let reached = question.reaches(&mut solvers, skipping, target, other, Some(distance))?;
            Ok((!reached).then_some(other))
        })
    }
}

/// What is asked of every pair.
pub(super) struct Question<'q> {
    pub(super) scene: &'q LibraryScene<'q>,
    pub(super) emissivities: &'q [&'q [f64]],
    pub(super) counting: &'q Counting,
    pub(super) required: f64,
    pub(super) few: Option<&'q Few>,
    /// Whether a bound that the pairs of a target share proves that it is told from an alternative; empty where there is none.
    beyond: Vec<bool>,
}

impl<'q> Question<'q> {
    pub(super) fn new(
        scene: &'q LibraryScene<'q>,
        emissivities: &'q [&'q [f64]],
        counting: &'q Counting,
        required: f64,
        few: Option<&'q Few>,
    ) -> Self {
        Self { scene, emissivities, counting, required, few, beyond: Vec::new() }
    }

    /// Bounds the distances of all pairs, target by target.
    fn bound_all(&mut self) -> Result<()> {
        let beyond = match self.few {
            Some(few) => {
                let own = few.emissivities.iter().map(Vec::as_slice).collect();
                let scene =
                    LibraryScene { bands: &few.bands, surroundings: &few.surroundings, ..*self.scene };
                Beyond::new(&scene, &few.counting, own, self.required)
            }
            None => Beyond::new(self.scene, self.counting, self.emissivities.to_vec(), self.required),
        };
        if let Some(beyond) = beyond {
            let count = self.emissivities.len();
            let of_target = |seen: &mut Seen, target| Ok(beyond.of_target(target, seen));
            self.beyond = parallel::booked_with(count, Seen::default, of_target)?.concat();
        }
        Ok(())
    }

    pub(super) fn solvers(&self) -> Solvers<'q> {
        let LibraryScene { unknowns, range, .. } = self.scene;
        let few = self.few.map(|few| {
            let (bands, surroundings) = (&few.bands, &few.surroundings);
            let local = LocalSolver::new(bands, surroundings, (*unknowns).clone());
            (local, NearestSolver::new(bands, surroundings, (*unknowns).clone(), *range))
        });
        Solvers { all: self.scene.solver(), few, estimate: f64::NAN, minimum: None }
    }

    /// Whether a bound that the pairs of target a share proves that it is told from b.
    fn is_beyond(&self, a: usize, b: usize) -> bool {
        self.beyond.get(a * self.emissivities.len() + b).is_some_and(|beyond| *beyond)
    }

    /// What one distance takes at most.
    fn things(&self) -> &'static [Thing] {
        let all: &[Thing] = if self.few.is_some() { &THINGS } else { &THINGS_OF_FEW };
        // Bounds stand first.
        &all[usize::from(self.beyond.is_empty())..]
    }

    /// Whether target a is told from alternative b; the distance in the target's own state where it is known.
    pub(super) fn reaches(
        &self,
        solvers: &mut Solvers<'_>,
        skipping: Skipping,
        a: usize,
        b: usize,
        in_own_state: Option<f64>,
    ) -> Result<bool> {
        let (own, other) = (self.emissivities[a], self.emissivities[b]);
        let (state, counting, required) = (self.scene.state, self.counting, self.required);
        let stride = self.few.map_or(1.0, |few| few.stride as f64);
        let hopeless = |solvers: &Solvers<'_>| solvers.estimate * stride.sqrt() >= CLOSE * required;
        let own_state = |solvers: &mut Solvers<'_>| {
            let distance = match in_own_state {
                Some(distance) => distance,
                None if hopeless(solvers) => return Ok(Attempt::NotTried),
                None => solvers.all.own_state_distance(own, other, state, counting)?,
            };
            Ok((distance < required).then_some(false).into())
        };
        let estimate = |solvers: &mut Solvers<'_>| {
            if let (Some(few), Some((local, _))) = (self.few, solvers.few.as_mut()) {
                let (own, other) = (&few.emissivities[a], &few.emissivities[b]);
                let found = local.with_counting(own, other, state, &few.counting);
                // Where there is none, nothing is guessed and everything tried.
                solvers.estimate = found.map_or(f64::NAN, |local| local.distance);
            }
            Ok(Attempt::Open)
        };
        let descent = |solvers: &mut Solvers<'_>| {
            solvers.minimum = None;
            if hopeless(solvers) {
                return Ok(Attempt::NotTried);
            }
            let found = solvers.all.descend(own, other, state, counting, required)?;
            let nearer = found.distance < required;
            solvers.minimum = Some(found);
            Ok(nearer.then_some(false).into())
        };
        let few_bands = |solvers: &mut Solvers<'_>| {
            let close = solvers.estimate < CLOSE * required;
            let (Some(few), Some((_, solver))) = (self.few, solvers.few.as_mut()) else {
                return Ok(Attempt::Open);
            };
            let (own, other) = (&few.emissivities[a], &few.emissivities[b]);
            // One state that is nearer in the few bands, and they prove nothing.
            if close && solver.descend(own, other, state, &few.counting, required)?.distance < required {
                return Ok(Attempt::NotTried);
            }
            let found = solver.nearer_than(own, other, state, &few.counting, required, None)?;
            Ok((found == Nearer::Nowhere).then_some(true).into())
        };
        let in_full = |solvers: &mut Solvers<'_>| {
            let known = match solvers.minimum.take() {
                None if !skipping.skips() => {
                    let found = solvers.all.with_counting(own, other, state, counting)?;
                    if found.distance < required {
                        return Ok((false, None));
                    }
                    Some(found)
                }
                known => known,
            };
            Ok(match solvers.all.nearer_than(own, other, state, counting, required, known.as_ref())? {
                Nearer::Somewhere => (false, skipping.skips().then_some(Reason::NearerState)),
                Nearer::Nowhere => (true, None),
                // On the safe side.
                Nearer::Undecided => (false, None),
            })
        };
        let shared = |_: &mut Solvers<'_>| Ok(self.is_beyond(a, b).then_some(true).into());
        let of_shared = (!self.beyond.is_empty()).then_some(Thing::SharedBounds);
        let own_is_new = in_own_state.is_none().then_some(Thing::OwnStateDistances);
        let proofs = [
            Proof { of: of_shared, spares: Reason::ProvedAbove, find: &shared },
            Proof { of: Some(Thing::FewBandEstimates), spares: Reason::Decided, find: &estimate },
            Proof { of: own_is_new, spares: Reason::OwnState, find: &own_state },
            Proof { of: Some(Thing::Descents), spares: Reason::Descent, find: &descent },
            Proof { of: Some(Thing::FewBandSearches), spares: Reason::FewBands, find: &few_bands },
        ];
        let of_few = [proofs[0], proofs[2]];
        let proofs = if self.few.is_some() { &proofs[..] } else { &of_few };
        skipping.first_proof(solvers, proofs, Thing::NearestSearches, &in_full)
    }
}
