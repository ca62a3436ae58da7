//! Lines on paper: clipping to a frame, thinning of what a pixel cannot show, dashes.

use super::scene::{Point, Rect};

/// Runs of consecutive points, split where one is missing.
pub(super) fn runs(points: impl Iterator<Item = Option<Point>>) -> Vec<Vec<Point>> {
    let mut runs = vec![Vec::new()];
    for point in points {
        match (point, runs.last_mut()) {
            (Some(point), Some(run)) => run.push(point),
            _ => runs.push(Vec::new()),
        }
    }
    runs.retain(|run: &Vec<Point>| !run.is_empty());
    runs
}

/// The parts of a line inside a frame (Liang and Barsky's parametric clipping, segment by segment).
pub(super) fn clip(line: &[Point], frame: &Rect) -> Vec<Vec<Point>> {
    let mut parts: Vec<Vec<Point>> = Vec::new();
    for (&from, &to) in line.iter().zip(line.iter().skip(1)) {
        let Some((a, b)) = clip_segment(from, to, frame) else { continue };
        match parts.last_mut() {
            Some(part) if part.last() == Some(&a) => part.push(b),
            _ => parts.push(vec![a, b]),
        }
    }
    parts
}

fn clip_segment(from: Point, to: Point, frame: &Rect) -> Option<(Point, Point)> {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let (mut enter, mut leave) = (0.0f64, 1.0f64);
    for (step, room) in [
        (-dx, from.0 - frame.left),
        (dx, frame.right - from.0),
        (-dy, from.1 - frame.top),
        (dy, frame.bottom - from.1),
    ] {
        if step == 0.0 {
            if room < 0.0 {
                return None;
            }
        } else if step < 0.0 {
            enter = enter.max(room / step);
        } else {
            leave = leave.min(room / step);
        }
    }
    let at = |t: f64| if t == 1.0 { to } else { (from.0 + t * dx, from.1 + t * dy) };
    (enter <= leave).then(|| (at(enter), at(leave)))
}

/// Keeps first, lowest, highest and last of the points that fall into the same quarter pixel of x.
pub(super) fn thin(line: &[Point]) -> Vec<Point> {
    let column = |point: &Point| (point.0 * 4.0).floor();
    let mut kept = Vec::new();
    for group in line.chunk_by(|a, b| column(a) == column(b)) {
        if group.len() <= 4 {
            kept.extend_from_slice(group);
            continue;
        }
        let extreme = |sign: f64| {
            let (mut best, mut at) = (f64::INFINITY, 0);
            for (i, point) in group.iter().enumerate() {
                if sign * point.1 < best {
                    (best, at) = (sign * point.1, i);
                }
            }
            at
        };
        let mut order = [0, extreme(1.0), extreme(-1.0), group.len() - 1];
        order.sort_unstable();
        kept.extend(order.iter().filter_map(|&i| group.get(i)).copied());
    }
    kept.dedup();
    kept
}

/// Cuts a line into dashes: lengths drawn and left out in turn, in pixels, each above zero.
pub(super) fn dash(line: &[Point], pattern: &[f64]) -> Vec<Vec<Point>> {
    let mut lengths = pattern.iter().copied().filter(|length| *length > 0.0).cycle();
    let Some(mut left) = lengths.next() else { return vec![line.to_vec()] };
    let mut drawing = true;
    let mut dashes = Vec::new();
    let mut current: Vec<Point> = line.first().copied().into_iter().collect();
    for (&from, &to) in line.iter().zip(line.iter().skip(1)) {
        let length = (to.0 - from.0).hypot(to.1 - from.1);
        let mut done = 0.0;
        while length - done > left {
            done += left;
            let at = (from.0 + (to.0 - from.0) * done / length, from.1 + (to.1 - from.1) * done / length);
            current.push(at);
            if drawing {
                dashes.push(std::mem::take(&mut current));
            }
            current = vec![at];
            drawing = !drawing;
            left = lengths.next().unwrap_or(f64::INFINITY);
        }
        left -= length - done;
        current.push(to);
    }
    if drawing {
        dashes.push(current);
    }
    dashes
}

/// An area between two lines over common x, cut to a frame; corners are added where an edge crosses it.
pub(super) fn clip_area(points: &[(f64, f64, f64)], frame: &Rect) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
    let mut all: Vec<(f64, f64, f64)> = Vec::new();
    for (&a, &b) in points.iter().zip(points.iter().skip(1)) {
        let at = |t: f64| (a.0 + t * (b.0 - a.0), a.1 + t * (b.1 - a.1), a.2 + t * (b.2 - a.2));
        let crossing = |from: f64, to: f64, level: f64| (level - from) / (to - from);
        let mut cuts = vec![
            crossing(a.0, b.0, frame.left),
            crossing(a.0, b.0, frame.right),
            crossing(a.1, b.1, frame.top),
            crossing(a.1, b.1, frame.bottom),
            crossing(a.2, b.2, frame.top),
            crossing(a.2, b.2, frame.bottom),
            crossing(a.1 - a.2, b.1 - b.2, 0.0),
        ];
        cuts.retain(|t| *t > 0.0 && *t < 1.0);
        cuts.sort_by(f64::total_cmp);
        all.push(a);
        all.extend(cuts.into_iter().map(at));
    }
    all.extend(points.last());
    let inside = |x: f64| (frame.left - 1e-6..=frame.right + 1e-6).contains(&x);
    let level = |y: f64| y.clamp(frame.top, frame.bottom);
    let mut parts = (Vec::new(), Vec::new(), Vec::new());
    for (x, a, b) in all.into_iter().filter(|(x, ..)| inside(*x)) {
        parts.0.push(x);
        parts.1.push(level(a.min(b)));
        parts.2.push(level(a.max(b)));
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: Rect = Rect { left: 0.0, top: 0.0, right: 10.0, bottom: 10.0 };

    #[test]
    fn a_line_through_the_frame_is_cut_at_both_sides() {
        assert_eq!(clip(&[(-5.0, 5.0), (15.0, 5.0)], &FRAME), [[(0.0, 5.0), (10.0, 5.0)]]);
        assert_eq!(clip(&[(5.0, 5.0), (5.0, 15.0), (6.0, 15.0), (6.0, 5.0)], &FRAME).len(), 2);
        assert!(clip(&[(-1.0, 0.0), (-1.0, 9.0)], &FRAME).is_empty());
    }

    #[test]
    fn dashes_cover_their_share_of_the_length() {
        let line: Vec<Point> = (0..=100).map(|i| (f64::from(i), 0.0)).collect();
        let dashes = dash(&line, &[6.0, 4.0]);
        let length: f64 = dashes.iter().map(|d| d[d.len() - 1].0 - d[0].0).sum();
        assert!((length - 60.0).abs() < 1e-9);
        assert_eq!(dash(&line, &[]), [line]);
    }

    #[test]
    fn thinning_keeps_the_extremes() {
        let line: Vec<Point> =
            (0..100_000).map(|i| (f64::from(i) * 1e-3, if i == 777 { 9.0 } else { 0.0 })).collect();
        let thinned = thin(&line);
        assert!(thinned.len() < 1700 && thinned.iter().any(|point| point.1 == 9.0));
    }

    #[test]
    fn an_area_is_cut_where_its_edge_crosses_the_frame() {
        let (x, upper, lower) = clip_area(&[(0.0, -10.0, 10.0), (10.0, 10.0, 10.0)], &FRAME);
        assert_eq!(x, [0.0, 5.0, 10.0]);
        assert_eq!((upper, lower), (vec![0.0, 0.0, 10.0], vec![10.0; 3]));
    }
}
