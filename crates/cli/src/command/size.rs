//! `hadar size`: the verdict on a camera.

use super::global::{By, Global};
use super::several;
use clap::Args;
use hadar::demand::Skipping;
use hadar::error::Result;
use hadar_report::size;
use hadar_report::words::Say;
use hadar_study::Verdict;
use hadar_study::sweep::Question;
use std::io::IsTerminal as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct SizeArgs {
    /// Scenario files (TOML), `-` for standard input; of several one table, a row for each
    #[arg(required = true, value_name = "SCENARIO")]
    scenarios: Vec<PathBuf>,
    /// Exit with code 3 if the requirement is not met; without --out the answer alone, by the cheapest proofs
    #[arg(long)]
    check: bool,
    /// The distance that decides, instead of the scenario's
    #[arg(long)]
    by: Option<By>,
}

pub(super) fn run(args: &SizeArgs, global: &Global) -> Result<ExitCode> {
    several::each(Question::Size, &args.scenarios, global, |path, global| one(path, args, global))
}

fn one(scenario: &Path, args: &SizeArgs, global: &Global) -> Result<u8> {
    let study = global.study(scenario, args.by.map(Into::into))?;
    if args.check
        && global.out.is_none()
        && global.skipping() == Skipping::On
        && let Some(result) = study.verdict_alone()?
    {
        global.answer(&result, &result.verdict.sentence.say(), &result.stats)?;
        return Ok(code(args, &result.verdict));
    }
    // Curves are for files and programs: nobody reads them off a terminal.
    let mut result =
        if global.out.is_some() || global.json { study.size_with_curves() } else { study.size() }?;
    let text = size::text(&result, &study);
    result.stats.add(&global.report(&text, |out| size::bundle(&study, &result, out))?);
    global.answer(&result, &text, &result.stats)?;
    if global.out.is_none() && !global.json && std::io::stderr().is_terminal() {
        global.note("for plots and tables add --out DIR");
    }
    Ok(code(args, &result.verdict))
}

fn code(args: &SizeArgs, verdict: &Verdict) -> u8 {
    if args.check && verdict.met != Some(true) { 3 } else { 0 }
}
