//! What the members of classes say together: table, picture.

use crate::figures::Plot;
use crate::plot::{Axis, Figure, Matrix, NamedSeries, NamedValues};
use crate::table::{Table, number, optional};
use crate::text::significant;
use crate::words::classes::LIGHTEST;
use crate::words::pictures;
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

/// Most series side by side; more members on both sides are a matrix.
const SERIES: usize = 4;

fn picture(answer: &ClassAnswer, place: Option<usize>) -> Plot {
    let sides = [&answer.target.members, &answer.alternative.members].map(|names| Group::of(names));
    let figure = if sides.iter().any(|groups| groups.len() <= SERIES) {
        dots(answer, &sides).into()
    } else {
        Figure::from(matrix(answer))
    };
    // Two alternatives may have the same name.
    let name = place.map_or_else(
        || "class_pairs".to_owned(),
        |place| format!("class_pairs_{place}_{}", answer.alternative.name),
    );
    Plot { name: name.into(), figure, table: table(std::slice::from_ref(answer)) }
}

/// Members of one material: samples, whose numbers say nothing to a reader.
struct Group {
    name: String,
    members: Vec<usize>,
}

impl Group {
    fn of(members: &[String]) -> Vec<Self> {
        let mut groups: Vec<Self> = Vec::new();
        for (i, member) in members.iter().enumerate() {
            let own = member.split_once('/').map_or(member.as_str(), |(_, own)| own);
            let name = own.split_once('@').map_or(own, |(name, _)| name);
            match groups.iter_mut().find(|group| group.name == name) {
                Some(group) => group.members.push(i),
                None => groups.push(Self { name: name.to_owned(), members: vec![i] }),
            }
        }
        groups
    }

    fn said(&self) -> String {
        match self.members.len() {
            1 => self.name.clone(),
            samples => format!("{} ({samples} samples)", self.name),
        }
    }
}

/// The axis of distances.
fn axis(answer: &ClassAnswer) -> Axis {
    Axis::log(if answer.statistical { "statistical distance d" } else { "distance (per √photon)" })
}

fn title(answer: &ClassAnswer) -> String {
    format!("Which {} is hardest to distinguish from which {}?", answer.target.name, answer.alternative.name)
}

/// The side of more materials as rows, the other one as symbols: of samples of one material the nearest.
fn dots(answer: &ClassAnswer, sides: &[Vec<Group>; 2]) -> NamedValues {
    let [targets, alternatives] = sides;
    let turned = targets.len() > alternatives.len();
    let (rows, series) = if turned { (targets, alternatives) } else { (alternatives, targets) };
    let distance = |row: &Group, of: &Group| {
        let pairs = row.members.iter().flat_map(|r| of.members.iter().map(move |s| (*r, *s)));
        let exact = pairs.filter_map(|(r, s)| {
            let (a, b) = if turned { (r, s) } else { (s, r) };
            answer.distances.pair(a, b)?.distance
        });
        exact.fold(f64::NAN, f64::min)
    };
    // The nearest first.
    let nearest = |row: &Group| series.iter().map(|of| distance(row, of)).fold(f64::INFINITY, f64::min);
    let mut rows: Vec<&Group> = rows.iter().collect();
    rows.sort_by(|a, b| nearest(a).total_cmp(&nearest(b)));
    let names = rows.iter().map(|row| row.said()).collect();
    let mut figure = NamedValues::new(title(answer), names, axis(answer)).no_value(pictures::FARTHER);
    if sides.iter().flatten().any(|group| group.members.len() > 1) {
        figure = figure.subtitle(pictures::NEAREST_OF_SAMPLES);
    }
    for of in series {
        figure =
            figure.series(NamedSeries::new(of.said(), rows.iter().map(|row| distance(row, of)).collect()));
    }
    match answer.required {
        Some(required) => figure
            .threshold(required, format!("required: {}", significant(required, 3)))
            .below("not distinguished"),
        None => figure,
    }
}

fn matrix(answer: &ClassAnswer) -> Matrix {
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
    let short = |names: &[String]| -> Vec<String> {
        names
            .iter()
            .map(|name| name.split_once('/').map_or(name.as_str(), |(_, own)| own).to_owned())
            .collect()
    };
    let mut figure = Matrix::new(
        title(answer),
        (format!("{}, the target", answer.target.name), short(rows)),
        (format!("{}, the alternative", answer.alternative.name), short(columns)),
        (axis(answer).range(least, if most > 1.01 * least { most } else { 2.0 * least }), values),
    );
    if answer.pairs > answer.searched {
        figure = figure.subtitle(LIGHTEST);
    }
    if let Some(required) = answer.required {
        let label = format!("not distinguished: d below {}", significant(required, 3));
        figure = figure.threshold(required, label);
    }
    figure
}
