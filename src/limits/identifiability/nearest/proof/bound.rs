//! The bound of d² in a box of temperatures.
//!
//! In a box every source of unknown temperature is a mixture of two spectra, the ends of its chord (`sources`), but for what
//! the chord misses: ‖W(N′ − ΣzA)‖ ≤ m. With the quadratic of `metric` about some N₀, h its shift, and
//! φ(δ) = ‖W(ΣzA − N₀) + h‖² − ‖h‖² (`hull`),
//!
//! d² ≥ cost − ‖h‖² + (√(‖h‖² + φ) − m)²,
//!
//! 0 in place of the bracket where that is negative; or, as m is in proportion to the amplitudes, with the least of the convex
//! √(‖h‖² + φ) − m(z) in its place. Where it comes out least is where the next quadratic is written about.
//!
//! What the amplitudes may be: a curve lies above its cold end and above its tangent there, so that c(1 − λ) of the one and cλ
//! of the other never are more than a band can have within reach, nor all bands together.

use super::amplitudes::{Amplitudes, Piece, Pieces, Ray};
use super::hull::{Hull, Quadratic, factor_of};
use super::metric::{Ellipsoid, Metric};
use super::orthogonal::{inner, reduce};
use super::sources::{Chord, Spectrum, chord, whole};
use super::vectors::{add_into, largest_share, product_into, square_of_product};
use super::view::View;
use crate::sum::dot;

/// Share of the bound wanted, or of the quadratic's least, beyond which what chords miss makes better quadratics useless.
const COARSE: f64 = 0.25;
/// Share of what is wanting that a better quadratic must have brought for another one to be tried.
const WORTH: f64 = 0.03;
/// How many times the rounding of counts a distance must be to be seen in them.
pub(super) const CLEAR: f64 = 4.0;
/// Rounding of the square of a length that is divided in two, as a share of it.
const ROUNDING: f64 = 1e-13;
/// Attempts with products of columns; after that their digits are all kept.
const PLAIN: usize = 2;

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
    /// Columns times the weights, and where their digits are all kept what of the priors follows.
    whitened: Vec<Vec<f64>>,
    /// Entries of the priors, row by row, and their residuals.
    rows: Vec<f64>,
    residuals: Vec<f64>,
    /// How bright the root of every band can be in the box.
    brightest: Vec<f64>,
    counts: Vec<f64>,
    metric: Metric,
    /// What the chord of a piece of amplitude 1 misses, as a length: 0 but at cold ends.
    missed: Vec<f64>,
    /// Whether the last quadratic was about the target itself.
    is_about_target: bool,
    square: Vec<f64>,
    quadratic: Quadratic,
    hull: Hull,
    ray: Ray,
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

/// What a quadratic is written with, besides what stands in the memory.
struct Written {
    cost: f64,
    /// ‖h‖².
    shift: f64,
    /// Rounding of the counts that are compared, as a length.
    grain: f64,
    /// m, and the axis that has most of it.
    missed: f64,
    axis: usize,
}

impl Bounder {
    /// A bound of d² in a box, over `narrower` amplitudes where these are given, from so many quadratics at most; the first of
    /// them about `start`, amplitudes of the pieces.
    pub(super) fn bound(
        &mut self,
        view: &mut View<'_>,
        ends: &[[usize; 2]],
        narrower: Option<&Amplitudes>,
        enough: f64,
        start: Option<&[f64]>,
        quadratics: usize,
    ) -> Bound {
        crate::stop::check();
        view.look();
        let view = &*view;
        self.lay(view, ends);
        let narrower = narrower.map(|allowed| Amplitudes { total: view.allowed.total, ..allowed.clone() });
        let allowed = narrower.as_ref().unwrap_or(&view.allowed);
        self.hull.point.clear();
        self.hull.point.extend_from_slice(start.unwrap_or_default());
        self.brightest.clear();
        self.brightest.extend(view.root.iter().map(|y| y + view.reach));
        let mut both = vec![0.0; self.places.len()];
        let mut found = Bound { lower: 0.0, axis: 0, coarse: false };
        for attempt in 0..quadratics {
            crate::stop::check();
            let Written { cost, shift, grain, missed, axis } = self.write(view, attempt >= PLAIN);
            found.axis = axis;
            // What is subtracted from each other here, and how much of it rounding may be.
            let rounding = 1e-15 * (cost + shift);
            let rest = cost - shift - rounding;
            let wanted = ((enough - rest).max(0.0).sqrt() + missed).powi(2) - shift;
            let Self { hull, quadratic, places, pieces, ray, missed: each, .. } = self;
            quadratic.most.clear();
            quadratic.most.extend((0..places.len()).map(|i| allowed.most(pieces, i)));
            let mut cheapest = |costs: &[f64], vertex: &mut [f64]| {
                both.copy_from_slice(costs);
                rises(places).for_each(|i| both[i] += costs[i - 1]);
                allowed.least(pieces, &both, vertex, ray);
                let rounding = allowed.rounding(pieces, &both, vertex, ray);
                rises(places).for_each(|i| vertex[i - 1] += vertex[i]);
                rounding
            };
            let fall = hull.least(quadratic, &mut cheapest, wanted);
            let left = (shift + fall).max(0.0).sqrt();
            // (left − missed)² without the difference of squares that may be nearly equal; nothing of what is hardly more than
            // the rounding of the counts that are compared.
            let seen = left > missed && left > CLEAR * grain;
            let apart = cost - rounding + fall + missed * (missed - 2.0 * left);
            let mut lower = if seen { apart } else { rest.min(0.0) };
            if lower < enough && missed > grain {
                // What chords miss is in proportion to the amplitudes, of which the least may need next to nothing.
                let length = hull.length_less(quadratic, &mut cheapest, each) - grain;
                if length > CLEAR * grain {
                    lower = lower
                        .max(cost - rounding + (length - quadratic.length) * (length + quadratic.length));
                }
            }
            // Without its rounding, which another origin makes small.
            let there = shift + fall + hull.rounding;
            found.coarse = missed * missed > COARSE * enough.max(there);
            let gained = lower - found.lower;
            found.lower = found.lower.max(lower);
            if found.lower >= enough || found.coarse {
                break;
            }
            let wanting = enough - found.lower;
            if attempt > 0 && gained < WORTH * wanting && hull.rounding < WORTH * wanting {
                break;
            }
            if attempt + 1 < quadratics {
                self.narrow(view, rest, missed);
            }
        }
        found
    }

    /// How bright bands can be by the last quadratic: states within reach have √(‖h‖² + φ) ≤ m + √(reach² − rest).
    fn narrow(&mut self, view: &View<'_>, rest: f64, missed: f64) {
        let Self { places, half, most, whitened, counts, metric, brightest, is_about_target, .. } = self;
        let metric = if *is_about_target { &view.later.about_target } else { &*metric };
        let basis = &mut whitened[..places.len()];
        // Priors only take states farther away: without them more are within reach.
        basis.iter_mut().for_each(|column| column.truncate(view.root.len()));
        let (_, along) = reduce(basis, &[&metric.shift]);
        let [along] = &along[..] else { return };
        let across = along[places.len()];
        let within = missed + (view.reach * view.reach - rest).max(0.0).sqrt();
        let shift = metric.length * metric.length;
        let radius = ((within - across) * (within + across) + ROUNDING * shift).max(0.0).sqrt();
        let mut off = vec![0.0; view.root.len()];
        half.iter().zip(&*most).for_each(|(half, most)| add_into(*most, half, &mut off));
        let ellipsoid = Ellipsoid { basis, along, radius, counts, missed: &off };
        ellipsoid.lower(&metric.weight, &view.noise, brightest);
    }

    /// Where the last bound was least: an amplitude for every piece.
    pub(super) fn point(&self) -> &[f64] {
        &self.hull.point
    }

    /// The same, source by source.
    pub(super) fn mixture(&self, view: &View<'_>) -> Mixture {
        let Self { pieces, places, hull, .. } = self;
        let sources = view.sources.list.len();
        let (mut amplitudes, mut temperature_k) = (vec![0.0; sources], vec![0.0; sources]);
        let mut point = hull.point.clone();
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

    /// Writes the quadratic about the last point, or about the target where there is none; with all `digits` of columns that
    /// their products cannot tell apart.
    fn write(&mut self, view: &View<'_>, digits: bool) -> Written {
        let Self { places, low, rise, half, most, whitened, counts, metric, .. } = self;
        let Self { square, quadratic, hull, brightest, is_about_target, missed: each, .. } = self;
        let Self { pieces, rows, residuals, .. } = self;
        let column = |place: Place| -> &[f64] {
            match place {
                Place::Fixed(s) => view.later.fixed[s].as_ref().map_or(&[], |spectrum| &spectrum.counts),
                Place::Low(axis) => &low[axis],
                Place::Rise(axis) => &rise[axis],
            }
        };
        let m = places.len();
        quadratic.origin.clear();
        counts.clear();
        counts.resize(view.root.len(), 0.0);
        let metric = if hull.point.len() == m {
            for (place, amount) in places.iter().zip(&hull.point) {
                add_into(*amount, column(*place), counts);
            }
            quadratic.origin.extend_from_slice(&hull.point);
            metric.put_about(counts, [&view.root, &view.counts, &view.noise], brightest);
            *is_about_target = false;
            &*metric
        } else {
            quadratic.origin.resize(m, 0.0);
            *is_about_target = true;
            &view.later.about_target
        };
        whitened.resize_with(whitened.len().max(m), Vec::new);
        for (out, place) in whitened.iter_mut().zip(&*places) {
            out.resize(view.root.len(), 0.0);
            product_into(column(*place), &metric.weight, out);
        }
        let mut along: Vec<f64> = whitened[..m].iter().map(|column| dot(column, &metric.shift)).collect();
        rows.clear();
        residuals.clear();
        view.priors.put_pieces(pieces, |constant, entries| {
            let residual = constant + inner(entries, &quadratic.origin);
            along.iter_mut().zip(entries).for_each(|(along, entry)| *along += residual * entry);
            rows.extend_from_slice(entries);
            residuals.push(residual);
        });
        let of_priors = inner(residuals, residuals);
        let shift = metric.length * metric.length + of_priors;
        quadratic.length = if of_priors > 0.0 { shift.sqrt() } else { metric.length };
        quadratic.linear.clear();
        quadratic.linear.extend(along.iter().map(|along| 2.0 * along));
        if digits {
            if !rows.is_empty() {
                for (i, column) in whitened[..m].iter_mut().enumerate() {
                    column.extend(rows.iter().skip(i).step_by(m));
                    column.resize(whole(column.len()), 0.0);
                }
            }
            let (triangle, _) = reduce(&mut whitened[..m], &[]);
            quadratic.factor.clear();
            quadratic.excess.fill(0.0);
            triangle.iter().for_each(|column| quadratic.factor.extend(column));
        } else {
            square.resize(m * m, 0.0);
            for i in 0..m {
                for j in 0..=i {
                    let of_priors: f64 = rows.chunks(m).map(|row| row[i] * row[j]).sum();
                    let product = dot(&whitened[i], &whitened[j]) + of_priors;
                    (square[i * m + j], square[j * m + i]) = (product, product);
                }
            }
            factor_of(square, &mut quadratic.factor, &mut quadratic.excess);
        }
        let length = |x: &[f64]| square_of_product(x, &metric.weight).sqrt();
        let grain = view.rounding * (length(&view.counts) + length(counts));
        let (mut missed, mut largest, mut most_missed) = (grain, -1.0, 0);
        each.clear();
        each.resize(m, 0.0);
        for (axis, (half, most)) in half.iter().zip(&*most).enumerate() {
            let of_unit = length(half);
            if let Some(place) =
                places.iter().position(|place| matches!(place, Place::Low(own) if *own == axis))
            {
                each[place] = of_unit;
            }
            let part = most * of_unit;
            missed += part;
            if part > largest {
                (largest, most_missed) = (part, axis);
            }
        }
        Written { cost: metric.cost + of_priors, shift, grain, missed, axis: most_missed }
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
