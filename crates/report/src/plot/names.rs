//! Names along one side of a figure.
//!
//! The letters follow from the distance of the names. Where even the smallest letters would touch, only
//! every second (third, …) name is printed.

use super::frame::TICK;
use super::text;

/// Longest name; longer ones are cut with an ellipsis.
const LONGEST: f64 = 190.0;
/// Smallest letters, and those of a name as a share of the distance of names.
const SMALLEST: f64 = 4.6;
pub(super) const SHARE: f64 = 0.84;

/// Names along one side, cut to what fits.
pub(super) struct Names {
    lines: Vec<String>,
    pub(super) size: f64,
    /// Every how many names one is printed.
    stride: usize,
    /// Room across the side.
    pub(super) room: f64,
    pub(super) turned: bool,
}

impl Names {
    /// Names at distances of `pitch`; beside their cells, or across them where there is `width` for each.
    pub(super) fn new(names: &[String], pitch: f64, width: Option<f64>) -> Self {
        let size = (SHARE * pitch).min(TICK);
        let stride = (SMALLEST / size).ceil().max(1.0) as usize;
        let size = (size * stride as f64).min(TICK);
        let cut = |name: &String| text::wrap_at_most(name, size, LONGEST, 1).into_iter().next();
        let lines: Vec<String> = names.iter().map(|name| cut(name).unwrap_or_default()).collect();
        let longest = lines.iter().map(|line| text::width(line, size)).fold(0.0, f64::max);
        match width {
            Some(width) if longest + 8.0 <= width => {
                Self { lines, size: TICK.min(size), stride, room: size * text::LEADING, turned: false }
            }
            _ => Self { lines, size, stride, room: longest, turned: true },
        }
    }

    pub(super) fn printed(&self) -> impl Iterator<Item = (usize, &String)> {
        self.lines.iter().enumerate().step_by(self.stride)
    }
}
