//! Descent over a scene and the alternative's state together, where all of it can be written as sources (`model`).
//!
//! d² = ‖√(N+v) − √(N′+v)‖² is a nonlinear least-squares problem in all temperatures, v and w at once. Gauss's step is
//! taken within a box that grows with success and shrinks without (a trust region that the ranges cut off), which is the
//! same bounded linear problem as that of a bound. Unlike a descent over scenes alone it follows narrow valleys
//! that run across scene and state.

use super::linear::{COLUMNS, Gram};
use super::model::{Model, Point, Region, SOURCES};
use super::series::planck_series;
use crate::sum::dot;

/// Steps at most.
const STEPS: usize = 80;
/// First size of the box: share of a range, and in K at most.
const FIRST: f64 = 0.25;
const FIRST_K: f64 = 10.0;
/// Size of the box relative to the first at which a descent ends, and the relative gain that is none.
const LAST: f64 = 1e-7;
const NO_GAIN: f64 = 1e-9;

/// How much more a broken sum of factors weighs than what they do.
const STIFF: f64 = 30.0;

/// Counts and residual of a point, and its derivatives.
pub(super) struct Residual {
    pub(super) target: Vec<f64>,
    pub(super) alternative: Vec<f64>,
    pub(super) square: f64,
    rows: Vec<f64>,
    columns: Vec<Vec<f64>>,
}

/// Where a descent from `point` ends, with the distance there.
pub(super) fn descend(model: &Model<'_>, whole: &Region, mut point: Point) -> (Point, f64) {
    let range = |i: usize| {
        let span = &whole[i / 3];
        [span.t, span.own, span.other][i % 3]
    };
    let count = 3 * whole.len().min(SOURCES);
    for i in 0..count {
        let [low, high] = range(i);
        point.values[i / 3][i % 3] = point.values[i / 3][i % 3].clamp(low, high);
    }
    model.scale(&mut point);
    let mut at = residual(model, &point);
    let mut size = 1.0;
    for _ in 0..STEPS {
        if !(size > LAST && at.square > 0.0) {
            break;
        }
        // The box: its middle and half widths.
        let (mut middle, mut half) = ([0.0; COLUMNS], [0.0; COLUMNS]);
        for i in 0..count {
            let [low, high] = range(i);
            let mut width = FIRST * (high - low);
            if i % 3 == 0 {
                width = width.min(FIRST_K);
            }
            let now = point.values[i / 3][i % 3];
            let [from, to] = [(now - size * width).max(low), (now + size * width).min(high)];
            (middle[i], half[i]) = (0.5 * (from + to) - now, 0.5 * (to - from));
        }
        let mut rows = at.rows.clone();
        let mut scaled = at.columns.clone();
        for (i, column) in scaled.iter_mut().enumerate() {
            for (row, x) in rows.iter_mut().zip(column.iter_mut()) {
                *row += middle[i] * *x;
                *x *= half[i];
            }
        }
        let solve = |rows: &[f64], scaled: &[Vec<f64>]| {
            let gram = Gram::new(
                count,
                dot(rows, rows),
                |i, j| dot(&scaled[i], &scaled[j]),
                |i| dot(&scaled[i], rows),
            );
            let x = gram.nearest();
            let mut next = point;
            for i in 0..count {
                let [low, high] = range(i);
                let value = &mut next.values[i / 3][i % 3];
                *value = (*value + middle[i] + half[i] * x[i]).clamp(low, high);
            }
            next
        };
        let mut next = solve(&rows, &scaled);
        if model.limited && model.excesses(&next) != [false; 2] {
            // A sum that is broken becomes one more row, of great weight.
            for (which, _) in model.excesses(&next).iter().enumerate().filter(|(_, broken)| **broken) {
                let lit = |i: usize| i % 3 == which + 1 && model.sources[i / 3].object;
                let stiff = (0..count)
                    .filter(|&i| lit(i) && half[i] > 0.0)
                    .map(|i| STIFF * dot(&scaled[i], &scaled[i]).sqrt() / half[i])
                    .fold(0.0, f64::max);
                let sum: f64 =
                    (0..count).filter(|&i| lit(i)).map(|i| point.values[i / 3][i % 3] + middle[i]).sum();
                rows.push(stiff * (sum - model.sums[which]));
                for (i, column) in scaled.iter_mut().enumerate() {
                    column.push(if lit(i) { stiff * half[i] } else { 0.0 });
                }
            }
            next = solve(&rows, &scaled);
            model.scale(&mut next);
        }
        let moved = residual(model, &next);
        if moved.square < at.square {
            let gain = 1.0 - moved.square / at.square;
            (point, at) = (next, moved);
            size = (2.0 * size).min(4.0);
            if gain < NO_GAIN {
                break;
            }
        } else {
            size *= 0.25;
        }
    }
    (point, at.square.sqrt())
}

pub(super) fn residual(model: &Model<'_>, point: &Point) -> Residual {
    let bands = model.var.len();
    let (mut target, mut alternative, mut apart) = (vec![0.0; bands], vec![0.0; bands], vec![0.0; bands]);
    // Derivatives of N and of N′.
    let mut slopes: Vec<[Vec<f64>; 2]> = Vec::new();
    let nodes = model.scene.bands.nodes_cm1();
    for (source, [t, v, w]) in model.sources.iter().zip(point.values) {
        let [value, slope, ..] = planck_series(nodes, t, 1.0);
        let [seen, known, alone] = [&source.target, &source.alternative, &source.alone]
            .map(|strength| model.counts(strength, &value));
        let [own, other] = [&source.own, &source.other].map(|strength| model.counts(strength, &value));
        let [steep, steep_known, steep_alone] = [&source.target, &source.alternative, &source.alone]
            .map(|strength| model.counts(strength, &slope));
        for band in 0..bands {
            target[band] += v * seen[band];
            alternative[band] += v * known[band] + w * alone[band];
            apart[band] += v * own[band] + w * other[band];
        }
        let along_t = [
            steep.iter().map(|x| v * x).collect(),
            steep_known.iter().zip(&steep_alone).map(|(a, b)| v * a + w * b).collect(),
        ];
        slopes.extend([along_t, [seen, known], [vec![0.0; bands], alone]]);
    }
    let root = |counts: &[f64]| -> Vec<f64> {
        counts.iter().zip(&model.var).map(|(n, v)| (n.max(0.0) + v).sqrt()).collect()
    };
    let (root, other_root) = (root(&target), root(&alternative));
    let safe = |x: f64| if x > 0.0 { 1.0 / x } else { 0.0 };
    let rows: Vec<f64> = (0..bands).map(|band| apart[band] * safe(root[band] + other_root[band])).collect();
    let columns = slopes.iter().map(|[own, other]| {
        (0..bands)
            .map(|band| 0.5 * (own[band] * safe(root[band]) - other[band] * safe(other_root[band])))
            .collect()
    });
    Residual { square: dot(&rows, &rows), columns: columns.collect(), rows, target, alternative }
}
