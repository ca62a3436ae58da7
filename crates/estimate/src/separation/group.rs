//! One emissivity for a group of pixels, each of its own temperature and lighting: least squares on the heat signal.
//!
//! Pixel p sends N_pw = κ_w [e_w B_w(T_p) + (1 − e_w) Σₖ V_pk S_kw] + a_w, a_w the counts of the air before the camera, with variance N + σ². Near a state, with scores D = κ(B − X)/√var of
//! the emissivities and those of T_p and V_p, the latter are taken off by projection (P⊥), so that the emissivities have the
//! information F = Σ_p D P⊥ D and the slope g = Σ_p D P⊥ r, r the residuals in deviations. A change of all emissivities that a change
//! of all temperatures undoes is left in F as a direction without information: **magnitude and temperature are almost degenerate**. What
//! holds it is a Gaussian prior e = m + A z: (1 + AᵀFA) z = Aᵀ(g + F(e − m)) is solved by Cholesky, and the covariance of e is
//! A(1 + AᵀFA)⁻¹Aᵀ, which has the errors of all temperatures and lightings in it (the Cramér–Rao bound of all unknowns jointly, with
//! the prior).
//!
//! * Lighting factors are taken off also where a limit holds them.
//! * Pixels whose χ² is more than [`FAR`] times the median of the group count for less, by its ratio.
//! * Where χ²/ν of n pixels exceeds 1 by more than its own scatter allows, what is beyond it is taken as common to all of them, and as
//!   if all W bands of it were along the one direction that tells least: for the deviations F is divided by χ²/ν + n W (χ²/ν − 1 − 3√(2/nν)). Pixels that
//!   differ, or a model that is wrong, do not average out; what is left is what the prior says.
//! * Where the solution leaves [0, 1], the bands that do are held at the limit; the deviations stay those without limits.

use super::radiometry::Radiometry;
use super::sample::Sample;
use crate::decompose::{Maps, NO_MATERIAL};
use hadar::fisher::emissivity::EmissivityPrior;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use rayon::prelude::*;

/// χ² over the median of the group beyond which a pixel counts for less.
const FAR: f64 = 3.0;
/// Pixels that one thread takes at a time.
const CHUNK: usize = 512;
/// Share of a column's length that another one leaves of it where they are the same.
const SAME: f64 = 1e-9;
/// Rounds in which bands are held at a limit.
const HELD_ROUNDS: usize = 12;
/// Deviations of χ²/ν that are no sign of a wrong model.
const SCATTER: f64 = 3.0;
/// Times the largest information, that which holds a band.
const HOLDS: f64 = 1e4;

/// State of a pixel.
#[derive(Debug, Clone)]
pub(super) struct State {
    pub(super) group: usize,
    pub(super) temperature_k: f64,
    pub(super) lighting: Vec<f64>,
}

/// States of the pixels of a sample that have one.
pub(super) fn states(maps: &Maps, radiometry: &Radiometry<'_>) -> Vec<Option<State>> {
    let lights = radiometry.lights.len();
    let one = |i: usize| {
        let temperature_k = f64::from(maps.temperature_k[i]);
        if maps.material[i] == NO_MATERIAL || !temperature_k.is_finite() {
            return None;
        }
        let own = maps.lighting.get(i * lights..(i + 1) * lights).unwrap_or_default();
        let lighting = own.iter().map(|v| f64::from(*v)).collect();
        Some(State { group: usize::from(maps.material[i]), temperature_k, lighting })
    };
    (0..maps.material.len()).map(one).collect()
}

/// A pixel at a state, in deviations of its counts.
struct Look {
    residual: Vec<f64>,
    /// D.
    emissivity: Vec<f64>,
    /// Scores of the lighting, then of the temperature.
    others: Vec<Vec<f64>>,
}

impl Look {
    fn at(radiometry: &Radiometry<'_>, counts: &[f64], e: &[f64], state: &State) -> Self {
        let [black, slope] = radiometry.blackbody(state.temperature_k);
        let light = radiometry.light(&state.lighting);
        let mut others: Vec<Vec<f64>> = radiometry.changes();
        let width = counts.len();
        let (mut residual, mut emissivity, mut warmer) =
            (vec![0.0; width], vec![0.0; width], vec![0.0; width]);
        for w in 0..width {
            let per = radiometry.counts[w];
            let sent = e[w] * black[w] + (1.0 - e[w]) * light[w];
            let mean = per.mul_add(sent, radiometry.of_air[w]).max(1e-6);
            let sigma = (mean + radiometry.var_added[w]).sqrt();
            residual[w] = (counts[w] - mean) / sigma;
            emissivity[w] = per * (black[w] - light[w]) / sigma;
            warmer[w] = per * e[w] * slope[w] / sigma;
            others.iter_mut().for_each(|other| other[w] *= per * (1.0 - e[w]) / sigma);
        }
        others.push(warmer);
        Self { residual, emissivity, others }
    }

    fn chi_square(&self) -> f64 {
        self.residual.iter().map(|r| r * r).sum()
    }
}

/// Pearson's χ² of a pixel at a state.
pub(super) fn chi_square(radiometry: &Radiometry<'_>, counts: &[f64], e: &[f64], state: &State) -> f64 {
    Look::at(radiometry, counts, e, state).chi_square()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// What is left of columns when those before are taken off, with length 1; what the others imitate is left out. With it whether the
/// last one is among them, and its length.
fn orthogonal(columns: &[Vec<f64>]) -> (Vec<Vec<f64>>, Option<f64>) {
    let mut base: Vec<Vec<f64>> = Vec::new();
    let mut last = None;
    for (i, column) in columns.iter().enumerate() {
        let mut left = column.clone();
        let before = dot(&left, &left).sqrt();
        // Twice is enough.
        for _ in 0..2 {
            for unit in &base {
                let along = dot(unit, &left);
                left.iter_mut().zip(unit).for_each(|(x, u)| *x -= along * u);
            }
        }
        let length = dot(&left, &left).sqrt();
        if length > SAME * before && length > 0.0 {
            left.iter_mut().for_each(|x| *x /= length);
            base.push(left);
            last = (i + 1 == columns.len()).then_some(length);
        }
    }
    (base, last)
}

/// Sums over the pixels of a group.
#[derive(Debug, Clone)]
pub(super) struct Information {
    /// F.
    matrix: DMatrix<f64>,
    /// g.
    slope: DVector<f64>,
    /// Mean −∂T/∂e: how far all temperatures shift with the emissivities, K.
    shift_k: DVector<f64>,
    weight: f64,
    chi_square: f64,
    freedom: f64,
    /// Σ (r² − 1) and Σ D² by band.
    spread: Vec<[f64; 2]>,
    pub(super) pixels: usize,
}

impl Information {
    fn none(width: usize) -> Self {
        Self {
            matrix: DMatrix::zeros(width, width),
            slope: DVector::zeros(width),
            shift_k: DVector::zeros(width),
            weight: 0.0,
            chi_square: 0.0,
            freedom: 0.0,
            spread: vec![[0.0; 2]; width],
            pixels: 0,
        }
    }

    fn add(&mut self, look: &Look, weight: f64) {
        let width = look.residual.len();
        let (base, last) = orthogonal(&look.others);
        let d = &look.emissivity;
        let mut left = look.residual.clone();
        for (w, d) in d.iter().enumerate() {
            self.matrix[(w, w)] += weight * d * d;
        }
        for unit in &base {
            let along = dot(unit, &left);
            left.iter_mut().zip(unit).for_each(|(x, u)| *x -= along * u);
            let column: Vec<f64> = unit.iter().zip(d).map(|(u, d)| u * d).collect();
            for (mut sums, value) in self.matrix.column_iter_mut().zip(&column) {
                let factor = weight * value;
                sums.iter_mut().zip(&column).for_each(|(sum, value)| *sum -= factor * value);
            }
        }
        for w in 0..width {
            self.slope[w] += weight * d[w] * left[w];
            self.spread[w][0] += weight * (look.residual[w].powi(2) - 1.0);
            self.spread[w][1] += weight * d[w] * d[w];
        }
        if let (Some(unit), Some(length)) = (base.last(), last) {
            for w in 0..width {
                self.shift_k[w] += weight * unit[w] * d[w] / length;
            }
        }
        self.weight += weight;
        self.chi_square += weight * look.chi_square();
        self.freedom += weight * (width as f64 - base.len() as f64).max(1.0);
        self.pixels += 1;
    }

    fn join(mut self, other: &Self) -> Self {
        self.matrix += &other.matrix;
        self.slope += &other.slope;
        self.shift_k += &other.shift_k;
        self.weight += other.weight;
        self.chi_square += other.chi_square;
        self.freedom += other.freedom;
        for (sum, more) in self.spread.iter_mut().zip(&other.spread) {
            *sum = [sum[0] + more[0], sum[1] + more[1]];
        }
        self.pixels += other.pixels;
        self
    }

    /// Of the pixels of a group, at the emissivities `e` of the bands that count.
    pub(super) fn of(
        radiometry: &Radiometry<'_>,
        sample: &Sample,
        pixels: &[(usize, &State)],
        e: &[f64],
    ) -> Self {
        let look =
            |(i, state): &(usize, &State)| Look::at(radiometry, &sample.used(*i, &radiometry.used), e, state);
        let chi: Vec<f64> = pixels.par_iter().map(|pixel| look(pixel).chi_square()).collect();
        let mut sorted = chi.clone();
        sorted.sort_by(f64::total_cmp);
        let far = FAR * sorted.get(sorted.len() / 2).copied().unwrap_or(f64::INFINITY);
        let parts: Vec<Self> = pixels
            .par_chunks(CHUNK)
            .zip(chi.par_chunks(CHUNK))
            .map(|(pixels, chi)| {
                let mut sum = Self::none(radiometry.used.len());
                for (pixel, chi) in pixels.iter().zip(chi) {
                    hadar::stop::check();
                    sum.add(&look(pixel), if *chi > far { far / chi } else { 1.0 });
                }
                sum
            })
            .collect();
        parts.iter().fold(Self::none(radiometry.used.len()), Self::join)
    }

    /// By how much the information is less than were all as it is modelled.
    fn worse(&self) -> f64 {
        let reduced = self.reduced();
        let beyond = reduced - 1.0 - SCATTER * (2.0 / self.freedom.max(1.0)).sqrt();
        let bands = self.slope.len() as f64;
        let worse = reduced.max(1.0) + self.weight * bands * beyond.max(0.0);
        if worse.is_finite() { worse } else { 1.0 }
    }

    /// χ² for each degree of freedom.
    pub(super) fn reduced(&self) -> f64 {
        if self.freedom > 0.0 { self.chi_square / self.freedom } else { f64::NAN }
    }
}

/// An emissivity with what is uncertain of it.
#[derive(Debug, Clone)]
pub(super) struct Curve {
    /// Of all bands, also of those that do not count, where the prior carries it on.
    pub(super) emissivity: Vec<f64>,
    /// Deviation of each.
    pub(super) sigma: Vec<f64>,
    /// The part of it that goes with the mean of all bands.
    pub(super) sigma_magnitude: Vec<f64>,
    /// Deviation of that mean.
    pub(super) sigma_mean: f64,
    /// Deviation of what all temperatures of the group have in common, K.
    pub(super) sigma_temperature_k: f64,
    /// Deviation of the pixels' emissivities about the curve, beyond their noise.
    pub(super) spread: Vec<f64>,
    /// Bands that a limit holds.
    pub(super) held: usize,
}

impl Curve {
    /// From the information at `e`, the emissivities of the bands that count; `reach` is about how far from them it may go.
    pub(super) fn new(
        radiometry: &Radiometry<'_>,
        prior: &EmissivityPrior,
        found: &Information,
        e: &[f64],
        reach: f64,
    ) -> Option<Self> {
        let used = &radiometry.used;
        // The estimate takes what is beyond the noise for more noise, its deviations take the worst of it.
        let scale = found.reduced().max(1.0);
        let scale = if scale.is_finite() { scale } else { 1.0 };
        let matrix = &found.matrix / scale;
        let (a, mean) = (prior.factor(), prior.mean());
        let own = a.select_rows(used.iter());
        let apart = DVector::from_iterator(used.len(), used.iter().zip(e).map(|(band, e)| e - mean[*band]));
        let free = factored(&own, &(&found.matrix / found.worse()))?;
        let damped = &matrix + DMatrix::identity(used.len(), used.len()) / (reach * reach);
        let right = &found.slope / scale + &damped * apart;
        let mut emissivity = prior.at(factored(&own, &damped)?.solve(&own.tr_mul(&right)).as_slice());
        let mut held: Vec<Option<f64>> = vec![None; used.len()];
        for _ in 0..HELD_ROUNDS {
            let mut more = false;
            for (held, band) in held.iter_mut().zip(used) {
                let limit = emissivity[*band].clamp(0.0, 1.0);
                if held.is_none() && (limit - emissivity[*band]).abs() > 1e-9 {
                    (*held, more) = (Some(limit), true);
                }
            }
            if !more {
                break;
            }
            let (mut matrix, mut right) = (damped.clone(), right.clone());
            let strong = HOLDS * matrix.diagonal().max().max(1.0);
            for (w, limit) in held.iter().enumerate() {
                if let Some(limit) = limit {
                    matrix[(w, w)] += strong;
                    right[w] += strong * (limit - mean[used[w]]);
                }
            }
            emissivity = prior.at(factored(&own, &matrix)?.solve(&own.tr_mul(&right)).as_slice());
        }
        emissivity.iter_mut().for_each(|e| *e = e.clamp(0.0, 1.0));
        // Rows of A L⁻ᵀ: the covariance is their products.
        let images: Vec<DVector<f64>> = (0..mean.len())
            .map(|band| free.l_dirty().solve_lower_triangular(&a.row(band).transpose()))
            .collect::<Option<_>>()?;
        let total: DVector<f64> =
            used.iter().fold(DVector::zeros(a.ncols()), |sum, band| sum + &images[*band]);
        let length = total.norm();
        let along = |image: &DVector<f64>| if length > 0.0 { image.dot(&total).abs() / length } else { 0.0 };
        let shift = used.iter().zip(found.shift_k.iter());
        let shift: DVector<f64> = shift.fold(DVector::zeros(a.ncols()), |sum, (band, k)| {
            sum + &images[*band] * (*k / found.weight.max(1e-300))
        });
        let spread =
            found.spread.iter().map(|[off, d]| if *d > 0.0 { (off / d).max(0.0).sqrt() } else { 0.0 });
        Some(Self {
            sigma: images.iter().map(|image| image.norm()).collect(),
            sigma_magnitude: images.iter().map(along).collect(),
            sigma_mean: length / used.len() as f64,
            sigma_temperature_k: shift.norm(),
            spread: spread.collect(),
            held: held.iter().flatten().count(),
            emissivity,
        })
    }
}

/// 1 + AᵀFA.
fn factored(own: &DMatrix<f64>, matrix: &DMatrix<f64>) -> Option<Cholesky<f64, Dyn>> {
    let mut inner = own.tr_mul(&(matrix * own));
    inner = 0.5 * (&inner + inner.transpose());
    (0..inner.nrows()).for_each(|k| inner[(k, k)] += 1.0);
    Cholesky::new(inner)
}
