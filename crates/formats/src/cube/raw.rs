//! Samples that stand in a file as they are, one after the other in any order of axes: read by rows at their place.
//!
//! Where rows are together and are stored as they are wanted, a read goes from the file straight into the caller's buffer.
//! Where every row is spread over the whole file, a block of rows is gathered at a time. Nothing else is shared between
//! threads but the file's descriptor.

use super::arrange::Part;
use super::axes::Axes;
use super::blocks::{Blocks, room};
use super::stored::{Stored, decode};
use super::values::Values;
use hadar::cube::{Cube, Rows, Sample, Shape};
use hadar::error::{Error, Result};
use std::fs::File;
use std::marker::PhantomData;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Most that one byte of a packed stream can stand for (RFC 1951: 258 bytes in two bits).
pub(super) const MAX_INFLATION: u64 = 1032;
/// Bytes of a run below which many runs are read at once, with what lies between them.
const SHORT_RUN: usize = 1 << 12;
/// Bytes that are then read at once.
const SPAN: usize = 1 << 20;

/// Where samples stand, and how.
#[derive(Debug)]
pub(super) struct Raw {
    pub(super) file: File,
    pub(super) path: PathBuf,
    pub(super) shape: Shape,
    /// Place of the first sample in the file.
    pub(super) start: u64,
    /// Outermost first.
    pub(super) order: Axes,
    pub(super) stored: Stored,
    pub(super) little_endian: bool,
    /// What the numbers stand for, where they are not the samples themselves.
    pub(super) values: Option<Values>,
}

/// A cube of such samples.
#[derive(Debug)]
struct RawCube<S> {
    raw: Raw,
    blocks: Option<Blocks<S>>,
    sample: PhantomData<S>,
}

impl Raw {
    /// Bytes of all samples.
    pub(super) fn bytes(shape: Shape, stored: Stored) -> u64 {
        shape.len() as u64 * stored.size() as u64
    }

    pub(super) fn cube(self) -> Cube {
        if self.stored.is_double() {
            Cube::F64(Box::new(RawCube::of(self)))
        } else {
            Cube::F32(Box::new(RawCube::of(self)))
        }
    }

    fn unread(&self, rows: &Range<usize>, error: std::io::Error) -> Error {
        let found = match error.kind() {
            std::io::ErrorKind::UnexpectedEof => {
                "the file has become shorter since it was opened; open it again".to_owned()
            }
            _ => error.to_string(),
        };
        Error::file(format!("read rows {} to {} of the cube", rows.start, rows.end), &self.path, found)
    }

    /// Fills bytes from the place of a sample.
    fn fill(&self, bytes: &mut [u8], place: usize) -> std::io::Result<()> {
        read_at(&self.file, &self.path, bytes, self.start + (place * self.stored.size()) as u64)
    }

    /// Whether the file has the rows as they are wanted, each with all its samples.
    fn is_plain<S: Sample>(&self) -> bool {
        let native = self.little_endian == cfg!(target_endian = "little");
        self.order == Axes::default() && native && self.stored.name() == S::NAME
    }

    /// Rows as the numbers stand there.
    fn gather<S: Sample>(&self, rows: &Range<usize>, samples: &mut [S]) -> std::io::Result<()> {
        let (size, first) = (self.stored.size(), rows.start * self.shape.row_len());
        if self.is_plain::<S>() {
            return self.fill(bytemuck::cast_slice_mut(samples), first);
        }
        let mut bytes = Vec::new();
        let decoded = |bytes: &[u8], out: &mut [S]| decode(bytes, self.stored, self.little_endian, out);
        if self.order == Axes::default() {
            bytes.resize(samples.len() * size, 0);
            self.fill(&mut bytes, first)?;
            decoded(&bytes, samples);
            return Ok(());
        }
        // Runs of neighbours, one for every place on the axes outside the rows'.
        let sides = self.order.sides(self.shape);
        let (outside, inside) = sides.split_at(self.order.place_of_rows());
        let runs: usize = outside.iter().product();
        let within: usize = inside.iter().skip(1).product();
        let (run, step) = (rows.len() * within, self.shape.rows() * within);
        if run == 0 {
            return Ok(());
        }
        let mut found = vec![S::zeroed(); run * runs];
        let together = if run * size < SHORT_RUN { (SPAN / (step * size)).max(1) } else { 1 };
        for (group, out) in found.chunks_mut(run * together).enumerate() {
            let first = group * together * step + rows.start * within;
            bytes.resize(((out.len() / run - 1) * step + run) * size, 0);
            self.fill(&mut bytes, first)?;
            for (one, bytes) in out.chunks_mut(run).zip(bytes.chunks(step * size)) {
                decoded(bytes, one);
            }
        }
        let small = Shape::new(rows.len(), self.shape.columns(), self.shape.bands())
            .map_err(std::io::Error::other)?;
        let (columns, bands) = (0..small.columns(), 0..small.bands());
        Part { samples: &found, strides: self.order.strides(small), columns, bands }.put(0, samples, small);
        Ok(())
    }
}

impl<S: Sample> RawCube<S> {
    fn of(raw: Raw) -> Self {
        let blocks = (raw.order.place_of_rows() == 2).then(|| Blocks::new(raw.shape, 1));
        Self { raw, blocks, sample: PhantomData }
    }
}

impl<S: Sample> Rows<S> for RawCube<S> {
    fn shape(&self) -> Shape {
        self.raw.shape
    }

    fn read<'a>(&'a self, rows: Range<usize>, buffer: &'a mut Vec<S>) -> Result<&'a [S]> {
        hadar::stop::check();
        let shape = self.raw.shape;
        let samples = room(&rows, shape, buffer)?;
        let gather = |rows: &Range<usize>, samples: &mut [S]| {
            self.raw.gather(rows, samples).map_err(|error| self.raw.unread(rows, error))
        };
        match &self.blocks {
            None => gather(&rows, samples)?,
            Some(blocks) => blocks.read(rows, samples, gather)?,
        }
        if let Some(values) = &self.raw.values {
            values.of_stored(samples, shape.bands());
        }
        Ok(samples)
    }
}

#[cfg(unix)]
pub(super) fn read_at(file: &File, _path: &Path, bytes: &mut [u8], place: u64) -> std::io::Result<()> {
    std::os::unix::fs::FileExt::read_exact_at(file, bytes, place)
}

#[cfg(not(unix))]
pub(super) fn read_at(_file: &File, path: &Path, bytes: &mut [u8], place: u64) -> std::io::Result<()> {
    read_reopened(path, bytes, place)
}

/// Where the system has no read at a place, every read has its own descriptor, so that threads need not wait.
#[cfg(any(not(unix), test))]
pub(super) fn read_reopened(path: &Path, bytes: &mut [u8], place: u64) -> std::io::Result<()> {
    use std::io::{Read, Seek, SeekFrom};
    let mut file = File::open(path)?;
    file.seek(SeekFrom::Start(place))?;
    file.read_exact(bytes)
}
