//! Fields changed in the text of a scenario: all else of it, comments included, stays as it was written.

use hadar::error::{Error, Result};
use serde::Deserialize;
use toml_edit::{ArrayOfTables, DocumentMut, Item, Table, TableLike, Value};

use crate::place::{self, Written};

/// A change. Paths are those of messages, such as `camera.exposure` and `environment[0].lighting`.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(tag = "do", rename_all = "lowercase", deny_unknown_fields)]
pub(crate) enum Edit {
    /// Puts a value at a key.
    Set {
        /// Its path.
        key: String,
        /// What is written; quotes of a text left out.
        value: String,
    },
    /// Takes a key, a table or an entry of a list away.
    Remove {
        /// Its path.
        key: String,
    },
    /// Adds a key with the value of its example, a table with those of the keys it must have, or one more entry of a list.
    Add {
        /// Its path, without a number for a new entry.
        key: String,
    },
    /// Puts a table in the place of another.
    Table {
        /// Its path.
        key: String,
        /// Its keys, as TOML.
        toml: String,
    },
}

/// A step of a path.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Step {
    Name(String),
    At(usize),
}

/// The text after the changes.
pub(crate) fn applied(text: &str, edits: &[Edit]) -> Result<String> {
    if edits.is_empty() {
        return Ok(text.to_owned());
    }
    let mut document: DocumentMut = text.parse().map_err(|_| {
        Error::malformed("the text of the scenario is no TOML", "mend the text before the form is used")
    })?;
    edits.iter().try_for_each(|edit| apply(document.as_item_mut(), edit))?;
    Ok(document.to_string())
}

fn apply(root: &mut Item, edit: &Edit) -> Result<()> {
    match edit {
        Edit::Set { key, value } => {
            let (table, name) = table_of(root, key)?;
            keep_conditions(table, key, &name);
            put(table, &name, place::value_at(key).parsed(value));
        }
        Edit::Remove { key } => match last(key)? {
            (above, Step::At(index)) => {
                let list = found(root, &above).ok_or_else(|| not_there(key))?;
                match list {
                    Item::ArrayOfTables(tables) if index < tables.len() => drop(tables.remove(index)),
                    Item::Value(Value::Array(items)) if index < items.len() => drop(items.remove(index)),
                    _ => return Err(not_there(key)),
                }
                let empty = match &*list {
                    Item::ArrayOfTables(tables) => tables.is_empty(),
                    Item::Value(Value::Array(items)) => items.is_empty(),
                    _ => false,
                };
                if empty {
                    *list = Item::None;
                }
            }
            (above, Step::Name(name)) => {
                let table = found(root, &above).and_then(Item::as_table_like_mut);
                table.and_then(|table| table.remove(&name)).ok_or_else(|| not_there(key))?;
            }
        },
        Edit::Add { key } => {
            let new = place::new_at(key).ok_or_else(|| not_there(key))?;
            let (table, name) = table_of(root, key)?;
            match (new, table.get_mut(&name)) {
                (Written::Entry(entry), Some(Item::ArrayOfTables(tables))) => tables.push(entry),
                (Written::Entry(entry), Some(Item::Value(Value::Array(items)))) => {
                    items.push(entry.into_inline_table());
                }
                (_, Some(there)) if !there.is_none() => {
                    return Err(Error::malformed(format!("{key} is there already"), "change it"));
                }
                (Written::Entry(entry), _) => {
                    let mut tables = ArrayOfTables::new();
                    tables.push(entry);
                    drop(table.insert(&name, Item::ArrayOfTables(tables)));
                }
                (Written::Table(new), _) => drop(table.insert(&name, Item::Table(new))),
                (Written::Value(value), _) => put(table, &name, value),
            }
        }
        Edit::Table { key, toml } => {
            let new: DocumentMut = toml.parse().map_err(|_| {
                Error::malformed(format!("what is to stand at {key} is no TOML"), "report this as a bug")
            })?;
            let (table, name) = table_of(root, key)?;
            let mut new: Table = new.as_table().clone();
            if let Some(Item::Table(old)) = table.get(&name) {
                *new.decor_mut() = old.decor().clone();
                new.set_position(old.position());
            }
            table.insert(&name, Item::Table(new));
        }
    }
    Ok(())
}

/// Figures of a camera, where what is stated of its noise says for which value of them, and the noises that take it.
const CONDITIONS: [(&str, &str, &[&str]); 3] = [
    ("exposure", "noise_exposure", &["netd", "detectivity", "nep", "nesr", "noise_electrons"]),
    ("f_number", "netd_f_number", &["netd"]),
    ("pixel", "netd_pixel", &["netd"]),
];

/// Writes down for which value of a figure the noise is stated, before that figure changes: whoever turns it turns a camera whose noise
/// is known, and states no other noise.
fn keep_conditions(table: &mut dyn TableLike, key: &str, name: &str) {
    let of_camera =
        CONDITIONS.iter().filter(|(figure, ..)| *figure == name && key == format!("camera.{name}"));
    for (_, condition, noises) in of_camera {
        let stated = noises.iter().any(|noise| table.contains_key(noise));
        let Some(value) = table.get(name).and_then(Item::as_value).cloned() else { continue };
        if stated && !table.contains_key(condition) {
            put(table, condition, value.decorated(" ", ""));
        }
    }
}

/// Puts a value at a key; what is written around it stays.
fn put(table: &mut dyn TableLike, name: &str, mut value: Value) {
    match table.get_mut(name).and_then(Item::as_value_mut) {
        Some(there) => {
            *value.decor_mut() = there.decor().clone();
            *there = value;
        }
        None => drop(table.insert(name, Item::Value(value))),
    }
}

/// The table that holds a key, and the key's own name.
fn table_of<'a>(root: &'a mut Item, key: &str) -> Result<(&'a mut dyn TableLike, String)> {
    let (above, Step::Name(name)) = last(key)? else { return Err(not_there(key)) };
    let table = found(root, &above).and_then(Item::as_table_like_mut);
    table.map(|table| (table, name)).ok_or_else(|| not_there(key))
}

fn found<'a>(root: &'a mut Item, path: &[Step]) -> Option<&'a mut Item> {
    path.iter().try_fold(root, |item, step| match step {
        Step::Name(name) => item.as_table_like_mut()?.get_mut(name),
        Step::At(index) => item.get_mut(*index),
    })
}

/// A path without its last step, and that.
fn last(key: &str) -> Result<(Vec<Step>, Step)> {
    let mut steps = Vec::new();
    for part in key.split('.') {
        let (name, mut rest) = part.split_at(part.find('[').unwrap_or(part.len()));
        if name.is_empty() || name.contains(|char: char| char.is_whitespace() || char.is_control()) {
            return Err(not_there(key));
        }
        steps.push(Step::Name(name.to_owned()));
        while let Some((index, after)) = rest.strip_prefix('[').and_then(|rest| rest.split_once(']')) {
            steps.push(Step::At(index.parse().map_err(|_| not_there(key))?));
            rest = after;
        }
        if !rest.is_empty() {
            return Err(not_there(key));
        }
    }
    let end = steps.pop().ok_or_else(|| not_there(key))?;
    Ok((steps, end))
}

fn not_there(key: &str) -> Error {
    Error::malformed(format!("there is no `{key}` in the scenario"), "name a key that is written in it")
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "# why\n[target] # it\nmaterial = \"skin\"   # of a person\ntemperature = \"33 degC\"\n\n\
        [[environment]]\ntemperature = \"5 degC\"\nlighting = 0.6\n\n# ours\n[camera]\nexposure = \"10 ms\"\nframes = 4\n";

    fn set(key: &str, value: &str) -> Edit {
        Edit::Set { key: key.into(), value: value.into() }
    }

    #[test]
    fn a_value_changes_and_nothing_around_it() {
        let text =
            applied(TEXT, &[set("target.material", "pmma"), set("environment[0].lighting", "0.25")]).unwrap();
        let expected = TEXT.replace("\"skin\"", "\"pmma\"").replace("0.6", "0.25");
        assert_eq!(text, expected);
        // A text that looks like a number stays one, and the other way round.
        assert!(applied(TEXT, &[set("camera.exposure", "3")]).unwrap().contains("exposure = \"3\"\n"));
        assert!(applied(TEXT, &[set("camera.frames", "8")]).unwrap().contains("frames = 8\n"));
        let new = applied(TEXT, &[set("target.distance", "30 m")]).unwrap();
        assert_eq!(new, TEXT.replace("33 degC\"\n", "33 degC\"\ndistance = \"30 m\"\n"));
    }

    #[test]
    fn whoever_turns_a_figure_states_no_other_noise() {
        let stated = TEXT.to_owned() + "netd = \"30 mK\"\nf_number = 1.0\n";
        let turned =
            applied(&stated, &[set("camera.exposure", "3 ms"), set("camera.exposure", "4 ms")]).unwrap();
        assert!(
            turned.contains("exposure = \"4 ms\"\n") && turned.ends_with("noise_exposure = \"10 ms\"\n"),
            "{turned}"
        );
        let turned = applied(&turned, &[set("camera.f_number", "1.4"), set("camera.frames", "9")]).unwrap();
        assert!(turned.ends_with("noise_exposure = \"10 ms\"\nnetd_f_number = 1.0\n"), "{turned}");
        // A camera without a noise of its own, or one that says it, has nothing to be kept.
        assert!(!applied(TEXT, &[set("camera.exposure", "3 ms")]).unwrap().contains("noise_exposure"));
    }

    #[test]
    fn keys_and_entries_come_and_go() {
        let removed = applied(TEXT, &[Edit::Remove { key: "environment[0]".into() }]).unwrap();
        assert!(!removed.contains("environment") && removed.contains("# ours"), "{removed}");
        let added = applied(TEXT, &[Edit::Add { key: "environment".into() }]).unwrap();
        assert_eq!(added.matches("[[environment]]").count(), 2, "{added}");
        let added = applied(&removed, &[Edit::Add { key: "environment".into() }]).unwrap();
        assert_eq!(added.matches("[[environment]]\ntemperature = ").count(), 1, "{added}");
        let table = applied(TEXT, &[Edit::Add { key: "background".into() }]).unwrap();
        assert!(table.contains("[background]\ntemperature = "), "{table}");
        let preset = Edit::Table { key: "camera".into(), toml: "preset = \"flir-a325sc\"".into() };
        let text = applied(TEXT, &[preset]).unwrap();
        assert!(text.ends_with("# ours\n[camera]\npreset = \"flir-a325sc\"\n"), "{text}");
    }

    #[test]
    fn inline_tables_and_lists_are_changed_where_they_stand() {
        let inline =
            "environment = [{ temperature = \"5 degC\", lighting = 0.6 }]\ncamera = { frames = 4 }\n";
        let text =
            applied(inline, &[set("environment[0].lighting", "0.1"), set("camera.frames", "5")]).unwrap();
        assert_eq!(text, inline.replace("0.6", "0.1").replace('4', "5"));
        let two = applied(inline, &[Edit::Add { key: "environment".into() }]).unwrap();
        assert_eq!(two.matches("temperature").count(), 2, "{two}");
    }

    #[test]
    fn what_is_not_there_is_refused() {
        for key in
            ["nothing.at", "environment[1].lighting", "target[0]", "", "a..b", "target.", "x[", "x[a]", "x]"]
        {
            assert!(applied(TEXT, &[set(key, "1")]).is_err() || key == "x]", "{key}");
            assert!(applied(TEXT, &[Edit::Remove { key: key.into() }]).is_err(), "{key}");
            assert!(applied(TEXT, &[Edit::Add { key: key.into() }]).is_err(), "{key}");
        }
        assert!(applied("[", &[set("a", "1")]).is_err());
        // What is written there is data: it opens no table.
        let sly = applied(TEXT, &[set("title", "x\"\n[camera]\nframes = 9")]).unwrap();
        assert_eq!(sly.matches("\n[camera]").count(), 1 + 1, "{sly}");
        assert_eq!(sly.parse::<DocumentMut>().unwrap()["camera"]["frames"].as_integer(), Some(4));
    }
}
