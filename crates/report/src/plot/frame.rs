//! What surrounds the data: heading, axes with their ticks and titles, grid.
//!
//! Every margin follows from the measured width of the text in it.

use super::axis::{Axis, Ruler, Scale, Secondary};
use super::colour::{FINE_GRID, GREY, GRID, INK};
use super::scene::{Anchor, Rect, Scene};
use super::text::{self, LEADING};
use super::ticks::Ticks;
use hadar::order;

/// Width of every figure in logical pixels.
pub(super) const WIDTH: f64 = 800.0;
pub(super) const TICK: f64 = 11.5;
const TITLE: f64 = 16.0;
const SUBTITLE: f64 = 11.5;
pub(super) const AXIS_TITLE: f64 = 12.5;
pub(super) const EDGE: f64 = 12.0;
/// Most lines of an axis title.
const MOST_LINES: usize = 6;
/// From the frame to the tick labels.
const LABEL_GAP: f64 = 8.0;

/// Draws title and subtitle; returns where they end.
pub(super) fn heading(scene: &mut Scene, title: &str, subtitle: &str) -> f64 {
    let mut y = EDGE;
    for (words, size, colour, most) in [(title, TITLE, INK, 4), (subtitle, SUBTITLE, GREY, 6)] {
        for line in text::wrap_at_most(words, size, scene.width - 2.0 * EDGE, most) {
            y += size * LEADING;
            scene.text((EDGE, y - 0.3 * size), &line, size, colour, Anchor::Start);
        }
    }
    y + 6.0
}

/// A vertical axis of known height.
#[derive(Debug)]
pub(super) struct Vertical {
    pub(super) ruler: Ruler,
    ticks: Ticks,
    title: Vec<String>,
    secondary: Option<Secondary>,
}

impl Vertical {
    pub(super) fn new(axis: &Axis, ruler: Ruler, height: f64) -> Self {
        let spacing = if axis.scale == Scale::Log { 26.0 } else { 48.0 };
        let mut wanted = (height / spacing) as usize;
        let mut ticks = Ticks::new(&ruler, wanted);
        // One or two numbers do not make a scale.
        while ticks.major.len() < 3 && (wanted as f64) < height / (2.0 * TICK) {
            wanted += 1;
            ticks = Ticks::new(&ruler, wanted);
        }
        let title = broken_title(&axis.title, height + 20.0);
        Self { ruler, ticks, title, secondary: axis.secondary.clone() }
    }

    /// Width that the second reading needs at the right of the frame.
    pub(super) fn room_right(&self) -> f64 {
        self.secondary.as_ref().map_or(0.0, |secondary| {
            let labels = secondary.ticks.iter().map(|(_, label)| text::width(label, TICK));
            LABEL_GAP + labels.fold(0.0, f64::max) + 6.0 + AXIS_TITLE * LEADING
        })
    }

    /// The second reading at the right of the frame; labels that would touch their neighbour are left out.
    pub(super) fn draw_secondary(&self, scene: &mut Scene, frame: &Rect) {
        let Some(Secondary { title, ticks }) = &self.secondary else { return };
        let place = |value: f64| self.ruler.fraction(value).filter(|at| (-1e-9..=1.0 + 1e-9).contains(at));
        // From the last one on, which is certainty.
        let mut free_from = f64::NEG_INFINITY;
        for (at, label) in ticks.iter().rev().filter_map(|(value, label)| Some((place(*value)?, label))) {
            let (x, y) = frame.at(1.0, at);
            scene.line((x, y), (x + 4.5, y), 0.7, INK);
            if y >= free_from {
                scene.text((x + LABEL_GAP, y + 0.36 * TICK), label, TICK, INK, Anchor::Start);
                free_from = y + TICK;
            }
        }
        let middle = (frame.right + self.room_right() - 0.3 * AXIS_TITLE, 0.5 * (frame.top + frame.bottom));
        scene.turned(middle, title, AXIS_TITLE, INK, Anchor::Middle);
    }

    fn labels_width(&self) -> f64 {
        let labels = self.ticks.major.iter().map(|(_, label)| label).chain(&self.ticks.multiplier);
        labels.map(|label| text::width(label, TICK)).fold(0.0, f64::max)
    }

    fn title_width(&self) -> f64 {
        self.title.len() as f64 * AXIS_TITLE * LEADING
    }

    /// Width that title and labels need beside the frame.
    pub(super) fn room(&self) -> f64 {
        EDGE + self.title_width() + self.labels_width() + LABEL_GAP + 6.0
    }

    pub(super) fn has_multiplier(&self) -> bool {
        self.ticks.multiplier.is_some()
    }

    pub(super) fn draw_grid(&self, scene: &mut Scene, frame: &Rect) {
        let minor = self.ticks.minor.iter().map(|at| (*at, FINE_GRID));
        for (at, colour) in minor.chain(self.ticks.major.iter().map(|(at, _)| (*at, GRID))) {
            let (_, y) = frame.at(0.0, at);
            scene.line((frame.left, y), (frame.right, y), 0.7, colour);
        }
    }

    /// Ticks, labels and title at the left of the frame; `raise` lifts the common power of ten.
    pub(super) fn draw_left(&self, scene: &mut Scene, frame: &Rect, raise: f64) {
        for at in &self.ticks.minor {
            let (x, y) = frame.at(0.0, *at);
            scene.line((x - 2.5, y), (x, y), 0.7, INK);
        }
        for (at, label) in &self.ticks.major {
            let (x, y) = frame.at(0.0, *at);
            scene.line((x - 4.5, y), (x, y), 0.7, INK);
            scene.text((x - LABEL_GAP, y + 0.36 * TICK), label, TICK, INK, Anchor::End);
        }
        if let Some(factor) = &self.ticks.multiplier {
            let at = (frame.left - LABEL_GAP, frame.top - 10.0 - raise);
            scene.text(at, factor, TICK, INK, Anchor::End);
        }
        let middle = 0.5 * (frame.top + frame.bottom);
        for (i, line) in self.title.iter().enumerate() {
            let x = EDGE + AXIS_TITLE * (0.8 + i as f64 * LEADING);
            scene.turned((x, middle), line, AXIS_TITLE, INK, Anchor::Middle);
        }
    }

    /// Ticks, labels and title at the right of a colour bar; they take [`Self::room`].
    pub(super) fn draw_right(&self, scene: &mut Scene, bar: &Rect) {
        for at in &self.ticks.minor {
            let (x, y) = bar.at(1.0, *at);
            scene.line((x, y), (x + 2.5, y), 0.7, INK);
        }
        for (at, label) in &self.ticks.major {
            let (x, y) = bar.at(1.0, *at);
            scene.line((x, y), (x + 4.5, y), 0.7, INK);
            scene.text((x + LABEL_GAP, y + 0.36 * TICK), label, TICK, INK, Anchor::Start);
        }
        if let Some(factor) = &self.ticks.multiplier {
            scene.text((bar.right + LABEL_GAP, bar.top - 10.0), factor, TICK, INK, Anchor::Start);
        }
        let middle = 0.5 * (bar.top + bar.bottom);
        for (i, line) in self.title.iter().enumerate() {
            let left = bar.right + LABEL_GAP + self.labels_width() + 6.0;
            let x = left + AXIS_TITLE * (0.9 + i as f64 * LEADING);
            scene.turned((x, middle), line, AXIS_TITLE, INK, Anchor::Middle);
        }
    }
}

/// A horizontal axis of known width.
#[derive(Debug)]
pub(super) struct Horizontal {
    pub(super) ruler: Ruler,
    ticks: Ticks,
    title: Vec<String>,
    secondary: Option<Secondary>,
}

impl Horizontal {
    /// As many labelled ticks as fit beside each other.
    pub(super) fn new(axis: &Axis, ruler: Ruler, width: f64) -> Self {
        let spacing = if axis.scale == Scale::Log { 48.0 } else { 75.0 };
        let mut wanted = (width / spacing) as usize;
        let mut ticks = Ticks::new(&ruler, wanted);
        while wanted > 2 && !fit(&ticks, width) {
            wanted -= 1;
            ticks = Ticks::new(&ruler, wanted);
        }
        let aside = ticks.multiplier.as_ref().map_or(0.0, |factor| 2.0 * text::width(factor, TICK) + 20.0);
        let title = broken_title(&axis.title, width - aside);
        Self { ruler, ticks, title, secondary: axis.secondary.clone() }
    }

    /// Width that the last label needs at the right of the frame.
    pub(super) fn room(&self) -> f64 {
        let last = |(at, label): &(f64, String)| if *at > 0.9 { 0.5 * text::width(label, TICK) } else { 0.0 };
        self.ticks.major.iter().map(last).fold(0.0, f64::max) + EDGE
    }

    /// Height that the second reading needs above the frame.
    pub(super) fn room_above(&self) -> f64 {
        match &self.secondary {
            Some(Secondary { title, .. }) if !title.is_empty() => 36.0,
            Some(_) => 20.0,
            None => 0.0,
        }
    }

    pub(super) fn draw_grid(&self, scene: &mut Scene, frame: &Rect) {
        let minor = self.ticks.minor.iter().map(|at| (*at, FINE_GRID));
        for (at, colour) in minor.chain(self.ticks.major.iter().map(|(at, _)| (*at, GRID))) {
            let (x, _) = frame.at(at, 0.0);
            scene.line((x, frame.top), (x, frame.bottom), 0.7, colour);
        }
    }

    /// Tick marks only, for a panel whose labels stand under another one.
    pub(super) fn draw_ticks(&self, scene: &mut Scene, frame: &Rect) {
        let minor = self.ticks.minor.iter().map(|at| (*at, 2.5));
        for (at, length) in minor.chain(self.ticks.major.iter().map(|(at, _)| (*at, 4.5))) {
            let (x, y) = frame.at(at, 0.0);
            scene.line((x, y), (x, y + length), 0.7, INK);
        }
    }

    /// Labels and title below the frame; returns where they end.
    pub(super) fn draw_labels(&self, scene: &mut Scene, frame: &Rect) -> f64 {
        let mut y = frame.bottom + LABEL_GAP + TICK;
        for (at, label) in &self.ticks.major {
            scene.text((frame.at(*at, 0.0).0, y), label, TICK, INK, Anchor::Middle);
        }
        y += 3.0;
        if let Some(factor) = &self.ticks.multiplier {
            scene.text((frame.right, y + AXIS_TITLE * LEADING), factor, TICK, INK, Anchor::End);
        }
        for line in &self.title {
            y += AXIS_TITLE * LEADING;
            scene.text((0.5 * (frame.left + frame.right), y), line, AXIS_TITLE, INK, Anchor::Middle);
        }
        y + 10.0
    }

    /// Height that [`Self::draw_labels_above`] needs.
    pub(super) fn room_for_labels(&self) -> f64 {
        // A common power of ten would have to be repeated as well.
        if self.secondary.is_some() || self.ticks.multiplier.is_some() { 0.0 } else { LABEL_GAP + TICK }
    }

    /// The labels once more above a tall frame, where there is room; none near the position given.
    pub(super) fn draw_labels_above(&self, scene: &mut Scene, frame: &Rect, taken: Option<f64>) {
        if self.room_for_labels() == 0.0 {
            return;
        }
        for (at, label) in &self.ticks.major {
            let (x, y) = frame.at(*at, 1.0);
            scene.line((x, y - 4.5), (x, y), 0.7, INK);
            let half = 0.5 * text::width(label, TICK) + 4.0;
            if taken.is_none_or(|taken| (taken - x).abs() > half) {
                scene.text((x, y - LABEL_GAP), label, TICK, INK, Anchor::Middle);
            }
        }
    }

    /// The second reading above the frame; labels that would touch their neighbour are left out.
    pub(super) fn draw_secondary(&self, scene: &mut Scene, frame: &Rect) {
        let Some(Secondary { title, ticks }) = &self.secondary else { return };
        let mut places: Vec<(f64, &str)> = ticks
            .iter()
            .filter_map(|(value, label)| Some((self.ruler.fraction(*value)?, label.as_str())))
            .filter(|(at, _)| (-1e-9..=1.0 + 1e-9).contains(at))
            .map(|(at, label)| (frame.at(at, 1.0).0, label))
            .collect();
        order::ascending(&mut places, |a| a.0);
        let mut free_from = frame.left - 30.0;
        for (x, label) in places {
            scene.line((x, frame.top - 4.5), (x, frame.top), 0.7, INK);
            let half = 0.5 * text::width(label, TICK);
            if x - half < free_from || x + half > scene.width - 4.0 {
                continue;
            }
            scene.text((x, frame.top - LABEL_GAP), label, TICK, INK, Anchor::Middle);
            free_from = x + half + 6.0;
        }
        if let Some(line) = text::wrap_at_most(title, AXIS_TITLE, frame.width(), 1).first() {
            let at = (0.5 * (frame.left + frame.right), frame.top - LABEL_GAP - 16.0);
            scene.text(at, line, AXIS_TITLE, INK, Anchor::Middle);
        }
    }
}

/// An axis title in lines; one that is too long breaks before its unit.
fn broken_title(title: &str, limit: f64) -> Vec<String> {
    let whole = text::wrap_at_most(title, AXIS_TITLE, limit, MOST_LINES);
    match title.split_once(" (") {
        Some((name, unit)) if whole.len() > 1 => {
            text::wrap_at_most(&format!("{name}\n({unit}"), AXIS_TITLE, limit, MOST_LINES)
        }
        _ => whole,
    }
}

fn fit(ticks: &Ticks, width: f64) -> bool {
    let mut ends: Vec<(f64, f64)> = ticks
        .major
        .iter()
        .map(|(at, label)| (at * width, 0.5 * text::width(label, TICK)))
        .map(|(x, half)| (x - half, x + half))
        .collect();
    order::ascending(&mut ends, |a| a.0);
    ends.iter().zip(ends.iter().skip(1)).all(|(a, b)| a.1 + 10.0 <= b.0)
}
