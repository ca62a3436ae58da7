//! The program `hadar-evidence`: the answers of `hadar reproduce` and `hadar accuracy`.

mod accuracy;
mod reproduce;

use hadar_cli::evidence::Question;
use hadar_cli::evidence_main;
use std::process::ExitCode;

/// Runs the command line of this process.
#[must_use]
pub fn main() -> ExitCode {
    evidence_main(|question, global| match question {
        Question::Reproduce(args) => reproduce::run(args, global),
        Question::Accuracy(args) => accuracy::run(args, global),
    })
}
