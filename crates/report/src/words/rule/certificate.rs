//! The certificate: a page for whoever must decide by it, then what was checked, what came out, and what it rests on, in Markdown.

use super::hardest::hardest_scenes;
use super::reasons::{passed, said};
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
use hadar_scenario::rule::{Clause, Verdict};
use hadar_scenario::{Rule, Units};
use hadar_study::{
    ApartAnswer, CameraAnswer, CameraVerdict, ClauseAnswer, Condition, Found, Grade, MeasuredAnswer,
    MeasuredVerdict, RuleAnswer, RuleStudy, Shortfall,
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
        out.table(&["number", "value", "from"], &[0, 1], sources::numbers_of(&answer.rule));
    }
    let cameras = sources::figures_of_cameras(answer);
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
        "A calculation by hadar, not a type approval, a test or legal advice: nothing was measured. It applies to one reading of a rule: of its {} numbers {} \
         are from documents, {chosen} are choices of the author or have no source. It judges what cameras can show, not what their software does.",
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
        "in every scene of the rule such a camera collects enough information; whether its software uses it is not said",
    ],
    [
        "yes, if",
        "the same, provided that something holds which nobody stated or checked; it is listed below, camera by camera",
    ],
    ["undecided", "neither is shown: figures are uncertain, or the proof leaves both possible"],
    [
        "no",
        "there is a scene of the rule in which what the clause counts (one pixel, unless it says the whole object) does not carry enough information, whatever the \
         software; or the picture is spoiled, or the target is not in the view in time",
    ],
    [
        "margin",
        "value reached over value required (for an error the inverse): below 1 is a no; above 1 is necessary but not sufficient, since blur, view and time count too",
    ],
    [
        "d",
        "statistical distance: how different two materials are in the counts, in standard deviations; a decision is right with the probability given with it",
    ],
    ["motion blur", "the image of the target moves by a pixel or more while it is taken"],
    ["out of view", "the target is not in the camera's field of view long enough before the decision"],
    [
        "proved",
        "holds in every scene of the rule by a mathematical bound; simulated: by drawing scenes or errors; searched: none worse was found; assumed: under \
         conditions",
    ],
    [
        "emissivity",
        "the fraction of a blackbody's radiation that a surface emits; the rest of what is seen of it is reflected from the surroundings",
    ],
    [
        "V",
        "lighting factor: the fraction of the hemisphere above a surface, weighted by the cosine, that a named part of the surroundings fills",
    ],
];

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
        for (key, word) in
            [("alternatives.temperature", "temperature"), ("alternatives.lighting", "lighting")]
        {
            if !clause.scenario.source.states(key) && !silent.contains(&word) {
                silent.push(word);
            }
        }
    }
    (!silent.is_empty()).then(|| {
        format!(
            "What the target must be distinguished from may have any {}: the rule sets no range.",
            silent.join(" and any ")
        )
    })
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
        "The answer depends on the content of these and on the program above; made again from them it is the same, byte by byte. \
         sha256sum gives the hash of a file; of built-in data the program gives it.",
    );
    let inputs = provenance.inputs.iter().map(|input| [input.path.clone(), hash(input)]);
    out.table(&["input", "SHA-256"], &[1], inputs);
    out
}

/// What is true of every rule.
const ALWAYS: [&str; 3] = [
    "the margin is the least statistical distance over the operating envelope, divided by the required one; no test is right more often than the probability in \
     the table, averaged over the limiting scene and its closest confuser",
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

/// A clause that requires materials to be distinguished.
fn of_apart(apart: &ApartAnswer, units: Units, out: &mut Document) {
    out.quote(&apart.requirement.quotable.say());
    let head = [
        "camera",
        "meets",
        "margin",
        "d at worst",
        "correct at most",
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
