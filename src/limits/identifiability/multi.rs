//! Many materials: distances of each against all, what they predict, and which can be told apart.
//!
//! Algorithm 3 of the paper: the distances from a target to every alternative, the least of which decides whether it is
//! identifiable (S33). All against all, everything that depends on the target alone is computed once
//! ([`LocalMatrix`], [`LibraryScene`]); where only a yes or no is asked for, [`LibraryScene::told_apart`] stops at the
//! first proof of either. Where target and alternative are classes of several spectra each, [`Classes`] finds the worst pair of
//! members, and what the others need be known of.
//!
//! Source: paper SII B, S32–S34, Algorithm 3.

mod beyond;
mod classes;
mod count;
mod decide;
mod local;
mod nearest;
mod predict;
mod scaling;

pub use crate::demand::Skipping;
pub use classes::{ClassDistances, Classes, MemberPair};
pub use count::check_count;
pub use decide::Decisions;
pub use local::{LocalMatrix, Passes};
pub use nearest::{LibraryScene, NearestMatrix, Progress};
pub use predict::{chains, clusters, prediction};
pub use scaling::expected_minimum;
