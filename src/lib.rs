//! Physical limits of seeing by heat.

pub mod error;
pub mod report;
pub mod units;

pub use error::{Error, Result};
