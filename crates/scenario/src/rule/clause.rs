//! Clauses: what a rule demands, each in scenes of its own.
//!
//! A clause (`[[clause]]`) has a `name`, a `kind`, a `text`, and any table of a scenario, which then stands in the place of the
//! rule's own: `[clause.envelope]`, `[[clause.environment]]`, `[clause.requirement]`, `[clause.stop]`. A rule without clauses is
//! one: to tell its target apart. What a clause demands, by its kind:
//!
//! * `tell-apart`: the target from its alternatives, as reliably as `[requirement]` says;
//! * `false-alarm`: `things` that are not the rule's target must not be taken for it: they are the target of this clause, and the
//!   materials of the rule's target are its alternatives;
//! * `contrast`: something is there: the target stands out from what is `behind` it, surfaces of these materials at any temperature of
//!   `[clause.alternatives]`, which must be stated;
//! * `resolution`: `pixels` across a target of `size`;
//! * `temperature-error`: the temperature of the target within `temperature_error`, at `coverage_factor` deviations;
//! * `depth-error`: the distance of an `object` of `[clause.scene]` within `depth_error`, seen by `[clause.stereo]`.

use super::demand::{Demand, depth_error, resolution, temperature_error};
use super::stop::StopSpec;
use crate::entries::{Document, Entries, Part};
use crate::envelope::LIGHTING_ROUNDING;
use crate::keys::clause as keys;
use crate::paths::{Paths, material};
use crate::read::{of_root, requirement};
use crate::section::{Entry, Section, without_repetition};
use crate::{Envelope, MaterialRef, Reliability, Requirement, Scenario, Scope, Source, write};
use hadar::error::{Error, Result};
use hadar::fisher::Nuisance;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Tables of a scenario that a clause may have.
const TABLES: &[&str] = &[
    "target",
    "background",
    "environment",
    "alternatives",
    "atmosphere",
    "bands",
    "unknown",
    "requirement",
    "envelope",
    "stop",
];

/// One demand, with the scenes in which it must hold.
#[derive(Debug, Clone)]
pub struct Clause {
    /// Its name; none of a rule without clauses.
    pub name: Option<String>,
    /// Its wording.
    pub text: Option<String>,
    /// What is demanded.
    pub demand: Demand,
    /// Task, surroundings, bands, unknowns, requirement and envelope; without a camera.
    pub scenario: Scenario,
    /// How the vehicle comes to a stop, if distances follow from that.
    pub stop: Option<StopSpec>,
    /// Where it stands, e.g. `clause[0]`; empty for the whole rule.
    pub key: String,
}

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    TellApart,
    FalseAlarm,
    Contrast,
    Resolution,
    TemperatureError,
    DepthError,
}

impl Kind {
    /// Whether it demands a quantity, in a `[requirement]` of its own kind.
    const fn is_measured(self) -> bool {
        matches!(self, Self::Resolution | Self::TemperatureError | Self::DepthError)
    }
}

const KINDS: [(&str, Kind); 6] = [
    ("tell-apart", Kind::TellApart),
    ("false-alarm", Kind::FalseAlarm),
    ("contrast", Kind::Contrast),
    ("resolution", Kind::Resolution),
    ("temperature-error", Kind::TemperatureError),
    ("depth-error", Kind::DepthError),
];

/// The clauses of a rule, at least one, and the scenario that they share.
pub(super) fn read(root: &Section<'_>) -> Result<(Scenario, Vec<Clause>)> {
    let source = root.source();
    let scenario = Scenario { source: source.clone(), ..of_root(root, requirement)? };
    let Some(entry) = root.get("clause") else {
        let stop = root.read("stop", StopSpec::read)?;
        let (name, text) = (None, None);
        let clause = Clause {
            name,
            text,
            demand: Demand::TellApart,
            scenario: scenario.clone(),
            stop,
            key: String::new(),
        };
        clause.check()?;
        return Ok((scenario, vec![clause]));
    };
    let items = entry.items("each clause as [[clause]], in double brackets")?;
    if items.is_empty() {
        let instead = "write [[clause]] with name and kind = \"tell-apart\", or leave it out";
        return Err(entry.fail(Error::malformed("the list is empty", instead)));
    }
    let mut clauses: Vec<Clause> = Vec::with_capacity(items.len());
    for (index, item) in items.iter().enumerate() {
        let clause = one(item, root, &scenario, format!("clause[{index}]"))?;
        if clauses.iter().any(|other| other.name == clause.name) {
            let error = Error::malformed("another clause has this name", "give it a name of its own");
            return Err(error.at(source.place(&format!("clause[{index}].name"))));
        }
        clauses.push(clause);
    }
    Ok((scenario, clauses))
}

fn one(item: &Entry<'_>, root: &Section<'_>, rule: &Scenario, key: String) -> Result<Clause> {
    // What is of one kind alone is not known in the others.
    let kind = item.table()?.choice("kind", &KINDS)?.unwrap_or(Kind::TellApart);
    let plain = item.section_of(match kind {
        Kind::TellApart => &keys::CLAUSE_TELL_APART,
        Kind::FalseAlarm => &keys::CLAUSE_FALSE_ALARM,
        Kind::Contrast => &keys::CLAUSE_CONTRAST,
        Kind::Resolution => &keys::CLAUSE_RESOLUTION,
        Kind::TemperatureError => &keys::CLAUSE_TEMPERATURE,
        Kind::DepthError => &keys::CLAUSE_DEPTH,
    })?;
    let name = match plain.text("name", "\"crossing at night\"")? {
        Some(name) => name,
        None => {
            return Err(plain.fail(
                "name",
                Error::malformed("the clause has no name", "write name = \"crossing at night\""),
            ));
        }
    };
    let said = plain.text("text", "\"a pedestrian crosses\"")?;
    let section = plain.clone().over(root);
    let stop = section.read("stop", StopSpec::read)?;
    let silent = |_: &Entry<'_>| Ok(Requirement::default());
    let (demand, mut scenario) = match kind {
        Kind::TellApart => (Demand::TellApart, of_root(&section, requirement)?),
        Kind::FalseAlarm => (Demand::FalseAlarm, false_alarm(&section, &plain, rule)?),
        Kind::Contrast => (Demand::Contrast, contrast(&section, &plain)?),
        Kind::Resolution => (resolution(&plain)?, of_root(&section, silent)?),
        Kind::TemperatureError => (temperature_error(&plain)?, of_root(&section, silent)?),
        Kind::DepthError => (depth_error(&plain, stop.is_some())?, of_root(&section, silent)?),
    };
    if demand != Demand::FalseAlarm {
        of_its_own(&mut scenario, &plain);
    }
    if kind.is_measured() {
        // What is measured is so by one pixel, or by geometry.
        scenario.requirement.of = Some(Scope::Pixel);
    }
    if kind.is_measured() && stop.is_none() {
        // Its requirement is another one; how fast the vehicle drives is the rule's to say.
        scenario.requirement.speed_m_s = rule.requirement.speed_m_s;
    }
    // What the rule demands of all clauses is refused below where none would judge it.
    scenario.requirement.time_s = scenario.requirement.time_s.or(rule.requirement.time_s);
    scenario.title.clone_from(&rule.title);
    scenario.source = relaid(&rule.source, &key);
    scenario.source.called = match kind {
        Kind::FalseAlarm => vec![("envelope.materials", "things")],
        Kind::Contrast => vec![("alternatives.materials", "behind")],
        _ => Vec::new(),
    };
    let clause = Clause { name: Some(name), text: said, demand, scenario, stop, key };
    clause.check()?;
    Ok(clause)
}

/// A clause's own target and surroundings are what they say, not what the rule's envelope says of the rule's.
fn of_its_own(scenario: &mut Scenario, plain: &Section<'_>) {
    let (target, objects) = (&scenario.target, &scenario.environment);
    let Some(envelope) = scenario.envelope.as_mut().filter(|_| !plain.has_own("envelope")) else { return };
    if plain.has_own("target") {
        envelope.temperature_k = Some([target.temperature_k; 2]);
        envelope.materials = Some(vec![target.material.clone()]);
        envelope.distance_m = target.distance_m.map(|z| [z; 2]).or(envelope.distance_m);
    }
    if plain.has_own("environment") {
        envelope.lighting = Some(objects.iter().map(|object| [object.lighting; 2]).collect());
        envelope.surroundings_k = Some(objects.iter().map(|object| [object.temperature_k; 2]).collect());
    }
}

/// The source of a clause's scenario: its own tables stand where those of the rule stood.
fn relaid(source: &Source, key: &str) -> Source {
    fn lay<T: Clone>(of: &BTreeMap<String, T>, key: &str) -> Arc<BTreeMap<String, T>> {
        let own: Vec<(String, T)> = of
            .iter()
            .filter_map(|(full, value)| {
                Some((full.strip_prefix(key)?.strip_prefix('.')?.to_owned(), value.clone()))
            })
            .collect();
        let head = |full: &str| full.split(['.', '[']).next().unwrap_or_default().to_owned();
        let replaced: BTreeSet<String> = own.iter().map(|(full, _)| head(full)).collect();
        let kept = of.iter().filter(|(full, _)| !replaced.contains(&head(full)));
        Arc::new(kept.map(|(full, value)| (full.clone(), value.clone())).chain(own).collect())
    }
    let mut source = source.clone();
    source.with_settings_among();
    (source.lines, source.texts) = (lay(&source.lines, key), lay(&source.texts, key));
    source
}

/// Whether a table of the clause itself has a key.
fn has_own(plain: &Section<'_>, table: &str, key: &str) -> bool {
    plain.get(table).is_some_and(|entry| entry.table().is_ok_and(|own| own.has_own(key)))
}

/// Materials that a clause must name.
fn materials(plain: &Section<'_>, key: &str) -> Result<Vec<MaterialRef>> {
    let example = format!("{key} = [\"steel-rough\"]");
    let named = plain.require(key)?;
    let items = named.items(&example)?;
    if items.is_empty() {
        return Err(named.fail(Error::malformed("the list is empty", format!("write {example}"))));
    }
    without_repetition(&items, material)
}

/// The scenario of a target before a background whose temperature is within a range.
fn contrast(section: &Section<'_>, plain: &Section<'_>) -> Result<Scenario> {
    let behind = materials(plain, "behind")?;
    let mut scenario = of_root(section, requirement)?;
    if !has_own(plain, "alternatives", "temperature") {
        let found = "the temperature of what is behind the target is not stated";
        let instead = "write temperature = [\"0 degC\", \"20 degC\"] in [clause.alternatives]";
        return Err(plain.fail("alternatives.temperature", Error::malformed(found, instead)));
    }
    if has_own(plain, "alternatives", "materials") {
        let instead = "leave them to `behind`";
        let error = Error::malformed("materials beside `behind`", instead);
        return Err(plain.fail("alternatives.materials", error));
    }
    if !scenario.unknown.nuisances.contains(&Nuisance::Temperature) {
        let found = "the temperature of what is behind the target is taken as known, and is not";
        let instead = "write nuisances = [\"temperature\", \"lighting\"] in [clause.unknown]";
        return Err(plain.fail("unknown.nuisances", Error::malformed(found, instead)));
    }
    if scenario.unknown.priors.contains_key(&Nuisance::Temperature) {
        let found = "a prior says that what is behind the target is about as warm as the target, and alternatives.temperature how warm it is";
        let error = Error::malformed(found, "leave it out of [clause.unknown]");
        return Err(plain.fail("unknown.priors.temperature", error));
    }
    (scenario.alternatives.materials, scenario.alternatives.own_too) = (Some(behind), true);
    Ok(scenario)
}

/// The scenario of things that must not be taken for the rule's target.
fn false_alarm(section: &Section<'_>, plain: &Section<'_>, rule: &Scenario) -> Result<Scenario> {
    let things = materials(plain, "things")?;
    let mut scenario = of_root(section, requirement)?;
    if !matches!(scenario.requirement.reliability, Reliability::Rates { .. }) {
        let found = "the probability of false alarms is not stated";
        let instead =
            "write false_alarm_probability = 0.001 beside detection_probability in [clause.requirement]";
        return Err(plain.fail("requirement", Error::malformed(found, instead)));
    }
    let own_temperature = plain.has_own("target") || has_own(plain, "envelope", "temperature");
    if !own_temperature {
        let found = "the temperature of the things is not stated";
        let instead = "write temperature = [\"0 degC\", \"60 degC\"] in [clause.envelope]";
        return Err(plain.fail("envelope.temperature", Error::malformed(found, instead)));
    }
    let people = rule.envelope.as_ref().and_then(|envelope| envelope.materials.clone());
    let people = people.unwrap_or_else(|| vec![rule.target.material.clone()]);
    if let Some(own) = scenario.envelope.as_ref().filter(|_| plain.has_own("envelope"))
        && own.materials.is_some()
    {
        let instead = "leave them to `things`";
        return Err(plain.fail("envelope.materials", Error::malformed("materials beside `things`", instead)));
    }
    if !has_own(plain, "alternatives", "materials") {
        scenario.alternatives.materials = Some(people);
    }
    // A thing of what people are made of may be taken for one.
    scenario.alternatives.own_too = true;
    if !plain.has_own("alternatives") {
        // What robots may be like says nothing of people: these may be as they like, which is the hardest.
        (scenario.alternatives.temperature_range_k, scenario.alternatives.lighting_range) = (None, None);
    }
    of_its_own(&mut scenario, plain);
    if let Some(first) = things.first() {
        scenario.target.material = first.clone();
    }
    scenario.envelope.get_or_insert_default().materials = Some(things);
    Ok(scenario)
}

impl Clause {
    /// The envelope, with the scenario's own values where it is silent.
    #[must_use]
    pub fn envelope(&self) -> Envelope {
        self.scenario.envelope.clone().unwrap_or_default().filled(&self.scenario)
    }

    /// Refuses what says again what follows from `[stop]`, and scenes that are not lit as is known.
    fn check(&self) -> Result<()> {
        self.lit_as_known()?;
        self.street_is_the_envelope()?;
        if self.scenario.requirement.time_s.is_some() {
            let found = "a time in the requirement of a rule, which would not be judged";
            let instead = "write start = \"4 s\" in [stop], from which the time of the decision follows";
            return Err(Error::malformed(found, instead).at(self.scenario.place("requirement.time")));
        }
        if self.stop.is_none() {
            return Ok(());
        }
        let scenario = &self.scenario;
        let twice = [
            (
                "requirement.speed",
                scenario.requirement.speed_m_s.is_some(),
                "a speed beside [stop], which has one",
            ),
            (
                "target.distance",
                scenario.target.distance_m.is_some(),
                "a distance beside [stop], from which it follows",
            ),
            (
                "envelope.distance",
                scenario.envelope.as_ref().is_some_and(|envelope| envelope.distance_m.is_some()),
                "distances beside [stop], from which they follow",
            ),
        ];
        match twice.into_iter().find(|(_, given, _)| *given) {
            Some((key, _, found)) => Err(Error::malformed(found, "leave it out").at(scenario.place(key))),
            None => Ok(()),
        }
    }

    /// Refuses a distance of the street beside those of the envelope, over which the depth would not be judged.
    fn street_is_the_envelope(&self) -> Result<()> {
        let Demand::DepthError(demand) = &self.demand else { return Ok(()) };
        let street = demand.object.distance_m(&mut demand.scene.clone()).is_some();
        if !street || self.scenario.envelope.as_ref().is_none_or(|envelope| envelope.distance_m.is_none()) {
            return Ok(());
        }
        let found = "a distance beside envelope.distance, over which the depth is judged";
        let key = format!("scene.{}_distance", demand.object.name());
        Err(Error::malformed(found, "leave it out").at(self.scenario.place(&key)))
    }

    /// Refuses an envelope with scenes whose lighting does not add up to the total that is known: the alternative's always does, and
    /// would seem told apart by that alone.
    pub(super) fn lit_as_known(&self) -> Result<()> {
        let lighting = self.envelope().lighting.unwrap_or_default();
        let Some(total) = self.scenario.unknown.lighting_total else { return Ok(()) };
        let [least, most] = [0, 1].map(|end| lighting.iter().map(|range| range[end]).sum::<f64>());
        if [least, most].iter().all(|sum| (sum - total).abs() <= LIGHTING_ROUNDING) {
            return Ok(());
        }
        let found = format!("there are scenes whose lighting does not add up to lighting_total = {total}");
        let instead = "write values that do, such as lighting = [[0.3, 0.3], [0.7, 0.7]], a clause for each, or leave out lighting_total";
        Err(Error::malformed(found, instead).at(self.scenario.place("envelope.lighting")))
    }

    /// What it says itself, then the tables in which it differs from the rule.
    pub(super) fn document(&self, rule: &Scenario, paths: Paths<'_>) -> (Entries, Document) {
        let mut own = Entries::default()
            .put_if("name", self.name.as_deref())
            .put("kind", self.demand.kind())
            .put_if("text", self.text.as_deref());
        let mut scenario = self.scenario.clone();
        if self.demand == Demand::FalseAlarm
            && let Some(envelope) = &mut scenario.envelope
            && let Some(things) = envelope.materials.take()
        {
            let things: Vec<String> = things.iter().map(|material| paths.material(material)).collect();
            own = own.put("things", things);
            scenario.target.material = rule.target.material.clone();
        }
        if self.demand == Demand::Contrast
            && let Some(behind) = scenario.alternatives.materials.take()
        {
            own =
                own.put("behind", behind.iter().map(|material| paths.material(material)).collect::<Vec<_>>());
        }
        let shared = rule.document(paths);
        let written =
            |name: &str, part: &Part| shared.0.iter().any(|(other, same)| *other == name && same == part);
        let mut document: Vec<_> = scenario
            .document(paths)
            .0
            .into_iter()
            .filter(|(name, part)| {
                let needed =
                    *name == "alternatives" && self.demand != Demand::TellApart && self.demand.tells_apart();
                TABLES.contains(name) && *name != "requirement" && (needed || !written(name, part))
            })
            .collect();
        match self.demand.written(paths) {
            Some(parts) => document.extend(parts.0),
            None => {
                let part = Part::Table(write::requirement(&scenario.requirement));
                if !written("requirement", &part) {
                    document.push(("requirement", part));
                }
            }
        }
        if let Some(stop) = self.stop {
            document.push(("stop", Part::Table(stop.entries())));
        }
        let placed = |(name, part)| match part {
            Part::Table(entries) => (name, Part::Table(entries.read_from(&format!("{}.{name}", self.key)))),
            other => (name, other),
        };
        (own, Document(document.into_iter().map(placed).collect()))
    }
}
