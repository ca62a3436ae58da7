//! Categories by the brightness of a pixel alone.
//!
//! The brightnesses of an image (a thermal image: all bands together) are cut into [`BINS`] of equally many pixels; each gets the category
//! that is commonest among its pixels **in truth**. On the image that it was learned from no table from brightness to category has more
//! pixels right, to the width of a bin: the most that a segmentation by temperature alone could say. On another image it says what such a
//! table is worth where the truth is not known.

use super::categories::NO_CATEGORY;

/// Parts of equally many pixels.
const BINS: usize = 256;

/// A table from brightness to category.
#[derive(Debug, Clone, PartialEq)]
pub struct ByBrightness {
    edges: Vec<f32>,
    commonest: Vec<u8>,
}

impl ByBrightness {
    /// From an image whose categories are known.
    #[must_use]
    pub fn learned(brightness: &[f32], truth: &[u8]) -> Self {
        let mut sorted: Vec<f32> = brightness.iter().copied().filter(|x| x.is_finite()).collect();
        sorted.sort_by(f32::total_cmp);
        let edges: Vec<f32> =
            (1..BINS).filter_map(|bin| sorted.get(bin * sorted.len() / BINS).copied()).collect();
        let mut counts = vec![[0_usize; NO_CATEGORY as usize]; edges.len() + 1];
        for (x, truth) in brightness.iter().zip(truth).filter(|(x, _)| x.is_finite()) {
            let bin = edges.partition_point(|edge| edge <= x);
            if let Some(count) = counts[bin].get_mut(usize::from(*truth)) {
                *count += 1;
            }
        }
        let commonest = counts
            .iter()
            .map(|counts| {
                let most = (0..NO_CATEGORY).max_by_key(|one| (counts[usize::from(*one)], NO_CATEGORY - one));
                most.filter(|one| counts[usize::from(*one)] > 0).unwrap_or(NO_CATEGORY)
            })
            .collect();
        Self { edges, commonest }
    }

    /// Categories of an image; [`NO_CATEGORY`] where there is no brightness.
    #[must_use]
    pub fn of(&self, brightness: &[f32]) -> Vec<u8> {
        let one = |x: &f32| match x.is_finite() {
            true => self.commonest[self.edges.partition_point(|edge| edge <= x)],
            false => NO_CATEGORY,
        };
        brightness.iter().map(one).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two categories apart in brightness are told, two of one brightness are not: the commoner one is said of all.
    #[test]
    fn equal_brightness_is_one_category() {
        let brightness: Vec<f32> = (0..3000).map(|i| [1.0, 1.0, 1.0, 5.0][i % 4]).collect();
        let truth: Vec<u8> = (0..3000).map(|i| [2, 2, 1, 0][i % 4]).collect();
        let found = ByBrightness::learned(&brightness, &truth).of(&brightness);
        assert!(found.iter().enumerate().all(|(i, one)| *one == [2, 2, 2, 0][i % 4]));
        let empty = ByBrightness::learned(&[f32::NAN, 1.0], &[0, NO_CATEGORY]);
        assert_eq!(empty.of(&[f32::NAN, 1.0]), [NO_CATEGORY, NO_CATEGORY]);
    }
}
