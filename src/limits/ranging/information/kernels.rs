//! The loops over samples: widening them to `f64`, and the sums over bands.
//!
//! A column takes a whole number of vectors ([`stride`]): the lanes beyond its last band hold counts of 0 and a
//! variance of 1 and so add nothing. The quotients of a column are added as one fraction, a/b + c/d = (ad +
//! cb)/(bd), up to [`TOGETHER`] of them in every lane, which leaves one division for as many vectors. All of them
//! are positive, so a rounding is relative to the sum (at most some 3 per term), and none overflows: see
//! [`super::limits`].

use super::boxes::{chunks, chunks_mut};
use super::limits::MOST;
use crate::cube::Sample;
use crate::simd::{Chunk, LANES, dispatched, fold_all};

/// Quotients added as one fraction.
const TOGETHER: usize = 7;

/// Doubles that a column of `bands` samples takes.
pub(super) fn stride(bands: usize) -> usize {
    bands.next_multiple_of(LANES)
}

/// What was seen of samples on the way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Seen {
    /// All are 0 or above, and none above [`MOST`].
    pub(super) sound: bool,
    /// The least of them, if they are sound.
    pub(super) least: f64,
}

/// Samples that can be widened to rows of `f64` with whole vectors per column.
pub(super) trait Stored: Sample {
    /// Writes the samples `[column][band]` to [column][`stride`].
    fn widen(samples: &[Self], bands: usize, to: &mut [f64]) -> Seen;
}

macro_rules! stored {
    ($sample:ty, $bits:ty, $name:ident) => {
        dispatched! {
            fn $name<'a>(samples: &'a [$sample], bands: usize, to: &'a mut [f64]) -> ($bits, $bits) {
                // The bits of numbers that are not negative are in the order of the numbers; negative ones and NaN come after.
                let (mut least, mut most) = ([<$bits>::MAX; LANES], [0; LANES]);
                let mut see = |chunk: [$sample; LANES]| {
                    let bits = chunk.map(<$sample>::to_bits);
                    let (low, high) = (least, most);
                    least = std::array::from_fn(|i| low[i].min(bits[i]));
                    most = std::array::from_fn(|i| high[i].max(bits[i]));
                };
                let tail = bands % LANES;
                // The others are of the next column, which is looked at here too.
                let keep: [bool; LANES] = std::array::from_fn(|i| i < tail);
                let columns = to.chunks_exact_mut(stride(bands));
                for (column, to) in columns.enumerate() {
                    let from = &samples[column * bands..];
                    let (whole, _) = from[..bands].as_chunks::<LANES>();
                    let mut to = chunks_mut(to);
                    for (from, to) in whole.iter().zip(to.by_ref()) {
                        see(*from);
                        *to = from.map(f64::from);
                    }
                    if let Some(to) = to.next() {
                        let start = bands - tail;
                        if let Some(from) = from[start..].first_chunk::<LANES>() {
                            see(*from);
                            *to = std::array::from_fn(|i| if keep[i] { f64::from(from[i]) } else { 0.0 });
                        } else {
                            let from = &from[start..bands];
                            see(std::array::from_fn(|i| from[i.min(tail - 1)]));
                            *to = std::array::from_fn(|i| if i < tail { f64::from(from[i]) } else { 0.0 });
                        }
                    }
                }
                (least.into_iter().min().unwrap_or(0), most.into_iter().max().unwrap_or(0))
            }
        }

        impl Stored for $sample {
            fn widen(samples: &[Self], bands: usize, to: &mut [f64]) -> Seen {
                let (least, most) = $name(samples, bands, to);
                let sound = most <= (MOST as $sample).to_bits();
                Seen { sound, least: f64::from(<$sample>::from_bits(least)) }
            }
        }
    };
}

stored!(f32, u32, widen_f32);
stored!(f64, u64, widen_f64);

/// Σ of quotients per lane, up to [`TOGETHER`] of them as one fraction.
pub(super) struct Quotients {
    total: Chunk,
    numerator: Chunk,
    denominator: Chunk,
    held: usize,
}

impl Quotients {
    #[inline(always)]
    pub(super) const fn new() -> Self {
        Self { total: [0.0; LANES], numerator: [0.0; LANES], denominator: [1.0; LANES], held: 0 }
    }

    /// Adds n/d.
    #[inline(always)]
    pub(super) fn add(&mut self, n: Chunk, d: Chunk) {
        if self.held == TOGETHER {
            self.total = self.sum();
            self.held = 0;
        }
        if self.held == 0 {
            (self.numerator, self.denominator) = (n, d);
        } else {
            let (a, b) = (self.numerator, self.denominator);
            self.numerator = std::array::from_fn(|i| a[i].mul_add(d[i], n[i] * b[i]));
            self.denominator = std::array::from_fn(|i| b[i] * d[i]);
        }
        self.held += 1;
    }

    #[inline(always)]
    pub(super) fn sum(&self) -> Chunk {
        std::array::from_fn(|i| self.total[i] + self.numerator[i] / self.denominator[i])
    }
}

#[inline(always)]
pub(super) fn square(x: Chunk) -> Chunk {
    x.map(|x| x * x)
}

#[inline(always)]
pub(super) fn minus(a: Chunk, b: Chunk) -> Chunk {
    std::array::from_fn(|i| a[i] - b[i])
}

#[inline(always)]
pub(super) fn plus(a: Chunk, b: Chunk) -> Chunk {
    std::array::from_fn(|i| a[i] + b[i])
}

dispatched! {
    /// Σ over the bands of each column.
    pub(super) fn totals<'a>(row: &'a [f64], stride: usize, lanes: &'a mut [Chunk], sums: &'a mut [f64]) -> () {
        for (lanes, column) in lanes.iter_mut().zip(row.chunks_exact(stride)) {
            let mut total = [0.0; LANES];
            for x in chunks(column) {
                total = plus(total, *x);
            }
            *lanes = total;
        }
        fold_all(&lanes[..sums.len()], 1.0, sums);
    }
}

/// What the quotients of a row are made of, all [column][`stride`].
#[derive(Debug, Clone, Copy)]
pub(super) struct Below<'a> {
    /// What stands below, without `var`.
    pub(super) below: &'a [f64],
    /// Added to it in every column.
    pub(super) var: &'a [f64],
    /// The derivative, of the same columns as `below`.
    pub(super) derivative: &'a [f64],
    pub(super) stride: usize,
}

dispatched! {
    /// Σ over the bands of (derivative)²/(below + var), of every column.
    pub(super) fn ratios<'a>(of: Below<'a>, lanes: &'a mut [Chunk], sums: &'a mut [f64]) -> () {
        let columns = of.below.chunks_exact(of.stride).zip(of.derivative.chunks_exact(of.stride));
        for (lanes, (below, derivative)) in lanes.iter_mut().zip(columns) {
            let mut ratio = Quotients::new();
            for ((below, var), d) in chunks(below).zip(chunks(of.var)).zip(chunks(derivative)) {
                ratio.add(square(*d), plus(*below, *var));
            }
            *lanes = ratio.sum();
        }
        fold_all(&lanes[..sums.len()], 1.0, sums);
    }
}

dispatched! {
    /// The same with the central difference: `row` holds the counts of the columns of `below` and one more on
    /// either side.
    pub(super) fn ratios_central<'a>(
        row: &'a [f64], of: Below<'a>, lanes: &'a mut [Chunk], sums: &'a mut [f64]
    ) -> () {
        let after = row[2 * of.stride..].chunks_exact(of.stride);
        let columns = of.below.chunks_exact(of.stride).zip(row.chunks_exact(of.stride).zip(after));
        for (lanes, (below, (before, after))) in lanes.iter_mut().zip(columns) {
            let mut ratio = Quotients::new();
            let terms = chunks(below).zip(chunks(of.var)).zip(chunks(before).zip(chunks(after)));
            for ((below, var), (before, after)) in terms {
                ratio.add(square(minus(*after, *before)), plus(*below, *var));
            }
            *lanes = ratio.sum();
        }
        fold_all(&lanes[..sums.len()], 0.25, sums);
    }
}

dispatched! {
    /// The same for windows of `width` columns, over which a central difference leaves only its ends: `row` holds the
    /// columns of the windows and one more on either side, `below` the sums over each window.
    pub(super) fn ratios_ends<'a>(
        row: &'a [f64], width: usize, of: Below<'a>, lanes: &'a mut [Chunk], sums: &'a mut [f64]
    ) -> () {
        let stride = of.stride;
        let columns = |first: usize| row[first * stride..].chunks_exact(stride);
        let ends = columns(0).zip(columns(1)).zip(columns(width).zip(columns(width + 1)));
        for (lanes, (below, (left, right))) in lanes.iter_mut().zip(of.below.chunks_exact(stride).zip(ends)) {
            let left = chunks(left.0).zip(chunks(left.1));
            let right = chunks(right.0).zip(chunks(right.1));
            let mut ratio = Quotients::new();
            for ((below, var), (left, right)) in chunks(below).zip(chunks(of.var)).zip(left.zip(right)) {
                let inner = minus(*right.0, *left.1);
                let outer = minus(*right.1, *left.0);
                ratio.add(square(plus(inner, outer)), plus(*below, *var));
            }
            *lanes = ratio.sum();
        }
        fold_all(&lanes[..sums.len()], 0.25, sums);
    }
}
