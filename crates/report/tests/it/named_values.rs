//! Figures of values by name: every row, symbol and explanation is there, and nothing is cut off.

use crate::support::figures::{axis, check_png, check_svg, number, sample, words};
use hadar_report::plot::{Axis, Figure, NamedSeries, NamedValues, render_png, render_svg};
use hadar_testing::seeded;
use proptest::prelude::*;

/// Distances of the first materials of the embedded library (made up), the first ones zero.
fn nearest(count: usize, zeros: usize) -> NamedValues {
    let library = hadar::material::Library::embedded().expect("the embedded library");
    let more = (0..count).map(|i| format!("made-up material {i}"));
    let names: Vec<String> = library.names().map(str::to_owned).chain(more).take(count).collect();
    let value = |i: usize| {
        let x = i as f64;
        if i < zeros { 0.0 } else { 10f64.powf(-3.4 + 0.018 * x + 0.7 * (0.9 * x).sin()) }
    };
    let values = (0..count).map(value).collect();
    NamedValues::new(
        "How far each material is from the one most like it",
        names,
        Axis::log("distance d₀ (per √photon)"),
    )
    .subtitle("nearest distance, target at 37 °C, environment at 20 °C, lighting 0.50, 715–1250 cm⁻¹")
    .series(NamedSeries::new("camera calibrated", values))
    .threshold(6.3e-4, "required: 6.3×10⁻⁴")
    .below("too alike for the camera")
}

fn scaled(values: &[f64], by: impl Fn(usize) -> f64) -> Vec<f64> {
    values.iter().enumerate().map(|(i, value)| value * by(i)).collect()
}

/// As [`nearest`], with intervals.
fn uncertain(count: usize, zeros: usize) -> NamedValues {
    let mut figure = nearest(count, zeros).interval_meaning("central 95 % of the draws");
    let only = figure.series.remove(0);
    let spread = |i: usize| 1.2 + 0.5 * (i as f64).cos().abs();
    let low = scaled(&only.values, |i| 1.0 / spread(i));
    let high = scaled(&only.values, spread);
    figure.series(only.intervals(low, high))
}

/// As [`nearest`] or [`uncertain`], with a second series whose every ninth value is missing.
fn two_series(figure: NamedValues) -> NamedValues {
    let mut second = figure.series[0].clone();
    let factor = |i: usize| if i % 9 == 5 { f64::NAN } else { 0.35 + 0.3 * (1.3 * i as f64).sin() };
    second.label = "gain unknown".to_owned();
    second.values = scaled(&second.values, factor);
    second.intervals = second.intervals.map(|(low, high)| (scaled(&low, factor), scaled(&high, factor)));
    figure.series(second)
}

/// Four series on a linear axis with a range, infinite numbers, a row without value, long names, another axis.
fn named_odds() -> NamedValues {
    let names = ["skin", "a rather long material name, weathered, oxidised and wetted by rain", "", "glass"];
    let row = |values: [f64; 4]| values.to_vec();
    NamedValues::new("Bias of the temperature", names.map(str::to_owned).into(), {
        let ticks = (-2..=2).map(|k| (f64::from(k), format!("{:.1}", f64::from(k) * 1.8))).collect();
        Axis::linear("bias (K)").range(-2.0, 2.0).secondary("bias (°F)", ticks)
    })
    .series(
        NamedSeries::new("one", row([0.0, 1.0, f64::NAN, 5.0]))
            .intervals(row([-1.0; 4]), row([1.0, 9.0, f64::NAN, 9.0])),
    )
    .series(NamedSeries::new("two", row([0.1, 1.0, f64::NAN, f64::INFINITY])))
    .series(NamedSeries::new("three", row([0.0, f64::NAN, f64::NAN, -3.0])))
    .series(NamedSeries::new("four", row([0.0, -1.0, f64::NAN, f64::NEG_INFINITY])))
    .threshold(-0.5, "least bias that is allowed")
    .no_value("not simulated")
}

#[test]
fn sample_figures_are_drawn() {
    for (name, figure) in [
        ("named_1", nearest(1, 0).into()),
        ("named_2", nearest(2, 0).into()),
        ("named_6", uncertain(6, 0).into()),
        ("named_6_two", two_series(uncertain(6, 1)).into()),
        ("named_30", nearest(30, 2).into()),
        ("named_30_uncertain", uncertain(30, 0).into()),
        ("named_70_plain", nearest(70, 0).into()),
        ("named_30_two", two_series(uncertain(30, 2)).into()),
        ("named_70", uncertain(70, 3).into()),
        ("named_70_two", two_series(uncertain(70, 3)).into()),
        ("named_odds", named_odds().into()),
    ] {
        sample(name, &figure);
    }
}

fn named() -> impl Strategy<Value = Figure> {
    let rows = prop::collection::vec((words(), number(), number(), number(), number()), 0..20);
    let threshold = prop::option::of((number(), words()));
    (words(), rows, axis(), 0..6usize, threshold).prop_map(|(title, rows, axis, count, threshold)| {
        let names = rows.iter().map(|row| row.0.clone()).collect();
        let column = |pick: fn(&(String, f64, f64, f64, f64)) -> f64| rows.iter().map(pick).collect();
        let series = |i: usize| {
            let values = column(if i.is_multiple_of(2) { |row| row.1 } else { |row| row.2 });
            let series = NamedSeries::new(format!("{title} {i}"), values);
            if i > 2 { series } else { series.intervals(column(|row| row.3), column(|row| row.4)) }
        };
        let figure = NamedValues::new(&title, names, axis).interval_meaning(&title);
        let figure = (0..count).map(series).fold(figure, NamedValues::series);
        match threshold {
            Some((value, label)) => figure.threshold(value, label).into(),
            None => figure.into(),
        }
    })
}

proptest! {
    #![proptest_config(seeded(7, 100))]

    #[test]
    fn any_numbers_give_a_valid_svg(figure in named()) {
        check_svg(&render_svg(&figure).expect("an SVG"));
    }
}

proptest! {
    #![proptest_config(seeded(7, 6))]

    #[test]
    fn any_numbers_give_a_png_with_nothing_cut_off(figure in named()) {
        check_png(&render_png(&figure).expect("a PNG"));
    }
}

/// Vertical places of the lines of text that are one of these names, in the order of the document.
fn baselines(svg: &str, name: &str) -> Vec<f64> {
    let texts = svg.split("<text ").skip(1).filter(|text| text.contains(&format!(">{name}</text>")));
    texts
        .map(|text| text.split(" y=\"").nth(1).and_then(|rest| rest.split('"').next()?.parse().ok()))
        .map(|y| y.expect("a text has a place"))
        .collect()
}

#[test]
fn named_values_show_every_name_from_the_top_and_a_symbol_for_every_value() {
    let figure = nearest(60, 3);
    let svg = render_svg(&figure.clone().into()).expect("an SVG");
    let places: Vec<f64> = figure
        .names
        .iter()
        .map(|name| match baselines(&svg, name).as_slice() {
            [y] => *y,
            other => panic!("{name}: {other:?}"),
        })
        .collect();
    assert!(places.windows(2).all(|pair| pair[0] < pair[1]));
    // The outer disc of every symbol that has a place on the axis, and that of the legend; the three zeros
    // are arrows, explained by one more.
    let blue = |kind: &str, part: &str| -> usize {
        let start = format!("<path {kind}=\"#0072B2\"");
        svg.lines().filter(|line| line.starts_with(&start)).map(|path| path.matches(part).count()).sum()
    };
    assert_eq!((blue("stroke", "h0"), blue("fill", "z")), (60 - 3 + 1, 3 + 1));
    assert_eq!(baselines(&svg, "0").len(), 1);
    for words in ["required: 6.3×10⁻⁴", "too alike for the camera"] {
        assert_eq!(baselines(&svg, words).len(), 1, "{words}");
    }
    // One series needs no name, more do; without threshold nothing is too alike.
    assert!(!svg.contains(">camera calibrated<"));
    let two = render_svg(&two_series(figure.clone()).into()).expect("an SVG");
    assert!(two.contains(">camera calibrated<") && two.contains(">gain unknown<"));
    let plain = render_svg(&NamedValues { threshold: None, ..figure }.into()).expect("an SVG");
    assert!(!plain.contains("required") && !plain.contains("too alike"));
}

#[test]
fn named_values_without_place_are_explained() {
    let svg = render_svg(&named_odds().into()).expect("an SVG");
    for words in ["not simulated", "∞ or beyond the axis", "−∞ or beyond the axis", "below the threshold"]
    {
        assert_eq!(baselines(&svg, words).len(), 1, "{words}");
    }
}

#[test]
fn nothing_of_named_values_leaves_the_figure() {
    for count in [0, 1, 5, 70, 250] {
        for figure in [nearest(count, 0), two_series(uncertain(count, 2.min(count)))] {
            let long =
                figure.names.iter().map(|name| format!("{name}, weathered and wetted by rain")).collect();
            check_png(&render_png(&NamedValues { names: long, ..figure }.into()).expect("a PNG"));
        }
    }
}

#[test]
fn named_values_of_wrong_length_are_an_error() {
    let figure = nearest(2, 0).series(NamedSeries::new("other", vec![1.0; 3]));
    let error = render_svg(&figure.into()).expect_err("a value too many").to_string();
    assert_eq!(error, "values of the series `other`: 3 values where 2 are needed");
}
