//! `hadar calibrate blackbody`: response and offset of a spectrometer, and the radiance of a cube.

use super::super::cube_format::CubeFormatArgs;
use super::super::global::Global;
use clap::Args;
use hadar::error::Result;
use hadar_report::calibrate::blackbody;
use hadar_scenario::calibrate::BlackbodyScenario;
use hadar_study::calibrate::BlackbodyStudy;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct BlackbodyArgs {
    /// A calibration scenario (TOML): [bands], [[blackbody]], [noise], [scene]
    #[arg(value_name = "FILE")]
    file: PathBuf,
    #[command(flatten)]
    cube_format: CubeFormatArgs,
}

pub(super) fn run(args: &BlackbodyArgs, global: &Global) -> Result<ExitCode> {
    let scenario = BlackbodyScenario::from_written(&global.written(&args.file)?)?;
    let study = BlackbodyStudy::new(&scenario)?;
    global.inputs_are_safe()?;
    let mut result = study.calibrate()?;
    let text = blackbody::text(&result, args.cube_format.format());
    result.stats.add(&global.report(&text, || blackbody::bundle(&result, args.cube_format.format()))?);
    global.answer(&result, &text, &result.stats)?;
    Ok(ExitCode::SUCCESS)
}
