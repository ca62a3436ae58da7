//! Bands that matter: what each band tells, and which few bands or filters keep most of the distance.
//!
//! A selection S of bands (or of filters, each the sum of neighbouring bands, read once) keeps the statistical
//! distance d(S) = ½ min_c ‖∂_gN − Σcᵢ∂ᵢN‖_S: that of the selected counts with the nuisances unknown. For many
//! pairs the smallest distance counts, or the smallest ratio to what is required of each pair. Finding the best S is a
//! combinatorial problem; what is reported is a good selection *and* a rigorous upper bound on every
//! other (see `certificate`), so that the gap between the two is known, and the two meet where `exact` is true.
//!
//! Assumptions: the local distance (the tangent at the target); Gaussian counts; the same exposure for all
//! bands however few are selected.

mod bands;
mod certificate;
mod filters;
mod information;
mod pair;
mod scores;
mod states;

pub use information::{Information, shares_between};
pub use scores::Scores;
pub use states::{Chosen, States};

use self::certificate::worst;
use self::pair::Pair;
use self::scores::same_length;
use crate::error::{Error, Result};
use std::ops::Range;

/// Rows of all pairs that the search for a bound may weigh, and the rounds that are always given.
const BOUND_EFFORT: usize = 10_000_000;
const ROUNDS: Range<usize> = 60..400;

/// A choice of single bands.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Selection {
    /// Indices of the bands, rising.
    pub bands: Vec<usize>,
    /// How good it is.
    pub quality: Quality,
}

/// A choice of filters.
#[derive(Debug, Clone, PartialEq)]
pub struct FilterSelection {
    /// Bands that each filter lets through, rising; fewer than asked for where more would not help.
    pub filters: Vec<Range<usize>>,
    /// How good it is.
    pub quality: Quality,
}

/// What a selection keeps, and what no other can exceed. Distances are over what is required of the pair
/// (1 where nothing is said), and are of the pair that fares worst.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Quality {
    /// Distance that is reached with the selected bands, as the selection measures it.
    pub distance: f64,
    /// Distance that is reached with all bands, as `distance`.
    pub distance_all_bands: f64,
    /// Share of the distance that is kept; 0 where there is none to keep. Filters with a separate noise may keep more than 1, as they are read less often than bands.
    pub kept: f64,
    /// No selection of as many has a greater distance.
    pub bound: f64,
    /// Whether the selection is proven to be the best.
    pub exact: bool,
    /// Index of the pair that fares worst with the selection.
    pub limiting_pair: Option<usize>,
    /// Pairs that not even all bands distinguish: left out of everything here.
    pub left_out: Vec<usize>,
    /// Fewest bands or filters that tell anything: one more than there are nuisances without priors.
    pub fewest: usize,
}

/// The pairs that can be told apart, made ready, with their indices.
struct Task {
    pairs: Vec<Pair>,
    indices: Vec<usize>,
    left_out: Vec<usize>,
    bands: usize,
}

impl Task {
    fn new(scores: &[Scores], k: usize, what: &str) -> Result<Self> {
        let Some(first) = scores.first() else {
            return Err(Error::malformed("there is no pair to choose bands for", "give at least one"));
        };
        for pair in scores {
            same_length("bands of a pair", pair.bands(), first.bands())?;
        }
        if k == 0 || k > first.bands() {
            let expected = format!("from 1 to the number of bands, {}", first.bands());
            return Err(Error::out_of_range(format!("number of {what}"), k as f64, "", expected));
        }
        let all = scores.iter().map(Pair::new).enumerate();
        let (useful, rest): (Vec<_>, Vec<_>) = all.partition(|(_, pair)| pair.whole() > 0.0);
        let (indices, pairs) = useful.into_iter().unzip();
        let left_out = rest.into_iter().map(|(index, _)| index).collect();
        Ok(Self { pairs, indices, left_out, bands: first.bands() })
    }

    /// Fewest rows that tell something of every pair.
    fn fewest(&self) -> usize {
        self.pairs.iter().map(Pair::needed).max().unwrap_or(1)
    }

    /// Rounds of the search for a bound when one round weighs `rows` rows of each pair.
    fn rounds(&self, rows: usize) -> usize {
        (BOUND_EFFORT / (rows * self.pairs.len()).max(1)).clamp(ROUNDS.start, ROUNDS.end)
    }

    fn quality(self, filters: &[Range<usize>], bound_square: f64, exact: bool) -> Quality {
        let fewest = self.fewest();
        let (distance, limiting) = worst(&self.pairs, filters);
        let whole = self.pairs.iter().map(Pair::whole).fold(f64::INFINITY, f64::min);
        let (distance, whole) = if self.pairs.is_empty() { (0.0, 0.0) } else { (distance, whole) };
        Quality {
            distance,
            distance_all_bands: whole,
            kept: if whole > 0.0 { distance / whole } else { 0.0 },
            bound: bound_square.sqrt().max(distance),
            exact,
            limiting_pair: self.indices.get(limiting).copied(),
            left_out: self.left_out,
            fewest,
        }
    }
}

/// The best k of the bands for the pairs together: the smallest distance (over what is required) is the greatest.
///
/// With no more bands than nuisances nothing is learned, whatever the bands: the distance is then 0, and
/// [`Quality::fewest`] says how many are needed.
///
/// ```
/// use hadar::identifiability::selection::{Scores, best_bands};
/// // Two lines, the second stronger, over a continuum of unknown level.
/// let lines = vec![0.0, 1.0, 0.0, 3.0, 0.0];
/// let pair = Scores::from_columns(vec![vec![1.0; 5]], lines, vec![1.0; 5], vec![0.0; 5])?;
/// let choice = best_bands(&[pair], 2)?;
/// assert!(choice.bands.contains(&3) && !choice.bands.contains(&1) && choice.quality.exact);
/// // Half the difference of the two bands in units of its noise √2: 3/(2√2).
/// assert!((choice.quality.distance - 3.0 / 8f64.sqrt()).abs() < 1e-14);
/// # Ok::<(), hadar::Error>(())
/// ```
///
/// # Errors
/// No pairs, pairs with different numbers of bands, or k outside 1 to the number of bands.
pub fn best_bands(scores: &[Scores], k: usize) -> Result<Selection> {
    let task = Task::new(scores, k, "bands")?;
    if task.pairs.is_empty() || k < task.fewest() {
        let bands: Vec<usize> = (0..k).collect();
        let quality = task.quality(&[], 0.0, true);
        return Ok(Selection { bands, quality });
    }
    let found = bands::choose(&task.pairs, k, task.rounds(task.bands));
    let filters: Vec<Range<usize>> = found.bands.iter().map(|&w| w..w + 1).collect();
    let quality = task.quality(&filters, found.bound_square, found.exact);
    Ok(Selection { bands: found.bands, quality })
}

/// The best k filters, or fewer, each a run of neighbouring bands: its counts are summed and read once, with the
/// electronic noise that its bands have on average for a reading. Filters do not overlap, and may leave gaps.
///
/// # Errors
/// As [`best_bands`].
pub fn best_filters(scores: &[Scores], k: usize) -> Result<FilterSelection> {
    let task = Task::new(scores, k, "filters")?;
    if task.pairs.is_empty() || k < task.fewest() {
        let quality = task.quality(&[], 0.0, true);
        return Ok(FilterSelection { filters: Vec::new(), quality });
    }
    let found = filters::choose(&task.pairs, k, task.rounds(task.bands * task.bands / 2));
    let quality = task.quality(&found.filters, found.bound_square, found.exact);
    Ok(FilterSelection { filters: found.filters, quality })
}
