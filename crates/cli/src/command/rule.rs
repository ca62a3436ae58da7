//! `hadar rule`: which cameras meet a rule.

use super::global::Global;
use clap::Args;
use hadar::error::Result;
use hadar_report::manifest::Input;
use hadar_report::rule;
use hadar_study::scenario::Rule;
use hadar_study::study::{RuleAnswer, RuleAsked, RuleStudy};
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
}

pub(super) fn run(args: &RuleArgs, global: &Global) -> Result<ExitCode> {
    let mut rule_read = Rule::from_file(&args.rule)?;
    rule_read.scenario.alternatives.skip_uncovered |= global.skip_uncovered;
    let study = RuleStudy::new(&rule_read, &global.library()?)?;
    global.inputs_are_safe()?;
    let asked = RuleAsked {
        verdict_only: args.check && global.out.is_none(),
        skipping: global.skipping(),
        seed: global.seed,
    };
    let bar = global.progress("pairs");
    let mut answer = study.answer(&asked, &|done, all| bar.set(done, all))?;
    bar.finish();
    let text = if asked.verdict_only { rule::check(&answer) } else { rule::text(&answer, &study) };
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

fn code(args: &RuleArgs, answer: &RuleAnswer) -> ExitCode {
    let mut met = answer.cameras.iter().map(|camera| camera.passes);
    let enough = if args.any { met.any(|passes| passes) } else { met.all(|passes| passes) };
    if args.check && !enough { ExitCode::from(3) } else { ExitCode::SUCCESS }
}
