//! The one font, how wide text is in it, and how text breaks into lines.
//!
//! DejaVu Sans is compiled in (crate `dejavu`), so that measures and pictures do not depend on the
//! machine. An SVG names it first and then Verdana, whose letters are as wide.

use std::sync::OnceLock;

use ab_glyph::{Font, FontRef, Glyph, PxScale, ScaleFont, point};

use super::ticks::{power, superscript};
use hadar::words::visible;
use hadar::{Error, Result};

/// Names for documents that leave the font to the viewer.
pub(super) const FAMILY: &str = "DejaVu Sans, Verdana, sans-serif";
/// Ascent plus descent of DejaVu Sans in em, which is how the rasteriser states a size.
const HEIGHT_PER_EM: f64 = 2384.0 / 2048.0;
/// Distance of lines in em.
pub(super) const LEADING: f64 = 1.3;

fn font() -> Option<&'static FontRef<'static>> {
    static FONT: OnceLock<Option<FontRef<'static>>> = OnceLock::new();
    FONT.get_or_init(|| FontRef::try_from_slice(dejavu::sans::regular()).ok()).as_ref()
}

/// Letters of a line that starts at the origin, at `size` pixels per em, and where the line ends.
fn set(font: &FontRef<'static>, text: &str, size: f64) -> (Vec<Glyph>, f32) {
    let scale = PxScale::from((size * HEIGHT_PER_EM) as f32);
    let scaled = font.as_scaled(scale);
    let (mut x, mut before) = (0.0, None);
    let mut glyphs = Vec::with_capacity(text.len());
    for letter in text.chars() {
        let id = scaled.glyph_id(letter);
        x += before.map_or(0.0, |before| scaled.kern(before, id));
        glyphs.push(id.with_scale_and_position(scale, point(x, 0.0)));
        x += scaled.h_advance(id);
        before = Some(id);
    }
    (glyphs, x)
}

/// Width of a line of text at `size` pixels per em, in pixels.
pub(super) fn width(text: &str, size: f64) -> f64 {
    font().map_or(0.0, |font| f64::from(set(font, text, size).1))
}

/// Calls `paint` for each pixel that a line of text covers, with its place relative to the start of the
/// baseline and the part of it that is covered.
pub(super) fn rasterise(text: &str, size: f64, mut paint: impl FnMut((i32, i32), f64)) -> Result<()> {
    let font = font().ok_or_else(|| {
        Error::malformed("the embedded font cannot be read", "build hadar again from clean sources")
    })?;
    for outline in set(font, text, size).0.into_iter().filter_map(|glyph| font.outline_glyph(glyph)) {
        let corner = outline.px_bounds().min;
        outline.draw(|x, y, part| {
            let pixel = (corner.x as i32 + x as i32, corner.y as i32 + y as i32);
            if part > 0.0 {
                paint(pixel, f64::from(part.min(1.0)));
            }
        });
    }
    Ok(())
}

/// Text without characters that no picture can show, in one line.
pub(super) fn clean(text: &str) -> String {
    let printable = |c: char| if c.is_control() || matches!(c, '\u{FFFE}' | '\u{FFFF}') { ' ' } else { c };
    let line: String = text.trim().chars().map(printable).collect();
    typeset(&visible(&line))
}

/// Powers, numbers and units that were written with the letters of a terminal, as they are printed: cm^-1, 2e7, 20 us, 37 degC.
fn typeset(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut before = "";
    for token in text.split_inclusive([' ', ',', ';', '(', ')']) {
        let word = token.trim_end_matches([' ', ',', ';', '(', ')', '.', ':']);
        let is_number = |word: &str| word.parse::<f64>().is_ok();
        match word {
            "degC" => out.push_str("°C"),
            "us" if is_number(before) => out.push_str("µs"),
            "um" if is_number(before) => out.push_str("µm"),
            word => out.push_str(&scientific(word).unwrap_or_else(|| raised(word))),
        }
        out.push_str(token.get(word.len()..).unwrap_or_default());
        before = word;
    }
    out
}

/// `2e7` as 2×10⁷; none where it is something else.
fn scientific(word: &str) -> Option<String> {
    let (mantissa, exponent) = word.split_once('e')?;
    let is_plain = |digits: &str| digits.bytes().all(|b| b.is_ascii_digit() || b == b'.');
    let sign = exponent.strip_prefix('-').map_or("", |_| "-");
    let digits = exponent.trim_start_matches(['-', '+']);
    let whole = !mantissa.is_empty() && is_plain(mantissa) && mantissa.parse::<f64>().is_ok();
    if !whole || digits.is_empty() || digits.len() > 3 || !digits.bytes().all(|b| b.is_ascii_digit()) {
        return None;
    }
    let exponent: i32 = format!("{sign}{digits}").parse().ok()?;
    Some(if mantissa == "1" { power(exponent) } else { format!("{mantissa}×{}", power(exponent)) })
}

/// What follows a circumflex, if it is a whole number, raised.
fn raised(word: &str) -> String {
    let mut parts = word.split('^');
    let mut out = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let sign = part.strip_prefix('-').map_or(0, |_| 1);
        let digits = part.bytes().skip(sign).take_while(u8::is_ascii_digit).count();
        match part.split_at_checked(sign + digits) {
            Some((number, rest)) if digits > 0 => {
                out.push_str(&superscript(number));
                out.push_str(rest);
            }
            _ => {
                out.push('^');
                out.push_str(part);
            }
        }
    }
    out
}

/// Where a long word may be broken: after these.
const JOINTS: [char; 5] = ['-', '_', '/', '@', '.'];

/// Breaks text at spaces, words that are too long at their joints and else anywhere, into lines of at most `limit` pixels.
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
                    // A joint in the first half would leave most of the line empty.
                    let joint = line.rfind(JOINTS).filter(|at| 2 * at >= line.len());
                    let rest = joint.map_or_else(String::new, |at| line.split_off(at + 1));
                    lines.push(std::mem::replace(&mut line, rest));
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

/// One line, cut in the middle with an ellipsis where it is too long: long names differ at their ends.
pub(super) fn cut(text: &str, size: f64, limit: f64) -> String {
    let letters: Vec<char> = clean(text).chars().collect();
    let shown = |kept: usize| {
        let first = kept / 3;
        let part = |range: &[char]| range.iter().collect::<String>();
        format!("{}…{}", part(&letters[..first]), part(&letters[letters.len() - (kept - first)..]))
    };
    let whole: String = letters.iter().collect();
    if width(&whole, size) <= limit {
        return whole;
    }
    (0..letters.len()).rev().map(shown).find(|line| width(line, size) <= limit).unwrap_or_default()
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
        // Advance of `m` in DejaVu Sans: 1995 of 2048 units per em.
        assert!((width("mmmm", 10.0) - 40.0 * 1995.0 / 2048.0).abs() < 1e-4);
    }

    #[test]
    fn letters_of_a_terminal_are_typeset() {
        for (typed, printed) in [
            ("S (photons s^-1 m^-2)", "S (photons s⁻¹ m⁻²)"),
            ("1e7 photons, 5.4e6 of them, 1e-4 per K", "10⁷ photons, 5.4×10⁶ of them, 10⁻⁴ per K"),
            ("200 us. 20 us at 37 degC: 12 um, for us.", "200 µs. 20 µs at 37 °C: 12 µm, for us."),
            ("10^x ^ 2^ e7 1e basalt@1e7 1.e7.2", "10^x ^ 2^ e7 1e basalt@1e7 1.e7.2"),
        ] {
            assert_eq!(clean(typed), printed);
            assert_eq!(clean(printed), printed);
        }
    }

    #[test]
    fn lines_stay_within_the_limit_and_lose_no_letter() {
        let text = "an ordinary sentence and averyveryverylongwordthatfitsnowhere";
        let lines = wrap(text, 10.0, 90.0);
        assert!(lines.iter().all(|line| width(line, 10.0) <= 90.0));
        assert_eq!(lines.concat().replace(' ', ""), text.replace(' ', ""));
        assert!(wrap(" \n\u{0}", 10.0, 90.0).is_empty());
        let name = "basalt@rock-igneous-mafic-solid-basalt-h1-jhu-nicolet";
        let lines = wrap(name, 10.0, 120.0);
        assert!(lines.iter().rev().skip(1).all(|line| line.ends_with(['-', '@'])), "{lines:?}");
        assert_eq!(lines.concat(), name);
        let short = cut(name, 10.0, 120.0);
        assert!(
            width(&short, 10.0) <= 120.0 && short.starts_with("bas") && short.ends_with("jhu-nicolet"),
            "{short}"
        );
        assert_eq!(cut("skin", 10.0, 120.0), "skin");
    }
}
