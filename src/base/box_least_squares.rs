//! Least squares in a box, with one limit on a sum: steps and fits of a handful of unknowns.
//!
//! Minimises ½ pᵀHp + gᵀp for positive definite H subject to lᵢ ≤ pᵢ ≤ uᵢ and, for a subset I, Σ_I pᵢ ≤ s, all of which
//! p = 0 meets. Active-set method on the box; the one sum constraint by its multiplier μ ≥ 0, on which
//! Σ_I pᵢ(μ) depends monotonically. A handful of unknowns, so everything is dense.
//!
//! Four solvers are kept beside it, for the reasons that their headers state with a measurement: of a box's linear model
//! (`policy::envelope::linear`), over a polytope known by its vertices (`identifiability::nearest::proof::hull`), over
//! mixtures of spectra (`identifiability::mixture::hull`), and of a pixel (`decompose::step` of `hadar-estimate`).
//!
//! Source: Nocedal and Wright, 'Numerical Optimization' (2006), section 16.5.

use crate::few::{Few, FewColumns};

/// Attempts at the multiplier of the sum constraint; a handful are enough.
const ATTEMPTS: usize = 200;

/// The problem: H, g, bounds, and the members and limit of the sum constraint.
pub(crate) struct BoxLeastSquares<'a> {
    pub(crate) hessian: &'a FewColumns,
    pub(crate) gradient: &'a [f64],
    pub(crate) lower: &'a [f64],
    pub(crate) upper: &'a [f64],
    pub(crate) summed: &'a [bool],
    pub(crate) sum_limit: f64,
}

impl BoxLeastSquares<'_> {
    /// The minimiser, or `None` if H is not positive definite.
    pub(crate) fn solve(&self) -> Option<Few> {
        let free = self.in_box(self.gradient)?;
        if self.summed_part(&free) <= self.sum_limit {
            return Some(free);
        }
        let tilted = |multiplier: f64| {
            let mut gradient = Few::from(self.gradient);
            for (value, &member) in gradient.iter_mut().zip(self.summed) {
                *value += if member { multiplier } else { 0.0 };
            }
            self.in_box(&gradient)
        };
        let excess = |step: &[f64]| self.summed_part(step) - self.sum_limit;
        let (mut low, mut high) =
            (0.0, self.gradient.iter().fold(f64::MIN_POSITIVE, |most, g| g.abs().max(most)));
        let mut above = excess(&free);
        let mut step = tilted(high)?;
        let mut below = excess(&step);
        while below > 0.0 {
            if !high.is_finite() {
                return None;
            }
            (low, above) = (high, below);
            high *= 4.0;
            step = tilted(high)?;
            below = excess(&step);
        }
        // The excess falls piecewise linearly: the secant through both ends, the staying end's excess halved
        // (Illinois rule) so that no end stays for long.
        let mut stays = 0;
        for _ in 0..ATTEMPTS {
            let size: f64 = step.iter().map(|value| value.abs()).sum();
            if excess(&step).abs() <= 4.0 * f64::EPSILON * (size + self.sum_limit) {
                break;
            }
            let inside = |at: f64| (at > low && at < high).then_some(at);
            let secant = (low * below - high * above) / (below - above);
            let Some(middle) = inside(secant).or_else(|| inside(0.5 * (low + high))) else { break };
            let at = tilted(middle)?;
            let value = excess(&at);
            if value > 0.0 {
                (low, above) = (middle, value);
                below *= if stays == 1 { 0.5 } else { 1.0 };
                stays = 1;
            } else {
                (high, below, step) = (middle, value, at);
                above *= if stays == -1 { 0.5 } else { 1.0 };
                stays = -1;
            }
        }
        Some(step)
    }

    fn summed_part(&self, step: &[f64]) -> f64 {
        step.iter().zip(self.summed).filter(|(_, member)| **member).map(|(value, _)| value).sum()
    }

    /// The minimiser in the box alone.
    fn in_box(&self, gradient: &[f64]) -> Option<Few> {
        crate::stop::check();
        let n = gradient.len();
        let mut step = Few::zeros(n);
        // A variable that stands at a bound it is pushed against starts fixed.
        let mut fixed: Few<bool> = (0..n)
            .map(|i| {
                (self.lower[i] >= 0.0 && gradient[i] > 0.0) || (self.upper[i] <= 0.0 && gradient[i] < 0.0)
            })
            .collect();
        for _ in 0..10 * (n + 1) {
            let goal = self.free_minimum(gradient, &step, &fixed)?;
            let (mut share, mut blocking) = (1.0, None);
            for i in (0..n).filter(|&i| !fixed[i]) {
                let bound = if goal[i] > self.upper[i] {
                    self.upper[i]
                } else if goal[i] < self.lower[i] {
                    self.lower[i]
                } else {
                    continue;
                };
                let reach = (bound - step[i]) / (goal[i] - step[i]);
                if reach < share || blocking.is_none() {
                    (share, blocking) = (reach.clamp(0.0, 1.0), Some((i, bound)));
                }
            }
            for i in (0..n).filter(|&i| !fixed[i]) {
                step[i] += share * (goal[i] - step[i]);
            }
            if let Some((i, bound)) = blocking {
                step[i] = bound;
                fixed[i] = true;
                continue;
            }
            let slope = |i: usize| (0..n).map(|j| self.hessian[(i, j)] * step[j]).sum::<f64>() + gradient[i];
            let release = (0..n)
                .filter(|&i| fixed[i])
                .map(|i| (i, if step[i] <= self.lower[i] { -slope(i) } else { slope(i) }))
                .filter(|&(i, gain)| gain > 0.0 && self.lower[i] < self.upper[i])
                .max_by(|a, b| a.1.total_cmp(&b.1));
            match release {
                Some((i, _)) => fixed[i] = false,
                None => return Some(step),
            }
        }
        Some(step)
    }

    /// Minimum over the free variables with the others held where they are.
    fn free_minimum(&self, gradient: &[f64], held: &[f64], fixed: &[bool]) -> Option<Few> {
        let free: Few<usize> = (0..fixed.len()).filter(|&i| !fixed[i]).collect();
        let mut goal = Few::from(held);
        let matrix = FewColumns::from_fn(free.len(), free.len(), |i, j| self.hessian[(free[i], free[j])]);
        let right = (0..free.len()).map(|i| {
            let pull: f64 =
                (0..fixed.len()).filter(|&j| fixed[j]).map(|j| self.hessian[(free[i], j)] * held[j]).sum();
            -gradient[free[i]] - pull
        });
        let solution = solved(matrix, right.collect())?;
        for (i, value) in free.iter().zip(&*solution) {
            goal[*i] = *value;
        }
        Some(goal)
    }
}

/// H⁻¹x by Cholesky's factor, or `None` if H is not positive definite.
fn solved(mut matrix: FewColumns, mut x: Few) -> Option<Few> {
    let n = x.len();
    for j in 0..n {
        for k in 0..j {
            let factor = matrix[(j, k)];
            for i in j..n {
                matrix[(i, j)] -= factor * matrix[(i, k)];
            }
        }
        let square = matrix[(j, j)];
        if square.is_nan() || square <= 0.0 {
            return None;
        }
        matrix[(j, j)] = square.sqrt();
        let pivot = matrix[(j, j)];
        matrix[j][j + 1..].iter_mut().for_each(|x| *x /= pivot);
    }
    for j in 0..n {
        x[j] /= matrix[(j, j)];
        for i in j + 1..n {
            x[i] -= x[j] * matrix[(i, j)];
        }
    }
    for j in (0..n).rev() {
        let later: f64 = (j + 1..n).map(|i| matrix[(i, j)] * x[i]).sum();
        x[j] = (x[j] - later) / matrix[(j, j)];
    }
    Some(x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};

    fn solve(lower: &[f64], upper: &[f64], sum_limit: f64) -> Vec<f64> {
        // ½(p₁² + 2p₂²) + p₁p₂/2 − p₁ − p₂: free minimum at (6/7, 2/7).
        let hessian = FewColumns::from_fn(2, 2, |i, j| [[1.0, 0.5], [0.5, 2.0]][i][j]);
        let gradient = [-1.0, -1.0];
        let summed = [true, true];
        let step = BoxLeastSquares {
            hessian: &hessian,
            gradient: &gradient,
            lower,
            upper,
            summed: &summed,
            sum_limit,
        };
        step.solve().unwrap().to_vec()
    }

    #[test]
    fn free_bounded_and_summed_minima() {
        let close = |a: &[f64], b: [f64; 2]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-14);
        assert!(close(&solve(&[-9.0; 2], &[9.0; 2], 9.0), [6.0 / 7.0, 2.0 / 7.0]));
        // p₁ ≤ ½: then 2p₂ = 1 − ¼.
        assert!(close(&solve(&[-9.0; 2], &[0.5, 9.0], 9.0), [0.5, 0.375]));
        // p₁ + p₂ = ½: Lagrange gives p₁ = ⅜ , p₂ = ⅛ (1 − p₁ − p₂/2 = 1 − p₁/2 − 2p₂).
        assert!(close(&solve(&[-9.0; 2], &[9.0; 2], 0.5), [0.375, 0.125]));
        assert!(close(&solve(&[0.0; 2], &[0.0; 2], 9.0), [0.0, 0.0]));
    }

    /// Against many random feasible points: none may be better than the minimiser.
    #[test]
    fn no_feasible_point_is_better() {
        let mut seed = 1_u64;
        let mut draw = move || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        for case in 0..300 {
            // Columns that are nearly parallel, as those of temperature and lighting are.
            let root = DMatrix::from_fn(3, 3, |i, j| {
                if i == 0 {
                    1.0
                } else {
                    0.1_f64.powi(case % 4) * draw() + f64::from(u8::from(i == j)) * 1e-3
                }
            });
            let square = root.transpose() * root;
            let hessian = FewColumns::from_fn(3, 3, |i, j| square[(i, j)]);
            let gradient = DVector::from_fn(3, |_, _| draw());
            let (lower, upper) = ([-0.3, -0.4, -0.5], [0.6, 0.5, 0.4]);
            let summed = [true, true, false];
            let sum_limit = if case % 2 == 0 { 0.0 } else { 0.2 };
            let problem = BoxLeastSquares {
                hessian: &hessian,
                gradient: gradient.as_slice(),
                lower: &lower,
                upper: &upper,
                summed: &summed,
                sum_limit,
            };
            let step = DVector::from_row_slice(&problem.solve().unwrap());
            let model = |p: &DVector<f64>| 0.5 * p.dot(&(&square * p)) + gradient.dot(p);
            let least = model(&step);
            assert!(step[0] + step[1] <= sum_limit + 1e-12, "{case}");
            for scale in [1.0, 0.1, 1e-2, 1e-3] {
                for _ in 0..300 {
                    let mut p =
                        DVector::from_fn(3, |i, _| (step[i] + scale * draw()).clamp(lower[i], upper[i]));
                    let excess = p[0] + p[1] - sum_limit;
                    if excess > 0.0 {
                        p[0] -= excess;
                        if p[0] < lower[0] {
                            continue;
                        }
                    }
                    assert!(
                        model(&p) >= least - 1e-9 * least.abs(),
                        "{case} {scale}: {} < {least}, {p} {step}",
                        model(&p)
                    );
                }
            }
        }
    }
}
