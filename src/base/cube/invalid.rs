//! Which sample is no count.

use super::{Sample, Shape};
use crate::error::Error;

/// The first of the samples that is NaN, infinite or negative, with its row, column and band (counted from 0), value
/// and what it must be. The samples are those of whole rows, the first of them `first_row`, as
/// [`Rows::read`](super::Rows::read) gives them.
///
/// ```
/// use hadar::cube::{Shape, first_invalid};
/// let shape = Shape::new(9, 1, 2)?;
/// assert!(first_invalid(&[1.0, 0.0, 2.5, 3.0], 7, shape).is_none());
/// let error = first_invalid(&[1.0, 0.0, 2.5, -3.0], 7, shape).ok_or("none")?.to_string();
/// assert!(error.starts_with("row 8, column 0, band 1 (counted from 0): photon count is -3"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn first_invalid<S: Sample>(samples: &[S], first_row: usize, shape: Shape) -> Option<Error> {
    // Blocks without a branch inside, so that they are looked at as fast as they are read.
    let place = samples.chunks(1024).enumerate().find_map(|(block, samples)| {
        let sound = samples.iter().fold(true, |sound, &sample| sound & is_count(sample));
        if sound {
            return None;
        }
        samples.iter().position(|&sample| !is_count(sample)).map(|place| block * 1024 + place)
    })?;
    let value = (*samples.get(place)?).into();
    let (row, within) = (first_row + place / shape.row_len(), place % shape.row_len());
    let (column, band) = (within / shape.bands(), within % shape.bands());
    Some(
        Error::out_of_range("photon count", value, "", "a finite number, 0 or above")
            .for_key(format!("row {row}, column {column}, band {band} (counted from 0)")),
    )
}

#[inline(always)]
fn is_count<S: Sample>(sample: S) -> bool {
    let value: f64 = sample.into();
    (0.0..f64::INFINITY).contains(&value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_place_is_right_wherever_it_is() {
        let shape = Shape::new(7, 30, 11).unwrap();
        for (value, shown) in
            [(f32::NAN, "NaN"), (f32::INFINITY, "inf"), (-0.5, "-0.5"), (f32::NEG_INFINITY, "-inf")]
        {
            for place in [0, 1, 1023, 1024, 1025, 2047, 2309] {
                let mut samples = vec![0.0_f32; shape.len()];
                samples[2309] = -7.0;
                samples[place] = value;
                let message = first_invalid(&samples, 5, shape).unwrap().to_string();
                let (row, column, band) = (5 + place / 330, place % 330 / 11, place % 11);
                let begins = format!(
                    "row {row}, column {column}, band {band} (counted from 0): photon count is {shown};"
                );
                assert!(message.starts_with(&begins), "{message}");
            }
        }
        assert_eq!(first_invalid(&vec![-0.0_f32; shape.len()], 0, shape), None);
    }
}
