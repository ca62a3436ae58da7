//! Questions about thermal cameras answered: scenarios from files, results as data.

pub mod scenario;
pub mod study;
pub mod warning;
pub mod words;
