//! Where a category that matters for safety cannot be excluded, of a target and of the cameras of a rule.

use super::conditions::under;
use super::shortfall::clauses;
use crate::text::numbers::{listed, significant};
use hadar::words::share;
use hadar_study::{Condition, SafetyMaterial, SafetyOfRule, SafetyOfTarget};
use std::collections::HashSet;
use std::fmt::Write as _;

/// The article of a name at the beginning of a sentence.
pub(super) fn article(name: &str) -> &'static str {
    if name.starts_with(['a', 'e', 'i', 'o', 'A', 'E', 'I', 'O']) { "An" } else { "A" }
}

/// Of a target; nothing without categories that matter for safety.
pub(super) fn of_target(all: &[SafetyOfTarget]) -> String {
    all.iter().map(|found| sentence(found) + "\n").collect()
}

fn sentence(found: &SafetyOfTarget) -> String {
    let (article, name, target) = (article(&found.category), &found.category, &found.target);
    match (found.is_target, found.excluded) {
        (true, _) => format!("{article} {name} cannot be excluded: {target} is of it."),
        (_, true) => format!(
            "{article} {name} is excluded where {target} is, at 99 %{}: at most 1 % of its readings are taken for {target}{}.",
            under(&found.conditions),
            if_constant(&found.constants)
        ),
        (_, false) => format!(
            "{article} {name} cannot be excluded where {target} is, at 99 %: {}.",
            why_not(found).join("; ")
        ),
    }
}

/// What spoils the readings, and what is known of materials that are left whatever spoils them; else of all that are left.
fn why_not(found: &SafetyOfTarget) -> Vec<String> {
    let spoiled = (!found.spoiled_by.is_empty()).then(|| clauses(&found.spoiled_by));
    let is_told = |one: &&SafetyMaterial| !one.excluded && (spoiled.is_none() || is_left(one));
    let materials: Vec<String> = found.materials.iter().filter(is_told).map(why).collect();
    spoiled.into_iter().chain(materials).collect()
}

/// Of every material of a matrix, category by category: where it cannot be excluded, then where it is.
pub(super) fn of_matrix(all: &[SafetyOfTarget]) -> String {
    let mut names: Vec<&String> = Vec::new();
    for found in all {
        if !names.contains(&&found.category) {
            names.push(&found.category);
        }
    }
    let mut out = String::new();
    for name in names {
        let (excluded, left): (Vec<&SafetyOfTarget>, Vec<&SafetyOfTarget>) =
            all.iter().filter(|found| found.category == *name).partition(|found| found.excluded);
        let all = left.len() + excluded.len();
        let (article, where_left) = (article(name), left.len());
        let conditions = under(of_any(&excluded));
        let _ = match where_left {
            0 => {
                let mut constants: Vec<String> =
                    excluded.iter().flat_map(|found| found.constants.iter().cloned()).collect();
                constants.sort_unstable();
                constants.dedup();
                let rests = if_constant(&constants);
                writeln!(
                    out,
                    "{article} {name} is excluded where any of the {all} materials is, at 99 %{rests}{conditions}"
                )
            }
            _ if where_left == all => {
                writeln!(
                    out,
                    "{article} {name} cannot be excluded where any of the {all} materials is, at 99 %"
                )
            }
            _ => writeln!(
                out,
                "{article} {name} cannot be excluded where {where_left} of the {all} materials are, at 99 %"
            ),
        };
        left.iter().for_each(|found| {
            let _ = writeln!(out, "  {}", sentence(found));
        });
        let where_excluded: Vec<String> = excluded
            .iter()
            .map(|found| match found.constants.is_empty() {
                true => found.target.clone(),
                false => format!("{} ({})", found.target, listed_constants(&found.constants)),
            })
            .collect();
        if !where_excluded.is_empty() {
            // Where all are excluded the first line has them.
            let conditions = if where_left == 0 { "" } else { conditions.as_str() };
            let _ = writeln!(
                out,
                "  excluded, at 99 %, where these are{conditions}: {}",
                listed(&where_excluded)
            );
        }
        out.push('\n');
    }
    out
}

/// The conditions of all rows that are excluded, each code once.
fn of_any<'f>(excluded: &[&'f SafetyOfTarget]) -> Vec<&'f Condition> {
    let mut codes = HashSet::new();
    let all = excluded.iter().flat_map(|found| &found.conditions);
    all.filter(|one| codes.insert(one.code())).collect()
}

/// Beside a simulation, whose draws have no part in it.
pub(super) fn beside_draws(all: &[SafetyOfTarget]) -> String {
    if all.is_empty() {
        return String::new();
    }
    format!(
        "By what is proved of the scenario's camera, independent of the draws\n{}\n",
        indented(&of_target(all))
    )
}

fn indented(lines: &str) -> String {
    lines.lines().map(|line| format!("  {line}\n")).collect()
}

/// What an exclusion rests on where materials are entered as one number.
fn if_constant(constants: &[String]) -> String {
    match constants.len() {
        0 => String::new(),
        _ => format!(", if real surfaces are as {}", listed_constants(constants)),
    }
}

fn listed_constants(constants: &[String]) -> String {
    format!("the one number of {}", listed(constants))
}

/// Whether more is known of a material than that no proof excludes it.
fn is_left(one: &SafetyMaterial) -> bool {
    !one.compared || one.probability_left_at_least.is_none_or(|left| left > 0.01)
}

fn why(one: &SafetyMaterial) -> String {
    match (one.compared, one.probability_left_at_least) {
        (false, _) => format!("{} is not among the alternatives, and was not compared", one.material),
        // What is left this rarely is left for want of proof.
        (_, Some(left)) if is_left(one) => {
            format!("{} is left in {} of the readings or more, by any test", one.material, share(left))
        }
        (_, Some(_)) => {
            format!("it is not proved that {} is left in at most 1 % of the readings", one.material)
        }
        (_, None) => format!("there is no camera that distinguishes {}", one.material),
    }
}

/// Of the cameras of a clause, a sentence each; nothing without categories that matter for safety.
pub(super) fn of_rule(all: &[SafetyOfRule]) -> Vec<String> {
    all.iter().map(of_camera).collect()
}

fn of_camera(found: &SafetyOfRule) -> String {
    let (article, name, camera) = (article(&found.category), &found.category, &found.camera);
    match (found.excluded, found.not_compared.as_slice(), found.statistical_distance_lower) {
        (true, ..) => format!(
            "{article} {name} is excluded by {camera} where any of the materials that the rule compares with it is, at 99 %{}{}.",
            if_constant(&found.constants),
            under(&found.conditions)
        ),
        (_, [_, ..], _) => format!(
            "{article} {name} cannot be excluded by {camera}: {} not compared.",
            match found.not_compared.as_slice() {
                [one] => format!("{one} is"),
                more => format!("{} are", more.join(", ")),
            }
        ),
        (_, _, Some(_)) if !found.not_compared_with.is_empty() => format!(
            "{article} {name} cannot be excluded by {camera}: it is not compared with {}.",
            listed(&found.not_compared_with)
        ),
        (_, _, Some(lower)) => format!(
            "{article} {name} cannot be excluded by {camera} at 99 %: that takes a verdict of meeting the rule and a proved d of 2.33 \
             between materials of it and others, of which {} is proved.",
            significant(lower, 2)
        ),
        (_, _, None) => format!(
            "{article} {name} cannot be excluded by {camera} at 99 %: nothing is proved of its statistical distance."
        ),
    }
}
