//! Paints a scene as SVG.
//!
//! Coordinates are whole tenths of a logical pixel, made so by the view box. Neighbours in the order of painting that look alike are one
//! path, whose points are written relative to the ones before and left out where they lie on the line anyway.

use super::colour::{Colour, WHITE};
use super::encode;
use super::readings;
use super::scene::{Anchor, Mark, Point, Rect, Scene};
use super::text;
use base64::prelude::{BASE64_STANDARD, Engine as _};
use hadar::Result;
use rayon::prelude::*;
use std::fmt::Write as _;

const SCALE: f64 = 10.0;

/// The document.
pub(super) fn paint(scene: &Scene) -> Result<String> {
    let size = ((scene.width * SCALE).ceil() as u32, (scene.height * SCALE).ceil() as u32);
    let rasters = scene.marks.par_iter().filter_map(|mark| match mark {
        Mark::Image { area, columns, pixels } => {
            Some(encode::file(pixels, *columns).map(|png| image(area, &png)))
        }
        _ => None,
    });
    let mut rasters = rasters.collect::<Result<Vec<String>>>()?.into_iter();
    let mut inner = Paths::default();
    let area = Rect { left: 0.0, top: 0.0, right: scene.width, bottom: scene.height };
    inner.draw(&Mark::Rect { area, colour: WHITE });
    for mark in &scene.marks {
        match mark {
            Mark::Image { .. } => inner.element(&rasters.next().unwrap_or_default()),
            Mark::Text { at, text, size, colour, anchor, turned } => {
                inner.element(&line_of_text(*at, text, *size, *colour, *anchor, *turned));
            }
            mark => inner.draw(mark),
        }
    }
    Ok(format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\" viewBox=\"0 0 {} {}\" \
         role=\"img\" fill=\"none\" stroke-linejoin=\"round\" stroke-linecap=\"round\" font-family=\"{}\">\n\
         <title>{}</title>\n{}{}</svg>\n",
        scene.width.ceil(),
        scene.height.ceil(),
        size.0,
        size.1,
        text::FAMILY,
        escape(&scene.title),
        readings::element(&scene.readable),
        inner.end(),
    ))
}

/// How a path is painted.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Look {
    Filled(Colour),
    /// A line of this width, in tenths.
    Drawn(u32, Colour),
}

impl Look {
    fn colour(self) -> Colour {
        match self {
            Self::Filled(colour) | Self::Drawn(_, colour) => colour,
        }
    }
}

/// Elements of a document, the last of which may still grow.
#[derive(Debug, Default)]
struct Paths {
    done: String,
    /// The path that is being written: its look and its steps.
    look: Option<Look>,
    steps: String,
    /// Where the last part of it ends.
    at: (i64, i64),
}

impl Paths {
    fn draw(&mut self, mark: &Mark) {
        match mark {
            Mark::Rect { area, colour } => {
                let (left, top) = whole((area.left, area.top));
                let (right, bottom) = whole((area.right, area.bottom));
                let corners = [(left, top), (right, top), (right, bottom), (left, bottom)];
                self.part(Look::Filled(*colour), &corners);
            }
            Mark::Stroke { points, width, colour } => {
                let points: Vec<_> = points.iter().copied().map(whole).collect();
                self.part(Look::Drawn(tenths(*width), *colour), &points);
            }
            Mark::Area { x, upper, lower, colour } => {
                let there = x.iter().zip(upper).map(|(x, y)| whole((*x, *y)));
                let back = x.iter().zip(lower).rev().map(|(x, y)| whole((*x, *y)));
                self.part(Look::Filled(*colour), &there.chain(back).collect::<Vec<_>>());
            }
            // A line of no length has round ends.
            Mark::Disc { centre, radius, colour } => {
                self.part(Look::Drawn(2 * tenths(*radius), *colour), &[whole(*centre)]);
            }
            Mark::Image { .. } | Mark::Text { .. } => {}
        }
    }

    /// Adds a part to the path of the same look, or begins a new path. What shines through is painted on its own, since parts of one
    /// path do not shade each other.
    fn part(&mut self, look: Look, points: &[(i64, i64)]) {
        let points = straightened(points);
        let Some(&first) = points.first() else { return };
        if self.look != Some(look) || look.colour().opacity < 1.0 {
            self.finish();
            self.look = Some(look);
            self.at = (0, 0);
        }
        self.step('m', first);
        match (look, points.as_slice()) {
            (Look::Drawn(..), [_]) => self.steps.push_str("h0"),
            (_, [_, rest @ ..]) => {
                for (i, point) in rest.iter().enumerate() {
                    let (dx, dy) = (point.0 - self.at.0, point.1 - self.at.1);
                    match (dx, dy) {
                        (0, dy) => _ = write!(self.steps, "v{dy}"),
                        (dx, 0) => _ = write!(self.steps, "h{dx}"),
                        // After a move, and after a line, more numbers are more lines.
                        _ if self.is_among_lines(i) => self.pair(*point),
                        _ => self.step('l', *point),
                    }
                    self.at = *point;
                }
            }
            _ => {}
        }
        if let Look::Filled(_) = look {
            self.steps.push('z');
            self.at = first;
        }
    }

    /// Whether the numbers after the last command are read as those of a line.
    fn is_among_lines(&self, before: usize) -> bool {
        before == 0
            || self.steps.ends_with(|last: char| last.is_ascii_digit()) && {
                let command = self.steps.rfind(|c: char| c.is_ascii_alphabetic());
                command.and_then(|at| self.steps.as_bytes().get(at)).is_some_and(|c| matches!(c, b'l' | b'm'))
            }
    }

    fn step(&mut self, command: char, to: (i64, i64)) {
        self.steps.push(command);
        self.pair(to);
    }

    /// A position relative to the last one. A sign parts numbers as well as a space does.
    fn pair(&mut self, to: (i64, i64)) {
        for number in [to.0 - self.at.0, to.1 - self.at.1] {
            if number >= 0 && self.steps.ends_with(|last: char| last.is_ascii_digit()) {
                self.steps.push(' ');
            }
            let _ = write!(self.steps, "{number}");
        }
        self.at = to;
    }

    /// Adds what is no path.
    fn element(&mut self, element: &str) {
        self.finish();
        self.done.push_str(element);
    }

    fn finish(&mut self) {
        let Some(look) = self.look.take() else { return };
        let steps = std::mem::take(&mut self.steps);
        let (attribute, width) = match look {
            Look::Filled(_) => ("fill", String::new()),
            Look::Drawn(width, _) => ("stroke", format!(" stroke-width=\"{width}\"")),
        };
        let (colour, opacity) = (hex(look.colour()), opacity(look.colour()));
        let _ = writeln!(self.done, "<path {attribute}=\"{colour}\"{width}{opacity} d=\"{steps}\"/>");
    }

    fn end(mut self) -> String {
        self.finish();
        self.done
    }
}

/// The points without those that change nothing: repeated ones, and those on the way from one neighbour to the other.
fn straightened(points: &[(i64, i64)]) -> Vec<(i64, i64)> {
    let mut kept: Vec<(i64, i64)> = Vec::with_capacity(points.len());
    for &point in points {
        while let [.., before, last] = *kept.as_slice() {
            let (a, b) = ((last.0 - before.0, last.1 - before.1), (point.0 - last.0, point.1 - last.1));
            if a.0 * b.1 != a.1 * b.0 || a.0 * b.0 + a.1 * b.1 < 0 {
                break;
            }
            kept.pop();
        }
        if kept.last() != Some(&point) {
            kept.push(point);
        }
    }
    kept
}

/// A raster as an element that carries its PNG.
fn image(area: &Rect, png: &[u8]) -> String {
    let (x, y) = whole((area.left, area.top));
    let (right, bottom) = whole((area.right, area.bottom));
    format!(
        "<image x=\"{x}\" y=\"{y}\" width=\"{}\" height=\"{}\" preserveAspectRatio=\"none\" \
         style=\"image-rendering:pixelated\" href=\"data:image/png;base64,{}\"/>\n",
        right - x,
        bottom - y,
        BASE64_STANDARD.encode(png)
    )
}

/// A line of text as an element.
fn line_of_text(at: Point, text: &str, size: f64, colour: Colour, anchor: Anchor, turned: bool) -> String {
    let (x, y) = whole(at);
    let turn = if turned { format!(" transform=\"rotate(-90 {x} {y})\"") } else { String::new() };
    let anchor = match anchor {
        Anchor::Start => "",
        Anchor::Middle => " text-anchor=\"middle\"",
        Anchor::End => " text-anchor=\"end\"",
    };
    let (fill, size, opacity) = (hex(colour), tenths(size), opacity(colour));
    format!(
        "<text x=\"{x}\" y=\"{y}\"{turn}{anchor} font-size=\"{size}\" fill=\"{fill}\"{opacity}>{}</text>\n",
        escape(text)
    )
}

/// In tenths of a logical pixel.
fn whole((x, y): Point) -> (i64, i64) {
    ((x * SCALE).round() as i64, (y * SCALE).round() as i64)
}

fn tenths(length: f64) -> u32 {
    (length * SCALE).round() as u32
}

fn hex(Colour { rgb: (r, g, b), .. }: Colour) -> String {
    format!("#{r:02X}{g:02X}{b:02X}")
}

fn opacity(colour: Colour) -> String {
    if colour.opacity < 1.0 { format!(" opacity=\"{}\"", colour.opacity) } else { String::new() }
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_of_one_look_are_one_path_without_points_that_change_nothing() {
        let ink = Colour::hex(0x123456);
        let line = |points: &[Point], colour| Mark::Stroke { points: points.to_vec(), width: 1.6, colour };
        let mut paths = Paths::default();
        paths.draw(&line(&[(1.0, 1.0), (2.0, 2.0), (2.0, 2.01), (3.0, 3.0), (2.5, 3.0), (0.0, 0.5)], ink));
        paths.draw(&line(&[(1.0, 1.0), (1.04, 1.0)], ink));
        paths.draw(&Mark::Disc { centre: (2.0, 0.0), radius: 0.8, colour: ink });
        let shining = ink.opacity(0.5);
        paths.draw(&line(&[(0.0, 0.0), (1.0, 0.0)], shining));
        paths.draw(&line(&[(0.0, 0.0), (0.0, 1.0)], shining));
        let area = Rect { left: 0.0, top: 0.0, right: 1.0, bottom: 2.0 };
        paths.draw(&Mark::Rect { area, colour: ink });
        assert_eq!(
            paths.end(),
            "<path stroke=\"#123456\" stroke-width=\"16\" d=\"m10 10 20 20h-5l-25-25m10 5h0m10-10h0\"/>\n\
             <path stroke=\"#123456\" stroke-width=\"16\" opacity=\"0.5\" d=\"m0 0h10\"/>\n\
             <path stroke=\"#123456\" stroke-width=\"16\" opacity=\"0.5\" d=\"m0 0v10\"/>\n\
             <path fill=\"#123456\" d=\"m0 0h10v20h-10z\"/>\n"
        );
    }
}
