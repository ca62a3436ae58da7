//! Classifiers against the limit: over photons, or side by side at one number of them.

use crate::figures::{Plot, information_axis};
use crate::plot::{Axis, Band, LineFigure, NamedSeries, NamedValues, Panel, Rule, Series, Style};
use crate::table::{Table, number, optional};
use crate::text::significant;
use hadar::identifiability::detection;
use hadar_simulate::classifier::Method;
use hadar_simulate::experiment::Performance;
use hadar_study::{NoiseCurves, SimulatedPerformance, SimulatedPoint, Simulation};

const LIMIT_COLOUR: usize = 0;

/// All experiments and classifiers as a table, a row each.
#[must_use]
pub fn simulation_table(result: &Simulation) -> Table {
    let rows: Vec<(&SimulatedPoint, &SimulatedPerformance)> = result
        .points
        .iter()
        .flat_map(|point| point.performances.iter().map(move |found| (point, found)))
        .collect();
    Table::of(
        &rows,
        &[
            ("photons", &|(point, _)| number(point.photons)),
            ("normalised_photons_n_d0_squared", &|(point, _)| number(point.normalised_photons)),
            ("gamma_per_band", &|(point, _)| number(point.gamma)),
            ("statistical_distance", &|(point, _)| number(point.statistical_distance)),
            ("statistical_distance_local", &|(point, _)| number(point.statistical_distance_local)),
            ("limit_accuracy", &|(point, _)| optional(point.limit_accuracy)),
            ("limit_accuracy_many_photons", &|(point, _)| number(point.limit_accuracy_normal)),
            ("accuracy_promised_by_local_distance", &|(point, _)| number(point.local_accuracy)),
            ("classifier", &|(_, found)| found.performance.name()),
            ("accuracy", &|(_, found)| number(found.performance.accuracy)),
            ("accuracy_low", &|(_, found)| number(found.performance.interval.low)),
            ("accuracy_high", &|(_, found)| number(found.performance.interval.high)),
            ("information_bits", &|(_, found)| optional(found.information_bits)),
            ("share_of_photons_used", &|(_, found)| optional(found.photon_share)),
            ("share_of_photons_used_low", &|(_, found)| optional(found.photon_share_low)),
            ("share_of_photons_used_high", &|(_, found)| optional(found.photon_share_high)),
            ("against_the_limit", &|(_, found)| found.standing.map_or("", |standing| standing.name()).into()),
            ("training", &|(_, found)| found.performance.training.clone().unwrap_or_default()),
        ],
    )
}

/// What a figure of experiments over photons shows besides the points.
#[derive(Debug, Clone, Default)]
pub struct SimulationCurves<'a> {
    /// Title.
    pub title: String,
    /// Limits under each kind of noise.
    pub noise: Option<&'a NoiseCurves>,
    /// Another simulation, with the camera's noise say, and what the subtitle says of its points.
    pub other: Option<(&'a Simulation, &'static str)>,
    /// File name without ending.
    pub name: &'static str,
}

/// Information that each classifier retrieves against the normalised photon number, with the limits.
#[must_use]
pub fn classifiers(result: &Simulation, curves: &SimulationCurves<'_>) -> Plot {
    let points = &result.points;
    let x: Vec<f64> = points.iter().map(|point| point.normalised_photons).collect();
    let limit: Vec<f64> = points.iter().map(|point| bits(limit_of(point))).collect();
    let mut figure = LineFigure::new(
        curves.title.clone(),
        photons_axis(result, curves),
        information_axis("information log₂ 2P (bits)"),
    );
    if points.len() > 2 {
        let of = |point: &SimulatedPoint, sign: f64| {
            bits((limit_of(point) + sign * 1.96 * spread(result, point)).clamp(0.5, 1.0))
        };
        let edge = |sign: f64| points.iter().map(|point| of(point, sign)).collect();
        let label = "where 95 % of an ideal classifier's points lie";
        figure = figure.band(Band::new(label, x.clone(), edge(-1.0), edge(1.0)).colour(LIMIT_COLOUR));
    }
    // The limits lie on top of the points.
    for (place, colour, words) in methods(result) {
        figure = figure.series(series(result, place, words).colour(colour));
    }
    if let Some((other, words)) = curves.other {
        figure = figure.subtitle(words);
        for (place, colour, _) in methods(other) {
            figure = figure.series(series(other, place, String::new()).colour(colour));
        }
    }
    match curves.noise {
        Some(noise) => {
            for (i, curve) in noise.curves.iter().enumerate() {
                let style = [Style::Line, Style::Dashed, Style::Dotted, Style::Line][i.min(3)];
                let colour = if i == 0 { CURVE_COLOUR } else { NOISE_COLOUR };
                let label =
                    if i == 0 { "limit, shot noise".to_owned() } else { format!("limit, {}", curve.name) };
                figure = figure.series(
                    Series::line(label, noise.normalised_photons.clone(), curve.information_bits())
                        .style(style)
                        .colour(colour),
                );
            }
        }
        None => {
            figure = figure.series(Series::line("limit", x.clone(), limit).colour(CURVE_COLOUR));
        }
    }
    let promised: Vec<f64> = points.iter().map(|point| bits(point.local_accuracy)).collect();
    figure = figure.series(
        Series::line("what the local distance would have promised", x.clone(), promised)
            .style(Style::Dotted)
            .colour(LOCAL_COLOUR),
    );
    figure = figure.lower(lower(result, curves.other.map(|other| other.0)));
    let criterion = detection::information_bits(1.0);
    figure = figure.rule(Rule::horizontal(criterion, "identifiable: d = 1"));
    Plot { name: curves.name.into(), figure: figure.into(), table: simulation_table(result) }
}

/// Accuracies less the limit, in percentage points: what the information cannot show where points lie on the curve.
fn lower(result: &Simulation, other: Option<&Simulation>) -> Panel {
    let joined = joined(result);
    let of_several = if joined > 1 { format!(", means of {joined}") } else { String::new() };
    let mut panel = Panel::new(Axis::linear(format!("accuracy − limit (percentage points{of_several})")))
        .rule(Rule::horizontal(0.0, ""));
    for result in std::iter::once(result).chain(other) {
        let photons: Vec<f64> = result.points.iter().map(|point| point.normalised_photons.ln()).collect();
        let x: Vec<f64> = means(&photons, joined).into_iter().map(f64::exp).collect();
        let edge = |sign: f64| {
            let spread = |point| sign * 100.0 * 1.96 * spread(result, point) / (joined as f64).sqrt();
            means(&result.points.iter().map(spread).collect::<Vec<_>>(), joined)
        };
        if x.len() > 2 {
            panel = panel.band(Band::new("", x.clone(), edge(-1.0), edge(1.0)).colour(LIMIT_COLOUR));
        }
        for (place, colour, _) in methods(result) {
            let of = |point: &SimulatedPoint| {
                let found = point.performances.get(place);
                found.map_or(f64::NAN, |found| 100.0 * (found.performance.accuracy - limit_of(point)))
            };
            let y = means(&result.points.iter().map(of).collect::<Vec<_>>(), joined);
            let style = if joined > 1 { Style::Marked } else { Style::Points };
            panel = panel.series(Series::line("", x.clone(), y).style(style).colour(colour));
        }
    }
    panel
}

/// More experiments than this are drawn as means of neighbours, so that the classifiers are seen beside each other.
const MOST_POINTS: usize = 40;

/// How many neighbouring experiments are taken together.
fn joined(result: &Simulation) -> usize {
    if result.points.len() > MOST_POINTS { 10 } else { 1 }
}

/// Means of so many neighbours each.
fn means(values: &[f64], joined: usize) -> Vec<f64> {
    values.chunks(joined.max(1)).map(|some| some.iter().sum::<f64>() / some.len() as f64).collect()
}

/// The photon numbers of the experiments, with what is drawn beyond them.
fn photons_axis(result: &Simulation, curves: &SimulationCurves<'_>) -> Axis {
    let points = result.points.iter().chain(curves.other.iter().flat_map(|other| &other.0.points));
    let ends = points.fold((f64::INFINITY, 0.0f64), |(low, high), point| {
        (low.min(point.normalised_photons), high.max(point.normalised_photons))
    });
    let axis = Axis::log("normalised photon number N d₀²");
    let beyond = if curves.noise.is_some() { BEYOND } else { MARGIN };
    if ends.0 < ends.1 { axis.range(ends.0 / MARGIN, beyond * ends.1) } else { axis }
}

/// Curves are drawn to this factor beyond the last experiment.
const BEYOND: f64 = 10.0;
const MARGIN: f64 = 1.3;
const CURVE_COLOUR: usize = 6;
const NOISE_COLOUR: usize = 2;
const LOCAL_COLOUR: usize = 6;

/// Each classifier's colour, the same in every figure.
fn method_colour(method: Method) -> usize {
    match method {
        Method::LikelihoodRatio => 0,
        Method::BestFits => 3,
        Method::Discriminant => 4,
        Method::Logistic => 5,
        Method::Network => 1,
    }
}

/// The classifiers, the optimum last so that it is drawn on top: each by its place, colour and name.
fn methods(result: &Simulation) -> Vec<(usize, usize, String)> {
    let first = result.points.first().map(|point| point.performances.as_slice());
    let all = first.unwrap_or_default().iter().enumerate();
    let named = |(i, found): (usize, &SimulatedPerformance)| {
        (i, method_colour(found.performance.method), found.performance.words())
    };
    all.map(named).rev().collect()
}

fn series(result: &Simulation, place: usize, label: String) -> Series {
    let of = |point: &SimulatedPoint| {
        let bits = point.performances.get(place).and_then(|found| found.information_bits);
        bits.map_or(f64::NAN, |bits| bits.max(0.0))
    };
    let x = result.points.iter().map(|point| point.normalised_photons).collect();
    Series::points(label, x, result.points.iter().map(of).collect()).pale()
}

/// The deviation of the accuracy of an ideal classifier: two classes of so many test spectra each.
fn spread(result: &Simulation, point: &SimulatedPoint) -> f64 {
    let (p, spectra) = (limit_of(point), result.spectra_per_class);
    (p * (1.0 - p) / (2.0 * (spectra - 2 * (spectra / 4)) as f64)).sqrt()
}

fn limit_of(point: &SimulatedPoint) -> f64 {
    point.limit_accuracy.unwrap_or(point.limit_accuracy_normal)
}

fn bits(probability: f64) -> f64 {
    (2.0 * probability).log2()
}

/// Accuracies of all classifiers in one experiment, beside the limit.
#[must_use]
pub fn accuracies(result: &Simulation, point: &SimulatedPoint, pair: &str) -> Plot {
    let found = || point.performances.iter().map(|found| &found.performance);
    let values = found().map(|performance| performance.accuracy).collect();
    let intervals = (
        found().map(|performance| performance.interval.low).collect(),
        found().map(|performance| performance.interval.high).collect(),
    );
    let figure = NamedValues::new(
        format!("How often is each classifier right? {pair}"),
        found().map(Performance::words).collect(),
        Axis::linear("share of correct decisions, averaged over the classes"),
    )
    .series(NamedSeries::new("balanced accuracy", values).intervals(intervals.0, intervals.1))
    .interval_meaning(format!("{} % interval", 100.0 * result.level));
    let classes = point.classes.len().max(2);
    let chance = 1.0 / classes as f64;
    let figure = figure.line(chance, format!("guessing among {classes}: {}", significant(chance, 3)));
    let figure = match point.limit_accuracy {
        Some(limit) => figure.line(limit, format!("limit of the likelihood ratio: {limit:.4}")),
        None => figure,
    };
    Plot { name: "accuracies".into(), figure: figure.into(), table: simulation_table(result) }
}

/// Limits under each kind of noise over all photon numbers, without experiments.
#[must_use]
pub fn noise_limits(noise: &NoiseCurves, title: &str, table: Table) -> Plot {
    let mut figure = LineFigure::new(
        title,
        Axis::log("normalised photon number N d₀²"),
        information_axis("information log₂ 2P (bits)"),
    )
    .rule(Rule::horizontal(detection::information_bits(1.0), "identifiable: d = 1"));
    for (i, curve) in noise.curves.iter().enumerate() {
        let style = [Style::Line, Style::Dashed, Style::Dotted, Style::Line][i.min(3)];
        let series = Series::line(curve.name, noise.normalised_photons.clone(), curve.information_bits());
        figure = figure.series(series.style(style).colour(i));
    }
    Plot { name: "noise_curves".into(), figure: figure.into(), table }
}
