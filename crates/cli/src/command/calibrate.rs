//! `hadar calibrate KIND FILE…`: what cubes tell of the camera that made them. A kind a file.

mod blackbody;
mod noise;
mod response;
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
    /// A spectrometer by blackbodies: response and offset of every channel with their errors, and the radiance of a cube
    ///
    /// Errors are distinguished: noise of each sample, and what is common to all pixels, by the blackbodies' noise and temperatures.
    Blackbody(blackbody::BlackbodyArgs),
    /// A camera behind a filter wheel by blackbodies: its response, how much of it is determined, and radiances behind the filters
    ///
    /// Cubes hold a band for each filter. The reference object of a scene is taken off, and the wheel's vignetting is found.
    Response(response::ResponseArgs),
    /// The noise of the samples from the cube: photons per unit, electronic noise, variance of each band
    ///
    /// From the differences of two or more frames of one scene; from a single frame of three bands or more by the differences of
    /// neighbours that other bands do not show.
    Noise(noise::NoiseArgs),
    /// Lines whose gain and offset are off, found and taken out: the cube without its stripes
    ///
    /// Lines are rows, or columns with axis = "columns" in a scenario. What is not striped stays as it is, bit by bit.
    Stripes(stripes::StripesArgs),
}

pub(super) fn run(args: &CalibrateArgs, global: &Global) -> Result<ExitCode> {
    match &args.kind {
        Kind::Blackbody(args) => blackbody::run(args, global),
        Kind::Response(args) => response::run(args, global),
        Kind::Noise(args) => noise::run(args, global),
        Kind::Stripes(args) => stripes::run(args, global),
    }
}
