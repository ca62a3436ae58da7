//! `hadar materials import`: files of any layout as two-column CSV.
//!
//! A file among several that is no spectrum is passed over with its reason, or all are refused with `--strict`; the only file that is named must be one.
//! Spectra imported before stay: one of the same name from another file gets a name beside it.

use super::super::global::Global;
use super::files::{Columns, SHOWN_CM1};
use hadar::demand::{Reason, Thing, Work};
use hadar::error::{Error, Result};
use hadar::material::{Material, Summary};
use hadar_report::bundle::Bundle;
use hadar_report::json;
use hadar_report::text::significant;
use hadar_report::words::Say;
use hadar_study::Warning;
use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Files that are named where nothing could be taken, beside the first with its reason.
const OTHERS: usize = 4;

/// What was read: materials with their files, and why others were not.
struct Found {
    materials: Vec<(Material, PathBuf)>,
    passed_over: Vec<Error>,
}

pub(super) fn run(named: &[PathBuf], columns: &Columns, global: &Global) -> Result<()> {
    let mut found = read_all(named, columns, global)?;
    let mut bundle = Bundle::default();
    let own = match &global.out {
        Some(directory) => global.folder(directory).own_files()?,
        None => Vec::new(),
    };
    let of: Vec<(&Material, &Path)> =
        found.materials.iter().map(|(material, file)| (material, file.as_path())).collect();
    let names = hadar_formats::spectra::unique_names(&of);
    let mut summaries = Vec::new();
    let mut out = String::new();
    for ((material, file), name) in found.materials.iter().zip(names) {
        let source = format!("# source: {}", material.provenance().source);
        let is_anothers = |name: &str| {
            let csv = format!("{name}.csv");
            let of_another =
                |(known, content): &(String, Vec<u8>)| *known == csv && !holds_line(content, &source);
            bundle.names().any(|known| known == csv) || own.iter().any(of_another)
        };
        let tagged = hadar_formats::spectra::tagged_name(material, file);
        let numbered = (2_usize..).map(|number| format!("{tagged}-{number}"));
        let mut names = [name, tagged.clone()].into_iter().chain(numbered);
        let material = material.clone().with_name(names.find(|name| !is_anothers(name)).unwrap_or(tagged));
        if global.out.is_some() {
            match material.to_csv(&rows(&material)) {
                Ok(csv) => bundle.add(format!("{}.csv", material.name()), csv),
                Err(error) if global.strict || found.materials.len() == 1 => return Err(error.in_file(file)),
                Err(error) => {
                    found.passed_over.push(error.in_file(file));
                    continue;
                }
            }
        }
        let summary = material.summary();
        say(&summary, &mut out);
        summaries.push(summary);
    }
    // What could be read may be known nowhere, or not everywhere, so that nothing is left to write.
    if summaries.is_empty() {
        return Err(nothing(named, &found.passed_over));
    }
    let warnings: Vec<Warning> = found
        .passed_over
        .iter()
        .map(|error| Warning::Library { remark: format!("passed over: {error}") })
        .collect();
    for warning in &warnings {
        let _ = writeln!(out, "{}", warning.say());
    }
    let mut work = Work::default();
    work.compute(Thing::LibrarySpectra, summaries.len() as u64);
    if let Some(directory) = &global.out {
        for (name, content) in own {
            if bundle.names().all(|known| known != name) {
                bundle.add(name, content);
            }
        }
        global.write(&bundle, directory, None)?;
        let _ = writeln!(out, "use them with --library {}", directory.display());
        work.compute(Thing::Reports, 1);
    } else {
        work.spare(Thing::Reports, Reason::NotAsked, 1);
    }
    global.answer_with(
        serde_json::json!({ "materials": summaries, "warnings": json::value(&warnings)? }),
        &out,
        &work,
    )
}

fn read_all(named: &[PathBuf], columns: &Columns, global: &Global) -> Result<Found> {
    let (mut files, mut passed_over) = (Vec::new(), Vec::new());
    for path in named {
        if path.is_dir() {
            let folder = hadar_formats::spectra::spectra_in(path)?;
            files.extend(folder.files);
            passed_over.extend(folder.passed_over);
        } else {
            files.push(path.clone())
        }
    }
    // One that is named twice, or itself and with its folder, is one.
    let mut seen = BTreeSet::new();
    files.retain(|file| seen.insert(std::path::absolute(file).unwrap_or_else(|_| file.clone())));
    let mut found = Found { materials: Vec::new(), passed_over };
    for file in &files {
        match columns.read(file) {
            Ok(materials) => {
                found.materials.extend(materials.into_iter().map(|material| (material, file.clone())));
            }
            Err(error) if global.strict || files.len() == 1 => return Err(error),
            Err(error) => found.passed_over.push(error),
        }
    }
    if found.materials.is_empty() { Err(nothing(named, &found.passed_over)) } else { Ok(found) }
}

/// Why nothing was taken.
fn nothing(named: &[PathBuf], passed_over: &[Error]) -> Error {
    const INSTEAD: &str = "name files of emissivity or reflectance";
    match passed_over {
        [] => {
            let folders: Vec<String> = named.iter().map(|path| path.display().to_string()).collect();
            let found = format!("there is no file of spectra in {}", folders.join(", "));
            Error::malformed(
                found,
                format!("{INSTEAD}, or folders that hold {}", hadar::material::ENDINGS.join(", ")),
            )
        }
        [first, others @ ..] => {
            let found = format!("none of {} files is a spectrum: {first}", passed_over.len());
            let mut also: Vec<String> = others.iter().take(OTHERS).filter_map(file_of).collect();
            if others.len() > OTHERS {
                also.push(format!("{} more", others.len() - OTHERS));
            }
            let told = if also.is_empty() { "" } else { "; name one alone for its reason, as of " };
            Error::malformed(found, format!("{INSTEAD}{told}{}", also.join(", ")))
        }
    }
}

/// The file that an error is about.
fn file_of(error: &Error) -> Option<String> {
    match error {
        Error::At { place, .. } => place.path.as_ref().map(|path| path.display().to_string()),
        _ => None,
    }
}

fn say(summary: &Summary, out: &mut String) {
    let range = summary.range_cm1.map_or_else(String::new, |(low, high)| {
        format!(", {} to {} cm^-1", significant(low, 5), significant(high, 5))
    });
    let _ = writeln!(out, "{}: {} rows{range}", summary.name, summary.rows);
    if !summary.read_as.is_empty() {
        let _ = writeln!(out, "  read as {}", summary.read_as);
    }
    for warning in &summary.warnings {
        let _ = writeln!(out, "  warning: {warning}");
    }
}

/// Whether a text file has this line.
fn holds_line(content: &[u8], line: &str) -> bool {
    content.split(|&byte| byte == b'\n').any(|one| one == line.as_bytes())
}

/// The material's own rows: its ends and every kink between.
fn rows(material: &Material) -> Vec<f64> {
    let (low, high) = material.range_cm1().unwrap_or(SHOWN_CM1);
    let mut rows = vec![low, high];
    rows.extend(material.breakpoints_cm1(low, high));
    rows.sort_by(f64::total_cmp);
    rows.dedup();
    rows
}
