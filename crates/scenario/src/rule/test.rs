//! What a rule says of known cameras (`[[test]]`), for `hadar rule --test`: whoever changes a figure of the rule is told.

use super::camera::RuleCamera;
use super::clause::Clause;
use crate::entries::Entries;
use crate::section::{Entry, Section};
use hadar::error::{Error, Result};
use hadar::units::Dimension;

/// Share of itself by which a margin may miss what is expected, where nothing is said.
const TOLERANCE: f64 = 0.01;

/// What is expected of one camera (`[[test]]`).
#[derive(Debug, Clone, PartialEq)]
pub struct RuleTest {
    /// Its place among the cameras.
    pub camera: usize,
    /// The place of a clause, or all of them together.
    pub clause: Option<usize>,
    /// The verdict.
    pub verdict: Option<Verdict>,
    /// What is there over what is demanded.
    pub margin: Option<f64>,
    /// Greatest distance at which the decision must stand, m.
    pub decision_distance_m: Option<f64>,
    /// Least time until then, s.
    pub decision_time_s: Option<f64>,
    /// How far beside the camera's axis the target is until then, at most, rad.
    pub bearing_rad: Option<f64>,
    /// Frames of all bands that fit into it.
    pub frames: Option<u32>,
    /// Share of itself by which the margin may miss.
    pub tolerance: f64,
}

hadar::named! {
    /// What comes of a camera.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Verdict {
        /// It does what is demanded.
        Meets = "meets",
        /// It does not.
        Fails = "fails",
        /// It may or may not: the interval of its margin contains the demand.
        Undecided = "undecided",
    }
    /// The name in a rule, e.g. `meets`.
    name
}

impl RuleTest {
    pub(super) fn entries(&self, cameras: &[RuleCamera], clauses: &[Clause]) -> Entries {
        let clause = self.clause.and_then(|index| clauses.get(index)?.name.as_deref());
        Entries::default()
            .put_if("camera", cameras.get(self.camera).map(RuleCamera::called))
            .put_if("clause", clause)
            .put_if("verdict", self.verdict.map(Verdict::name))
            .put_if("margin", self.margin)
            .put_quantity("decision_distance", Dimension::Length, self.decision_distance_m)
            .put_quantity("decision_time", Dimension::Time, self.decision_time_s)
            .put_quantity("bearing", Dimension::Angle, self.bearing_rad)
            .put_if("frames", self.frames)
            .put("tolerance", self.tolerance)
    }
}

/// The tests of a rule with these cameras and clauses.
pub(super) fn read(root: &Section<'_>, cameras: &[RuleCamera], clauses: &[Clause]) -> Result<Vec<RuleTest>> {
    let Some(entry) = root.get("test") else { return Ok(Vec::new()) };
    let items = entry.items("each test as [[test]], in double brackets")?;
    items.iter().map(|item| one(item, cameras, clauses)).collect()
}

fn one(item: &Entry<'_>, cameras: &[RuleCamera], clauses: &[Clause]) -> Result<RuleTest> {
    let section = item.section()?;
    let camera = section.require("camera")?;
    let names = || cameras.iter().map(RuleCamera::called);
    let name = camera.text("\"flir-a325sc\"")?.trim();
    let index = names().position(|known| known == name);
    let index =
        index.ok_or_else(|| camera.fail(Error::unknown_name("camera of this rule", name, names())))?;
    let clause = section.read("clause", |entry| {
        let names = || clauses.iter().filter_map(|clause| clause.name.as_deref());
        let name = entry.text("\"crossing\"")?.trim();
        let found = clauses.iter().position(|clause| clause.name.as_deref() == Some(name));
        found.ok_or_else(|| entry.fail(Error::unknown_name("clause of this rule", name, names())))
    })?;
    let test = RuleTest {
        camera: index,
        clause,
        verdict: section.choice("verdict", &Verdict::ALL.map(|verdict| (verdict.name(), verdict)))?,
        margin: section.number("margin")?,
        decision_distance_m: section.quantity("decision_distance")?,
        decision_time_s: section.quantity("decision_time")?,
        bearing_rad: section.quantity("bearing")?,
        frames: section.read("frames", |entry| entry.count("60"))?,
        tolerance: section.number("tolerance")?.unwrap_or(TOLERANCE),
    };
    let RuleTest { verdict, margin, decision_distance_m, decision_time_s, bearing_rad, frames, .. } = &test;
    let numbers =
        [margin, decision_distance_m, decision_time_s, bearing_rad].iter().any(|number| number.is_some());
    if verdict.is_none() && frames.is_none() && !numbers {
        let instead = "write what is expected, as in verdict = \"meets\" and margin = 1.23";
        return Err(item.fail(Error::malformed("the test expects nothing", instead)));
    }
    if clauses.len() > 1 && test.clause.is_none() && (frames.is_some() || numbers) {
        let first = clauses.iter().find_map(|clause| clause.name.as_deref()).unwrap_or("crossing");
        let found = "numbers of a rule of several clauses, without the clause";
        return Err(item.fail(Error::malformed(found, format!("write clause = \"{first}\" beside them"))));
    }
    Ok(test)
}
