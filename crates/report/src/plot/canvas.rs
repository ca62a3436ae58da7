//! Pixels to paint on.

use super::colour::Colour;

/// Red, green and blue.
type Rgb = (u8, u8, u8);

/// Steps of how much of a pixel is covered. No eye sees more at the rim of a line or a letter, and a palette holds their colours.
const LEVELS: f64 = 15.0;

/// An image that is being painted.
pub(super) struct Canvas {
    pub(super) width: usize,
    pub(super) height: usize,
    /// Row after row.
    pub(super) pixels: Vec<Rgb>,
}

impl Canvas {
    /// A white one.
    pub(super) fn new(width: usize, height: usize) -> Self {
        Self { width, height, pixels: vec![(0xFF, 0xFF, 0xFF); width * height] }
    }

    /// Paints a pixel, `part` of which is covered; nothing beyond the image.
    pub(super) fn dot(&mut self, (x, y): (i32, i32), colour: Colour, part: f64) {
        let (Ok(x), Ok(y)) = (usize::try_from(x), usize::try_from(y)) else { return };
        if x >= self.width {
            return;
        }
        let weight = ((part * LEVELS).round() / LEVELS * colour.opacity * 256.0).round() as i32;
        let Some(below) = self.pixels.get_mut(y * self.width + x) else { return };
        let mix = |below: u8, above: u8| {
            let (below, above) = (i32::from(below), i32::from(above));
            (below + ((above - below) * weight + 128) / 256).clamp(0, 255) as u8
        };
        let rgb = colour.rgb;
        *below = (mix(below.0, rgb.0), mix(below.1, rgb.1), mix(below.2, rgb.2));
    }

    /// Paints all pixels from one corner to before the other.
    pub(super) fn fill(&mut self, from: (i32, i32), to: (i32, i32), colour: Colour) {
        for y in from.1.max(0)..to.1.min(self.height as i32) {
            (from.0.max(0)..to.0.min(self.width as i32)).for_each(|x| self.dot((x, y), colour, 1.0));
        }
    }
}
