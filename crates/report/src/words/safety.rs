//! Where a category that matters for safety cannot be excluded, of a target and of the cameras of a rule.

use crate::text::numbers::significant;
use hadar::words::share;
use hadar_study::{SafetyMaterial, SafetyOfRule, SafetyOfTarget};
use std::fmt::Write as _;

/// The article of a name at the beginning of a sentence.
pub(super) fn article(name: &str) -> &'static str {
    if name.starts_with(['a', 'e', 'i', 'o', 'A', 'E', 'I', 'O']) { "An" } else { "A" }
}

/// Of a target; nothing without categories that matter for safety.
pub(super) fn of_target(all: &[SafetyOfTarget]) -> String {
    let mut out = String::new();
    for found in all {
        let (article, name, target) = (article(&found.category), &found.category, &found.target);
        let _ = match (found.is_target, found.excluded) {
            (true, _) => writeln!(out, "{article} {name} cannot be excluded: {target} is of it."),
            (_, true) => writeln!(
                out,
                "{article} {name} is excluded where {target} is, at 99 %: at most 1 % of its readings are taken for {target}."
            ),
            (_, false) => writeln!(
                out,
                "{article} {name} cannot be excluded where {target} is, at 99 %: {}.",
                found.materials.iter().filter(|one| !one.excluded).map(why).collect::<Vec<_>>().join("; ")
            ),
        };
    }
    out
}

fn why(one: &SafetyMaterial) -> String {
    match (one.compared, one.probability_left_at_least) {
        (false, _) => format!("{} is not among the alternatives, and was not compared", one.material),
        // What is left this rarely is left for want of proof.
        (_, Some(left)) if left > 0.01 => {
            format!("{} is left in {} of the readings or more, by any test", one.material, share(left))
        }
        (_, Some(_)) => {
            format!("it is not proved that {} is left in at most 1 % of the readings", one.material)
        }
        (_, None) => format!("there is no camera that tells {}", one.material),
    }
}

/// Of the cameras of a clause; nothing without categories that matter for safety.
pub(super) fn of_rule(all: &[SafetyOfRule]) -> String {
    let mut out = String::new();
    for found in all {
        let (article, name, camera) = (article(&found.category), &found.category, &found.camera);
        let _ = match (found.excluded, found.not_compared.as_slice(), found.statistical_distance_lower) {
            (true, ..) => {
                writeln!(out, "{article} {name} is excluded by {camera} wherever there is none, at 99 %.")
            }
            (_, [_, ..], _) => writeln!(
                out,
                "{article} {name} cannot be excluded by {camera}: {} not compared.",
                match found.not_compared.as_slice() {
                    [one] => format!("{one} is"),
                    more => format!("{} are", more.join(", ")),
                }
            ),
            (_, _, Some(lower)) => writeln!(
                out,
                "{article} {name} cannot be excluded by {camera} at 99 %: that takes a verdict of meeting the rule and a proved d of 2.33 \
                 between materials of it and others, of which {} is proved.",
                significant(lower, 2)
            ),
            (_, _, None) => writeln!(
                out,
                "{article} {name} cannot be excluded by {camera} at 99 %: nothing is proved of its statistical distance."
            ),
        };
    }
    if !out.is_empty() {
        out.push('\n');
    }
    out
}
