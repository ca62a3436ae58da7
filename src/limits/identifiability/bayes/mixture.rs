//! Two classes as mixtures over their priors, and how often the test between them is right.
//!
//! With x_w = 2√(κS_w + σ_w²), whose noise is normal of variance 1 where counts are many, a class is the mixture
//! p(y) = E_θ[N(y; x(θ), 1)], and the best test of two equally likely ones errs with ½∫min(p₀, p₁) dy.
//!
//! * From below: p = E_Δ[p^Δ], p^Δ = Σ_i N(y; x(θ_i), 1)/n over a lattice with random shift Δ. The integral of the minimum is
//!   concave in (p₀, p₁), so that E_Δ ½∫min(p₀^Δ, p₁^Δ) is at most the error, for any n: whoever is told the lattices on
//!   which the states lie decides no worse. It holds every pairing of the states of one class with those of the other.
//! * From above: the same E_Δ ½∫ over a test that knows only other lattices ([`Cells`]), a test that anyone can make.
//!   Both meet as n grows.
//!
//! The integrals: y is drawn from (p₀^Δ + p₁^Δ + m^Δ)/3, m of states halfway from each state of the target to the nearest of the
//! alternative, weighted by what it was drawn with, states and noise by lattices; three deviations by the scatter over Δ.
//! All happens in the span of the x(θ) of one lattice; what of the others lies outside it, by ρ on average, changes the
//! error by no more than ρ/√(2π).

use super::cells::{Cells, Cloud, Scratch};
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
/// States of a lattice that readings are drawn about, and that the test knows.
const DRAWN: usize = 512;
/// See [`DRAWN`]; fewer with more than two priors, whose cells take longer.
const KNOWN: usize = 512;
/// See [`KNOWN`].
const KNOWN_OF_MANY: usize = 128;
/// States of a lattice that span what readings are projected on, most of its dimensions, and the share of the largest
/// change of x that may be left outside it.
const SPANNING: usize = 128;
/// See [`SPANNING`].
const DIMENSIONS: usize = 16;
/// See [`SPANNING`].
const OUTSIDE: f64 = 1e-7;
/// Error of a probability that is small enough.
const ERROR: f64 = 3e-3;
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

/// One lattice of each class.
#[derive(Debug, Clone, Default)]
struct Shifted {
    classes: [Cloud; 2],
    middles: Cloud,
    /// The classes on other lattices, which the test knows; empty where something has no prior.
    known: [Cloud; 2],
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
    known: bool,
    shifted: Vec<Shifted>,
    outside: f64,
}

/// Share of wrong decisions: no test has fewer than `least`, one has `reached`, which is not known where something has no
/// prior; three deviations of both.
#[derive(Debug, Clone, Copy)]
pub(super) struct Missed {
    pub(super) least: f64,
    pub(super) reached: Option<f64>,
    pub(super) errors: [f64; 2],
}

impl Missed {
    /// Whether more states would tell hardly more: errors are small, and the two sides as near as they.
    pub(super) fn is_settled(&self) -> bool {
        let error = self.errors[0].max(self.errors[1]);
        error <= ERROR && self.reached.is_none_or(|reached| reached - self.least <= error)
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
        crate::stop::check();
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
        let known = scene.free.nuisances().is_empty();
        let most = if axes > 2 { KNOWN_OF_MANY } else { KNOWN };
        let few = if known && axes > 0 { points.min(most) } else { 0 };
        let lattices: Vec<Lattices> = (0..SHIFTS as u64)
            .map(|seed| {
                let mut rng = ChaCha8Rng::seed_from_u64(seed);
                let states = Lattice::new(points, axes, &mut rng);
                let known = Lattice::new(few, axes, &mut rng);
                Lattices {
                    states,
                    known,
                    noise: std::array::from_fn(|_| Lattice::new(points, DIMENSIONS, &mut rng)),
                }
            })
            .collect();
        let mut reading = Reading::new(scene, counting);
        let (origin, _) = reading.of(0, scene.pair.state, false);
        let span = span(&mut reading, &origin, &lattices[0].states)?;
        let shifted = parallel::try_map_with(
            lattices.len(),
            || (Reading::new(scene, counting), Free::new(scene)),
            |(reading, free), i| Shifted::new(reading, free, (&origin, &span), &lattices[i]),
        )?;
        let [outside, states] = shifted
            .iter()
            .fold([0.0; 2], |sum, one: &Shifted| [sum[0] + one.outside[0], sum[1] + one.outside[1]]);
        Ok(Self { dimensions: span.len(), axes, known, shifted, outside: outside / states.max(1.0) })
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
            return Missed { least: miss, reached: self.known.then_some(miss), errors: [projected; 2] };
        }
        let parts = parallel::map(self.shifted.len(), |i| self.part(&self.shifted[i], factor));
        let [least, reached] = [0, 1].map(|side| mean(parts.iter().map(|part| part[side])));
        // What may stand between the states, about one of them with an error of ½.
        let between = 0.25 / self.states().max(1) as f64;
        Missed {
            least: least[0],
            reached: self.known.then_some(reached[0]),
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

    fn part(&self, own: &Shifted, factor: f64) -> [f64; 2] {
        let r = self.dimensions;
        let told = [&own.classes[0], &own.classes[1], &own.middles].map(|cloud| cloud.scaled(factor));
        let cells =
            self.known.then(|| own.known.each_ref().map(|cloud| Cells::new(cloud, factor, r, self.axes)));
        let (mut y, mut scratch) = (vec![0.0; r], Scratch::default());
        let mut sums = [Compensated::default(); 2];
        let mut noise = own.noise.chunks_exact(r.max(1));
        let mut readings = 0;
        for (kind, drawn) in own.drawn.iter().enumerate() {
            for &i in drawn {
                crate::stop::check();
                let Some(z) = noise.next() else { continue };
                y.iter_mut().zip(z).enumerate().for_each(|(d, (y, z))| *y = told[kind].coordinate(d, i) + z);
                let logs = told.each_ref().map(|cloud| {
                    scratch.squares(cloud, &y);
                    scratch.log_mean(|_| 0.0)
                });
                let most = logs.iter().fold(f64::NEG_INFINITY, |a, b| a.max(*b));
                let [first, second, middle] = logs.map(|log| (log - most).exp());
                let drawn_by = (first + second + middle) / 3.0;
                sums[0].add(0.5 * first.min(second) / drawn_by);
                if let Some(cells) = &cells {
                    let [own, other] = cells.each_ref().map(|cells| cells.log_density(&y, &mut scratch));
                    sums[1].add(0.5 * if own >= other { second } else { first } / drawn_by);
                }
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

fn square_between(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum()
}

/// The state of the alternative that is nearest to the target's in what has no prior.
struct Free<'a> {
    scene: Scene<'a>,
    solver: Option<NearestSolver<'a>>,
}

impl<'a> Free<'a> {
    fn new(scene: Scene<'a>) -> Self {
        let free = scene.free.clone();
        let solver = (!free.nuisances().is_empty())
            .then(|| NearestSolver::new(scene.bands, scene.surroundings, free, scene.range));
        Self { scene, solver }
    }

    fn nearest(&mut self, own: Option<&State>, other: State, counting: &Counting) -> Result<State> {
        crate::stop::check();
        // Where the ranges differ the two have not the same state, and what has no prior stays where it is.
        let Some((solver, own)) = self.solver.as_mut().zip(own.filter(|own| **own == other)) else {
            return Ok(other);
        };
        let Pair { emissivity, alternative, .. } = self.scene.pair;
        Ok(solver.with_counting(emissivity, alternative, own, counting)?.state)
    }
}

/// An orthonormal basis of what x of some states is beside that of the nominal one, the largest first.
fn span(reading: &mut Reading<'_>, origin: &[f64], lattice: &Lattice) -> Result<Vec<Vec<f64>>> {
    let mut left: Vec<Vec<f64>> = Vec::new();
    let mut free = Free::new(reading.scene);
    for i in (0..lattice.points()).step_by((lattice.points() / SPANNING).max(1)) {
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

/// Lattices of states, of those that the test knows, and of the noise.
struct Lattices {
    states: Lattice,
    known: Lattice,
    noise: [Lattice; 3],
}

impl Shifted {
    fn new(
        reading: &mut Reading<'_>,
        free: &mut Free<'_>,
        (origin, span): (&[f64], &[Vec<f64>]),
        lattices: &Lattices,
    ) -> Result<Self> {
        let scene = reading.scene;
        let (mut one, r, axes) = (Self::default(), span.len(), scene.priors[0].axes());
        let project = |x: &[f64]| {
            let mut left: Vec<f64> = x.iter().zip(origin).map(|(x, o)| x - o).collect();
            let at: Vec<f64> = span.iter().map(|basis| remove(&mut left, basis)).collect();
            (at, dot(&left, &left).sqrt())
        };
        let mut at: [Vec<f64>; 2] = Default::default();
        for i in 0..lattices.states.points() {
            let shares = lattices.states.folded(i);
            let [own, other] = scene.priors.each_ref().map(|prior| prior.state(&shares));
            let other = other.map(|state| free.nearest(own.as_ref(), state, reading.counting)).transpose()?;
            let mut roots: [Option<Vec<f64>>; 2] = [None, None];
            for (class, state) in [own, other].iter().enumerate() {
                let Some(state) = state else { continue };
                let (x, root) = reading.of(class, state, false);
                roots[class] = Some(root);
                let (place, left) = project(&x);
                at[class].extend(place);
                one.outside[0] += left;
                one.outside[1] += 1.0;
            }
            if let [Some(own), Some(other)] = &roots {
                one.squares.push(square_between(own, other));
            } else if roots.iter().any(Option::is_some) {
                one.squares.push(f64::INFINITY);
            }
        }
        let mut middles = Vec::new();
        for x in at[0].chunks_exact(r.max(1)) {
            let others = at[1].chunks_exact(r.max(1));
            let near = others.min_by(|a, b| square_between(a, x).total_cmp(&square_between(b, x)));
            middles.extend(x.iter().zip(near.unwrap_or(x)).map(|(a, b)| 0.5 * (a + b)));
        }
        one.middles = Cloud::new(&middles, &[], r);
        one.classes = at.each_ref().map(|at| Cloud::new(at, &[], r));
        let points = lattices.known.points();
        let (mut at, mut cells): ([Vec<f64>; 2], [Vec<f64>; 2]) = Default::default();
        for i in 0..points {
            let shares = lattices.known.folded(i);
            for (class, prior) in scene.priors.iter().enumerate() {
                let Some(state) = prior.state(&shares) else { continue };
                let (x, _) = reading.of(class, &state, true);
                at[class].extend(project(&x).0);
                for (axis, width) in prior.cell_deviations(&shares, points).enumerate() {
                    let change = reading.change(axis, &x);
                    cells[class].extend(span.iter().map(|basis| width * dot(basis, &change)));
                }
            }
        }
        one.known = [0, 1].map(|class| Cloud::new(&at[class], &cells[class], r));
        for kind in 0..3 {
            let count = [&one.classes[0], &one.classes[1], &one.middles][kind].count;
            one.drawn[kind] = (0..count).step_by((count / DRAWN).max(1)).collect();
            for &i in &one.drawn[kind] {
                let places = lattices.noise[kind].point(i, axes).take(r);
                one.noise.extend(places.map(|place| quantile(place, NOISE)));
            }
        }
        Ok(one)
    }
}
