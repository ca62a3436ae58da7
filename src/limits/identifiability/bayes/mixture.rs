//! Two classes as mixtures over their priors, and how often the test between them is right.
//!
//! With x_w = 2√(κS_w + σ_w²), whose noise is normal of variance 1 where counts are many, a class is the mixture
//! p(y) = E_θ[N(y; x(θ), 1)], and the best test of two equally likely ones errs with ½∫min(p₀, p₁) dy.
//!
//! * From below: p = E_Δ[p^Δ], p^Δ = Σ_i N(y; x(θ_i), 1)/n over a lattice with random shift Δ. The integral of the minimum is
//!   concave in (p₀, p₁), so that E_Δ ½∫min(p₀^Δ, p₁^Δ) is at most the error, for any n: whoever is told the lattices on
//!   which the states lie decides no worse. It holds every pairing of the states of one class with those of the other.
//! * From above: the same E_Δ ½∫ over a test that knows only other lattices, of which every state stands for its cell,
//!   N(y; x(θ_j), 1 + ΣJJᵀ/12), J the change of x over a cell: a test that anyone can make. Both meet as n grows.
//!
//! The integrals: y is drawn from (p₀^Δ + p₁^Δ + m^Δ)/3, m of states halfway from each state of the target to the nearest of the
//! alternative, weighted by what it was drawn with, states and noise by lattices; three deviations by the scatter over Δ.
//! All happens in the span of the x(θ) of one lattice; what of the others lies outside it, by ρ on average, changes the
//! error by no more than ρ/√(2π).

use super::prior::{Lattice, PriorSpace, quantile};
use super::stack::Pair;
use crate::error::Result;
use crate::fisher::{Counting, Unknowns};
use crate::identifiability::detection;
use crate::identifiability::nearest::{NearestSolver, StateRange};
use crate::parallel;
use crate::scene::{Jacobian, Parameter, State, Surroundings};
use crate::spectrum::Bands;
use crate::sum::{Compensated, dot};
use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;
use std::f64::consts::PI;

/// Lattices whose scatter tells the error of their mean.
const SHIFTS: usize = 16;
/// States of a lattice that readings are drawn about.
const DRAWN: usize = 256;
/// States of a lattice that span what readings are projected on, most of its dimensions, and the share of the largest
/// change of x that may be left outside it.
const SPANNING: usize = 128;
/// See [`SPANNING`].
const DIMENSIONS: usize = 16;
const OUTSIDE: f64 = 1e-8;
/// Terms of a likelihood this much below its largest, in logarithm, are none.
const NEGLIGIBLE: f64 = 40.0;
/// Cut of the normal noise, in deviations.
const NOISE: [f64; 2] = [-8.0, 8.0];

/// What is looked at.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scene<'a> {
    pub(super) bands: &'a Bands,
    pub(super) surroundings: &'a Surroundings,
    pub(super) pair: Pair<'a>,
    /// Priors of the target and of the alternative.
    pub(super) priors: &'a [PriorSpace; 2],
    /// What has no prior, which in the alternative may be anything, whatever the rest.
    pub(super) free: &'a Unknowns,
    pub(super) range: StateRange,
    pub(super) total_known: bool,
}

/// States of one class on one lattice.
#[derive(Debug, Clone, Default)]
struct Cloud {
    /// x of each state in the span, less that of the nominal one.
    at: Vec<f64>,
    /// Changes of x over a cell along each axis, over √12.
    cells: Vec<f64>,
    count: usize,
}

/// One lattice of each class.
#[derive(Debug, Clone, Default)]
struct Shifted {
    classes: [Cloud; 2],
    middles: Vec<f64>,
    /// States that readings are drawn about, of the target, the alternative and the middles, and the noise of each.
    drawn: [Vec<usize>; 3],
    noise: Vec<f64>,
    /// Squared half separation in shot noise alone of the states with equal shares of the priors.
    squares: Vec<f64>,
    /// Sum of what lies outside the span, and of how many states.
    outside: [f64; 2],
}

/// The classes on all lattices.
#[derive(Debug, Clone)]
pub(super) struct Mixtures {
    dimensions: usize,
    axes: usize,
    shifted: Vec<Shifted>,
    outside: f64,
}

/// Share of wrong decisions: no test has fewer than `least`, one has `reached`; three deviations of both.
#[derive(Debug, Clone, Copy)]
pub(super) struct Missed {
    pub(super) least: f64,
    pub(super) reached: f64,
    pub(super) errors: [f64; 2],
}

impl Missed {
    /// Whether more states would tell hardly more: the two sides are as near as their errors.
    pub(super) fn is_settled(&self) -> bool {
        self.reached - self.least <= self.errors[0].max(self.errors[1])
    }
}

/// x = 2√(κS + σ²) of a surface, and where asked for its changes.
struct Reading<'a> {
    scene: Scene<'a>,
    counting: &'a Counting,
    jacobian: Jacobian<'a>,
    parameters: Vec<Parameter>,
}

impl<'a> Reading<'a> {
    fn new(scene: Scene<'a>, counting: &'a Counting) -> Self {
        let parameters = scene.priors[0].parameters().collect();
        Self { scene, counting, jacobian: Jacobian::new(scene.bands, scene.surroundings), parameters }
    }

    /// x of class `class` in `state`, and the square roots of its photons.
    fn of(&mut self, class: usize, state: &State, parameters: bool) -> (Vec<f64>, Vec<f64>) {
        let Pair { emissivity, alternative, .. } = self.scene.pair;
        let (own, other) = if class == 0 { (emissivity, alternative) } else { (alternative, emissivity) };
        let parameters: &[Parameter] = if parameters { &self.parameters } else { &[] };
        self.jacobian.evaluate(own, other, state, parameters, self.scene.total_known);
        let photons =
            self.jacobian.signal().iter().map(|signal| (signal * self.counting.counts_per_radiance).max(0.0));
        let photons: Vec<f64> = photons.collect();
        let x = photons.iter().enumerate().map(|(w, n)| 2.0 * (n + self.counting.var_added(w)).sqrt());
        (x.collect(), photons.iter().map(|n| n.sqrt()).collect())
    }

    /// ∂x along parameter `i` of what was last looked at, x given.
    fn change(&self, i: usize, x: &[f64]) -> Vec<f64> {
        let column = self.jacobian.column(i).iter().zip(x);
        let rate = 2.0 * self.counting.counts_per_radiance;
        column.map(|(c, x)| if *x > 0.0 { rate * c / x } else { 0.0 }).collect()
    }
}

impl Mixtures {
    /// Both classes on lattices of `points` states each, with counts as `counting` makes them.
    pub(super) fn new(scene: Scene<'_>, counting: &Counting, points: usize) -> Result<Self> {
        let axes = scene.priors[0].axes();
        let lattices: Vec<(Lattice, [Lattice; 3])> = (0..SHIFTS as u64)
            .map(|seed| {
                let mut rng = ChaCha8Rng::seed_from_u64(seed);
                let states = Lattice::new(points, axes, &mut rng);
                (states, std::array::from_fn(|_| Lattice::new(points, DIMENSIONS, &mut rng)))
            })
            .collect();
        let mut reading = Reading::new(scene, counting);
        let (origin, _) = reading.of(0, scene.pair.state, false);
        let span = span(&mut reading, &origin, &lattices[0].0, points)?;
        let shifted = parallel::try_map_with(
            lattices.len(),
            || (Reading::new(scene, counting), Free::new(scene)),
            |(reading, free), i| shifted(reading, free, (&origin, &span), &lattices[i], points),
        )?;
        let [outside, states] = shifted
            .iter()
            .fold([0.0; 2], |sum, one: &Shifted| [sum[0] + one.outside[0], sum[1] + one.outside[1]]);
        Ok(Self { dimensions: span.len(), axes, shifted, outside: outside / states.max(1.0) })
    }

    /// States of each class, all lattices together.
    pub(super) fn states(&self) -> usize {
        self.shifted.iter().map(|one| one.classes[0].count.min(one.classes[1].count)).sum()
    }

    /// Shares of wrong decisions with all x `factor` times as large: √N where they are those of one photon.
    pub(super) fn missed(&self, factor: f64) -> Missed {
        let projected = factor * self.outside / (2.0 * PI).sqrt();
        if let (0, Some(Shifted { classes: [own, other], .. })) = (self.axes, self.shifted.first()) {
            let miss = detection::miss_probability(0.5 * factor * square_between(&own.at, &other.at).sqrt());
            return Missed { least: miss, reached: miss, errors: [projected; 2] };
        }
        let parts = parallel::map(self.shifted.len(), |i| {
            self.part(&self.shifted[i], &self.shifted[(i + 1) % self.shifted.len()], factor)
        });
        let [least, reached] = [0, 1].map(|side| mean(parts.iter().map(|part| part[side])));
        // What may stand between the states, about one of them with an error of ½.
        let between = 0.25 / self.states().max(1) as f64;
        Missed {
            least: least[0],
            reached: reached[0],
            errors: [least[1] + between + projected, reached[1] + between],
        }
    }

    /// A rigorous least share of wrong decisions for any number of photons: ½(1 − √(1 − ρ²)), ρ = exp(−d²/2), averaged over
    /// states with equal shares of the priors; three deviations of it.
    pub(super) fn least_of_few(&self, factor: f64) -> [f64; 2] {
        let of = |one: &Shifted| {
            let miss = |square: &f64| {
                let overlap = (-factor * factor * square).exp();
                0.5 * overlap / (1.0 + (1.0 - overlap).max(0.0).sqrt())
            };
            one.squares.iter().map(miss).sum::<f64>() / one.squares.len().max(1) as f64
        };
        mean(self.shifted.iter().map(of))
    }

    fn part(&self, own: &Shifted, known: &Shifted, factor: f64) -> [f64; 2] {
        let r = self.dimensions;
        let told: Vec<Vec<f64>> =
            own.classes.iter().map(|c| &c.at).chain([&own.middles]).map(|at| scaled(at, factor)).collect();
        let cells = known.classes.each_ref().map(|cloud| Cells::new(cloud, factor, r, self.axes));
        let (mut y, mut scratch) = (vec![0.0; r], Vec::new());
        let mut sums = [Compensated::default(); 2];
        let mut noise = own.noise.chunks_exact(r.max(1));
        let mut readings = 0;
        for (kind, drawn) in own.drawn.iter().enumerate() {
            for &i in drawn {
                let Some(z) = noise.next() else { continue };
                let centre = &told[kind][i * r..(i + 1) * r];
                y.iter_mut().zip(centre.iter().zip(z)).for_each(|(y, (c, z))| *y = c + z);
                let logs = [0, 1, 2].map(|c| log_mean(&told[c], &y, &mut scratch));
                let most = logs.iter().fold(f64::NEG_INFINITY, |a, b| a.max(*b));
                let [first, second, middle] = logs.map(|log| (log - most).exp());
                let drawn_by = (first + second + middle) / 3.0;
                let [own, other] = cells.each_ref().map(|cells| cells.log_density(&y, &mut scratch));
                let chosen = if own >= other { second } else { first };
                sums[0].add(0.5 * first.min(second) / drawn_by);
                sums[1].add(0.5 * chosen / drawn_by);
                readings += 1;
            }
        }
        sums.map(|sum| sum.value() / f64::from(readings.max(1)))
    }
}

/// Mean and three deviations of it.
fn mean(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let values: Vec<f64> = values.collect();
    let n = values.len().max(1) as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    [mean, 3.0 * (squares / (n * (n - 1.0).max(1.0))).sqrt()]
}

fn scaled(values: &[f64], factor: f64) -> Vec<f64> {
    values.iter().map(|value| factor * value).collect()
}

fn square_between(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum()
}

/// ln Σ exp − ln n of half the negative squares of a reading's separations from some states.
fn log_mean(at: &[f64], y: &[f64], scratch: &mut Vec<f64>) -> f64 {
    scratch.clear();
    scratch.extend(at.chunks_exact(y.len().max(1)).map(|x| -0.5 * square_between(x, y)));
    log_mean_exp(scratch)
}

fn log_mean_exp(logs: &[f64]) -> f64 {
    let most = logs.iter().fold(f64::NEG_INFINITY, |a, b| a.max(*b));
    let near = logs.iter().filter(|log| **log > most - NEGLIGIBLE);
    let sum: f64 = near.map(|log| (log - most).exp()).sum();
    most + sum.ln() - (logs.len().max(1) as f64).ln()
}

/// States that stand for their cells, as normal densities: their inverse covariance is 1 − GᵀG.
struct Cells {
    at: Vec<f64>,
    /// k rows of G for each state.
    rows: Vec<f64>,
    /// −½ ln det of the covariance.
    logs: Vec<f64>,
    axes: usize,
}

impl Cells {
    fn new(cloud: &Cloud, factor: f64, r: usize, axes: usize) -> Self {
        let mut rows = scaled(&cloud.cells, factor);
        let mut logs = Vec::with_capacity(cloud.count);
        for rows in rows.chunks_exact_mut((axes * r).max(1)) {
            logs.push(-orthogonalise(rows, r, axes));
        }
        logs.resize(cloud.count, 0.0);
        Self { at: scaled(&cloud.at, factor), rows, logs, axes }
    }

    fn log_density(&self, y: &[f64], scratch: &mut Vec<f64>) -> f64 {
        let r = y.len();
        scratch.clear();
        let states = self.at.chunks_exact(r.max(1)).zip(&self.logs).enumerate();
        scratch.extend(states.map(|(j, (x, log))| {
            let mut square = square_between(x, y);
            for row in self.rows[j * self.axes * r..(j + 1) * self.axes * r].chunks_exact(r.max(1)) {
                let along: f64 = row.iter().zip(y.iter().zip(x)).map(|(g, (y, x))| g * (y - x)).sum();
                square -= along * along;
            }
            log - 0.5 * square
        }));
        log_mean_exp(scratch)
    }
}

/// Rows J become G = L⁻¹J, LLᵀ = 1 + JJᵀ; ln det L.
fn orthogonalise(rows: &mut [f64], r: usize, axes: usize) -> f64 {
    let row = |rows: &[f64], i: usize| rows[i * r..(i + 1) * r].to_vec();
    let own: Vec<Vec<f64>> = (0..axes).map(|i| row(rows, i)).collect();
    let mut lower = vec![0.0; axes * axes];
    let mut log = 0.0;
    for i in 0..axes {
        for j in 0..=i {
            let mut sum = f64::from(u8::from(i == j)) + dot(&own[i], &own[j]);
            sum -= (0..j).map(|l| lower[i * axes + l] * lower[j * axes + l]).sum::<f64>();
            lower[i * axes + j] = if i == j { sum.max(1.0).sqrt() } else { sum / lower[j * axes + j] };
        }
        log += lower[i * axes + i].ln();
        for d in 0..r {
            let before: f64 = (0..i).map(|l| lower[i * axes + l] * rows[l * r + d]).sum();
            rows[i * r + d] = (own[i][d] - before) / lower[i * axes + i];
        }
    }
    log
}

/// The state of the alternative that is nearest to the target's in what has no prior.
struct Free<'a> {
    scene: Scene<'a>,
    solver: Option<NearestSolver<'a>>,
}

impl<'a> Free<'a> {
    fn new(scene: Scene<'a>) -> Self {
        let free = scene.free.clone();
        let solver = (!free.nuisances().is_empty()).then(|| NearestSolver::new(scene.bands, scene.surroundings, free, scene.range));
        Self { scene, solver }
    }

    fn nearest(&mut self, own: Option<&State>, other: State, counting: &Counting) -> Result<State> {
        // Where the ranges differ the two have not the same state, and what has no prior stays where it is.
        let Some((solver, own)) = self.solver.as_mut().zip(own.filter(|own| **own == other)) else {
            return Ok(other);
        };
        let Pair { emissivity, alternative, .. } = self.scene.pair;
        Ok(solver.with_counting(emissivity, alternative, own, counting)?.state)
    }
}

/// An orthonormal basis of what x of some states is beside that of the nominal one, the largest first.
fn span(reading: &mut Reading<'_>, origin: &[f64], lattice: &Lattice, points: usize) -> Result<Vec<Vec<f64>>> {
    let mut left: Vec<Vec<f64>> = Vec::new();
    let mut free = Free::new(reading.scene);
    for i in (0..points).step_by((points / SPANNING).max(1)) {
        let shares = lattice.folded(i);
        let states = reading.scene.priors.each_ref().map(|prior| prior.state(&shares));
        let [own, other] = states;
        let other = other.map(|state| free.nearest(own.as_ref(), state, reading.counting)).transpose()?;
        for (class, state) in [own, other].iter().enumerate() {
            let Some(state) = state else { continue };
            let (mut x, _) = reading.of(class, state, false);
            x.iter_mut().zip(origin).for_each(|(x, o)| *x -= o);
            left.push(x);
        }
    }
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let mut first = 0.0;
    while basis.len() < DIMENSIONS.min(origin.len()) {
        let squares = left.iter().map(|x| dot(x, x));
        let Some((largest, square)) = squares.enumerate().max_by(|a, b| a.1.total_cmp(&b.1)) else { break };
        if basis.is_empty() {
            first = square;
        }
        if square <= first * OUTSIDE * OUTSIDE || square <= 0.0 {
            break;
        }
        let mut one = left[largest].clone();
        // Once more, for what rounding left of the others.
        for earlier in &basis {
            remove(&mut one, earlier);
        }
        let length = dot(&one, &one).sqrt();
        one.iter_mut().for_each(|x| *x /= length);
        for x in &mut left {
            remove(x, &one);
        }
        basis.push(one);
    }
    if basis.is_empty() {
        // Nothing changes anything: any direction will do.
        let length = (origin.len().max(1) as f64).sqrt();
        basis.push(vec![1.0 / length; origin.len()]);
    }
    Ok(basis)
}

/// Takes from x what it has along a unit vector, and says how much that is.
fn remove(x: &mut [f64], along: &[f64]) -> f64 {
    let share = dot(x, along);
    x.iter_mut().zip(along).for_each(|(x, a)| *x -= share * a);
    share
}

fn shifted(
    reading: &mut Reading<'_>,
    free: &mut Free<'_>,
    (origin, span): (&[f64], &[Vec<f64>]),
    (lattice, noise): &(Lattice, [Lattice; 3]),
    points: usize,
) -> Result<Shifted> {
    let scene = reading.scene;
    let mut one = Shifted::default();
    let r = span.len();
    // A cell along each axis, over √12.
    let share = (points as f64).powf(-1.0 / scene.priors[0].axes().max(1) as f64) / 12.0_f64.sqrt();
    for i in 0..points {
        let shares = lattice.folded(i);
        let [own, other] = scene.priors.each_ref().map(|prior| prior.state(&shares));
        let other = other.map(|state| free.nearest(own.as_ref(), state, reading.counting)).transpose()?;
        let mut roots: [Option<Vec<f64>>; 2] = [None, None];
        for (class, state) in [own, other].iter().enumerate() {
            let Some(state) = state else { continue };
            let (x, root) = reading.of(class, state, true);
            roots[class] = Some(root);
            let cloud = &mut one.classes[class];
            for (axis, width) in scene.priors[class].widths(&shares, share).enumerate() {
                let change = reading.change(axis, &x);
                cloud.cells.extend(span.iter().map(|basis| width * dot(basis, &change)));
            }
            let mut left: Vec<f64> = x.iter().zip(origin).map(|(x, o)| x - o).collect();
            cloud.at.extend(span.iter().map(|basis| remove(&mut left, basis)));
            cloud.count += 1;
            one.outside[0] += dot(&left, &left).sqrt();
            one.outside[1] += 1.0;
        }
        if let [Some(own), Some(other)] = &roots {
            one.squares.push(square_between(own, other));
        } else if roots.iter().any(Option::is_some) {
            one.squares.push(f64::INFINITY);
        }
    }
    let [own, other] = &one.classes;
    for x in own.at.chunks_exact(r.max(1)) {
        let near = other.at.chunks_exact(r.max(1)).min_by(|a, b| square_between(a, x).total_cmp(&square_between(b, x)));
        one.middles.extend(x.iter().zip(near.unwrap_or(x)).map(|(a, b)| 0.5 * (a + b)));
    }
    let counts = [own.count, other.count, own.count];
    for (kind, count) in counts.into_iter().enumerate() {
        let step = (count / DRAWN).max(1);
        one.drawn[kind] = (0..count).step_by(step).collect();
        for &i in &one.drawn[kind] {
            let places = noise[kind].point(i, scene.priors[0].axes()).take(r);
            one.noise.extend(places.map(|place| quantile(place, NOISE)));
        }
    }
    Ok(one)
}
