//! Which blackbodies through which filters tell the most of a response in a given time.
//!
//! Readings i of some candidates (temperature, filter) share the time: a reading of the share p_i has the variance σ²/p_i, σ that of one
//! that takes all of it. With r = m + A z and an offset for each filter, the information on z and offsets is
//!
//! M(p) = diag(1, ε) + Σ p_i s_i s_iᵀ,
//!
//! and the design is the one of the largest ln det M − ln det M_offsets, twice the information on z in nats (D_s-optimal with a prior).
//! ε stands for offsets that are known to a thousand deviations of a reading of all the time, next to nothing: without it a filter that
//! has no time has no derivative. Every share is multiplied by the root of its own derivative over the mean derivative (Silvey,
//! Titterington and Torsney, Commun. Statist. A 7, 1379 (1978); without the root shares of two temperatures go to and fro) until, by
//! concavity, no design gains more than [`Design::gap_nats`] = max_i d_i − Σ p_i d_i,
//! d_i = s_iᵀM⁻¹s_i − 1/(ε + Σ_{same filter} p). Filters are chosen by
//! leaving out those of the smallest shares in the best design of those left, a third of the surplus at a time: good, not proved to
//! be the best set.
//!
//! Assumptions: as in [`hadar::calibration::filter_wheel`], exact temperatures, the same noise in every reading of the same time.

use hadar::calibration::determined::CurvePrior;
use hadar::calibration::filter_wheel::{FilterWheel, Reading};
use hadar::calibration::sent::Sent;
use hadar::error::{Error, Result, check};
use hadar::order;
use hadar::planck;
use nalgebra::{Cholesky, DMatrix, DVector};

/// ε, in units of the noise of a reading of all the time.
const OFFSET_KNOWN: f64 = 1e-6;
/// A share that may grow again.
const LEAST_SHARE: f64 = 1e-9;
/// Shares of the time below this are no readings.
const SMALL_SHARE: f64 = 1e-4;
/// A gap at which a design is called the best, nats.
const GAP_NATS: f64 = 0.05;
const MOST_ROUNDS: usize = 3000;
/// Rounds while filters are left out.
const FEW_ROUNDS: usize = 60;

/// How the time is shared.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Design {
    /// Temperature (K), filter and share of the time.
    pub(crate) shares: Vec<(f64, usize, f64)>,
    /// What any other design of these candidates could gain at most, nats.
    pub(crate) gap_nats: f64,
}

impl Design {
    /// Its readings, where one of the whole time has the deviation `sigma`, counts.
    #[must_use]
    pub(crate) fn readings(&self, sigma: f64) -> Vec<Reading> {
        let mut temperatures: Vec<f64> = self.shares.iter().map(|share| share.0).collect();
        temperatures.sort_by(f64::total_cmp);
        temperatures.dedup();
        let place = |t: f64| temperatures.iter().position(|one| *one == t).unwrap_or(0);
        let reading = |(temperature_k, filter, share): &(f64, usize, f64)| Reading {
            blackbody: place(*temperature_k),
            sent: Sent::black(*temperature_k),
            filter: *filter,
            sigma: sigma / share.sqrt(),
        };
        self.shares.iter().map(reading).collect()
    }

    /// The same time at all temperatures through these filters.
    #[must_use]
    pub(crate) fn even(temperatures_k: &[f64], filters: &[usize]) -> Self {
        let share = 1.0 / (temperatures_k.len() * filters.len()) as f64;
        let shares = temperatures_k.iter().flat_map(|t| filters.iter().map(move |q| (*t, *q, share)));
        Self { shares: shares.collect(), gap_nats: f64::INFINITY }
    }

    /// The best one of these temperatures and filters.
    ///
    /// # Errors
    /// Fewer than two temperatures, no filter, a deviation that is not positive.
    pub(crate) fn best(
        wheel: &FilterWheel,
        prior: &CurvePrior,
        temperatures_k: &[f64],
        filters: &[usize],
        sigma: f64,
    ) -> Result<Self> {
        Self::after(MOST_ROUNDS, wheel, prior, temperatures_k, (filters, sigma))
    }

    fn after(
        most_rounds: usize,
        wheel: &FilterWheel,
        prior: &CurvePrior,
        temperatures_k: &[f64],
        (filters, sigma): (&[usize], f64),
    ) -> Result<Self> {
        check::positive("deviation of a reading", sigma, "counts")?;
        if temperatures_k.len() < 2 || filters.is_empty() {
            let found = format!("{} temperatures and {} filters", temperatures_k.len(), filters.len());
            return Err(Error::malformed(found, "give two temperatures or more, and a filter"));
        }
        if let Some(filter) = filters.iter().find(|filter| **filter >= wheel.filters()) {
            let found = format!("filter {filter} of {}", wheel.filters());
            return Err(Error::malformed(found, "count from 0"));
        }
        let scores = scores(wheel, prior, temperatures_k, filters, sigma)?;
        let (values, count) = (prior.unknowns(), temperatures_k.len() * filters.len());
        let mut shares = vec![1.0 / count as f64; count];
        let (mut gap_nats, mut rounds) = (f64::INFINITY, 0);
        while gap_nats > GAP_NATS && rounds < most_rounds {
            let gains = gains(&scores, &shares, filters.len(), values)?;
            let mean: f64 = gains.iter().zip(&shares).map(|(d, p)| d * p).sum();
            gap_nats = gains.iter().copied().fold(0.0, f64::max) - mean;
            shares.iter_mut().zip(&gains).for_each(|(p, d)| *p = (*p * (d / mean).sqrt()).max(LEAST_SHARE));
            let total: f64 = shares.iter().sum();
            shares.iter_mut().for_each(|p| *p /= total);
            rounds += 1;
        }
        let kept = (0..count).filter(|i| shares[*i] > SMALL_SHARE);
        let total: f64 = kept.clone().map(|i| shares[i]).sum();
        let shares = kept.map(|i| {
            let (k, q) = (i / filters.len(), i % filters.len());
            (temperatures_k[k], filters[q], shares[i] / total)
        });
        Ok(Self { shares: shares.collect(), gap_nats })
    }

    /// The best one of `count` filters among all of the wheel.
    ///
    /// # Errors
    /// As [`Design::best`].
    pub(crate) fn best_filters(
        wheel: &FilterWheel,
        prior: &CurvePrior,
        temperatures_k: &[f64],
        count: usize,
        sigma: f64,
    ) -> Result<Self> {
        let mut left: Vec<usize> = (0..wheel.filters()).collect();
        let count = count.max(1);
        while left.len() > count {
            let design = Self::after(FEW_ROUNDS, wheel, prior, temperatures_k, (&left, sigma))?;
            let share = |q: &usize| -> f64 {
                design.shares.iter().filter(|share| share.1 == *q).map(|share| share.2).sum()
            };
            let fewer = left.len() - ((left.len() - count) / 3).max(1);
            order::descending(&mut left, share);
            left.truncate(fewer);
            left.sort_unstable();
        }
        Self::best(wheel, prior, temperatures_k, &left, sigma)
    }
}

/// Scores of z, then of the offsets, of every candidate at the whole time; temperatures outside, filters inside.
fn scores(
    wheel: &FilterWheel,
    prior: &CurvePrior,
    temperatures_k: &[f64],
    filters: &[usize],
    sigma: f64,
) -> Result<DMatrix<f64>> {
    let (centres, values) = (wheel.centres_cm1(), prior.unknowns());
    if prior.mean().len() != centres.len() {
        let what = "values of a response".into();
        return Err(Error::Length { what, found: prior.mean().len(), expected: centres.len() });
    }
    let origin_k = temperatures_k.iter().sum::<f64>() / temperatures_k.len() as f64;
    check::positive("temperature of a blackbody", origin_k, "K")?;
    let (mut base, mut apart) = (vec![0.0; centres.len()], vec![0.0; centres.len()]);
    planck::photon_radiance_into(centres, origin_k, &mut base);
    let mut out = DMatrix::zeros(temperatures_k.len() * filters.len(), values + filters.len());
    for (k, t) in temperatures_k.iter().enumerate() {
        planck::photon_radiance_difference_into(centres, origin_k, t - origin_k, &base, &mut apart);
        for (place, q) in filters.iter().enumerate() {
            let row = k * filters.len() + place;
            for (j, apart) in apart.iter().enumerate() {
                let weight = wheel.weight(*q, j) * apart / sigma;
                for z in 0..values {
                    out[(row, z)] += weight * prior.factor()[(j, z)];
                }
            }
            // An offset in units of the noise.
            out[(row, values + place)] = 1.0;
        }
    }
    Ok(out)
}

/// d_i of every candidate.
fn gains(scores: &DMatrix<f64>, shares: &[f64], filters: usize, values: usize) -> Result<Vec<f64>> {
    let mut weighted = scores.clone();
    for (mut row, share) in weighted.row_iter_mut().zip(shares) {
        row.scale_mut(share.max(0.0).sqrt());
    }
    let mut information = weighted.tr_mul(&weighted);
    (0..values).for_each(|z| information[(z, z)] += 1.0);
    let time = |q: usize| shares.iter().skip(q).step_by(filters).sum::<f64>();
    let times: Vec<f64> = (0..filters).map(time).collect();
    for q in 0..filters {
        information[(values + q, values + q)] += OFFSET_KNOWN;
    }
    let Some(factor) = Cholesky::new(information) else {
        return Err(Error::malformed(
            "the information of the readings is not positive",
            "give temperatures that are further apart, or a larger noise",
        ));
    };
    let gain = |i: usize| {
        let score = DVector::from_iterator(scores.ncols(), scores.row(i).iter().copied());
        let image = factor.l_dirty().solve_lower_triangular(&score).map_or(0.0, |x| x.norm_squared());
        (image - 1.0 / (OFFSET_KNOWN + times[i % filters])).max(0.0)
    };
    Ok((0..scores.nrows()).map(gain).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use hadar::calibration::determined::{CurveSmoothness, Determined};

    fn wheel() -> (FilterWheel, CurvePrior) {
        let centres: Vec<f64> = (0..10).map(|j| 700.0 + 60.0 * f64::from(j)).collect();
        let pass = |at: f64| {
            centres.iter().map(|nu| 0.8 * libm::exp(-((nu - at) / 70.0).powi(2))).collect::<Vec<_>>()
        };
        let filters = vec![pass(800.0), pass(950.0), pass(960.0), pass(1150.0)];
        let known = CurveSmoothness { scale: 0.3, shape: 0.2, correlation_cm1: 150.0 };
        let prior = CurvePrior::smooth(&centres, &[0.8; 10], known).unwrap();
        (FilterWheel::new(centres, filters, 1e-18).unwrap(), prior)
    }

    /// ½ ln det(1 + AᵀJA) of a design, by the singular values that the other file computes.
    fn nats(design: &Design, sigma: f64) -> f64 {
        let (wheel, prior) = wheel();
        let scores = wheel.scores(&design.readings(sigma), None).unwrap();
        let found = (&scores * prior.factor()).singular_values();
        found.iter().map(|d| 0.5 * (d * d).ln_1p()).sum()
    }

    /// No even design over some of the temperatures and filters, and no change of the best one, gains more than the gap allows.
    #[test]
    fn the_best_design_is_not_beaten_beyond_its_gap() {
        let (wheel, prior) = wheel();
        let temperatures: Vec<f64> = (0..8).map(|k| 300.0 + 12.0 * f64::from(k)).collect();
        let all = [0, 1, 2, 3];
        let best = Design::best(&wheel, &prior, &temperatures, &all, 0.01).unwrap();
        assert!(best.gap_nats < 0.06, "{}", best.gap_nats);
        let most = nats(&best, 0.01);
        assert!(nats(&Design::even(&temperatures, &all), 0.01) < most);
        for some in [&[0, 1, 3][..], &[0, 3], &[1, 2], &all] {
            for ends in [&temperatures[..2], &temperatures[..5], &temperatures[3..], &[300.0, 384.0]] {
                let other = nats(&Design::even(ends, some), 0.01);
                assert!(other <= most + 0.5 * best.gap_nats + 1e-3, "{other} {most}");
            }
        }
        // Two filters that are nearly one: of three, one of them goes.
        let three = Design::best_filters(&wheel, &prior, &temperatures, 3, 0.01).unwrap();
        let has = |q: usize| three.shares.iter().any(|share| share.1 == q);
        assert!(has(0) && has(3) && !(has(1) && has(2)));
        let scores = wheel.scores(&best.readings(0.01), None).unwrap();
        assert!(Determined::of(&scores, &prior).unwrap().number >= 3);
    }
}
