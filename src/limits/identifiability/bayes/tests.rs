use super::*;
use crate::fisher::Counting;
use crate::fisher::Nuisance::{self, Gain, Lighting, Temperature};
use crate::identifiability::local::LocalSolver;
use crate::planck;
use crate::scene::{EnvironmentObject, State};
use rand::RngExt;
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
    let space = PriorSpace::new(&unknowns, &state, &StateRange::default()).unwrap();
    let nodes = space.product(16, 10_000).unwrap();
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
    let average = scene.bound(&none).photons_for_average(scene.pair(&state), 0.8, &|_, _| ()).unwrap();
    assert_eq!(average, None);

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

/// P* of two classes with one band or two, their states on a fine grid: ½ + ¼∫|p₀ − p₁| by the midpoint rule.
fn by_quadrature(own: &[Vec<f64>], other: &[Vec<f64>], weights: &[f64]) -> f64 {
    let all = || own.iter().chain(other);
    let ends = |d: usize| {
        let low = all().map(|x| x[d]).fold(f64::INFINITY, f64::min) - 6.0;
        let high = all().map(|x| x[d]).fold(f64::NEG_INFINITY, f64::max) + 6.0;
        let cells = ((high - low) / 0.25).ceil();
        (low, (high - low) / cells, cells as usize)
    };
    let [(x0, dx, nx), (y0, dy, ny)] = [0, 1].map(ends);
    let mut grid = vec![[0.0; 2]; nx * ny];
    let norm = dx * dy / (2.0 * PI);
    for (class, states) in [own, other].iter().enumerate() {
        for (state, weight) in states.iter().zip(weights) {
            let near = |at: f64, start: f64, step: f64, n: usize| {
                let cell = |to: f64| (((to - start) / step).max(0.0) as usize).min(n);
                cell(at - 6.5)..cell(at + 6.5)
            };
            for i in near(state[0], x0, dx, nx) {
                let x = x0 + (i as f64 + 0.5) * dx - state[0];
                for j in near(state[1], y0, dy, ny) {
                    let y = y0 + (j as f64 + 0.5) * dy - state[1];
                    grid[i * ny + j][class] += norm * weight * (-0.5 * (x * x + y * y)).exp();
                }
            }
        }
    }
    0.5 + 0.25 * grid.iter().map(|[p, q]| (p - q).abs()).sum::<f64>()
}

/// The bracket holds the Bayes test's probability, found by quadrature over all readings of two bands, and is narrow; the
/// photons for that probability are bracketed by what was asked with. Temperature alone has a prior.
#[test]
fn the_bracket_holds_what_quadrature_over_all_readings_finds() {
    let mut rng = ChaCha8Rng::seed_from_u64(40);
    for scene in 0..12 {
        let bands = Bands::uniform(800.0, 1150.0, 350.0).unwrap();
        let mut uniform = |low: f64, high: f64| rng.random_range(low..high);
        let object = EnvironmentObject { temperature_k: uniform(270.0, 300.0), emissivity: None };
        let surroundings = Surroundings::new(bands.nodes_cm1(), vec![object.clone()]).unwrap();
        let emissivities: [Vec<f64>; 2] =
            std::array::from_fn(|_| bands.nodes_cm1().iter().map(|_| uniform(0.3, 0.98)).collect());
        let near = if scene % 3 == 0 { object.temperature_k } else { uniform(280.0, 310.0) };
        let state =
            surroundings.state(near, &[if scene % 3 == 0 { 1.0 } else { uniform(0.2, 1.0) }]).unwrap();
        let sigma = uniform(0.5, 6.0);
        let unknowns = free(&[Temperature]).prior(Temperature, sigma).unwrap();
        let bound = BayesianBound::new(&bands, &surroundings, unknowns);
        let pair = Pair { emissivity: &emissivities[0], alternative: &emissivities[1], state: &state };
        let photons = 10.0_f64.powf(uniform(3.0, 5.5));
        let total: f64 = bands.weigh(&surroundings.signal(&emissivities[0], &state)).iter().sum();
        let counting = Counting { counts_per_radiance: photons / total, var_added: Vec::new() };
        let steps: Vec<f64> = (0..1201).map(|i| -6.0 + 0.01 * f64::from(i)).collect();
        let weights: Vec<f64> = steps.iter().map(|z| (-0.5 * z * z).exp()).collect();
        let sum: f64 = weights.iter().sum();
        let weights: Vec<f64> = weights.iter().map(|weight| weight / sum).collect();
        let readings = emissivities.each_ref().map(|emissivity| {
            let of = |z: &f64| {
                let moved = surroundings.state(state.temperature_k + sigma * z, &state.lighting).unwrap();
                let signal = bands.weigh(&surroundings.signal(emissivity, &moved));
                signal.iter().map(|s| 2.0 * (counting.counts_per_radiance * s).sqrt()).collect::<Vec<f64>>()
            };
            steps.iter().map(of).collect::<Vec<_>>()
        });
        let exact = by_quadrature(&readings[0], &readings[1], &weights);
        let found = bound.average_probability(pair, &counting).unwrap();
        let lower = found.lower.unwrap();
        println!(
            "{photons:.2e}, {sigma:.1} K: {exact:.5} in {lower:.5} to {:.5}, {} states",
            found.upper, found.states
        );
        assert!(lower <= exact && exact <= found.upper, "{found:?} {exact}");
        assert!(found.upper - lower < 0.02, "{found:?}");
        if !(0.55..0.998).contains(&exact) {
            continue;
        }
        let needed = bound.photons_for_average(pair, exact, &|_, _| ()).unwrap().unwrap();
        println!("    photons {:.3e} to {:.3e}", needed.lower, needed.upper.unwrap());
        assert!(needed.lower <= photons && photons <= needed.upper.unwrap(), "{needed:?}");
    }
}

/// Where all is known, or as good as known, it is the law of two points; and of equal materials nothing.
#[test]
fn without_priors_an_average_is_the_law_of_two_points() {
    let scene = scene();
    let state = scene.state(315.0, 0.6);
    let pair = scene.pair(&state);
    let counting = |photons: f64| Counting {
        counts_per_radiance: photons / scene.bound(&free(&[])).photon_radiance(pair).unwrap(),
        var_added: Vec::new(),
    };
    let signal = |emissivity: &[f64]| scene.bands.weigh(&scene.surroundings.signal(emissivity, &state));
    let one = detection::half_separation(
        &signal(&scene.skin),
        &signal(&scene.paint),
        &Counting { counts_per_radiance: 1.0, var_added: Vec::new() },
    ) / signal(&scene.skin).iter().sum::<f64>().sqrt();
    let known = scene.bound(&free(&[]));
    let narrow =
        free(&[Temperature, Lighting]).prior(Temperature, 1e-7).unwrap().prior(Lighting, 1e-9).unwrap();
    let narrow = scene.bound(&narrow);
    for d in [0.7, 1.0, 2.5] {
        let photons = (d / one).powi(2);
        assert!(photons > FEW_PHOTONS, "{photons}");
        let exact = detection::probability(d);
        let point = known.average_probability(pair, &counting(photons)).unwrap();
        assert!(
            (point.upper - exact).abs() < 1e-5 && (point.lower.unwrap() - exact).abs() < 1e-5,
            "{point:?}"
        );
        let found = narrow.average_probability(pair, &counting(photons)).unwrap();
        let lower = found.lower.unwrap();
        println!("d = {d}: {exact:.5} in {lower:.5} to {:.5}", found.upper);
        assert!(lower <= exact && exact <= found.upper && found.upper - lower < 0.01, "{found:?} {exact}");
        for bound in [&known, &narrow] {
            let needed = bound.photons_for_average(pair, exact, &|_, _| ()).unwrap().unwrap();
            let upper = needed.upper.unwrap();
            assert!(needed.lower <= photons * 1.0001 && photons <= upper * 1.0001, "{needed:?} {photons}");
            assert!(upper / needed.lower < 1.2, "{needed:?}");
        }
    }
    let same = Pair { alternative: &scene.skin, ..pair };
    let wide = scene.bound(&free(&[Temperature]).prior(Temperature, 3.0).unwrap());
    let found = wide.average_probability(same, &counting(1e6)).unwrap();
    assert!(found.lower == Some(0.5) && found.upper < 0.51, "{found:?}");
    // No number suffices, or none that is known, beyond what the digits of equal spectra tell.
    let needed = wide.photons_for_average(same, 0.8, &|_, _| ()).unwrap();
    assert!(needed.is_none_or(|needed| needed.upper.is_none() && needed.lower > 1e15), "{needed:?}");
}

/// What has no prior is the adversary's: the limit is no higher than where it is known, no test is promised anything, and with a
/// range that leaves it nothing it is the limit of what is known. Either material may be the target. Wide priors are cut.
#[test]
fn limits_of_averages_are_in_order() {
    let scene = scene();
    let state = scene.state(305.0, 0.7);
    let pair = scene.pair(&state);
    let total = scene.bound(&free(&[])).photon_radiance(pair).unwrap();
    let counting = Counting { counts_per_radiance: 3e4 / total, var_added: Vec::new() };
    let alone = free(&[Temperature]).prior(Temperature, 2.0).unwrap();
    let known = scene.bound(&alone).average_probability(pair, &counting).unwrap();
    let lit = alone.with(Lighting);
    let open = scene.bound(&lit).average_probability(pair, &counting).unwrap();
    println!("known {known:?}, open {open:?}");
    assert!(open.lower.is_none() && open.upper < known.lower.unwrap(), "{open:?} {known:?}");
    let shut = StateRange { lighting: [0.7, 0.7], ..StateRange::default() };
    let shut = scene.bound(&lit).within(shut).average_probability(pair, &counting).unwrap();
    assert!((shut.upper - known.upper).abs() < 0.01, "{shut:?} {known:?}");
    let needed = scene.bound(&lit).photons_for_average(pair, 0.9, &|_, _| ()).unwrap().unwrap();
    assert!(needed.upper.is_none() && needed.lower > 3e4, "{needed:?}");
    let turned = Pair { emissivity: pair.alternative, alternative: pair.emissivity, state: &state };
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    assert_eq!(known, one.install(|| scene.bound(&alone).average_probability(pair, &counting).unwrap()));
    let other = scene.bound(&alone).average_probability(turned, &counting).unwrap();
    assert!(
        other.lower.unwrap() <= known.upper && known.lower.unwrap() <= other.upper,
        "{other:?} {known:?}"
    );
    let wide = free(&[Temperature, Lighting]).prior(Temperature, 1e4).unwrap().prior(Lighting, 50.0).unwrap();
    let found = scene.bound(&wide).average_probability(pair, &counting).unwrap();
    println!("wide {found:?}");
    assert!(found.lower.unwrap() <= found.upper && found.upper <= 1.0);
    // Noise only makes it worse, and a handful of photons has the rigorous limit alone.
    let noisy = Counting { var_added: vec![1e4; scene.bands.len()], ..counting.clone() };
    assert!(scene.bound(&alone).average_probability(pair, &noisy).unwrap().upper < known.lower.unwrap());
    let few = Counting { counts_per_radiance: 20.0 / total, var_added: Vec::new() };
    let few = scene.bound(&alone).average_probability(pair, &few).unwrap();
    assert!(few.lower.is_none() && few.upper > 0.5 && few.upper < known.upper, "{few:?}");
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
    let ask =
        |progress: &dyn Fn(usize, usize)| bound.photons_for_average(pair, 0.9, progress).unwrap().unwrap();
    let found = ask(&progress);
    println!("{found:?}, {:?} lattices looked at", told.get());
    assert!(found.lower <= found.upper.unwrap() && found.upper.unwrap() < 4.0 * found.lower, "{found:?}");
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
    assert!(bound.photons_for_average(scene.pair(&state), 0.5, &|_, _| ()).is_err());
    assert!(bound.distance(scene.pair(&scene.state(1e-3, 0.0)), 1.0).is_err());
    let away = StateRange { temperature_k: [400.0, 500.0], ..StateRange::default() };
    let away = bound.clone().within(away).photons_for_average(scene.pair(&state), 0.8, &|_, _| ());
    assert!(away.unwrap_err().to_string().contains("outside the range"));
    // Wide priors are cut at the physical range.
    let wide = free(&[Temperature, Lighting]).prior(Temperature, 1e4).unwrap().prior(Lighting, 50.0).unwrap();
    let found = scene.bound(&wide).distance(scene.pair(&state), 1e6).unwrap();
    assert!(found.distance.is_finite(), "{found:?}");
}
