//! What decides which material a spectrum of counts is from.
//!
//! Every rule gives each class a score, and decides for the largest: ln-likelihoods for rules that know the physics,
//! the logarithm of a probability, or anything that grows with it, for those that were trained.

mod affine;
mod best_fits;
mod confusion;
mod discriminant;
mod likelihood_ratio;
mod logistic;
mod model;
pub mod network;

pub use best_fits::{BestFits, Candidate};
pub use confusion::Confusion;
pub(super) use confusion::share;
pub use discriminant::{Discriminant, SHRINKAGES};
pub use likelihood_ratio::LikelihoodRatio;
pub use logistic::Logistic;
pub use model::{Method, SavedModel, Trained};
pub use network::Network;

use super::spectra::LabelledSpectra;
use hadar::error::{Error, Result};

/// A rule that decides between classes of spectra; it may be used from several threads at once.
pub trait Classifier: Send + Sync {
    /// The name used on the command line and in results.
    fn name(&self) -> &'static str;

    /// How many classes it decides between.
    fn classes(&self) -> usize;

    /// How many bands its spectra have.
    fn bands(&self) -> usize;

    /// The same rule with workspace of its own, for one thread.
    fn judge(&self) -> Box<dyn Judge + '_>;
}

/// A classifier at work.
pub trait Judge: Send {
    /// Writes a score for every class of one spectrum; `false` if they are not as good as they should be (a fit that
    /// did not converge).
    fn score(&mut self, counts: &[f64], scores: &mut [f64]) -> bool;
}

/// Makes sure that the parts a classifier is trained with belong together.
fn check_parts(training: &LabelledSpectra, validation: &LabelledSpectra) -> Result<()> {
    for (what, found, expected) in [
        ("bands of the validation spectra", validation.bands(), training.bands()),
        ("classes of the validation spectra", validation.classes(), training.classes()),
    ] {
        if found != expected {
            return Err(Error::Length { what: what.into(), found, expected });
        }
    }
    if training.is_empty() || validation.is_empty() {
        let found = "there are no spectra to train or to validate with";
        return Err(Error::malformed(found, "give some of every class"));
    }
    Ok(())
}

#[cfg(test)]
mod tests;
