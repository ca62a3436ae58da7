//! Errors that counts of all pixels have alike, as by the calibration that they went through.
//!
//! Counts of band w are off by c_w z_w in every pixel, z_w of deviation 1 and one for each band, and by t_w z, z one for all bands. Pixels do
//! not average them down. The scores of unknowns that the whole cube shares ([`super::shared`]) are off by Σ_w a_w (c_w z_w + t_w z),
//! a_w = Σᵢ dᵢ_w/σᵢ_w, d the slopes in deviations of the noise without what temperature and lighting explain ([`super::judge()`]).
//!
//! Units: counts for c and t. Assumption: to first order; the pixels are fitted with c as noise of their own beside the rest.

use nalgebra::DMatrix;

/// Deviations of what counts of all pixels are off by alike, of every band; empty where nothing is known of it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Alike {
    /// Of each band for itself, counts.
    pub of_bands: Vec<f64>,
    /// Of all bands together, counts.
    pub together: Vec<f64>,
}

impl Alike {
    /// Whether nothing is known of it.
    #[must_use]
    pub fn is_none(&self) -> bool {
        self.of_bands.is_empty() && self.together.is_empty()
    }

    /// What the scores are off by: a column for each z, `lean` the a of every unknown over the bands `used`.
    pub(super) fn of_scores(&self, lean: &[f64], used: &[usize]) -> DMatrix<f64> {
        let bands = used.len();
        let unknowns = lean.len() / bands.max(1);
        let a = |i: usize, w: usize| lean.get(i * bands + w).copied().unwrap_or(0.0);
        let of =
            |list: &[f64], w: usize| used.get(w).and_then(|band| list.get(*band)).copied().unwrap_or(0.0);
        DMatrix::from_fn(unknowns, bands + 1, |i, w| match w < bands {
            true => a(i, w) * of(&self.of_bands, w),
            false => (0..bands).map(|w| a(i, w) * of(&self.together, w)).sum(),
        })
    }
}
