use super::*;
use crate::fisher::{Nuisance, Unknowns};
use crate::identifiability::{detection, linear, local::LocalSolver};
use crate::scene::{EnvironmentObject, Surroundings};
use crate::spectrum::Bands;
use crate::statistics::Statistics;
use rand::SeedableRng;
use rand_distr::{Distribution, Normal, Poisson};
use statrs::function::gamma::ln_gamma;

struct Scene {
    bands: Bands,
    surroundings: Surroundings,
    state: State,
}

fn scene(centers: &[f64], temperature_k: f64) -> Scene {
    let bands = Bands::from_rows(centers.iter().map(|&nu| (nu, 40.0))).unwrap();
    let object = EnvironmentObject { temperature_k: 293.15, emissivity: None };
    let surroundings = Surroundings::new(bands.nodes_cm1(), vec![object]).unwrap();
    let state = surroundings.state(temperature_k, &[0.5]).unwrap();
    Scene { bands, surroundings, state }
}

fn range() -> StateRange {
    StateRange { temperature_k: [280.0, 360.0], lighting: [0.1, 0.9], lighting_sum: 1.0 }
}

fn free(nuisances: &[Nuisance]) -> Unknowns {
    Unknowns::new(nuisances.iter().copied()).unwrap()
}

impl Scene {
    fn detector(
        &self,
        unknowns: &Unknowns,
        statistics: &Statistics,
        mesh: LatticeMesh,
    ) -> LatticeDetector<'_> {
        let (bands, surroundings) = (&self.bands, &self.surroundings);
        LatticeDetector::new(bands, surroundings, unknowns.clone(), range(), statistics.clone())
            .and_then(|detector| detector.with_mesh(mesh))
            .unwrap()
    }

    fn means(&self, emissivity: &[f64], state: &State, counts: f64) -> Vec<f64> {
        self.surroundings.signal(emissivity, state).iter().map(|s| counts * 40.0 * s).collect()
    }

    fn counts(&self, emissivity: &[f64], photons: f64) -> f64 {
        photons / self.means(emissivity, &self.state, 1.0).iter().sum::<f64>()
    }

    /// Every state of the fine mesh of every material, written down once more.
    fn surfaces(&self, library: &[Vec<f64>], counts: f64, nt: usize, nv: usize) -> Vec<Vec<Vec<f64>>> {
        let spaced = |n: usize, low: f64, high: f64| {
            (0..n).map(move |i| low + (high - low) * i as f64 / (n - 1) as f64)
        };
        let of = |emissivity: &Vec<f64>| {
            let mut surface = Vec::new();
            for t in spaced(nt, 280.0, 360.0) {
                for v in spaced(nv, 0.1, 0.9) {
                    let state = self.surroundings.state(t, &[v]).unwrap();
                    surface.push(self.means(emissivity, &state, counts));
                }
            }
            surface
        };
        library.iter().map(of).collect()
    }
}

/// argmax over materials of the largest likelihood over the states, straight from the laws.
fn decide(statistics: &Statistics, surfaces: &[Vec<Vec<f64>>], n: &[f64]) -> usize {
    let best = |surface: &Vec<Vec<f64>>| {
        let likelihood = |means: &Vec<f64>| -> f64 {
            means.iter().zip(n).enumerate().map(|(w, (&m, &n))| statistics.log_likelihood(w, n, m)).sum()
        };
        surface.iter().map(likelihood).fold(f64::NEG_INFINITY, f64::max)
    };
    let best: Vec<f64> = surfaces.iter().map(best).collect();
    (0..best.len()).max_by(|&i, &j| best[i].total_cmp(&best[j])).unwrap()
}

fn ln_mass(statistics: &Statistics, band: usize, n: f64, mean: f64) -> f64 {
    match statistics {
        Statistics::NegativeBinomial { modes } => {
            let m = modes[band];
            ln_gamma(n + m) - ln_gamma(m) - ln_gamma(n + 1.0) + n * (mean / (mean + m)).ln()
                - m * (mean / m).ln_1p()
        }
        _ => n * mean.ln() - mean - ln_gamma(n + 1.0),
    }
}

/// The loops of Algorithm 1 as the paper prints them, over two bands.
#[test]
fn the_papers_loops_give_the_same_vector() {
    let scene = scene(&[850.0, 1150.0], 310.15);
    let library = [vec![0.95, 0.93], vec![0.7, 0.85], vec![0.5, 0.2]];
    let mesh = LatticeMesh { temperatures: 6, lightings: 3, tail: 1e-9, ..LatticeMesh::default() };
    for statistics in [Statistics::Poisson, Statistics::negative_binomial(vec![9.0, 40.0]).unwrap()] {
        let unknowns = free(&[Nuisance::Temperature, Nuisance::Lighting]);
        let photons = 30.0;
        let counts = scene.counts(&library[0], photons);
        let found =
            scene.detector(&unknowns, &statistics, mesh).detect(&library, 0, &scene.state, photons).unwrap();
        let surfaces = scene.surfaces(&library, counts, 11, 5);
        let own = scene.means(&library[0], &scene.state, counts);
        let mut exact = [0.0; 3];
        for n1 in (0..160).map(f64::from) {
            for n2 in (0..90).map(f64::from) {
                let mass = ln_mass(&statistics, 0, n1, own[0]) + ln_mass(&statistics, 1, n2, own[1]);
                exact[decide(&statistics, &surfaces, &[n1, n2])] += mass.exp();
            }
        }
        assert_eq!(found.states, 3 * 55);
        assert!(found.fills_space && found.undecided == 0.0 && found.tail <= 1e-9);
        for (p, exact) in found.probabilities.iter().zip(exact) {
            assert!((p - exact).abs() < found.tail + 1e-11, "{found:?} {exact}");
        }
    }
}

#[test]
fn identical_materials_share_evenly() {
    let scene = scene(&[800.0, 1000.0, 1200.0], 310.15);
    let (unknowns, mesh) = (free(&[Nuisance::Temperature]), LatticeMesh::default());
    let same = vec![0.9, 0.8, 0.7];
    let library = [same.clone(), same.clone()];
    let detector = scene.detector(&unknowns, &Statistics::Poisson, mesh);
    let found = detector.detect(&library, 0, &scene.state, 3000.0).unwrap();
    assert!(found.probabilities.iter().all(|p| (p - 0.5 * (1.0 - found.tail)).abs() < 1e-14), "{found:?}");
    // A third that is far away takes nothing.
    let three = [same.clone(), vec![0.2, 0.9, 0.2], same];
    let found = detector.detect(&three, 2, &scene.state, 30_000.0).unwrap();
    assert!((found.probabilities[0] - 0.5).abs() < 1e-8 && found.probabilities[1] < 1e-8, "{found:?}");
}

#[test]
fn three_bands_far_apart_are_certain() {
    let scene = scene(&[800.0, 1000.0, 1200.0], 310.15);
    let unknowns = free(&[Nuisance::Temperature, Nuisance::Lighting]);
    let library = [vec![0.95, 0.95, 0.95], vec![0.9, 0.3, 0.9]];
    let mesh = LatticeMesh { temperatures: 33, lightings: 17, ..LatticeMesh::default() };
    let found = scene
        .detector(&unknowns, &Statistics::Poisson, mesh)
        .detect(&library, 0, &scene.state, 30_000.0)
        .unwrap();
    assert!(found.probabilities[0] > 1.0 - 1e-8 && !found.fills_space, "{found:?}");
}

/// A Monte Carlo decision over the same states: 4 standard deviations, a false alarm in 16 000.
#[test]
fn a_simulated_decision_is_right_as_often() {
    let scene = scene(&[800.0, 1000.0, 1200.0], 315.0);
    let library = [vec![0.95, 0.9, 0.92], vec![0.8, 0.7, 0.9]];
    let unknowns = free(&[Nuisance::Temperature, Nuisance::Lighting]);
    let mesh = LatticeMesh { temperatures: 11, lightings: 5, cells: 200, ..LatticeMesh::default() };
    let photons = 2000.0;
    let counts = scene.counts(&library[0], photons);
    let surfaces = scene.surfaces(&library, counts, 21, 9);
    let own = scene.means(&library[0], &scene.state, counts);
    for statistics in [Statistics::Poisson, Statistics::gaussian(vec![400.0, 100.0, 0.0]).unwrap()] {
        let found =
            scene.detector(&unknowns, &statistics, mesh).detect(&library, 0, &scene.state, photons).unwrap();
        let mut rng = rand::rngs::ChaCha12Rng::seed_from_u64(4);
        let draws = 3000;
        let mut right = 0;
        for _ in 0..draws {
            let n: Vec<f64> = (0..3)
                .map(|w| match statistics {
                    Statistics::Poisson => Poisson::new(own[w]).unwrap().sample(&mut rng),
                    _ => Normal::new(own[w], statistics.variance(w, own[w]).sqrt()).unwrap().sample(&mut rng),
                })
                .collect();
            right += u32::from(decide(&statistics, &surfaces, &n) == 0);
        }
        let (p, share) = (found.probabilities[0], f64::from(right) / f64::from(draws));
        assert!(p > 0.6 && p < 0.95, "{found:?}");
        assert!((share - p).abs() < 4.0 * (p * (1.0 - p) / f64::from(draws)).sqrt(), "{share} {found:?}");
        let whole = found.probabilities.iter().sum::<f64>() + found.tail;
        assert!((whole - 1.0).abs() < 1e-12, "{whole}");
    }
}

/// Nearly equal materials, two bands, temperature unknown: nearly parallel lines, so Theorem 1 holds. 1 %:
/// the lines' angle and the change of the variance along them.
#[test]
fn nearly_parallel_lines_follow_theorem_one() {
    let scene = scene(&[800.0, 1200.0], 315.0);
    let library = [vec![0.9, 0.9], vec![0.85, 0.9]];
    let unknowns = free(&[Nuisance::Temperature]);
    let mesh = LatticeMesh { temperatures: 800, ..LatticeMesh::default() };
    let photons = 10_000.0;
    let found = scene
        .detector(&unknowns, &Statistics::Poisson, mesh)
        .detect(&library, 0, &scene.state, photons)
        .unwrap();
    let local = LocalSolver::new(&scene.bands, &scene.surroundings, unknowns)
        .per_photon(&library[0], &library[1], &scene.state, f64::INFINITY)
        .unwrap();
    let expected = detection::probability(photons.sqrt() * local.distance);
    assert!(expected > 0.6 && expected < 0.95, "{expected}");
    assert!((found.probabilities[0] - expected).abs() < 0.01, "{found:?} {expected}");
    // Theorem 1 from the same lines' two directions, by secants.
    let counts = scene.counts(&library[0], photons);
    let at = |e: &[f64], t: f64| scene.means(e, &State { temperature_k: t, ..scene.state.clone() }, counts);
    let (own, other) = (at(&library[0], 315.0), at(&library[1], 315.0));
    let warmer = at(&library[0], 315.01);
    let difference = |a: &[f64], b: &[f64]| -> Vec<f64> { a.iter().zip(b).map(|(a, b)| a - b).collect() };
    let sigma: Vec<f64> = own.iter().map(|n| n.sqrt()).collect();
    let theorem = linear::detection(&difference(&other, &own), &[difference(&warmer, &own)], &sigma).unwrap();
    assert!((theorem.probability / expected - 1.0).abs() < 1e-4, "{theorem:?} {expected}");
}

/// Cells of several counts: within the bound that the result gives, and less wrong when finer.
#[test]
fn cells_err_by_no_more_than_they_say() {
    let scene = scene(&[800.0, 1200.0], 315.0);
    let library = [vec![0.9, 0.9], vec![0.85, 0.9]];
    let unknowns = free(&[Nuisance::Temperature]);
    let solve = |cells| {
        let mesh = LatticeMesh { temperatures: 50, cells, ..LatticeMesh::default() };
        scene
            .detector(&unknowns, &Statistics::Poisson, mesh)
            .detect(&library, 0, &scene.state, 4000.0)
            .unwrap()
    };
    let exact = solve(5000);
    assert_eq!(exact.undecided, 0.0);
    for cells in [20, 60] {
        let found = solve(cells);
        let error = (found.probabilities[0] - exact.probabilities[0]).abs();
        assert!(error <= found.undecided && found.undecided < 6.0 / cells as f64, "{found:?} {error}");
    }
}

#[test]
fn threads_change_no_bit() {
    let scene = scene(&[800.0, 1000.0, 1200.0], 315.0);
    let library = [vec![0.95, 0.9, 0.92], vec![0.8, 0.7, 0.9]];
    let mesh = LatticeMesh { temperatures: 9, lightings: 3, ..LatticeMesh::default() };
    let unknowns = free(&[Nuisance::Temperature, Nuisance::Lighting]);
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let detector = scene.detector(&unknowns, &Statistics::Poisson, mesh);
        pool.install(|| detector.detect(&library, 0, &scene.state, 500.0).unwrap())
    };
    assert_eq!(with(1), with(3));
}

/// A prior that is tight makes the unknown known, whatever its range.
#[test]
fn a_tight_prior_takes_the_unknown_away() {
    let scene = scene(&[800.0, 1200.0], 320.0);
    let library = [vec![0.9, 0.9], vec![0.85, 0.9]];
    let mesh = LatticeMesh { temperatures: 17, ..LatticeMesh::default() };
    let solve = |unknowns: &Unknowns| {
        scene
            .detector(unknowns, &Statistics::Poisson, mesh)
            .detect(&library, 0, &scene.state, 4000.0)
            .unwrap()
    };
    let tight = free(&[Nuisance::Temperature]).prior(Nuisance::Temperature, 1e-3).unwrap();
    let known = solve(&free(&[]));
    assert_eq!(known.states, 2);
    assert!((solve(&tight).probabilities[0] - known.probabilities[0]).abs() < 1e-12);
    assert!(solve(&free(&[Nuisance::Temperature])).probabilities[0] < known.probabilities[0] - 0.01);
}

#[test]
fn what_cannot_be_meshed_is_refused() {
    let four = scene(&[800.0, 900.0, 1000.0, 1100.0], 300.0);
    let poisson = Statistics::Poisson;
    assert!(
        LatticeDetector::new(&four.bands, &four.surroundings, free(&[]), range(), poisson.clone()).is_err()
    );
    let two = scene(&[800.0, 1200.0], 300.0);
    let new = |unknowns, range| {
        LatticeDetector::new(&two.bands, &two.surroundings, unknowns, range, poisson.clone())
    };
    assert!(new(free(&[Nuisance::EnvironmentTemperature]), range()).is_err());
    assert!(new(free(&[]), StateRange { temperature_k: [300.0, 200.0], ..range() }).is_err());
    let detector = new(free(&[Nuisance::Temperature]), range()).unwrap();
    assert!(detector.clone().with_mesh(LatticeMesh { temperatures: 0, ..LatticeMesh::default() }).is_err());
    assert!(detector.clone().with_mesh(LatticeMesh { tail: 0.5, ..LatticeMesh::default() }).is_err());
    assert!(detector.clone().with_mesh(LatticeMesh { cells: usize::MAX, ..LatticeMesh::default() }).is_err());
    let both = new(free(&[Nuisance::Temperature, Nuisance::Lighting]), range()).unwrap();
    let huge = LatticeMesh { temperatures: 100_000, lightings: 100_000, ..LatticeMesh::default() };
    assert!(both.with_mesh(huge).unwrap().detect(&[vec![0.5; 2]], 0, &two.state, 1.0).is_err());
    assert!(detector.detect(&[vec![0.5; 2]], 1, &two.state, 10.0).is_err());
    assert!(detector.detect(&[vec![0.5; 2]], 0, &two.state, 1e30).is_err());
    assert!(detector.detect(&[vec![0.5; 3]], 0, &two.state, 10.0).is_err());
}

/// Nothing unknown but the gain, over a factor 2 either way: the loops once more.
#[test]
fn gains_are_meshed_evenly_in_the_logarithm() {
    let scene = scene(&[850.0, 1150.0], 310.15);
    let library = [vec![0.95, 0.93], vec![0.7, 0.95]];
    let mesh = LatticeMesh { gains: 3, ..LatticeMesh::default() };
    let found = scene
        .detector(&free(&[Nuisance::Gain]), &Statistics::Poisson, mesh)
        .detect(&library, 0, &scene.state, 60.0)
        .unwrap();
    let counts = scene.counts(&library[0], 60.0);
    let means = |e: &Vec<f64>| scene.means(e, &scene.state, counts);
    let gains = |e: &Vec<f64>| -> Vec<Vec<f64>> {
        (-2..=2).map(|k| means(e).iter().map(|n| n * 0.5_f64.exp2().powi(k)).collect()).collect()
    };
    let surfaces: Vec<Vec<Vec<f64>>> = library.iter().map(gains).collect();
    let own = means(&library[0]);
    let mut exact = 0.0;
    for n1 in (0..130).map(f64::from) {
        for n2 in (0..90).map(f64::from) {
            let mass =
                ln_mass(&Statistics::Poisson, 0, n1, own[0]) + ln_mass(&Statistics::Poisson, 1, n2, own[1]);
            exact += if decide(&Statistics::Poisson, &surfaces, &[n1, n2]) == 0 { mass.exp() } else { 0.0 };
        }
    }
    assert!(found.states == 10 && (found.probabilities[0] - exact).abs() < 2e-9, "{found:?} {exact}");
}

#[test]
fn lighting_stays_within_its_sum() {
    let bands = Bands::from_rows([(800.0, 40.0), (1000.0, 40.0), (1200.0, 40.0)]).unwrap();
    let object = |t| EnvironmentObject { temperature_k: t, emissivity: None };
    let surroundings = Surroundings::new(bands.nodes_cm1(), vec![object(260.0), object(300.0)]).unwrap();
    let state = surroundings.state(310.0, &[0.3, 0.5]).unwrap();
    let states = |unknowns: Unknowns| {
        let mesh = LatticeMesh { lightings: 5, ..LatticeMesh::default() };
        LatticeDetector::new(&bands, &surroundings, unknowns, StateRange::default(), Statistics::Poisson)
            .and_then(|detector| detector.with_mesh(mesh))
            .and_then(|detector| detector.detect(&[vec![0.9; 3]], 0, &state, 100.0))
            .unwrap()
            .states
    };
    // Steps of 1/8: pairs with a sum of at most 1, or the first of two whose sum is 0.8.
    assert_eq!(states(free(&[Nuisance::Lighting])), 45);
    assert_eq!(states(free(&[Nuisance::Lighting]).lighting_total(Some(0.8)).unwrap()), 7);
}
