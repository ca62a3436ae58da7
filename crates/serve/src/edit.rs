//! Fields changed in the text of a scenario: all else of it, comments included, stays as it was written.

use hadar::error::{Error, Result};
use hadar::instrument::figures::{self, Part, TABLE};
use hadar_scenario::{Scenario, StatedCamera, Written};
use hadar_study::with_noise_kept;
use serde::Deserialize;
use std::sync::Arc;
use toml_edit::{ArrayOfTables, DocumentMut, Item, Table, TableLike, Value};

use crate::place;

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

impl Edit {
    /// The path that it changes.
    fn key(&self) -> &str {
        match self {
            Self::Set { key, .. } | Self::Remove { key } | Self::Add { key } | Self::Table { key, .. } => key,
        }
    }
}

/// The text after the changes; it may name these cameras of the user's own.
pub(crate) fn applied(text: &str, edits: &[Edit], cameras: &Arc<[StatedCamera]>) -> Result<String> {
    if edits.is_empty() {
        return Ok(text.to_owned());
    }
    let mut document: DocumentMut = text.parse().map_err(|_| {
        Error::malformed("the text of the scenario is no TOML", "mend the text before the form is used")
    })?;
    for edit in edits {
        let before = edit.key().starts_with("camera.").then(|| document.to_string());
        apply(document.as_item_mut(), edit)?;
        if let Some(before) = before {
            keep_noise(&before, &mut document, cameras);
        }
    }
    Ok(document.to_string())
}

fn apply(root: &mut Item, edit: &Edit) -> Result<()> {
    match edit {
        Edit::Set { key, value } => {
            let (table, name) = table_of(root, key)?;
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
                (place::Written::Entry(entry), Some(Item::ArrayOfTables(tables))) => tables.push(entry),
                (place::Written::Entry(entry), Some(Item::Value(Value::Array(items)))) => {
                    items.push(entry.into_inline_table());
                }
                (_, Some(there)) if !there.is_none() => {
                    return Err(Error::malformed(format!("{key} is there already"), "change it"));
                }
                (place::Written::Entry(entry), _) => {
                    let mut tables = ArrayOfTables::new();
                    tables.push(entry);
                    drop(table.insert(&name, Item::ArrayOfTables(tables)));
                }
                (place::Written::Table(new), _) => drop(table.insert(&name, Item::Table(new))),
                (place::Written::Value(value), _) => put(table, &name, value),
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

/// Figures of a camera, and the keys that say for which value of them a noise is stated.
const CONDITIONS: [(&str, &str); 4] = [
    ("exposure", "noise_exposure"),
    ("f_number", "netd_f_number"),
    ("optics_efficiency", "netd_optics_efficiency"),
    ("pixel", "netd_pixel"),
];

/// Writes the noise down with all for which it is stated, where a change of the camera would make it another one: whoever turns a figure
/// turns a camera whose noise is known. `before` is the text without the change.
fn keep_noise(before: &str, document: &mut DocumentMut, cameras: &Arc<[StatedCamera]>) {
    let read = |text: &str| {
        Scenario::from_written(&Written::of(text, None).with_cameras(Arc::clone(cameras)).refusing_files())
            .ok()
    };
    let (Some(filed), Some(mut moved)) = (read(before), read(&document.to_string())) else { return };
    let (Some(filed), Some(spec)) = (filed.camera, moved.camera.take()) else { return };
    let kept = with_noise_kept(&spec, &filed);
    let text = Scenario { camera: Some(kept.clone()), ..moved }.to_toml();
    let (Ok(written), Ok(before)) = (text.parse::<DocumentMut>(), before.parse::<DocumentMut>()) else {
        return;
    };
    let value = |document: &DocumentMut, key: &str| document.get("camera")?.get(key)?.as_value().cloned();
    for row in TABLE.iter().filter(|row| row.part != Part::Own && row.is_given(&kept) && !row.is_given(&spec))
    {
        // As the figure itself was written, where it is that one.
        let figure =
            CONDITIONS.iter().find(|(_, condition)| *condition == row.key).map(|(figure, _)| *figure);
        let same = figure
            .filter(|figure| figures::row(figure).is_some_and(|own| own.number(&filed) == row.number(&kept)));
        let new = same.and_then(|figure| value(&before, figure)).or_else(|| value(&written, row.key));
        if let (Some(new), Some(table)) = (new, document.get_mut("camera").and_then(Item::as_table_like_mut))
        {
            put(table, row.key, new.decorated(" ", ""));
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

    fn applied(text: &str, edits: &[Edit]) -> Result<String> {
        super::applied(text, edits, &Arc::default())
    }

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
        // All of the noise is written down, as its figures were written, once.
        let kept = "netd_temperature = \"303.15 K\"\nnetd_f_number = 1.0\nnetd_optics_efficiency = 1.0\nnoise_exposure = \"10 ms\"\n";
        assert!(turned.contains("exposure = \"4 ms\"\n") && turned.ends_with(kept), "{turned}");
        let slower = applied(&turned, &[set("camera.f_number", "1.4"), set("camera.frames", "9")]).unwrap();
        assert!(slower.contains("\nf_number = 1.4\n") && slower.ends_with(kept), "{slower}");
        // What is turned is the noise itself: its conditions stay as they are.
        let louder = applied(&stated, &[set("camera.netd", "40 mK")]).unwrap();
        assert_eq!(louder, stated.replace("30 mK", "40 mK"));
        // A preset's noise is of the preset, unless the preset does not say for which lens.
        let preset = |name: &str| {
            TEXT.replace("exposure = \"10 ms\"", &format!("preset = \"{name}\"\nf_number = 1.4"))
        };
        let turned = |name: &str| applied(&preset(name), &[set("camera.f_number", "2.0")]).unwrap();
        assert_eq!(turned("flir-boson-640-14mm"), preset("flir-boson-640-14mm").replace("1.4", "2.0"));
        let open = turned("flir-tau-2-640");
        assert!(open.contains("netd = \"0.03 K\"\n") && open.contains("netd_f_number = 1.4\n"), "{open}");
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
