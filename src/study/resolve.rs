//! Names and files of a scenario looked up: materials on the nodes of the bands, surroundings, camera.

use super::Warning;
use crate::error::{Error, Result};
use crate::fisher::{Nuisance, Unknowns};
use crate::identifiability::detection;
use crate::identifiability::nearest::StateRange;
use crate::instrument::{Camera, NoiseSpec, presets};
use crate::material::{Library, Material};
use crate::scenario::{BandSource, CameraSpec, MaterialRef, Reliability, Scenario};
use crate::scene::{EnvironmentObject, State, Surroundings};
use crate::spectrum::Bands;
use crate::units::Spectral;
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
        let bands = centre_bands(&scenario)?;
        let alternatives = finder.alternatives(&target, &bands)?;
        let warnings = finder.warnings;

        let mut everything: Vec<&Material> = alternatives.iter().map(AsRef::as_ref).collect();
        everything.push(target.as_ref());
        everything.extend(environment.iter().flatten().map(AsRef::as_ref));
        let bands = integrated(&scenario, bands, &everything, &target, &alternatives)?;

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
        let camera = scenario.camera.as_ref().map(|spec| camera(spec, &scenario)).transpose()?;
        let required = match scenario.requirement.reliability {
            Reliability::Distance(distance) => distance,
            Reliability::DetectionProbability(probability) => {
                detection::distance_for_probability(probability)
                    .map_err(|error| error.at(scenario.place("requirement.detection_probability")))?
            }
        };
        let unknowns = unknowns(&scenario).map_err(|error| error.at(scenario.place("unknown")))?;
        let range = state_range(&scenario);
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

    /// The alternatives named, or every other surface of the library that covers the bands.
    fn alternatives(&mut self, target: &Material, bands: &Bands) -> Result<Vec<Cow<'a, Material>>> {
        let wanted = &self.scenario.alternatives;
        if let Some(materials) = &wanted.materials {
            let found = materials.iter().enumerate().map(|(i, material)| {
                self.find(&format!("alternatives.materials[{i}]"), material, wanted.extrapolate)
            });
            return found.collect();
        }
        let (low, high) = bands.range_cm1();
        let mut found = Vec::new();
        for material in self.library.iter() {
            if material.name() == target.name() || !is_surface(material) {
                continue;
            }
            let covers = material.range_cm1().is_none_or(|(first, last)| first <= low && last >= high);
            if covers || wanted.extrapolate.is_some() {
                let material = self.accept(Cow::Borrowed(material), wanted.extrapolate);
                found.push(material);
            } else {
                let message =
                    format!("{} is left out: its spectrum does not cover the bands", material.name());
                self.warnings.push(Warning::new("material-skipped", message));
            }
        }
        if found.is_empty() {
            return Err(Error::malformed(
                "no material of the library covers the bands",
                "name alternatives.materials",
            )
            .at(self.scenario.place("alternatives")));
        }
        Ok(found)
    }
}

/// Skies are surroundings, not something a target could be made of.
fn is_surface(material: &Material) -> bool {
    !material.name().starts_with("sky-") && material.name() != "sky"
}

fn alternatives_as_written(alternatives: &[Surface]) -> Vec<String> {
    alternatives.iter().map(|surface| surface.name.clone()).collect()
}

/// The bands of the scenario as the paper samples them: at band centres.
fn centre_bands(scenario: &Scenario) -> Result<Bands> {
    let made = match &scenario.bands.source {
        BandSource::Grid { start, stop, step } => match (start, stop, step) {
            (Spectral::Wavelength(start), Spectral::Wavelength(stop), Spectral::Wavelength(step)) => {
                Bands::uniform_wavelength(*start, *stop, *step)
            }
            _ => Bands::uniform(start.number(), stop.number(), step.number()),
        },
        BandSource::Rows(path) => return Bands::from_rows_file(path),
        BandSource::Filters(path) => return Bands::from_filters_file(path),
        BandSource::Ranges(ranges) => {
            let edges: Vec<(f64, f64)> = ranges
                .iter()
                .map(|[a, b]| (a.wavenumber_cm1(), b.wavenumber_cm1()))
                .map(|(a, b)| (a.min(b), a.max(b)))
                .collect();
            Bands::from_ranges(&edges)
        }
    };
    made.map_err(|error| error.at(scenario.place("bands")))
}

/// The same bands integrating the spectra of target and alternatives, where the scenario asks for it.
fn integrated(
    scenario: &Scenario,
    bands: Bands,
    everything: &[&Material],
    target: &Material,
    alternatives: &[Cow<'_, Material>],
) -> Result<Bands> {
    if !scenario.bands.integrate {
        return Ok(bands);
    }
    let low = bands.bands().iter().map(|band| band.low_cm1).fold(f64::INFINITY, f64::min);
    let high = bands.bands().iter().map(|band| band.high_cm1).fold(0.0, f64::max);
    let kinks: Vec<f64> =
        everything.iter().flat_map(|material| material.breakpoints_cm1(low, high)).collect();
    let environment: Vec<(f64, f64)> =
        scenario.environment.iter().map(|object| (object.temperature_k, object.lighting)).collect();
    let temperature_k = scenario.target.temperature_k;
    bands
        .integrated(&kinks, scenario.bands.tolerance, |nodes| {
            let objects = environment
                .iter()
                .map(|&(temperature_k, _)| EnvironmentObject { temperature_k, emissivity: None })
                .collect();
            let surroundings = Surroundings::new(nodes, objects)?;
            let lighting: Vec<f64> = environment.iter().map(|&(_, lighting)| lighting).collect();
            let state = surroundings.state(temperature_k, &lighting)?;
            std::iter::once(target)
                .chain(alternatives.iter().map(AsRef::as_ref))
                .map(|material| Ok(surroundings.signal(&material.emissivity(nodes)?, &state)))
                .collect()
        })
        .map_err(|error| error.at(scenario.place("bands.integrate")))
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

/// The preset with what the scenario overrides; without a preset everything must be said.
fn camera(spec: &CameraSpec, scenario: &Scenario) -> Result<Camera> {
    let place = |key: &str| scenario.place(&format!("camera.{key}"));
    let preset = match &spec.preset {
        Some(name) => Some(presets::get(name).map_err(|error| error.at(place("preset")))?),
        None => None,
    };
    let need = |key: &'static str, own: Option<f64>, preset: Option<f64>, example: &str| {
        own.or(preset).ok_or_else(|| {
            Error::malformed(
                format!("neither a preset nor camera.{key} is given"),
                format!("write {key} = {example}, or preset = \"flir-a325sc\""),
            )
            .at(place(key))
        })
    };
    let from = preset.as_ref();
    let exposure_s = need("exposure", spec.exposure_s, from.map(|c| c.exposure_s), "\"12 ms\"")?;
    let pixel_m = need("pixel", spec.pixel_m, from.map(|c| c.pixel_m), "\"12 um\"")?;
    let f_number = need("f_number", spec.f_number, from.map(|c| c.f_number), "1.3")?;
    let focal_length_m =
        need("focal_length", spec.focal_length_m, from.map(|c| c.focal_length_m), "\"18 mm\"")?;
    let optics_efficiency = spec.optics_efficiency.or(from.map(|c| c.optics_efficiency)).unwrap_or(1.0);
    let reference_temperature_k = from.map_or(303.15, |c| c.reference_temperature_k);
    let own_noise = if let Some(netd_k) = spec.netd_k {
        Some(NoiseSpec::Netd {
            netd_k,
            temperature_k: spec.netd_temperature_k.unwrap_or(reference_temperature_k),
            f_number: spec.netd_f_number.unwrap_or(f_number),
            optics_efficiency,
            pixel_m,
        })
    } else if let Some(detectivity_cm_hz05_w) = spec.detectivity_cm_hz05_w {
        Some(NoiseSpec::Detectivity { detectivity_cm_hz05_w })
    } else {
        spec.noise_electrons.map(|sigma_counts| NoiseSpec::Counts { sigma_counts })
    };
    for (key, given) in [
        ("netd_temperature", spec.netd_temperature_k.is_some()),
        ("netd_f_number", spec.netd_f_number.is_some()),
    ] {
        if given && spec.netd_k.is_none() {
            return Err(Error::malformed(
                format!("{key} without a netd"),
                "write netd = \"50 mK\" beside it",
            )
            .at(place(key)));
        }
    }
    let noise = match (own_noise, from) {
        (Some(noise), _) => noise,
        (None, Some(preset)) => preset.noise,
        (None, None) => {
            return Err(Error::malformed(
                "the camera's noise is not given",
                "write netd = \"50 mK\", detectivity = \"4.7e10 cm Hz^0.5/W\" or noise_electrons = 0",
            )
            .at(place("netd")));
        }
    };
    let camera = Camera {
        name: spec.preset.clone().unwrap_or_else(|| "camera".into()),
        description: from.map_or_else(String::new, |c| c.description.clone()),
        provenance: from.map_or_else(Vec::new, |c| c.provenance.clone()),
        exposure_s,
        pixel_m,
        f_number,
        focal_length_m,
        optics_efficiency,
        noise,
        // Noise that comes with the preset is stated at the preset's exposure.
        noise_exposure_s: from.filter(|_| own_noise.is_none()).map_or(exposure_s, |c| c.noise_exposure_s),
        flicker_fraction: spec.flicker_fraction.or(from.map(|c| c.flicker_fraction)).unwrap_or(0.0),
        full_well: spec.full_well.or(from.and_then(|c| c.full_well)),
        readout: spec.readout.or(from.map(|c| c.readout)).unwrap_or(crate::instrument::Readout::Simultaneous),
        frames: spec.frames.or(from.map(|c| c.frames)).unwrap_or(1),
        field_of_view_rad: spec.field_of_view_rad.or(from.and_then(|c| c.field_of_view_rad)),
        pixels: spec.pixels.or(from.and_then(|c| c.pixels)),
        reference_temperature_k,
        spectral_range_cm1: from.map_or([715.0, 1250.0], |c| c.spectral_range_cm1),
    };
    camera.checked().map_err(|error| error.at(place("preset")))
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
        // The noise stays the preset's: its NETD is stated under the preset's own conditions.
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
