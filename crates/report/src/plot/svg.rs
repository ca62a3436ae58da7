//! Paints a scene as SVG.
//!
//! The backend of `plotters` knows whole numbers only: marks are drawn ten times as large and the
//! document is scaled down by its view box.

use plotters::backend::{DrawingBackend, SVGBackend};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, FontDesc, FontFamily, FontStyle, FontTransform, ShapeStyle, TextStyle};

use super::backend::{failure, rgba};
use super::colour::{Colour, WHITE};
use super::png;
use super::scene::{Anchor, Mark, Point, Rect, Scene};
use super::text;
use base64::prelude::{BASE64_STANDARD, Engine as _};
use hadar::Result;
use rayon::prelude::*;

const SCALE: f64 = 10.0;

/// The document.
pub(super) fn paint(scene: &Scene) -> Result<String> {
    let size = ((scene.width * SCALE).ceil() as u32, (scene.height * SCALE).ceil() as u32);
    let area = Rect { left: 0.0, top: 0.0, right: scene.width, bottom: scene.height };
    let mut inner = String::new();
    // The backend knows no rasters: marks between two of them are drawn on their own.
    let ground = [Mark::Rect { area, colour: WHITE }];
    let rasters = scene.marks.par_iter().filter_map(|mark| match mark {
        Mark::Image { area, columns, pixels } => {
            Some(png::raster(pixels, *columns).map(|png| image(area, &png)))
        }
        _ => None,
    });
    let mut rasters = rasters.collect::<Result<Vec<String>>>()?.into_iter();
    for (i, run) in scene.marks.split_inclusive(|mark| matches!(mark, Mark::Image { .. })).enumerate() {
        let ground = if i == 0 { ground.as_slice() } else { &[] };
        inner.push_str(&drawn(ground.iter().chain(run), size)?);
        if let Some(Mark::Image { .. }) = run.last() {
            inner.extend(rasters.next());
        }
    }
    Ok(format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\" viewBox=\"0 0 {} {}\" \
         role=\"img\" stroke-linejoin=\"round\" stroke-linecap=\"round\">\n<title>{}</title>\n{inner}</svg>\n",
        scene.width.ceil(),
        scene.height.ceil(),
        size.0,
        size.1,
        escape(&scene.title),
    ))
}

/// Marks as elements.
fn drawn<'a>(marks: impl Iterator<Item = &'a Mark>, size: (u32, u32)) -> Result<String> {
    let mut body = String::new();
    let mut backend = SVGBackend::with_string(&mut body, size);
    for mark in marks {
        draw(&mut backend, mark)?;
    }
    backend.present().map_err(failure)?;
    drop(backend);
    // The defaults of the format need not be written out for every mark.
    let body = body.replace(" opacity=\"1\"", "").replace(" stroke=\"none\"", "");
    let inner = body.split_once('\n').map_or("", |(_, inner)| inner);
    Ok(inner.trim_end().strip_suffix("</svg>").unwrap_or(inner).to_owned())
}

/// A raster as an element that carries its PNG.
fn image(area: &Rect, png: &[u8]) -> String {
    let (x, y) = at((area.left, area.top));
    let (right, bottom) = at((area.right, area.bottom));
    format!(
        "<image x=\"{x}\" y=\"{y}\" width=\"{}\" height=\"{}\" preserveAspectRatio=\"none\" \
         style=\"image-rendering:pixelated\" href=\"data:image/png;base64,{}\"/>\n",
        right - x,
        bottom - y,
        BASE64_STANDARD.encode(png)
    )
}

fn draw(backend: &mut SVGBackend<'_>, mark: &Mark) -> Result<()> {
    match mark {
        Mark::Rect { area, colour } => {
            let (from, to) = (at((area.left, area.top)), at((area.right, area.bottom)));
            backend.draw_rect(from, to, &shape(*colour, 0.0), true)
        }
        Mark::Stroke { points, width, colour } => {
            backend.draw_path(points.iter().copied().map(at), &shape(*colour, *width))
        }
        Mark::Area { x, upper, lower, colour } => {
            let there = x.iter().zip(upper).map(|(x, y)| at((*x, *y)));
            let back = x.iter().zip(lower).rev().map(|(x, y)| at((*x, *y)));
            backend.fill_polygon(there.chain(back), &shape(*colour, 0.0))
        }
        Mark::Disc { centre, radius, colour } => {
            let radius = (radius * SCALE).round() as u32;
            backend.draw_circle(at(*centre), radius, &shape(*colour, 0.0), true)
        }
        // Drawn between the runs of marks.
        Mark::Image { .. } => Ok(()),
        Mark::Text { at: (x, y), text, size, colour, anchor, turned } => {
            // The backend puts the baseline 0.76 em below the position and divides the size by 1.24.
            let drop = 0.76 * size;
            let (from, turn) = if *turned {
                (at((x - drop, *y)), FontTransform::Rotate270)
            } else {
                (at((*x, y - drop)), FontTransform::None)
            };
            let across = match anchor {
                Anchor::Start => HPos::Left,
                Anchor::Middle => HPos::Center,
                Anchor::End => HPos::Right,
            };
            let family = FontFamily::Name(text::FAMILY);
            let font = FontDesc::new(family, size * SCALE * 1.24, FontStyle::Normal).transform(turn);
            let pos = Pos::new(across, VPos::Top);
            backend.draw_text(text, &TextStyle { font, color: rgba(*colour).to_backend_color(), pos }, from)
        }
    }
    .map_err(failure)
}

fn at((x, y): Point) -> (i32, i32) {
    ((x * SCALE).round() as i32, (y * SCALE).round() as i32)
}

fn shape(colour: Colour, width: f64) -> ShapeStyle {
    ShapeStyle { color: rgba(colour), filled: true, stroke_width: (width * SCALE).round() as u32 }
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
