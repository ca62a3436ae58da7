//! Many materials: distances of each against all.

mod local;

pub use local::LocalMatrix;
