//! Cubes of a calibration, every sample a number: read whole, or by rows where sums are all that is wanted.

use crate::memory;
use hadar::cube::{Cube, Rows, Sample, Shape};
use hadar::error::{Error, Result};
use hadar::parallel;
use hadar_scenario::Source;
use hadar_scenario::calibrate::blackbodies::CubeFile;
use rayon::prelude::*;

/// Puts file, line and key on an error.
pub(super) fn at<'a>(source: &'a Source, key: &str) -> impl Fn(Error) -> Error + use<'a> {
    let key = key.to_owned();
    move |error| match &error {
        Error::At { place, .. } if place.path.is_some() => error.for_key(key.clone()),
        _ => error.at(source.place(&key)),
    }
}

/// Opens a cube that is named under a key; with its bands that are bad as the scenario and the file say.
pub(super) fn open(file: &CubeFile, source: &Source, key: &str) -> Result<(Cube, Vec<usize>)> {
    let opened = hadar_formats::cube::open_as(&file.path, file.variable.as_deref(), file.axes)
        .map_err(at(source, key))?;
    let bands = opened.cube.shape().bands();
    if let Some(bad) = file.bad_bands.iter().find(|band| **band >= bands) {
        let error =
            Error::malformed(format!("band {bad} of {bands}"), format!("count from 0 up to {}", bands - 1));
        return Err(at(source, &key.replace("data", "bad_bands"))(error));
    }
    let bad = file.bad_bands.iter().chain(&opened.found.bad_bands).copied().collect();
    Ok((opened.cube, bad))
}

/// Rows, columns and bands in words.
pub(super) fn shown(shape: Shape) -> String {
    format!("{} x {} x {} (rows, columns, bands)", shape.rows(), shape.columns(), shape.bands())
}

/// A sample that is no number.
fn no_number<S: Sample>(samples: &[S], row: usize, shape: Shape) -> Option<Error> {
    let place = samples.iter().position(|sample| !(*sample).into().is_finite())?;
    let value: f64 = samples[place].into();
    let (column, band) = (place / shape.bands(), place % shape.bands());
    Some(
        Error::out_of_range("sample", value, "", "a finite number; leave out what the camera did not read")
            .for_key(format!("row {row}, column {column}, band {band} (counted from 0)")),
    )
}

/// Every row as it is read, by many threads; `of` is told the row and its samples, which may be no numbers where they may be `missing`.
fn rows<S: Sample, T: Send>(
    cube: &dyn Rows<S>,
    out: &mut [T],
    per_row: usize,
    missing: bool,
    of: impl Fn(&[S], &mut [T]) + Sync,
) -> Result<()> {
    let shape = cube.shape();
    parallel::fill(out, per_row, Vec::new, |buffer, row, out| {
        let samples = cube.read(row..row + 1, buffer)?;
        if !missing
            && !samples.iter().fold(true, |all, sample| all & (*sample).into().is_finite())
            && let Some(error) = no_number(samples, row, shape)
        {
            return Err(error);
        }
        of(samples, out);
        Ok(())
    })
}

/// What takes so many bytes for each sample of a cube is refused where the machine has no memory for it.
pub(super) fn check_memory(shape: Shape, bytes: u64, what: &str) -> Result<()> {
    let all = bytes.saturating_mul(shape.len() as u64);
    memory::check(all, what, "cut the cube into parts of fewer rows")
}

/// All samples.
pub(super) fn samples(cube: &Cube) -> Result<Vec<f64>> {
    let shape = cube.shape();
    check_memory(shape, 8, "all samples of the cube")?;
    let mut out = vec![0.0; shape.len()];
    match cube {
        Cube::F32(cube) => rows(cube.as_ref(), &mut out, shape.row_len(), false, copied),
        Cube::F64(cube) => rows(cube.as_ref(), &mut out, shape.row_len(), false, copied),
    }?;
    Ok(out)
}

fn copied<S: Sample>(samples: &[S], out: &mut [f64]) {
    out.iter_mut().zip(samples).for_each(|(out, sample)| *out = (*sample).into());
}

/// Two numbers made of each sample, given with its band; NaN of samples that are no numbers.
pub(super) fn pairs(cube: &Cube, of: impl Fn(usize, f64) -> [f32; 2] + Sync) -> Result<Vec<[f32; 2]>> {
    fn each<S: Sample>(
        cube: &dyn Rows<S>,
        out: &mut [[f32; 2]],
        of: impl Fn(usize, f64) -> [f32; 2] + Sync,
    ) -> Result<()> {
        let shape = cube.shape();
        let bands = shape.bands();
        rows(cube, out, shape.row_len(), true, |samples, out| {
            for (samples, out) in samples.chunks(bands).zip(out.chunks_mut(bands)) {
                for (band, (sample, out)) in samples.iter().zip(out).enumerate() {
                    let sample: f64 = (*sample).into();
                    *out = if sample.is_finite() { of(band, sample) } else { [f32::NAN; 2] };
                }
            }
        })
    }
    let mut out = vec![[0.0; 2]; cube.shape().len()];
    match cube {
        Cube::F32(cube) => each(cube.as_ref(), &mut out, of),
        Cube::F64(cube) => each(cube.as_ref(), &mut out, of),
    }?;
    Ok(out)
}

/// Mean of every band over all pixels, and the deviation of a pixel from it.
pub(super) fn means(cube: &Cube) -> Result<(Vec<f64>, Vec<f64>)> {
    let shape = cube.shape();
    let bands = shape.bands();
    let pixels = (shape.rows() * shape.columns()) as f64;
    let (mut sum, mut square) = (vec![0.0; bands], vec![0.0; bands]);
    let (mut first, mut samples) = (Vec::new(), Vec::new());
    for row in 0..shape.rows() {
        row_of(cube, row, false, &mut samples)?;
        if first.is_empty() {
            first.extend(samples.iter().take(bands).copied());
        }
        for pixel in samples.chunks(bands) {
            let sums = sum.iter_mut().zip(&mut square);
            for ((sample, first), (sum, square)) in pixel.iter().zip(&first).zip(sums) {
                let off = sample - first;
                *sum += off;
                *square += off * off;
            }
        }
    }
    let scatter = |(sum, square): (&f64, &f64)| {
        let var = (square - sum * sum / pixels) / (pixels - 1.0).max(1.0);
        var.max(0.0).sqrt()
    };
    let scatters = sum.iter().zip(&square).map(scatter).collect();
    Ok((first.iter().zip(&sum).map(|(first, sum)| first + sum / pixels).collect(), scatters))
}

/// A row of a cube as numbers.
fn row_of(cube: &Cube, row: usize, missing: bool, out: &mut Vec<f64>) -> Result<()> {
    fn of<S: Sample>(cube: &dyn Rows<S>, row: usize, missing: bool, out: &mut Vec<f64>) -> Result<()> {
        let mut buffer = Vec::new();
        let samples = cube.read(row..row + 1, &mut buffer)?;
        out.clear();
        out.extend(samples.iter().map(|sample| -> f64 { (*sample).into() }));
        match missing || out.iter().fold(true, |all, sample| all & sample.is_finite()) {
            true => Ok(()),
            false => no_number(samples, row, cube.shape()).map_or(Ok(()), Err),
        }
    }
    match cube {
        Cube::F32(cube) => of(cube.as_ref(), row, missing, out),
        Cube::F64(cube) => of(cube.as_ref(), row, missing, out),
    }
}

/// Three numbers made of every sample of a scene and those of the same place in other cubes, NaN where the scene has no number; `place` puts the name of the cube, 0 the
/// scene, on an error.
pub(super) fn beside(
    scene: &Cube,
    others: &[Cube],
    place: impl Fn(usize, Error) -> Error + Sync,
    of: impl Fn(usize, f64, &[f64]) -> [f32; 3] + Sync,
) -> Result<[Vec<f32>; 3]> {
    let shape = scene.shape();
    let [mut a, mut b, mut c] = [0; 3].map(|_| vec![0.0_f32; shape.len()]);
    let per_row = shape.row_len();
    let rows = a.par_chunks_mut(per_row).zip(b.par_chunks_mut(per_row)).zip(c.par_chunks_mut(per_row));
    let start = || (Vec::new(), vec![Vec::new(); others.len()], vec![0.0; others.len()]);
    rows.enumerate().try_for_each_init(start, |(own, beside, values), (row, ((a, b), c))| {
        hadar::stop::check();
        row_of(scene, row, true, own).map_err(|error| place(0, error))?;
        for (k, (cube, samples)) in others.iter().zip(beside.iter_mut()).enumerate() {
            row_of(cube, row, false, samples).map_err(|error| place(k + 1, error))?;
        }
        for (i, sample) in own.iter().enumerate() {
            values.iter_mut().zip(beside.iter()).for_each(|(value, samples)| *value = samples[i]);
            if sample.is_finite() {
                [a[i], b[i], c[i]] = of(i % shape.bands(), *sample, values);
            } else {
                [a[i], b[i], c[i]] = [f32::NAN; 3];
            }
        }
        Ok(())
    })?;
    Ok([a, b, c])
}
