//! `hadar verify FOLDER`: the command of a report given again, and every file compared. Exit codes: 0 the same, 1 not.

use super::global::{Global, Remade, day};
use super::provenance;
use clap::Args;
use hadar::error::{Error, Result};
use hadar::inputs::inputs_of;
use hadar_formats::file;
use hadar_formats::hash::{nearest_folder, sha256_of_file};
use hadar_report::folder::Scratch;
use hadar_report::manifest::{Input, Provenance};
use hadar_report::verify::{Demands, Stored, Verified, text};
use hadar_scenario::Date;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;

#[derive(Debug, Args)]
pub(super) struct VerifyArgs {
    /// The folder of a report (--out)
    folder: PathBuf,
    /// The folder that the report's inputs are in, by the names that it gives them (default: one near by in which they are as they were)
    #[arg(long, value_name = "DIR")]
    inputs: Option<PathBuf>,
    /// Demand that the statement says PASSED
    #[arg(long)]
    passed: bool,
    /// Demand that it is about this rule, with nothing set over it and no condition accepted
    #[arg(long, value_name = "RULE")]
    rule: Option<PathBuf>,
    /// Demand that it is about this day
    #[arg(long, value_name = "YYYY-MM-DD", value_parser = day)]
    on: Option<Date>,
    /// Demand that this DSSE envelope holds the statement; whether its signature is valid must be checked with the tool that made it
    #[arg(long, value_name = "FILE")]
    envelope: Option<PathBuf>,
}

impl VerifyArgs {
    /// Of a folder, without further demands.
    pub(super) fn of(folder: PathBuf, inputs: Option<PathBuf>) -> Self {
        Self { folder, inputs, passed: false, rule: None, on: None, envelope: None }
    }

    fn demands(&self) -> Result<Demands> {
        let unread = |path: &Path, kind| Error::file("read", path, kind);
        let rule = match &self.rule {
            Some(path) => {
                let hash = sha256_of_file(path).map_err(|error| unread(path, error.kind()))?;
                let hash = hash.ok_or_else(|| unread(path, ErrorKind::InvalidInput))?;
                let home = std::path::absolute(path).map_err(|error| unread(path, error.kind()))?;
                Some((hash, home.parent().map_or_else(PathBuf::new, Path::to_owned)))
            }
            None => None,
        };
        let envelope = self
            .envelope
            .as_deref()
            .map(|path| file::bytes(path, "read the DSSE envelope", LONGEST_ENVELOPE));
        let on = self.on.map(|day| day.to_string());
        Ok(Demands { passed: self.passed, rule, on, envelope: envelope.transpose()? })
    }
}

/// The longest envelope, bytes.
const LONGEST_ENVELOPE: u64 = 1 << 27;

/// What does a command as it is told.
type Run = Box<dyn Fn(&Global) -> Result<ExitCode>>;

/// A command of a report, read again.
pub(super) struct Again {
    /// Whether it is one that makes reports.
    pub(super) makes_reports: bool,
    pub(super) given: Global,
    pub(super) run: Run,
}

/// `read_again` reads the words of a command.
pub(super) fn run(
    args: &VerifyArgs,
    global: &Global,
    read_again: &dyn Fn(&[String]) -> Option<Again>,
) -> Result<ExitCode> {
    let verified = verified(args, global, read_again)?;
    global.print(&verified, &text(&verified))?;
    Ok(ExitCode::from(u8::from(!verified.verified)))
}

/// What comes of it. What is read later is read from the folder of the inputs.
pub(super) fn verified(
    args: &VerifyArgs,
    global: &Global,
    read_again: &dyn Fn(&[String]) -> Option<Again>,
) -> Result<Verified> {
    let demands = args.demands()?;
    // Named from here, and not from where the inputs are.
    let absolute = |path: &PathBuf| {
        std::path::absolute(path).map_err(|error| Error::file("read the library", path, error.kind()))
    };
    let library = global.library.iter().map(absolute).collect::<Result<Vec<_>>>()?;
    let folder = std::path::absolute(&args.folder)
        .map_err(|error| Error::file("read the report", &args.folder, error.kind()))?;
    let stored = Stored::read(&folder)?;
    let again = checked(stored.provenance(), read_again).map_err(|error| error.in_file(&folder))?;
    let scenario = scenario_of(stored.provenance());
    let base = base(args, &folder, &stored)?;
    std::env::set_current_dir(&base)
        .map_err(|error| Error::file("give the command from", &base, error.kind()))?;
    // As it is, not as the report says.
    let was = stored.provenance().inputs.first().and_then(|input| input.sha256.clone());
    let nearby = scenario.as_deref().and_then(|path| sha256_of_file(path).ok().flatten());
    let asked = nearby.clone().filter(|is| args.inputs.is_some() || Some(is) == was.as_ref());
    // What the report has word by word is what it says that it has read, wherever else that is as it was.
    let own = stored.asked_as_read.clone();
    let asked = if own.is_some() && own != was { own } else { asked.or(own) };
    let scratch = Scratch::temporary()?;
    let made = scratch.place().join("report");
    // Where the file itself is as it was, it is asked: the copy may be that of another question.
    let is_itself = scenario.is_some() && nearby.is_some() && nearby == was;
    let copy = stored.asked.clone().zip(scenario).map(|(text, path)| (path, text));
    let copy = copy.filter(|_| !is_itself);
    let remade = Arc::new(Remade::new(copy, stored.provenance().clone()));
    let given = again.given.made_again(&made, Arc::clone(&remade), global, library);
    let (outcome, _) = inputs_of(|| (again.run)(&given));
    outcome?;
    stored.against(&folder, &made, &remade.inputs(), asked.as_deref(), provenance::COMMIT, &demands)
}

/// The command of a report, if it is one that makes reports and says nothing of where they go.
fn checked(provenance: &Provenance, read_again: &dyn Fn(&[String]) -> Option<Again>) -> Result<Again> {
    let refuse = |found: String| {
        Error::malformed(found, "name the report of a command that answers a scenario, a rule or a cube")
    };
    let said = provenance.command_line();
    match read_again(&provenance.command) {
        None => Err(refuse(format!("its command, {said}, is none of this program"))),
        Some(again) if again.given.out.is_some() || again.given.force => {
            Err(refuse(format!("its command, {said}, says where to write, which a report never does")))
        }
        Some(again) if !again.makes_reports => {
            Err(refuse(format!("its command, {said}, cannot be given again from here")))
        }
        Some(again) if again.given.seed != provenance.seed => {
            Err(refuse(format!("its seed, {}, is not that of its command, {said}", provenance.seed)))
        }
        Some(again) => Ok(again),
    }
}

/// The file of the question, as the command names it.
fn scenario_of(provenance: &Provenance) -> Option<PathBuf> {
    let first = Path::new(&provenance.inputs.first()?.path);
    if first.components().count() != 1 {
        return None;
    }
    let is_it = |word: &&String| {
        Path::new(word).file_name() == first.file_name()
            || (*word == "-" && first == Path::new(hadar_scenario::STDIN))
    };
    let word = provenance.command.iter().skip(2).find(is_it)?;
    Some(if word == "-" { first.to_owned() } else { word.into() })
}

/// The folder of the report's inputs: one near the report or near this one in which all of them are as they were; else one in which all but
/// the file of the question are, of which the report has a copy; else one in which that file is. What is another there is then said.
fn base(args: &VerifyArgs, folder: &Path, stored: &Stored) -> Result<PathBuf> {
    if let Some(inputs) = &args.inputs {
        return Ok(inputs.clone());
    }
    let here = std::env::current_dir()
        .map_err(|error| Error::file("find the current folder", Path::new("."), error.kind()))?;
    let files: Vec<&Input> =
        stored.provenance().inputs.iter().filter(|input| !input.path.starts_with("built-in: ")).collect();
    let (question, others) = files.split_at(files.len().min(1));
    let are_in = |inputs: &[&Input]| {
        let is_it = |base: &Path| {
            inputs.iter().all(|input| {
                let there = sha256_of_file(&base.join(&input.path)).ok().flatten();
                there.is_some() && there == input.sha256
            })
        };
        let starts = folder.parent().into_iter().chain([here.as_path()]).filter(|_| !inputs.is_empty());
        starts.into_iter().find_map(|start| nearest_folder(start, is_it))
    };
    let found = are_in(&files).or_else(|| stored.asked.as_ref().and_then(|_| are_in(others)));
    Ok(found.or_else(|| are_in(question)).unwrap_or(here))
}
