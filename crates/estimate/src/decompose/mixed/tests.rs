use super::*;
use crate::decompose::library_error::tests::Scene;
use crate::decompose::maps::Maps;
use crate::decompose::model::Model;
use crate::decompose::{LibraryError, Options, Setting, decompose, flag};
use hadar::cube::{Cube, MemoryCube, Shape};
use hadar::demand::Skipping;
use hadar::random::generator;
use rand_distr::{Distribution, Poisson, Uniform};

const PRIOR: f64 = 0.1;
/// Temperatures of the scene's setting.
const RANGE_K: [f64; 2] = [270.0, 335.0];

fn maps(scene: &Scene, counts: &[f64], options: &Options) -> Maps {
    let bands = scene.bands.len();
    let shape = Shape::new(1, counts.len() / bands, bands).unwrap();
    let cube = Cube::F64(Box::new(MemoryCube::new(shape, counts.to_vec()).unwrap()));
    scene.with(|setting| decompose(setting, options, &cube, &|_| ()).unwrap())
}

fn asked(mixed: Option<f64>) -> Options {
    Options { mixed, ..Options::default() }
}

/// What a drawn pixel is: materials, share of the first, temperatures.
type Truth = ([usize; 2], f64, [f64; 2]);

/// Counts of pixels of two surfaces, shares, temperatures and lightings drawn from their prior within these temperatures.
fn drawn(
    scene: &Scene,
    materials: usize,
    pixels: usize,
    seed: u64,
    range_k: [f64; 2],
) -> (Vec<f64>, Vec<Truth>) {
    let mut random = generator(seed, 0);
    let (mut counts, mut truth) = (Vec::new(), Vec::new());
    let unit = Uniform::new(0.0, 1.0).unwrap();
    for i in 0..pixels {
        let ms = [i % materials, (i + 1 + (i / materials) % (materials - 1)) % materials];
        let mut at = || unit.sample(&mut random);
        let f = LEAST + (1.0 - 2.0 * LEAST) * at();
        let t = [0, 1].map(|_| range_k[0] + (range_k[1] - range_k[0]) * at());
        let v = [0, 1].map(|_| at());
        let [first, second] = [0, 1].map(|p| scene.mean(ms[p], t[p], v[p])[0].clone());
        let mean = first * f + second * (1.0 - f);
        counts.extend(mean.iter().map(|n| Poisson::new(*n).unwrap().sample(&mut random)));
        truth.push((ms, f, t));
    }
    (counts, truth)
}

const LEAST: f64 = parts::LEAST_SHARE;

/// −2 ln of a mean likelihood over all states of two surfaces, at the middles of a grid of five dimensions, and of one.
fn integrated(scene: &Scene, ms: &[usize], n: &[f64]) -> f64 {
    const STEPS: [usize; 5] = [14, 14, 14, 10, 10];
    let [low, high] = RANGE_K;
    let middle = |i: usize, of: usize| (i as f64 + 0.5) / of as f64;
    let surface = |m: usize, t: usize, of_t: usize, v: usize, of_v: usize| {
        scene.mean(m, low + (high - low) * middle(t, of_t), middle(v, of_v))[0].clone()
    };
    let deviance = |mean: &dyn Fn(usize) -> f64| -> f64 {
        n.iter().enumerate().map(|(w, n)| 2.0 * (n * (n / mean(w)).ln() - (n - mean(w)))).sum()
    };
    let mut costs = Vec::new();
    if let [m] = ms {
        for (t, v) in (0..200).flat_map(|t| (0..50).map(move |v| (t, v))) {
            let own = surface(*m, t, 200, v, 50);
            costs.push(deviance(&|w| own[w]));
        }
    } else {
        let all = |m: usize, t: usize, v: usize| -> Vec<_> {
            (0..t).flat_map(|i| (0..v).map(move |j| (i, j))).map(|(i, j)| surface(m, i, t, j, v)).collect()
        };
        let (first, second) = (all(ms[0], STEPS[1], STEPS[3]), all(ms[1], STEPS[2], STEPS[4]));
        for f in (0..STEPS[0]).map(|i| LEAST + (1.0 - 2.0 * LEAST) * middle(i, STEPS[0])) {
            for a in &first {
                costs.extend(second.iter().map(|b| deviance(&|w| f * a[w] + (1.0 - f) * b[w])));
            }
        }
    }
    let least = costs.iter().copied().fold(f64::INFINITY, f64::min);
    let sum: f64 = costs.iter().map(|cost| (-0.5 * (cost - least)).exp()).sum();
    least - 2.0 * (sum / costs.len() as f64).ln()
}

/// Mean likelihoods against sums over grids, of one surface and of two: ln of them within 0.75 where a grid resolves them.
#[test]
fn mean_likelihoods_are_those_of_a_grid() {
    let mut compared = 0;
    for counts in [30.0, 300.0] {
        let scene = Scene::new(3, 9, counts);
        let mut seen = scene.draw(3, 0.0, 7).0;
        seen.extend(drawn(&scene, 3, 4, 9, RANGE_K).0);
        scene.with(|setting| {
            let model = Model::new(setting).unwrap();
            let mut room = parts::Room::default();
            for n in seen.chunks(9) {
                let mut padded = vec![1.0; model.width];
                padded[..9].copy_from_slice(n);
                for ms in [[0, 1], [1, 2]] {
                    let of_two = start(&model, ms, [300.0, 300.0]);
                    let of_one = start(&model, [ms[0]], [300.0]);
                    for parts in [&of_two[..], &of_one[..]] {
                        let found = most_probable(&model, parts, &padded, f64::INFINITY, &mut room).unwrap();
                        let whole = integrated(&scene, &ms[..parts.len()], n);
                        if whole < 30.0 {
                            compared += 1;
                            let off = found.cost - whole;
                            assert!(
                                off.abs() < 1.5,
                                "{counts}, {} parts: {} is not {whole}",
                                parts.len(),
                                found.cost
                            );
                        }
                    }
                }
            }
        });
    }
    assert!(compared > 45, "{compared}");
}

/// Pixels drawn from the prior: as many hold two surfaces as their probabilities say, also where they are all but sure.
#[test]
fn probabilities_are_those_of_what_is_there() {
    for counts in [1e3, 1e4, 1e5] {
        let scene = Scene::new(4, 31, counts);
        let mut random = generator(3, 3);
        let unit = Uniform::new(0.0, 1.0).unwrap();
        let (two, _) = drawn(&scene, 4, 300, 11, RANGE_K);
        let mut seen = two;
        for i in 0..2700 {
            let mut at = || unit.sample(&mut random);
            let mean = scene.mean(i % 4, RANGE_K[0] + (RANGE_K[1] - RANGE_K[0]) * at(), at())[0].clone();
            seen.extend(mean.iter().map(|n| Poisson::new(*n).unwrap().sample(&mut random)));
        }
        let [before, after] = [None, Some(PRIOR)].map(|mixed| maps(&scene, &seen, &asked(mixed)));
        let bins = [0.0, 0.02, 0.2, 0.8, 0.98, 1.0 + 1e-6];
        for ends in bins.windows(2) {
            let of: Vec<usize> =
                (0..3000).filter(|i| (ends[0]..ends[1]).contains(&f64::from(after.mixed[*i]))).collect();
            let expected: f64 = of.iter().map(|i| f64::from(after.mixed[*i])).sum();
            let found = of.iter().filter(|i| **i < 300).count();
            let sigma = (expected * (1.0 - expected / of.len().max(1) as f64)).max(0.0).sqrt();
            assert!(
                (expected - found as f64).abs() < 3.0 * sigma + 2.0,
                "{counts}, {ends:?}: {expected} expected of {}, {found} found",
                of.len()
            );
        }
        // A decision is only ever taken back.
        for i in (0..3000).filter(|i| after.is_decided(*i)) {
            assert!(before.is_decided(i) && before.material[i] == after.material[i]);
        }
        let decided = |m: &Maps| (0..300).filter(|i| m.is_decided(*i)).count();
        assert!(4 * decided(&after) < decided(&before), "{} of {}", decided(&after), decided(&before));
    }
}

/// Two surfaces at temperatures of a street: their pair is found, shares and temperatures are within their deviations, and single ones stay.
#[test]
fn two_surfaces_are_told_with_their_shares_and_temperatures() {
    for (counts, least_told, least_kept) in [(1e4, 230, 250), (1e5, 280, 290), (1e6, 290, 295)] {
        let scene = Scene::new(6, 41, counts);
        let (seen, truth) = scene.draw(300, 0.0, 7);
        let after = maps(&scene, &seen, &asked(Some(PRIOR)));
        let kept =
            (0..300).filter(|i| after.is_decided(*i) && usize::from(after.material[*i]) == truth[*i].0);
        assert!(kept.count() >= least_kept, "{counts}");
        let is_two = |m: &Maps, i: usize| m.material[i] == NO_MATERIAL && m.candidates[i] == 1;
        assert_eq!((0..300).filter(|i| is_two(&after, *i)).count(), 0, "{counts}");
        let (seen, truth) = drawn(&scene, 6, 300, 9, [285.0, 315.0]);
        let after = maps(&scene, &seen, &asked(Some(PRIOR)));
        let (mut told, mut right, mut held, mut low) = (0, 0, [0, 0, 0], 0);
        for (i, (ms, f, t)) in truth.iter().enumerate().filter(|(i, _)| is_two(&after, *i)) {
            told += 1;
            let found: [usize; 2] = std::array::from_fn(|p| usize::from(after.mixed_material[2 * i + p]));
            assert_ne!(after.flags[i] & flag::NO_FIT, 0);
            low += usize::from(after.p_value[i] < 0.1);
            assert!(!after.is_decided(i) && after.mixed_share[2 * i] >= 0.5);
            let turned = found == [ms[1], ms[0]];
            if found == *ms || turned {
                right += 1;
                let (share, t) = if turned { (1.0 - f, [t[1], t[0]]) } else { (*f, *t) };
                let holds = |x: f32, sigma: f32, truth: f64| {
                    usize::from((f64::from(x) - truth).abs() < 1.96 * f64::from(sigma))
                };
                held[0] += holds(after.mixed_share[2 * i], after.mixed_share[2 * i + 1], share);
                for p in 0..2 {
                    let at = 2 * i + p;
                    held[1 + p] +=
                        holds(after.mixed_temperature_k[at], after.mixed_temperature_sigma_k[at], t[p]);
                }
            }
        }
        assert!(told >= least_told && right as f64 > 0.96 * f64::from(told), "{counts}: {right} of {told}");
        // Their p-values are those of a right model: a tenth is below a tenth.
        assert!((0.04..0.17).contains(&(low as f64 / f64::from(told))), "{counts}: {low} of {told}");
        // Surfaces of a street, with deviations from a prior that is wider: they hold more often, and a mode that is bent less.
        assert!(held.iter().all(|held| *held as f64 > 0.9 * right as f64), "{counts}: {held:?} of {right}");
    }
}

/// A fit that is given up would have cost more than was asked, but for one in a hundred.
#[test]
fn nothing_is_given_up_that_would_count() {
    let (mut asked, mut lost) = (0, 0);
    for counts in [1e3, 1e4, 1e5, 1e6] {
        let scene = Scene::new(5, 41, counts);
        let (mut seen, _) = drawn(&scene, 5, 60, 13, RANGE_K);
        seen.extend(scene.draw(20, 0.0, 7).0);
        scene.with(|setting| {
            let model = Model::new(setting).unwrap();
            let mut room = parts::Room::default();
            for n in seen.chunks(41) {
                let mut padded = vec![1.0; model.width];
                padded[..41].copy_from_slice(n);
                for ms in (0..5).flat_map(|a| (a + 1..5).map(move |b| [a, b])) {
                    let from = start(&model, ms, [300.0, 300.0]);
                    let whole = most_probable(&model, &from, &padded, f64::INFINITY, &mut room).unwrap();
                    // What fits; what costs nearly too much is told roughly.
                    if whole.chi_square > 150.0 {
                        continue;
                    }
                    for (more, rough) in [(8.0, 8.0), (30.0, 0.5)] {
                        let found = most_probable(&model, &from, &padded, whole.cost + more, &mut room);
                        asked += 1;
                        lost +=
                            usize::from(found.is_none_or(|found| (found.cost - whole.cost).abs() > rough));
                    }
                }
            }
        });
    }
    assert!(asked > 2000 && 100 * lost <= asked, "{lost} of {asked}");
}

/// Bounds and starts that are left out change nothing that is told.
#[test]
fn what_is_skipped_changes_nothing() {
    for counts in [1e3, 1e5] {
        let scene = Scene::new(6, 41, counts);
        let mut seen = scene.draw(40, 0.0, 7).0;
        seen.extend(drawn(&scene, 6, 60, 9, RANGE_K).0);
        let [some, all] = [Skipping::On, Skipping::Off]
            .map(|skipping| maps(&scene, &seen, &Options { skipping, ..asked(Some(PRIOR)) }));
        assert_eq!(
            (&some.material, &some.flags, &some.candidates),
            (&all.material, &all.flags, &all.candidates)
        );
        assert_eq!(some.mixed_material, all.mixed_material);
        for (a, b) in some.mixed.iter().zip(&all.mixed) {
            assert!((a - b).abs() < 1e-3, "{a} is not {b}");
        }
    }
}

/// What may be there without the hypothesis may be there with it, and the categories of both parts besides: it excludes no person.
#[test]
fn two_surfaces_exclude_no_category() {
    let (mut told, mut parts) = (0, 0);
    for counts in [1e3, 1e4, 1e5, 1e6] {
        let scene = Scene::new(4, 41, counts);
        let (mut seen, truth) = drawn(&scene, 4, 150, 9, RANGE_K);
        seen.extend(scene.draw(50, 0.0, 7).0);
        let of = |other, mixed| {
            let options = Options { categories: vec![0b001, 0b011, 0b010, 0b100], other, ..asked(mixed) };
            maps(&scene, &seen, &options)
        };
        let before = of(None, None);
        for after in [of(None, Some(PRIOR)), of(Some(PRIOR), None), of(Some(PRIOR), Some(PRIOR))] {
            for i in 0..200 {
                let (without, with) = (before.possible(i), after.possible(i));
                assert_eq!(without.at_95 & !with.at_95, 0, "{counts}, {i}");
                assert_eq!(without.at_99 & !with.at_99, 0, "{counts}, {i}");
                let is_any = with.at_95 == u64::MAX;
                assert!(is_any || with.common_95 & !without.common_95 == 0, "{counts}, {i}");
                assert_eq!(with.at_95 & !with.at_99, 0);
            }
        }
        let after = of(None, Some(PRIOR));
        let of = |m: usize| [0b001, 0b011, 0b010, 0b100][m];
        for (i, (ms, ..)) in truth.iter().enumerate() {
            if after.material[i] == NO_MATERIAL && after.candidates[i] == 1 {
                told += 1;
                parts += usize::from((of(ms[0]) | of(ms[1])) & !after.possible(i).at_95 == 0);
            }
        }
    }
    assert!(told > 300 && parts as f64 > 0.97 * f64::from(told), "{parts} of {told}");
}

#[test]
fn what_is_impossible_is_refused() {
    let scene = Scene::new(2, 9, 1e3);
    let bands = scene.bands.len();
    let refused = |scene: &Scene, options: &Options| {
        let cube =
            Cube::F64(Box::new(MemoryCube::new(Shape::new(1, 1, bands).unwrap(), vec![1e3; bands]).unwrap()));
        scene.with(|setting| decompose(setting, options, &cube, &|_| ()).unwrap_err().to_string())
    };
    for wrong in [0.0, 1.0, -0.1, f64::NAN] {
        assert!(refused(&scene, &asked(Some(wrong))).contains("two surfaces"));
    }
    assert!(refused(&scene, &Options { other: Some(0.5), ..asked(Some(0.5)) }).contains("0.5"));
    let many: Vec<Vec<f64>> = (0..=MOST_MIXED).map(|m| vec![0.3 + 0.01 * m as f64; bands]).collect();
    let cube =
        Cube::F64(Box::new(MemoryCube::new(Shape::new(1, 1, bands).unwrap(), vec![1e3; bands]).unwrap()));
    let error = scene.with(|setting| {
        let setting = Setting { library: &many, ..*setting };
        decompose(&setting, &asked(Some(0.1)), &cube, &|_| ()).unwrap_err().to_string()
    });
    assert!(error.contains("65 materials"), "{error}");
    let library_error = Some(LibraryError { relative: 0.01, correlation_cm1: 50.0 });
    assert!(
        refused(&scene, &Options { library_error, ..asked(Some(0.1)) }).contains("errors of the library")
    );
}
