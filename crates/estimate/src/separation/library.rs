//! A library out of a heat cube.
//!
//! 1. Some pixels are drawn. Each has its emissivity by NEM, under that of a few lightings which leaves it smoothest, and β = e/mean(e) by
//!    RATIO; pixels without one are declared and left out.
//! 2. K-means makes more groups of β, in units of its noise, than are asked for: what is lit differently may look different.
//! 3. Each group has emissivities fitted to its pixels, one in each of three parts of [0, 1]: its magnitude is the ε_max of NEM there that
//!    explains them best, each with a temperature and lighting of its own; then all bands are free ([`super::group`]).
//! 4. Of these emissivities as many as asked for are taken, those whose physics loss over the pixels is least together.
//! 5. Rounds: every pixel goes to the emissivity that explains it best, with its temperature and lighting ([`crate::decompose`]); the
//!    emissivities are fitted to all pixels at once; a step that makes the loss larger is taken back and shortened.
//! 6. Where a range of counts is asked for, each has a loss on pixels that were kept apart: the mean over them of
//!    ν ln(χ²/ν) − 2 ln π, χ² the physics loss with ν degrees of freedom, π the share of the pixel's group. The first term is that of a
//!    likelihood with a scale of its own for each pixel, the second what the name of a group costs: a group that is split in two
//!    without need costs 2 ln 2 and gains nothing, so that the loss does not fall for ever. The fewest groups within a
//!    standard error of the least loss are taken.
//!
//! The whole cube is then decomposed by the library. In all of this the prior density of an emissivity's mean counts for every pixel
//! that is given to it: in a street that lights itself a mirror of the ground sends what the ground sends.
//!
//! Source: paper, supplement SV C, which chooses K by hand and names the scan over K as future work.

use super::group::{Curve, Information, State, chi_square, states};
use super::k_means::k_means;
use super::nem::{Surface, nem, ratio};
use super::radiometry::Radiometry;
use super::sample::Sample;
use crate::decompose::{Maps, Options, Setting, decompose};
use hadar::cube::Cube;
use hadar::error::{Error, Result, check};
use hadar::fisher::emissivity::{EmissivityPrior, Smoothness};
use hadar::parallel;
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
/// Rounds in which each emissivity is held against all that were not taken.
const EXCHANGES: usize = 3;
/// Parts of [0, 1] in which the magnitude of a group is looked for.
const PARTS: [[f64; 2]; 3] = [[0.0, 0.35], [0.35, 0.8], [0.8, 1.01]];
const ROUNDS: usize = 30;
/// Groups of K-means for each that is asked for, and besides.
const MORE: [usize; 2] = [2, 6];
/// Pixels of a group that its emissivity is fitted to, those that are compared by all, and those that counts are tried with.
const OF_GROUP: usize = 240;
const COMPARED: usize = 1_500;
const TRIED: usize = 4_000;
/// How far an emissivity goes in a first step, and when a step is too short to matter.
const REACH: f64 = 0.03;
const SHORTEST: f64 = 1e-4;
/// Share of a deviation that a last round changes at most.
const SETTLED: f64 = 0.1;
/// −2 ln of a prior density that is held against no emissivity more.
const MOST_IMPROBABLE: f64 = 40.0;
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
#[non_exhaustive]
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
    /// Prior probability of each, in any scale: that of its mean emissivity.
    pub prior: Vec<f64>,
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

/// The key of an error about how many groups are asked for.
pub const COUNT: &str = "clusters.count";

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
            check.decomposed(setting, &blank, Vec::new())?;
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
        )
        .for_key(COUNT));
    }
    let without_nem = fitted.pixels() - profiles.pixels.len();
    let starts = maker.starts(&profiles, most)?;
    let (start, tried) = match range {
        false => (starts.taken(most), Vec::new()),
        true => {
            let fewer = fitted.every(TRIED);
            let mut made = Vec::new();
            for count in fewest..=most {
                let one = maker.fitted(&fewer, starts.taken(count))?;
                made.extend((!one.curves.is_empty()).then_some((count, one)));
            }
            if made.is_empty() {
                return Err(nothing());
            }
            let (chosen, tried) = maker.judged(&made, &kept)?;
            (made.swap_remove(chosen).1.curves.into_iter().map(|curve| curve.emissivity).collect(), tried)
        }
    };
    let Made { curves, information, rounds, settled } = maker.fitted(&fitted, start)?;
    let mut order: Vec<usize> = (0..curves.len()).collect();
    order.sort_by(|a, b| information[*b].pixels.cmp(&information[*a].pixels).then(a.cmp(b)));
    if curves.is_empty() {
        return Err(nothing());
    }
    let clusters: Vec<Cluster> =
        order.iter().map(|i| cluster(&radiometry, &curves[*i], &information[*i])).collect();
    let library: Vec<Vec<f64>> = clusters.iter().map(|one| radiometry.at_nodes(&one.emissivity)).collect();
    let prior: Vec<f64> = clusters.iter().map(|one| maker.probability(&one.emissivity)).collect();
    let options = Options { prior: prior.clone(), ..Options::default() };
    let maps = decompose(&Setting { library: &library, ..*setting }, &options, cube, done)?;
    Ok(Found { clusters, prior, tried, drawn, without_nem, rounds, settled, maps })
}

fn nothing() -> Error {
    Error::malformed(
        "all pixels send what they are lit by: nothing tells an emissivity",
        "check unit and surroundings, or look when the scene is warmer or colder than they are",
    )
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
    /// Lightings that were tried.
    lights: Vec<Vec<f64>>,
    pixels: Vec<usize>,
    /// Place of each pixel's lighting among them.
    lit: Vec<usize>,
    whitened: Vec<f64>,
}

/// Emissivities to start from, and the loss of each with some pixels.
struct Starts {
    curves: Vec<Vec<f64>>,
    losses: Vec<Vec<f64>>,
}

impl Starts {
    /// So many of them, that explain the pixels best together.
    fn taken(&self, count: usize) -> Vec<Vec<f64>> {
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

    fn profiles(&self) -> Profiles {
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
    fn starts(&self, profiles: &Profiles, count: usize) -> Result<Starts> {
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

    /// Loss of each pixel with one emissivity.
    fn losses(&self, pixels: &Sample, e: &[f64]) -> Result<Vec<f64>> {
        let maps = pixels.decomposed(self.setting, &[self.radiometry.at_nodes(e)], Vec::new())?;
        let found = states(&maps, self.radiometry);
        Ok((0..pixels.pixels()).map(|i| self.loss(pixels, i, found[i].as_ref(), e)).collect())
    }

    /// −2 ln of the prior density of an emissivity's mean, over its most.
    fn improbable(&self, e: &[f64]) -> f64 {
        let used = &self.radiometry.used;
        let mean = used.iter().map(|band| e[*band]).sum::<f64>() / used.len() as f64;
        ((mean - self.asked.prior.mean) / self.asked.prior.magnitude).powi(2)
    }

    /// That density. It has a say in every pixel: a mirror of the ground sends what the ground sends.
    fn probability(&self, e: &[f64]) -> f64 {
        libm::exp(-0.5 * self.improbable(e).min(MOST_IMPROBABLE))
    }

    /// Loss of a pixel: that of a likelihood whose scale is its own, and what is improbable of the emissivity. Where the
    /// surroundings explain the pixel, as they do with any mirror, it is no better than a fit should be.
    fn loss(&self, pixels: &Sample, i: usize, state: Option<&State>, e: &[f64]) -> f64 {
        let used: Vec<f64> = self.radiometry.used.iter().map(|band| e[*band]).collect();
        let freedom = used.len() as f64;
        let each = state.map_or(1.0, |state| {
            let counts = pixels.used(i, &self.radiometry.used);
            chi_square(self.radiometry, &counts, &used, state) / freedom
        });
        freedom * libm::log1p(each) + self.improbable(e).min(MOST_IMPROBABLE)
    }

    /// What a pixel without a state costs where there are several emissivities.
    fn explained(&self) -> f64 {
        self.radiometry.used.len() as f64 * std::f64::consts::LN_2
    }

    /// Emissivities fitted to pixels, from a start.
    fn fitted(&self, pixels: &Sample, start: Vec<Vec<f64>>) -> Result<Made> {
        let used = |e: &[f64]| -> Vec<f64> { self.radiometry.used.iter().map(|band| e[*band]).collect() };
        let unusable = || {
            let found = "emissivities whose information is no number";
            Error::malformed(found, "check unit and noise of the cube")
        };
        let mut curves = start;
        let mut best: Option<(f64, Vec<Vec<f64>>, Vec<Information>)> = None;
        let mut before: Vec<Option<usize>> = Vec::new();
        let (mut reach, mut rounds, mut settled) = (REACH, 0, false);
        while rounds < ROUNDS && !settled && reach > SHORTEST {
            rounds += 1;
            let library: Vec<Vec<f64>> = curves.iter().map(|e| self.radiometry.at_nodes(e)).collect();
            let prior = curves.iter().map(|e| self.probability(e)).collect();
            let found = states(&pixels.decomposed(self.setting, &library, prior)?, self.radiometry);
            let now: Vec<Option<usize>> = found.iter().map(|state| state.as_ref().map(|s| s.group)).collect();
            let each = parallel::map(found.len(), |i| {
                let own = found[i].as_ref().map(|own| self.loss(pixels, i, Some(own), &curves[own.group]));
                own.unwrap_or_else(|| self.explained())
            });
            let loss: f64 = each.iter().sum();
            let worse = best.as_ref().is_some_and(|best| loss > best.0 + curves.len() as f64);
            if worse {
                reach *= 0.2;
            } else {
                let mut kept = Vec::new();
                let mut information = Vec::new();
                for (group, e) in curves.iter().enumerate() {
                    let own: Vec<(usize, &State)> = found
                        .iter()
                        .enumerate()
                        .filter_map(|(i, state)| state.as_ref().filter(|s| s.group == group).map(|s| (i, s)))
                        .collect();
                    // A group that lost all its pixels is none.
                    if !own.is_empty() {
                        information.push(Information::of(self.radiometry, pixels, &own, &used(e)));
                        kept.push(e.clone());
                    }
                }
                if kept.is_empty() {
                    break;
                }
                best = Some((loss, kept, information));
            }
            let Some((_, from, information)) = &best else { break };
            let mut change: f64 = 0.0;
            let mut next = Vec::new();
            for (e, sums) in from.iter().zip(information) {
                let own = used(e);
                let curve =
                    Curve::new(self.radiometry, self.prior, sums, &own, reach).ok_or_else(unusable)?;
                let off = self.radiometry.used.iter().zip(&own);
                change = off
                    .map(|(b, e)| (curve.emissivity[*b] - e).abs() / curve.sigma[*b])
                    .fold(change, f64::max);
                next.push(curve.emissivity);
            }
            settled = !worse && change < SETTLED && now == before && reach > 0.3;
            if !worse {
                before = now;
                reach = f64::min(reach * 2.5, 1.0);
            }
            curves = next;
        }
        let Some((_, from, information)) = best else {
            return Ok(Made { curves: Vec::new(), information: Vec::new(), rounds, settled });
        };
        let curves = from.iter().zip(&information).map(|(e, sums)| {
            Curve::new(self.radiometry, self.prior, sums, &used(e), reach.max(SHORTEST)).ok_or_else(unusable)
        });
        Ok(Made { curves: curves.collect::<Result<_>>()?, information, rounds, settled })
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

    /// The place of the count that is taken, and the loss of each.
    fn judged(&self, made: &[(usize, Made)], kept: &Sample) -> Result<(usize, Vec<Tried>)> {
        let mut losses: Vec<Vec<f64>> = Vec::new();
        let mut tried = Vec::new();
        for (count, made) in made {
            let curves: Vec<Vec<f64>> =
                made.curves.iter().map(|c| self.radiometry.at_nodes(&c.emissivity)).collect();
            let prior = made.curves.iter().map(|c| self.probability(&c.emissivity)).collect();
            let maps = kept.decomposed(self.setting, &curves, prior)?;
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
