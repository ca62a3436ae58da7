//! One pair made ready: well-scaled rows of which selections are made, and their least-squares fits.
//!
//! The nuisance columns are orthogonalised over all bands and scaled to length 1, and the difference is replaced
//! by what they leave of it: the distance of no subset changes by that, and over all bands the fit is trivial.
//! A selection's distance is d² = ¼ min_c Σ (r − c·q)² over its rows (q, r), one for each band or filter, and
//! one for each prior, which is always there. Last column scaled by ½ over the required distance, so that the
//! sums of squares here are (d/required)².
//!
//! Searches use the normal equations of these scaled columns, which are good to some eight digits or more;
//! any c whatever gives a valid bound, and distances that are reported come from orthogonalised rows.

use super::scores::Scores;
use crate::fisher::Projector;
use std::ops::Range;

/// Added to the diagonal of the normal equations, whose columns have length 1 over all bands.
const RIDGE: f64 = 1e-15;

/// Rows of one pair of materials.
#[derive(Debug, Clone)]
pub(super) struct Pair {
    /// Columns: nuisances that matter, and the difference.
    width: usize,
    /// Nuisances without priors: as many rows tell nothing.
    free: usize,
    /// One row per band, in units of the noise.
    rows: Vec<f64>,
    /// One row per prior.
    priors: Vec<f64>,
    /// Rows before they are divided by the noise, and their sums up to each band.
    plain: Vec<f64>,
    sums: Vec<f64>,
    /// Variance of each band that comes with photons and that of a reading, and their sums up to each band.
    variance: Vec<[f64; 2]>,
    variance_sums: Vec<[f64; 2]>,
    whole: f64,
}

impl Pair {
    pub(super) fn new(scores: &Scores) -> Self {
        let (bands, priors) = (scores.bands(), scores.priors.len());
        let variance: Vec<[f64; 2]> =
            scores.var_photons.iter().zip(&scores.var_reading).map(|(n, s)| [*n, *s]).collect();
        let mut weights: Vec<f64> = variance.iter().map(|v| reciprocal(v[0] + v[1])).collect();
        weights.resize(bands + priors, 1.0);
        let mut columns = Vec::with_capacity(scores.columns.len() * weights.len());
        for (i, column) in scores.columns.iter().enumerate() {
            columns.extend_from_slice(column);
            columns.extend(scores.priors.iter().map(|p| if p.0 == i { 1.0 / p.1 } else { 0.0 }));
        }
        let found = Projector::default().project(&mut columns, &weights, scores.cancellation);
        let distinct = found.residual > 0.0 && found.relative_error < 1.0;

        let last = scores.columns.len().saturating_sub(1);
        let live: Vec<usize> = (0..last).filter(|i| !found.dropped.contains(i)).collect();
        let free = live.iter().filter(|i| scores.priors.iter().all(|prior| prior.0 != **i)).count();
        let column = |i: usize| &columns[i * weights.len()..(i + 1) * weights.len()];
        let length = |i: usize| {
            let squares = column(i).iter().zip(&weights).map(|(x, u)| u * x * x);
            squares.sum::<f64>().sqrt()
        };
        let mut factors: Vec<f64> = live.iter().map(|&i| reciprocal(length(i))).collect();
        factors.push(if distinct { 0.5 / scores.required } else { 0.0 });
        let width = factors.len();
        let mut plain = Vec::with_capacity(weights.len() * width);
        for w in 0..weights.len() {
            let entries = live.iter().chain([&last]).zip(&factors);
            plain.extend(entries.map(|(&i, factor)| factor * column(i)[w]));
        }
        let prior_rows = plain.split_off(bands * width);
        let rows = plain
            .chunks(width)
            .zip(&weights)
            .flat_map(|(row, u)| row.iter().map(move |x| x * u.sqrt()))
            .collect();
        let mut sums = vec![0.0; width];
        for row in plain.chunks(width) {
            let start = sums.len() - width;
            sums.extend_from_within(start..);
            sums[start + width..].iter_mut().zip(row).for_each(|(sum, x)| *sum += x);
        }
        let mut variance_sums = vec![[0.0; 2]];
        let mut running = [0.0; 2];
        for v in &variance {
            running = [running[0] + v[0], running[1] + v[1]];
            variance_sums.push(running);
        }
        let whole = if distinct { 0.5 * found.residual / scores.required } else { 0.0 };
        Self { width, free, rows, priors: prior_rows, plain, sums, variance, variance_sums, whole }
    }

    /// Number of bands.
    pub(super) fn bands(&self) -> usize {
        self.variance.len()
    }

    /// Number of columns, the difference among them.
    pub(super) fn width(&self) -> usize {
        self.width
    }

    /// Fewest rows that may tell something.
    pub(super) fn needed(&self) -> usize {
        self.free + 1
    }

    /// Distance over requirement in all bands.
    pub(super) fn whole(&self) -> f64 {
        self.whole
    }

    /// The row of one band.
    pub(super) fn row(&self, band: usize) -> &[f64] {
        &self.rows[band * self.width..(band + 1) * self.width]
    }

    /// All rows, band after band.
    pub(super) fn rows(&self) -> &[f64] {
        &self.rows
    }

    /// The row of a filter that sums the counts of its bands and reads them once, with the noise of a
    /// reading that its bands have on average.
    fn filter_row(&self, filter: &Range<usize>, out: &mut [f64]) {
        let (from, to) = (filter.start * self.width, filter.end * self.width);
        let (low, high) = (self.variance_sums[filter.start], self.variance_sums[filter.end]);
        let scale = noise(high, low, filter.len()).sqrt();
        for (i, out) in out.iter_mut().enumerate() {
            *out = scale * (self.sums[to + i] - self.sums[from + i]);
        }
    }

    /// As [`Pair::filter_row`], added anew instead of from differences of sums.
    fn exact_row(&self, filter: &Range<usize>, out: &mut [f64]) {
        out.fill(0.0);
        let mut variance = [0.0; 2];
        for w in filter.clone() {
            let row = &self.plain[w * self.width..(w + 1) * self.width];
            out.iter_mut().zip(row).for_each(|(sum, x)| *sum += x);
            variance = [variance[0] + self.variance[w][0], variance[1] + self.variance[w][1]];
        }
        let scale = noise(variance, [0.0; 2], filter.len()).sqrt();
        out.iter_mut().for_each(|x| *x *= scale);
    }

    /// Distance over requirement of a selection of filters (a band is a filter of its own).
    pub(super) fn distance(&self, filters: &[Range<usize>]) -> f64 {
        if filters.len() < self.needed() || self.whole == 0.0 {
            return 0.0;
        }
        let priors = self.priors.len() / self.width;
        let count = filters.len() + priors;
        let mut columns = vec![0.0; count * self.width];
        let mut row = vec![0.0; self.width];
        for (j, filter) in filters.iter().enumerate() {
            self.exact_row(filter, &mut row);
            row.iter().enumerate().for_each(|(i, x)| columns[i * count + j] = *x);
        }
        for (j, row) in self.priors.chunks(self.width).enumerate() {
            row.iter().enumerate().for_each(|(i, x)| columns[i * count + filters.len() + j] = *x);
        }
        let found = Projector::default().project(&mut columns, &vec![1.0; count], 1.0);
        if found.relative_error < 1.0 { found.residual } else { 0.0 }
    }

    /// Normal equations of the priors alone.
    pub(super) fn prior_gram(&self) -> Vec<f64> {
        let mut gram = vec![0.0; self.width * self.width];
        self.priors.chunks(self.width).for_each(|row| add_square(&mut gram, row, 1.0));
        gram
    }

    /// Normal equations of a selection, priors included.
    pub(super) fn gram(&self, filters: &[Range<usize>]) -> Vec<f64> {
        let mut gram = self.prior_gram();
        let mut row = vec![0.0; self.width];
        for filter in filters {
            if filter.len() == 1 {
                add_square(&mut gram, self.row(filter.start), 1.0);
            } else {
                self.filter_row(filter, &mut row);
                add_square(&mut gram, &row, 1.0);
            }
        }
        gram
    }

    /// Normal equations of single bands, priors included.
    pub(super) fn gram_of_bands(&self, bands: impl IntoIterator<Item = usize>) -> Vec<f64> {
        let mut gram = self.prior_gram();
        bands.into_iter().for_each(|band| add_square(&mut gram, self.row(band), 1.0));
        gram
    }

    /// Σ (r − c·q)² over the priors.
    pub(super) fn prior_cost(&self, coefficients: &[f64]) -> f64 {
        self.priors.chunks(self.width).map(|row| residual(row, coefficients).powi(2)).sum()
    }

    /// Sums up to each band of r − c·q before it is divided by the noise.
    pub(super) fn residual_sums(&self, coefficients: &[f64]) -> Vec<f64> {
        self.sums.chunks(self.width).map(|row| residual(row, coefficients)).collect()
    }

    /// 1/variance of the filters from band `start` to each later end.
    pub(super) fn noise_from(&self, start: usize) -> impl Iterator<Item = f64> {
        let low = self.variance_sums[start];
        self.variance_sums[start + 1..].iter().enumerate().map(move |(i, high)| noise(*high, low, i + 1))
    }
}

/// 1/x, and 0 for 0.
fn reciprocal(x: f64) -> f64 {
    if x > 0.0 { 1.0 / x } else { 0.0 }
}

/// 1/variance of a filter of `bands` bands, from sums of both kinds of variance at its ends: what comes with photons adds up, the
/// reading comes once.
fn noise(high: [f64; 2], low: [f64; 2], bands: usize) -> f64 {
    reciprocal((high[0] - low[0]) + (high[1] - low[1]) / bands as f64)
}

/// r − c·q of a row; c is 0 where it is not given.
#[inline]
pub(super) fn residual(row: &[f64], coefficients: &[f64]) -> f64 {
    let difference = row.last().copied().unwrap_or(0.0);
    row.iter().zip(coefficients).fold(difference, |left, (q, c)| left - q * c)
}

/// Adds weight·row·rowᵀ, lower triangle.
pub(super) fn add_square(gram: &mut [f64], row: &[f64], weight: f64) {
    for (i, (gram, x)) in gram.chunks_mut(row.len()).zip(row).enumerate() {
        gram[..=i].iter_mut().zip(row).for_each(|(g, y)| *g += weight * x * y);
    }
}

/// Least-squares fit of a selection.
#[derive(Debug, Clone, Default)]
pub(super) struct Fit {
    /// Coefficients c of the nuisances.
    pub(super) coefficients: Vec<f64>,
    /// (d/required)².
    pub(super) square: f64,
    /// Triangular factor of the normal equations of the nuisances, with the inverses of its diagonal.
    factor: Vec<f64>,
    scratch: Vec<f64>,
}

impl Fit {
    /// Solves the normal equations (lower triangle, `width` columns). Written out beside nalgebra's Cholesky factor, without allocation and with a
    /// pivot that is never 0: three columns take 87 ns, with nalgebra's 200 ns.
    pub(super) fn solve(&mut self, gram: &[f64], width: usize) {
        let p = width - 1;
        self.factor.clear();
        self.factor.resize(p * p, 0.0);
        self.coefficients.clear();
        self.coefficients.extend_from_slice(&gram[p * width..p * width + p]);
        self.scratch.resize(p, 0.0);
        let mut square = gram[p * width + p];
        for i in 0..p {
            for j in 0..=i {
                let known: f64 = (0..j).map(|k| self.factor[i * p + k] * self.factor[j * p + k]).sum();
                let left = gram[i * width + j] - known;
                self.factor[i * p + j] =
                    if i == j { 1.0 / (left.max(0.0) + RIDGE).sqrt() } else { left * self.factor[j * p + j] };
            }
            let known: f64 = (0..i).map(|k| self.factor[i * p + k] * self.coefficients[k]).sum();
            let z = (self.coefficients[i] - known) * self.factor[i * p + i];
            self.coefficients[i] = z;
            square -= z * z;
        }
        for i in (0..p).rev() {
            let known: f64 = (i + 1..p).map(|k| self.factor[k * p + i] * self.coefficients[k]).sum();
            self.coefficients[i] = (self.coefficients[i] - known) * self.factor[i * p + i];
        }
        self.square = square.max(0.0);
    }

    /// (d/required)² with one more row: + (r − c·q)²/(1 + qᵀG⁻¹q).
    #[inline]
    pub(super) fn with_row(&mut self, row: &[f64]) -> f64 {
        let p = self.coefficients.len();
        let mut spread = 1.0;
        for i in 0..p {
            let factor = &self.factor[i * p..=i * p + i];
            let known: f64 = factor[..i].iter().zip(&self.scratch).map(|(l, y)| l * y).sum();
            let y = (row[i] - known) * factor[i];
            self.scratch[i] = y;
            spread += y * y;
        }
        let left = residual(row, &self.coefficients);
        self.square + left * left / spread
    }
}
