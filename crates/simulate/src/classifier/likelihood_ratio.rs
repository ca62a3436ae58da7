//! The likelihood ratio of known states: no test is right more often on average, if counts follow its law.
//!
//! ln L_c = Σ_w ln P(n_w; N_cw) for class c of mean counts N_cw, without terms that all classes share. With M_w the mean
//! of N_cw over the classes, taken off so that nothing large cancels:
//!
//! * Poisson: Σ [(n − M) a + M (a − δ)], a = ln(N_c/M), δ = N_c/M − 1; one product per band and class;
//! * negative binomial of m modes: the same with a = ln(N_c/M) − ln[(m + N_c)/(m + M)], and
//!   −m ln[(m + N_c)/(m + M)] instead of −(N_c − M);
//! * Gaussian: −½Σ [(n − N_c)²/v_c + ln v_c], v_c = N_c + σ²_w.
//!
//! Symbols: n counts, N mean counts, σ² variance of the electronic noise (counts²), m modes. Weights of a band
//! in which a class counts nothing, ever, are finite but so large that one count excludes the class.
//!
//! Source: Neyman and Pearson, Phil. Trans. R. Soc. A 231, 289 (1933), doi:10.1098/rsta.1933.0009.

use super::affine::Affine;
use super::{Classifier, Judge};
use hadar::error::{Error, Result, check};
use hadar::statistics::Statistics;

/// Weight of a count that a class cannot have.
const EXCLUDES: f64 = -1e280;

/// The likelihood ratio between classes of known mean counts.
///
/// ```
/// use hadar_simulate::classifier::{Classifier, LikelihoodRatio};
/// use hadar::statistics::Statistics;
/// let rule = LikelihoodRatio::new(&Statistics::Poisson, &[vec![100.0, 50.0], vec![144.0, 50.0]])?;
/// let mut scores = [0.0; 2];
/// rule.judge().score(&[150.0, 50.0], &mut scores);
/// // 150 ln(144/100) − 44
/// assert!((scores[1] - scores[0] - 10.6965).abs() < 1e-4);
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct LikelihoodRatio {
    bands: usize,
    scores: Scores,
}

/// ln-likelihoods as functions of the counts.
#[derive(Debug, Clone)]
enum Scores {
    Linear(Affine),
    /// Of each class: −½Σ ln v, and N and −½/v of each band.
    Square(Vec<(f64, Vec<(f64, f64)>)>),
}

impl LikelihoodRatio {
    /// Classes with these mean counts in every band.
    ///
    /// # Errors
    /// No classes, a class of another number of bands, means that are negative or not finite; a Gaussian band
    /// without any variance.
    pub fn new(statistics: &Statistics, means: &[Vec<f64>]) -> Result<Self> {
        let Some(first) = means.first() else {
            return Err(Error::malformed(
                "there are no classes to distinguish",
                "give the mean counts of two",
            ));
        };
        let bands = first.len();
        statistics.check_bands(bands)?;
        for class in means {
            if class.len() != bands {
                let what = "bands of a class".into();
                return Err(Error::Length { what, found: class.len(), expected: bands });
            }
            for &mean in class {
                check::non_negative("mean counts of a band", mean, "counts")?;
            }
        }
        let scores = match statistics {
            Statistics::Gaussian { .. } => {
                Scores::Square(means.iter().map(|class| square(statistics, class)).collect::<Result<_>>()?)
            }
            Statistics::Poisson | Statistics::NegativeBinomial { .. } => {
                Scores::Linear(linear(statistics, means, bands))
            }
        };
        Ok(Self { bands, scores })
    }
}

/// Normal counts of one class.
fn square(statistics: &Statistics, means: &[f64]) -> Result<(f64, Vec<(f64, f64)>)> {
    let mut constant = 0.0;
    let band = |(band, &mean): (usize, &f64)| {
        let var = check::positive("variance of a band", statistics.variance(band, mean), "counts^2")?;
        constant -= 0.5 * var.ln();
        Ok((mean, -0.5 / var))
    };
    let bands = means.iter().enumerate().map(band).collect::<Result<_>>()?;
    Ok((constant, bands))
}

/// Photons that are counted one by one: weights, and what the centre of the counts leaves.
fn linear(statistics: &Statistics, means: &[Vec<f64>], bands: usize) -> Affine {
    let classes = means.len();
    let mut affine = Affine {
        centre: vec![0.0; bands],
        weights: vec![vec![0.0; bands]; classes],
        constants: vec![0.0; classes],
    };
    for band in 0..bands {
        let middle = means.iter().map(|class| class[band]).sum::<f64>() / classes as f64;
        if middle == 0.0 {
            continue;
        }
        let dark = means.iter().any(|class| class[band] == 0.0);
        affine.centre[band] = if dark { 0.0 } else { middle };
        for (c, class) in means.iter().enumerate() {
            let mean = class[band];
            // ln[(m + N)/(m + M)], and m times it; their limits for many modes are 0 and N − M.
            let (dark_log, none) = match statistics {
                Statistics::NegativeBinomial { modes } => {
                    let m = modes[band];
                    let log = ((mean - middle) / (m + middle)).ln_1p();
                    (log, m * log)
                }
                Statistics::Poisson | Statistics::Gaussian { .. } => (0.0, mean - middle),
            };
            let ratio = ((mean - middle) / middle).ln_1p();
            let weight = if mean == 0.0 { EXCLUDES } else { ratio - dark_log };
            affine.weights[c][band] = weight;
            affine.constants[c] += if dark { -none } else { middle.mul_add(weight, -none) };
        }
    }
    affine
}

impl Classifier for LikelihoodRatio {
    fn name(&self) -> &'static str {
        "likelihood-ratio"
    }

    fn classes(&self) -> usize {
        match &self.scores {
            Scores::Linear(affine) => affine.constants.len(),
            Scores::Square(classes) => classes.len(),
        }
    }

    fn bands(&self) -> usize {
        self.bands
    }

    fn judge(&self) -> Box<dyn Judge + '_> {
        match &self.scores {
            Scores::Linear(affine) => Box::new(affine),
            Scores::Square(classes) => Box::new(Normal(classes)),
        }
    }
}

/// Scores of normal counts.
struct Normal<'r>(&'r [(f64, Vec<(f64, f64)>)]);

impl Judge for Normal<'_> {
    fn score(&mut self, counts: &[f64], scores: &mut [f64]) -> bool {
        for (score, (constant, bands)) in scores.iter_mut().zip(self.0) {
            let square = counts.iter().zip(bands).map(|(n, (mean, weight))| (n - mean).powi(2) * weight);
            *score = constant + square.sum::<f64>();
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Differences of scores are those of the log-likelihoods, whose terms are summed one by one here.
    #[test]
    fn scores_are_log_likelihoods() {
        let means = vec![vec![3.0, 1e4, 0.5], vec![5.0, 1.01e4, 0.4], vec![2.0, 0.98e4, 0.9]];
        let counts = [4.0, 10_050.0, 1.0];
        for statistics in [
            Statistics::Poisson,
            Statistics::negative_binomial(vec![0.5, 1e5, 3.0]).unwrap(),
            Statistics::gaussian(vec![2.0, 0.0, 7.0]).unwrap(),
        ] {
            let rule = LikelihoodRatio::new(&statistics, &means).unwrap();
            let mut scores = [0.0; 3];
            assert!(rule.judge().score(&counts, &mut scores));
            let exact: Vec<f64> = means
                .iter()
                .map(|means| (0..3).map(|w| statistics.log_likelihood(w, counts[w], means[w])).sum())
                .collect();
            for c in 1..3 {
                let (found, expected) = (scores[c] - scores[0], exact[c] - exact[0]);
                // n ln N loses eleven of the sixteen digits in its difference.
                assert!(
                    (found - expected).abs() < 1e-9 * exact[0].abs(),
                    "{} {found} {expected}",
                    statistics.name()
                );
            }
        }
    }

    /// 1e15 photons, classes 1e-8 apart: n ln N alone would have lost all digits. (n − N)²/N differs by 2·δ·(n − N).
    #[test]
    fn nearly_equal_classes_keep_their_digits() {
        let (mean, off) = (1e15_f64, 1e7_f64);
        let rule = LikelihoodRatio::new(&Statistics::Poisson, &[vec![mean], vec![mean + off]]).unwrap();
        let mut scores = [0.0; 2];
        rule.judge().score(&[mean + 3e7], &mut scores);
        let expected = (3e7 * off - 0.5 * off * off) / mean;
        assert!(((scores[1] - scores[0]) / expected - 1.0).abs() < 1e-6, "{scores:?} {expected}");
    }

    /// A count where a class has none excludes it; none there does not.
    #[test]
    fn a_dark_band_excludes() {
        let rule =
            LikelihoodRatio::new(&Statistics::Poisson, &[vec![0.0, 9.0], vec![2.0, 9.0], vec![0.0, 8.0]])
                .unwrap();
        let mut scores = [0.0; 3];
        rule.judge().score(&[1.0, 9.0], &mut scores);
        assert!(scores[1] > scores[0] && scores[1] > scores[2], "{scores:?}");
        rule.judge().score(&[0.0, 9.0], &mut scores);
        assert!((scores[0] - scores[1] - 2.0).abs() < 1e-12, "{scores:?}");
    }

    #[test]
    fn impossible_classes_are_refused() {
        assert!(LikelihoodRatio::new(&Statistics::Poisson, &[]).is_err());
        assert!(LikelihoodRatio::new(&Statistics::Poisson, &[vec![1.0], vec![1.0, 2.0]]).is_err());
        assert!(LikelihoodRatio::new(&Statistics::Poisson, &[vec![1.0], vec![f64::NAN]]).is_err());
        let silent = Statistics::gaussian(vec![0.0]).unwrap();
        assert!(LikelihoodRatio::new(&silent, &[vec![0.0], vec![1.0]]).is_err());
    }
}
