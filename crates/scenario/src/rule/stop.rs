//! The `[stop]` of a rule or of one of its clauses: how fast the vehicle is, how it brakes, where the target comes into view.
//!
//! From it follow the distances at which the camera must have decided, and how long it may look; see
//! [`hadar::policy::stop`].

use crate::entries::Entries;
use crate::section::{Entry, Section};
use hadar::error::{Error, Result};
use hadar::policy::encounter::Encounter;
use hadar::policy::stop::{Start, Stop, StopFigures};
use hadar::units::Dimension;

/// How a vehicle comes to a stop before the target (`[stop]`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StopSpec {
    figures: StopFigures,
    stop: Stop,
    encounter: Option<Encounter>,
}

/// How far from the camera's axis a target meets the vehicle at most where nobody says, m: half a car, and a person.
const OFFSET_M: f64 = 1.0;

impl StopSpec {
    /// The manoeuvre.
    #[must_use]
    pub fn stop(&self) -> &Stop {
        &self.stop
    }

    /// Its figures.
    #[must_use]
    pub fn figures(&self) -> &StopFigures {
        &self.figures
    }

    /// That the target crosses, where it is said how fast.
    #[must_use]
    pub fn encounter(&self) -> Option<&Encounter> {
        self.encounter.as_ref()
    }

    /// The same at one of its speeds.
    pub(super) fn at(&self, speed_m_s: f64) -> Result<Self> {
        let figures = StopFigures { speeds_m_s: [speed_m_s; 2], ..self.figures };
        let stop = Stop::new(figures)?;
        let crossing = |one: Encounter| Encounter::new(stop, one.crossing_m_s(), one.offset_m());
        Ok(Self { figures, stop, encounter: self.encounter.map(crossing).transpose()? })
    }

    pub(super) fn read(entry: &Entry<'_>) -> Result<Self> {
        let section = entry.section()?;
        let speed = section.require("speed")?;
        let one = |entry: &Entry<'_>| entry.quantity();
        let speeds_m_s = match speed.is_list() {
            true => speed.range("[\"10 km/h\", \"60 km/h\"]", one, |speed| speed)?,
            false => [one(&speed)?; 2],
        };
        section.at_most_one(&["target_speed", "closing_speed"])?;
        let target_m_s = match section.quantity("closing_speed")? {
            Some(_) if speeds_m_s[0] != speeds_m_s[1] => {
                let found = "one closing speed for a range of speeds";
                let instead = "write target_speed = \"5 km/h\", the target's own speed along the way";
                return Err(section.fail("closing_speed", Error::malformed(found, instead)));
            }
            Some(closing_m_s) => speeds_m_s[0] - closing_m_s,
            None => section.quantity("target_speed")?.unwrap_or(0.0),
        };
        let required = |key| -> Result<f64> { section.require(key)?.quantity() };
        let figures = StopFigures {
            speeds_m_s,
            target_m_s,
            latency_s: required("latency")?,
            deceleration_m_s2: required("deceleration")?,
            margin_m: section.quantity("margin")?.unwrap_or(0.0),
            start: section.read("start", start)?,
        };
        let stop = Stop::new(figures).map_err(|error| misfit(&section, error))?;
        let offset_m = section.quantity("offset")?;
        let encounter = match (section.quantity("crossing_speed")?, offset_m) {
            (None, Some(_)) => {
                let found = "where a target crosses, and not how fast";
                let instead = "write crossing_speed = \"5 km/h\" beside it, or \"0 km/h\" of one that stands";
                return Err(section.fail("offset", Error::malformed(found, instead)));
            }
            (crossing, offset_m) => crossing
                .map(|crossing_m_s| Encounter::new(stop, crossing_m_s, offset_m.unwrap_or(OFFSET_M)))
                .transpose()
                .map_err(|error| section.fail("crossing_speed", error))?,
        };
        Ok(Self { figures, stop, encounter })
    }

    pub(super) fn entries(self) -> Entries {
        let StopFigures { speeds_m_s, target_m_s, latency_s, deceleration_m_s2, margin_m, start } =
            self.figures;
        let entries = match speeds_m_s {
            [one, other] if one == other => {
                Entries::default().put_quantity("speed", Dimension::Speed, Some(one))
            }
            range => Entries::default().put_range("speed", Dimension::Speed, Some(range)),
        };
        let entries = entries
            .put_quantity("target_speed", Dimension::Speed, Some(target_m_s))
            .put_quantity("latency", Dimension::Time, Some(latency_s))
            .put_quantity("deceleration", Dimension::Acceleration, Some(deceleration_m_s2))
            .put_quantity("margin", Dimension::Length, Some(margin_m))
            .put_quantity("crossing_speed", Dimension::Speed, self.encounter.map(|one| one.crossing_m_s()))
            .put_quantity("offset", Dimension::Length, self.encounter.map(|one| one.offset_m()));
        match start {
            Some(Start::TimeToContact(time_s)) => {
                entries.put_quantity("start", Dimension::Time, Some(time_s))
            }
            Some(Start::Distance(start_m)) => entries.put_quantity("start", Dimension::Length, Some(start_m)),
            None => entries,
        }
    }
}

/// A time before contact or a distance, by its unit.
fn start(entry: &Entry<'_>) -> Result<Start> {
    let text = entry.quantity_text()?;
    if Dimension::Time.unit_in(&text).is_some() {
        return entry.quantity_of(Dimension::Time).map(Start::TimeToContact);
    }
    if Dimension::Length.unit_in(&text).is_some() {
        return entry.quantity_of(Dimension::Length).map(Start::Distance);
    }
    let found = format!("`{}` is neither a time before contact nor a distance", text.trim());
    Err(entry.fail(Error::malformed(found, "write start = \"4 s\" or start = \"60 m\"")))
}

/// Figures that do not go together, by the key of the one that is at fault.
fn misfit(section: &Section<'_>, error: Error) -> Error {
    let key = match &error {
        Error::OutOfRange { quantity, .. } => match quantity.as_str() {
            "start" | "time to contact" => "start",
            "speed of the target" if section.has_own("closing_speed") => "closing_speed",
            "speed of the target" => "target_speed",
            _ => "speed",
        },
        _ => "speed",
    };
    section.fail(key, error)
}
