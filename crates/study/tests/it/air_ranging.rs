//! Scenarios of ranging by air: what is written is read again, and what is silent.

use hadar_scenario::AirRangingScenario;
use hadar_scenario::air_ranging::{Demand, SmoothEmissivity};

const LEAST: &str = "signal = \"air\"\n[target]\nmaterial = \"skin\"\ntemperature = \"37 degC\"\ndistance = \"50 m\"\n\
                     [atmosphere]\nmodel = \"us-standard\"\n[camera]\npreset = \"flir-a325sc\"\n";

const ALL: &str = r#"title = "How far?"
signal = "air"
[target]
material = "skin"
temperature = "37 degC"
distance = "50 m"
[[environment]]
temperature = "-20 degC"
lighting = 0.5
[atmosphere]
model = "us-standard"
temperature = "12 degC"
[bands]
start = "770 cm^-1"
stop = "1250 cm^-1"
step = "5 cm^-1"
[unknown]
nuisances = ["temperature", "air-temperature", "emissivity"]
priors = { temperature = "2 K", air-temperature = "0.5 K" }
emissivity_error = 0.02
emissivity_correlation = "80 cm^-1"
[camera]
preset = "flir-a325sc"
[distances]
list = ["30 m", "10 m", "30 m"]
[stereo]
baseline = "0.2 m"
window = [3, 7]
texture = 0.01
[requirement]
distance_error = "5 m"
"#;

fn read(text: &str) -> AirRangingScenario {
    AirRangingScenario::from_toml(text, None).unwrap()
}

#[test]
fn what_is_written_is_read_again() {
    for text in [LEAST, ALL] {
        let scenario = read(text);
        let again = read(&scenario.to_toml());
        assert_eq!(again, scenario, "{}", scenario.to_toml());
    }
    let all = read(ALL);
    assert_eq!(all.distances_m, [10.0, 30.0]);
    assert_eq!(all.unknown.air_temperature, Some(Some(0.5)));
    assert_eq!(all.unknown.emissivity, Some(SmoothEmissivity { sigma: 0.02, correlation_cm1: 80.0 }));
    assert_eq!(all.requirement, Some(Demand::Absolute(5.0)));
    assert_eq!(all.stereo.map(|stereo| stereo.window), Some([3, 7]));
    assert!(all.to_toml().contains("air-temperature = \"0.5 K\""), "{}", all.to_toml());
}

#[test]
fn what_is_silent_has_a_default() {
    let least = read(LEAST);
    assert_eq!((least.distances_m.len(), least.distances_m[0], least.distances_m[24]), (25, 5.0, 150.0));
    assert!(least.stereo.is_none() && least.requirement.is_none());
    let emissivity = read(&format!("{LEAST}[unknown]\nnuisances = [\"emissivity\"]\n")).unknown.emissivity;
    assert_eq!(emissivity, Some(SmoothEmissivity { sigma: 0.01, correlation_cm1: 100.0 }));
}

#[test]
fn each_mistake_is_one_line() {
    let message =
        |more: &str| AirRangingScenario::from_toml(&format!("{LEAST}{more}"), None).unwrap_err().to_string();
    for (more, expected) in [
        ("[unknown]\nnuisances = [\"wind\"]\n", "line 11: unknown.nuisances[0]: `wind` is not known here"),
        (
            "[unknown]\nnuisances = []\npriors = { air-temperature = \"1 K\" }\n",
            "line 12: unknown.priors.air-temperature: `air-temperature` is not among unknown.nuisances",
        ),
        ("[distances]\nfrom = \"10 m\"\n", "line 10: distances.to: the key is missing; write to = \"150 m\""),
        ("[distances]\nlist = []\n", "line 11: distances.list: the list is empty"),
        ("[distances]\nlist = [\"nan m\"]\n", "line 11: distances.list[0]: `nan m`"),
        ("[stereo]\nbaseline = \"0 m\"\ntexture = 0.1\n", "line 11: stereo.baseline: `0 m` is out of range"),
        ("[requirement]\n", "line 10: requirement: nothing is demanded"),
        ("[scene]\n", "line 10: there is no key `scene`"),
    ] {
        let message = message(more);
        assert!(message.starts_with(expected), "{more}: {message}");
    }
}
