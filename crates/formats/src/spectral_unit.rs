//! Units of the spectral axis, as files spell them, and the wavenumber that a number in each stands for.
//!
//! Wavelength λ and frequency f become ν = 1/λ and ν = f/c, in cm⁻¹; wavelengths are those in vacuum.

use hadar::units::{SPEED_OF_LIGHT_M_S, with_plain_micro};

/// What the numbers of a spectral axis are counted in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum SpectralUnit {
    /// Wavelength in µm.
    Micrometre,
    /// Wavelength in nm.
    Nanometre,
    /// Wavelength in Å.
    Angstrom,
    /// Wavelength in mm.
    Millimetre,
    /// Wavelength in m.
    Metre,
    /// Wavenumber in cm⁻¹.
    PerCentimetre,
    /// Wavenumber in m⁻¹.
    PerMetre,
    /// Frequency in THz.
    Terahertz,
    /// Frequency in GHz.
    Gigahertz,
    /// Frequency in Hz.
    Hertz,
}

use SpectralUnit::{
    Angstrom, Gigahertz, Hertz, Metre, Micrometre, Millimetre, Nanometre, PerCentimetre, PerMetre, Terahertz,
};

/// Spellings without blanks, brackets and carets, in lower case.
const SPELLINGS: &[(SpectralUnit, &[&str])] = &[
    (Micrometre, &["um", "micron", "microns", "micrometer", "micrometers", "micrometre", "micrometres"]),
    (Nanometre, &["nm", "nanometer", "nanometers", "nanometre", "nanometres"]),
    (Angstrom, &["å", "angstrom", "angstroms", "ångström"]),
    (Millimetre, &["mm", "millimeter", "millimeters", "millimetre", "millimetres"]),
    (Metre, &["m", "meter", "meters", "metre", "metres"]),
    (
        PerCentimetre,
        &[
            "cm-1",
            "cm1",
            "1/cm",
            "/cm",
            "1/centimeter",
            "1/centimetre",
            "percm",
            "inversecm",
            "reciprocalcm",
            "wavenumber",
            "wavenumbers",
            "kayser",
        ],
    ),
    (PerMetre, &["m-1", "m1", "1/m"]),
    (Terahertz, &["thz", "terahertz"]),
    (Gigahertz, &["ghz", "gigahertz"]),
    (Hertz, &["hz", "hertz"]),
];

impl SpectralUnit {
    /// The unit of a spelling: `um`, `µm`, `Micrometers`, `[cm^-1]`, `1/CM`, `cm⁻¹`, `THz`, …
    ///
    /// ```
    /// use hadar_formats::spectral_unit::SpectralUnit;
    /// assert_eq!(SpectralUnit::spelt("(µm)"), Some(SpectralUnit::Micrometre));
    /// assert_eq!(SpectralUnit::spelt("[cm^-1]"), Some(SpectralUnit::PerCentimetre));
    /// assert_eq!(SpectralUnit::spelt("furlong"), None);
    /// assert_eq!(SpectralUnit::spelt("Mm"), None);
    /// ```
    #[must_use]
    pub fn spelt(text: &str) -> Option<Self> {
        let plain = plain(text)?;
        SPELLINGS.iter().find(|(_, spellings)| spellings.contains(&plain.as_str())).map(|(unit, _)| *unit)
    }

    /// The wavenumber in cm⁻¹ of a number in this unit; a wavelength of 0 has none that is finite.
    #[must_use]
    pub fn wavenumber_cm1(self, value: f64) -> f64 {
        match self {
            Micrometre => 1e4 / value,
            Nanometre => 1e7 / value,
            Angstrom => 1e8 / value,
            Millimetre => 10.0 / value,
            Metre => 0.01 / value,
            PerCentimetre => value,
            PerMetre => 0.01 * value,
            Terahertz => value * (1e10 / SPEED_OF_LIGHT_M_S),
            Gigahertz => value * (1e7 / SPEED_OF_LIGHT_M_S),
            Hertz => value * (0.01 / SPEED_OF_LIGHT_M_S),
        }
    }

    /// Its name in messages, `um` or `cm^-1`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Micrometre => "um",
            Nanometre => "nm",
            Angstrom => "angstrom",
            Millimetre => "mm",
            Metre => "m",
            PerCentimetre => "cm^-1",
            PerMetre => "m^-1",
            Terahertz => "THz",
            Gigahertz => "GHz",
            Hertz => "Hz",
        }
    }

    /// What is counted in it: `wavelength`, `wavenumber` or `frequency`.
    #[must_use]
    pub const fn quantity(self) -> &'static str {
        match self {
            Micrometre | Nanometre | Angstrom | Millimetre | Metre => "wavelength",
            PerCentimetre | PerMetre => "wavenumber",
            Terahertz | Gigahertz | Hertz => "frequency",
        }
    }
}

/// A spelling without what only decorates it; none of a text too long for a unit.
fn plain(text: &str) -> Option<String> {
    const LONGEST: usize = 40;
    // Capitals say nothing, as in `UM`, but for the megametre and what is a prefix alone.
    let bare = text.trim_matches(|char: char| !char.is_alphanumeric());
    if text.len() > LONGEST || bare == "M" || bare.ends_with("Mm") {
        return None;
    }
    // What was written as UTF-8 and read as Latin-1: the micro sign, and the Greek letter.
    let text = with_plain_micro(text).to_lowercase().replace("âu", "u").replace("î¼", "u");
    let chars = text.chars().filter_map(|char| match char {
        '⁻' | '−' | '–' => Some('-'),
        '¹' => Some('1'),
        '^' | '*' | '(' | ')' | '[' | ']' | '{' | '}' | '$' | '.' | '_' => None,
        char if char.is_whitespace() => None,
        char => Some(char),
    });
    Some(chars.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_is_told_by_any_customary_spelling() {
        for (unit, spellings) in [
            (
                Micrometre,
                &["um", "(um)", "[µm]", "μm", "Âµm", "Î¼m", "Micrometers", "microns", "MICROMETRES"][..],
            ),
            (Nanometre, &["nm", "Nanometers", "(NM)"]),
            (
                PerCentimetre,
                &[
                    "cm-1",
                    "cm^-1",
                    "[cm^-1]",
                    "1/CM",
                    "cm⁻¹",
                    "cm−1",
                    "cm^{-1}",
                    "cm1",
                    "Wavenumber",
                    "cm**-1",
                ],
            ),
            (Terahertz, &["THz", "thz"]),
            (Gigahertz, &["GHz"]),
            (Angstrom, &["Å", "Angstroms"]),
        ] {
            for spelling in spellings {
                assert_eq!(SpectralUnit::spelt(spelling), Some(unit), "{spelling}");
            }
            assert_eq!(SpectralUnit::spelt(unit.name()), Some(unit));
        }
        for other in ["", "cm", "Unknown", "Index", "K", &"u".repeat(1000)] {
            assert_eq!(SpectralUnit::spelt(other), None, "{other}");
        }
    }

    #[test]
    fn ten_micrometres_are_a_thousand_per_centimetre_in_every_unit() {
        for (unit, value) in [
            (Micrometre, 10.0),
            (Nanometre, 1e4),
            (Angstrom, 1e5),
            (Millimetre, 0.01),
            (Metre, 1e-5),
            (PerCentimetre, 1e3),
            (PerMetre, 1e5),
            (Terahertz, 29.979_245_8),
            (Gigahertz, 29_979.245_8),
            (Hertz, 29.979_245_8e12),
        ] {
            let wavenumber = unit.wavenumber_cm1(value);
            assert!((wavenumber / 1e3 - 1.0).abs() < 1e-15, "{unit:?}: {wavenumber}");
        }
    }
}
