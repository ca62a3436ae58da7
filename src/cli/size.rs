//! `hadar size`: the verdict on a camera.

use super::{By, Global};
use crate::error::Result;
use crate::report::{sizing, text};
use clap::Args;
use std::io::IsTerminal as _;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct SizeArgs {
    /// The scenario file (TOML)
    scenario: PathBuf,
    /// Exit with code 3 if the requirement is not met
    #[arg(long)]
    check: bool,
    /// The distance that decides, instead of the scenario's
    #[arg(long)]
    by: Option<By>,
}

pub(super) fn run(args: &SizeArgs, global: &Global) -> Result<ExitCode> {
    let study = global.study(&args.scenario, args.by.map(Into::into))?;
    let result = study.size()?;
    if let Some(out) = &global.out {
        global.write(&sizing::bundle(&study, &result, out)?, out)?;
    }
    global.print(&result, &text::sizing(&result, &study))?;
    if global.out.is_none() && !global.json && std::io::stderr().is_terminal() {
        global.note("for plots and tables add --out DIR");
    }
    let failed = args.check && result.verdict.met != Some(true);
    Ok(if failed { ExitCode::from(3) } else { ExitCode::SUCCESS })
}
