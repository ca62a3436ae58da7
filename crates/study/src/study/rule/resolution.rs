//! A clause that demands pixels on the target: n = h f/(z p), h the side of the target (m), f the focal length (m), p the side of
//! a pixel (m), z the distance (m).
//!
//! That is geometry alone: neither optics that blur nor noise are in it. It is least at the greatest distance from which a frame
//! is taken.

use super::approach::Approach;
use super::cameras::Named;
use super::clauses::{Measure, MeasuredAnswer, MeasuredScene, MeasuredVerdict};
use super::results::Grade;
use crate::scenario::rule::{Clause, StopSpec, Verdict};
use crate::study::Shortfall;
use hadar::error::{Error, Result};

/// A clause with its cameras.
#[derive(Debug)]
pub(super) struct Resolution {
    pixels: f64,
    size_m: f64,
    farthest_m: f64,
    stop: Option<StopSpec>,
    /// With the number of its bands.
    cameras: Vec<(Named, usize)>,
}

impl Resolution {
    pub(super) fn new(clause: &Clause, [pixels, size_m]: [f64; 2], cameras: &[Named]) -> Result<Self> {
        let scenario = &clause.scenario;
        let by_stop = clause.stop.map(|spec| spec.stop().decisions()[1].distance_m);
        let farthest_m = by_stop.or(clause.envelope().distance_m.map(|[_, most]| most)).ok_or_else(|| {
            let found = "nothing says how far the target is";
            let instead = "write distance = [\"5 m\", \"30 m\"] in [envelope], or [stop]";
            Error::malformed(found, instead).at(scenario.place("envelope.distance"))
        })?;
        let counted = |named: &Named| Ok((named.clone(), named.bands(scenario)?));
        let cameras = cameras.iter().map(counted).collect::<Result<_>>()?;
        Ok(Self { pixels, size_m, farthest_m, stop: clause.stop, cameras })
    }

    pub(super) fn answer(&self) -> MeasuredAnswer {
        let cameras = self.cameras.iter().map(|(named, bands)| self.judged(named, *bands)).collect();
        let definition = format!(
            "{} pixels across {} at the greatest distance, by geometry alone",
            self.pixels,
            hadar::words::length(self.size_m)
        );
        MeasuredAnswer { quantity: Measure::Pixels, demanded: self.pixels, definition, cameras }
    }

    fn judged(&self, Named { name, camera, .. }: &Named, bands: usize) -> MeasuredVerdict {
        let approach = self.stop.map(|spec| Approach::of(spec.stop(), camera, bands));
        let distance_m = approach.as_ref().map_or(self.farthest_m, |approach| approach.distance_m[1]);
        let value = self.size_m * camera.focal_length_m / (distance_m * camera.pixel_m);
        let mut fails_by = Vec::new();
        if value < self.pixels {
            fails_by.push(Shortfall::Pixels);
        }
        fails_by.extend(approach.as_ref().and_then(Approach::shortfall));
        let passes = fails_by.is_empty();
        MeasuredVerdict {
            name: name.clone(),
            verdict: if passes { Verdict::Meets } else { Verdict::Fails },
            passes,
            fails_by,
            value: Some(value),
            margin: value / self.pixels,
            grade: Grade::Proved,
            limiting: MeasuredScene { distance_m: Some(distance_m), ..MeasuredScene::default() },
            approach: approach.map(|approach| approach.result),
            warnings: Vec::new(),
        }
    }
}
