//! No choice does better: upper bounds on the distance that any selection keeps.
//!
//! For a pair p and a selection S, d_p²(S) = ¼ min_c Σ_S r_pw(c)². Hence for any shares λ_p ≥ 0 of sum 1 and
//! any coefficients c_p whatever, min_p d_p²(S) ≤ ¼ Σ_S Σ_p λ_p r_pw(c_p)²: what a single row adds no longer
//! depends on the others, and the best S on the right is found outright (the largest k terms; for filters
//! by dynamic programming). A [`Certificate`] (λ, c) is therefore a proof, however it was come by.
//!
//! The least bound equals max over mixtures z of selections of min_p f_p(z), f_p concave (minimax theorem). It is
//! approached by Frank and Wolfe's method: fit c to the mixture, λ from a soft minimum that hardens, mix in
//! the selection that is best against (λ, c), by as much as helps. The average of certificates is a better
//! one than they are (the right-hand side is convex in (λ, λc)), and is tried too. The selections met on the way
//! are good ones.
//!
//! Source: Jaggi, Proc. 30th Int. Conf. on Machine Learning, 427 (2013); for selection of measurements by convex
//! relaxation Joshi and Boyd, IEEE Trans. Signal Process. 57, 451 (2009), doi:10.1109/TSP.2008.2007095.

use super::information::normalised;
use super::pair::{Fit, Pair};
use crate::minimum::golden_section;
use std::convert::Infallible;
use std::ops::Range;

/// Share of rounding that a bound is raised by.
const ROUNDING: f64 = 1e-11;
/// Share by which a bound may exceed what it proves to be the best.
const PROOF: f64 = 1e-9;
/// Hardness of the soft minimum at the first round and its growth per round.
const HARDNESS: (f64, f64) = (5.0, 2.0);
/// Selections kept to start from.
const KEPT: usize = 4;
/// Steps of the search for how much to mix in.
const LINE_STEPS: usize = 10;

/// Shares λ and coefficients c: a proof that nothing is better than its bound.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Certificate {
    pub(super) shares: Vec<f64>,
    pub(super) coefficients: Vec<Vec<f64>>,
}

impl Certificate {
    /// The fits of all bands, and shares that make the pairs count alike there.
    pub(super) fn first(pairs: &[Pair]) -> Self {
        let least = pairs.iter().map(Pair::whole).fold(f64::INFINITY, f64::min);
        Self {
            shares: normalised(pairs.iter().map(|pair| (least / pair.whole()).powi(2)).collect()),
            coefficients: pairs.iter().map(|pair| vec![0.0; pair.width() - 1]).collect(),
        }
    }

    /// Shares that lean to the pairs of least value, and the fits of the normal equations.
    pub(super) fn fitted(pairs: &[Pair], grams: &[Vec<f64>], hardness: f64) -> Self {
        crate::stop::check();
        let mut fit = Fit::default();
        let (mut squares, mut coefficients) = (Vec::new(), Vec::new());
        for (pair, gram) in pairs.iter().zip(grams) {
            fit.solve(gram, pair.width());
            squares.push(fit.square);
            coefficients.push(fit.coefficients.clone());
        }
        Self { shares: soft_minimum(&squares, hardness).1, coefficients }
    }

    /// What the priors add to any selection.
    pub(super) fn prior_cost(&self, pairs: &[Pair]) -> f64 {
        let costs = pairs.iter().zip(&self.coefficients).map(|(pair, c)| pair.prior_cost(c));
        costs.zip(&self.shares).map(|(cost, share)| share * cost).sum()
    }
}

/// Finds the selection that is best against a certificate.
pub(super) trait Opponent {
    /// That selection, and its Σ_S Σ_p λ_p r_pw²: an upper bound on (d/required)² of any selection.
    fn best(&mut self, pairs: &[Pair], certificate: &Certificate) -> (Vec<Range<usize>>, f64);
}

/// What the search for a bound has found.
#[derive(Debug, Clone)]
pub(super) struct Bounded {
    /// No selection has a greater (d/required)².
    pub(super) square: f64,
    pub(super) certificate: Certificate,
    /// The best selections met, with the least distance over requirement among the pairs.
    pub(super) met: Vec<(f64, Vec<Range<usize>>)>,
}

/// Least distance over requirement among the pairs, and of which.
pub(super) fn worst(pairs: &[Pair], filters: &[Range<usize>]) -> (f64, usize) {
    let distances = pairs.iter().map(|pair| pair.distance(filters)).enumerate();
    distances.fold((f64::INFINITY, 0), |least, (p, d)| if d < least.0 { (d, p) } else { least })
}

/// The least bound that `rounds` rounds find.
pub(super) fn bound(pairs: &[Pair], opponent: &mut impl Opponent, rounds: usize) -> Bounded {
    let mut certificate = Certificate::first(pairs);
    let mut found = Bounded {
        square: f64::INFINITY,
        certificate: certificate.clone(),
        met: Vec::with_capacity(KEPT + 1),
    };
    let mut mixture: Option<Vec<Vec<f64>>> = None;
    let mut average = Average::new(pairs);
    for round in 0..rounds.max(1) {
        crate::stop::check();
        let (selection, square) = opponent.best(pairs, &certificate);
        found.learn(square, &certificate);
        let grams: Vec<Vec<f64>> = pairs.iter().map(|pair| pair.gram(&selection)).collect();
        found.meet(pairs, selection);
        average.add(&certificate, (round + 1) as f64);
        if round % 8 == 7 {
            let mean = average.certificate();
            let (selection, square) = opponent.best(pairs, &mean);
            found.learn(square, &mean);
            found.meet(pairs, selection);
        }
        if round == rounds / 4 {
            average = Average::new(pairs);
        }
        let hardness = HARDNESS.0 + HARDNESS.1 * round as f64;
        mixture = Some(match mixture {
            None => grams,
            Some(old) => mixed(pairs, &old, &grams, hardness),
        });
        if let Some(mixture) = &mixture {
            certificate = Certificate::fitted(pairs, mixture, hardness);
        }
        if found.met.first().is_some_and(|first| found.proves(first.0)) {
            break;
        }
    }
    found
}

impl Bounded {
    /// Whether nothing is better than a selection of this distance, but for rounding.
    pub(super) fn proves(&self, distance: f64) -> bool {
        self.square <= distance * distance * (1.0 + PROOF)
    }

    pub(super) fn learn(&mut self, square: f64, certificate: &Certificate) {
        let square = square * (1.0 + ROUNDING);
        if square < self.square {
            self.square = square;
            self.certificate = certificate.clone();
        }
    }

    fn meet(&mut self, pairs: &[Pair], selection: Vec<Range<usize>>) {
        if self.met.iter().any(|met| met.1 == selection) {
            return;
        }
        let (distance, _) = worst(pairs, &selection);
        let place = self.met.partition_point(|met| met.0 >= distance);
        self.met.insert(place, (distance, selection));
        self.met.truncate(KEPT);
    }
}

/// The soft minimum of the values, and the share of each in it.
fn soft_minimum(values: &[f64], hardness: f64) -> (f64, Vec<f64>) {
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    let most = values.iter().copied().fold(0.0, f64::max);
    let scale = least.max(1e-15 * most);
    if !(scale > 0.0 && scale.is_finite()) {
        return (0.0, vec![1.0 / values.len() as f64; values.len()]);
    }
    let mut shares: Vec<f64> = values.iter().map(|v| (-hardness * (v - least) / scale).exp()).collect();
    let total: f64 = shares.iter().sum();
    shares.iter_mut().for_each(|share| *share /= total);
    (least - scale * total.ln() / hardness, shares)
}

/// The mixture of two normal equations that has the greatest soft minimum.
fn mixed(pairs: &[Pair], old: &[Vec<f64>], new: &[Vec<f64>], hardness: f64) -> Vec<Vec<f64>> {
    let blend = |part: f64| -> Vec<Vec<f64>> {
        let one = |(a, b): (&Vec<f64>, &Vec<f64>)| a.iter().zip(b).map(|(a, b)| a + part * (b - a)).collect();
        old.iter().zip(new).map(one).collect()
    };
    let mut fit = Fit::default();
    let mut value = |part: f64| {
        let squares: Vec<f64> = pairs
            .iter()
            .zip(blend(part))
            .map(|(pair, gram)| {
                fit.solve(&gram, pair.width());
                fit.square
            })
            .collect();
        soft_minimum(&squares, hardness).0
    };
    // The value is concave up to the scale of the soft minimum.
    let Ok([low, high]) = golden_section::<Infallible>([0.0, 1.0], LINE_STEPS, |part| Ok(-value(part)));
    blend(0.5 * (low + high))
}

/// Weighted mean of certificates: of λ and of λc.
struct Average {
    weight: f64,
    shares: Vec<f64>,
    products: Vec<Vec<f64>>,
}

impl Average {
    fn new(pairs: &[Pair]) -> Self {
        Self {
            weight: 0.0,
            shares: vec![0.0; pairs.len()],
            products: pairs.iter().map(|pair| vec![0.0; pair.width() - 1]).collect(),
        }
    }

    fn add(&mut self, certificate: &Certificate, weight: f64) {
        self.weight += weight;
        let entries = certificate.shares.iter().zip(&certificate.coefficients);
        for ((share, product), (s, c)) in self.shares.iter_mut().zip(&mut self.products).zip(entries) {
            *share += weight * s;
            product.iter_mut().zip(c).for_each(|(sum, c)| *sum += weight * s * c);
        }
    }

    fn certificate(&self) -> Certificate {
        let coefficients = self.products.iter().zip(&self.shares).map(|(product, share)| {
            product.iter().map(|sum| if *share > 0.0 { sum / share } else { 0.0 }).collect()
        });
        Certificate {
            shares: self.shares.iter().map(|share| share / self.weight).collect(),
            coefficients: coefficients.collect(),
        }
    }
}
