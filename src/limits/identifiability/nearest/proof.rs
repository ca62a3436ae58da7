//! A lower bound of the nearest distance: branch and bound over the unknown temperatures alone.
//!
//! For fixed temperatures ‖√(N + v) − √(N′ + v)‖² is jointly convex in all that enters linearly, the amplitudes of the
//! alternative's sources (`amplitudes`): −√ is convex. What is left to search are the unknown temperatures, none, one or a
//! few. A box of them is bounded by quadratics that lie below the cost wherever it could be nearer than the best state known
//! (`metric`), over amplitudes and the chord of each source's spectrum (`sources`), less what the chord misses; the least
//! value of a quadratic is bounded by its slope (`hull`). About the best state a box is closed at once by convexity
//! (`closing`); the others are halved until none could be nearer, the lowest first. A state that turns out to be nearer on
//! the way becomes the best one, and all begins again.
//!
//! Rounding: lengths are lowered by [`ROUNDING`] of what they are made of, spectra are taken to be as exact as
//! [`crate::planck`] states, and the bound given is lowered by [`MARGIN`]. Priors only add to a distance; the bound leaves
//! them out.

mod amplitudes;
mod closing;
mod hull;
mod metric;
mod sources;

use self::amplitudes::{Amplitudes, Pieces};
use self::closing::{Minimum, Reach, close};
use self::hull::{Quadratic, reduce};
use self::metric::Metric;
pub(super) use self::sources::Few;
use self::sources::{Chord, Sources, Spectrum, chord};
use super::refine::{NearestDistance, refine};
use super::residual::{Comparison, Target};
use crate::fisher::Nuisance;
use crate::scene::{Parameter, State};
use crate::sum::dot;
use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::sync::Arc;

/// Rounding of a length, as a share of its terms, with that of Planck's function.
const ROUNDING: f64 = 1e-14;
/// What a bound is lowered by in the end.
const MARGIN: f64 = 1e-12;
/// Boxes looked at most, by the number of unknown temperatures.
const BOXES: [u64; 4] = [1, 2_000, 6_000, 6_000];
/// Nearer states that are followed at most.
const RESTARTS: usize = 30;
/// Share of the bound wanted beyond which what chords miss makes it useless to try better quadratics.
const COARSE: f64 = 0.25;
/// Descents into valleys on the way, and boxes after which another one is tried from no lower than before.
const DESCENTS: usize = 40;
const SELDOM: u64 = 50;
/// Quadratics that are tried in a box.
const QUADRATICS: usize = 5;
/// Half widths of the closed box that are tried, as shares of T/max(x, 2) in the middle of the bands.
const WIDTHS: [f64; 8] = [0.3, 0.1, 0.03, 0.01, 3e-3, 1e-3, 1e-4, 1e-6];

/// Whether a state nearer than a limit was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Nearer {
    /// One is.
    Somewhere,
    /// None is, which is proved.
    Nowhere,
    /// None was found, and it is not proved that there is none.
    Undecided,
}

/// What is to be shown.
#[derive(Debug, Clone, Copy)]
struct Goal {
    /// A state of less d² than this ends the proof.
    limit: f64,
    /// The bound of d² that is enough.
    enough: f64,
    /// Boxes looked at most.
    boxes: u64,
}

/// What is known of a search.
enum Outcome {
    /// No state is nearer than this.
    Bound(f64),
    /// A nearer state.
    Nearer(State),
}

/// What has come of closing a box about the best state.
enum Closed {
    /// A lower bound of d² in it, and its faces.
    Box(f64, Vec<[f64; 2]>),
    /// A nearer state.
    Nearer(State),
    /// No box can be closed.
    Nothing,
}

/// Intervals of the unknown temperatures: places of their ends among the spectra known.
#[derive(Debug, Clone)]
struct Region {
    ends: Vec<[usize; 2]>,
    bound: f64,
    axis: Option<usize>,
}

impl Ord for Region {
    fn cmp(&self, other: &Self) -> Ordering {
        other.bound.total_cmp(&self.bound)
    }
}

impl PartialOrd for Region {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Region {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Region {}

/// A spectrum of a source at one end of an interval.
struct End {
    spectrum: Spectrum,
    /// The largest amplitude with which no band alone is beyond reach.
    most: f64,
}

/// Amplitudes and temperatures of all sources.
struct Mixture {
    amplitudes: Vec<f64>,
    temperature_k: Vec<f64>,
}

/// A pair in some of its bands: fewer bands never carry more information, and where they prove enough they are quicker.
struct View<'a> {
    sources: Sources<'a>,
    allowed: Amplitudes,
    /// √(N + v), N and v of every band.
    root: Vec<f64>,
    counts: Vec<f64>,
    noise: Vec<f64>,
    /// The distance within which everything is.
    reach: f64,
    about_target: Metric,
    /// Sources of unknown temperature, and their spectra at the temperatures known, as far as they were needed.
    axes: Vec<usize>,
    ends: Vec<Vec<Option<End>>>,
    /// Spectra of the others.
    fixed: Vec<Option<Spectrum>>,
}

struct Prover<'a> {
    few: Option<View<'static>>,
    all: View<'a>,
    /// Ends of intervals, by axis.
    temperature_k: Vec<Vec<f64>>,
    boxes: u64,
}

/// Whether any state is nearer than `limit`; `known` is the nearest one that a search has found, if there was one.
pub(super) fn nearer_than(
    comparison: &mut Comparison<'_>,
    few: Option<&Arc<Few>>,
    target: &Target<'_>,
    limit: f64,
    known: Option<&NearestDistance>,
    boxes: u64,
) -> Nearer {
    let goal = Goal { limit: limit * limit, enough: limit * limit * (1.0 + 4.0 * MARGIN), boxes };
    match Prover::new(comparison, few, target, limit).run(comparison, target, known, goal) {
        Outcome::Nearer(_) => Nearer::Somewhere,
        Outcome::Bound(lower) if lower * (1.0 - MARGIN) >= limit => Nearer::Nowhere,
        Outcome::Bound(_) => Nearer::Undecided,
    }
}

/// The best state with a bound proved to `tolerance` of its distance, or as far as the effort goes.
pub(super) fn prove(
    comparison: &mut Comparison<'_>,
    few: Option<&Arc<Few>>,
    target: &Target<'_>,
    mut best: NearestDistance,
    tolerance: f64,
) -> NearestDistance {
    for _ in 0..RESTARTS {
        if best.distance <= 0.0 {
            break;
        }
        let cost = best.distance * best.distance;
        // A little more than asked for, so that a bound rounded down does not miss it.
        let share = 1.0 - 0.9 * tolerance;
        let prover = Prover::new(comparison, few, target, best.distance);
        let boxes = BOXES[prover.all.axes.len().min(BOXES.len() - 1)];
        let goal = Goal { limit: cost, enough: share * share * cost, boxes };
        match prover.run(comparison, target, Some(&best), goal) {
            Outcome::Bound(lower) => {
                best.lower = (lower * (1.0 - MARGIN)).clamp(0.0, best.distance);
                break;
            }
            Outcome::Nearer(state) => {
                let found = refine(comparison, target, state, None, 0.0);
                let iterations = best.iterations + found.iterations;
                if found.distance >= best.distance {
                    break;
                }
                best = NearestDistance { iterations, ..found };
            }
        }
    }
    best
}

impl<'a> View<'a> {
    fn new(
        sources: Sources<'a>,
        allowed: Amplitudes,
        [root, counts, noise]: [Vec<f64>; 3],
        reach: f64,
    ) -> Self {
        let size = dot(&root, &root).sqrt() + reach;
        let total = (size * size - crate::sum::sum(&noise)) * (1.0 + 1e-12);
        let allowed = Amplitudes { total, ..allowed };
        let axes: Vec<usize> = (0..sources.list.len()).filter(|&s| sources.list[s].free()).collect();
        let fixed = (0..sources.list.len())
            .map(|s| (!sources.list[s].free()).then(|| sources.spectrum(s, sources.list[s].temperature_k[0])))
            .collect();
        let about_target = Metric::about_target(&root, &counts, reach);
        let ends = axes.iter().map(|_| Vec::new()).collect();
        Self { sources, allowed, root, counts, noise, reach, about_target, axes, ends, fixed }
    }

    /// Makes sure of the spectrum at an end of an interval.
    fn know(&mut self, axis: usize, place: usize, temperature_k: f64) {
        if self.ends[axis].len() <= place {
            self.ends[axis].resize_with(place + 1, || None);
        }
        if self.ends[axis][place].is_some() {
            return;
        }
        let spectrum = self.sources.spectrum(self.axes[axis], temperature_k);
        let mut most = f64::INFINITY;
        for ((counts, root), noise) in spectrum.counts.iter().zip(&self.root).zip(&self.noise) {
            let bright = root + self.reach;
            most = most.min((bright * bright * (1.0 + 1e-9) - noise) / counts);
        }
        self.ends[axis][place] = Some(End { spectrum, most });
    }

    /// The amplitude of a source, where it is known.
    fn held(&self, s: usize) -> Option<f64> {
        if self.allowed.gain_free {
            return None;
        }
        match s.checked_sub(1) {
            None => Some(1.0),
            Some(k) => {
                (self.allowed.ranges[k][0] == self.allowed.ranges[k][1]).then(|| self.allowed.ranges[k][0])
            }
        }
    }

    /// The largest amplitude that a source can have in a box that begins with this spectrum.
    fn most(&self, s: usize, cold: &End) -> f64 {
        let gain = if self.allowed.gain_free { f64::exp(14.0) } else { 1.0 };
        let own = match s.checked_sub(1) {
            None => gain,
            Some(k) => gain * self.allowed.ranges[k][1].min(self.allowed.sum),
        };
        own.min(cold.most).max(0.0)
    }

    /// A lower bound of d² in a box, the axis along which it is best halved, where it is least, and whether what the
    /// chords miss is in the way of more.
    fn bound(
        &self,
        ends: &[[usize; 2]],
        allowed: &Amplitudes,
        enough: f64,
        quadratics: usize,
    ) -> (f64, usize, Mixture, bool) {
        let bands = self.root.len();
        let (mut pieces, mut columns, mut sags) = (Pieces::default(), Vec::new(), Vec::new());
        let mut temperature_k = Vec::new();
        for s in 0..self.sources.list.len() {
            let mut put = |spectrum: &Spectrum, column: Vec<f64>, cap: f64| {
                pieces.source.push(s);
                pieces.length.push(spectrum.length);
                pieces.cap.push(cap);
                temperature_k.push(spectrum.temperature_k);
                columns.push(column);
            };
            if let Some(spectrum) = &self.fixed[s] {
                put(spectrum, spectrum.counts.clone(), f64::INFINITY);
                continue;
            }
            let axis = self.axes.iter().position(|&axis| axis == s).unwrap_or(0);
            let [Some(cold), Some(hot)] = ends[axis].map(|end| self.ends[axis][end].as_ref()) else {
                continue;
            };
            let (mut low, mut high, mut half) = (vec![0.0; bands], vec![0.0; bands], vec![0.0; bands]);
            chord(Chord {
                width_k: hot.spectrum.temperature_k - cold.spectrum.temperature_k,
                cold: [&cold.spectrum.counts, &cold.spectrum.slope],
                hot: [&hot.spectrum.counts, &hot.spectrum.slope],
                low: &mut low,
                high: &mut high,
                half: &mut half,
            });
            let most = self.most(s, cold);
            put(&cold.spectrum, low, most);
            put(&hot.spectrum, high, hot.most.max(0.0));
            sags.push((axis, most, half));
        }
        let mut whitened: Vec<Vec<f64>> = columns.iter().map(|column| vec![0.0; column.len()]).collect();
        let mut metric = self.about_target.clone();
        let (mut best, mut axis, mut point, mut coarse) = (0.0_f64, 0, vec![0.0; columns.len()], false);
        for attempt in 0..quadratics {
            for (out, column) in whitened.iter_mut().zip(&columns) {
                for ((out, value), w) in out.iter_mut().zip(column).zip(&metric.weight) {
                    *out = value * w;
                }
            }
            let size = dot(&metric.shift, &metric.shift).sqrt();
            let (factor, mut shift) = reduce(&mut whitened, &[&metric.shift]);
            let mut shift = shift.pop().unwrap_or_default();
            let left = shift.pop().unwrap_or(0.0);
            let (mut missed, mut largest) = (0.0, -1.0);
            for (which, most, half) in &sags {
                let size: f64 = half.iter().zip(&metric.weight).map(|(h, w)| (h * w) * (h * w)).sum();
                let part = if size > 0.0 { most * size.sqrt() } else { 0.0 };
                missed += part;
                if part > largest {
                    (largest, axis) = (part, *which);
                }
            }
            let m = columns.len();
            let quadratic = Quadratic {
                constant: left * left,
                linear: vec![0.0; m],
                factor,
                shift,
                origin: vec![0.0; m],
            };
            missed += ROUNDING * size;
            let wanted = ((enough - metric.constant).max(0.0).sqrt() + missed).powi(2);
            let found = quadratic.least(|costs, vertex| allowed.least(&pieces, costs, vertex), wanted);
            let rest = (found.lower.max(0.0).sqrt() - missed).max(0.0);
            let lower = metric.constant + rest * rest;
            coarse = missed * missed > COARSE * enough;
            let gained = lower - best;
            best = best.max(lower);
            point = found.point;
            if best >= enough || (attempt > 0 && gained < 0.03 * (enough - best)) || coarse {
                break;
            }
            let mut counts = vec![0.0; bands];
            for (column, amount) in columns.iter().zip(&point) {
                counts.iter_mut().zip(column).for_each(|(sum, value)| *sum += amount * value);
            }
            counts.iter_mut().for_each(|value| *value = value.max(0.0));
            metric = Metric::about(&self.root, &counts, &self.noise, &self.counts, self.reach);
        }
        let mut mixture =
            Mixture { amplitudes: vec![0.0; self.fixed.len()], temperature_k: vec![0.0; self.fixed.len()] };
        for (i, amount) in point.iter().enumerate() {
            let s = pieces.source[i];
            mixture.amplitudes[s] += amount;
            mixture.temperature_k[s] += amount * temperature_k[i];
        }
        for (s, t) in mixture.temperature_k.iter_mut().enumerate() {
            let own = pieces.source.iter().position(|&source| source == s).unwrap_or(0);
            *t = if mixture.amplitudes[s] > 0.0 { *t / mixture.amplitudes[s] } else { temperature_k[own] };
        }
        (best, axis, mixture, coarse)
    }
}

impl<'a> Prover<'a> {
    fn new(comparison: &Comparison<'a>, few: Option<&Arc<Few>>, target: &Target<'_>, reach: f64) -> Self {
        let space = &comparison.space;
        let sources = Sources::new(comparison, target);
        let counts: Vec<f64> = comparison.target.signal().iter().map(|s| target.counts * s).collect();
        let bands = [comparison.root().to_vec(), counts, comparison.noise().to_vec()];
        let reach = reach * (1.0 + 1e-9);
        let unknown_lighting = space.unknowns.contains(Nuisance::Lighting);
        let known_total = space.unknowns.known_lighting_total();
        let mut ranges: Vec<[f64; 2]> = target
            .state
            .lighting
            .iter()
            .map(|&v| if unknown_lighting { space.range.lighting } else { [v, v] })
            .collect();
        let mut sum = if unknown_lighting { space.lighting_sum() } else { f64::INFINITY };
        let sum_known = unknown_lighting && known_total.is_some();
        if unknown_lighting && ranges.iter().map(|range| range[0]).sum::<f64>() > sum {
            // States are then scaled down to the sum, below their range.
            ranges.iter_mut().for_each(|range| range[0] = 0.0);
        }
        if sum_known {
            // The last factor is what the others leave, whatever its range.
            if let Some(last) = ranges.last_mut() {
                *last = [0.0, sum];
            }
        }
        // By the rounding of the user's own numbers.
        sum *= 1.0 + 1e-15;
        let gain_free = space.unknowns.contains(Nuisance::Gain);
        let allowed = Amplitudes { gain_free, ranges, sum, sum_known, total: 0.0, gain_cap: None };
        let few = few.map(|few| {
            let kept = bands.each_ref().map(|x| x.iter().copied().step_by(few.stride).collect());
            View::new(sources.every(few), allowed.clone(), kept, reach)
        });
        let all = View::new(sources, allowed, bands, reach);
        let temperature_k = all.axes.iter().map(|_| Vec::new()).collect();
        Self { few, all, temperature_k, boxes: 0 }
    }

    fn run(
        mut self,
        comparison: &mut Comparison<'_>,
        target: &Target<'_>,
        best: Option<&NearestDistance>,
        goal: Goal,
    ) -> Outcome {
        let Goal { limit, enough, boxes } = goal;
        let (mut aside, faces) = match best.map(|best| self.close_about(comparison, target, best, goal)) {
            Some(Closed::Nearer(state)) => return Outcome::Nearer(state),
            Some(Closed::Box(lower, faces)) => (lower, Some(faces)),
            Some(Closed::Nothing) | None => (f64::INFINITY, None),
        };
        let mut queue = BinaryHeap::new();
        if self.all.axes.is_empty() {
            if faces.is_none() {
                queue.push(Region { ends: Vec::new(), bound: 0.0, axis: None });
            }
        } else {
            let warmest = best.map_or(target.state, |best| &best.state);
            queue.extend(self.around(faces.as_deref(), warmest));
        }
        let (mut descents, mut descended) = (0, f64::INFINITY);
        while let Some(region) = queue.pop() {
            if region.bound >= enough || self.boxes >= boxes {
                queue.push(region);
                break;
            }
            let parts = match region.axis {
                Some(axis) => self.halves(&region, axis),
                None => vec![region.clone()],
            };
            if parts.is_empty() {
                aside = aside.min(region.bound);
                continue;
            }
            for mut part in parts {
                self.boxes += 1;
                let allowed = self.all.allowed.clone();
                let (bound, axis, mixture) = self.bound(&part.ends, &allowed, enough);
                part.bound = bound.max(part.bound);
                if part.bound < enough {
                    let (state, cost) = self.candidate(comparison, target, &mixture);
                    if cost < limit * (1.0 - 1e-12) {
                        return Outcome::Nearer(state);
                    }
                    if cost < descended && descents < DESCENTS {
                        // Downhill from here another valley may be found; each time from lower than before, or seldom.
                        descents += 1;
                        descended = cost;
                        let found = refine(comparison, target, state, None, 0.0);
                        if found.distance * found.distance < limit * (1.0 - 1e-12) {
                            return Outcome::Nearer(found.state);
                        }
                    } else if self.boxes.is_multiple_of(SELDOM) {
                        descended = f64::INFINITY;
                    }
                }
                part.axis = Some(axis);
                queue.push(part);
            }
        }
        let waiting = queue.peek().map_or(f64::INFINITY, |region| region.bound);
        Outcome::Bound(aside.min(waiting).min(limit.max(enough)).max(0.0).sqrt())
    }

    /// The state of a mixture, if its cost is below the limit.
    fn nearer(
        &self,
        comparison: &mut Comparison<'_>,
        target: &Target<'_>,
        limit: f64,
        mixture: &Mixture,
    ) -> Option<State> {
        let (state, cost) = self.candidate(comparison, target, mixture);
        (cost < limit * (1.0 - 1e-12)).then_some(state)
    }

    /// The state of a mixture, and its cost.
    fn candidate(
        &self,
        comparison: &mut Comparison<'_>,
        target: &Target<'_>,
        mixture: &Mixture,
    ) -> (State, f64) {
        let mut state = target.state.clone();
        let space = &comparison.space;
        let surface = mixture.amplitudes[0];
        for parameter in &space.parameters {
            match *parameter {
                Parameter::Temperature => state.temperature_k = mixture.temperature_k[0],
                Parameter::Lighting(k) => {
                    state.lighting[k] = if surface > 0.0 { mixture.amplitudes[k + 1] / surface } else { 0.0 };
                }
                Parameter::Gain => state.gain = surface.max(f64::MIN_POSITIVE),
                Parameter::EnvironmentTemperature(k) => state.environment_k[k] = mixture.temperature_k[k + 1],
                Parameter::Material => {}
            }
        }
        let state = space.within_range(&state);
        let cost = comparison.cost(target, &state);
        (state, cost)
    }

    /// The place of an end of an interval.
    fn end(&mut self, axis: usize, temperature_k: f64) -> usize {
        let known = self.temperature_k[axis].iter().position(|t| *t == temperature_k);
        known.unwrap_or_else(|| {
            self.temperature_k[axis].push(temperature_k);
            self.temperature_k[axis].len() - 1
        })
    }

    /// A lower bound of d² in a box, the axis along which it is best halved, and where it is least: in few bands, and in all
    /// where these do not prove enough.
    fn bound(&mut self, ends: &[[usize; 2]], allowed: &Amplitudes, enough: f64) -> (f64, usize, Mixture) {
        let mut least = 0.0_f64;
        let known = &self.temperature_k;
        let mut ask = |view: &mut View<'_>, quadratics: usize| {
            for (axis, ends) in ends.iter().enumerate() {
                ends.iter().for_each(|&end| view.know(axis, end, known[axis][end]));
            }
            let allowed = Amplitudes { total: view.allowed.total, ..allowed.clone() };
            let mut found = view.bound(ends, &allowed, enough, quadratics);
            least = least.max(found.0);
            found.0 = least;
            found
        };
        if let Some(few) = &mut self.few {
            let found = ask(few, 1);
            let share = self.all.root.len() as f64 / few.root.len() as f64;
            // Where they are far from it all bands would hardly do either.
            if found.0 >= enough || (found.3 && share * found.0 < enough) {
                return (found.0, found.1, found.2);
            }
        }
        let found = ask(&mut self.all, QUADRATICS);
        (found.0, found.1, found.2)
    }

    /// The whole range but for the closed box, in boxes that share faces with it.
    fn around(&mut self, faces: Option<&[[f64; 2]]>, warm: &State) -> Vec<Region> {
        let ranges: Vec<[f64; 2]> = (0..self.all.axes.len()).map(|axis| self.range(axis, warm)).collect();
        let mut rest: Vec<[usize; 2]> = Vec::new();
        for (axis, range) in ranges.iter().enumerate() {
            let ends = [self.end(axis, range[0]), self.end(axis, range[1])];
            rest.push(ends);
        }
        let region = |ends: Vec<[usize; 2]>| Region { ends, bound: 0.0, axis: None };
        let Some(faces) = faces else { return vec![region(rest)] };
        let mut regions = Vec::new();
        for (axis, (face, range)) in faces.iter().zip(&ranges).enumerate() {
            let mut inner = rest[axis];
            for side in 0..2 {
                if (side == 0 && face[0] <= range[0]) || (side == 1 && face[1] >= range[1]) {
                    continue;
                }
                let cut = self.end(axis, face[side]);
                let mut outer = rest.clone();
                outer[axis][1 - side] = cut;
                inner[side] = cut;
                regions.push(region(outer));
            }
            rest[axis] = inner;
        }
        regions
    }

    /// The range of an unknown temperature, cut off where a known amplitude is too bright in some band.
    fn range(&mut self, axis: usize, warm: &State) -> [f64; 2] {
        let s = self.all.axes[axis];
        let [low, high] = self.all.sources.list[s].temperature_k;
        let Some(amplitude) = self.all.held(s) else { return [low, high] };
        let mut t = 1.2 * temperature_of(warm, s).max(low);
        while t < high {
            let end = self.end(axis, t);
            self.all.know(axis, end, t);
            if self.all.ends[axis][end].as_ref().is_some_and(|end| end.most < amplitude) {
                return [low, t];
            }
            t *= 1.3;
        }
        [low, high]
    }

    fn halves(&mut self, region: &Region, axis: usize) -> Vec<Region> {
        let ends = region.ends[axis];
        let [a, b] = ends.map(|end| self.temperature_k[axis][end]);
        let middle = if b > 1.2 * a { (a * b).sqrt() } else { 0.5 * (a + b) };
        if !(middle > a && middle < b) || b - a <= 1e-13 * b {
            return Vec::new();
        }
        let middle = self.end(axis, middle);
        [[ends[0], middle], [middle, ends[1]]]
            .map(|ends| {
                let mut half = Region { axis: None, ..region.clone() };
                half.ends[axis] = ends;
                half
            })
            .into()
    }

    /// Closes the widest box about the best state that can be: its bound, where it is least, and its faces.
    fn close_about(
        &mut self,
        comparison: &mut Comparison<'_>,
        target: &Target<'_>,
        best: &NearestDistance,
        goal: Goal,
    ) -> Closed {
        let (state, enough) = (&best.state, goal.enough);
        let (residual, other) = comparison.residual(target, state);
        let count = self.all.fixed.len();
        let temperature_k: Vec<f64> = (0..count).map(|s| temperature_of(state, s)).collect();
        let gain = if self.all.allowed.gain_free { state.gain } else { 1.0 };
        let amplitudes: Vec<f64> =
            (0..count).map(|s| if s == 0 { gain } else { gain * state.lighting[s - 1] }).collect();
        let spectra: Vec<Spectrum> = (0..count)
            .map(|s| match &self.all.fixed[s] {
                Some(spectrum) => spectrum.clone(),
                None => self.all.sources.spectrum(s, temperature_k[s]),
            })
            .collect();
        let bands = self.all.root.len();
        let (mut pull, mut seen, mut cost) = (vec![0.0; bands], vec![0.0; bands], 0.0);
        for w in 0..bands {
            if other[w] > 1e-150 && self.all.root[w] > 0.0 {
                (pull[w], seen[w]) = (-residual[w] / other[w], other[w]);
                cost += residual[w] * residual[w];
            }
        }
        let root = self.all.root.clone();
        let minimum = Minimum {
            amplitudes: &amplitudes,
            spectra: &spectra,
            pull: &pull,
            root: &root,
            other: &seen,
            reach: self.all.reach,
            cost,
        };
        let nu = self.all.sources.bands.range_cm1();
        for width in WIDTHS {
            let reach: Vec<Option<Reach>> = (0..count)
                .map(|s| {
                    let [low, high] = self.all.sources.list[s].temperature_k;
                    let t = temperature_k[s];
                    let x = crate::units::SECOND_RADIATION_CM_K * 0.5 * (nu.0 + nu.1) / t;
                    let half = width * t / x.max(2.0);
                    let least = if self.all.held(s).is_some() { amplitudes[s] } else { 0.25 * amplitudes[s] };
                    let (down_k, up_k) = (half.min(t - low).max(0.0), half.min(high - t).max(0.0));
                    self.all.sources.list[s].free().then_some(Reach { down_k, up_k, least })
                })
                .collect();
            let Some(closed) = close(&self.all.sources, &minimum, &reach, &self.all.allowed, enough) else {
                continue;
            };
            let lower = closed.lower.min(cost);
            let mixture = Mixture { amplitudes: closed.amplitudes, temperature_k: closed.temperature_k };
            let faces: Vec<[f64; 2]> = self
                .all
                .axes
                .iter()
                .filter_map(|&s| {
                    let Reach { down_k, up_k, .. } = reach[s]?;
                    Some([temperature_k[s] - down_k, temperature_k[s] + up_k])
                })
                .collect();
            if lower >= enough && self.dim_ones_are_farther(&faces, &amplitudes, enough) {
                return Closed::Box(lower, faces);
            }
            if let Some(state) = self.nearer(comparison, target, goal.limit, &mixture) {
                return Closed::Nearer(state);
            }
            if self.all.axes.is_empty() {
                return Closed::Box(lower, faces);
            }
        }
        Closed::Nothing
    }

    /// Whether no state in a box is nearer in which a source of unknown temperature and amplitude has less than half its share:
    /// what the closed box leaves out.
    fn dim_ones_are_farther(&mut self, faces: &[[f64; 2]], amplitudes: &[f64], enough: f64) -> bool {
        let free: Vec<usize> =
            self.all.axes.iter().copied().filter(|&s| self.all.held(s).is_none()).collect();
        if free.is_empty() {
            return true;
        }
        let ends: Vec<[usize; 2]> = faces
            .iter()
            .enumerate()
            .map(|(axis, face)| [self.end(axis, face[0]), self.end(axis, face[1])])
            .collect();
        free.into_iter().chain(self.all.allowed.gain_free.then_some(0)).all(|s| {
            let mut allowed = self.all.allowed.clone();
            match s.checked_sub(1) {
                None => allowed.gain_cap = Some(0.5 * amplitudes[0]),
                Some(k) => {
                    let share = 0.5 * amplitudes[s] / amplitudes[0];
                    allowed.ranges[k][1] = share.max(allowed.ranges[k][0]);
                }
            }
            self.bound(&ends, &allowed, enough).0 >= enough
        })
    }
}

fn temperature_of(state: &State, s: usize) -> f64 {
    s.checked_sub(1).map_or(state.temperature_k, |k| state.environment_k[k])
}

#[cfg(test)]
mod tests;
