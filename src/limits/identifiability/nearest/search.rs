//! Where the refinement starts: every minimum along T′ of the cost with the other unknowns fitted.
//!
//! With the target's own weights 1/(4(N + σ²)) the cost is ‖W(S − S′)‖², and S′ is linear in V′: at every T′
//! of a grid one small bounded quadratic problem fits V′, and the derivative along T′ follows from
//! the residual alone (envelope theorem). A minimum lies between two points where it turns from falling to
//! rising; a narrow valley beside a high pass is then found although neither point is low. Many bands
//! are thinned for this: it only says where to start.
//!
//! Unknown gain keeps the problem linear, in G′ and G′V′; unknown environment temperatures are tried at a few
//! values. Priors add their squares, but those of the gain and of lighting beside it, which are not quadratic in that. With a known total
//! of the lighting the full linearised problem is used instead.

mod downhill;
mod fit;
mod table;
mod whitened;

pub(super) use self::table::EmissionTable;

use self::fit::{Fit, Fitted};
use self::table::{Emission, Thinned, step_at};
use self::whitened::Whitened;
use super::residual::{Comparison, Target};
use crate::aligned::Aligned;
use crate::fisher::Nuisance;
use crate::identifiability::space::value;
use crate::order;
use crate::scene::{Parameter, State};
use crate::units::SECOND_RADIATION_CM_K;

/// Where environment temperatures are unknown, the grid is made for surroundings this many times as warm.
const WARMTHS: [f64; 7] = [0.75, 0.85, 0.93, 1.0, 1.07, 1.17, 1.3];
/// Minima that are refined at most.
const REFINED: usize = 10;
/// A start is refined unless another one is this many times cheaper.
const WORTH_REFINING: f64 = 9.0;

/// A state with the other unknowns fitted, and about what it costs.
struct Start {
    state: State,
    cost: f64,
}

impl Comparison<'_> {
    /// States to refine from: the target's own, and one for every minimum along T′. Left out
    /// are those that are both many times as costly as the cheapest and more than `reach` farther away.
    pub(super) fn starts(
        &mut self,
        table: &mut Option<EmissionTable>,
        target: &Target<'_>,
        reach: f64,
    ) -> Vec<State> {
        let own = self.space.within_range(target.state);
        let own_cost = self.cost(target, &own);
        if !self.space.unknowns.contains(Nuisance::Temperature) {
            return vec![own];
        }
        let table = table.get_or_insert_with(|| EmissionTable::new(self.target.bands()));
        let mut minima = self.minima(table, target, &own);
        order::ascending(&mut minima, |a| a.cost);
        minima.truncate(REFINED);
        let cheapest = minima.first().map_or(f64::INFINITY, |start| start.cost);
        let worth = (WORTH_REFINING * cheapest).max((cheapest.sqrt() + reach).powi(2));
        minima.retain(|start| start.cost <= worth);
        let mut starts: Vec<State> = minima.into_iter().map(|start| start.state).collect();
        if own_cost <= worth || starts.is_empty() {
            starts.push(own);
        }
        starts
    }

    /// A start for every minimum along T′.
    fn minima(&mut self, table: &mut EmissionTable, target: &Target<'_>, own: &State) -> Vec<Start> {
        let whitened = Whitened::new(self, &table.thinned, target);
        let unknowns = &self.space.unknowns;
        let linear = unknowns.known_lighting_total().is_none();
        let unknown_surroundings = unknowns.contains(Nuisance::EnvironmentTemperature);
        let steps = self.steps(table, &whitened, own.gain);
        let range = self.space.range.temperature_k;
        let scene: Vec<f64> = std::iter::once(target.state.temperature_k)
            .chain(target.state.environment_k.iter().copied())
            .collect();
        let (thinned, grid) = table.grid(&whitened.emissivity, steps, &scene, range);
        if !linear {
            let temperatures: Vec<f64> = grid.iter().map(|emission| emission.temperature_k).collect();
            return self.linearised_grid(target, own, &temperatures);
        }
        let warmths = if unknown_surroundings { &WARMTHS[..] } else { &[1.0] };
        let surroundings = warmths.iter().map(|warmth| {
            let environment_k = own.environment_k.iter().map(|t| t * warmth).collect();
            State { environment_k, ..own.clone() }
        });
        let whitened = &whitened;
        surroundings.flat_map(|own| self.quadratic_grid(target, thinned, whitened, &own, &grid)).collect()
    }

    /// Steps of the grid between which the alternative's own emission goes from next to nothing of the target's
    /// photons to far too many.
    fn steps(
        &self,
        table: &mut EmissionTable,
        whitened: &Whitened,
        gain: f64,
    ) -> std::ops::RangeInclusive<usize> {
        let weights = whitened.emitted(&table.thinned);
        let signal: f64 = self.target.signal().iter().step_by(table.thinned.stride).sum();
        // The emission is that of gain 1.
        let signal = signal / gain;
        let [low, high] = self.space.range.temperature_k;
        let mut bottom = table.step_of_emission(&weights, 1e-6 * signal, low, high);
        let mut top = table.step_of_emission(&weights, 4.0 * signal, low, high);
        if self.space.unknowns.contains(Nuisance::Gain) {
            // The scale says nothing of T′ then, only the shape: from deep in the Wien tail to Rayleigh–Jeans.
            let (first, last) = self.range_cm1;
            bottom = bottom.min(step_at((SECOND_RADIATION_CM_K * first / 60.0).max(low)));
            top = top.max(step_at((SECOND_RADIATION_CM_K * last * 100.0).min(high)));
        }
        bottom.saturating_sub(1).max(step_at(low))..=top.max(bottom)
    }

    /// Minima for S′ linear in lighting and gain: weighted least squares in thinned bands.
    fn quadratic_grid(
        &self,
        target: &Target<'_>,
        thinned: &Thinned,
        whitened: &Whitened,
        own: &State,
        grid: &[&Emission],
    ) -> Vec<Start> {
        crate::stop::check();
        let fit = self.fit(target, thinned, whitened, own);
        let of_surroundings: f64 = (0..own.environment_k.len())
            .map(|k| {
                (
                    self.thinned_prior(target, thinned, Parameter::EnvironmentTemperature(k)),
                    own.environment_k[k],
                )
            })
            .map(|([square, centre], t)| square * (t - centre) * (t - centre))
            .sum();
        let [square, centre] = self.thinned_prior(target, thinned, Parameter::Temperature);
        let with_priors = |fitted: Fitted, temperature_k: f64| {
            let off = temperature_k - centre;
            Fitted {
                cost: fitted.cost + of_surroundings + square * off * off,
                slope: fitted.slope + square * off,
            }
        };
        if let Some(alone) = fit.alone(whitened, own) {
            let fits: Vec<(f64, Fitted)> = grid.iter().map(|emission| alone.at(emission)).collect();
            let state = |i: usize| {
                let mut state = State { temperature_k: grid[i].temperature_k, ..own.clone() };
                if let Some(&k) = fit.lit.first() {
                    state.lighting[k] = fits[i].0;
                }
                state
            };
            let fits = fits.iter().zip(grid);
            let fitted: Vec<Fitted> =
                fits.map(|(fit, emission)| with_priors(fit.1, emission.temperature_k)).collect();
            return minima(&fitted, state);
        }
        let (states, fitted): (Vec<State>, Vec<Fitted>) = grid
            .iter()
            .map(|emission| {
                let (state, fitted) = fit.point(whitened, own, emission);
                (state, with_priors(fitted, emission.temperature_k))
            })
            .unzip();
        minima(&fitted, |i| states[i].clone())
    }

    /// The other unknowns in thinned bands.
    fn fit(&self, target: &Target<'_>, thinned: &Thinned, whitened: &Whitened, own: &State) -> Fit {
        let lit: Vec<usize> = self
            .space
            .parameters
            .iter()
            .filter_map(|parameter| if let Parameter::Lighting(k) = parameter { Some(*k) } else { None })
            .collect();
        let objects = own.lighting.len();
        let surroundings = self.target.surroundings();
        let mut scattered: Vec<Aligned> =
            (0..objects).map(|k| whitened.scattered(thinned, &surroundings.object_signal(k, own))).collect();
        // Scattered light of factors that are known.
        let mut known = Aligned::zeros(whitened.signal.len());
        for k in (0..objects).filter(|k| !lit.contains(k)) {
            for (known, scattered) in known.iter_mut().zip(&*scattered[k]) {
                *known += own.lighting[k] * scattered;
            }
        }
        let free = lit.iter().map(|&k| std::mem::take(&mut scattered[k])).collect();
        let known_sum: f64 = (0..objects).filter(|k| !lit.contains(k)).map(|k| own.lighting[k]).sum();
        let gain = self.space.unknowns.contains(Nuisance::Gain);
        Fit {
            priors: lit
                .iter()
                .map(|&k| self.thinned_prior(target, thinned, Parameter::Lighting(k)))
                .collect(),
            free,
            lit,
            known,
            range: self.space.bounds(Parameter::Lighting(0)),
            sum_limit: self.space.lighting_sum() - known_sum,
            gain,
        }
    }

    /// w² and centre of a prior, w = 0 for none. Thinned bands hold so much less of the photons; it counts beside them as it does beside all.
    fn thinned_prior(&self, target: &Target<'_>, thinned: &Thinned, wanted: Parameter) -> [f64; 2] {
        let share = 1.0 / thinned.stride as f64;
        let found = self.priors(target).find(|(i, _)| self.space.parameters[*i] == wanted);
        found.map_or([0.0; 2], |(_, weight)| [weight * weight * share, value(target.state, wanted)])
    }

    /// Minima by full linearisation: a few steps in the other unknowns with T′ held.
    fn linearised_grid(&mut self, target: &Target<'_>, own: &State, temperatures: &[f64]) -> Vec<Start> {
        crate::stop::check();
        let along = self.space.parameters.iter().position(|parameter| *parameter == Parameter::Temperature);
        let (states, fitted): (Vec<State>, Vec<Fitted>) = temperatures
            .iter()
            .map(|&temperature_k| {
                let mut state = State { temperature_k, ..own.clone() };
                let mut at = self.linearise(target, &state);
                for _ in 0..3 {
                    let Some(step) = self.space.step(&at.quadratic, &state, 1e-9, true) else { break };
                    let moved = self.space.moved(&state, &step);
                    let next = self.linearise(target, &moved);
                    if next.cost > at.cost {
                        break;
                    }
                    (state, at) = (moved, next);
                }
                let slope = along.map_or(0.0, |i| at.quadratic.gradient[i]);
                (state, Fitted { cost: at.cost, slope })
            })
            .unzip();
        minima(&fitted, |i| states[i].clone())
    }
}

/// One start for every minimum that the grid tells of.
fn minima(grid: &[Fitted], state: impl Fn(usize) -> State) -> Vec<Start> {
    let mut found = Vec::new();
    for (i, point) in grid.iter().enumerate() {
        let mut here = || found.push(Start { state: state(i), cost: point.cost });
        // The coldest state emits next to nothing: the cost is flat there and its slope tells little.
        if i == 0 || point.slope == 0.0 {
            here();
        }
        match grid.get(i + 1) {
            Some(next) if point.slope < 0.0 && next.slope > 0.0 => {
                // Where a straight derivative would vanish.
                let share = point.slope / (point.slope - next.slope);
                let cost = point.cost.min(next.cost);
                found.push(Start { state: between(&state(i), &state(i + 1), share), cost });
            }
            None if point.slope < 0.0 => here(),
            _ => {}
        }
    }
    found
}

/// The state that is `share` of the way from a to b.
fn between(a: &State, b: &State, share: f64) -> State {
    let mix = |a: f64, b: f64| a + share.clamp(0.0, 1.0) * (b - a);
    let list = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| mix(*a, *b)).collect();
    State {
        temperature_k: mix(a.temperature_k, b.temperature_k),
        lighting: list(&a.lighting, &b.lighting),
        gain: mix(a.gain, b.gain),
        environment_k: list(&a.environment_k, &b.environment_k),
    }
}
