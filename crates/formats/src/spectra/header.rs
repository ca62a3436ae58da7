//! What the header of a column says: the unit of the axis, and emissivity or reflectance, as a fraction or in percent.
//!
//! `wavelength (um)`, `Wavelength [µm]`, `nm`, `wavenumber_cm1`, `cm-1`, `λ / µm`, `frequency (THz)`; `emissivity`, `Reflectance (%)`,
//! `%R`, `skin_reflectance`. What is not stated is taken only where nothing else is possible ([`unit_of_range`]).

mod factor;

use self::factor::is_scaled;
use crate::spectral_unit::SpectralUnit;
use hadar::error::{Error, Result};
use hadar::words::kebab_case;

/// Names of an axis and what they count, without blanks and signs.
const AXES: &[(&str, &[&str])] = &[
    (
        "wavelength",
        &[
            "wavelength",
            "wavelengths",
            "lambda",
            "λ",
            "wl",
            "wvl",
            "wave",
            "centerwavelength",
            "centrewavelength",
            "wellenlänge",
            "wellenlaenge",
        ],
    ),
    ("wavenumber", &["wavenumber", "wavenumbers", "wn", "nu", "ν", "ν̃", "wellenzahl"]),
    ("frequency", &["frequency", "freq", "f", "frequenz"]),
    ("", &["", "x"]),
];
const EMISSIVITY: &[&str] =
    &["emissivity", "emissivities", "emittance", "emiss", "emis", "epsilon", "eps", "emissionsgrad"];
const REFLECTANCE: &[&str] = &[
    "reflectance",
    "reflectances",
    "reflectivity",
    "reflection",
    "refl",
    "rho",
    "reflexionsgrad",
    "dhr",
    "bhr",
    "hdrf",
    "albedo",
];
const OTHER: &[&str] = &[
    "transmittance",
    "transmission",
    "transmissivity",
    "absorbance",
    "absorption",
    "absorptance",
    "absorptivity",
    "radiance",
    "intensity",
    "counts",
    "munk",
];
/// Names of one letter, which stand alone.
const LETTERS: &[(&str, Option<Quantity>)] = &[
    ("e", Some(Quantity::Emissivity)),
    ("ε", Some(Quantity::Emissivity)),
    ("r", Some(Quantity::Reflectance)),
    ("ρ", Some(Quantity::Reflectance)),
    ("t", None),
    ("τ", None),
    ("a", None),
];
const PERCENT: &[&str] = &["percent", "pct", "prozent", "percentage"];
/// Words beside a quantity that change nothing of it.
const IDLE: &[&str] = &[
    "spectral",
    "total",
    "hemispherical",
    "directional",
    "normal",
    "fraction",
    "fractional",
    "unitless",
    "dimensionless",
    "in",
    "of",
];
/// Words that make of a quantity something from which no emissivity follows: a part of the reflectance, another scale.
const CHANGED: &[&str] = &[
    "specular",
    "diffuse",
    "bidirectional",
    "biconical",
    "brdf",
    "brf",
    "atr",
    "relative",
    "log",
    "log10",
    "ln",
    "minus",
    "non",
    "inverse",
    "delta",
    "derivative",
    "normalized",
    "normalised",
    "continuum",
    "difference",
    "change",
    "arb",
    "apparent",
    "ratio",
    "residual",
    "scaled",
    "raw",
    "uncorrected",
    "radiance",
    "min",
    "max",
    "minimum",
    "maximum",
    "d",
    "first",
    "second",
    "1st",
    "2nd",
];
const DEVIATION: &[&str] = &[
    "std",
    "stdev",
    "sd",
    "sigma",
    "σ",
    "error",
    "err",
    "uncertainty",
    "unc",
    "deviation",
    "variance",
    "var",
];

/// What emissivities are made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Quantity {
    /// Emissivity itself.
    Emissivity,
    /// Reflectance of an opaque surface, e = 1 − R.
    Reflectance,
}

impl Quantity {
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Emissivity => "emissivity",
            Self::Reflectance => "reflectance",
        }
    }

    /// What is assumed where this is made into an emissivity.
    pub(super) const fn note(self) -> &'static str {
        match self {
            Self::Emissivity => "",
            Self::Reflectance => "emissivity = 1 - reflectance (Kirchhoff), taken as opaque",
        }
    }

    /// The emissivity of a fraction.
    pub(super) fn emissivity(self, fraction: f64) -> f64 {
        match self {
            Self::Emissivity => fraction,
            Self::Reflectance => 1.0 - fraction,
        }
    }
}

/// A column of values.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Values {
    /// What is said to be in it; none where only a name is.
    pub(super) quantity: Option<Quantity>,
    pub(super) percent: bool,
    /// The material's name in kebab-case; may be empty.
    pub(super) name: String,
}

/// What a column holds.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Meaning {
    Values(Values),
    /// Errors of another column.
    Deviation,
    /// Something from which no emissivity follows.
    Other,
    /// A reflectance, or a name in which the word is.
    Unclear,
}

/// The axis of a header: its unit, if that is said, and what is counted, if that is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Axis {
    pub(super) unit: Option<SpectralUnit>,
    pub(super) quantity: &'static str,
}

/// The axis that a header names; none where it names none.
///
/// # Errors
/// A unit of something else, as in `wavelength (cm-1)`.
pub(super) fn axis(cell: &str) -> Result<Option<Axis>> {
    let cell = cell.trim();
    if cell.len() > LONGEST {
        return Ok(None);
    }
    if let Some(quantity) = axis_named(cell).filter(|quantity| !quantity.is_empty()) {
        return Ok(Some(Axis { unit: None, quantity }));
    }
    // The longest end that is a unit: `(1/cm)` before `cm)`.
    for (at, _) in cell.char_indices().filter(|&(at, char)| at == 0 || !char.is_alphanumeric()) {
        let after =
            cell.get(at..).and_then(|rest| rest.chars().next()).map_or(at, |char| at + char.len_utf8());
        for split in [at, after] {
            let (Some(name), Some(rest)) = (cell.get(..split), cell.get(split..)) else { continue };
            let Some(quantity) = axis_named(name) else { continue };
            let Some(unit) = SpectralUnit::spelt(rest).or_else(|| angstrom(quantity, rest)) else { continue };
            let fits = quantity.is_empty()
                || quantity == unit.quantity()
                || quantity == "frequency" && unit.quantity() == "wavenumber";
            if fits {
                return Ok(Some(Axis { unit: Some(unit), quantity: unit.quantity() }));
            }
            let found = format!("a {quantity} in {} is none", unit.name());
            let instead = format!("write {}, or the unit that is true", named_axis(unit));
            return Err(Error::malformed(found, instead));
        }
    }
    Ok(None)
}

/// The unit `A` of a wavelength, which elsewhere is the letter of a material or of absorbance.
fn angstrom(quantity: &str, unit: &str) -> Option<SpectralUnit> {
    let letter = unit.trim_matches(|char: char| "()[] _/".contains(char));
    (quantity == "wavelength" && letter == "A").then_some(SpectralUnit::Angstrom)
}

/// Whether a header says both what is counted and in which unit, as no material's name does.
pub(super) fn says_in_full(cell: &str) -> bool {
    let Ok(Some(Axis { unit: Some(_), quantity })) = axis(cell) else { return false };
    cell.to_lowercase().starts_with(quantity)
}

/// The longest header that is looked at, bytes.
const LONGEST: usize = 80;

/// What a name of an axis counts, `""` for a name that may count anything.
fn axis_named(name: &str) -> Option<&'static str> {
    let lower = name.to_lowercase();
    let plain: String = lower.chars().filter(|char| char.is_alphanumeric() || *char == '\u{303}').collect();
    let plain = plain.strip_suffix("in").filter(|plain| !plain.is_empty()).unwrap_or(&plain);
    AXES.iter().find(|(_, names)| names.contains(&plain)).map(|(quantity, _)| *quantity)
}

/// What a column of values holds.
pub(super) fn values(cell: &str) -> Meaning {
    let kebab = format!("-{}-", kebab_case(cell)).replace("-per-cent-", "-percent-");
    let mut words: Vec<&str> = kebab.split('-').filter(|word| !word.is_empty()).collect();
    let percent = cell.contains('%') || words.iter().any(|word| PERCENT.contains(word));
    words.retain(|word| !PERCENT.contains(word));
    let name = words.join("-");
    let of = |quantity, name| Meaning::Values(Values { quantity, percent, name });
    // `Reflectance (0-1)`, `emissivity, unitless`.
    let words = words.strip_suffix(&["0", "1"]).unwrap_or(&words);
    let end = words.iter().rposition(|word| !IDLE.contains(word)).map_or(0, |last| last + 1);
    let Some((last, before)) = words.get(..end).and_then(<[&str]>::split_last) else { return of(None, name) };
    let before: Vec<&str> = before.iter().copied().filter(|word| !IDLE.contains(word)).collect();
    let any = |list: &[&str]| list.contains(last) || before.iter().any(|word| list.contains(word));
    let is_said = any(EMISSIVITY) || any(REFLECTANCE) || any(OTHER);
    if DEVIATION.contains(last) || is_said && any(DEVIATION) {
        return Meaning::Deviation;
    }
    if is_scaled(cell, is_said && !percent) {
        return Meaning::Unclear;
    }
    // `1 - emissivity` is none.
    if cell.to_lowercase().contains("a.u.")
        || is_said && (any(CHANGED) || matches!(before[..], ["1" | "one"]))
    {
        return Meaning::Other;
    }
    let letter = |word: &str| LETTERS.iter().find(|(letter, _)| *letter == word);
    let of_letter = |quantity: Option<Quantity>| match quantity {
        Some(_) => of(quantity, before.join("-")),
        None => Meaning::Other,
    };
    match (letter(before.first().unwrap_or(last)), letter(last)) {
        (Some((_, quantity)), _) if before.is_empty() => return of_letter(*quantity),
        // `brick %R`, `brick (R)`, `brick ρ` say what the numbers are; `brick R` may.
        (_, Some((letter, quantity))) if is_marked(cell, letter) => return of_letter(*quantity),
        (_, Some((letter, quantity)))
            if percent || (*letter != "a" && *quantity != Some(Quantity::Emissivity)) =>
        {
            return Meaning::Unclear;
        }
        // `1 - R`.
        _ if matches!(before[..], ["1" | "one", word, ..] if letter(word).is_some()) => {
            return Meaning::Other;
        }
        // `R 1` and `R_brick` may be the reflectance of a sample; of emissivities they need not say it.
        (Some((_, quantity)), _) if !is_said && *quantity != Some(Quantity::Emissivity) => {
            return Meaning::Unclear;
        }
        (Some(_), _) if before.len() == 1 && last.bytes().all(|byte| byte.is_ascii_digit()) => {
            return Meaning::Unclear;
        }
        _ => {}
    }
    if before.iter().any(|word| OTHER.contains(word)) && !OTHER.contains(last) {
        return Meaning::Unclear;
    }
    if EMISSIVITY.contains(last) {
        return of(Some(Quantity::Emissivity), before.join("-"));
    }
    if REFLECTANCE.contains(last) {
        return of(Some(Quantity::Reflectance), before.join("-"));
    }
    match (any(OTHER), any(REFLECTANCE), any(EMISSIVITY)) {
        _ if OTHER.contains(last) => Meaning::Other,
        // `reflectance 2`, `white reflectance panel`: what the numbers are, or a part of a name.
        (true, ..) | (_, true, _) => Meaning::Unclear,
        (.., true) => of(Some(Quantity::Emissivity), name),
        // A name, in which nothing of a quantity is.
        _ => of(None, name),
    }
}

/// Whether a letter stands in a header as a quantity: in brackets, beside a sign of percent, or as none of the alphabet's.
fn is_marked(cell: &str, letter: &str) -> bool {
    let lower = cell.to_lowercase();
    let plain = lower.trim_end_matches([' ', ')', ']']);
    let before = plain.strip_suffix(letter).map(str::trim_end);
    !letter.is_ascii()
        || before.is_some_and(|before| before.ends_with(['%', '(', '[']))
        || plain.ends_with(&format!("{letter}%"))
}

/// Wavelengths of emissivities, µm: 0.2 µm to 1 mm.
const WAVELENGTHS_UM: (f64, f64) = (0.2, 1000.0);
/// Wavenumbers of them, cm⁻¹.
const WAVENUMBERS_CM1: (f64, f64) = (10.0, 5e4);

/// The unit of an axis that states none, where only one is possible from the lowest to the highest of its numbers: a wavelength in µm or
/// nm, a wavenumber in cm⁻¹.
pub(super) fn unit_of_range(quantity: &str, (low, high): (f64, f64)) -> Option<SpectralUnit> {
    let inside = |(from, to): (f64, f64), factor: f64| factor * from <= low && high <= factor * to;
    match quantity {
        "wavenumber" if inside(WAVENUMBERS_CM1, 1.0) => Some(SpectralUnit::PerCentimetre),
        "wavelength" => match (inside(WAVELENGTHS_UM, 1.0), inside(WAVELENGTHS_UM, 1e3)) {
            (true, false) => Some(SpectralUnit::Micrometre),
            (false, true) => Some(SpectralUnit::Nanometre),
            _ => None,
        },
        _ => None,
    }
}

/// The header of a column with this unit.
pub(super) const fn named_axis(unit: SpectralUnit) -> &'static str {
    match unit {
        SpectralUnit::Micrometre => "wavelength_um",
        SpectralUnit::Nanometre => "wavelength_nm",
        SpectralUnit::Angstrom => "wavelength_angstrom",
        SpectralUnit::Millimetre => "wavelength_mm",
        SpectralUnit::Metre => "wavelength_m",
        SpectralUnit::PerCentimetre => "wavenumber_cm1",
        SpectralUnit::PerMetre => "wavenumber_m1",
        SpectralUnit::Terahertz => "frequency_THz",
        SpectralUnit::Gigahertz => "frequency_GHz",
        SpectralUnit::Hertz => "frequency_Hz",
    }
}

/// The header to write above columns of these ranges: what it says already is kept, the rest is what the numbers look like.
pub(super) fn suggested(header: &[String], ranges: &[(f64, f64)]) -> String {
    /// Columns that are shown of many.
    const SHOWN: usize = 4;
    let count = ranges.len().max(header.len()).max(2);
    let range = |column: usize| ranges.get(column).copied();
    let mut cells: Vec<String> = Vec::new();
    for column in 0..count.min(SHOWN) {
        let said = header.get(column).map_or("", |cell| cell.trim()).to_owned();
        let kept = match (column, axis(&said)) {
            (0, Ok(Some(Axis { unit: Some(_), .. }))) => Some(said.clone()),
            (0, _) => None,
            _ if count == 2 => match values(&said) {
                Meaning::Values(Values { quantity: Some(_), percent, .. })
                    if percent || range(column).is_none_or(|(_, high)| high <= 1.0) =>
                {
                    Some(said.clone())
                }
                _ => None,
            },
            _ => (!said.is_empty()).then(|| said.clone()),
        };
        let meant = |column: usize| match (column, range(column)) {
            (0, None) => "wavenumber_cm1",
            (0, Some((low, high))) => {
                let quantity = axis(&said).ok().flatten().map_or("", |axis| axis.quantity);
                match (quantity, low, high) {
                    ("wavelength", _, high) if high <= 100.0 => "wavelength_um",
                    ("wavelength", ..) => "wavelength_nm",
                    ("wavenumber", _, high) if high > 5e4 => "wavenumber_m1",
                    ("wavenumber", ..) => "wavenumber_cm1",
                    ("frequency", ..) => "frequency_THz",
                    (_, _, high) if high <= 100.0 => "wavelength_um",
                    (_, _, high) if high <= 5000.0 => "wavenumber_cm1",
                    _ => "wavelength_nm",
                }
            }
            _ if count > 2 => "name of the material",
            (_, Some((_, high))) if high > 1.0 => "reflectance_percent",
            _ => "emissivity",
        };
        cells.push(kept.filter(|cell| !cell.contains(',')).unwrap_or_else(|| meant(column).to_owned()));
    }
    if count > SHOWN {
        cells.push("…".to_owned());
    }
    cells.join(",")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_is_told_by_its_header() {
        use SpectralUnit::{Micrometre, Nanometre, PerCentimetre, Terahertz};
        for (unit, headers) in [
            (
                Micrometre,
                &[
                    "wavelength_um",
                    "wavelength (um)",
                    "Wavelength [µm]",
                    "µm",
                    "λ / µm",
                    "Wavelength, microns",
                    "wavelength (micrometers)",
                    "lambda_um",
                    "Wellenlänge [µm]",
                    "x (um)",
                    "Wavelength in um",
                ][..],
            ),
            (Nanometre, &["nm", "Wavelength (nm)", "wl_nm", "WAVELENGTH_NM", "wavelength nm"]),
            (
                PerCentimetre,
                &[
                    "wavenumber_cm1",
                    "wavenumber [cm^-1]",
                    "cm-1",
                    "Wavenumbers (cm-1)",
                    "wavenumber (1/cm)",
                    "ν [cm⁻¹]",
                    "frequency (cm-1)",
                    "wavenumber_cm-1",
                    "1/cm",
                    "Wavenumber (cm⁻¹)",
                ],
            ),
            (
                SpectralUnit::Angstrom,
                &["wavelength (A)", "Wavelength [Å]", "wavelength_A", "lambda (angstrom)"],
            ),
            (Terahertz, &["THz", "frequency (THz)", "frequency_THz", "f [THz]"]),
        ] {
            for header in headers {
                let axis = axis(header).unwrap_or_else(|error| panic!("{header}: {error}"));
                assert_eq!(axis.and_then(|axis| axis.unit), Some(unit), "{header}");
            }
        }
        assert_eq!(axis("wavelength"), Ok(Some(Axis { unit: None, quantity: "wavelength" })));
        assert_eq!(axis("Wavenumber"), Ok(Some(Axis { unit: None, quantity: "wavenumber" })));
        for other in [
            "",
            "emissivity",
            "thickness (um)",
            "skin",
            "A",
            "x (A)",
            "wavelength a",
            "temperature [K]",
            "x",
            "time (s)",
            "8.5",
        ] {
            assert_eq!(axis(other), Ok(None), "{other}");
        }
        assert!(axis("wavelength (cm-1)").unwrap_err().to_string().contains("write wavenumber_cm1"));
        assert!(axis("wavenumber_um").unwrap_err().to_string().contains("write wavelength_um"));
        for unit in
            [Micrometre, Nanometre, PerCentimetre, Terahertz, SpectralUnit::Metre, SpectralUnit::Gigahertz]
        {
            assert_eq!(axis(named_axis(unit)).unwrap().and_then(|axis| axis.unit), Some(unit));
        }
    }

    #[test]
    fn values_are_told_by_their_header() {
        let of = |quantity, percent, name: &str| {
            Meaning::Values(Values { quantity: Some(quantity), percent, name: name.to_owned() })
        };
        use Quantity::{Emissivity, Reflectance};
        for (header, meaning) in [
            ("emissivity", of(Emissivity, false, "")),
            ("Emissivity (%)", of(Emissivity, true, "")),
            ("spectral emissivity [-]", of(Emissivity, false, "")),
            ("ε", of(Emissivity, false, "")),
            ("%R", of(Reflectance, true, "")),
            ("R [%]", of(Reflectance, true, "")),
            ("reflectance_percent", of(Reflectance, true, "")),
            ("Reflectance (fraction)", of(Reflectance, false, "")),
            ("Directional Hemispherical Reflectance", of(Reflectance, false, "")),
            ("skin_reflectance", of(Reflectance, false, "skin")),
            ("Roof tile emissivity (%)", of(Emissivity, true, "roof-tile")),
            ("emissivity_std", Meaning::Deviation),
            ("sigma_emissivity", Meaning::Deviation),
            ("uncertainty", Meaning::Deviation),
            ("Transmittance (%)", Meaning::Other),
            ("absorbance", Meaning::Other),
            ("specular reflectance", Meaning::Other),
            ("reflectance (a.u.)", Meaning::Other),
            ("%T", Meaning::Other),
            ("1-emissivity", Meaning::Other),
            ("1 - Reflectance (%)", Meaning::Other),
            ("log reflectance", Meaning::Other),
            ("apparent reflectance", Meaning::Other),
            ("emissivity ratio", Meaning::Other),
            ("max emissivity", Meaning::Other),
            ("absorbance reflectance", Meaning::Unclear),
            ("emissivity difference", Meaning::Other),
            ("reflectance 2", Meaning::Unclear),
            ("white reflectance panel", Meaning::Unclear),
            ("transmittance_300K", Meaning::Unclear),
            ("R 2", Meaning::Unclear),
            ("brick %R", of(Reflectance, true, "brick")),
            ("brick (R)", of(Reflectance, false, "brick")),
            ("brick ρ", of(Reflectance, false, "brick")),
            ("brick DHR", of(Reflectance, false, "brick")),
            ("brick albedo", of(Reflectance, false, "brick")),
            ("brick %T", Meaning::Other),
            ("brick [A]", Meaning::Other),
            ("R_brick", Meaning::Unclear),
            ("T_glass", Meaning::Unclear),
            ("A_brick", Meaning::Unclear),
            ("brick R (%)", Meaning::Unclear),
            ("brick R", Meaning::Unclear),
            ("1-R_brick", Meaning::Other),
            ("T-shirt emissivity", of(Emissivity, false, "t-shirt")),
            ("Reflectance (0-1)", of(Reflectance, false, "")),
            ("emissivity_300K", of(Emissivity, false, "emissivity-300k")),
            ("emissivity (per cent)", of(Emissivity, true, "")),
            ("Per cent Reflectance", of(Reflectance, true, "")),
            ("supper-centre emissivity", of(Emissivity, false, "supper-centre")),
            ("CrystalGlass emissivity", of(Emissivity, false, "crystal-glass")),
            ("emissivity (0-100 %)", of(Emissivity, true, "emissivity-0-100")),
            ("emissivity*100", Meaning::Unclear),
            ("100*emissivity", Meaning::Unclear),
            ("emissivity × 100", Meaning::Unclear),
            ("emissivity (x100)", Meaning::Unclear),
            ("emissivity [1e-2]", Meaning::Unclear),
            ("emissivity_e-2", Meaning::Unclear),
            ("emissivity 10^-2", Meaning::Unclear),
            ("emissivity ppm", Meaning::Unclear),
            ("emissivity (‰)", Meaning::Unclear),
            ("gold (‰)", Meaning::Unclear),
            ("gold *100", Meaning::Unclear),
            ("emissivity of e-glass", of(Emissivity, false, "emissivity-of-e-glass")),
        ] {
            assert_eq!(values(header), meaning, "{header}");
        }
        let named =
            |name: &str, percent| Meaning::Values(Values { quantity: None, percent, name: name.to_owned() });
        assert_eq!(values("al2o3"), named("al2o3", false));
        assert_eq!(values("skin (%)"), named("skin", true));
        assert_eq!(values("sample A"), named("sample-a", false));
        assert_eq!(values("e-glass"), named("e-glass", false));
    }

    #[test]
    fn a_unit_that_is_not_stated_is_taken_only_where_it_is_the_only_one() {
        assert_eq!(unit_of_range("wavelength", (7.5, 14.0)), Some(SpectralUnit::Micrometre));
        assert_eq!(unit_of_range("wavelength", (350.0, 2500.0)), Some(SpectralUnit::Nanometre));
        assert_eq!(unit_of_range("wavelength", (400.0, 900.0)), None);
        assert_eq!(unit_of_range("wavenumber", (700.0, 1300.0)), Some(SpectralUnit::PerCentimetre));
        assert_eq!(unit_of_range("wavenumber", (7e4, 1.3e5)), None);
        assert_eq!(unit_of_range("frequency", (20.0, 40.0)), None);
    }
}
