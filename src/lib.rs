//! The physical limits of seeing by heat.

mod base;
pub mod instrument;
mod limits;
mod physics;
mod witness;

pub use base::error::{Error, Result};
pub(crate) use base::simd;
pub use base::{allowed, demand, error, grid, root, statistics, sum, units, words};
pub use limits::{fisher, identifiability, policy, ranging};
pub use physics::{atmosphere, material, planck, scene, spectrum};
pub use witness::{render, simulate};
