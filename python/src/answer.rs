//! The commands `size`, `identify`, `rule`, `range` and `simulate`: the same study, the same JSON.

use crate::asked::{asked, keyword};
use crate::error::{named, raised};
use crate::question::Question;
use crate::threads::{Counted, Threads, with_limits, with_threads};
use hadar::demand::{Reason, Skipping, Thing, Work, ledger_of};
use hadar::error::{Error, Result};
use hadar::inputs::Noting;
use hadar::material::Library;
use hadar_formats::ReadLibrary as _;
use hadar_report::bundle::Bundle;
use hadar_report::manifest::{Provenance, answer_json};
use hadar_report::words::Say;
use hadar_report::{
    air_ranging, identify as identify_report, range, rule as rule_report, simulate as simulate_report,
    size as size_report,
};
use hadar_scenario::{DistanceKind, RangingScenario, Rule, Scenario, day};
use hadar_study::air_ranging::{AirPlan, AirRangingStudy};
use hadar_study::budget::{self, Limits, Takes};
use hadar_study::range::{RangePlan, RangeStudy};
use hadar_study::{
    Asked, Extent, Law, PhotonLaw, RuleAsked, RuleStudy, SimulationAsked, Study, Trial, Warning, Watch,
};
use pyo3::prelude::*;
use std::path::PathBuf;

type Draw = Box<dyn Fn() -> Result<Bundle> + Send + Sync>;

/// What a command answers.
#[pyclass(frozen, module = "hadar_limits._hadar")]
pub(crate) struct Answer {
    /// One JSON object, as the command prints with `--json`.
    #[pyo3(get)]
    json: String,
    /// As the command prints.
    #[pyo3(get)]
    text: String,
    /// What is to be said of the library.
    #[pyo3(get)]
    library_warnings: Vec<String>,
    draw: Draw,
}

#[pymethods]
impl Answer {
    /// The pictures as SVG, by the names of their files.
    fn pictures(&self, py: Python<'_>) -> PyResult<Vec<(String, String)>> {
        with_threads(py, None, || (self.draw)()?.drawings())
    }
}

asked! {
    /// What all commands share.
    Common {
        library: Vec<PathBuf>,
        only_library: bool,
        skip_uncovered: bool,
        seed: u64,
        skipping: bool,
        threads: Option<Threads>,
        time_limit: Option<String>,
        memory_limit: Option<String>,
        progress: Option<Py<PyAny>>,
    }
}

/// Found by a command: text, JSON, pictures to be drawn.
struct Found {
    json: String,
    text: String,
    draw: Draw,
}

impl Common {
    fn skipping(&self) -> Skipping {
        if self.skipping { Skipping::On } else { Skipping::Off }
    }

    fn limits(&self) -> Result<Limits> {
        let time = self.time_limit.as_deref().map(budget::time).transpose();
        let memory = self.memory_limit.as_deref().map(budget::size).transpose();
        Ok(Limits {
            time: time.map_err(|error| error.for_key("time_limit"))?,
            memory_bytes: memory.map_err(|error| error.for_key("memory_limit"))?,
        })
    }

    fn library(&self) -> Result<Library> {
        let mut library = if self.only_library { Library::empty() } else { Library::embedded()? };
        for path in &self.library {
            library.add_path(path)?;
        }
        if library.is_empty() {
            return Err(Error::malformed(
                "the library is empty",
                "add spectra with library=, or leave out only_library",
            ));
        }
        Ok(library)
    }

    /// Refuses what takes more than is allowed.
    fn admit(&self, takes: Takes) -> Result<()> {
        self.limits()?.admit(takes, rayon::current_num_threads())
    }

    /// Answers without the interpreter; files are noted as they are read.
    fn answer(
        &self,
        py: Python<'_>,
        question: &Question,
        find: impl FnOnce(&Noting, &mut Reading<'_>) -> Result<Found> + Send,
    ) -> PyResult<Answer> {
        let limits = self.limits().map_err(raised)?;
        with_limits(py, self.threads, &limits, self.progress.as_ref(), |counted| {
            let noting = Noting::open();
            let mut reading = Reading { common: self, said: Vec::new(), counted };
            let found = find(&noting, &mut reading).map_err(|error| question.told(error))?;
            let Found { json, text, draw } = found;
            let library_warnings = reading.said.iter().map(|warning| warning.say()).collect();
            Ok(Answer { json, text, library_warnings, draw })
        })
    }

    fn study(
        &self,
        question: &Question,
        by: Option<DistanceKind>,
        reading: &mut Reading<'_>,
    ) -> Result<Study> {
        let mut scenario = question.read(Scenario::from_file, Scenario::from_toml)?;
        if let Some(by) = by {
            scenario.requirement.by = by;
        }
        scenario.alternatives.skip_uncovered |= self.skip_uncovered;
        let study = Study::new_skipping(&scenario, &reading.library()?, self.skipping())?;
        self.admit(study.takes())?;
        Ok(study)
    }
}

/// The library as a question reads it, with what is to be said of it, and how far the answer is.
struct Reading<'a> {
    common: &'a Common,
    said: Vec<Warning>,
    counted: &'a Counted,
}

impl Reading<'_> {
    fn library(&mut self) -> Result<Library> {
        let library = self.common.library()?;
        self.said =
            library.warnings().iter().map(|remark| Warning::Library { remark: remark.clone() }).collect();
        Ok(library)
    }

    fn json(&self, answer: &impl serde::Serialize) -> Result<String> {
        answer_json(answer, &self.said, &[])
    }
}

/// A report that nobody asked for, as the command counts it.
fn no_report() -> Work {
    let mut work = Work::default();
    work.spare(Thing::Reports, Reason::NotAsked, 1);
    work
}

fn by_name(by: Option<&str>) -> PyResult<Option<DistanceKind>> {
    let of = |by| named("distance", by, &DistanceKind::ALL, DistanceKind::name).map_err(raised);
    by.map(of).transpose()
}

/// `hadar size`.
#[pyfunction]
pub(crate) fn size(
    py: Python<'_>,
    scenario: &Bound<'_, PyAny>,
    by: Option<&str>,
    common: Common,
) -> PyResult<Answer> {
    let (question, by) = (Question::of(scenario)?, by_name(by)?);
    common.answer(py, &question, |_, reading| {
        let study = common.study(&question, by, reading)?;
        let mut result = study.size()?;
        let (trade_offs, work) = ledger_of(|| study.trade_offs(&result))?;
        result.trade_offs = Some(trade_offs);
        result.stats.add(&work);
        let text = size_report::text(&result, &study);
        result.stats.add(&no_report());
        let json = reading.json(&result)?;
        Ok(Found { json, text, draw: Box::new(move || size_report::bundle(&study, &result)) })
    })
}

asked! {
    /// What `hadar identify` can be asked besides.
    Identify {
        matrix: bool,
        apart: bool,
        prove: Option<f64>,
        scaling: bool,
        bands: Option<usize>,
        filters: Option<usize>,
        exact: bool,
        statistics: Option<String>,
        photons: Option<f64>,
        half_width: f64,
        trials: u64,
        average: bool,
    }
}

const LAWS: [(Law, &str); 3] =
    [(Law::Poisson, "poisson"), (Law::Gaussian, "gaussian"), (Law::NegativeBinomial, "negative-binomial")];

/// `hadar identify`.
#[pyfunction]
pub(crate) fn identify(
    py: Python<'_>,
    scenario: &Bound<'_, PyAny>,
    by: Option<&str>,
    more: Identify,
    common: Common,
) -> PyResult<Answer> {
    let (question, by) = (Question::of(scenario)?, by_name(by)?);
    let law = more.statistics.as_deref().map(|law| named("statistics", law, &LAWS, |law| law.1));
    let law = law.transpose().map_err(raised)?.map(|law| law.0);
    common.answer(py, &question, |_, reading| {
        let mut study = common.study(&question, by, reading)?;
        if let Some(share) = more.prove {
            study = study.proving(share)?;
        }
        let trial = || Trial::asked(law, more.photons, (common.seed, more.half_width, more.trials));
        let asked = Asked {
            matrix: more.matrix,
            apart: more.apart,
            skipping: common.skipping(),
            scaling: more.scaling,
            bands: (more.bands.is_some() || more.filters.is_some()).then_some((more.bands, more.filters)),
            exact: more.exact.then(trial).transpose()?,
            average: more.average,
        };
        let count = |done, of| reading.counted.set(done, of);
        let watch = Watch { searched: &count, decided: &count, simulated: &count, averaged: &count };
        let mut answers = study.answer(&asked, &watch)?;
        let text = identify_report::text(&answers, &study);
        answers.identification.stats.add(&no_report());
        let (json, seed) = (reading.json(&answers)?, common.seed);
        Ok(Found { json, text, draw: Box::new(move || identify_report::bundle(&study, &answers, seed)) })
    })
}

/// `hadar rule`.
#[pyfunction]
pub(crate) fn rule(
    py: Python<'_>,
    rule: &Bound<'_, PyAny>,
    on: Option<&str>,
    common: Common,
) -> PyResult<Answer> {
    let question = Question::of(rule)?;
    let on = on.map(|on| {
        day(on)
            .ok_or_else(|| raised(Error::malformed(format!("on: `{on}` is no day"), "write \"2029-09-01\"")))
    });
    let on = on.transpose()?;
    common.answer(py, &question, |noting, reading| {
        let mut rule_read = question.read(Rule::from_file, Rule::from_toml)?;
        rule_read.skip_uncovered(common.skip_uncovered);
        let study = RuleStudy::new(&rule_read, &reading.library()?)?;
        common.admit(study.takes())?;
        let (extent, skipping, seed) = (Extent::Everything, common.skipping(), common.seed);
        let mut answer = study
            .answer(&RuleAsked { extent, skipping, seed, on, ..RuleAsked::default() }, &|done, of| {
                reading.counted.set(done, of)
            })?;
        let text = rule_report::text(&answer, &study);
        answer.stats.add(&no_report());
        let provenance = Provenance::of("unknown", Vec::new(), seed, &noting.so_far())?;
        let json = reading.json(&rule_report::Output::of(&answer, &provenance.inputs))?;
        let draw = move || rule_report::bundle(&study, &answer, &provenance);
        Ok(Found { json, text, draw: Box::new(draw) })
    })
}

asked! {
    /// What `hadar range` can be asked besides.
    Range {
        trials: usize,
        bands: Option<usize>,
    }
}

/// `hadar range`.
#[pyfunction]
pub(crate) fn range_(
    py: Python<'_>,
    scenario: &Bound<'_, PyAny>,
    more: Range,
    common: Common,
) -> PyResult<Answer> {
    let (question, Range { trials, bands }) = (Question::of(scenario)?, more);
    common.answer(py, &question, |_, reading| {
        let scenario = question.read(RangingScenario::from_file, RangingScenario::from_toml)?;
        scenario.check_asked(trials, bands)?;
        match scenario {
            RangingScenario::Air(scenario) => {
                let study = AirRangingStudy::new(&scenario, &reading.library()?)?;
                let plan = AirPlan { trials, seed: common.seed, bands };
                let mut result = study.range(&plan, &|done, of| reading.counted.set(done, of))?;
                let text = air_ranging::text(&result);
                result.stats.add(&no_report());
                let json = reading.json(&result)?;
                Ok(Found { json, text, draw: Box::new(move || air_ranging::bundle(&result)) })
            }
            RangingScenario::Stereo(scenario) => {
                let study = RangeStudy::new(&scenario, &reading.library()?)?;
                common.admit(study.takes())?;
                let (seed, skipping) = (common.seed, common.skipping());
                let plan = RangePlan { trials, seed, skipping, ..RangePlan::default() };
                let mut result = study.range(&plan, None, &|done, of| reading.counted.set(done, of))?;
                let text = range::text(&result);
                result.stats.add(&no_report());
                let json = reading.json(&result)?;
                Ok(Found { json, text, draw: Box::new(move || range::bundle(&result, None)) })
            }
        }
    })
}

asked! {
    /// What `hadar simulate` can be asked besides.
    Simulate {
        classifiers: Vec<String>,
        spectra: usize,
        photons: Vec<f64>,
        sweep: Option<usize>,
        statistics: String,
        shot_noise_only: bool,
        against: Vec<String>,
        model: Vec<PathBuf>,
        skip_spectra: bool,
        thermometry: Option<String>,
        temperatures: usize,
    }
}

const PHOTON_LAWS: [(PhotonLaw, &str); 3] = [
    (PhotonLaw::Poisson, "poisson"),
    (PhotonLaw::NegativeBinomial, "negative-binomial"),
    (PhotonLaw::FixedTotal, "fixed-total"),
];

/// `hadar simulate`.
#[pyfunction]
pub(crate) fn simulate(
    py: Python<'_>,
    scenario: &Bound<'_, PyAny>,
    more: Simulate,
    common: Common,
) -> PyResult<Answer> {
    let question = Question::of(scenario)?;
    let law = named("statistics", &more.statistics, &PHOTON_LAWS, |law| law.1).map_err(raised)?.0;
    common.answer(py, &question, |_, reading| {
        let study = common.study(&question, None, reading)?;
        if let Some(range) = &more.thermometry {
            let temperatures = hadar_study::true_temperatures(range, more.temperatures)?;
            let mut result = study.thermometry(&temperatures, more.spectra, common.seed, &|done, of| {
                reading.counted.set(done, of)
            })?;
            let text = simulate_report::thermometry::text(&result);
            result.stats.add(&no_report());
            let json = reading.json(&result)?;
            let draw = move || simulate_report::thermometry::bundle(&study, &result);
            return Ok(Found { json, text, draw: Box::new(draw) });
        }
        let asked = SimulationAsked {
            classifiers: more.classifiers.clone(),
            spectra: more.spectra,
            photons: more.photons.clone(),
            sweep: more.sweep,
            law,
            camera_noise: !more.shot_noise_only,
            against: more.against.clone(),
            models: more.model.clone(),
            skip_spectra: more.skip_spectra,
            save_spectra: false,
            seed: common.seed,
        };
        let (plan, planning) = ledger_of(|| study.plan(&asked))?;
        let (mut result, _) = study.simulate(&plan, &|done, of| reading.counted.set(done, of))?;
        let text = simulate_report::text(&result, &study);
        result.stats.add(&planning.and(&no_report()));
        let json = reading.json(&result)?;
        let draw = move || simulate_report::bundle(&study, &result, None);
        Ok(Found { json, text, draw: Box::new(draw) })
    })
}
