//! `hadar range`: bounds of passive ranging: by stereo from a scene or a heat cube, or by the air on the path (`signal = "air"`).

use super::decompose::FoundBad;
use super::global::{Global, condition};
use super::several;
use clap::Args;
use hadar::error::{Error, Result};
use hadar_report::range::MapFiles;
use hadar_report::{air_ranging, range};
use hadar_scenario::range::Subject;
use hadar_scenario::{AirRangingScenario, RangeScenario, RangingScenario};
use hadar_study::Condition;
use hadar_study::air_ranging::{AirPlan, AirRangingStudy};
use hadar_study::range::{MapSink, RangePlan, RangeStudy};
use hadar_study::sweep::Question;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct RangeArgs {
    /// Ranging scenarios (TOML), `-` for standard input; several give one table, a row for each
    #[arg(required = true, value_name = "SCENARIO")]
    scenarios: Vec<PathBuf>,
    /// Match noisy views N times along the scenario's lines, and whole views once: do matchers reach the bound? By air: fit N spectra
    /// at each of some distances
    #[arg(long, value_name = "N", default_value_t = 0)]
    trials: usize,
    /// Exit with code 3 unless the demand is met under no condition except those of --accept; a cube of one view and one depth is decided by
    /// the cheapest proofs alone
    #[arg(long, conflicts_with = "trials")]
    check: bool,
    /// Codes of conditions under which a 'yes' is accepted; `hadar explain CODE` explains them
    #[arg(long, value_name = "CODE", num_args = 1.., value_delimiter = ',', value_parser = condition)]
    accept: Vec<String>,
    /// What is done with pixels of a cube that are found to be bad: cube.bad of the scenario; without a cube it is refused
    #[arg(long, value_enum)]
    bad: Option<FoundBad>,
    /// By air: the N of all bands that tell most of the distance, with what no other choice can exceed
    #[arg(long, value_name = "N")]
    bands: Option<usize>,
}

pub(super) fn run(args: &RangeArgs, global: &Global) -> Result<ExitCode> {
    several::each(Question::Range, &args.scenarios, global, |path, global| one(path, args, global))
}

fn one(scenario: &Path, args: &RangeArgs, global: &Global) -> Result<u8> {
    let mut scenario = RangingScenario::from_written(&global.written(scenario)?)?;
    if let Some(bad) = args.bad {
        let found = match &mut scenario {
            RangingScenario::Stereo(scenario) => match &mut scenario.subject {
                Subject::Cube(cube) => {
                    cube.bad = bad.into();
                    None
                }
                Subject::Scene(_) => Some("--bad, but the views are rendered, and have no bad pixels"),
            },
            RangingScenario::Air(_) => Some("--bad, but ranging by air reads no cube"),
        };
        if let Some(found) = found {
            return Err(Error::malformed(found, "leave it out, or give a [cube]"));
        }
    }
    scenario.check_asked(args.trials, args.bands)?;
    match scenario {
        RangingScenario::Stereo(scenario) => by_stereo(args, global, &scenario),
        RangingScenario::Air(scenario) => by_air(args, global, &scenario),
    }
}

fn by_air(args: &RangeArgs, global: &Global, scenario: &AirRangingScenario) -> Result<u8> {
    if args.check && scenario.requirement.is_none() {
        let instead = "write [requirement] with distance_error = \"5 m\" or relative_distance_error = 0.05";
        let found = Error::malformed("--check, but nothing is demanded", instead);
        return Err(found.at(scenario.place("requirement")));
    }
    let study = AirRangingStudy::new(scenario, &global.library()?)?;
    global.inputs_are_safe()?;
    let plan = AirPlan { trials: args.trials, seed: global.seed, bands: args.bands };
    let bar = global.progress("distances");
    let mut result = study.range(&plan, &|done, total| bar.set(done, total))?;
    bar.finish();
    result.verdict.accepted.clone_from(&args.accept);
    let text = air_ranging::text(&result);
    result.stats.add(&global.report(&text, || air_ranging::bundle(&result))?);
    global.answer(&result, &text, &result.stats)?;
    let verdict = &result.verdict;
    let failed = args.check && !Condition::hold(verdict.met, &verdict.conditions, &verdict.accepted);
    Ok(if failed { 3 } else { 0 })
}

fn by_stereo(args: &RangeArgs, global: &Global, scenario: &RangeScenario) -> Result<u8> {
    let study = RangeStudy::new(scenario, &global.library()?)?;
    global.admit(study.takes())?;
    let plan = RangePlan {
        trials: args.trials,
        seed: global.seed,
        skipping: global.skipping(),
        // A report shows all windows.
        verdict_alone: args.check && global.out.is_none(),
        ..RangePlan::default()
    };
    if args.check && matches!(&scenario.subject, Subject::Cube(cube) if cube.depth.is_none()) {
        let found =
            Error::malformed("--check demands a depth error", "write depth = \"12 m\" or a file of depths");
        return Err(found.at(scenario.place("cube.depth")));
    }
    let bar = global.progress("rows and draws");
    let maps = global.scratch()?.map(MapFiles::new);
    let sink = maps.as_ref().map(|maps| maps as &dyn MapSink);
    let mut result = study.range(&plan, sink, &|done, total| bar.set(done, total))?;
    bar.finish();
    result.verdict.accepted.clone_from(&args.accept);
    let text = match plan.verdict_alone {
        true => range::verdict(&result.verdict),
        false => range::text(&result),
    };
    result.stats.add(&global.report(&text, || range::bundle(&result, maps.as_ref()))?);
    global.answer(&result, &text, &result.stats)?;
    let verdict = &result.verdict;
    let failed = args.check && !Condition::hold(verdict.met, &verdict.conditions, &verdict.accepted);
    Ok(if failed { 3 } else { 0 })
}
