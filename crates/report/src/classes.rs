//! What the members of classes say together: text, table, picture.

use crate::figures::Plot;
use crate::plot::{Axis, Figure, Matrix};
use crate::table::{Table, number, optional};
use crate::text::significant;
use hadar::words::share;
use hadar_study::{ClassAnswer, ClassSide};
use std::fmt::Write as _;

/// Members of a mixture that are named.
const NAMED: usize = 3;

/// Class by class what all pairs of members say.
pub(crate) fn text(answers: &[ClassAnswer]) -> String {
    let mut out = String::new();
    for answer in answers {
        let _ = writeln!(
            out,
            "Classes: {} against {}, {}{}",
            with_spectra(&answer.target),
            with_spectra(&answer.alternative),
            match answer.pairs {
                1 => "one pair of members".to_owned(),
                pairs => format!("{pairs} pairs of members"),
            },
            match answer.searched {
                searched if searched == answer.pairs => String::new(),
                searched => format!(" ({searched} searched, the others are proved to decide nothing)"),
            }
        );
        let mut line = |label: &str, text: String| {
            let _ = writeln!(out, "  {label:<34} {text}");
        };
        let unit = if answer.statistical { "" } else { " per sqrt(photon)" };
        let distance = |d: f64| format!("d = {}{unit}", significant(d, 3));
        let [own, other] = &answer.worst;
        line("hardest pair", format!("{own} against {other}, {}", distance(answer.distance)));
        if let Some(told) = answer.share_of_pairs_told {
            line(
                if answer.mixtures.is_some() {
                    "unmixed pairs that it tells"
                } else {
                    "pairs that the camera tells"
                },
                format!("{} by the members' weights", share(told)),
            );
        }
        if let Some([low, high]) = answer.mean_detection_probability {
            let words = match high - low {
                _ if low > 0.9995 => "above 0.9995".to_owned(),
                open if open < 1e-3 => format!("{low:.3}"),
                _ => format!("{low:.3} to {high:.3}"),
            };
            line("detection probability, mean", words);
        }
        for left in &answer.leave_one_out {
            let words = left.distance.map_or_else(|| "nothing is left".into(), distance);
            line(&format!("without {}", left.member), words);
        }
        let chance = |side: &ClassSide| {
            let chance = ClassAnswer::chance_one_more_is_nearer(side)?;
            Some(format!("1 in {:.0} of {}", 1.0 / chance, side.name))
        };
        let chance = |side: &ClassSide| chance(side).filter(|_| answer.mixtures.is_none());
        let chances: Vec<String> =
            [&answer.target, &answer.alternative].into_iter().filter_map(chance).collect();
        if !chances.is_empty() {
            let words =
                format!("is harder than all with a chance of at most {}, if drawn alike", chances.join(", "));
            line("one more spectrum", words);
        }
        if let Some(found) = &answer.mixtures {
            let parts = |parts: &[(String, f64)]| {
                let named = parts.iter().take(NAMED).map(|(name, part)| format!("{} {name}", share(*part)));
                let more = if parts.len() > NAMED { " and others" } else { "" };
                named.collect::<Vec<_>>().join(", ") + more
            };
            let (low, high) = (significant(found.distance_lower, 3), distance(found.distance));
            line(
                "worst mixture found",
                format!("{high}: {} against {}", parts(&found.target), parts(&found.alternative)),
            );
            line("all mixtures, each part lit anyhow", format!("at least {low}{unit}, proved"));
        }
        out.push('\n');
    }
    out
}

fn with_spectra(side: &ClassSide) -> String {
    match (side.is_class, side.mean) {
        (false, _) => side.name.clone(),
        (true, false) if side.members.len() == 1 => format!("{} (1 spectrum)", side.name),
        (true, false) => format!("{} ({} spectra)", side.name, side.members.len()),
        (true, true) => format!("{} (mean of {} spectra)", side.name, side.spectra),
    }
}

/// Every pair with its distance, or what is proved of it.
pub(crate) fn table(answers: &[ClassAnswer]) -> Table {
    let unit = match answers.first() {
        Some(answer) if answer.statistical => "statistical_distance",
        _ => "distance_per_sqrt_photon",
    };
    let mut table = Table::new([
        "target".to_owned(),
        "alternative".into(),
        "weight".into(),
        unit.into(),
        format!("{unit}_lower"),
    ]);
    for answer in answers {
        for (a, own) in answer.target.members.iter().enumerate() {
            for (b, other) in answer.alternative.members.iter().enumerate() {
                let Some(pair) = answer.distances.pair(a, b) else { continue };
                table.push(vec![
                    own.clone(),
                    other.clone(),
                    number(answer.target.weights[a] * answer.alternative.weights[b]),
                    optional(pair.distance),
                    number(pair.lower),
                ]);
            }
        }
    }
    table
}

/// The distances of all pairs of members; of those that decide nothing what is proved of them.
#[must_use]
pub fn pictures(answers: &[ClassAnswer]) -> Vec<Plot> {
    let drawn = answers.iter().filter(|answer| answer.pairs > 1);
    drawn.enumerate().map(|(i, answer)| picture(answer, (answers.len() > 1).then_some(i + 1))).collect()
}

fn picture(answer: &ClassAnswer, place: Option<usize>) -> Plot {
    let (rows, columns) = (&answer.target.members, &answer.alternative.members);
    let values: Vec<f64> = (0..rows.len())
        .flat_map(|a| (0..columns.len()).map(move |b| (a, b)))
        .map(|(a, b)| {
            let pair = answer.distances.pair(a, b);
            pair.map_or(f64::NAN, |pair| pair.distance.unwrap_or(pair.lower)).max(1e-30)
        })
        .collect();
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    let most = values.iter().copied().fold(0.0, f64::max);
    let axis = if answer.statistical { "statistical distance d" } else { "distance (per √photon)" };
    let beyond = answer.pairs > answer.searched;
    let short = |names: &[String]| -> Vec<String> {
        names
            .iter()
            .map(|name| name.split_once('/').map_or(name.as_str(), |(_, own)| own).to_owned())
            .collect()
    };
    let mut figure = Matrix::new(
        format!("Every {} against every {}", answer.target.name, answer.alternative.name),
        (format!("{}, the target", answer.target.name), short(rows)),
        (format!("{}, the alternative", answer.alternative.name), short(columns)),
        (Axis::log(axis).range(least, if most > 1.01 * least { most } else { 2.0 * least }), values),
    );
    if beyond {
        figure = figure.subtitle(
            "The lightest are proved to be at least as far as is drawn; they decide nothing.".to_owned(),
        );
    }
    if let Some(required) = answer.required {
        let label = format!("not told apart: d below {}", significant(required, 3));
        figure = figure.threshold(required, label);
    }
    // Two alternatives may have the same name.
    let name = place.map_or_else(
        || "class_pairs".to_owned(),
        |place| format!("class_pairs_{place}_{}", answer.alternative.name),
    );
    Plot { name: name.into(), figure: Figure::from(figure), table: table(std::slice::from_ref(answer)) }
}
