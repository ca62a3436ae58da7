//! What the search for nearest states takes for granted of its inputs, and what it refuses.

use hadar::demand::Skipping;
use hadar::fisher::{Counting, Nuisance, Unknowns};
use hadar::identifiability::multi::{LibraryScene, LocalMatrix};
use hadar::identifiability::nearest::{NearestSolver, StateRange};
use hadar::material::Library;
use hadar::scene::{EnvironmentObject, State, Surroundings};
use hadar::spectrum::Bands;
use hadar_scenario::Scenario;
use hadar_simulate::sequential::Plan;
use hadar_study::warning::Code;
use hadar_study::{Law, Study, Trial};

struct Scene {
    bands: Bands,
    surroundings: Surroundings,
    state: State,
    own: Vec<f64>,
    other: Vec<f64>,
}

fn scene() -> Scene {
    let bands = Bands::uniform(720.0, 1250.0, 10.0).unwrap();
    let object = EnvironmentObject { temperature_k: 293.15, emissivity: None };
    let surroundings = Surroundings::new(bands.nodes_cm1(), vec![object]).unwrap();
    let state = surroundings.state(330.0, &[0.5]).unwrap();
    let wave = |level: f64, nu: &f64| level + 0.04 * (nu / 70.0).sin();
    let own = bands.nodes_cm1().iter().map(|nu| wave(0.9, nu)).collect();
    let other = bands.nodes_cm1().iter().map(|nu| 0.7 - wave(0.0, nu)).collect();
    Scene { bands, surroundings, state, own, other }
}

/// The known gain of a camera scales both spectra: the distance per √photon is the same. Rounding only (1e-12).
#[test]
fn a_known_gain_changes_nothing() {
    let Scene { bands, surroundings, state, own, other } = scene();
    let unknowns = Unknowns::new([Nuisance::Temperature, Nuisance::Lighting]).unwrap();
    let mut solver = NearestSolver::new(&bands, &surroundings, unknowns, StateRange::default());
    let mut distance = |gain: f64| {
        let state = State { gain, ..state.clone() };
        solver.per_photon(&own, &other, &state, f64::INFINITY).unwrap().distance
    };
    let nominal = distance(1.0);
    for gain in [1e-6, 1e-3, 0.5, 30.0, 1e6] {
        assert!((distance(gain) / nominal - 1.0).abs() < 1e-12, "{gain}");
    }
}

/// A refinement starts from the free part of a state; what is known is not the start's to choose.
#[test]
fn what_is_known_is_not_taken_from_a_start() {
    let Scene { bands, surroundings, state, own, other } = scene();
    let unknowns = Unknowns::new([Nuisance::Temperature]).unwrap();
    let mut solver = NearestSolver::new(&bands, &surroundings, unknowns, StateRange::default());
    let counting = Counting { counts_per_radiance: 1e-15, var_added: vec![] };
    let found = solver.with_counting(&own, &other, &state, &counting).unwrap();
    let start =
        State { lighting: vec![0.9], temperature_k: found.state.temperature_k + 5.0, ..state.clone() };
    let refined = solver.refine_with_counting(&own, &other, &state, &counting, &start).unwrap();
    assert_eq!(refined.state.lighting, [0.5]);
    assert!((refined.distance / found.distance - 1.0).abs() < 1e-12);
}

/// Spectra, noise and ranges that are no numbers are errors, never a distance.
#[test]
fn impossible_inputs_are_errors() {
    let Scene { bands, surroundings, state, own, other } = scene();
    let unknowns = Unknowns::new([Nuisance::Temperature, Nuisance::Lighting]).unwrap();
    let shot = Counting { counts_per_radiance: 1e-15, var_added: vec![] };
    let with = |range: StateRange, other: &[f64], counting: &Counting| {
        NearestSolver::new(&bands, &surroundings, unknowns.clone(), range)
            .with_counting(&own, other, &state, counting)
            .map(|nearest| nearest.distance)
    };
    let whole = StateRange::default();
    assert!(with(whole, &other, &shot).is_ok());
    assert!(with(whole, &vec![f64::NAN; other.len()], &shot).is_err());
    assert!(with(whole, &other[1..], &shot).is_err());
    for var in [f64::NAN, -1.0, f64::INFINITY] {
        let counting = Counting { var_added: vec![var; other.len()], ..shot.clone() };
        assert!(with(whole, &other, &counting).is_err(), "{var}");
    }
    assert!(with(whole, &other, &Counting { var_added: vec![1.0; 3], ..shot.clone() }).is_err());
    for temperature_k in [[400.0, 300.0], [f64::NAN, 300.0], [0.0, 300.0], [100.0, f64::INFINITY]] {
        assert!(with(StateRange { temperature_k, ..whole }, &other, &shot).is_err(), "{temperature_k:?}");
    }
    assert!(with(StateRange { lighting: [0.8, 0.2], ..whole }, &other, &shot).is_err());
    assert!(with(StateRange { lighting_sum: -1.0, ..whole }, &other, &shot).is_err());
    let mut matrix = LocalMatrix::new(&bands, &surroundings, unknowns.clone());
    assert!(matrix.per_photon(&[&own, &other[1..]], &state).is_err());
    let library = LibraryScene {
        bands: &bands,
        surroundings: &surroundings,
        unknowns: &unknowns,
        range: whole,
        state: &state,
        tolerance: None,
    };
    for required in [f64::NAN, 0.0, -1.0, f64::INFINITY] {
        for skipping in [Skipping::On, Skipping::Off] {
            assert!(
                library.told_apart(&[&own, &other], &shot, required, skipping, &|_, _| ()).is_err(),
                "{required}"
            );
        }
    }
    // Far apart, so that nothing need be asked of the pair itself.
    let far = |range, counting: &Counting| {
        let scene = LibraryScene { range, ..library };
        scene.told_apart(&[&own, &other], counting, 1e-3, Skipping::On, &|_, _| ()).is_err()
    };
    for temperature_k in [[400.0, 300.0], [f64::NAN, 300.0], [0.0, 300.0], [100.0, f64::INFINITY]] {
        assert!(far(StateRange { temperature_k, ..whole }, &shot), "{temperature_k:?}");
    }
    assert!(far(StateRange { lighting: [0.8, 0.2], ..whole }, &shot));
    assert!(far(StateRange { lighting_sum: -1.0, ..whole }, &shot));
    assert!(far(whole, &Counting { var_added: vec![1.0; 3], ..shot.clone() }));
    assert!(library.first_not_told_from(2, &[&own, &other], &shot, 1.0, Skipping::On).is_err());
    let decided = library.told_apart(&[&own, &other], &shot, 1.0, Skipping::On, &|_, _| ()).unwrap();
    assert!(!decided.told_apart(0, 2) && !decided.told_apart(2, 2));
}

fn study(bands: &str, alternatives: &str) -> Study {
    let text = format!(
        "[target]\nmaterial = \"skin\"\ntemperature = \"400 K\"\n[[environment]]\ntemperature = \"20 degC\"\n\
         lighting = 0.5\n[alternatives]\nmaterials = [{alternatives}]\n[bands]\n{bands}\n"
    );
    let scenario = Scenario::from_toml(&text, None).unwrap();
    Study::new(&scenario, &Library::embedded().unwrap()).unwrap()
}

/// Bunching widens every distance's noise alike: where light is strongly bunched, local and nearest distance shrink
/// together against those of Poisson counts. Their ratio stays within the 5 % by which they differ in curvature.
#[test]
fn bunched_light_weighs_all_distances_alike() {
    let study =
        study("start = \"715 cm^-1\"\nstop = \"1250 cm^-1\"\nstep = \"5 cm^-1\"", "\"soda-lime-glass\"");
    let ratio = |law: Law| {
        let plan = Plan::new(1, 0.1, 100).unwrap();
        let trial = Trial { law: Some(law), photons: Some(1e4), plan };
        let pair = study.exact(&trial, &|_, _| ()).unwrap().pairs[0].clone();
        (pair.statistical_distance_local, pair.statistical_distance_nearest)
    };
    let (poisson, bunched) = (ratio(Law::Poisson), ratio(Law::NegativeBinomial));
    let (local, nearest) = (bunched.0 / poisson.0, bunched.1 / poisson.1);
    // Some 0.06 photons per mode in these bands at 400 K: 1/√(1 + n̄) is 0.97.
    assert!(local < 0.99 && local > 0.94, "{local}");
    assert!((local / nearest - 1.0).abs() < 0.01, "{local} {nearest}");
}

/// The target cannot be told from itself: it is left out of its own alternatives, with a warning.
#[test]
fn the_target_is_no_alternative_of_its_own() {
    let study =
        study("start = \"800 cm^-1\"\nstop = \"1200 cm^-1\"\nstep = \"10 cm^-1\"", "\"skin\", \"pmma\"");
    let found = study.identify().unwrap();
    assert_eq!(found.pairs.len(), 1);
    assert!(found.warnings.iter().any(|warning| warning.code() == Code::TargetAmongAlternatives));
}
