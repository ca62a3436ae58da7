//! How the counts of a pixel change with its temperature and lighting, made orthonormal in units of their noise.
//!
//! A = D^(−1/2) ∂N/∂(T, V) = Q R, with D = N + σ² (counts²) the variances of the bands at the fit. What is linear in temperature and
//! lighting, L = ℓ·(T, V), follows the counts by the row g = Q R⁻ᵀ ℓ of whitened counts: its variance is g·g, the Cramér–Rao bound. What
//! the fit leaves of whitened counts ρ is (I − Q Qᵀ)ρ; of unit noise its variance in band w is 1 − Σ Q_w².
//!
//! Columns are scaled to 1 first; one that the others before it make up within 1e-9 is left out, and an L that would need it has no row.
//! Where ΣV is known (S48) the lighting that is first has what the others leave of it.

use super::model::{Light, Model, Setting};
use hadar::error::{Error, Result};
use hadar::planck::photon_radiance_and_slope_into;

/// What is left of a column of length 1 that counts as none of its own.
const DEPENDENT: f64 = 1e-9;
/// By how much an L may differ from what is left of a dependent column, of its largest part.
const AGREES: f64 = 1e-6;

/// What is the same for all pixels. Values are those of the bands that count.
#[derive(Debug)]
pub(super) struct Tangents<'a> {
    setting: Setting<'a>,
    /// Bands that count.
    pub(super) used: Vec<usize>,
    /// Radiance of each of the surroundings in each band, photons s⁻¹ m⁻² sr⁻¹.
    pub(super) lights: Vec<Vec<f64>>,
    /// Counts that each material scatters of each of the surroundings at V = 1: `[material][surroundings][band]`.
    scattered: Vec<Vec<Vec<f64>>>,
    /// Whether a light is given in counts of the same camera.
    counted: Vec<bool>,
    /// Counts for each unit of incident light in a band, κ(1 − e): `[material][band]`.
    pub(super) reflected: Vec<Vec<f64>>,
    /// Counts for each unit of radiance in a band, κ.
    pub(super) counts_per_radiance: Vec<f64>,
    /// Mean wavenumber of each band, cm⁻¹, and its width, cm⁻¹.
    pub(super) centres_cm1: Vec<f64>,
    pub(super) widths_cm1: Vec<f64>,
}

/// A pixel's counts and their columns.
#[derive(Debug, Default)]
pub(super) struct Tangent {
    /// Mean counts of the fit.
    pub(super) mean: Vec<f64>,
    /// Their deviations.
    pub(super) sigma: Vec<f64>,
    /// Orthonormal columns.
    pub(super) q: Vec<Vec<f64>>,
    /// Columns of R in terms of those before them; the last entry of each is its own.
    r: Vec<(Vec<f64>, bool)>,
    scales: Vec<f64>,
}

impl<'a> Tangents<'a> {
    /// # Errors
    /// An impossible setting; an unknown gain, which maps do not keep.
    pub(super) fn new(setting: &Setting<'a>) -> Result<Self> {
        if setting.gain {
            let found = "an unknown scale of the counts, of which no light can be told";
            return Err(Error::malformed(found, "calibrate the camera: leave unknown.gain out"));
        }
        let Model { used, centres_cm1, .. } = Model::new(setting)?;
        let pick = |all: Vec<f64>| -> Vec<f64> { used.iter().map(|band| all[*band]).collect() };
        let (bands, widths) = (setting.bands, pick(setting.bands.widths_cm1()));
        let kappa = pick(setting.counts_per_radiance.to_vec());
        let per = |counts: Vec<f64>| -> Vec<f64> { counts.iter().zip(&kappa).map(|(n, k)| n / k).collect() };
        let lights: Vec<Vec<f64>> = setting
            .surroundings
            .iter()
            .map(|light| match light {
                Light::Radiance(radiance) => pick(bands.weigh(radiance)),
                Light::Counts(counts) => per(pick(counts.clone())),
            })
            .collect();
        let mut reflected = Vec::with_capacity(setting.library.len());
        let mut scattered = Vec::with_capacity(setting.library.len());
        for emissivity in setting.library {
            let rest: Vec<f64> = emissivity.iter().map(|e| 1.0 - e).collect();
            let mean: Vec<f64> = pick(bands.weigh(&rest)).iter().zip(&widths).map(|(r, w)| r / w).collect();
            let of = |(light, sent): (&Light, &Vec<f64>)| -> Vec<f64> {
                let radiance = match light {
                    Light::Radiance(radiance) => {
                        pick(bands.weigh(&radiance.iter().zip(&rest).map(|(s, r)| s * r).collect::<Vec<_>>()))
                    }
                    Light::Counts(_) => sent.iter().zip(&mean).map(|(s, r)| s * r).collect(),
                };
                radiance.iter().zip(&kappa).map(|(s, k)| s * k).collect()
            };
            scattered.push(setting.surroundings.iter().zip(&lights).map(of).collect());
            reflected.push(mean.iter().zip(&kappa).map(|(r, k)| r * k).collect());
        }
        let counted = setting.surroundings.iter().map(|light| matches!(light, Light::Counts(_))).collect();
        Ok(Self {
            setting: *setting,
            used,
            lights,
            scattered,
            counted,
            reflected,
            counts_per_radiance: kappa,
            centres_cm1,
            widths_cm1: widths,
        })
    }

    /// The library.
    pub(super) fn materials(&self) -> usize {
        self.setting.library.len()
    }

    /// Counts that material `m` scatters of light `k` at V = 1.
    pub(super) fn scattered_of(&self, m: usize, k: usize) -> &[f64] {
        self.scattered.get(m).and_then(|own| own.get(k)).map_or(&[], Vec::as_slice)
    }

    /// Whether light `k` is given in counts of the same camera.
    pub(super) fn is_counted(&self, k: usize) -> bool {
        self.counted.get(k).copied().unwrap_or(false)
    }

    /// Columns of a pixel of material `m`; false where it has no temperature or lighting.
    pub(super) fn at(&self, m: usize, temperature_k: f64, lighting: &[f64], to: &mut Tangent) -> bool {
        let (Some(emissivity), Some(scattered)) = (self.setting.library.get(m), self.scattered.get(m)) else {
            return false;
        };
        if !(temperature_k > 0.0 && lighting.iter().all(|v| v.is_finite())) {
            return false;
        }
        let nodes = self.setting.bands.nodes_cm1();
        let (mut value, mut slope) = (vec![0.0; nodes.len()], vec![0.0; nodes.len()]);
        photon_radiance_and_slope_into(nodes, temperature_k, &mut value, &mut slope);
        let counts = |of: &[f64]| -> Vec<f64> {
            let emitted: Vec<f64> = of.iter().zip(emissivity).map(|(b, e)| b * e).collect();
            let all = self.setting.bands.weigh(&emitted);
            self.used.iter().zip(&self.counts_per_radiance).map(|(band, k)| k * all[*band]).collect()
        };
        to.mean = counts(&value);
        for (v, light) in lighting.iter().zip(scattered) {
            to.mean.iter_mut().zip(light).for_each(|(n, c)| *n += v * c);
        }
        let var = |band: usize| self.setting.var_added.get(band).copied().unwrap_or(0.0);
        to.sigma.clear();
        to.sigma.extend(
            to.mean.iter().zip(&self.used).map(|(n, band)| (n.max(0.0) + var(*band)).sqrt().max(1e-150)),
        );
        to.q.clear();
        to.r.clear();
        to.scales.clear();
        to.push(counts(&slope));
        let known = self.first_is_rest();
        for light in scattered.iter().skip(usize::from(known)) {
            match scattered.first().filter(|_| known) {
                Some(first) => to.push(light.iter().zip(first).map(|(a, b)| a - b).collect()),
                None => to.push(light.clone()),
            }
        }
        true
    }

    /// What an error of 1 of the emissivity, as a share of it, does to the counts of a pixel, in deviations of each band:
    /// e (κB(T) − X)/σ = (N − X)/σ, as N = e κB(T) + (1 − e)X.
    pub(super) fn reach(&self, lighting: &[f64], tangent: &Tangent) -> Vec<f64> {
        let each = tangent.mean.iter().zip(&tangent.sigma).enumerate();
        each.map(|(w, (n, sigma))| {
            let incident: f64 = self.lights.iter().zip(lighting).map(|(light, v)| v * light[w]).sum();
            (n - self.counts_per_radiance[w] * incident) / sigma
        })
        .collect()
    }

    fn first_is_rest(&self) -> bool {
        self.setting.lighting_total.is_some() && !self.setting.surroundings.is_empty()
    }

    /// ℓ of ΣVₖ aₖ in the order of the columns.
    pub(super) fn of_lighting(&self, a: &[f64]) -> Vec<f64> {
        let mut all = vec![0.0];
        match a.first().filter(|_| self.first_is_rest()) {
            Some(first) => all.extend(a.iter().skip(1).map(|a| a - first)),
            None => all.extend(a),
        }
        all
    }

    /// ℓ of the temperature.
    pub(super) fn of_temperature(&self) -> Vec<f64> {
        let mut all = self.of_lighting(&vec![0.0; self.lights.len()]);
        all[0] = 1.0;
        all
    }
}

impl Tangent {
    /// Adds a column of ∂N.
    fn push(&mut self, mut column: Vec<f64>) {
        column.iter_mut().zip(&self.sigma).for_each(|(d, sigma)| *d /= sigma);
        let length = dot(&column, &column).sqrt();
        let scale = if length > 0.0 { length } else { 1.0 };
        column.iter_mut().for_each(|d| *d /= scale);
        let mut parts = vec![0.0; self.q.len()];
        // Twice is enough: what rounding left of the others goes the second time.
        for _ in 0..2 {
            for (part, q) in parts.iter_mut().zip(&self.q) {
                let along = dot(q, &column);
                *part += along;
                column.iter_mut().zip(q).for_each(|(d, q)| *d -= along * q);
            }
        }
        let rest = dot(&column, &column).sqrt();
        let own = rest > DEPENDENT;
        if own {
            column.iter_mut().for_each(|d| *d /= rest);
            self.q.push(column);
            parts.push(rest);
        }
        self.r.push((parts, own));
        self.scales.push(scale);
    }

    /// The row g of whitened counts that L = ℓ·(T, V) follows; `None` where the counts do not tell it.
    pub(super) fn row(&self, l: &[f64]) -> Option<Vec<f64>> {
        let mut y: Vec<f64> = Vec::with_capacity(self.q.len());
        let mut largest = 0.0_f64;
        let scaled: Vec<f64> = l.iter().zip(&self.scales).map(|(l, scale)| l / scale).collect();
        for (l, (parts, own)) in scaled.iter().zip(&self.r) {
            largest = largest.max(l.abs());
            let known: f64 = parts.iter().zip(&y).map(|(r, y)| r * y).sum();
            match parts.last().filter(|_| *own) {
                Some(diagonal) => y.push((l - known) / diagonal),
                None if (l - known).abs() <= AGREES * largest => {}
                None => return None,
            }
        }
        let mut row = vec![0.0; self.sigma.len()];
        for (y, q) in y.iter().zip(&self.q) {
            row.iter_mut().zip(q).for_each(|(g, q)| *g += y * q);
        }
        Some(row)
    }

    /// Takes out of whitened counts what temperature and lighting explain.
    pub(super) fn take_out(&self, rho: &mut [f64]) {
        for q in &self.q {
            let along = dot(q, rho);
            rho.iter_mut().zip(q).for_each(|(rho, q)| *rho -= along * q);
        }
    }

    /// Variance that unit noise keeps in band `w` then.
    pub(super) fn kept(&self, w: usize) -> f64 {
        (1.0 - self.q.iter().map(|q| q[w] * q[w]).sum::<f64>()).max(0.0)
    }
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
