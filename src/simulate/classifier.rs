//! What decides which material a spectrum of counts is from.
//!
//! Every rule gives each class a score, and decides for the largest: ln-likelihoods for rules that know the physics,
//! the logarithm of a probability, or anything that grows with it, for those that were trained.

pub mod network;

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
pub trait Judge {
    /// Writes a score for every class of one spectrum; `false` if they are not as good as they should be (a fit that
    /// did not converge).
    fn score(&mut self, counts: &[f64], scores: &mut [f64]) -> bool;
}
