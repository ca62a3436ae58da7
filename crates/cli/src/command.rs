//! The command line: parse, run, print.
//!
//! Exit codes: 0 done; 1 the input is wrong, or a limit of time or memory is exceeded (one message on stderr); 2 usage; 3 requirement not
//! met with `--check`; 130 and 143 stopped by Ctrl-C and SIGTERM. With `--json` stdout is one object and nothing else.

mod calibrate;
mod cameras;
mod certificate;
mod cube_format;
mod decompose;
mod diff;
pub mod evidence;
mod explain;
mod find;
pub(crate) mod flags;
pub(crate) mod global;
mod identify;
mod init;
mod library;
mod materials;
pub(crate) mod progress;
mod provenance;
mod range;
mod render;
mod rule;
mod serve;
mod several;
mod shell;
mod simulate;
mod size;
mod stderr;
mod stopping;
mod sweep;
mod terminal;
pub(crate) mod threads;
mod verify;

use self::global::Global;
use self::stderr::say;
use self::terminal::Stream;
use clap::{CommandFactory as _, FromArgMatches, Parser, Subcommand};
use hadar::error::{Error, Result};
use hadar::inputs::Noting;
use hadar::words::significant;
use hadar_study::budget::Watch;
use std::ffi::{OsStr, OsString};
use std::io::ErrorKind;
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

/// The physical limits of seeing by heat: can this thermal camera distinguish one material from another?
#[derive(Debug, Parser)]
#[command(name = "hadar", version, about)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Judge a camera for a task: verdict, requirement, margins, what would have to change
    Size(size::SizeArgs),
    /// What can be distinguished: the target from every alternative, all materials from each other, and by which bands
    ///
    /// Without a flag: the distance from the target to every alternative, the photons it takes, and with a camera which
    /// of them it distinguishes the target from. Flags add what else is to be computed, and can be combined.
    Identify(identify::IdentifyArgs),
    /// Which camera to take: cameras, lenses, filters and frames that meet a scenario, the cheapest first
    Find(find::FindArgs),
    /// Which cameras meet a rule: a requirement over ranges of scenes, with a certificate that can be quoted
    Rule(rule::RuleArgs),
    /// How well depth can be measured: bounds of stereo ranging from a scene or a heat cube
    Range(range::RangeArgs),
    /// Decompose a heat cube: material, temperature and lighting of every pixel, and what stays undecided
    Decompose(decompose::DecomposeArgs),
    /// Emissivities from a heat cube: a library where none was measured, with its errors
    Library(library::LibraryArgs),
    /// Calibrate a camera by blackbodies and cubes: response, radiance with its errors, noise, stripes
    Calibrate(calibrate::CalibrateArgs),
    /// Render a scene as a heat cube, with the true state of every pixel
    Render(render::RenderArgs),
    /// Draw spectra, train and judge classifiers, and compare them with the limit
    Simulate(simulate::SimulateArgs),
    /// Many scenes or cameras: vary keys of a file, with a table row for each; resumes where it stopped
    Sweep(sweep::SweepArgs),
    #[command(flatten)]
    Evidence(evidence::Question),
    /// The materials: list, show, plot, import
    Materials(materials::MaterialsArgs),
    /// The known cameras: list, show, compare
    Cameras(cameras::CamerasArgs),
    /// Compare two reports or two answers: what was asked, the verdict, figures that moved, warnings; exit code 0
    /// where they are the same, 1 where they differ, 2 where one cannot be read
    Diff(diff::DiffArgs),
    /// Make a report again from its recorded inputs and compare every file byte by byte; exit code 0 where all are the same, 1
    /// where one is not
    Verify(verify::VerifyArgs),
    /// `hadar size`, `find` and `rule` as pages in the browser of this machine: a form, the verdict, pictures that follow a slider
    Serve(serve::ServeArgs),
    /// Print the script by which a shell completes commands and flags; source it, or save it where the shell looks
    Completions(shell::CompletionsArgs),
    /// The manual page; with --out one for each command
    Man(shell::ManArgs),
    /// Explain a term, a key of a file, a warning, a key of the JSON or a command
    Explain(explain::ExplainArgs),
    /// The keys of files as a JSON schema, by which editors complete and check them
    Schema(explain::SchemaArgs),
    /// Write a commented file to begin with; it runs as it is
    Init(init::InitArgs),
}

/// Runs the command line of this process.
#[must_use]
pub fn main() -> ExitCode {
    threads::on_own_stack(|| answered(parsed_by::<Cli>(&line()), |cli, global| run(&cli.command, global)))
}

/// What a process ends with: its answer's exit code, or 1 or 2 behind a message of what is wrong.
pub(crate) fn answered<C>(
    parsed: std::result::Result<(C, Global), clap::Error>,
    run: impl FnOnce(&C, &Global) -> Result<ExitCode>,
) -> ExitCode {
    let failed = |error: Error| {
        say(&Stream::Err.message("error:", &error.to_string()));
        ExitCode::from(1)
    };
    let start = Instant::now();
    match parsed {
        Ok((cli, global)) => {
            let code = stopping::or_stopped(|| run(&cli, &global).unwrap_or_else(failed))
                .unwrap_or_else(|code| code);
            // Here alone is a time said: an answer that held one would be another each time.
            if global.stats {
                global.note(&format!("time: {} s", significant(start.elapsed().as_secs_f64(), 2)));
            }
            code
        }
        // What is wrong goes to stderr, where nobody need listen; what was asked for, such as --help, does not.
        Err(usage) => match usage.print() {
            Err(error) if !usage.use_stderr() && error.kind() != ErrorKind::BrokenPipe => {
                failed(Error::file("print the help", Path::new("stdout"), error))
            }
            _ => ExitCode::from(usage.exit_code() as u8),
        },
    }
}

/// The whole command line.
fn line() -> clap::Command {
    flags::added(Cli::command())
}

/// The words of this process, read by a command line.
pub(crate) fn parsed_by<C: FromArgMatches>(
    line: &clap::Command,
) -> std::result::Result<(C, Global), clap::Error> {
    parsed_from(line, &std::env::args_os().collect::<Vec<_>>())
}

/// Words read by a command line, the first of which is the program's name.
fn parsed_from<C: FromArgMatches>(
    line: &clap::Command,
    words: &[impl Into<OsString> + Clone + AsRef<OsStr>],
) -> std::result::Result<(C, Global), clap::Error> {
    let found = line.clone().try_get_matches_from(words).map_err(|error| {
        let words = words.iter().skip(1).map(|word| word.as_ref().to_string_lossy().into_owned());
        flags::explained(line, error, &words.collect::<Vec<_>>())
    })?;
    let global = flags::given(line, &found)?;
    Ok((C::from_arg_matches(&found)?, global))
}

/// What lasts as long as a command: the list of what it reads, and who watches over its limits.
pub(crate) struct Prepared {
    _noting: Noting,
    _watch: Option<Watch>,
}

/// Starts the threads, the list of what is read, and unless its questions have limits of their own the watch over the limits; with
/// `checks_out` refuses a folder that a report may not be written to.
pub(crate) fn prepared(global: &Global, checks_out: bool, watched: bool) -> Result<Prepared> {
    if let Some(threads) = global.threads.filter(|threads| *threads > threads::MOST) {
        let expected = format!("at most {}, or 0 for all cores", threads::MOST);
        return Err(Error::out_of_range("--threads", threads as f64, "", expected));
    }
    threads::start(global.threads, global.quiet);
    let watch = watched.then(|| stopping::begin(global.limits)).transpose()?;
    let noting = Noting::open();
    if let Some(out) = global.out.as_ref().filter(|_| checks_out) {
        global.folder(out).check()?;
    }
    Ok(Prepared { _noting: noting, _watch: watch })
}

fn run(command: &Command, global: &Global) -> Result<ExitCode> {
    let _prepared = match command {
        // The program that answers does so itself.
        Command::Evidence(_) => None,
        // A signal ends the page, and limits are those of each of its questions.
        Command::Serve(_) => Some(prepared(global, true, false)?),
        _ => Some(prepared(global, true, true)?),
    };
    dispatch(command, global)
}

/// The command of a report, by its words.
fn read_again(words: &[String]) -> Option<verify::Again> {
    let (Cli { command }, given) = parsed_from::<Cli>(&line(), words).ok()?;
    let makes_reports = match &command {
        Command::Rule(args) => !args.verifies(),
        // It would write where the report says.
        Command::Simulate(args) => !args.saves_models(),
        Command::Size(_)
        | Command::Identify(_)
        | Command::Find(_)
        | Command::Range(_)
        | Command::Decompose(_)
        | Command::Library(_)
        | Command::Calibrate(_)
        | Command::Render(_)
        | Command::Sweep(_)
        | Command::Materials(_) => true,
        _ => false,
    };
    let run = Box::new(move |global: &Global| dispatch(&command, global));
    Some(verify::Again { makes_reports, given, run })
}

/// Does what a command says, where all is prepared.
fn dispatch(command: &Command, global: &Global) -> Result<ExitCode> {
    match command {
        Command::Size(args) => size::run(args, global),
        Command::Identify(args) => identify::run(args, global),
        Command::Find(args) => find::run(args, global),
        Command::Rule(args) => rule::run(args, global, &read_again),
        Command::Range(args) => range::run(args, global),
        Command::Decompose(args) => decompose::run(args, global),
        Command::Library(args) => library::run(args, global),
        Command::Calibrate(args) => calibrate::run(args, global),
        Command::Render(args) => render::run(args, global),
        Command::Simulate(args) => simulate::run(args, global),
        Command::Sweep(args) => sweep::run(args, global),
        Command::Evidence(question) => evidence::hand_over(question),
        Command::Materials(args) => materials::run(args, global),
        Command::Cameras(args) => cameras::run(args, global),
        Command::Diff(args) => Ok(diff::run(args, global)),
        Command::Verify(args) => verify::run(args, global, &read_again),
        Command::Serve(args) => serve::run(args, global),
        Command::Completions(args) => shell::completions(args, line()),
        Command::Man(_) => shell::man(line(), global),
        Command::Explain(args) => explain::run(args, global, &line()),
        Command::Schema(args) => explain::schema(args),
        Command::Init(args) => init::run(args, global),
    }
}
