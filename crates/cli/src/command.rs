//! The command line: parse, run, print.
//!
//! Exit codes: 0 done; 1 the input is wrong (one message on stderr); 2 usage; 3 requirement not met with
//! `--check`. With `--json` stdout is one object and nothing else.

mod accuracy;
mod cameras;
mod global;
mod identify;
mod materials;
mod progress;
mod range;
mod reproduce;
mod rule;
mod simulate;
mod size;
mod terminal;

use self::global::Global;
use self::terminal::Stream;
use clap::{Parser, Subcommand};
use hadar::error::Result;
use hadar_report::bundle::Bundle;
use std::process::ExitCode;

/// The physical limits of seeing by heat: can this thermal camera tell one material from another?
#[derive(Debug, Parser)]
#[command(name = "hadar", version, about)]
struct Cli {
    #[command(subcommand)]
    command: Command,
    #[command(flatten)]
    global: Global,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// The main job: verdict on a camera, requirement, margins, what would have to change
    Size(size::SizeArgs),
    /// What can be told apart: the target from every alternative, all materials from each other, and by which bands
    ///
    /// Without a flag: the distance from the target to every alternative, the photons it takes, and with a camera which
    /// of them it tells the target from. Flags add what else is to be computed, and can be combined.
    Identify(identify::IdentifyArgs),
    /// Which cameras meet a rule: a requirement over ranges of scenes, with a certificate that can be quoted
    Rule(rule::RuleArgs),
    /// How well depth can be measured: bounds of stereo ranging from a scene or a heat cube
    Range(range::RangeArgs),
    /// Draw spectra, train and judge classifiers, and hold them against the limit
    Simulate(simulate::SimulateArgs),
    /// The paper's figures and tables made again, with a ledger of what agrees
    Reproduce(reproduce::ReproduceArgs),
    /// Run time against error: every method of a computation over its effort, beside extended precision
    Accuracy(accuracy::AccuracyArgs),
    /// The materials: list, show, plot, import
    Materials(materials::MaterialsArgs),
    /// The known cameras: list, show, compare
    Cameras(cameras::CamerasArgs),
}

/// Most threads that can be asked for.
const MOST_THREADS: usize = 1024;

/// Runs the command line of this process.
#[must_use]
pub(crate) fn main() -> ExitCode {
    let cli = Cli::parse();
    if let Some(threads) = cli.global.threads {
        if threads > MOST_THREADS {
            let found =
                format!("--threads is {threads}; it must be at most {MOST_THREADS}, or 0 for all cores");
            eprintln!("{}", Stream::Err.message("error:", &found));
            return ExitCode::from(1);
        }
        // Fails only if a pool is there already, which is then the one that is used.
        let _ = rayon::ThreadPoolBuilder::new().num_threads(threads).build_global();
    }
    match run(&cli) {
        Ok(code) => code,
        Err(error) => {
            eprintln!("{}", Stream::Err.message("error:", &error.to_string()));
            ExitCode::from(1)
        }
    }
}

fn run(cli: &Cli) -> Result<ExitCode> {
    if let Some(out) = &cli.global.out {
        Bundle::check_destination(out)?;
    }
    match &cli.command {
        Command::Size(args) => size::run(args, &cli.global),
        Command::Identify(args) => identify::run(args, &cli.global),
        Command::Rule(args) => rule::run(args, &cli.global),
        Command::Range(args) => range::run(args, &cli.global),
        Command::Simulate(args) => simulate::run(args, &cli.global),
        Command::Reproduce(args) => reproduce::run(args, &cli.global),
        Command::Accuracy(args) => accuracy::run(args, &cli.global),
        Command::Materials(args) => materials::run(args, &cli.global),
        Command::Cameras(args) => cameras::run(args, &cli.global),
    }
}
