//! `hadar find`: which camera to take.

use super::global::{Global, condition};
use clap::Args;
use hadar::error::Result;
use hadar_report::find;
use hadar_scenario::{Rule, Scenario, is_rule};
use hadar_study::find::find_for_rule;
use hadar_study::{Condition, OwnCameras};
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct FindArgs {
    /// Scenario file or rule (TOML) without a camera, with what may be chosen in [find]; `-` for standard input
    #[arg(value_name = "QUESTION")]
    question: PathBuf,
    /// Exit with code 3 unless a camera meets the requirement under no condition except those of --accept
    #[arg(long)]
    check: bool,
    /// Codes of conditions under which a 'yes' is accepted; `hadar explain CODE` explains them
    #[arg(long, value_name = "CODE", num_args = 1.., value_delimiter = ',', value_parser = condition)]
    accept: Vec<String>,
}

pub(super) fn run(args: &FindArgs, global: &Global) -> Result<ExitCode> {
    let written = global.written(&args.question)?;
    let (own, library) = (OwnCameras::from_files(&global.cameras)?, global.library()?);
    let mut found = if is_rule(&written)? {
        let mut rule = Rule::from_written(&written)?;
        rule.skip_uncovered(global.skip_uncovered);
        find_for_rule(&rule, &own, &library, global.skipping())?
    } else {
        let mut scenario = Scenario::from_written(&written)?;
        scenario.alternatives.skip_uncovered |= global.skip_uncovered;
        hadar_study::find::find(&scenario, &own, &library, global.skipping())?
    };
    let text = find::text(&found);
    let work = global.report(&text, || find::bundle(&found))?;
    found.stats.add(&work);
    global.answer(&found, &text, &found.stats)?;
    let is_open = found
        .best
        .as_ref()
        .is_none_or(|best| Condition::unaccepted(best.conditions(), &args.accept).next().is_some());
    Ok(ExitCode::from(if args.check && is_open { 3 } else { 0 }))
}
