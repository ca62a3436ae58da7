//! Variances of electronic noise from a file.
//!
//! A CSV file has a column `variance_counts2` and, if wanted, `band` (in steps of 1) or `wavenumber_cm1` (rising or
//! falling, and then turned round); one row per band, bands counted in rising wavenumber. An NPY or MATLAB file has one variance per sample.

use crate::cube::{is_cube, open_as};
use crate::file::text_of_file;
use hadar::cube::Shape;
use hadar::error::{Error, Result, check};
use hadar::grid::Grid;
use hadar::ranging::noise::NoiseVariance;
use std::path::Path;

const VARIANCE: &str = "variance_counts2";

/// How to begin, for messages.
const EXAMPLE: &str = "begin it with a line such as band,variance_counts2, and give one row per band";

/// Reads the variances for a cube of this shape: one per band from a CSV file, or one per sample from an NPY or
/// MATLAB file as [`cube::open_as`](open_as) reads it. Samples of a file that does not state its bands are in the order of the cube's
/// own file, of which each band in rising wavenumber is one of `order`.
///
/// # Errors
/// A file that cannot be read, columns of another name, a variance that is negative or no number, bands out of
/// order, another number of bands or samples than the cube has.
///
/// ```no_run
/// use hadar::cube::Shape;
/// let noise = hadar_formats::noise_variance("read_noise.csv".as_ref(), Shape::new(480, 640, 54)?, None)?;
/// # Ok::<(), hadar::Error>(())
/// ```
pub fn noise_variance(path: &Path, shape: Shape, order: Option<&[usize]>) -> Result<NoiseVariance> {
    if !path.is_dir() && path.exists() && is_cube(path)? {
        let opened = open_as(path, None, None)?;
        let bands = opened.found.rising_bands(order);
        let noise = NoiseVariance::PerSample(opened.cube.with_bands(bands)?);
        noise.check(shape).map_err(|error| error.in_file(path))?;
        return Ok(noise);
    }
    let text = text_of_file(path, "read the noise variances")?;
    per_band(&text, shape).map_err(|error| error.in_file(path))
}

fn per_band(text: &str, shape: Shape) -> Result<NoiseVariance> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let is_row = |line: &str| !line.trim().is_empty() && !line.trim_start().starts_with('#');
    let header = text.lines().find(|line| is_row(line)).unwrap_or("");
    if !header.split(',').any(|cell| cell.trim().trim_matches('"').trim() == VARIANCE) {
        return Err(Error::malformed(format!("the file has no column {VARIANCE}"), EXAMPLE));
    }
    // A table has at least two columns; the only one of a list is written twice.
    let alone = !header.contains(',');
    let doubled = |line: &str| if alone && is_row(line) { format!("{line},{line}") } else { line.to_owned() };
    let grid = Grid::parse(&text.lines().map(doubled).collect::<Vec<_>>().join("\n"))?;
    let (mut variances, mut falling) = (Vec::new(), false);
    for (column, name) in grid.header.iter().enumerate() {
        let cells =
            grid.rows.iter().map(|(line, cells)| (*line, cells.get(column).copied().unwrap_or(f64::NAN)));
        match name.as_str() {
            VARIANCE => variances = cells.map(variance).collect::<Result<_>>()?,
            "band" => in_order(name, cells, |step, _| step == 1.0)?,
            "wavenumber_cm1" => {
                let mut ends = cells.clone().map(|(_, nu)| nu);
                falling = ends.next().zip(ends.next()).is_some_and(|(first, second)| second < first);
                in_order(name, cells, |step, first| step * first > 0.0)?;
            }
            other => {
                return Err(Error::malformed(
                    format!("a column `{other}`"),
                    "keep only variance_counts2 and band or wavenumber_cm1",
                )
                .for_key(other)
                .on_line(grid.header_line));
            }
        }
    }
    if falling {
        variances.reverse();
    }
    let noise = NoiseVariance::PerBand(variances);
    noise.check(shape)?;
    Ok(noise)
}

fn variance((line, value): (usize, f64)) -> Result<f64> {
    check::non_negative("noise variance", value, "counts^2")
        .map_err(|error| error.for_key(VARIANCE).on_line(line))
}

/// Makes sure that rows are in the order of the bands: `follows` says so of a step, given the first step.
fn in_order(
    name: &str,
    mut cells: impl Iterator<Item = (usize, f64)>,
    follows: impl Fn(f64, f64) -> bool,
) -> Result<()> {
    let Some((_, mut before)) = cells.next() else { return Ok(()) };
    let mut first_step = None;
    for (line, value) in cells {
        let step = value - before;
        if !follows(step, *first_step.get_or_insert(step)) {
            return Err(Error::malformed(
                format!("{name} {value} after {before}"),
                "give one row per band, in the order of the cube",
            )
            .for_key(name)
            .on_line(line));
        }
        before = value;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cube::write_npy;

    fn of(text: &str, bands: usize) -> Result<Vec<f64>> {
        per_band(text, Shape::new(2, 2, bands).unwrap()).map(|noise| match noise {
            NoiseVariance::PerBand(variances) => variances,
            other => panic!("{other:?}"),
        })
    }

    #[test]
    fn one_row_per_band_with_or_without_their_names() {
        assert_eq!(of("variance_counts2\n4\n0\n2.5\n", 3).unwrap(), [4.0, 0.0, 2.5]);
        assert_eq!(of("# read noise\nband,variance_counts2\n1,4\n2,9\n", 2).unwrap(), [4.0, 9.0]);
        assert_eq!(
            of("\u{feff}variance_counts2, wavenumber_cm1\n4,900\n9,880\n1,800", 3).unwrap(),
            [1.0, 9.0, 4.0]
        );
    }

    #[test]
    fn mistakes_name_line_and_column() {
        for (text, message) in [
            (
                "band,sigma\n1,2\n",
                "the file has no column variance_counts2; begin it with a line such as band,variance_counts2, and give one row per band",
            ),
            ("variance_counts2\n1\n2\n3\n", "noise variances, one per band: 3 values where 2 are needed"),
            ("variance_counts2\n", "noise variances, one per band: 0 values where 2 are needed"),
            (
                "variance_counts2\n1\n\n-2\n",
                "line 4: variance_counts2: noise variance is -2 counts^2; it must be a finite number, 0 or above",
            ),
            (
                "band,variance_counts2\n1,1\n3,1\n",
                "line 3: band: band 3 after 1; give one row per band, in the order of the cube",
            ),
            (
                "wavenumber_cm1,variance_counts2\n800,1\n800,1\n",
                "line 3: wavenumber_cm1: wavenumber_cm1 800 after 800; give one row per band, in the order of the cube",
            ),
            (
                "gain,variance_counts2\n1,1\n2,1\n",
                "line 1: gain: a column `gain`; keep only variance_counts2 and band or wavenumber_cm1",
            ),
        ] {
            assert_eq!(of(text, 2).unwrap_err().to_string(), message);
        }
        let falling = "wavenumber_cm1,variance_counts2\n900,1\n880,1\n890,1\n";
        assert!(of(falling, 3).unwrap_err().to_string().starts_with("line 4: wavenumber_cm1: "));
        assert!(of("variance_counts2\nNaN\n1\n", 2).is_err());
        assert!(of("", 2).is_err());
    }

    #[test]
    fn a_cube_of_variances_has_the_shape_of_the_counts() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("noise");
        let shape = Shape::new(2, 1, 2).unwrap();
        write_npy(&path, shape, &[1.0_f32, 2.0, 3.0, 4.0]).unwrap();
        assert!(matches!(noise_variance(&path, shape, None).unwrap(), NoiseVariance::PerSample(_)));
        let error = noise_variance(&path, Shape::new(2, 2, 2).unwrap(), None).unwrap_err().to_string();
        assert!(error.contains("2 x 1 x 2 samples, the cube has 2 x 2 x 2"), "{error}");
        std::fs::write(&path, "variance_counts2\n1\n2\n").unwrap();
        assert!(matches!(noise_variance(&path, shape, None).unwrap(), NoiseVariance::PerBand(_)));
        let missing = noise_variance(&folder.path().join("none"), shape, None).unwrap_err().to_string();
        assert!(missing.contains("there is no such file"), "{missing}");
        let directory = noise_variance(folder.path(), shape, None).unwrap_err().to_string();
        assert!(directory.contains("this is a directory"), "{directory}");
    }
}
