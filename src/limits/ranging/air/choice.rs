//! The few bands that tell most of a distance.
//!
//! What a set of bands tells of z, the other unknowns with their priors left to be fitted, is the least over c of
//! Σ (s_z − c·s)² over its bands and the priors: four times the square of the distance d that
//! [`crate::identifiability::selection`] chooses bands by. Its proof holds here word for word: at any fixed c the sum of the N largest
//! terms, with those of the priors, is more than any N bands can tell; the least such sum that is found bounds them all.
//!
//! Assumption: each band is exposed and noisy as before, however few are read.

use super::{AirSolver, AirState};
use crate::error::{Error, Result};
use crate::fisher::Counting;
use crate::identifiability::selection::best_bands;

/// Unknowns beside which bands are chosen, at most: a search weighs their square for every choice it looks at.
const MOST_UNKNOWNS: usize = 100;

/// A choice of bands.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct AirChoice {
    /// Indices of the bands, rising.
    pub bands: Vec<usize>,
    /// Least error of the distance with them, m.
    pub sigma_m: f64,
    /// No choice of as many has a smaller one, m: proved.
    pub sigma_least_m: f64,
    /// With all bands, m.
    pub sigma_all_bands_m: f64,
    /// Whether the choice is proved to be the best.
    pub exact: bool,
}

impl AirSolver<'_> {
    /// The `count` bands with the least error of the distance in `state`.
    ///
    /// # Errors
    /// As [`AirSolver::bound`]; a number of bands outside 1 to all of them, or too few to tell the distance from what is unknown;
    /// more than 100 unknowns.
    pub fn best_bands(&self, state: &AirState, counting: &Counting, count: usize) -> Result<AirChoice> {
        let unknowns = self.parameters(self.modes(state, counting)?.len()).len();
        if unknowns > MOST_UNKNOWNS {
            let expected = format!(
                "at most {MOST_UNKNOWNS} to choose bands beside, modes of the emissivity included: state a longer correlation of its errors, or \
                 take fewer bands"
            );
            return Err(Error::out_of_range("number of unknowns", unknowns as f64, "", expected));
        }
        let scores = self.selection_scores(state, counting)?;
        let found = best_bands(&[scores], count)?;
        let quality = found.quality;
        if quality.distance_all_bands > 0.0 && count < quality.fewest {
            let expected = format!(
                "at least {}, one more than there are unknowns without a prior besides the distance",
                quality.fewest
            );
            return Err(Error::out_of_range("number of bands", count as f64, "", expected));
        }
        let sigma = |distance: f64| if distance > 0.0 { 0.5 / distance } else { f64::INFINITY };
        Ok(AirChoice {
            bands: found.bands,
            sigma_m: sigma(quality.distance),
            sigma_least_m: sigma(quality.bound),
            sigma_all_bands_m: sigma(quality.distance_all_bands),
            exact: quality.exact,
        })
    }
}
