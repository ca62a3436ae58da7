//! `hadar identify`: distances from the target to every alternative, and all against all.

use super::{By, Global};
use crate::error::Result;
use crate::identifiability::multi::Skipping;
use crate::report::{library, text};
use crate::study::{Asked, Study};
use clap::Args;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct IdentifyArgs {
    /// The scenario file (TOML)
    scenario: PathBuf,
    /// The distance that decides, instead of the scenario's
    #[arg(long)]
    by: Option<By>,
    /// All materials against all: distances, which the camera tells apart, clusters it cannot
    #[arg(long)]
    matrix: bool,
    /// Only which materials the camera tells apart, each pair by the first proof
    #[arg(long, conflicts_with = "matrix")]
    apart: bool,
    /// How the least distance changes with the size of the library and the number of bands
    #[arg(long)]
    scaling: bool,
    /// Answer only whether the camera tells the target from every alternative; exit with code 3 if not
    #[arg(long, conflicts_with_all = ["matrix", "apart", "scaling"])]
    check: bool,
    /// Compute pairs that a cheap bound decides all the same (the answer does not change)
    #[arg(long)]
    no_skip: bool,
    /// Say on stderr what was computed and what was not
    #[arg(long)]
    stats: bool,
}

pub(super) fn run(args: &IdentifyArgs, global: &Global) -> Result<ExitCode> {
    let study = global.study(&args.scenario, args.by.map(Into::into))?;
    if args.check {
        return check(args, &study, global);
    }
    let skipping = if args.no_skip { Skipping::Off } else { Skipping::On };
    let asked = Asked { matrix: args.matrix, apart: args.apart, skipping, scaling: args.scaling };
    let answers = study.answer(&asked)?;
    if let Some(out) = &global.out {
        global.write(&library::bundle(&study, &answers, out)?, out)?;
    }
    if let (true, Some(work)) = (args.stats, answers.apart.as_ref().and_then(|apart| apart.work)) {
        global.note(&text::work(&work));
    }
    global.print(&answers, &text::answers(&answers, &study))?;
    Ok(ExitCode::SUCCESS)
}

/// The answer to one question, at the first proof.
fn check(args: &IdentifyArgs, study: &Study, global: &Global) -> Result<ExitCode> {
    let result = study.check()?;
    if args.stats {
        global.note(&text::work(&result.work));
    }
    global.print(&result, &text::check(&result, study))?;
    Ok(if result.identifiable { ExitCode::SUCCESS } else { ExitCode::from(3) })
}
