//! What all pixels of a cube together say of the model they were decomposed with.
//!
//! A pixel may fit by itself and the cube may not: what each pixel hides in its noise adds up. At the fit of pixel i, with whitened
//! residual ρᵢ = (I − QᵢQᵢᵀ)(n − N)/σ ([`super::tangent`]: what its temperature and lighting explain is taken out),
//!
//! * p of χ² = ρ·ρ with as many degrees of freedom as bands less columns of Q is uniform; the mean of n of them is ½ ± 1/√(12 n);
//! * Σᵢ ρᵢ_w has the variance Σᵢ kᵢ_w, kᵢ_w = 1 − ΣQᵢ_w²: the residual that pixels have in common in band w;
//! * along a cause θ ([`super::cause`]), with dᵢ its slope without what temperature and lighting explain, the score is s = Σ dᵢ·ρᵢ and the
//!   information J = Σ dᵢ·dᵢ. θ̂ = J⁻¹s is the estimate of θ together with all temperatures and lightings (one step of maximum
//!   likelihood), s²/J what χ² gains by it; a temperature moves by θ̂ g·(∂N/∂θ)/σ, g its row.
//!
//! Pixels that fit nothing by themselves (p below [`NO_FIT`]) are left out of the first sums, as a material that is missing is no fault
//! of the rest; the p of what is left is uniform from there on. In the second sums, for where most pixels fit nothing, they count
//! with the weight of a residual of [`FAR`] deviations of χ².
//!
//! Stated errors ε of the emissivities, of covariance Σ (bands of one material), are the same in all pixels of a material. They move s by
//! Σₘ aₘ·ε, aₘ_w = Σᵢ dᵢ_w rᵢ_w/σᵢ_w over its pixels, r = e (κB(T) − X) the counts of an error of 1: its variance is J + Σₘ aₘᵀ Σ aₘ, which
//! takes the place of J in s²/J.
//!
//! Beside unknowns that the whole cube shares and that were estimated with the pixels ([`super::shared`], covariance C), a cause keeps
//! J_aa − J_aθ C J_θa of its information, and a temperature moves by what the cause does less what the unknowns that follow it do.
//!
//! Where a surface sends what it would reflect, its temperature is so uncertain that its counts bend ([`STRAIGHT`]): what the fit leaves of a
//! right model then leans to one side, in all such pixels alike. Their bend ∂²N/∂T² is taken out like a column of Q.
//!
//! Assumption: the material of a pixel with one candidate is right.

use super::cause::Cause;
use super::effect::Effect;
use super::library_error::LibraryError;
use super::maps::{Maps, check_bands};
use super::pixel::{NO_FIT, NO_MATERIAL, flag};
use super::setting::Setting;
use super::tangent::{Tangent, Tangents, dot};
use hadar::correlation::matern;
use hadar::cube::{CubeRef, Rows, Sample};
use hadar::error::{Error, Result};
use hadar::parallel;
use hadar::statistics::chi_square_survival;

/// Deviations of χ² above its mean from which on a residual weighs less.
const FAR: f64 = 4.0;

/// How far counts may be off their tangents one deviation of the temperature away, in deviations of the noise.
const STRAIGHT: f64 = 1e-3;

/// Share of a cause's information from which on it is one of its own beside those that are estimated with the pixels.
const ONE: f64 = 1e-4;

/// Rows whose sums are in memory at once.
const ROWS: usize = 16;

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
    /// What stated errors of the library add to the variance of s.
    pub of_library: Vec<f64>,
    /// Σ of the squares of what a unit of each cause does to a temperature, in its deviations.
    pub moved: Vec<f64>,
    /// a of every material, cause and band; empty without stated errors.
    lean: Vec<f64>,
    /// a of every shared unknown and band, of errors that all pixels have alike ([`super::alike`]).
    pub(super) alike: Vec<f64>,
    /// The last of the causes, which are estimated with the pixels ([`super::shared`]).
    shared: usize,
    /// By how much each of these follows a unit of each cause, if it was taken for nothing.
    follow: Vec<Vec<f64>>,
    /// J, the same of `of_library` and of `moved`, of each cause with each of the shared ones: `[cause][shared]`.
    pub(super) cross: Cross,
}

/// Products of each cause with each of those that are shared, `[cause][shared]`.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Cross {
    pub(super) information: Vec<f64>,
    pub(super) of_library: Vec<f64>,
    moved: Vec<f64>,
}

impl Together {
    fn new(bands: usize, [causes, shared]: [usize; 2], materials: usize) -> Self {
        let each = vec![0.0; causes * shared];
        Self {
            shared,
            cross: Cross { information: each.clone(), of_library: each.clone(), moved: each },
            residual: vec![[0.0; 2]; bands],
            score: vec![0.0; causes],
            information: vec![0.0; causes],
            of_library: vec![0.0; causes],
            moved: vec![0.0; causes],
            lean: vec![0.0; materials * causes * bands],
            alike: vec![0.0; shared * bands],
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
        for (to, from) in [
            (&mut self.score, &other.score),
            (&mut self.information, &other.information),
            (&mut self.moved, &other.moved),
            (&mut self.lean, &other.lean),
            (&mut self.alike, &other.alike),
            (&mut self.cross.information, &other.cross.information),
            (&mut self.cross.moved, &other.cross.moved),
        ] {
            to.iter_mut().zip(from).for_each(|(to, from)| *to += from);
        }
    }

    /// Puts what errors of covariance `sigma` (`[band][band]`) do to the scores in the place of what they lean on.
    fn with_library(&mut self, sigma: &[f64]) {
        let (causes, bands) = (self.score.len(), self.residual.len().max(1));
        for of_material in std::mem::take(&mut self.lean).chunks(causes.max(1) * bands) {
            let lean = |cause: usize| &of_material[cause * bands..][..bands];
            let images: Vec<Vec<f64>> = (0..causes)
                .map(|cause| sigma.chunks(bands).map(|row| dot(row, lean(cause))).collect())
                .collect();
            for (a, image) in images.iter().enumerate() {
                self.of_library[a] += dot(image, lean(a));
                for k in 0..self.shared {
                    self.cross.of_library[a * self.shared + k] += dot(image, lean(causes - self.shared + k));
                }
            }
        }
    }

    /// What each cause has beside those that were estimated with the pixels, which are no causes any more; `rest` is what their scores leave
    /// of their own equations, `image` a vector times their covariance.
    pub(super) fn beside(&mut self, rest: &dyn Fn(&[f64]) -> Vec<f64>, image: &dyn Fn(&[f64]) -> Vec<f64>) {
        let count = self.shared;
        let kept = self.score.len() - count;
        // What is left of their own equations where they were settled.
        let rest_of_shared = rest(&self.score[kept..]);
        for a in 0..kept {
            let row = |of: &[f64], a: usize| -> Vec<f64> { of[a * count..][..count].to_vec() };
            let (information, library, moved) =
                (row(&self.cross.information, a), row(&self.cross.of_library, a), row(&self.cross.moved, a));
            // By how much the shared ones follow a unit of the cause.
            let follow = image(&information);
            self.score[a] -= dot(&follow, &rest_of_shared);
            let own = self.information[a];
            let rest = own - dot(&information, &follow);
            // What is left of one that a shared unknown is as well is rounding.
            self.information[a] = if rest > ONE * own { rest } else { 0.0 };
            let square = |of: &[f64], own: f64, row: &[f64]| {
                let each = (0..count).map(|k| follow[k] * dot(&follow, &of[(kept + k) * count..][..count]));
                (own - 2.0 * dot(row, &follow) + each.sum::<f64>()).max(0.0)
            };
            self.of_library[a] = square(&self.cross.of_library, self.of_library[a], &library);
            self.moved[a] = square(&self.cross.moved, self.moved[a], &moved);
            self.follow.push(follow);
        }
        [&mut self.score, &mut self.information, &mut self.of_library, &mut self.moved]
            .into_iter()
            .for_each(|all| all.truncate(kept));
    }

    /// A cause alone; nothing where the pixels do not tell.
    #[must_use]
    pub fn alone(&self, cause: usize) -> Option<Alone> {
        let (information, score) = (*self.information.get(cause)?, *self.score.get(cause)?);
        let var = information + self.of_library.get(cause)?;
        (information > 0.0).then(|| Alone {
            estimate: score / information,
            sigma: var.sqrt() / information,
            gain_chi_square: score * (score / var),
        })
    }

    /// By how many of its deviations a temperature moves where a cause is as it is estimated, rms over the pixels.
    #[must_use]
    pub fn temperature_moved(&self, cause: usize) -> f64 {
        let estimate = self.alone(cause).map_or(0.0, |found| found.estimate.abs());
        let square = self.moved.get(cause).copied().unwrap_or(0.0) / self.pixels.max(1) as f64;
        estimate * square.sqrt()
    }

    /// By how much each of the unknowns that were estimated with the pixels is off for a unit of a cause; nothing without such.
    #[must_use]
    pub fn follow(&self, cause: usize) -> &[f64] {
        self.follow.get(cause).map_or(&[], Vec::as_slice)
    }

    /// Deviations of the mean p-value below that of a right model.
    #[must_use]
    pub fn p_deviations(&self) -> f64 {
        p_deviations(self.p_values, self.pixels)
    }
}

/// Estimate of a cause alone, together with all temperatures and lightings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Alone {
    /// By how much.
    pub estimate: f64,
    /// Its deviation.
    pub sigma: f64,
    /// What χ² gains by it; with stated errors of the library the square of the estimate in its deviations.
    pub gain_chi_square: f64,
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

/// The sums, those of `shared` after those of `causes`.
pub(super) fn sums<'c>(
    setting: &Setting<'_>,
    (causes, shared): (&[Cause], &[Cause]),
    error: Option<LibraryError>,
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
        ("deviations of the maps", maps.temperature_sigma_k.len(), pixels),
        ("candidates of the maps", maps.candidates.len(), pixels),
        ("flags of the maps", maps.flags.len(), pixels),
        ("lighting factors of the maps", maps.lighting.len(), pixels * lights),
    ] {
        if found != expected {
            return Err(Error::Length { what: what.into(), found, expected });
        }
    }
    let tangents = Tangents::new(setting)?;
    let effects = causes.iter().chain(shared).map(|cause| Effect::new(cause, setting, &tangents));
    let effects = effects.collect::<Result<Vec<_>>>()?;
    let nu = tangents.centres_cm1.clone();
    let materials = error.map_or(0, |_| setting.library.len());
    let judge = Judge {
        tangents,
        effects,
        shared: shared.len(),
        maps,
        lights,
        materials,
        per_unit: 1.0 / setting.units_per_count,
    };
    let mut found = match cube {
        CubeRef::F32(rows) => judge.whole(rows),
        CubeRef::F64(rows) => judge.whole(rows),
    }?;
    if let Some(LibraryError { relative, correlation_cm1 }) = error {
        let of = |a: f64| nu.iter().map(move |b| relative * relative * matern(a - b, correlation_cm1));
        let sigma: Vec<f64> = nu.iter().flat_map(|a| of(*a)).collect();
        [&mut found.fitting, &mut found.all].into_iter().for_each(|sums| sums.with_library(&sigma));
    }
    Ok(found)
}

struct Judge<'a> {
    tangents: Tangents,
    effects: Vec<Effect>,
    /// The last of them, which are estimated with the pixels.
    shared: usize,
    maps: &'a Maps,
    lights: usize,
    /// Materials with stated errors.
    materials: usize,
    per_unit: f64,
}

impl Judge<'_> {
    fn whole<S: Sample>(&self, cube: &dyn Rows<S>) -> Result<Judged> {
        let shape = cube.shape();
        let sums = || {
            let (bands, causes) = (self.tangents.used.len(), [self.effects.len(), self.shared]);
            [(); 2].map(|()| Together::new(bands, causes, self.materials))
        };
        let of_row = |(room, buffer): &mut (Room, Vec<S>), row: usize| -> Result<[Together; 2]> {
            let mut sums = sums();
            let samples = cube.read(row..row + 1, buffer)?;
            for (column, sample) in samples.chunks(shape.bands()).enumerate() {
                hadar::stop::check();
                self.pixel(row * shape.columns() + column, sample, room, &mut sums);
            }
            Ok(sums)
        };
        let mut all = sums();
        for first in (0..shape.rows()).step_by(ROWS) {
            let count = ROWS.min(shape.rows() - first);
            let room = || (Room::default(), Vec::new());
            let rows = parallel::try_map_with(count, room, |own, row| of_row(own, first + row))?;
            rows.iter().for_each(|row| all.iter_mut().zip(row).for_each(|(sum, row)| sum.add(row)));
        }
        let [fitting, all] = all;
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
        let temperature_k = f64::from(maps.temperature_k[i]);
        if !tangents.at(m, temperature_k, lit, tangent) {
            return;
        }
        let sigma_k = f64::from(maps.temperature_sigma_k[i]);
        tangents.bend((m, temperature_k, lit), sigma_k, STRAIGHT, tangent);
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
        let reach = match self.materials {
            0 => Vec::new(),
            _ => tangents.reach(lit, tangent),
        };
        moved.clear();
        for (effect, slope) in self.effects.iter().zip(slopes.iter_mut()) {
            effect.slope(tangents, (m, temperature_k, lit), tangent, slope);
            moved.push(if sigma_k > 0.0 && sigma_k.is_finite() { dot(&row, slope) / sigma_k } else { 0.0 });
            tangent.take_out(slope);
        }
        let weight = ((freedom + FAR * (2.0 * freedom).sqrt()) / chi_square).min(1.0);
        // With stated errors their own p-value says it.
        let fits = match self.materials {
            0 => p_value >= NO_FIT,
            _ => maps.flags[i] & flag::NO_FIT == 0,
        };
        for (sums, weight) in [(all, weight)].into_iter().chain(fits.then_some((fitting, 1.0))) {
            sums.pixels += 1;
            sums.p_values += p_value;
            sums.chi_square += weight * chi_square;
            sums.freedom += freedom;
            for (w, (residual, rho)) in sums.residual.iter_mut().zip(rho.iter()).enumerate() {
                residual[0] += weight * rho;
                residual[1] += weight * tangent.kept(w);
            }
            let shared = slopes.iter().skip(slopes.len() - self.shared);
            for (alike, one) in sums.alike.chunks_mut(rho.len().max(1)).zip(shared) {
                for (alike, (d, sigma)) in alike.iter_mut().zip(one.iter().zip(&tangent.sigma)) {
                    *alike += weight * d / sigma;
                }
            }
            for (a, one) in slopes.iter().enumerate() {
                sums.score[a] += weight * dot(one, rho);
                sums.moved[a] += moved[a] * moved[a];
                sums.information[a] += weight * dot(one, one);
                let first = slopes.len() - self.shared;
                for (k, other) in slopes[first..].iter().enumerate() {
                    sums.cross.information[a * self.shared + k] += weight * dot(one, other);
                    sums.cross.moved[a * self.shared + k] += moved[a] * moved[first + k];
                }
                let lean = &mut sums.lean[..];
                let from = (m * slopes.len() + a) * one.len();
                for (lean, (d, reach)) in lean.iter_mut().skip(from).zip(one.iter().zip(&reach)) {
                    *lean += weight * d * reach;
                }
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
pub(super) mod tests;
