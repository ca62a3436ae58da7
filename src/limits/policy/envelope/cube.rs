//! A box of a cell, and the point of its linear model that is nearest to the origin.
//!
//! Δ ≈ Δ_c + Ax, |x_i| ≤ 1 (`bound`), with a row of great weight for every relation of the factors that x would break.

use super::linear::{COLUMNS, Gram, Limit, SOURCES, Vector};
use super::relation::Relation;

/// How much more a broken relation of factors weighs than what they do.
const STIFF: f64 = 30.0;
/// By what share of its terms a relation is broken so that it counts.
const BROKEN: f64 = 1e-9;
/// How often broken relations are looked for.
const ROUNDS: usize = 4;
/// How much less the factor of a cone counts than its temperature, squared.
const SHARE_OF_FACTOR: f64 = 1e-2;

/// Part of a cell: an interval of each temperature, and ranges of the factors.
#[derive(Debug, Clone)]
pub(super) struct Cube {
    pub(super) cell: u32,
    pub(super) nodes: [u32; SOURCES],
    /// Ranges of v and w, each in its column: 3s + 1 and 3s + 2.
    pub(super) factors: [[f64; 2]; COLUMNS],
    /// Proved: no distance in it is below.
    pub(super) bound: f64,
    /// Along what it is best split: 3s for temperature s, 3s + 1 for v, 3s + 2 for w; `None` if it cannot be.
    pub(super) split: Option<usize>,
}

#[inline(always)]
pub(super) fn dot(a: &Vector, b: &Vector) -> f64 {
    let mut lanes = [0.0; 4];
    for (a, b) in a.chunks_exact(4).zip(b.chunks_exact(4)) {
        for i in 0..4 {
            lanes[i] += a[i] * b[i];
        }
    }
    (lanes[0] + lanes[1]) + (lanes[2] + lanes[3])
}

#[inline(always)]
pub(super) fn add(to: &mut Vector, factor: f64, column: &Vector) {
    for (to, x) in to.iter_mut().zip(column) {
        *to += factor * x;
    }
}

pub(super) fn centre([low, high]: [f64; 2]) -> (f64, f64) {
    (0.5 * (low + high), 0.5 * (high - low))
}

/// Δ_c + Ax, |x_i| ≤ 1: a column of A for T, v and w of each source.
pub(super) struct Linear {
    pub(super) middle: Vector,
    pub(super) columns: [Vector; COLUMNS],
    /// Columns that count, the first ones.
    pub(super) count: usize,
    /// Sources whose columns are three spectra of a cone instead.
    pub(super) cones: [bool; SOURCES],
}

impl Cube {
    pub(super) fn own(&self, s: usize) -> [f64; 2] {
        self.factors[3 * s + 1]
    }

    pub(super) fn other(&self, s: usize) -> [f64; 2] {
        self.factors[3 * s + 2]
    }
}

impl Linear {
    #[inline(always)]
    pub(super) fn at(&self, x: &[f64; COLUMNS]) -> Vector {
        let mut point = self.middle;
        for (x, column) in x.iter().zip(&self.columns).take(self.count) {
            add(&mut point, *x, column);
        }
        point
    }

    /// Half the derivatives of the square at x, where the point is, and the square, limits and all.
    pub(super) fn slopes(
        &self,
        point: &Vector,
        x: &[f64; COLUMNS],
        limits: &[Limit],
    ) -> ([f64; COLUMNS], f64) {
        let (mut slopes, mut square) = ([0.0; COLUMNS], dot(point, point));
        for (slope, column) in slopes.iter_mut().zip(&self.columns).take(self.count) {
            *slope = dot(column, point);
        }
        for limit in limits {
            let value = limit.middle + limit.row.iter().zip(x).map(|(row, x)| row * x).sum::<f64>();
            slopes.iter_mut().zip(&limit.row).for_each(|(slope, row)| *slope += value * row);
            square += value * value;
        }
        (slopes, square)
    }

    /// How far a range reaches, squared.
    pub(super) fn extent(&self, gram: &Gram, i: usize) -> f64 {
        if !self.cones[i / 3] {
            return gram.size(i);
        }
        let [first, .., last] = [0, 1, 2].map(|j| &self.columns[3 * (i / 3) + j]);
        match i % 3 {
            0 => first.iter().zip(last).map(|(a, b)| (a - b) * (a - b)).sum(),
            _ => SHARE_OF_FACTOR * gram.size(i),
        }
    }

    /// A relation as a row: what it is for x = 0, its coefficients, its size, and a stiffness.
    fn row(&self, relation: &Relation, cube: &Cube) -> ([f64; COLUMNS], f64, f64, f64) {
        let (mut row, mut middle, mut stiff, mut size) =
            ([0.0; COLUMNS], relation.constant, 0.0f64, relation.constant.abs());
        for (i, share) in relation.share.iter().enumerate().filter(|(_, share)| **share != 0.0) {
            let [low, high] = cube.factors[i];
            size += share.abs() * high;
            let (value, half, columns) = if self.cones[i / 3] {
                (1.5 * high, 0.5 * high, i - 1..i + 2)
            } else {
                (0.5 * (low + high), 0.5 * (high - low), i..i + 1)
            };
            middle += share * value;
            if half > 0.0 {
                let column = &self.columns[i];
                stiff = stiff.max(STIFF * dot(column, column).sqrt() / (share.abs() * half));
            }
            columns.for_each(|i| row[i] = share * half);
        }
        (row, middle, size, stiff)
    }

    /// Its normal equations, with a row more for each limit.
    #[inline(always)]
    fn gram(&self, limits: &[Limit]) -> Gram {
        let Self { middle, columns, count, .. } = self;
        Gram::new(
            *count,
            dot(middle, middle) + limits.iter().map(|l| l.middle * l.middle).sum::<f64>(),
            |i, j| dot(&columns[i], &columns[j]) + limits.iter().map(|l| l.row[i] * l.row[j]).sum::<f64>(),
            |i| dot(&columns[i], middle) + limits.iter().map(|l| l.row[i] * l.middle).sum::<f64>(),
        )
    }
}

/// Where a linear model is nearest to the origin.
pub(super) struct Nearest {
    pub(super) gram: Gram,
    pub(super) x: [f64; COLUMNS],
    pub(super) limits: Vec<Limit>,
}

/// The x that brings the linear model nearest to the origin, within what relates the factors.
#[inline(always)]
pub(super) fn nearest(relations: &[Relation], cube: &Cube, linear: &Linear) -> Nearest {
    let mut limits = Vec::new();
    for _ in 0..ROUNDS {
        let gram = linear.gram(&limits);
        let x = gram.nearest();
        if !add_broken(relations, cube, &x, linear, &mut limits) {
            return Nearest { gram, x, limits };
        }
    }
    let gram = linear.gram(&limits);
    Nearest { x: gram.nearest(), gram, limits }
}

/// Adds a row for every relation that the point x breaks; whether any is new.
fn add_broken(
    relations: &[Relation],
    cube: &Cube,
    x: &[f64; COLUMNS],
    linear: &Linear,
    limits: &mut Vec<Limit>,
) -> bool {
    let before = limits.len();
    for (index, relation) in relations.iter().enumerate() {
        if limits[..before].iter().any(|limit| limit.relation == index) {
            continue;
        }
        let (row, middle, size, stiff) = linear.row(relation, cube);
        let at = middle + row.iter().zip(x).map(|(row, x)| row * x).sum::<f64>();
        let broken = at > BROKEN * size || (relation.equal && at < -BROKEN * size);
        if broken && stiff > 0.0 {
            let row = row.map(|x| stiff * x);
            limits.push(Limit { relation: index, row, middle: stiff * middle, stiffness: stiff });
        }
    }
    limits.len() > before
}
