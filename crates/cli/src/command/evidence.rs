//! `hadar reproduce` and `hadar accuracy`: their arguments, and the program `hadar-evidence` that answers them.
//!
//! That program contains references in 512 bits and the figures of the paper, which no other command needs, and is built
//! separately. The arguments are parsed here, so that help, manual, completions and usage errors are complete without it. Then the
//! program of that name in the folder of `hadar` is run with the same arguments. It refuses them if it was built from another
//! commit: its reports would name a commit that did not make them.

use super::provenance::COMMIT;
use clap::{Args, Subcommand};
use hadar::error::{Error, Result};
use hadar_report::manifest::VERSION;
use std::env::consts::EXE_SUFFIX;
use std::ffi::OsString;
use std::io;
use std::path::Path;
use std::process::{self, ExitCode};

/// The program.
pub(crate) const PROGRAM: &str = "hadar-evidence";
/// What builds it.
const BUILT_BY: &str = "cargo build --release -p hadar-evidence";
/// Tells the program which build of `hadar` hands over to it.
pub(crate) const HANDED_OVER_BY: &str = "HADAR_HANDED_OVER_BY";

/// What is asked of `hadar-evidence`.
#[derive(Debug, Subcommand)]
pub enum Question {
    /// The paper's figures and tables made again, with a ledger of what agrees
    Reproduce(ReproduceArgs),
    /// Run time against error: every method of a computation over its effort, compared with extended precision
    Accuracy(AccuracyArgs),
}

/// Arguments of `hadar reproduce`.
#[derive(Debug, Args)]
pub struct ReproduceArgs {
    /// Figures and tables: fig3b, figs7, fig3c, edfig1, edfig5, edfig6, edfig7, edfig8, edfig9, edfig9a, fig4, figs12, figs17, figs19,
    /// figs20, figs29, tabs5, tabs2, policy, or all of these; further studies, not in `all`: exact-probability, priors, decompose-limits,
    /// air-ranging, ftir-calibration, stripes, library-figures (with --library FILE), emissivity-from-data (with --library FOLDER),
    /// person-or-robot (with --library twice)
    #[arg(value_name = "ID", default_value = "all")]
    pub items: Vec<String>,
    /// Some of the experiments only: within a minute on two cores
    #[arg(long)]
    pub quick: bool,
}

/// Arguments of `hadar accuracy`.
#[derive(Debug, Args)]
pub struct AccuracyArgs {
    /// Computations: planck, band-integrals, local, local-near-equilibrium, nearest, nearest-hard, probability, decisions, windows,
    /// draws; continuum (what the width of bands costs); brute-force (nearest distances and their proofs held against a
    /// brute force, set of unknowns by set of unknowns); skipping (what leaving out the needless is worth); stress (generated
    /// extremes, each judged in extended precision); or all. Alone: vectors (questions with answers, for any other program to
    /// be checked by)
    #[arg(value_name = "NAME", default_value = "all")]
    pub items: Vec<String>,
    /// Fewer settings and shorter runs
    #[arg(long)]
    pub quick: bool,
    /// Stress cases (default: 100000, or 2000 with --quick)
    #[arg(long, value_name = "N")]
    pub cases: Option<u64>,
    /// Scenes of the brute force for every set of unknowns (default: 100, or 3 with --quick)
    #[arg(long, value_name = "N")]
    pub scenes: Option<u64>,
    /// One scene of the brute force again, by its number
    #[arg(long, value_name = "NUMBER", conflicts_with = "scenes")]
    pub scene: Option<u64>,
}

/// Hands the words of this process over to `hadar-evidence` in the folder of this program; its exit code.
///
/// # Errors
/// It does not exist there, or cannot be started; the message names the command that builds it.
pub(super) fn hand_over(question: &Question) -> Result<ExitCode> {
    let own = std::env::current_exe().map_err(|error| Error::file("find", Path::new("hadar"), error))?;
    let program = own.with_file_name(format!("{PROGRAM}{EXE_SUFFIX}"));
    let mut command = process::Command::new(&program);
    command.args(std::env::args_os().skip(1)).env(HANDED_OVER_BY, build());
    replaced_by(&mut command).map_err(|error| {
        let asked = match question {
            Question::Reproduce(_) => "hadar reproduce",
            Question::Accuracy(_) => "hadar accuracy",
        };
        let found = match error.kind() {
            io::ErrorKind::NotFound => format!("there is no {}", program.display()),
            _ => format!("{} cannot be run ({error})", program.display()),
        };
        Error::malformed(
            format!("`{asked}` is answered by the program {PROGRAM}, and {found}"),
            format!("build it in a clone of the repository by `{BUILT_BY}`"),
        )
    })
}

/// Which build this is: the two programs have one version and one commit.
fn build() -> String {
    format!("{VERSION}, commit {COMMIT}")
}

/// Refuses to answer for a `hadar` of another build.
pub(crate) fn same_build(handed_over_by: Option<OsString>) -> Result<()> {
    match handed_over_by {
        Some(other) if other != *build() => Err(Error::malformed(
            format!("{PROGRAM} is {}, and the `hadar` that asks it is {}", build(), other.display()),
            format!("build both again: `cargo build --release` and `{BUILT_BY}`"),
        )),
        _ => Ok(()),
    }
}

/// Signals reach the program as if it had been called itself.
#[cfg(unix)]
fn replaced_by(command: &mut process::Command) -> io::Result<ExitCode> {
    Err(std::os::unix::process::CommandExt::exec(command))
}

#[cfg(not(unix))]
fn replaced_by(command: &mut process::Command) -> io::Result<ExitCode> {
    let code = command.status()?.code().and_then(|code| u8::try_from(code).ok());
    Ok(ExitCode::from(code.unwrap_or(1)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_build_is_refused_and_nobody_is_not() {
        assert!(same_build(None).is_ok() && same_build(Some(build().into())).is_ok());
        let said = same_build(Some("0.0.9, commit abc".into())).unwrap_err().to_string();
        assert!(said.contains("is 0.0.9, commit abc") && said.contains(BUILT_BY), "{said}");
    }
}
