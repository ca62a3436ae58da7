//! Two surfaces in one pixel: two materials of the library, each with its own temperature and lighting, and its share of the pixel.
//!
//! S = f S₁ + (1 − f) S₂, the share f of each at least a tenth: less than that is told as one surface. The likelihood of every pair is averaged over all
//! states ([`mean_likelihood`]), and compared with that of the best single material averaged likewise: the freedom of two temperatures,
//! two lightings and a share is paid for. With π the prior of a mixed pixel and πₘ those of the materials, a pair has π πₐ π_b / Σ π π.
//!
//! A pair is not fitted where a bound says that it cannot count: all that it can send lies near the space that the spectra of both materials span
//! ([`super::space`]), and a mean likelihood is at most the largest one, so that −2 ln of it is at least the deviance of the counts' distance
//! from that space ([`super::screen`]).
//!
//! Assumptions: the emissivities of the library are exact and the gain is known. Two surfaces of the same material are one.

mod factor;
mod mean_likelihood;
mod parts;
mod way;

use super::fit::Fit;
use super::model::Model;
use super::screen::{Screen, Screened};
use super::space::{Space, dot, norm, remove, unit};
use super::thresholds::NO_MATERIAL;
use hadar::error::{Error, Result};
use mean_likelihood::{Found, most_probable};
use parts::start;

/// Materials of a library of which pairs are formed, at most: their number grows with the square.
pub const MOST_MIXED: usize = 64;
/// −2 ln of the odds, to the best of all hypotheses, at which a pair no longer counts: 5e-5.
const BESIDE: f64 = 20.0;
/// The same at which a pair is looked at from one start alone, both parts as warm as the best single material.
const NEAR: f64 = 8.0;
/// How far two parts are from the temperature of the best single material at further starts, K.
const APART_K: f64 = 15.0;
/// Share of the probability of a mixed pixel of which the pairs are told.
const TOLD: f64 = 0.99;

/// A pixel as two surfaces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mixture {
    /// Posterior probability that a pixel holds two surfaces; 0 where that is not asked.
    pub probability: f64,
    /// The materials of the likeliest pair, that of the larger share first; [`NO_MATERIAL`] where no pair counts.
    pub materials: [u16; 2],
    /// Share of the first, and its deviation.
    pub share: [f64; 2],
    /// Temperature of each, K.
    pub temperature_k: [f64; 2],
    /// Their deviations, K.
    pub sigma_k: [f64; 2],
}

impl Mixture {
    /// One surface.
    pub(super) const NOTHING: Self = Self {
        probability: 0.0,
        materials: [NO_MATERIAL; 2],
        share: [f64::NAN; 2],
        temperature_k: [f64::NAN; 2],
        sigma_k: [f64::NAN; 2],
    };
}

/// The hypothesis.
#[derive(Debug)]
pub(super) struct Mixed {
    pairs: Vec<Pair>,
    /// (1 − π)/π.
    pub(super) odds_against: f64,
}

/// Two kinds.
#[derive(Debug)]
struct Pair {
    kinds: [usize; 2],
    /// −2 ln of its prior, to that of the most probable material of the library.
    handicap: f64,
    /// Orthonormal directions of the second one's space that the first one's lacks, one after the other.
    directions: Vec<f64>,
    /// The farthest that a mixture is from the common space.
    left_out: f64,
}

/// Room for one pixel's work, and what was found of it.
#[derive(Debug, Default)]
pub(super) struct Workplace {
    room: parts::Room,
    order: Vec<(f64, usize)>,
    /// Pairs that count, with what they cost on the scale of the deviances of single materials.
    found: Vec<(f64, usize, Found)>,
}

impl Workplace {
    /// Looks at all bands since they were asked for.
    pub(super) fn looks(&mut self) -> u64 {
        std::mem::take(&mut self.room.looks)
    }
}

impl Mixed {
    /// Of prior probability `probability`, beside `single` of one surface of the library.
    pub(super) fn new(
        model: &Model,
        screen: Option<&Screen>,
        (kinds, prior, alike): (&[usize], &[f64], &[usize]),
        [probability, single]: [f64; 2],
    ) -> Result<Self> {
        let is_share = probability > 0.0 && probability < 1.0 && single > 0.0;
        if !is_share {
            let quantity = "probability that a pixel holds two surfaces";
            return Err(Error::out_of_range(
                quantity,
                probability,
                "",
                "above 0 and, with all others, below 1",
            ));
        }
        if kinds.len() > MOST_MIXED {
            let found = format!("mixed pixels of {} materials", kinds.len());
            return Err(Error::malformed(
                found,
                format!("give at most {MOST_MIXED}, or leave mixed pixels out"),
            ));
        }
        let weight = |kind: usize| prior[kinds[kind]] * alike[kind] as f64;
        let all: f64 = (0..kinds.len()).map(weight).sum();
        let most = prior.iter().copied().fold(0.0, f64::max);
        let pairs = || (0..kinds.len()).flat_map(|a| (a + 1..kinds.len()).map(move |b| [a, b]));
        let of_pairs: f64 = pairs().map(|[a, b]| weight(a) * weight(b)).sum();
        let spaces: Vec<Space> = match screen {
            Some(screen) => kinds.iter().map(|&m| screen.space(model, m)).collect(),
            None => Vec::new(),
        };
        let pair = |[a, b]: [usize; 2]| {
            let share = probability * weight(a) * weight(b) / of_pairs;
            let handicap = -2.0 * libm::log(share * all / (single * most));
            let (mut directions, mut left_out) = (Vec::new(), f64::INFINITY);
            if let (Some(first), Some(second)) = (spaces.get(a), spaces.get(b)) {
                let mut of_both: Vec<Vec<f64>> = Vec::new();
                for own in second.directions() {
                    let mut rest = own.clone();
                    for _ in 0..2 {
                        first.directions().chain(&of_both).for_each(|q| remove(&mut rest, q));
                    }
                    // Of what lies in the first one's space only rounding is left.
                    of_both.extend(unit(rest, 1e-9 * norm(own)));
                }
                directions = of_both.concat();
                left_out = first.left_out.max(second.left_out);
            }
            Pair { kinds: [a, b], handicap, directions, left_out }
        };
        Ok(Self { pairs: pairs().map(pair).collect(), odds_against: (1.0 - probability) / probability })
    }

    /// Fits the pairs that no bound excludes, beside the best single fit, of material `m`, worth so much with its prior; −2 ln of what all
    /// pairs are worth, on that scale.
    pub(super) fn fit(
        &self,
        (model, kinds): (&Model, &[usize]),
        (m, best, worth): (usize, &Fit, f64),
        screened: Option<(&Screen, &Screened)>,
        shifted: &[f64],
        workplace: &mut Workplace,
    ) -> f64 {
        let Workplace { room, order, found } = workplace;
        found.clear();
        let t = best.state.temperature_k;
        let from = start(model, [m], [t]);
        let Some(single) = most_probable(model, &from, shifted, f64::INFINITY, room) else {
            return f64::INFINITY;
        };
        // From −2 ln of mean likelihoods to deviances of single materials.
        let scale = best.deviance - single.cost;
        order.clear();
        order.extend(self.pairs.iter().enumerate().map(|(i, pair)| (pair.outside(screened), i)));
        order.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut least = worth;
        for &(_, i) in &*order {
            let pair = &self.pairs[i];
            let enough = least + BESIDE - pair.handicap - scale;
            if screened.is_some_and(|seen| pair.is_beyond(enough, seen)) {
                continue;
            }
            let from = start(model, pair.kinds.map(|kind| kinds[kind]), [t, t]);
            let Some(one) = most_probable(model, &from, shifted, enough, room) else { continue };
            let cost = one.cost + pair.handicap + scale;
            least = least.min(cost);
            found.push((cost, i, one));
        }
        // Those that count once more, from parts of different temperatures.
        for (cost, i, one) in found.iter_mut().filter(|(cost, ..)| *cost < least + NEAR) {
            let besides = self.pairs[*i].handicap + scale;
            for by in [APART_K, -APART_K] {
                let from = start(model, one.parts.map(|part| part.m), [t + by, t - by]);
                if let Some(other) = most_probable(model, &from, shifted, one.cost, room)
                    && other.cost < one.cost
                {
                    (*one, *cost) = (other, other.cost + besides);
                }
            }
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        let Some((least, ..)) = found.first() else { return f64::INFINITY };
        let sum: f64 = found.iter().map(|(cost, ..)| libm::exp(-0.5 * (cost - least))).sum();
        least - 2.0 * libm::log(sum)
    }

    /// What is told of a mixed pixel of this probability, and χ² of the likeliest pair with the number of its unknowns.
    pub(super) fn told(
        &self,
        model: &Model,
        workplace: &Workplace,
        probability: f64,
    ) -> (Mixture, Option<(f64, usize)>) {
        let Some((_, _, found)) = workplace.found.first() else { return (Mixture::NOTHING, None) };
        let [mut first, mut second] = found.parts;
        if second.share > first.share {
            std::mem::swap(&mut first, &mut second);
        }
        let mixture = Mixture {
            probability,
            materials: [first.m as u16, second.m as u16],
            share: [first.share, first.sigma_share],
            temperature_k: [first.temperature_k, second.temperature_k],
            sigma_k: [first.sigma_k, second.sigma_k],
        };
        (mixture, Some((found.chi_square, 1 + 2 * model.vertices)))
    }

    /// Kinds of the pairs that hold 99 % of what all pairs are worth.
    pub(super) fn kinds_left<'a>(
        &'a self,
        workplace: &'a Workplace,
    ) -> impl Iterator<Item = [usize; 2]> + 'a {
        let least = workplace.found.first().map_or(0.0, |(cost, ..)| *cost);
        let weight = move |cost: f64| libm::exp(-0.5 * (cost - least));
        let all: f64 = workplace.found.iter().map(|(cost, ..)| weight(*cost)).sum();
        let mut held = 0.0;
        workplace.found.iter().map_while(move |(cost, i, _)| {
            let is_left = held < TOLD * all;
            held += weight(*cost);
            is_left.then(|| self.pairs[*i].kinds)
        })
    }
}

impl Pair {
    /// Squared distance of a pixel's counts from the common space.
    fn outside(&self, screened: Option<(&Screen, &Screened)>) -> f64 {
        let Some((screen, seen)) = screened else { return 0.0 };
        let white = seen.white();
        let each = self.directions.chunks_exact(white.len()).map(|q| dot(q, white).powi(2));
        (screen.outside(self.kinds[0], seen) - each.sum::<f64>()).max(0.0)
    }

    /// Whether no mixture of the two costs less than that.
    fn is_beyond(&self, cost: f64, (screen, seen): (&Screen, &Screened)) -> bool {
        let reach = screen.reach(cost.max(0.0), seen);
        self.outside(Some((screen, seen))) > (reach + self.left_out).powi(2)
    }
}

#[cfg(test)]
mod tests;
