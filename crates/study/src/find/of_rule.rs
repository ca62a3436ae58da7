//! The camera that meets a rule everywhere.
//!
//! Choices are searched in the scenes that the clauses of the rule describe, each at its farthest distance. What would be listed is held
//! against the whole rule; where it fails by the distance, the scene that limits it joins the others and the search begins again, so that
//! no choice that fails there comes back. It ends when all that is listed meets the rule.

use super::chosen::{Listed, Put, confirmed};
use super::searched::Pool;
use super::supply::Supply;
use super::{Asked, Choice, FindAnswer, candidates, question};
use crate::{CameraVerdict, Extent, LimitingScene, OwnCameras, RuleAsked, RuleStudy, Shortfall};
use hadar::demand::{Ledger, Skipping};
use hadar::error::{Error, Result};
use hadar::material::Library;
use hadar_scenario::rule::{Clause, RuleCamera, Verdict};
use hadar_scenario::{BandSource, MaterialRef, Rule, Scenario};
use std::collections::BTreeMap;

/// Scenes that are added at most.
const MOST_SCENES: usize = 24;

/// Which cameras meet a rule.
///
/// # Errors
/// As [`super::find`] and [`RuleStudy::new`]; a rule that tells nothing apart.
pub fn find_for_rule(
    rule: &Rule,
    own: &OwnCameras,
    library: &Library,
    skipping: Skipping,
) -> Result<FindAnswer> {
    let ledger = Ledger::open();
    if let Some(camera) = rule.cameras.first() {
        let error = Error::malformed(
            format!("the rule has a camera already, {}, and one is sought", camera.called()),
            "name it in find.cameras, or ask `hadar rule`",
        );
        return Err(error.at(rule.scenario.place(&camera.key)));
    }
    let apart: Vec<&Clause> = rule.clauses.iter().filter(|clause| is_apart(clause)).collect();
    let mut scenes = Vec::with_capacity(apart.len());
    for clause in &apart {
        let mut scene = nominal(clause);
        scene.find.clone_from(&rule.scenario.find);
        scenes.push(question(&scene)?.0);
    }
    let Some(first) = scenes.first().cloned() else {
        let error = Error::malformed(
            "the rule distinguishes no materials",
            "hold cameras against it with `hadar rule`",
        );
        return Err(error.at(rule.scenario.place("clause")));
    };
    let spec = first.find.clone().unwrap_or_default();
    let (candidates, failed) = candidates::of(&first, &spec, own)?;
    let mut supply = Supply::of(&spec, &candidates, &first, library)?;
    let mut pool = Pool::default();
    let asked = Asked { spec: &spec, candidates: &candidates, library, skipping };
    let (mut refused, mut known): (Vec<Choice>, Vec<Choice>) = (Vec::new(), Vec::new());
    loop {
        let mut searched = asked.search(&scenes, &mut supply, &mut pool)?;
        searched.sought.retain(|one| !refused.iter().any(|other| one.choice.is_same(other)));
        let mut added = None;
        let found = confirmed(searched.sought.clone(), &spec, |choice| {
            // What met the rule before meets it now.
            if let Some(judged) = known.iter().find(|other| choice.is_same(other)) {
                judged.clone_into(choice);
                return Ok(Put::Met);
            }
            match put_to_rule(choice, rule, library, skipping)? {
                None => {
                    known.push(choice.clone());
                    Ok(Put::Met)
                }
                Some(Limit { clause, scene }) => {
                    let scene = scene.map(|limiting| Scenario {
                        find: first.find.clone(),
                        ..scene_of(apart[clause], &limiting)
                    });
                    match scene.filter(|scene| scenes.len() < MOST_SCENES && !scenes.contains(scene)) {
                        Some(scene) => {
                            added = Some(question(&scene)?.0);
                            Ok(Put::Again)
                        }
                        None => Ok(Put::Refused),
                    }
                }
            }
        })?;
        let Listed { refused: now, again, .. } = &found;
        refused.extend(now.iter().cloned());
        match added.filter(|_| *again) {
            Some(scene) => scenes.push(scene),
            None => {
                let found = Listed { refused, ..found };
                let answer = asked.answer(first, searched, found, failed)?;
                let (filters_left_out, stats) = (supply.left_out, ledger.close());
                let (rule, scenes) = (Some(rule.clone()), scenes.len());
                return Ok(FindAnswer { rule, scenes, filters_left_out, stats, ..answer });
            }
        }
    }
}

fn is_apart(clause: &Clause) -> bool {
    clause.demand.tells_apart()
}

/// The scene that a clause describes, from as far away as it holds.
fn nominal(clause: &Clause) -> Scenario {
    let mut scenario = clause.scenario.clone();
    if let Some([_, far_m]) = scenario.envelope.take().and_then(|envelope| envelope.distance_m) {
        scenario.target.distance_m = Some(far_m);
    }
    scenario
}

/// The scene of a clause in which a camera fails.
fn scene_of(clause: &Clause, limiting: &LimitingScene) -> Scenario {
    let mut scenario = nominal(clause);
    scenario.target.temperature_k = limiting.temperature_k;
    scenario.target.distance_m = limiting.distance_m.or(scenario.target.distance_m);
    for (k, object) in scenario.environment.iter_mut().enumerate() {
        object.lighting = limiting.lighting.get(k).copied().unwrap_or(object.lighting);
        object.temperature_k = limiting.surroundings_k.get(k).copied().unwrap_or(object.temperature_k);
    }
    let envelope = clause.scenario.envelope.as_ref();
    let materials = envelope.and_then(|envelope| envelope.materials.as_ref());
    if let Some(material) = materials.and_then(|all| all.iter().find(|one| is_of(one, &limiting.target))) {
        scenario.target.material = material.clone();
    }
    scenario
}

/// Whether a surface of a name is of a material or class that is named so.
fn is_of(material: &MaterialRef, surface: &str) -> bool {
    match material {
        MaterialRef::Name(name) => {
            surface == name || surface.strip_prefix(name).is_some_and(|rest| rest.starts_with('/'))
        }
        MaterialRef::File(path) => path.file_stem().is_some_and(|stem| stem.to_string_lossy() == surface),
    }
}

/// By what a choice does not meet a rule.
struct Limit {
    /// The place of the clause among those that tell materials apart.
    clause: usize,
    /// The scene in which it is too near; none where it is something else.
    scene: Option<LimitingScene>,
}

/// Holds a choice against the rule; nothing where it meets.
fn put_to_rule(
    choice: &mut Choice,
    rule: &Rule,
    library: &Library,
    skipping: Skipping,
) -> Result<Option<Limit>> {
    let mut own = rule.clone();
    let spec = choice.scenario.camera.clone().unwrap_or_default();
    own.cameras = vec![RuleCamera {
        name: None,
        spec,
        uncertainty: BTreeMap::new(),
        share: None,
        key: "camera[0]".into(),
    }];
    own.tests.clear();
    own.scenario.find = None;
    let source = &choice.scenario.bands.source;
    own.scenario.bands.source.clone_from(source);
    for clause in own.clauses.iter_mut() {
        clause.scenario.find = None;
        if clause.scenario.bands.source == BandSource::Unsaid {
            clause.scenario.bands.source.clone_from(source);
        }
    }
    let study = RuleStudy::new(&own, library)?;
    let asked = RuleAsked { extent: Extent::Margins, skipping, ..RuleAsked::default() };
    let answer = study.answer(&asked, &|_, _| ())?;
    let lines: Vec<&CameraVerdict> =
        answer.clauses.iter().filter_map(|clause| clause.apart()?.cameras.first()).collect();
    let margin =
        |of: &dyn Fn(&CameraVerdict) -> f64| lines.iter().map(|line| of(line)).fold(f64::INFINITY, f64::min);
    let required = choice.required_distance;
    let proved = |line: &CameraVerdict| {
        let share =
            line.lower_bound.map_or(0.0, |bound| bound / line.statistical_distance.max(f64::MIN_POSITIVE));
        line.margin * share.min(1.0)
    };
    choice.upper = required * margin(&|line| line.margin);
    choice.lower = required * margin(&proved);
    let limiting = lines.iter().min_by(|a, b| a.margin.total_cmp(&b.margin));
    choice.limiting = limiting.map_or_else(String::new, |line| line.limiting.alternative.clone());
    let found = answer.cameras.into_iter().next();
    let is_met = found.as_ref().is_some_and(|camera| camera.verdict == Verdict::Meets);
    let fails = lines.iter().position(|line| line.verdict != Verdict::Meets);
    let limit = fails.map(|clause| {
        let line = lines[clause];
        let by_distance =
            line.fails_by.contains(&Shortfall::Distance) || line.undecided_by.contains(&Shortfall::Distance);
        Limit { clause, scene: by_distance.then(|| line.limiting.clone()) }
    });
    (choice.of_rule, choice.rule) = (found, Some(own));
    Ok(if is_met { None } else { Some(limit.unwrap_or(Limit { clause: 0, scene: None })) })
}
