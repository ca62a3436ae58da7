//! How the counts of a pixel change with its temperature and lighting, made orthonormal in units of their noise.
//!
//! A = D^(−1/2) ∂N/∂(T, V) = Q R, with D = N + σ² (counts²) the variances of the bands at the fit. What is linear in temperature and
//! lighting, L = ℓ·(T, V), follows the counts by the row g = Q R⁻ᵀ ℓ of whitened counts: its variance is g·g, the Cramér–Rao bound. What
//! the fit leaves of whitened counts ρ is (I − Q Qᵀ)ρ; of unit noise its variance in band w is 1 − Σ Q_w².
//!
//! Columns are scaled to 1 first; one that the others before it make up within 1e-9 is left out, and an L that would need it has no row.
//! Where ΣV is known (S48) the lighting that is first has what the others leave of it.

use super::model::Model;
use super::setting::{Light, Setting};
use hadar::error::{Error, Result};
use hadar::planck::photon_radiance_and_slope_into;
use hadar::spectrum::Bands;

/// What is left of a column of length 1 that counts as none of its own.
const DEPENDENT: f64 = 1e-9;
/// By how much an L may differ from what is left of a dependent column, of its largest part.
const AGREES: f64 = 1e-6;

/// Steps over which a bend is looked at, as shares of the temperature: less is rounding, more is another temperature.
const LEAST_STEP: f64 = 1e-3;
const MOST_STEP: f64 = 2e-2;

/// What is the same for all pixels. Values are those of the bands that count.
#[derive(Debug)]
pub(super) struct Tangents {
    bands: Bands,
    /// Emissivities at the nodes.
    library: Vec<Vec<f64>>,
    /// Electronic noise of each band, counts².
    var_added: Vec<f64>,
    /// Whether the lighting that is first has what the others leave.
    first_is_rest: bool,
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
    /// Counts of each material besides: of light that is always there, and of the air: `[material][band]`.
    besides: Vec<Vec<f64>>,
    /// Light that is always there, radiance in each band; empty for none.
    light_besides: Vec<f64>,
    /// Counts of the air's own light; empty for none.
    pub(super) of_air: Vec<f64>,
    /// Share of the light of a node that comes through; empty for all of it.
    through: Vec<f64>,
    /// Its mean in each band.
    through_band: Vec<f64>,
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

impl Tangents {
    /// # Errors
    /// An impossible setting; an unknown gain, which maps do not keep.
    pub(super) fn new(setting: &Setting<'_>) -> Result<Self> {
        if setting.gain {
            let found = "an unknown scale of the counts, of which no light can be told";
            return Err(Error::malformed(found, "calibrate the camera: leave unknown.gain out"));
        }
        let Model { used, centres_cm1, .. } = Model::new(setting)?;
        let pick = |all: Vec<f64>| -> Vec<f64> { used.iter().map(|band| all[*band]).collect() };
        let (bands, widths) = (setting.bands, pick(setting.bands.widths_cm1()));
        let kappa = pick(setting.counts_per_radiance.to_vec());
        let lights = setting.radiances(&used);
        let through: Vec<f64> = setting.path.map_or_else(Vec::new, |path| path.transmittance.clone());
        let behind = |values: Vec<f64>| -> Vec<f64> {
            let share = |i: usize| through.get(i).copied().unwrap_or(1.0);
            pick(bands.weigh(&values.iter().enumerate().map(|(i, s)| share(i) * s).collect::<Vec<_>>()))
        };
        let per_kappa =
            |radiance: Vec<f64>| -> Vec<f64> { radiance.iter().zip(&kappa).map(|(s, k)| s * k).collect() };
        let of_air = setting.path.map_or_else(Vec::new, |path| per_kappa(pick(bands.weigh(&path.radiance))));
        let light_besides = match setting.light_besides {
            [] => Vec::new(),
            light => pick(bands.weigh(light)),
        };
        let mut besides = Vec::with_capacity(setting.library.len());
        let mut reflected = Vec::with_capacity(setting.library.len());
        let mut scattered = Vec::with_capacity(setting.library.len());
        for emissivity in setting.library {
            let rest: Vec<f64> = emissivity.iter().map(|e| 1.0 - e).collect();
            let mean: Vec<f64> = behind(rest.clone()).iter().zip(&widths).map(|(r, w)| r / w).collect();
            let of = |(light, sent): (&Light, &Vec<f64>)| -> Vec<f64> {
                let radiance = match light {
                    Light::Radiance(radiance) => {
                        behind(radiance.iter().zip(&rest).map(|(s, r)| s * r).collect())
                    }
                    Light::Counts(_) => sent.iter().zip(&mean).map(|(s, r)| s * r).collect(),
                };
                per_kappa(radiance)
            };
            let mut own = match setting.light_besides {
                [] => vec![0.0; kappa.len()],
                light => per_kappa(behind(light.iter().zip(&rest).map(|(s, r)| s * r).collect())),
            };
            own.iter_mut().zip(&of_air).for_each(|(n, air)| *n += air);
            besides.push(own);
            scattered.push(setting.surroundings.iter().zip(&lights).map(of).collect());
            reflected.push(mean.iter().zip(&kappa).map(|(r, k)| r * k).collect());
        }
        let counted = setting.surroundings.iter().map(|light| matches!(light, Light::Counts(_))).collect();
        let through_band =
            behind(vec![1.0; bands.nodes_cm1().len()]).iter().zip(&widths).map(|(t, w)| t / w).collect();
        Ok(Self {
            bands: bands.clone(),
            library: setting.library.to_vec(),
            var_added: setting.var_added.to_vec(),
            first_is_rest: setting.lighting_total.is_some() && !setting.surroundings.is_empty(),
            used,
            lights,
            scattered,
            counted,
            reflected,
            counts_per_radiance: kappa,
            centres_cm1,
            besides,
            light_besides,
            of_air,
            through_band,
            widths_cm1: widths,
            through: setting.path.map_or_else(Vec::new, |path| path.transmittance.clone()),
        })
    }

    /// The library.
    pub(super) fn materials(&self) -> usize {
        self.library.len()
    }

    /// Counts that material `m` scatters of light `k` at V = 1.
    pub(super) fn scattered_of(&self, m: usize, k: usize) -> &[f64] {
        self.scattered.get(m).and_then(|own| own.get(k)).map_or(&[], Vec::as_slice)
    }

    /// Whether light `k` is given in counts of the same camera.
    pub(super) fn is_counted(&self, k: usize) -> bool {
        self.counted.get(k).copied().unwrap_or(false)
    }

    /// Mean counts of a pixel, and their slope with temperature, into `to` and what is returned; `None` where it has no temperature or lighting.
    pub(super) fn mean(
        &self,
        (m, temperature_k, lighting): (usize, f64, &[f64]),
        to: &mut Vec<f64>,
    ) -> Option<Vec<f64>> {
        let (emissivity, scattered) = (self.library.get(m)?, self.scattered.get(m)?);
        if !(temperature_k > 0.0 && lighting.iter().all(|v| v.is_finite())) {
            return None;
        }
        let nodes = self.bands.nodes_cm1();
        let (mut value, mut slope) = (vec![0.0; nodes.len()], vec![0.0; nodes.len()]);
        photon_radiance_and_slope_into(nodes, temperature_k, &mut value, &mut slope);
        let counts = |mut of: Vec<f64>| -> Vec<f64> {
            of.iter_mut().zip(emissivity).for_each(|(b, e)| *b *= e);
            of.iter_mut().zip(&self.through).for_each(|(b, share)| *b *= share);
            let all = self.bands.weigh(&of);
            self.used.iter().zip(&self.counts_per_radiance).map(|(band, k)| k * all[*band]).collect()
        };
        *to = counts(value);
        to.iter_mut().zip(&self.besides[m]).for_each(|(n, own)| *n += own);
        for (v, light) in lighting.iter().zip(scattered) {
            to.iter_mut().zip(light).for_each(|(n, c)| *n += v * c);
        }
        Some(counts(slope))
    }

    /// Columns of a pixel of material `m`; false where it has no temperature or lighting.
    pub(super) fn at(&self, m: usize, temperature_k: f64, lighting: &[f64], to: &mut Tangent) -> bool {
        let Some(slope) = self.mean((m, temperature_k, lighting), &mut to.mean) else { return false };
        let var = |band: usize| self.var_added.get(band).copied().unwrap_or(0.0);
        to.sigma.clear();
        to.sigma.extend(
            to.mean.iter().zip(&self.used).map(|(n, band)| (n.max(0.0) + var(*band)).sqrt().max(1e-150)),
        );
        to.q.clear();
        to.r.clear();
        to.scales.clear();
        to.push(slope);
        let scattered = &self.scattered[m];
        for light in scattered.iter().skip(usize::from(self.first_is_rest)) {
            match scattered.first().filter(|_| self.first_is_rest) {
                Some(first) => to.push(light.iter().zip(first).map(|(a, b)| a - b).collect()),
                None => to.push(light.clone()),
            }
        }
        true
    }

    /// Adds the column ∂²N/∂T² of what the pixel emits, if within a deviation of its temperature the counts are off their tangents by more
    /// than `straight` deviations of the noise.
    pub(super) fn bend(
        &self,
        (m, temperature_k, lighting): (usize, f64, &[f64]),
        sigma_k: f64,
        straight: f64,
        tangent: &mut Tangent,
    ) {
        let step_k = sigma_k.clamp(LEAST_STEP * temperature_k, MOST_STEP * temperature_k);
        let [mut above, mut below] = [(); 2].map(|()| Vec::new());
        if self.mean((m, temperature_k + step_k, lighting), &mut above).is_none()
            || self.mean((m, temperature_k - step_k, lighting), &mut below).is_none()
        {
            return;
        }
        let ends = above.iter().zip(&below).zip(&tangent.mean);
        let bend: Vec<f64> = ends.map(|((a, b), n)| 0.5 * (a + b) - n).collect();
        let mut rest: Vec<f64> = bend.iter().zip(&tangent.sigma).map(|(bend, sigma)| bend / sigma).collect();
        tangent.take_out(&mut rest);
        if dot(&rest, &rest).sqrt() * (sigma_k / step_k).powi(2) > straight {
            tangent.push(bend);
        }
    }

    /// What an error of 1 of the emissivity, as a share of it, does to the counts of a pixel, in deviations of each band:
    /// e (κB(T) − X)/σ = (N − X)/σ, as N = e κB(T) + (1 − e)X, all behind the air, without its own light.
    pub(super) fn reach(&self, lighting: &[f64], tangent: &Tangent) -> Vec<f64> {
        let each = tangent.mean.iter().zip(&tangent.sigma).enumerate();
        each.map(|(w, (n, sigma))| {
            let incident: f64 = self.lights.iter().zip(lighting).map(|(light, v)| v * light[w]).sum();
            let incident = incident + self.light_besides.get(w).copied().unwrap_or(0.0);
            let air = self.of_air.get(w).copied().unwrap_or(0.0);
            (n - air - self.counts_per_radiance[w] * self.through_band[w] * incident) / sigma
        })
        .collect()
    }

    /// ℓ of ΣVₖ aₖ in the order of the columns.
    pub(super) fn of_lighting(&self, a: &[f64]) -> Vec<f64> {
        let mut all = vec![0.0];
        match a.first().filter(|_| self.first_is_rest) {
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
