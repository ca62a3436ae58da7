//! What a row says: the numbers, texts and yeses of an answer by the names they have in its JSON.

use super::cell::Cell;
use serde_json::Value;
use std::collections::BTreeMap;

/// What an answer says of how it was asked and found, and not of the scene.
const LEFT_OUT: [&str; 3] = ["scenario", "stats", "warnings"];
/// Lists of what has a code: the codes of a list are a column.
pub(super) const CODED: [&str; 2] = ["warnings", "conditions"];

/// The values of a row by the names of their columns, such as `verdict.margin`.
pub type Record = BTreeMap<String, Cell>;

/// Whether a value is a part of an answer, or within it: `camera.frames` of `camera`, `pairs[0].proof` of `pairs`.
#[must_use]
pub fn is_within(name: &str, part: &str) -> bool {
    name.strip_prefix(part).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
}

/// Whether a record has a value of everything that is asked for.
pub(super) fn has_all(record: &Record, columns: &[String]) -> bool {
    columns.iter().all(|column| record.keys().any(|name| is_within(name, column)))
}

/// What is asked for of a record. Where it has none of a column it is left whole, so that a message can name those that are like it.
#[must_use]
pub fn asked_of(mut record: Record, columns: &[String]) -> Record {
    if !columns.is_empty() && has_all(&record, columns) {
        record.retain(|name, _| columns.iter().any(|column| is_within(name, column)));
    }
    record
}

/// The values of an answer. Of lists, which have tables of their own, only the `items` that are named are there
/// (`pairs[0].distance_nearest`, or `cameras[0]` for all of it), and what the scenario asks of safety; of warnings the codes.
pub(super) fn record(answer: &Value, items: &[String]) -> Record {
    let mut record = Record::new();
    if let Value::Object(map) = answer {
        for (key, value) in map.iter().filter(|(key, _)| !LEFT_OUT.contains(&key.as_str())) {
            flatten(key, value, &mut record);
        }
        codes("", map, &mut record);
        for (i, of_target) in map.get("safety").and_then(Value::as_array).into_iter().flatten().enumerate() {
            flatten(&format!("safety[{i}]"), of_target, &mut record);
        }
    }
    for item in items {
        if let Some(value) = at(answer, item) {
            flatten(item, value, &mut record);
        }
    }
    record
}

fn flatten(name: &str, value: &Value, record: &mut Record) {
    match value {
        Value::Object(map) => {
            for (key, value) in map.iter().filter(|(key, _)| !LEFT_OUT.contains(&key.as_str())) {
                flatten(&format!("{name}.{key}"), value, record);
            }
            codes(&format!("{name}."), map, record);
        }
        value => {
            if let Some(cell) = Cell::of_json(value) {
                record.insert(name.to_owned(), cell);
            }
        }
    }
}

/// The codes of the lists of a part of an answer.
fn codes(part: &str, map: &serde_json::Map<String, Value>, record: &mut Record) {
    for key in CODED {
        if let Some(Value::Array(all)) = map.get(key) {
            let mut codes: Vec<&str> = all.iter().filter_map(|one| one.get("code")?.as_str()).collect();
            codes.dedup();
            record.insert(format!("{part}{key}"), Cell::Text(codes.join(" ").into()));
        }
    }
}

/// What stands at a path such as `pairs[0].distance_nearest`.
fn at<'v>(mut value: &'v Value, path: &str) -> Option<&'v Value> {
    for part in path.split('.') {
        let (name, items) = part.split_at(part.find('[').unwrap_or(part.len()));
        value = value.get(name)?;
        for index in items.split_terminator(']') {
            value = value.get(index.strip_prefix('[')?.parse::<usize>().ok()?)?;
        }
    }
    Some(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn scalars_have_their_path_and_lists_are_left_to_those_who_name_an_item() {
        let answer = json!({
            "scenario": {"target": "x"}, "verdict": {"met": true, "margin": 1.5, "limit": null}, "n": 3,
            "pairs": [{"d": 0.25, "state": {"v": [0.5]}}], "warnings": [{"code": "a"}, {"code": "a"}, {"code": "b"}],
            "safety": [{"category": "person", "excluded": false, "materials": [{"excluded": true}]}],
        });
        let plain = record(&answer, &[]);
        let names: Vec<&str> = plain.keys().map(String::as_str).collect();
        assert_eq!(
            names,
            [
                "n",
                "safety[0].category",
                "safety[0].excluded",
                "verdict.limit",
                "verdict.margin",
                "verdict.met",
                "warnings"
            ]
        );
        assert_eq!(plain["n"], Cell::Integer(3));
        assert_eq!(plain["verdict.margin"], Cell::Number(1.5));
        assert_eq!(plain["warnings"], Cell::Text("a b".into()));
        let items = ["pairs[0].d", "pairs[0].state.v[0]", "pairs[1].d", "pairs[", "n[0]"].map(str::to_owned);
        let chosen = record(&answer, &items);
        assert_eq!(chosen["pairs[0].d"], Cell::Number(0.25));
        assert_eq!(chosen["pairs[0].state.v[0]"], Cell::Number(0.5));
        assert_eq!(chosen.len(), plain.len() + 2);
        assert_eq!(record(&answer, &["pairs[0]".to_owned()])["pairs[0].d"], Cell::Number(0.25));
    }
}
