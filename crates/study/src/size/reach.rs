//! Statistical distances of one camera after another against one alternative, as a quantity is solved for.
//!
//! From trial to trial the nearest state is followed: it moves little, and a refinement takes a fraction of a search.
//! What was solved for is searched anew at the end; where another state is nearer there, that one is followed.

use super::super::{Study, Surface};
use hadar::demand::{self, Thing};
use hadar::error::Result;
use hadar::fisher::Counting;
use hadar::identifiability::local::LocalSolver;
use hadar::identifiability::nearest::NearestSolver;
use hadar::policy::{CameraTask, Quantity, Solution, Trial};
use hadar::scene::State;
use hadar::spectrum::Bands;
use hadar_scenario::DistanceKind;

/// Relative difference between a followed and a fully searched nearest distance that is rounding.
const SAME: f64 = 1e-10;
/// How often another state may turn out nearer before every trial is searched in full.
const TURNS: usize = 4;

/// The solvers of one set of bands.
pub(crate) struct Solvers<'a> {
    nearest: NearestSolver<'a>,
    local: LocalSolver<'a>,
}

impl<'a> Solvers<'a> {
    pub(crate) fn new(study: &'a Study, bands: &'a Bands) -> Self {
        let unknowns = study.decisive_unknowns();
        Self {
            nearest: NearestSolver::new(bands, &study.surroundings, study.unknowns.clone(), study.range)
                .proving(study.tolerance()),
            local: LocalSolver::new(bands, &study.surroundings, unknowns),
        }
    }

    /// The distance that decides, between a target and an alternative of such emissivities, and the nearest state. It is
    /// searched in full without a state to start from.
    pub(crate) fn reached(
        &mut self,
        study: &Study,
        [target, other]: [&[f64]; 2],
        counting: &Counting,
        start: Option<&State>,
    ) -> Result<(f64, Option<State>)> {
        if study.scenario.requirement.by != DistanceKind::Nearest {
            let unknowns = study.decisive_unknowns();
            study.book_local(&unknowns, 1);
            let local = self.local.with_counting(target, other, &study.state, counting)?;
            return Ok((local.distance, None));
        }
        let nearest = match start {
            Some(start) => {
                demand::computed(Thing::RefinedSearches, 1);
                self.nearest.refine_with_counting(target, other, &study.state, counting, start)?
            }
            None => {
                demand::computed(Thing::NearestSearches, 1);
                self.nearest.with_counting(target, other, &study.state, counting)?
            }
        };
        Ok((nearest.distance, Some(nearest.state)))
    }
}

/// Evaluates trials by the distance that decides.
pub(crate) struct Reach<'a> {
    study: &'a Study,
    alternative: &'a Surface,
    /// Of the scenario's own distance, where the bands are always the same.
    own: Solvers<'a>,
    /// Of another distance, the last one: bands as they are received from there, and what the path emits.
    elsewhere: Option<(Option<f64>, Bands, Vec<f64>)>,
    state: Option<State>,
}

impl<'a> Reach<'a> {
    pub(crate) fn new(study: &'a Study, alternative: &'a Surface) -> Self {
        let own = Solvers::new(study, &study.bands);
        Self { study, alternative, own, elsewhere: None, state: None }
    }

    /// The statistical distance of a trial, its nearest state followed from the trial before.
    pub(crate) fn followed(&mut self, trial: &Trial) -> Result<f64> {
        self.evaluate(trial, true)
    }

    /// The statistical distance of a trial, its nearest state searched in full.
    pub(crate) fn anew(&mut self, trial: &Trial) -> Result<f64> {
        self.evaluate(trial, false)
    }

    fn evaluate(&mut self, trial: &Trial, follow: bool) -> Result<f64> {
        let study = self.study;
        let start = self.state.take().filter(|_| follow);
        let start = start.as_ref();
        let pair = [study.target.emissivity.as_slice(), self.alternative.emissivity.as_slice()];
        let (distance, state) = if trial.distance_m == study.scenario.target.distance_m {
            let counting = study.counting_of(&trial.camera);
            self.own.reached(study, pair, &counting, start)?
        } else {
            let there = match self.elsewhere.take().filter(|(from, ..)| *from == trial.distance_m) {
                Some(there) => there,
                None => {
                    let (bands, air) = study.received(Some(&trial.camera), trial.distance_m)?;
                    (trial.distance_m, bands, air)
                }
            };
            let (distance_m, bands, air) = self.elsewhere.insert(there);
            let counting =
                trial.camera.counting(bands, &study.view_through(&trial.camera, bands, *distance_m, air));
            Solvers::new(study, bands).reached(study, pair, &counting, start)?
        };
        self.state = state;
        Ok(distance)
    }

    /// Solves a task for a quantity; the nearest state at the solution is searched in full.
    pub(crate) fn solve(&mut self, task: &CameraTask<'_>, quantity: Quantity) -> Result<Solution> {
        for _ in 0..TURNS {
            let solution = task.solve(quantity, |trial| self.followed(trial))?;
            let Some(value) = solution.value else { return Ok(solution) };
            // A speed is that of an exposure, which is where the search ended.
            let anew = self.anew(&task.forward(quantity, value))?;
            if anew >= solution.statistical_distance * (1.0 - SAME) {
                return Ok(solution);
            }
            // Another state is nearer at this noise: it is followed from now on.
        }
        task.solve(quantity, |trial| self.anew(trial))
    }
}
