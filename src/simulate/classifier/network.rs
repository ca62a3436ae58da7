//! The paper's small convolutional network.

pub mod options;
mod layers;
mod training;
#[cfg(test)]
mod tests;

pub use options::{NetworkOptions, Settings};

use super::{Classifier, Judge};
use crate::error::{Error, Result};
use crate::simulate::spectra::LabelledSpectra;
use layers::{Layers, Workspace};

/// Mean of every band and the reciprocal of its deviation.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Standard {
    means: Vec<f64>,
    /// 0 for a band without scatter.
    scales: Vec<f64>,
}

impl Standard {
    /// From the spectra's own scatter.
    fn new(spectra: &LabelledSpectra) -> Result<Self> {
        let n = spectra.len() as f64;
        let mut means = vec![0.0; spectra.bands()];
        for (counts, _) in spectra.iter() {
            means.iter_mut().zip(counts).for_each(|(mean, count)| *mean += count / n);
        }
        let mut variances = vec![0.0; spectra.bands()];
        for (counts, _) in spectra.iter() {
            for ((variance, mean), count) in variances.iter_mut().zip(&means).zip(counts) {
                *variance += (count - mean).powi(2) / n;
            }
        }
        let scale = |(band, variance): (usize, &f64)| {
            let mut counts = spectra.counts().iter().skip(band).step_by(spectra.bands());
            let first = counts.next();
            // Rounding of the mean leaves a scatter that is none.
            if counts.all(|count| Some(count) == first) { Ok(0.0) } else {
                let scale = 1.0 / variance.sqrt();
                if scale.is_finite() && scale > 0.0 { Ok(scale) } else {
                    Err(Error::out_of_range("variance of a band", *variance, "", "a finite number above 0"))
                }
            }
        };
        let scales = variances.iter().enumerate().map(scale).collect::<Result<_>>()?;
        Ok(Self { means, scales })
    }

    fn apply<'a, T: layers::Real>(&'a self, counts: &'a [f64]) -> impl Iterator<Item = T> + 'a {
        let each = counts.iter().zip(&self.means).zip(&self.scales);
        each.map(|((count, mean), scale)| T::of((count - mean) * scale))
    }
}

/// How a training went.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Outcome {
    /// Epochs gone through.
    pub epochs: usize,
    /// The one whose weights were kept.
    pub best_epoch: usize,
    /// Mean cross-entropy of the validation part, nats.
    pub validation_loss: f64,
    /// Number of weights, biases among them.
    pub weights: usize,
}

/// A trained network.
#[derive(Debug, Clone, PartialEq)]
pub struct Network {
    layers: Layers,
    options: NetworkOptions,
    standard: Standard,
    weights: Vec<f32>,
    outcome: Outcome,
}

impl Network {
    /// Trains.
    pub fn train(
        training: &LabelledSpectra,
        validation: &LabelledSpectra,
        options: &NetworkOptions,
        progress: &(dyn Fn(usize, usize) + Sync),
    ) -> Result<Self> {
        let s = options.settings();
        let layers = Layers::new(training.bands(), training.classes(), s.channels, s.taps, s.stride);
        let standard = Standard::new(training)?;
        let (weights, outcome) = training::train(&layers, [training, validation], &standard, s, progress);
        Ok(Self { layers, options: *options, standard, weights, outcome })
    }

    /// outcome
    pub fn outcome(&self) -> &Outcome { &self.outcome }
}

impl Classifier for Network {
    fn name(&self) -> &'static str {
        "network"
    }

    fn classes(&self) -> usize {
        self.layers.classes
    }

    fn bands(&self) -> usize {
        self.layers.bands
    }

    fn judge(&self) -> Box<dyn Judge + '_> {
        Box::new(AtWork { network: self, workspace: Workspace::new(&self.layers, false) })
    }
}

struct AtWork<'a> {
    network: &'a Network,
    workspace: Workspace<f32, 1>,
}

impl Judge for AtWork<'_> {
    fn score(&mut self, counts: &[f64], scores: &mut [f64]) -> bool {
        let Network { layers, standard, weights, .. } = self.network;
        for (lane, value) in self.workspace.x[0].iter_mut().zip(standard.apply(counts)) {
            *lane = [value];
        }
        self.workspace.forward(layers, weights);
        for (score, [lane]) in scores.iter_mut().zip(&self.workspace.scores) {
            *score = f64::from(*lane);
        }
        scores.iter().all(|score| score.is_finite())
    }
}
