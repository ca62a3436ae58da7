//! Soft links of groups of the older kind, which the reader of the format takes for objects at an address of ones: left out.
//!
//! A node of a group's table begins with `SNOD`, a version (1), a byte of nothing and the number of its entries in two bytes; an entry is the
//! place of a name and the address of an object (8 bytes each), the kind of what is kept beside it (4; 2 of a soft link), 4 bytes of nothing and
//! 16 of what is kept. What a soft link leads to is listed by its own name.
//!
//! Source: The HDF Group, HDF5 File Format Specification 3.0, 'Disk Format: Level 1B and 1C'.

use hdf5_pure::FormatError;

/// Bytes before the entries of a node, and of an entry where places and addresses have 8.
const HEAD: usize = 8;
const ENTRY: usize = 40;
const SOFT: [u8; 4] = 2_u32.to_le_bytes();

/// The `len` first bytes of a node at an address, soft links left out of it; `read` gives bytes as they stand in the file.
pub(super) fn without_soft(
    bytes: Vec<u8>,
    len: usize,
    mut read: impl FnMut(usize) -> Result<Vec<u8>, FormatError>,
) -> Result<Vec<u8>, FormatError> {
    let Some(&[b'S', b'N', b'O', b'D', 1, _, low, high]) = bytes.first_chunk::<HEAD>() else {
        return Ok(bytes);
    };
    let count = usize::from(u16::from_le_bytes([low, high]));
    // A file that is too short for its table is refused by its reader.
    let Ok(node) = read(HEAD + count * ENTRY) else { return Ok(bytes) };
    let (head, entries) = node.split_at(HEAD.min(node.len()));
    let (entries, _) = entries.as_chunks::<ENTRY>();
    let kept: Vec<&[u8; ENTRY]> = entries.iter().filter(|entry| entry.get(16..20) != Some(&SOFT)).collect();
    if kept.len() == count {
        return Ok(bytes);
    }
    let mut out = head.to_vec();
    if let (Some(number), Ok(kept)) = (out.get_mut(6..8), u16::try_from(kept.len())) {
        number.copy_from_slice(&kept.to_le_bytes());
    }
    kept.into_iter().for_each(|entry| out.extend_from_slice(entry));
    out.resize(len, 0);
    Ok(out)
}
