//! The noise of a band as a budget of labelled lines, and the counting that solvers take.
//!
//! With N = κ φ S counts of the target (κ = étendue × efficiencies × integration time t, φ the share of the pixel it
//! fills), b other light, n averaged frames and t₀ the exposure for which the electronic noise σ² is stated, the variance
//! of a band is the sum of
//!
//! | line | variance | grows as |
//! |---|---|---|
//! | shot noise | N | t |
//! | light from the path, behind the target, filters and sensor | κ b | t |
//! | photon bunching, n̄ counted photons per mode | (N + κ b) n̄ | t |
//! | dark counts, rate r | r t | t |
//! | Johnson noise, flicker share f | (1 − f) σ² t/t₀ | t |
//! | flicker noise | f σ² (t/t₀)² | t² |
//! | read noise ρ per frame | n ρ² | frames |
//! | quantisation, full well over 2^bits = q | n q²/12 | frames |
//!
//! An interferometer reads all bands at every one of its W mirror positions, y = ½ Σ_w n_w (1 + cos 2πν_w x): counts of band w
//! are estimated from the whole interferogram, with the variance 4 Σ_w N_w of all photons in it (line 'multiplexed shot
//! noise': what goes beyond N of the band) and 8 W times every line of a reading. That is the multiplex advantage, W/8 of a
//! sequential instrument's electronic variance in the same time, and its price where photons are the noise.
//!
//! Of an object counts and variance are those of the sum over its n pixels: n times every line; what pixels, rows and columns have in
//! common has lines of its own ([`super::pattern`]).
//!
//! Bands that are read together are exposed and read once: the lines of photons add up, dark counts and those below come once.
//!
//! Assumptions: electronic noise of the bands is independent, also between mirror positions; a converter's steps are small
//! against the other noise, so that they act as noise.
//!
//! Source: paper S10–S15, Table S2; photon bunching in [`bunching`]; P. B. Fellgett, J. Phys. Radium 19, 187 (1958) for
//! the multiplex advantage (the factors 4 and 8 are the least-squares covariance of one-sided cosines).

use super::counting::Counting;
use super::{Camera, NoiseSpec, Readout, View, bunching};
use crate::spectrum::Bands;

/// One line of the noise budget of a band.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct NoiseLine {
    /// Name of the noise source of this line.
    pub label: &'static str,
    /// Variance, counts², mean over the bands.
    pub var_counts: f64,
    /// How it grows with the integration time t.
    pub scaling: &'static str,
    /// The figure of the camera from which it follows.
    pub source: &'static str,
}

/// A line with its variance in every band.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct BandLine {
    /// What it is.
    pub label: &'static str,
    /// Variance of each band, counts².
    pub var_counts: Vec<f64>,
    /// How it grows with the integration time t, or with the frames alone.
    pub scaling: &'static str,
    /// What it follows from.
    pub source: &'static str,
    /// Whether it comes with the photons of the band: it then adds up over bands that are read together, while the noise of
    /// a reading comes once.
    pub with_photons: bool,
}

/// The line of the target's own photons, which is the one that depends on what the target is.
pub const SHOT: &str = "shot noise";
/// That of photon bunching, the other one that photons make.
pub const BUNCHING: &str = "photon bunching";

impl Camera {
    /// Counts of a pixel per unit of band signal of the target: étendue × efficiencies × time × the share of the pixel it fills, m² sr s.
    #[must_use]
    pub fn counts_per_radiance(&self, bands: &Bands, view: &View) -> f64 {
        // An interferometer sees every band all the time.
        let positions = if self.readout == Readout::FourierTransform { bands.len() as f64 } else { 1.0 };
        self.collected(view) * positions
    }

    /// The same of a band that is seen once.
    pub(super) fn collected(&self, view: &View) -> f64 {
        self.collected_within(self.integration_s(), view)
    }

    /// The same within a time, s.
    fn collected_within(&self, time_s: f64, view: &View) -> f64 {
        self.etendue_m2_sr(view.distance_m)
            * self.optics_efficiency
            * self.quantum_efficiency
            * time_s
            * view.fill
    }

    /// Counts of all pixels of the view per unit of band signal, and the variance of each band that does not depend on what the target is.
    #[must_use]
    pub fn counting(&self, bands: &Bands, view: &View) -> Counting {
        let counts_per_radiance = view.extent.pixels() * self.counts_per_radiance(bands, view);
        let mut var_added = Vec::new();
        for line in self.added_noise(bands, view) {
            if var_added.is_empty() {
                var_added = line.var_counts;
            } else {
                var_added.iter_mut().zip(&line.var_counts).for_each(|(sum, var)| *sum += var);
            }
        }
        Counting { counts_per_radiance, var_added }
    }

    /// The part of [`Camera::counting`]'s variance that comes with photons, band by band, counts².
    #[must_use]
    pub fn var_with_photons(&self, bands: &Bands, view: &View) -> Vec<f64> {
        let mut var = vec![0.0; bands.len()];
        for line in self.added_noise(bands, view).iter().filter(|line| line.with_photons) {
            var.iter_mut().zip(&line.var_counts).for_each(|(sum, one)| *sum += one);
        }
        var
    }

    /// By how much the variance of a reading grows in a band of a spectrum: an interferogram spreads it.
    pub(super) fn spread(&self, bands: usize) -> f64 {
        if self.readout == Readout::FourierTransform { 8.0 * bands as f64 } else { 1.0 }
    }

    /// Every line but the target's own shot noise, band by band, of the sum over the pixels of the view; those of no variance are left out.
    #[must_use]
    pub fn added_noise(&self, bands: &Bands, view: &View) -> Vec<BandLine> {
        let kappa = self.counts_per_radiance(bands, view);
        let of_light = kappa / view.fill;
        let interferometer = self.readout == Readout::FourierTransform;
        // Of photons: those of the band, or of all of them, four times.
        let photons = |counts: Vec<f64>| match interferometer {
            true => vec![4.0 * crate::sum::sum(&counts); bands.len()],
            false => counts,
        };
        // Of every reading: as it is, or as the interferogram spreads it.
        let spread = self.spread(bands.len());
        let every = |var: f64| vec![var * spread; bands.len()];
        let pixels = view.extent.pixels();
        let mut lines: Vec<BandLine> = Vec::new();
        let mut push = |mut line: BandLine| {
            if line.var_counts.iter().any(|var| *var > 0.0) {
                line.var_counts.iter_mut().for_each(|var| *var *= pixels);
                lines.push(line);
            }
        };
        let line = |with_photons: bool| {
            move |label, var_counts, scaling, source| BandLine {
                label,
                var_counts,
                scaling,
                source,
                with_photons,
            }
        };
        let (of_photons, of_reading) = (line(true), line(false));
        if interferometer {
            let total = 4.0 * kappa * crate::sum::sum(&view.signal);
            let beyond = view.signal.iter().map(|signal| total - kappa * signal).collect();
            push(of_photons("multiplexed shot noise", beyond, "t", "photons of all bands in every reading"));
        }
        for light in &view.light {
            let counts = light.radiance.iter().map(|radiance| of_light * radiance).collect();
            push(of_photons(
                light.label,
                photons(counts),
                "t",
                "light that holds no information on the target",
            ));
        }
        if self.photon_bunching && view.occupancy.len() == view.signal.len() {
            let counts = |w: usize, signal: f64| kappa * signal + of_light * view.other_light(w);
            let added = view
                .signal
                .iter()
                .enumerate()
                .map(|(w, signal)| bunching::added_variance(counts(w, *signal), view.occupancy[w]));
            push(of_photons(BUNCHING, photons(added.collect()), "t", "counted photons per mode (S11, S12)"));
        }
        let frames = f64::from(self.frames);
        let dark = every(self.dark_rate_per_s * self.integration_s());
        push(of_reading("dark counts", dark, "t", "dark_rate"));
        if let Some(mut sigma) = self.reading_sigma(bands) {
            if let NoiseSpec::SpectralRadiance { .. } = self.noise {
                // Stated in front of the optics: what the path takes away does not make it less.
                let widths = bands.widths_cm1();
                let open = sigma.iter_mut().zip(view.open_widths_cm1.iter().zip(&widths));
                open.for_each(|(sigma, (open, behind))| *sigma *= open / behind);
            }
            let stretch = self.integration_s() / self.noise_exposure_s;
            let source = self.noise.key();
            let grown = |factor: f64| sigma.iter().map(|sigma| sigma * sigma * factor * spread).collect();
            let johnson = grown((1.0 - self.flicker_fraction) * stretch);
            push(of_reading("Johnson noise", johnson, "t", source));
            let flicker = grown(self.flicker_fraction * stretch * stretch);
            push(of_reading("flicker noise", flicker, "t^2", source));
        }
        let read = every(frames * self.read_noise_counts.powi(2));
        push(of_reading("read noise", read, "frames", "read_noise"));
        let step = self.quantisation_step_counts().unwrap_or(0.0);
        let rounding = every(frames * step * step / 12.0);
        push(of_reading("quantisation", rounding, "frames", "full_well, quantisation_bits"));
        for mut line in self.shared_noise(bands.len(), view) {
            if line.var_counts.iter().any(|var| *var > 0.0) {
                line.var_counts.iter_mut().for_each(|var| *var *= spread);
                lines.push(line);
            }
        }
        lines
    }

    /// Counts of one step of the converter, where full well and bits are known.
    #[must_use]
    pub fn quantisation_step_counts(&self) -> Option<f64> {
        self.quantisation_bits.and_then(|bits| self.full_well.map(|full| full / f64::from(bits).exp2()))
    }

    /// Counts that the fullest reading of one frame holds of the target (`signal` by band) and all other light.
    #[must_use]
    pub fn brightest_reading(&self, signal: &[f64], view: &View) -> f64 {
        let kappa = self.collected_within(self.exposure_s, view);
        let counts =
            signal.iter().enumerate().map(|(w, s)| kappa * s + kappa / view.fill * view.other_light(w));
        let light = match self.readout {
            // At zero path difference all light of all bands is in one reading.
            Readout::FourierTransform => counts.sum(),
            _ => counts.fold(0.0, f64::max),
        };
        light + self.dark_rate_per_s * self.exposure_s
    }

    /// The noise of an average band as labelled lines, which sum to its total variance.
    #[must_use]
    pub fn noise_budget(&self, bands: &Bands, signal: &[f64], view: &View) -> Vec<NoiseLine> {
        let kappa = view.extent.pixels() * self.counts_per_radiance(bands, view);
        let shot = BandLine {
            label: SHOT,
            var_counts: signal.iter().map(|signal| kappa * signal).collect(),
            scaling: "t",
            source: "photons of the target",
            with_photons: true,
        };
        let mean = |var: &[f64]| crate::sum::sum(var) / bands.len() as f64;
        std::iter::once(shot)
            .chain(self.added_noise(bands, view))
            .map(|line| NoiseLine {
                label: line.label,
                var_counts: mean(&line.var_counts),
                scaling: line.scaling,
                source: line.source,
            })
            .collect()
    }
}
