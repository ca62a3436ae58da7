//! Pixels and their nearest states of the other materials: how often the material is named, and how often that can be.

use crate::reproduce::pixels::{Pixel, Street};
use hadar::error::Result;
use hadar::identifiability::detection;
use hadar::identifiability::nearest::NearestSolver;
use hadar::identifiability::ratio::RatioLaw;
use hadar::statistics::Statistics;
use hadar_estimate::decompose::{Method, NO_MATERIAL};
use rayon::prelude::*;

/// Two materials that are hard to tell apart, by name.
pub(super) const TWO: [&str; 2] = ["concrete", "cinderblock"];
/// States whose spectra are drawn at each number of photons, in all sets together.
const SPECTRA: usize = 9600;

/// Random pixels, each with the nearest state of every other material.
pub(super) struct Sets {
    /// As many states as there are materials, the random one first.
    states: Vec<Vec<Pixel>>,
    /// Distance to the nearest of the others for one photon.
    distances: Vec<f64>,
}

/// Shares of right materials, each state of a set as often as the others.
#[derive(Debug, Clone, Copy)]
pub(super) struct Decided {
    /// Of maximum likelihood, and where it names none.
    pub(super) right: f64,
    pub(super) unnamed: f64,
    /// Of the best decision between the states of the set, on the same spectra.
    pub(super) best: f64,
    /// Standard errors of `right` and `best`.
    pub(super) right_error: f64,
    pub(super) best_error: f64,
    /// `best` of two states, computed without draws.
    pub(super) exact: Option<f64>,
    /// Of maximum likelihood on the random states alone, and their mean Φ(d).
    pub(super) right_random: f64,
    pub(super) phi: f64,
}

impl Decided {
    /// What is right if a guess is made where none is named.
    pub(super) fn with_guesses(&self, materials: usize) -> f64 {
        self.right + self.unnamed / materials as f64
    }

    /// Whether it is above the best decision by more than three standard errors.
    pub(super) fn is_beyond(&self, materials: usize) -> bool {
        self.with_guesses(materials) > self.best + 3.0 * self.right_error.hypot(self.best_error)
    }
}

impl Sets {
    pub(super) fn new(street: &Street, count: usize, seed: u64) -> Result<Self> {
        let pixels = street.pixels(count, seed)?;
        let (unknowns, counting) = (street.unknowns()?, street.counting(1.0));
        let solver =
            || NearestSolver::new(&street.bands, &street.surroundings, unknowns.clone(), street.range());
        let set = |solver: &mut NearestSolver<'_>, pixel: &Pixel| {
            let own = &street.library[pixel.material];
            let (mut states, mut nearest) = (vec![pixel.clone()], f64::INFINITY);
            for (material, other) in street.library.iter().enumerate().filter(|(m, _)| *m != pixel.material) {
                let found = solver.with_counting(own, other, &pixel.state, &counting)?;
                nearest = nearest.min(found.distance);
                states.push(Pixel { material, state: found.state });
            }
            Ok((states, nearest))
        };
        let found: Vec<(Vec<Pixel>, f64)> = pixels.par_iter().map_init(solver, set).collect::<Result<_>>()?;
        let (states, distances) = found.into_iter().unzip();
        Ok(Self { states, distances })
    }

    pub(super) fn decided(&self, street: &Street, photons: f64, seed: u64, stream: u64) -> Result<Decided> {
        let states = street.library.len();
        let spectra = SPECTRA / (self.states.len() * states);
        let drawn: Vec<Pixel> = self
            .states
            .iter()
            .flatten()
            .flat_map(|pixel| std::iter::repeat_n(pixel.clone(), spectra))
            .collect();
        let counts = street.drawn(&drawn, photons, seed, stream)?;
        // The state of the set that the counts are the most probable in: no decision does better.
        let of_set = |(set, counts): (&Vec<Pixel>, &[f64])| -> Result<(f64, f64)> {
            let means: Vec<Vec<f64>> = set.iter().map(|pixel| street.means(pixel, photons)).collect();
            let likely = |n: &[f64], means: &[f64]| -> f64 {
                n.iter().zip(means).map(|(n, mean)| n * mean.ln() - mean).sum()
            };
            let right = counts.chunks(street.bands.len()).enumerate().filter(|(i, n)| {
                let each = means.iter().map(|means| likely(n, means)).enumerate();
                each.max_by(|a, b| a.1.total_cmp(&b.1)).is_some_and(|(state, _)| state == i / spectra)
            });
            let exact = match means.as_slice() {
                [a, b] => RatioLaw::new(a, b, &Statistics::Poisson)?.accuracy(),
                _ => f64::NAN,
            };
            Ok((right.count() as f64, exact))
        };
        let per_set = spectra * states * street.bands.len();
        let of_sets: Vec<(f64, f64)> =
            self.states.par_iter().zip(counts.par_chunks(per_set)).map(of_set).collect::<Result<_>>()?;
        let maps = street.decomposed(Method::Ml, &street.library, counts.clone(), photons)?;
        let is_right: Vec<bool> = drawn
            .iter()
            .zip(&maps.material)
            .map(|(pixel, material)| usize::from(*material) == pixel.material)
            .collect();
        let all = drawn.len() as f64;
        let share = |count: usize| count as f64 / all;
        let error = |share: f64| (share * (1.0 - share) / all).sqrt();
        let right = share(is_right.iter().filter(|right| **right).count());
        let best = of_sets.iter().map(|(right, _)| right).sum::<f64>() / all;
        let random = || is_right.chunks(spectra).step_by(states).flatten();
        let phi = self.distances.iter().map(|d| detection::probability(d * photons.sqrt()));
        Ok(Decided {
            right,
            unnamed: share(maps.material.iter().filter(|m| **m == NO_MATERIAL).count()),
            best,
            right_error: error(right),
            best_error: error(best),
            exact: (states == 2)
                .then(|| of_sets.iter().map(|(_, exact)| exact).sum::<f64>() / of_sets.len() as f64),
            right_random: random().filter(|right| **right).count() as f64 / random().count() as f64,
            phi: phi.sum::<f64>() / self.distances.len() as f64,
        })
    }
}
