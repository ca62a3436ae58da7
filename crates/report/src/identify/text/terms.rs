//! What the camera and the limit are called.

use hadar_study::scenario::DistanceKind;
use hadar_study::study::Study;

/// The camera by its name, where it has one.
pub(super) fn camera(study: &Study) -> &str {
    match study.camera().map(|camera| camera.name.as_str()) {
        None | Some("camera") => "the camera",
        Some(name) => name,
    }
}

/// What must be added to an answer that is not by the nearest distance.
pub(super) fn no_limit(study: &Study) -> &'static str {
    match study.scenario().requirement.by {
        DistanceKind::Nearest => "",
        DistanceKind::Local => ", by the local distance, which is no limit and can err either way",
        DistanceKind::LocalUnknownGain => {
            ", by the local distance with unknown gain (S29), which is no limit"
        }
    }
}
