//! Numbers as they are stored in files of cubes, and what they become: `f64` where `f32` would round them, else `f32`.

use hadar::cube::Sample;
use hadar::error::Result;

/// Numbers decoded at a time, bytes; a multiple of 8.
const CHUNK: usize = 1 << 15;

/// How a number is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Stored {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F16,
    F32,
    F64,
}

impl Stored {
    /// How numbers of a type of a MATLAB file are stored.
    pub(super) const fn of_mat(kind: u32) -> Option<Self> {
        Some(match kind {
            1 => Self::I8,
            2 => Self::U8,
            3 => Self::I16,
            4 => Self::U16,
            5 => Self::I32,
            6 => Self::U32,
            7 => Self::F32,
            9 => Self::F64,
            12 => Self::I64,
            13 => Self::U64,
            _ => return None,
        })
    }

    /// A whole number of so many bytes.
    pub(super) const fn whole(signed: bool, bytes: u64) -> Option<Self> {
        Some(match (signed, bytes) {
            (true, 1) => Self::I8,
            (false, 1) => Self::U8,
            (true, 2) => Self::I16,
            (false, 2) => Self::U16,
            (true, 4) => Self::I32,
            (false, 4) => Self::U32,
            (true, 8) => Self::I64,
            (false, 8) => Self::U64,
            _ => return None,
        })
    }

    /// A floating-point number of so many bytes.
    pub(super) const fn float(bytes: u64) -> Option<Self> {
        Some(match bytes {
            2 => Self::F16,
            4 => Self::F32,
            8 => Self::F64,
            _ => return None,
        })
    }

    pub(super) const fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 | Self::F16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 | Self::I64 | Self::U64 => 8,
        }
    }

    /// Whether an `f32` does not hold all of its values; above 2⁵³ an `f64` rounds too.
    pub(super) const fn is_double(self) -> bool {
        matches!(self, Self::F64 | Self::I32 | Self::U32 | Self::I64 | Self::U64)
    }

    /// Its name in messages.
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::I8 => "i8",
            Self::U8 => "u8",
            Self::I16 => "i16",
            Self::U16 => "u16",
            Self::I32 => "i32",
            Self::U32 => "u32",
            Self::I64 => "i64",
            Self::U64 => "u64",
            Self::F16 => "f16",
            Self::F32 => "f32",
            Self::F64 => "f64",
        }
    }
}

/// Numbers from the bytes of as many.
pub(super) fn decode<S: Sample>(bytes: &[u8], stored: Stored, little_endian: bool, numbers: &mut [S]) {
    macro_rules! as_stored {
        ($type:ty, $value:expr) => {{
            let (words, _) = bytes.as_chunks::<{ size_of::<$type>() }>();
            let value = $value;
            let each = numbers.iter_mut().zip(words);
            // Two loops, so that neither asks for the order within.
            match little_endian {
                true => each.for_each(|(number, word)| *number = S::of(value(<$type>::from_le_bytes(*word)))),
                false => {
                    each.for_each(|(number, word)| *number = S::of(value(<$type>::from_be_bytes(*word))));
                }
            }
        }};
    }
    match stored {
        Stored::I8 => as_stored!(i8, f64::from),
        Stored::U8 => as_stored!(u8, f64::from),
        Stored::I16 => as_stored!(i16, f64::from),
        Stored::U16 => as_stored!(u16, f64::from),
        Stored::I32 => as_stored!(i32, f64::from),
        Stored::U32 => as_stored!(u32, f64::from),
        Stored::F16 => as_stored!(u16, half),
        Stored::F32 => as_stored!(f32, f64::from),
        Stored::F64 => as_stored!(f64, |value| value),
        // No `From`, since they are rounded.
        Stored::I64 => as_stored!(i64, |value| value as f64),
        Stored::U64 => as_stored!(u64, |value| value as f64),
    }
}

/// The next numbers of a source that gives bytes in their order.
pub(super) fn decode_next<S: Sample>(
    mut exact: impl FnMut(&mut [u8]) -> Result<()>,
    stored: Stored,
    little_endian: bool,
    numbers: &mut [S],
) -> Result<()> {
    let mut bytes = [0; CHUNK];
    for numbers in numbers.chunks_mut(CHUNK / stored.size()) {
        let bytes = &mut bytes[..numbers.len() * stored.size()];
        exact(bytes)?;
        decode(bytes, stored, little_endian, numbers);
    }
    Ok(())
}

/// A number of IEEE 754 half precision: a bit of sign, five of exponent, ten of fraction.
fn half(bits: u16) -> f64 {
    let fraction = f64::from(bits & 0x3ff) / 1024.0;
    let magnitude = match i32::from(bits >> 10 & 0x1f) {
        0 => fraction * 2.0_f64.powi(-14),
        31 if fraction == 0.0 => f64::INFINITY,
        31 => f64::NAN,
        exponent => (1.0 + fraction) * 2.0_f64.powi(exponent - 15),
    };
    if bits >> 15 == 1 { -magnitude } else { magnitude }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_are_as_the_standard_has_them() {
        // 1, -2, 65504 (the largest), the least normal and subnormal numbers, 1/3 rounded.
        for (bits, value) in [
            (0x3c00, 1.0),
            (0xc000, -2.0),
            (0x7bff, 65504.0),
            (0x0400, 6.103_515_625e-5),
            (0x0001, 5.960_464_477_539_063e-8),
            (0x3555, 0.333_251_953_125),
            (0x8000, 0.0),
            (0xfc00, f64::NEG_INFINITY),
        ] {
            assert_eq!(half(bits), value, "{bits:x}");
        }
        assert!(half(0x7e00).is_nan());
    }
}
