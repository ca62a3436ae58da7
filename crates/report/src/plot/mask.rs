//! How much of each pixel a shape covers, so that edges are smooth.
//!
//! The coverage of a pixel at distance d from
//! the middle of a line of half-width r is r + ½ − d, bounded to [0, 1]. Parts of one shape that
//! overlap count once, so that translucent lines have no knots.

use super::scene::Point;

/// Coverage of a picture's pixels by one shape at a time.
pub(super) struct Mask {
    width: i32,
    height: i32,
    coverage: Vec<u8>,
    touched: Vec<(i32, i32)>,
}

impl Mask {
    pub(super) fn new(width: u32, height: u32) -> Self {
        let coverage = vec![0; width as usize * height as usize];
        Self { width: width as i32, height: height as i32, coverage, touched: Vec::new() }
    }

    fn cell(&mut self, x: i32, y: i32) -> Option<&mut u8> {
        let inside = (0..self.width).contains(&x) && (0..self.height).contains(&y);
        inside.then(|| y as usize * self.width as usize + x as usize).and_then(|i| self.coverage.get_mut(i))
    }

    fn cover(&mut self, x: i32, y: i32, part: f64) {
        let part = (part * 255.0).round() as u8;
        let Some(cell) = self.cell(x, y) else { return };
        let before = *cell;
        *cell = before.max(part);
        if before == 0 && part > 0 {
            self.touched.push((x, y));
        }
    }

    /// A line with round joins and ends; a single point makes a disc. Positions in pixels.
    pub(super) fn stroke(&mut self, points: &[Point], half_width: f64) {
        if let [only] = points {
            self.capsule(*only, *only, half_width);
        }
        for (&from, &to) in points.iter().zip(points.iter().skip(1)) {
            // Short pieces keep the boxes that are searched for covered pixels small.
            let pieces = ((to.0 - from.0).hypot(to.1 - from.1) / 12.0).ceil().clamp(1.0, 1e4) as u32;
            let at = |i: u32| {
                let t = f64::from(i) / f64::from(pieces);
                (from.0 + t * (to.0 - from.0), from.1 + t * (to.1 - from.1))
            };
            for i in 0..pieces {
                self.capsule(at(i), at(i + 1), half_width);
            }
        }
    }

    fn capsule(&mut self, from: Point, to: Point, half_width: f64) {
        let reach = half_width + 1.0;
        let (dx, dy) = (to.0 - from.0, to.1 - from.1);
        let square = dx * dx + dy * dy;
        let span = |a: f64, b: f64| ((a.min(b) - reach).floor() as i32)..=((a.max(b) + reach).ceil() as i32);
        for y in span(from.1, to.1) {
            for x in span(from.0, to.0) {
                let (px, py) = (f64::from(x) + 0.5 - from.0, f64::from(y) + 0.5 - from.1);
                let t = if square > 0.0 { ((px * dx + py * dy) / square).clamp(0.0, 1.0) } else { 0.0 };
                let (x_off, y_off) = (px - t * dx, py - t * dy);
                let distance = (x_off * x_off + y_off * y_off).sqrt();
                let part = (half_width + 0.5 - distance).clamp(0.0, (2.0 * half_width).min(1.0));
                if part > 0.0 {
                    self.cover(x, y, part);
                }
            }
        }
    }

    /// The area between two lines over common x, in pixels.
    pub(super) fn area(&mut self, x: &[f64], upper: &[f64], lower: &[f64]) {
        let nodes: Vec<_> = x.iter().zip(upper).zip(lower).map(|((x, u), l)| (*x, *u, *l)).collect();
        for (a, b) in nodes.iter().zip(nodes.iter().skip(1)) {
            let (a, b) = if a.0 <= b.0 { (a, b) } else { (b, a) };
            for column in (a.0 - 0.5).ceil() as i32..(b.0 - 0.5).ceil() as i32 {
                let t = (f64::from(column) + 0.5 - a.0) / (b.0 - a.0);
                let (top, bottom) = (a.1 + t * (b.1 - a.1), a.2 + t * (b.2 - a.2));
                let (top, bottom) = (top.min(bottom), top.max(bottom));
                for y in top.floor() as i32..bottom.ceil() as i32 {
                    let part = bottom.min(f64::from(y) + 1.0) - top.max(f64::from(y));
                    self.cover(column, y, part.clamp(0.0, 1.0));
                }
            }
        }
    }

    /// Hands out the covered pixels with their coverage from 0 to 1, and forgets the shape.
    pub(super) fn drain(&mut self, mut paint: impl FnMut((i32, i32), f64)) {
        let touched = std::mem::take(&mut self.touched);
        for &(x, y) in &touched {
            if let Some(cell) = self.cell(x, y) {
                let part = f64::from(std::mem::take(cell)) / 255.0;
                paint((x, y), part);
            }
        }
        self.touched = touched;
        self.touched.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn total(mask: &mut Mask) -> f64 {
        let mut sum = 0.0;
        mask.drain(|_, part| sum += part);
        sum
    }

    #[test]
    fn coverage_adds_up_to_the_area_of_the_shape() {
        let mut mask = Mask::new(200, 200);
        mask.stroke(&[(100.0, 100.0)], 20.0);
        // One bit in 256 of rounding per pixel of the rim, and the curvature of the rim.
        approx::assert_relative_eq!(total(&mut mask), std::f64::consts::PI * 400.0, max_relative = 2e-3);
        mask.stroke(&[(20.3, 30.1), (160.7, 130.9), (20.3, 30.1)], 3.0);
        let length = (140.4f64).hypot(100.8);
        let expected = 6.0 * length + std::f64::consts::PI * 9.0;
        approx::assert_relative_eq!(total(&mut mask), expected, max_relative = 5e-3);
        mask.area(&[10.0, 110.0], &[20.5, 70.5], &[70.25, 70.5]);
        approx::assert_relative_eq!(total(&mut mask), 0.5 * 49.75 * 100.0, max_relative = 5e-3);
        mask.stroke(&[(-1e3, -1e3), (-500.0, 3e4)], 3.0);
        assert_eq!(total(&mut mask), 0.0);
    }
}
