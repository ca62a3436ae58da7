//! Random numbers of one case: over many orders of magnitude, and at the last bits.

use hadar_simulate::draws::generator;
use rand::RngExt;
use rand::rngs::ChaCha8Rng;

/// The random numbers of one case.
#[derive(Debug)]
pub(in crate::accuracy) struct Draw(ChaCha8Rng);

impl Draw {
    pub(in crate::accuracy) fn new(seed: u64, case: u64) -> Self {
        Self(generator(seed, case))
    }

    /// Evenly in [0, 1).
    pub(in crate::accuracy) fn unit(&mut self) -> f64 {
        self.0.random_range(0.0..1.0)
    }

    pub(in crate::accuracy) fn chance(&mut self, probability: f64) -> bool {
        self.unit() < probability
    }

    /// Evenly between two numbers.
    pub(in crate::accuracy) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Evenly in the logarithm.
    pub(in crate::accuracy) fn scale(&mut self, low: f64, high: f64) -> f64 {
        (low.ln() + (high.ln() - low.ln()) * self.unit()).exp().clamp(low, high)
    }

    /// One of 0 … count − 1.
    pub(in crate::accuracy) fn below(&mut self, count: usize) -> usize {
        self.0.random_range(0..count.max(1))
    }

    /// A value beside another: equal, some last bits away, or a share of 10⁻¹⁶ to 0.3 of it.
    pub(in crate::accuracy) fn beside(&mut self, value: f64) -> f64 {
        match self.below(4) {
            0 => value,
            1 => self.some_bits_from(value),
            _ => {
                let share = self.scale(1e-16, 0.3);
                value * if self.chance(0.5) { 1.0 + share } else { 1.0 - share }
            }
        }
    }

    /// One to four last bits up or down of a positive number.
    pub(in crate::accuracy) fn some_bits_from(&mut self, value: f64) -> f64 {
        let bits = 1 + self.below(4) as u64;
        f64::from_bits(if self.chance(0.5) { value.to_bits() + bits } else { value.to_bits() - bits })
    }
}
