//! Blackbodies seen through the filters of a wheel, as readings of the camera's response.
//!
//! The mean reading of filter q before a blackbody of temperature T is (S49, at the centre of the image where η = 1)
//!
//! C(T, q) = g Σ_j r_j Δν T_qj B_j(T) + K_q + ξ,
//!
//! r_j the response at W wavenumbers in units of its peak. What the filter adds, K_q + ξ, is unknown and one number for each filter. The
//! paper takes the reading of a reference object off (S51), C(T_k, q) − C(T₀, q): all differences then share the noise of the
//! reference. An unknown offset for each filter, to which every reading tells its part, the reference among them, is the same
//! with these correlations right, and is what is done here: its span is removed from the scores. Blackbodies whose temperatures are
//! uncertain by u_k have an unknown each, common to all filters, held by the row 1/u_k; emissivities and surroundings as well, B_j(T) being
//! what a blackbody sends ([`super::sent`]).
//!
//! | symbol | unit |
//! |---|---|
//! | g | counts per photon s⁻¹ m⁻² sr⁻¹ |
//! | ν, Δν | cm⁻¹ |
//! | B | photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹ |
//! | T, u | K |
//! | C, K, σ | counts |
//!
//! Assumptions: σ of a reading is known and independent of r; the sum stands for the integral, as the paper has it;
//! how fine a sum that takes is [`super::finer`]'s.

use super::determined::without;
use super::sent::{Sent, Unknown};
use crate::error::{Error, Result, check};
use nalgebra::DMatrix;

/// Filters before a camera of unknown response.
#[derive(Debug, Clone, PartialEq)]
pub struct FilterWheel {
    centres_cm1: Vec<f64>,
    step_cm1: f64,
    transmittances: Vec<Vec<f64>>,
    counts_per_radiance: f64,
}

/// A blackbody read through a filter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading {
    /// Which blackbody: readings of the same one have the same error of its temperature.
    pub blackbody: usize,
    /// What it sends.
    pub sent: Sent,
    /// Which filter.
    pub filter: usize,
    /// Deviation of the reading, counts.
    pub sigma: f64,
}

impl FilterWheel {
    /// Response values at evenly spaced wavenumbers, the transmittance of each filter there, and the counts g.
    ///
    /// # Errors
    /// No filter, fewer than two values or uneven ones, transmittances outside [0, 1] or of another number, g not positive.
    pub fn new(
        centres_cm1: Vec<f64>,
        transmittances: Vec<Vec<f64>>,
        counts_per_radiance: f64,
    ) -> Result<Self> {
        let (Some(first), Some(last), true) =
            (centres_cm1.first(), centres_cm1.last(), centres_cm1.len() > 1 && !transmittances.is_empty())
        else {
            let found = format!("{} response values and {} filters", centres_cm1.len(), transmittances.len());
            return Err(Error::malformed(found, "give two values or more, and a filter"));
        };
        check::positive("wavenumber of a response value", *first, "cm^-1")?;
        check::positive("counts per radiance", counts_per_radiance, "")?;
        let step_cm1 = check::positive(
            "step of the response values",
            (last - first) / (centres_cm1.len() - 1) as f64,
            "cm^-1",
        )?;
        let even = |pair: &[f64]| (pair[1] - pair[0] - step_cm1).abs() < 1e-6 * step_cm1;
        if !centres_cm1.windows(2).all(even) {
            return Err(Error::malformed("response values at uneven wavenumbers", "space them evenly"));
        }
        for filter in &transmittances {
            if filter.len() != centres_cm1.len() {
                let what = "transmittances of a filter".into();
                return Err(Error::Length { what, found: filter.len(), expected: centres_cm1.len() });
            }
            filter.iter().try_for_each(|t| check::unit_interval("transmittance", *t).map(drop))?;
        }
        Ok(Self { centres_cm1, step_cm1, transmittances, counts_per_radiance })
    }

    /// Wavenumbers of the response values.
    #[must_use]
    pub fn centres_cm1(&self) -> &[f64] {
        &self.centres_cm1
    }

    /// Filters.
    #[must_use]
    pub fn filters(&self) -> usize {
        self.transmittances.len()
    }

    /// Transmittances of a filter at the response values.
    #[must_use]
    pub fn transmittance(&self, filter: usize) -> &[f64] {
        &self.transmittances[filter]
    }

    /// g Δν T_qj, by which a radiance at value j becomes counts of filter q at a response of 1.
    #[must_use]
    pub fn weight(&self, filter: usize, value: usize) -> f64 {
        self.counts_per_radiance * self.step_cm1 * self.transmittances[filter][value]
    }

    /// Counts of a filter before a spectrum, without offsets.
    #[must_use]
    pub fn counts(&self, filter: usize, response: &[f64], radiance: &[f64]) -> f64 {
        (0..self.centres_cm1.len()).map(|j| self.weight(filter, j) * response[j] * radiance[j]).sum()
    }

    /// Filters of which the transmittances, times the response of at most 1, are a combination of those before them: the first such
    /// one, and the one that it is the most like.
    #[must_use]
    pub fn dependent(&self) -> Option<[usize; 2]> {
        const ALIKE: f64 = 1e-6;
        let unit = |q: usize| {
            let column = nalgebra::DVector::from_column_slice(&self.transmittances[q]);
            let length = column.norm();
            if length > 0.0 { column / length } else { column }
        };
        let mut basis: Vec<nalgebra::DVector<f64>> = Vec::new();
        for q in 0..self.filters() {
            let mut rest = unit(q);
            for _ in 0..2 {
                for one in &basis {
                    let along = one.dot(&rest);
                    rest.axpy(-along, one, 1.0);
                }
            }
            let left = rest.norm();
            if left < ALIKE {
                let like = |p: &usize| unit(*p).dot(&unit(q));
                let most = (0..q).max_by(|a, b| like(a).total_cmp(&like(b))).unwrap_or(q);
                return Some([most, q]);
            }
            basis.push(rest / left);
        }
        None
    }

    /// Counts that each unknown of its blackbody moves a reading by, a camera of this response before it: none of other blackbodies.
    pub fn moved<'a>(
        &'a self,
        reading: &'a Reading,
        unknowns: &'a [Unknown],
        response: &'a [f64],
    ) -> impl Iterator<Item = f64> + 'a {
        let mut slope = vec![0.0; self.centres_cm1.len()];
        unknowns.iter().map(move |one| {
            if one.blackbody != reading.blackbody {
                return 0.0;
            }
            reading.sent.slope_into(one.of, &self.centres_cm1, &mut slope);
            self.counts(reading.filter, response, &slope)
        })
    }

    /// Refuses readings of filters and blackbodies that are not there.
    ///
    /// # Errors
    /// Those, temperatures and deviations that are not positive.
    pub fn check(&self, readings: &[Reading], unknowns: &[Unknown]) -> Result<()> {
        for reading in readings {
            reading.sent.check()?;
            check::positive("deviation of a reading", reading.sigma, "counts")?;
            let known = |one: &Unknown| one.blackbody == reading.blackbody;
            if reading.filter >= self.filters() || !(unknowns.is_empty() || unknowns.iter().any(known)) {
                let found = format!("filter {} of blackbody {}", reading.filter, reading.blackbody);
                return Err(Error::malformed(found, "count both from 0"));
            }
        }
        Ok(())
    }

    /// Scores of the response values, the offsets of all filters removed, and what is unknown of the blackbodies, with the response about
    /// which that is taken; nothing if they are exact.
    ///
    /// # Errors
    /// A filter or blackbody that is not there, temperatures or deviations that are not positive.
    pub fn scores(&self, readings: &[Reading], errors: Option<(&[Unknown], &[f64])>) -> Result<DMatrix<f64>> {
        let values = self.centres_cm1.len();
        let (unknowns, response) = errors.unwrap_or_default();
        self.check(readings, unknowns)?;
        let rows = readings.len() + unknowns.len();
        let mut scores = DMatrix::zeros(rows, values);
        let mut others = DMatrix::zeros(rows, self.filters() + unknowns.len());
        let mut apart = vec![0.0; values];
        for (i, reading) in readings.iter().enumerate() {
            // Radiances from that of the first on: what they have in common is the offset's.
            reading.sent.apart_into(&readings[0].sent, &self.centres_cm1, &mut apart);
            for j in 0..values {
                scores[(i, j)] = self.weight(reading.filter, j) * apart[j] / reading.sigma;
            }
            others[(i, reading.filter)] = 1.0 / reading.sigma;
            for (u, (moved, one)) in self.moved(reading, unknowns, response).zip(unknowns).enumerate() {
                // In units of the deviation that is known beforehand.
                others[(i, self.filters() + u)] = moved * one.deviation / reading.sigma;
            }
        }
        (0..unknowns.len()).for_each(|u| others[(readings.len() + u, self.filters() + u)] = 1.0);
        Ok(without(&scores, &others))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planck;
    use nalgebra::Cholesky;

    fn wheel() -> FilterWheel {
        let centres: Vec<f64> = (0..8).map(|j| 700.0 + 80.0 * f64::from(j)).collect();
        let pass = |at: f64| {
            centres.iter().map(|nu| 0.8 * libm::exp(-((nu - at) / 90.0).powi(2))).collect::<Vec<_>>()
        };
        let filters = vec![pass(800.0), pass(950.0), pass(1150.0)];
        FilterWheel::new(centres, filters, 1e-18).unwrap()
    }

    /// The paper's differences from a reference, whose noise all of them share, by their covariance: the same information.
    #[test]
    fn an_offset_for_each_filter_is_the_reference_with_its_common_noise() {
        let wheel = wheel();
        let temperatures = [308.15, 320.0, 340.0, 365.0];
        let mut readings = Vec::new();
        for (k, t) in temperatures.iter().enumerate() {
            for q in 0..3 {
                let sigma = 0.2 + 0.05 * (k + q) as f64;
                readings.push(Reading { blackbody: k, sent: Sent::black(*t), filter: q, sigma });
            }
        }
        let scores = wheel.scores(&readings, None).unwrap();
        let ours = scores.tr_mul(&scores);
        let mut theirs = DMatrix::zeros(8, 8);
        for q in 0..3 {
            let of = |k: usize| readings.iter().find(|r| r.blackbody == k && r.filter == q).unwrap();
            let slope = DMatrix::from_fn(3, 8, |k, j| {
                let b = |t| planck::photon_radiance(wheel.centres_cm1()[j], t);
                wheel.weight(q, j) * (b(temperatures[k + 1]) - b(temperatures[0]))
            });
            let covariance = DMatrix::from_fn(3, 3, |a, b| {
                let own = if a == b { of(a + 1).sigma.powi(2) } else { 0.0 };
                own + of(0).sigma.powi(2)
            });
            let solved = Cholesky::new(covariance).unwrap().solve(&slope);
            theirs += slope.tr_mul(&solved);
        }
        let scale = theirs.amax();
        assert!((ours - theirs).amax() < 1e-9 * scale);
    }

    /// Uncertain temperatures by the covariance of the readings, in which an error of a blackbody is common to its filters.
    #[test]
    fn uncertain_temperatures_are_errors_common_to_all_filters() {
        let wheel = wheel();
        let response = vec![0.3, 0.6, 0.9, 1.0, 0.9, 0.8, 0.5, 0.2];
        let temperatures = [308.15, 330.0, 365.0];
        let errors = [0.03, 0.05, 0.02];
        let mut readings = Vec::new();
        for (k, t) in temperatures.iter().enumerate() {
            for q in 0..3 {
                readings.push(Reading { blackbody: k, sent: Sent::black(*t), filter: q, sigma: 0.3 });
            }
        }
        let unknowns = Unknown::temperatures(&errors);
        let scores = wheel.scores(&readings, Some((&unknowns, &response))).unwrap();
        let ours = scores.tr_mul(&scores);
        // Offsets stand in the covariance with a deviation beside which nothing counts.
        let slope: Vec<f64> = readings
            .iter()
            .map(|r| {
                let b: Vec<f64> = wheel
                    .centres_cm1()
                    .iter()
                    .map(|nu| planck::photon_radiance_slope(*nu, r.sent.temperature_k))
                    .collect();
                wheel.counts(r.filter, &response, &b)
            })
            .collect();
        let covariance = DMatrix::from_fn(9, 9, |a, b| {
            let (ra, rb) = (readings[a], readings[b]);
            let own = if a == b { 0.09 } else { 0.0 };
            let offset = if ra.filter == rb.filter { 1e6 } else { 0.0 };
            let shared = if ra.blackbody == rb.blackbody { errors[ra.blackbody].powi(2) } else { 0.0 };
            own + offset + shared * slope[a] * slope[b]
        });
        let design = DMatrix::from_fn(9, 8, |i, j| {
            let b = planck::photon_radiance(wheel.centres_cm1()[j], readings[i].sent.temperature_k);
            wheel.weight(readings[i].filter, j) * b
        });
        let solved = Cholesky::new(covariance).unwrap().solve(&design);
        let theirs = design.tr_mul(&solved);
        let scale = theirs.amax();
        assert!((&ours - &theirs).amax() < 1e-4 * scale, "{}", (ours - theirs).amax() / scale);
    }

    #[test]
    fn a_filter_that_is_a_mixture_of_others_is_named() {
        let wheel = wheel();
        assert_eq!(wheel.dependent(), None);
        let mut filters: Vec<Vec<f64>> = (0..3).map(|q| wheel.transmittance(q).to_vec()).collect();
        filters.push(filters[0].iter().zip(&filters[2]).map(|(a, b)| 0.3 * a + 0.6 * b).collect());
        let more = FilterWheel::new(wheel.centres_cm1().to_vec(), filters, 1.0).unwrap();
        assert_eq!(more.dependent(), Some([2, 3]));
    }
}
