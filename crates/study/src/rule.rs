//! A rule answered: every camera against every clause, in all scenes that the clause is demanded in.
//!
//! A camera meets a rule if it meets all of its clauses; what a clause demands is with its kind (`apart`, `resolution`,
//! `temperature`, `depth`).

mod apart;
mod approach;
mod asked;
mod between;
mod cameras;
mod clauses;
mod course;
mod depth;
mod earlier;
mod envelope;
mod exclusion;
mod expected;
mod grid;
mod guard;
mod ideal;
mod market;
mod moved;
mod not_in_force;
mod pairs;
mod reforms;
mod resolution;
mod results;
mod safety;
mod search;
mod stand_in;
mod standing;
mod temperature;
mod uncertainty;

pub use asked::{Extent, RuleAsked};
pub use clauses::{
    ApartAnswer, CameraAnswer, ClauseAnswer, Definition, Found, Line, Measure, MeasuredAnswer, MeasuredScene,
    MeasuredVerdict, RuleAnswer,
};
pub use course::{Course, CourseOfCamera, Moment};
pub use expected::{TestCheck, TestResult, Told};
pub use grid::{CameraInCell, Grid, GridCell};
pub use market::Market;
pub use moved::{FiguresMoved, Moved};
pub use not_in_force::NotInForce;
pub use reforms::{BeforeLaw, Reformed, Reforms};
pub use results::{
    ApproachResult, CameraVerdict, Certified, CrossingResult, EmissivityError, EnvelopeResult, Fixes,
    IdealCamera, LightTime, LimitingScene, Neighbourhood, NotIdentifiable, Proof, Quotable, RuleRequirement,
    StopResult, WhoMeets, WithoutPlaceholders,
};
pub use safety::SafetyOfRule;
pub use stand_in::{ShapesDrawn, StandIn, StandInAnswer, StandInScene};
pub use standing::{Outcome, Place as CameraBeforeClause, Reason as NotPassed};
pub use uncertainty::{BudgetLine, Drawn, MarginUncertainty};

use self::apart::TellApart;
use self::depth::DepthClause;
use self::resolution::Resolution;
use self::temperature::TemperatureClause;
use super::{Study, Warning};
use crate::budget::Takes;
use crate::condition::hardest_first;
use crate::grade::Grade;
use hadar::demand::{self, Ledger, Work};
use hadar::error::{Error, Result};
use hadar::material::Library;
use hadar_scenario::rule::{Clause, Demand, Verdict};
use hadar_scenario::{Date, Rule};

/// A rule with everything it names looked up and checked.
#[derive(Debug)]
pub struct RuleStudy {
    rule: Rule,
    clauses: Vec<Kind>,
    warnings: Vec<Warning>,
    /// Materials that mean another thing than in this program.
    replaced: Vec<String>,
    /// All figures of every camera.
    camera_figures: Vec<String>,
    looked_up: Work,
}

/// A clause with everything it names looked up, by what it demands.
#[derive(Debug)]
enum Kind {
    Apart(Box<TellApart>),
    Resolution(Resolution),
    Temperature(TemperatureClause),
    Depth(DepthClause),
}

impl RuleStudy {
    /// What it takes at least.
    #[must_use]
    pub fn takes(&self) -> Takes {
        self.studies().map(Study::takes).sum()
    }

    /// Of every clause that tells materials apart, every camera before every material, from the least distance.
    pub fn studies(&self) -> impl Iterator<Item = &Study> {
        let apart = self.clauses.iter().filter_map(|clause| match clause {
            Kind::Apart(apart) => Some(apart),
            _ => None,
        });
        apart.flat_map(|apart| &apart.candidates).flat_map(|one| &one.near)
    }

    /// Looks up everything that `rule` names, materials in `library`.
    ///
    /// # Errors
    /// As [`Study::new`]; two cameras of one name; a requirement by another than the nearest distance.
    ///
    /// ```
    /// use hadar::material::Library;
    /// use hadar_scenario::Rule;
    /// use hadar_study::{RuleAsked, RuleStudy};
    /// let text = r#"
    ///     cameras = ["ideal-pnrd"]
    ///     [target]
    ///     material = "skin"
    ///     temperature = "37 degC"
    ///     [[environment]]
    ///     temperature = "20 degC"
    ///     lighting = 0.5
    ///     [alternatives]
    ///     materials = ["pmma"]
    ///     [bands]
    ///     start = "750 cm^-1"
    ///     stop = "1250 cm^-1"
    ///     step = "100 cm^-1"
    ///     [envelope]
    ///     temperature = ["30 degC", "37 degC"]
    /// "#;
    /// let study = RuleStudy::new(&Rule::from_toml(text, None)?, &Library::embedded()?)?;
    /// let answer = study.answer(&RuleAsked::default(), &|_, _| ())?;
    /// assert!(answer.cameras[0].passes);
    /// let least = &answer.clauses[0].apart().unwrap().cameras[0];
    /// assert!(least.limiting.temperature_k < 304.0);
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn new(rule: &Rule, library: &Library) -> Result<Self> {
        let cameras = cameras::of(rule)?;
        if cameras.is_empty() {
            let instead = "write cameras = [\"flir-a325sc\"] above the first [table], or ask `hadar find`";
            let error = Error::malformed("the rule has no camera to check", instead);
            return Err(error.at(rule.scenario.place("find")));
        }
        let mut filled = rule.clone();
        let mut clauses = Vec::with_capacity(rule.clauses.len());
        let mut warnings: Vec<Warning> = Vec::new();
        for (index, clause) in rule.clauses.iter().enumerate() {
            let kind = match &clause.demand {
                Demand::TellApart | Demand::FalseAlarm | Demand::Contrast => {
                    let apart = TellApart::new(rule, clause, &cameras, library)?;
                    warnings.extend(
                        apart
                            .warnings
                            .iter()
                            .filter(|one| !warnings.contains(one))
                            .cloned()
                            .collect::<Vec<_>>(),
                    );
                    filled
                        .cameras
                        .iter_mut()
                        .zip(apart.specs())
                        .for_each(|(camera, spec)| camera.spec = spec);
                    if clause.name.is_none() {
                        filled.scenario = apart.scenario.clone();
                    }
                    filled.clauses[index].scenario = apart.scenario.clone();
                    Kind::Apart(Box::new(apart))
                }
                Demand::Resolution { pixels, size_m } => {
                    Kind::Resolution(Resolution::new(rule, clause, [*pixels, *size_m], &cameras)?)
                }
                Demand::TemperatureError { error_k, coverage_factor } => {
                    let wanted = (*error_k, *coverage_factor);
                    Kind::Temperature(TemperatureClause::new(rule, clause, wanted, &cameras, library)?)
                }
                Demand::DepthError(demand) => {
                    Kind::Depth(DepthClause::new(rule, clause, demand, &cameras, library)?)
                }
            };
            clauses.push(kind);
        }
        let replaced = library.replaced().to_vec();
        let figures = |one: &cameras::Named| format!("{:?} {:?}", one.camera, one.uncertainty);
        let camera_figures = cameras.iter().map(figures).collect();
        Ok(Self { rule: filled, clauses, warnings, replaced, camera_figures, looked_up: library.work() })
    }

    /// The rule with its defaults filled in.
    #[must_use]
    pub fn rule(&self) -> &Rule {
        &self.rule
    }

    /// Of the first clause that tells materials apart, the first camera before the first material, from the least distance.
    #[must_use]
    pub fn study(&self) -> Option<&Study> {
        self.clauses.iter().find_map(|clause| match clause {
            Kind::Apart(apart) => apart.study(),
            Kind::Temperature(clause) => clause.study(),
            Kind::Resolution(_) | Kind::Depth(_) => None,
        })
    }

    /// That the rule does not hold on a day, if that is so.
    #[must_use]
    pub fn idle(&self, on: Option<Date>) -> Option<NotInForce> {
        let about = &self.rule.about;
        let day = on.filter(|day| !about.holds_on(*day))?;
        Some(NotInForce { day, from: about.from, until: about.until })
    }

    /// What the rule says of every camera; `progress` is told how many pairs of materials before a camera are done.
    ///
    /// # Errors
    /// A scene without photons; a file that can no longer be read.
    pub fn answer(&self, asked: &RuleAsked, progress: &dyn Fn(usize, usize)) -> Result<RuleAnswer> {
        let ledger = Ledger::open();
        demand::add(&self.looked_up);
        let steps = |kind: &Kind| match kind {
            Kind::Apart(apart) => apart.pairs(),
            _ => self.rule.cameras.len(),
        };
        let all = self.clauses.iter().map(steps).sum();
        let mut before = 0;
        let mut clauses = Vec::with_capacity(self.clauses.len());
        let mut earlier = Vec::new();
        for (kind, clause) in self.clauses.iter().zip(&self.rule.clauses) {
            let within = |done: usize| progress(before + done, all);
            let found = match kind {
                Kind::Apart(apart) => {
                    let (found, kept) = apart.answer(asked, &earlier, &within)?;
                    earlier.push(kept);
                    Found::Apart(Box::new(found))
                }
                Kind::Resolution(clause) => Found::Measured(clause.answer()?),
                Kind::Temperature(clause) => Found::Measured(clause.answer(&within)?),
                Kind::Depth(clause) => Found::Measured(clause.answer(&within)?),
            };
            before += steps(kind);
            clauses.push(answered(clause, found));
        }
        let cameras = together(&clauses);
        let idle = self.idle(asked.on);
        let sentence = WhoMeets { idle, ..who_meets(&clauses, &cameras) };
        let rule = self.rule.clone();
        let warnings =
            idle.map(Warning::NotInForce).into_iter().chain(self.warnings.iter().cloned()).collect();
        let accepted = asked.accepted.clone();
        Ok(RuleAnswer {
            rule,
            on: asked.on,
            replaced: self.replaced.clone(),
            camera_figures: self.camera_figures.clone(),
            accepted,
            sentence,
            cameras,
            clauses,
            warnings,
            stats: ledger.close(),
        })
    }
}

fn answered(clause: &Clause, found: Found) -> ClauseAnswer {
    let mut answer = ClauseAnswer {
        name: clause.name.clone(),
        kind: clause.demand.kind(),
        text: clause.text.clone(),
        stop: clause.stop.as_ref().map(StopResult::of),
        sentence: WhoMeets::default(),
        found,
    };
    let alone = std::slice::from_ref(&answer);
    let clause = answer.name.is_some();
    answer.sentence = WhoMeets { clause, ..who_meets(alone, &together(alone)) };
    answer
}

/// What all clauses say of each camera.
fn together(clauses: &[ClauseAnswer]) -> Vec<CameraAnswer> {
    let mut cameras: Vec<CameraAnswer> = Vec::new();
    for clause in clauses {
        for line in clause.lines() {
            let name = || clause.name.clone();
            let interval = line.uncertainty.map(|found| [found.low, found.high]);
            let camera = match cameras.iter_mut().position(|camera| camera.name == line.camera) {
                Some(index) => &mut cameras[index],
                None => {
                    cameras.push(CameraAnswer {
                        name: line.camera.to_owned(),
                        verdict: Verdict::Meets,
                        passes: true,
                        margin: f64::INFINITY,
                        limiting_clause: None,
                        interval: None,
                        fails: Vec::new(),
                        undecided: Vec::new(),
                        grade: Grade::Proved,
                        evidence: Grade::Proved,
                        conditions: Vec::new(),
                    });
                    let last = cameras.len() - 1;
                    &mut cameras[last]
                }
            };
            if line.margin < camera.margin {
                (camera.margin, camera.limiting_clause, camera.interval) = (line.margin, name(), interval);
            }
            for one in line.conditions {
                // Of all clauses the hardest of a kind.
                match camera.conditions.iter_mut().find(|known| known.is_like(one)) {
                    Some(known) if one.rank() < known.rank() => known.clone_from(one),
                    Some(_) => {}
                    None => camera.conditions.push(one.clone()),
                }
            }
            let verdicts = (camera.verdict, line.verdict);
            let weakest = |known: Grade, one: Grade| match verdicts {
                // One clause that is surely not met is enough; of several the surest counts.
                (Verdict::Fails, Verdict::Fails) => known.min(one),
                (Verdict::Fails, _) => known,
                (_, Verdict::Fails) => one,
                _ => known.max(one),
            };
            camera.grade = weakest(camera.grade, line.grade);
            camera.evidence = weakest(camera.evidence, line.evidence);
            camera.verdict = match (camera.verdict, line.verdict) {
                (Verdict::Fails, _) | (_, Verdict::Fails) => Verdict::Fails,
                (Verdict::Undecided, _) | (_, Verdict::Undecided) => Verdict::Undecided,
                (Verdict::Meets, Verdict::Meets) => Verdict::Meets,
            };
            match line.verdict {
                Verdict::Fails => camera.fails.extend(name()),
                Verdict::Undecided => camera.undecided.extend(name()),
                Verdict::Meets => {}
            }
            camera.passes = camera.verdict == Verdict::Meets;
        }
    }
    for camera in &mut cameras {
        camera.conditions.retain(|one| one.counts(camera.passes));
        hardest_first(&mut camera.conditions);
    }
    cameras
}

/// Which cameras meet all clauses.
fn who_meets(clauses: &[ClauseAnswer], cameras: &[CameraAnswer]) -> WhoMeets {
    let mut who = WhoMeets::default();
    for camera in cameras {
        match camera.verdict {
            Verdict::Meets => who.meet.push((camera.name.clone(), camera.conditions.clone())),
            Verdict::Undecided => who.undecided.push((camera.name.clone(), camera.interval)),
            Verdict::Fails => who.fail.push(camera.name.clone()),
        }
        if camera.passes && camera.evidence > Grade::Proved {
            who.unproved.push(camera.name.clone());
        }
    }
    let scenes = clauses.iter().filter_map(ClauseAnswer::apart).flat_map(|apart| &apart.cameras);
    for LimitingScene { target, alternative, placeholders, .. } in scenes.map(|camera| &camera.limiting) {
        if let Some(numbers) = placeholders {
            let pair = (target.clone(), alternative.clone(), *numbers);
            if !who.placeholders.contains(&pair) {
                who.placeholders.push(pair);
            }
        }
    }
    who
}
