//! A lower bound of the distance in a box of all sources' temperatures and factors.
//!
//! With Δ = Qᵀω(N − N′) and the matrix M of the variances (see `cell`), for any direction u of length 1, n = min over
//! the box of u·Δ and A = ½√(uᵀMu),
//!
//! d ≥ n/(A + √(A² + hn)) or n/2A,   min u·Δ = Σ_s min over (T, v, w) of u·[v f(T) + w g(T)].
//!
//! 1. Linear model (`linear`): Δ ≈ Δ_c + Ax, |x_i| ≤ 1, Δ_c its value at the centre and A its derivatives times the half
//!    widths, in coordinates in which M is the unit matrix.
//! 2. Its point nearest to the origin (`nearest`) gives the direction, u ∝ Δ_c + Ax. A linear model loses nothing by
//!    that choice (duality of the nearest point of a convex set); so the bound misses the least distance in the box by
//!    its second derivatives alone. How well the nearest point is solved for matters for tightness alone.
//!    A source of the alternative's own that may be next to nothing, v f(T) with 0 ≤ v ≤ v_high, is no parallelogram but
//!    a cone: there the columns are the three spectra whose mixtures make up all that a parabola in T passes through.
//! 3. For this one u, source by source (`least`): u·Δ is linear in v and w, so that only the four corners of their
//!    ranges matter, and on each of them a parabola in T minimised on its interval, less the cubic term and the
//!    remainder.
//! 4. Split is along what bends u·Δ, moves it, or changes the variance most. What has a wide interval of temperature is
//!    halved there first.
//!
//! Where factors are tied by a relation r ≤ 0 (`relation`), λr ≤ 0 may be added for any λ ≥ 0 (prices of v and w), and for r = 0
//! for any λ at all; λ is the multiplier that the linear model has, found with r as one more row of great weight.

use super::cell::{Cell, Weighing};
use super::cube::{Cube, Linear, Nearest, add, centre, dot, nearest};
use super::linear::{COLUMNS, Factor, PAIRS, RANK, SOURCES, Vector};
use super::model::Model;
use super::node::{Detail, Node};

/// About how fast Planck's function grows with temperature, both relative.
const GROWTH: f64 = 5.0;
/// Share of the least distance known below which the linear model is taken to reach the origin.
const REACHED: f64 = 1e-4;
/// Share of a square below which what is left of it has lost too many digits.
const CANCELLED: f64 = 1e-9;

/// Rounding of uᵀMu, as a share of the trace of M.
const SPREAD_ROUNDING: f64 = 64.0 * RANK as f64 * f64::EPSILON;
/// A source whose factor may be this much smaller than it can be at most is taken for a cone.
const CONE: f64 = 0.5;
/// Width of a temperature, as a share of it, below which the three spectra of a cone are one.
const NARROW: f64 = 1e-2;

/// Corners of what counts may be along a stretch of distances, as shares of h and β: those of both ends and of the middle. The
/// corner of a single distance comes first: h and β are 0.
const CORNERS: [[f64; 2]; 3] = [[-1.0, -1.0], [1.0, -1.0], [0.0, 1.0]];

/// Least a + bt + ct² on |t| ≤ 1.
#[inline(always)]
fn least_parabola(a: f64, b: f64, c: f64) -> f64 {
    if 2.0 * c > b.abs() { a - 0.25 * b * b / c } else { a + c - b.abs() }
}

/// The sum of a matrix's diagonal, of so many components.
fn trace(matrix: &[f64; PAIRS], rank: usize) -> f64 {
    let (mut total, mut place) = (0.0, 0);
    for i in 0..rank {
        total += matrix[place];
        place += RANK - i;
    }
    total
}

/// uᵀMu.
fn along(matrix: &[f64; PAIRS], u: &Vector) -> f64 {
    let (mut total, mut place) = (0.0, 0);
    for i in 0..RANK {
        let mut line = 0.5 * matrix[place] * u[i];
        for (x, u) in matrix[place..place + RANK - i].iter().zip(&u[i..]).skip(1) {
            line += x * u;
        }
        total += 2.0 * u[i] * line;
        place += RANK - i;
    }
    total
}

impl Cell {
    pub(super) fn node_of(&self, cube: &Cube, s: usize) -> &Node {
        &self.sources[s][cube.nodes[s] as usize]
    }

    /// Takes off a cube what lies beyond the distance attained and what relations exclude. `false` where that leaves
    /// nothing.
    pub(super) fn clamp(&self, model: &Model<'_>, cube: &mut Cube) -> bool {
        let t = |s: usize| self.node_of(cube, s).t;
        if model.twins.iter().any(|&[first, second]| t(first)[0] > t(second)[1]) {
            return false;
        }
        for s in 0..self.sources.len() {
            let most = self.node_of(cube, s).most;
            for (which, most) in most.into_iter().enumerate() {
                let range = &mut cube.factors[3 * s + 1 + which];
                range[1] = range[1].min(most);
                if range[1] < range[0] {
                    return false;
                }
            }
        }
        model.tighten(&mut cube.factors)
    }

    /// Sets bound and split of a cube; the bound never falls below what it was.
    pub(super) fn bound(&self, model: &Model<'_>, cube: &mut Cube) {
        crate::stop::check();
        cube.split = self.widest(cube);
        if cube.split.is_some() {
            return;
        }
        let relations = if model.is_related() { model.relations_on(&cube.factors) } else { Vec::new() };
        let variance = self.variance_of(cube);
        let factor = Factor::new(&variance, self.rank);
        let linear = self.linear(model, cube, &factor);
        let Nearest { gram, mut x, limits } = nearest(&relations, cube, &linear);
        let mut point = linear.at(&x);
        if dot(&point, &point) < CANCELLED * dot(&linear.middle, &linear.middle) {
            let (slopes, square) = linear.slopes(&point, &x, &limits);
            x = gram.nearest_from(x, slopes, square);
            point = linear.at(&x);
        }
        if dot(&point, &point).sqrt() <= REACHED * self.attained {
            cube.split = self.best_split(cube, |i| linear.extent(&gram, i));
            return;
        }
        factor.solve_transposed(&mut point);
        let norm = dot(&point, &point).sqrt();
        let u = point.map(|x| x / norm);
        let mut prices = [0.0; COLUMNS];
        let mut total = 0.0;
        for limit in &limits {
            let relation = &relations[limit.relation];
            let price = limit.price(&x, relation.equal) / norm;
            prices.iter_mut().zip(&relation.share).for_each(|(to, share)| *to += price * share);
            total += price * relation.constant - price.abs() * relation.tolerance(&cube.factors);
        }
        let mut weight = [0.0; COLUMNS];
        // Along a stretch of distances the least is at one of its corners.
        let corners = if model.along.is_some() { &CORNERS[..] } else { &CORNERS[..1] };
        let least = |corner: &[f64; 2]| -> f64 {
            (0..self.sources.len()).map(|s| self.least(cube, s, &u, &prices, *corner, &mut weight)).sum()
        };
        let lower = |a: f64, b: f64| if b.is_nan() || b < a { b } else { a };
        total += corners.iter().map(least).fold(f64::INFINITY, lower);
        for limit in &limits {
            // What a product may be off by in the middle of the cube.
            if let Some(factors) = model.product_of(limit.relation) {
                let gap: f64 = factors.iter().map(|&i| centre(cube.factors[i]).1).product();
                factors.iter().for_each(|&i| weight[i] += limit.price(&x, false) / norm * gap);
            }
        }
        if total > 0.0 && total.is_finite() {
            let spread = along(&variance, &u) + SPREAD_ROUNDING * trace(&variance, self.rank);
            self.weigh_variance(cube, &u, 0.5 * total / spread, &mut weight);
            // A denominator some hundred roundings too large, never too small.
            let bound = match self.weighing {
                Weighing::Both => total / (spread.sqrt() * (1.0 + 1e-13)),
                Weighing::Target { highest } => {
                    let a = 0.5 * spread.sqrt();
                    total / ((a + (a * a + highest * total).sqrt()) * (1.0 + 1e-13))
                }
            };
            // Factors were cut off for what lies beyond the distance attained.
            if spread > 0.0 && !bound.is_nan() {
                cube.bound = cube.bound.max(bound.min(self.attained));
            }
        }
        cube.split = self.best_split(cube, |i| weight[i]);
    }

    /// The widest interval of temperature, if one is too wide for a bound.
    fn widest(&self, cube: &Cube) -> Option<usize> {
        let wide = (0..self.sources.len()).filter_map(|s| {
            let node = self.node_of(cube, s);
            (node.detail == Detail::Wide).then(|| (node.t[1] / node.t[0], 3 * s))
        });
        wide.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, split)| split)
    }

    /// Δ_c and A of a cube, in coordinates in which M is the unit matrix.
    #[inline(always)]
    fn linear(&self, model: &Model<'_>, cube: &Cube, factor: &Factor) -> Linear {
        let mut count = 3 * self.sources.len();
        let (mut middle, mut columns) = ([0.0; RANK], [[0.0; RANK]; COLUMNS]);
        let mut cones = [false; SOURCES];
        for s in 0..self.sources.len() {
            let node = self.node_of(cube, s);
            let ((v, dv), (w, dw)) = (centre(cube.own(s)), centre(cube.other(s)));
            let wide = node.t[1] - node.t[0] > NARROW * node.t[1];
            if wide && model.sources[s].role.is_free() && cube.own(s)[0] < CONE * cube.own(s)[1] {
                cones[s] = true;
                // The points that span a + bt + ct² on |t| ≤ 1.
                let half = 0.5 * cube.own(s)[1];
                let span = [[1.0, -1.0, 1.0], [1.0, 0.0, -1.0], [1.0, 1.0, 1.0]];
                for (column, shares) in columns[3 * s..].iter_mut().zip(span) {
                    shares.iter().zip(&node.own).for_each(|(share, term)| add(column, half * share, term));
                    add(&mut middle, 1.0, column);
                }
                continue;
            }
            add(&mut middle, v, &node.own[0]);
            add(&mut columns[3 * s], v, &node.own[1]);
            add(&mut columns[3 * s + 1], dv, &node.own[0]);
            if cube.other(s)[1] > 0.0 {
                add(&mut middle, w, &node.other[0]);
                add(&mut columns[3 * s], w, &node.other[1]);
                add(&mut columns[3 * s + 2], dw, &node.other[0]);
            }
        }
        // Along a stretch of distances, if there is room: without it the direction is not the best one.
        if model.along.is_some() && count < COLUMNS {
            for s in 0..self.sources.len() {
                let node = self.node_of(cube, s);
                let Some(along) = &node.along else { continue };
                add(&mut columns[count], centre(cube.own(s)).0, &along[0][0][0]);
                add(&mut columns[count], centre(cube.other(s)).0, &along[0][1][0]);
            }
            count += 1;
        }
        for column in columns[..count].iter_mut().chain([&mut middle]) {
            factor.solve(column);
        }
        Linear { middle, columns, count, cones }
    }

    /// Adds what the ranges account for by the variance at their upper ends being too large within them.
    #[inline(always)]
    fn weigh_variance(&self, cube: &Cube, u: &Vector, scale: f64, weight: &mut [f64; COLUMNS]) {
        for s in 0..self.sources.len() {
            let node = self.node_of(cube, s);
            let mut seen = 0.0;
            for (which, spread) in [&node.own_spread, &node.other_spread].into_iter().enumerate() {
                let Some(spread) = spread else { continue };
                let column = 3 * s + 1 + which;
                let [low, high] = cube.factors[column];
                if high > 0.0 {
                    let share = scale * along(spread, u);
                    weight[column] += share * (high - low);
                    seen += share * high;
                }
            }
            weight[3 * s] += seen * GROWTH * (node.t[1] - node.t[0]) / node.t[1];
        }
    }

    /// M at the upper ends of a cube.
    #[inline(always)]
    fn variance_of(&self, cube: &Cube) -> [f64; PAIRS] {
        let mut total = *self.var_spread;
        let mut add = |factor: f64, spread: &[f64; PAIRS]| {
            for (to, x) in total.iter_mut().zip(spread) {
                *to += factor * x;
            }
        };
        for s in 0..self.sources.len() {
            let node = self.node_of(cube, s);
            if let Some(spread) = &node.own_spread {
                add(cube.own(s)[1], spread);
            }
            if let Some(spread) = node.other_spread.as_ref().filter(|_| cube.other(s)[1] > 0.0) {
                add(cube.other(s)[1], spread);
            }
        }
        total
    }

    /// Least u·(v f + w g) with the prices of v and w of one source at a corner of a stretch, less rounding, and how much of it
    /// each of its ranges accounts for.
    #[inline(always)]
    fn least(
        &self,
        cube: &Cube,
        s: usize,
        u: &Vector,
        prices: &[f64; COLUMNS],
        corner: [f64; 2],
        weight: &mut [f64; COLUMNS],
    ) -> f64 {
        let node = self.node_of(cube, s);
        let mut f = [0, 1, 2, 3].map(|term| dot(u, &node.own[term]));
        f[0] += prices[3 * s + 1];
        if let Some(along) = &node.along {
            for (share, along) in corner.into_iter().zip(&**along) {
                f.iter_mut().zip(&along[0]).for_each(|(f, along)| *f += share * dot(u, along));
            }
        }
        let (own, other) = (cube.own(s), cube.other(s));
        let size = node.reach.size;
        let slack = self.rounding * (own[1] * size[0] + other[1] * size[1]);
        if other[1] <= 0.0 {
            let least =
                own.map(|v| least_parabola(v * f[0], v * f[1], v * f[2]) - v * (f[3].abs() + node.own_rest));
            let (v, dv) = centre(own);
            weight[3 * s] =
                v * (f[1].abs() + f[2].abs() + f[3].abs() + node.own_rest) + 0.5 * dv * f[1].abs();
            weight[3 * s + 1] = dv * (f[0].abs() + 0.5 * f[1].abs());
            return least[0].min(least[1]) - slack;
        }
        let mut g = [0, 1, 2, 3].map(|term| dot(u, &node.other[term]));
        g[0] += prices[3 * s + 2];
        if let Some(along) = &node.along {
            for (share, along) in corner.into_iter().zip(&**along) {
                g.iter_mut().zip(&along[1]).for_each(|(g, along)| *g += share * dot(u, along));
            }
        }
        let mut least = f64::INFINITY;
        for v in own {
            for w in other {
                let mix = |term: usize| v * f[term] + w * g[term];
                let rest = mix(3).abs() + v * node.own_rest + w * node.other_rest;
                least = least.min(least_parabola(mix(0), mix(1), mix(2)) - rest);
            }
        }
        let ((v, dv), (w, dw)) = (centre(own), centre(other));
        let mix = |term: usize| (v * f[term] + w * g[term]).abs();
        let cross = 0.5 * (dv * f[1].abs() + dw * g[1].abs());
        weight[3 * s] = mix(1) + mix(2) + mix(3) + v * node.own_rest + w * node.other_rest + cross;
        weight[3 * s + 1] = dv * (f[0].abs() + 0.5 * f[1].abs());
        weight[3 * s + 2] = dw * (g[0].abs() + 0.5 * g[1].abs());
        least - slack
    }

    /// The range of most weight among those that can be halved.
    fn best_split(&self, cube: &Cube, weight: impl Fn(usize) -> f64) -> Option<usize> {
        let mut best: Option<(f64, usize)> = None;
        for i in 0..3 * self.sources.len() {
            let [low, high] = cube.factors[i];
            let divisible =
                if i % 3 == 0 { self.node_of(cube, i / 3).divisible() } else { high - low > 1e-12 * high };
            let weight = weight(i);
            if divisible && weight > 0.0 && best.is_none_or(|(most, _)| weight > most) {
                best = Some((weight, i));
            }
        }
        best.map(|(_, i)| i)
    }
}
