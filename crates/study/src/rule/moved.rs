//! What hangs on each figure of a rule: every number moved by a tenth either way, alone, and the cameras held against the rule again.
//!
//! A quantity is multiplied by 0.9 and 1.1, a temperature moved by 3 K, of a probability what is missing to 1 multiplied. Figures are those that need
//! a source ([`Rule::figures`]), list by list and number by number; what is no number stays. Clauses that a figure is not in are not answered again.

use super::asked::{Extent, RuleAsked};
use super::reforms::BeforeLaw;
use super::{Line, RuleAnswer, RuleStudy};
use crate::condition::Condition;
use hadar::demand::Work;
use hadar::error::Result;
use hadar::material::Library;
use hadar_scenario::rule::{Figure, Verdict};
use hadar_scenario::{Rule, Setting, Written};

/// By how much a number is moved, and a temperature, K.
const SHARE: f64 = 0.1;
const KELVIN: f64 = 3.0;
/// Kelvins below which they are a difference.
const LEAST_KELVIN: f64 = 100.0;

/// Sensitivity of the verdicts to the figures of a rule.
#[derive(Debug, Clone, serde::Serialize)]
#[non_exhaustive]
pub struct FiguresMoved {
    /// What comes of every camera by the rule as it is.
    pub law: Vec<BeforeLaw>,
    /// Every number moved, those first that change most.
    pub figures: Vec<Moved>,
    /// What was computed and what was skipped, with the time.
    pub stats: Work,
}

/// One number moved.
#[derive(Debug, Clone, serde::Serialize)]
#[non_exhaustive]
pub struct Moved {
    /// The figure, with the place in its list.
    pub key: String,
    /// Value of the figure as the rule states it, with its unit.
    pub value: String,
    /// What stood in its place.
    pub moved_to: String,
    /// The largest change of a margin among all cameras and clauses, as a share of it; `None` where the rule then says nothing.
    pub largest_change: Option<f64>,
    /// Whether the verdict on a camera before a clause is another one, and which.
    pub verdicts: Vec<String>,
    /// Whether a test of the rule then fails; `None` of a rule without tests.
    pub breaks_a_test: Option<bool>,
    /// Why the rule then says nothing.
    pub refused: Option<String>,
}

impl FiguresMoved {
    /// Moves every figure of the rule of a file; `progress` is told how many of how many are done.
    ///
    /// # Errors
    /// As [`RuleStudy::answer`], of the rule as it is.
    pub fn of(
        written: &Written,
        library: &Library,
        skip_uncovered: bool,
        progress: &dyn Fn(usize, usize),
    ) -> Result<Self> {
        let mut law = Rule::from_written(written)?;
        law.skip_uncovered(skip_uncovered);
        let own = answer(&law, library)?;
        let mut stats = own.stats.clone();
        let jobs: Vec<(String, String, String)> = law.figures().iter().flat_map(moves).collect();
        let all = jobs.len();
        let mut figures = Vec::with_capacity(all);
        for (done, (key, value, moved_to)) in jobs.into_iter().enumerate() {
            let setting = Setting { key: key.clone(), value: moved_to.clone(), by: "the move" };
            let found = Rule::from_written(&written.clone().with([setting])).and_then(|mut rule| {
                rule.skip_uncovered(skip_uncovered);
                only_clause(&mut rule, &key);
                answer(&rule, library)
            });
            let mut moved = Moved {
                key,
                value,
                moved_to,
                largest_change: None,
                verdicts: Vec::new(),
                breaks_a_test: None,
                refused: None,
            };
            match found {
                Ok(found) => {
                    stats.add(&found.stats);
                    moved.compare(&own, &found);
                    moved.breaks_a_test =
                        (!law.tests.is_empty()).then(|| found.tested().iter().any(|test| !test.passes));
                }
                Err(error) => moved.refused = Some(error.to_string()),
            }
            figures.push(moved);
            progress(done + 1, all);
        }
        hadar::order::descending(&mut figures, |one| {
            one.largest_change.unwrap_or(0.0) + if one.verdicts.is_empty() { 0.0 } else { 1e6 }
        });
        Ok(Self { law: BeforeLaw::all(&own), figures, stats })
    }
}

fn answer(rule: &Rule, library: &Library) -> Result<RuleAnswer> {
    let asked = RuleAsked { extent: Extent::Margins, ..RuleAsked::default() };
    RuleStudy::new(rule, library)?.answer(&asked, &|_, _| ())
}

/// Leaves the clause alone that a key stands in, and the tests of it.
fn only_clause(rule: &mut Rule, key: &str) {
    let index = key.strip_prefix("clause[").and_then(|rest| rest.split_once(']')?.0.parse::<usize>().ok());
    let Some((index, clause)) = index.and_then(|index| Some((index, rule.clauses.get(index)?.clone())))
    else {
        return;
    };
    rule.tests.retain_mut(|test| test.clause.replace(0) == Some(index));
    rule.clauses = vec![clause];
}

impl Moved {
    /// What is another of the clauses that are in both answers.
    fn compare(&mut self, law: &RuleAnswer, moved: &RuleAnswer) {
        let mut largest = 0.0f64;
        for after in &moved.clauses {
            let Some(before) = law.clauses.iter().find(|clause| clause.name == after.name) else { continue };
            for (was, is) in before.lines().iter().zip(after.lines()) {
                let change = if was.margin == is.margin {
                    0.0
                } else {
                    (is.margin - was.margin).abs() / was.margin.max(is.margin)
                };
                largest = largest.max(change);
                // A yes under conditions is another than one without.
                let open = |line: &Line<'_>| {
                    Condition::open(line.conditions).any(|one| !matches!(one, Condition::Setting { .. }))
                };
                if (was.verdict, open(was)) != (is.verdict, open(&is)) {
                    let clause = after.name.as_ref().map_or_else(String::new, |name| format!(" ({name})"));
                    let said = |line: &Line<'_>| match (line.verdict, open(line)) {
                        (Verdict::Meets, true) => "meets, if",
                        (verdict, _) => verdict.name(),
                    };
                    self.verdicts.push(format!("{}{clause}: {} to {}", was.camera, said(was), said(&is)));
                }
            }
        }
        self.largest_change = Some(largest);
    }
}

/// The moves of every number in a figure: key, value, value moved, as TOML.
fn moves(figure: &Figure) -> Vec<(String, String, String)> {
    let Ok(value) = format!("x = {}", figure.value).parse::<toml::Table>() else { return Vec::new() };
    let mut out = Vec::new();
    for (key, value) in value.iter().flat_map(|(_, value)| numbers(&figure.key, value)) {
        for way in [-1.0, 1.0] {
            out.extend(moved(&key, &value, way).map(|to| (key.clone(), value.to_string(), to.to_string())));
        }
    }
    out
}

/// Every value that is no list, with its key.
fn numbers(key: &str, value: &toml::Value) -> Vec<(String, toml::Value)> {
    match value {
        toml::Value::Array(items) => {
            items.iter().enumerate().flat_map(|(i, item)| numbers(&format!("{key}[{i}]"), item)).collect()
        }
        toml::Value::Table(table) => {
            table.iter().flat_map(|(name, item)| numbers(&format!("{key}.{name}"), item)).collect()
        }
        other => vec![(key.to_owned(), other.clone())],
    }
}

/// A number moved; `None` of what is none, and of 0.
fn moved(key: &str, value: &toml::Value, way: f64) -> Option<toml::Value> {
    let factor = 1.0 + way * SHARE;
    let is_probability = key.ends_with("_probability");
    let scaled = |number: f64| match is_probability {
        true => short(1.0 - (1.0 - number) * factor),
        false => short(number * factor),
    };
    match value {
        toml::Value::Float(number) => Some(toml::Value::Float(scaled(*number))).filter(|_| *number != 0.0),
        toml::Value::Integer(number) => {
            let to = scaled(*number as f64);
            // A number of something stays whole.
            let whole = if to == to.round() { to } else { *number as f64 + way };
            Some(toml::Value::Integer(whole as i64)).filter(|_| *number > 0)
        }
        toml::Value::String(text) => {
            let text = text.trim();
            let digits = text
                .find(|char: char| !(char.is_ascii_digit() || "+-.eE".contains(char)))
                .unwrap_or(text.len());
            let (number, unit) = text.split_at(digits);
            let number: f64 = number.trim().parse().ok()?;
            let to = match unit.trim() {
                "degC" | "°C" => number + way * KELVIN,
                "K" if number > LEAST_KELVIN => number + way * KELVIN,
                "" => return None,
                _ => scaled(number),
            };
            // What is 0 and no temperature cannot be moved by a share of it.
            (to != number).then(|| toml::Value::String(format!("{to} {}", unit.trim())))
        }
        _ => None,
    }
}

/// A number without the digits that only rounding gave it.
fn short(number: f64) -> f64 {
    format!("{number:.12e}").parse().unwrap_or(number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_of_a_figure_is_moved_alone() {
        let of = |key: &str, value: &str| {
            let figure = Figure::new(key, value);
            moves(&figure).into_iter().map(|(key, _, to)| format!("{key} {to}")).collect::<Vec<_>>()
        };
        assert_eq!(of("stop.latency", "\"0.5 s\""), ["stop.latency \"0.45 s\"", "stop.latency \"0.55 s\""]);
        assert_eq!(
            of("envelope.temperature", "[\"20 degC\", \"37 degC\"]"),
            [
                "envelope.temperature[0] \"17 degC\"",
                "envelope.temperature[0] \"23 degC\"",
                "envelope.temperature[1] \"34 degC\"",
                "envelope.temperature[1] \"40 degC\""
            ]
        );
        let probability = of("requirement.detection_probability", "0.9");
        assert!(probability[0].starts_with("requirement.detection_probability 0.91"), "{probability:?}");
        assert!(of("alternatives.materials", "[\"aluminium\"]").is_empty());
        assert_eq!(
            of("clause[4].requirement.pixels", "6"),
            ["clause[4].requirement.pixels 5", "clause[4].requirement.pixels 7"]
        );
    }
}
