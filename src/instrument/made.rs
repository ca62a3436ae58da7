//! A camera made from what is stated of it, and what is stated of a camera that is made.
//!
//! What a camera cannot do without and nobody states is asked for, or something stands for it: the frame time for an
//! exposure (an NETD is of a frame, so that signal and noise stretch alike and only shot noise depends on it), an efficiency
//! of 1 beside an NETD (which was measured through the same lens). Every such figure is listed in [`Camera::assumed`], with whether a
//! camera may be worse.
//!
//! All other figures are taken as they are ([`Taken`]), there and back.

use super::assumed::{Assumed, PAPER_RANGE_CM1};
use super::figures::{NoiseFigures, Part, StatedNoise, TABLE, every_figure};
use super::noise::NetdConditions;
use super::pattern::{Pattern, PatternFigures};
use super::presets::{Missing, NoiseCamera, Preset};
use super::{Camera, CameraSpec, Efficiency, EfficiencyCurve, NoiseSpec, Readout};

/// Temperature of the blackbody at which figures are quoted where none is stated, K.
pub const REFERENCE_K: f64 = 303.15;

/// A figure in the other struct: what a camera has of what is stated, what is stated of what it has.
trait Taken<T> {
    fn taken(&self) -> T;
}

impl<T: Copy + Default> Taken<T> for Option<T> {
    fn taken(&self) -> T {
        self.unwrap_or_default()
    }
}

impl<T: Copy> Taken<Self> for Option<T> {
    fn taken(&self) -> Self {
        *self
    }
}

impl<T: Copy> Taken<Option<T>> for T {
    fn taken(&self) -> Option<T> {
        Some(*self)
    }
}

impl Taken<f64> for Option<Efficiency> {
    /// What depends on wavenumber is in the curves.
    fn taken(&self) -> f64 {
        self.as_ref().and_then(Efficiency::number).unwrap_or(1.0)
    }
}

impl Taken<Option<Efficiency>> for f64 {
    fn taken(&self) -> Option<Efficiency> {
        Some(Efficiency::Number(*self))
    }
}

macro_rules! conversions {
    ($spec:tt $camera:tt [$($name:ident)*] [$($own:ident: $own_type:ty,)*] $rows:tt) => {
        /// What a camera has that is not taken from a field of the same name.
        struct Own {
            $($own: $own_type,)*
        }

        impl Camera {
            /// What is stated, and what the camera has of its own.
            fn as_stated(figures: &CameraSpec, own: Own) -> Self {
                Self { $($name: figures.$name.taken(),)* $($own: own.$own,)* }
            }
        }

        impl CameraSpec {
            fn as_taken(camera: &Camera) -> Self {
                Self { $($name: camera.$name.taken(),)* ..Self::default() }
            }
        }
    };
}

every_figure!(conversions);

impl Preset {
    /// The camera with these figures, what stands for missing ones listed in [`Camera::assumed`].
    ///
    /// # Errors
    /// All figures that are missing and nothing can stand for.
    pub fn camera(&self) -> Result<Camera, Missing> {
        let mut assumed = Vec::new();
        let Required { exposure_s, pixel_m, f_number, focal_length_m, optics_efficiency } =
            self.required(&mut assumed)?;
        let figures = &self.figures;
        let noise = match &self.noise_table {
            Some(table) => table.clone(),
            None => {
                let at = self.noise_camera();
                let at =
                    [at.f_number.unwrap_or(f_number), at.optics_efficiency, at.pixel_m.unwrap_or(pixel_m)];
                noise_of(figures.noise.stated(), at, &mut assumed)
            }
        };
        let spectral_range_cm1 = figures.spectral_range_cm1.unwrap_or_else(|| {
            let [low, high] = PAPER_RANGE_CM1;
            assumed.push(Assumed::favourable("spectral_range", format!("{low} to {high} cm^-1")));
            PAPER_RANGE_CM1
        });
        let own = [figures.read_noise_counts, figures.dark_rate_per_s].map(Option::unwrap_or_default);
        let is_noisy = is_noisy(&noise, own, &figures.pattern);
        if figures.flicker_fraction.is_none() && is_noisy {
            assumed.push(Assumed::favourable("flicker_fraction", "0"));
        }
        let unstated = figures.pattern.unstated(true);
        if is_noisy && !unstated.is_empty() {
            assumed.push(Assumed::favourable("fixed_pattern", format!("0 ({})", unstated.join(", "))));
        }
        let readout = figures.readout.unwrap_or_else(|| match figures.spectral_bands {
            // Filters before a camera of one band are exposed one after the other.
            Some(1) => Readout::Sequential,
            Some(_) => {
                assumed.push(Assumed::favourable("readout", Readout::Simultaneous.name()));
                Readout::Simultaneous
            }
            // The slowest, if not the worst for every noise.
            None => {
                assumed.push(Assumed::favourable("readout", Readout::Sequential.name()));
                Readout::Sequential
            }
        });
        let frames = figures.frames.unwrap_or(1);
        if figures.frame_rate_hz.is_none() && (frames > 1 || readout.exposures(2) > 1) {
            assumed.push(Assumed::favourable("frame_rate", "no pause between exposures"));
        }
        self.open_figures([exposure_s, pixel_m], is_noisy, &mut assumed);
        let (at, (stated, _)) = (self.noise_camera(), self.noise_in_full());
        let reference_temperature_k = figures.reference_temperature_k.unwrap_or(REFERENCE_K);
        let pattern_at = NetdConditions {
            temperature_k: stated.netd_temperature_k.unwrap_or(reference_temperature_k),
            f_number: stated.netd_f_number.or(at.f_number).unwrap_or(f_number),
            optics_efficiency: stated.netd_optics_efficiency.unwrap_or(at.optics_efficiency),
            pixel_m: stated.netd_pixel_m.or(at.pixel_m).unwrap_or(pixel_m),
        };
        let own = Own {
            name: self.name.clone(),
            description: self.description.clone(),
            provenance: self.document.iter().chain(&self.provenance).cloned().collect(),
            assumed,
            efficiency_curves: self.efficiency_curves.clone(),
            noise,
            pattern: Pattern::new(figures.pattern, pattern_at),
            frame_rate_hz: figures.frame_rate_hz,
        };
        Ok(Camera {
            exposure_s,
            pixel_m,
            f_number,
            focal_length_m,
            optics_efficiency,
            noise_exposure_s: self.noise_exposure_s().unwrap_or(exposure_s),
            readout,
            frames,
            reference_temperature_k,
            spectral_range_cm1,
            ..Camera::as_stated(figures, own)
        })
    }

    /// Whether a document states the noise: of the whole camera then, so that what was measured in front of the optics holds all that it
    /// loses and adds. Of a noise of one's own nobody says so, whichever camera is named beside it.
    fn is_noise_documented(&self) -> bool {
        !self.description.is_empty() && !self.is_noise_own
    }

    /// Figures that change nothing where nobody states them.
    fn open_figures(&self, [exposure_s, pixel_m]: [f64; 2], is_noisy: bool, assumed: &mut Vec<Assumed>) {
        let figures = &self.figures;
        let is_own = !self.is_noise_documented();
        let of_scene =
            matches!(figures.noise.stated(), Some(StatedNoise::Netd { .. } | StatedNoise::Nesr { .. }));
        let of_document = of_scene && !is_own;
        if figures.quantum_efficiency.is_none() && !of_document {
            assumed.push(Assumed::favourable("quantum_efficiency", "1"));
        }
        if figures.full_well.is_none() {
            assumed.push(Assumed::favourable("full_well", "never full"));
        }
        if figures.noise_exposure_s.is_none() && is_noisy && is_own {
            let frame = format!("{:.4} ms, that of a frame", 1e3 * exposure_s);
            assumed.push(Assumed::favourable("noise_exposure", frame));
        }
        if of_scene && is_own {
            if figures.noise.netd_pixel_m.is_none() {
                assumed.push(Assumed::favourable("netd_pixel", format!("{:.4} um, its own", 1e6 * pixel_m)));
            }
            if figures.noise.netd_optics_efficiency.is_none() {
                assumed.push(Assumed::favourable("netd_optics_efficiency", "that of its lens"));
            }
        }
        if self.description.is_empty()
            && figures.spectral_bands.is_none()
            && figures.readout.is_some_and(|one| one != Readout::Sequential)
        {
            assumed.push(Assumed::favourable("spectral_bands", "as many as are asked for"));
        }
        let rest = [
            ("dark_rate", figures.dark_rate_per_s.is_none()),
            ("read_noise", figures.read_noise_counts.is_none()),
            // Bits divide the full well; without one there is no step to speak of.
            ("quantisation_bits", figures.full_well.is_some() && figures.quantisation_bits.is_none()),
        ];
        for (key, silent) in rest {
            if silent && !of_document {
                assumed.push(Assumed::favourable(key, "0"));
            }
        }
    }

    /// The camera that the noise is stated of; what its document is silent on is as here.
    #[must_use]
    pub fn noise_camera(&self) -> NoiseCamera {
        let own = NoiseCamera::of(&self.figures);
        let Some(at) = self.noise_at else { return own };
        let is_timed = at.exposure_s.is_some() || at.frame_rate_hz.is_some();
        NoiseCamera {
            exposure_s: at.exposure_s.or(own.exposure_s.filter(|_| !is_timed)),
            frame_rate_hz: at.frame_rate_hz.or(own.frame_rate_hz.filter(|_| !is_timed)),
            f_number: at.f_number.or(own.f_number),
            pixel_m: at.pixel_m.or(own.pixel_m),
            ..at
        }
    }

    /// The exposure of which the noise is, s: as it is stated, or that of the camera that it is stated of, a frame where that is silent.
    fn noise_exposure_s(&self) -> Option<f64> {
        let at = self.noise_camera();
        self.figures.noise_exposure_s.or(at.exposure_s).or(at.frame_rate_hz.map(f64::recip))
    }

    /// The noise with all of its conditions, those that are not stated as they are taken.
    #[must_use]
    pub fn noise_in_full(&self) -> (NoiseFigures, Option<f64>) {
        let at = self.noise_camera();
        let mut noise = self.figures.noise.clone();
        if noise.netd_k.is_some() {
            noise.netd_temperature_k.get_or_insert(REFERENCE_K);
        }
        if noise.netd_k.is_some() || noise.nesr_microflick.is_some() {
            noise.netd_f_number = noise.netd_f_number.or(at.f_number);
            noise.netd_optics_efficiency = noise.netd_optics_efficiency.or(Some(at.optics_efficiency));
            noise.netd_pixel_m = noise.netd_pixel_m.or(at.pixel_m);
        }
        (noise, self.noise_exposure_s())
    }

    /// The figures without which there is no camera: the frame is taken for an exposure that is not stated, 1 for an efficiency of the optics.
    fn required(&self, assumed: &mut Vec<Assumed>) -> Result<Required, Missing> {
        let CameraSpec { exposure_s, frame_rate_hz, pixel_m, f_number, focal_length_m, .. } = self.figures;
        let stated = self.figures.noise.stated();
        let mut missing = Missing::default();
        // What is missing is asked for with all else that is, before anything is made of it.
        let mut ask = |key| {
            missing.0.push(key);
            f64::NAN
        };
        let exposure_s = match (exposure_s, frame_rate_hz) {
            (Some(exposure), _) => exposure,
            (None, Some(rate)) => {
                let frame = format!("{:.4} ms, the frame", 1e3 / rate);
                assumed.push(match stated {
                    // Signal and noise stretch alike, unless the noise is of another exposure.
                    Some(StatedNoise::Netd { .. } | StatedNoise::Nesr { .. })
                        if self.figures.noise_exposure_s.is_none() =>
                    {
                        Assumed::worst("exposure", frame)
                    }
                    _ => Assumed::favourable("exposure", frame),
                });
                1.0 / rate
            }
            (None, None) => ask("exposure"),
        };
        let pixel_m = pixel_m.unwrap_or_else(|| ask("pixel"));
        let f_number = f_number.unwrap_or_else(|| ask("f_number"));
        let focal_length_m = focal_length_m.unwrap_or_else(|| ask("focal_length"));
        if self.noise_table.is_none() && stated.is_none() {
            ask("netd");
        }
        if !missing.0.is_empty() {
            return Err(missing);
        }
        let optics_efficiency = &self.figures.optics_efficiency;
        if optics_efficiency.is_none() {
            assumed.push(match stated {
                Some(StatedNoise::Netd { .. } | StatedNoise::Nesr { .. })
                    if self.figures.noise.netd_optics_efficiency.is_none() && self.is_noise_documented() =>
                {
                    Assumed::worst("optics_efficiency", "1 (the noise is stated through the same optics)")
                }
                _ => Assumed::favourable("optics_efficiency", "1"),
            });
        }
        let optics_efficiency = optics_efficiency.taken();
        Ok(Required { exposure_s, pixel_m, f_number, focal_length_m, optics_efficiency })
    }
}

impl NoiseCamera {
    /// Those of what is stated.
    #[must_use]
    pub fn of(figures: &CameraSpec) -> Self {
        let CameraSpec { exposure_s, frame_rate_hz, f_number, pixel_m, .. } = *figures;
        let optics_efficiency = figures.optics_efficiency.taken();
        Self { exposure_s, frame_rate_hz, f_number, pixel_m, optics_efficiency }
    }
}

/// What every camera has.
struct Required {
    exposure_s: f64,
    pixel_m: f64,
    f_number: f64,
    focal_length_m: f64,
    optics_efficiency: f64,
}

/// Whether a camera has any noise but that of photons: of an ideal one no figure of it is missed.
fn is_noisy(noise: &NoiseSpec, [read_counts, dark_per_s]: [f64; 2], pattern: &PatternFigures) -> bool {
    noise.is_some() || read_counts > 0.0 || dark_per_s > 0.0 || !pattern.is_silent()
}

/// The noise that is stated; conditions that an NETD does not state are these.
fn noise_of(
    stated: Option<StatedNoise>,
    [f_number, optics_efficiency, pixel_m]: [f64; 3],
    assumed: &mut Vec<Assumed>,
) -> NoiseSpec {
    match stated {
        None | Some(StatedNoise::None) => NoiseSpec::None,
        Some(StatedNoise::Netd {
            netd_k,
            temperature_k,
            f_number: at,
            optics_efficiency: eta,
            pixel_m: of,
        }) => {
            if temperature_k.is_none() {
                assumed.push(Assumed::favourable("netd_temperature", format!("{REFERENCE_K} K")));
            }
            if at.is_none() {
                assumed.push(Assumed::favourable("netd_f_number", format!("f/{f_number}")));
            }
            NoiseSpec::Netd {
                netd_k,
                temperature_k: temperature_k.unwrap_or(REFERENCE_K),
                f_number: at.unwrap_or(f_number),
                optics_efficiency: eta.unwrap_or(optics_efficiency),
                pixel_m: of.unwrap_or(pixel_m),
            }
        }
        Some(StatedNoise::Detectivity { detectivity_cm_hz05_w, bandwidth_hz }) => {
            NoiseSpec::Detectivity { detectivity_cm_hz05_w, bandwidth_hz }
        }
        Some(StatedNoise::Nep { nep_w_hz05, bandwidth_hz }) => NoiseSpec::Nep { nep_w_hz05, bandwidth_hz },
        Some(StatedNoise::Nesr { microflick, f_number: at, optics_efficiency: eta, pixel_m: of, .. }) => {
            NoiseSpec::SpectralRadiance {
                microflick,
                f_number: at.unwrap_or(f_number),
                optics_efficiency: eta.unwrap_or(optics_efficiency),
                pixel_m: of.unwrap_or(pixel_m),
            }
        }
        Some(StatedNoise::Counts { sigma_counts }) => NoiseSpec::Counts { sigma_counts },
    }
}

impl CameraSpec {
    /// Every figure of a camera, as it would be stated; curves and tables over wavenumber are no figures.
    #[must_use]
    pub fn of(camera: &Camera) -> Self {
        Self {
            frame_rate_hz: camera.frame_rate_hz,
            noise: NoiseFigures::of(&camera.noise),
            pattern: camera.pattern.stated_at(camera, camera.pattern_conditions()),
            ..Self::as_taken(camera)
        }
    }
}

impl Camera {
    /// What a noise in K would be stated for beside this camera's: the conditions of its NETD, or its own.
    fn pattern_conditions(&self) -> NetdConditions {
        match self.noise {
            NoiseSpec::Netd { temperature_k, f_number, optics_efficiency, pixel_m, .. } => {
                NetdConditions { temperature_k, f_number, optics_efficiency, pixel_m }
            }
            _ => NetdConditions::of(self, self.reference_temperature_k),
        }
    }
}

impl NoiseFigures {
    /// No noise is one of 0 counts.
    fn of(noise: &NoiseSpec) -> Self {
        Self::from(match *noise {
            NoiseSpec::None => StatedNoise::Counts { sigma_counts: 0.0 },
            NoiseSpec::Netd { netd_k, temperature_k, f_number, optics_efficiency, pixel_m } => {
                StatedNoise::Netd {
                    netd_k,
                    temperature_k: Some(temperature_k),
                    f_number: Some(f_number),
                    optics_efficiency: Some(optics_efficiency),
                    pixel_m: Some(pixel_m),
                }
            }
            NoiseSpec::Detectivity { detectivity_cm_hz05_w, bandwidth_hz } => {
                StatedNoise::Detectivity { detectivity_cm_hz05_w, bandwidth_hz }
            }
            NoiseSpec::Nep { nep_w_hz05, bandwidth_hz } => StatedNoise::Nep { nep_w_hz05, bandwidth_hz },
            NoiseSpec::SpectralRadiance { microflick, f_number, optics_efficiency, pixel_m } => {
                StatedNoise::Nesr {
                    microflick,
                    wavelength_um: None,
                    f_number: Some(f_number),
                    optics_efficiency: Some(optics_efficiency),
                    pixel_m: Some(pixel_m),
                }
            }
            NoiseSpec::Counts { sigma_counts } => StatedNoise::Counts { sigma_counts },
            NoiseSpec::Table { .. } => return Self::default(),
        })
    }
}

impl Camera {
    /// Whether it has no noise but that of photons.
    #[must_use]
    pub fn is_ideal(&self) -> bool {
        !is_noisy(&self.noise, [self.read_noise_counts, self.dark_rate_per_s], &self.pattern.stated)
    }

    /// Keys of the figures in which it is not another camera, but for the rounding of a conversion of units. Whatever of the
    /// electronic noise differs goes by the key that states that noise.
    #[must_use]
    pub fn changed_from(&self, other: &Self) -> Vec<&'static str> {
        let (own, others) = (CameraSpec::of(self), CameraSpec::of(other));
        let curves = |camera: &Self, key: &str| -> Vec<_> {
            camera.efficiency_curves.iter().filter(|curve| curve.name() == key).cloned().collect()
        };
        let mut keys = Vec::new();
        for row in TABLE {
            if row.is_same(&own, &others) && curves(self, row.key) == curves(other, row.key) {
                continue;
            }
            let key = match row.part {
                // Noise of the same figures at another exposure is another noise, where there is any.
                _ if row.key == "noise_exposure" => {
                    if self.noise == NoiseSpec::None || keys.contains(&self.noise.key()) {
                        continue;
                    }
                    row.key
                }
                Part::Own => row.key,
                Part::Noise | Part::Condition(_) => self.noise.key(),
            };
            if !keys.contains(&key) {
                keys.push(key);
            }
        }
        keys
    }
}
