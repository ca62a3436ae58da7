//! A map of categories against the truth.
//!
//! Intersection over union of category i: pixels that are i and found to be, over those that are or were found to be
//! (IoU = TP/(TP + FP + FN)); the mean over the categories that are there or were found. A pixel that is of none of the categories and was
//! given one is a false alarm of that; one that was given none is a miss of its own. A pixel that is undecided is never right, and a miss of
//! its own as well. Pixels whose truth is not known do not count.

use super::categories::NO_CATEGORY;
use serde::Serialize;

/// How a map agrees with what is there.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Agreement {
    /// Pixels of every category (rows; the last one none of them) by what was found (columns; the last but one none, the last one
    /// undecided).
    pub confusion: Vec<Vec<usize>>,
    /// Intersection over union; `None` of a category that neither is there nor was found.
    pub iou: Vec<Option<f64>>,
    /// Their mean (mIoU); `None` where no category is there or was found.
    pub mean_iou: Option<f64>,
    /// Share of the pixels that are right.
    pub right: Option<f64>,
    /// Share of the pixels that are undecided.
    pub undecided: Option<f64>,
    /// Number of pixels that are compared.
    pub pixels: usize,
}

impl Agreement {
    /// Of what was found with what is there, pixel by pixel, of so many categories. The truth is `None` where it is not known,
    /// [`NO_CATEGORY`] where it is none of them.
    #[must_use]
    pub fn of(found: &[u8], truth: impl IntoIterator<Item = Option<u8>>, categories: usize) -> Self {
        Self::with_undecided(found, &[], truth, categories)
    }

    /// The same of a map some pixels of which are undecided, whatever it holds there.
    #[must_use]
    pub fn with_undecided(
        found: &[u8],
        is_undecided: &[bool],
        truth: impl IntoIterator<Item = Option<u8>>,
        categories: usize,
    ) -> Self {
        let mut confusion = vec![vec![0_usize; categories + 2]; categories + 1];
        let place = |one: u8| if one == NO_CATEGORY { categories } else { usize::from(one).min(categories) };
        for (i, (found, truth)) in found.iter().zip(truth).enumerate() {
            if let Some(truth) = truth {
                let is_undecided = is_undecided.get(i).copied().unwrap_or(false);
                let found = if is_undecided { categories + 1 } else { place(*found) };
                confusion[place(truth)][found] += 1;
            }
        }
        let iou: Vec<Option<f64>> = (0..categories)
            .map(|i| {
                let there: usize = confusion[i].iter().sum();
                let found: usize = confusion.iter().map(|row| row[i]).sum();
                let union = there + found - confusion[i][i];
                (union > 0).then(|| confusion[i][i] as f64 / union as f64)
            })
            .collect();
        let known = || iou.iter().flatten();
        let pixels: usize = confusion.iter().flatten().sum();
        let right: usize = (0..=categories).map(|i| confusion[i][i]).sum();
        let undecided: usize = confusion.iter().map(|row| row[categories + 1]).sum();
        let share = |of: usize| (pixels > 0).then(|| of as f64 / pixels as f64);
        Self {
            mean_iou: (known().count() > 0).then(|| known().sum::<f64>() / known().count() as f64),
            right: share(right),
            undecided: share(undecided),
            iou,
            confusion,
            pixels,
        }
    }
}
