//! Lays out a figure of curves.

use super::axis::{Axis, Ruler, Scale};
use super::colour::{self, Colour, GREY, INK};
use super::direct::{Direct, End};
use super::figure::{Band, LineFigure, Panel, Rule, Series, Style};
use super::frame::{self, Horizontal, Vertical};
use super::geometry;
use super::label::Placer;
use super::legend::{Entry, Key, Legend};
use super::readings::Readable;
use super::scene::{Mark, Point, Rect, Scene};
use super::symbol::{Shape, Symbol};
use super::text;
use hadar::Result;

const HEIGHT: f64 = 345.0;
const UPPER_HEIGHT: f64 = 270.0;
const LOWER_HEIGHT: f64 = 135.0;
const EVEN_HEIGHT: f64 = 150.0;
const SOLID: &[f64] = &[];
const DASHES: [&[f64]; 5] = [SOLID, &[7.0, 4.0], &[0.5, 3.8], &[9.0, 3.5, 0.5, 3.5], &[3.5, 3.0]];

const POINT: f64 = 2.8;
const PALE: f64 = 0.5;

/// A panel grows up to this height where the legend beside it needs that.
const HIGHEST: f64 = 560.0;

/// A panel with its height, and how many colours the panels above it have used.
struct Part<'a> {
    panel: &'a Panel,
    height: f64,
    colours_from: usize,
}

pub(super) fn scene(figure: &LineFigure) -> Result<Scene> {
    let heights = match figure.lower.as_slice() {
        [] => (HEIGHT, 0.0),
        [_] => (UPPER_HEIGHT, LOWER_HEIGHT),
        _ => (EVEN_HEIGHT, EVEN_HEIGHT),
    };
    let mut parts = vec![Part { panel: &figure.panel, height: heights.0, colours_from: 0 }];
    for panel in &figure.lower {
        let colours_from = parts.iter().map(|part| part.panel.series.len()).sum();
        parts.push(Part { panel, height: heights.1, colours_from });
    }
    parts.iter().try_for_each(|part| part.panel.check())?;

    let x_ruler = x_ruler(&figure.x, &parts);
    let ends = ends(&parts, &x_ruler);
    let heights: Vec<f64> = parts.iter().map(|part| part.height).collect();
    let direct = Direct::new(ends.clone(), &heights);
    let entries: Vec<Entry> = match direct {
        Some(_) => Vec::new(),
        None => ends.into_iter().map(|end| end.entry).collect(),
    };
    if let [only] = parts.as_mut_slice() {
        let column = Legend::new(entries.clone(), frame::WIDTH, HIGHEST).column_height();
        only.height = only.height.max(column);
    }
    let axes: Vec<(&Part, Vertical)> = parts
        .iter()
        .map(|part| (part, Vertical::new(&part.panel.y, y_ruler(part.panel, &x_ruler), part.height)))
        .collect();
    let left = axes.iter().map(|(_, y)| y.room()).fold(50.0, f64::max);
    let legend = Legend::new(entries, frame::WIDTH - 12.0 - left, HIGHEST);
    // The last label may stick out, unless a legend stands there anyway.
    let trial = Horizontal::new(&figure.x, x_ruler, frame::WIDTH - left - 24.0);
    let beside = axes.iter().map(|(_, y)| y.room_right()).fold(0.0, f64::max);
    let labels = direct.as_ref().map_or(0.0, Direct::width);
    let right = frame::WIDTH - trial.room().max(24.0).max(beside + 12.0) - legend.width() - labels;
    let x = Horizontal::new(&figure.x, x_ruler, right - left);

    let mut scene = Scene::new(&figure.title, frame::WIDTH);
    let factor = if axes.first().is_some_and(|(_, y)| y.has_multiplier()) { 16.0 } else { 0.0 };
    let top = frame::heading(&mut scene, &figure.title, &figure.subtitle) + x.room_above().max(factor) + 6.0;
    let mut bottom = top;
    for (i, (part, y)) in axes.iter().enumerate() {
        let gap = match i {
            0 => 0.0,
            _ if y.has_multiplier() => 28.0,
            _ => 18.0,
        };
        let area = Rect { left, right, top: bottom + gap, bottom: bottom + gap + part.height };
        bottom = area.bottom;
        draw_panel(&mut scene, part, &x, y, area);
        let axes = [(figure.x.title.as_str(), &x.ruler), (part.panel.y.title.as_str(), &y.ruler)];
        let is_line = |one: &Series| one.style != Style::Points;
        let curves =
            part.panel.series.iter().map(|one| (one.label.as_str(), [&one.x[..], &one.y], is_line(one)));
        scene.readable.push(Readable::curves(area.sides(), axes, curves));
        if i == 0 {
            x.draw_secondary(&mut scene, &area);
        }
        y.draw_secondary(&mut scene, &area);
        if let Some(direct) = &direct {
            direct.draw(&mut scene, i, &area, beside);
        }
        y.draw_left(&mut scene, &area, if i == 0 && x.room_above() > 0.0 { 14.0 } else { 0.0 });
    }
    legend.draw_right(&mut scene, (right + beside + 16.0, top));
    let lowest = Rect { left, right, top, bottom };
    let below = x.draw_labels(&mut scene, &lowest);
    let below = legend.draw_below(&mut scene, left, frame::WIDTH - 12.0, below);
    scene.height = (below + 10.0).max(top + legend.column_height() + 12.0).ceil();
    Ok(scene)
}

fn x_ruler(axis: &Axis, parts: &[Part]) -> Ruler {
    let mut values = Vec::new();
    let mut any_points = false;
    for Part { panel, .. } in parts {
        values.extend(panel.series.iter().flat_map(|series| &series.x));
        values.extend(panel.bands.iter().flat_map(|band| &band.x));
        values.extend(panel.markers.iter().map(|marker| marker.x));
        values.extend(panel.rules.iter().filter_map(|rule| match rule {
            Rule::Vertical { x, .. } => Some(*x),
            Rule::Horizontal { .. } => None,
        }));
        any_points |= !panel.markers.is_empty() || panel.series.iter().any(|s| has_points(s.style));
    }
    Ruler::fit(axis.scale, axis.range, values.into_iter(), if any_points { 0.03 } else { 0.0 })
}

/// Range over the numbers whose horizontal position is in view.
fn y_ruler(panel: &Panel, x: &Ruler) -> Ruler {
    let in_view = |at: f64| x.fraction(at).is_some_and(|part| (-1e-9..=1.0 + 1e-9).contains(&part));
    let mut values = Vec::new();
    let mut add = |x: &[f64], y: &[f64]| {
        values.extend(x.iter().zip(y).filter(|(x, _)| in_view(**x)).map(|(_, y)| *y));
    };
    for Series { x, y, .. } in &panel.series {
        add(x, y);
    }
    for Band { x, low, high, .. } in &panel.bands {
        add(x, low);
        add(x, high);
    }
    for marker in &panel.markers {
        add(&[marker.x], &[marker.y]);
    }
    values.extend(panel.rules.iter().filter_map(|rule| match rule {
        Rule::Horizontal { y, .. } => Some(*y),
        Rule::Vertical { .. } => None,
    }));
    Ruler::fit(
        panel.y.scale,
        panel.y.range,
        values.into_iter(),
        if panel.y.scale == Scale::Log { 0.03 } else { 0.06 },
    )
}

fn band_colour(band: &Band) -> Colour {
    band.colour.map_or(GREY, |index| colour::series(index).0).opacity(0.22)
}

fn series_look(index: usize, series: &Series) -> (Colour, &'static [f64]) {
    let (colour, round) = colour::series(series.colour.unwrap_or(index));
    let style = match series.style {
        Style::Line | Style::Points | Style::Marked => 0,
        Style::Dashed => 1,
        Style::Dotted => 2,
    };
    (colour, DASHES.get((style + round) % DASHES.len()).copied().unwrap_or(SOLID))
}

fn has_points(style: Style) -> bool {
    matches!(style, Style::Points | Style::Marked)
}

/// Colour and shape together tell points apart.
fn symbol(index: usize, series: &Series) -> Symbol {
    let index = series.colour.unwrap_or(index);
    let colour = colour::series(index).0;
    let colour = if series.pale { colour.opacity(PALE) } else { colour };
    Symbol { shape: Shape::series(index), colour, open: series.open }
}

/// Curves first, then bands; what appears in several panels under one name is listed once, in the first.
fn ends(parts: &[Part], x: &Ruler) -> Vec<End> {
    let mut ends: Vec<End> = Vec::new();
    for (panel, part) in parts.iter().enumerate() {
        let y = y_ruler(part.panel, x);
        // Where the curve is at the last position in view.
        let last = |points: &mut dyn Iterator<Item = (f64, f64)>| {
            let placed = points.filter_map(|(at, value)| Some((x.fraction(at)?, y.fraction(value)?)));
            let seen = placed.filter(|(at, _)| (-1e-9..=1.0 + 1e-9).contains(at));
            seen.max_by(|a, b| a.0.total_cmp(&b.0))
        };
        let series = part.panel.series.iter().enumerate().map(|(i, series)| {
            let (colour, dash) = series_look(part.colours_from + i, series);
            let symbol = symbol(part.colours_from + i, series);
            let key = match series.style {
                Style::Points => Key::Symbol { symbol, ground: None },
                Style::Marked => Key::Marked { symbol, dash },
                _ => Key::Line { colour, dash },
            };
            let at = last(&mut series.x.iter().copied().zip(series.y.iter().copied()));
            End { panel, at, entry: Entry { key, label: series.label.clone() } }
        });
        let bands = part.panel.bands.iter().map(|band| {
            let middles = band.low.iter().zip(&band.high).map(|(low, high)| 0.5 * (low + high));
            let key = Key::Area { colour: band_colour(band) };
            let at = last(&mut band.x.iter().copied().zip(middles));
            End { panel, at, entry: Entry { key, label: band.label.clone() } }
        });
        for end in series.chain(bands) {
            let same = |listed: &End| listed.entry == end.entry;
            if !text::clean(&end.entry.label).is_empty() && !ends.iter().any(same) {
                ends.push(end);
            }
        }
    }
    ends
}

fn draw_panel(scene: &mut Scene, part: &Part, x: &Horizontal, y: &Vertical, area: Rect) {
    let panel = part.panel;
    let place = |at: f64, value: f64| -> Option<Point> {
        Some(area.at(x.ruler.fraction(at)?, y.ruler.fraction(value)?))
    };
    x.draw_grid(scene, &area);
    y.draw_grid(scene, &area);
    for band in &panel.bands {
        draw_band(scene, band, &place, &area);
    }
    let mut placer = Placer::new(area);
    let rules: Vec<(&Rule, Point)> =
        panel.rules.iter().filter_map(|rule| placed(rule, x, y, &area)).collect();
    for (rule, (px, py)) in &rules {
        let line = match rule {
            Rule::Horizontal { .. } => [(area.left, *py), (area.right, *py)],
            Rule::Vertical { .. } => [(*px, area.top), (*px, area.bottom)],
        };
        for points in geometry::dash(&line, &[5.0, 3.0]) {
            scene.marks.push(Mark::Stroke { points, width: 1.1, colour: GREY });
        }
        placer.avoid_line(&line);
    }
    let width = if panel.series.len() > 10 { 1.3 } else { 1.8 };
    for (i, series) in panel.series.iter().enumerate() {
        let (colour, dash) = series_look(part.colours_from + i, series);
        let points = || series.x.iter().zip(&series.y).map(|(x, y)| place(*x, *y));
        if series.style != Style::Points {
            for run in geometry::runs(points()) {
                draw_run(scene, &mut placer, &run, &area, width, colour, dash);
            }
        }
        if has_points(series.style) {
            let symbol = symbol(part.colours_from + i, series);
            for centre in points().flatten().filter(|point| area.grown(0.01).contains(*point)) {
                symbol.draw(scene, centre, POINT);
                placer.avoid_line(&[centre]);
            }
        }
    }
    scene.outline(area, 0.9, INK);
    x.draw_ticks(scene, &area);
    let markers =
        panel.markers.iter().filter_map(|marker| Some((place(marker.x, marker.y)?, marker.label.as_str())));
    let markers: Vec<(Point, &str)> = markers.filter(|(at, _)| area.grown(0.01).contains(*at)).collect();
    placer.points(scene, &markers);
    // What is in the ring stays in view.
    for (centre, _) in &markers {
        scene.marks.push(Mark::Disc { centre: *centre, radius: 1.6, colour: INK });
    }
    for (rule, (px, py)) in &rules {
        match rule {
            Rule::Horizontal { label, .. } => placer.along(scene, *py, label, GREY),
            Rule::Vertical { label, .. } => placer.upwards(scene, *px, label, GREY),
        }
    }
}

/// Where a reference line stands, if in view.
fn placed<'a>(rule: &'a Rule, x: &Horizontal, y: &Vertical, area: &Rect) -> Option<(&'a Rule, Point)> {
    let at = match rule {
        Rule::Horizontal { y: value, .. } => area.at(0.0, y.ruler.fraction(*value)?),
        Rule::Vertical { x: value, .. } => area.at(x.ruler.fraction(*value)?, 0.0),
    };
    area.grown(0.01).contains(at).then_some((rule, at))
}

fn draw_run(
    scene: &mut Scene,
    placer: &mut Placer,
    run: &[Point],
    area: &Rect,
    width: f64,
    colour: Colour,
    dash: &[f64],
) {
    // A number between two gaps would not show as a line.
    if let [centre] = run {
        if area.contains(*centre) {
            scene.marks.push(Mark::Disc { centre: *centre, radius: 0.9 * width, colour });
        }
        return;
    }
    for part in geometry::clip(&geometry::thin(run), area) {
        placer.avoid_line(&part);
        let strokes = if dash.is_empty() { vec![part] } else { geometry::dash(&part, dash) };
        scene.marks.extend(strokes.into_iter().map(|points| Mark::Stroke { points, width, colour }));
    }
}

fn draw_band(scene: &mut Scene, band: &Band, place: &impl Fn(f64, f64) -> Option<Point>, area: &Rect) {
    let edges = band.x.iter().zip(&band.low).zip(&band.high).map(|((x, low), high)| {
        let ((px, low), (_, high)) = (place(*x, *low)?, place(*x, *high)?);
        Some((px, low, high))
    });
    let edges: Vec<Option<(f64, f64, f64)>> = edges.collect();
    for run in edges.split(Option::is_none) {
        let run: Vec<(f64, f64, f64)> = run.iter().flatten().copied().collect();
        let (x, upper, lower) = geometry::clip_area(&run, area);
        if x.len() > 1 {
            scene.marks.push(Mark::Area { x, upper, lower, colour: band_colour(band) });
        }
    }
}
