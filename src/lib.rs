//! Physical limits of seeing by heat.

pub mod error;
pub mod planck;
mod simd;
pub mod spectrum;
mod sum;
pub mod units;

pub use error::{Error, Result};
