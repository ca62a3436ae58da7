//! How well the distance can be read from the air, in a sentence.

use super::AirRangingStudy;
use super::results::{AirFinding, AirPoint, AirSight, AirVerdict, BlindChange};
use crate::words::error_of;
use hadar::fisher::precision::Sight;
use hadar::words::{length, significant};
use serde::{Serialize, Serializer};
use std::fmt::{self, Display, Formatter};

impl AirRangingStudy {
    pub(super) fn verdict(
        &self,
        at: &AirPoint,
        sight: &AirSight,
        met_between_m: Option<[f64; 2]>,
    ) -> AirVerdict {
        let distance_m = at.distance_m;
        let demand = self.scenario.requirement;
        let met = demand.map(|demand| at.sigma_m.is_some_and(|sigma| sigma <= demand.at(distance_m)));
        let sentence = match (sight.status, at.sigma_m) {
            (Sight::Seen, Some(sigma_m)) => AirFinding::Seen {
                distance_m,
                sigma_m,
                unknown: sight.unknown.clone(),
                demand: demand.zip(met).map(|(demand, met)| (demand, met, met_between_m)),
            },
            (Sight::Unchanged, _) => AirFinding::Unchanged { distance_m },
            _ => AirFinding::Imitated { distance_m, by: sight.blind_direction.clone() },
        };
        AirVerdict { met, sentence }
    }
}

impl Display for AirFinding {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Seen { distance_m, sigma_m, unknown, demand } => {
                if let Some((_, met, _)) = demand {
                    f.write_str(if *met { "Yes: " } else { "No: " })?;
                }
                let at = if demand.is_some() { "at" } else { "At" };
                write!(
                    f,
                    "{at} {} m the distance is known to +- {} at best",
                    significant(*distance_m, 3),
                    length(*sigma_m)
                )?;
                if sigma_m > distance_m {
                    f.write_str(", which is more than itself, so not at all,")?;
                }
                f.write_str(" from one pixel and one reading")?;
                match unknown.split_last() {
                    None => f.write_str(", all else known")?,
                    Some((last, [])) => write!(f, ", {last} unknown")?,
                    Some((last, others)) => write!(f, ", {} and {last} unknown", others.join(", "))?,
                }
                if let Some((demand, _, met_between_m)) = demand {
                    write!(f, " ({} demanded", error_of(*demand))?;
                    match met_between_m {
                        Some([near, far]) => {
                            write!(f, ", met from {} to {} m)", significant(*near, 3), significant(*far, 3))?;
                        }
                        None => f.write_str(", met at no distance asked for)")?,
                    }
                }
                f.write_str(".")
            }
            Self::Unchanged { distance_m } => write!(
                f,
                "At {} m nothing tells the distance: the target looks like the air, so that more or less of it changes nothing.",
                significant(*distance_m, 3)
            ),
            Self::Imitated { distance_m, by } => {
                write!(f, "At {} m nothing tells the distance: ", significant(*distance_m, 3))?;
                let change = |change: &BlindChange| {
                    format!("{} by {} per metre", change.unknown, significant(change.change_per_m, 2))
                };
                match by.len() {
                    0 => f.write_str("other unknowns imitate any change of it")?,
                    1..=4 => {
                        let changes: Vec<String> = by.iter().map(change).collect();
                        write!(f, "a change of {} imitates any change of it", changes.join(", "))?;
                    }
                    more => write!(f, "changes of {more} unknowns together imitate any change of it")?,
                }
                f.write_str(".")
            }
        }
    }
}

impl Serialize for AirFinding {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}
