#![doc = include_str!("../README.md")]

#[cfg(feature = "accuracy")]
pub mod accuracy;
pub mod atmosphere;
pub mod cli;
pub mod demand;
pub mod error;
pub mod fisher;
mod grid;
pub mod identifiability;
pub mod instrument;
pub mod lattice_points;
pub mod material;
pub mod minimum;
pub mod planck;
pub mod policy;
pub mod ranging;
#[cfg(feature = "accuracy")]
pub mod reference;
pub mod render;
pub mod report;
pub mod reproduce;
mod root;
pub mod scenario;
pub mod scene;
mod simd;
pub mod simulate;
pub mod spectrum;
pub mod statistics;
pub mod study;
mod sum;
pub mod units;
mod words;

pub use error::{Error, Result};
