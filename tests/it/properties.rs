//! What must hold for the distances of any scene.

use crate::support::scenes::{Inputs, Recipe, Scene, curve, ever_more_unknowns, recipe};
use hadar::fisher::{Counting, Nuisance, Unknowns};
use hadar::identifiability::Status;
use hadar::identifiability::local::{LocalDistance, LocalSolver};
use hadar::identifiability::nearest::{NearestDistance, NearestSolver, StateRange};
use hadar::scene::{Parameter, State};
use hadar::spectrum::{Bands, FilterCurve};
use hadar_testing::seeded;
use nalgebra::DMatrix;
use num_dual::Dual64;
use proptest::prelude::*;

/// The nearest distance is stationary in the state, which is found to about 1e-11.
const SEARCH: f64 = 1e-9;
/// Emissivities 0.1 apart per band leave distances far above this; below it lies rounding.
const FLOOR: f64 = 1e-15;

impl Scene {
    fn local(&self, unknowns: &Unknowns, photons: f64) -> LocalDistance {
        LocalSolver::new(&self.bands, &self.surroundings, unknowns.clone())
            .per_photon(&self.emissivity, &self.alternative, &self.state, photons)
            .unwrap()
    }

    fn nearest(&self, unknowns: &Unknowns, photons: f64) -> NearestDistance {
        NearestSolver::new(&self.bands, &self.surroundings, unknowns.clone(), StateRange::default())
            .per_photon(&self.emissivity, &self.alternative, &self.state, photons)
            .unwrap()
    }

    fn local_counting(&self, unknowns: &Unknowns, counting: &Counting) -> LocalDistance {
        LocalSolver::new(&self.bands, &self.surroundings, unknowns.clone())
            .with_counting(&self.emissivity, &self.alternative, &self.state, counting)
            .unwrap()
    }

    fn nearest_counting(&self, unknowns: &Unknowns, counting: &Counting) -> NearestDistance {
        NearestSolver::new(&self.bands, &self.surroundings, unknowns.clone(), StateRange::default())
            .with_counting(&self.emissivity, &self.alternative, &self.state, counting)
            .unwrap()
    }
}

fn temperature_and_lighting() -> Unknowns {
    Unknowns::new([Nuisance::Temperature, Nuisance::Lighting]).unwrap()
}

fn noiseless(counts_per_radiance: f64) -> Counting {
    Counting { counts_per_radiance, var_added: Vec::new() }
}

/// Whether the nearest state is compared too. With the gain or the temperatures of the surroundings unknown as well as
/// temperature and lighting, the separation has long flat valleys with several ends, and the search promises less.
fn searched(unknowns: &Unknowns) -> bool {
    !unknowns.contains(Nuisance::Gain) && !unknowns.contains(Nuisance::EnvironmentTemperature)
}

/// The two distances agree within `relative`, of the larger.
fn equal(a: f64, b: f64, relative: f64) -> bool {
    (a - b).abs() <= relative * a.abs().max(b.abs()) + FLOOR
}

proptest! {
    #![proptest_config(seeded(20, 60))]

    #[test]
    fn another_unknown_never_raises_a_distance(
        recipe in recipe(),
        order in Just(Nuisance::ALL.to_vec()).prop_shuffle(),
    ) {
        let scene = recipe.scene();
        let (mut local_before, mut nearest_before) = (f64::INFINITY, f64::INFINITY);
        for count in 0..=order.len() {
            let unknowns = Unknowns::new(order.iter().copied().take(count)).unwrap();
            if unknowns.parameters(recipe.objects.len()).len() >= recipe.count {
                break;
            }
            let local = scene.local(&unknowns, f64::INFINITY);
            let slack = 1.0 + local.relative_error + 1e-14;
            prop_assert!(local.distance <= local_before * slack + FLOOR, "{unknowns:?}: local {:e} after {local_before:e}", local.distance);
            local_before = local.distance;
            if searched(&unknowns) {
                let nearest = scene.nearest(&unknowns, f64::INFINITY).distance;
                prop_assert!(nearest <= nearest_before * (1.0 + SEARCH) + FLOOR, "{unknowns:?}: nearest {nearest:e} after {nearest_before:e}");
                nearest_before = nearest;
            }
        }
    }

    /// Identical materials are told by comparison, not by subtraction: the answer is 0, not a small number.
    #[test]
    fn identical_materials_are_at_distance_zero(recipe in recipe()) {
        let mut scene = recipe.scene();
        scene.alternative = scene.emissivity.clone();
        for unknowns in ever_more_unknowns(recipe.count, recipe.objects.len()) {
            let local = scene.local(&unknowns, f64::INFINITY);
            prop_assert_eq!((local.distance, local.status), (0.0, Status::Identical));
            let nearest = scene.nearest(&unknowns, f64::INFINITY);
            prop_assert_eq!(nearest.distance, 0.0);
            prop_assert_eq!(&nearest.state, &scene.state);
        }
    }

    /// Nothing else depends on N: a square root, a sum and a quotient, 1e-13.
    #[test]
    fn shot_noise_distances_grow_as_the_root_of_the_photons(recipe in recipe(), log_photons in 0.0..14.0) {
        let (scene, photons) = (recipe.scene(), 10f64.powf(log_photons));
        for unknowns in ever_more_unknowns(recipe.count, recipe.objects.len()) {
            let local = scene.local(&unknowns, f64::INFINITY);
            let counting = Counting::shot(photons, &scene.bands.weigh(&scene.surroundings.signal(&scene.emissivity, &scene.state)));
            let counted = scene.local_counting(&unknowns, &counting).distance / photons.sqrt();
            prop_assert!(equal(counted, local.distance, 1e-13 + local.relative_error), "local {counted:e} {:e}", local.distance);
            if !searched(&unknowns) {
                continue;
            }
            let (one, many) = (scene.nearest(&unknowns, f64::INFINITY), scene.nearest_counting(&unknowns, &counting));
            prop_assert!(equal(many.distance / photons.sqrt(), one.distance, SEARCH), "nearest {:e} {:e}", many.distance, one.distance);
        }
    }

    /// The definition of the nearest distance, evaluated by a second formula at random states of the alternative, and
    /// at the state that was found.
    #[test]
    fn no_state_is_nearer_than_the_nearest(
        recipe in recipe(),
        trials in proptest::collection::vec((150.0..900.0, 0.0..1.0, 0.0..1.0), 40),
    ) {
        let scene = recipe.scene();
        let unknowns = temperature_and_lighting();
        let nearest = scene.nearest(&unknowns, f64::INFINITY);
        let found = scene.half_separation(&nearest.state);
        // Square roots of whole counts lose what differences keep: 1e-15 absolute.
        prop_assert!(equal(found, nearest.distance, 1e-10), "{found:e} {:e}", nearest.distance);
        let around = nearest.state.temperature_k;
        for (temperature_k, share, lit) in trials {
            let lighting = match scene.state.lighting.len() {
                1 => vec![lit],
                _ => vec![lit * share, lit * (1.0 - share)],
            };
            for temperature_k in [temperature_k, around * (1.0 + 0.02 * (share - 0.5))] {
                let state = State { temperature_k, lighting: lighting.clone(), ..scene.state.clone() };
                let separation = scene.half_separation(&state);
                prop_assert!(nearest.distance <= separation * (1.0 + SEARCH) + FLOOR, "{:e} at {:?}, {separation:e} at {state:?}", nearest.distance, nearest.state);
            }
        }
    }

    /// The paper's S29, formed from the normalised spectrum p = N/ΣN by dual numbers and a Householder factorisation:
    /// J⁰ = Σ ∂p ∂p/p, d₀ = ½‖P⊥ ∂_g p/√p‖. Gain in the set must give the same. What both lose is the rounding
    /// of the scores (1e-15) over what the projection leaves of them.
    #[test]
    fn gain_in_the_set_is_the_normalised_form_of_the_paper(recipe in recipe()) {
        let scene = recipe.scene();
        let unknowns = temperature_and_lighting();
        prop_assume!(recipe.count > 3 + recipe.objects.len());
        let local = scene.local(&unknowns.with(Nuisance::Gain), f64::INFINITY);
        let exact = normalised_distance(&scene);
        let tolerance = 1e-12 + 20.0 * local.relative_error;
        prop_assert!(equal(local.distance, exact, tolerance), "{:e} {exact:e} within {tolerance:e}", local.distance);
    }

    /// A weak prior is none, a strong one is knowledge, and in between less knowledge never helps.
    #[test]
    fn priors_lie_between_ignorance_and_knowledge(recipe in recipe(), log_photons in 4.0..10.0) {
        let (scene, photons) = (recipe.scene(), 10f64.powf(log_photons));
        let free = temperature_and_lighting();
        prop_assume!(recipe.count > 2 + recipe.objects.len());
        let known = Unknowns::new([Nuisance::Lighting]).unwrap();
        let with = |sigma: f64| free.clone().prior(Nuisance::Temperature, sigma).unwrap();
        let (ends, ends_nearest) = (
            [scene.local(&known, photons), scene.local(&free, photons)],
            [scene.nearest(&known, photons), scene.nearest(&free, photons)],
        );
        let sharp = scene.local(&with(1e-12), photons).distance;
        // A prior row of 1e12 over scores of at most 1e8 leaves 1e-8² of them.
        prop_assert!(equal(sharp, ends[0].distance, 1e-9), "known: {sharp:e} {:e}", ends[0].distance);
        let sharp = scene.nearest(&with(1e-9), photons).distance;
        prop_assert!(equal(sharp, ends_nearest[0].distance, 1e-6), "known: {sharp:e} {:e}", ends_nearest[0].distance);
        // What a prior of 10¹² K adds, 1e-12/√N, must vanish beside the distance.
        let vague = scene.local(&with(1e12), photons).distance;
        prop_assert!(equal(vague, ends[1].distance, 1e-9 + ends[1].relative_error), "unknown: {vague:e} {:e}", ends[1].distance);
        let vague = scene.nearest(&with(1e12), photons).distance;
        prop_assert!(equal(vague, ends_nearest[1].distance, 1e-6), "unknown: {vague:e} {:e}", ends_nearest[1].distance);
        let (mut before, mut before_nearest) = (f64::INFINITY, f64::INFINITY);
        for sigma in [1e-4, 1e-2, 1.0, 1e2, 1e4] {
            let local = scene.local(&with(sigma), photons);
            prop_assert!(local.distance <= before * (1.0 + local.relative_error + 1e-12) + FLOOR, "prior {sigma} K");
            let nearest = scene.nearest(&with(sigma), photons).distance;
            prop_assert!(nearest <= before_nearest * (1.0 + SEARCH) + FLOOR, "prior {sigma} K: {nearest:e} after {before_nearest:e}");
            (before, before_nearest) = (local.distance, nearest);
        }
    }

    /// For an alternative that differs by ε of a narrow feature the surfaces are flat, and both distances are one:
    /// the difference is of the order of ε over the share that the unknowns leave of the feature.
    #[test]
    fn the_local_distance_is_the_limit_of_the_nearest_one(
        recipe in recipe(),
        center in 0.2f64..0.8,
        side in prop_oneof![Just(-1.0f64), Just(1.0)],
    ) {
        let mut scene = recipe.scene();
        let unknowns = temperature_and_lighting();
        prop_assume!(recipe.count > 20);
        let (low, high) = scene.bands.range_cm1();
        let middle = low + center * (high - low);
        let ratio = |scene: &mut Scene, epsilon: f64| {
            let bump = |nu: f64| (-0.5 * ((nu - middle) / 25.0).powi(2)).exp();
            let nodes = scene.surroundings.nodes_cm1().to_vec();
            scene.alternative =
                scene.emissivity.iter().zip(&nodes).map(|(e, &nu)| e + side * epsilon * bump(nu)).collect();
            let local = scene.local(&unknowns, f64::INFINITY);
            let left = local.distance / local.distance_no_nuisance;
            (scene.nearest(&unknowns, f64::INFINITY).distance / local.distance, left)
        };
        let (ratio, left) = ratio(&mut scene, 1e-7);
        prop_assume!(left > 1e-3);
        prop_assert!((ratio - 1.0).abs() < 1e-4, "nearest/local = {ratio}, {left:e} left");
    }
}

/// ½‖P⊥ ∂_g p/√p‖ with p the normalised spectrum and P⊥ removing temperature and lighting.
fn normalised_distance(scene: &Scene) -> f64 {
    let widths = scene.bands.widths_cm1();
    let mut columns: Vec<Vec<f64>> = Vec::new();
    let objects = scene.state.lighting.len();
    for which in 0..objects + 2 {
        let mut inputs = Inputs::<Dual64>::of(&scene.state);
        match which {
            0 => inputs.temperature_k = inputs.temperature_k.derivative(),
            k if k <= objects => inputs.lighting[k - 1] = inputs.lighting[k - 1].derivative(),
            _ => inputs.mixing = inputs.mixing.derivative(),
        }
        let counts: Vec<Dual64> = scene.signal(&inputs).iter().zip(&widths).map(|(s, w)| *s * *w).collect();
        let total = counts.iter().fold(Dual64::from(0.0), |sum, count| sum + *count);
        let scores: Vec<f64> =
            counts.iter().map(|count| *count / total).map(|p| p.eps / p.re.sqrt()).collect();
        let norm = scores.iter().map(|s| s * s).sum::<f64>().sqrt();
        // Unit columns, but for the last, whose length is the answer's.
        let scale = if which == objects + 1 { 1.0 } else { norm };
        columns.push(scores.iter().map(|s| s / scale).collect());
    }
    let matrix = DMatrix::from_fn(widths.len(), columns.len(), |row, column| columns[column][row]);
    let r = matrix.qr().r();
    0.5 * r[(objects + 1, objects + 1)].abs()
}

proptest! {
    #![proptest_config(seeded(20, 40))]

    /// A noiseless detector at a fixed exposure: bands can only tell more if there are more of them.
    #[test]
    fn more_bands_never_lower_the_statistical_distance(recipe in recipe(), keep in proptest::collection::vec(any::<bool>(), 600)) {
        let all = recipe.centers();
        let kept: Vec<f64> = all.iter().zip(&keep).filter(|(_, keep)| **keep).map(|(nu, _)| *nu).collect();
        prop_assume!(kept.len() > 4);
        let rows = kept.iter().map(|&nu| (nu, recipe.step_cm1));
        let (few, many) = (recipe.on(Bands::from_rows(rows).unwrap()), recipe.scene());
        never_lower(&few, &many)?;
    }

    /// Ranges are sampled every 1 cm⁻¹, so halves of a 2k cm⁻¹ band sum to it exactly: finer bands of the same light.
    #[test]
    fn finer_bands_never_lower_the_statistical_distance(recipe in recipe(), half in 1u32..10, count in 6u32..30) {
        let width = f64::from(2 * half);
        let edge = |i: u32| 700.0 + f64::from(i) * width;
        let coarse: Vec<(f64, f64)> = (0..count).map(|i| (edge(i), edge(i + 1))).collect();
        let middle = |(low, high): (f64, f64)| 0.5 * (low + high);
        let fine: Vec<(f64, f64)> =
            coarse.iter().flat_map(|&range| [(range.0, middle(range)), (middle(range), range.1)]).collect();
        let coarse = recipe.on(Bands::from_ranges(&coarse).unwrap());
        let fine = recipe.on(Bands::from_ranges(&fine).unwrap());
        prop_assert_eq!(coarse.bands.nodes_cm1(), fine.bands.nodes_cm1());
        never_lower(&coarse, &fine)?;
    }

    /// Two filters of half the transmittance in place of one share its light between them and tell no more and no less.
    #[test]
    fn sharing_the_light_between_equal_bands_changes_nothing(recipe in recipe(), count in 6usize..15) {
        let filters = |transmittance: f64, copies: usize| {
            let curves = (0..count * copies).map(|i| {
                let low = 710.0 + 35.0 * (i / copies) as f64;
                FilterCurve::new(format!("f{i}"), vec![(low, transmittance), (low + 30.0, transmittance)]).unwrap()
            });
            recipe.on(Bands::from_filters(curves.collect()).unwrap())
        };
        let (one, two) = (filters(0.8, 1), filters(0.4, 2));
        for unknowns in ever_more_unknowns(count, recipe.objects.len()) {
            let (a, b) = (one.local(&unknowns, f64::INFINITY), two.local(&unknowns, f64::INFINITY));
            prop_assert!(equal(a.distance, b.distance, 1e-13 + a.relative_error), "local {:e} {:e}", a.distance, b.distance);
            if !searched(&unknowns) {
                continue;
            }
            let (a, b) = (one.nearest(&unknowns, f64::INFINITY), two.nearest(&unknowns, f64::INFINITY));
            prop_assert!(equal(a.distance, b.distance, SEARCH), "nearest {:e} {:e}", a.distance, b.distance);
        }
    }

    /// Radiances per another unit of wavenumber with counts per that radiance: the same counts, the same answers.
    #[test]
    fn the_unit_of_radiance_does_not_matter(recipe in recipe(), log_unit in -12.0..12.0, log_photons in 6.0..12.0, gamma in 0.0..1e4) {
        let unit = 10f64.powf(log_unit);
        let scene = recipe.scene();
        let rows = recipe.centers().into_iter().map(|nu| (nu, recipe.step_cm1 * unit));
        let other = recipe.on(Bands::from_rows(rows).unwrap());
        let signal = scene.counts(&scene.emissivity, &scene.state);
        let mut counting = Counting::shot(10f64.powf(log_photons), &signal);
        counting.var_added = signal.iter().map(|s| gamma * s * counting.counts_per_radiance).collect();
        let mut scaled = counting.clone();
        scaled.counts_per_radiance /= unit;
        for unknowns in ever_more_unknowns(recipe.count, recipe.objects.len()) {
            let (a, b) = (scene.local(&unknowns, f64::INFINITY), other.local(&unknowns, f64::INFINITY));
            prop_assert!(equal(a.distance, b.distance, 1e-13 + a.relative_error));
            let (a, b) = (scene.local_counting(&unknowns, &counting), other.local_counting(&unknowns, &scaled));
            prop_assert!(equal(a.distance, b.distance, 1e-13 + a.relative_error), "{:e} {:e}", a.distance, b.distance);
            if !searched(&unknowns) {
                continue;
            }
            let (a, b) = (scene.nearest_counting(&unknowns, &counting), other.nearest_counting(&unknowns, &scaled));
            prop_assert!(equal(a.distance, b.distance, SEARCH), "{:e} {:e}", a.distance, b.distance);
        }
    }

    #[test]
    fn a_black_target_does_not_see_the_lighting(recipe in recipe(), other in curve()) {
        let mut scene = recipe.scene();
        scene.emissivity = vec![1.0; recipe.count];
        scene.alternative = other.on(scene.bands.nodes_cm1());
        let local = scene.local(&temperature_and_lighting(), f64::INFINITY);
        let lightings: Vec<Parameter> = (0..recipe.objects.len()).map(Parameter::Lighting).collect();
        prop_assert_eq!(&local.dropped, &lightings);
        let known = scene.local(&Unknowns::new([Nuisance::Temperature]).unwrap(), f64::INFINITY);
        prop_assert!(equal(local.distance, known.distance, 1e-14));
        prop_assert!(local.distance > 0.0 && local.status == Status::Ok);
    }

    /// Nothing lights the target: S = e B(T), a change of V has no meaning, and only T is unknown.
    #[test]
    fn no_environment_leaves_only_the_temperature(mut recipe in recipe()) {
        recipe.objects.clear();
        let scene = recipe.scene();
        let local = scene.local(&temperature_and_lighting(), f64::INFINITY);
        let known = scene.local(&Unknowns::new([Nuisance::Temperature]).unwrap(), f64::INFINITY);
        prop_assert_eq!(local.distance, known.distance);
        prop_assert!(local.distance > 0.0 && local.distance <= known.distance_no_nuisance);
        let nearest = scene.nearest(&temperature_and_lighting(), f64::INFINITY);
        prop_assert!(equal(scene.half_separation(&nearest.state), nearest.distance, 1e-10));
        prop_assert!(nearest.distance > 0.0);
    }

    /// T = T₀ all around, however the user splits V = 1 between objects.
    #[test]
    fn in_equilibrium_nothing_can_be_told_apart(recipe in recipe(), parts in 1u32..=9) {
        let mut recipe = recipe.black();
        for object in &mut recipe.objects {
            object.temperature_k = recipe.temperature_k;
        }
        match recipe.objects.as_mut_slice() {
            [one] => one.lighting = 1.0,
            [first, second] => {
                first.lighting = f64::from(parts) / 10.0;
                second.lighting = f64::from(10 - parts) / 10.0;
            }
            _ => unreachable!(),
        }
        let scene = recipe.scene();
        prop_assume!(scene.emissivity != scene.alternative);
        for unknowns in ever_more_unknowns(recipe.count, recipe.objects.len()) {
            let local = scene.local(&unknowns, f64::INFINITY);
            prop_assert_eq!((local.distance, local.status), (0.0, Status::Equilibrium));
            // Factors that add up to 1 but for their last bit leave as much.
            prop_assert!(scene.nearest(&unknowns, f64::INFINITY).distance < 1e-16);
        }
    }
}

/// Both distances of `more` are at least those of `less`, at the same exposure without electronic noise.
fn never_lower(less: &Scene, more: &Scene) -> Result<(), TestCaseError> {
    let counting = noiseless(1e-12);
    let objects = less.state.lighting.len();
    for unknowns in ever_more_unknowns(less.bands.len(), objects) {
        let (a, b) = (less.local_counting(&unknowns, &counting), more.local_counting(&unknowns, &counting));
        let slack = 1e-13 + a.relative_error + b.relative_error;
        prop_assert!(b.distance >= a.distance * (1.0 - slack), "local {:e} to {:e}", a.distance, b.distance);
        if !searched(&unknowns) {
            continue;
        }
        let (a, b) =
            (less.nearest_counting(&unknowns, &counting), more.nearest_counting(&unknowns, &counting));
        prop_assert!(
            b.distance >= a.distance * (1.0 - SEARCH) - FLOOR,
            "nearest {:e} to {:e}",
            a.distance,
            b.distance
        );
    }
    Ok(())
}

/// The recipe's own bands are what the property tests run on; this keeps the strategy honest.
#[test]
fn random_scenes_are_within_what_they_promise() {
    let mut runner = proptest::test_runner::TestRunner::new(seeded(20, 200));
    runner
        .run(&recipe(), |recipe: Recipe| {
            let scene = recipe.scene();
            prop_assert!((5..600).contains(&recipe.count) && scene.bands.len() == recipe.count);
            prop_assert!(scene.emissivity.iter().chain(&scene.alternative).all(|e| (0.0..=1.0).contains(e)));
            prop_assert!(scene.state.lighting.iter().sum::<f64>() <= 1.0);
            Ok(())
        })
        .unwrap();
}
