//! What neighbours tell about a pixel, where it is asked for: two priors over the whole image.
//!
//! * [`SpatialPrior::Potts`]: neighbours tend to be of one material and of nearly one temperature ([`potts`], then [`level`]);
//! * [`SpatialPrior::TexSgd`]: the paper's 'semi-global' cost, which pulls temperatures to the median of their window ([`sgd`]).
//!
//! Both choose among the materials that each pixel's own counts leave ([`kept`]): none is taken up that they make e¹² times less
//! likely than the best. What is found then rests on the prior: an object of one pixel that hardly differs from what is around it is
//! lost, and the posterior and the intervals are right only as far as scenes are like that. Where photons abound nothing changes.
//!
//! Lighting factors stay those of the pixel's own counts for the material that was chosen.

mod kept;
mod level;
mod potts;
mod sgd;

pub(super) use kept::{Kept, KeptRow};

use self::potts::Beliefs;
use super::pixel::{NO_MATERIAL, Pixel, Spared, Task, flag};
use super::possible::CANDIDATE_SHARE;
use hadar::cube::{Rows, Sample};
use hadar::error::{Error, Result};
use rayon::prelude::*;

/// Largest log-odds of a neighbour: e¹⁰ is certainty, and single precision still holds the product of four.
const MOST_WEIGHT: f64 = 10.0;

/// A prior over the image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SpatialPrior {
    /// Neighbours tend to be of one material and nearly one temperature.
    Potts {
        /// Log-odds that each of the four neighbours of that material and temperature adds to a material.
        weight: f64,
        /// Deviation of the temperature from one pixel of a material to the next, K; estimated from the cube if silent.
        temperature_step_k: Option<f64>,
    },
    /// Temperatures tend to the median of their window (paper, SIII B).
    TexSgd {
        /// The paper's p.
        weight: f64,
    },
}

/// What a prior did.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Spatial {
    /// Pixels whose material is another than by their own counts.
    pub changed: usize,
    /// Number of passes over the image until it settled or was stopped.
    pub sweeps: usize,
    /// Whether the last sweep changed nothing of note.
    pub settled: bool,
    /// Deviation of the temperature from one pixel of a material to the next, K, where it is used.
    pub temperature_step_k: Option<f64>,
}

/// The material of every pixel as the place among its candidates, and what the prior says of them.
#[derive(Debug)]
struct Chosen {
    places: Vec<usize>,
    beliefs: Option<Beliefs>,
    temperatures_k: Option<Vec<f64>>,
    about: Spatial,
}

impl SpatialPrior {
    /// # Errors
    /// A weight or a step that is no positive number or too large; a cost that knows no errors of the library beside such errors.
    pub(super) fn check(&self, library_error: bool) -> Result<()> {
        let (Self::Potts { weight, .. } | Self::TexSgd { weight }) = *self;
        if !(weight > 0.0 && weight <= MOST_WEIGHT) {
            return Err(Error::out_of_range(
                "weight of the spatial prior",
                weight,
                "",
                "above 0, at most 10",
            ));
        }
        match *self {
            Self::Potts { temperature_step_k: Some(step), .. } if !(step > 0.0 && step.is_finite()) => {
                Err(Error::out_of_range("temperature step of the spatial prior", step, "K", "above 0"))
            }
            Self::TexSgd { .. } if library_error => Err(Error::malformed(
                "the cost of TeX-SGD knows no errors of the library",
                "take the Potts prior, or leave the error of the emissivities out",
            )),
            _ => Ok(()),
        }
    }

    /// Lets the prior choose among what is kept of `pixels`, decomposes again those of which it chose another material, and takes
    /// temperatures together.
    ///
    /// # Errors
    /// A cube that cannot be read again.
    pub(super) fn apply<S: Sample>(
        &self,
        task: &Task,
        kept: &Kept,
        pixels: &mut [Pixel],
        (cube, per_unit): (&dyn Rows<S>, f64),
    ) -> Result<(Spared, Spatial)> {
        let (columns, bands) = (cube.shape().columns(), cube.shape().bands());
        let chosen = self.choose(kept, columns);
        let changed = |i: usize| {
            let place = chosen.places.get(i).copied().filter(|place| *place > 0)?;
            kept.of(i).get(place)?.kind
        };
        let again: Vec<(Spared, usize)> = pixels
            .par_chunks_mut(columns)
            .enumerate()
            .map_init(
                || (task.room(), Vec::new()),
                |(room, buffer), (row, pixels)| {
                    let (mut spared, mut count) = (Spared::default(), 0);
                    let others: Vec<(usize, u16)> = (0..columns)
                        .filter_map(|column| changed(row * columns + column).map(|kind| (column, kind)))
                        .collect();
                    if others.is_empty() {
                        return Ok((spared, count));
                    }
                    let samples = cube.read(row..row + 1, buffer)?;
                    for (column, kind) in others {
                        let sample = samples.get(column * bands..(column + 1) * bands);
                        let Some((pixel, sample)) = pixels.get_mut(column).zip(sample) else { continue };
                        task.load(sample, per_unit, room);
                        *pixel = task.pixel_of(Some(kind.into()), room, &mut spared);
                        count += 1;
                    }
                    Ok((spared, count))
                },
            )
            .collect::<Result<_>>()?;
        // Fits that are made again are none more of the question.
        let spared = again
            .iter()
            .fold(Spared::default(), |sum, (spared, _)| Spared { looks: sum.looks + spared.looks, ..sum });
        if let Some(beliefs) = &chosen.beliefs {
            pixels.iter_mut().enumerate().for_each(|(i, pixel)| beliefs.put(kept, i, task, pixel));
        }
        let temperatures_k = match (chosen.about.temperature_step_k, chosen.temperatures_k) {
            (Some(step_k), _) => level::levelled(pixels, columns, step_k),
            (None, Some(values)) => values.iter().zip(&*pixels).map(|(t, own)| (*t, own.sigma_k)).collect(),
            (None, None) => Vec::new(),
        };
        for (pixel, (temperature_k, sigma_k)) in pixels.iter_mut().zip(temperatures_k) {
            if pixel.temperature_k.is_finite() && temperature_k.is_finite() {
                (pixel.temperature_k, pixel.sigma_k) = (temperature_k, sigma_k);
            }
        }
        let changed = again.iter().map(|(_, count)| count).sum();
        Ok((spared, Spatial { changed, ..chosen.about }))
    }

    /// Chooses among what is kept of an image of so many columns.
    fn choose(&self, kept: &Kept, columns: usize) -> Chosen {
        match *self {
            Self::Potts { weight, temperature_step_k } => {
                let step_k = temperature_step_k.unwrap_or_else(|| level::step_k(kept, columns));
                let beliefs = Beliefs::new(kept, columns, weight, step_k);
                let places = (0..kept.pixels()).map(|i| beliefs.best(kept, i)).collect();
                let about = Spatial {
                    changed: 0,
                    sweeps: beliefs.sweeps,
                    settled: beliefs.settled,
                    temperature_step_k: step_k.is_finite().then_some(step_k),
                };
                Chosen { places, beliefs: Some(beliefs), temperatures_k: None, about }
            }
            Self::TexSgd { weight } => {
                let sgd::Found { places, temperatures_k, sweeps, settled } =
                    sgd::minimised(kept, columns, weight);
                let about = Spatial { changed: 0, sweeps, settled, temperature_step_k: None };
                Chosen { places, beliefs: None, temperatures_k: Some(temperatures_k), about }
            }
        }
    }
}

impl Beliefs {
    /// Puts the posterior of pixel `i`, the materials that 95 % of it leave, and their categories in the place of those of its own counts.
    pub(super) fn put(&self, kept: &Kept, i: usize, task: &Task, pixel: &mut Pixel) {
        let alike = |kind: u16| task.alike.get(usize::from(kind)).copied().unwrap_or(1);
        let mut order: Vec<(f64, usize, Option<usize>)> = Vec::new();
        for (candidate, belief) in kept.of(i).iter().zip(self.of(kept, i)) {
            let count = candidate.kind.map_or(kept.others(i), alike);
            order.push((f64::from(*belief), count, candidate.kind.map(usize::from)));
        }
        let Some(&(belief, count, chosen)) = order.get(self.best(kept, i)) else { return };
        pixel.posterior = belief / count.max(1) as f64;
        order.sort_by(|a, b| b.0.total_cmp(&a.0));
        let (mut held, mut candidates) = (0.0, 0);
        if pixel.material != NO_MATERIAL {
            let each =
                order.iter().filter_map(|(belief, count, kind)| Some(((*kind)?, belief / *count as f64)));
            let others = each.filter(|(kind, _)| Some(*kind) != chosen);
            let ranked = task.ranked(chosen.map(|kind| (kind, pixel.posterior)).into_iter().chain(others));
            pixel.ranked = ranked;
        }
        if let Some(members) = &task.members {
            let beliefs: Vec<_> = order.iter().map(|(belief, _, kind)| (*kind, *belief)).collect();
            members.put(&beliefs, &mut pixel.possible);
        }
        for (belief, count, _) in order {
            if held >= CANDIDATE_SHARE {
                break;
            }
            held += belief;
            candidates += count;
        }
        pixel.candidates = candidates.min(usize::from(u16::MAX)) as u16;
        pixel.flags &= !flag::UNDECIDED;
        pixel.flags |= if candidates > 1 { flag::UNDECIDED } else { 0 };
    }
}
