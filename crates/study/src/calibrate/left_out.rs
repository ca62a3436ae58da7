//! Bands that are left out of all cubes of a calibration by blackbodies: what is bad in one calibrates nothing.
//!
//! They are those that the scenario or a file names, that a file lacks, and those found in the cube of a blackbody of 16 pixels or more:
//! missing in most pixels, of one value in all but a sixteenth of them (0 as well) where the noise would move it, or cut off in more than a sixteenth.

use crate::Warning;
use crate::cube_bad::{BadBand, bands_found, bands_of_blackbody};
use hadar::cube::Cube;
use hadar::error::{Error, Result};

/// Bands that are left out, and those that are not.
#[derive(Debug, Default)]
pub(super) struct LeftOut {
    /// With why, in their order.
    pub(super) bands: Vec<BadBand>,
    /// The others, in their order.
    pub(super) good: Vec<usize>,
}

impl LeftOut {
    /// Of cubes of `all` bands, the bands `named` and `absent` in any of them; samples of a blackbody scatter by `noise`.
    ///
    /// # Errors
    /// Cubes that cannot be read, no band that is left.
    pub(super) fn of(
        all: usize,
        named: &[usize],
        absent: &[usize],
        cubes: &[Cube],
        noise: f64,
    ) -> Result<Self> {
        let mut bands: Vec<BadBand> = Vec::new();
        for (list, why) in [(absent, "absent"), (named, "named")] {
            for band in list {
                if !bands.iter().any(|bad| bad.band == *band) {
                    bands.push(BadBand { band: *band, why });
                }
            }
        }
        for cube in cubes {
            let known: Vec<usize> = bands.iter().map(|bad| bad.band).collect();
            bands.extend(bands_of_blackbody(cube, &known, noise)?);
        }
        bands.sort_by_key(|bad| bad.band);
        let good: Vec<usize> = (0..all).filter(|band| bands.iter().all(|bad| bad.band != *band)).collect();
        if good.is_empty() {
            let found = "every band is bad in the cube of some blackbody";
            return Err(Error::malformed(found, "leave cubes out that are bad, or name fewer bad_bands"));
        }
        Ok(Self { bands, good })
    }

    /// What the reader must know of it.
    pub(super) fn warnings(&self) -> impl Iterator<Item = Warning> + '_ {
        bands_found(&self.bands)
    }

    /// A cube without them.
    pub(super) fn without(&self, cube: Cube) -> Result<Cube> {
        cube.with_bands(self.good.clone())
    }

    /// Samples of the bands that are left among all of them, NaN in those that are left out.
    pub(super) fn among(&self, samples: Vec<f32>) -> Vec<f32> {
        if self.bands.is_empty() {
            return samples;
        }
        let all = self.good.len() + self.bands.len();
        let mut out = vec![f32::NAN; samples.len() / self.good.len() * all];
        for (out, own) in out.chunks_mut(all).zip(samples.chunks(self.good.len())) {
            for (band, value) in self.good.iter().zip(own) {
                if let Some(place) = out.get_mut(*band) {
                    *place = *value;
                }
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hadar::cube::{MemoryCube, Shape};

    /// 400 pixels of 6 bands
    fn cube(scale: f64, of: impl Fn(usize, f64) -> f64) -> Cube {
        let samples: Vec<f64> = (0..2400)
            .map(|i| {
                let scatter = (i * 7919 % 613) as f64 / 613.0;
                of(i % 6, 500.0 + 40.0 * (i % 6) as f64 + scale * scatter)
            })
            .collect();
        Cube::F64(Box::new(MemoryCube::new(Shape::new(20, 20, 6).unwrap(), samples).unwrap()))
    }

    fn spoilt(band: usize, value: f64) -> f64 {
        match band {
            1 => 0.0,
            2 => 77.25,
            3 => f64::NAN,
            4 => (value + 500.0).min(1160.5),
            _ => value,
        }
    }

    #[test]
    fn bands_that_are_bad_in_one_cube_are_left_out_of_all() {
        let cubes = [cube(1.0, |_, value| value), cube(1.0, spoilt)];
        let found = LeftOut::of(6, &[5], &[], &cubes, 1.0).unwrap();
        let whys: Vec<(usize, &str)> = found.bands.iter().map(|bad| (bad.band, bad.why)).collect();
        let expected = [(1, "stuck"), (2, "stuck"), (3, "missing"), (4, "saturated"), (5, "named")];
        assert_eq!(whys, expected);
        assert_eq!(found.without(cube(1.0, |_, value| value)).unwrap().shape().bands(), found.good.len());
        let all = found.among(vec![1.0; found.good.len()]);
        assert!(all[0] == 1.0 && all[1..].iter().all(|x| x.is_nan()), "{all:?}");
    }

    /// Whole numbers with less noise than a step: that most are alike says nothing.
    #[test]
    fn whole_numbers_of_little_noise_are_readings() {
        let whole = [cube(0.4, |_, value| value.round()), cube(0.4, |_, value| value.round() + 50.0)];
        assert!(LeftOut::of(6, &[], &[], &whole, 0.1).unwrap().bands.is_empty());
        // A cube without noise has no band without readings, but those that are missing.
        let still = [cube(0.0, |band, value| if band == 2 { f64::NAN } else { value + 0.5 })];
        let found = LeftOut::of(6, &[], &[], &still, 1.0).unwrap();
        assert_eq!(found.bands, [BadBand { band: 2, why: "missing" }]);
        assert!(LeftOut::of(6, &[0, 1, 2, 3, 4, 5], &[], &[], 1.0).is_err());
    }
}
