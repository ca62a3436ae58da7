//! Paints a scene as PNG, at three pixels per logical pixel.

use plotters::backend::{BitMapBackend, DrawingBackend};
use plotters::style::Color;

use super::backend::{failure, rgba};
use super::colour::Colour;
use super::mask::Mask;
use super::scene::{Anchor, Mark, Point, Rect, Scene};
use super::text;
use hadar::Result;
use std::io::Write;

const SCALE: f64 = 3.0;

/// Takes the pixels of whole rows, red, green and blue.
pub type PutRows<'a> = dyn FnMut(&[(u8, u8, u8)]) -> Result<()> + 'a;

/// The file.
pub(super) fn paint(scene: &Scene) -> Result<Vec<u8>> {
    let (width, height) = ((scene.width * SCALE).ceil() as u32, (scene.height * SCALE).ceil() as u32);
    let mut pixels = vec![0xFF; 3 * width as usize * height as usize];
    let mut backend = BitMapBackend::with_buffer_and_format(&mut pixels, (width, height)).map_err(failure)?;
    let mut mask = Mask::new(width, height);
    scene.marks.iter().try_for_each(|mark| draw(&mut backend, &mut mask, mark))?;
    backend.present().map_err(failure)?;
    drop(backend);
    encode(&pixels, width, height).map_err(failure)
}

/// A raster of its own, a pixel each. Up to 256 colours make a palette.
pub(super) fn raster(pixels: &[(u8, u8, u8)], columns: usize) -> Result<Vec<u8>> {
    let rows = pixels.len().checked_div(columns).unwrap_or(0);
    let mut palette: Vec<(u8, u8, u8)> = pixels.to_vec();
    palette.sort_unstable();
    palette.dedup();
    let mut file = Vec::new();
    let mut encoder = encoder(&mut file, columns as u32, rows as u32);
    let data = if palette.len() <= 256 {
        encoder.set_color(::png::ColorType::Indexed);
        encoder.set_palette(flat(&palette));
        pixels.iter().map(|colour| palette.binary_search(colour).unwrap_or(0) as u8).collect()
    } else {
        flat(pixels)
    };
    let mut writer = encoder.write_header().map_err(failure)?;
    writer.write_image_data(&data).map_err(failure)?;
    writer.finish().map_err(failure)?;
    Ok(file)
}

/// An image whose pixels come row after row.
pub(super) fn by_rows(
    to: impl Write,
    [rows, columns]: [usize; 2],
    paint: &mut dyn FnMut(&mut PutRows<'_>) -> Result<()>,
) -> Result<()> {
    let side = |side: usize| u32::try_from(side).map_err(failure);
    let mut writer = encoder(to, side(columns)?, side(rows)?).write_header().map_err(failure)?;
    let mut stream = writer.stream_writer().map_err(failure)?;
    paint(&mut |pixels| stream.write_all(&flat(pixels)).map_err(failure))?;
    stream.finish().map_err(failure)?;
    writer.finish().map_err(failure)
}

fn encode(pixels: &[u8], width: u32, height: u32) -> std::result::Result<Vec<u8>, ::png::EncodingError> {
    let mut file = Vec::new();
    let mut writer = encoder(&mut file, width, height).write_header()?;
    writer.write_image_data(pixels)?;
    writer.finish()?;
    Ok(file)
}

/// Of 8 bits a channel and three of them.
fn encoder<'a, W: Write + 'a>(to: W, width: u32, height: u32) -> ::png::Encoder<'a, W> {
    let mut encoder = ::png::Encoder::new(to, width, height);
    encoder.set_color(::png::ColorType::Rgb);
    encoder.set_depth(::png::BitDepth::Eight);
    // The best is a hundredth smaller, and takes up to ten times as long.
    encoder.set_compression(::png::Compression::Default);
    // White ground and flat colours: whole rows repeat, which a filter would hide from the compressor.
    encoder.set_filter(::png::FilterType::NoFilter);
    encoder
}

fn flat(colours: &[(u8, u8, u8)]) -> Vec<u8> {
    colours.iter().flat_map(|&(r, g, b)| [r, g, b]).collect()
}

fn draw(backend: &mut BitMapBackend<'_>, mask: &mut Mask, mark: &Mark) -> Result<()> {
    match mark {
        Mark::Rect { area, colour } => fill(backend, area, *colour),
        Mark::Stroke { points, width, colour } => {
            if points.len() <= 5 && is_upright(points) {
                return points
                    .iter()
                    .zip(points.iter().skip(1))
                    .try_for_each(|(&from, &to)| fill(backend, &bar(from, to, *width), *colour));
            }
            mask.stroke(&points.iter().copied().map(at).collect::<Vec<_>>(), 0.5 * width * SCALE);
            blend(backend, mask, *colour)
        }
        Mark::Area { x, upper, lower, colour } => {
            let scaled = |values: &[f64]| values.iter().map(|value| value * SCALE).collect::<Vec<_>>();
            mask.area(&scaled(x), &scaled(upper), &scaled(lower));
            blend(backend, mask, *colour)
        }
        Mark::Disc { centre, radius, colour } => {
            mask.stroke(&[at(*centre)], radius * SCALE);
            blend(backend, mask, *colour)
        }
        Mark::Image { area, columns, pixels } => image(backend, area, *columns, pixels),
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
                dot(backend, pixel, *colour, part)
            })
        }
    }
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

fn fill(backend: &mut BitMapBackend<'_>, area: &Rect, colour: Colour) -> Result<()> {
    let whole = |x: f64, y: f64| ((x * SCALE).round() as i32, (y * SCALE).round() as i32);
    let (from, to) = (whole(area.left, area.top), whole(area.right, area.bottom));
    backend.draw_rect(from, to, &rgba(colour), true).map_err(failure)
}

/// Every pixel of the area takes the colour of the raster's pixel below its centre.
fn image(
    backend: &mut BitMapBackend<'_>,
    area: &Rect,
    columns: usize,
    pixels: &[(u8, u8, u8)],
) -> Result<()> {
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
            dot(backend, (x, y), Colour { rgb, opacity: 1.0 }, 1.0)?;
        }
    }
    Ok(())
}

fn blend(backend: &mut BitMapBackend<'_>, mask: &mut Mask, colour: Colour) -> Result<()> {
    mask.drain(|pixel, part| dot(backend, pixel, colour, part))
}

fn dot(backend: &mut BitMapBackend<'_>, pixel: (i32, i32), colour: Colour, part: f64) -> Result<()> {
    let colour = colour.opacity(part * colour.opacity);
    backend.draw_pixel(pixel, rgba(colour).to_backend_color()).map_err(failure)
}
