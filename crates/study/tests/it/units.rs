//! What a person wrote comes back as it was written, and answers speak in the same units.

use hadar::instrument::figures::{Kind, TABLE};
use hadar::units::Dimension;
use hadar_scenario::{RangeScenario, Rule, Scenario, Units};

const SCENARIO: &str = r#"
[target]
material = "skin"
temperature = "98.6 degF"
distance = "100 ft"
size = "20 in"
[background]
temperature = "59 °F"
[[environment]]
temperature = "20 °C"
lighting = 0.5
[[environment]]
temperature = "-4.0 degC"
lighting = 0.25
[alternatives]
temperature = ["0 °C", "250 degF"]
[atmosphere]
model = "us-standard"
temperature = "15 °C"
[bands]
ranges = [["8000 nm", "9 µm"], ["0.0091 mm", "14 um"]]
[unknown]
nuisances = ["temperature", "lighting"]
priors = { temperature = "500 mK", lighting = 0.1 }
[requirement]
speed = "30 mph"
[envelope]
temperature = ["30 °C", "98.6 degF"]
surroundings = ["-10 degC", "30 degC"]
distance = ["16 ft", "0.03 km"]
[sensitivity]
correlation = "1000 m^-1"
"#;

/// Every text of a file stands in what is written, in quotes.
#[track_caller]
fn all_there(texts: impl IntoIterator<Item = String>, written: &str) {
    for text in texts {
        assert!(written.contains(&format!("\"{text}\"")), "{text} is not in\n{written}");
    }
}

#[test]
fn a_scenario_is_written_in_the_units_of_its_author() {
    let mut scenario = Scenario::from_toml(SCENARIO, None).unwrap();
    let texts: Vec<String> = scenario.source.texts.values().cloned().collect();
    let quantities = texts.iter().filter(|text| text.starts_with(|c: char| c.is_ascii_digit() || c == '-'));
    assert_eq!(quantities.count(), 22);
    all_there(texts, &scenario.to_toml());
    assert_eq!(Scenario::from_toml(&scenario.to_toml(), None).unwrap(), scenario);
    // In JSON one unit for each dimension.
    let json = serde_json::to_value(&scenario).unwrap();
    assert_eq!(json["target"]["distance"], format!("{} m", 100.0 * 0.3048));
    // What is no longer what was written is not written so.
    scenario.target.temperature_k = 300.0;
    assert!(scenario.to_toml().contains("temperature = \"300 K\"\ndistance = \"100 ft\""));
}

#[test]
fn every_figure_of_a_camera_is_written_in_the_units_of_its_author() {
    for row in TABLE {
        let Kind::Quantity(dimension, ..) = row.kind else { continue };
        let written = match dimension {
            Dimension::Temperature => "86 °F",
            Dimension::TemperatureDifference => "50000 uK",
            Dimension::Length => "0.012 mm",
            Dimension::Time => "0.0002 min",
            Dimension::Angle => "436 mrad",
            Dimension::Frequency => "0.06 kHz",
            Dimension::Rate => "1000 Hz",
            Dimension::Detectivity => "4.7e10 Jones",
            Dimension::NoiseEquivalentPower => "2.5 pW/Hz^0.5",
            Dimension::SpectralRadiance => "1.5e-6 flick",
            other => panic!("{other:?} of {}: name a unit", row.key),
        };
        let text = format!(
            "[target]\nmaterial = \"skin\"\ntemperature = \"310 K\"\n[camera]\n{} = \"{written}\"\n",
            row.key
        );
        let scenario = Scenario::from_toml(&text, None).unwrap_or_else(|error| panic!("{error}"));
        all_there([written.to_owned()], &scenario.to_toml());
    }
}

#[test]
fn rules_and_ranging_scenarios_keep_their_units_too() {
    let own =
        "[[camera]]\nname = \"a\"\npixel = \"0.012 mm\"\n[[camera]]\nname = \"b\"\npixel = \"17000 nm\"\n";
    let rule = Rule::from_toml(&format!("cameras = [\"flir-a325sc\"]\n{SCENARIO}{own}"), None).unwrap();
    all_there(rule.scenario.source.texts.values().cloned(), &rule.to_toml());
    assert!(rule.to_toml().contains("name = \"b\"\npixel = \"17000 nm\""), "{}", rule.to_toml());
    let text = "[scene]\nperson_temperature = \"98.6 degF\"\ncar_distance = \"60 ft\"\n[camera]\npreset = \"flir-a325sc\"\n\
                [stereo]\nbaseline = \"8 in\"\n[requirement]\ndepth_error = \"1 ft\"\n";
    let range = RangeScenario::from_toml(text, None).unwrap();
    all_there(range.source.texts.values().cloned(), &range.to_toml());
}

#[test]
fn answers_speak_in_the_units_of_the_scenario() {
    let units = Scenario::from_toml(SCENARIO, None).unwrap().units();
    assert_eq!(units.temperature(310.15), "98.60 degF");
    assert_eq!((units.length(30.48), units.speed(13.4112)), ("100 ft".into(), "30.0 mph".into()));
    assert_eq!(units.temperatures([273.15, 310.15]), "32 to 98.6 degF");
    assert_eq!(units.length(0.0254), "1.00 in");
    let metric = Units::default();
    assert_eq!((metric.length(0.05), metric.speed(2.0)), ("50.0 mm".into(), "2.00 m/s".into()));
    assert_eq!(metric.temperature(273.15), "0.00 degC");
}
