//! A scenario as fields: the tables and keys that its text has, and those that it could have, from the table of keys.

use hadar::atmosphere::Atmosphere;
use hadar::units::Dimension;
use hadar_study::scenario::keys::{FILES, Key, Silent, Table, Value};
use serde::Serialize;
use toml_edit::{DocumentMut, Item, TableLike};

/// The fields of a scenario.
#[derive(Debug, Serialize)]
pub(crate) struct Form {
    /// Tables in the order of the table of keys; keys above all tables stand in the first.
    sections: Vec<Section>,
    /// Tables that it could have: its path, what it is called and what it means.
    absent: Vec<Absent>,
}

/// A table.
#[derive(Debug, Serialize)]
struct Section {
    path: String,
    /// The same without the place in a list, by which it is explained.
    word: String,
    meaning: &'static str,
    /// Whether there may be more of it.
    many: bool,
    /// Whether the scenario can do without it.
    removable: bool,
    fields: Vec<Field>,
    absent: Vec<Absent>,
}

/// A key that is not written.
#[derive(Debug, Serialize)]
struct Absent {
    path: String,
    name: String,
    meaning: &'static str,
}

/// A key that is written.
#[derive(Debug, Serialize)]
struct Field {
    path: String,
    word: String,
    name: String,
    meaning: &'static str,
    /// How it is shown: `quantity`, `number`, `choice`, `flag`, `material`, `materials`, `text` or `toml`.
    kind: &'static str,
    /// What is written, quotes of a text left out.
    value: String,
    /// Items of a list of materials.
    items: Vec<String>,
    choices: Vec<String>,
    slider: Option<Slider>,
    removable: bool,
}

/// A range that a slider covers, in the unit that is written.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct Slider {
    number: f64,
    unit: String,
    /// `linear`, `log`, or `nines`: logarithmic towards 1.
    scale: &'static str,
    low: f64,
    high: f64,
    whole: bool,
}

/// The root of the kind of file that `hadar size` reads.
fn root() -> Option<&'static Table> {
    FILES.iter().find(|kind| kind.commands.contains(&"size")).map(|kind| kind.root)
}

/// The fields of a text that may name these cameras; none where it is no TOML.
pub(crate) fn of(text: &str, presets: &[String]) -> Option<Form> {
    let document: DocumentMut = text.parse().ok()?;
    let root = root()?;
    let (table, mut sections) = (document.as_table(), Vec::new());
    sections.push(Section {
        path: String::new(),
        word: String::new(),
        meaning: "",
        many: false,
        removable: false,
        fields: fields(root, table, "", presets),
        absent: absent(root, table, "")
            .filter(|(key, _)| key.value.table().is_none())
            .map(|(_, one)| one)
            .collect(),
    });
    below(root, table, "", presets, &mut sections);
    let more = absent(root, table, "").filter(|(key, _)| key.value.table().is_some());
    Some(Form { absent: more.map(|(_, one)| one).collect(), sections })
}

/// The tables within a table.
fn below(
    table: &Table,
    written: &dyn TableLike,
    above: &str,
    presets: &[String],
    sections: &mut Vec<Section>,
) {
    for key in table.keys() {
        let (Some(inner), Some(item)) = (key.value.table(), written.get(key.name)) else { continue };
        let path = join(above, key.name);
        let mut add = |path: String, item: &Item| {
            let Some(found) = item.as_table_like() else { return };
            sections.push(Section {
                word: word(&path),
                meaning: key.meaning,
                many: matches!(key.value, Value::Tables(_)),
                removable: key.silent != Silent::Refused,
                fields: fields(inner, found, &path, presets),
                absent: absent(inner, found, &path).map(|(_, one)| one).collect(),
                path: path.clone(),
            });
            below(inner, found, &path, presets, sections);
        };
        match key.value {
            Value::Tables(_) => {
                let items = (0..).map_while(|index| item.get(index));
                items.enumerate().for_each(|(index, item)| add(format!("{path}[{index}]"), item));
            }
            Value::Named(_) => {
                let own = item.as_table_like().into_iter().flat_map(TableLike::iter);
                own.for_each(|(name, item)| add(join(&path, name), item));
            }
            _ => add(path, item),
        }
    }
}

fn fields(table: &Table, written: &dyn TableLike, above: &str, presets: &[String]) -> Vec<Field> {
    let value =
        |key: &Key| written.get(key.name).and_then(Item::as_value).filter(|_| key.value.table().is_none());
    table.keys().filter_map(|key| Some(field(&key, value(&key)?, above, presets))).collect()
}

fn field(key: &Key, value: &toml_edit::Value, above: &str, presets: &[String]) -> Field {
    let path = join(above, key.name);
    let text = match value.as_str() {
        Some(text) => text.to_owned(),
        None => value.clone().decorated("", "").to_string(),
    };
    let items = value.as_array().into_iter().flatten().filter_map(|item| item.as_str().map(str::to_owned));
    let choices = choices(key, &path, presets);
    let kind = match key.value {
        _ if !choices.is_empty() => "choice",
        Value::Quantity(..) | Value::Spectral => "quantity",
        Value::Number(_) | Value::NumberOrFile(_) | Value::Count(_) => "number",
        Value::Flag => "flag",
        Value::Material => "material",
        Value::List(Value::Material) => "materials",
        Value::Text | Value::Date | Value::File | Value::Choice(_) => "text",
        _ => "toml",
    };
    Field {
        word: word(&path),
        name: key.name.replace('_', " "),
        meaning: key.meaning,
        slider: slider(key, &text),
        removable: key.silent != Silent::Refused,
        items: items.collect(),
        value: text,
        path,
        kind,
        choices,
    }
}

/// The words that may stand at a key, where they are few.
fn choices(key: &Key, path: &str, presets: &[String]) -> Vec<String> {
    let names = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect();
    match (key.value, path) {
        (Value::Choice(words), _) => names(words),
        (_, "atmosphere.model") => names(Atmosphere::names()),
        (_, "camera.preset") => presets.to_vec(),
        _ => Vec::new(),
    }
}

/// The keys that are not written, those of lists of tables always: there may be one more. Tables of the author's own names are
/// named in the text.
fn absent<'a>(
    table: &'a Table,
    written: &'a dyn TableLike,
    above: &'a str,
) -> impl Iterator<Item = (Key, Absent)> + 'a {
    let could_be = |key: &Key| match key.value {
        // Files are read by the command alone.
        Value::File | Value::Named(_) => false,
        Value::Tables(_) => true,
        _ => written.get(key.name).is_none_or(Item::is_none),
    };
    table.keys().filter(could_be).map(move |key| {
        let one =
            Absent { path: join(above, key.name), name: key.name.replace('_', " "), meaning: key.meaning };
        (key, one)
    })
}

fn join(above: &str, name: &str) -> String {
    if above.is_empty() { name.to_owned() } else { format!("{above}.{name}") }
}

/// A path without places in lists.
fn word(path: &str) -> String {
    let parts = path.split('.').map(|part| part.split('[').next().unwrap_or(part));
    parts.collect::<Vec<_>>().join(".")
}

/// The range about a number that is written: of a share all of it, of a temperature 40 K, else a decade on either side.
fn slider(key: &Key, text: &str) -> Option<Slider> {
    let (dimension, allowed, whole) = match key.value {
        Value::Quantity(dimension, allowed) => (Some(dimension), Some(allowed), false),
        Value::Number(allowed) | Value::NumberOrFile(allowed) => (None, Some(allowed), false),
        Value::Count(_) => (None, None, true),
        _ => return None,
    };
    let (number, unit) = parts(text).filter(|_| text.len() <= LONGEST_NUMBER)?;
    if dimension.is_some_and(|dimension| dimension.parse(text).is_err()) {
        return None;
    }
    let is_share = allowed.is_some_and(|allowed| {
        allowed.allows(0.5) && allowed.allows(1.0 - 1e-9) && !allowed.allows(1.0 + 1e-6)
    });
    let (scale, low, high) = match dimension {
        _ if key.name == "detection_probability" => ("nines", 0.501, 0.999_999),
        Some(Dimension::Temperature) => {
            let half = if unit.ends_with('F') { 72.0 } else { 40.0 };
            ("linear", number - half, number + half)
        }
        None if is_share => ("linear", 0.0, 1.0),
        _ if whole => ("log", 1.0, (10.0 * number).clamp(100.0, 1e6)),
        _ => ("log", number / 10.0, number * 10.0),
    };
    // No end that is refused.
    let is_allowed = |value: f64| match (dimension, allowed) {
        (Some(dimension), Some(allowed)) => {
            dimension.parse(&format!("{value} {unit}")).is_ok_and(|value| allowed.allows(value))
        }
        (None, Some(allowed)) => allowed.allows(value),
        _ => true,
    };
    let [low, high] = [low, high].map(|end| nearest_allowed(number, end, is_allowed));
    let sound = number >= low && number <= high && low.is_finite() && high.is_finite() && low < high;
    (sound && (scale != "log" || low > 0.0)).then(|| Slider {
        number,
        unit: unit.to_owned(),
        scale,
        low,
        high,
        whole,
    })
}

/// Longest text that is taken for a number with its unit, bytes.
const LONGEST_NUMBER: usize = 64;
/// Halvings between an end of a slider that is refused and a number that is not.
const HALVINGS: usize = 40;

/// The end itself where it is allowed, else the last number towards it that is.
fn nearest_allowed(number: f64, end: f64, is_allowed: impl Fn(f64) -> bool) -> f64 {
    if is_allowed(end) || !is_allowed(number) {
        return end;
    }
    let halved = |(inside, outside): (f64, f64), _| {
        let middle = 0.5 * (inside + outside);
        if is_allowed(middle) { (middle, outside) } else { (inside, middle) }
    };
    (0..HALVINGS).fold((number, end), halved).0
}

/// A number and the unit behind it, as they are written.
fn parts(text: &str) -> Option<(f64, &str)> {
    let text = text.trim();
    let is_number = |end: &usize| text.get(..*end).is_some_and(|part| part.trim().parse::<f64>().is_ok());
    let ends = text.char_indices().map(|(at, _)| at).chain([text.len()]).skip(1);
    let end = ends.filter(is_number).last()?;
    let number: f64 = text.get(..end)?.trim().parse().ok()?;
    number.is_finite().then(|| (number, text.get(end..).unwrap_or_default().trim()))
}

/// What may stand at a path of a scenario.
#[derive(Debug, Clone, Copy)]
pub(crate) struct At(Option<Value>);

/// What may stand at a path.
pub(crate) fn value_at(path: &str) -> At {
    At(find(path).map(|(value, _)| value))
}

impl At {
    /// What is typed into a field, as it is written: a text where a text is due, else TOML where it is some.
    pub(crate) fn parsed(self, typed: &str) -> toml_edit::Value {
        let is_text = matches!(
            self.0,
            Some(
                Value::Quantity(..)
                    | Value::Spectral
                    | Value::Text
                    | Value::Date
                    | Value::Choice(_)
                    | Value::Material
                    | Value::File
            )
        );
        let toml = (!is_text).then(|| typed.trim().parse::<toml_edit::Value>().ok()).flatten();
        toml.unwrap_or_else(|| typed.into())
    }
}

/// What is written where nothing was.
#[derive(Debug)]
pub(crate) enum Written {
    /// A value.
    Value(toml_edit::Value),
    /// A table.
    Table(toml_edit::Table),
    /// One entry of a list of tables.
    Entry(toml_edit::Table),
}

/// What is written at a path where nothing was: the value of its example, or a table of the keys that it must have.
pub(crate) fn new_at(path: &str) -> Option<Written> {
    let (value, example) = find(path)?;
    let filled = |table: &Table| {
        let mut new = toml_edit::Table::new();
        let due =
            |key: &Key| key.silent == Silent::Refused || DUE.contains(&join(&word(path), key.name).as_str());
        for key in table.keys().filter(due) {
            if let Ok(value) = key.example.parse::<toml_edit::Value>() {
                new.insert(key.name, Item::Value(value));
            }
        }
        new
    };
    match value {
        Value::Table(table) => Some(Written::Table(filled(table))),
        Value::Tables(table) => Some(Written::Entry(filled(table))),
        _ => example.parse().ok().map(Written::Value),
    }
}

/// Keys that a new table begins with although it may be silent about them.
const DUE: [&str; 3] = ["environment.lighting", "atmosphere.model", "camera.preset"];

/// What may stand at a path, and its example.
fn find(path: &str) -> Option<(Value, &'static str)> {
    let mut table = root()?;
    let mut found = None;
    let mut names = path.split('.').map(|part| part.split('[').next().unwrap_or(part));
    while let Some(name) = names.next() {
        let key = table.key(name)?;
        found = Some((key.value, key.example));
        if let Some(inner) = key.value.table() {
            table = inner;
            if matches!(key.value, Value::Named(_)) && names.next().is_none() {
                return found;
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_told_from_their_units() {
        for (text, expected) in [
            ("10 ms", Some((10.0, "ms"))),
            ("-3.5e-1 degC", Some((-0.35, "degC"))),
            ("0.6", Some((0.6, ""))),
            ("12um", Some((12.0, "um"))),
            ("1e3m", Some((1000.0, "m"))),
            ("warm", None),
            ("", None),
            ("nan K", None),
        ] {
            assert_eq!(parts(text), expected, "{text}");
        }
    }

    #[test]
    fn a_slider_ends_where_values_are_refused() {
        let slider_at = |path: &str, text: &str| {
            let mut table = root().unwrap();
            let mut found = None;
            for name in path.split('.') {
                let key = table.key(name).unwrap();
                found = Some(key);
                table = key.value.table().unwrap_or(table);
            }
            slider(&found.unwrap(), text)
        };
        let ends = |path: &str, text: &str| slider_at(path, text).map(|slider| (slider.low, slider.high));
        assert_eq!(ends("camera.exposure", "10 ms"), Some((1.0, 100.0)));
        assert_eq!(ends("environment.lighting", "0.6"), Some((0.0, 1.0)));
        assert_eq!(ends("target.temperature", "33 degC"), Some((-7.0, 73.0)));
        let (low, high) = ends("camera.field_of_view", "50 deg").unwrap();
        assert!(low == 5.0 && high < 180.0 && high > 179.9, "{low} {high}");
        let (low, high) = ends("camera.f_number", "1.0").unwrap();
        assert!((low - 0.5).abs() < 1e-9 && high == 10.0, "{low} {high}");
        assert!(ends("target.temperature", "10 K").unwrap().0 > 0.0);
        assert_eq!(slider_at("camera.netd", "warm"), None);
    }

    #[test]
    fn every_key_of_a_scenario_has_something_to_begin_with_and_is_read_back() {
        let root = root().unwrap();
        let mut seen = 0;
        for section in root.keys() {
            let Some(table) = section.value.table() else { continue };
            let above = match section.value {
                Value::Named(_) => format!("{}.own", section.name),
                _ => section.name.to_owned(),
            };
            for key in table.keys() {
                let path = join(&above, key.name);
                if key.value.table().is_some() {
                    assert!(matches!(new_at(&path), Some(Written::Table(_))), "{path}");
                    continue;
                }
                let Some(Written::Value(value)) = new_at(&path) else { panic!("{path}") };
                let text = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
                let again = value_at(&path).parsed(&text);
                assert_eq!(again.to_string().trim(), value.to_string().trim(), "{path}");
                seen += 1;
            }
        }
        assert!(seen > 60, "{seen}");
    }
}
