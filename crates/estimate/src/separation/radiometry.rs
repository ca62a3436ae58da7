//! Counts of a cube as mean radiances of its bands.
//!
//! L_w = (n_w − κ_w P_w)/(κ_w Δ_w): counts n, κ counts for each unit of band signal, P what the air before the camera sends itself, Δ = ∫τ dν
//! of its transmittance τ over the band (cm⁻¹), P = 0 and τ = 1 where there is none. Radiances of a band are means with the weight τ. Bands
//! of which less than [`CLEAR`] comes through do not count. An emissivity is one number for a band. The surroundings are vertices as in [`crate::decompose`]: darkness first where the lighting adds up to at most 1.

use crate::decompose::{Light, Setting};
use hadar::planck;

/// Least mean transmittance of a band that tells of what is behind the air.
const CLEAR: f64 = 0.01;

/// What is the same for all pixels, one value for each band that counts.
#[derive(Debug)]
pub(super) struct Radiometry<'a> {
    setting: Setting<'a>,
    /// Bands that count.
    pub(super) used: Vec<usize>,
    /// Mean wavenumbers of all bands, cm⁻¹.
    pub(super) centres_cm1: Vec<f64>,
    /// Those of the bands that count.
    pub(super) wavenumbers_cm1: Vec<f64>,
    /// τ at the nodes; empty without air.
    through: Vec<f64>,
    /// Δ of all bands.
    widths_cm1: Vec<f64>,
    /// κ Δ.
    pub(super) counts: Vec<f64>,
    /// κ P.
    pub(super) of_air: Vec<f64>,
    /// Variance of electronic noise, counts².
    pub(super) var_added: Vec<f64>,
    /// Mean radiance of each of the surroundings.
    pub(super) lights: Vec<Vec<f64>>,
    /// Whether their lighting adds up to a known total.
    pub(super) total: Option<f64>,
}

impl<'a> Radiometry<'a> {
    /// Of a setting that was checked.
    pub(super) fn new(setting: &Setting<'a>) -> Self {
        let bands = setting.bands;
        let plain_cm1 = bands.widths_cm1();
        let centres_cm1: Vec<f64> =
            bands.weigh(bands.nodes_cm1()).iter().zip(&plain_cm1).map(|(sum, width)| sum / width).collect();
        let through = setting.path.map_or_else(Vec::new, |path| path.transmittance.clone());
        let widths_cm1 = if through.is_empty() { plain_cm1.clone() } else { bands.weigh(&through) };
        let air = setting.path.map_or_else(|| vec![0.0; bands.len()], |path| bands.weigh(&path.radiance));
        let is_clear = |band: &usize| widths_cm1[*band] > CLEAR * plain_cm1[*band];
        let used: Vec<usize> =
            (0..bands.len()).filter(|band| !setting.bad_bands.contains(band) && is_clear(band)).collect();
        let light = |light: &Light| -> Vec<f64> {
            let all: Vec<f64> = match light {
                Light::Radiance(nodes) => {
                    let sums = bands.weigh(&behind(nodes.clone(), &through));
                    sums.iter().zip(&widths_cm1).map(|(sum, width)| sum / width).collect()
                }
                Light::Counts(counts) => counts
                    .iter()
                    .zip(setting.counts_per_radiance.iter().zip(&widths_cm1))
                    .map(|(n, (per, width))| n / (per * width))
                    .collect(),
            };
            used.iter().map(|band| all[*band]).collect()
        };
        Self {
            lights: setting.surroundings.iter().map(light).collect(),
            wavenumbers_cm1: used.iter().map(|band| centres_cm1[*band]).collect(),
            counts: used.iter().map(|band| setting.counts_per_radiance[*band] * widths_cm1[*band]).collect(),
            var_added: used.iter().map(|band| setting.var_added.get(*band).copied().unwrap_or(0.0)).collect(),
            of_air: used.iter().map(|band| setting.counts_per_radiance[*band] * air[*band]).collect(),
            total: setting.lighting_total.filter(|_| !setting.surroundings.is_empty()),
            setting: *setting,
            used,
            centres_cm1,
            through,
            widths_cm1,
        }
    }

    /// B(T) and its slope.
    pub(super) fn blackbody(&self, temperature_k: f64) -> [Vec<f64>; 2] {
        let nodes = self.setting.bands.nodes_cm1();
        let (mut value, mut slope) = (vec![0.0; nodes.len()], vec![0.0; nodes.len()]);
        planck::photon_radiance_and_slope_into(nodes, temperature_k, &mut value, &mut slope);
        [value, slope].map(|values| {
            let sums = self.setting.bands.weigh(&behind(values, &self.through));
            self.used.iter().map(|band| sums[*band] / self.widths_cm1[*band]).collect()
        })
    }

    /// Equal shares of the surroundings, as bright as they can be.
    pub(super) fn even_lighting(&self) -> Vec<f64> {
        let count = self.lights.len();
        vec![self.total.unwrap_or(1.0) / count.max(1) as f64; count]
    }

    /// Lightings that stand for all that are possible: each of the surroundings alone (and darkness, where they may add up to less), steps
    /// between two of them, and equal shares.
    pub(super) fn lightings(&self) -> Vec<Vec<f64>> {
        let count = self.lights.len();
        let total = self.total.unwrap_or(1.0);
        let mut vertices: Vec<Vec<f64>> =
            (0..count).map(|k| (0..count).map(|own| if own == k { total } else { 0.0 }).collect()).collect();
        if self.total.is_none() {
            vertices.push(vec![0.0; count]);
        }
        let shares: &[f64] = if vertices.len() < 3 { &[0.25, 0.5, 0.75] } else { &[0.5] };
        let mut all = vertices.clone();
        for (i, a) in vertices.iter().enumerate() {
            for b in &vertices[i + 1..] {
                let mixed = |share: &f64| a.iter().zip(b).map(|(a, b)| a + share * (b - a)).collect();
                all.extend(shares.iter().map(mixed));
            }
        }
        all.push(self.even_lighting());
        all
    }

    /// X under a lighting.
    pub(super) fn light(&self, lighting: &[f64]) -> Vec<f64> {
        let mut sum = vec![0.0; self.used.len()];
        for (light, v) in self.lights.iter().zip(lighting) {
            sum.iter_mut().zip(light).for_each(|(sum, light)| *sum += v * light);
        }
        sum
    }

    /// What more of one of the surroundings brings, at the cost of the first one where the total is known.
    pub(super) fn changes(&self) -> Vec<Vec<f64>> {
        match (self.total, self.lights.split_first()) {
            (Some(_), Some((first, others))) => others
                .iter()
                .map(|light| light.iter().zip(first).map(|(light, first)| light - first).collect())
                .collect(),
            _ => self.lights.clone(),
        }
    }

    /// L of counts, and its deviation.
    pub(super) fn radiance(&self, counts: &[f64]) -> [Vec<f64>; 2] {
        let each = || counts.iter().zip(self.counts.iter().zip(&self.var_added));
        let sigma = each().map(|(n, (per, var))| (n.max(0.0) + var).max(1.0).sqrt() / per);
        let radiance = each().zip(&self.of_air).map(|((n, (per, _)), air)| (n - air) / per);
        [radiance.collect(), sigma.collect()]
    }

    /// An emissivity of every band at the nodes.
    pub(super) fn at_nodes(&self, emissivity: &[f64]) -> Vec<f64> {
        self.setting.bands.spread(emissivity)
    }
}

/// What comes through the air of values at the nodes.
fn behind(mut values: Vec<f64>, through: &[f64]) -> Vec<f64> {
    values.iter_mut().zip(through).for_each(|(value, share)| *value *= share);
    values
}
