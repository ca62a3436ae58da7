//! Rules in memory and what is said of them, for the tests of what rules ask.

use super::folder::SCENARIO;
use hadar::material::Library;
use hadar_scenario::Rule;
use hadar_study::{CameraVerdict, Extent, Found, MeasuredVerdict, RuleAnswer, RuleAsked, RuleStudy};
use std::sync::OnceLock;

/// One camera of 60 Hz before a pedestrian, with the vehicle of 49 CFR 571.127.
pub(crate) const NIGHT: &str = r#"cameras = ["flir-a325sc"]
[target]
material = "skin"
temperature = "33 degC"
[[environment]]
temperature = "10 degC"
lighting = 0.5
[alternatives]
materials = ["aluminium"]
[bands]
ranges = [["8 um", "9 um"], ["9 um", "10 um"], ["11 um", "12 um"]]
[envelope]
temperature = ["25 degC", "37 degC"]
[stop]
speed = "60 km/h"
latency = "0.5 s"
deceleration = "5 m/s^2"
start = "4.0 s"
"#;

pub(crate) fn library() -> &'static Library {
    static LIBRARY: OnceLock<Library> = OnceLock::new();
    LIBRARY.get_or_init(|| Library::embedded().unwrap())
}

#[track_caller]
pub(crate) fn answered(text: &str) -> RuleAnswer {
    let rule = Rule::from_toml(text, None).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let study = RuleStudy::new(&rule, library()).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let asked = RuleAsked { extent: Extent::Margins, ..RuleAsked::default() };
    study.answer(&asked, &|_, _| ()).unwrap()
}

#[track_caller]
pub(crate) fn only(text: &str) -> CameraVerdict {
    answered(text).only().unwrap().cameras[0].clone()
}

#[track_caller]
pub(crate) fn measured(text: &str) -> MeasuredVerdict {
    match &answered(text).clauses[0].found {
        Found::Measured(measured) => measured.cameras[0].clone(),
        Found::Apart(_) => panic!("{text}"),
    }
}

pub(crate) fn close(a: f64, b: f64, relative: f64) -> bool {
    (a - b).abs() <= relative * b.abs()
}

/// A rule of one camera.
pub(crate) fn rule(camera: &str) -> String {
    let scenario = SCENARIO.replace("[camera]\npreset = \"flir-a325sc\"\n", "");
    format!("cameras = [\"{camera}\"]\n{scenario}[envelope]\ntemperature = [\"30 degC\", \"37 degC\"]\n")
}
