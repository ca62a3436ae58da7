//! How the optical depth D = −ln τ of a band grows with the length L of the path, from its values at a few lengths.
//!
//! * Between two columns: y = ln D is a cubic of x = ln L in Hermite's form,
//!   y = y₀ + (y₁ − y₀)t²(3 − 2t) + h t(1 − t)[s₀(1 − t) − s₁t], t = (x − x₀)/h, h = x₁ − x₀. The slopes s = dy/dx at
//!   the columns are those of the parabola through three columns, held to 0 ≤ s ≤ 3 min(secants beside it), which
//!   keeps D from falling anywhere (Fritsch and Carlson). Two columns make a power law.
//! * Below the shortest column: D ∝ Lˢ with the slope there, held to ½ ≤ s ≤ 1. 1 is Beer's law, which the mean over
//!   a band never exceeds (D is concave in L and 0 at 0); ½ is the square-root law of strong lines.
//! * At a column: its own value, to the last bit.
//!
//! A τ of 0 or 1 in a table of five digits says only that D > 12.2 or D < 5·10⁻⁶. Such a column is put
//! on the power law of the two columns beside it (Beer's law where there is but one), as far as its digits allow.
//! Where all columns are 1 there is no absorption.
//!
//! Source: Fritsch and Carlson, SIAM J. Numer. Anal. 17, 238 (1980), doi:10.1137/0717021.

use crate::spectrum::same;

/// Half the last digit of a table: the largest τ that is written 0, and 1 − τ of the smallest that is written 1.
const LEAST: f64 = 5e-6;

/// The lengths of the columns.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Lengths {
    metres: Vec<f64>,
    ln: Vec<f64>,
}

/// What of the columns a stretch of lengths lies in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Piece {
    /// Below the first one or up to it; its longest length by this much of ln L.
    Below(f64),
    /// Between `low` and the next, either of them included: shares of the way in ln L, and the whole of it.
    Between { low: usize, shares: [f64; 2], width: f64 },
}

/// Where a length lies among the columns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Position {
    /// No path at all.
    Nowhere,
    /// At a column.
    Column(usize),
    /// Below the first one, by this much of ln L.
    Below(f64),
    /// Between `low` and the next: share of the way in ln L, and the whole of it.
    Between { low: usize, share: f64, width: f64 },
}

impl Lengths {
    /// From ascending lengths above 0.
    pub(super) fn new(metres: Vec<f64>) -> Self {
        let ln = metres.iter().map(|length| length.ln()).collect();
        Self { metres, ln }
    }

    pub(super) fn longest_m(&self) -> f64 {
        self.metres.last().copied().unwrap_or(0.0)
    }

    pub(super) fn metres(&self) -> &[f64] {
        &self.metres
    }

    /// Where a stretch lies; `None` if a column is within it.
    pub(super) fn piece(&self, near: Position, far: Position) -> Option<Piece> {
        let place = |position: Position| match position {
            Position::Column(column) => Some((column, 0.0)),
            Position::Between { low, share, .. } => Some((low, share)),
            Position::Below(_) | Position::Nowhere => None,
        };
        match (near, far) {
            (Position::Below(_), Position::Below(by)) => Some(Piece::Below(by)),
            (Position::Below(_), Position::Column(0)) => Some(Piece::Below(0.0)),
            _ => {
                let ((low, from), (end, to)) = (place(near)?, place(far)?);
                let to = if end == low { to } else { (end == low + 1 && to == 0.0).then_some(1.0)? };
                let width = self.ln.get(low + 1)? - self.ln.get(low)?;
                Some(Piece::Between { low, shares: [from, to], width })
            }
        }
    }

    /// The place of a length, 0 or above; `None` beyond the longest column.
    pub(super) fn locate(&self, length_m: f64) -> Option<Position> {
        if length_m == 0.0 {
            return Some(Position::Nowhere);
        }
        if let Some(column) = self.metres.iter().position(|&column| same(column, length_m)) {
            return Some(Position::Column(column));
        }
        let next = self.metres.partition_point(|&column| column < length_m);
        let (x, high) = (length_m.ln(), *self.ln.get(next)?);
        let Some(low) = next.checked_sub(1) else { return Some(Position::Below(high - x)) };
        let (start, width) = (self.ln.get(low)?, high - self.ln.get(low)?);
        Some(Position::Between { low, share: (x - start) / width, width })
    }
}

/// D at the columns and what continues it between them.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Growth {
    /// Empty where nothing absorbs.
    knots: Vec<Knot>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Knot {
    depth: f64,
    ln_depth: f64,
    slope: f64,
}

impl Knot {
    /// dy/dx of the cubic to the next knot, at the share t of the way, which is `width` long in x.
    fn slope_to(&self, next: &Self, width: f64, t: f64) -> f64 {
        let (secant, left) = ((next.ln_depth - self.ln_depth) / width, 1.0 - t);
        6.0 * secant * t * left + self.slope * left * (1.0 - 3.0 * t) + next.slope * t * (3.0 * t - 2.0)
    }
}

impl Growth {
    /// From transmittances in [0, 1], one for each length, none above the one before.
    pub(super) fn new(lengths: &Lengths, transmittances: &[f64]) -> Self {
        if transmittances.iter().all(|&tau| tau == 1.0) {
            return Self { knots: Vec::new() };
        }
        let depths = depths(&lengths.ln, transmittances);
        let ln_depths: Vec<f64> = depths.iter().map(|depth| depth.ln()).collect();
        let slopes = slopes(&lengths.ln, &ln_depths);
        let knot = |((&depth, &ln_depth), &slope)| Knot { depth, ln_depth, slope };
        Self { knots: depths.iter().zip(&ln_depths).zip(&slopes).map(knot).collect() }
    }

    /// D at a place; 0 or above.
    pub(super) fn depth(&self, position: Position) -> f64 {
        let knot = |index: usize| self.knots.get(index);
        let depth = match position {
            Position::Nowhere => None,
            Position::Column(column) => knot(column).map(|knot| knot.depth),
            Position::Below(by) => {
                knot(0).map(|knot| (knot.ln_depth - knot.slope.clamp(0.5, 1.0) * by).exp())
            }
            Position::Between { low, share, width } => knot(low).zip(knot(low + 1)).map(|(from, to)| {
                let left = 1.0 - share;
                let rise = (to.ln_depth - from.ln_depth) * (share * share * (3.0 - 2.0 * share));
                let bend = width * share * left * (from.slope * left - to.slope * share);
                // Rounding must not lead past a column.
                (from.ln_depth + (rise + bend)).exp().max(from.depth).min(to.depth)
            }),
        };
        depth.unwrap_or(0.0)
    }
}

impl Growth {
    /// dy/dx = d ln D/d ln L at a place; 0 where nothing absorbs or there is no path. Cubics that meet at a column have one slope
    /// there; at the shortest one it is that of longer paths.
    pub(super) fn slope(&self, position: Position) -> f64 {
        let knot = |index: usize| self.knots.get(index);
        let slope = match position {
            Position::Nowhere => None,
            Position::Column(column) => knot(column).map(|knot| knot.slope),
            Position::Below(_) => knot(0).map(|first| first.slope.clamp(0.5, 1.0)),
            Position::Between { low, share, width } => {
                knot(low).zip(knot(low + 1)).map(|(from, to)| from.slope_to(to, width, share))
            }
        };
        slope.unwrap_or(0.0).max(0.0)
    }

    /// The most that |D′|, |D″| and |D‴| are on a piece, along x = ln L: D′ = Dy′, D″ = D(y′² + y″) and
    /// D‴ = D(y′³ + 3y′y″ + y‴) with D largest at the far end and, on a cubic, y″ a straight line.
    pub(super) fn bend(&self, piece: Piece) -> [f64; 3] {
        let knot = |index: usize| self.knots.get(index);
        let of = |depth: f64, slope: f64, second: f64, third: f64| {
            let square = slope * slope;
            [slope, square + second, slope * square + 3.0 * slope * second + third].map(|x| depth * x)
        };
        let bend = match piece {
            Piece::Below(by) => knot(0)
                .map(|first| of(self.depth(Position::Below(by)), first.slope.clamp(0.5, 1.0), 0.0, 0.0)),
            Piece::Between { low, shares: [start, end], width } => {
                knot(low).zip(knot(low + 1)).map(|(from, to)| {
                    let depth = self.depth(Position::Between { low, share: end, width });
                    let (secant, a, b) = ((to.ln_depth - from.ln_depth) / width, from.slope, to.slope);
                    let slope = |t: f64| from.slope_to(to, width, t);
                    let second = |t: f64| {
                        (6.0 * secant * (1.0 - 2.0 * t) - a * (4.0 - 6.0 * t) - b * (2.0 - 6.0 * t)) / width
                    };
                    let [first, last] = [second(start), second(end)];
                    // y′ is largest at an end or where y″ is 0.
                    let turn = start + (end - start) * first / (first - last);
                    let turn = if start < turn && turn < end { slope(turn) } else { 0.0 };
                    let steepest = slope(start).max(slope(end)).max(turn).max(0.0);
                    let third = (6.0 * (a + b) - 12.0 * secant).abs() / (width * width);
                    of(depth, steepest, first.abs().max(last.abs()), third)
                })
            }
        };
        bend.unwrap_or([0.0; 3])
    }
}

/// −ln τ, with what lies beyond the digits put on the power law of its neighbours.
fn depths(ln_lengths: &[f64], transmittances: &[f64]) -> Vec<f64> {
    let mut depths: Vec<f64> = transmittances.iter().map(|tau| -tau.ln()).collect();
    let known = |depth: f64| depth > 0.0 && depth.is_finite();
    let law = |depths: &[f64], near: Option<usize>, far: Option<usize>, at: usize| {
        let knot =
            |i: Option<usize>| Some((*ln_lengths.get(i?)?, *depths.get(i?)?)).filter(|(_, d)| known(*d));
        let (x0, depth) = knot(near)?;
        let slope = knot(far).map_or(1.0, |(x1, other)| ((depth / other).ln() / (x0 - x1)).clamp(0.0, 1.0));
        Some(depth * (slope * (ln_lengths.get(at)? - x0)).exp())
    };
    for i in 0..depths.len() {
        if depths.get(i).is_some_and(|depth| depth.is_infinite()) {
            let beyond = law(&depths, i.checked_sub(1), i.checked_sub(2), i);
            let least = -LEAST.ln();
            depths[i] = beyond.map_or(least, |depth| depth.clamp(least, f64::MAX));
        }
    }
    for i in (0..depths.len()).rev() {
        if depths.get(i).is_some_and(|&depth| depth <= 0.0) {
            let before = law(&depths, Some(i + 1), Some(i + 2), i);
            depths[i] = before.map_or(LEAST, |depth| depth.clamp(f64::MIN_POSITIVE, LEAST));
        }
    }
    depths
}

/// dy/dx at the knots: of the parabola through three of them, held to where the cubic cannot fall.
fn slopes(x: &[f64], y: &[f64]) -> Vec<f64> {
    let pieces: Vec<(f64, f64)> = x
        .windows(2)
        .zip(y.windows(2))
        .map(|(x, y)| {
            let width = x[1] - x[0];
            (width, (y[1] - y[0]) / width)
        })
        .collect();
    // The parabola's slope at the end of the first piece that the second one does not touch.
    let end = |(h, d): (f64, f64), (next, e): (f64, f64)| d + (d - e) * (h / (h + next));
    let inner = |(h, d): (f64, f64), (next, e): (f64, f64)| (next * d + h * e) / (h + next);
    let piece = |index: Option<usize>| pieces.get(index?).copied();
    (0..x.len())
        .map(|i| {
            let (before, after) = (piece(i.checked_sub(1)), piece(Some(i)));
            let slope = match (before, after) {
                (Some(before), Some(after)) => inner(before, after),
                (None, Some(after)) => piece(Some(i + 1)).map_or(after.1, |next| end(after, next)),
                (Some(before), None) => {
                    piece(i.checked_sub(2)).map_or(before.1, |previous| end(before, previous))
                }
                (None, None) => 0.0,
            };
            let most =
                [before, after].into_iter().flatten().map(|(_, d)| 3.0 * d).fold(f64::INFINITY, f64::min);
            slope.min(most).max(0.0)
        })
        .collect()
}
