//! Emissivities to start from: groups of pixels whose spectra look alike, each with a magnitude in each part of [0, 1].
//!
//! A pixel's emissivity is that of NEM under the lighting which leaves it smoothest, and its shape β = e/ē. K-means groups β in units of its
//! noise; each group has emissivities fitted to its pixels, from the ε_max of NEM that explains them best in each part. Those
//! whose loss over the pixels is least together are taken, one after the other, then each against every other.

use super::super::k_means::k_means;
use super::super::nem::{Surface, nem, ratio};
use super::fit::Maker;
use hadar::error::Result;
use hadar::parallel;

/// Pixels that are grouped by K-means; the others go to the nearest mean.
const GROUPED: usize = 4_000;
const STARTS: usize = 6;
/// Pixels of a group by which its magnitude is looked for.
const LOOKED: usize = 96;
const MAGNITUDES: [f64; 13] = [0.97, 0.94, 0.9, 0.85, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.12, 0.06];
/// Rounds in which each emissivity is held against all that were not taken.
const EXCHANGES: usize = 3;
/// Parts of [0, 1] in which the magnitude of a group is looked for.
const PARTS: [[f64; 2]; 3] = [[0.0, 0.35], [0.35, 0.8], [0.8, 1.01]];
/// Groups of K-means for each that is asked for, and besides.
const MORE: [usize; 2] = [2, 6];
/// Pixels of a group that its emissivity is fitted to, and those that are compared by all.
const OF_GROUP: usize = 240;
const COMPARED: usize = 1_500;
/// Least emissivity of a start.
const LEAST: f64 = 0.005;

/// Relative emissivities of the pixels that have one, in units of their noise.
pub(super) struct Profiles {
    /// Lightings that were tried.
    lights: Vec<Vec<f64>>,
    pub(super) pixels: Vec<usize>,
    /// Place of each pixel's lighting among them.
    lit: Vec<usize>,
    whitened: Vec<f64>,
}

/// Emissivities to start from, and the loss of each with some pixels.
pub(super) struct Starts {
    curves: Vec<Vec<f64>>,
    losses: Vec<Vec<f64>>,
}

impl Starts {
    /// So many of them, that explain the pixels best together.
    pub(super) fn taken(&self, count: usize) -> Vec<Vec<f64>> {
        chosen(&self.losses, count).into_iter().map(|i| self.curves[i].clone()).collect()
    }
}

/// A pixel's emissivities, their deviations, and how much is wrong with them were they smooth.
struct Alone {
    emissivity: Vec<f64>,
    sigma: Vec<f64>,
    roughness: f64,
}

/// Of emissivities with a loss for each pixel those that explain most together, one after the other, then each against every other.
fn chosen(losses: &[Vec<f64>], count: usize) -> Vec<usize> {
    let pixels = losses.first().map_or(0, Vec::len);
    let least = |of: &[usize]| -> Vec<f64> {
        (0..pixels).map(|p| of.iter().map(|i| losses[*i][p]).fold(f64::INFINITY, f64::min)).collect()
    };
    let with = |i: usize, least: &[f64]| losses[i].iter().zip(least).map(|(own, l)| own.min(*l)).sum::<f64>();
    let best_beside = |taken: &[usize]| {
        let least = least(taken);
        let left = (0..losses.len()).filter(|i| !taken.contains(i));
        left.map(|i| (i, with(i, &least))).min_by(|a, b| a.1.total_cmp(&b.1))
    };
    let mut chosen: Vec<usize> = Vec::new();
    while chosen.len() < count.min(losses.len()) {
        let Some((next, _)) = best_beside(&chosen) else { break };
        chosen.push(next);
        let mut total: f64 = least(&chosen).iter().sum();
        for _ in 0..EXCHANGES {
            let mut changed = false;
            for place in 0..chosen.len() {
                let others: Vec<usize> =
                    chosen.iter().enumerate().filter(|(i, _)| *i != place).map(|(_, own)| *own).collect();
                if let Some((other, loss)) = best_beside(&others)
                    && loss < total * (1.0 - 1e-9)
                {
                    (chosen[place], total, changed) = (other, loss, true);
                }
            }
            if !changed {
                break;
            }
        }
    }
    chosen
}

/// At most so many of some things, evenly.
fn every(all: &[usize], most: usize) -> Vec<usize> {
    all.iter().copied().step_by(all.len().div_ceil(most).max(1)).collect()
}

impl Maker<'_> {
    /// NEM of a pixel.
    fn nem(&self, pixel: usize, light: &[f64], max_emissivity: f64) -> Option<Alone> {
        let r = self.radiometry;
        let [radiance, sigma] = r.radiance(&self.sample.used(pixel, &r.used));
        let surface =
            Surface { wavenumbers_cm1: &r.wavenumbers_cm1, radiance: &radiance, light, sigma: &sigma };
        let found = nem(&surface, max_emissivity)?;
        let [black, _] = r.blackbody(found.temperature_k);
        let error = black.iter().zip(light).zip(&sigma).map(|((b, x), sigma)| (sigma / (b - x)).abs());
        let (e, sigma): (_, Vec<f64>) = (found.emissivity, error.collect());
        let bent = |w: usize| {
            let off = e[w] - (e[w - 1] + e[w + 1]) / 2.0;
            off * off / (sigma[w].powi(2) + (sigma[w - 1].powi(2) + sigma[w + 1].powi(2)) / 4.0)
        };
        let roughness = (1..e.len().max(2) - 1).map(bent).sum();
        e.iter().all(|e| e.is_finite()).then_some(Alone { emissivity: e, sigma, roughness })
    }

    /// Every pixel by itself.
    pub(super) fn profiles(&self) -> Profiles {
        let lights: Vec<Vec<f64>> =
            self.radiometry.lightings().iter().map(|lighting| self.radiometry.light(lighting)).collect();
        let one = |pixel: usize| {
            let each = lights.iter().enumerate().filter_map(|(lit, light)| {
                let found = self.nem(pixel, light, self.asked.max_emissivity)?;
                let mean = found.emissivity.iter().sum::<f64>() / found.emissivity.len() as f64;
                (mean > LEAST).then_some((lit, mean, found))
            });
            let (lit, mean, found) = each.min_by(|a, b| a.2.roughness.total_cmp(&b.2.roughness))?;
            let error: Vec<f64> = found.sigma.iter().map(|sigma| sigma / mean).collect();
            Some((pixel, lit, ratio(&found.emissivity), error))
        };
        let found: Vec<_> = parallel::map(self.sample.pixels(), one).into_iter().flatten().collect();
        let width = self.radiometry.used.len();
        // The median over the pixels: a few next to equilibrium would have all the say.
        let scale: Vec<f64> = parallel::map(width, |w| {
            let mut errors: Vec<f64> = found.iter().map(|one| one.3[w]).collect();
            errors.sort_by(f64::total_cmp);
            errors.get(errors.len() / 2).copied().unwrap_or(1.0).max(f64::MIN_POSITIVE)
        });
        Profiles {
            pixels: found.iter().map(|one| one.0).collect(),
            lit: found.iter().map(|one| one.1).collect(),
            whitened: found.iter().flat_map(|one| one.2.iter().zip(&scale).map(|(b, s)| b / s)).collect(),
            lights,
        }
    }

    /// Emissivities to start from, enough for so many.
    pub(super) fn starts(&self, profiles: &Profiles, count: usize) -> Result<Starts> {
        let width = self.radiometry.used.len();
        let all = profiles.pixels.len();
        let groups = (MORE[0] * count + MORE[1]).min(all);
        let stride = if groups * 4 < GROUPED { all.div_ceil(GROUPED).max(1) } else { 1 };
        let some: Vec<usize> = (0..all).step_by(stride).collect();
        let groups = groups.min(some.len());
        let points: Vec<f64> =
            some.iter().flat_map(|i| &profiles.whitened[i * width..][..width]).copied().collect();
        let means = k_means(&points, width, groups, self.asked.seed, STARTS)?;
        let mut members: Vec<Vec<usize>> = vec![Vec::new(); groups];
        for (i, group) in some.iter().zip(&means.group) {
            members[*group].push(*i);
        }
        members.retain(|group| !group.is_empty());
        let of_group = |group: &Vec<usize>| -> Result<Vec<Vec<f64>>> {
            let own: Vec<usize> = every(group, OF_GROUP);
            let pixels = self.sample.some(&own.iter().map(|i| profiles.pixels[*i]).collect::<Vec<_>>());
            let from = self.magnitudes(profiles, &own)?.into_iter().map(|start| {
                let made = self.fitted(&pixels, vec![start.clone()])?;
                Ok(made.curves.into_iter().next().map_or(start, |curve| curve.emissivity))
            });
            from.collect()
        };
        let curves = parallel::try_map(members.len(), |i| of_group(&members[i]))?.concat();
        // What each costs every pixel.
        let compared = self.sample.some(&every(&profiles.pixels, COMPARED));
        let losses: Vec<Vec<f64>> = parallel::try_map(curves.len(), |i| self.losses(&compared, &curves[i]))?;
        Ok(Starts { curves, losses })
    }

    /// Emissivities of a group by NEM, each with the ε_max of a part of [0, 1] that explains its pixels best: which part is right is
    /// not seen before all bands are fitted.
    fn magnitudes(&self, profiles: &Profiles, group: &[usize]) -> Result<Vec<Vec<f64>>> {
        let some = every(group, LOOKED);
        let pixels = self.sample.some(&some.iter().map(|i| profiles.pixels[*i]).collect::<Vec<_>>());
        let first = self.asked.max_emissivity;
        let all = || std::iter::once(first).chain(MAGNITUDES.into_iter().filter(|m| *m < first));
        let mut starts = Vec::new();
        for [low, high] in PARTS {
            let mut best: Option<(f64, Vec<f64>)> = None;
            for magnitude in all().filter(|m| (low..high).contains(m)) {
                let Some(e) = self.mean_of(profiles, &some, magnitude) else { continue };
                let loss: f64 = self.losses(&pixels, &e)?.iter().sum();
                if best.as_ref().is_none_or(|best| loss < best.0) {
                    best = Some((loss, e));
                }
            }
            starts.extend(best.map(|best| best.1));
        }
        if starts.is_empty() {
            starts.push(self.prior.mean().to_vec());
        }
        Ok(starts)
    }

    /// Mean emissivity of some pixels by NEM, weighted by its information; of all bands.
    fn mean_of(&self, profiles: &Profiles, group: &[usize], max_emissivity: f64) -> Option<Vec<f64>> {
        let width = self.radiometry.used.len();
        let (mut sum, mut weights) = (vec![0.0; width], vec![0.0; width]);
        for i in group {
            let light = &profiles.lights[profiles.lit[*i]];
            let Some(own) = self.nem(profiles.pixels[*i], light, max_emissivity) else { continue };
            for w in 0..width {
                let weight = own.sigma[w].powi(-2);
                sum[w] += weight * own.emissivity[w];
                weights[w] += weight;
            }
        }
        if weights.iter().any(|weight| *weight <= 0.0 || !weight.is_finite()) {
            return None;
        }
        let used: Vec<f64> =
            sum.iter().zip(&weights).map(|(sum, weight)| (sum / weight).clamp(LEAST, 1.0)).collect();
        // A band that does not count has what the nearest one has.
        let of = |band: usize| {
            let near = self.radiometry.used.iter().zip(&used).min_by_key(|(own, _)| own.abs_diff(band));
            near.map_or(self.prior.mean()[band], |(_, e)| *e)
        };
        Some((0..self.prior.mean().len()).map(of).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two that complement each other are better than the one that is best alone.
    #[test]
    fn what_explains_most_together_is_taken() {
        let losses = [vec![2.0, 2.0, 2.0, 2.0], vec![0.0, 0.0, 9.0, 9.0], vec![9.0, 9.0, 0.0, 0.0]];
        assert_eq!(chosen(&losses, 1), [0]);
        let mut two = chosen(&losses, 2);
        two.sort_unstable();
        assert_eq!(two, [1, 2]);
        assert_eq!(chosen(&losses, 7).len(), 3);
        assert!(chosen(&[], 2).is_empty());
    }
}
