//! Local distances: one for every set of unknowns, and those that cancel, vanish or are nearly lost.

use super::answer::{Answer, Vector};
use super::json::Json;
use super::scene::{Material, Object, Scene, black, coat, glass, metal, sand, sky};
use super::topic::Topic;
use crate::reference::Extended;
use crate::reference::local::LocalReference;
use hadar::error::Result;
use hadar::fisher::{Counting, Nuisance};
use hadar::spectrum::Bands;

use Nuisance::{EnvironmentTemperature, Gain, Lighting, Temperature};

/// What a distance of nothing may be: of distances with no nuisance up to 1, the rounding of each term.
const NOTHING: f64 = 1e-13;

pub(super) fn topic() -> Result<Topic> {
    let base = Scene::of(coat, metal)?;
    let vectors = unknowns(&base)?.into_iter().chain(hard(&base)?);
    Ok(Topic {
        name: "local",
        title: "Local distances of two materials",
        catches: "a factor 2 or a root in the distance, weights that are not 1/(S + variance), a nuisance that is not projected away or \
                  one that should not be, gain as a parameter instead of its logarithm, a total of the lighting that is not \
                  kept, a prior that does not compete with the photons; an inverted matrix where unknowns are nearly \
                  dependent; a contrast by subtraction near equilibrium; pseudo-inverses that give a distance where there is none",
        vectors: vectors.map(|(id, about, scene)| vector(id, about, &scene)).collect::<Result<_>>()?,
        files: Vec::new(),
    })
}

type Asked = (&'static str, &'static str, Scene);

fn unknowns(base: &Scene) -> Result<Vec<Asked>> {
    let two = vec![Object { temperature_k: 265.0, lighting: 0.4, material: Some(sky) }, black(295.0, 0.35)];
    let scene = |materials: [Material; 2]| Scene::of(materials[0], materials[1]);
    Ok(vec![
        ("all-known", "nothing unknown but the material", base.clone()),
        ("temperature", "one nuisance", base.clone().not_knowing([Temperature])),
        ("lighting", "one nuisance", base.clone().not_knowing([Lighting])),
        (
            "temperature-lighting",
            "the paper's calibrated camera",
            base.clone().not_knowing([Temperature, Lighting]),
        ),
        ("gain", "the paper's normalised form", base.clone().not_knowing([Temperature, Lighting, Gain])),
        ("everything", "the temperature of the surroundings too", base.clone().not_knowing(Nuisance::ALL)),
        (
            "two-objects",
            "a lighting factor for each of two objects, one of them no blackbody",
            Scene { objects: two.clone(), ..scene([sand, glass])?.not_knowing([Temperature, Lighting]) },
        ),
        (
            "total-known",
            "the same with the sum of the factors known",
            Scene {
                objects: two,
                lighting_total: Some(0.75),
                ..scene([sand, glass])?.not_knowing([Temperature, Lighting])
            },
        ),
        (
            "priors",
            "priors compete with 1e5 photons; that of gain is one of its logarithm",
            Scene {
                priors: vec![(Temperature, 0.5), (Lighting, 0.02), (Gain, 0.01)],
                photons: Some(1e5),
                gain: 0.8,
                ..base.clone().not_knowing([Temperature, Lighting, Gain])
            },
        ),
        (
            "even-noise",
            "2e10 photons with noise of 1e12 counts^2 in every band",
            Scene {
                counting: Some(Counting { counts_per_radiance: 6e-12, var_added: vec![1e12; 20] }),
                ..base.clone().not_knowing([Temperature, Lighting])
            },
        ),
        (
            "uneven-noise",
            "noise that differs from band to band, and a prior",
            Scene {
                counting: Some(Counting {
                    counts_per_radiance: 3e-15,
                    var_added: (1..21).map(|i| f64::from(i * i) * 4096.0).collect(),
                }),
                priors: vec![(Temperature, 2.0)],
                ..base.clone().not_knowing([Temperature, Lighting])
            },
        ),
    ])
}

fn hard(base: &Scene) -> Result<Vec<Asked>> {
    let last_bit = f64::from_bits(293.15_f64.to_bits() + 1);
    let both = |scene: &Scene| scene.clone().not_knowing([Temperature, Lighting]);
    let nearly: Vec<f64> =
        base.target.iter().zip(&base.alternative).map(|(e, other)| e + (other - e) * 1e-9).collect();
    let grey = |e: f64| vec![e; base.target.len()];
    let one_band = Bands::from_rows([(1000.0, 50.0)])?;
    Ok(vec![
        (
            "near-equilibrium",
            "T - T0 = 1e-5 K, V = 1 - 1e-6",
            Scene {
                temperature_k: 293.150_01,
                objects: vec![black(293.15, 0.999_999)],
                ..both(&Scene::of(coat, sand)?)
            },
        ),
        (
            "last-bit",
            "T and T0 differ in their last bit, V = 1: contrasts of 1e-16 of the signal",
            Scene {
                temperature_k: last_bit,
                objects: vec![black(293.15, 1.0)],
                ..both(&Scene::of(coat, sand)?)
            },
        ),
        (
            "equilibrium",
            "T = T0, V = 1: nothing tells any materials apart",
            Scene {
                temperature_k: 293.15,
                objects: vec![black(293.15, 1.0)],
                ..both(&Scene::of(coat, sand)?)
            },
        ),
        (
            "nearly-equal",
            "emissivities that differ by 1e-9 of their difference",
            Scene { alternative: nearly, ..both(base) },
        ),
        ("identical", "the same emissivity twice", Scene { alternative: base.target.clone(), ..both(base) }),
        (
            "blind",
            "grey bodies in deep space: an unknown gain imitates the material",
            Scene {
                objects: Vec::new(),
                target: grey(0.5),
                alternative: grey(0.25),
                ..base.clone().not_knowing([Gain])
            },
        ),
        (
            "one-band",
            "a single band, nothing unknown: half |e' - e| |C| over S",
            base.clone().seen_in(one_band, coat, metal),
        ),
        (
            "nearly-dependent",
            "two black objects 1 mK apart, both factors unknown",
            Scene {
                objects: vec![black(293.151, 0.3), black(293.15, 0.3)],
                ..both(&Scene::of(sand, glass)?)
            },
        ),
        (
            "faint-lighting",
            "V = 1e-12, unknown like the temperature around",
            Scene {
                objects: vec![black(293.15, 1e-12)],
                ..Scene::of(sand, glass)?.not_knowing([Temperature, Lighting, EnvironmentTemperature])
            },
        ),
    ])
}

/// Local distances of a scene.
#[derive(Debug)]
pub(super) struct Local {
    pub(super) distance: Extended,
    distance_no_nuisance: Extended,
    pub(super) status: &'static str,
    /// What doubles can do, as a share of the distance.
    pub(super) reach: f64,
    reach_no_nuisance: f64,
}

pub(super) fn found(scene: &Scene) -> Result<Local> {
    let (surroundings, state) = (scene.surroundings()?, scene.state());
    let mut reference = LocalReference::new(&scene.bands, &surroundings, scene.unknowns()?);
    let found = reference.answer(scene.pair(&state), scene.noise(), &[]);
    let status = if scene.target == scene.alternative {
        "identical"
    } else if found.distance_no_nuisance.is_zero() {
        "equilibrium"
    } else if found.distance.is_zero() {
        "blind"
    } else {
        "ok"
    };
    let reach = |terms: &Extended, sum: &Extended| {
        scene.reach() * if sum.is_zero() { 1.0 } else { (terms / sum).to_f64().max(1.0) }
    };
    Ok(Local {
        status,
        reach: reach(&(&found.terms + &found.carried), &found.distance),
        reach_no_nuisance: reach(&found.terms, &found.distance_no_nuisance),
        distance: found.distance,
        distance_no_nuisance: found.distance_no_nuisance,
    })
}

impl Local {
    pub(super) fn answer(&self) -> Answer {
        answer(&self.distance, self.reach)
    }

    pub(super) fn answer_no_nuisance(&self) -> Answer {
        answer(&self.distance_no_nuisance, self.reach_no_nuisance)
    }
}

fn answer(distance: &Extended, reach: f64) -> Answer {
    let answer = Answer::one(distance, reach);
    if distance.is_zero() { answer.or_within(NOTHING) } else { answer }
}

fn vector(id: &'static str, about: &'static str, scene: &Scene) -> Result<Vector> {
    let found = found(scene)?;
    let answers = [
        ("status", Answer::text(found.status)),
        ("distance", found.answer()),
        ("distance_no_nuisance", found.answer_no_nuisance()),
    ];
    Ok(Vector::new(id, about, Json::Object(scene.asked()), answers))
}
