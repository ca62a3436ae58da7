//! Lays out a heat map.

use super::axis::{Axis, Ruler, transform};
use super::colour::{self, Colour, GREY, INK, NO_VALUE, WHITE};
use super::contour;
use super::frame::{self, Horizontal, Vertical};
use super::geometry;
use super::heatmap::{HeatMap, edges};
use super::label::{Placer, RIM};
use super::legend::{self, Entry, Key, Legend};
use super::scene::{Mark, Point, Rect, Scene};
use super::ticks;
use hadar::Result;

const HEIGHT: f64 = 420.0;
const BAR: f64 = 18.0;
/// Shades of colour, halved until at most so many rectangles are drawn or the coarsest are reached.
const FINEST: u16 = 128;
const GROUND: u16 = 16;
const MOST_CELLS: usize = 10_000;
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

    let lattice = Lattice::new(&x, &y, &columns, &rows, area);
    let missing = draw_cells(&mut scene, map, &colours, &lattice);
    let mut placer = Placer::new(area);
    draw_contours(&mut scene, &mut placer, map, &x, &y, &area);
    scene.outline(area, 0.9, INK);
    x.draw_ticks(&mut scene, &area);
    x.draw_secondary(&mut scene, &area);
    y.draw_left(&mut scene, &area, if x.room_above() > 0.0 { 14.0 } else { 0.0 });
    for marker in &map.markers {
        let at = x.ruler.fraction(marker.x).zip(y.ruler.fraction(marker.y)).map(|(x, y)| area.at(x, y));
        let Some(at) = at.filter(|at| area.grown(0.01).contains(*at)) else { continue };
        draw_ring(&mut scene, at);
        placer.point(&mut scene, at, &marker.label);
    }
    let values = map.values.iter().copied();
    draw_bar(&mut scene, values, &bar, &Rect { left: right + 18.0, right: right + 18.0 + BAR, ..area });

    let below = x.draw_labels(&mut scene, &area);
    let missing = missing.map(|key| Entry { key, label: map.no_value.clone() });
    let legend = Legend::new(missing.into_iter().collect(), right - left, HEIGHT);
    scene.height = (legend.draw_below(&mut scene, left, frame::WIDTH - 12.0, below) + 10.0).ceil();
    Ok(scene)
}

/// Stated range, or all of the cells.
fn over(axis: &Axis, edges: &[f64]) -> Ruler {
    let (low, high) = (edges.first().copied(), edges.last().copied());
    Ruler::over(axis.scale, axis.range, low.unwrap_or(f64::INFINITY), high.unwrap_or(f64::NEG_INFINITY), 0.0)
}

/// A lattice of cells in pixels: the edges of the columns and of the rows.
struct Lattice {
    x: Vec<f64>,
    y: Vec<f64>,
    frame: Rect,
}

impl Lattice {
    fn new(x: &Horizontal, y: &Vertical, columns: &[f64], rows: &[f64], frame: Rect) -> Self {
        let x = columns.iter().map(|t| frame.at(x.ruler.place(*t), 0.0).0).collect();
        let y = rows.iter().map(|t| frame.at(0.0, y.ruler.place(*t)).1).collect();
        Self { x, y, frame }
    }

    /// The part of a block, grown by some pixels, that is in view.
    fn area(&self, block: &Block, grown: f64) -> Option<Rect> {
        let edges = |edges: &[f64], (from, to): (usize, usize)| {
            edges.get(from).zip(edges.get(to)).map(|(a, b)| (a.min(*b) - grown, a.max(*b) + grown))
        };
        let ((left, right), (top, bottom)) = (edges(&self.x, block.columns)?, edges(&self.y, block.rows)?);
        let area = Rect {
            left: left.max(self.frame.left),
            right: right.min(self.frame.right),
            top: top.max(self.frame.top),
            bottom: bottom.min(self.frame.bottom),
        };
        (area.width() > 0.0 && area.height() > 0.0).then_some(area)
    }
}

/// Cells as blocks of one out of `shades` shades.
fn shaded(map: &HeatMap, colours: &Ruler, shades: u16) -> Vec<Block> {
    let shade = |value: &f64| {
        let part = colours.fraction(*value)?.clamp(0.0, 1.0);
        Some(((part * f64::from(shades)) as u16).min(shades - 1))
    };
    merged(&map.values.iter().map(shade).collect::<Vec<_>>(), map.columns.len())
}

fn shade_colour(shade: u16, shades: u16) -> Colour {
    colour::quantity((f64::from(shade) + 0.5) / f64::from(shades))
}

/// Draws the cells; says how those without value look, if there are any.
fn draw_cells(scene: &mut Scene, map: &HeatMap, colours: &Ruler, lattice: &Lattice) -> Option<Key> {
    // Where two cells meet inside a pixel, the ground shines through: similar colours are laid below.
    let ground = shaded(map, colours, GROUND);
    for block in ground.iter().filter(|_| ground.len() <= MOST_CELLS / 4) {
        if let Some((shade, area)) = block.shade.zip(lattice.area(block, 0.7)) {
            scene.fill(area, shade_colour(shade, GROUND));
        }
    }
    let mut shades = FINEST;
    let mut blocks = shaded(map, colours, shades);
    while blocks.len() > MOST_CELLS && shades > GROUND {
        shades /= 2;
        blocks = shaded(map, colours, shades);
    }
    let mut missing = Vec::new();
    for block in &blocks {
        let Some(area) = lattice.area(block, 0.0) else { continue };
        match block.shade {
            Some(shade) => scene.fill(area, shade_colour(shade, shades)),
            None => missing.push(area),
        }
    }
    if missing.len() > MOST_HATCHED {
        missing.iter().for_each(|area| scene.fill(*area, NO_VALUE));
        return Some(Key::Area { colour: NO_VALUE });
    }
    missing.iter().for_each(|area| legend::hatch(scene, *area));
    outline_missing(scene, map, colours, lattice);
    (!missing.is_empty()).then_some(Key::Hatched)
}

/// Lines between cells with and without value.
fn outline_missing(scene: &mut Scene, map: &HeatMap, colours: &Ruler, lattice: &Lattice) {
    let width = map.columns.len();
    let known: Vec<bool> = map.values.iter().map(|value| colours.fraction(*value).is_some()).collect();
    let at = |row: usize, column: usize| known.get(row * width + column).copied();
    let mut line = |from: Option<Point>, to: Option<Point>| {
        for points in from.zip(to).map(|(a, b)| geometry::clip(&[a, b], &lattice.frame)).unwrap_or_default() {
            scene.marks.push(Mark::Stroke { points, width: 0.7, colour: GREY });
        }
    };
    let node = |row: usize, column: usize| Some((*lattice.x.get(column)?, *lattice.y.get(row)?));
    for row in 0..map.rows.len() {
        for column in 0..width {
            if column + 1 < width && at(row, column) != at(row, column + 1) {
                line(node(row, column + 1), node(row + 1, column + 1));
            }
            if row + 1 < map.rows.len() && at(row, column) != at(row + 1, column) {
                line(node(row + 1, column), node(row + 1, column + 1));
            }
        }
    }
}

/// A rectangle of cells of one shade: columns and rows from the first to before the last.
struct Block {
    shade: Option<u16>,
    columns: (usize, usize),
    rows: (usize, usize),
}

/// Covers the grid with rectangles of one shade, each as wide and then as high as it can be.
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
                placer.avoid_line(&part);
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

/// The colour bar with its scale, and tips where there are values beyond it.
pub(super) fn draw_bar(scene: &mut Scene, values: impl Iterator<Item = f64>, axis: &Vertical, bar: &Rect) {
    const STRIPS: u16 = 96;
    for i in (0..STRIPS).rev() {
        let part = |i: u16| f64::from(i) / f64::from(STRIPS);
        let colour = colour::quantity(part(i) + 0.5 / f64::from(STRIPS));
        // From its own upper edge down to the end: the next ones are painted over it without a seam.
        scene.fill(Rect { top: bar.at(0.0, part(i + 1)).1, ..*bar }, colour);
    }
    scene.outline(*bar, 0.9, INK);
    // A tip at an end of the bar: there are values beyond it.
    let (mut least, mut most) = (0.0f64, 1.0f64);
    for part in values.filter_map(|value| axis.ruler.fraction(value)) {
        (least, most) = (least.min(part), most.max(part));
    }
    let middle = 0.5 * (bar.left + bar.right);
    let x = vec![bar.left, middle, bar.right];
    if most > 1.0 + 1e-9 {
        let base = bar.top - 2.0;
        let upper = vec![base, base - 9.0, base];
        scene.marks.push(Mark::Area {
            x: x.clone(),
            upper,
            lower: vec![base; 3],
            colour: colour::quantity(1.0),
        });
    }
    if least < -1e-9 {
        let base = bar.bottom + 2.0;
        let lower = vec![base, base + 9.0, base];
        scene.marks.push(Mark::Area { x, upper: vec![base; 3], lower, colour: colour::quantity(0.0) });
    }
    axis.draw_right(scene, bar);
}

/// A ring that is seen on any colour and leaves the cell in it open to view.
fn draw_ring(scene: &mut Scene, (x, y): Point) {
    let round = |i: u32| std::f64::consts::TAU * f64::from(i) / 48.0;
    let points: Vec<Point> = (0..=48).map(|i| (x + RIM * round(i).cos(), y + RIM * round(i).sin())).collect();
    for (width, colour) in [(4.0, WHITE), (1.8, INK)] {
        scene.marks.push(Mark::Stroke { points: points.clone(), width, colour });
    }
}
