//! A lower bound of the distance in a box of all sources' temperatures and factors.
//!
//! Let Δ = Qᵀω(N − N′) (see `cell`), Δ_c its value at the centre and A its derivatives times the half widths. Of the linear
//! model the point x, |x_i| ≤ 1, nearest to the origin is found, and u = (Δ_c + Ax)/‖Δ_c + Ax‖. For this one direction
//!
//! min over the box of u·Δ = Σ_s min over (T, v, w) of u·[v f(T) + w g(T)]
//!
//! is bounded below source by source: linear in v and w, so that only the four corners of their ranges matter, and on each
//! of them a parabola in T minimised on its interval, less the cubic term and the remainder. A linear model loses nothing
//! by the choice of u (duality of the nearest point of a convex set); so the bound misses the least distance in the box
//! by its second derivatives alone. *Any* u gives a valid bound: how well the nearest point is solved for matters for
//! tightness alone.
//!
//! Split is along what bends u·Δ, or moves it, most.

use super::cell::{Cell, Node, PAIRS, RANK, Vector};
use super::model::SOURCES;

/// Columns of A: temperature, v, w of each source.
const COLUMNS: usize = 3 * SOURCES;
/// Steps of the search for the nearest point of the linear model.
const STEPS: usize = 16;
/// Share of the separation in the middle below which the linear model is taken to reach the origin.
const REACHED: f64 = 1e-9;

/// Part of a cell: an interval of each temperature, and ranges of the factors.
#[derive(Debug, Clone)]
pub(super) struct Cube {
    pub(super) cell: u32,
    pub(super) nodes: [u32; SOURCES],
    pub(super) own: [[f64; 2]; SOURCES],
    pub(super) other: [[f64; 2]; SOURCES],
    /// Proved: no distance in it is below.
    pub(super) bound: f64,
    /// Along what it is best split: 3s for temperature s, 3s + 1 for v, 3s + 2 for w; `None` if it cannot be.
    pub(super) split: Option<usize>,
}

#[inline(always)]
fn dot(a: &Vector, b: &Vector) -> f64 {
    let mut lanes = [0.0; 4];
    for (a, b) in a.chunks_exact(4).zip(b.chunks_exact(4)) {
        for i in 0..4 {
            lanes[i] += a[i] * b[i];
        }
    }
    (lanes[0] + lanes[1]) + (lanes[2] + lanes[3])
}

#[inline(always)]
fn add(to: &mut Vector, factor: f64, column: &Vector) {
    for (to, x) in to.iter_mut().zip(column) {
        *to += factor * x;
    }
}

/// Least a + bt + ct² on |t| ≤ 1.
#[inline(always)]
fn least_parabola(a: f64, b: f64, c: f64) -> f64 {
    if 2.0 * c > b.abs() { a - 0.25 * b * b / c } else { a + c - b.abs() }
}

fn centre([low, high]: [f64; 2]) -> (f64, f64) {
    (0.5 * (low + high), 0.5 * (high - low))
}

impl Cell {
    fn node_of(&self, cube: &Cube, s: usize) -> &Node {
        &self.sources[s].nodes[cube.nodes[s] as usize]
    }

    /// Sets bound and split of a cube; the bound never falls below what it was.
    pub(super) fn bound(&self, cube: &mut Cube) {
        let sources = self.sources.len();
        let (mut middle, mut columns) = ([0.0; RANK], [[0.0; RANK]; COLUMNS]);
        for s in 0..sources {
            let node = self.node_of(cube, s);
            let ((v, dv), (w, dw)) = (centre(cube.own[s]), centre(cube.other[s]));
            add(&mut middle, v, &node.own[0]);
            add(&mut columns[3 * s], v, &node.own[1]);
            add(&mut columns[3 * s + 1], dv, &node.own[0]);
            if cube.other[s][1] > 0.0 {
                add(&mut middle, w, &node.other[0]);
                add(&mut columns[3 * s], w, &node.other[1]);
                add(&mut columns[3 * s + 2], dw, &node.other[0]);
            }
        }
        let mut point = middle;
        let gram = Gram::new(&columns[..3 * sources], &middle);
        let x = gram.nearest();
        for (x, column) in x.iter().zip(&columns) {
            add(&mut point, *x, column);
        }
        let norm = dot(&point, &point).sqrt();
        if norm <= REACHED * dot(&middle, &middle).sqrt() {
            let size = |i: usize| gram.square[i][i];
            cube.split = self.best_split(cube, size);
            return;
        }
        let u = point.map(|x| x / norm);
        let mut weight = [0.0; COLUMNS];
        let mut total = -self.slack;
        for s in 0..sources {
            total += self.least(cube, s, &u, &mut weight);
        }
        cube.split = self.best_split(cube, |i| weight[i]);
        if total > 0.0 {
            // A denominator some hundred roundings too large, never too small.
            let bound = total / (self.spread_of(cube, &u).sqrt() * (1.0 + 1e-13));
            if bound > cube.bound {
                cube.bound = bound;
            }
        }
    }

    /// Least u·(v f + w g) of one source, and how much of it each of its ranges accounts for.
    #[inline(always)]
    fn least(&self, cube: &Cube, s: usize, u: &Vector, weight: &mut [f64; COLUMNS]) -> f64 {
        let node = self.node_of(cube, s);
        let f = [0, 1, 2, 3].map(|term| dot(u, &node.own[term]));
        let own = cube.own[s];
        let other = cube.other[s];
        if other[1] <= 0.0 {
            let least =
                own.map(|v| least_parabola(v * f[0], v * f[1], v * f[2]) - v * (f[3].abs() + node.own_rest));
            let (v, dv) = centre(own);
            weight[3 * s] =
                v * (f[1].abs() + f[2].abs() + f[3].abs() + node.own_rest) + 0.5 * dv * f[1].abs();
            weight[3 * s + 1] = dv * (f[0].abs() + 0.5 * f[1].abs());
            return least[0].min(least[1]);
        }
        let g = [0, 1, 2, 3].map(|term| dot(u, &node.other[term]));
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
        least
    }

    /// uᵀMu at the upper ends of a cube.
    #[inline(always)]
    fn spread_of(&self, cube: &Cube, u: &Vector) -> f64 {
        let mut products = [0.0; PAIRS];
        let mut place = 0;
        for i in 0..RANK {
            for j in i..RANK {
                products[place] = u[i] * u[j];
                place += 1;
            }
        }
        let along = |spread: &[f64; PAIRS]| -> f64 {
            let mut lanes = [0.0; 8];
            for (a, b) in products.chunks_exact(8).zip(spread.chunks_exact(8)) {
                for i in 0..8 {
                    lanes[i] += a[i] * b[i];
                }
            }
            lanes.iter().sum()
        };
        let mut total = along(&self.var_spread);
        for s in 0..self.sources.len() {
            let node = self.node_of(cube, s);
            total += cube.own[s][1] * along(&node.own_spread);
            if cube.other[s][1] > 0.0 {
                total += cube.other[s][1] * along(&node.other_spread);
            }
        }
        total
    }

    /// The range of most weight among those that can be halved.
    fn best_split(&self, cube: &Cube, weight: impl Fn(usize) -> f64) -> Option<usize> {
        let mut best: Option<(f64, usize)> = None;
        for i in 0..3 * self.sources.len() {
            let s = i / 3;
            let [low, high] = [[0.0, 1.0], cube.own[s], cube.other[s]][i % 3];
            let divisible =
                if i % 3 == 0 { self.divisible(s, cube.nodes[s]) } else { high - low > 1e-12 * high };
            let weight = weight(i);
            if divisible && weight > 0.0 && best.is_none_or(|(most, _)| weight > most) {
                best = Some((weight, i));
            }
        }
        best.map(|(_, i)| i)
    }
}

/// Normal equations of the linear model, of its columns that are not zero.
struct Gram {
    square: [[f64; COLUMNS]; COLUMNS],
    pull: [f64; COLUMNS],
    columns: [usize; COLUMNS],
    count: usize,
}

impl Gram {
    fn new(columns: &[Vector], middle: &Vector) -> Self {
        let (mut square, mut pull) = ([[0.0; COLUMNS]; COLUMNS], [0.0; COLUMNS]);
        let (mut used, mut count) = ([0; COLUMNS], 0);
        for (i, column) in columns.iter().enumerate() {
            let own = dot(column, column);
            if own > 0.0 {
                square[i][i] = own;
                pull[i] = dot(column, middle);
                used[count] = i;
                count += 1;
            }
        }
        for a in 0..count {
            for b in 0..a {
                let (i, j) = (used[a], used[b]);
                let value = dot(&columns[i], &columns[j]);
                (square[i][j], square[j][i]) = (value, value);
            }
        }
        Self { square, pull, columns: used, count }
    }

    /// x with |x_i| ≤ 1 that brings middle + Σxᵢ columnᵢ nearest to the origin: an active set (Stark and Parker,
    /// Comput. Stat. 10, 129 (1995)). Coefficients that come to a bound are held there; when the others have come to
    /// rest, the one that is pulled back most is let go.
    fn nearest(&self) -> [f64; COLUMNS] {
        let (mut x, mut held) = ([0.0; COLUMNS], [false; COLUMNS]);
        let mut slope = self.pull;
        let columns = &self.columns[..self.count];
        for _ in 0..STEPS {
            let (mut free, mut count) = ([0; COLUMNS], 0);
            for &i in columns.iter().filter(|&&i| !held[i]) {
                free[count] = i;
                count += 1;
            }
            let free = &free[..count];
            let step = self.newton(free, &slope);
            // As far as the first bound.
            let (mut share, mut stop) = (1.0, None);
            for (&i, &d) in free.iter().zip(&step) {
                let room = if d > 0.0 { 1.0 - x[i] } else { -1.0 - x[i] };
                if d != 0.0 && room / d < share {
                    (share, stop) = (room / d, Some(i));
                }
            }
            for (&i, &d) in free.iter().zip(&step) {
                x[i] = (x[i] + share * d).clamp(-1.0, 1.0);
                for &j in columns {
                    slope[j] += share * d * self.square[i][j];
                }
            }
            if let Some(i) = stop {
                x[i] = x[i].signum();
                held[i] = true;
                continue;
            }
            let mut most = (0.0, None);
            for &i in columns.iter().filter(|&&i| held[i]) {
                let pull = x[i] * slope[i] / self.square[i][i].sqrt();
                if pull > most.0 {
                    most = (pull, Some(i));
                }
            }
            match most.1 {
                Some(i) => held[i] = false,
                None => break,
            }
        }
        x
    }

    /// −G⁻¹ slope on the free coefficients, by Cholesky's factors of the matrix scaled to a unit diagonal.
    fn newton(&self, free: &[usize], slope: &[f64; COLUMNS]) -> [f64; COLUMNS] {
        let n = free.len();
        let (mut factor, mut y, mut scale) = ([[0.0; COLUMNS]; COLUMNS], [0.0; COLUMNS], [0.0; COLUMNS]);
        for (a, &i) in free.iter().enumerate() {
            scale[a] = 1.0 / self.square[i][i].sqrt();
        }
        for a in 0..n {
            for b in 0..=a {
                let mut value = self.square[free[a]][free[b]] * scale[a] * scale[b];
                for k in 0..b {
                    value -= factor[a][k] * factor[b][k];
                }
                // A little is added to the diagonal: columns may be dependent.
                factor[a][b] = if a == b { (value + 1e-12).max(1e-13).sqrt() } else { value / factor[b][b] };
            }
            let mut value = -slope[free[a]] * scale[a];
            for k in 0..a {
                value -= factor[a][k] * y[k];
            }
            y[a] = value / factor[a][a];
        }
        for a in (0..n).rev() {
            for k in a + 1..n {
                y[a] -= factor[k][a] * y[k];
            }
            y[a] /= factor[a][a];
        }
        for a in 0..n {
            y[a] *= scale[a];
        }
        y
    }
}
