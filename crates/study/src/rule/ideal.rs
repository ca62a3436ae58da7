//! The part of an envelope in which no camera could do what a rule demands.
//!
//! 'No camera' is an ideal one: a detector that counts every photon and adds no noise, behind the fastest lens in air
//! (f/0.5), with the largest pixel of the rule's cameras, exposed as long as motion blur allows at the rule's speed and
//! least distance (Δ = 1 for the camera that allows longest), or else as long as the longest integration among them, as
//! often as the most frames among them; the target fills the pixel at the least distance. It counts
//! N = κΣS, κ = π A_p t, of an object n times as many, n the most pixels of it that any of the cameras has.
//!
//! Beside it the share in which errors of the emissivities make up the whole distance, whatever the camera: with an error of
//! δ in each band of both materials, independent, the spectra move apart by (δ/√2)√(κ Σ C²/S) on average, C = B(T) − X
//! the contrast between own and scattered light. It grows with √κ as the distance does.
//!
//! Scenes: every range uniform (lighting that adds up to more than 1 left out), every pair alike; a lattice of irrational
//! steps with random shifts (Cranley and Patterson, SIAM J. Numer. Anal. 13, 904 (1976)), whose spread is the error.

use super::super::Study;
use super::apart::TellApart;
use super::approach::Moving;
use super::envelope::{all, scene_at};
use super::results::{EmissivityError, IdealCamera, LightTime, Neighbourhood, NotIdentifiable};
use hadar::demand::{self, Reason, Thing};
use hadar::error::Result;
use hadar::fisher::Counting;
use hadar::identifiability::nearest::NearestSolver;
use hadar::instrument::{Camera, FASTEST_F_NUMBER};
use hadar::lattice_points::GoldenLattice;
use hadar::parallel;
use hadar::planck;
use hadar::policy::envelope::Ranges;
use hadar::scene::State;
use hadar::spectrum::Bands;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

/// Random shifts of the lattice, and scenes of all of them together.
const SHIFTS: usize = 16;
const SCENES: usize = 2048;
/// Standard deviation of an emissivity in a band.
const EMISSIVITY_ERROR: f64 = 1e-3;
/// Share of the scenes that a neighbourhood holds.
const MOST: f64 = 0.9;

/// A scene before the ideal camera.
#[derive(Debug, Clone)]
struct Drawn {
    shift: usize,
    distance: f64,
    within_error: bool,
    state: State,
}

/// Scenes before the ideal camera.
#[derive(Debug, Clone)]
pub(super) struct Scenes<'a> {
    of: Vec<(&'a Study, Bands, Ranges)>,
    counts_per_radiance: f64,
    drawn: Vec<Drawn>,
}

impl Scenes<'_> {
    fn are_of(&self, other: &[(&Study, Bands, Ranges)]) -> bool {
        let same = |((one, bands, ranges), (other, other_bands, other_ranges)): (
            &(&Study, Bands, Ranges),
            &(&Study, Bands, Ranges),
        )| bands == other_bands && ranges == other_ranges && one.asks_as(other);
        self.of.len() == other.len() && self.of.iter().zip(other).all(same)
    }
}

impl TellApart {
    /// The share of the envelope in which an ideal camera does not tell the materials apart, and its scenes; those that are `known`
    /// where they are the same.
    pub(super) fn not_identifiable<'a>(
        &'a self,
        seed: u64,
        known: &[&Scenes<'a>],
    ) -> Result<(NotIdentifiable, Scenes<'a>)> {
        let cameras: Vec<&Camera> = self.cameras().collect();
        let pixel_m = cameras.iter().map(|camera| camera.pixel_m).fold(0.0, f64::max);
        let (time_s, why) = self.longest(&cameras);
        let near: &[Study] = self.candidates.first().map_or(&[], |candidate| &candidate.near);
        let etendue = std::f64::consts::PI * pixel_m * pixel_m / (4.0 * FASTEST_F_NUMBER * FASTEST_F_NUMBER);
        let pixels = near_pixels(near.iter().chain(self.candidates.iter().flat_map(|one| &one.near)));
        let counts_per_radiance = pixels * etendue * time_s;
        let of = near
            .iter()
            .map(|study| {
                let (bands, _) = study.received(None, study.scenario.target.distance_m)?;
                Ok((study, bands, study.ranges(&self.envelope)?))
            })
            .collect::<Result<Vec<(&Study, Bands, Ranges)>>>()?;
        let scenes = match known.iter().find(|one| one.are_of(&of)) {
            Some(known) => {
                demand::spared(Thing::NearestSearches, Reason::Shared, known.drawn.len() as u64);
                (*known).clone()
            }
            None => drawn(of, counts_per_radiance, seed)?,
        };
        let drawn = &scenes.drawn;
        let grown = (counts_per_radiance / scenes.counts_per_radiance).sqrt();
        let told = |scene: &Drawn| scene.distance * grown >= self.required;
        let (fraction, standard_error) = share(drawn, |scene| !told(scene));
        let (within, error_within) = share(drawn, |scene| scene.within_error);
        let definition = IdealCamera {
            f_number: FASTEST_F_NUMBER,
            pixel_m,
            time_s,
            why,
            distance_m: near.first().and_then(|study| study.scenario.target.distance_m),
            required: self.required,
            pixels,
            units: self.scenario.units(),
        };
        let found = NotIdentifiable {
            fraction,
            standard_error,
            definition,
            fraction_within_emissivity_error: within,
            standard_error_within_emissivity_error: error_within,
            emissivity_error: EmissivityError(EMISSIVITY_ERROR),
            scenes: drawn.len(),
            neighbourhood: neighbourhood(drawn, told),
        };
        Ok((found, scenes))
    }

    /// The cameras, looked up.
    fn cameras(&self) -> impl Iterator<Item = &Camera> {
        let studies = self.candidates.iter().filter_map(|candidate| candidate.near.first());
        studies.filter_map(|study| study.camera.as_ref())
    }

    /// The longest that the rule allows to collect light, s, and why.
    fn longest(&self, cameras: &[&Camera]) -> (f64, LightTime) {
        let frames = cameras.iter().map(|camera| camera.frames).max().unwrap_or(1);
        let moving = self.moving;
        let sharp = cameras.iter().filter_map(|camera| moving?.sharp_s(camera));
        match (sharp.reduce(f64::max), moving) {
            (Some(exposure), Some(Moving { speed_m_s, distance_m: Some(distance_m), .. })) => (
                exposure * f64::from(frames),
                LightTime::Sharp { frames, speed_m_s, distance_m, units: self.scenario.units() },
            ),
            _ => {
                let longest = cameras.iter().map(|camera| camera.integration_s()).fold(0.0, f64::max);
                (longest, LightTime::LongestIntegration)
            }
        }
    }
}

/// The scenes of all pairs before a camera that counts so much.
fn drawn(of: Vec<(&Study, Bands, Ranges)>, counts_per_radiance: f64, seed: u64) -> Result<Scenes<'_>> {
    let counting = Counting { counts_per_radiance, var_added: Vec::new() };
    let pairs: Vec<(usize, usize)> = of
        .iter()
        .enumerate()
        .flat_map(|(target, (study, ..))| (0..study.alternatives.len()).map(move |other| (target, other)))
        .collect();
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let dimensions = of.first().map_or(0, |(_, _, ranges)| all(ranges).len());
    let mut shifted = || GoldenLattice::new((0..dimensions).map(|_| random.random::<f64>()).collect());
    let lattices: Vec<GoldenLattice> = (0..SHIFTS).map(|_| shifted()).collect();
    let each = (SCENES / (SHIFTS * pairs.len().max(1))).max(4);
    let jobs: Vec<(usize, usize)> =
        (0..SHIFTS).flat_map(|shift| (0..pairs.len()).map(move |pair| (shift, pair))).collect();
    let drawn = parallel::try_map(jobs.len(), |i| {
        let (shift, pair) = jobs[i];
        let (target, other) = pairs[pair];
        let (study, bands, ranges) = &of[target];
        let places = (0..each).map(|index| lattices[shift].point(index * pairs.len() + pair));
        let states: Vec<State> = places.filter_map(|place| scene_at(ranges, &place)).collect();
        let Study { surroundings, unknowns, range, .. } = study;
        let mut solver = NearestSolver::new(bands, surroundings, unknowns.clone(), *range);
        let mut drawn = Vec::with_capacity(states.len());
        for state in states {
            let (own, alternative) = (&study.target.emissivity, &study.alternatives[other].emissivity);
            let distance = solver.with_counting(own, alternative, &state, &counting)?.distance;
            let within_error = distance < error_distance(study, bands, &state, &counting);
            drawn.push(Drawn { shift, distance, within_error, state });
        }
        Ok(drawn)
    })?;
    let drawn: Vec<Drawn> = drawn.into_iter().flatten().collect();
    demand::computed(Thing::NearestSearches, drawn.len() as u64);
    Ok(Scenes { of, counts_per_radiance, drawn })
}

/// The most pixels that count together before any of the cameras.
fn near_pixels<'s>(studies: impl Iterator<Item = &'s Study>) -> f64 {
    let pixels = studies.filter_map(|study| study.pixels_of_object(study.scenario.target.distance_m));
    pixels.fold(1.0, f64::max)
}

/// By how much errors of both emissivities move the spectra apart, in units of shot noise.
fn error_distance(study: &Study, bands: &Bands, state: &State, counting: &Counting) -> f64 {
    let nodes = bands.nodes_cm1();
    let mut contrast = vec![0.0; nodes.len()];
    planck::photon_radiance_into(nodes, state.temperature_k, &mut contrast);
    for (k, factor) in state.lighting.iter().enumerate() {
        let light = study.surroundings.object_signal(k, state);
        contrast.iter_mut().zip(light).for_each(|(contrast, light)| *contrast -= factor * light);
    }
    let contrast = bands.weigh(&contrast);
    let signal = bands.weigh(&study.surroundings.signal(&study.target.emissivity, state));
    let squares = contrast.iter().zip(signal).map(|(c, s)| if s > 0.0 { c * c / s } else { 0.0 });
    EMISSIVITY_ERROR * (0.5 * counting.counts_per_radiance * squares.sum::<f64>()).sqrt()
}

/// The share of scenes of a kind with its standard error, from the spread between the shifts.
fn share(drawn: &[Drawn], of: impl Fn(&Drawn) -> bool) -> (f64, f64) {
    let shares: Vec<f64> = (0..SHIFTS)
        .filter_map(|shift| {
            let mine = || drawn.iter().filter(|scene| scene.shift == shift);
            let count = mine().count();
            (count > 0).then(|| mine().filter(|scene| of(scene)).count() as f64 / count as f64)
        })
        .collect();
    let n = shares.len() as f64;
    if n == 0.0 {
        return (0.0, 0.0);
    }
    let mean = shares.iter().sum::<f64>() / n;
    let spread: f64 = shares.iter().map(|share| (share - mean) * (share - mean)).sum();
    (mean, if n > 1.0 { (spread / (n * (n - 1.0))).sqrt() } else { 0.0 })
}

/// How near to equilibrium the scenes are in which no camera could do it; without surroundings there is none.
fn neighbourhood(drawn: &[Drawn], told: impl Fn(&Drawn) -> bool) -> Option<Neighbourhood> {
    if drawn.iter().all(|scene| scene.state.lighting.iter().all(|lighting| *lighting == 0.0)) {
        return None;
    }
    let bad = || drawn.iter().filter(|scene| !told(scene)).map(|scene| &scene.state);
    let most = |mut values: Vec<f64>| {
        values.sort_by(f64::total_cmp);
        values.get((MOST * (values.len().max(1) - 1) as f64).ceil() as usize).copied()
    };
    let differences = bad().map(|state| {
        let total: f64 = state.lighting.iter().sum();
        let weighed: f64 = state.lighting.iter().zip(&state.environment_k).map(|(v, t)| v * t).sum();
        (state.temperature_k - if total > 0.0 { weighed / total } else { 0.0 }).abs()
    });
    let temperature_difference_k = most(differences.collect())?;
    let unlit = most(bad().map(|state| 1.0 - state.lighting.iter().sum::<f64>()).collect())?;
    Some(Neighbourhood { temperature_difference_k, unlit: unlit.max(0.0) })
}
