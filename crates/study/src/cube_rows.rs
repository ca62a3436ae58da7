//! The mean of rows of a cube that show one and the same thing, without the pixels that do not.
//!
//! A pixel is left out where a band of it is more than [`FAR`] deviations from the median of the rows; the deviation is 1.4826 times
//! the median distance from the median, or [`LEAST`] of the median if that is more. A few dead pixels or passers-by then change the mean
//! by nothing, where they would change a plain one by as much as they are off.
//!
//! Source: F. R. Hampel, J. Am. Stat. Assoc. 69, 383 (1974), doi:10.2307/2285666.

use hadar::cube::{Rows, Sample};
use hadar::error::{Error, Result};

/// Deviations from the median from which on a pixel is not like the others.
const FAR: f64 = 8.0;
/// Least deviation, as a share of the median.
const LEAST: f64 = 1e-3;
/// The median distance of a normal distribution is its deviation over this.
const NORMAL: f64 = 1.4826;
/// Pixels that the medians are taken of, evenly.
const ASKED: usize = 4096;

/// The mean of every band over rows from the first up to the second, and how many pixels with all samples are left out of it.
pub(super) fn mean_of<S: Sample>(
    cube: &dyn Rows<S>,
    [first, last]: [usize; 2],
    bad_bands: &[usize],
) -> Result<(Vec<f64>, usize)> {
    let shape = cube.shape();
    if last > shape.rows() {
        let found = format!("rows {first} to {last} of a cube of {}", shape.rows());
        return Err(Error::malformed(found, format!("write rows up to {}", shape.rows())));
    }
    let bands = shape.bands();
    let used: Vec<usize> = (0..bands).filter(|band| !bad_bands.contains(band)).collect();
    let is_whole = |pixel: &[S]| used.iter().all(|band| pixel[*band].into().is_finite());
    let stride = ((last - first) * shape.columns()).div_ceil(ASKED).max(1);
    let (mut asked, mut buffer, mut place) = (vec![Vec::new(); bands], Vec::new(), 0_usize);
    for row in first..last {
        for pixel in cube.read(row..row + 1, &mut buffer)?.chunks(bands).filter(|pixel| is_whole(pixel)) {
            if place.is_multiple_of(stride) {
                used.iter().for_each(|band| asked[*band].push(pixel[*band].into()));
            }
            place += 1;
        }
    }
    if place == 0 {
        return Err(Error::malformed("these rows hold no pixel with all its samples", "name other rows"));
    }
    let limits: Vec<(usize, f64, f64)> = used
        .iter()
        .map(|band| {
            let middle = median(&mut asked[*band]);
            let mut distances: Vec<f64> = asked[*band].iter().map(|x: &f64| (x - middle).abs()).collect();
            (*band, middle, FAR * f64::max(NORMAL * median(&mut distances), LEAST * middle.abs()))
        })
        .collect();
    let (mut sum, mut count, mut left_out) = (vec![0.0; bands], 0.0, 0);
    for row in first..last {
        for pixel in cube.read(row..row + 1, &mut buffer)?.chunks(bands).filter(|pixel| is_whole(pixel)) {
            let like = |(band, middle, far): &(usize, f64, f64)| (pixel[*band].into() - middle).abs() <= *far;
            if limits.iter().all(like) {
                used.iter().for_each(|band| sum[*band] += pixel[*band].into());
                count += 1.0;
            } else {
                left_out += 1;
            }
        }
    }
    if count == 0.0 {
        let found = "no pixel of these rows is like the others in all bands";
        return Err(Error::malformed(found, "name rows that show one and the same thing"));
    }
    sum.iter_mut().for_each(|sum| *sum /= count);
    Ok((sum, left_out))
}

fn median(values: &mut [f64]) -> f64 {
    let middle = values.len() / 2;
    if values.is_empty() { f64::NAN } else { *values.select_nth_unstable_by(middle, f64::total_cmp).1 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hadar::cube::{MemoryCube, Shape};

    /// Dead pixels change a plain mean by their share, this one by nothing.
    #[test]
    fn dead_pixels_and_passers_by_are_not_in_the_mean() {
        let shape = Shape::new(10, 8, 3).unwrap();
        let mut samples: Vec<f64> = (0..240).map(|i| 1000.0 + f64::from(i * 37 % 11) - 5.0).collect();
        let plain = |samples: &[f64], band: usize, skip: usize| {
            let own = samples.chunks(3).skip(skip).map(|pixel| pixel[band]);
            own.sum::<f64>() / (80 - skip) as f64
        };
        let expected: Vec<f64> = (0..3).map(|band| plain(&samples, band, 4)).collect();
        samples[..6].fill(0.0);
        samples[6..12].fill(4000.0);
        let cube = MemoryCube::new(shape, samples).unwrap();
        let (mean, left_out) = mean_of(&cube, [0, 10], &[]).unwrap();
        assert_eq!(left_out, 4);
        assert!(mean.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-9), "{mean:?} {expected:?}");
    }
}
