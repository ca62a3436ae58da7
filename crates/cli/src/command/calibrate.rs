//! `hadar calibrate KIND FILE…`: what cubes tell of the camera that made them. A kind a file.

mod noise;
mod stripes;

use super::global::Global;
use clap::{Args, Subcommand};
use hadar::error::Result;
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct CalibrateArgs {
    #[command(subcommand)]
    kind: Kind,
}

#[derive(Debug, Subcommand)]
enum Kind {
    /// The noise of the samples out of the cube: photons per unit, electronic noise, variance of each band
    ///
    /// Of two or more frames of one scene by what they differ by; of a single frame of three bands or more by what neighbours differ
    /// by that other bands do not see.
    Noise(noise::NoiseArgs),
    /// Lines whose gain and offset are off, found and taken out: the cube without its stripes
    ///
    /// Lines are rows, or columns with axis = "columns" in a scenario. What is not striped stays as it is, bit by bit.
    Stripes(stripes::StripesArgs),
}

pub(super) fn run(args: &CalibrateArgs, global: &Global) -> Result<ExitCode> {
    match &args.kind {
        Kind::Noise(args) => noise::run(args, global),
        Kind::Stripes(args) => stripes::run(args, global),
    }
}
