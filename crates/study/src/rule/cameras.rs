//! The cameras of a rule, looked up once for all of its clauses.

use crate::{bands, camera, camera_bands};
use hadar::error::{Error, Result};
use hadar::instrument::Camera;
use hadar::spectrum::Bands;
use hadar_scenario::rule::{Known, RuleCamera};
use hadar_scenario::{CameraSpec, Rule, Scenario};
use std::collections::BTreeMap;

/// A camera with the name that the rule's answer has for it.
#[derive(Debug, Clone)]
pub(super) struct Named {
    pub(super) name: String,
    pub(super) camera: Camera,
    pub(super) spec: CameraSpec,
    /// Where it stands among the cameras of the rule.
    pub(super) index: usize,
    pub(super) uncertainty: BTreeMap<&'static str, Known>,
}

impl Named {
    /// Whether it may be better than its figures, which are limits.
    pub(super) fn may_be_better(&self) -> bool {
        self.uncertainty.values().any(|known| matches!(known, Known::AtMost))
    }

    /// How many bands of a scenario it reads.
    pub(super) fn bands(&self, scenario: &Scenario) -> Result<usize> {
        Ok(self.read(scenario)?.len())
    }

    /// The bands of a scenario that it reads.
    pub(super) fn read(&self, scenario: &Scenario) -> Result<Bands> {
        let asked = camera_bands::asked(&scenario.bands.source, Some((&self.camera, &self.spec)));
        bands::seen_by(&asked, &scenario.source, Some(self.camera.rim_sine()))
    }
}

/// All cameras of a rule; their mistakes are told by the keys that they have in it.
pub(super) fn of(rule: &Rule) -> Result<Vec<Named>> {
    let mut found: Vec<Named> = Vec::with_capacity(rule.cameras.len());
    for (index, own) in rule.cameras.iter().enumerate() {
        if own.is_listed() {
            complete(own).map_err(|error| error.at(rule.camera_place(index, "preset")))?;
        }
        let camera = camera::resolved_at(&own.spec, &|key| rule.camera_place(index, key))?;
        let preset = own.spec.preset.is_some().then(|| camera.name.clone());
        let name = own.name.clone().or(preset).unwrap_or_else(|| format!("camera {}", index + 1));
        if found.iter().any(|other| other.name == name) {
            let error = Error::malformed(
                format!("another camera is called {name} too"),
                "give it a name of its own, as in name = \"ours\"",
            );
            return Err(error.at(rule.camera_place(index, "name")));
        }
        let (spec, uncertainty) = (own.spec.clone(), own.uncertainty.clone());
        found.push(Named { name, camera, spec, index, uncertainty });
    }
    Ok(found)
}

/// Refuses a known camera, named alone, of which no document states all that is needed.
fn complete(own: &RuleCamera) -> Result<()> {
    let Some(known) = camera::known(&own.spec)? else { return Ok(()) };
    let (name, Err(missing)) = (&known.name, known.camera()) else { return Ok(()) };
    let found = format!("no document that was read states {} of {name}", missing.0.join(", "));
    let instead = "write it as a table of its own, with what the camera has in place of the dots:".into();
    let head = [String::from("[[camera]]"), format!("preset = {name:?}")];
    Err(Error::Incomplete { found, instead, lines: head.into_iter().chain(missing.lines()).collect() })
}
