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
//! order that is written out, and compiled per instruction set as in [`hadar::simd`].

use super::convolution::Convolution;
use super::options::Settings;
use super::real::{Lanes, Real, mask, total};
use hadar::error::{Error, Result};
use pulp::Simd;
use std::ops::Range;

/// Most bands and most classes, so that no number of weights overflows.
const LARGEST: usize = 1 << 20;
/// Layers with fewer positions than this are not thinned out by a stride.
const SHORT: usize = 16;

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
    /// Layers for spectra of a kind that can be told apart.
    pub(super) fn checked(bands: usize, classes: usize, settings: &Settings) -> Result<Self> {
        let within = |what: &str, value: usize, least: usize| match value {
            value if (least..=LARGEST).contains(&value) => Ok(()),
            value => Err(Error::out_of_range(what, value as f64, "", format!("from {least} to {LARGEST}"))),
        };
        within("number of bands", bands, 1)?;
        within("number of classes", classes, 2)?;
        Ok(Self::new(bands, classes, settings.channels, settings.taps, settings.stride))
    }

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
    fn scores<S: Simd>(&mut self, simd: S, layers: &Layers, w: &[T]) {
        for (z, bias) in self.scores.iter_mut().zip(&w[layers.biases.clone()]) {
            *z = [*bias; L];
        }
        for (x, w) in self.x[3].iter().zip(w[layers.dense.clone()].chunks_exact(layers.classes)) {
            for (z, w) in self.scores.iter_mut().zip(w) {
                T::scaled(simd, *w, x, z);
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
    fn dense_gradient<S: Simd>(&mut self, simd: S, layers: &Layers, w: &[T], labels: &[usize]) {
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
                T::scaled(simd, *w, z, g);
            }
        }
        for (bias, z) in self.gradient[layers.biases.clone()].iter_mut().zip(&self.scores) {
            *bias = total(*z);
        }
        mask(x, g);
    }
}

/// A named type instead of a closure, for the reason given at [`hadar::simd::dispatched`].
struct Kernel<'a, T, const L: usize> {
    layers: &'a Layers,
    weights: &'a [T],
    labels: Option<&'a [usize]>,
    workspace: &'a mut Workspace<T, L>,
}

impl<T: Real, const L: usize> pulp::WithSimd for Kernel<'_, T, L> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { layers, weights: w, labels, workspace } = self;
        let [first, second, third] = &layers.convolutions;
        let [x0, x1, x2, x3] = &mut workspace.x;
        first.forward(simd, w, x0, x1);
        second.forward(simd, w, x1, x2);
        third.forward(simd, w, x2, x3);
        workspace.scores(simd, layers, w);
        if let Some(labels) = labels {
            workspace.dense_gradient(simd, layers, w, labels);
            let ([x0, x1, x2, _], [g1, g2, g3], out) =
                (&workspace.x, &mut workspace.g, &mut workspace.gradient);
            third.gradient(simd, x2, g3, out);
            third.backward(simd, w, g3, x2, g2);
            second.gradient(simd, x1, g2, out);
            second.backward(simd, w, g2, x1, g1);
            first.gradient(simd, x0, g1, out);
        }
    }
}
