use super::*;
use crate::reference::nearest::NearestReference;
use crate::reference::{Extended, planck};
use hadar::fisher::{Counting, Nuisance};
use hadar::scene::EnvironmentObject;

const FEW: Noise<'static> = Noise::PerPhoton { photons: f64::INFINITY };

/// A scene of bands, black objects (temperature, lighting) and a target.
fn scene(nodes: &[f64], objects: &[(f64, f64)], temperature_k: f64) -> (Bands, Surroundings, State) {
    let bands = Bands::from_rows(nodes.iter().map(|&nu| (nu, 1.0))).unwrap();
    let black =
        objects.iter().map(|&(temperature_k, _)| EnvironmentObject { temperature_k, emissivity: None });
    let surroundings = Surroundings::new(bands.nodes_cm1(), black.collect()).unwrap();
    let lighting: Vec<f64> = objects.iter().map(|object| object.1).collect();
    let state = surroundings.state(temperature_k, &lighting).unwrap();
    (bands, surroundings, state)
}

fn unknown(set: &[Nuisance]) -> Unknowns {
    Unknowns::new(set.iter().copied()).unwrap()
}

fn found(bands: &Bands, surroundings: &Surroundings, set: &Unknowns, pair: Pair<'_>) -> Found {
    BruteForce::new(bands, surroundings, set, StateRange::default()).nearest(pair, FEW).unwrap()
}

fn extended(value: DoubleDouble) -> Extended {
    Extended::from(value.high()) + Extended::from(value.low())
}

fn radiance(nu: f64, temperature_k: f64) -> f64 {
    planck::photon_radiance(nu, temperature_k).to_f64()
}

/// Gain alone: with unit vectors a ∝ √N and b ∝ √N′ the distance is that of a from the line along b, √(1 − (a·b)²).
#[test]
fn the_gain_alone_is_an_angle() {
    let nodes = [800.0, 950.0, 1100.0, 1250.0];
    let (bands, surroundings, state) = scene(&nodes, &[(280.0, 0.6)], 310.0);
    let [target, alternative] = [[0.9, 0.8, 0.7, 0.95], [0.3, 0.6, 0.2, 0.5]];
    let pair = Pair { emissivity: &target, alternative: &alternative, state: &state };
    let signal = |e: &[f64]| -> Vec<f64> {
        let of = |(e, nu): (&f64, &f64)| e * radiance(*nu, 310.0) + (1.0 - e) * 0.6 * radiance(*nu, 280.0);
        e.iter().zip(&nodes).map(of).collect()
    };
    let [own, other] = [signal(&target), signal(&alternative)];
    let cross: f64 = own.iter().zip(&other).map(|(a, b)| (a * b).sqrt()).sum();
    let angle = cross * cross / (own.iter().sum::<f64>() * other.iter().sum::<f64>());
    let exact = (1.0 - angle).sqrt();
    let least = found(&bands, &surroundings, &unknown(&[Nuisance::Gain]), pair);
    assert!((least.distance.to_f64() / exact - 1.0).abs() < 1e-12, "{least:?} {exact}");
}

/// Lighting alone in two bands lit by one grey object: (√(A₁ + V E₁) − √N₁)² + (…)² by golden section in V, and at the end
/// of the range where the target is brighter than any lighting makes the alternative.
#[test]
fn lighting_alone_is_a_line() {
    let nodes = [900.0, 1150.0];
    for (warm, target, alternative, inside) in
        [(320.0, [0.5, 0.6], [0.7, 0.4], true), (260.0, [0.9, 0.95], [0.1, 0.12], false)]
    {
        let (bands, surroundings, state) = scene(&nodes, &[(warm, 0.4)], 300.0);
        let pair = Pair { emissivity: &target, alternative: &alternative, state: &state };
        let signal = |e: &[f64; 2], v: f64| {
            [0, 1].map(|i| e[i] * radiance(nodes[i], 300.0) + (1.0 - e[i]) * v * radiance(nodes[i], warm))
        };
        let own = signal(&target, 0.4);
        let cost = |v: f64| {
            let other = signal(&alternative, v);
            (0..2).map(|i| (other[i].sqrt() - own[i].sqrt()).powi(2)).sum::<f64>() / (own[0] + own[1])
        };
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..200 {
            let [a, b] = [low + 0.382 * (high - low), low + 0.618 * (high - low)];
            if cost(a) < cost(b) {
                high = b;
            } else {
                low = a;
            }
        }
        let least = found(&bands, &surroundings, &unknown(&[Nuisance::Lighting]), pair);
        assert!((least.distance.to_f64() / cost(low).sqrt() - 1.0).abs() < 1e-11, "{least:?}");
        assert_eq!(least.state.lighting[0] > 0.0 && least.state.lighting[0] < 1.0, inside, "{least:?}");
    }
}

/// One band: any temperature that sends as much is at no distance; and a known total leaves one object nothing free.
#[test]
fn one_band_tells_nothing_and_a_known_total_everything() {
    let (bands, surroundings, state) = scene(&[1000.0], &[(250.0, 0.5)], 300.0);
    let pair = Pair { emissivity: &[0.4], alternative: &[0.9], state: &state };
    for set in [&[Nuisance::Temperature][..], &[Nuisance::Gain], &[Nuisance::EnvironmentTemperature]] {
        let least = found(&bands, &surroundings, &unknown(set), Pair { alternative: &[0.35], ..pair });
        assert!(least.distance.to_f64() < 1e-24, "{set:?} {least:?}");
    }
    let known = unknown(&[Nuisance::Lighting]).lighting_total(Some(0.5)).unwrap();
    let least = found(&bands, &surroundings, &known, pair);
    let [warm, cold] = [300.0, 250.0].map(|t| radiance(1000.0, t));
    let [own, other] = [0.4_f64, 0.9].map(|e| (e * warm + (1.0 - e) * 0.5 * cold).sqrt());
    assert!((least.distance.to_f64() / ((other - own) / own) - 1.0).abs() < 1e-13, "{least:?}");
}

/// The same material is at no distance in every set of unknowns, and one that differs by 1e-13 at as little.
#[test]
fn identical_materials_are_at_no_distance() {
    let nodes = [700.0, 800.0, 1000.0, 1100.0, 1200.0, 1300.0, 1400.0];
    let (bands, surroundings, state) = scene(&nodes, &[(280.0, 0.3), (240.0, 0.2)], 300.0);
    let target = [0.9, 0.7, 0.8, 0.75, 0.6, 0.9, 0.5];
    let mut alternative = target;
    alternative[2] *= 1.0 + 1e-13;
    for bits in 0..16 {
        let set: Vec<Nuisance> =
            [Nuisance::Temperature, Nuisance::Lighting, Nuisance::Gain, Nuisance::EnvironmentTemperature]
                .into_iter()
                .enumerate()
                .filter(|(i, _)| bits >> i & 1 == 1)
                .map(|(_, nuisance)| nuisance)
                .collect();
        let set = unknown(&set);
        let same = Pair { emissivity: &target, alternative: &target, state: &state };
        let least = found(&bands, &surroundings, &set, same).distance.to_f64();
        assert!(least < 1e-22, "{set:?}: {least:e}");
        let nearly = found(&bands, &surroundings, &set, Pair { alternative: &alternative, ..same });
        let own = BruteForce::new(&bands, &surroundings, &set, StateRange::default());
        let own = own.separation(Pair { alternative: &alternative, ..same }, &state, FEW).to_f64();
        let distance = nearly.distance.to_f64();
        assert!(distance > 0.0 && distance <= own && own < 1e-13, "{set:?}: {distance:e} {own:e}");
    }
}

/// Separations are those of 512 bits, in a camera's noise too, at states of every kind.
#[test]
fn separations_are_those_of_extended_precision() {
    let nodes = [400.0, 650.0, 900.0, 1200.0, 2000.0];
    let (bands, surroundings, state) = scene(&nodes, &[(280.0, 0.3), (30.0, 0.2)], 120.0);
    let [target, alternative] = [[0.9, 0.7, 0.8, 0.75, 0.6], [0.1, 0.7, 0.3, 1.0, 0.0]];
    let set = unknown(&[Nuisance::Temperature, Nuisance::Lighting, Nuisance::Gain]);
    let pair = Pair { emissivity: &target, alternative: &alternative, state: &state };
    let force = BruteForce::new(&bands, &surroundings, &set, StateRange::default());
    let mut reference = NearestReference::new(&bands, &surroundings, set.clone(), StateRange::default());
    let counting = Counting { counts_per_radiance: 1e-12, var_added: vec![1e4; nodes.len()] };
    for noise in [FEW, Noise::Counting(&counting)] {
        for (temperature_k, lighting, gain) in
            [(120.0, [0.3, 0.2], 1.0 + 1e-14), (3.0, [0.0, 1.0], 0.1), (1e5, [0.5, 0.5], 1e-6)]
        {
            let other = State { temperature_k, lighting: lighting.to_vec(), gain, ..state.clone() };
            let exact = reference.separation(pair, &other, noise).distance;
            let error = extended(force.separation(pair, &other, noise)).relative_error_to(&exact);
            assert!(error < 1e-26, "{temperature_k}: {error:e}");
        }
    }
}

/// Where the brute force ends, extended precision finds no way further down.
#[test]
fn the_end_is_a_bottom() {
    let nodes = [700.0, 760.0, 840.0, 900.0, 980.0, 1060.0, 1140.0];
    let (bands, surroundings, state) = scene(&nodes, &[(290.0, 0.4), (260.0, 0.3)], 305.0);
    let target = [0.9, 0.7, 0.8, 0.75, 0.6, 0.9, 0.5];
    let alternative = [0.3, 0.5, 0.35, 0.6, 0.5, 0.45, 0.55];
    let pair = Pair { emissivity: &target, alternative: &alternative, state: &state };
    for set in [
        unknown(&[Nuisance::Temperature, Nuisance::Lighting]),
        unknown(&[Nuisance::Temperature, Nuisance::Lighting]).lighting_total(Some(0.7)).unwrap(),
        unknown(&[Nuisance::Temperature, Nuisance::EnvironmentTemperature]),
    ] {
        let least = found(&bands, &surroundings, &set, pair);
        let mut reference = NearestReference::new(&bands, &surroundings, set.clone(), StateRange::default());
        let (deeper, _) = reference.nearest_from(pair, std::slice::from_ref(&least.state), FEW).unwrap();
        let error = extended(least.distance).relative_error_to(&deeper);
        assert!(error < 1e-12, "{set:?}: {error:e} {least:?}");
    }
}

/// A scenario of `shared/reference/nearest`, as far as these are written: sections of `key = value`.
struct Written {
    bands: Bands,
    surroundings: Surroundings,
    state: State,
    target: Vec<f64>,
    alternative: Vec<f64>,
    unknowns: Unknowns,
    range: StateRange,
}

fn numbers(text: &str) -> Vec<f64> {
    let digits = |c: char| !(c.is_ascii_digit() || ".-+eE".contains(c));
    text.split(digits).filter_map(|part| part.parse().ok()).collect()
}

fn written(folder: &std::path::Path, name: &str) -> Written {
    let text = std::fs::read_to_string(folder.join(name)).unwrap();
    let mut bands = [0.0; 3];
    let (mut temperature_k, mut objects, mut lighting) = (0.0, Vec::new(), Vec::new());
    let (mut range, mut unknowns, mut files) = (StateRange::default(), Vec::new(), Vec::new());
    let mut section = "";
    for line in text.lines() {
        if line.starts_with('[') {
            section = line.trim_matches(['[', ']']);
            continue;
        }
        let Some((key, value)) = line.split_once(" = ") else { continue };
        let value_of = numbers(value);
        match (section, key) {
            ("target", "temperature") => temperature_k = value_of[0],
            ("environment", "temperature") => objects.push((value_of[0], None)),
            ("environment", "lighting") => lighting.push(value_of[0]),
            ("environment", "material") => {
                objects.last_mut().unwrap().1 = Some(value.trim_matches('"').to_owned());
            }
            ("alternatives", "materials") => files.push(value.trim_matches(['[', ']', '"']).to_owned()),
            ("alternatives", "temperature") => range.temperature_k = [value_of[0], value_of[1]],
            ("alternatives", "lighting") => range.lighting = [value_of[0], value_of[1]],
            ("bands", "start") => bands[0] = value_of[0],
            ("bands", "stop") => bands[1] = value_of[0],
            ("bands", "step") => bands[2] = value_of[0],
            ("unknown", "nuisances") => {
                for (word, nuisance) in [
                    ("temperature", Nuisance::Temperature),
                    ("lighting", Nuisance::Lighting),
                    ("gain", Nuisance::Gain),
                ] {
                    if value.contains(word) {
                        unknowns.push(nuisance);
                    }
                }
            }
            _ => (),
        }
    }
    let spectrum = |file: &str| -> Vec<f64> {
        let text = std::fs::read_to_string(folder.join(file)).unwrap();
        text.lines().skip(1).map(|line| numbers(line)[1]).collect()
    };
    let [start, stop, step] = bands;
    let count = ((stop - start) / step).round() as usize + 1;
    let bands = Bands::from_rows((0..count).map(|i| (start + step * i as f64, step))).unwrap();
    let objects = objects.into_iter().map(|(temperature_k, file): (f64, Option<String>)| EnvironmentObject {
        temperature_k,
        emissivity: file.map(|file| spectrum(&file)),
    });
    let surroundings = Surroundings::new(bands.nodes_cm1(), objects.collect()).unwrap();
    let state = surroundings.state(temperature_k, &lighting).unwrap();
    let [target, alternative] = [spectrum("target.csv"), spectrum(&files[0])];
    Written { bands, surroundings, state, target, alternative, unknowns: unknown(&unknowns), range }
}

/// Scenes in which a search once ended too high: the 60-digit minima that come with them, wide never above narrow.
#[test]
fn sixty_digit_minima_are_met() {
    let minima = [
        ("8039_0", 8.8902e-8),
        ("8000_2", 0.048_891_6),
        ("6304_2", 0.001_783_21),
        ("12120_1", 9.5691e-4),
        ("6230_3", 1.226_95e-12),
    ];
    for (name, least) in minima {
        let Some(folder) = hadar_testing::shared(&format!("reference/nearest/nearest_{name}")) else {
            return;
        };
        let [wide, narrow] = ["wide.toml", "narrow.toml"].map(|file| {
            let scene = written(&folder, file);
            let pair =
                Pair { emissivity: &scene.target, alternative: &scene.alternative, state: &scene.state };
            let force = BruteForce::new(&scene.bands, &scene.surroundings, &scene.unknowns, scene.range);
            force.nearest(pair, FEW).unwrap().distance.to_f64()
        });
        println!("{name}: {wide:e} {narrow:e}");
        assert!((wide / least - 1.0).abs() < 2e-5, "{name}: {wide:e}");
        assert!(wide <= narrow * (1.0 + 1e-20), "{name}: {wide:e} {narrow:e}");
    }
}
