//! What is said of many materials.

mod average;
mod bands;
pub(crate) mod captions;
mod exact;
mod matrix;
mod terms;

use self::bands::{bands, scaling};
use self::exact::exact;
use self::matrix::{apart, matrix};
use self::terms::{camera, does_not_tell, no_limit, told_by};
use crate::text::footing::footing;
use crate::text::numbers::{numbers, significant};
use crate::text::pairs::pair_table;
use crate::words::size::ROUNDED;
use crate::words::{Say, classes, conditions, probability as words, safety};
use hadar::order;
use hadar_study::{Answers, Check, Identification, NearestProof, Study, YesNo};
use std::fmt::Write as _;

/// Entries of the prediction vector that are shown.
const SHOWN: usize = 5;
/// Entries below this are not worth a name.
const LEAST_SHOWN: f64 = 1e-3;

/// All that was asked for. All against all come first where they were asked for; `apart` alone has no table of the
/// target's.
#[must_use]
pub fn text(answers: &Answers, study: &Study) -> String {
    let mut out = String::new();
    if let Some(found) = &answers.matrix {
        out.push_str(&matrix(found, study));
    }
    match &answers.apart {
        Some(found) => {
            out.push_str(&apart(found, study));
            let said = safety::of_target(&answers.identification.safety);
            if !said.is_empty() {
                let _ = writeln!(out, "{said}");
            }
        }
        None => out.push_str(&identification(&answers.identification, study)),
    }
    if let Some(found) = &answers.scaling {
        out.push_str(&scaling(found, &study.target().name));
    }
    if let Some(found) = &answers.bands_that_matter {
        out.push_str(&bands(found, study));
    }
    if let Some(found) = &answers.exact {
        out.push_str(&exact(found, study));
    }
    let told = answers.identification.identifiability.told_from.unwrap_or(0);
    out.push_str(&conditions::paragraph(&answers.identification.conditions, told > 0));
    out + &footing(&answers.identification, study)
}

/// Distances to all alternatives.
fn identification(result: &Identification, study: &Study) -> String {
    let mut out = verdict(result, study);
    out.push_str(&safety::of_target(&result.safety));
    if result.prior_average.is_none() && !study.scenario().unknown.priors.is_empty() {
        out.push_str("For a target in the state of the scenario; on average over the priors: --average.\n");
    }
    out.push_str(&pair_table(&result.pairs, study));
    out.push_str(&prediction(result));
    out.push('\n');
    out.push_str(&classes::text(&result.classes));
    out
}

/// The answer in a sentence, and the hardest alternative.
fn verdict(result: &Identification, study: &Study) -> String {
    let mut out = String::new();
    let Some(pair) = result.pairs.iter().find(|pair| pair.alternative == result.limiting) else {
        return out;
    };
    // Where there are classes each stands for all of its members.
    let class = result.pairs.iter().position(|other| other.alternative == pair.alternative);
    let class = class.and_then(|index| result.classes.get(index));
    let (target, alternative) = match class {
        Some(class) => (&class.target.name, &class.alternative.name),
        None => (&pair.target, &pair.alternative),
    };
    let all = result.pairs.len();
    let reliability = words::demanded(study.required_distance());
    // The average is finite also where the state that stands in the scenario is one of equilibrium.
    if let Some(average) = &result.prior_average {
        out.push_str(&average::text(average, target, &reliability, study));
        let state = study.state();
        let _ = writeln!(
            out,
            "At exactly {}{}:",
            study.units().temperature(state.temperature_k),
            numbers(" and V ", &state.lighting, 2)
        );
    }
    let open = result.pairs.iter().filter(|pair| pair.told == Some(YesNo::Undecided)).count();
    if let Some(told) = result.identifiability.told_from {
        let name = camera(study);
        let yes = conditions::yes(&result.conditions).replacen('y', "Y", 1);
        let sentence = match (all, told) {
            (1, 1) => format!("{yes}: {name} distinguishes {target} from {alternative}"),
            // Neither shown nor ruled out.
            (1, _) if pair.told == Some(YesNo::Undecided) => {
                format!("Undecided: whether {name} distinguishes {target} from {alternative}")
            }
            (1, _) => format!("No: {name} {} {target} from {alternative}", does_not_tell(study)),
            (_, told) if told == all => {
                format!("{yes}: {name} distinguishes {target} from all {all} alternatives")
            }
            (_, told) if open > 0 => {
                let start = if told + open == all { "Undecided" } else { "No" };
                {
                    let shown = if told == 0 { "none".to_owned() } else { told.to_string() };
                    let are = if open == 1 { "is" } else { "are" };
                    format!(
                        "{start}: {name} is shown to distinguish {target} from {shown} of {all} alternatives, while {open} {are} undecided,"
                    )
                }
            }
            (_, 0) => format!("No: {name} distinguishes {target} from none of {all} alternatives"),
            (_, told) => format!("No: {name} distinguishes {target} from only {told} of {all} alternatives"),
        };
        let _ = writeln!(out, "{sentence} with a probability of {reliability}{}.", told_by(study));
        if let Some(class) = class {
            let _ = writeln!(out, "{}", class.say());
        }
        if let (false, Some(limit)) = (no_limit(study).is_empty(), pair.statistical_distance_nearest) {
            let _ = writeln!(
                out,
                "The limit, by the nearest distance: {} against {}, of {} required.",
                words::reliability(limit),
                pair.alternative,
                reliability
            );
        }
    }
    let needed = match pair.photons_required_bounds {
        [Some(fewest), enough] => {
            let least = if no_limit(study).is_empty() { "at least " } else { "" };
            let proved = match (pair.proof, enough) {
                (NearestProof::Proved, _) => String::new(),
                (NearestProof::Searched, Some(enough)) if enough <= fewest * (1.0 + ROUNDED) => String::new(),
                (NearestProof::Searched, Some(enough)) => {
                    format!(" ({} by what is proved)", significant(enough, 3))
                }
                (NearestProof::Searched, None) => " (nothing is proved)".into(),
            };
            format!("it takes {least}{}{proved} photons, by shot noise alone", significant(fewest, 3))
        }
        [None, _] => "no number of photons suffices".into(),
    };
    let _ = writeln!(
        out,
        "{target} is hardest to distinguish from {}: {needed}{}.",
        pair.alternative,
        no_limit(study)
    );
    out.push('\n');
    out
}

/// The largest entries of the prediction vector.
fn prediction(result: &Identification) -> String {
    let Some(all) = &result.identifiability.prediction_heuristic else { return String::new() };
    let mut sorted: Vec<_> = all.iter().collect();
    order::descending(&mut sorted, |b| b.probability);
    let shown: Vec<String> = sorted
        .iter()
        .take(SHOWN)
        .filter(|entry| entry.probability >= LEAST_SHOWN)
        .map(|entry| format!("{} {}", entry.material, significant(entry.probability, 2)))
        .collect();
    let rest = if shown.len() < all.len() { ", less for the others" } else { "" };
    format!(
        "\nPrediction vector S32 of the paper (a heuristic: no bound, and no test's probability)\n  {}{rest}\n",
        shown.join(", ")
    )
}

/// The answer of a check.
#[must_use]
pub fn check(result: &Check, study: &Study) -> String {
    // Where there are classes each stands for all of its members.
    let classes = study.class_answers();
    let target = classes.first().map_or(&study.target().name, |class| &class.target.name);
    let camera = camera(study);
    let reliability = words::demanded(study.required_distance());
    match &result.not_told_from {
        Some(other) => {
            let class = result.failed.and_then(|index| classes.get(index));
            let other = class.map_or(other, |class| &class.alternative.name);
            let cannot = does_not_tell(study);
            let by = told_by(study);
            format!("No: {camera} {cannot} {target} from {other} with a probability of {reliability}{by}.\n")
        }
        None => {
            let all = match study.alternatives() {
                [one] => classes.first().map_or(&one.name, |class| &class.alternative.name).clone(),
                all => format!("all {} alternatives", all.len()),
            };
            let by = told_by(study);
            let yes = conditions::yes(&result.conditions).replacen('y', "Y", 1);
            let verdict = format!(
                "{yes}: {camera} distinguishes {target} from {all} with a probability of {reliability}{by}.\n"
            );
            match conditions::paragraph(&result.conditions, true) {
                none if none.is_empty() => verdict,
                all => format!("{verdict}\n{}\n", all.trim_end()),
            }
        }
    }
}
