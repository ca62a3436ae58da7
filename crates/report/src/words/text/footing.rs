//! What results rest on, and what their reader must know.

use super::numbers::listed;
use crate::words::Say;
use hadar::identifiability::decision::DecisionLaw;
use hadar::instrument::Readout;
use hadar_formats::cube::Found;
use hadar_scenario::{AtmosphereSource, DistanceKind, Nuisance, Scenario, Setting};
use hadar_study::warning::by_code;
use hadar_study::{Identification, PairResult, Study, Warning};
use std::fmt::Write as _;

/// Headings that end an answer, in this order.
pub(crate) const ASSUMPTIONS: &str = "Assumptions";
pub(crate) const WARNINGS: &str = "Warnings";

/// Last line of a block of codes: how to ask more.
pub(crate) const ASK_MORE: &str = "  hadar explain CODE: what a code means and what to do";

/// The same of a page.
pub(crate) const RESTS_ON: &str = "What this rests on";

/// What the file of a cube was read as, on a line.
pub(crate) fn read_as(found: &Found) -> String {
    format!("Cube: {found}\n\n")
}

/// An answer of several paragraphs that says first among its assumptions what stands in the place of the file's own values. One line
/// alone answers a question and tells nothing of it.
#[must_use]
pub fn with_settings(answer: &str, settings: &[Setting]) -> String {
    if settings.is_empty() || !answer.trim().contains("\n\n") {
        return answer.to_owned();
    }
    let set: Vec<String> = settings.iter().map(|one| format!("{} = {}", one.key, one.value)).collect();
    let line = format!("{ASSUMPTIONS}\n  values that replace those of the file: {}\n", set.join("; "));
    let heading = format!("\n{ASSUMPTIONS}\n");
    match answer.split_once(&heading) {
        Some((before, after)) => format!("{before}\n{line}{after}"),
        None => match answer.split_once(&format!("\n{WARNINGS}\n")) {
            Some((before, after)) => format!("{before}\n{line}{WARNINGS}\n{after}"),
            None => format!("{}\n\n{line}", answer.trim_end()),
        },
    }
}

/// What results rest on, and what the reader must know.
pub(crate) fn footing(result: &Identification, study: &Study) -> String {
    assumptions(study, of_counts(study, &result.pairs)) + &warnings(&result.warnings)
}

/// What is unknown, and what is known of it beforehand.
fn unknown(scenario: &Scenario) -> String {
    let unknown = &scenario.unknown;
    // What there is none of is neither known nor unknown.
    let there = |nuisance: &&Nuisance| {
        !scenario.environment.is_empty()
            || !matches!(nuisance, Nuisance::Lighting | Nuisance::EnvironmentTemperature)
    };
    let named = unknown.nuisances.iter().filter(there).map(|nuisance| {
        let unit = match nuisance {
            Nuisance::Temperature | Nuisance::EnvironmentTemperature => " K",
            Nuisance::Lighting | Nuisance::Gain => "",
        };
        let prior = unknown.priors.get(nuisance).map(|sigma| {
            let written = scenario.source.written(&format!("unknown.priors.{}", nuisance.name()));
            let sigma = written.map_or_else(|| format!("{sigma}{unit}"), str::to_owned);
            format!("known to +- {sigma}")
        });
        let total = unknown.lighting_total.filter(|_| *nuisance == Nuisance::Lighting);
        let total = total.map(|total| format!("total known to be {total}"));
        let known: Vec<String> = [prior, total].into_iter().flatten().collect();
        match known.as_slice() {
            [] => nuisance.name().to_owned(),
            known => format!("{} ({})", nuisance.name(), known.join(", ")),
        }
    });
    let named: Vec<String> = named.collect();
    if named.is_empty() { "nothing but the material".into() } else { named.join(", ") }
}

/// What distances take counts for, and what the one that decides is.
pub(crate) fn of_counts(study: &Study, pairs: &[PairResult]) -> &'static str {
    let few = |pair: &PairResult| pair.decided_by.is_some_and(|law| law != DecisionLaw::Gaussian);
    if pairs.iter().any(few) {
        return "small counts, decided by their exact law; two equally likely materials; its bounds are a limit, not a promise";
    }
    gaussian(study)
}

/// The same of counts that are many.
pub(crate) fn gaussian(study: &Study) -> &'static str {
    match study.scenario().requirement.by {
        DistanceKind::Nearest => {
            "counts large enough to be Gaussian; two equally likely materials; d is a limit, not a promise"
        }
        DistanceKind::Local | DistanceKind::LocalUnknownGain => {
            "counts large enough to be Gaussian; two equally likely materials; d is the paper's local distance, which is not a limit"
        }
    }
}

/// What a result rests on, its camera included; `counts` says what is assumed of them.
pub(crate) fn assumptions(study: &Study, counts: &str) -> String {
    let mut out = of_scene(study, counts);
    if let Some(camera) = study.camera() {
        let read = match camera.readout {
            Readout::Simultaneous => "every band is read by every pixel with the whole exposure",
            Readout::Sequential => "bands are exposed one after the other, each by every pixel",
            Readout::FourierTransform => {
                "all bands at once through an interferometer, one mirror position for each"
            }
            Readout::Dispersive => "all bands of a line at once, side by side; an image takes line by line",
        };
        let curved = camera.efficiency_curves.iter().any(|curve| curve.name() == "quantum_efficiency");
        let counted = match camera.quantum_efficiency {
            _ if curved => "quantum efficiency by its table".to_owned(),
            1.0 => "all photons are counted (quantum efficiency 1)".to_owned(),
            eta => format!("quantum efficiency {eta}"),
        };
        let _ = writeln!(out, "  {read}; {counted}");
    }
    out
}

/// What a result rests on whatever the camera.
pub(crate) fn of_scene(study: &Study, counts: &str) -> String {
    let scenario = study.scenario();
    let unknown = unknown(scenario);
    let bands = study.bands().bands();
    let (low, high) =
        (bands.first().map_or(0.0, |b| b.center_cm1), bands.last().map_or(0.0, |b| b.center_cm1));
    // As short as they were written, without the digits of a converted wavelength.
    let (low, high) = ((low * 100.0).round() / 100.0, (high * 100.0).round() / 100.0);
    let mut out = format!("{ASSUMPTIONS}\n");
    let _ = writeln!(out, "  unknown in addition to the material: {unknown}");
    let _ = match study.bands().len() {
        1 => writeln!(out, "  1 band centred at {low} cm^-1"),
        count => writeln!(out, "  {count} bands centred from {low} to {high} cm^-1"),
    };
    let units = study.units();
    let fills = match (scenario.target.size_m, &scenario.background) {
        (Some(size), Some(behind)) => {
            format!("of {} in front of {}", units.length(size), units.temperature(behind.temperature_k))
        }
        _ => "that fills the pixel".to_owned(),
    };
    let air = match &scenario.atmosphere {
        None => "no atmosphere on the path".to_owned(),
        Some(spec) => match &spec.source {
            AtmosphereSource::Model(name) => format!("air `{name}` on the path, without aerosol"),
            AtmosphereSource::Table(_) => "air of a table on the path".to_owned(),
        },
    };
    let around = if scenario.environment.is_empty() { ", in empty space" } else { "" };
    let _ = writeln!(out, "  opaque Lambertian target {fills}{around}, one scattering, {air}");
    let _ = writeln!(out, "  {counts}");
    let skies = study.skies_left_out();
    if !skies.is_empty() {
        let _ = writeln!(
            out,
            "  skies of the library are surroundings, not alternatives: {} omitted",
            listed(skies)
        );
    }
    out
}

pub(crate) fn warnings(warnings: &[Warning]) -> String {
    if warnings.is_empty() {
        return String::new();
    }
    let mut out = format!("{WARNINGS}\n");
    // One line per code: a whole library would otherwise bury the answer.
    for (code, said) in by_code(warnings) {
        let rest = match said.len() - 1 {
            0 => String::new(),
            more => format!(" (and {more} more of this kind, see --json)"),
        };
        let _ = writeln!(out, "  [{}] {}{rest}", code.name(), said[0].say());
    }
    let _ = writeln!(out, "{ASK_MORE}");
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_set_is_the_first_assumption() {
        let set = [Setting { key: "camera.exposure".into(), value: "5 ms".into(), by: "--set" }];
        let line = "Assumptions\n  values that replace those of the file: camera.exposure = 5 ms\n";
        for (text, expected) in [
            (
                "No.\n\nAssumptions\n  air\nWarnings\n  [x] y\n",
                format!("No.\n\n{line}  air\nWarnings\n  [x] y\n"),
            ),
            ("No.\n\na\nWarnings\n  [x] y\n", format!("No.\n\na\n{line}Warnings\n  [x] y\n")),
            ("No.\n\na\n", format!("No.\n\na\n\n{line}")),
            ("No.\n", "No.\n".into()),
        ] {
            assert_eq!(with_settings(text, &set), expected);
            assert_eq!(with_settings(text, &[]), text);
        }
    }
}
