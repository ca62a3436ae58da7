//! Nearest distances in hard scenes, and from the nearest state back to the target's own material.
//!
//! Each, there and back, must be the separation of the state it names, within its stated error or, where none is stated, a
//! few units in the last place of the terms of that separation; and its lower bound must not be above what is possible:
//! there the brute force's distance, back the one that leads there, as the target's own state is among the candidates
//! where it is within the range. Brackets and the probability averaged over both ends are those of extended precision.

use super::draw::Draw;
use super::findings::Findings;
use crate::accuracy::brute_force::scene::{Scene, Set};
use crate::accuracy::brute_force::{answer, tolerance};
use crate::reference::Extended;
use crate::reference::brute_force::BruteForce;
use crate::reference::double_double::Real;
use crate::reference::local::{LocalReference, Noise, Pair};
use crate::reference::nearest::NearestReference;
use crate::reference::probability::normal_tail;
use hadar::error::{Error, Result};
use hadar::identifiability::detection;
use hadar::identifiability::nearest::{NearestDistance, NearestSolver};
use hadar::scene::{Parameter, State};

/// Rounding of the separation's terms, relative to their sum, over 10 + x as that of radiances is, x = hcν/kT.
const ROUNDING: f64 = 2e-16;
/// hc/k, cm K.
const SECOND_RADIATION_CM_K: f64 = 1.438_776_877;
/// Smallest band signal over the largest that separations are judged with.
const FAINT: f64 = 1e-150;

/// One scene with any set of unknowns but temperatures of the surroundings, which take the brute force long.
pub(super) fn judge(draw: &mut Draw, found: &mut Findings) -> Result<()> {
    let sets: Vec<Set> = Set::all().into_iter().filter(|set| !set.environment).collect();
    let set = sets[draw.below(sets.len())];
    let scene = Scene::draw(draw, set)?;
    let Scene { bands, surroundings, state, target, alternative, unknowns, range, counting } = &scene;
    let noise = counting.as_ref().map_or(Noise::PerPhoton { photons: f64::INFINITY }, Noise::Counting);
    let pair = Pair { emissivity: target, alternative, state };
    let mut signal = LocalReference::new(bands, surroundings, unknowns.clone());
    let mut photons = |material: &[f64], state: &State| -> Vec<f64> {
        signal.signal(material, state).iter().map(Extended::to_f64).collect()
    };
    let own = photons(target, state);
    let there = match answer(&scene, Some(tolerance(&scene, set))) {
        // A target without light is refused.
        Err(Error::OutOfRange { .. }) if own.iter().all(|signal| *signal < FAINT) => return Ok(()),
        answered => answered?,
    };
    named(found, "there", &scene, pair, &there);
    let force = BruteForce::new(bands, surroundings, unknowns, *range);
    if let Some(least) = force.nearest(pair, noise) {
        let least = least.distance.to_f64();
        found.require(there.lower <= least * (1.0 + 4.0 * f64::EPSILON), || {
            format!("lower bound {:e} where {least:e} is possible", there.lower)
        });
    }
    let other = photons(alternative, &there.state);
    let most = other.iter().copied().fold(0.0, f64::max);
    if other.iter().any(|signal| *signal < FAINT * most) {
        return Ok(());
    }
    let mut solver =
        NearestSolver::new(bands, surroundings, unknowns.clone(), *range).proving(tolerance(&scene, set));
    let back = match counting {
        None => solver.per_photon(alternative, target, &there.state, f64::INFINITY)?,
        Some(counting) => solver.with_counting(alternative, target, &there.state, counting)?,
    };
    let pair = Pair { emissivity: alternative, alternative: target, state: &there.state };
    named(found, "back", &scene, pair, &back);
    // Per photon of the target, as the distance there is.
    let per_photon = match counting {
        None => (other.iter().sum::<f64>() / own.iter().sum::<f64>()).sqrt(),
        Some(_) => 1.0,
    };
    let limit = force.separation(pair, state, noise).to_f64();
    found.require(!is_candidate(&scene, &there.state) || back.lower <= limit * (1.0 + 1e-14), || {
        format!("back lower bound {:e} where the target's own state is at {limit:e}", back.lower)
    });
    brackets(found, there.distance, back.distance * per_photon);
    Ok(())
}

/// Whether the target's own state is one that the search back may choose: within the range, and as the nearest state is in all
/// that is known.
fn is_candidate(scene: &Scene, nearest: &State) -> bool {
    let Scene { state, range, unknowns, .. } = scene;
    let [[cold, hot], [dim, bright]] = [range.temperature_k, range.lighting];
    let lit: f64 = state.lighting.iter().sum();
    let parameters = unknowns.parameters(state.lighting.len());
    let free = |parameter: Parameter| parameters.contains(&parameter);
    (!free(Parameter::Temperature) || (cold..=hot).contains(&state.temperature_k))
        && (!free(Parameter::Lighting(0))
            || (state.lighting.iter().all(|factor| (dim..=bright).contains(factor))
                && lit <= range.lighting_sum * (1.0 - 1e-15)
                && unknowns.known_lighting_total().is_none()))
        && (free(Parameter::Gain) || state.gain == nearest.gain)
}

/// A distance against the separation of the state that comes with it.
fn named(found: &mut Findings, way: &str, scene: &Scene, pair: Pair<'_>, answer: &NearestDistance) {
    let Scene { bands, surroundings, unknowns, range, counting, .. } = scene;
    let noise = counting.as_ref().map_or(Noise::PerPhoton { photons: f64::INFINITY }, Noise::Counting);
    let NearestDistance { distance, lower, relative_error, .. } = *answer;
    found.require(distance >= 0.0 && distance.is_finite(), || format!("{way}: distance {distance}"));
    found.require(lower >= 0.0 && lower <= distance * (1.0 + 4.0 * f64::EPSILON), || {
        format!("{way}: lower bound {lower:e} of {distance:e}")
    });
    let mut reference = NearestReference::new(bands, surroundings, unknowns.clone(), *range);
    let exact = reference.separation(pair, &answer.state, noise);
    let separation = exact.distance.to_f64();
    let coldest = pair.state.temperature_k.min(answer.state.temperature_k);
    let x = SECOND_RADIATION_CM_K * bands.nodes_cm1().iter().copied().fold(0.0, f64::max) / coldest;
    let rounding = ROUNDING * (10.0 + x) * (exact.terms.to_f64() + separation);
    if distance == 0.0 {
        let own = reference.separation(pair, pair.state, noise).distance.to_f64();
        found.require(separation <= 2e-14 * own + rounding, || {
            format!("{way}: 0 where the separation is {separation:e}")
        });
        return;
    }
    let error = Extended::from(distance).relative_error_to(&exact.distance);
    let bound = if relative_error.is_finite() { relative_error } else { rounding / separation };
    found.check(&format!("{way}: separation at the nearest state"), error, bound);
}

/// The bracket of the best test's error, and the probability averaged over both ends, against extended precision.
fn brackets(found: &mut Findings, distance: f64, back: f64) {
    if distance > 37.0 || distance == 0.0 {
        return;
    }
    let bound = 1e-15 * (10.0 + distance * distance);
    let d = Extended::from(distance);
    let rho = (d.square() * Extended::from(-0.5)).exp();
    // 1 − √(1 − ρ²) would lose what is below the last of 512 bits.
    let root = (Extended::one() - rho.square()).sqrt();
    let lower = rho.square() / (Extended::one() + root) * Extended::from(0.5);
    let bracket = detection::error_bracket(distance);
    found.check(
        "upper end of the bracket",
        Extended::from(bracket.upper).relative_error_to(&(rho * Extended::from(0.5))),
        bound,
    );
    if lower.to_f64() > 1e-290 {
        found.check(
            "lower end of the bracket",
            Extended::from(bracket.lower).relative_error_to(&lower),
            2.0 * bound,
        );
    }
    let ratio = (back / distance).min(1.0);
    let width = ((1.0 + ratio) * 0.5).sqrt();
    let exact =
        (normal_tail(-distance / width) + normal_tail(-ratio * distance / width)) * Extended::from(0.5);
    let both = detection::two_sided_probability(distance, ratio);
    found.check("probability over both ends", Extended::from(both).relative_error_to(&exact), bound);
}
