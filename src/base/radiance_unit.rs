//! Units of spectral radiance, and what one is per photon or watt and cm⁻¹.
//!
//! A unit is a product of powers: a power (W, J s⁻¹, erg s⁻¹, or photons s⁻¹), an area (m², cm²), a solid angle (sr), and what it is spread over: wavenumber
//! (cm⁻¹, m⁻¹), wavelength (µm, nm, m) or frequency (Hz, THz). What it is spread over follows from the length and time that are left:
//!
//! | left | spread over | per cm⁻¹ |
//! |---|---|---|
//! | m⁻¹ | wavenumber | L_ν̃ |
//! | m⁻³ | wavelength | L_ν̃ = λ² L_λ |
//! | m⁻² s | frequency | L_ν̃ = c L_f |
//!
//! and L = hcν̃ times the photon radiance. A band is converted at its centre: of a radiance that is smooth in it the relative error is of the order of
//! (Δν̃/ν̃)².
//!
//! Spellings: `W m^-2 sr^-1 per cm^-1`, `W/(m2 sr um)`, `mW m-2 sr-1 (cm-1)-1`, `W·m⁻²·sr⁻¹·µm⁻¹`, `photons s-1 m-2 sr-1 um-1`, `uflick`; powers
//! of what stands in brackets; what follows a `/` or `per` alone is divided by. Source: definitions of the SI; flick: 1 W cm⁻² sr⁻¹ µm⁻¹; Jy: 10⁻²⁶ W m⁻² Hz⁻¹.

use crate::error::{Error, Result};
use crate::units::{PLANCK_J_S, SPEED_OF_LIGHT_M_S, with_plain_micro};

/// What a spectral radiance is counted in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RadianceUnit {
    /// Whether photons are counted, not energy.
    photons: bool,
    /// What one is in W (or photons s⁻¹) m⁻² sr⁻¹ per m⁻¹, m or Hz.
    factor: f64,
    over: Over,
}

/// What a radiance is spread over.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Over {
    Wavenumber,
    Wavelength,
    Frequency,
}

/// Powers of power, photons, length, time and solid angle, and a factor.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Product {
    factor: f64,
    powers: [i32; 5],
}

const NOTHING: Product = Product { factor: 1.0, powers: [0; 5] };
const CENTIMETRE: Product = Product { factor: 1e-2, powers: [0, 0, 1, 0, 0] };
const WATT: usize = 0;
const PHOTON: usize = 1;
const METRE: usize = 2;
const SECOND: usize = 3;
const STERADIAN: usize = 4;

/// Names with their factors and powers; prefixes may stand before those that take them.
const NAMES: &[(&str, f64, [i32; 5], bool)] = &[
    ("W", 1.0, [1, 0, 0, 0, 0], true),
    ("watt", 1.0, [1, 0, 0, 0, 0], true),
    ("watts", 1.0, [1, 0, 0, 0, 0], true),
    ("J", 1.0, [1, 0, 0, 1, 0], true),
    ("joule", 1.0, [1, 0, 0, 1, 0], true),
    ("erg", 1e-7, [1, 0, 0, 1, 0], false),
    ("ergs", 1e-7, [1, 0, 0, 1, 0], false),
    ("Jy", 1e-26, [1, 0, -2, 1, 0], true),
    ("jansky", 1e-26, [1, 0, -2, 1, 0], true),
    ("photon", 1.0, [0, 1, 0, 0, 0], false),
    ("photons", 1.0, [0, 1, 0, 0, 0], false),
    ("ph", 1.0, [0, 1, 0, 0, 0], false),
    ("m", 1.0, [0, 0, 1, 0, 0], true),
    ("meter", 1.0, [0, 0, 1, 0, 0], true),
    ("metre", 1.0, [0, 0, 1, 0, 0], true),
    ("micron", 1e-6, [0, 0, 1, 0, 0], false),
    ("s", 1.0, [0, 0, 0, 1, 0], true),
    ("sec", 1.0, [0, 0, 0, 1, 0], false),
    ("second", 1.0, [0, 0, 0, 1, 0], false),
    ("Hz", 1.0, [0, 0, 0, -1, 0], true),
    ("hertz", 1.0, [0, 0, 0, -1, 0], true),
    ("sr", 1.0, [0, 0, 0, 0, 1], false),
    ("ster", 1.0, [0, 0, 0, 0, 1], false),
    ("steradian", 1.0, [0, 0, 0, 0, 1], false),
];
const PREFIXES: &[(&str, f64)] = &[
    ("", 1.0),
    ("micro", 1e-6),
    ("milli", 1e-3),
    ("centi", 1e-2),
    ("nano", 1e-9),
    ("kilo", 1e3),
    ("mega", 1e6),
    ("giga", 1e9),
    ("tera", 1e12),
    ("m", 1e-3),
    ("u", 1e-6),
    ("n", 1e-9),
    ("c", 1e-2),
    ("k", 1e3),
    ("M", 1e6),
    ("G", 1e9),
    ("T", 1e12),
];
/// Units with a name of their own, in W m⁻² sr⁻¹ per m of wavelength.
const FLICKS: &[(&str, f64)] = &[
    ("flick", 1e10),
    ("flicks", 1e10),
    ("uflick", 1e4),
    ("uflicks", 1e4),
    ("microflick", 1e4),
    ("microflicks", 1e4),
    ("mflick", 1e7),
    ("milliflick", 1e7),
];
/// Longest text that is a unit, bytes.
const LONGEST: usize = 80;

impl RadianceUnit {
    /// The unit of the paper and of cubes that state none, W m⁻² sr⁻¹ per cm⁻¹.
    pub const PER_WAVENUMBER: Self = Self { photons: false, factor: 1e-2, over: Over::Wavenumber };

    /// The unit that a text says.
    ///
    /// # Errors
    /// What is none: an unknown name, or a product that is no spectral radiance, with what it would have to be.
    ///
    /// ```
    /// use hadar::radiance_unit::RadianceUnit;
    /// let unit = RadianceUnit::spelt("uW cm-2 sr-1 um-1")?;
    /// assert_eq!(unit, RadianceUnit::spelt("microflick")?);
    /// // 1 W m⁻² sr⁻¹ µm⁻¹ at 10 µm is 0.01 W m⁻² sr⁻¹ per cm⁻¹: 1 µm of 10 µm is 100 of 1000 cm⁻¹.
    /// let watts = RadianceUnit::spelt("W/(m^2 sr um)")?.watts_per_cm1(1000.0);
    /// assert!((watts / 0.01 - 1.0).abs() < 1e-14);
    /// assert!(RadianceUnit::spelt("W m-2 sr-1 cm-1").is_err());
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn spelt(text: &str) -> Result<Self> {
        let refused = |why: &str| {
            Err(Error::malformed(
                format!("`{}` is no unit of spectral radiance: {why}", shown(text)),
                "write one as in \"W m^-2 sr^-1 per cm^-1\", \"W m^-2 sr^-1 um^-1\", \"microflick\" or \"photons s^-1 m^-2 sr^-1 um^-1\"",
            ))
        };
        if text.len() > LONGEST {
            return refused("it is too long");
        }
        let plain = plain(text);
        if let Some((_, factor)) = FLICKS.iter().find(|(name, _)| plain.trim().eq_ignore_ascii_case(name)) {
            return Ok(Self { photons: false, factor: *factor, over: Over::Wavelength });
        }
        let mut reader = Reader { rest: plain.trim(), per_cm: false };
        let product = match reader.product() {
            Ok(product) if reader.rest.is_empty() => product,
            Ok(_) => return refused(&format!("what is `{}`?", shown(reader.rest))),
            Err(what) => return refused(&what),
        };
        let Product { factor, powers } = product;
        let (photons, per_s) = match (powers[WATT], powers[PHOTON]) {
            (1, 0) => (false, 0),
            (0, 1) => (true, -1),
            _ => return refused("it has neither one power nor photons per second"),
        };
        if powers[STERADIAN] != -1 {
            return refused("it is not per sr");
        }
        let over = match (powers[METRE], powers[SECOND] - per_s) {
            (-1, 0) => Over::Wavenumber,
            // Per cm of wavelength is nobody's unit: it is meant per cm⁻¹, or not.
            (-3, 0) if reader.per_cm => {
                return refused("`cm-1` is per cm; per cm^-1 is \"per cm^-1\" or \"(cm-1)-1\"");
            }
            (-3, 0) => Over::Wavelength,
            (-2, 1) => Over::Frequency,
            (-2, 0) => return refused("it is not spread over wavenumber, wavelength or frequency"),
            _ => return refused("it is not per area and per wavenumber, wavelength or frequency"),
        };
        Ok(Self { photons, factor, over })
    }

    /// What one is in W m⁻² sr⁻¹ per cm⁻¹ at a wavenumber.
    #[must_use]
    pub fn watts_per_cm1(self, wavenumber_cm1: f64) -> f64 {
        let per_m1 = 100.0 * wavenumber_cm1;
        let spread = match self.over {
            Over::Wavenumber => 1.0,
            Over::Wavelength => 1.0 / per_m1 / per_m1,
            Over::Frequency => SPEED_OF_LIGHT_M_S,
        };
        let joules = if self.photons { PLANCK_J_S * SPEED_OF_LIGHT_M_S * per_m1 } else { 1.0 };
        100.0 * self.factor * spread * joules
    }

    /// What one is in photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹ at a wavenumber.
    #[must_use]
    pub fn photons_per_cm1(self, wavenumber_cm1: f64) -> f64 {
        self.watts_per_cm1(wavenumber_cm1) / (PLANCK_J_S * SPEED_OF_LIGHT_M_S * 100.0 * wavenumber_cm1)
    }

    /// Whether the same number means the same in two units, at every wavenumber.
    #[must_use]
    pub fn is(self, other: Self) -> bool {
        (self.photons, self.over) == (other.photons, other.over)
            && (self.factor / other.factor - 1.0).abs() < 1e-12
    }
}

/// Without what decorates it, superscripts as powers.
fn plain(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut was_raised = false;
    for char in with_plain_micro(text).chars() {
        let raised = match char {
            '⁻' => Some('-'),
            '⁰' => Some('0'),
            '¹' => Some('1'),
            '²' => Some('2'),
            '³' => Some('3'),
            _ => None,
        };
        if raised.is_some() && !was_raised {
            out.push('^');
        }
        was_raised = raised.is_some();
        match (raised, char) {
            (Some(digit), _) => out.push(digit),
            (None, '−' | '–') => out.push('-'),
            (None, '·' | '⋅' | '×' | ',' | '_') => out.push(' '),
            (None, '[' | '{') => out.push('('),
            (None, ']' | '}') => out.push(')'),
            (None, '$' | '\\') => {}
            (None, other) => out.push(other),
        }
    }
    out
}

fn shown(text: &str) -> String {
    text.chars().take(LONGEST).collect()
}

/// Reads a product from the left.
struct Reader<'a> {
    rest: &'a str,
    /// Whether cm^-1 is one of the factors, however it is spelt.
    per_cm: bool,
}

impl Reader<'_> {
    fn product(&mut self) -> std::result::Result<Product, String> {
        let mut all = NOTHING;
        let mut sign = 1;
        loop {
            self.skip();
            if self.rest.is_empty() || self.rest.starts_with(')') {
                return if sign == 1 { Ok(all) } else { Err("it ends with a division".into()) };
            }
            if let Some(rest) = self.rest.strip_prefix('/').or_else(|| word(self.rest, "per")) {
                (self.rest, sign) = (rest, -1);
                continue;
            }
            let one = self.factor()?;
            let raised = self.power()?.unwrap_or(1) * sign;
            self.per_cm |= raised == -1 && one == CENTIMETRE;
            all = all.times(one, raised)?;
            sign = 1;
        }
    }

    fn factor(&mut self) -> std::result::Result<Product, String> {
        if let Some(rest) = self.rest.strip_prefix('(') {
            self.rest = rest;
            let inner = self.product()?;
            let rest = self.rest.strip_prefix(')').ok_or("a bracket is not closed")?;
            self.rest = rest;
            return Ok(inner);
        }
        let end = self.rest.find(|char: char| !char.is_alphabetic()).unwrap_or(self.rest.len());
        let (name, rest) = self.rest.split_at(end);
        if name.is_empty() {
            // 1/… and 1e-6 W … are numbers.
            let digits =
                |text: &str| text.find(|c: char| !(c.is_ascii_digit() || c == '.')).unwrap_or(text.len());
            let mut end = digits(self.rest);
            let signed =
                self.rest[end..].strip_prefix(['e', 'E']).map(|text| text.trim_start_matches(['+', '-']));
            if let Some(exponent) = signed.filter(|text| text.starts_with(|c: char| c.is_ascii_digit())) {
                end = self.rest.len() - exponent.len() + digits(exponent);
            }
            let (number, rest) = self.rest.split_at(end);
            let factor: f64 = number.parse().map_err(|_| format!("what is `{}`?", shown(self.rest)))?;
            self.rest = rest;
            return Ok(Product { factor, ..NOTHING });
        }
        self.rest = rest;
        named(name).ok_or_else(|| unknown(name))
    }

    /// The power of what was read, if one stands behind it.
    fn power(&mut self) -> std::result::Result<Option<i32>, String> {
        let after = self.rest.trim_start_matches(['^', '*']);
        let is_marked = after.len() < self.rest.len() && !self.rest.starts_with("* ");
        let (inner, closes) = match after.strip_prefix('(') {
            Some(inner) if is_marked => (inner, true),
            _ => (after, false),
        };
        let end = inner
            .char_indices()
            .find(|(at, char)| !(char.is_ascii_digit() || *at == 0 && matches!(char, '-' | '+')))
            .map_or(inner.len(), |(at, _)| at);
        let (digits, rest) = inner.split_at(end);
        let Ok(power) = digits.parse::<i32>() else { return Ok(None) };
        if power.abs() > 9 {
            return Err(format!("a power of {power}"));
        }
        self.rest = if closes { rest.strip_prefix(')').ok_or("a bracket is not closed")? } else { rest };
        Ok(Some(power))
    }

    fn skip(&mut self) {
        self.rest = self.rest.trim_start_matches([' ', '\t', '*', '.']);
    }
}

/// What follows a word, if a text begins with it.
fn word<'a>(text: &'a str, word: &str) -> Option<&'a str> {
    text.strip_prefix(word).filter(|rest| rest.starts_with([' ', '(']))
}

/// What is said of a name that is none, with those that are like it.
fn unknown(name: &str) -> String {
    let prefixed = |(own, _, _, takes_prefix): &(&str, f64, [i32; 5], bool)| -> Vec<String> {
        // `cm` and `centimetre`, not `centim`.
        let suits = |prefix: &str| *takes_prefix && (prefix.len() > 1) == (own.len() > 2);
        let prefixes = PREFIXES.iter().filter(|(prefix, _)| prefix.is_empty() || suits(prefix));
        prefixes.map(|(prefix, _)| format!("{prefix}{own}")).collect()
    };
    let names: Vec<String> =
        NAMES.iter().flat_map(prefixed).chain(FLICKS.iter().map(|(flick, _)| (*flick).to_owned())).collect();
    let as_long = names.iter().map(String::as_str).filter(|own| own.len().abs_diff(name.len()) < 3);
    match Error::unknown_name("unit", &shown(name), as_long) {
        Error::UnknownName { name, nearest, .. } if !nearest.is_empty() => {
            format!("what is `{name}`? The nearest are `{}`", nearest.join("`, `"))
        }
        _ => format!("what is `{}`?", shown(name)),
    }
}

fn named(name: &str) -> Option<Product> {
    let of = |wanted: &str| {
        let found = NAMES.iter().find(|(own, ..)| *own == wanted)?;
        let (_, factor, powers, takes_prefix) = *found;
        Some((Product { factor, powers }, takes_prefix))
    };
    PREFIXES.iter().find_map(|(prefix, scale)| {
        let (one, takes_prefix) = of(name.strip_prefix(prefix)?)?;
        (prefix.is_empty() || takes_prefix).then(|| Product { factor: one.factor * scale, ..one })
    })
}

impl Product {
    fn times(self, other: Self, raised: i32) -> std::result::Result<Self, String> {
        let mut powers = self.powers;
        powers.iter_mut().zip(other.powers).for_each(|(own, more)| *own += more * raised);
        let factor = self.factor * other.factor.powi(raised);
        match factor.is_finite() && factor > 0.0 {
            true => Ok(Self { factor, powers }),
            false => Err("a factor that is none".into()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planck;
    use proptest::prelude::*;

    #[test]
    fn many_spellings_of_one_unit() {
        for (reference, spellings) in [
            (
                "W m^-2 sr^-1 per cm^-1",
                &[
                    "W m-2 sr-1 (cm-1)-1",
                    "W/(m2 sr cm-1)",
                    "W/m2/sr/cm-1",
                    "W m⁻² sr⁻¹ (cm⁻¹)⁻¹",
                    "W*m**-2*sr**-1*cm",
                    "W.m-2.sr-1.cm",
                    "W cm m^-2 sr^-1",
                    "1e0 W m-2 sr-1 cm",
                    "watt / (meter^2 steradian) / (1/cm)",
                    "W/(m^{2} sr cm^{-1})",
                    "1000 mW m-2 sr-1 (cm-1)-1",
                    "1e-3 kW m-2 sr-1 per cm^-1",
                    "1E+3 mW m-2 sr-1 per cm^-1",
                    "0.0001 W cm-2 sr-1 (cm-1)-1",
                ][..],
            ),
            (
                "W m-2 sr-1 um-1",
                &[
                    "W/m^2/um/sr",
                    "W m⁻² sr⁻¹ µm⁻¹",
                    "W/(m2*sr*um)",
                    "W m-2 sr-1 micron-1",
                    "mW m-2 sr-1 nm-1",
                    "W m-2 sr-1 per um",
                    "kW m-2 sr-1 mm-1",
                    "W / (m2 sr micrometer)",
                ],
            ),
            (
                "uW cm-2 sr-1 um-1",
                &["microflick", "uflick", "µflick", "0.01 W m-2 sr-1 um-1", "μW/(cm² sr μm)"],
            ),
            ("photons s-1 m-2 sr-1 um-1", &["ph/(s m2 sr um)", "photon s^-1 m^-2 sr^-1 um^-1"]),
            ("1e-20 W m-2 sr-1 Hz-1", &["MJy/sr", "MJy sr-1", "megajansky per sr", "1e6 Jy/sr"]),
            (
                "1e-3 W m-2 sr-1 per cm^-1",
                &["erg s-1 cm-2 sr-1 (cm-1)-1", "erg/(s cm2 sr cm-1)", "1e-3 J s-1 m-2 sr-1 (cm-1)-1"],
            ),
            ("W m-2 sr-1 Hz-1", &["W m-2 sr-1 s", "W/(m2 sr Hz)", "1000000000000 W m-2 sr-1 THz-1"]),
        ] {
            let unit = RadianceUnit::spelt(reference).unwrap();
            for spelling in spellings {
                let found =
                    RadianceUnit::spelt(spelling).unwrap_or_else(|error| panic!("{spelling}: {error}"));
                assert!(found.is(unit), "{spelling}: {found:?} {unit:?}");
            }
        }
        assert!(RadianceUnit::spelt("W m^-2 sr^-1 per cm^-1").unwrap().is(RadianceUnit::PER_WAVENUMBER));
    }

    #[test]
    fn what_is_no_spectral_radiance_is_refused() {
        for (text, why) in [
            ("W m-2 sr-1 cm-1", "per cm^-1 is"),
            ("W m-2 sr-1", "not spread over"),
            ("W m-2 um-1", "not per sr"),
            ("K", "what is `K`"),
            ("m-2 sr-1 um-1", "neither one power"),
            ("DN", "what is `DN`"),
            ("micrflick", "`microflick`"),
            ("W m-2 sr-1 per cn^-1", "`cm`"),
            ("photons m-2 sr-1 um-1", "not per area and per"),
            ("W m-2 sr-1 furlong-1", "what is `furlong`"),
            ("W m-2 sr-1 (um-1", "not closed"),
            ("W m-2 sr-1 um-1 )", "what is `)`"),
            ("W m-2 sr-1 /", "ends with a division"),
            ("W^99 m-2 sr-1 um-1", "a power of 99"),
            ("", "neither one power"),
            (&"W ".repeat(99), "too long"),
        ] {
            let error = RadianceUnit::spelt(text).unwrap_err().to_string();
            assert!(error.contains(why), "{text}: {error}");
        }
    }

    /// Per cm of wavelength is not meant, however it is spelt.
    #[test]
    fn per_centimetre_is_refused_in_every_spelling() {
        for spelling in [
            "W*m^-2*sr^-1*cm^-1",
            "W*m**-2*sr**-1*cm**-1",
            "W m^{-2} sr^{-1} cm^{-1}",
            "W m$^{-2}$ sr$^{-1}$ cm$^{-1}$",
            "W m-2 sr-1 (cm-1)",
            "W m-2 sr-1 [cm-1]",
            "W m-2 sr-1 (1/cm)",
            "W/m^2/sr*cm^-1",
            "W m⁻² sr⁻¹ cm⁻¹",
            "W·m⁻²·sr⁻¹·cm⁻¹",
            "uW cm-2 sr-1 cm-1",
            "W m-2 sr-1 centimetre^-1",
        ] {
            let error = RadianceUnit::spelt(spelling).expect_err(spelling).to_string();
            assert!(error.contains("per cm^-1 is"), "{spelling}: {error}");
        }
    }

    /// Planck's law in textbook forms, per wavelength, frequency and wavenumber: all mean the same blackbody.
    #[test]
    fn one_blackbody_in_every_unit() {
        let (nu, kelvin) = (950.0, 310.0);
        let x = crate::units::SECOND_RADIATION_CM_K * nu / kelvin;
        let (h, c) = (PLANCK_J_S, SPEED_OF_LIGHT_M_S);
        let (lambda, f) = (0.01 / nu, 100.0 * nu * c);
        let per_m = 2.0 * h * c * c / lambda.powi(5) / x.exp_m1();
        let per_hz = 2.0 * h * f.powi(3) / (c * c) / x.exp_m1();
        let per_m1 = 2.0 * h * c * c * (100.0 * nu).powi(3) / x.exp_m1();
        let photons = planck::photon_radiance(nu, kelvin);
        for (text, value) in [
            ("W m-2 sr-1 um-1", per_m * 1e-6),
            ("mW m-2 sr-1 nm-1", per_m * 1e-6),
            ("microflick", per_m * 1e-4),
            ("W m-3 sr-1", per_m),
            ("W m-2 sr-1 Hz-1", per_hz),
            ("W m-2 sr-1 per cm^-1", per_m1 * 100.0),
            ("W m-2 sr-1 per m^-1", per_m1),
            ("mW/(m2 sr cm-1)", per_m1 * 1e5),
            ("photons s-1 m-2 sr-1 um-1", per_m * 1e-6 * lambda / (h * c)),
            ("photons s-1 cm-2 sr-1 (cm-1)-1", per_m1 * 100.0 * lambda / (h * c) * 1e-4),
        ] {
            let unit = RadianceUnit::spelt(text).unwrap();
            assert!((value * unit.photons_per_cm1(nu) / photons - 1.0).abs() < 1e-12, "{text}");
            let watts = value * unit.watts_per_cm1(nu);
            assert!((watts / (per_m1 * 100.0) - 1.0).abs() < 1e-12, "{text}");
        }
    }

    proptest! {
        #[test]
        fn no_text_panics(text in ".{0,60}") {
            let _ = RadianceUnit::spelt(&text);
        }

        #[test]
        fn no_product_panics(parts in prop::collection::vec("[Wmunkcsr/().^*-]{1,3}[0-9]? ?", 0..12)) {
            let _ = RadianceUnit::spelt(&parts.concat());
        }
    }
}
