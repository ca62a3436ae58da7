//! The way down to the least of a smooth function under linear constraints: Newton's method with a working set.
//!
//! min f(z), aᵢ·z ≤ bᵢ (some of them equal). Constraints that hold with equality form the working set W; a step stays in
//! the null space of W, whose basis comes from eliminating W's rows, and solves (ZᵀHZ + λ)p = −Zᵀg with unit diagonal.
//! A constraint that a step meets is taken in; one that pushes the wrong way (multiplier below 0 in g + Aᵀμ = 0) is let
//! go. A step that does not lead down is shortened, then damped.
//!
//! Source: Nocedal, Wright, Numerical Optimization, 2nd ed., 16.5 (2006).

use crate::reference::double_double::Real;

/// Unknowns at most: three temperatures, gain, and three lighting factors.
pub(super) const MOST: usize = 8;
/// What one unknown has each.
pub(super) type Each<R> = [R; MOST];
/// Times that a step is shortened before it is damped.
const SHORTENED: usize = 12;

/// a·z ≤ b, or = b.
#[derive(Debug, Clone)]
pub(super) struct Constraint<R> {
    pub(super) row: Each<f64>,
    pub(super) bound: R,
    pub(super) equal: bool,
}

/// A function to second order.
#[derive(Debug, Clone)]
pub(super) struct Local<R> {
    pub(super) cost: R,
    pub(super) gradient: Each<R>,
    pub(super) hessian: [Each<R>; MOST],
    /// Positive second derivatives that make unknowns of any size comparable.
    pub(super) scale: Each<R>,
}

/// A problem to go down in.
#[derive(Debug)]
pub(super) struct Descent<'c, R> {
    pub(super) unknowns: usize,
    pub(super) constraints: &'c [Constraint<R>],
    /// Longest step of each unknown.
    pub(super) longest: Each<f64>,
    /// Share of the cost below which no more is to be gained.
    pub(super) settled: f64,
    /// Cost below which all is rounding.
    pub(super) nothing: f64,
    pub(super) steps: usize,
}

/// The rows of the working set after elimination: unknown `pivots[i]` is Σ −rows[i][j] zⱼ over the others.
struct Eliminated<R> {
    rows: Vec<Each<R>>,
    pivots: Vec<usize>,
}

impl<R: Real> Descent<'_, R> {
    /// The least reached from a feasible start.
    pub(super) fn run(&self, start: Each<R>, mut evaluate: impl FnMut(&Each<R>) -> Local<R>) -> (Each<R>, R) {
        let zero = R::from(0.0);
        let (mut z, mut at) = (start, evaluate(&start));
        let mut working: Vec<usize> =
            (0..self.constraints.len()).filter(|&i| self.constraints[i].equal).collect();
        let mut damping = 0.0;
        for _ in 0..self.steps {
            if at.cost.to_f64() <= self.nothing {
                break;
            }
            let Some(step) = self.downhill(&z, &at, &mut working, &mut damping) else { break };
            let step = self.within_longest(step, &at.gradient);
            let (mut share, mut meets) = (R::from(1.0), None);
            for (i, constraint) in self.constraints.iter().enumerate() {
                let along = self.dot(constraint, &step);
                if !working.contains(&i) && along > zero {
                    let room = self.slack(constraint, &z).larger(zero) / along;
                    if room < share {
                        (share, meets) = (room, Some(i));
                    }
                }
            }
            let mut moved = None;
            for _ in 0..SHORTENED {
                let mut there = z;
                for (there, change) in there.iter_mut().zip(&step) {
                    *there = *there + share * *change;
                }
                let next = evaluate(&there);
                // A step to a constraint may be too short to tell, and goes on along it.
                let same = R::from(1.0 + 64.0 * R::ROUNDING) * at.cost;
                if next.cost < at.cost || (meets.is_some() && next.cost <= same) {
                    moved = Some((there, next));
                    break;
                }
                (share, meets) = (share * R::from(0.25), None);
            }
            match moved {
                Some(next) => {
                    (z, at) = next;
                    working.extend(meets);
                    damping = if damping < 1e-10 { 0.0 } else { damping * 0.01 };
                }
                None if damping < 1e4 => damping = 1e3 * damping.max(1e-12),
                None => break,
            }
        }
        (z, at.cost)
    }

    /// The step, no unknown moved farther than its longest: each cut for itself, as one that hardly matters must not hold the
    /// others, unless that leads up.
    fn within_longest(&self, step: Each<R>, gradient: &Each<R>) -> Each<R> {
        let (mut cut, mut share) = (step, R::from(1.0));
        for (change, longest) in cut.iter_mut().zip(self.longest) {
            let size = change.magnitude();
            if size.to_f64() > longest {
                share = share.smaller(R::from(longest) / size);
                *change = *change / size * R::from(longest);
            }
        }
        let slope = cut.iter().zip(gradient).fold(R::from(0.0), |sum, (p, g)| sum + *p * *g);
        if slope < R::from(0.0) { cut } else { step.map(|change| change * share) }
    }

    fn dot(&self, constraint: &Constraint<R>, z: &Each<R>) -> R {
        let terms = constraint.row.iter().zip(z).take(self.unknowns).filter(|(a, _)| **a != 0.0);
        terms.fold(R::from(0.0), |sum, (a, z)| sum + R::from(*a) * *z)
    }

    fn slack(&self, constraint: &Constraint<R>, z: &Each<R>) -> R {
        constraint.bound - self.dot(constraint, z)
    }

    /// What rounding leaves of a constraint that holds with equality.
    fn is_met(&self, constraint: &Constraint<R>, z: &Each<R>) -> bool {
        let terms = constraint.row.iter().zip(z).take(self.unknowns);
        let size =
            terms.fold(constraint.bound.magnitude().to_f64(), |sum, (a, z)| sum + (a * z.to_f64()).abs());
        self.slack(constraint, z).to_f64() <= 16.0 * R::ROUNDING * size
    }

    /// A step that leads down and meets no constraint at once; nothing at the least.
    fn downhill(
        &self,
        z: &Each<R>,
        at: &Local<R>,
        working: &mut Vec<usize>,
        damping: &mut f64,
    ) -> Option<Each<R>> {
        for _ in 0..8 * (self.constraints.len() + 1) {
            let eliminated = self.eliminate(working);
            let step = loop {
                match self.newton(at, &eliminated, *damping) {
                    Some(step) => break step,
                    None if *damping < 1e6 => *damping = 10.0 * damping.max(1e-9),
                    None => return None,
                }
            };
            let slope = step.iter().zip(&at.gradient).fold(R::from(0.0), |sum, (p, g)| sum + *p * *g);
            if -slope <= R::from(self.settled) * at.cost {
                let wrong = self.wrong_way(at, &eliminated, working)?;
                working.remove(wrong);
                continue;
            }
            let stops = (0..self.constraints.len()).find(|i| {
                let constraint = &self.constraints[*i];
                !working.contains(i)
                    && self.dot(constraint, &step) > R::from(0.0)
                    && self.is_met(constraint, z)
            });
            match stops {
                Some(stops) if working.len() < self.unknowns => working.push(stops),
                Some(_) => return None,
                None => return Some(step),
            }
        }
        None
    }

    fn eliminate(&self, working: &[usize]) -> Eliminated<R> {
        let mut eliminated = Eliminated { rows: Vec::new(), pivots: Vec::new() };
        for &i in working {
            let mut row = self.constraints[i].row.map(R::from);
            for (done, &pivot) in eliminated.rows.iter().zip(&eliminated.pivots) {
                let share = row[pivot];
                for j in 0..self.unknowns {
                    row[j] = row[j] - share * done[j];
                }
                row[pivot] = R::from(0.0);
            }
            let largest = (0..self.unknowns)
                .max_by(|&a, &b| row[a].magnitude().to_f64().total_cmp(&row[b].magnitude().to_f64()));
            let Some(pivot) = largest else { continue };
            let head = row[pivot];
            row.iter_mut().for_each(|a| *a = *a / head);
            for done in &mut eliminated.rows {
                let share = done[pivot];
                for j in 0..self.unknowns {
                    done[j] = done[j] - share * row[j];
                }
            }
            eliminated.rows.push(row);
            eliminated.pivots.push(pivot);
        }
        eliminated
    }

    /// Newton's step within the working set; nothing where the second derivatives are not positive.
    fn newton(&self, at: &Local<R>, eliminated: &Eliminated<R>, damping: f64) -> Option<Each<R>> {
        let zero = R::from(0.0);
        let n = self.unknowns;
        let free: Vec<usize> = (0..n).filter(|j| !eliminated.pivots.contains(j)).collect();
        // Columns of Z.
        let basis: Vec<Each<R>> = free
            .iter()
            .map(|&j| {
                let mut column = [zero; MOST];
                column[j] = R::from(1.0);
                for (row, &pivot) in eliminated.rows.iter().zip(&eliminated.pivots) {
                    column[pivot] = -row[j];
                }
                column
            })
            .collect();
        let mut step = [zero; MOST];
        let m = free.len();
        let mut reduced = [[zero; MOST]; MOST];
        let mut right = [zero; MOST];
        let mut scale = [zero; MOST];
        for (a, column) in basis.iter().enumerate() {
            for i in 0..n {
                right[a] = right[a] - column[i] * at.gradient[i];
                scale[a] = scale[a] + column[i] * column[i] * at.scale[i];
                let terms = at.hessian[i].iter().zip(column).take(n);
                let image = terms.fold(zero, |sum, (h, z)| sum + *h * *z);
                for (reduced, other) in reduced[a].iter_mut().zip(&basis[..=a]) {
                    *reduced = *reduced + other[i] * image;
                }
            }
        }
        for scale in &mut scale[..m] {
            *scale = if *scale > zero { R::from(1.0) / scale.root() } else { R::from(1.0) };
        }
        for a in 0..m {
            right[a] = right[a] * scale[a];
            for b in 0..=a {
                reduced[a][b] = reduced[a][b] * scale[a] * scale[b];
            }
            reduced[a][a] = reduced[a][a] + R::from(damping.max(64.0 * R::ROUNDING));
        }
        let solution = cholesky(&mut reduced, &right, m)?;
        for (a, column) in basis.iter().enumerate() {
            for (step, z) in step.iter_mut().zip(column) {
                *step = *step + *z * solution[a] * scale[a];
            }
        }
        Some(step)
    }

    /// The place in the working set of the inequality that pushes the wrong way the most.
    fn wrong_way(&self, at: &Local<R>, eliminated: &Eliminated<R>, working: &[usize]) -> Option<usize> {
        let zero = R::from(0.0);
        let w = working.len();
        // Aᵀμ = −g on the pivots: Gauss with row pivots.
        let mut rows: Vec<Vec<R>> = eliminated
            .pivots
            .iter()
            .map(|&pivot| {
                let columns = working.iter().map(|&i| R::from(self.constraints[i].row[pivot]));
                columns.chain([-at.gradient[pivot]]).collect()
            })
            .collect();
        for pivot in 0..w {
            let best = (pivot..w).max_by(|&a, &b| {
                rows[a][pivot].magnitude().to_f64().total_cmp(&rows[b][pivot].magnitude().to_f64())
            })?;
            rows.swap(pivot, best);
            if rows[pivot][pivot] == zero {
                return None;
            }
            let head = rows[pivot].clone();
            for (i, row) in rows.iter_mut().enumerate() {
                if i != pivot {
                    let share = row[pivot] / head[pivot];
                    row.iter_mut().zip(&head).for_each(|(a, head)| *a = *a - share * *head);
                }
            }
        }
        let multiplier = |i: usize| (rows[i][w] / rows[i][i]).to_f64();
        let wrong = (0..w).filter(|&i| !self.constraints[working[i]].equal && multiplier(i) < 0.0);
        wrong.min_by(|&a, &b| multiplier(a).total_cmp(&multiplier(b)))
    }
}

/// Solves a symmetric positive definite system, its lower half given.
fn cholesky<R: Real>(matrix: &mut [Each<R>; MOST], right: &Each<R>, n: usize) -> Option<Each<R>> {
    let mut solution = *right;
    for i in 0..n {
        for j in 0..=i {
            let known = (0..j).fold(matrix[i][j], |sum, k| sum - matrix[i][k] * matrix[j][k]);
            if i == j {
                if !(known.to_f64() > 0.0 && known.to_f64().is_finite()) {
                    return None;
                }
                matrix[i][i] = known.root();
            } else {
                matrix[i][j] = known / matrix[j][j];
            }
        }
        solution[i] = (0..i).fold(solution[i], |sum, k| sum - matrix[i][k] * solution[k]) / matrix[i][i];
    }
    for i in (0..n).rev() {
        solution[i] = (i + 1..n).fold(solution[i], |sum, k| sum - matrix[k][i] * solution[k]) / matrix[i][i];
    }
    Some(solution)
}
