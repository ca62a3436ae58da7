//! Counts of target and alternative as sums over sources, each of one temperature.
//!
//! N − N′ = κΣ_s [v_s f_s(T_s) + w_s g_s(T_s)]: f and g are band integrals of a fixed spectrum times B(T_s), v what the
//! source gives the target (and the alternative, where it does not know better), w what it gives the alternative alone.
//!
//! | source | v | f | w | g |
//! |---|---|---|---|---|
//! | the target's surface | 1 | e | | |
//! | the alternative's, temperature unknown | 1 | −e′ | | |
//! | both, temperature known | 1 | e − e′ | | |
//! | object k, lighting unknown | Vₖ | (1 − e)εₖ | Vₖ′ | −(1 − e′)εₖ |
//! | object k, lighting known | Vₖ | (e′ − e)εₖ | | |

use super::ranges::Ranges;
use super::scene::EnvelopeScene;
use crate::fisher::{Nuisance, Unknowns};
use crate::planck;
use crate::scene::State;

/// Sources that a proof can deal with: two surfaces and two objects.
pub(super) const SOURCES: usize = 4;

/// A body of one temperature, with the spectra at the nodes that it is seen by.
#[derive(Debug, Clone)]
pub(super) struct Source {
    /// f and g without B.
    pub(super) own: Vec<f64>,
    pub(super) other: Vec<f64>,
    /// What the target and the alternative see of v, and the alternative of w.
    pub(super) target: Vec<f64>,
    pub(super) alternative: Vec<f64>,
    pub(super) alone: Vec<f64>,
    /// Whether v and w are lighting factors.
    pub(super) object: bool,
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

/// Everything about a pair that does not depend on the ranges.
#[derive(Debug)]
pub(super) struct Model<'a> {
    pub(super) scene: EnvelopeScene<'a>,
    pub(super) sources: Vec<Source>,
    pub(super) var: Vec<f64>,
    lighting_unknown: bool,
    /// Shares of N and N′ in the bound of a variance, band by band: ¼(1 + s) and ¼(1 + 1/s).
    pub(super) shares: [Vec<f64>; 2],
    /// Largest sum of V and of V′.
    pub(super) sums: [f64; 2],
    /// Whether the ranges of the factors reach beyond these.
    pub(super) limited: bool,
}

/// Whether a lower bound can be proved, and whether it is one on the very distance and not without its priors.
pub(super) fn provable(unknowns: &Unknowns, objects: usize) -> bool {
    !unknowns.contains(Nuisance::Gain)
        && !unknowns.contains(Nuisance::EnvironmentTemperature)
        && unknowns.known_lighting_total().is_none()
        && objects + 2 <= SOURCES
}

impl<'a> Model<'a> {
    /// The sources of a pair, and the ranges of the whole envelope.
    pub(super) fn new(scene: &EnvelopeScene<'a>, ranges: &Ranges) -> (Self, Region) {
        let [own_t, own_v] = [Nuisance::Temperature, Nuisance::Lighting].map(|n| scene.unknowns.contains(n));
        let (e, other) = (scene.emissivity, scene.alternative);
        let zeros = || vec![0.0; e.len()];
        let negative = |x: &[f64]| x.iter().map(|x| -x).collect::<Vec<f64>>();
        let one = [1.0, 1.0];
        let span = |t, own, other| Span { t, own, other };
        let (mut sources, mut region) = (Vec::new(), Vec::new());
        let seen = |own: Vec<f64>, target: Vec<f64>, alternative: Vec<f64>| Source {
            own,
            other: zeros(),
            target,
            alternative,
            alone: zeros(),
            object: false,
        };
        region.push(span(ranges.temperature_k(), one, [0.0; 2]));
        if own_t {
            sources.push(seen(e.to_vec(), e.to_vec(), zeros()));
            sources.push(seen(negative(other), zeros(), other.to_vec()));
            region.push(span(scene.range.temperature_k, one, [0.0; 2]));
        } else {
            let apart = e.iter().zip(other).map(|(e, other)| e - other).collect();
            sources.push(seen(apart, e.to_vec(), other.to_vec()));
        }
        let most = scene.range.lighting[1].min(scene.range.lighting_sum).max(scene.range.lighting[0]);
        for (k, object) in scene.surroundings.objects().iter().enumerate() {
            let own = |j: usize| object.emissivity.as_ref().map_or(1.0, |own| own[j]);
            let spectrum =
                |f: &dyn Fn(usize) -> f64| (0..e.len()).map(|j| f(j) * own(j)).collect::<Vec<f64>>();
            let target = spectrum(&|j| 1.0 - e[j]);
            let alternative = spectrum(&|j| 1.0 - other[j]);
            let (t, v) = (ranges.environment_k()[k], ranges.lighting()[k]);
            if own_v {
                let (own, other) = (target.clone(), negative(&alternative));
                sources.push(Source {
                    own,
                    other,
                    target,
                    alternative: zeros(),
                    alone: alternative,
                    object: true,
                });
                region.push(span(t, v, [scene.range.lighting[0], most]));
            } else {
                let apart = spectrum(&|j| other[j] - e[j]);
                let (other, alone) = (zeros(), zeros());
                sources.push(Source { own: apart, other, target, alternative, alone, object: true });
                region.push(span(t, v, [0.0; 2]));
            }
        }
        let var: Vec<f64> = (0..scene.bands.len()).map(|band| scene.counting.var_added(band)).collect();
        let shares = [vec![0.5; var.len()], vec![0.5; var.len()]];
        let sums = [1.0, scene.range.lighting_sum];
        let most = |range: fn(&Span) -> f64| -> f64 {
            let lit = region.iter().zip(&sources).filter(|(_, source)| source.object);
            lit.map(|(span, _)| range(span)).sum()
        };
        let limited = most(|span| span.own[1]) > sums[0] || most(|span| span.other[1]) > sums[1];
        (Self { scene: *scene, sources, var, lighting_unknown: own_v, shares, sums, limited }, region)
    }

    /// Counts of every band for a spectrum that is `strength` times `radiance` at the nodes.
    pub(super) fn counts(&self, strength: &[f64], radiance: &[f64]) -> Vec<f64> {
        let product: Vec<f64> = strength.iter().zip(radiance).map(|(a, b)| a * b).collect();
        let mut counts = self.scene.bands.weigh(&product);
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
        let mut object = 0;
        for (s, (source, value)) in self.sources.iter().zip(&mut values).enumerate() {
            *value = if source.object {
                let (t, v, w) =
                    (state.environment_k[object], state.lighting[object], nearest.lighting[object]);
                object += 1;
                [t, v, if self.lighting_unknown { w } else { 0.0 }]
            } else {
                [if s == 0 { state.temperature_k } else { nearest.temperature_k }, 1.0, 0.0]
            };
        }
        Point { values }
    }

    /// The scene of a point, as a place in the unit cube of the ranges.
    pub(super) fn place(&self, point: &Point, ranges: &Ranges) -> Vec<f64> {
        let mut values = Vec::new();
        for (s, (source, value)) in self.sources.iter().zip(point.values).enumerate() {
            if source.object {
                values.extend([value[0], value[1]]);
            } else if s == 0 {
                values.push(value[0]);
            }
        }
        let share = |(value, [low, high]): (f64, [f64; 2])| {
            if high > low { ((value - low) / (high - low)).clamp(0.0, 1.0) } else { 0.0 }
        };
        values.into_iter().zip(ranges.all()).map(share).collect()
    }

    fn sums_of(&self, point: &Point) -> [f64; 2] {
        [1, 2].map(|which: usize| {
            let values = self.sources.iter().zip(point.values).filter(|(source, _)| source.object);
            values.map(|(_, value)| value[which]).sum()
        })
    }

    /// Which sums of lighting factors, V and V′, are larger than they may be.
    pub(super) fn excesses(&self, point: &Point) -> [bool; 2] {
        let sums = self.sums_of(point);
        [0, 1].map(|which: usize| sums[which] > self.sums[which] + 1e-12)
    }

    /// Scales lighting factors down to the sums they may have.
    pub(super) fn scale(&self, point: &mut Point) {
        let (sums, excesses) = (self.sums_of(point), self.excesses(point));
        for (source, value) in self.sources.iter().zip(&mut point.values) {
            for which in (0..2).filter(|&which| source.object && excesses[which]) {
                value[which + 1] *= self.sums[which] / sums[which];
            }
        }
    }

    /// Keeps lighting factors within what their sum may be. `false` where that leaves nothing.
    pub(super) fn tighten(&self, own: &mut [[f64; 2]], other: &mut [[f64; 2]]) -> bool {
        [own, other].into_iter().zip(self.sums).all(|(factors, sum)| {
            let lit = || self.sources.iter().enumerate().filter(|(_, source)| source.object).map(|(s, _)| s);
            let least: f64 = lit().map(|s| factors[s][0]).sum();
            let rest = sum - least + 1e-12;
            lit().for_each(|s| factors[s][1] = factors[s][1].min(factors[s][0] + rest.max(0.0)));
            rest >= 0.0
        })
    }
}
