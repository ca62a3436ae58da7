//! How accurate the answers are, measured against the reference path.

pub mod stress;
