//! What is said of the model that a cube is decomposed with: a verdict, what pixels have in common, what may be otherwise than told.

use hadar_estimate::decompose::{Cause, Maps, flag};
use serde::Serialize;

/// What all pixels together say of the model.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModelJudged {
    /// Whether the cube follows it: `not-rejected`, `rejected`, `not-judged`, or `shared-not-told`.
    pub verdict: ModelVerdict,
    /// Number of pixels that have a p-value.
    pub pixels: usize,
    /// Mean of their p-values from 1e-4 on: a half for a right model; not with stated errors of the library.
    pub p_value_mean: Option<f64>,
    /// Deviations by which that is below a half.
    pub p_value_deviations: Option<f64>,
    /// Share of the pixels that no material fits.
    pub unfit: Option<f64>,
    /// Pixels with one candidate that fit, of which bands and causes are told.
    pub pixels_asked: usize,
    /// Mean χ² of a degree of freedom of these pixels: 1 for a right model.
    pub chi_square_reduced: Option<f64>,
    /// What these pixels have in common in each band, in rising wavenumber.
    pub bands: Vec<BandResidual>,
    /// What may be otherwise than told, what explains most first.
    pub causes: Vec<CauseRow>,
}

/// Whether a cube follows its model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum ModelVerdict {
    /// Nothing speaks against it.
    NotRejected,
    /// The pixels together do not follow it.
    Rejected,
    /// It was not asked.
    NotJudged,
    /// Unknowns that the whole cube shares are not told well enough to decide a material.
    SharedNotTold,
}

impl ModelVerdict {
    /// Whether nothing is decided without the condition 'if the model holds'.
    #[must_use]
    pub const fn takes_back(self) -> bool {
        matches!(self, Self::Rejected | Self::SharedNotTold)
    }
}

/// What pixels have in common in a band.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BandResidual {
    /// Its place, from 0, in rising wavenumber.
    pub band: usize,
    /// Mean wavenumber of the band, cm⁻¹.
    pub wavenumber_cm1: f64,
    /// Mean residual of a pixel, in deviations of its noise.
    pub residual: f64,
    /// The same in deviations of the mean.
    pub deviations: f64,
}

/// Something that may be otherwise than told, and what it would explain.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CauseRow {
    /// `gain`, `wavelength-shift`, `light-scale`, `light-tilt`, `light-path`, `light-temperature`, `lighting-total`, `light-missing`, `air`, `band` or
    /// `noise`.
    pub cause: &'static str,
    /// Which of the surroundings, from 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub light: Option<usize>,
    /// Which band, from 0 in rising wavenumber.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub band: Option<usize>,
    /// By how much, were it that alone.
    pub estimate: f64,
    /// Standard deviation of the estimated change, in its unit.
    pub sigma: f64,
    /// `cm^-1`, `K`, `m`, or nothing for a share.
    pub unit: &'static str,
    /// By how much χ² of the pixels asked falls by it.
    pub gain_chi_square: f64,
    /// By how many of its deviations a temperature moves then, rms over the pixels.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub temperature_moved: Option<f64>,
    /// Whether it explains at least half as much as the best: intervals hold what it would do.
    pub may_be: bool,
}

/// Whether a pixel has a p-value that counts here: `None` without one, else whether some material fits.
pub(crate) fn fits(maps: &Maps, i: usize) -> Option<bool> {
    let flags = maps.flags.get(i).copied().unwrap_or(flag::SKIPPED);
    let told = flags & (flag::SKIPPED | flag::NO_INFORMATION) == 0 && !maps.p_value.get(i)?.is_nan();
    told.then_some(flags & flag::NO_FIT == 0)
}

/// Pixels that some material fits, the sum of their p-values, and pixels that none fits.
pub(crate) fn p_values(maps: &Maps) -> (usize, f64, usize) {
    (0..maps.material.len()).fold((0, 0.0, 0), |(fitting, sum, unfit), i| match fits(maps, i) {
        Some(true) => (fitting + 1, sum + f64::from(maps.p_value[i]), unfit),
        Some(false) => (fitting, sum, unfit + 1),
        None => (fitting, sum, unfit),
    })
}

/// Name, light, band and unit of a cause.
pub(crate) fn said(cause: &Cause) -> (&'static str, Option<usize>, Option<usize>, &'static str) {
    match cause {
        Cause::Gain => ("gain", None, None, ""),
        Cause::WavelengthShift(_) => ("wavelength-shift", None, None, "cm^-1"),
        Cause::LightScale(light) => ("light-scale", Some(*light), None, ""),
        Cause::LightShape { light, .. } => ("light-tilt", Some(*light), None, ""),
        Cause::LightPath { light, .. } => ("light-path", Some(*light), None, ""),
        Cause::LightTemperature { light, .. } => ("light-temperature", Some(*light), None, "K"),
        Cause::LightingTotal => ("lighting-total", None, None, ""),
        Cause::LightMissing { .. } => ("light-missing", None, None, ""),
        Cause::Air { .. } => ("air", None, None, "m"),
        Cause::Band(band) => ("band", None, Some(*band), ""),
    }
}
