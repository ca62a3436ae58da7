//! The least of a convex quadratic of two variables over a rectangle, from below.
//!
//! Q(x, y) = xx x² + 2 xy xy + yy y² + 2 x x + 2 y y on 0 ≤ x ≤ 1, a ≤ y ≤ b. Its least within, if there is one, and those of the four
//! edges give a point z; whatever the point is, Q(y) ≥ Q(z) + g·(y − z) with the gradient g there (convexity), which is what is returned:
//! rounding of z costs tightness, never truth.

/// What a largest y is lifted by, as a share of it and of the range.
const SLACK: f64 = 1e-6;
/// What must be left of yy once x is fitted, as a share.
const DEPENDENT: f64 = 1e-8;

/// Coefficients of Q, and [a, b].
#[derive(Clone, Copy)]
pub(super) struct OverRectangle {
    pub(super) xx: f64,
    pub(super) xy: f64,
    pub(super) yy: f64,
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) range: [f64; 2],
}

impl OverRectangle {
    /// A lower bound of Q, but for the rounding of its terms.
    #[inline(always)]
    pub(super) fn least(self) -> f64 {
        let Self { xx, xy, yy, x: s, y: v, range } = self;
        let value = |x: f64, y: f64| x * (xx * x + 2.0 * (xy * y + s)) + y * (yy * y + 2.0 * v);
        let (per_x, per_y) = (1.0 / if xx > 0.0 { xx } else { 1.0 }, 1.0 / if yy > 0.0 { yy } else { 1.0 });
        let along_x = |y: f64| within(-(xy * y + s) * per_x, [0.0, 1.0]);
        let along_y = |x: f64| within(-(xy * x + v) * per_y, range);
        let flat = xx * yy - xy * xy;
        let per_flat = 1.0 / if flat > 0.0 { flat } else { 1.0 };
        let (mut x, mut y) =
            (within((xy * v - yy * s) * per_flat, [0.0, 1.0]), within((xy * s - xx * v) * per_flat, range));
        let mut least = value(x, y);
        let edges = [
            [0.0, along_y(0.0)],
            [1.0, along_y(1.0)],
            [along_x(range[0]), range[0]],
            [along_x(range[1]), range[1]],
        ];
        for edge in edges {
            let there = value(edge[0], edge[1]);
            let lower = there < least;
            x = if lower { edge[0] } else { x };
            y = if lower { edge[1] } else { y };
            least = if lower { there } else { least };
        }
        let (by_x, by_y) = (2.0 * (xx * x + xy * y + s), 2.0 * (xy * x + yy * y + v));
        let fall_x = less(by_x * (0.0 - x), by_x * (1.0 - x));
        let fall_y = less(by_y * (range[0] - y), by_y * (range[1] - y));
        least + fall_x + fall_y
    }

    /// The largest y at which Q is no more than a value, and a little more; b at most.
    ///
    /// It is concave in x, so that it is largest where it is along all x, or at the end next to that.
    pub(super) fn highest(self, value: f64) -> f64 {
        let Self { xx, xy, yy, x: s, y: v, range } = self;
        let root =
            |square: f64, half: f64, rest: f64| (-half + (half * half - square * rest).sqrt()) / square;
        let at = |x: f64| root(yy, xy * x + v, x * (xx * x + 2.0 * s) - value);
        let left = yy - xy * xy / xx;
        if left.is_nan() || left < DEPENDENT * yy {
            return range[1];
        }
        let y = root(left, v - xy * s / xx, -value - s * s / xx);
        let x = -(xy * y + s) / xx;
        let most = if x <= 0.0 {
            at(0.0)
        } else if x >= 1.0 {
            at(1.0)
        } else if x > 0.0 {
            y
        } else {
            return range[1];
        };
        // None at all where the value is not reached anywhere: then nothing is to be said either.
        let more = most + SLACK * (most.abs() + range[1] - range[0]);
        if more < range[1] { more.max(range[0]) } else { range[1] }
    }
}

/// The smaller one.
#[inline(always)]
fn less(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// What is nearest to x between a and b.
#[inline(always)]
fn within(x: f64, [a, b]: [f64; 2]) -> f64 {
    let above = if x > a { x } else { a };
    less(above, b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::generator;
    use rand::RngExt;

    /// Against the value everywhere on a fine lattice of the rectangle, round and all but flat ones.
    #[test]
    fn nothing_on_the_rectangle_is_below_or_higher() {
        let mut random = generator(41, 0);
        let (mut tight, mut reached) = (0, 0);
        for trial in 0..2000 {
            let mut draw = || 2.0 * random.random::<f64>() - 1.0;
            let rows: [[f64; 2]; 3] = [[draw(), draw()], [draw(), draw()], [draw(), draw()]];
            // The second column nearly along the first one in every other trial.
            let flat = if trial % 2 == 0 { 1.0 } else { 1e-3 };
            let columns = rows.map(|[a, b]| [a, a + flat * b]);
            let sum = |f: &dyn Fn([f64; 2]) -> f64| columns.iter().map(|row| f(*row)).sum::<f64>();
            let range = [-1.5 * draw().abs(), 1.5 * draw().abs()];
            let of = OverRectangle {
                xx: sum(&|[a, _]| a * a),
                xy: sum(&|[a, b]| a * b),
                yy: sum(&|[_, b]| b * b),
                x: draw(),
                y: draw(),
                range,
            };
            let value = |x: f64, y: f64| {
                of.xx * x * x + 2.0 * of.xy * x * y + of.yy * y * y + 2.0 * of.x * x + 2.0 * of.y * y
            };
            let points =
                (0..=60).flat_map(|i| (0..=60).map(move |j| (f64::from(i) / 60.0, f64::from(j) / 60.0)));
            let points: Vec<(f64, f64)> =
                points.map(|(x, share)| (x, range[0] + share * (range[1] - range[0]))).collect();
            let lowest = points.iter().map(|(x, y)| value(*x, *y)).fold(f64::INFINITY, f64::min);
            let least = of.least();
            assert!(least <= lowest + 1e-12, "{trial}: {least} {lowest}");
            tight += usize::from(lowest - least < 0.01 * (1.0 + lowest.abs()));
            let limit = lowest + 0.3 * draw().abs();
            let highest = points.iter().filter(|(x, y)| value(*x, *y) <= limit).map(|(_, y)| *y);
            let highest = highest.fold(f64::NEG_INFINITY, f64::max);
            let told = of.highest(limit);
            assert!(told >= highest - 1e-9 && told <= range[1], "{trial}: {told} {highest}");
            reached += usize::from(told < range[1] && told - highest < 0.05 * (range[1] - range[0]));
        }
        assert!(tight > 1900 && reached > 500, "{tight} {reached}");
    }
}
