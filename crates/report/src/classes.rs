//! What the members of classes say together: table, picture.

use crate::figures::Plot;
use crate::plot::{Axis, Figure, Matrix};
use crate::table::{Table, number, optional};
use crate::text::significant;
use crate::words::classes::LIGHTEST;
use hadar_study::ClassAnswer;

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
        figure = figure.subtitle(LIGHTEST);
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
