//! Linear discriminant: the likelihood ratio of normal classes with one covariance, both estimated from spectra.
//!
//! With x the counts in units of each band's deviation, m_c the mean of class c and S the pooled covariance:
//! score_c = m_cᵀS_λ⁻¹x − ½m_cᵀS_λ⁻¹m_c, S_λ = (1 − λ)S + λ·1 (the diagonal of S is 1). Of the shrinkages λ offered the
//! one that is right most often on the validation part is kept, the larger if two tie. λ = 0 is Fisher's discriminant,
//! λ = 1 neglects correlations, of which shot noise has none.
//!
//! n spectra in p bands cannot tell all of S: with λ = 0 the accuracy of two classes of half separation d falls from Φ(d)
//! to about Φ(d √(1 − p/n)/√(1 + p/(n d²))), with λ = 1 to about Φ(d/√(1 + p/(n d²))). S_λ is factorised by
//! Cholesky, nothing inverted.
//!
//! Symbols: p bands, n training spectra of all classes.
//!
//! Sources: Fisher, Ann. Eugen. 7, 179 (1936), doi:10.1111/j.1469-1809.1936.tb02137.x; Raudys and Young, J. Multivar.
//! Anal. 89, 1 (2004), doi:10.1016/S0047-259X(02)00021-0 (accuracy); Friedman, J. Am. Stat. Assoc. 84, 165 (1989),
//! doi:10.1080/01621459.1989.10478752 (shrinkage).

use super::affine::{Affine, Scale};
use super::{Classifier, Confusion, Judge, check_parts};
use crate::spectra::LabelledSpectra;
use hadar::error::{Error, Result, check};
use nalgebra::{Cholesky, DMatrix};

/// Shrinkages that are tried.
pub const SHRINKAGES: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

/// The linear discriminant, trained.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(try_from = "Raw")]
pub struct Discriminant {
    /// Shrinkage λ of the covariance that was kept, 0 to 1.
    shrinkage: f64,
    rule: Affine,
}

#[derive(serde::Deserialize)]
struct Raw {
    shrinkage: f64,
    rule: Affine,
}

impl TryFrom<Raw> for Discriminant {
    type Error = Error;

    fn try_from(raw: Raw) -> Result<Self> {
        check::unit_interval("shrinkage", raw.shrinkage)?;
        Ok(Self { shrinkage: raw.shrinkage, rule: raw.rule.checked()? })
    }
}

impl Discriminant {
    /// Trains with each of `shrinkages` (those whose S_λ is singular left out) and keeps the best on `validation`.
    ///
    /// # Errors
    /// Parts of other bands or classes, a class without spectra, a λ outside [0, 1], or none that leaves S_λ regular
    /// (λ = 1 always does).
    pub fn train(
        training: &LabelledSpectra,
        validation: &LabelledSpectra,
        shrinkages: &[f64],
    ) -> Result<Self> {
        check_parts(training, validation)?;
        let scale = Scale::of(training)?;
        let (bands, classes) = (training.bands(), training.classes());
        let mut off = scale.apply(training);
        for (mut column, &label) in off.column_iter_mut().zip(training.labels()) {
            column.iter_mut().zip(&scale.classes[label]).for_each(|(x, mean)| *x -= mean);
        }
        let freedom = (training.len() as f64 - classes as f64).max(1.0);
        let covariance = &off * off.transpose() / freedom;
        let means = DMatrix::from_iterator(bands, classes, scale.classes.iter().flatten().copied());
        let mut best: Option<(f64, Self)> = None;
        for &shrinkage in shrinkages {
            hadar::stop::check();
            check::unit_interval("shrinkage", shrinkage)?;
            let Some(rule) = solve(&covariance, &means, shrinkage, freedom) else { continue };
            let constants = (0..classes).map(|c| -0.5 * rule.column(c).dot(&means.column(c))).collect();
            let trained = Self { shrinkage, rule: scale.rule(&rule, constants)? };
            let right = Confusion::of(&trained, validation)?.accuracy();
            let better = best.as_ref().is_none_or(|(accuracy, other)| {
                right > *accuracy || (right == *accuracy && shrinkage > other.shrinkage)
            });
            if better {
                best = Some((right, trained));
            }
        }
        best.map(|(_, trained)| trained).ok_or_else(|| {
            let found =
                format!("{} training spectra cannot tell the covariance of {bands} bands", training.len());
            Error::malformed(found, "give more spectra than bands, or a shrinkage above 0")
        })
    }

    /// The shrinkage λ that was kept.
    #[must_use]
    pub fn shrinkage(&self) -> f64 {
        self.shrinkage
    }
}

/// S_λ⁻¹m by Cholesky; `None` where S_λ is singular.
fn solve(
    covariance: &DMatrix<f64>,
    means: &DMatrix<f64>,
    shrinkage: f64,
    freedom: f64,
) -> Option<DMatrix<f64>> {
    let bands = covariance.nrows();
    if shrinkage == 0.0 && freedom < bands as f64 {
        return None;
    }
    let mut shrunk = covariance * (1.0 - shrinkage);
    for w in 0..bands {
        // A band without scatter has neither variance nor weight.
        shrunk[(w, w)] = if covariance[(w, w)] > 0.0 { shrunk[(w, w)] + shrinkage } else { 1.0 };
    }
    Cholesky::new(shrunk).map(|factor| factor.solve(means))
}

impl Classifier for Discriminant {
    fn name(&self) -> &'static str {
        "discriminant"
    }

    fn classes(&self) -> usize {
        self.rule.constants.len()
    }

    fn bands(&self) -> usize {
        self.rule.centre.len()
    }

    fn judge(&self) -> Box<dyn Judge + '_> {
        Box::new(&self.rule)
    }
}
