//! `hadar explain`: what a term of the field, a key of a file, a warning, a key of an answer or a command means; `hadar schema`: the keys for editors.

use super::global::{Global, put};
use clap::Args;
use clap::builder::PossibleValuesParser;
use hadar::error::{Error, Result};
use hadar_report::explain::{self, ExplainedCode, ExplainedKey, Reference, ResultKey, Term};
use hadar_report::json;
use hadar_scenario::keys::{self, FILES, FileKind, Place, Silent};
use hadar_study::warning::Code;
use serde::Serialize;
use std::fmt::Write as _;
use std::process::ExitCode;

/// Keys of files that are told in full; of more their meanings alone.
const IN_FULL: usize = 3;
/// Keys of an answer that are told; of more it is said how many.
const MOST_RESULTS: usize = 12;

#[derive(Debug, Args)]
pub(super) struct ExplainArgs {
    /// A term or symbol of the field (`NETD`, `gamma`, `S27`), a key of a file (`target.temperature`), a table (`envelope`), the code of a warning, a key of the JSON, a command; without it: an overview
    word: Option<String>,
    /// All terms, keys of files, codes and keys of the JSON: a long text
    #[arg(long, conflicts_with = "word")]
    all: bool,
}

#[derive(Debug, Args)]
pub(super) struct SchemaArgs {
    /// A command whose files it is for, or a kind of file; default: all of them
    #[arg(value_parser = kinds())]
    command: Option<String>,
}

/// What a word means.
#[derive(Debug, Serialize)]
struct Explained {
    /// The word that was looked up.
    word: String,
    /// Terms of the field of this name or symbol.
    terms: Vec<Term>,
    /// Keys of files that are called so.
    keys: Vec<ExplainedKey>,
    /// The warning of this code.
    warning: Option<ExplainedCode>,
    /// The condition of a verdict of this code.
    condition: Option<ExplainedCode>,
    /// What a camera falls short of by this code.
    shortfall: Option<ExplainedCode>,
    /// The reason of this code for which a rule is not passed.
    reason: Option<ExplainedCode>,
    /// Keys of answers that are called so.
    results: Vec<ResultKey>,
    /// The command of this name.
    command: Option<ExplainedCommand>,
}

/// A command.
#[derive(Debug, Serialize)]
struct ExplainedCommand {
    /// Name of the command, without `hadar`.
    name: String,
    /// The question that the command answers.
    about: String,
    /// Tables of the files that it reads.
    tables: Vec<&'static str>,
}

pub(super) fn run(args: &ExplainArgs, global: &Global, cli: &clap::Command) -> Result<ExitCode> {
    if args.all {
        let reference = explain::all();
        global.print(&reference, &reference_text(&reference))?;
        return Ok(ExitCode::SUCCESS);
    }
    let Some(word) = args.word.as_deref().map(str::trim) else {
        let (json, text) = sections();
        global.print(&json, &text)?;
        return Ok(ExitCode::SUCCESS);
    };
    let places = explain::key(word);
    let mut explained = Explained {
        word: word.to_owned(),
        terms: explain::term(word),
        keys: places.iter().map(ExplainedKey::from).collect(),
        warning: explain::code(word).map(ExplainedCode::from),
        condition: explain::called(word, explain::conditions()),
        shortfall: explain::called(word, explain::shortfalls()),
        reason: explain::called(word, explain::reasons()),
        results: explain::result(word),
        command: command(word, cli),
    };
    if explained.keys.is_empty()
        && explained.results.is_empty()
        && explained.warning.is_none()
        && explained.condition.is_none()
        && explained.shortfall.is_none()
        && explained.reason.is_none()
        && explained.command.is_none()
        && explained.terms.is_empty()
    {
        explained.terms = explain::terms_like(word);
        if explained.terms.is_empty() {
            return Err(unknown(word, cli));
        }
    }
    global.print(&explained, &text(&explained, &places))?;
    Ok(ExitCode::SUCCESS)
}

fn unknown(word: &str, cli: &clap::Command) -> Error {
    let words = explain::words();
    let is_new = |name: &&str| words.iter().all(|word| word != name);
    let commands = cli.get_subcommands().map(clap::Command::get_name).filter(is_new);
    let all = commands.chain(words.iter().map(String::as_str));
    let error = Error::unknown_name("term, key, warning or command", word, all);
    match &error {
        Error::UnknownName { nearest, .. } if nearest.is_empty() => Error::malformed(
            error.to_string(),
            "`hadar explain` gives an overview, `hadar explain --all` prints everything",
        ),
        _ => error,
    }
}

/// Prints the schema of the files of a command, or of all.
pub(super) fn schema(args: &SchemaArgs) -> Result<ExitCode> {
    let kinds: Vec<&FileKind> = match &args.command {
        None => FILES.iter().collect(),
        Some(word) => keys::kinds_of(word),
    };
    put(&json::pretty(&keys::schema(kinds))?)?;
    Ok(ExitCode::SUCCESS)
}

/// The words by which files are known: their commands, and kinds that have other names.
fn kinds() -> PossibleValuesParser {
    let all = FILES.iter().flat_map(|kind| kind.commands.iter().copied().chain([kind.name]));
    let mut words: Vec<&str> = Vec::new();
    all.for_each(|word| {
        if !words.contains(&word) {
            words.push(word);
        }
    });
    PossibleValuesParser::new(words)
}

fn command(word: &str, cli: &clap::Command) -> Option<ExplainedCommand> {
    let name = word.strip_prefix("hadar ").unwrap_or(word);
    let found = name.split_whitespace().try_fold(cli, |above, name| above.find_subcommand(name))?;
    let about = found.get_about().map(ToString::to_string).unwrap_or_default();
    let files = FILES.iter().filter(|kind| kind.commands.contains(&name));
    let mut tables: Vec<&str> = files.flat_map(|kind| kind.root.keys().map(|key| key.name)).collect();
    tables.sort_unstable();
    tables.dedup();
    (!name.is_empty()).then(|| ExplainedCommand { name: name.to_owned(), about, tables })
}

fn text(explained: &Explained, places: &[Place]) -> String {
    let mut text = String::new();
    explained.terms.iter().for_each(|term| of_term(term, &mut text));
    if let Some(ExplainedCommand { name, about, tables }) = &explained.command {
        let _ = writeln!(text, "hadar {name}: {about}");
        if !tables.is_empty() {
            let _ = writeln!(text, "  its file   {}", tables.join(", "));
        }
        let _ = writeln!(text, "  flags      hadar {name} --help\n");
    }
    if let Some(warning) = explained.warning {
        of_code("warning", warning, &mut text);
    }
    if let Some(condition) = explained.condition {
        of_code("condition", condition, &mut text);
    }
    if let Some(shortfall) = explained.shortfall {
        of_code("falls short by", shortfall, &mut text);
    }
    if let Some(reason) = explained.reason {
        of_code("not passed for", reason, &mut text);
    }
    if places.len() > IN_FULL {
        let _ = writeln!(
            text,
            "key `{}` of {} tables; one of them in full: hadar explain PATH",
            explained.word,
            places.len()
        );
        let width = places.iter().filter_map(|place| place.paths.first()).map(String::len).max().unwrap_or(0);
        for place in places {
            let path = place.paths.first().map_or("", String::as_str);
            let _ = writeln!(text, "  {path:<width$}  {}", place.key.meaning);
        }
        text.push('\n');
    } else {
        for place in places {
            in_full(place, &mut text);
        }
    }
    if !explained.results.is_empty() {
        let _ = writeln!(text, "in JSON");
        explained.results.iter().take(MOST_RESULTS).for_each(|one| of_result(*one, &mut text));
        let more = explained.results.len().saturating_sub(MOST_RESULTS);
        if more > 0 {
            let _ = writeln!(text, "  and {more} more (--json)");
        }
    }
    text
}

/// All of it, one after the other.
fn reference_text(reference: &Reference) -> String {
    let mut text = String::from("TERMS\n\n");
    reference.terms.iter().for_each(|term| of_term(term, &mut text));
    text.push_str("KEYS OF FILES\n\n");
    keys::all().iter().for_each(|place| in_full(place, &mut text));
    text.push_str("WARNINGS\n\n");
    reference.warnings.iter().for_each(|one| of_code("warning", *one, &mut text));
    text.push_str("CONDITIONS OF A VERDICT\n\n");
    reference.conditions.iter().for_each(|one| of_code("condition", *one, &mut text));
    text.push_str("WHAT A CAMERA FALLS SHORT OF\n\n");
    reference.shortfalls.iter().for_each(|one| of_code("falls short by", *one, &mut text));
    text.push_str("WHY A RULE IS NOT PASSED\n\n");
    reference.reasons.iter().for_each(|one| of_code("not passed for", *one, &mut text));
    text.push_str("KEYS OF THE JSON\n\n");
    reference.results.iter().for_each(|one| of_result(*one, &mut text));
    text
}

fn of_term(term: &Term, text: &mut String) {
    let symbol = term.typed_symbol();
    let head = if symbol.is_empty() || symbol == term.name { String::new() } else { format!(", {symbol}") };
    let _ = writeln!(text, "{}{head}\n  means      {}", term.name, term.meaning);
    if term.unit != "-" {
        let _ = writeln!(text, "  unit       {}", term.unit);
    }
    if !term.keys.is_empty() {
        let _ = writeln!(text, "  keys       {}", term.keys.join(", "));
    }
    if !term.also.is_empty() && !term.is_equation {
        let _ = writeln!(text, "  also       {}", term.also.join(", "));
    }
    let _ = writeln!(text, "  more       the guide, docs/src/{}\n", term.see);
}

fn of_code(what: &str, ExplainedCode { code, meaning, remedy }: ExplainedCode, text: &mut String) {
    let _ = writeln!(text, "{what} [{code}]\n  means      {meaning}\n  do         {remedy}\n");
}

fn of_result(ResultKey { key, of, meaning }: ResultKey, text: &mut String) {
    let _ = writeln!(text, "  {key}, of: {}\n    {meaning}", lower(of));
}

/// A phrase within a sentence.
fn lower(phrase: &str) -> String {
    let mut letters = phrase.chars();
    let second_is_small = phrase.chars().nth(1).is_none_or(|letter| !letter.is_uppercase());
    match letters.next() {
        Some(first) if second_is_small => first.to_lowercase().chain(letters).collect(),
        _ => phrase.to_owned(),
    }
}

fn in_full(place: &Place, text: &mut String) {
    let key = place.key;
    let told = ExplainedKey::from(place);
    let Some((path, also)) = place.paths.split_first() else { return };
    let _ = writeln!(text, "{path}\n  means      {}", told.meaning);
    let _ = writeln!(text, "  written    {}", told.value);
    let silent = match key.silent {
        Silent::Refused => "none: it must be stated".to_owned(),
        Silent::Is(value) => format!("{} = {value}", key.name),
        Silent::Means(words) => words.to_owned(),
    };
    let _ = writeln!(text, "  default    {silent}");
    if let Some(example) = &told.example {
        let _ = writeln!(text, "  example    {example}");
    }
    if !key.is_table() {
        let _ = writeln!(text, "  used in    {}", told.enters);
    }
    let _ = writeln!(text, "  read by    hadar {}", told.commands.join(", "));
    if !also.is_empty() {
        let _ = writeln!(text, "  also       {}", also.join(", "));
    }
    let inside = key.value.keys_inside();
    if let Some(width) = inside.iter().map(|key| key.name.len()).max() {
        let _ = writeln!(text, "  keys");
        for key in inside {
            let _ = writeln!(text, "    {:<width$}  {}", key.name, key.meaning);
        }
    }
    text.push('\n');
}

/// All that there is to be explained.
#[derive(Debug, Serialize)]
struct Sections {
    /// Kinds of files, with their tables.
    files: Vec<SectionsOfFile>,
    /// How many terms and symbols of the field are known.
    terms: usize,
    /// Codes of all warnings that exist.
    warnings: Vec<&'static str>,
    /// How many keys of answers are known.
    result_keys: usize,
}

/// A kind of file.
#[derive(Debug, Serialize)]
struct SectionsOfFile {
    /// What this kind of file describes.
    meaning: &'static str,
    /// Commands that read such a file.
    commands: &'static [&'static str],
    /// Its tables and the keys above them.
    tables: Vec<&'static str>,
}

fn sections() -> (Sections, String) {
    let of_file = |kind: &FileKind| SectionsOfFile {
        meaning: kind.root.meaning,
        commands: kind.commands,
        tables: kind.root.keys().map(|key| key.name).collect(),
    };
    let sections = Sections {
        files: FILES.iter().map(of_file).collect(),
        terms: explain::terms().count(),
        warnings: Code::ALL.iter().map(|code| code.name()).collect(),
        result_keys: explain::results().count(),
    };
    let mut text =
        String::from("hadar explain WORD says what a word means. Files, and the tables in them:\n\n");
    for file in &sections.files {
        let _ = writeln!(
            text,
            "{} (hadar {})\n  {}",
            file.meaning.trim_end_matches('.'),
            file.commands.join(", "),
            file.tables.join(", ")
        );
    }
    let _ = write!(
        text,
        "\n{} terms of the field, such as NETD, d or S27; {} codes of warnings, such as {}; {} keys of the JSON; every command.\n`hadar explain TABLE` lists its keys, `hadar init` writes a file to begin with.",
        sections.terms,
        sections.warnings.len(),
        sections.warnings.first().copied().unwrap_or_default(),
        sections.result_keys
    );
    (sections, text)
}
