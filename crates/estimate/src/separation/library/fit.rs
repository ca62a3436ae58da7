//! Emissivities fitted to pixels, from a start: rounds of giving every pixel to the one that explains it best, and of steps of them all.
//!
//! The loss of a pixel is n ln(1 + χ²/n) + ((ē − μ)/s)², n its bands, χ² of its best temperature and lighting, ē the mean emissivity with a prior of
//! mean μ and deviation s: the likelihood of a noise whose scale is the pixel's own. A step that makes the sum larger is taken back and shortened.

use super::super::group::{Curve, Information, State, chi_square, states};
use super::super::radiometry::Radiometry;
use super::super::sample::Sample;
use crate::decompose::Setting;
use hadar::error::{Error, Result};
use hadar::fisher::emissivity::{EmissivityPrior, Smoothness};
use hadar::parallel;

const ROUNDS: usize = 30;
/// How far an emissivity goes in a first step, and when a step is too short to matter.
const REACH: f64 = 0.03;
const SHORTEST: f64 = 1e-4;
/// Share of a deviation that a last round changes at most.
const SETTLED: f64 = 0.1;
/// −2 ln of a prior density that is held against no emissivity more.
const MOST_IMPROBABLE: f64 = 40.0;

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

/// A library of one count.
pub(super) struct Made {
    pub(super) curves: Vec<Curve>,
    pub(super) information: Vec<Information>,
    pub(super) rounds: usize,
    pub(super) settled: bool,
}

/// What makes libraries out of a sample.
pub(super) struct Maker<'a> {
    pub(super) setting: &'a Setting<'a>,
    pub(super) radiometry: &'a Radiometry<'a>,
    pub(super) prior: &'a EmissivityPrior,
    pub(super) asked: &'a Asked,
    pub(super) sample: &'a Sample,
}

impl Maker<'_> {
    /// Loss of each pixel with one emissivity.
    pub(super) fn losses(&self, pixels: &Sample, e: &[f64]) -> Result<Vec<f64>> {
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
    pub(super) fn probability(&self, e: &[f64]) -> f64 {
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
    pub(super) fn fitted(&self, pixels: &Sample, start: Vec<Vec<f64>>) -> Result<Made> {
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
}
