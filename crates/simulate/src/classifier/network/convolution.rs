//! One convolution with ReLU, forwards and backwards; [`super::layers`] has the equations.

use super::real::{Lanes, Real, mask, total};
use pulp::Simd;
use std::ops::Range;

/// Channels that are worked on together; the number of channels is a multiple of it.
pub(super) const BLOCK: usize = 8;

/// Size of one convolution.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Convolution {
    pub(super) inputs: usize,
    pub(super) channels: usize,
    pub(super) taps: usize,
    pub(super) stride: usize,
    pub(super) positions_in: usize,
    pub(super) positions: usize,
    /// Where its weights lie among all.
    pub(super) kernel: Range<usize>,
    pub(super) biases: Range<usize>,
}

impl Convolution {
    /// The input position of the first tap that lies within the input, and the taps that do.
    #[inline(always)]
    fn window(&self, position: usize) -> (usize, Range<usize>) {
        let (centre, before) = (position * self.stride, self.taps / 2);
        let first = centre.saturating_sub(before);
        let end = (centre + before + 1).min(self.positions_in);
        (first, first + before - centre..end + before - centre)
    }

    /// Output positions at which a tap lies within the input.
    #[inline(always)]
    fn reached_by(&self, tap: usize) -> Range<usize> {
        let before = self.taps / 2;
        let start = before.saturating_sub(tap).div_ceil(self.stride);
        let end = (self.positions_in + before).saturating_sub(tap).div_ceil(self.stride).min(self.positions);
        // Short inputs have taps that never lie within.
        start.min(end)..end
    }

    #[inline(always)]
    pub(super) fn forward<S: Simd, T: Real, const L: usize>(
        &self,
        simd: S,
        w: &[T],
        x: &[Lanes<T, L>],
        out: &mut [Lanes<T, L>],
    ) {
        let (kernel, biases) = (&w[self.kernel.clone()], w[self.biases.clone()].as_chunks::<BLOCK>().0);
        for (p, out) in out.chunks_exact_mut(self.channels).enumerate() {
            let (first, taps) = self.window(p);
            let x = &x[first * self.inputs..(first + taps.len()) * self.inputs];
            let kernel = kernel[taps.start * self.inputs * self.channels..].as_chunks::<BLOCK>().0;
            for (block, (out, biases)) in out.as_chunks_mut::<BLOCK>().0.iter_mut().zip(biases).enumerate() {
                let mut sum = biases.map(|bias| [bias; L]);
                for (x, w) in x.iter().zip(kernel[block..].iter().step_by(self.channels / BLOCK)) {
                    for (sum, w) in sum.iter_mut().zip(w) {
                        T::scaled(simd, *w, x, sum);
                    }
                }
                *out = sum.map(|lanes| lanes.map(|z| if z > T::ZERO { z } else { T::ZERO }));
            }
        }
    }

    /// Gradient of the weights from that of the sums before ReLU, `g`.
    #[inline(always)]
    pub(super) fn gradient<S: Simd, T: Real, const L: usize>(
        &self,
        simd: S,
        x: &[Lanes<T, L>],
        g: &[Lanes<T, L>],
        out: &mut [T],
    ) {
        let blocks = self.channels / BLOCK;
        let g = g.as_chunks::<BLOCK>().0;
        let (before, kernel) = (self.taps / 2, out[self.kernel.clone()].as_chunks_mut::<BLOCK>().0);
        for (row, kernel) in kernel.chunks_exact_mut(blocks).enumerate() {
            let (tap, channel) = (row / self.inputs, row % self.inputs);
            let positions = self.reached_by(tap);
            let first = (positions.start * self.stride + tap).saturating_sub(before) * self.inputs + channel;
            let x = x.get(first..).unwrap_or_default().iter().step_by(self.stride * self.inputs);
            for (block, out) in kernel.iter_mut().enumerate() {
                let mut sum = [[T::ZERO; L]; BLOCK];
                let g = g.get(positions.start * blocks + block..).unwrap_or_default().iter().step_by(blocks);
                for (x, g) in x.clone().zip(g).take(positions.len()) {
                    for (sum, g) in sum.iter_mut().zip(g) {
                        T::product(simd, x, g, sum);
                    }
                }
                *out = sum.map(total);
            }
        }
        for (block, out) in out[self.biases.clone()].as_chunks_mut::<BLOCK>().0.iter_mut().enumerate() {
            let mut sum = [[T::ZERO; L]; BLOCK];
            for g in g[block..].iter().step_by(blocks) {
                for (sum, g) in sum.iter_mut().zip(g) {
                    *sum = std::array::from_fn(|i| sum[i] + g[i]);
                }
            }
            *out = sum.map(total);
        }
    }

    /// Gradient of the sums that made the input `x` by ReLU.
    #[inline(always)]
    pub(super) fn backward<S: Simd, T: Real, const L: usize>(
        &self,
        simd: S,
        w: &[T],
        g: &[Lanes<T, L>],
        x: &[Lanes<T, L>],
        out: &mut [Lanes<T, L>],
    ) {
        let (kernel, blocks) = (&w[self.kernel.clone()], self.channels / BLOCK);
        out.fill([T::ZERO; L]);
        for (p, g) in g.chunks_exact(self.channels).enumerate() {
            let (first, taps) = self.window(p);
            let out = &mut out[first * self.inputs..(first + taps.len()) * self.inputs];
            let kernel = kernel[taps.start * self.inputs * self.channels..].as_chunks::<BLOCK>().0;
            // Only the first layer has one input, and nothing asks for its gradient.
            for (out, w) in out.as_chunks_mut::<BLOCK>().0.iter_mut().zip(kernel.chunks_exact(self.channels))
            {
                let mut sum = *out;
                for (block, g) in g.as_chunks::<BLOCK>().0.iter().enumerate() {
                    let rows: [[T; BLOCK]; BLOCK] = std::array::from_fn(|row| w[row * blocks + block]);
                    for (o, g) in g.iter().enumerate() {
                        for (sum, row) in sum.iter_mut().zip(&rows) {
                            T::scaled(simd, row[o], g, sum);
                        }
                    }
                }
                *out = sum;
            }
        }
        mask(x, out);
    }
}
