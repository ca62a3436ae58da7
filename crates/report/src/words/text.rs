//! What several answers say in the same words: numbers, pairs of materials, what results rest on, what they took.

pub(crate) mod columns;
pub(crate) mod cubes;
pub(crate) mod footing;
pub(crate) mod numbers;
pub(crate) mod pairs;
mod stats;

pub use footing::with_settings;
pub use numbers::{between, photons_between, quantity, significant};
pub use stats::stats;
