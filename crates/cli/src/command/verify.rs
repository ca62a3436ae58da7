//! `hadar verify FOLDER`: the command of a report given again, and every file compared. Exit codes: 0 the same, 1 not.

use super::global::{Global, Remade};
use super::{Command, dispatch, line, provenance};
use clap::Args;
use hadar::error::{Error, Result};
use hadar::inputs::inputs_of;
use hadar_report::folder::Scratch;
use hadar_report::manifest::{Provenance, sha256_of_file};
use hadar_report::verify::{Stored, text};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;

#[derive(Debug, Args)]
pub(super) struct VerifyArgs {
    /// The folder of a report (--out)
    folder: PathBuf,
    /// The folder in which the command of the report was given, from which it names its files (default: this one, else one that the
    /// report is in)
    #[arg(long, value_name = "DIR")]
    from: Option<PathBuf>,
}

pub(super) fn run(args: &VerifyArgs, global: &Global) -> Result<ExitCode> {
    let folder = std::path::absolute(&args.folder)
        .map_err(|error| Error::file("read the report", &args.folder, error.kind()))?;
    let stored = Stored::read(&folder)?;
    let (command, given) = read_again(stored.provenance()).map_err(|error| error.in_file(&folder))?;
    let scenario = scenario_of(stored.provenance());
    let base = base(args, &folder, &stored, scenario.as_deref())?;
    std::env::set_current_dir(&base)
        .map_err(|error| Error::file("give the command from", &base, error.kind()))?;
    // As it is, not as the report says.
    let was = stored.provenance().inputs.first().and_then(|input| input.sha256.clone());
    let asked = scenario.as_deref().and_then(|path| sha256_of_file(path).ok().flatten());
    let asked = asked.filter(|is| args.from.is_some() || Some(is) == was.as_ref());
    let scratch = Scratch::temporary()?;
    let made = scratch.place().join("report");
    let remade = Arc::new(Remade::new(
        stored.asked.clone().zip(scenario).map(|(text, path)| (path, text)),
        stored.provenance().clone(),
    ));
    let again = given.made_again(&made, Arc::clone(&remade), global);
    let (outcome, _) = inputs_of(|| dispatch(&command, &again));
    outcome?;
    let verified = stored.against(&folder, &made, &remade.inputs(), asked.as_deref(), provenance::COMMIT)?;
    global.print(&verified, &text(&verified))?;
    Ok(ExitCode::from(u8::from(!verified.verified)))
}

/// The command of a report, if it is one that makes reports and says nothing of where they go.
fn read_again(provenance: &Provenance) -> Result<(Command, Global)> {
    let refuse = |found: String| {
        Error::malformed(found, "name the report of a command that answers a scenario, a rule or a cube")
    };
    let said = provenance.command_line();
    let (cli, given) = super::parsed_from::<super::Cli>(&line(), &provenance.command)
        .map_err(|_| refuse(format!("its command, {said}, is none of this program")))?;
    if given.out.is_some() || given.force {
        return Err(refuse(format!("its command, {said}, says where to write, which a report never does")));
    }
    let makes_reports = match &cli.command {
        Command::Rule(args) => !args.verifies(),
        Command::Size(_)
        | Command::Identify(_)
        | Command::Range(_)
        | Command::Decompose(_)
        | Command::Library(_)
        | Command::Calibrate(_)
        | Command::Render(_)
        | Command::Simulate(_)
        | Command::Sweep(_)
        | Command::Materials(_) => true,
        _ => false,
    };
    match makes_reports {
        true => Ok((cli.command, given)),
        false => Err(refuse(format!("its command, {said}, cannot be given again from here"))),
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

/// The folder in which the command was given: one in which the file of the question is as it was; of a report without a copy of it, else one
/// in which it is.
fn base(args: &VerifyArgs, folder: &Path, stored: &Stored, scenario: Option<&Path>) -> Result<PathBuf> {
    if let Some(from) = &args.from {
        return Ok(from.clone());
    }
    let here = std::env::current_dir()
        .map_err(|error| Error::file("find the current folder", Path::new("."), error.kind()))?;
    let Some(scenario) = scenario else { return Ok(here) };
    let was = stored.provenance().inputs.first().and_then(|input| input.sha256.clone());
    let bases = || std::iter::once(here.as_path()).chain(folder.ancestors().skip(1));
    let of = |base: &Path| sha256_of_file(&base.join(scenario)).ok().flatten();
    let is_as_it_was = |base: &&Path| of(base).is_some_and(|hash| Some(hash) == was);
    let any = || bases().find(|base| of(base).is_some() && stored.asked.is_none());
    let found = bases().find(is_as_it_was).or_else(any);
    Ok(found.unwrap_or(&here).to_owned())
}
