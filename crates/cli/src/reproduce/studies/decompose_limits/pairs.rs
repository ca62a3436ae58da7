//! Pixels and their nearest states of another material: how often each is named, and how often that can be.

use crate::reproduce::pixels::{Pixel, Street};
use hadar::decompose::Method;
use hadar::error::Result;
use hadar::identifiability::detection;
use hadar::identifiability::nearest::NearestSolver;
use hadar::identifiability::ratio::RatioLaw;
use hadar::statistics::Statistics;
use rayon::prelude::*;

const PAIRS: usize = 300;
/// Spectra of each of the two states.
const SPECTRA: usize = 8;

/// Random pixels, and of each the nearest state of any other material.
pub(super) struct Pairs {
    pixels: Vec<Pixel>,
    nearest: Vec<Pixel>,
    /// Nearest distance for one photon.
    distances: Vec<f64>,
}

/// Shares of right materials.
#[derive(Debug, Clone, Copy)]
pub(super) struct Decided {
    /// Of both states of the pairs, and its standard error.
    pub(super) right: f64,
    pub(super) right_error: f64,
    /// What no method exceeds there, and what Φ(d) says.
    pub(super) limit: f64,
    pub(super) phi: f64,
    /// Of the random pixels alone.
    pub(super) right_random: f64,
}

impl Pairs {
    pub(super) fn new(street: &Street, seed: u64) -> Result<Self> {
        let pixels = street.pixels(PAIRS, seed)?;
        let (unknowns, counting) = (street.unknowns()?, street.counting(1.0));
        let solver =
            || NearestSolver::new(&street.bands, &street.surroundings, unknowns.clone(), street.range());
        let nearest = |solver: &mut NearestSolver<'_>, pixel: &Pixel| {
            let own = &street.library[pixel.material];
            let mut best = (f64::INFINITY, pixel.clone());
            for (material, other) in street.library.iter().enumerate().filter(|(m, _)| *m != pixel.material) {
                let found = solver.with_counting(own, other, &pixel.state, &counting)?;
                if found.distance < best.0 {
                    best = (found.distance, Pixel { material, state: found.state });
                }
            }
            Ok(best)
        };
        let found: Vec<(f64, Pixel)> = pixels.par_iter().map_init(solver, nearest).collect::<Result<_>>()?;
        let (distances, nearest) = found.into_iter().unzip();
        Ok(Self { pixels, nearest, distances })
    }

    pub(super) fn decided(&self, street: &Street, photons: f64, seed: u64, stream: u64) -> Result<Decided> {
        let repeated = |pixels: &[Pixel]| -> Vec<Pixel> {
            pixels.iter().flat_map(|pixel| std::iter::repeat_n(pixel.clone(), SPECTRA)).collect()
        };
        let shares = |pixels: &[Pixel], stream: u64| -> Result<Vec<f64>> {
            let pixels = repeated(pixels);
            let counts = street.drawn(&pixels, photons, seed, stream)?;
            let maps = street.decomposed(Method::Ml, &street.library, counts, photons)?;
            let right =
                |(pixel, material): (&Pixel, &u16)| f64::from(usize::from(*material) == pixel.material);
            let right: Vec<f64> = pixels.iter().zip(&maps.material).map(right).collect();
            Ok(right.chunks(SPECTRA).map(mean).collect())
        };
        let first = shares(&self.pixels, stream)?;
        let second = shares(&self.nearest, stream | 1 << 19)?;
        let both: Vec<f64> = first.iter().zip(&second).map(|(a, b)| 0.5 * (a + b)).collect();
        let limit = |(pixel, other): (&Pixel, &Pixel)| {
            let means = [pixel, other].map(|one| street.means(one, photons));
            Ok(RatioLaw::new(&means[0], &means[1], &Statistics::Poisson)?.accuracy())
        };
        let limits = self.pixels.par_iter().zip(&self.nearest).map(limit).collect::<Result<Vec<f64>>>()?;
        let phi: Vec<f64> =
            self.distances.iter().map(|d| detection::probability(d * photons.sqrt())).collect();
        // The spectra are drawn about fixed pairs.
        let var = |share: &f64| share * (1.0 - share) / (SPECTRA as f64 - 1.0);
        let scatter: f64 = first.iter().chain(&second).map(var).sum();
        Ok(Decided {
            right: mean(&both),
            right_error: scatter.sqrt() / (2.0 * PAIRS as f64),
            limit: mean(&limits),
            phi: mean(&phi),
            right_random: mean(&first),
        })
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}
