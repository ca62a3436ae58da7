//! Nothing is beyond reach that a state found by other means is within; against searches that share no code with the bound.

use super::*;
use crate::scene::EnvironmentObject;

/// Numbers from 0 to 1.
fn draws(mut seed: u64) -> impl FnMut() -> f64 {
    move || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// An alternative before a target: the cost at (T′, V′), and its least by nested golden sections.
struct Brute<'b> {
    bands: &'b Bands,
    scale: f64,
    target: Vec<f64>,
    alternative: &'b [f64],
    noise: f64,
    /// Temperatures of the surroundings; what lights the alternative, V′ of the first where that is free.
    objects: &'b [EnvironmentObject],
    state: &'b State,
    free: [bool; 2],
    range: StateRange,
}

impl Brute<'_> {
    fn cost(&self, temperature_k: f64, lighting: f64) -> f64 {
        let mut sum = 0.0;
        for (w, nu) in self.bands.nodes_cm1().iter().enumerate() {
            let mut light = 0.0;
            for (k, object) in self.objects.iter().enumerate() {
                let v = if self.free[1] && k == 0 { lighting } else { self.state.lighting[k] };
                let own = object.emissivity.as_ref().map_or(1.0, |e| e[w]);
                light += v * own * planck::photon_radiance(*nu, object.temperature_k);
            }
            let e = self.alternative[w];
            let counts = self.scale * (e * planck::photon_radiance(*nu, temperature_k) + (1.0 - e) * light);
            let off = (counts + self.noise).sqrt() - (self.target[w] + self.noise).sqrt();
            sum += off * off;
        }
        sum
    }

    fn lit(&self, temperature_k: f64) -> f64 {
        if !self.free[1] {
            return self.cost(temperature_k, 0.0);
        }
        let top = self.range.lighting[1].min(self.range.lighting_sum);
        golden([self.range.lighting[0].min(top), top], 40, |v| self.cost(temperature_k, v)).1
    }

    /// The least distance found.
    fn least(&self) -> f64 {
        if !self.free[0] {
            return self.lit(self.state.temperature_k).sqrt();
        }
        let [low, high] = self.range.temperature_k.map(f64::ln);
        let at = |i: usize| low + (high - low) * i as f64 / 60.0;
        let costs: Vec<f64> = (0..=60).map(|i| self.lit(at(i).exp())).collect();
        let best = (0..=60).min_by(|a, b| costs[*a].total_cmp(&costs[*b])).unwrap_or(0);
        let around = [at(best.saturating_sub(1)), at((best + 1).min(60))];
        golden(around, 50, |t| self.lit(t.exp())).1.min(costs[best]).sqrt()
    }
}

/// The least of a function with one valley.
fn golden([mut a, mut b]: [f64; 2], steps: usize, f: impl Fn(f64) -> f64) -> (f64, f64) {
    let share = 0.5 * (5f64.sqrt() - 1.0);
    for _ in 0..steps {
        let [x, y] = [b - share * (b - a), a + share * (b - a)];
        if f(x) < f(y) { b = y } else { a = x }
    }
    [a, 0.5 * (a + b), b]
        .map(|x| (x, f(x)))
        .into_iter()
        .min_by(|p, q| p.1.total_cmp(&q.1))
        .unwrap_or((a, f(a)))
}

/// Random scenes: counts from 10 to 1e12, noise, lights, ranges, emissivities down to mirrors; what may be unknown.
#[test]
fn nothing_within_reach_is_said_to_be_beyond() {
    let mut draw = draws(17);
    let [mut asked, mut shown] = [0; 2];
    for scene in 0..80 {
        let first = 400.0 + 1500.0 * draw();
        let bands = Bands::uniform(first, first * (1.1 + 0.8 * draw()), 0.02 * first).expect("bands");
        let nodes = bands.nodes_cm1();
        let smooth = |draw: &mut dyn FnMut() -> f64| -> Vec<f64> {
            let (level, wave, length, phase) = (draw(), 0.3 * draw() * draw(), 0.05 + draw(), 6.0 * draw());
            nodes
                .iter()
                .map(|nu| (level + wave * (nu / (length * first) + phase).sin()).clamp(0.0, 1.0))
                .collect()
        };
        let kind = scene % 4;
        let unknown: &[Nuisance] = match kind {
            0 => &[Nuisance::Temperature, Nuisance::Lighting],
            1 => &[Nuisance::Temperature],
            2 => &[Nuisance::Lighting],
            _ => &[Nuisance::Temperature, Nuisance::Lighting],
        };
        let objects: Vec<EnvironmentObject> = (0..if kind == 1 { 2 } else { 1 })
            .map(|_| EnvironmentObject {
                // Some as hot as the sun.
                temperature_k: if draw() < 0.2 { 5800.0 } else { 150.0 + 250.0 * draw() },
                emissivity: (draw() < 0.3).then(|| smooth(&mut draw)),
            })
            .collect();
        let surroundings = Surroundings::new(nodes, objects.clone()).expect("surroundings");
        let lighting: Vec<f64> = objects.iter().map(|_| 0.5 * draw()).collect();
        let state = surroundings.state(200.0 + 400.0 * draw(), &lighting).expect("state");
        let unknowns = Unknowns::new(unknown.iter().copied()).expect("distinct");
        let range = match kind {
            3 => StateRange {
                temperature_k: [150.0 + 50.0 * draw(), 400.0 + 300.0 * draw()],
                lighting: [0.1 * draw(), 0.6 + 0.4 * draw()],
                lighting_sum: 1.0,
            },
            _ => StateRange::default(),
        };
        let black: f64 = nodes.iter().map(|nu| planck::photon_radiance(*nu, state.temperature_k)).sum();
        let per_band = 10f64.powf(1.0 + 11.0 * draw());
        let weight = bands.weights_cm1()[0];
        let counting = Counting {
            counts_per_radiance: per_band * nodes.len() as f64 / (black * weight),
            var_added: vec![per_band * draw() * draw(); nodes.len()],
        };
        let mut library: Vec<Vec<f64>> = (0..5).map(|_| smooth(&mut draw)).collect();
        library.push(vec![1.0; nodes.len()]);
        // Hardly anything is reflected, of what may be far brighter than what is sent.
        let little = 10f64.powf(-3.0 - 6.0 * draw());
        library.push(vec![1.0 - little; nodes.len()]);
        library.push(library[0].iter().map(|e| e * 0.999).collect());
        let emissivities: Vec<&[f64]> = library.iter().map(Vec::as_slice).collect();
        let seeing = Seeing {
            bands: &bands,
            surroundings: &surroundings,
            unknowns: &unknowns,
            range,
            state: &state,
            counting: &counting,
        };
        let target = if scene % 5 == 4 { 6 } else { (draw() * 5.0) as usize };
        let scale = counting.counts_per_radiance * weight;
        let mut brute = Brute {
            bands: &bands,
            scale,
            target: Vec::new(),
            alternative: emissivities[target],
            noise: counting.var_added[0],
            objects: &objects,
            state: &state,
            free: [unknown.contains(&Nuisance::Temperature), unknown.contains(&Nuisance::Lighting)],
            range: StateRange { temperature_k: range.temperature_k.map(|t| t.clamp(20.0, 1e5)), ..range },
        };
        let own = emissivities[target];
        brute.target = (0..nodes.len())
            .map(|w| {
                let light: f64 = objects
                    .iter()
                    .zip(&state.lighting)
                    .map(|(object, v)| {
                        v * object.emissivity.as_ref().map_or(1.0, |e| e[w])
                            * planck::photon_radiance(nodes[w], object.temperature_k)
                    })
                    .sum();
                scale
                    * (own[w] * planck::photon_radiance(nodes[w], state.temperature_k)
                        + (1.0 - own[w]) * light)
            })
            .collect();
        for other in (0..library.len()).filter(|other| *other != target) {
            brute.alternative = emissivities[other];
            let least = brute.least();
            for (share, may_be) in [(1.0 + 1e-6, false), (1.05, false), (0.25, true)] {
                let required = share * least;
                let Some(beyond) = Beyond::new(seeing, emissivities.clone(), required) else { continue };
                let said = beyond.of_target(target, &mut Seen::default())[other];
                assert!(
                    may_be || !said,
                    "scene {scene}, {target} against {other}: {least} found, {required} said"
                );
                if may_be {
                    asked += 1;
                    shown += usize::from(said);
                }
            }
        }
    }
    // It is of use: most of what is four times as far is shown to be.
    assert!(asked > 200 && shown as f64 > 0.7 * asked as f64, "{shown} of {asked}");
}

/// Where the model is another one nothing is said.
#[test]
fn what_it_does_not_know_it_leaves_to_the_pairs() {
    let bands = Bands::uniform(700.0, 1200.0, 5.0).expect("bands");
    let objects = vec![EnvironmentObject { temperature_k: 290.0, emissivity: None }; 2];
    let surroundings = Surroundings::new(bands.nodes_cm1(), objects).expect("surroundings");
    let state = surroundings.state(310.0, &[0.4, 0.3]).expect("state");
    let counting = Counting { counts_per_radiance: 1e-17, var_added: Vec::new() };
    let (a, b) = (vec![0.9; bands.len()], vec![0.5; bands.len()]);
    let of = |unknowns: Unknowns, required: f64, b: &[f64]| {
        let range = StateRange::default();
        let seeing = Seeing {
            bands: &bands,
            surroundings: &surroundings,
            unknowns: &unknowns,
            range,
            state: &state,
            counting: &counting,
        };
        Beyond::new(seeing, vec![&a, b], required).is_some()
    };
    let unknowns = |of: &[Nuisance]| Unknowns::new(of.iter().copied()).expect("distinct");
    let temperature = unknowns(&[Nuisance::Temperature]);
    assert!(of(temperature.clone(), 1.0, &b));
    assert!(!of(temperature.clone().prior(Nuisance::Temperature, 1.0).expect("a prior"), 1.0, &b));
    for others in [
        vec![Nuisance::Temperature, Nuisance::Gain],
        vec![Nuisance::Temperature, Nuisance::EnvironmentTemperature],
        vec![Nuisance::Temperature, Nuisance::Lighting],
    ] {
        assert!(!of(unknowns(&others), 1.0, &b), "{others:?}");
    }
    for required in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(!of(temperature.clone(), required, &b));
    }
    assert!(!of(temperature.clone(), 1.0, &b[1..]) && !of(temperature, 1.0, &vec![1.5; bands.len()]));
}

/// A material is not told from itself where it reflects a millionth of a light ten million times brighter.
#[test]
fn nothing_is_beyond_itself() {
    let bands = Bands::uniform(2400.0, 2600.0, 2.0).expect("bands");
    for (little, per_band) in [(1e-6, 1e12), (1.33e-5, 1e12), (1e-6, 1e10), (1.06e-7, 1e10), (1e-9, 1e14)] {
        let objects = vec![EnvironmentObject { temperature_k: 5800.0, emissivity: None }];
        let surroundings = Surroundings::new(bands.nodes_cm1(), objects).expect("surroundings");
        let state = surroundings.state(300.0, &[1.0]).expect("state");
        let own = vec![1.0 - little; bands.len()];
        let sent: f64 = bands
            .nodes_cm1()
            .iter()
            .map(|nu| planck::photon_radiance(*nu, 300.0) + little * planck::photon_radiance(*nu, 5800.0))
            .sum();
        let counting = Counting {
            counts_per_radiance: per_band * bands.len() as f64 / (2.0 * sent),
            var_added: Vec::new(),
        };
        for (unknown, temperature_k) in [
            (vec![Nuisance::Lighting], [0.1, 1e6]),
            (vec![Nuisance::Temperature, Nuisance::Lighting], [280.0, 320.0]),
        ] {
            let unknowns = Unknowns::new(unknown).expect("distinct");
            let range = StateRange { temperature_k, ..StateRange::default() };
            let seeing = Seeing {
                bands: &bands,
                surroundings: &surroundings,
                unknowns: &unknowns,
                range,
                state: &state,
                counting: &counting,
            };
            let Some(beyond) = Beyond::new(seeing, vec![&own, &own], 1.0) else { continue };
            assert!(!beyond.of_target(0, &mut Seen::default())[1], "{little} {per_band}");
        }
    }
}
