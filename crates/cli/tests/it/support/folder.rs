//! The program run in a folder of its own.

use assert_cmd::Command;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A small scenario that every test changes to its needs.
pub(crate) const SCENARIO: &str = r#"[target]
material = "skin"
temperature = "37 degC"
[[environment]]
temperature = "20 degC"
lighting = 0.5
[alternatives]
materials = ["aluminium"]
[bands]
step = "5 cm^-1"
[camera]
preset = "flir-a325sc"
"#;

/// A folder with `a.toml` in it, in which the program runs.
pub(crate) struct Folder(TempDir);

/// What the program left behind.
pub(crate) struct Outcome {
    pub code: i32,
    pub stdout: String,
    pub stderr: String,
}

impl Outcome {
    fn of(command: &mut Command) -> Self {
        let output = command.output().unwrap();
        Self {
            code: output.status.code().unwrap_or(-1),
            stdout: String::from_utf8(output.stdout).unwrap(),
            stderr: String::from_utf8(output.stderr).unwrap(),
        }
    }
}

impl Folder {
    pub(crate) fn with(scenario: &str) -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        folder.file("a.toml", scenario);
        folder
    }

    pub(crate) fn path(&self) -> &Path {
        self.0.path()
    }

    pub(crate) fn file(&self, name: &str, content: &str) -> PathBuf {
        let path = self.path().join(name);
        fs::write(&path, content).unwrap();
        path
    }

    pub(crate) fn run(&self, arguments: &[&str]) -> Outcome {
        let mut command = Command::new(crate::PROGRAM);
        Outcome::of(command.current_dir(self.path()).args(arguments))
    }

    /// The same under every condition that a 'yes' may rest on.
    pub(crate) fn accepting(&self, arguments: &[&str]) -> Outcome {
        let all = hadar_study::Condition::codes().join(",");
        self.run(&[arguments, &["--accept", &all]].concat())
    }

    /// The same with a text on standard input.
    pub(crate) fn fed(&self, stdin: &str, arguments: &[&str]) -> Outcome {
        let mut command = Command::new(crate::PROGRAM);
        Outcome::of(command.current_dir(self.path()).args(arguments).write_stdin(stdin))
    }

    pub(crate) fn json(&self, arguments: &[&str]) -> Value {
        let outcome = self.run(&[arguments, &["--json"]].concat());
        assert_eq!(outcome.code, 0, "{arguments:?}: {}", outcome.stderr);
        serde_json::from_str(&outcome.stdout).unwrap_or_else(|error| panic!("{error}: {}", outcome.stdout))
    }

    /// Names of all files below, sorted.
    pub(crate) fn files(&self) -> Vec<String> {
        let mut found = Vec::new();
        let mut folders = vec![self.path().to_owned()];
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                if path.is_dir() {
                    folders.push(path.clone());
                }
                found.push(path.strip_prefix(self.path()).unwrap().display().to_string());
            }
        }
        found.sort();
        found
    }

    /// The one line said about a mistake; nothing on stdout, nothing written.
    #[track_caller]
    pub(crate) fn refusal(&self, arguments: &[&str]) -> String {
        let before = self.files();
        let outcome = self.run(arguments);
        assert_eq!(outcome.code, 1, "{arguments:?}: {}{}", outcome.stdout, outcome.stderr);
        assert_eq!(outcome.stdout, "", "{arguments:?}");
        assert_eq!(self.files(), before, "{arguments:?} wrote something");
        let line = outcome.stderr.strip_suffix('\n').unwrap_or_default();
        assert!(!line.is_empty() && !line.contains('\n'), "{arguments:?}: {}", outcome.stderr);
        line.strip_prefix("error: ").expect("it begins with error:").to_owned()
    }
}
