//! What a question needs, and what of that was computed.
//!
//! A question goes to its answer with a [`Demand`]: it says whether proofs may spare work ([`Skipping`]), and every
//! part of the work passes through one of its gates, which runs what is needed, leaves out the rest, and books both:
//!
//! * [`Demand::if_asked`]: parts that nobody asked for;
//! * [`Demand::first_proof`]: an answer by the cheapest proof that gives it, the dear ones left out;
//! * [`Demand::until`]: one of many answers that settles the question, the others left out.
//!
//! What is counted in bulk (windows, samples, trials) is booked by those who count it. The ledger [`Work`] has a line
//! for every kind of [`Thing`]: how many were computed, and how many were spared, by [`Reason`]. How many there could
//! have been at most is the sum of these, never a number of its own, so that the lines always add up. Ledgers add in
//! any order and grouping.

mod ledger;

pub use ledger::{Line, Reason, Thing, Work};

use crate::error::Result;

/// Whether work that a proof makes needless is left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Skipping {
    /// Stop at the first proof.
    #[default]
    On,
    /// Compute everything in full; the answer is the same.
    Off,
}

/// A question on the way to its answer.
///
/// ```
/// use hadar::demand::{Demand, Proof, Reason, Skipping, Thing};
///
/// // Is 91 a prime? Its last digit might tell; division by all numbers does.
/// let digit = Proof {
///     of: Some(Thing::OwnStateDistances),
///     spares: Reason::OwnState,
///     find: &|n: &mut u32| Ok((*n % 2 == 0).then_some(false).into()),
/// };
/// let in_full = |n: &mut u32| Ok(((2..*n).all(|k| *n % k != 0), None));
/// for (number, tried) in [(91, 1), (92, 0)] {
///     let mut demand = Demand::new(Skipping::On);
///     let prime = demand.first_proof(&mut { number }, &[digit], Thing::NearestSearches, &in_full)?;
///     assert!(!prime);
///     assert_eq!(demand.work().computed(Thing::NearestSearches), tried);
///     assert_eq!(demand.work().possible(Thing::NearestSearches), 1);
/// }
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Demand {
    skipping: Skipping,
    work: Work,
}

/// A cheap way to an answer, which may find none.
pub struct Proof<'p, C, A> {
    /// What trying it computes; `None` where that was computed before.
    pub of: Option<Thing>,
    /// Why whatever comes after it is spared where it finds the answer.
    pub spares: Reason,
    /// The answer, or none.
    pub find: Try<'p, C, A>,
}

/// What came of a proof.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Attempt<A> {
    /// The answer.
    Proved(A),
    /// No answer.
    Open,
    /// It was not tried, since it would hardly find an answer.
    NotTried,
}

impl<A> From<Option<A>> for Attempt<A> {
    fn from(found: Option<A>) -> Self {
        found.map_or(Self::Open, Self::Proved)
    }
}

/// Tries to find an answer.
pub type Try<'p, C, A> = &'p dyn Fn(&mut C) -> Result<Attempt<A>>;
/// Finds the answer; with a reason where it was found before all was computed.
pub type Full<'p, C, A> = &'p dyn Fn(&mut C) -> Result<(A, Option<Reason>)>;

impl<C, A> Clone for Proof<'_, C, A> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<C, A> Copy for Proof<'_, C, A> {}

impl Demand {
    /// A question that nothing has been done for.
    #[must_use]
    pub fn new(skipping: Skipping) -> Self {
        Self { skipping, work: Work::default() }
    }

    /// Whether proofs may spare work.
    #[must_use]
    pub const fn skipping(&self) -> Skipping {
        self.skipping
    }

    /// Whether work that a proof makes needless is left out.
    #[must_use]
    pub fn skips(&self) -> bool {
        self.skipping == Skipping::On
    }

    /// What it took so far.
    #[must_use]
    pub const fn work(&self) -> &Work {
        &self.work
    }

    /// What it took.
    #[must_use]
    pub fn into_work(self) -> Work {
        self.work
    }

    /// So many were computed.
    pub fn computed(&mut self, thing: Thing, count: usize) {
        self.work.compute(thing, count as u64);
    }

    /// So many were not needed.
    pub fn spared(&mut self, thing: Thing, reason: Reason, count: usize) {
        self.work.spare(thing, reason, count as u64);
    }

    /// What another question took, of which this one is made up.
    pub fn add(&mut self, work: &Work) {
        self.work.add(work);
    }

    /// Computes `count` things if they are asked for, and nothing else.
    ///
    /// # Errors
    /// Those of `make`.
    pub fn if_asked<T>(
        &mut self,
        asked: bool,
        thing: Thing,
        count: usize,
        make: impl FnOnce(&mut Self) -> Result<T>,
    ) -> Result<Option<T>> {
        if !asked {
            self.spared(thing, Reason::NotAsked, count);
            return Ok(None);
        }
        let made = make(self)?;
        self.computed(thing, count);
        Ok(Some(made))
    }

    /// One `thing` by the first of the `proofs` that gives an answer, else `in_full`; without skipping always so.
    ///
    /// # Errors
    /// Those of the proofs, and of the computation in full.
    pub fn first_proof<C, A>(
        &mut self,
        context: &mut C,
        proofs: &[Proof<'_, C, A>],
        thing: Thing,
        in_full: Full<'_, C, A>,
    ) -> Result<A> {
        let proofs = if self.skips() { proofs } else { &[] };
        for (i, proof) in proofs.iter().enumerate() {
            let found = (proof.find)(context)?;
            match proof.of {
                Some(of) if matches!(found, Attempt::NotTried) => self.spared(of, Reason::Hopeless, 1),
                Some(of) => self.computed(of, 1),
                None => {}
            }
            if let Attempt::Proved(answer) = found {
                let later = proofs[i + 1..].iter().filter_map(|later| later.of);
                later.chain([thing]).for_each(|of| self.spared(of, proof.spares, 1));
                return Ok(answer);
            }
        }
        let (answer, ended) = in_full(context)?;
        match ended {
            None => self.computed(thing, 1),
            Some(reason) => self.spared(thing, reason, 1),
        }
        Ok(answer)
    }

    /// The first answer that settles a question about many items, in their order; `None` where none does. Items after
    /// it spare one of each of the `things` they would have taken; without skipping all are looked at.
    ///
    /// # Errors
    /// That of the first item that fails.
    pub fn until<I, A>(
        &mut self,
        items: impl IntoIterator<Item = I>,
        things: &[Thing],
        mut settles: impl FnMut(&mut Self, I) -> Result<Option<A>>,
    ) -> Result<Option<A>> {
        let mut answer = None;
        for item in items {
            if answer.is_some() && self.skips() {
                things.iter().for_each(|thing| self.spared(*thing, Reason::AnotherOne, 1));
                continue;
            }
            let found = settles(self, item)?;
            answer = answer.or(found);
        }
        Ok(answer)
    }
}

#[cfg(test)]
mod tests;
