//! `hadar` held against references in extended precision.

pub mod accuracy;
pub mod reference;
