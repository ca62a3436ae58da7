//! A straight line through the deviations of segments over their levels, robust, with a prior of its slope.

use hadar::order;

/// Where a bisquare weight is 0, in deviations.
const REJECTED: f64 = 4.685;
const ROUNDS: usize = 12;
/// A normal deviate's deviation over its median absolute value.
const PER_MEDIAN: f64 = 1.482_602;

/// off(x) = p + h·(x − x₀).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Fitted {
    pub(super) level: f64,
    pub(super) off: f64,
    pub(super) slope: f64,
    /// Variances of p and h for a scatter of 1.
    pub(super) unit: [f64; 2],
    /// Scatter of the segments about it.
    pub(super) scatter: f64,
    /// Segments that count.
    pub(super) used: f64,
}

impl Fitted {
    pub(super) fn at(&self, x: f64) -> f64 {
        self.off + self.slope * (x - self.level)
    }
}

pub(super) fn median(values: &mut [f64]) -> f64 {
    let middle = values.len() / 2;
    match values.is_empty() {
        true => f64::NAN,
        false => *values.select_nth_unstable_by(middle, f64::total_cmp).1,
    }
}

/// Robust deviation of values about their median.
pub(super) fn scatter(values: &[f64]) -> f64 {
    let mut own = values.to_vec();
    let middle = median(&mut own);
    own.iter_mut().for_each(|value| *value = (*value - middle).abs());
    PER_MEDIAN * median(&mut own)
}

/// Fits deviations `off` at `levels`; `least` is the least scatter, `prior` the deviation of the slope from 0. `None` of fewer than six.
pub(super) fn fitted(levels: &[f64], off: &[f64], least: f64, prior: f64) -> Option<Fitted> {
    let mut points: Vec<(f64, f64)> = levels
        .iter()
        .zip(off)
        .filter(|(x, y)| x.is_finite() && y.is_finite())
        .map(|(x, y)| (*x, *y))
        .collect();
    if points.len() < 6 {
        return None;
    }
    order::ascending(&mut points, |a| a.0);
    let half = points.len() / 2;
    let mut slopes: Vec<f64> = points
        .iter()
        .zip(&points[points.len() - half..])
        .filter(|(low, high)| high.0 > low.0)
        .map(|(low, high)| (high.1 - low.1) / (high.0 - low.0))
        .collect();
    // A slope without contrast is noise; the prior holds it at the beginning too.
    let slope = if slopes.is_empty() { 0.0 } else { median(&mut slopes) };
    let mut h = slope.max(-3.0 * prior).min(3.0 * prior);
    let mut x0 = points[points.len() / 2].0;
    let mut rest: Vec<f64> = points.iter().map(|(x, y)| y - h * (x - x0)).collect();
    let mut p = median(&mut rest);
    let (mut deviation, mut sums) = (least, [0.0; 3]);
    for _ in 0..ROUNDS {
        let mut off: Vec<f64> = points.iter().map(|(x, y)| (y - p - h * (x - x0)).abs()).collect();
        deviation = (PER_MEDIAN * median(&mut off)).max(least);
        let weight = |x: f64, y: f64| {
            let u = (y - p - h * (x - x0)) / (REJECTED * deviation);
            (1.0 - u * u).max(0.0).powi(2)
        };
        let weights: Vec<f64> = points.iter().map(|(x, y)| weight(*x, *y)).collect();
        let total: f64 = weights.iter().sum();
        if total <= 0.0 || total.is_nan() {
            return None;
        }
        let of = |value: &dyn Fn(&(f64, f64)) -> f64| {
            points.iter().zip(&weights).map(|(point, w)| w * value(point)).sum::<f64>()
        };
        let (middle, mean) = (of(&|point| point.0) / total, of(&|point| point.1) / total);
        let xx = of(&|point| (point.0 - middle).powi(2));
        let xy = of(&|point| (point.0 - middle) * (point.1 - mean));
        // The prior as an observation of 0 with that deviation.
        let known = (deviation / prior).powi(2);
        let next = (mean, if xx + known > 0.0 { xy / (xx + known) } else { 0.0 });
        let settled = (next.0 - p).abs() <= 1e-3 * deviation && middle == x0;
        (p, h, x0) = (next.0, next.1, middle);
        sums = [total, xx + known, of(&|point| (point.1 - mean - h * (point.0 - middle)).powi(2))];
        if settled {
            break;
        }
    }
    let scatter = (sums[2] / (sums[0] - 2.0).max(1.0)).sqrt().max(deviation);
    Some(Fitted { level: x0, off: p, slope: h, unit: [1.0 / sums[0], 1.0 / sums[1]], scatter, used: sums[0] })
}
