//! NPY files written and read again by rows, in any order and by several threads: maps that are larger than memory.

use super::npy::{Value, array};
use hadar::error::{Error, Result};
use std::fs::File;
use std::io::{Read, Seek, SeekFrom, Write};
use std::marker::PhantomData;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// An NPY file (version 1) whose rows are written at their places.
///
/// ```
/// # let folder = tempfile::tempdir()?;
/// # let path = folder.path().join("map.npy");
/// use hadar_formats::cube::{NpyRows, npy_map};
/// let file = NpyRows::<u16>::create(&path, &[3, 2])?;
/// file.write(1, &[3, 4, 5, 6])?;
/// file.write(0, &[1, 2])?;
/// assert_eq!(file.read(1..3)?, [3, 4, 5, 6]);
/// assert_eq!(std::fs::read(&path)?, npy_map::<u16>(&[3, 2], &[1, 2, 3, 4, 5, 6])?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct NpyRows<V> {
    file: Mutex<File>,
    path: PathBuf,
    rows: usize,
    /// Values of a row.
    width: usize,
    /// Place of the first value.
    start: u64,
    value: PhantomData<V>,
}

impl<V: Value> NpyRows<V> {
    /// A file for an array of such dimensions, of which the first are the rows; one that is there is replaced. Rows that are never
    /// written are 0.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn create(path: &Path, dimensions: &[usize]) -> Result<Self> {
        let rows = dimensions.first().copied().unwrap_or(0);
        let width: usize = dimensions.iter().skip(1).product();
        let begin = || -> std::io::Result<(File, u64)> {
            let mut file = File::options().read(true).write(true).create(true).truncate(true).open(path)?;
            array::<V>(&mut file, V::NAME, dimensions, &[])?;
            let start = file.stream_position()?;
            file.set_len(start + (rows * width * size_of::<V>()) as u64)?;
            Ok((file, start))
        };
        let (file, start) = begin().map_err(|error| Error::file("write the map", path, error))?;
        Ok(Self { file: Mutex::new(file), path: path.to_owned(), rows, width, start, value: PhantomData })
    }

    /// Writes whole rows, from row `first` on.
    ///
    /// # Errors
    /// Values that are no whole rows, or beyond the last; a disk that is full.
    pub fn write(&self, first: usize, values: &[V]) -> Result<()> {
        let left = self.rows.saturating_sub(first) * self.width;
        if values.len() > left || !values.len().is_multiple_of(self.width.max(1)) {
            return Err(Error::Length {
                what: format!("values from row {first} of a map of rows of {}", self.width),
                found: values.len(),
                expected: left,
            });
        }
        let place = self.start + (first * self.width * size_of::<V>()) as u64;
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        file.seek(SeekFrom::Start(place))
            .and_then(|_| file.write_all(bytemuck::cast_slice(values)))
            .map_err(|error| Error::file("write the map", &self.path, error))
    }

    /// The values of whole rows, as they were written.
    ///
    /// # Errors
    /// Rows that are none; a file that cannot be read.
    pub fn read(&self, rows: Range<usize>) -> Result<Vec<V>> {
        hadar::stop::check();
        if rows.start > rows.end || rows.end > self.rows {
            let found = format!("rows {} to {} of a map", rows.start, rows.end);
            return Err(Error::malformed(found, format!("the map has {} rows", self.rows)));
        }
        let mut values = vec![V::zeroed(); rows.len() * self.width];
        let place = self.start + (rows.start * self.width * size_of::<V>()) as u64;
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        file.seek(SeekFrom::Start(place))
            .and_then(|_| file.read_exact(bytemuck::cast_slice_mut(&mut values)))
            .map_err(|error| Error::file("read the map", &self.path, error))?;
        Ok(values)
    }

    /// Where it is.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_that_are_none_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let file = NpyRows::<f32>::create(&folder.path().join("a.npy"), &[2, 3]).unwrap();
        for (first, len) in [(0, 2), (1, 6), (2, 3), (usize::MAX, 3)] {
            assert!(file.write(first, &vec![1.0; len]).is_err(), "{first} {len}");
        }
        file.write(1, &[1.0; 3]).unwrap();
        assert_eq!(file.read(0..2).unwrap(), [0.0, 0.0, 0.0, 1.0, 1.0, 1.0]);
        assert!(file.read(1..3).is_err());
        assert_eq!(std::fs::metadata(file.path()).unwrap().len(), 128 + 24);
        assert!(NpyRows::<f32>::create(&folder.path().join("none/a.npy"), &[2, 3]).is_err());
    }
}
