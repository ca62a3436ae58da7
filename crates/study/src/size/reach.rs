//! Statistical distances of one camera after another against one alternative, as a quantity is solved for.
//!
//! From trial to trial the nearest state is followed: it moves little, and a refinement takes a fraction of a search.
//! What was solved for is searched anew at the end; where another state is nearer there, that one is followed. Where what is proved
//! stays behind what was found, more is asked for until what is proved is enough too. The law of few counts takes longer than the
//! distance: it is asked at a solution by the distance, and what comes of it tells by the secant what to ask of the distance.

use super::super::{Study, Surface};
use crate::distances::Statistical;
use hadar::demand::{self, Thing};
use hadar::error::Result;
use hadar::fisher::Counting;
use hadar::identifiability::decision::DecisionLaw;
use hadar::identifiability::local::LocalSolver;
use hadar::identifiability::nearest::{Nearer, NearestSolver};
use hadar::policy::{CameraTask, Quantity, Solution, Trial};
use hadar::scene::State;
use hadar::spectrum::Bands;
use hadar_scenario::DistanceKind;

/// Relative difference between a followed and a fully searched nearest distance that is rounding.
const SAME: f64 = 1e-10;
/// How often another state may turn out nearer, or few counts ask for another distance, before every trial is searched in full.
const TURNS: usize = 8;
/// How often more is asked for until what is proved suffices.
const RAISES: usize = 8;
/// Share by which more is asked for than is required, so that what is put in meets it whatever rounding does.
pub(crate) const SURELY: f64 = 1e-9;

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
        pair: [&[f64]; 2],
        counting: &Counting,
        start: Option<&State>,
    ) -> Result<(f64, Option<State>)> {
        self.found(study, pair, (&study.bands, counting), start).map(|(found, state)| (found.distance, state))
    }

    /// The same with what is proved of it, which is nothing where a state was followed.
    fn found(
        &mut self,
        study: &Study,
        [target, other]: [&[f64]; 2],
        (bands, counting): (&Bands, &Counting),
        start: Option<&State>,
    ) -> Result<(Statistical, Option<State>)> {
        let integrals = |distance: f64| study.integral_error(distance, bands, counting);
        if study.scenario.requirement.by != DistanceKind::Nearest {
            let unknowns = study.decisive_unknowns();
            study.book_local(&unknowns, 1);
            let local = self.local.with_counting(target, other, &study.state, counting)?;
            let distance = local.distance;
            let found = Statistical {
                distance,
                lower: distance,
                relative_error: Some(local.relative_error + integrals(distance)),
            };
            return Ok((found, None));
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
        let lower = study.sure(nearest.distance, nearest.lower);
        let distance = nearest.distance;
        let relative_error = Some(nearest.relative_error + integrals(distance));
        let found = Statistical { distance, lower, relative_error };
        Ok((found, Some(nearest.state)))
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
    /// Whether counts were so few, where a trial was searched in full, that their own law decides.
    few_counts: bool,
}

impl<'a> Reach<'a> {
    pub(crate) fn new(study: &'a Study, alternative: &'a Surface) -> Self {
        let own = Solvers::new(study, &study.bands);
        Self { study, alternative, own, elsewhere: None, state: None, few_counts: false }
    }

    /// The statistical distance of a trial, its nearest state followed from the trial before.
    pub(crate) fn followed(&mut self, trial: &Trial) -> Result<f64> {
        let start = self.state.take();
        let by_law = start.is_none() || self.few_counts;
        self.evaluate(trial, start.as_ref(), by_law).map(|[_, found]| found)
    }

    /// The statistical distance of a trial, as proved and as found, its nearest state searched in full.
    pub(crate) fn anew(&mut self, trial: &Trial) -> Result<[f64; 2]> {
        self.evaluate(trial, None, true)
    }

    fn evaluate(&mut self, trial: &Trial, start: Option<&State>, by_law: bool) -> Result<[f64; 2]> {
        let (study, alternative) = (self.study, self.alternative);
        let (mut state, mut few_counts) = (None, !by_law && self.few_counts);
        let distances = self.with_solvers(trial, |solvers, bands, counting| {
            let pair = [study.target.emissivity.as_slice(), alternative.emissivity.as_slice()];
            let found = solvers.found(study, pair, (bands, counting), start)?;
            let (found, nearest) = match (study.errors_shared(), found) {
                (Some(spec), (found, Some(nearest))) => {
                    let seen = (bands, counting);
                    let solver = &mut solvers.nearest;
                    let with = study.with_shared_errors(solver, pair[1], seen, (found, nearest), spec)?;
                    (with.0, Some(with.1))
                }
                (_, found) => found,
            };
            if !by_law {
                state = nearest;
                return Ok(found.solved_by());
            }
            let decision = study.decision(alternative, (bands, counting), found, nearest.as_ref())?;
            few_counts |= decision.decided_by != DecisionLaw::Gaussian;
            state = nearest;
            Ok(decision.found.solved_by())
        })?;
        (self.state, self.few_counts) = (state, few_counts);
        Ok(distances)
    }

    /// Whether it is proved that a trial reaches what is required; where a state is nearer, or may be, it does not.
    pub(crate) fn is_met(&mut self, trial: &Trial, required: f64) -> Result<bool> {
        let (study, alternative) = (self.study, self.alternative);
        let found = self.with_solvers(trial, |solvers, bands, counting| {
            let by_nearest = study.scenario.requirement.by == DistanceKind::Nearest;
            if !by_nearest || study.errors_shared().is_some() || !study.counts_are_many(bands, counting) {
                return Ok(None);
            }
            demand::computed(Thing::NearestSearches, 1);
            let (own, other) = (&study.target.emissivity, &alternative.emissivity);
            solvers.nearest.nearer_than(own, other, &study.state, counting, required, None).map(Some)
        })?;
        match found {
            Some(found) => Ok(found == Nearer::Nowhere),
            None => Ok(self.anew(trial)?[0] >= required),
        }
    }

    /// Hands the solvers of a trial on, with the bands that they are of, and what is counted in them.
    fn with_solvers<T>(
        &mut self,
        trial: &Trial,
        ask: impl FnOnce(&mut Solvers<'_>, &Bands, &Counting) -> Result<T>,
    ) -> Result<T> {
        let study = self.study;
        if trial.distance_m == study.scenario.target.distance_m {
            let counting = study.counting_of(&trial.camera);
            return ask(&mut self.own, &study.bands, &counting);
        }
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
        ask(&mut Solvers::new(study, bands), bands, &counting)
    }

    /// Solves a task for a quantity; the nearest state at the solution is searched in full. `necessary` is by the states that were found,
    /// the value by what is proved.
    pub(crate) fn solve(&mut self, task: &CameraTask<'_>, quantity: Quantity) -> Result<Solution> {
        let mut required = task.required * (1.0 + SURELY);
        let (found, mut proved) = self.solve_found(&CameraTask { required, ..task.clone() }, quantity)?;
        let Some(necessary) = found.value else { return Ok(found) };
        let mut solution = found.clone();
        for _ in 0..RAISES {
            let Some(value) = solution.value else { break };
            let lower = match proved {
                Some(lower) => lower,
                None => self.anew(&task.forward(quantity, value))?[0],
            };
            if lower >= task.required {
                return Ok(Solution { necessary: Some(necessary), ..solution });
            }
            // More is asked for, by the share that the proof stays behind.
            let raised = required * (task.required / lower) * (1.0 + SURELY);
            if !(raised.is_finite() && raised > required) {
                break;
            }
            required = raised;
            let harder = CameraTask { required, ..task.clone() };
            (solution, proved) = self.solve_found(&harder, quantity)?;
        }
        Ok(found.not_proved())
    }

    /// Solves by the states that are found; with what is proved at the solution, where that was searched in full last.
    fn solve_found(&mut self, task: &CameraTask<'_>, quantity: Quantity) -> Result<(Solution, Option<f64>)> {
        // What is asked of the distance, and what came of the last one, as logarithms over what is required.
        let (mut asked, mut last) = (0.0, None);
        for _ in 0..TURNS {
            let aimed = CameraTask { required: task.required * f64::exp(asked), ..task.clone() };
            let mut solution = aimed.solve(quantity, |trial| {
                let start = self.state.take();
                self.evaluate(trial, start.as_ref(), false).map(|[_, found]| found)
            })?;
            let Some(value) = solution.value else {
                // What the distance does not reach the law of few counts may.
                let by_law = task.solve(quantity, |trial| {
                    let start = self.state.take();
                    self.evaluate(trial, start.as_ref(), true).map(|[_, found]| found)
                })?;
                if by_law.value.is_none() {
                    return Ok((by_law, None));
                }
                break;
            };
            // A speed is that of an exposure, which is where the search ended.
            let [proved, anew] = self.anew(&task.forward(quantity, value))?;
            let found = match self.few_counts {
                true if quantity == Quantity::Frames => break,
                true => (anew / task.required).ln(),
                // Where another state is nearer at this noise, that is followed from now on.
                false if anew >= solution.statistical_distance * (1.0 - SAME) => {
                    return Ok((solution, Some(proved)));
                }
                false => {
                    (asked, last) = (0.0, None);
                    continue;
                }
            };
            if found.abs() <= SAME {
                solution.statistical_distance = anew;
                return Ok((solution, Some(proved)));
            }
            let slope = last.map_or(1.0, |(asked_before, before)| (found - before) / (asked - asked_before));
            last = Some((asked, found));
            asked -= found / if slope > 0.2 { slope } else { 1.0 };
        }
        Ok((task.solve(quantity, |trial| Ok(self.anew(trial)?[1]))?, None))
    }
}
