//! `hadar decompose`: a heat cube as material, temperature and lighting of every pixel.

use super::global::Global;
use clap::Args;
use hadar::error::Result;
use hadar_estimate::decompose::{MOST_RANKED, Method};
use hadar_report::decompose;
use hadar_report::folder::Scratch;
use hadar_scenario::DecomposeScenario;
use hadar_scenario::decompose::Bad;
use hadar_study::decompose::{CANDIDATES, DecomposeStudy, Keep};
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct DecomposeArgs {
    /// The decomposition scenario (TOML): [cube], [bands], [[environment]], [library]
    scenario: PathBuf,
    /// Method of decomposition
    #[arg(long, value_enum, default_value_t = By::Ml)]
    method: By,
    /// What is done with pixels and bands that are found to be bad: cube.bad of the scenario
    #[arg(long, value_enum)]
    bad: Option<FoundBad>,
    /// Number of the most probable materials of a pixel that are written with their posteriors
    #[arg(long, value_name = "K", default_value_t = CANDIDATES as u8, value_parser = clap::value_parser!(u8).range(1..=MOST_RANKED as i64))]
    candidates: u8,
}

/// What is done with what is found to be bad, as a flag.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum FoundBad {
    /// They are left out
    LeaveOut,
    /// They are taken like all others
    Keep,
}

impl From<FoundBad> for Bad {
    fn from(bad: FoundBad) -> Self {
        match bad {
            FoundBad::LeaveOut => Self::LeaveOut,
            FoundBad::Keep => Self::Keep,
        }
    }
}

/// Methods, as a flag.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum By {
    /// Maximum likelihood of material, temperature and lighting
    Ml,
    /// The paper's inverse functions: slopes along wavenumber take the lighting away (S46, S47)
    AnalyticInverse,
    /// Temperature and emissivity alone, as if nothing were scattered
    Te,
    /// The blackbody of equal radiance in all bands together, as a thermal camera reads
    GreyBody,
}

impl From<By> for Method {
    fn from(by: By) -> Self {
        match by {
            By::Ml => Self::Ml,
            By::AnalyticInverse => Self::AnalyticInverse,
            By::Te => Self::Te,
            By::GreyBody => Self::GreyBody,
        }
    }
}

pub(super) fn run(args: &DecomposeArgs, global: &Global) -> Result<ExitCode> {
    let mut scenario = DecomposeScenario::from_written(&global.written(&args.scenario)?)?;
    scenario.cube.bad = args.bad.map_or(scenario.cube.bad, Bad::from);
    let study = DecomposeStudy::new(&scenario, &global.library()?)?.with_candidates(args.candidates.into());
    global.admit(study.takes())?;
    let scratch = match study.wants_files() {
        true => Some(global.scratch()?.map_or_else(Scratch::temporary, Ok)?),
        false => None,
    };
    let room = scratch.as_ref().map(Scratch::place);
    let keep = room.as_deref().map_or(Keep::InMemory, |room| Keep::in_files(room, study.shape()));
    let bar = global.progress("rows");
    let mut result =
        study.decompose(args.method.into(), global.skipping(), keep, &|done, total| bar.set(done, total))?;
    bar.finish();
    let text = decompose::text(&result);
    result.stats.add(&global.report(&text, || decompose::bundle(&result, room.as_deref()))?);
    global.answer(&result, &text, &result.stats)?;
    Ok(ExitCode::SUCCESS)
}
