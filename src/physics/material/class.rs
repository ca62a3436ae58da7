//! Classes: several spectra that stand for one kind of surface, such as any skin or any paint.
//!
//! A class has members, each a material with a weight w_i ≥ 0, Σw_i = 1: names of a library, files, all spectra of a folder, or
//! those of a library or folder whose names match a pattern (`*` any characters, `?` one). Weights are those of what was written; a folder's
//! is shared by its spectra in equal parts.
//!
//! * Every member is a surface of its own; what is asked of a class is asked of all of them.
//! * With mixtures, surfaces of Σ c_i e_i(ν), c_i ≥ 0, Σc_i = 1, belong to the class too (parts of one temperature and lighting
//!   that no pixel resolves).
//! * With a spread the emissivities are uncertain: by a stated deviation and correlation length, or, the class standing as its mean
//!   ē = Σw_i e_i, by the sample covariance Σw_i (e_i − ē)(e_i − ē)ᵀ/(1 − Σw_i²).

use crate::error::{Error, Result, check};
use std::path::PathBuf;

/// Endings of files of spectra; OPUS counts its own, `.0`, `.1`, …
pub const ENDINGS: [&str; 15] = [
    ".csv", ".txt", ".tsv", ".tab", ".asc", ".dpt", ".xy", ".jdx", ".dx", ".jcm", ".jcamp", ".sli", ".spc",
    ".asd", ".0",
];
/// Digits of the longest number that OPUS gives a file.
const OPUS_DIGITS: usize = 4;

/// Whether a file is called as files of spectra are ([`ENDINGS`], in any case; a number of at most four digits, as OPUS has them).
#[must_use]
pub fn is_spectra(name: &str) -> bool {
    let ending = name.rfind('.').and_then(|dot| name.get(dot..));
    let is_opus = |ending: &str| {
        let number = ending.trim_start_matches('.');
        (1..=OPUS_DIGITS).contains(&number.len()) && number.bytes().all(|byte| byte.is_ascii_digit())
    };
    ending.is_some_and(|ending| {
        ENDINGS.iter().any(|known| ending.eq_ignore_ascii_case(known)) || is_opus(ending)
    })
}

/// A material by name in a library, or files with spectra.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum MaterialRef {
    /// Name in the library, e.g. `aluminium`; in a class also a pattern for names.
    Name(String),
    /// Path of a CSV or ECOSTRESS file; in a class also of a folder, or of a pattern for names in one.
    File(PathBuf),
}

/// How the emissivities of a class scatter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Spread {
    /// Gaussian errors of every member, of this root mean square and correlation length (cm⁻¹).
    Stated {
        /// Root mean square error of an emissivity.
        emissivity_error: f64,
        /// Difference of wavenumbers over which the errors lose their correlation, cm⁻¹.
        correlation_cm1: f64,
    },
    /// The class is its mean, and its members are a sample of what scatters about it.
    Sample,
}

impl Spread {
    /// What is stated of a scatter, if anything is.
    ///
    /// # Errors
    /// A sample covariance beside stated errors, a correlation of none, an error outside [0, 1], a length that is not above 0.
    pub fn stated(
        sample: bool,
        emissivity_error: Option<f64>,
        correlation_cm1: Option<f64>,
    ) -> Result<Option<Self>> {
        match (sample, emissivity_error, correlation_cm1) {
            (true, None, None) => Ok(Some(Self::Sample)),
            (true, ..) => Err(Error::malformed(
                "a sample covariance beside stated errors",
                "keep covariance, or emissivity_error with its correlation",
            )),
            (false, None, None) => Ok(None),
            (false, Some(error), Some(length)) => Ok(Some(Self::Stated {
                emissivity_error: check::unit_interval("emissivity_error", error)?,
                correlation_cm1: check::positive("correlation", length, "cm^-1")?,
            })),
            (false, Some(_), None) => Err(Error::malformed(
                "errors of an emissivity without their correlation",
                "write the wavenumbers over which they stay alike, as in correlation = \"50 cm^-1\"",
            )),
            (false, None, Some(_)) => {
                Err(Error::malformed("a correlation of no errors", "write emissivity_error = 0.01 too"))
            }
        }
    }
}

/// A class that a library has.
#[derive(Debug, Clone, PartialEq)]
pub struct LibraryClass {
    /// What it is made of.
    pub spec: ClassSpec,
    /// What it is, in one line; empty where its manifest does not say.
    pub description: String,
    /// Other words for it. Whoever writes one of them in the place of a material is told this class's name.
    pub also: Vec<String>,
    /// What belongs to it and is not in it, since no spectrum is known; empty where nothing is missing.
    pub without: Vec<String>,
}

/// What a class is made of, before anything is read.
#[derive(Debug, Clone, PartialEq)]
pub struct ClassSpec {
    /// Its members.
    pub materials: Vec<MaterialRef>,
    /// A weight for each of them; all the same if silent.
    pub weights: Option<Vec<f64>>,
    /// Whether mixtures of the members belong to it.
    pub mixtures: bool,
    /// How its emissivities scatter.
    pub spread: Option<Spread>,
}
