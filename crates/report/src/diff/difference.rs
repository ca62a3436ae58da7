//! What differs between two reports.
//!
//! Of a figure that moved, Δ = new − old is within its error where |Δ| ≤ u_old + u_new, u as stated beside it. What made the reports
//! (version, commit, command) is told and is no difference.

use super::side::{Figure, Side, plain};
use hadar::error::{Error, Result};
use hadar::order;
use serde::Serialize;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

/// Something that is written down and is another one, or on one side alone.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Changed {
    /// Key of what differs, or its path.
    pub key: String,
    /// As the first has it.
    pub before: Option<String>,
    /// As the second has it.
    pub after: Option<String>,
}

/// A figure that moved, or words of an answer that are others.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Moved {
    /// Path of the figure within the answer.
    pub figure: String,
    /// As the first has it.
    pub before: Option<Value>,
    /// As the second has it.
    pub after: Option<Value>,
    /// Change over the first; none of words, and from 0.
    pub relative_change: Option<f64>,
    /// Both stated errors together, in the unit of the figure; none where one is not stated.
    pub error: Option<f64>,
    /// Whether it moved no more than that.
    pub within_error: Option<bool>,
}

/// A curve, some of whose values moved.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Curve {
    /// Table or list that holds the curve.
    pub curve: String,
    /// How many values it has.
    pub values: usize,
    /// How many of them moved, or are on one side alone.
    pub moved: usize,
    /// Largest relative change of a value of the curve.
    pub largest_relative_change: Option<f64>,
}

/// A warning.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Warned {
    /// Code of the warning that differs.
    pub code: String,
    /// Text of the warning that differs.
    pub message: String,
}

/// All that differs.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Difference {
    /// Whether the two answers are the same.
    pub same: bool,
    /// Differences of the programs that made the two.
    pub made_by: [Vec<String>; 2],
    /// The verdicts, where they are others.
    pub verdict: Option<Changed>,
    /// Whether a 'Yes' is a 'No' or the other way; where nothing is decided, and of the text of a folder, whether the words are
    /// others.
    pub verdict_changed: bool,
    /// What the second's 'yes' rests on and the first's does not, by code and, of several, camera.
    pub conditions_came: Vec<String>,
    /// What the first's does and the second's does not.
    pub conditions_went: Vec<String>,
    /// Differences of the questions, key by key.
    pub question: Vec<Changed>,
    /// Files that were read, by their SHA-256.
    pub inputs: Vec<Changed>,
    /// How many figures were compared.
    pub compared: usize,
    /// Figures, the largest change first, words behind them.
    pub figures: Vec<Moved>,
    /// Curves of which some values moved.
    pub curves: Vec<Curve>,
    /// Warnings that the second has.
    pub warnings_came: Vec<Warned>,
    /// Warnings that the first has.
    pub warnings_went: Vec<Warned>,
    /// Codes of warnings that both have and that say something else.
    pub warnings_changed: Vec<String>,
    /// Other files, by their SHA-256.
    pub files: Vec<Changed>,
}

impl Difference {
    /// What differs between two sides.
    ///
    /// # Errors
    /// A folder and a JSON, which have their figures under other names; answers of two kinds.
    pub fn between(before: &Side, after: &Side) -> Result<Self> {
        if before.is_folder != after.is_folder {
            let found = "one is the folder of a report, the other an answer as JSON";
            return Err(Error::malformed(found, "name two folders or two files"));
        }
        if !before.is_like(after) {
            let found = "these are answers to different questions, with hardly a figure in common";
            return Err(Error::malformed(found, "name two answers of one command"));
        }
        let (figures, curves) = figures(before, after);
        let mut found = Self {
            made_by: [before.made_by.clone(), after.made_by.clone()],
            verdict: (before.verdict != after.verdict).then(|| Changed {
                key: "verdict".into(),
                before: Some(before.verdict.clone()),
                after: Some(after.verdict.clone()),
            }),
            verdict_changed: match (&before.decided, &after.decided) {
                (Some(before), Some(after)) => before != after,
                _ => word(&before.verdict) != word(&after.verdict),
            },
            question: changed(&before.question, &after.question),
            inputs: changed(&before.inputs, &after.inputs),
            compared: before.figures.keys().chain(after.figures.keys()).collect::<BTreeSet<_>>().len(),
            figures,
            curves,
            conditions_came: more(&after.conditions, &before.conditions),
            conditions_went: more(&before.conditions, &after.conditions),
            warnings_came: others(after, before),
            warnings_went: others(before, after),
            files: changed(&before.files, &after.files),
            ..Self::default()
        };
        found.warnings_changed = reworded(before, after);
        found.same = found.verdict.is_none()
            && before.conditions == after.conditions
            && found.question.is_empty()
            && found.inputs.is_empty()
            && found.figures.is_empty()
            && found.curves.is_empty()
            && before.warnings == after.warnings
            && found.files.is_empty();
        Ok(found)
    }
}

/// Conditions that one has more than another.
fn more(own: &BTreeSet<[String; 2]>, other: &BTreeSet<[String; 2]>) -> Vec<String> {
    let said = |[camera, code]: &[String; 2]| match camera.as_str() {
        "" => format!("[{code}]"),
        camera => format!("[{code}] {camera}"),
    };
    own.difference(other).map(said).collect()
}

/// The Yes or No of the text of a folder, or the sentence itself.
fn word(sentence: &str) -> &str {
    let first = sentence.split([':', '.']).next().unwrap_or_default();
    if ["Yes", "No"].contains(&first) { first } else { sentence }
}

fn changed(before: &BTreeMap<String, String>, after: &BTreeMap<String, String>) -> Vec<Changed> {
    let keys: BTreeSet<&String> = before.keys().chain(after.keys()).collect();
    let one = |key: &String| Changed {
        key: key.clone(),
        before: before.get(key).cloned(),
        after: after.get(key).cloned(),
    };
    keys.into_iter().filter(|key| before.get(*key) != after.get(*key)).map(one).collect()
}

fn codes(side: &Side) -> BTreeSet<&str> {
    side.warnings.iter().map(|[code, _]| code.as_str()).collect()
}

/// Warnings whose code the other does not have.
fn others(of: &Side, than: &Side) -> Vec<Warned> {
    let known = codes(than);
    let missing = of.warnings.iter().filter(|[code, _]| !known.contains(code.as_str()));
    missing.map(|[code, message]| Warned { code: code.clone(), message: message.clone() }).collect()
}

fn reworded(before: &Side, after: &Side) -> Vec<String> {
    let of = |side: &Side, code: &str| -> Vec<[String; 2]> {
        side.warnings.iter().filter(|[own, _]| own == code).cloned().collect()
    };
    let known = codes(after);
    let both = codes(before).into_iter().filter(|code| known.contains(code));
    both.filter(|code| of(before, code) != of(after, code)).map(str::to_owned).collect()
}

fn figures(before: &Side, after: &Side) -> (Vec<Moved>, Vec<Curve>) {
    let keys: BTreeSet<&String> = before.figures.keys().chain(after.figures.keys()).collect();
    let (mut moved, mut curves) = (Vec::new(), BTreeMap::<String, Curve>::new());
    for key in keys {
        let pair = (before.figures.get(key), after.figures.get(key));
        let of_curve = pair.0.or(pair.1).and_then(|figure| figure.curve.clone());
        let one = step(key, pair);
        let Some(curve) = of_curve else {
            moved.extend(one);
            continue;
        };
        let entry = curves.entry(curve.clone()).or_insert(Curve {
            curve,
            values: 0,
            moved: 0,
            largest_relative_change: None,
        });
        entry.values += 1;
        if let Some(one) = one {
            entry.moved += 1;
            let largest = entry.largest_relative_change.unwrap_or(0.0);
            if one.relative_change.is_some_and(|change| change.abs() > largest.abs()) {
                entry.largest_relative_change = one.relative_change;
            }
        }
    }
    let size = |one: &Moved| one.relative_change.map_or(-1.0, f64::abs);
    order::descending(&mut moved, size);
    (moved, curves.into_values().filter(|curve| curve.moved > 0).collect())
}

/// What became of a figure; none where it stayed.
fn step(key: &str, (before, after): (Option<&Figure>, Option<&Figure>)) -> Option<Moved> {
    let value = |figure: Option<&Figure>| figure.map(|figure| figure.value.clone());
    let (old, new) = (value(before), value(after));
    let numbers = old.as_ref().and_then(Value::as_f64).zip(new.as_ref().and_then(Value::as_f64));
    let same = match numbers {
        Some((old, new)) => old == new,
        None => old.as_ref().map(plain) == new.as_ref().map(plain),
    };
    if same {
        return None;
    }
    let error = before.and_then(|figure| figure.error).zip(after.and_then(|figure| figure.error));
    let error = error.map(|(old, new)| old + new);
    Some(Moved {
        figure: key.to_owned(),
        relative_change: numbers.filter(|(old, _)| *old != 0.0).map(|(old, new)| (new - old) / old.abs()),
        within_error: numbers.zip(error).map(|((old, new), error)| (new - old).abs() <= error),
        before: old,
        after: new,
        error,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn side(figures: &[(&str, f64, Option<f64>)], verdict: &str) -> Side {
        let one = |(key, value, error): &(&str, f64, Option<f64>)| {
            ((*key).to_owned(), Figure { value: (*value).into(), error: *error, curve: None })
        };
        Side { figures: figures.iter().map(one).collect(), verdict: verdict.into(), ..Side::default() }
    }

    #[test]
    fn a_figure_moves_within_its_error_or_beyond() {
        let before = side(
            &[("a", 1.0, Some(0.01)), ("b", 2.0, Some(0.01)), ("c", 0.0, None), ("d", 5.0, None)],
            "No: x",
        );
        let after = side(
            &[("a", 1.015, Some(0.01)), ("b", 2.1, Some(0.01)), ("c", 1.0, None), ("d", 5.0, None)],
            "No: y",
        );
        let found = Difference::between(&before, &after).unwrap();
        let of = |name: &str| found.figures.iter().find(|moved| moved.figure == name).unwrap();
        assert_eq!(
            (of("a").within_error, of("b").within_error, of("c").within_error),
            (Some(true), Some(false), None)
        );
        assert!((of("b").relative_change.unwrap() - 0.05).abs() < 1e-12 && of("c").relative_change.is_none());
        assert_eq!((found.figures.len(), found.figures[0].figure.as_str()), (3, "b"));
        assert!(!found.same && !found.verdict_changed && found.verdict.is_some());
        assert!(Difference::between(&before, &before).unwrap().same);
        assert!(Difference::between(&before, &side(&[], "Yes: x")).unwrap().verdict_changed);
    }
}
