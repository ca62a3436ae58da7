//! Tells the program which commit it was built from, for the reports that it signs.
//!
//! `HADAR_COMMIT` says it for those who package the program; else the package does, then the repository, without which it is
//! `unknown`. The answer is found again when a commit was made or a source was changed, and only this package is compiled for it.

use std::path::{Path, PathBuf};
use std::process::Command;

/// Where sources are, from the root of the workspace.
const SOURCES: [&str; 6] = ["src", "crates", "spectra", "cameras", "Cargo.toml", "Cargo.lock"];

fn main() {
    println!("cargo:rerun-if-env-changed=HADAR_COMMIT");
    println!("cargo:rerun-if-changed=build.rs");
    let package = PathBuf::from(std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default());
    let named = std::env::var("HADAR_COMMIT").ok().filter(|commit| !commit.trim().is_empty());
    let commit = named.or_else(|| of_package(&package)).or_else(|| of_repository(&package));
    let commit = commit.unwrap_or_else(|| "unknown".to_owned());
    println!("cargo:rustc-env=HADAR_COMMIT={}", commit.trim());
}

/// As `cargo package` notes it.
fn of_package(package: &Path) -> Option<String> {
    let note = std::fs::read_to_string(package.join(".cargo_vcs_info.json")).ok()?;
    let commit = note.split("\"sha1\": \"").nth(1)?.split('"').next()?;
    Some(marked(commit, note.contains("\"dirty\": true")))
}

/// That of the repository whose workspace this is; not of one that merely lies around it.
fn of_repository(package: &Path) -> Option<String> {
    let root = package.parent()?.parent()?.canonicalize().ok()?;
    let git = |arguments: &[&str]| {
        let output = Command::new("git").arg("-C").arg(&root).args(arguments).output().ok()?;
        let text = String::from_utf8(output.stdout).ok()?;
        output.status.success().then(|| text.trim().to_owned())
    };
    if Path::new(&git(&["rev-parse", "--show-toplevel"])?).canonicalize().ok()? != root {
        return None;
    }
    let watched =
        ["HEAD", "logs/HEAD"].into_iter().filter_map(|name| git(&["rev-parse", "--git-path", name]));
    let sources = ["src", "spectra", "cameras", "Cargo.toml", "Cargo.lock"].map(PathBuf::from).into_iter();
    let packages =
        std::fs::read_dir(root.join("crates")).ok()?.flatten().map(|found| found.path().join("src"));
    for path in watched.map(PathBuf::from).chain(sources).chain(packages) {
        let path = root.join(path);
        if path.exists() {
            println!("cargo:rerun-if-changed={}", path.display());
        }
    }
    let commit = git(&["rev-parse", "HEAD"])?;
    let changed = git(&[&["status", "--porcelain", "--"], SOURCES.as_slice()].concat())?;
    // Tests are no part of the program.
    let changed = changed.lines().any(|line| !line.contains("/tests/"));
    Some(marked(&commit, changed))
}

fn marked(commit: &str, dirty: bool) -> String {
    format!("{commit}{}", if dirty { "-dirty" } else { "" })
}
