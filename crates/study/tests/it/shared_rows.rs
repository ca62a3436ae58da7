//! Rows of a sweep share what they have in common; each answers as if it had been asked alone.

use hadar::demand::Skipping;
use hadar::material::Library;
use hadar_scenario::{Setting, Written};
use hadar_study::Remembered;
use hadar_study::sweep::{Asking, Question, Record};
use hadar_testing::seeded;
use proptest::prelude::*;
use proptest::sample::{select, subsequence};
use std::cell::Cell;

const SCENE: &str = "[target]\nmaterial = \"skin\"\ntemperature = \"33 degC\"\ndistance = \"20 m\"\n\
    [[environment]]\ntemperature = \"10 degC\"\nlighting = 0.5\n[alternatives]\nmaterials = [\"aluminium\"]\n\
    [bands]\nranges = [[\"8 um\", \"10 um\"], [\"10 um\", \"12 um\"], [\"12 um\", \"13.5 um\"]]\n\
    [unknown]\nnuisances = [\"temperature\", \"lighting\"]\n[camera]\npreset = \"flir-a325sc\"\n\
    readout = \"sequential\"\n[requirement]\ndistance = 1.0\n";

/// Keys of every table, and what may be set there.
const SET: [(&str, &[&str]); 17] = [
    ("target.temperature", &["30 degC", "36 degC"]),
    ("target.material", &["pmma", "mine.csv", "other.csv"]),
    ("target.distance", &["5 m", "80 m"]),
    ("environment[0].temperature", &["-5 degC", "30 degC"]),
    ("environment[0].lighting", &["0.1", "0.9"]),
    ("environment[0].material", &["asphalt", "mine.csv"]),
    ("background", &["{ temperature = \"5 degC\" }", "{ temperature = \"5 degC\", material = \"asphalt\" }"]),
    ("alternatives.materials", &["[\"pmma\"]", "[\"aluminium\", \"asphalt\"]", "[\"mine.csv\"]"]),
    ("alternatives.temperature", &["[\"0 degC\", \"90 degC\"]"]),
    ("bands.ranges", &["[[\"8 um\", \"11 um\"], [\"11 um\", \"13 um\"]]"]),
    ("bands.tolerance", &["1e-4", "1e-9"]),
    ("unknown.nuisances", &["[\"temperature\"]", "[\"temperature\", \"lighting\", \"gain\"]"]),
    ("camera.exposure", &["1 ms", "20 ms"]),
    ("camera.optics_efficiency", &["0.5", "glass.csv"]),
    ("camera.preset", &["flir-boson-640-14mm"]),
    ("requirement.distance", &["0.01", "3.0"]),
    ("sensitivity.emissivity_error", &["0.001", "0.02"]),
];

/// What is set in a row: some of the keys, each to one of its values.
fn settings() -> impl Strategy<Value = Vec<Setting>> {
    subsequence(SET.to_vec(), 0..=4).prop_flat_map(|keys| {
        let set = keys.into_iter().map(|(key, values)| {
            select(values.to_vec()).prop_map(move |value| Setting {
                key: key.into(),
                value: value.into(),
                by: "--vary",
            })
        });
        set.collect::<Vec<_>>()
    })
}

fn answer(written: &Written, remembered: &Remembered, library: &Library) -> Result<Record, String> {
    let asking = Asking {
        library,
        remembered,
        by: None,
        skip_uncovered: false,
        skipping: Skipping::On,
        seed: 1,
        method: hadar_estimate::decompose::Method::Ml,
        columns: &["verdict", "requirement", "camera", "warnings"].map(str::to_owned),
        voice: |_| String::new(),
    };
    match Question::Size.answer(written, &asking) {
        Ok(answer) => Ok(answer.record),
        Err(error) => Err(error.to_string()),
    }
}

#[test]
fn a_row_is_answered_as_if_it_were_alone() {
    let folder = tempfile::tempdir().unwrap();
    let table = |name: &str, head: &str, values: [f64; 2]| {
        let text = format!("wavelength_um,{head}\n5,{}\n16,{}\n", values[0], values[1]);
        std::fs::write(folder.path().join(name), text).unwrap();
    };
    table("mine.csv", "emissivity", [0.9, 0.8]);
    table("glass.csv", "efficiency", [0.9, 0.6]);
    let (library, path) = (Library::embedded().unwrap(), folder.path().join("scenario.toml"));
    let alone = Written::of(SCENE, Some(&path));
    let (among, remembered) = (alone.clone().parsed(), Remembered::default());
    let (turn, answered) = (Cell::new(0_u32), Cell::new(0));
    let rows = prop::collection::vec(settings(), 1..=3);
    let mut runner = proptest::test_runner::TestRunner::new(seeded(31, 24));
    runner
        .run(&rows, |rows| {
            for set in rows {
                // What a file holds may change between rows.
                turn.set(turn.get() + 1);
                table("other.csv", "emissivity", [0.9, 0.3 + 0.1 * f64::from(turn.get() % 4)]);
                let own = answer(&alone.with(set.clone()), &Remembered::default(), &library);
                prop_assert_eq!(&answer(&among.with(set), &remembered, &library), &own);
                answered.set(answered.get() + u32::from(own.is_ok()));
            }
            Ok(())
        })
        .unwrap();
    let (turn, answered) = (turn.get(), answered.get());
    assert!(answered > turn / 3, "{answered} of {turn} rows were answered");
}
