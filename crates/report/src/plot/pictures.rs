//! Images side by side, each with its own colour bar: a raster of numbers per picture. Images of one colour axis share a bar; of an
//! odd number of images the legend takes the place that is left.

use super::axis::{Axis, Ruler};
use super::colour::{self, Colour, INK, NO_SIGNED_VALUE, NO_VALUE, WHITE};
use super::contour;
use super::frame::{self, Vertical};
use super::heat::{draw_bar, shade};
use super::label::Placer;
use super::legend::{CASED, Entry, Key, Legend};
use super::scene::{Anchor, Mark, Point, Rect, Scene};
use super::text::{self, LEADING};
use hadar::{Error, Result};
use rayon::prelude::*;

/// Width of a colour bar, and its distance from the picture.
const BAR: f64 = 11.0;
const APART: f64 = 8.0;
/// Shorter lines between signs are noise, in logical pixels.
const SHORTEST: f64 = 40.0;
/// Between two pictures.
const GAP: f64 = 14.0;
const TITLE: f64 = 12.5;
/// A picture taller than this is made narrower.
const HIGHEST: f64 = 420.0;

/// One image.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// What it shows, in a few words above it.
    pub title: String,
    /// The colour axis: title with unit, scale, range.
    pub colour: Axis,
    /// Pixels of a row.
    pub columns: usize,
    /// Values, row after row, the uppermost first.
    pub values: Vec<f64>,
    /// Colours in the place of values.
    pub painted: Option<Painted>,
    /// Rows that are marked by a dashed line.
    pub lines: Vec<usize>,
    /// Values, one for each pixel, between whose signs a line is drawn; nowhere where empty.
    pub boundary: Vec<f64>,
    /// Words beside a pixel (row, column): what is there.
    pub labels: Vec<(usize, usize, String)>,
}

/// Colours of an image that are no scale of one quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct Painted {
    /// Red, green and blue, row after row, the uppermost first.
    pub pixels: Vec<Rgb>,
    /// Colours at the ends of the bar of the colour axis, which must have a range; no bar without them.
    pub ramp: Option<[Rgb; 2]>,
}

/// Red, green and blue.
pub type Rgb = (u8, u8, u8);

/// Images side by side, two in a row.
#[derive(Debug, Clone, PartialEq)]
pub struct Pictures {
    /// One line that says what is shown; wraps when long.
    pub title: String,
    /// Small print under the title; nothing where empty.
    pub subtitle: String,
    /// The images, from left to right and from top to bottom.
    pub pictures: Vec<Picture>,
    /// What a pixel without value means, for the legend.
    pub no_value: String,
    /// What the lines between signs mean, for the legend.
    pub boundary_meaning: String,
    /// Colours of painted images and what they mean, for the legend.
    pub keys: Vec<(Rgb, String)>,
}

impl Picture {
    /// An image of `columns` × (number of values / `columns`) pixels.
    pub fn new(title: impl Into<String>, colour: Axis, columns: usize, values: Vec<f64>) -> Self {
        let (title, painted) = (title.into(), None);
        let (lines, boundary, labels) = (Vec::new(), Vec::new(), Vec::new());
        Self { title, colour, columns, values, painted, lines, boundary, labels }
    }

    /// An image of colours.
    pub fn painted(title: impl Into<String>, colour: Axis, columns: usize, painted: Painted) -> Self {
        Self { painted: Some(painted), ..Self::new(title, colour, columns, Vec::new()) }
    }

    /// Marks rows by dashed lines.
    #[must_use]
    pub fn lines(mut self, rows: &[usize]) -> Self {
        self.lines = rows.to_vec();
        self
    }

    /// Draws a line where these values, one for each pixel, change their sign.
    #[must_use]
    pub fn boundary(mut self, values: Vec<f64>) -> Self {
        self.boundary = values;
        self
    }

    /// Names what is at a pixel.
    #[must_use]
    pub fn label(mut self, row: usize, column: usize, words: impl Into<String>) -> Self {
        self.labels.push((row, column, words.into()));
        self
    }

    /// Names areas, each in the middle of its longest run along a row: of every pixel its area, of every area its name. Areas of less
    /// than a hundredth of a row have no name.
    #[must_use]
    pub fn name_areas(mut self, areas: &[Option<usize>], names: &[String]) -> Self {
        let mut longest: Vec<(usize, usize)> = vec![(0, 0); names.len()];
        let columns = self.columns.max(1);
        for (row, of_row) in areas.chunks(columns).enumerate() {
            let mut from = row * columns;
            for run in of_row.chunk_by(|a, b| a == b) {
                let area = run.first().copied().flatten().and_then(|area| longest.get_mut(area));
                if let Some(best) = area.filter(|best| run.len() > best.0) {
                    *best = (run.len(), from + run.len() / 2);
                }
                from += run.len();
            }
        }
        for ((length, middle), name) in longest.into_iter().zip(names) {
            if length > columns / 100 + 1 {
                self.labels.push((middle / columns, middle % columns, name.clone()));
            }
        }
        self
    }

    fn rows(&self) -> usize {
        self.pixels().checked_div(self.columns).unwrap_or(0)
    }

    fn pixels(&self) -> usize {
        self.painted.as_ref().map_or(self.values.len(), |painted| painted.pixels.len())
    }

    /// Height over width.
    fn ratio(&self) -> f64 {
        self.rows() as f64 / self.columns as f64
    }

    fn ruler(&self) -> Ruler {
        Ruler::fit(self.colour.scale, self.colour.range, self.values.iter().copied(), 0.0)
    }

    /// Width that the bar takes at the right.
    fn room(&self, height: f64) -> f64 {
        if self.painted.as_ref().is_some_and(|painted| painted.ramp.is_none()) {
            return 0.0;
        }
        Vertical::new(&self.colour, self.ruler(), height).room() + BAR + APART - frame::EDGE
    }

    /// As wide as a slot allows with what stands beside it.
    fn width(&self, slot: f64, has_bar: bool) -> f64 {
        // The room beside the bar depends on its height only through the number of its ticks.
        let guess = (0.75 * slot * self.ratio()).min(HIGHEST);
        let room = if has_bar { self.room(guess) } else { 0.0 };
        (slot - room).min(HIGHEST / self.ratio())
    }

    fn check(&self) -> Result<()> {
        if !self.boundary.is_empty() && self.boundary.len() != self.values.len() {
            let what = format!("values between which `{}` has a line", self.title);
            return Err(Error::Length { what, found: self.boundary.len(), expected: self.values.len() });
        }
        let expected = self.rows() * self.columns;
        if expected > 0 && expected == self.pixels() {
            return Ok(());
        }
        let what = format!("pixels of the picture `{}` in rows of {}", self.title, self.columns);
        Err(Error::Length { what, found: self.pixels(), expected: expected.max(1) })
    }
}

impl Pictures {
    /// Images under a common title.
    pub fn new(title: impl Into<String>, pictures: Vec<Picture>) -> Self {
        Self {
            title: title.into(),
            subtitle: String::new(),
            pictures,
            no_value: "no value".to_owned(),
            boundary_meaning: String::new(),
            keys: Vec::new(),
        }
    }

    /// Sets the small print under the title.
    #[must_use]
    pub fn subtitle(mut self, subtitle: impl Into<String>) -> Self {
        self.subtitle = subtitle.into();
        self
    }

    /// Says what the lines between signs mean.
    #[must_use]
    pub fn boundary_meaning(mut self, meaning: impl Into<String>) -> Self {
        self.boundary_meaning = meaning.into();
        self
    }

    /// Says what colours of painted images mean.
    #[must_use]
    pub fn keys(mut self, keys: Vec<(Rgb, String)>) -> Self {
        self.keys = keys;
        self
    }

    /// Says what a pixel without value means.
    #[must_use]
    pub fn no_value(mut self, meaning: impl Into<String>) -> Self {
        self.no_value = meaning.into();
        self
    }
}

/// Whether all images are of one stated scale.
fn is_shared(pictures: &[Picture]) -> bool {
    let stated = |picture: &Picture| picture.painted.is_none() && picture.colour.range.is_some();
    let same = pictures.windows(2).all(|pair| pair[0].colour == pair[1].colour);
    pictures.len() > 1 && same && pictures.iter().all(stated)
}

/// Places of images of one width.
struct Layout {
    across: usize,
    slot: f64,
    width: f64,
    /// Images of one scale share the bar at the right of the first row.
    shared: bool,
}

impl Layout {
    fn new(pictures: &[Picture]) -> Self {
        let (across, shared) = (pictures.len().clamp(1, 2), is_shared(pictures));
        let bar = pictures.first().filter(|_| shared).map_or(0.0, |first| first.room(0.5 * HIGHEST) + GAP);
        let whole = frame::WIDTH - 2.0 * frame::EDGE - bar;
        let slot = (whole - GAP * (across - 1) as f64) / across as f64;
        // They are compared with their neighbours pixel by pixel.
        let width = pictures.iter().map(|picture| picture.width(slot, !shared)).fold(slot, f64::min);
        Self { across, slot, width, shared }
    }
}

pub(super) fn scene(figure: &Pictures) -> Result<Scene> {
    figure.pictures.iter().try_for_each(Picture::check)?;
    let layout = Layout::new(&figure.pictures);
    let Layout { across, slot, width, shared } = layout;
    let mut scene = Scene::new(&figure.title, frame::WIDTH);
    let mut top = frame::heading(&mut scene, &figure.title, &figure.subtitle) + 4.0;
    let mut missing = false;
    let no_value = match figure.pictures.iter().any(|picture| colour::is_signed(&picture.ruler())) {
        true => NO_SIGNED_VALUE,
        false => NO_VALUE,
    };
    // Where the next one would be.
    let mut free = None;
    for (row, pair) in figure.pictures.chunks(across).enumerate() {
        let titles: Vec<Vec<String>> =
            pair.iter().map(|picture| text::wrap_at_most(&picture.title, TITLE, slot, 4)).collect();
        let lines = titles.iter().map(Vec::len).max().unwrap_or(0) as f64;
        let bars = pair.iter().map(|picture| Vertical::new(&picture.colour, picture.ruler(), width));
        let factor = if bars.into_iter().any(|bar| bar.has_multiplier()) { 10.0 } else { 0.0 };
        let upper = top + lines * TITLE * LEADING + 6.0 + factor;
        let mut lowest = upper;
        for (i, (picture, title)) in pair.iter().zip(&titles).enumerate() {
            let left = frame::EDGE + i as f64 * (slot + GAP);
            for (line, words) in title.iter().enumerate() {
                let y = top + (line as f64 + 0.85) * TITLE * LEADING;
                scene.text((left, y), words, TITLE, INK, Anchor::Start);
            }
            let bar = match (shared, row, i) {
                (false, ..) => Some(left + width + APART),
                (true, 0, 0) => Some(frame::EDGE + across as f64 * (slot + GAP) - GAP + APART),
                _ => None,
            };
            let (bottom, holes) = draw(&mut scene, picture, (left, upper), width, bar, no_value);
            lowest = lowest.max(bottom);
            missing |= holes;
        }
        let last = frame::EDGE + (across - 1) as f64 * (slot + GAP);
        free = (pair.len() < across).then_some(((last, upper), lowest));
        top = lowest + 12.0;
    }
    let entries = entries(figure, missing.then_some(no_value));
    if !entries.is_empty() {
        let within = |left: f64| Legend::new(entries.clone(), frame::WIDTH - frame::EDGE - left, 0.0);
        top = match free {
            Some(((left, upper), lowest)) => {
                let end = within(left).draw_below(&mut scene, left, left + slot, upper);
                end.max(lowest) + 12.0
            }
            None => within(frame::EDGE).draw_below(&mut scene, frame::EDGE, frame::WIDTH - frame::EDGE, top),
        };
    }
    scene.height = (top + 6.0).ceil();
    Ok(scene)
}

/// What the legend says of colours, lines and pixels without value.
fn entries(figure: &Pictures, no_value: Option<Colour>) -> Vec<Entry> {
    let of_key = |(rgb, label): &(Rgb, String)| {
        let key = Key::Area { colour: Colour { rgb: *rgb, opacity: 1.0 } };
        Entry { key, label: label.clone() }
    };
    let mut entries: Vec<Entry> = figure.keys.iter().map(of_key).collect();
    if figure.pictures.iter().any(|picture| !picture.boundary.is_empty()) {
        entries.push(Entry { key: Key::Cased, label: figure.boundary_meaning.clone() });
    }
    let missing = no_value.map(|colour| Entry { key: Key::Area { colour }, label: figure.no_value.clone() });
    entries.extend(missing);
    entries
}

/// Draws a picture of this width, its bar at `bar`; says where it ends and whether pixels have no value.
fn draw(
    scene: &mut Scene,
    picture: &Picture,
    (left, top): Point,
    width: f64,
    bar: Option<f64>,
    no_value: Colour,
) -> (f64, bool) {
    let ruler = picture.ruler();
    let area = Rect { left, right: left + width, top, bottom: top + width * picture.ratio() };
    if let Some(painted) = &picture.painted {
        draw_painted(scene, picture, painted, &area);
        draw_labels(scene, picture, &area);
        return (area.bottom, false);
    }
    let fractions: Vec<Option<f64>> = picture.values.par_iter().map(|value| ruler.fraction(*value)).collect();
    let holes = fractions.contains(&None);
    let shaded = |part: &Option<f64>| part.map_or(no_value, |part| shade(&ruler, part)).rgb;
    let pixels = fractions.par_iter().map(shaded).collect();
    scene.marks.push(Mark::Image { area, columns: picture.columns, pixels });
    draw_boundary(scene, picture, &area);
    for row in &picture.lines {
        let y = area.top + (*row as f64 + 0.5) / picture.rows() as f64 * area.height();
        let dashes = (area.width() / 12.0) as u32;
        for i in 0..dashes {
            let from = area.left + f64::from(i) * 12.0;
            for (thickness, colour) in [(2.6, INK), (1.4, WHITE)] {
                scene.line((from + 2.0, y), (from + 8.0, y), thickness, colour);
            }
        }
    }
    scene.outline(area, 0.9, INK);
    if let Some(left) = bar {
        let axis = Vertical::new(&picture.colour, ruler, area.height());
        let beside = Rect { left, right: left + BAR, ..area };
        draw_bar(scene, fractions.into_iter().flatten(), &axis, &beside, &colour::map(&ruler));
    }
    draw_labels(scene, picture, &area);
    (area.bottom, holes)
}

/// Words beside what they name.
fn draw_labels(scene: &mut Scene, picture: &Picture, area: &Rect) {
    let mut placer = Placer::new(*area);
    let (rows, columns) = (picture.rows() as f64, picture.columns as f64);
    let place = |(row, column, words): &'_ (usize, usize, String)| {
        let at = area.at((*column as f64 + 0.5) / columns, 1.0 - (*row as f64 + 0.5) / rows);
        (at, words.clone())
    };
    let labels: Vec<(Point, String)> = picture.labels.iter().map(place).collect();
    for (at, _) in &labels {
        scene.marks.push(Mark::Disc { centre: *at, radius: 2.6, colour: WHITE });
        scene.marks.push(Mark::Disc { centre: *at, radius: 1.7, colour: INK });
    }
    placer.away(scene, &labels);
}

/// Draws a painted picture, with a bar if it has one.
fn draw_painted(scene: &mut Scene, picture: &Picture, painted: &Painted, area: &Rect) {
    let (area, ruler) = (*area, picture.ruler());
    scene.marks.push(Mark::Image { area, columns: picture.columns, pixels: painted.pixels.clone() });
    scene.outline(area, 0.9, INK);
    if let Some([from, to]) = painted.ramp {
        let mixed = |part: f64| {
            let mix =
                |from: u8, to: u8| (f64::from(from) + part * (f64::from(to) - f64::from(from))).round() as u8;
            Colour { rgb: (mix(from.0, to.0), mix(from.1, to.1), mix(from.2, to.2)), opacity: 1.0 }
        };
        let bar = Vertical::new(&picture.colour, ruler, area.height());
        let beside = Rect { left: area.right + APART, right: area.right + APART + BAR, ..area };
        draw_bar(scene, std::iter::empty(), &bar, &beside, &mixed);
    }
}

/// Lines where the values of the boundary change their sign, but for those around specks.
fn draw_boundary(scene: &mut Scene, picture: &Picture, area: &Rect) {
    if picture.boundary.is_empty() {
        return;
    }
    let x: Vec<f64> = (0..picture.columns)
        .map(|i| area.left + (i as f64 + 0.5) / picture.columns as f64 * area.width())
        .collect();
    let y: Vec<f64> = (0..picture.rows())
        .map(|i| area.top + (i as f64 + 0.5) / picture.rows() as f64 * area.height())
        .collect();
    let length = |line: &[Point]| -> f64 {
        line.windows(2).map(|ends| (ends[1].0 - ends[0].0).hypot(ends[1].1 - ends[0].1)).sum()
    };
    let lines = contour::lines(&x, &y, &picture.boundary, 0.0);
    for line in lines.into_iter().filter(|line| length(line) >= SHORTEST) {
        for (width, colour) in CASED {
            scene.marks.push(Mark::Stroke { points: line.clone(), width, colour });
        }
    }
}
