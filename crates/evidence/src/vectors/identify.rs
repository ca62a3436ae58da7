//! Whole scenarios as files, with what `hadar identify SCENARIO --json` must say of them.
//!
//! Nothing of the product reads or computes here: scenario and spectra are written from the numbers that the answers come from.

mod scenario;

use self::scenario::{Asked, BANDS_CM1, COAT, Demand, GLASS, METAL, SAND, SKY, file_of, spectrum};
use super::answer::{Answer, Vector};
use super::counts::{camera, netd};
use super::json::Json;
use super::local::{self, Local};
use super::nearest::{FOUND, Nearest, PLACED, nearest};
use super::probability::{self, needed_for};
use super::requirement::counting;
use super::scene::{Object, Scene, black, coat, metal, sky};
use super::topic::Topic;
use crate::reference::Extended;
use crate::reference::camera::Place;
use crate::reference::local::LocalReference;
use hadar::error::Result;
use hadar::fisher::Nuisance;
use hadar::instrument::{Camera, NoiseSpec};
use hadar::spectrum::Bands;

pub(super) fn topic() -> Result<Topic> {
    let [start, stop, step] = BANDS_CM1;
    let bands = Bands::uniform(start, stop, step)?;
    let base = Scene::of(coat, metal)?.seen_in(bands, coat, metal);
    let both = base.not_knowing([Nuisance::Temperature, Nuisance::Lighting]);
    let quiet = camera()?;
    let bolometer = Camera { noise: netd(0.05, &quiet), frames: 4, ..quiet.clone() };
    let asked = [
        Asked {
            id: "person-or-robot",
            about: "a person in a coat, a robot of metal or of glass; a bolometer at 30 m",
            target: COAT,
            alternatives: vec![METAL, GLASS],
            scene: both.clone(),
            celsius: true,
            distance_m: Some(30.0),
            camera: Some(bolometer),
            demand: Demand::Distance(1.0),
        },
        Asked {
            id: "under-a-sky",
            about: "two objects around, one of them no blackbody, whose lighting adds up to 1; no camera; a reliability",
            target: SAND,
            alternatives: vec![GLASS],
            scene: Scene {
                objects: vec![
                    Object { temperature_k: 265.0, lighting: 0.55, material: Some(sky) },
                    black(290.0, 0.45),
                ],
                temperature_k: 315.0,
                lighting_total: Some(1.0),
                ..both.clone()
            },
            celsius: false,
            distance_m: None,
            camera: None,
            demand: Demand::Probability(0.99),
        },
        Asked {
            id: "near-equilibrium",
            about: "a thousandth of a kelvin and of the lighting from equilibrium; noise in counts, with flicker",
            target: COAT,
            alternatives: vec![SAND],
            scene: Scene { temperature_k: 293.151, objects: vec![black(293.15, 0.999)], ..both.clone() },
            celsius: false,
            distance_m: Some(5.0),
            camera: Some(Camera {
                noise: NoiseSpec::Counts { sigma_counts: 5000.0 },
                flicker_fraction: 0.4,
                exposure_s: 0.036,
                ..quiet
            }),
            demand: Demand::Distance(2.0),
        },
        Asked {
            id: "equilibrium",
            about: "everything at one temperature, lit all around: nothing tells anything apart",
            target: COAT,
            alternatives: vec![SAND],
            scene: Scene { temperature_k: 293.15, objects: vec![black(293.15, 1.0)], ..both },
            celsius: false,
            distance_m: None,
            camera: None,
            demand: Demand::Distance(1.0),
        },
    ];
    let mut files: Vec<(String, String)> = asked.iter().map(|asked| (asked.file(), asked.toml())).collect();
    files.extend([COAT, METAL, GLASS, SAND, SKY].map(|(name, material)| (file_of(name), spectrum(material))));
    Ok(Topic {
        name: "identify",
        title: "Scenarios, and what `hadar identify SCENARIO --json` says of them",
        catches: "what is between a file and the formulas: units, defaults, spectra taken at other wavenumbers, a requirement read as \
                  another, the wrong alternative; and the whole chain from spectra to probabilities",
        vectors: asked.iter().map(Asked::vector).collect::<Result<_>>()?,
        files,
    })
}

impl Asked {
    fn vector(&self) -> Result<Vector> {
        let mut answers = Vec::new();
        for (pair, (_, alternative)) in self.alternatives.iter().enumerate() {
            let scene = self.scene.clone();
            let bands = scene.bands.clone();
            let scene = scene.seen_in(bands, self.target.1, *alternative);
            answers.extend(self.of_pair(pair, &scene)?);
        }
        let inputs = Json::object([
            ("scenario", self.file().as_str().into()),
            ("command", format!("hadar identify {} --json", self.file()).as_str().into()),
        ]);
        Ok(Vector { id: self.id, about: self.about, inputs, answers })
    }

    fn of_pair(&self, pair: usize, scene: &Scene) -> Result<Vec<(String, Answer)>> {
        let (surroundings, state) = (scene.surroundings()?, scene.state());
        let signal =
            LocalReference::new(&scene.bands, &surroundings, scene.unknowns()?).signal(&scene.target, &state);
        let radiance: Extended = signal.iter().cloned().sum();
        let required = match self.demand {
            Demand::Distance(distance) => distance,
            Demand::Probability(probability) => needed_for(probability),
        };
        let mut answers = Vec::new();
        if pair == 0 {
            answers.push(("/photon_radiance".to_owned(), Answer::one(&radiance, scene.reach())));
        }
        let mut push = |key: &str, answer: Answer| answers.push((format!("/pairs/{pair}/{key}"), answer));
        let photons = |distance: &Extended, reach: f64| match distance.is_zero() {
            true => Answer::none(),
            false => Answer::double((Extended::from(required) / distance).square().to_f64(), 2.0 * reach),
        };
        let found = local::found(scene)?;
        push("status", Answer::text(found.status));
        push("distance_no_nuisance", found.answer_no_nuisance());
        push("distance_local", found.answer());
        push("photons_required_by/local", photons(&found.distance, found.reach));
        let mut unknown = scene.unknown.clone();
        unknown.push(Nuisance::Gain);
        let with_gain: Local = local::found(&Scene { unknown, ..scene.clone() })?;
        push("distance_local_unknown_gain", with_gain.answer());
        push("photons_required_by/local_unknown_gain", photons(&with_gain.distance, with_gain.reach));
        let least = nearest(scene)?;
        push("distance_nearest", least.answer());
        push("photons_required", photons(&least.distance, least.reach));
        if least.distance.is_zero() {
            return Ok(answers);
        }
        push("nearest_state/temperature_k", Answer::double(least.state.temperature_k, PLACED));
        push("nearest_state/lighting", Answer::doubles(&least.state.lighting, PLACED).or_within(PLACED));
        push("distance_return", returned(scene, &least, &radiance)?);
        if let Some(camera) = &self.camera {
            let place = Place { distance_m: self.distance_m, size_m: None };
            let counting = counting(camera, scene, &signal, place)?;
            let d = nearest(&Scene { counting: Some(counting), ..scene.clone() })?;
            push("statistical_distance", Answer::double(d.distance.to_f64(), d.reach));
            // An error of d is one of d² or less in any of them.
            let d = d.distance.to_f64();
            for (name, value) in probability::of(d) {
                let key = match name {
                    "error_lower" => "error_bracket/lower",
                    "error_upper" => "error_bracket/upper",
                    name => name,
                };
                push(key, Answer::double(value.to_f64(), FOUND * (10.0 + d * d)));
            }
        }
        Ok(answers)
    }
}

/// From the nearest state back to the target's own material, per √photon of the target.
fn returned(scene: &Scene, least: &Nearest, radiance: &Extended) -> Result<Answer> {
    let mut back = Scene {
        target: scene.alternative.clone(),
        alternative: scene.target.clone(),
        temperature_k: least.state.temperature_k,
        gain: least.state.gain,
        ..scene.clone()
    };
    for (object, lighting) in back.objects.iter_mut().zip(&least.state.lighting) {
        object.lighting = *lighting;
    }
    let (surroundings, state) = (back.surroundings()?, back.state());
    let signal =
        LocalReference::new(&back.bands, &surroundings, back.unknowns()?).signal(&back.target, &state);
    let share = (signal.into_iter().sum::<Extended>() / radiance).sqrt();
    let distance = nearest(&back)?.distance * share;
    // It depends on the state that it sets out from.
    Ok(Answer::double(distance.to_f64(), PLACED))
}
