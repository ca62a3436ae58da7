//! The cameras of a rule: known ones by name (`cameras`), others as tables (`[[camera]]`).

use super::known::{Known, Uncertainty};
use crate::CameraSpec;
use crate::camera::read_with;
use crate::keys::rule::UNCERTAIN;
use crate::section::Entry;
use hadar::allowed::FROM_ZERO;
use hadar::error::{Error, Place, Result};
use hadar::instrument::figures::{Kind, Row};
use hadar::units::Dimension;
use hadar::words::significant;
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
    /// How well figures are known, by their keys.
    pub uncertainty: BTreeMap<&'static str, Known>,
    /// What part of a market it is.
    pub share: Option<f64>,
    /// Where it stands, e.g. `cameras[1]` or `camera[0]`.
    pub key: String,
}

/// What shares may add up to above 1.
const SHARES_ROUNDING: f64 = 1e-9;
/// Of which a larger one is never better: noise.
const NOISE: [&str; 11] = [
    "netd",
    "noise_electrons",
    "read_noise",
    "dark_rate",
    "fixed_pattern",
    "row_noise",
    "column_noise",
    "offset_drift",
    "temporal_row_noise",
    "temporal_column_noise",
    "frame_noise",
];
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
        cameras.push(RuleCamera { name: None, spec, uncertainty, share: None, key });
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
            let share = section.number("share")?;
            Ok(RuleCamera { name, spec, uncertainty, share, key: format!("camera[{index}]") })
        })
        .collect()
}

/// A figure as a table of its value and how well it is known, which is noted; whether it is one.
fn uncertain(
    row: &'static Row,
    entry: &Entry<'_>,
    noted: &mut BTreeMap<&'static str, Known>,
) -> Result<bool> {
    if !entry.is_table() {
        return Ok(false);
    }
    let section = entry.section_of(&UNCERTAIN)?;
    section.at_most_one(&["value", "at_most"])?;
    if section.has_own("at_most") {
        if let Some(beside) = ["u", "law", "same"].into_iter().find(|beside| section.has_own(beside)) {
            let found = format!("{beside} beside at_most");
            return Err(section.fail(beside, Error::malformed(found, "write value and u, or at_most alone")));
        }
        if !NOISE.contains(&row.key) {
            let found = format!("a limit of {}, of which it is not known which side is worse", row.key);
            let instead = format!(
                "write {} = {{ value = ..., u = ... }}; at_most is for {}",
                row.key,
                NOISE.join(", ")
            );
            return Err(section.fail("at_most", Error::malformed(found, instead)));
        }
        noted.insert(row.key, Known::AtMost);
        return Ok(true);
    }
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
    let rectangular = section.choice("law", &[("gaussian", false), ("rectangular", true)])?.unwrap_or(false);
    let same = section.text("same", "\"lens\"")?;
    noted.insert(row.key, Known::Within(Uncertainty { sigma, rectangular, same }));
    Ok(true)
}

/// Refuses shares of more than a whole market, and a name of figures with the same error that one figure of a camera has alone: errors of two cameras, which are judged apart, have nothing
/// to do with each other.
pub(super) fn check(cameras: &[RuleCamera], place: impl Fn(usize, &str) -> Place) -> Result<()> {
    let named = |camera: &RuleCamera, name: &str| {
        let all = camera.uncertainty.values();
        all.filter(|known| matches!(known, Known::Within(one) if one.same.as_deref() == Some(name))).count()
    };
    let mut all = 0.0;
    for (index, camera) in cameras.iter().enumerate() {
        all += camera.share.unwrap_or(0.0);
        if all > 1.0 + SHARES_ROUNDING {
            let found = format!("shares of a market that add up to {}", significant(all, 4));
            return Err(
                Error::malformed(found, "write shares that add up to 1 at most").at(place(index, "share"))
            );
        }
    }
    for (index, camera) in cameras.iter().enumerate() {
        for (key, known) in &camera.uncertainty {
            let Known::Within(Uncertainty { same: Some(same), .. }) = known else { continue };
            if named(camera, same) < 2 {
                let elsewhere = cameras.iter().any(|other| other.key != camera.key && named(other, same) > 0);
                let found = match elsewhere {
                    true => format!("one error, {same:?}, of figures of two cameras, which are judged apart"),
                    false => format!("no other figure has the same error, {same:?}"),
                };
                let instead = format!("give two figures of this camera same = {same:?}, or leave it out");
                return Err(Error::malformed(found, instead).at(place(index, key)));
            }
        }
    }
    Ok(())
}
