//! The `hadar` command: parse, run, print.

use std::process::ExitCode;

mod command;
mod reproduce;

fn main() -> ExitCode {
    command::main()
}
