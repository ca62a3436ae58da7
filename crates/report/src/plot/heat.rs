//! Lays out a heat map.

use super::axis::{Axis, Ruler, transform};
use super::colour::{self, Colour, GREY, INK, NO_VALUE, WHITE};
use super::contour;
use super::figure::Marker;
use super::frame::{self, Horizontal, Vertical};
use super::geometry;
use super::heatmap::{HeatMap, edges};
use super::label::Placer;
use super::legend::{self, Entry, Key, Legend};
use super::readings::Readable;
use super::scene::{Mark, Point, Rect, Scene};
use super::symbol::{Shape, Symbol};
use super::ticks;
use hadar::Result;

const HEIGHT: f64 = 420.0;
const BAR: f64 = 18.0;
/// Pixels of the raster in a logical one: those of the PNG.
const FINE: f64 = super::png::SCALE;
/// Steps of colour: no eye sees more, and a palette of a file holds them.
const SHADES: f64 = 200.0;
/// Patches without value that are hatched; more of them are plain grey.
const MOST_HATCHED: usize = 500;

pub(super) fn scene(map: &HeatMap) -> Result<Scene> {
    map.check()?;
    let (columns, rows) = (edges(&map.columns, map.x.scale), edges(&map.rows, map.y.scale));
    let y = Vertical::new(&map.y, over(&map.y, &rows), HEIGHT);
    let colours = Ruler::fit(map.colour.scale, map.colour.range, map.values.iter().copied(), 0.0);
    let bar = Vertical::new(&map.colour, colours, HEIGHT);
    let left = y.room().max(50.0);
    let right = frame::WIDTH - bar.room() - BAR - 18.0;
    let x = Horizontal::new(&map.x, over(&map.x, &columns), right - left);

    let mut scene = Scene::new(&map.title, frame::WIDTH);
    let factor = if y.has_multiplier() || bar.has_multiplier() { 16.0 } else { 0.0 };
    let top = frame::heading(&mut scene, &map.title, &map.subtitle) + x.room_above().max(factor) + 14.0;
    let area = Rect { left, right, top, bottom: top + HEIGHT };

    let shades = |part| shade(&colours, part);
    let missing = draw_cells(&mut scene, &Lattice::new(map, &colours), &shades, [&x.ruler, &y.ruler], area);
    let [across, up] = [(&map.x, &x.ruler, &map.columns), (&map.y, &y.ruler, &map.rows)]
        .map(|(axis, ruler, centres)| (axis.title.as_str(), ruler, centres.as_slice()));
    scene.readable.extend(Readable::cells(area.sides(), [across, up], (&map.colour.title, &map.values)));
    let mut placer = Placer::new(area);
    let contours = draw_contours(&mut scene, &mut placer, map, &x, &y, &area);
    scene.outline(area, 0.9, INK);
    x.draw_ticks(&mut scene, &area);
    x.draw_secondary(&mut scene, &area);
    y.draw_left(&mut scene, &area, if x.room_above() > 0.0 { 14.0 } else { 0.0 });
    let place = |marker: &Marker| Some(area.at(x.ruler.fraction(marker.x)?, y.ruler.fraction(marker.y)?));
    let markers = map.markers.iter().filter_map(|marker| Some((place(marker)?, marker.label.as_str())));
    let markers: Vec<(Point, &str)> = markers.filter(|(at, _)| area.grown(0.01).contains(*at)).collect();
    placer.points(&mut scene, &markers);
    for (line, text) in &contours {
        placer.on_line(&mut scene, line, text);
    }
    let values = map.values.iter().copied();
    let beside = Rect { left: right + 18.0, right: right + 18.0 + BAR, ..area };
    draw_bar(
        &mut scene,
        values.filter_map(|value| bar.ruler.fraction(value)),
        &bar,
        &beside,
        &colour::map(&bar.ruler),
    );
    let mut entries = Vec::new();
    for (i, (value, label)) in map.marks.iter().enumerate() {
        let symbol = Symbol { shape: Shape::Right, colour: INK, open: i > 0 };
        // A value beyond the scale is marked at its end.
        let Some(part) = bar.ruler.fraction(*value) else { continue };
        let (x, y) = beside.at(0.0, part.clamp(0.0, 1.0));
        symbol.draw(&mut scene, (x - 6.0, y), 4.0);
        let beyond = if (0.0..=1.0).contains(&part) { "" } else { ", beyond the scale" };
        entries.push(Entry { key: Key::Symbol { symbol, ground: None }, label: format!("{label}{beyond}") });
    }

    let below = x.draw_labels(&mut scene, &area);
    entries.extend(missing.map(|key| Entry { key, label: map.no_value.clone() }));
    let legend = Legend::new(entries, right - left, 0.0);
    scene.height = (legend.draw_below(&mut scene, left, frame::WIDTH - 12.0, below) + 10.0).ceil();
    Ok(scene)
}

/// Stated range, or all of the cells.
fn over(axis: &Axis, edges: &[f64]) -> Ruler {
    let (low, high) = (edges.first().copied(), edges.last().copied());
    Ruler::over(axis.scale, axis.range, low.unwrap_or(f64::INFINITY), high.unwrap_or(f64::NEG_INFINITY), 0.0)
}

/// Cells between their edges, and their centres, on the transformed scales.
struct Lattice<'a> {
    map: &'a HeatMap,
    columns: (Vec<f64>, Vec<f64>),
    rows: (Vec<f64>, Vec<f64>),
    /// Parts of the colour scale, `None` where there is no value.
    parts: Vec<Option<f64>>,
}

impl<'a> Lattice<'a> {
    fn new(map: &'a HeatMap, colours: &Ruler) -> Self {
        let side = |centres: &[f64], scale| {
            let t = centres.iter().filter_map(|centre| transform(scale, *centre)).collect();
            (edges(centres, scale), t)
        };
        let parts = map.values.iter().map(|value| colours.fraction(*value)).collect();
        Self { map, columns: side(&map.columns, map.x.scale), rows: side(&map.rows, map.y.scale), parts }
    }

    fn part(&self, row: usize, column: usize) -> Option<f64> {
        self.parts.get(row * self.map.columns.len() + column).copied().flatten()
    }

    /// Part of the colour scale at a position: linear between the centres around it; none in a cell without value.
    fn at(&self, x: f64, y: f64) -> Option<f64> {
        let (column, across) = between(&self.columns, x)?;
        let (row, up) = between(&self.rows, y)?;
        // The cell that the position is in has the last word.
        self.part(row + usize::from(up >= 0.5), column + usize::from(across >= 0.5))?;
        let corners = [
            (row, column, (1.0 - up) * (1.0 - across)),
            (row, column + 1, (1.0 - up) * across),
            (row + 1, column, up * (1.0 - across)),
            (row + 1, column + 1, up * across),
        ];
        let known =
            corners.into_iter().filter_map(|(row, column, weight)| Some((self.part(row, column)?, weight)));
        let (sum, weights) = known.fold((0.0, 0.0), |(sum, all), (part, w)| (sum + w * part, all + w));
        (weights > 0.0).then(|| sum / weights)
    }
}

/// The last centre at or before a position, and how far towards the next it is; none beyond the outermost edges.
fn between((edges, centres): &(Vec<f64>, Vec<f64>), at: f64) -> Option<(usize, f64)> {
    let (first, last) = (*edges.first()?, *edges.last()?);
    if at < first || at > last {
        return None;
    }
    let before = centres.partition_point(|centre| *centre <= at).saturating_sub(1);
    let (Some(low), Some(high)) = (centres.get(before), centres.get(before + 1)) else {
        return Some((before, 0.0));
    };
    Some((before, ((at - low) / (high - low)).clamp(0.0, 1.0)))
}

/// Draws the map as a raster; says how cells without value look, if there are any.
fn draw_cells(
    scene: &mut Scene,
    lattice: &Lattice<'_>,
    shades: &dyn Fn(f64) -> Colour,
    [x, y]: [&Ruler; 2],
    area: Rect,
) -> Option<Key> {
    let (width, height) = ((area.width() * FINE) as usize, (area.height() * FINE) as usize);
    let along = |ruler: &Ruler, part: f64| ruler.first + part * (ruler.last - ruler.first);
    let mut pixels = Vec::with_capacity(width * height);
    for row in 0..height {
        let at_y = along(y, 1.0 - (row as f64 + 0.5) / height as f64);
        for column in 0..width {
            let at_x = along(x, (column as f64 + 0.5) / width as f64);
            pixels.push(lattice.at(at_x, at_y).map_or(NO_VALUE, shades).rgb);
        }
    }
    scene.marks.push(Mark::Image { area, columns: width, pixels });
    let missing: Vec<Rect> = lattice.cells_without_value(x, y, &area);
    if missing.len() > MOST_HATCHED {
        return Some(Key::Area { colour: NO_VALUE });
    }
    missing.iter().for_each(|cell| legend::hatch(scene, *cell));
    missing.iter().for_each(|cell| scene.outline(*cell, 0.7, GREY));
    (!missing.is_empty()).then_some(Key::Hatched)
}

impl Lattice<'_> {
    /// Places of the cells without value, as far as they are in view.
    fn cells_without_value(&self, x: &Ruler, y: &Ruler, frame: &Rect) -> Vec<Rect> {
        let width = self.map.columns.len();
        let missing = self.parts.iter().enumerate().filter(|(_, part)| part.is_none());
        let place = |at: usize| {
            let (row, column) = (at / width, at % width);
            let across = |i: usize| Some(frame.at(x.place(*self.columns.0.get(i)?), 0.0).0);
            let up = |i: usize| Some(frame.at(0.0, y.place(*self.rows.0.get(i)?)).1);
            let (a, b, c, d) = (across(column)?, across(column + 1)?, up(row)?, up(row + 1)?);
            let cell = Rect {
                left: a.min(b).max(frame.left),
                right: a.max(b).min(frame.right),
                top: c.min(d).max(frame.top),
                bottom: c.max(d).min(frame.bottom),
            };
            (cell.width() > 0.0 && cell.height() > 0.0).then_some(cell)
        };
        missing.filter_map(|(at, _)| place(at)).collect()
    }
}

/// Colour at a part of a scale, in the steps that a palette holds.
pub(super) fn shade(scale: &Ruler, part: f64) -> Colour {
    colour::map(scale)((part.clamp(0.0, 1.0) * SHADES).round() / SHADES)
}

/// Draws the contour lines; returns the longest of each level, with its label.
fn draw_contours(
    scene: &mut Scene,
    placer: &mut Placer,
    map: &HeatMap,
    x: &Horizontal,
    y: &Vertical,
    area: &Rect,
) -> Vec<(Vec<Point>, String)> {
    let centre = |i: &f64, ruler: &Ruler| ruler.fraction(*i).unwrap_or(0.0);
    let columns: Vec<f64> = map.columns.iter().map(|c| area.at(centre(c, &x.ruler), 0.0).0).collect();
    let rows: Vec<f64> = map.rows.iter().map(|r| area.at(0.0, centre(r, &y.ruler)).1).collect();
    let scale = map.colour.scale;
    let values: Vec<f64> = map.values.iter().map(|v| transform(scale, *v).unwrap_or(f64::NAN)).collect();
    let mut labels = Vec::new();
    for level in &map.contours {
        let Some(at) = transform(scale, *level) else { continue };
        let mut longest: Vec<Point> = Vec::new();
        for line in contour::lines(&columns, &rows, &values, at) {
            for part in geometry::clip(&line, area) {
                for (width, colour) in [(2.2, INK.opacity(0.35)), (1.1, WHITE)] {
                    scene.marks.push(Mark::Stroke { points: part.clone(), width, colour });
                }
                placer.avoid_line(&part);
                if part.len() > longest.len() {
                    longest = part;
                }
            }
        }
        labels.push((longest, ticks::label(*level)));
    }
    labels
}

/// The colour bar with its scale, and tips where there are fractions beyond it.
pub(super) fn draw_bar(
    scene: &mut Scene,
    fractions: impl Iterator<Item = f64>,
    axis: &Vertical,
    bar: &Rect,
    colour_of: &dyn Fn(f64) -> Colour,
) {
    const STRIPS: u16 = 96;
    let strips = (0..STRIPS).rev().map(|i| colour_of((f64::from(i) + 0.5) / f64::from(STRIPS)).rgb);
    scene.marks.push(Mark::Image { area: *bar, columns: 1, pixels: strips.collect() });
    scene.outline(*bar, 0.9, INK);
    // A tip at an end of the bar: there are values beyond it.
    let (mut least, mut most) = (0.0f64, 1.0f64);
    for part in fractions {
        (least, most) = (least.min(part), most.max(part));
    }
    let middle = 0.5 * (bar.left + bar.right);
    let x = vec![bar.left, middle, bar.right];
    if most > 1.0 + 1e-9 {
        let base = bar.top - 2.0;
        let upper = vec![base, base - 9.0, base];
        scene.marks.push(Mark::Area { x: x.clone(), upper, lower: vec![base; 3], colour: colour_of(1.0) });
    }
    if least < -1e-9 {
        let base = bar.bottom + 2.0;
        let lower = vec![base, base + 9.0, base];
        scene.marks.push(Mark::Area { x, upper: vec![base; 3], lower, colour: colour_of(0.0) });
    }
    axis.draw_right(scene, bar);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_linear_between_centres_and_end_at_cells_without_value() {
        let axis = || Axis::linear("");
        let values = vec![0.0, 1.0, 2.0, f64::NAN];
        let map = HeatMap::new("", (axis(), vec![0.0, 1.0]), (axis(), vec![0.0, 1.0]), (axis(), values));
        let colours = Ruler::fit(map.colour.scale, Some((0.0, 2.0)), std::iter::empty(), 0.0);
        let lattice = Lattice::new(&map, &colours);
        assert_eq!(
            (lattice.at(0.0, 0.0), lattice.at(1.0, 0.0), lattice.at(0.0, 1.0)),
            (Some(0.0), Some(0.5), Some(1.0))
        );
        assert_eq!((lattice.at(0.25, 0.0), lattice.at(-0.4, 0.25)), (Some(0.125), Some(0.25)));
        assert_eq!((lattice.at(0.9, 0.9), lattice.at(-0.6, 0.0)), (None, None));
    }
}
