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

use crate::fisher::Nuisance;
use crate::identifiability::nearest::residual::{Comparison, Target};
use crate::planck;
use crate::simd::dispatched;
use crate::spectrum::Bands;
use crate::units::SECOND_RADIATION_CM_K;
use std::ops::Deref;
use std::sync::Arc;

/// Every so many bands of a problem, and where their nodes stand among those of the whole.
#[derive(Debug)]
pub(crate) struct Few {
    pub(super) bands: Bands,
    nodes: Vec<usize>,
    pub(super) stride: usize,
}

impl Few {
    /// About `enough` bands, if there are more than twice as many.
    pub(crate) fn of(bands: &Bands, enough: usize) -> Option<Arc<Self>> {
        let stride = bands.len() / enough;
        (stride > 1).then(|| {
            let (bands, nodes) = bands.every(stride);
            Arc::new(Self { bands, nodes, stride })
        })
    }
}

/// Bands that several share.
#[derive(Debug)]
pub(super) enum Shared<'a> {
    All(&'a Bands),
    Few(Arc<Few>),
}

impl Deref for Shared<'_> {
    type Target = Bands;

    fn deref(&self) -> &Bands {
        match self {
            Self::All(bands) => bands,
            Self::Few(few) => &few.bands,
        }
    }
}

/// One source: what B(T) is multiplied by at the nodes, and where its temperature may be.
#[derive(Debug)]
pub(super) struct Source {
    strength: Vec<f64>,
    pub(super) temperature_k: [f64; 2],
}

impl Source {
    /// Whether its temperature is unknown.
    pub(super) fn free(&self) -> bool {
        self.temperature_k[1] > self.temperature_k[0]
    }
}

/// A source at one temperature, in counts of the bands per unit of its amplitude.
#[derive(Debug, Clone)]
pub(super) struct Spectrum {
    pub(super) temperature_k: f64,
    pub(super) counts: Vec<f64>,
    /// ∂/∂T.
    pub(super) slope: Vec<f64>,
    /// Sum of the counts.
    pub(super) length: f64,
}

/// All sources of an alternative.
#[derive(Debug)]
pub(super) struct Sources<'a> {
    pub(super) bands: Shared<'a>,
    pub(super) list: Vec<Source>,
}

impl<'a> Sources<'a> {
    pub(super) fn new(comparison: &Comparison<'a>, target: &Target<'_>) -> Self {
        let space = &comparison.space;
        let surroundings = comparison.target.surroundings();
        let unknown = |nuisance| space.unknowns.contains(nuisance);
        let gain = if unknown(Nuisance::Gain) { 1.0 } else { target.state.gain };
        let scale = target.counts * gain;
        let span = |unknown: bool, range: [f64; 2], known: f64| if unknown { range } else { [known, known] };
        let other = target.alternative;
        let surface = Source {
            strength: other.iter().map(|e| scale * e).collect(),
            temperature_k: span(
                unknown(Nuisance::Temperature),
                space.range.temperature_k,
                target.state.temperature_k,
            ),
        };
        let objects = surroundings.objects().iter().zip(&target.state.environment_k).enumerate();
        let lights = objects.map(|(k, (object, &known))| {
            let own = |j: usize| object.emissivity.as_ref().map_or(1.0, |own| own[j]);
            let range = space.bounds(crate::scene::Parameter::EnvironmentTemperature(k));
            Source {
                strength: other.iter().enumerate().map(|(j, e)| scale * (1.0 - e) * own(j)).collect(),
                temperature_k: span(unknown(Nuisance::EnvironmentTemperature), range, known),
            }
        });
        Self {
            bands: Shared::All(comparison.target.bands()),
            list: std::iter::once(surface).chain(lights).collect(),
        }
    }

    /// The same in few bands.
    pub(super) fn every(&self, few: &Arc<Few>) -> Sources<'static> {
        let list = self.list.iter().map(|source| Source {
            strength: few.nodes.iter().map(|&j| source.strength[j]).collect(),
            temperature_k: source.temperature_k,
        });
        Sources { bands: Shared::Few(Arc::clone(few)), list: list.collect() }
    }

    /// Source `s` at a temperature.
    pub(super) fn spectrum(&self, s: usize, temperature_k: f64) -> Spectrum {
        let nodes = self.bands.nodes_cm1();
        let (mut value, mut slope) = (vec![0.0; nodes.len()], vec![0.0; nodes.len()]);
        planck::photon_radiance_and_slope_into(nodes, temperature_k, &mut value, &mut slope);
        let counts = self.counted(s, &mut value);
        let slope = self.counted(s, &mut slope);
        let length = crate::sum::sum(&counts);
        Spectrum { temperature_k, counts, slope, length }
    }

    fn counted(&self, s: usize, radiance: &mut [f64]) -> Vec<f64> {
        radiance.iter_mut().zip(&self.list[s].strength).for_each(|(value, strength)| *value *= strength);
        self.bands.weigh(radiance)
    }

    /// A″ at a temperature, and a bound of |A‴| between two others around it.
    ///
    /// With n = 1/(eˣ − 1), m = x n(1 + n) and w = x(1 + 2n): T²n″ = m(w − 2), T³n‴ = m(w² − 6w + 6 + 2xm), of which
    /// |w² − 6w + 6| ≤ w² as w ≥ 2; m grows with T, x and w fall.
    pub(super) fn bend(&self, s: usize, temperature_k: f64, [low, high]: [f64; 2]) -> [Vec<f64>; 2] {
        let nodes = self.bands.nodes_cm1();
        let [mut bend, mut third, mut hot] = [(); 3].map(|()| vec![0.0; nodes.len()]);
        planck::photon_radiance_into(nodes, temperature_k, &mut bend);
        planck::photon_radiance_into(nodes, low, &mut third);
        planck::photon_radiance_into(nodes, high, &mut hot);
        bends(Bends { nodes, temperature_k, low_k: low, bend: &mut bend, third: &mut third, hot: &hot });
        [bend, third].map(|mut spectrum| self.counted(s, &mut spectrum))
    }
}

/// What [`bends`] reads and writes: B at the temperature itself becomes B″, at the cold end the bound of |B‴|.
struct Bends<'a> {
    nodes: &'a [f64],
    temperature_k: f64,
    low_k: f64,
    bend: &'a mut [f64],
    third: &'a mut [f64],
    hot: &'a [f64],
}

dispatched! {
    fn bends<'a>(bends: Bends<'a>) -> () {
        let Bends { nodes, temperature_k, low_k, bend, third, hot } = bends;
        let one = planck::mode_density(1.0);
        for (((bend, third), hot), nu) in bend.iter_mut().zip(third).zip(hot).zip(nodes) {
            let density = one * nu * nu;
            let (x, n) = (SECOND_RADIATION_CM_K * nu / temperature_k, *bend / density);
            // w − 2 = x²/6 − x⁴/360 + … cancels where x is small.
            let small = x * x / 6.0 * (1.0 - x * x / 60.0);
            let beyond = if x < 0.1 { small } else { x * (1.0 + 2.0 * n) - 2.0 };
            *bend = density * x * n * (1.0 + n) * beyond / (temperature_k * temperature_k);
            let (x, n, hot) = (SECOND_RADIATION_CM_K * nu / low_k, *third / density, hot / density);
            let w = x * (1.0 + 2.0 * n);
            // At the hot end x is no more than at the cold one.
            let m = x * hot * (1.0 + hot);
            *third = density * m * (w * w + 2.0 * x * m) / (low_k * low_k * low_k);
        }
    }
}

/// What [`chord`] reads and writes.
pub(super) struct Chord<'a> {
    pub(super) width_k: f64,
    /// Counts and slopes at the cold and the hot end.
    pub(super) cold: [&'a [f64]; 2],
    pub(super) hot: [&'a [f64]; 2],
    pub(super) low: &'a mut [f64],
    pub(super) high: &'a mut [f64],
    pub(super) half: &'a mut [f64],
}

dispatched! {
    /// Both ends of the chord lowered by ρ/2, and ρ/2: the curve is within that of them.
    pub(super) fn chord<'a>(chord: Chord<'a>) -> () {
        let Chord { width_k, cold, hot, low, high, half } = chord;
        let per_kelvin = 1.0 / width_k;
        let ends = cold[0].iter().zip(cold[1]).zip(hot[0].iter().zip(hot[1]));
        let out = low.iter_mut().zip(high).zip(half);
        for (((a, slope_a), (b, slope_b)), ((low, high), half)) in ends.zip(out) {
            let chord = (b - a) * per_kelvin;
            let (rise, rest, turn) = ((chord - slope_a).max(0.0), (slope_b - chord).max(0.0), slope_b - slope_a);
            let sag = if turn > 0.0 { width_k * rise * rest / turn } else { 0.0 };
            // With some roundings of the counts.
            *half = 0.5 * sag.min(b - a).max(0.0) + 2e-15 * b;
            *low = a - *half;
            *high = b - *half;
        }
    }
}
