//! Tables of a rule about braking (`[stop]`) and about stand-ins for people (`[stand_in]`).

use super::key::Silent::{Is, Means, Refused};
use super::key::{
    A_SHARE, KELVIN, Key, LENGTH, LENGTH_FROM_ZERO, MATERIALS, SPEED, TIME, Table, Value, WAVENUMBER,
};
use hadar::allowed::{ABOVE_ZERO, Allowed, FROM_ZERO};
use hadar::units::Dimension;

const ANY: Allowed = Allowed { holds: |_| true, expected: "a finite number" };
const STOP_KEYS: &[Key] = &[
    Key::row(
        "speed",
        Value::Either(&[SPEED, Value::Pair(&SPEED)]),
        Refused,
        "\"60 km/h\" or [\"10 km/h\", \"60 km/h\"]",
        "Speed of the vehicle, or a range of speeds.",
        "stopping distance v t + v^2/(2 a); motion blur",
    ),
    Key::row(
        "latency",
        Value::Quantity(Dimension::Time, FROM_ZERO),
        Refused,
        "\"0.5 s\"",
        "Time from the decision until the brakes act.",
        "stopping distance v t + v^2/(2 a)",
    ),
    Key::row(
        "deceleration",
        Value::Quantity(Dimension::Acceleration, ABOVE_ZERO),
        Refused,
        "\"5 m/s^2\"",
        "How hard the vehicle brakes.",
        "stopping distance v t + v^2/(2 a)",
    ),
    Key::row(
        "margin",
        LENGTH_FROM_ZERO,
        Is("\"0 m\""),
        "\"1 m\"",
        "How far before the target the vehicle must stand.",
        "added to the stopping distance",
    ),
    Key::row(
        "start",
        Value::Either(&[TIME, LENGTH]),
        Means("the target is in view all the time"),
        "\"4 s\"",
        "Where the target comes into view: a time before contact, or a distance.",
        "time that is left for looking",
    ),
    Key::row(
        "target_speed",
        Value::Quantity(Dimension::Speed, ANY),
        Is("\"0 m/s\""),
        "\"5 km/h\"",
        "Speed of the target along the way, away from the vehicle.",
        "closing speed",
    ),
    Key::row(
        "closing_speed",
        SPEED,
        Means("speed less target_speed"),
        "\"50 km/h\"",
        "Speed at which vehicle and target come together.",
        "closing speed",
    ),
    Key::row(
        "crossing_speed",
        Value::Quantity(Dimension::Speed, FROM_ZERO),
        Means(
            "nothing is known of its way: the target does not cross, a condition, and blurs as at the edge of the view",
        ),
        "\"5 km/h\"",
        "How fast the target crosses the way; 0 of one that stands on it.",
        "motion blur, and whether the target is in the view until the decision",
    ),
    Key::row(
        "offset",
        LENGTH_FROM_ZERO,
        Means("1 m, where crossing_speed is stated"),
        "\"0.5 m\"",
        "Largest distance from the camera's axis at which target and vehicle would meet.",
        "bearing of the target until the decision",
    ),
];
/// `[stop]`.
pub(crate) static STOP: Table =
    Table::of("How the vehicle comes to a stop, from which the distances of the rule follow.", &[STOP_KEYS]);

const BELOW_ONE: Value =
    Value::Number(Allowed { holds: |value| (0.0..1.0).contains(&value), expected: "from 0 to below 1" });
const STAND_IN_KEYS: &[Key] = &[
    Key::row(
        "clause",
        Value::Text,
        Means("the only one that distinguishes people"),
        "\"crossing\"",
        "The clause whose limit is turned round.",
        "scenes in which no camera may tell the stand-in",
    ),
    Key::row(
        "materials",
        MATERIALS,
        Means("those of the target"),
        "[\"skin\"]",
        "What it may be made of.",
        "emissivity of the stand-in",
    ),
    Key::row(
        "temperature",
        KELVIN,
        Means("that of the target"),
        "\"33 degC\"",
        "Its temperature.",
        "about which the tolerance lies",
    ),
    Key::row(
        "emissivity",
        Value::List(&BELOW_ONE),
        Is("[0.0, 0.005, 0.01, 0.02, 0.03, 0.05]"),
        "[0.0, 0.01, 0.02]",
        "Tolerances of its emissivity, for each of which the tolerance of its temperature is found.",
        "the distance stays below the demand for all errors within",
    ),
    Key::row(
        "emissivity_error",
        Value::Either(&[A_SHARE, Value::Text]),
        Means("exactly the shape of its material"),
        "\"0.005 absolute\"",
        "Root mean square error of the shape of its spectrum, absolute: 0.005 of 1.",
        "59 shapes are drawn; the least tolerance of all is one that 95 % of all shapes have",
    ),
    Key::row(
        "correlation",
        WAVENUMBER,
        Means("10 cm^-1 with emissivity_error"),
        "\"50 cm^-1\"",
        "Difference of wavenumbers over which these errors lose their correlation.",
        "covariance s^2 exp(-|dnu|/l)",
    ),
];
/// `[stand_in]`.
pub(crate) static STAND_IN: Table =
    Table::of("What is to pass for a person where cameras are tested.", &[STAND_IN_KEYS]);
