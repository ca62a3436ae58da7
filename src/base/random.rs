//! The generator of random numbers: a named one, so that a seed gives the same numbers on every machine and in every version.
//!
//! Source: Bernstein, 'ChaCha, a variant of Salsa20' (2008).

use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;

/// What random numbers are made with; the seed then says which ones. A test holds the first draws fast.
pub const GENERATOR: &str =
    "ChaCha8 (rand 0.10, seed_from_u64, a stream per spectrum or block of trials), rand_distr 0.6.0";

/// The generator of one spectrum or one block of trials.
#[must_use]
pub fn generator(seed: u64, stream: u64) -> ChaCha8Rng {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(stream);
    rng
}
