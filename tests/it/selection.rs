//! Choices of bands and filters against enumeration, closed forms and laws that every choice obeys.

use crate::support::scenes::{Recipe, Scene, recipe};
use hadar::fisher::{Counting, Nuisance, Unknowns};
use hadar::identifiability::local::LocalSolver;
use hadar::identifiability::nearest::{NearestSolver, StateRange};
use hadar::identifiability::selection::{Quality, Scores, best_bands, best_filters, shares_between};
use hadar::spectrum::Bands;
use hadar_testing::seeded;
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;
use std::ops::Range;

/// ½‖P⊥ v‖ of whitened rows (nuisances, v), by a singular value decomposition.
fn half_residual(rows: &[Vec<f64>]) -> f64 {
    let width = rows.first().map_or(1, Vec::len);
    let matrix = DMatrix::from_fn(rows.len(), width - 1, |i, j| rows[i][j]);
    let difference = DVector::from_fn(rows.len(), |i, _| rows[i][width - 1]);
    if width == 1 {
        return 0.5 * difference.norm();
    }
    if rows.len() < width {
        return 0.0;
    }
    let scaled = DMatrix::from_columns(
        &matrix.column_iter().map(|c| c / c.norm().max(f64::MIN_POSITIVE)).collect::<Vec<_>>(),
    );
    let svd = scaled.svd(true, false);
    let u = svd.u.unwrap();
    let mut left = difference;
    for (column, value) in u.column_iter().zip(svd.singular_values.iter()) {
        if *value > 1e-12 {
            left -= column * column.dot(&left);
        }
    }
    0.5 * left.norm()
}

/// A pair as plain numbers.
#[derive(Debug, Clone)]
struct Numbers {
    nuisances: Vec<Vec<f64>>,
    difference: Vec<f64>,
    counts: Vec<f64>,
    var: Vec<f64>,
}

impl Numbers {
    fn scores(&self) -> Scores {
        let Self { nuisances, difference, counts, var } = self.clone();
        Scores::from_columns(nuisances, difference, counts, var).unwrap()
    }

    fn bands(&self) -> usize {
        self.counts.len()
    }

    /// The distance with filters, straight from its definition.
    fn distance(&self, filters: &[Range<usize>]) -> f64 {
        let rows: Vec<Vec<f64>> = filters
            .iter()
            .map(|filter| {
                let noise: f64 = self.var[filter.clone()].iter().sum::<f64>() / filter.len() as f64
                    + self.counts[filter.clone()].iter().sum::<f64>();
                let columns = self.nuisances.iter().chain([&self.difference]);
                columns.map(|c| c[filter.clone()].iter().sum::<f64>() / noise.sqrt()).collect()
            })
            .collect();
        half_residual(&rows)
    }
}

fn least(pairs: &[Numbers], filters: &[Range<usize>]) -> f64 {
    pairs.iter().map(|pair| pair.distance(filters)).fold(f64::INFINITY, f64::min)
}

fn singles(bands: &[usize]) -> Vec<Range<usize>> {
    bands.iter().map(|&w| w..w + 1).collect()
}

/// All ways to take k of n.
fn subsets(n: usize, k: usize) -> Vec<Vec<usize>> {
    (0u32..1 << n)
        .filter(|mask| mask.count_ones() as usize == k)
        .map(|mask| (0..n).filter(|i| mask >> i & 1 == 1).collect())
        .collect()
}

/// All ways to lay at most k filters over bands from `from` to n.
fn layouts(from: usize, n: usize, k: usize) -> Vec<Vec<Range<usize>>> {
    let mut all = vec![vec![]];
    if k > 0 {
        for start in from..n {
            for end in start + 1..=n {
                all.extend(layouts(end, n, k - 1).into_iter().map(|mut rest| {
                    rest.insert(0, start..end);
                    rest
                }));
            }
        }
    }
    all
}

fn pair(bands: usize, nuisances: usize) -> impl Strategy<Value = Numbers> {
    let column = || prop::collection::vec(-1.0..1.0f64, bands);
    (
        prop::collection::vec(column(), nuisances),
        column(),
        prop::collection::vec(0.1..3.0f64, bands),
        prop_oneof![Just(vec![0.0; bands]), prop::collection::vec(0.0..3.0f64, bands)],
    )
        .prop_map(|(nuisances, difference, counts, var)| Numbers { nuisances, difference, counts, var })
}

fn pairs(most: usize) -> impl Strategy<Value = Vec<Numbers>> {
    (4..=most, 0..3usize, 1..5usize)
        .prop_flat_map(|(bands, nuisances, count)| prop::collection::vec(pair(bands, nuisances), count))
}

fn check(quality: &Quality, found: f64, best: f64) {
    // Both by orthogonalisation: some ulp of ‖v‖, which random residuals do not undercut by much.
    assert!((quality.distance - found).abs() <= 1e-9 * found, "{quality:?} {found}");
    assert!(quality.bound >= best * (1.0 - 1e-12), "{quality:?} {best}");
    assert!(found <= best * (1.0 + 1e-12) && quality.distance <= quality.bound);
    // Equal ones may be taken for each other within the share by which a change must help.
    assert!(!quality.exact || found >= best * (1.0 - 1e-8), "{quality:?} {best}");
}

proptest! {
    #![proptest_config(seeded(20, 120))]

    #[test]
    fn bands_against_all_subsets(pairs in pairs(9), k in 1..7usize) {
        let bands = pairs[0].bands();
        let k = k.min(bands);
        let scores: Vec<Scores> = pairs.iter().map(Numbers::scores).collect();
        let choice = best_bands(&scores, k).unwrap();
        prop_assert_eq!(choice.bands.len(), k);
        prop_assert!(choice.bands.windows(2).all(|two| two[0] < two[1]));
        let best = subsets(bands, k).iter().map(|bands| least(&pairs, &singles(bands))).fold(0.0, f64::max);
        check(&choice.quality, least(&pairs, &singles(&choice.bands)), best);
        prop_assert!(choice.quality.exact);
        let all = least(&pairs, &singles(&(0..bands).collect::<Vec<_>>()));
        if k == bands && all > 1e-6 {
            prop_assert!((choice.quality.kept - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn filters_against_all_layouts(pairs in pairs(6), k in 1..4usize) {
        let bands = pairs[0].bands();
        let scores: Vec<Scores> = pairs.iter().map(Numbers::scores).collect();
        let choice = best_filters(&scores, k).unwrap();
        prop_assert!(choice.filters.len() <= k);
        prop_assert!(choice.filters.windows(2).all(|two| two[0].end <= two[1].start));
        let best = layouts(0, bands, k).iter().map(|filters| least(&pairs, filters)).fold(0.0, f64::max);
        check(&choice.quality, least(&pairs, &choice.filters), best);
        prop_assert!(choice.quality.exact);
    }
}

proptest! {
    #![proptest_config(seeded(24, 60))]

    /// What comes with photons adds up over a filter: without the noise of a reading no filters exceed all bands, and the best are
    /// those of summed variances.
    #[test]
    fn filters_sum_what_comes_with_photons(pairs in pairs(6), k in 1..4usize) {
        let of_reading = |pair: &Numbers| {
            let counts = pair.counts.iter().zip(&pair.var).map(|(n, var)| n + var).collect();
            Numbers { counts, var: vec![0.0; pair.bands()], ..pair.clone() }
        };
        let summed: Vec<Numbers> = pairs.iter().map(of_reading).collect();
        let scores: Vec<Scores> =
            pairs.iter().map(|pair| pair.scores().with_photon_noise(&pair.var).unwrap()).collect();
        let choice = best_filters(&scores, k).unwrap();
        let best = layouts(0, pairs[0].bands(), k).iter().map(|filters| least(&summed, filters)).fold(0.0, f64::max);
        check(&choice.quality, least(&summed, &choice.filters), best);
        prop_assert!(choice.quality.kept <= 1.0 + 1e-9, "{:?}", choice.quality);
        let more: Vec<f64> = pairs[0].var.iter().map(|var| var + 1.0).collect();
        prop_assert!(pairs[0].scores().with_photon_noise(&more).is_err());
    }
}

/// Scores of a scene with temperature and lighting unknown; photons and electronic noise per band.
fn scores_of(scene: &Scene, unknowns: &Unknowns, counting: Option<&Counting>) -> Scores {
    let Scene { bands, surroundings, state, emissivity, alternative } = scene;
    Scores::of(bands, surroundings, unknowns, emissivity, alternative, state, counting).unwrap()
}

fn temperature_and_lighting() -> Unknowns {
    Unknowns::new([Nuisance::Temperature, Nuisance::Lighting]).unwrap()
}

/// `count` photons in all, and as much electronic noise in a band as the mean band has photons.
fn camera(scene: &Scene, photons: f64, share: f64) -> Counting {
    let signal = scene.counts(&scene.emissivity, &scene.state);
    let bands = signal.len();
    Counting {
        counts_per_radiance: photons / signal.iter().sum::<f64>(),
        var_added: vec![share * photons / bands as f64; bands],
    }
}

proptest! {
    #![proptest_config(seeded(20, 10))]

    /// All bands: the local distance, with and without a camera, with priors. Fewer: never more, ever less.
    #[test]
    fn random_scenes(recipe in recipe(), noisy in any::<bool>(), sigma in prop::option::of(0.01..3.0f64)) {
        let scene = recipe.scene();
        prop_assume!(scene.bands.len() > 6);
        let mut unknowns = temperature_and_lighting();
        if let Some(sigma) = sigma {
            unknowns = unknowns.prior(Nuisance::Temperature, sigma).unwrap();
        }
        let counting = camera(&scene, 1e6, f64::from(u8::from(noisy)));
        let scores = scores_of(&scene, &unknowns, Some(&counting));
        let mut solver = LocalSolver::new(&scene.bands, &scene.surroundings, unknowns.clone());
        let local =
            solver.with_counting(&scene.emissivity, &scene.alternative, &scene.state, &counting).unwrap();
        let information = scores.information();
        // The rounding of either is what the solver estimates.
        let tolerance = 1e-12 + 4.0 * local.relative_error;
        prop_assert!((information.distance / local.distance - 1.0).abs() < tolerance);
        let pair = [scores];
        let mut before = 0.0;
        for k in [2, 3, 4, 6] {
            let choice = best_bands(&pair, k).unwrap();
            let quality = &choice.quality;
            prop_assert!((quality.distance_all_bands / local.distance - 1.0).abs() < tolerance);
            prop_assert!(quality.distance <= quality.bound);
            prop_assert!(quality.bound <= quality.distance_all_bands * (1.0 + 1e-6));
            prop_assert!(k >= quality.fewest || quality.distance == 0.0);
            prop_assert!(quality.distance >= before * (1.0 - 1e-9), "{k}: {} {before}", quality.distance);
            before = quality.distance;
            let filters = best_filters(&pair, k).unwrap().quality;
            // Bands are filters too.
            prop_assert!(filters.bound >= quality.distance * (1.0 - 1e-9));
            prop_assert!(filters.distance <= filters.bound);
            // Counts that are summed tell no more, unless their noise is shared.
            prop_assert!(noisy || filters.kept <= 1.0 + 1e-9);
        }
    }

    /// What the leave-one-out formula says a band is worth is what is lost without it.
    #[test]
    fn a_band_left_out(recipe in recipe(), band in any::<prop::sample::Index>()) {
        let scene = recipe.scene();
        prop_assume!(scene.bands.len() > 6);
        let band = band.index(scene.bands.len());
        let information = scores_of(&scene, &temperature_and_lighting(), None).information();
        let rows = |bands: &Bands| -> Vec<(f64, f64)> {
            bands.bands().iter().zip(bands.widths_cm1()).map(|(b, width)| (b.center_cm1, width)).collect()
        };
        let mut fewer = rows(&scene.bands);
        fewer.remove(band);
        let other = recipe.on(Bands::from_rows(fewer).unwrap());
        // Per √photon of all bands, not of those that are left.
        let photons = |scene: &Scene| scene.counts(&scene.emissivity, &scene.state).iter().sum::<f64>();
        let left = scores_of(&other, &temperature_and_lighting(), None).information().distance
            * (photons(&other) / photons(&scene)).sqrt();
        let lost = 1.0 - (left / information.distance).powi(2);
        prop_assert!((information.lost_without[band] - lost).abs() < 1e-8, "{lost} {:?}", information.lost_without[band]);
        prop_assert!(information.lost_without[band] >= information.share[band]);
        prop_assert!((information.share.iter().sum::<f64>() - 1.0).abs() < 1e-12);
    }
}

/// A scene of 100 bands to be divided.
fn fine() -> Recipe {
    use proptest::strategy::ValueTree;
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let mut recipe = recipe().new_tree(&mut runner).unwrap().current();
    (recipe.start_cm1, recipe.step_cm1, recipe.count) = (720.0, 5.0, 100);
    recipe
}

/// Bands merged by twos, fours…: with shot noise alone the distance never grows; with a noise per reading
/// far above the shot noise it does, and the best filters beat the bands.
#[test]
fn merged_bands() {
    let scene = fine().scene();
    let unknowns = temperature_and_lighting();
    let merged = |counting: &Counting, by: usize| {
        let scores = scores_of(&scene, &unknowns, Some(counting));
        best_filters(&[scores], 100 / by).unwrap().quality
    };
    let quiet = camera(&scene, 1e8, 0.0);
    let kept: Vec<f64> = [50, 20, 10, 5, 4].map(|by| merged(&quiet, by).kept).into();
    assert!(
        kept.windows(2).all(|two| two[1] >= two[0]) && kept.iter().all(|kept| *kept <= 1.0 + 1e-12),
        "{kept:?}"
    );
    // Noise 10⁴ times the shot noise: 20 filters are read a fifth as often as 100 bands.
    let noisy = camera(&scene, 1e8, 1e4);
    assert!(merged(&noisy, 5).kept > 1.5, "{}", merged(&noisy, 5).kept);
}

/// One line of three bands, depth a, on a flat continuum of unknown level, 2n bands aside. With k = 2m the best
/// choice has as many bands on the line as off it, if there are so many; with j on and l off the distance is
/// ½a√(jl/(j+l)).
#[test]
fn an_absorption_line_on_a_flat_continuum() {
    let a = 0.3;
    let line: Vec<f64> = (0..41).map(|w| if (19..22).contains(&w) { a } else { 0.0 }).collect();
    let pair = [Scores::from_columns(vec![vec![1.0; 41]], line, vec![1.0; 41], vec![0.0; 41]).unwrap()];
    for (k, on) in [(2, 1), (3, 1), (4, 2), (6, 3), (10, 3)] {
        let choice = best_bands(&pair, k).unwrap();
        let (j, l) = (f64::from(on), k as f64 - f64::from(on));
        let expected = 0.5 * a * (j * l / (j + l)).sqrt();
        assert!((choice.quality.distance / expected - 1.0).abs() < 1e-12, "{k}: {choice:?} {expected}");
        assert!(choice.quality.bound < expected * (1.0 + if k == 3 { 0.07 } else { 1e-9 }), "{choice:?}");
    }
    // Two filters, all the line and the longer side of the continuum; three take both sides and keep everything.
    let two = best_filters(&pair, 2).unwrap();
    let expected = 0.5 * a * (3.0 * 19.0 / 22.0_f64).sqrt();
    assert!((two.quality.distance / expected - 1.0).abs() < 1e-12, "{two:?}");
    let three = best_filters(&pair, 3).unwrap();
    assert!((three.quality.kept - 1.0).abs() < 1e-12 && three.quality.exact, "{three:?}");
    assert_eq!(three.filters, [0..19, 19..22, 22..41]);
}

/// Two alternatives seen in different bands: the choice serves both, and required distances shift it.
#[test]
fn a_library_is_served_as_a_whole() {
    let pair = |bands: Range<usize>| {
        let difference = (0..20).map(|w| if bands.contains(&w) { 1.0 } else { 0.0 }).collect();
        Scores::from_columns(vec![], difference, vec![1.0; 20], vec![0.0; 20]).unwrap()
    };
    let both = [pair(0..8), pair(12..20)];
    let choice = best_bands(&both, 6).unwrap();
    assert_eq!(choice.bands.iter().filter(|w| **w < 8).count(), 3);
    assert!((choice.quality.distance - 0.5 * 3f64.sqrt()).abs() < 1e-14 && choice.quality.exact);
    // The second needs √2 times the distance: twice the bands.
    let [one, other] = both;
    let choice = best_bands(&[one.clone(), other.required(2f64.sqrt()).unwrap()], 6).unwrap();
    assert_eq!(choice.bands.iter().filter(|w| **w < 8).count(), 2);
    // A pair that nothing tells apart is left out, and said so.
    let blind = Scores::from_columns(vec![], vec![0.0; 20], vec![1.0; 20], vec![0.0; 20]).unwrap();
    let choice = best_bands(&[blind.clone(), one], 2).unwrap();
    assert_eq!((choice.quality.left_out, choice.quality.limiting_pair), (vec![0], Some(1)));
    let none = best_bands(&[blind], 2).unwrap().quality;
    assert_eq!((none.distance, none.kept, none.limiting_pair), (0.0, 0.0, None));
}

/// Shares of the nearest separation: with the solver's state they add up to the distance it found.
#[test]
fn shares_of_the_nearest_separation() {
    let scene = fine().scene();
    let mut solver = NearestSolver::new(
        &scene.bands,
        &scene.surroundings,
        temperature_and_lighting(),
        StateRange::default(),
    );
    let found =
        solver.per_photon(&scene.emissivity, &scene.alternative, &scene.state, f64::INFINITY).unwrap();
    let (own, other) =
        (scene.counts(&scene.emissivity, &scene.state), scene.counts(&scene.alternative, &found.state));
    let shares = shares_between(&own, &other, None).unwrap();
    let total: f64 = own.iter().sum();
    for (w, share) in shares.iter().enumerate() {
        let part = (own[w].sqrt() - other[w].sqrt()).powi(2) / total / found.distance.powi(2);
        assert!((share - part).abs() < 1e-6, "{share} {part}");
    }
    assert!(shares_between(&own, &own[1..], None).is_err());
}

#[test]
fn mistakes_are_named() {
    let pair = |bands: usize| {
        Scores::from_columns(vec![], vec![1.0; bands], vec![1.0; bands], vec![0.0; bands]).unwrap()
    };
    let message = |result: hadar::Result<_>| {
        result.map(|_: hadar::identifiability::selection::Selection| ()).unwrap_err().to_string()
    };
    assert_eq!(message(best_bands(&[], 1)), "there is no pair to choose bands for; give at least one");
    assert_eq!(
        message(best_bands(&[pair(3)], 4)),
        "number of bands is 4; it must be from 1 to the number of bands, 3"
    );
    assert_eq!(message(best_bands(&[pair(3), pair(4)], 1)), "bands of a pair: 4 values where 3 are needed");
    assert!(best_filters(&[pair(3)], 0).is_err());
    assert!(Scores::from_columns(vec![vec![1.0]], vec![1.0; 2], vec![1.0; 2], vec![0.0; 2]).is_err());
    assert!(Scores::from_columns(vec![], vec![f64::NAN], vec![1.0], vec![0.0]).is_err());
    assert!(Scores::from_columns(vec![], vec![], vec![], vec![]).is_err());
    assert!(pair(2).required(0.0).is_err());
}
