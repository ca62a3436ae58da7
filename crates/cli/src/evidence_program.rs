//! The command line of `hadar-evidence`: the two questions of [`crate::evidence`], parsed and printed as `hadar` does.

use crate::command::evidence::{HANDED_OVER_BY, PROGRAM, Question, same_build};
use crate::command::global::Global;
use crate::command::threads::on_own_stack;
use crate::command::{answered, flags, parsed_by, prepared};
use clap::{CommandFactory as _, Parser};
use hadar::error::Result;
use std::process::ExitCode;

#[derive(Debug, Parser)]
#[command(name = PROGRAM, version, about = "What answers `hadar reproduce` and `hadar accuracy`")]
struct Cli {
    #[command(subcommand)]
    question: Question,
}

/// Runs the command line of this process as `hadar-evidence`, which answers by `answer`.
#[must_use]
pub fn evidence_main(answer: impl Fn(&Question, &Global) -> Result<ExitCode> + Sync) -> ExitCode {
    on_own_stack(|| {
        answered(parsed_by::<Cli>(&flags::added(Cli::command())), |cli, global| {
            same_build(std::env::var_os(HANDED_OVER_BY))?;
            // Figures of the paper have a folder each, which their command checks.
            let _prepared = prepared(global, matches!(cli.question, Question::Accuracy(_)), true)?;
            answer(&cli.question, global)
        })
    })
}
