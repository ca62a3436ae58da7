//! Every figure of a camera once: its two fields, and its rows among the keys of `[camera]`.
//!
//! [`every_figure`] hands the list to the macro that it is given: the structs [`crate::instrument::CameraSpec`] and
//! [`crate::instrument::Camera`], the table of the keys and what makes one of the other are expansions of it. A block is
//!
//! ```text
//! /// What it is, as stated.
//! its_name: Option<f64>,
//! /// What it is, in the camera.
//! => f64,
//! row("its_key", …);
//! ```
//!
//! A camera takes the figure as it is stated, the default of its type (0, false) where it is not; what else stands for a figure is
//! said in `made.rs`. Fields of one struct alone stand in `@CameraSpec` and `@Camera`. The order is that of the fields in JSON and of the keys.

/// Hands `[fields of CameraSpec] [fields of Camera] [names of both] [names and types of Camera alone] [rows]` to a macro.
macro_rules! every_figure {
    (@blocks $then:ident $(
        $(@CameraSpec { $($(#[$spec_doc:meta])* $spec:ident: $spec_type:ty,)+ })?
        $(@Camera { $($(#[$own_doc:meta])* $own:ident: $own_type:ty,)+ })?
        $(#[$stated_doc:meta])*
        $name:ident: $stated:ty,
        $(#[$kept_doc:meta])*
        => $kept:ty
        $(, $row:expr)*;
    )*) => {
        $then! {
            [$($($($(#[$spec_doc])* pub $spec: $spec_type,)+)? $(#[$stated_doc])* pub $name: $stated,)*]
            [$($($($(#[$own_doc])* pub $own: $own_type,)+)? $(#[$kept_doc])* pub $name: $kept,)*]
            [$($name)*]
            [$($($($own: $own_type,)+)?)*]
            [$($($row,)*)*]
        }
    };
    ($then:ident) => { $crate::instrument::figures::every_figure! { @blocks $then
        @CameraSpec {
            /// Name of a known camera, whose figures hold where the others are silent.
            #[serde(skip)]
            preset: Option<String>,
            /// What is stated of that camera, where it is one of the user's own.
            #[serde(skip)]
            own: Option<Arc<CameraSpec>>,
            /// The same camera as its file states it, where figures that its noise is stated for are moved over the file.
            #[serde(skip)]
            filed: Option<Arc<CameraSpec>>,
        }
        @Camera {
            /// Name of the camera, as in `camera.preset`.
            name: String,
            /// What it is, in one line.
            description: String,
            /// Where the figures are from, and what is known to be wrong with them.
            provenance: Vec<String>,
            /// Figures that no document states, and the values taken for them.
            assumed: Vec<Assumed>,
        }
        /// Exposure of one frame, s.
        exposure_s: Option<f64>,
        /// Exposure of one frame, s.
        => f64,
        row("preset", "known camera", Kind::Name(slot!(preset)), "\"flir-a325sc\"",
            "A known camera, whose figures hold where the other keys are silent (`hadar cameras list`).",
            "its figures where the other keys are silent").elsewhere(),
        row("exposure", "exposure", Kind::Quantity(Dimension::Time, ABOVE_ZERO, slot!(exposure_s)), "\"12 ms\"",
            "Exposure of a frame; the whole frame where only a frame rate is known.",
            "counts = etendue x exposure x efficiencies x S (S7)").always_shown();

        @CameraSpec {
            /// Number of frames in a second, Hz.
            frame_rate_hz: Option<f64>,
        }
        /// Side of a square pixel, m.
        pixel_m: Option<f64>,
        /// Side of a square pixel, m.
        => f64,
        row("pixel", "pixel", Kind::Quantity(Dimension::Length, ABOVE_ZERO, slot!(pixel_m)), "\"12 um\"",
            "Side of a square pixel.",
            "etendue A_p/((1 + gamma)F^2) of a pixel (S7, SII E)").always_shown();

        /// f-number of the lens: focal length over the diameter of the aperture.
        f_number: Option<f64>,
        /// f-number F of the lens: focal length over the diameter of the aperture.
        => f64,
        row("f_number", "f-number", Kind::Number(F_NUMBER, slot!(f_number)), "1.3",
            "f-number of the lens.",
            "etendue A_p/((1 + gamma)F^2) of a pixel (S7, SII E)").always_shown();

        /// Focal length of the lens, m.
        focal_length_m: Option<f64>,
        /// Focal length of the lens, m.
        => f64,
        row("focal_length", "focal length", Kind::Quantity(Dimension::Length, ABOVE_ZERO, slot!(focal_length_m)),
            "\"18 mm\"",
            "Focal length of the lens.",
            "footprint p z/f, disparity f b/z (S35)").always_shown();

        /// Share of the photons that the optics pass.
        optics_efficiency: Option<Efficiency>,
        /// Share of the photons that the optics pass, in (0, 1].
        => f64,
        row("optics_efficiency", "optics efficiency", Kind::Efficiency(EFFICIENCY, slot!(optics_efficiency)), "0.9",
            "Share of the photons that the optics let through; 1 where it is not stated.",
            "counts = etendue x exposure x efficiencies x S (S7)").always_shown();

        /// Share of the photons on the detector that are counted.
        quantum_efficiency: Option<Efficiency>,
        /// Share of the photons on the detector that are counted, in (0, 1].
        => f64,
        row("quantum_efficiency", "quantum efficiency", Kind::Efficiency(EFFICIENCY, slot!(quantum_efficiency)), "0.9",
            "Share of the photons on the detector that are counted; 1 where it is not stated.",
            "counts = etendue x exposure x efficiencies x S (S7)").always_shown();

        @CameraSpec {
            /// Electronic noise of one band reading, and the conditions under which it is stated.
            noise: NoiseFigures,
        }
        @Camera {
            /// Efficiencies that depend on wavenumber, of the optics and of the detector, to be multiplied with the two above.
            #[serde(skip_serializing_if = "Vec::is_empty")]
            efficiency_curves: Vec<EfficiencyCurve>,
            /// Electronic noise of one band reading.
            noise: NoiseSpec,
        }
        /// Exposure for which the noise is stated, s.
        noise_exposure_s: Option<f64>,
        /// Exposure at which that noise is stated, s.
        => f64,
        row("netd", "NETD", Kind::Quantity(Dimension::TemperatureDifference, ABOVE_ZERO, slot!(noise.netd_k)), "\"50 mK\"",
            "Noise-equivalent temperature difference of one frame as it is measured: it contains the shot noise of its photons. Like every \
             noise it keeps the conditions for which it is stated when another figure is moved.",
            "electronic noise of a reading (S10, Table S2)").noise(),
        row("netd_temperature", "temperature of the NETD",
            Kind::Quantity(Dimension::Temperature, BLACKBODY, slot!(noise.netd_temperature_k)), "\"30 degC\"",
            "Temperature of the blackbody at which the NETD is stated, beside netd_f_number; 30 degC where no condition is stated.",
            "electronic noise of a reading from NETD (Table S2)").condition_of(&["netd"]),
        row("netd_f_number", "f-number of the NETD", Kind::Number(F_NUMBER, slot!(noise.netd_f_number)), "1.0",
            "f-number at which the NETD (beside netd_temperature) or the NESR is stated; that of the lens where no condition is stated.",
            "electronic noise of a reading from NETD or NESR (Table S2)").condition_of(&["netd", "nesr"]),
        row("netd_optics_efficiency", "optics efficiency of the NETD",
            Kind::Number(EFFICIENCY, slot!(noise.netd_optics_efficiency)), "0.9",
            "Share of the photons that the optics let through where the NETD or the NESR is stated; that of the camera where it is not stated.",
            "electronic noise of a reading from NETD or NESR (Table S2)").condition_of(&["netd", "nesr"]),
        row("netd_pixel", "pixel of the NETD", Kind::Quantity(Dimension::Length, ABOVE_ZERO, slot!(noise.netd_pixel_m)),
            "\"12 um\"",
            "Side of the pixel for which the NETD or the NESR is stated; the camera's own where it is not stated.",
            "electronic noise of a reading from NETD or NESR (Table S2)").condition_of(&["netd", "nesr"]),
        row("detectivity", "D*",
            Kind::Quantity(Dimension::Detectivity, ABOVE_ZERO, slot!(noise.detectivity_cm_hz05_w)), "\"4.7e10 cm Hz^0.5/W\"",
            "Specific detectivity D*, with a noise_bandwidth or the noise_exposure that it follows from.",
            "electronic noise of a reading (S10, Table S2)").noise(),
        row("nep", "NEP",
            Kind::Quantity(Dimension::NoiseEquivalentPower, ABOVE_ZERO, slot!(noise.nep_w_hz05)), "\"1e-12 W/Hz^0.5\"",
            "Noise-equivalent power of 1 Hz, with a noise_bandwidth or the noise_exposure that it follows from.",
            "electronic noise of a reading (S10, Table S2)").noise(),
        row("nesr", "NESR",
            Kind::Quantity(Dimension::SpectralRadiance, ABOVE_ZERO, slot!(noise.nesr_microflick)), "\"1 uflick\"",
            "Noise-equivalent spectral radiance in front of the optics.",
            "electronic noise of a reading (S10, Table S2)").noise(),
        row("noise_electrons", "noise of a reading", Kind::Number(FROM_ZERO, slot!(noise.electrons)), "1000",
            "Standard deviation of a band reading's electronic noise, in counts.",
            "electronic noise of a reading (S14 to S16)").noise(),
        row("noise_table", "noise over wavenumber", Kind::File(slot!(noise.table)), "\"noise.csv\"",
            "Standard deviation of a band reading over wavenumber: CSV with the columns wavenumber_cm1,sigma_counts.",
            "electronic noise of a reading (S14 to S16)").noise(),
        row("noise_bandwidth", "bandwidth of the noise",
            Kind::Quantity(Dimension::Frequency, ABOVE_ZERO, slot!(noise.bandwidth_hz)), "\"175 kHz\"",
            "Bandwidth for which D* or NEP is taken; 1/(2 x noise_exposure) where it is not stated.",
            "noise power NEP sqrt(bandwidth) (Table S2)").condition_of(&["detectivity", "nep"]),
        row("noise_exposure", "exposure of the noise",
            Kind::Quantity(Dimension::Time, ABOVE_ZERO, slot!(noise_exposure_s)), "\"12 ms\"",
            "Exposure for which the noise is stated; that of the frame where it is not stated.",
            "scaling of the noise from its exposure to the camera's").condition_of(&NOISES);

        @CameraSpec {
            /// Noise that pixels, rows, columns and frames share.
            pattern: PatternFigures,
        }
        @Camera {
            /// Noise that pixels, rows, columns and frames share.
            #[serde(skip_serializing_if = "Pattern::is_none")]
            pattern: Pattern,
        }
        /// Share of the noise variance at that exposure which is flicker.
        flicker_fraction: Option<f64>,
        /// Share of the noise variance at that exposure which is flicker, in [0, 1].
        => f64,
        row("flicker_fraction", "flicker share of noise variance", Kind::Number(SHARE, slot!(flicker_fraction)), "0.5",
            "Share of the electronic noise variance at noise_exposure that is flicker, which frames do not average out; 0 where \
             it is not stated.",
            "share of the variance that frames do not average").always_shown(),
        row("fixed_pattern", "fixed pattern", Kind::Quantity(Dimension::TemperatureDifference, FROM_ZERO, slot!(pattern.pixel_k)),
            "\"20 mK\"",
            "Deviation from pixel to pixel that a correction of non-uniformity leaves and no number of frames averages away (sigma_VH), at \
             the conditions of the NETD; 0 where it is not stated, which is a condition of a verdict.",
            "noise of pixels, rows, columns and frames"),
        row("row_noise", "row noise", Kind::Quantity(Dimension::TemperatureDifference, FROM_ZERO, slot!(pattern.row_k)),
            "\"14 mK\"",
            "Deviation from row to row that stays (sigma_V), as fixed_pattern: the pixels of a row of an object share it.",
            "noise of pixels, rows, columns and frames"),
        row("column_noise", "column noise", Kind::Quantity(Dimension::TemperatureDifference, FROM_ZERO, slot!(pattern.column_k)),
            "\"14 mK\"",
            "Deviation from column to column that stays (sigma_H), as row_noise.",
            "noise of pixels, rows, columns and frames"),
        row("offset_drift", "drift of the offset", Kind::Quantity(Dimension::TemperatureDifference, FROM_ZERO, slot!(pattern.offset_k)),
            "\"50 mK\"",
            "Deviation that all readings of a band share since it was calibrated, as fixed_pattern: neither pixels nor frames average it away. \
             For a gain that drifts make gain unknown, with its deviation as a prior.",
            "noise of pixels, rows, columns and frames"),
        row("temporal_row_noise", "temporal row noise",
            Kind::Quantity(Dimension::TemperatureDifference, FROM_ZERO, slot!(pattern.temporal_row_k)), "\"5 mK\"",
            "Deviation from row to row that is another one in every frame (sigma_TV), beside the NETD; 0 where it is not stated, which is a \
             condition of a verdict on an object.",
            "noise of pixels, rows, columns and frames"),
        row("temporal_column_noise", "temporal column noise",
            Kind::Quantity(Dimension::TemperatureDifference, FROM_ZERO, slot!(pattern.temporal_column_k)), "\"5 mK\"",
            "Deviation from column to column that is another one in every frame (sigma_TH), as temporal_row_noise.",
            "noise of pixels, rows, columns and frames"),
        row("frame_noise", "frame noise", Kind::Quantity(Dimension::TemperatureDifference, FROM_ZERO, slot!(pattern.frame_k)),
            "\"5 mK\"",
            "Deviation of a whole frame (sigma_T), as temporal_row_noise: all pixels of an object share it.",
            "noise of pixels, rows, columns and frames"),
        row("pattern_drift", "drift of the pattern", Kind::Quantity(Dimension::Time, ABOVE_ZERO, slot!(pattern.drift_s)),
            "\"60 s\"",
            "Time after which what stays of pixels, rows and columns is another pattern (correlation time; a shutter makes one anew); never \
             where it is not stated.",
            "share of a pattern that the mean over frames keeps");

        /// Counts per second without any light.
        dark_rate_per_s: Option<f64>,
        /// Counts per second without any light.
        => f64,
        row("dark_rate", "dark counts", Kind::Quantity(Dimension::Rate, FROM_ZERO, slot!(dark_rate_per_s)), "\"1000 1/s\"",
            "Counts per second without light; 0 where it is not stated.",
            "dark counts in the noise budget (S14 to S16)");

        /// Deviation that every reading adds, counts.
        read_noise_counts: Option<f64>,
        /// Deviation that every reading adds whatever its exposure, counts.
        => f64,
        row("read_noise", "read noise", Kind::Number(FROM_ZERO, slot!(read_noise_counts)), "100",
            "Standard deviation that every reading adds whatever its exposure, in counts; 0 where it is not stated.",
            "read noise in the noise budget (S14 to S16)");

        /// Number of bits of the analogue-to-digital converter.
        quantisation_bits: Option<u32>,
        /// Bits of the converter that divides the full well into steps, if known.
        => Option<u32>,
        row("quantisation_bits", "bits of the converter", Kind::Count(slot!(quantisation_bits)), "14",
            "Bits of the converter, which divide the full_well into steps.",
            "quantisation in the noise budget: step^2/12").always_shown();

        /// Counts at which a pixel is full.
        full_well: Option<f64>,
        /// Counts at which a pixel is full, if known.
        => Option<f64>,
        row("full_well", "full well", Kind::Number(ABOVE_ZERO, slot!(full_well)), "1e7",
            "Counts at which a pixel is full; never where it is not stated.",
            "longest exposure; step of the quantisation").always_shown();

        /// Whether the bunching of thermal photons adds its noise. A document that does not mention it means that it does not.
        #[serde(default = "not_asked_for")]
        photon_bunching: Option<bool>,
        /// Whether the bunching of thermal photons adds its noise.
        => bool,
        row("photon_bunching", "photon bunching", Kind::Flag(slot!(photon_bunching)), "true",
            "Whether the bunching of thermal photons adds its noise; false where it is not stated.",
            "variance n + n^2/modes (S11 to S13)").elsewhere();

        /// When the bands are exposed.
        readout: Option<Readout>,
        /// When the bands are exposed.
        => Readout,
        row("readout", "readout", Kind::Readout(slot!(readout)), "\"sequential\"",
            "Whether all bands are read in one exposure or one after the other; one after the other where nobody states it.",
            "exposures until all bands are known; light of filters (S8, S9)").elsewhere();

        /// Number of bands that the detector itself separates; with one of them a spectrum takes filters.
        spectral_bands: Option<u32>,
        /// Number of bands that the detector itself separates, if known; with one of them a spectrum takes filters.
        => Option<u32>,
        row("spectral_bands", "bands of its own", Kind::Count(slot!(spectral_bands)), "1",
            "Bands that the camera has of its own: with 1 a spectrum takes filters, one after the other; as many as the scenario \
             asks for where it is not stated.",
            "whether filters must make the other bands").elsewhere();

        /// Number of frames that are averaged.
        frames: Option<u32>,
        /// Number of frames that are averaged.
        => u32,
        row("frames", "averaged frames", Kind::Count(slot!(frames)), "16",
            "Number of frames that are averaged; 1 where it is not stated.",
            "counts and variance of all frames together").elsewhere(),
        row("frame_rate", "frame rate", Kind::Quantity(Dimension::Frequency, ABOVE_ZERO, slot!(frame_rate_hz)), "\"60 Hz\"",
            "Frames per second: an exposure is no longer than a frame.",
            "time until all frames and bands are known").always_shown();

        @Camera {
            /// Frames per second, if known: an exposure is no longer than a frame.
            frame_rate_hz: Option<f64>,
        }
        /// Temperature of the sensor, K.
        sensor_temperature_k: Option<f64>,
        /// Temperature of the sensor, whose emission filters throw back onto it (K of S8), K, if known.
        => Option<f64>,
        row("sensor_temperature", "temperature of the sensor",
            Kind::Quantity(Dimension::Temperature, ABSOLUTE_TEMPERATURE, slot!(sensor_temperature_k)), "\"30 degC\"",
            "Temperature of the sensor, whose light filters throw back onto it; no such light where it is not stated.",
            "light of the sensor (S8, S9)");

        /// Temperature of the filters, K.
        filter_temperature_k: Option<f64>,
        /// Temperature of the filters (F of S8), K, if known; else that of the sensor.
        => Option<f64>,
        row("filter_temperature", "temperature of the filters",
            Kind::Quantity(Dimension::Temperature, ABSOLUTE_TEMPERATURE, slot!(filter_temperature_k)), "\"30 degC\"",
            "Temperature of the filters; that of the sensor where it is not stated.",
            "light of the filters (S8, S9)");

        /// Full field of view across, rad.
        field_of_view_rad: Option<f64>,
        /// Full field of view across, rad, if known.
        => Option<f64>,
        row("field_of_view", "field of view", Kind::Quantity(Dimension::Angle, FIELD_OF_VIEW, slot!(field_of_view_rad)),
            "\"25 deg\"",
            "Full field of view across.",
            "footprint of a pixel; ranges of sizing practice").always_shown();

        /// Pixels across the field of view.
        pixels: Option<u32>,
        /// Pixels across the field of view, if known.
        => Option<u32>,
        row("pixels", "pixels across", Kind::Count(slot!(pixels)), "320",
            "Pixels across the field of view.",
            "footprint of a pixel; ranges of sizing practice").elsewhere();

        @CameraSpec {
            /// Pixels down the field of view. Documents only, as is all that has no row in [`super::TABLE`].
            lines: Option<u32>,
        }
        /// Temperature of the blackbody at which photons and γ are quoted, K. Documents only.
        reference_temperature_k: Option<f64>,
        /// Temperature of the blackbody at which photons and γ are quoted, K.
        => f64;

        /// The spectral range of the detector, cm⁻¹, lower end first.
        spectral_range_cm1: Option<[f64; 2]>,
        /// The spectral range of the detector, cm⁻¹, in which NETD and photons are quoted.
        => [f64; 2],
        row("spectral_range", "spectral range", Kind::Span(slot!(spectral_range_cm1)), "[\"8 um\", \"14 um\"]",
            "Range in which the detector sees, over which NETD and photons are quoted; where it is not stated a 'yes' hangs on it.",
            "integral of NETD x dN/dT (Table S2)").elsewhere();
    } };
}

pub(in crate::instrument) use every_figure;
