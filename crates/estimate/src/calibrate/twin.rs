//! Instruments whose truth is known, and which draw readings.
//!
//! A filter-wheel camera after the paper's prototype 1 (SIV): 31 blackbodies from 35 to 110 °C, step 2.5 K, ten filters, 30 values of the
//! response from 595 to 1340 cm⁻¹. The paper's filters and its maker's response are pictures without numbers; what stands here is
//! chosen: passbands T = 0.8 exp[−ln 2 (2(ν − ν₀)/w)⁴] of the widths that such filters have ([`FILTERS`]), and a microbolometer's
//! response, high from 8 to 13 µm,
//!
//! r(ν) ∝ [1 − ¼((ν − 980)/300)²] / {(1 + e^{−(ν−730)/20}) (1 + e^{(ν−1300)/15})} × [1 + 0.06 sin(2π(ν − 595)/190)],
//!
//! brought to a peak of 1; the typical curve that its maker gives is the same with edges 12 cm⁻¹ further out and no ripple. One count is
//! the deviation of one sample: 50 mK at 303.15 K without a filter.
//!
//! A Fourier spectrometer after SVI: 71 channels from 700 to 1400 cm⁻¹, R smooth, ξ = −R K of its own light at 296 K.

use hadar::calibration::blackbody::Blackbodies;
use hadar::calibration::determined::{CurvePrior, CurveSmoothness};
use hadar::calibration::filter_wheel::{FilterWheel, Reading};
use hadar::calibration::finer::Finer;
use hadar::calibration::sent::{Of, Sent};
use hadar::error::Result;
use hadar::planck;
use rand::rngs::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

/// Noise-equivalent temperature difference of a sample at [`NETD_AT_K`], K.
pub const NETD_K: f64 = 0.05;
/// Temperature at which it is stated, K.
pub const NETD_AT_K: f64 = 303.15;
/// Centre and width at half height of the ten filters, cm⁻¹.
pub const FILTERS: [[f64; 2]; 10] = [
    [740.0, 90.0],
    [800.0, 80.0],
    [850.0, 90.0],
    [905.0, 80.0],
    [960.0, 100.0],
    [1020.0, 90.0],
    [1085.0, 100.0],
    [1150.0, 110.0],
    [1230.0, 120.0],
    [990.0, 420.0],
];
/// What is known of the response beforehand: its scale to a tenth, its shape to 0.15 of the peak.
pub const KNOWN: CurveSmoothness = CurveSmoothness { scale: 0.1, shape: 0.15, correlation_cm1: 100.0 };

/// A draw of the standard normal distribution.
#[must_use]
pub fn normal(rng: &mut ChaCha8Rng) -> f64 {
    StandardNormal.sample(rng)
}

/// Transmittance of a passband at some wavenumbers.
#[must_use]
pub fn passband([centre, width]: [f64; 2], wavenumbers_cm1: &[f64]) -> Vec<f64> {
    let at = |nu: &f64| {
        let x = 2.0 * (nu - centre) / width;
        0.8 * libm::exp(-std::f64::consts::LN_2 * x * x * x * x)
    };
    wavenumbers_cm1.iter().map(at).collect()
}

/// Wavenumbers of the 30 response values, cm⁻¹.
#[must_use]
pub fn response_values_cm1() -> Vec<f64> {
    (0..30).map(|j| 595.0 + 745.0 / 29.0 * f64::from(j)).collect()
}

/// 35 to 110 °C, step 2.5 K.
#[must_use]
pub fn papers_temperatures_k() -> Vec<f64> {
    (0..31).map(|k| 308.15 + 2.5 * f64::from(k)).collect()
}

fn microbolometer(edges: f64, ripple: f64, nu: f64) -> f64 {
    let dome = 1.0 - 0.25 * ((nu - 980.0) / 300.0).powi(2);
    let low = 1.0 + libm::exp(-(nu - 730.0 + edges) / 20.0);
    let high = 1.0 + libm::exp((nu - 1300.0 - edges) / 15.0);
    dome / (low * high) * (1.0 + ripple * libm::sin(std::f64::consts::TAU * (nu - 595.0) / 190.0))
}

/// A filter-wheel camera.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct FilterWheelTwin {
    /// Filters and scale of the counts.
    pub wheel: FilterWheel,
    /// What is known of the response: about the typical curve.
    pub prior: CurvePrior,
    /// The true response at the 30 values, or at their parts.
    pub response: Vec<f64>,
    /// K_q, counts.
    pub offsets: Vec<f64>,
    /// Size of the pattern of D, counts.
    pub diaphragm: f64,
    /// Size of the pattern of ξ, counts.
    pub dark: f64,
    /// Temperatures of the blackbodies, K; the first is the reference.
    pub temperatures_k: Vec<f64>,
}

impl FilterWheelTwin {
    /// After prototype 1.
    ///
    /// # Errors
    /// None, unless a figure above is wrong.
    pub fn prototype() -> Result<Self> {
        Self::cut(1)
    }

    /// The same camera with each value of the response cut into an odd number of parts: what it reads is a finer sum.
    ///
    /// # Errors
    /// An even number of parts.
    pub fn cut(parts: usize) -> Result<Self> {
        let values = response_values_cm1();
        let typical = |nu: &f64| microbolometer(12.0, 0.0, *nu);
        let peak = values.iter().map(typical).fold(0.0, f64::max);
        let scaled = |centres: &[f64]| -> Vec<f64> { centres.iter().map(|nu| typical(nu) / peak).collect() };
        let counts = counts_per_radiance(&values, &scaled(&values));
        let centres = if parts == 1 { values } else { Finer::cut(&values, parts)?.centres_cm1().to_vec() };
        let truth: Vec<f64> = centres.iter().map(|nu| microbolometer(0.0, 0.06, *nu)).collect();
        let typical = scaled(&centres);
        let filters = FILTERS.iter().map(|filter| passband(*filter, &centres)).collect();
        Ok(Self {
            prior: CurvePrior::smooth(&centres, &typical, KNOWN)?,
            wheel: FilterWheel::new(centres, filters, counts)?,
            response: truth.iter().map(|r| r / peak).collect(),
            offsets: (0..10).map(|q| 900.0 + 35.0 * f64::from(q * q % 7)).collect(),
            diaphragm: 400.0,
            dark: 150.0,
            temperatures_k: papers_temperatures_k(),
        })
    }

    /// The same camera behind other filters.
    ///
    /// # Errors
    /// A passband that is none.
    pub fn wheel_of(&self, filters: &[[f64; 2]]) -> Result<FilterWheel> {
        let centres = self.wheel.centres_cm1().to_vec();
        let curves = filters.iter().map(|filter| passband(*filter, &centres)).collect();
        let counts = counts_per_radiance(&centres, self.prior.mean());
        FilterWheel::new(centres, curves, counts)
    }

    /// All blackbodies through all filters, each reading with this deviation (counts).
    #[must_use]
    pub fn readings(&self, sigma: f64) -> Vec<Reading> {
        let of = |(k, t): (usize, &f64)| {
            let (blackbody, sent) = (k, Sent::black(*t));
            (0..self.wheel.filters()).map(move |filter| Reading { blackbody, sent, filter, sigma })
        };
        self.temperatures_k.iter().enumerate().flat_map(of).collect()
    }

    /// Mean counts of readings at the centre of the image, blackbodies warmer than stated by `shifts_k`.
    #[must_use]
    pub fn means(&self, readings: &[Reading], response: &[f64], shifts_k: &[f64]) -> Vec<f64> {
        let centres = self.wheel.centres_cm1();
        let mut radiance = vec![0.0; centres.len()];
        let mut mean = |reading: &Reading| {
            let sent = reading.sent.shifted(Of::Temperature, shifts_k[reading.blackbody]);
            sent.radiance_into(centres, &mut radiance);
            self.wheel.counts(reading.filter, response, &radiance) + self.offsets[reading.filter]
        };
        readings.iter().map(&mut mean).collect()
    }

    /// η of a pixel of an image: asymmetric, as the wheel is not aligned; 1 at the centre.
    #[must_use]
    pub fn eta(&self, [rows, columns]: [usize; 2], pixel: usize) -> f64 {
        let off = |at: usize, count: usize| (at as f64 - (count / 2) as f64) / count as f64;
        let (y, x) = (off(pixel / columns, rows), off(pixel % columns, columns));
        1.0 - 0.35 * (x * x + 1.3 * y * y) + 0.06 * x - 0.04 * y
    }

    /// A cube `[pixel][filter]` of a uniform blackbody, each sample with noise of the deviation `sigma`.
    #[must_use]
    pub fn blackbody_cube(
        &self,
        temperature_k: f64,
        size: [usize; 2],
        sigma: f64,
        rng: &mut ChaCha8Rng,
    ) -> Vec<f64> {
        let mut radiance = vec![0.0; self.wheel.centres_cm1().len()];
        planck::photon_radiance_into(self.wheel.centres_cm1(), temperature_k, &mut radiance);
        let counts: Vec<f64> =
            (0..self.wheel.filters()).map(|q| self.wheel.counts(q, &self.response, &radiance)).collect();
        let mut out = Vec::with_capacity(size[0] * size[1] * counts.len());
        for pixel in 0..size[0] * size[1] {
            let (eta, phase) = (self.eta(size, pixel), pixel as f64);
            let dark =
                self.dark * libm::sin(0.7 * phase) + self.diaphragm * (1.0 - eta) * libm::cos(0.2 * phase);
            for (counts, offset) in counts.iter().zip(&self.offsets) {
                let noise = if sigma > 0.0 { sigma * normal(rng) } else { 0.0 };
                out.push(eta * counts + offset * (1.0 + 0.1 * libm::cos(0.3 * phase)) + dark + noise);
            }
        }
        out
    }
}

/// g by which one count is [`NETD_K`] at [`NETD_AT_K`] without a filter.
fn counts_per_radiance(centres_cm1: &[f64], typical: &[f64]) -> f64 {
    let step = centres_cm1[1] - centres_cm1[0];
    let slope = |(nu, r): (&f64, &f64)| r * planck::photon_radiance_slope(*nu, NETD_AT_K);
    1.0 / (NETD_K * step * centres_cm1.iter().zip(typical).map(slope).sum::<f64>())
}

/// A spectrometer.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct SpectrometerTwin {
    /// Channels, cm⁻¹.
    pub wavenumbers_cm1: Vec<f64>,
    /// R, counts per photon s⁻¹ m⁻² sr⁻¹ per cm⁻¹.
    pub response: Vec<f64>,
    /// ξ, counts.
    pub offset: Vec<f64>,
    /// Deviation of a reading, counts: 1.
    pub sigma: f64,
}

impl SpectrometerTwin {
    /// Of 30 mK at 300 K and 1000 cm⁻¹ in one reading.
    #[must_use]
    pub fn new() -> Self {
        let wavenumbers_cm1: Vec<f64> = (0..71).map(|i| 700.0 + 10.0 * f64::from(i)).collect();
        let peak = 1.0 / (0.03 * planck::photon_radiance_slope(1000.0, 300.0));
        let curve = |nu: &f64| peak * libm::exp(-((nu - 1000.0) / 420.0).powi(2));
        let response: Vec<f64> = wavenumbers_cm1.iter().map(curve).collect();
        let own = |(nu, r): (&f64, &f64)| -r * planck::photon_radiance(*nu, 296.0);
        let offset = wavenumbers_cm1.iter().zip(&response).map(own).collect();
        Self { wavenumbers_cm1, response, offset, sigma: 1.0 }
    }

    /// Readings at these temperatures, uncertain by `errors_k`.
    ///
    /// # Errors
    /// No two temperatures that differ.
    pub fn readings(&self, temperatures_k: &[f64], errors_k: &[f64]) -> Result<Blackbodies> {
        let sigma = vec![vec![self.sigma; self.wavenumbers_cm1.len()]; temperatures_k.len()];
        Blackbodies::new(&self.wavenumbers_cm1, temperatures_k.to_vec(), errors_k.to_vec(), &sigma)
    }

    /// A reading of a surface of temperature, emissivity and surroundings, drawn.
    #[must_use]
    pub fn drawn(&self, sent: impl Fn(usize) -> f64, rng: &mut ChaCha8Rng) -> Vec<f64> {
        (0..self.wavenumbers_cm1.len())
            .map(|c| self.response[c] * sent(c) + self.offset[c] + self.sigma * normal(rng))
            .collect()
    }
}

impl Default for SpectrometerTwin {
    fn default() -> Self {
        Self::new()
    }
}
