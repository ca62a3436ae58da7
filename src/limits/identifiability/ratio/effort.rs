//! How much is spent on one law of Λ.

/// Relative numerical error with which an integral is good enough.
pub(super) const SETTLED: f64 = 1e-9;

/// How much is spent on one law.
#[derive(Debug, Clone, Copy)]
pub(super) struct Effort {
    /// Most combinations of the counts of all bands but one that a sum goes through, and most counts of that one.
    pub(super) combinations: usize,
    pub(super) table: usize,
    /// Most bands times points of the finest rule of an integral.
    pub(super) points: usize,
    /// Relative numerical error with which an integral is good enough.
    pub(super) settled: f64,
    /// Points of the finer lattice.
    pub(super) lattice: usize,
}

/// As much as is needed.
pub(super) const WHOLE: Effort = Effort {
    combinations: 1_000_000,
    table: 4_000_000,
    points: usize::MAX,
    settled: SETTLED,
    lattice: 1 << 18,
};
/// Some milliseconds.
pub(super) const QUICK: Effort =
    Effort { combinations: 20_000, table: 40_000, points: 200_000, settled: 1e-5, lattice: 1 << 14 };
