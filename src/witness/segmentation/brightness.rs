//! The best that the brightness of a pixel alone can say of its category.
//!
//! The brightnesses of an image (a thermal image: all bands together) are cut into [`BINS`] of equally many pixels; all pixels of a bin get
//! the category that is commonest among them **in truth**. No table from brightness to category has more pixels right on this image, to
//! the width of a bin: what a segmentation by temperature alone, that does not know the truth, is held against.

use super::categories::NO_CATEGORY;

/// Parts of equally many pixels.
const BINS: usize = 256;

/// Categories by the brightness alone, laid out with the truth; [`NO_CATEGORY`] where there is no brightness.
#[must_use]
pub fn by_brightness(brightness: &[f32], truth: &[u8]) -> Vec<u8> {
    let mut sorted: Vec<f32> = brightness.iter().copied().filter(|x| x.is_finite()).collect();
    sorted.sort_by(f32::total_cmp);
    let edges: Vec<f32> =
        (1..BINS).filter_map(|bin| sorted.get(bin * sorted.len() / BINS).copied()).collect();
    let bin = |x: f32| edges.partition_point(|edge| *edge <= x);
    let mut counts = vec![[0_usize; NO_CATEGORY as usize]; edges.len() + 1];
    for (x, truth) in brightness.iter().zip(truth).filter(|(x, _)| x.is_finite()) {
        if let Some(count) = counts[bin(*x)].get_mut(usize::from(*truth)) {
            *count += 1;
        }
    }
    let commonest: Vec<u8> = counts
        .iter()
        .map(|counts| {
            let most = (0..NO_CATEGORY).max_by_key(|one| (counts[usize::from(*one)], NO_CATEGORY - one));
            most.filter(|one| counts[usize::from(*one)] > 0).unwrap_or(NO_CATEGORY)
        })
        .collect();
    brightness.iter().map(|x| if x.is_finite() { commonest[bin(*x)] } else { NO_CATEGORY }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two categories apart in brightness are told, two of one brightness are not: the commoner one is said of all.
    #[test]
    fn equal_brightness_is_one_category() {
        let brightness: Vec<f32> = (0..3000).map(|i| [1.0, 1.0, 1.0, 5.0][i % 4]).collect();
        let truth: Vec<u8> = (0..3000).map(|i| [2, 2, 1, 0][i % 4]).collect();
        let found = by_brightness(&brightness, &truth);
        assert!(found.iter().enumerate().all(|(i, one)| *one == [2, 2, 2, 0][i % 4]));
        assert_eq!(by_brightness(&[f32::NAN, 1.0], &[0, NO_CATEGORY]), [NO_CATEGORY, NO_CATEGORY]);
    }
}
