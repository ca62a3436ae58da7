//! The scenario: what is there, what it must be told apart from, the surroundings, the camera.
//!
//! A scenario is a TOML file whose quantities are strings with their unit (`"37 degC"`). Here it is plain
//! data in one unit per dimension, which the field's name carries (`temperature_k`, `pixel_m`); every value
//! was checked when it was read, and nothing is looked up: materials, filters and presets are names or
//! paths that other parts resolve, who get file and line of a key from [`Scenario::place`].
//!
//! Symbols: T temperature in K; V thermal lighting factor (share of the hemisphere above the target that an
//! environment object fills; V ≥ 0, ΣV ≤ 1); d statistical distance, P = Φ(d) detection probability.

use std::collections::BTreeMap;

pub use hadar::fisher::Nuisance;
use hadar::instrument::Extent;
pub use hadar::instrument::{CameraSpec, Efficiency, Readout};
pub use hadar::material::{ClassSpec, Extrapolation, MaterialRef, Spread};

pub mod air_ranging;
pub mod atmosphere;
pub mod bands;
pub mod calibrate;
mod camera;
pub mod cameras;
mod class;
pub mod decompose;
mod emissivity_error;
mod entries;
pub mod envelope;
pub mod examples;
pub mod find;
mod kept;
pub mod keys;
mod kind;
pub mod library;
mod parsed;
mod paths;
pub mod range;
mod read;
mod reader;
pub mod render;
mod report_inputs;
pub mod rule;
pub mod scene;
mod scene_folder;
mod section;
pub mod sensitivity;
mod setting;
pub mod source;
mod stated_camera;
mod units;
mod write;
mod written;

pub use air_ranging::{AirRangingScenario, RangingScenario};
pub use atmosphere::{AtmosphereSource, AtmosphereSpec};
pub use bands::{BandSource, BandsSpec, FilterList, FilterPlace, Filters};
use decompose::CategorySpec;
pub use decompose::DecomposeScenario;
pub use envelope::Envelope;
pub use find::FindSpec;
pub use library::LibraryScenario;
pub use range::RangeScenario;
pub use reader::{command_for, is_rule};
pub use render::RenderScenario;
pub use rule::Rule;
pub use scene::SceneSpec;
pub use section::{Date, day};
pub use sensitivity::SensitivitySpec;
pub use setting::Setting;
pub use source::Source;
pub use stated_camera::StatedCamera;
pub use units::{Units, interval};
pub use written::{STDIN, Written};

/// Everything a scenario file says, defaults filled in.
///
/// Two scenarios are equal when they ask the same question: where they were read from does not count.
///
/// ```
/// use hadar_scenario::{MaterialRef, Scenario};
/// let text = r#"
///     [target]
///     material = "skin"
///     temperature = "37 degC"
/// "#;
/// let scenario = Scenario::from_toml(text, None).unwrap();
/// assert_eq!(scenario.target.material, MaterialRef::Name("skin".to_owned()));
/// assert_eq!(scenario.target.temperature_k, 310.15);
///
/// let error = Scenario::from_toml(&text.replace(" degC", ""), None).unwrap_err();
/// assert_eq!(
///     error.to_string(),
///     "line 4: target.temperature: `37` is a number without a unit; write \"37 degC\" or \"310.15 K\""
/// );
/// ```
///
/// ```
/// use hadar_scenario::Scenario;
/// let text = "[target]\nmaterial = \"skin\"\ntemperature = \"37 degC\"";
/// let scenario = Scenario::from_toml(text, None).unwrap();
/// let filled = scenario.to_toml();
/// assert!(filled.contains("nuisances = [\"temperature\", \"lighting\"]"));
/// assert_eq!(Scenario::from_toml(&filled, None).unwrap(), scenario);
/// ```
#[derive(Debug, Clone)]
pub struct Scenario {
    /// What the scenario is about, for headings.
    pub title: Option<String>,
    /// Kinds of surfaces of several spectra each, by name.
    pub classes: BTreeMap<String, ClassSpec>,
    /// What is there.
    pub target: Target,
    /// What is behind the target.
    pub background: Option<Background>,
    /// The surroundings that light the target; may be empty (cold space).
    pub environment: Vec<EnvironmentObject>,
    /// What the target must be told apart from.
    pub alternatives: Alternatives,
    /// The air between target and camera; none, if it is not given.
    pub atmosphere: Option<AtmosphereSpec>,
    /// The spectral bands.
    pub bands: BandsSpec,
    /// What is not known beforehand.
    pub unknown: Unknown,
    /// The camera, if there is one.
    pub camera: Option<CameraSpec>,
    /// How reliably, and at which speed.
    pub requirement: Requirement,
    /// Scenes that the requirement must hold in, if not this one alone.
    pub envelope: Option<Envelope>,
    /// How wrong the emissivities may be; the defaults of [`SensitivitySpec`] where it is not given.
    pub sensitivity: Option<SensitivitySpec>,
    /// What may be chosen, where a camera is sought.
    pub find: Option<FindSpec>,
    /// What materials are parts of: where those that matter for safety cannot be excluded is said.
    pub categories: Vec<CategorySpec>,
    /// Where it was read from.
    pub source: Source,
}

impl Scenario {
    /// The units in which it was written.
    #[must_use]
    pub fn units(&self) -> Units {
        Units::of(&self.source)
    }

    /// Whether the verdict is of all pixels of the object together.
    #[must_use]
    pub fn is_of_object(&self) -> bool {
        self.scope() == Scope::Object
    }

    /// What the verdict is of: where nothing is said, the object if its pixels are stated.
    #[must_use]
    pub fn scope(&self) -> Scope {
        let stated = if self.target.pixels.is_some() { Scope::Object } else { Scope::Pixel };
        self.requirement.of.unwrap_or(stated)
    }
}

impl PartialEq for Scenario {
    fn eq(&self, other: &Self) -> bool {
        self.title == other.title
            && self.classes == other.classes
            && self.target == other.target
            && self.background == other.background
            && self.environment == other.environment
            && self.alternatives == other.alternatives
            && self.atmosphere == other.atmosphere
            && self.bands == other.bands
            && self.unknown == other.unknown
            && self.camera == other.camera
            && self.requirement == other.requirement
            && self.envelope == other.envelope
            && self.sensitivity == other.sensitivity
            && self.find == other.find
            && self.categories == other.categories
    }
}

/// The object that is there (`[target]`).
#[derive(Debug, Clone, PartialEq)]
pub struct Target {
    /// Its material.
    pub material: MaterialRef,
    /// Its temperature, K; above 0.
    pub temperature_k: f64,
    /// Its distance from the camera, m; above 0.
    pub distance_m: Option<f64>,
    /// Side of the target as the camera sees it, m; above 0. One that fills the pixel if none.
    pub size_m: Option<f64>,
    /// Pixels that it fills, in the place of a size.
    pub pixels: Option<PixelsFilled>,
    /// How its spectrum is continued beyond its data.
    pub extrapolate: Option<Extrapolation>,
}

/// How many pixels a target fills.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PixelsFilled {
    /// So many, as many rows as columns.
    All(u32),
    /// Rows and columns.
    Sides([u32; 2]),
}

impl PixelsFilled {
    /// Rows and columns, which the keys have checked.
    #[must_use]
    pub fn extent(self) -> Extent {
        let extent = match self {
            Self::All(pixels) => Extent::square(f64::from(pixels)),
            Self::Sides(sides) => Extent::new(sides.map(f64::from)),
        };
        extent.unwrap_or_default()
    }
}

/// What is behind a target that does not fill a pixel (`[background]`); lit as the target is.
#[derive(Debug, Clone, PartialEq)]
pub struct Background {
    /// Its temperature, K; above 0.
    pub temperature_k: f64,
    /// Its material; a blackbody if none.
    pub material: Option<MaterialRef>,
    /// How its spectrum is continued beyond its data.
    pub extrapolate: Option<Extrapolation>,
}

/// One object of the surroundings (`[[environment]]`).
#[derive(Debug, Clone, PartialEq)]
pub struct EnvironmentObject {
    /// Its temperature, K; above 0.
    pub temperature_k: f64,
    /// Its thermal lighting factor V, in [0, 1]; the sum over all objects is at most 1.
    pub lighting: f64,
    /// Its material; a blackbody if none.
    pub material: Option<MaterialRef>,
    /// How its spectrum is continued beyond its data.
    pub extrapolate: Option<Extrapolation>,
}

/// What the target must be told apart from (`[alternatives]`).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Alternatives {
    /// The materials; `None` means every other material of the library.
    pub materials: Option<Vec<MaterialRef>>,
    /// Range of the alternative's temperature, K, lower end first.
    pub temperature_range_k: Option<[f64; 2]>,
    /// Range of each lighting factor at the alternative, within [0, 1], lower end first.
    pub lighting_range: Option<[f64; 2]>,
    /// How the spectra of the alternatives are continued beyond their data.
    pub extrapolate: Option<Extrapolation>,
    /// Whether materials that do not cover the bands are left out, with a warning, instead of refused.
    pub skip_uncovered: bool,
    /// Whether the target's own material is one of them where it is named: what is behind it may be of that too.
    pub own_too: bool,
}

/// What is not known beforehand (`[unknown]`).
#[derive(Debug, Clone, PartialEq)]
pub struct Unknown {
    /// The unknowns, each at most once, in the order they were written; may be empty.
    pub nuisances: Vec<Nuisance>,
    /// Standard deviation of the prior of an unknown (K, or dimensionless: see [`Nuisance`]); above 0.
    pub priors: BTreeMap<Nuisance, f64>,
    /// The known sum of all lighting factors, which makes one of them no unknown of its own (S48).
    pub lighting_total: Option<f64>,
}

impl Default for Unknown {
    fn default() -> Self {
        Self {
            nuisances: vec![Nuisance::Temperature, Nuisance::Lighting],
            priors: BTreeMap::new(),
            lighting_total: None,
        }
    }
}

/// How reliable the decision must be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Reliability {
    /// Detection probability P = Φ(d), between 0.5 (a coin) and 1, both excluded.
    DetectionProbability(f64),
    /// Statistical distance d; above 0. d = 1 is P = 0.8413.
    Distance(f64),
    /// Detection probability as above, and the probability that an alternative is taken for the target, between 0 and 0.5.
    Rates {
        /// Of finding what is there.
        detection: f64,
        /// Of finding what is not there.
        false_alarm: f64,
    },
}

hadar::named! {
    /// Which distance a requirement is about; what they are is said with the distances themselves.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub enum DistanceKind {
        /// To the nearest state of the alternative: the limit that no test exceeds.
        #[default]
        Nearest = "nearest",
        /// Its tangent at the target, with the unknowns of the scenario.
        Local = "local",
        /// The same with the gain unknown too: the paper's S29.
        LocalUnknownGain = "local-unknown-gain",
    }
    /// The name in a scenario, e.g. `local-unknown-gain`.
    name
}

hadar::named! {
    /// What a verdict is of.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub enum Scope {
        /// One pixel on the target.
        #[default]
        Pixel = "pixel",
        /// All pixels that the target fills, together.
        Object = "object",
    }
    /// The name in a scenario.
    name
}

/// What is demanded (`[requirement]`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Requirement {
    /// How reliable the decision must be, in the terms it was written in.
    pub reliability: Reliability,
    /// The distance that must reach it.
    pub by: DistanceKind,
    /// What must reach it: one pixel or the whole object; the object where `target.pixels` is stated and nothing else is said.
    pub of: Option<Scope>,
    /// Speed of the vehicle, m s⁻¹; above 0.
    pub speed_m_s: Option<f64>,
    /// Time within which all bands of all frames must be read, s; above 0.
    pub time_s: Option<f64>,
}

impl Default for Requirement {
    fn default() -> Self {
        Self {
            reliability: Reliability::Distance(1.0),
            by: DistanceKind::Nearest,
            of: None,
            speed_m_s: None,
            time_s: None,
        }
    }
}
