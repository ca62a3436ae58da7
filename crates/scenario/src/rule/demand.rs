//! What a clause demands beside telling materials apart: pixels, a temperature, a distance.

use crate::entries::{Document, Entries};
use crate::paths::Paths;
use crate::range::{DepthRequirement, Stereo, read as depth, write as depth_written};
use crate::scene::{SceneSpec, scene, scene_written};
use crate::section::Section;
use hadar::error::{Error, Result};
use hadar::units::Dimension;

/// Deviations within which a temperature must lie, where nothing is said: 95 %.
const COVERAGE_FACTOR: f64 = 2.0;

/// What a clause demands.
#[derive(Debug, Clone, PartialEq)]
pub enum Demand {
    /// The target is told from its alternatives.
    TellApart,
    /// Things are not taken for the rule's target.
    FalseAlarm,
    /// The target stands out from what is behind it.
    Contrast,
    /// So many pixels across the target.
    Resolution {
        /// Pixels, not whole ones alone.
        pixels: f64,
        /// The critical dimension of the target, m.
        size_m: f64,
    },
    /// The temperature of the target is known.
    TemperatureError {
        /// How well, K.
        error_k: f64,
        /// Standard deviations that must lie within.
        coverage_factor: f64,
    },
    /// The distance of something is known.
    DepthError(Box<DepthDemand>),
}

/// A distance that must be known.
#[derive(Debug, Clone, PartialEq)]
pub struct DepthDemand {
    /// The street.
    pub scene: SceneSpec,
    /// The pair of cameras.
    pub stereo: Stereo,
    /// How well, and in what share of the windows.
    pub requirement: DepthRequirement,
    /// Of what.
    pub object: DepthObject,
}

hadar::named! {
    /// An object of the street whose distance is that of the clause.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum DepthObject {
        /// The person.
        Person = "person",
        /// The car.
        Car = "car",
    }
    /// The name in a rule, which is that of the rendered surface.
    name
}

impl DepthObject {
    /// Its distance in a street, m.
    pub fn distance_m(self, scene: &mut SceneSpec) -> &mut Option<f64> {
        match self {
            Self::Person => &mut scene.person_distance_m,
            Self::Car => &mut scene.car_distance_m,
        }
    }
}

impl Demand {
    /// The name of its kind, e.g. `tell-apart`.
    #[must_use]
    pub const fn kind(&self) -> &'static str {
        match self {
            Self::TellApart => "tell-apart",
            Self::FalseAlarm => "false-alarm",
            Self::Contrast => "contrast",
            Self::Resolution { .. } => "resolution",
            Self::TemperatureError { .. } => "temperature-error",
            Self::DepthError(_) => "depth-error",
        }
    }
}

impl Demand {
    /// Whether materials are told apart, as `[requirement]` of the scenario says.
    #[must_use]
    pub const fn tells_apart(&self) -> bool {
        matches!(self, Self::TellApart | Self::FalseAlarm | Self::Contrast)
    }

    /// Its tables; `None` of what `[requirement]` of the scenario says.
    pub(super) fn written(&self, paths: Paths<'_>) -> Option<Document> {
        let requirement = |entries: Entries| Some(Document::default().put("requirement", entries));
        match self {
            Self::TellApart | Self::FalseAlarm | Self::Contrast => None,
            Self::Resolution { pixels, size_m } => {
                requirement(Entries::default().put("pixels", *pixels).put_quantity(
                    "size",
                    Dimension::Length,
                    Some(*size_m),
                ))
            }
            Self::TemperatureError { error_k, coverage_factor } => requirement(
                Entries::default()
                    .put_quantity("temperature_error", Dimension::TemperatureDifference, Some(*error_k))
                    .put("coverage_factor", *coverage_factor),
            ),
            Self::DepthError(demand) => {
                let own = depth_written::requirement(demand.requirement).put("object", demand.object.name());
                requirement(own).map(|document| {
                    document
                        .put("scene", scene_written(&demand.scene, paths))
                        .put("stereo", depth_written::stereo(&demand.stereo))
                })
            }
        }
    }
}

pub(super) fn resolution(plain: &Section<'_>) -> Result<Demand> {
    let requirement = plain.require("requirement")?;
    let requirement = requirement.section()?;
    Ok(Demand::Resolution {
        pixels: requirement.require("pixels")?.number("6")?,
        size_m: requirement.require("size")?.quantity()?,
    })
}

pub(super) fn temperature_error(plain: &Section<'_>) -> Result<Demand> {
    let requirement = plain.require("requirement")?;
    let requirement = requirement.section()?;
    let error = requirement.require("temperature_error")?;
    Ok(Demand::TemperatureError {
        error_k: error.quantity()?,
        coverage_factor: requirement.number("coverage_factor")?.unwrap_or(COVERAGE_FACTOR),
    })
}

pub(super) fn depth_error(plain: &Section<'_>, stops: bool) -> Result<Demand> {
    let objects = DepthObject::ALL.map(|object| (object.name(), object));
    let entry = plain.require("requirement")?;
    let object = entry.table()?.choice("object", &objects)?.unwrap_or(DepthObject::Person);
    let requirement = depth::requirement(&entry)?;
    let scene = match plain.get("scene") {
        Some(entry) => scene(&entry)?,
        None => SceneSpec::default(),
    };
    let own = match object {
        DepthObject::Person => ("scene.person_distance", scene.person_distance_m),
        DepthObject::Car => ("scene.car_distance", scene.car_distance_m),
    };
    if stops && own.1.is_some() {
        let found = "a distance beside [stop], from which it follows";
        return Err(plain.fail(own.0, Error::malformed(found, "leave it out")));
    }
    let stereo = depth::stereo_of_scene(&plain.require("stereo")?)?;
    Ok(Demand::DepthError(Box::new(DepthDemand { scene, stereo, requirement, object })))
}
