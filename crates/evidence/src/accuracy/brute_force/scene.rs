//! Scenes that a search of the nearest state finds hard: few bands, equilibrium, materials nearly equal, ends of ranges.

use crate::accuracy::stress::draw::Draw;
use hadar::error::Result;
use hadar::fisher::{Counting, Nuisance, Unknowns};
use hadar::identifiability::nearest::StateRange;
use hadar::scene::{EnvironmentObject, State, Surroundings};
use hadar::spectrum::Bands;

/// ν/T at which hν = kT, cm⁻¹ K⁻¹.
const THERMAL_CM1_PER_K: f64 = 0.695;
/// Largest hν/kT of the target: its signal stays far from underflow.
const FAINTEST: f64 = 300.0;

/// What is unknown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::accuracy) struct Set {
    pub(in crate::accuracy) temperature: bool,
    pub(in crate::accuracy) lighting: bool,
    pub(in crate::accuracy) total_known: bool,
    pub(in crate::accuracy) gain: bool,
    pub(in crate::accuracy) environment: bool,
}

impl Set {
    /// Every set out of the four with anything in it, those with lighting once more with its total known.
    pub(in crate::accuracy) fn all() -> Vec<Self> {
        let mut sets = Vec::new();
        for bits in 1..16 {
            let [temperature, lighting, gain, environment] = [0, 1, 2, 3].map(|i| bits >> i & 1 == 1);
            let open = Self { temperature, lighting, total_known: false, gain, environment };
            sets.push(open);
            if lighting {
                sets.push(Self { total_known: true, ..open });
            }
        }
        sets
    }

    pub(in crate::accuracy) fn name(self) -> String {
        let lighting = if self.total_known { "lighting (total known)" } else { "lighting" };
        let parts = [
            (self.temperature, "temperature"),
            (self.lighting, lighting),
            (self.gain, "gain"),
            (self.environment, "surroundings' temperatures"),
        ];
        parts.into_iter().filter(|part| part.0).map(|part| part.1).collect::<Vec<_>>().join(", ")
    }

    fn nuisances(self) -> impl Iterator<Item = Nuisance> {
        [
            (self.temperature, Nuisance::Temperature),
            (self.lighting, Nuisance::Lighting),
            (self.gain, Nuisance::Gain),
            (self.environment, Nuisance::EnvironmentTemperature),
        ]
        .into_iter()
        .filter_map(|(unknown, nuisance)| unknown.then_some(nuisance))
    }
}

/// A pair to find the nearest state of.
#[derive(Debug)]
pub(in crate::accuracy) struct Scene {
    pub(in crate::accuracy) bands: Bands,
    pub(in crate::accuracy) surroundings: Surroundings,
    pub(in crate::accuracy) state: State,
    pub(in crate::accuracy) target: Vec<f64>,
    pub(in crate::accuracy) alternative: Vec<f64>,
    pub(in crate::accuracy) unknowns: Unknowns,
    pub(in crate::accuracy) range: StateRange,
    /// The camera's noise; per √photon without.
    pub(in crate::accuracy) counting: Option<Counting>,
}

impl Scene {
    pub(in crate::accuracy) fn draw(draw: &mut Draw, set: Set) -> Result<Self> {
        let temperature_k = temperature_k(draw);
        let bands = bands(draw, temperature_k)?;
        let nodes = bands.nodes_cm1().len();
        let least = usize::from(set.environment || set.lighting) + usize::from(set.total_known);
        let most = if set.environment { 2 } else { 3 };
        let mut count = least + draw.below(most - least + 1);
        if set.environment && draw.chance(0.2) {
            // Two dimensions more take the brute force long.
            count = least;
        }
        let objects = objects(draw, count, temperature_k, nodes);
        let lighting = lighting(draw, objects.len());
        let mut unknowns = Unknowns::new(set.nuisances())?;
        if set.total_known {
            unknowns = unknowns.lighting_total(Some(lighting.iter().sum::<f64>().clamp(0.0, 1.0)))?;
        }
        let range = range(draw, temperature_k, &lighting, set);
        let surroundings = Surroundings::new(bands.nodes_cm1(), objects)?;
        let mut state = surroundings.state(temperature_k, &lighting)?;
        if draw.chance(0.1) {
            state.gain = draw.scale(0.01, 100.0);
        }
        let target = emissivity(draw, nodes);
        let alternative = alternative(draw, &target);
        let counting = draw.chance(0.5).then(|| {
            let signal = bands.weigh(&surroundings.signal(&target, &state));
            counting(draw, &signal)
        });
        Ok(Self { bands, surroundings, state, target, alternative, unknowns, range, counting })
    }
}

fn temperature_k(draw: &mut Draw) -> f64 {
    match draw.below(20) {
        0 | 1 => draw.scale(2.0, 30.0),
        2..=4 => draw.scale(30.0, 200.0),
        5..=15 => draw.between(200.0, 400.0),
        _ => draw.scale(400.0, 3000.0),
    }
}

/// Share of what is drawn seldom.
const ODD: f64 = 0.05;
/// Share of the scenes with so many bands that a proof counts neighbours as one.
const MANY: f64 = 0.04;

/// 3 to 60 bands, mostly few, or 128 to 227, in a narrow or a wide range about the target's peak or far from it.
fn bands(draw: &mut Draw, temperature_k: f64) -> Result<Bands> {
    let drawn = draw.scale(3.0, 61.0);
    let count = if drawn.fract() < MANY { 128.0 + 100.0 * drawn.fract() / MANY } else { drawn } as usize;
    let x = match draw.below(20) {
        0..=12 => draw.between(1.5, 10.0),
        13..=15 => draw.scale(0.01, 1.5),
        _ => draw.scale(10.0, 100.0),
    };
    let width = if draw.chance(0.4) { draw.scale(1.004, 1.1) } else { draw.scale(1.1, 5.0) };
    let low = THERMAL_CM1_PER_K * temperature_k * x;
    let high = (low * width).min(FAINTEST * THERMAL_CM1_PER_K * temperature_k);
    let step = (high - low) / count as f64;
    if step > 0.5 && step < 10.0 && draw.chance(0.3) {
        // Several nodes a band.
        let ranges: Vec<(f64, f64)> = (0..count)
            .map(|i| (low + step * i as f64, low + step * (i as f64 + draw.between(0.3, 1.0))))
            .collect();
        return Bands::from_ranges(&ranges);
    }
    let uniform = draw.chance(0.5);
    let rows = (0..count).map(|i| {
        let shift = if uniform { 0.0 } else { draw.between(0.0, 0.9) };
        (low + step * (i as f64 + shift), step)
    });
    Bands::from_rows(rows.collect::<Vec<_>>())
}

fn objects(draw: &mut Draw, count: usize, temperature_k: f64, nodes: usize) -> Vec<EnvironmentObject> {
    let equilibrium = draw.chance(0.3);
    (0..count)
        .map(|_| {
            let beside_k = if equilibrium {
                let apart = draw.scale(1e-15, 0.03);
                temperature_k * if draw.chance(0.5) { 1.0 + apart } else { 1.0 - apart }
            } else if draw.chance(0.8) {
                temperature_k * draw.scale(0.4, 2.0)
            } else {
                temperature_k * draw.scale(0.05, 10.0)
            };
            let emissivity = match draw.below(5) {
                0 | 1 => None,
                2 => Some(vec![draw.unit(); nodes]),
                _ => Some(emissivity(draw, nodes)),
            };
            EnvironmentObject { temperature_k: beside_k.clamp(1.0, 1e5), emissivity }
        })
        .collect()
}

/// Lighting factors, some of them 0, their sum 0, 1, nearly 1 or between.
fn lighting(draw: &mut Draw, count: usize) -> Vec<f64> {
    let mut factors: Vec<f64> = (0..count).map(|_| draw.scale(1e-2, 1.0)).collect();
    let total = match draw.below(20) {
        0 => 0.0,
        1..=4 => 1.0,
        5 | 6 => 1.0 - draw.scale(1e-16, 1e-3),
        _ => draw.unit(),
    };
    let sum: f64 = factors.iter().sum();
    for factor in &mut factors {
        *factor = if draw.chance(0.07) { 0.0 } else { *factor * total / sum };
    }
    // Rounding must not make it more than all.
    while factors.iter().sum::<f64>() > 1.0 {
        factors.iter_mut().for_each(|factor| *factor *= 1.0 - f64::EPSILON);
    }
    factors
}

/// All that physics allows, or less: around the target's state, or beside it.
fn range(draw: &mut Draw, temperature_k: f64, lighting: &[f64], set: Set) -> StateRange {
    let mut range = StateRange::default();
    if draw.chance(0.7) {
        return range;
    }
    if draw.chance(0.7) {
        let [below, above] = [0, 1].map(|_| draw.scale(1e-4, 0.5));
        let middle = if draw.chance(0.2) { temperature_k * draw.scale(0.7, 1.4) } else { temperature_k };
        range.temperature_k = [middle * (1.0 - below), middle * (1.0 + above)];
    }
    if !set.total_known && !lighting.is_empty() && draw.chance(0.7) {
        let each = lighting.len() as f64;
        let share = draw.unit();
        // Seldom above what the target's own state has.
        let most =
            if is_odd(share) { 0.9 / each } else { lighting.iter().copied().fold(0.9 / each, f64::min) };
        let low = share * most;
        range.lighting = [low, draw.between(low, 1.0)];
        if draw.chance(0.3) {
            range.lighting_sum = draw.between(low * each, 1.0);
        }
    }
    range
}

/// An emissivity: smooth, rough, grey, near black or near none.
fn emissivity(draw: &mut Draw, nodes: usize) -> Vec<f64> {
    let (middle, slope, bend) = (draw.between(0.1, 0.9), draw.between(-0.1, 0.1), draw.between(0.0, 20.0));
    let smooth = |i: usize| {
        let place = i as f64 / nodes.max(2) as f64;
        (middle + slope * (2.0 * place - 1.0) + 0.05 * (bend * place).sin()).clamp(0.0, 1.0)
    };
    match draw.below(12) {
        0 => vec![draw.unit(); nodes],
        1..=4 => (0..nodes).map(smooth).collect(),
        5 | 6 => (0..nodes).map(|i| (smooth(i) + draw.between(-1e-2, 1e-2)).clamp(0.0, 1.0)).collect(),
        7 => (0..nodes).map(|_| draw.between(0.95, 1.0)).collect(),
        8 => (0..nodes).map(|_| draw.scale(1e-3, 0.1)).collect(),
        9 => (0..nodes).map(|_| if draw.chance(0.2) { draw.below(2) as f64 } else { draw.unit() }).collect(),
        _ => (0..nodes).map(|_| draw.unit()).collect(),
    }
}

/// Another material: of its own, nearly equal, or the same but for a factor.
fn alternative(draw: &mut Draw, target: &[f64]) -> Vec<f64> {
    let own = emissivity(draw, target.len());
    match draw.below(20) {
        0..=3 => {
            let share = draw.scale(1e-13, 0.1);
            target.iter().zip(&own).map(|(e, own)| (e + share * (own - e)).clamp(0.0, 1.0)).collect()
        }
        4 => {
            let factor = draw.unit();
            target.iter().zip(&own).map(|(e, own)| factor * e + 1e-3 * (1.0 - factor) * own).collect()
        }
        _ => own,
    }
}

/// Whether a number drawn is one of a few, by its last digits: without another draw, by which all later ones would change.
fn is_odd(drawn: f64) -> bool {
    (1e9 * drawn).fract() < ODD
}

/// 1 to 10³⁰ photons, electronic noise from none to a thousand times theirs, seldom to 10¹⁵ times, even or rough.
fn counting(draw: &mut Draw, signal: &[f64]) -> Counting {
    let total: f64 = signal.iter().sum();
    let photons = draw.scale(1.0, 1e30);
    let level = if draw.chance(0.3) { 0.0 } else { draw.scale(1e-6, 1e3) };
    let level = if is_odd(level) { 1e12 * level } else { level };
    let each = level * photons / signal.len() as f64;
    let rough = draw.chance(0.3);
    let var_added = if each > 0.0 {
        signal.iter().map(|_| if rough { each * draw.scale(1e-6, 1.0) } else { each }).collect()
    } else {
        Vec::new()
    };
    Counting { counts_per_radiance: photons / total, var_added }
}
