//! Nearest distances with the state that they belong to.
//!
//! The brute force finds the state: a lattice of temperatures, the convex problem of gain and lighting at each. Newton's method
//! in 512 bits then stands at the bottom of that valley, of the target's own state's, and of some others', which is all
//! there is where priors count.

use super::answer::{Answer, Vector};
use super::json::Json;
use super::scene::{Object, Scene, black, coat, glass, metal, sand, sky};
use super::topic::Topic;
use crate::reference::Extended;
use crate::reference::brute_force::BruteForce;
use crate::reference::double_double::Real;
use crate::reference::nearest::NearestReference;
use hadar::error::{Error, Result};
use hadar::fisher::{Counting, Nuisance};
use hadar::identifiability::nearest::StateRange;
use hadar::scene::State;
use hadar::spectrum::Bands;
use rayon::prelude::*;

use Nuisance::{EnvironmentTemperature, Gain, Lighting, Temperature};

/// To what share of itself the least distance has to be found: it is stationary in the state.
pub(super) const FOUND: f64 = 1e-9;
/// The state, which is only as well known as the root of that.
pub(super) const PLACED: f64 = 2e-5;
/// Share of the separation at the target's own state below which there is no distance.
const VANISHING: f64 = 1e-25;
/// How nearly the two searches of the reference agree: a share of the distance, which may be rounding of the separation at the
/// target's own state.
const AGREED: f64 = 1e-14;
const ROUNDED: f64 = 1e-28;
/// What the roots of shares of one photon are good for in doubles.
const ROUNDING: f64 = 1e-15;
/// What a search in doubles makes of no distance.
const SOUGHT: f64 = 1e-8;
/// Temperatures of further starts, K.
const STARTS_K: [f64; 5] = [150.0, 260.0, 300.0, 350.0, 600.0];

/// The nearest state of a scene.
#[derive(Debug)]
pub(super) struct Nearest {
    pub(super) distance: Extended,
    pub(super) state: State,
    /// What doubles can do, as a share of the distance.
    pub(super) reach: f64,
}

pub(super) fn topic() -> Result<Topic> {
    let vectors = asked()?.into_par_iter().map(|(id, about, scene)| vector(id, about, &scene));
    Ok(Topic {
        name: "nearest",
        title: "Nearest distances, and the states they belong to",
        catches: "a search that ends in the wrong valley, leaves the physical range or does not reach its edge, loses a constraint on \
                  the sum of the lighting, or moves what is known; counts normalised by the alternative's photons instead of \
                  the target's; noise in one of the two roots only; differences of roots where materials are nearly equal",
        vectors: vectors.collect::<Result<_>>()?,
        files: Vec::new(),
    })
}

fn asked() -> Result<Vec<(&'static str, &'static str, Scene)>> {
    let base = Scene::of(coat, metal)?;
    let both = base.clone().not_knowing([Temperature, Lighting]);
    let other = Scene::of(glass, sand)?.not_knowing([Temperature, Lighting]);
    let two = vec![Object { temperature_k: 265.0, lighting: 0.4, material: Some(sky) }, black(295.0, 0.35)];
    let nearly: Vec<f64> =
        base.target.iter().zip(&base.alternative).map(|(e, other)| e + (other - e) * 1e-6).collect();
    let grey = |e: f64| vec![e; base.target.len()];
    let range = StateRange::default();
    let six = Bands::from_rows((0..6).map(|i| (750.0 + 90.0 * f64::from(i), 50.0)))?;
    Ok(vec![
        ("all-known", "nothing to search: the separation at the target's own state", base.clone()),
        ("temperature", "one unknown", base.clone().not_knowing([Temperature])),
        ("temperature-lighting", "warm metal that looks like a coat", both.clone()),
        (
            "back",
            "the other way round: hot metal and the coat nearest to it",
            Scene {
                temperature_k: 350.0,
                objects: vec![black(293.15, 0.25)],
                ..Scene::of(metal, coat)?.not_knowing([Temperature, Lighting])
            },
        ),
        ("gain", "an unknown gain besides", other.clone().not_knowing([Temperature, Lighting, Gain])),
        (
            "warm-edge",
            "the alternative may be no warmer than 325 K",
            Scene { range: StateRange { temperature_k: [273.15, 325.0], ..range }, ..both.clone() },
        ),
        (
            "two-objects",
            "two lighting factors, one of an object that is no blackbody",
            Scene { objects: two.clone(), ..other.clone() },
        ),
        (
            "sum-at-its-limit",
            "two factors whose sum may not exceed 1",
            Scene {
                objects: vec![
                    Object { temperature_k: 265.0, lighting: 0.55, material: Some(sky) },
                    black(295.0, 0.45),
                ],
                ..other.clone()
            },
        ),
        (
            "total-known",
            "two factors whose sum is known",
            Scene { objects: two, lighting_total: Some(0.75), ..other.clone() },
        ),
        (
            "surroundings",
            "the surroundings' temperature is unknown too",
            other.clone().not_knowing([Temperature, Lighting, EnvironmentTemperature]),
        ),
        (
            "two-valleys",
            "downhill from the target's own state leads to a distance 1.8 times too large",
            Scene {
                target: vec![0.36, 0.4, 0.58, 0.54, 0.83, 0.53],
                alternative: vec![0.94, 0.61, 0.63, 0.47, 0.2, 0.81],
                bands: six,
                temperature_k: 310.0,
                objects: vec![black(280.0, 0.21)],
                ..base.clone().not_knowing([Temperature, Gain])
            },
        ),
        (
            "noise",
            "noise in every band: the distance of all counts, not of one photon",
            Scene {
                counting: Some(Counting {
                    counts_per_radiance: 4e-13,
                    var_added: (1..21).map(|i| f64::from(i) * 1e8).collect(),
                }),
                ..both.clone()
            },
        ),
        (
            "priors",
            "priors hold the state back, among 1e5 photons",
            Scene { priors: vec![(Temperature, 3.0), (Lighting, 0.05)], photons: Some(1e5), ..both.clone() },
        ),
        (
            "nearly-equal",
            "emissivities that differ by 1e-6 of their difference: roots differ by 1e-9",
            Scene { alternative: nearly, ..both.clone() },
        ),
        (
            "imitated",
            "twice the gain makes one grey body the other: no distance",
            Scene {
                objects: Vec::new(),
                target: grey(0.5),
                alternative: grey(0.25),
                ..base.not_knowing([Gain])
            },
        ),
        (
            "last-bit",
            "T and T0 differ in their last bit, V = 1: no distance that doubles could tell from none",
            Scene {
                temperature_k: f64::from_bits(293.15_f64.to_bits() + 1),
                objects: vec![black(293.15, 1.0)],
                ..both
            },
        ),
    ])
}

/// The nearest state by both searches of the reference.
///
/// # Errors
/// No state within the range, or two searches that do not agree.
pub(super) fn nearest(scene: &Scene) -> Result<Nearest> {
    let (surroundings, state, unknowns) = (scene.surroundings()?, scene.state(), scene.unknowns()?);
    let (pair, noise) = (scene.pair(&state), scene.noise());
    let none = || Error::malformed("no state of the alternative in its range", "widen the range");
    let force = BruteForce::new(&scene.bands, &surroundings, &unknowns, scene.range);
    let forced = force.nearest(pair, noise).ok_or_else(none)?;
    let [low, high] = scene.range.temperature_k;
    let mut starts = vec![forced.state.clone()];
    if unknowns.has_priors() {
        // The brute force knows none.
        let starts_k = std::iter::once(state.temperature_k).chain(STARTS_K);
        starts
            .extend(starts_k.map(|kelvin| State { temperature_k: kelvin.clamp(low, high), ..state.clone() }));
    }
    let mut reference = NearestReference::new(&scene.bands, &surroundings, unknowns.clone(), scene.range);
    let (distance, state) = reference.nearest_from(pair, &starts, noise).ok_or_else(none)?;
    let own = reference.separation(pair, pair.state, noise).distance;
    let there = reference.separation(pair, &state, noise);
    let vanishing = distance <= &own * Extended::from(VANISHING);
    let distance = if vanishing { Extended::zero() } else { distance };
    let apart = (Extended::from(forced.distance.to_f64()) - &distance).abs();
    let alike =
        &distance * Extended::from(AGREED) + &own * Extended::from(ROUNDED) + Extended::from(VANISHING);
    if !unknowns.has_priors() && apart > alike {
        let found = "two searches of the reference that do not agree";
        return Err(Error::malformed(found, "report this as a bug"));
    }
    let magnified = if vanishing { 1.0 } else { (there.terms / &distance).to_f64().max(1.0) };
    Ok(Nearest { distance, state, reach: FOUND + scene.reach() * magnified })
}

impl Nearest {
    pub(super) fn answer(&self) -> Answer {
        let answer = Answer::one(&self.distance, self.reach);
        // Where it is less than what doubles leave of the roots, none is as good.
        if self.distance < Extended::from(ROUNDING) { answer.or_within(SOUGHT) } else { answer }
    }
}

fn vector(id: &'static str, about: &'static str, scene: &Scene) -> Result<Vector> {
    let found = nearest(scene)?;
    let mut answers = vec![("distance_nearest".to_owned(), found.answer())];
    let is_unknown = |nuisance| scene.unknown.contains(&nuisance);
    let State { temperature_k, lighting, gain, environment_k } = &found.state;
    if is_unknown(Temperature) {
        answers.push(("nearest_temperature_k".into(), Answer::double(*temperature_k, PLACED)));
    }
    if is_unknown(Lighting) {
        answers.push(("nearest_lighting".into(), Answer::doubles(lighting, PLACED).or_within(PLACED)));
    }
    if is_unknown(Gain) {
        answers.push(("nearest_gain".into(), Answer::double(*gain, PLACED)));
    }
    if is_unknown(EnvironmentTemperature) {
        answers.push(("nearest_environment_temperature_k".into(), Answer::doubles(environment_k, PLACED)));
    }
    let mut inputs = scene.asked();
    inputs.push((
        "range".into(),
        Json::object([
            ("temperature_k", scene.range.temperature_k.as_slice().into()),
            ("lighting", scene.range.lighting.as_slice().into()),
            ("lighting_sum", scene.range.lighting_sum.into()),
        ]),
    ));
    Ok(Vector { id, about, inputs: Json::Object(inputs), answers })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vectors::local;
    use hadar_testing::{digits, number, reference_emissivity, reference_pairs};

    /// Distances of 30 digits: a person from a robot, and back. The state of the nearest is a double, its distance stationary.
    #[test]
    fn thirty_digit_distances_are_met() {
        let Some(cases) = reference_pairs() else { return };
        for case in cases.iter().take(2) {
            let (nu, target) = reference_emissivity(&case["target"]);
            let (_, alternative) = reference_emissivity(&case["alternative"]);
            let around = &case["environment"][0];
            let scene = Scene {
                bands: Bands::from_rows(nu.iter().map(|&nu| (nu, 1.0))).unwrap(),
                target,
                alternative,
                temperature_k: number(&case["target_temperature_k"]),
                objects: vec![black(number(&around["T"]), number(&around["V"]))],
                ..Scene::of(coat, metal).unwrap().not_knowing([Temperature, Lighting])
            };
            let met = |found: &Extended, answers: &serde_json::Value| {
                let both = |one: &&serde_json::Value| {
                    one["unknown"] == serde_json::json!(["temperature", "lighting"])
                };
                let exact = answers.as_array().unwrap().iter().find(both).unwrap();
                let error = found.relative_error_to(&Extended::parse(&digits(&exact["value"])));
                assert!(error < 1e-27, "{}: {error:e}", case["name"]);
            };
            met(&local::found(&scene).unwrap().distance, &case["distance_local"]);
            met(&nearest(&scene).unwrap().distance, &case["distance_nearest"]);
        }
    }
}
