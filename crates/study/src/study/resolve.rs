//! Names and files of a scenario looked up: materials on the nodes of the bands, surroundings, camera.

mod defaults;
mod finder;

use self::defaults::{alternatives_as_written, check_range, fill, state_range, unknowns};
use self::finder::Finder;
use super::sight::{Air, Behind, check_detector};
use super::{Warning, bands, camera};
use crate::scenario::{Reliability, Scenario};
use hadar::demand::Work;
use hadar::error::{Error, Result};
use hadar::fisher::{Nuisance, Unknowns};
use hadar::identifiability::detection;
use hadar::identifiability::nearest::StateRange;
use hadar::instrument::Camera;
use hadar::material::{Library, Material};
use hadar::scene::{EnvironmentObject, State, Surroundings};
use hadar::spectrum::Bands;

/// A material on the nodes of the bands.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    /// Name.
    pub name: String,
    /// Emissivity at the nodes.
    pub emissivity: Vec<f64>,
}

/// A scenario with everything it names looked up and checked.
#[derive(Debug, Clone)]
pub struct Study {
    pub(super) scenario: Scenario,
    /// The bands as they leave the target.
    pub(super) open_bands: Bands,
    /// The same behind path, optics and detector: what is counted.
    pub(super) bands: Bands,
    /// The air on the path.
    pub(super) atmosphere: Option<Air>,
    /// Emission of the path at the nodes, photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹; empty for none.
    pub(super) air: Vec<f64>,
    /// What is behind a target that does not fill the pixel.
    pub(super) behind: Option<Behind>,
    pub(super) surroundings: Surroundings,
    pub(super) state: State,
    pub(super) unknowns: Unknowns,
    pub(super) range: StateRange,
    pub(super) target: Surface,
    pub(super) alternatives: Vec<Surface>,
    pub(super) camera: Option<Camera>,
    pub(super) required: f64,
    /// Skies of the library that are no alternatives.
    pub(super) skies: Vec<String>,
    pub(super) warnings: Vec<Warning>,
    /// What it took to look everything up.
    pub(super) looked_up: Work,
}

impl Study {
    /// Looks up everything that `scenario` names, materials in `library`.
    ///
    /// # Errors
    /// An unknown material or camera (with the nearest names), a file that cannot be used, a spectrum that
    /// does not cover the bands; each with file, line and key.
    ///
    /// ```
    /// use hadar::{material::Library, scenario::Scenario, study::Study};
    /// let text = r#"
    ///     [target]
    ///     material = "skin"
    ///     temperature = "37 degC"
    ///     [[environment]]
    ///     temperature = "20 degC"
    ///     lighting = 0.5
    ///     [alternatives]
    ///     materials = ["aluminium"]
    /// "#;
    /// let study = Study::new(&Scenario::from_toml(text, None)?, &Library::embedded()?)?;
    /// let pair = &study.identify()?.pairs[0];
    /// assert!((pair.distance_nearest / 8.852e-4 - 1.0).abs() < 1e-3);
    /// # Ok::<(), hadar::Error>(())
    /// ```
    pub fn new(scenario: &Scenario, library: &Library) -> Result<Self> {
        let mut scenario = scenario.clone();
        let mut finder = Finder { scenario: &scenario, library, warnings: Vec::new(), skies: Vec::new() };
        let target =
            finder.find("target.material", &scenario.target.material, scenario.target.extrapolate)?;
        let environment = scenario
            .environment
            .iter()
            .enumerate()
            .map(|(k, object)| {
                let found = object.material.as_ref().map(|material| {
                    finder.find(&format!("environment[{k}].material"), material, object.extrapolate)
                });
                found.transpose()
            })
            .collect::<Result<Vec<_>>>()?;
        let behind = match scenario.background.as_ref().map(|behind| (behind.temperature_k, &behind.material))
        {
            None => None,
            Some((temperature_k, None)) => Some((temperature_k, None)),
            Some((temperature_k, Some(material))) => {
                let extrapolate = scenario.background.as_ref().and_then(|behind| behind.extrapolate);
                Some((temperature_k, Some(finder.find("background.material", material, extrapolate)?)))
            }
        };
        let bands = bands::at_centres(&scenario.bands, &scenario.source)?;
        let camera =
            scenario.camera.as_ref().map(|spec| camera::resolved(spec, &scenario.source)).transpose()?;
        if let Some(camera) = &camera {
            check_detector(&bands, camera, &scenario)?;
        }
        let alternatives = finder.alternatives(&target, &bands)?;
        let Finder { warnings, skies, .. } = finder;

        let materials =
            bands::Materials { target: &target, alternatives: &alternatives, environment: &environment };
        let bands = bands::integrated(&scenario, bands, &materials)?;

        let nodes = bands.nodes_cm1();
        let on_nodes = |material: &Material, key: &str| {
            let emissivity = material.emissivity(nodes).map_err(|error| error.at(scenario.place(key)))?;
            Ok(Surface { name: material.name().to_owned(), emissivity })
        };
        let objects = scenario
            .environment
            .iter()
            .zip(&environment)
            .enumerate()
            .map(|(k, (object, material))| {
                let key = format!("environment[{k}].material");
                let surface = material.as_ref().map(|material| on_nodes(material, &key)).transpose()?;
                Ok(EnvironmentObject {
                    temperature_k: object.temperature_k,
                    emissivity: surface.map(|surface| surface.emissivity),
                })
            })
            .collect::<Result<Vec<_>>>()?;
        let surroundings = Surroundings::new(nodes, objects)?;
        let lighting: Vec<f64> = scenario.environment.iter().map(|object| object.lighting).collect();
        let state = surroundings
            .state(scenario.target.temperature_k, &lighting)
            .map_err(|error| error.at(scenario.place("environment")))?;
        let target = on_nodes(&target, "target.material")?;
        let alternatives = alternatives
            .iter()
            .enumerate()
            .map(|(i, material)| on_nodes(material, &format!("alternatives.materials[{i}]")))
            .collect::<Result<Vec<_>>>()?;
        let behind = behind
            .map(|(temperature_k, material)| {
                let surface = match &material {
                    Some(material) => on_nodes(material, "background.material")?,
                    None => Surface { name: "blackbody".into(), emissivity: vec![1.0; nodes.len()] },
                };
                Ok::<_, Error>(Behind { surface, temperature_k })
            })
            .transpose()?;
        let required = match scenario.requirement.reliability {
            Reliability::Distance(distance) => distance,
            Reliability::DetectionProbability(probability) => {
                detection::distance_for_probability(probability)
                    .map_err(|error| error.at(scenario.place("requirement.detection_probability")))?
            }
        };
        let atmosphere = Air::of(&scenario)?;
        let unknowns = unknowns(&scenario).map_err(|error| error.at(scenario.place("unknown")))?;
        let range = state_range(&scenario);
        check_range(&scenario, &range)?;
        fill(&mut scenario, &alternatives_as_written(&alternatives), camera.as_ref(), &range);
        let mut study = Self {
            scenario,
            open_bands: bands.clone(),
            bands,
            atmosphere,
            air: Vec::new(),
            behind,
            surroundings,
            state,
            unknowns,
            range,
            target,
            alternatives,
            camera,
            required,
            skies,
            warnings,
            looked_up: library.work(),
        };
        study.check_sight()?;
        (study.bands, study.air) = study.received(study.camera.as_ref(), study.scenario.target.distance_m)?;
        study.check_magnitudes()?;
        Ok(study)
    }

    /// The scenario with its defaults filled in.
    #[must_use]
    pub fn scenario(&self) -> &Scenario {
        &self.scenario
    }

    /// The bands.
    #[must_use]
    pub fn bands(&self) -> &Bands {
        &self.bands
    }

    /// The surroundings.
    #[must_use]
    pub fn surroundings(&self) -> &Surroundings {
        &self.surroundings
    }

    /// The state of the target.
    #[must_use]
    pub fn state(&self) -> &State {
        &self.state
    }

    /// The unknowns.
    #[must_use]
    pub fn unknowns(&self) -> &Unknowns {
        &self.unknowns
    }

    /// The range of the alternatives' states.
    #[must_use]
    pub fn range(&self) -> StateRange {
        self.range
    }

    /// The target.
    #[must_use]
    pub fn target(&self) -> &Surface {
        &self.target
    }

    /// The alternatives.
    #[must_use]
    pub fn alternatives(&self) -> &[Surface] {
        &self.alternatives
    }

    /// The camera, if the scenario has one.
    #[must_use]
    pub fn camera(&self) -> Option<&Camera> {
        self.camera.as_ref()
    }

    /// The statistical distance that the requirement demands.
    #[must_use]
    pub fn required_distance(&self) -> f64 {
        self.required
    }

    /// Skies of the library that were left out where the scenario names no alternatives.
    #[must_use]
    pub fn skies_left_out(&self) -> &[String] {
        &self.skies
    }

    /// Whether a nuisance is among the unknowns.
    pub(super) fn is_unknown(&self, nuisance: Nuisance) -> bool {
        self.unknowns.contains(nuisance)
    }
}
