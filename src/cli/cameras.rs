//! `hadar cameras`: the known cameras.

use super::Global;
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
            global.print(&serde_json::json!({ "cameras": cameras }), &out)?;
        }
        Action::Show { name } => {
            let camera = presets::get(name)?;
            let figures = camera.figures()?;
            let text = text::camera(&camera, &figures);
            global.print(&Shown { camera, figures }, &text)?;
        }
    }
    Ok(ExitCode::SUCCESS)
}
