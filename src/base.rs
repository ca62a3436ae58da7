//! What every storey stands on: errors, units, sums, lattices, one-dimensional solvers, best-first search, least squares in a box,
//! statistics, stopping.

pub mod aligned;
pub mod allowed;
pub(crate) mod best_first;
pub(crate) mod box_least_squares;
pub mod correlation;
pub mod cube;
pub mod demand;
pub mod error;
pub mod grid;
pub mod inputs;
pub mod lattice_points;
pub mod minimum;
pub(crate) mod named;
pub mod order;
pub mod parallel;
pub mod radiance_unit;
pub mod random;
pub mod root;
pub mod simd;
pub mod statistics;
pub mod stop;
pub mod sum;
pub mod units;
pub(crate) mod wide;
pub mod words;
