//! What is stated of the noise that readings share, and for what.

use crate::instrument::noise::NetdConditions;

/// What is stated of noise that readings share, K at the conditions of the NETD.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Deserialize, serde::Serialize)]
#[serde(deny_unknown_fields)]
pub struct PatternFigures {
    /// σ_VH, from pixel to pixel, K.
    pub pixel_k: Option<f64>,
    /// σ_V, from row to row, K.
    pub row_k: Option<f64>,
    /// σ_H, from column to column, K.
    pub column_k: Option<f64>,
    /// Of all readings of a band, from calibration to calibration, K.
    pub offset_k: Option<f64>,
    /// σ_TV, from row to row and frame to frame, K.
    pub temporal_row_k: Option<f64>,
    /// σ_TH, from column to column and frame to frame, K.
    pub temporal_column_k: Option<f64>,
    /// σ_T, from frame to frame, K.
    pub frame_k: Option<f64>,
    /// Time after which the fixed ones are new ones, s; never where `None`.
    pub drift_s: Option<f64>,
}

/// A term of the noise in three dimensions.
#[derive(Debug)]
pub(super) struct Term {
    pub(super) label: &'static str,
    pub(super) key: &'static str,
    pub(super) is_fixed: bool,
    /// Whether rows, and columns, have their own.
    pub(super) of_each: [bool; 2],
}

const fn term(label: &'static str, key: &'static str, is_fixed: bool, of_each: [bool; 2]) -> Term {
    Term { label, key, is_fixed, of_each }
}

/// In the order of the fields.
pub(super) const TERMS: [Term; 7] = [
    term("fixed pattern", "fixed_pattern", true, [true, true]),
    term("row noise", "row_noise", true, [true, false]),
    term("column noise", "column_noise", true, [false, true]),
    term("offset drift", "offset_drift", true, [false, false]),
    term("temporal row noise", "temporal_row_noise", false, [true, false]),
    term("temporal column noise", "temporal_column_noise", false, [false, true]),
    term("frame noise", "frame_noise", false, [false, false]),
];

impl PatternFigures {
    pub(super) const fn sigmas_k(&self) -> [Option<f64>; 7] {
        let Self { pixel_k, row_k, column_k, offset_k, .. } = *self;
        [pixel_k, row_k, column_k, offset_k, self.temporal_row_k, self.temporal_column_k, self.frame_k]
    }

    /// Keys of those of one kind, fixed or from frame to frame, that are not stated.
    #[must_use]
    pub fn unstated(&self, is_fixed: bool) -> Vec<&'static str> {
        let silent = TERMS.iter().zip(self.sigmas_k()).filter(|(_, sigma_k)| sigma_k.is_none());
        silent.filter(|(term, _)| term.is_fixed == is_fixed).map(|(term, _)| term.key).collect()
    }

    /// Whether nothing is stated.
    pub(in crate::instrument) fn is_silent(&self) -> bool {
        self.sigmas_k().iter().all(Option::is_none)
    }

    pub(super) const fn of_sigmas(
        [pixel_k, row_k, column_k, offset_k, temporal_row_k, temporal_column_k, frame_k]: [Option<f64>; 7],
        drift_s: Option<f64>,
    ) -> Self {
        Self { pixel_k, row_k, column_k, offset_k, temporal_row_k, temporal_column_k, frame_k, drift_s }
    }
}

/// The noise that readings of a camera share.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Pattern {
    /// What is stated of it.
    #[serde(flatten)]
    pub(in crate::instrument) stated: PatternFigures,
    /// Conditions for which the figures of the pattern are stated.
    pub(super) at: NetdConditions,
}

impl Pattern {
    /// What is stated, and the conditions for which it is.
    #[must_use]
    pub const fn new(stated: PatternFigures, at: NetdConditions) -> Self {
        Self { stated, at }
    }

    /// Keys of those of one kind, fixed or from frame to frame, that nobody stated.
    #[must_use]
    pub fn unstated(&self, is_fixed: bool) -> Vec<&'static str> {
        self.stated.unstated(is_fixed)
    }

    pub(super) fn sigmas_k(&self) -> [f64; 7] {
        self.stated.sigmas_k().map(Option::unwrap_or_default)
    }

    /// What of it each pixel has for itself.
    #[must_use]
    pub fn of_pixels(&self) -> Self {
        let PatternFigures { pixel_k, drift_s, .. } = self.stated;
        Self { stated: PatternFigures { pixel_k, drift_s, ..PatternFigures::default() }, at: self.at }
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_none(&self) -> bool {
        self.sigmas_k() == [0.0; 7]
    }

    /// Whether pixels share some of it.
    #[must_use]
    pub fn is_shared(&self) -> bool {
        self.sigmas_k()[1..].iter().any(|sigma_k| *sigma_k > 0.0)
    }

    /// Whether there is some that no number of frames averages away.
    #[must_use]
    pub fn has_fixed(&self) -> bool {
        self.stated.drift_s.is_none() && self.sigmas_k()[..4].iter().any(|sigma_k| *sigma_k > 0.0)
    }

    /// Share of the variance of a pattern that is left in the mean over a time, s.
    pub(super) fn left_after(&self, time_s: f64) -> f64 {
        let Some(drift_s) = self.stated.drift_s else { return 1.0 };
        let x = time_s / drift_s;
        // (2/x)(1 − (1 − e⁻ˣ)/x) loses its digits near 0, where it is 1 − x/3 + x²/12.
        if x < 1e-4 { 1.0 - x / 3.0 } else { 2.0 / x * (1.0 + (-x).exp_m1() / x) }
    }
}
