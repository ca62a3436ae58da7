//! The likelihood ratio of best fits (generalised likelihood ratio): states are not known, and fitted.
//!
//! To every candidate material its own free state is fitted (`likelihood`); its score is the largest ln-likelihood.
//! Fits start from given states. A candidate without any is not fitted, and never chosen.

use super::{Classifier, Judge};
use hadar::identifiability::likelihood::MaximumLikelihood;
use hadar::scene::State;

/// A material and the states its fits start from; one without any is not fitted.
#[derive(Debug, Clone)]
pub struct Candidate<'a> {
    /// Emissivity at the nodes.
    pub emissivity: &'a [f64],
    /// Where fits start.
    pub starts: Vec<State>,
}

/// The decision for the material whose best state is the most likely. Made by
/// [`crate::decision::DecisionScene::best_fits`].
#[derive(Debug, Clone)]
pub struct BestFits<'a> {
    fits: MaximumLikelihood<'a>,
    candidates: Vec<Candidate<'a>>,
    /// What is not unknown has its value here.
    known: State,
    bands: usize,
}

impl<'a> BestFits<'a> {
    pub(crate) fn new(
        fits: MaximumLikelihood<'a>,
        candidates: Vec<Candidate<'a>>,
        known: State,
        bands: usize,
    ) -> Self {
        Self { fits, candidates, known, bands }
    }

    /// Candidates that are not fitted: too far away from all that is drawn.
    #[must_use]
    pub fn out_of_reach(&self) -> Vec<usize> {
        (0..self.candidates.len()).filter(|&i| self.candidates[i].starts.is_empty()).collect()
    }
}

impl Classifier for BestFits<'_> {
    fn name(&self) -> &'static str {
        "best-fits"
    }

    fn classes(&self) -> usize {
        self.candidates.len()
    }

    fn bands(&self) -> usize {
        self.bands
    }

    fn judge(&self) -> Box<dyn Judge + '_> {
        Box::new(Worker { rule: self, fits: self.fits.clone() })
    }
}

/// One thread's fits.
struct Worker<'r, 'a> {
    rule: &'r BestFits<'a>,
    fits: MaximumLikelihood<'a>,
}

impl Judge for Worker<'_, '_> {
    fn score(&mut self, counts: &[f64], scores: &mut [f64]) -> bool {
        let mut converged = true;
        for (score, candidate) in scores.iter_mut().zip(&self.rule.candidates) {
            *score = f64::NEG_INFINITY;
            if !candidate.starts.is_empty() {
                let fit = self.fits.fit(candidate.emissivity, counts, &self.rule.known, &candidate.starts);
                converged &= fit.converged;
                *score = fit.log_likelihood;
            }
        }
        converged
    }
}
