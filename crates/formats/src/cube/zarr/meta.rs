//! What a Zarr array says of itself: `.zarray` and `.zattrs`, or `zarr.json`.

use super::codecs::Codec;
use crate::cube::attributes::{Attribute, Attributes};
use crate::cube::stored::Stored;
use crate::cube::values::Values;
use crate::file::bytes;
use hadar::error::{Error, Result};
use serde_json::Value;
use std::path::Path;

/// Longest description, bytes.
const LONGEST: u64 = 1 << 24;
/// Largest chunk, bytes.
const LARGEST_CHUNK: u64 = 1 << 32;
/// Most dimensions.
const MOST: usize = 32;

/// What an array says of itself.
#[derive(Debug, Clone)]
pub(super) struct Meta {
    pub(super) version: &'static str,
    pub(super) sides: Vec<usize>,
    pub(super) chunk: Vec<usize>,
    pub(super) stored: Stored,
    pub(super) little_endian: bool,
    /// Whether the first dimension of a chunk runs fastest.
    pub(super) fastest_first: bool,
    /// What unpacks a chunk, in this order.
    pub(super) codecs: Vec<Codec>,
    /// Before the places of a chunk in its key, and between them.
    prefix: &'static str,
    separator: char,
    pub(super) attributes: Attributes,
    fill: Option<f64>,
    pub(super) dimensions: Vec<String>,
}

impl Meta {
    /// The array of a folder; none of a group.
    pub(super) fn of_folder(folder: &Path) -> Result<Option<Self>> {
        if let Some(array) = json(folder, ".zarray")? {
            let attributes = json(folder, ".zattrs")?.unwrap_or_default();
            return Self::of_version_2(&array, &attributes).map(Some);
        }
        match json(folder, "zarr.json")? {
            Some(array) if array["node_type"] == "array" => Self::of_version_3(&array).map(Some),
            _ => Ok(None),
        }
    }

    /// The sides of an array of numbers that cannot be read otherwise.
    pub(super) fn sides_of_numbers(folder: &Path) -> Option<Vec<usize>> {
        let json = |name: &str| -> Option<Value> {
            serde_json::from_slice(&bytes(&folder.join(name), "read the array", LONGEST).ok()?).ok()
        };
        let (array, is_number) = match json(".zarray") {
            Some(array) => {
                let is_number = array["dtype"].as_str().is_some_and(|kind| of_numpy(kind).is_some());
                (array, is_number)
            }
            None => {
                let array = json("zarr.json")?;
                let is_number = array["data_type"].as_str().is_some_and(|kind| of_name(kind).is_some());
                (array, is_number)
            }
        };
        sides(&array["shape"]).ok().filter(|_| is_number)
    }

    fn of_version_2(array: &Value, attributes: &Value) -> Result<Self> {
        let (stored, little_endian) =
            array["dtype"].as_str().and_then(of_numpy).ok_or_else(|| other_type(&array["dtype"]))?;
        let mut codecs: Vec<Codec> = match &array["compressor"] {
            Value::Null => Vec::new(),
            compressor => vec![Codec::named(compressor["id"].as_str().unwrap_or_default())?],
        };
        // What was packed last is unpacked first.
        if let Some(filters) = array["filters"].as_array() {
            for filter in filters.iter().rev() {
                let size = filter["elementsize"].as_u64().and_then(|size| usize::try_from(size).ok());
                match (filter["id"].as_str(), size) {
                    (Some("shuffle"), Some(size)) => codecs.push(Codec::Shuffle(size)),
                    (name, _) => codecs.push(Codec::named(name.unwrap_or_default())?),
                }
            }
        }
        let dimensions = attributes["_ARRAY_DIMENSIONS"].clone();
        Self {
            version: "Zarr 2",
            sides: sides(&array["shape"])?,
            chunk: sides(&array["chunks"])?,
            stored,
            little_endian,
            fastest_first: array["order"] == "F",
            codecs,
            prefix: "",
            separator: if array["dimension_separator"] == "/" { '/' } else { '.' },
            attributes: said(attributes),
            fill: number(&array["fill_value"]),
            dimensions: names(&dimensions),
        }
        .checked()
    }

    fn of_version_3(array: &Value) -> Result<Self> {
        let stored =
            array["data_type"].as_str().and_then(of_name).ok_or_else(|| other_type(&array["data_type"]))?;
        if array["chunk_grid"]["name"] != "regular" {
            return Err(damaged("its chunks are of several sizes"));
        }
        let (mut codecs, mut little_endian, mut fastest_first) = (Vec::new(), true, false);
        let all = array["codecs"].as_array().ok_or_else(|| damaged("zarr.json has no codecs"))?;
        for codec in all {
            let of = &codec["configuration"];
            match codec["name"].as_str().unwrap_or_default() {
                "bytes" | "endian" => little_endian = of["endian"] != "big",
                "transpose" => {
                    let order = sides_or_zero(&of["order"]);
                    let rank = array["shape"].as_array().map_or(0, Vec::len);
                    if order.iter().copied().eq((0..rank).rev()) && rank > 1 {
                        fastest_first = !fastest_first;
                    } else if !order.iter().copied().eq(0..rank) {
                        return Err(damaged(format!("its chunks have the order {}", of["order"])));
                    }
                }
                name => codecs.insert(0, Codec::named(name)?),
            }
        }
        let encoding = &array["chunk_key_encoding"];
        let is_2 = encoding["name"] == "v2";
        let separator = match encoding["configuration"]["separator"].as_str() {
            Some("/") => '/',
            Some(_) => '.',
            None if is_2 => '.',
            None => '/',
        };
        Self {
            version: "Zarr 3",
            sides: sides(&array["shape"])?,
            chunk: sides(&array["chunk_grid"]["configuration"]["chunk_shape"])?,
            stored,
            little_endian,
            fastest_first,
            codecs,
            prefix: if is_2 { "" } else { "c" },
            separator,
            attributes: said(&array["attributes"]),
            fill: number(&array["fill_value"]),
            dimensions: names(&array["dimension_names"]),
        }
        .checked()
    }

    fn checked(self) -> Result<Self> {
        let bytes = self
            .chunk
            .iter()
            .try_fold(self.stored.size() as u64, |bytes, side| bytes.checked_mul(*side as u64));
        let whole = self.sides.iter().try_fold(8_u64, |bytes, side| bytes.checked_mul(*side as u64));
        if self.sides.len() != self.chunk.len() || self.sides.contains(&0) || self.chunk.contains(&0) {
            return Err(damaged(format!("an array of {:?} in chunks of {:?}", self.sides, self.chunk)));
        }
        if bytes.is_none_or(|bytes| bytes > LARGEST_CHUNK) || whole.is_none_or(|bytes| bytes > 1 << 60) {
            return Err(damaged(format!(
                "an array of {:?} in chunks of {:?}, beyond counting",
                self.sides, self.chunk
            )));
        }
        Ok(self)
    }

    /// What the numbers stand for. A number that arrays are filled with stands for nothing, unless it is 0.
    pub(super) fn values(&self) -> Result<Option<Values>> {
        let filled = self.fill.filter(|fill| *fill != 0.0 && fill.is_finite());
        self.attributes.values_with(self.stored, filled)
    }

    /// The file of a chunk by its places.
    pub(super) fn key(&self, places: &[usize]) -> String {
        let places: Vec<String> = places.iter().map(usize::to_string).collect();
        let joined = places.join(&self.separator.to_string());
        if self.prefix.is_empty() { joined } else { format!("{}{}{joined}", self.prefix, self.separator) }
    }
}

/// Lengths above 0.
fn sides(list: &Value) -> Result<Vec<usize>> {
    let sides = sides_or_zero(list);
    let all = list.as_array().is_some_and(|list| list.len() == sides.len() && list.len() <= MOST);
    if !all || sides.is_empty() {
        return Err(damaged(format!("`{list}` is no shape")));
    }
    Ok(sides)
}

fn sides_or_zero(list: &Value) -> Vec<usize> {
    let side = |side: &Value| side.as_u64().and_then(|side| usize::try_from(side).ok());
    list.as_array().map(|list| list.iter().filter_map(side).collect()).unwrap_or_default()
}

fn names(list: &Value) -> Vec<String> {
    let name = |name: &Value| name.as_str().unwrap_or_default().to_owned();
    list.as_array().map(|list| list.iter().map(name).collect()).unwrap_or_default()
}

/// A number, also as it is written where JSON has none.
fn number(value: &Value) -> Option<f64> {
    match value.as_str() {
        Some("NaN") => Some(f64::NAN),
        Some("Infinity") => Some(f64::INFINITY),
        Some("-Infinity") => Some(f64::NEG_INFINITY),
        _ => value.as_f64(),
    }
}

/// The number of the eight bytes, the least first, that a text of base 64 stands for (RFC 4648).
fn double_in_base64(text: &str) -> Option<f64> {
    let digits = text.strip_suffix('=').filter(|digits| digits.len() == 11)?;
    let mut bits: u128 = 0;
    for digit in digits.bytes() {
        let value = match digit {
            b'A'..=b'Z' => digit - b'A',
            b'a'..=b'z' => digit - b'a' + 26,
            b'0'..=b'9' => digit - b'0' + 52,
            b'+' => 62,
            b'/' => 63,
            _ => return None,
        };
        bits = bits << 6 | u128::from(value);
    }
    // Of the last digit two bits are none of the number's.
    Some(f64::from_bits(((bits >> 2) as u64).swap_bytes()))
}

/// What a file of a folder says; nothing where there is none.
fn json(folder: &Path, name: &str) -> Result<Option<Value>> {
    let path = folder.join(name);
    if !path.is_file() {
        return Ok(None);
    }
    let text = bytes(&path, "read the array", LONGEST)?;
    serde_json::from_slice(&text).map(Some).map_err(|error| damaged(format!("{name}: {error}")))
}

/// The attributes of a group.
pub(super) fn of_group(folder: &Path) -> Result<Attributes> {
    let group = json(folder, "zarr.json")?.map(|group| group["attributes"].clone());
    Ok(said(&group.or(json(folder, ".zattrs")?).unwrap_or_default()))
}

/// Attributes as those of NetCDF.
fn said(attributes: &Value) -> Attributes {
    let of = |value: &Value| {
        let items = value.as_array().map_or_else(|| vec![value.clone()], Clone::clone);
        let numbers: Option<Vec<f64>> = items.iter().map(number).collect();
        match (value.as_str(), numbers) {
            (None, Some(numbers)) if items.iter().all(|item| item.is_i64() || item.is_u64()) => {
                Attribute::Whole(numbers)
            }
            (None, Some(numbers)) => Attribute::Floating(numbers),
            (Some(text), _) => Attribute::Text(text.to_owned()),
            _ => Attribute::Other,
        }
    };
    let all = attributes.as_object().into_iter().flatten().map(|(name, value)| {
        // Xarray writes the bytes of a double where JSON might have no number.
        let double = value.as_str().filter(|_| name == "_FillValue").and_then(double_in_base64);
        (name.clone(), double.map_or_else(|| of(value), |fill| Attribute::Floating(vec![fill])))
    });
    Attributes::of(all)
}

/// A type as NumPy spells it, with the order of its bytes.
fn of_numpy(text: &str) -> Option<(Stored, bool)> {
    let order = text.get(..1)?;
    let bytes = text.get(2..)?.parse().ok()?;
    let stored = match text.get(1..2)? {
        "i" => Stored::whole(true, bytes),
        "u" => Stored::whole(false, bytes),
        "f" => Stored::float(bytes),
        _ => None,
    }?;
    Some((stored, order != ">"))
}

/// A type by its name.
fn of_name(name: &str) -> Option<Stored> {
    let digits = name.find(|char: char| char.is_ascii_digit())?;
    let (kind, bits) = name.split_at(digits);
    let bytes = bits.parse::<u64>().ok().filter(|bits| bits.is_multiple_of(8))? / 8;
    match kind {
        "int" => Stored::whole(true, bytes),
        "uint" => Stored::whole(false, bytes),
        "float" => Stored::float(bytes),
        _ => None,
    }
}

fn other_type(found: &Value) -> Error {
    Error::malformed(
        format!("the samples are of the type {found}"),
        "write the cube as an array of floats or whole numbers",
    )
}

/// An array that cannot be read.
pub(super) fn damaged(error: impl std::fmt::Display) -> Error {
    Error::malformed(
        format!("the Zarr array cannot be read: {error}"),
        "write or copy it again, or write the cube with np.save('cube.npy', zarr.open('cube.zarr')[:])",
    )
}
