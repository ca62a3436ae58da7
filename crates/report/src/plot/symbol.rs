//! Symbols of points, told apart by shape as well as by colour, filled or open.

use super::colour::{Colour, INK, WHITE};
use super::scene::{Mark, Point, Rect, Scene};
use hadar::order;

/// Width of the line of an open symbol, and of the white rim around symbols.
const LINE: f64 = 1.3;
const RIM: f64 = 0.8;

/// What is drawn around the position of a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shape {
    Disc,
    Square,
    Diamond,
    Triangle,
    /// A triangle that points to the left.
    Left,
    /// A triangle that points to the right.
    Right,
}

impl Shape {
    /// Shape of the series with this index.
    pub(super) fn series(index: usize) -> Self {
        match index % 4 {
            0 => Self::Disc,
            1 => Self::Square,
            2 => Self::Diamond,
            _ => Self::Triangle,
        }
    }

    /// From the centre to the corners (the rim of a disc), for areas about as large as that of a disc of
    /// radius 1; and how much that shrinks when all sides move inwards by 1.
    fn size(self) -> (f64, f64) {
        match self {
            Self::Disc => (1.0, 1.0),
            Self::Square => (0.9, 1.0),
            Self::Diamond => (1.27, std::f64::consts::SQRT_2),
            Self::Triangle | Self::Left | Self::Right => (1.4, 2.0),
        }
    }

    /// `reach`: half a side of a square, from the centre to the corners of the others.
    fn mark(self, (x, y): Point, reach: f64, colour: Colour) -> Mark {
        // Half a side of the triangle, and from its centre to the middle of a side.
        let (half, back) = (0.866 * reach, 0.5 * reach);
        let sideways = |tip: f64, base: f64| {
            let mut ends = [(tip, 0.0), (base, half)];
            order::ascending(&mut ends, |a| a.0);
            let along = ends.map(|(x, _)| x).to_vec();
            let (upper, lower) = (ends.map(|(_, h)| y - h).to_vec(), ends.map(|(_, h)| y + h).to_vec());
            Mark::Area { x: along, upper, lower, colour }
        };
        match self {
            Self::Disc => Mark::Disc { centre: (x, y), radius: reach, colour },
            Self::Square => {
                let area = Rect { left: x, right: x, top: y, bottom: y }.grown(reach);
                Mark::Rect { area, colour }
            }
            Self::Diamond => Mark::Area {
                x: vec![x - reach, x, x + reach],
                upper: vec![y, y - reach, y],
                lower: vec![y, y + reach, y],
                colour,
            },
            Self::Triangle => Mark::Area {
                x: vec![x - half, x, x + half],
                upper: vec![y + back, y - reach, y + back],
                lower: vec![y + back; 3],
                colour,
            },
            Self::Left => sideways(x - reach, x + back),
            Self::Right => sideways(x + reach, x - back),
        }
    }
}

/// A ring that is seen on any colour and leaves what is in it open to view.
pub(super) fn draw_ring(scene: &mut Scene, (x, y): Point, radius: f64) {
    let round = |i: u32| std::f64::consts::TAU * f64::from(i) / 48.0;
    let points: Vec<Point> =
        (0..=48).map(|i| (x + radius * round(i).cos(), y + radius * round(i).sin())).collect();
    for (width, colour) in [(4.0, WHITE), (1.8, INK)] {
        scene.marks.push(Mark::Stroke { points: points.clone(), width, colour });
    }
}

/// A shape in its colour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Symbol {
    pub(super) shape: Shape,
    pub(super) colour: Colour,
    /// White inside.
    pub(super) open: bool,
}

impl Symbol {
    /// Draws what keeps the symbol apart from lines below it.
    pub(super) fn draw_rim(&self, scene: &mut Scene, centre: Point, radius: f64) {
        let (reach, inwards) = self.shape.size();
        scene.marks.push(self.shape.mark(centre, reach * radius + inwards * RIM, WHITE));
    }

    /// Draws the symbol about as large as a disc of this radius.
    pub(super) fn draw(&self, scene: &mut Scene, centre: Point, radius: f64) {
        let (reach, inwards) = self.shape.size();
        let reach = reach * radius;
        scene.marks.push(self.shape.mark(centre, reach, self.colour));
        let inner = reach - inwards * LINE;
        if self.open && inner > 0.0 {
            scene.marks.push(self.shape.mark(centre, inner, WHITE));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Area that a mark covers.
    fn area(mark: &Mark) -> f64 {
        match mark {
            Mark::Disc { radius, .. } => std::f64::consts::PI * radius * radius,
            Mark::Rect { area, .. } => area.width() * area.height(),
            Mark::Area { x, upper, lower, .. } => (1..x.len())
                .map(|i| 0.5 * (x[i] - x[i - 1]) * (lower[i] - upper[i] + lower[i - 1] - upper[i - 1]))
                .sum(),
            _ => 0.0,
        }
    }

    #[test]
    fn symbols_are_about_as_large_as_a_disc() {
        for shape in (0..4).map(Shape::series).chain([Shape::Left, Shape::Right]) {
            let part = area(&shape.mark((5.0, 5.0), shape.size().0, WHITE)) / std::f64::consts::PI;
            assert!((0.8..=1.05).contains(&part), "{shape:?} {part}");
        }
    }

    #[test]
    fn the_line_of_an_open_symbol_is_equally_wide_on_all_sides() {
        // Sides at a distance d from the centre enclose an area k d²: shrinking by 1 in d at d = 10.
        for shape in (0..4).map(Shape::series).chain([Shape::Left, Shape::Right]) {
            let (_, inwards) = shape.size();
            let at = |distance: f64| area(&shape.mark((0.0, 0.0), inwards * distance, WHITE)).sqrt();
            assert!((at(9.0) / at(10.0) - 0.9).abs() < 1e-9, "{shape:?}");
            // The apothem: the area is half of the circumference times it.
            let sides = match shape {
                Shape::Disc => continue,
                Shape::Square | Shape::Diamond => 4.0,
                _ => 3.0,
            };
            let expected = (sides * 100.0 * (std::f64::consts::PI / sides).tan()).sqrt();
            assert!((at(10.0) / expected - 1.0).abs() < 1e-3, "{shape:?}");
        }
    }
}
