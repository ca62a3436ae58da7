//! `hadar identify`: distances from the target to every alternative, all against all, bands, simulated decisions.

use super::global::{By, Global, condition, plain_number};
use super::progress::Bar;
use super::several;
use clap::Args;
use hadar::error::Result;
use hadar_report::identify;
use hadar_study::sweep::Question;
use hadar_study::{Asked, Condition, Law, Study, Trial, Watch};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

const ALL: &str = "All against all";
const BANDS: &str = "Bands and the size of the library";
const EXACT: &str = "Simulated decisions";

#[derive(Debug, Args)]
pub(super) struct IdentifyArgs {
    /// Scenario files (TOML), `-` for standard input; several give one table, a row for each
    #[arg(required = true, value_name = "SCENARIO")]
    scenarios: Vec<PathBuf>,
    /// The distance that decides, instead of the scenario's
    #[arg(long)]
    by: Option<By>,
    /// All materials against all: distances, the pairs that the camera distinguishes, clusters of those that it cannot
    #[arg(long, help_heading = ALL)]
    matrix: bool,
    /// Only which pairs of materials the camera distinguishes, each by the first proof
    #[arg(long, conflicts_with = "matrix", help_heading = ALL)]
    apart: bool,
    /// Prove nearest distances to this share of themselves (default: 1e-6, with several unknown temperatures 1e-3)
    #[arg(long, value_name = "SHARE", allow_negative_numbers = true, value_parser = plain_number)]
    prove: Option<f64>,
    /// How the least distance changes with the size of the library and the number of bands
    #[arg(long, help_heading = BANDS)]
    scaling: bool,
    /// Which bands matter, and the best K single bands for distinguishing the target from all alternatives
    #[arg(long, value_name = "K", help_heading = BANDS)]
    bands: Option<usize>,
    /// Which bands matter, and the best K contiguous filters, or fewer that do as well
    #[arg(long, value_name = "K", help_heading = BANDS)]
    filters: Option<usize>,
    /// Simulate the maximum-likelihood decision over all states, and compare it with the limits
    #[arg(long, help_heading = EXACT)]
    exact: bool,
    /// How counts scatter in the simulation (default: gaussian with a noisy camera, else poisson)
    #[arg(long, requires = "exact", help_heading = EXACT)]
    statistics: Option<Statistics>,
    /// Photons of the target in the simulation (default: the camera's; without one those required)
    #[arg(long, value_name = "N", requires = "exact", allow_negative_numbers = true, value_parser = plain_number, help_heading = EXACT)]
    photons: Option<f64>,
    /// Half width of the 95 % interval at which the simulation stops
    #[arg(long, value_name = "P", default_value_t = 0.01, requires = "exact", allow_negative_numbers = true, value_parser = plain_number, help_heading = EXACT)]
    half_width: f64,
    /// Most trials of a state in the simulation
    #[arg(long, value_name = "N", default_value_t = 1_000_000, requires = "exact", help_heading = EXACT)]
    trials: u64,
    /// Photons at which the hardest pair is distinguished on average over the priors of the scenario
    #[arg(long)]
    average: bool,
    /// Answer only whether the camera distinguishes the target from every alternative; exit with code 3 unless it does under no condition except those of --accept
    #[arg(long, conflicts_with_all = ["matrix", "apart", "scaling", "bands", "filters", "exact", "average"])]
    check: bool,
    /// With --check: codes of conditions under which a 'yes' is accepted; `hadar explain CODE` explains them
    #[arg(long, value_name = "CODE", num_args = 1.., value_delimiter = ',', value_parser = condition, requires = "check")]
    accept: Vec<String>,
}

pub(super) fn run(args: &IdentifyArgs, global: &Global) -> Result<ExitCode> {
    several::each(Question::Identify, &args.scenarios, global, |path, global| one(path, args, global))
}

fn one(scenario: &Path, args: &IdentifyArgs, global: &Global) -> Result<u8> {
    let mut study = global.study(scenario, args.by.map(Into::into))?;
    if let Some(share) = args.prove {
        study = study.proving(share)?;
    }
    if args.check {
        return only_check(&study, &args.accept, global);
    }
    let chosen = args.bands.is_some() || args.filters.is_some();
    let asked = Asked {
        matrix: args.matrix,
        apart: args.apart,
        skipping: global.skipping(),
        scaling: args.scaling,
        bands: chosen.then_some((args.bands, args.filters)),
        exact: args.exact.then(|| trial(args, global)).transpose()?,
        average: args.average,
    };
    let bars = ["targets searched", "pairs decided", "pairs simulated", "states of the priors"];
    let bars = bars.map(|what| global.progress(what));
    let [searched, decided, simulated, averaged] = bars.each_ref().map(|bar| |done, all| bar.set(done, all));
    let watch = Watch { searched: &searched, decided: &decided, simulated: &simulated, averaged: &averaged };
    let mut answers = study.answer(&asked, &watch)?;
    bars.iter().for_each(Bar::finish);
    let text = identify::text(&answers, &study);
    let report = global.report(&text, || identify::bundle(&study, &answers, global.seed))?;
    answers.identification.stats.add(&report);
    global.answer(&answers, &text, &answers.identification.stats)?;
    Ok(0)
}

/// Laws of counting, as a flag.
#[derive(Debug, Clone, Copy, clap::ValueEnum)]
enum Statistics {
    /// Shot noise alone
    Poisson,
    /// Shot noise and the camera's electronic noise
    Gaussian,
    /// Bunched photons of thermal light
    NegativeBinomial,
}

fn trial(args: &IdentifyArgs, global: &Global) -> Result<Trial> {
    let law = args.statistics.map(|statistics| match statistics {
        Statistics::Poisson => Law::Poisson,
        Statistics::Gaussian => Law::Gaussian,
        Statistics::NegativeBinomial => Law::NegativeBinomial,
    });
    Trial::asked(law, args.photons, (global.seed, args.half_width, args.trials))
}

/// The answer to one question, at the first proof.
fn only_check(study: &Study, accepted: &[String], global: &Global) -> Result<u8> {
    global.writes_nothing("--check, which answers yes or no,")?;
    let mut result = study.check_with_conditions(global.skipping())?;
    result.accepted = accepted.to_vec();
    global.answer(&result, &identify::check(&result, study), &result.stats)?;
    let is_open = Condition::unaccepted(&result.conditions, accepted).next().is_some();
    Ok(if result.identifiable && !is_open { 0 } else { 3 })
}
