//! The keys of `[camera]`, in the order in which they are read, written and listed.

use super::row::{Kind, Line, Part, Row, Slot};
use crate::allowed::{ABOVE_ZERO, ABSOLUTE_TEMPERATURE, Allowed, FROM_ZERO, SHARE};
use crate::units::Dimension;

/// The fastest f-number of a lens in air (Abbe's sine condition).
pub const FASTEST_F_NUMBER: f64 = 0.5;

const F_NUMBER: Allowed = Allowed {
    holds: |value| value >= FASTEST_F_NUMBER,
    expected: "at least 0.5, the fastest that a lens in air can be",
};
/// Of the blackbody of a NETD. Colder or hotter ones than are built change counts by so little, or so much, per K that no digit is
/// left of a noise, which a verdict would then not see.
const BLACKBODY: Allowed =
    Allowed { holds: |value| (50.0..=5000.0).contains(&value), expected: "from 50 K to 5000 K" };
const EFFICIENCY: Allowed =
    Allowed { holds: |value| value > 0.0 && value <= 1.0, expected: "above 0, at most 1" };
const FIELD_OF_VIEW: Allowed = Allowed {
    holds: |value| value > 0.0 && value < std::f64::consts::PI,
    expected: "above 0 and below 180 deg",
};

/// The keys that state the noise, of which there is at most one.
pub const NOISES: [&str; 6] = ["netd", "detectivity", "nep", "nesr", "noise_electrons", "noise_table"];

macro_rules! slot {
    ($($field:ident).+) => { Slot { of: |spec| &spec.$($field).+, at: |spec| &mut spec.$($field).+ } };
}

const fn row(
    key: &'static str,
    label: &'static str,
    kind: Kind,
    example: &'static str,
    meaning: &'static str,
    enters: &'static str,
) -> Row {
    Row { key, label, kind, example, part: Part::Own, line: Line::IfStated, meaning, enters }
}

impl Row {
    const fn always_shown(self) -> Self {
        Self { line: Line::Always, ..self }
    }

    const fn elsewhere(self) -> Self {
        Self { line: Line::Elsewhere, ..self }
    }

    const fn noise(self) -> Self {
        Self { part: Part::Noise, line: Line::Elsewhere, ..self }
    }

    const fn condition_of(self, noises: &'static [&'static str]) -> Self {
        Self { part: Part::Condition(noises), line: Line::Elsewhere, ..self }
    }
}

/// The keys of `[camera]`.
pub const TABLE: &[Row] = &[
    row(
        "preset",
        "known camera",
        Kind::Name(slot!(preset)),
        "\"flir-a325sc\"",
        "A known camera, whose figures hold where the other keys are silent (`hadar cameras list`).",
        "its figures where the other keys are silent",
    )
    .elsewhere(),
    row(
        "exposure",
        "exposure",
        Kind::Quantity(Dimension::Time, ABOVE_ZERO, slot!(exposure_s)),
        "\"12 ms\"",
        "Exposure of a frame; the whole frame where only a frame rate is known.",
        "counts = etendue x exposure x efficiencies x S (S7)",
    )
    .always_shown(),
    row(
        "pixel",
        "pixel",
        Kind::Quantity(Dimension::Length, ABOVE_ZERO, slot!(pixel_m)),
        "\"12 um\"",
        "Side of a square pixel.",
        "etendue A_p/((1 + gamma)F^2) of a pixel (S7, SII E)",
    )
    .always_shown(),
    row(
        "f_number",
        "f-number",
        Kind::Number(F_NUMBER, slot!(f_number)),
        "1.3",
        "f-number of the lens.",
        "etendue A_p/((1 + gamma)F^2) of a pixel (S7, SII E)",
    )
    .always_shown(),
    row(
        "focal_length",
        "focal length",
        Kind::Quantity(Dimension::Length, ABOVE_ZERO, slot!(focal_length_m)),
        "\"18 mm\"",
        "Focal length of the lens.",
        "footprint p z/f, disparity f b/z (S35)",
    )
    .always_shown(),
    row(
        "optics_efficiency",
        "optics efficiency",
        Kind::Efficiency(EFFICIENCY, slot!(optics_efficiency)),
        "0.9",
        "Share of the photons that the optics let through; 1 where it is not stated.",
        "counts = etendue x exposure x efficiencies x S (S7)",
    )
    .always_shown(),
    row(
        "quantum_efficiency",
        "quantum efficiency",
        Kind::Efficiency(EFFICIENCY, slot!(quantum_efficiency)),
        "0.9",
        "Share of the photons on the detector that are counted; 1 where it is not stated.",
        "counts = etendue x exposure x efficiencies x S (S7)",
    )
    .always_shown(),
    row(
        "netd",
        "NETD",
        Kind::Quantity(Dimension::TemperatureDifference, ABOVE_ZERO, slot!(noise.netd_k)),
        "\"50 mK\"",
        "Noise-equivalent temperature difference of one frame.",
        "electronic noise of a reading (S10, Table S2)",
    )
    .noise(),
    row(
        "netd_temperature",
        "temperature of the NETD",
        Kind::Quantity(Dimension::Temperature, BLACKBODY, slot!(noise.netd_temperature_k)),
        "\"30 degC\"",
        "Temperature of the blackbody at which the NETD is stated; 30 degC where it is not stated.",
        "electronic noise of a reading from NETD (Table S2)",
    )
    .condition_of(&["netd"]),
    row(
        "netd_f_number",
        "f-number of the NETD",
        Kind::Number(F_NUMBER, slot!(noise.netd_f_number)),
        "1.0",
        "f-number at which the NETD is stated; that of the lens where it is not stated.",
        "electronic noise of a reading from NETD (Table S2)",
    )
    .condition_of(&["netd"]),
    row(
        "netd_pixel",
        "pixel of the NETD",
        Kind::Quantity(Dimension::Length, ABOVE_ZERO, slot!(noise.netd_pixel_m)),
        "\"12 um\"",
        "Side of the pixel for which the NETD is stated; the camera's own where it is not stated.",
        "electronic noise of a reading from NETD (Table S2)",
    )
    .condition_of(&["netd"]),
    row(
        "detectivity",
        "D*",
        Kind::Quantity(Dimension::Detectivity, ABOVE_ZERO, slot!(noise.detectivity_cm_hz05_w)),
        "\"4.7e10 cm Hz^0.5/W\"",
        "Specific detectivity D*, with a noise_bandwidth or the noise_exposure that it follows from.",
        "electronic noise of a reading (S10, Table S2)",
    )
    .noise(),
    row(
        "nep",
        "NEP",
        Kind::Quantity(Dimension::NoiseEquivalentPower, ABOVE_ZERO, slot!(noise.nep_w_hz05)),
        "\"1e-12 W/Hz^0.5\"",
        "Noise-equivalent power of 1 Hz, with a noise_bandwidth or the noise_exposure that it follows from.",
        "electronic noise of a reading (S10, Table S2)",
    )
    .noise(),
    row(
        "nesr",
        "NESR",
        Kind::Quantity(Dimension::SpectralRadiance, ABOVE_ZERO, slot!(noise.nesr_microflick)),
        "\"1 uflick\"",
        "Noise-equivalent spectral radiance in front of the optics.",
        "electronic noise of a reading (S10, Table S2)",
    )
    .noise(),
    row(
        "noise_electrons",
        "noise of a reading",
        Kind::Number(FROM_ZERO, slot!(noise.electrons)),
        "1000",
        "Standard deviation of a band reading's electronic noise, in counts.",
        "electronic noise of a reading (S14 to S16)",
    )
    .noise(),
    row(
        "noise_table",
        "noise over wavenumber",
        Kind::File(slot!(noise.table)),
        "\"noise.csv\"",
        "Standard deviation of a band reading over wavenumber: CSV with the columns wavenumber_cm1,sigma_counts.",
        "electronic noise of a reading (S14 to S16)",
    )
    .noise(),
    row(
        "noise_bandwidth",
        "bandwidth of the noise",
        Kind::Quantity(Dimension::Frequency, ABOVE_ZERO, slot!(noise.bandwidth_hz)),
        "\"175 kHz\"",
        "Bandwidth for which D* or NEP is taken; 1/(2 x noise_exposure) where it is not stated.",
        "noise power NEP sqrt(bandwidth) (Table S2)",
    )
    .condition_of(&["detectivity", "nep"]),
    row(
        "noise_exposure",
        "exposure of the noise",
        Kind::Quantity(Dimension::Time, ABOVE_ZERO, slot!(noise_exposure_s)),
        "\"12 ms\"",
        "Exposure for which the noise is stated; that of the frame where it is not stated.",
        "scaling of the noise from its exposure to the camera's",
    )
    .condition_of(&NOISES),
    row(
        "flicker_fraction",
        "flicker share of noise variance",
        Kind::Number(SHARE, slot!(flicker_fraction)),
        "0.5",
        "Share of the electronic noise variance at noise_exposure that is flicker, which frames do not average out; 0 where \
         it is not stated.",
        "share of the variance that frames do not average",
    )
    .always_shown(),
    row(
        "dark_rate",
        "dark counts",
        Kind::Quantity(Dimension::Rate, FROM_ZERO, slot!(dark_rate_per_s)),
        "\"1000 1/s\"",
        "Counts per second without light; 0 where it is not stated.",
        "dark counts in the noise budget (S14 to S16)",
    ),
    row(
        "read_noise",
        "read noise",
        Kind::Number(FROM_ZERO, slot!(read_noise_counts)),
        "100",
        "Standard deviation that every reading adds whatever its exposure, in counts; 0 where it is not stated.",
        "read noise in the noise budget (S14 to S16)",
    ),
    row(
        "quantisation_bits",
        "bits of the converter",
        Kind::Count(slot!(quantisation_bits)),
        "14",
        "Bits of the converter, which divide the full_well into steps.",
        "quantisation in the noise budget: step^2/12",
    )
    .always_shown(),
    row(
        "full_well",
        "full well",
        Kind::Number(ABOVE_ZERO, slot!(full_well)),
        "1e7",
        "Counts at which a pixel is full; never where it is not stated.",
        "longest exposure; step of the quantisation",
    )
    .always_shown(),
    row(
        "photon_bunching",
        "photon bunching",
        Kind::Flag(slot!(photon_bunching)),
        "true",
        "Whether the bunching of thermal photons adds its noise; false where it is not stated.",
        "variance n + n^2/modes (S11 to S13)",
    )
    .elsewhere(),
    row(
        "readout",
        "readout",
        Kind::Readout(slot!(readout)),
        "\"sequential\"",
        "Whether all bands are read in one exposure or one after the other; simultaneous where it is not stated.",
        "exposures until all bands are known; light of filters (S8, S9)",
    )
    .elsewhere(),
    row(
        "spectral_bands",
        "bands of its own",
        Kind::Count(slot!(spectral_bands)),
        "1",
        "Bands that the camera has of its own: with 1 a spectrum takes filters, one after the other; as many as the scenario \
         asks for where it is not stated.",
        "whether filters must make the other bands",
    )
    .elsewhere(),
    row(
        "frames",
        "averaged frames",
        Kind::Count(slot!(frames)),
        "16",
        "Number of frames that are averaged; 1 where it is not stated.",
        "counts and variance of all frames together",
    )
    .elsewhere(),
    row(
        "frame_rate",
        "frame rate",
        Kind::Quantity(Dimension::Frequency, ABOVE_ZERO, slot!(frame_rate_hz)),
        "\"60 Hz\"",
        "Frames per second: an exposure is no longer than a frame.",
        "time until all frames and bands are known",
    )
    .always_shown(),
    row(
        "sensor_temperature",
        "temperature of the sensor",
        Kind::Quantity(Dimension::Temperature, ABSOLUTE_TEMPERATURE, slot!(sensor_temperature_k)),
        "\"30 degC\"",
        "Temperature of the sensor, whose light filters throw back onto it; no such light where it is not stated.",
        "light of the sensor (S8, S9)",
    ),
    row(
        "filter_temperature",
        "temperature of the filters",
        Kind::Quantity(Dimension::Temperature, ABSOLUTE_TEMPERATURE, slot!(filter_temperature_k)),
        "\"30 degC\"",
        "Temperature of the filters; that of the sensor where it is not stated.",
        "light of the filters (S8, S9)",
    ),
    row(
        "field_of_view",
        "field of view",
        Kind::Quantity(Dimension::Angle, FIELD_OF_VIEW, slot!(field_of_view_rad)),
        "\"25 deg\"",
        "Full field of view across.",
        "footprint of a pixel; ranges of sizing practice",
    )
    .always_shown(),
    row(
        "pixels",
        "pixels across",
        Kind::Count(slot!(pixels)),
        "320",
        "Pixels across the field of view.",
        "footprint of a pixel; ranges of sizing practice",
    )
    .elsewhere(),
];
