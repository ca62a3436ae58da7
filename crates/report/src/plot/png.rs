//! Paints a scene as PNG, at [`SCALE`] pixels per logical pixel.

use super::canvas::Canvas;
use super::colour::Colour;
use super::encode::{self, Rows};
use super::mask::Mask;
use super::scene::{Anchor, Mark, Point, Rect, Scene};
use super::text;
use hadar::Result;
use std::io::Write;

/// A page shows a picture about a thousand pixels wide.
pub(super) const SCALE: f64 = 1.5;

/// Takes the pixels of whole rows, red, green and blue.
pub type PutRows<'a> = dyn FnMut(&[(u8, u8, u8)]) -> Result<()> + 'a;

/// The file.
pub(super) fn paint(scene: &Scene) -> Result<Vec<u8>> {
    let (width, height) = ((scene.width * SCALE).ceil() as u32, (scene.height * SCALE).ceil() as u32);
    let mut canvas = Canvas::new(width as usize, height as usize);
    let mut mask = Mask::new(width, height);
    scene.marks.iter().try_for_each(|mark| draw(&mut canvas, &mut mask, mark))?;
    encode::file(&canvas.pixels, canvas.width)
}

/// An image whose pixels come row after row.
pub(super) fn by_rows(
    to: impl Write,
    size: [usize; 2],
    paint: &mut dyn FnMut(&mut PutRows<'_>) -> Result<()>,
) -> Result<()> {
    let mut rows = Rows::begin(to, size)?;
    paint(&mut |pixels| rows.put(pixels))?;
    rows.end()
}

fn draw(canvas: &mut Canvas, mask: &mut Mask, mark: &Mark) -> Result<()> {
    match mark {
        Mark::Rect { area, colour } => fill(canvas, area, *colour),
        Mark::Stroke { points, width, colour } => {
            if points.len() <= 5 && is_upright(points) {
                let sides = points.iter().zip(points.iter().skip(1));
                sides.for_each(|(&from, &to)| fill(canvas, &bar(from, to, *width), *colour));
                return Ok(());
            }
            mask.stroke(&points.iter().copied().map(at).collect::<Vec<_>>(), 0.5 * width * SCALE);
            blend(canvas, mask, *colour);
        }
        Mark::Area { x, upper, lower, colour } => {
            let scaled = |values: &[f64]| values.iter().map(|value| value * SCALE).collect::<Vec<_>>();
            mask.area(&scaled(x), &scaled(upper), &scaled(lower));
            blend(canvas, mask, *colour);
        }
        Mark::Disc { centre, radius, colour } => {
            mask.stroke(&[at(*centre)], radius * SCALE);
            blend(canvas, mask, *colour);
        }
        Mark::Image { area, columns, pixels } => image(canvas, area, *columns, pixels),
        Mark::Text { at: (x, y), text, size, colour, anchor, turned } => {
            let length = text::width(text, size * SCALE);
            let back = match anchor {
                Anchor::Start => 0.0,
                Anchor::Middle => 0.5 * length,
                Anchor::End => length,
            };
            let (x, y) = at((*x, *y));
            let (x, y) = if *turned { (x, y + back) } else { (x - back, y) };
            let (x, y) = (x.round() as i32, y.round() as i32);
            text::rasterise(text, size * SCALE, |(along, down), part| {
                let pixel = if *turned { (x + down, y - 1 - along) } else { (x + along, y + down) };
                canvas.dot(pixel, *colour, part);
            })?;
        }
    }
    Ok(())
}

fn at((x, y): Point) -> Point {
    (x * SCALE, y * SCALE)
}

fn is_upright(points: &[Point]) -> bool {
    points.iter().zip(points.iter().skip(1)).all(|(a, b)| a.0 == b.0 || a.1 == b.1)
}

/// An upright line as a rectangle of whole pixels, so that grids and frames are crisp.
fn bar(from: Point, to: Point, width: f64) -> Rect {
    let half = 0.5 * (width * SCALE).round().max(1.0) / SCALE;
    let snap = |value: f64| ((value - half) * SCALE).round() / SCALE + half;
    let (x0, x1) = (snap(from.0.min(to.0)), snap(from.0.max(to.0)));
    let (y0, y1) = (snap(from.1.min(to.1)), snap(from.1.max(to.1)));
    Rect { left: x0 - half, top: y0 - half, right: x1 + half, bottom: y1 + half }
}

fn fill(canvas: &mut Canvas, area: &Rect, colour: Colour) {
    hadar::stop::check();
    let whole = |x: f64, y: f64| ((x * SCALE).round() as i32, (y * SCALE).round() as i32);
    canvas.fill(whole(area.left, area.top), whole(area.right, area.bottom), colour);
}

/// Every pixel of the area takes the colour of the raster's pixel below its centre.
fn image(canvas: &mut Canvas, area: &Rect, columns: usize, pixels: &[(u8, u8, u8)]) {
    let rows = pixels.len().checked_div(columns).unwrap_or(0);
    let span = |from: f64, to: f64| ((from * SCALE).round() as i32, (to * SCALE).round() as i32);
    let ((left, right), (top, bottom)) = (span(area.left, area.right), span(area.top, area.bottom));
    let below = |at: i32, (from, to): (i32, i32), count: usize| {
        ((f64::from(at - from) + 0.5) / f64::from(to - from) * count as f64) as usize
    };
    for y in top..bottom {
        let row = below(y, (top, bottom), rows) * columns;
        for x in left..right {
            let Some(&rgb) = pixels.get(row + below(x, (left, right), columns)) else { continue };
            canvas.dot((x, y), Colour { rgb, opacity: 1.0 }, 1.0);
        }
    }
}

fn blend(canvas: &mut Canvas, mask: &mut Mask, colour: Colour) {
    hadar::stop::check();
    mask.drain(|pixel, part| canvas.dot(pixel, colour, part));
}
