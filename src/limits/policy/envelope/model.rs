//! Counts of target and alternative as sums over sources, each of one temperature.
//!
//! N − N′ = κΣ_s [v_s f_s(T_s) + w_s g_s(T_s)]: f and g are band integrals of a fixed spectrum times B(T_s), v what the
//! source gives the target (and the alternative, where it does not know better), w what it gives the alternative alone.
//! With c₀ = G the alternative's gain and cₖ = G·Vₖ′ all is linear in the factors; what ties them is in `relation`.
//!
//! | source | v | f | w | g |
//! |---|---|---|---|---|
//! | the target's surface | 1 | e | | |
//! | the alternative's, temperature unknown | c₀ | −e′ | | |
//! | both, temperature known, gain unknown | 1 | e | c₀ | −e′ |
//! | both, temperature and gain known | 1 | e − e′ | | |
//! | object k, lighting or gain unknown | Vₖ | (1 − e)εₖ | cₖ | −(1 − e′)εₖ |
//! | object k, lighting and gain known | Vₖ | (e′ − e)εₖ | | |
//! | object k with a temperature of the alternative's own | Vₖ | (1 − e)εₖ | | |
//! | the alternative's object k | cₖ | −(1 − e′)εₖ | | |

use super::linear::{COLUMNS, SOURCES};
use super::ranges::Ranges;
use super::relation::{Product, Relation};
use super::scene::{EnvelopeScene, Stretch};
use crate::fisher::{Nuisance, Unknowns};
use crate::identifiability::{ENVIRONMENT_K, LARGEST_LN_GAIN};
use crate::planck;
use crate::scene::State;
use crate::spectrum::Bands;

/// What a source is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    /// The target's surface, with the alternative's where that is at the same temperature.
    Target,
    /// The alternative's surface at a temperature of its own.
    Alternative,
    /// Object k of the surroundings.
    Object(usize),
    /// Object k at the temperature that the alternative has it.
    AlternativeObject(usize),
}

impl Role {
    /// Whether its temperature is the alternative's to choose.
    pub(super) fn is_free(self) -> bool {
        matches!(self, Self::Alternative | Self::AlternativeObject(_))
    }
}

/// A body of one temperature, with the spectra at the nodes that it is seen by.
#[derive(Debug, Clone)]
pub(super) struct Source {
    pub(super) role: Role,
    /// f and g without B.
    pub(super) own: Vec<f64>,
    pub(super) other: Vec<f64>,
    /// What the target and the alternative see of v, and the alternative of w.
    pub(super) target: Vec<f64>,
    pub(super) alternative: Vec<f64>,
    pub(super) alone: Vec<f64>,
}

/// Ranges of one source: temperature (K), v and w.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Span {
    pub(super) t: [f64; 2],
    pub(super) own: [f64; 2],
    pub(super) other: [f64; 2],
}

/// Ranges of all sources.
pub(super) type Region = Vec<Span>;

/// Values of the temperatures, v and w of all sources.
#[derive(Debug, Clone, Copy)]
pub(super) struct Point {
    pub(super) values: [[f64; 3]; SOURCES],
}

impl Point {
    /// The factors, each in its column.
    pub(super) fn factors(&self) -> [f64; COLUMNS] {
        let mut factors = [0.0; COLUMNS];
        factors.copy_from_slice(self.values.as_flattened());
        factors
    }
}

/// Everything about a pair that does not depend on the ranges.
#[derive(Debug)]
pub(super) struct Model<'a> {
    pub(super) scene: EnvelopeScene<'a>,
    /// Along what distances, if not from one alone.
    pub(super) along: Option<Stretch<'a>>,
    pub(super) sources: Vec<Source>,
    pub(super) var: Vec<f64>,
    /// Shares of N and N′ in the bound of a variance, band by band: ¼(1 + s) and ¼(1 + 1/s).
    pub(super) shares: [Vec<f64>; 2],
    /// Relations of the factors that may be broken, and products.
    pub(super) relations: Vec<Relation>,
    pub(super) products: Vec<Product>,
    /// Columns of G and of G·Vₖ′, where there are any.
    pub(super) gain: Option<usize>,
    lights: Vec<Option<usize>>,
    /// Objects at temperatures of the alternative's own, each with the next that it may change places with.
    pub(super) twins: Vec<[usize; 2]>,
}

/// Whether a lower bound can be proved: on the very distance, if there are no priors.
pub(super) fn provable(unknowns: &Unknowns, objects: usize) -> bool {
    let each = if unknowns.contains(Nuisance::EnvironmentTemperature) { 2 } else { 1 };
    objects * each + 2 <= SOURCES
}

/// Sources as they are put together.
struct Built {
    sources: Vec<Source>,
    region: Region,
}

impl Built {
    /// Adds a source that is seen by `target`, `alternative` (with v) and `alone` (with w).
    fn add(&mut self, role: Role, [target, alternative, alone]: [Vec<f64>; 3], span: Span) -> usize {
        let own = target.iter().zip(&alternative).map(|(a, b)| a - b).collect();
        let other = alone.iter().map(|x| -x).collect();
        self.sources.push(Source { role, own, other, target, alternative, alone });
        self.region.push(span);
        self.sources.len() - 1
    }
}

impl<'a> Model<'a> {
    /// The sources of a pair, and the ranges of the whole envelope.
    pub(super) fn new(scene: &EnvelopeScene<'a>, ranges: &Ranges) -> (Self, Region) {
        use Nuisance::{EnvironmentTemperature, Gain, Lighting, Temperature};
        let [own_t, own_v, own_gain, own_k] = [Temperature, Lighting, Gain, EnvironmentTemperature]
            .map(|nuisance| scene.unknowns.contains(nuisance));
        let (e, other) = (scene.emissivity.to_vec(), scene.alternative.to_vec());
        let zeros = || vec![0.0; e.len()];
        let (one, none) = ([1.0, 1.0], [0.0, 0.0]);
        let gain_range = if own_gain { [(-LARGEST_LN_GAIN).exp(), LARGEST_LN_GAIN.exp()] } else { one };
        let mut built = Built { sources: Vec::new(), region: Vec::new() };
        let t = ranges.temperature_k();
        let span = |t, own, other| Span { t, own, other };
        let mut gain = None;
        if own_t {
            built.add(Role::Target, [e.clone(), zeros(), zeros()], span(t, one, none));
            let t = scene.range.temperature_k;
            let s =
                built.add(Role::Alternative, [zeros(), other.clone(), zeros()], span(t, gain_range, none));
            gain = Some(3 * s + 1);
        } else if own_gain {
            let s = built.add(Role::Target, [e.clone(), zeros(), other.clone()], span(t, one, gain_range));
            gain = Some(3 * s + 2);
        } else {
            built.add(Role::Target, [e.clone(), other.clone(), zeros()], span(t, one, none));
        }
        let gain = gain.filter(|_| own_gain);
        let objects = scene.surroundings.objects();
        let mut lights = Vec::new();
        for (k, object) in objects.iter().enumerate() {
            let own = |j: usize| object.emissivity.as_ref().map_or(1.0, |own| own[j]);
            let lit = |by: &[f64]| (0..by.len()).map(|j| (1.0 - by[j]) * own(j)).collect::<Vec<f64>>();
            let (t, v) = (ranges.environment_k()[k], ranges.lighting()[k]);
            let within = if own_v { lighting_range(scene, k, objects.len()) } else { v };
            let w = [within[0] * gain_range[0], within[1] * gain_range[1]];
            lights.push(if own_k {
                built.add(Role::Object(k), [lit(&e), zeros(), zeros()], span(t, v, none));
                let unseen = [zeros(), lit(&other), zeros()];
                Some(3 * built.add(Role::AlternativeObject(k), unseen, span(ENVIRONMENT_K, w, none)) + 1)
            } else if own_v || own_gain {
                Some(3 * built.add(Role::Object(k), [lit(&e), zeros(), lit(&other)], span(t, v, w)) + 2)
            } else {
                let s = built.add(Role::Object(k), [lit(&e), lit(&other), zeros()], span(t, v, none));
                // (1 − e)εₖ − (1 − e′)εₖ without the difference of what is nearly 1.
                let apart = (0..e.len()).map(|j| (other[j] - e[j]) * own(j));
                built.sources[s].own = apart.collect();
                None
            });
        }
        let Built { sources, region } = built;
        let var: Vec<f64> = (0..scene.bands.len()).map(|band| scene.counting.var_added(band)).collect();
        let shares = [vec![0.5; var.len()], vec![0.5; var.len()]];
        let (relations, products) = (Vec::new(), Vec::new());
        let twins = Vec::new();
        let mut model = Self {
            scene: *scene,
            along: None,
            sources,
            var,
            shares,
            relations,
            products,
            gain,
            lights,
            twins,
        };
        model.relate(&region, own_v);
        if own_v {
            model.pair_twins(&region);
        }
        (model, region)
    }

    /// Writes down what ties the factors, as far as their ranges do not see to it.
    fn relate(&mut self, region: &Region, own_v: bool) {
        let mut all =
            vec![Relation::new(&self.seen().map(|(_, v)| (v, 1.0)).collect::<Vec<_>>(), -1.0, false)];
        // a·c₀, which is a number where the gain is known.
        let with_gain = |mut terms: Vec<(usize, f64)>, a: f64, equal: bool| match self.gain {
            Some(column) => {
                terms.push((column, a));
                Relation::new(&terms, 0.0, equal)
            }
            None => Relation::new(&terms, a, equal),
        };
        let lit: Vec<usize> = self.lights.iter().flatten().copied().collect();
        if own_v && !lit.is_empty() {
            let total = self.scene.unknowns.known_lighting_total();
            let sum = total.unwrap_or(self.scene.range.lighting_sum);
            let terms = lit.iter().map(|&w| (w, 1.0)).collect();
            all.push(with_gain(terms, -sum, total.is_some()));
            for (k, &w) in lit.iter().enumerate() {
                let [low, high] = lighting_range(&self.scene, k, lit.len());
                if high < sum {
                    all.push(with_gain(vec![(w, 1.0)], -high, false));
                }
                if low > 0.0 {
                    all.push(with_gain(vec![(w, -1.0)], low, false));
                }
            }
        }
        let mut products = Vec::new();
        if !own_v {
            for ((_, v), w) in self.seen().zip(&self.lights).filter_map(|(seen, w)| Some((seen, (*w)?))) {
                match self.gain {
                    Some(gain) => products.push(Product { value: w, factors: [v, gain] }),
                    None => all.push(Relation::new(&[(w, 1.0), (v, -1.0)], 0.0, true)),
                }
            }
        }
        let ranges = factors(region);
        all.retain(|relation| relation.binds(&ranges));
        (self.relations, self.products) = (all, products);
    }

    /// Finds objects that the alternative may exchange: then the colder one may be taken to come first.
    fn pair_twins(&mut self, region: &Region) {
        let free = |s: &usize| matches!(self.sources[*s].role, Role::AlternativeObject(_));
        let objects: Vec<usize> = (0..self.sources.len()).filter(free).collect();
        let alike = |a: usize, b: usize| {
            self.sources[a].alternative == self.sources[b].alternative && region[a] == region[b]
        };
        let pairs = objects.windows(2).map(|pair| [pair[0], pair[1]]);
        self.twins = pairs.filter(|&[a, b]| alike(a, b)).collect();
    }

    /// Objects, and the column of the factor by which the target sees each.
    fn seen(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.sources.iter().enumerate().filter_map(|(s, source)| match source.role {
            Role::Object(k) => Some((k, 3 * s + 1)),
            _ => None,
        })
    }

    /// Counts of every band for a spectrum that is `strength` times `radiance` at the nodes; those of the near end of a stretch.
    pub(super) fn counts(&self, strength: &[f64], radiance: &[f64]) -> Vec<f64> {
        self.counts_in(self.scene.bands, strength, radiance)
    }

    /// The same at the far end.
    pub(super) fn counts_of_far(&self, strength: &[f64], radiance: &[f64]) -> Vec<f64> {
        self.counts_in(self.along.map_or(self.scene.bands, |along| along.far), strength, radiance)
    }

    /// The same in bands of other weights.
    pub(super) fn counts_in(&self, bands: &Bands, strength: &[f64], radiance: &[f64]) -> Vec<f64> {
        let product: Vec<f64> = strength.iter().zip(radiance).map(|(a, b)| a * b).collect();
        let mut counts = bands.weigh(&product);
        counts.iter_mut().for_each(|count| *count *= self.scene.counting.counts_per_radiance);
        counts
    }

    pub(super) fn radiance(&self, temperature_k: f64) -> Vec<f64> {
        let nodes = self.scene.bands.nodes_cm1();
        let mut radiance = vec![0.0; nodes.len()];
        planck::photon_radiance_into(nodes, temperature_k, &mut radiance);
        radiance
    }

    /// Takes the ratio s² = (N′+v)/(N+v) of every band from a point: bounds are tightest where it is right.
    pub(super) fn lean(&mut self, counts: [&[f64]; 2]) {
        for (band, v) in self.var.iter().enumerate() {
            let [target, alternative] = counts.map(|counts| counts[band] + v);
            let usable = target > 0.0 && alternative > 0.0;
            let s = if usable { (alternative / target).sqrt().clamp(1e-3, 1e3) } else { 1.0 };
            (self.shares[0][band], self.shares[1][band]) = (0.25 * (1.0 + s), 0.25 * (1.0 + 1.0 / s));
        }
    }

    /// Scene and alternative's state as values of the sources.
    pub(super) fn point(&self, state: &State, nearest: &State) -> Point {
        let mut values = [[0.0; 3]; SOURCES];
        let gain = if self.gain.is_some() { nearest.gain } else { 1.0 };
        for (s, (source, value)) in self.sources.iter().zip(&mut values).enumerate() {
            let lit = |k: usize| gain * nearest.lighting[k];
            *value = match source.role {
                Role::Target if self.gain == Some(3 * s + 2) => [state.temperature_k, 1.0, gain],
                Role::Target => [state.temperature_k, 1.0, 0.0],
                Role::Alternative => [nearest.temperature_k, gain, 0.0],
                Role::Object(k) => {
                    let w = if self.lights[k] == Some(3 * s + 2) { lit(k) } else { 0.0 };
                    [state.environment_k[k], state.lighting[k], w]
                }
                Role::AlternativeObject(k) => [nearest.environment_k[k], lit(k), 0.0],
            };
        }
        Point { values }
    }

    /// The alternative's state at a point, what it does not know better as in the scene there.
    pub(super) fn nearest_at(&self, point: &Point, scene: &State) -> State {
        let mut nearest = scene.clone();
        let value = |column: usize| point.values.as_flattened()[column];
        if let Some(column) = self.gain {
            nearest.gain = value(column);
        }
        for (source, [t, ..]) in self.sources.iter().zip(point.values) {
            match source.role {
                Role::Alternative => nearest.temperature_k = t,
                Role::AlternativeObject(k) => nearest.environment_k[k] = t,
                Role::Target | Role::Object(_) => {}
            }
        }
        for (lighting, column) in nearest.lighting.iter_mut().zip(&self.lights) {
            if let Some(column) = column {
                *lighting = value(*column) / nearest.gain;
            }
        }
        nearest
    }

    /// The scene of a point, as a place in the unit cube of the ranges.
    pub(super) fn place(&self, point: &Point, ranges: &Ranges) -> Vec<f64> {
        let mut values = Vec::new();
        for (source, value) in self.sources.iter().zip(point.values) {
            match source.role {
                Role::Object(_) => values.extend([value[0], value[1]]),
                Role::Target => values.push(value[0]),
                Role::Alternative | Role::AlternativeObject(_) => {}
            }
        }
        let share = |(value, [low, high]): (f64, [f64; 2])| {
            if high > low { ((value - low) / (high - low)).clamp(0.0, 1.0) } else { 0.0 }
        };
        values.into_iter().zip(ranges.all()).map(share).collect()
    }

    /// Whether factors are tied by more than their ranges.
    pub(super) fn is_related(&self) -> bool {
        !(self.relations.is_empty() && self.products.is_empty())
    }

    /// The relations that hold on a box.
    pub(super) fn relations_on(&self, ranges: &[[f64; 2]; COLUMNS]) -> Vec<Relation> {
        let products = self.products.iter().flat_map(|product| product.relations(ranges));
        self.relations.iter().copied().chain(products).collect()
    }

    /// The factors of the product that a relation on a box is from, if it is.
    pub(super) fn product_of(&self, relation: usize) -> Option<[usize; 2]> {
        let own = relation.checked_sub(self.relations.len())?;
        self.products.get(own / 4).map(|product| product.factors)
    }

    /// The relations that hold about a point to first order.
    pub(super) fn relations_at(&self, point: &Point) -> Vec<Relation> {
        let factors = point.factors();
        let products = self.products.iter().map(|product| product.tangent(&factors));
        self.relations.iter().copied().chain(products).collect()
    }

    /// Moves factors to where their relations hold, as far as scaling them does it.
    pub(super) fn project(&self, point: &mut Point) {
        let values = point.values.as_flattened_mut();
        for relation in &self.relations {
            relation.project(values);
        }
        for product in &self.products {
            values[product.value] = product.factors.iter().map(|&i| values[i]).product();
        }
    }

    /// Takes off a box of factors what their relations exclude. `false` where that leaves nothing.
    pub(super) fn tighten(&self, ranges: &mut [[f64; 2]; COLUMNS]) -> bool {
        self.relations.iter().all(|relation| relation.tighten(ranges))
            && self.products.iter().all(|product| product.tighten(ranges))
    }
}

/// Ranges of v and w, each in its column.
pub(super) fn factors(region: &Region) -> [[f64; 2]; COLUMNS] {
    let mut ranges = [[0.0; 2]; COLUMNS];
    for (s, span) in region.iter().enumerate().take(SOURCES) {
        (ranges[3 * s + 1], ranges[3 * s + 2]) = (span.own, span.other);
    }
    ranges
}

/// Vₖ′ at least and at most. Where the total is known the last factor is what the others leave of it.
fn lighting_range(scene: &EnvelopeScene<'_>, k: usize, objects: usize) -> [f64; 2] {
    let [low, high] = scene.range.lighting;
    let sum = scene.unknowns.known_lighting_total().unwrap_or(scene.range.lighting_sum);
    let low = low.min(sum / objects as f64);
    match scene.unknowns.known_lighting_total() {
        Some(total) if k + 1 == objects => [0.0, total],
        Some(total) => [low.min(total), high.min(total)],
        None => [low, high.min(scene.range.lighting_sum).max(low)],
    }
}
