//! The camera: from radiance to counts, and the noise beside them.
//!
//! * étendue of a pixel π A_p/(4F² + (f/z)²) (S7), A_p pixel area (m²), F f-number, f focal length (m),
//!   z distance (m);
//! * counts of band w: N_w = S_w × étendue × optics efficiency × exposure × frames;
//! * electronic noise per band reading, as a budget of labelled lines ([`noise`]): Johnson σ² ∝ t,
//!   flicker σ² ∝ t²;
//! * γ = Σσ²_w/ΣN_w, the noise of a reading over the photons of that band (the paper's γ per band);
//! * H = t A_p/((1 + γ)F²), the hardware figure of the paper's policy inequality, m² s.
//!
//! Assumptions: every band is read by every pixel with the same exposure; unit quantum efficiency unless
//! it is folded into the optics efficiency; photon bunching neglected (occupancy per mode ≪ 1); linear
//! response. Averaged frames add photons, Johnson noise and (fully correlated) flicker noise as one longer
//! exposure does.
//!
//! Source: paper S7–S16, Tables S1 and S2, Methods 'Guiding public policy'.

pub mod bunching;
pub mod noise;
pub mod presets;

pub use noise::{NoiseLine, NoiseSpec};

use crate::error::{Error, Result, check};
use crate::fisher::Counting;
use crate::planck;
use crate::spectrum::Bands;

/// The fastest f-number of a lens in air (Abbe's sine condition).
pub const FASTEST_F_NUMBER: f64 = 0.5;

/// When the bands are exposed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Readout {
    /// All in the same exposure.
    Simultaneous,
    /// One after the other, an exposure each.
    Sequential,
}

impl Readout {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Simultaneous, Self::Sequential];

    /// The name in a scenario.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Simultaneous => "simultaneous",
            Self::Sequential => "sequential",
        }
    }
}

/// A spectral thermal camera.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Camera {
    /// Name, as in `camera.preset`.
    pub name: String,
    /// What it is, in one line.
    #[serde(default)]
    pub description: String,
    /// Where the figures are from, and what is known to be wrong with them.
    #[serde(default)]
    pub provenance: Vec<String>,
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
    /// Electronic noise of one band reading.
    pub noise: NoiseSpec,
    /// Exposure at which that noise is stated, s.
    pub noise_exposure_s: f64,
    /// Share of the noise variance at that exposure which is flicker, in [0, 1].
    pub flicker_fraction: f64,
    /// Counts at which a pixel is full, if known.
    pub full_well: Option<f64>,
    /// When the bands are exposed.
    pub readout: Readout,
    /// Frames that are averaged.
    pub frames: u32,
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
        check::unit_interval("flicker_fraction", self.flicker_fraction)?;
        check::positive("frames", f64::from(self.frames), "")?;
        let [low, high] = self.spectral_range_cm1;
        check::positive("spectral range", low, "cm^-1")?;
        if high <= low {
            return Err(Error::out_of_range("spectral range", high, "cm^-1", format!("above {low} cm^-1")));
        }
        self.noise.check()?;
        Ok(self)
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

    /// Time until all bands are read, s.
    #[must_use]
    pub fn acquisition_s(&self, bands: usize) -> f64 {
        match self.readout {
            Readout::Simultaneous => self.integration_s(),
            Readout::Sequential => self.integration_s() * bands as f64,
        }
    }

    /// Counts per unit of band signal, and the variance of the electronic noise of each band.
    #[must_use]
    pub fn counting(&self, bands: &Bands, distance_m: Option<f64>) -> Counting {
        let counts_per_radiance =
            self.etendue_m2_sr(distance_m) * self.optics_efficiency * self.integration_s();
        let stretch = self.integration_s() / self.noise_exposure_s;
        let growth = noise::growth(stretch, self.flicker_fraction);
        let var_added = match self.reading_sigma(bands) {
            Some(sigma) => sigma.iter().map(|sigma| sigma * sigma * growth).collect(),
            None => Vec::new(),
        };
        Counting { counts_per_radiance, var_added }
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
        let counting = one_frame.counting(&bands, None);
        // Photons between the ends of the range; the outermost bands of Table S2 reach half a band beyond.
        let [low, high] = self.spectral_range_cm1;
        let range = Bands::from_ranges(&[(low, high)])?;
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
