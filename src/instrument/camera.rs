//! A camera with every figure that it needs, and what follows from them alone.
//!
//! * étendue of a pixel π A_p/(4F² + (f/z)²) (S7), A_p pixel area (m²), F f-number, f focal length (m),
//!   z distance (m);
//! * H = t A_p/((1 + γ)F²), the hardware figure of the paper's policy inequality, m² s.
//!
//! Source: paper S7, Methods 'Guiding public policy'.

use super::assumed::{Assumed, PAPER_RANGE_CM1};
use super::counting::Counting;
use super::figures::every_figure;
use super::{EfficiencyCurve, NoiseSpec, Pattern, Readout, View};
use crate::error::Result;
use crate::planck;
use crate::spectrum::Bands;

/// Windows of the air in which thermal detectors work: 8 to 14 µm as the paper counts it, and 3 to 5 µm, cm⁻¹.
const WINDOWS_CM1: [[f64; 2]; 2] = [PAPER_RANGE_CM1, [2000.0, 1e4 / 3.0]];
/// Step of a camera's own bands, cm⁻¹: the paper's.
pub(super) const OWN_STEP_CM1: f64 = 1.0;
/// Share of a time that is rounding.
const SAME_TIME: f64 = 1e-12;
/// How far the angle of a pixel may be outside what field of view and pixels across it say, as a share: distortion.
const DISTORTION: f64 = 0.1;

macro_rules! camera {
    ($spec:tt [$($field:tt)*] $both:tt $own:tt $rows:tt) => {
        /// A spectral thermal camera.
        #[derive(Debug, Clone, PartialEq, serde::Serialize)]
        pub struct Camera {
            $($field)*
        }
    };
}

every_figure!(camera);

impl Camera {
    /// Étendue of a pixel, m² sr, for a target at `distance_m` (infinitely far where `None`) (S7).
    ///
    /// ```
    /// let camera = hadar::instrument::presets::get("flir-a325sc")?;
    /// let far = camera.etendue_m2_sr(None);
    /// let exact = std::f64::consts::PI * 12e-6 * 12e-6 / (4.0 * 1.3 * 1.3);
    /// assert!((far / exact - 1.0).abs() < 1e-15);
    /// assert!(camera.etendue_m2_sr(Some(0.1)) < far);
    /// # Ok::<(), hadar::Error>(())
    /// ```
    #[must_use]
    pub fn etendue_m2_sr(&self, distance_m: Option<f64>) -> f64 {
        let near = distance_m.map_or(0.0, |z| self.focal_length_m / z);
        std::f64::consts::PI * self.pixel_m * self.pixel_m
            / (4.0 * self.f_number * self.f_number + near * near)
    }

    /// Sine of the angle between the axis and the rim of the lens as a pixel sees it, 1/(2F): that of the cone whose étendue is
    /// π A_p/(4F²).
    #[must_use]
    pub fn rim_sine(&self) -> f64 {
        (0.5 / self.f_number).min(1.0)
    }

    /// Side of what a pixel sees at a distance in m, m.
    #[must_use]
    pub fn footprint_m(&self, distance_m: f64) -> f64 {
        self.pixel_m * distance_m / self.focal_length_m
    }

    /// What a pixel sees, rad: by its side and the focal length, and by the view and the pixels across it, the finer one first. Both are
    /// the same where the view is not known.
    #[must_use]
    pub fn pixel_angles_rad(&self) -> [f64; 2] {
        let by_lens = self.pixel_m / self.focal_length_m;
        let by_view = self.view_and_pixels().map_or(by_lens, |(view_rad, pixels)| view_rad / pixels);
        [by_lens.min(by_view), by_lens.max(by_view)]
    }

    /// Whether these two are no picture of one lens. It may keep straight lines straight, with 2 tan(θ/2) of a view θ over all pixels,
    /// or angles, with θ, and distort a little.
    #[must_use]
    pub fn contradicts_its_view(&self) -> bool {
        let by_lens = self.pixel_m / self.focal_length_m;
        self.view_and_pixels().is_some_and(|(view_rad, pixels)| {
            let [least, most] = [view_rad / pixels, 2.0 * (0.5 * view_rad).tan() / pixels];
            !(least * (1.0 - DISTORTION)..=most * (1.0 + DISTORTION)).contains(&by_lens)
        })
    }

    /// The view, rad, and the pixels across it, where both are known.
    #[must_use]
    pub fn view_and_pixels(&self) -> Option<(f64, f64)> {
        Some((self.field_of_view_rad?, f64::from(self.pixels?)))
    }

    /// Where nobody states the range of the detector, it is taken to see these bands and the rest of the windows of the air that they lie
    /// in: an NETD is of all that its detector sees.
    pub fn sees(&mut self, bands: &Bands) {
        let Some(range) = self.assumed.iter_mut().find(|one| one.figure == "spectral_range") else { return };
        let asked = bands.range_cm1();
        let [mut low, mut high] = [asked.0, asked.1];
        for [from, to] in WINDOWS_CM1 {
            if asked.0 < to && asked.1 > from {
                (low, high) = (low.min(from), high.max(to));
            }
        }
        self.spectral_range_cm1 = [low, high];
        range.taken = format!("{low:.0} to {high:.0} cm^-1");
    }

    /// The bands as the detector receives them, weighed with the efficiencies that depend on wavenumber.
    #[must_use]
    pub fn received(&self, bands: &Bands) -> Bands {
        if self.efficiency_curves.is_empty() {
            return bands.clone();
        }
        bands.transmitted(|nu| self.efficiency_at(nu))
    }

    /// The product of the efficiencies that depend on wavenumber, at one (cm⁻¹).
    pub(super) fn efficiency_at(&self, wavenumber_cm1: f64) -> f64 {
        self.efficiency_curves.iter().map(|curve| curve.at(wavenumber_cm1)).product()
    }

    /// Total integration time of a band, s: exposure × frames.
    #[must_use]
    pub fn integration_s(&self) -> f64 {
        self.exposure_s * f64::from(self.frames)
    }

    /// Time until all bands of all frames are read, s. Exposures wait for their frames where the frame rate is known.
    #[must_use]
    pub fn acquisition_s(&self, bands: usize) -> f64 {
        self.series_s(self.readout.exposures(bands) as f64 * f64::from(self.frames))
    }

    /// Time until all bands are exposed once, s.
    #[must_use]
    pub fn sweep_s(&self, bands: usize) -> f64 {
        self.series_s(self.readout.exposures(bands) as f64)
    }

    /// Frames of all bands that are read within `time_s`, 0 if not one is.
    ///
    /// ```
    /// let mut camera = hadar::instrument::presets::get("flir-a325sc")?;
    /// camera.frame_rate_hz = Some(60.0);
    /// // 110 frames begin within 1.83 s, and the last of them ends within it.
    /// assert_eq!(camera.frames_within(11.0 / 6.0, 1), 110);
    /// assert_eq!(camera.frames_within(1e-3, 1), 0);
    /// // Five bands one after the other.
    /// camera.readout = hadar::instrument::Readout::Sequential;
    /// assert_eq!(camera.frames_within(11.0 / 6.0, 5), 22);
    /// # Ok::<(), hadar::Error>(())
    /// ```
    #[must_use]
    pub fn frames_within(&self, time_s: f64, bands: usize) -> u32 {
        let (first_s, next_s) = (self.exposure_s, self.series_s(2.0) - self.exposure_s);
        // A time of so many frames to the last bit holds them all.
        let exposures = 1.0 + (time_s * (1.0 + SAME_TIME) - first_s) / next_s;
        if exposures >= 1.0 { (exposures / self.readout.exposures(bands) as f64) as u32 } else { 0 }
    }

    /// From the begin of the first to the end of the last of so many exposures, s.
    fn series_s(&self, exposures: f64) -> f64 {
        self.exposure_s + (exposures - 1.0) * self.exposure_s.max(self.frame_s().unwrap_or(0.0))
    }

    /// The exposure with which all bands are exposed once in `time_s`; not positive where the frames alone take longer.
    #[must_use]
    pub fn exposure_of_sweep_s(&self, bands: usize, time_s: f64) -> f64 {
        self.exposure_of_series_s(self.readout.exposures(bands) as f64, time_s)
    }

    /// The exposure with which all bands of all frames are read in `time_s`; not positive where the frames alone take longer.
    #[must_use]
    pub fn exposure_of_acquisition_s(&self, bands: usize, time_s: f64) -> f64 {
        self.exposure_of_series_s(self.readout.exposures(bands) as f64 * f64::from(self.frames), time_s)
    }

    fn exposure_of_series_s(&self, exposures: f64, time_s: f64) -> f64 {
        match self.frame_s() {
            Some(frame_s) if time_s < exposures * frame_s => time_s - (exposures - 1.0) * frame_s,
            _ => time_s / exposures,
        }
    }

    /// The longest exposure of a frame, s, where the frame rate is known.
    #[must_use]
    pub fn frame_s(&self) -> Option<f64> {
        self.frame_rate_hz.map(f64::recip)
    }

    /// The bands in which NETD, photons and γ of the camera itself are quoted: 1 cm⁻¹ over its range.
    ///
    /// # Errors
    /// A range that makes no bands.
    pub fn own_bands(&self) -> Result<Bands> {
        let [low, high] = self.spectral_range_cm1;
        Bands::uniform(low, high, OWN_STEP_CM1)
    }

    /// Photons per exposure of a blackbody at the reference temperature, noise and figures of merit.
    ///
    /// # Errors
    /// As [`Camera::own_bands`].
    pub fn figures(&self) -> Result<Figures> {
        let bands = self.own_bands()?;
        let one_frame = Self { frames: 1, ..self.clone() };
        let bands = one_frame.received(&bands);
        let counting = one_frame.counting(&bands, &View::default());
        let mut blackbody = vec![0.0; bands.nodes_cm1().len()];
        planck::photon_radiance_into(bands.nodes_cm1(), self.reference_temperature_k, &mut blackbody);
        let photons = counting.counts_per_radiance * crate::sum::sum(&bands.weigh(&blackbody));
        let var: f64 = (0..bands.len()).map(|w| counting.var_added(w)).sum();
        let gamma = var / photons;
        Ok(Figures {
            reference_temperature_k: self.reference_temperature_k,
            bands: bands.len(),
            photons,
            noise_counts: (var / bands.len() as f64).sqrt(),
            gamma_per_band: gamma,
            etendue_m2_sr: self.etendue_m2_sr(None),
            hardware_m2_s: one_frame.hardware_m2_s(gamma),
        })
    }

    /// H = t A_p/((1 + γ)F²), m² s, t the integration time.
    #[must_use]
    pub fn hardware_m2_s(&self, gamma: f64) -> f64 {
        self.integration_s() * self.pixel_m * self.pixel_m / ((1.0 + gamma) * self.f_number * self.f_number)
    }
}

/// What a camera does in one exposure of a blackbody at its reference temperature.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Figures {
    /// Temperature of the blackbody, K.
    pub reference_temperature_k: f64,
    /// Number of 1 cm⁻¹ bands over the camera's spectral range.
    pub bands: usize,
    /// Photons in all bands together.
    pub photons: f64,
    /// Electronic noise of one band reading (root mean square over the bands), counts.
    pub noise_counts: f64,
    /// γ = Σσ²/ΣN: noise over photons of a band.
    pub gamma_per_band: f64,
    /// Étendue of a pixel for a far target, m² sr.
    pub etendue_m2_sr: f64,
    /// H = t A_p/((1 + γ)F²), m² s.
    pub hardware_m2_s: f64,
}

/// γ = Σσ²_w/ΣN_w of a scene whose band signals are `signal`.
#[must_use]
pub fn gamma_per_band(counting: &Counting, signal: &[f64]) -> f64 {
    let photons: f64 = signal.iter().map(|s| s * counting.counts_per_radiance).sum();
    let var: f64 = (0..signal.len()).map(|w| counting.var_added(w)).sum();
    if photons > 0.0 { var / photons } else { f64::INFINITY }
}
