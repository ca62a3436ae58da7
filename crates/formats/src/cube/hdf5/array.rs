//! Arrays of an HDF5 file: their type, their dimensions, what their attributes say.

use super::sound::{damaged, sound};
use super::source::{check_chunks, step};
use crate::cube::attributes::{Attribute, Attributes};
use crate::cube::packed::Slices;
use crate::cube::stored::{Stored, decode};
use crate::cube::values::Values;
use hadar::cube::Sample;
use hadar::error::{Error, Result};
use hdf5_pure::{AttrValue, Dataset, Datatype, DatatypeByteOrder, File, Group};
use std::collections::HashMap;

/// Groups within groups, and arrays, that are looked at.
const MOST_DEPTH: usize = 8;
pub(super) const MOST_ARRAYS: usize = 1000;
const MOST_GROUPS: usize = 1000;

/// An array of numbers.
#[derive(Debug)]
pub(super) struct Array {
    pub(super) dataset: Dataset,
    pub(super) stored: Stored,
    pub(super) little_endian: bool,
    /// Sides as NumPy would say them, or MATLAB where MATLAB has written it.
    pub(super) sides: Vec<usize>,
    pub(super) matlab: bool,
    pub(super) values: Option<Values>,
    pub(super) attributes: Attributes,
}

impl Array {
    /// What the numbers of an array stand for is not looked at before [`Self::with_values`].
    pub(super) fn of(dataset: Dataset) -> Result<Self> {
        step();
        let (stored, little_endian) = number(&dataset.datatype().map_err(damaged)?)?;
        let side = |side: u64| usize::try_from(side).unwrap_or(usize::MAX);
        let mut sides: Vec<usize> = dataset.shape().map_err(damaged)?.into_iter().map(side).collect();
        let attributes = dataset.attrs().map_err(damaged)?;
        let matlab = attributes.contains_key("MATLAB_class");
        if matlab {
            sides.reverse();
        }
        let attributes = said(&attributes);
        let stored = attributes.stored(stored);
        Ok(Self { dataset, stored, little_endian, sides, matlab, values: None, attributes })
    }

    /// The same with what its numbers stand for.
    pub(super) fn with_values(self) -> Result<Self> {
        Ok(Self { values: self.attributes.values(self.stored)?, ..self })
    }

    /// All its numbers, of so many.
    pub(super) fn numbers(&self, count: usize, len: u64) -> Option<Vec<f64>> {
        check_chunks(&self.dataset, len).ok()?;
        let bytes = sound(|| self.dataset.read_raw().map_err(damaged)).ok()?;
        let mut numbers = vec![0.0; count];
        (bytes.len() == count * self.stored.size()).then(|| {
            decode(&bytes, self.stored, self.little_endian, &mut numbers);
            numbers
        })
    }

    /// The text that MATLAB has written as an array of its characters, of no more than so many.
    pub(super) fn text(&self, most: usize, len: u64) -> Option<String> {
        let count: usize = self.sides.iter().product();
        if self.attributes.text("MATLAB_class") != Some("char") || count > most {
            return None;
        }
        let letter = |code: f64| char::from_u32(code as u32);
        self.numbers(count, len)?.into_iter().map(letter).collect()
    }
}

impl Slices for Array {
    fn stored(&self) -> Stored {
        self.stored
    }

    fn values(&self) -> Option<&Values> {
        self.values.as_ref()
    }

    fn slices<S: Sample>(&self, first: usize, count: usize, out: &mut [S]) -> Result<()> {
        let bytes = sound(|| self.dataset.read_raw_rows(first as u64, count as u64).map_err(damaged))?;
        if bytes.len() != out.len() * self.stored.size() {
            return Err(damaged("the array ends too early"));
        }
        decode(&bytes, self.stored, self.little_endian, out);
        Ok(())
    }
}

/// How numbers of a type are stored, and whether their least byte comes first.
fn number(datatype: &Datatype) -> Result<(Stored, bool)> {
    let other = || {
        let instead = "write the cube as an array of floats or whole numbers";
        Error::malformed("the variable is no array of such numbers as a cube has", instead)
    };
    let (stored, order) = match datatype {
        Datatype::FixedPoint { size, byte_order, layout }
            if layout.bit_offset == 0 && u32::from(layout.bit_precision) == 8 * size =>
        {
            (Stored::whole(layout.signed, u64::from(*size)), byte_order)
        }
        Datatype::FloatingPoint { size, byte_order, layout } => {
            let ieee = matches!(
                (size, layout.exponent_size, layout.mantissa_size),
                (2, 5, 10) | (4, 8, 23) | (8, 11, 52)
            );
            (Stored::float(u64::from(*size)).filter(|_| ieee), byte_order)
        }
        Datatype::Enumeration { size: 1, .. } => {
            let instead = "write what was counted, or a.astype(np.uint8) if 0 and 1 are counts";
            return Err(Error::malformed("the samples are truth values", instead));
        }
        Datatype::Compound { members, .. } if members.len() == 2 => {
            let instead = "write one of its parts, such as the magnitude";
            return Err(Error::malformed("the samples are complex numbers or pairs", instead));
        }
        _ => return Err(other()),
    };
    let little_endian = match order {
        DatatypeByteOrder::LittleEndian => true,
        DatatypeByteOrder::BigEndian => false,
        _ => return Err(other()),
    };
    Ok((stored.ok_or_else(other)?, little_endian))
}

/// The attributes of an array or a group.
pub(super) fn said(attributes: &HashMap<String, AttrValue>) -> Attributes {
    let of = |value: &AttrValue| {
        let signed = || value.to_i64s().map(|all| all.iter().map(|one| *one as f64).collect());
        let unsigned = || value.to_u64s().map(|all| all.iter().map(|one| *one as f64).collect());
        let whole = || signed().or_else(unsigned).map(Attribute::Whole);
        let text = || value.as_str().map(|text| Attribute::Text(text.to_owned()));
        value.to_f64s().map(Attribute::Floating).or_else(whole).or_else(text).unwrap_or(Attribute::Other)
    };
    Attributes::of(attributes.iter().map(|(name, value)| (name.clone(), of(value))))
}

/// All arrays by their path, those that MATLAB keeps for itself left out.
pub(super) fn listed(source: &File) -> Vec<(String, Dataset)> {
    let mut found = Vec::new();
    within(&source.root(), "", MOST_DEPTH, &mut 0, &mut found);
    found
}

/// `groups`: how many have been looked into, which a file may lead to again and again.
fn within(group: &Group, path: &str, depth: usize, groups: &mut usize, found: &mut Vec<(String, Dataset)>) {
    *groups += 1;
    step();
    for name in group.datasets().unwrap_or_default() {
        step();
        if found.len() < MOST_ARRAYS
            && let Ok(dataset) = group.dataset(&name)
        {
            found.push((format!("{path}{name}"), dataset));
        }
    }
    for name in group.groups().unwrap_or_default() {
        step();
        if depth > 0
            && *groups < MOST_GROUPS
            && found.len() < MOST_ARRAYS
            && !name.starts_with('#')
            && let Ok(inner) = group.group(&name)
        {
            within(&inner, &format!("{path}{name}/"), depth - 1, groups, found);
        }
    }
}
