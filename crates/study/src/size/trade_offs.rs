//! Two quantities at a time, for the scenario's camera and the limiting alternative.

use crate::Study;
use crate::size::Sizing;
use crate::size::reach::{Reach, SURELY};
use hadar::error::Result;
use hadar::parallel;
use hadar::policy::trade_off::{self, PAIRS, Resolution, TradeOff};
use hadar::policy::{Motion, Quantity, Trial};

impl Study {
    /// The trade-off curves of the pairs in [`trade_off::PAIRS`], against the limiting alternative of `result`; none
    /// without a camera. Those of a speed are left out where the scenario does not say enough for one, those of noise
    /// where the detector has none, those of distance where nothing depends on it (neither size nor air), and all that
    /// have no solution anywhere.
    ///
    /// # Errors
    /// As [`Study::size`].
    pub fn trade_offs(&self, result: &Sizing) -> Result<Vec<TradeOff>> {
        let pairs = self.traded_off();
        let curves = parallel::booked(pairs.len(), |i| self.trade_off(result, pairs[i], Resolution::FINE))?;
        Ok(curves.into_iter().flatten().collect())
    }

    /// The pairs of quantities that are traded off in this scenario, the second solved for along the first.
    #[must_use]
    pub fn traded_off(&self) -> Vec<(Quantity, Quantity)> {
        let Some(camera) = self.camera.as_ref().filter(|_| self.errors_shared().is_none()) else {
            return Vec::new();
        };
        let task = self.task(camera);
        let known = |pair: &(Quantity, Quantity)| match pair.1 {
            Quantity::Speed => Motion::of(camera, task.distance_m).is_some(),
            Quantity::Noise => task.value(Quantity::Noise) > 0.0,
            // Else distance does not matter.
            Quantity::Frames => task.size_m.is_some() || self.scenario.atmosphere.is_some(),
            _ => true,
        };
        PAIRS.into_iter().filter(known).collect()
    }

    /// One of the curves of [`Study::trade_offs`], so finely traced; none where nothing along it suffices, or
    /// without a camera.
    ///
    /// # Errors
    /// As [`Study::size`].
    pub fn trade_off(
        &self,
        result: &Sizing,
        pair: (Quantity, Quantity),
        resolution: Resolution,
    ) -> Result<Option<TradeOff>> {
        let (Some(camera), Some(alternative)) = (&self.camera, self.alternative(&result.limiting)) else {
            return Ok(None);
        };
        let brightest = |trial: &Trial| self.brightest(trial);
        let given = self.circumstances(&brightest);
        let mut solved = result.solve_for.iter().flat_map(|solutions| &solutions.0);
        let alone = solved
            .find(|(quantity, _)| *quantity == pair.0)
            .and_then(|(_, found)| found.value.or(found.necessary));
        // What is proved of the camera is what is solved for, a little more than is asked: so the camera itself does as now.
        let as_now = result.verdict.lower.unwrap_or(0.0) * (1.0 - 2.0 * SURELY);
        let mut reach = Reach::new(self, alternative);
        let curve = trade_off::trace(
            &self.task(camera),
            pair,
            as_now,
            alone,
            &given,
            resolution,
            &mut |task, quantity| reach.solve(task, quantity),
        )?;
        Ok(Some(curve).filter(TradeOff::has_solution))
    }
}
