//! The response of a camera from blackbodies read through filters, by least squares with a smooth curve expected.
//!
//! Unknown are the z of a response r = m + A z ([`CurvePrior`]: about the typical curve, smooth), an offset K_q of each filter and the
//! errors δ_k of the blackbodies' temperatures (emissivities, surroundings) in units of their deviation u_k. Rows, each in units of its deviation:
//!
//! | rows | z | K | δ/u |
//! |---|---|---|---|
//! | readings | g Δν Σ_j T_qj B_j(T_k) A_j/σ | 1/σ | g Δν Σ_j r_j T_qj B′_j(T_k) u_k/σ |
//! | prior | 1 | 0 | 0 |
//! | prior | 0 | 0 | 1 |
//!
//! solved by their triangular factor; the columns of δ are taken at the response of a first pass. The covariance of r is G Gᵀ, with
//! Gᵀ = F⁻ᵀ[A 0 0]ᵀ by a triangular solve. Units: as in [`hadar::calibration::filter_wheel`].
//!
//! A scene behind filter q, the reference of temperature T₀ taken off (S51), has the mean radiance
//!
//! S̄_q = [(C − C⁰)/η + G_q(B(T₀))]/G_q(1),   G_q(X) = g Δν Σ_j r_j T_qj X_j,
//!
//! whose error common to all pixels is that of r: ∂S̄_q/∂r_j = g Δν T_qj (B_j(T₀) − S̄_q)/G_q(1).
//!
//! The sum stands for an integral: on a grid that is too coarse for the prior its error is far beyond the noise, and no deviation holds it.
//! The wheel and the prior belong on the parts of [`hadar::calibration::finer`]; [`Response::at_values`] then has the values.
//!
//! Assumptions: normal readings; η = 1 where they are made; the prior is true. Where it is not, the estimate is off by (K − 1)(r − m), K the
//! resolving kernels: curves of another covariance P′ have errors of covariance N Nᵀ + (K − 1) P′ (K − 1)ᵀ ([`Response::of_curves`]), N what
//! the readings' errors and the blackbodies' become: N = G F⁻ᵀ Hᵀ over their rows H, and K = N W, W the readings' derivatives by r.

use hadar::calibration::determined::CurvePrior;
use hadar::calibration::filter_wheel::{FilterWheel, Reading};
use hadar::calibration::finer::Finer;
use hadar::calibration::sent::{Of, Unknown};
use hadar::error::{Error, Result, check};
use hadar::planck;
use nalgebra::{DMatrix, DVector};

/// Share of a column that is left of it below which it is rounding.
const FITTED: f64 = 1e-9;

/// A response with its covariance.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Response {
    /// r, in units of the typical curve's peak.
    pub values: Vec<f64>,
    /// G of its covariance G Gᵀ, a row for each value.
    pub factor: DMatrix<f64>,
    /// K_q, counts, with ξ of the place.
    pub offsets: Vec<f64>,
    /// Errors of the blackbodies as found, one of each unknown.
    pub shifts: Vec<f64>,
    /// Σ of the squared residuals in units of their deviations, priors included.
    pub chi_square: f64,
    /// Its part of the readings alone.
    pub chi_square_readings: f64,
    /// What that part is expected to be, n − tr H of the readings' rows; all of it is fitted where it is near 0.
    pub freedom: f64,
    /// Deviations of the K_q, counts.
    pub offset_sigmas: Vec<f64>,
    /// The blackbody by whose other temperature χ² falls most.
    pub worst: Option<Suspect>,
    /// N, a row for each value: the readings first, then the errors of the blackbodies.
    noise: DMatrix<f64>,
    /// W, a row for each reading.
    scores: DMatrix<f64>,
}

/// A blackbody whose temperature, were it free, would explain part of χ².
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Suspect {
    /// Its place.
    pub blackbody: usize,
    /// By how much warmer its readings are than they should be, K.
    pub shift_k: f64,
    /// By how much χ² falls.
    pub explains: f64,
}

/// A mean radiance behind a filter, photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct FilterRadiance {
    /// S̄.
    pub radiance: f64,
    /// Deviation by the response, common to all pixels.
    pub sigma_common: f64,
    /// What a count more adds, at η = 1.
    pub per_count: f64,
}

impl Response {
    /// From readings and their counts, and what is unknown of the blackbodies; nothing if they are exact.
    ///
    /// # Errors
    /// Lists of different lengths, readings that are no numbers, a filter or blackbody that is not there.
    pub fn found(
        wheel: &FilterWheel,
        prior: &CurvePrior,
        readings: &[Reading],
        counts: &[f64],
        unknowns: &[Unknown],
    ) -> Result<Self> {
        if readings.len() != counts.len() {
            let what = "counts of readings".into();
            return Err(Error::Length { what, found: counts.len(), expected: readings.len() });
        }
        counts.iter().try_for_each(|count| check::finite("count of a reading", *count, "").map(drop))?;
        wheel.check(readings, unknowns)?;
        let first = Self::pass(wheel, prior, readings, counts, (unknowns, prior.mean()))?;
        Self::pass(wheel, prior, readings, counts, (unknowns, &first.values))
    }

    fn pass(
        wheel: &FilterWheel,
        prior: &CurvePrior,
        readings: &[Reading],
        counts: &[f64],
        (unknowns, about): (&[Unknown], &[f64]),
    ) -> Result<Self> {
        let (n, filters, modes, others) = (readings.len(), wheel.filters(), prior.unknowns(), unknowns.len());
        let columns = modes + filters + others;
        let mut rows = DMatrix::zeros(n + modes + others, columns);
        let mut scores = DMatrix::zeros(n, prior.mean().len());
        let mut right = DVector::zeros(n + modes + others);
        let centres = wheel.centres_cm1();
        let mut radiance = vec![0.0; centres.len()];
        let (mut last, mut per_kelvin) = (None, Vec::with_capacity(n));
        for (i, (reading, count)) in readings.iter().zip(counts).enumerate() {
            if last != Some(reading.sent) {
                last = Some(reading.sent);
                reading.sent.radiance_into(centres, &mut radiance);
            }
            for (j, b) in radiance.iter().enumerate() {
                scores[(i, j)] = wheel.weight(reading.filter, j) * b / reading.sigma;
            }
            rows[(i, modes + reading.filter)] = 1.0 / reading.sigma;
            for (u, (moved, one)) in wheel.moved(reading, unknowns, about).zip(unknowns).enumerate() {
                rows[(i, modes + filters + u)] = moved * one.deviation / reading.sigma;
            }
            let warmer =
                Unknown { blackbody: reading.blackbody, of: Of::Temperature, deviation: f64::INFINITY };
            per_kelvin.extend(wheel.moved(reading, &[warmer], about).map(|moved| moved / reading.sigma));
            right[i] = (count - wheel.counts(reading.filter, prior.mean(), &radiance)) / reading.sigma;
        }
        rows.view_mut((0, 0), (n, modes)).copy_from(&(&scores * prior.factor()));
        (0..modes).for_each(|z| rows[(n + z, z)] = 1.0);
        (0..others).for_each(|k| rows[(n + modes + k, modes + filters + k)] = 1.0);
        let kept = (rows.clone(), right.clone());
        let qr = rows.qr();
        qr.q_tr_mul(&mut right);
        let factor = qr.r();
        let mut solved = right.rows(0, columns).clone_owned();
        let unread = || {
            Error::malformed(
                "a filter that no blackbody was read through",
                "leave it out, or give its readings",
            )
        };
        if !factor.solve_upper_triangular_mut(&mut solved) {
            return Err(unread());
        }
        let residual = kept.1 - &kept.0 * &solved;
        // F⁻ᵀ of columns, whose lengths are their variances after the fit.
        let within = |mut of: DMatrix<f64>| match factor.tr_solve_upper_triangular_mut(&mut of) {
            true => Ok(of),
            false => Err(unread()),
        };
        let freedom = n as f64 - within(kept.0.rows(0, n).transpose())?.norm_squared();
        let offset_sigmas =
            within(DMatrix::from_fn(columns, filters, |i, q| f64::from(u8::from(i == modes + q))))?;
        let mut worst: Option<Suspect> = None;
        for blackbody in 0..=readings.iter().map(|reading| reading.blackbody).max().unwrap_or(0) {
            let own = |i: usize| if readings[i].blackbody == blackbody { per_kelvin[i] } else { 0.0 };
            let column = DMatrix::from_fn(n, 1, |i, _| own(i));
            let along = (0..n).map(|i| own(i) * residual[i]).sum::<f64>();
            let left =
                column.norm_squared() - within(kept.0.rows(0, n).transpose() * &column)?.norm_squared();
            if left > FITTED * column.norm_squared()
                && worst.is_none_or(|worst| along * along / left > worst.explains)
            {
                worst = Some(Suspect { blackbody, shift_k: along / left, explains: along * along / left });
            }
        }
        let mut covariance = DMatrix::zeros(columns, centres.len());
        covariance.rows_mut(0, modes).copy_from(&prior.factor().transpose());
        if !factor.tr_solve_upper_triangular_mut(&mut covariance) {
            return Err(unread());
        }
        let factor = covariance.transpose();
        let mut read = kept.0.remove_rows(n, modes).transpose();
        read = within(read)?;
        let shifts = (0..others).map(|u| solved[modes + filters + u] * unknowns[u].deviation);
        Ok(Self {
            values: prior.at(&solved.as_slice()[..modes]),
            noise: &factor * read,
            scores,
            factor,
            offsets: (0..filters).map(|q| solved[modes + q]).collect(),
            shifts: shifts.collect(),
            chi_square: residual.norm_squared(),
            chi_square_readings: residual.rows(0, n).norm_squared(),
            freedom,
            offset_sigmas: offset_sigmas.column_iter().map(|column| column.norm()).collect(),
            worst,
        })
    }

    /// The same with the values alone, of a response at all parts of them.
    #[must_use]
    pub fn at_values(&self, finer: &Finer) -> Self {
        let values = finer.at_values(&self.values);
        let at_values =
            |of: &DMatrix<f64>| DMatrix::from_fn(values.len(), of.ncols(), |j, k| of[(finer.place(j), k)]);
        Self { factor: at_values(&self.factor), noise: at_values(&self.noise), values, ..self.clone() }
    }

    /// The same estimate with the errors that it has where curves are `drawn` from another prior about the same typical curve.
    ///
    /// # Errors
    /// A prior of other places than the wheel's.
    pub fn of_curves(&self, drawn: &CurvePrior) -> Result<Self> {
        let (n, expected) = (self.scores.nrows(), self.scores.ncols());
        for found in [drawn.mean().len(), self.noise.nrows()] {
            if found != expected {
                return Err(Error::Length { what: "values of a response".into(), found, expected });
            }
        }
        let missed = self.noise.columns(0, n) * (&self.scores * drawn.factor()) - drawn.factor();
        let mut factor = self.noise.clone().resize_horizontally(self.noise.ncols() + missed.ncols(), 0.0);
        factor.columns_mut(self.noise.ncols(), missed.ncols()).copy_from(&missed);
        Ok(Self { factor, ..self.clone() })
    }

    /// Deviation of value j.
    #[must_use]
    pub fn sigma(&self, value: usize) -> f64 {
        self.factor.row(value).norm()
    }

    /// Mean radiance behind a filter of a scene whose counts lie `counts` above those of the reference at T₀ (K), η = 1.
    #[must_use]
    pub fn radiance(
        &self,
        wheel: &FilterWheel,
        filter: usize,
        counts: f64,
        reference_k: f64,
    ) -> FilterRadiance {
        let centres = wheel.centres_cm1();
        let mut reference = vec![0.0; centres.len()];
        planck::photon_radiance_into(centres, reference_k, &mut reference);
        let total = wheel.counts(filter, &self.values, &vec![1.0; centres.len()]);
        let radiance = (counts + wheel.counts(filter, &self.values, &reference)) / total;
        let sensitivity = DVector::from_fn(centres.len(), |j, _| {
            wheel.weight(filter, j) * (reference[j] - radiance) / total
        });
        FilterRadiance {
            radiance,
            sigma_common: self.factor.tr_mul(&sensitivity).norm(),
            per_count: 1.0 / total,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibrate::twin::{FilterWheelTwin, KNOWN, normal, response_values_cm1};
    use hadar::calibration::determined::Determined;
    use hadar::correlation::{exponential, matern};
    use hadar::random::generator;
    use nalgebra::Cholesky;

    /// Deviations by the triangular factor are those that the bound has by projections and singular values.
    #[test]
    fn deviations_of_the_estimate_are_those_of_the_bound() {
        let twin = FilterWheelTwin::prototype().unwrap();
        let (readings, errors) = (twin.readings(0.05), Unknown::temperatures(&[0.02; 31]));
        let counts = twin.means(&readings, &twin.response, &vec![0.0; 31]);
        for errors in [&errors[..], &[]] {
            let found = Response::found(&twin.wheel, &twin.prior, &readings, &counts, errors).unwrap();
            let about = (!errors.is_empty()).then_some((errors, &found.values[..]));
            let scores = twin.wheel.scores(&readings, about).unwrap();
            let bound = Determined::of(&scores, &twin.prior).unwrap();
            for j in 0..30 {
                let ratio = found.sigma(j) / bound.sigma_smooth[j];
                assert!((ratio - 1.0).abs() < 1e-3, "{j} {ratio}");
            }
        }
    }

    /// Without noise the estimate is what the resolving kernels make of the truth.
    #[test]
    fn the_bias_of_smoothness_is_that_of_the_kernels() {
        let twin = FilterWheelTwin::prototype().unwrap();
        let readings = twin.readings(0.5);
        let counts = twin.means(&readings, &twin.response, &vec![0.0; 31]);
        let found = Response::found(&twin.wheel, &twin.prior, &readings, &counts, &[]).unwrap();
        let kernels =
            Determined::of(&twin.wheel.scores(&readings, None).unwrap(), &twin.prior).unwrap().kernels;
        let off = DVector::from_fn(30, |j, _| twin.response[j] - twin.prior.mean()[j]);
        let seen = kernels * &off;
        for j in 0..30 {
            let expected = twin.prior.mean()[j] + seen[j];
            assert!((found.values[j] - expected).abs() < 1e-5, "{j} {} {expected}", found.values[j]);
        }
        assert!(found.offsets.iter().zip(&twin.offsets).all(|(a, b)| (a - b).abs() < 20.0));
    }

    /// The errors for curves of another prior are those of the fit where that prior is its own, blackbodies' errors among them.
    #[test]
    fn errors_for_curves_of_the_own_prior_are_the_own_ones() {
        let twin = FilterWheelTwin::cut(3).unwrap();
        let (readings, errors) = (twin.readings(0.5), Unknown::temperatures(&[0.02; 31]));
        let counts = twin.means(&readings, &twin.prior.at(&[0.3, -1.0, 0.5]), &vec![0.0; 31]);
        let found = Response::found(&twin.wheel, &twin.prior, &readings, &counts, &errors).unwrap();
        let again = found.of_curves(&twin.prior).unwrap();
        for j in 0..90 {
            assert!((again.sigma(j) / found.sigma(j) - 1.0).abs() < 1e-6, "{j}");
        }
        let finer = Finer::cut(&response_values_cm1(), 3).unwrap();
        let refused = found.at_values(&finer).of_curves(&twin.prior).unwrap_err().to_string();
        assert!(refused.contains("30") && refused.contains("90"), "{refused}");
    }

    type Correlation = fn(f64, f64) -> f64;

    /// Shares of 95 % intervals of the values, and of radiances behind the filters, that hold the truth: curves of this correlation drawn
    /// at `true_parts` of each value, readings by the sum over these, fits on `parts`. Then the same two by the errors for
    /// curves with kinks.
    fn held(parts: usize, true_parts: usize, sigma: f64, (draws, drawn): (u64, Correlation)) -> [f64; 4] {
        let (twin, truth) = (FilterWheelTwin::cut(parts).unwrap(), FilterWheelTwin::cut(true_parts).unwrap());
        let [finer, finest] =
            [parts, true_parts].map(|parts| Finer::cut(&response_values_cm1(), parts).unwrap());
        let fine = truth.wheel.centres_cm1().to_vec();
        let typical = truth.prior.mean();
        // By Cholesky, not by the modes that the fit has.
        let covariance = DMatrix::from_fn(fine.len(), fine.len(), |i, j| {
            let alike = drawn(fine[i] - fine[j], KNOWN.correlation_cm1);
            let own = if i == j { 1e-12 } else { 0.0 };
            KNOWN.scale.powi(2) * typical[i] * typical[j] + KNOWN.shape.powi(2) * alike + own
        });
        let drawn = Cholesky::new(covariance).unwrap().l();
        let some = |twin: &FilterWheelTwin| {
            let mut twin = twin.clone();
            twin.temperatures_k = (0..8).map(|k| 308.15 + 10.0 * f64::from(k)).collect();
            twin.readings(sigma)
        };
        let (readings, exact) = (some(&twin), vec![0.0; 8]);
        let [scene, reference] = [330.0, 308.15].map(|t| {
            let mut radiance = vec![0.0; fine.len()];
            planck::photon_radiance_into(&fine, t, &mut radiance);
            radiance
        });
        let ones = vec![1.0; fine.len()];
        let kinked = CurvePrior::kinked(twin.wheel.centres_cm1(), twin.prior.mean(), KNOWN).unwrap();
        let mut shares = [0.0; 4];
        for draw in 0..draws {
            let mut rng = generator(42, draw);
            let z = DVector::from_fn(fine.len(), |_, _| normal(&mut rng));
            let off = &drawn * z;
            let curve: Vec<f64> = typical.iter().zip(off.iter()).map(|(mean, off)| mean + off).collect();
            let mut counts = truth.means(&readings, &curve, &exact);
            counts.iter_mut().for_each(|count| *count += sigma * normal(&mut rng));
            let found = Response::found(&twin.wheel, &twin.prior, &readings, &counts, &[]).unwrap();
            for (shares, found) in shares.chunks_mut(2).zip([&found, &found.of_curves(&kinked).unwrap()]) {
                let at_values = found.at_values(&finer);
                for (j, own) in finest.at_values(&curve).iter().enumerate() {
                    let off = (at_values.values[j] - own).abs();
                    shares[0] += f64::from(u8::from(off < 1.96 * at_values.sigma(j))) / (30.0 * draws as f64);
                }
                for q in 0..10 {
                    let of = |x: &[f64]| truth.wheel.counts(q, &curve, x);
                    let measured = found.radiance(&twin.wheel, q, of(&scene) - of(&reference), 308.15);
                    let off = (measured.radiance - of(&scene) / of(&ones)).abs();
                    shares[1] +=
                        f64::from(u8::from(off < 1.96 * measured.sigma_common)) / (10.0 * draws as f64);
                }
            }
        }
        shares
    }

    /// Readings are integrals. 240 curves; the 30 values of one share their errors, so that the share scatters by less than 0.006.
    /// The radiances, which are read without noise, have fewer errors that are independent: 0.01.
    #[test]
    fn intervals_hold_what_is_drawn_on_a_finer_grid() {
        let own = Finer::of(&response_values_cm1(), KNOWN.correlation_cm1).unwrap().parts();
        for sigma in [2.0, 0.2, 0.02, 0.0002] {
            let [values, radiances, kinked, _] = held(own, 5 * own, sigma, (240, matern));
            assert!((0.93..0.97).contains(&values), "{sigma} {values}");
            assert!((0.91..0.99).contains(&radiances), "{sigma} {radiances}");
            assert!(kinked >= values, "{sigma} {kinked}");
        }
        // What the sum over the values alone held: .69 of them.
        let [coarse, ..] = held(1, 5 * own, 0.0002, (40, matern));
        assert!(coarse < 0.8, "{coarse}");
    }

    /// A response with kinks is outside the errors of smooth ones; those for curves with kinks hold it.
    #[test]
    fn what_smoothness_is_worth_is_said() {
        let own = Finer::of(&response_values_cm1(), KNOWN.correlation_cm1).unwrap().parts();
        for sigma in [2.0, 0.02] {
            let [smooth, smooth_radiances, values, radiances] = held(own, 5 * own, sigma, (240, exponential));
            assert!(smooth < 0.9, "{sigma} {smooth}");
            assert!((0.93..0.97).contains(&values), "{sigma} {values}");
            assert!((0.91..0.99).contains(&radiances), "{sigma} {radiances} {smooth_radiances}");
        }
    }
}
