//! The crate's own reference path: the same answers in extended precision, by the plainest formulas.
//!
//! What the fast path takes such care over is written here as the textbooks have it, B = 2cν²/(eˣ − 1), B(T) − ΣVₖB(Tₖ)
//! by subtraction, Gram and Schmidt column by column, at a precision ([`PRECISION`] bits, 154 digits) that leaves more
//! than 30 digits after every cancellation the fast path may meet: a last bit of a temperature (16 digits), of a
//! lighting factor (16), of an emissivity (16), nuisances that depend on each other up to 1e-14 (14 each), and what a
//! nearly blind pair leaves (16). The range of exponents is ±2³¹, so that nothing overflows or underflows. A number that
//! is a double is taken as it is, all its bits exact.
//!
//! It shares types with the fast path (bands, surroundings, states, unknowns, noise) but no arithmetic. It is
//! slow: some 10 µs for every exponential.
//!
//! * [`extended`]: the numbers;
//! * [`planck`]: photon radiance, its slope and differences;
//! * [`camera`]: counts and noise;
//! * [`local`]: local distances;
//! * [`nearest`]: separation of two states, and the nearest one from given starts;
//! * [`probability`]: tail of the normal law, and exact errors of the best test between Poisson laws.

pub mod brute_force;
pub mod camera;
pub mod double_double;
pub mod extended;
pub mod local;
pub mod nearest;
pub mod planck;
pub mod probability;

pub use extended::{Extended, PRECISION};
