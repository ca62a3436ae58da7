//! Tests of what holds the crate against references.

mod accuracy;
mod vectors;
