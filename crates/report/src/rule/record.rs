//! The certificate as data: what was checked, line by line, with the evidence and the hashes of all that it rests on; the same as
//! an in-toto statement, for the tools with which people sign; and whether one that was made before says what is found now.
//!
//! `certificate.json` has the form of `schemas/certificate.schema.json`. `certificate.intoto.json` is an unsigned Statement (v1) about it
//! and all other files of the report, with the predicate `test-result/v0.1`: a line that meets its clause, proved and unconditionally, on a stated day on
//! which the rule as it is written holds, is a passed test, one that fails a failed one, and all else a warned one ([`RuleAnswer::outcome`]). Beside the keys
//! of that predicate: `reasons`, `on`, `policy` (rule and settings in one digest), `evidence`, `conditions`, `accepted`, `verifier`, `command`, `seed`.
//!
//! Source: in-toto attestation framework, Statement v1 and predicate `test-result` v0.1 (github.com/in-toto/attestation).

use crate::json;
use crate::manifest::{Input, Provenance, SCHEMA, VERSION, sha256};
use crate::words::Say;
use crate::words::rule::{measure, together};
use hadar::error::{Error, Result};
use hadar::inputs::called;
use hadar_scenario::rule::Verdict;
use hadar_study::{
    CameraBeforeClause, ClauseAnswer, Condition, Found, Line, NotPassed, RuleAnswer, RuleStudy,
};
use serde_json::{Value, json};

/// Its name in a report.
pub(super) const NAME: &str = "certificate.json";
/// The name of the statement.
pub(crate) const STATEMENT: &str = "certificate.intoto.json";
const NAMED: &str = "name the certificate.json of a report by hadar rule";
/// Share by which numbers of two runs may differ: nothing is random in them but rounding of another build.
const SAME: f64 = 1e-6;

/// The certificate.
///
/// # Errors
/// Data that is no JSON, which is a bug.
pub fn record(study: &RuleStudy, answer: &RuleAnswer, provenance: &Provenance) -> Result<Value> {
    let about = &answer.rule.about;
    let day = |day: Option<hadar_scenario::Date>| day.map(|day| day.to_string());
    let file = provenance.inputs.first().map(|input| input.path.clone());
    let path = study.rule().scenario.source.path.as_deref().map(|path| called(path.parent(), path));
    let clauses = answer.clauses.iter().map(of_clause).collect::<Result<Vec<_>>>()?;
    let cameras = answer.cameras.iter().map(|camera| {
        json!({
            "name": camera.name,
            "verdict": camera.verdict.name(),
            "margin": camera.margin,
            "interval": camera.interval,
            "limiting_clause": camera.limiting_clause,
            "evidence": camera.grade.name(),
            "conditions": json::value(&camera.conditions).unwrap_or_default(),
        })
    });
    let set = &study.rule().scenario.source.settings;
    let (outcome, reasons) = answer.outcome();
    let mut record = json!({
        "hadar": VERSION,
        "schema": SCHEMA,
        "on": answer.on.map(|day| day.to_string()),
        "accepted": answer.accepted,
        "rule": {
            "file": file,
            "path": path,
            "name": about.name,
            "text": about.text,
            "authority": about.authority,
            "version": about.version,
            "status": about.status,
            "from": day(about.from),
            "until": day(about.until),
        },
        "sources": json::value(&answer.rule.sources)?,
        "sentence": answer.sentence.say(),
        "result": outcome,
        "reasons": reasons,
        "cameras": cameras.collect::<Vec<_>>(),
        "clauses": clauses,
        "warnings": json::value(&together(answer))?,
        "inputs": json::value(&provenance.inputs)?,
    });
    if let Some(rule) = record.get_mut("rule").and_then(Value::as_object_mut).filter(|_| !set.is_empty()) {
        rule.insert("set".into(), json::value(set)?);
    }
    Ok(record)
}

fn of_clause(clause: &ClauseAnswer) -> Result<Value> {
    let (quantity, demanded) = match &clause.found {
        Found::Apart(apart) => ("statistical_distance", apart.requirement.distance),
        Found::Measured(measured) => (measure(measured.quantity), measured.demanded),
    };
    let lines = clause.lines().into_iter().enumerate().map(|(index, line)| of_line(clause, index, &line));
    Ok(json!({
        "name": clause.name,
        "kind": clause.kind,
        "text": clause.text,
        "stop": json::value(&clause.stop)?,
        "quantity": quantity,
        "demanded": demanded,
        "lines": lines.collect::<Result<Vec<_>>>()?,
    }))
}

fn of_line(clause: &ClauseAnswer, index: usize, line: &Line<'_>) -> Result<Value> {
    // The scene in which it is nearest to failing is the one to drive.
    let (reached, proved, scene) = match &clause.found {
        Found::Apart(apart) => {
            let own = apart.cameras.get(index);
            (
                own.map(|own| own.statistical_distance),
                own.and_then(|own| own.lower_bound).map(|bound| bound / apart.requirement.distance),
                own.map_or(Ok(Value::Null), |own| json::value(&own.limiting))?,
            )
        }
        Found::Measured(measured) => {
            let own = measured.cameras.get(index);
            (
                own.and_then(|own| own.value),
                None,
                own.map_or(Ok(Value::Null), |own| json::value(&own.limiting))?,
            )
        }
    };
    Ok(json!({
        "camera": line.camera,
        "verdict": line.verdict.name(),
        "fails_by": json::value(&line.fails_by)?,
        "undecided_by": json::value(&line.undecided_by)?,
        "reached": reached,
        "margin": line.margin,
        "margin_proved": proved,
        "uncertainty": json::value(&line.uncertainty)?,
        "evidence": line.grade.name(),
        "conditions": json::value(&line.conditions)?,
        "limiting_scene": scene,
    }))
}

/// A record as it is written.
pub(super) fn text(record: &Value) -> Result<String> {
    Ok(json::pretty(record)? + "\n")
}

/// The statement about a report, whose files are its subjects.
pub(super) fn statement(answer: &RuleAnswer, provenance: &Provenance) -> Value {
    let of = |wanted: &dyn Fn(&ClauseAnswer, &Line<'_>) -> bool| -> Vec<String> {
        let name = |clause: &ClauseAnswer, line: &Line<'_>| match &clause.name {
            Some(clause) => format!("{}: {clause}", line.camera),
            None => line.camera.to_owned(),
        };
        let clauses = answer.clauses.iter();
        clauses
            .flat_map(|clause| {
                let lines = clause.lines();
                let wanted = lines.iter().filter(|line| wanted(clause, line));
                wanted.map(|line| name(clause, line)).collect::<Vec<_>>()
            })
            .collect()
    };
    let rests_on = answer.cameras.iter().map(|camera| {
        let open: Vec<String> = Condition::open(&camera.conditions).map(Condition::code).collect();
        (camera.name.clone(), json!(open))
    });
    let grades = answer.cameras.iter().map(|camera| (camera.name.clone(), json!(camera.grade.name())));
    let (outcome, reasons) = answer.outcome();
    let is_of = |reason: &NotPassed, clause: &ClauseAnswer, line: &Line<'_>| {
        let of = |place: &CameraBeforeClause| place.camera == line.camera && place.clause == clause.name;
        reason.place().is_none_or(of)
    };
    let warned = |clause: &ClauseAnswer, line: &Line<'_>| {
        line.verdict != Verdict::Fails && reasons.iter().any(|reason| is_of(reason, clause, line))
    };
    let resource = |input: &Input| match &input.sha256 {
        Some(hash) => json!({ "name": input.path, "digest": { "sha256": hash } }),
        None => json!({ "name": input.path }),
    };
    json!({
        "_type": "https://in-toto.io/Statement/v1",
        "subject": [],
        "predicateType": "https://in-toto.io/attestation/test-result/v0.1",
        "predicate": {
            "result": outcome.word(),
            "reasons": reasons,
            "on": answer.on.map(|day| day.to_string()),
            "policy": policy(answer, provenance),
            "configuration": provenance.inputs.iter().map(resource).collect::<Vec<_>>(),
            "passedTests": of(&|clause, line| line.verdict == Verdict::Meets && !warned(clause, line)),
            "warnedTests": of(&warned),
            "failedTests": of(&|_, line| line.verdict == Verdict::Fails),
            "conditions": rests_on.collect::<serde_json::Map<_, _>>(),
            "evidence": grades.collect::<serde_json::Map<_, _>>(),
            "accepted": answer.accepted,
            "verifier": { "id": "hadar", "version": VERSION, "commit": provenance.commit },
            "command": provenance.command,
            "seed": provenance.seed,
        },
    })
}

/// The rule and all that changes what it says in one digest: that of the file itself where nothing does.
fn policy(answer: &RuleAnswer, provenance: &Provenance) -> Value {
    let Some(rule) = provenance.inputs.first() else { return Value::Null };
    let settings = &answer.rule.scenario.source.settings;
    let mut lines = vec![rule.sha256.clone().unwrap_or_default()];
    lines.extend(settings.iter().map(|set| format!("set {}={}", set.key, set.value)));
    lines.extend(answer.accepted.iter().map(|code| format!("accept {code}")));
    let digest = if lines.len() == 1 { lines.remove(0) } else { sha256(lines.join("\n").as_bytes()) };
    json!({ "uri": rule.path, "digest": { "sha256": digest }, "set": settings, "accept": answer.accepted })
}

/// Whether a certificate says what is found now; the largest difference of two numbers, as a share of them.
///
/// # Errors
/// The first thing that is another one, with its place: an input, a verdict, a number by more than a millionth.
pub fn agreement(certificate: &Value, now: &Value) -> Result<f64> {
    let inputs = |record: &Value| -> Vec<Input> {
        record
            .get("inputs")
            .and_then(|inputs| serde_json::from_value(inputs.clone()).ok())
            .unwrap_or_default()
    };
    let (before, read) = (inputs(certificate), inputs(now));
    let another = |found: String| {
        Err(Error::malformed(found, "take what it was made with, or make the certificate again"))
    };
    if let Some(input) = before.iter().find(|input| !read.contains(input)) {
        return another(match read.iter().find(|other| other.path == input.path) {
            Some(_) => format!("{} is another one than the certificate's", input.path),
            None => format!("{}, which the certificate rests on, is not read now", input.path),
        });
    }
    if let Some(input) = read.iter().find(|input| !before.contains(input)) {
        return another(format!("{} is read now, of which the certificate says nothing", input.path));
    }
    let mut largest = 0.0;
    compare(certificate, now, "", &mut largest)?;
    Ok(largest)
}

/// A certificate in a text that is as this program writes it: nothing twice, nothing in another form.
///
/// # Errors
/// A text that is no JSON, or is in another form.
pub fn parsed(text: &str) -> Result<Value> {
    let value: Value = serde_json::from_str(text)
        .map_err(|error| Error::malformed(format!("this is not JSON: {error}"), NAMED))?;
    if self::text(&value)? != text {
        let found = "this was written or changed by another program: its form is not that of a certificate";
        return Err(Error::malformed(found, NAMED));
    }
    Ok(value)
}

fn compare(a: &Value, b: &Value, place: &str, largest: &mut f64) -> Result<()> {
    let differs = || {
        let place = if place.is_empty() { "the certificate" } else { place };
        let found = format!("{place}: the certificate says {}, found now is {}", short(a), short(b));
        Err(Error::malformed(found, "the certificate was changed, or made by another program"))
    };
    match (a, b) {
        (Value::Object(a), Value::Object(b)) => {
            let keys = a.keys().chain(b.keys());
            for key in keys {
                let place = if place.is_empty() { key.clone() } else { format!("{place}.{key}") };
                let of =
                    |object: &serde_json::Map<String, Value>| object.get(key).cloned().unwrap_or_default();
                if a.contains_key(key) != b.contains_key(key) {
                    let found = format!("{place}: only one of certificate and what is found now has that");
                    return Err(Error::malformed(
                        found,
                        "the certificate was changed, or made by another program",
                    ));
                }
                compare(&of(a), &of(b), &place, largest)?;
            }
            Ok(())
        }
        (Value::Array(x), Value::Array(y)) if x.len() == y.len() => {
            let pairs = x.iter().zip(y).enumerate();
            pairs
                .into_iter()
                .try_for_each(|(index, (a, b))| compare(a, b, &format!("{place}[{index}]"), largest))
        }
        (Value::Number(x), Value::Number(y)) if x.is_f64() && y.is_f64() => {
            let (x, y) = (x.as_f64().unwrap_or(f64::NAN), y.as_f64().unwrap_or(f64::NAN));
            let off = if x == y { 0.0 } else { (x - y).abs() / x.abs().max(y.abs()) };
            if off <= SAME {
                *largest = largest.max(off);
                return Ok(());
            }
            differs()
        }
        _ if a == b => Ok(()),
        _ => differs(),
    }
}

/// A value as a message has it.
fn short(value: &Value) -> String {
    let text = value.to_string();
    if text.chars().count() > 60 { text.chars().take(57).chain("...".chars()).collect() } else { text }
}
