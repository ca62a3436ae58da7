//! Reforms beside the law: the same cameras before a rule as it is and with the values of each reform, and what changes.

use super::asked::{Extent, RuleAsked};
use super::clauses::{CameraAnswer, RuleAnswer};
use super::{Market, RuleStudy};
use crate::Shortfall;
use crate::condition::Condition;
use hadar::demand::Work;
use hadar::error::{Error, Place, Result};
use hadar::material::Library;
use hadar_scenario::rule::{Ground, Reform, Verdict};
use hadar_scenario::{Rule, Setting, Written};

/// A rule and its reforms.
#[derive(Debug, Clone, serde::Serialize)]
#[non_exhaustive]
pub struct Reforms {
    /// What comes of every camera by the law as it is.
    pub law: Vec<BeforeLaw>,
    /// Which part of the market meets it, where shares are stated.
    pub market: Option<Market>,
    /// The same by each reform.
    pub reforms: Vec<Reformed>,
    /// What was computed and what was skipped, with the time.
    pub stats: Work,
}

/// A rule with the values of a reform.
#[derive(Debug, Clone, serde::Serialize)]
#[non_exhaustive]
pub struct Reformed {
    /// What the reform is called.
    pub name: String,
    /// Status of the reform, as its file states it.
    pub status: Option<String>,
    /// The day from which it would hold.
    pub from: Option<String>,
    /// Values that replace those of the law.
    pub set: Vec<Setting>,
    /// What says so.
    #[serde(flatten)]
    pub ground: Ground,
    /// What comes of every camera, in the order of the law's.
    pub cameras: Vec<BeforeLaw>,
    /// Those with another verdict, by their names.
    pub changed: Vec<String>,
    /// Which part of the market meets it.
    pub market: Option<Market>,
}

/// What comes of one camera.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct BeforeLaw {
    /// Name of the camera, as the rule names it.
    pub camera: String,
    /// Whether the camera meets the rule: yes, no or undecided.
    pub verdict: Verdict,
    /// Least margin of the camera over all clauses.
    pub margin: f64,
    /// The clause of that margin.
    pub limiting_clause: Option<String>,
    /// Where the least margin decides nothing: what spoils the picture, by the first clause that it fails.
    pub spoiled_by: Vec<Shortfall>,
    /// The clause that the camera fails for the reasons in `spoiled_by`.
    pub spoiled_clause: Option<String>,
    /// Codes of the conditions of a 'meets' without which it may be none.
    pub conditions: Vec<String>,
}

impl BeforeLaw {
    /// Of every camera of an answer.
    pub(super) fn all(answer: &RuleAnswer) -> Vec<Self> {
        answer.cameras.iter().map(|camera| Self::of(camera, answer)).collect()
    }

    fn of(camera: &CameraAnswer, answer: &RuleAnswer) -> Self {
        let mut lines = answer.clauses.iter().flat_map(|clause| {
            clause.lines().into_iter().map(|line| (clause.name.clone(), line)).collect::<Vec<_>>()
        });
        let is_spoiled = camera.verdict == Verdict::Fails && camera.margin >= 1.0;
        let fails = lines.find(|(_, line)| line.camera == camera.name && line.verdict == Verdict::Fails);
        let (spoiled_clause, spoiled_by) = match fails.filter(|_| is_spoiled) {
            Some((clause, line)) => (clause, line.fails_by.to_vec()),
            None => (None, Vec::new()),
        };
        Self {
            spoiled_by,
            spoiled_clause,
            camera: camera.name.clone(),
            verdict: camera.verdict,
            margin: camera.margin,
            limiting_clause: camera.limiting_clause.clone(),
            // What is set is what is asked about.
            conditions: Condition::open(&camera.conditions)
                .filter(|one| !matches!(one, Condition::Setting { .. }))
                .map(Condition::code)
                .collect(),
        }
    }

    /// Whether another is another verdict.
    #[must_use]
    pub fn differs_from(&self, other: &Self) -> bool {
        (self.verdict, self.conditions.is_empty()) != (other.verdict, other.conditions.is_empty())
    }
}

impl Reforms {
    /// Answers the rule of a file as it is, and with the values of each of its reforms; `progress` is told how many of how many are done.
    ///
    /// # Errors
    /// As [`RuleStudy::answer`]; a rule without reforms; a reform that sets what the rule does not have.
    pub fn of(
        written: &Written,
        library: &Library,
        skip_uncovered: bool,
        progress: &dyn Fn(usize, usize),
    ) -> Result<Self> {
        let mut law = Rule::from_written(written)?;
        law.skip_uncovered(skip_uncovered);
        if law.reforms.is_empty() {
            let instead = "write [[reform]] with name, set and choice = \"why\" or a document";
            return Err(Error::malformed("the rule has no reforms", instead).at(law.scenario.place("")));
        }
        let all = law.reforms.len() + 1;
        let answer = |rule: &Rule| -> Result<RuleAnswer> {
            let asked = RuleAsked { extent: Extent::Margins, ..RuleAsked::default() };
            RuleStudy::new(rule, library)?.answer(&asked, &|_, _| ())
        };
        let own = answer(&law)?;
        progress(1, all);
        let mut stats = own.stats.clone();
        let before = BeforeLaw::all(&own);
        let mut reforms = Vec::with_capacity(law.reforms.len());
        for (index, Reform { name, status, from, set, ground }) in law.reforms.iter().enumerate() {
            let named = |error: Error| {
                error.at(Place { key: Some(format!("reform[{index}].set")), ..law.scenario.place("reform") })
            };
            let mut rule = Rule::from_written(&written.clone().with(set.clone())).map_err(named)?;
            rule.skip_uncovered(skip_uncovered);
            let answer = answer(&rule).map_err(named)?;
            stats.add(&answer.stats);
            let cameras = BeforeLaw::all(&answer);
            let changed = before.iter().zip(&cameras).filter(|(law, reform)| law.differs_from(reform));
            reforms.push(Reformed {
                name: name.clone(),
                status: status.clone(),
                from: from.map(|day| day.to_string()),
                set: set.clone(),
                ground: ground.clone(),
                changed: changed.map(|(law, _)| law.camera.clone()).collect(),
                market: answer.market(),
                cameras,
            });
            progress(index + 2, all);
        }
        Ok(Self { law: before, market: own.market(), reforms, stats })
    }
}
