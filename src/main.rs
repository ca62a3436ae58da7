//! The `hadar` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    hadar::cli::main()
}
