//! Labelled spectra of counts: drawn about the means of every class, parted into training, validation and test.
//!
//! Spectrum i of class c has the stream of random numbers c·2⁴⁰ + i of its own, so that neither the number of threads
//! nor the number of spectra changes any of them. Training, validation and test have ranges of i that never meet
//! ([`Parts`]): a classifier that was trained on more spectra has still seen none of the test.

use super::draws::{Draws, STREAMS, generator};
use hadar::error::{Error, Result};
use rayon::prelude::*;
use std::ops::Range;

/// Most spectra of one class, and most counts that are kept at once (4 GB).
pub const MOST_SPECTRA: usize = 100_000_000;
const MOST_COUNTS: usize = 500_000_000;
/// Where the spectra for validation and for the test begin; those for training begin at 0.
const VALIDATION: u64 = 1 << 38;
const TEST: u64 = 1 << 39;

/// Spectra of counts, each with the class it is from.
#[derive(Debug, Clone, PartialEq)]
pub struct LabelledSpectra {
    bands: usize,
    classes: usize,
    /// Spectrum after spectrum.
    counts: Vec<f64>,
    labels: Vec<usize>,
}

impl LabelledSpectra {
    /// Spectra one after the other in `counts`, `bands` counts each, and their `labels` below `classes`.
    ///
    /// # Errors
    /// Lists whose lengths do not fit together, a label of no class, a count that is no number.
    pub fn new(bands: usize, classes: usize, counts: Vec<f64>, labels: Vec<usize>) -> Result<Self> {
        if counts.len() != labels.len() * bands || bands == 0 {
            return Err(Error::Length {
                what: "counts of the labelled spectra".into(),
                found: counts.len(),
                expected: labels.len() * bands.max(1),
            });
        }
        if let Some(&label) = labels.iter().find(|&&label| label >= classes) {
            let expected = format!("below the number of classes, {classes}");
            return Err(Error::out_of_range("label", label as f64, "", expected));
        }
        if let Some(&count) = counts.iter().find(|count| !count.is_finite()) {
            return Err(Error::out_of_range("count", count, "", "a finite number"));
        }
        Ok(Self { bands, classes, counts, labels })
    }

    /// Spectra `range` of every class, drawn by the laws of `draws`, one of each class; class by class in turn.
    ///
    /// # Errors
    /// No classes, laws for different numbers of bands, more counts than memory should hold.
    pub fn draw(draws: &[Draws], range: Range<u64>, seed: u64) -> Result<Self> {
        let (bands, classes) = (check_laws(draws)?, draws.len());
        let each = (MOST_COUNTS / (bands * classes)) as u64;
        let spectra = range.end.saturating_sub(range.start);
        if spectra > each {
            let expected = format!(
                "at most {each} with {classes} classes of {bands} bands, as many as are kept in memory"
            );
            return Err(Error::out_of_range("training spectra of each class", spectra as f64, "", expected));
        }
        let mut counts = vec![0.0; bands * classes * spectra as usize];
        counts.par_chunks_mut(bands * classes).enumerate().for_each(|(i, chunk)| {
            hadar::stop::check();
            for (class, spectrum) in chunk.chunks_mut(bands).enumerate() {
                draw_one(draws, class, range.start + i as u64, seed, spectrum);
            }
        });
        let labels = (0..spectra).flat_map(|_| 0..classes).collect();
        Ok(Self { bands, classes, counts, labels })
    }

    /// How many spectra there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.labels.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.labels.is_empty()
    }

    /// Bands of a spectrum.
    #[must_use]
    pub fn bands(&self) -> usize {
        self.bands
    }

    /// Classes they are from.
    #[must_use]
    pub fn classes(&self) -> usize {
        self.classes
    }

    /// Class of every spectrum.
    #[must_use]
    pub fn labels(&self) -> &[usize] {
        &self.labels
    }

    /// The counts of all spectra, one after the other.
    #[must_use]
    pub fn counts(&self) -> &[f64] {
        &self.counts
    }

    /// Every spectrum with its class.
    pub fn iter(&self) -> impl Iterator<Item = (&[f64], usize)> {
        self.counts.chunks_exact(self.bands.max(1)).zip(self.labels.iter().copied())
    }
}

/// Draws spectrum `i` of one class.
pub(super) fn draw_one(draws: &[Draws], class: usize, i: u64, seed: u64, counts: &mut [f64]) {
    let stream = class as u64 * STREAMS + i;
    draws[class].draw_into(&mut generator(seed, stream), counts);
}

/// Makes sure that there are classes of as many bands each; returns the bands.
pub(super) fn check_laws(draws: &[Draws]) -> Result<usize> {
    let expected = draws.first().map_or(0, Draws::bands);
    if expected == 0 {
        return Err(Error::malformed("there are no bands or classes to draw", "give at least one"));
    }
    match draws.iter().map(Draws::bands).find(|bands| *bands != expected) {
        Some(found) => Err(Error::Length { what: "bands of a class".into(), found, expected }),
        None => Ok(expected),
    }
}

/// Which spectra of each class are for training, for validation and for the test: 25, 25 and 50 %, as in the paper.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Parts {
    /// What parameters are fitted to.
    pub training: Range<u64>,
    /// What says when to stop.
    pub validation: Range<u64>,
    /// What the accuracy is measured on; no classifier sees it before.
    pub test: Range<u64>,
}

impl Parts {
    /// Parts of `per_class` spectra.
    ///
    /// # Errors
    /// Fewer than 4, which leave a part empty, or more than [`MOST_SPECTRA`].
    pub fn of(per_class: usize) -> Result<Self> {
        if per_class < 4 {
            let expected = "at least 4: a quarter each for training and validation, half for the test";
            return Err(Error::out_of_range("spectra of each class", per_class as f64, "", expected));
        }
        if per_class > MOST_SPECTRA {
            return Err(Error::out_of_range("spectra of each class", per_class as f64, "", "at most 1e8"));
        }
        let (quarter, rest) = ((per_class / 4) as u64, (per_class - 2 * (per_class / 4)) as u64);
        let part = |first: u64, spectra: u64| first..first + spectra;
        Ok(Self { training: part(0, quarter), validation: part(VALIDATION, quarter), test: part(TEST, rest) })
    }
}

/// Spectra for training, for validation and for the test.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Split {
    /// See [`Parts`].
    pub training: LabelledSpectra,
    /// See [`Parts`].
    pub validation: LabelledSpectra,
    /// See [`Parts`].
    pub test: LabelledSpectra,
}

impl Split {
    /// Draws `per_class` spectra of every class.
    ///
    /// # Errors
    /// As [`Parts::of`] and [`LabelledSpectra::draw`].
    pub fn draw(draws: &[Draws], per_class: usize, seed: u64) -> Result<Self> {
        let parts = Parts::of(per_class)?;
        let part = |range| LabelledSpectra::draw(draws, range, seed);
        Ok(Self {
            training: part(parts.training)?,
            validation: part(parts.validation)?,
            test: part(parts.test)?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hadar::statistics::Statistics;

    fn two() -> Vec<Draws> {
        let draws = |means: &[f64]| Draws::new(&Statistics::Poisson, means).unwrap();
        vec![draws(&[10.0, 1e6]), draws(&[20.0, 1e6])]
    }

    /// A spectrum depends on its class and its number alone.
    #[test]
    fn a_spectrum_is_the_same_however_many_are_drawn() {
        let [few, many] = [3..5, 0..9].map(|range| LabelledSpectra::draw(&two(), range, 7).unwrap());
        assert_eq!(few.counts(), &many.counts()[3 * 4..5 * 4]);
        assert_ne!(few.counts()[..2], few.counts()[4..6]);
        assert_eq!(many.labels()[..4], [0, 1, 0, 1]);
    }

    /// Parts do not overlap and have the paper's shares.
    #[test]
    fn parts_are_25_25_and_50_percent() {
        let split = Split::draw(&two(), 40, 1).unwrap();
        assert_eq!([split.training.len(), split.validation.len(), split.test.len()], [20, 20, 40]);
        // Of many more spectra, no spectrum for training is one of the test.
        let more = Split::draw(&two(), 400, 1).unwrap();
        assert_eq!(&more.test.counts()[..split.test.counts().len()], split.test.counts());
        let has = |spectra: &LabelledSpectra, one: &[f64]| spectra.iter().any(|(counts, _)| counts == one);
        for (one, _) in split.test.iter() {
            assert!(!has(&more.training, one) && !has(&more.validation, one));
        }
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        assert!(Split::draw(&two(), 3, 1).is_err() && Split::draw(&two(), usize::MAX, 1).is_err());
        assert!(LabelledSpectra::draw(&two(), 0..u64::MAX, 1).is_err());
        assert!(Split::draw(&[], 8, 1).is_err());
        assert!(LabelledSpectra::new(2, 2, vec![1.0; 4], vec![0, 2]).is_err());
        assert!(LabelledSpectra::new(2, 2, vec![1.0; 3], vec![0, 1]).is_err());
        assert!(LabelledSpectra::new(1, 1, vec![f64::NAN], vec![0]).is_err());
    }
}
