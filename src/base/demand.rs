//! What a question needs, and what of that was computed.
//!
//! A question is answered with or without [`Skipping`], and every part of the work passes through one of these gates,
//! which runs what is needed, leaves out the rest, and books both:
//!
//! * [`if_asked`]: parts that nobody asked for;
//! * [`Skipping::first_proof`]: an answer by the cheapest proof that gives it, the dear ones left out;
//! * [`Skipping::until`]: one of many answers that settles the question, the others left out.
//!
//! What is counted in bulk (windows, samples, trials) is booked by those who count it. All of it goes to the [`Ledger`]
//! that is open around the work. What stands in it, [`Work`], has a line for every kind of [`Thing`]: how many were
//! computed, and how many were spared, by [`Reason`]. How many there could have been at most is the sum of these, never a
//! number of its own, so that the lines always add up. Ledgers add in any order and grouping.

mod ledger;
mod sink;

pub use ledger::{Line, Reason, Thing, Work};
pub use sink::{Ledger, add, computed, ledger_of, spared};

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

/// Computes `count` things if they are asked for, and nothing else.
///
/// # Errors
/// Those of `make`.
pub fn if_asked<T>(
    asked: bool,
    thing: Thing,
    count: u64,
    make: impl FnOnce() -> Result<T>,
) -> Result<Option<T>> {
    if !asked {
        spared(thing, Reason::NotAsked, count);
        return Ok(None);
    }
    let made = make()?;
    computed(thing, count);
    Ok(Some(made))
}

impl Skipping {
    /// Whether work that a proof makes needless is left out.
    #[must_use]
    pub fn skips(self) -> bool {
        self == Self::On
    }

    /// One `thing` by the first of the `proofs` that gives an answer, else `in_full`; without skipping always so.
    ///
    /// ```
    /// use hadar::demand::{Proof, Reason, Skipping, Thing, ledger_of};
    ///
    /// // Is 91 a prime? Its last digit might tell; division by all numbers does.
    /// let digit = Proof {
    ///     of: Some(Thing::OwnStateDistances),
    ///     spares: Reason::OwnState,
    ///     find: &|n: &mut u32| Ok((*n % 2 == 0).then_some(false).into()),
    /// };
    /// let in_full = |n: &mut u32| Ok(((2..*n).all(|k| *n % k != 0), None));
    /// for (number, tried) in [(91, 1), (92, 0)] {
    ///     let (prime, work) = ledger_of(|| {
    ///         Skipping::On.first_proof(&mut { number }, &[digit], Thing::NearestSearches, &in_full)
    ///     })?;
    ///     assert!(!prime);
    ///     assert_eq!(work.computed(Thing::NearestSearches), tried);
    ///     assert_eq!(work.possible(Thing::NearestSearches), 1);
    /// }
    /// # Ok::<(), hadar::Error>(())
    /// ```
    ///
    /// # Errors
    /// Those of the proofs, and of the computation in full.
    pub fn first_proof<C, A>(
        self,
        context: &mut C,
        proofs: &[Proof<'_, C, A>],
        thing: Thing,
        in_full: Full<'_, C, A>,
    ) -> Result<A> {
        let proofs = if self.skips() { proofs } else { &[] };
        for (i, proof) in proofs.iter().enumerate() {
            let found = (proof.find)(context)?;
            match proof.of {
                Some(of) if matches!(found, Attempt::NotTried) => spared(of, Reason::Hopeless, 1),
                Some(of) => computed(of, 1),
                None => {}
            }
            if let Attempt::Proved(answer) = found {
                let later = proofs[i + 1..].iter().filter_map(|later| later.of);
                later.chain([thing]).for_each(|of| spared(of, proof.spares, 1));
                return Ok(answer);
            }
        }
        let (answer, ended) = in_full(context)?;
        match ended {
            None => computed(thing, 1),
            Some(reason) => spared(thing, reason, 1),
        }
        Ok(answer)
    }

    /// The first answer that settles a question about many items, in their order; `None` where none does. Items after
    /// it spare one of each of the `things` they would have taken; without skipping all are looked at.
    ///
    /// # Errors
    /// That of the first item that fails.
    pub fn until<I, A>(
        self,
        items: impl IntoIterator<Item = I>,
        things: &[Thing],
        mut settles: impl FnMut(I) -> Result<Option<A>>,
    ) -> Result<Option<A>> {
        let mut answer = None;
        for item in items {
            if answer.is_some() && self.skips() {
                things.iter().for_each(|thing| spared(*thing, Reason::AnotherOne, 1));
                continue;
            }
            let found = settles(item)?;
            answer = answer.or(found);
        }
        Ok(answer)
    }
}

#[cfg(test)]
mod tests;
