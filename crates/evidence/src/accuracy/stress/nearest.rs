//! Nearest distances against the separation of the state that was found, and the valley that it stands in.

use super::draw::Draw;
use super::findings::Findings;
use super::scene::{Hardship, Scene};
use crate::reference::Extended;
use crate::reference::local::{LocalReference, Noise, Pair};
use crate::reference::nearest::NearestReference;
use hadar::error::Result;
use hadar::identifiability::nearest::{NearestSolver, StateRange};

/// Rounding of the separation's terms, relative to their sum.
const ROUNDING: f64 = 2e-15;
/// Share by which the valley may be deeper than where the search ended.
const DEEPER: f64 = 1e-6;

/// A mild scene with a search of the alternative's own state.
pub(super) fn judge(draw: &mut Draw, found: &mut Findings) -> Result<()> {
    let count = 5 + draw.below(8);
    let scene = Scene::draw(draw, Hardship::Mild, count)?;
    let Scene { bands, surroundings, state, target, alternative, unknowns } = &scene;
    let range = StateRange { temperature_k: [100.0, 1000.0], ..StateRange::default() };
    let mut solver = NearestSolver::new(bands, surroundings, unknowns.clone(), range);
    let signal = LocalReference::new(bands, surroundings, unknowns.clone()).signal(target, state);
    let signal: Vec<f64> = signal.iter().map(Extended::to_f64).collect();
    let counting = scene.counting(draw, &signal);
    let (noise, nearest) = if draw.chance(0.5) {
        let photons = draw.scale(1e3, 1e12);
        (Noise::PerPhoton { photons }, solver.per_photon(target, alternative, state, photons)?)
    } else {
        (Noise::Counting(&counting), solver.with_counting(target, alternative, state, &counting)?)
    };
    found.require(nearest.distance.is_finite(), || format!("distance {}", nearest.distance));
    let pair = Pair { emissivity: target, alternative, state };
    let mut reference = NearestReference::new(bands, surroundings, unknowns.clone(), range);
    let there = reference.separation(pair, &nearest.state, noise);
    let own = reference.separation(pair, state, noise);
    let rounding = ROUNDING * (there.terms.to_f64() + there.distance.to_f64());
    let separation = there.distance.to_f64();
    if nearest.distance == 0.0 {
        found.require(separation <= 2e-14 * own.distance.to_f64() + rounding, || {
            format!("0 where the separation is {separation:e}")
        });
        return Ok(());
    }
    let error = Extended::from(nearest.distance).relative_error_to(&there.distance);
    found.check("separation at the nearest state", error, rounding / separation);
    let own = own.distance.to_f64();
    found.require(nearest.distance <= own * (1.0 + 1e-12) + rounding, || {
        format!("{:e} is farther than {own:e} at the target's own state", nearest.distance)
    });
    if !nearest.converged {
        // Which it says.
        return Ok(());
    }
    if let Some((least, _)) = reference.nearest_from(pair, std::slice::from_ref(&nearest.state), noise) {
        let least = least.to_f64();
        found.require(nearest.distance <= least * (1.0 + DEEPER) + rounding, || {
            format!("{:e} where the valley goes down to {least:e}", nearest.distance)
        });
    }
    Ok(())
}
