//! The one font, how wide text is in it, and how text breaks into lines.
//!
//! DejaVu Sans is compiled in (crate `dejavu`), so that measures and pictures do not depend on the
//! machine. An SVG names it first and then Verdana, whose letters are as wide.

use std::sync::OnceLock;

use plotters::style::{FontDesc, FontFamily, FontStyle, register_font};

use crate::{Error, Result};

pub(super) const FAMILY: &str = "DejaVu Sans, Verdana, sans-serif";
/// Ascent plus descent of DejaVu Sans in em: what the rasteriser of `plotters` takes as the size.
pub(super) const HEIGHT_PER_EM: f64 = 2384.0 / 2048.0;
/// Distance of lines in em.
pub(super) const LEADING: f64 = 1.3;

/// Makes the font known to `plotters`, once per process.
pub(super) fn register() -> Result<()> {
    static REGISTERED: OnceLock<bool> = OnceLock::new();
    let known =
        REGISTERED.get_or_init(|| register_font(FAMILY, FontStyle::Normal, dejavu::sans::regular()).is_ok());
    if *known {
        Ok(())
    } else {
        Err(Error::malformed("the embedded font cannot be read", "build hadar again from clean sources"))
    }
}

pub(super) fn font(size: f64) -> FontDesc<'static> {
    FontDesc::new(FontFamily::Name(FAMILY), size, FontStyle::Normal)
}

/// Width of a line of text at `size` pixels per em, in pixels.
pub(super) fn width(text: &str, size: f64) -> f64 {
    // The width comes in whole pixels: measure large, then scale down.
    const LARGE: f64 = 1000.0;
    let pixels = match font(LARGE * HEIGHT_PER_EM).layout_box(text) {
        Ok((_, (pixels, _))) => f64::from(pixels),
        Err(_) => 0.65 * LARGE * text.chars().count() as f64,
    };
    pixels * size / LARGE
}

/// Text without characters that no picture can show.
pub(super) fn clean(text: &str) -> String {
    let printable = |c: char| if c.is_control() || matches!(c, '\u{FFFE}' | '\u{FFFF}') { ' ' } else { c };
    text.trim().chars().map(printable).collect()
}

/// Breaks text at spaces, and words that are too long anywhere, into lines of at most `limit` pixels.
pub(super) fn wrap(text: &str, size: f64, limit: f64) -> Vec<String> {
    let mut lines = Vec::new();
    for paragraph in text.lines() {
        let mut line = String::new();
        for word in clean(paragraph).split_whitespace() {
            let longer = if line.is_empty() { word.to_owned() } else { format!("{line} {word}") };
            if width(&longer, size) <= limit {
                line = longer;
                continue;
            }
            if !line.is_empty() {
                lines.push(std::mem::take(&mut line));
            }
            for letter in word.chars() {
                if !line.is_empty() && width(&format!("{line}{letter}"), size) > limit {
                    lines.push(std::mem::take(&mut line));
                }
                line.push(letter);
            }
        }
        if !line.is_empty() {
            lines.push(line);
        }
    }
    lines
}

/// As [`wrap`], cut with an ellipsis after `most` lines.
pub(super) fn wrap_at_most(text: &str, size: f64, limit: f64, most: usize) -> Vec<String> {
    let mut lines = wrap(text, size, limit);
    if lines.len() > most {
        lines.truncate(most);
        if let Some(last) = lines.last_mut() {
            while !last.is_empty() && width(&format!("{last}…"), size) > limit {
                last.pop();
            }
            last.push('…');
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn widths_are_those_of_the_font() {
        register().unwrap();
        // Advance of `m` in DejaVu Sans: 1995 of 2048 units per em.
        assert!((width("mmmm", 10.0) - 40.0 * 1995.0 / 2048.0).abs() < 0.02);
    }

    #[test]
    fn lines_stay_within_the_limit_and_lose_no_letter() {
        register().unwrap();
        let text = "an ordinary sentence and averyveryverylongwordthatfitsnowhere";
        let lines = wrap(text, 10.0, 90.0);
        assert!(lines.iter().all(|line| width(line, 10.0) <= 90.0));
        assert_eq!(lines.concat().replace(' ', ""), text.replace(' ', ""));
        assert!(wrap(" \n\u{0}", 10.0, 90.0).is_empty());
    }
}
