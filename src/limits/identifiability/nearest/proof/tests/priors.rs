//! Proofs with priors against a search that knows of nothing but the definition, and against what priors cannot do.

use super::draws;
use crate::fisher::{Counting, Nuisance, Unknowns};
use crate::identifiability::nearest::{NearestDistance, NearestSolver, StateRange, leaves_priors_out};
use crate::scene::{EnvironmentObject, State, Surroundings};
use crate::spectrum::Bands;

const ALL: [Nuisance; 4] =
    [Nuisance::Temperature, Nuisance::Lighting, Nuisance::Gain, Nuisance::EnvironmentTemperature];

struct Scene {
    bands: Bands,
    surroundings: Surroundings,
    emissivity: [Vec<f64>; 2],
    state: State,
    range: StateRange,
    counting: Counting,
}

impl Scene {
    /// A few bands, one or two surroundings, materials that may be nearly equal, and a range that may leave the target's own state out.
    fn drawn(draw: &mut impl FnMut() -> f64) -> Self {
        let (low, wide) = (300.0 + 900.0 * draw(), 40.0 + 900.0 * draw());
        let bands = Bands::uniform(low, low + wide, wide / (3.0 + 12.0 * draw()).floor()).unwrap();
        let nodes = bands.nodes_cm1().to_vec();
        let objects = 1 + usize::from(draw() < 0.4);
        let surroundings: Vec<EnvironmentObject> = (0..objects)
            .map(|_| EnvironmentObject { temperature_k: 230.0 + 120.0 * draw(), emissivity: None })
            .collect();
        let surroundings = Surroundings::new(&nodes, surroundings).unwrap();
        let lit: Vec<f64> = (0..objects).map(|_| draw() / objects as f64).collect();
        let state = surroundings.state(250.0 + 150.0 * draw(), &lit).unwrap();
        let target: Vec<f64> = nodes.iter().map(|_| 0.05 + 0.9 * draw()).collect();
        let apart = 10f64.powf(-4.0 * draw());
        let other = target.iter().map(|e| (e + apart * (draw() - 0.5)).clamp(0.01, 0.99)).collect();
        let mut range = StateRange::default();
        if draw() < 0.3 {
            let cold = state.temperature_k * (0.8 + 0.3 * draw());
            range.temperature_k = [cold, cold * (1.0 + 0.3 * draw())];
            range.lighting = [0.0, 0.2 + 0.8 * draw()];
        }
        let photons = 10f64.powf(2.0 + 8.0 * draw());
        let total: f64 = bands.weigh(&surroundings.signal(&target, &state)).iter().sum();
        let noise = if draw() < 0.5 { 0.0 } else { photons / bands.len() as f64 };
        let counting = Counting { counts_per_radiance: photons / total, var_added: vec![noise; bands.len()] };
        Self { bands, surroundings, emissivity: [target, other], state, range, counting }
    }

    fn nearest(&self, unknowns: &Unknowns) -> NearestDistance {
        let Self { bands, surroundings, emissivity: [target, other], state, range, counting } = self;
        NearestSolver::new(bands, surroundings, unknowns.clone(), *range)
            .proving(1e-6)
            .with_counting(target, other, state, counting)
            .unwrap()
    }

    fn signals(&self, material: usize, state: &State) -> Vec<f64> {
        self.bands.weigh(&self.surroundings.signal(&self.emissivity[material], state))
    }

    /// d² of a state of the alternative by the definition.
    fn cost(&self, own: &[f64], unknowns: &Unknowns, at: &[f64]) -> f64 {
        let root = |(w, signal): (usize, &f64)| {
            (self.counting.counts_per_radiance * signal + self.counting.var_added[w]).sqrt()
        };
        let there = self.at(unknowns, at);
        let other = self.signals(1, &there);
        let bands = own.iter().enumerate().map(root).zip(other.iter().enumerate().map(root));
        let parameters = unknowns.parameters(self.state.lighting.len());
        let centre = self.values(unknowns, &self.state);
        let prior = parameters.iter().zip(at.iter().zip(&centre)).map(|(parameter, (value, centre))| {
            unknowns.sigma_prior(*parameter).map_or(0.0, |sigma| (0.5 * (value - centre) / sigma).powi(2))
        });
        bands.map(|(a, b)| (a - b).powi(2)).sum::<f64>() + prior.sum::<f64>()
    }

    fn values(&self, unknowns: &Unknowns, state: &State) -> Vec<f64> {
        let mut values = Vec::new();
        for nuisance in ALL.into_iter().filter(|one| unknowns.contains(*one)) {
            match nuisance {
                Nuisance::Temperature => values.push(state.temperature_k),
                Nuisance::Lighting => values.extend(&state.lighting),
                Nuisance::Gain => values.push(state.gain.ln()),
                Nuisance::EnvironmentTemperature => values.extend(&state.environment_k),
            }
        }
        values
    }

    /// The state of such values, pressed into the range.
    fn at(&self, unknowns: &Unknowns, values: &[f64]) -> State {
        let mut state = self.state.clone();
        let mut values = values.iter().copied();
        let mut next = || values.next().unwrap();
        for nuisance in ALL.into_iter().filter(|one| unknowns.contains(*one)) {
            match nuisance {
                Nuisance::Temperature => state.temperature_k = next(),
                Nuisance::Lighting => state.lighting.iter_mut().for_each(|lit| *lit = next()),
                Nuisance::Gain => state.gain = next().exp(),
                Nuisance::EnvironmentTemperature => state.environment_k.iter_mut().for_each(|t| *t = next()),
            }
        }
        state
    }

    fn is_allowed(&self, unknowns: &Unknowns, values: &[f64]) -> bool {
        let state = self.at(unknowns, values);
        let StateRange { temperature_k: [cold, hot], lighting: [dim, bright], lighting_sum } = self.range;
        let (lit, own) = (&state.lighting, [&state.temperature_k]);
        let warm = own.into_iter().all(|t| !unknowns.contains(ALL[0]) || (cold..=hot).contains(t));
        let among = lit.iter().all(|v| (dim..=bright).contains(v)) && lit.iter().sum::<f64>() <= lighting_sum;
        warm && (among || !unknowns.contains(ALL[1])) && state.environment_k.iter().all(|t| *t > 1.0)
    }

    /// The least d² that a search by steps along the axes, ever smaller, comes to from a state.
    fn searched(&self, unknowns: &Unknowns, start: &State, draw: &mut impl FnMut() -> f64) -> f64 {
        let own = self.signals(0, &self.state);
        let mut at = self.values(unknowns, start);
        if !self.is_allowed(unknowns, &at) {
            return f64::INFINITY;
        }
        let mut least = self.cost(&own, unknowns, &at);
        let mut step = 0.1;
        for _ in 0..100 {
            let mut better = false;
            for _ in 0..8 * at.len() {
                let size = |value: f64| step * value.abs().max(0.1);
                let tried: Vec<f64> =
                    at.iter().map(|value| value + size(*value) * (2.0 * draw() - 1.0)).collect();
                if self.is_allowed(unknowns, &tried) {
                    let cost = self.cost(&own, unknowns, &tried);
                    if cost < least {
                        (least, at, better) = (cost, tried, true);
                    }
                }
            }
            if !better {
                step *= 0.5;
            }
        }
        least
    }
}

fn with_priors(set: usize, draw: &mut impl FnMut() -> f64) -> Unknowns {
    let unknown: Vec<Nuisance> = (0..4).filter(|i| set >> i & 1 == 1).map(|i| ALL[i]).collect();
    let mut unknowns = Unknowns::new(unknown.iter().copied()).unwrap();
    for (i, nuisance) in unknown.iter().enumerate() {
        if i == 0 || draw() < 0.6 {
            let unit = if matches!(nuisance, Nuisance::Lighting | Nuisance::Gain) { 0.1 } else { 10.0 };
            unknowns = unknowns.prior(*nuisance, unit * 10f64.powf(1.0 - 5.0 * draw())).unwrap();
        }
    }
    unknowns
}

/// No bound is above a state that a search by the definition finds, whatever is unknown; and where a proof leaves no prior out, nearly
/// all are proved.
#[test]
fn no_state_is_nearer_than_a_proof_with_priors_says() {
    let mut draw = draws(23);
    let (mut told, mut proved, mut tight) = (0, 0, 0);
    for trial in 0..300 {
        let scene = Scene::drawn(&mut draw);
        let unknowns = with_priors(1 + trial % 15, &mut draw);
        let found = scene.nearest(&unknowns);
        let from_own = scene.searched(&unknowns, &scene.state, &mut draw);
        let least = scene.searched(&unknowns, &found.state, &mut draw).min(from_own).sqrt();
        let rounding = 1e-13
            * scene.counting.counts_per_radiance.sqrt()
            * scene.signals(0, &scene.state).iter().sum::<f64>().sqrt();
        assert!(
            found.lower <= least * (1.0 + 1e-9) + rounding,
            "{trial}: {found:?} {least:e} {unknowns:?} {:?}",
            scene.state
        );
        if !leaves_priors_out(&unknowns) {
            told += 1;
            proved += usize::from(found.is_proved_to(1e-3));
            tight += usize::from(found.is_proved_to(1e-6));
        }
    }
    assert!(told > 80 && proved * 100 >= 98 * told && tight * 100 >= 95 * told, "{proved} {tight} of {told}");
}

/// To know more never brings two things nearer: a narrower prior, up to certainty, leaves every distance at least what it was, and one that says
/// nothing leaves it as without.
#[test]
fn narrower_priors_never_bring_states_nearer() {
    let mut draw = draws(29);
    let mut told = 0;
    for trial in 0..100 {
        let scene = Scene::drawn(&mut draw);
        let nuisance = ALL[trial % 4];
        let mut unknown: Vec<Nuisance> = ALL.into_iter().filter(|_| draw() < 0.4).collect();
        unknown.retain(|one| *one != nuisance);
        let without = Unknowns::new(unknown.iter().copied()).unwrap();
        unknown.push(nuisance);
        let set = || Unknowns::new(unknown.iter().copied()).unwrap();
        if !scene.is_allowed(&set(), &scene.values(&set(), &scene.state)) {
            continue;
        }
        told += 1;
        let deviations = [1e100, 10f64.powf(2.0 - 3.0 * draw()), 10f64.powf(-1.0 - 3.0 * draw()), 1e-100];
        let mut before = scene.nearest(&set());
        let unsaid = before.lower;
        for sigma in deviations {
            let now = scene.nearest(&set().prior(nuisance, sigma).unwrap());
            let slack = 1e-9 * now.distance
                + 1e-13
                    * scene.counting.counts_per_radiance.sqrt()
                    * scene.signals(0, &scene.state).iter().sum::<f64>().sqrt();
            assert!(
                before.lower <= now.distance + slack,
                "{trial} {nuisance:?} {sigma:e}: {before:?} {now:?}"
            );
            // Nor does it make less of it proved.
            assert!(
                now.lower >= unsaid * (1.0 - 2e-6) - slack,
                "{trial} {nuisance:?} {sigma:e}: {unsaid} {now:?}"
            );
            before = now;
        }
        // Certainty is what is known.
        let known = scene.nearest(&without);
        assert!(
            before.lower <= known.distance * (1.0 + 1e-9)
                && known.lower <= before.distance * (1.0 + 1e-9) + 1e-12,
            "{trial} {nuisance:?}: {before:?} {known:?}"
        );
    }
    assert!(told > 50, "{told}");
}
