//! A figure laid out: a list of marks in logical pixels, x to the right and y downwards.

use super::colour::Colour;
use super::readings::Readable;
use super::text;

/// A position in logical pixels.
pub(super) type Point = (f64, f64);

/// A rectangle in logical pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rect {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) right: f64,
    pub(super) bottom: f64,
}

impl Rect {
    pub(super) fn width(&self) -> f64 {
        self.right - self.left
    }

    pub(super) fn height(&self) -> f64 {
        self.bottom - self.top
    }

    /// Left, top, right, bottom.
    pub(super) fn sides(&self) -> [f64; 4] {
        [self.left, self.top, self.right, self.bottom]
    }

    pub(super) fn contains(&self, (x, y): Point) -> bool {
        (self.left..=self.right).contains(&x) && (self.top..=self.bottom).contains(&y)
    }

    pub(super) fn overlaps(&self, other: &Self) -> bool {
        self.left < other.right
            && other.left < self.right
            && self.top < other.bottom
            && other.top < self.bottom
    }

    pub(super) fn grown(&self, by: f64) -> Self {
        Self { left: self.left - by, top: self.top - by, right: self.right + by, bottom: self.bottom + by }
    }

    /// Position at these fractions of the width, from the left, and of the height, from the bottom.
    pub(super) fn at(&self, x: f64, y: f64) -> Point {
        (self.left + x * self.width(), self.bottom - y * self.height())
    }
}

/// Which part of a line of text stands at its position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// One thing to paint.
#[derive(Debug, Clone)]
pub(super) enum Mark {
    /// A filled rectangle.
    Rect { area: Rect, colour: Colour },
    /// A line with round joins and ends.
    Stroke { points: Vec<Point>, width: f64, colour: Colour },
    /// The area between two lines with common x, from left to right.
    Area { x: Vec<f64>, upper: Vec<f64>, lower: Vec<f64>, colour: Colour },
    /// A filled circle.
    Disc { centre: Point, radius: f64, colour: Colour },
    /// A raster of colours, row after row from the top.
    Image { area: Rect, columns: usize, pixels: Vec<(u8, u8, u8)> },
    /// A line of text on a baseline through `at`; upwards when turned.
    Text { at: Point, text: String, size: f64, colour: Colour, anchor: Anchor, turned: bool },
}

/// All marks, in the order of painting.
#[derive(Debug, Clone)]
pub(super) struct Scene {
    pub(super) title: String,
    pub(super) width: f64,
    pub(super) height: f64,
    pub(super) marks: Vec<Mark>,
    /// Panels whose numbers can be read off.
    pub(super) readable: Vec<Readable>,
}

impl Scene {
    pub(super) fn new(title: &str, width: f64) -> Self {
        Self { title: text::clean(title), width, height: 0.0, marks: Vec::new(), readable: Vec::new() }
    }

    pub(super) fn line(&mut self, from: Point, to: Point, width: f64, colour: Colour) {
        self.marks.push(Mark::Stroke { points: vec![from, to], width, colour });
    }

    pub(super) fn fill(&mut self, area: Rect, colour: Colour) {
        self.marks.push(Mark::Rect { area, colour });
    }

    pub(super) fn outline(&mut self, area: Rect, width: f64, colour: Colour) {
        let Rect { left, top, right, bottom } = area;
        let points = vec![(left, top), (right, top), (right, bottom), (left, bottom), (left, top)];
        self.marks.push(Mark::Stroke { points, width, colour });
    }

    pub(super) fn text(&mut self, at: Point, text: &str, size: f64, colour: Colour, anchor: Anchor) {
        let text = text::clean(text);
        self.marks.push(Mark::Text { at, text, size, colour, anchor, turned: false });
    }

    /// Text that reads upwards.
    pub(super) fn turned(&mut self, at: Point, text: &str, size: f64, colour: Colour, anchor: Anchor) {
        let text = text::clean(text);
        self.marks.push(Mark::Text { at, text, size, colour, anchor, turned: true });
    }
}
