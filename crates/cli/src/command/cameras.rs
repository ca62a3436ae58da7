//! `hadar cameras`: the known cameras.

use super::global::Global;
use clap::{Args, Subcommand};
use hadar::demand::{Reason, Thing, Work};
use hadar::error::Result;
use hadar::instrument::presets::{self, Preset};
use hadar_report::cameras::{self, Sheet, SideBySide};
use hadar_study::OwnCameras;
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct CamerasArgs {
    #[command(subcommand)]
    action: Action,
}

#[derive(Debug, Subcommand)]
enum Action {
    /// All known cameras, and what is not known of them
    List,
    /// One camera: its figures, what follows from them, and where they are from
    Show {
        /// Name of the camera
        name: String,
    },
    /// Two cameras side by side: photons, noise, and how far apart each sees the same two spectra
    Compare {
        /// Name of the first camera
        a: String,
        /// Name of the second one; ratios are of it over the first
        b: String,
    },
}

pub(super) fn run(args: &CamerasArgs, global: &Global) -> Result<ExitCode> {
    let all: Vec<Preset> =
        presets::all()?.iter().cloned().chain(OwnCameras::from_files(&global.cameras)?.presets).collect();
    let find = |name: &String| {
        let own = all.iter().find(|camera| camera.file.is_some() && camera.name == *name);
        own.map_or_else(|| presets::find(name).cloned(), |own| Ok(own.clone()))
    };
    let known = all.len();
    match &args.action {
        Action::List => {
            let json = serde_json::json!({ "cameras": all });
            let sheets = all.iter().cloned().map(Sheet::stated).collect::<Vec<_>>();
            global.answer_with(json, &cameras::list(&sheets), &work(0, known))?;
        }
        Action::Show { name } => {
            let sheet = Sheet::of(find(name)?)?;
            let work = work(usize::from(sheet.worked.is_some()), known);
            global.answer_with(sheet.json()?.into(), &cameras::text(&sheet), &work)?;
        }
        Action::Compare { a, b } => {
            let (a, b) = (find(a)?, find(b)?);
            let asked = if a.name == b.name { 1 } else { 2 };
            let both = SideBySide::of(Sheet::of(a)?, Sheet::of(b)?)?;
            let shown = [&both.a, &both.b].iter().take(asked).filter(|sheet| sheet.worked.is_some()).count();
            let json = cameras::comparison_json(&both)?;
            global.answer_with(json, &cameras::comparison(&both), &work(shown, known))?;
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// Cameras whose figures were worked out, of so many that are known.
fn work(shown: usize, known: usize) -> Work {
    let mut work = Work::default();
    work.compute(Thing::Cameras, shown as u64);
    work.spare(Thing::Cameras, Reason::NotAsked, (known - shown) as u64);
    work
}
