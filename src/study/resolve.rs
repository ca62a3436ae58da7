//! Names and files of a scenario looked up: materials on the nodes of the bands, surroundings, camera.

use super::{Warning, bands, camera};
use crate::error::{Error, Result};
use crate::fisher::{Nuisance, Unknowns};
use crate::identifiability::detection;
use crate::identifiability::nearest::StateRange;
use crate::instrument::{Camera, NoiseSpec};
use crate::material::{Library, Material};
use crate::scenario::{MaterialRef, Reliability, Scenario};
use crate::scene::{EnvironmentObject, State, Surroundings};
use crate::spectrum::Bands;
use std::borrow::Cow;

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
    pub(super) bands: Bands,
    pub(super) surroundings: Surroundings,
    pub(super) state: State,
    pub(super) unknowns: Unknowns,
    pub(super) range: StateRange,
    pub(super) target: Surface,
    pub(super) alternatives: Vec<Surface>,
    pub(super) camera: Option<Camera>,
    pub(super) required: f64,
    pub(super) warnings: Vec<Warning>,
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
        let mut finder = Finder { scenario: &scenario, library, warnings: Vec::new() };
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
        let bands = bands::at_centres(&scenario)?;
        let alternatives = finder.alternatives(&target, &bands)?;
        let warnings = finder.warnings;

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
        let camera = scenario.camera.as_ref().map(|spec| camera::resolved(spec, &scenario)).transpose()?;
        let required = match scenario.requirement.reliability {
            Reliability::Distance(distance) => distance,
            Reliability::DetectionProbability(probability) => {
                detection::distance_for_probability(probability)
                    .map_err(|error| error.at(scenario.place("requirement.detection_probability")))?
            }
        };
        let unknowns = unknowns(&scenario).map_err(|error| error.at(scenario.place("unknown")))?;
        let range = state_range(&scenario);
        check_range(&scenario, &range)?;
        fill(&mut scenario, &alternatives_as_written(&alternatives), camera.as_ref(), &range);
        let study = Self {
            scenario,
            bands,
            surroundings,
            state,
            unknowns,
            range,
            target,
            alternatives,
            camera,
            required,
            warnings,
        };
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
}

struct Finder<'a> {
    scenario: &'a Scenario,
    library: &'a Library,
    warnings: Vec<Warning>,
}

impl<'a> Finder<'a> {
    fn find(
        &mut self,
        key: &str,
        reference: &MaterialRef,
        extrapolate: Option<crate::material::Extrapolation>,
    ) -> Result<Cow<'a, Material>> {
        let found = match reference {
            MaterialRef::Name(name) => self.library.get(name).map(Cow::Borrowed),
            // A file's own mistakes are told with the file's place, not the scenario's.
            MaterialRef::File(path) => {
                return Material::from_file(path).map(|m| self.accept(Cow::Owned(m), extrapolate));
            }
        };
        found
            .map(|material| self.accept(material, extrapolate))
            .map_err(|error| error.at(self.scenario.place(key)))
    }

    fn accept(
        &mut self,
        material: Cow<'a, Material>,
        extrapolate: Option<crate::material::Extrapolation>,
    ) -> Cow<'a, Material> {
        for warning in material.warnings() {
            self.warnings.push(Warning::new("material", format!("{}: {warning}", material.name())));
        }
        match extrapolate {
            Some(extrapolation) => Cow::Owned(material.into_owned().with_extrapolation(extrapolation)),
            None => material,
        }
    }

    /// The alternatives named, or every other surface of the library. Those that do not cover the bands are
    /// refused, or left out with a warning where the scenario asks for it.
    fn alternatives(&mut self, target: &Material, bands: &Bands) -> Result<Vec<Cow<'a, Material>>> {
        let wanted = &self.scenario.alternatives;
        let found: Vec<Cow<'a, Material>> = match &wanted.materials {
            Some(materials) => {
                let found = materials.iter().enumerate().map(|(i, material)| {
                    self.find(&format!("alternatives.materials[{i}]"), material, wanted.extrapolate)
                });
                let mut found: Vec<Cow<'a, Material>> = found.collect::<Result<_>>()?;
                // The target cannot be told from itself; alone it stays, so that the answer says so.
                let own = materials.iter().position(|material| *material == self.scenario.target.material);
                if let Some(own) = own
                    && found.len() > 1
                {
                    found.remove(own);
                    let message =
                        format!("{} is left out of the alternatives: it is the target", target.name());
                    self.warnings.push(Warning::new("target-among-alternatives", message));
                }
                found
            }
            None => self
                .library
                .iter()
                .filter(|material| material.name() != target.name() && is_surface(material))
                .map(|material| self.accept(Cow::Borrowed(material), wanted.extrapolate))
                .collect(),
        };
        if found.is_empty() {
            let instead = "name alternatives.materials, or add spectra with --library";
            let error = Error::malformed("the library has no other material than the target", instead);
            return Err(error.at(self.scenario.place("alternatives")));
        }
        if wanted.materials.is_some() && !wanted.skip_uncovered {
            // Said of each by name and key when it is sampled.
            return Ok(found);
        }
        let (low, high) = bands.range_cm1();
        let (kept, left): (Vec<_>, Vec<_>) = found.into_iter().partition(|material| {
            let range = material.range_cm1();
            wanted.extrapolate.is_some() || range.is_none_or(|(first, last)| first <= low && last >= high)
        });
        let names: Vec<&str> = left.iter().map(|material| material.name()).collect();
        if names.is_empty() {
            return Ok(kept);
        }
        if !wanted.skip_uncovered || kept.is_empty() {
            let found = format!(
                "{} of {} alternatives do not cover the bands ({low} to {high} cm^-1): {}",
                names.len(),
                names.len() + kept.len(),
                shortened(&names)
            );
            let instead = if kept.is_empty() {
                "choose bands that the spectra cover, or alternatives.extrapolate = \"hold\""
            } else {
                "leave them out with --skip-uncovered, name alternatives.materials, or choose other bands"
            };
            return Err(Error::malformed(found, instead).at(self.scenario.place("alternatives")));
        }
        for name in names {
            let message = format!("{name} is left out: its spectrum does not cover the bands");
            self.warnings.push(Warning::new("material-skipped", message));
        }
        Ok(kept)
    }
}

/// The first few of many names.
fn shortened(names: &[&str]) -> String {
    const SHOWN: usize = 6;
    let shown = names.iter().take(SHOWN).copied().collect::<Vec<_>>().join(", ");
    match names.len().checked_sub(SHOWN) {
        Some(more) if more > 0 => format!("{shown} and {more} more"),
        _ => shown,
    }
}

/// Skies are surroundings, not something a target could be made of.
fn is_surface(material: &Material) -> bool {
    !material.name().starts_with("sky-") && material.name() != "sky"
}

fn alternatives_as_written(alternatives: &[Surface]) -> Vec<String> {
    alternatives.iter().map(|surface| surface.name.clone()).collect()
}

fn unknowns(scenario: &Scenario) -> Result<Unknowns> {
    let unknown = &scenario.unknown;
    let mut unknowns =
        Unknowns::new(unknown.nuisances.iter().copied())?.lighting_total(unknown.lighting_total)?;
    for (nuisance, sigma) in &unknown.priors {
        unknowns = unknowns.prior(*nuisance, *sigma)?;
    }
    Ok(unknowns)
}

fn state_range(scenario: &Scenario) -> StateRange {
    let default = StateRange::default();
    StateRange {
        temperature_k: scenario.alternatives.temperature_range_k.unwrap_or(default.temperature_k),
        lighting: scenario.alternatives.lighting_range.unwrap_or(default.lighting),
        lighting_sum: default.lighting_sum,
    }
}

/// The least lighting of all objects together must fit into what they may sum to.
fn check_range(scenario: &Scenario, range: &StateRange) -> Result<()> {
    let least = range.lighting[0] * scenario.environment.len() as f64;
    let most = scenario.unknown.lighting_total.unwrap_or(range.lighting_sum);
    if least <= most {
        return Ok(());
    }
    let found = format!("a lighting of at least {} for each object makes {least} in all", range.lighting[0]);
    let error = Error::malformed(found, format!("lower it, so that all together stay at or below {most}"));
    Err(error.at(scenario.place("alternatives.lighting")))
}

/// Fills in what the scenario left silent and others knew, so that its echo says everything.
fn fill(scenario: &mut Scenario, alternatives: &[String], camera: Option<&Camera>, range: &StateRange) {
    if scenario.alternatives.materials.is_none() {
        scenario.alternatives.materials =
            Some(alternatives.iter().map(|name| MaterialRef::Name(name.clone())).collect());
    }
    scenario.alternatives.temperature_range_k = Some(range.temperature_k);
    scenario.alternatives.lighting_range = Some(range.lighting);
    if let (Some(spec), Some(camera)) = (scenario.camera.as_mut(), camera) {
        // A preset's noise stays the preset's, stated under the preset's own conditions. Noise of the
        // scenario's own is written with its conditions, so that it stays what it is when the rest is changed.
        match camera.noise {
            NoiseSpec::Netd { temperature_k, f_number, pixel_m, .. } if spec.netd_k.is_some() => {
                spec.netd_temperature_k = Some(temperature_k);
                spec.netd_f_number = Some(f_number);
                spec.netd_pixel_m = Some(pixel_m);
                spec.noise_exposure_s = Some(camera.noise_exposure_s);
            }
            NoiseSpec::Detectivity { .. } if spec.detectivity_cm_hz05_w.is_some() => {
                spec.noise_exposure_s = Some(camera.noise_exposure_s);
            }
            NoiseSpec::Counts { .. } if spec.noise_electrons.is_some() => {
                spec.noise_exposure_s = Some(camera.noise_exposure_s);
            }
            _ => {}
        }
        spec.exposure_s = Some(camera.exposure_s);
        spec.pixel_m = Some(camera.pixel_m);
        spec.f_number = Some(camera.f_number);
        spec.focal_length_m = Some(camera.focal_length_m);
        spec.optics_efficiency = Some(camera.optics_efficiency);
        spec.flicker_fraction = Some(camera.flicker_fraction);
        spec.full_well = camera.full_well;
        spec.readout = Some(camera.readout);
        spec.frames = Some(camera.frames);
        spec.field_of_view_rad = camera.field_of_view_rad;
        spec.pixels = camera.pixels;
    }
}

impl Study {
    /// Whether a nuisance is among the unknowns.
    pub(super) fn is_unknown(&self, nuisance: Nuisance) -> bool {
        self.unknowns.contains(nuisance)
    }
}
