//! The legend: outside of the data, below the plot when short, in a column at its right when long.

use super::colour::{Colour, GREY, INK, WHITE};
use super::geometry;
use super::scene::{Anchor, Mark, Point, Rect, Scene};
use super::symbol::Symbol;
use super::text;

const SIZE: f64 = 11.5;
const KEY: f64 = 26.0;
const GAP: f64 = 6.0;
pub(super) const LINE: f64 = 15.0;
/// Widest text of an entry in the column at the right.
const COLUMN: f64 = 190.0;
/// Most entries that are drawn; the rest is counted.
const MOST: usize = 120;

/// Most lines of an entry.
const MOST_LINES: usize = 8;

/// Widths and colours of a line that is seen on any colour.
pub(super) const CASED: [(f64, Colour); 2] = [(2.8, INK), (1.2, WHITE)];

/// What an entry looks like in the plot.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Key {
    Line {
        colour: Colour,
        dash: &'static [f64],
    },
    /// A line with a symbol on it.
    Marked {
        symbol: Symbol,
        dash: &'static [f64],
    },
    Area {
        colour: Colour,
    },
    Hatched,
    /// A light line with a dark rim, that is seen on any colour.
    Cased,
    /// A patch of colour with a dot.
    Dotted {
        colour: Colour,
        ink: Colour,
    },
    /// A symbol, on a patch of colour where `ground` is given.
    Symbol {
        symbol: Symbol,
        ground: Option<Colour>,
    },
    /// A thin line with a point.
    Whisker {
        colour: Colour,
    },
}

/// A legend entry before it has a place.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Entry {
    pub(super) key: Key,
    pub(super) label: String,
}

/// Where the legend goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    Below,
    Right,
}

/// A legend with its lines broken.
#[derive(Debug, Clone)]
pub(super) struct Legend {
    entries: Vec<(Key, Vec<String>)>,
    more: usize,
    side: Side,
}

impl Legend {
    /// Chooses side and lines: rows of this `width`, or a column no higher than `highest`.
    pub(super) fn new(entries: Vec<Entry>, width: f64, highest: f64) -> Self {
        let mut entries: Vec<Entry> =
            entries.into_iter().filter(|entry| !text::clean(&entry.label).is_empty()).collect();
        let more = entries.len().saturating_sub(MOST);
        entries.truncate(MOST);
        let broken = |limit: f64| -> Vec<(Key, Vec<String>)> {
            let lines = |entry: &Entry| broken(&entry.label, limit, MOST_LINES);
            entries.iter().map(|entry| (entry.key.clone(), lines(entry))).collect()
        };
        if entries.len() > 4 {
            let legend = Self { entries: broken(COLUMN), more, side: Side::Right };
            if legend.column_height() <= highest {
                return legend;
            }
        }
        // Many entries share rows; a few may have a row each.
        let columns = if entries.len() > 4 && width > 3.0 * COLUMN { 3.0 } else { 1.0 };
        Self { entries: broken(width / columns - KEY - 4.0 * GAP), more, side: Side::Below }
    }

    fn lines(&self) -> usize {
        self.entries.iter().map(|(_, lines)| lines.len().max(1)).sum::<usize>() + usize::from(self.more > 0)
    }

    /// Width that the legend takes away at the right of the plot.
    pub(super) fn width(&self) -> f64 {
        let text = self.entries.iter().map(|(_, lines)| entry_width(lines)).fold(0.0, f64::max);
        if self.side == Side::Right && !self.entries.is_empty() { text + 2.0 * GAP } else { 0.0 }
    }

    /// Height of a column at the right of the plot.
    pub(super) fn column_height(&self) -> f64 {
        if self.side == Side::Right { self.lines() as f64 * LINE } else { 0.0 }
    }

    /// Draws a column downwards from the upper left corner given.
    pub(super) fn draw_right(&self, scene: &mut Scene, (left, top): Point) {
        if self.side == Side::Right {
            let mut y = top;
            for (key, lines) in &self.entries {
                draw_entry(scene, key, lines, (left, y));
                y += LINE * lines.len().max(1) as f64;
            }
            self.remark(scene, (left, y));
        }
    }

    /// Draws rows below `top` and returns where they end.
    pub(super) fn draw_below(&self, scene: &mut Scene, left: f64, right: f64, top: f64) -> f64 {
        if self.side == Side::Right || self.entries.is_empty() {
            return top;
        }
        let widths = self.columns(right - left);
        let mut y = top;
        for row in self.entries.chunks(widths.len()) {
            let mut x = left;
            for ((key, lines), width) in row.iter().zip(&widths) {
                draw_entry(scene, key, lines, (x, y));
                x += width;
            }
            y += LINE * row.iter().map(|(_, lines)| lines.len()).max().unwrap_or(1) as f64;
        }
        if self.more > 0 {
            self.remark(scene, (left, y));
            y += LINE;
        }
        y
    }

    /// Widths of as many columns as fit, at least one.
    fn columns(&self, room: f64) -> Vec<f64> {
        let widths = |count: usize| -> Vec<f64> {
            let widest = |column: usize| {
                let of_column = self.entries.iter().skip(column).step_by(count);
                of_column.map(|(_, lines)| entry_width(lines)).fold(0.0, f64::max)
            };
            (0..count).map(|column| widest(column) + 4.0 * GAP).collect()
        };
        let fitting =
            (2..=self.entries.len().min(8)).rev().map(widths).find(|w| w.iter().sum::<f64>() <= room);
        fitting.unwrap_or_else(|| vec![room])
    }

    fn remark(&self, scene: &mut Scene, (left, top): Point) {
        if self.more > 0 {
            let text = format!("and {} more", self.more);
            scene.text((left + KEY + GAP, top + 11.0), &text, SIZE, GREY, Anchor::Start);
        }
    }
}

/// The lines of an entry.
pub(super) fn broken(label: &str, limit: f64, most: usize) -> Vec<String> {
    text::wrap_at_most(label, SIZE, limit, most)
}

/// Width of an entry with its key.
pub(super) fn entry_width(lines: &[String]) -> f64 {
    KEY + GAP + lines.iter().map(|line| text::width(line, SIZE)).fold(0.0, f64::max)
}

/// Draws an entry whose upper left corner is given.
pub(super) fn draw_entry(scene: &mut Scene, key: &Key, lines: &[String], (left, top): Point) {
    let middle = top + 0.5 * LINE;
    let area = Rect { left: left + 4.0, top: middle - 5.0, right: left + KEY - 2.0, bottom: middle + 5.0 };
    match key {
        Key::Line { colour, dash } => {
            for points in geometry::dash(&[(left, middle), (left + KEY, middle)], dash) {
                scene.marks.push(Mark::Stroke { points, width: 1.8, colour: *colour });
            }
        }
        Key::Marked { symbol, dash } => {
            for points in geometry::dash(&[(left, middle), (left + KEY, middle)], dash) {
                scene.marks.push(Mark::Stroke { points, width: 1.8, colour: symbol.colour });
            }
            symbol.draw(scene, (left + 0.5 * KEY, middle), 3.2);
        }
        Key::Area { colour } => {
            scene.fill(area, *colour);
            // White is a colour too.
            scene.outline(area, 0.5, GREY);
        }
        Key::Cased => {
            for (width, colour) in CASED {
                scene.line((left, middle), (left + KEY, middle), width, colour);
            }
        }
        Key::Hatched => {
            hatch(scene, area);
            scene.outline(area, 0.7, GREY);
        }
        Key::Dotted { colour, ink } => {
            scene.fill(area, *colour);
            let centre = (0.5 * (area.left + area.right), middle);
            scene.marks.push(Mark::Disc { centre, radius: 2.4, colour: *ink });
        }
        Key::Symbol { symbol, ground } => {
            if let Some(colour) = ground {
                scene.fill(area, *colour);
            }
            symbol.draw(scene, (0.5 * (area.left + area.right), middle), 3.8);
        }
        Key::Whisker { colour } => {
            scene.line((left, middle), (left + KEY, middle), 1.1, *colour);
            let centre = (left + 0.5 * KEY, middle);
            scene.marks.push(Mark::Disc { centre, radius: 2.6, colour: *colour });
        }
    }
    for (i, line) in lines.iter().enumerate() {
        let baseline = top + 11.5 + i as f64 * LINE;
        scene.text((left + KEY + GAP, baseline), line, SIZE, INK, Anchor::Start);
    }
}

/// Grey with diagonal lines: no value.
pub(super) fn hatch(scene: &mut Scene, area: Rect) {
    scene.fill(area, super::colour::NO_VALUE);
    const STEP: f64 = 5.0;
    // Lines x + y = const, the same ones over the whole figure, so that neighbours join.
    let first = ((area.left + area.top) / STEP).ceil() as i64;
    let last = ((area.right + area.bottom) / STEP).floor() as i64;
    for sum in (first..=last).map(|i| i as f64 * STEP) {
        let ends = [(sum - area.bottom, area.bottom), (sum - area.top, area.top)];
        for points in geometry::clip(&ends, &area) {
            scene.marks.push(Mark::Stroke { points, width: 0.7, colour: GREY.opacity(0.75) });
        }
    }
}
