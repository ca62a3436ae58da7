//! A row answered as the command of a name answers its file.

use super::part::parts;
use super::record::{Record, asked_of, has_all, is_within, record};
use crate::air_ranging::{AirPlan, AirRangingStudy};
use crate::calibrate::NoiseStudy;
use crate::decompose::{DecomposeStudy, Keep};
use crate::library::LibraryStudy;
use crate::range::{RangePlan, RangeStudy};
use crate::spoken::{Voice, with_voice};
use crate::{PhotonLaw, Remembered, RuleAsked, RuleStudy, SimulationPlan, SizeAsked, Study};
use hadar::demand::{Skipping, Work};
use hadar::error::{Error, Result};
use hadar::material::Library;
use hadar_estimate::decompose::Method;
use hadar_scenario::calibrate::NoiseScenario;
use hadar_scenario::{
    DecomposeScenario, DistanceKind, LibraryScenario, RangingScenario, Rule, Scenario, Written, command_for,
};
use hadar_simulate::classifier;
use hadar_simulate::experiment::Design;
use serde::Serialize;

/// Spectra of a class where a classifier is judged and nobody says how many.
pub const SPECTRA: usize = 5000;

hadar::named! {
    /// What is asked of every row.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum Question {
        /// The verdict on a camera.
        Size = "size",
        /// Distances to every alternative.
        Identify = "identify",
        /// Spectra drawn and classifiers judged.
        Simulate = "simulate",
        /// Which cameras meet a rule.
        Rule = "rule",
        /// How well depth can be measured.
        Range = "range",
        /// A heat cube taken apart.
        Decompose = "decompose",
        /// Materials found in a heat cube.
        Library = "library",
        /// The noise of frames of a camera.
        CalibrateNoise = "calibrate noise",
    }
    /// The command that answers it.
    name
}

/// How every row is asked.
#[derive(Debug, Clone, Copy)]
pub struct Asking<'a> {
    /// The materials.
    pub library: &'a Library,
    /// The distance that decides, instead of the scenario's.
    pub by: Option<DistanceKind>,
    /// Whether alternatives that do not cover the bands are left out.
    pub skip_uncovered: bool,
    /// Whether proofs may spare work.
    pub skipping: Skipping,
    /// Seed of random numbers.
    pub seed: u64,
    /// How cubes are taken apart.
    pub method: Method,
    /// What rows share.
    pub remembered: &'a Remembered,
    /// The columns that are wanted; all but items of lists where there are none.
    pub columns: &'a [String],
    /// The words of the sentences that are columns.
    pub voice: Voice,
}

/// What a row says, and what it took.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// Its values: of the columns that are wanted, or all of them ([`asked_of`]).
    pub record: Record,
    /// Whether these are all.
    pub is_whole: bool,
    /// What was computed.
    pub work: Work,
}

impl Asking<'_> {
    /// Whether anything of a part of the answer is wanted.
    #[must_use]
    pub fn wants(&self, part: &str) -> bool {
        self.columns.is_empty() || self.columns.iter().any(|column| is_within(column, part))
    }

    /// Items of lists that are wanted.
    pub fn items(&self) -> impl Iterator<Item = &String> {
        self.columns.iter().filter(|column| column.contains('['))
    }
}

impl Question {
    /// The question of a command's name.
    ///
    /// # Errors
    /// Another name.
    pub fn named(name: &str) -> Result<Self> {
        let unknown = || Error::unknown_name("command for rows", name, Self::ALL.map(Self::name));
        Self::ALL.into_iter().find(|question| question.name() == name).ok_or_else(unknown)
    }

    /// The chosen columns, and of each that is a part of a verdict what that rests on.
    #[must_use]
    pub fn with_conditions(self, chosen: impl IntoIterator<Item = String>) -> Vec<String> {
        let mut columns: Vec<String> = chosen.into_iter().collect();
        let conditions = |column: &String| {
            let part = column.split_once('.').map(|(part, _)| part);
            let of_pair = column.starts_with("pairs[") && (part.is_none() || column.ends_with(".told_apart"));
            match self {
                Self::Size | Self::Range if part == Some("verdict") => Some("verdict.conditions".to_owned()),
                Self::Identify if part == Some("identifiability") || of_pair => Some("conditions".to_owned()),
                Self::Rule => {
                    part.filter(|part| part.starts_with("cameras[")).map(|part| format!("{part}.conditions"))
                }
                _ => None,
            }
        };
        for column in columns.iter().filter_map(conditions).collect::<Vec<_>>() {
            if !columns.contains(&column) {
                columns.push(column);
            }
        }
        columns
    }

    /// The question that a file asks.
    ///
    /// # Errors
    /// A file of another kind.
    pub fn of(file: &Written) -> Result<Self> {
        match command_for(file)? {
            Some(command) => Self::named(command),
            None => {
                let found = "this file is no question about a scene";
                let error = Error::malformed(found, "name a scenario, or say which with --command size");
                Err(file.path.as_ref().map_or_else(|| error.clone(), |path| error.clone().in_file(path)))
            }
        }
    }

    /// What is drawn of it where nobody says, the first that is there.
    #[must_use]
    pub const fn headline(self) -> &'static [&'static str] {
        match self {
            Self::Size => &["verdict.margin", "requirement.photons"],
            Self::Identify => {
                &["identifiability.detection_probability_minimum", "identifiability.distance_minimum"]
            }
            Self::Simulate => &["points[0].limit_accuracy", "points[0].statistical_distance"],
            Self::Rule => &["cameras[0].margin"],
            Self::Range => &["verdict.share", "at.sigma_m"],
            Self::Decompose => &["undecided"],
            Self::Library => &["decided"],
            Self::CalibrateNoise => &["noise_electrons[1]"],
        }
    }

    /// Lists whose first item belongs to a row, since they are what is asked for.
    const fn lists(self) -> &'static [&'static str] {
        match self {
            Self::Size | Self::Identify | Self::Decompose | Self::Library => &[],
            Self::CalibrateNoise => &["noise_electrons[0]", "noise_electrons[1]", "noise_electrons[2]"],
            Self::Simulate => &["points[0]"],
            Self::Rule => &["cameras[0]"],
            Self::Range => &["objects[0]"],
        }
    }

    /// Reads a row's file, and nothing that it names.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn read(self, written: &Written) -> Result<()> {
        match self {
            Self::Size | Self::Identify | Self::Simulate => Scenario::from_written(written).map(drop),
            Self::Rule => Rule::from_written(written).map(drop),
            Self::Range => RangingScenario::from_written(written).map(drop),
            Self::Decompose => DecomposeScenario::from_written(written).map(drop),
            Self::Library => LibraryScenario::from_written(written).map(drop),
            Self::CalibrateNoise => NoiseScenario::from_written(written).map(drop),
        }
    }

    /// Answers a row.
    ///
    /// # Errors
    /// Those of the command.
    pub fn answer(self, written: &Written, asking: &Asking<'_>) -> Result<Answer> {
        let library = asking.library;
        match self {
            Self::Size => {
                let study = study(written, asking)?;
                let asked = SizeAsked {
                    solutions: asking.wants("solve_for"),
                    sensitivity: asking.wants("sensitivity"),
                    emissivity_errors: asking.wants("verdict"),
                };
                let found = study.size_with(asked)?;
                self.told(&found, &found.stats, asking)
            }
            Self::Identify => {
                let found = study(written, asking)?.identify_with_conditions()?;
                self.told(&found, &found.stats, asking)
            }
            Self::Simulate => {
                let plan = SimulationPlan {
                    photons: Vec::new(),
                    law: PhotonLaw::Poisson,
                    camera_noise: true,
                    against: Vec::new(),
                    design: Design {
                        per_class: SPECTRA,
                        methods: classifier::Method::ALL.to_vec(),
                        seed: asking.seed,
                        level: 0.95,
                        skip_spectra: false,
                    },
                    models: Vec::new(),
                    save_spectra: false,
                };
                let (found, _) = study(written, asking)?.simulate(&plan, &|_, _| ())?;
                self.told(&found, &found.stats, asking)
            }
            Self::Rule => {
                let mut rule = Rule::from_written(written)?;
                rule.skip_uncovered(asking.skip_uncovered);
                let asked =
                    RuleAsked { skipping: asking.skipping, seed: asking.seed, ..RuleAsked::default() };
                let found = RuleStudy::new(&rule, library)?.answer(&asked, &|_, _| ())?;
                self.told(&found, &found.stats, asking)
            }
            Self::Range => match RangingScenario::from_written(written)? {
                RangingScenario::Stereo(scenario) => {
                    let plan = RangePlan {
                        seed: asking.seed,
                        skipping: asking.skipping,
                        bounds_alone: !asking.wants("solve_for"),
                        ..RangePlan::default()
                    };
                    let found = RangeStudy::new(&scenario, library)?.range(&plan, None, &|_, _| ())?;
                    self.told(&found, &found.stats, asking)
                }
                RangingScenario::Air(scenario) => {
                    let plan = AirPlan { trials: 0, seed: asking.seed, bands: None };
                    let found = AirRangingStudy::new(&scenario, library)?.range(&plan, &|_, _| ())?;
                    self.told(&found, &found.stats, asking)
                }
            },
            Self::Decompose => {
                let scenario = DecomposeScenario::from_written(written)?;
                let study = DecomposeStudy::new(&scenario, library)?;
                let found = study.decompose(asking.method, asking.skipping, Keep::InMemory, &|_, _| ())?;
                self.told(&found, &found.stats, asking)
            }
            Self::Library => {
                let study = LibraryStudy::new(&LibraryScenario::from_written(written)?, library)?;
                let found = study.library(library, asking.seed, &|_, _| ())?;
                self.told(&found, &found.stats, asking)
            }
            Self::CalibrateNoise => {
                let found = NoiseStudy::new(&NoiseScenario::from_written(written)?)?.noise()?;
                self.told(&found, &found.stats, asking)
            }
        }
    }

    fn told(self, found: &impl Serialize, work: &Work, asking: &Asking<'_>) -> Result<Answer> {
        let items: Vec<String> =
            asking.items().cloned().chain(self.lists().iter().map(|list| (*list).to_owned())).collect();
        let of = |columns: &[String]| match with_voice(asking.voice, || parts(found, columns)) {
            Ok(json) => Ok(record(&json, &items)),
            Err(error) => Err(Error::malformed(error.to_string(), "report this as a bug")),
        };
        let mut found = of(asking.columns)?;
        let is_whole = asking.columns.is_empty() || !has_all(&found, asking.columns);
        if is_whole && !asking.columns.is_empty() {
            found = of(&[])?;
        }
        Ok(Answer { record: asked_of(found, asking.columns), is_whole, work: work.clone() })
    }
}

/// A row's scenario looked up.
fn study(written: &Written, asking: &Asking<'_>) -> Result<Study> {
    let mut scenario = Scenario::from_written(written)?;
    if let Some(by) = asking.by {
        scenario.requirement.by = by;
    }
    scenario.alternatives.skip_uncovered |= asking.skip_uncovered;
    Study::remembering(&scenario, asking.library, asking.skipping, asking.remembered)
}
