//! Intervals of the temperature of a source with what is known of it there.
//!
//! A narrow interval T ± ΔT has Qᵀωf and Qᵀωg as cubics in T with remainders (`series`). A wide one, which only
//! the alternative's own temperatures have, is there to be halved. One in which a source is next to nothing, whatever its
//! factor, keeps no more than its norm.

use super::linear::{PAIRS, Vector};
use super::series::TERMS;

/// Radii of the discs of Cauchy's estimate, as shares of the lowest temperature.
pub(super) const RADII: [f64; 5] = [0.2, 0.4, 0.6, 0.8, 0.95];
/// Intervals are not halved below this share of their temperature.
const NARROWEST: f64 = 1e-9;

pub(super) type Cubic = [Vector; TERMS];
pub(super) type Spread = Option<Box<[f64; PAIRS]>>;

/// How well the interval of a source is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Detail {
    Wide,
    Cubic,
    Faint,
}

/// Norms of f and g at the upper end of an interval and at the reach of each disc about it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reach {
    pub(super) lowest_k: f64,
    pub(super) size: [f64; 2],
    /// Norms of what f and g may be off the parabola along a stretch of distances, at the upper end.
    pub(super) sag: [f64; 2],
    pub(super) discs: [[f64; 2]; RADII.len()],
}

/// An interval of the temperature of a source.
#[derive(Debug, Clone)]
pub(super) struct Node {
    pub(super) t: [f64; 2],
    pub(super) detail: Detail,
    /// Qᵀω f and Qᵀω g as cubics, of the middle of a stretch of distances, and the norms of what these leave.
    pub(super) own: Cubic,
    pub(super) other: Cubic,
    /// h and β of a stretch, of f and g.
    pub(super) along: Option<Box<[[Cubic; 2]; 2]>>,
    pub(super) own_rest: f64,
    pub(super) other_rest: f64,
    /// Shares of v and w in M at the upper end, where they have any.
    pub(super) own_spread: Spread,
    pub(super) other_spread: Spread,
    /// Largest v and w of the alternative's that leave room for a distance below the one attained.
    pub(super) most: [f64; 2],
    pub(super) reach: Reach,
    /// Place of the first of two halves.
    pub(super) halves: Option<u32>,
}

impl Node {
    pub(super) fn divisible(&self) -> bool {
        let [low, high] = self.t;
        self.detail != Detail::Faint && high - low > NARROWEST * high
    }
}
