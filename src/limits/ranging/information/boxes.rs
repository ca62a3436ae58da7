//! Sums over windows whose cost does not grow with the window and whose error does not grow with the image.
//!
//! Rows are cut into blocks as high as the window. A window of h rows reaches over two blocks at most: its sum is
//! the sum of the last rows of the one (from below, kept for every row) and of the first rows of the other (from
//! above, kept as it grows). Nothing is ever subtracted, so the error is at most h roundings of sums of magnitudes;
//! the blocks begin at multiples of h, so that the sum of a window does not depend on where the work began. Columns
//! are summed in the same way.
//!
//! Source: van Herk, Pattern Recognit. Lett. 13, 517 (1992), doi:10.1016/0167-8655(92)90069-C; Gil and Werman, IEEE
//! TPAMI 15, 504 (1993), doi:10.1109/34.211471 (there for maxima).

use super::request::Window;
use crate::aligned::{Aligned, spaced};
use crate::simd::{Chunk, LANES, dispatched};

/// Makes room for `len` values, if there is not.
pub(super) fn grow(room: &mut Aligned, len: usize) {
    if room.len() < len {
        room.set_len(len);
    }
}

/// Sums over the last `height` rows of rows that come one after the other.
#[derive(Debug, Default)]
pub(super) struct Stack {
    height: usize,
    len: usize,
    spacing: usize,
    /// Rows of the block in work, and from there on the sums up to the end of the block before.
    rows: Aligned,
    /// Sum of the rows of the block in work.
    top: Aligned,
    first: usize,
}

impl Stack {
    /// Starts again at row `first`, with rows of `len` values (a multiple of [`LANES`]).
    pub(super) fn start(&mut self, height: usize, len: usize, first: usize) {
        self.spacing = spaced(len);
        grow(&mut self.rows, height * self.spacing);
        grow(&mut self.top, len);
        (self.height, self.len, self.first) = (height, len, first);
    }

    /// Where row `y` is to be written.
    pub(super) fn row(&mut self, y: usize) -> &mut [f64] {
        let start = y % self.height * self.spacing;
        &mut self.rows[start..start + self.len]
    }

    /// Takes row `y`, once it is written, into the sums.
    pub(super) fn push(&mut self, y: usize) {
        let start = y % self.height * self.spacing;
        let row = &self.rows[start..start + self.len];
        if y.is_multiple_of(self.height) || y == self.first {
            self.top[..self.len].copy_from_slice(row);
        } else {
            add_to(row, &mut self.top);
        }
    }

    /// Sum of the rows that end with `y`, the one last pushed.
    pub(super) fn sum(&self, y: usize, sum: &mut [f64]) {
        let after = (y + 1) % self.height;
        if after == 0 {
            sum.copy_from_slice(&self.top[..self.len]);
        } else {
            let start = after * self.spacing;
            add(&self.rows[start..start + self.len], &self.top, sum);
        }
    }

    /// Makes the sums from below where `y` is the last row of its block; to be called when all else is done with it.
    pub(super) fn finish(&mut self, y: usize) {
        if !(y + 1).is_multiple_of(self.height) {
            return;
        }
        let begun = if self.first + self.height > y { self.first % self.height } else { 0 };
        for above in (begun.max(1)..self.height - 1).rev() {
            let (rows, below) = self.rows.split_at_mut((above + 1) * self.spacing);
            let start = above * self.spacing;
            add_to(&below[..self.len], &mut rows[start..start + self.len]);
        }
    }
}

dispatched! {
    /// `to` += `from`.
    pub(super) fn add_to<'a>(from: &'a [f64], to: &'a mut [f64]) -> () {
        for (to, from) in to.as_chunks_mut::<LANES>().0.iter_mut().zip(from.as_chunks::<LANES>().0) {
            let (a, b) = (*to, *from);
            *to = std::array::from_fn(|i| a[i] + b[i]);
        }
    }
}

dispatched! {
    /// `sum` = `a` + `b`.
    fn add<'a>(a: &'a [f64], b: &'a [f64], sum: &'a mut [f64]) -> () {
        let parts = a.as_chunks::<LANES>().0.iter().zip(b.as_chunks::<LANES>().0);
        for (sum, (a, b)) in sum.as_chunks_mut::<LANES>().0.iter_mut().zip(parts) {
            let (a, b): (Chunk, Chunk) = (*a, *b);
            *sum = std::array::from_fn(|i| a[i] + b[i]);
        }
    }
}

/// Columns of a strip of an image.
#[derive(Debug, Clone, Copy)]
pub(super) struct Along {
    /// Values per column, a multiple of [`LANES`].
    pub(super) stride: usize,
    /// Columns of a window.
    pub(super) width: usize,
    /// Column of the image that the strip begins with.
    pub(super) first: usize,
}

dispatched! {
    /// Sums over windows along a row: `sums[i]` is over the columns i to i + width of `row`.
    ///
    /// `ends` is room for as many values as `row` has, `begin` for a column.
    pub(super) fn along<'a>(
        row: &'a [f64], place: Along, ends: &'a mut [f64], begin: &'a mut [f64], sums: &'a mut [f64]
    ) -> () {
        let Along { stride, width, first } = place;
        ends_of_blocks(row, place, ends);
        let mut inside = first % width;
        for (x, at) in row.chunks_exact(stride).enumerate() {
            if inside == 0 || x == 0 {
                begin.copy_from_slice(at);
            } else {
                plus(at, begin);
            }
            let complete = inside + 1 == width;
            inside = if complete { 0 } else { inside + 1 };
            let Some(left) = (x + 1).checked_sub(width) else { continue };
            let sum = &mut sums[left * stride..(left + 1) * stride];
            if complete {
                sum.copy_from_slice(begin);
            } else {
                let end = &ends[left * stride..(left + 1) * stride];
                for (sum, (end, begin)) in chunks_mut(sum).zip(chunks(end).zip(chunks(begin))) {
                    *sum = std::array::from_fn(|i| end[i] + begin[i]);
                }
            }
        }
    }
}

/// `ends[x]`: sum of the columns from x to the end of its block, for every block that ends in the strip.
#[inline(always)]
fn ends_of_blocks(row: &[f64], place: Along, ends: &mut [f64]) {
    let Along { stride, width, first } = place;
    let columns = row.len() / stride;
    let whole = (first + columns) / width * width;
    let Some(last) = whole.checked_sub(first).filter(|last| *last > 0) else { return };
    let mut after = 0;
    for x in (0..last).rev() {
        let at = &row[x * stride..(x + 1) * stride];
        let (to, next) = ends[x * stride..].split_at_mut(stride);
        if after == 0 {
            to.copy_from_slice(at);
        } else {
            for (to, (at, next)) in chunks_mut(to).zip(chunks(at).zip(chunks(next))) {
                *to = std::array::from_fn(|i| at[i] + next[i]);
            }
        }
        after = if after + 1 == width { 0 } else { after + 1 };
    }
}

/// An image of one value per pixel, or the part of it that windows lie in.
#[derive(Debug, Clone, Copy)]
pub(super) struct Image<'a> {
    pub(super) values: &'a [f64],
    /// Values from row to row.
    pub(super) pitch: usize,
    /// Columns of a row that count, the first ones.
    pub(super) columns: usize,
}

dispatched! {
    /// Sums over small windows, row by row and then column by column: `sums` \[row\]\[column\] as many rows of windows as
    /// there is room for.
    pub(super) fn window_sums<'a>(of: Image<'a>, window: Window, sums: &'a mut [f64]) -> () {
        let Image { values, pitch, columns } = of;
        let centres = (columns + 1).saturating_sub(window.columns()).max(1);
        let mut sum = vec![0.0; columns];
        for (top, sums) in sums.chunks_exact_mut(centres).enumerate() {
            sum.copy_from_slice(&values[top * pitch..][..columns]);
            for row in top + 1..top + window.rows() {
                for (sum, x) in sum.iter_mut().zip(&values[row * pitch..][..columns]) {
                    *sum += x;
                }
            }
            sums.copy_from_slice(&sum[..centres]);
            for shift in 1..window.columns() {
                for (to, x) in sums.iter_mut().zip(&sum[shift..]) {
                    *to += x;
                }
            }
        }
    }
}

#[inline(always)]
fn plus(from: &[f64], to: &mut [f64]) {
    for (to, from) in chunks_mut(to).zip(chunks(from)) {
        let (a, b) = (*to, *from);
        *to = std::array::from_fn(|i| a[i] + b[i]);
    }
}

#[inline(always)]
pub(super) fn chunks(values: &[f64]) -> std::slice::Iter<'_, Chunk> {
    values.as_chunks::<LANES>().0.iter()
}

#[inline(always)]
pub(super) fn chunks_mut(values: &mut [f64]) -> std::slice::IterMut<'_, Chunk> {
    values.as_chunks_mut::<LANES>().0.iter_mut()
}
