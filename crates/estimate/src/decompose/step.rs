//! The least of a quadratic form of the unknowns within their range: one step of maximum likelihood.
//!
//! Q(d) = ½ dᵀJ d − bᵀd over temperature steps within its range and mixtures u of the vertices, u ≥ 0, with Σu = 1 where the camera
//! is calibrated. J is the information and b the slope of the likelihood. An active set: steps go to the least of the face that
//! is at hand, or to where they leave it; weights at 0 come back where the slope asks for them. There are at most eight
//! weights, so the number of faces is small and every one is left at most once downwards.
//!
//! Kept beside the solver in a box of `hadar`, without allocation: a step of two unknowns takes 20 ns, of three 0.25 µs, there 0.54 and
//! 0.65 µs. Its steps differ from those in the twelfth digit, and directions without information have no answer there.
//!
//! Directions along which there is no information (a black target does not scatter) are not taken, and said so. They are found
//! after each column was scaled to 1, so no unit matters.

use super::kernel::Sums;
use super::model::MOST;

/// A pivot below this, of columns scaled to 1, is a direction without information of its own.
const DEPENDENT: f64 = 1e-11;
/// Directions of the unknowns, and of those that a limit holds besides.
const WAYS: usize = 2 * MOST;
/// Deviations that a weight at 0 must promise before it comes back.
const PROMISE: f64 = 1e-7;

/// Where the unknowns are, and what holds them.
#[derive(Debug, Clone, Copy)]
pub(super) struct State {
    pub(super) temperature_k: f64,
    /// Weights of the vertices; those beyond their number are 0.
    pub(super) mixture: [f64; MOST],
    /// Vertices whose weight is not held at 0.
    pub(super) free: [bool; MOST],
    /// Whether the temperature is at an end of its range.
    pub(super) held: bool,
}

/// What is fixed about the unknowns.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limits {
    pub(super) range_k: [f64; 2],
    pub(super) vertices: usize,
    pub(super) gain: bool,
    /// Unknown numbers, the temperature among them.
    pub(super) unknowns: usize,
    /// Whether the temperature stays where it is held.
    pub(super) at_temperature: bool,
}

/// Information of the unknowns that are free, factored, the temperature last.
#[derive(Debug, Clone)]
struct Face {
    /// Each direction in the unknowns of [`Sums`], scaled.
    directions: [[f64; MOST]; MOST],
    factor: [[f64; MOST]; MOST],
    blind: [bool; MOST],
    len: usize,
    unknowns: usize,
}

impl State {
    /// Goes to the least of the form; the way there.
    pub(super) fn step(&mut self, sums: &Sums, limits: &Limits) -> Step {
        let of_two = limits.unknowns == 2 && !limits.gain && !self.held && self.free[0] && self.free[1];
        if let Some(step) = of_two.then(|| self.step_of_two(sums, limits)).flatten() {
            return step;
        }
        let mut slope = sums.slope;
        let start = *self;
        // Each round frees or holds one; more than there are faces is rounding.
        for _ in 0..4 * MOST {
            let face = Face::new(sums, limits, self);
            let along = face.least(&slope);
            let (share, stopped) = self.reach(&along, limits);
            self.go(&along, share, limits);
            for (i, slope) in slope[..limits.unknowns].iter_mut().enumerate() {
                *slope -= share * dot(&sums.information[i], &along, limits.unknowns);
            }
            match stopped {
                Some(Stop::Temperature) => self.held = true,
                Some(Stop::Vertex(j)) => {
                    self.mixture[j] = 0.0;
                    self.free[j] = false;
                }
                None => {
                    if !self.release(&slope, sums, limits) {
                        break;
                    }
                }
            }
        }
        let by = self.unknowns_since(&start, limits);
        Step { by, square: quadratic(sums, &by, limits.unknowns), held: self.holds() != start.holds() }
    }

    /// The step of a temperature and one weight that nothing holds and whose columns differ; `None` if a limit is in the way.
    fn step_of_two(&mut self, sums: &Sums, limits: &Limits) -> Option<Step> {
        let [[a, b, ..], [_, c, ..], ..] = sums.information;
        let (p, q) = (sums.slope[0], sums.slope[1]);
        // 1 − cos² of the angle between the columns.
        let apart = 1.0 - (b / a) * (b / c);
        if apart.is_nan() || apart <= DEPENDENT {
            return None;
        }
        let temperature = (p - b / c * q) / (a * apart);
        let weight = (q - b / a * p) / (c * apart);
        let (to_k, to) = (self.temperature_k + temperature, self.mixture[1] + weight);
        let [low, high] = limits.range_k;
        if !(low < to_k && to_k < high && 0.0 < to && to < 1.0) {
            return None;
        }
        self.temperature_k = to_k;
        (self.mixture[0], self.mixture[1]) = (1.0 - to, to);
        let mut by = [0.0; MOST];
        (by[0], by[1]) = (temperature, weight);
        Some(Step { by, square: temperature.mul_add(p, weight * q).max(0.0), held: false })
    }

    /// Goes on by a share of a step that was taken to here, as far as the range allows.
    pub(super) fn stretch(&mut self, step: &Step, share: f64, limits: &Limits) {
        let rest = step.by.map(|by| (share - 1.0) * by);
        let (within, _) = self.reach(&rest, limits);
        self.go(&rest, within, limits);
    }

    fn holds(&self) -> (bool, [bool; MOST]) {
        (self.held, self.free)
    }

    /// What is known of the unknowns.
    pub(super) fn deviations(&self, sums: &Sums, limits: &Limits) -> Deviations {
        // What a limit holds is not known better for that: the truth may be a little way off it.
        let open = Self { held: false, free: [true; MOST], ..*self };
        let mut ways = [[0.0; MOST]; WAYS];
        let mut each = ways.iter_mut();
        let mut push = |face: &Face, i: usize| {
            let way = face.unit(i);
            let length = self.length(&way, sums, limits);
            each.next().into_iter().for_each(|to| *to = way.map(|x| length * x));
        };
        let inside = Face::new(sums, limits, &Self { held: false, ..*self });
        (0..inside.len).for_each(|i| push(&inside, i));
        let base = (0..limits.vertices).find(|&j| self.free[j]).filter(|_| !limits.gain);
        for j in (0..limits.vertices).filter(|&j| !self.free[j]) {
            let face = inside.with(direction_of(j, base, limits), sums);
            push(&face, face.len - 1);
        }
        Deviations { face: Face::new(sums, limits, &open), ways, limits: *limits }
    }

    /// How far the truth may be along a direction of one deviation, either way: until a limit, or until χ² has risen by 1.
    fn length(&self, way: &[f64; MOST], sums: &Sums, limits: &Limits) -> f64 {
        let score = dot(&sums.slope, way, limits.unknowns);
        let to = |sign: f64| {
            let rise = libm::sqrt(score.mul_add(score, 1.0)) + sign * score;
            let until = |j: usize| match sign * weight_along(way, j, limits) {
                // What stays but for rounding meets no limit.
                slope if slope < -PROMISE => self.mixture[j] / -slope,
                _ => f64::INFINITY,
            };
            (0..limits.vertices).map(until).fold(rise.min(1.0), f64::min)
        };
        to(1.0).max(to(-1.0))
    }

    fn reach(&self, along: &[f64; MOST], limits: &Limits) -> (f64, Option<Stop>) {
        let (mut share, mut stopped) = (1.0, None);
        let [low, high] = limits.range_k;
        let to = self.temperature_k + along[0];
        if !(low..=high).contains(&to) {
            let end = if to < low { low } else { high };
            share = ((end - self.temperature_k) / along[0]).clamp(0.0, 1.0);
            stopped = Some(Stop::Temperature);
        }
        for j in (0..limits.vertices).filter(|&j| self.free[j]) {
            let slope = weight_along(along, j, limits);
            if self.mixture[j] + slope < 0.0 {
                let until = (self.mixture[j] / -slope).clamp(0.0, 1.0);
                if until < share {
                    (share, stopped) = (until, Some(Stop::Vertex(j)));
                }
            }
        }
        (share, stopped)
    }

    fn go(&mut self, along: &[f64; MOST], share: f64, limits: &Limits) {
        let [low, high] = limits.range_k;
        self.temperature_k = share.mul_add(along[0], self.temperature_k).clamp(low, high);
        for j in (0..limits.vertices).filter(|&j| self.free[j]) {
            self.mixture[j] = share.mul_add(weight_along(along, j, limits), self.mixture[j]).max(0.0);
        }
        if !limits.gain {
            let total: f64 = self.mixture[..limits.vertices].iter().sum();
            self.mixture[..limits.vertices].iter_mut().for_each(|u| *u /= total);
        }
    }

    /// Lets go of what would rather move: whether there was any.
    fn release(&mut self, slope: &[f64; MOST], sums: &Sums, limits: &Limits) -> bool {
        if self.held && !limits.at_temperature {
            let [low, _] = limits.range_k;
            let inwards = if self.temperature_k <= low { slope[0] } else { -slope[0] };
            if inwards > PROMISE * sums.information[0][0].sqrt() {
                self.held = false;
                return true;
            }
        }
        let base = (0..limits.vertices).find(|&j| self.free[j]);
        let mut best = (PROMISE, None);
        for j in (0..limits.vertices).filter(|&j| !self.free[j]) {
            let direction = direction_of(j, base.filter(|_| !limits.gain), limits);
            let length = quadratic(sums, &direction, limits.unknowns).sqrt();
            let promise = dot(slope, &direction, limits.unknowns) / length;
            if length > 0.0 && promise > best.0 {
                best = (promise, Some(j));
            }
        }
        if let (_, Some(j)) = best {
            self.free[j] = true;
            return true;
        }
        false
    }

    fn unknowns_since(&self, start: &Self, limits: &Limits) -> [f64; MOST] {
        let mut moved = [0.0; MOST];
        moved[0] = self.temperature_k - start.temperature_k;
        let first = usize::from(!limits.gain);
        for j in first..limits.vertices {
            moved[1 + j - first] = self.mixture[j] - start.mixture[j];
        }
        moved
    }
}

/// A step of the unknowns d.
#[derive(Debug, Clone, Copy)]
pub(super) struct Step {
    by: [f64; MOST],
    /// dᵀJd: its length in deviations, squared, and what the deviance loses by it.
    pub(super) square: f64,
    /// Whether it came to a limit or away from one.
    held: bool,
}

impl Step {
    /// What share of the step before this one is: with every step so, they would add up to 1/(1 − share) of it.
    pub(super) fn share_of(&self, before: &Self, sums: &Sums, n: usize) -> Option<f64> {
        let along = (0..n).map(|i| self.by[i] * dot(&sums.information[i], &before.by, n)).sum::<f64>();
        let square = quadratic(sums, &before.by, n);
        (!self.held && !before.held && square > 0.0).then(|| along / square)
    }
}

/// Deviations of the unknowns.
#[derive(Debug)]
pub(super) struct Deviations {
    /// As if no limit held any of them.
    face: Face,
    /// Independent directions of one deviation, as far as limits let the truth go along them; those that a limit holds each for itself.
    ways: [[f64; MOST]; WAYS],
    limits: Limits,
}

impl Deviations {
    /// Of the temperature, K, as if no limit held anything; infinite without information.
    pub(super) fn temperature_k(&self) -> f64 {
        let last = self.face.len - 1;
        if self.face.blind[last] { f64::INFINITY } else { self.face.deviation(last) }
    }

    /// Of Σⱼ cⱼuⱼ over the weights of the vertices; infinite where some of it cannot be told.
    pub(super) fn of_mixture(&self, c: &[f64; MOST]) -> f64 {
        let along = |way: &[f64; MOST]| {
            (0..self.limits.vertices).map(|j| c[j] * weight_along(way, j, &self.limits)).sum::<f64>()
        };
        let form = self.face.directions.each_ref().map(along);
        let is_blind = (0..self.face.len).any(|i| self.face.blind[i] && form[i] != 0.0);
        let square: f64 = self.ways.iter().map(|way| along(way).powi(2)).sum();
        if is_blind || square.is_nan() { f64::INFINITY } else { square.sqrt() }
    }
}

enum Stop {
    Temperature,
    Vertex(usize),
}

/// How weight j changes along a direction of the unknowns.
fn weight_along(direction: &[f64; MOST], j: usize, limits: &Limits) -> f64 {
    match (limits.gain, j) {
        (true, j) => direction[1 + j],
        (false, 0) => -direction[1..limits.vertices].iter().sum::<f64>(),
        (false, j) => direction[j],
    }
}

/// More of vertex j, less of `base`.
fn direction_of(j: usize, base: Option<usize>, limits: &Limits) -> [f64; MOST] {
    let mut direction = [0.0; MOST];
    for (vertex, amount) in std::iter::once((j, 1.0)).chain(base.map(|base| (base, -1.0))) {
        match (limits.gain, vertex) {
            (true, vertex) => direction[1 + vertex] += amount,
            (false, 0) => {}
            (false, vertex) => direction[vertex] += amount,
        }
    }
    direction
}

fn dot(a: &[f64; MOST], b: &[f64; MOST], n: usize) -> f64 {
    a[..n].iter().zip(&b[..n]).map(|(a, b)| a * b).sum()
}

fn quadratic(sums: &Sums, direction: &[f64; MOST], n: usize) -> f64 {
    (0..n).map(|i| direction[i] * dot(&sums.information[i], direction, n)).sum::<f64>().max(0.0)
}

impl Face {
    fn new(sums: &Sums, limits: &Limits, state: &State) -> Self {
        let mut face = Self {
            directions: [[0.0; MOST]; MOST],
            factor: [[0.0; MOST]; MOST],
            blind: [false; MOST],
            len: 0,
            unknowns: limits.unknowns,
        };
        let base = (0..limits.vertices).find(|&j| state.free[j]).filter(|_| !limits.gain);
        for j in (0..limits.vertices).filter(|&j| state.free[j] && Some(j) != base) {
            face.directions[face.len] = direction_of(j, base, limits);
            face.len += 1;
        }
        if !state.held {
            face.directions[face.len][0] = 1.0;
            face.len += 1;
        }
        (0..face.len).for_each(|i| face.factor(i, sums));
        face
    }

    /// With one direction more, after all others.
    fn with(&self, direction: [f64; MOST], sums: &Sums) -> Self {
        let mut face = self.clone();
        face.directions[face.len] = direction;
        face.len += 1;
        face.factor(face.len - 1, sums);
        face
    }

    /// Scales direction i and factors it with those before.
    fn factor(&mut self, i: usize, sums: &Sums) {
        let n = self.unknowns;
        // A column shorter than rounding of the counts themselves has no direction.
        let length = quadratic(sums, &self.directions[i], n).sqrt();
        let scale = if length > f64::MIN_POSITIVE { 1.0 / length } else { 1.0 };
        self.directions[i][..n].iter_mut().for_each(|x| *x *= scale);
        let mut image = [0.0; MOST];
        for (k, image) in image[..n].iter_mut().enumerate() {
            *image = dot(&sums.information[k], &self.directions[i], n);
        }
        for j in 0..=i {
            let mut rest = dot(&image, &self.directions[j], n);
            for k in 0..j {
                rest -= self.factor[i][k] * self.factor[j][k];
            }
            if j < i {
                self.factor[i][j] = if self.blind[j] { 0.0 } else { rest / self.factor[j][j] };
            } else if rest > DEPENDENT {
                self.factor[i][i] = rest.sqrt();
            } else {
                self.blind[i] = true;
            }
        }
    }

    /// L x = b, with nothing along what is blind.
    fn forward(&self, b: impl Fn(usize) -> f64) -> [f64; MOST] {
        let mut x = [0.0; MOST];
        for i in 0..self.len {
            if !self.blind[i] {
                let before: f64 = (0..i).map(|k| self.factor[i][k] * x[k]).sum();
                x[i] = (b(i) - before) / self.factor[i][i];
            }
        }
        x
    }

    /// The step to the least of the form on this face.
    fn least(&self, slope: &[f64; MOST]) -> [f64; MOST] {
        self.back(self.forward(|i| dot(slope, &self.directions[i], self.unknowns)))
    }

    /// The i-th of independent directions of one deviation: direction i without what those before explain of it; nothing if blind.
    fn unit(&self, i: usize) -> [f64; MOST] {
        let mut one = [0.0; MOST];
        one[i] = if self.blind[i] { 0.0 } else { 1.0 };
        self.back(one)
    }

    fn back(&self, half: [f64; MOST]) -> [f64; MOST] {
        let mut steps = [0.0; MOST];
        for i in (0..self.len).rev().filter(|&i| !self.blind[i]) {
            let after: f64 = (i + 1..self.len).map(|k| self.factor[k][i] * steps[k]).sum();
            steps[i] = (half[i] - after) / self.factor[i][i];
        }
        let mut along = [0.0; MOST];
        for (x, along) in along[..self.unknowns].iter_mut().enumerate() {
            *along = (0..self.len).map(|i| steps[i] * self.directions[i][x]).sum();
        }
        along
    }

    /// Deviation of the temperature, whose direction is the last one: those before are profiled out.
    fn deviation(&self, last: usize) -> f64 {
        self.directions[last][0] / self.factor[last][last]
    }
}
