//! How often a classifier takes each class for each.

use super::{Classifier, Judge};
use crate::draws::Draws;
use crate::sequential::Interval;
use crate::spectra::{LabelledSpectra, check_laws, draw_one};
use hadar::error::{Error, Result};
use hadar::parallel;
use rayon::prelude::*;
use std::ops::Range;

/// Spectra that one thread judges at a time.
const CHUNK: usize = 256;
/// Likelihoods closer than this are a tie: fits end within 1e-9 of the largest likelihood.
pub(crate) const TIE: f64 = 1e-6;

/// Decisions counted by true and by chosen class; those that tie share one.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Confusion {
    /// Number of decisions of every true class for every chosen class, `decisions[true][chosen]`.
    pub decisions: Vec<Vec<f64>>,
    /// Spectra whose scores were not as good as they should be.
    pub unconverged: u64,
}

impl Confusion {
    /// Judges all `spectra`. The result does not depend on the number of threads.
    ///
    /// # Errors
    /// Spectra of other bands or classes than the classifier's.
    pub fn of(classifier: &dyn Classifier, spectra: &LabelledSpectra) -> Result<Self> {
        let (bands, classes) = (spectra.bands(), spectra.classes());
        check(classifier, bands, classes)?;
        let parts: Vec<Self> = spectra
            .counts()
            .par_chunks(CHUNK * bands)
            .zip(spectra.labels().par_chunks(CHUNK))
            .map_init(
                || classifier.judge(),
                |judge, (counts, labels)| {
                    hadar::stop::check();
                    let (mut part, mut scores) = (Self::empty(classes), vec![0.0; classes]);
                    for (counts, &label) in counts.chunks_exact(bands).zip(labels) {
                        part.judge(judge.as_mut(), counts, label, &mut scores);
                    }
                    part
                },
            )
            .collect();
        Ok(Self::sum(classes, parts.iter()))
    }

    /// Draws spectra `range` of every class by `draws`, has each judged by all `classifiers`, and forgets it.
    ///
    /// # Errors
    /// No classes, laws for different numbers of bands, a classifier of other bands or classes.
    pub fn of_draws(
        classifiers: &[&dyn Classifier],
        draws: &[Draws],
        range: Range<u64>,
        seed: u64,
    ) -> Result<Vec<Self>> {
        let (bands, classes) = (check_laws(draws)?, draws.len());
        classifiers.iter().try_for_each(|classifier| check(*classifier, bands, classes))?;
        let chunks: Vec<u64> = range.clone().step_by(CHUNK).collect();
        let parts: Vec<Vec<Self>> = parallel::map_with(
            chunks.len(),
            || classifiers.iter().map(|classifier| classifier.judge()).collect::<Vec<_>>(),
            |judges, chunk| {
                let first = chunks[chunk];
                let mut parts = vec![Self::empty(classes); classifiers.len()];
                let (mut counts, mut scores) = (vec![0.0; bands], vec![0.0; classes]);
                for i in first..(first + CHUNK as u64).min(range.end) {
                    for class in 0..classes {
                        draw_one(draws, class, i, seed, &mut counts);
                        for (part, judge) in parts.iter_mut().zip(judges.iter_mut()) {
                            part.judge(judge.as_mut(), &counts, class, &mut scores);
                        }
                    }
                }
                parts
            },
        );
        Ok((0..classifiers.len()).map(|i| Self::sum(classes, parts.iter().map(|part| &part[i]))).collect())
    }

    fn empty(classes: usize) -> Self {
        Self { decisions: vec![vec![0.0; classes]; classes], unconverged: 0 }
    }

    fn judge(&mut self, judge: &mut dyn Judge, counts: &[f64], class: usize, scores: &mut [f64]) {
        self.unconverged += u64::from(!judge.score(counts, scores));
        share(scores, &mut self.decisions[class]);
    }

    fn sum<'p>(classes: usize, parts: impl Iterator<Item = &'p Self>) -> Self {
        let mut sum = Self::empty(classes);
        for part in parts {
            let cells = sum.decisions.iter_mut().flatten().zip(part.decisions.iter().flatten());
            cells.for_each(|(sum, more)| *sum += more);
            sum.unconverged += part.unconverged;
        }
        sum
    }

    /// Spectra of each class.
    #[must_use]
    pub fn spectra(&self) -> Vec<f64> {
        self.decisions.iter().map(|row| row.iter().sum()).collect()
    }

    /// Share of correct decisions of each class.
    #[must_use]
    pub fn shares(&self) -> Vec<f64> {
        let share = |(class, spectra): (usize, f64)| self.decisions[class][class] / spectra.max(1.0);
        self.spectra().into_iter().enumerate().map(share).collect()
    }

    /// Balanced accuracy: the mean over the classes of the share of correct decisions.
    #[must_use]
    pub fn accuracy(&self) -> f64 {
        let shares = self.shares();
        shares.iter().sum::<f64>() / shares.len().max(1) as f64
    }

    /// Interval of the balanced accuracy at a level, from Wilson's of every class.
    #[must_use]
    pub fn interval(&self, level: f64) -> Interval {
        let intervals: Vec<Interval> = self
            .spectra()
            .into_iter()
            .enumerate()
            .map(|(class, spectra)| {
                Interval::wilson(self.decisions[class][class], spectra.round() as u64, level)
            })
            .collect();
        Interval::of_mean(&self.shares(), &intervals)
    }
}

/// Makes sure that spectra are of the classifier's bands and classes.
fn check(classifier: &dyn Classifier, bands: usize, classes: usize) -> Result<()> {
    for (what, found, expected) in
        [("bands", bands, classifier.bands()), ("classes", classes, classifier.classes())]
    {
        if found != expected {
            let what = format!("{what} of the spectra for the classifier `{}`", classifier.name());
            return Err(Error::Length { what, found, expected });
        }
    }
    Ok(())
}

/// Adds one decision to the class of the largest score; those that tie share it.
pub(crate) fn share(scores: &[f64], decisions: &mut [f64]) {
    let largest = scores.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let wins = |score: f64| score >= largest - TIE;
    let winners = scores.iter().filter(|score| wins(**score)).count();
    if winners == 0 {
        // Scores that are no numbers tell nothing: a guess.
        let guess = 1.0 / decisions.len().max(1) as f64;
        return decisions.iter_mut().for_each(|decided| *decided += guess);
    }
    for (decided, score) in decisions.iter_mut().zip(scores) {
        *decided += if wins(*score) { 1.0 / winners as f64 } else { 0.0 };
    }
}
