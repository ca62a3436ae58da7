//! Local distances judged by the reference: status, value, and the rounding error that the answer claims.

use super::draw::Draw;
use super::findings::Findings;
use super::findings::Point;
use super::report::digits;
use super::scene::{Hardship, Scene, band_count};
use crate::reference::Extended;
use crate::reference::local::{LocalAnswer, LocalReference, Noise, Pair, Share};
use hadar::error::{Error, Result};
use hadar::fisher::{Counting, Projector, Unknowns};
use hadar::identifiability::Status;
use hadar::identifiability::local::{LocalDistance, LocalSolver};
use hadar::planck;
use hadar::scene::Parameter;

const UNIT_ROUNDOFF: f64 = 0.5 * f64::EPSILON;
/// Photon radiance of a scene or a band below which it counts as dark.
const DARK: f64 = 1e-150;
/// Largest change of a band's signal per unit of an unknown below which it counts as faint.
const FAINT: f64 = 1e-250;
/// Distance below which doubles need not keep its digits.
pub(super) const TINY: f64 = 1e-200;
/// Rounding of sums and elements in units in the last place, for what comes without an estimate.
const FEW: f64 = 16.0;

/// One scene with or without electronic noise.
pub(super) fn judge(draw: &mut Draw, found: &mut Findings, hardship: Hardship, noise: bool) -> Result<()> {
    let count = band_count(draw);
    let scene = Scene::draw(draw, hardship, count)?;
    judge_scene(draw, found, &scene, noise).map(drop)
}

/// A fast answer beside the exact one; nothing where there rightly is none.
pub(super) type Both = Option<(LocalDistance, LocalAnswer)>;

/// Judges a scene.
pub(super) fn judge_scene(draw: &mut Draw, found: &mut Findings, scene: &Scene, noise: bool) -> Result<Both> {
    let Scene { bands, surroundings, state, target, alternative, unknowns } = scene;
    let mut solver = LocalSolver::new(bands, surroundings, unknowns.clone());
    let mut reference = LocalReference::new(bands, surroundings, unknowns.clone());
    let exact_signal = reference.signal(target, state);
    let signal: Vec<f64> = exact_signal.iter().map(Extended::to_f64).collect();
    let total: f64 = signal.iter().sum();
    let counting: Counting;
    let (noise, fast) = if noise && total > DARK {
        counting = scene.counting(draw, &signal);
        (Noise::Counting(&counting), solver.with_counting(target, alternative, state, &counting))
    } else {
        let photons = if draw.chance(0.5) { f64::INFINITY } else { draw.scale(1.0, 1e30) };
        (Noise::PerPhoton { photons }, solver.per_photon(target, alternative, state, photons))
    };
    let fast = match fast {
        Ok(fast) => fast,
        Err(error) => {
            let declared = excused(&error, total);
            found.require(declared, || format!("an error that is not due: {error}"));
            return Ok(None);
        }
    };
    if in_the_dark(&exact_signal) {
        finite(found, &fast);
        return Ok(None);
    }
    let pair = Pair { emissivity: target, alternative, state };
    let exact = reference.answer(pair, noise, &[]);
    if faint(&exact) {
        finite(found, &fast);
        return Ok(None);
    }
    compare(found, scene, &fast, &exact);
    Ok(Some((fast, exact)))
}

/// Whether a band has light, but so little that doubles hold none of it, or not all of its digits: it counts as dark.
pub(super) fn in_the_dark(signal: &[Extended]) -> bool {
    let dark = Extended::from(DARK);
    signal.iter().any(|signal| signal.is_positive() && *signal < dark)
}

/// Whether an unknown changes anything, but so little that doubles lose digits of it.
pub(super) fn faint(exact: &LocalAnswer) -> bool {
    exact.shares.iter().any(|share| share.largest > 0.0 && share.largest < FAINT)
}

/// Whether an error is one of the declared ones.
fn excused(error: &Error, total: f64) -> bool {
    matches!(error, Error::OutOfRange { .. }) && !(total > DARK && total.is_finite())
}

/// No answer may be anything but a finite number, 0 or above.
fn finite(found: &mut Findings, fast: &LocalDistance) {
    let numbers = [fast.distance, fast.distance_no_nuisance, fast.relative_error, fast.photon_radiance];
    found.require(numbers.iter().all(|number| number.is_finite() && *number >= 0.0), || {
        format!("not a finite number: {numbers:?}")
    });
}

/// A fast answer against the exact one with the same nuisances left out.
pub(super) fn compare(found: &mut Findings, scene: &Scene, fast: &LocalDistance, exact: &LocalAnswer) {
    finite(found, fast);
    let error = |value: f64, exact: &Extended| Extended::from(value).relative_error_to(exact);
    found.check("photon radiance", error(fast.photon_radiance, &exact.photon_radiance), FEW * UNIT_ROUNDOFF);
    // Nothing is said where even the answer's own digits do not tell.
    if fast.relative_error < 1.0 {
        judge_dropped(found, fast, exact);
    }
    let norm = exact.distance_no_nuisance.to_f64();
    let terms = exact.terms.to_f64();
    if norm > TINY && fast.status != Status::Equilibrium {
        let bound = fast.relative_error_no_nuisance + 2.0 * UNIT_ROUNDOFF;
        found.check(
            "distance with no nuisance",
            error(fast.distance_no_nuisance, &exact.distance_no_nuisance),
            bound,
        );
    }
    // What counts as nothing: the rounding of the material's own column.
    let rounding = 2.0 * FEW * UNIT_ROUNDOFF * terms;
    let distance = exact.distance.to_f64();
    let identical = scene.target == scene.alternative;
    match fast.status {
        Status::Ok if distance < TINY => {
            found.require(fast.distance <= 2.0 * TINY, || format!("{:e}, not {distance:e}", fast.distance));
        }
        Status::Ok => {
            found.require(!identical, || "Ok for identical materials".into());
            let bound = fast.relative_error + 2.0 * UNIT_ROUNDOFF;
            found.check("distance", error(fast.distance, &exact.distance), bound);
        }
        Status::Identical => {
            found.require(identical, || "Identical for materials that differ".into());
        }
        Status::Equilibrium => {
            // To the last bit of several lighting factors.
            let rest = scene.state.lighting.iter().fold(Extended::one(), |rest, v| rest - Extended::from(*v));
            let warm = scene.state.environment_k.iter().zip(&scene.state.lighting);
            let warm = warm.filter(|part| *part.1 > 0.0).all(|part| *part.0 == scene.state.temperature_k);
            let last_bit = warm && rest.abs() <= Extended::from(0.5 * f64::EPSILON);
            found.require(norm <= 1e-120 || last_bit, || format!("Equilibrium at a distance {norm:e}"));
        }
        Status::Blind => {
            found.require(!identical, || "Blind for identical materials".into());
            found.require(distance <= rounding.max(TINY), || {
                format!("Blind at a distance {distance:e} where rounding is {rounding:e}")
            });
        }
    }
    if fast.status != Status::Ok {
        found.require(fast.distance == 0.0, || format!("{:?} with a distance", fast.status));
    }
}

/// Whether those nuisances were dropped, and those alone, that change nothing.
fn judge_dropped(found: &mut Findings, fast: &LocalDistance, exact: &LocalAnswer) {
    for Share { parameter, left, largest } in &exact.shares {
        if *parameter == Parameter::Material || *largest < DARK {
            continue;
        }
        let dropped = fast.dropped.contains(parameter);
        found.require(*left == 0.0 || !dropped, || format!("{parameter:?} dropped, {left:.1e} of it left"));
        let kept = fast.status == Status::Ok && !dropped;
        found.require(*left > 0.0 || !kept, || format!("{parameter:?} kept, nothing of it left"));
    }
}

/// A scene near equilibrium, with a point for the picture where it is of one black object.
pub(super) fn near_equilibrium(draw: &mut Draw, found: &mut Findings, case: u64) -> Result<()> {
    let count = band_count(draw);
    let scene = Scene::draw(draw, Hardship::Equilibrium, count)?;
    let noise = draw.chance(0.2);
    let Some((_, exact)) = judge_scene(draw, found, &scene, noise)? else { return Ok(()) };
    let Scene { bands, surroundings, state, target, alternative, .. } = &scene;
    let ([base_k], [factor]) = (state.environment_k.as_slice(), state.lighting.as_slice()) else {
        return Ok(());
    };
    if noise || !bands.one_node_per_band() {
        return Ok(());
    }
    let mut solver = LocalSolver::new(bands, surroundings, Unknowns::default());
    let bare = solver.per_photon(target, alternative, state, f64::INFINITY)?;
    if bare.status != Status::Ok {
        return Ok(());
    }
    let naive = naive_distance(&scene, *base_k, *factor);
    let error = |value: f64| Extended::from(value).relative_error_to(&exact.distance_no_nuisance);
    let bound = bare.relative_error + 2.0 * UNIT_ROUNDOFF;
    found.check("distance with nothing unknown", error(bare.distance), bound);
    found.points.push(Point {
        case,
        apart: ((state.temperature_k - base_k) / base_k).abs(),
        unlit: 1.0 - factor,
        digits: digits(error(bare.distance)),
        digits_naive: digits(error(naive)),
        digits_claimed: digits(bare.relative_error),
    });
    Ok(())
}

/// The distance with no nuisance by the formulas as they stand, in doubles: C = B(T) − V·B(T₀).
fn naive_distance(scene: &Scene, base_k: f64, factor: f64) -> f64 {
    let nodes = scene.bands.nodes_cm1();
    let widths = scene.bands.widths_cm1();
    let gain = scene.state.gain;
    let (mut column, mut signal) = (Vec::new(), Vec::new());
    for (i, &nu) in nodes.iter().enumerate() {
        let own = planck::photon_radiance(nu, scene.state.temperature_k);
        let lit = factor * planck::photon_radiance(nu, base_k);
        let (e, other) = (scene.target[i], scene.alternative[i]);
        signal.push(widths[i] * gain * (e * own + (1.0 - e) * lit));
        column.push(widths[i] * gain * (other - e) * (own - lit));
    }
    let total: f64 = signal.iter().sum();
    let weights: Vec<f64> =
        signal.iter().map(|signal| if *signal > 0.0 { 1.0 / (signal * total) } else { 0.0 }).collect();
    0.5 * Projector::default().project(&mut column, &weights, 1.0).residual
}
