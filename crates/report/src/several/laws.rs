//! Several rules side by side: every camera before every rule, with what decides and the hardest scene.

use crate::figures::Plot;
use crate::plot::{Axis, Figure, NamedSeries, NamedValues};
use crate::table::{Table, number};
use crate::text::columns::aligned;
use crate::text::significant;
use crate::words::several::{
    BESIDES, BESIDES_IF, IN_BRACKETS, LEAST_OR_SPOILED, NOT_ALL, NOT_THE_SAME, SIDE_BY_SIDE, UNDECIDED,
    YES_IF, before_all, hardest, of_rule,
};
use serde_json::Value;

/// A camera before a rule.
struct Cell<'a> {
    verdict: &'static str,
    meets: bool,
    margin: f64,
    clause: Option<&'a str>,
    evidence: &'a str,
    /// What it fails by where its margin does not say it, in codes.
    spoiled: Vec<&'a str>,
    /// The scene that decides, in words.
    scene: Option<&'a str>,
}

/// A camera of some of the rules: what has the same name and other figures is another one.
#[derive(PartialEq)]
struct Camera<'a> {
    name: &'a str,
    digest: &'a str,
}

/// A rule that was answered.
struct Law<'a> {
    name: &'a str,
    answer: &'a Value,
}

impl<'a> Law<'a> {
    fn cameras(&self) -> impl Iterator<Item = (Camera<'a>, &'a Value)> {
        let all = self.answer["cameras"].as_array().into_iter().flatten().enumerate();
        all.filter_map(|(index, own)| {
            let digest = self.answer["camera_digests"][index].as_str().unwrap_or_default();
            Some((Camera { name: own["name"].as_str()?, digest }, own))
        })
    }

    fn before(&self, camera: &Camera<'_>) -> Option<Cell<'a>> {
        let (_, own) = self.cameras().find(|(known, _)| known == camera)?;
        let name = camera.name;
        let conditional = hangs(&own["conditions"]);
        let verdict = match own["verdict"].as_str() {
            Some("meets") if self.idle() && conditional => BESIDES_IF,
            Some("meets") if self.idle() => BESIDES,
            Some("meets") if conditional => YES_IF,
            Some("meets") => "yes",
            Some("undecided") => UNDECIDED,
            _ => "no",
        };
        let margin = own["margin"].as_f64().unwrap_or(f64::NAN);
        let spoils = verdict == "no" && margin >= 1.0;
        // Where a picture is spoiled the least margin decides nothing: the first clause that fails does.
        let clause = own["fails"][0].as_str().filter(|_| spoils).or(own["limiting_clause"].as_str());
        let lines = self.answer["clauses"].as_array().into_iter().flatten();
        let lines = lines.filter(|line| clause.is_none() || line["name"].as_str() == clause);
        let line =
            lines.filter_map(|line| line["cameras"].as_array()).flatten().find(|line| line["name"] == name);
        let by = own["fails_by"].as_array().or_else(|| line?["fails_by"].as_array()).into_iter().flatten();
        let scene = self.answer["hardest"].as_array().into_iter().flatten().find(|scene| {
            scene["camera"] == name && (clause.is_none() || scene["clause"].as_str() == clause)
        });
        Some(Cell {
            verdict,
            meets: own["verdict"] == "meets" && !self.idle(),
            margin,
            clause,
            spoiled: by.filter_map(Value::as_str).filter(|_| spoils).collect(),
            evidence: own["grade"].as_str().unwrap_or_default(),
            scene: scene.and_then(|scene| scene["scene"].as_str()),
        })
    }

    /// Whether it does not hold on the day that is asked about.
    fn idle(&self) -> bool {
        !self.answer["on"].is_null() && self.answer["in_force"] != true
    }
}

fn laws<'a>(answers: &[(&'a str, &'a Value)]) -> Vec<Law<'a>> {
    answers.iter().map(|(name, answer)| Law { name, answer }).collect()
}

/// Whether one of some conditions is favourable.
pub(super) fn hangs(conditions: &Value) -> bool {
    conditions.as_array().is_some_and(|all| all.iter().any(|one| one["favourable"] == true))
}

/// All cameras, in the order in which the rules name them, each with what it is called: of several of one name by its rule too.
fn cameras<'a>(laws: &[Law<'a>]) -> Vec<(Camera<'a>, String)> {
    let mut found: Vec<(Camera<'a>, &'a str)> = Vec::new();
    for law in laws {
        for (camera, _) in law.cameras() {
            if !found.iter().any(|(known, _)| *known == camera) {
                found.push((camera, law.name));
            }
        }
    }
    let alone = |name: &str| found.iter().filter(|(camera, _)| camera.name == name).count() == 1;
    let called: Vec<String> = found
        .iter()
        .map(|(Camera { name, .. }, law)| if alone(name) { (*name).to_owned() } else { of_rule(name, law) })
        .collect();
    found.into_iter().map(|(camera, _)| camera).zip(called).collect()
}

/// Whether all rules name a camera and are met by it.
fn meets_all(laws: &[Law<'_>], camera: &Camera<'_>) -> bool {
    laws.iter().all(|law| law.before(camera).is_some_and(|cell| cell.meets))
}

/// Which cameras meet all rules, what comes of each by each, and the hardest scenes; `None` of fewer than two rules.
pub(super) fn text(answers: &[(&str, &Value)], asked: usize) -> Option<String> {
    let laws = laws(answers);
    let cameras = cameras(&laws);
    if laws.len() < 2 || cameras.is_empty() {
        return None;
    }
    let all = cameras.iter().filter(|(camera, _)| meets_all(&laws, camera));
    let meet: Vec<&(Camera<'_>, String)> = all.collect();
    let is_open = |camera: &Camera<'_>| {
        laws.iter().any(|law| law.before(camera).is_some_and(|cell| cell.verdict == YES_IF))
    };
    let open = meet.iter().any(|(camera, _)| is_open(camera));
    let names: Vec<&str> = meet.iter().map(|(_, called)| called.as_str()).collect();
    let mut out = before_all(&names, open, cameras.len(), laws.len(), asked);
    let mut lines = vec![
        std::iter::once("camera".to_owned())
            .chain(laws.iter().map(|law| law.name.to_owned()))
            .collect::<Vec<_>>(),
    ];
    for (camera, called) in &cameras {
        let cell = |law: &Law<'_>| match law.before(camera) {
            Some(cell) => {
                let why = match cell.spoiled.as_slice() {
                    [] => significant(cell.margin, 3),
                    codes => codes.join(", ").replace('-', " "),
                };
                let by = cell.clause.map_or_else(String::new, |clause| format!(", {clause}"));
                format!("{} ({why}{by})", cell.verdict)
            }
            None => "-".into(),
        };
        lines.push(std::iter::once(called.clone()).chain(laws.iter().map(cell)).collect());
    }
    out += &aligned(&lines, &[]);
    out += IN_BRACKETS;
    if cameras.iter().any(|(camera, called)| camera.name != called) {
        out += NOT_THE_SAME;
    }
    for law in &laws {
        let scenes =
            cameras.iter().filter_map(|(camera, called)| Some((called.as_str(), law.before(camera)?.scene?)));
        out += &hardest(law.name, &scenes.collect::<Vec<_>>());
    }
    Some(out)
}

/// The table of every camera before every rule, and their margins as a picture where all rules have the same cameras.
pub(super) fn plot(answers: &[(&str, &Value)]) -> Option<Plot> {
    let laws = laws(answers);
    let cameras = cameras(&laws);
    if laws.len() < 2 || cameras.is_empty() {
        return None;
    }
    let mut table = Table::new([
        "rule",
        "camera",
        "verdict",
        "margin",
        "evidence",
        "clause",
        "fails_by",
        "hardest_scene",
    ]);
    let mut figure = NamedValues::new(
        SIDE_BY_SIDE,
        cameras.iter().map(|(_, called)| called.clone()).collect(),
        Axis::log("margin: value reached over value required (for an error the inverse)"),
    )
    .subtitle(LEAST_OR_SPOILED)
    .failing(cameras.iter().map(|(camera, _)| !meets_all(&laws, camera)).collect())
    .below(NOT_ALL);
    for law in &laws {
        let cells: Vec<Option<Cell<'_>>> = cameras.iter().map(|(camera, _)| law.before(camera)).collect();
        for ((_, called), cell) in cameras.iter().zip(&cells) {
            let Some(cell) = cell else { continue };
            table.push(vec![
                law.name.to_owned(),
                called.clone(),
                cell.verdict.to_owned(),
                number(cell.margin),
                cell.evidence.to_owned(),
                cell.clause.unwrap_or_default().to_owned(),
                cell.spoiled.join(" "),
                cell.scene.unwrap_or_default().to_owned(),
            ]);
        }
        let margins = cells.iter().map(|cell| cell.as_ref().map_or(f64::NAN, |cell| cell.margin)).collect();
        figure = figure.series(NamedSeries::new(law.name, margins));
    }
    Some(Plot { name: "laws".into(), figure: Figure::from(figure.threshold(1.0, "demanded")), table })
}
