//! `hadar identify`: distances from the target to every alternative.

use super::{By, Global};
use crate::error::Result;
use crate::report::bundle::Bundle;
use crate::report::{tables, text};
use clap::Args;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct IdentifyArgs {
    /// The scenario file (TOML)
    scenario: PathBuf,
    /// The distance that decides, instead of the scenario's
    #[arg(long)]
    by: Option<By>,
}

pub(super) fn run(args: &IdentifyArgs, global: &Global) -> Result<ExitCode> {
    let study = global.study(&args.scenario, args.by.map(Into::into))?;
    let result = study.identify()?;
    if let Some(out) = &global.out {
        let mut bundle = Bundle::default();
        bundle.add("scenario.toml", study.scenario().to_toml_beside(out));
        bundle.add("pairs.csv", tables::pairs(&result.pairs).to_csv()?);
        bundle.add("warnings.csv", tables::warnings(&result.warnings).to_csv()?);
        global.write(&bundle, out)?;
    }
    global.print(&result, &text::identification(&result, &study))?;
    Ok(ExitCode::SUCCESS)
}
