//! Response and offset of a spectrometer from blackbodies, and the radiance that is measured with them.
//!
//! A reading of a linear instrument before a blackbody of temperature T_k is, in each channel (S54; a back reflection is part of ξ),
//!
//! C_k = R B(T_k + δ_k) + ξ + ε_k,   ε_k normal of deviation σ_k, δ_k of deviation u_k and common to all channels.
//!
//! Of a blackbody that is not quite black B_k stands for what it sends, L_k, and B′_k δ_k for all that its errors of temperature,
//! emissivity and surroundings move ([`super::sent`]).
//!
//! By least squares with weights w_k = 1/σ_k² (S55 and S56 for two temperatures), about the weighted mean B̄ of the radiances,
//!
//! R = Σ h_k C_k,  h_k = w_k (B_k − B̄)/Σ w (B − B̄)²;   C̄ = Σ w_k C_k/Σ w;   ξ = C̄ − R B̄,
//!
//! R and C̄ uncorrelated. A radiance S = (C − ξ)/R = B̄ + (C − C̄)/R then errs by
//!
//! dS = dC/R − Σ_k ℓ_k(S) (ε_k/R + B′_k δ_k),   ℓ_k(S) = w_k/Σw + (S − B̄) h_k,   Σ ℓ_k = 1:
//!
//! the first term anew in every pixel, the second common to all pixels of the channel, and that of δ common to all channels as well.
//!
//! With more than two blackbodies the channels together tell something of δ: of what the two columns of a channel leave, the scores
//! R B′_k/σ_k. Their triangular factor F, with the rows 1/u_k, gives the covariance of δ without an inverse ([`Bound`]).
//!
//! Units: counts for C, ξ, σ; photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹ for B and S; K for T, u.
//!
//! Assumptions: linear response; σ known; errors to first order, those of one blackbody independent of those of another.

use super::sent::{Deviations, Sent, Unknown};
use crate::error::{Error, Result, check};
use nalgebra::{DMatrix, DVector};

/// Blackbodies that were read in some channels.
#[derive(Debug, Clone, PartialEq)]
pub struct Blackbodies {
    sent: Vec<Sent>,
    unknowns: Vec<Unknown>,
    channels: Vec<Channel>,
}

/// The least squares of one channel, before any reading.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Channel {
    /// B̄, photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹.
    pub mean_radiance: f64,
    /// B_k − B̄.
    pub apart: Vec<f64>,
    /// What each unknown moves of the radiance of its blackbody: B′ of a temperature.
    pub slope: Vec<f64>,
    /// σ_k, counts.
    pub sigma: Vec<f64>,
    /// w_k/Σw.
    pub share: Vec<f64>,
    /// h_k, by which readings make the response.
    pub gain: Vec<f64>,
    /// Variance of the response by noise.
    pub var_response: f64,
    /// Variance of C̄ by noise, counts².
    pub var_centre: f64,
}

impl Channel {
    fn new(wavenumber_cm1: f64, sent: &[Sent], unknowns: &[Unknown], sigma: Vec<f64>) -> Result<Self> {
        let at = |of: &dyn Fn(&[f64], &mut [f64])| {
            let mut out = [0.0];
            of(&[wavenumber_cm1], &mut out);
            out[0]
        };
        let slope = |one: &Unknown| at(&|nu, out| sent[one.blackbody].slope_into(one.of, nu, out));
        // Radiances from the first on, which lose nothing where temperatures are near each other.
        let from_first: Vec<f64> =
            sent.iter().map(|one| at(&|nu, out| one.apart_into(&sent[0], nu, out))).collect();
        let least = sigma.iter().copied().fold(f64::INFINITY, f64::min);
        let weights: Vec<f64> = sigma.iter().map(|sigma| (least / sigma).powi(2)).collect();
        let total: f64 = weights.iter().sum();
        let share: Vec<f64> = weights.iter().map(|w| w / total).collect();
        let mean: f64 = share.iter().zip(&from_first).map(|(share, b)| share * b).sum();
        let apart: Vec<f64> = from_first.iter().map(|b| b - mean).collect();
        let spread: f64 = share.iter().zip(&apart).map(|(share, b)| share * b * b).sum();
        if spread <= 0.0 {
            let found = format!("all blackbodies send the same at {wavenumber_cm1} cm^-1");
            return Err(Error::malformed(found, "give blackbodies whose temperatures differ more"));
        }
        let gain = share.iter().zip(&apart).map(|(share, b)| share * b / spread).collect();
        let var_centre = least * least / total;
        Ok(Self {
            mean_radiance: at(&|nu, out| sent[0].radiance_into(nu, out)) + mean,
            apart,
            slope: unknowns.iter().map(slope).collect(),
            sigma,
            share,
            gain,
            var_response: var_centre / spread,
            var_centre,
        })
    }

    /// What each unknown moves, where a reading of its blackbody counts by its `weights`.
    pub fn moved(&self, weights: impl Iterator<Item = f64>) -> Vec<f64> {
        // Unknowns are those of all blackbodies, again and again.
        let weights: Vec<f64> = weights.collect();
        weights.iter().cycle().zip(&self.slope).map(|(weight, slope)| weight * slope).collect()
    }

    /// ℓ_k of a radiance.
    pub fn leverages(&self, radiance: f64) -> impl Iterator<Item = f64> + '_ {
        let off = radiance - self.mean_radiance;
        self.share.iter().zip(&self.gain).map(move |(share, gain)| share + off * gain)
    }

    /// Variance that noise of the blackbodies' readings leaves in a measured radiance, common to all pixels.
    #[must_use]
    pub fn var_radiance(&self, radiance: f64, response: f64) -> f64 {
        let off = radiance - self.mean_radiance;
        (self.var_centre + off * off * self.var_response) / (response * response)
    }

    /// What the two columns of the channel leave of a vector over the blackbodies, all in units of their noise.
    #[must_use]
    pub fn left(&self, whitened: &[f64]) -> Vec<f64> {
        let mut rest = whitened.to_vec();
        let ones: Vec<f64> = self.share.iter().map(|share| share.sqrt()).collect();
        let norm = self.share.iter().zip(&self.apart).map(|(share, b)| share * b * b).sum::<f64>().sqrt();
        let slope: Vec<f64> = ones.iter().zip(&self.apart).map(|(one, b)| one * b / norm).collect();
        for _ in 0..2 {
            for q in [&ones, &slope] {
                let along: f64 = q.iter().zip(&rest).map(|(q, x)| q * x).sum();
                rest.iter_mut().zip(q).for_each(|(x, q)| *x -= along * q);
            }
        }
        rest
    }
}

impl Blackbodies {
    /// Black ones at these temperatures, uncertain by `errors_k`; all else as [`Self::of`].
    ///
    /// # Errors
    /// As [`Self::of`].
    pub fn new(
        wavenumbers_cm1: &[f64],
        temperatures_k: Vec<f64>,
        errors_k: Vec<f64>,
        sigma: &[Vec<f64>],
    ) -> Result<Self> {
        let deviations: Vec<Deviations> = errors_k.into_iter().map(|u| [u, 0.0, 0.0]).collect();
        Self::of(wavenumbers_cm1, temperatures_k.into_iter().map(Sent::black).collect(), &deviations, sigma)
    }

    /// Blackbodies with the deviations of their figures, read with deviations `sigma[blackbody][channel]` (counts) in channels at these
    /// wavenumbers.
    ///
    /// # Errors
    /// No two temperatures that differ, numbers that are not positive, lists of another length.
    pub fn of(
        wavenumbers_cm1: &[f64],
        sent: Vec<Sent>,
        deviations: &[Deviations],
        sigma: &[Vec<f64>],
    ) -> Result<Self> {
        let count = sent.len();
        for (what, found, expected) in [
            ("uncertainties of blackbodies", deviations.len(), count),
            ("deviations of readings", sigma.len(), count),
        ] {
            if found != expected {
                return Err(Error::Length { what: what.into(), found, expected });
            }
        }
        wavenumbers_cm1
            .iter()
            .try_for_each(|nu| check::positive("wavenumber of a channel", *nu, "cm^-1").map(drop))?;
        let unknowns = Unknown::all(deviations)?;
        for (one, sigma) in sent.iter().zip(sigma) {
            one.check()?;
            if sigma.len() != wavenumbers_cm1.len() {
                let what = "deviations of a reading".into();
                return Err(Error::Length { what, found: sigma.len(), expected: wavenumbers_cm1.len() });
            }
            sigma.iter().try_for_each(|sigma| {
                check::positive("deviation of a reading", *sigma, "counts").map(drop)
            })?;
        }
        if count < 2 {
            let found = format!("{count} blackbody temperature{}", if count == 1 { "" } else { "s" });
            return Err(Error::malformed(
                found,
                "response and offset are two unknowns: give a second blackbody at another temperature",
            ));
        }
        if sent.iter().all(|one| one.temperature_k == sent[0].temperature_k) {
            let found = format!("blackbodies 1 and 2 are both at {} K", sent[0].temperature_k);
            return Err(Error::malformed(found, "give two temperatures that differ"));
        }
        let channels = wavenumbers_cm1
            .iter()
            .enumerate()
            .map(|(i, nu)| Channel::new(*nu, &sent, &unknowns, sigma.iter().map(|sigma| sigma[i]).collect()));
        Ok(Self { channels: channels.collect::<Result<_>>()?, unknowns, sent })
    }

    /// What they are.
    #[must_use]
    pub fn sent(&self) -> &[Sent] {
        &self.sent
    }

    /// Their errors δ: of the temperatures first.
    #[must_use]
    pub fn unknowns(&self) -> &[Unknown] {
        &self.unknowns
    }

    /// The channels.
    #[must_use]
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// Scores of δ/u in a channel of this response: what the channel's own unknowns leave of them, `[blackbody]` for each unknown δ.
    #[must_use]
    pub fn temperature_scores(&self, channel: usize, response: f64) -> Vec<Vec<f64>> {
        let channel = &self.channels[channel];
        let column = |(one, slope): (&Unknown, &f64)| {
            let mut column = vec![0.0; self.sent.len()];
            let k = one.blackbody;
            column[k] = response * slope * one.deviation / channel.sigma[k];
            channel.left(&column)
        };
        self.unknowns.iter().zip(&channel.slope).map(column).collect()
    }

    /// The bound at the responses of the channels.
    ///
    /// # Errors
    /// Another number of responses, or one that is 0.
    pub fn bound(&self, response: &[f64]) -> Result<Bound> {
        if response.len() != self.channels.len() {
            let what = "responses".into();
            return Err(Error::Length { what, found: response.len(), expected: self.channels.len() });
        }
        if let Some(none) = response.iter().find(|r| !(r.is_finite() && **r != 0.0)) {
            return Err(Error::out_of_range("response of a channel", *none, "", "a number other than 0"));
        }
        let (count, unknowns) = (self.sent.len(), self.unknowns.len());
        let mut rows = DMatrix::zeros(count * self.channels.len() + unknowns, unknowns);
        for (c, response) in response.iter().enumerate() {
            for (k, column) in self.temperature_scores(c, *response).iter().enumerate() {
                column.iter().enumerate().for_each(|(i, score)| rows[(c * count + i, k)] = *score);
            }
        }
        (0..unknowns).for_each(|k| rows[(count * self.channels.len() + k, k)] = 1.0);
        Ok(Bound { factor: rows.qr().r(), response: response.to_vec() })
    }
}

/// Least deviations of what blackbodies calibrate.
#[derive(Debug, Clone, PartialEq)]
pub struct Bound {
    /// F, information on δ/u is FᵀF.
    factor: DMatrix<f64>,
    response: Vec<f64>,
}

/// The two parts of a variance.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Parts {
    /// Of the noise of the blackbodies' readings.
    pub var_noise: f64,
    /// Of their temperatures (emissivities, surroundings), common to all channels.
    pub var_temperature: f64,
}

impl Parts {
    /// Root of their sum.
    #[must_use]
    pub fn sigma(self) -> f64 {
        (self.var_noise + self.var_temperature).sqrt()
    }
}

impl Bound {
    /// Variance of Σ g_k δ_k.
    fn var_of(&self, of: &Blackbodies, sensitivity: &[f64]) -> f64 {
        self.whitened(of, sensitivity).norm_squared()
    }

    /// Σ g_k δ_k as a vector whose products with others are covariances.
    #[must_use]
    pub fn whitened(&self, of: &Blackbodies, sensitivity: &[f64]) -> DVector<f64> {
        let scaled = sensitivity.iter().zip(&of.unknowns).map(|(g, one)| g * one.deviation);
        let mut row = DVector::from_iterator(of.unknowns.len(), scaled);
        self.factor.tr_solve_upper_triangular_mut(&mut row);
        row
    }

    /// Of the response in a channel.
    #[must_use]
    pub fn response(&self, of: &Blackbodies, channel: usize) -> Parts {
        let (one, response) = (&of.channels[channel], self.response[channel]);
        let sensitivity = one.moved(one.gain.iter().map(|h| h * response));
        Parts { var_noise: one.var_response, var_temperature: self.var_of(of, &sensitivity) }
    }

    /// Of the offset ξ in a channel, counts².
    #[must_use]
    pub fn offset(&self, of: &Blackbodies, channel: usize) -> Parts {
        // The reading of no radiance.
        let parts = self.radiance(of, channel, 0.0);
        let square = self.response[channel].powi(2);
        Parts { var_noise: parts.var_noise * square, var_temperature: parts.var_temperature * square }
    }

    /// Covariance of response and offset in a channel, counts per radiance × counts.
    #[must_use]
    pub fn covariance(&self, of: &Blackbodies, channel: usize) -> f64 {
        // var(ξ + R S) at S = B̄: the offset there is C̄, which is uncorrelated to R as far as noise goes.
        let one = &of.channels[channel];
        let s = one.mean_radiance;
        let square = self.response[channel].powi(2);
        let at = |parts: Parts| (parts.var_noise + parts.var_temperature) * square;
        let (offset, centre) = (self.offset(of, channel), self.radiance(of, channel, s));
        let response = self.response(of, channel).sigma().powi(2);
        (at(centre) - offset.sigma().powi(2) - s * s * response) / (2.0 * s)
    }

    /// Of a radiance measured in a channel, without the noise of its own reading.
    #[must_use]
    pub fn radiance(&self, of: &Blackbodies, channel: usize, radiance: f64) -> Parts {
        let one = &of.channels[channel];
        let sensitivity = one.moved(one.leverages(radiance));
        Parts {
            var_noise: one.var_radiance(radiance, self.response[channel]),
            var_temperature: self.var_of(of, &sensitivity),
        }
    }

    /// Deviation of the temperature of blackbody k, K, after all channels.
    #[must_use]
    pub fn sigma_temperature_k(&self, of: &Blackbodies, blackbody: usize) -> f64 {
        let one = (0..of.unknowns.len()).map(|k| f64::from(u8::from(k == blackbody)));
        self.var_of(of, &one.collect::<Vec<_>>()).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planck;
    use nalgebra::Cholesky;

    const NU: [f64; 3] = [800.0, 950.0, 1200.0];
    const R: [f64; 3] = [2e-18, 3e-18, 1.5e-18];

    fn blackbodies() -> Blackbodies {
        let temperatures = vec![283.15, 313.15, 353.15, 353.2];
        let sigma: Vec<Vec<f64>> = (0..4)
            .map(|k| (0..3).map(|i| 0.01 * (1.0 + 0.3 * k as f64 + 0.2 * i as f64)).collect())
            .collect();
        let sent = temperatures.into_iter().zip([0.98, 1.0, 0.97, 0.95]);
        let sent = sent.map(|(t, emissivity)| Sent { emissivity, surroundings_k: 295.0, ..Sent::black(t) });
        let deviations = [[0.05, 0.005, 0.3], [0.02, 0.002, 0.3], [0.08, 0.01, 0.3], [0.04, 0.003, 0.3]];
        Blackbodies::of(&NU, sent.collect(), &deviations, &sigma).unwrap()
    }

    /// All unknowns of all channels together, by the inverse of the whole information matrix, in scaled units.
    #[test]
    fn the_bound_is_that_of_all_channels_together() {
        let of = blackbodies();
        let bound = of.bound(&R).unwrap();
        let (scale, sent) = (1e18, of.sent().to_vec());
        // Unknowns: R and ξ of three channels, then δ of temperature, emissivity and surroundings of four blackbodies.
        let mut information = DMatrix::zeros(18, 18);
        for (c, nu) in NU.iter().enumerate() {
            for k in 0..4 {
                let mut score = DVector::zeros(18);
                let Sent { temperature_k: t, emissivity: e, surroundings_k } = sent[k];
                let b = |t: f64| planck::photon_radiance(*nu, t);
                score[2 * c] = (e * b(t) + (1.0 - e) * b(surroundings_k)) / scale;
                score[2 * c + 1] = 1.0;
                score[6 + k] = R[c] * e * planck::photon_radiance_slope(*nu, t);
                score[10 + k] = R[c] * (b(t) - b(surroundings_k));
                score[14 + k] = R[c] * (1.0 - e) * planck::photon_radiance_slope(*nu, surroundings_k);
                let sigma = of.channels()[c].sigma[k];
                information += &score * score.transpose() / (sigma * sigma);
            }
        }
        for (u, one) in of.unknowns().iter().enumerate() {
            information[(6 + u, 6 + u)] += 1.0 / one.deviation.powi(2);
        }
        let covariance = Cholesky::new(information).unwrap().inverse();
        for c in 0..3 {
            let response = covariance[(2 * c, 2 * c)].sqrt() / scale;
            assert!((bound.response(&of, c).sigma() / response - 1.0).abs() < 1e-6);
            let offset = covariance[(2 * c + 1, 2 * c + 1)].sqrt();
            assert!((bound.offset(&of, c).sigma() / offset - 1.0).abs() < 1e-6);
            let both = covariance[(2 * c, 2 * c + 1)] / scale;
            assert!((bound.covariance(&of, c) / both - 1.0).abs() < 1e-6);
        }
        for k in 0..4 {
            let own = covariance[(6 + k, 6 + k)].sqrt();
            assert!((bound.sigma_temperature_k(&of, k) / own - 1.0).abs() < 1e-6);
        }
    }

    /// Two temperatures: S55 and S56 by hand.
    #[test]
    fn two_blackbodies_are_the_papers_differences() {
        let of = Blackbodies::new(&[1000.0], vec![290.0, 340.0], vec![0.0, 0.1], &[vec![0.02], vec![0.05]])
            .unwrap();
        let b = [290.0, 340.0].map(|t| planck::photon_radiance(1000.0, t));
        let response = 1e-18;
        let bound = of.bound(&[response]).unwrap();
        let parts = bound.response(&of, 0);
        let noise = (0.02_f64.powi(2) + 0.05_f64.powi(2)).sqrt() / (b[1] - b[0]);
        assert!((parts.var_noise.sqrt() / noise - 1.0).abs() < 1e-12);
        let slope = planck::photon_radiance_slope(1000.0, 340.0);
        let shift = response * slope * 0.1 / (b[1] - b[0]);
        assert!((parts.var_temperature.sqrt() / shift - 1.0).abs() < 1e-12);
        // A radiance as that of the colder blackbody errs as its reading does.
        let at_cold = bound.radiance(&of, 0, b[0]);
        assert!((at_cold.var_noise.sqrt() * response / 0.02 - 1.0).abs() < 1e-9);
        assert!(at_cold.var_temperature.sqrt() < 1e-9 * slope);
        let refused = |t: Vec<f64>| {
            let sigma = vec![vec![0.1]; t.len()];
            Blackbodies::new(&[1000.0], t.clone(), vec![0.0; t.len()], &sigma).unwrap_err().to_string()
        };
        assert!(refused(vec![300.0]).contains("second blackbody"));
        assert!(refused(vec![300.0, 300.0]).contains("blackbodies 1 and 2 are both at 300 K"));
    }
}
