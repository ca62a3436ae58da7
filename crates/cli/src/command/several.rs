//! Several scenarios asked the same: each as if it were alone, then one table of all.
//!
//! What goes wrong with one is in its row, and the others are answered. The exit code is that of the worst: 1 for a scenario without an
//! answer, else 3 for a requirement that is not met, else 0.

use super::global::Global;
use hadar::demand::Work;
use hadar::error::{Error, Result};
use hadar::inputs::{self, inputs_of};
use hadar_report::several::{self, Row};
use hadar_scenario::STDIN;
use hadar_study::sweep::Question;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Answers one as it is, several by a table.
pub(super) fn each(
    question: Question,
    paths: &[PathBuf],
    global: &Global,
    one: impl Fn(&Path, &Global) -> Result<u8>,
) -> Result<ExitCode> {
    if let [path] = paths {
        return one(path, global).map(ExitCode::from);
    }
    if paths.iter().filter(|path| path.as_os_str() == "-").count() > 1 {
        let found = "standard input is named twice, and can be read once";
        return Err(Error::malformed(found, "name `-` once"));
    }
    let (folders, home) = (folders(paths), shared_folder(paths));
    let named = |path: &Path| named(path, home.as_deref());
    if let Some(out) = &global.out {
        folders.iter().try_for_each(|name| global.folder(&out.join(name)).check())?;
    }
    let mut rows = Vec::with_capacity(paths.len());
    for (path, folder) in paths.iter().zip(&folders) {
        let others = paths.iter().filter(|other| *other != path);
        let own = global.of_several(folder, others.map(|other| other.to_string_lossy().into_owned()));
        if global.stats {
            global.note(&format!("{}:", named(path)));
        }
        let (outcome, read) = inputs_of(|| one(path, &own));
        inputs::add(&read);
        let (exit_code, error) = match outcome {
            Ok(code) => (code, None),
            Err(error) => (1, Some(error.to_string().replace(&*path.to_string_lossy(), &named(path)))),
        };
        let answer = own.kept().filter(|_| error.is_none());
        rows.push(Row { scenario: named(path), exit_code, error, answer });
    }
    let text = several::text(question, &rows);
    let work = global.report(&text, || several::bundle(question, &rows))?;
    let worst = rows.iter().map(|row| row.exit_code).min_by_key(|code| match code {
        1 => 0,
        0 => 2,
        _ => 1,
    });
    #[derive(serde::Serialize)]
    struct Output {
        answers: Vec<Row>,
        stats: Work,
    }
    global.print(&Output { answers: rows, stats: work }, &text)?;
    Ok(ExitCode::from(worst.unwrap_or(0)))
}

/// How a scenario is called in the table: by the way to it from the folder that all are in, wherever that is.
fn named(path: &Path, home: Option<&Path>) -> String {
    if path.as_os_str() == "-" { STDIN.to_owned() } else { inputs::called(home, path) }
}

/// The deepest folder that all files are in.
fn shared_folder(paths: &[PathBuf]) -> Option<PathBuf> {
    let folder = |path: &PathBuf| {
        let whole = std::path::absolute(path).ok()?;
        let folder = whole.parent()?;
        Some(folder.canonicalize().unwrap_or_else(|_| folder.to_owned()))
    };
    let mut folders = paths.iter().filter(|path| path.as_os_str() != "-").filter_map(folder);
    let first = folders.next()?;
    let shared = |one: PathBuf, other: PathBuf| {
        let same = one.components().zip(other.components()).take_while(|(one, other)| one == other);
        same.map(|(part, _)| part).collect()
    };
    Some(folders.fold(first, shared))
}

/// A folder for each, by the name of its file; a number behind those of the same name.
fn folders(paths: &[PathBuf]) -> Vec<String> {
    let stem = |path: &PathBuf| match path.file_stem() {
        Some(stem) if stem != "-" => stem.to_string_lossy().into_owned(),
        _ => "stdin".to_owned(),
    };
    let mut taken: BTreeSet<String> = paths.iter().map(stem).collect();
    let mut first = BTreeSet::new();
    let numbered = |stem: String| {
        if first.insert(stem.clone()) {
            return stem;
        }
        let free = (2..).map(|number| format!("{stem}-{number}")).find(|name| !taken.contains(name));
        let name = free.unwrap_or(stem);
        taken.insert(name.clone());
        name
    };
    paths.iter().map(stem).map(numbered).collect()
}

#[cfg(test)]
mod tests {
    use super::folders;

    #[test]
    fn every_scenario_has_a_folder_of_its_own() {
        let of = |paths: &[&str]| folders(&paths.iter().map(Into::into).collect::<Vec<_>>());
        assert_eq!(of(&["a.toml", "b/c.toml", "-"]), ["a", "c", "stdin"]);
        assert_eq!(of(&["a.toml", "x/a.toml", "a-2.toml", "y/a.toml"]), ["a", "a-3", "a-2", "a-4"]);
    }
}
