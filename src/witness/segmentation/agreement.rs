//! A map of categories against the truth.
//!
//! Intersection over union of category i: pixels that are i and found to be, over those that are or were found to be
//! (IoU = TP/(TP + FP + FN)); the mean over the categories that are there or were found. Pixels whose truth is not known do not count;
//! a pixel that was given no category is a miss of its own.

use super::categories::NO_CATEGORY;
use serde::Serialize;

/// How a map agrees with what is there.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Agreement {
    /// Pixels of every category (rows) by what was found (columns; the last one nothing).
    pub confusion: Vec<Vec<usize>>,
    /// Intersection over union; `None` of a category that neither is there nor was found.
    pub iou: Vec<Option<f64>>,
    /// Their mean (mIoU); `None` where no pixel counts.
    pub mean_iou: Option<f64>,
    /// Share of the pixels that are right.
    pub right: Option<f64>,
    /// Pixels that count.
    pub pixels: usize,
}

impl Agreement {
    /// Of what was found with what is there, pixel by pixel, of so many categories.
    #[must_use]
    pub fn of(found: &[u8], truth: &[u8], categories: usize) -> Self {
        let mut confusion = vec![vec![0_usize; categories + 1]; categories];
        for (found, truth) in found.iter().zip(truth).filter(|(_, truth)| **truth != NO_CATEGORY) {
            if let Some(row) = confusion.get_mut(usize::from(*truth)) {
                row[usize::from(*found).min(categories)] += 1;
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
        let right: usize = (0..categories).map(|i| confusion[i][i]).sum();
        Self {
            mean_iou: (pixels > 0).then(|| known().sum::<f64>() / known().count() as f64),
            right: (pixels > 0).then(|| right as f64 / pixels as f64),
            iou,
            confusion,
            pixels,
        }
    }
}
