//! Numbers as they are stored in a MATLAB file.

use super::planes::Number;

/// How numbers are stored, which need not be their class: MATLAB takes the smallest type that holds them all.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Stored {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
    I64,
    U64,
}

impl Stored {
    pub(super) const fn of(kind: u32) -> Option<Self> {
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

    pub(super) const fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 | Self::I64 | Self::U64 => 8,
        }
    }
}

/// Numbers from the bytes of as many.
pub(super) fn decode<S: Number>(bytes: &[u8], stored: Stored, little_endian: bool, numbers: &mut [S]) {
    macro_rules! as_stored {
        ($type:ty) => {{
            let (words, _) = bytes.as_chunks::<{ size_of::<$type>() }>();
            for (number, word) in numbers.iter_mut().zip(words) {
                let value =
                    if little_endian { <$type>::from_le_bytes(*word) } else { <$type>::from_be_bytes(*word) };
                // No `From` for the integers of 64 bits, which are rounded.
                *number = S::narrowed(value as f64);
            }
        }};
    }
    match stored {
        Stored::I8 => as_stored!(i8),
        Stored::U8 => as_stored!(u8),
        Stored::I16 => as_stored!(i16),
        Stored::U16 => as_stored!(u16),
        Stored::I32 => as_stored!(i32),
        Stored::U32 => as_stored!(u32),
        Stored::F32 => as_stored!(f32),
        Stored::F64 => as_stored!(f64),
        Stored::I64 => as_stored!(i64),
        Stored::U64 => as_stored!(u64),
    }
}
