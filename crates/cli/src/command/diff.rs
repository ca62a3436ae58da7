//! `hadar diff A B`: two reports or answers held against each other. Exit codes are those of `diff`: 0 same, 1 different, 2 trouble.

use super::global::Global;
use super::stderr::say;
use super::terminal::Stream;
use clap::Args;
use hadar::error::Result;
use hadar_report::diff::{Difference, Side, text};
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct DiffArgs {
    /// The folder of a report (--out), or an answer as JSON (--json)
    a: PathBuf,
    /// Another one of the same kind
    b: PathBuf,
}

pub(super) fn run(args: &DiffArgs, global: &Global) -> ExitCode {
    compared(args, global).unwrap_or_else(|error| {
        say(&Stream::Err.message("error:", &error.to_string()));
        ExitCode::from(2)
    })
}

fn compared(args: &DiffArgs, global: &Global) -> Result<ExitCode> {
    let found = Difference::between(&Side::read(&args.a)?, &Side::read(&args.b)?)?;
    global.print(&found, &text(&found))?;
    Ok(ExitCode::from(u8::from(!found.same)))
}
