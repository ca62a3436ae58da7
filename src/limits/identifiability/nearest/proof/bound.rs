//! The bound of d² in a box of temperatures.
//!
//! In a box every source of unknown temperature is a mixture of two spectra, the ends of its chord (`sources`), but for what
//! the chord misses. A first look is by the quadratic of `metric` about the target, h its shift: with ‖W(N′ − ΣzA)‖ ≤ m and
//! φ(δ) = ‖W(ΣzA − N)‖² − ‖h‖² (`hull`),
//!
//! d² ≥ cost − ‖h‖² + (√(‖h‖² + φ) − m)²,
//!
//! 0 in place of the bracket where that is negative; or, as m is in proportion to the amplitudes, with the least of the convex
//! √(‖h‖² + φ) − m(z) in its place. From where that is least Newton's method goes to the least of the cost itself over the box, what
//! chords miss included, and a tangent there is a bound as exact as can be (`tangent`).
//!
//! What the amplitudes may be: a curve lies above its cold end and above its tangent there, so that c(1 − λ) of the one and cλ
//! of the other never are more than a band can have within reach, nor all bands together.

use super::amplitudes::{Amplitudes, Piece, Pieces, Ray};
use super::hull::{Hull, Quadratic, factor_of};
use super::orthogonal::inner;
use super::sources::{Chord, Spectrum, chord};
use super::tangent::{Bands, size_of_product, slopes, weights};
use super::vectors::{add_into, largest_share, product_into, square_of_product, square_of_quotient};
use super::view::View;
use crate::sum::dot;

/// Share of what is wanted, and of the cost without what chords miss, below which the least cost over a box is so far from it that finer
/// bands hardly help.
const COARSE: f64 = 0.5;
/// How many times the rounding of counts a distance must be to be seen in them.
pub(super) const CLEAR: f64 = 4.0;
/// Rounding of products and sums of bands, as a share of the sizes of their terms.
const ROUNDING: f64 = 3e-15;
/// Tangents at most, the first of them after steps in which a band alone reaches the target's counts, and parts of a step that are tried.
const TANGENTS: usize = 12;
const STRAIGHT: usize = 2;
const PARTS: [f64; 4] = [1.0, 0.4, 0.1, 0.02];
/// Share of the largest amplitude below which one is as good as none.
const HARDLY: f64 = 1e-3;
/// Share of a cost by which a step must lower it, of what its slope promises.
const PROMISED: f64 = 0.01;
/// Share of what is wanting below which a fall of the cost ends the search.
const WORTH: f64 = 0.02;

/// Amplitudes and temperatures of all sources.
pub(super) struct Mixture {
    pub(super) amplitudes: Vec<f64>,
    pub(super) temperature_k: Vec<f64>,
}

/// What is known of a box.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bound {
    /// No d² in it is below.
    pub(super) lower: f64,
    /// The axis along which it is best halved.
    pub(super) axis: usize,
    /// Whether what the chords miss is in the way of more.
    pub(super) coarse: bool,
}

/// Bounds one box of a view after the other, in the same memory.
#[derive(Debug, Clone, Default)]
pub(super) struct Bounder {
    pieces: Pieces,
    places: Vec<Place>,
    /// Of every axis: the cold end of the chord, what it rises by to the hot one, what it misses, and the largest amplitude.
    low: Vec<Vec<f64>>,
    rise: Vec<Vec<f64>>,
    half: Vec<Vec<f64>>,
    most: Vec<f64>,
    /// Columns times the weights.
    whitened: Vec<Vec<f64>>,
    /// Entries of the priors, row by row, and their residuals.
    rows: Vec<f64>,
    residuals: Vec<f64>,
    /// Amplitudes of the pieces, where the last bound was least.
    point: Vec<f64>,
    /// There: the counts, what chords may miss of them, the slope of the cost by counts, and the weights of a step.
    counts: Vec<f64>,
    slack: Vec<f64>,
    pull: Vec<f64>,
    weight: Vec<f64>,
    /// Σ|r/y|N, costs of the pieces less their rounding, what that is at the point and anywhere, and the cheapest amplitudes.
    by_own: f64,
    least_cost: Vec<f64>,
    sizes: Vec<[f64; 2]>,
    vertex: Vec<f64>,
    /// What the chord of a piece of amplitude 1 misses, as a length: 0 but at cold ends.
    missed: Vec<f64>,
    square: Vec<f64>,
    quadratic: Quadratic,
    hull: Hull,
    memory: Vertex,
}

/// Where the spectrum of a piece is.
#[derive(Debug, Clone, Copy)]
enum Place {
    /// Of a source of known temperature.
    Fixed(usize),
    /// Of an axis.
    Low(usize),
    Rise(usize),
}

/// Where rises stand; each comes after the cold end it begins at. A source stands in the quadratic by its amplitude and by that
/// share of it which is hot: both ends may be nearly the same, what is between them keeps its digits.
fn rises(places: &[Place]) -> impl Iterator<Item = usize> {
    places.iter().enumerate().filter(|(_, place)| matches!(place, Place::Rise(_))).map(|(i, _)| i)
}

/// The spectrum of a piece.
fn column<'s>(view: &'s View<'_>, [low, rise]: [&'s [Vec<f64>]; 2], place: Place) -> &'s [f64] {
    match place {
        Place::Fixed(s) => view.later.fixed[s].as_ref().map_or(&[], |spectrum| &spectrum.counts),
        Place::Low(axis) => &low[axis],
        Place::Rise(axis) => &rise[axis],
    }
}

/// The bands of a view where such counts are compared, of which chords may miss so much.
fn of_bands<'s>(view: &'s View<'_>, [counts, missed]: [&'s [f64]; 2]) -> Bands<'s> {
    Bands { root: &view.root, own: &view.counts, noise: &view.noise, counts, missed }
}

/// Spectra of all pieces times weights.
fn put_products(
    whitened: &mut Vec<Vec<f64>>,
    of: [&[Vec<f64>]; 2],
    view: &View<'_>,
    places: &[Place],
    weight: &[f64],
) {
    whitened.resize_with(whitened.len().max(places.len()), Vec::new);
    for (out, place) in whitened.iter_mut().zip(places) {
        out.resize(weight.len(), 0.0);
        product_into(column(view, of, *place), weight, out);
    }
}

/// Products of all columns with each other, with the rows of the priors.
fn put_square(square: &mut Vec<f64>, columns: &[Vec<f64>], rows: &[f64]) {
    let m = columns.len();
    square.resize(m * m, 0.0);
    for i in 0..m {
        for j in 0..=i {
            let of_priors: f64 = rows.chunks(m).map(|row| row[i] * row[j]).sum();
            let product = dot(&columns[i], &columns[j]) + of_priors;
            (square[i * m + j], square[j * m + i]) = (product, product);
        }
    }
}

/// Memory of [`Cheapest`].
#[derive(Debug, Clone, Default)]
struct Vertex {
    both: Vec<f64>,
    ray: Ray,
}

/// Finds the cheapest amplitudes of the pieces.
struct Cheapest<'a> {
    allowed: &'a Amplitudes,
    pieces: &'a Pieces,
    places: &'a [Place],
}

impl Cheapest<'_> {
    /// Puts them, and returns what rounding may have lifted their cost by.
    fn put(&self, costs: &[f64], vertex: &mut [f64], memory: &mut Vertex) -> f64 {
        let Self { allowed, pieces, places } = self;
        let Vertex { both, ray } = memory;
        both.clear();
        both.extend_from_slice(costs);
        rises(places).for_each(|i| both[i] += costs[i - 1]);
        allowed.least(pieces, both, vertex, ray);
        let rounding = allowed.rounding(pieces, both, vertex, ray);
        rises(places).for_each(|i| vertex[i - 1] += vertex[i]);
        rounding
    }

    /// How large each amplitude can be.
    fn put_most(&self, most: &mut Vec<f64>) {
        most.clear();
        most.extend((0..self.places.len()).map(|i| self.allowed.most(self.pieces, i)));
    }
}

impl Bounder {
    /// A bound of d² in a box, over `narrower` amplitudes where these are given; without a first look from `start` on, amplitudes of
    /// the pieces.
    pub(super) fn bound(
        &mut self,
        view: &mut View<'_>,
        ends: &[[usize; 2]],
        narrower: Option<&Amplitudes>,
        enough: f64,
        start: Option<&[f64]>,
    ) -> Bound {
        crate::stop::check();
        view.look();
        let view = &*view;
        self.lay(view, ends);
        let narrower = narrower.map(|allowed| Amplitudes { total: view.allowed.total, ..allowed.clone() });
        let allowed = narrower.as_ref().unwrap_or(&view.allowed);
        let mut lower = 0.0;
        match start {
            Some(start) if start.len() == self.places.len() => start.clone_into(&mut self.point),
            _ => {
                lower = self.about_target(view, allowed, enough);
                self.point.clone_from(&self.hull.point);
            }
        }
        let mut coarse = false;
        if lower < enough {
            let (bound, least) = self.tangents(view, allowed, enough);
            lower = lower.max(bound);
            coarse = least < COARSE * enough && least < COARSE * self.without_chords(view);
        }
        Bound { lower, axis: self.widest(view), coarse }
    }

    /// The axis whose chords miss most.
    fn widest(&self, view: &View<'_>) -> usize {
        let missed = |axis: usize| {
            let cold = self.places.iter().position(|place| matches!(place, Place::Low(own) if *own == axis));
            let amplitude = cold.map_or(0.0, |cold| self.point[cold].max(HARDLY * self.most[axis]));
            amplitude * square_of_product(&self.half[axis], &view.later.about_target.weight).sqrt()
        };
        let parts: Vec<f64> = (0..view.axes.len()).map(missed).collect();
        (0..parts.len()).max_by(|&i, &j| parts[i].total_cmp(&parts[j])).unwrap_or(0)
    }

    /// A bound by the tangents of the cost from the point on, and the least cost found in the box.
    fn tangents(&mut self, view: &View<'_>, allowed: &Amplitudes, enough: f64) -> (f64, f64) {
        let (mut lower, mut goal) = (0.0_f64, Vec::new());
        let mut cost = self.evaluate(view);
        for step in 0..TANGENTS {
            crate::stop::check();
            if cost.is_nan() {
                break;
            }
            let (bound, gap) = self.tangent(view, allowed, cost);
            lower = lower.max(bound);
            // The least over the box is no more than what is found in it.
            if lower >= enough || cost < enough || gap <= WORTH * (enough - lower) || step + 1 == TANGENTS {
                break;
            }
            self.newton(view, allowed, step >= STRAIGHT);
            let promised =
                inner(&self.quadratic.linear, &self.hull.point) - inner(&self.quadratic.linear, &self.point);
            let from = self.point.clone();
            goal.clone_from(&self.hull.point);
            let mut fell = false;
            for part in PARTS {
                let points = from.iter().zip(&goal);
                self.point.clear();
                self.point.extend(points.map(|(from, to)| part.mul_add(to - from, *from)));
                let there = self.evaluate(view);
                if there < cost + PROMISED * part * promised.min(0.0) {
                    (cost, fell) = (there, true);
                    break;
                }
            }
            if !fell {
                self.point = from;
                break;
            }
        }
        (lower, cost)
    }

    /// The least cost at the point within what chords miss; puts slopes and the weights of a step from there.
    fn evaluate(&mut self, view: &View<'_>) -> f64 {
        let Self { places, low, rise, half, point, counts, slack, pull, .. } = self;
        let Self { pieces, rows, residuals, .. } = self;
        let bands = view.root.len();
        for line in [&mut *counts, slack] {
            line.clear();
            line.resize(bands, 0.0);
        }
        pull.resize(bands, 0.0);
        for (place, amount) in places.iter().zip(&*point) {
            add_into(*amount, column(view, [low, rise], *place), counts);
            if let Place::Low(axis) = *place {
                add_into(*amount, &half[axis], slack);
            }
        }
        let [cost, by_own] = slopes(of_bands(view, [counts, slack]), &view.later.share, pull);
        rows.clear();
        residuals.clear();
        view.priors.put_pieces(pieces, |constant, entries| {
            residuals.push(constant + inner(entries, point));
            rows.extend_from_slice(entries);
        });
        self.by_own = by_own;
        cost + inner(residuals, residuals)
    }

    /// The cost at the point if chords missed nothing.
    fn without_chords(&mut self, view: &View<'_>) -> f64 {
        let Self { counts, slack, pull, .. } = self;
        slack.fill(0.0);
        slopes(of_bands(view, [counts, slack]), &view.later.share, pull)[0]
    }

    /// The bound by the tangent at the point, and how far below the cost there it falls but for rounding.
    fn tangent(&mut self, view: &View<'_>, allowed: &Amplitudes, cost: f64) -> (f64, f64) {
        let Self { places, low, rise, half, point, pull, pieces, rows, residuals, .. } = self;
        let Self { quadratic, least_cost, sizes, vertex, memory, .. } = self;
        let m = places.len();
        quadratic.linear.clear();
        least_cost.clear();
        sizes.clear();
        for (i, place) in places.iter().enumerate() {
            let spectrum = column(view, [low, rise], *place);
            let of_priors =
                residuals.iter().zip(rows.chunks(m)).map(|(residual, row)| 2.0 * residual * row[i]);
            let of_priors: Vec<f64> = of_priors.collect();
            let missed = if let Place::Low(axis) = *place { size_of_product(pull, &half[axis]) } else { 0.0 };
            let all = size_of_product(pull, spectrum);
            let size = ROUNDING * (all + missed + of_priors.iter().map(|x| x.abs()).sum::<f64>());
            // What chords miss holds the rounding of their ends.
            let of_spectrum = if let Place::Fixed(_) = *place { view.rounding * all } else { 0.0 };
            let own = dot(pull, spectrum) - missed + of_priors.iter().sum::<f64>();
            quadratic.linear.push(own);
            least_cost.push(own - size - of_spectrum);
            sizes.push([size, size + of_spectrum]);
        }
        vertex.clear();
        vertex.resize(m, 0.0);
        let lifted = Cheapest { allowed, pieces, places }.put(least_cost, vertex, memory);
        let (mut gap, mut lost) = (0.0, lifted + ROUNDING * cost + view.rounding * self.by_own);
        for i in 0..m {
            gap += quadratic.linear[i] * (point[i] - vertex[i]);
            lost += sizes[i][0] * point[i].abs() + sizes[i][1] * vertex[i].abs();
        }
        let bound = cost - gap.max(0.0) - lost;
        (if bound.is_nan() { f64::NEG_INFINITY } else { bound }, gap)
    }

    /// A Newton step from the point over what is allowed: where it ends is the point of the hull.
    fn newton(&mut self, view: &View<'_>, allowed: &Amplitudes, exact: bool) {
        let Self { places, low, rise, whitened, weight, pull, rows, residuals, point, counts, slack, .. } =
            self;
        weight.resize(view.root.len(), 0.0);
        weights(of_bands(view, [counts, slack]), exact, weight);
        let Self { square, quadratic, hull, pieces, memory, .. } = self;
        put_products(whitened, [low, rise], view, places, weight);
        put_square(square, &whitened[..places.len()], rows);
        factor_of(square, &mut quadratic.factor, &mut quadratic.excess);
        quadratic.origin.clone_from(point);
        let of_priors = inner(residuals, residuals);
        quadratic.length = (0.25 * square_of_quotient(pull, weight) + of_priors).sqrt();
        let oracle = Cheapest { allowed, pieces, places };
        oracle.put_most(&mut quadratic.most);
        hull.least(quadratic, |costs, vertex| oracle.put(costs, vertex, memory), f64::INFINITY);
    }

    /// A bound by the quadratic about the target.
    fn about_target(&mut self, view: &View<'_>, allowed: &Amplitudes, enough: f64) -> f64 {
        let Self { places, low, rise, half, most, whitened, rows, residuals, .. } = self;
        let Self { square, quadratic, hull, pieces, memory, missed: each, .. } = self;
        let metric = &view.later.about_target;
        let m = places.len();
        put_products(whitened, [low, rise], view, places, &metric.weight);
        let mut along: Vec<f64> = whitened[..m].iter().map(|column| dot(column, &metric.shift)).collect();
        rows.clear();
        residuals.clear();
        view.priors.put_pieces(pieces, |residual, entries| {
            along.iter_mut().zip(entries).for_each(|(along, entry)| *along += residual * entry);
            rows.extend_from_slice(entries);
            residuals.push(residual);
        });
        put_square(square, &whitened[..m], rows);
        factor_of(square, &mut quadratic.factor, &mut quadratic.excess);
        quadratic.origin.clear();
        quadratic.origin.resize(m, 0.0);
        quadratic.linear.clear();
        quadratic.linear.extend(along.iter().map(|along| 2.0 * along));
        let shift = metric.cost + inner(residuals, residuals);
        quadratic.length = shift.sqrt();
        let length = |x: &[f64]| square_of_product(x, &metric.weight).sqrt();
        let grain = view.rounding * length(&view.counts);
        each.clear();
        each.resize(m, 0.0);
        let mut missed = grain;
        for (i, place) in places.iter().enumerate() {
            if let Place::Low(axis) = *place {
                each[i] = length(&half[axis]);
                missed += most[axis] * each[i];
            }
        }
        let wanted = (enough.sqrt() + missed).powi(2) - shift;
        let oracle = Cheapest { allowed, pieces, places };
        oracle.put_most(&mut quadratic.most);
        let mut cheapest = |costs: &[f64], vertex: &mut [f64]| oracle.put(costs, vertex, memory);
        let fall = hull.least(quadratic, &mut cheapest, wanted);
        let left = (shift + fall).max(0.0).sqrt();
        // Nothing of what is hardly more than the rounding of the counts that are compared.
        let seen = left > missed && left > CLEAR * grain;
        let lower = if seen { (left - missed).powi(2) } else { 0.0 };
        if lower >= enough || missed <= grain {
            return lower;
        }
        // What chords miss is in proportion to the amplitudes, of which the least may need next to nothing.
        let length = hull.length_less(quadratic, &mut cheapest, each) - grain;
        if length > CLEAR * grain { lower.max(length * length) } else { lower }
    }

    /// Where the last bound was least: an amplitude for every piece.
    pub(super) fn point(&self) -> &[f64] {
        &self.point
    }

    /// The same, source by source.
    pub(super) fn mixture(&self, view: &View<'_>) -> Mixture {
        let Self { pieces, places, .. } = self;
        let sources = view.sources.list.len();
        let (mut amplitudes, mut temperature_k) = (vec![0.0; sources], vec![0.0; sources]);
        let mut point = self.point.clone();
        rises(places).for_each(|i| point[i - 1] -= point[i]);
        for ((amount, s), t) in point.iter().zip(&pieces.source).zip(&pieces.temperature_k) {
            amplitudes[*s] += amount;
            temperature_k[*s] += amount * t;
        }
        for (s, (t, amplitude)) in temperature_k.iter_mut().zip(&mut amplitudes).enumerate() {
            let own = pieces.source.iter().position(|&source| source == s).unwrap_or(0);
            *t = if *amplitude > 0.0 { *t / *amplitude } else { pieces.temperature_k[own] };
            if pieces.unit[own][0] < pieces.unit[own][1] {
                *amplitude /= view.sources.scale(*t);
            }
        }
        Mixture { amplitudes, temperature_k }
    }

    /// Lays out the pieces of a box.
    fn lay(&mut self, view: &View<'_>, ends: &[[usize; 2]]) {
        let Self { pieces, places, low, rise, half, most, .. } = self;
        pieces.clear();
        places.clear();
        most.resize(view.axes.len(), 0.0);
        for columns in [&mut *low, &mut *rise, &mut *half] {
            columns.resize_with(view.axes.len(), Vec::new);
            columns.iter_mut().for_each(|column| column.resize(view.root.len(), 0.0));
        }
        for s in 0..view.sources.list.len() {
            if let Some(spectrum) = &view.later.fixed[s] {
                pieces.put_known(s, spectrum);
                places.push(Place::Fixed(s));
                continue;
            }
            let axis = view.axes.iter().position(|&axis| axis == s).unwrap_or(0);
            let [Some(cold), Some(hot)] = ends[axis].map(|end| view.end(axis, end)) else { continue };
            let temperature_k = [cold, hot].map(|end| end.spectrum.temperature_k);
            let rounding = view.sources.rounding(temperature_k[0]);
            let mut lay = |[cold, hot]: [&Spectrum; 2], more: f64| {
                chord(Chord {
                    width: hot.along - cold.along,
                    more,
                    cold: [&cold.counts, &cold.slope],
                    hot: [&hot.counts, &hot.slope],
                    low: &mut low[axis],
                    rise: &mut rise[axis],
                    half: &mut half[axis],
                });
            };
            let (lengths, caps, unit);
            match view.shapes(axis, ends[axis]) {
                Some([(dim, cold_scale), (bright, hot_scale)]) => {
                    let [x, least_x] = temperature_k.map(|t| view.sources.lowest_x(t));
                    let bent = (x - least_x) * (x - least_x) * (-least_x).exp() / 24.0;
                    lay([dim, bright], rounding + 2.0 * bent);
                    let all = (cold.most * cold_scale).min(view.most(s) * hot_scale);
                    (lengths, caps, unit) =
                        ([dim.lengths()[0]; 2], [all; 2], [1.0 / hot_scale, 1.0 / cold_scale]);
                }
                None => {
                    let (dim, bright) = (&cold.spectrum, &hot.spectrum);
                    lay([dim, bright], rounding);
                    let width_k = bright.along - dim.along;
                    let limited = s > 0 && !view.allowed.gain_free;
                    let cap = if limited {
                        largest_share(&view.later.brightest, &dim.counts, &dim.slope, width_k)
                    } else {
                        f64::INFINITY
                    };
                    let [length, slope_length] = dim.lengths();
                    lengths = [length, length + width_k * slope_length];
                    (caps, unit) = ([cold.most.min(view.most(s)), cap], [1.0; 2]);
                }
            }
            most[axis] = caps[0].max(0.0);
            for (i, place) in [Place::Low(axis), Place::Rise(axis)].into_iter().enumerate() {
                let (length, cap, temperature_k) = (lengths[i], caps[i], temperature_k[i]);
                pieces.put(Piece { source: s, length, cap, temperature_k, unit });
                places.push(place);
            }
        }
    }

    /// The pieces of a box, for tests, with their spectra and what the chords miss.
    #[cfg(test)]
    pub(super) fn laid(
        &mut self,
        view: &mut View<'_>,
        ends: &[[usize; 2]],
    ) -> (Pieces, Vec<Vec<f64>>, Vec<Vec<f64>>) {
        view.look();
        self.lay(view, ends);
        let columns = self.places.iter().map(|place| match *place {
            Place::Fixed(s) => {
                view.later.fixed[s].as_ref().map_or_else(Vec::new, |fixed| fixed.counts.clone())
            }
            Place::Low(axis) => self.low[axis].clone(),
            Place::Rise(axis) => self.rise[axis].clone(),
        });
        let columns = columns.collect();
        (self.pieces.clone(), columns, self.half.clone())
    }
}
