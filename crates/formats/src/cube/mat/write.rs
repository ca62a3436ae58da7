//! Writes MATLAB files of version 5: one array of numbers, not compressed.
//!
//! A header of 128 bytes; then an element of type 14 with its subelements: flags and class, dimensions, name, numbers in column-major
//! order, each padded to 8 bytes.
//!
//! Source: MathWorks, 'MAT-File Format' (R2025a), level 5.

use super::element::MATRIX;
use crate::cube::Value;
use hadar::error::{Error, Result};

/// Bytes of the header's text.
const TEXT: usize = 116;
const INT8: u32 = 1;
const INT32: u32 = 5;
const UINT32: u32 = 6;

/// An array `[row][column][layer]` under a name, as a .mat file; a map of one layer has two dimensions.
///
/// # Errors
/// A number of values that is not that of the dimensions; an array that is too large for such a file.
///
/// ```
/// use hadar_formats::cube::mat_file;
/// let file = mat_file("tMap", [1, 2, 1], &[21.5_f32, 36.6])?;
/// assert_eq!(&file[..6], b"MATLAB");
/// assert!(mat_file("tMap", [2, 2, 1], &[21.5_f32]).is_err());
/// # Ok::<(), hadar::Error>(())
/// ```
pub fn mat_file<V: Value>(name: &str, [rows, columns, layers]: [usize; 3], values: &[V]) -> Result<Vec<u8>> {
    let expected = rows * columns * layers;
    if values.len() != expected {
        return Err(Error::Length { what: "values of a map".to_owned(), found: values.len(), expected });
    }
    // Type of the numbers, class of the array.
    let (kind, class) = match V::NAME {
        "u1" => (2, 9),
        "u2" => (4, 11),
        "f4" => (7, 7),
        _ => (9, 6),
    };
    let mut dimensions = vec![rows, columns];
    if layers != 1 {
        dimensions.push(layers);
    }
    let dimensions = dimensions.iter().map(|&n| i32::try_from(n)).collect::<std::result::Result<Vec<_>, _>>();
    let bytes = u32::try_from(expected * size_of::<V>());
    let (Ok(dimensions), Ok(bytes)) = (dimensions, bytes) else {
        let found = format!("an array of {rows} x {columns} x {layers}");
        return Err(Error::malformed(found, "such files hold at most 4 GiB: render fewer pixels or bands"));
    };
    let mut content = Vec::with_capacity(bytes as usize + 128);
    element(&mut content, UINT32, &[u32::to_le_bytes(class), [0; 4]].concat());
    element(&mut content, INT32, &dimensions.iter().flat_map(|n| n.to_le_bytes()).collect::<Vec<_>>());
    element(&mut content, INT8, name.as_bytes());
    content.extend(u32::to_le_bytes(kind));
    content.extend(bytes.to_le_bytes());
    for layer in 0..layers {
        for column in 0..columns {
            for row in 0..rows {
                if let Some(value) = values.get((row * columns + column) * layers + layer) {
                    content.extend_from_slice(bytemuck::bytes_of(value));
                }
            }
        }
    }
    content.resize(content.len().next_multiple_of(8), 0);
    let mut file = format!("{:TEXT$}", "MATLAB 5.0 MAT-file").into_bytes();
    // No subsystem; version 1, little endian.
    file.extend([0; 8]);
    file.extend([0, 1, b'I', b'M']);
    file.extend(MATRIX.to_le_bytes());
    let too_long = |_| Error::malformed("an array beyond 4 GiB", "render fewer pixels or bands");
    file.extend(u32::try_from(content.len()).map_err(too_long)?.to_le_bytes());
    file.extend(content);
    Ok(file)
}

fn element(to: &mut Vec<u8>, kind: u32, content: &[u8]) {
    to.extend(kind.to_le_bytes());
    to.extend((content.len() as u32).to_le_bytes());
    to.extend_from_slice(content);
    to.resize(to.len().next_multiple_of(8), 0);
}
