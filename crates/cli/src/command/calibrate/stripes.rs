//! `hadar calibrate stripes`: lines whose gain and offset are off.

use super::super::global::Global;
use clap::Args;
use hadar::error::Result;
use hadar_report::calibrate::stripes;
use hadar_study::scenario::calibrate::{Frames, StripesScenario};
use hadar_study::study::calibrate::StripesStudy;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct StripesArgs {
    /// A calibration scenario (TOML): [cube], [stripes]; or the cube itself (.npy, .mat), whose rows are looked at
    #[arg(value_name = "FILE")]
    file: PathBuf,
}

pub(super) fn run(args: &StripesArgs, global: &Global) -> Result<ExitCode> {
    let scenario = match Frames::is_bare(&args.file) {
        true => StripesScenario::bare(&args.file),
        false => StripesScenario::from_file(&args.file)?,
    };
    let study = StripesStudy::new(&scenario)?;
    global.inputs_are_safe()?;
    let mut result = study.destripe()?;
    let text = stripes::text(&result);
    result.stats.add(&global.report(&text, |out| stripes::bundle(&result, out))?);
    global.answer(&result, &text, &result.stats)?;
    Ok(ExitCode::SUCCESS)
}
