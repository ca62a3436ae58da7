//! The command line: parse, run, print.
//!
//! Exit codes: 0 done; 1 the input is wrong (one message on stderr); 2 usage; 3 requirement not met with
//! `--check`. With `--json` stdout is one object and nothing else.

mod accuracy;
mod cameras;
mod identify;
mod materials;
mod progress;
mod range;
mod reproduce;
mod rule;
mod simulate;
mod size;

use clap::{Args, Parser, Subcommand};
use hadar::demand::{Reason, Skipping, Thing, Work};
use hadar::error::{Error, Result};
use hadar::material::Library;
use hadar_report::bundle::Bundle;
use hadar_report::text;
use hadar_study::scenario::Scenario;
use hadar_study::study::Study;
use std::io::Write as _;
use std::path::{Path, PathBuf};
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

/// Options of every command.
#[derive(Debug, Args)]
struct Global {
    /// Print one JSON object on stdout and nothing else
    #[arg(long, global = true)]
    json: bool,
    /// Write scenario, tables and plots into this folder
    #[arg(long, global = true, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Materials of your own, a folder or a file; may be given several times
    #[arg(long, global = true, value_name = "DIR")]
    library: Vec<PathBuf>,
    /// Use the materials of --library alone, not the built-in ones
    #[arg(long, global = true)]
    only_library: bool,
    /// Leave out alternatives whose spectra do not cover the bands, with a warning
    #[arg(long, global = true)]
    skip_uncovered: bool,
    /// Seed of random numbers; the same seed gives the same result, for any number of threads
    #[arg(long, global = true, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Number of threads (default: all cores); the result does not depend on it
    #[arg(long, global = true, value_name = "N")]
    threads: Option<usize>,
    /// Say on stderr what was computed, what was not, and why (with --json always under `stats`)
    #[arg(long, global = true)]
    stats: bool,
    /// Compute in full what a proof would spare; the answer is the same
    #[arg(long, global = true)]
    no_skip: bool,
    /// Print nothing on stderr but errors
    #[arg(short, long, global = true)]
    quiet: bool,
}

/// Most threads that can be asked for.
const MOST_THREADS: usize = 1024;

/// Runs the command line of this process.
#[must_use]
pub fn main() -> ExitCode {
    let cli = Cli::parse();
    if let Some(threads) = cli.global.threads {
        if threads > MOST_THREADS {
            eprintln!("error: --threads is {threads}; it must be at most {MOST_THREADS}, or 0 for all cores");
            return ExitCode::from(1);
        }
        // Fails only if a pool is there already, which is then the one that is used.
        let _ = rayon::ThreadPoolBuilder::new().num_threads(threads).build_global();
    }
    match run(&cli) {
        Ok(code) => code,
        Err(error) => {
            eprintln!("error: {error}");
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

impl Global {
    /// The embedded library with the user's own materials, and what is to be said about them.
    fn library(&self) -> Result<Library> {
        let mut library = if self.only_library { Library::empty() } else { Library::embedded()? };
        for path in &self.library {
            library.add_path(path)?;
        }
        if library.is_empty() {
            let instead = "add spectra with --library DIR, or leave out --only-library";
            return Err(Error::malformed("the library is empty", instead));
        }
        for warning in library.warnings() {
            self.note(&format!("warning: {warning}"));
        }
        Ok(library)
    }

    /// A bar on stderr for long work; nothing where stderr is no terminal, or quiet.
    fn progress(&self, what: &'static str) -> progress::Bar {
        progress::Bar::new(what, self.quiet)
    }

    /// A line on stderr, unless quiet.
    fn note(&self, text: &str) {
        if !self.quiet {
            eprintln!("{text}");
        }
    }

    /// Whether proofs may spare work.
    fn skipping(&self) -> Skipping {
        if self.no_skip { Skipping::Off } else { Skipping::On }
    }

    /// Makes and writes a report where there is a folder for it; what that took.
    fn report(&self, make: impl FnOnce(&Path) -> Result<Bundle>) -> Result<Work> {
        let mut work = Work::default();
        let Some(out) = &self.out else {
            work.spare(Thing::Reports, Reason::NotAsked, 1);
            return Ok(work);
        };
        let bundle = make(out)?;
        self.write(&bundle, out)?;
        work.compute(Thing::Reports, 1);
        work.compute(Thing::Figures, bundle.figures() as u64);
        Ok(work)
    }

    /// Prints a result that has its ledger in it, and with `--stats` the ledger.
    fn answer(&self, json: &impl serde::Serialize, text: &str, work: &Work) -> Result<()> {
        if self.stats {
            self.note(text::stats(work).trim_end());
        }
        self.print(json, text)
    }

    /// Prints a result that has no ledger in it, with `stats` beside its keys.
    fn answer_with(&self, mut json: serde_json::Value, text: &str, work: &Work) -> Result<()> {
        if let Some(object) = json.as_object_mut() {
            object.insert("stats".into(), as_json(work)?);
        }
        self.answer(&json, text, work)
    }

    /// Prints a result: JSON with `--json`, else the text.
    fn print(&self, json: &impl serde::Serialize, text: &str) -> Result<()> {
        let text = if self.json {
            serde_json::to_string_pretty(json)
                .map_err(|error| Error::malformed(error.to_string(), "report this as a bug"))?
        } else {
            text.trim_end().to_owned()
        };
        match writeln!(std::io::stdout(), "{text}") {
            // A reader that has seen enough (`| head`) is no error.
            Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
                Err(Error::file("print the result", Path::new("stdout"), error))
            }
            _ => Ok(()),
        }
    }

    fn study(&self, path: &Path, by: Option<hadar_study::scenario::DistanceKind>) -> Result<Study> {
        let mut scenario = Scenario::from_file(path)?;
        if let Some(by) = by {
            scenario.requirement.by = by;
        }
        scenario.alternatives.skip_uncovered |= self.skip_uncovered;
        Study::new(&scenario, &self.library()?)
    }

    /// Writes the files and says where.
    fn write(&self, bundle: &Bundle, out: &Path) -> Result<()> {
        bundle.write(out)?;
        let names: Vec<&str> = bundle.names().collect();
        self.note(&format!("wrote {} to {}", names.join(", "), out.display()));
        Ok(())
    }
}

/// Anything as JSON.
fn as_json(value: &impl serde::Serialize) -> Result<serde_json::Value> {
    serde_json::to_value(value).map_err(|error| Error::malformed(error.to_string(), "report this as a bug"))
}

/// The distance that decides, as a flag.
#[derive(Debug, Clone, Copy, clap::ValueEnum)]
enum By {
    /// To the nearest state of the alternative: the limit
    Nearest,
    /// The paper's local distance, calibrated camera (S27)
    Local,
    /// The paper's local distance with unknown gain (S29)
    LocalUnknownGain,
}

impl From<By> for hadar_study::scenario::DistanceKind {
    fn from(by: By) -> Self {
        match by {
            By::Nearest => Self::Nearest,
            By::Local => Self::Local,
            By::LocalUnknownGain => Self::LocalUnknownGain,
        }
    }
}
