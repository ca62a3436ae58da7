//! The least of a convex quadratic over the amplitudes, with a lower bound that does not rest on the search for it.
//!
//! φ(δ) = g·δ + ‖Fδ‖², δ = z − z₀, over a polytope of z known by its least linear costs alone. Wolfe's method: the minimum over
//! the affine hull of a few vertices; those with a negative share leave, the cheapest vertex along the gradient joins.
//! Whatever is reached, no point is below φ(δ) − ∇φ·(δ − v), v the cheapest vertex: φ is convex.
//!
//! F is kept, not FᵀF, so that nearly dependent columns keep what digits they came with.
//!
//! Rounding: with ℓᵢ the length of column i and |gᵢ| ≤ 2ℓ₀ℓᵢ the terms of φ and ∇φ are no larger than products of these, so that an
//! origin near the minimum makes it small. The tangent is off by that wherever the least may be, not only at the vertex found.
//!
//! Kept beside [`crate::box_least_squares`], which knows a box and one sum alone, and of F only FᵀF: over the
//! simplex of three amplitudes this takes 0.45 µs, that 1.1 µs, and both reach the same least value to 5e-15.
//!
//! Source: P. Wolfe, Mathematical Programming 11, 128 (1976), doi:10.1007/BF01580381.

use super::orthogonal::{add, back_substitute, inner};

/// Vertices that join at most.
const JOINS: usize = 60;
/// Share of a vertex that is none.
const NOTHING: f64 = 1e-15;
/// What is left of a side, as a share, below which it depends on those before.
const DEPENDENT: f64 = 1e-14;
/// Rounding of a product of two columns, and more of it for each of them, as a share of their lengths ([`crate::sum`]).
const ROUNDING: f64 = 6e-15;
const ROUNDING_EACH: f64 = 2.5e-16;

/// The least that is left of the square of a column.
const LEAST: f64 = 1e-15;

/// g, F column by column, z₀ and ℓ₀.
#[derive(Debug, Clone, Default)]
pub(super) struct Quadratic {
    pub(super) linear: Vec<f64>,
    pub(super) factor: Vec<f64>,
    /// What F holds more of each column's square than there is.
    pub(super) excess: Vec<f64>,
    pub(super) origin: Vec<f64>,
    /// How large each of z can be.
    pub(super) most: Vec<f64>,
    pub(super) length: f64,
}

/// The search for the least value, with its memory.
#[derive(Debug, Clone, Default)]
pub(super) struct Hull {
    /// The lowest point found, z.
    pub(super) point: Vec<f64>,
    /// Vertices less z₀ and F times these, one after the other, and their shares.
    vertices: Vec<f64>,
    images: Vec<f64>,
    shares: Vec<f64>,
    /// δ, Fδ and ∇φ.
    change: Vec<f64>,
    image: Vec<f64>,
    gradient: Vec<f64>,
    vertex: Vec<f64>,
    /// Of the minimum over the affine hull: its shares, sides made orthonormal, and the triangle that they leave.
    goal: Vec<f64>,
    sides: Vec<f64>,
    triangle: Vec<f64>,
}

/// Resizes to zeros.
fn clear(list: &mut Vec<f64>, len: usize) {
    list.clear();
    list.resize(len, 0.0);
}

impl Hull {
    /// A lower bound of φ; searches until it is `enough` or cannot be raised. `cheapest` puts the vertex of least linear
    /// cost and returns what rounding may lift that by.
    pub(super) fn least(
        &mut self,
        quadratic: &Quadratic,
        mut cheapest: impl FnMut(&[f64], &mut [f64]) -> f64,
        enough: f64,
    ) -> f64 {
        let Quadratic { linear, origin, .. } = quadratic;
        let n = linear.len();
        for list in [&mut self.vertex, &mut self.image, &mut self.point, &mut self.change] {
            clear(list, n);
        }
        self.vertices.clear();
        self.images.clear();
        self.shares.clear();
        self.gradient.clone_from(linear);
        cheapest(&self.gradient, &mut self.vertex);
        self.join(quadratic);
        self.shares[0] = 1.0;
        let (mut lower, mut stale) = (f64::NEG_INFINITY, 0);
        for _ in 0..JOINS {
            self.change.fill(0.0);
            for (share, vertex) in self.shares.iter().zip(self.vertices.chunks(n)) {
                add(&mut self.change, *share, vertex);
            }
            let value = self.evaluate(quadratic);
            let lifted = cheapest(&self.gradient, &mut self.vertex);
            let sides = self.change.iter().zip(&self.vertex).zip(origin);
            let gap: f64 = sides
                .zip(&self.gradient)
                .map(|(((change, v), o), gradient)| gradient * (change - (v - o)))
                .sum();
            if gap.is_nan() {
                // No cheapest vertex is known.
                break;
            }
            let rounding = lifted + self.rounding_of_tangent(quadratic);
            let bound = value - gap.max(0.0) - rounding;
            if bound > lower {
                (lower, stale) = (bound, 0);
                self.point.iter_mut().zip(&self.change).zip(origin).for_each(|((p, d), o)| *p = d + o);
            } else {
                stale += 1;
            }
            if lower >= enough
                || gap <= rounding
                || stale > 4
                || !self.join(quadratic)
                || !self.settle(linear)
            {
                break;
            }
        }
        lower
    }

    /// A lower bound of √(ℓ₀² + φ) − `less`·z, by its tangent at the lowest point found: a length less what is linear is convex.
    pub(super) fn length_less(
        &mut self,
        quadratic: &Quadratic,
        mut cheapest: impl FnMut(&[f64], &mut [f64]) -> f64,
        less: &[f64],
    ) -> f64 {
        let n = self.point.len();
        clear(&mut self.vertex, n);
        clear(&mut self.change, n);
        self.change
            .iter_mut()
            .zip(self.point.iter().zip(&quadratic.origin))
            .for_each(|(d, (p, o))| *d = p - o);
        let there = (quadratic.length * quadratic.length + self.evaluate(quadratic)).sqrt();
        self.gradient
            .iter_mut()
            .zip(less)
            .for_each(|(gradient, less)| *gradient = 0.5 * *gradient / there - less);
        let lifted = cheapest(&self.gradient, &mut self.vertex);
        let lists = self.gradient.iter().zip(&self.point).zip(&self.vertex);
        let gap: f64 = lists.map(|((gradient, p), v)| gradient * (p - v)).sum();
        let rounding = lifted + 0.5 * self.rounding_of_tangent(quadratic) / there;
        if gap.is_nan() {
            f64::NEG_INFINITY
        } else {
            there - inner(less, &self.point) - gap.max(0.0) - rounding
        }
    }

    /// φ at δ; puts Fδ and ∇φ. Not of the images of vertices, whose rounding is by how far these are.
    fn evaluate(&mut self, quadratic: &Quadratic) -> f64 {
        let Quadratic { linear, factor, excess, .. } = quadratic;
        let n = linear.len();
        clear(&mut self.image, n);
        for (change, column) in self.change.iter().zip(factor.chunks(n)) {
            add(&mut self.image, *change, column);
        }
        let mut value = inner(linear, &self.change) + inner(&self.image, &self.image);
        for (i, (gradient, g)) in self.gradient.iter_mut().zip(linear).enumerate() {
            // Without what F holds more: the tangent is that of φ itself, wherever its cheapest vertex is.
            let more = excess[i] * self.change[i];
            *gradient = g + 2.0 * (inner(&factor[i * n..(i + 1) * n], &self.image) - more);
            value -= more * self.change[i];
        }
        value
    }

    /// What the tangent at δ may be off, wherever the least may be, not only where rounding has put it.
    fn rounding_of_tangent(&self, quadratic: &Quadratic) -> f64 {
        let Quadratic { factor, origin, most, length, .. } = quadratic;
        let n = origin.len();
        let unit = ROUNDING + ROUNDING_EACH * n as f64;
        let (mut near, mut far) = (0.0, 0.0);
        for i in 0..n {
            let column = &factor[i * n..(i + 1) * n];
            let size = inner(column, column).sqrt();
            near += self.change[i].abs() * size;
            if size == 0.0 {
                continue;
            }
            let side = self.change[i] - (self.vertex[i] - origin[i]);
            far += side.abs().max(most[i] + (origin[i] + self.change[i]).abs()) * size;
        }
        unit * (near * (2.0 * length + near) + 2.0 * far * (length + near))
    }

    /// The cheapest vertex joins, without a share, unless it is there already.
    fn join(&mut self, quadratic: &Quadratic) -> bool {
        crate::stop::check();
        let n = self.vertex.len();
        let start = self.vertices.len();
        self.vertices.extend(self.vertex.iter().zip(&quadratic.origin).map(|(v, o)| v - o));
        let (before, new) = self.vertices.split_at(start);
        if before.chunks(n).any(|known| known == new) {
            self.vertices.truncate(start);
            return false;
        }
        self.images.resize(start + n, 0.0);
        let image = &mut self.images[start..];
        for (i, amount) in self.vertices[start..].iter().enumerate() {
            add(image, *amount, &quadratic.factor[i * n..(i + 1) * n]);
        }
        self.shares.push(0.0);
        true
    }

    /// The minimum over the hull of the vertices, which shrink to those that carry it.
    fn settle(&mut self, linear: &[f64]) -> bool {
        while self.shares.len() > 1 {
            self.affine(linear);
            let mut reach = 1.0_f64;
            for (share, goal) in self.shares.iter().zip(&self.goal) {
                if *goal < NOTHING && share > goal {
                    reach = reach.min(share / (share - goal));
                }
            }
            let shares = self.shares.iter_mut().zip(&self.goal);
            shares.for_each(|(share, goal)| *share += reach * (goal - *share));
            let before = self.shares.len();
            for i in (0..before).rev() {
                if self.shares[i] <= NOTHING {
                    self.leave(i, linear.len());
                }
            }
            let sum: f64 = self.shares.iter().sum();
            if !(sum > 0.0 && sum.is_finite()) {
                return false;
            }
            self.shares.iter_mut().for_each(|share| *share /= sum);
            if reach >= 1.0 || self.shares.len() == before {
                break;
            }
        }
        true
    }

    fn leave(&mut self, i: usize, n: usize) {
        let last = self.shares.len() - 1;
        self.shares.swap_remove(i);
        for list in [&mut self.vertices, &mut self.images] {
            list.copy_within(last * n..(last + 1) * n, i * n);
            list.truncate(last * n);
        }
    }

    /// Shares of the vertices at the least of φ over their affine hull: with sides s = QR in F from the last of them, b,
    /// R w = −Qᵀ(Fb) − ½R⁻ᵀ(g·s).
    fn affine(&mut self, linear: &[f64]) {
        crate::stop::check();
        let n = linear.len();
        let m = self.shares.len() - 1;
        let vertex = |i: usize| &self.vertices[i * n..(i + 1) * n];
        let image = |i: usize| &self.images[i * n..(i + 1) * n];
        clear(&mut self.goal, m + 1);
        clear(&mut self.sides, m * n);
        clear(&mut self.triangle, m * m);
        for k in 0..m {
            let (done, rest) = self.sides.split_at_mut(k * n);
            let side = &mut rest[..n];
            side.iter_mut().zip(image(k).iter().zip(image(m))).for_each(|(side, (a, b))| *side = a - b);
            let before = inner(side, side).sqrt();
            for _ in 0..2 {
                for (i, known) in done.chunks(n).enumerate() {
                    let along = inner(known, side);
                    self.triangle[k * m + i] += along;
                    add(side, -along, known);
                }
            }
            let left = inner(side, side).sqrt();
            if left > DEPENDENT * before {
                self.triangle[k * m + k] = left;
                side.iter_mut().for_each(|x| *x /= left);
                let slope: f64 =
                    linear.iter().zip(vertex(k).iter().zip(vertex(m))).map(|(g, (a, b))| g * (a - b)).sum();
                let known: f64 = (0..k).map(|i| self.triangle[k * m + i] * self.goal[i]).sum();
                // R⁻ᵀ of half the slopes, row by row.
                self.goal[k] = (0.5 * slope - known) / left;
            } else {
                side.fill(0.0);
            }
        }
        for (goal, side) in self.goal.iter_mut().zip(self.sides.chunks(n.max(1))) {
            *goal = -*goal - inner(side, image(m));
        }
        back_substitute(|row, column| self.triangle[column * m + row], &mut self.goal[..m]);
        self.goal[m] = 1.0 - self.goal[..m].iter().sum::<f64>();
    }
}

/// F of FᵀF row by row, column by column. What is left of a column is no less than rounding; where less would be, the
/// difference is given as `excess`: however dependent the columns, no product is below what it was.
pub(super) fn factor_of(square: &[f64], factor: &mut Vec<f64>, excess: &mut Vec<f64>) {
    let n = square.len().isqrt();
    clear(factor, n * n);
    clear(excess, n);
    for k in 0..n {
        for i in 0..k {
            let known: f64 = (0..i).map(|j| factor[k * n + j] * factor[i * n + j]).sum();
            let pivot = factor[i * n + i];
            let left = square[k * n + i] - known;
            factor[k * n + i] = if pivot > 0.0 { left / pivot } else { 0.0 };
        }
        let known: f64 = factor[k * n..k * n + k].iter().map(|x| x * x).sum();
        let (left, least) = (square[k * n + k] - known, LEAST * square[k * n + k]);
        factor[k * n + k] = left.max(least).sqrt();
        excess[k] = (least - left).max(0.0);
    }
}
