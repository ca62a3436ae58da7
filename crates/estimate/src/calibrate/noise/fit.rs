//! A line through variances over means, with errors by a jackknife.

/// 97.5 % quantile of Student's t of 31 degrees of freedom.
const T_975: f64 = 2.0395;
/// Rounds of weights.
const ROUNDS: usize = 8;

/// A bin: mean, variance of the noise, texture taken out of it, and degrees of freedom.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bin {
    pub(super) mean: f64,
    pub(super) variance: f64,
    pub(super) texture: f64,
    pub(super) weight: f64,
}

/// var = electronic + per_photon·m + spread·m², each with its standard error.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Line {
    /// Variance of the electronic noise a, unit² of the cube.
    pub electronic: f64,
    /// Standard error of the electronic variance a, unit² of the cube.
    pub sigma_electronic: f64,
    /// What one photon is in the unit of the cube: b.
    pub per_photon: f64,
    /// Standard error of b, unit of the cube per photon.
    pub sigma_per_photon: f64,
    /// Relative variance of gains c; 0 where it is not fitted.
    pub spread: f64,
    /// Standard error of the relative variance c of the gains.
    pub sigma_spread: f64,
    /// Correlation of the errors of a and b.
    pub correlation: f64,
    /// Standard error of √a/b, which the errors of a and b have together; infinite where a is not above 0.
    pub sigma_noise_electrons: f64,
}

impl Line {
    /// The variance at a mean.
    #[must_use]
    pub fn variance(&self, mean: f64) -> f64 {
        self.electronic + (self.per_photon + self.spread * mean) * mean
    }

    /// Deviation of the electronic noise in photons, √a/b; 0 where a is not above 0.
    #[must_use]
    pub fn noise_electrons(&self) -> f64 {
        self.electronic.max(0.0).sqrt() / self.per_photon
    }

    /// Ends of the interval that holds a value with 95 %, given its standard error.
    #[must_use]
    pub fn interval(value: f64, sigma: f64) -> [f64; 2] {
        [value - T_975 * sigma, value + T_975 * sigma]
    }

    /// Ends of the interval of √a/b, cut at 0, as errors of a and b go together.
    #[must_use]
    pub fn noise_electrons_interval(&self) -> [f64; 2] {
        // √a has no error of its own near a = 0: the interval of a/b² is taken, and its root.
        let (a, b) = (self.electronic, self.per_photon);
        let (da, db) = (self.sigma_electronic / (b * b), 2.0 * a * self.sigma_per_photon / (b * b * b));
        let sigma = (da * da + db * db - 2.0 * self.correlation * da * db).max(0.0).sqrt();
        Self::interval(a / (b * b), sigma).map(|square| square.max(0.0).sqrt())
    }
}

/// Standard error of a value by what it is without each group.
pub(super) fn jackknife(others: &[f64]) -> f64 {
    covariance(others, others).sqrt()
}

fn covariance(one: &[f64], other: &[f64]) -> f64 {
    let count = one.len() as f64;
    let mean = |of: &[f64]| of.iter().sum::<f64>() / count;
    let (a, b) = (mean(one), mean(other));
    one.iter().zip(other).map(|(x, y)| (x - a) * (y - b)).sum::<f64>() * (count - 1.0) / count
}

/// Why there is no line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum NoLine {
    /// So many bins, and so many that are needed.
    Bins(usize, usize),
    /// The variance that is left when texture is taken out is not above 0.
    AllTexture,
    /// Deviation of the means, and of their noise: they do not differ by more than that.
    OneLevel([f64; 2]),
}

/// Solutions of the whole, the first of the sets, and of everything without a group, the others.
pub(super) fn replicated(sets: &[Vec<Bin>], averaged: f64, spread: bool) -> Result<Vec<[f64; 3]>, NoLine> {
    sets.iter().map(|bins| solved(bins, averaged, spread)).collect()
}

/// The line of the whole with the errors that the others show.
pub(super) fn line(solutions: &[[f64; 3]]) -> Option<Line> {
    let ([a, b, c], others) = solutions.split_first()?;
    let [a, b, c] = [*a, *b, *c];
    let column = |of: usize| others.iter().map(|x| x[of]).collect::<Vec<f64>>();
    let [one, two, three] = [0, 1, 2].map(column);
    let [sigma_a, sigma_b] = [jackknife(&one), jackknife(&two)];
    let electrons: Vec<f64> = others.iter().map(|x| x[0].max(0.0).sqrt() / x[1]).collect();
    Some(Line {
        electronic: a,
        sigma_electronic: sigma_a,
        per_photon: b,
        sigma_per_photon: sigma_b,
        spread: c,
        sigma_spread: jackknife(&three),
        correlation: covariance(&one, &two) / (sigma_a * sigma_b).max(f64::MIN_POSITIVE),
        sigma_noise_electrons: if a > 0.0 { jackknife(&electrons) } else { f64::INFINITY },
    })
}

/// Weighted least squares, weights by the line itself; a straight one with the noise of the means taken out.
fn solved(bins: &[Bin], averaged: f64, spread: bool) -> Result<[f64; 3], NoLine> {
    let terms = if spread { 3 } else { 2 };
    if bins.len() < terms {
        return Err(NoLine::Bins(bins.len(), terms));
    }
    let total: f64 = bins.iter().map(|bin| bin.weight).sum();
    let of =
        |value: &dyn Fn(&Bin) -> f64| bins.iter().map(|bin| bin.weight * value(bin)).sum::<f64>() / total;
    let (m0, v0) = (of(&|bin| bin.mean), of(&|bin| bin.variance));
    let scale = of(&|bin| (bin.mean - m0).powi(2)).sqrt();
    let one_level = NoLine::OneLevel([scale, (v0 / averaged).max(0.0).sqrt()]);
    if !(v0 > 0.0 && v0.is_finite()) {
        return Err(NoLine::AllTexture);
    }
    if scale.is_nan() || scale <= 0.0 {
        return Err(one_level);
    }
    // About the middle, in units of the spread of the means and of the mean variance.
    let mut x = [1.0, 0.0, 0.0];
    for _ in 0..ROUNDS {
        let (mut normal, mut right) = ([[0.0; 3]; 3], [0.0; 3]);
        let slope = x[1] * v0 / scale;
        for bin in bins {
            let u = (bin.mean - m0) / scale;
            let model = (x[0] + x[1] * u + x[2] * u * u).max(0.05);
            let weight = bin.weight / (model * model);
            let powers = [1.0, u, u * u];
            for i in 0..terms {
                for j in 0..terms {
                    normal[i][j] += weight * powers[i] * powers[j];
                }
                right[i] += weight * powers[i] * bin.variance / v0;
            }
            if !spread {
                let noise = bin.variance / averaged / (scale * scale);
                let skewness = slope * slope * bin.mean.max(0.0) / averaged / (scale * v0);
                normal[1][1] -= weight * noise;
                right[1] -= weight * skewness;
            }
        }
        x = cholesky(&normal, &right, terms).ok_or(one_level)?;
    }
    let (a, b, c) = (x[0] * v0, x[1] * v0 / scale, x[2] * v0 / (scale * scale));
    Ok([a - b * m0 + c * m0 * m0, b - 2.0 * c * m0, c])
}

/// Solves a symmetric positive system of up to three unknowns, or none where a column hardly differs from the others. nalgebra's Cholesky factor
/// takes any positive pivot and 67 ns (41 ns here for two unknowns); of three, half the solutions differ from it in the last digits.
fn cholesky(normal: &[[f64; 3]; 3], right: &[f64; 3], terms: usize) -> Option<[f64; 3]> {
    let mut low = [[0.0; 3]; 3];
    for i in 0..terms {
        for j in 0..=i {
            let rest = normal[i][j] - (0..j).map(|k| low[i][k] * low[j][k]).sum::<f64>();
            if i == j {
                // Columns have a scale of 1: less than this of one is rounding.
                if !(rest > 1e-9 * normal[i][i] && rest.is_finite()) {
                    return None;
                }
                low[i][i] = rest.sqrt();
            } else {
                low[i][j] = rest / low[j][j];
            }
        }
    }
    let mut x = *right;
    for i in 0..terms {
        x[i] = (x[i] - (0..i).map(|k| low[i][k] * x[k]).sum::<f64>()) / low[i][i];
    }
    for i in (0..terms).rev() {
        x[i] = (x[i] - (i + 1..terms).map(|k| low[k][i] * x[k]).sum::<f64>()) / low[i][i];
    }
    x[terms..].fill(0.0);
    Some(x)
}
