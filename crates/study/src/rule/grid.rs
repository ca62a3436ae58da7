//! The grid of a rule: every cell, a clause at one speed in one light, before every camera.
//!
//! What is left at contact in a cell is 0 where the camera meets it, and the whole closing speed where it fails by anything that later frames do
//! not mend; who has only read its frames too late decides where they are read, and brakes from there.

use super::RuleStudy;
use super::asked::{Extent, RuleAsked};
use super::clauses::Line;
use crate::Shortfall;
use crate::condition::Condition;
use crate::grade::Grade;
use hadar::demand::Work;
use hadar::error::Result;
use hadar::material::Library;
use hadar_scenario::Rule;
use hadar_scenario::rule::{StopSpec, Verdict};

/// A rule, cell by cell.
#[derive(Debug, Clone, serde::Serialize)]
#[non_exhaustive]
pub struct Grid {
    /// Every cell: clause by clause, light by light, speed by speed.
    pub cells: Vec<GridCell>,
    /// What it took.
    pub stats: Work,
}

/// A clause at one speed, in one light.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct GridCell {
    /// The clause; none of a rule without clauses.
    pub clause: Option<String>,
    /// The light; none of a clause that light does not touch.
    pub light: Option<String>,
    /// Speed of the vehicle, m s⁻¹.
    pub speed_m_s: f64,
    /// Distance at which the decision must stand, m.
    pub decision_distance_m: f64,
    /// Every camera, in the order of the rule.
    pub cameras: Vec<CameraInCell>,
}

/// A camera in a cell.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct CameraInCell {
    /// The camera.
    pub camera: String,
    /// What comes of it.
    pub verdict: Verdict,
    /// What is there over what is demanded.
    pub margin: f64,
    /// The interval of the margin; `None` where no uncertainty is stated.
    pub interval: Option<[f64; 2]>,
    /// What it does not meet.
    pub fails_by: Vec<Shortfall>,
    /// Codes of the conditions of a 'meets' without which it may be none.
    pub conditions: Vec<String>,
    /// How the verdict is known.
    pub grade: Grade,
    /// How fast vehicle and target close in at contact, m s⁻¹; `None` where the verdict is undecided.
    pub impact_m_s: Option<f64>,
}

impl CameraInCell {
    fn of(line: &Line<'_>, spec: &StopSpec) -> Self {
        let decision = spec.stop().decisions()[0];
        let late = || {
            let needed_s = line.approach?.needed_s;
            let decided_m = decision.start_m? - decision.closing_m_s * needed_s;
            Some(spec.stop().impact_m_s(&decision, decided_m))
        };
        let impact_m_s = match line.verdict {
            Verdict::Meets => Some(0.0),
            Verdict::Undecided => None,
            Verdict::Fails if line.fails_by == [Shortfall::DecisionTime] => late(),
            Verdict::Fails => Some(decision.closing_m_s),
        };
        Self {
            camera: line.camera.to_owned(),
            verdict: line.verdict,
            margin: line.margin,
            interval: line.uncertainty.map(|found| [found.low, found.high]),
            fails_by: line.fails_by.to_vec(),
            conditions: Condition::open(line.conditions).map(Condition::code).collect(),
            grade: line.grade,
            impact_m_s,
        }
    }
}

impl Grid {
    /// Judges every cell of a rule; `progress` is told how many pairs of materials before a camera are done.
    ///
    /// # Errors
    /// As [`RuleStudy::answer`]; a rule without a grid.
    pub fn of(rule: &Rule, library: &Library, progress: &dyn Fn(usize, usize)) -> Result<Self> {
        let (rule, cells) = rule.of_cells()?;
        let study = RuleStudy::new(&rule, library)?;
        let asked = RuleAsked { extent: Extent::Margins, nearly_alike: true, ..RuleAsked::default() };
        let answer = study.answer(&asked, progress)?;
        let judged = rule.clauses.iter().zip(&answer.clauses).zip(cells);
        let cells = judged.filter_map(|((clause, found), cell)| {
            let spec = clause.stop.as_ref()?;
            Some(GridCell {
                clause: cell.clause,
                light: cell.light,
                speed_m_s: cell.speed_m_s,
                decision_distance_m: spec.stop().decisions()[0].distance_m,
                cameras: found.lines().iter().map(|line| CameraInCell::of(line, spec)).collect(),
            })
        });
        Ok(Self { cells: cells.collect(), stats: answer.stats })
    }
}
