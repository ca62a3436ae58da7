//! `hadar rule --verify CERTIFICATE`: a certificate computed again, and the report that it is in.

use super::global::{Global, known_condition};
use super::verify::{Again, VerifyArgs};
use hadar::error::{Error, Result};
use hadar::inputs::{self, inputs_of};
use hadar_formats::file;
use hadar_formats::hash::{nearest_folder, sha256_of_file};
use hadar_report::manifest::{self, Input};
use hadar_report::rule;
use hadar_report::verify::{Verified, text as of_report};
use hadar_scenario::{Rule, STDIN, Setting, Written, day};
use hadar_study::{OwnCameras, RuleAsked, RuleStudy};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// What is read of a certificate at most, bytes.
const LONGEST_CERTIFICATE: u64 = 1 << 26;

/// A value in the place of the rule's own, as a certificate has it.
#[derive(serde::Deserialize)]
struct Set {
    key: String,
    value: String,
}

/// Whether a certificate says what is found now.
pub(super) fn verify(
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
    let accepted: Vec<String> = serde_json::from_value(of(&before, "accepted"))
        .map_err(|error| told(format!("what it accepts is not readable: {error}")))?;
    accepted.iter().try_for_each(|code| known_condition(code)).map_err(|error| error.in_file(certificate))?;
    let on = of(&before, "on").as_str().and_then(day);
    let listed: Vec<Input> = serde_json::from_value(of(&before, "inputs"))
        .map_err(|error| told(format!("its inputs are none: {error}")))?;
    let path = found_again(path, certificate, listed.first(), global);
    if path == Path::new(STDIN) {
        let instead = "put its rule_as_read.toml into the same folder again";
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
    let digits = if off == 0.0 { "to the last digit".to_owned() } else { format!("to {off:.1e}") };
    let found = format!(
        "{} inputs are as they were, and all that {} says was found again, {digits}",
        listed.len(),
        inputs::called(None, certificate)
    );
    // Names of inputs are from the folder of the rule, where that is not the report's own copy.
    let home = path.parent().filter(|_| !path.ends_with(rule::AS_READ)).map(or_here);
    let report = report_of(certificate, home.map(Path::to_owned), global, read_again)?;
    let text = match &report {
        None => format!(
            "Verified: {found}. It is no part of a report: other files of its folder were not read.\n"
        ),
        Some(report) => {
            let verified = if report.verified { "Verified:" } else { "Not verified, though" };
            format!("{verified} {found}.\nThe report that it is in: {}", of_report(report))
        }
    };
    let verified = report.as_ref().is_none_or(|report| report.verified);
    global.answer(&Output { verified, largest_difference: off, report }, &text, &answer.stats)?;
    Ok(ExitCode::from(u8::from(!verified)))
}

#[derive(serde::Serialize)]
struct Output {
    verified: bool,
    largest_difference: f64,
    /// Of the report that the certificate is in.
    report: Option<Verified>,
}

/// The report that a certificate is in, made again: every other file of it says the same, and is as easily changed.
fn report_of(
    certificate: &Path,
    inputs: Option<PathBuf>,
    global: &Global,
    read_again: &dyn Fn(&[String]) -> Option<Again>,
) -> Result<Option<Verified>> {
    let folder = certificate.parent().map(or_here).filter(|folder| folder.join(manifest::NAME).exists());
    let Some(folder) = folder else { return Ok(None) };
    let asked = VerifyArgs::of(folder.to_owned(), global.inputs.clone().or(inputs));
    super::verify::verified(&asked, global, read_again).map(Some)
}

/// A folder that a path names by nothing is this one.
fn or_here(folder: &Path) -> &Path {
    if folder == Path::new("") { Path::new(".") } else { folder }
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
    // One that stands above the report, or here, is the rule that is meant: changed there, it is not found again in another place.
    let above = own.and_then(Path::parent).map(|folder| folder.join(&path));
    let in_place = above.into_iter().chain([path.clone()]).find(|file| file.is_file());
    if let Some(in_place) = in_place {
        // As it was written, where that is the same file.
        let real = |file: &Path| file.canonicalize().ok();
        return if real(&path) == real(&in_place) { path } else { in_place };
    }
    let near = own.and_then(|folder| nearest_folder(folder, is_it));
    let here = || std::env::current_dir().ok().and_then(|folder| nearest_folder(&folder, is_it));
    let found = near.or_else(here).map(|folder| folder.join(&path));
    // Where there is none of its name, as it was read.
    let copy = own.map(|folder| folder.join(rule::AS_READ)).filter(|_| !path.exists());
    let beside = || copy.filter(|copy| is_rule(copy));
    found.or_else(beside).unwrap_or(path)
}
