//! The scene in which a camera is nearest to failing a clause, or fails most, in words.

use super::measured;
use super::stop::metres;
use crate::text::significant;
use crate::words::Say;
use hadar_scenario::Units;
use hadar_study::{CameraVerdict, ClauseAnswer, Found, MeasuredVerdict, NearestState, RuleAnswer};

/// A camera in the hardest scene of a clause.
#[derive(Debug, Clone, serde::Serialize)]
pub(crate) struct HardestScene {
    /// The clause; none of a rule without clauses.
    pub(crate) clause: Option<String>,
    /// Name of the camera in that scene.
    pub(crate) camera: String,
    /// The scene in which the margin is least, in words.
    pub(crate) scene: String,
    /// What there is in it over what is demanded.
    pub(crate) margin: f64,
}

impl Say for HardestScene {
    fn say(&self) -> String {
        let of_clause = self.clause.as_ref().map_or_else(String::new, |name| format!(" ({name})"));
        format!("{}{of_clause}: {}; margin {}", self.camera, self.scene, significant(self.margin, 3))
    }
}

/// Those of every clause and camera, in the order of the answer.
pub(crate) fn hardest_scenes(answer: &RuleAnswer) -> Vec<HardestScene> {
    let units = answer.rule.scenario.units();
    answer.clauses.iter().flat_map(|clause| of_clause(clause, units)).collect()
}

fn of_clause(clause: &ClauseAnswer, units: Units) -> Vec<HardestScene> {
    let one = |camera: &str, margin: f64, scene: String| HardestScene {
        clause: clause.name.clone(),
        camera: camera.to_owned(),
        scene,
        margin,
    };
    match &clause.found {
        Found::Apart(apart) => {
            let of = |own: &CameraVerdict| one(&own.name, own.margin, scene_in_words(own, clause, units));
            apart.cameras.iter().map(of).collect()
        }
        Found::Measured(measured) => {
            let of = |own: &MeasuredVerdict| {
                one(&own.name, own.margin, measured::measured_scene(&own.limiting, units))
            };
            measured.cameras.iter().map(of).collect()
        }
    }
}

/// 'skin of 30 degC, 9 m away, lit by surroundings of 15 degC (V 0.8), against polycarbonate'.
pub(super) fn scene_in_words(camera: &CameraVerdict, clause: &ClauseAnswer, units: Units) -> String {
    let scene = &camera.limiting;
    let mut out = format!("{} of {}", scene.target, units.temperature(scene.temperature_k));
    match scene.distance_m {
        Some(distance) if scene.distance_matters => out += &format!(", {} away", metres(distance, units)),
        Some(_) => out += ", at any distance",
        None => {}
    }
    let lit = scene.surroundings_k.iter().zip(&scene.lighting);
    let lit: Vec<String> = lit
        .map(|(kelvin, factor)| format!("{} (V {})", units.temperature(*kelvin), significant(*factor, 3)))
        .collect();
    if !lit.is_empty() {
        out += &format!(", lit by surroundings of {}", lit.join(" and "));
    }
    let NearestState { temperature_k, lighting, .. } = &scene.nearest_state;
    let mirrored: Vec<String> = lighting.iter().map(|factor| significant(*factor, 3)).collect();
    let mirrored = if mirrored.is_empty() { String::new() } else { format!(", V {}", mirrored.join(" ")) };
    out += &format!(
        ", against {} that looks alike at {}{mirrored}",
        scene.alternative,
        units.temperature(*temperature_k)
    );
    if let Some(stop) = &clause.stop {
        out += &format!(", from a vehicle at up to {}", units.speed(stop.fastest.speed_m_s));
    }
    out
}
