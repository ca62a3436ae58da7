//! Which of the flags that several commands have a command takes: those that change its answer, how it is printed, or where it goes.
//!
//! One table says it; the parser, the help and the message about a flag that a command does not take are made from it. How an answer is
//! printed may also be said before the command.

use super::global::Global;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::parser::ValueSource;
use clap::{Arg, ArgMatches, Args as _, Command, Error};

type Flags = &'static [&'static str];

/// Of whatever answers.
pub(super) const PRINTED: Flags = &["json", "stats", "threads", "quiet"];
/// Of whatever may last.
const LIMITS: Flags = &["time_limit", "memory_limit"];
const REPORT: Flags = &["out", "format", "force"];
const FOLDER: Flags = &["out", "force"];
const MATERIALS: Flags = &["library", "only_library", "strict"];
const CAMERAS: Flags = &["cameras"];
const UNCOVERED: Flags = &["skip_uncovered"];
const SEED: Flags = &["seed"];
const SKIP: Flags = &["no_skip"];
const SET: Flags = &["set", "inputs"];

/// Every command that does something, by the words that name it, with the flags that it takes beside its own.
const TAKEN: &[(&str, &[Flags])] = &[
    ("size", &[PRINTED, LIMITS, REPORT, SET, MATERIALS, CAMERAS, UNCOVERED, SKIP]),
    ("identify", &[PRINTED, LIMITS, REPORT, SET, MATERIALS, CAMERAS, UNCOVERED, SEED, SKIP]),
    ("find", &[PRINTED, LIMITS, REPORT, SET, MATERIALS, CAMERAS, UNCOVERED, SKIP]),
    ("rule", &[PRINTED, LIMITS, REPORT, SET, MATERIALS, CAMERAS, UNCOVERED, SEED, SKIP]),
    ("range", &[PRINTED, LIMITS, REPORT, SET, MATERIALS, CAMERAS, SEED, SKIP]),
    ("decompose", &[PRINTED, LIMITS, REPORT, SET, MATERIALS, CAMERAS, SKIP]),
    ("library", &[PRINTED, LIMITS, REPORT, SET, MATERIALS, CAMERAS, SEED]),
    ("calibrate blackbody", &[PRINTED, LIMITS, REPORT, SET]),
    ("calibrate response", &[PRINTED, LIMITS, REPORT, SET]),
    ("calibrate noise", &[PRINTED, LIMITS, REPORT, SET]),
    ("calibrate stripes", &[PRINTED, LIMITS, REPORT, SET]),
    ("render", &[PRINTED, LIMITS, REPORT, SET, MATERIALS, CAMERAS, SEED]),
    ("simulate", &[PRINTED, LIMITS, REPORT, SET, MATERIALS, CAMERAS, UNCOVERED, SEED, SKIP]),
    ("sweep", &[PRINTED, LIMITS, REPORT, SET, MATERIALS, CAMERAS, UNCOVERED, SEED, SKIP]),
    ("reproduce", &[PRINTED, LIMITS, REPORT, &["library", "strict"], SEED]),
    ("accuracy", &[PRINTED, LIMITS, REPORT, SEED]),
    ("materials list", &[PRINTED, MATERIALS]),
    ("materials show", &[PRINTED, MATERIALS]),
    ("materials plot", &[PRINTED, LIMITS, REPORT, MATERIALS]),
    ("materials import", &[PRINTED, LIMITS, FOLDER, &["strict"]]),
    ("cameras list", &[PRINTED, CAMERAS]),
    ("cameras show", &[PRINTED, CAMERAS]),
    ("cameras compare", &[PRINTED, CAMERAS]),
    ("serve", &[LIMITS, MATERIALS, CAMERAS, &["threads", "quiet"]]),
    ("diff", &[&["json", "quiet"]]),
    ("verify", &[&["json", "threads", "quiet"], LIMITS]),
    ("completions", &[]),
    ("man", &[FOLDER, &["quiet"]]),
    ("explain", &[&["json"]]),
    ("schema", &[]),
    ("init", &[&["json"]]),
];

fn taken(path: &str) -> impl Iterator<Item = &'static str> {
    let row = TAKEN.iter().find(|(name, _)| *name == path);
    row.into_iter().flat_map(|(_, groups)| groups.iter().copied().flatten().copied())
}

/// The command line with every flag where it belongs.
pub(crate) fn added(command: Command) -> Command {
    let flags = Global::augment_args(Command::new(""));
    let flag = |id: &str| flags.get_arguments().find(|flag| flag.get_id() == id).cloned();
    let printed: Vec<Arg> = PRINTED.iter().filter_map(|id| flag(id)).collect();
    below(command, "", &|path| taken(path).filter_map(flag).collect()).args(printed)
}

fn below(command: Command, path: &str, flags: &dyn Fn(&str) -> Vec<Arg>) -> Command {
    let names: Vec<String> = command.get_subcommands().map(|child| child.get_name().to_owned()).collect();
    if names.is_empty() {
        return command.args(flags(path));
    }
    names.into_iter().fold(command, |command, name| {
        let path = joined(path, &name);
        command.mut_subcommand(name, |child| below(child, &path, flags))
    })
}

fn joined(path: &str, name: &str) -> String {
    format!("{path} {name}").trim_start().to_owned()
}

/// What was given, before the command and behind it.
///
/// # Errors
/// A flag before a command that does not take it.
pub(super) fn given(command: &Command, root: &ArgMatches) -> Result<Global, Error> {
    let (mut path, mut leaf) = (String::new(), root);
    while let Some((name, child)) = leaf.subcommand() {
        (path, leaf) = (joined(&path, name), child);
    }
    let typed = |id: &&&str| root.value_source(id) == Some(ValueSource::CommandLine);
    if let Some(id) = PRINTED.iter().filter(typed).find(|id| taken(&path).all(|flag| flag != **id)) {
        return Err(refused(command, &format!("--{id}"), &path));
    }
    Ok(Global::of([leaf, root]))
}

/// What to say of a flag that the command does not have, where another has it; another mistake is as it was said.
pub(super) fn explained(command: &Command, error: Error, words: &[String]) -> Error {
    let Some(ContextValue::String(flag)) = error.get(ContextKind::InvalidArg) else { return error };
    if let Some(joined) = in_two_words(command, words, flag) {
        return joined;
    }
    let flag = flag.split('=').next().unwrap_or(flag);
    if error.kind() != ErrorKind::UnknownArgument || takers(command, "", flag).is_empty() {
        return error;
    }
    let (mut path, mut here) = (String::new(), command);
    for word in words {
        if let Some(child) = here.find_subcommand(word) {
            (path, here) = (joined(&path, word), child);
        }
    }
    refused(command, flag, &path)
}

/// What to say of a key and its values in two words: `--vary camera.exposure "1 ms..10 ms:3"`.
fn in_two_words(command: &Command, words: &[String], second: &str) -> Option<Error> {
    let [flag, key, values] = words.windows(3).find_map(|three| match three {
        [flag, key, values]
            if ["--vary", "--set"].contains(&flag.as_str()) && !key.contains('=') && values == second =>
        {
            Some([flag, key, values])
        }
        _ => None,
    })?;
    let said = format!("{flag}: `{key}` has no value; join key and value by `=`: {flag} {key}=\"{values}\"");
    Some(Error::raw(ErrorKind::UnknownArgument, format!("{said}\n")).with_cmd(command))
}

fn refused(command: &Command, flag: &str, path: &str) -> Error {
    let takers = takers(command, "", flag);
    let said = match path {
        "" => format!("write `{flag}` after the command that takes it: {}", takers.join(", ")),
        _ if takers.iter().any(|taker| taker == path) => {
            format!("write `{flag}` behind `hadar {path}`, not before")
        }
        _ => format!("`hadar {path}` takes no `{flag}`; what takes it: {}", takers.join(", ")),
    };
    Error::raw(ErrorKind::UnknownArgument, format!("{said}\n")).with_cmd(command)
}

/// The commands that take a flag (`--seed`, `-q`).
fn takers(command: &Command, path: &str, flag: &str) -> Vec<String> {
    let has = |arg: &Arg| {
        let long = flag.strip_prefix("--").is_some_and(|name| arg.get_long() == Some(name));
        long || (flag.len() == 2 && arg.get_short() == flag.chars().nth(1))
    };
    if !command.has_subcommands() {
        return if command.get_arguments().any(has) { vec![path.to_owned()] } else { Vec::new() };
    }
    command.get_subcommands().flat_map(|child| takers(child, &joined(path, child.get_name()), flag)).collect()
}

#[cfg(test)]
mod tests {
    use super::super::line;
    use super::*;

    fn leaves(command: &Command, path: &str) -> Vec<String> {
        if !command.has_subcommands() {
            return vec![path.to_owned()];
        }
        command.get_subcommands().flat_map(|child| leaves(child, &joined(path, child.get_name()))).collect()
    }

    #[test]
    fn every_command_has_a_row_and_every_row_a_command_and_flags_that_there_are() {
        let mut commands = leaves(&line(), "");
        let mut rows: Vec<&str> = TAKEN.iter().map(|(path, _)| *path).collect();
        commands.sort();
        rows.sort_unstable();
        assert_eq!(commands, rows);
        let flags = Global::augment_args(Command::new(""));
        let known: Vec<&str> = flags.get_arguments().map(|flag| flag.get_id().as_str()).collect();
        let used: Vec<&str> = rows.iter().flat_map(|row| taken(row)).collect();
        assert!(used.iter().all(|flag| known.contains(flag)), "{known:?}");
        assert!(known.iter().all(|flag| used.contains(flag)), "{known:?}");
        line().debug_assert();
    }
}
