//! The bound of d² in a box of temperatures.
//!
//! In a box every source of unknown temperature is a mixture of two spectra, the ends of its chord (`sources`), but for what
//! the chord misses. A first look is by the quadratic of `metric` about the target: with ‖W(N′ − ΣzA)‖ ≤ m
//!
//! d ≥ ‖W(ΣzA − N)‖ − m,
//!
//! the least of it over the amplitudes (`hull`): of the square, or as m is in proportion to the amplitudes of the convex difference. From
//! where that is least a search goes to the least of the cost itself, what chords miss included, and a tangent there is a bound as exact
//! as can be (`least`).
//!
//! What the amplitudes may be: a curve lies above its cold end and above its tangent there, so that c(1 − λ) of the one and cλ
//! of the other never are more than a band can have within reach, nor all bands together.

mod least;
mod pieces;

#[cfg(test)]
use self::pieces::column;
use self::pieces::{Cheapest, Place, Vertex, put_products, put_square, rises};
use super::amplitudes::{Amplitudes, Piece, Pieces};
use super::hull::{Hull, Quadratic, factor_of};
use super::orthogonal::inner;
use super::sources::{Chord, Spectrum, chord};
use super::vectors::{largest_share, square_of_product};
use super::view::View;
use crate::sum::dot;

/// Share of what is wanted, and of the cost without what chords miss, below which the least cost over a box is so far from it that finer
/// bands hardly help.
const COARSE: f64 = 0.5;
/// How many times the rounding of counts a distance must be to be seen in them.
pub(super) const CLEAR: f64 = 4.0;
/// Share of the largest amplitude below which one is as good as none.
const HARDLY: f64 = 1e-3;

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
            amplitude * square_of_product(&self.half[axis], &view.in_boxes().about_target.weight).sqrt()
        };
        let parts: Vec<f64> = (0..view.axes.len()).map(missed).collect();
        (0..parts.len()).max_by(|&i, &j| parts[i].total_cmp(&parts[j])).unwrap_or(0)
    }

    /// A bound by the quadratic about the target.
    fn about_target(&mut self, view: &View<'_>, allowed: &Amplitudes, enough: f64) -> f64 {
        let Self { places, low, rise, half, most, whitened, rows, residuals, .. } = self;
        let Self { square, quadratic, hull, pieces, memory, missed: each, .. } = self;
        let metric = &view.in_boxes().about_target;
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
            if let Some(spectrum) = &view.fixed[s] {
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
                        largest_share(view.brightest(), &dim.counts, &dim.slope, width_k)
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
        let columns = self.places.iter().map(|place| column(view, [&self.low, &self.rise], *place).to_vec());
        let columns = columns.collect();
        (self.pieces.clone(), columns, self.half.clone())
    }
}
