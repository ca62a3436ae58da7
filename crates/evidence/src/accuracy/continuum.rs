//! What bands of finite width cost against the continuous spectrum.
//!
//! The distances are sums over bands of functions of the spectra at the band's centre. As the step Δ goes to 0 they go to
//! integrals over ν, in which every wavenumber is seen apart: the continuum. That limit is computed without any step, by
//! quadrature: each node of an adaptive Gauss–Legendre rule is a band whose width is the node's weight.
//!
//! Two errors of a step are told apart: of the photon radiance ΣS Δ (how well a sum stands for an integral), and of the
//! distances, where bands also join what the continuum keeps apart. The recommended step is the widest from which on all
//! narrower ones err by less than [`GOOD`] in the nearest distance.

use super::Order;
use super::scene::{Pair, RANGE_CM1, bands, unknowns};
use hadar::error::Result;
use hadar::identifiability::local::LocalSolver;
use hadar::identifiability::nearest::{NearestSolver, StateRange};
use hadar::material::{Library, Material};
use hadar::scene::{EnvironmentObject, Surroundings};
use hadar::spectrum::Bands;

/// Relative error of the nearest distance below which a step will do.
pub const GOOD: f64 = 1e-3;
/// Relative tolerance of the quadrature that stands for the continuum.
const TOLERANCE: f64 = 1e-10;
/// Numbers of bands over 536 cm⁻¹: steps of 0.1 to 53.6 cm⁻¹.
const COUNTS: [usize; 11] = [5360, 1072, 536, 268, 134, 67, 54, 40, 27, 18, 10];
/// What everything else of the library is told from.
const OTHER: &str = "skin";
/// The target, and what it is told from: smooth spectra, sharp ones. They are drawn.
const PAIRS: [[&str; 2]; 8] = [
    ["skin", "aluminium"],
    ["skin", "pmma"],
    ["soda-lime-glass", "skin"],
    ["silicon-carbide", "skin"],
    ["sapphire", "skin"],
    ["fused-silica", "skin"],
    ["silicon-carbide", "sapphire"],
    ["fused-silica", "sapphire"],
];

/// Errors of one pair at one step, relative to the continuum.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct MaterialStep {
    /// Name of the target's material in the library.
    pub target: String,
    /// Name of the alternative material in the library.
    pub alternative: String,
    /// Width of the bands, cm⁻¹.
    pub step_cm1: f64,
    /// Of the photon radiance of the target.
    pub error_radiance: f64,
    /// Relative error of the local distance.
    pub error_local: f64,
    /// Relative error of the nearest distance.
    pub error_nearest: f64,
}

/// The widest step with [`GOOD`] nearest distances.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Recommended {
    /// Name of the target's material in the library.
    pub target: String,
    /// Name of the alternative material in the library.
    pub alternative: String,
    /// The step, cm⁻¹; none if not even the narrowest will do.
    pub step_cm1: Option<f64>,
    /// Whether the pair is one of those that are drawn.
    pub drawn: bool,
}

/// What steps cost, pair by pair.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Continuum {
    /// Errors, pair after pair, steps ascending.
    pub steps: Vec<MaterialStep>,
    /// What follows for each pair.
    pub recommended: Vec<Recommended>,
}

/// Errors of steps from 0.1 to 54 cm⁻¹ for smooth and for sharp pairs, and for every other material of the library
/// against skin (skies apart).
///
/// # Errors
/// A material of the built-in library that does not cover the bands; a quadrature that does not converge.
pub fn continuum(order: Order) -> Result<Continuum> {
    let library = Library::embedded()?;
    let (mut steps, mut recommended) = (Vec::new(), Vec::new());
    let others = library.names().filter(|name| !name.starts_with("sky-") && *name != OTHER);
    let others = others.map(|name| [name, OTHER]).filter(|pair| !PAIRS.contains(pair));
    let all: Vec<[&str; 2]> = PAIRS.into_iter().chain(others).collect();
    for (i, [target, alternative]) in all.into_iter().enumerate() {
        let drawn = i < PAIRS.len();
        if order.quick && !drawn {
            break;
        }
        let materials = [library.get(target)?, library.get(alternative)?];
        let limit = Values::of(&Pair::new(spectrum_of_nodes(materials)?, materials)?)?;
        if limit.nearest == 0.0 {
            // The same spectrum by another name.
            continue;
        }
        let mut widest = None;
        let mut good = true;
        for count in order.some(&COUNTS) {
            let found = Values::of(&Pair::new(bands(count)?, materials)?)?;
            let step_cm1 = (RANGE_CM1[1] - RANGE_CM1[0]) / count as f64;
            let step = MaterialStep {
                target: target.into(),
                alternative: alternative.into(),
                step_cm1,
                error_radiance: (found.radiance / limit.radiance - 1.0).abs(),
                error_local: (found.local / limit.local - 1.0).abs(),
                error_nearest: (found.nearest / limit.nearest - 1.0).abs(),
            };
            good &= step.error_nearest < GOOD;
            if good {
                widest = Some(step_cm1);
            }
            steps.push(step);
        }
        let (target, alternative) = (target.into(), alternative.into());
        recommended.push(Recommended { target, alternative, step_cm1: widest, drawn });
    }
    Ok(Continuum { steps, recommended })
}

/// What is compared.
struct Values {
    radiance: f64,
    local: f64,
    nearest: f64,
}

impl Values {
    fn of(pair: &Pair) -> Result<Self> {
        let Pair { bands, surroundings, target, alternative, state } = pair;
        let local = LocalSolver::new(bands, surroundings, unknowns()?).per_photon(
            target,
            alternative,
            state,
            f64::INFINITY,
        )?;
        let nearest = NearestSolver::new(bands, surroundings, unknowns()?, StateRange::default())
            .per_photon(target, alternative, state, f64::INFINITY)?;
        Ok(Self { radiance: local.photon_radiance, local: local.distance, nearest: nearest.distance })
    }
}

/// The nodes of a quadrature over the whole range as bands whose widths are the weights.
fn spectrum_of_nodes(materials: [&Material; 2]) -> Result<Bands> {
    let [low, high] = RANGE_CM1;
    let kinks: Vec<f64> = materials.iter().flat_map(|material| material.breakpoints_cm1(low, high)).collect();
    let whole = Bands::from_rows([(0.5 * (low + high), high - low)])?;
    let fine = whole.integrated(&kinks, TOLERANCE, |nodes| {
        let object = EnvironmentObject { temperature_k: super::scene::AMBIENT_K, emissivity: None };
        let surroundings = Surroundings::new(nodes, vec![object])?;
        let state = surroundings.state(super::scene::TARGET_K, &[super::scene::LIGHTING])?;
        materials
            .iter()
            .map(|material| Ok(surroundings.signal(&material.emissivity(nodes)?, &state)))
            .collect()
    })?;
    Bands::from_rows(fine.nodes_cm1().iter().copied().zip(fine.weights_cm1().iter().copied()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Grey bodies: what is left of a sum with the midpoint rule falls with the square of the step.
    #[test]
    fn smooth_spectra_err_by_the_square_of_the_step() {
        let library = Library::embedded().unwrap();
        let materials = [library.get("skin").unwrap(), library.get("aluminium").unwrap()];
        let limit =
            Values::of(&Pair::new(spectrum_of_nodes(materials).unwrap(), materials).unwrap()).unwrap();
        let error = |count: usize| {
            let found = Values::of(&Pair::new(bands(count).unwrap(), materials).unwrap()).unwrap();
            found.radiance / limit.radiance - 1.0
        };
        let ratio = error(67) / error(134);
        assert!((3.0..5.0).contains(&ratio), "{ratio}");
    }
}
