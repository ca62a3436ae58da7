//! Contour lines by marching squares: linear between the centres of four neighbouring cells.
//!
//! A square with a corner without value has no line. In the ambiguous case (opposite corners on the same
//! side) the mean of the corners decides which ones are joined.

use super::scene::Point;

/// The lines along which `values` (row after row, over the positions `x` and `y`) equal `level`.
pub(super) fn lines(x: &[f64], y: &[f64], values: &[f64], level: f64) -> Vec<Vec<Point>> {
    let value = |row: usize, column: usize| values.get(row * x.len() + column).copied();
    let mut segments = Vec::new();
    for (row, y_pair) in y.windows(2).enumerate() {
        for (column, x_pair) in x.windows(2).enumerate() {
            let (&[x0, x1], &[y0, y1]) = (x_pair, y_pair) else { continue };
            let corners = [(row, column), (row, column + 1), (row + 1, column + 1), (row + 1, column)];
            let [Some(a), Some(b), Some(c), Some(d)] = corners.map(|(row, column)| value(row, column)) else {
                continue;
            };
            if ![a, b, c, d].iter().all(|v| v.is_finite()) {
                continue;
            }
            let cross = |from: f64, to: f64, p: f64, q: f64| {
                ((from >= level) != (to >= level)).then(|| p + (level - from) / (to - from) * (q - p))
            };
            let bottom = cross(a, b, x0, x1).map(|x| (x, y0));
            let right = cross(b, c, y0, y1).map(|y| (x1, y));
            let top = cross(d, c, x0, x1).map(|x| (x, y1));
            let left = cross(a, d, y0, y1).map(|y| (x0, y));
            if let (Some(bottom), Some(right), Some(top), Some(left)) = (bottom, right, top, left) {
                let middle_like_a = ((a + b + c + d) / 4.0 >= level) == (a >= level);
                segments.extend(if middle_like_a {
                    [(bottom, right), (top, left)]
                } else {
                    [(bottom, left), (top, right)]
                });
            } else {
                let mut ends = [bottom, right, top, left].into_iter().flatten();
                segments.extend(ends.next().zip(ends.next()));
            }
        }
    }
    chain(segments)
}

/// Joins segments that share an end. Ends on a common edge come from the same numbers and are equal to
/// the last bit.
fn chain(segments: Vec<(Point, Point)>) -> Vec<Vec<Point>> {
    use std::collections::HashMap;
    let key = |(x, y): Point| (x.to_bits(), y.to_bits());
    let mut at: HashMap<(u64, u64), Vec<usize>> = HashMap::new();
    for (i, (a, b)) in segments.iter().enumerate() {
        at.entry(key(*a)).or_default().push(i);
        at.entry(key(*b)).or_default().push(i);
    }
    let mut used = vec![false; segments.len()];
    // Follows the line from `end`, marking segments as used.
    let mut follow = |mut end: Point, used: &mut Vec<bool>| {
        let mut path = Vec::new();
        while let Some(next) = at.get_mut(&key(end)).and_then(|candidates| {
            candidates.retain(|&i| !used.get(i).copied().unwrap_or(true));
            candidates.pop()
        }) {
            let (Some(&(a, b)), Some(flag)) = (segments.get(next), used.get_mut(next)) else { break };
            *flag = true;
            end = if key(a) == key(end) { b } else { a };
            path.push(end);
        }
        path
    };
    let mut paths = Vec::new();
    for (i, &(a, b)) in segments.iter().enumerate() {
        match used.get_mut(i) {
            Some(flag) if !*flag => *flag = true,
            _ => continue,
        }
        let mut path = follow(a, &mut used);
        path.reverse();
        path.extend([a, b]);
        path.extend(follow(b, &mut used));
        paths.push(path);
    }
    paths
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_paraboloid_has_a_circle_as_its_contour() {
        let axis: Vec<f64> = (-20..=20).map(f64::from).collect();
        let values: Vec<f64> = axis.iter().flat_map(|y| axis.iter().map(move |x| x * x + y * y)).collect();
        let lines = lines(&axis, &axis, &values, 150.0);
        assert_eq!(lines.len(), 1);
        assert_eq!(lines[0].first(), lines[0].last());
        // Linear interpolation of x² over a cell of 1 is off by at most 1/4 in the value, 0.01 in the radius.
        assert!(lines[0].iter().all(|(x, y)| (x.hypot(*y) - 150f64.sqrt()).abs() < 0.011));
    }

    #[test]
    fn cells_without_value_interrupt_a_line() {
        let axis = [0.0, 1.0, 2.0, 3.0];
        let mut values: Vec<f64> = (0..16).map(|i| f64::from(i / 4)).collect();
        assert_eq!(lines(&axis, &axis, &values, 1.5), [[(3.0, 1.5), (2.0, 1.5), (1.0, 1.5), (0.0, 1.5)]]);
        values[5] = f64::NAN;
        assert_eq!(lines(&axis, &axis, &values, 1.5).concat().len(), 2);
    }
}
