//! The limit turned round: how far at most is something that is to pass for a person (a heated mannequin) from the nearest person, over all
//! that its tolerances and an envelope of scenes allow?
//!
//! The stand-in has the emissivity e(ν) + δ, the same δ at all wavenumbers, and the temperature T; it is lit by V_k from objects of T_k. In all
//! these it may be anywhere in a box. The person has the temperature T′ and lighting V′ that make it most like the stand-in, each
//! as it is where the scene says that it is known. A person lit as the stand-in is is one too, also where objects light by different amounts and
//! the range that all of them have in common does not hold that. D is the largest nearest statistical distance over the box: no test tells a
//! stand-in within these tolerances from a person more often than Φ(D).
//!
//! **Attained**: the largest distance at corners of boxes. **Proved**: a bound from above, box by box. With chords of Planck's law for
//! T and T_k the stand-in's counts are affine in each of its coordinates, a mean of those at the corners. At each corner i a person
//! (T′_i, V′_i) is at d_i. ‖√(N + σ²) − √(N′ + σ²)‖² is convex in (N, N′) together, so that the same means of both are no farther
//! than the largest d_i. To the mean of the persons' counts the person of the mean (T̄, V̄) is near: with a ≤ B″, all of this is, node by node,
//!
//! * Σ w B(T′_i) − B(T̄) within [0, ¼ΔT′ ΔB′], since B is convex in T;
//! * Σ w V′_i B(T_k,i) − V̄ B(T_k) within ¼ΔV′ ΔB + V ¼ΔT_k ΔB′;
//! * e ¼ΔT ΔB′ + (1 − e) Σ V_k ¼ΔT_k ΔB′ for the stand-in itself,
//!
//! as counts s, whose part in the distance is at most ‖s/(2√(N + σ²))‖ at the least counts. The box with the largest bound
//! is halved until the bounds are near what is attained. Unknown gain or temperatures of the surroundings only bring persons nearer:
//! bounds that hold them at what they are hold for them too.
//!
//! Assumption: noise that does not depend on the scene (the least that it may be is given).
//!
//! Symbols: counts N = κ Σ_j w_j S(ν_j), σ² added variance, T in K, ν in cm⁻¹.

use super::envelope::{EnvelopeScene, Ranges};
use crate::best_first::BestFirst;
use crate::error::{Error, Result};
use crate::fisher::{Nuisance, Unknowns};
use crate::identifiability::nearest::NearestSolver;
use crate::planck;
use crate::scene::State;
use std::collections::HashMap;

/// Share of a bound that rounding of the search and of sums may make up.
const ROUNDING: f64 = 1e-9;
/// Dimensions of a box at most, whose corners are all looked at.
const MOST_DIMENSIONS: usize = 8;

/// How far to go.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effort {
    /// Share of the largest distance by which the bound may be above it.
    pub relative_tolerance: f64,
    /// Boxes at most.
    pub boxes: usize,
    /// Enough is known once the bound is at most this, or something is above it; `None` to go on to the tolerance.
    pub enough: Option<f64>,
}

/// The stand-in that is farthest from any person.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Farthest {
    /// Its nearest statistical distance, attained.
    pub distance: f64,
    /// Proved: nothing within the tolerances is farther from all persons.
    pub upper_bound: f64,
    /// Difference of its emissivity.
    pub offset: f64,
    /// Its state.
    pub state: State,
    /// The person that is most like it.
    pub person: State,
    /// Boxes that were looked at.
    pub boxes: usize,
}

/// A corner: the stand-in's counts, and the person nearest to it.
#[derive(Debug, Clone)]
struct Corner {
    distance: f64,
    person: State,
    counts: Vec<f64>,
    person_counts: Vec<f64>,
}

/// A box of (δ, T, V_1.., T_1..).
#[derive(Debug, Clone)]
struct Piece {
    low: Vec<f64>,
    high: Vec<f64>,
    /// Along which it is halved.
    split: usize,
}

struct Search<'a, 'b> {
    scene: &'b EnvelopeScene<'a>,
    solver: NearestSolver<'a>,
    /// Of persons lit as the stand-in is, where its own lighting may be one that persons of the scene's range do not have.
    lit_alike: Option<NearestSolver<'a>>,
    objects: usize,
    corners: HashMap<Vec<u64>, Corner>,
}

/// The farthest stand-in of a `scene`, whose target it is and whose alternative is the person: emissivity offsets and states within the
/// ranges.
///
/// # Errors
/// Ranges that do not fit the scene, offsets out of order or that lead out of [0, 1], more than eight coordinates that vary, or more
/// lighting than there is room for; a scene without photons.
pub fn farthest(
    scene: &EnvelopeScene<'_>,
    offsets: [f64; 2],
    ranges: &Ranges,
    effort: &Effort,
) -> Result<Farthest> {
    let objects = ranges.lighting().len();
    let ends = |of: &[[f64; 2]], end: usize| of.iter().map(|range| range[end]).collect::<Vec<_>>();
    let point = |end: usize| {
        let own = [offsets[end], ranges.temperature_k()[end]];
        [own.to_vec(), ends(ranges.lighting(), end), ends(ranges.environment_k(), end)].concat()
    };
    let (low, high) = (point(0), point(1));
    check(scene, offsets, &low, &high, ranges)?;
    // What else is unknown can only bring a person nearer.
    let known = scene.unknowns.nuisances().iter().copied();
    let held = known.filter(|nuisance| matches!(nuisance, Nuisance::Temperature | Nuisance::Lighting));
    let unknowns = Unknowns::new(held)?.lighting_total(scene.unknowns.known_lighting_total())?;
    let [dim, bright] = scene.range.lighting;
    let within = ranges.lighting().iter().all(|[low, high]| dim <= *low && *high <= bright);
    let lit_alike = if unknowns.contains(Nuisance::Lighting) && !within {
        let alike = unknowns.nuisances().iter().copied().filter(|nuisance| *nuisance != Nuisance::Lighting);
        Some(NearestSolver::new(scene.bands, scene.surroundings, Unknowns::new(alike)?, scene.range))
    } else {
        None
    };
    let solver = NearestSolver::new(scene.bands, scene.surroundings, unknowns, scene.range);
    let mut search = Search { scene, solver, lit_alike, objects, corners: HashMap::new() };
    let mut best: Option<(f64, Vec<f64>)> = None;
    let mut waiting = BestFirst::new(effort.boxes as u64);
    let mut parts = vec![[low, high]];
    loop {
        for [low, high] in parts {
            let (bound, piece) = search.piece(low, high, &mut best)?;
            // Of equal bounds the newest first.
            let age = u64::MAX - waiting.look();
            waiting.push(-bound, age, piece);
        }
        let attained = best.as_ref().map_or(0.0, |(distance, _)| *distance);
        let close = |bound: f64| bound <= attained * (1.0 + effort.relative_tolerance);
        let enough = |bound: f64| effort.enough.is_some_and(|enough| bound <= enough || attained > enough);
        let farthest = waiting.take(|bound| close(-bound) || enough(-bound));
        let Some((_, Piece { low, high, split })) = farthest else { break };
        let middle = 0.5 * (low[split] + high[split]);
        let (mut left, mut right) = (high.clone(), low.clone());
        (left[split], right[split]) = (middle, middle);
        parts = vec![[low, left], [right, high]];
    }
    let (distance, place) = best.unwrap_or_default();
    let state = search.state(&place);
    let offset = place.first().copied().unwrap_or(0.0);
    let person = search.corner(&place)?.person.clone();
    let boxes = waiting.looked_at() as usize;
    Ok(Farthest { distance, upper_bound: -waiting.bound(), offset, state, person, boxes })
}

fn check(
    scene: &EnvelopeScene<'_>,
    offsets: [f64; 2],
    low: &[f64],
    high: &[f64],
    ranges: &Ranges,
) -> Result<()> {
    let objects = scene.surroundings.objects().len();
    if ranges.lighting().len() != objects {
        let what = "ranges of the lighting of a stand-in".into();
        return Err(Error::Length { what, found: ranges.lighting().len(), expected: objects });
    }
    let possible = |offset: f64| scene.emissivity.iter().all(|e| (0.0..=1.0).contains(&(e + offset)));
    if !(offsets[0] <= offsets[1] && offsets.iter().all(|offset| possible(*offset))) {
        let expected = "in order, and no emissivity with it below 0 or above 1";
        return Err(Error::out_of_range("difference of the emissivity", offsets[1], "", expected));
    }
    let most: f64 = ranges.lighting().iter().map(|range| range[1]).sum();
    if most > 1.0 + ROUNDING {
        let expected = "at most 1 for a stand-in, of whose tolerance every corner is looked at";
        return Err(Error::out_of_range("sum of the largest lighting factors", most, "", expected));
    }
    let wide = low.iter().zip(high).filter(|(low, high)| low < high).count();
    if wide > MOST_DIMENSIONS {
        let expected = format!("at most {MOST_DIMENSIONS}");
        return Err(Error::out_of_range("coordinates of a stand-in that vary", wide as f64, "", expected));
    }
    Ok(())
}

impl Search<'_, '_> {
    fn state(&self, place: &[f64]) -> State {
        let of = |from: usize| place.get(from..from + self.objects).unwrap_or_default().to_vec();
        State {
            temperature_k: place.get(1).copied().unwrap_or(f64::NAN),
            lighting: of(2),
            gain: 1.0,
            environment_k: of(2 + self.objects),
        }
    }

    /// What is at a corner; computed once for all boxes that share it.
    fn corner(&mut self, place: &[f64]) -> Result<&Corner> {
        let key: Vec<u64> = place.iter().map(|value| value.to_bits()).collect();
        if !self.corners.contains_key(&key) {
            let state = self.state(place);
            let offset = place.first().copied().unwrap_or(0.0);
            let emissivity: Vec<f64> = self.scene.emissivity.iter().map(|e| e + offset).collect();
            let counting = self.scene.counting;
            let mut found =
                self.solver.with_counting(&emissivity, self.scene.alternative, &state, counting)?;
            if let Some(solver) = &mut self.lit_alike {
                let alike = solver.with_counting(&emissivity, self.scene.alternative, &state, counting)?;
                found = if alike.distance < found.distance { alike } else { found };
            }
            let (bands, surroundings) = (self.scene.bands, self.scene.surroundings);
            let counts = |emissivity: &[f64], state: &State| {
                let mut counts = bands.weigh(&surroundings.signal(emissivity, state));
                counts.iter_mut().for_each(|count| *count *= counting.counts_per_radiance);
                counts
            };
            let person_counts = counts(self.scene.alternative, &found.state);
            let counts = counts(&emissivity, &state);
            let corner = Corner { distance: found.distance, person: found.state, counts, person_counts };
            self.corners.insert(key.clone(), corner);
        }
        self.corners.get(&key).ok_or_else(|| Error::malformed("a corner was lost", "report this as a bug"))
    }

    /// A box with its bound; `best` is told of corners that are farther.
    fn piece(
        &mut self,
        low: Vec<f64>,
        high: Vec<f64>,
        best: &mut Option<(f64, Vec<f64>)>,
    ) -> Result<(f64, Piece)> {
        let wide: Vec<usize> = (0..low.len()).filter(|&i| low[i] < high[i]).collect();
        let mut corners: Vec<Corner> = Vec::with_capacity(1 << wide.len());
        for number in 0..1usize << wide.len() {
            let mut place = low.clone();
            wide.iter()
                .enumerate()
                .filter(|(bit, _)| number >> bit & 1 == 1)
                .for_each(|(_, &i)| place[i] = high[i]);
            let corner = self.corner(&place)?.clone();
            if best.as_ref().is_none_or(|(distance, _)| corner.distance > *distance) {
                *best = Some((corner.distance, place));
            }
            corners.push(corner);
        }
        let attained = corners.iter().map(|corner| corner.distance).fold(0.0, f64::max);
        let spread = |of: &dyn Fn(&Corner) -> f64| {
            let [least, most] = corners
                .iter()
                .map(of)
                .fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(v), b.max(v)]);
            [least, most]
        };
        let person_k = spread(&|corner| corner.person.temperature_k);
        let person_lighting: Vec<[f64; 2]> = (0..self.objects)
            .map(|k| spread(&|corner| corner.person.lighting.get(k).copied().unwrap_or(0.0)))
            .collect();
        let [own, person] = self.bent(&low, &high, &corners, person_k, &person_lighting);
        let bound = attained + own + person;
        let bound = bound * (1.0 + ROUNDING);
        // In kelvins: how far the person moves along a coordinate, and how far the coordinate itself goes.
        let along = |bit: usize| {
            let pairs = (0..corners.len()).filter(|number| number >> bit & 1 == 0);
            let moved = pairs.map(|number| {
                let (a, b) = (&corners[number].person, &corners[number | 1 << bit].person);
                let lit = a.lighting.iter().zip(&b.lighting).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                (a.temperature_k - b.temperature_k).abs() + person_k[1] * 0.1 * lit
            });
            moved.fold(0.0, f64::max)
        };
        let is_kelvin = |i: usize| i == 1 || i >= 2 + self.objects;
        let score = |(bit, i): (usize, usize)| along(bit) + if is_kelvin(i) { high[i] - low[i] } else { 0.0 };
        let scored = wide.iter().enumerate().map(|(bit, &i)| (i, score((bit, i))));
        let split = scored.max_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(i, _)| i);
        Ok((bound, Piece { low, high, split }))
    }

    /// What the curvature of Planck's law puts on the bound of a box: how far stand-in and person are from the means of corners.
    fn bent(
        &self,
        low: &[f64],
        high: &[f64],
        corners: &[Corner],
        person_k: [f64; 2],
        person_lighting: &[[f64; 2]],
    ) -> [f64; 2] {
        let EnvelopeScene { bands, surroundings, emissivity, alternative, counting, .. } = self.scene;
        let nodes = bands.nodes_cm1();
        let own = sag(nodes, [low[1], high[1]]);
        let person = sag(nodes, person_k);
        let (mut of_own, mut of_person) = (vec![0.0; nodes.len()], vec![0.0; nodes.len()]);
        for j in 0..nodes.len() {
            of_own[j] = (emissivity[j] + high[0]) * own[j];
            of_person[j] = alternative[j] * person[j];
        }
        for (k, object) in surroundings.objects().iter().enumerate() {
            let ends = [low[2 + self.objects + k], high[2 + self.objects + k]];
            let bent = sag(nodes, ends);
            let (mut cold, mut warm) = (vec![0.0; nodes.len()], vec![0.0; nodes.len()]);
            planck::photon_radiance_into(nodes, ends[0], &mut cold);
            planck::photon_radiance_into(nodes, ends[1], &mut warm);
            let [least, most] = person_lighting[k];
            for j in 0..nodes.len() {
                let full = object.emissivity.as_ref().map_or(1.0, |emissivity| emissivity[j]);
                of_own[j] += (1.0 - emissivity[j] - low[0]) * full * high[2 + k] * bent[j];
                let moved = 0.25 * (most - least) * (warm[j] - cold[j]) + most * bent[j];
                of_person[j] += (1.0 - alternative[j]) * full * moved;
            }
        }
        let norm = |bent: &[f64], counts: &dyn Fn(&Corner) -> &Vec<f64>| {
            let bent = bands.weigh(bent);
            let squares = bent.iter().enumerate().map(|(w, bent)| {
                let bent = bent * counting.counts_per_radiance;
                if bent == 0.0 {
                    return 0.0;
                }
                let least = corners.iter().map(|corner| counts(corner)[w]).fold(f64::INFINITY, f64::min);
                let least = least - bent + counting.var_added(w);
                // Where nothing is left to count nothing is known.
                if least > 0.0 { 0.25 * bent * bent / least } else { f64::INFINITY }
            });
            squares.sum::<f64>().sqrt()
        };
        [norm(&of_own, &|corner| &corner.counts), norm(&of_person, &|corner| &corner.person_counts)]
    }
}

/// How far a chord of B(T) between two temperatures is above it at most: B is convex, so within ¼ΔT ΔB′.
fn sag(nodes_cm1: &[f64], [cold_k, warm_k]: [f64; 2]) -> Vec<f64> {
    let slope = |&node: &f64| {
        planck::photon_radiance_slope(node, warm_k) - planck::photon_radiance_slope(node, cold_k)
    };
    nodes_cm1.iter().map(|node| 0.25 * (warm_k - cold_k) * slope(node).max(0.0)).collect()
}

#[cfg(test)]
mod tests;
