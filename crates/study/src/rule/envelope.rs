//! An envelope of scenes before one camera: which scene is the worst, against which alternative.
//!
//! Temperature, lighting and surroundings are searched by [`policy::envelope`](hadar::policy::envelope) for each
//! material of the target and each alternative. Distance and added variance are not searched, since the information of a
//! band is monotone in both. With κ counts per radiance, S the signal and v the added variance,
//!
//! √(κS + v) − √(κS′ + v) = κ(S − S′)/(√(κS + v) + √(κS′ + v)) = (S − S′)/(√(S/κ + v/κ²) + √(S′/κ + v/κ²))
//!
//! grows with κ and falls with v, band by band, for every pair of states; so does its least sum of squares.
//!
//! * Distance z: étendue πA/(4F² + (f/z)²) grows with z, by the share (f/2Fz)² in all; the share of the pixel that
//!   the target fills and the transmittance of the path fall, the light of the path and from behind the
//!   target grow. Étendue × fill rises, then falls: it is least at one of the ends. Without air the one end has the smaller κ
//!   and the larger v in all bands, or both ends are searched. With air, bands of one node count no less from anywhere than
//!   with the far transmittances and the least κ; where the added variance is largest from afar too, the far end stands for all
//!   ([`Sighted::share_of_far`]). Elsewhere distances between are searched, and stretch by stretch it is proved that none is
//!   worse ([`lower_bound_along`](hadar::policy::envelope::lower_bound_along), `between`): air that changes a spectrum within
//!   a band (bands of several nodes) changes S − S′ too, and any distance may be the worst.
//! * Added variance that depends on the scene (bunched photons, an interferometer, light from behind the target) is
//!   taken in the brightest scene of the envelope, where it is largest.
//!
//! A worst case so found is attained where the added variance does not depend on the scene, and else a lower bound.

use crate::sight::Along;
use crate::{Study, Surface};
use hadar::error::{Error, Result};
use hadar::fisher::Counting;
use hadar::identifiability::nearest::NearestSolver;
use hadar::instrument::Camera;
use hadar::lattice_points::GoldenLattice;
use hadar::parallel;
use hadar::policy::envelope::{EnvelopeScene, Ranges};
use hadar::scene::State;
use hadar_scenario::Envelope;

/// Relative difference of counts that is rounding.
const SAME: f64 = 1e-12;
/// Share of a distance that may be lost by taking the least counts per radiance for those of the far end.
const LOST: f64 = 5e-6;
/// Dimensions up to which the corners are among the scenes of an estimate, and scenes beside them.
const CORNERS: usize = 6;
pub(super) const SCENES: usize = 32;

/// One camera, one material of the target, one distance: all scenes between, with what counts in each.
#[derive(Debug, Clone)]
pub(crate) struct Sighted {
    pub(crate) study: Study,
    pub(crate) counting: Counting,
    pub(crate) ranges: Ranges,
}

/// A pair of materials before a camera, and a scene of the envelope in which they are near.
#[derive(Debug, Clone)]
pub(crate) struct Estimate {
    /// Index of what is sighted, and of the alternative in its study.
    pub(crate) sighted: usize,
    pub(crate) alternative: usize,
    /// Statistical distance in that scene.
    pub(crate) distance: f64,
    pub(crate) state: State,
    pub(crate) nearest: State,
}

impl Study {
    /// The same before another camera, from a distance.
    pub(super) fn before(&self, camera: &Camera, distance_m: Option<f64>) -> Result<Self> {
        let mut study = self.clone();
        study.scenario.target.distance_m = distance_m;
        (study.bands, study.air) = study.received(Some(camera), distance_m)?;
        study.camera = Some(camera.clone());
        Ok(study)
    }
}

impl Sighted {
    /// A study with its camera, over the ranges of an envelope that is filled in.
    pub(crate) fn new(study: Study, envelope: &Envelope) -> Result<Self> {
        let ranges = study.ranges(envelope)?;
        let brightest = Study { state: brightest(&ranges), ..study.clone() };
        let counting =
            brightest.counting().unwrap_or(Counting { counts_per_radiance: 0.0, var_added: vec![] });
        Ok(Self { study, counting, ranges })
    }

    /// The same before another camera, from a distance.
    pub(crate) fn before(
        &self,
        camera: &Camera,
        distance_m: Option<f64>,
        envelope: &Envelope,
    ) -> Result<Self> {
        Self::new(self.study.before(camera, distance_m)?, envelope)
    }

    /// The pair with an alternative, for a search.
    pub(crate) fn scene<'a>(&'a self, alternative: &'a Surface) -> EnvelopeScene<'a> {
        EnvelopeScene {
            bands: &self.study.bands,
            surroundings: &self.study.surroundings,
            emissivity: &self.study.target.emissivity,
            alternative: &alternative.emissivity,
            counting: &self.counting,
            unknowns: &self.study.unknowns,
            range: self.study.range,
        }
    }

    /// Whether every band counts less here than in `other`, amid more noise: then every distance is smaller.
    pub(crate) fn is_worse_than(&self, other: &Self) -> bool {
        let mut bands = self.counts().into_iter().zip(other.counts()).enumerate();
        bands.all(|(w, (here, there))| {
            here <= there * (1.0 + SAME)
                && self.counting.var_added(w) >= other.counting.var_added(w) * (1.0 - SAME)
        })
    }

    /// What is left of the counts per radiance of `far` from anywhere between the ends, if all else is worst from afar: no distance
    /// between has less than this share of the far one's statistical distance. `None` where that is not so, or too little.
    pub(crate) fn share_of_far(&self, far: &Self, ends_m: [f64; 2]) -> Result<Option<f64>> {
        let along = self.along(ends_m)?;
        let no_more = |w: usize| along.counting.var_added(w) <= far.counting.var_added(w) * (1.0 + SAME);
        let share = along.counting.counts_per_radiance / far.counting.counts_per_radiance;
        let stands = !self.study.air_reshapes_bands() && (0..far.study.bands.len()).all(no_more);
        Ok((stands && share >= 1.0 - LOST).then_some(share.min(1.0)))
    }

    /// What the camera sees along a stretch of distances, in the brightest scene.
    pub(crate) fn along(&self, ends_m: [f64; 2]) -> Result<Along> {
        let study = Study { state: brightest(&self.ranges), ..self.study.clone() };
        let camera = study.camera.clone().ok_or_else(|| {
            Error::malformed("a rule without a camera", "name one, as in cameras = [\"ideal-pnrd\"]")
        })?;
        study.along(&camera, ends_m)
    }

    /// Whether counts or added variance of any band differ by more than `share`.
    pub(crate) fn differs_from(&self, other: &Self, share: f64) -> bool {
        let apart = |a: f64, b: f64| (a - b).abs() > share * a.abs().max(b.abs());
        let mut bands = self.counts().into_iter().zip(other.counts()).enumerate();
        bands.any(|(w, (a, b))| apart(a, b) || apart(self.counting.var_added(w), other.counting.var_added(w)))
    }

    /// Counts of a flat spectrum in each band.
    fn counts(&self) -> Vec<f64> {
        let kappa = self.counting.counts_per_radiance;
        self.study.bands.widths_cm1().into_iter().map(|width| kappa * width).collect()
    }

    /// The nearest of a few scenes for every alternative: of those that are `known` of the same materials, perhaps from elsewhere, and of the
    /// corners with so many `between` them, if any are asked for.
    pub(crate) fn estimates(
        &self,
        sighted: usize,
        known: &[Estimate],
        between: Option<usize>,
    ) -> Result<(Vec<Estimate>, u64)> {
        let corners = between.map(|scenes| scattered(&self.ranges, scenes)).unwrap_or_default();
        let estimate = |alternative: usize| {
            let surface = &self.study.alternatives[alternative];
            let mut solver = self.solver();
            let mut best: Option<Estimate> = None;
            let mut places = corners.clone();
            for pair in known.iter().filter(|pair| pair.alternative == alternative) {
                if !places.contains(&pair.state) {
                    places.push(pair.state.clone());
                }
            }
            if places.is_empty() {
                places = scattered(&self.ranges, SCENES);
            }
            for state in &places {
                let found = solver.with_counting(
                    &self.study.target.emissivity,
                    &surface.emissivity,
                    state,
                    &self.counting,
                )?;
                if best.as_ref().is_none_or(|best| found.distance < best.distance) {
                    let (distance, nearest, state) = (found.distance, found.state, state.clone());
                    best = Some(Estimate { sighted, alternative, distance, state, nearest });
                }
            }
            Ok((best, places.len() as u64))
        };
        let found: Vec<(Option<Estimate>, u64)> = parallel::try_map(self.study.alternatives.len(), estimate)?;
        let searched = found.iter().map(|(_, searched)| searched).sum();
        Ok((found.into_iter().filter_map(|(best, _)| best).collect(), searched))
    }

    pub(crate) fn solver(&self) -> NearestSolver<'_> {
        let Study { bands, surroundings, unknowns, range, .. } = &self.study;
        NearestSolver::new(bands, surroundings, unknowns.clone(), *range)
    }
}

impl Study {
    /// The ranges of an envelope that is filled in.
    ///
    /// # Errors
    /// Ranges that leave no scene.
    pub(crate) fn ranges(&self, envelope: &Envelope) -> Result<Ranges> {
        let state = &self.state;
        let points = |values: &[f64]| values.iter().map(|value| [*value; 2]).collect::<Vec<_>>();
        Ranges::new(
            envelope.temperature_k.unwrap_or([state.temperature_k; 2]),
            envelope.lighting.clone().unwrap_or_else(|| points(&state.lighting)),
            envelope.surroundings_k.clone().unwrap_or_else(|| points(&state.environment_k)),
        )
        .map_err(|error| error.at(self.scenario.place("envelope")))
    }
}

/// The scene in which every band is brightest: all at their highest temperatures, the lighting of each object
/// as much as it may be (together perhaps more than 1, so that it bounds every scene).
pub(crate) fn brightest(ranges: &Ranges) -> State {
    State {
        temperature_k: ranges.temperature_k()[1],
        lighting: ranges.lighting().iter().map(|range| range[1]).collect(),
        gain: 1.0,
        environment_k: ranges.environment_k().iter().map(|range| range[1]).collect(),
    }
}

/// The scene in which every band is darkest.
pub(crate) fn darkest(ranges: &Ranges) -> State {
    State {
        temperature_k: ranges.temperature_k()[0],
        lighting: ranges.lighting().iter().map(|range| range[0]).collect(),
        gain: 1.0,
        environment_k: ranges.environment_k().iter().map(|range| range[0]).collect(),
    }
}

/// Share of the hemisphere above the target that no object fills, at most.
pub(crate) fn unlit(ranges: &Ranges) -> f64 {
    1.0 - ranges.lighting().iter().map(|range| range[0]).sum::<f64>()
}

/// Every range of an envelope: the target's temperature, then temperature and lighting of each object.
pub(crate) fn all(ranges: &Ranges) -> Vec<[f64; 2]> {
    let objects = ranges.environment_k().iter().zip(ranges.lighting()).flat_map(|(t, v)| [*t, *v]);
    std::iter::once(ranges.temperature_k()).chain(objects).collect()
}

/// The scene at a point of the unit cube, in the order of [`all`]; `None` where the lighting adds up to more than 1.
pub(crate) fn scene_at(ranges: &Ranges, place: &[f64]) -> Option<State> {
    let within = |([low, high], x): ([f64; 2], &f64)| (low + (high - low) * x).clamp(low, high);
    let values: Vec<f64> = all(ranges).into_iter().zip(place).map(within).collect();
    let (temperature_k, objects) = values.split_first()?;
    let objects = objects.chunks_exact(2);
    let lighting: Vec<f64> = objects.clone().map(|object| object[1]).collect();
    let environment_k = objects.map(|object| object[0]).collect();
    let state = State { temperature_k: *temperature_k, lighting, gain: 1.0, environment_k };
    (state.lighting.iter().sum::<f64>() <= 1.0 + SAME).then_some(state)
}

/// Corners and so many scenes between them.
fn scattered(ranges: &Ranges, scenes: usize) -> Vec<State> {
    places(ranges, scenes).iter().filter_map(|place| scene_at(ranges, place)).collect()
}

/// Places of a few scenes in the unit cube, in the order of [`all`].
pub(crate) fn scattered_places(ranges: &Ranges) -> Vec<Vec<f64>> {
    places(ranges, SCENES)
}

fn places(ranges: &Ranges, scenes: usize) -> Vec<Vec<f64>> {
    let ranges_all = all(ranges);
    let free: Vec<usize> = (0..ranges_all.len()).filter(|&i| ranges_all[i][0] < ranges_all[i][1]).collect();
    let lay = |value: &dyn Fn(usize) -> f64| {
        let mut place = vec![0.0; ranges_all.len()];
        free.iter().enumerate().for_each(|(i, &dimension)| place[dimension] = value(i));
        place
    };
    let corners = 0..if free.len() <= CORNERS { 1usize << free.len() } else { 0 };
    // Where there are too many corners scenes stand for them.
    let scenes = if free.len() > CORNERS { scenes.max(SCENES) } else { scenes };
    let scenes = 0..if free.is_empty() { 0 } else { scenes };
    let lattice = GoldenLattice::new(vec![0.5; free.len()]);
    let places = corners.map(|corner| lay(&|i| ((corner >> i) & 1) as f64)).chain(scenes.map(|index| {
        let point = lattice.point(index);
        lay(&|i| point[i])
    }));
    let mut places: Vec<Vec<f64>> = places.filter(|place| scene_at(ranges, place).is_some()).collect();
    // Where hardly any lighting fits beneath 1, the least of it does.
    if places.is_empty() {
        places.push(lay(&|_| 0.0));
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_stay_within_the_ranges() {
        let ranges =
            Ranges::new([300.0, 310.0], vec![[0.1, 0.9], [0.0, 0.5]], vec![[260.0, 280.0]; 2]).unwrap();
        let states = scattered(&ranges, SCENES);
        // Of 2^5 corners those with V = 0.9 + 0.5 are none.
        assert!(states.len() > 24 + 16, "{}", states.len());
        for state in &states {
            assert!((300.0..=310.0).contains(&state.temperature_k));
            assert!(state.lighting.iter().sum::<f64>() <= 1.0);
            assert!(state.environment_k.iter().all(|t| (260.0..=280.0).contains(t)));
        }
        assert_eq!(brightest(&ranges).lighting, [0.9, 0.5]);
        let point = Ranges::new([300.0; 2], vec![[0.5; 2]], vec![[280.0; 2]]).unwrap();
        assert_eq!(scattered(&point, SCENES).len(), 1);
    }
}
