//! The least of a convex quadratic over the amplitudes, with a lower bound that does not rest on the search for it.
//!
//! φ(δ) = g·δ + δᵀHδ, δ = z − z₀, over a polytope of z known by its least linear costs alone. Wolfe's method: the minimum over
//! the affine hull of a few vertices; those with a negative share leave, the cheapest vertex along the gradient joins.
//! Whatever is reached, no point is below φ(δ) − ∇φ·(δ − v), v the cheapest vertex: φ is convex.
//!
//! Rounding: with lengths ℓᵢ = √Hᵢᵢ and |gᵢ| ≤ 2ℓ₀ℓᵢ the terms of φ and ∇φ are no larger than products of these, so that an
//! origin near the minimum makes it small.
//!
//! Source: P. Wolfe, Mathematical Programming 11, 128 (1976), doi:10.1007/BF01580381.

use super::orthogonal::{add, inner};

/// Vertices that join at most.
const JOINS: usize = 60;
/// Share of a vertex that is none.
const NOTHING: f64 = 1e-15;
/// What is left of a side's square, as a share of the largest, below which it depends on those before.
const DEPENDENT: f64 = 1e-15;
/// Rounding of a product of two columns, and more of it for each of them, as a share of their lengths ([`crate::sum`]).
const ROUNDING: f64 = 2.5e-15;
const ROUNDING_EACH: f64 = 2.5e-16;

/// g, H row by row, z₀ and ℓ₀.
#[derive(Debug, Clone, Default)]
pub(super) struct Quadratic {
    pub(super) linear: Vec<f64>,
    pub(super) square: Vec<f64>,
    pub(super) origin: Vec<f64>,
    pub(super) length: f64,
}

/// The search for the least value, with its memory.
#[derive(Debug, Clone, Default)]
pub(super) struct Hull {
    /// The lowest point found, z.
    pub(super) point: Vec<f64>,
    /// Vertices less z₀ and H times these, one after the other, and their shares.
    vertices: Vec<f64>,
    images: Vec<f64>,
    shares: Vec<f64>,
    /// δ, Hδ and ∇φ.
    change: Vec<f64>,
    image: Vec<f64>,
    gradient: Vec<f64>,
    vertex: Vec<f64>,
    /// Of the minimum over the affine hull.
    goal: Vec<f64>,
    matrix: Vec<f64>,
}

/// Resizes to zeros.
fn clear(list: &mut Vec<f64>, len: usize) {
    list.clear();
    list.resize(len, 0.0);
}

impl Hull {
    /// A lower bound of φ; searches until it is `enough` or cannot be raised. `cheapest` gives the vertex of least linear
    /// cost.
    pub(super) fn least(
        &mut self,
        quadratic: &Quadratic,
        mut cheapest: impl FnMut(&[f64], &mut [f64]),
        enough: f64,
    ) -> f64 {
        let Quadratic { linear, square, origin, length } = quadratic;
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
        let unit = ROUNDING + ROUNDING_EACH * n as f64;
        let (mut lower, mut stale) = (f64::NEG_INFINITY, 0);
        for _ in 0..JOINS {
            self.change.fill(0.0);
            self.image.fill(0.0);
            for (i, share) in self.shares.iter().enumerate() {
                add(&mut self.change, *share, &self.vertices[i * n..(i + 1) * n]);
                add(&mut self.image, *share, &self.images[i * n..(i + 1) * n]);
            }
            let value = inner(linear, &self.change) + inner(&self.image, &self.change);
            for ((gradient, g), image) in self.gradient.iter_mut().zip(linear).zip(&self.image) {
                *gradient = g + 2.0 * image;
            }
            cheapest(&self.gradient, &mut self.vertex);
            let (mut gap, mut near, mut far) = (0.0, 0.0, 0.0);
            for i in 0..n {
                let side = self.change[i] - (self.vertex[i] - origin[i]);
                gap += self.gradient[i] * side;
                let size = square[i * n + i].max(0.0).sqrt();
                near += self.change[i].abs() * size;
                far += side.abs() * size;
            }
            let rounding = unit * (near * (2.0 * length + near) + 2.0 * far * (length + near));
            let bound = value - gap.max(0.0) - rounding;
            if bound > lower {
                (lower, stale) = (bound, 0);
                self.point.iter_mut().zip(&self.change).zip(origin).for_each(|((p, d), o)| *p = d + o);
            } else {
                stale += 1;
            }
            if lower >= enough || gap <= rounding || stale > 4 || !self.join(quadratic) || !self.settle(n) {
                break;
            }
        }
        lower
    }

    /// The cheapest vertex joins, without a share, unless it is there already.
    fn join(&mut self, quadratic: &Quadratic) -> bool {
        let n = self.vertex.len();
        let start = self.vertices.len();
        self.vertices.extend(self.vertex.iter().zip(&quadratic.origin).map(|(v, o)| v - o));
        let (before, new) = self.vertices.split_at(start);
        if before.chunks(n).any(|known| known == new) {
            self.vertices.truncate(start);
            return false;
        }
        self.images.extend((0..n).map(|i| inner(&quadratic.square[i * n..(i + 1) * n], new)));
        self.shares.push(0.0);
        // ∇φ at the vertex is formed anew in `affine`.
        self.goal.clone_from(&quadratic.linear);
        true
    }

    /// The minimum over the hull of the vertices, which shrink to those that carry it.
    fn settle(&mut self, n: usize) -> bool {
        let linear = std::mem::take(&mut self.goal);
        let mut goal = Vec::new();
        let mut settled = true;
        while self.shares.len() > 1 {
            self.affine(&linear, &mut goal);
            let mut reach = 1.0_f64;
            for (share, goal) in self.shares.iter().zip(&goal) {
                if *goal < NOTHING && share > goal {
                    reach = reach.min(share / (share - goal));
                }
            }
            self.shares.iter_mut().zip(&goal).for_each(|(share, goal)| *share += reach * (goal - *share));
            let before = self.shares.len();
            for i in (0..before).rev().filter(|&i| self.shares[i] <= NOTHING).collect::<Vec<_>>() {
                self.leave(i, n);
            }
            let sum: f64 = self.shares.iter().sum();
            if !(sum > 0.0 && sum.is_finite()) {
                settled = false;
                break;
            }
            self.shares.iter_mut().for_each(|share| *share /= sum);
            if reach >= 1.0 || self.shares.len() == before {
                break;
            }
        }
        self.goal = linear;
        settled
    }

    fn leave(&mut self, i: usize, n: usize) {
        let last = self.shares.len() - 1;
        self.shares.swap_remove(i);
        for list in [&mut self.vertices, &mut self.images] {
            list.copy_within(last * n..(last + 1) * n, i * n);
            list.truncate(last * n);
        }
    }

    /// Shares of the vertices at the least of φ over their affine hull: with sides s from the last of them, b,
    /// Σⱼ sᵢᵀHsⱼ wⱼ = −½ sᵢ·∇φ(b), by Cholesky's method.
    fn affine(&mut self, linear: &[f64], shares: &mut Vec<f64>) {
        let n = linear.len();
        let m = self.shares.len() - 1;
        let vertex = |i: usize| &self.vertices[i * n..(i + 1) * n];
        let image = |i: usize| &self.images[i * n..(i + 1) * n];
        clear(shares, m + 1);
        clear(&mut self.matrix, m * m);
        for i in 0..m {
            for k in 0..n {
                let side = vertex(i)[k] - vertex(m)[k];
                shares[i] -= side * (0.5 * linear[k] + image(m)[k]);
                for j in 0..=i {
                    self.matrix[i * m + j] += side * (image(j)[k] - image(m)[k]);
                }
            }
        }
        let largest = (0..m).map(|i| self.matrix[i * m + i]).fold(0.0, f64::max);
        let matrix = &mut self.matrix;
        for i in 0..m {
            for j in 0..=i {
                let known: f64 = (0..j).map(|k| matrix[i * m + k] * matrix[j * m + k]).sum();
                let left = matrix[i * m + j] - known;
                matrix[i * m + j] = if i == j {
                    if left > DEPENDENT * largest { left.sqrt() } else { 0.0 }
                } else if matrix[j * m + j] > 0.0 {
                    left / matrix[j * m + j]
                } else {
                    0.0
                };
            }
            let known: f64 = (0..i).map(|k| matrix[i * m + k] * shares[k]).sum();
            let pivot = matrix[i * m + i];
            shares[i] = if pivot > 0.0 { (shares[i] - known) / pivot } else { 0.0 };
        }
        for i in (0..m).rev() {
            let later: f64 = (i + 1..m).map(|k| matrix[k * m + i] * shares[k]).sum();
            let pivot = matrix[i * m + i];
            shares[i] = if pivot > 0.0 { (shares[i] - later) / pivot } else { 0.0 };
        }
        shares[m] = 1.0 - shares[..m].iter().sum::<f64>();
    }
}
