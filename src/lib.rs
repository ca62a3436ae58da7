//! Physical limits of seeing by heat.

pub mod error;
pub mod scenario;
pub mod units;

pub use error::{Error, Result};
