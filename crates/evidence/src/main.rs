//! The program `hadar-evidence`.

use std::process::ExitCode;

fn main() -> ExitCode {
    hadar_evidence::main()
}
