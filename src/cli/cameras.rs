//! `hadar cameras`: the known cameras.

use super::{Global, as_json};
use crate::demand::{Reason, Thing, Work};
use crate::error::Result;
use crate::instrument::{Camera, Figures, presets};
use crate::report::text;
use clap::{Args, Subcommand};
use std::fmt::Write as _;
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct CamerasArgs {
    #[command(subcommand)]
    action: Action,
}

#[derive(Debug, Subcommand)]
enum Action {
    /// All known cameras
    List,
    /// One camera: its figures and where they are from
    Show {
        /// Name of the camera
        name: String,
    },
}

/// A camera and what follows from its figures.
#[derive(serde::Serialize)]
struct Shown {
    #[serde(flatten)]
    camera: Camera,
    #[serde(flatten)]
    figures: Figures,
}

pub(super) fn run(args: &CamerasArgs, global: &Global) -> Result<ExitCode> {
    match &args.action {
        Action::List => {
            let cameras = presets::all()?;
            let mut out = String::new();
            for camera in &cameras {
                let _ = writeln!(out, "{:<14} {}", camera.name, camera.description);
            }
            global.answer_with(serde_json::json!({ "cameras": cameras }), &out, &work(0, cameras.len()))?;
        }
        Action::Show { name } => {
            let camera = presets::get(name)?;
            let others = presets::all()?.len() - 1;
            let figures = camera.figures()?;
            let text = text::camera(&camera, &figures);
            global.answer_with(as_json(&Shown { camera, figures })?, &text, &work(1, others))?;
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// Cameras whose figures were worked out, and those of which none were asked for.
fn work(shown: usize, others: usize) -> Work {
    let mut work = Work::default();
    work.compute(Thing::Cameras, shown as u64);
    work.spare(Thing::Cameras, Reason::NotAsked, others as u64);
    work
}
