//! Bounds that no algorithm beats. None of them calls a simulation, which is their independent witness.

pub mod calibration;
pub mod fisher;
pub mod identifiability;
pub mod policy;
pub mod ranging;
