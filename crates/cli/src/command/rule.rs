//! `hadar rule`: which cameras meet a rule.

use super::certificate;
use super::global::{Global, condition, day};
use super::several;
use super::verify::Again;
use clap::Args;
use hadar::demand::Work;
use hadar::error::{Error, Result};
use hadar::material::Library;
use hadar_report::rule;
use hadar_scenario::rule::{Citation, Figure};
use hadar_scenario::{Date, Rule, Setting, Written};
use hadar_study::sweep::Question;
use hadar_study::{
    CameraAnswer, Condition, Extent, FiguresMoved, Grid, Reforms, RuleAnswer, RuleAsked, RuleStudy,
    TestResult, Warning,
};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct RuleArgs {
    /// Rule files (TOML), `-` for standard input: scenarios with [envelope], cameras = [...] or [[camera]] tables, and [rule];
    /// several give one table, a row for each
    #[arg(required_unless_present = "verify", value_name = "RULE")]
    rules: Vec<PathBuf>,
    /// Exit with code 3 unless every camera meets the rule; without --out one line per camera, each decided by the first scene
    /// that suffices
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
    /// Compute the tolerances of a heated surrogate target within which no camera distinguishes it from a person with the probability that the rule requires, [stand_in]
    #[arg(long, conflicts_with_all = ["check", "test", "sources"])]
    stand_in: bool,
    /// Judge the cameras by every reform of the rule, [[reform]], and compare with the rule as it is
    #[arg(long, conflicts_with_all = ["check", "test", "sources", "stand_in", "on", "accept"])]
    reforms: bool,
    /// Change every number of the rule by a tenth, one at a time, and report which verdicts change
    #[arg(long, conflicts_with_all = ["check", "test", "sources", "stand_in", "reforms", "on", "accept"])]
    figures: bool,
    /// Judge every clause with a vehicle cell by cell, speed by speed and light by light, [[grid]]: the table that a maker hands in
    #[arg(long, conflicts_with_all = ["check", "test", "sources", "stand_in", "reforms", "figures", "on", "accept"])]
    grid: bool,
    /// Compute a certificate again, certificate.json of a report, and check that its inputs and its statements are the same
    #[arg(long, value_name = "CERTIFICATE", conflicts_with_all = ["rules", "check", "test", "sources", "stand_in", "reforms", "figures", "grid", "on"])]
    verify: Option<PathBuf>,
    /// Codes of conditions under which a 'yes' is accepted; `hadar explain CODE` explains them
    #[arg(long, value_name = "CODE", num_args = 1.., value_delimiter = ',', value_parser = condition, conflicts_with = "verify")]
    accept: Vec<String>,
    /// Cameras to judge instead of the rule's own, by name: the program's, or those of --cameras; may be given several times
    #[arg(long, value_name = "NAME", conflicts_with_all = ["verify", "sources", "test"])]
    judge: Vec<String>,
    /// Day to ask about: a rule that does not hold on it says so
    #[arg(long, value_name = "YYYY-MM-DD", value_parser = day)]
    on: Option<Date>,
}

impl RuleArgs {
    /// Whether a certificate is held against what is found now.
    pub(super) const fn verifies(&self) -> bool {
        self.verify.is_some()
    }
}

pub(super) fn run(
    args: &RuleArgs,
    global: &Global,
    read_again: &dyn Fn(&[String]) -> Option<Again>,
) -> Result<ExitCode> {
    if let Some(certificate) = &args.verify {
        return certificate::verify(certificate, global, read_again);
    }
    let alone = [
        (args.test, "--test"),
        (args.sources, "--sources"),
        (args.stand_in, "--stand-in"),
        (args.reforms, "--reforms"),
        (args.figures, "--figures"),
        (args.grid, "--grid"),
    ];
    if let Some((_, flag)) = alone.into_iter().find(|(asked, _)| *asked && args.rules.len() > 1) {
        let found = format!("{flag} is asked of {} rules at once", args.rules.len());
        return Err(Error::malformed(found, "name one rule"));
    }
    several::each(Question::Rule, &args.rules, global, |path, global| one(path, args, global))
}

/// What stands in the place of the rule's own cameras, and of the tests that name them.
fn judged(names: &[String]) -> Vec<Setting> {
    if names.is_empty() {
        return Vec::new();
    }
    let set = |key: &str, value: String| Setting { key: key.into(), value, by: "--judge" };
    let names = serde_json::json!(names).to_string();
    vec![set("cameras", names), set("camera", "[]".into()), set("test", "[]".into())]
}

fn one(file: &Path, args: &RuleArgs, global: &Global) -> Result<u8> {
    let written = global.written(file)?;
    let judged = judged(&args.judge);
    if let Some(twice) =
        judged.iter().find(|own| written.settings.iter().any(|other| other.key.starts_with(&own.key)))
    {
        let found = Error::malformed("--judge says which cameras there are", "leave out one of the two");
        return Err(found.for_key(format!("--set {}", twice.key)));
    }
    let written = written.with(judged);
    if args.reforms {
        return reforms(&written, global);
    }
    if args.figures {
        return figures(&written, global);
    }
    let mut rule_read = Rule::from_written(&written)?;
    rule_read.skip_uncovered(global.skip_uncovered);
    if args.sources {
        return sources(&rule_read, global);
    }
    if args.grid {
        return grid(&rule_read, global);
    }
    if args.test {
        global.writes_nothing("--test")?;
    }
    if args.test && rule_read.tests.is_empty() {
        let instead = "write [[test]] with camera = \"flir-a325sc\" and verdict = \"fails\"";
        let error = Error::malformed("the rule has no tests", instead);
        return Err(error.at(rule_read.scenario.place("")));
    }
    let library = global.library()?;
    let study = RuleStudy::new(&rule_read, &library)?;
    global.admit(study.takes())?;
    if args.stand_in {
        return stand_in(&study, &library, args.on, global);
    }
    let extent = match args.test {
        true => Extent::Margins,
        false if args.check && global.out.is_none() => Extent::Verdicts,
        false => Extent::Everything,
    };
    let asked = RuleAsked {
        extent,
        skipping: global.skipping(),
        seed: global.seed,
        on: args.on,
        accepted: args.accept.clone(),
        ..RuleAsked::default()
    };
    let bar = global.progress("pairs");
    let mut answer = study.answer(&asked, &|done, all| bar.set(done, all))?;
    bar.finish();
    if args.test {
        return tested(&answer, global);
    }
    let text = if extent == Extent::Verdicts { rule::check(&answer) } else { rule::text(&answer, &study) };
    let provenance = global.provenance()?;
    answer.stats.add(&global.report(&text, || rule::bundle(&study, &answer, &provenance))?);
    global.answer(&rule::Output::of(&answer, &provenance.inputs), &text, &answer.stats)?;
    Ok(code(args, &answer))
}

/// How exact a surrogate target must be.
fn stand_in(study: &RuleStudy, library: &Library, on: Option<Date>, global: &Global) -> Result<u8> {
    let bar = global.progress("stand-ins");
    let answer = study.stand_in(library, on, &|done, all| bar.set(done, all))?;
    bar.finish();
    let text = rule::stand_in(&answer);
    let work = global.report(&text, || rule::stand_in_bundle(&answer))?;
    global.answer(&answer, &text, &work)?;
    Ok(0)
}

/// Every camera by the rule and by its reforms.
fn reforms(written: &Written, global: &Global) -> Result<u8> {
    let bar = global.progress("laws");
    let found =
        Reforms::of(written, &global.library()?, global.skip_uncovered, &|done, all| bar.set(done, all))?;
    bar.finish();
    let text = rule::reforms(&found);
    let title = Rule::from_written(written)?.about.name;
    let work = global.report(&text, || rule::reforms_bundle(&found, title.as_deref()))?;
    let mut stats = found.stats.clone();
    stats.add(&work);
    global.answer(&found, &text, &stats)?;
    Ok(0)
}

/// What hangs on every figure of the rule.
fn figures(written: &Written, global: &Global) -> Result<u8> {
    let bar = global.progress("figures");
    let found = FiguresMoved::of(written, &global.library()?, global.skip_uncovered, &|done, all| {
        bar.set(done, all)
    })?;
    bar.finish();
    let text = rule::figures_moved(&found);
    let title = Rule::from_written(written)?.about.name;
    let work = global.report(&text, || rule::moved_bundle(&found, title.as_deref()))?;
    let mut stats = found.stats.clone();
    stats.add(&work);
    global.answer(&found, &text, &stats)?;
    Ok(0)
}

/// Every cell of the rule's grid.
fn grid(rule_read: &Rule, global: &Global) -> Result<u8> {
    let bar = global.progress("pairs");
    let found = Grid::of(rule_read, &global.library()?, &|done, all| bar.set(done, all))?;
    bar.finish();
    let units = rule_read.scenario.units();
    let text = rule::cell_by_cell(&found, units);
    let work = global.report(&text, || rule::grid_bundle(&found, rule_read.about.name.as_deref(), units))?;
    let mut stats = found.stats.clone();
    stats.add(&work);
    global.answer(&found, &text, &stats)?;
    Ok(0)
}

/// The tests of a rule.
fn tested(answer: &RuleAnswer, global: &Global) -> Result<u8> {
    #[derive(serde::Serialize)]
    struct Output {
        tests: Vec<TestResult>,
        /// That the rule does not hold on the day.
        warnings: Vec<Warning>,
    }
    let tests = answer.tested();
    let all = tests.iter().all(|test| test.passes);
    let warnings: Vec<Warning> = answer.sentence.idle.into_iter().map(Warning::NotInForce).collect();
    let text = rule::tests(&tests, answer.sentence.idle);
    global.answer(&Output { tests, warnings }, &text, &answer.stats)?;
    Ok(if all { 0 } else { 3 })
}

/// The sources of a rule.
fn sources(rule_read: &Rule, global: &Global) -> Result<u8> {
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
    Ok(0)
}

fn code(args: &RuleArgs, answer: &RuleAnswer) -> u8 {
    let is_met = |camera: &CameraAnswer| {
        camera.passes && Condition::unaccepted(&camera.conditions, &answer.accepted).next().is_none()
    };
    let mut met = answer.cameras.iter().map(is_met);
    let enough = if args.any { met.any(|passes| passes) } else { met.all(|passes| passes) };
    if args.check && !enough { 3 } else { 0 }
}
