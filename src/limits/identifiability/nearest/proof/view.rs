//! A pair in all its bands or in some of them, and the bound of d² in a box of temperatures.
//!
//! In a box every source of unknown temperature is a mixture of two spectra, the ends of its chord (`sources`), but for what
//! the chord misses: ‖W(N′ − ΣzA)‖ ≤ m. With the quadratic of `metric` about some N₀, h its shift, and
//! φ(δ) = ‖W(ΣzA − N₀) + h‖² − ‖h‖² (`hull`),
//!
//! d² ≥ cost − ‖h‖² + (√(‖h‖² + φ) − m)²,
//!
//! 0 in place of the bracket where that is negative. Where it comes out least is where the next quadratic is written about.
//! Fewer bands never carry more information, and where they prove enough they are quicker.
//!
//! What the amplitudes may be: a curve lies above its cold end and above its tangent there, so that c(1 − λ) of the one and cλ
//! of the other never are more than a band can have within reach, nor all bands together.

use super::amplitudes::{Amplitudes, Piece, Pieces, Ray};
use super::hull::{Hull, Quadratic, factor_of};
use super::metric::Metric;
use super::orthogonal::reduce;
use super::sources::{Chord, LARGEST_LN_GAIN, Sources, Spectrum, chord, whole};
use super::vectors::{add_into, largest_share, product_into, square_of_product};
use crate::sum::dot;

/// Rounding of a length, as a share of its terms, besides that of Planck's function.
const ROUNDING: f64 = 1e-15;
/// Share of the bound wanted, or of the quadratic's least, beyond which what chords miss makes better quadratics useless.
const COARSE: f64 = 0.25;
/// Share of what is wanting that a better quadratic must have brought for another one to be tried.
const WORTH: f64 = 0.03;

/// From how much more radiance at the hot end on a box is wide.
const WIDE: f64 = 2.0;

/// How many times the rounding of counts a distance must be to be seen in them.
const CLEAR: f64 = 4.0;
/// Attempts with products of columns; after that their digits are all kept.
const PLAIN: usize = 2;

/// A spectrum of a source at one end of an interval.
struct End {
    spectrum: Spectrum,
    /// Its shape, and β.
    shape: Option<(Spectrum, f64)>,
    /// The largest amplitude with which no band alone is beyond reach.
    most: f64,
}

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

/// A pair in some of its bands.
pub(super) struct View<'a> {
    pub(super) sources: Sources<'a>,
    pub(super) allowed: Amplitudes,
    /// √(N + v), N and v of every band, in whole chunks.
    pub(super) root: Vec<f64>,
    counts: Vec<f64>,
    noise: Vec<f64>,
    /// The distance within which everything is.
    pub(super) reach: f64,
    /// Sources of unknown temperature, and their spectra at the temperatures known, as far as they were needed.
    pub(super) axes: Vec<usize>,
    ends: Vec<Vec<Option<End>>>,
    /// Rounding of the counts that are compared, as a share of them.
    rounding: f64,
    shaped: Vec<Shaped>,
    /// Temperatures below which the axes send next to nothing.
    dark_k: Vec<f64>,
    later: Later,
}

/// What only a look at these bands needs: where few bands suffice, all of them are never looked at.
#[derive(Default)]
struct Later {
    /// Spectra of the sources of known temperature.
    fixed: Vec<Option<Spectrum>>,
    /// The counts that each band can have within reach.
    brightest: Vec<f64>,
    about_target: Metric,
    work: Work,
}

/// Whether the shape of a source is taken instead of itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Shaped {
    /// Its amplitude is free.
    Always,
    /// Its amplitude hangs on another one's, which a wide box hardly tells of.
    Wide,
    /// Its amplitude is known.
    Never,
}

/// Memory of [`View::bound`], for one box after the other.
#[derive(Default)]
struct Work {
    pieces: Pieces,
    places: Vec<Place>,
    /// Of every axis: the cold end of the chord, what it rises by to the hot one, what it misses, and the largest amplitude.
    low: Vec<Vec<f64>>,
    rise: Vec<Vec<f64>>,
    half: Vec<Vec<f64>>,
    most: Vec<f64>,
    /// Columns times the weights.
    whitened: Vec<Vec<f64>>,
    counts: Vec<f64>,
    metric: Metric,
    square: Vec<f64>,
    quadratic: Quadratic,
    hull: Hull,
    ray: Ray,
}

/// Where the spectrum of a piece is.
#[derive(Clone, Copy)]
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

impl<'a> View<'a> {
    pub(super) fn new(sources: Sources<'a>, allowed: Amplitudes, bands: [Vec<f64>; 3], reach: f64) -> Self {
        let [root, counts, noise] = bands.map(|mut x| {
            x.resize(whole(x.len()), 0.0);
            x
        });
        let size = dot(&root, &root).sqrt() + reach;
        let total = (size * size - crate::sum::sum(&noise)) * (1.0 + 1e-12);
        let allowed = Amplitudes { total, ..allowed };
        let axes: Vec<usize> = (0..sources.list.len()).filter(|&s| sources.list[s].free()).collect();
        let ends = axes.iter().map(|_| Vec::new()).collect();
        let sent = crate::sum::sum(&counts);
        let mut dark_k = vec![0.0; axes.len()];
        let open = |range: &[f64; 2]| range[0] < range[1];
        let shaped = axes.iter().zip(&mut dark_k).map(|(&s, dark_k)| {
            let shaped = match s.checked_sub(1) {
                None if !allowed.gain_free => Shaped::Never,
                None if allowed.ranges.iter().all(open) => Shaped::Always,
                Some(k) if open(&allowed.ranges[k]) => Shaped::Always,
                Some(_) if !allowed.gain_free => Shaped::Never,
                _ => Shaped::Wide,
            };
            match (shaped, sources.dark_k(s, sent)) {
                (Shaped::Never, _) | (_, None) => Shaped::Never,
                (shaped, Some(k)) => {
                    *dark_k = k;
                    shaped
                }
            }
        });
        let shaped = shaped.collect();
        // What is colder than the target sends less of its counts than it is less exact.
        let rounding = ROUNDING + 2.0 * sources.list.first().map_or(0.0, |own| sources.rounding(own.known_k));
        let later = Later::default();
        Self { sources, allowed, root, counts, noise, reach, axes, ends, rounding, shaped, dark_k, later }
    }

    /// Makes sure of what only a look at these bands needs.
    pub(super) fn look(&mut self) {
        if !self.later.fixed.is_empty() {
            return;
        }
        let (reach, bands, axes) = (self.reach, self.root.len(), self.axes.len());
        let fixed =
            self.sources.list.iter().enumerate().map(|(s, source)| {
                (!source.free()).then(|| self.sources.spectrum(s, source.temperature_k[0]))
            });
        let brightest = self.root.iter().zip(&self.noise);
        let brightest = brightest.map(|(y, v)| (y + reach) * (y + reach) * (1.0 + 1e-9) - v);
        let empty = || vec![vec![0.0; bands]; axes];
        self.later = Later {
            fixed: fixed.collect(),
            brightest: brightest.collect(),
            about_target: Metric::about_target(&self.root, &self.counts, reach),
            work: Work {
                low: empty(),
                rise: empty(),
                half: empty(),
                most: vec![0.0; axes],
                whitened: vec![vec![0.0; bands]; self.sources.list.len() + axes],
                ..Work::default()
            },
        };
    }

    /// Makes sure of the spectrum at an end of an interval.
    pub(super) fn know(&mut self, axis: usize, place: usize, temperature_k: f64) {
        self.look();
        if self.ends[axis].len() <= place {
            self.ends[axis].resize_with(place + 1, || None);
        }
        if self.ends[axis][place].is_some() {
            return;
        }
        let spectrum = self.sources.spectrum(self.axes[axis], temperature_k);
        let most = largest_share(&self.later.brightest, &spectrum.counts, &spectrum.slope, 0.0);
        let shape = if self.shaped[axis] == Shaped::Never { None } else { self.sources.shape(&spectrum) };
        self.ends[axis][place] = Some(End { spectrum, shape, most });
    }

    /// The temperature below which a source of free amplitude need not be looked at.
    pub(super) fn coldest_k(&self, axis: usize) -> f64 {
        self.dark_k[axis]
    }

    /// Whether even `amplitude` of a source is beyond reach in some band at an end.
    pub(super) fn too_bright(
        &mut self,
        axis: usize,
        place: usize,
        temperature_k: f64,
        amplitude: f64,
    ) -> bool {
        self.know(axis, place, temperature_k);
        self.ends[axis][place].as_ref().is_some_and(|end| end.most < amplitude)
    }

    /// The spectrum of a source at a temperature.
    pub(super) fn spectrum(&self, s: usize, temperature_k: f64) -> Spectrum {
        match self.later.fixed.get(s) {
            Some(Some(spectrum)) => spectrum.clone(),
            _ => self.sources.spectrum(s, temperature_k),
        }
    }

    /// The amplitude of a source, where it is known.
    pub(super) fn held(&self, s: usize) -> Option<f64> {
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

    /// The largest amplitude that a source can have by its range.
    fn most(&self, s: usize) -> f64 {
        let gain = if self.allowed.gain_free { LARGEST_LN_GAIN.exp() } else { 1.0 };
        match s.checked_sub(1) {
            None => gain,
            Some(k) => gain * self.allowed.ranges[k][1].min(self.allowed.sum),
        }
    }

    /// Lays out the pieces of a box.
    fn lay(&self, ends: &[[usize; 2]], work: &mut Work) {
        work.pieces.clear();
        work.places.clear();
        for s in 0..self.sources.list.len() {
            if let Some(spectrum) = &self.later.fixed[s] {
                work.pieces.put_known(s, spectrum);
                work.places.push(Place::Fixed(s));
                continue;
            }
            let axis = self.axes.iter().position(|&axis| axis == s).unwrap_or(0);
            let [Some(cold), Some(hot)] = ends[axis].map(|end| self.ends[axis][end].as_ref()) else {
                continue;
            };
            let temperature_k = [cold, hot].map(|end| end.spectrum.temperature_k);
            let rounding = self.sources.rounding(temperature_k[0]);
            let mut lay = |[cold, hot]: [&Spectrum; 2], more: f64| {
                chord(Chord {
                    width: hot.along - cold.along,
                    more,
                    cold: [&cold.counts, &cold.slope],
                    hot: [&hot.counts, &hot.slope],
                    low: &mut work.low[axis],
                    rise: &mut work.rise[axis],
                    half: &mut work.half[axis],
                });
            };
            let (lengths, caps, unit);
            match (&cold.shape, &hot.shape) {
                (Some((dim, cold_scale)), Some((bright, hot_scale)))
                    if self.shaped[axis] == Shaped::Always || *hot_scale > WIDE * cold_scale =>
                {
                    let [x, least_x] = temperature_k.map(|t| self.sources.lowest_x(t));
                    let bent = (x - least_x) * (x - least_x) * (-least_x).exp() / 24.0;
                    lay([dim, bright], rounding + 2.0 * bent);
                    let most = (cold.most * cold_scale).min(self.most(s) * hot_scale);
                    (lengths, caps, unit) = ([dim.length; 2], [most; 2], [1.0 / hot_scale, 1.0 / cold_scale]);
                }
                _ => {
                    let (dim, bright) = (&cold.spectrum, &hot.spectrum);
                    lay([dim, bright], rounding);
                    let width_k = bright.along - dim.along;
                    let limited = s > 0 && !self.allowed.gain_free;
                    let cap = if limited {
                        largest_share(&self.later.brightest, &dim.counts, &dim.slope, width_k)
                    } else {
                        f64::INFINITY
                    };
                    lengths = [dim.length, dim.length + width_k * dim.slope_length];
                    (caps, unit) = ([cold.most.min(self.most(s)), cap], [1.0; 2]);
                }
            }
            work.most[axis] = caps[0].max(0.0);
            for (i, place) in [Place::Low(axis), Place::Rise(axis)].into_iter().enumerate() {
                let (length, cap, temperature_k) = (lengths[i], caps[i], temperature_k[i]);
                work.pieces.put(Piece { source: s, length, cap, temperature_k, unit });
                work.places.push(place);
            }
        }
    }

    /// The spectrum of a piece.
    fn column<'w>(&'w self, [low, rise]: [&'w [Vec<f64>]; 2], place: Place) -> &'w [f64] {
        match place {
            Place::Fixed(s) => self.later.fixed[s].as_ref().map_or(&[], |spectrum| &spectrum.counts),
            Place::Low(axis) => &low[axis],
            Place::Rise(axis) => &rise[axis],
        }
    }

    /// A bound of d² in a box, over `narrower` amplitudes where these are given, from so many quadratics at most; the first of
    /// them about `start`, amplitudes of the pieces.
    pub(super) fn bound(
        &mut self,
        ends: &[[usize; 2]],
        narrower: Option<&Amplitudes>,
        enough: f64,
        start: Option<&[f64]>,
        quadratics: usize,
    ) -> Bound {
        self.look();
        let mut work = std::mem::take(&mut self.later.work);
        self.lay(ends, &mut work);
        let Work {
            pieces,
            places,
            low,
            rise,
            half,
            most,
            whitened,
            counts,
            metric,
            square,
            quadratic,
            hull,
            ray,
        } = &mut work;
        let m = places.len();
        let narrower = narrower.map(|allowed| Amplitudes { total: self.allowed.total, ..allowed.clone() });
        let allowed = narrower.as_ref().unwrap_or(&self.allowed);
        let mut both = vec![0.0; m];
        let mut cheapest = |costs: &[f64], vertex: &mut [f64]| {
            both.copy_from_slice(costs);
            rises(places).for_each(|i| both[i] += costs[i - 1]);
            allowed.least(pieces, &both, vertex, ray);
            rises(places).for_each(|i| vertex[i - 1] += vertex[i]);
        };
        hull.point.clear();
        hull.point.extend_from_slice(start.unwrap_or_default());
        let mut found = Bound { lower: 0.0, axis: 0, coarse: false };
        for attempt in 0..quadratics {
            quadratic.origin.clear();
            let metric = if hull.point.len() == m {
                counts.clear();
                counts.resize(self.root.len(), 0.0);
                for (place, amount) in places.iter().zip(&hull.point).filter(|(_, amount)| **amount > 0.0) {
                    add_into(*amount, self.column([low, rise], *place), counts);
                }
                quadratic.origin.extend_from_slice(&hull.point);
                metric.put_about(counts, [&self.root, &self.counts, &self.noise], self.reach);
                &*metric
            } else {
                quadratic.origin.resize(m, 0.0);
                &self.later.about_target
            };
            for (out, place) in whitened.iter_mut().zip(&*places) {
                product_into(self.column([low, rise], *place), &metric.weight, out);
            }
            quadratic.length = metric.length;
            quadratic.linear.clear();
            quadratic.linear.extend(whitened[..m].iter().map(|column| 2.0 * dot(column, &metric.shift)));
            if attempt < PLAIN {
                square.resize(m * m, 0.0);
                for i in 0..m {
                    for j in 0..=i {
                        let product = dot(&whitened[i], &whitened[j]);
                        (square[i * m + j], square[j * m + i]) = (product, product);
                    }
                }
                factor_of(square, &mut quadratic.factor, &mut quadratic.excess);
            } else {
                // Columns that products cannot tell apart.
                let (triangle, _) = reduce(&mut whitened[..m], &[]);
                quadratic.factor.clear();
                quadratic.excess.fill(0.0);
                triangle.iter().for_each(|column| quadratic.factor.extend(column));
            }
            let grain = self.rounding * self.later.about_target.length;
            let (mut missed, mut largest) = (grain, -1.0);
            for (axis, (half, most)) in half.iter().zip(&*most).enumerate() {
                let part = most * square_of_product(half, &metric.weight).sqrt();
                missed += part;
                if part > largest {
                    (largest, found.axis) = (part, axis);
                }
            }
            let shift = metric.length * metric.length;
            // What is subtracted from each other here, and how much of it rounding may be.
            let rounding = 1e-15 * (metric.cost + shift);
            let rest = metric.cost - shift - rounding;
            let wanted = ((enough - rest).max(0.0).sqrt() + missed).powi(2) - shift;
            let fall = hull.least(quadratic, &mut cheapest, wanted);
            let left = (shift + fall).max(0.0).sqrt();
            // (left − missed)² without the difference of squares that may be nearly equal; nothing of what is hardly more than
            // the rounding of the counts that are compared.
            let seen = left > missed && left > CLEAR * grain;
            let apart = metric.cost - rounding + fall + missed * (missed - 2.0 * left);
            let lower = if seen { apart } else { rest.min(0.0) };
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
        }
        self.later.work = work;
        found
    }

    /// Where the last bound was least: an amplitude for every piece.
    pub(super) fn point(&self) -> &[f64] {
        &self.later.work.hull.point
    }

    /// The same, source by source.
    pub(super) fn mixture(&self) -> Mixture {
        let Work { pieces, places, hull, .. } = &self.later.work;
        let sources = self.sources.list.len();
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
                *amplitude /= self.sources.scale(*t);
            }
        }
        Mixture { amplitudes, temperature_k }
    }

    /// The pieces of a box, for tests, with their spectra and what the chords miss.
    #[cfg(test)]
    pub(super) fn laid(&mut self, ends: &[[usize; 2]]) -> (Pieces, Vec<Vec<f64>>, Vec<Vec<f64>>) {
        let mut work = std::mem::take(&mut self.later.work);
        self.lay(ends, &mut work);
        let columns = work.places.iter().map(|place| self.column([&work.low, &work.rise], *place).to_vec());
        let laid = (work.pieces.clone(), columns.collect(), work.half.clone());
        self.later.work = work;
        laid
    }
}
