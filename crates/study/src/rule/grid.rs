//! The grid of a rule: every cell, a clause at one speed in one light, before every camera.
//!
//! What is left at contact in a cell is 0 where the camera meets it, and the whole closing speed where it fails by anything that later frames do
//! not mend; who has only read its frames too late decides where they are read, unless they are blurred there or the target is out of view, and
//! brakes from there.

use super::RuleStudy;
use super::approach::Moving;
use super::asked::{Extent, RuleAsked};
use super::cameras::Named;
use super::clauses::Line;
use crate::Shortfall;
use crate::condition::Condition;
use crate::grade::Grade;
use hadar::demand::Work;
use hadar::error::Result;
use hadar::instrument::Camera;
use hadar::material::Library;
use hadar::policy::encounter::Encounter;
use hadar_scenario::Rule;
use hadar_scenario::rule::{Clause, Demand, StopSpec, Verdict};

/// A rule, cell by cell.
#[derive(Debug, Clone, serde::Serialize)]
#[non_exhaustive]
pub struct Grid {
    /// Every cell: clause by clause, light by light, speed by speed.
    pub cells: Vec<GridCell>,
    /// What was computed and what was skipped, with the time.
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
    /// Distance at which the decision is due, m.
    pub decision_distance_m: f64,
    /// Every camera, in the order of the rule.
    pub cameras: Vec<CameraInCell>,
}

/// A camera in a cell.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct CameraInCell {
    /// Name of the camera, as the rule names it.
    pub camera: String,
    /// Whether the camera meets the rule in this cell: yes, no or undecided.
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
    /// How fast vehicle and target close in at contact, m s⁻¹; `None` where that cannot be said: undecided, or a false alarm.
    pub impact_m_s: Option<f64>,
}

/// A clause at one speed, before one camera that reads so many bands.
struct Before<'a> {
    clause: &'a Clause,
    spec: &'a StopSpec,
    camera: &'a Camera,
    bands: usize,
}

impl Before<'_> {
    /// How fast both close in at contact, m s⁻¹, if that can be said.
    fn impact_m_s(&self, line: &Line<'_>) -> Option<f64> {
        if self.clause.demand == Demand::FalseAlarm {
            // Whoever takes a thing for a person stops before it.
            return None;
        }
        let closing_m_s = self.spec.stop().decisions()[0].closing_m_s;
        match line.verdict {
            Verdict::Meets => Some(0.0),
            Verdict::Undecided => None,
            // Were it in time, it still might not.
            Verdict::Fails if line.fails_by == [Shortfall::DecisionTime] && !line.undecided_by.is_empty() => {
                None
            }
            Verdict::Fails if line.fails_by == [Shortfall::DecisionTime] => {
                Some(self.late_m_s(line).unwrap_or(closing_m_s))
            }
            Verdict::Fails => Some(closing_m_s),
        }
    }

    /// Of a camera that is only late; `None` where the last of its frames, nearer than those it was judged by, are spoiled.
    fn late_m_s(&self, line: &Line<'_>) -> Option<f64> {
        let decision = self.spec.stop().decisions()[0];
        let read_m = decision.start_m? - decision.closing_m_s * line.approach?.needed_s;
        let here = decision.at_distance(read_m);
        if read_m <= 0.0 {
            return None;
        }
        if let (Some(encounter), Some(half_rad)) =
            (self.spec.encounter(), Encounter::half_view_rad(self.camera))
        {
            encounter.decided_m(&here, half_rad).filter(|seen_m| *seen_m <= read_m)?;
        }
        // Where pixels are counted they run into each other by the same length from everywhere, which is judged.
        let counts_blur = !matches!(self.clause.demand, Demand::Resolution { .. });
        let blur =
            Moving::of(self.clause).map(|moving| moving.blur_pixels_at(&here, self.camera, self.bands));
        if counts_blur && blur.is_some_and(|blur| blur >= 1.0) {
            return None;
        }
        Some(self.spec.stop().impact_m_s(&decision, read_m))
    }

    fn judged(&self, line: &Line<'_>) -> CameraInCell {
        CameraInCell {
            camera: line.camera.to_owned(),
            verdict: line.verdict,
            margin: line.margin,
            interval: line.uncertainty.map(|found| [found.low, found.high]),
            fails_by: line.fails_by.to_vec(),
            conditions: Condition::open(line.conditions).map(Condition::code).collect(),
            grade: line.grade,
            impact_m_s: self.impact_m_s(line),
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
        let judged = rule.clauses.iter().zip(&study.clauses).zip(&answer.clauses).zip(cells);
        let cells = judged.filter_map(|(((clause, kind), found), cell)| {
            let spec = clause.stop.as_ref()?;
            let lines = found.lines().into_iter().zip(kind.looking());
            let one = |(line, (named, bands)): (Line<'_>, (&Named, usize))| {
                Before { clause, spec, camera: &named.camera, bands }.judged(&line)
            };
            Some(GridCell {
                clause: cell.clause,
                light: cell.light,
                speed_m_s: cell.speed_m_s,
                decision_distance_m: spec.stop().decisions()[0].distance_m,
                cameras: lines.map(one).collect(),
            })
        });
        Ok(Self { cells: cells.collect(), stats: answer.stats })
    }
}
