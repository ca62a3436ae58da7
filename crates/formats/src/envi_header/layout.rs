//! Size of the data of an ENVI file, and how samples are stored.

use super::EnviHeader;
use hadar::error::{Error, Result};

/// Order of the samples in the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Interleave {
    /// `[band][line][sample]`.
    Bsq,
    /// `[line][band][sample]`.
    Bil,
    /// `[line][sample][band]`.
    Bip,
}

/// What a sample is stored as.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DataType {
    /// 1: unsigned, 8 bits.
    U8,
    /// 2: signed, 16 bits.
    I16,
    /// 3: signed, 32 bits.
    I32,
    /// 4: float, 32 bits.
    F32,
    /// 5: float, 64 bits.
    F64,
    /// 12: unsigned, 16 bits.
    U16,
    /// 13: unsigned, 32 bits.
    U32,
    /// 14: signed, 64 bits.
    I64,
    /// 15: unsigned, 64 bits.
    U64,
}

impl DataType {
    /// Bytes of a sample.
    #[must_use]
    pub const fn size(self) -> usize {
        match self {
            Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    /// The number as a sample holds it: a float of 32 bits has of -1.23e34 not all digits that a header has.
    #[must_use]
    pub fn stored(self, value: f64) -> f64 {
        match self {
            Self::F32 => f64::from(value as f32),
            _ => value,
        }
    }

    /// The samples of bytes, each the nearest `f64`; bytes that are left over make none.
    #[must_use]
    pub fn samples(self, bytes: &[u8], order: ByteOrder) -> Vec<f64> {
        match self {
            Self::U8 => bytes.iter().copied().map(f64::from).collect(),
            Self::I16 => each(bytes, order, |b| f64::from(i16::from_le_bytes(b))),
            Self::U16 => each(bytes, order, |b| f64::from(u16::from_le_bytes(b))),
            Self::I32 => each(bytes, order, |b| f64::from(i32::from_le_bytes(b))),
            Self::U32 => each(bytes, order, |b| f64::from(u32::from_le_bytes(b))),
            Self::F32 => each(bytes, order, |b| f64::from(f32::from_le_bytes(b))),
            Self::F64 => each(bytes, order, f64::from_le_bytes),
            Self::I64 => each(bytes, order, |b| i64::from_le_bytes(b) as f64),
            Self::U64 => each(bytes, order, |b| u64::from_le_bytes(b) as f64),
        }
    }
}

fn each<const N: usize>(bytes: &[u8], order: ByteOrder, of: impl Fn([u8; N]) -> f64) -> Vec<f64> {
    let (samples, _) = bytes.as_chunks::<N>();
    let ordered = |mut sample: [u8; N]| {
        if order == ByteOrder::Big {
            sample.reverse();
        }
        of(sample)
    };
    samples.iter().copied().map(ordered).collect()
}

/// Which byte of a sample comes first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ByteOrder {
    /// 0: the least significant one.
    Little,
    /// 1: the most significant one.
    Big,
}

/// Size of the data, and how they are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Layout {
    /// Samples of a line: columns of an image, channels of a spectral library.
    pub samples: usize,
    /// Lines: rows of an image, spectra of a spectral library.
    pub lines: usize,
    /// Bands; 1 in a spectral library.
    pub bands: usize,
    /// What a sample is stored as.
    pub data_type: DataType,
    /// Order of the samples.
    pub interleave: Interleave,
    /// Order of the bytes of a sample.
    pub byte_order: ByteOrder,
    /// Bytes before the first sample.
    pub header_offset: u64,
}

impl Layout {
    /// Bytes of the data file, offset and all; none where they are beyond counting.
    #[must_use]
    pub fn bytes(&self) -> Option<u64> {
        let sizes = [self.samples, self.lines, self.bands, self.data_type.size()];
        let data = sizes.iter().try_fold(1_u64, |product, &size| product.checked_mul(size as u64))?;
        data.checked_add(self.header_offset)
    }
}

impl EnviHeader {
    /// Size of the data and how they are stored. `byte order` may be silent where a sample is one byte, `interleave` where there is
    /// one band, `bands` in a spectral library, `header offset` anywhere (it is 0).
    ///
    /// # Errors
    /// A key that is missing or wrong; complex samples; a compressed file.
    pub fn layout(&self) -> Result<Layout> {
        let bands =
            if self.is_spectral_library() && self.text("bands").is_none() { 1 } else { self.count("bands")? };
        let data_type = self.data_type()?;
        if self.number("file compression")?.is_some_and(|compression| compression != 0.0) {
            let error = Error::malformed("the data are compressed", "write them without compression");
            return Err(self.wrong("file compression", error));
        }
        Ok(Layout {
            samples: self.count("samples")?,
            lines: self.count("lines")?,
            bands,
            data_type,
            interleave: self.interleave(bands)?,
            byte_order: self.byte_order(data_type)?,
            header_offset: match self.text("header offset") {
                None => 0,
                Some(text) => text.parse().map_err(|_| {
                    let found = format!("`{text}` is no number of bytes");
                    self.wrong("header offset", Error::malformed(found, "write a whole number, as in 0"))
                })?,
            },
        })
    }

    fn count(&self, key: &str) -> Result<usize> {
        let text = self.needed(key, "write a whole number")?;
        match text.parse::<usize>() {
            Ok(count) if count > 0 => Ok(count),
            _ => {
                let found = format!("`{text}` is not how many there are");
                Err(self.wrong(key, Error::malformed(found, "write a whole number above 0")))
            }
        }
    }

    fn data_type(&self) -> Result<DataType> {
        const KEY: &str = "data type";
        const CODES: &str = "write 1, 2, 3, 4, 5, 12, 13, 14 or 15, as in 4 for floats of 32 bits";
        Ok(match self.needed(KEY, CODES)? {
            "1" => DataType::U8,
            "2" => DataType::I16,
            "3" => DataType::I32,
            "4" => DataType::F32,
            "5" => DataType::F64,
            "12" => DataType::U16,
            "13" => DataType::U32,
            "14" => DataType::I64,
            "15" => DataType::U64,
            "6" | "9" => {
                let instead = "write real ones, such as their magnitudes";
                return Err(self.wrong(KEY, Error::malformed("the samples are complex", instead)));
            }
            other => {
                let found = format!("`{other}` is no type of data");
                return Err(self.wrong(KEY, Error::malformed(found, CODES)));
            }
        })
    }

    fn interleave(&self, bands: usize) -> Result<Interleave> {
        const KEY: &str = "interleave";
        const NAMES: &str = "write bsq, bil or bip";
        if bands == 1 && self.text(KEY).is_none() {
            return Ok(Interleave::Bsq);
        }
        let text = self.needed(KEY, NAMES)?;
        match text.to_lowercase().as_str() {
            "bsq" => Ok(Interleave::Bsq),
            "bil" => Ok(Interleave::Bil),
            "bip" => Ok(Interleave::Bip),
            _ => Err(self.wrong(KEY, Error::malformed(format!("`{text}` is no order of samples"), NAMES))),
        }
    }

    fn byte_order(&self, data_type: DataType) -> Result<ByteOrder> {
        const KEY: &str = "byte order";
        const ORDERS: &str = "write 0 where the least significant byte comes first, else 1";
        if data_type.size() == 1 && self.text(KEY).is_none() {
            return Ok(ByteOrder::Little);
        }
        match self.needed(KEY, ORDERS)? {
            "0" => Ok(ByteOrder::Little),
            "1" => Ok(ByteOrder::Big),
            other => {
                Err(self.wrong(KEY, Error::malformed(format!("`{other}` is no order of bytes"), ORDERS)))
            }
        }
    }
}
