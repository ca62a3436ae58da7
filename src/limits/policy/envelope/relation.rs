//! What ties the factors of sources together: Σ aᵢxᵢ + b ≤ 0, or = 0, x the factors v and w of all sources.
//!
//! With c₀ = G the alternative's gain and c = (G, G·V₁′, …, G·V_K′) its factors, all that the alternative may be is linear in c:
//!
//! | | |
//! |---|---|
//! | sum of the lighting | Σ cₖ ≤ c₀ ΣV_most, or = c₀ ΣV where the total is known |
//! | each factor | l₀c₀ ≤ cₖ ≤ l₁c₀ |
//! | lighting known | cₖ = c₀Vₖ, V of the scene: a product where the gain is unknown |
//!
//! A product w = vc on a box is replaced by what is linear and holds on all of it (McCormick, Math. Program. 10, 147 (1976)):
//! (v − v_low)(c − c_low) ≥ 0 and the like of its four corners. It is exact where v or c is a point.

use super::linear::COLUMNS;

/// By what share of its terms a relation may be broken by the rounding of the user's own numbers.
pub(super) const ROUNDING: f64 = 1e-12;

/// Σ aᵢxᵢ + b ≤ 0, or = 0.
#[derive(Debug, Clone, Copy)]
pub(super) struct Relation {
    pub(super) share: [f64; COLUMNS],
    pub(super) constant: f64,
    pub(super) equal: bool,
}

/// w = v·c, columns of factors.
#[derive(Debug, Clone, Copy)]
pub(super) struct Product {
    pub(super) value: usize,
    pub(super) factors: [usize; 2],
}

impl Relation {
    pub(super) fn new(terms: &[(usize, f64)], constant: f64, equal: bool) -> Self {
        let mut share = [0.0; COLUMNS];
        terms.iter().for_each(|&(column, a)| share[column] += a);
        Self { share, constant, equal }
    }

    fn terms(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.share.iter().copied().enumerate().filter(|(_, a)| *a != 0.0)
    }

    /// By how much all of its terms may be off.
    pub(super) fn tolerance(&self, ranges: &[[f64; 2]; COLUMNS]) -> f64 {
        let size: f64 = self.terms().map(|(i, a)| a.abs() * ranges[i][1]).sum();
        ROUNDING * (size + self.constant.abs())
    }

    /// Its least and its largest value on a box.
    fn reach(&self, ranges: &[[f64; 2]; COLUMNS]) -> [f64; 2] {
        let end = |upper: bool| {
            let terms = self.terms().map(|(i, a)| a * ranges[i][usize::from((a > 0.0) == upper)]);
            self.constant + terms.sum::<f64>()
        };
        [end(false), end(true)]
    }

    /// Whether it may be broken on a box.
    pub(super) fn binds(&self, ranges: &[[f64; 2]; COLUMNS]) -> bool {
        let [least, most] = self.reach(ranges);
        let tolerance = self.tolerance(ranges);
        most > tolerance || (self.equal && least < -tolerance)
    }

    /// Its value at a point.
    pub(super) fn at(&self, point: &[f64; COLUMNS]) -> f64 {
        self.constant + self.terms().map(|(i, a)| a * point[i]).sum::<f64>()
    }

    /// Whether it is broken at a point by more than rounding.
    pub(super) fn is_broken(&self, point: &[f64; COLUMNS]) -> bool {
        let value = self.at(point);
        let size: f64 = self.terms().map(|(i, a)| (a * point[i]).abs()).sum();
        let tolerance = ROUNDING * (size + self.constant.abs());
        value > tolerance || (self.equal && value < -tolerance)
    }

    /// Scales the terms that add to it until it holds.
    pub(super) fn project(&self, point: &mut [f64]) {
        let (mut adds, mut rest) = (0.0, self.constant);
        for (i, a) in self.terms() {
            let term = a * point[i];
            if a > 0.0 { adds += term } else { rest += term }
        }
        if adds > 0.0 && (adds + rest > 0.0 || self.equal) {
            let scale = (-rest / adds).max(0.0);
            self.terms().filter(|(_, a)| *a > 0.0).for_each(|(i, _)| point[i] *= scale);
        }
    }

    /// Takes off a box what the relation excludes at its ends. `false` where that leaves nothing.
    pub(super) fn tighten(&self, ranges: &mut [[f64; 2]; COLUMNS]) -> bool {
        let tolerance = self.tolerance(ranges);
        for sign in [1.0, -1.0] {
            if sign < 0.0 && !self.equal {
                break;
            }
            let least = |ranges: &[[f64; 2]; COLUMNS], i: usize, a: f64| {
                if a > 0.0 { a * ranges[i][0] } else { a * ranges[i][1] }
            };
            let all: f64 =
                sign * self.constant + self.terms().map(|(i, a)| least(ranges, i, sign * a)).sum::<f64>();
            if all > tolerance {
                return false;
            }
            for (i, a) in self.terms() {
                let a = sign * a;
                // What is left for this term when the others are at their least.
                let room = (tolerance - all).max(0.0) / a.abs();
                let [low, high] = ranges[i];
                if a > 0.0 && low + room < high {
                    ranges[i][1] = low + room;
                } else if a < 0.0 && high - room > low {
                    ranges[i][0] = high - room;
                }
            }
        }
        true
    }
}

impl Product {
    /// w = vc to first order about a point.
    pub(super) fn tangent(&self, point: &[f64; COLUMNS]) -> Relation {
        let Self { value, factors: [v, c] } = *self;
        Relation::new(&[(value, 1.0), (v, -point[c]), (c, -point[v])], point[v] * point[c], true)
    }

    /// What is linear and holds on a box.
    pub(super) fn relations(&self, ranges: &[[f64; 2]; COLUMNS]) -> [Relation; 4] {
        let Self { value, factors: [v, c] } = *self;
        let [[v0, v1], [c0, c1]] = [ranges[v], ranges[c]];
        let corner = |v_end: f64, c_end: f64, sign: f64| {
            let terms = [(c, sign * v_end), (v, sign * c_end), (value, -sign)];
            Relation::new(&terms, -sign * v_end * c_end, false)
        };
        [corner(v0, c0, 1.0), corner(v1, c1, 1.0), corner(v1, c0, -1.0), corner(v0, c1, -1.0)]
    }

    /// Takes off a box what the product excludes at its ends. `false` where that leaves nothing.
    pub(super) fn tighten(&self, ranges: &mut [[f64; 2]; COLUMNS]) -> bool {
        let Self { value, factors: [v, c] } = *self;
        let wider = [1.0 - ROUNDING, 1.0 + ROUNDING];
        let mut keep = |i: usize, within: [f64; 2]| {
            let [low, high] = [within[0] * wider[0], within[1] * wider[1]];
            ranges[i] = [ranges[i][0].max(low), ranges[i][1].min(high)];
            let fits = ranges[i][0] <= ranges[i][1];
            if fits { Some(ranges[i]) } else { None }
        };
        let everything = [0.0, f64::INFINITY];
        let over = |[low, high]: [f64; 2], [from, to]: [f64; 2]| {
            [if to > 0.0 { low / to } else { 0.0 }, if from > 0.0 { high / from } else { f64::INFINITY }]
        };
        let (Some(of_v), Some(of_c)) = (keep(v, everything), keep(c, everything)) else { return false };
        let Some(of_w) = keep(value, [of_v[0] * of_c[0], of_v[1] * of_c[1]]) else { return false };
        let Some(of_v) = keep(v, over(of_w, of_c)) else { return false };
        keep(c, over(of_w, of_v)).is_some()
    }
}
