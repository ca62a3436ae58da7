//! Proofs at extremes, held against states that are known to be there: no proof may say that they are not.

use hadar::fisher::{Counting, Nuisance, Unknowns};
use hadar::identifiability::nearest::{Nearer, NearestSolver, StateRange};
use hadar::scene::{EnvironmentObject, State, Surroundings};
use hadar::spectrum::Bands;

const ALL: [Nuisance; 4] =
    [Nuisance::Temperature, Nuisance::Lighting, Nuisance::Gain, Nuisance::EnvironmentTemperature];

fn unknowns(set: usize) -> Unknowns {
    Unknowns::new((0..4).filter(|i| set >> i & 1 == 1).map(|i| ALL[i])).unwrap()
}

/// Eleven bands, and objects of these temperatures around the target.
struct Place {
    bands: Bands,
    surroundings: Surroundings,
}

impl Place {
    fn new(objects_k: &[f64]) -> Self {
        let bands = Bands::uniform(800.0, 1200.0, 40.0).unwrap();
        let object = |&temperature_k: &f64| EnvironmentObject { temperature_k, emissivity: None };
        let surroundings =
            Surroundings::new(bands.nodes_cm1(), objects_k.iter().map(object).collect()).unwrap();
        Self { bands, surroundings }
    }

    fn wave(&self, mean: f64, height: f64, step: f64, start: f64) -> Vec<f64> {
        (0..self.bands.nodes_cm1().len()).map(|i| mean + height * (step * i as f64 + start).sin()).collect()
    }

    fn signal(&self, emissivity: &[f64], state: &State) -> Vec<f64> {
        self.bands.weigh(&self.surroundings.signal(emissivity, state))
    }

    fn solver(&self, set: usize, range: StateRange) -> NearestSolver<'_> {
        NearestSolver::new(&self.bands, &self.surroundings, unknowns(set), range)
    }
}

/// Distance between two signals, written down without the crate.
fn distance(own: &[f64], other: &[f64], counting: &Counting) -> f64 {
    let square = own.iter().zip(other).enumerate().map(|(w, (a, b))| {
        let [a, b] = [a, b].map(|signal| counting.counts_per_radiance * signal);
        let sum = (a + counting.var_added(w)).sqrt() + (b + counting.var_added(w)).sqrt();
        if sum > 0.0 { ((a - b) / sum).powi(2) } else { 0.0 }
    });
    square.sum::<f64>().sqrt()
}

/// Noise of any height: what is left of the counts beside it is never taken for nothing.
#[test]
fn noise_far_above_the_counts_hides_no_state() {
    let place = Place::new(&[280.0]);
    let state = place.surroundings.state(310.0, &[0.5]).unwrap();
    let mut proved = 0;
    for set in [2, 4, 5, 6, 12] {
        for exponent in (0..30).step_by(3) {
            for share in [1.0, 1e-2, 1e-4, 1e-6] {
                let own = place.wave(0.6, 0.2, 0.9, 0.3);
                let other = place.wave(0.7, 0.15, 0.7, 1.0);
                let other: Vec<f64> = own.iter().zip(&other).map(|(a, b)| a + share * (b - a)).collect();
                let signal = place.signal(&own, &state);
                let mut counting = Counting::shot(1e6, &signal);
                let var = 1e6 / signal.len() as f64 * 10f64.powi(exponent);
                counting.var_added = (0..signal.len()).map(|w| var * (1.0 + 0.1 * w as f64)).collect();
                let found = place
                    .solver(set, StateRange::default())
                    .proving(1e-3)
                    .with_counting(&own, &other, &state, &counting)
                    .unwrap();
                let there = distance(&signal, &place.signal(&other, &found.state), &counting);
                // Of the difference of two counts no more is known here than this share.
                let counts = 1e6 / signal.len() as f64;
                let own_rounding = 1e-9 + 5e-15 * counts / (there * (counts + var).sqrt());
                let within = found.lower <= there * (1.0 + own_rounding);
                assert!(within, "{set} 1e{exponent} {share}: {found:?} {there:e}");
                proved += usize::from(found.lower > 0.9 * there);
                for factor in [1.0 + 1e-6, 1.05, 1.5] {
                    let nearer = place
                        .solver(set, StateRange::default())
                        .nearer_than(&own, &other, &state, &counting, factor * there, None)
                        .unwrap();
                    assert_ne!(nearer, Nearer::Nowhere, "{set} 1e{exponent} {share} {factor}: {there:e}");
                }
            }
        }
    }
    assert!(proved > 100, "{proved}");
}

/// Without an unknown temperature there is but one box, and nothing to halve.
#[test]
fn one_box_that_does_not_suffice_is_an_answer() {
    let place = Place::new(&[325.5]);
    for set in [2, 4, 6] {
        for seed in 0..40 {
            let phase = f64::from(seed);
            let state = place.surroundings.state(215.0 + phase, &[0.5]).unwrap();
            let (own, other) = (place.wave(0.6, 0.3, 0.9, phase), place.wave(0.5, 0.3, 0.7, 2.0 * phase));
            let signal = place.signal(&own, &state);
            let counting = Counting::shot(1e8, &signal);
            let mut solver = place.solver(set, StateRange::default()).proving(1e-6);
            let found = solver.with_counting(&own, &other, &state, &counting).unwrap();
            let there = distance(&signal, &place.signal(&other, &found.state), &counting);
            for factor in [0.5, 0.9, 1.0 - 1e-6, 1.0 - 1e-10, 1.0 - 1e-13, 1.0, 1.0 + 1e-6, 1.3] {
                let limit = factor * there;
                let nearer = solver.nearer_than(&own, &other, &state, &counting, limit, None).unwrap();
                assert!(factor <= 1.0 || nearer != Nearer::Nowhere, "{set} {seed} {factor}");
                assert!(factor > 0.95 || nearer == Nearer::Nowhere, "{set} {seed} {factor} {nearer:?}");
            }
        }
    }
}

/// A state that is found is one that is allowed, also where the target's own is not.
#[test]
fn states_keep_to_the_lower_ends_of_the_lighting_and_to_its_sum() {
    let place = Place::new(&[250.0, 290.0, 310.0]);
    for (low, sum) in [(0.05, 0.95), (0.2, 0.7), (0.3, 0.8)] {
        let range = StateRange { lighting: [low, 0.9], lighting_sum: sum, ..StateRange::default() };
        // All at once can have no more than this.
        let low = low.min(sum / 3.0);
        for set in [2, 3, 6, 7] {
            for seed in 0..12 {
                let phase = f64::from(seed);
                let lighting = [[0.0, 0.98, 0.01], [0.33, 0.33, 0.33], [0.0, 0.0, 0.0]][seed as usize % 3];
                let state = place.surroundings.state(300.0, &lighting).unwrap();
                let (own, other) = (place.wave(0.6, 0.3, 0.9, phase), place.wave(0.5, 0.3, 0.7, 2.0 * phase));
                let counting = Counting::shot(1e8, &place.signal(&own, &state));
                let mut solver = place.solver(set, range).proving(1e-3);
                let nearest = solver.with_counting(&own, &other, &state, &counting).unwrap().state;
                let inside = nearest.lighting.iter().all(|v| *v >= low * (1.0 - 1e-12) && *v <= 0.9);
                let total: f64 = nearest.lighting.iter().sum();
                assert!(inside && total <= sum * (1.0 + 1e-12), "{set} {seed}: {nearest:?}");
            }
        }
    }
}

/// Materials that differ in their last digits: what rounding adds to a distance is not proved.
#[test]
fn rounding_of_a_distance_is_not_proved() {
    let place = Place::new(&[280.0]);
    let dark = place.surroundings.state(310.0, &[0.0]).unwrap();
    let mut nowhere = 0;
    for delta in [1e-15, 1e-14, 1e-13, 1e-12, 1e-10, 1e-7] {
        for seed in 0..40 {
            let own = place.wave(0.6, 0.2, 0.9, f64::from(seed));
            let factor = 0.8 + 3e-3 * f64::from(seed);
            let ripple = place.wave(1.0, delta, 1.3, 0.0);
            let other: Vec<f64> = own.iter().zip(&ripple).map(|(e, ripple)| e * factor * ripple).collect();
            let signal = place.signal(&own, &dark);
            let counting = Counting::shot(delta.powi(-2), &signal);
            let mut solver = place.solver(4, StateRange::default()).proving(1e-3);
            let found = solver.with_counting(&own, &other, &dark, &counting).unwrap();
            // With a gain near the best, (G f − e)/e exactly, and the rest of it fitted.
            let rows: Vec<f64> =
                own.iter().zip(&other).map(|(e, f)| found.state.gain.mul_add(*f, -*e) / e).collect();
            let photons: Vec<f64> = signal.iter().map(|s| counting.counts_per_radiance * s).collect();
            let mean =
                rows.iter().zip(&photons).map(|(r, n)| r * n).sum::<f64>() / photons.iter().sum::<f64>();
            let square: f64 = rows.iter().zip(&photons).map(|(r, n)| 0.25 * n * (r - mean).powi(2)).sum();
            let there = square.sqrt();
            assert!(found.lower <= there * (1.0 + 10.0 * delta), "{delta} {seed}: {found:?} {there}");
            for factor in [1.0 + 1e-6, 1.0001, 1.01, 1.3] {
                for known in [None, Some(&found)] {
                    let limit = (factor + 10.0 * delta) * there;
                    let nearer = solver.nearer_than(&own, &other, &dark, &counting, limit, known).unwrap();
                    assert_ne!(nearer, Nearer::Nowhere, "{delta} {seed} {factor}");
                }
            }
            let less = solver.nearer_than(&own, &other, &dark, &counting, 0.9 * there, Some(&found)).unwrap();
            nowhere += usize::from(less == Nearer::Nowhere);
        }
    }
    assert!(nowhere > 100, "{nowhere}");
}

/// Light of any brightness, where a range allows it, is not taken for dark.
#[test]
fn a_cold_object_may_be_as_bright_as_its_range_allows() {
    let place = Place::new(&[280.0]);
    let state = place.surroundings.state(310.0, &[0.5]).unwrap();
    let range = StateRange { lighting: [0.0, 1e100], lighting_sum: 1e100, ..StateRange::default() };
    for cold_k in [6.0, 8.0, 11.0, 13.0, 20.0] {
        let other = place.wave(0.5, 0.1, 0.9, 0.0);
        let mut bright = State { environment_k: vec![cold_k], lighting: vec![0.0], ..state.clone() };
        let unlit = place.surroundings.signal(&other, &bright);
        let light = place.surroundings.object_signal(0, &bright);
        bright.lighting = vec![0.2 * unlit[0] / ((1.0 - other[0]) * light[0])];
        let lit = place.surroundings.signal(&other, &bright);
        let [mirror, black] = [0.0, 1.0].map(|e| place.surroundings.signal(&vec![e; unlit.len()], &state));
        let own: Vec<f64> = (0..lit.len())
            .map(|j| {
                let like = (lit[j] - mirror[j]) / (black[j] - mirror[j]) + 1e-5 * (j as f64).sin();
                like.clamp(0.0, 1.0)
            })
            .collect();
        let signal = place.signal(&own, &state);
        let counting = Counting::shot(1e8, &signal);
        let there = distance(&signal, &place.signal(&other, &bright), &counting);
        let found =
            place.solver(10, range).proving(1e-3).with_counting(&own, &other, &state, &counting).unwrap();
        assert!(found.lower <= there * (1.0 + 1e-9), "{cold_k}: {found:?} {there:e}");
        let nearer =
            place.solver(10, range).nearer_than(&own, &other, &state, &counting, 1.1 * there, None).unwrap();
        assert_ne!(nearer, Nearer::Nowhere, "{cold_k}: {there:e}");
    }
}
