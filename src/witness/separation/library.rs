//! A library out of a heat cube.
//!
//! 1. Some pixels are drawn. Each has its emissivity by NEM under an even lighting, and β = e/mean(e) by RATIO; pixels without one are
//!    declared and left out.
//! 2. K-means groups β in units of its noise.
//! 3. The magnitude of each group is the ε_max of NEM at which one emissivity, the mean over its pixels, explains its pixels best,
//!    each with a temperature and lighting of its own, beside the prior.
//! 4. Rounds: every pixel goes to the emissivity that explains it best, with its temperature and lighting ([`crate::decompose`]); the
//!    emissivities are fitted to all pixels at once ([`super::group`]); until nothing changes.
//! 5. Where a range of counts is asked for, each has a loss on pixels that were kept apart: the mean over them of
//!    ν ln(χ²/ν) − 2 ln π, χ² the physics loss with ν degrees of freedom, π the share of the pixel's group. The first term is that of a
//!    likelihood with a scale of its own for each pixel, the second what the name of a group costs: a group that is split in two
//!    without need costs 2 ln 2 and gains nothing, so that the loss does not fall for ever. The fewest groups within a
//!    standard error of the least loss are taken.
//!
//! The whole cube is then decomposed by the library.
//!
//! Source: paper, supplement SV C, which chooses K by hand and names the scan over K as future work.

use super::group::{Curve, Information, State, chi_square, states};
use super::k_means::k_means;
use super::nem::{Surface, nem, ratio};
use super::radiometry::Radiometry;
use super::sample::Sample;
use crate::decompose::{Maps, Options, Setting, decompose};
use crate::error::{Error, Result, check};
use crate::fisher::emissivity::{EmissivityPrior, Smoothness};
use crate::ranging::cube::Cube;
use rayon::prelude::*;

/// Pixels that emissivities are fitted to, and those that counts of groups are judged by.
const FITTED: usize = 12_000;
const KEPT: usize = 4_000;
/// Pixels that are grouped by K-means; the others go to the nearest mean.
const GROUPED: usize = 4_000;
const STARTS: usize = 6;
/// Pixels of a group by which its magnitude is looked for.
const LOOKED: usize = 96;
const MAGNITUDES: [f64; 13] = [0.97, 0.94, 0.9, 0.85, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.12, 0.06];
const ROUNDS: usize = 12;
/// Share of a deviation that a last round changes at most.
const SETTLED: f64 = 0.1;
/// Least emissivity of a start.
const LEAST: f64 = 0.005;

/// What is asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Asked {
    /// Groups, the fewest and the most.
    pub count: [usize; 2],
    /// ε_max of NEM, by which pixels are first compared.
    pub max_emissivity: f64,
    /// What is known of the emissivities beforehand.
    pub prior: Smoothness,
    /// Seed of random numbers.
    pub seed: u64,
}

/// A group of pixels with one emissivity; values of all bands in their order.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Cluster {
    /// Emissivity.
    pub emissivity: Vec<f64>,
    /// Its deviation: noise, all temperatures and lightings unknown, what the prior leaves.
    pub sigma: Vec<f64>,
    /// The part of it that goes with the mean of all bands: the systematic part, which a shift of all temperatures hides.
    pub sigma_magnitude: Vec<f64>,
    /// Deviation of the pixels' emissivities about this one, beyond their noise; 0 for bands that do not count.
    pub spread: Vec<f64>,
    /// Deviation of the mean emissivity.
    pub sigma_mean: f64,
    /// Deviation of what all its temperatures have in common, K.
    pub sigma_temperature_k: f64,
    /// χ² for each degree of freedom.
    pub chi_square_reduced: f64,
    /// Pixels that it was fitted to.
    pub fitted: usize,
    /// Bands held at 0 or 1.
    pub held: usize,
}

/// A count of groups and its loss on pixels that were kept apart.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Tried {
    /// Groups asked for.
    pub count: usize,
    /// Groups that have pixels.
    pub left: usize,
    /// Mean loss of a pixel.
    pub loss: f64,
    /// Standard error of its difference from the least one; 0 for that.
    pub error: f64,
    /// Mean χ² for each degree of freedom, its logarithm averaged.
    pub chi_square_reduced: f64,
}

/// A library and what it makes of the cube.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// The groups, that of the most pixels first.
    pub clusters: Vec<Cluster>,
    /// Every count that was tried, where there were several.
    pub tried: Vec<Tried>,
    /// Pixels that were drawn and have all their samples.
    pub drawn: usize,
    /// Those of them that have no NEM: in equilibrium, or impossible.
    pub without_nem: usize,
    /// Rounds until nothing changed, or all.
    pub rounds: usize,
    /// Whether nothing changed in the last one.
    pub settled: bool,
    /// The whole cube, decomposed by the library.
    pub maps: Maps,
}

/// Groups the pixels of a cube and finds the emissivity of each group; the library of `setting` is not looked at. `done` is told how
/// many rows are finished in the end.
///
/// # Errors
/// A setting that is impossible, an unknown gain, no surroundings to tell emission from; no group, more groups than pixels; a cube
/// that cannot be read.
pub fn library_from_cube(
    setting: &Setting<'_>,
    asked: &Asked,
    cube: &Cube,
    done: &(dyn Fn(usize) + Sync),
) -> Result<Found> {
    let [fewest, most] = asked.count;
    if fewest == 0 || most < fewest {
        let found = format!("{fewest} to {most} groups");
        return Err(Error::malformed(found, "ask for one at least, the fewest first"));
    }
    check::unit_interval("largest emissivity", asked.max_emissivity)?;
    check::positive("largest emissivity", asked.max_emissivity, "")?;
    if setting.gain {
        let found = "an unknown gain, which no emissivity can be told from";
        return Err(Error::malformed(found, "give counts of a known scale"));
    }
    let (found, expected) = (cube.shape().bands(), setting.bands.len());
    if found != expected {
        return Err(Error::Length { what: "bands of the cube".into(), found, expected });
    }
    // Everything else that can be wrong with a setting is found by a decomposition of nothing.
    let blank = vec![vec![1.0; setting.bands.nodes_cm1().len()]];
    let radiometry = {
        let check = Sample::of(cube, setting, 1, asked.seed)?;
        if check.pixels() > 0 {
            check.decomposed(setting, &blank)?;
        }
        Radiometry::new(setting)
    };
    let prior = EmissivityPrior::smooth(&radiometry.centres_cm1, asked.prior)?;
    let range = most > fewest;
    let sample = Sample::of(cube, setting, if range { FITTED + KEPT } else { FITTED }, asked.seed)?;
    let drawn = sample.pixels();
    // Every fourth is kept apart, so that both have the whole image.
    let (kept, fitted): (Vec<usize>, Vec<usize>) = (0..drawn).partition(|i| range && i % 4 == 3);
    let (kept, fitted) = (sample.some(&kept), sample.some(&fitted));
    let maker = Maker { setting, radiometry: &radiometry, prior: &prior, asked, sample: &fitted };
    let profiles = maker.profiles();
    if most > profiles.pixels.len() {
        let (pixels, without) = (profiles.pixels.len(), fitted.pixels() - profiles.pixels.len());
        return Err(Error::malformed(
            format!(
                "{most} clusters of {pixels} pixels ({without} more send what they are lit by, or are no surface)"
            ),
            "ask for fewer clusters than pixels",
        ));
    }
    let without_nem = fitted.pixels() - profiles.pixels.len();
    let mut made = Vec::new();
    for count in fewest..=most {
        made.push((count, maker.library(&profiles, count)?));
    }
    let (chosen, tried) = match range {
        false => (0, Vec::new()),
        true => maker.judged(&made, &kept)?,
    };
    let Made { curves, information, rounds, settled } = made.swap_remove(chosen).1;
    let mut order: Vec<usize> = (0..curves.len()).collect();
    order.sort_by(|a, b| information[*b].pixels.cmp(&information[*a].pixels).then(a.cmp(b)));
    let clusters: Vec<Cluster> =
        order.iter().map(|i| cluster(&radiometry, &curves[*i], &information[*i])).collect();
    let library: Vec<Vec<f64>> = clusters.iter().map(|one| radiometry.at_nodes(&one.emissivity)).collect();
    let maps = decompose(&Setting { library: &library, ..*setting }, &Options::default(), cube, done)?;
    Ok(Found { clusters, tried, drawn, without_nem, rounds, settled, maps })
}

fn cluster(radiometry: &Radiometry<'_>, curve: &Curve, information: &Information) -> Cluster {
    let mut spread = vec![0.0; curve.emissivity.len()];
    radiometry.used.iter().zip(&curve.spread).for_each(|(band, own)| spread[*band] = *own);
    Cluster {
        emissivity: curve.emissivity.clone(),
        sigma: curve.sigma.clone(),
        sigma_magnitude: curve.sigma_magnitude.clone(),
        spread,
        sigma_mean: curve.sigma_mean,
        sigma_temperature_k: curve.sigma_temperature_k,
        chi_square_reduced: information.reduced(),
        fitted: information.pixels,
        held: curve.held,
    }
}

/// Relative emissivities of the pixels that have one, in units of their noise.
struct Profiles {
    pixels: Vec<usize>,
    whitened: Vec<f64>,
}

/// A library of one count.
struct Made {
    curves: Vec<Curve>,
    information: Vec<Information>,
    rounds: usize,
    settled: bool,
}

/// What makes libraries out of a sample.
struct Maker<'a> {
    setting: &'a Setting<'a>,
    radiometry: &'a Radiometry<'a>,
    prior: &'a EmissivityPrior,
    asked: &'a Asked,
    sample: &'a Sample,
}

impl Maker<'_> {
    /// NEM of a pixel: emissivities of the bands that count, and their deviations.
    fn nem(&self, pixel: usize, light: &[f64], max_emissivity: f64) -> Option<[Vec<f64>; 2]> {
        let r = self.radiometry;
        let [radiance, sigma] = r.radiance(&self.sample.used(pixel, &r.used));
        let surface =
            Surface { wavenumbers_cm1: &r.wavenumbers_cm1, radiance: &radiance, light, sigma: &sigma };
        let found = nem(&surface, max_emissivity)?;
        let [black, _] = r.blackbody(found.temperature_k);
        let error = black.iter().zip(light).zip(&sigma).map(|((b, x), sigma)| (sigma / (b - x)).abs());
        let error: Vec<f64> = error.collect();
        found.emissivity.iter().all(|e| e.is_finite()).then_some([found.emissivity, error])
    }

    fn profiles(&self) -> Profiles {
        let light = self.radiometry.light(&self.radiometry.even_lighting());
        let one = |pixel: usize| {
            let [e, error] = self.nem(pixel, &light, self.asked.max_emissivity)?;
            let mean = e.iter().sum::<f64>() / e.len() as f64;
            (mean > LEAST)
                .then(|| (pixel, ratio(&e), error.iter().map(|error| error / mean).collect::<Vec<f64>>()))
        };
        let found: Vec<_> = (0..self.sample.pixels()).into_par_iter().filter_map(one).collect();
        let width = self.radiometry.used.len();
        // The median over the pixels: a few next to equilibrium would have all the say.
        let scale: Vec<f64> = (0..width)
            .into_par_iter()
            .map(|w| {
                let mut errors: Vec<f64> = found.iter().map(|one| one.2[w]).collect();
                errors.sort_by(f64::total_cmp);
                errors.get(errors.len() / 2).copied().unwrap_or(1.0).max(f64::MIN_POSITIVE)
            })
            .collect();
        Profiles {
            pixels: found.iter().map(|one| one.0).collect(),
            whitened: found.iter().flat_map(|one| one.1.iter().zip(&scale).map(|(b, s)| b / s)).collect(),
        }
    }

    /// The library of so many groups.
    fn library(&self, profiles: &Profiles, count: usize) -> Result<Made> {
        let width = self.radiometry.used.len();
        let stride = profiles.pixels.len().div_ceil(GROUPED).max(1);
        let some: Vec<usize> = (0..profiles.pixels.len()).step_by(stride).collect();
        // Few pixels are all grouped.
        let some = if some.len() < count { (0..profiles.pixels.len()).collect() } else { some };
        let points: Vec<f64> =
            some.iter().flat_map(|i| &profiles.whitened[i * width..][..width]).copied().collect();
        let means = k_means(&points, width, count, self.asked.seed, STARTS)?;
        let mut groups: Vec<Vec<usize>> = vec![Vec::new(); count];
        for (i, group) in some.iter().zip(&means.group) {
            groups[*group].push(profiles.pixels[*i]);
        }
        groups.retain(|group| !group.is_empty());
        let mut curves: Vec<Vec<f64>> =
            groups.par_iter().map(|group| self.start(group)).collect::<Result<_>>()?;
        let mut before: Vec<Option<usize>> = Vec::new();
        let mut rounds = 0;
        loop {
            rounds += 1;
            let library: Vec<Vec<f64>> = curves.iter().map(|e| self.radiometry.at_nodes(e)).collect();
            let maps = self.sample.decomposed(self.setting, &library)?;
            let found = states(&maps, self.radiometry);
            let now: Vec<Option<usize>> = found.iter().map(|state| state.as_ref().map(|s| s.group)).collect();
            let (mut fitted, mut information) = (Vec::new(), Vec::new());
            let mut change: f64 = 0.0;
            for (group, e) in curves.iter().enumerate() {
                let own: Vec<(usize, &State)> = found
                    .iter()
                    .enumerate()
                    .filter_map(|(i, state)| state.as_ref().filter(|s| s.group == group).map(|s| (i, s)))
                    .collect();
                // A group that lost all its pixels is none.
                if own.is_empty() {
                    change = f64::INFINITY;
                    continue;
                }
                let used: Vec<f64> = self.radiometry.used.iter().map(|band| e[*band]).collect();
                let sums = Information::of(self.radiometry, self.sample, &own, &used);
                let Some(curve) = Curve::new(self.radiometry, self.prior, &sums, &used) else {
                    let found = "emissivities whose information is no number";
                    return Err(Error::malformed(found, "check unit and noise of the cube"));
                };
                let off = self
                    .radiometry
                    .used
                    .iter()
                    .map(|b| (curve.emissivity[*b] - e[*b]).abs() / curve.sigma[*b]);
                change = off.fold(change, f64::max);
                fitted.push(curve);
                information.push(sums);
            }
            let settled = change < SETTLED && now == before;
            if settled || rounds == ROUNDS || fitted.is_empty() {
                return Ok(Made { curves: fitted, information, rounds, settled });
            }
            before = now;
            curves = fitted.into_iter().map(|curve| curve.emissivity).collect();
        }
    }

    /// The emissivity of a group by NEM, with the ε_max that explains its pixels best.
    fn start(&self, group: &[usize]) -> Result<Vec<f64>> {
        let r = self.radiometry;
        let light = r.light(&r.even_lighting());
        let stride = group.len().div_ceil(LOOKED).max(1);
        let some: Vec<usize> = group.iter().copied().step_by(stride).collect();
        let pixels = self.sample.some(&some);
        let mut best: Option<(f64, Vec<f64>)> = None;
        let first = self.asked.max_emissivity;
        for magnitude in std::iter::once(first).chain(MAGNITUDES.into_iter().filter(|m| *m < first)) {
            let Some(e) = self.mean_of(&some, &light, magnitude) else { continue };
            let maps = pixels.decomposed(self.setting, &[r.at_nodes(&e)])?;
            let used: Vec<f64> = r.used.iter().map(|band| e[*band]).collect();
            let freedom = used.len() as f64;
            let loss: f64 = states(&maps, r)
                .iter()
                .enumerate()
                .map(|(i, state)| {
                    let Some(state) = state else { return freedom };
                    freedom * libm::log1p(chi_square(r, &pixels.used(i, &r.used), &used, state) / freedom)
                })
                .sum();
            let mean = used.iter().sum::<f64>() / freedom;
            let known = self.asked.prior;
            let loss = loss + ((mean - known.mean) / known.magnitude).powi(2);
            if best.as_ref().is_none_or(|best| loss < best.0) {
                best = Some((loss, e));
            }
        }
        Ok(best.map_or_else(|| self.prior.mean().to_vec(), |best| best.1))
    }

    /// Mean emissivity of some pixels by NEM, weighted by its information; of all bands.
    fn mean_of(&self, pixels: &[usize], light: &[f64], max_emissivity: f64) -> Option<Vec<f64>> {
        let width = self.radiometry.used.len();
        let (mut sum, mut weights) = (vec![0.0; width], vec![0.0; width]);
        for pixel in pixels {
            let Some([e, error]) = self.nem(*pixel, light, max_emissivity) else { continue };
            for w in 0..width {
                let weight = error[w].powi(-2);
                sum[w] += weight * e[w];
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

    /// The place of the count that is taken, and the loss of each.
    fn judged(&self, made: &[(usize, Made)], kept: &Sample) -> Result<(usize, Vec<Tried>)> {
        let mut losses: Vec<Vec<f64>> = Vec::new();
        let mut tried = Vec::new();
        for (count, made) in made {
            let curves: Vec<Vec<f64>> =
                made.curves.iter().map(|c| self.radiometry.at_nodes(&c.emissivity)).collect();
            let maps = kept.decomposed(self.setting, &curves)?;
            let found = states(&maps, self.radiometry);
            let total: usize = made.information.iter().map(|i| i.pixels).sum();
            let unknowns = 1 + self.radiometry.changes().len();
            let freedom = (self.radiometry.used.len() as f64 - unknowns as f64).max(1.0);
            let terms: Vec<[f64; 2]> = found
                .par_iter()
                .enumerate()
                .map(|(i, state)| {
                    // What no group explains costs the same with every count.
                    let Some(state) = state else { return [0.0; 2] };
                    let e: Vec<f64> = self
                        .radiometry
                        .used
                        .iter()
                        .map(|b| made.curves[state.group].emissivity[*b])
                        .collect();
                    let counts = kept.used(i, &self.radiometry.used);
                    let chi = chi_square(self.radiometry, &counts, &e, state).max(f64::MIN_POSITIVE);
                    let share = made.information[state.group].pixels as f64 / total.max(1) as f64;
                    [freedom * libm::log(chi / freedom), -2.0 * libm::log(share)]
                })
                .collect();
            let each: Vec<f64> = terms.iter().map(|[chi, name]| chi + name).collect();
            let pixels = each.len().max(1) as f64;
            tried.push(Tried {
                count: *count,
                left: made.curves.len(),
                loss: each.iter().sum::<f64>() / pixels,
                error: 0.0,
                chi_square_reduced: libm::exp(terms.iter().map(|t| t[0]).sum::<f64>() / pixels / freedom),
            });
            losses.push(each);
        }
        let best = (0..tried.len()).min_by(|a, b| tried[*a].loss.total_cmp(&tried[*b].loss)).unwrap_or(0);
        for (own, loss) in tried.iter_mut().zip(&losses) {
            let apart: Vec<f64> = loss.iter().zip(&losses[best]).map(|(a, b)| a - b).collect();
            let count = apart.len().max(2) as f64;
            let mean = apart.iter().sum::<f64>() / count;
            own.error =
                (apart.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (count * (count - 1.0))).sqrt();
        }
        let least = tried[best].loss;
        let chosen = tried.iter().position(|one| one.loss <= least + one.error).unwrap_or(best);
        Ok((chosen, tried))
    }
}
