//! NPY files: read by rows at their place in the file, and written.
//!
//! A read goes from the file straight into the caller's buffer; nothing is shared between threads but the file's
//! descriptor, so that several read at once.
//!
//! Source: NumPy, `numpy.lib.format` (versions 1.0, 2.0, 3.0).

use super::{Cube, READ_CUBE, Rows, Sample, Shape, beyond, dimensions};
use crate::error::{Error, Result};
use npyz::{DType, Endianness, NpyHeader, Order, TypeChar};
use std::fs::File;
use std::io::{BufWriter, Read, Seek, SeekFrom, Write};
use std::marker::PhantomData;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// What an NPY file begins with.
pub(super) const MAGIC: &[u8] = b"\x93NUMPY";

/// Longest header that is looked at, bytes; as NumPy has it.
const MAX_HEADER: usize = 10_000;

/// Deepest nesting of a header that is looked at: a type made of types made of types.
const MAX_DEPTH: usize = 8;

/// A cube in an NPY file.
#[derive(Debug)]
struct NpyCube<S> {
    file: File,
    path: PathBuf,
    shape: Shape,
    /// Place of the first sample in the file.
    start: u64,
    /// Whether the bytes of a sample stand in the other order than this processor's.
    swapped: bool,
    stored: Stored,
    sample: PhantomData<S>,
}

/// Opens an NPY file.
pub(super) fn open(mut file: File, path: &Path) -> Result<Cube> {
    let unreadable = |error: std::io::Error| Error::file(READ_CUBE, path, error);
    let len = file.metadata().map_err(unreadable)?.len();
    let (header, start) = header(&mut file, len)?;
    let (stored, order) = sample_type(&header.dtype())?;
    let shape = shape(&header)?;
    if header.order() == Order::Fortran {
        return Err(Error::malformed(
            "the array is in Fortran order, its rows not together",
            "write it with np.save(path, np.ascontiguousarray(a))",
        ));
    }
    check_len(len.saturating_sub(start), shape.len() as u64 * stored.bytes() as u64)?;
    let (path, swapped) = (path.to_owned(), order != Endianness::of_machine());
    Ok(if stored.is_double() {
        Cube::F64(Box::new(NpyCube { file, path, shape, start, swapped, stored, sample: PhantomData }))
    } else {
        Cube::F32(Box::new(NpyCube { file, path, shape, start, swapped, stored, sample: PhantomData }))
    })
}

/// What a sample is in the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Stored {
    Float(usize),
    Unsigned(usize),
    Signed(usize),
}

impl Stored {
    fn bytes(self) -> usize {
        let (Self::Float(bytes) | Self::Unsigned(bytes) | Self::Signed(bytes)) = self;
        bytes
    }

    /// Whether an `f32` does not hold all of its values.
    fn is_double(self) -> bool {
        match self {
            Self::Float(bytes) => bytes > 4,
            Self::Unsigned(bytes) | Self::Signed(bytes) => bytes > 2,
        }
    }

    /// A whole number of which the bytes are given, the least first.
    fn whole(self, bytes: &[u8]) -> f64 {
        let mut wide = [0; 8];
        wide[..bytes.len()].copy_from_slice(bytes);
        let shift = 64 - 8 * bytes.len() as u32;
        match self {
            Self::Signed(_) => ((u64::from_le_bytes(wide) << shift) as i64 >> shift) as f64,
            _ => u64::from_le_bytes(wide) as f64,
        }
    }
}

/// The header, and how many bytes it takes.
fn header(file: &mut File, len: u64) -> Result<(NpyHeader, u64)> {
    let cut = || truncated("the file ends within its header".to_owned());
    let mut bytes = Vec::with_capacity(256);
    // The first 12 bytes tell how many there are.
    let mut fill = |bytes: &mut Vec<u8>, upto: u64| -> Result<()> {
        file.seek(SeekFrom::Start(bytes.len() as u64)).map_err(|_| cut())?;
        (&*file).take(upto - bytes.len() as u64).read_to_end(bytes).map_err(|_| cut())?;
        if bytes.len() as u64 == upto { Ok(()) } else { Err(cut()) }
    };
    fill(&mut bytes, 12)?;
    let (before, text) = match bytes[6..12] {
        [1, _, low, high, ..] => (10, u32::from(u16::from_le_bytes([low, high]))),
        [2 | 3, _, a, b, c, d] => (12, u32::from_le_bytes([a, b, c, d])),
        [version, ..] => {
            return Err(Error::malformed(
                format!("the file is of version {version} of the NPY format"),
                "write version 1, 2 or 3, as np.save does",
            ));
        }
        [] => return Err(cut()),
    };
    let start = before + u64::from(text);
    if start > len {
        return Err(cut());
    }
    let strange = |text: &[u8]| {
        let shown: String = String::from_utf8_lossy(text).trim_end().chars().take(80).collect();
        Error::malformed(
            format!("the header `{shown}` is not that of an array of numbers in two or three dimensions"),
            "write the array with np.save(path, a)",
        )
    };
    if text as usize > MAX_HEADER {
        return Err(strange(&bytes));
    }
    fill(&mut bytes, start.max(12))?;
    let text = &bytes[before as usize..];
    // The parser tries every bracket as several things, each with all that is in it: its time doubles with every level.
    // Dimensions of more than 19 digits together would not fit its u64.
    let brackets = text.iter().filter(|byte| b"([{".contains(byte)).count();
    let digits = text.iter().filter(|byte| byte.is_ascii_digit()).count();
    if brackets > 64 || depth(text) > MAX_DEPTH || digits > 19 {
        return Err(strange(text));
    }
    let header = NpyHeader::from_reader(bytes.as_slice()).map_err(|_| strange(text))?;
    Ok((header, start))
}

/// Most brackets that are open at one place.
fn depth(text: &[u8]) -> usize {
    let (mut open, mut most) = (0_usize, 0);
    for byte in text {
        match byte {
            b'(' | b'[' | b'{' => open += 1,
            b')' | b']' | b'}' => open = open.saturating_sub(1),
            _ => {}
        }
        most = most.max(open);
    }
    most
}

/// What samples are, and the order of their bytes.
fn sample_type(dtype: &DType) -> Result<(Stored, Endianness)> {
    if let DType::Plain(plain) = dtype {
        let bytes = usize::try_from(plain.size_field()).unwrap_or(usize::MAX);
        let stored = match (plain.type_char(), bytes) {
            (TypeChar::Float, 4 | 8) => Some(Stored::Float(bytes)),
            (TypeChar::Uint, 1 | 2 | 4 | 8) => Some(Stored::Unsigned(bytes)),
            (TypeChar::Int, 1 | 2 | 4 | 8) => Some(Stored::Signed(bytes)),
            _ => None,
        };
        if let Some(stored) = stored {
            return Ok((stored, plain.endianness()));
        }
    }
    let name: String = dtype.descr().chars().take(80).collect();
    Err(Error::malformed(
        format!("the samples are of type {name}, not f4, f8 or whole numbers"),
        "write them with np.save(path, a.astype(np.float32))",
    ))
}

fn shape(header: &NpyHeader) -> Result<Shape> {
    let [rows, columns, bands] = match *header.shape() {
        [rows, columns] => [rows, columns, 1],
        [rows, columns, bands] => [rows, columns, bands],
        ref other => return Err(dimensions(other.len())),
    }
    .map(|n| usize::try_from(n).unwrap_or(usize::MAX));
    Shape::new(rows, columns, bands)
}

fn truncated(found: String) -> Error {
    Error::malformed(found, "it was not written or copied to its end; write it again")
}

fn check_len(found: u64, expected: u64) -> Result<()> {
    match found.cmp(&expected) {
        std::cmp::Ordering::Equal => Ok(()),
        std::cmp::Ordering::Less => Err(truncated(format!(
            "the file has {found} of the {expected} bytes of samples that its header announces"
        ))),
        std::cmp::Ordering::Greater => Err(Error::malformed(
            format!("the file has {} bytes more than its header announces", found - expected),
            "write the array alone with np.save(path, a)",
        )),
    }
}

impl<S: Sample> Rows<S> for NpyCube<S> {
    fn shape(&self) -> Shape {
        self.shape
    }

    fn read<'a>(&'a self, rows: Range<usize>, buffer: &'a mut Vec<S>) -> Result<&'a [S]> {
        if rows.start > rows.end || rows.end > self.shape.rows() {
            return Err(beyond(&rows, self.shape));
        }
        let len = rows.len() * self.shape.row_len();
        // What is there already is only overwritten: cleared once, not with every read.
        if buffer.len() < len {
            buffer.resize(len, S::zeroed());
        }
        let samples = &mut buffer[..len];
        let size = self.stored.bytes();
        let place = self.start + (rows.start * self.shape.row_len() * size) as u64;
        let unread = |error: std::io::Error| {
            let found = match error.kind() {
                std::io::ErrorKind::UnexpectedEof => {
                    "the file has become shorter since it was opened; open it again".to_owned()
                }
                _ => error.to_string(),
            };
            let action = format!("read rows {} to {} of the cube", rows.start, rows.end);
            Error::file(action, &self.path, found)
        };
        if !matches!(self.stored, Stored::Float(_)) {
            let mut bytes = vec![0; len * size];
            read_at(&self.file, &self.path, &mut bytes, place).map_err(unread)?;
            if self.swapped != cfg!(target_endian = "big") {
                bytes.chunks_exact_mut(size).for_each(<[u8]>::reverse);
            }
            match self.stored {
                // Counts of most cameras, without a detour.
                Stored::Unsigned(2) => {
                    let each = samples.iter_mut().zip(bytes.as_chunks().0);
                    each.for_each(|(sample, bytes)| *sample = S::of(u16::from_le_bytes(*bytes).into()));
                }
                Stored::Unsigned(4) => {
                    let each = samples.iter_mut().zip(bytes.as_chunks().0);
                    each.for_each(|(sample, bytes)| *sample = S::of(u32::from_le_bytes(*bytes).into()));
                }
                _ => {
                    let each = samples.iter_mut().zip(bytes.chunks_exact(size));
                    each.for_each(|(sample, bytes)| *sample = S::of(self.stored.whole(bytes)));
                }
            }
            return Ok(samples);
        }
        read_at(&self.file, &self.path, bytemuck::cast_slice_mut(samples), place).map_err(unread)?;
        if self.swapped {
            swap_bytes(samples);
        }
        Ok(samples)
    }
}

#[cfg(unix)]
fn read_at(file: &File, _path: &Path, bytes: &mut [u8], place: u64) -> std::io::Result<()> {
    std::os::unix::fs::FileExt::read_exact_at(file, bytes, place)
}

#[cfg(not(unix))]
fn read_at(_file: &File, path: &Path, bytes: &mut [u8], place: u64) -> std::io::Result<()> {
    read_reopened(path, bytes, place)
}

/// Where the system has no read at a place, every read has its own descriptor, so that threads need not wait.
#[cfg(any(not(unix), test))]
fn read_reopened(path: &Path, bytes: &mut [u8], place: u64) -> std::io::Result<()> {
    let mut file = File::open(path)?;
    file.seek(SeekFrom::Start(place))?;
    file.read_exact(bytes)
}

fn swap_bytes<S: Sample>(samples: &mut [S]) {
    if size_of::<S>() == size_of::<u32>() {
        bytemuck::cast_slice_mut::<S, u32>(samples).iter_mut().for_each(|word| *word = word.swap_bytes());
    } else {
        bytemuck::cast_slice_mut::<S, u64>(samples).iter_mut().for_each(|word| *word = word.swap_bytes());
    }
}

/// Writes samples `[row][column][band]` to an NPY file (version 1, three dimensions); one that is there is replaced.
///
/// # Errors
/// A number of samples that is not that of the shape; a file that cannot be written.
///
/// ```no_run
/// use hadar::cube::{Shape, write_npy};
/// write_npy("scene.npy".as_ref(), Shape::new(1, 2, 2)?, &[10.0_f32, 11.0, 20.0, 21.0])?;
/// # Ok::<(), hadar::Error>(())
/// ```
pub fn write_npy<S: Sample>(path: &Path, shape: Shape, samples: &[S]) -> Result<()> {
    check_samples(shape, samples)?;
    let unwritten = |error: std::io::Error| Error::file("write the cube", path, error);
    let file = File::create(path).map_err(unwritten)?;
    let mut writer = BufWriter::new(file);
    put(&mut writer, shape, samples).and_then(|()| writer.flush()).map_err(unwritten)
}

/// Writes samples `[row][column][band]` in NPY format (version 1, three dimensions).
///
/// # Errors
/// A number of samples that is not that of the shape; whatever the writer refuses.
///
/// ```
/// use hadar::cube::{Shape, write_npy_to};
/// let mut bytes = Vec::new();
/// write_npy_to(&mut bytes, Shape::new(1, 2, 2)?, &[10.0_f32, 11.0, 20.0, 21.0])?;
/// assert!(bytes.starts_with(b"\x93NUMPY\x01\x00"));
/// assert_eq!(bytes.len(), 128 + 4 * 4);
/// # Ok::<(), hadar::Error>(())
/// ```
pub fn write_npy_to<S: Sample>(mut writer: impl Write, shape: Shape, samples: &[S]) -> Result<()> {
    check_samples(shape, samples)?;
    put(&mut writer, shape, samples)
        .map_err(|error| Error::File { action: "write the cube".to_owned(), reason: error.to_string() })
}

fn check_samples<S: Sample>(shape: Shape, samples: &[S]) -> Result<()> {
    if samples.len() == shape.len() {
        return Ok(());
    }
    Err(Error::Length { what: "samples of a cube".to_owned(), found: samples.len(), expected: shape.len() })
}

fn put<S: Sample>(writer: &mut impl Write, shape: Shape, samples: &[S]) -> std::io::Result<()> {
    array(writer, &format!("f{}", size_of::<S>()), &[shape.rows(), shape.columns(), shape.bands()], samples)
}

/// What a map holds for each pixel.
pub trait Value: bytemuck::Pod {
    /// NumPy's name of the type, without the order of bytes.
    const NAME: &'static str;
}

impl Value for u8 {
    const NAME: &'static str = "u1";
}

impl Value for u16 {
    const NAME: &'static str = "u2";
}

impl Value for f32 {
    const NAME: &'static str = "f4";
}

/// A map of such dimensions, the last one running fastest, as an NPY file (version 1).
///
/// # Errors
/// A number of values that is not that of the dimensions.
///
/// ```
/// let file = hadar::cube::npy_map(&[1, 2], &[3_u16, 65535])?;
/// assert_eq!(file.len(), 128 + 2 * 2);
/// let of_one = hadar::cube::npy_map(&[2], &[3_u16, 65535])?;
/// assert!(String::from_utf8_lossy(&of_one).contains("'shape': (2,)"));
/// # Ok::<(), hadar::Error>(())
/// ```
pub fn npy_map<V: Value>(dimensions: &[usize], values: &[V]) -> Result<Vec<u8>> {
    let expected = dimensions.iter().product();
    if values.len() != expected {
        return Err(Error::Length { what: "values of a map".to_owned(), found: values.len(), expected });
    }
    let mut file = Vec::new();
    array(&mut file, V::NAME, dimensions, values)
        .map_err(|error| Error::File { action: "write the map".to_owned(), reason: error.to_string() })?;
    Ok(file)
}

fn array<V: bytemuck::Pod>(
    writer: &mut impl Write,
    name: &str,
    dimensions: &[usize],
    values: &[V],
) -> std::io::Result<()> {
    let order = if size_of::<V>() == 1 { "|" } else { Endianness::of_machine().to_str() };
    let dimensions = match dimensions {
        // To NumPy (10) is a number, no shape.
        [one] => format!("{one},"),
        more => more.iter().map(usize::to_string).collect::<Vec<_>>().join(", "),
    };
    let text = format!("{{'descr': '{order}{name}', 'fortran_order': False, 'shape': ({dimensions}), }}");
    // Blanks and a line feed make 10 bytes and the text a multiple of 64: at most 3·20 digits, far below 2¹⁶.
    let padded = (10 + text.len() + 1).next_multiple_of(64) - 11;
    writer.write_all(MAGIC)?;
    writer.write_all(&[1, 0])?;
    writer.write_all(&(padded as u16 + 1).to_le_bytes())?;
    writeln!(writer, "{text:<padded$}")?;
    writer.write_all(bytemuck::cast_slice(values))
}

#[cfg(test)]
mod tests;
