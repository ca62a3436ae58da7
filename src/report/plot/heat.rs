//! Lays out a heat map.

use super::axis::{Axis, Ruler, transform};
use super::colour::{self, INK, WHITE};
use super::contour;
use super::frame::{self, Horizontal, Vertical};
use super::geometry;
use super::heatmap::{HeatMap, edges};
use super::label::Placer;
use super::legend::{self, Entry, Key, Legend};
use super::lines::draw_marker;
use super::scene::{Mark, Point, Rect, Scene};
use super::ticks;
use crate::Result;

const HEIGHT: f64 = 420.0;
const BAR: f64 = 18.0;
/// Shades of colour: fewer where the cells would otherwise make a document too large.
const SHADES: [u16; 4] = [128, 64, 32, 16];
const MOST_CELLS: usize = 12_000;

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

    x.draw_grid(&mut scene, &area);
    y.draw_grid(&mut scene, &area);
    let any_missing = draw_cells(&mut scene, map, &colours, &place(&x, &y, &area), (&columns, &rows), &area);
    let mut placer = Placer::new(area);
    draw_contours(&mut scene, &mut placer, map, &x, &y, &area);
    scene.outline(area, 0.9, INK);
    x.draw_ticks(&mut scene, &area);
    x.draw_secondary(&mut scene, &area);
    y.draw_left(&mut scene, &area, if x.room_above() > 0.0 { 14.0 } else { 0.0 });
    for marker in &map.markers {
        let at = x.ruler.fraction(marker.x).zip(y.ruler.fraction(marker.y)).map(|(x, y)| area.at(x, y));
        let Some(at) = at.filter(|at| area.grown(0.01).contains(*at)) else { continue };
        draw_marker(&mut scene, at);
        placer.point(&mut scene, at, &marker.label);
    }
    draw_bar(&mut scene, map, &bar, &Rect { left: right + 18.0, right: right + 18.0 + BAR, ..area });

    let below = x.draw_labels(&mut scene, &area);
    let missing = Entry { key: Key::Hatched, label: map.no_value.clone() };
    let legend = Legend::new(any_missing.then_some(missing).into_iter().collect(), right - left, HEIGHT);
    scene.height = (legend.draw_below(&mut scene, left, frame::WIDTH - 12.0, below) + 10.0).ceil();
    Ok(scene)
}

/// Stated range, or all of the cells.
fn over(axis: &Axis, edges: &[f64]) -> Ruler {
    let (low, high) = (edges.first().copied(), edges.last().copied());
    Ruler::over(axis.scale, axis.range, low.unwrap_or(f64::INFINITY), high.unwrap_or(f64::NEG_INFINITY), 0.0)
}

/// Pixel of a position on the transformed scales.
fn place(x: &Horizontal, y: &Vertical, area: &Rect) -> impl Fn(f64, f64) -> Point + use<> {
    let (x, y, area) = (x.ruler, y.ruler, *area);
    move |at, value| area.at(x.place(at), y.place(value))
}

/// Draws the cells, neighbours of one shade as one rectangle; says whether any is without value.
fn draw_cells(
    scene: &mut Scene,
    map: &HeatMap,
    colours: &Ruler,
    place: &impl Fn(f64, f64) -> Point,
    (columns, rows): (&[f64], &[f64]),
    area: &Rect,
) -> bool {
    let width = map.columns.len();
    let mut blocks = Vec::new();
    let mut shades = 1;
    for candidate in SHADES {
        shades = candidate;
        let shade = |value: &f64| {
            let part = colours.fraction(*value)?.clamp(0.0, 1.0);
            Some(((part * f64::from(shades)) as u16).min(shades - 1))
        };
        blocks = merged(&map.values.iter().map(shade).collect::<Vec<_>>(), width);
        if blocks.len() <= MOST_CELLS {
            break;
        }
    }
    let mut missing = Vec::new();
    for Block { shade, columns: (c0, c1), rows: (r0, r1) } in blocks {
        let edge = |edges: &[f64], i: usize| edges.get(i).copied().unwrap_or(0.0);
        let (a, b) = (place(edge(columns, c0), edge(rows, r0)), place(edge(columns, c1), edge(rows, r1)));
        let cell = Rect {
            left: a.0.min(b.0).max(area.left),
            right: a.0.max(b.0).min(area.right),
            top: a.1.min(b.1).max(area.top),
            bottom: a.1.max(b.1).min(area.bottom),
        };
        if cell.width() <= 0.0 || cell.height() <= 0.0 {
            continue;
        }
        match shade {
            Some(shade) => {
                let colour = colour::quantity((f64::from(shade) + 0.5) / f64::from(shades));
                scene.marks.push(Mark::Rect { area: cell, colour, bleeds: true });
            }
            None => missing.push(cell),
        }
    }
    for cell in &missing {
        legend::hatch(scene, *cell);
    }
    !missing.is_empty()
}

/// A rectangle of cells of one shade: columns and rows from the first to before the last.
struct Block {
    shade: Option<u16>,
    columns: (usize, usize),
    rows: (usize, usize),
}

/// Covers the grid with rectangles of one shade, each as wide and then as high as it can be; from the top
/// row down, so that what bleeds over an edge is painted over.
fn merged(shades: &[Option<u16>], width: usize) -> Vec<Block> {
    let height = shades.len().checked_div(width).unwrap_or(0);
    let mut free = vec![true; shades.len()];
    let mut blocks = Vec::new();
    for row in (0..height).rev() {
        for column in 0..width {
            let start = row * width + column;
            let (Some(true), Some(&shade)) = (free.get(start), shades.get(start)) else { continue };
            let same = |free: &[bool], i: usize| free.get(i) == Some(&true) && shades.get(i) == Some(&shade);
            let end = (column..width).find(|c| !same(&free, row * width + c)).unwrap_or(width);
            let fits = |r: &usize| (column..end).all(|c| same(&free, r * width + c));
            let low = (0..row).rev().take_while(fits).last().unwrap_or(row);
            for flags in (low..=row).map(|r| (r * width + column, r * width + end)) {
                free.get_mut(flags.0..flags.1).unwrap_or_default().fill(false);
            }
            blocks.push(Block { shade, columns: (column, end), rows: (low, row + 1) });
        }
    }
    blocks
}

fn draw_contours(
    scene: &mut Scene,
    placer: &mut Placer,
    map: &HeatMap,
    x: &Horizontal,
    y: &Vertical,
    area: &Rect,
) {
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
                if part.len() > longest.len() {
                    longest = part;
                }
            }
        }
        labels.push((longest, ticks::label(*level)));
    }
    for (line, text) in labels {
        placer.on_line(scene, &line, &text);
    }
}

fn draw_bar(scene: &mut Scene, map: &HeatMap, axis: &Vertical, bar: &Rect) {
    const STRIPS: u16 = 96;
    for i in (0..STRIPS).rev() {
        let part = |i: u16| f64::from(i) / f64::from(STRIPS);
        let colour = colour::quantity(part(i) + 0.5 / f64::from(STRIPS));
        let strip = Rect { top: bar.at(0.0, part(i + 1)).1, bottom: bar.at(0.0, part(i)).1, ..*bar };
        scene.marks.push(Mark::Rect { area: strip, colour, bleeds: i > 0 });
    }
    scene.outline(*bar, 0.9, INK);
    // A tip at an end of the bar: there are values beyond it.
    let parts = || map.values.iter().filter_map(|value| axis.ruler.fraction(*value));
    let middle = 0.5 * (bar.left + bar.right);
    let x = vec![bar.left, middle, bar.right];
    if parts().any(|part| part > 1.0 + 1e-9) {
        let base = bar.top - 2.0;
        let upper = vec![base, base - 9.0, base];
        scene.marks.push(Mark::Area {
            x: x.clone(),
            upper,
            lower: vec![base; 3],
            colour: colour::quantity(1.0),
        });
    }
    if parts().any(|part| part < -1e-9) {
        let base = bar.bottom + 2.0;
        let lower = vec![base, base + 9.0, base];
        scene.marks.push(Mark::Area { x, upper: vec![base; 3], lower, colour: colour::quantity(0.0) });
    }
    axis.draw_right(scene, bar);
}
