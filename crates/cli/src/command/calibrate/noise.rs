//! `hadar calibrate noise`: photon transfer.

use super::super::global::Global;
use clap::Args;
use hadar::error::{Error, Result};
use hadar_report::calibrate::noise;
use hadar_scenario::calibrate::{Frames, NoiseScenario};
use hadar_study::calibrate::NoiseStudy;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct NoiseArgs {
    /// A calibration scenario (TOML): [cube], [noise]; or the frames themselves (.npy, .mat)
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
}

pub(super) fn run(args: &NoiseArgs, global: &Global) -> Result<ExitCode> {
    let scenario = match args.files.as_slice() {
        [one] if !Frames::is_bare(one) => NoiseScenario::from_written(&global.written(one)?)?,
        files => match files.iter().find(|file| !Frames::is_bare(file)) {
            Some(other) => {
                let instead = "name frames (.npy, .mat) or one scenario with [cube] data = [\"frame_1.npy\", \"frame_2.npy\"]";
                return Err(Error::malformed("a scenario among several files", instead).in_file(other));
            }
            None => {
                global.sets_nothing("a cube")?;
                NoiseScenario::bare(files)
            }
        },
    };
    let study = NoiseStudy::new(&scenario)?;
    global.inputs_are_safe()?;
    let mut result = study.noise()?;
    let text = noise::text(&result);
    result.stats.add(&global.report(&text, || noise::bundle(&result))?);
    global.answer(&result, &text, &result.stats)?;
    Ok(ExitCode::SUCCESS)
}
