//! One band between two laws p and q of the same kind: the tilted law p^{1−s}q^s and its logarithm μ(s).
//!
//! μ(s) = ln Σₙ p(n)^{1−s} q(n)^s, C(s) = −μ(s) ≥ 0, μ′ the mean and μ″ the variance of ln(q/p) under the
//! tilted law. With means N and N′ (counts), all derived here by completing the sum or the square:
//!
//! * Poisson: C = (1−s)N + sN′ − G, G = N^{1−s}N′^s; tilted Poisson of mean G, L = ln(N′/N):
//!   μ′ = GL − (N′ − N), μ″ = GL².
//! * Gaussian of variances v, v′, u = (1−s)v′ + sv, Δ = N′ − N:
//!   C = ½s(1−s)Δ²/u + ½ ln[u/(v^s v′^{1−s})], μ′ = ½Δ²[s²v − (1−s)²v′]/u² + ½[(v′ − v)/u − ln(v′/v)],
//!   μ″ = Δ²vv′/u³ + ½[(v′ − v)/u]².
//! * Negative binomial of m modes, a = N/m: C = m ln(G₁ − G₀), G₀ = a^{1−s}a′^s, G₁ = (1+a)^{1−s}(1+a′)^s;
//!   tilted law of occupancy x = G₀/(G₁ − G₀), λ = ln[a′(1+a)/(a(1+a′))]:
//!   μ′ = m[xλ − ln((1+a′)/(1+a))], μ″ = m x(1+x)λ².
//!
//! Near equality each C is a difference of nearly equal numbers. All of them are weighted arithmetic over
//! geometric means, AM/GM − 1 = (1−s)φ(−sL) + sφ((1−s)L) with φ(x) = eˣ − 1 − x ≥ 0 and L the logarithm of
//! the ratio: two positive terms, since the linear parts cancel exactly. What is left is a loss of a factor
//! 1 + a for bunched light.

use crate::error::{Error, Result, check};
use crate::statistics::Statistics;

/// Logarithms of ratios above which nothing cancels any more, and powers might overflow.
const FAR: f64 = 30.0;

/// One band.
#[derive(Debug, Clone, Copy)]
pub(in crate::limits::identifiability) enum Tilted {
    /// p and q are the same.
    Same,
    /// One of them counts nothing, ever: the supports share n = 0 only. −ln of the other's chance of it,
    /// and whether p is the dark one.
    Dark { exponent: f64, first: bool },
    /// N, N′ and L.
    Poisson { mean: f64, other: f64, log: f64 },
    /// Δ², v, v′ and ln(v′/v).
    Gaussian { square: f64, var: f64, other: f64, log: f64 },
    /// m, a, a′, ln(a′/a) and ln((1+a′)/(1+a)).
    Bunched { modes: f64, a: f64, other: f64, log: f64, log_dark: f64 },
}

/// C(s), μ′(s) and μ″(s).
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::limits::identifiability) struct Moments {
    pub(in crate::limits::identifiability) exponent: f64,
    pub(in crate::limits::identifiability) slope: f64,
    pub(in crate::limits::identifiability) variance: f64,
}

impl Tilted {
    /// The band `band` between means `mean` and `other`, counts.
    pub(super) fn new(statistics: &Statistics, band: usize, mean: f64, other: f64) -> Result<Self> {
        check::non_negative("mean count of a band", mean, "counts")?;
        check::non_negative("mean count of a band", other, "counts")?;
        let var = check::finite("variance of a band", statistics.variance(band, mean), "counts^2")?;
        let var_other = check::finite("variance of a band", statistics.variance(band, other), "counts^2")?;
        if let Statistics::Gaussian { .. } = statistics {
            check::positive("variance of a band", var.min(var_other), "counts^2")?;
        }
        if mean == other {
            return Ok(Self::Same);
        }
        let change = other - mean;
        Ok(match statistics {
            Statistics::Gaussian { .. } => {
                let square = check::finite("difference of a band, squared", change * change, "counts^2")?;
                Self::Gaussian { square, var, other: var_other, log: log_ratio(var, var_other, change) }
            }
            _ if mean == 0.0 || other == 0.0 => {
                let exponent = match statistics {
                    Statistics::NegativeBinomial { modes } => {
                        modes[band] * (mean.max(other) / modes[band]).ln_1p()
                    }
                    _ => mean.max(other),
                };
                Self::Dark { exponent, first: mean == 0.0 }
            }
            Statistics::Poisson => Self::Poisson { mean, other, log: log_ratio(mean, other, change) },
            Statistics::NegativeBinomial { modes } => {
                let modes = modes[band];
                let log = log_ratio(mean, other, change);
                let (a, other) = (mean / modes, other / modes);
                if !(a > 0.0 && other > 0.0 && a.is_finite() && other.is_finite()) {
                    return Err(Error::out_of_range(
                        "modes of a band",
                        modes,
                        "",
                        "comparable to the counts",
                    ));
                }
                let log_dark = (change / modes / (1.0 + a)).ln_1p();
                Self::Bunched { modes, a, other, log, log_dark }
            }
        })
    }

    /// C, μ′ and μ″ at s in [0, 1], by continuity at the ends.
    pub(in crate::limits::identifiability) fn at(&self, s: f64) -> Moments {
        let t = 1.0 - s;
        match *self {
            Self::Same => Moments::default(),
            Self::Dark { exponent, first } => {
                let (share, sign) = if first { (s, -1.0) } else { (t, 1.0) };
                Moments { exponent: share * exponent, slope: sign * exponent, variance: 0.0 }
            }
            Self::Poisson { mean, other, log } => {
                let geometric = geometric(mean, other, log, s);
                let exponent = if log.abs() <= FAR {
                    geometric * mean_excess(s, log)
                } else {
                    (t * mean + s * other - geometric).max(0.0)
                };
                let slope = if log.abs() <= 1.0 {
                    mean * (log * (s * log).exp_m1() - beyond_linear(log))
                } else {
                    geometric * log - (other - mean)
                };
                Moments { exponent, slope, variance: geometric * log * log }
            }
            Self::Gaussian { square, var, other, log } => {
                let u = t * other + s * var;
                let width = if log.abs() <= FAR {
                    mean_excess(t, log).ln_1p()
                } else {
                    u.ln() - s * var.ln() - t * other.ln()
                };
                let tilt = (other - var) / u;
                let skew = if log.abs() <= 1.0 {
                    let growth = log.exp_m1();
                    (beyond_linear(log) - t * log * growth) / (1.0 + t * growth)
                } else {
                    tilt - log
                };
                let lean = square / u * ((s * s * var - t * t * other) / u);
                Moments {
                    exponent: 0.5 * (s * t * square / u + width.max(0.0)),
                    slope: 0.5 * (lean + skew),
                    variance: square / u * (var / u) * (other / u) + 0.5 * tilt * tilt,
                }
            }
            Self::Bunched { modes, a, other, log, log_dark } => {
                let lit = geometric(a, other, log, s);
                let dark = geometric(1.0 + a, 1.0 + other, log_dark, s);
                let gap = if log.abs() <= FAR {
                    lit * mean_excess(s, log) - dark * mean_excess(s, log_dark)
                } else {
                    dark - lit - 1.0
                };
                let gap = gap.max(0.0);
                let (occupancy, odds) = (lit / (1.0 + gap), log - log_dark);
                Moments {
                    exponent: modes * gap.ln_1p(),
                    slope: modes * (occupancy * odds - log_dark),
                    variance: modes * occupancy * (1.0 + occupancy) * odds * odds,
                }
            }
        }
    }
}

impl Tilted {
    /// Of the events that ln(q/p) is a Poisson sum of, at s: their third absolute moment over their second. 0 for normal counts,
    /// which are no such sum.
    pub(super) fn graininess(&self, s: f64) -> f64 {
        match *self {
            Self::Same | Self::Dark { .. } | Self::Gaussian { .. } => 0.0,
            Self::Poisson { log, .. } => log.abs(),
            // Clusters of k counts, m r^k/k of them, r = x/(1 + x): Σ k²r^k/Σ kr^k = (1 + r)/(1 − r).
            Self::Bunched { a, other, log, log_dark, .. } => {
                let lit = geometric(a, other, log, s);
                let dark = geometric(1.0 + a, 1.0 + other, log_dark, s);
                (log - log_dark).abs() * (1.0 + 2.0 * lit / (dark - lit).max(1.0))
            }
        }
    }
}

/// ln(y/x) with y = x + `change`, exact near equality.
fn log_ratio(x: f64, y: f64, change: f64) -> f64 {
    let relative = change / x;
    if relative.abs() < 0.5 { relative.ln_1p() } else { y.ln() - x.ln() }
}

/// x^{1−s}y^s with ln(y/x) known.
pub(in crate::limits::identifiability) fn geometric(x: f64, y: f64, log: f64, s: f64) -> f64 {
    if log.abs() <= FAR { x * (s * log).exp() } else { ((1.0 - s) * x.ln() + s * y.ln()).exp() }
}

/// [(1−s)x + sy]/(x^{1−s}y^s) − 1 with ln(y/x) = `log`.
fn mean_excess(s: f64, log: f64) -> f64 {
    (1.0 - s) * beyond_linear(-s * log) + s * beyond_linear((1.0 - s) * log)
}

/// φ(x) = eˣ − 1 − x.
fn beyond_linear(x: f64) -> f64 {
    if x.abs() > 0.5 {
        return x.exp_m1() - x;
    }
    // x²/2!·(1 + x/3·(1 + x/4·(…))), to x¹⁸.
    0.5 * x * x * (3..=18).rev().fold(1.0, |sum, k| 1.0 + x / f64::from(k) * sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// μ′ and μ″ are the derivatives of −C: central differences, good to h²~1e-8.
    #[test]
    fn slope_and_variance_are_derivatives_of_the_exponent() {
        let laws = [
            Statistics::Poisson,
            Statistics::gaussian(vec![4.0]).unwrap(),
            Statistics::negative_binomial(vec![3.0]).unwrap(),
        ];
        for statistics in &laws {
            for (mean, other) in [(10.0, 17.0), (9.0, 0.3), (5.0, 5.5), (0.0, 3.0), (2.0, 0.0)] {
                let band = Tilted::new(statistics, 0, mean, other).unwrap();
                for s in [0.2, 0.5, 0.9] {
                    let h = 1e-4;
                    let (below, at, above) = (band.at(s - h), band.at(s), band.at(s + h));
                    let slope = -(above.exponent - below.exponent) / (2.0 * h);
                    let variance = (above.slope - below.slope) / (2.0 * h);
                    assert!((slope - at.slope).abs() < 1e-6 * (1.0 + slope.abs()), "{band:?} {s} {slope}");
                    assert!((variance - at.variance).abs() < 1e-6 * (1.0 + variance), "{band:?} {s}");
                }
            }
        }
    }

    #[test]
    fn the_remainder_of_the_exponential_meets_its_series() {
        for x in [-0.5, 0.5] {
            let (inside, outside) = (beyond_linear(x), f64::exp_m1(x) - x);
            assert!((inside / outside - 1.0).abs() < 1e-15 * 8.0, "{inside} {outside}");
        }
    }
}
