//! `hadar render`: a scene as a heat cube with its truth.

use super::cube_format::CubeFormatArgs;
use super::global::Global;
use clap::{Args, ValueEnum};
use hadar::error::{Error, Result};
use hadar_report::cube_format::CubeFormat;
use hadar_report::json;
use hadar_report::render::{self, Layout};
use hadar_scenario::RenderScenario;
use hadar_study::render::{RenderPlan, RenderStudy};
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct RenderArgs {
    /// The scenario (TOML): [scene], [[object]], [bands], [camera]; a ranging scenario of a scene is one too
    scenario: PathBuf,
    /// Write expected counts, without noise
    #[arg(long)]
    no_noise: bool,
    /// How the cube and its truth lie in the folder
    #[arg(long, value_enum, default_value_t = Folders::Npy)]
    layout: Folders,
    #[command(flatten)]
    cube_format: CubeFormatArgs,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Folders {
    /// NPY files
    Npy,
    /// The folders of the HADAR database, with .mat files
    Hadar,
}

pub(super) fn run(args: &RenderArgs, global: &Global) -> Result<ExitCode> {
    if global.out.is_none() && !global.json {
        let found = "there is nowhere to write the cube to";
        return Err(Error::malformed(found, "add --out DIR"));
    }
    let (layout, format) = match (args.layout, args.cube_format.format()) {
        (Folders::Npy, format) => (Layout::Npy, format),
        (Folders::Hadar, CubeFormat::Npy) => (Layout::Hadar, CubeFormat::Npy),
        (Folders::Hadar, CubeFormat::Envi) => {
            let found = "the folders of the HADAR database have .mat files";
            return Err(Error::malformed(found, "leave --cube-format or --layout out"));
        }
    };
    let scenario = RenderScenario::from_written(&global.written(&args.scenario)?)?;
    let study = RenderStudy::new(&scenario, &global.library()?)?;
    global.admit(study.takes())?;
    let bar = global.progress("rows");
    let plan = RenderPlan { seed: (!args.no_noise).then_some(global.seed) };
    let result = study.render(plan, &|done, total| bar.set(done, total))?;
    bar.finish();
    let text = render::text(&result);
    let work = global.report(&text, || render::bundle(&result, layout, format))?;
    global.answer_with(json::value(&result)?, &text, &work)?;
    Ok(ExitCode::SUCCESS)
}
