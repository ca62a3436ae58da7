//! Arrays of an HDF5 file: their type, their dimensions, what their attributes say.

use super::sound::{damaged, sound};
use super::source::{check_chunks, step};
use crate::cube::stored::{Stored, decode};
use crate::cube::values::{ALL_VALID, Values};
use crate::spectral_unit::SpectralUnit;
use hadar::cube::Sample;
use hadar::error::{Error, Result};
use hdf5_pure::{AttrValue, Dataset, Datatype, DatatypeByteOrder, File, Group};
use std::collections::HashMap;

/// Groups within groups, and arrays, that are looked at.
const MOST_DEPTH: usize = 8;
pub(super) const MOST_ARRAYS: usize = 1000;
const MOST_GROUPS: usize = 1000;
/// What NetCDF fills floating-point arrays with where nothing else is said.
const NETCDF_FILL: f64 = 9.969_209_968_386_869e36;
/// By how much the end of a range of whole numbers may be off.
const ROUNDING: f64 = 1e-6;
/// What the unit of an array is called, and what says without one what it is.
const UNITS: [&str; 3] = ["units", "unit", "data_units"];
const QUANTITIES: [&str; 2] = ["standard_name", "quantity"];
/// What the spectral axis of a file is called.
const AXIS: [&str; 5] = ["wavelength", "wavelengths", "wavenumber", "wavenumbers", "lambda"];

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
    /// The unit of the samples, as the file says it.
    pub(super) unit: Option<String>,
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
        let stored = match (says_unsigned(&attributes), stored) {
            (true, Stored::I8) => Stored::U8,
            (true, Stored::I16) => Stored::U16,
            (true, Stored::I32) => Stored::U32,
            (true, Stored::I64) => Stored::U64,
            _ => stored,
        };
        let text = |name: &&str| attribute(&attributes, name)?.as_str().map(str::to_owned);
        let unit = UNITS.iter().find_map(text).or_else(|| QUANTITIES.iter().find_map(text));
        let unit = unit.filter(|unit| !unit.trim().is_empty());
        Ok(Self { dataset, stored, little_endian, sides, matlab, values: None, unit })
    }

    /// The same with what its numbers stand for.
    pub(super) fn with_values(self) -> Result<Self> {
        let attributes = self.dataset.attrs().map_err(damaged)?;
        Ok(Self { values: values(&attributes, self.stored)?, ..self })
    }

    /// Some slices of the first dimension, as they are stored.
    pub(super) fn slices<S: Sample>(&self, first: usize, count: usize, out: &mut [S]) -> Result<()> {
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

/// What the numbers stand for, by the conventions of NetCDF.
fn values(attributes: &HashMap<String, AttrValue>, stored: Stored) -> Result<Option<Values>> {
    let wrong = |key: &str, found: String, instead: &str| {
        Error::malformed(format!("the attribute is {found}"), instead).for_key(key)
    };
    let numbers = |key: &str| match attribute(attributes, key) {
        None => Ok(Vec::new()),
        Some(value) => {
            let signed = || value.to_i64s().map(|all| all.iter().map(|one| *one as f64).collect());
            let unsigned = || value.to_u64s().map(|all| all.iter().map(|one| *one as f64).collect());
            let numbers: Option<Vec<f64>> = value.to_f64s().or_else(signed).or_else(unsigned);
            numbers.ok_or_else(|| match value.as_str() {
                Some(text) => {
                    wrong(key, format!("the text `{}`", text.escape_debug()), "write it as a number")
                }
                None => wrong(key, "no number".to_owned(), "write it as one"),
            })
        }
    };
    let one = |key: &str| match numbers(key)?.as_slice() {
        [] => Ok(None),
        [value] if value.is_finite() => Ok(Some(*value)),
        [value] => Err(wrong(key, value.to_string(), "write a finite number")),
        many => {
            let instead = "write one number for the whole array, or the array unpacked";
            Err(wrong(key, format!("a list of {} numbers", many.len()), instead))
        }
    };
    // A number that is unsigned beside its type is written as the signed one of the same bits.
    let unsigned = if says_unsigned(attributes) { (8.0 * stored.size() as f64).exp2() } else { 0.0 };
    let of_bits = |value: f64| if value < 0.0 { value + unsigned } else { value };
    let mut missing = [numbers("_FillValue")?, numbers("missing_value")?].concat();
    missing.iter_mut().for_each(|value| *value = of_bits(*value));
    // Whether NetCDF wrote the file is not asked: no reading is of that value.
    if missing.is_empty() && matches!(stored, Stored::F32 | Stored::F64) {
        missing.push(NETCDF_FILL);
    }
    missing.retain(|value| !value.is_nan());
    missing.dedup();
    let (gain, offset) = (one("scale_factor")?, one("add_offset")?);
    if gain == Some(0.0) {
        return Err(wrong(
            "scale_factor",
            "0, which makes all samples one".to_owned(),
            "write another number",
        ));
    }
    let valid = match (numbers("valid_range")?.as_slice(), one("valid_min")?, one("valid_max")?) {
        ([], None, None) => ALL_VALID,
        ([], least, most) => [least.unwrap_or(f64::NEG_INFINITY), most.unwrap_or(f64::INFINITY)],
        (&[least, most], None, None) => [least, most],
        ([_, _], ..) => {
            let found = "beside valid_min or valid_max".to_owned();
            return Err(wrong("valid_range", found, "keep one of them"));
        }
        (other, ..) => {
            let found = format!("a list of {} numbers", other.len());
            return Err(wrong("valid_range", found, "write the least and the largest number"));
        }
    };
    // They are in what is stored, but in what it stands for where they are of its type and not of that which is stored.
    let is_of_samples = ["valid_range", "valid_min", "valid_max"]
        .iter()
        .any(|key| attribute(attributes, key).is_some_and(|value| value.to_f64s().is_some()));
    let packed = (gain, offset) != (None, None) && !matches!(stored, Stored::F16 | Stored::F32 | Stored::F64);
    let valid = match is_of_samples && packed {
        true => {
            let [a, b] = valid.map(|value| (value - offset.unwrap_or(0.0)) / gain.unwrap_or(1.0));
            // Whole numbers, whatever the division was rounded to.
            [(a.min(b) - ROUNDING).ceil(), (a.max(b) + ROUNDING).floor()]
        }
        false => valid.map(of_bits),
    };
    if valid[0].is_nan() || valid[1].is_nan() || valid[0] > valid[1] {
        let found = format!("from {} to {}", valid[0], valid[1]);
        return Err(wrong("valid_range", found, "write the smaller number first"));
    }
    let list = |value: Option<f64>| value.map(|value| vec![value]);
    Ok(Values::new(list(gain), list(offset), missing, valid))
}

/// Whether the numbers are unsigned, which NetCDF's older model has no types for.
fn says_unsigned(attributes: &HashMap<String, AttrValue>) -> bool {
    let said = attributes.get("_Unsigned").and_then(AttrValue::as_str);
    said.is_some_and(|text| text.eq_ignore_ascii_case("true"))
}

/// An attribute, which some write with other capitals.
fn attribute<'a>(attributes: &'a HashMap<String, AttrValue>, key: &str) -> Option<&'a AttrValue> {
    attributes.iter().find(|(name, _)| name.eq_ignore_ascii_case(key)).map(|(_, value)| value)
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

/// Centres of the bands, cm⁻¹, of an axis of so many numbers beside the array that says its unit; and whether there is only one that
/// does not.
pub(super) fn wavelengths(source: &File, array: &str, bands: usize, len: u64) -> (Option<Vec<f64>>, bool) {
    let folder = array.rsplit_once('/').map_or("", |(folder, _)| folder);
    let of_bands = |name: &&str| {
        let path = if folder.is_empty() { (*name).to_owned() } else { format!("{folder}/{name}") };
        source.dataset(&path).ok().filter(|axis| axis.shape().is_ok_and(|shape| shape == [bands as u64]))
    };
    let centres = |axis: &Dataset| {
        let unit = SpectralUnit::spelt(axis.attrs().ok()?.get("units")?.as_str()?)?;
        check_chunks(axis, len).ok()?;
        let centres: Vec<f64> =
            axis.read_f64().ok()?.into_iter().map(|value| unit.wavenumber_cm1(value)).collect();
        centres.iter().all(|centre| *centre > 0.0 && centre.is_finite()).then_some(centres)
    };
    let listed: Vec<Dataset> = AXIS.iter().filter_map(of_bands).collect();
    let found = listed.iter().find_map(centres);
    let unused = found.is_none() && !listed.is_empty();
    (found, unused)
}
