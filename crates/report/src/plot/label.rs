//! Where labels inside a panel go: beside what they name, within the frame, off the curves.

use super::colour::{Colour, INK, WHITE};
use super::scene::{Anchor, Point, Rect, Scene};
use super::symbol::draw_ring;
use super::text;

pub(super) const SIZE: f64 = 11.0;
const PADDING: f64 = 2.5;
const LONGEST: f64 = 210.0;
const MOST_LINES: usize = 8;
/// Radius of the ring of a marker, and of what it takes.
const RING: f64 = 6.5;
const RIM: f64 = 8.0;
/// Contour labels keep so far from other labels.
const CLEAR: f64 = 9.0;

/// Lines of a label and the room they need.
#[derive(Debug, Clone)]
pub(super) struct Label {
    lines: Vec<String>,
    width: f64,
    height: f64,
}

impl Label {
    pub(super) fn new(text: &str) -> Option<Self> {
        let lines = text::wrap_at_most(text, SIZE, LONGEST, MOST_LINES);
        let width = lines.iter().map(|line| text::width(line, SIZE)).fold(0.0, f64::max) + 2.0 * PADDING;
        let height = lines.len() as f64 * SIZE * text::LEADING + PADDING;
        (!lines.is_empty()).then_some(Self { lines, width, height })
    }

    fn at(&self, left: f64, top: f64) -> Rect {
        Rect { left, top, right: left + self.width, bottom: top + self.height }
    }

    fn draw(&self, scene: &mut Scene, area: Rect, colour: Colour) {
        scene.fill(area, WHITE.opacity(0.8));
        for (i, line) in self.lines.iter().enumerate() {
            let baseline = area.top + SIZE * (0.98 + i as f64 * text::LEADING) + 0.5 * PADDING;
            scene.text((area.left + PADDING, baseline), line, SIZE, colour, Anchor::Start);
        }
    }
}

/// Finds free places in one panel.
#[derive(Debug)]
pub(super) struct Placer {
    frame: Rect,
    taken: Vec<Rect>,
    ink: Vec<Point>,
}

impl Placer {
    pub(super) fn new(frame: Rect) -> Self {
        Self { frame, taken: Vec::new(), ink: Vec::new() }
    }

    /// Notes a drawn line: labels keep off it if they can.
    pub(super) fn avoid_line(&mut self, line: &[Point]) {
        self.ink.extend(line.first());
        for (&from, &to) in line.iter().zip(line.iter().skip(1)) {
            let pieces = ((to.0 - from.0).hypot(to.1 - from.1) / 4.0).ceil().clamp(1.0, 1e3);
            if pieces == 1.0 && self.ink.last().is_some_and(|p| (p.0 - to.0).hypot(p.1 - to.1) < 2.0) {
                continue;
            }
            let step = |i: u32| f64::from(i) / pieces;
            self.ink.extend(
                (1..=pieces as u32)
                    .map(|i| (from.0 + step(i) * (to.0 - from.0), from.1 + step(i) * (to.1 - from.1))),
            );
        }
    }

    /// The first of the least bad places, which is then taken.
    fn best(&mut self, places: impl IntoIterator<Item = Rect>) -> Option<Rect> {
        let mut best: Option<(f64, Rect)> = None;
        for (rank, place) in places.into_iter().enumerate() {
            let place = self.pushed_inside(place, 4.0);
            let collisions = self.taken.iter().filter(|taken| taken.overlaps(&place)).count();
            let inked = self.ink.iter().filter(|point| place.contains(**point)).count();
            let cost = 1e4 * collisions as f64 + inked.min(500) as f64 + 0.3 * rank as f64;
            if best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, place));
            }
        }
        let (_, place) = best?;
        self.taken.push(place);
        Some(place)
    }

    /// Moves a place that sticks out of the frame back into it.
    fn pushed_inside(&self, place: Rect, margin: f64) -> Rect {
        let shift = |low: f64, high: f64, from: f64, to: f64| {
            if low < from + margin { from + margin - low } else { (to - margin - high).min(0.0) }
        };
        let dx = shift(place.left, place.right, self.frame.left, self.frame.right);
        let dy = shift(place.top, place.bottom, self.frame.top, self.frame.bottom);
        Rect {
            left: place.left + dx,
            right: place.right + dx,
            top: place.top + dy,
            bottom: place.bottom + dy,
        }
    }

    /// Draws rings around points and labels them; no label is over a ring.
    pub(super) fn points(&mut self, scene: &mut Scene, points: &[(Point, &str)]) {
        for (at, _) in points {
            draw_ring(scene, *at, RING);
            let around = Rect { left: at.0, right: at.0, top: at.1, bottom: at.1 };
            self.taken.push(around.grown(RIM));
        }
        points.iter().for_each(|(at, text)| self.point(scene, *at, text));
    }

    /// Labels a point.
    fn point(&mut self, scene: &mut Scene, at: Point, text: &str) {
        self.beside(scene, at, text, &[10.0, 20.0, 38.0, 62.0]);
    }

    /// Labels points of an image from some way off, so that what is there stays in view.
    pub(super) fn away(&mut self, scene: &mut Scene, points: &[(Point, String)]) {
        let around = |(x, y): Point| Rect { left: x, right: x, top: y, bottom: y }.grown(PADDING);
        self.taken.extend(points.iter().map(|(at, _)| around(*at)));
        points.iter().for_each(|(at, text)| self.beside(scene, *at, text, &[30.0, 45.0, 62.0]));
    }

    fn beside(&mut self, scene: &mut Scene, (x, y): Point, text: &str, gaps: &[f64]) {
        let Some(label) = Label::new(text) else { return };
        let (w, h) = (label.width, label.height);
        let mut places = Vec::new();
        for &gap in gaps {
            let diagonal = 0.7 * gap;
            places.extend([
                label.at(x + gap, y - 0.5 * h),
                label.at(x + diagonal, y - h - diagonal),
                label.at(x + diagonal, y + diagonal),
                label.at(x - w - gap, y - 0.5 * h),
                label.at(x - w - diagonal, y - h - diagonal),
                label.at(x - w - diagonal, y + diagonal),
                label.at(x - 0.5 * w, y - h - gap),
                label.at(x - 0.5 * w, y + gap),
            ]);
        }
        let Some(area) = self.best(places) else { return };
        let near = (x.clamp(area.left, area.right), y.clamp(area.top, area.bottom));
        let distance = (near.0 - x).hypot(near.1 - y);
        if distance > 13.0 {
            let rim = RIM / distance;
            scene.line((x + rim * (near.0 - x), y + rim * (near.1 - y)), near, 0.8, INK);
        }
        label.draw(scene, area, INK);
    }

    /// Labels a horizontal line.
    pub(super) fn along(&mut self, scene: &mut Scene, y: f64, text: &str, colour: Colour) {
        let Some(label) = Label::new(text) else { return };
        let room = (self.frame.width() - label.width).max(0.0);
        let places = [0.01, 0.99, 0.25, 0.5, 0.75].into_iter().flat_map(|part| {
            let left = self.frame.left + part * room;
            [label.at(left, y - label.height - 1.5), label.at(left, y + 1.5)]
        });
        let places: Vec<_> = places.collect();
        if let Some(area) = self.best(places) {
            label.draw(scene, area, colour);
        }
    }

    /// Labels a vertical line, the text reading upwards beside it.
    pub(super) fn upwards(&mut self, scene: &mut Scene, x: f64, text: &str, colour: Colour) {
        let lines = text::wrap_at_most(text, SIZE, self.frame.height() - 12.0, MOST_LINES);
        let longest = lines.iter().map(|line| text::width(line, SIZE)).fold(0.0, f64::max);
        let leading = SIZE * text::LEADING;
        let (w, h) = (lines.len() as f64 * leading + PADDING, longest + 2.0 * PADDING);
        if lines.is_empty() {
            return;
        }
        let room = (self.frame.height() - h).max(0.0);
        let places = [0.01, 0.99, 0.5].into_iter().flat_map(|part| {
            let top = self.frame.top + part * room;
            [x + 1.5, x - 1.5 - w].map(|left| Rect { left, top, right: left + w, bottom: top + h })
        });
        let places: Vec<_> = places.collect();
        if let Some(area) = self.best(places) {
            scene.fill(area, WHITE.opacity(0.8));
            for (i, line) in lines.iter().enumerate() {
                let at = (area.left + SIZE + 0.5 * PADDING + i as f64 * leading, area.bottom - PADDING);
                scene.turned(at, line, SIZE, colour, Anchor::Start);
            }
        }
    }

    /// Labels a contour line at one of its points; left out where there is no room.
    pub(super) fn on_line(&mut self, scene: &mut Scene, line: &[Point], text: &str) {
        let Some(label) = Label::new(text) else { return };
        let count = line.len();
        for part in [10, 5, 15, 3, 17, 8, 12] {
            let Some((x, y)) = line.get(count * part / 20) else { continue };
            let area = label.at(x - 0.5 * label.width, y - 0.5 * label.height);
            let inside = self.frame.grown(-6.0);
            let fits = inside.contains((area.left, area.top)) && inside.contains((area.right, area.bottom));
            if fits && !self.taken.iter().any(|taken| taken.overlaps(&area.grown(CLEAR))) {
                self.taken.push(area);
                label.draw(scene, area, INK);
                return;
            }
        }
    }
}
