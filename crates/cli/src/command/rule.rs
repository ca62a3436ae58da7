//! `hadar rule`: which cameras meet a rule.

use super::global::Global;
use clap::Args;
use hadar::demand::Work;
use hadar::error::{Error, Result};
use hadar_report::manifest::Input;
use hadar_report::rule;
use hadar_study::scenario::rule::{Citation, Figure};
use hadar_study::scenario::{Date, Rule, day};
use hadar_study::study::{Extent, RuleAnswer, RuleAsked, RuleStudy, TestResult};
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct RuleArgs {
    /// The rule file (TOML): a scenario with [envelope], cameras = [...] or [[camera]] tables, and [rule]
    rule: PathBuf,
    /// Exit with code 3 unless every camera meets the rule; without --out a line a camera, each decided by the first scene that
    /// does
    #[arg(long)]
    check: bool,
    /// With --check: one camera that meets the rule is enough
    #[arg(long, requires = "check")]
    any: bool,
    /// Run the tests of the rule, [[test]]: exit with code 3 unless all of them hold
    #[arg(long, conflicts_with_all = ["check", "sources"])]
    test: bool,
    /// Say where every figure of the rule is from, [[source]]
    #[arg(long, conflicts_with = "check")]
    sources: bool,
    /// Ask about a day: a rule that does not hold on it says so
    #[arg(long, value_name = "YYYY-MM-DD", value_parser = on)]
    on: Option<Date>,
}

fn on(text: &str) -> std::result::Result<Date, String> {
    day(text).ok_or_else(|| "write year, month and day, as in 2029-09-01".to_owned())
}

pub(super) fn run(args: &RuleArgs, global: &Global) -> Result<ExitCode> {
    let mut rule_read = Rule::from_file(&args.rule)?;
    rule_read.scenario.alternatives.skip_uncovered |= global.skip_uncovered;
    if args.sources {
        return sources(&rule_read, global);
    }
    if args.test {
        global.writes_nothing("--test")?;
    }
    if args.test && rule_read.tests.is_empty() {
        let instead = "write [[test]] with camera = \"flir-a325sc\" and verdict = \"fails\"";
        let error = Error::malformed("the rule has no tests", instead);
        return Err(error.at(rule_read.scenario.place("")));
    }
    let study = RuleStudy::new(&rule_read, &global.library()?)?;
    global.inputs_are_safe()?;
    let extent = match args.test {
        true => Extent::Margins,
        false if args.check && global.out.is_none() => Extent::Verdicts,
        false => Extent::Everything,
    };
    let asked = RuleAsked { extent, skipping: global.skipping(), seed: global.seed, on: args.on };
    let bar = global.progress("pairs");
    let mut answer = study.answer(&asked, &|done, all| bar.set(done, all))?;
    bar.finish();
    if args.test {
        return tested(&answer, global);
    }
    let text = if extent == Extent::Verdicts { rule::check(&answer) } else { rule::text(&answer, &study) };
    let provenance = global.provenance()?;
    answer.stats.add(&global.report(&text, |out| rule::bundle(&study, &answer, &provenance, out))?);
    global.answer(&Output { answer: &answer, inputs: &provenance.inputs }, &text, &answer.stats)?;
    Ok(code(args, &answer))
}

/// What is printed with `--json`.
#[derive(serde::Serialize)]
struct Output<'a> {
    #[serde(flatten)]
    answer: &'a RuleAnswer,
    /// All that the answer rests on, by its content.
    inputs: &'a [Input],
}

/// The tests of a rule.
fn tested(answer: &RuleAnswer, global: &Global) -> Result<ExitCode> {
    #[derive(serde::Serialize)]
    struct Output {
        tests: Vec<TestResult>,
    }
    let tests = answer.tested();
    let all = tests.iter().all(|test| test.passes);
    let text = rule::tests(&tests);
    global.answer(&Output { tests }, &text, &answer.stats)?;
    Ok(if all { ExitCode::SUCCESS } else { ExitCode::from(3) })
}

/// The sources of a rule.
fn sources(rule_read: &Rule, global: &Global) -> Result<ExitCode> {
    global.writes_nothing("--sources")?;
    #[derive(serde::Serialize)]
    struct Output<'a> {
        figures: Vec<Figure>,
        sources: &'a [Citation],
    }
    if rule_read.sources.is_empty() {
        let found = format!("the rule names no source for its {} figures", rule_read.figures().len());
        let instead =
            "write [[source]] with keys and document, clause, quote, date and mark, or choice = \"why\"";
        return Err(Error::malformed(found, instead).at(rule_read.scenario.place("")));
    }
    let output = Output { figures: rule_read.figures(), sources: &rule_read.sources };
    global.answer(&output, &rule::sources(rule_read), &Work::default())?;
    Ok(ExitCode::SUCCESS)
}

fn code(args: &RuleArgs, answer: &RuleAnswer) -> ExitCode {
    let mut met = answer.cameras.iter().map(|camera| camera.passes);
    let enough = if args.any { met.any(|passes| passes) } else { met.all(|passes| passes) };
    if args.check && !enough { ExitCode::from(3) } else { ExitCode::SUCCESS }
}
