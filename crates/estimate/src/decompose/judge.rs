//! What all pixels of a cube together say of the model they were decomposed with.
//!
//! A pixel may fit by itself and the cube may not: what each pixel hides in its noise adds up. At the fit of pixel i, with whitened
//! residual ρᵢ = (I − QᵢQᵢᵀ)(n − N)/σ ([`super::tangent`]: what its temperature and lighting explain is taken out),
//!
//! * p of χ² = ρ·ρ with as many degrees of freedom as bands less columns of Q is uniform; the mean of n of them is ½ ± 1/√(12 n);
//! * Σᵢ ρᵢ_w has the variance Σᵢ kᵢ_w, kᵢ_w = 1 − ΣQᵢ_w²: the residual that pixels have in common in band w;
//! * along a cause θ ([`super::cause`]), with dᵢ its slope without what temperature and lighting explain, the score is s = Σ dᵢ·ρᵢ and the
//!   information J = Σ dᵢ·dᵢ. θ̂ = J⁻¹s is the estimate of θ together with all temperatures and lightings (one step of maximum
//!   likelihood), s²/J what χ² gains by it; a temperature moves by θ̂ (g·∂N/∂θ/σ)/|g| of its deviations, g its row.
//!
//! Pixels that fit nothing by themselves (p below [`NO_FIT`]) are left out of the first sums, as a material that is missing is no fault
//! of the rest; the p of what is left is uniform from there on. In the second sums, for where most pixels fit nothing, they count
//! with the weight of a residual of [`FAR`] deviations of χ².
//!
//! Assumptions: the material of a pixel with one candidate is right; errors of the library are none (they are the same in all pixels of
//! a material, and would be taken for causes).

use super::cause::{Cause, Effect};
use super::maps::{Maps, check_bands};
use super::model::Setting;
use super::pixel::{NO_FIT, NO_MATERIAL, flag};
use super::tangent::{Tangent, Tangents, dot};
use hadar::cube::{CubeRef, Rows, Sample};
use hadar::error::{Error, Result};
use hadar::parallel;
use hadar::statistics::chi_square_survival;

/// Deviations of χ² above its mean from which on a residual weighs less.
const FAR: f64 = 4.0;

/// What pixels say together, of the bands that count and some causes.
#[derive(Debug, Clone, PartialEq)]
pub struct Judged {
    /// Of the pixels that fit by themselves.
    pub fitting: Together,
    /// Of all pixels with one candidate.
    pub all: Together,
    /// Bands that count, in rising wavenumber.
    pub bands: Vec<usize>,
}

/// Sums over pixels.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Together {
    /// Pixels.
    pub pixels: usize,
    /// Σ p.
    pub p_values: f64,
    /// Σ χ².
    pub chi_square: f64,
    /// Degrees of freedom.
    pub freedom: f64,
    /// Σ ρ of each band, and its variance.
    pub residual: Vec<[f64; 2]>,
    /// s of each cause.
    pub score: Vec<f64>,
    /// J of each cause alone.
    pub information: Vec<f64>,
    /// Σ of the squares of what a unit of each cause does to a temperature, in its deviations.
    pub moved: Vec<f64>,
}

impl Together {
    fn new(bands: usize, causes: usize) -> Self {
        Self {
            residual: vec![[0.0; 2]; bands],
            score: vec![0.0; causes],
            information: vec![0.0; causes],
            moved: vec![0.0; causes],
            ..Self::default()
        }
    }

    fn add(&mut self, other: &Self) {
        self.pixels += other.pixels;
        self.p_values += other.p_values;
        self.chi_square += other.chi_square;
        self.freedom += other.freedom;
        let pairs = self.residual.iter_mut().zip(&other.residual);
        pairs.for_each(|(to, from)| to.iter_mut().zip(from).for_each(|(to, from)| *to += from));
        self.score.iter_mut().zip(&other.score).for_each(|(to, from)| *to += from);
        self.information.iter_mut().zip(&other.information).for_each(|(to, from)| *to += from);
        self.moved.iter_mut().zip(&other.moved).for_each(|(to, from)| *to += from);
    }

    /// Estimate of a cause alone, and what χ² gains by it; nothing where the pixels do not tell.
    #[must_use]
    pub fn alone(&self, cause: usize) -> Option<(f64, f64)> {
        let information = *self.information.get(cause)?;
        let score = *self.score.get(cause)?;
        (information > 0.0).then(|| (score / information, score * score / information))
    }

    /// By how many of its deviations a temperature moves where a cause is as it is estimated, rms over the pixels.
    #[must_use]
    pub fn temperature_moved(&self, cause: usize) -> f64 {
        let estimate = self.alone(cause).map_or(0.0, |(estimate, _)| estimate.abs());
        let square = self.moved.get(cause).copied().unwrap_or(0.0) / self.pixels.max(1) as f64;
        estimate * square.sqrt()
    }

    /// Deviations of the mean p-value below that of a right model.
    #[must_use]
    pub fn p_deviations(&self) -> f64 {
        p_deviations(self.p_values, self.pixels)
    }
}

/// Deviations by which the mean of p-values from [`NO_FIT`] on is below that of a right model.
#[must_use]
pub fn p_deviations(sum: f64, pixels: usize) -> f64 {
    if pixels == 0 {
        return 0.0;
    }
    let count = pixels as f64;
    (0.5 * (1.0 + NO_FIT) - sum / count) * (12.0 * count).sqrt()
}

/// What pixels `[row][column]` with their `maps` say together of a setting and of `causes`.
///
/// # Errors
/// Maps or a cube of another setting, a cube that cannot be read, an unknown gain of every pixel.
pub fn judge<'c>(
    setting: &Setting<'_>,
    causes: &[Cause],
    maps: &Maps,
    cube: impl Into<CubeRef<'c>>,
) -> Result<Judged> {
    let cube = cube.into();
    check_bands(setting, cube)?;
    let (shape, lights) = (cube.shape(), setting.surroundings.len());
    let pixels = shape.rows() * shape.columns();
    for (what, found, expected) in [
        ("materials of the maps", maps.material.len(), pixels),
        ("temperatures of the maps", maps.temperature_k.len(), pixels),
        ("candidates of the maps", maps.candidates.len(), pixels),
        ("flags of the maps", maps.flags.len(), pixels),
        ("lighting factors of the maps", maps.lighting.len(), pixels * lights),
    ] {
        if found != expected {
            return Err(Error::Length { what: what.into(), found, expected });
        }
    }
    let tangents = Tangents::new(setting)?;
    let effects: Vec<Effect> = causes.iter().map(|cause| Effect::new(cause, setting, &tangents)).collect();
    let judge = Judge { tangents, effects, maps, lights, per_unit: 1.0 / setting.units_per_count };
    match cube {
        CubeRef::F32(rows) => judge.whole(rows),
        CubeRef::F64(rows) => judge.whole(rows),
    }
}

struct Judge<'a> {
    tangents: Tangents<'a>,
    effects: Vec<Effect>,
    maps: &'a Maps,
    lights: usize,
    per_unit: f64,
}

impl Judge<'_> {
    fn whole<S: Sample>(&self, cube: &dyn Rows<S>) -> Result<Judged> {
        let shape = cube.shape();
        let (bands, causes) = (self.tangents.used.len(), self.effects.len());
        let of_row = |(room, buffer): &mut (Room, Vec<S>), row: usize| -> Result<[Together; 2]> {
            let mut sums = [Together::new(bands, causes), Together::new(bands, causes)];
            let samples = cube.read(row..row + 1, buffer)?;
            for (column, sample) in samples.chunks(shape.bands()).enumerate() {
                hadar::stop::check();
                self.pixel(row * shape.columns() + column, sample, room, &mut sums);
            }
            Ok(sums)
        };
        let rows = parallel::try_map_with(shape.rows(), || (Room::default(), Vec::new()), of_row)?;
        let mut sums = [Together::new(bands, causes), Together::new(bands, causes)];
        for row in &rows {
            sums.iter_mut().zip(row).for_each(|(sum, row)| sum.add(row));
        }
        let [fitting, all] = sums;
        Ok(Judged { fitting, all, bands: self.tangents.used.clone() })
    }

    /// Adds a pixel with one candidate to the sums of those that fit, and of all.
    fn pixel<S: Sample>(&self, i: usize, sample: &[S], room: &mut Room, [fitting, all]: &mut [Together; 2]) {
        const UNTOLD: u8 = flag::SKIPPED | flag::NO_INFORMATION | flag::TEMPERATURE_UNKNOWN;
        let (maps, tangents) = (self.maps, &self.tangents);
        let material = maps.material[i];
        if material == NO_MATERIAL || maps.candidates[i] != 1 || maps.flags[i] & UNTOLD != 0 {
            return;
        }
        let m = usize::from(material);
        let Room { tangent, lit, rho, slopes, moved } = room;
        lit.clear();
        lit.extend(maps.lighting[i * self.lights..][..self.lights].iter().map(|v| f64::from(*v)));
        // What nothing scatters changes nothing.
        lit.iter_mut().filter(|v| v.is_nan()).for_each(|v| *v = 0.0);
        if !tangents.at(m, f64::from(maps.temperature_k[i]), lit, tangent) {
            return;
        }
        rho.clear();
        for ((band, mean), sigma) in tangents.used.iter().zip(&tangent.mean).zip(&tangent.sigma) {
            let n: f64 = sample[*band].into();
            rho.push((self.per_unit * n - mean) / sigma);
        }
        tangent.take_out(rho);
        let chi_square = dot(rho, rho);
        let freedom = rho.len() as f64 - tangent.q.len() as f64;
        let p_value = chi_square_survival(chi_square, freedom);
        if !chi_square.is_finite() || p_value.is_nan() {
            return;
        }
        slopes.resize_with(self.effects.len(), Vec::new);
        let row = tangent.row(&tangents.of_temperature()).unwrap_or_default();
        let length = dot(&row, &row).sqrt();
        moved.clear();
        for (effect, slope) in self.effects.iter().zip(slopes.iter_mut()) {
            effect.slope(tangents, (m, lit), tangent, slope);
            moved.push(if length > 0.0 { dot(&row, slope) / length } else { 0.0 });
            tangent.take_out(slope);
        }
        let weight = ((freedom + FAR * (2.0 * freedom).sqrt()) / chi_square).min(1.0);
        let fits = p_value >= NO_FIT;
        for (sums, weight) in [(all, weight)].into_iter().chain(fits.then_some((fitting, 1.0))) {
            sums.pixels += 1;
            sums.p_values += p_value;
            sums.chi_square += weight * chi_square;
            sums.freedom += freedom;
            for (w, (residual, rho)) in sums.residual.iter_mut().zip(rho.iter()).enumerate() {
                residual[0] += weight * rho;
                residual[1] += weight * tangent.kept(w);
            }
            for (a, one) in slopes.iter().enumerate() {
                sums.score[a] += weight * dot(one, rho);
                sums.moved[a] += moved[a] * moved[a];
                sums.information[a] += weight * dot(one, one);
            }
        }
    }
}

/// Room for one pixel.
#[derive(Debug, Default)]
struct Room {
    tangent: Tangent,
    lit: Vec<f64>,
    rho: Vec<f64>,
    slopes: Vec<Vec<f64>>,
    moved: Vec<f64>,
}

#[cfg(test)]
mod tests;
