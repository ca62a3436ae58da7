//! Response and offset of a spectrometer from readings of blackbodies, and what is measured with them.
//!
//! Least squares of each channel with weights 1/σ² (paper S55, S56 for two temperatures); where there are more than two blackbodies, what
//! the fits leave tells of the errors δ of their temperatures, emissivities and surroundings, common to all channels: least squares on the residuals with 1/u_k, and
//! the fits made anew, until nothing moves. Errors: [`Bound`] at the estimate.
//!
//! A radiance is S = B̄ + (C − C̄)/R; emissivity and surroundings of a surface at several temperatures are slope and meeting point of two
//! lines (S57, S58; [`hadar::calibration::surface`]). Units and assumptions: [`hadar::calibration::blackbody`].

use hadar::calibration::blackbody::{Blackbodies, Bound, Channel};
use hadar::calibration::surface::{self, Truth};
use hadar::error::{Error, Result, check};
use nalgebra::{DMatrix, DVector};

const ROUNDS: usize = 3;

/// Response and offset of every channel.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Calibration {
    /// The blackbodies it was made with.
    pub blackbodies: Blackbodies,
    /// R, counts per photon s⁻¹ m⁻² sr⁻¹ per cm⁻¹.
    pub response: Vec<f64>,
    /// C̄, counts: the reading of the radiance B̄.
    pub centre: Vec<f64>,
    /// δ of each unknown of the blackbodies as found, those of temperatures first.
    pub shifts: Vec<f64>,
    /// Σ of squared residuals in units of their deviations, the prior of δ included; as many degrees of freedom as readings less two for
    /// each channel.
    pub chi_square: f64,
    /// Errors.
    pub bound: Bound,
}

/// Emissivity of a surface and radiance of its surroundings in a channel, with their errors.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct SurfaceFound {
    /// e.
    pub emissivity: f64,
    /// X, photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹.
    pub surroundings: f64,
    /// Their errors.
    pub errors: surface::Surface,
}

/// Slope and value at the mean of readings of a channel.
fn line(channel: &Channel, counts: impl Iterator<Item = f64> + Clone) -> [f64; 2] {
    let slope = channel.gain.iter().zip(counts.clone()).map(|(h, c)| h * c).sum();
    [slope, channel.share.iter().zip(counts).map(|(share, c)| share * c).sum()]
}

impl Calibration {
    /// From counts `[blackbody][channel]`.
    ///
    /// # Errors
    /// Counts of another number or that are no numbers, a channel that responds to nothing.
    pub fn found(blackbodies: Blackbodies, counts: &[Vec<f64>]) -> Result<Self> {
        let (of, channels) = (&blackbodies, blackbodies.channels().len());
        let (count, unknowns) = (of.sent().len(), of.unknowns());
        if counts.len() != count || counts.iter().any(|counts| counts.len() != channels) {
            let what = "counts of blackbodies".into();
            let found = counts.iter().map(Vec::len).sum();
            return Err(Error::Length { what, found, expected: count * channels });
        }
        counts
            .iter()
            .flatten()
            .try_for_each(|count| check::finite("count of a blackbody", *count, "").map(drop))?;
        let fit = |response: &[f64], shifts: &[f64]| -> (Vec<f64>, Vec<f64>) {
            of.channels()
                .iter()
                .enumerate()
                .map(|(c, channel)| {
                    let mut corrected: Vec<f64> = counts.iter().map(|counts| counts[c]).collect();
                    for (one, (slope, shift)) in unknowns.iter().zip(channel.slope.iter().zip(shifts)) {
                        corrected[one.blackbody] -= response[c] * slope * shift;
                    }
                    let [slope, centre] = line(channel, corrected.into_iter());
                    (slope, centre)
                })
                .unzip()
        };
        let mut shifts = vec![0.0; unknowns.len()];
        let (mut response, mut centre) = fit(&vec![0.0; channels], &shifts);
        let tells = count > 2 && unknowns.iter().any(|one| one.deviation > 0.0);
        for _ in 0..if tells { ROUNDS } else { 0 } {
            let mut rows = DMatrix::zeros(count * channels + unknowns.len(), unknowns.len());
            let mut right = DVector::zeros(count * channels + unknowns.len());
            for (c, channel) in of.channels().iter().enumerate() {
                for (k, column) in of.temperature_scores(c, response[c]).iter().enumerate() {
                    column.iter().enumerate().for_each(|(i, score)| rows[(c * count + i, k)] = *score);
                }
                // About the mean, so that the offset, which is large, is not what is left by rounding.
                let whitened: Vec<f64> =
                    (0..count).map(|k| (counts[k][c] - centre[c]) / channel.sigma[k]).collect();
                channel.left(&whitened).iter().enumerate().for_each(|(i, x)| right[c * count + i] = *x);
            }
            (0..unknowns.len()).for_each(|k| rows[(count * channels + k, k)] = 1.0);
            let qr = rows.qr();
            qr.q_tr_mul(&mut right);
            let mut solved = right.rows(0, unknowns.len()).clone_owned();
            qr.r().solve_upper_triangular_mut(&mut solved);
            shifts = solved.iter().zip(unknowns).map(|(x, one)| x * one.deviation).collect();
            (response, centre) = fit(&response, &shifts);
        }
        let mut chi_square: f64 = shifts
            .iter()
            .zip(unknowns)
            .map(|(shift, one)| if one.deviation > 0.0 { (shift / one.deviation).powi(2) } else { 0.0 })
            .sum();
        for (c, channel) in of.channels().iter().enumerate() {
            let mut sent = channel.apart.clone();
            for (one, (slope, shift)) in unknowns.iter().zip(channel.slope.iter().zip(&shifts)) {
                sent[one.blackbody] += slope * shift;
            }
            for (k, sent) in sent.iter().enumerate() {
                let mean = centre[c] + response[c] * sent;
                chi_square += ((counts[k][c] - mean) / channel.sigma[k]).powi(2);
            }
        }
        let bound = of.bound(&response)?;
        Ok(Self { response, centre, shifts, chi_square, bound, blackbodies })
    }

    /// ξ of a channel, counts.
    #[must_use]
    pub fn offset(&self, channel: usize) -> f64 {
        self.centre[channel] - self.response[channel] * self.blackbodies.channels()[channel].mean_radiance
    }

    /// Radiance of a reading.
    #[must_use]
    pub fn radiance(&self, channel: usize, counts: f64) -> f64 {
        let mean = self.blackbodies.channels()[channel].mean_radiance;
        mean + (counts - self.centre[channel]) / self.response[channel]
    }

    /// Emissivity and surroundings of a surface from counts `[temperature][channel]` at the temperatures of `readings`.
    ///
    /// # Errors
    /// Counts or channels of another number.
    pub fn surface(&self, readings: &Blackbodies, counts: &[Vec<f64>]) -> Result<Vec<SurfaceFound>> {
        let channels = self.response.len();
        let expected = readings.sent().len() * channels;
        let found = counts.iter().map(Vec::len).sum();
        if readings.channels().len() != channels || counts.len() != readings.sent().len() || found != expected
        {
            return Err(Error::Length { what: "counts of a surface".into(), found, expected });
        }
        let of = |c: usize| {
            let (own, black) = (&readings.channels()[c], &self.blackbodies.channels()[c]);
            let [a, centre] = line(own, counts.iter().map(|counts| counts[c]));
            let response = self.response[c];
            let emissivity = a / response;
            // Where the lines meet, from the mean of the blackbodies on.
            let between = own.mean_radiance - black.mean_radiance;
            let off = (centre - self.centre[c] - a * between) / (response - a);
            let surroundings = black.mean_radiance + off;
            let truth = Truth { response, emissivity, surroundings };
            let errors = surface::errors((&self.blackbodies, &self.bound), readings, c, truth);
            SurfaceFound { emissivity, surroundings, errors }
        };
        Ok((0..channels).map(of).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hadar::planck;

    /// Without noise everything comes back, errors of temperatures as far as they are told: the prior holds them back a little.
    #[test]
    fn what_went_in_comes_out() {
        let nu: Vec<f64> = (0..40).map(|i| 700.0 + 15.0 * f64::from(i)).collect();
        let t = [280.0, 310.0, 340.0, 360.0];
        let shifts = [0.0, 0.05, 0.0, -0.03];
        let response = |nu: f64| 1e-16 * (1.0 + 0.3 * (nu / 90.0).sin());
        let offset = |nu: f64| -40.0 - 0.01 * nu;
        let counts = |t: f64| -> Vec<f64> {
            nu.iter().map(|nu| response(*nu) * planck::photon_radiance(*nu, t) + offset(*nu)).collect()
        };
        let exact = Blackbodies::new(&nu, t.to_vec(), vec![0.0; 4], &vec![vec![0.01; 40]; 4]).unwrap();
        let found = Calibration::found(exact, &t.map(counts)).unwrap();
        for (c, nu) in nu.iter().enumerate() {
            assert!((found.response[c] / response(*nu) - 1.0).abs() < 1e-10);
            assert!((found.offset(c) / offset(*nu) - 1.0).abs() < 1e-9);
        }
        assert!(found.chi_square < 1e-9);
        let (e, x) = (0.8, planck::photon_radiance(nu[7], 250.0));
        let own_k = [300.0, 330.0];
        let own = Blackbodies::new(&nu, own_k.to_vec(), vec![0.0; 2], &vec![vec![0.01; 40]; 2]).unwrap();
        let seen = own_k.map(|t| -> Vec<f64> {
            let sent = |nu: &f64| response(*nu) * (e * planck::photon_radiance(*nu, t) + (1.0 - e) * x);
            nu.iter().map(|nu| sent(nu) + offset(*nu)).collect()
        });
        let surface = found.surface(&own, &seen).unwrap()[7];
        assert!((surface.emissivity - e).abs() < 1e-9 && (surface.surroundings / x - 1.0).abs() < 1e-8);
        // Wrong temperatures of two blackbodies: what is known of their differences is found, to first order in the errors.
        let wrong = Blackbodies::new(&nu, t.to_vec(), vec![0.1; 4], &vec![vec![1e-3; 40]; 4]).unwrap();
        let warmer: Vec<Vec<f64>> = t.iter().zip(shifts).map(|(t, more)| counts(t + more)).collect();
        let found = Calibration::found(wrong, &warmer).unwrap();
        let off: f64 = found.response.iter().zip(&nu).map(|(r, nu)| (r / response(*nu) - 1.0).powi(2)).sum();
        let sigma = (0..40).map(|c| found.bound.response(&found.blackbodies, c).sigma() / found.response[c]);
        let allowed: f64 = sigma.map(|sigma| sigma * sigma).sum();
        assert!(off < allowed && found.chi_square < 4.0, "{off} {allowed} {}", found.chi_square);
    }
}
