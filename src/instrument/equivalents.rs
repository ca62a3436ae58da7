//! The same electronic noise, stated in every way that data sheets use.
//!
//! Every statement is linear in σ, the deviation of a band reading in counts (D* is so in 1/σ), so that each is σ over
//! what one unit of it amounts to by [`NoiseSpec`]:
//!
//! * NETD = σ/(dN/dT), N photons of a blackbody in all of the camera's range (K); one that is measured is √(σ² + N)/(dN/dT);
//! * NEP = σ hcν/(η_q t), power on the detector (W); per √Hz it is NEP/√Δf;
//! * D* = √(A_p Δf)/NEP (cm √Hz W⁻¹), A_p pixel area;
//! * NESR = σ hcν/(t η × étendue × Δλ) (µflick = µW cm⁻² sr⁻¹ µm⁻¹), Δλ width of the band in wavelength;
//! * γ = Σσ²/ΣN over the bands.
//!
//! t is the exposure for which the noise is stated, ν (cm⁻¹) the middle of the camera's range where a statement depends on
//! it, Δf the stated bandwidth or else 1/(2t). Photons pass the camera's own optics, so that an NETD that was measured in
//! front of them comes back divided by their efficiency.
//!
//! Assumptions: one frame; a target far away; bands of 1 cm⁻¹. Dark counts, read noise and quantisation are other lines of
//! the budget and not part of σ.
//!
//! Source: paper Table S2 and the text above it, S7.

pub use super::noise::NetdConditions;

use super::{Camera, NoiseSpec, Readout, View};
use crate::error::Result;
use crate::planck;
use crate::spectrum::Bands;
use crate::units::{PLANCK_J_S, SPEED_OF_LIGHT_M_S};

/// Width of the bands in which noise is stated, cm⁻¹.
const BAND_CM1: f64 = 1.0;

/// One noise in every way of stating it. What depends on a wavenumber is for the middle of the range.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Equivalents {
    /// Exposure for which all of this holds, s.
    pub exposure_s: f64,
    /// Bandwidth for which the noise is stated, Hz.
    pub bandwidth_hz: f64,
    /// Middle of the spectral range, cm⁻¹.
    pub mid_cm1: f64,
    /// Temperature of the blackbody of NETD and γ, K.
    pub reference_temperature_k: f64,
    /// f-number of the NETD: the camera's own.
    pub f_number: f64,
    /// σ of a band reading, root mean square over bands of 1 cm⁻¹, counts.
    pub sigma_counts: f64,
    /// NETD of a reading of all photons of the range, behind the camera's optics, K.
    pub netd_k: f64,
    /// The same with the shot noise of those photons, K.
    pub netd_with_shot_noise_k: f64,
    /// NETD of a single band of 1 cm⁻¹ in the middle of the range, K.
    pub netd_of_a_band_k: f64,
    /// Noise-equivalent power in the bandwidth, W.
    pub nep_w: f64,
    /// Noise-equivalent power of 1 Hz, W Hz^-½.
    pub nep_w_hz05: f64,
    /// Specific detectivity, cm √Hz W⁻¹; none where there is no noise.
    pub detectivity_cm_hz05_w: Option<f64>,
    /// Noise-equivalent spectral radiance of a band of 1 cm⁻¹, µflick.
    pub nesr_microflick: f64,
    /// γ = Σσ²/ΣN over bands of 1 cm⁻¹.
    pub gamma_per_band: f64,
}

impl NetdConditions {
    /// Those of the camera itself, at a temperature in K.
    #[must_use]
    pub fn of(camera: &Camera, temperature_k: f64) -> Self {
        Self {
            temperature_k,
            f_number: camera.f_number,
            optics_efficiency: camera.optics_efficiency,
            pixel_m: camera.pixel_m,
        }
    }
}

/// σ in counts of an NETD in K under these conditions: NETD · dN/dT. Of a measured NETD it is that of shot noise and electronic noise together.
///
/// ```
/// use hadar::instrument::{equivalents, presets};
/// let camera = presets::get("flir-a325sc")?;
/// // Table S2 counts the photons in front of the optics.
/// let at = equivalents::NetdConditions { optics_efficiency: 1.0, ..equivalents::NetdConditions::of(&camera, 303.15) };
/// let sigma = equivalents::sigma_of_netd(&camera, 47.8e-3, at);
/// assert!((sigma / 1.769e6 - 1.0).abs() < 1e-3);
/// assert!((equivalents::netd_of_sigma(&camera, sigma, at) / 47.8e-3 - 1.0).abs() < 1e-14);
/// # Ok::<(), hadar::Error>(())
/// ```
#[must_use]
pub fn sigma_of_netd(camera: &Camera, netd_k: f64, at: NetdConditions) -> f64 {
    netd_k * per_kelvin(camera, at)
}

/// NETD in K under these conditions of σ in counts.
#[must_use]
pub fn netd_of_sigma(camera: &Camera, sigma_counts: f64, at: NetdConditions) -> f64 {
    sigma_counts / per_kelvin(camera, at)
}

/// The NETD (K) of the same detector at another temperature, f-number, optics efficiency or pixel: as 1/(dN/dT), hence with F².
///
/// ```
/// use hadar::instrument::{equivalents, presets};
/// let camera = presets::get("flir-a325sc")?;
/// let at = equivalents::NetdConditions::of(&camera, 300.0);
/// let slow = equivalents::NetdConditions { f_number: 2.0 * at.f_number, ..at };
/// assert!((equivalents::netd_elsewhere(&camera, 50e-3, at, slow) / 200e-3 - 1.0).abs() < 1e-14);
/// # Ok::<(), hadar::Error>(())
/// ```
#[must_use]
pub fn netd_elsewhere(camera: &Camera, netd_k: f64, from: NetdConditions, to: NetdConditions) -> f64 {
    netd_k * per_kelvin(camera, from) / per_kelvin(camera, to)
}

/// σ in counts of a power on the detector in W at a wavenumber in cm⁻¹: η_q NEP t/(hcν).
///
/// # Errors
/// A wavenumber that makes no band.
pub fn sigma_of_nep(camera: &Camera, nep_w: f64, wavenumber_cm1: f64) -> Result<f64> {
    Ok(nep_w * one_watt(camera, &band_at(camera, wavenumber_cm1)?))
}

/// Power on the detector in W of σ in counts at a wavenumber in cm⁻¹.
///
/// # Errors
/// A wavenumber that makes no band.
pub fn nep_of_sigma(camera: &Camera, sigma_counts: f64, wavenumber_cm1: f64) -> Result<f64> {
    Ok(sigma_counts / one_watt(camera, &band_at(camera, wavenumber_cm1)?))
}

/// D* (cm √Hz W⁻¹) of a noise-equivalent power (W) in a bandwidth (Hz), for a pixel of side `pixel_m` (m): √(A_p Δf)/NEP.
#[must_use]
pub fn detectivity_of_nep(nep_w: f64, pixel_m: f64, bandwidth_hz: f64) -> f64 {
    100.0 * pixel_m * bandwidth_hz.sqrt() / nep_w
}

/// Noise-equivalent power (W) in a bandwidth (Hz) of D* (cm √Hz W⁻¹).
#[must_use]
pub fn nep_of_detectivity(detectivity_cm_hz05_w: f64, pixel_m: f64, bandwidth_hz: f64) -> f64 {
    // √(A_p Δf) over the one is the other, both ways.
    detectivity_of_nep(detectivity_cm_hz05_w, pixel_m, bandwidth_hz)
}

/// σ in counts of a spectral radiance in µflick, in the band of 1 cm⁻¹ at a wavenumber in cm⁻¹.
///
/// # Errors
/// A wavenumber that makes no band.
pub fn sigma_of_nesr(camera: &Camera, microflick: f64, wavenumber_cm1: f64) -> Result<f64> {
    Ok(microflick * one_microflick(camera, &band_at(camera, wavenumber_cm1)?))
}

/// Spectral radiance in µflick of σ in counts, in the band of 1 cm⁻¹ at a wavenumber in cm⁻¹.
///
/// # Errors
/// A wavenumber that makes no band.
pub fn nesr_of_sigma(camera: &Camera, sigma_counts: f64, wavenumber_cm1: f64) -> Result<f64> {
    Ok(sigma_counts / one_microflick(camera, &band_at(camera, wavenumber_cm1)?))
}

/// Spectral radiance of a blackbody, µflick, at a wavelength (µm) and temperature (K); and its slope, µflick per K.
///
/// ```
/// let (all, slope) = hadar::instrument::equivalents::blackbody_microflick(10.0, 300.0);
/// assert!((all - 992.0).abs() < 1.0 && (1e3 / slope - 62.51).abs() < 0.01);
/// ```
#[must_use]
pub fn blackbody_microflick(wavelength_um: f64, temperature_k: f64) -> (f64, f64) {
    let nu = 1e4 / wavelength_um;
    // Photons per cm⁻¹ times their energy, W m⁻² sr⁻¹ per cm⁻¹; dν/dλ = ν²/10⁴ cm⁻¹ per µm; 100 µflick are 1 W m⁻² sr⁻¹ µm⁻¹.
    let scale = PLANCK_J_S * SPEED_OF_LIGHT_M_S * 100.0 * nu * (nu * nu / 1e4) * 100.0;
    let photons = planck::photon_radiance(nu, temperature_k);
    (photons * scale, planck::photon_radiance_slope(nu, temperature_k) * scale)
}

impl Camera {
    /// The electronic noise of a reading stated in every way.
    ///
    /// # Errors
    /// As [`Camera::own_bands`].
    ///
    /// ```
    /// let noise = hadar::instrument::presets::get("nicolet-is50")?.equivalents()?;
    /// assert!((noise.detectivity_cm_hz05_w.unwrap_or(0.0) / 4.7e10 - 1.0).abs() < 1e-13);
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn equivalents(&self) -> Result<Equivalents> {
        let camera = reading(self);
        let [low, high] = camera.spectral_range_cm1;
        let (t, mid_cm1) = (camera.exposure_s, 0.5 * (low + high));
        let bandwidth_hz = match camera.noise {
            NoiseSpec::Detectivity { bandwidth_hz: Some(hz), .. }
            | NoiseSpec::Nep { bandwidth_hz: Some(hz), .. } => hz,
            _ => 0.5 / t,
        };
        let bands = camera.received(&camera.own_bands()?);
        let var: Vec<f64> =
            camera.reading_sigma(&bands).unwrap_or_default().iter().map(|sigma| sigma * sigma).collect();
        let var = crate::sum::sum(&var);
        let sigma_counts = (var / bands.len() as f64).sqrt();
        let temperature_k = camera.reference_temperature_k;
        let photons = camera.figures()?.photons;
        let slope = camera.counts_per_kelvin(temperature_k);
        let mid = band_at(&camera, mid_cm1)?;
        let sigma_mid = one_band(&camera, &mid);
        let nep_w = sigma_mid / one_watt(&camera, &mid);
        Ok(Equivalents {
            exposure_s: t,
            bandwidth_hz,
            mid_cm1,
            reference_temperature_k: temperature_k,
            f_number: camera.f_number,
            sigma_counts,
            netd_k: sigma_counts / slope,
            netd_with_shot_noise_k: (sigma_counts * sigma_counts + photons).sqrt() / slope,
            netd_of_a_band_k: sigma_mid / band_slope(&camera, &mid, temperature_k),
            nep_w,
            nep_w_hz05: nep_w / bandwidth_hz.sqrt(),
            detectivity_cm_hz05_w: (nep_w > 0.0)
                .then(|| detectivity_of_nep(nep_w, camera.pixel_m, bandwidth_hz)),
            nesr_microflick: sigma_mid / one_microflick(&camera, &mid),
            gamma_per_band: var / photons,
        })
    }
}

/// The camera as it makes the reading for which its noise is stated.
fn reading(camera: &Camera) -> Camera {
    Camera {
        exposure_s: camera.noise_exposure_s,
        frames: 1,
        readout: Readout::Simultaneous,
        ..camera.clone()
    }
}

/// dN/dT under these conditions, counts per K.
pub(super) fn per_kelvin(camera: &Camera, at: NetdConditions) -> f64 {
    let stated = Camera {
        f_number: at.f_number,
        optics_efficiency: at.optics_efficiency,
        pixel_m: at.pixel_m,
        ..reading(camera)
    };
    stated.counts_per_kelvin(at.temperature_k)
}

/// The band of 1 cm⁻¹ at a wavenumber, as the detector receives it.
fn band_at(camera: &Camera, wavenumber_cm1: f64) -> Result<Bands> {
    Ok(camera.received(&Bands::from_rows([(wavenumber_cm1, BAND_CM1)])?))
}

/// σ of a single band, counts; 0 without noise.
fn one_band(camera: &Camera, band: &Bands) -> f64 {
    camera.reading_sigma(band).and_then(|sigma| sigma.first().copied()).unwrap_or(0.0)
}

/// Counts that 1 W on the detector amounts to in the exposure of the noise.
fn one_watt(camera: &Camera, band: &Bands) -> f64 {
    let noise = NoiseSpec::Nep { nep_w_hz05: 1.0, bandwidth_hz: Some(1.0) };
    one_band(&Camera { noise, ..camera.clone() }, band)
}

/// Counts that 1 µflick amounts to in the exposure of the noise.
fn one_microflick(camera: &Camera, band: &Bands) -> f64 {
    let (f_number, optics_efficiency, pixel_m) = (camera.f_number, camera.optics_efficiency, camera.pixel_m);
    let noise = NoiseSpec::SpectralRadiance { microflick: 1.0, f_number, optics_efficiency, pixel_m };
    one_band(&Camera { noise, ..camera.clone() }, band)
}

/// dN/dT of a single band, counts per K.
fn band_slope(camera: &Camera, band: &Bands, temperature_k: f64) -> f64 {
    let slopes: Vec<f64> =
        band.nodes_cm1().iter().map(|nu| planck::photon_radiance_slope(*nu, temperature_k)).collect();
    camera.counts_per_radiance(band, &View::default()) * crate::sum::sum(&band.weigh(&slopes))
}
