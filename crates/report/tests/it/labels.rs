//! Words of up to [`LONGEST`] letters, even one word without a joint, are in the picture whole, whatever they name.

use crate::support::figures::{check_png, check_svg};
use hadar_report::plot::{
    Axis, Band, Figure, HeatMap, LineFigure, Marker, Matrix, NamedSeries, NamedValues, Panel, Picture,
    Pictures, Rule, Series, render_png, render_svg,
};
use hadar_testing::seeded;
use proptest::prelude::*;

/// Letters of the longest name; a single word of some 80 does not fit everywhere.
const LONGEST: usize = 60;

/// A name of about so many letters: words of a few, or one word without any joint.
fn name(letters: usize, in_words: bool) -> String {
    let letter = |i: usize| if in_words && i % 8 == 7 { ' ' } else { char::from(b'a' + (i * 7 % 26) as u8) };
    let name: String = (0..letters).map(letter).collect();
    name.trim().to_owned()
}

/// The same word in every place that a figure has for words.
fn figures(words: &str) -> Vec<(&'static str, Figure)> {
    let x = || vec![1.0, 2.0, 3.0];
    let axis = || Axis::linear(words);
    let lines = |curves: usize| {
        let mut figure = LineFigure::new(words, axis(), axis())
            .subtitle(words)
            .marker(Marker::new(words, 2.0, 2.0))
            .rule(Rule::horizontal(1.5, words))
            .rule(Rule::vertical(1.2, words))
            .band(Band::new(words, x(), vec![1.0; 3], vec![2.0; 3]));
        for i in 0..curves {
            figure = figure.series(Series::line(format!("{words}{i}"), x(), vec![1.0, 2.0, i as f64]));
        }
        figure
    };
    let below = Panel::new(axis()).series(Series::line(words, x(), x()));
    let names = |count: usize| -> Vec<String> { (0..count).map(|i| format!("{words}{i}")).collect() };
    let matrix = |count: usize| {
        let values = (0..count * count).map(|i| i as f64).collect();
        Matrix::new(words, (words, names(count)), (words, names(count)), (axis(), values))
            .threshold(2.0, words)
    };
    let named = |count: usize| {
        let values: Vec<f64> = (0..count).map(|i| 1.0 + i as f64).collect();
        NamedValues::new(words, names(count), axis())
            .series(NamedSeries::new(words, values.clone()).intervals(values.clone(), values))
            .interval_meaning(words)
            .threshold(2.0, words)
            .below(words)
            .line(1.5, words)
    };
    let map = HeatMap::new(words, (axis(), x()), (axis(), x()), (axis(), (0..9).map(f64::from).collect()))
        .subtitle(words)
        .marker(Marker::new(words, 2.0, 2.0));
    let picture =
        || Picture::new(words, Axis::linear(words), 3, (0..9).map(f64::from).collect()).label(1, 1, words);
    vec![
        ("two curves", lines(2).into()),
        ("seven curves", lines(7).into()),
        ("two panels", lines(3).lower(below).into()),
        ("a small matrix", matrix(3).into()),
        ("a matrix", matrix(12).into()),
        ("a few names", named(3).into()),
        ("many names", named(25).into()),
        ("a map", map.into()),
        ("a picture", Pictures::new(words, vec![picture()]).subtitle(words).into()),
        ("pictures", Pictures::new(words, vec![picture(), picture(), picture()]).into()),
    ]
}

/// All letters of a picture in the order of painting, lines of one name joined.
fn letters(svg: &str) -> String {
    let texts = svg.split("<text ").skip(1).filter_map(|text| text.split_once('>'));
    let lines = texts.filter_map(|(_, rest)| rest.split_once("</text>")).map(|(words, _)| words);
    lines.collect::<String>().replace(' ', "")
}

proptest! {
    #![proptest_config(seeded(7, 10))]

    #[test]
    fn no_letter_of_a_label_is_lost(letters_of in 1usize..LONGEST, in_words: bool) {
        let words = name(letters_of, in_words);
        for (what, figure) in figures(&words) {
            let svg = render_svg(&figure).expect("an SVG");
            check_svg(&svg);
            prop_assert!(!svg.contains('…'), "{what}, {letters_of} letters: cut off");
            prop_assert!(letters(&svg).contains(&words.replace(' ', "")), "{what}, {letters_of} letters: lost");
        }
    }
}

proptest! {
    #![proptest_config(seeded(7, 3))]

    #[test]
    fn no_label_leaves_the_picture(letters_of in 1usize..LONGEST, in_words: bool) {
        for (_, figure) in figures(&name(letters_of, in_words)) {
            check_png(&render_png(&figure).expect("a PNG"));
        }
    }
}
