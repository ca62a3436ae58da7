//! Maps of the pixels of a cube in files.

use hadar::cube::{Cube, Rows, Sample, Shape};
use hadar::error::{Error, Result};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// A map in a file.
#[derive(Debug)]
pub(crate) struct Map {
    pub(crate) path: PathBuf,
    pub(crate) cube: Cube,
}

impl Map {
    /// A map of the pixels of a cube, of so many layers as one of `layers`.
    pub(crate) fn open(path: &Path, shape: Shape, layers: &[usize]) -> Result<Self> {
        let cube = hadar_formats::cube::open(path, None)?;
        let found = cube.shape();
        if (found.rows(), found.columns()) != (shape.rows(), shape.columns())
            || !layers.contains(&found.bands())
        {
            let found = format!(
                "the map is {} x {} x {}, the cube {} x {} pixels",
                found.rows(),
                found.columns(),
                found.bands(),
                shape.rows(),
                shape.columns()
            );
            return Err(Error::malformed(found, "give one value for each pixel").in_file(path));
        }
        Ok(Self { path: path.to_owned(), cube })
    }

    pub(crate) fn read(&self, rows: Range<usize>) -> Result<Vec<f64>> {
        read(&self.cube, rows)
    }
}

/// Samples of some rows of a cube.
pub(crate) fn read(cube: &Cube, rows: Range<usize>) -> Result<Vec<f64>> {
    fn of<S: Sample>(cube: &dyn Rows<S>, rows: Range<usize>) -> Result<Vec<f64>> {
        Ok(cube.read(rows, &mut Vec::new())?.iter().map(|x| (*x).into()).collect())
    }
    match cube {
        Cube::F32(cube) => of(cube.as_ref(), rows),
        Cube::F64(cube) => of(cube.as_ref(), rows),
    }
}
