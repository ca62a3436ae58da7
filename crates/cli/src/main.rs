//! The program `hadar`.

use std::process::ExitCode;

fn main() -> ExitCode {
    hadar_cli::main()
}
