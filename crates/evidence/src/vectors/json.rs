//! JSON as it is written: keys in the order given, lists of numbers on one line.

/// A value.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Json {
    Null,
    /// With the fewest digits that give the double back.
    Number(f64),
    Text(String),
    List(Vec<Json>),
    Object(Vec<(String, Json)>),
}

impl From<f64> for Json {
    fn from(value: f64) -> Self {
        Self::Number(value)
    }
}

impl From<&str> for Json {
    fn from(value: &str) -> Self {
        Self::Text(value.into())
    }
}

impl From<&[f64]> for Json {
    fn from(values: &[f64]) -> Self {
        Self::List(values.iter().copied().map(Self::Number).collect())
    }
}

impl<T: Into<Self>> From<Option<T>> for Json {
    fn from(value: Option<T>) -> Self {
        value.map_or(Self::Null, Into::into)
    }
}

impl Json {
    /// An object of keys known beforehand.
    pub(super) fn object<const N: usize>(entries: [(&str, Self); N]) -> Self {
        Self::Object(entries.into_iter().map(|(key, value)| (key.to_owned(), value)).collect())
    }

    /// The text of a file.
    pub(super) fn written(&self) -> String {
        let mut text = String::new();
        self.write(0, &mut text);
        text + "\n"
    }

    fn is_plain(&self) -> bool {
        !matches!(self, Self::List(_) | Self::Object(_))
    }

    fn write(&self, depth: usize, text: &mut String) {
        match self {
            Self::Null => text.push_str("null"),
            Self::Number(value) if value.fract() == 0.0 && value.abs() < 1e15 => {
                text.push_str(&format!("{value}"));
            }
            Self::Number(value) => text.push_str(&format!("{value:?}")),
            // Quotes and control characters as JSON has them.
            Self::Text(value) => text.push_str(&serde_json::Value::from(value.as_str()).to_string()),
            Self::List(values) if values.iter().all(Self::is_plain) => {
                text.push('[');
                for (i, value) in values.iter().enumerate() {
                    text.push_str(if i > 0 { ", " } else { "" });
                    value.write(depth, text);
                }
                text.push(']');
            }
            Self::List(values) => block(['[', ']'], depth, text, values, |value, text| {
                value.write(depth + 1, text);
            }),
            Self::Object(entries) => block(['{', '}'], depth, text, entries, |(key, value), text| {
                text.push_str(&format!("\"{key}\": "));
                value.write(depth + 1, text);
            }),
        }
    }
}

/// Each on a line of its own.
fn block<T>(ends: [char; 2], depth: usize, text: &mut String, all: &[T], write: impl Fn(&T, &mut String)) {
    text.push(ends[0]);
    for (i, one) in all.iter().enumerate() {
        text.push_str(if i > 0 { ",\n" } else { "\n" });
        text.push_str(&" ".repeat(depth + 1));
        write(one, text);
    }
    text.push('\n');
    text.push_str(&" ".repeat(depth));
    text.push(ends[1]);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_again() {
        let numbers = [0.1, -1e-300, 1e22, 293.15, 3.0, f64::from_bits(293.15_f64.to_bits() + 1)];
        let json = Json::object([
            ("numbers", Json::from(numbers.as_slice())),
            ("text", "a \"b\"\n".into()),
            ("none", Json::Null),
            ("list", Json::List(vec![Json::object([("one", 1.0.into())]), Json::List(Vec::new())])),
        ]);
        let read: serde_json::Value = serde_json::from_str(&json.written()).unwrap();
        let back = read["numbers"].as_array().unwrap().iter().map(|number| number.as_f64().unwrap());
        assert_eq!(back.collect::<Vec<_>>(), numbers);
        assert_eq!(read["text"], "a \"b\"\n");
        assert!(read["none"].is_null() && read["list"][0]["one"] == 1.0);
        assert!(json.written().starts_with("{\n \"numbers\": [0.1, "), "{}", json.written());
    }
}
