//! How a spectrum is known: what it is, on what basis, from which source, under which licence.

use serde::{Deserialize, Serialize};
use std::fmt;

/// The kind of knowledge a spectrum rests on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Basis {
    /// n and k measured and tabulated; the emissivity follows by Fresnel's equations.
    #[serde(rename = "measured optical constants")]
    MeasuredOpticalConstants,
    /// A formula whose parameters were fitted to measurements and published.
    #[serde(rename = "published model")]
    PublishedModel,
    /// One number for all wavenumbers.
    #[serde(rename = "constant")]
    Constant,
    /// A surface put together by hand from others (roughness, area fractions): plausible, not measured.
    #[serde(rename = "model surface")]
    ModelSurface,
    /// A file or rows that the user supplied.
    #[serde(rename = "user file")]
    UserFile,
}

impl fmt::Display for Basis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::MeasuredOpticalConstants => "measured optical constants",
            Self::PublishedModel => "published model",
            Self::Constant => "constant",
            Self::ModelSurface => "model surface",
            Self::UserFile => "user file",
        })
    }
}

/// What a material is and how it is known. All fields are one line of text; empty where nothing is known.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Provenance {
    /// What the surface of the material is, in words.
    pub description: String,
    /// Group in lists, e.g. `metal`.
    pub category: String,
    /// Kind of knowledge, such as measured optical constants, a published model or a constant.
    pub basis: Basis,
    /// Publication or file from which the values are.
    pub source: String,
    /// Terms under which the numbers may be passed on.
    pub licence: String,
    /// Assumptions, and what a user should know before trusting it.
    pub note: String,
}

impl Provenance {
    /// Provenance of something the caller made.
    pub(super) fn given(basis: Basis, description: &str) -> Self {
        Self { basis, ..Self::of_file(description.to_owned(), "given by the user".to_owned(), "") }
    }

    /// Provenance of what a user's file holds.
    #[must_use]
    pub fn of_file(description: String, source: String, note: &str) -> Self {
        let (category, note) = ("user".to_owned(), note.to_owned());
        Self { description, category, basis: Basis::UserFile, source, licence: String::new(), note }
    }
}
