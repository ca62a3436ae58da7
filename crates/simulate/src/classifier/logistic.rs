//! Logistic regression: the logarithm of the odds between classes as a linear function of the counts.
//!
//! ln P(c|x) = b_c + w_cᵀx − ln Σ_k exp(b_k + w_kᵀx), x the counts in units of each band's deviation; the first class
//! has b = w = 0. Minimised is the mean of −ln P of the right class over the training spectra: a convex function whose
//! curvature is at most ½λ_max, λ_max the largest eigenvalue of XXᵀ/n (¼ for two classes), which makes 1 over it
//! a safe step, of which a part is taken. Nesterov's accelerated descent starts at 0; the weights that are best on the validation part are
//! kept, and training ends when they have not improved for a while: stopping early is what keeps many bands from
//! being learnt by heart.
//!
//! Sources: Cox, J. R. Stat. Soc. B 20, 215 (1958); Böhning, Ann. Inst. Stat. Math. 44, 197 (1992),
//! doi:10.1007/BF00048682 (bound of the curvature); Nesterov, Sov. Math. Dokl. 27, 372 (1983).

use super::affine::{Affine, Scale};
use super::{Classifier, Judge, check_parts};
use crate::spectra::LabelledSpectra;
use hadar::error::{Error, Result};
use nalgebra::{DMatrix, DVector};

/// Most steps, and steps without gain on the validation part after which training ends.
const STEPS: usize = 1000;
const PATIENCE: usize = 40;
/// Share of the safe step that is taken: where many bands tell little, the best weights are a small part of the first
/// full step, which would miss them.
const CAUTION: f64 = 0.05;
/// Iterations of the power method for the largest eigenvalue, and by how much its result may fall short.
const POWER: usize = 30;
const MARGIN: f64 = 1.2;

/// Logistic regression, trained.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(try_from = "Raw")]
pub struct Logistic {
    /// Steps after which the weights were best.
    steps: usize,
    /// Mean −ln P on the validation part there.
    validation_loss: f64,
    rule: Affine,
}

#[derive(serde::Deserialize)]
struct Raw {
    steps: usize,
    validation_loss: f64,
    rule: Affine,
}

impl TryFrom<Raw> for Logistic {
    type Error = Error;

    fn try_from(raw: Raw) -> Result<Self> {
        let Raw { steps, validation_loss, rule } = raw;
        Ok(Self { steps, validation_loss, rule: rule.checked()? })
    }
}

impl Logistic {
    /// Trains on `training` until `validation` improves no more.
    ///
    /// # Errors
    /// Parts of other bands or classes, a class without spectra.
    pub fn train(training: &LabelledSpectra, validation: &LabelledSpectra) -> Result<Self> {
        check_parts(training, validation)?;
        let scale = Scale::of(training)?;
        let others = training.classes() - 1;
        let (x, x_validation) = (with_ones(scale.apply(training)), with_ones(scale.apply(validation)));
        let curvature = if others == 1 { 0.25 } else { 0.5 };
        let step = CAUTION / (curvature * MARGIN * largest_eigenvalue(&x));
        let mut weights = DMatrix::<f64>::zeros(x.nrows(), others);
        let (mut ahead, mut best) = (weights.clone(), weights.clone());
        let (mut best_loss, mut best_step, mut momentum) = (f64::INFINITY, 0, 1.0_f64);
        for done in 0..STEPS {
            hadar::stop::check();
            let (loss, _) = loss(&x_validation, validation.labels(), &weights);
            if loss < best_loss {
                (best_loss, best_step) = (loss, done);
                best.copy_from(&weights);
            } else if done >= best_step + PATIENCE {
                break;
            }
            let (_, pull) = self::loss(&x, training.labels(), &ahead);
            let next = &ahead - (&x * pull) * step;
            let following = 0.5 * (1.0 + (4.0 * momentum).mul_add(momentum, 1.0).sqrt());
            ahead = &next + (&next - &weights) * ((momentum - 1.0) / following);
            (weights, momentum) = (next, following);
        }
        let bands = x.nrows() - 1;
        let mut all = DMatrix::zeros(bands, others + 1);
        all.columns_mut(1, others).copy_from(&best.rows(0, bands));
        let constants = std::iter::once(0.0).chain(best.row(bands).iter().copied()).collect();
        Ok(Self { steps: best_step, validation_loss: best_loss, rule: scale.rule(&all, constants)? })
    }

    /// Steps after which the weights were best on the validation part.
    #[must_use]
    pub fn steps(&self) -> usize {
        self.steps
    }

    /// Mean −ln P of the right class on the validation part.
    #[must_use]
    pub fn validation_loss(&self) -> f64 {
        self.validation_loss
    }
}

/// A last row of ones, whose weights are the constants.
fn with_ones(x: DMatrix<f64>) -> DMatrix<f64> {
    let bands = x.nrows();
    x.insert_row(bands, 1.0)
}

/// Largest eigenvalue of XXᵀ/n, from below.
fn largest_eigenvalue(x: &DMatrix<f64>) -> f64 {
    let n = x.ncols().max(1) as f64;
    let mut direction = DVector::from_fn(x.nrows(), |i, _| 1.0 + 0.1 * (i as f64).sin());
    let mut value = 1.0;
    for _ in 0..POWER {
        hadar::stop::check();
        direction.unscale_mut(direction.norm().max(f64::MIN_POSITIVE));
        direction = x * x.tr_mul(&direction) / n;
        value = direction.norm();
    }
    // The row of ones alone has 1.
    value.max(1.0)
}

/// Mean −ln P of the right class, and its derivative by the scores of every class but the first, over n.
fn loss(x: &DMatrix<f64>, labels: &[usize], weights: &DMatrix<f64>) -> (f64, DMatrix<f64>) {
    let n = labels.len().max(1) as f64;
    let mut pull = x.tr_mul(weights);
    let mut sum = 0.0;
    for (mut scores, &label) in pull.row_iter_mut().zip(labels) {
        // Scores are counted from the largest, so that no exponential overflows.
        let largest = scores.iter().copied().fold(0.0, f64::max);
        let right = label.checked_sub(1).map_or(0.0, |c| scores[c]);
        let total = scores.iter().map(|s| (s - largest).exp()).sum::<f64>() + (-largest).exp();
        sum += total.ln() + largest - right;
        for (c, score) in scores.iter_mut().enumerate() {
            let is_right = if c + 1 == label { 1.0 } else { 0.0 };
            *score = ((*score - largest).exp() / total - is_right) / n;
        }
    }
    (sum / n, pull)
}

impl Classifier for Logistic {
    fn name(&self) -> &'static str {
        "logistic"
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
