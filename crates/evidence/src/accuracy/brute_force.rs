//! Nearest distances held against a brute force, set of unknowns by set of unknowns, over scenes that searches find hard.
//!
//! The brute force ([`crate::reference::brute_force`]) gives the distance of a state within the range, with 31 digits, so
//! that none of what is counted here as wrong can be a fault of its own:
//!
//! * a proved lower bound above it;
//! * a distance proved to a tolerance that is above it by more than the tolerance;
//! * a distance that is off, as the separation of the state it names, by more than its stated error.
//!
//! Where nothing is proved a distance above it is no false statement; it is counted all the same. That the brute force
//! itself ends above the answer is counted too: it tells how good a witness it is. The answer's own state is one more start of
//! the way down, so that the judgement does not rest on the lattice alone.
//!
//! Case i is of set i modulo their number, and depends on the seed and i alone.

mod report;
pub(super) mod scene;
#[cfg(test)]
mod tests;

pub use report::{BruteForcePlan, BruteForceReport, Failure, SetReport};

use self::report::{Judged, Tally};
use self::scene::{Scene, Set};
use super::stress::draw::Draw;
use crate::reference::brute_force::BruteForce;
use crate::reference::double_double::Real;
use crate::reference::local::{Noise, Pair};
use hadar::error::{Error, Result};
use hadar::identifiability::nearest::{NearestDistance, NearestSolver};
use hadar::scene::State;
use hadar::stop::unless_it_panics;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

/// What is to be proved of the distance where no more than one temperature is unknown, and beyond.
const PROOF: [f64; 2] = [1e-6, 1e-3];
/// Rounding of 31 digits, over a few operations.
const LAST_DIGITS: f64 = 1e-29;
/// Rounding of the comparison itself.
const ROUNDING: f64 = 4.0 * f64::EPSILON;
/// Share by which the brute force may end above the way down from the answer.
const MISSED: f64 = 1e-9;
/// Share of the separation at the target's own state below which a distance is none: the alternative can imitate the target.
const VANISHING: f64 = 1e-12;

/// Scenes of a set at most: a month of two cores.
const MOST_SCENES: u64 = 1_000_000;

/// Holds the crate's nearest distances against the brute force, telling `progress` how many of how many are done.
///
/// # Errors
/// A plan without scenes, with more than a million of a set, or of a scene beyond those.
pub fn brute_force(plan: &BruteForcePlan, progress: &(dyn Fn(u64, u64) + Sync)) -> Result<BruteForceReport> {
    let sets = Set::all();
    let count = sets.len() as u64;
    let among = |quantity: &str, value: u64, least: u64, most: u64| {
        let expected = || format!("from {least} to {most}");
        let fits = (least..=most).contains(&value);
        fits.then_some(value).ok_or_else(|| Error::out_of_range(quantity, value as f64, "", expected()))
    };
    let cases = match plan.only {
        Some(case) => {
            let case = among("number of the scene", case, 0, MOST_SCENES * count - 1)?;
            case..case + 1
        }
        None => {
            0..count * among("scenes of the brute force of every set", plan.scenes_per_set, 1, MOST_SCENES)?
        }
    };
    let (done, all) = (AtomicU64::new(0), cases.end - cases.start);
    let run = |case: u64| {
        let judged = caught(plan.seed, case, sets[(case % count) as usize]);
        progress(done.fetch_add(1, Ordering::Relaxed) + 1, all);
        (case, judged)
    };
    let judged: Vec<(u64, Judged)> = cases.into_par_iter().map(run).collect();
    let mut tallies: Vec<Tally> = sets.iter().map(|set| Tally::new(*set)).collect();
    for (case, judged) in judged {
        tallies[(case % count) as usize].add(case, judged);
    }
    Ok(BruteForceReport::new(plan, tallies))
}

/// What a case finds; a panic of it is a fault.
fn caught(seed: u64, case: u64, set: Set) -> Judged {
    match unless_it_panics(|| judge(seed, case, set)) {
        Some(Ok(judged)) => judged,
        Some(Err(error)) => Judged::fault(format!("an error where the input is in order: {error}")),
        None => Judged::fault("panic".into()),
    }
}

fn judge(seed: u64, case: u64, set: Set) -> Result<Judged> {
    let mut draw = Draw::new(seed, case);
    let scene = Scene::draw(&mut draw, set)?;
    let start = Instant::now();
    let answer = answer(&scene, Some(tolerance(&scene, set)))?;
    let seconds = start.elapsed().as_secs_f64();
    let mut judged = compare(&scene, set, &answer);
    judged.solver_s = seconds;
    Ok(judged)
}

/// How far a distance is to be proved.
pub(super) fn tolerance(scene: &Scene, set: Set) -> f64 {
    let others = if set.environment { scene.surroundings.objects().len() } else { 0 };
    PROOF[usize::from(usize::from(set.temperature) + others > 1)]
}

/// The distance, proved to a share of it or only searched.
pub(super) fn answer(scene: &Scene, tolerance: Option<f64>) -> Result<NearestDistance> {
    let Scene { bands, surroundings, state, target, alternative, unknowns, range, counting } = scene;
    let solver = NearestSolver::new(bands, surroundings, unknowns.clone(), *range);
    let mut solver = match tolerance {
        Some(tolerance) => solver.proving(tolerance),
        None => solver,
    };
    match counting {
        None => solver.per_photon(target, alternative, state, f64::INFINITY),
        Some(counting) => solver.with_counting(target, alternative, state, counting),
    }
}

/// An answer against the brute force.
fn compare(scene: &Scene, set: Set, answer: &NearestDistance) -> Judged {
    let Scene { bands, surroundings, state, target, alternative, unknowns, range, counting } = scene;
    let start = Instant::now();
    let force = BruteForce::new(bands, surroundings, unknowns, *range);
    let pair = Pair { emissivity: target, alternative, state };
    let noise = counting.as_ref().map_or(Noise::PerPhoton { photons: f64::INFINITY }, Noise::Counting);
    let Some(found) = force.nearest(pair, noise) else {
        return Judged::fault("no state within the range".into());
    };
    let from_answer = force.nearest_from(pair, &answer.state, noise);
    let missed = from_answer.distance.to_f64() < found.distance.to_f64() * (1.0 - MISSED);
    let found = if missed { from_answer } else { found };
    let least = found.distance.to_f64();
    let separation = |state: &State| force.separation(pair, state, noise).to_f64();
    let there = separation(&answer.state);
    let tolerance = tolerance(scene, set);
    let NearestDistance { distance, lower, relative_error, .. } = *answer;
    let told = if relative_error.is_finite() { relative_error } else { 0.0 };
    let vanishing = least <= VANISHING * separation(state);
    let excess = if distance <= least || vanishing { 0.0 } else { distance / least - 1.0 };
    let mut judged = Judged {
        vanishing,
        excess,
        above: excess > tolerance + told + ROUNDING,
        proved: lower >= distance * (1.0 - tolerance) && (lower > 0.0 || distance == 0.0),
        bounded: lower > 0.0,
        error_told: relative_error.is_finite(),
        missed: missed && !vanishing,
        brute_force_s: start.elapsed().as_secs_f64(),
        ..Judged::default()
    };
    if !(distance >= 0.0 && distance.is_finite() && lower >= 0.0 && lower <= distance * (1.0 + ROUNDING)) {
        judged.faults.push(format!("distance {distance:e}, lower bound {lower:e}"));
    }
    if lower > least * (1.0 + ROUNDING) {
        judged.lower_above = true;
        let place = &found.state;
        judged.faults.push(format!("lower bound {lower:e} where {least:e} is the distance of {place:?}"));
    }
    if judged.proved && judged.above {
        judged.faults.push(format!("{distance:e} proved to {tolerance:e} where {least:e} is possible"));
    }
    // The brute force's own rounding is a share of the roots of signal and noise that it subtracts.
    let seen = bands.weigh(&surroundings.signal(target, state)).into_iter().enumerate();
    let roots: f64 = match counting {
        None => 1.0,
        Some(c) => seen.map(|(band, s)| c.counts_per_radiance * s + c.var_added(band)).sum::<f64>().sqrt(),
    };
    let apart = ((distance - there).abs() - LAST_DIGITS * roots).max(0.0);
    let off = if distance == 0.0 { 0.0 } else { apart / there };
    // A distance of 0 says that only rounding is left of the roots, whose squares are the counts.
    let dark = State { temperature_k: 0.1, gain: 1e-6, ..state.clone() };
    let dark = State { lighting: vec![0.0; dark.lighting.len()], ..dark };
    let nothing = distance == 0.0 && there <= VANISHING * separation(&dark);
    if relative_error.is_finite()
        && !nothing
        && (off > relative_error + ROUNDING || distance == 0.0 && there > 0.0)
    {
        judged.error_wrong = true;
        judged.faults.push(format!(
            "{distance:e} where the state named is at {there:e}, error told {relative_error:e}"
        ));
    }
    judged
}
