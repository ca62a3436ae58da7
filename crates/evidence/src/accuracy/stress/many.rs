//! Local distances in very many bands, and of many materials at once.

use super::draw::Draw;
use super::findings::Findings;
use super::local::{TINY, faint, in_the_dark, judge_scene};
use super::scene::{Hardship, Scene, band_count};
use crate::reference::Extended;
use crate::reference::local::{LocalReference, Noise, Pair};
use hadar::error::Result;
use hadar::fisher::Counting;
use hadar::identifiability::Status;
use hadar::identifiability::multi::LocalMatrix;

/// Fewest bands here, and how many times as many there are at most.
const FEWEST: f64 = 100.0;
const MOST: f64 = 1000.0;

/// One scene in 10² to 10⁵ bands, mostly few hundred.
pub(super) fn bands(draw: &mut Draw, found: &mut Findings) -> Result<()> {
    let count = (FEWEST * MOST.powf(draw.unit().powi(10))) as usize;
    let hardship = if draw.chance(0.5) { Hardship::Ranges } else { Hardship::Equilibrium };
    let scene = Scene::draw(draw, hardship, count)?;
    let noise = draw.chance(0.5);
    judge_scene(draw, found, &scene, noise).map(drop)
}

/// Three materials against each other in one scene: each distance within the error that comes with the matrix.
pub(super) fn materials(draw: &mut Draw, found: &mut Findings) -> Result<()> {
    let count = 2 + band_count(draw);
    let scene = Scene::draw(draw, Hardship::Ranges, count)?;
    let third: Vec<f64> = scene.target.iter().map(|_| draw.unit()).collect();
    let all = [scene.target.as_slice(), scene.alternative.as_slice(), third.as_slice()];
    let Scene { bands, surroundings, state, unknowns, .. } = &scene;
    let mut reference = LocalReference::new(bands, surroundings, unknowns.clone());
    let signal: Vec<f64> = reference.signal(all[0], state).iter().map(Extended::to_f64).collect();
    if all.iter().any(|target| in_the_dark(&reference.signal(target, state))) {
        return Ok(());
    }
    let counting: Counting;
    let mut matrix = LocalMatrix::new(bands, surroundings, unknowns.clone());
    let (noise, fast) = if draw.chance(0.5) {
        counting = scene.counting(draw, &signal);
        (Noise::Counting(&counting), matrix.with_counting(&all, state, &counting))
    } else {
        (Noise::PerPhoton { photons: f64::INFINITY }, matrix.per_photon(&all, state))
    };
    let errors = fast.as_ref().map_or_else(|_| Vec::new(), |fast| matrix.relative_errors(fast));
    let mut solver = hadar::identifiability::local::LocalSolver::new(bands, surroundings, unknowns.clone());
    for (i, target) in all.iter().enumerate() {
        for (j, alternative) in all.iter().enumerate().filter(|(j, _)| *j != i) {
            let alone = match noise {
                Noise::PerPhoton { photons } => solver.per_photon(target, alternative, state, photons),
                Noise::Counting(counting) => solver.with_counting(target, alternative, state, counting),
            };
            let (Ok(fast), Ok(alone)) = (&fast, &alone) else {
                // The first target that fails fails the matrix.
                found.require(fast.is_err() || alone.is_ok(), || {
                    "a pair fails where the matrix does not".into()
                });
                continue;
            };
            let value = fast[3 * i + j];
            found.require(value.is_finite() && value >= 0.0, || format!("distance {value}"));
            if alone.status == Status::Equilibrium {
                // To the last bit of the lighting factors.
                found.require(value == 0.0, || format!("distance {value:e} in equilibrium"));
                continue;
            }
            let exact = reference.answer(Pair { emissivity: target, alternative, state }, noise, &[]);
            if faint(&exact) {
                continue;
            }
            let rounding = 1e-14 * exact.terms.to_f64();
            if alone.distance == 0.0 || value == 0.0 || exact.distance.to_f64() < TINY {
                let limit = (2.0 * rounding).max(2.0 * TINY);
                found.require(value <= limit && exact.distance.to_f64() <= limit, || {
                    format!("distance {value:e} where {:e} is exact", exact.distance.to_f64())
                });
                continue;
            }
            let error = Extended::from(value).relative_error_to(&exact.distance);
            found.check("distance", error, errors[3 * i + j]);
        }
    }
    Ok(())
}
