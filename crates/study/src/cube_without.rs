//! Cubes that hand on the samples of bad pixels as missing ones.

use super::cube_sample::{LOOKED, some};
use hadar::cube::{Cube, Rows, Sample, Shape};
use hadar::error::Result;
use std::ops::Range;

/// Counts of a pixel beside which another of the same picture does not hold none at all: a twentieth of them would be missed by e⁻³⁰.
const BRIGHT: f64 = 600.0;

/// Which pixels have no samples.
#[derive(Debug, Clone)]
enum Bad {
    /// Those that are not 0 here, `[row][column]`.
    Marked(Vec<u8>),
    /// Those that are 0 in all bands.
    Dead,
}

/// A cube whose bad pixels have no samples.
#[derive(Debug)]
struct Without<S> {
    cube: Box<dyn Rows<S>>,
    bad: Bad,
}

/// The cube without the samples of the pixels that are not 0 in a map; itself where there are none.
pub(super) fn without(cube: Cube, map: &[u8]) -> Cube {
    match map.iter().all(|code| *code == 0) {
        true => cube,
        false => Bad::Marked(map.to_vec()).of(cube),
    }
}

/// The cube without the samples of its dead pixels, where nothing is known of it but how many counts a unit is: pixels that are 0 in all
/// bands while the median of those looked at holds [`BRIGHT`] counts.
pub(super) fn without_dead(cube: Cube, counts_per_unit: f64) -> Result<Cube> {
    fn median<S: Sample>(cube: &dyn Rows<S>) -> Result<f64> {
        let looked = some(cube, LOOKED)?;
        let pixels = looked.samples().chunks(looked.shape().bands());
        let mut sums: Vec<f64> = pixels.map(|pixel| pixel.iter().map(|one| (*one).into()).sum()).collect();
        let middle = sums.len() / 2;
        Ok(*sums.select_nth_unstable_by(middle, f64::total_cmp).1)
    }
    let median = match &cube {
        Cube::F32(rows) => median(rows.as_ref()),
        Cube::F64(rows) => median(rows.as_ref()),
    }?;
    Ok(if median * counts_per_unit >= BRIGHT { Bad::Dead.of(cube) } else { cube })
}

impl Bad {
    fn of(self, cube: Cube) -> Cube {
        match cube {
            Cube::F32(cube) => Cube::F32(Box::new(Without { cube, bad: self })),
            Cube::F64(cube) => Cube::F64(Box::new(Without { cube, bad: self })),
        }
    }

    fn is<S: Sample>(&self, i: usize, pixel: &[S]) -> bool {
        match self {
            Self::Marked(map) => map.get(i).is_some_and(|code| *code > 0),
            Self::Dead => pixel.iter().all(|one| (*one).into() == 0.0),
        }
    }
}

impl<S: Sample> Rows<S> for Without<S> {
    fn shape(&self) -> Shape {
        self.cube.shape()
    }

    fn read<'a>(&'a self, rows: Range<usize>, buffer: &'a mut Vec<S>) -> Result<&'a [S]> {
        let (shape, first) = (self.shape(), rows.start.saturating_mul(self.shape().columns()));
        let mut own = Vec::new();
        let samples = self.cube.read(rows, &mut own)?;
        buffer.clear();
        buffer.extend_from_slice(samples);
        let pixels = buffer.chunks_mut(shape.bands()).enumerate();
        for (_, pixel) in pixels.filter(|(i, pixel)| self.bad.is(first + i, pixel)) {
            pixel.fill(S::of(f64::NAN));
        }
        Ok(buffer)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hadar::cube::MemoryCube;

    const BANDS: usize = 8;

    fn cube(samples: Vec<f64>) -> Cube {
        let shape = Shape::new(8, 9, BANDS).unwrap();
        Cube::F64(Box::new(MemoryCube::new(shape, samples).unwrap()))
    }

    /// Where a picture is bright, a pixel that is 0 in all bands was not read; where it is dim, it is a reading like any other.
    #[test]
    fn dead_pixels_of_a_bright_picture_have_no_samples() {
        let mut samples = vec![5000.0; 72 * BANDS];
        samples[..BANDS].fill(0.0);
        samples[BANDS] = 0.0;
        let missing = |counts_per_unit: f64| -> Vec<usize> {
            let Cube::F64(cube) = without_dead(cube(samples.clone()), counts_per_unit).unwrap() else {
                panic!()
            };
            let mut buffer = Vec::new();
            let read = cube.read(0..8, &mut buffer).unwrap();
            read.iter().enumerate().filter(|(_, one)| one.is_nan()).map(|(i, _)| i).collect()
        };
        assert_eq!(missing(1.0), (0..BANDS).collect::<Vec<_>>());
        assert!(missing(1e-3).is_empty());
    }
}
