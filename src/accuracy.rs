//! How long answers take, and what they are worth.

pub mod skipping;
