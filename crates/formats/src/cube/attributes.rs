//! What the attributes of an array say of its numbers, by the conventions of NetCDF, whatever file they are from.
//!
//! Source: NetCDF Users Guide, Attribute Conventions.

use super::scaling;
use super::stored::Stored;
use super::values::{ALL_VALID, Values};
use hadar::error::{Error, Result};

/// What NetCDF fills floating-point arrays with where nothing else is said.
const NETCDF_FILL: f64 = 9.969_209_968_386_869e36;
/// By how much the end of a range of whole numbers may be off.
const ROUNDING: f64 = 1e-6;
/// By which stored numbers become samples: factor and offset.
const APPLIED: [&str; 2] = ["scale_factor", "add_offset"];
/// What the unit of an array is called, and what says without one what it is.
const UNITS: [&str; 3] = ["units", "unit", "data_units"];
const QUANTITIES: [&str; 2] = ["standard_name", "quantity"];

/// The value of an attribute.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Attribute {
    Text(String),
    Floating(Vec<f64>),
    Whole(Vec<f64>),
    /// Neither text nor numbers, which other kinds of files have.
    #[cfg(any(feature = "hdf5", feature = "zarr"))]
    Other,
}

/// The attributes of an array, by their names.
#[derive(Debug, Clone, Default)]
pub(super) struct Attributes(Vec<(String, Attribute)>);

impl Attributes {
    pub(super) fn of(attributes: impl IntoIterator<Item = (String, Attribute)>) -> Self {
        Self(attributes.into_iter().collect())
    }

    /// An attribute, which some write with other capitals.
    fn get(&self, key: &str) -> Option<&Attribute> {
        self.0.iter().find(|(name, _)| name.eq_ignore_ascii_case(key)).map(|(_, value)| value)
    }

    /// All of them with their names.
    pub(super) fn all(&self) -> impl Iterator<Item = (&str, &Attribute)> {
        self.0.iter().map(|(name, value)| (name.as_str(), value))
    }

    /// Refuses factors and offsets of samples that are not applied: of their array `name` under other names, or under any of the folders that it
    /// is in where it has none itself.
    ///
    /// # Errors
    /// One that would change samples.
    pub(super) fn check_scaling(&self, name: &str, folders: impl IntoIterator<Item = Self>) -> Result<()> {
        let is_applied = |key: &str| APPLIED.iter().any(|applied| key.eq_ignore_ascii_case(applied));
        let check = |(key, value): (&str, &Attribute)| match value {
            Attribute::Floating(numbers) | Attribute::Whole(numbers) => scaling::check(key, name, numbers),
            Attribute::Text(text) => {
                text.trim().parse().map_or(Ok(()), |one| scaling::check(key, name, &[one]))
            }
            #[cfg(any(feature = "hdf5", feature = "zarr"))]
            Attribute::Other => Ok(()),
        };
        self.all().filter(|(key, _)| !is_applied(key)).try_for_each(check)?;
        if APPLIED.iter().any(|key| self.says(key)) {
            return Ok(());
        }
        folders.into_iter().try_for_each(|folder| folder.all().try_for_each(check))
    }

    /// The unit that is stated as such.
    pub(super) fn stated_unit(&self) -> Option<&str> {
        UNITS.iter().find_map(|key| self.text(key))
    }

    /// Whether there is an attribute of this name.
    pub(super) fn says(&self, key: &str) -> bool {
        self.get(key).is_some()
    }

    pub(super) fn text(&self, key: &str) -> Option<&str> {
        match self.get(key)? {
            Attribute::Text(text) => Some(text),
            _ => None,
        }
    }

    /// The unit of the samples, or what they are.
    pub(super) fn unit(&self) -> Option<String> {
        let unit = self.stated_unit().or_else(|| QUANTITIES.iter().find_map(|key| self.text(key)))?;
        (!unit.trim().is_empty()).then(|| unit.to_owned())
    }

    /// Whether the numbers are unsigned, which NetCDF's older model has no types for.
    fn says_unsigned(&self) -> bool {
        self.text("_Unsigned").is_some_and(|text| text.eq_ignore_ascii_case("true"))
    }

    /// How numbers are stored, where their type is that of the signed ones.
    pub(super) fn stored(&self, stored: Stored) -> Stored {
        match (self.says_unsigned(), stored) {
            (true, Stored::I8) => Stored::U8,
            (true, Stored::I16) => Stored::U16,
            (true, Stored::I32) => Stored::U32,
            (true, Stored::I64) => Stored::U64,
            _ => stored,
        }
    }

    /// What the numbers stand for.
    pub(super) fn values(&self, stored: Stored) -> Result<Option<Values>> {
        self.values_with(stored, None)
    }

    /// The same where one more number may mean that nothing was measured.
    pub(super) fn values_with(&self, stored: Stored, filled: Option<f64>) -> Result<Option<Values>> {
        let wrong = |key: &str, found: String, instead: &str| {
            Error::malformed(format!("the attribute is {found}"), instead).for_key(key)
        };
        let numbers = |key: &str| match self.get(key) {
            None => Ok(Vec::new()),
            Some(Attribute::Floating(numbers) | Attribute::Whole(numbers)) => Ok(numbers.clone()),
            Some(Attribute::Text(text)) => {
                Err(wrong(key, format!("the text `{}`", text.escape_debug()), "write it as a number"))
            }
            #[cfg(any(feature = "hdf5", feature = "zarr"))]
            Some(Attribute::Other) => Err(wrong(key, "no number".to_owned(), "write it as one")),
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
        let unsigned = if self.says_unsigned() { (8.0 * stored.size() as f64).exp2() } else { 0.0 };
        let of_bits = |value: f64| if value < 0.0 { value + unsigned } else { value };
        let mut missing = [numbers("_FillValue")?, numbers("missing_value")?].concat();
        missing.extend(filled);
        missing.iter_mut().for_each(|value| *value = of_bits(*value));
        // Whether NetCDF wrote the file is not asked: no reading is of that value.
        if missing.is_empty() && matches!(stored, Stored::F32 | Stored::F64) {
            missing.push(NETCDF_FILL);
        }
        missing.retain(|value| !value.is_nan());
        missing.dedup();
        let (gain, offset) = (one(APPLIED[0])?, one(APPLIED[1])?);
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
            .any(|key| matches!(self.get(key), Some(Attribute::Floating(_))));
        let packed =
            (gain, offset) != (None, None) && !matches!(stored, Stored::F16 | Stored::F32 | Stored::F64);
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
}
