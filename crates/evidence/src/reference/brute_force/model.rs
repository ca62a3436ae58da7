//! What a candidate state of the alternative costs, in numbers of any kind, and its first and second derivatives.
//!
//! N′ = Σₛ Cₛ Sₛ(tₛ) in every band: S₀ = Σ w e′B(T′) and Sₖ = Σ w (1 − e′) εₖ B(Tₖ′) over the band's nodes, t the logarithm of
//! a temperature; C₀ = G′, Cₖ = G′Vₖ′. f = Σ (√(N′+v) − √(N+v))², N and v as shares of the target's photons. Unknowns are,
//! in this order, free temperatures (their logarithms), G′, and all Cₖ: for fixed temperatures f is jointly convex in the
//! last two, and what limits V′ is linear in them (low·G′ ≤ Cₖ ≤ high·G′, ΣCₖ ≤ limit·G′).
//!
//! With x = hcν/kT and y = 1/(eˣ − 1): B = 2cν² y, ∂B/∂t = B q, ∂²B/∂t² = B q (x(1 + 2y) − 1), q = x(1 + y).

use super::descent::{Constraint, Each, Local, MOST};
use crate::reference::double_double::Real;
use crate::reference::local::{Noise, Pair};
use hadar::fisher::{Nuisance, Unknowns};
use hadar::identifiability::nearest::StateRange;
use hadar::scene::{State, Surroundings};
use hadar::spectrum::Bands;

/// Largest |ln G′|.
pub(super) const LOG_GAIN: f64 = 14.0;
/// Temperatures of an object, K.
pub(super) const OBJECT_K: [f64; 2] = [0.1, 1e6];
/// Least N′ + v that is divided by.
const LEAST: f64 = 1e-200;

/// hc/k, cm K.
pub(super) fn second_radiation_cm_k<R: Real>() -> R {
    let [h, c, k, power] = [662_607_015.0, 299_792_458.0, 1_380_649.0, 1e11].map(R::from);
    h * c / (k * power)
}

/// What is unknown and how far, as columns of numbers.
#[derive(Debug, Clone)]
pub(super) struct Layout {
    pub(super) objects: usize,
    /// Spectra whose temperature is unknown: 0 the alternative's own, k its k-th object from 1.
    pub(super) temperatures: Vec<usize>,
    pub(super) gain: bool,
    pub(super) lighting: bool,
    pub(super) total: Option<f64>,
    pub(super) range: StateRange,
}

impl Layout {
    pub(super) fn new(unknowns: &Unknowns, range: StateRange, objects: usize) -> Self {
        let own = unknowns.contains(Nuisance::Temperature).then_some(0);
        let others = if unknowns.contains(Nuisance::EnvironmentTemperature) { objects } else { 0 };
        Self {
            objects,
            temperatures: own.into_iter().chain(1..=others).collect(),
            gain: unknowns.contains(Nuisance::Gain),
            lighting: unknowns.contains(Nuisance::Lighting) && objects > 0,
            total: unknowns.known_lighting_total(),
            range,
        }
    }

    /// Lowest and highest temperature of a spectrum, K.
    pub(super) fn limits_k(&self, spectrum: usize) -> [f64; 2] {
        if spectrum == 0 { self.range.temperature_k } else { OBJECT_K }
    }

    /// Unknowns with so many free temperatures.
    pub(super) fn unknowns(&self, free: usize) -> usize {
        free + usize::from(self.gain) + if self.lighting { self.objects } else { 0 }
    }
}

/// One spectrum of the alternative in the bands, with its derivatives along the logarithm of its temperature.
#[derive(Debug, Clone)]
pub(super) struct Spectrum<R> {
    pub(super) value: Vec<R>,
    pub(super) slope: Vec<R>,
    pub(super) bend: Vec<R>,
}

/// A pair in numbers of one kind.
#[derive(Debug)]
pub(super) struct Model<'a, R> {
    pub(super) layout: &'a Layout,
    pub(super) own: &'a State,
    nodes_cm1: &'a [f64],
    nodes_per_band: Vec<usize>,
    /// Weight × 2cν² × e′ of every node, and (1 − e′)εₖ in its place.
    factors: Vec<Vec<R>>,
    /// N, and the root of N + v.
    counts: Vec<R>,
    root: Vec<R>,
    noise: Vec<R>,
    /// d² over f.
    pub(super) scale: R,
}

impl<'a, R: Real> Model<'a, R> {
    pub(super) fn new(
        bands: &'a Bands,
        surroundings: &'a Surroundings,
        layout: &'a Layout,
        pair: Pair<'a>,
        noise: Noise<'_>,
    ) -> Self {
        let (zero, one) = (R::from(0.0), R::from(1.0));
        let nodes_cm1 = bands.nodes_cm1();
        let ones = vec![1.0; nodes_cm1.len()];
        let nodes_per_band = bands.sum_nodes(&ones).iter().map(|&count| count as usize).collect();
        let modes: Vec<R> = nodes_cm1
            .iter()
            .zip(bands.weights_cm1())
            .map(|(&nu, &weight)| {
                R::from(599_584_916_000_000.0) * R::from(nu) * R::from(nu) * R::from(weight)
            })
            .collect();
        let factors = |emissivity: &[f64], spectrum: usize| -> Vec<R> {
            let at = |(node, mode): (usize, &R)| {
                let e = R::from(emissivity[node]);
                let Some(object) = spectrum.checked_sub(1) else { return *mode * e };
                let lit = surroundings.objects()[object].emissivity.as_ref();
                *mode * (one - e) * lit.map_or(one, |lit| R::from(lit[node]))
            };
            modes.iter().enumerate().map(at).collect()
        };
        let all = |emissivity: &[f64]| -> Vec<Vec<R>> {
            (0..=layout.objects).map(|spectrum| factors(emissivity, spectrum)).collect()
        };
        let mut model = Self {
            layout,
            own: pair.state,
            nodes_cm1,
            nodes_per_band,
            factors: all(pair.emissivity),
            counts: Vec::new(),
            root: Vec::new(),
            noise: Vec::new(),
            scale: one,
        };
        let state = pair.state;
        let mut signal = vec![zero; bands.len()];
        for spectrum in 0..=layout.objects {
            let (factor, temperature) = match spectrum.checked_sub(1) {
                None => (one, state.temperature_k),
                Some(k) => (R::from(state.lighting[k]), state.environment_k[k]),
            };
            let found = model.spectrum(spectrum, R::from(temperature).logarithm(), false);
            for (signal, value) in signal.iter_mut().zip(found.value) {
                *signal = *signal + R::from(state.gain) * factor * value;
            }
        }
        let total = signal.iter().fold(zero, |sum, signal| sum + *signal);
        let share = R::from(1.0 / total.to_f64());
        model.factors = all(pair.alternative);
        for factor in model.factors.iter_mut().flatten() {
            *factor = *factor * share;
        }
        let (scale, per_count) = match noise {
            Noise::PerPhoton { .. } => (one / (total * share), zero),
            Noise::Counting(counting) => {
                let counts = R::from(counting.counts_per_radiance);
                (counts / share, share / counts)
            }
        };
        model.scale = scale;
        model.noise = (0..bands.len())
            .map(|band| match noise {
                Noise::PerPhoton { .. } => zero,
                Noise::Counting(counting) => R::from(counting.var_added(band)) * per_count,
            })
            .collect();
        model.counts = signal.iter().map(|signal| *signal * share).collect();
        let levels = model.counts.iter().zip(&model.noise);
        model.root = levels.map(|(counts, noise)| (*counts + *noise).root()).collect();
        model
    }

    /// A spectrum at the logarithm of its temperature, with derivatives or without.
    pub(super) fn spectrum(&self, spectrum: usize, log_temperature: R, derivatives: bool) -> Spectrum<R> {
        let (zero, one) = (R::from(0.0), R::from(1.0));
        let scale = second_radiation_cm_k::<R>() * (-log_temperature).exponential();
        let bands = self.nodes_per_band.len();
        let blank = || vec![zero; if derivatives { bands } else { 0 }];
        let mut found = Spectrum { value: vec![zero; bands], slope: blank(), bend: blank() };
        let mut nodes = self.nodes_cm1.iter().zip(&self.factors[spectrum]);
        for (band, &count) in self.nodes_per_band.iter().enumerate() {
            for (&nu, &factor) in nodes.by_ref().take(count) {
                let x = scale * R::from(nu);
                let power = (-x).exponential();
                let rest = -(-x).exponential_less_one();
                let value = factor * power / rest;
                found.value[band] = found.value[band] + value;
                if derivatives {
                    let y = power / rest;
                    let slope = value * x * (one + y);
                    found.slope[band] = found.slope[band] + slope;
                    found.bend[band] = found.bend[band] + slope * (x * (one + y + y) - one);
                }
            }
        }
        found
    }

    /// G′ and the Cₖ of the unknowns `z`, after `free` temperatures.
    pub(super) fn factors(&self, z: &Each<R>, free: usize) -> Each<R> {
        let layout = self.layout;
        let mut factors = [R::from(0.0); MOST];
        factors[0] = if layout.gain { z[free] } else { R::from(self.own.gain) };
        for k in 1..=layout.objects {
            factors[k] = if layout.lighting {
                z[free + usize::from(layout.gain) + k - 1]
            } else {
                factors[0] * R::from(self.own.lighting[k - 1])
            };
        }
        factors
    }

    /// The cost where `spectra` are those of the state, the ones named in `free` with derivatives.
    pub(super) fn evaluate(&self, z: &Each<R>, free: &[usize], spectra: &[&Spectrum<R>]) -> Local<R> {
        let (zero, half) = (R::from(0.0), R::from(0.5));
        let layout = self.layout;
        let factors = self.factors(z, free.len());
        let n = layout.unknowns(free.len());
        let mut at =
            Local { cost: zero, gradient: [zero; MOST], hessian: [[zero; MOST]; MOST], scale: [zero; MOST] };
        let (first, gain) = (free.len(), usize::from(layout.gain));
        for band in 0..self.root.len() {
            let mut other = zero;
            for (factor, spectrum) in factors.iter().zip(spectra) {
                other = other + *factor * spectrum.value[band];
            }
            let mut columns = [zero; MOST];
            let mut bends = [zero; MOST];
            for (i, &s) in free.iter().enumerate() {
                columns[i] = factors[s] * spectra[s].slope[band];
                bends[i] = factors[s] * spectra[s].bend[band];
            }
            if layout.gain {
                columns[first] = spectra[0].value[band];
                if !layout.lighting {
                    for (&lit, spectrum) in self.own.lighting.iter().zip(&spectra[1..]) {
                        columns[first] = columns[first] + R::from(lit) * spectrum.value[band];
                    }
                }
            }
            if layout.lighting {
                for (column, spectrum) in columns[first + gain..].iter_mut().zip(&spectra[1..]) {
                    *column = spectrum.value[band];
                }
            }
            let own = self.root[band];
            let (root, apart) = self.apart(band, other);
            at.cost = at.cost + apart * apart;
            let safe = root.larger(R::from(LEAST.sqrt()));
            let (down, curve) = (apart / safe, half * own / (safe * safe * safe));
            let gauss = half / (safe * safe);
            for i in 0..n {
                at.gradient[i] = at.gradient[i] + down * columns[i];
                at.scale[i] = at.scale[i] + gauss * columns[i] * columns[i];
                let weighted = curve * columns[i];
                for (hessian, other) in at.hessian[i].iter_mut().zip(&columns[..=i]) {
                    *hessian = *hessian + weighted * *other;
                }
            }
            for (i, &s) in free.iter().enumerate() {
                at.hessian[i][i] = at.hessian[i][i] + down * bends[i];
                // ∂²N′/∂t∂C.
                let slope = down * spectra[s].slope[band];
                if layout.gain && s == 0 {
                    at.hessian[first][i] = at.hessian[first][i] + slope;
                } else if s > 0 && layout.lighting {
                    let column = first + gain + s - 1;
                    at.hessian[column][i] = at.hessian[column][i] + slope;
                } else if s > 0 && layout.gain {
                    let lit = R::from(self.own.lighting[s - 1]);
                    at.hessian[first][i] = at.hessian[first][i] + lit * slope;
                }
            }
        }
        for i in 0..n {
            at.scale[i] = at.scale[i].larger(at.hessian[i][i].magnitude());
            for j in 0..i {
                at.hessian[j][i] = at.hessian[i][j];
            }
        }
        at
    }

    /// The cost of these G′ and Cₖ alone.
    pub(super) fn cost(&self, factors: &Each<R>, spectra: &[&Spectrum<R>]) -> R {
        let mut cost = R::from(0.0);
        for band in 0..self.noise.len() {
            let terms = factors.iter().zip(spectra);
            let other =
                terms.fold(R::from(0.0), |sum, (factor, spectrum)| sum + *factor * spectrum.value[band]);
            let (_, apart) = self.apart(band, other);
            cost = cost + apart * apart;
        }
        cost
    }

    /// √(N′ + v) and √(N′ + v) − √(N + v) in a band: of much noise in both nothing is left in N′ − N.
    fn apart(&self, band: usize, other: R) -> (R, R) {
        let other = other.larger(R::from(0.0));
        let root = (other + self.noise[band]).root();
        let sum = root + self.root[band];
        (root, if sum > R::from(0.0) { (other - self.counts[band]) / sum } else { sum })
    }

    /// What limits the unknowns with these free temperatures.
    pub(super) fn constraints(&self, free: &[usize]) -> Vec<Constraint<R>> {
        let layout = self.layout;
        let blank = [0.0; MOST];
        let mut constraints = Vec::new();
        let mut limit = |row, bound, equal| constraints.push(Constraint { row, bound, equal });
        let single = |i: usize, sign: f64| {
            let mut row = blank;
            row[i] = sign;
            row
        };
        for (i, &spectrum) in free.iter().enumerate() {
            let [low, high] = layout.limits_k(spectrum).map(|limit| R::from(limit).logarithm());
            limit(single(i, 1.0), high, false);
            limit(single(i, -1.0), -low, false);
        }
        let first = free.len();
        if layout.gain {
            limit(single(first, 1.0), R::from(LOG_GAIN).exponential(), false);
            limit(single(first, -1.0), -R::from(-LOG_GAIN).exponential(), false);
        }
        if layout.lighting {
            let [low, high] = layout.range.lighting;
            let (sum, equal) = layout.total.map_or((layout.range.lighting_sum, false), |total| (total, true));
            // a·C ≤ bound·G: with the gain known the right side is a number.
            let factors = first + usize::from(layout.gain);
            let mut against_gain = |mut row: Each<f64>, bound: f64, equal| {
                if layout.gain {
                    row[first] = -bound;
                    limit(row, R::from(0.0), equal);
                } else {
                    limit(row, R::from(bound) * R::from(self.own.gain), equal);
                }
            };
            let mut all = blank;
            for k in 0..layout.objects {
                against_gain(single(factors + k, -1.0), -low, false);
                if high < sum {
                    against_gain(single(factors + k, 1.0), high, false);
                }
                all[factors + k] = 1.0;
            }
            against_gain(all, sum, equal);
        }
        constraints
    }
}
