//! Classes of several spectra: the worst pair against all pairs, mixtures against random ones.

use crate::support::scenes::radiance;
use hadar::demand::Skipping;
use hadar::fisher::{Counting, Nuisance, Unknowns};
use hadar::identifiability::mixture::Mixtures;
use hadar::identifiability::multi::{Classes, LibraryScene};
use hadar::identifiability::nearest::{NearestSolver, StateRange};
use hadar::scene::{EnvironmentObject, State, Surroundings};
use hadar::spectrum::Bands;
use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};

/// A random scene with two classes of surfaces.
struct Case {
    bands: Bands,
    surroundings: Surroundings,
    state: State,
    targets: Vec<Vec<f64>>,
    alternatives: Vec<Vec<f64>>,
    range: StateRange,
    counts_per_radiance: f64,
    var: f64,
}

/// A smooth emissivity about a level that members of a class share.
fn member(random: &mut ChaCha8Rng, level: f64, count: usize) -> Vec<f64> {
    let waves: Vec<(f64, f64)> = (1..=4)
        .map(|_| (random.random_range(0.0..0.3 * (1.0 - level)), random.random_range(0.0..6.3)))
        .collect();
    (0..count)
        .map(|i| {
            let t = i as f64 / count as f64;
            let wave =
                waves.iter().enumerate().map(|(k, (a, phase))| a * (3.1 * (k + 1) as f64 * t + phase).cos());
            (level + wave.sum::<f64>()).clamp(0.02, 1.0)
        })
        .collect()
}

impl Case {
    fn random(seed: u64, members: usize) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let count = random.random_range(12..80);
        let bands = Bands::from_rows(
            (0..count).map(|i| (720.0 + 530.0 * i as f64 / count as f64, 530.0 / count as f64)),
        )
        .unwrap();
        let objects = (0..1 + seed as usize % 2)
            .map(|_| EnvironmentObject { temperature_k: random.random_range(250.0..310.0), emissivity: None })
            .collect::<Vec<_>>();
        let lighting = vec![0.6 / objects.len() as f64; objects.len()];
        let surroundings = Surroundings::new(bands.nodes_cm1(), objects).unwrap();
        let state = surroundings.state(random.random_range(290.0..330.0), &lighting).unwrap();
        let levels = [random.random_range(0.85..0.97), random.random_range(0.4..0.95)];
        let [targets, alternatives] =
            levels.map(|level| (0..members).map(|_| member(&mut random, level, count)).collect::<Vec<_>>());
        let range = StateRange { temperature_k: [250.0, 400.0], ..StateRange::default() };
        let counts_per_radiance = 10.0_f64.powf(random.random_range(-17.0..-14.0));
        let var = random.random_range(0.0..1e5);
        Self { bands, surroundings, state, targets, alternatives, range, counts_per_radiance, var }
    }

    fn scene<'a>(&'a self, unknowns: &'a Unknowns) -> LibraryScene<'a> {
        LibraryScene {
            bands: &self.bands,
            surroundings: &self.surroundings,
            unknowns,
            range: self.range,
            state: &self.state,
            tolerance: Some(1e-6),
        }
    }

    fn counting(&self) -> Counting {
        Counting {
            counts_per_radiance: self.counts_per_radiance,
            var_added: vec![self.var; self.bands.len()],
        }
    }

    /// Half the separation of two surfaces, straight from its definition: statistical, and per √photon of the first.
    fn separations(&self, own: &[f64], other: &[f64], state: &State) -> [f64; 2] {
        let (nodes, widths) = (self.bands.nodes_cm1(), self.bands.widths_cm1());
        let counts = |e: &[f64], state: &State| -> Vec<f64> {
            (0..nodes.len())
                .map(|j| {
                    let lit: f64 = state
                        .lighting
                        .iter()
                        .zip(&state.environment_k)
                        .map(|(v, t)| v * radiance(nodes[j], *t))
                        .sum();
                    widths[j] * (e[j] * radiance(nodes[j], state.temperature_k) + (1.0 - e[j]) * lit)
                })
                .collect()
        };
        let (a, b) = (counts(own, &self.state), counts(other, state));
        let square = |kappa: f64, v: f64| -> f64 {
            a.iter().zip(&b).map(|(a, b)| ((kappa * a + v).sqrt() - (kappa * b + v).sqrt()).powi(2)).sum()
        };
        [square(self.counts_per_radiance, self.var).sqrt(), (square(1.0, 0.0) / a.iter().sum::<f64>()).sqrt()]
    }
}

fn slices(spectra: &[Vec<f64>]) -> Vec<&[f64]> {
    spectra.iter().map(Vec::as_slice).collect()
}

fn random_mixture(random: &mut ChaCha8Rng, spectra: &[Vec<f64>]) -> Vec<f64> {
    // Exponentials, most of them small: corners, edges and the middle all come up.
    let shares: Vec<f64> = spectra.iter().map(|_| (-random.random::<f64>().ln()).powi(3)).collect();
    let total: f64 = shares.iter().sum();
    (0..spectra[0].len()).map(|j| spectra.iter().zip(&shares).map(|(e, p)| p / total * e[j]).sum()).collect()
}

#[test]
fn no_random_mixture_is_nearer_than_is_proved_and_none_much_nearer_than_was_found() {
    for seed in 0..24 {
        let case = Case::random(seed, 3 + seed as usize % 3);
        let unknowns = Unknowns::new([Nuisance::Temperature, Nuisance::Lighting]).unwrap();
        let scene = case.scene(&unknowns);
        let (targets, alternatives) = (slices(&case.targets), slices(&case.alternatives));
        let counting = case.counting();
        for (which, counting) in [Some(&counting), None].into_iter().enumerate() {
            let mixtures =
                Mixtures { scene: &scene, targets: &targets, alternatives: &alternatives, counting };
            let found = mixtures.nearest(1e-3, f64::INFINITY).unwrap();
            // What was found is what its own state says.
            let mixed = |members: &[Vec<f64>], shares: &[f64]| -> Vec<f64> {
                (0..members[0].len())
                    .map(|j| members.iter().zip(shares).map(|(e, p)| p * e[j]).sum())
                    .collect()
            };
            let pair = [mixed(&case.targets, &found.target), mixed(&case.alternatives, &found.alternative)];
            let own = case.separations(&pair[0], &pair[1], &found.state)[which];
            assert!((own / found.distance - 1.0).abs() < 1e-6, "seed {seed}: {own} {found:?}");
            assert!(found.lower <= found.distance);
            let mut random = ChaCha8Rng::seed_from_u64(1000 + seed);
            let mut solver =
                NearestSolver::new(&case.bands, &case.surroundings, unknowns.clone(), case.range);
            let mut least = f64::INFINITY;
            for _ in 0..150 {
                let own = random_mixture(&mut random, &case.targets);
                let other = random_mixture(&mut random, &case.alternatives);
                let nearest = match counting {
                    Some(counting) => solver.with_counting(&own, &other, &case.state, counting),
                    None => solver.per_photon(&own, &other, &case.state, f64::INFINITY),
                };
                least = least.min(nearest.unwrap().distance);
            }
            println!(
                "{seed} {which} found {:.5e} lower {:.4} random {:.4} boxes {}",
                found.distance,
                found.lower / found.distance,
                least / found.distance,
                found.boxes
            );
            assert!(least >= found.lower, "seed {seed}: {least} {found:?}");
            assert!(least >= 0.999 * found.distance, "seed {seed}: {least} {found:?}");
        }
    }
}

/// The distance of every pair, one by one and in full.
fn every_pair(case: &Case, unknowns: &Unknowns, counting: Option<&Counting>) -> Vec<f64> {
    let mut found = Vec::new();
    for own in &case.targets {
        for other in &case.alternatives {
            let mut solver =
                NearestSolver::new(&case.bands, &case.surroundings, unknowns.clone(), case.range);
            let nearest = match counting {
                Some(counting) => solver.with_counting(own, other, &case.state, counting),
                None => solver.per_photon(own, other, &case.state, f64::INFINITY),
            };
            found.push(nearest.unwrap().distance);
        }
    }
    found
}

#[test]
fn the_worst_pair_and_those_without_any_member_are_those_of_all_pairs_one_by_one() {
    let mut skipped = 0;
    for seed in 0..16 {
        let mut case = Case::random(seed, 6);
        case.alternatives.pop();
        let unknowns = Unknowns::new([Nuisance::Temperature, Nuisance::Lighting]).unwrap();
        let scene = case.scene(&unknowns);
        let (targets, alternatives) = (slices(&case.targets), slices(&case.alternatives));
        let classes = Classes { scene: &scene, targets: &targets, alternatives: &alternatives };
        let countings = vec![case.counting(); targets.len()];
        for counting in [Some(countings.as_slice()), None] {
            let brute = every_pair(&case, &unknowns, counting.map(|each| &each[0]));
            let mut ranked = brute.clone();
            ranked.sort_by(f64::total_cmp);
            let required = counting.map(|_| ranked[ranked.len() / 3] * 1.5);
            let found = classes.distances(counting, required, Skipping::On, &|_, _| ()).unwrap();
            let all = classes.distances(counting, required, Skipping::Off, &|_, _| ()).unwrap();
            assert_eq!(found.targets(), targets.len());
            for (i, (pair, exact)) in found.pairs.iter().zip(&brute).enumerate() {
                // A search without a proof may miss the nearest state; a proof can not: the greater one is wrong.
                assert!(pair.lower <= exact * (1.0 + 1e-6), "seed {seed}, pair {i}: {pair:?} {exact}");
                let full = all.pairs[i].distance.expect("all are searched");
                assert!(full <= exact * (1.0 + 1e-9), "seed {seed}, pair {i}: {full} {exact}");
                if let Some(distance) = pair.distance {
                    assert!((distance / full - 1.0).abs() < 1e-9, "seed {seed}, pair {i}: {distance} {full}");
                }
                if let Some(required) = required {
                    let surely = pair.distance.unwrap_or(pair.lower) >= required;
                    assert_eq!(surely, full >= required, "seed {seed}, pair {i}: {pair:?} {full} {required}");
                }
            }
            skipped += found.pairs.iter().filter(|pair| pair.distance.is_none()).count();
            let least = |kept: &dyn Fn(usize, usize) -> bool| {
                let each = all.pairs.iter().enumerate().filter(|(i, _)| kept(i / 5, i % 5));
                each.map(|(_, pair)| pair.distance.unwrap()).fold(f64::INFINITY, f64::min)
            };
            let decisive =
                |pair: &hadar::identifiability::multi::MemberPair| pair.distance.unwrap_or(pair.lower);
            let of = |kept: &dyn Fn(usize, usize) -> bool| {
                let (a, b) = found.worst(decisive, kept).unwrap();
                decisive(found.pair(a, b).unwrap())
            };
            assert!((of(&|_, _| true) / least(&|_, _| true) - 1.0).abs() < 1e-9, "seed {seed}");
            for member in 0..6 {
                let without = |a: usize, _: usize| a != member;
                assert!((of(&without) / least(&without) - 1.0).abs() < 1e-9, "seed {seed} without {member}");
            }
            for member in 0..5 {
                let without = |_: usize, b: usize| b != member;
                assert!((of(&without) / least(&without) - 1.0).abs() < 1e-9, "seed {seed} without {member}");
            }
        }
    }
    assert!(skipped > 100, "only {skipped} pairs were skipped");
}
