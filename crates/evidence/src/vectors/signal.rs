//! Band signals of a target in its surroundings, and their derivatives along everything that may be unknown.

use super::answer::{Answer, Vector};
use super::json::Json;
use super::scene::{Object, Scene, black, coat, glass, metal, sand, sky};
use super::topic::Topic;
use crate::reference::Extended;
use crate::reference::local::LocalReference;
use hadar::error::Result;
use hadar::scene::Parameter;
use hadar::spectrum::Bands;

pub(super) fn topic() -> Result<Topic> {
    let last_bit = f64::from_bits(293.15_f64.to_bits() + 1);
    let base = Scene::of(coat, metal)?;
    let sky_above = Object { temperature_k: 260.0, lighting: 0.6, material: Some(sky) };
    let wide = Bands::from_ranges(&[(800.0, 806.0), (1000.0, 1009.0), (1150.0, 1153.0)])?;
    let asked = [
        ("person-in-a-room", "an ordinary scene", base.clone()),
        ("deep-space", "no surroundings at all", Scene { objects: Vec::new(), ..base.clone() }),
        (
            "under-a-sky",
            "surroundings that are not black, and a gain",
            Scene {
                objects: vec![sky_above.clone(), black(290.0, 0.4)],
                gain: 0.75,
                ..Scene::of(sand, glass)?
            },
        ),
        (
            "total-known",
            "two objects whose lighting adds up to a known total",
            Scene {
                objects: vec![black(280.0, 0.3), black(300.0, 0.45)],
                lighting_total: Some(0.75),
                ..base.clone()
            },
        ),
        (
            "total-known-alike",
            "the two are 1 uK apart: the derivative along lighting is a difference",
            Scene {
                objects: vec![black(293.150_001, 0.3), black(293.15, 0.45)],
                lighting_total: Some(0.75),
                ..base.clone()
            },
        ),
        (
            "near-equilibrium",
            "T - T0 = 1e-9 K, V = 1 - 2^-40: the contrast is far below its terms",
            Scene {
                temperature_k: 293.150_000_001,
                objects: vec![black(293.15, 1.0 - 1.0 / f64::from(2_u32.pow(20)).powi(2))],
                ..base.clone()
            },
        ),
        (
            "last-bit",
            "T and T0 differ in their last bit, V = 1",
            Scene { temperature_k: last_bit, objects: vec![black(293.15, 1.0)], ..base.clone() },
        ),
        ("wide-bands", "bands of several nodes", base.clone().seen_in(wide, sand, glass)),
        ("faint-lighting", "V = 1e-12", Scene { objects: vec![black(293.15, 1e-12)], ..base.clone() }),
        (
            "cryogenic",
            "a target of 77 K under surroundings of 4 K",
            Scene { temperature_k: 77.0, objects: vec![black(4.0, 0.9)], ..base },
        ),
    ];
    let vectors = asked.into_iter().map(|(id, about, scene)| vector(id, about, &scene));
    Ok(Topic {
        name: "signal",
        title: "Band signals of a scene and their derivatives",
        catches: "reflectance forgotten or taken for emissivity, lighting that is not weighed by the object's own emissivity, a sign or \
                  a factor of any derivative, the gain left out of one, weights of nodes; a contrast or a difference of \
                  lighting by subtraction near equilibrium",
        vectors: vectors.collect::<Result<_>>()?,
        files: Vec::new(),
    })
}

fn vector(id: &'static str, about: &'static str, scene: &Scene) -> Result<Vector> {
    let (surroundings, state) = (scene.surroundings()?, scene.state());
    let pair = scene.pair(&state);
    let mut reference = LocalReference::new(&scene.bands, &surroundings, scene.unknowns()?);
    let reach = scene.reach();
    let signal = reference.signal(&scene.target, &state);
    let total: Extended = signal.iter().cloned().sum();
    let mut answers = vec![
        ("photon_radiance_per_s_m2_sr".to_owned(), Answer::one(&total, reach)),
        ("band_signal_per_s_m2_sr".into(), Answer::many(&signal, reach)),
    ];
    let mut derivative = |name: String, parameter: Parameter, reach: f64| {
        let column = reference.derivative(parameter, pair);
        answers.push((format!("derivative_{name}"), Answer::many(&column, reach)));
    };
    derivative("temperature_per_s_m2_sr_k".into(), Parameter::Temperature, reach);
    let free = scene.objects.len() - usize::from(scene.lighting_total.is_some());
    for k in 0..free {
        derivative(format!("lighting_{k}_per_s_m2_sr"), Parameter::Lighting(k), reach);
    }
    derivative("log_gain_per_s_m2_sr".into(), Parameter::Gain, reach);
    for k in 0..scene.objects.len() {
        let name = format!("environment_temperature_{k}_per_s_m2_sr_k");
        derivative(name, Parameter::EnvironmentTemperature(k), reach);
    }
    // Where objects are on both sides of the target, or partly lit, terms of either sign remain.
    let column = reference.derivative(Parameter::Material, pair);
    let terms = reference.material_terms(pair);
    let magnified =
        terms.iter().zip(&column).map(|(terms, sum)| (terms / sum.abs()).to_f64()).fold(1.0, f64::max);
    answers.push(("derivative_material_per_s_m2_sr".into(), Answer::many(&column, reach * magnified)));
    Ok(Vector { id, about, inputs: Json::Object(scene.seen()), answers })
}
