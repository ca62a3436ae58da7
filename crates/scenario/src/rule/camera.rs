//! The cameras of a rule: known ones by name (`cameras`), others as tables (`[[camera]]`).

use crate::CameraSpec;
use crate::camera::read_with;
use crate::keys::rule::UNCERTAIN;
use crate::section::Entry;
use hadar::allowed::FROM_ZERO;
use hadar::error::{Error, Result};
use hadar::instrument::figures::{Kind, Row};
use hadar::units::Dimension;
use std::collections::BTreeMap;

/// A list at the top of a file stands before its tables.
const CAMERAS: &str = "cameras = [\"flir-a325sc\", \"ideal-pnrd\"]";

/// A camera that is held against a rule.
#[derive(Debug, Clone, PartialEq)]
pub struct RuleCamera {
    /// The name it is given, if any.
    pub name: Option<String>,
    /// What it is.
    pub spec: CameraSpec,
    /// Standard uncertainties of figures, by their keys, in the units used inside; not negative.
    pub uncertainty: BTreeMap<&'static str, f64>,
    /// Where it stands, e.g. `cameras[1]` or `camera[0]`.
    pub key: String,
}

impl RuleCamera {
    /// What it is called in a rule: the name it is given, or that of a known camera.
    #[must_use]
    pub fn called(&self) -> &str {
        self.name.as_deref().or(self.spec.preset.as_deref()).unwrap_or(&self.key)
    }

    /// Whether it is a known camera named in `cameras`, without keys of its own.
    #[must_use]
    pub fn is_listed(&self) -> bool {
        self.key.starts_with("cameras[")
    }
}

/// Known cameras as they are.
pub(super) fn presets(entry: &Entry<'_>) -> Result<Vec<RuleCamera>> {
    let items = entry.items(CAMERAS)?;
    let mut cameras: Vec<RuleCamera> = Vec::with_capacity(items.len());
    for (index, item) in items.iter().enumerate() {
        let name = item.name("\"flir-a325sc\"")?;
        let own = item.source().own_camera(&name);
        let spec = CameraSpec { preset: Some(name), own, ..CameraSpec::default() };
        if cameras.iter().any(|camera| camera.spec == spec) {
            return Err(item.fail(Error::malformed("the same is already in the list", "name it once")));
        }
        let (uncertainty, key) = (BTreeMap::new(), format!("cameras[{index}]"));
        cameras.push(RuleCamera { name: None, spec, uncertainty, key });
    }
    Ok(cameras)
}

/// Cameras of the rule's own.
pub(super) fn tables(entry: &Entry<'_>) -> Result<Vec<RuleCamera>> {
    let items = entry.items("each camera as [[camera]], in double brackets")?;
    items
        .iter()
        .enumerate()
        .map(|(index, item)| {
            let mut uncertainty = BTreeMap::new();
            let spec = read_with(item, &mut |row, entry| uncertain(row, entry, &mut uncertainty))?;
            let section = item.table()?;
            let name = section.text("name", "\"ours\"")?;
            Ok(RuleCamera { name, spec, uncertainty, key: format!("camera[{index}]") })
        })
        .collect()
}

/// A figure as a table of its value and its standard uncertainty, which is noted; whether it is one.
fn uncertain(row: &'static Row, entry: &Entry<'_>, noted: &mut BTreeMap<&'static str, f64>) -> Result<bool> {
    if !entry.is_table() {
        return Ok(false);
    }
    let section = entry.section_of(&UNCERTAIN)?;
    let u = section.require("u")?;
    let sigma = match row.kind {
        // Of a difference of temperatures, not of a temperature.
        Kind::Quantity(Dimension::Temperature, ..) => {
            u.quantity_as(Dimension::TemperatureDifference, FROM_ZERO)?
        }
        Kind::Quantity(dimension, ..) => u.quantity_as(dimension, FROM_ZERO)?,
        Kind::Number(..) | Kind::Efficiency(..) => u.number_as("0.01", FROM_ZERO)?,
        _ => {
            let found = format!("an uncertainty of {}, which is no measured number", row.key);
            return Err(entry.fail(Error::malformed(found, format!("write {} = {}", row.key, row.example))));
        }
    };
    noted.insert(row.key, sigma);
    Ok(true)
}
