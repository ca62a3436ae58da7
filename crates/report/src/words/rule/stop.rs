//! How a vehicle comes to a stop, and what a camera sees until then, in words.

use crate::text::numbers::{quantity, significant};
use hadar_scenario::Units;
use hadar_study::{ApproachResult, StopResult};

/// Where and when the decision must stand.
pub(super) fn decisions(stop: &StopResult, units: Units) -> String {
    let (slow, fast) = (stop.slowest, stop.fastest);
    let mut said = match slow.speed_m_s == fast.speed_m_s {
        true => format!(
            "at {} the decision is due {} ahead",
            units.speed(fast.speed_m_s),
            metres(fast.distance_m, units)
        ),
        false => format!(
            "at {} to {} the decision is due {} to {} ahead",
            units.speed(slow.speed_m_s),
            units.speed(fast.speed_m_s),
            metres(slow.distance_m, units),
            metres(fast.distance_m, units)
        ),
    };
    if fast.closing_m_s != fast.speed_m_s {
        said += &format!(" (closing speed {})", units.speed(fast.closing_m_s));
    }
    if let Some(one) = stop.hastiest
        && let Some((start_m, time_s)) = one.start_m.zip(one.time_s)
    {
        said += &format!(
            ", {} s after the target comes into view at {}",
            significant(time_s, 3),
            metres(start_m, units)
        );
        if slow.speed_m_s != fast.speed_m_s {
            said += &format!(" (at {}, which leaves least)", units.speed(one.speed_m_s));
        }
    }
    if let Some(crossing) = &stop.crossing {
        let way = match crossing.speed_m_s {
            0.0 => "the target is".to_owned(),
            speed => format!("the target, which crosses at {}, is", units.speed(speed)),
        };
        let bearing = significant(crossing.bearing_rad.to_degrees(), 3);
        said += &format!("; {way} up to {bearing} deg off the axis until then");
    }
    said
}

/// What one camera does in that time.
pub(super) fn approach(approach: &ApproachResult, units: Units) -> String {
    let frames = |count: u32| if count == 1 { "1 frame".to_owned() } else { format!("{count} frames") };
    let take = if approach.frames_needed == 1 { "takes" } else { "take" };
    let needed = format!(
        "{} of all bands {take} {}",
        frames(approach.frames_needed),
        quantity(approach.needed_s, "s")
    );
    let fit = match (approach.frames_within, approach.time_s) {
        (Some(0), Some(time_s)) => format!("; not one fits into {} s", significant(time_s, 3)),
        (Some(1), Some(time_s)) => format!("; 1 fits into {} s", significant(time_s, 3)),
        (Some(within), Some(time_s)) => format!("; {within} fit into {} s", significant(time_s, 3)),
        _ => String::new(),
    };
    let outside = match approach.in_view_from_m_s {
        Some(Some(speed)) => {
            format!("; the target can be seen in time from {} on", units.speed(speed))
        }
        Some(None) => "; the target is not in its view in time".to_owned(),
        None => String::new(),
    };
    format!(
        "{needed}{fit}; the first is seen from {}; a pixel sees {} where the decision is due{outside}",
        metres(approach.seen_from_m, units),
        units.length(approach.footprint_m)
    )
}

/// A distance to three digits: people measure it on the ground.
pub(super) fn metres(metres: f64, units: Units) -> String {
    match units.length(1.0).ends_with(" m") {
        true => format!("{} m", significant(metres, 3)),
        false => units.length(metres),
    }
}
