//! The alternative as a sum of sources, each of one temperature, and their spectra in counts.
//!
//! N′ = Σ_s c_s A_s(T_s): source 0 is the surface, A₀ = κ∫e′B, source k + 1 the light of object k, κ∫(1 − e′)εₖB. As
//! κ, e′, εₖ and the weights of the bands are not negative, A_s is in every band an increasing convex function of T (B is:
//! T²B″/B = x(1 + n)[x(1 + 2n) − 2] and x(1 + 2n) = x coth(x/2) ≥ 2). So on an interval [a, b] it lies below its chord, and
//! above its tangents at both ends: by no more than
//!
//! ρ = (b − a)(s − A′(a))(A′(b) − s)/(A′(b) − A′(a)),  s the slope of the chord,
//!
//! where the two tangents meet.
//!
//! Where the amplitude is free as well only the *shape* of a source matters, U = A/β with β = B(ν₀, T) at the lowest wavenumber,
//! which changes far less with T. Along s = 1/T each band is a sum of f = (e^{as} − 1)/(e^{bs} − 1) with b ≥ a > 0, which falls with
//! s and is all but convex: with ψ(y) = y/(1 − e⁻ʸ), p = ψ(as) and q = ψ(bs), s²f″/f = q(2q − 2p − bs) + p·as, which is
//! never below −(as)²e^{−as}/24 (as → 0, b = 1.5a). So with that much more, over a box, the same holds of U along −1/T.

use super::groups::{by_place, neighbours_summed, products_by_place_into, products_summed, whole};
use super::vectors::{multiply, product_into, rest_into, scale};
use crate::aligned::Aligned;
use crate::fisher::Nuisance;
use crate::identifiability::nearest::blackbodies::{Blackbodies, Blackbody};
use crate::identifiability::nearest::residual::{Comparison, Target};
use crate::identifiability::space::LARGEST_LN_GAIN;
use crate::planck;
use crate::scene::Parameter;
use crate::simd::dispatched;
use crate::spectrum::Bands;
use crate::units::SECOND_RADIATION_CM_K;
use std::cell::OnceCell;
use std::sync::Arc;

/// One source: what B(T) is multiplied by at the nodes (with the weight of the band where that is its only node), and where its
/// temperature may be.
#[derive(Debug)]
pub(super) struct Source {
    strength: Aligned,
    pub(super) temperature_k: [f64; 2],
}

impl Source {
    /// Whether its temperature is unknown.
    pub(super) fn free(&self) -> bool {
        self.temperature_k[1] > self.temperature_k[0]
    }
}

/// A source at one temperature, in counts of the bands per unit of its amplitude, in whole chunks.
#[derive(Debug, Clone)]
pub(super) struct Spectrum {
    pub(super) temperature_k: f64,
    /// What it is taken to be a function of: T, or −1/T for a shape.
    pub(super) along: f64,
    pub(super) counts: Aligned,
    /// ∂/∂along.
    pub(super) slope: Aligned,
    lengths: OnceCell<[f64; 2]>,
}

impl Spectrum {
    fn of(temperature_k: f64, along: f64, [counts, slope]: [Aligned; 2]) -> Self {
        Self { temperature_k, along, counts, slope, lengths: OnceCell::new() }
    }

    /// Sum of the counts, and of their slopes.
    pub(super) fn lengths(&self) -> [f64; 2] {
        *self.lengths.get_or_init(|| [&self.counts, &self.slope].map(|x| crate::sum::sum(x)))
    }
}

/// All sources of an alternative.
#[derive(Debug, Clone)]
pub(super) struct Sources<'a> {
    pub(super) bands: &'a Bands,
    pub(super) list: Arc<[Source]>,
    blackbodies: Arc<Blackbodies>,
    /// Every so many neighbouring bands are counted as one.
    merged: usize,
    /// Strengths of the sources of unknown temperature by place in groups of so many, where bands are counted together and each has one node.
    by_place: Arc<[Option<Aligned>]>,
    /// Rounding of the target's own counts, as a share of them.
    own_rounding: f64,
    /// The lowest wavenumber, ν₀, and the highest.
    pub(super) range_cm1: (f64, f64),
}

/// hcν₀/kT beyond which radiances underflow.
const DARK: f64 = 690.0;
/// Share of the target's counts that is next to nothing: its root is far below rounding.
const NOTHING: f64 = 1e-32;
/// By how much of itself the rounding of what is colder may be larger before it is asked how much of the light that is.
const SAME_ROUNDING: f64 = 0.5;

impl<'a> Sources<'a> {
    pub(super) fn new(
        comparison: &Comparison<'a>,
        target: &Target<'_>,
        within_reach: impl Fn(Parameter, [f64; 2]) -> [f64; 2],
    ) -> Self {
        let space = &comparison.space;
        let surroundings = comparison.target.surroundings();
        let unknown = |nuisance| space.unknowns.contains(nuisance);
        let gain = if unknown(Nuisance::Gain) { 1.0 } else { target.state.gain };
        let per_share = target.counts * gain;
        let bands = comparison.target.bands();
        let weights = bands.one_node_per_band().then(|| bands.weights_cm1());
        let strength = |share: Aligned| -> Aligned {
            let mut strength = share;
            if let Some(weights) = weights {
                multiply(&mut strength, weights);
            }
            scale(&mut strength, per_share);
            strength
        };
        let span = |nuisance, parameter, range: [f64; 2], known: f64| {
            if unknown(nuisance) { within_reach(parameter, range) } else { [known, known] }
        };
        let other = target.alternative;
        let surface = Source {
            strength: strength(Aligned::from(other)),
            temperature_k: span(
                Nuisance::Temperature,
                Parameter::Temperature,
                space.range.temperature_k,
                target.state.temperature_k,
            ),
        };
        let objects = surroundings.objects().iter().zip(&target.state.environment_k).enumerate();
        let lights = objects.map(|(k, (object, &known))| {
            let mut lit = Aligned::unset(other.len());
            rest_into(other, &mut lit);
            if let Some(own) = &object.emissivity {
                multiply(&mut lit, own);
            }
            let parameter = Parameter::EnvironmentTemperature(k);
            let range = space.bounds(parameter);
            Source {
                strength: strength(lit),
                temperature_k: span(Nuisance::EnvironmentTemperature, parameter, range, known),
            }
        });
        let list = std::iter::once(surface).chain(lights).collect();
        let blackbodies = Arc::clone(&comparison.blackbodies);
        let mut sources = Self {
            bands,
            list,
            blackbodies,
            merged: 1,
            by_place: Arc::default(),
            own_rounding: 0.0,
            range_cm1: comparison.range_cm1,
        };
        sources.own_rounding = sources.rounding_of(comparison, target);
        sources
    }

    /// Rounding of the target's counts: that of its own emission, and of what it scatters of surroundings so much colder that these
    /// are less exact, in the band where they have the largest share.
    fn rounding_of(&self, comparison: &Comparison<'_>, target: &Target<'_>) -> f64 {
        crate::stop::check();
        let state = target.state;
        let own = self.rounding(state.temperature_k);
        let (surroundings, signal) = (comparison.target.surroundings(), comparison.target.signal());
        let colder = state.environment_k.iter().zip(&state.lighting).enumerate().map(|(k, (&t, lit))| {
            let less = self.rounding(t) - own;
            if less <= own * SAME_ROUNDING || *lit == 0.0 {
                return less.max(0.0);
            }
            let mut light = surroundings.object_signal(k, state);
            light
                .iter_mut()
                .zip(target.emissivity)
                .for_each(|(light, e)| *light *= (1.0 - e) * lit * state.gain);
            let shares = self.bands.weigh(&light).into_iter().zip(signal);
            less * shares
                .map(|(light, all)| if light > 0.0 { (light / all).min(1.0) } else { 0.0 })
                .fold(0.0, f64::max)
        });
        own + colder.sum::<f64>()
    }

    /// Rounding of the target's counts, as a share of them.
    pub(super) fn rounding_of_target(&self) -> f64 {
        self.own_rounding + self.rounding_of_merging()
    }

    /// The same with neighbouring bands counted as one.
    pub(super) fn merged(&self, merged: usize) -> Self {
        let is_placed = merged > 1 && self.bands.one_node_per_band();
        // Of a temperature that is known there is one spectrum alone.
        let placed =
            |source: &Source| (is_placed && source.free()).then(|| by_place(&source.strength, merged));
        let placed = self.list.iter().map(placed);
        Self { merged, by_place: placed.collect(), ..self.clone() }
    }

    /// Source `s` at a temperature that other pairs look at, too.
    pub(super) fn spectrum(&self, s: usize, temperature_k: f64) -> Spectrum {
        let blackbody = self.blackbodies.at(self.bands.nodes_cm1(), temperature_k);
        let strength = self.by_place.get(s).and_then(Option::as_ref);
        match strength.and_then(|strength| Some((strength, blackbody.by_place(self.merged)?))) {
            None => self.of(s, temperature_k, blackbody.radiance.each_ref().map(|radiance| &radiance[..])),
            Some((strength, radiance)) => {
                crate::stop::check();
                let counted = radiance.each_ref().map(|radiance| {
                    let mut sums = Aligned::unset(strength.len() / self.merged);
                    products_by_place_into(radiance, strength, &mut sums);
                    sums
                });
                Spectrum::of(temperature_k, temperature_k, counted)
            }
        }
    }

    /// The same at one that is the pair's own.
    pub(super) fn own_spectrum(&self, s: usize, temperature_k: f64) -> Spectrum {
        let blackbody = Blackbody::of(self.bands.nodes_cm1(), temperature_k);
        self.of(s, temperature_k, blackbody.radiance.each_ref().map(|radiance| &radiance[..]))
    }

    /// The same of B and ∂B/∂T at the nodes.
    pub(super) fn of(&self, s: usize, temperature_k: f64, blackbody: [&[f64]; 2]) -> Spectrum {
        crate::stop::check();
        Spectrum::of(temperature_k, temperature_k, blackbody.map(|radiance| self.counted(s, radiance)))
    }

    /// A spectrum with so many neighbouring bands counted as one.
    pub(super) fn summed(&self, spectrum: &Spectrum, count: usize) -> Spectrum {
        let summed = |counts: &[f64]| neighbours_summed(&counts[..self.bands.len()], count);
        let [counts, slope] = [&spectrum.counts, &spectrum.slope].map(|counts| summed(counts));
        Spectrum::of(spectrum.temperature_k, spectrum.along, [counts, slope])
    }

    /// The shape of a spectrum, and β; `None` where there is next to nothing.
    pub(super) fn shape(&self, spectrum: &Spectrum) -> Option<(Spectrum, f64)> {
        let t = spectrum.temperature_k;
        let scale = self.scale(t);
        if scale.is_nan() || scale < f64::MIN_POSITIVE {
            return None;
        }
        let bend = planck::log_derivative(self.range_cm1.0, t);
        let len = spectrum.counts.len();
        let counts = Aligned::filled(len, spectrum.counts.iter().map(|counts| counts / scale));
        let slopes = spectrum.slope.iter().zip(&spectrum.counts);
        let slopes = slopes.map(|(slope, counts)| t * t * ((slope - counts * bend) / scale));
        let slope = Aligned::filled(len, slopes);
        Some((Spectrum::of(t, -1.0 / t, [counts, slope]), scale))
    }

    /// β at a temperature.
    pub(super) fn scale(&self, temperature_k: f64) -> f64 {
        planck::photon_radiance(self.range_cm1.0, temperature_k)
    }

    /// The temperature below which a source sends next to nothing of so many counts, whatever the gain and with the `brightest`
    /// factor that it can have: e^x − 1 ≥ e^{x}/2 from x = ln 2 on. `None` if its radiance underflows before that.
    pub(super) fn dark_k(&self, s: usize, counts: f64, brightest: f64) -> Option<f64> {
        let nodes = self.bands.nodes_cm1().iter().zip(&self.list[s].strength);
        let weights = self.bands.weights_cm1();
        let weight = |j: usize| if self.bands.one_node_per_band() { 1.0 } else { weights[j] };
        let most: f64 =
            nodes.enumerate().map(|(j, (nu, e))| 2.0 * weight(j) * e * planck::mode_density(*nu)).sum();
        let x = (most / counts).ln() - NOTHING.ln() + LARGEST_LN_GAIN + brightest.max(1.0).ln();
        (x.is_finite() && x < DARK).then(|| SECOND_RADIATION_CM_K * self.range_cm1.0 / x.max(1.0))
    }

    /// hcν/kT at the lowest wavenumber.
    pub(super) fn lowest_x(&self, temperature_k: f64) -> f64 {
        SECOND_RADIATION_CM_K * self.range_cm1.0 / temperature_k
    }

    /// The same in the middle of the bands.
    pub(super) fn middle_x(&self, temperature_k: f64) -> f64 {
        let (first, last) = self.range_cm1;
        SECOND_RADIATION_CM_K * 0.5 * (first + last) / temperature_k
    }

    /// How many times as bright one temperature is as another one in the middle of the bands; 1 where that is no number.
    pub(super) fn brightness(&self, temperature_k: f64, other_k: f64) -> f64 {
        let (first, last) = self.range_cm1;
        let [own, other] = [temperature_k, other_k].map(|t| planck::photon_radiance(0.5 * (first + last), t));
        let ratio = own / other;
        if ratio > 0.0 && ratio.is_finite() { ratio } else { 1.0 }
    }

    /// Rounding of spectra from this temperature on, as a share of them ([`crate::planck`]).
    pub(super) fn rounding(&self, temperature_k: f64) -> f64 {
        let (_, last) = self.range_cm1;
        self.rounding_of_merging()
            + 4e-16 * (10.0 + (SECOND_RADIATION_CM_K * last / temperature_k).min(2.0 * DARK))
    }

    fn rounding_of_merging(&self) -> f64 {
        if self.merged > 1 { f64::EPSILON * self.merged as f64 } else { 0.0 }
    }

    fn counted(&self, s: usize, radiance: &[f64]) -> Aligned {
        let (bands, strength) = (self.bands.len(), &self.list[s].strength);
        if self.merged > 1 && self.bands.one_node_per_band() {
            return products_summed([radiance, strength], self.merged);
        }
        let mut counts = Aligned::unset(whole(bands));
        counts[bands..].fill(0.0);
        if self.bands.one_node_per_band() {
            product_into(radiance, strength, &mut counts);
        } else {
            let mut radiance = Aligned::from(radiance);
            multiply(&mut radiance, strength);
            self.bands.weigh_into(&radiance, &mut counts[..bands]);
        }
        if self.merged > 1 { neighbours_summed(&counts[..bands], self.merged) } else { counts }
    }

    /// A″ at a temperature, and a bound of |A‴| between two others around it.
    ///
    /// With n = 1/(eˣ − 1), m = x n(1 + n) and w = x(1 + 2n): T²n″ = m(w − 2), T³n‴ = m(w² − 6w + 6 + 2xm), of which
    /// |w² − 6w + 6| ≤ w² as w ≥ 2; m grows with T, x and w fall.
    pub(super) fn bend(&self, s: usize, temperature_k: f64, [low, high]: [f64; 2]) -> [Aligned; 2] {
        crate::stop::check();
        let nodes = self.bands.nodes_cm1();
        let [mut bend, mut third] = [(); 2].map(|()| Aligned::unset(nodes.len()));
        planck::photon_radiance_into(nodes, temperature_k, &mut bend);
        let ends = [low, high].map(|end| self.blackbodies.at(nodes, end));
        let [cold, hot] = ends.each_ref().map(|end| &end.radiance[0][..]);
        bends(Bends { nodes, temperature_k, low_k: low, bend: &mut bend, third: &mut third, cold, hot });
        [bend, third].map(|spectrum| self.counted(s, &spectrum))
    }
}

/// What [`bends`] reads and writes: B at the temperature itself becomes B″; the bound of |B‴| comes of B at both ends.
struct Bends<'a> {
    nodes: &'a [f64],
    temperature_k: f64,
    low_k: f64,
    bend: &'a mut [f64],
    third: &'a mut [f64],
    cold: &'a [f64],
    hot: &'a [f64],
}

dispatched! {
    fn bends<'a>(bends: Bends<'a>) -> () {
        let Bends { nodes, temperature_k, low_k, bend, third, cold, hot } = bends;
        let ends = nodes.iter().zip(cold.iter().zip(hot));
        for ((nu, (cold, hot)), (bend, third)) in ends.zip(bend.iter_mut().zip(third)) {
            (*bend, *third) = bent(*nu, [*bend, *cold, *hot], temperature_k, low_k);
        }
    }
}

/// B″ and the bound of |B‴| at a node, from B at the temperature itself, at the cold end and at the hot one.
#[inline(always)]
fn bent(nu: f64, [own, cold, hot]: [f64; 3], temperature_k: f64, low_k: f64) -> (f64, f64) {
    let density = planck::mode_density(1.0) * nu * nu;
    let (x, n) = (SECOND_RADIATION_CM_K * nu / temperature_k, own / density);
    // w − 2 = x²/6 − x⁴/360 + … cancels where x is small.
    let small = x * x / 6.0 * (1.0 - x * x / 60.0);
    let large = x * (1.0 + 2.0 * n) - 2.0;
    let beyond = if x < 0.1 { small } else { large };
    let second = own * x * (1.0 + n) * beyond / (temperature_k * temperature_k);
    let (x, n, hot) = (SECOND_RADIATION_CM_K * nu / low_k, cold / density, hot / density);
    let w = x * (1.0 + 2.0 * n);
    // At the hot end x is no more than at the cold one.
    let m = x * hot * (1.0 + hot);
    (second, density * m * (w * w + 2.0 * x * m) / (low_k * low_k * low_k))
}

/// What [`chord`] reads and writes.
pub(in crate::limits::identifiability) struct Chord<'a> {
    /// Between the ends, in what the slopes are along.
    pub(in crate::limits::identifiability) width: f64,
    /// Rounding of the counts and what they may bend the other way, as a share of the hot end.
    pub(in crate::limits::identifiability) more: f64,
    /// Counts and slopes at the cold and the hot end.
    pub(in crate::limits::identifiability) cold: [&'a [f64]; 2],
    pub(in crate::limits::identifiability) hot: [&'a [f64]; 2],
    pub(in crate::limits::identifiability) low: &'a mut [f64],
    pub(in crate::limits::identifiability) rise: &'a mut [f64],
    pub(in crate::limits::identifiability) half: &'a mut [f64],
}

dispatched! {
    /// The cold end of the chord lowered by ρ/2, what it rises by, and ρ/2 with `more`: the curve is within that of them.
    pub(in crate::limits::identifiability) fn chord<'a>(chord: Chord<'a>) -> () {
        let Chord { width, more, cold, hot, low, rise, half } = chord;
        let per_unit = 1.0 / width;
        let ends = cold[0].iter().zip(cold[1]).zip(hot[0].iter().zip(hot[1]));
        let out = low.iter_mut().zip(rise).zip(half);
        for (((a, slope_a), (b, slope_b)), ((low, rise), half)) in ends.zip(out) {
            let missed = half_sag([width, per_unit], [*a, *slope_a], [*b, *slope_b]);
            *half = missed + more * b;
            *low = a - missed;
            *rise = b - a;
        }
    }
}

/// ρ/2 of one band: between ends so far apart (and one over that), from counts and slopes at both.
#[inline(always)]
pub(super) fn half_sag([width, per_unit]: [f64; 2], [a, slope_a]: [f64; 2], [b, slope_b]: [f64; 2]) -> f64 {
    let chord = (b - a) * per_unit;
    let (above, rest, turn) = ((chord - slope_a).max(0.0), (slope_b - chord).max(0.0), slope_b - slope_a);
    let sag = if turn > 0.0 { width * above * rest / turn } else { 0.0 };
    0.5 * sag.min(b - a).max(0.0)
}
