//! Lays out a matrix of named rows and columns.
//!
//! The names get the room that they need at a size that follows from the cells, which get what is left. Names
//! of columns are turned unless all fit above their cells.

use super::axis::{Ruler, Scale};
use super::colour::{self, Colour, INK, NO_VALUE, WHITE};
use super::frame::{self, AXIS_TITLE, EDGE, TICK, Vertical};
use super::heat;
use super::legend::{self, Entry, Key, Legend};
use super::matrix::Matrix;
use super::names::{self, NARROW, Names, SHARE};
use super::scene::{Anchor, Mark, Rect, Scene};
use super::text;
use super::ticks;
use hadar::Result;

/// Longest line of the title of the columns.
const ACROSS: f64 = frame::WIDTH - 2.0 * EDGE;
/// Room for the title of the rows, however few.
const SHORTEST_TITLE: f64 = 120.0;
const BAR: f64 = 18.0;
const BAR_GAP: f64 = 18.0;
/// Tallest colour bar, and the shortest that still holds a scale.
const BAR_HEIGHT: std::ops::Range<f64> = 150.0..420.0;
/// From the cells to the names.
const NAME_GAP: f64 = 5.0;
/// Widest and highest cell.
const WIDEST: f64 = 150.0;
const HIGHEST: f64 = 75.0;
/// Height up to which rows are as high as columns are wide, however few the columns.
const TALL: f64 = 620.0;
/// Numbers in cells.
const NUMBER: f64 = 10.0;
/// Patches without value that are hatched; more of them are plain grey.
const MOST_HATCHED: usize = 500;
/// Edges of cells stand at whole pixels of the PNG, so that the cells are all alike.
const PIXELS: f64 = super::png::SCALE;
/// Size below which cells are pixels of one image: nothing separates or marks them.
const FINE: f64 = 4.0;
/// Fraction of the colour scale above which colours are light.
const LIGHT: f64 = 0.55;

pub(super) fn scene(matrix: &Matrix) -> Result<Scene> {
    matrix.check()?;
    let known = || matrix.cells().map(|cell| cell.2);
    let grid = Grid::new(matrix, colours(matrix));

    let mut scene = Scene::new(&matrix.title, frame::WIDTH);
    let title = title_room(&matrix.column_title, ACROSS);
    let heading = frame::heading(&mut scene, &matrix.title, &matrix.subtitle) + 4.0;
    let top = snapped(heading + title + (grid.columns.room + NAME_GAP).max(14.0), f64::ceil);
    // Nothing separates the last cells from the frame.
    let along = |pitch: f64, count: usize| (pitch * count as f64 - grid.gap).max(0.0);
    let (width, height) = (along(grid.cell.0, matrix.columns.len()), along(grid.cell.1, matrix.rows.len()));
    let area = Rect { left: grid.left, right: grid.left + width, top, bottom: top + height };

    for (i, line) in text::wrap(&matrix.column_title, AXIS_TITLE, ACROSS).iter().enumerate() {
        let half = 0.5 * text::width(line, AXIS_TITLE);
        let middle = (0.5 * (area.left + area.right)).min(frame::WIDTH - EDGE - half).max(EDGE + half);
        let y = heading + AXIS_TITLE * (1.0 + i as f64 * text::LEADING);
        scene.text((middle, y), line, AXIS_TITLE, INK, Anchor::Middle);
    }
    for (i, line) in text::wrap(&matrix.row_title, AXIS_TITLE, grid.upwards).iter().enumerate() {
        let x = EDGE + AXIS_TITLE * (0.8 + i as f64 * text::LEADING);
        scene.turned((x, 0.5 * (area.top + area.bottom)), line, AXIS_TITLE, INK, Anchor::Middle);
    }
    grid.draw_names(&mut scene, &area);
    let entries = grid.draw_cells(&mut scene, matrix, &area);
    draw_groups(&mut scene, matrix, &grid, &area);
    scene.outline(area, 0.9, INK);

    let bar_left = area.right + BAR_GAP;
    let bar = Rect { left: bar_left, right: bar_left + BAR, top, bottom: top + grid.bar_height };
    let fractions = known().filter_map(|value| grid.bar.ruler.fraction(value));
    heat::draw_bar(&mut scene, fractions, &grid.bar, &bar, &colour::map(&grid.bar.ruler));
    if let Some(part) = matrix.threshold.as_ref().and_then(|t| grid.bar.ruler.fraction(t.value))
        && (0.0..=1.0).contains(&part)
    {
        let (_, y) = bar.at(0.0, part);
        for (width, colour) in [(3.4, WHITE), (1.4, INK)] {
            scene.line((bar.left - 4.0, y), (bar.right, y), width, colour);
        }
    }
    let below = area.bottom.max(bar.bottom + 9.0) + 12.0;
    let legend = Legend::new(entries, frame::WIDTH - 2.0 * EDGE, 0.0);
    let end = legend.draw_below(&mut scene, area.left.min(240.0), frame::WIDTH - EDGE, below);
    scene.height = (end + 10.0).ceil();
    Ok(scene)
}

fn colours(matrix: &Matrix) -> Ruler {
    let values = matrix.cells().map(|cell| cell.2);
    Ruler::fit(matrix.colour.scale, matrix.colour.range, values, 0.0)
}

/// Whether the cells are so many that they are pixels of one image.
pub(super) fn is_image(matrix: &Matrix) -> bool {
    // Only many are laid out to find out.
    let many = (frame::WIDTH.max(TALL) / FINE) as usize / 2;
    let many = matrix.rows.len().max(matrix.columns.len()) > many;
    many && matrix.check().is_ok() && Grid::new(matrix, colours(matrix)).gap == 0.0
}

/// Room that the title of a side needs in lines of this length.
fn title_room(title: &str, limit: f64) -> f64 {
    let lines = text::wrap(title, AXIS_TITLE, limit).len() as f64;
    if lines == 0.0 { 0.0 } else { AXIS_TITLE * text::LEADING * lines + 5.0 }
}

/// To a whole pixel of the PNG.
fn snapped(value: f64, round: fn(f64) -> f64) -> f64 {
    round(value * PIXELS) / PIXELS
}

/// Sizes of everything that depends on everything else.
struct Grid {
    rows: Names,
    columns: Names,
    bar: Vertical,
    bar_height: f64,
    left: f64,
    /// Width and height of a cell.
    cell: (f64, f64),
    /// What separates two cells.
    gap: f64,
    /// Longest line of the title of the rows.
    upwards: f64,
}

impl Grid {
    fn new(matrix: &Matrix, colours: Ruler) -> Self {
        let (rows, columns) = (matrix.rows.len().max(1) as f64, matrix.columns.len().max(1) as f64);
        let mut pitch = 20.0;
        let mut grid = Self::with(matrix, colours, (pitch, pitch));
        // Smaller letters leave more room for the cells, larger cells take larger letters.
        for _ in 0..6 {
            let right = frame::WIDTH - grid.bar.room() - BAR - BAR_GAP;
            pitch = ((right - grid.left) / columns).min(WIDEST);
            let high = pitch.min(HIGHEST).min((TALL / rows).max(pitch.min(TICK / SHARE)));
            // A single row is not a thread.
            let high = high.max((BAR_HEIGHT.start / rows).min(HIGHEST));
            let cell = (snapped(pitch, f64::floor), snapped(high, f64::floor));
            grid = Self::with(matrix, colours, cell);
        }
        // Whatever the last round has changed, the cells must end before the colour bar.
        let right = frame::WIDTH - grid.bar.room() - BAR - BAR_GAP;
        let widest = snapped((right - grid.left) / columns, f64::floor).max(1.0 / PIXELS);
        grid.cell.0 = grid.cell.0.min(widest);
        grid.columns = Names::new(&matrix.columns, grid.cell.0, names::WIDE, Some(grid.cell.0));
        grid
    }

    fn with(matrix: &Matrix, colours: Ruler, cell: (f64, f64)) -> Self {
        let rows = Names::new(&matrix.rows, cell.1, NARROW, None);
        let columns = Names::new(&matrix.columns, cell.0, names::WIDE, Some(cell.0));
        let height = cell.1 * matrix.rows.len() as f64;
        let bar_height = height.clamp(BAR_HEIGHT.start, BAR_HEIGHT.end);
        let bar = Vertical::new(&matrix.colour, colours, bar_height);
        let upwards = height.max(SHORTEST_TITLE);
        let title = title_room(&matrix.row_title, upwards);
        let left = snapped(EDGE + title + rows.room + NAME_GAP + 2.0, f64::ceil);
        let gap = if cell.0.min(cell.1) < FINE { 0.0 } else { 1.0 / PIXELS };
        Self { rows, columns, bar, bar_height, left, cell, gap, upwards }
    }

    fn draw_names(&self, scene: &mut Scene, area: &Rect) {
        for (i, below, line) in self.rows.printed() {
            let y = area.top + self.cell.1 * (i as f64 + 0.5) + 0.36 * self.rows.size + below;
            scene.text((area.left - NAME_GAP, y), line, self.rows.size, INK, Anchor::End);
        }
        for (i, below, line) in self.columns.printed() {
            let (x, y) = (area.left + self.cell.0 * (i as f64 + 0.5), area.top - NAME_GAP);
            let size = self.columns.size;
            if self.columns.turned {
                scene.turned((x + 0.36 * size + below, y), line, size, INK, Anchor::Start);
            } else {
                scene.text((x, y - 1.0 + below - self.columns.drop()), line, size, INK, Anchor::Middle);
            }
        }
    }

    fn area_of(&self, row: usize, column: usize, area: &Rect) -> Rect {
        let (left, top) = (area.left + self.cell.0 * column as f64, area.top + self.cell.1 * row as f64);
        Rect { left, top, right: left + self.cell.0 - self.gap, bottom: top + self.cell.1 - self.gap }
    }

    /// Whether the numbers fit into the cells.
    fn has_numbers(&self, matrix: &Matrix) -> bool {
        let most = self.cell.0 - 10.0;
        self.cell.1 >= 2.4 * NUMBER
            && matrix.cells().all(|cell| text::width(&ticks::label(cell.2), NUMBER) <= most)
    }

    /// Cells with their marks; returns what the legend says of them.
    fn draw_cells(&self, scene: &mut Scene, matrix: &Matrix, area: &Rect) -> Vec<Entry> {
        let ruler = &self.bar.ruler;
        let missing = matrix.cells().filter(|cell| !cell.2.is_finite()).count();
        if self.gap == 0.0 {
            let mut pixels = vec![WHITE.rgb; matrix.values.len()];
            for (row, column, value) in matrix.cells() {
                let known = || heat::shade(ruler, fraction(ruler, value));
                let colour = if value.is_finite() { known() } else { NO_VALUE };
                pixels[row * matrix.columns.len() + column] = colour.rgb;
            }
            scene.marks.push(Mark::Image { area: *area, columns: matrix.columns.len(), pixels });
            let entry = |colour, label| Entry { key: Key::Area { colour }, label };
            let below = matrix.threshold.as_ref().map(|threshold| {
                let label = format!("{}, below the line on the scale", threshold.meaning);
                entry(heat::shade(ruler, 0.5 * fraction(ruler, threshold.value)), label)
            });
            let unknown = (missing > 0).then(|| entry(NO_VALUE, matrix.no_value.clone()));
            return below.into_iter().chain(unknown).collect();
        }
        let numbers = self.has_numbers(matrix);
        let mut marked = None;
        for (row, column, value) in matrix.cells() {
            let place = self.area_of(row, column, area);
            if !value.is_finite() {
                if missing > MOST_HATCHED {
                    scene.fill(place, NO_VALUE)
                } else {
                    legend::hatch(scene, place)
                }
                continue;
            }
            let part = fraction(ruler, value);
            let colour = colour::map(ruler)(part);
            let ink = ink_on(ruler, part);
            scene.fill(place, colour);
            if numbers {
                let (x, y) = place.at(0.5, 0.5);
                scene.text((x, y + 0.36 * NUMBER), &ticks::label(value), NUMBER, ink, Anchor::Middle);
            }
            if matrix.is_marked(row, column, value) {
                marked.get_or_insert((colour, ink));
                let smaller = place.width().min(place.height());
                let radius = if numbers { 3.0 } else { (0.2 * smaller).clamp(0.7, 4.0) };
                let (x, y) = place.at(0.5, 0.5);
                let centre = if numbers { (place.right - 8.0, place.top + 8.0) } else { (x, y) };
                scene.marks.push(Mark::Disc { centre, radius, colour: ink });
            }
        }
        let below = marked.zip(matrix.threshold.as_ref()).map(|((colour, ink), threshold)| Entry {
            key: Key::Dotted { colour, ink },
            label: threshold.meaning.clone(),
        });
        let key = if missing > MOST_HATCHED { Key::Area { colour: NO_VALUE } } else { Key::Hatched };
        let unknown = (missing > 0).then(|| Entry { key, label: matrix.no_value.clone() });
        below.into_iter().chain(unknown).collect()
    }
}

/// Part of the colour scale; its lower end for what has no logarithm.
fn fraction(ruler: &Ruler, value: f64) -> f64 {
    let lowest = if ruler.scale == Scale::Log && ruler.first > ruler.last { 1.0 } else { 0.0 };
    ruler.fraction(value).unwrap_or(lowest).clamp(0.0, 1.0)
}

/// What is seen on the colour at this part of a scale.
fn ink_on(ruler: &Ruler, part: f64) -> Colour {
    let is_light = if colour::is_signed(ruler) { (0.2..0.8).contains(&part) } else { part >= LIGHT };
    if is_light { INK } else { WHITE }
}

/// Lines between groups, a little longer than the cells.
fn draw_groups(scene: &mut Scene, matrix: &Matrix, grid: &Grid, area: &Rect) {
    let beyond = NAME_GAP - 1.0;
    let lines = |starts: &[usize], from: f64, pitch: f64| -> Vec<f64> {
        let inner = starts.iter().filter(|start| **start > 0);
        inner.map(|start| from + pitch * *start as f64 - 0.5 * grid.gap).collect()
    };
    let rows = lines(&matrix.row_groups, area.top, grid.cell.1);
    let columns = lines(&matrix.column_groups, area.left, grid.cell.0);
    for (width, colour) in [(2.6, WHITE), (1.0, INK)] {
        for &y in &rows {
            scene.line((area.left - beyond, y), (area.right, y), width, colour);
        }
        for &x in &columns {
            scene.line((x, area.top - beyond), (x, area.bottom), width, colour);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::axis::Axis;

    /// Where lines between cells would leave nothing of them, they are one image, whose pixels are the cells.
    #[test]
    fn very_many_cells_are_pixels_of_an_image() {
        let names: Vec<String> = (0..1000).map(|i| format!("m{i}")).collect();
        let values = (0..1_000_000).map(|i| f64::from(i % 1000)).collect();
        let colour = Axis::linear("d").range(0.0, 999.0);
        let matrix = Matrix::new("many", ("target", names.clone()), ("alternative", names), (colour, values));
        let sample = matrix.threshold(10.0, "too near");
        let drawn = scene(&sample).unwrap();
        let mut images = drawn.marks.iter().filter_map(|mark| match mark {
            Mark::Image { columns, pixels, .. } => Some((*columns, pixels)),
            _ => None,
        });
        let (columns, pixels) = images.next().unwrap();
        assert_eq!((columns, pixels.len()), (1000, 1_000_000));
        assert_eq!(pixels[5], heat::shade(&colours(&sample), 5.0 / 999.0).rgb);
        assert_eq!(pixels[999_005], heat::shade(&colours(&sample), 5.0 / 999.0).rgb);
        assert_eq!(pixels[1001], WHITE.rgb, "a name beside itself");
        assert!(drawn.marks.len() < 5000, "{}", drawn.marks.len());
    }
}
