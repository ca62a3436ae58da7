//! Wrong files from right ones: what a slip of an editor, of a transfer or of a program would make of them, and what
//! only malice would.

use flate2::{Compression, write::ZlibEncoder};
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use std::io::Write;
use std::ops::Range;

/// Longest file that is made, bytes.
const LONGEST: usize = 1 << 16;

/// What numbers are replaced by.
const NUMBERS: &[&str] = &[
    "NaN",
    "inf",
    "-inf",
    "1e999",
    "-1e999",
    "1e308",
    "1e-320",
    "5e-324",
    "-0",
    "0",
    "-1",
    "+1",
    "1.5",
    "1e5",
    "4294967295",
    "4294967296",
    "2147483648",
    "9223372036854775807",
    "18446744073709551616",
    "0x10",
    "0b11",
    "1_000",
    "1e",
    ".",
    "",
    "99999999999999999999999999999999999999",
    "0.1",
    "1",
    "1000",
    "1e7",
    "1e4",
];

/// What is put in somewhere.
const TOKENS: &[&str] = &[
    "\0",
    "\u{feff}",
    "\r",
    "\n",
    "\r\n",
    "\n\n",
    "\t",
    " ",
    ",",
    ";",
    "\"",
    "'",
    "\"\"\"",
    "#",
    "=",
    "[",
    "]",
    "[[",
    "]]",
    "{",
    "}",
    "(",
    ")",
    ".",
    "..",
    "/",
    "\\",
    "\\u0000",
    "\\n",
    "\u{7f}",
    "\u{85}",
    "\u{1b}[2J",
    "\u{2028}",
    "\u{e9}",
    "%",
    "@",
    ":",
    "-",
    "true",
    "nan",
    "material",
    "name",
    "wavenumber_cm1",
    "wavelength_um",
    "emissivity",
    "reflectance",
    "n",
    "k",
    "Name:",
    "Y Units:",
    "um",
    "cm^-1",
    "K",
    "degC",
    " /. ",
    ".csv",
    "variance_counts2",
    "band",
    "width_um",
    "version",
    "'descr'",
    "(((((",
    "{{{{{",
    "[[[[[",
    "a.a.a.a.a.",
    "null",
    "{\"a\":",
];

/// Words that binary headers are overwritten with.
const WORDS: &[u64] = &[
    0,
    1,
    2,
    3,
    4,
    5,
    8,
    14,
    15,
    0xff,
    0xffff,
    0x7fff_ffff,
    0xffff_ffff,
    1 << 31,
    1 << 32,
    u64::MAX,
    1 << 62,
];

/// The file that belongs to a number: the same one always.
pub(crate) fn mutated(seeds: &[Vec<u8>], stream: &str, number: u64) -> Vec<u8> {
    // FNV, so that every reader has inputs of its own.
    let hash = stream
        .bytes()
        .fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3));
    let mut rng = ChaCha8Rng::seed_from_u64(hash);
    rng.set_stream(number);
    let mut bytes = pick(&mut rng, seeds).clone();
    for _ in 0..1 + rng.random_range(0..4_u32) * rng.random_range(0..3_u32) {
        change(&mut bytes, seeds, &mut rng);
        bytes.truncate(LONGEST);
    }
    bytes
}

fn pick<'a, T>(rng: &mut ChaCha8Rng, from: &'a [T]) -> &'a T {
    &from[rng.random_range(0..from.len())]
}

/// A piece of the file; most are short.
fn piece(rng: &mut ChaCha8Rng, len: usize) -> Range<usize> {
    let start = rng.random_range(0..=len);
    let most = if rng.random_bool(0.7) { (len - start).min(16) } else { len - start };
    start..start + rng.random_range(0..=most)
}

/// The lines of the file, line feeds included.
fn line(rng: &mut ChaCha8Rng, bytes: &[u8]) -> Range<usize> {
    let place = rng.random_range(0..=bytes.len());
    let start = bytes[..place].iter().rposition(|&byte| byte == b'\n').map_or(0, |at| at + 1);
    let end = bytes[place..].iter().position(|&byte| byte == b'\n').map_or(bytes.len(), |at| place + at + 1);
    start..end
}

/// A number that is written in the file.
fn number(rng: &mut ChaCha8Rng, bytes: &[u8]) -> Option<Range<usize>> {
    let place = rng.random_range(0..=bytes.len());
    let start = place + bytes[place..].iter().position(u8::is_ascii_digit)?;
    let of_number = |byte: &u8| byte.is_ascii_digit() || b".eE+-".contains(byte);
    let first = bytes[..start].iter().rposition(|byte| !of_number(byte)).map_or(0, |at| at + 1);
    let end = bytes[start..].iter().position(|byte| !of_number(byte)).map_or(bytes.len(), |at| start + at);
    Some(first..end)
}

fn change(bytes: &mut Vec<u8>, seeds: &[Vec<u8>], rng: &mut ChaCha8Rng) {
    match rng.random_range(0..14_u32) {
        0 | 1 => {
            if !bytes.is_empty() {
                let place = rng.random_range(0..bytes.len());
                bytes[place] = if rng.random_bool(0.5) {
                    bytes[place] ^ 1 << rng.random_range(0..8_u32)
                } else {
                    rng.random()
                };
            }
        }
        2 => {
            bytes.drain(piece(rng, bytes.len()));
        }
        3 => bytes.truncate(rng.random_range(0..=bytes.len())),
        4 => {
            let copied = bytes[piece(rng, bytes.len())].to_vec();
            let place = rng.random_range(0..=bytes.len());
            bytes.splice(place..place, copied);
        }
        5 | 6 => {
            let place = rng.random_range(0..=bytes.len());
            bytes.splice(place..place, pick(rng, TOKENS).bytes());
        }
        7 => {
            bytes.drain(line(rng, bytes));
        }
        8 => {
            let copied = bytes[line(rng, bytes)].to_vec();
            let place = line(rng, bytes).start;
            bytes.splice(place..place, copied);
        }
        9 | 10 => {
            if let Some(place) = number(rng, bytes) {
                bytes.splice(place, pick(rng, NUMBERS).bytes());
            }
        }
        11 => {
            // The head of one file and the tail of another.
            let other = pick(rng, seeds);
            bytes.truncate(rng.random_range(0..=bytes.len()));
            bytes.extend(&other[rng.random_range(0..=other.len())..]);
        }
        12 => {
            let place = piece(rng, bytes.len());
            let times = 1 << rng.random_range(1..10_u32);
            let repeated = bytes[place.clone()].repeat(times);
            bytes.splice(place, repeated);
        }
        _ => binary(bytes, rng),
    }
}

/// A word of a header overwritten, or the arrays of a MATLAB file packed.
fn binary(bytes: &mut Vec<u8>, rng: &mut ChaCha8Rng) {
    let matlab = bytes.get(124..128) == Some(b"\0\x01IM");
    if matlab && rng.random_bool(0.3) {
        let mut packed = ZlibEncoder::new(Vec::new(), Compression::fast());
        packed.write_all(&bytes[128..]).expect("memory");
        let packed = packed.finish().expect("memory");
        bytes.truncate(128);
        bytes.extend(15_u32.to_le_bytes());
        bytes.extend(u32::try_from(packed.len()).expect("a short file").to_le_bytes());
        bytes.extend(packed);
        return;
    }
    let width = *pick(rng, &[1, 2, 4, 8]);
    if bytes.len() < width {
        return;
    }
    let place = rng.random_range(0..=bytes.len() - width) / width * width;
    let word = *pick(rng, WORDS);
    let word =
        if rng.random_bool(0.8) { word.to_le_bytes() } else { (word << (64 - 8 * width)).to_be_bytes() };
    bytes[place..place + width].copy_from_slice(&word[..width]);
}
