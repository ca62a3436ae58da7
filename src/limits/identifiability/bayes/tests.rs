use super::*;
use crate::fisher::Counting;
use crate::fisher::Nuisance::{self, Gain, Lighting, Temperature};
use crate::identifiability::local::LocalSolver;
use crate::identifiability::nearest::StateRange;
use crate::planck;
use crate::scene::{EnvironmentObject, State};
use std::f64::consts::PI;

struct Scene {
    bands: Bands,
    surroundings: Surroundings,
    skin: Vec<f64>,
    paint: Vec<f64>,
}

fn scene() -> Scene {
    let bands = Bands::uniform(750.0, 1250.0, 10.0).unwrap();
    let object = EnvironmentObject { temperature_k: 293.15, emissivity: None };
    let surroundings = Surroundings::new(bands.nodes_cm1(), vec![object]).unwrap();
    let nu = bands.nodes_cm1();
    let skin = nu.iter().map(|nu| 0.94 + 0.02 * (nu / 60.0).sin()).collect();
    let paint = nu.iter().map(|nu| 0.82 + 0.06 * (nu / 45.0).cos()).collect();
    Scene { surroundings, skin, paint, bands }
}

fn free(nuisances: &[Nuisance]) -> Unknowns {
    Unknowns::new(nuisances.iter().copied()).unwrap()
}

impl Scene {
    fn state(&self, temperature_k: f64, lighting: f64) -> State {
        self.surroundings.state(temperature_k, &[lighting]).unwrap()
    }

    fn pair<'a>(&'a self, state: &'a State) -> Pair<'a> {
        Pair { emissivity: &self.skin, alternative: &self.paint, state }
    }

    fn bound(&self, unknowns: &Unknowns) -> BayesianBound<'_> {
        BayesianBound::new(&self.bands, &self.surroundings, unknowns.clone())
    }

    fn local(&self, unknowns: &Unknowns, state: &State, photons: f64) -> f64 {
        LocalSolver::new(&self.bands, &self.surroundings, unknowns.clone())
            .per_photon(&self.skin, &self.paint, state, photons)
            .unwrap()
            .distance
    }
}

fn close(a: f64, b: f64, tolerance: f64) {
    assert!((a / b - 1.0).abs() < tolerance, "{a} {b}");
}

#[test]
fn without_priors_it_is_the_local_distance() {
    let scene = scene();
    let state = scene.state(315.0, 0.6);
    for nuisances in [&[][..], &[Temperature], &[Temperature, Lighting], &[Temperature, Lighting, Gain]] {
        let unknowns = free(nuisances);
        let found = scene.bound(&unknowns).distance(scene.pair(&state), 1e6).unwrap();
        // Rounding of two projections, a hundred ulp at this condition.
        close(found.distance, scene.local(&unknowns, &state, f64::INFINITY), 1e-12);
        assert_eq!((found.nodes, found.quadrature_change), (1, 0.0));
        let photons = scene.bound(&unknowns).photons_required(scene.pair(&state), 2.0).unwrap().unwrap();
        close(photons, (2.0 / found.distance).powi(2), 1e-11);
    }
}

/// σ → 0: the parameter is known. Error of order σ²: (1e-4/315)² and less.
#[test]
fn a_narrow_prior_makes_a_parameter_known() {
    let scene = scene();
    let state = scene.state(315.0, 0.6);
    let known = scene.local(&free(&[Lighting]), &state, f64::INFINITY);
    let unknowns = free(&[Temperature, Lighting]).prior(Temperature, 1e-6).unwrap();
    let found = scene.bound(&unknowns).distance(scene.pair(&state), 1e4).unwrap();
    close(found.distance, known, 1e-8);
    let both =
        free(&[Temperature, Lighting]).prior(Temperature, 1e-6).unwrap().prior(Lighting, 1e-8).unwrap();
    let found = scene.bound(&both).distance(scene.pair(&state), 1e4).unwrap();
    close(found.distance, scene.local(&free(&[]), &state, f64::INFINITY), 1e-8);
}

/// A moderate prior away from equilibrium: the average changes little, the prior's precision as
/// LocalSolver's.
#[test]
fn a_prior_counts_as_it_does_locally() {
    let scene = scene();
    let state = scene.state(330.0, 0.6);
    let unknowns = free(&[Temperature, Lighting]).prior(Temperature, 0.02).unwrap();
    for photons in [1e3, 1e6] {
        let found = scene.bound(&unknowns).distance(scene.pair(&state), photons).unwrap();
        close(found.distance, scene.local(&unknowns, &state, photons), 1e-4);
    }
}

/// Information averaged before it is inverted: d_B² ≥ E[d²].
#[test]
fn the_bound_is_the_optimistic_average() {
    let scene = scene();
    let state = scene.state(305.0, 0.8);
    let unknowns =
        free(&[Temperature, Lighting]).prior(Temperature, 8.0).unwrap().prior(Lighting, 0.1).unwrap();
    let photons = 1e5;
    let bound = scene.bound(&unknowns).distance(scene.pair(&state), photons).unwrap().distance;
    let total = scene.bound(&unknowns).photon_radiance(scene.pair(&state)).unwrap();
    let counting = Counting { counts_per_radiance: photons / total, var_added: Vec::new() };
    let mut solver = LocalSolver::new(&scene.bands, &scene.surroundings, unknowns.clone());
    let nodes = prior::product(&unknowns, &state, 16, 10_000).unwrap();
    let mean: f64 = nodes
        .iter()
        .map(|node| {
            let d = solver.with_counting(&scene.skin, &scene.paint, &node.state, &counting).unwrap().distance;
            node.weight * d * d
        })
        .sum();
    assert!(photons * bound * bound >= mean && photons * bound * bound < 10.0 * mean, "{bound} {mean}");
}

#[test]
fn the_quadrature_converges_as_it_says() {
    let scene = scene();
    let state = scene.state(298.0, 0.9);
    let unknowns =
        free(&[Temperature, Lighting]).prior(Temperature, 3.0).unwrap().prior(Lighting, 0.1).unwrap();
    let at = |order| {
        let bound = scene.bound(&unknowns).with_order(order).unwrap();
        bound.distance(scene.pair(&state), 1e6).unwrap()
    };
    let [coarse, middle, fine] = [8, 16, 32].map(at);
    println!(
        "orders 8, 16, 32: changes {} {} {}",
        coarse.quadrature_change, middle.quadrature_change, fine.quadrature_change
    );
    close(coarse.distance, fine.distance, coarse.quadrature_change.max(1e-12));
    close(middle.distance, fine.distance, 1e-9);
    assert!(fine.quadrature_change < 1e-9 && fine.nodes == 64 * 64);
}

/// At equilibrium nothing is finite without a prior; with one, d_B = ½σ_T‖(e′−e)∂B/∂T‖ per √photon for σ_T
/// → 0.
#[test]
fn a_prior_ends_the_equilibrium_singularity() {
    let scene = scene();
    let state = scene.state(293.15, 1.0);
    let none = free(&[Temperature]);
    assert_eq!(scene.bound(&none).photons_required(scene.pair(&state), 1.0).unwrap(), None);
    assert_eq!(
        scene
            .bound(&none)
            .photons_for_average(scene.pair(&state), 0.8, Distances::Local, &|_, _| ())
            .unwrap(),
        None
    );

    let nu = scene.bands.nodes_cm1();
    let (mut b, mut slope) = (vec![0.0; nu.len()], vec![0.0; nu.len()]);
    planck::photon_radiance_and_slope_into(nu, 293.15, &mut b, &mut slope);
    let information: f64 =
        (0..nu.len()).map(|j| ((scene.paint[j] - scene.skin[j]) * slope[j]).powi(2) / b[j]).sum::<f64>()
            / b.iter().sum::<f64>();
    let required = |sigma: f64| {
        let unknowns = none.clone().prior(Temperature, sigma).unwrap();
        let bound = scene.bound(&unknowns);
        let d = bound.distance(scene.pair(&state), f64::INFINITY).unwrap();
        let photons = bound.photons_required(scene.pair(&state), 1.0).unwrap().unwrap();
        close(photons, d.distance.powi(-2), 0.01);
        (d.distance, photons)
    };
    let (at_two, photons) = required(2.0);
    println!("equilibrium, 2 K: d_B {at_two:.4e}, photons for d = 1 {photons:.4e}");
    close(at_two, information.sqrt(), 0.01);
    for sigma in [0.1, 0.5, 1.0] {
        let (d, narrow) = required(sigma);
        close(d / at_two, sigma / 2.0, 0.01);
        close(narrow / photons, 4.0 / (sigma * sigma), 0.02);
    }
}

/// E[Φ(a|x|)] = ½ + arctan(a)/π over a standard normal x, a = √N c σ_T; c from a state 0.01 K off
/// equilibrium.
#[test]
fn the_averaged_probability_near_equilibrium_is_an_arctangent() {
    let scene = scene();
    let state = scene.state(293.15, 1.0);
    let unknowns = free(&[Temperature]).prior(Temperature, 2.0).unwrap();
    let bound = scene.bound(&unknowns);
    for photons in [1e6, 1e7, 1e8] {
        let c = scene.local(&unknowns, &scene.state(293.16, 1.0), photons) / 0.01;
        let exact = 0.5 + (photons.sqrt() * c * 2.0).atan() / PI;
        let found = bound.average_probability(scene.pair(&state), photons, Distances::Local).unwrap();
        println!(
            "{photons:.0e}: P {:.5}, arctangent {exact:.5}, change {:.1e}",
            found.probability, found.error
        );
        assert!((found.probability - exact).abs() < 2e-3, "{found:?} {exact}");
        assert!(exact > 0.51 && found.probability + found.miss_probability == 1.0);
    }
    let photons_for = |bound: &BayesianBound<'_>| {
        bound.photons_for_average(scene.pair(&state), 0.8, Distances::Local, &|_, _| ()).unwrap().unwrap()
    };
    let found = photons_for(&bound);
    let there = bound.average_probability(scene.pair(&state), found.photons, Distances::Local).unwrap();
    println!("equilibrium, 2 K: photons for an averaged probability of 0.8: {found:?}");
    assert!((there.probability - 0.8).abs() <= 2e-3);
    let exact = photons_for(&bound.clone().with_order(32).unwrap());
    assert!((found.photons / exact.photons - 1.0).abs() <= found.relative_error, "{found:?} {exact:?}");
    let range = StateRange { temperature_k: [200.0, 400.0], ..StateRange::default() };
    let coarse = bound.clone().with_order(6).unwrap();
    let nearest = coarse.average_probability(scene.pair(&state), 1e8, Distances::Nearest(range)).unwrap();
    let local = coarse.average_probability(scene.pair(&state), 1e8, Distances::Local).unwrap();
    assert!((nearest.probability - local.probability).abs() < 0.02, "{nearest:?} {local:?}");
}

/// The lattices against the product rule at high order, whose cost multiplies with the priors: P̄ within the error that is
/// told, which is no more than was asked for, and not by far too large.
#[test]
fn lattices_average_as_product_rules_do() {
    let scene = scene();
    let one = free(&[Temperature, Lighting]).prior(Temperature, 4.0).unwrap();
    let two = one.clone().prior(Lighting, 0.3).unwrap();
    let three = two.with(Gain).prior(Gain, 0.05).unwrap();
    let cut = free(&[Temperature, Lighting]).prior(Lighting, 0.2).unwrap();
    for (unknowns, state, order) in [
        (&one, scene.state(296.0, 0.9), 64),
        (&two, scene.state(298.0, 0.5), 32),
        (&three, scene.state(310.0, 0.6), 12),
        (&cut, scene.state(300.0, 1.0), 64),
    ] {
        let (bound, pair) = (scene.bound(unknowns), scene.pair(&state));
        let product = bound.clone().with_order(order).unwrap();
        for photons in [1e5, 1e7, 1e9] {
            let exact = product.average_probability(pair, photons, Distances::Local).unwrap();
            let mut nodes = 0;
            for tolerance in [1e-2, 1e-3] {
                let bound = bound.clone().with_tolerance(tolerance).unwrap();
                let found = bound.average_probability(pair, photons, Distances::Local).unwrap();
                let off = (found.probability - exact.probability).abs();
                println!(
                    "{photons:.0e} {tolerance}: off by {off:.1e}, told {:.1e}, {} states; product {:.1e}, {} states",
                    found.error, found.nodes, exact.error, exact.nodes
                );
                assert!(exact.error < 1e-4 && found.error <= tolerance, "{exact:?} {found:?}");
                assert!(off <= found.error + exact.error, "{off:e} {found:?}");
                assert!(found.nodes <= 4096 && found.nodes >= nodes);
                nodes = found.nodes;
            }
        }
    }
}

/// Nine unknowns with a prior each: no rule multiplies. Progress is told, and the same seeds give the same bits.
#[test]
fn the_cost_does_not_multiply_with_the_priors() {
    let bands = Bands::uniform(750.0, 1250.0, 25.0).unwrap();
    let object = |temperature_k| EnvironmentObject { temperature_k, emissivity: None };
    let surroundings =
        Surroundings::new(bands.nodes_cm1(), [260.0, 285.0, 293.0, 300.0].map(object).to_vec()).unwrap();
    let state = surroundings.state(305.0, &[0.2, 0.2, 0.2, 0.2]).unwrap();
    let nu = bands.nodes_cm1();
    let skin: Vec<f64> = nu.iter().map(|nu| 0.94 + 0.02 * (nu / 60.0).sin()).collect();
    let paint: Vec<f64> = nu.iter().map(|nu| 0.82 + 0.06 * (nu / 45.0).cos()).collect();
    let mut unknowns = free(&[Temperature, Lighting, Nuisance::EnvironmentTemperature]);
    for (nuisance, sigma) in [(Temperature, 5.0), (Lighting, 0.03), (Nuisance::EnvironmentTemperature, 5.0)] {
        unknowns = unknowns.prior(nuisance, sigma).unwrap();
    }
    let bound = BayesianBound::new(&bands, &surroundings, unknowns);
    let pair = Pair { emissivity: &skin, alternative: &paint, state: &state };
    let told = std::cell::Cell::new((0, 0));
    let progress = |done, total| {
        assert!(done > told.get().0 && done <= total);
        told.set((done, total));
    };
    let ask = |progress: &dyn Fn(usize, usize)| {
        bound.photons_for_average(pair, 0.9, Distances::Local, progress).unwrap().unwrap()
    };
    let found = ask(&progress);
    println!("{found:?}, {:?} states looked at", told.get());
    assert!(told.get().0 == told.get().1 && told.get().0 < 20_000);
    assert!(found.relative_error > 0.0 && found.relative_error < 0.03, "{found:?}");
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    assert_eq!(found, ask(&|_, _| ()));
    let bits = one.install(|| bound.average_probability(pair, 1e6, Distances::Local).unwrap());
    assert_eq!(bits, bound.average_probability(pair, 1e6, Distances::Local).unwrap());
    let hybrid = bound.distance(pair, 1e6).unwrap();
    assert!(hybrid.quadrature_change < 0.02 && hybrid.nodes == 512, "{hybrid:?}");
}

#[test]
fn what_is_no_task_is_refused() {
    let scene = scene();
    let state = scene.state(300.0, 0.5);
    let unknowns = free(&[Temperature]).prior(Temperature, 2.0).unwrap();
    let bound = scene.bound(&unknowns);
    assert!(bound.clone().with_order(1).is_err());
    assert!(bound.distance(scene.pair(&state), 0.0).is_err());
    assert!(bound.distance(scene.pair(&state), f64::NAN).is_err());
    assert!(bound.photons_required(scene.pair(&state), -1.0).is_err());
    assert!(bound.photons_for_average(scene.pair(&state), 0.5, Distances::Local, &|_, _| ()).is_err());
    assert!(bound.distance(scene.pair(&scene.state(1e-3, 0.0)), 1.0).is_err());
    // Wide priors are cut at the physical range.
    let wide = free(&[Temperature, Lighting]).prior(Temperature, 1e4).unwrap().prior(Lighting, 50.0).unwrap();
    let found = scene.bound(&wide).distance(scene.pair(&state), 1e6).unwrap();
    assert!(found.distance.is_finite(), "{found:?}");
}
