//! Which camera to take: cameras, lenses, filters and frames that meet a scenario, the best first.
//!
//! A *choice* is a camera of a catalogue with a lens, some filters before it and a number of frames. What it reaches is what
//! [`Study::size`] says of the scenario with that camera, and nothing is called met that was not put to it.
//!
//! The search goes by proofs. More filters and more frames never tell less, so that a camera which all filters at once do not help
//! is left alone; of the filters the best few are found by the states of the alternatives that were nearest so far
//! ([`hadar::identifiability::selection::States`]): no choice tells the target from an alternative better than from each of its states.
//! For every camera, lens and number of frames the fewest filters that meet are found, and of as many those that tell best. Every
//! distance is proved as any other; a choice between what is proved and what was found is *undecided*, and no camera is recommended by it.
//!
//! Cameras that are beaten by none in all that is to be small (price class, time, filters, aperture) are listed, the first by the order
//! that was asked for. A price that is not known is larger than any other.
//!
//! Assumption: the noises of two readings have nothing in common (else choices are judged one by one up to a number, and what was not
//! judged is said).

mod candidates;
mod chosen;
mod judged;
mod results;
mod searched;
mod wheel;

pub use results::{Choice, Failed, FilterUsed, FindAnswer, LensUsed, Misses, NearMiss, Why};

use self::candidates::Candidate;
use self::chosen::{Sought, beaten_by_none};
use self::searched::{Found, Pool};
use self::wheel::{Supply, Wheel};
use crate::{OwnCameras, SizeAsked, Study, YesNo, resolve};
use hadar::demand::{self, Ledger, Reason, Skipping, Thing};
use hadar::error::{Error, Result};
use hadar::material::Library;
use hadar_scenario::{DistanceKind, FindSpec, Scenario};

/// Which cameras meet a scenario.
///
/// # Errors
/// No camera, lens or filter left; prices of two currencies; as [`Study::new`] and [`Study::size`].
pub fn find(
    scenario: &Scenario,
    own: &OwnCameras,
    library: &Library,
    skipping: Skipping,
) -> Result<FindAnswer> {
    let ledger = Ledger::open();
    let (scenario, spec) = question(scenario)?;
    let (candidates, mut failed) = candidates::of(&scenario, &spec, own)?;
    let required = resolve::required(&scenario)?;
    let mut supply = Supply::of(&spec, &candidates)?;
    let mut first_error = None;
    let (mut pool, mut sought, mut undecided, mut missed) =
        (Pool::default(), Vec::new(), Vec::new(), Vec::new());
    let mut tried = 0;
    for candidate in &candidates {
        hadar::stop::check();
        let wheel = match Wheel::new(candidate, &scenario, &mut supply, library) {
            Ok(wheel) => wheel,
            // A camera of the user's own, or one that is named, is told as it would be by itself.
            Err(error) if candidate.is_named => return Err(error),
            Err(error) => {
                first_error = first_error.or_else(|| Some(error.clone()));
                failed.push(candidate.fails(Why::Refused { because: error.to_string() }));
                continue;
            }
        };
        tried += 1;
        if scenario.alternatives.skip_uncovered {
            // Other bands may have other alternatives.
            pool = Pool::default();
        }
        match wheel.search(&spec, &mut pool, (skipping, sought.is_empty()))? {
            Found::Met(choices) => sought.extend(choices),
            Found::Fails(fails) => {
                if let Some(near) = &fails.near {
                    missed.push((near.clone(), failed.len()));
                }
                failed.push(fails.failed);
            }
            Found::Undecided(choice, fails) => {
                undecided.push(choice);
                failed.push(fails);
            }
        }
    }
    demand::computed(Thing::Cameras, tried);
    demand::spared(Thing::Cameras, Reason::NotAsked, candidates.len() as u64 - tried);
    if let (0, Some(error)) = (tried, first_error) {
        return Err(error);
    }
    let no_filter = |one: &Failed| matches!(one.why, Why::NoFilter { .. });
    if sought.is_empty() && tried > 0 && failed.iter().filter(|one| no_filter(one)).count() as u64 == tried {
        let found = "no filter lies within the range of any of these cameras";
        let error = Error::malformed(found, "give filters between 7 and 14 um, or other cameras");
        return Err(error.at(scenario.place("find.filters")));
    }
    // Put to the main job: what it does not call met is not listed.
    let listed = chosen::confirmed(sought, &spec, |choice| put_to_size(choice, library))?;
    let (met, refused) = (listed.met, listed.refused);
    undecided.extend(refused);
    let best_first = beaten_by_none(&met, &spec);
    let near = match met.is_empty() {
        true => near_miss(&missed, library)?,
        false => None,
    };
    Ok(FindAnswer {
        scenario,
        required_distance: required,
        met: !best_first.is_empty(),
        best: best_first.first().map(|index| met[*index].choice.clone()),
        listed: best_first.iter().map(|index| met[*index].choice.clone()).collect(),
        also: chosen::best_of_each(&met, &best_first)
            .into_iter()
            .map(|index| met[index].choice.clone())
            .collect(),
        undecided: chosen::distinct(undecided),
        failed,
        near,
        warnings: Vec::new(),
        stats: ledger.close(),
    })
}

/// The question with its defaults; the time of `[find]` is that of the requirement.
fn question(scenario: &Scenario) -> Result<(Scenario, FindSpec)> {
    let mut scenario = scenario.clone();
    let mut spec = scenario.find.clone().unwrap_or_default();
    let refuse = |key: &str, found: String, instead: &str| {
        Err(Error::malformed(found, instead).at(scenario.place(key)))
    };
    if scenario.requirement.by != DistanceKind::Nearest {
        let found = format!("by = \"{}\" is no limit", scenario.requirement.by.name());
        return refuse("requirement.by", found, "leave it out: cameras are found by the nearest distance");
    }
    if let Some(preset) = scenario.camera.as_ref().and_then(|camera| camera.preset.as_ref()) {
        let found = format!("the camera is {preset} already, and one is sought");
        return refuse("camera.preset", found, "write it as find.cameras, or ask `hadar size`");
    }
    if !matches!(scenario.bands.source, hadar_scenario::BandSource::Unsaid) {
        let found = "the bands are given, and filters are sought".into();
        return refuse(
            "bands",
            found,
            "leave [bands] out, or write find.filters = { from = \"my_filters.csv\" }",
        );
    }
    if scenario.envelope.is_some() {
        let found = "an envelope of scenes, of which one camera is sought for each".into();
        return refuse(
            "envelope",
            found,
            "leave it out, or hold the camera that is found against it with `hadar rule`",
        );
    }
    // Said once, as what is demanded.
    if let Some(time_s) = spec.time_s.take() {
        if scenario.requirement.time_s.is_some() {
            return refuse(
                "find.time",
                "requirement.time is given as well".into(),
                "keep only one of the two",
            );
        }
        scenario.requirement.time_s = Some(time_s);
    }
    scenario.find = Some(spec.clone());
    Ok((scenario, spec))
}

/// A choice as the main job judges it.
fn put_to_size(choice: &mut Choice, library: &Library) -> Result<bool> {
    let study = Study::new(&choice.scenario, library)?;
    let sizing = study.size_with(SizeAsked { solutions: false, sensitivity: true })?;
    let (lower, upper) = (sizing.verdict.lower, sizing.verdict.upper);
    choice.lower = lower.unwrap_or(choice.lower);
    choice.upper = upper.unwrap_or(choice.upper);
    choice.limiting.clone_from(&sizing.limiting);
    choice.warnings.clone_from(&sizing.warnings);
    let is_met = sizing.verdict.answer == Some(YesNo::Yes);
    choice.verdict = Some(sizing.verdict);
    Ok(is_met)
}

/// The camera that comes nearest, and what it would have to be.
fn near_miss(missed: &[(Choice, usize)], library: &Library) -> Result<Option<NearMiss>> {
    let nearest = missed.iter().max_by(|a, b| a.0.upper.total_cmp(&b.0.upper));
    let Some((choice, _)) = nearest else { return Ok(None) };
    let mut choice = choice.clone();
    let study = Study::new(&choice.scenario, library)?;
    let sizing = study.size_with(SizeAsked { solutions: true, sensitivity: false })?;
    choice.limiting.clone_from(&sizing.limiting);
    choice.upper = sizing.verdict.upper.unwrap_or(choice.upper);
    choice.lower = sizing.verdict.lower.unwrap_or(choice.lower);
    choice.verdict = Some(sizing.verdict.clone());
    Ok(Some(NearMiss { choice, solve_for: sizing.solve_for.clone(), sizing }))
}

/// A candidate with what is to be judged of it.
impl Candidate {
    /// That it fails, and why.
    fn fails(&self, why: Why) -> Failed {
        Failed { camera: self.camera.clone(), lens: self.lens.clone(), why, lower: None, upper: None }
    }
}

/// One of the choices, and where it stands in the order that was asked for.
#[derive(Debug, Clone)]
pub(crate) struct Ranked {
    pub(crate) choice: Choice,
    pub(crate) sought: Sought,
}
