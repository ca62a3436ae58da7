//! What the camera and the limit are called.

use hadar_scenario::DistanceKind;
use hadar_study::Study;

/// The camera by its name, where it has one.
pub(super) fn camera(study: &Study) -> &str {
    match study.camera().map(|camera| camera.name.as_str()) {
        None | Some("camera") => "the camera",
        Some(name) => name,
    }
}

/// What must be added to an answer that is not by the nearest distance.
pub(super) fn no_limit(study: &Study) -> String {
    crate::words::size::no_limit(study.scenario().requirement.by)
        .map_or_else(String::new, |reading| format!(", by {reading}"))
}

/// That it is not told apart: a limit forbids it, a reading that is none does not.
pub(super) fn does_not_tell(study: &Study) -> &'static str {
    if study.scenario().requirement.by == DistanceKind::Nearest { "cannot tell" } else { "does not tell" }
}
