//! The files of a rule: a certificate of one page, tables, the rule with its defaults, margins as a plot.
//!
//! Nothing in them depends on when or where they were made, so that anyone can make them again, byte by byte.

mod course;
mod grid;
mod moved;
mod record;
mod reforms;
mod stand_in;

pub use crate::words::rule::{
    cell_by_cell, check, figures_moved, reforms, rows, sources, stand_in, tests, text,
};
pub use grid::grid_bundle;
pub use moved::moved_bundle;
pub(crate) use record::STATEMENT;
pub use record::{agreement, parsed, record};
pub use reforms::reforms_bundle;
pub use stand_in::stand_in_bundle;

use super::bundle::Bundle;
use super::figures::Plot;
use super::manifest::{Input, Provenance, sha256};
use super::plot::{Axis, Figure, NamedSeries, NamedValues};
use super::table::{Table, joined, number, optional, yes_no};
use super::tables;
use crate::words::rule::{ALL_CLAUSES, HardestScene, certificate, hardest_scenes, measure, one_clause};
use crate::words::shortfall::{codes, no};
use hadar::error::Result;
use hadar::policy::Quantity;
use hadar_scenario::rule::Verdict;
use hadar_study::companion::Companion;
use hadar_study::{
    CameraAnswer, CameraVerdict, Condition, Found, MarginUncertainty, RuleAnswer, RuleStudy, Warning,
};

/// What can be changed of a camera.
const HARDWARE: [Quantity; 5] =
    [Quantity::Exposure, Quantity::Pixel, Quantity::FNumber, Quantity::Noise, Quantity::Frames];

/// The rule's own file in a report of it, as it was read.
pub const AS_READ: &str = "rule_as_read.toml";

/// A rule's answer as JSON.
#[derive(Debug, serde::Serialize)]
pub struct Output<'a> {
    /// The answer.
    #[serde(flatten)]
    pub answer: &'a RuleAnswer,
    /// The scene in which every camera is nearest to failing each clause, or fails it most.
    hardest: Vec<HardestScene>,
    /// A digest of all figures of each camera, in their order: the same of the same camera in any rule.
    camera_digests: Vec<String>,
    /// All that it rests on, by its content.
    pub inputs: &'a [Input],
}

impl<'a> Output<'a> {
    /// That of an answer, which rests on `inputs`.
    #[must_use]
    pub fn of(answer: &'a RuleAnswer, inputs: &'a [Input]) -> Self {
        let camera_digests = answer.camera_figures.iter().map(|figures| sha256(figures.as_bytes())).collect();
        Self { answer, hardest: hardest_scenes(answer), camera_digests, inputs }
    }
}

/// All files; paths in the rule are written relative to `out` where they lie below it.
///
/// # Errors
/// A table that cannot be written.
pub fn bundle(study: &RuleStudy, answer: &RuleAnswer, provenance: &Provenance) -> Result<Bundle> {
    let title = certificate::title(answer);
    let mut bundle = Bundle::about(Some(&title));
    bundle.add("certificate.md", certificate::page(study, answer, provenance));
    bundle.begin_with(certificate::first_page(answer, provenance).to_html());
    let data = record::text(&record::record(study, answer, provenance)?)?;
    bundle.add(record::NAME, data);
    bundle.add_statement(record::STATEMENT, record::NAME, record::statement(answer, provenance));
    bundle.add_asked("rule.toml", study.rule().to_toml());
    // What is filled in has no source: only the rule itself, word by word, says where its figures are from.
    bundle.add(AS_READ, study.rule().text());
    bundle.add_table("cameras.csv", cameras(answer))?;
    bundle.add_table("worst_cases.csv", worst_cases(answer))?;
    let companions: Vec<&Companion> = answer
        .clauses
        .iter()
        .filter_map(|clause| clause.apart())
        .flat_map(|apart| &apart.companions)
        .collect();
    if !companions.is_empty() {
        bundle.add_table("companion.csv", tables::companions(companions))?;
    }
    bundle.add("inputs.csv", inputs(provenance).to_csv()?);
    let rests_on = answer
        .cameras
        .iter()
        .flat_map(|camera| camera.conditions.iter().map(move |one| (camera.name.as_str(), one)));
    bundle.add_conditions(&rests_on.collect::<Vec<_>>())?;
    bundle.add_warnings(&warnings(answer))?;
    bundle.add_plots(&[margins(answer)])?;
    bundle.add_plots(&course::plots(&study.courses(answer)?, study.rule().scenario.units()))?;
    Ok(bundle)
}

/// All warnings, those of a camera with its name.
fn warnings(answer: &RuleAnswer) -> Vec<Warning> {
    let mut all = answer.warnings.clone();
    for clause in &answer.clauses {
        for line in clause.lines() {
            let own = line.warnings.iter().map(|warning| warning.clone().of_cameras(line.camera));
            let new: Vec<Warning> = own.filter(|warning| !all.contains(warning)).collect();
            all.extend(new);
        }
    }
    all
}

/// Every camera before every clause.
fn cameras(answer: &RuleAnswer) -> Table {
    let fixes = HARDWARE.map(|quantity| format!("would_do_{}", quantity.key()));
    let head = [
        "camera",
        "meets_the_rule",
        "fails_by",
        "conditions",
        "bands",
        "readout",
        "sweep_s",
        "margin",
        "statistical_distance",
        "detection_probability",
        "lower_bound",
        "certificate",
        "motion_blur_pixels",
    ];
    let last = [
        "clause",
        "kind",
        "evidence",
        "quantity",
        "demanded",
        "reached",
        "verdict",
        "margin_low",
        "margin_high",
    ];
    let names = head.into_iter().map(str::to_owned).chain(fixes).chain(last.map(str::to_owned));
    let mut table = Table::new(names);
    for clause in &answer.clauses {
        let apart: &[CameraVerdict] = clause.apart().map_or(&[], |apart| &apart.cameras);
        for (index, line) in clause.lines().into_iter().enumerate() {
            let own = apart.get(index);
            let of = |value: &dyn Fn(&CameraVerdict) -> String| own.map(value).unwrap_or_default();
            let mut row = vec![
                line.camera.to_owned(),
                yes_no(line.verdict == Verdict::Meets),
                codes(line.fails_by, " "),
                line.conditions.iter().map(hadar_study::Condition::code).collect::<Vec<_>>().join(" "),
                of(&|camera| camera.bands.to_string()),
                of(&|camera| camera.readout.name().into()),
                of(&|camera| number(camera.sweep_s)),
                number(line.margin),
                of(&|camera| number(camera.statistical_distance)),
                of(&|camera| number(camera.detection_probability)),
                of(&|camera| optional(camera.lower_bound)),
                of(&|camera| camera.certificate.kind.code().into()),
                of(&|camera| optional(camera.motion_blur_pixels)),
            ];
            row.extend(HARDWARE.map(|quantity| of(&|camera| optional(value(camera, quantity)))));
            let name = clause.name.clone().unwrap_or_default();
            row.extend([name, clause.kind.to_owned(), line.grade.name().to_owned()]);
            row.extend(match &clause.found {
                Found::Apart(apart) => {
                    let (required, reached) =
                        (apart.requirement.distance, own.map(|own| own.statistical_distance));
                    ["statistical distance".to_owned(), number(required), optional(reached)]
                }
                Found::Measured(measured) => {
                    let reached = measured.cameras.get(index).and_then(|camera| camera.value);
                    [measure(measured.quantity).to_owned(), number(measured.demanded), optional(reached)]
                }
            });
            let end = |of: &dyn Fn(&MarginUncertainty) -> f64| optional(line.uncertainty.map(of));
            row.extend([line.verdict.name().to_owned(), end(&|found| found.low), end(&|found| found.high)]);
            table.push(row);
        }
    }
    table
}

fn value(camera: &CameraVerdict, wanted: Quantity) -> Option<f64> {
    let solved = camera.fixes.iter().flat_map(|fixes| &fixes.quantities.0);
    solved.filter(|(quantity, _)| *quantity == wanted).find_map(|(_, solution)| solution.value)
}

fn worst_cases(answer: &RuleAnswer) -> Table {
    let mut table = Table::new([
        "clause",
        "camera",
        "target",
        "alternative",
        "temperature_k",
        "lighting",
        "surroundings_k",
        "distance_m",
        "nearest_temperature_k",
        "nearest_lighting",
        "statistical_distance",
        "hardware_required_m2_s",
    ]);
    for clause in &answer.clauses {
        let name = clause.name.clone().unwrap_or_default();
        for camera in clause.apart().iter().flat_map(|apart| &apart.cameras) {
            let scene = &camera.limiting;
            table.push(vec![
                name.clone(),
                camera.name.clone(),
                scene.target.clone(),
                scene.alternative.clone(),
                number(scene.temperature_k),
                joined(&scene.lighting),
                joined(&scene.surroundings_k),
                optional(scene.distance_m),
                number(scene.nearest_state.temperature_k),
                joined(&scene.nearest_state.lighting),
                number(camera.statistical_distance),
                optional(scene.hardware_m2_s),
            ]);
        }
        let Found::Measured(measured) = &clause.found else { continue };
        for camera in &measured.cameras {
            let scene = &camera.limiting;
            let nothing = String::new;
            table.push(vec![
                name.clone(),
                camera.name.clone(),
                scene.target.clone().unwrap_or_default(),
                nothing(),
                optional(scene.temperature_k),
                joined(&scene.lighting),
                joined(&scene.surroundings_k),
                optional(scene.distance_m),
                nothing(),
                nothing(),
                nothing(),
                nothing(),
            ]);
        }
    }
    table
}

fn inputs(provenance: &Provenance) -> Table {
    let mut table = Table::new(["path", "sha256"]);
    let row = |input: &Input| vec![input.path.clone(), input.sha256.clone().unwrap_or_default()];
    provenance.inputs.iter().for_each(|input| table.push(row(input)));
    table
}

/// The margin of every camera: those that meet the rule first, then the others, each with what it fails by.
fn margins(answer: &RuleAnswer) -> Plot {
    let mut ranked: Vec<&CameraAnswer> = answer.cameras.iter().collect();
    ranked.sort_by(|a, b| b.passes.cmp(&a.passes).then(b.margin.total_cmp(&a.margin)));
    let only = answer.only();
    let verdict = |camera: &CameraAnswer| {
        only.and_then(|only| only.cameras.iter().find(|verdict| verdict.name == camera.name))
    };
    let mut table = Table::new(["camera", "meets_the_rule", "fails_by", "margin", "margin_proved"]);
    for camera in &ranked {
        let own = verdict(camera);
        let fails = own.map_or_else(|| camera.fails.join(", "), |own| codes(&own.fails_by, " "));
        let proved = own.and_then(|own| Some(own.lower_bound? / only?.requirement.distance));
        table.push(vec![
            camera.name.clone(),
            yes_no(camera.passes),
            fails,
            number(camera.margin),
            optional(proved),
        ]);
    }
    // The margin does not show what else a camera fails by.
    let named = |camera: &&CameraAnswer| match (camera.verdict, verdict(camera)) {
        (Verdict::Meets, _) if Condition::open(&camera.conditions).next().is_some() => {
            format!("{}\nyes, if", camera.name)
        }
        (Verdict::Meets, _) => camera.name.clone(),
        (Verdict::Undecided, Some(_)) => format!("{}\nundecided", camera.name),
        (Verdict::Fails, Some(own)) => format!("{}\n{}", camera.name, no(&own.fails_by)),
        (_, None) => {
            let clauses = camera.fails.iter().chain(&camera.undecided);
            format!("{}\n{}", camera.name, clauses.cloned().collect::<Vec<_>>().join(", "))
        }
    };
    let names = ranked.iter().map(named).collect();
    let mut values =
        NamedSeries::new("least over the envelope", ranked.iter().map(|camera| camera.margin).collect());
    if ranked.iter().any(|camera| camera.interval.is_some()) {
        let end = |of: usize| {
            ranked.iter().map(|camera| camera.interval.map_or(camera.margin, |ends| ends[of])).collect()
        };
        values = values.intervals(end(0), end(1));
    }
    let (axis, subtitle) = match only {
        Some(only) => {
            ("margin: statistical distance over that demanded", one_clause(only.requirement.distance))
        }
        None => ("margin: value reached over value required (for an error the inverse)", ALL_CLAUSES.into()),
    };
    let figure = NamedValues::new(certificate::title(answer), names, Axis::log(axis))
        .subtitle(subtitle)
        .series(values)
        .threshold(1.0, "demanded")
        .failing(ranked.iter().map(|camera| !camera.passes).collect())
        .below(if answer.sentence.undecided.is_empty() {
            "does not meet the rule"
        } else {
            "does not meet the rule, or is undecided"
        });
    Plot { name: "margins".into(), figure: Figure::from(figure), table }
}
