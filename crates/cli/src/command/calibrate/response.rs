//! `hadar calibrate response`: the response of a camera behind a filter wheel, and radiances behind its filters.

use super::super::global::Global;
use clap::Args;
use hadar::error::Result;
use hadar_report::calibrate::response;
use hadar_scenario::calibrate::ResponseScenario;
use hadar_study::calibrate::ResponseStudy;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct ResponseArgs {
    /// A calibration scenario (TOML): [response], [[blackbody]], [noise], [scene]
    #[arg(value_name = "FILE")]
    file: PathBuf,
}

pub(super) fn run(args: &ResponseArgs, global: &Global) -> Result<ExitCode> {
    let scenario = ResponseScenario::from_written(&global.written(&args.file)?)?;
    let study = ResponseStudy::new(&scenario)?;
    global.inputs_are_safe()?;
    let mut result = study.calibrate()?;
    let text = response::text(&result);
    result.stats.add(&global.report(&text, || response::bundle(&result))?);
    global.answer(&result, &text, &result.stats)?;
    Ok(ExitCode::SUCCESS)
}
