//! The nearest point of a box's linear model, and changes to coordinates in which a variance is 1.
//!
//! Kept beside [`crate::box_least_squares`] and nalgebra's Cholesky factor because columns of a box may depend on each other and
//! rounding may leave a pivot that is not positive: there these have no answer, and a bound needs one. They are no faster either
//! (nine columns: 0.80 µs here, 0.84 µs with the former; a step of it 0.57 µs, 0.55 µs with nalgebra), and the least squares
//! agree to 8e-16 where columns are independent, so that other solvers would change the last digits of all bounds.

/// Components that are kept of a spectrum.
pub(super) const RANK: usize = 16;
/// Entries of a symmetric matrix.
pub(super) const PAIRS: usize = RANK * (RANK + 1) / 2;
/// A spectrum by its components.
pub(super) type Vector = [f64; RANK];
/// Sources that a proof can deal with: two surfaces, and four objects or twice two.
pub(super) const SOURCES: usize = 6;
/// Columns of A: temperature, v, w of each source.
pub(super) const COLUMNS: usize = 3 * SOURCES;
/// Steps of the search for the nearest point.
const STEPS: usize = 40;
/// Share of the distance that may be lost by slopes that are left.
const LOSS: f64 = 1e-3;

/// Cholesky's factor L of a matrix M = LLᵀ of the first `rank` components; the others are left alone.
pub(super) struct Factor {
    /// Column by column, with the inverse of the diagonal.
    columns: [Vector; RANK],
    rank: usize,
}

impl Factor {
    /// Of a matrix given by the lines of its upper half. A pivot that is not positive, which rounding may leave, is
    /// taken for a small one: any factor gives a valid bound.
    pub(super) fn new(matrix: &[f64; PAIRS], rank: usize) -> Self {
        let mut columns = [[0.0; RANK]; RANK];
        let mut place = 0;
        for (i, column) in columns.iter_mut().enumerate() {
            column[i..].copy_from_slice(&matrix[place..place + RANK - i]);
            place += RANK - i;
        }
        for i in 0..rank {
            let (done, rest) = columns.split_at_mut(i + 1);
            let column = &mut done[i];
            let pivot = column[i].max(1e-12);
            let inverse = 1.0 / pivot.sqrt();
            column.iter_mut().skip(i + 1).for_each(|x| *x *= inverse);
            column[i] = inverse;
            for (j, later) in rest.iter_mut().enumerate().take(rank.saturating_sub(i + 1)) {
                let share = column[i + 1 + j];
                for (x, y) in later.iter_mut().zip(column.iter()).skip(i + 1 + j) {
                    *x -= share * y;
                }
            }
        }
        Self { columns, rank }
    }

    /// L⁻¹x.
    #[inline(always)]
    pub(super) fn solve(&self, x: &mut Vector) {
        for (i, column) in self.columns.iter().enumerate().take(self.rank) {
            let value = x[i] * column[i];
            x[i] = value;
            for (x, l) in x.iter_mut().zip(column).skip(i + 1) {
                *x -= value * l;
            }
        }
    }

    /// L⁻ᵀx.
    pub(super) fn solve_transposed(&self, x: &mut Vector) {
        for (i, column) in self.columns.iter().enumerate().take(self.rank).rev() {
            let later: f64 = x.iter().zip(column).skip(i + 1).map(|(x, l)| x * l).sum();
            x[i] = (x[i] - later) * column[i];
        }
    }
}

/// A relation between factors as a row of the linear model: nothing where it holds anyway.
#[derive(Clone, Copy)]
pub(super) struct Limit {
    /// Which of the relations of a box.
    pub(super) relation: usize,
    pub(super) row: [f64; COLUMNS],
    pub(super) middle: f64,
    pub(super) stiffness: f64,
}

impl Limit {
    /// The multiplier of the relation, without its sign where it is an inequality.
    pub(super) fn price(&self, x: &[f64; COLUMNS], equal: bool) -> f64 {
        let row: f64 = self.row.iter().zip(x).map(|(row, x)| row * x).sum();
        let price = self.stiffness * (self.middle + row);
        if equal { price } else { price.max(0.0) }
    }
}

/// Normal equations of the linear model, of its columns that are not zero.
pub(super) struct Gram {
    /// ‖middle‖².
    middle: f64,
    square: [[f64; COLUMNS]; COLUMNS],
    pull: [f64; COLUMNS],
    columns: [usize; COLUMNS],
    count: usize,
}

impl Gram {
    /// Of `columns` columns, from their inner products with each other and with the middle.
    #[inline(always)]
    pub(super) fn new(
        columns: usize,
        square_of_middle: f64,
        inner: impl Fn(usize, usize) -> f64,
        middle: impl Fn(usize) -> f64,
    ) -> Self {
        let (mut square, mut pull) = ([[0.0; COLUMNS]; COLUMNS], [0.0; COLUMNS]);
        let (mut used, mut count) = ([0; COLUMNS], 0);
        for i in 0..columns {
            let own = inner(i, i);
            if own > 0.0 {
                square[i][i] = own;
                pull[i] = middle(i);
                for &j in &used[..count] {
                    let value = inner(i, j);
                    (square[i][j], square[j][i]) = (value, value);
                }
                used[count] = i;
                count += 1;
            }
        }
        Self { middle: square_of_middle, square, pull, columns: used, count }
    }

    /// ‖columnᵢ‖².
    pub(super) fn size(&self, i: usize) -> f64 {
        self.square[i][i]
    }

    /// x with |x_i| ≤ 1 that brings middle + Σxᵢ columnᵢ nearest to the origin: an active set (Stark and Parker,
    /// Comput. Stat. 10, 129 (1995)). Coefficients that come to a bound are held there; when the others have come to
    /// rest, the one that is pulled back most is let go.
    pub(super) fn nearest(&self) -> [f64; COLUMNS] {
        self.nearest_from([0.0; COLUMNS], self.pull, self.middle)
    }

    /// The same from x on, with half the slopes of the square and the square there: where all but a little of the middle
    /// cancels, what is left has lost its digits in the normal equations, but not where it is formed anew.
    pub(super) fn nearest_from(
        &self,
        start: [f64; COLUMNS],
        slopes: [f64; COLUMNS],
        square_at_start: f64,
    ) -> [f64; COLUMNS] {
        let (mut x, mut slope) = (start, slopes);
        let columns = &self.columns[..self.count];
        let mut held = [false; COLUMNS];
        columns.iter().for_each(|&i| held[i] = x[i].abs() >= 1.0);
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
            // A matrix near singular is not solved in one go, and what is left of the slopes is lost in a bound.
            let loss: f64 = free.iter().map(|&i| slope[i].abs()).sum();
            let moved = columns.iter().map(|&i| (x[i] - start[i]) * (slopes[i] + slope[i]));
            let square = square_at_start + moved.sum::<f64>();
            if loss > LOSS * square {
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
                for (x, y) in factor[a].iter().zip(&factor[b]).take(b) {
                    value -= x * y;
                }
                // A little is added to the diagonal: columns may be dependent.
                factor[a][b] = if a == b { (value + 1e-14).max(1e-14).sqrt() } else { value / factor[b][b] };
            }
            let mut value = -slope[free[a]] * scale[a];
            for (x, y) in factor[a].iter().zip(&y).take(a) {
                value -= x * y;
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
