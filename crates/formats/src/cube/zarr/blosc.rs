//! Chunks as Blosc packs them: blocks, each cut into as many streams as a number has bytes, packed by another codec.
//!
//! A header of 16 bytes: version, version of the codec, flags, bytes of a number, bytes of all, of a block and of what is packed. Then the place of
//! each block, and blocks of streams, each with its length before it; a stream as long as what it stands for is not packed.
//!
//! Source: Blosc, 'Blosc Header Format' (c-blosc 1.21, README_CHUNK_FORMAT).

use super::streams::{lz4, unshuffled, zlib, zstd};

const HEADER: usize = 16;
/// Flags.
const SHUFFLED: u8 = 1;
const PLAIN: u8 = 2;
const BIT_SHUFFLED: u8 = 4;
const WHOLE_BLOCKS: u8 = 16;
/// Streams that a block is cut into at most, and bytes that each of them has at least.
const MOST_STREAMS: usize = 16;
const SHORTEST_STREAM: usize = 128;

type Unpacked = std::result::Result<Vec<u8>, String>;

/// The bytes of a chunk, at most so many.
pub(super) fn unpacked(packed: &[u8], most: usize) -> Unpacked {
    let header = packed.first_chunk::<HEADER>().ok_or("it ends within its header")?;
    let word = |at: usize| {
        header.get(at..).and_then(<[u8]>::first_chunk).map_or(0, |word| u32::from_le_bytes(*word) as usize)
    };
    let (flags, size) = (header[2], usize::from(header[3]).max(1));
    let (bytes, block) = (word(4), word(8));
    if bytes > most.saturating_add(4) || word(12) > packed.len() || (block == 0 && bytes > 0) {
        return Err(format!("it announces {bytes} bytes in blocks of {block}"));
    }
    if flags & PLAIN != 0 {
        let plain = packed.get(HEADER..HEADER + bytes).ok_or("it ends within its bytes")?;
        return Ok(plain.to_vec());
    }
    let codec: fn(&[u8], usize) -> Unpacked = match flags >> 5 {
        1 => lz4,
        3 => zlib,
        4 => zstd,
        0 => {
            return Err(
                "it is packed with blosclz, which is not read; write it with cname = 'lz4' or 'zstd'".into(),
            );
        }
        _ => {
            return Err(
                "it is packed with snappy, which is not read; write it with cname = 'lz4' or 'zstd'".into()
            );
        }
    };
    if flags & BIT_SHUFFLED != 0 {
        return Err("its bits are shuffled, which is not read; write it with shuffle = 1".into());
    }
    let mut out = Vec::with_capacity(bytes.min(most));
    for number in 0..bytes.div_ceil(block.max(1)) {
        let start = packed
            .get(HEADER + 4 * number..)
            .and_then(<[u8]>::first_chunk)
            .map(|place| u32::from_le_bytes(*place) as usize);
        let mut rest = start.and_then(|start| packed.get(start..)).ok_or("a block is beyond it")?;
        let length = block.min(bytes - out.len());
        let is_cut = flags & WHOLE_BLOCKS == 0
            && length == block
            && size <= MOST_STREAMS
            && block / size >= SHORTEST_STREAM;
        let streams = if is_cut { size } else { 1 };
        let mut own = Vec::with_capacity(length);
        for _ in 0..streams {
            let (count, after) = rest.split_first_chunk::<4>().ok_or("it ends within a block")?;
            let count = u32::from_le_bytes(*count) as usize;
            let (stream, after) = after.split_at_checked(count).ok_or("it ends within a block")?;
            rest = after;
            let due = length / streams;
            let bytes = if count == due { stream.to_vec() } else { codec(stream, due)? };
            if bytes.len() != due {
                return Err(format!("a stream of {} bytes where {due} are due", bytes.len()));
            }
            own.extend(bytes);
        }
        out.extend(if flags & SHUFFLED != 0 { unshuffled(&own, size) } else { own });
    }
    Ok(out)
}
