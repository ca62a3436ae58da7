//! Requirements solved for and put back: the camera that is asked for must do what was asked.

use super::draw::Draw;
use super::findings::Findings;
use super::scene::{Hardship, Scene};
use crate::reference::Extended;
use crate::reference::local::{LocalReference, Noise, Pair};
use hadar::error::Result;
use hadar::identifiability::local::LocalSolver;
use hadar::instrument::{View, presets};
use hadar::policy::photons_required;
use hadar::policy::solve::{CameraTask, Quantity, Trial};

/// How closely a solution must meet what was asked: to the last bits of a logarithm, and what the distance's own
/// rounding adds.
const MET: f64 = 1e-9;

/// The cameras of the paper.
const CAMERAS: [&str; 3] = ["flir-a325sc", "nicolet-is50", "ideal-pnrd"];

/// A camera in front of a mild scene.
pub(super) fn judge(draw: &mut Draw, found: &mut Findings) -> Result<()> {
    let count = 6 + draw.below(6);
    let scene = Scene::draw(draw, Hardship::Mild, count)?;
    let Scene { bands, surroundings, state, target, alternative, unknowns } = &scene;
    let mut solver = LocalSolver::new(bands, surroundings, unknowns.clone());
    let per_photon = solver.per_photon(target, alternative, state, f64::INFINITY)?;
    put_photons_back(draw, found, per_photon.distance);
    if per_photon.relative_error > 1e-3 {
        return Ok(());
    }
    let mut camera = presets::get(CAMERAS[draw.below(CAMERAS.len())])?;
    camera.flicker_fraction = if draw.chance(0.3) { 0.0 } else { draw.scale(1e-6, 1.0) };
    camera.exposure_s = draw.scale(1e-9, 1e3);
    let distance_m = draw.chance(0.5).then(|| draw.scale(0.1, 1e5));
    let required = draw.scale(1e-3, 40.0);
    let task = CameraTask {
        camera: &camera,
        bands,
        required,
        distance_m,
        farthest_m: None,
        size_m: None,
        of_object: false,
    };
    let quantity = Quantity::OF_CAMERA[draw.below(Quantity::OF_CAMERA.len())];
    let view = View::at(distance_m);
    let mut distance = |trial: &Trial| {
        let counting = trial.camera.counting(bands, &view);
        solver.with_counting(target, alternative, state, &counting).map(|local| local.distance)
    };
    let solution = task.solve(quantity, &mut distance)?;
    found.require(solution.statistical_distance.is_finite(), || format!("{solution:?}"));
    let Some(value) = solution.value else {
        found.require(solution.reason.is_some() && solution.statistical_distance < required, || {
            format!("neither value nor reason: {solution:?}")
        });
        return Ok(());
    };
    found.require(value.is_finite() && value >= 0.0, || format!("{quantity:?} of {value}"));
    let trial = task.forward(quantity, value);
    let (counting, fast) = (trial.camera.counting(bands, &view), distance(&trial)?);
    let pair = Pair { emissivity: target, alternative, state };
    let exact = LocalReference::new(bands, surroundings, unknowns.clone()).answer(
        pair,
        Noise::Counting(&counting),
        &[],
    );
    let reached = exact.distance.to_f64();
    let tolerance = MET + per_photon.relative_error;
    let fully = reached >= required * (1.0 - tolerance);
    found.require(fully, || {
        format!("{quantity:?} of {value:e} reaches {reached:e} ({fast:e}), not {required:e}")
    });
    let whole = quantity == Quantity::Frames || value == 0.0;
    let off = Extended::from(required).relative_error_to(&exact.distance);
    // A pair that differs without limit meets it at any value.
    let anyhow = solution.statistical_distance == required && reached > required;
    if !whole && !anyhow {
        found.check("distance at the solution", off, tolerance);
    }
    Ok(())
}

/// N photons for a distance: √N·d₀ gives it back.
fn put_photons_back(draw: &mut Draw, found: &mut Findings, per_photon: f64) {
    let required = draw.scale(1e-6, 1e6);
    match photons_required(required, per_photon) {
        Some(photons) => {
            let back = Extended::from(photons).sqrt() * Extended::from(per_photon);
            let error = back.relative_error_to(&Extended::from(required));
            found.check("photons put back", error, 4.0 * f64::EPSILON);
        }
        None => found.require(per_photon == 0.0, || format!("no photons suffice at {per_photon:e}")),
    }
}
