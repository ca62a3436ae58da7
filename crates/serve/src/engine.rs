//! The answer to a scenario: that of `hadar size`, with what a page shows of it one by one.

use crate::edit::{self, Edit};
use crate::examples::{self, Example};
use crate::form::{self, Form};
use crate::longest::longest;
use crate::said::{Said, Told};
use crate::size_limit::{self, Command};
use hadar::demand::{Reason, Thing, Work};
use hadar::error::Result;
use hadar::inputs::{self, Inputs, inputs_of};
use hadar::instrument::presets::{self, Preset};
use hadar::material::Library;
use hadar::policy::trade_off::Resolution;
use hadar_report::bundle::About;
use hadar_report::json;
use hadar_report::manifest::{Provenance, VERSION, answer_json};
use hadar_report::size::{self, rows};
use hadar_report::text::{between, photons_between, significant};
use hadar_report::words::Say;
use hadar_report::words::probability::probability;
use hadar_scenario::{Scenario, Written};
use hadar_study::budget::Limits;
use hadar_study::warning::Warning;
use hadar_study::{OwnCameras, PairResult, SizeAsked, Study, YesNo};
use serde::{Deserialize, Serialize};

/// Nodes of bands times alternatives, and objects of the surroundings, up to which a question without priors takes a part of a second.
/// With priors the search for the closest state takes seconds whatever their number.
const QUICK_SPECTRAL_VALUES: usize = 20_000;
const QUICK_SURROUNDINGS: usize = 3;
/// What a scenario of the page is called in its report.
const NAME: &str = "scenario.toml";

/// What scenarios of the page are answered with.
#[derive(Debug)]
pub struct Engine {
    /// Materials that they may name.
    pub library: Library,
    /// Cameras of the user's own that they may name.
    pub cameras: OwnCameras,
    /// The scenario that the page begins with.
    pub begin: String,
    /// The rule that the page for rules begins with; the first of the collection where `None`.
    pub begin_rule: Option<String>,
    /// Commit of the program's source, for reports.
    pub commit: String,
    /// How long an answer may take, and how much memory the program.
    pub limits: Limits,
}

/// A question of the page.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Ask {
    /// The text of the scenario.
    pub(crate) scenario: String,
    /// What is to be changed in it first.
    #[serde(default)]
    pub(crate) edits: Vec<Edit>,
    /// The trade-off that is drawn, by the quantity solved for; silent: the first.
    #[serde(default)]
    pub(crate) trade_off: Option<String>,
    /// Whether what does not follow a slider is asked for too: what the verdict hangs on, and the answer as text.
    #[serde(default)]
    pub(crate) full: bool,
}

/// A question with what its scenario names looked up.
#[derive(Debug)]
pub(crate) struct Prepared {
    ask: Ask,
    /// The scenario after the changes.
    text: String,
    study: Result<Study>,
    read: Inputs,
}

impl Prepared {
    /// Whether it takes a part of a second, as far as its scenario tells.
    pub(crate) fn is_quick(&self) -> bool {
        self.study.as_ref().map_or(true, |study| {
            let values = study.bands().nodes_cm1().len().saturating_mul(study.alternatives().len());
            values <= QUICK_SPECTRAL_VALUES
                && study.surroundings().objects().len() <= QUICK_SURROUNDINGS
                && !study.unknowns().has_priors()
        })
    }
}

/// What the page gets.
#[derive(Debug, Serialize)]
struct Answered {
    /// The text after the changes.
    scenario: String,
    /// The same as fields; none where the text is no TOML.
    form: Option<Form>,
    /// The answer; none where there is an error.
    answer: Option<Answer>,
    /// What is wrong.
    error: Option<Told>,
}

/// An answer as it is shown.
#[derive(Debug, Serialize)]
struct Answer {
    /// Whether the requirement is met; none without a camera.
    met: Option<bool>,
    /// Whether a 'yes' hangs on something.
    conditional: bool,
    sentence: String,
    numbers: Vec<rows::Row>,
    solved: Vec<rows::Solved>,
    pairs: Vec<Pair>,
    /// What the verdict rests on.
    conditions: Vec<Said>,
    warnings: Vec<Said>,
    /// Names and drawings (SVG).
    pictures: Vec<(String, String)>,
    /// Quantities that a trade-off can be drawn of, by name, and which one is.
    trade_offs: Vec<String>,
    trade_off: Option<String>,
    /// The whole answer as the command prints it; none while a slider moves.
    text: Option<String>,
}

/// An alternative as it is shown.
#[derive(Debug, Serialize)]
struct Pair {
    alternative: String,
    distance_nearest: String,
    photons_required: String,
    statistical_distance: Option<String>,
    detection_probability: Option<String>,
    told: Option<&'static str>,
}

impl Engine {
    /// What the page begins with: a scenario, and names that it may use.
    pub(crate) fn start(&self) -> Result<String> {
        #[derive(Serialize)]
        struct Named<'a> {
            name: &'a str,
            about: &'a str,
        }
        #[derive(Serialize)]
        struct Start<'a> {
            version: &'static str,
            scenario: &'a str,
            materials: Vec<Named<'a>>,
            cameras: Vec<Named<'a>>,
            examples: Vec<Example>,
            /// How long an answer may take.
            longest_s: u64,
            library_warnings: &'a [String],
        }
        let of_material = |material| {
            let material: &hadar::material::Material = material;
            Named { name: material.name(), about: &material.provenance().category }
        };
        let classes = self.library.classes().map(|(name, _)| Named { name, about: "class" });
        let of_camera = |camera| {
            let camera: &Preset = camera;
            Named { name: &camera.name, about: &camera.description }
        };
        json::line(&Start {
            version: VERSION,
            scenario: &self.begin,
            materials: self.library.iter().map(of_material).chain(classes).collect(),
            cameras: self.presets()?.map(of_camera).collect(),
            examples: examples::all()?,
            longest_s: self.limits.time.unwrap_or(longest("/ask").0).as_secs(),
            library_warnings: self.library.warnings(),
        })
    }

    /// Reads the scenario of a question and looks up what it names.
    pub(crate) fn prepare(&self, ask: Ask) -> Prepared {
        let (prepared, read) = inputs_of(|| {
            let (text, changed) = match self.edited(&ask) {
                Ok(text) => (text, Ok(())),
                Err(error) => (ask.scenario.clone(), Err(error)),
            };
            let study = changed.and_then(|()| self.study(&text));
            (text, study)
        });
        Prepared { ask, text: prepared.0, study: prepared.1, read }
    }

    /// A scenario with its changes as text, fields and answer.
    pub(crate) fn answer(&self, Prepared { ask, text: scenario, study, .. }: Prepared) -> Result<String> {
        let (answer, error) = match study.and_then(|study| shown(&study, &ask)) {
            Ok(answer) => (Some(answer), None),
            Err(error) => (None, Some(Told::from(&error))),
        };
        let presets: Vec<String> = self.presets()?.map(|camera| camera.name.clone()).collect();
        json::line(&Answered { form: form::of(&scenario, &presets), scenario, answer, error })
    }

    /// The answer as `hadar size --json` prints it.
    pub(crate) fn json(&self, prepared: Prepared) -> Result<String> {
        let mut result = prepared.study?.size_with_curves()?;
        let mut no_report = Work::default();
        no_report.spare(Thing::Reports, Reason::NotAsked, 1);
        result.stats.add(&no_report);
        answer_json(&result, &self.library_warnings(), &[]).map(|text| text + "\n")
    }

    /// The report of `hadar size --out`, on its one page.
    pub(crate) fn report(&self, Prepared { text, study, read, .. }: Prepared) -> Result<String> {
        let study = study?;
        let (result, mut read) = inputs_of(|| {
            inputs::add(&read);
            study.size_with_curves()
        });
        let result = result?;
        read.streams.insert(0, (NAME.to_owned(), text.into_bytes()));
        let command = ["hadar", "size", NAME].map(str::to_owned).to_vec();
        let provenance = Provenance::of(&self.commit, command, 1, &read)?;
        let about = About { answer: &size::text(&result, &study), provenance: &provenance, inputs: &[] };
        size::bundle(&study, &result)?.page(&about)
    }

    /// The text of a question with its changes.
    fn edited(&self, ask: &Ask) -> Result<String> {
        edit::applied(&ask.scenario, &ask.edits, &self.cameras.stated.clone().into())
    }

    fn study(&self, text: &str) -> Result<Study> {
        let scenario = Scenario::from_written(&self.written(text))?;
        size_limit::surroundings(scenario.environment.len(), Command::Size)?;
        let study = Study::new(&scenario, &self.library)?;
        size_limit::bands(&study, Command::Size)?;
        self.limits.admit(study.takes(), rayon::current_num_threads())?;
        Ok(study)
    }

    /// A text of the page as it is to be read: it may name the cameras of the user's own, and no file.
    pub(crate) fn written(&self, text: &str) -> Written {
        Written::of(text, None).with_cameras(self.cameras.stated.clone().into()).refusing_files()
    }

    /// The cameras that a scenario may name.
    fn presets(&self) -> Result<impl Iterator<Item = &Preset>> {
        Ok(presets::all()?.iter().chain(&self.cameras.presets))
    }

    pub(crate) fn library_warnings(&self) -> Vec<Warning> {
        self.library.warnings().iter().map(|remark| Warning::Library { remark: remark.clone() }).collect()
    }
}

fn shown(study: &Study, ask: &Ask) -> Result<Answer> {
    let result =
        study.size_with(SizeAsked { solutions: true, sensitivity: ask.full, emissivity_errors: ask.full })?;
    let pairs = study.traded_off();
    let wanted = |pair: &&(_, hadar::policy::Quantity)| Some(pair.1.key()) == ask.trade_off.as_deref();
    let pair = pairs.iter().find(wanted).or(pairs.first());
    // While a slider moves, coarse curves.
    let resolution = if ask.full { Resolution::FINE } else { Resolution::COARSE };
    let met = result.verdict.met;
    Ok(Answer {
        met,
        conditional: result.verdict.open().next().is_some(),
        sentence: result.verdict.sentence.say(),
        numbers: rows::of_camera(&result, study),
        solved: rows::solved(&result, study.units()),
        pairs: result.pairs.iter().map(pair_shown).collect(),
        conditions: result.verdict.conditions.iter().map(Said::from).collect(),
        warnings: result.warnings.iter().map(Said::from).collect(),
        pictures: size::followed(study, &result, pair.copied(), resolution)?.drawings()?,
        trade_offs: pairs.iter().map(|pair| pair.1.key().to_owned()).collect(),
        trade_off: pair.map(|pair| pair.1.key().to_owned()),
        text: ask.full.then(|| size::text(&result, study)),
    })
}

fn pair_shown(pair: &PairResult) -> Pair {
    Pair {
        alternative: pair.alternative.clone(),
        distance_nearest: significant(pair.distance_nearest, 3),
        photons_required: photons_between(pair.photons_required_bounds),
        statistical_distance: pair.statistical_distance_bounds.map(|ends| between(ends, 3)),
        detection_probability: pair.statistical_distance.map(|d| probability(d, 4)),
        told: pair.told.map(YesNo::name),
    }
}
