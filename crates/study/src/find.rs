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
//! A *rule* is met everywhere or not: choices are searched in the scenes of its clauses, the first is held against the whole rule, the scene
//! in which it fails joins the others, and so on until what is listed meets the rule.
//!
//! Assumption: the noises of two readings have nothing in common (else choices are judged one by one up to a number, and what was not
//! judged is said).

mod candidates;
mod chosen;
mod judged;
mod of_rule;
mod results;
mod searched;
mod supply;
mod wheel;

pub use of_rule::find_for_rule;
pub use results::{Choice, Failed, FilterUsed, FindAnswer, LensUsed, Misses, NearMiss, Why};

use self::candidates::Candidate;
use self::chosen::{Listed, Put, Ranked, beaten_by_none};
use self::searched::{Found, Pool};
use self::supply::Supply;
use self::wheel::Wheel;
use crate::{OwnCameras, SizeAsked, Study, YesNo, resolve};
use hadar::demand::{self, Ledger, Reason, Skipping, Thing, Work};
use hadar::error::{Error, Result};
use hadar::material::Library;
use hadar_scenario::{BandSource, DistanceKind, FindSpec, Scenario};

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
    let (candidates, failed) = candidates::of(&scenario, &spec, own)?;
    let mut supply = Supply::of(&spec, &candidates, &scenario, library)?;
    let asked = Asked { spec: &spec, candidates: &candidates, library, skipping };
    let searched = asked.search(std::slice::from_ref(&scenario), &mut supply, &mut Pool::default())?;
    let listed = chosen::confirmed(searched.sought.clone(), &spec, |choice| put_to_size(choice, library))?;
    let filters_left_out = supply.left_out;
    let answer = asked.answer(scenario, searched, listed, failed)?;
    Ok(FindAnswer { filters_left_out, stats: ledger.close(), ..answer })
}

/// What is asked of every camera.
struct Asked<'a> {
    spec: &'a FindSpec,
    candidates: &'a [Candidate],
    library: &'a Library,
    skipping: Skipping,
}

/// What a search comes to, before anything was put to the main job or the rule.
#[derive(Debug, Default)]
struct Searched {
    sought: Vec<Ranked>,
    failed: Vec<Failed>,
    missed: Vec<Choice>,
    /// Whether exposures were tried.
    exposures: bool,
}

impl Asked<'_> {
    /// Every camera in some scenes.
    fn search(&self, scenes: &[Scenario], supply: &mut Supply<'_>, pool: &mut Pool) -> Result<Searched> {
        let mut all = Searched::default();
        let (mut first_error, mut tried, mut without_filters) = (None, 0, 0);
        for candidate in self.candidates {
            hadar::stop::check();
            let wheels = match Wheel::all(candidate, scenes, supply, self.library) {
                Ok(wheels) => wheels,
                // A camera that is named is told as it would be by itself.
                Err(error) if candidate.is_named => return Err(error),
                Err(error) => {
                    all.failed.push(candidate.fails(Why::Refused { because: error.to_string() }));
                    first_error = first_error.or(Some(error));
                    continue;
                }
            };
            tried += 1;
            if scenes.iter().any(|scene| scene.alternatives.skip_uncovered) {
                // Other bands may have other alternatives.
                *pool = Pool::default();
            }
            all.exposures |= wheels.len() > 1;
            let mut found = Vec::with_capacity(wheels.len());
            for wheel in &wheels {
                let wants_near = all.sought.is_empty();
                found.push(wheel.search(self.spec, pool, (self.skipping, wants_near))?);
            }
            match Found::of_all(found) {
                Some(Found::Sought(choices)) => all.sought.extend(choices),
                Some(Found::Fails(fails)) => {
                    without_filters += u64::from(matches!(fails.failed.why, Why::NoFilter { .. }));
                    all.missed.extend(fails.near.filter(|near| near.upper > 0.0));
                    all.failed.push(fails.failed);
                }
                None => {}
            }
        }
        demand::computed(Thing::Cameras, tried);
        demand::spared(Thing::Cameras, Reason::NotAsked, self.candidates.len() as u64 - tried);
        if let (0, Some(error)) = (tried, first_error) {
            return Err(error);
        }
        if tried > 0 && without_filters == tried {
            let found = "no filter lies within the range of any of these cameras";
            let error = Error::malformed(found, "give filters between 7 and 14 um, or other cameras");
            return Err(scenes.first().map_or(error.clone(), |scene| error.at(scene.place("find.filters"))));
        }
        Ok(all)
    }

    /// The answer of what is listed.
    fn answer(
        &self,
        scenario: Scenario,
        searched: Searched,
        listed: Listed,
        mut failed: Vec<Failed>,
    ) -> Result<FindAnswer> {
        let Listed { met, refused, .. } = listed;
        let mut undecided = Vec::new();
        failed.extend(searched.failed);
        // What the main job or the rule does not call met is not shown to meet, or shown not to.
        for choice in chosen::distinct(refused) {
            let (lens, is_open) = (Some(choice.lens.clone()), choice.is_undecided());
            let why = if is_open { Why::Undecided } else { Why::NotAsAWhole };
            let (lower, upper) = (Some(choice.lower), Some(choice.upper));
            failed.push(Failed { camera: choice.camera.clone(), lens, why, lower, upper });
            if is_open {
                undecided.push(choice);
            }
        }
        let best_first = beaten_by_none(&met, self.spec);
        let near = if met.is_empty() { near_miss(&searched.missed, self.library)? } else { None };
        let of = |places: &[usize]| -> Vec<Choice> {
            places.iter().map(|index| met[*index].choice.clone()).collect()
        };
        let listed = of(&best_first);
        Ok(FindAnswer {
            required_distance: resolve::required(&scenario)?,
            scenario,
            rule: None,
            scenes: 1,
            met: !listed.is_empty(),
            warnings: listed.first().map_or_else(Vec::new, |best| best.warnings.clone()),
            best: listed.first().cloned(),
            listed,
            exposures_tried: searched.exposures,
            also: of(&chosen::best_of_each(&met, &best_first)),
            undecided,
            filters_left_out: Vec::new(),
            failed,
            near,
            stats: Work::default(),
        })
    }
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
    if !matches!(scenario.bands.source, BandSource::Unsaid) {
        let found = "the bands are given, and filters are sought".into();
        return refuse(
            "bands",
            found,
            "leave [bands] out, or write find.filters = { from = \"my_filters.csv\" }",
        );
    }
    if scenario.envelope.is_some() {
        let found = "an envelope of scenes, which is a rule".into();
        return refuse("envelope", found, "read the file as a rule, or leave the envelope out");
    }
    if let Some(frames) = scenario.camera.as_ref().and_then(|camera| camera.frames) {
        if scenario.source.line("find.frames").is_some() {
            return refuse(
                "find.frames",
                "camera.frames is given as well".into(),
                "keep only one of the two",
            );
        }
        spec.frames = vec![frames];
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
fn put_to_size(choice: &mut Choice, library: &Library) -> Result<Put> {
    let study = Study::new(&choice.scenario, library)?;
    let sizing =
        study.size_with(SizeAsked { solutions: false, sensitivity: false, emissivity_errors: true })?;
    let (lower, upper) = (sizing.verdict.lower, sizing.verdict.upper);
    choice.lower = lower.unwrap_or(choice.lower);
    choice.upper = upper.unwrap_or(choice.upper);
    choice.limiting.clone_from(&sizing.limiting);
    choice.warnings.clone_from(&sizing.warnings);
    let is_met = sizing.verdict.answer == Some(YesNo::Yes);
    choice.verdict = Some(sizing.verdict);
    Ok(if is_met { Put::Met } else { Put::Refused })
}

/// The camera that comes nearest, and what it would have to be.
fn near_miss(missed: &[Choice], library: &Library) -> Result<Option<NearMiss>> {
    let nearest = missed.iter().max_by(|a, b| a.upper.total_cmp(&b.upper));
    let Some(choice) = nearest else { return Ok(None) };
    let mut choice = choice.clone();
    let study = Study::new(&choice.scenario, library)?;
    let sizing =
        study.size_with(SizeAsked { solutions: true, sensitivity: false, emissivity_errors: false })?;
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
