//! Whether and how well the distance is read from the air.

use super::AirRangingStudy;
use super::results::{AirFinding, AirPoint, AirSight, AirVerdict};
use hadar::fisher::precision::Sight;

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
