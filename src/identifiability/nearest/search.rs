//! Where the refinement starts: every minimum along T′ of the cost with the other unknowns fitted.
//!
//! With the target's own weights 1/(4(N + σ²)) the cost is ‖W(S − S′)‖², and S′ is linear in V′: at every T′
//! of a grid one small bounded quadratic problem fits V′, and the derivative along T′ follows from
//! the residual alone (envelope theorem). A minimum lies between two points where it turns from falling to
//! rising; a narrow valley beside a high pass is then found although neither point is low. Many bands
//! are thinned for this: it only says where to start.
//!
//! Unknown gain keeps the problem linear, in G′ and G′V′; unknown environment temperatures are tried at a few
//! values. With priors or a known total of the lighting the full linearised problem is used instead.

use super::residual::{Target, dot};
use super::{NearestSolver, State};
use crate::fisher::Nuisance;
use crate::identifiability::step::BoundedStep;
use crate::planck;
use crate::scene::Parameter;
use crate::spectrum::Bands;
use crate::units::SECOND_RADIATION_CM_K;
use nalgebra::{DMatrix, DVector};

/// Temperatures of the grid between its ends.
const GRID: usize = 56;
/// More of them around the temperatures of the scene, as shares of these.
const AROUND: [f64; 7] = [-0.03, -0.01, -0.003, 0.0, 0.003, 0.01, 0.03];
/// Where environment temperatures are unknown, the grid is made for surroundings this many times as warm.
const WARMTHS: [f64; 7] = [0.75, 0.85, 0.93, 1.0, 1.07, 1.17, 1.3];
/// Bands that are enough to find where minima are.
const ENOUGH_BANDS: usize = 128;
/// Minima that are refined at most.
const REFINED: usize = 6;
/// A start is refined unless another one is this many times cheaper.
const WORTH_REFINING: f64 = 9.0;

/// A point of the grid: T′ with the other unknowns fitted.
struct Point {
    state: State,
    cost: f64,
    /// Derivative of the cost along T′.
    slope: f64,
}

impl NearestSolver<'_> {
    /// States to refine from: the target's own, and one for every minimum along T′. Left out are those that are both
    /// many times as costly as the cheapest and more than `reach` farther away.
    pub(super) fn starts(&mut self, target: &Target<'_>, reach: f64) -> Vec<State> {
        let own = self.space.within_range(target.state);
        if !self.space.unknowns.contains(Nuisance::Temperature) {
            return vec![own];
        }
        let temperatures = self.temperatures(target);
        let linear =
            !self.space.unknowns.has_priors() && self.space.unknowns.known_lighting_total().is_none();
        let mut minima: Vec<Point> = if linear {
            let unknown = self.space.unknowns.contains(Nuisance::EnvironmentTemperature);
            let warmths = if unknown { &WARMTHS[..] } else { &[1.0] };
            let grids = warmths.iter().map(|warmth| {
                let environment_k = own.environment_k.iter().map(|t| t * warmth).collect();
                self.quadratic_grid(target, &State { environment_k, ..own.clone() }, &temperatures)
            });
            grids.flat_map(|grid| minima(&grid)).collect()
        } else {
            minima(&self.linearised_grid(target, &own, &temperatures))
        };
        minima.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        minima.truncate(REFINED);
        let own_cost = self.linearise(target, &own).cost;
        let cheapest = minima.first().map_or(f64::INFINITY, |start| start.cost);
        let worth = (WORTH_REFINING * cheapest).max((cheapest.sqrt() + reach).powi(2));
        minima.retain(|start| start.cost <= worth);
        let mut starts: Vec<State> = minima.into_iter().map(|start| start.state).collect();
        if own_cost <= worth || starts.is_empty() {
            starts.push(own);
        }
        starts
    }

    /// Temperatures between which the alternative's own emission goes from next to nothing of the target's
    /// photons to far too many, and around the temperatures of the scene.
    fn temperatures(&self, target: &Target<'_>) -> Vec<f64> {
        let bands = self.target.bands();
        let step = bands.len().div_ceil(16);
        let signal: f64 = self.target.signal().iter().step_by(step).sum();
        let sampled: Vec<(f64, f64)> = bands
            .nodes_and_weights()
            .step_by(step)
            .flat_map(|(first, nodes, weights)| {
                nodes
                    .iter()
                    .zip(weights)
                    .enumerate()
                    .map(move |(j, (nu, w))| (*nu, w * target.alternative[first + j]))
            })
            .collect();
        let (nu, weights): (Vec<f64>, Vec<f64>) = sampled.into_iter().unzip();
        let mut radiance = vec![0.0; nu.len()];
        let [low, high] = self.space.range.temperature_k;
        let mut solve = |goal: f64| {
            let (mut a, mut b) = (low.ln(), high.ln());
            for _ in 0..16 {
                let middle = 0.5 * (a + b);
                planck::photon_radiance_into(&nu, middle.exp(), &mut radiance);
                let emitted: f64 = radiance.iter().zip(&weights).map(|(b, w)| b * w).sum();
                if emitted < goal { a = middle } else { b = middle }
            }
            0.5 * (a + b)
        };
        let (mut bottom, mut top) = (solve(1e-6 * signal), solve(4.0 * signal));
        if self.space.unknowns.contains(Nuisance::Gain) {
            // The scale says nothing of T′ then, only the shape: from deep in the Wien tail to Rayleigh–Jeans.
            let (first, last) = bands.range_cm1();
            bottom = bottom.min((SECOND_RADIATION_CM_K * first / 60.0).ln()).max(low.ln());
            top = top.max((SECOND_RADIATION_CM_K * last * 100.0).ln()).min(high.ln());
        }
        let top = top.max(bottom);
        let even = (0..GRID).map(|i| (bottom + (top - bottom) * i as f64 / (GRID - 1) as f64).exp());
        let scene =
            std::iter::once(target.state.temperature_k).chain(target.state.environment_k.iter().copied());
        let around = scene.flat_map(|t| AROUND.map(|share| t * (1.0 + share)));
        let mut temperatures: Vec<f64> = even.chain(around).map(|t| t.clamp(low, high)).collect();
        temperatures.sort_by(f64::total_cmp);
        temperatures.dedup();
        temperatures
    }

    /// The grid for S′ linear in lighting and gain: weighted least squares in thinned bands.
    fn quadratic_grid(&self, target: &Target<'_>, own: &State, temperatures: &[f64]) -> Vec<Point> {
        let thin = Thinned::new(self, target);
        let lit: Vec<usize> = self
            .space
            .parameters
            .iter()
            .filter_map(|parameter| if let Parameter::Lighting(k) = parameter { Some(*k) } else { None })
            .collect();
        let objects = own.lighting.len();
        let mut scattered: Vec<Vec<f64>> =
            (0..objects).map(|k| thin.scattered(self, target, own, k)).collect();
        // Scattered light of factors that are known.
        let mut known = vec![0.0; thin.signal.len()];
        for k in (0..objects).filter(|k| !lit.contains(k)) {
            add(&mut known, own.lighting[k], &scattered[k]);
        }
        let free = lit.iter().map(|&k| std::mem::take(&mut scattered[k])).collect();
        let known_sum: f64 = (0..objects).filter(|k| !lit.contains(k)).map(|k| own.lighting[k]).sum();
        let fit = Fit {
            free,
            lit,
            known,
            range: self.space.range.lighting,
            sum_limit: self.space.lighting_sum() - known_sum,
            gain: self.space.unknowns.contains(Nuisance::Gain),
        };
        temperatures.iter().map(|&t| fit.point(&thin, own, t)).collect()
    }

    /// The grid by full linearisation: a few steps in the other unknowns with T′ held.
    fn linearised_grid(&mut self, target: &Target<'_>, own: &State, temperatures: &[f64]) -> Vec<Point> {
        let along = self.space.parameters.iter().position(|parameter| *parameter == Parameter::Temperature);
        temperatures
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
                Point { state, cost: at.cost, slope: along.map_or(0.0, |i| at.quadratic.gradient[i]) }
            })
            .collect()
    }
}

/// One start for every minimum that the grid tells of.
fn minima(grid: &[Point]) -> Vec<Point> {
    let copy = |point: &Point| Point { state: point.state.clone(), ..*point };
    let mut found = Vec::new();
    for (i, point) in grid.iter().enumerate() {
        let falling_after = point.slope < 0.0;
        match grid.get(i + 1) {
            Some(next) if falling_after && next.slope > 0.0 => found.push(between(point, next)),
            None if falling_after => found.push(copy(point)),
            _ => {}
        }
        // The coldest state emits next to nothing: the cost is flat there and its slope tells little.
        if i == 0 || point.slope == 0.0 {
            found.push(copy(point));
        }
    }
    found
}

/// The state between two points where a straight derivative would vanish.
fn between(a: &Point, b: &Point) -> Point {
    let share = (a.slope / (a.slope - b.slope)).clamp(0.0, 1.0);
    let mix = |a: f64, b: f64| a + share * (b - a);
    let list = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| mix(*a, *b)).collect();
    let state = State {
        temperature_k: mix(a.state.temperature_k, b.state.temperature_k),
        lighting: list(&a.state.lighting, &b.state.lighting),
        gain: mix(a.state.gain, b.state.gain),
        environment_k: list(&a.state.environment_k, &b.state.environment_k),
    };
    Point { state, cost: a.cost.min(b.cost), slope: 0.0 }
}

/// Every so many bands of the problem, whitened by the target's own noise.
struct Thinned {
    bands: Bands,
    /// First node of the whole problem behind every thinned node.
    nodes: Vec<usize>,
    /// √weight κ/(2√(κS + σ²)) of every band.
    whitening: Vec<f64>,
    /// Whitened signal of the target.
    signal: Vec<f64>,
    /// Emissivity of the alternative at the thinned nodes.
    emissivity: Vec<f64>,
}

/// The unknowns besides T′, fitted by least squares at each T′.
struct Fit {
    /// Whitened scattered light of the unknown factors, and whose they are.
    free: Vec<Vec<f64>>,
    lit: Vec<usize>,
    /// Whitened scattered light of the others.
    known: Vec<f64>,
    range: [f64; 2],
    /// What the unknown factors may sum to.
    sum_limit: f64,
    /// Whether the overall scale is free too.
    gain: bool,
}

impl Fit {
    fn point(&self, thin: &Thinned, own: &State, temperature_k: f64) -> Point {
        let (mut base, slope) = thin.emission(temperature_k);
        add(&mut base, 1.0, &self.known);
        let (gain, factors) =
            if self.gain { self.scaled(thin, &base) } else { (own.gain, self.plain(thin, &base, own)) };
        let mut state = State { temperature_k, gain, ..own.clone() };
        let mut residual = thin.signal.clone();
        add(&mut residual, -gain, &base);
        for ((&factor, column), &k) in factors.iter().zip(&self.free).zip(&self.lit) {
            add(&mut residual, -gain * factor, column);
            state.lighting[k] = factor;
        }
        Point { state, cost: dot(&residual, &residual), slope: -gain * dot(&residual, &slope) }
    }

    /// Factors within their range and sum, for the scale the target has.
    fn plain(&self, thin: &Thinned, base: &[f64], own: &State) -> Vec<f64> {
        let n = self.free.len();
        let [low, high] = self.range;
        let mut goal = thin.signal.clone();
        add(&mut goal, -own.gain, base);
        // p = V′ − low, so that p = 0 meets the bounds.
        for column in &self.free {
            add(&mut goal, -own.gain * low, column);
        }
        let columns: Vec<&[f64]> = self.free.iter().map(Vec::as_slice).collect();
        let limit = (self.sum_limit - low * n as f64).max(0.0);
        let fitted = least_squares(&columns, &goal, own.gain, high - low, limit);
        fitted.iter().map(|p| p + low).collect()
    }

    /// Scale and factors: with u = sΣ·G − ΣG V ≥ 0 for the unused part of the sum sΣ, G·S′ is a sum with
    /// non-negative coefficients of base/sΣ and base/sΣ + column.
    fn scaled(&self, thin: &Thinned, base: &[f64]) -> (f64, Vec<f64>) {
        let limit = if self.free.is_empty() || self.sum_limit <= 0.0 { 1.0 } else { self.sum_limit };
        let share: Vec<f64> = base.iter().map(|b| b / limit).collect();
        let lit: Vec<Vec<f64>> = self
            .free
            .iter()
            .map(|column| share.iter().zip(column).map(|(share, c)| share + c).collect())
            .collect();
        let mut columns = vec![share.as_slice()];
        columns.extend(lit.iter().map(Vec::as_slice));
        let fitted = least_squares(&columns, &thin.signal, 1.0, f64::INFINITY, f64::INFINITY);
        let gain = fitted.iter().sum::<f64>() / limit;
        if gain <= 0.0 {
            return (1.0, vec![0.0; self.free.len()]);
        }
        let [low, high] = self.range;
        (gain, fitted[1..].iter().map(|p| (p / gain).clamp(low, high)).collect())
    }
}

/// Coefficients p of `columns` times `scale` that fit `goal` best, 0 ≤ p ≤ `upper`, Σp ≤ `sum_limit`.
fn least_squares(columns: &[&[f64]], goal: &[f64], scale: f64, upper: f64, sum_limit: f64) -> Vec<f64> {
    let n = columns.len();
    let gram = DMatrix::from_fn(n, n, |i, j| scale * scale * dot(columns[i], columns[j]));
    let size = (0..n).map(|i| gram[(i, i)]).fold(0.0, f64::max);
    if size <= 0.0 {
        // Nothing to fit with: any coefficients will do.
        return vec![0.0; n];
    }
    let pull: Vec<f64> = columns.iter().map(|column| -scale * dot(column, goal) / size).collect();
    if n == 1 {
        return vec![(-pull[0] * size / gram[(0, 0)]).clamp(0.0, upper.min(sum_limit))];
    }
    let hessian = DMatrix::from_fn(n, n, |i, j| gram[(i, j)] / size + if i == j { 1e-13 } else { 0.0 });
    let step = BoundedStep {
        hessian: &hessian,
        gradient: &DVector::from_vec(pull),
        lower: &vec![0.0; n],
        upper: &vec![upper; n],
        summed: &vec![true; n],
        sum_limit,
    };
    step.solve().map_or_else(|| vec![0.0; n], |step| step.as_slice().to_vec())
}

impl Thinned {
    fn new(solver: &NearestSolver<'_>, target: &Target<'_>) -> Self {
        let whole = solver.target.bands();
        let stride = (whole.len() / ENOUGH_BANDS).max(1);
        let (bands, nodes) = whole.every(stride);
        let kept = |values: &[f64]| -> Vec<f64> { values.iter().copied().step_by(stride).collect() };
        let signal = kept(solver.target.signal());
        let whitening: Vec<f64> = signal
            .iter()
            .zip(kept(solver.work.noise()))
            .map(|(signal, noise)| (target.counts * signal + noise).sqrt())
            .map(|root| if root > 0.0 { 0.5 * target.counts / root } else { 0.0 })
            .collect();
        let emissivity = nodes.iter().map(|&j| target.alternative[j]).collect();
        let signal = signal.iter().zip(&whitening).map(|(s, w)| s * w).collect();
        Self { bands, nodes, whitening, signal, emissivity }
    }

    fn whiten(&self, node_values: &[f64]) -> Vec<f64> {
        let mut banded = self.bands.weigh(node_values);
        banded.iter_mut().zip(&self.whitening).for_each(|(value, w)| *value *= w);
        banded
    }

    /// Whitened (1 − e′)εₖB(Tₖ).
    fn scattered(&self, solver: &NearestSolver<'_>, target: &Target<'_>, own: &State, k: usize) -> Vec<f64> {
        let radiance = solver.target.surroundings().object_signal(k, own);
        let values: Vec<f64> =
            self.nodes.iter().map(|&j| (1.0 - target.alternative[j]) * radiance[j]).collect();
        self.whiten(&values)
    }

    /// The whitened emission of the alternative at T′, and its derivative along T′.
    fn emission(&self, temperature_k: f64) -> (Vec<f64>, Vec<f64>) {
        let n = self.nodes.len();
        let (mut value, mut slope) = (vec![0.0; n], vec![0.0; n]);
        planck::photon_radiance_and_slope_into(self.bands.nodes_cm1(), temperature_k, &mut value, &mut slope);
        for ((value, slope), e) in value.iter_mut().zip(&mut slope).zip(&self.emissivity) {
            *value *= e;
            *slope *= e;
        }
        (self.whiten(&value), self.whiten(&slope))
    }
}

fn add(to: &mut [f64], factor: f64, column: &[f64]) {
    for (to, column) in to.iter_mut().zip(column) {
        *to += factor * column;
    }
}
