//! Scores that are linear in the counts, and the scale they are trained on.

use super::Judge;
use crate::spectra::LabelledSpectra;
use hadar::error::{Error, Result, check};

/// Partial sums, so that products need not wait for each other.
const LANES: usize = 8;

/// Score of class c: constant_c + Σ_w (n_w − centre_w) weight_cw.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub(super) struct Affine {
    pub(super) centre: Vec<f64>,
    pub(super) weights: Vec<Vec<f64>>,
    pub(super) constants: Vec<f64>,
}

impl Affine {
    /// Makes sure that lengths fit and that all are numbers: what comes from a file may be anything.
    pub(super) fn checked(self) -> Result<Self> {
        let lengths = self.weights.iter().map(|weights| (weights.len(), self.centre.len()));
        let classes = std::iter::once((self.constants.len(), self.weights.len()));
        if let Some((found, expected)) = lengths.chain(classes).find(|(found, expected)| found != expected) {
            return Err(Error::Length { what: "weights of a linear classifier".into(), found, expected });
        }
        if self.centre.is_empty() || self.weights.len() < 2 {
            return Err(Error::malformed("a classifier without bands or classes", "train one"));
        }
        let all = self.centre.iter().chain(self.weights.iter().flatten()).chain(&self.constants);
        all.into_iter()
            .try_for_each(|&value| check::finite("weight of a classifier", value, "").map(drop))?;
        Ok(self)
    }
}

impl Judge for &Affine {
    fn score(&mut self, counts: &[f64], scores: &mut [f64]) -> bool {
        for ((score, weights), constant) in scores.iter_mut().zip(&self.weights).zip(&self.constants) {
            let mut sums = [0.0; LANES];
            let chunks = counts.chunks(LANES).zip(self.centre.chunks(LANES)).zip(weights.chunks(LANES));
            for ((counts, centre), weights) in chunks {
                for (sum, ((n, m), a)) in sums.iter_mut().zip(counts.iter().zip(centre).zip(weights)) {
                    *sum += (n - m) * a;
                }
            }
            *score = constant + sums.iter().sum::<f64>();
        }
        true
    }
}

/// Mean and deviation within the classes of every band, which training takes as zero and unit.
#[derive(Debug, Clone)]
pub(super) struct Scale {
    pub(super) means: Vec<f64>,
    /// 1/deviation; 0 for a band that does not scatter, which then tells nothing.
    pub(super) inverse: Vec<f64>,
    /// Mean of each class on that scale.
    pub(super) classes: Vec<Vec<f64>>,
}

impl Scale {
    /// From spectra of at least two classes, every one of which has some.
    pub(super) fn of(spectra: &LabelledSpectra) -> Result<Self> {
        let (bands, classes) = (spectra.bands(), spectra.classes());
        let mut numbers = vec![0.0_f64; classes];
        spectra.labels().iter().for_each(|&label| numbers[label] += 1.0);
        if classes < 2 || numbers.contains(&0.0) {
            return Err(Error::malformed(
                format!("training spectra of {classes} classes, in numbers {numbers:?}"),
                "give spectra of at least two classes, and some of every one",
            ));
        }
        let mut means = vec![vec![0.0; bands]; classes];
        for (counts, label) in spectra.iter() {
            means[label].iter_mut().zip(counts).for_each(|(sum, n)| *sum += n);
        }
        for (means, number) in means.iter_mut().zip(&numbers) {
            means.iter_mut().for_each(|sum| *sum /= number);
        }
        let mut square = vec![0.0; bands];
        for (counts, label) in spectra.iter() {
            let off = counts.iter().zip(&means[label]).map(|(n, mean)| n - mean);
            square.iter_mut().zip(off).for_each(|(sum, off)| *sum += off * off);
        }
        let freedom = (spectra.len() as f64 - classes as f64).max(1.0);
        let inverse: Vec<f64> =
            square.iter().map(|s| if *s > 0.0 { (freedom / s).sqrt() } else { 0.0 }).collect();
        let total: Vec<f64> =
            (0..bands).map(|w| means.iter().map(|m| m[w]).sum::<f64>() / classes as f64).collect();
        let on_scale = |means: &Vec<f64>| -> Vec<f64> {
            means.iter().zip(&total).zip(&inverse).map(|((m, t), i)| (m - t) * i).collect()
        };
        Ok(Self { classes: means.iter().map(on_scale).collect(), means: total, inverse })
    }

    /// All spectra on that scale, band by band (one row per band, one column per spectrum in column-major order).
    pub(super) fn apply(&self, spectra: &LabelledSpectra) -> nalgebra::DMatrix<f64> {
        let scaled = spectra.iter().flat_map(|(counts, _)| {
            counts.iter().zip(&self.means).zip(&self.inverse).map(|((n, m), i)| (n - m) * i)
        });
        nalgebra::DMatrix::from_iterator(spectra.bands(), spectra.len(), scaled)
    }

    /// The rule on counts that has `weights` (a column for each class) and `constants` on this scale.
    pub(super) fn rule(&self, weights: &nalgebra::DMatrix<f64>, constants: Vec<f64>) -> Result<Affine> {
        let weights = weights.column_iter().map(|column| {
            column.iter().zip(&self.inverse).map(|(weight, inverse)| weight * inverse).collect()
        });
        Affine { centre: self.means.clone(), weights: weights.collect(), constants }.checked()
    }
}
