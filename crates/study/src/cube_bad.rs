//! Bad pixels and bands of a cube: named by the user, or found by what no detector that works could read.
//!
//! | code | name | a pixel |
//! |---|---|---|
//! | 1 | missing | a sample of which is no number |
//! | 2 | dead | all samples of which are 0, where even a surface at the lowest temperature would send 30 counts at an emissivity of 0.02 |
//! | 3 | stuck | all samples of which are one value, which noise would do once in 10⁹ pixels at most |
//! | 4 | saturated | a sample of which is at the value where readings are cut off |
//! | 5 | too-bright | a sample of which is more than 4 times what a blackbody at the highest temperature, or any light, sends |
//! | 6 | named | that stands in `cube.bad_pixels` |
//! | 7 | outlier | far beyond all around it: of pictures alone (`cube_outliers`), never of these cubes |
//!
//! A band is bad where it is missing in most pixels, or one value in all that were looked at while noise would move it. Readings are
//! cut off at the largest value that 20 of the samples looked at have, if ten times as many have it as the next one and fewer are above.
//!
//! Nothing here depends on the neighbours of a pixel: spoiling one changes no other one. Samples of bad pixels are handed on as
//! missing ones, for every command alike. Only pixels looked at (16 384, evenly) say what a band and a limit is.

use super::Warning;
use super::cube_sample::{LOOKED, some};
use hadar::cube::{Cube, MemoryCube, Rows, Sample, Shape};
use hadar::error::Result;
use hadar::parallel;
use serde::Serialize;
use std::collections::BTreeMap;

/// Fewer pixels say nothing of a band.
const SAYING: usize = 16;
/// Counts of which 0 is no reading: e⁻³⁰.
const FEWEST: f64 = 30.0;
/// Probability that noise makes all samples of a pixel the same.
const BY_CHANCE: f64 = 1e-9;
/// Times the most that can be sent.
const BEYOND: f64 = 4.0;
/// Least emissivity that a surface is taken to have on the average over the bands.
const LEAST_EMISSIVITY: f64 = 0.02;
/// Samples at one value that are no chance, and how many more than at the next value.
const PILED: usize = 20;
const PILED_OVER_NEXT: usize = 10;
/// The same at the least value: whole numbers that are cut off in the noise of the dark have many at the next one too.
const PILED_BELOW_OVER_NEXT: usize = 3;
/// Of so many pixels one may have another value in a band that is stuck: a single pixel does not say what a band is.
const OTHERS: usize = 16;

/// Names of the codes, from 1.
pub const NAMES: [&str; 7] = ["missing", "dead", "stuck", "saturated", "too-bright", "named", "outlier"];

/// Why a band is left out that nobody named.
const BAND_NAMES: [&str; 4] = ["absent", "missing", "stuck", "saturated"];
/// Noise in steps of whole numbers that moves readings: by less of it most are the same number.
const MOVES: f64 = 0.3;

/// Bad pixels and bands of a cube.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize)]
pub struct BadFound {
    /// How many pixels are bad, by why.
    pub pixels: Vec<BadPixels>,
    /// Bands that were found to be bad or that the file lacks, in addition to those named.
    pub bands: Vec<BadBand>,
    /// The code of every pixel, 0 for good ones; empty where all are.
    #[serde(skip)]
    pub map: Vec<u8>,
}

impl BadFound {
    /// What the reader must know of it; pixels that miss a sample are told where they are counted.
    pub(super) fn warnings(&self, shape: Shape) -> Vec<Warning> {
        let of = shape.rows() * shape.columns();
        let bands = bands_found(&self.bands);
        let found = self.pixels.iter().filter(|bad| bad.why != "missing" && bad.why != "named");
        bands
            .chain(found.map(|bad| Warning::PixelsFoundBad { pixels: bad.pixels, of, why: bad.why }))
            .collect()
    }
}

/// What the reader must know of bands that were found to be bad.
pub(super) fn bands_found(found: &[BadBand]) -> impl Iterator<Item = Warning> + '_ {
    BAND_NAMES.into_iter().filter_map(|why| {
        let bands: Vec<usize> = found.iter().filter(|bad| bad.why == why).map(|bad| bad.band).collect();
        (!bands.is_empty()).then_some(Warning::BandsFoundBad { bands, why })
    })
}

/// Pixels that are bad for one reason.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct BadPixels {
    /// `missing`, `dead`, `stuck`, `saturated`, `too-bright`, `named` or `outlier`.
    pub why: &'static str,
    /// Number of the reason in `bad_pixels.npy`.
    pub code: u8,
    /// Number of pixels that are bad for this reason.
    pub pixels: usize,
}

/// A band that was found to be bad.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct BadBand {
    /// Its place, from 0, in rising wavenumber.
    pub band: usize,
    /// `absent` (the file has no such band), `missing`, `stuck`, of a calibration also `saturated` and `named`.
    pub why: &'static str,
}

/// What is known of readings, all in the unit of the cube and for each band.
pub(super) struct Readings<'a> {
    /// Bands that are left out already.
    pub(super) bad_bands: &'a [usize],
    /// What one count is.
    pub(super) units_per_count: f64,
    /// Variance of the electronic noise, counts².
    pub(super) var_added: &'a [f64],
    /// Counts of a blackbody at the lowest temperature.
    pub(super) least: &'a [f64],
    /// Counts of a blackbody at the highest temperature, or of the brightest light.
    pub(super) most: &'a [f64],
    /// Whether only what is missing or named is bad.
    pub(super) keeps: bool,
    /// Whether the scale of the counts is unknown: nothing is too bright then, nor too dark.
    pub(super) gain: bool,
}

/// Bands without readings of a cube of which nothing is known but that its samples scatter, besides those that are left out.
pub(super) fn bands_without_readings(cube: &Cube, bad_bands: &[usize]) -> Result<Vec<BadBand>> {
    let bands = cube.shape().bands();
    let (none, noise) = (vec![0.0; bands], vec![1.0; bands]);
    let readings = Readings {
        bad_bands,
        units_per_count: 1.0,
        var_added: &noise,
        least: &none,
        most: &none,
        keeps: false,
        gain: true,
    };
    match cube {
        Cube::F32(rows) => Ok(readings.bands(&some(rows.as_ref(), LOOKED)?)),
        Cube::F64(rows) => Ok(readings.bands(&some(rows.as_ref(), LOOKED)?)),
    }
}

/// Bands of a blackbody's cube without readings that scatter by `noise`, besides those that are left out: of these some are cut off.
pub(super) fn bands_of_blackbody(cube: &Cube, bad_bands: &[usize], noise: f64) -> Result<Vec<BadBand>> {
    match cube {
        Cube::F32(rows) => Ok(bands_among(&some(rows.as_ref(), LOOKED)?, bad_bands, noise)),
        Cube::F64(rows) => Ok(bands_among(&some(rows.as_ref(), LOOKED)?, bad_bands, noise)),
    }
}

fn bands_among<S: Sample>(looked: &MemoryCube<S>, bad_bands: &[usize], noise: f64) -> Vec<BadBand> {
    let bands = looked.shape().bands();
    let values = || looked.samples().iter().map(|sample| -> f64 { (*sample).into() });
    // An even surface reads one whole number in all pixels where noise is far below one.
    let moves = noise > MOVES || values().any(|value| value.is_finite() && value.fract() != 0.0);
    let (none, var) = (vec![0.0; bands], vec![if moves { 1.0 } else { 0.0 }; bands]);
    let readings = Readings {
        bad_bands,
        units_per_count: 1.0,
        var_added: &var,
        least: &none,
        most: &none,
        keeps: false,
        gain: true,
    };
    // One number for all bands is no surface: the cube is dead, or full.
    let mut finite = values().filter(|value| value.is_finite());
    let first = finite.next();
    if bands > 1 && looked.samples().len() / bands >= SAYING && finite.all(|value| Some(value) == first) {
        let dead = (0..bands).filter(|band| !bad_bands.contains(band));
        return dead.map(|band| BadBand { band, why: "stuck" }).collect();
    }
    let mut found = readings.bands(looked);
    let is_known = |band: &usize| bad_bands.contains(band);
    let used: Vec<usize> = (0..bands)
        .filter(|band| !is_known(band) && !found.iter().any(|bad| bad.band == *band && bad.why == "missing"))
        .collect();
    let pixels = looked.samples().len() / bands;
    let Some(most) = cut_off(numbers(looked, &used), PILED_OVER_NEXT).filter(|_| moves && pixels >= SAYING)
    else {
        return found;
    };
    let is_cut = |band: &usize| {
        let own = looked.samples().chunks(bands).filter_map(|pixel| pixel.get(*band));
        OTHERS * own.filter(|sample| -> bool { Into::<f64>::into(**sample) >= most }).count() > pixels
    };
    let cut: Vec<usize> = used.iter().copied().filter(is_cut).collect();
    // All of them are a cube without noise.
    if cut.len() < used.len() {
        found.retain(|bad| !cut.contains(&bad.band));
        found.extend(cut.into_iter().map(|band| BadBand { band, why: "saturated" }));
    }
    found
}

/// The value at which samples of these bands are cut off, above or below, and the share of them that are, if they are; of both the larger one.
pub(super) fn cut_off_share(cube: &Cube, used: &[usize]) -> Result<Option<[f64; 2]>> {
    fn of<S: Sample>(looked: &MemoryCube<S>, used: &[usize]) -> Option<[f64; 2]> {
        let all = numbers(looked, used);
        let share = |is_cut: &dyn Fn(f64) -> bool| {
            all.iter().filter(|value| is_cut(**value)).count() as f64 / all.len() as f64
        };
        let above = cut_off(all.clone(), PILED_OVER_NEXT).map(|most| [most, share(&|value| value >= most)]);
        let least = cut_off(all.iter().map(|value| -value).collect(), PILED_BELOW_OVER_NEXT);
        let below = least.map(|least| [-least, share(&|value| value <= -least)]);
        above.into_iter().chain(below).reduce(|a, b| if b[1] > a[1] { b } else { a })
    }
    match cube {
        Cube::F32(rows) => Ok(of(&some(rows.as_ref(), LOOKED)?, used)),
        Cube::F64(rows) => Ok(of(&some(rows.as_ref(), LOOKED)?, used)),
    }
}

impl Readings<'_> {
    /// Finds bad bands and pixels; `named` are those the user names.
    pub(super) fn find(&self, cube: &Cube, named: &[bool]) -> Result<BadFound> {
        match cube {
            Cube::F32(rows) => self.find_in(rows.as_ref(), named),
            Cube::F64(rows) => self.find_in(rows.as_ref(), named),
        }
    }

    fn find_in<S: Sample>(&self, cube: &dyn Rows<S>, named: &[bool]) -> Result<BadFound> {
        let shape = cube.shape();
        let looked = some(cube, LOOKED)?;
        let bands = if self.keeps { Vec::new() } else { self.bands(&looked) };
        let is_used =
            |band: &usize| !self.bad_bands.contains(band) && bands.iter().all(|bad| bad.band != *band);
        let used: Vec<usize> = (0..shape.bands()).filter(is_used).collect();
        let cut_off = cut_off(numbers(&looked, &used), PILED_OVER_NEXT);
        let of_row = |buffer: &mut Vec<S>, row: usize| -> Result<Vec<u8>> {
            let samples = cube.read(row..row + 1, buffer)?;
            let pixels = samples.chunks(shape.bands()).enumerate();
            Ok(pixels
                .map(|(column, pixel)| {
                    hadar::stop::check();
                    let is_named = named.get(row * shape.columns() + column).copied().unwrap_or(false);
                    if is_named { 6 } else { self.code(pixel, &used, cut_off) }
                })
                .collect())
        };
        let map = parallel::try_map_with(shape.rows(), Vec::new, of_row)?.concat();
        let mut counts: BTreeMap<u8, usize> = BTreeMap::new();
        map.iter().filter(|code| **code > 0).for_each(|code| *counts.entry(*code).or_default() += 1);
        let of = |(code, pixels): (&u8, &usize)| {
            let why = NAMES.get(usize::from(*code) - 1)?;
            Some(BadPixels { why, code: *code, pixels: *pixels })
        };
        let pixels: Vec<BadPixels> = counts.iter().filter_map(of).collect();
        Ok(BadFound { bands, map: if pixels.is_empty() { Vec::new() } else { map }, pixels })
    }

    fn code<S: Sample>(&self, pixel: &[S], used: &[usize], cut_off: Option<f64>) -> u8 {
        let value = |band: &usize| -> f64 { pixel[*band].into() };
        if used.iter().any(|band| !value(band).is_finite()) {
            return 1;
        }
        if self.keeps {
            return 0;
        }
        let Some(first) = used.first().map(value) else { return 0 };
        if used.iter().all(|band| value(band) == first) {
            let least: f64 = used.iter().map(|band| self.least[*band]).sum();
            let noise: f64 = used.iter().map(|band| self.var_added(*band)).sum();
            if first == 0.0 {
                return if LEAST_EMISSIVITY * least > FEWEST || noise > 0.0 { 2 } else { 0 };
            }
            // Below 0 without noise there are no counts at all, which is an error of its own.
            if first < 0.0 && noise == 0.0 {
                return 0;
            }
            // The most probable value of counts of mean n has the probability 1/√(2πn).
            let counts = (first / self.units_per_count).abs();
            let same = |band: &usize| {
                let var = counts + self.var_added(*band);
                (1.0 / (std::f64::consts::TAU * var).sqrt()).min(1.0).ln()
            };
            let chance: f64 = used.iter().skip(1).map(same).sum();
            return if chance < BY_CHANCE.ln() { 3 } else { 0 };
        }
        if cut_off.is_some_and(|most| used.iter().any(|band| value(band) >= most)) {
            return 4;
        }
        let too_bright = |band: &usize| {
            let sigma = (self.most[*band] + self.var_added(*band)).sqrt();
            value(band) / self.units_per_count > BEYOND * self.most[*band] + 10.0 * sigma + FEWEST
        };
        if !self.gain && used.iter().any(too_bright) { 5 } else { 0 }
    }

    fn var_added(&self, band: usize) -> f64 {
        self.var_added.get(band).copied().unwrap_or(0.0)
    }

    /// Bands that no pixel looked at has a reading of.
    fn bands<S: Sample>(&self, looked: &MemoryCube<S>) -> Vec<BadBand> {
        let bands = looked.shape().bands();
        let pixels = looked.samples().len() / bands;
        let mut found = Vec::new();
        for band in (0..bands).filter(|band| !self.bad_bands.contains(band)) {
            let values = || looked.samples().chunks(bands).map(|pixel| -> f64 { pixel[band].into() });
            let missing = values().filter(|value| !value.is_finite()).count();
            let mut known: Vec<f64> = values().filter(|value| value.is_finite()).collect();
            known.sort_by(f64::total_cmp);
            let median = known.get(known.len() / 2).copied().unwrap_or(f64::NAN);
            let others = known.iter().filter(|value| **value != median).count();
            let moves = self.var_added(band) > 0.0 || LEAST_EMISSIVITY * self.least[band] > FEWEST;
            let why = match () {
                () if pixels < SAYING => None,
                () if 2 * missing > pixels => Some("missing"),
                () if moves && OTHERS * others <= known.len() => Some("stuck"),
                () => None,
            };
            found.extend(why.map(|why| BadBand { band, why }));
        }
        // All of them alike is a cube without noise, or nothing at all.
        let used = bands - self.bad_bands.iter().filter(|band| **band < bands).count();
        if found.len() >= used {
            found.retain(|bad| bad.why == "missing");
        }
        if found.len() >= used { Vec::new() } else { found }
    }
}

/// Readings of these bands that are numbers.
fn numbers<S: Sample>(looked: &MemoryCube<S>, used: &[usize]) -> Vec<f64> {
    let bands = looked.shape().bands();
    let all = looked.samples().chunks(bands).flat_map(|pixel| used.iter().map(|band| pixel[*band].into()));
    all.filter(|value: &f64| value.is_finite()).collect()
}

/// The largest value at which readings are cut off, if they are.
fn cut_off(mut values: Vec<f64>, over_next: usize) -> Option<f64> {
    values.sort_by(|a, b| b.total_cmp(a));
    // From the largest down, how many have each: a few beyond the limit are pixels that are bad in another way.
    let mut beyond = 0;
    let mut same = values.chunk_by(|a, b| a == b);
    while let Some(one) = same.next() {
        if one.len() >= PILED {
            let (next, after) = (same.next()?.len(), same.next().map_or(0, <[f64]>::len));
            // Few photons pile up as well, at 0, 1 and so on.
            let is_pile = one.len() >= over_next * next && next < over_next * after.max(1);
            return is_pile.then(|| one[0]);
        }
        beyond += one.len();
        if beyond >= PILED {
            return None;
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const BANDS: usize = 8;

    fn readings() -> Readings<'static> {
        Readings {
            bad_bands: &[],
            units_per_count: 1.0,
            var_added: &[],
            least: &[2000.0; BANDS],
            most: &[50_000.0; BANDS],
            keeps: false,
            gain: false,
        }
    }

    fn cube(samples: Vec<f64>) -> Cube {
        let shape = Shape::new(8, 9, BANDS).unwrap();
        Cube::F64(Box::new(MemoryCube::new(shape, samples).unwrap()))
    }

    fn good() -> Vec<f64> {
        (0..72 * BANDS).map(|i| 5000.0 + (i * 7919 % 613) as f64).collect()
    }

    proptest! {
        /// Whatever is put into one pixel, no other one is found to be bad, and no band.
        #[test]
        fn a_spoilt_pixel_is_its_own(
            at in 0_usize..72,
            value in prop::sample::select(vec![0.0, f64::NAN, f64::INFINITY, 1e36, 1e20, 65535.0, 5000.0]),
            whole in any::<bool>(),
        ) {
            let mut samples = good();
            let first = at * BANDS;
            let count = if whole { BANDS } else { 1 };
            samples[first..first + count].fill(value);
            let found = readings().find(&cube(samples), &[]).unwrap();
            prop_assert!(found.bands.is_empty());
            let bad: Vec<usize> = found.map.iter().enumerate().filter(|(_, code)| **code > 0).map(|(i, _)| i).collect();
            prop_assert!(bad.iter().all(|i| *i == at), "{bad:?}");
            if whole {
                prop_assert_eq!(bad, vec![at]);
            }
        }
    }

    #[test]
    fn what_is_bad_is_named() {
        let mut samples = good();
        for pixel in samples.chunks_mut(BANDS) {
            pixel[2] = 777.0;
            pixel[4] = f64::NAN;
        }
        samples[..BANDS].fill(0.0);
        samples[BANDS..2 * BANDS].fill(4321.0);
        samples[2 * BANDS] = 1e9;
        let mut named = vec![false; 72];
        named[70] = true;
        let found = readings().find(&cube(samples), &named).unwrap();
        assert_eq!(found.bands, [BadBand { band: 2, why: "stuck" }, BadBand { band: 4, why: "missing" }]);
        assert_eq!(found.map[..3], [2, 3, 5]);
        assert_eq!((found.map[70], found.map.iter().filter(|code| **code > 0).count()), (6, 4));
    }

    /// A blackbody that is full, or dead, in all bands at once is none; samples that are cut off are counted.
    #[test]
    fn a_cube_of_one_number_has_no_good_band_and_cut_off_samples_are_counted() {
        for value in [65535.0, 0.0, 100.5] {
            let found = bands_of_blackbody(&cube(vec![value; 72 * BANDS]), &[3], 2.0).unwrap();
            let bands: Vec<usize> = found.iter().map(|bad| bad.band).collect();
            assert_eq!(bands, [0, 1, 2, 4, 5, 6, 7], "{value}");
        }
        let all: Vec<usize> = (0..BANDS).collect();
        assert_eq!(cut_off_share(&cube(good()), &all).unwrap(), None);
        let clipped: Vec<f64> = good().iter().map(|n| n.min(5400.0)).collect();
        let share = clipped.iter().filter(|n| **n == 5400.0).count() as f64 / clipped.len() as f64;
        assert_eq!(cut_off_share(&cube(clipped), &all).unwrap(), Some([5400.0, share]));
        assert!(share > 0.3);
        let clipped: Vec<f64> = good().iter().map(|n| n.max(5400.0)).collect();
        assert_eq!(cut_off_share(&cube(clipped), &all).unwrap(), Some([5400.0, 1.0 - share]));
        // Whole numbers that are cut off have many at the next one too.
        let whole: Vec<f64> =
            (0..72 * BANDS).map(|i| ((i * 7919 % 613 / 40) as f64 - 6.0).max(0.0)).collect();
        assert!(
            cut_off_share(&cube(whole), &all)
                .unwrap()
                .is_some_and(|[least, share]| least == 0.0 && share > 0.4)
        );
        // Counts of 0.05 photons: 0 in 95 of 100, 1 in 5, 2 in a tenth.
        let few = (0..72 * BANDS)
            .map(|i| if i % 20 == 0 { 1.0 } else { 0.0 } + if i % 400 == 0 { 1.0 } else { 0.0 });
        assert_eq!(cut_off_share(&cube(few.collect()), &all).unwrap(), None);
    }

    #[test]
    fn readings_that_are_cut_off_are_found() {
        let mut samples = good();
        samples.iter_mut().for_each(|n| *n = n.min(5400.0));
        let found = readings().find(&cube(samples), &[]).unwrap();
        assert_eq!(found.pixels.iter().map(|one| one.why).collect::<Vec<_>>(), ["saturated"]);
    }
}
