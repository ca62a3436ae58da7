//! The certificate: a page for whoever must decide by it, then what was checked, what came out, and what it rests on, in Markdown.

use super::hardest::hardest_scenes;
use super::stop::decisions;
use super::{in_words_of_kind, measured, sources, text};
use crate::document::Document;
use crate::manifest::{Input, Provenance, VERSION};
use crate::text::footing::{RESTS_ON, gaussian, of_scene};
use crate::text::significant;
use crate::words::Say;
use crate::words::page::READ_ONCE;
use crate::words::probability::reliability;
use crate::words::safety;
use crate::words::shortfall::no;
use hadar::instrument::presets;
use hadar_scenario::rule::{Clause, Figure, Verdict};
use hadar_scenario::{Rule, Units};
use hadar_study::{
    ApartAnswer, CameraAnswer, CameraBeforeClause, CameraVerdict, ClauseAnswer, Condition, Found, Grade,
    MeasuredAnswer, MeasuredVerdict, NotPassed, Outcome, RuleAnswer, RuleStudy, Shortfall,
};

/// The page.
pub(crate) fn page(study: &RuleStudy, answer: &RuleAnswer, provenance: &Provenance) -> String {
    first_page(answer, provenance).followed_by(details(study, answer, provenance)).to_markdown()
}

/// What somebody who is no physicist must know: who asked what, what came out and why, the worst scenes, where the numbers are from.
pub(crate) fn first_page(answer: &RuleAnswer, provenance: &Provenance) -> Document {
    let about = &answer.rule.about;
    let mut out = Document::default();
    out.heading(1, &title(answer));
    out.quote(&what_it_is(&answer.rule));
    let mut fields = about_the_rule(answer);
    fields.push(("Checked with", format!("hadar {VERSION}, commit {}", provenance.commit)));
    fields.push(("Command", format!("{}, seed {}", provenance.command_line(), provenance.seed)));
    out.fields(fields);
    about.text.iter().for_each(|text| out.quote(text));
    out.strong(&answer.sentence.say());
    let (outcome, reasons) = answer.outcome();
    out.paragraph(&passed(outcome, &reasons));
    out.items(said(&reasons).into_iter().map(|text| (None, text)));

    out.heading(2, "Clause by clause");
    let names = answer.cameras.iter().map(|camera| camera.name.as_str());
    let head: Vec<&str> = std::iter::once("clause").chain(names).collect();
    let mut rows: Vec<Vec<String>> = Vec::new();
    for clause in &answer.clauses {
        let lines = clause.lines();
        let cell = |camera: &CameraAnswer| {
            let line = lines.iter().find(|line| line.camera == camera.name);
            line.map_or_else(String::new, |line| {
                in_a_word(line.verdict, line.grade, line.conditions, line.fails_by)
            })
        };
        let name = clause.name.clone().unwrap_or_else(|| in_words_of_kind(clause.kind).to_owned());
        rows.push(std::iter::once(name).chain(answer.cameras.iter().map(cell)).collect());
    }
    if answer.clauses.len() > 1 {
        let all = answer.cameras.iter().map(|one| in_a_word(one.verdict, one.grade, &one.conditions, &[]));
        rows.push(std::iter::once("the whole rule".to_owned()).chain(all).collect());
    }
    out.table(&head, &[], rows);

    out.heading(2, "The hardest scenes");
    out.items(hardest_scenes(answer).iter().map(|scene| (None, scene.say())));
    if let Some(range) = look_alikes(&answer.rule) {
        out.paragraph(&range);
    }
    if !answer.rule.sources.is_empty() {
        out.heading(2, "Where the numbers of the rule are from");
        out.table(&["number", "value", "from"], &[0, 1], numbers_of(&answer.rule));
    }
    let cameras = figures_of_cameras(answer);
    if !cameras.is_empty() {
        out.heading(2, "Where the figures of the cameras are from");
        out.table(&["camera", "figure", "value", "from"], &[1, 2], cameras);
    }
    out.heading(2, "What the words mean");
    out.items(WORDS.map(|[word, meaning]| (Some(word.to_owned()), meaning.to_owned())));
    out
}

/// What the rule says of itself, and the day that is asked about.
pub(super) fn about_the_rule(answer: &RuleAnswer) -> Vec<(&'static str, String)> {
    let about = &answer.rule.about;
    let stated = [("Authority", &about.authority), ("Version", &about.version), ("Status", &about.status)];
    let mut fields: Vec<(&'static str, String)> =
        stated.into_iter().filter_map(|(label, value)| Some((label, value.clone()?))).collect();
    fields.extend(in_force(&answer.rule).map(|dates| ("Holds", dates)));
    let day = answer.on.map_or_else(|| "none was stated".to_owned(), |day| day.to_string());
    fields.push(("Day that is asked about", day));
    fields
}

/// What the page is, and what it is not.
pub(super) fn what_it_is(rule: &Rule) -> String {
    let figures = rule.figures();
    let chosen = figures.iter().filter(|figure| !sources::is_documented(rule, &figure.key)).count();
    format!(
        "A calculation by hadar, no type approval, no test and no legal advice: nothing was measured. It answers for one reading of a rule: of its {} numbers {} \
         are those of documents, {chosen} are choices of the author or have no source. It judges what cameras could tell, not what their software does.",
        figures.len(),
        figures.len() - chosen
    )
}

/// Words of the page, each with its meaning.
pub const WORDS: [[&str; 2]; 12] = [
    [
        "PASSED",
        "every camera of the list meets every clause, proved, under no open condition, on a stated day on which the rule holds; FAILED: one does not; WARNED: neither",
    ],
    [
        "yes",
        "in every scene of the rule a camera like this has information enough; whether its software uses it is not said",
    ],
    [
        "yes, if",
        "the same, provided that something holds which nobody stated or checked; it is listed below, camera by camera",
    ],
    ["undecided", "neither is shown: figures are uncertain, or the proof ends between the two"],
    [
        "no",
        "there is a scene of the rule in which what the clause counts (one pixel, unless it says the whole object) does not carry enough information, whatever the \
         software; or the picture is spoiled, or the target is not in the view in time",
    ],
    [
        "margin",
        "what is there over what is demanded: below 1 is a no; above 1 is needed and not enough, since blur, view and time count too",
    ],
    [
        "d",
        "statistical distance: how far two materials are apart in what is counted; a decision is right with the probability written beside it",
    ],
    ["motion blur", "the picture of the target moves by a pixel or more while it is taken"],
    ["out of view", "the target is not in the camera's field of view long enough before the decision"],
    [
        "proved",
        "holds in every scene of the rule by a mathematical bound; simulated: by drawing scenes or errors; searched: none worse was found; assumed: under \
         conditions",
    ],
    [
        "emissivity",
        "how much of its own heat a surface sends out; the rest of what is seen of it is mirrored surroundings",
    ],
    [
        "V",
        "lighting factor: the share of what a surface mirrors that comes from the surroundings that are named",
    ],
];

/// Whether the rule is passed, in a sentence.
pub(super) fn passed(outcome: Outcome, reasons: &[NotPassed]) -> String {
    match outcome {
        Outcome::Passed => "Result: PASSED. Every camera meets every clause, proved, under no condition but those that are accepted, on a day on which the rule holds.".into(),
        _ => format!("Result: {}. {}", outcome.word(), if reasons.len() == 1 { "The reason:" } else { "The reasons:" }),
    }
}

const FAILS: &str = "does not meet it";
const IS_UNDECIDED: &str = "undecided";
const IS_UNPROVED: &str = "met, and not proved";
const RESTS: &str = "rests on conditions that nobody accepted (--accept)";

/// Codes of reasons for which a rule is not passed, each with its meaning and what to do about it.
pub(crate) const REASONS: [[&str; 3]; 10] = [
    ["fails", "a camera does not meet a clause", "see its margin and what it fails by"],
    ["undecided", "a camera may or may not meet a clause", "state its figures with less uncertainty"],
    [
        "not-proved",
        "a camera meets a clause, and that is no proof",
        "see `evidence`: what was searched, simulated or assumed",
    ],
    [
        "conditions",
        "meeting a clause rests on conditions that nobody accepted",
        "settle them, or name them with --accept",
    ],
    [
        "camera-figures",
        "nobody says where figures of a camera are from",
        "name them in a [[source]], keys = [\"camera[0]\"], with a document or a choice",
    ],
    [
        "changed",
        "a value stands in the place of the rule's own, so that this is another rule",
        "leave out --set and --judge",
    ],
    [
        "materials-replaced",
        "materials by a name of this program are others",
        "leave out --library, or give them names of their own",
    ],
    ["no-day", "no day was stated on which the rule should hold", "name one with --on"],
    ["no-dates", "the rule does not say when it holds", "write from in [rule]"],
    ["not-in-force", "the rule does not hold on the day", "ask about a day on which it does"],
];

/// A reason that is of a camera: under which heading, where, and what else is said of it.
fn of_a_camera(reason: &NotPassed) -> Option<(&'static str, &CameraBeforeClause, String)> {
    match reason {
        NotPassed::Fails(place) => Some((FAILS, place, String::new())),
        NotPassed::Undecided(place) => Some((IS_UNDECIDED, place, String::new())),
        NotPassed::NotProved(place, grade) => Some((IS_UNPROVED, place, format!(", {}", grade.name()))),
        NotPassed::RestsOn(place, codes) => Some((RESTS, place, format!(": {}", codes.join(", ")))),
        _ => None,
    }
}

/// Reasons in words, those of a kind together, and of those the ones of a camera.
pub(super) fn said(reasons: &[NotPassed]) -> Vec<String> {
    let mut out = Vec::new();
    for heading in [FAILS, IS_UNDECIDED, IS_UNPROVED, RESTS] {
        let of_heading = reasons.iter().filter_map(of_a_camera).filter(|(own, ..)| *own == heading);
        let mut groups: Vec<(&str, String, Vec<&str>)> = Vec::new();
        for (_, place, what) in of_heading {
            match groups.iter_mut().find(|(camera, own, _)| *camera == place.camera && *own == what) {
                Some((.., clauses)) => clauses.extend(place.clause.as_deref()),
                None => groups.push((&place.camera, what, place.clause.as_deref().into_iter().collect())),
            }
        }
        let said = |(camera, what, clauses): (&str, String, Vec<&str>)| match clauses.as_slice() {
            [] => format!("{camera}{what}"),
            some => format!("{camera} ({}){what}", some.join(", ")),
        };
        let cameras: Vec<String> = groups.into_iter().map(said).collect();
        if !cameras.is_empty() {
            out.push(format!("{heading}: {}", cameras.join("; ")));
        }
    }
    let changed = |one: &NotPassed| match one {
        NotPassed::Changed { key, value } => Some(format!("{key} = {value}")),
        _ => None,
    };
    let changed: Vec<String> = reasons.iter().filter_map(changed).collect();
    if !changed.is_empty() {
        let what = "values stand in the place of the rule's own, so that this is another rule";
        out.push(format!("{what}: {}", changed.join("; ")));
    }
    for reason in reasons {
        match reason {
            NotPassed::Unsourced { camera, figures } => out.push(format!(
                "nobody says where figures of {camera} are from: {} ([[source]])",
                figures.join(", ")
            )),
            NotPassed::NoDay => out.push("no day was stated on which the rule should hold (--on)".into()),
            NotPassed::Replaced { materials } => {
                out.push(format!(
                    "materials of these names are not the program's, but those of --library: {}",
                    materials.join(", ")
                ));
            }
            NotPassed::NoDates => {
                out.push("the rule does not say from which day it holds ([rule] from)".into())
            }
            NotPassed::NotInForce(idle) => out.push(idle.say()),
            _ => {}
        }
    }
    out
}

/// A verdict in a cell.
pub(super) fn in_a_word(
    verdict: Verdict,
    grade: Grade,
    conditions: &[Condition],
    fails_by: &[Shortfall],
) -> String {
    match verdict {
        Verdict::Meets => match Condition::open(conditions).count() {
            0 => format!("yes ({})", grade.name()),
            1 => "yes, if (1 condition)".into(),
            count => format!("yes, if ({count} conditions)"),
        },
        Verdict::Undecided => "undecided".into(),
        Verdict::Fails if fails_by.is_empty() => "no".into(),
        Verdict::Fails => no(fails_by),
    }
}

/// That what must be told apart may be anything, where the rule does not narrow it.
fn look_alikes(rule: &Rule) -> Option<String> {
    let tells = |clause: &&Clause| clause.demand.tells_apart();
    let mut silent = Vec::new();
    for clause in rule.clauses.iter().filter(tells) {
        let lines = &clause.scenario.source.lines;
        for (key, word) in
            [("alternatives.temperature", "temperature"), ("alternatives.lighting", "lighting")]
        {
            if !lines.contains_key(key) && !silent.contains(&word) {
                silent.push(word);
            }
        }
    }
    (!silent.is_empty()).then(|| {
        format!(
            "What the target must be told from may have any {}: the rule sets no range.",
            silent.join(" and any ")
        )
    })
}

const NOBODY: &str = "nobody says from where";

/// Every number of the rule with what stands behind it.
fn numbers_of(rule: &Rule) -> Vec<[String; 3]> {
    let named = |figure: Figure| [figure.key.clone(), figure.value, behind(rule, &figure.key)];
    rule.figures().into_iter().map(named).collect()
}

/// What stands behind a figure.
fn behind(rule: &Rule, key: &str) -> String {
    let said: Vec<String> = rule.behind(key).map(sources::from_where).collect();
    if said.is_empty() { NOBODY.to_owned() } else { said.join("; ") }
}

/// Every figure of the cameras that the rule states, and the known cameras that stand behind the others.
fn figures_of_cameras(answer: &RuleAnswer) -> Vec<[String; 4]> {
    let rule = &answer.rule;
    let mut rows = Vec::new();
    for (index, (camera, own)) in answer.cameras.iter().zip(&rule.cameras).enumerate() {
        if let Some(preset) = &own.spec.preset {
            let own = rule.own_document(index).map(|named| named.map(str::to_owned));
            let known = || {
                let known = presets::find(preset).ok()?;
                known.document.or_else(|| known.provenance.into_iter().next())
            };
            let from = own.unwrap_or_else(known).unwrap_or_else(|| behind(rule, &rule.cameras[index].key));
            rows.push([camera.name.clone(), "preset".into(), preset.clone(), from]);
        }
        for figure in rule.camera_figures(index) {
            let key = figure.key.split_once('.').map_or(figure.key.as_str(), |(_, key)| key).to_owned();
            rows.push([camera.name.clone(), key, figure.value, behind(rule, &figure.key)]);
        }
    }
    rows
}

/// When a rule holds.
pub(super) fn in_force(rule: &Rule) -> Option<String> {
    match (rule.about.from, rule.about.until) {
        (Some(from), Some(until)) => Some(format!("from {from} until {until}")),
        (Some(from), None) => Some(format!("from {from}")),
        (None, Some(until)) => Some(format!("until {until}")),
        (None, None) => None,
    }
}

fn details(study: &RuleStudy, answer: &RuleAnswer, provenance: &Provenance) -> Document {
    let units = answer.rule.scenario.units();
    let mut out = Document::default();
    for clause in &answer.clauses {
        out.heading(2, clause.name.as_deref().unwrap_or("Details"));
        if clause.name.is_some() {
            clause.text.iter().for_each(|text| out.quote(text));
            out.paragraph(&clause.sentence.say());
        }
        if let Some(stop) = &clause.stop {
            out.paragraph(&format!("Stop: {}.", decisions(stop, units)));
        }
        match &clause.found {
            Found::Apart(apart) => of_apart(apart, units, &mut out),
            Found::Measured(measured) => of_measured(measured, units, &mut out),
        }
        budgets(clause, &mut out);
    }
    out.heading(2, RESTS_ON);
    let footing = study.study().map(|study| of_scene(study, gaussian(study))).unwrap_or_default();
    let footing = footing.lines().skip(1).map(|line| line.trim().to_owned());
    out.items(footing.chain(ALWAYS.map(str::to_owned)).map(|line| (None, line)));
    for camera in answer.cameras.iter().filter(|camera| !camera.conditions.is_empty()) {
        out.heading(2, &format!("What the verdict on {} rests on", camera.name));
        out.items(camera.conditions.iter().map(|one| {
            let kind = if one.favourable() { "only if " } else { "" };
            let accepted = if answer.accepted.contains(&one.code()) { " (accepted)" } else { "" };
            (Some(one.code()), format!("{kind}{}{accepted}", one.say()))
        }));
    }
    let warned = text::together(answer);
    if !warned.is_empty() {
        out.heading(2, "Warnings");
        out.items(warned.iter().map(|warning| (Some(warning.code().name().to_owned()), warning.say())));
    }
    let hash = |input: &Input| input.sha256.as_deref().unwrap_or(READ_ONCE).to_owned();
    out.heading(2, "Inputs");
    out.paragraph(
        "The answer rests on these, by their content, and on the program above; made again with them it is the same, byte by byte. \
         sha256sum gives the hash of a file; of what is built in the program gives it.",
    );
    let inputs = provenance.inputs.iter().map(|input| [input.path.clone(), hash(input)]);
    out.table(&["input", "SHA-256"], &[1], inputs);
    out
}

/// What is true of every rule.
const ALWAYS: [&str; 3] = [
    "the margin is the least statistical distance over the envelope, over that demanded; no test is right more often than the probability in \
     the table, averaged over the limiting scene and its nearest look-alike",
    "it is a limit of physics: a camera that falls short of the distance cannot do the task with any software; one that reaches it may, if its \
     software comes near the limit",
    "figures of cameras are those of the documents named with them; nothing was measured here",
];

/// What it is called.
pub(crate) fn title(answer: &RuleAnswer) -> String {
    let about = &answer.rule.about;
    let title = about.name.clone().or(answer.rule.scenario.title.clone());
    title.unwrap_or_else(|| "Which cameras meet the rule".into())
}

/// Budgets of all margins whose figures are uncertain.
fn budgets(clause: &ClauseAnswer, out: &mut Document) {
    for line in clause.lines() {
        let Some(found) = line.uncertainty else { continue };
        out.paragraph(&format!("Margin of {}:", line.camera));
        out.items(measured::uncertainty(line.margin, found).into_iter().map(|line| (None, line)));
    }
}

/// A clause that tells materials apart.
fn of_apart(apart: &ApartAnswer, units: Units, out: &mut Document) {
    out.quote(&apart.requirement.quotable.say());
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
    out.table(&head, &[], apart.cameras.iter().map(|camera| row(camera, units)));
    out.items(safety::of_rule(&apart.safety).into_iter().map(|sentence| (None, sentence)));
    if let Some(part) = &apart.not_identifiable {
        out.paragraph(&format!("{}.", text::no_camera(part).join("; ")));
    }
}

/// A clause that demands a quantity.
fn of_measured(measured: &MeasuredAnswer, units: Units, out: &mut Document) {
    out.quote(&format!("Demanded: {}.", measured.definition.say()));
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
    out.table(&head, &[], measured.cameras.iter().map(cells));
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
