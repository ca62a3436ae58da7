//! Nothing is beyond reach that a state found by other means is within; against searches that share no code with the bound.

use super::*;
use crate::fisher::Unknowns;
use crate::identifiability::nearest::StateRange;
use crate::planck::photon_radiance;
use crate::scene::{EnvironmentObject, State, Surroundings};
use crate::spectrum::Bands;

/// Numbers from 0 to 1.
fn draws(mut seed: u64) -> impl FnMut() -> f64 {
    move || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// A scene with its camera.
struct Drawn {
    bands: Bands,
    surroundings: Surroundings,
    unknowns: Unknowns,
    range: StateRange,
    state: State,
    counting: Counting,
    library: Vec<Vec<f64>>,
}

impl Drawn {
    /// Counts from 10 to 1e12 a band, noise, lights as hot as the sun, emissivities of mirrors, of black and of nearly black surfaces.
    fn new(kind: usize, draw: &mut dyn FnMut() -> f64) -> Self {
        let first = 400.0 + 1500.0 * draw();
        let bands = Bands::uniform(first, first * (1.1 + 0.8 * draw()), 0.02 * first).expect("bands");
        let nodes = bands.nodes_cm1().to_vec();
        let smooth = |draw: &mut dyn FnMut() -> f64| -> Vec<f64> {
            let (level, wave, length, phase) = (draw(), 0.3 * draw() * draw(), 0.05 + draw(), 6.0 * draw());
            let at = |nu: &f64| (level + wave * (nu / (length * first) + phase).sin()).clamp(0.0, 1.0);
            nodes.iter().map(at).collect()
        };
        let objects: Vec<EnvironmentObject> = (0..if kind == 1 { 2 } else { 1 })
            .map(|_| EnvironmentObject {
                temperature_k: if draw() < 0.2 { 5800.0 } else { 150.0 + 250.0 * draw() },
                emissivity: (draw() < 0.3).then(|| smooth(draw)),
            })
            .collect();
        let lighting: Vec<f64> = objects.iter().map(|_| 0.5 * draw()).collect();
        let surroundings = Surroundings::new(&nodes, objects).expect("surroundings");
        let state = surroundings.state(200.0 + 400.0 * draw(), &lighting).expect("state");
        let unknown: &[Nuisance] = match kind {
            1 => &[Nuisance::Temperature],
            2 => &[Nuisance::Lighting],
            _ => &[Nuisance::Temperature, Nuisance::Lighting],
        };
        let unknowns = Unknowns::new(unknown.iter().copied()).expect("distinct");
        let range = match kind {
            3 => StateRange {
                temperature_k: [150.0 + 50.0 * draw(), 400.0 + 300.0 * draw()],
                lighting: [0.1 * draw(), 0.6 + 0.4 * draw()],
                lighting_sum: 1.0,
            },
            _ => StateRange::default(),
        };
        let black: f64 = nodes.iter().map(|nu| photon_radiance(*nu, state.temperature_k)).sum();
        let per_band = 10f64.powf(1.0 + 11.0 * draw());
        let counting = Counting {
            counts_per_radiance: per_band * nodes.len() as f64 / (black * bands.weights_cm1()[0]),
            var_added: vec![per_band * draw() * draw(); nodes.len()],
        };
        let mut library: Vec<Vec<f64>> = (0..5).map(|_| smooth(draw)).collect();
        let little = 10f64.powf(-3.0 - 6.0 * draw());
        library.extend([1.0, 1.0 - little].map(|e| vec![e; nodes.len()]));
        library.push(library[0].iter().map(|e| e * 0.999).collect());
        Self { bands, surroundings, unknowns, range, state, counting, library }
    }

    fn counts(&self, material: usize, temperature_k: f64, lighting: &[f64]) -> Vec<f64> {
        let of_band = |w: usize| {
            let nu = self.bands.nodes_cm1()[w];
            let lit = self.surroundings.objects().iter().zip(lighting).map(|(object, v)| {
                v * object.emissivity.as_ref().map_or(1.0, |e| e[w])
                    * photon_radiance(nu, object.temperature_k)
            });
            let e = self.library[material][w];
            let sent = e * photon_radiance(nu, temperature_k) + (1.0 - e) * lit.sum::<f64>();
            self.counting.counts_per_radiance * self.bands.weights_cm1()[w] * sent
        };
        (0..self.bands.len()).map(of_band).collect()
    }

    /// The least distance of an alternative that nested golden sections find.
    fn least(&self, target: usize, other: usize) -> f64 {
        let own = self.counts(target, self.state.temperature_k, &self.state.lighting);
        let cost = |temperature_k: f64, lighting: &[f64]| -> f64 {
            let all = self.counts(other, temperature_k, lighting).into_iter().zip(&own).enumerate();
            all.map(|(w, (n, own))| {
                let noise = self.counting.var_added(w);
                ((n + noise).sqrt() - (own + noise).sqrt()).powi(2)
            })
            .sum()
        };
        let lit = |temperature_k: f64| {
            if !self.unknowns.contains(Nuisance::Lighting) {
                return cost(temperature_k, &self.state.lighting);
            }
            golden(self.range.lighting, 40, |v| cost(temperature_k, &[v]))
        };
        if !self.unknowns.contains(Nuisance::Temperature) {
            return lit(self.state.temperature_k).sqrt();
        }
        let [low, high] = self.range.temperature_k.map(|t| t.clamp(20.0, 1e5).ln());
        let at = |i: usize| low + (high - low) * i as f64 / 60.0;
        let costs: Vec<f64> = (0..=60).map(|i| lit(at(i).exp())).collect();
        let best = (0..=60).min_by(|a, b| costs[*a].total_cmp(&costs[*b])).unwrap_or(0);
        let around = [at(best.saturating_sub(1)), at((best + 1).min(60))];
        golden(around, 50, |t| lit(t.exp())).min(costs[best]).sqrt()
    }

    fn scene(&self) -> LibraryScene<'_> {
        LibraryScene {
            bands: &self.bands,
            surroundings: &self.surroundings,
            unknowns: &self.unknowns,
            range: self.range,
            state: &self.state,
            tolerance: None,
        }
    }

    fn beyond(&self, required: f64) -> Option<Beyond<'_>> {
        let emissivities = self.library.iter().map(Vec::as_slice).collect();
        Beyond::new(&self.scene(), &self.counting, emissivities, required)
    }
}

/// The least of a function with one valley.
fn golden([mut a, mut b]: [f64; 2], steps: usize, f: impl Fn(f64) -> f64) -> f64 {
    let share = 0.5 * (5f64.sqrt() - 1.0);
    for _ in 0..steps {
        let [x, y] = [b - share * (b - a), a + share * (b - a)];
        if f(x) < f(y) { b = y } else { a = x }
    }
    [a, 0.5 * (a + b), b].map(f).into_iter().fold(f64::INFINITY, f64::min)
}

#[test]
fn nothing_within_reach_is_said_to_be_beyond() {
    let mut draw = draws(17);
    let [mut asked, mut shown] = [0; 2];
    for number in 0..80 {
        let drawn = Drawn::new(number % 4, &mut draw);
        let target = if number % 5 == 4 { 6 } else { (draw() * 5.0) as usize };
        for other in (0..drawn.library.len()).filter(|other| *other != target) {
            let least = drawn.least(target, other);
            for (share, may_be) in [(1.0 + 1e-6, false), (1.05, false), (0.25, true)] {
                let required = share * least;
                let Some(beyond) = drawn.beyond(required) else { continue };
                let said = beyond.of_target(target, &mut Seen::default())[other];
                assert!(may_be || !said, "{number}: {target}, {other}: {least} found, {required} said");
                asked += usize::from(may_be);
                shown += usize::from(may_be && said);
            }
        }
    }
    // It is of use: most of what is four times as far is shown to be.
    assert!(asked > 200 && shown as f64 > 0.7 * asked as f64, "{shown} of {asked}");
}

/// With the temperature known there are no chords, and where no band is so dim that the root of its counts bends within reach nothing else
/// is given away: the bound is the distance, to less than a hundredth.
#[test]
fn without_chords_the_bound_is_the_distance() {
    let mut draw = draws(23);
    let mut looked = 0;
    for number in 0..40 {
        let mut drawn = Drawn::new(2, &mut draw);
        drawn.counting.var_added.clear();
        drawn.counting.counts_per_radiance *= 1e6;
        drawn.library[0].iter_mut().for_each(|e| *e = 0.9_f64.mul_add(*e, 0.05));
        let off = |w: usize| 1.0 + 1e-3 * (w as f64).sin();
        drawn.library[1] = drawn.library[0].iter().enumerate().map(|(w, e)| e * off(w)).collect();
        let least = drawn.least(0, 1);
        let own = drawn.counts(0, drawn.state.temperature_k, &drawn.state.lighting);
        if own.iter().any(|n| n.sqrt() < 200.0 * least) {
            continue;
        }
        looked += 1;
        for (share, expected) in [(0.99, true), (1.0 + 1e-6, false)] {
            let beyond = drawn.beyond(share * least).expect("a scene that it knows");
            let said = beyond.of_target(0, &mut Seen::default())[1];
            assert_eq!(said, expected, "{number}: {share} of {least}");
        }
    }
    assert!(looked >= 10, "{looked}");
}

/// Where the model is another one nothing is said.
#[test]
fn what_it_does_not_know_it_leaves_to_the_pairs() {
    let mut draw = draws(5);
    let drawn = Drawn::new(1, &mut draw);
    let of = |unknowns: &Unknowns, required: f64, other: &[f64]| {
        let scene = LibraryScene { unknowns, ..drawn.scene() };
        Beyond::new(&scene, &drawn.counting, vec![&drawn.library[0], other], required).is_some()
    };
    let other = &drawn.library[1];
    let unknowns = |of: &[Nuisance]| Unknowns::new(of.iter().copied()).expect("distinct");
    let temperature = unknowns(&[Nuisance::Temperature]);
    assert!(of(&temperature, 1.0, other));
    assert!(!of(&temperature.clone().prior(Nuisance::Temperature, 1.0).expect("a prior"), 1.0, other));
    for besides in [Nuisance::Gain, Nuisance::EnvironmentTemperature, Nuisance::Lighting] {
        assert!(!of(&unknowns(&[Nuisance::Temperature, besides]), 1.0, other), "{besides:?}");
    }
    for required in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(!of(&temperature, required, other));
    }
    assert!(!of(&temperature, 1.0, &other[1..]) && !of(&temperature, 1.0, &vec![1.5; other.len()]));
}

/// A material is not told from itself where it reflects a millionth of a light ten million times brighter.
#[test]
fn nothing_is_beyond_itself() {
    for (little, per_band) in [(1e-6, 1e12), (1.33e-5, 1e12), (1e-6, 1e10), (1.06e-7, 1e10), (1e-9, 1e14)] {
        let bands = Bands::uniform(2400.0, 2600.0, 2.0).expect("bands");
        let sun = EnvironmentObject { temperature_k: 5800.0, emissivity: None };
        let surroundings = Surroundings::new(bands.nodes_cm1(), vec![sun]).expect("surroundings");
        let state = surroundings.state(300.0, &[1.0]).expect("state");
        let sent = |nu: &f64| photon_radiance(*nu, 300.0) + little * photon_radiance(*nu, 5800.0);
        let per_radiance =
            per_band / (2.0 * bands.nodes_cm1().iter().map(sent).sum::<f64>() / bands.len() as f64);
        let narrow = StateRange { temperature_k: [280.0, 320.0], ..StateRange::default() };
        for (unknown, range) in [
            (vec![Nuisance::Lighting], StateRange::default()),
            (vec![Nuisance::Temperature, Nuisance::Lighting], narrow),
        ] {
            let drawn = Drawn {
                library: vec![vec![1.0 - little; bands.len()]; 2],
                counting: Counting { counts_per_radiance: per_radiance, var_added: Vec::new() },
                unknowns: Unknowns::new(unknown).expect("distinct"),
                bands: bands.clone(),
                surroundings: surroundings.clone(),
                state: state.clone(),
                range,
            };
            let Some(beyond) = drawn.beyond(1.0) else { continue };
            assert!(!beyond.of_target(0, &mut Seen::default())[1], "{little} {per_band}");
        }
    }
}
