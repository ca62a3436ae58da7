//! `hadar simulate`: spectra drawn, classifiers trained and judged, held against the limit.

use super::global::Global;
use clap::Args;
use hadar::demand::{Work, ledger_of};
use hadar::error::{Error, Result};
use hadar_report::bundle::Bundle;
use hadar_report::simulate::{self, average as average_report, thermometry as thermometry_report};
use hadar_study::{PhotonLaw, SimulationAsked, SimulationPlan, Study, true_temperatures};
use std::path::PathBuf;
use std::process::ExitCode;

/// Most spectra at each true temperature.
const MOST_READINGS: usize = 10_000_000;
/// Normalised photon numbers N d₀² that curves of a sweep cover.
const CURVES: [f64; 2] = [0.01, 1e8];
const CURVE_POINTS: usize = 101;

#[derive(Debug, Args)]
pub(super) struct SimulateArgs {
    /// The scenario file (TOML)
    scenario: PathBuf,
    /// Classifiers that take part: likelihood-ratio, best-fits, discriminant, logistic, network (default: all)
    #[arg(long, value_name = "NAMES", value_delimiter = ',', help_heading = "Classifiers")]
    classifiers: Vec<String>,
    /// Spectra of each class: a quarter for training, a quarter for validation, half for the test
    #[arg(long, value_name = "N", default_value_t = hadar_study::sweep::SPECTRA, help_heading = "Spectra")]
    spectra: usize,
    /// Photons of the target, one experiment each (default: the camera's; without one those required)
    #[arg(
        long,
        value_name = "N",
        value_delimiter = ',',
        allow_negative_numbers = true,
        help_heading = "Spectra"
    )]
    photons: Vec<f64>,
    /// K experiments with N d0^2/(1+gamma) from 0.01 to 10, d0 the nearest distance in shot noise, gamma that of the camera
    #[arg(long, value_name = "K", conflicts_with = "photons", help_heading = "Spectra")]
    sweep: Option<usize>,
    /// How photons are counted
    #[arg(long, value_enum, default_value_t = Statistics::Poisson, help_heading = "Spectra")]
    statistics: Statistics,
    /// Leave out the camera's electronic noise
    #[arg(long, help_heading = "Spectra")]
    shot_noise_only: bool,
    /// Alternatives that are classes in addition to the target (default: the most similar one); `all` for all of them
    #[arg(long, value_name = "NAMES", value_delimiter = ',', help_heading = "Spectra")]
    against: Vec<String>,
    /// Write the trained classifiers of the last experiment into this folder
    #[arg(long, value_name = "DIR", help_heading = "Classifiers")]
    save_models: Option<PathBuf>,
    /// A saved classifier that takes part as it is; may be given several times
    #[arg(long, value_name = "FILE", help_heading = "Classifiers")]
    model: Vec<PathBuf>,
    /// Write the spectra that classifiers are judged on into the report of --out, with the classes' states and mean counts
    #[arg(long, help_heading = "Spectra")]
    save_spectra: bool,
    /// Draw the likelihood ratio itself instead of spectra: far quicker where it alone takes part, and as accurate
    #[arg(long, help_heading = "Spectra")]
    skip_spectra: bool,
    /// Read the target's temperature instead: by maximum likelihood and by thermal imaging at true temperatures
    /// such as "30 degC..105 degC", or at a single one; --spectra are drawn at each
    #[arg(long, value_name = "RANGE", allow_hyphen_values = true, conflicts_with_all = CLASSIFYING, help_heading = "Thermometry")]
    thermometry: Option<String>,
    /// How many true temperatures there are in the range
    #[arg(
        long,
        value_name = "N",
        default_value_t = 16,
        requires = "thermometry",
        help_heading = "Thermometry"
    )]
    temperatures: usize,
    /// Draw the states of both materials from the priors, decide by the ratio of the mixtures, and hold the share of right
    /// decisions against its limits on either side, with --spectra of each material
    #[arg(long, conflicts_with_all = JUDGING, help_heading = "Spectra")]
    average: bool,
    /// Exit with code 3 if a classifier was right more often than the limit allows
    #[arg(long)]
    check: bool,
}

impl SimulateArgs {
    /// Whether it writes files beside its report.
    pub(super) fn saves_models(&self) -> bool {
        self.save_models.is_some()
    }
}

/// Flags of classifiers, which mean nothing where the Bayes test decides.
const JUDGING: [&str; 6] = ["classifiers", "sweep", "save_models", "model", "skip_spectra", "thermometry"];

/// Flags that say how classifiers are judged, and nothing to thermometry.
const CLASSIFYING: [&str; 11] = [
    "classifiers",
    "photons",
    "sweep",
    "statistics",
    "shot_noise_only",
    "against",
    "save_models",
    "model",
    "check",
    "skip_spectra",
    "save_spectra",
];

/// Laws of photons, as a flag.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Statistics {
    /// Each on its own
    Poisson,
    /// Bunched, as thermal light is
    NegativeBinomial,
    /// As many in every spectrum: multinomial
    FixedTotal,
}

pub(super) fn run(args: &SimulateArgs, global: &Global) -> Result<ExitCode> {
    let study = global.study(&args.scenario, None)?;
    if let Some(range) = &args.thermometry {
        return thermometry(range, args, &study, global);
    }
    if let Some(folder) = &args.save_models {
        let models = global.folder(folder);
        models.check()?;
        if global.out.as_ref().is_some_and(|out| global.folder(out).is(&models)) {
            let found = "--save-models and --out name one folder, where one would replace the other";
            return Err(Error::malformed(found, "name a folder within, such as --save-models DIR/models"));
        }
    }
    if args.save_spectra && global.out.is_none() {
        let found = "--save-spectra writes into the folder of a report, and there is none";
        return Err(Error::malformed(found, "name one with --out"));
    }
    let (plan, planning) = ledger_of(|| plan(args, &study, global))?;
    if args.check && (plan.against.len() > 1 || plan.law == PhotonLaw::FixedTotal) {
        let found = "--check holds two classes against their limit, which is not known here";
        return Err(Error::malformed(found, "name one alternative with --against, or leave out fixed-total"));
    }
    if args.average {
        return average(args, &plan, planning, &study, global);
    }
    let bar = global.progress("experiments");
    let (mut result, models) = study.simulate(&plan, &|done, total| bar.set(done, total))?;
    bar.finish();
    if let Some(folder) = &args.save_models {
        let mut bundle = Bundle::default();
        for saved in &models {
            bundle.add(format!("{}.json", saved.model.method().name()), saved.to_json()?);
        }
        global.write(&bundle, folder, None)?;
    }
    let text = simulate::text(&result, &study);
    let report = global.report(&text, || {
        let rival = result.points.first().and_then(|point| point.classes.get(1));
        let rival =
            rival.filter(|_| args.sweep.is_some()).and_then(|class| study.alternative(&class.material));
        let noise = rival.map(|rival| study.noise_curves(rival, CURVES, CURVE_POINTS)).transpose()?;
        simulate::bundle(&study, &result, noise.as_ref())
    })?;
    result.stats.add(&planning.and(&report));
    global.answer(&result, &text, &result.stats)?;
    let failed = args.check && !result.limit_holds;
    Ok(if failed { ExitCode::from(3) } else { ExitCode::SUCCESS })
}

fn average(
    args: &SimulateArgs,
    plan: &SimulationPlan,
    planning: Work,
    study: &Study,
    global: &Global,
) -> Result<ExitCode> {
    let mut result = study.simulate_average(plan)?;
    let text = average_report::text(&result, study);
    let report = global.report(&text, || average_report::bundle(study, &result))?;
    result.stats.add(&planning.and(&report));
    global.answer(&result, &text, &result.stats)?;
    Ok(if args.check && !result.brackets_hold { ExitCode::from(3) } else { ExitCode::SUCCESS })
}

fn thermometry(range: &str, args: &SimulateArgs, study: &Study, global: &Global) -> Result<ExitCode> {
    let temperatures = true_temperatures(range, args.temperatures)?;
    if args.spectra > MOST_READINGS {
        let expected = format!("at most {MOST_READINGS} at each temperature");
        return Err(Error::out_of_range("--spectra", args.spectra as f64, "", expected));
    }
    let bar = global.progress("temperatures");
    let mut result =
        study.thermometry(&temperatures, args.spectra, global.seed, &|done, total| bar.set(done, total))?;
    bar.finish();
    let text = thermometry_report::text(&result);
    result.stats.add(&global.report(&text, || thermometry_report::bundle(study, &result))?);
    global.answer(&result, &text, &result.stats)?;
    Ok(ExitCode::SUCCESS)
}

fn plan(args: &SimulateArgs, study: &Study, global: &Global) -> Result<SimulationPlan> {
    study.plan(&SimulationAsked {
        classifiers: args.classifiers.clone(),
        spectra: args.spectra,
        photons: args.photons.clone(),
        sweep: args.sweep,
        law: match args.statistics {
            Statistics::Poisson => PhotonLaw::Poisson,
            Statistics::NegativeBinomial => PhotonLaw::NegativeBinomial,
            Statistics::FixedTotal => PhotonLaw::FixedTotal,
        },
        camera_noise: !args.shot_noise_only,
        against: args.against.clone(),
        models: args.model.clone(),
        skip_spectra: args.skip_spectra,
        save_spectra: args.save_spectra,
        seed: global.seed,
    })
}
