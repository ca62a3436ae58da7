//! Names along one side of a figure.
//!
//! The letters follow from the distance of the names. A long name takes several lines where there is room for them, and
//! all names have smaller letters where there is not; only where even the smallest do not fit is it cut in the middle. Where they
//! would touch, only every second (third, …) name is printed.

use super::frame::TICK;
use super::text;

/// Widest line of a name, of rows of points and of a matrix.
pub(super) const WIDE: f64 = 270.0;
pub(super) const NARROW: f64 = 190.0;
/// Most lines of a name.
const MOST: usize = 5;
/// Smallest letters, and those of a name as a share of the distance of names.
const SMALLEST: f64 = 4.6;
pub(super) const SHARE: f64 = 0.84;

/// Names along one side, in lines.
pub(super) struct Names {
    lines: Vec<Vec<String>>,
    pub(super) size: f64,
    /// Every how many names one is printed.
    stride: usize,
    /// Room across the side.
    pub(super) room: f64,
    pub(super) turned: bool,
}

/// Lines that the longest of the names takes at the largest size.
pub(super) fn most_lines(names: &[String]) -> usize {
    names.iter().map(|name| text::wrap(name, TICK, WIDE).len()).max().unwrap_or(1).clamp(1, MOST)
}

impl Names {
    /// Names at distances of `pitch` in lines of at most `longest`; beside their cells, or across them where there is
    /// `width` for each.
    pub(super) fn new(names: &[String], pitch: f64, longest: f64, width: Option<f64>) -> Self {
        let size = (SHARE * pitch).min(TICK);
        let stride = (SMALLEST / size).ceil().max(1.0) as usize;
        let size = (size * stride as f64).min(TICK);
        // The room of a name is that of those that are left out, too.
        let pitch = pitch * stride as f64;
        let most = |size: f64| ((pitch / (size * text::LEADING)).floor().max(1.0) as usize).min(MOST);
        let fits = |name: &String, size: f64| text::wrap(name, size, longest).len() <= most(size);
        let smaller = std::iter::successors(Some(size), |size| Some(0.93 * size));
        let size = smaller
            .take_while(|size| *size >= SMALLEST)
            .find(|size| names.iter().all(|name| fits(name, *size)))
            .unwrap_or(size.min(SMALLEST.max(0.6 * size)));
        let broken = |name: &String| match text::wrap(name, size, longest) {
            lines if lines.len() <= most(size) => lines,
            _ => vec![text::cut(&name.replace('\n', " "), size, longest)],
        };
        let lines: Vec<Vec<String>> = names.iter().map(broken).collect();
        let longest = lines.iter().flatten().map(|line| text::width(line, size)).fold(0.0, f64::max);
        match width {
            Some(width) if longest + 8.0 <= width => {
                let most = lines.iter().map(Vec::len).max().unwrap_or(1) as f64;
                Self { lines, size, stride, room: most * size * text::LEADING, turned: false }
            }
            _ => Self { lines, size, stride, room: longest, turned: true },
        }
    }

    /// Every printed line: the name it belongs to, how far its baseline is from that of a lone line, and its letters.
    pub(super) fn printed(&self) -> impl Iterator<Item = (usize, f64, &str)> {
        let leading = self.size * text::LEADING;
        self.lines.iter().enumerate().step_by(self.stride).flat_map(move |(name, lines)| {
            let middle = 0.5 * (lines.len() as f64 - 1.0);
            lines
                .iter()
                .enumerate()
                .map(move |(i, line)| (name, (i as f64 - middle) * leading, line.as_str()))
        })
    }

    /// How far below its own lines the lowest of a name are, from a lone one.
    pub(super) fn drop(&self) -> f64 {
        if self.turned { 0.0 } else { 0.5 * (self.room - self.size * text::LEADING) }
    }
}
