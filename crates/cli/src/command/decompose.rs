//! `hadar decompose`: a heat cube as material, temperature and lighting of every pixel.

use super::global::Global;
use clap::Args;
use hadar::error::Result;
use hadar_report::decompose;
use hadar_study::scenario::DecomposeScenario;
use hadar_study::study::decompose::DecomposeStudy;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct DecomposeArgs {
    /// The decomposition scenario (TOML): [cube], [bands], [[environment]], [library]
    scenario: PathBuf,
}

pub(super) fn run(args: &DecomposeArgs, global: &Global) -> Result<ExitCode> {
    let scenario = DecomposeScenario::from_file(&args.scenario)?;
    let study = DecomposeStudy::new(&scenario, &global.library()?)?;
    global.inputs_are_safe()?;
    let bar = global.progress("rows");
    let mut result = study.decompose(global.skipping(), &|done, total| bar.set(done, total))?;
    bar.finish();
    let text = decompose::text(&result);
    result.stats.add(&global.report(&text, |out| decompose::bundle(&result, out))?);
    global.answer(&result, &text, &result.stats)?;
    Ok(ExitCode::SUCCESS)
}
