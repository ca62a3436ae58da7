mod brute;
mod hidden;
mod stretch;

use super::cell::Cell;
use super::cube::Cube;
use super::joint::residual;
use super::linear::SOURCES;
use super::model::Point;
use super::partition::partition;
use super::*;
use crate::fisher::{Counting, Nuisance, Unknowns};
use crate::identifiability::nearest::StateRange;
use crate::instrument::{View, presets};
use crate::material::Library;
use crate::planck::photon_radiance;
use crate::scene::{EnvironmentObject, Surroundings};
use crate::spectrum::Bands;
use proptest::prelude::*;
use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};

/// Bands, surroundings and a pair of materials.
struct Setting {
    bands: Bands,
    surroundings: Surroundings,
    emissivity: Vec<f64>,
    alternative: Vec<f64>,
    counting: Counting,
    unknowns: Unknowns,
    range: StateRange,
}

impl Setting {
    fn new(bands: Bands, pair: [&str; 2], objects: usize, camera: &str) -> Self {
        let library = Library::embedded().unwrap();
        let of = |name: &str| match name.parse::<f64>() {
            Ok(gray) => vec![gray; bands.nodes_cm1().len()],
            Err(_) => library.get(name).unwrap().emissivity(bands.nodes_cm1()).unwrap(),
        };
        let object = EnvironmentObject { temperature_k: 293.15, emissivity: None };
        let counting = presets::get(camera).unwrap().counting(&bands, &View::at(Some(30.0)));
        Self {
            surroundings: Surroundings::new(bands.nodes_cm1(), vec![object; objects]).unwrap(),
            emissivity: of(pair[0]),
            alternative: of(pair[1]),
            counting,
            unknowns: Unknowns::new([Nuisance::Temperature, Nuisance::Lighting]).unwrap(),
            range: StateRange::default(),
            bands,
        }
    }

    fn longwave(pair: [&str; 2], camera: &str) -> Self {
        Self::new(Bands::uniform(715.0, 1250.0, 1.0).unwrap(), pair, 1, camera)
    }

    fn scene(&self) -> EnvelopeScene<'_> {
        EnvelopeScene {
            bands: &self.bands,
            surroundings: &self.surroundings,
            emissivity: &self.emissivity,
            alternative: &self.alternative,
            counting: &self.counting,
            unknowns: &self.unknowns,
            range: self.range,
        }
    }

    fn worst(&self, ranges: &Ranges) -> WorstCase {
        worst_case(&self.scene(), ranges, &Effort::default()).unwrap()
    }

    fn distance(&self, state: &State) -> f64 {
        let mut solver = self.scene().solver();
        solver.with_counting(&self.emissivity, &self.alternative, state, &self.counting).unwrap().distance
    }
}

/// Target, lighting and surroundings of the delivery robots: 30 to 40 degrees, V 0.1 to 0.9, −10 to 30 degrees.
fn evening() -> Ranges {
    Ranges::new([303.15, 313.15], vec![[0.1, 0.9]], vec![[263.15, 303.15]]).unwrap()
}

#[test]
fn a_person_and_a_robot_are_proved_to_one_per_cent() {
    for camera in ["flir-a325sc", "ideal-pnrd"] {
        for range in [[273.15, 393.15], [0.1, 1e6]] {
            let mut setting = Setting::longwave(["0.95", "aluminium"], camera);
            setting.range.temperature_k = range;
            let worst = setting.worst(&evening());
            assert_eq!(worst.certificate, Certificate::BranchAndBound, "{camera}: {worst:?}");
            let lower = worst.lower_bound.unwrap();
            assert!(lower <= worst.distance && lower >= 0.99 * worst.distance, "{worst:?}");
            // Least contrast: coldest target, warmest surroundings, most light.
            assert_eq!((worst.state.temperature_k, worst.state.environment_k[0]), (303.15, 303.15));
            assert_eq!(worst.state.lighting, [0.9]);
            // The distance can be fed forward.
            assert_eq!(setting.distance(&worst.state), worst.distance);
        }
    }
}

/// Wherever a search begins: what it proves is below what many scenes attain, and what it attains above what they prove.
#[test]
fn bounds_hold_from_wherever_the_search_begins() {
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    for unknowns in
        [vec![Nuisance::Temperature, Nuisance::Lighting], vec![Nuisance::Temperature, Nuisance::Gain]]
    {
        let bands = Bands::uniform(800.0, 1250.0, 50.0).unwrap();
        let mut setting = Setting::new(bands, ["skin", "aluminium"], 1, "ideal-pnrd");
        setting.unknowns = Unknowns::new(unknowns).unwrap();
        let ranges = evening();
        let many = setting.worst(&ranges);
        let proved = many.lower_bound.unwrap();
        for tolerance in [0.01, 0.5] {
            for _ in 0..6 {
                let [a, b, c, d] = [(); 4].map(|()| rng.random::<f64>());
                let state = ranges.scene_at(&[a, b, c]);
                let nearest = State { temperature_k: 250.0 + 200.0 * d, gain: 0.5 + a, ..state.clone() };
                let effort = Effort { relative_tolerance: tolerance, ..Effort::default() };
                let near = worst_case_near(&setting.scene(), &ranges, [&state, &nearest], &effort).unwrap();
                let lower = near.lower_bound.unwrap();
                assert!(lower <= many.distance && proved <= near.distance, "{near:?} {many:?}");
                assert!(lower <= near.distance, "{near:?}");
                let is_proved = near.certificate == Certificate::BranchAndBound;
                assert!(!is_proved || lower >= (1.0 - tolerance) * near.distance, "{near:?}");
                assert!(near.evaluations < many.evaluations / 4, "{near:?} {many:?}");
                let there = setting.distance(&near.state);
                assert!(there <= near.distance * (1.0 + 1e-9), "{there} {near:?}");
            }
        }
    }
}

/// No lattice of scenes finds anything below what is proved, nor below what is attained by more than the tolerance.
#[test]
fn a_lattice_of_scenes_finds_nothing_below_the_bound() {
    let ranges = [
        evening(),
        Ranges::new([250.0, 340.0], vec![[0.0, 1.0]], vec![[230.0, 330.0]]).unwrap(),
        Ranges::new([320.0, 321.0], vec![[0.3, 0.35]], vec![[200.0, 320.0]]).unwrap(),
    ];
    let pairs =
        [["aluminium", "gold"], ["fused-silica", "quartz"], ["marble", "concrete"], ["brass", "0.93"]];
    let mut compared = 0;
    for (pair, camera) in pairs.iter().zip(["ideal-pnrd", "flir-a325sc"].into_iter().cycle()) {
        for ranges in &ranges {
            let setting = Setting::new(Bands::uniform(740.0, 1240.0, 20.0).unwrap(), *pair, 1, camera);
            let worst = setting.worst(ranges);
            let lower = worst.lower_bound.unwrap();
            for place in 0..6 * 5 * 6 {
                let share = |i: i32, n: i32| f64::from(i) / f64::from(n - 1);
                let at = [share(place % 6, 6), share(place / 6 % 6, 6), share(place / 36, 5)];
                let distance = setting.distance(&ranges.scene_at(&at));
                // 1e-9: what the search for the nearest state leaves.
                assert!(distance >= lower * (1.0 - 1e-9), "{pair:?} {at:?}: {distance} {worst:?}");
                assert!(distance >= 0.99 * worst.distance, "{pair:?} {at:?}: {distance} {worst:?}");
                compared += 1;
            }
        }
    }
    assert_eq!(compared, 12 * 180);
}

/// Points of random boxes are no nearer than the bound of their box: the certificate itself, box by box, against plain
/// square roots of plain counts, for every set of unknowns, weighed by the target alone and by both.
#[test]
fn no_point_of_a_box_is_below_its_bound() {
    let mut random = ChaCha8Rng::seed_from_u64(11);
    let pairs = [["0.95", "aluminium"], ["silver", "gold"], ["quartz", "0.3"]];
    let (mut positive, mut tight) = (0, f64::INFINITY);
    for (case, (nuisances, objects, total)) in sets().into_iter().enumerate() {
        let camera = ["flir-a325sc", "ideal-pnrd"][case % 2];
        let mut setting =
            Setting::new(Bands::uniform(740.0, 1240.0, 20.0).unwrap(), pairs[case % 3], objects, camera);
        setting.unknowns = Unknowns::new(nuisances).unwrap().lighting_total(total).unwrap();
        let ranges =
            Ranges::new([290.0, 315.0], vec![[0.1, 0.9]; objects], vec![[260.0, 310.0]; objects]).unwrap();
        let (mut model, whole) = Model::new(&setting.scene(), &ranges);
        let ratio: Vec<f64> = (0..setting.bands.len()).map(|_| random.random_range(0.5..2.0)).collect();
        model.lean([&vec![1.0; ratio.len()], &ratio]);
        let middle = ranges.scene_at(&vec![0.5; 1 + 2 * objects]);
        let best = residual(&model, &model.point(&middle, &middle));
        let apart = best.square.sqrt();
        for attained in [0.3 * apart, 1e3 * apart] {
            let parts = partition(&model, whole.clone(), attained);
            for part in parts.iter().step_by(1 + parts.len() / 2) {
                let mut cell = Cell::new(&model, part, &best, attained);
                for _ in 0..8 {
                    let cube = random_cube(&model, &mut cell, &mut random);
                    positive += usize::from(cube.bound > 0.0);
                    for _ in 0..40 {
                        let Some(point) = random_point(&model, &cell, &cube, &mut random) else { continue };
                        let exact = residual(&model, &point).square.sqrt();
                        assert!(
                            cube.bound <= exact * (1.0 + 1e-12),
                            "{case}: {} {exact} {cube:?}",
                            cube.bound
                        );
                        if cube.bound > 0.0 {
                            tight = tight.min(exact / cube.bound);
                        }
                    }
                }
            }
        }
    }
    // It would be easy to be below with bounds of nothing.
    assert!(positive > 150 && tight < 1.01, "{positive} {tight}");
}

/// A box as the branch and bound may come to, bounded anew.
fn random_cube(model: &Model<'_>, cell: &mut Cell, random: &mut ChaCha8Rng) -> Cube {
    let factors = model::factors(&cell.region);
    let mut cube = Cube { cell: 0, nodes: [0; SOURCES], factors, bound: 0.0, split: None };
    let halvings = random.random_range(0..60);
    for _ in 0..halvings {
        cell.bound(model, &mut cube);
        let Some(split) = cube.split else { break };
        let (mut part, half) = (cube.clone(), random.random_range(0..2usize));
        if split % 3 == 0 {
            let s = split / 3;
            let halves = cell.halve(model, s, cube.nodes[s]);
            part.nodes[s] = (cell.sources[s].len() + half) as u32;
            cell.sources[s].extend(halves);
        } else {
            let range = &mut part.factors[split];
            range[1 - half] = 0.5 * (range[0] + range[1]);
        }
        part.bound = 0.0;
        if cell.clamp(model, &mut part) {
            cube = part;
        }
    }
    cube.bound = 0.0;
    cell.bound(model, &mut cube);
    cube
}

/// A point of a box in which everything holds that factors are tied by, corners as often as inside.
fn random_point(model: &Model<'_>, cell: &Cell, cube: &Cube, random: &mut ChaCha8Rng) -> Option<Point> {
    let mut within =
        |[low, high]: [f64; 2]| low + (high - low) * (random.random_range(-1.0..2.0f64)).clamp(0.0, 1.0);
    let mut values = [[0.0; 3]; SOURCES];
    for (s, value) in values.iter_mut().enumerate().take(cell.region.len()) {
        let [own, other] = [1, 2].map(|which: usize| cube.factors[3 * s + which]);
        *value = [within(cell.node_of(cube, s).t), within(own), within(other)];
    }
    let mut point = Point { values };
    model.project(&mut point);
    let factors = point.factors();
    let inside = (0..factors.len()).filter(|i| i % 3 != 0).all(|i| {
        let [low, high] = cube.factors[i];
        (low * (1.0 - 1e-12)..=high * (1.0 + 1e-12)).contains(&factors[i])
    });
    let holds = !model.relations.iter().any(|relation| relation.is_broken(&factors));
    (holds && inside).then_some(point)
}

/// Sets of unknowns with a number of objects and a known total of the lighting.
fn sets() -> Vec<(Vec<Nuisance>, usize, Option<f64>)> {
    use Nuisance::{EnvironmentTemperature as Around, Gain, Lighting, Temperature};
    vec![
        (vec![Temperature, Lighting], 1, None),
        (vec![Temperature, Lighting], 2, None),
        (vec![Temperature, Lighting], 3, None),
        (vec![Temperature, Lighting], 2, Some(0.7)),
        (vec![Gain], 2, None),
        (vec![Temperature, Gain], 1, None),
        (vec![Lighting, Gain], 2, None),
        (vec![Temperature, Lighting, Gain], 1, None),
        (vec![Temperature, Lighting, Gain], 2, Some(0.6)),
        (vec![Around], 1, None),
        (vec![Temperature, Around], 2, None),
        (vec![Temperature, Lighting, Around], 1, None),
        (vec![Lighting, Around], 2, None),
        (vec![Temperature, Gain, Around], 1, None),
        (vec![Temperature, Lighting, Gain, Around], 1, None),
    ]
}

/// One band, nothing unknown: d = κw|e − e′|(B(T) − VB(T₀))/(√ + √), least where the target is coldest and the light warmest.
#[test]
fn one_band_by_hand() {
    for var in [0.0, 1e6, 1e20] {
        let mut setting =
            Setting::new(Bands::from_rows([(1000.0, 2.0)]).unwrap(), ["0.9", "0.3"], 1, "ideal-pnrd");
        setting.unknowns = Unknowns::new([]).unwrap();
        setting.counting.var_added = vec![var];
        let ranges = Ranges::new([305.0, 340.0], vec![[0.2, 0.8]], vec![[250.0, 300.0]]).unwrap();
        let worst = setting.worst(&ranges);
        let counts = |e: f64| {
            let signal =
                e * photon_radiance(1000.0, 305.0) + (1.0 - e) * 0.8 * photon_radiance(1000.0, 300.0);
            setting.counting.counts_per_radiance * 2.0 * signal
        };
        let (own, other) = (counts(0.9), counts(0.3));
        let exact = (own - other) / ((own + var).sqrt() + (other + var).sqrt());
        // 1e-11: the difference of the counts in the formula as it stands here.
        assert!((worst.distance / exact - 1.0).abs() < 1e-11, "{var}: {} {exact}", worst.distance);
        assert_eq!(worst.certificate, Certificate::BranchAndBound, "{worst:?}");
        assert_eq!((worst.state.temperature_k, worst.state.lighting[0]), (305.0, 0.8));
    }
}

/// Two gray bodies in two bands, temperature unknown: the nearest temperature by golden sections, scene by scene of a lattice.
#[test]
fn two_gray_bodies_by_golden_sections() {
    let rows = [(800.0, 1.0), (1200.0, 1.0)];
    let mut setting = Setting::new(Bands::from_rows(rows).unwrap(), ["0.9", "0.4"], 1, "ideal-pnrd");
    setting.unknowns = Unknowns::new([Nuisance::Temperature]).unwrap();
    setting.range.temperature_k = [200.0, 600.0];
    let ranges = Ranges::new([310.0, 320.0], vec![[0.0, 0.5]], vec![[270.0, 290.0]]).unwrap();
    let worst = setting.worst(&ranges);
    let kappa = setting.counting.counts_per_radiance;
    let square = |t: f64, v: f64, t0: f64, other: f64| -> f64 {
        let root = |nu: f64, e: f64, t: f64| {
            (kappa * (e * photon_radiance(nu, t) + (1.0 - e) * v * photon_radiance(nu, t0))).sqrt()
        };
        rows.iter().map(|(nu, _)| (root(*nu, 0.9, t) - root(*nu, 0.4, other)).powi(2)).sum()
    };
    let mut least = f64::INFINITY;
    for place in 0..9 * 9 * 9 {
        let share = |i: i32| f64::from(i % 9) / 8.0;
        let (t, v, t0) =
            (310.0 + 10.0 * share(place), 0.5 * share(place / 9), 270.0 + 20.0 * share(place / 81));
        let (mut low, mut high) = (200.0, 600.0);
        let golden = 0.5 * (5.0f64.sqrt() - 1.0);
        while high - low > 1e-7 {
            let (a, b) = (high - golden * (high - low), low + golden * (high - low));
            if square(t, v, t0, a) < square(t, v, t0, b) { high = b } else { low = a }
        }
        least = least.min(square(t, v, t0, 0.5 * (low + high)).sqrt());
    }
    assert_eq!(worst.certificate, Certificate::BranchAndBound, "{worst:?}");
    assert!(
        worst.lower_bound.unwrap() <= least && worst.distance <= least * (1.0 + 1e-9),
        "{least} {worst:?}"
    );
    assert!(worst.distance >= 0.9 * least, "{least} {worst:?}");
}

#[test]
fn an_envelope_of_one_scene_is_that_scene() {
    let setting = Setting::longwave(["skin", "aluminium"], "ideal-pnrd");
    let ranges = Ranges::new([310.15; 2], vec![[0.5; 2]], vec![[293.15; 2]]).unwrap();
    let worst = setting.worst(&ranges);
    let state = setting.surroundings.state(310.15, &[0.5]).unwrap();
    assert_eq!((worst.state.clone(), worst.distance), (state.clone(), setting.distance(&state)));
    assert_eq!(worst.certificate, Certificate::BranchAndBound);
}

#[test]
fn equilibrium_is_recognised() {
    let setting = Setting::longwave(["0.95", "aluminium"], "flir-a325sc");
    let equal = Ranges::new([290.0, 310.0], vec![[0.5, 1.0]], vec![[280.0, 300.0]]).unwrap();
    let worst = setting.worst(&equal);
    assert_eq!(
        (worst.certificate, worst.distance, worst.lower_bound),
        (Certificate::Equilibrium, 0.0, Some(0.0))
    );
    assert_eq!(
        (worst.state.temperature_k, &worst.state.lighting[..]),
        (worst.state.environment_k[0], &[1.0][..])
    );
    assert_eq!(setting.distance(&worst.state), 0.0);
    // Never quite: some of the light is always missing, or the target is always warmer.
    for ranges in [
        Ranges::new([290.0, 310.0], vec![[0.5, 0.999]], vec![[280.0, 300.0]]).unwrap(),
        Ranges::new([300.1, 310.0], vec![[0.5, 1.0]], vec![[280.0, 300.0]]).unwrap(),
    ] {
        let worst = setting.worst(&ranges);
        assert_eq!(worst.certificate, Certificate::BranchAndBound, "{worst:?}");
        assert!(worst.distance > 0.0);
    }
    // Two objects that light wholly together.
    let two =
        Setting::new(Bands::uniform(740.0, 1240.0, 20.0).unwrap(), ["0.95", "aluminium"], 2, "ideal-pnrd");
    let ranges =
        Ranges::new([290.0, 310.0], vec![[0.3, 0.6], [0.1, 0.5]], vec![[280.0, 300.0], [285.0, 290.0]]);
    let worst = two.worst(&ranges.unwrap());
    assert_eq!((worst.certificate, worst.state.temperature_k), (Certificate::Equilibrium, 290.0));
    // Gray against gray at one temperature: another lighting makes up for another emissivity.
    let gray = Setting::longwave(["0.95", "0.9"], "flir-a325sc");
    assert_eq!(gray.worst(&evening()).certificate, Certificate::Equilibrium);
}

/// Without a proof it says so; priors leave a bound; too few boxes leave a wider one.
#[test]
fn what_cannot_be_proved_is_not_called_proved() {
    let mut setting =
        Setting::new(Bands::uniform(740.0, 1240.0, 50.0).unwrap(), ["0.95", "aluminium"], 1, "ideal-pnrd");
    let proved = setting.worst(&evening());
    let few = worst_case(&setting.scene(), &evening(), &Effort { boxes: 1, ..Effort::default() }).unwrap();
    assert!(matches!(few.certificate, Certificate::Bounded { gap } if gap > 0.01), "{few:?}");
    assert!(few.lower_bound.unwrap() <= proved.distance);
    let none = worst_case(&setting.scene(), &evening(), &Effort { boxes: 0, ..Effort::default() }).unwrap();
    assert!(matches!(none.certificate, Certificate::DenseSearch { .. }) && none.lower_bound.is_none());
    assert!((none.distance / proved.distance - 1.0).abs() < 0.01);

    let plain = setting.unknowns.clone();
    setting.unknowns = plain.clone().prior(Nuisance::Temperature, 0.1).unwrap();
    let prior = setting.worst(&evening());
    assert!(prior.distance >= proved.lower_bound.unwrap() && prior.lower_bound.unwrap() <= prior.distance);
    setting.unknowns = plain.clone().with(Nuisance::Gain);
    // At one temperature, gain and lighting together make any gray body of another: colder surroundings.
    let cold = Ranges::new([303.15, 313.15], vec![[0.1, 0.9]], vec![[263.15, 293.15]]).unwrap();
    let gain = setting.worst(&cold);
    assert_eq!(gain.certificate, Certificate::BranchAndBound, "{gain:?}");
    // One more unknown brings nothing farther apart.
    setting.unknowns = plain;
    assert!(gain.distance <= setting.worst(&cold).distance * (1.0 + 1e-9), "{gain:?}");

    // More objects than there are sources for.
    let five =
        Setting::new(Bands::uniform(740.0, 1240.0, 250.0).unwrap(), ["0.95", "aluminium"], 5, "ideal-pnrd");
    let around = Ranges::new([303.15; 2], vec![[0.1, 0.1]; 5], vec![[263.15, 263.15]; 5]).unwrap();
    let searched = five.worst(&around);
    assert!(
        matches!(searched.certificate, Certificate::DenseSearch { .. }) && searched.lower_bound.is_none()
    );
}

#[test]
fn any_number_of_threads_gives_the_same() {
    let setting = Setting::longwave(["copper", "brass"], "ideal-pnrd");
    let [one, three] = [1, 3].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| setting.worst(&evening()))
    });
    assert_eq!(one, three);
}

#[test]
fn impossible_ranges_are_refused() {
    let message =
        |t, v: &[[f64; 2]], t0: &[[f64; 2]]| Ranges::new(t, v.to_vec(), t0.to_vec()).unwrap_err().to_string();
    let (t, v, t0) = ([300.0, 310.0], [[0.1, 0.9]], [[280.0, 290.0]]);
    assert!(message([310.0, 300.0], &v, &t0).contains("empty"));
    assert!(message(t, &[[0.9, 0.1]], &t0).contains("empty"));
    assert!(message([-1.0, 300.0], &v, &t0).contains("above 0"));
    assert!(message(t, &[[0.1, 1.1]], &t0).contains("between 0 and 1"));
    assert!(message(t, &[[0.6, 0.7]; 2], &[[280.0, 290.0]; 2]).contains("at most 1"));
    assert!(message(t, &[], &t0).contains("0 values where 1"));
    let setting = Setting::longwave(["0.95", "aluminium"], "flir-a325sc");
    let two = Ranges::new(t, vec![[0.1, 0.2]; 2], vec![[280.0, 290.0]; 2]).unwrap();
    assert!(worst_case(&setting.scene(), &two, &Effort::default()).is_err());
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 16, ..ProptestConfig::default() })]

    /// A larger envelope has no larger worst case.
    #[test]
    fn more_scenes_are_no_better(
        t in (280.0..320.0_f64, 0.0..10.0_f64, 0.0..10.0_f64),
        v in (0.3..0.5_f64, 0.0..0.2_f64, 0.0..0.2_f64),
        t0 in (240.0..310.0_f64, 0.0..20.0_f64, 0.0..20.0_f64),
        pair in proptest::sample::select(vec![["0.95", "aluminium"], ["gold", "copper"], ["marble", "quartz"]]),
        shot in any::<bool>(),
    ) {
        let camera = if shot { "ideal-pnrd" } else { "flir-a325sc" };
        let setting = Setting::new(Bands::uniform(740.0, 1240.0, 50.0).unwrap(), pair, 1, camera);
        let ranges = |more: f64| {
            let reach = |(low, width, extra): (f64, f64, f64)| [low - more * extra, low + width + more * extra];
            Ranges::new(reach(t), vec![reach(v)], vec![reach(t0)]).unwrap()
        };
        let effort = Effort { boxes: 20_000, ..Effort::default() };
        let [small, large] = [0.0, 1.0].map(|more| worst_case(&setting.scene(), &ranges(more), &effort).unwrap());
        prop_assert!(large.lower_bound.unwrap() <= small.distance);
        // What is proved is within 1 % of the least there is.
        let proved = large.certificate == Certificate::BranchAndBound;
        prop_assert!(!proved || large.distance <= small.distance * 1.0102, "{small:?} {large:?}");
    }
}
