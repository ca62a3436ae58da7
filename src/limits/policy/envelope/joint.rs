//! Descent over a scene and the alternative's state together, where all of it can be written as sources (`model`).
//!
//! With p all temperatures, v and w, and r(p) = √(N+v) − √(N′+v) band by band, d² = ‖r(p)‖² is a nonlinear least-squares
//! problem. Each step is Gauss's within a box about p,
//!
//! min over |xᵢ| ≤ 1 of ‖r(p + m) + Σᵢ xᵢ hᵢ ∂r/∂pᵢ‖,   r(p + m) ≈ r(p) + Σᵢ mᵢ ∂r/∂pᵢ,
//!
//! m the middle of the box less p and h its half widths: the bounded linear problem that a bound has too (`linear`). The
//! box doubles where the step gains and shrinks to a quarter where it does not (a trust region that the ranges cut
//! off). Unlike a descent over scenes alone it follows narrow valleys that run across scene and state.

use super::linear::{COLUMNS, Gram, SOURCES};
use super::model::{Model, Point, Region};
use super::relation::Relation;
use crate::planck;
use crate::sum::dot;

/// Steps at most.
const STEPS: usize = 80;
/// First size of the box: share of a range, and in K and of the temperature at most.
const FIRST: f64 = 0.25;
const FIRST_K: f64 = 10.0;
const FIRST_SHARE: f64 = 0.03;
/// Size of the box relative to the first at which a descent ends, and the relative gain that is none.
const LAST: f64 = 1e-7;
const NO_GAIN: f64 = 1e-9;

/// How much more a broken relation of factors weighs than what they do.
const STIFF: f64 = 30.0;

/// Counts and residual of a point, and its derivatives.
pub(super) struct Residual {
    pub(super) target: Vec<f64>,
    pub(super) alternative: Vec<f64>,
    pub(super) square: f64,
    pub(super) rows: Vec<f64>,
    columns: Vec<Vec<f64>>,
}

/// Where a descent from `point` ends, with the distance there.
pub(super) fn descend(model: &Model<'_>, whole: &Region, mut point: Point) -> (Point, f64) {
    let ranges: Vec<[f64; 2]> =
        whole.iter().take(SOURCES).flat_map(|span| [span.t, span.own, span.other]).collect();
    for (value, [low, high]) in point.values.as_flattened_mut().iter_mut().zip(&ranges) {
        *value = value.clamp(*low, *high);
    }
    model.project(&mut point);
    let mut at = residual(model, &point);
    let mut size = 1.0;
    for _ in 0..STEPS {
        if !(size > LAST && at.square > 0.0) {
            break;
        }
        let next = step(model, &ranges, &point, &at, size);
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

/// The best point of the linear model in a box of `size` times the first.
fn step(model: &Model<'_>, ranges: &[[f64; 2]], point: &Point, at: &Residual, size: f64) -> Point {
    crate::stop::check();
    let gain = model.gain.map_or(1.0, |column| point.values.as_flattened()[column]);
    let mut linear = Linear::new(ranges, point, at, size, gain);
    let next = linear.best(ranges, point);
    if !model.is_related() {
        return next;
    }
    let relations = model.relations_at(point);
    let broken = relations.iter().filter(|relation| relation.is_broken(&next.factors()));
    for relation in broken {
        linear.limit(point, relation);
    }
    let mut next = linear.best(ranges, point);
    model.project(&mut next);
    next
}

/// The residual in a box about a point: rows + Σ xᵢ columnᵢ, |xᵢ| ≤ 1.
struct Linear {
    /// Of the box less the point, and half its widths.
    middle: [f64; COLUMNS],
    half: [f64; COLUMNS],
    rows: Vec<f64>,
    columns: Vec<Vec<f64>>,
}

impl Linear {
    fn new(ranges: &[[f64; 2]], point: &Point, at: &Residual, size: f64, gain: f64) -> Self {
        let (mut middle, mut half) = ([0.0; COLUMNS], [0.0; COLUMNS]);
        for (i, (now, [low, high])) in point.values.as_flattened().iter().zip(ranges).enumerate() {
            let share = FIRST * (high - low);
            let most = if i % 3 == 0 { FIRST_K.max(FIRST_SHARE * now) } else { FIRST * gain.max(1.0) };
            let width = share.min(most);
            let [from, to] = [(now - size * width).max(*low), (now + size * width).min(*high)];
            (middle[i], half[i]) = (0.5 * (from + to) - now, 0.5 * (to - from));
        }
        let (mut rows, mut columns) = (at.rows.clone(), at.columns.clone());
        for (i, column) in columns.iter_mut().enumerate() {
            for (row, x) in rows.iter_mut().zip(column.iter_mut()) {
                *row += middle[i] * *x;
                *x *= half[i];
            }
        }
        Self { middle, half, rows, columns }
    }

    /// Adds a row of great weight for a relation that is not to be broken.
    fn limit(&mut self, point: &Point, relation: &Relation) {
        let tied = || relation.share.iter().copied().enumerate().take(self.columns.len());
        let stiff = tied()
            .filter(|&(i, share)| share != 0.0 && self.half[i] > 0.0)
            .map(|(i, share)| {
                STIFF * dot(&self.columns[i], &self.columns[i]).sqrt() / (share.abs() * self.half[i])
            })
            .fold(0.0, f64::max);
        let mut middle = point.factors();
        middle.iter_mut().zip(&self.middle).for_each(|(value, m)| *value += m);
        self.rows.push(stiff * relation.at(&middle));
        for (column, (i, share)) in self.columns.iter_mut().zip(relation.share.iter().enumerate()) {
            column.push(stiff * share * self.half[i]);
        }
    }

    /// The point of the box where the linear model is nearest to the origin.
    fn best(&self, ranges: &[[f64; 2]], point: &Point) -> Point {
        let Self { middle, half, rows, columns } = self;
        let gram = Gram::new(
            columns.len(),
            dot(rows, rows),
            |i, j| dot(&columns[i], &columns[j]),
            |i| dot(&columns[i], rows),
        );
        let x = gram.nearest();
        let mut next = *point;
        for (i, (value, [low, high])) in next.values.as_flattened_mut().iter_mut().zip(ranges).enumerate() {
            *value = (*value + middle[i] + half[i] * x[i]).clamp(*low, *high);
        }
        next
    }
}

/// Counts, residual and derivatives at a point.
pub(super) fn residual(model: &Model<'_>, point: &Point) -> Residual {
    crate::stop::check();
    let bands = model.var.len();
    let (mut target, mut alternative, mut apart) = (vec![0.0; bands], vec![0.0; bands], vec![0.0; bands]);
    // Derivatives of N and of N′.
    let mut slopes: Vec<[Vec<f64>; 2]> = Vec::new();
    let nodes = model.scene.bands.nodes_cm1();
    let (mut value, mut slope) = (vec![0.0; nodes.len()], vec![0.0; nodes.len()]);
    for (source, [t, v, w]) in model.sources.iter().zip(point.values) {
        planck::photon_radiance_and_slope_into(nodes, t, &mut value, &mut slope);
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
