//! Lays out named values: names at the left, points on a common axis at their right.
//!
//! Rows come closer the more there are, down to the distance at which their names are still read with ease;
//! from there on the figure grows. The legend stands above the rows, from where a long list is read.

use super::axis::{Ruler, Scale};
use super::colour::{self, Colour, GREY, INK, SHADE, WHITE};
use super::frame::{self, EDGE, Horizontal};
use super::geometry;
use super::label;
use super::legend::{Entry, Key, Legend};
use super::named::{NamedSeries, NamedValues};
use super::names::{self, Names};
use super::readings::Readable;
use super::scene::{Anchor, Mark, Point, Rect, Scene};
use super::symbol::{Shape, Symbol};
use super::text;
use hadar::Result;

/// From the frame to the names.
const NAME_GAP: f64 = 8.0;
/// Distances of rows for one series, what each further one adds where there is room, and its least share.
const PITCH: std::ops::RangeInclusive<f64> = 13.5..=22.0;
const MORE_PITCH: f64 = 6.0;
const SERIES_PITCH: f64 = 8.0;
/// Height of all rows up to which they stand widely.
const TALL: f64 = 620.0;
/// Height of all rows at which letters become smaller, whatever the rows.
const TALLEST: f64 = 2700.0;
/// Height from which on the labels of the axis are printed above the rows, too.
const LABELS_TWICE: f64 = 480.0;
const LARGEST_SYMBOL: f64 = 3.6;
const WHISKER: f64 = 1.1;

pub(super) fn scene(figure: &NamedValues) -> Result<Scene> {
    figure.check()?;
    let rows = Rows::new(figure);
    let ruler = ruler(figure);
    let names = Names::new(&figure.names, rows.pitch, names::WIDE, None);
    // The first label of the axis sticks out to the left.
    let left = (EDGE + names.room + NAME_GAP).max(50.0);
    let trial = Horizontal::new(&figure.axis, ruler, frame::WIDTH - left - 24.0);
    let right = frame::WIDTH - trial.room().max(24.0);
    let x = Horizontal::new(&figure.axis, ruler, right - left);

    let mut scene = Scene::new(&figure.title, frame::WIDTH);
    let heading = frame::heading(&mut scene, &figure.title, &figure.subtitle) + 2.0;
    let legend = Legend::new(entries(figure, &ruler), frame::WIDTH - 2.0 * EDGE, 0.0);
    let after = legend.draw_below(&mut scene, EDGE, frame::WIDTH - EDGE, heading);
    let height = rows.pitch * figure.names.len().max(1) as f64;
    let twice = if height > LABELS_TWICE { x.room_for_labels() } else { 0.0 };
    let line = threshold(figure, &ruler);
    let words = line.map_or("", |(_, label)| label);
    let words = text::wrap(words, label::SIZE, frame::WIDTH - 2.0 * EDGE);
    let leading = label::SIZE * text::LEADING;
    let room = if words.is_empty() { 0.0 } else { leading * words.len() as f64 + 3.0 };
    let top = after + x.room_above() + twice + room + 6.0;
    let area = Rect { left, right, top, bottom: top + height };

    rows.draw_ground(&mut scene, figure, &area);
    x.draw_grid(&mut scene, &area);
    rows.draw_guides(&mut scene, &area);
    for (i, (value, _)) in figure.lines.iter().enumerate() {
        let Some(part) = ruler.fraction(*value).filter(|part| (0.0..=1.0).contains(part)) else { continue };
        let (at, _) = area.at(part, 0.0);
        let (colour, dash) = line_look(i);
        for points in geometry::dash(&[(at, area.bottom), (at, area.top)], dash) {
            scene.marks.push(Mark::Stroke { points, width: 1.4, colour });
        }
    }
    let taken = line.map(|(part, _)| area.at(part, 0.0).0);
    if let Some((part, _)) = line {
        let (at, _) = area.at(part, 0.0);
        let up = if x.room_above() > 0.0 || words.is_empty() { area.top } else { area.top - twice - 3.0 };
        for points in geometry::dash(&[(at, area.bottom), (at, up)], &[5.0, 3.0]) {
            scene.marks.push(Mark::Stroke { points, width: 1.2, colour: INK });
        }
        let base = area.top - x.room_above() - twice - 6.0;
        for (line, below) in words.iter().zip((0..words.len()).rev()) {
            let half = 0.5 * text::width(line, label::SIZE);
            let middle = at.min(frame::WIDTH - EDGE - half).max(EDGE + half);
            scene.text((middle, base - leading * below as f64), line, label::SIZE, INK, Anchor::Middle);
        }
    }
    scene.outline(area, 0.9, INK);
    let series = figure.series.iter().map(|series| (series.label.as_str(), series.values.as_slice()));
    scene.readable.push(Readable::rows(area.sides(), (&figure.axis.title, &ruler), &figure.names, series));
    x.draw_ticks(&mut scene, &area);
    x.draw_secondary(&mut scene, &area);
    if twice > 0.0 {
        x.draw_labels_above(&mut scene, &area, taken);
    }
    for (row, below, line) in names.printed() {
        let colour = if figure.fails(row) { GREY } else { INK };
        let y = rows.middle(row, &area) + 0.36 * names.size + below;
        scene.text((left - NAME_GAP, y), line, names.size, colour, Anchor::End);
    }
    rows.draw_values(&mut scene, figure, &ruler, &area);
    let end = x.draw_labels(&mut scene, &area);
    scene.height = (end + 4.0).ceil();
    Ok(scene)
}

/// The range of all that has a place on the axis.
fn ruler(figure: &NamedValues) -> Ruler {
    let series = figure.series.iter().flat_map(|series| {
        let ends = series.intervals.iter().flat_map(|(low, high)| low.iter().chain(high));
        series.values.iter().chain(ends).copied()
    });
    let threshold = figure.threshold.iter().chain(&figure.lines).map(|(value, _)| *value);
    Ruler::fit(figure.axis.scale, figure.axis.range, series.chain(threshold), 0.03)
}

/// Where the line of the threshold stands, and its label, if in view.
fn threshold<'a>(figure: &'a NamedValues, ruler: &Ruler) -> Option<(f64, &'a str)> {
    let (value, label) = figure.threshold.as_ref()?;
    let part = ruler.fraction(*value)?;
    (0.0..=1.0).contains(&part).then_some((part, label.trim()))
}

/// Where a value is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Place {
    /// At this fraction of the axis.
    At(f64),
    /// Beyond the end at this fraction, 0 or 1.
    Beyond(f64, Reason),
}

/// Why a value has no place on the axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Reason {
    Zero,
    Negative,
    Infinite,
    OutOfRange,
}

/// Place of a value; `None` for NaN.
fn place(ruler: &Ruler, value: f64) -> Option<Place> {
    let (low, high) = if ruler.first <= ruler.last { (0.0, 1.0) } else { (1.0, 0.0) };
    match ruler.fraction(value) {
        // What rounding pushes out at the ends is still inside.
        Some(part) if (-1e-9..=1.0 + 1e-9).contains(&part) => Some(Place::At(part)),
        Some(part) => Some(Place::Beyond(part.clamp(0.0, 1.0), Reason::OutOfRange)),
        None if value.is_nan() => None,
        None if value > 1.0 => Some(Place::Beyond(high, Reason::Infinite)),
        None if ruler.scale == Scale::Linear => Some(Place::Beyond(low, Reason::Infinite)),
        // Positive numbers that small are an underflow.
        None if value >= 0.0 => Some(Place::Beyond(low, Reason::Zero)),
        None => Some(Place::Beyond(low, Reason::Negative)),
    }
}

fn symbol(index: usize, series: &NamedSeries, open: bool) -> Symbol {
    let (colour, _) = colour::series(series.colour.unwrap_or(index));
    Symbol { shape: Shape::series(index), colour, open }
}

/// Colour and dashes of a further line.
fn line_look(index: usize) -> (Colour, &'static [f64]) {
    if index == 0 { (GREY, &[3.0, 3.0]) } else { (colour::series(index).0, &[]) }
}

/// An arrow towards this end of the axis.
fn arrow(end: f64, colour: Colour) -> Symbol {
    Symbol { shape: if end == 0.0 { Shape::Left } else { Shape::Right }, colour, open: true }
}

/// What the legend says: the series, then what symbols and grey rows mean.
fn entries(figure: &NamedValues, ruler: &Ruler) -> Vec<Entry> {
    let mut entries = Vec::new();
    let all = || figure.series.iter().flat_map(|series| series.values.iter().copied());
    let only = if let [only] = figure.series.as_slice() { Some(symbol(0, only, true)) } else { None };
    if only.is_none() {
        entries.extend(figure.series.iter().enumerate().map(|(i, series)| {
            let key = Key::Symbol { symbol: symbol(i, series, false), ground: None };
            Entry { key, label: series.label.clone() }
        }));
    }
    for (i, (_, label)) in figure.lines.iter().enumerate() {
        let (colour, dash) = line_look(i);
        entries.push(Entry { key: Key::Line { colour, dash }, label: label.clone() });
    }
    let colour = only.map_or(INK, |symbol| symbol.colour);
    let has_intervals = figure.series.iter().any(|series| series.intervals.is_some());
    if has_intervals {
        entries.push(Entry { key: Key::Whisker { colour }, label: figure.interval_meaning.clone() });
    }
    let below = |row: usize| figure.series.iter().any(|series| figure.is_below(row, series.at(row).0));
    if (0..figure.names.len()).any(below) {
        let label = figure.below.clone();
        match only {
            Some(symbol) => entries.push(Entry { key: Key::Symbol { symbol, ground: Some(SHADE) }, label }),
            None => {
                let symbol = Symbol { shape: Shape::Disc, colour, open: true };
                entries.push(Entry { key: Key::Symbol { symbol, ground: None }, label });
                if (0..figure.names.len()).any(|row| figure.fails(row)) {
                    let label = format!("{}, all values", figure.below);
                    entries.push(Entry { key: Key::Area { colour: SHADE }, label });
                }
            }
        }
    }
    for end in [0.0, 1.0] {
        let found: Vec<Reason> = all()
            .filter_map(|value| match place(ruler, value)? {
                Place::Beyond(at, reason) if at == end => Some(reason),
                _ => None,
            })
            .collect();
        if !found.is_empty() {
            let key = Key::Symbol { symbol: arrow(end, colour), ground: None };
            entries.push(Entry { key, label: reasons(&found, ruler, end) });
        }
    }
    entries
}

/// What an arrow at this end stands for.
fn reasons(found: &[Reason], ruler: &Ruler, end: f64) -> String {
    let is_low = (end == 0.0) == (ruler.first <= ruler.last);
    let mut words = Vec::new();
    match (found.contains(&Reason::Zero), found.contains(&Reason::Negative)) {
        (_, true) => words.push("0 or below"),
        (true, false) => words.push("0"),
        _ => {}
    }
    if found.contains(&Reason::Infinite) {
        words.push(if is_low { "−∞" } else { "∞" });
    }
    if found.contains(&Reason::OutOfRange) {
        words.push("beyond the axis");
    }
    words.join(" or ")
}

/// Distances of rows and of what is in them.
struct Rows {
    pitch: f64,
    /// From one series to the next within a row.
    step: f64,
    radius: f64,
}

impl Rows {
    fn new(figure: &NamedValues) -> Self {
        let (rows, series) = (figure.names.len().max(1) as f64, figure.series.len().max(1) as f64);
        let widest = PITCH.end() + MORE_PITCH * (series - 1.0);
        let pitch = (TALL / rows).clamp(*PITCH.start(), widest).max(SERIES_PITCH * series);
        // Long names take lines of their own.
        let lines = names::most_lines(&figure.names) as f64;
        let named = if lines > 1.0 { lines * frame::TICK * text::LEADING + 3.0 } else { 0.0 };
        let pitch = pitch.max(named).min(TALLEST / rows);
        let step = 0.8 * pitch / series;
        // Symbols of neighbouring series at the same value do not touch.
        Self { pitch, step, radius: (0.27 * pitch).min(0.46 * step).min(LARGEST_SYMBOL) }
    }

    fn middle(&self, row: usize, area: &Rect) -> f64 {
        area.top + self.pitch * (row as f64 + 0.5)
    }

    /// Rows that fail, those next to each other as one patch.
    fn draw_ground(&self, scene: &mut Scene, figure: &NamedValues, area: &Rect) {
        let fails: Vec<bool> = (0..figure.names.len()).map(|row| figure.fails(row)).collect();
        let mut from = 0;
        for run in fails.chunk_by(|a, b| a == b) {
            let to = from + run.len();
            if run.first() == Some(&true) {
                let (top, bottom) = (area.top + self.pitch * from as f64, area.top + self.pitch * to as f64);
                scene.fill(Rect { top, bottom, ..*area }, SHADE);
            }
            from = to;
        }
    }

    /// A thin line from each name through its values.
    fn draw_guides(&self, scene: &mut Scene, area: &Rect) {
        let count = (area.height() / self.pitch).round() as usize;
        for y in (0..count).map(|row| self.middle(row, area)) {
            scene.line((area.left - 3.0, y), (area.right, y), 0.7, GREY.opacity(0.22));
        }
    }

    fn draw_values(&self, scene: &mut Scene, figure: &NamedValues, ruler: &Ruler, area: &Rect) {
        let middle = 0.5 * (figure.series.len() as f64 - 1.0);
        for row in 0..figure.names.len() {
            let mut empty = true;
            let mut symbols = Vec::new();
            for (i, series) in figure.series.iter().enumerate() {
                let (value, interval) = series.at(row);
                let y = self.middle(row, area) + self.step * (i as f64 - middle);
                let symbol = symbol(i, series, figure.is_below(row, value));
                let ends = interval.and_then(|(a, b)| Some((end(ruler, a)?, end(ruler, b)?)));
                if let Some((a, b)) = ends.filter(|(a, b)| a != b) {
                    // The round ends stay inside the frame.
                    let at =
                        |part: f64| area.at(part, 0.0).0.clamp(area.left + WHISKER, area.right - WHISKER);
                    scene.line((at(a), y), (at(b), y), WHISKER, symbol.colour);
                    empty = false;
                }
                symbols.extend(place(ruler, value).map(|place| self.placed(place, y, symbol, area)));
            }
            // A rim must not cut into the symbol of another series.
            symbols.iter().for_each(|(symbol, at)| symbol.draw_rim(scene, *at, self.radius));
            symbols.iter().for_each(|(symbol, at)| symbol.draw(scene, *at, self.radius));
            if empty && symbols.is_empty() {
                self.draw_nothing(scene, &figure.no_value, self.middle(row, area), area);
            }
        }
    }

    /// A symbol at its place, or an arrow instead whose tip, with its rim, is at the frame.
    fn placed(&self, place: Place, y: f64, symbol: Symbol, area: &Rect) -> (Symbol, Point) {
        match place {
            Place::At(part) => (symbol, (area.at(part, 0.0).0, y)),
            Place::Beyond(part, _) => {
                let inwards = (1.4 * self.radius + 2.2) * (1.0 - 2.0 * part);
                (arrow(part, symbol.colour), (area.at(part, 0.0).0 + inwards, y))
            }
        }
    }

    /// Words in place of values.
    fn draw_nothing(&self, scene: &mut Scene, words: &str, y: f64, area: &Rect) {
        let size = (0.76 * self.pitch).min(10.0);
        if let Some(line) = text::wrap_at_most(words, size, area.width() - 16.0, 1).first() {
            let (left, right) = (area.left + 5.0, area.left + 11.0 + text::width(line, size));
            scene.fill(Rect { left, right, top: y - 0.5 * size, bottom: y + 0.5 * size }, WHITE);
            scene.text((area.left + 8.0, y + 0.36 * size), line, size, GREY, Anchor::Start);
        }
    }
}

/// Where an interval ends; at the edge where it goes on beyond.
fn end(ruler: &Ruler, value: f64) -> Option<f64> {
    place(ruler, value).map(|place| match place {
        Place::At(part) | Place::Beyond(part, _) => part.clamp(0.0, 1.0),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_has_no_place_is_at_the_edge_where_it_would_be() {
        let on = |range| Ruler::fit(Scale::Log, Some(range), std::iter::empty(), 0.0);
        let ruler = on((1.0, 100.0));
        assert_eq!(place(&ruler, 10.0), Some(Place::At(0.5)));
        assert_eq!(place(&ruler, f64::NAN), None);
        for (value, part, reason) in [
            (0.0, 0.0, Reason::Zero),
            (-1.0, 0.0, Reason::Negative),
            (f64::INFINITY, 1.0, Reason::Infinite),
            (0.1, 0.0, Reason::OutOfRange),
            (1e3, 1.0, Reason::OutOfRange),
        ] {
            assert_eq!(place(&ruler, value), Some(Place::Beyond(part, reason)));
            let turned = place(&on((100.0, 1.0)), value);
            assert_eq!(turned, Some(Place::Beyond(1.0 - part, reason)));
        }
        let linear = Ruler::fit(Scale::Linear, Some((-1.0, 1.0)), std::iter::empty(), 0.0);
        assert_eq!(place(&linear, f64::NEG_INFINITY), Some(Place::Beyond(0.0, Reason::Infinite)));
        assert_eq!(place(&linear, -0.0), Some(Place::At(0.5)));
    }
}
