//! How well the distance can be read from the air, in a sentence.

mod text;

pub use text::text;
pub(crate) use text::{one_reading, window, without_sky};

use super::demand::error_of;
use super::range::saturates;
use super::text::numbers::in_a_row;
use super::{Say, conditions};
use hadar::words::{length, significant};
use hadar_study::air_ranging::{AirFinding, BlindChange};

impl Say for AirFinding {
    fn say(&self) -> String {
        match self {
            Self::Seen { distance_m, sigma_m, unknown, demand, overfull, conditions } => {
                let start = match (demand, overfull) {
                    (None, None) => "At".to_owned(),
                    (None, Some(full)) => format!("If all could be counted, where {}, at", saturates(*full)),
                    (Some(_), Some(full)) => {
                        format!("No, as {}; if all could be counted, at", saturates(*full))
                    }
                    (Some((_, true, _)), _) => conditions::yes(conditions).replacen('y', "Y", 1) + ": at",
                    (Some((_, false, _)), _) => "No: at".to_owned(),
                };
                let mut out = format!(
                    "{start} {} m the distance is known to +- {} at best",
                    significant(*distance_m, 3),
                    length(*sigma_m)
                );
                if sigma_m > distance_m {
                    out += ", which is more than itself, so not at all,";
                }
                out += " from one pixel and one reading";
                out += &match in_a_row(unknown, "and") {
                    none if none.is_empty() => ", all else known".into(),
                    names => format!(", {names} unknown"),
                };
                if let Some((demand, _, met_between_m)) = demand {
                    out += &format!(" ({} demanded", error_of(*demand));
                    out += &match met_between_m {
                        Some([near, far]) => {
                            format!(", met from {} to {} m)", significant(*near, 3), significant(*far, 3))
                        }
                        None => ", met at no distance asked for)".into(),
                    };
                }
                out + "."
            }
            Self::Unchanged { distance_m } => format!(
                "At {} m no band holds information on the distance: the target looks like the air, so that more or less of it changes nothing.",
                significant(*distance_m, 3)
            ),
            Self::Imitated { distance_m, by } => {
                format!(
                    "At {} m no band holds information on the distance: {}.",
                    significant(*distance_m, 3),
                    imitated(by)
                )
            }
        }
    }
}

/// What imitates a change of the distance.
fn imitated(by: &[BlindChange]) -> String {
    let change = |change: &BlindChange| {
        format!("{} by {} per metre", change.unknown, significant(change.change_per_m, 2))
    };
    match by.len() {
        0 => "other unknowns imitate any change of it".into(),
        1..=4 => {
            let changes: Vec<String> = by.iter().map(change).collect();
            format!("a change of {} imitates any change of it", changes.join(", "))
        }
        more => format!("changes of {more} unknowns together imitate any change of it"),
    }
}
