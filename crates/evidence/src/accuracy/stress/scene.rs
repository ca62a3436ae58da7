//! Scenes that no one would think of: bands, surroundings, materials, states, unknowns and noise at the ends of their
//! ranges and beside each other.

use super::draw::Draw;
use hadar::error::Result;
use hadar::fisher::{Counting, Nuisance, Unknowns};
use hadar::scene::{EnvironmentObject, State, Surroundings};
use hadar::spectrum::Bands;

/// ν/T at which hν = kT, cm⁻¹ K⁻¹.
const THERMAL_CM1_PER_K: f64 = 0.695;
/// What wavenumbers may be, cm⁻¹.
const WAVENUMBERS_CM1: [f64; 2] = [1e-3, 1e5];
/// What temperatures may be, K.
const TEMPERATURES_K: [f64; 2] = [1.0, 1e5];

/// Least emissivity and lighting factor that is not 0: products with the least of radiances must not underflow.
const LEAST: f64 = 1e-100;

/// What a scene is to be hard for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Hardship {
    /// Everything over its range.
    Ranges,
    /// The target at the temperature of its surroundings, or nearly, and lit all around, or nearly.
    Equilibrium,
    /// Nuisances that are nearly, or quite, the same.
    Dependence,
    /// Nothing: a scene that a search can be judged in.
    Mild,
}

/// A scene with two materials.
#[derive(Debug)]
pub(super) struct Scene {
    pub(super) bands: Bands,
    pub(super) surroundings: Surroundings,
    pub(super) state: State,
    pub(super) target: Vec<f64>,
    pub(super) alternative: Vec<f64>,
    pub(super) unknowns: Unknowns,
}

impl Scene {
    /// Draws one with `count` bands.
    pub(super) fn draw(draw: &mut Draw, hardship: Hardship, count: usize) -> Result<Self> {
        let mild = hardship == Hardship::Mild;
        let temperature_k =
            if mild { draw.between(250.0, 400.0) } else { draw.scale(TEMPERATURES_K[0], TEMPERATURES_K[1]) };
        let bands = bands(draw, temperature_k, count, mild)?;
        let nodes = bands.nodes_cm1().len();
        let most = match hardship {
            Hardship::Equilibrium => 2,
            Hardship::Mild => 3,
            Hardship::Ranges | Hardship::Dependence => 9,
        };
        let mut objects: Vec<EnvironmentObject> = Vec::new();
        for _ in 0..(if count > 100 { draw.below(3) } else { draw.below(most) }) {
            let temperature_k = match (hardship, objects.last()) {
                (Hardship::Mild, _) => draw.between(250.0, 350.0),
                (Hardship::Dependence, Some(last)) if draw.chance(0.7) => draw.beside(last.temperature_k),
                (Hardship::Equilibrium, _) => equilibrium_k(draw, temperature_k),
                _ if draw.chance(0.3) => draw.beside(temperature_k),
                _ => temperature_k * draw.scale(0.03, 30.0),
            };
            let black = hardship == Hardship::Equilibrium || draw.chance(0.7);
            let emissivity = (!black).then(|| emissivity(draw, nodes, mild));
            objects.push(EnvironmentObject { temperature_k, emissivity });
        }
        if hardship == Hardship::Dependence && objects.len() > 1 && draw.chance(0.3) {
            // The same object, or one that differs by its emissivity alone.
            let copy = objects[draw.below(objects.len())].clone();
            objects.push(copy);
        }
        let lighting = lighting(draw, objects.len(), hardship);
        let unknowns = unknowns(draw, hardship, &lighting)?;
        let surroundings = Surroundings::new(bands.nodes_cm1(), objects)?;
        let mut state = surroundings.state(temperature_k, &lighting)?;
        if !mild && draw.chance(0.1) {
            state.gain = draw.scale(1e-6, 1e6);
        }
        let target = emissivity(draw, nodes, mild);
        let alternative = alternative(draw, &target, mild);
        Ok(Self { bands, surroundings, state, target, alternative, unknowns })
    }

    /// Noise of a camera: photons from 1 to 10³⁰, electronic noise over photons from 0 to 10³⁰.
    pub(super) fn counting(&self, draw: &mut Draw, signal: &[f64]) -> Counting {
        let total: f64 = signal.iter().sum();
        let photons = draw.scale(1.0, 1e30);
        let counts_per_radiance = (photons / total).clamp(1e-300, 1e300);
        let gamma = if draw.chance(0.3) { 0.0 } else { draw.scale(1e-30, 1e30) };
        let each = gamma * photons / signal.len() as f64;
        let rough = draw.chance(0.3);
        let var_added = match gamma {
            0.0 => Vec::new(),
            _ => signal.iter().map(|_| if rough { each * draw.scale(1e-6, 1.0) } else { each }).collect(),
        };
        Counting { counts_per_radiance, var_added }
    }
}

/// How many bands: mostly few.
pub(super) fn band_count(draw: &mut Draw) -> usize {
    draw.scale(1.0, 25.0) as usize
}

fn bands(draw: &mut Draw, temperature_k: f64, count: usize, mild: bool) -> Result<Bands> {
    let [lowest, highest] = WAVENUMBERS_CM1;
    let thermal = THERMAL_CM1_PER_K * temperature_k;
    let (low, high) = if mild {
        (700.0, 1300.0)
    } else if draw.chance(0.8) {
        let low = (thermal * draw.scale(1e-3, 10.0)).clamp(lowest, 0.9 * highest);
        (low, (low * draw.scale(1.05, 30.0)).min(highest))
    } else {
        let low = draw.scale(lowest, 0.5 * highest);
        (low, (low * draw.scale(1.01, 1e6)).min(highest))
    };
    if count < 20 && high - low < 30.0 * count as f64 && high - low > 0.1 && draw.chance(0.4) {
        // Several nodes a band.
        let width = (high - low) / count as f64;
        let ranges: Vec<(f64, f64)> = (0..count)
            .map(|i| (low + width * i as f64, low + width * (i as f64 + draw.between(0.2, 1.0))))
            .collect();
        return Bands::from_ranges(&ranges);
    }
    let step = (high - low) / count as f64;
    let unit = draw.chance(0.4);
    let uniform = count > 100 || draw.chance(0.5);
    let rows = (0..count).map(|i| {
        let shift = if uniform { 0.0 } else { draw.between(0.0, 0.9) };
        (low + step * (i as f64 + shift), if unit { 1.0 } else { step })
    });
    Bands::from_rows(rows.collect::<Vec<_>>())
}

/// A temperature from a thousand kelvin to a last bit away, or none.
fn equilibrium_k(draw: &mut Draw, temperature_k: f64) -> f64 {
    match draw.below(10) {
        0 => temperature_k,
        1 => draw.some_bits_from(temperature_k),
        _ => {
            let apart = draw.scale(1e-15 * temperature_k, 1e3);
            let beside = if draw.chance(0.5) { temperature_k + apart } else { temperature_k - apart };
            if beside > 0.05 * temperature_k { beside } else { temperature_k + apart }
        }
    }
}

/// Lighting factors whose sum is 0, 1, nearly one of them, or between.
fn lighting(draw: &mut Draw, count: usize, hardship: Hardship) -> Vec<f64> {
    let mut factors: Vec<f64> = (0..count).map(|_| draw.scale(1e-3, 1.0)).collect();
    let sum: f64 = factors.iter().sum();
    let total = match (hardship, draw.below(8)) {
        (Hardship::Mild, _) => draw.between(0.2, 1.0),
        (_, 0) => 0.0,
        (_, 1) => draw.scale(LEAST, 1e-3),
        (Hardship::Equilibrium, 2..=5) | (_, 2) => 1.0,
        (_, 3) => 1.0 - draw.scale(1e-16, 1e-3),
        _ => draw.unit(),
    };
    for factor in &mut factors {
        *factor *= total / sum;
        if hardship != Hardship::Mild && draw.chance(0.05) {
            *factor = 0.0;
        }
    }
    // Rounding must not make it more than all, but for what the states allow.
    let sum: f64 = factors.iter().sum();
    if sum > 1.0 {
        factors.iter_mut().for_each(|factor| *factor *= 1.0 - 1e-15);
    }
    factors
}

/// An emissivity: rough, smooth, grey, or beside the ends of its range.
fn emissivity(draw: &mut Draw, nodes: usize, mild: bool) -> Vec<f64> {
    let (middle, slope, bend) = (draw.between(0.1, 0.9), draw.between(-0.1, 0.1), draw.between(0.0, 20.0));
    let smooth = |i: usize| {
        let place = i as f64 / nodes.max(2) as f64;
        (middle + slope * (2.0 * place - 1.0) + 0.05 * (bend * place).sin()).clamp(0.0, 1.0)
    };
    match if mild { 4 } else { draw.below(10) } {
        0 => vec![if draw.chance(0.5) { 0.0 } else { 1.0 }; nodes],
        1 => (0..nodes).map(|_| draw.scale(LEAST, 1e-3)).collect(),
        2 => (0..nodes).map(|_| 1.0 - draw.scale(1e-17, 1e-3)).collect(),
        3 => vec![draw.unit(); nodes],
        4 | 5 => (0..nodes).map(smooth).collect(),
        6 => (0..nodes).map(|_| if draw.chance(0.3) { draw.below(2) as f64 } else { draw.unit() }).collect(),
        _ => (0..nodes).map(|_| draw.unit()).collect(),
    }
}

/// Another material: of its own, or equal but for a little, the last bits, one band, or nothing.
fn alternative(draw: &mut Draw, target: &[f64], mild: bool) -> Vec<f64> {
    let own = emissivity(draw, target.len(), mild);
    if mild {
        return own;
    }
    let (kind, share, only) = (draw.below(12), draw.scale(1e-16, 0.1), draw.below(target.len()));
    let bit = |e: f64, up: bool| match e.to_bits() {
        0 => LEAST,
        bits => f64::from_bits(if up && e < 1.0 { bits + 1 } else { bits - 1 }),
    };
    let mut other: Vec<f64> = Vec::with_capacity(target.len());
    for (i, (&e, &own)) in target.iter().zip(&own).enumerate() {
        other.push(match kind {
            0 => e,
            1 => bit(e, draw.chance(0.5)),
            2 if i == only => bit(e, draw.chance(0.5)),
            3 if i == only => own,
            2 | 3 => e,
            4 | 5 => (e + share * (own - e)).clamp(0.0, 1.0),
            _ => own,
        });
    }
    other
}

fn unknowns(draw: &mut Draw, hardship: Hardship, lighting: &[f64]) -> Result<Unknowns> {
    let likely = match hardship {
        Hardship::Dependence => [0.8, 0.8, 0.6, 0.3],
        Hardship::Mild => [0.8, 0.6, 0.15, 0.0],
        Hardship::Ranges | Hardship::Equilibrium => [0.6, 0.5, 0.3, 0.15],
    };
    let set: Vec<Nuisance> = Nuisance::ALL
        .into_iter()
        .zip(likely)
        .filter(|(_, likely)| draw.chance(*likely))
        .map(|n| n.0)
        .collect();
    let mut unknowns = Unknowns::new(set.iter().copied())?;
    if !lighting.is_empty() && draw.chance(0.15) {
        unknowns = unknowns.lighting_total(Some(lighting.iter().sum::<f64>().clamp(0.0, 1.0)))?;
    }
    for nuisance in set {
        if draw.chance(if hardship == Hardship::Mild { 0.1 } else { 0.25 }) {
            let sigma =
                if hardship == Hardship::Mild { draw.scale(1e-3, 1e3) } else { draw.scale(1e-30, 1e30) };
            unknowns = unknowns.prior(nuisance, sigma)?;
        }
    }
    Ok(unknowns)
}
