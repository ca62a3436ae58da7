//! Whether and how well the distance is read from the air, and what that rests on.

use super::AirRangingStudy;
use super::results::{AirFinding, AirPoint, AirSight, AirVerdict};
use crate::Condition;
use crate::range::Overfull;
use crate::rests_on::that_count;
use hadar::error::Result;
use hadar::fisher::precision::Sight;
use hadar::instrument::View;

impl AirRangingStudy {
    pub(super) fn verdict(
        &self,
        at: &AirPoint,
        sight: &AirSight,
        met_between_m: Option<[f64; 2]>,
    ) -> Result<AirVerdict> {
        let distance_m = at.distance_m;
        let demand = self.scenario.requirement;
        let brightest = self.brightest(distance_m)?;
        let overfull = Overfull::of(brightest, &self.camera);
        let reaches = demand.map(|demand| at.sigma_m.is_some_and(|sigma| sigma <= demand.at(distance_m)));
        let met = reaches.map(|reaches| reaches && overfull.is_none());
        let conditions = met.map_or_else(Vec::new, |met| self.conditions(brightest, met));
        let sentence = match (sight.status, at.sigma_m) {
            (Sight::Seen, Some(sigma_m)) => AirFinding::Seen {
                distance_m,
                sigma_m,
                unknown: sight.unknown.clone(),
                demand: demand.zip(met).map(|(demand, met)| (demand, met, met_between_m)),
                overfull: overfull.map(|full| [full.counts, full.full_well]),
                conditions: conditions.clone(),
            },
            (Sight::Unchanged, _) => AirFinding::Unchanged { distance_m },
            _ => AirFinding::Imitated { distance_m, by: sight.blind_direction.clone() },
        };
        Ok(AirVerdict { met, sentence, conditions, accepted: Vec::new() })
    }

    /// Photons of the fullest reading of the target at a distance, with the light of the path.
    pub(super) fn brightest(&self, distance_m: f64) -> Result<f64> {
        let scene = self.scene()?;
        let signal = scene.evaluate(scene.emissivity, &self.state(distance_m), &[], &[], false)?.signal;
        let view = View { signal: signal.clone(), ..View::at(Some(distance_m)) };
        Ok(self.camera.brightest_reading(&signal, &view))
    }

    /// What a verdict rests on: what nobody stated of camera and scene, and what is not among the unknowns.
    fn conditions(&self, brightest: f64, met: bool) -> Vec<Condition> {
        let unknown = self.scenario.unknown;
        let mut found = self.study.unstated(&self.camera, brightest);
        found.extend(unknown.emissivity.is_none().then_some(Condition::EmissivityKnown));
        found.extend(unknown.air_temperature.is_none().then_some(Condition::AirTemperatureKnown));
        that_count(found, met)
    }
}
