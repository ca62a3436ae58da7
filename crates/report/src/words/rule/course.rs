//! The approach to a decision, in words.

use crate::text::numbers::significant;
use hadar::words::length;
use hadar_scenario::Units;
use hadar_study::Course;

pub(crate) const MARGIN: &str = "d over required d";
pub(crate) const DEMANDED: &str = "demanded";
pub(crate) const AT_MOST: &str = "1 pixel";
pub(crate) const BLUR: &str = "blur (pixels)";
pub(crate) const EVERY_CAMERA: &str = "decided then";
pub(crate) const DECISION: &str = "decision";
pub(crate) const TIME: &str = "time to contact without braking (s)";
pub(crate) const DISTANCE: &str = "distance (m)";

/// What a picture of a course is about.
pub(crate) fn title(course: &Course, units: Units) -> String {
    let speed = units.speed(course.decision.speed_m_s);
    match &course.clause {
        Some(clause) => format!("{clause}: the approach at {speed}"),
        None => format!("The approach at {speed}"),
    }
}

/// Below that; `told` where anything is told apart.
pub(crate) fn below(course: &Course, told: bool) -> String {
    let told = match (told, course.tells_apart) {
        (true, _) => {
            "d is the statistical distance in the scene that limits each camera; it begins where the camera has read its frames, as if all were taken there, and is drawn while the target is in view. "
        }
        (false, true) => "No camera has read its frames while the target is still in view. ",
        (false, false) => "",
    };
    format!(
        "{told}The decision is due {} m ahead; one that comes later leaves the closing speed of the last panel at contact.",
        significant(course.decision.distance_m, 3)
    )
}

/// The axis of pixels.
pub(crate) fn pixels(size_m: f64) -> String {
    format!("pixels across {}", length(size_m))
}

/// The axis of what braking still does.
pub(crate) fn impact(unit: &str) -> String {
    format!("speed at contact ({unit})")
}
