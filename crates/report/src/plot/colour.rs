//! Colours: a palette for curves and a map for quantities, both safe for the colour-blind.
//!
//! Curves: Okabe and Ito, *Color Universal Design* (2008), without its yellow, which is lost on white.
//! Quantities: viridis of S. van der Walt and N. Smith (matplotlib, released under CC0), perceptually
//! uniform and readable in grey; its published table at twenty equal steps, linear in sRGB between them.
//! Signed quantities: `RdBu` of C. Brewer (colorbrewer2.org), blue below zero, white at it, red above.
//!
//! What the colour-blind see of them is computed in the tests ([`vision`]).

#[cfg(test)]
mod vision;

use super::axis::{Ruler, Scale};

/// Red, green and blue.
type Rgb = (u8, u8, u8);

/// Red, green, blue, and opacity from 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Colour {
    pub(super) rgb: (u8, u8, u8),
    pub(super) opacity: f64,
}

impl Colour {
    pub(super) const fn hex(code: u32) -> Self {
        let [_, r, g, b] = code.to_be_bytes();
        Self { rgb: (r, g, b), opacity: 1.0 }
    }

    pub(super) const fn opacity(self, opacity: f64) -> Self {
        Self { opacity, ..self }
    }
}

pub(super) const WHITE: Colour = Colour::hex(0xFFFFFF);
pub(super) const INK: Colour = Colour::hex(0x1A1A1A);
pub(super) const GREY: Colour = Colour::hex(0x5F6368);
pub(super) const GRID: Colour = Colour::hex(0xE4E6E8);
pub(super) const FINE_GRID: Colour = Colour::hex(0xF2F3F4);
pub(super) const SHADE: Colour = Colour::hex(0xECEDEF);
pub(super) const NO_VALUE: Colour = Colour::hex(0xD6D6D6);
/// No value beside the white of a signed quantity.
pub(super) const NO_SIGNED_VALUE: Colour = Colour::hex(0x9A9A9A);

/// Blue, vermillion, bluish green, reddish purple, orange, sky blue, black.
const PALETTE: [Colour; 7] = [
    Colour::hex(0x0072B2),
    Colour::hex(0xD55E00),
    Colour::hex(0x009E73),
    Colour::hex(0xCC79A7),
    Colour::hex(0xE69F00),
    Colour::hex(0x56B4E9),
    Colour::hex(0x000000),
];

/// Colour of the series with this index, and how many times the palette has been used up before.
pub(super) fn series(index: usize) -> (Colour, usize) {
    let colour = PALETTE.get(index % PALETTE.len()).copied().unwrap_or(INK);
    (colour, index / PALETTE.len())
}

/// Colour of an area with this index: the palette, then paler and paler.
pub(super) fn area(index: usize) -> Rgb {
    let (colour, times) = series(index);
    let share = 0.55_f64.powi(i32::try_from(times).unwrap_or(i32::MAX));
    let paler = |part: u8| (255.0 - share * (255.0 - f64::from(part))).round() as u8;
    let (r, g, b) = colour.rgb;
    (paler(r), paler(g), paler(b))
}

const VIRIDIS: [u32; 20] = [
    0x440154, 0x481567, 0x482677, 0x453781, 0x404788, 0x39568C, 0x33638D, 0x2D708E, 0x287D8E, 0x238A8D,
    0x1F968B, 0x20A387, 0x29AF7F, 0x3CBB75, 0x55C667, 0x73D055, 0x95D840, 0xB8DE29, 0xDCE319, 0xFDE725,
];

const SIGNED: [u32; 11] = [
    0x053061, 0x2166AC, 0x4393C3, 0x92C5DE, 0xD1E5F0, 0xF7F7F7, 0xFDDBC7, 0xF4A582, 0xD6604D, 0xB2182B,
    0x67001F,
];

/// Colour of a quantity at `fraction` of its scale; the ends beyond it.
pub(super) fn quantity(fraction: f64) -> Colour {
    along(&VIRIDIS, fraction)
}

/// Colours of a scale: those of a signed quantity where its two ends differ by their sign alone.
pub(super) fn map(ruler: &Ruler) -> fn(f64) -> Colour {
    if is_signed(ruler) { |fraction| along(&SIGNED, fraction) } else { quantity }
}

/// Whether the two ends of a scale differ by their sign alone.
pub(super) fn is_signed(ruler: &Ruler) -> bool {
    ruler.scale == Scale::Linear && ruler.first == -ruler.last
}

fn along(table: &[u32], fraction: f64) -> Colour {
    let position = fraction.clamp(0.0, 1.0) * (table.len() - 1) as f64;
    let step = position as usize;
    let weight = position - step as f64;
    let at = |i: usize| table.get(i).or(table.last()).map_or(INK, |&code| Colour::hex(code)).rgb;
    let (a, b) = (at(step), at(step + 1));
    let mix = |a: u8, b: u8| (f64::from(a) + weight * (f64::from(b) - f64::from(a))).round() as u8;
    Colour { rgb: (mix(a.0, b.0), mix(a.1, b.1), mix(a.2, b.2)), opacity: 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// CIE lightness of an sRGB colour (IEC 61966-2-1, then L* = 116 Y^⅓ − 16).
    fn lightness(colour: Colour) -> f64 {
        let linear = |c: u8| {
            let c = f64::from(c) / 255.0;
            if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
        };
        let (r, g, b) = colour.rgb;
        let y = 0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b);
        116.0 * y.cbrt() - 16.0
    }

    #[test]
    fn lightness_rises_evenly_along_the_colour_map() {
        let l: Vec<f64> = (0..=50).map(|i| lightness(quantity(f64::from(i) / 50.0))).collect();
        let step = (l[50] - l[0]) / 50.0;
        // Viridis is uniform in CAM02-UCS, whose lightness differs a little from L*.
        assert!(l.windows(2).all(|pair| (pair[1] - pair[0]) > 0.6 * step && pair[1] - pair[0] < 1.5 * step));
        assert_eq!(quantity(f64::NEG_INFINITY), Colour::hex(0x440154));
        assert_eq!(quantity(7.0), Colour::hex(0xFDE725));
    }
}
