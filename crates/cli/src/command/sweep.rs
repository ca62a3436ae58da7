//! `hadar sweep`: one question about many scenes or cameras, a row of a table for each.

mod there;
mod work;

use self::there::{Outcome, There};
use super::decompose;
use super::global::{self, Global};
use super::provenance;
use clap::Args;
use hadar::demand::Work;
use hadar::error::{Error, Result};
use hadar::inputs::{self, inputs_of};
use hadar::stop::unless_it_panics;
use hadar_formats::hash;
use hadar_report::bundle::About;
use hadar_report::json;
use hadar_report::manifest::{Input, VERSION, sha256, sha256_of_file};
use hadar_report::sweep::{self, Basis, Gathered, Hashes, Journal, Keys, Swept};
use hadar_report::words;
use hadar_scenario::Written;
use hadar_study::Remembered;
use hadar_study::sweep::{Asking, Axis, Cases, Cell, Plan, Question};
use std::collections::{BTreeMap, BTreeSet};
use std::hash::{BuildHasher as _, RandomState};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::{Mutex, PoisonError};

#[derive(Debug, Args)]
pub(super) struct SweepArgs {
    /// The file (TOML) whose keys are varied
    scenario: PathBuf,
    /// Vary a key: FROM..TO:COUNT or FROM..TO:COUNT:log, or values A,B,C; of cube.data also a folder of cubes; given several times, all
    /// combinations are rows
    #[arg(long, value_name = "KEY=VALUES")]
    vary: Vec<String>,
    /// Rows of a CSV table whose header names keys; an empty cell leaves what the file says; the `sweep.csv`
    /// of another sweep asks its rows again
    #[arg(long, value_name = "CSV")]
    cases: Option<PathBuf>,
    /// What is asked of every row: size, identify, simulate, rule, range, decompose, library, "calibrate noise" (default: what the file
    /// is for)
    #[arg(long, value_name = "NAME")]
    command: Option<String>,
    /// Columns of the answers, by their names in the command's JSON (`verdict.margin`, `camera` for all within, `pairs[0].proof`
    /// for an item of a list); without them all but lists. What no column needs is not computed
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    columns: Vec<String>,
    /// The distance that decides, instead of the scenario's
    #[arg(long)]
    by: Option<global::By>,
    /// Method of decomposition where rows are heat cubes
    #[arg(long, value_enum, default_value_t = decompose::By::Ml)]
    method: decompose::By,
    /// Compute only every n-th row, from the i-th on; the last shard to end writes the table
    #[arg(long, value_name = "I/N", default_value = "1/1")]
    shard: String,
    /// Write the table of the rows that are there, and compute none of the others
    #[arg(long)]
    merge: bool,
    /// Rows of earlier runs and of other shards that are computed again before the table is written, taken at random: a number, or
    /// `all` of them
    #[arg(long, value_name = "N|all", default_value = "5", value_parser = recompute)]
    recompute: Recompute,
}

/// How many rows of others are computed again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Recompute {
    Some(usize),
    All,
}

fn recompute(text: &str) -> std::result::Result<Recompute, String> {
    match text.trim() {
        "all" => Ok(Recompute::All),
        number => {
            number.parse().map(Recompute::Some).map_err(|_| "write a number of rows, or all".to_owned())
        }
    }
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
    /// Rows that were there, of earlier runs or other shards.
    kept: usize,
    /// How many of these were computed again, and found the same.
    recomputed: usize,
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
    let home = args.scenario.parent().unwrap_or(Path::new(""));
    let axis = |text: &String| Axis::parse(text)?.with_cubes_of_folder(home);
    let axes = args.vary.iter().map(axis).collect::<Result<_>>()?;
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
        method: args.method.into(),
        columns: &columns,
        voice: words::voice,
    };
    global.inputs_are_safe()?;
    let hashes = Hashes::default();
    let keys = Keys::of(&common(&file, question, &asking, global)?, &plan);
    let journal = Journal::open(out, shard)?;
    let mut done = vec![false; plan.rows()];
    if args.recompute != Recompute::All {
        journal.read(&keys, &|_| true, &hashes, &mut |row| {
            if row.outcome.is_ok() && row.basis.covers(&columns) {
                row.rows.iter().for_each(|row| done[*row] = true);
            }
        })?;
    }
    let own = |row: &usize| row % shard[1] + 1 == shard[0] && !args.merge;
    let open: Vec<usize> = (0..plan.rows()).filter(own).filter(|row| !done[*row]).collect();
    drop(done);
    let stats = Mutex::new(Work::default());
    let file = file.parsed();
    let answered_anew = |row: usize| -> Result<(Basis, Outcome)> {
        let written = file.with(plan.settings(row));
        let (answer, read) = inputs_of(|| unless_it_panics(|| question.answer(&written, &asking)));
        let (outcome, is_whole) = match answer {
            Some(Ok(answer)) => {
                stats.lock().unwrap_or_else(PoisonError::into_inner).add(&answer.work);
                (Ok(answer.record), answer.is_whole)
            }
            Some(Err(error)) => (Err(error.to_string()), true),
            None => (Err("the program failed in this row; report this as a bug".to_owned()), true),
        };
        Ok((Basis::of(&read, (!is_whole).then_some(&*columns), &hashes)?, outcome))
    };
    let there = Mutex::new(There::new(Gathered::new(plan.inputs(), plan.rows())));
    let bar = global.progress("rows");
    let job = |index: usize| match open.get(index) {
        Some(row) => {
            let (key, (basis, outcome)) = (keys.of_row(*row), answered_anew(*row)?);
            let basis = journal.write(&key, basis, &outcome)?;
            there.lock().unwrap_or_else(PoisonError::into_inner).put(keys.rows(&key), &basis, &outcome);
            Ok(())
        }
        None => Ok(()),
    };
    work::each(open.len(), &job, &|done, all| bar.set(done, all))?;
    bar.finish();
    journal.lock_report();
    let mut there = there.into_inner().unwrap_or_else(PoisonError::into_inner);
    there.gather(&journal, &keys, &columns)?;
    let again = sample(&there.of_others, args.recompute);
    let same = |index: usize| match again.get(index) {
        Some(row) => is_same(*row, &there.gathered, answered_anew(*row)?.1, out),
        None => Ok(()),
    };
    work::each(again.len(), &same, &|_, _| ())?;
    let swept = Swept {
        question,
        gathered: there.gathered,
        chosen: columns,
        kept: there.of_others.len(),
        recomputed: again.len(),
    };
    let stats = stats.into_inner().unwrap_or_else(PoisonError::into_inner);
    answered(&swept, open.len(), &there.built_in, &stats, args, global)
}

/// Rows of others that are looked at again: which ones, nobody can foresee who wrote them.
fn sample(of_others: &BTreeSet<usize>, most: Recompute) -> Vec<usize> {
    let mut rows: Vec<usize> = of_others.iter().copied().collect();
    if let Recompute::Some(most) = most {
        let chance = RandomState::new();
        rows.sort_by_cached_key(|row| chance.hash_one(row));
        rows.truncate(most);
    }
    rows
}

/// Refuses rows of others, of which one is not what is found now.
fn is_same(row: usize, gathered: &Gathered, now: Outcome, out: &Path) -> Result<()> {
    let before = gathered.record(row);
    let told =
        |cell: Option<&Cell>| cell.map_or_else(|| "nothing".to_owned(), |cell| cell.to_json().to_string());
    let found = match now {
        Err(message) => format!("fails: {message}"),
        Ok(mut now) => {
            now.retain(|_, cell| *cell != Cell::Empty);
            let names = before.keys().chain(now.keys());
            let Some(name) = names.into_iter().find(|name| before.get(*name) != now.get(*name)) else {
                return Ok(());
            };
            format!("has {} where {} is found now, as `{name}`", told(before.get(name)), told(now.get(name)))
        }
    };
    let instead = "ask with --recompute all, or remove its folder .sweep: none of these rows is believed";
    let found = format!("row {row}, of an earlier run or another shard, {found}");
    Err(Error::malformed(found, instead).in_file(out))
}

/// Writes the table where all rows are there, or all that there are are asked for, and says what there is.
fn answered(
    swept: &Swept,
    computed: usize,
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
        let provenance = global.provenance_with(built_in)?;
        let inputs = inputs::so_far().paths();
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
        kept: swept.kept,
        recomputed: swept.recomputed,
        first_failure: failures.first().map(|(_, message)| *message),
        files,
    };
    // How it was found stands in no report, which is the same for any number of runs and shards.
    global.answer_with(json::value(&summary)?, &(text + &sweep::kept(swept)), stats)?;
    // A sweep in which nothing went well is a mistake in what all rows share.
    let lost = failed > 0 && answered == 0 && to_go == 0;
    Ok(if lost { ExitCode::from(1) } else { ExitCode::SUCCESS })
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
    let mut parts = vec![program, question.name().to_owned(), file.text.to_string()];
    let home = file
        .path
        .as_deref()
        .and_then(Path::parent)
        .map(std::path::absolute)
        .and_then(std::result::Result::ok);
    parts.push(format!("{home:?} {:?} {:?} {}", asking.by, asking.skipping, asking.skip_uncovered));
    parts.push(format!("{:?}", ["solve_for", "sensitivity", "verdict"].map(|part| asking.wants(part))));
    parts.push(format!("{} {} {:?}", asking.method.name(), asking.seed, asking.items().collect::<Vec<_>>()));
    for path in &global.library {
        parts.push(format!("{}", path.display()));
    }
    parts.push(global.only_library.to_string());
    parts.push(format!("{:?}", file.settings));
    parts.push(format!("{:?}", file.cameras));
    // The scenario and the cases are read as text above and row by row.
    let read = hash::of_all_read(&inputs::so_far())?;
    let libraries =
        read.iter().filter(|(path, _)| global.library.iter().any(|library| path.starts_with(library)));
    for (path, hash) in libraries {
        parts.push(format!("{} {hash}", path.display()));
    }
    Ok(sha256(parts.join("\0").as_bytes()))
}
