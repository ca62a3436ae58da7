//! Does an estimator reach its Cramér–Rao bound? Bias, error and variance from repeated estimates, with intervals.
//!
//! Of n estimates x of p parameters about the truth θ, C the bound of their covariance (p × p):
//!
//! * bias b = x̄ − θ with Student's interval, RMSE √⟨(x − θ)²⟩;
//! * ratio of variances s²/C_ii, and jointly r = Σ|z|²/(p(n − 1)) = tr(C⁻¹Ĉ)/p, z = C^(−½)(x − x̄) by a triangular
//!   factor; both are 1 for an estimator that reaches the bound;
//! * their interval ν r/χ²(ν) with ν degrees of freedom. For normal estimates ν = p(n − 1). Else the variance of r is
//!   [Var|z|²/n + 2p r²/(n(n − 1))]/p², and ν = 2r²/Var r, Var|z|² from the sample's fourth moments (times
//!   1 + 2/(p(n − 1)), which makes them right on average for normal estimates). For p = 1 this is ν = 2n/(κ − (n − 3)/
//!   (n − 1)), κ the kurtosis. Coverage at 95 %, measured over 3000 samples each: 93.8, 94.4 and
//!   94.7 % (normal; n = 20, 200, 1000), 87.8, 93.6 and 94.2 % (Laplace): fourth moments of few and heavy-tailed
//!   estimates come out too small.
//!
//! The verdict is about variance and bias: an estimator that is biased, or whose parameters are held within a range,
//! may err less than the bound, which does not apply to it.
//!
//! Sources: O'Neill, Am. Stat. 68, 282 (2014), doi:10.1080/00031305.2014.966589 (variance of a sample variance);
//! Satterthwaite, Biom. Bull. 2, 110 (1946), doi:10.2307/3002019 (degrees of freedom).

mod photons;
#[cfg(test)]
mod tests;
mod verdict;

pub use photons::PhotonShare;
pub use verdict::{Criteria, Verdict};

use super::sequential::Interval;
use hadar::error::{Error, Result, check};
use hadar::fisher::precision::JointBound;
use hadar::statistics::{chi_square_quantile, student_quantile};

/// Errors of repeated estimates of one quantity, in its unit.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Errors {
    /// Number of estimates that were made.
    pub estimates: usize,
    /// Their mean less the truth.
    pub bias: f64,
    /// Confidence interval of the bias, in the unit of the quantity.
    pub bias_interval: Interval,
    /// Standard deviation of the estimates, in the unit of the quantity.
    pub deviation: f64,
    /// Root of their mean squared error.
    pub rmse: f64,
    /// Confidence interval of the root mean square error, in the unit of the quantity.
    pub rmse_interval: Interval,
}

impl Errors {
    /// Errors of `estimates` of `truth`, intervals at `level`.
    ///
    /// # Errors
    /// Fewer than two estimates, anything that is not finite, or a level outside (0, 1).
    ///
    /// ```
    /// let errors = hadar_simulate::efficiency::Errors::of(&[1.0, 3.0], 1.5, 0.95)?;
    /// assert!(errors.bias == 0.5 && errors.deviation == 2f64.sqrt() && errors.rmse == 1.25f64.sqrt());
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn of(estimates: &[f64], truth: f64, level: f64) -> Result<Self> {
        Criteria { level, ..Criteria::default() }.check()?;
        let spread = Spread::of(estimates, truth)?;
        let squares: Vec<f64> = estimates.iter().map(|x| (x - truth) * (x - truth)).collect();
        let square = mean(&squares);
        let freedom = freedom(&squares, 1, 0.0);
        let of_square = around(square, freedom, level)?;
        Ok(Self {
            estimates: estimates.len(),
            bias: spread.bias,
            bias_interval: spread.bias_interval(level)?,
            deviation: spread.deviation,
            rmse: square.sqrt(),
            rmse_interval: Interval { low: of_square.low.sqrt(), high: of_square.high.sqrt() },
        })
    }
}

/// One parameter compared with its bound.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct ParameterEfficiency {
    /// Bias and errors of the estimates of this parameter.
    pub errors: Errors,
    /// Standard deviation by the bound, in the unit of the parameter.
    pub sigma_bound: f64,
    /// Variance over that of the bound.
    pub ratio: f64,
    /// Confidence interval of the ratio of the variance to the bound.
    pub ratio_interval: Interval,
    /// Degrees of freedom of the interval: n − 1 for normal estimates.
    pub freedom: f64,
    /// Whether the estimator reaches its bound, as the interval shows.
    pub verdict: Verdict,
}

/// All parameters compared with the bound of their covariance.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct JointEfficiency {
    /// Mean ratio of covariance to bound over p parameters, tr(C⁻¹Ĉ)/p.
    pub ratio: f64,
    /// Confidence interval of the mean ratio.
    pub ratio_interval: Interval,
    /// Degrees of freedom of the interval: p(n − 1) for normal estimates.
    pub freedom: f64,
    /// √(bᵀC⁻¹b): length of the bias in deviations of the bound.
    pub bias_length: f64,
    /// What follows; biased where any parameter is.
    pub verdict: Verdict,
}

/// The report on an estimator.
///
/// ```
/// use hadar::fisher::precision::JointBound;
/// use hadar_simulate::draws::generator;
/// use hadar_simulate::efficiency::{Criteria, Efficiency, Verdict};
/// use rand_distr::{Distribution, StandardNormal};
/// let mut rng = generator(1, 0);
/// let mut mean_of_four = || (0..4).map(|_| -> f64 { StandardNormal.sample(&mut rng) }).sum::<f64>() / 4.0;
/// let estimates: Vec<f64> = (0..4000).map(|_| mean_of_four()).collect();
/// let report = Efficiency::of(&estimates, &[0.0], &JointBound::from_sigma(0.5)?, &Criteria::default())?;
/// assert_eq!(report.parameters[0].verdict, Verdict::Reaches);
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Efficiency {
    /// Each parameter compared with its own bound.
    pub parameters: Vec<ParameterEfficiency>,
    /// All parameters together, compared with the bound of their covariance.
    pub joint: JointEfficiency,
    /// What the verdicts rest on.
    pub criteria: Criteria,
}

impl Efficiency {
    /// Holds estimates, p after p for each trial, against the bound of their covariance.
    ///
    /// # Errors
    /// Lists whose lengths do not fit together, fewer than two trials, anything that is not finite, criteria that
    /// are none.
    pub fn of(estimates: &[f64], truth: &[f64], bound: &JointBound, criteria: &Criteria) -> Result<Self> {
        criteria.check()?;
        let p = bound.parameters();
        if truth.len() != p {
            let what = "true values of the parameters".into();
            return Err(Error::Length { what, found: truth.len(), expected: p });
        }
        if !estimates.len().is_multiple_of(p) {
            let (found, expected) = (estimates.len(), estimates.len().next_multiple_of(p));
            return Err(Error::Length { what: "estimates, p for each trial".into(), found, expected });
        }
        let (level, verdicts) = (criteria.level, criteria.level_of_verdicts());
        let mut parameters = Vec::with_capacity(p);
        let mut biases = Vec::with_capacity(p);
        for (i, &truth) in truth.iter().enumerate() {
            let own: Vec<f64> = estimates.iter().skip(i).step_by(p).copied().collect();
            let (errors, spread, sigma) =
                (Errors::of(&own, truth, level)?, Spread::of(&own, truth)?, bound.sigma(i));
            let squares: Vec<f64> = spread.off.iter().map(|d| (d / sigma) * (d / sigma)).collect();
            let found = Ratio::of(&squares, 1);
            let bias = spread.bias_interval(verdicts)?;
            let bias = Interval { low: bias.low / sigma, high: bias.high / sigma };
            parameters.push(ParameterEfficiency {
                errors,
                sigma_bound: sigma,
                ratio: found.ratio,
                ratio_interval: found.interval(level)?,
                freedom: found.freedom,
                verdict: Verdict::of(found.interval(verdicts)?, bias, criteria),
            });
            biases.push(errors.bias);
        }
        let centre: Vec<f64> = truth.iter().zip(&biases).map(|(truth, bias)| truth + bias).collect();
        let length = |x: &[f64]| bound.whitened(x).iter().map(|z| z * z).sum::<f64>();
        let squares: Vec<f64> = (estimates.chunks_exact(p))
            .map(|x| length(&x.iter().zip(&centre).map(|(x, mean)| x - mean).collect::<Vec<f64>>()))
            .collect();
        let found = Ratio::of(&squares, p);
        let biased = parameters.iter().any(|one| one.verdict == Verdict::Biased);
        let unknown = parameters.iter().any(|one| one.verdict == Verdict::Undecided);
        let unbiased = Interval { low: 0.0, high: 0.0 };
        let verdict = match Verdict::of(found.interval(verdicts)?, unbiased, criteria) {
            Verdict::Reaches if biased => Verdict::Biased,
            Verdict::Reaches if unknown => Verdict::Undecided,
            other => other,
        };
        let joint = JointEfficiency {
            ratio: found.ratio,
            ratio_interval: found.interval(level)?,
            freedom: found.freedom,
            bias_length: length(&biases).sqrt(),
            verdict,
        };
        Ok(Self { parameters, joint, criteria: *criteria })
    }
}

/// Estimates about their own mean.
struct Spread {
    bias: f64,
    deviation: f64,
    off: Vec<f64>,
}

impl Spread {
    fn of(estimates: &[f64], truth: f64) -> Result<Self> {
        check::finite("true value", truth, "")?;
        if estimates.len() < 2 {
            let n = estimates.len() as f64;
            return Err(Error::out_of_range("number of estimates", n, "", "at least 2"));
        }
        estimates.iter().try_for_each(|&x| check::finite("estimate", x, "").map(drop))?;
        // Differences from the truth first: they are small beside it.
        let errors: Vec<f64> = estimates.iter().map(|x| x - truth).collect();
        let bias = mean(&errors);
        let off: Vec<f64> = errors.iter().map(|x| x - bias).collect();
        let square = hadar::sum::dot(&off, &off) / (off.len() - 1) as f64;
        Ok(Self { bias, deviation: square.sqrt(), off })
    }

    fn bias_interval(&self, level: f64) -> Result<Interval> {
        let n = self.off.len() as f64;
        let reach = student_quantile(0.5 * (1.0 + level), n - 1.0)? * self.deviation / n.sqrt();
        Ok(Interval { low: self.bias - reach, high: self.bias + reach })
    }
}

/// Σ|z|²/(p(n − 1)) and its degrees of freedom.
struct Ratio {
    ratio: f64,
    freedom: f64,
}

impl Ratio {
    fn of(squares: &[f64], p: usize) -> Self {
        let n = squares.len() as f64;
        Self { ratio: mean(squares) * n / (n - 1.0) / p as f64, freedom: freedom(squares, p, 1.0) }
    }

    fn interval(&self, level: f64) -> Result<Interval> {
        around(self.ratio, self.freedom, level)
    }
}

/// 2⟨q⟩²/Var⟨q⟩ for squares q of p normal-like parts, from whose mean `fitted` degrees (of each part) are taken off.
fn freedom(squares: &[f64], p: usize, fitted: f64) -> f64 {
    let (n, p) = (squares.len() as f64, p as f64);
    let average = mean(squares);
    if average <= 0.0 {
        return p * (n - fitted);
    }
    let relative: Vec<f64> = squares.iter().map(|q| q / average).collect();
    // ⟨q²⟩/⟨q⟩² is 1 + 2/p for normal parts; of a sample it comes out pm/(pm + 2) of that.
    let m = p * (n - fitted);
    let fourth = mean(&relative.iter().map(|q| q * q).collect::<Vec<f64>>()) * ((m + 2.0) / m);
    let variance = (fourth - 1.0).max(0.0) / n + fitted * 2.0 / (p * n * (n - 1.0));
    if variance > 0.0 { 2.0 / variance } else { p * (n - fitted) }
}

/// All means of a χ² variate over its degrees of freedom that `value` may be drawn about.
fn around(value: f64, freedom: f64, level: f64) -> Result<Interval> {
    let tail = 0.5 * (1.0 - level);
    Ok(Interval {
        low: value / chi_square_quantile(1.0 - tail, freedom)?,
        high: value / chi_square_quantile(tail, freedom)?,
    })
}

fn mean(values: &[f64]) -> f64 {
    hadar::sum::sum(values) / values.len() as f64
}
