//! Physical constants (exact SI) and quantities written with their unit.
//!
//! At the edge of the crate a quantity is a string with its unit (`"37 degC"`, `"12 um"`); units of
//! one [`Dimension`] are converted to one plain `f64` whose name then carries the unit
//! (`temperature_k`, `pixel_m`). A bare number where a unit is due is an error that says what to write.
//!
//! Source of the constants: SI Brochure, 9th edition (2019), where h, k and c are exact.

use crate::error::{Error, Result, check};
use std::borrow::Cow;

/// Speed of light in vacuum, m s⁻¹ (exact).
pub const SPEED_OF_LIGHT_M_S: f64 = 299_792_458.0;
/// Planck constant, J s (exact).
pub const PLANCK_J_S: f64 = 6.626_070_15e-34;
/// Boltzmann constant, J K⁻¹ (exact).
pub const BOLTZMANN_J_K: f64 = 1.380_649e-23;
/// Second radiation constant hc/k, cm K, rounded to the nearest `f64`.
pub const SECOND_RADIATION_CM_K: f64 = 1.438_776_877_503_933_8;
/// What [`SECOND_RADIATION_CM_K`] leaves of hc/k, cm K: the sum of the two is good to 32 digits.
pub const SECOND_RADIATION_REST_CM_K: f64 = 8.967_968_474_929_929e-18;

/// The micro sign and the Greek letter mu.
const MICRO: [char; 2] = ['\u{b5}', '\u{3bc}'];

/// What a number measures; fixes which units are accepted and which one is used inside.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dimension {
    /// Absolute temperature, inside in K.
    Temperature,
    /// Difference of temperatures (a noise, a prior), inside in K.
    TemperatureDifference,
    /// Length, inside in m.
    Length,
    /// Time, inside in s.
    Time,
    /// Speed, inside in m s⁻¹.
    Speed,
    /// Acceleration, inside in m s⁻².
    Acceleration,
    /// Plane angle, inside in rad.
    Angle,
    /// Specific detectivity D*, inside in cm √Hz W⁻¹.
    Detectivity,
    /// Frequency or bandwidth, inside in Hz.
    Frequency,
    /// Number per time, inside in s⁻¹.
    Rate,
    /// Noise-equivalent power of a bandwidth of 1 Hz, inside in W Hz^-½.
    NoiseEquivalentPower,
    /// Spectral radiance per wavelength, inside in µflick (µW cm⁻² sr⁻¹ µm⁻¹).
    SpectralRadiance,
    /// Wavenumber, inside in cm⁻¹.
    Wavenumber,
    /// Wavelength, inside in µm.
    Wavelength,
}

/// One accepted unit: spelling with `u` for micro, factor and offset to the unit used inside.
struct Unit {
    spelling: &'static str,
    factor: f64,
    offset: f64,
}

const fn unit(spelling: &'static str, factor: f64) -> Unit {
    Unit { spelling, factor, offset: 0.0 }
}

const TEMPERATURE: &[Unit] = &[
    unit("K", 1.0),
    Unit { spelling: "degC", factor: 1.0, offset: 273.15 },
    Unit { spelling: "°C", factor: 1.0, offset: 273.15 },
    Unit { spelling: "degF", factor: 5.0 / 9.0, offset: 459.67 * 5.0 / 9.0 },
    Unit { spelling: "°F", factor: 5.0 / 9.0, offset: 459.67 * 5.0 / 9.0 },
    unit("mK", 1e-3),
];
const TEMPERATURE_DIFFERENCE: &[Unit] =
    &[unit("K", 1.0), unit("mK", 1e-3), unit("uK", 1e-6), unit("degC", 1.0)];
const LENGTH: &[Unit] = &[
    unit("m", 1.0),
    unit("km", 1e3),
    unit("cm", 1e-2),
    unit("mm", 1e-3),
    unit("um", 1e-6),
    unit("nm", 1e-9),
    unit("ft", 0.3048),
    unit("in", 0.0254),
];
const TIME: &[Unit] = &[
    unit("s", 1.0),
    unit("ms", 1e-3),
    unit("us", 1e-6),
    unit("ns", 1e-9),
    unit("min", 60.0),
    unit("h", 3600.0),
];
const SPEED: &[Unit] =
    &[unit("m/s", 1.0), unit("km/h", 1.0 / 3.6), unit("mph", 0.44704), unit("kn", 1852.0 / 3600.0)];
/// 1 g is the standard acceleration of free fall, 9.80665 m s⁻² exactly.
const ACCELERATION: &[Unit] = &[unit("m/s^2", 1.0), unit("m/s2", 1.0), unit("m/s²", 1.0), unit("g", 9.80665)];
const ANGLE: &[Unit] = &[unit("rad", 1.0), unit("mrad", 1e-3), unit("deg", std::f64::consts::PI / 180.0)];
const DETECTIVITY: &[Unit] = &[unit("cm Hz^0.5/W", 1.0), unit("Jones", 1.0), unit("m Hz^0.5/W", 1e2)];
const FREQUENCY: &[Unit] = &[unit("Hz", 1.0), unit("kHz", 1e3), unit("MHz", 1e6), unit("GHz", 1e9)];
const RATE: &[Unit] = &[unit("1/s", 1.0), unit("s^-1", 1.0), unit("s-1", 1.0), unit("Hz", 1.0)];
const NOISE_EQUIVALENT_POWER: &[Unit] = &[
    unit("W/Hz^0.5", 1.0),
    unit("mW/Hz^0.5", 1e-3),
    unit("uW/Hz^0.5", 1e-6),
    unit("nW/Hz^0.5", 1e-9),
    unit("pW/Hz^0.5", 1e-12),
    unit("fW/Hz^0.5", 1e-15),
    unit("aW/Hz^0.5", 1e-18),
];
const SPECTRAL_RADIANCE: &[Unit] = &[unit("uflick", 1.0), unit("flick", 1e6)];
const WAVENUMBER: &[Unit] = &[unit("cm^-1", 1.0), unit("cm-1", 1.0), unit("1/cm", 1.0), unit("m^-1", 1e-2)];
const WAVELENGTH: &[Unit] = &[unit("um", 1.0), unit("nm", 1e-3), unit("mm", 1e3)];

impl Dimension {
    /// All of them.
    pub const ALL: [Self; 14] = [
        Self::Temperature,
        Self::TemperatureDifference,
        Self::Length,
        Self::Time,
        Self::Speed,
        Self::Acceleration,
        Self::Angle,
        Self::Detectivity,
        Self::Frequency,
        Self::Rate,
        Self::NoiseEquivalentPower,
        Self::SpectralRadiance,
        Self::Wavenumber,
        Self::Wavelength,
    ];

    const fn units(self) -> &'static [Unit] {
        match self {
            Self::Temperature => TEMPERATURE,
            Self::TemperatureDifference => TEMPERATURE_DIFFERENCE,
            Self::Length => LENGTH,
            Self::Time => TIME,
            Self::Speed => SPEED,
            Self::Acceleration => ACCELERATION,
            Self::Angle => ANGLE,
            Self::Detectivity => DETECTIVITY,
            Self::Frequency => FREQUENCY,
            Self::Rate => RATE,
            Self::NoiseEquivalentPower => NOISE_EQUIVALENT_POWER,
            Self::SpectralRadiance => SPECTRAL_RADIANCE,
            Self::Wavenumber => WAVENUMBER,
            Self::Wavelength => WAVELENGTH,
        }
    }

    /// The unit used inside, as it is written, e.g. `K` or `cm^-1`.
    #[must_use]
    pub fn unit(self) -> &'static str {
        self.units()[0].spelling
    }

    /// All units that it may be written with, that used inside first.
    pub fn spellings(self) -> impl Iterator<Item = &'static str> {
        self.units().iter().map(|unit| unit.spelling)
    }

    const fn example(self) -> &'static str {
        match self {
            Self::Temperature => "\"37 degC\" or \"310.15 K\"",
            Self::TemperatureDifference => "\"50 mK\" or \"2 K\"",
            Self::Length => "\"30 m\" or \"12 um\"",
            Self::Time => "\"12 ms\"",
            Self::Speed => "\"30 mph\" or \"13.4 m/s\"",
            Self::Acceleration => "\"5 m/s^2\" or \"0.5 g\"",
            Self::Angle => "\"25 deg\"",
            Self::Detectivity => "\"4.7e10 cm Hz^0.5/W\"",
            Self::Frequency => "\"60 Hz\" or \"175 kHz\"",
            Self::Rate => "\"1000 1/s\"",
            Self::NoiseEquivalentPower => "\"1e-12 W/Hz^0.5\"",
            Self::SpectralRadiance => "\"1 uflick\"",
            Self::Wavenumber => "\"715 cm^-1\"",
            Self::Wavelength => "\"8 um\"",
        }
    }

    /// Reads a quantity with its unit, e.g. `"37 degC"`, into the unit used inside.
    ///
    /// # Errors
    /// A missing or unknown unit, one of another dimension, or a number that is not finite.
    ///
    /// ```
    /// use hadar::units::Dimension;
    /// assert_eq!(Dimension::Temperature.parse("37 degC").unwrap(), 310.15);
    /// assert!(Dimension::Length.parse("12").unwrap_err().to_string().contains("without a unit"));
    /// ```
    pub fn parse(self, text: &str) -> Result<f64> {
        let text = text.trim();
        let (number, spelling) = parts(text);
        if let Some(error) = decimal_comma(text) {
            return Err(error);
        }
        let value: f64 = number.parse().map_err(|_| {
            Error::malformed(
                format!("`{text}` does not begin with a number"),
                format!("write {}", self.example()),
            )
        })?;
        check::finite("the number", value, "")?;
        if spelling.is_empty() {
            return Err(Error::malformed(
                format!("`{text}` is a number without a unit"),
                format!("write {}", self.example()),
            ));
        }
        match self.unit_spelt(spelling) {
            Some(unit) => match value * unit.factor + unit.offset {
                value if value.is_finite() => Ok(value),
                _ => Err(Error::malformed(format!("`{text}` is out of range"), "it must be a finite number")),
            },
            None => Err(Error::malformed(
                format!("`{spelling}` is not a unit of {}", self.name()),
                format!("write {}", self.example()),
            )),
        }
    }

    /// Writes a value of the unit used inside so that [`Dimension::parse`] gives it back to the last bit.
    #[must_use]
    pub fn format(self, value: f64) -> String {
        format!("{value} {}", self.unit())
    }

    /// The unit of a quantity that its author wrote, e.g. `mph` of `"30 mph"`, with `u` for micro; none of another dimension.
    #[must_use]
    pub fn unit_in(self, text: &str) -> Option<&'static str> {
        self.unit_spelt(parts(text.trim()).1).map(|unit| unit.spelling)
    }

    /// A value of the unit used inside as a number of another one of its units.
    #[must_use]
    pub fn in_unit(self, value: f64, spelling: &str) -> Option<f64> {
        self.unit_spelt(spelling).map(|unit| (value - unit.offset) / unit.factor)
    }

    fn unit_spelt(self, spelling: &str) -> Option<&'static Unit> {
        let spelling = with_plain_micro(spelling);
        self.units().iter().find(|unit| unit.spelling == spelling)
    }

    /// Its name in a sentence.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Temperature => "temperature",
            Self::TemperatureDifference => "temperature difference",
            Self::Length => "length",
            Self::Time => "time",
            Self::Speed => "speed",
            Self::Acceleration => "acceleration",
            Self::Angle => "angle",
            Self::Detectivity => "detectivity",
            Self::Frequency => "frequency",
            Self::Rate => "rate",
            Self::NoiseEquivalentPower => "noise-equivalent power",
            Self::SpectralRadiance => "spectral radiance",
            Self::Wavenumber => "wavenumber",
            Self::Wavelength => "wavelength",
        }
    }
}

/// A position or step on the spectral axis, in the axis its author chose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Spectral {
    /// Wavenumber, cm⁻¹.
    Wavenumber(f64),
    /// Wavelength, µm.
    Wavelength(f64),
}

impl Spectral {
    /// Reads `"715 cm^-1"` or `"8 um"`.
    ///
    /// # Errors
    /// As [`Dimension::parse`].
    pub fn parse(text: &str) -> Result<Self> {
        if Dimension::Wavelength.unit_in(text).is_some() {
            Dimension::Wavelength.parse(text).map(Self::Wavelength)
        } else {
            Dimension::Wavenumber.parse(text).map(Self::Wavenumber)
        }
    }

    /// Writes it so that [`Spectral::parse`] gives it back.
    #[must_use]
    pub fn format(self) -> String {
        match self {
            Self::Wavenumber(value) => Dimension::Wavenumber.format(value),
            Self::Wavelength(value) => Dimension::Wavelength.format(value),
        }
    }

    /// What its number measures.
    #[must_use]
    pub const fn dimension(self) -> Dimension {
        match self {
            Self::Wavenumber(_) => Dimension::Wavenumber,
            Self::Wavelength(_) => Dimension::Wavelength,
        }
    }

    /// The number on its own axis, cm⁻¹ or µm.
    #[must_use]
    pub const fn number(self) -> f64 {
        match self {
            Self::Wavenumber(value) | Self::Wavelength(value) => value,
        }
    }

    /// As a wavenumber, cm⁻¹ (a position, not a step).
    #[must_use]
    pub fn wavenumber_cm1(self) -> f64 {
        match self {
            Self::Wavenumber(value) => value,
            Self::Wavelength(value) => 1e4 / value,
        }
    }
}

/// A spelling of a unit with `u` for micro, whose sign (U+00B5) and Greek letter (U+03BC) look the same.
///
/// ```
/// use hadar::units::with_plain_micro;
/// assert_eq!(["µs", "μs", "us"].map(with_plain_micro), ["us"; 3]);
/// ```
#[must_use]
pub fn with_plain_micro(spelling: &str) -> Cow<'_, str> {
    match spelling.contains(MICRO) {
        true => Cow::Owned(spelling.replace(MICRO, "u")),
        false => Cow::Borrowed(spelling),
    }
}

/// The leading number of a text, and the rest: of a quantity its unit.
///
/// ```
/// assert_eq!(hadar::units::parts("4.7e10 cm Hz^0.5/W"), ("4.7e10", "cm Hz^0.5/W"));
/// ```
#[must_use]
pub fn parts(text: &str) -> (&str, &str) {
    let (number, rest) = text.split_at(number_end(text));
    (number.trim(), rest.trim())
}

/// A number with a comma where its decimal point belongs, named as such; none where that is not what is wrong.
///
/// ```
/// let error = hadar::units::decimal_comma("37,5 degC").unwrap().to_string();
/// assert_eq!(error, "`37,5 degC` has a decimal comma; write 37.5, as in \"37.5 degC\"");
/// assert!(hadar::units::decimal_comma("37.5 degC").is_none());
/// ```
#[must_use]
pub fn decimal_comma(text: &str) -> Option<Error> {
    let text = text.trim();
    let (whole, rest) = text.split_at(number_end(text));
    let point = format!("{whole}.{}", rest.strip_prefix(',')?);
    let (number, unit) = parts(&point);
    number.parse::<f64>().ok().filter(|_| number.len() > whole.len() + 1)?;
    let whole_unit = if unit.is_empty() { String::new() } else { format!(", as in \"{number} {unit}\"") };
    Some(Error::malformed(format!("`{text}` has a decimal comma"), format!("write {number}{whole_unit}")))
}

/// End of the leading number of `text` (an `e` is part of it only before digits or a sign).
fn number_end(text: &str) -> usize {
    let bytes = text.as_bytes();
    let mut end = 0;
    while end < bytes.len() {
        let byte = bytes[end];
        let exponent =
            matches!(byte, b'e' | b'E') && matches!(bytes.get(end + 1), Some(b'0'..=b'9' | b'+' | b'-'));
        let sign = matches!(byte, b'+' | b'-') && (end == 0 || matches!(bytes[end - 1], b'e' | b'E'));
        if byte.is_ascii_digit() || byte == b'.' || exponent || sign {
            end += 1;
        } else {
            break;
        }
    }
    end
}

/// x·2^power in steps that do not overflow before the result does.
pub(crate) fn times_power_of_two(x: f64, power: i32) -> f64 {
    let half = power / 2;
    x * f64::from(half).exp2() * f64::from(power - half).exp2()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_radiation_constant_is_h_c_over_k() {
        let direct = PLANCK_J_S * SPEED_OF_LIGHT_M_S / BOLTZMANN_J_K * 100.0;
        assert!((direct / SECOND_RADIATION_CM_K - 1.0).abs() < 4e-16);
    }

    #[test]
    fn quantities_survive_a_round_trip() {
        for (dimension, text, value) in [
            (Dimension::Temperature, "20 degC", 293.15),
            (Dimension::Temperature, "212 degF", 373.15),
            (Dimension::TemperatureDifference, "47.8mK", 0.0478),
            (Dimension::Length, "12 um", 12e-6),
            (Dimension::Speed, "30 mph", 13.4112),
            (Dimension::Acceleration, "0.5 g", 4.903325),
            (Dimension::Acceleration, "5 m/s²", 5.0),
            (Dimension::Time, "1.2e-2 s", 0.012),
            (Dimension::Wavenumber, "715 cm^-1", 715.0),
        ] {
            let parsed = dimension.parse(text).unwrap();
            assert!((parsed / value - 1.0).abs() < 4e-16, "{text}: {parsed}");
            assert_eq!(dimension.parse(&dimension.format(parsed)).unwrap(), parsed);
        }
    }

    #[test]
    fn a_micro_sign_and_a_greek_mu_are_the_same() {
        for micro in ["u", "\u{b5}", "\u{3bc}"] {
            for (dimension, unit, value) in [
                (Dimension::Length, "m", 12e-6),
                (Dimension::Time, "s", 12e-6),
                (Dimension::TemperatureDifference, "K", 12e-6),
                (Dimension::NoiseEquivalentPower, "W/Hz^0.5", 12e-6),
                (Dimension::SpectralRadiance, "flick", 12.0),
                (Dimension::Wavelength, "m", 12.0),
            ] {
                let text = format!("12 {micro}{unit}");
                assert!((dimension.parse(&text).unwrap() / value - 1.0).abs() < 4e-16, "{text}");
                assert_eq!(dimension.unit_in(&text), Some(format!("u{unit}").as_str()), "{text}");
            }
            let text = format!("8 {micro}m");
            assert_eq!(Spectral::parse(&text).unwrap(), Spectral::Wavelength(8.0), "{text}");
        }
    }

    #[test]
    fn units_of_another_dimension_and_bare_numbers_are_refused() {
        assert!(Dimension::Temperature.parse("37 m").is_err());
        assert!(Dimension::Temperature.parse("NaN K").is_err());
        assert!(Dimension::Temperature.parse("").is_err());
        assert!(Dimension::Length.parse("1e308 km").is_err());
        for (text, point) in [("37,5 degC", "37.5 degC"), ("-1,25e-3K", "-1.25e-3 K"), ("0,5 mK", "0.5 mK")] {
            let error = Dimension::Temperature.parse(text).unwrap_err().to_string();
            assert!(error.contains("has a decimal comma; write ") && error.contains(point), "{error}");
        }
        assert!(["1, 2", "a,5", "1.5,5", "5,"].iter().all(|text| decimal_comma(text).is_none()));
        assert_eq!(Dimension::Speed.unit_in("30 mph"), Some("mph"));
        assert_eq!(Dimension::Length.unit_in("30 mph"), None);
        let fahrenheit = Dimension::Temperature.in_unit(310.15, "°F").unwrap();
        assert!((fahrenheit / 98.6 - 1.0).abs() < 1e-14, "{fahrenheit}");
        assert_eq!(Spectral::parse("8 um").unwrap(), Spectral::Wavelength(8.0));
        assert_eq!(Spectral::parse("715 cm^-1").unwrap(), Spectral::Wavenumber(715.0));
        assert!(Spectral::parse("8").is_err());
    }
}
