//! `hadar size`: the verdict on a camera.

use super::{By, Global, plots, warnings_table};
use crate::error::Result;
use crate::identifiability::detection;
use crate::report::bundle::Bundle;
use crate::report::figures::{self, InformationMarks, Plot};
use crate::report::table::{Table, number, optional};
use crate::report::text;
use crate::study::{Sizing, Study};
use clap::Args;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Most alternatives that are drawn into one plot.
const DRAWN: usize = 6;

#[derive(Debug, Args)]
pub(super) struct SizeArgs {
    /// The scenario file (TOML)
    scenario: PathBuf,
    /// Exit with code 3 if the requirement is not met
    #[arg(long)]
    check: bool,
    /// The distance that decides, instead of the scenario's
    #[arg(long)]
    by: Option<By>,
}

pub(super) fn run(args: &SizeArgs, global: &Global) -> Result<ExitCode> {
    let study = global.study(&args.scenario, args.by.map(Into::into))?;
    let result = study.size()?;
    if let Some(out) = &global.out {
        global.write(&bundle(&study, &result, out)?, out)?;
    }
    global.print(&result, &text::sizing(&result, &study))?;
    let failed = args.check && result.verdict.met != Some(true);
    Ok(if failed { ExitCode::from(3) } else { ExitCode::SUCCESS })
}

/// Scenario, tables and plots.
fn bundle(study: &Study, result: &Sizing, out: &Path) -> Result<Bundle> {
    let mut bundle = Bundle::default();
    bundle.add("scenario.toml", study.scenario().to_toml_beside(out));
    bundle.add("pairs.csv", plots::pairs(&result.pairs).to_csv()?);
    bundle.add("requirement.csv", requirement(result).to_csv()?);
    if let Some(camera) = &result.camera {
        let mut table = Table::new(["line", "variance_counts2", "grows_with_integration_time_as"]);
        for line in &camera.noise_budget {
            table.push(vec![line.label.into(), number(line.var_counts), line.scaling.into()]);
        }
        bundle.add("noise_budget.csv", table.to_csv()?);
        bundle.add("solve_for.csv", solve_for(result).to_csv()?);
    }
    bundle.add("warnings.csv", warnings_table(&result.warnings).to_csv()?);
    plots::add(&mut bundle, &drawn(study, result)?)?;
    Ok(bundle)
}

/// The four plots of the limiting pair.
fn drawn(study: &Study, result: &Sizing) -> Result<Vec<Plot>> {
    let mut ranked: Vec<_> = result.pairs.iter().zip(study.alternatives()).collect();
    ranked.sort_by(|a, b| a.0.distance_nearest.total_cmp(&b.0.distance_nearest));
    let nodes = study.surroundings().nodes_cm1();
    let closest: Vec<_> = ranked.iter().take(DRAWN).map(|(_, surface)| *surface).collect();
    let mut drawn = vec![figures::emissivities(nodes, study.target(), &closest)];
    let limiting =
        result.pairs.iter().zip(study.alternatives()).find(|(pair, _)| pair.alternative == result.limiting);
    let Some((pair, surface)) = limiting else { return Ok(drawn) };
    let (target, other) = (pair.target.as_str(), pair.alternative.as_str());
    drawn.push(figures::spectra(&study.spectra(surface)?, target, other));
    let marks = InformationMarks {
        camera: match (&result.camera, pair.information_bits) {
            (Some(camera), Some(bits)) => Some((camera.camera.name.clone(), camera.photons, bits)),
            _ => None,
        },
        required_bits: detection::information_bits(study.required_distance()),
        required_distance: study.required_distance(),
    };
    let curves = study.information_curves(surface, pair.distance_nearest, pair.distance_local)?;
    drawn.push(figures::identifiability(&curves, target, other, &marks));
    if let Some(map) = study.photon_map(surface)? {
        let state = study.state();
        let here = (state.temperature_k, state.lighting.first().copied().unwrap_or(0.0));
        drawn.push(figures::photon_map(&map, target, other, here, result.requirement.by));
    }
    Ok(drawn)
}

fn requirement(result: &Sizing) -> Table {
    let mut table =
        Table::new(["reading", "distance_per_sqrt_photon", "photons", "hardware_m2_s", "decides"]);
    let pair = result.pairs.iter().find(|pair| pair.alternative == result.limiting);
    let (n, h) = (result.requirement.photons_by, result.requirement.hardware_by_m2_s);
    let distances = pair.map_or([0.0; 3], |pair| {
        [pair.distance_nearest, pair.distance_local, pair.distance_local_unknown_gain]
    });
    let readings = [
        ("nearest", n.nearest, h.nearest),
        ("local", n.local, h.local),
        ("local-unknown-gain", n.local_unknown_gain, h.local_unknown_gain),
    ];
    for ((reading, photons, hardware), distance) in readings.into_iter().zip(distances) {
        let decides = if reading == result.requirement.by { "yes" } else { "no" };
        let row = [reading.into(), number(distance), optional(photons), optional(hardware), decides.into()];
        table.push(row.to_vec());
    }
    table
}

fn solve_for(result: &Sizing) -> Table {
    let mut table = Table::new(["quantity", "value", "camera", "statistical_distance", "reason"]);
    for (quantity, solution) in result.solve_for.iter().flat_map(|solutions| &solutions.0) {
        table.push(vec![
            quantity.key().into(),
            optional(solution.value),
            number(solution.camera),
            number(solution.statistical_distance),
            solution.reason.clone().unwrap_or_default(),
        ]);
    }
    table
}
