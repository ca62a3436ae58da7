//! `hadar sweep`: one question about many scenes or cameras, a row of a table for each.

mod journal;
mod work;

use self::journal::{Entry, Hashes, Journal};
use super::global::{By, Global};
use super::provenance;
use clap::Args;
use hadar::demand::Work;
use hadar::error::{Error, Result};
use hadar::inputs::{self, inputs_of};
use hadar_report::bundle::About;
use hadar_report::json;
use hadar_report::manifest::{Input, VERSION, sha256, sha256_of_file};
use hadar_report::sweep::{self, Gathered, Swept};
use hadar_report::words;
use hadar_scenario::Written;
use hadar_study::Remembered;
use hadar_study::sweep::{Asking, Axis, Cases, Plan, Question};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Mutex;

#[derive(Debug, Args)]
pub(super) struct SweepArgs {
    /// The file (TOML) whose keys are varied
    scenario: PathBuf,
    /// Vary a key: FROM..TO:COUNT or FROM..TO:COUNT:log, or values A,B,C; given several times, all combinations are rows
    #[arg(long, value_name = "KEY=VALUES")]
    vary: Vec<String>,
    /// Rows of a CSV table whose header names keys; an empty cell leaves what the file says
    #[arg(long, value_name = "CSV")]
    cases: Option<PathBuf>,
    /// What is asked of every row: size, identify, simulate, rule, range, decompose (default: what the file is for)
    #[arg(long, value_name = "NAME")]
    command: Option<String>,
    /// Columns of the answers, by their names in the command's JSON (`verdict.margin`, `camera` for all within, `pairs[0].proof`
    /// for an item of a list); without them all but lists. What no column needs is not computed
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    columns: Vec<String>,
    /// The distance that decides, instead of the scenario's
    #[arg(long)]
    by: Option<By>,
    /// Compute every n-th row alone, from the i-th on; the last shard that ends writes the table
    #[arg(long, value_name = "I/N", default_value = "1/1")]
    shard: String,
    /// Compute nothing, and write the table of the rows that are there
    #[arg(long)]
    merge: bool,
}

/// What is printed with `--json`.
#[derive(serde::Serialize)]
struct Summary<'a> {
    command: &'static str,
    rows: usize,
    answered: usize,
    failed: usize,
    /// Of all rows those that neither this run nor one before has answered, and that did not fail.
    to_go: usize,
    /// Rows that this run computed.
    computed: usize,
    /// Rows that were there.
    kept: usize,
    first_failure: Option<&'a str>,
    files: Vec<String>,
}

pub(super) fn run(args: &SweepArgs, global: &Global) -> Result<ExitCode> {
    let Some(out) = &global.out else {
        return Err(Error::malformed("there is no folder for the rows", "name one with --out DIR"));
    };
    let shard = shard(&args.shard)?;
    let file = global.written(&args.scenario)?;
    let question = match &args.command {
        Some(name) => Question::named(name.trim()).map_err(|error| error.for_key("--command"))?,
        None => Question::of(&file)?,
    };
    let axes = args.vary.iter().map(|text| Axis::parse(text)).collect::<Result<_>>()?;
    let plan = Plan::new(axes, args.cases.as_deref().map(Cases::from_file).transpose()?)?;
    if let Some(set) =
        file.settings.iter().find(|set| plan.inputs().iter().any(|varied| varied.key == set.key))
    {
        let found = Error::malformed("it is varied too", "leave out one of the two");
        return Err(found.for_key(format!("--set {}", set.key)));
    }
    plan.check(&file, &|written| question.read(written))?;
    let library = global.library()?;
    let columns = question.with_conditions(args.columns.iter().map(|name| name.trim().to_owned()));
    let remembered = Remembered::default();
    let asking = Asking {
        library: &library,
        remembered: &remembered,
        by: args.by.map(Into::into),
        skip_uncovered: global.skip_uncovered,
        skipping: global.skipping(),
        seed: global.seed,
        columns: &columns,
        voice: words::voice,
    };
    global.inputs_are_safe()?;
    let (hashes, sweep) = (Hashes::default(), common(&file, question, &asking, global)?);
    let keys: Vec<String> = (0..plan.rows()).map(|row| key(&sweep, &plan, row)).collect();
    let journal = Journal::open(out, shard)?;
    let mut done = BTreeSet::new();
    journal.read(&mut |entry| {
        if entry.error.is_none() && entry.holds(&hashes) {
            done.insert(entry.key);
        }
    })?;
    let own = |row: &usize| row % shard[1] + 1 == shard[0] && !args.merge;
    let open: Vec<usize> = (0..plan.rows()).filter(own).filter(|row| !done.contains(&keys[*row])).collect();
    let kept = keys.iter().filter(|key| done.contains(*key)).count();
    drop(done);
    let stats = Mutex::new(Work::default());
    let bar = global.progress("rows");
    let job = |index: usize| {
        let Some((row, key)) = open.get(index).and_then(|row| Some((*row, keys.get(*row)?))) else {
            return Ok(());
        };
        let written = file.with(plan.settings(row));
        let (answer, read) =
            inputs_of(|| catch_unwind(AssertUnwindSafe(|| question.answer(&written, &asking))));
        let outcome = match answer {
            Ok(Ok(answer)) => {
                if let Ok(mut stats) = stats.lock() {
                    stats.add(&answer.work);
                }
                Ok(answer.record)
            }
            Ok(Err(error)) => Err(error.to_string()),
            Err(_) => Err("the program failed in this row; report this as a bug".to_owned()),
        };
        journal.write(&Entry::new(key.clone(), &read, outcome, &hashes))
    };
    work::each(open.len(), &job, &|done, all| bar.set(done, all))?;
    bar.finish();
    let _report = journal.lock_report()?;
    let (gathered, built_in) = gathered(&journal, &plan, &keys, &hashes)?;
    let swept = Swept { question, gathered, chosen: columns };
    let stats = stats.into_inner().unwrap_or_default();
    answered(&swept, [open.len(), kept], &built_in, &stats, args, global)
}

/// Writes the table where all rows are there, or all that there are are asked for, and says what there is.
fn answered(
    swept: &Swept,
    [computed, kept]: [usize; 2],
    built_in: &BTreeMap<String, Input>,
    stats: &Work,
    args: &SweepArgs,
    global: &Global,
) -> Result<ExitCode> {
    let gathered = &swept.gathered;
    let failures: Vec<(usize, &str)> = gathered.failed().collect();
    let (rows, answered, failed) = (gathered.rows(), gathered.answered(), failures.len());
    let to_go = rows - answered - failed;
    // A table that is there is not replaced by one of nothing.
    if args.merge && to_go == rows {
        let found = format!(
            "none of the {rows} rows is there: what there is was asked of other files, flags or values"
        );
        return Err(Error::malformed(found, "run the sweep without --merge"));
    }
    let text = sweep::text(swept);
    let mut files = Vec::new();
    if let Some(out) = global.out.as_ref().filter(|_| to_go == 0 || args.merge) {
        let file = inputs::called(inputs::so_far().home().as_deref(), &args.scenario);
        let title = format!("{} of {file}", swept.question.name());
        let bundle = sweep::bundle(swept, &title)?;
        let bundle = global.formatted(&bundle)?;
        files.extend(bundle.names().map(str::to_owned));
        let mut provenance = global.provenance()?;
        provenance.inputs.retain(|input| !built_in.contains_key(&input.path));
        provenance.inputs.extend(built_in.values().cloned());
        let inputs = inputs::so_far().files;
        let about = About { answer: &text, provenance: &provenance, inputs: &inputs };
        let count = bundle.write_report(&global.folder(out), &about)?;
        global.note(&format!("wrote {count} files to {}", out.join("").display()));
    } else {
        global.note(&format!(
            "{to_go} rows are not there yet: run their shards, or write what is there with --merge"
        ));
    }
    let summary = Summary {
        command: swept.question.name(),
        rows,
        answered,
        failed,
        to_go,
        computed,
        kept,
        first_failure: failures.first().map(|(_, message)| *message),
        files,
    };
    global.answer_with(json::value(&summary)?, &text, stats)?;
    // A sweep in which nothing went well is a mistake in what all rows share.
    let lost = failed > 0 && answered == 0 && to_go == 0;
    Ok(if lost { ExitCode::from(1) } else { ExitCode::SUCCESS })
}

/// What is there of the rows, and what of the program itself it rests on; their files are noted as read.
fn gathered(
    journal: &Journal,
    plan: &Plan,
    keys: &[String],
    hashes: &Hashes,
) -> Result<(Gathered, BTreeMap<String, Input>)> {
    let mut rows: HashMap<&str, Vec<usize>> = HashMap::new();
    for (row, key) in keys.iter().enumerate() {
        rows.entry(key).or_default().push(row);
    }
    let mut gathered = Gathered::new(plan.inputs(), plan.rows());
    let mut built_in = BTreeMap::new();
    let mut files: BTreeSet<PathBuf> = BTreeSet::new();
    journal.read(&mut |entry| {
        let Some(rows) = rows.get(entry.key.as_str()).filter(|_| entry.holds(hashes)) else { return };
        files.extend(entry.files().map(Path::to_owned));
        built_in.extend(entry.built_in.iter().map(|input| (input.path.clone(), input.clone())));
        let outcome = entry.outcome();
        rows.iter().for_each(|row| gathered.put(*row, outcome.clone()));
    })?;
    files.iter().for_each(|path| inputs::file(path));
    Ok((gathered, built_in))
}

/// Which rows of how many are this run's, from 1.
fn shard(text: &str) -> Result<[usize; 2]> {
    let read = text.split_once('/').and_then(|(i, n)| Some([i.trim().parse().ok()?, n.trim().parse().ok()?]));
    read.filter(|[i, n]: &[usize; 2]| (1..=*n).contains(i)).ok_or_else(|| {
        let found = format!("`{text}` is no shard");
        Error::malformed(found, "write --shard 1/4 to --shard 4/4 for four of them").for_key("--shard")
    })
}

/// What all rows rest on: the program, the question, the files that were read so far with their content.
fn common(file: &Written, question: Question, asking: &Asking<'_>, global: &Global) -> Result<String> {
    let mut program = format!("{VERSION} {}", provenance::COMMIT);
    // What was changed since a commit has no name but its own content.
    if provenance::COMMIT.ends_with("-dirty") || provenance::COMMIT == "unknown" {
        let own = std::env::current_exe().and_then(|path| sha256_of_file(&path)).ok().flatten();
        program.push_str(&own.unwrap_or_default());
    }
    let mut parts = vec![program, question.name().to_owned(), file.text.clone()];
    let home = file
        .path
        .as_deref()
        .and_then(Path::parent)
        .map(std::path::absolute)
        .and_then(std::result::Result::ok);
    parts.push(format!("{home:?} {:?} {:?} {}", asking.by, asking.skipping, asking.skip_uncovered));
    parts.push(format!("{} {}", asking.wants("solve_for"), asking.wants("sensitivity")));
    parts.push(format!("{} {:?}", asking.seed, asking.items().collect::<Vec<_>>()));
    for path in &global.library {
        parts.push(format!("{}", path.display()));
    }
    parts.push(global.only_library.to_string());
    parts.push(format!("{:?}", file.settings));
    parts.push(format!("{:?}", file.cameras));
    // The scenario and the cases are read as text above and row by row.
    let read = inputs::so_far().files;
    let libraries = read.iter().filter(|path| global.library.iter().any(|library| path.starts_with(library)));
    for path in libraries {
        let hash =
            sha256_of_file(path).map_err(|error| Error::file("read for its hash", path, error.kind()))?;
        parts.push(format!("{} {hash:?}", path.display()));
    }
    Ok(sha256(parts.join("\0").as_bytes()))
}

/// What a row asks of whom.
fn key(common: &str, plan: &Plan, row: usize) -> String {
    let settings = plan.settings(row);
    let set = settings.iter().map(|setting| format!("\0{}={}", setting.key, setting.value));
    let mut hash = sha256(format!("{common}{}", set.collect::<String>()).as_bytes());
    // Half of it tells as many rows apart as anybody has.
    hash.truncate(32);
    hash
}
