//! A report or an answer as what can be compared: every value by the place where it stands.
//!
//! An item of a list goes by its name where it has one (`pairs[aluminium].distance_nearest`), a row of a table by the first columns that
//! tell rows apart; of curves there are tables, not values. An error that is stated beside a value goes with it.

use crate::bundle::CONDITIONS;
use crate::manifest::{Manifest, sha256};
use hadar::error::{Error, Result};
use hadar_formats::file;
use serde_json::{Map, Value};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// The longest file that is compared, bytes.
const LONGEST: u64 = 1 << 26;
const ACTION: &str = "read what is to be compared";
/// A list of more unnamed items than this is a curve.
const FEW: usize = 8;
/// Columns that may name a row.
const NAMING: usize = 4;
/// What an item of a list is called, the first that it has.
const NAMES: [&str; 9] =
    ["name", "alternative", "material", "scenario", "camera", "classifier", "code", "quantity", "label"];
/// Files of a report that say what others say, and what is compared on its own.
const DERIVED: [&str; 5] = ["svg", "png", "html", "parquet", "md"];
/// The question with its defaults, as a report has it.
const ASKED: [&str; 2] = ["scenario.toml", "rule.toml"];

/// A value.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Figure {
    pub(super) value: Value,
    /// By how much it may be wrong, in its own unit.
    pub(super) error: Option<f64>,
    /// The curve that it is of.
    pub(super) curve: Option<String>,
}

/// One of two things that are compared.
#[derive(Debug, Clone, Default)]
pub struct Side {
    pub(super) is_folder: bool,
    pub(super) made_by: Vec<String>,
    /// What answers of its kind consist of: keys of the JSON, tables of the folder.
    pub(super) parts: BTreeSet<String>,
    pub(super) verdict: String,
    /// What it decides: whether a requirement is met and whether subject to something, of a rule by every camera. `None` where an
    /// answer decides nothing, and of a folder, whose answer is text.
    pub(super) decided: Option<Vec<Value>>,
    pub(super) question: BTreeMap<String, String>,
    pub(super) inputs: BTreeMap<String, String>,
    pub(super) figures: BTreeMap<String, Figure>,
    pub(super) warnings: BTreeSet<[String; 2]>,
    /// What its 'yes' rests on: the camera, where there are several, and the code.
    pub(super) conditions: BTreeSet<[String; 2]>,
    /// Files that hold neither tables nor words, by their hashes.
    pub(super) files: BTreeMap<String, String>,
}

impl Side {
    /// What a folder that `--out` made holds, or a file that `--json` printed.
    ///
    /// # Errors
    /// What is neither; a file of a report that was changed since.
    pub fn read(path: &Path) -> Result<Self> {
        if path.is_dir() { Self::of_folder(path) } else { Self::of_json(path) }
    }

    fn of_folder(folder: &Path) -> Result<Self> {
        let unread = |error: std::io::Error| Error::file("read the report", folder, error.kind());
        let Some(manifest) = Manifest::in_folder(folder).map_err(unread)? else {
            let instead = "name a folder that --out made, or a file with what --json printed";
            return Err(Error::malformed("there is no report in this folder", instead).in_file(folder));
        };
        let provenance = &manifest.provenance;
        let mut side = Self { is_folder: true, ..Self::default() };
        side.made_by = vec![
            format!("hadar {}, commit {}", manifest.hadar, provenance.commit),
            format!("{}, seed {}", provenance.command_line(), provenance.seed),
        ];
        let names: BTreeSet<&str> = manifest.files.iter().map(|file| file.name.as_str()).collect();
        let is_asked = ASKED.iter().any(|asked| names.contains(asked));
        // The question is compared key by key, whatever its file is called.
        for input in provenance.inputs.iter().skip(usize::from(is_asked)) {
            side.inputs.insert(input.path.clone(), input.sha256.clone().unwrap_or_default());
        }
        for listed in &manifest.files {
            let (path, name) = (folder.join(&listed.name), listed.name.as_str());
            let end = Path::new(name).extension().and_then(|end| end.to_str()).unwrap_or_default();
            if DERIVED.contains(&end) {
                continue;
            }
            let compared = end == "csv" || name == "answer.txt" || ASKED.contains(&name);
            if !compared {
                side.files.insert(name.to_owned(), listed.sha256.clone());
                continue;
            }
            let bytes = file::bytes(&path, ACTION, LONGEST)?;
            if sha256(&bytes) != listed.sha256 {
                let found = "the file was changed since the report was written";
                return Err(Error::malformed(found, "make the report again").in_file(&path));
            }
            let text = String::from_utf8_lossy(&bytes);
            match name {
                CONDITIONS => side.rests_on(&text).map_err(|error| error.in_file(&path))?,
                _ if end == "csv" && name != "warnings.csv" => {
                    let drawn = names.contains(name.replace(".csv", ".png").as_str());
                    let table = table(&text, name, drawn).map_err(|error| error.in_file(&path))?;
                    side.figures.extend(table);
                    side.parts.insert(name.to_owned());
                }
                "answer.txt" => side.verdict = first_sentence(&text),
                "warnings.csv" => side.warned(&text).map_err(|error| error.in_file(&path))?,
                _ => {
                    let asked: Value = toml::from_str(&text).map_err(|error| {
                        Error::malformed(
                            format!("this is not TOML: {}", error.message()),
                            "make the report again",
                        )
                        .in_file(&path)
                    })?;
                    side.asked(&asked);
                }
            }
        }
        Ok(side)
    }

    fn of_json(path: &Path) -> Result<Self> {
        let bytes = file::bytes(path, ACTION, LONGEST)?;
        let instead = "name a folder that --out made, or a file with what --json printed";
        let told = |found: String| Error::malformed(found, instead).in_file(path);
        let answer: Map<String, Value> = serde_json::from_slice(&bytes)
            .map_err(|error| told(format!("this is no JSON of an answer: {error}")))?;
        let Some(version) = answer.get("hadar").and_then(Value::as_str) else {
            return Err(told("this is no answer: it has no `hadar`".into()));
        };
        let mut side = Self { made_by: vec![format!("hadar {version}")], ..Self::default() };
        let at = |pointer: &[&str]| {
            pointer.iter().try_fold(None, |found: Option<&Value>, key| {
                found.map_or_else(|| answer.get(*key), |value| value.get(key)).map(Some)
            })
        };
        side.verdict =
            match (at(&["verdict", "sentence"]), at(&["sentence"]), at(&["identifiability", "identifiable"]))
            {
                (Some(Some(Value::String(sentence))), ..) | (_, Some(Some(Value::String(sentence))), _) => {
                    sentence.clone()
                }
                (.., Some(Some(Value::Bool(yes)))) => (if *yes { "Yes" } else { "No" }).to_owned(),
                _ => String::new(),
            };
        side.decided = decided(&answer);
        side.conditions = conditions(&answer);
        for (key, value) in &answer {
            match key.as_str() {
                "hadar" | "schema" | "stats" | "set" | "sentence" => {}
                "scenario" | "rule" => side.asked(value),
                "warnings" | "library_warnings" => {
                    for warning in value.as_array().into_iter().flatten() {
                        let part = |key: &str| warning[key].as_str().unwrap_or_default().to_owned();
                        side.warnings.insert([part("code"), part("message")]);
                    }
                }
                "inputs" => {
                    for input in value.as_array().into_iter().flatten() {
                        let part = |key: &str| input[key].as_str().unwrap_or_default().to_owned();
                        side.inputs.insert(part("path"), part("sha256"));
                    }
                }
                _ => {
                    flatten(value, key, None, None, &mut side.figures);
                    side.parts.insert(key.clone());
                }
            }
        }
        side.figures.remove("verdict.sentence");
        Ok(side)
    }

    /// Whether two are answers of one kind: most parts of the one that has fewer are parts of both.
    pub(super) fn is_like(&self, other: &Self) -> bool {
        2 * self.parts.intersection(&other.parts).count() >= self.parts.len().min(other.parts.len())
    }

    fn asked(&mut self, question: &Value) {
        let mut keys = BTreeMap::new();
        flatten(question, "", None, None, &mut keys);
        self.question = keys.into_iter().map(|(key, figure)| (key, plain(&figure.value))).collect();
    }

    fn rests_on(&mut self, text: &str) -> Result<()> {
        for row in rows(text)?.1 {
            let cell = |at: usize| row.get(at).cloned().unwrap_or_default();
            if cell(3) == "true" {
                self.conditions.insert([cell(0), cell(1)]);
            }
        }
        Ok(())
    }

    fn warned(&mut self, text: &str) -> Result<()> {
        for row in rows(text)?.1 {
            let cell = |at: usize| row.get(at).cloned().unwrap_or_default();
            self.warnings.insert([cell(0), cell(1)]);
        }
        Ok(())
    }
}

/// What a 'yes' rests on, as the JSON of an answer has it.
fn conditions(answer: &Map<String, Value>) -> BTreeSet<[String; 2]> {
    let of = |camera: &str, all: Option<&Value>| -> Vec<[String; 2]> {
        let open =
            all.and_then(Value::as_array).into_iter().flatten().filter(|one| one["favourable"] == true);
        open.filter_map(|one| Some([camera.to_owned(), one["code"].as_str()?.to_owned()])).collect()
    };
    let own = [answer.get("verdict").and_then(|verdict| verdict.get("conditions")), answer.get("conditions")];
    let cameras = answer.get("cameras").and_then(Value::as_array).into_iter().flatten();
    let of_cameras =
        cameras.flat_map(|one| of(one["name"].as_str().unwrap_or_default(), one.get("conditions")));
    own.into_iter().flat_map(|all| of("", all)).chain(of_cameras).collect()
}

/// What an answer decides, as its JSON has it.
fn decided(answer: &Map<String, Value>) -> Option<Vec<Value>> {
    let of = |decision: &Value, conditions: Option<&Value>| {
        let all = conditions.and_then(Value::as_array).into_iter().flatten();
        let codes: Vec<Value> =
            all.filter(|one| one["favourable"] == true).map(|one| one["code"].clone()).collect();
        (!decision.is_null()).then(|| vec![decision.clone(), codes.into()])
    };
    let verdict = answer.get("verdict");
    if let Some(met) = verdict.and_then(|verdict| verdict.get("met")) {
        return of(met, verdict.and_then(|verdict| verdict.get("conditions")));
    }
    if let Some(yes) = answer.get("identifiability").and_then(|found| found.get("identifiable")) {
        return of(yes, None);
    }
    let cameras = answer.get("rule").and(answer.get("cameras"))?.as_array()?;
    let found: Option<Vec<Vec<Value>>> = cameras
        .iter()
        .map(|camera| {
            let mut found = of(camera.get("verdict")?, camera.get("conditions"))?;
            found.push(camera.get("name")?.clone());
            Some(found)
        })
        .collect();
    found.map(|found| found.concat())
}

/// Text without quotes, anything else as JSON has it.
pub(crate) fn plain(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

fn first_sentence(answer: &str) -> String {
    answer.trim().lines().next().unwrap_or_default().to_owned()
}

/// Every value below one, by its place; `error` is that of a number among its neighbours.
fn flatten(
    value: &Value,
    place: &str,
    error: Option<f64>,
    curve: Option<&str>,
    found: &mut BTreeMap<String, Figure>,
) {
    match value {
        Value::Object(object) => {
            for (key, value) in object {
                let place = if place.is_empty() { key.clone() } else { format!("{place}.{key}") };
                flatten(value, &place, stated(object, key, value), curve, found);
            }
        }
        Value::Array(items) => {
            let names = named(items);
            let is_curve = names.is_none() && items.len() > FEW;
            let curve = curve.or_else(|| is_curve.then_some(place));
            for (index, item) in items.iter().enumerate() {
                let name = names.as_ref().and_then(|names| names.get(index).cloned());
                let name = name.unwrap_or_else(|| index.to_string());
                flatten(item, &format!("{place}[{name}]"), None, curve, found);
            }
        }
        Value::Null => {}
        value => {
            let figure = Figure { value: value.clone(), error, curve: curve.map(str::to_owned) };
            found.insert(place.to_owned(), figure);
        }
    }
}

/// The names of the items of a list, where all have one of their own.
fn named(items: &[Value]) -> Option<Vec<String>> {
    let of = |key: &&str| -> Option<Vec<String>> {
        let names: Option<Vec<String>> =
            items.iter().map(|item| item.get(key)?.as_str().map(str::to_owned)).collect();
        names.filter(|names| names.iter().collect::<BTreeSet<_>>().len() == names.len())
    };
    NAMES.iter().find_map(of)
}

/// The error that stands beside a number: relative, of its own unit, or half an interval.
fn stated(beside: &Map<String, Value>, key: &str, value: &Value) -> Option<f64> {
    let number = value.as_f64()?;
    let reading =
        key.strip_prefix("distance_").map(|rest| rest.strip_suffix("_per_sqrt_photon").unwrap_or(rest));
    let of = |name: String| beside.get(&name).and_then(Value::as_f64);
    let relative = reading.and_then(|reading| {
        let plain = (reading == "local").then(|| of("relative_error".into())).flatten();
        of(format!("relative_error_{reading}")).or(plain)
    });
    let half = |name: String| {
        let ends = beside.get(&name)?.as_array()?;
        let [low, high] = ends.as_slice() else { return None };
        Some((high.as_f64()? - low.as_f64()?) / 2.0)
    };
    let own = of(format!("{key}_error")).or((key == "value").then(|| of("numerical_error".into())).flatten());
    relative.map(|share| share * number.abs()).or(own).or_else(|| half(format!("{key}_interval")))
}

fn rows(text: &str) -> Result<(Vec<String>, Vec<Vec<String>>)> {
    let failed =
        |error: csv::Error| Error::malformed(format!("this is no table: {error}"), "make the report again");
    let mut reader =
        csv::ReaderBuilder::new().comment(Some(b'#')).flexible(true).from_reader(text.as_bytes());
    let own = |record: &csv::StringRecord| record.iter().map(str::to_owned).collect::<Vec<_>>();
    let head = own(reader.headers().map_err(failed)?);
    let rows = reader.records().map(|row| row.map(|row| own(&row)).map_err(failed));
    Ok((head, rows.collect::<Result<_>>()?))
}

/// The cells of a table by row and column.
fn table(text: &str, name: &str, is_curve: bool) -> Result<BTreeMap<String, Figure>> {
    let (head, rows) = rows(text)?;
    let key =
        |row: &Vec<String>, columns: usize| row.iter().take(columns).cloned().collect::<Vec<_>>().join(" ");
    let tells = |columns: &usize| {
        rows.iter().map(|row| key(row, *columns)).collect::<BTreeSet<_>>().len() == rows.len()
    };
    // A pair goes by both of its materials, whichever others there are.
    let first = if head.first().is_some_and(|column| column == "target") { 2 } else { 1 };
    let columns = (first..=NAMING.min(head.len())).find(tells);
    let mut found = BTreeMap::new();
    for (index, row) in rows.iter().enumerate() {
        let cells: Map<String, Value> =
            head.iter().cloned().zip(row.iter().map(|cell| cell_of(cell))).collect();
        let row = columns.map_or_else(|| index.to_string(), |columns| key(row, columns));
        for (column, value) in &cells {
            if !value.is_null() {
                let figure = Figure {
                    value: value.clone(),
                    error: stated(&cells, column, value),
                    curve: is_curve.then(|| name.to_owned()),
                };
                found.insert(format!("{name}[{row}].{column}"), figure);
            }
        }
    }
    Ok(found)
}

fn cell_of(text: &str) -> Value {
    match text.parse::<f64>() {
        _ if text.is_empty() => Value::Null,
        Ok(number) if number.is_finite() => number.into(),
        _ => text.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn values_go_by_names_and_have_their_errors() {
        let pair = |name: &str| json!({ "alternative": name, "distance_nearest": 2.0, "relative_error_nearest": 1e-3, "none": null });
        let mut found = BTreeMap::new();
        flatten(&json!([pair("a"), pair("b")]), "pairs", None, None, &mut found);
        assert_eq!(found["pairs[b].distance_nearest"].error, Some(2e-3));
        assert!(!found.contains_key("pairs[b].none") && found["pairs[a].distance_nearest"].curve.is_none());
        let mut found = BTreeMap::new();
        flatten(
            &json!({ "p": 0.5, "p_interval": [0.4, 0.7], "curve": [1, 2, 3, 4, 5, 6, 7, 8, 9] }),
            "",
            None,
            None,
            &mut found,
        );
        assert!((found["p"].error.unwrap() - 0.15).abs() < 1e-12);
        assert_eq!(found["curve[8]"].curve.as_deref(), Some("curve"));
    }

    #[test]
    fn rows_go_by_the_first_columns_that_tell_them_apart() {
        let text = "target,alternative,d\nskin,pmma,1\nskin,gold,2\n";
        let found = table(text, "pairs.csv", false).unwrap();
        assert_eq!(found["pairs.csv[skin gold].d"].value, json!(2.0));
        let twice = table("a,b\n1,1\n1,1\n", "t.csv", true).unwrap();
        assert_eq!(twice["t.csv[1].b"].curve.as_deref(), Some("t.csv"));
    }
}
