//! What a rule expects of its cameras (`[[test]]`), beside what was found.

use super::clauses::{ClauseAnswer, RuleAnswer};
use hadar_scenario::rule::{RuleTest, Verdict};

/// Share by which what follows from figures of the rule alone may miss: the digits that it is written with.
const SAME: f64 = 1e-3;

/// A test with what was found.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct TestResult {
    /// Name of the camera that is tested.
    pub camera: String,
    /// The clause; all of them together where `None`.
    pub clause: Option<String>,
    /// Whether everything expected was found.
    pub passes: bool,
    /// Each expected result with what was found.
    pub checks: Vec<TestCheck>,
}

/// Something that is expected.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct TestCheck {
    /// Its key in the test, with the unit it is told in.
    pub what: &'static str,
    /// The result that the rule's author expects.
    pub expected: Told,
    /// What was found; `None` where nothing is said of it.
    pub found: Option<Told>,
    /// Whether that is the same: a margin within the tolerance of the test, distance and time of a decision within a thousandth.
    pub passes: bool,
}

/// A verdict or a number.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[serde(untagged)]
pub enum Told {
    /// A verdict.
    Verdict(Verdict),
    /// A number, in SI units.
    Number(f64),
}

impl RuleAnswer {
    /// Every test of the rule with what was found.
    #[must_use]
    pub fn tested(&self) -> Vec<TestResult> {
        self.rule.tests.iter().map(|test| self.one(test)).collect()
    }

    fn one(&self, test: &RuleTest) -> TestResult {
        let camera = self.cameras.get(test.camera);
        // Of a rule of one clause numbers are those of that clause.
        let clause: Option<&ClauseAnswer> = match test.clause {
            Some(index) => self.clauses.get(index),
            None => self.clauses.first().filter(|_| self.clauses.len() == 1),
        };
        let lines = clause.map(ClauseAnswer::lines);
        let line = lines.as_ref().and_then(|lines| lines.get(test.camera));
        let verdict = match test.clause {
            Some(_) => line.map(|line| line.verdict),
            None => camera.map(|camera| camera.verdict),
        };
        let stop = clause.and_then(|clause| clause.stop);
        let mut checks = Vec::new();
        if let Some(expected) = test.verdict {
            let passes = verdict == Some(expected);
            let (expected, found) = (Told::Verdict(expected), verdict.map(Told::Verdict));
            checks.push(TestCheck { what: "verdict", expected, found, passes });
        }
        let numbers = [
            ("margin", test.margin, line.map(|line| line.margin), test.tolerance),
            ("decision_distance_m", test.decision_distance_m, stop.map(|stop| stop.fastest.distance_m), SAME),
            ("decision_time_s", test.decision_time_s, stop.and_then(|stop| stop.hastiest?.time_s), SAME),
            ("bearing_rad", test.bearing_rad, stop.and_then(|stop| Some(stop.crossing?.bearing_rad)), SAME),
            (
                "frames",
                test.frames.map(f64::from),
                line.and_then(|line| line.approach?.frames_within).map(f64::from),
                0.0,
            ),
        ];
        for (what, expected, found, tolerance) in numbers {
            let Some(expected) = expected else { continue };
            let passes = found.is_some_and(|found| (found - expected).abs() <= tolerance * expected.abs());
            let (expected, found) = (Told::Number(expected), found.map(Told::Number));
            checks.push(TestCheck { what, expected, found, passes });
        }
        TestResult {
            camera: camera.map_or_else(String::new, |camera| camera.name.clone()),
            clause: test.clause.and_then(|index| self.clauses.get(index)?.name.clone()),
            passes: checks.iter().all(|check| check.passes),
            checks,
        }
    }
}
