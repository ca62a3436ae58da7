//! A material at its best.

use super::super::step::{State, Step};

/// A material at its best.
#[derive(Debug, Clone, Copy)]
pub(in crate::decompose) struct Fit {
    pub(in crate::decompose) state: State,
    pub(in crate::decompose) deviance: f64,
    /// Pearson's χ², with the errors of the library where they are stated.
    pub(in crate::decompose) chi_square: f64,
}

impl Fit {
    /// After a step so short that no look at it is needed.
    pub(super) fn after(self, state: State, step: Step) -> Self {
        let less = step.square.max(0.0);
        Self { state, deviance: self.deviance - less, chi_square: self.chi_square - less }
    }
}
