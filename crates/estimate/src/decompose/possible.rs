//! Which categories a pixel may be of: those of its candidates, and those that cannot be excluded.
//!
//! With qₘ the posterior of material m, πₘ its prior (Σ π = 1) and Cₘ the set of the categories that it is a part of:
//! * at 95 %: the union of Cₘ over the candidates (the fewest materials that hold 95 % of the posterior), and their intersection;
//! * at 99 %: the union over the fewest that hold 99 %, and over every m with qₘ/(1 − qₘ) · (1 − πₘ)/πₘ > 0.01/0.99.
//!
//! The second condition of the latter gives m as much prior as all others together. For materials of known temperature and lighting, the ratio of
//! the others' mean likelihood to that of m is 1 in the mean where m is there, so it exceeds 99 in at most 1 % of its pixels (Markov):
//! a material that is there is excluded so rarely however many others the library has. With profile likelihoods that holds as far as all
//! materials profit alike from what is fitted. The share of pixels of which 99 % of the posterior lack what is there is 1 % only in the
//! mean over the prior.
//!
//! A set is a number whose bit c stands for category c, at most [`MOST`], and [`OTHER`] for a material that is in none. A pixel that fits
//! nothing, tells nothing or was left out can be of any: [`ANYTHING`].
//!
//! Shares: Σₘ qₘ [c ∈ Cₘ]/|Cₘ|, the posterior of a material in equal parts for its categories.
//!
//! With Dₘ the least deviance of m, both conditions fail where Dₘ > minₗ (Dₗ − 2 ln πₗ) + 2 ln 99 and m is e¹² times less probable than the best: the
//! one l alone makes the ratio exceed 99. No fit is dropped on less, whatever the priors and however many materials there are.
//!
//! Assumptions: the model and the library hold.

use super::fit::Fit;
use hadar::error::{Error, Result};

/// Share of the posterior that the candidates hold.
pub const CANDIDATE_SHARE: f64 = 0.95;
/// Posteriors that are the same.
pub(super) const TIE: f64 = 1e-9;
/// Categories at most.
pub const MOST: usize = 63;
/// The bit of a material that is in no category.
pub const OTHER: u64 = 1 << MOST;
/// Every category, and none.
pub const ANYTHING: u64 = u64::MAX;
/// Share of the posterior beyond which a category counts as excluded, and of the pixels of a material that it is excluded in, at most.
pub const MISSED: f64 = 0.01;

/// The categories that a pixel may be of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Possible {
    /// Categories of any of its candidates.
    pub at_95: u64,
    /// Categories that each of its candidates is a part of.
    pub common_95: u64,
    /// Categories that cannot be excluded at 99 %.
    pub at_99: u64,
}

impl Possible {
    /// Nothing is known.
    pub const ANYTHING: Self = Self { at_95: ANYTHING, common_95: ANYTHING, at_99: ANYTHING };

    const NOTHING: Self = Self { at_95: 0, common_95: ANYTHING, at_99: 0 };
}

/// What the kinds of a library are parts of.
#[derive(Debug)]
pub(super) struct Members {
    /// Categories of any of the equal materials of each kind.
    all: Vec<u64>,
    /// Categories of each of them.
    common: Vec<u64>,
    /// For each kind and category, the number of its equal materials, in parts.
    parts: Vec<f64>,
    /// (1 − π)/π of one material of each kind.
    odds_against: Vec<f64>,
    /// How many of the equal materials of each kind there are.
    alike: Vec<usize>,
    /// Deviance without a prior, beyond the best one with it, from which on a kind of little posterior is excluded: 2 ln (99 Σ π/max π).
    pub(super) cut: f64,
    /// How many categories there are.
    pub(super) count: usize,
}

impl Members {
    /// From the categories of each material, the kind of each, and −2 ln π of each kind (in any scale).
    ///
    /// # Errors
    /// Categories of another number of materials.
    pub(super) fn new(
        categories: &[u64],
        kind_of: &[usize],
        alike: &[usize],
        handicap: &[f64],
    ) -> Result<Option<Self>> {
        let (found, expected) = (categories.len(), kind_of.len());
        if found == 0 {
            return Ok(None);
        }
        if found != expected {
            return Err(Error::Length { what: "materials with categories".into(), found, expected });
        }
        let used = categories.iter().fold(0, |all, own| all | own) & !OTHER;
        let count = (u64::BITS - used.leading_zeros()) as usize;
        let kinds = alike.len();
        let (mut all, mut common) = (vec![0; kinds], vec![ANYTHING; kinds]);
        let mut parts = vec![0.0; kinds * count];
        for (own, &kind) in categories.iter().zip(kind_of) {
            let own = if *own == 0 { OTHER } else { *own };
            all[kind] |= own;
            common[kind] &= own;
            let each = 1.0 / f64::from((own & !OTHER).count_ones().max(1));
            for (c, part) in parts[kind * count..(kind + 1) * count].iter_mut().enumerate() {
                *part += if own >> c & 1 == 1 { each } else { 0.0 };
            }
        }
        let priors: Vec<f64> = handicap.iter().map(|h| libm::exp(-0.5 * h)).collect();
        let sum: f64 = priors.iter().zip(alike).map(|(prior, alike)| prior * *alike as f64).sum();
        let odds_against = priors.iter().map(|prior| (sum - prior) / prior).collect();
        let most = priors.iter().copied().fold(0.0, f64::max);
        let cut = 2.0 * libm::log((1.0 - MISSED) / MISSED * sum / most);
        Ok(Some(Self { all, common, parts, odds_against, alike: alike.to_vec(), cut, count }))
    }

    /// What the fits of a pixel leave, the likeliest first; `weight` is the posterior of one material of a fit, `candidates` how many of the
    /// fits are candidates. The shares of the categories are put into `shares`.
    pub(super) fn possible(
        &self,
        fits: &[(usize, Fit)],
        weight: impl Fn(&Fit) -> f64,
        candidates: usize,
        shares: &mut Vec<f32>,
    ) -> Possible {
        let posteriors = || fits.iter().map(|(kind, fit)| (Some(*kind), weight(fit)));
        shares.clear();
        shares.extend((0..self.count).map(|c| {
            posteriors().map(|(kind, each)| each * self.part(kind, c)).sum::<f64>().min(1.0) as f32
        }));
        let mut possible =
            posteriors().take(candidates).fold(Possible::NOTHING, |sum, (kind, _)| self.with(sum, kind));
        possible.at_99 = self.left(posteriors());
        possible
    }

    /// A pair of kinds besides: among the candidates, and among what 99 % leave.
    pub(super) fn add_pair(
        &self,
        possible: &mut Possible,
        kinds: [usize; 2],
        [is_candidate, is_left]: [bool; 2],
    ) {
        for kind in kinds {
            if is_candidate {
                *possible = self.with(*possible, Some(kind));
            }
            if is_left || is_candidate {
                possible.at_99 |= self.all[kind];
            }
        }
    }

    fn part(&self, kind: Option<usize>, category: usize) -> f64 {
        kind.and_then(|kind| self.parts.get(kind * self.count + category).copied()).unwrap_or(0.0)
    }

    /// A set of candidates with one more, of any kind where it is not known.
    fn with(&self, mut possible: Possible, kind: Option<usize>) -> Possible {
        let of = |sets: &[u64]| kind.and_then(|kind| sets.get(kind).copied()).unwrap_or(ANYTHING);
        possible.at_95 |= of(&self.all);
        possible.common_95 &= of(&self.common);
        possible
    }

    /// What cannot be excluded of kinds with the posterior of one material of each, the likeliest first.
    fn left(&self, posteriors: impl Iterator<Item = (Option<usize>, f64)>) -> u64 {
        let (mut held, mut last, mut left) = (0.0, 0.0, 0);
        for (kind, each) in posteriors {
            let Some(kind) = kind else { return ANYTHING };
            let odds = each / (1.0 - each).max(f64::MIN_POSITIVE);
            let is_excluded = odds * self.odds_against[kind] <= MISSED / (1.0 - MISSED);
            // What is too small to be a number is not excluded.
            let is_left = !is_excluded;
            if held < 1.0 - MISSED || each >= last * (1.0 - TIE) || is_left {
                left |= self.all[kind];
            }
            if held < 1.0 - MISSED {
                last = each;
            }
            held += each * self.alike[kind] as f64;
        }
        left
    }

    /// Puts what a prior over the image leaves in the place of what the counts of a pixel leave: kinds with the posterior of all their
    /// materials, the likeliest first. What the counts alone do not exclude stays possible at 99 %.
    pub(super) fn put(&self, beliefs: &[(Option<usize>, f64)], of_pixel: &mut Possible) {
        if *of_pixel == Possible::ANYTHING {
            return;
        }
        let (mut held, mut possible) = (0.0, Possible::NOTHING);
        for (kind, belief) in beliefs {
            if held >= CANDIDATE_SHARE {
                break;
            }
            possible = self.with(possible, *kind);
            held += belief;
        }
        let each = |(kind, belief): &(Option<usize>, f64)| {
            let alike = kind.and_then(|kind| self.alike.get(kind)).copied().unwrap_or(1);
            (*kind, belief / alike as f64)
        };
        let known = || beliefs.iter().filter(|(kind, belief)| kind.is_some() || *belief > 0.0).map(each);
        possible.at_99 = of_pixel.at_99 | self.left(known());
        *of_pixel = possible;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::decompose::step::State;
    use proptest::prelude::*;

    /// Fits of these posteriors, the likeliest first, of as many kinds.
    fn fits(posteriors: &[f64]) -> Vec<(usize, Fit)> {
        let fit = |p: &f64| Fit { state: State::at(300.0), deviance: -2.0 * libm::log(*p), chi_square: 0.0 };
        posteriors.iter().map(fit).enumerate().collect()
    }

    fn of(categories: &[u64], posteriors: &[f64], candidates: usize) -> (Possible, Vec<f32>) {
        let kinds: Vec<usize> = (0..categories.len()).collect();
        let (alike, handicap) = (vec![1; kinds.len()], vec![0.0; kinds.len()]);
        let members = Members::new(categories, &kinds, &alike, &handicap).unwrap().unwrap();
        let mut shares = Vec::new();
        let weight = |fit: &Fit| libm::exp(-0.5 * fit.deviance);
        (members.possible(&fits(posteriors), weight, candidates, &mut shares), shares)
    }

    #[test]
    fn a_material_of_two_categories_leaves_both_and_one_of_none_the_other() {
        let (possible, shares) = of(&[0b011, 0b001, 0], &[0.96, 0.03, 0.01], 1);
        assert_eq!((possible.at_95, possible.common_95), (0b011, 0b011));
        assert_eq!(possible.at_99, 0b011 | OTHER);
        assert!((shares[0] - 0.51).abs() < 1e-6 && (shares[1] - 0.48).abs() < 1e-6);
        let (possible, _) = of(&[0b011, 0b001, 0], &[0.90, 0.08, 0.02], 2);
        assert_eq!((possible.at_95, possible.common_95), (0b011, 0b001));
    }

    /// A library of many materials does not exclude the one that is there for being one of many.
    #[test]
    fn a_material_counts_beside_a_crowd_as_much_as_beside_one() {
        let mut posteriors = vec![0.1; 9];
        posteriors.extend([0.0995, 0.0005]);
        let categories: Vec<u64> = (0..11).map(|m| if m == 10 { 1 } else { 2 }).collect();
        // 0.0005 of the posterior are odds of 0.005 against ten others with a tenth of the prior each.
        assert_eq!(of(&categories, &posteriors, 10).0.at_99, 2);
        posteriors[9..].copy_from_slice(&[0.098, 0.002]);
        assert_eq!(of(&categories, &posteriors, 10).0.at_99, 3);
    }

    proptest! {
        /// A material that would be left with a prior of a half is left: its fit is among those that count, whatever its prior and however
        /// many others there are.
        #[test]
        fn what_a_prior_of_a_half_leaves_is_left(
            deviances in prop::collection::vec(0.0_f64..60.0, 2..8),
            logs in prop::collection::vec(-27.0_f64..0.0, 8),
            alike in prop::collection::vec(prop_oneof![Just(1_usize), 1..20_000_usize], 8),
        ) {
            let count = deviances.len();
            let (alike, priors) = (&alike[..count], logs[..count].iter().map(|log| libm::exp(*log)));
            let priors: Vec<f64> = priors.collect();
            let most = priors.iter().copied().fold(0.0, f64::max);
            let handicap: Vec<f64> = priors.iter().map(|prior| -2.0 * libm::log(prior / most)).collect();
            let kind_of: Vec<usize> =
                (0..count).flat_map(|kind| std::iter::repeat_n(kind, alike[kind])).collect();
            let categories: Vec<u64> = kind_of.iter().map(|kind| 1 << kind).collect();
            let members = Members::new(&categories, &kind_of, alike, &handicap).unwrap().unwrap();
            let with = |kind: usize| deviances[kind] + handicap[kind];
            let best = (0..count).map(with).fold(f64::INFINITY, f64::min);
            let beyond = |kind: usize| super::super::thresholds::beyond(handicap[kind], Some(&members));
            let mut kept: Vec<(usize, f64)> = (0..count)
                .filter(|kind| deviances[*kind] <= best + beyond(*kind))
                .map(|kind| (kind, libm::exp(-0.5 * (with(kind) - best))))
                .collect();
            kept.sort_by(|a, b| b.1.total_cmp(&a.1));
            let total: f64 = kept.iter().map(|(kind, weight)| alike[*kind] as f64 * weight).sum();
            let left = members.left(kept.iter().map(|(kind, weight)| (Some(*kind), weight / total)));
            for kind in 0..count {
                let others = |other: usize| alike[other] as f64 - f64::from(u8::from(other == kind));
                let sum = |of: &dyn Fn(usize) -> f64| (0..count).map(|o| others(o) * of(o)).sum::<f64>();
                let mean = sum(&|o| priors[o] * libm::exp(-0.5 * deviances[o])) / sum(&|o| priors[o]);
                let ratio = libm::exp(-0.5 * deviances[kind]) / mean;
                prop_assert!(ratio < 1.001 * MISSED / (1.0 - MISSED) || left >> kind & 1 == 1, "{kind}: {ratio}");
            }
        }

        /// What is a candidate is not excluded, and what all candidates are is what one of them is.
        #[test]
        fn sets_hold_one_another(
            weights in prop::collection::vec(0.001_f64..1.0, 1..12),
            categories in prop::collection::vec(0_u64..8, 12),
        ) {
            let sum: f64 = weights.iter().sum();
            let mut posteriors: Vec<f64> = weights.iter().map(|w| w / sum).collect();
            posteriors.sort_by(|a, b| b.total_cmp(a));
            let mut held = 0.0;
            let candidates = posteriors.iter().take_while(|p| { let more = held < CANDIDATE_SHARE; held += *p; more }).count();
            let (possible, shares) = of(&categories[..posteriors.len()], &posteriors, candidates);
            prop_assert_eq!(possible.at_95 & !possible.at_99, 0);
            prop_assert_eq!(possible.common_95 & !possible.at_95, 0);
            prop_assert!(shares.iter().sum::<f32>() <= 1.0 + 1e-5);
        }
    }
}
