//! The paper's small convolutional network: it knows no physics, and learns what classes look like from spectra.
//!
//! Every band is standardised by mean and deviation of the training part (a band without scatter gives 0). Then come
//! three one-dimensional convolutions with ReLU, one fully connected layer and softmax ([`Settings`] for the sizes,
//! which the paper leaves open). Weights are those with the smallest cross-entropy of the validation part that Adam
//! came by. Scores are the logarithms of the probabilities.
//!
//! The network sees 2500 spectra and has to learn from them what a likelihood knows, the means of every band, so that
//! it falls short of the likelihood ratio the more, the more bands there are for the same distance of the classes.
//!
//! Source: Methods of the HADAR paper, doi:10.1038/s41586-023-06174-6.

mod convolution;
mod layers;
mod options;
mod real;
mod standard;
mod trained;
mod training;

pub use options::{NetworkOptions, Settings};
pub use trained::Network;
pub use training::Outcome;

use super::{Classifier, Judge};
use crate::spectra::LabelledSpectra;
use hadar::error::{Error, Result};
use layers::{Layers, Workspace};
use standard::Standard;

impl Network {
    /// Trains on one part of the spectra until those of the other show no more progress; `progress` is told after
    /// every epoch how many are done and how many there are at most.
    ///
    /// The weights have the same bits for any number of threads. A training uses several of them for many bands, but
    /// one if it is called from a thread of rayon: then it is the trainings that are many.
    ///
    /// # Errors
    /// No spectra, fewer than two classes, parts that do not fit together, counts whose variance overflows, or a
    /// learning rate so large that the weights did.
    pub fn train(
        training: &LabelledSpectra,
        validation: &LabelledSpectra,
        options: &NetworkOptions,
        progress: &(dyn Fn(usize, usize) + Sync),
    ) -> Result<Self> {
        if training.is_empty() || validation.is_empty() {
            let found = "there are no spectra for training or validation";
            return Err(Error::malformed(found, "give at least one of each"));
        }
        for (what, found, expected) in [
            ("bands of the validation part", validation.bands(), training.bands()),
            ("classes of the validation part", validation.classes(), training.classes()),
        ] {
            if found != expected {
                return Err(Error::Length { what: what.into(), found, expected });
            }
        }
        let layers = Layers::checked(training.bands(), training.classes(), options.settings())?;
        let standard = Standard::new(training)?;
        let parts = [training, validation];
        let train =
            |parallel| training::train(&layers, parts, &standard, options.settings(), parallel, progress);
        let (weights, outcome) =
            if training::parallel(&layers) { rayon::scope(|_| train(true)) } else { train(false) };
        let mut numbers = weights.iter().copied().map(f64::from).chain([outcome.validation_loss]);
        if let Some(number) = numbers.find(|number| !number.is_finite()) {
            let expected = "finite; take a smaller learning rate";
            return Err(Error::out_of_range("a trained weight", number, "", expected));
        }
        Ok(Self { layers, options: *options, standard, weights, outcome })
    }

    /// How the training went.
    #[must_use]
    pub fn outcome(&self) -> &Outcome {
        &self.outcome
    }

    /// Sizes and training.
    #[must_use]
    pub fn options(&self) -> &NetworkOptions {
        &self.options
    }
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

/// One spectrum at a time; its scores have the same bits as in a batch.
struct AtWork<'a> {
    network: &'a Network,
    workspace: Workspace<f32, 1>,
}

impl Judge for AtWork<'_> {
    fn score(&mut self, counts: &[f64], scores: &mut [f64]) -> bool {
        let Network { layers, standard, weights, .. } = self.network;
        if counts.len() != layers.bands || scores.len() != layers.classes {
            scores.fill(f64::NAN);
            return false;
        }
        for (lane, value) in self.workspace.x[0].iter_mut().zip(standard.apply(counts)) {
            *lane = [value];
        }
        self.workspace.forward(layers, weights);
        for (score, [lane]) in scores.iter_mut().zip(&self.workspace.scores) {
            *score = f64::from(*lane);
        }
        // ReLU makes 0 of what is no number, so that the scores would not show it.
        self.workspace.x[0].iter().flatten().all(|x| x.is_finite())
            && scores.iter().all(|score| score.is_finite())
    }
}

#[cfg(test)]
mod tests;
