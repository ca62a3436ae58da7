//! The projection of [`bound`](super::bound) where doubles cannot tell what is left of a column from their rounding.
//!
//! A nuisance of which less than 1e-14 is left of what it is made of has, in doubles, no direction; leaving it out makes
//! the distance too large, by any factor. Here the columns are formed ([`CarefulScene`]) and made orthogonal in 128 bits,
//! and where these leave a doubt in 512, so that a nuisance is left out only if it is zero or less than [`DEPENDENT`] is
//! left of it: it then depends on the others exactly.
//!
//! Rounding: with u = 2⁻¹¹⁸ and 2⁻⁵⁰², what is left of column k is off by no more than ηₖ = u(terms of column k) + Σᵢ ρₖᵢ ηᵢ/ρᵢ, ρₖᵢ
//! being what was left of it before direction i was taken off and ρᵢ what was left of that; elements are good to a few hundred
//! units of the last place of the terms they are made of. A direction turns by ηᵢ/ρᵢ, and the residual by the square of that.
//! Where even 512 bits do not tell whether a nuisance depends on the others, nothing is known of the distance, and the error
//! says so. Otherwise it is that of the numbers it ends in, doubles.
//!
//! Source: paper S25–S29.

use super::{Counting, Unknowns};
use crate::scene::{Asked, CarefulScene, Column, Parameter, State, Surroundings};
use crate::spectrum::Bands;
use crate::units::SECOND_RADIATION_CM_K;
use crate::wide::Wide;

/// Limbs of the first try and of the last.
const FEW: usize = 2;
const MANY: usize = 8;
/// Share of a column below which what is left of it is nothing.
const DEPENDENT: f64 = 1e-130;
/// Relative error of which nothing is known.
const UNKNOWN: f64 = 1e300;
/// Rounding of elements and sums, in units of the last place.
const ROUNDINGS: f64 = 512.0;
/// Relative error that the first try may leave: none that a double would show.
const GOOD: f64 = 1e-18;
/// What the conversion to doubles adds: two roots, two quotients.
const CONVERSION: f64 = 4.0 * f64::EPSILON;
/// Share of the column asked for below which what is left of it is taken for nothing: the rounding of its own elements,
/// were they formed in doubles.
pub(crate) const BLIND: f64 = 16.0 * f64::EPSILON;

/// hcν/kT beyond which radiances come near the least number of a double, and then are 0.
const FAINT: f64 = 690.0;

/// Power of two below which a signal (photons s⁻¹ m⁻² sr⁻¹) is none.
const DARK: i64 = -1000;

/// Which noise weighs the bands.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Noise<'n> {
    /// u = 1/(S ΣS); priors count as among so many photons, for nothing where infinite.
    PerPhoton { photons: f64 },
    /// u = κ²/(κS + σ²).
    Counting(&'n Counting),
}

/// What is left of the last column; lengths are divided by 2 to the power of its column, so that they are near 1.
#[derive(Debug, Clone)]
pub(crate) struct Careful {
    pub(crate) residual: f64,
    pub(crate) norm: f64,
    /// Of `residual`.
    pub(crate) relative_error: f64,
    /// Per column, the last included.
    pub(crate) powers: Vec<i32>,
    /// ‖aᵢ‖ of the columns, and what is left of each; 0 of those that were dropped.
    pub(crate) lengths: Vec<f64>,
    pub(crate) norms: Vec<f64>,
    /// Unit upper triangle, row by row, and the coefficients of the last column on the others.
    pub(crate) triangle: Vec<f64>,
    pub(crate) coefficients: Vec<f64>,
    pub(crate) dropped: Vec<usize>,
}

/// Spectra in either number of digits.
#[derive(Debug, Clone)]
pub(crate) struct CarefulProjector<'a> {
    few: CarefulScene<'a, FEW>,
    many: CarefulScene<'a, MANY>,
    /// Largest hcν/k of a node, K.
    hottest_k: f64,
}

impl<'a> CarefulProjector<'a> {
    pub(crate) fn new(bands: &'a Bands, surroundings: &'a Surroundings) -> Self {
        let (few, many) = (CarefulScene::new(bands, surroundings), CarefulScene::new(bands, surroundings));
        let most_cm1 = bands.nodes_cm1().iter().copied().fold(0.0, f64::max);
        Self { few, many, hottest_k: SECOND_RADIATION_CM_K * most_cm1 }
    }

    /// Whether a radiance of a state is so small that doubles may lose it.
    pub(crate) fn loses_light(&self, state: &State) -> bool {
        let coldest_k = state.environment_k.iter().fold(state.temperature_k, |least, t| least.min(*t));
        self.hottest_k > FAINT * coldest_k
    }

    /// The last of the parameters' columns off the others.
    pub(crate) fn project(&mut self, asked: Asked<'_>, noise: Noise<'_>, unknowns: &Unknowns) -> Careful {
        let of_few = of_scene(&mut self.few, asked, noise, unknowns);
        match of_few {
            Some(found) => found,
            None => of_scene(&mut self.many, asked, noise, unknowns).unwrap_or_else(Careful::nothing),
        }
    }
}

/// The last of some columns off the others, in units of the deviations `sigma` of their rows: the doubles count as exact.
pub(crate) fn project_columns(columns: &[&[f64]], sigma: &[f64]) -> Careful {
    fn of<const L: usize>(columns: &[&[f64]], sigma: &[f64]) -> Option<Careful> {
        let wide = |values: &[f64]| values.iter().map(|&value| Wide::<L>::from(value)).collect::<Vec<_>>();
        let weights = wide(sigma).into_iter().map(|sigma| (sigma * sigma).inverse()).collect();
        let columns = columns.iter().map(|column| Column::exact(wide(column))).collect();
        Elimination::new(columns, weights).finish()
    }
    of::<FEW>(columns, sigma).or_else(|| of::<MANY>(columns, sigma)).unwrap_or_else(Careful::nothing)
}

fn of_scene<const L: usize>(
    scene: &mut CarefulScene<'_, L>,
    asked: Asked<'_>,
    noise: Noise<'_>,
    unknowns: &Unknowns,
) -> Option<Careful> {
    let (signal, mut columns) = scene.columns(asked);
    let total = signal.iter().fold(Wide::ZERO, |sum, signal| sum + *signal);
    let weight = |(band, signal): (usize, &Wide<L>)| {
        let (square, added, counts) = match noise {
            Noise::PerPhoton { .. } => (Wide::from(1.0), Wide::ZERO, total),
            Noise::Counting(counting) => {
                let counts = Wide::from(counting.counts_per_radiance);
                (counts * counts, Wide::from(counting.var_added(band)), counts)
            }
        };
        // A band without photons tells nothing.
        let dark = signal.exponent() < DARK && added.is_zero();
        let variance = counts * *signal + added;
        if variance.is_positive() && !dark { square * variance.inverse() } else { Wide::ZERO }
    };
    let mut weights: Vec<Wide<L>> = signal.iter().enumerate().map(weight).collect();
    let photons = match noise {
        Noise::PerPhoton { photons } => photons,
        Noise::Counting(_) => 1.0,
    };
    let prior = |parameter: &Parameter| unknowns.sigma_prior(*parameter).filter(|_| photons.is_finite());
    for (owner, parameter) in asked.parameters.iter().enumerate() {
        let Some(sigma) = prior(parameter) else { continue };
        let sigma = Wide::from(sigma);
        weights.push((sigma * sigma * Wide::from(photons)).inverse());
        for (i, column) in columns.iter_mut().enumerate() {
            column.push(if i == owner { Wide::from(1.0) } else { Wide::ZERO });
        }
    }
    Elimination::new(columns, weights).finish()
}

/// Columns on their way to being orthogonal.
struct Elimination<const L: usize> {
    columns: Vec<Vec<Wide<L>>>,
    weights: Vec<Wide<L>>,
    /// Lengths of the columns, and of the terms that their elements are made of.
    lengths: Vec<Wide<L>>,
    terms: Vec<Wide<L>>,
    /// Unit upper triangle, row by row.
    triangle: Vec<Wide<L>>,
    found: Careful,
}

fn inner<const L: usize>(a: &[Wide<L>], b: &[Wide<L>]) -> Wide<L> {
    a.iter().zip(b).fold(Wide::ZERO, |sum, (a, b)| sum + *a * *b)
}

impl<const L: usize> Elimination<L> {
    const UNIT: f64 = ROUNDINGS * Wide::<L>::UNIT;
    const LAST: bool = L == MANY;

    fn new(columns: Vec<Column<L>>, weights: Vec<Wide<L>>) -> Self {
        let count = columns.len();
        let mut found = Careful::nothing();
        found.norms = vec![0.0; count];
        found.triangle = vec![0.0; count * count];
        let (columns_done, triangle) = (Vec::with_capacity(count), vec![Wide::ZERO; count * count]);
        let (lengths, terms_done) = (Vec::with_capacity(count), Vec::with_capacity(count));
        let mut elimination =
            Self { columns: columns_done, weights, lengths, terms: terms_done, triangle, found };
        for Column { mut values, terms } in columns {
            let length = elimination.length(&values);
            let terms = terms.map_or(length, |terms| elimination.length(&terms));
            let power = length.exponent();
            let found = &mut elimination.found;
            found.powers.push(power.clamp(i32::MIN.into(), i32::MAX.into()) as i32);
            found.lengths.push(length.shifted(-power).to_f64());
            elimination.lengths.push(length.shifted(-power));
            elimination.terms.push(terms.shifted(-power));
            values.iter_mut().for_each(|value| *value = value.shifted(-power));
            elimination.columns.push(values);
        }
        elimination
    }

    fn length(&self, values: &[Wide<L>]) -> Wide<L> {
        let squares = values.iter().zip(&self.weights).map(|(value, weight)| *value * *value * *weight);
        squares.fold(Wide::ZERO, |sum, square| sum + square).sqrt()
    }

    fn weighted(&self, column: usize) -> Vec<Wide<L>> {
        self.columns[column].iter().zip(&self.weights).map(|(value, weight)| *value * *weight).collect()
    }

    /// ‖aᵢ‖ + Σ|cⱼ|‖aⱼ‖ of a column whose parts along those before it are known, and the same of the terms.
    fn made_of(&mut self, column: usize) -> [Wide<L>; 2] {
        let (count, found) = (self.columns.len(), &mut self.found);
        // In all digits: coefficients on columns that nearly depend on each other cancel to any degree.
        let mut coefficients = vec![Wide::ZERO; column];
        for row in (0..column).rev().filter(|&row| found.norms[row] > 0.0) {
            let known = (row + 1..column).map(|i| self.triangle[row * count + i] * coefficients[i]);
            coefficients[row] =
                self.triangle[row * count + column] - known.fold(Wide::ZERO, |sum, part| sum + part);
        }
        found.coefficients = coefficients.iter().map(|c| c.to_f64()).collect();
        [&self.lengths, &self.terms].map(|lengths| {
            let parts = coefficients.iter().zip(lengths).map(|(c, length)| c.abs() * *length);
            parts.fold(lengths[column], |sum, part| sum + part)
        })
    }

    /// Takes column after column off the later ones; `None` where more digits are needed.
    fn finish(mut self) -> Option<Careful> {
        let count = self.columns.len();
        let Some(last) = count.checked_sub(1) else { return Some(self.found) };
        // How far what is left of a column may be off: by its own rounding, and by that of every direction that was taken off it.
        let mut noise: Vec<f64> = self.terms.iter().map(|terms| Self::UNIT * terms.to_f64()).collect();
        let mut turned = 0.0;
        for pivot in 0..last {
            let length = self.found.lengths[pivot];
            self.found.triangle[pivot * count + pivot] = 1.0;
            let weighted = self.weighted(pivot);
            let square = inner(&self.columns[pivot], &weighted);
            let [made_of, terms] = self.made_of(pivot);
            let left = square.sqrt().to_f64();
            let nothing = if Self::LAST { DEPENDENT } else { 0.0 };
            if length == 0.0 || left <= (Wide::from(nothing) * made_of).to_f64() {
                if length > 0.0 && !Self::LAST {
                    return None;
                }
                // Neither plain rounding, which it is if it depends on the others, nor surely more than all rounding.
                let plain = Self::UNIT * terms.to_f64();
                turned += if left > plain && left <= noise[pivot] { UNKNOWN } else { 0.0 };
                self.found.dropped.push(pivot);
                continue;
            }
            turned += (noise[pivot] / left).powi(2);
            if turned > GOOD && !Self::LAST {
                return None;
            }
            self.found.norms[pivot] = left;
            let inverse = square.inverse();
            for column in pivot + 1..count {
                let before = inner(&self.columns[column], &self.weighted(column)).sqrt().to_f64();
                noise[column] += before * (noise[pivot] / left + Self::UNIT);
                let share = inner(&self.columns[column], &weighted) * inverse;
                self.found.triangle[pivot * count + column] = share.to_f64();
                self.triangle[pivot * count + column] = share;
                let (done, later) = self.columns.split_at_mut(column);
                for (value, pivot) in later[0].iter_mut().zip(&done[pivot]) {
                    *value = *value - share * *pivot;
                }
            }
        }
        self.made_of(last);
        let norm = self.found.lengths[last];
        let residual = inner(&self.columns[last], &self.weighted(last)).sqrt().to_f64();
        let noise = noise[last];
        let found = &mut self.found;
        found.triangle[count * count - 1] = 1.0;
        (found.norm, found.residual) = (norm, residual);
        if residual + noise <= BLIND * norm {
            found.residual = 0.0;
        } else {
            let relative_error = noise / residual + turned;
            if relative_error > GOOD && !Self::LAST {
                return None;
            }
            found.relative_error = relative_error.min(UNKNOWN) + CONVERSION;
        }
        found.norms[last] = found.residual;
        Some(self.found)
    }
}

/// Coefficients of a column on those before it, from the unit upper triangle; 0 on those that were dropped.
pub(super) fn back_substitute(triangle: &[f64], norms: &[f64], column: usize, coefficients: &mut [f64]) {
    let count = norms.len();
    for row in (0..column).rev() {
        if norms[row] == 0.0 {
            coefficients[row] = 0.0;
            continue;
        }
        let known: f64 = (row + 1..column).map(|i| triangle[row * count + i] * coefficients[i]).sum();
        coefficients[row] = triangle[row * count + column] - known;
    }
}

impl Careful {
    fn nothing() -> Self {
        Self {
            residual: 0.0,
            norm: 0.0,
            relative_error: 0.0,
            powers: Vec::new(),
            lengths: Vec::new(),
            norms: Vec::new(),
            triangle: Vec::new(),
            coefficients: Vec::new(),
            dropped: Vec::new(),
        }
    }
}
