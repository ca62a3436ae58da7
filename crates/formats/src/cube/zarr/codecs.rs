//! What unpacks the chunks of a Zarr array.

use super::blosc;
use super::streams::{lz4, read, unshuffled, zlib, zstd};
use flate2::read::MultiGzDecoder;
use hadar::error::{Error, Result};

/// A step of unpacking.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Codec {
    Gzip,
    Zlib,
    Zstd,
    Lz4,
    Blosc,
    /// Bytes of numbers of so many bytes, those of equal weight together.
    Shuffle(usize),
    /// Four bytes of a checksum behind the others.
    Crc32c,
}

impl Codec {
    /// The codec of a name.
    ///
    /// # Errors
    /// One that is not read.
    pub(super) fn named(name: &str) -> Result<Self> {
        Ok(match name {
            "gzip" => Self::Gzip,
            "zlib" | "numcodecs.zlib" => Self::Zlib,
            "zstd" | "numcodecs.zstd" => Self::Zstd,
            "lz4" | "numcodecs.lz4" => Self::Lz4,
            "blosc" | "numcodecs.blosc" => Self::Blosc,
            "crc32c" => Self::Crc32c,
            other => {
                return Err(Error::malformed(
                    format!("its chunks are packed with `{}`, which is not read", other.escape_debug()),
                    "write them with zstd, gzip, zlib, lz4 or blosc, or the cube with np.save('cube.npy', a[:])",
                ));
            }
        })
    }
}

/// Bytes of a chunk, of which there must be so many.
pub(super) fn unpacked(
    packed: Vec<u8>,
    codecs: &[Codec],
    bytes: usize,
) -> std::result::Result<Vec<u8>, String> {
    let mut content = packed;
    for codec in codecs {
        content = match codec {
            Codec::Gzip => read(MultiGzDecoder::new(content.as_slice()), bytes)?,
            Codec::Zlib => zlib(&content, bytes)?,
            Codec::Zstd => zstd(&content, bytes)?,
            Codec::Lz4 => {
                // The number of bytes stands before the block.
                let (length, block) = content.split_first_chunk::<4>().ok_or("it is empty")?;
                let length = u32::from_le_bytes(*length) as usize;
                if length > bytes.saturating_add(4) {
                    return Err(format!("it announces {length} bytes"));
                }
                lz4(block, length)?
            }
            Codec::Blosc => blosc::unpacked(&content, bytes)?,
            Codec::Shuffle(size) => unshuffled(&content, *size),
            Codec::Crc32c => {
                let (content, sum) = content.split_last_chunk::<4>().ok_or("it is empty")?;
                if crc32c(content) != u32::from_le_bytes(*sum) {
                    return Err("its checksum is another".into());
                }
                content.to_vec()
            }
        };
    }
    match content.len() == bytes {
        true => Ok(content),
        false => Err(format!("{} bytes where {bytes} are due", content.len())),
    }
}

/// The checksum of Castagnoli (RFC 3720), bit by bit.
fn crc32c(bytes: &[u8]) -> u32 {
    let of_byte = |sum: u32, byte: &u8| {
        (0..8).fold(sum ^ u32::from(*byte), |sum, _| sum >> 1 ^ if sum & 1 == 1 { 0x82f6_3b78 } else { 0 })
    };
    !bytes.iter().fold(u32::MAX, of_byte)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_checksum_is_that_of_the_standard() {
        // RFC 3720, B.4: 32 bytes of zeros; and the check value of the catalogue of CRCs.
        assert_eq!(crc32c(&[0; 32]), 0x8a91_36aa);
        assert_eq!(crc32c(b"123456789"), 0xe306_9283);
    }
}
