//! Names and files of a scenario looked up: materials on the nodes of the bands, surroundings, camera.

mod defaults;
mod finder;
mod magnitudes;

use self::defaults::{check_range, fill, state_range, unknowns};
use self::finder::Finder;
use self::magnitudes::check_temperatures;
use super::air::{Air, Behind};
use super::bands::{self, check_detector};
use super::camera::check_time;
use super::classes::Members;
use super::integration::{self, Spectra, integrated};
use super::remembered::Remembered;
use super::{Study, Surface, camera, camera_bands};
use hadar::demand::Skipping;
use hadar::error::{Error, Result};
use hadar::identifiability::detection;
use hadar::instrument::Camera;
use hadar::material::{Library, Material};
use hadar::scene::{EnvironmentObject, Surroundings};
use hadar_scenario::{Reliability, Scenario};
use std::borrow::Cow;

impl Study {
    /// Looks up everything that `scenario` names, materials in `library`.
    ///
    /// # Errors
    /// An unknown material or camera (with the nearest names), a file that cannot be used, a spectrum that
    /// does not cover the bands; each with file, line and key.
    ///
    /// ```
    /// use hadar::material::Library;
    /// use hadar_scenario::Scenario;
    /// use hadar_study::Study;
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
        Self::new_skipping(scenario, library, Skipping::On)
    }

    /// The same, with every pair of members of classes searched in full where nothing is to be skipped.
    ///
    /// # Errors
    /// As [`Study::new`].
    pub fn new_skipping(scenario: &Scenario, library: &Library, skipping: Skipping) -> Result<Self> {
        Self::with_members(scenario, library)?.of_worst_members(skipping)
    }

    /// The same, which shares with other scenarios what it computes.
    ///
    /// # Errors
    /// As [`Study::new`].
    pub fn remembering(
        scenario: &Scenario,
        library: &Library,
        skipping: Skipping,
        remembered: &Remembered,
    ) -> Result<Self> {
        Self::with_members_in(scenario, library, None, Some(remembered))?.of_worst_members(skipping)
    }

    /// The same with all members of classes side by side: those of the target's are [`Study::targets`], the first of which is the
    /// target, and those of the alternatives' are alternatives of their own.
    pub(super) fn with_members(scenario: &Scenario, library: &Library) -> Result<Self> {
        Self::with_members_in(scenario, library, None, None)
    }

    /// The same where filters stand in a cone of light though no camera is there: `sine` is that of the angle of its rim.
    pub(super) fn with_members_in(
        scenario: &Scenario,
        library: &Library,
        sine: Option<f64>,
        remembered: Option<&Remembered>,
    ) -> Result<Self> {
        check_temperatures(scenario)?;
        let mut scenario = scenario.clone();
        let mut finder = Finder::new(&scenario, library);
        finder.check_names()?;
        let target =
            finder.group("target.material", &scenario.target.material, scenario.target.extrapolate)?;
        let (environment, behind) = (finder.environment()?, finder.behind()?);
        let made = scenario.camera.as_ref().map(|spec| camera::resolved_as_stated(spec, &scenario.source));
        let (mut camera, stated) = made.transpose()?.unzip();
        let asked =
            camera_bands::asked(&scenario.bands.source, camera.as_ref().zip(scenario.camera.as_ref()));
        let sine = camera.as_ref().map(Camera::rim_sine).or(sine);
        let bands = bands::seen_by(&asked, &scenario.source, sine)?;
        if let Some(camera) = &mut camera {
            camera.sees(&bands);
        }
        if let (Some(camera), Some(spec)) = (&camera, &scenario.camera) {
            check_detector(&bands, camera, &scenario)?;
            check_time(camera, &scenario)?;
            let place = |key: &str| scenario.place(key);
            finder.warnings.extend(camera_bands::check(camera, spec, &asked, &bands, &place)?);
        }
        let target = finder.covering(target, &bands, scenario.target.extrapolate)?;
        let alternatives = finder.alternatives(&target, &bands)?;
        let Finder { warnings, skies, left_out, .. } = finder;

        let surfaces = std::iter::once(&target).chain(&alternatives).flat_map(|group| &group.members);
        let surfaces: Vec<&Material> = surfaces.map(|(material, _)| material.as_ref()).collect();
        let mut extrapolated: Vec<String> = Vec::new();
        for material in surfaces.iter().filter(|material| !finder::covers(material, &bands, None)) {
            if !extrapolated.iter().any(|known| known == material.name()) {
                extrapolated.push(material.name().to_owned());
            }
        }
        let atmosphere = Air::of(&scenario)?;
        let spectra = Spectra {
            surfaces: &surfaces,
            environment: &environment,
            behind: behind.as_ref().map(|(temperature_k, material)| (*temperature_k, material.as_deref())),
            air: atmosphere.as_ref(),
            camera: camera.as_ref(),
        };
        let wanted = integration::asked(&scenario, &asked);
        let compute = || integrated(&scenario, wanted, &bands, &spectra);
        let found = match remembered {
            Some(remembered) => remembered.integrals(spectra.integrand(&scenario, wanted, &bands), compute),
            None => compute(),
        };
        let (bands, integration, integrals) = found.map_err(|error| {
            let mut groups = std::iter::once(&target).chain(&alternatives);
            groups.find_map(|group| group.short_of(&bands, &scenario)).unwrap_or(error)
        })?;

        let nodes = bands.nodes_cm1();
        let on_nodes = |material: &Material, key: &str| {
            Surface::of(material, nodes).map_err(|error| error.at(scenario.place(key)))
        };
        let surroundings = surroundings(&scenario, &environment, nodes, &on_nodes)?;
        let lighting: Vec<f64> = scenario.environment.iter().map(|object| object.lighting).collect();
        let state = surroundings
            .state(scenario.target.temperature_k, &lighting)
            .map_err(|error| error.at(scenario.place("environment")))?;
        let members = |group: &finder::Group<'_>| {
            let surfaces = group.members.iter().map(|(material, _)| on_nodes(material, &group.key));
            let weights = group.members.iter().map(|(_, weight)| *weight).collect();
            Ok(Members::new(&group.name, group.spec.clone(), surfaces.collect::<Result<_>>()?, weights))
        };
        let target = members(&target)?;
        let groups = alternatives.iter().map(members).collect::<Result<Vec<_>>>()?;
        let alternatives: Vec<Surface> = groups.iter().flat_map(|group| group.surfaces.clone()).collect();
        let behind = behind.map(|of| self::behind(of, nodes, &on_nodes)).transpose()?;
        let required = required(&scenario)?;
        scenario.bands.source = asked;
        let unknowns = unknowns(&scenario).map_err(|error| error.at(scenario.place("unknown")))?;
        let range = state_range(&scenario);
        check_range(&scenario, &range)?;
        let names: Vec<String> = groups.iter().map(|group| group.name.clone()).collect();
        fill(&mut scenario, &names, camera.as_ref().zip(stated.as_ref()), &range);
        let mut study = Self {
            scenario,
            open_bands: bands.clone(),
            bands,
            integration,
            atmosphere,
            air: Vec::new(),
            behind,
            surroundings,
            state,
            unknowns,
            range,
            target: target.surfaces.first().cloned().ok_or_else(no_members)?,
            alternatives,
            members: [vec![target], groups],
            classes: Vec::new(),
            paired: Vec::new(),
            camera,
            tolerance: None,
            required,
            skies,
            left_out,
            extrapolated,
            warnings,
            looked_up: library.work().and(&integrals),
            remembered: remembered.cloned(),
        };
        study.check_sight()?;
        (study.bands, study.air) = study.received(study.camera.as_ref(), study.scenario.target.distance_m)?;
        study.check_magnitudes()?;
        Ok(study)
    }
}

/// What is around the target, at the nodes.
fn surroundings(
    scenario: &Scenario,
    materials: &[Option<Cow<'_, Material>>],
    nodes_cm1: &[f64],
    on_nodes: &dyn Fn(&Material, &str) -> Result<Surface>,
) -> Result<Surroundings> {
    let objects = scenario.environment.iter().zip(materials).enumerate().map(|(k, (object, material))| {
        let key = format!("environment[{k}].material");
        let surface = material.as_ref().map(|material| on_nodes(material, &key)).transpose()?;
        let emissivity = surface.map(|surface| surface.emissivity);
        Ok(EnvironmentObject { temperature_k: object.temperature_k, emissivity })
    });
    Surroundings::new(nodes_cm1, objects.collect::<Result<_>>()?)
}

/// What is behind the target, at the nodes; a blackbody where it has no material.
fn behind(
    (temperature_k, material): (f64, Option<Cow<'_, Material>>),
    nodes_cm1: &[f64],
    on_nodes: &dyn Fn(&Material, &str) -> Result<Surface>,
) -> Result<Behind> {
    let surface = match &material {
        Some(material) => on_nodes(material, "background.material")?,
        None => Surface::of(&Material::constant("blackbody", 1.0)?, nodes_cm1)?,
    };
    Ok(Behind { surface, temperature_k })
}

/// The statistical distance that is asked for.
pub(super) fn required(scenario: &Scenario) -> Result<f64> {
    let (distance, key) = match scenario.requirement.reliability {
        Reliability::Distance(distance) => return Ok(distance),
        Reliability::DetectionProbability(probability) => {
            (detection::distance_for_probability(probability), "requirement.detection_probability")
        }
        Reliability::Rates { detection, false_alarm } => {
            (detection::distance_for_rates(detection, false_alarm), "requirement.false_alarm_probability")
        }
    };
    distance.map_err(|error| error.at(scenario.place(key)))
}

fn no_members() -> Error {
    Error::malformed("the class has no members", "write materials = [\"my_skin.csv\"]")
}
