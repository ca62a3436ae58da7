//! Every method on every spectrum, in scenes that are drawn.

use super::gaussian::gaussian;
use super::mmd::{Mmd, mmd};
use super::smoothest::smoothest;
use super::spectra::{Sky, Spectra, smoothness, wavenumbers_cm1};
use hadar::error::Result;
use hadar::fisher::emissivity::{EmissivityPrior, Seen, Separation};
use hadar::planck::{photon_radiance_and_slope_into, photon_radiance_slope};
use hadar::statistics::Statistics;
use hadar_estimate::separation::{Separated, Surface, nem};
use hadar_simulate::draws::{Draws, generator};
use rand::RngExt;
use rayon::prelude::*;

/// Noise of a reading, as a temperature at 300 K.
pub(super) const NEDT_K: [f64; 2] = [0.03, 0.1];
/// Temperatures of the surfaces, and those that are looked for, K.
const DRAWN_K: [f64; 2] = [295.0, 320.0];
const LOOKED_K: [f64; 2] = [270.0, 345.0];
const MAX_EMISSIVITY: f64 = 0.98;
/// Principal components of the others that a prior is made of.
const COMPONENTS: usize = 8;
/// Temperature at which noise is stated, K.
const STATED_K: f64 = 300.0;

/// Methods, in the order of their errors.
pub(super) const METHODS: [&str; 6] = [
    "NEM",
    "TES (MMD)",
    "smoothest (ISSTES)",
    "principal components",
    "smooth prior",
    "smooth prior, drawn from it",
];

/// Errors of one method.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Errors {
    pub(super) temperature_rms_k: f64,
    pub(super) temperature_median_k: f64,
    pub(super) emissivity_rms: f64,
    pub(super) emissivity_median: f64,
    /// Share of the scenes in which it gives an answer.
    pub(super) answered: f64,
}

/// All methods at one noise under one sky.
pub(super) struct Compared {
    pub(super) sky: &'static str,
    pub(super) nedt_k: f64,
    pub(super) errors: [Errors; 6],
    /// Bound at emissivities drawn from the prior, its squares averaged over them and over the temperatures of the surfaces.
    pub(super) bound_temperature_k: f64,
    /// What no estimate is below, averaged: van Trees' bound.
    pub(super) rigorous_temperature_k: f64,
    pub(super) bound_emissivity: f64,
    pub(super) scenes: usize,
}

/// Deviations of a reading in every band.
pub(super) fn sigma(nedt_k: f64) -> Vec<f64> {
    wavenumbers_cm1().iter().map(|nu| nedt_k * photon_radiance_slope(*nu, STATED_K)).collect()
}

/// Error of the temperature (K) and root mean square error of the emissivity.
type Off = Option<(f64, f64)>;

fn off(found: Option<Separated>, temperature_k: f64, e: &[f64]) -> Off {
    let found = found?;
    let square: Vec<f64> =
        found.emissivity.iter().zip(e).map(|(a, b)| (a - b).powi(2)).filter(|x| x.is_finite()).collect();
    Some((
        found.temperature_k - temperature_k,
        (square.iter().sum::<f64>() / square.len().max(1) as f64).sqrt(),
    ))
}

fn summed(all: &[Off]) -> Errors {
    let known: Vec<(f64, f64)> = all.iter().flatten().copied().collect();
    let rms = |pick: &dyn Fn(&(f64, f64)) -> f64| {
        (known.iter().map(|one| pick(one).powi(2)).sum::<f64>() / known.len().max(1) as f64).sqrt()
    };
    let median = |pick: &dyn Fn(&(f64, f64)) -> f64| {
        let mut values: Vec<f64> = known.iter().map(|one| pick(one).abs()).collect();
        values.sort_by(f64::total_cmp);
        values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
    };
    Errors {
        temperature_rms_k: rms(&|one| one.0),
        temperature_median_k: median(&|one| one.0),
        emissivity_rms: rms(&|one| one.1),
        emissivity_median: median(&|one| one.1),
        answered: known.len() as f64 / all.len().max(1) as f64,
    }
}

pub(super) fn compare(
    spectra: &Spectra,
    sky: &Sky,
    nedt_k: f64,
    scenes: usize,
    seed: u64,
) -> Result<Compared> {
    let nu = wavenumbers_cm1();
    let sigma = sigma(nedt_k);
    let stream = (nedt_k * 1e3) as u64 + sky.name.len() as u64 * 1000;
    let all: Vec<&[f64]> = spectra.emissivity.iter().map(Vec::as_slice).collect();
    let own_prior = EmissivityPrior::smooth(&nu, smoothness(&all))?;
    let one = |i: usize| -> Result<Vec<([Off; 6], [f64; 3])>> {
        let others = spectra.others(i);
        let relation = Mmd::of_spectra(&others);
        let components = EmissivityPrior::of_spectra(&others, COMPONENTS)?;
        let smooth = EmissivityPrior::smooth(&nu, smoothness(&others))?;
        let mut random = generator(seed, (stream << 20) + i as u64);
        let mut rows = Vec::new();
        for _ in 0..scenes {
            let temperature_k = random.random_range(DRAWN_K[0]..DRAWN_K[1]);
            let (mut black, mut slope) = (vec![0.0; nu.len()], vec![0.0; nu.len()]);
            photon_radiance_and_slope_into(&nu, temperature_k, &mut black, &mut slope);
            let mut normal = vec![0.0; nu.len() + own_prior.unknowns()];
            Draws::new(&Statistics::gaussian(vec![1.0; normal.len()])?, &vec![0.0; normal.len()])?
                .draw_into(&mut random, &mut normal);
            let noise: Vec<f64> = sigma.iter().zip(&normal).map(|(sigma, x)| sigma * x).collect();
            let sent = |e: &[f64]| -> Vec<f64> {
                (0..nu.len()).map(|w| e[w] * black[w] + (1.0 - e[w]) * sky.radiance[w] + noise[w]).collect()
            };
            let e = &spectra.emissivity[i];
            let radiance = sent(e);
            let surface =
                |radiance| Surface { wavenumbers_cm1: &nu, radiance, light: &sky.radiance, sigma: &sigma };
            let seen = surface(&radiance);
            let drawn = own_prior.at(&normal[nu.len()..]);
            let of_drawn = sent(&drawn);
            let look = Seen { blackbody: &black, slope: &slope, light: &sky.radiance, sigma: &sigma };
            let (bound, rigorous) =
                (Separation::at(&own_prior, &drawn, &look)?, Separation::averaged(&own_prior, &look)?);
            let found = [
                off(nem(&seen, MAX_EMISSIVITY), temperature_k, e),
                off(mmd(&seen, MAX_EMISSIVITY, &relation), temperature_k, e),
                off(Some(smoothest(&seen, LOOKED_K)), temperature_k, e),
                off(gaussian(&seen, &components, LOOKED_K), temperature_k, e),
                off(gaussian(&seen, &smooth, LOOKED_K), temperature_k, e),
                off(gaussian(&surface(&of_drawn), &own_prior, LOOKED_K), temperature_k, &drawn),
            ];
            rows.push((
                found,
                [bound.sigma_temperature_k, bound.emissivity_rms(), rigorous.sigma_temperature_k],
            ));
        }
        Ok(rows)
    };
    let rows: Vec<([Off; 6], [f64; 3])> =
        (0..spectra.names.len()).into_par_iter().map(one).collect::<Result<Vec<_>>>()?.concat();
    let errors = std::array::from_fn(|m| summed(&rows.iter().map(|row| row.0[m]).collect::<Vec<_>>()));
    let rms =
        |k: usize| (rows.iter().map(|row| row.1[k].powi(2)).sum::<f64>() / rows.len().max(1) as f64).sqrt();
    Ok(Compared {
        sky: sky.name,
        nedt_k,
        errors,
        bound_temperature_k: rms(0),
        bound_emissivity: rms(1),
        rigorous_temperature_k: rms(2),
        scenes: rows.len(),
    })
}
