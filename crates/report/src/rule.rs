//! The files of a rule: a certificate of one page, tables, the rule with its defaults, margins as a plot.
//!
//! Nothing in them depends on when or where they were made, so that anyone can make them again, byte by byte.

mod certificate;
mod check;
mod text;

pub use check::check;
pub use text::text;

use super::bundle::Bundle;
use super::figures::Plot;
use super::manifest::{Input, Provenance};
use super::plot::{Axis, Figure, NamedSeries, NamedValues};
use super::table::{Table, number, optional};
use super::text::shortfalls::no;
use super::text::significant;
use hadar::error::Result;
use hadar::policy::Quantity;
use hadar_study::study::{CameraVerdict, RuleAnswer, RuleStudy, Warning};
use std::path::Path;

/// What can be changed of a camera.
const HARDWARE: [Quantity; 5] =
    [Quantity::Exposure, Quantity::Pixel, Quantity::FNumber, Quantity::Noise, Quantity::Frames];

/// All files; paths in the rule are written relative to `out` where they lie below it.
///
/// # Errors
/// A table that cannot be written.
pub fn bundle(study: &RuleStudy, answer: &RuleAnswer, provenance: &Provenance, out: &Path) -> Result<Bundle> {
    let title = certificate::title(answer);
    let mut bundle = Bundle::about(Some(&title));
    bundle.add("certificate.md", certificate::markdown(study, answer, provenance));
    bundle.add_asked("rule.toml", study.rule().to_toml_beside(out));
    bundle.add_table("cameras.csv", cameras(answer))?;
    bundle.add_table("worst_cases.csv", worst_cases(answer))?;
    bundle.add("inputs.csv", inputs(provenance).to_csv()?);
    bundle.add_warnings(&warnings(answer))?;
    bundle.add_plots(&[margins(answer)])?;
    Ok(bundle)
}

/// All warnings, those of a camera with its name.
fn warnings(answer: &RuleAnswer) -> Vec<Warning> {
    let of_cameras = answer
        .cameras
        .iter()
        .flat_map(|camera| camera.warnings.iter().map(|warning| warning.clone().of_cameras(&camera.name)));
    answer.warnings.iter().cloned().chain(of_cameras).collect()
}

fn cameras(answer: &RuleAnswer) -> Table {
    let fixes = HARDWARE.map(|quantity| format!("would_do_{}", quantity.key()));
    let head = [
        "camera",
        "meets_the_rule",
        "fails_by",
        "provided",
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
    let mut table = Table::new(head.map(str::to_owned).into_iter().chain(fixes));
    for camera in &answer.cameras {
        let mut row = vec![
            camera.name.clone(),
            if camera.passes { "yes" } else { "no" }.into(),
            text::codes(&camera.fails_by, " "),
            camera.provided.map(|proviso| proviso.to_string()).unwrap_or_default(),
            camera.bands.to_string(),
            camera.readout.name().into(),
            number(camera.sweep_s),
            number(camera.margin),
            number(camera.statistical_distance),
            number(camera.detection_probability),
            optional(camera.lower_bound),
            camera.certificate.kind.code().into(),
            optional(camera.motion_blur_pixels),
        ];
        row.extend(HARDWARE.map(|quantity| optional(value(camera, quantity))));
        table.push(row);
    }
    table
}

fn value(camera: &CameraVerdict, wanted: Quantity) -> Option<f64> {
    let solved = camera.fixes.iter().flat_map(|fixes| &fixes.quantities.0);
    solved.filter(|(quantity, _)| *quantity == wanted).find_map(|(_, solution)| solution.value)
}

fn worst_cases(answer: &RuleAnswer) -> Table {
    let joined = |values: &[f64]| values.iter().map(|&value| number(value)).collect::<Vec<_>>().join(" ");
    let mut table = Table::new([
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
    for camera in &answer.cameras {
        let scene = &camera.limiting;
        table.push(vec![
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
    let mut ranked: Vec<&CameraVerdict> = answer.cameras.iter().collect();
    ranked.sort_by(|a, b| b.passes.cmp(&a.passes).then(b.margin.total_cmp(&a.margin)));
    let mut table = Table::new(["camera", "meets_the_rule", "fails_by", "margin", "margin_proved"]);
    let required = answer.requirement.distance;
    for camera in &ranked {
        let proved = camera.lower_bound.map(|bound| bound / required);
        table.push(vec![
            camera.name.clone(),
            if camera.passes { "yes" } else { "no" }.into(),
            text::codes(&camera.fails_by, " "),
            number(camera.margin),
            optional(proved),
        ]);
    }
    // The margin does not show what else a camera fails by.
    let named = |camera: &&CameraVerdict| match camera.passes {
        true => camera.name.clone(),
        false => format!("{}\n{}", camera.name, no(&camera.fails_by)),
    };
    let names = ranked.iter().map(named).collect();
    let values =
        NamedSeries::new("least over the envelope", ranked.iter().map(|camera| camera.margin).collect());
    let title = answer.rule.about.name.clone().or(answer.rule.scenario.title.clone());
    let title = title.unwrap_or_else(|| "Which cameras meet the rule".into());
    let required = significant(required, 3);
    let figure = NamedValues::new(title, names, Axis::log("margin: statistical distance over that demanded"))
        .subtitle(format!(
            "Least over the envelope; demanded is d = {required}. Full symbols meet the rule; a camera may have signal enough and \
             still fail by its image."
        ))
        .series(values)
        .threshold(1.0, "demanded")
        .failing(ranked.iter().map(|camera| !camera.passes).collect())
        .below("does not meet the rule");
    Plot { name: "margins".into(), figure: Figure::from(figure), table }
}
