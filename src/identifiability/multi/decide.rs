//! Which materials can be told apart, with no more work than the answer needs.
//!
//! Two materials are told apart if the nearest statistical distance reaches the requirement with either of them as the
//! target. A pair is decided by the first of these that proves it:
//!
//! 1. the alternative in the target's own state is nearer than required: a distance to any state is an upper
//!    bound (to first order this is ½‖s_g‖, the distance with no nuisance);
//! 2. every n-th band alone reaches the requirement: fewer bands never carry more information, since each band adds a
//!    square to the separation at every state of the alternative, hence to the least of them;
//! 3. the search in all bands, which ends at the first state that is nearer than required.
//!
//! One direction that fails decides the pair. Proofs are as good as the search for the nearest state is.

use super::LibraryScene;
use crate::error::{Error, Result, check};
use crate::fisher::Counting;
use crate::identifiability::nearest::{Nearer, NearestSolver};
use crate::scene::{EnvironmentObject, State, Surroundings, check_emissivity};
use crate::spectrum::Bands;
use rayon::prelude::*;

/// Bands that are enough for a first look.
const FEW_BANDS: usize = 64;

/// Whether pairs that a cheap bound decides are computed all the same.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Skipping {
    /// Stop at the first proof.
    On,
    /// Compute every distance in full; the answer is the same.
    Off,
}

/// What was computed and what was not.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
pub struct Work {
    /// Distances that were asked for: two per pair of materials.
    pub distances: usize,
    /// Decided at the target's own state.
    pub decided_at_own_state: usize,
    /// Decided by a few of the bands.
    pub decided_by_few_bands: usize,
    /// Decided by a search that ended at the first state nearer than required.
    pub decided_on_the_way: usize,
    /// Not asked, since another distance had decided the question: the other direction of the pair, or another
    /// alternative that is too near.
    pub decided_by_another: usize,
    /// Computed in full.
    pub in_full: usize,
}

impl Work {
    fn and(self, other: Self) -> Self {
        Self {
            distances: self.distances + other.distances,
            decided_at_own_state: self.decided_at_own_state + other.decided_at_own_state,
            decided_by_few_bands: self.decided_by_few_bands + other.decided_by_few_bands,
            decided_on_the_way: self.decided_on_the_way + other.decided_on_the_way,
            decided_by_another: self.decided_by_another + other.decided_by_another,
            in_full: self.in_full + other.in_full,
        }
    }
}

/// Which pairs of materials can be told apart.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Decisions {
    count: usize,
    /// Row-major, symmetric; true on the diagonal.
    apart: Vec<bool>,
    /// What it took.
    pub work: Work,
}

impl Decisions {
    /// Whether materials a and b can be told apart; false for one that is not there.
    #[must_use]
    pub fn told_apart(&self, a: usize, b: usize) -> bool {
        b < self.count && self.apart.get(a * self.count + b).is_some_and(|told| *told)
    }
}

/// A solver in all bands, and one in few.
struct Solvers<'s> {
    all: NearestSolver<'s>,
    few: Option<NearestSolver<'s>>,
}

/// The scene in every n-th band.
struct Few {
    bands: Bands,
    surroundings: Surroundings,
    counting: Counting,
    emissivities: Vec<Vec<f64>>,
}

impl Few {
    fn of(scene: &LibraryScene<'_>, emissivities: &[&[f64]], counting: &Counting) -> Result<Option<Self>> {
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
            var_electronic: counting.var_electronic.iter().copied().step_by(stride).collect(),
        };
        let emissivities = emissivities.iter().map(|emissivity| kept(emissivity)).collect();
        Ok(Some(Self { bands, surroundings, counting, emissivities }))
    }
}

impl LibraryScene<'_> {
    /// Which of these materials a camera tells apart: whether the nearest statistical distance reaches
    /// `required` both ways.
    ///
    /// # Errors
    /// As [`NearestSolver::with_counting`], for the first pair that fails.
    pub fn told_apart(
        &self,
        emissivities: &[&[f64]],
        counting: &Counting,
        required: f64,
        skipping: Skipping,
    ) -> Result<Decisions> {
        check::positive("required distance", required, "")?;
        let count = emissivities.len();
        let few = match skipping {
            Skipping::On => Few::of(self, emissivities, counting)?,
            Skipping::Off => None,
        };
        let question = Question { scene: self, emissivities, counting, required, few: few.as_ref() };
        let pairs: Vec<(usize, usize)> =
            (0..count).flat_map(|a| (a + 1..count).map(move |b| (a, b))).collect();
        let answers: Result<Vec<(bool, Work)>> = pairs
            .par_iter()
            .map_init(
                || question.solvers(),
                |solvers, &(a, b)| match skipping {
                    Skipping::On => question.decide(solvers, a, b),
                    Skipping::Off => question.compute(solvers, a, b),
                },
            )
            .collect();
        let mut apart = vec![true; count * count];
        let mut work = Work::default();
        for (&(a, b), (told, took)) in pairs.iter().zip(answers?) {
            (apart[a * count + b], apart[b * count + a]) = (told, told);
            work = work.and(took);
        }
        Ok(Decisions { count, apart, work })
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
    ) -> Result<(Option<usize>, Work)> {
        check::positive("required distance", required, "")?;
        if target >= emissivities.len() {
            let found = emissivities.len();
            return Err(Error::Length { what: "materials".into(), found, expected: target + 1 });
        }
        let few = Few::of(self, emissivities, counting)?;
        let question = Question { scene: self, emissivities, counting, required, few: few.as_ref() };
        let mut solvers = question.solvers();
        let mut ranked = Vec::new();
        for other in (0..emissivities.len()).filter(|&other| other != target) {
            let (own, other_e) = (emissivities[target], emissivities[other]);
            let distance = solvers.all.own_state_distance(own, other_e, self.state, counting)?;
            ranked.push((distance, other));
        }
        ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut work = Work { distances: ranked.len(), ..Work::default() };
        for (asked, (_, other)) in ranked.iter().enumerate() {
            if !question.reaches(&mut solvers, target, *other, &mut work)? {
                work.decided_by_another = ranked.len() - asked - 1;
                return Ok((Some(*other), work));
            }
        }
        Ok((None, work))
    }
}

/// What is asked of every pair.
struct Question<'q> {
    scene: &'q LibraryScene<'q>,
    emissivities: &'q [&'q [f64]],
    counting: &'q Counting,
    required: f64,
    few: Option<&'q Few>,
}

impl<'q> Question<'q> {
    fn solvers(&self) -> Solvers<'q> {
        let LibraryScene { unknowns, range, .. } = self.scene;
        let few = self
            .few
            .map(|few| NearestSolver::new(&few.bands, &few.surroundings, (*unknowns).clone(), *range));
        Solvers { all: self.scene.solver(), few }
    }

    fn state(&self) -> &State {
        self.scene.state
    }

    /// Both distances in full.
    fn compute(&self, solvers: &mut Solvers<'_>, a: usize, b: usize) -> Result<(bool, Work)> {
        let mut distance = |a: usize, b: usize| {
            let (own, other) = (self.emissivities[a], self.emissivities[b]);
            solvers.all.with_counting(own, other, self.state(), self.counting).map(|found| found.distance)
        };
        let told = distance(a, b)? >= self.required && distance(b, a)? >= self.required;
        Ok((told, Work { distances: 2, in_full: 2, ..Work::default() }))
    }

    /// No more than the answer needs.
    fn decide(&self, solvers: &mut Solvers<'_>, a: usize, b: usize) -> Result<(bool, Work)> {
        let mut work = Work { distances: 2, ..Work::default() };
        for (asked, (a, b)) in [(a, b), (b, a)].into_iter().enumerate() {
            if !self.reaches(solvers, a, b, &mut work)? {
                work.decided_by_another = 1 - asked;
                return Ok((false, work));
            }
        }
        Ok((true, work))
    }

    /// Whether target a is told from alternative b.
    fn reaches(&self, solvers: &mut Solvers<'_>, a: usize, b: usize, work: &mut Work) -> Result<bool> {
        let (own, other) = (self.emissivities[a], self.emissivities[b]);
        if solvers.all.own_state_distance(own, other, self.state(), self.counting)? < self.required {
            work.decided_at_own_state += 1;
            return Ok(false);
        }
        if let (Some(few), Some(solver)) = (self.few, solvers.few.as_mut()) {
            let (own, other) = (&few.emissivities[a], &few.emissivities[b]);
            let found = solver.nearer_than(own, other, self.state(), &few.counting, self.required)?;
            if found == Nearer::Nowhere {
                work.decided_by_few_bands += 1;
                return Ok(true);
            }
        }
        match solvers.all.nearer_than(own, other, self.state(), self.counting, self.required)? {
            Nearer::Somewhere => {
                work.decided_on_the_way += 1;
                Ok(false)
            }
            Nearer::Nowhere => {
                work.in_full += 1;
                Ok(true)
            }
        }
    }
}
