//! Where and when a vehicle must have decided, so that it stops before it touches what is ahead: by the motion itself, phase by phase.

use super::answer::{Answer, Vector, reach};
use super::json::Json;
use super::topic::Topic;
use crate::reference::Extended;

/// What a vehicle does: speed, the target's own speed along the way, latency, deceleration, margin, time to contact at the start.
type Manoeuvre = [f64; 6];

pub(super) fn topic() -> Topic {
    let manoeuvres: [(&'static str, &'static str, Manoeuvre); 8] = [
        (
            "night",
            "60 km/h towards what stands, as 49 CFR 571.127 tests",
            [60.0 / 3.6, 0.0, 0.5, 5.0, 0.0, 4.0],
        ),
        ("no-latency", "the stopping distance of textbooks", [20.0, 0.0, 0.0, 8.0, 0.0, 6.0]),
        (
            "along",
            "who walks away need only not be closed in upon",
            [65.0 / 3.6, 5.0 / 3.6, 0.5, 7.0, 0.0, 4.0],
        ),
        (
            "towards",
            "who comes walks on until the vehicle stands",
            [6.0 * 0.44704, -5.0 / 3.6, 0.5, 2.0, 0.5, 4.0],
        ),
        ("runs-into-it", "a target that is faster than the vehicle", [2.0, -8.0, 0.3, 1.5, 1.0, 5.0]),
        ("crawl", "where the margin is most of the way", [0.1, 0.0, 0.2, 3.0, 2.0, 60.0]),
        (
            "nearly-as-fast",
            "a closing speed that is a difference of near numbers",
            [20.0, 19.999, 0.5, 5.0, 0.0, 4.0],
        ),
        ("hurry", "just before it is too late", [30.0, 0.0, 0.5, 5.0, 0.0, 3.5 * (1.0 + 1e-9)]),
    ];
    Topic {
        name: "stop",
        title: "Distance and time of a decision, from how a vehicle brakes",
        catches: "the closing speed for the speed or the other way round, braking until the vehicle stands where the target walks \
                  away, a target that stands still while the vehicle brakes, a margin that is left out of the time, a latency that is \
                  driven at half the speed",
        vectors: manoeuvres.into_iter().map(|(id, about, manoeuvre)| of(id, about, manoeuvre)).collect(),
        files: Vec::new(),
    }
}

/// The gap that is closed while the vehicle goes on, then while it brakes, less what the target moves itself.
fn of(id: &'static str, about: &'static str, manoeuvre: Manoeuvre) -> Vector {
    let [speed, target, latency, deceleration, margin, contact] = manoeuvre.map(Extended::from);
    let zero = Extended::zero();
    let inputs = Json::object([
        ("speed_m_s", manoeuvre[0].into()),
        ("target_speed_m_s", manoeuvre[1].into()),
        ("latency_s", manoeuvre[2].into()),
        ("deceleration_m_s2", manoeuvre[3].into()),
        ("margin_m", manoeuvre[4].into()),
        ("time_to_contact_at_start_s", manoeuvre[5].into()),
    ]);
    let closing = &speed - &target;
    // Braking ends when the vehicle is as slow as a target that goes away, or stands.
    let end = if target > zero { target.clone() } else { zero };
    let brake = (&speed - &end) / &deceleration;
    let driven = (speed.square() - end.square()) / (&deceleration + &deceleration);
    let walked = &target * &(&latency + &brake);
    let distance = &speed * &latency + &driven - &walked + &margin;
    let start = &closing * &contact;
    let time = (&start - &distance) / &closing;
    // What differences magnify.
    let magnified = |sum: Extended, value: &Extended| reach(0.0) * (sum / value.abs()).to_f64().max(1.0);
    let of_distance = magnified(&speed * &latency + &driven + walked.abs() + &margin, &distance);
    let of_closing = magnified(&speed + &target.abs(), &closing);
    let of_time = magnified(&start + &distance, &(&start - &distance));
    Vector::new(
        id,
        about,
        inputs,
        [
            ("closing_speed_m_s", Answer::one(&closing, of_closing)),
            ("decision_distance_m", Answer::one(&distance, of_distance.max(of_closing))),
            ("decision_time_s", Answer::one(&time, of_time.max(of_distance).max(of_closing))),
        ],
    )
}
