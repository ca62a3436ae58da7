//! `hadar accuracy`: run time against error, method by method.

use crate::accuracy::brute_force::{BruteForcePlan, BruteForceReport, brute_force};
use crate::accuracy::skipping::{Skipped, skipping};
use crate::accuracy::stress::{StressPlan, StressReport, stress};
use crate::accuracy::{Chart, Continuum, Item, Order, continuum};
use crate::report;
use crate::vectors::{Topic, VERSION, topics};
use hadar::demand::{Reason, Thing, Work};
use hadar::error::{Error, Result};
use hadar_cli::Global;
use hadar_cli::evidence::AccuracyArgs;
use hadar_report::bundle::Bundle;
use hadar_report::json;
use std::process::ExitCode;
use std::time::Instant;

/// What is no chart of methods.
const CONTINUUM: &str = "continuum";
const SKIPPING: &str = "skipping";
const STRESS: &str = "stress";
/// Stress cases of a quick run.
const QUICK_CASES: u64 = 2000;
const CASES: u64 = 100_000;
const BRUTE_FORCE: &str = "brute-force";
/// Scenes of every set of unknowns; a thousand take some twenty minutes on two cores.
const SCENES: u64 = 100;
const QUICK_SCENES: u64 = 3;
/// No measurement, and no part of `all`.
const VECTORS: &str = "vectors";

/// What is printed with `--json`.
#[derive(Default, serde::Serialize)]
struct Output {
    charts: Vec<Chart>,
    #[serde(skip_serializing_if = "Option::is_none")]
    continuum: Option<Continuum>,
    #[serde(skip_serializing_if = "Option::is_none")]
    brute_force: Option<BruteForceReport>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    skipping: Vec<Skipped>,
    #[serde(skip_serializing_if = "Option::is_none")]
    stress: Option<StressReport>,
}

/// One thing to do.
#[derive(Clone, Copy, PartialEq)]
enum Task {
    Chart(Item),
    Continuum,
    BruteForce,
    Skipping,
    Stress,
}

impl Task {
    fn from_name(name: &str) -> Result<Self> {
        all().into_iter().find(|task| task.name() == name).ok_or_else(|| {
            let names: Vec<&str> = all().into_iter().map(Self::name).collect();
            let instead = format!("choose among {}, all, {VECTORS}", names.join(", "));
            Error::malformed(format!("unknown computation `{name}`"), instead)
        })
    }

    fn name(self) -> &'static str {
        match self {
            Self::Chart(item) => item.name(),
            Self::Continuum => CONTINUUM,
            Self::BruteForce => BRUTE_FORCE,
            Self::Skipping => SKIPPING,
            Self::Stress => STRESS,
        }
    }
}

pub(super) fn run(args: &AccuracyArgs, global: &Global) -> Result<ExitCode> {
    if args.items == [VECTORS] {
        return vectors(args, global);
    }
    let tasks = tasks(&args.items)?;
    given_to(&tasks, Task::Stress, "--cases", args.cases)?;
    given_to(&tasks, Task::BruteForce, "--scenes", args.scenes)?;
    given_to(&tasks, Task::BruteForce, "--scene", args.scene)?;
    let order = Order { quick: args.quick, seed: global.seed };
    let (mut output, mut bundle, mut text) =
        (Output::default(), Bundle::about(Some("Run time against error")), String::new());
    for (i, task) in tasks.iter().enumerate() {
        let start = Instant::now();
        match task {
            Task::Chart(item) => {
                let chart = item.measure(order)?;
                text.push_str(&format!("{}\n", report::text(&chart)));
                bundle.add_plots(&[report::plot(&chart)])?;
                output.charts.push(chart);
            }
            Task::Continuum => {
                let found = continuum(order)?;
                text.push_str(&format!("{}\n", report::continuum_text(&found)));
                bundle.add_plots(&[report::continuum_plot(&found)])?;
                output.continuum = Some(found);
            }
            Task::BruteForce => {
                let scenes_per_set = args.scenes.unwrap_or(if args.quick { QUICK_SCENES } else { SCENES });
                let bar = global.progress("scenes of the brute force");
                let plan = BruteForcePlan { scenes_per_set, seed: global.seed, only: args.scene };
                let found = brute_force(&plan, &|done, total| bar.set(done as usize, total as usize))?;
                bar.finish();
                text.push_str(&format!("{}\n", report::brute_force_text(&found)));
                bundle.add_table("brute_force.csv", report::brute_force_table(&found))?;
                output.brute_force = Some(found);
            }
            Task::Skipping => {
                let found = skipping(order.quick)?;
                text.push_str(&format!("{}\n", report::skipping_text(&found)));
                bundle.add_table("skipping.csv", report::skipping_table(&found))?;
                output.skipping = found;
            }
            Task::Stress => {
                let cases = args.cases.unwrap_or(if args.quick { QUICK_CASES } else { CASES });
                let bar = global.progress("stress cases");
                let plan = StressPlan { cases, seed: global.seed };
                let found = stress(&plan, &|done, total| bar.set(done as usize, total as usize))?;
                bar.finish();
                text.push_str(&format!("{}\n", report::stress_text(&found)));
                bundle.add_plots(&report::stress_plots(&found))?;
                output.stress = Some(found);
            }
        }
        let took = start.elapsed().as_secs_f64();
        global.note(&format!("{} of {}: {}, {took:.1} s", i + 1, tasks.len(), task.name()));
    }
    if let Some(out) = &global.out {
        bundle.add_table("accuracy.csv", report::table(&output.charts))?;
        bundle.add("README.md", page(&output, args.quick));
        global.write(&bundle, out, Some(&text))?;
    }
    let mut work = Work::default();
    work.compute(Thing::Sections, tasks.len() as u64);
    work.spare(Thing::Sections, Reason::NotAsked, (all().len() - tasks.len()) as u64);
    global.answer_with(json::value(&output)?, &text, &work)?;
    let failed = output.stress.is_some_and(|stress| stress.failures > 0)
        || output.brute_force.is_some_and(|found| found.failures > 0);
    Ok(if failed { ExitCode::from(3) } else { ExitCode::SUCCESS })
}

/// What is printed of the vectors with `--json`.
#[derive(serde::Serialize)]
struct Vectors {
    vectors_version: u32,
    topics: Vec<Counted>,
}

/// How many vectors there are about a topic.
#[derive(serde::Serialize)]
struct Counted {
    topic: &'static str,
    title: &'static str,
    vectors: usize,
    answers: usize,
}

/// Makes the test vectors, and with `--out` their files.
fn vectors(args: &AccuracyArgs, global: &Global) -> Result<ExitCode> {
    given_to(&[], Task::Stress, "--cases", args.cases)?;
    given_to(&[], Task::BruteForce, "--scenes", args.scenes)?;
    given_to(&[], Task::BruteForce, "--scene", args.scene)?;
    if args.quick {
        return Err(Error::malformed("`--quick` with `vectors`, of which all are made", "leave out --quick"));
    }
    let topics = topics()?;
    if let Some(out) = &global.out {
        global.write(&report::vectors_bundle(&topics), out, None)?;
    }
    let counted = |topic: &Topic| {
        let Topic { name, title, vectors, .. } = topic;
        Counted { topic: name, title, vectors: vectors.len(), answers: topic.answers() }
    };
    let output = Vectors { vectors_version: VERSION, topics: topics.iter().map(counted).collect() };
    let mut work = Work::default();
    work.compute(Thing::Sections, 1);
    work.spare(Thing::Sections, Reason::NotAsked, all().len() as u64);
    global.answer_with(json::value(&output)?, &report::vectors_text(&topics), &work)?;
    Ok(ExitCode::SUCCESS)
}

/// Refuses a number for a computation that is not asked for.
fn given_to(tasks: &[Task], of: Task, option: &str, given: Option<u64>) -> Result<()> {
    match given {
        Some(number) if !tasks.contains(&of) => {
            let found =
                format!("`{option} {number}`, which is for `{}`, and that is not asked for", of.name());
            Err(Error::malformed(found, format!("add `{}` to the names, or leave {option} out", of.name())))
        }
        _ => Ok(()),
    }
}

fn all() -> Vec<Task> {
    let others = [Task::Continuum, Task::BruteForce, Task::Skipping, Task::Stress];
    Item::ALL.map(Task::Chart).into_iter().chain(others).collect()
}

fn tasks(names: &[String]) -> Result<Vec<Task>> {
    if names.iter().any(|name| name == "all") {
        if names.len() > 1 {
            return Err(Error::malformed("`all` beside other names", "write `all` alone, or the names"));
        }
        return Ok(all());
    }
    if names.iter().any(|name| name == VECTORS) {
        return Err(Error::malformed("`vectors` beside other names", "write `vectors` alone, or the names"));
    }
    let mut tasks = Vec::new();
    for name in names {
        let task = Task::from_name(name)?;
        if !tasks.contains(&task) {
            tasks.push(task);
        }
    }
    Ok(tasks)
}

fn page(output: &Output, quick: bool) -> String {
    let made = if quick { "hadar accuracy --quick" } else { "hadar accuracy" };
    let mut page = format!(
        "# Run time against error\n\nMade by `{made}`. Times are of one thread, the least of many short runs, on whatever \
         machine this was; errors are true ones, against references named below each picture.\n\n"
    );
    page.push_str(&report::markdown(&output.charts));
    for chart in &output.charts {
        page.push_str(&format!(
            "\n## {}\n\n{}. {}\n\n![{}]({}.png)\n",
            chart.title,
            capital(&report::verdict(chart)),
            chart.remark,
            chart.title,
            chart.name
        ));
    }
    if let Some(found) = &output.continuum {
        page.push_str(&format!("\n## Bands of finite width\n\n{}\n![Error of the nearest distance over the width of bands](continuum.png)\n", report::continuum_text(found)));
    }
    if let Some(found) = &output.brute_force {
        page.push_str(&format!(
            "\n## Nearest distances against a brute force\n\n{}",
            report::brute_force_text(found)
        ));
    }
    if !output.skipping.is_empty() {
        page.push_str(&format!(
            "\n## Nothing computed in vain\n\n{}",
            report::skipping_text(&output.skipping)
        ));
    }
    if let Some(found) = &output.stress {
        page.push_str(&format!(
            "\n## Stress\n\n{}\n![Share of the answers that keep so many digits](stress_digits.png)\n\n\
             ![Digits kept over the distance from equilibrium](stress_equilibrium.png)\n",
            report::stress_text(found)
        ));
    }
    page
}

fn capital(sentence: &str) -> String {
    let mut letters = sentence.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}
