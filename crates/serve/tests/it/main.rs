//! The pages as a client sees them.

mod page;
mod rules;
mod support;
