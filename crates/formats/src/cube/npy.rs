//! NPY files: what their header says, and how they are written.
//!
//! Source: NumPy, `numpy.lib.format` (versions 1.0, 2.0, 3.0).

mod header;

use super::READ_CUBE;
use super::axes::Axes;
use super::found::{Found, Opened};
use super::raw::Raw;
use super::stored::{Stored, decode_next};
use hadar::cube::{Sample, Shape};
use hadar::error::{Error, Result};
use header::Header;
use std::fs::File;
use std::io::{BufWriter, Read, Seek, SeekFrom, Write};
use std::path::Path;

/// What an NPY file begins with.
pub(super) const MAGIC: &[u8] = b"\x93NUMPY";

/// Longest header that is looked at, bytes; as NumPy has it.
const MAX_HEADER: usize = 10_000;

/// What the header of an array says.
#[derive(Debug)]
pub(super) struct Array {
    pub(super) shape: Shape,
    pub(super) sides: Vec<usize>,
    /// Outermost first, as it is stored.
    pub(super) order: Axes,
    pub(super) stored: Stored,
    pub(super) little_endian: bool,
    /// Bytes before the first sample.
    pub(super) start: u64,
}

/// Opens an array that fills `len` bytes of a file from a place.
pub(super) fn open(
    mut file: File,
    path: &Path,
    (place, len): (u64, u64),
    axes: Option<Axes>,
    format: &'static str,
) -> Result<Opened> {
    file.seek(SeekFrom::Start(place)).map_err(|error| Error::file(READ_CUBE, path, error))?;
    let array = Array::read(&mut file, len, axes)?;
    let Array { shape, sides, order, stored, little_endian, start } = array;
    let start = place + start;
    let raw = Raw { file, path: path.to_owned(), shape, start, order, stored, little_endian, values: None };
    let cube = raw.cube();
    let found = Found { axes, ..Found::array(format, shape, stored.name(), &sides) };
    Ok(Opened { cube, found })
}

impl Array {
    /// Reads the header of an array of `len` bytes in all.
    pub(super) fn read(file: &mut impl Read, len: u64, axes: Option<Axes>) -> Result<Self> {
        let (header, start) = header(file, len)?;
        let (stored, little_endian) = sample_type(&header.descr)?;
        let sides = header.sides;
        let said = axes.unwrap_or_default();
        let shape = said.shape(&sides)?;
        check_len(len.saturating_sub(start), Raw::bytes(shape, stored))?;
        // The first index runs fastest in Fortran order; the third of two is that of the only band, wherever it stands.
        let order_of_axes = if header.fortran_order { said.reversed() } else { said };
        Ok(Self { shape, sides, order: order_of_axes, stored, little_endian, start })
    }
}

/// The numbers of a list, if an array of `len` bytes in all is one of `count` numbers.
pub(super) fn list(file: &mut impl Read, len: u64, count: usize) -> Option<Vec<f64>> {
    let (header, start) = header(file, len).ok()?;
    let (stored, little_endian) = sample_type(&header.descr).ok()?;
    let sides = header.sides;
    let bytes = (count as u64).checked_mul(stored.size() as u64)?;
    let is_list = sides.iter().filter(|side| **side != 1).count() <= 1;
    if !is_list || len.checked_sub(start) != Some(bytes) {
        return None;
    }
    let mut numbers = vec![0.0_f64; count];
    let exact = |bytes: &mut [u8]| file.read_exact(bytes).map_err(|error| truncated(error.to_string()));
    decode_next(exact, stored, little_endian, &mut numbers).ok()?;
    Some(numbers)
}

/// The one text of at most so many characters of an array of `len` bytes in all: bytes, or whole characters of four bytes.
pub(super) fn text(file: &mut impl Read, len: u64, most: usize) -> Option<String> {
    let (Header { descr, sides, .. }, start) = header(file, len).ok()?;
    let kind = header::quoted(&descr)?;
    let (order, kind) = kind.split_at_checked(1)?;
    let (kind, count) = kind.split_at_checked(1)?;
    let count: usize = count.parse().ok().filter(|count| *count <= most)?;
    let size = match kind {
        "S" => 1,
        "U" => 4,
        _ => return None,
    };
    if sides.iter().any(|side| *side != 1) || len.checked_sub(start) != Some((size * count) as u64) {
        return None;
    }
    let mut bytes = vec![0; size * count];
    file.read_exact(&mut bytes).ok()?;
    if size == 1 {
        return Some(String::from_utf8_lossy(&bytes).into_owned());
    }
    let (characters, _) = bytes.as_chunks::<4>();
    let code =
        |four: &[u8; 4]| if order == ">" { u32::from_be_bytes(*four) } else { u32::from_le_bytes(*four) };
    characters.iter().map(|four| char::from_u32(code(four))).collect()
}

/// The header, and how many bytes it takes.
fn header(file: &mut impl Read, len: u64) -> Result<(Header, u64)> {
    let cut = || truncated("the file ends within its header".to_owned());
    let mut bytes = Vec::with_capacity(256);
    // The first 12 bytes tell how many there are.
    let mut fill = |bytes: &mut Vec<u8>, upto: u64| -> Result<()> {
        file.take(upto - bytes.len() as u64).read_to_end(bytes).map_err(|_| cut())?;
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
    let header = std::str::from_utf8(text).ok().and_then(header::parse).ok_or_else(|| strange(text))?;
    Ok((header, start))
}

/// What samples are, and whether their lowest byte comes first.
fn sample_type(descr: &str) -> Result<(Stored, bool)> {
    let plain = header::quoted(descr).unwrap_or_default();
    let name = plain.trim_start_matches(['<', '>', '|']);
    let (kind, size) = name.split_at_checked(1).unwrap_or_default();
    let size = if size.bytes().all(|byte| byte.is_ascii_digit()) { size.parse().unwrap_or(0) } else { 0 };
    let stored = match kind {
        "f" => Stored::float(size),
        "u" => Stored::whole(false, size),
        "i" => Stored::whole(true, size),
        _ => None,
    };
    // Only of single bytes there is no order.
    let stored = stored.filter(|_| match plain.len() - name.len() {
        1 => size == 1 || !plain.starts_with('|'),
        _ => false,
    });
    if let Some(stored) = stored {
        return Ok((stored, plain.starts_with('<')));
    }
    if name == "b1" {
        let instead = "write what was counted, or np.save(path, a.astype(np.uint8)) if 0 and 1 are counts";
        return Err(Error::malformed("the samples are truth values", instead));
    }
    if kind == "c" {
        let instead = "write one of its parts, as np.save(path, np.abs(a).astype(np.float32))";
        return Err(Error::malformed("the samples are complex numbers", instead));
    }
    let name: String = descr.chars().take(80).collect();
    Err(Error::malformed(
        format!("the samples are of type {name}, not floating-point or whole numbers"),
        "write them with np.save(path, a.astype(np.float32))",
    ))
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

/// Writes samples `[row][column][band]` to an NPY file (version 1, three dimensions); one that is there is replaced.
///
/// # Errors
/// A number of samples that is not that of the shape; a file that cannot be written.
///
/// ```no_run
/// use hadar::cube::Shape;
/// use hadar_formats::cube::write_npy;
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
/// use hadar::cube::Shape;
/// use hadar_formats::cube::write_npy_to;
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

impl Value for f64 {
    const NAME: &'static str = "f8";
}

/// A map of such dimensions, the last one running fastest, as an NPY file (version 1).
///
/// # Errors
/// A number of values that is not that of the dimensions.
///
/// ```
/// let file = hadar_formats::cube::npy_map(&[1, 2], &[3_u16, 65535])?;
/// assert_eq!(file.len(), 128 + 2 * 2);
/// let of_one = hadar_formats::cube::npy_map(&[2], &[3_u16, 65535])?;
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

pub(super) fn array<V: bytemuck::Pod>(
    writer: &mut impl Write,
    name: &str,
    dimensions: &[usize],
    values: &[V],
) -> std::io::Result<()> {
    let order =
        if size_of::<V>() == 1 { "|" } else { if cfg!(target_endian = "little") { "<" } else { ">" } };
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
