//! The image that a camera without bands would see.

use super::{Cube, MemoryCube, Rows, Sample, Shape, first_invalid};
use crate::error::Result;
use crate::sum;
use rayon::prelude::*;

/// Samples that are in work at a time for each thread: 1 MB of `f32`.
const BLOCK: usize = 1 << 18;

/// The sum of all bands in every pixel, one band, `[row][column]`. Rows are read as they are needed; the sum is the
/// same to the last bit for any number of threads.
///
/// # Errors
/// A file that cannot be read, a count that is negative or no finite number.
///
/// ```
/// use hadar::cube::{MemoryCube, Shape, panchromatic};
/// let cube = MemoryCube::new(Shape::new(1, 2, 3)?, vec![1.0_f32, 2.0, 3.0, 10.0, 20.0, 30.0])?;
/// let image = panchromatic(&cube.into())?;
/// assert_eq!(image.samples(), [6.0, 60.0]);
/// # Ok::<(), hadar::Error>(())
/// ```
pub fn panchromatic(cube: &Cube) -> Result<MemoryCube<f64>> {
    match cube {
        Cube::F32(cube) => of_rows(cube.as_ref()),
        Cube::F64(cube) => of_rows(cube.as_ref()),
    }
}

fn of_rows<S: Sample>(cube: &dyn Rows<S>) -> Result<MemoryCube<f64>> {
    let shape = cube.shape();
    let height = (BLOCK / shape.row_len()).max(1);
    let mut image = vec![0.0; shape.rows() * shape.columns()];
    let outcomes: Vec<Result<()>> = image
        .par_chunks_mut(height * shape.columns())
        .enumerate()
        .map_init(
            || (Vec::new(), vec![0.0; shape.bands()]),
            |(buffer, spectrum), (block, image)| {
                crate::stop::check();
                let first = block * height;
                let samples = cube.read(first..first + image.len() / shape.columns(), buffer)?;
                if let Some(error) = first_invalid(samples, first, shape) {
                    return Err(error);
                }
                for (total, pixel) in image.iter_mut().zip(samples.chunks_exact(shape.bands())) {
                    spectrum.iter_mut().zip(pixel).for_each(|(band, &sample)| *band = sample.into());
                    *total = sum::sum(spectrum);
                }
                Ok(())
            },
        )
        .collect();
    // In the order of the rows, so that the error is always the first one's.
    outcomes.into_iter().collect::<Result<()>>()?;
    MemoryCube::new(Shape::new(shape.rows(), shape.columns(), 1)?, image)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pixel_is_the_sum_of_its_bands() {
        // Rows of several blocks, the last one shorter; integers, so that the sum is exact.
        let shape = Shape::new(1001, 31, 17).unwrap();
        let samples: Vec<f32> = (0..shape.len()).map(|i| (i % 8191) as f32).collect();
        let exact: Vec<f64> =
            samples.chunks(17).map(|pixel| pixel.iter().map(|&n| f64::from(n)).sum()).collect();
        let image = panchromatic(&MemoryCube::new(shape, samples).unwrap().into()).unwrap();
        assert_eq!(image.shape(), Shape::new(1001, 31, 1).unwrap());
        assert_eq!(image.samples(), exact);
    }

    #[test]
    fn the_first_count_that_is_none_is_named() {
        let shape = Shape::new(900, 40, 30).unwrap();
        let mut samples = vec![1.0_f64; shape.len()];
        samples[(700 * 40 + 3) * 30 + 2] = f64::NAN;
        samples[(800 * 40 + 3) * 30 + 2] = -1.0;
        let error = panchromatic(&MemoryCube::new(shape, samples).unwrap().into()).unwrap_err();
        assert_eq!(
            error.to_string(),
            "row 700, column 3, band 2 (counted from 0): photon count is NaN; it must be a finite number, 0 or above"
        );
    }
}
