//! The two expectations that every route computes.

/// E[e^{−sΛ}; Λ > 0] and E[e^{(1−s)Λ}; Λ < 0] under the tilted law, ties by halves.
#[derive(Debug, Clone, Copy)]
pub(super) struct Integrals {
    pub(super) first: f64,
    pub(super) second: f64,
    /// C(s).
    pub(super) exponent: f64,
    /// Estimated error of the sum, and of either.
    pub(super) numerical: f64,
    pub(super) numerical_class: f64,
}

impl Integrals {
    /// Estimated error of the sum, relative to it.
    pub(super) fn relative(&self) -> f64 {
        self.numerical / (self.first + self.second)
    }
}
