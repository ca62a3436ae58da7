//! The network's arithmetic: three convolutions with ReLU and a fully connected layer, forwards and backwards.
//!
//! With x⁽⁰⁾ the standardised spectrum, positions p, channels c and o, taps k, stride s and K taps (an odd number):
//!
//! ```text
//! x⁽ˡ⁾[p][o] = max(0, b⁽ˡ⁾[o] + Σₖ Σ_c w⁽ˡ⁾[k][c][o] x⁽ˡ⁻¹⁾[sp + k − (K−1)/2][c])     l = 1, 2, 3; 0 beyond the ends
//! z[m]       = b[m] + Σ_f w[f][m] x⁽³⁾[f],      q[m] = exp z[m]/Σ exp z,      loss = −ln q[label]
//! ```
//!
//! `L` spectra are worked on side by side, one in every lane: no lane ever meets another until the gradients of all
//! lanes are added, so a spectrum's scores have the same bits whatever `L` is. Products are fused (`mul_add`) in an
//! order that is written out, and compiled per instruction set as in [`crate::simd`].

use std::ops::{Add, Div, Mul, Range, Sub};

/// Channels that are worked on together; the number of channels is a multiple of it.
pub(super) const BLOCK: usize = 8;
/// Layers with fewer positions than this are not thinned out by a stride.
const SHORT: usize = 16;

/// Single precision for the product, double to check gradients with.
pub(super) trait Real:
    Copy
    + PartialOrd
    + Send
    + Sync
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
{
    const ZERO: Self;
    fn of(value: f64) -> Self;
    fn to_f64(self) -> f64;
    fn fused(self, factor: Self, term: Self) -> Self;
    fn exp(self) -> Self;
    fn ln(self) -> Self;
    fn sqrt(self) -> Self;
}

macro_rules! real {
    ($t:ty) => {
        impl Real for $t {
            const ZERO: Self = 0.0;
            #[inline(always)]
            fn of(value: f64) -> Self {
                value as $t
            }
            #[inline(always)]
            fn to_f64(self) -> f64 {
                f64::from(self)
            }
            #[inline(always)]
            fn fused(self, factor: Self, term: Self) -> Self {
                self.mul_add(factor, term)
            }
            #[inline(always)]
            fn exp(self) -> Self {
                self.exp()
            }
            #[inline(always)]
            fn ln(self) -> Self {
                self.ln()
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                self.sqrt()
            }
        }
    };
}
real!(f32);
real!(f64);

/// One number of `L` spectra.
type Lanes<T, const L: usize> = [T; L];

#[inline(always)]
fn fused<T: Real, const L: usize>(weight: T, x: Lanes<T, L>, sum: Lanes<T, L>) -> Lanes<T, L> {
    std::array::from_fn(|i| weight.fused(x[i], sum[i]))
}

/// Σ over the lanes of a·b, pairwise.
#[inline(always)]
fn total<T: Real, const L: usize>(mut x: Lanes<T, L>) -> T {
    let mut width = L;
    while width > 1 {
        let half = width.div_ceil(2);
        for i in half..width {
            x[i - half] = x[i - half] + x[i];
        }
        width = half;
    }
    x.first().copied().unwrap_or(T::ZERO)
}

/// Size of one convolution.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Convolution {
    inputs: usize,
    channels: usize,
    taps: usize,
    stride: usize,
    positions_in: usize,
    positions: usize,
    /// Where its weights lie among all.
    kernel: Range<usize>,
    biases: Range<usize>,
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
        let end = (self.positions_in + before).saturating_sub(tap).div_ceil(self.stride);
        start..end.min(self.positions).max(start)
    }

    #[inline(always)]
    fn forward<T: Real, const L: usize>(&self, w: &[T], x: &[Lanes<T, L>], out: &mut [Lanes<T, L>]) {
        let (kernel, biases) = (&w[self.kernel.clone()], w[self.biases.clone()].as_chunks::<BLOCK>().0);
        for (p, out) in out.chunks_exact_mut(self.channels).enumerate() {
            let (first, taps) = self.window(p);
            let x = &x[first * self.inputs..(first + taps.len()) * self.inputs];
            let kernel = kernel[taps.start * self.inputs * self.channels..].as_chunks::<BLOCK>().0;
            for (block, (out, biases)) in out.as_chunks_mut::<BLOCK>().0.iter_mut().zip(biases).enumerate() {
                let mut sum = biases.map(|bias| [bias; L]);
                for (x, w) in x.iter().zip(kernel[block..].iter().step_by(self.channels / BLOCK)) {
                    for (sum, w) in sum.iter_mut().zip(w) {
                        *sum = fused(*w, *x, *sum);
                    }
                }
                *out = sum.map(|lanes| lanes.map(|z| if z > T::ZERO { z } else { T::ZERO }));
            }
        }
    }

    /// Gradient of the weights from that of the sums before ReLU, `g`.
    #[inline(always)]
    fn gradient<T: Real, const L: usize>(&self, x: &[Lanes<T, L>], g: &[Lanes<T, L>], out: &mut [T]) {
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
                let g = g[positions.start * blocks + block..].iter().step_by(blocks);
                for (x, g) in x.clone().zip(g).take(positions.len()) {
                    for (sum, g) in sum.iter_mut().zip(g) {
                        *sum = std::array::from_fn(|i| x[i].fused(g[i], sum[i]));
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
    fn backward<T: Real, const L: usize>(
        &self,
        w: &[T],
        g: &[Lanes<T, L>],
        x: &[Lanes<T, L>],
        out: &mut [Lanes<T, L>],
    ) {
        let kernel = &w[self.kernel.clone()];
        out.fill([T::ZERO; L]);
        for (p, g) in g.chunks_exact(self.channels).enumerate() {
            let (first, taps) = self.window(p);
            let out = &mut out[first * self.inputs..(first + taps.len()) * self.inputs];
            let kernel = kernel[taps.start * self.inputs * self.channels..].chunks_exact(self.channels);
            for (out, w) in out.iter_mut().zip(kernel) {
                let mut sum = *out;
                for (w, g) in w.iter().zip(g) {
                    sum = fused(*w, *g, sum);
                }
                *out = sum;
            }
        }
        mask(x, out);
    }
}

/// ReLU lets gradients through where its output is above 0.
#[inline(always)]
fn mask<T: Real, const L: usize>(x: &[Lanes<T, L>], g: &mut [Lanes<T, L>]) {
    for (g, x) in g.iter_mut().zip(x) {
        *g = std::array::from_fn(|i| if x[i] > T::ZERO { g[i] } else { T::ZERO });
    }
}

/// Sizes of all layers and where their weights lie in one long list.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Layers {
    pub(super) bands: usize,
    pub(super) classes: usize,
    pub(super) convolutions: [Convolution; 3],
    features: usize,
    dense: Range<usize>,
    biases: Range<usize>,
}

impl Layers {
    pub(super) fn new(bands: usize, classes: usize, channels: usize, taps: usize, stride: usize) -> Self {
        let (mut inputs, mut positions_in, mut end) = (1, bands, 0);
        let mut range = |len: usize| {
            end += len;
            end - len..end
        };
        let convolutions = std::array::from_fn(|_| {
            let stride = if positions_in < SHORT { 1 } else { stride };
            let positions = positions_in.div_ceil(stride);
            let (kernel, biases) = (range(taps * inputs * channels), range(channels));
            let layer =
                Convolution { inputs, channels, taps, stride, positions_in, positions, kernel, biases };
            (inputs, positions_in) = (channels, positions);
            layer
        });
        let features = positions_in * channels;
        let (dense, biases) = (range(features * classes), range(classes));
        Self { bands, classes, convolutions, features, dense, biases }
    }

    /// Number of weights, biases among them.
    pub(super) fn weights(&self) -> usize {
        self.biases.end
    }

    /// Weights of every layer, without biases, and how many of them meet in one sum.
    pub(super) fn kernels(&self) -> impl Iterator<Item = (Range<usize>, usize)> {
        self.convolutions.iter().map(|layer| (layer.kernel.clone(), layer.taps * layer.inputs))
    }

    /// Channels of every convolution.
    pub(super) fn channels(&self) -> usize {
        self.convolutions[0].channels
    }

    #[cfg(test)]
    pub(super) fn dense(&self) -> Range<usize> {
        self.dense.clone()
    }
}

/// Room for the layers of `L` spectra, and what came of them.
#[derive(Debug, Clone)]
pub(super) struct Workspace<T, const L: usize> {
    /// Input: positions × bands; then the outputs of the convolutions.
    pub(super) x: [Vec<Lanes<T, L>>; 4],
    g: [Vec<Lanes<T, L>>; 3],
    /// ln q of every class.
    pub(super) scores: Vec<Lanes<T, L>>,
    pub(super) gradient: Vec<T>,
}

impl<T: Real, const L: usize> Workspace<T, L> {
    /// `backward`: whether gradients will be asked for.
    pub(super) fn new(layers: &Layers, backward: bool) -> Self {
        let zeros = |len| vec![[T::ZERO; L]; len];
        let size = |layer: &Convolution| layer.positions * layer.channels;
        let [a, b, c] = layers.convolutions.each_ref().map(size);
        let g = if backward { [a, b, c] } else { [0; 3] };
        Self {
            x: [layers.bands, a, b, c].map(zeros),
            g: g.map(zeros),
            scores: zeros(layers.classes),
            gradient: vec![T::ZERO; if backward { layers.weights() } else { 0 }],
        }
    }

    /// Scores of the input.
    pub(super) fn forward(&mut self, layers: &Layers, weights: &[T]) {
        pulp::Arch::new().dispatch(Kernel { layers, weights, labels: None, workspace: self });
    }

    /// Scores of the input and the gradient of the sum of its losses; lanes without a label count for nothing.
    pub(super) fn backward(&mut self, layers: &Layers, weights: &[T], labels: &[usize]) {
        pulp::Arch::new().dispatch(Kernel { layers, weights, labels: Some(labels), workspace: self });
    }

    #[inline(always)]
    fn scores(&mut self, layers: &Layers, w: &[T]) {
        for (z, bias) in self.scores.iter_mut().zip(&w[layers.biases.clone()]) {
            *z = [*bias; L];
        }
        for (x, w) in self.x[3].iter().zip(w[layers.dense.clone()].chunks_exact(layers.classes)) {
            for (z, w) in self.scores.iter_mut().zip(w) {
                *z = fused(*w, *x, *z);
            }
        }
        for i in 0..L {
            // The largest is taken off first: then no exponential overflows and one of them is 1.
            let largest = self.scores.iter().fold(self.scores[0][i], |a, z| if z[i] > a { z[i] } else { a });
            let sum = self.scores.iter().fold(T::ZERO, |sum, z| sum + (z[i] - largest).exp());
            let ln_sum = sum.ln();
            for z in &mut self.scores {
                z[i] = (z[i] - largest) - ln_sum;
            }
        }
    }

    #[inline(always)]
    fn dense_gradient(&mut self, layers: &Layers, w: &[T], labels: &[usize]) {
        // ∂loss/∂z = q − 1 for the label's class and q for the others.
        for (class, z) in self.scores.iter_mut().enumerate() {
            *z = std::array::from_fn(|i| match labels.get(i) {
                Some(&label) => z[i].exp() - T::of(f64::from(u8::from(label == class))),
                None => T::ZERO,
            });
        }
        let (x, g, classes) = (&self.x[3], &mut self.g[2], layers.classes);
        let dense = self.gradient[layers.dense.clone()].chunks_exact_mut(classes);
        let w = w[layers.dense.clone()].chunks_exact(classes);
        for (((x, g), w), dense) in x.iter().zip(g.iter_mut()).zip(w).zip(dense) {
            *g = [T::ZERO; L];
            for ((z, w), dense) in self.scores.iter().zip(w).zip(dense) {
                *dense = total::<T, L>(std::array::from_fn(|i| x[i] * z[i]));
                *g = fused(*w, *z, *g);
            }
        }
        for (bias, z) in self.gradient[layers.biases.clone()].iter_mut().zip(&self.scores) {
            *bias = total(*z);
        }
        mask(x, g);
    }
}

/// A named type instead of a closure, for the reason given at [`crate::simd::dispatched`].
struct Kernel<'a, T, const L: usize> {
    layers: &'a Layers,
    weights: &'a [T],
    labels: Option<&'a [usize]>,
    workspace: &'a mut Workspace<T, L>,
}

impl<T: Real, const L: usize> pulp::NullaryFnOnce for Kernel<'_, T, L> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { layers, weights: w, labels, workspace } = self;
        let [first, second, third] = &layers.convolutions;
        let [x0, x1, x2, x3] = &mut workspace.x;
        first.forward(w, x0, x1);
        second.forward(w, x1, x2);
        third.forward(w, x2, x3);
        workspace.scores(layers, w);
        if let Some(labels) = labels {
            workspace.dense_gradient(layers, w, labels);
            let ([x0, x1, x2, _], [g1, g2, g3], out) = (&workspace.x, &mut workspace.g, &mut workspace.gradient);
            third.gradient(x2, g3, out);
            third.backward(w, g3, x2, g2);
            second.gradient(x1, g2, out);
            second.backward(w, g2, x1, g1);
            first.gradient(x0, g1, out);
        }
    }
}
