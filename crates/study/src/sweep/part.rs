//! An answer as JSON of which those parts alone are made that are wanted: what no column of a row is about is not put into words.
//!
//! What is wanted is said by paths of names, such as `verdict.margin`; of a list all is made, and of one whose codes are a column
//! ([`super::record`]) the codes.

use super::record::CODED;
use serde::Serialize;
use serde::ser::{SerializeMap, SerializeSeq, SerializeStruct, Serializer};
use serde_json::value::Serializer as Whole;
use serde_json::{Error, Map, Value};

/// Makes the parts of an answer that are wanted; all of it where nothing is named.
pub(super) fn parts(answer: &impl Serialize, paths: &[String]) -> Result<Value, Error> {
    let wanted: Vec<&str> = paths.iter().map(String::as_str).collect();
    if wanted.is_empty() { whole(answer) } else { answer.serialize(Part { wanted: &wanted }) }
}

fn whole(value: &(impl Serialize + ?Sized)) -> Result<Value, Error> {
    serde_json::to_value(value)
}

/// What is wanted of a value.
#[derive(Clone, Copy)]
struct Part<'w> {
    wanted: &'w [&'w str],
}

impl Part<'_> {
    /// A value below a name, if anything of it is wanted.
    fn below<T: Serialize + ?Sized>(self, name: &str, value: &T) -> Result<Option<Value>, Error> {
        let mut inside = Vec::new();
        for path in self.wanted {
            let Some(rest) = path.strip_prefix(name) else { continue };
            match rest.strip_prefix('.') {
                Some(rest) => inside.push(rest),
                None if rest.is_empty() && CODED.contains(&name) => inside.push("code"),
                None if rest.is_empty() || rest.starts_with('[') => return whole(value).map(Some),
                None => {}
            }
        }
        if inside.is_empty() { Ok(None) } else { value.serialize(Part { wanted: &inside }).map(Some) }
    }
}

/// A table, or a list, as far as it is made.
struct Made<'w> {
    part: Part<'w>,
    map: Map<String, Value>,
    list: Vec<Value>,
    key: Option<String>,
}

impl<'w> Made<'w> {
    fn of(part: Part<'w>) -> Self {
        Self { part, map: Map::new(), list: Vec::new(), key: None }
    }

    fn put<T: Serialize + ?Sized>(&mut self, name: &str, value: &T) -> Result<(), Error> {
        if let Some(value) = self.part.below(name, value)? {
            self.map.insert(name.to_owned(), value);
        }
        Ok(())
    }
}

/// Values without parts are made whole.
macro_rules! whole {
    ($($name:ident($($value:ident: $type:ty),*);)*) => {
        $(fn $name(self, $($value: $type),*) -> Result<Value, Error> { Whole.$name($($value),*) })*
    };
}

impl<'w> Serializer for Part<'w> {
    type Ok = Value;
    type Error = Error;
    type SerializeSeq = Made<'w>;
    type SerializeTuple = <Whole as Serializer>::SerializeTuple;
    type SerializeTupleStruct = <Whole as Serializer>::SerializeTupleStruct;
    type SerializeTupleVariant = <Whole as Serializer>::SerializeTupleVariant;
    type SerializeMap = Made<'w>;
    type SerializeStruct = Made<'w>;
    type SerializeStructVariant = <Whole as Serializer>::SerializeStructVariant;

    whole! {
        serialize_bool(value: bool);
        serialize_i8(value: i8);
        serialize_i16(value: i16);
        serialize_i32(value: i32);
        serialize_i64(value: i64);
        serialize_i128(value: i128);
        serialize_u8(value: u8);
        serialize_u16(value: u16);
        serialize_u32(value: u32);
        serialize_u64(value: u64);
        serialize_u128(value: u128);
        serialize_f32(value: f32);
        serialize_f64(value: f64);
        serialize_char(value: char);
        serialize_str(value: &str);
        serialize_bytes(value: &[u8]);
        serialize_none();
        serialize_unit();
        serialize_unit_struct(name: &'static str);
        serialize_unit_variant(name: &'static str, index: u32, variant: &'static str);
    }

    fn serialize_some<T: Serialize + ?Sized>(self, value: &T) -> Result<Value, Error> {
        value.serialize(self)
    }

    fn serialize_newtype_struct<T: Serialize + ?Sized>(
        self,
        _: &'static str,
        value: &T,
    ) -> Result<Value, Error> {
        value.serialize(self)
    }

    fn serialize_newtype_variant<T: Serialize + ?Sized>(
        self,
        name: &'static str,
        index: u32,
        variant: &'static str,
        value: &T,
    ) -> Result<Value, Error> {
        Whole.serialize_newtype_variant(name, index, variant, value)
    }

    fn serialize_seq(self, _: Option<usize>) -> Result<Made<'w>, Error> {
        Ok(Made::of(self))
    }

    fn serialize_tuple(self, length: usize) -> Result<Self::SerializeTuple, Error> {
        Whole.serialize_tuple(length)
    }

    fn serialize_tuple_struct(
        self,
        name: &'static str,
        length: usize,
    ) -> Result<Self::SerializeTupleStruct, Error> {
        Whole.serialize_tuple_struct(name, length)
    }

    fn serialize_tuple_variant(
        self,
        name: &'static str,
        index: u32,
        variant: &'static str,
        length: usize,
    ) -> Result<Self::SerializeTupleVariant, Error> {
        Whole.serialize_tuple_variant(name, index, variant, length)
    }

    fn serialize_map(self, _: Option<usize>) -> Result<Made<'w>, Error> {
        Ok(Made::of(self))
    }

    fn serialize_struct(self, _: &'static str, _: usize) -> Result<Made<'w>, Error> {
        Ok(Made::of(self))
    }

    fn serialize_struct_variant(
        self,
        name: &'static str,
        index: u32,
        variant: &'static str,
        length: usize,
    ) -> Result<Self::SerializeStructVariant, Error> {
        Whole.serialize_struct_variant(name, index, variant, length)
    }
}

impl SerializeSeq for Made<'_> {
    type Ok = Value;
    type Error = Error;

    fn serialize_element<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Error> {
        self.list.push(value.serialize(self.part)?);
        Ok(())
    }

    fn end(self) -> Result<Value, Error> {
        Ok(Value::Array(self.list))
    }
}

impl SerializeStruct for Made<'_> {
    type Ok = Value;
    type Error = Error;

    fn serialize_field<T: Serialize + ?Sized>(&mut self, name: &'static str, value: &T) -> Result<(), Error> {
        self.put(name, value)
    }

    fn end(self) -> Result<Value, Error> {
        Ok(Value::Object(self.map))
    }
}

impl SerializeMap for Made<'_> {
    type Ok = Value;
    type Error = Error;

    fn serialize_key<T: Serialize + ?Sized>(&mut self, key: &T) -> Result<(), Error> {
        self.key = Some(match whole(key)? {
            Value::String(name) => name,
            other => other.to_string(),
        });
        Ok(())
    }

    fn serialize_value<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Error> {
        let name = self.key.take().unwrap_or_default();
        self.put(&name, value)
    }

    fn end(self) -> Result<Value, Error> {
        Ok(Value::Object(self.map))
    }
}
