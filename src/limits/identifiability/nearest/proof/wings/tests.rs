//! Bounds of intervals against states drawn at random within them, for each kind of walk, with all the amplitudes that are free.

use super::super::prover::{Memory, Prover, merged_into};
use super::Alone;
use crate::fisher::{Nuisance, Unknowns};
use crate::identifiability::nearest::residual::{Comparison, Metric};
use crate::identifiability::nearest::{NearestSolver, StateRange};
use crate::random::generator;
use crate::scene::{EnvironmentObject, State, Surroundings};
use crate::spectrum::Bands;
use rand::RngExt;

const SETS: [&[Nuisance]; 6] = [
    &[Nuisance::Temperature],
    &[Nuisance::Temperature, Nuisance::Lighting],
    &[Nuisance::EnvironmentTemperature],
    &[Nuisance::Temperature, Nuisance::Gain],
    &[Nuisance::Temperature, Nuisance::Lighting, Nuisance::Gain],
    &[Nuisance::Lighting, Nuisance::EnvironmentTemperature],
];

#[test]
fn no_state_of_an_interval_is_nearer_than_its_bound() {
    let mut random = generator(53, 0);
    let mut draw = move || random.random::<f64>();
    let bands = Bands::uniform(720.0, 1240.0, 20.0).unwrap();
    let nodes = bands.nodes_cm1().to_vec();
    let (mut within, mut told, mut told_together) = ([0; 6], [0; 6], 0);
    for trial in 0..150 {
        let (kind, round) = (trial % SETS.len(), trial / SETS.len());
        let set = SETS[kind];
        let is_unknown = |nuisance| set.contains(&nuisance);
        let object = EnvironmentObject { temperature_k: 250.0 + 70.0 * draw(), emissivity: None };
        let surroundings = Surroundings::new(&nodes, vec![object]).unwrap();
        let state = surroundings.state(280.0 + 60.0 * draw(), &[0.9 * draw()]).unwrap();
        let mut wave = || {
            let (a, b, c) = (0.3 + 0.6 * draw(), 0.3 * draw(), 30.0 + 200.0 * draw());
            nodes.iter().map(|nu| (a + b * (nu / c).sin()).clamp(0.02, 0.99)).collect::<Vec<f64>>()
        };
        let (own, other) = (wave(), wave());
        let mut unknowns = Unknowns::new(set.iter().copied()).unwrap();
        if round % 2 == 0 {
            for nuisance in set {
                let unit = if *nuisance == Nuisance::Lighting { 0.1 } else { 10.0 };
                unknowns = unknowns.prior(*nuisance, unit * 10f64.powf(-2.0 * draw())).unwrap();
            }
        }
        let range = StateRange::default();
        let photons = 1e4;
        let best = NearestSolver::new(&bands, &surroundings, unknowns.clone(), range)
            .per_photon(&own, &other, &state, photons)
            .unwrap();
        let mut comparison = Comparison::new(&bands, &surroundings, unknowns, range);
        let metric = Metric::PerPhoton { photons };
        let target = comparison.aim(&own, &other, &state, metric).unwrap();
        let reach = best.distance * (1.0 + 3.0 * draw().powi(2));
        let mut memory = Memory::default();
        let merging = [None, Some(3), Some(8)][round % 3];
        let mut prover = Prover::new(&comparison, merging, &mut memory, &target, reach);
        let minimum = prover.minimum(&mut comparison, &target, &best.state);
        let s = prover.all.axes[0];
        let axis_k = |state: &State| if s == 0 { state.temperature_k } else { state.environment_k[0] };
        for _ in 0..12 {
            let far = 10f64.powf(-3.0 * draw());
            let ends = [axis_k(&best.state) * (1.0 + far * (draw() - 0.5)), axis_k(&best.state)];
            let ends =
                if draw() < 0.5 { ends } else { [ends[0], ends[0] * (1.0 + 0.2 * far * (draw() - 0.5))] };
            let enough = best.distance * best.distance;
            let mut bounds = Vec::new();
            if let Some(view) = merged_into(&mut prover.merged, &prover.all, merging) {
                let minimum = minimum.counted_together(view, merging.unwrap());
                let alone = minimum.as_ref().and_then(|minimum| Alone::new(view, minimum, s));
                bounds.extend(alone.map(|mut alone| alone.bound(ends, enough)));
            }
            told_together +=
                usize::from(bounds.iter().any(|bound| bound.is_some_and(|lower| lower >= enough)));
            bounds.push(match Alone::new(&prover.all, &minimum, s) {
                Some(mut alone) => alone.bound(ends, enough),
                None => prover.mixed(&minimum, s, enough, |_, _| false)(ends),
            });
            // Too bright already: no state beyond the nearer end is within reach.
            let lower = bounds.into_iter().map(|lower| lower.unwrap_or(reach * reach)).fold(0.0, f64::max);
            told[kind] += usize::from(lower >= enough);
            for _ in 0..300 {
                let mut at = best.state.clone();
                let t = ends[0] + draw() * (ends[1] - ends[0]);
                let mut near = |x: f64| x * (1.0 + far * (draw() - 0.5));
                if s == 0 {
                    at.temperature_k = t
                } else {
                    at.environment_k[0] = t
                }
                if is_unknown(Nuisance::Lighting) {
                    at.lighting[0] = (near(at.lighting[0]) + 1e-3 * (near(1.0) - 1.0)).clamp(0.0, 1.0);
                }
                if is_unknown(Nuisance::Gain) {
                    at.gain = near(at.gain);
                }
                let cost = comparison.cost(&target, &at);
                if cost < reach * reach {
                    within[kind] += 1;
                    assert!(
                        cost >= lower * (1.0 - 1e-9) - 1e-18,
                        "{trial} {ends:?}: {cost:e} {lower:e} {at:?}"
                    );
                }
            }
        }
    }
    assert!(within.iter().all(|count| *count > 2_000), "{within:?}");
    assert!(told.iter().all(|count| *count > 20), "{told:?}");
    assert!(told_together > 50, "{told_together}");
}
