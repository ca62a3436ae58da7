//! `hadar calibrate stripes`: lines whose gain and offset are off.

use super::super::cube_format::CubeFormatArgs;
use super::super::global::Global;
use clap::Args;
use hadar::error::Result;
use hadar_report::calibrate::stripes;
use hadar_scenario::calibrate::{Frames, StripesScenario};
use hadar_study::calibrate::StripesStudy;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct StripesArgs {
    /// A calibration scenario (TOML): [cube], [stripes]; or the cube itself (.npy, .hdr, .mat, …), whose rows are looked at
    #[arg(value_name = "FILE")]
    file: PathBuf,
    #[command(flatten)]
    cube_format: CubeFormatArgs,
}

pub(super) fn run(args: &StripesArgs, global: &Global) -> Result<ExitCode> {
    let scenario = match Frames::is_bare(&args.file) {
        true => {
            global.sets_nothing("a cube")?;
            StripesScenario::bare(&args.file)
        }
        false => StripesScenario::from_written(&global.written(&args.file)?)?,
    };
    let study = StripesStudy::new(&scenario)?;
    global.inputs_are_safe()?;
    let mut result = study.destripe()?;
    let text = stripes::text(&result);
    result.stats.add(&global.report(&text, || stripes::bundle(&result, args.cube_format.format()))?);
    global.answer(&result, &text, &result.stats)?;
    Ok(ExitCode::SUCCESS)
}
