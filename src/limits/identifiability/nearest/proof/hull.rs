//! The least of a convex quadratic over the amplitudes, with a lower bound that does not rest on the search for it.
//!
//! f(z) = f₀ + g·(z − z₀) + ‖F(z − z₀) + b‖², over a polytope known by its least linear costs alone. Wolfe's method: the
//! minimum over the affine hull of a few vertices; those with a negative share leave, the cheapest vertex along the gradient
//! joins. Whatever is reached, no point is below f(z) − ∇f·(z − v), v the cheapest vertex: f is convex.
//!
//! F is kept, not FᵀF, so that nearly dependent columns keep their digits.
//!
//! Source: P. Wolfe, Mathematical Programming 11, 128 (1976), doi:10.1007/BF01580381.

use crate::sum::dot;

/// Vertices that join at most.
const JOINS: usize = 60;
/// Share of a vertex that is none.
const NOTHING: f64 = 1e-15;
/// What is left of a column, as a share, below which it depends on those before.
const DEPENDENT: f64 = 1e-14;

/// A convex quadratic of n variables; F and the orthogonal columns are written column by column.
#[derive(Debug, Clone, Default)]
pub(super) struct Quadratic {
    pub(super) constant: f64,
    /// g.
    pub(super) linear: Vec<f64>,
    /// F.
    pub(super) factor: Vec<Vec<f64>>,
    /// b.
    pub(super) shift: Vec<f64>,
    /// z₀.
    pub(super) origin: Vec<f64>,
}

/// What is known of a least value.
#[derive(Debug, Clone)]
pub(super) struct Least {
    /// No point is below.
    pub(super) lower: f64,
    /// The lowest point found.
    pub(super) point: Vec<f64>,
}

/// Σ aᵢbᵢ of a few numbers.
pub(super) fn inner(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// to += factor · x.
pub(super) fn add(to: &mut [f64], factor: f64, x: &[f64]) {
    to.iter_mut().zip(x).for_each(|(to, x)| *to += factor * x);
}

/// Makes columns orthonormal (Gram and Schmidt, twice) and gives the triangle R of columns = QR, column by column, what depends on
/// earlier columns left out, and for each of `others` Qᵀother followed by what is left of its length.
pub(super) fn reduce(columns: &mut [Vec<f64>], others: &[&[f64]]) -> (Vec<Vec<f64>>, Vec<Vec<f64>>) {
    let size = columns.len();
    let mut triangle = vec![vec![0.0; size]; size];
    for (k, above) in triangle.iter_mut().enumerate() {
        let (done, rest) = columns.split_at_mut(k);
        let column = &mut rest[0];
        let before = dot(column, column).sqrt();
        for _ in 0..2 {
            for (i, known) in done.iter().enumerate() {
                let along = dot(known, column);
                above[i] += along;
                add(column, -along, known);
            }
        }
        let left = dot(column, column).sqrt();
        if left > DEPENDENT * before {
            above[k] = left;
            column.iter_mut().for_each(|x| *x /= left);
        } else {
            column.fill(0.0);
        }
    }
    let reduced = others.iter().map(|other| {
        let mut rest = other.to_vec();
        let mut along = vec![0.0; size + 1];
        for _ in 0..2 {
            for (i, known) in columns.iter().enumerate() {
                let part = dot(known, &rest);
                along[i] += part;
                add(&mut rest, -part, known);
            }
        }
        along[size] = dot(&rest, &rest).sqrt();
        along
    });
    let reduced = reduced.collect();
    (triangle, reduced)
}

impl Quadratic {
    /// F(x) + b for x relative to the origin.
    fn image(&self, x: &[f64]) -> Vec<f64> {
        let mut image = self.shift.clone();
        for (column, x) in self.factor.iter().zip(x) {
            add(&mut image, *x, column);
        }
        image
    }

    /// Searches until the bound is `enough` or cannot be raised; `cheapest` gives the vertex of least linear cost.
    pub(super) fn least(&self, mut cheapest: impl FnMut(&[f64], &mut [f64]) -> f64, enough: f64) -> Least {
        let n = self.linear.len();
        let mut vertex = vec![0.0; n];
        let apart =
            |vertex: &[f64]| -> Vec<f64> { vertex.iter().zip(&self.origin).map(|(v, o)| v - o).collect() };
        let gradient_at = |image: &[f64]| -> Vec<f64> {
            self.linear.iter().zip(&self.factor).map(|(g, column)| g + 2.0 * inner(column, image)).collect()
        };
        cheapest(&gradient_at(&self.shift), &mut vertex);
        let mut corral = vec![apart(&vertex)];
        let mut shares = vec![1.0];
        let mut point = corral[0].clone();
        let mut lower = f64::NEG_INFINITY;
        let mut stale = 0;
        for _ in 0..JOINS {
            let image = self.image(&point);
            let value = self.constant + inner(&self.linear, &point) + inner(&image, &image);
            let gradient = gradient_at(&image);
            cheapest(&gradient, &mut vertex);
            let joining = apart(&vertex);
            let gap: f64 =
                gradient.iter().zip(point.iter().zip(&joining)).map(|(g, (p, v))| g * (p - v)).sum();
            let bound = value - gap.max(0.0);
            stale = if bound > lower { 0 } else { stale + 1 };
            lower = lower.max(bound);
            if lower >= enough || gap <= 1e-13 * value.abs() || stale > 4 || corral.contains(&joining) {
                break;
            }
            corral.push(joining);
            shares.push(0.0);
            if !self.settle(&mut corral, &mut shares) {
                break;
            }
            point.fill(0.0);
            for (vertex, share) in corral.iter().zip(&shares) {
                add(&mut point, *share, vertex);
            }
        }
        point.iter_mut().zip(&self.origin).for_each(|(p, o)| *p += o);
        Least { lower, point }
    }

    /// The minimum over the hull of the corral, which shrinks to the vertices that carry it.
    fn settle(&self, corral: &mut Vec<Vec<f64>>, shares: &mut Vec<f64>) -> bool {
        while corral.len() > 1 {
            let goal = self.affine(corral);
            let mut reach = 1.0_f64;
            for (share, goal) in shares.iter().zip(&goal) {
                if *goal < NOTHING && share > goal {
                    reach = reach.min(share / (share - goal));
                }
            }
            shares.iter_mut().zip(&goal).for_each(|(share, goal)| *share += reach * (goal - *share));
            let before = corral.len();
            let mut keep = shares.iter().map(|share| *share > NOTHING);
            corral.retain(|_| keep.next().unwrap_or(false));
            shares.retain(|share| *share > NOTHING);
            let sum: f64 = shares.iter().sum();
            if !(sum > 0.0 && sum.is_finite()) {
                return false;
            }
            shares.iter_mut().for_each(|share| *share /= sum);
            if reach >= 1.0 || corral.len() == before {
                return true;
            }
        }
        true
    }

    /// Shares of the corral at the least of f over its affine hull.
    fn affine(&self, corral: &[Vec<f64>]) -> Vec<f64> {
        let m = corral.len() - 1;
        let base = &corral[m];
        let sides: Vec<Vec<f64>> =
            corral[..m].iter().map(|v| v.iter().zip(base).map(|(v, b)| v - b).collect()).collect();
        let mut images: Vec<Vec<f64>> = sides
            .iter()
            .map(|side| {
                let mut image = vec![0.0; self.shift.len()];
                self.factor.iter().zip(side).for_each(|(column, x)| add(&mut image, *x, column));
                image
            })
            .collect();
        let (triangle, others) = reduce(&mut images, &[&self.image(base)]);
        // ‖image + Rw‖² + g·(sides w): R w = −Qᵀimage − ½R⁻ᵀ(g·sides).
        let mut right = vec![0.0; m];
        for k in 0..m {
            let pivot = triangle[k][k];
            if pivot > 0.0 {
                let before: f64 = (0..k).map(|i| triangle[k][i] * right[i]).sum();
                right[k] = (0.5 * inner(&self.linear, &sides[k]) - before) / pivot;
            }
        }
        let mut shares: Vec<f64> = right.iter().zip(&others[0]).map(|(r, along)| -along - r).collect();
        for k in (0..m).rev() {
            let pivot = triangle[k][k];
            shares[k] = if pivot > 0.0 {
                let later: f64 = (k + 1..m).map(|j| triangle[j][k] * shares[j]).sum();
                (shares[k] - later) / pivot
            } else {
                0.0
            };
        }
        let rest = 1.0 - shares.iter().sum::<f64>();
        shares.push(rest);
        shares
    }
}
