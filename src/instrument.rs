//! The camera: from radiance to counts, and the noise beside them.
//!
//! * étendue of a pixel π A_p/(4F² + (f/z)²) (S7), A_p pixel area (m²), F f-number, f focal length (m),
//!   z distance (m);
//! * counts of band w: N_w = S_w × étendue × optics efficiency × quantum efficiency × exposure × frames, where a
//!   pixel that the target does not fill counts its share ([`View`]); efficiencies that depend on wavenumber
//!   ([`EfficiencyCurve`]) are in the weights of the bands;
//! * everything else that adds variance, as a budget of labelled lines ([`budget`]), the electronic noise of a
//!   band reading among them ([`noise`]);
//! * γ = Σσ²_w/ΣN_w, the noise of a reading over the photons of that band (the paper's γ per band);
//! * H = t A_p/((1 + γ)F²), the hardware figure of the paper's policy inequality, m² s.
//!
//! Assumptions: every band is read with the same exposure; linear response; photon bunching neglected
//! (occupancy per mode ≪ 1) unless it is asked for. Averaged frames add photons, Johnson noise and (fully
//! correlated) flicker noise as one longer exposure does; read noise and quantisation come with every frame.
//!
//! Source: paper S7–S16, Tables S1 and S2, Methods 'Guiding public policy'.

pub mod budget;
pub mod bunching;
pub mod comparison;
pub mod efficiency;
pub mod equivalents;
pub mod noise;
pub mod presets;
pub mod view;

pub use budget::NoiseLine;
pub use comparison::Comparison;
pub use efficiency::EfficiencyCurve;
pub use equivalents::Equivalents;
pub use noise::NoiseSpec;
pub use view::{Light, View};

use crate::error::{Error, Result, check};
use crate::fisher::Counting;
use crate::planck;
use crate::spectrum::Bands;

/// The fastest f-number of a lens in air (Abbe's sine condition).
pub const FASTEST_F_NUMBER: f64 = 0.5;

/// Share of a frame by which a stated exposure may exceed it: rounding.
const FRAME_ROUNDING: f64 = 0.01;

/// The most bits a converter has.
const MOST_BITS: u32 = 32;

/// When the bands are exposed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Readout {
    /// All in the same exposure.
    Simultaneous,
    /// One after the other, an exposure each: a wheel of filters, a scanned monochromator.
    Sequential,
    /// All at once through an interferometer, as many mirror positions as bands, an exposure each.
    FourierTransform,
    /// All in the same exposure, side by side behind a slit: an image is made line by line.
    Dispersive,
}

impl Readout {
    /// All of them.
    pub const ALL: [Self; 4] =
        [Self::Simultaneous, Self::Sequential, Self::FourierTransform, Self::Dispersive];

    /// The name in a scenario.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Simultaneous => "simultaneous",
            Self::Sequential => "sequential",
            Self::FourierTransform => "fourier-transform",
            Self::Dispersive => "dispersive",
        }
    }

    /// Exposures until all of so many bands are known.
    #[must_use]
    pub const fn exposures(self, bands: usize) -> usize {
        match self {
            Self::Simultaneous | Self::Dispersive => 1,
            Self::Sequential | Self::FourierTransform => bands,
        }
    }
}

/// A spectral thermal camera.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Camera {
    /// Name, as in `camera.preset`.
    pub name: String,
    /// What it is, in one line.
    pub description: String,
    /// Where the figures are from, and what is known to be wrong with them.
    pub provenance: Vec<String>,
    /// Figures that no document states, and what stands for them.
    pub assumed: Vec<String>,
    /// Exposure of one frame, s.
    pub exposure_s: f64,
    /// Side of a square pixel, m.
    pub pixel_m: f64,
    /// f-number F.
    pub f_number: f64,
    /// Focal length, m.
    pub focal_length_m: f64,
    /// Share of the photons that the optics pass, in (0, 1].
    pub optics_efficiency: f64,
    /// Share of the photons on the detector that are counted, in (0, 1].
    pub quantum_efficiency: f64,
    /// Efficiencies that depend on wavenumber, of the optics and of the detector, to be multiplied with the two above.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub efficiency_curves: Vec<EfficiencyCurve>,
    /// Electronic noise of one band reading.
    pub noise: NoiseSpec,
    /// Exposure at which that noise is stated, s.
    pub noise_exposure_s: f64,
    /// Share of the noise variance at that exposure which is flicker, in [0, 1].
    pub flicker_fraction: f64,
    /// Counts per second without any light.
    pub dark_rate_per_s: f64,
    /// Deviation that every reading adds whatever its exposure, counts.
    pub read_noise_counts: f64,
    /// Bits of the converter that divides the full well into steps, if known.
    pub quantisation_bits: Option<u32>,
    /// Counts at which a pixel is full, if known.
    pub full_well: Option<f64>,
    /// Whether the bunching of thermal photons adds its noise.
    pub photon_bunching: bool,
    /// When the bands are exposed.
    pub readout: Readout,
    /// Frames that are averaged.
    pub frames: u32,
    /// Frames per second, if known: an exposure is no longer than a frame.
    pub frame_rate_hz: Option<f64>,
    /// Temperature of the sensor, whose emission filters throw back onto it (K of S8), K, if known.
    pub sensor_temperature_k: Option<f64>,
    /// Temperature of the filters (F of S8), K, if known; else that of the sensor.
    pub filter_temperature_k: Option<f64>,
    /// Full field of view across, rad, if known.
    pub field_of_view_rad: Option<f64>,
    /// Pixels across the field of view, if known.
    pub pixels: Option<u32>,
    /// Temperature of the blackbody at which photons and γ are quoted, K.
    pub reference_temperature_k: f64,
    /// The spectral range of the detector, cm⁻¹, in which NETD and photons are quoted.
    pub spectral_range_cm1: [f64; 2],
}

impl Camera {
    /// Checks every figure.
    ///
    /// # Errors
    /// The first figure that is out of range, by its name in the scenario.
    pub fn checked(self) -> Result<Self> {
        check::positive("exposure", self.exposure_s, "s")?;
        check::positive("pixel", self.pixel_m, "m")?;
        check::positive("focal_length", self.focal_length_m, "m")?;
        check::positive("noise exposure", self.noise_exposure_s, "s")?;
        check::positive("reference temperature", self.reference_temperature_k, "K")?;
        if !(self.f_number.is_finite() && self.f_number >= FASTEST_F_NUMBER) {
            return Err(Error::out_of_range(
                "f_number",
                self.f_number,
                "",
                "0.5 or above: no lens in air is faster",
            ));
        }
        check::positive("optics_efficiency", self.optics_efficiency, "")?;
        check::unit_interval("optics_efficiency", self.optics_efficiency)?;
        check::positive("quantum_efficiency", self.quantum_efficiency, "")?;
        check::unit_interval("quantum_efficiency", self.quantum_efficiency)?;
        check::unit_interval("flicker_fraction", self.flicker_fraction)?;
        check::non_negative("dark_rate", self.dark_rate_per_s, "1/s")?;
        check::non_negative("read_noise", self.read_noise_counts, "counts")?;
        for (name, figure) in [
            ("full_well", self.full_well),
            ("frame_rate", self.frame_rate_hz),
            ("sensor_temperature", self.sensor_temperature_k),
            ("filter_temperature", self.filter_temperature_k),
        ] {
            if let Some(figure) = figure {
                check::positive(name, figure, "")?;
            }
        }
        self.check_frame()?;
        if self.quantisation_bits.is_some() && self.full_well.is_none() {
            return Err(Error::malformed(
                "quantisation_bits without a full_well to divide",
                "write full_well = 1e7 beside it",
            ));
        }
        if self.quantisation_bits.is_some_and(|bits| bits > MOST_BITS) {
            let bits = f64::from(self.quantisation_bits.unwrap_or_default());
            return Err(Error::out_of_range("quantisation_bits", bits, "", format!("at most {MOST_BITS}")));
        }
        if self.filter_temperature_k.is_some() && self.sensor_temperature_k.is_none() {
            return Err(Error::malformed(
                "filter_temperature without a sensor_temperature",
                "write sensor_temperature = \"30 degC\" beside it",
            ));
        }
        check::positive("frames", f64::from(self.frames), "")?;
        let [low, high] = self.spectral_range_cm1;
        check::positive("spectral range", low, "cm^-1")?;
        if high <= low {
            return Err(Error::out_of_range("spectral range", high, "cm^-1", format!("above {low} cm^-1")));
        }
        self.noise.check()?;
        Ok(self)
    }

    /// Refuses an exposure that is longer than a frame.
    fn check_frame(&self) -> Result<()> {
        let Some(rate) = self.frame_rate_hz else { return Ok(()) };
        // Stated figures are rounded: 16.7 ms at 60 Hz is a whole frame.
        if self.exposure_s * rate <= 1.0 + FRAME_ROUNDING {
            return Ok(());
        }
        let frame_ms = (1e7 / rate).round() / 1e4;
        Err(Error::out_of_range(
            "exposure",
            self.exposure_s,
            "s",
            format!("at most the {frame_ms} ms of a frame (frame_rate = \"{rate} Hz\")"),
        ))
    }

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

    /// From the begin of the first to the end of the last of so many exposures, s.
    fn series_s(&self, exposures: f64) -> f64 {
        self.exposure_s + (exposures - 1.0) * self.exposure_s.max(self.frame_s().unwrap_or(0.0))
    }

    /// The exposure with which all bands are exposed once in `time_s`; not positive where the frames alone take longer.
    #[must_use]
    pub fn exposure_of_sweep_s(&self, bands: usize, time_s: f64) -> f64 {
        let exposures = self.readout.exposures(bands) as f64;
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

    /// σ of each band reading at the exposure the noise is stated for, in counts; `None` without noise.
    #[must_use]
    pub fn reading_sigma(&self, bands: &Bands) -> Option<Vec<f64>> {
        noise::reading_sigma(self, bands)
    }

    /// The bands in which NETD, photons and γ of the camera itself are quoted: 1 cm⁻¹ over its range.
    ///
    /// # Errors
    /// A range that makes no bands.
    pub fn own_bands(&self) -> Result<Bands> {
        let [low, high] = self.spectral_range_cm1;
        Bands::uniform(low, high, 1.0)
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
        // Photons between the ends of the range; the outermost bands of Table S2 reach half a band beyond.
        let [low, high] = self.spectral_range_cm1;
        let range = one_frame.received(&Bands::from_ranges(&[(low, high)])?);
        let mut blackbody = vec![0.0; range.nodes_cm1().len()];
        planck::photon_radiance_into(range.nodes_cm1(), self.reference_temperature_k, &mut blackbody);
        let photons = counting.counts_per_radiance * range.weigh(&blackbody).iter().sum::<f64>();
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
