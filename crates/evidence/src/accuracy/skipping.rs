//! What skipping is worth: real questions answered with everything that is needless left out, and with all of it computed.
//!
//! Both ways are timed one after the other several times, the least of each counts, and the answers are compared. Of
//! the seven questions one is of a kind that nothing can be spared of.

use hadar::demand::{self, Skipping, Work, ledger_of};
use hadar::error::{Error, Result};
use hadar::material::Library;
use hadar::ranging::information::decide::decide;
use hadar::ranging::information::{Cell, Request, information};
use hadar_scenario::examples::{FIVE_MATERIALS, HUMAN_VS_ROBOT, HUMAN_VS_ROBOT_3_BANDS, STREET};
use hadar_scenario::{DistanceKind, RangeScenario, Scenario};
use hadar_simulate::classifier::Method;
use hadar_simulate::experiment::Design;
use hadar_simulate::sequential::{Interval, Plan};
use hadar_study::range::RangeStudy;
use hadar_study::{Apart, Exact, PhotonLaw, Simulation, SimulationPlan, Study, Trial};
use std::time::Instant;

/// Times that both ways are run; with `quick` fewer.
const RUNS: [usize; 2] = [5, 2];
/// Half width of the simulated decision's 95 % interval; with `quick` wider.
const HALF_WIDTH: [f64; 2] = [0.005, 0.02];
/// Spectra of each class that classifiers are judged on and trained with.
const SPECTRA: [usize; 2] = [5000, 400];
/// Rows and columns of the street; with `quick` fewer.
const VIEW: [&str; 2] = ["480, 640", "96, 128"];
/// Depth at which a window of the street is asked for, m.
const DEPTH_M: f64 = 12.0;
/// Seed of all draws.
const SEED: u64 = 1;

/// A question answered both ways.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Skipped {
    /// Name of the scenario that is computed.
    pub scenario: &'static str,
    /// Name of the question that is answered for it.
    pub question: &'static str,
    /// Time of the answer with skipping, s.
    pub seconds_on: f64,
    /// Time of the answer with everything computed, s.
    pub seconds_off: f64,
    /// Whether both answers are the same.
    pub answers_equal: bool,
    /// What it took with skipping.
    pub work: Work,
}

impl Skipped {
    /// How many times as long everything takes.
    #[must_use]
    pub fn gain(&self) -> f64 {
        self.seconds_off / self.seconds_on
    }
}

/// Answers all questions both ways; `quick` takes smaller scenes and fewer runs.
///
/// # Errors
/// None that a release can have: scenarios and spectra are embedded and tested.
pub fn skipping(quick: bool) -> Result<Vec<Skipped>> {
    let level = usize::from(quick);
    let library = Library::embedded()?;
    let bench = Bench { runs: RUNS[level] };
    let study = |toml: &str| Study::new(&Scenario::from_toml(toml, None)?, &library);
    let coarse =
        |toml: &str| if quick { toml.replace("\"1 cm^-1\"", "\"4 cm^-1\"") } else { toml.to_owned() };
    let five = study(&coarse(FIVE_MATERIALS))?;
    let all_at_once = study(&coarse(&all_materials(FIVE_MATERIALS)))?;
    let person = study(&coarse(&all_materials(HUMAN_VS_ROBOT)))?;
    let mut by_local = Scenario::from_toml(&coarse(FIVE_MATERIALS), None)?;
    by_local.requirement.by = DistanceKind::Local;
    let by_local = Study::new(&by_local, &library)?;
    let three = study(HUMAN_VS_ROBOT_3_BANDS)?;
    let street = STREET.replace("[bands]", &format!("size = [{}]\n[bands]", VIEW[level]));
    let street = RangeStudy::new(&RangeScenario::from_toml(&street, None)?, &library)?;
    let apart = "which pairs the camera distinguishes";
    let told = |study: &'static str, at: &Study| {
        bench.compared((study, apart), |skipping| at.told_apart(skipping, &|_, _| ()), same_pairs)
    };
    Ok(vec![
        told("five materials", &five)?,
        told("the built-in library", &all_at_once)?,
        bench.compared(
            ("a person among the built-in library", "whether the camera distinguishes the target from all"),
            |skipping| person.check(skipping).inspect(|check| demand::add(&check.stats)),
            |a, b| (a.identifiable, &a.not_told_from) == (b.identifiable, &b.not_told_from),
        )?,
        windows(&bench, &street)?,
        decision(&bench, &three, HALF_WIDTH[level])?,
        classifier(&bench, &three, SPECTRA[level])?,
        told("five materials, by the local distance", &by_local)?,
    ])
}

/// A scenario whose alternatives are all other materials of the library.
fn all_materials(toml: &str) -> String {
    let kept = toml.lines().filter(|line| !line.starts_with("materials = "));
    kept.collect::<Vec<_>>().join("\n")
}

/// Runs both ways in turn.
struct Bench {
    runs: usize,
}

impl Bench {
    fn compared<A>(
        &self,
        (scenario, question): (&'static str, &'static str),
        answer: impl Fn(Skipping) -> Result<A>,
        same: impl Fn(&A, &A) -> bool,
    ) -> Result<Skipped> {
        let [mut on, mut off] = [f64::INFINITY; 2];
        let mut answers_equal = true;
        let mut took = Work::default();
        for _ in 0..self.runs {
            let ((skipped, work), seconds_on) = timed(|| ledger_of(|| answer(Skipping::On)))?;
            let (whole, seconds_off) = timed(|| answer(Skipping::Off))?;
            (on, off) = (on.min(seconds_on), off.min(seconds_off));
            answers_equal &= same(&skipped, &whole);
            took = work;
        }
        Ok(Skipped { scenario, question, seconds_on: on, seconds_off: off, answers_equal, work: took })
    }
}

fn timed<A>(make: impl FnOnce() -> Result<A>) -> Result<(A, f64)> {
    let start = Instant::now();
    let made = make()?;
    Ok((made, start.elapsed().as_secs_f64()))
}

fn same_pairs(a: &Apart, b: &Apart) -> bool {
    (&a.told_apart, &a.not_told_apart, &a.clusters) == (&b.told_apart, &b.not_told_apart, &b.clusters)
}

/// Windows of a rendered cube that allow the demanded depth error at one depth: by proofs, and by the whole map.
fn windows(bench: &Bench, study: &RangeStudy) -> Result<Skipped> {
    let Some((cube, noise)) = study.rendered_left(&|_, _| ())? else {
        return Err(Error::malformed("a street that is no scene", "report this as a bug"));
    };
    let stereo = &study.scenario().stereo;
    let shape = cube.shape();
    let request = Request {
        window: stereo.window,
        derivative: stereo.derivative,
        noise,
        joined: stereo.joined,
        cells: &[Cell::Full],
        centres: 0..shape.rows(),
    };
    let per_px_m = study.stereo_geometry().depth_error_m(DEPTH_M, 1.0)?;
    let allowed_px = study.scenario().requirement.error.at(DEPTH_M) / per_px_m;
    let required = 2.0 / (allowed_px * allowed_px);
    let answer = |skipping: Skipping| match skipping {
        Skipping::On => {
            let decision = decide(&cube, &request, required)?;
            demand::add(&decision.stats.work(shape.len()));
            Ok(decision.above)
        }
        Skipping::Off => {
            let map = information(&cube, &request)?;
            let above = map.cell(Cell::Full).iter().map(|j| *j >= required);
            Ok(above.collect())
        }
    };
    let names = ("a street's heat cube", "which windows allow 1 % of the depth at 12 m");
    bench.compared(names, answer, |a: &Vec<bool>, b| a == b)
}

/// The accuracy of the best decision within so much: in rounds until the interval is narrow enough, and with as many
/// trials as that takes at most, whatever comes out.
fn decision(bench: &Bench, study: &Study, half_width: f64) -> Result<Skipped> {
    // A mean of two proportions, each with variance 1/4n at most: h = z/√(8n).
    let most = (1.96_f64 / half_width).powi(2) / 8.0;
    let photons = study.identify()?.pairs.first().and_then(|pair| pair.photons_required);
    let answer = |skipping: Skipping| {
        let plan = match skipping {
            Skipping::On => Plan::new(SEED, half_width, most.ceil() as u64)?,
            // No interval is as narrow as that.
            Skipping::Off => Plan::new(SEED, 1e-9, most.ceil() as u64)?,
        };
        study.exact(&Trial { law: Some(hadar_study::Law::Poisson), photons, plan }, &|_, _| ())
    };
    let interval = |exact: &Exact| exact.pairs.first().map(|pair| pair.balanced_interval);
    let agree = |a: &Exact, b: &Exact| match (interval(a), interval(b)) {
        (Some(a), Some(b)) => {
            let narrow = |i: &Interval| i.half_width() <= 1.01 * half_width;
            narrow(&a) && narrow(&b) && a.low <= b.high && b.low <= a.high
        }
        _ => false,
    };
    let names = ("a person or a robot in three bands", "how often the best decision is right");
    bench.compared(names, answer, agree)
}

/// How often the likelihood ratio is right: alone, and among all classifiers.
fn classifier(bench: &Bench, study: &Study, per_class: usize) -> Result<Skipped> {
    let photons = study.identify()?.pairs.first().and_then(|pair| pair.photons_required);
    let answer = |skipping: Skipping| {
        let methods = match skipping {
            Skipping::On => vec![Method::LikelihoodRatio],
            Skipping::Off => Method::ALL.to_vec(),
        };
        let design = Design { per_class, methods, seed: SEED, level: 0.95, skip_spectra: false };
        let plan = SimulationPlan {
            photons: photons.into_iter().collect(),
            law: PhotonLaw::Poisson,
            camera_noise: false,
            against: Vec::new(),
            design,
            models: Vec::new(),
            save_spectra: false,
        };
        let (result, _) = study.simulate(&plan, &|_, _| ())?;
        demand::add(&result.stats);
        Ok(result)
    };
    let ratio = |found: &Simulation| {
        let performances = found.points.first().map(|point| point.performances.as_slice());
        let own =
            performances.unwrap_or_default().iter().find(|p| p.performance.method == Method::LikelihoodRatio);
        own.map(|own| (own.performance.accuracy, own.performance.interval))
    };
    let names = ("a person or a robot in three bands", "how often the likelihood ratio is right");
    bench.compared(names, answer, |a, b| ratio(a).is_some() && ratio(a) == ratio(b))
}
