//! `hadar size`: the verdict on a camera.

use super::global::{By, Global, condition};
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
    /// Scenario files (TOML), `-` for standard input; several give one table, a row for each
    #[arg(required = true, value_name = "SCENARIO")]
    scenarios: Vec<PathBuf>,
    /// Exit with code 3 unless the requirement is met under no condition except those of --accept; without --out a 'no' alone, by the
    /// cheapest proofs
    #[arg(long)]
    check: bool,
    /// Codes of conditions under which a 'yes' is accepted; `hadar explain CODE` explains them
    #[arg(long, value_name = "CODE", num_args = 1.., value_delimiter = ',', value_parser = condition)]
    accept: Vec<String>,
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
        // A program is given the whole answer, with skipping or without.
        && !global.json
        && global.skipping() == Skipping::On
        && let Some(result) = study.no_alone()?
    {
        global.answer(&result, &result.verdict.sentence.say(), &result.stats)?;
        return Ok(code(args, &result.verdict));
    }
    // Curves are for files and programs: nobody reads them off a terminal.
    let mut result =
        if global.out.is_some() || global.json { study.size_with_curves() } else { study.size() }?;
    result.verdict.accepted.clone_from(&args.accept);
    let text = match args.check && global.out.is_none() {
        true => size::check(&result),
        false => size::text(&result, &study),
    };
    result.stats.add(&global.report(&text, || size::bundle(&study, &result))?);
    global.answer(&result, &text, &result.stats)?;
    if global.out.is_none() && !global.json && std::io::stderr().is_terminal() {
        global.note("for plots and tables add --out DIR");
    }
    Ok(code(args, &result.verdict))
}

fn code(args: &SizeArgs, verdict: &Verdict) -> u8 {
    let met = verdict.met == Some(true) && verdict.open().next().is_none();
    if args.check && !met { 3 } else { 0 }
}
