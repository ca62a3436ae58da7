//! A rule: a requirement over an envelope of scenes, and the cameras that are held against it.
//!
//! A rule file is a scenario without `[camera]`, with `cameras = ["flir-a325sc"]` for known cameras as they are,
//! `[[camera]]` tables with the keys of `[camera]` and an optional `name` for others, and `[rule]` for what a reader of
//! the certificate must know: `name`, `text` (its wording), `authority` (whose it is), `version`, `status`, and `from` and
//! `until` which dates it holds. `[stop]` says how fast the vehicle is and how it brakes, so that distances follow; `[[clause]]`
//! are demands with scenes of their own; a figure of a `[[camera]]` may have a standard uncertainty,
//! `netd = { value = "50 mK", u = "5 mK" }`, of which `[uncertainty]` guards so many; `[[source]]` say where the figures are from; `[[test]]` what known cameras do.

mod camera;
mod citation;
mod clause;
mod demand;
mod grid;
pub(crate) mod known;
mod reform;
mod stand_in;
mod stop;
mod test;

pub use camera::RuleCamera;
pub use citation::{Citation, Figure, Ground, Mark};
pub use clause::Clause;
pub use demand::{Demand, DepthDemand, DepthObject};
pub use grid::{GridLight, GridPlace};
pub use known::{Known, Uncertainty};
pub use reform::Reform;
pub use stand_in::StandInSpec;
pub use stop::StopSpec;
pub use test::{RuleTest, Verdict};

use super::Scenario;
use super::camera::written;
use super::entries::{Document, Entries, Part};
use super::keys::files;
use super::kind::Kind;
use super::paths::Paths;
use super::read::MINIMUM;
use super::reader::file;
use super::section::{Entry, Section};
use hadar::error::{Error, Place, Result};
use std::sync::Arc;
use toml::value::Date;

/// 95 % of a Gaussian.
const COVERAGE_FACTOR: f64 = 2.0;
const NO_CAMERA: &str = "write cameras = [\"flir-a325sc\"] above the first [table], or a [[camera]] table";

/// What a rule says of itself (`[rule]`).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct About {
    /// Its name.
    pub name: Option<String>,
    /// Its wording.
    pub text: Option<String>,
    /// Who sets it.
    pub authority: Option<String>,
    /// Its version.
    pub version: Option<String>,
    /// Whether it is law, a draft, postponed.
    pub status: Option<String>,
    /// The first day on which it holds.
    pub from: Option<Date>,
    /// The last one.
    pub until: Option<Date>,
}

impl About {
    /// Whether it holds on a day.
    #[must_use]
    pub fn holds_on(&self, day: Date) -> bool {
        self.from.is_none_or(|from| from <= day) && self.until.is_none_or(|until| day <= until)
    }
}

/// Everything a rule file says, defaults filled in.
///
/// ```
/// use hadar_scenario::Rule;
/// let text = r#"
///     cameras = ["flir-a325sc", "ideal-pnrd"]
///     [target]
///     material = "skin"
///     temperature = "37 degC"
///     [envelope]
///     temperature = ["30 degC", "37 degC"]
/// "#;
/// let rule = Rule::from_toml(text, None)?;
/// assert_eq!(rule.cameras.len(), 2);
/// let error = Rule::from_toml(&text.replace("[\"30", "[\"40"), None).unwrap_err().to_string();
/// assert!(error.starts_with("line 7: envelope.temperature: the range goes from 40 degC to 37 degC"), "{error}");
/// # Ok::<(), hadar::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Rule {
    /// What it says of itself.
    pub about: About,
    /// Deviations to both sides of a margin that must be above or below 1; see `[uncertainty]`.
    pub coverage_factor: f64,
    /// Task, surroundings, bands, unknowns, requirement and operating envelope that clauses share; without a camera.
    pub scenario: Scenario,
    /// What it demands, at least one thing.
    pub clauses: Vec<Clause>,
    /// The cameras, those of `cameras` first.
    pub cameras: Vec<RuleCamera>,
    /// What is to pass for a person in tests, if the rule says so.
    pub stand_in: Option<StandInSpec>,
    /// Where its figures are from; nothing of a rule that does not say.
    pub sources: Vec<Citation>,
    /// Other values that somebody proposes.
    pub reforms: Vec<Reform>,
    /// Lights of the table that is made of it cell by cell.
    pub grid: Vec<GridLight>,
    /// What is expected of its cameras.
    pub tests: Vec<RuleTest>,
}

file!(Rule, scenario.source, (Kind::Rule, MINIMUM, &files::RULE));

impl Rule {
    fn of_root(root: &Section<'_>) -> Result<Self> {
        let about = root.read("rule", about)?.unwrap_or_default();
        let coverage_factor = root.read("uncertainty", |entry| entry.section()?.number("coverage_factor"))?;
        let coverage_factor = coverage_factor.flatten().unwrap_or(COVERAGE_FACTOR);
        let mut cameras = root.read("cameras", camera::presets)?.unwrap_or_default();
        cameras.extend(root.read("camera", camera::tables)?.unwrap_or_default());
        if cameras.is_empty() && root.get("find").is_none() {
            let key = if root.get("cameras").is_some() { "cameras" } else { "" };
            return Err(root.fail(key, Error::malformed("the rule has no camera to check", NO_CAMERA)));
        }
        let (scenario, clauses) = clause::read(root)?;
        camera::check(&cameras, |index, key| scenario.place(&format!("{}.{key}", cameras[index].key)))?;
        let tests = test::read(root, &cameras, &clauses)?;
        let sources = citation::read(root)?;
        let stand_in = root.read("stand_in", StandInSpec::read)?;
        let reforms = reform::read(root, about.from)?;
        let grid = grid::read(root, scenario.environment.len())?;
        Ok(Self {
            about,
            coverage_factor,
            scenario,
            stand_in,
            clauses,
            cameras,
            sources,
            reforms,
            grid,
            tests,
        })
    }

    /// Leaves out, in all clauses, alternatives whose spectra do not cover the bands, if that is asked for.
    pub fn skip_uncovered(&mut self, skip: bool) {
        self.scenario.alternatives.skip_uncovered |= skip;
        self.clauses.iter_mut().for_each(|clause| clause.scenario.alternatives.skip_uncovered |= skip);
    }

    /// Its file as it was read.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.scenario.source.text
    }

    /// Its figures as its file has them.
    #[must_use]
    pub fn figures(&self) -> Vec<Figure> {
        citation::of(&self.scenario.source)
    }

    /// The figures of the camera at an index that its file states, a known camera's own left out.
    #[must_use]
    pub fn camera_figures(&self, index: usize) -> Vec<Figure> {
        let of = |camera: &RuleCamera| citation::of_camera(&self.scenario.source, &camera.key);
        self.cameras.get(index).map(of).unwrap_or_default()
    }

    /// Of a camera of the user's own file: the document that it names, if it names one.
    #[must_use]
    pub fn own_document(&self, index: usize) -> Option<Option<&str>> {
        let spec = &self.cameras.get(index)?.spec;
        let name = spec.own.as_ref().and(spec.preset.as_ref())?;
        let stated = self.scenario.source.cameras.iter().find(|camera| camera.name == *name)?;
        Some(stated.document.as_deref())
    }

    /// What stands behind the figure at a key; nothing behind a value that is set over the rule.
    pub fn behind(&self, key: &str) -> impl Iterator<Item = &Ground> {
        let source = &self.scenario.source;
        let is_set = source.setting(key).is_some() || source.settings.iter().any(|set| set.is_in(key));
        let own = if is_set { &[][..] } else { &self.sources };
        own.iter().filter(move |citation| citation.covers(key)).map(|citation| &citation.ground)
    }

    /// The same rule with a clause for each cell of its grid in the place of its own, and the cells.
    ///
    /// # Errors
    /// A rule without a grid, or without speeds; a clause with another number of surroundings; too many cells; a light in which not all scenes
    /// are lit as is known.
    pub fn of_cells(&self) -> Result<(Self, Vec<GridPlace>)> {
        let (clauses, cells) = grid::cells(&self.clauses, &self.grid, &|key| self.scenario.place(key))?;
        let mut rule = Self { clauses, ..self.clone() };
        (rule.tests, rule.reforms, rule.grid) = (Vec::new(), Vec::new(), Vec::new());
        Ok((rule, cells))
    }

    /// Whether its demands are those of `[[clause]]` tables.
    #[must_use]
    pub fn has_clauses(&self) -> bool {
        self.clauses.iter().any(|clause| clause.name.is_some())
    }

    /// Where `key` of the camera at an index stands.
    #[must_use]
    pub fn camera_place(&self, index: usize, key: &str) -> Place {
        let key = match self.cameras.get(index) {
            Some(camera) if camera.is_listed() => camera.key.clone(),
            Some(camera) => format!("{}.{key}", camera.key),
            None => "camera".to_owned(),
        };
        self.scenario.place(&key)
    }

    /// The scenario of a clause with the camera at an index as its `[camera]`, which then stands where the rule has it.
    #[must_use]
    pub fn with_camera(&self, clause: &Clause, index: usize) -> Scenario {
        let mut scenario = clause.scenario.clone();
        let Some(camera) = self.cameras.get(index) else { return scenario };
        scenario.camera = Some(camera.spec.clone());
        scenario.source.with_settings_among();
        let lines = Arc::make_mut(&mut scenario.source.lines);
        let own: Vec<(String, usize)> = lines
            .iter()
            .filter_map(|(key, line)| {
                key.strip_prefix(&camera.key).map(|rest| (format!("camera{rest}"), *line))
            })
            .collect();
        lines.extend(own);
        scenario
    }

    fn document(&self, paths: Paths<'_>) -> Document {
        let document = Scenario { camera: None, ..self.scenario.clone() }.document(paths);
        let camera = |camera: &RuleCamera| {
            Entries::default()
                .put_if("name", camera.name.as_deref())
                .put_if("share", camera.share)
                .and(written(&camera.spec, paths).with_uncertainty(&camera.uncertainty))
                .read_from(&camera.key)
        };
        let about = Entries::default()
            .put_if("name", self.about.name.as_deref())
            .put_if("text", self.about.text.as_deref())
            .put_if("authority", self.about.authority.as_deref())
            .put_if("version", self.about.version.as_deref())
            .put_if("status", self.about.status.as_deref())
            .put_if("from", self.about.from.map(|day| day.to_string()))
            .put_if("until", self.about.until.map(|day| day.to_string()));
        let uncertain = self.cameras.iter().any(|camera| !camera.uncertainty.is_empty());
        let clause = |clause: &Clause| clause.document(&self.scenario, paths);
        let clauses = || Part::Documents(self.clauses.iter().map(clause).collect());
        let stop = self.clauses.iter().find_map(|clause| clause.stop).filter(|_| !self.has_clauses());
        let tests: Vec<_> =
            self.tests.iter().map(|test| test.entries(&self.cameras, &self.clauses)).collect();
        let reforms: Vec<_> = self.reforms.iter().map(Reform::entries).collect();
        let grid: Vec<_> = self.grid.iter().map(GridLight::entries).collect();
        document
            .put("rule", about)
            .put_if(
                "uncertainty",
                uncertain.then(|| Entries::default().put("coverage_factor", self.coverage_factor)),
            )
            .put_if("clause", self.has_clauses().then(clauses))
            .put_if("stop", stop.map(|stop| stop.entries()))
            .put_if("stand_in", self.stand_in.as_ref().map(|spec| spec.written(paths)))
            .put("camera", self.cameras.iter().map(camera).collect::<Vec<_>>())
            .put_if("reform", (!reforms.is_empty()).then_some(reforms))
            .put_if("grid", (!grid.is_empty()).then_some(grid))
            .put_if("test", (!tests.is_empty()).then_some(tests))
    }
}

/// Two rules are equal when they ask the same question of the same cameras: where they stand does not count.
impl PartialEq for Rule {
    fn eq(&self, other: &Self) -> bool {
        let same = |(a, b): (&RuleCamera, &RuleCamera)| {
            a.name == b.name && a.spec == b.spec && a.uncertainty == b.uncertainty && a.share == b.share
        };
        let same_clause = |(a, b): (&Clause, &Clause)| {
            (&a.name, &a.text, &a.demand, &a.stop) == (&b.name, &b.text, &b.demand, &b.stop)
                && a.scenario == b.scenario
        };
        self.about == other.about
            && self.scenario == other.scenario
            && self.clauses.len() == other.clauses.len()
            && self.clauses.iter().zip(&other.clauses).all(same_clause)
            && self.reforms == other.reforms
            && self.grid == other.grid
            && self.tests == other.tests
            && self.stand_in == other.stand_in
            && self.cameras.len() == other.cameras.len()
            && self.cameras.iter().zip(&other.cameras).all(same)
    }
}

fn about(entry: &Entry<'_>) -> Result<About> {
    let section = entry.section()?;
    let from = section.read("from", Entry::date)?;
    let until = section.read("until", Entry::date)?;
    if let Some((from, until)) = from.zip(until).filter(|(from, until)| until < from) {
        let found = format!("the rule ends on {until}, before it begins on {from}");
        return Err(section.fail("until", Error::malformed(found, "correct one of the two dates")));
    }
    Ok(About {
        name: section.text("name", "\"Robots that see people at night\"")?,
        text: section.text("text", "\"A camera must distinguish a person from a robot.\"")?,
        authority: section.text("authority", "\"City of Lafayette\"")?,
        version: section.text("version", "\"1\"")?,
        status: section.text("status", "\"in force\"")?,
        from,
        until,
    })
}
