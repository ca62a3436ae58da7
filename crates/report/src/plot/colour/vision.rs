//! Colours that stand for different things are told apart by all eyes.

use super::*;
use hadar_testing::vision::{ciede2000, closest};

/// CIEDE2000 below which two categories are refused; neighbours on a picture are told apart from about 2 on.
const APART: f64 = 10.0;

/// Pairs 1, 7, 13, 16, 21 and 25 of Sharma, Wu and Dalal (2005), Table 1.
#[test]
fn distances_are_those_of_the_published_table() {
    for (a, b, expected) in [
        ([50.0, 2.6772, -79.7751], [50.0, 0.0, -82.7485], 2.0425),
        ([50.0, 0.0, 0.0], [50.0, -1.0, 2.0], 2.3669),
        ([50.0, 2.49, -0.001], [50.0, -2.49, 0.0009], 7.1792),
        ([50.0, 2.5, 0.0], [73.0, 25.0, -18.0], 27.1492),
        ([60.2574, -34.0099, 36.2677], [60.4626, -34.1751, 39.4387], 1.2644),
        ([22.7233, 20.0904, -46.6940], [23.0331, 14.9730, -42.5619], 2.0373),
    ] {
        assert!((ciede2000(a, b) - expected).abs() < 1e-4, "{a:?} {b:?}");
        assert!((ciede2000(b, a) - expected).abs() < 1e-4, "{a:?} {b:?}");
    }
}

fn palette() -> Vec<(String, Rgb)> {
    PALETTE.iter().enumerate().map(|(i, colour)| (format!("colour {i}"), colour.rgb)).collect()
}

#[test]
fn no_two_colours_of_curves_look_alike() {
    let found = closest(&palette());
    println!("curves: {found:?}");
    assert!(found.distance >= APART, "{found:?}");
}

/// What it refuses: a red beside a green, which differ by hue alone.
#[test]
fn colours_that_a_deuteranope_confuses_are_refused() {
    let colours = [("brown".to_owned(), (0xA5, 0x5A, 0x2A)), ("green".to_owned(), (0x6B, 0x8E, 0x23))];
    let found = closest(&colours);
    assert!(found.distance < APART && found.eyes != "normal", "{found:?}");
}

#[test]
fn areas_are_told_from_each_other_and_from_no_value() {
    let mut areas: Vec<(String, Rgb)> = (0..PALETTE.len()).map(|i| (format!("area {i}"), area(i))).collect();
    areas.push(("no value".to_owned(), NO_VALUE.rgb));
    let found = closest(&areas);
    println!("areas: {found:?}");
    assert!(found.distance >= APART, "{found:?}");
}

/// The sign of a quantity is seen from a tenth of the scale on, and no value is none of its colours.
#[test]
fn signs_are_told_apart() {
    let at = |fraction: f64| along(&SIGNED, fraction).rgb;
    for half in 1..=10 {
        let off = 0.05 * f64::from(half);
        let pair = [("below".to_owned(), at(0.5 - off)), ("above".to_owned(), at(0.5 + off))];
        let found = closest(&pair);
        assert!(found.distance >= if half < 2 { 5.0 } else { APART }, "{off} {found:?}");
    }
    let middle = [("zero".to_owned(), at(0.5)), ("no value".to_owned(), NO_SIGNED_VALUE.rgb)];
    assert!(closest(&middle).distance >= APART);
}
