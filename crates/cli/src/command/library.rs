//! `hadar library`: emissivities out of a heat cube, without a library.

use super::decompose::FoundBad;
use super::global::Global;
use clap::Args;
use hadar::error::Result;
use hadar_report::library;
use hadar_scenario::LibraryScenario;
use hadar_scenario::decompose::Bad;
use hadar_study::library::LibraryStudy;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct LibraryArgs {
    /// What the library is made from (TOML): [cube], [bands], [[environment]], [clusters]
    scenario: PathBuf,
    /// What is done with pixels and bands that are found to be bad: cube.bad of the scenario
    #[arg(long, value_enum)]
    bad: Option<FoundBad>,
}

pub(super) fn run(args: &LibraryArgs, global: &Global) -> Result<ExitCode> {
    LibraryScenario::check_path(&args.scenario)?;
    let mut scenario = LibraryScenario::from_written(&global.written(&args.scenario)?)?;
    scenario.cube.bad = args.bad.map_or(scenario.cube.bad, Bad::from);
    let library_of_program = global.library()?;
    let study = LibraryStudy::new(&scenario, &library_of_program)?;
    global.admit(study.takes())?;
    let bar = global.progress("rows");
    let mut result = study.library(&library_of_program, global.seed, &|done, total| bar.set(done, total))?;
    bar.finish();
    let text = library::text(&result);
    result.stats.add(&global.report(&text, || library::bundle(&result))?);
    global.answer(&result, &text, &result.stats)?;
    Ok(ExitCode::SUCCESS)
}
