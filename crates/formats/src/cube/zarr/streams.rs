//! Bytes as the usual programs pack them, and numbers whose bytes of equal weight stood together.

use flate2::read::ZlibDecoder;
use std::io::Read;

/// No more than are due, and four of a checksum.
pub(super) fn read(from: impl Read, bytes: usize) -> std::result::Result<Vec<u8>, String> {
    let mut out = Vec::new();
    from.take(bytes as u64 + 5).read_to_end(&mut out).map_err(|error| error.to_string())?;
    Ok(out)
}

pub(super) fn zstd(packed: &[u8], bytes: usize) -> std::result::Result<Vec<u8>, String> {
    let decoder = ruzstd::decoding::StreamingDecoder::new(packed).map_err(|error| error.to_string())?;
    read(decoder, bytes)
}

pub(super) fn zlib(packed: &[u8], bytes: usize) -> std::result::Result<Vec<u8>, String> {
    read(ZlibDecoder::new(packed), bytes)
}

pub(super) fn lz4(block: &[u8], bytes: usize) -> std::result::Result<Vec<u8>, String> {
    let mut out = vec![0; bytes];
    let length = lz4_flex::block::decompress_into(block, &mut out).map_err(|error| error.to_string())?;
    match length == bytes {
        true => Ok(out),
        false => Err(format!("{length} bytes where {bytes} are due")),
    }
}

/// Numbers whose bytes of equal weight stood together; bytes of no whole number are left at the end.
pub(super) fn unshuffled(bytes: &[u8], size: usize) -> Vec<u8> {
    let count = bytes.len() / size.max(1);
    if size < 2 || count == 0 {
        return bytes.to_vec();
    }
    let mut out = bytes.to_vec();
    for (weight, plane) in bytes.chunks_exact(count).take(size).enumerate() {
        out.iter_mut().skip(weight).step_by(size).zip(plane).for_each(|(out, byte)| *out = *byte);
    }
    out
}
