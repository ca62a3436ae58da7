//! The certificate: one page of Markdown that says what was checked, what came out, and what it rests on.

use super::sources::dates;
use super::stop::decisions;
use super::{measured, text};
use crate::manifest::{Input, Provenance, VERSION};
use crate::table::markdown;
use crate::text::footing::{RESTS_ON, gaussian, of_scene};
use crate::text::significant;
use crate::words::Say;
use crate::words::page::READ_ONCE;
use crate::words::probability::reliability;
use crate::words::safety;
use hadar_scenario::Units;
use hadar_study::{
    ApartAnswer, CameraVerdict, ClauseAnswer, Found, MeasuredAnswer, MeasuredVerdict, RuleAnswer, RuleStudy,
};
use std::fmt::Write as _;

/// The page.
pub(crate) fn page(study: &RuleStudy, answer: &RuleAnswer, provenance: &Provenance) -> String {
    let (about, units) = (&answer.rule.about, answer.rule.scenario.units());
    let mut out = format!("# {}\n\n", title(answer));
    for (label, value) in [("Authority", &about.authority), ("Version", &about.version)] {
        if let Some(value) = value {
            let _ = writeln!(out, "{label}: {value}  ");
        }
    }
    dates(&answer.rule).iter().for_each(|line| {
        let _ = writeln!(out, "{line}  ");
    });
    let _ = writeln!(out, "Checked with hadar {VERSION}, commit {}  ", provenance.commit);
    let _ = writeln!(out, "Command: `{}`, seed {}\n", provenance.command_line(), provenance.seed);
    if let Some(text) = &about.text {
        let _ = writeln!(out, "{text}\n");
    }
    let _ = writeln!(out, "**{}**\n", answer.sentence.say());
    for clause in &answer.clauses {
        if let Some(name) = &clause.name {
            let _ = writeln!(out, "## {name}\n");
            if let Some(text) = &clause.text {
                let _ = writeln!(out, "{text}\n");
            }
            let _ = writeln!(out, "{}\n", clause.sentence.say());
        }
        if let Some(stop) = &clause.stop {
            let _ = writeln!(out, "Stop: {}.\n", decisions(stop, units));
        }
        match &clause.found {
            Found::Apart(apart) => of_apart(apart, units, &mut out),
            Found::Measured(measured) => of_measured(measured, units, &mut out),
        }
        budgets(clause, &mut out);
    }
    out.push_str(&format!("## {RESTS_ON}\n\n"));
    if let Some(study) = study.study() {
        let footing = of_scene(study, gaussian(study));
        footing.lines().skip(1).for_each(|line| {
            let _ = writeln!(out, "- {}", line.trim());
        });
    }
    out.push_str(
        "- the margin is the least statistical distance over the envelope, over that demanded; no test is right more often than \
         the probability in the table, averaged over the limiting scene and its nearest look-alike\n\
         - it is a limit of physics: a camera that falls short of the distance cannot do the task with any software; one that \
         reaches it may, if its software comes near the limit\n\
         - figures of cameras are those of the documents named with them; nothing was measured here\n\n",
    );
    for camera in answer.cameras.iter().filter(|camera| !camera.conditions.is_empty()) {
        let _ = writeln!(out, "## What the verdict on {} rests on\n", camera.name);
        for one in &camera.conditions {
            let kind = if one.favourable() { "only if " } else { "" };
            let accepted = if answer.accepted.contains(&one.code()) { " (accepted)" } else { "" };
            let _ = writeln!(out, "- [{}] {kind}{}{accepted}", one.code(), one.say());
        }
        out.push('\n');
    }
    let warned = text::together(answer);
    if !warned.is_empty() {
        out.push_str("## Warnings\n\n");
        warned.iter().for_each(|warning| {
            let _ = writeln!(out, "- [{}] {}", warning.code().name(), warning.say());
        });
        out.push('\n');
    }
    let hash = |input: &Input| input.sha256.as_deref().map_or(READ_ONCE.into(), |hash| format!("`{hash}`"));
    let inputs = provenance.inputs.iter().map(|input| [input.path.clone(), hash(input)]);
    out.push_str(
        "## Inputs\n\nThe answer rests on these, by their content, and on the program above; made again with them it is the same, byte by byte. \
         `sha256sum` gives the hash of a file; of what is built in the program gives it.\n\n",
    );
    out + &markdown(&["input", "SHA-256"], inputs)
}

/// What it is called.
pub(crate) fn title(answer: &RuleAnswer) -> String {
    let about = &answer.rule.about;
    let title = about.name.clone().or(answer.rule.scenario.title.clone());
    title.unwrap_or_else(|| "Which cameras meet the rule".into())
}

/// Budgets of all margins whose figures are uncertain.
fn budgets(clause: &ClauseAnswer, out: &mut String) {
    for line in clause.lines() {
        let Some(found) = line.uncertainty else { continue };
        let _ = writeln!(out, "Margin of {}:\n", line.camera);
        measured::uncertainty(line.margin, found).iter().for_each(|line| {
            let _ = writeln!(out, "- {line}");
        });
        out.push('\n');
    }
}

/// A clause that tells materials apart.
fn of_apart(apart: &ApartAnswer, units: Units, out: &mut String) {
    let _ = writeln!(out, "> {}\n", apart.requirement.quotable.say());
    let head = [
        "camera",
        "meets",
        "margin",
        "d at worst",
        "right at most",
        "bands",
        "certificate",
        "limiting scene",
        "would do",
    ];
    out.push_str(&markdown(&head, apart.cameras.iter().map(|camera| row(camera, units))));
    out.push('\n');
    for sentence in safety::of_rule(&apart.safety) {
        let _ = writeln!(out, "- {sentence}");
    }
    if !apart.safety.is_empty() {
        out.push('\n');
    }
    if let Some(part) = &apart.not_identifiable {
        let _ = writeln!(out, "{}.\n", text::no_camera(part).join("; "));
    }
}

/// A clause that demands a quantity.
fn of_measured(measured: &MeasuredAnswer, units: Units, out: &mut String) {
    let _ = writeln!(out, "> Demanded: {}.\n", measured.definition.say());
    let head =
        ["camera", "meets", "margin", measured::measure(measured.quantity), "evidence", "limiting scene"];
    let cells = |camera: &MeasuredVerdict| {
        [
            camera.name.clone(),
            measured::measured_meets(camera),
            significant(camera.margin, 3),
            camera.value.map_or_else(|| "no bound".into(), |value| significant(value, 3)),
            camera.grade.name().to_owned(),
            measured::measured_scene(&camera.limiting, units),
        ]
    };
    out.push_str(&markdown(&head, measured.cameras.iter().map(cells)));
    out.push('\n');
}

fn row(camera: &CameraVerdict, units: Units) -> [String; 9] {
    [
        camera.name.clone(),
        text::meets(camera),
        significant(camera.margin, 3),
        significant(camera.statistical_distance, 3),
        reliability(camera.statistical_distance),
        text::reading(camera),
        text::certified(camera),
        text::scene(&camera.limiting, units),
        camera.fixes.as_ref().map_or_else(String::new, |fixes| text::would_do(fixes, units)),
    ]
}
