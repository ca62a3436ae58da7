use super::*;
use crate::fisher::Counting;
use crate::identifiability::nearest::StateRange;
use crate::lattice_points::GoldenLattice;
use crate::scene::{EnvironmentObject, Surroundings};
use crate::spectrum::Bands;

fn bands() -> Bands {
    Bands::from_ranges(&[(770.0, 830.0), (830.0, 910.0), (910.0, 1000.0), (1000.0, 1110.0), (1110.0, 1250.0)])
        .unwrap()
}

struct Scene {
    bands: Bands,
    surroundings: Surroundings,
    mannequin: Vec<f64>,
    person: Vec<f64>,
    counting: Counting,
    unknowns: Unknowns,
    range: StateRange,
}

impl Scene {
    fn of(counts_per_radiance: f64, unknown: &[Nuisance]) -> Self {
        let bands = bands();
        let nodes = bands.nodes_cm1().to_vec();
        let ambient = EnvironmentObject { temperature_k: 283.15, emissivity: None };
        let surroundings = Surroundings::new(&nodes, vec![ambient]).unwrap();
        let wave = |a: f64, b: f64| nodes.iter().map(|nu| a + b * (nu / 60.0).sin()).collect::<Vec<_>>();
        Self {
            counting: Counting { counts_per_radiance, var_added: vec![0.0; bands.len()] },
            unknowns: Unknowns::new(unknown.iter().copied()).unwrap(),
            range: StateRange { temperature_k: [300.0, 311.0], ..StateRange::default() },
            mannequin: wave(0.93, 0.004),
            person: wave(0.95, 0.01),
            surroundings,
            bands,
        }
    }

    fn scene(&self) -> EnvelopeScene<'_> {
        EnvelopeScene {
            bands: &self.bands,
            surroundings: &self.surroundings,
            emissivity: &self.mannequin,
            alternative: &self.person,
            counting: &self.counting,
            unknowns: &self.unknowns,
            range: self.range,
        }
    }
}

const ALL: Effort = Effort { relative_tolerance: 0.01, boxes: 20_000, enough: None };

fn ranges(temperature_k: [f64; 2], lighting: [f64; 2], surroundings_k: [f64; 2]) -> Ranges {
    Ranges::new(temperature_k, vec![lighting], vec![surroundings_k]).unwrap()
}

/// No stand-in of a lattice is farther than what is proved, by few boxes as by many; many come within 1 % of what is attained.
#[test]
fn nothing_within_the_tolerances_is_farther_than_proved() {
    let both = [Nuisance::Temperature, Nuisance::Lighting];
    for unknown in [&both[..], &both[..1], &both[1..], &[]] {
        for (kappa, boxes) in [(1e-15, 1), (1e-15, 20_000), (1e-13, 300)] {
            let own = Scene::of(kappa, unknown);
            let scene = own.scene();
            let envelope = ranges([303.0, 307.0], [0.3, 0.7], [278.0, 284.0]);
            let offsets = [-0.02, 0.02];
            let found = farthest(&scene, offsets, &envelope, &Effort { boxes, ..ALL }).unwrap();
            if boxes > 1000 {
                assert!(found.upper_bound <= 1.011 * found.distance, "{unknown:?} {kappa} {found:?}");
            }
            let lattice = GoldenLattice::new(vec![0.3; 4]);
            let mut solver = scene.solver();
            for index in 0..200 {
                let p = lattice.point(index);
                let at = |[a, b]: [f64; 2], x: f64| a + (b - a) * x;
                let state = State {
                    temperature_k: at([303.0, 307.0], p[1]),
                    lighting: vec![at([0.3, 0.7], p[2])],
                    gain: 1.0,
                    environment_k: vec![at([278.0, 284.0], p[3])],
                };
                let e: Vec<f64> = own.mannequin.iter().map(|e| e + at(offsets, p[0])).collect();
                let there = solver.with_counting(&e, &own.person, &state, &own.counting).unwrap().distance;
                assert!(there <= found.upper_bound, "{unknown:?} {there} {}", found.upper_bound);
            }
        }
    }
}

/// Stand-in and person of any mean are no farther from the means of the corners' counts than is said, and for boxes that are not
/// small it is a good part of that: no slack hides a wrong term.
#[test]
fn means_of_corners_are_as_near_as_is_said() {
    let own = Scene::of(1e-13, &[Nuisance::Temperature, Nuisance::Lighting]);
    let scene = own.scene();
    let roots = |emissivity: &[f64], state: &State| -> Vec<f64> {
        let counts = own.bands.weigh(&own.surroundings.signal(emissivity, state));
        counts.into_iter().map(|count| (1e-13 * count).sqrt()).collect()
    };
    let apart = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt();
    let mut closest = [0.0f64; 2];
    let lattice = GoldenLattice::new(vec![0.1; 4]);
    // The person that is nearest may have any temperature and lighting.
    let persons = [[302.0, 309.0], [0.2, 0.9]];
    for (low, high) in [
        (vec![-0.02, 303.0, 0.3, 278.0], vec![0.02, 307.0, 0.7, 284.0]),
        (vec![0.0, 290.0, 0.1, 260.0], vec![0.01, 320.0, 0.2, 300.0]),
        (vec![0.0, 303.0, 0.3, 278.0], vec![0.0, 303.0, 0.3, 308.0]),
    ] {
        let solver = scene.solver();
        let mut search =
            Search { scene: &scene, solver, lit_alike: None, objects: 1, corners: HashMap::new() };
        let places =
            (0..16).map(|n: usize| (0..4).map(|i| if n >> i & 1 == 1 { high[i] } else { low[i] }).collect());
        let places: Vec<Vec<f64>> = places.collect();
        let mut corners = Vec::new();
        for (n, place) in places.iter().enumerate() {
            let mut corner = search.corner(place).unwrap().clone();
            // Any persons will do for the means: these are at the ends of their ranges.
            corner.person.temperature_k = persons[0][n / 2 % 2];
            corner.person.lighting = vec![persons[1][(n + n / 8) % 2]];
            corner.person.environment_k = vec![place[3]];
            let signal = own.surroundings.signal(&own.person, &corner.person);
            corner.person_counts = own.bands.weigh(&signal).into_iter().map(|s| 1e-13 * s).collect();
            corners.push(corner);
        }
        let said = search.bent(&low, &high, &corners, persons[0], &[persons[1]]);
        for index in 0..200 {
            let x = lattice.point(index);
            let weights: Vec<f64> = (0..16usize)
                .map(|n| (0..4).map(|i| if n >> i & 1 == 1 { x[i] } else { 1.0 - x[i] }).product())
                .collect();
            let mean = |of: &dyn Fn(usize) -> f64| (0..16).map(|n| weights[n] * of(n)).sum::<f64>();
            let place: Vec<f64> = (0..4).map(|i| low[i] + (high[i] - low[i]) * x[i]).collect();
            let state = search.state(&place);
            let e: Vec<f64> = own.mannequin.iter().map(|e| e + place[0]).collect();
            let mixed = |of: &dyn Fn(usize, usize) -> f64| {
                (0..own.bands.len()).map(|w| mean(&|n| of(n, w)).sqrt()).collect::<Vec<f64>>()
            };
            let found = apart(&roots(&e, &state), &mixed(&|n, w| corners[n].counts[w]));
            let person = State {
                temperature_k: mean(&|n| corners[n].person.temperature_k),
                lighting: vec![mean(&|n| corners[n].person.lighting[0])],
                ..state
            };
            let of_person = apart(&roots(&own.person, &person), &mixed(&|n, w| corners[n].person_counts[w]));
            assert!(
                found <= said[0] * (1.0 + 1e-9) && of_person <= said[1] * (1.0 + 1e-9),
                "{low:?} {said:?}"
            );
            closest = [closest[0].max(found / said[0].max(1e-300)), closest[1].max(of_person / said[1])];
        }
    }
    // The bound of a chord is twice its sag.
    assert!(closest.iter().all(|share| *share > 0.35), "{closest:?}");
}

/// By hand: one coordinate varies, everything is known but the temperature, of which the person may have any: the same material at
/// a temperature beyond the person's is as far as the person's warmest.
#[test]
fn the_same_material_is_told_by_its_temperature_alone() {
    let mut own = Scene::of(1e-14, &[Nuisance::Temperature]);
    own.mannequin = own.person.clone();
    let scene = own.scene();
    let at = |warmest: f64| {
        let envelope = ranges([305.0, warmest], [0.5, 0.5], [283.15, 283.15]);
        farthest(&scene, [0.0, 0.0], &envelope, &Effort { relative_tolerance: 0.01, boxes: 1, enough: None })
            .unwrap()
    };
    let within = at(310.0);
    assert!(within.distance < 1e-6, "{within:?}");
    let envelope = ranges([305.0, 312.0], [0.5, 0.5], [283.15, 283.15]);
    let found = farthest(
        &scene,
        [0.0, 0.0],
        &envelope,
        &Effort { relative_tolerance: 1e-3, boxes: 4000, enough: None },
    );
    let found = found.unwrap();
    let counts = |t: f64| {
        let state = State { temperature_k: t, lighting: vec![0.5], gain: 1.0, environment_k: vec![283.15] };
        let signal = own.surroundings.signal(&own.person, &state);
        own.bands.weigh(&signal).into_iter().map(|s| 1e-14 * s).collect::<Vec<_>>()
    };
    let squares =
        counts(312.0).iter().zip(counts(311.0)).map(|(a, b)| (a.sqrt() - b.sqrt()).powi(2)).sum::<f64>();
    assert!((found.distance / squares.sqrt() - 1.0).abs() < 1e-6, "{} {}", found.distance, squares.sqrt());
    assert!((found.state.temperature_k - 312.0).abs() < 1e-9);
    assert!((found.person.temperature_k - 311.0).abs() < 1e-4);
}

/// Two objects that light by different amounts: a thing of the person's own material is one, however it is lit, and no person has to be in what both
/// ranges have in common.
#[test]
fn a_thing_of_the_persons_own_is_one_however_it_is_lit() {
    let mut own = Scene::of(1e-14, &[Nuisance::Temperature, Nuisance::Lighting]);
    let nodes = own.bands.nodes_cm1().to_vec();
    let object = |temperature_k| EnvironmentObject { temperature_k, emissivity: None };
    own.surroundings = Surroundings::new(&nodes, vec![object(273.0), object(291.0)]).unwrap();
    own.mannequin = own.person.clone();
    // What 0.05 to 0.12 and 0.12 to 0.24 have in common.
    own.range.lighting = [0.12, 0.12];
    let all =
        Ranges::new([301.0, 303.0], vec![[0.05, 0.12], [0.12, 0.24]], vec![[273.0; 2], [291.0; 2]]).unwrap();
    let found = farthest(&own.scene(), [0.0; 2], &all, &ALL).unwrap();
    assert!(found.distance < 1e-6, "{}", found.distance);
    let told = farthest(&own.scene(), [-0.01, 0.01], &all, &ALL).unwrap();
    assert!(told.distance > 1e3 * found.distance.max(1e-12) && told.upper_bound >= told.distance);
}
