//! `hadar serve`: the main job as a page in the browser of this machine.

use super::global::{Global, put};
use super::{init, provenance};
use clap::Args;
use hadar::error::{Error, Result};
use hadar_scenario::command_for;
use hadar_serve::Engine;
use hadar_study::OwnCameras;
use std::net::{Ipv4Addr, TcpListener};
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct ServeArgs {
    /// The scenario that the page begins with, or the rule for the page of rules, `-` for standard input; default: that of
    /// `hadar init size`
    scenario: Option<PathBuf>,
    /// Port on 127.0.0.1; 0 takes any that is free
    #[arg(long, value_name = "PORT", default_value_t = 8731)]
    port: u16,
}

pub(super) fn run(args: &ServeArgs, global: &Global) -> Result<ExitCode> {
    let written = args.scenario.as_ref().map(|path| global.written(path)).transpose()?;
    let (begin, begin_rule) = match written {
        Some(written) if matches!(command_for(&written), Ok(Some("rule"))) => {
            (init::size(), Some(written.text.to_string()))
        }
        Some(written) => (written.text.to_string(), None),
        None => (init::size(), None),
    };
    let page = if begin_rule.is_some() { "rules" } else { "" };
    let engine = Engine {
        library: global.library()?,
        cameras: OwnCameras::from_files(&global.cameras)?,
        begin,
        begin_rule,
        commit: provenance::COMMIT.to_owned(),
        limits: global.limits,
    };
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, args.port)).map_err(|error| {
        let found = format!("port {} of 127.0.0.1 cannot be taken ({})", args.port, error.kind());
        Error::malformed(found, "name another --port, or 0 for any that is free")
    })?;
    let address =
        listener.local_addr().map_err(|error| Error::malformed(error.to_string(), "name another --port"))?;
    put(&format!("http://{address}/{page}"))?;
    global.note("open it in a browser of this machine; Ctrl-C ends it");
    hadar_serve::serve(engine, listener)?;
    Ok(ExitCode::SUCCESS)
}
