//! Half the separation between the target's state and the nearest state of the alternative.
//!
//! d = min ‖√(N + σ²) − √(N′ + σ²)‖ over the alternative's own free state θ′ (T′, V′, gain′, Tₖ′: those that
//! are unknown, within their physical range). 2√(N + σ²) has unit variance, so d is half the separation in
//! units of the noise, and no test, averaged over the two states, is right more often than Φ(d) (large N).
//!
//! Per band r = (N − N′)/(√(N+σ²) + √(N′+σ²)), with
//! S − S′ = (e − e′)C + e′[B(T) − B(T′)] + (1 − e′)(X − X′) formed from differences that are exact to a few
//! ulp (C contrast, X lighting; see [`crate::scene`]): nothing is lost as the materials become equal.
//! A prior of deviation σ_p on a parameter adds the row (θ′ − θ)/(2σ_p), whose tangent is the local bound's.
//!
//! Proof ([`NearestSolver::proving`], `proof`): for fixed temperatures the cost is jointly convex in everything else, so
//! that branch and bound over the unknown temperatures gives a lower bound, and the nearest state where the descent from the
//! target's own has ended in another valley. The range of an unknown gain is 10⁻⁶ to 10⁶ (|ln G′| ≤ 14).
//!
//! Search, where no proof is asked for or where it does not end: with T′ free a grid of it with the other unknowns fitted at each
//! point; between two points the derivative of the fitted cost along T′ tells of a minimum (`search`). Every minimum is then
//! refined by damped Newton steps within the bounds (`residual`), and so is the target's own state. It can miss the nearest valley.
//!
//! Source: design of the project; Algorithm 1 of the paper is its exact counterpart on a lattice.

mod blackbodies;
mod proof;
mod refine;
mod residual;
mod search;

use self::proof::Memory;
pub use self::proof::Nearer;
pub(super) use self::proof::{Chord, chord};
pub use self::refine::NearestDistance;
use self::refine::refine;
use self::residual::{Comparison, Metric, Target};
use self::search::EmissionTable;
pub use super::space::StateRange;
use crate::error::{Error, Result};
use crate::fisher::{Counting, Nuisance, Unknowns};
use crate::order;
use crate::scene::{State, Surroundings};
use crate::simd::LANES;
use crate::spectrum::Bands;

/// Bands that are enough for a first look.
const FEW_BANDS: usize = 64;
/// Relative separation up to which two states are one as far as a fit that starts from either is concerned.
const SAME_STATE: f64 = 1e-4;

/// Distances that no scene has: what is compared sends less than numbers hold.
const BEYOND: f64 = 1e100;
/// Distances below which nothing is proved: products of their squares with the target's counts come to an end of numbers.
const SMALLEST: f64 = 1e-75;

/// Boxes in which it is tried to prove that nothing is nearer before a search, and after one.
const FIRST_BOXES: u64 = 60;
const MOST_BOXES: u64 = 6_000;
/// Share of the terms that a separation is made of below which a distance is nothing but rounding: fourteen digits cancel.
const NOTHING_OF_TERMS: f64 = 1e-14;
/// The same of the separation of the target from nothing: between that and all of it a distance may be far from nothing and yet be the
/// rounding of terms far larger than the target is bright, which its error then says.
const NEXT_TO_NOTHING: f64 = 1e-12;
/// How many times a distance its error is estimated to be where it is nothing but rounding: deep in the Wien tail
/// the estimate is hundreds of times too large, and a distance called 0 is a claim.
const NOTHING_BUT_ROUNDING: f64 = 1e3;

/// Whether a proof may leave priors out, which makes its bounds too low to come near the distance: beside an unknown gain, and of
/// surroundings' temperatures beside an unknown lighting, they are not convex in what it is over.
#[must_use]
pub fn leaves_priors_out(unknowns: &Unknowns) -> bool {
    let unknown = |nuisance| unknowns.contains(nuisance);
    let of_light = unknown(Nuisance::EnvironmentTemperature) && unknown(Nuisance::Lighting);
    unknowns.has_priors() && (unknown(Nuisance::Gain) || of_light)
}

/// Finds nearest states in fixed bands and surroundings.
#[derive(Debug, Clone)]
pub struct NearestSolver<'a> {
    comparison: Comparison<'a>,
    /// What the searches before have computed that the next one can use.
    table: Option<EmissionTable>,
    /// How many neighbouring bands a proof counts as one for a first look, where there are many.
    merging: Option<usize>,
    memory: Memory,
    /// To what share of its distance a nearest state is proved, if at all.
    tolerance: Option<f64>,
}

/// What searches have computed of their bands that other searches in the same bands can use, whatever they look for there: it makes them
/// quicker, and changes nothing that they find.
#[derive(Debug, Default)]
pub struct Searched(Option<EmissionTable>);

impl<'a> NearestSolver<'a> {
    /// A solver for one set of bands, surroundings, unknowns and ranges of the alternative's state.
    #[must_use]
    pub fn new(
        bands: &'a Bands,
        surroundings: &'a Surroundings,
        unknowns: Unknowns,
        range: StateRange,
    ) -> Self {
        Self {
            comparison: Comparison::new(bands, surroundings, unknowns, range),
            table: None,
            merging: Some(in_chunks(bands.len() / FEW_BANDS)).filter(|count| *count > 1),
            memory: Memory::default(),
            tolerance: None,
        }
    }

    /// The same solver that also proves how near the nearest state can be at most, to this share of the distance.
    #[must_use]
    pub fn proving(self, relative_tolerance: f64) -> Self {
        Self { tolerance: Some(relative_tolerance), ..self }
    }

    /// The same solver with what others in the same bands have computed.
    #[must_use]
    pub fn knowing(self, searched: Searched) -> Self {
        Self { table: searched.0, ..self }
    }

    /// What its searches have computed, for others in the same bands.
    #[must_use]
    pub fn searched(self) -> Searched {
        Searched(self.table)
    }

    /// Nearest distance per √photon in the limit of shot noise. Priors count as among `photons` photons.
    ///
    /// # Errors
    /// A scene without photons.
    pub fn per_photon(
        &mut self,
        emissivity: &[f64],
        alternative: &[f64],
        state: &State,
        photons: f64,
    ) -> Result<NearestDistance> {
        self.search(emissivity, alternative, state, Metric::PerPhoton { photons }, None, 0.0)
    }

    /// Nearest statistical distance d with the camera's own noise.
    ///
    /// # Errors
    /// A scene without photons.
    pub fn with_counting(
        &mut self,
        emissivity: &[f64],
        alternative: &[f64],
        state: &State,
        counting: &Counting,
    ) -> Result<NearestDistance> {
        self.search(emissivity, alternative, state, Metric::Counting(counting), None, 0.0)
    }

    /// As [`NearestSolver::with_counting`], but only refined from a state known to be near the answer.
    ///
    /// # Errors
    /// A scene without photons.
    pub fn refine_with_counting(
        &mut self,
        emissivity: &[f64],
        alternative: &[f64],
        state: &State,
        counting: &Counting,
        start: &State,
    ) -> Result<NearestDistance> {
        self.search(emissivity, alternative, state, Metric::Counting(counting), Some(start), 0.0)
    }

    /// Whether any state of the alternative is nearer than `limit`, with the camera's own noise: the search
    /// ends at the first one, and where there is none with a proof, which a minimum that is `known` makes quicker where it is
    /// hardly farther.
    ///
    /// # Errors
    /// A scene without photons.
    pub fn nearer_than(
        &mut self,
        emissivity: &[f64],
        alternative: &[f64],
        state: &State,
        counting: &Counting,
        limit: f64,
        known: Option<&NearestDistance>,
    ) -> Result<Nearer> {
        let metric = Metric::Counting(counting);
        let target = self.comparison.aim(emissivity, alternative, state, metric)?;
        let first = self.proved_nearer(&target, limit, known, FIRST_BOXES);
        if first != Nearer::Undecided {
            return Ok(first);
        }
        let tolerance = self.tolerance.take();
        let found = self.search(emissivity, alternative, state, metric, None, limit);
        self.tolerance = tolerance;
        let found = found?;
        if found.distance < limit {
            return Ok(Nearer::Somewhere);
        }
        let last = self.proved_nearer(&target, limit, Some(&found), MOST_BOXES);
        if let (Nearer::Undecided, Some(mut without)) = (last, self.without_priors()) {
            let all = without.nearer_than(emissivity, alternative, state, counting, limit, None)?;
            return Ok(if all == Nearer::Nowhere { all } else { last });
        }
        Ok(last)
    }

    /// The same solver with nothing known beforehand, where anything is: then no state is farther, so that its bounds hold.
    fn without_priors(&self) -> Option<Self> {
        let unknowns = &self.comparison.space.unknowns;
        let mut solver = unknowns.has_priors().then(|| self.clone())?;
        solver.comparison.space.unknowns = unknowns.without_priors();
        solver.table = None;
        Some(solver)
    }

    fn proved_nearer(
        &mut self,
        target: &Target<'_>,
        limit: f64,
        known: Option<&NearestDistance>,
        boxes: u64,
    ) -> Nearer {
        let own = self.comparison.space.within_range(target.state);
        let best = known.map_or(&own, |known| &known.state);
        let (relative_error, _) = self.comparison.rounding_at(target, best, limit);
        let with = (self.merging, &mut self.memory);
        // That none is nearer must be so whatever rounding has added to the distance about which it is proved.
        let reach = limit / (1.0 - relative_error.min(0.5));
        let found = proof::nearer_than(&mut self.comparison, with, target, [limit, reach], known, boxes);
        let is_sure = relative_error <= 0.5 && limit >= SMALLEST;
        if found == Nearer::Nowhere && !is_sure { Nearer::Undecided } else { found }
    }

    /// Downhill from the target's own state to a minimum, or to the first state that is nearer than `limit`. Other minima are not
    /// seen: that it finds none nearer proves nothing.
    ///
    /// # Errors
    /// A scene without photons.
    pub fn descend(
        &mut self,
        emissivity: &[f64],
        alternative: &[f64],
        state: &State,
        counting: &Counting,
        limit: f64,
    ) -> Result<NearestDistance> {
        self.search(emissivity, alternative, state, Metric::Counting(counting), Some(state), limit)
    }

    /// Statistical distance to the alternative in the target's own state (as far as that is within the
    /// alternative's range): an upper bound on the nearest one.
    ///
    /// # Errors
    /// A scene without photons.
    pub fn own_state_distance(
        &mut self,
        emissivity: &[f64],
        alternative: &[f64],
        state: &State,
        counting: &Counting,
    ) -> Result<f64> {
        let target = self.comparison.aim(emissivity, alternative, state, Metric::Counting(counting))?;
        let own = self.comparison.space.within_range(state);
        Ok(self.comparison.cost(&target, &own).sqrt())
    }

    /// The nearest state, or the first one found that is nearer than `enough`.
    fn search(
        &mut self,
        emissivity: &[f64],
        alternative: &[f64],
        state: &State,
        metric: Metric<'_>,
        start: Option<&State>,
        enough: f64,
    ) -> Result<NearestDistance> {
        let target = self.comparison.aim(emissivity, alternative, state, metric)?;
        let own_cost = if enough > 0.0 { self.comparison.cost(&target, state) } else { f64::INFINITY };
        if own_cost < enough * enough && self.comparison.space.within_range(state) == *state {
            // The target's own state is near enough.
            let at_edge = self.comparison.space.edges(state);
            let (distance, state) = (own_cost.sqrt(), state.clone());
            return Ok(NearestDistance {
                distance,
                lower: 0.0,
                relative_error: 0.0,
                state,
                at_edge,
                iterations: 0,
                converged: false,
            });
        }
        let mut best: Option<NearestDistance> = None;
        let tolerance = self.tolerance.filter(|_| start.is_none());
        let starts = match (start, tolerance) {
            (Some(start), _) => vec![self.comparison.space.free_of(start, state)],
            // A proof finds other valleys by itself.
            (None, Some(_)) => {
                let downhill = self.comparison.downhill(&mut self.table, &target);
                vec![downhill.unwrap_or_else(|| state.clone())]
            }
            (None, None) => self.comparison.starts(&mut self.table, &target, 0.0),
        };
        if self.descend_from(&target, starts, &mut best, enough) {
            return best.ok_or_else(nothing_in_range);
        }
        if let Some(tolerance) = tolerance {
            self.prove(&target, &mut best, tolerance);
            if best.as_ref().is_none_or(|best| !best.is_proved_to(tolerance)) {
                // Where it does not end, the search may know of one.
                let before = best.as_ref().map_or(f64::INFINITY, |best| best.distance);
                let mut starts = self.comparison.starts(&mut self.table, &target, 0.0);
                starts.push(state.clone());
                self.descend_from(&target, starts, &mut best, enough);
                if best.as_ref().is_some_and(|best| best.distance < before) {
                    self.prove(&target, &mut best, tolerance);
                }
                if let (Some(best), Some(mut without)) = (&mut best, self.without_priors()) {
                    // What it finds tells whether its bound could be of use.
                    without.tolerance = None;
                    let ask =
                        |solver: &mut Self| solver.search(emissivity, alternative, state, metric, None, 0.0);
                    if ask(&mut without)?.distance > best.lower {
                        without.tolerance = Some(tolerance);
                        best.lower = best.lower.max(ask(&mut without)?.lower).min(best.distance);
                    }
                }
            }
        }
        match best {
            Some(best) if best.distance.is_nan() || best.distance > BEYOND => {
                let found = "a distance beyond all numbers: the target sends next to nothing, the alternative does not";
                let instead = "take a warmer scene, more lighting, or bands at lower wavenumbers";
                Err(Error::malformed(found, instead))
            }
            Some(mut best) => {
                if best.distance > 0.0 {
                    let (relative_error, terms) =
                        self.comparison.rounding_at(&target, &best.state, best.distance);
                    best.relative_error = relative_error;
                    if self.comparison.space.parameters.is_empty() {
                        // There is no other state.
                        best.lower = best.distance;
                    }
                    // No bound is nearer to the distance than this is known.
                    let surely = best.lower.min(best.distance * (1.0 - relative_error));
                    best.lower = if surely > 0.0 && best.distance >= SMALLEST { surely } else { 0.0 };
                    let is_rounding =
                        best.distance <= NOTHING_OF_TERMS * terms || relative_error > NOTHING_BUT_ROUNDING;
                    let own = || self.comparison.against_nothing(&target);
                    let is_nothing = || !(NEXT_TO_NOTHING * own()..=own()).contains(&best.distance);
                    if terms.is_finite() && is_rounding && is_nothing() {
                        // Nothing but rounding is left.
                        (best.distance, best.lower, best.relative_error) = (0.0, 0.0, 0.0);
                    }
                }
                Ok(best)
            }
            None => Err(nothing_in_range()),
        }
    }

    /// Downhill from every start to the best of all, with the iterations of all; whether that ended early, nearer than `enough`.
    fn descend_from(
        &mut self,
        target: &Target<'_>,
        starts: Vec<State>,
        best: &mut Option<NearestDistance>,
        enough: f64,
    ) -> bool {
        let mut iterations = best.as_ref().map_or(0, |best| best.iterations);
        for start in starts {
            let candidate = refine(&mut self.comparison, target, start, best.as_ref(), enough);
            iterations += candidate.iterations;
            let found = candidate.distance < enough;
            // Nor is what is no number in the way of what comes later.
            if best.as_ref().is_none_or(|best| candidate.distance < best.distance || best.distance.is_nan()) {
                *best = Some(candidate);
            }
            if let Some(best) = best {
                best.iterations = iterations;
            }
            if found {
                return true;
            }
        }
        false
    }

    /// Proves the best state, or finds a better one.
    fn prove(&mut self, target: &Target<'_>, best: &mut Option<NearestDistance>, tolerance: f64) {
        if let Some(known) = best.take_if(|best| best.distance.is_finite()) {
            let with = (self.merging, &mut self.memory);
            *best = Some(proof::prove(&mut self.comparison, with, target, known, tolerance));
        }
    }

    /// States at minima of the distance, nearest first, that lie no more than `reach` beyond the least one.
    ///
    /// # Errors
    /// A scene without photons.
    pub fn minima_with_counting(
        &mut self,
        emissivity: &[f64],
        alternative: &[f64],
        state: &State,
        counting: &Counting,
        reach: f64,
    ) -> Result<Vec<NearestDistance>> {
        let target = self.comparison.aim(emissivity, alternative, state, Metric::Counting(counting))?;
        let starts = self.comparison.starts(&mut self.table, &target, reach);
        let mut minima: Vec<NearestDistance> =
            starts.into_iter().map(|start| refine(&mut self.comparison, &target, start, None, 0.0)).collect();
        order::ascending(&mut minima, |a| a.distance);
        let farthest = minima.first().map_or(0.0, |least| least.distance + reach);
        let mut distinct: Vec<NearestDistance> = Vec::new();
        for minimum in minima.into_iter().filter(|minimum| minimum.distance <= farthest) {
            if distinct
                .iter()
                .all(|known| self.comparison.space.separation(&known.state, &minimum.state) >= SAME_STATE)
            {
                distinct.push(minimum);
            }
        }
        Ok(distinct)
    }
}

/// No more than that, in whole chunks where there is one.
fn in_chunks(count: usize) -> usize {
    if count < LANES { count } else { count - count % LANES }
}

fn nothing_in_range() -> Error {
    Error::malformed("the alternative has no state in its range", "widen the range")
}
