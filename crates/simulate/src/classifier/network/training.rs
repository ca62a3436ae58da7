//! Training by Adam on the cross-entropy, stopped early.
//!
//! ```text
//! m ← β₁ m + (1 − β₁) g,   v ← β₂ v + (1 − β₂) g²,   w ← w − η [m/(1 − β₁ᵗ)]/(√(v/(1 − β₂ᵗ)) + ε) − η λ w
//! ```
//!
//! with β₁ = 0.9, β₂ = 0.999, ε = 10⁻⁸, λ the weight decay and η falling linearly from the learning rate to 0.
//!
//! Sources: Kingma and Ba, ICLR 2015, arXiv:1412.6980 (Adam); Loshchilov and Hutter, ICLR 2019, arXiv:1711.05101
//! (decay beside Adam); He et al., ICCV 2015, doi:10.1109/ICCV.2015.123 (first weights).

use super::layers::{Layers, Workspace};
use super::options::{LANES, Settings};
use super::real::Real;
use super::standard::Standard;
use crate::draws::generator;
use crate::spectra::LabelledSpectra;
use rand::rngs::ChaCha8Rng;
use rand::seq::SliceRandom;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;

/// Streams of random numbers that no spectrum has.
const STREAM: u64 = 1 << 63;

/// How a training went.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Outcome {
    /// Number of passes over the training examples.
    pub epochs: usize,
    /// The epoch after which the weights were as they are now; 0 if nothing lowered the validation loss.
    pub best_epoch: usize,
    /// Mean cross-entropy of the validation part, nats.
    pub validation_loss: f64,
    /// Number of weights, biases among them.
    pub weights: usize,
}

/// First and second moments of the gradients so far.
#[derive(Debug, Clone)]
pub(super) struct Adam<T> {
    moments: Vec<[T; 2]>,
    steps: i32,
}

impl<T: Real> Adam<T> {
    const BETA: [f64; 2] = [0.9, 0.999];
    const EPSILON: f64 = 1e-8;

    pub(super) fn new(weights: usize) -> Self {
        Self { moments: vec![[T::ZERO; 2]; weights], steps: 0 }
    }

    pub(super) fn step(&mut self, weights: &mut [T], gradient: &[T], rate: f64, decay: f64) {
        self.steps = self.steps.saturating_add(1);
        let [b1, b2] = Self::BETA.map(T::of);
        let [c1, c2] = Self::BETA.map(|beta| T::of(1.0 - beta));
        let [m_scale, v_scale] = Self::BETA.map(|beta| 1.0 / (1.0 - beta.powi(self.steps)));
        let (rate_m, v_scale) = (T::of(rate * m_scale), T::of(v_scale));
        let (keep, epsilon) = (T::of(1.0 - rate * decay), T::of(Self::EPSILON));
        for ((w, [m, v]), g) in weights.iter_mut().zip(&mut self.moments).zip(gradient) {
            *m = b1 * *m + c1 * *g;
            *v = b2 * *v + c2 * (*g * *g);
            *w = *w * keep - rate_m * *m / ((*v * v_scale).sqrt() + epsilon);
        }
    }
}

/// Standardised spectra.
struct Set<'a, T> {
    bands: usize,
    values: Vec<T>,
    labels: &'a [usize],
}

impl<'a, T: Real> Set<'a, T> {
    fn new(spectra: &'a LabelledSpectra, standard: &Standard) -> Self {
        let values = spectra.iter().flat_map(|(counts, _)| standard.apply(counts));
        Self { bands: spectra.bands(), values: values.collect(), labels: spectra.labels() }
    }

    /// Puts spectra into the lanes of the input, and 0 into those left over.
    fn load(&self, chosen: &[usize], input: &mut [[T; LANES]]) {
        input.fill([T::ZERO; LANES]);
        for (lane, &i) in chosen.iter().enumerate() {
            let spectrum = self.values.get(i * self.bands..).unwrap_or_default();
            for (lanes, value) in input.iter_mut().zip(spectrum) {
                lanes[lane] = *value;
            }
        }
    }

    fn labels<'b>(&self, chosen: &[usize], room: &'b mut [usize; LANES]) -> &'b [usize] {
        for (room, &i) in room.iter_mut().zip(chosen) {
            *room = self.labels[i];
        }
        &room[..chosen.len().min(LANES)]
    }
}

/// First weights: normal of variance 2/(numbers in a sum), biases and the fully connected layer 0, so that training
/// begins with equal probabilities of all classes.
pub(super) fn first_weights<T: Real>(layers: &Layers, seed: u64) -> Vec<T> {
    let mut weights = vec![T::ZERO; layers.weights()];
    let mut rng = generator(seed, STREAM);
    for (range, summed) in layers.kernels() {
        let sigma = (2.0 / summed as f64).sqrt();
        let normal = |rng: &mut ChaCha8Rng| -> f64 { StandardNormal.sample(rng) };
        weights[range].fill_with(|| T::of(sigma * normal(&mut rng)));
    }
    weights
}

/// Whether the parts of a batch go to several threads: not if they are too small for it, nor on a thread that already
/// is one of several. There a training would wait for its parts while its thread takes up another whole training.
pub(super) fn parallel(layers: &Layers) -> bool {
    const WORTH_A_THREAD: usize = 1024;
    layers.bands * layers.channels() >= WORTH_A_THREAD && rayon::current_thread_index().is_none()
}

/// The weights with the smallest validation loss.
pub(super) fn train<T: Real>(
    layers: &Layers,
    spectra: [&LabelledSpectra; 2],
    standard: &Standard,
    settings: &Settings,
    parallel: bool,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> (Vec<T>, Outcome) {
    let [training, validation] = spectra.map(|spectra| Set::<T>::new(spectra, standard));
    let mut weights = first_weights(layers, settings.seed);
    let mut adam = Adam::new(weights.len());
    let mut workspaces = vec![Workspace::new(layers, true); settings.batch / LANES];
    let mut gradient = vec![T::ZERO; weights.len()];
    let mut rng = generator(settings.seed, STREAM + 1);
    let mut order: Vec<usize> = (0..training.labels.len()).collect();
    let all: Vec<usize> = (0..validation.labels.len()).collect();

    let steps = settings.epochs * order.len().div_ceil(settings.batch);
    let mut step = 0;
    let mut best = (weights.clone(), f64::INFINITY, 0);
    let mut epochs = 0;
    while epochs < settings.epochs && epochs - best.2 < settings.patience {
        order.shuffle(&mut rng);
        for batch in order.chunks(settings.batch) {
            hadar::stop::check();
            each(parallel, &mut workspaces, batch, |workspace, chosen| {
                training.load(chosen, &mut workspace.x[0]);
                workspace.backward(layers, &weights, training.labels(chosen, &mut [0; LANES]));
            });
            gradient.fill(T::ZERO);
            let share = T::of(1.0 / batch.len() as f64);
            for workspace in &workspaces[..batch.len().div_ceil(LANES)] {
                for (sum, g) in gradient.iter_mut().zip(&workspace.gradient) {
                    *sum = g.fused(share, *sum);
                }
            }
            let rate = settings.learning_rate * (1.0 - step as f64 / steps as f64);
            adam.step(&mut weights, &gradient, rate, settings.weight_decay);
            step += 1;
        }
        epochs += 1;
        let loss = loss(layers, &weights, &validation, &all, &mut workspaces, parallel);
        if loss < best.1 {
            best = (weights.clone(), loss, epochs);
        }
        progress(epochs, settings.epochs);
    }
    let (weights, validation_loss, best_epoch) = best;
    let count = weights.len();
    (weights, Outcome { epochs, best_epoch, validation_loss, weights: count })
}

/// Works on the parts of a batch, a workspace for each. Which thread does it changes nothing in them.
fn each<T: Real, const L: usize>(
    parallel: bool,
    workspaces: &mut [Workspace<T, L>],
    batch: &[usize],
    work: impl Fn(&mut Workspace<T, L>, &[usize]) + Sync,
) {
    if parallel {
        let parts = workspaces.par_iter_mut().zip(batch.par_chunks(L));
        parts.for_each(|(workspace, chosen)| work(workspace, chosen));
    } else {
        let parts = workspaces.iter_mut().zip(batch.chunks(L));
        parts.for_each(|(workspace, chosen)| work(workspace, chosen));
    }
}

/// Mean cross-entropy, nats.
fn loss<T: Real>(
    layers: &Layers,
    weights: &[T],
    set: &Set<T>,
    all: &[usize],
    workspaces: &mut [Workspace<T, LANES>],
    parallel: bool,
) -> f64 {
    let mut sum = 0.0;
    for batch in all.chunks(workspaces.len() * LANES) {
        hadar::stop::check();
        each(parallel, workspaces, batch, |workspace, chosen| {
            set.load(chosen, &mut workspace.x[0]);
            workspace.forward(layers, weights);
        });
        for (lane, &i) in batch.iter().enumerate() {
            sum -= workspaces[lane / LANES].scores[set.labels[i]][lane % LANES].to_f64();
        }
    }
    sum / all.len() as f64
}
