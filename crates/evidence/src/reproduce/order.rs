//! How an item is asked for, and what it gives.

use super::ledger::Line;
use hadar_report::bundle::Bundle;

/// How much is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Effort {
    /// Every experiment.
    Full,
    /// Some of them.
    Quick,
}

/// How an item is made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Order {
    /// All experiments or some.
    pub effort: Effort,
    /// Seed of all that is drawn.
    pub seed: u64,
}

impl Order {
    /// The seed of a study whose committed report has the seed `first`: the default of 1 keeps it.
    pub(super) const fn seed_from(self, first: u64) -> u64 {
        first.wrapping_add(self.seed.wrapping_sub(1))
    }

    /// Of `all` experiments in a list: those that are made.
    pub(super) fn some_of<T>(self, all: &[T], quick: usize) -> &[T] {
        match self.effort {
            Effort::Full => all,
            Effort::Quick => &all[..quick.min(all.len())],
        }
    }
}

/// Is told how many experiments of how many are done.
pub(crate) type Progress<'a> = &'a (dyn Fn(usize, usize) + Sync);

/// Pictures of a page with their captions, and what is printed below them.
#[derive(Debug, Clone, Default)]
pub(super) struct Figures {
    pub(super) pictures: Vec<(&'static str, &'static str)>,
    pub(super) text: String,
}

/// Files, lines of the ledger and what its page shows.
pub(super) type Made = (Bundle, Vec<Line>, Figures);
