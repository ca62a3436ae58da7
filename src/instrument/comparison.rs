//! Two cameras before the same scene.
//!
//! What tells two spectra apart that differ by the same small share in every band is Σ_w N_w²/(N_w + σ²_w), N_w counts and
//! σ²_w all other variance of band w: the square of d over that share. Its root over the number of bands is the figure of
//! merit here, so that the ratio of two cameras is the ratio of their distances d in one acquisition. In the same time the
//! quicker one averages more frames: lines of the budget that grow as t or with the frames then grow with their number, those
//! of t² with its square.
//!
//! Assumptions: a grey scene of one temperature that fills the pixel; bands of 1 cm⁻¹ in the range that both cameras see;
//! spectra that differ little and alike in all bands. Pairs whose difference is in a few bands weigh those alone.
//!
//! Source: S25–S27 of the paper for small differences.

use super::{Camera, NoiseLine, View};
use crate::error::{Error, Result};
use crate::planck;
use crate::spectrum::Bands;

/// Temperature of the scene in which cameras are compared, K.
pub const SCENE_K: f64 = 300.0;

/// Two cameras in the range that both see; every ratio is of B over A.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Comparison {
    /// Temperature of the scene, K.
    pub temperature_k: f64,
    /// The range that both see, cm⁻¹.
    pub range_cm1: [f64; 2],
    /// What A does in it.
    pub a: InScene,
    /// What B does in it.
    pub b: InScene,
    /// Ratio of the photons in one acquisition, B over A.
    pub photons: f64,
    /// Photons in the same time.
    pub photons_in_same_time: f64,
    /// Noise other than the target's photons, in one acquisition; none where A has none.
    pub noise: Option<f64>,
    /// Noise other than the target's photons over the photons of a band; none where A has none.
    pub noise_over_photons: Option<f64>,
    /// Distance d of spectra that differ little, in one acquisition.
    pub distance: f64,
    /// The same in the time that the slower one takes for all bands.
    pub distance_in_same_time: f64,
}

/// A camera before a grey scene, in one acquisition of all bands.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct InScene {
    /// Number of spectral bands that the camera reads.
    pub bands: usize,
    /// Time until all bands are read, s.
    pub acquisition_s: f64,
    /// Expected photons in all bands of one acquisition.
    pub photons: f64,
    /// Deviation of a band by all but the photons of the target, root mean square over the bands, counts.
    pub noise_counts: f64,
    /// √(Σ N²/(N + σ²) / W): the distance d that a difference of 1 in every band would have, over √W.
    pub figure_of_merit: f64,
}

impl Camera {
    /// The lines of noise of an average band of these, before a far blackbody of a temperature in K.
    #[must_use]
    pub fn budget_of_blackbody(&self, bands: &Bands, temperature_k: f64) -> Vec<NoiseLine> {
        let bands = self.received(bands);
        let view = self.view_of_blackbody(&bands, temperature_k);
        self.noise_budget(&bands, &view.signal, &view)
    }

    /// The exposure in s after which the fullest reading of these bands before a blackbody fills the well, where its depth is
    /// known.
    #[must_use]
    pub fn full_well_exposure_s(&self, bands: &Bands, temperature_k: f64) -> Option<f64> {
        let full = self.full_well?;
        let bands = self.received(bands);
        let view = self.view_of_blackbody(&bands, temperature_k);
        Some(full * self.exposure_s / self.brightest_reading(&view.signal, &view))
    }

    /// What a pixel sees of a far blackbody, of bands as they are received.
    fn view_of_blackbody(&self, bands: &Bands, temperature_k: f64) -> View {
        let mut radiance = vec![0.0; bands.nodes_cm1().len()];
        planck::photon_radiance_into(bands.nodes_cm1(), temperature_k, &mut radiance);
        let signal = bands.weigh(&radiance);
        let occupancy = match self.photon_bunching {
            true => self.counts_per_mode_of_blackbody(bands, temperature_k),
            false => Vec::new(),
        };
        View { signal, occupancy, ..View::default() }
    }
}

/// Counts of every band, and its variance by how it grows: with t or frames, and with t².
struct Bandwise {
    counts: Vec<f64>,
    linear: Vec<f64>,
    square: Vec<f64>,
}

impl Bandwise {
    fn of(camera: &Camera, bands: &Bands) -> Self {
        let bands = camera.received(bands);
        let view = camera.view_of_blackbody(&bands, SCENE_K);
        let kappa = camera.counts_per_radiance(&bands, &view);
        let counts: Vec<f64> = view.signal.iter().map(|signal| kappa * signal).collect();
        let (mut linear, mut square) = (vec![0.0; counts.len()], vec![0.0; counts.len()]);
        for line in camera.added_noise(&bands, &view) {
            let sum = if line.scaling == "t^2" { &mut square } else { &mut linear };
            sum.iter_mut().zip(&line.var_counts).for_each(|(sum, var)| *sum += var);
        }
        Self { counts, linear, square }
    }

    /// The figure of merit with `frames` times as many frames.
    fn merit(&self, frames: f64) -> f64 {
        let terms =
            self.counts.iter().zip(&self.linear).zip(&self.square).map(|((counts, linear), square)| {
                counts * (counts / (counts + linear + frames * square)) * frames
            });
        (terms.sum::<f64>() / self.counts.len() as f64).sqrt()
    }

    fn in_scene(&self, acquisition_s: f64) -> InScene {
        let bands = self.counts.len();
        let var = (crate::sum::sum(&self.linear) + crate::sum::sum(&self.square)) / bands as f64;
        InScene {
            bands,
            acquisition_s,
            photons: crate::sum::sum(&self.counts),
            noise_counts: var.sqrt(),
            figure_of_merit: self.merit(1.0),
        }
    }
}

/// Two cameras before a grey scene of 300 K.
///
/// # Errors
/// Cameras whose spectral ranges have nothing in common.
///
/// ```
/// use hadar::instrument::{comparison::compare, presets};
/// let (bolometer, ideal) = (presets::get("flir-a325sc")?, presets::get("ideal-pnrd")?);
/// let ratios = compare(&bolometer, &ideal)?;
/// // Shot noise alone is nearly sqrt(1 + gamma) = 838 times better; less, as noise spares the bands with most photons.
/// assert!(ratios.distance > 750.0 && ratios.distance < 838.0);
/// # Ok::<(), hadar::Error>(())
/// ```
pub fn compare(a: &Camera, b: &Camera) -> Result<Comparison> {
    let low = a.spectral_range_cm1[0].max(b.spectral_range_cm1[0]);
    let high = a.spectral_range_cm1[1].min(b.spectral_range_cm1[1]);
    if high - low < 1.0 {
        let found = format!("{} and {} see no wavenumber that the other sees", a.name, b.name);
        return Err(Error::malformed(found, "compare cameras of the same range"));
    }
    let bands = Bands::uniform(low, high, 1.0)?;
    let (of_a, of_b) = (Bandwise::of(a, &bands), Bandwise::of(b, &bands));
    let (time_a, time_b) = (a.acquisition_s(bands.len()), b.acquisition_s(bands.len()));
    let (in_a, in_b) = (of_a.in_scene(time_a), of_b.in_scene(time_b));
    let slower = time_a.max(time_b);
    let photons = in_b.photons / in_a.photons;
    let noise = (in_a.noise_counts > 0.0).then(|| in_b.noise_counts / in_a.noise_counts);
    Ok(Comparison {
        temperature_k: SCENE_K,
        range_cm1: [low, high],
        photons,
        photons_in_same_time: photons * time_a / time_b,
        noise,
        noise_over_photons: noise.map(|noise| noise / photons),
        distance: in_b.figure_of_merit / in_a.figure_of_merit,
        distance_in_same_time: of_b.merit(slower / time_b) / of_a.merit(slower / time_a),
        a: in_a,
        b: in_b,
    })
}
