//! One camera with one lens: the fewest filters and the frames with which it meets.

use super::chosen::{Ranked, Sought};
use super::judged::{Best, Judged, Nearest};
use super::results::{Misses, Why};
use super::wheel::{Scene, Wheel, WheelKind, at_frames};
use crate::{Study, YesNo};
use hadar::demand::{self, Reason, Skipping, Thing};
use hadar::error::{Error, Result};
use hadar::fisher::Counting;
use hadar::identifiability::selection::States;
use hadar::instrument::Camera;
use hadar::scene::State;
use hadar_scenario::FindSpec;

/// Choices that are judged at most for one number of filters and frames, and that `--no-skip` goes through at most.
const MOST_JUDGED: usize = 100;
const MOST_OF_ALL: f64 = 20_000.0;
/// Frames that stand for any number of them.
const FRAMES_WITHOUT_END: u32 = 100_000_000;
/// Relative difference of squares that is rounding.
const SAME: f64 = 1e-9;
/// Share of a square that may be left unexplained, far above rounding.
const FIXED: f64 = 1e-6;

/// Nearest states that any camera met: what was near in some bands may be near in others.
#[derive(Debug, Default)]
pub(super) struct Pool {
    states: Vec<Known>,
}

/// A state of an alternative, and what priors say against it.
#[derive(Debug)]
struct Known {
    /// Places of the scene, of the target's member and of the alternative.
    place: [usize; 3],
    state: State,
    fixed: f64,
}

/// What became of a camera.
pub(super) enum Found {
    /// Choices that meet pair by pair; without such the best of which that is open.
    Sought(Vec<Ranked>),
    Fails(Box<Misses>),
}

impl Found {
    /// What becomes of a camera that was searched at several exposures.
    pub(super) fn of_all(all: Vec<Self>) -> Option<Self> {
        let mut sought = Vec::new();
        let mut best: Option<Box<Misses>> = None;
        for found in all {
            match found {
                Self::Sought(choices) => sought.extend(choices),
                Self::Fails(fails) => {
                    let most = |fails: &Misses| fails.failed.upper.unwrap_or(-1.0);
                    if best.as_ref().is_none_or(|best| most(&fails) > most(best)) {
                        best = Some(fails);
                    }
                }
            }
        }
        if sought.is_empty() { best.map(Self::Fails) } else { Some(Self::Sought(sought)) }
    }
}

impl Wheel<'_> {
    /// The choices that meet, or why none does.
    pub(super) fn search(
        &self,
        spec: &FindSpec,
        pool: &mut Pool,
        (skipping, wants_near): (Skipping, bool),
    ) -> Result<Found> {
        let fails = |why| Ok(Found::Fails(Box::new(Misses { failed: self.failed(why, None), near: None })));
        if self.kind == WheelKind::Nothing {
            let [low, high] = self.candidate.made.spectral_range_cm1;
            return fails(Why::NoFilter { range_um: [1e4 / high, 1e4 / low] });
        }
        let Some(camera) = &self.first().study.camera else { return fails(Why::NoLens) };
        let all: Vec<usize> = (0..self.filters.len()).collect();
        let (least, most) = match self.kind {
            WheelKind::Filters => (1, (spec.filters.at_most as usize).min(all.len())),
            _ => (all.len(), all.len()),
        };
        if let Some(time_s) = self.first().scenario.requirement.time_s {
            let takes_s = at_frames(camera, spec.frames.first().copied().unwrap_or(1)).acquisition_s(least);
            if takes_s > time_s {
                return fails(Why::Time { takes_s });
            }
        }
        if self.blur(camera, least).is_none_or(|blur| blur >= 1.0) {
            return fails(Why::Motion);
        }
        if camera.full_well.is_some_and(|full| self.brightest(camera) > full) {
            return fails(Why::FullWell);
        }
        let mut search = Search {
            wheel: self,
            pool,
            signals: Vec::new(),
            own: Vec::new(),
            skipping,
            wants_near,
            searches: 0,
            of_all: 0.0,
        };
        let found = search.run(spec, (least, most), camera)?;
        demand::computed(Thing::CameraChoices, search.searches);
        Ok(found)
    }
}

/// The search for the best filters of one camera and lens.
struct Search<'w, 'a> {
    wheel: &'w Wheel<'a>,
    pool: &'w mut Pool,
    /// Signals of the target's members in each scene, and of each state of the pool, in all bands.
    own: Vec<Vec<Vec<f64>>>,
    signals: Vec<Vec<f64>>,
    skipping: Skipping,
    wants_near: bool,
    searches: u64,
    /// Choices that are gone through without skipping.
    of_all: f64,
}

impl Search<'_, '_> {
    fn run(&mut self, spec: &FindSpec, (least, most): (usize, usize), camera: &Camera) -> Result<Found> {
        let wheel = self.wheel;
        let required = wheel.first().study.required;
        let all: Vec<usize> = (0..wheel.filters.len()).collect();
        let mut frames: Vec<u32> = spec.frames.clone();
        frames.retain(|frames| wheel.is_in_time(&at_frames(camera, *frames), least));
        let Some(most_frames) = frames.last().copied() else {
            // The fewest frames are in time; a sweep that moves too far was told before.
            return Ok(Found::Fails(Box::new(Misses {
                failed: wheel.failed(Why::Motion, None),
                near: None,
            })));
        };
        if self.skipping == Skipping::On && wheel.kind == WheelKind::Filters {
            // All filters at once: what they do not tell, a few do not.
            let most_told = self.told_by_all(most_frames, &all)?;
            if most_told < required {
                let frames_would_do = self.told_by_all(FRAMES_WITHOUT_END, &all)? >= required;
                let best = if self.wants_near { self.best(most_frames, most, camera)?.0 } else { None };
                let mut failed = wheel.failed(Why::AllFilters { frames_would_do }, best.as_ref());
                failed.upper = Some(most_told);
                let near = best.map(|best| wheel.choice(&best));
                return Ok(Found::Fails(Box::new(Misses { failed, near })));
            }
        }
        let mut met: Vec<Best> = Vec::new();
        let (mut from, mut all_judged, mut tried, mut is_cut) = (least, true, 0, false);
        let (mut nearest, mut open): (Option<Best>, Option<Best>) = (None, None);
        for frames in frames.iter().rev().copied() {
            let camera = at_frames(camera, frames);
            let (mut is_met, mut is_late, first) = (false, false, from);
            for k in first..=most {
                if !wheel.is_in_time(&camera, k) {
                    (is_late, is_cut) = (true, true);
                    break;
                }
                tried = tried.max(k);
                let (best, judged_all) = self.best(frames, k, &camera)?;
                all_judged &= judged_all;
                let Some(best) = best else { continue };
                match best.judged.told {
                    YesNo::Yes => {
                        met.push(best);
                        // Fewer frames take no fewer filters.
                        (from, is_met) = (k, true);
                        break;
                    }
                    told => {
                        let known = if told == YesNo::Undecided { &mut open } else { &mut nearest };
                        if known.as_ref().is_none_or(|known| best.judged.upper > known.judged.upper) {
                            *known = Some(best);
                        }
                    }
                }
            }
            // Fewer frames do no better, but for more filters there is then time.
            if !is_met && !is_late {
                break;
            }
        }
        // What is open is for the main job or the rule to say.
        if met.is_empty() {
            met.extend(open);
        }
        if !met.is_empty() {
            let ranked = met.iter().map(|best| {
                let choice = wheel.choice(best);
                Ranked { sought: Sought::of(&choice), choice }
            });
            return Ok(Found::Sought(ranked.collect()));
        }
        let failed = wheel.failed(
            Why::Distance { filters: tried, frames: most_frames, all_judged, is_cut },
            nearest.as_ref(),
        );
        let near = nearest.map(|best| wheel.choice(&best));
        Ok(Found::Fails(Box::new(Misses { failed, near })))
    }

    /// What all bands at once tell at most, as far as the states that were found show; looked into no further than to below what is
    /// required.
    fn told_by_all(&mut self, frames: u32, all: &[usize]) -> Result<f64> {
        let Some(camera) = &self.wheel.first().study.camera else { return Ok(0.0) };
        let required = self.wheel.first().study.required;
        let states = self.states(&at_frames(camera, frames))?;
        let bound = states.square_of_all().sqrt();
        if bound < required * (1.0 - SAME) {
            demand::spared(Thing::CameraChoices, Reason::Bounded, 1);
            return Ok(bound);
        }
        let judged = self.judge(all, frames, self.nearest_pair(&states, all), required * (1.0 - SAME))?;
        // Of few counts another law decides than the distance.
        Ok(if judged.told == YesNo::No {
            judged.upper.min(bound).min(required * (1.0 - SAME))
        } else {
            f64::INFINITY
        })
    }

    /// The best choice of at most k bands at so many frames, one that is told before one that is not; and whether nothing was left
    /// unjudged that may be better.
    fn best(&mut self, frames: u32, k: usize, camera: &Camera) -> Result<(Option<Best>, bool)> {
        let camera = at_frames(camera, frames);
        if self.wheel.kind == WheelKind::Own {
            let all: Vec<usize> = (0..self.wheel.filters.len()).collect();
            let judged = self.judge(&all, frames, [0; 3], 0.0)?;
            return Ok((Some(Best { chosen: all, judged, frames }), true));
        }
        if self.skipping == Skipping::Off {
            return self.best_of_all(frames, k).map(|best| (best, true));
        }
        let mut without: Vec<Vec<usize>> = Vec::new();
        let mut best: Option<Best> = None;
        let required = self.wheel.first().study.required;
        loop {
            let states = self.states(&camera)?;
            let Some(next) = states.best(k, &without) else { return Ok((best, true)) };
            let known = best.as_ref().map_or(0.0, |best| best.judged.upper);
            let is_met = best.as_ref().is_some_and(|best| best.judged.told == YesNo::Yes);
            // What is left is no better than what meets, or does not meet.
            let is_no_better = is_met && next.square <= known * known * (1.0 + SAME);
            let is_short = next.square < required * required * (1.0 - SAME);
            if is_no_better || (is_short && best.is_some()) {
                let left = count_of(self.wheel.filters.len(), k) - without.len() as f64;
                demand::spared(Thing::CameraChoices, Reason::Bounded, left.max(0.0) as u64);
                return Ok((best, true));
            }
            if without.len() >= MOST_JUDGED {
                return Ok((best, false));
            }
            let first = self.nearest_pair(&states, &next.readings);
            // Below it a choice is no better than the best, or does not meet.
            let goal = if is_met { known } else { known.min(required * (1.0 - SAME)) };
            let judged = self.judge(&next.readings, frames, first, goal)?;
            without.push(next.readings.clone());
            let is_better = best.as_ref().is_none_or(|best| rank(&judged) > rank(&best.judged));
            if is_better && (judged.upper > goal || best.is_none()) {
                best = Some(Best { chosen: next.readings, judged, frames });
            }
        }
    }

    /// The same by going through every choice.
    fn best_of_all(&mut self, frames: u32, k: usize) -> Result<Option<Best>> {
        let n = self.wheel.filters.len();
        let count = count_of(n, k);
        self.of_all += count;
        if self.of_all > MOST_OF_ALL {
            let found = format!(
                "without skipping more than {:.0} choices of up to {k} of {n} filters would be judged",
                self.of_all
            );
            return Err(Error::malformed(
                found,
                "allow fewer filters (find.filters.at_most), or leave --no-skip out",
            ));
        }
        let next: Vec<usize> = match &self.wheel.next {
            Some(next) => next.clone(),
            None => (1..=n).collect(),
        };
        let mut choices = vec![Vec::new()];
        let mut at = 0;
        while let Some(choice) = choices.get(at).cloned() {
            at += 1;
            let from = choice.last().map_or(0, |last: &usize| next[*last].max(last + 1));
            if choice.len() < k {
                choices.extend((from..n).map(|w| choice.iter().copied().chain([w]).collect::<Vec<_>>()));
            }
        }
        let mut best: Option<Best> = None;
        for chosen in choices.into_iter().skip(1) {
            let judged = self.judge(&chosen, frames, [0; 3], 0.0)?;
            if best.as_ref().is_none_or(|best| rank(&judged) > rank(&best.judged)) {
                best = Some(Best { chosen, judged, frames });
            }
        }
        Ok(best)
    }

    /// What some bands tell in every scene, its nearest states added to those that are known; distances of a scene that demands another
    /// one count by their share of what it demands.
    fn judge(&mut self, chosen: &[usize], frames: u32, first: [usize; 3], goal: f64) -> Result<Judged> {
        let mut judged = Judged::nothing();
        let scenes = &self.wheel.scenes;
        let order = (0..scenes.len()).map(|scene| (scene + first[0]) % scenes.len());
        self.searches += 1;
        for scene in order {
            if judged.upper <= goal {
                break;
            }
            let mut study = scenes[scene].study.with_bands_alone(chosen)?;
            if let Some(camera) = study.camera.as_mut() {
                camera.frames = frames;
            }
            let (scale, pair) =
                (self.wheel.scale(scene), if scene == first[0] { [first[1], first[2]] } else { [0, 0] });
            let found = study.judged(pair, goal / scale)?;
            self.keep(scene, &study, &found);
            judged.with_scene(scene, scale, found);
        }
        Ok(judged)
    }

    /// Adds the nearest states of a scene to those that are known.
    fn keep(&mut self, scene: usize, study: &Study, found: &Judged) {
        for Nearest { place: [_, t, a], state, distance, by_many } in &found.states {
            let place = [scene, *t, *a];
            // Where counts are few another law decides, by which squares do not add up.
            let is_known = self.pool.states.iter().any(|known| known.place == place && known.state == *state);
            let Some(counting) = study.counting().filter(|_| *by_many && !is_known) else { continue };
            let own = signal(study, &study.of_target(*t).target.emissivity, &study.state);
            let other = signal(study, &study.alternatives[*a].emissivity, state);
            let square: f64 = squares(&own, &other, &counting).iter().sum();
            // What is not in the squares is what priors say; errors that readings share make the distance less.
            let left = (distance * distance - square).max(0.0);
            let fixed = if study.unknowns.has_priors() { left } else { 0.0 };
            if left == fixed || left <= FIXED * square {
                self.pool.states.push(Known { place, state: state.clone(), fixed });
            }
        }
    }

    /// Squares of all bands against all states that are known.
    fn states(&mut self, camera: &Camera) -> Result<States> {
        let wheel = self.wheel;
        if self.own.is_empty() {
            let of = |scene: &Scene| {
                let targets = scene.study.members[0].iter().flat_map(|members| &members.surfaces);
                targets.map(|target| signal(&scene.study, &target.emissivity, &scene.study.state)).collect()
            };
            self.own = wheel.scenes.iter().map(of).collect();
        }
        while let Some(Known { place: [scene, _, a], state, .. }) = self.pool.states.get(self.signals.len()) {
            let study = &wheel.scenes[*scene].study;
            self.signals.push(signal(study, &study.alternatives[*a].emissivity, state));
        }
        let countings: Vec<Counting> =
            wheel.scenes.iter().map(|scene| scene.study.counting_of(camera)).collect();
        let mut states = States::of(wheel.filters.len());
        if let Some(next) = &wheel.next {
            states = states.with_next(next.clone());
        }
        for (Known { place: [scene, t, _], fixed, .. }, other) in self.pool.states.iter().zip(&self.signals) {
            let Some(own) = self.own[*scene].get(*t) else { continue };
            let scale = wheel.scale(*scene).powi(2);
            let squares: Vec<f64> =
                squares(own, other, &countings[*scene]).iter().map(|square| scale * square).collect();
            states.add(&squares, scale * fixed);
        }
        Ok(states)
    }

    /// The pair of the state that a choice tells least.
    fn nearest_pair(&self, states: &States, chosen: &[usize]) -> [usize; 3] {
        states
            .nearest(chosen)
            .and_then(|place| self.pool.states.get(place))
            .map_or([0; 3], |known| known.place)
    }
}

/// What is better: to be told, then to be told at all, then by how much.
fn rank(judged: &Judged) -> (u8, f64) {
    let told = match judged.told {
        YesNo::Yes => 2,
        YesNo::Undecided => 1,
        YesNo::No => 0,
    };
    (told, judged.upper)
}

/// Σ over the nodes of each band, photons s⁻¹ m⁻² sr⁻¹.
fn signal(study: &Study, emissivity: &[f64], state: &State) -> Vec<f64> {
    study.bands.weigh(&study.surroundings.signal(emissivity, state))
}

/// (√(N + σ²) − √(N′ + σ²))² of every band.
fn squares(own: &[f64], other: &[f64], counting: &Counting) -> Vec<f64> {
    let kappa = counting.counts_per_radiance;
    let square = |(w, (own, other)): (usize, (&f64, &f64))| {
        let (counts, others, var) = (kappa * own, kappa * other, counting.var_added(w));
        let roots = (counts + var).sqrt() + (others + var).sqrt();
        if roots > 0.0 { ((counts - others) / roots).powi(2) } else { 0.0 }
    };
    own.iter().zip(other).enumerate().map(square).collect()
}

/// Choices of up to k of n.
fn count_of(n: usize, k: usize) -> f64 {
    let of = |k: usize| (0..k).map(|i| (n - i) as f64 / (i + 1) as f64).product::<f64>();
    (1..=k.min(n)).map(of).sum()
}
