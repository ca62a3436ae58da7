//! A surface of none of the library's materials: an emissivity that is smooth, and otherwise unknown.
//!
//! Its emissivity is drawn from a Gaussian process of constant mean μ, deviation s and the law of [`super`] along wavenumbers, with a
//! quarter of the correlation left at ℓ. Of the laws of [`SMOOTH`] and [`GREY`] the one counts that costs a pixel least: nearly black as
//! paints, fabrics and plants are, anything between a mirror and a blackbody, or hardly changing along wavenumber at all. Such a surface costs
//! rᵀC⁻¹r + ln det C + ln det(I + P) at its best temperature and lighting, and a material that is known the same with its own
//! C and information I, P the inverse variances of temperature and lighting within their ranges: −2 ln of the mean likelihood over
//! these (Laplace). The freedom of the emissivity is paid for by the determinant, so that a material of the library that fits
//! wins where the counts tell it from what is merely smooth, and does not where they do not.
//!
//! The odds are within a factor of 10 of those of likelihoods integrated over temperature and lighting, of 3 in most pixels.
//!
//! With π its prior probability and πₘ those of the library's (Σ πₘ = 1 − π), its posterior is that of one more material.
//!
//! Assumptions: the emissivity is Gaussian, so a little of it lies beyond 0 and 1. The best of some laws costs less than their mean:
//! a surface that is none of these is excluded more seldom than its prior says, never more often.

use super::*;
use crate::decompose::fit::scan;
use crate::decompose::kernel::{Asked as Looked, mean_counts, sums as look};
use crate::decompose::setting::Setting;
use nalgebra::DMatrix;
use std::ops::Range;

/// Mean and deviation of an emissivity: a quarter of the correlation left over so many cm⁻¹, and those of grey surfaces.
const LAWS: [[f64; 2]; 6] = [[0.95, 0.03], [0.9, 0.06], [0.75, 0.15], [0.4, 0.25], [0.93, 0.05], [0.2, 0.1]];
const SMOOTH: Range<usize> = 0..4;
const SMOOTH_CM1: f64 = 100.0;
const GREY: Range<usize> = 4..6;
const GREY_CM1: f64 = 5000.0;
/// Shares of the range of temperatures at which a fit starts besides.
const ACROSS: [f64; 3] = [0.1, 0.4, 0.7];
/// The law whose flat emissivity a start is looked for with.
const START: usize = 1;

/// The hypothesis, of the bands and lights of a setting.
#[derive(Debug)]
pub(in crate::decompose) struct Other {
    model: Model,
    /// Of smooth surfaces, and of grey ones.
    errors: [(Range<usize>, Errors); 2],
    /// −2 ln of its prior, to that of the most probable material of the library.
    handicap: f64,
    /// (1 − π)/π.
    odds_against: f64,
}

impl Other {
    /// Of prior probability `probability`, beside `single` of one surface of the library, whose materials have priors in any scale.
    pub(in crate::decompose) fn new(
        setting: &Setting<'_>,
        [probability, single]: [f64; 2],
        prior: &[f64],
    ) -> Result<Self> {
        let is_share = probability > 0.0 && probability < 1.0 && single > 0.0;
        if !is_share {
            let quantity = "probability that a surface is none of the library";
            return Err(Error::out_of_range(
                quantity,
                probability,
                "",
                "above 0 and, with all others, below 1",
            ));
        }
        let flat: Vec<Vec<f64>> =
            LAWS.iter().map(|[mean, _]| vec![*mean; setting.bands.nodes_cm1().len()]).collect();
        let model = Model::new(&Setting { library: &flat, ..*setting })?;
        let of = |correlation_cm1: f64| Errors::new(&model, LibraryError { relative: 1.0, correlation_cm1 });
        let errors = [(SMOOTH, of(SMOOTH_CM1)?), (GREY, of(GREY_CM1)?)];
        let (all, most) = prior.iter().fold((0.0, 0.0_f64), |(all, most), p| (all + p, most.max(*p)));
        let handicap = 2.0 * libm::log(single * most / (probability * all));
        Ok(Self { model, errors, handicap, odds_against: (1.0 - probability) / probability })
    }

    /// Its best fit, with the cost of its prior, on the scale of the deviance of `best`, material `m` of `library`, and its law.
    pub(in crate::decompose) fn fit(
        &self,
        (library, m, best): (&Model, usize, &Fit),
        errors: Option<&Errors>,
        (shifted, workplace, sums): (&[f64], &mut Workplace, &mut Sums),
        looks: &mut u64,
    ) -> Option<(usize, Fit)> {
        let from = scan(&self.model, START, shifted, sums, looks);
        let [low, high] = self.model.range_k;
        let mut starts = [best.state, from, from, from, from];
        for (start, share) in starts[2..].iter_mut().zip(ACROSS) {
            start.temperature_k = share.mul_add(high - low, low);
        }
        for (laws, errors) in &self.errors {
            for start in starts {
                for m in laws.clone() {
                    let ([mean, deviation], none) = (LAWS[m], f64::INFINITY);
                    let share = deviation / mean;
                    let asked =
                        Asked { kind: 0, m, share, start, short: COMPARED, beside: none, worse: none };
                    workplace.queue.push(asked);
                }
            }
            *looks += workplace.run(&self.model, errors, shifted, sums) as u64;
        }
        let least = |a: &(Asked, Fit, f64), b: &(Asked, Fit, f64)| a.1.deviance.total_cmp(&b.1.deviance);
        let (asked, fit, _) = workplace.done.drain(..).min_by(least)?;
        let (_, fit) = self.told((asked.m, fit), (shifted, workplace, sums));
        let narrower = volume(&self.model, sums);
        let state = &best.state;
        let offset = match errors {
            // Of exact materials deviances are known, which Σ ln N′ and χ² become but for what is the same for all.
            None => {
                let mixture = &state.mixture[..library.vertices];
                let at = Looked { m, shifted, temperature_k: state.temperature_k, mixture };
                look(library, at, sums);
                best.chi_square + logarithm_of_all(&mean_counts(library, at)) - best.deviance
            }
            Some(errors) => {
                workplace.fit(library, errors, m, shifted, *state, sums);
                0.0
            }
        };
        let deviance = fit.deviance - offset + narrower - volume(library, sums) + self.handicap;
        Some((asked.m, Fit { deviance, ..fit }))
    }

    /// (1 − π)/π.
    pub(in crate::decompose) fn odds_against(&self) -> f64 {
        self.odds_against
    }

    /// The same to its end; the sums are those of the last look.
    pub(in crate::decompose) fn told(
        &self,
        (law, fit): (usize, Fit),
        (shifted, workplace, sums): (&[f64], &mut Workplace, &mut Sums),
    ) -> (&Model, Fit) {
        let [mean, deviation] = LAWS[law];
        let none = f64::INFINITY;
        let (m, share, start) = (law, deviation / mean, fit.state);
        workplace.queue.push(Asked { kind: 0, m, share, start, short: TOLD, beside: none, worse: none });
        let [smooth, grey] = &self.errors;
        let (_, errors) = if smooth.0.contains(&law) { smooth } else { grey };
        workplace.run(&self.model, errors, shifted, sums);
        (&self.model, workplace.done.pop().map_or(fit, |(_, fit, _)| fit))
    }
}

/// ln det(I + P) of what was seen at a state, by Gauss's elimination: no pivot of I + P is below that of P.
fn volume(model: &Model, seen: &Sums) -> f64 {
    let count = model.unknowns();
    let width_k = model.range_k[1] - model.range_k[0];
    let prior = |i: usize| 12.0 / if i == 0 { width_k * width_k } else { 1.0 };
    let mut rest =
        DMatrix::from_fn(count, count, |i, j| seen.information[i][j] + if i == j { prior(i) } else { 0.0 });
    let mut sum = 0.0;
    for i in 0..count {
        let pivot = rest[(i, i)].max(prior(i));
        sum += libm::log(pivot);
        for j in i + 1..count {
            let factor = rest[(j, i)] / pivot;
            for k in i + 1..count {
                rest[(j, k)] -= factor * rest[(i, k)];
            }
        }
    }
    sum
}

#[cfg(test)]
mod tests;
