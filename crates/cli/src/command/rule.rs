//! `hadar rule`: which cameras meet a rule.

use super::global::{Global, condition, day as on_day};
use super::several;
use super::verify::{Again, VerifyArgs};
use clap::Args;
use hadar::demand::Work;
use hadar::error::{Error, Result};
use hadar::inputs::{self, inputs_of};
use hadar::material::Library;
use hadar_formats::file;
use hadar_formats::hash::{nearest_folder, sha256_of_file};
use hadar_report::manifest::{self, Input};
use hadar_report::rule;
use hadar_report::verify::{Verified, text as of_report};
use hadar_scenario::rule::{Citation, Figure};
use hadar_scenario::{Date, Rule, STDIN, Setting, Written, day};
use hadar_study::sweep::Question;
use hadar_study::{
    CameraAnswer, Condition, Extent, FiguresMoved, OwnCameras, Reforms, RuleAnswer, RuleAsked, RuleStudy,
    TestResult, Warning,
};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// What is read of a certificate at most, bytes.
const LONGEST_CERTIFICATE: u64 = 1 << 26;

#[derive(Debug, Args)]
pub(super) struct RuleArgs {
    /// Rule files (TOML), `-` for standard input: scenarios with [envelope], cameras = [...] or [[camera]] tables, and [rule]; of
    /// several one table, a row for each
    #[arg(required_unless_present = "verify", value_name = "RULE")]
    rules: Vec<PathBuf>,
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
    /// Say how exact a heated stand-in must be so that no camera tells it from a person as reliably as the rule demands, [stand_in]
    #[arg(long, conflicts_with_all = ["check", "test", "sources"])]
    stand_in: bool,
    /// Hold the cameras against every reform of the rule, [[reform]], beside the rule as it is
    #[arg(long, conflicts_with_all = ["check", "test", "sources", "stand_in", "on", "accept"])]
    reforms: bool,
    /// Move every number of the rule by a tenth, alone, and say what hangs on it
    #[arg(long, conflicts_with_all = ["check", "test", "sources", "stand_in", "reforms", "on", "accept"])]
    figures: bool,
    /// Compute a certificate again, certificate.json of a report, and say whether all that it rests on and all that it says is the same
    #[arg(long, value_name = "CERTIFICATE", conflicts_with_all = ["rules", "check", "test", "sources", "stand_in", "reforms", "figures", "on"])]
    verify: Option<PathBuf>,
    /// Codes of conditions under which a 'yes' is one, as `hadar explain CODE` tells them
    #[arg(long, value_name = "CODE", num_args = 1.., value_delimiter = ',', value_parser = condition, conflicts_with = "verify")]
    accept: Vec<String>,
    /// Ask about a day: a rule that does not hold on it says so
    #[arg(long, value_name = "YYYY-MM-DD", value_parser = on_day)]
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
        return verify(certificate, global, read_again);
    }
    let alone = [
        (args.test, "--test"),
        (args.sources, "--sources"),
        (args.stand_in, "--stand-in"),
        (args.reforms, "--reforms"),
        (args.figures, "--figures"),
    ];
    if let Some((_, flag)) = alone.into_iter().find(|(asked, _)| *asked && args.rules.len() > 1) {
        let found = format!("{flag} is asked of {} rules at once", args.rules.len());
        return Err(Error::malformed(found, "name one rule"));
    }
    several::each(Question::Rule, &args.rules, global, |path, global| one(path, args, global))
}

fn one(file: &Path, args: &RuleArgs, global: &Global) -> Result<u8> {
    let written = global.written(file)?;
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
    global.answer(&rule::Output { answer: &answer, inputs: &provenance.inputs }, &text, &answer.stats)?;
    Ok(code(args, &answer))
}

/// A value in the place of the rule's own, as a certificate has it.
#[derive(serde::Deserialize)]
struct Set {
    key: String,
    value: String,
}

/// Whether a certificate says what is found now.
fn verify(
    certificate: &Path,
    global: &Global,
    read_again: &dyn Fn(&[String]) -> Option<Again>,
) -> Result<ExitCode> {
    global.writes_nothing("--verify")?;
    global.sets_nothing("a certificate")?;
    let told = |found: String| {
        let instead = "name the certificate.json of a report by hadar rule";
        Error::malformed(found, instead).in_file(certificate)
    };
    // Not an input of the rule, as what is read by the library is.
    let (bytes, _) = inputs_of(|| file::bytes(certificate, "read the certificate", LONGEST_CERTIFICATE));
    let bytes = bytes?;
    let text = String::from_utf8(bytes).map_err(|_| told("this is not UTF-8 text".into()))?;
    let before = rule::parsed(&text).map_err(|error| error.in_file(certificate))?;
    let of = |value: &Value, key: &str| value.get(key).cloned().unwrap_or_default();
    let Some(path) = of(&of(&before, "rule"), "path").as_str().map(PathBuf::from) else {
        return Err(told("this is no certificate of a rule".into()));
    };
    let set: Vec<Set> = serde_json::from_value(match of(&of(&before, "rule"), "set") {
        Value::Null => Value::Array(Vec::new()),
        set => set,
    })
    .map_err(|error| told(format!("what it set is not readable: {error}")))?;
    let on = of(&before, "on").as_str().and_then(day);
    let listed: Vec<Input> = serde_json::from_value(of(&before, "inputs"))
        .map_err(|error| told(format!("its inputs are none: {error}")))?;
    let path = found_again(path, certificate, listed.first(), global);
    if path == Path::new(STDIN) {
        let instead = "put its rule_as_read.toml beside it again";
        let found = Error::malformed("its rule was read from standard input, and is no file", instead);
        return Err(found.in_file(certificate));
    }
    let home = path.parent().unwrap_or(Path::new(""));
    for input in listed.iter().filter(|input| !input.path.starts_with("built-in: ")) {
        let file = home.join(&input.path);
        // What is not in the folder of the rule, such as --library, is compared when it is read.
        if !file.exists() {
            continue;
        }
        let now =
            sha256_of_file(&file).map_err(|error| Error::file("read for its hash", &file, error.kind()))?;
        if now != input.sha256 {
            let hash = |hash: &Option<String>| hash.clone().unwrap_or_else(|| "none".into());
            let found = format!(
                "the file was changed: its SHA-256 was {} and is {}",
                hash(&input.sha256),
                hash(&now)
            );
            return Err(Error::malformed(found, "check the rule again: hadar rule").in_file(&file));
        }
    }
    let set = set.into_iter().map(|Set { key, value }| Setting { key, value, by: "the certificate" });
    let mut written = Written::from_file(&path)?
        .with(set)
        .with_cameras(OwnCameras::from_files(&global.cameras)?.stated.into());
    // The copy that a report has of it stands for the file that was read, under that one's name.
    let name = listed.first().map(|input| input.path.clone());
    let name = name.filter(|_| path.ends_with(rule::AS_READ));
    if let Some(name) = &name {
        written.path = Some(path.with_file_name(Path::new(name).file_name().unwrap_or_default()));
    }
    let mut rule_read = Rule::from_written(&written)?;
    rule_read.skip_uncovered(global.skip_uncovered);
    let study = RuleStudy::new(&rule_read, &global.library()?)?;
    let bar = global.progress("pairs");
    let accepted: Vec<String> = serde_json::from_value(of(&before, "accepted")).unwrap_or_default();
    let answer =
        study.answer(&RuleAsked { on, accepted, ..RuleAsked::default() }, &|done, all| bar.set(done, all))?;
    bar.finish();
    let mut provenance = global.provenance()?;
    let copy = provenance.inputs.iter_mut().find(|input| input.path == rule::AS_READ);
    if let Some((copy, name)) = copy.zip(name) {
        copy.path = name;
    }
    let now = rule::record(&study, &answer, &provenance)?;
    let off = rule::agreement(&before, &now).map_err(|error| error.in_file(certificate))?;
    #[derive(serde::Serialize)]
    struct Output {
        verified: bool,
        largest_difference: f64,
        /// Of the report that the certificate is in.
        report: Option<Verified>,
    }
    let digits = if off == 0.0 { "to the last digit".to_owned() } else { format!("to {off:.1e}") };
    let found = format!(
        "{} inputs are as they were, and all that {} says was found again, {digits}",
        listed.len(),
        inputs::called(None, certificate)
    );
    // Every other file of a report says the same, and is as easily changed.
    let folder =
        certificate.parent().map(|folder| if folder == Path::new("") { Path::new(".") } else { folder });
    let report = folder.filter(|folder| folder.join(manifest::NAME).exists());
    // Names of inputs are from the folder of the rule, where that is not the report's own copy.
    let home = (!path.ends_with(rule::AS_READ)).then(|| path.parent().map(Path::to_owned)).flatten();
    let home = home.map(|home| if home == Path::new("") { PathBuf::from(".") } else { home });
    let report = report
        .map(|folder| {
            super::verify::verified(
                &VerifyArgs::of(folder.to_owned(), global.inputs.clone().or(home)),
                global,
                read_again,
            )
        })
        .transpose()?;
    let text = match &report {
        Some(report) if report.verified => {
            format!("Verified: {found}.\nThe report that it is in: {}", of_report(report))
        }
        Some(report) => {
            format!("Not verified, though {found}.\nThe report that it is in: {}", of_report(report))
        }
        None => format!(
            "Verified: {found}. It is no part of a report: other files beside it were not looked at.\n"
        ),
    };
    let verified = report.as_ref().is_none_or(|report| report.verified);
    global.answer(&Output { verified, largest_difference: off, report }, &text, &answer.stats)?;
    Ok(ExitCode::from(u8::from(!verified)))
}

/// The rule of a certificate: where it is told to be, else by its content from here or near the certificate.
fn found_again(path: PathBuf, certificate: &Path, rule_read: Option<&Input>, global: &Global) -> PathBuf {
    if let Some(inputs) = &global.inputs {
        return inputs.join(path);
    }
    let is_rule = |file: &Path| {
        let hash = sha256_of_file(file).ok().flatten();
        hash.is_some() && rule_read.is_some_and(|input| input.sha256 == hash)
    };
    let is_it = |folder: &Path| is_rule(&folder.join(&path));
    let absolute = std::path::absolute(certificate).ok();
    let own = absolute.as_deref().and_then(Path::parent);
    let near = own.and_then(|folder| nearest_folder(folder, is_it));
    let here = || std::env::current_dir().ok().and_then(|folder| nearest_folder(&folder, is_it));
    let found = near.or_else(here).map(|folder| folder.join(&path));
    // Where there is none of its name, as it was read.
    let copy = own.map(|folder| folder.join(rule::AS_READ)).filter(|_| !path.exists());
    let beside = || copy.filter(|copy| is_rule(copy));
    found.or_else(beside).unwrap_or(path)
}

/// How exact a stand-in must be.
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
    let found = FiguresMoved::of(written, &global.library()?, &|done, all| bar.set(done, all))?;
    bar.finish();
    let text = rule::figures_moved(&found);
    let title = Rule::from_written(written)?.about.name;
    let work = global.report(&text, || rule::moved_bundle(&found, title.as_deref()))?;
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
