//! Readings frame after frame: exact counts, white noise, and flicker noise that remembers.
//!
//! n_j = counts_j + e_j + x_j(t), band j, in every frame:
//!
//! * e: normal, independent in every frame, variance σ_J² + σ_R² (Johnson noise, whose variance grows with the exposure
//!   of the frame, and the noise of reading it);
//! * x: flicker, normal and stationary of variance σ_F², independent in every band: K Ornstein–Uhlenbeck processes of
//!   equal variance σ_F²/K, whose relaxation times τ_k divide the logarithm of (τ_min, τ_max) evenly. Covariance
//!   c(Δ) = (σ_F²/K) Σ e^{−|Δ|/τ_k}, one-sided spectrum (σ_F²/K) Σ 4τ_k/[1 + (2πfτ_k)²], which is
//!   σ_F²/[f ln(τ_max/τ_min)] between 1/(2πτ_max) and 1/(2πτ_min).
//!
//! From frame to frame x_k → ρx_k + √(1 − ρ²) σ_k z, ρ = e^{−Δ/τ_k}: exact for any spacing Δ, the first frame already
//! stationary. Flicker within the exposure of one frame counts as constant. A single reading has variance
//! σ_J² + σ_R² + σ_F², as [`super::Draws::with_electronic_noise`] draws it; the average of M frames does not gain √M
//! over flicker:
//!
//! var = (σ_J² + σ_R²)/M + (1/M²) Σ_k σ_k² [M + 2 Σ_{l<M} (M − l) ρ_k^l].
//!
//! Sources: Van der Ziel, Physica 16, 359 (1950), doi:10.1016/0031-8914(50)90078-4 (1/f from relaxations); Gillespie,
//! Phys. Rev. E 54, 2084 (1996), doi:10.1103/PhysRevE.54.2084 (exact steps).

use super::{Draws, generator};
use hadar::error::{Error, Result, check};
use rand::rngs::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

/// Shape of flicker noise of variance 1: its relaxation times.
#[derive(Debug, Clone, PartialEq)]
pub struct Flicker {
    relaxation_s: Vec<f64>,
}

impl Flicker {
    /// 1/f between 1/(2π `longest_s`) and 1/(2π `shortest_s`), of `per_decade` relaxation times in each decade (2 keep
    /// the spectrum within 4 % of 1/f, 1 within 25 %, well inside those ends).
    ///
    /// # Errors
    /// Times that are not positive, not finite or not in order; `per_decade` 0 or above 100.
    pub fn new(shortest_s: f64, longest_s: f64, per_decade: usize) -> Result<Self> {
        check::positive("shortest relaxation time", shortest_s, "s")?;
        check::positive("longest relaxation time", longest_s, "s")?;
        if longest_s < shortest_s {
            let expected = "the shortest relaxation time or more";
            return Err(Error::out_of_range("longest relaxation time", longest_s, "s", expected));
        }
        if !(1..=100).contains(&per_decade) {
            let found = per_decade as f64;
            return Err(Error::out_of_range("relaxation times in a decade", found, "", "between 1 and 100"));
        }
        let decades = longest_s.log10() - shortest_s.log10();
        let count = ((decades * per_decade as f64).ceil() as usize).max(1);
        // Middle of each part, so that the parts cover the whole range evenly.
        let time = |k: usize| shortest_s * 10_f64.powf(decades * (k as f64 + 0.5) / count as f64);
        Ok(Self { relaxation_s: (0..count).map(time).collect() })
    }

    /// The relaxation times, s.
    #[must_use]
    pub fn relaxation_s(&self) -> &[f64] {
        &self.relaxation_s
    }

    /// Covariance of two readings `lag_s` apart, for a variance of 1.
    #[must_use]
    pub fn covariance(&self, lag_s: f64) -> f64 {
        self.mean(|time| (-lag_s.abs() / time).exp())
    }

    /// Spectral density at `frequency_hz` (one-sided), for a variance of 1; 1/Hz.
    #[must_use]
    pub fn spectrum(&self, frequency_hz: f64) -> f64 {
        self.mean(|time| 4.0 * time / (1.0 + (std::f64::consts::TAU * frequency_hz * time).powi(2)))
    }

    /// Variance of the average of `frames` readings `spacing_s` apart, for a variance of 1.
    #[must_use]
    pub fn var_average(&self, frames: u32, spacing_s: f64) -> f64 {
        let m = f64::from(frames.max(1));
        self.mean(|time| {
            let x = spacing_s.abs() / time;
            if m * x < 1e-4 {
                // Means of the distance of two frames, and of its square.
                let square = (m * m - 1.0) / 6.0;
                return 1.0 - 2.0 * square / m * x + 0.5 * square * x * x;
            }
            // Geometric sums: Σ_{l<M} (M − l)ρ^l = ρ[M(1 − ρ) − (1 − ρ^M)]/(1 − ρ)².
            let (rho, step, whole) = ((-x).exp(), -(-x).exp_m1(), -(-m * x).exp_m1());
            (1.0 + 2.0 * rho * (step - whole / m) / (step * step)) / m
        })
    }

    fn mean(&self, term: impl Fn(f64) -> f64) -> f64 {
        self.relaxation_s.iter().map(|&time| term(time)).sum::<f64>() / self.relaxation_s.len() as f64
    }
}

/// Electronic noise of every band's readings, at one exposure of the frame.
///
/// ```
/// use hadar_simulate::draws::electronic::{ElectronicNoise, Flicker};
/// let flicker = Flicker::new(1e-3, 1e3, 2)?;
/// let noise = ElectronicNoise::new(&[4.0], &[5.0], &[1.0], flicker)?;
/// assert_eq!(noise.var_reading(), [10.0]);
/// // A hundred frames in 10 s: the white part falls to a hundredth, flicker to a third.
/// assert!((0.35..0.5).contains(&noise.var_average(0, 100, 0.1)));
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct ElectronicNoise {
    var_white: Vec<f64>,
    var_flicker: Vec<f64>,
    flicker: Flicker,
}

impl ElectronicNoise {
    /// Variances of every band in one frame, counts²: Johnson noise, reading, flicker.
    ///
    /// # Errors
    /// Lists of different length, variances that are negative or not finite.
    pub fn new(var_johnson: &[f64], var_read: &[f64], var_flicker: &[f64], flicker: Flicker) -> Result<Self> {
        for (what, list) in [("reading noise", var_read), ("flicker noise", var_flicker)] {
            if list.len() != var_johnson.len() {
                let what = format!("variances of {what}");
                return Err(Error::Length { what, found: list.len(), expected: var_johnson.len() });
            }
        }
        for &var in var_johnson.iter().chain(var_read).chain(var_flicker) {
            check::non_negative("variance of electronic noise", var, "counts^2")?;
        }
        let var_white: Vec<f64> = var_johnson.iter().zip(var_read).map(|(a, b)| a + b).collect();
        for (white, flicker) in var_white.iter().zip(var_flicker) {
            check::finite("variance of electronic noise", white + flicker, "counts^2")?;
        }
        Ok(Self { var_white, var_flicker: var_flicker.to_vec(), flicker })
    }

    /// Variance of a single reading of every band, counts².
    #[must_use]
    pub fn var_reading(&self) -> Vec<f64> {
        self.var_white.iter().zip(&self.var_flicker).map(|(white, flicker)| white + flicker).collect()
    }

    /// Covariance of a band's electronic noise in two different frames `lag_s` apart, counts²; 0 for no such band.
    #[must_use]
    pub fn covariance(&self, band: usize, lag_s: f64) -> f64 {
        self.var_flicker.get(band).map_or(0.0, |var| var * self.flicker.covariance(lag_s))
    }

    /// Variance of a band's electronic noise in the average of `frames` frames `spacing_s` apart, counts²; 0 for no
    /// such band.
    #[must_use]
    pub fn var_average(&self, band: usize, frames: u32, spacing_s: f64) -> f64 {
        match (self.var_white.get(band), self.var_flicker.get(band)) {
            (Some(white), Some(flicker)) => {
                white / f64::from(frames.max(1)) + flicker * self.flicker.var_average(frames, spacing_s)
            }
            _ => 0.0,
        }
    }
}

/// Spectra of one pixel, frame after frame.
///
/// ```
/// use hadar_simulate::draws::{Draws, electronic::{ElectronicNoise, Flicker, Frames}};
/// use hadar::statistics::Statistics;
/// let draws = Draws::new(&Statistics::Poisson, &[1000.0, 500.0])?;
/// let noise = ElectronicNoise::new(&[9.0; 2], &[16.0; 2], &[400.0; 2], Flicker::new(1e-2, 1e4, 2)?)?;
/// let mut frames = Frames::new(draws, noise, 1, 0)?;
/// let mut reading = [0.0; 2];
/// frames.next_into(0.0, &mut reading)?;
/// frames.next_into(1.0 / 30.0, &mut reading)?;
/// assert!((reading[0] - 1000.0).abs() < 250.0);
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug)]
pub struct Frames {
    draws: Draws,
    noise: ElectronicNoise,
    rng: ChaCha8Rng,
    /// Flicker of every band, relaxation time after relaxation time, in its standard deviations; empty before the
    /// first frame.
    state: Vec<f64>,
}

impl Frames {
    /// Frames with counts from `draws`, from stream `stream` of random numbers.
    ///
    /// # Errors
    /// Noise of another number of bands.
    pub fn new(draws: Draws, noise: ElectronicNoise, seed: u64, stream: u64) -> Result<Self> {
        if noise.var_white.len() != draws.bands() {
            let found = noise.var_white.len();
            return Err(Error::Length {
                what: "bands of the electronic noise".into(),
                found,
                expected: draws.bands(),
            });
        }
        Ok(Self { draws, noise, rng: generator(seed, stream), state: Vec::new() })
    }

    /// The next frame, `spacing_s` after the last one (any for the first).
    ///
    /// # Errors
    /// A spacing that is negative or not finite.
    pub fn next_into(&mut self, spacing_s: f64, reading: &mut [f64]) -> Result<()> {
        check::non_negative("time between two frames", spacing_s, "s")?;
        let times = &self.noise.flicker.relaxation_s;
        let rng = &mut self.rng;
        self.draws.draw_into(rng, reading);
        if self.state.is_empty() {
            let size = times.len() * self.noise.var_flicker.len();
            self.state = (0..size).map(|_| StandardNormal.sample(rng)).collect();
        } else {
            for (chunk, time) in self.state.chunks_mut(self.noise.var_flicker.len().max(1)).zip(times) {
                let rho = (-spacing_s / time).exp();
                let fresh = (-(-2.0 * spacing_s / time).exp_m1()).sqrt();
                for x in chunk {
                    let z: f64 = StandardNormal.sample(rng);
                    *x = rho * *x + fresh * z;
                }
            }
        }
        let bands = self.noise.var_white.iter().zip(&self.noise.var_flicker).enumerate();
        for (value, (band, (white, flicker))) in reading.iter_mut().zip(bands) {
            let z: f64 = StandardNormal.sample(rng);
            let sum: f64 = self.state.iter().skip(band).step_by(self.noise.var_flicker.len()).sum();
            *value += white.sqrt() * z + (flicker / times.len() as f64).sqrt() * sum;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
