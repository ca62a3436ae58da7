//! What is said of many materials.

use super::{exponential, photons, significant};
use crate::identifiability::detection;
use crate::identifiability::multi::{Passes, Work};
use crate::scenario::DistanceKind;
use crate::study::{
    Answers, Apart, BandsThatMatter, Check, Exact, ExactPair, Identification, Matrix, Scaling, Study,
};
use std::fmt::Write as _;

/// Names listed in one line at most; all of them are in the tables.
const LISTED: usize = 12;
/// Entries of the prediction vector that are shown.
const SHOWN: usize = 5;
/// Entries below this are not worth a name.
const LEAST_SHOWN: f64 = 1e-3;
/// Probabilities from here on are 1 to three digits.
const CERTAIN: f64 = 0.9995;

/// All that was asked for, the target against its alternatives first.
#[must_use]
pub fn answers(answers: &Answers, study: &Study) -> String {
    let mut out = super::identification(&answers.identification, study);
    if let Some(found) = &answers.matrix {
        out.push_str(&matrix(found, study));
    }
    if let Some(found) = &answers.apart {
        out.push_str(&apart(found, study));
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
    out + &super::footing(&answers.identification, study)
}

/// The camera by its name, where it has one.
fn camera(study: &Study) -> &str {
    match study.camera().map(|camera| camera.name.as_str()) {
        None | Some("camera") => "the camera",
        Some(name) => name,
    }
}

/// The answer in a sentence, and the hardest alternative.
pub(super) fn verdict(result: &Identification, study: &Study) -> String {
    let mut out = String::new();
    let Some(pair) = result.pairs.iter().find(|pair| pair.alternative == result.limiting) else {
        return out;
    };
    let (target, all) = (&pair.target, result.pairs.len());
    let percent = 100.0 * detection::probability(study.required_distance());
    if let Some(told) = result.identifiability.told_from {
        let name = camera(study);
        let sentence = match (all, told) {
            (1, 1) => format!("Yes: {name} tells {target} from {}", pair.alternative),
            (1, _) => format!("No: {name} cannot tell {target} from {}", pair.alternative),
            (_, told) if told == all => format!("Yes: {name} tells {target} from all {all} alternatives"),
            (_, 0) => format!("No: {name} tells {target} from none of {all} alternatives"),
            (_, told) => format!("No: {name} tells {target} from only {told} of {all} alternatives"),
        };
        let _ = writeln!(out, "{sentence} with {percent:.1} % reliability{}.", no_limit(study));
    }
    let needed = match pair.photons_required {
        Some(_) => {
            format!("it takes at least {} photons, by shot noise alone", photons(pair.photons_required))
        }
        None => "no number of photons suffices".into(),
    };
    let _ =
        writeln!(out, "{target} is hardest to tell from {}: {needed}{}.", pair.alternative, no_limit(study));
    if let Some(average) = &result.prior_average {
        let _ = writeln!(
            out,
            "Averaged over the priors: {} photons for {percent:.1} % right answers (hybrid Cramer-Rao bound of estimates, no limit of decisions: {}).",
            photons(average.photons_required),
            photons(average.photons_required_hybrid_bound)
        );
    }
    out.push('\n');
    out
}

/// What must be added to an answer that is not by the nearest distance.
fn no_limit(study: &Study) -> &'static str {
    match study.scenario().requirement.by {
        DistanceKind::Nearest => "",
        DistanceKind::Local => ", by the local distance, which is no limit and can err either way",
        DistanceKind::LocalUnknownGain => {
            ", by the local distance with unknown gain (S29), which is no limit"
        }
    }
}

/// The largest entries of the prediction vector.
pub(super) fn prediction(result: &Identification) -> String {
    let Some(all) = &result.identifiability.prediction_heuristic else { return String::new() };
    let mut sorted: Vec<_> = all.iter().collect();
    sorted.sort_by(|a, b| b.probability.total_cmp(&a.probability));
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

/// A list of names, cut short where it is long.
fn listed(names: &[String]) -> String {
    match names.len().checked_sub(LISTED) {
        Some(more) if more > 0 => format!("{} and {more} more", names[..LISTED].join(", ")),
        _ => names.join(", "),
    }
}

/// Which materials can be told apart, and which cannot.
fn apart(apart: &Apart, study: &Study) -> String {
    let camera = match camera(study) {
        "the camera" => "The camera",
        name => name,
    };
    let pairs = apart.told_apart.len() + apart.not_told_apart.len();
    let percent = 100.0 * detection::probability(study.required_distance());
    let mut out = format!(
        "{camera} tells {} of {pairs} pairs apart with {percent:.1} % reliability, either of them the target\n",
        apart.told_apart.len()
    );
    if apart.told_apart.is_empty() {
        return out + "  not one pair\n\n";
    }
    let names =
        |pairs: &[[String; 2]]| -> Vec<String> { pairs.iter().map(|[a, b]| format!("{a} | {b}")).collect() };
    let _ = writeln!(out, "  told apart      {}", listed(&names(&apart.told_apart)));
    if !apart.not_told_apart.is_empty() {
        let _ = writeln!(out, "  not told apart  {}", listed(&names(&apart.not_told_apart)));
    }
    if !apart.clusters.is_empty() {
        out.push_str("Clusters of which no two members are told apart\n");
    }
    for (i, cluster) in apart.clusters.iter().enumerate() {
        let _ = writeln!(out, "  {:<3} ({}) {}", i + 1, cluster.len(), listed(cluster));
    }
    out.push('\n');
    out
}

/// Every material as a target, the hardest first.
fn matrix(matrix: &Matrix, study: &Study) -> String {
    let mut out = format!("Every material as the target, by the {} distance\n", matrix.by);
    let width = matrix.materials.iter().map(String::len).max().unwrap_or(0).max(8);
    let with_camera = matrix.statistical_distance.is_some();
    let _ = write!(out, "  {:<width$}  {:<width$}  {:>12}", "target", "hardest", "per photon^.5");
    let _ = writeln!(out, "{}", if with_camera { "    camera d   as a target" } else { "" });
    for target in matrix.hardest_first() {
        let _ = write!(
            out,
            "  {:<width$}  {:<width$}  {:>13}",
            target.material,
            target.limiting,
            exponential(target.distance_minimum, 2)
        );
        if let (Some(d), Some(yes)) = (target.statistical_distance_minimum, target.identifiable) {
            let answer = if yes { "yes" } else { "no" };
            let _ = write!(out, "  {:>10}  {answer:>12}", exponential(d, 2));
        }
        out.push('\n');
    }
    out.push('\n');
    if let Some(found) = &matrix.apart {
        out.push_str(&apart(found, study));
    }
    out
}

/// The answer of a check.
#[must_use]
pub fn check(result: &Check, study: &Study) -> String {
    let target = &study.target().name;
    let camera = camera(study);
    let percent = 100.0 * detection::probability(study.required_distance());
    match &result.not_told_from {
        Some(other) => {
            format!("No: {camera} cannot tell {target} from {other} with {percent:.1} % reliability.\n")
        }
        None => {
            let all = match study.alternatives() {
                [one] => one.name.clone(),
                all => format!("all {} alternatives", all.len()),
            };
            format!("Yes: {camera} tells {target} from {all} with {percent:.1} % reliability.\n")
        }
    }
}

/// How distances scale with materials and bands.
fn scaling(scaling: &Scaling, target: &str) -> String {
    let mut out = format!("Scaling of the distance of {target} ({})\n", scaling.by);
    let library = &scaling.library;
    if let (Some(first), Some(last), Some(size)) =
        (library.target.first(), library.target.last(), library.materials.last())
    {
        let _ = writeln!(
            out,
            "  least     {} per sqrt(photon) against 1 alternative on average, {} against {}",
            exponential(*first, 2),
            exponential(*last, 2),
            size - 1
        );
    }
    let bands = &scaling.bands;
    let span = |values: &[f64], what: &str| {
        let best = values.iter().copied().fold(0.0, f64::max);
        let at = values.iter().position(|v| *v == best).and_then(|i| bands.bands.get(i));
        match (values.first(), values.last(), at, bands.bands.first(), bands.bands.last()) {
            (Some(first), Some(last), Some(at), Some(few), Some(many)) if best > 0.0 => format!(
                "  {what}  {} in {few} band{}, {} in {many}; most in {at}: {best:.2e}\n",
                exponential(*first, 2),
                if *few == 1 { "" } else { "s" },
                exponential(*last, 2)
            ),
            _ => format!("  {what}  0 in any number of bands\n"),
        }
    };
    out.push_str(&span(&bands.shot_noise, "least, shot noise alone (per sqrt(photon)) "));
    out.push_str(&span(&bands.shot_noise_median, "median, shot noise alone (per sqrt(photon))"));
    if !bands.camera.is_empty() {
        out.push_str(&span(&bands.camera, "least, the camera's noise per reading (d)  "));
        out.push_str(&span(&bands.camera_median, "median, the camera's noise per reading (d) "));
    }
    out.push('\n');
    out
}

/// Which bands matter, and what the best few keep.
fn bands(found: &BandsThatMatter, study: &Study) -> String {
    let target = &study.target().name;
    let against = match found.alternatives.as_slice() {
        [one] => one.clone(),
        all => format!("{} alternatives", all.len()),
    };
    let mut out = format!("Bands that matter for telling {target} from {against}, by the local distance\n");
    if !found.left_out.is_empty() {
        let _ = writeln!(out, "  left out, since not even all bands tell them: {}", listed(&found.left_out));
    }
    for (choice, what) in [(&found.bands, "band"), (&found.filters, "contiguous filter")] {
        let Some(choice) = choice else { continue };
        let count = choice.passbands.len();
        let plural = if count == 1 { "" } else { "s" };
        if choice.distance == 0.0 {
            let _ = writeln!(
                out,
                "  so few {what}s tell nothing: it takes {} or more, one more than there are unknowns",
                choice.fewest
            );
            continue;
        }
        let share = |distance: f64| {
            let ratio = distance / choice.distance_all_bands;
            if ratio < 1.5 {
                format!("{} %", significant(100.0 * ratio, 3))
            } else {
                format!("{} times", significant(ratio, 3))
            }
        };
        let proof = if choice.exact {
            "no others give more".to_owned()
        } else {
            format!("no others give more than {}", share(choice.bound))
        };
        let limiting = choice.limiting.as_deref().unwrap_or(&found.alternative);
        let unit = if study.camera().is_some() { "camera d" } else { "per sqrt(photon)" };
        let _ = writeln!(
            out,
            "  best {count} {what}{plural}: {}{} the distance of all {} bands read one by one ({unit} {:.2e}, all bands {:.2e}; worst against {limiting}); {proof}",
            share(choice.distance),
            if choice.kept < 1.5 { " of" } else { "" },
            found.center_cm1.len(),
            choice.distance,
            choice.distance_all_bands
        );
        let places: Vec<String> = choice
            .passbands
            .iter()
            .map(|band| match what {
                // As many digits as tell neighbours apart.
                "band" if band.high_cm1 - band.low_cm1 < 1.0 => format!("{:.2}", band.center_cm1),
                "band" => format!("{:.0}", band.center_cm1),
                _ => format!("{:.1}-{:.1}", band.low_cm1, band.high_cm1),
            })
            .collect();
        let _ = writeln!(out, "    at {} cm^-1", places.join(", "));
    }
    out.push('\n');
    out
}

/// The simulated decisions beside their limits.
fn exact(found: &Exact, study: &Study) -> String {
    let percent = 100.0 * found.level;
    let mut out = format!(
        "Maximum-likelihood decision, states unknown, {} counts (seed {}, {percent:.0} % intervals)\n",
        found.statistics, found.seed
    );
    let width = found.pairs.iter().map(|pair| pair.alternative.len()).max().unwrap_or(0).max(11);
    let _ = writeln!(
        out,
        "  {:<width$}  {:>9}  {:>18}  {:>11}  {:>11}  {:>9}  {:>17}",
        "alternative", "photons", "right decisions", "limit Phi(d)", "two-sided", "local", "rigorous limits"
    );
    let shown = |pair: &&ExactPair| pair.limit < CERTAIN || pair.balanced < CERTAIN;
    let certain = found.pairs.iter().filter(|pair| !shown(pair)).count();
    for pair in found.pairs.iter().filter(shown) {
        let _ = write!(
            out,
            "  {:<width$}  {:>9.2e}  {:>9.3} +- {:.3}    {:>12.3}  {:>11.3}  {:>9.3}  {:>8.3} to {:.3}",
            pair.alternative,
            pair.photons,
            pair.balanced,
            pair.balanced_interval.half_width(),
            pair.limit,
            pair.two_sided,
            pair.local,
            1.0 - pair.error_upper,
            1.0 - pair.error_lower
        );
        if let Some(lattice) = &pair.lattice {
            let p = lattice.probabilities.first().copied().unwrap_or(f64::NAN);
            let _ = write!(out, "  Algorithm 1: {p:.3}");
        }
        out.push('\n');
    }
    if certain > 0 {
        let _ = writeln!(out, "  {certain} more, of limit and right decisions both 1.000 to three digits");
    }
    if let Some(library) = &found.library {
        let _ = writeln!(
            out,
            "  among all at once {} is recognised in {:.3} +- {:.3} of {} trials{}",
            study.target().name,
            library.probability,
            library.interval.half_width(),
            library.trials,
            if library.union_bound_known_states > 0.0 {
                format!(
                    "; were all states known, in at least {:.3} (union bound)",
                    library.union_bound_known_states
                )
            } else {
                String::new()
            }
        );
    }
    out.push_str(
        "  right decisions: averaged over the target's state and the alternative's nearest; the rigorous limits are those of\n  the best test between these two known states, which no test exceeds\n",
    );
    if found.pairs.iter().any(|pair| pair.lattice.is_some()) {
        let target = &study.target().name;
        let _ = writeln!(
            out,
            "  Algorithm 1: share of right decisions with {target} true (not averaged), all states on a mesh"
        );
    }
    out.push('\n');
    out
}

/// What the answers took.
#[must_use]
pub fn work_of(answers: &Answers) -> String {
    if let Some(done) = answers.apart.as_ref().and_then(|apart| apart.work) {
        return work(&done);
    }
    let every = "work: every distance was computed; only --apart and --check can do with less";
    let Some(Passes { shared_targets, one_pass, two_passes, alone }) =
        answers.matrix.as_ref().map(|m| m.passes)
    else {
        return every.into();
    };
    format!(
        "{every}. Of the {} local ones {one_pass} took one pass over the bands and {two_passes} a second one, \
         with what {shared_targets} targets lent them; {alone} were judged on their own",
        one_pass + two_passes + alone
    )
}

/// What was computed and what was not.
#[must_use]
pub fn work(work: &Work) -> String {
    let skipped = work.distances.saturating_sub(work.in_full + work.decided_on_the_way);
    format!(
        "work: {} distances asked for, {skipped} not searched in all bands ({} decided at the target's own state, \
         {} by a few of the bands, {} by another distance), {} searches ended at the first state nearer than required, {} in full",
        work.distances,
        work.decided_at_own_state,
        work.decided_by_few_bands,
        work.decided_by_another,
        work.decided_on_the_way,
        work.in_full
    )
}
