//! The program `hadar-evidence`: the answers of `hadar reproduce` and `hadar accuracy`.

mod accuracy;
mod reproduce;

use hadar_cli::evidence::{self, Question};
use std::process::ExitCode;

/// Runs the command line of this process.
#[must_use]
pub fn main() -> ExitCode {
    evidence::main(|question, global| match question {
        Question::Reproduce(args) => reproduce::run(args, global),
        Question::Accuracy(args) => accuracy::run(args, global),
    })
}
