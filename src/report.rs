//! Results made readable. Physics never imports this module; it imports no physics.

pub mod plot;
