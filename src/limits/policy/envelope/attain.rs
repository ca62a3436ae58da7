//! The worst case from above: a dense set of scenes, and descents from the best of them.
//!
//! Scenes are points of a lattice ([`GoldenLattice`]), stretched a little beyond the envelope and cut off at its faces, where
//! least distances often lie, and every corner. In each the nearest state is searched for. A descent then moves
//! along one range at a time and along what two rounds have gained (Hooke and Jeeves, J. ACM 8, 212 (1961)), with steps
//! that halve. Neither proves anything.

use super::joint;
use super::model::{Model, Point, Region};
use super::ranges::Ranges;
use super::scene::EnvelopeScene;
use crate::error::Result;
use crate::identifiability::nearest::NearestSolver;
use crate::lattice_points::GoldenLattice;
use crate::order;
use crate::parallel;
use crate::scene::State;

/// Share of a range by which points of the lattice reach beyond it on either side.
const BEYOND: f64 = 0.1;
/// Dimensions up to which every corner is tried.
const CORNERS: usize = 7;
/// Descents.
const DESCENTS: usize = 6;
/// First step of a descent and the one at which it ends, as shares of a range.
const FIRST_STEP: f64 = 0.125;
const LAST_STEP: f64 = 2e-5;
/// Distances that one descent computes at most.
const PATIENCE: usize = 500;

/// Relative difference of two distances that is rounding.
const SAME: f64 = 1e-9;

/// The least distance found.
#[derive(Debug, Clone)]
pub(super) struct Attained {
    pub(super) distance: f64,
    pub(super) state: State,
    pub(super) nearest: State,
    pub(super) evaluations: u64,
}

/// A point of the unit cube with its distance.
#[derive(Debug, Clone)]
struct Tried {
    place: Vec<f64>,
    distance: f64,
    nearest: State,
}

/// What the nearest states are computed with.
struct Trial<'a, 's> {
    scene: &'s EnvelopeScene<'a>,
    ranges: &'s Ranges,
    solver: NearestSolver<'a>,
    evaluations: u64,
}

impl Trial<'_, '_> {
    fn at(&mut self, place: &[f64]) -> Result<Tried> {
        self.evaluations += 1;
        let EnvelopeScene { emissivity, alternative, counting, .. } = *self.scene;
        let state = self.ranges.scene_at(place);
        let found = self.solver.with_counting(emissivity, alternative, &state, counting)?;
        Ok(Tried { place: place.to_vec(), distance: found.distance, nearest: found.state })
    }

    /// The scene of a point, and the nearer of what the search finds there and what the point's own state leads to.
    fn from(&mut self, model: &Model<'_>, point: &Point) -> Result<Tried> {
        let place = model.place(point, self.ranges);
        let found = self.at(&place)?;
        let EnvelopeScene { emissivity, alternative, counting, .. } = *self.scene;
        let state = self.ranges.scene_at(&place);
        let start = model.nearest_at(point, &state);
        self.evaluations += 1;
        let own = self.solver.refine_with_counting(emissivity, alternative, &state, counting, &start)?;
        // By more than rounding: what the search finds is what others will find.
        let nearer = own.distance < found.distance * (1.0 - SAME);
        Ok(if nearer { Tried { distance: own.distance, nearest: own.state, ..found } } else { found })
    }
}

/// The least distance of `points` scenes and more, refined.
pub(super) fn attain(
    scene: &EnvelopeScene<'_>,
    ranges: &Ranges,
    points: usize,
    joint: Option<&(Model<'_>, Region)>,
) -> Result<Attained> {
    let free: Vec<bool> = ranges.all().iter().map(|[low, high]| low < high).collect();
    let places = places(&free, points);
    let solver = scene.solver();
    let trial = || Trial { scene, ranges, solver: solver.clone(), evaluations: 0 };
    let mut tried: Vec<Tried> = parallel::try_map_with(places.len(), trial, |trial, i| trial.at(&places[i]))?;
    order::ascending(&mut tried, |a| a.distance);
    let starts = apart(tried);
    let refined: Vec<(Tried, u64)> = parallel::try_map(starts.len(), |i| {
        let mut trial = trial();
        Ok((refine(&mut trial, starts[i].clone(), &free, joint)?, trial.evaluations))
    })?;
    let evaluations = places.len() as u64 + refined.iter().map(|(_, count)| count).sum::<u64>();
    let best = refined.into_iter().map(|(tried, _)| tried).min_by(|a, b| a.distance.total_cmp(&b.distance));
    let best = match best {
        Some(best) => best,
        None => trial().at(&vec![0.5; free.len()])?,
    };
    Ok(Attained {
        distance: best.distance,
        state: ranges.scene_at(&best.place),
        nearest: best.nearest,
        evaluations,
    })
}

/// A scene at one temperature in which the distance is 0.
pub(super) fn nothing_differs(scene: &EnvelopeScene<'_>, ranges: &Ranges) -> Result<Option<Attained>> {
    let EnvelopeScene { emissivity, alternative, counting, .. } = *scene;
    let mut solver = scene.solver();
    for (tried, state) in ranges.isothermal().into_iter().enumerate() {
        let found = solver.with_counting(emissivity, alternative, &state, counting)?;
        if found.distance == 0.0 {
            let evaluations = tried as u64 + 1;
            return Ok(Some(Attained { distance: 0.0, state, nearest: found.state, evaluations }));
        }
    }
    Ok(None)
}

/// What a descent from a point that another search has come upon leads to, if it is below `below`; and how many
/// nearest distances that took.
pub(super) fn attain_from(
    (model, whole): &(Model<'_>, Region),
    ranges: &Ranges,
    start: Point,
    below: f64,
) -> Result<(Option<Attained>, u64)> {
    let (point, distance) = joint::descend(model, whole, start);
    if distance >= below {
        return Ok((None, 0));
    }
    let found = attained_at(model, ranges, &point)?;
    let evaluations = found.evaluations;
    Ok(((found.distance < below).then_some(found), evaluations))
}

/// What a descent from a point leads to.
pub(super) fn attain_near(
    (model, whole): &(Model<'_>, Region),
    ranges: &Ranges,
    start: Point,
) -> Result<Attained> {
    let (point, _) = joint::descend(model, whole, start);
    attained_at(model, ranges, &point)
}

/// The nearest state in the scene of a point, and its distance.
fn attained_at(model: &Model<'_>, ranges: &Ranges, point: &Point) -> Result<Attained> {
    let scene = &model.scene;
    let mut trial = Trial { scene, ranges, solver: scene.solver(), evaluations: 0 };
    let Tried { place, distance, nearest } = trial.from(model, point)?;
    let evaluations = trial.evaluations;
    Ok(Attained { distance, state: ranges.scene_at(&place), nearest, evaluations })
}

/// From one of the best scenes downhill: with the alternative's state together where that can be, then along the ranges.
fn refine(
    trial: &mut Trial<'_, '_>,
    mut best: Tried,
    free: &[bool],
    joint: Option<&(Model<'_>, Region)>,
) -> Result<Tried> {
    let Some((model, whole)) = joint else { return descend(trial, best, free, FIRST_STEP) };
    let start = model.point(&trial.ranges.scene_at(&best.place), &best.nearest);
    let (point, _) = joint::descend(model, whole, start);
    let found = trial.from(model, &point)?;
    if found.distance < best.distance {
        best = found;
    }
    Ok(best)
}

/// Points of the unit cube: the lattice and the corners. What is not free stays at 0.
fn places(free: &[bool], points: usize) -> Vec<Vec<f64>> {
    let dimensions: Vec<usize> = (0..free.len()).filter(|&i| free[i]).collect();
    let n = dimensions.len();
    let lay = |value: &dyn Fn(usize) -> f64| {
        let mut place = vec![0.0; free.len()];
        dimensions.iter().enumerate().for_each(|(i, &dimension)| place[dimension] = value(i));
        place
    };
    if n == 0 {
        return vec![lay(&|_| 0.0)];
    }
    let lattice = GoldenLattice::new(vec![0.5; n]);
    let scenes = (1..=points).map(|index| {
        let point = lattice.point(index);
        lay(&|i| (point[i] * (1.0 + 2.0 * BEYOND) - BEYOND).clamp(0.0, 1.0))
    });
    let corners = 0..if n <= CORNERS { 1usize << n } else { 0 };
    corners.map(|corner| lay(&|i| ((corner >> i) & 1) as f64)).chain(scenes).collect()
}

/// The best of the scenes that are not close to a better one.
fn apart(sorted: Vec<Tried>) -> Vec<Tried> {
    let mut starts: Vec<Tried> = Vec::new();
    for tried in sorted {
        let far = |other: &Tried| tried.place.iter().zip(&other.place).any(|(a, b)| (a - b).abs() > 0.15);
        if starts.iter().all(far) {
            starts.push(tried);
            if starts.len() == DESCENTS {
                break;
            }
        }
    }
    starts
}

/// The method of Hooke and Jeeves within the unit cube.
fn descend(trial: &mut Trial<'_, '_>, start: Tried, free: &[bool], first_step: f64) -> Result<Tried> {
    let (mut best, mut step) = (start, first_step);
    let first = trial.evaluations;
    while step > LAST_STEP && best.distance > 0.0 && trial.evaluations - first < PATIENCE as u64 {
        let before = best.place.clone();
        let moved = explore(trial, &mut best, free, step)?;
        if !moved {
            step *= 0.5;
            continue;
        }
        // On along what the round has gained, as long as it pays.
        let mut gain: Vec<f64> = best.place.iter().zip(&before).map(|(to, from)| to - from).collect();
        loop {
            let ahead: Vec<f64> =
                best.place.iter().zip(&gain).map(|(x, d)| (x + d).clamp(0.0, 1.0)).collect();
            if ahead == best.place {
                break;
            }
            let tried = trial.at(&ahead)?;
            if tried.distance >= best.distance {
                break;
            }
            best = tried;
            gain.iter_mut().for_each(|d| *d *= 2.0);
        }
    }
    Ok(best)
}

/// One step along each free range, if it pays; whether any did.
fn explore(trial: &mut Trial<'_, '_>, best: &mut Tried, free: &[bool], step: f64) -> Result<bool> {
    crate::stop::check();
    let mut moved = false;
    for dimension in (0..free.len()).filter(|&i| free[i]) {
        for step in [step, -step] {
            let mut place = best.place.clone();
            place[dimension] = (place[dimension] + step).clamp(0.0, 1.0);
            if place == best.place {
                continue;
            }
            let tried = trial.at(&place)?;
            if tried.distance < best.distance {
                *best = tried;
                moved = true;
                break;
            }
        }
    }
    Ok(moved)
}
