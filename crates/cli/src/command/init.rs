//! `hadar init`: a commented file to begin with, that runs as it is.
//!
//! Templates are plain TOML; what each key means is put in from the table of keys.

use super::global::Global;
use clap::{Args, ValueEnum};
use hadar::error::{Error, Result};
use hadar_scenario::keys::commented;
use serde::Serialize;
use std::fs::OpenOptions;
use std::io::{ErrorKind, Write as _};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct InitArgs {
    /// What the file is for
    #[arg(value_enum, default_value_t = For::Size)]
    command: For,
    /// Name of the file; default: that of the command
    file: Option<PathBuf>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum For {
    /// A camera for a requirement
    Size,
    /// What the target can be distinguished from
    Identify,
    /// Which camera, lens and filters to take
    Find,
    /// A rule over ranges of scenes, and cameras
    Rule,
    /// Depth by two cameras before a street
    Range,
    /// Distance from the air between
    Air,
    /// Classifiers against the limit
    Simulate,
    /// A scene as a heat cube
    Render,
    /// Decomposition of a heat cube, with a scene to make one
    Decompose,
    /// A library from a heat cube, with a scene to make one
    Library,
}

const SCENE: &str = include_str!("init/render.toml");

impl For {
    /// Its text, the name of its file, and the command that reads it.
    const fn template(self) -> (&'static str, &'static str, &'static str) {
        match self {
            Self::Size => (include_str!("init/size.toml"), "size.toml", "size"),
            Self::Identify => (include_str!("init/identify.toml"), "identify.toml", "identify"),
            Self::Find => (include_str!("init/find.toml"), "find.toml", "find"),
            Self::Rule => (include_str!("init/rule.toml"), "rule.toml", "rule"),
            Self::Range => (include_str!("init/range.toml"), "range.toml", "range"),
            Self::Air => (include_str!("init/air.toml"), "air.toml", "range"),
            Self::Simulate => (include_str!("init/simulate.toml"), "simulate.toml", "simulate"),
            Self::Render => (SCENE, "scene.toml", "render"),
            Self::Decompose => (include_str!("init/decompose.toml"), "decompose.toml", "decompose"),
            Self::Library => (include_str!("init/library.toml"), "library.toml", "library"),
        }
    }

    /// Whether it is about a cube that has to be made first.
    const fn needs_a_cube(self) -> bool {
        matches!(self, Self::Decompose | Self::Library)
    }
}

/// The commented file of the main job.
pub(super) fn size() -> String {
    commented(For::Size.template().0)
}

/// What was written, and what to do with it.
#[derive(Debug, Serialize)]
struct Written {
    /// The files that were written.
    files: Vec<PathBuf>,
    /// Commands that run them, in this order.
    commands: Vec<String>,
}

pub(super) fn run(args: &InitArgs, global: &Global) -> Result<ExitCode> {
    let (text, name, command) = args.command.template();
    let path = args.file.clone().unwrap_or_else(|| name.into());
    let mut files = vec![(path.clone(), text)];
    let mut commands = Vec::new();
    if args.command.needs_a_cube() {
        let scene = path.with_file_name("scene.toml");
        commands.push(format!(
            "hadar render {} --out {}",
            scene.display(),
            path.with_file_name("scene").display()
        ));
        files.insert(0, (scene, SCENE));
    }
    let out = if args.command == For::Render {
        format!(" --out {}", path.with_extension("").display())
    } else {
        String::new()
    };
    commands.push(format!("hadar {command} {}{out}", path.display()));
    // None is written where one of them is in the way; a scene may serve several files.
    let texts: Vec<String> = files.iter().map(|(_, text)| commented(text)).collect();
    let mut missing = Vec::new();
    for ((path, plain), text) in files.iter().zip(&texts) {
        let serves = *plain == SCENE
            && args.command.needs_a_cube()
            && path.metadata().is_ok_and(|there| there.is_file() && there.len() == text.len() as u64)
            && std::fs::read_to_string(path).is_ok_and(|there| there == *text);
        match path.exists() {
            false => missing.push((path, text)),
            true if serves => {}
            true => return Err(in_the_way(path)),
        }
    }
    missing.iter().try_for_each(|(path, text)| write(path, text))?;
    let written = Written { files: files.into_iter().map(|(path, _)| path).collect(), commands };
    let names: Vec<String> = written.files.iter().map(|path| path.display().to_string()).collect();
    let text = format!("wrote {}; run\n  {}", names.join(" and "), written.commands.join("\n  "));
    global.print(&written, &text)?;
    Ok(ExitCode::SUCCESS)
}

fn in_the_way(path: &Path) -> Error {
    Error::file(
        "write the template",
        path,
        "there is such a file; name another one, as in hadar init size mine.toml",
    )
}

fn write(path: &Path, text: &str) -> Result<()> {
    let created = OpenOptions::new().write(true).create_new(true).open(path);
    let written = created.and_then(|mut file| file.write_all(text.as_bytes()));
    written.map_err(|error| match error.kind() {
        ErrorKind::AlreadyExists => in_the_way(path),
        _ => Error::file("write the template", path, error),
    })
}
