//! What the camera and the limit are called.

use hadar_scenario::{DistanceKind, Scope};
use hadar_study::Study;

/// The camera by its name, where it has one.
pub(super) fn camera(study: &Study) -> &str {
    match study.camera().map(|camera| camera.name.as_str()) {
        None | Some("camera") => "the camera",
        Some(name) => name,
    }
}

/// By what materials are told: all pixels of an object, and a reading that is no limit; nothing of a pixel by the nearest.
pub(super) fn told_by(study: &Study) -> String {
    let pixels = match study.scenario().scope() {
        Scope::Object => " by all of its pixels together",
        Scope::Pixel => "",
    };
    format!("{pixels}{}", no_limit(study))
}

/// What must be added to an answer that is not by the nearest distance.
pub(super) fn no_limit(study: &Study) -> String {
    crate::words::size::no_limit(study.scenario().requirement.by)
        .map_or_else(String::new, |reading| format!(", by {reading}"))
}

/// That it is not told apart: a limit forbids it, a reading that is none does not.
pub(super) fn does_not_tell(study: &Study) -> &'static str {
    if study.scenario().requirement.by == DistanceKind::Nearest {
        "cannot distinguish"
    } else {
        "does not distinguish"
    }
}
