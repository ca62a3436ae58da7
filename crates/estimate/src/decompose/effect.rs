//! What a unit of a [`Cause`] changes in a pixel's counts: the table of [`super::cause`].

use super::cause::Cause;
use super::setting::{Light, Setting};
use super::tangent::{Tangent, Tangents, dot};
use super::told::{Told, legendre, longer_slope};
use hadar::error::Result;
use hadar::planck::{photon_radiance_and_slope_into, photon_radiance_into};

/// A cause with what of it is the same for all pixels, in the bands that count.
#[derive(Debug)]
pub(super) struct Effect {
    cause: Cause,
    /// Radiance in each band: of the light that a unit of it adds, or of the air.
    radiance: Vec<f64>,
    /// P_w of a shape, what a longer path adds to a light, α_w of the air.
    share: Vec<f64>,
    /// All spectra read higher and lower by [`Effect::step`].
    shifted: Option<Box<[Tangents; 2]>>,
    /// Half of the narrowest band's width, cm⁻¹.
    step: f64,
}

impl Effect {
    pub(super) fn new(cause: &Cause, setting: &Setting<'_>, tangents: &Tangents) -> Result<Self> {
        let bands = setting.bands;
        let pick = |all: Vec<f64>| -> Vec<f64> { tangents.used.iter().map(|band| all[*band]).collect() };
        let radiance = match cause {
            Cause::LightTemperature { light, temperature_k } => {
                let nodes = bands.nodes_cm1();
                let (mut value, mut slope) = (vec![0.0; nodes.len()], vec![0.0; nodes.len()]);
                photon_radiance_and_slope_into(nodes, *temperature_k, &mut value, &mut slope);
                if let Some(Light::Radiance(radiance)) = setting.surroundings.get(*light) {
                    let own = slope.iter_mut().zip(value.iter().zip(radiance));
                    own.for_each(|(d, (b, s))| *d *= if *b > 0.0 { s / b } else { 0.0 });
                }
                let slope = bands.weigh(&slope);
                match setting.surroundings.get(*light) {
                    // Of bands, not of nodes, and as much as it is beside the blackbody.
                    Some(Light::Counts(counts)) => {
                        let of = bands.weigh(&value);
                        let each = slope.iter().zip(&of).zip(counts.iter().zip(setting.counts_per_radiance));
                        pick(
                            each.map(|((d, b), (n, k))| if *b > 0.0 { d * n / (k * b) } else { 0.0 })
                                .collect(),
                        )
                    }
                    _ => pick(slope),
                }
            }
            Cause::LightMissing { temperature_k } | Cause::Air { temperature_k, .. } => {
                let mut radiance = vec![0.0; bands.nodes_cm1().len()];
                photon_radiance_into(bands.nodes_cm1(), *temperature_k, &mut radiance);
                pick(bands.weigh(&radiance))
            }
            _ => Vec::new(),
        };
        let share = match cause {
            Cause::LightShape { order, .. } => {
                let wide = bands.weigh(&legendre(*order, bands.nodes_cm1()));
                pick(wide).iter().zip(&tangents.widths_cm1).map(|(sum, width)| sum / width).collect()
            }
            Cause::LightPath { emissivity, .. } => {
                let slopes: Vec<f64> = emissivity.iter().map(|e| longer_slope(*e)).collect();
                let wide = bands.weigh(&slopes);
                pick(wide).iter().zip(&tangents.widths_cm1).map(|(sum, width)| sum / width).collect()
            }
            Cause::Air { depth_per_m, .. } => {
                let depth = pick(bands.weigh(depth_per_m));
                depth.iter().zip(&tangents.widths_cm1).map(|(depth, width)| depth / width).collect()
            }
            _ => Vec::new(),
        };
        let step = 0.5 * tangents.widths_cm1.iter().copied().fold(f64::INFINITY, f64::min);
        let shifted = match cause {
            Cause::WavelengthShift(_) => {
                let told = Told::of(setting);
                let at = |by: f64| Tangents::new(&told.with(cause, by)?.setting());
                Some(Box::new([at(step)?, at(-step)?]))
            }
            _ => None,
        };
        Ok(Self { cause: cause.clone(), radiance, share, shifted, step })
    }

    /// What a unit of the cause changes of Σₖ aₖVₖ itself, the counts as they are: as a sum that is told.
    pub(super) fn of_lighting(&self, a: &[f64], lighting: &[f64]) -> f64 {
        let total: f64 = lighting.iter().sum();
        match self.cause {
            Cause::LightingTotal if total > 0.0 => {
                a.iter().zip(lighting).map(|(a, v)| a * v).sum::<f64>() / total
            }
            _ => 0.0,
        }
    }

    /// What it changes of Σₖ VₖLₖ in the radiances Lₖ of the lights over all bands.
    pub(super) fn of_lights(&self, tangents: &Tangents, lighting: &[f64]) -> f64 {
        let all = |of: &Tangents, k: usize| of.lights.get(k).map_or(0.0, |light| light.iter().sum::<f64>());
        let lit = |of: &Tangents| lighting.iter().enumerate().map(|(k, v)| v * all(of, k)).sum::<f64>();
        let v = |k: usize| lighting.get(k).copied().unwrap_or(0.0);
        match &self.cause {
            // What a light is from its counts is less by a share that they are more for each unit of radiance.
            Cause::Gain => (0..lighting.len())
                .filter(|k| tangents.is_counted(*k))
                .map(|k| -v(k) * all(tangents, k))
                .sum(),
            Cause::WavelengthShift(_) => {
                let [higher, lower] =
                    self.shifted.as_deref().map_or([0.0; 2], |ends| ends.each_ref().map(lit));
                0.5 * (higher - lower) / self.step
            }
            Cause::LightScale(k) => v(*k) * all(tangents, *k),
            Cause::LightShape { light, .. } | Cause::LightPath { light, .. } => {
                let of_light = tangents.lights.get(*light).map_or(0.0, |light| dot(light, &self.share));
                v(*light) * of_light
            }
            Cause::LightTemperature { light, .. } => v(*light) * self.radiance.iter().sum::<f64>(),
            _ => 0.0,
        }
    }

    /// Slope of the counts of a pixel of material `m` along the cause, in deviations of each band, into `to`.
    pub(super) fn slope(
        &self,
        tangents: &Tangents,
        (m, temperature_k, lighting): (usize, f64, &[f64]),
        tangent: &Tangent,
        to: &mut Vec<f64>,
    ) {
        let kappa = &tangents.counts_per_radiance;
        let mean = &tangent.mean;
        let scattered = |k: usize| tangents.scattered_of(m, k);
        let v = |k: usize| lighting.get(k).copied().unwrap_or(0.0);
        to.clear();
        match &self.cause {
            Cause::Gain => {
                to.extend(mean);
                for k in (0..lighting.len()).filter(|k| tangents.is_counted(*k)) {
                    to.iter_mut().zip(scattered(k)).for_each(|(d, c)| *d -= v(k) * c);
                }
            }
            Cause::WavelengthShift(_) => {
                to.resize(mean.len(), 0.0);
                let mut counts = Vec::new();
                let ends = self.shifted.iter().flat_map(|ends| ends.iter()).zip([0.5, -0.5]);
                for (end, half) in ends {
                    if end.mean((m, temperature_k, lighting), &mut counts).is_some() {
                        to.iter_mut().zip(&counts).for_each(|(d, n)| *d += half * n / self.step);
                    }
                }
            }
            Cause::LightScale(k) => to.extend(scattered(*k).iter().map(|c| v(*k) * c)),
            Cause::LightShape { light, .. } | Cause::LightPath { light, .. } => {
                to.extend(scattered(*light).iter().zip(&self.share).map(|(c, x)| v(*light) * c * x));
            }
            Cause::LightTemperature { light, .. } => {
                to.extend(tangents.reflected[m].iter().zip(&self.radiance).map(|(r, s)| v(*light) * r * s));
            }
            Cause::LightingTotal => {
                let total: f64 = lighting.iter().sum();
                to.resize(mean.len(), 0.0);
                for k in 0..lighting.len() {
                    let share = if total > 0.0 { v(k) / total } else { 0.0 };
                    to.iter_mut().zip(scattered(k)).for_each(|(d, c)| *d += share * c);
                }
            }
            Cause::LightMissing { .. } => {
                to.extend(tangents.reflected[m].iter().zip(&self.radiance).map(|(r, s)| r * s));
            }
            Cause::Air { .. } => {
                let sent = mean.iter().zip(kappa).zip(&self.radiance);
                to.extend(sent.zip(&self.share).map(|(((n, k), b), depth)| -depth * (n - k * b)));
            }
            Cause::Band(band) => {
                let own = tangents.used.iter().position(|one| one == band);
                to.extend(mean.iter().enumerate().map(|(w, n)| if Some(w) == own { *n } else { 0.0 }));
            }
        }
        to.iter_mut().zip(&tangent.sigma).for_each(|(d, sigma)| *d /= sigma);
    }
}
