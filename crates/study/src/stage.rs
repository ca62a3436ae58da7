//! A scene as it is rendered: what the scenario names looked up, the camera before it.
//!
//! A spectral sky is a surface of the highest brightness temperature T of its radiance L, with e(ν) = L(ν)/B(ν, T) ≤ 1.

use super::heat_cube::spectrum;
use hadar::error::{Error, Place, Result};
use hadar::instrument::Camera;
use hadar::material::Library;
use hadar::planck;
use hadar::spectrum::Bands;
use hadar_scenario::MaterialRef;
use hadar_scenario::scene::{Form, ObjectSpec, SceneSpec, SkySpec, SurfaceSpec};
use hadar_simulate::render::{
    Body, Bump, Emissivity, Object, Options, Rig, Road, Scene, StreetSpec, Surface, Texture, Uneven,
};

/// Samples of a rendered view that are held at a time, four times over; a pixel takes as much as so many beside its own.
const MOST_SAMPLES: f64 = 2e8;
const SAMPLES_OF_PIXEL: usize = 32;
/// Size of what is warmer or cooler on a surface, m.
const PATCHES_M: f64 = 0.3;
/// Size of the bumps of a rough surface, m.
const BUMPS_M: f64 = 0.1;
/// Height of a person or robot, m.
const HEIGHT_M: f64 = 1.75;

/// The scene, and of what its surfaces are.
pub(super) struct Staged {
    pub(super) scene: Scene,
    /// Name of the material of each surface's two emissivities; none of the sky.
    pub(super) materials: Vec<[Option<String>; 2]>,
    /// Further materials that a decomposition chooses from.
    pub(super) further: Vec<(String, Emissivity)>,
}

type At<'a> = &'a dyn Fn(&str) -> Place;

/// The scene of a scenario.
pub(super) fn staged(spec: &SceneSpec, bands: &Bands, library: &Library, place: At<'_>) -> Result<Staged> {
    let found = |key: &str, material: &MaterialRef| -> Result<Emissivity> {
        let nodes = bands.nodes_cm1();
        let emissivity = match material {
            MaterialRef::Name(name) => library.get(name).and_then(|found| found.emissivity(nodes)),
            MaterialRef::File(path) => {
                hadar_formats::spectra::material(path).and_then(|read| read.emissivity(nodes))
            }
        };
        Ok(Emissivity::Spectrum(emissivity.map_err(|error| error.at(place(key)))?))
    };
    let street = street(spec, &found)?;
    let (mut sky, mut ground) = (street.sky(), street.ground());
    let mut of_ground = ["road, texture 0", "road, texture 1"].map(|name| Some(name.to_owned()));
    if let Some(spec) = &spec.sky {
        sky = heaven(spec, bands, &found).map_err(|error| error.at(place("scene.sky")))?;
    }
    if let Some(spec) = &spec.ground {
        ground = surface("ground", &spec.surface, "scene.ground", 0, &found)?;
        of_ground = [Some(name(&spec.surface.material)), Some(name(&spec.surface.material))];
        if let Some(marks) = &spec.marks {
            ground.emissivity[1] = found("scene.ground.marks", marks)?;
            ground.texture =
                Texture::Road(Road { asphalt: 0.0, contrast: 0.0, mark: 1.0, ..Road::default() });
            of_ground[1] = Some(name(marks));
        }
    }
    let mut materials = vec![[None, None], of_ground];
    let mut scene = Scene::new(sky, ground).map_err(|error| error.at(place("scene")))?;
    match &spec.objects {
        None => {
            for object in street.objects() {
                let tyres = matches!(object.body, Body::Car { .. }).then(|| "tyres".to_owned());
                for own in std::iter::once(object.surface.name.clone()).chain(tyres) {
                    materials.push([Some(own.clone()), Some(own)]);
                }
                scene.add(object).map_err(|error| error.at(place("scene")))?;
            }
        }
        Some(objects) => {
            for (i, spec) in objects.iter().enumerate() {
                let key = format!("object[{i}]");
                let object = object(spec, &key, i, &found)?;
                let tyres = match &spec.form {
                    Form::Car(_, tyres) => Some(name(&tyres.as_ref().unwrap_or(&spec.surface).material)),
                    _ => None,
                };
                for own in std::iter::once(name(&spec.surface.material)).chain(tyres) {
                    materials.push([Some(own.clone()), Some(own)]);
                }
                scene.add(object).map_err(|error| error.at(place(&key)))?;
            }
        }
    }
    let further = spec.library.iter().flatten().enumerate();
    let further = further.map(|(i, own)| Ok((name(own), found(&format!("scene.library[{i}]"), own)?)));
    Ok(Staged { scene, materials, further: further.collect::<Result<_>>()? })
}

/// The camera before a scene.
pub(super) fn rig(
    spec: &SceneSpec,
    camera: &Camera,
    baseline_m: f64,
    bands: &Bands,
    place: At<'_>,
) -> Result<Rig> {
    let default = Rig::default();
    let rig = Rig {
        baseline_m,
        focal_length_m: camera.focal_length_m,
        pixel_m: camera.pixel_m,
        rows: spec.size.map_or(default.rows, |size| size[0]),
        columns: spec.size.map_or(default.columns, |size| size[1]),
        height_m: spec.camera_height_m.unwrap_or(default.height_m),
        pitch_rad: spec.camera_pitch_rad.unwrap_or(default.pitch_rad),
    };
    let at_scene = |error: Error| error.at(place("scene"));
    let samples = rig.rows as f64 * rig.columns as f64 * (bands.len() + SAMPLES_OF_PIXEL) as f64;
    if samples > MOST_SAMPLES {
        let found = format!("{} x {} pixels in {} bands", rig.rows, rig.columns, bands.len());
        let instead = format!(
            "lower scene.size or the number of bands: {:.0e} pixels fit into memory",
            MOST_SAMPLES / (bands.len() + SAMPLES_OF_PIXEL) as f64
        );
        return Err(at_scene(Error::malformed(found, instead)));
    }
    rig.checked().map_err(at_scene)
}

/// How it is drawn.
pub(super) fn options(spec: &SceneSpec) -> Options {
    let default = Options::default();
    Options { bounces: spec.bounces.map_or(default.bounces, |bounces| bounces as usize), ..default }
}

type Found<'a> = &'a dyn Fn(&str, &MaterialRef) -> Result<Emissivity>;

/// The built-in street with the figures that the scenario changes.
fn street(spec: &SceneSpec, found: Found<'_>) -> Result<StreetSpec> {
    let mut street = StreetSpec::default();
    let set = |to: &mut f64, from: Option<f64>| *to = from.unwrap_or(*to);
    set(&mut street.ground_k, spec.ground_temperature_k);
    set(&mut street.sky_k, spec.sky_temperature_k);
    set(&mut street.car_k, spec.car_temperature_k);
    set(&mut street.person_k, spec.person_temperature_k);
    set(&mut street.car_at_m[1], spec.car_distance_m);
    set(&mut street.person_at_m[1], spec.person_distance_m);
    if let Some(ends) = spec.ground_emissivity {
        street.ground_emissivity = ends.map(Emissivity::Constant);
    }
    if let Some(material) = &spec.car {
        street.car_emissivity = found("scene.car", material)?;
    }
    if let Some(material) = &spec.person {
        street.person_emissivity = found("scene.person", material)?;
    }
    Ok(street)
}

/// The name of a material: its own, or that of its file.
fn name(material: &MaterialRef) -> String {
    match material {
        MaterialRef::Name(name) => name.clone(),
        MaterialRef::File(path) => {
            path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned())
        }
    }
}

fn heaven(spec: &SkySpec, bands: &Bands, found: Found<'_>) -> Result<Surface> {
    let nodes = bands.nodes_cm1();
    match spec {
        SkySpec::Surface { material: None, temperature_k } => {
            Ok(Surface::plain("sky", *temperature_k, &Emissivity::Constant(1.0)))
        }
        SkySpec::Surface { material: Some(material), temperature_k } => {
            Ok(Surface::plain("sky", *temperature_k, &found("scene.sky.material", material)?))
        }
        SkySpec::Spectrum { path, column } => {
            let radiance = spectrum(path, column, nodes)?;
            let brightness =
                nodes.iter().zip(&radiance).map(|(nu, l)| planck::brightness_temperature(*nu, *l));
            let temperature_k = brightness.fold(0.0, f64::max) * (1.0 + 1e-12);
            let emissivity = nodes.iter().zip(&radiance).map(|(nu, l)| {
                let share = l / planck::photon_radiance(*nu, temperature_k);
                if share.is_finite() { share.min(1.0) } else { 0.0 }
            });
            Ok(Surface::plain("sky", temperature_k, &Emissivity::Spectrum(emissivity.collect())))
        }
    }
}

fn surface(name: &str, spec: &SurfaceSpec, key: &str, seed: u32, found: Found<'_>) -> Result<Surface> {
    let mut surface =
        Surface::plain(name, spec.temperature_k, &found(&format!("{key}.material"), &spec.material)?);
    surface.uneven = (spec.variation_k > 0.0).then(|| Uneven {
        sigma_k: spec.variation_k,
        size_m: spec.variation_size_m.unwrap_or(PATCHES_M),
        seed: 101 + seed,
    });
    surface.bump = (spec.roughness > 0.0).then(|| Bump {
        size_m: spec.roughness_size_m.unwrap_or(BUMPS_M),
        slope: spec.roughness,
        seed: 11 + seed,
    });
    Ok(surface)
}

fn object(spec: &ObjectSpec, key: &str, place: usize, found: Found<'_>) -> Result<Object> {
    let seed = u32::try_from(place + 1).unwrap_or(1);
    let own = spec.name.clone().unwrap_or_else(|| spec.form.name().to_owned());
    let body = match &spec.form {
        Form::Person(height) => Body::Person { height_m: height.unwrap_or(HEIGHT_M) },
        Form::Robot(height) => Body::Robot { height_m: height.unwrap_or(HEIGHT_M) },
        Form::Car(size, tyres) => {
            let (spec, key) = match tyres {
                Some(tyres) => (tyres, format!("{key}.tyres")),
                None => (&spec.surface, key.to_owned()),
            };
            let size_m = size.unwrap_or(StreetSpec::default().car_size_m);
            Body::Car {
                size_m,
                tyres: Box::new(surface(&format!("tyres of {own}"), spec, &key, seed, found)?),
            }
        }
        Form::Block(size_m) => Body::Block { size_m: *size_m },
        Form::Post([height_m, radius_m]) => Body::Post { height_m: *height_m, radius_m: *radius_m },
        Form::Ball(size_m, above_m) => Body::Ball { size_m: *size_m, above_m: *above_m },
    };
    Ok(Object { surface: surface(&own, &spec.surface, key, seed, found)?, at_m: spec.at_m, body })
}
