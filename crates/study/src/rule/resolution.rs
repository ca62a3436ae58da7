//! A clause that demands pixels on the target: n = h/(z α), h the side of the target (m), z the distance (m), α what a pixel sees (rad):
//! its side over the focal length, or the view over the pixels across it, where that is coarser.
//!
//! That is geometry alone: neither optics that blur nor noise are in it; pixels that run into each other while a frame is exposed
//! count as one. It is least at the greatest distance from which a frame
//! is taken.

use super::approach::{Approach, Moving, is_timed};
use super::cameras::Named;
use super::clauses::{Definition, Measure, MeasuredAnswer, MeasuredScene, MeasuredVerdict};
use super::uncertainty::{Judged, Uncertain};
use crate::Shortfall;
use crate::grade::Grade;
use crate::rests_on::{diffraction, of_measured};
use crate::warn::contradiction;
use hadar::error::{Error, Result};
use hadar::instrument::Camera;
use hadar::spectrum::Bands;
use hadar_scenario::Rule;
use hadar_scenario::rule::{Clause, StopSpec, Verdict};

/// A clause with its cameras.
#[derive(Debug)]
pub(super) struct Resolution {
    pixels: f64,
    size_m: f64,
    farthest_m: f64,
    stop: Option<StopSpec>,
    moving: Option<Moving>,
    rule: Rule,
    /// With its bands.
    cameras: Vec<(Named, Bands)>,
}

impl Resolution {
    pub(super) fn new(
        rule: &Rule,
        clause: &Clause,
        [pixels, size_m]: [f64; 2],
        cameras: &[Named],
    ) -> Result<Self> {
        let scenario = &clause.scenario;
        let by_stop = clause.stop.map(|spec| spec.stop().decisions()[1].distance_m);
        let farthest_m = by_stop.or(clause.envelope().distance_m.map(|[_, most]| most)).ok_or_else(|| {
            let found = "nothing says how far the target is";
            let instead = "write distance = [\"5 m\", \"30 m\"] in [envelope], or [stop]";
            Error::malformed(found, instead).at(scenario.place("envelope.distance"))
        })?;
        let counted = |named: &Named| Ok((named.clone(), named.read(scenario)?));
        let cameras = cameras.iter().map(counted).collect::<Result<_>>()?;
        let rule = rule.clone();
        Ok(Self { pixels, size_m, farthest_m, stop: clause.stop, moving: Moving::of(clause), rule, cameras })
    }

    pub(super) fn answer(&self) -> Result<MeasuredAnswer> {
        let judged = |(named, bands): &(Named, Bands)| self.judged(named, bands);
        let cameras = self.cameras.iter().map(judged).collect::<Result<_>>()?;
        let definition = Definition::Pixels { pixels: self.pixels, size_m: self.size_m };
        Ok(MeasuredAnswer { quantity: Measure::Pixels, demanded: self.pixels, definition, cameras })
    }

    fn approach(&self, camera: &Camera, bands: usize) -> Option<Approach> {
        self.stop.map(|spec| Approach::of(spec.stop(), camera, bands))
    }

    /// The greatest distance from which a frame is taken, m, and the pixels across the target: from there, or as many as do not run into
    /// each other while a frame is exposed, where that is fewer: the target over its way meanwhile, the same from everywhere, and least at
    /// the highest speed.
    fn reached(&self, camera: &Camera, bands: usize) -> (f64, f64) {
        let approach = self.approach(camera, bands);
        let distance_m = approach.map_or(self.farthest_m, |approach| approach.distance_m[1]);
        let [_, coarser] = camera.pixel_angles_rad();
        let sharp = self.size_m / (distance_m * coarser);
        let smeared = self.moving.and_then(|moving| {
            let fastest = self.stop.map_or(moving.speed_m_s, |spec| {
                let one = spec.stop().decisions()[1];
                one.speed_m_s.max(one.closing_m_s)
            });
            Some(self.size_m / (moving.blur_m(camera, 1)? * fastest / moving.speed_m_s))
        });
        let value = smeared.map_or(sharp, |smeared| sharp.min(smeared));
        (distance_m, value)
    }

    /// Frames that come too late, or of which it cannot be said how they blur.
    fn spoiled(&self, camera: &Camera, bands: usize) -> Vec<Shortfall> {
        let unknown = self.moving.is_some_and(|moving| moving.blur_pixels(camera, 1).is_none());
        let late = self.approach(camera, bands).and_then(|approach| approach.shortfall());
        unknown.then_some(Shortfall::MotionUnknown).into_iter().chain(late).collect()
    }

    fn judged(&self, named: &Named, read: &Bands) -> Result<MeasuredVerdict> {
        let bands = read.len();
        let (distance_m, value) = self.reached(&named.camera, bands);
        let place = |key: &str| self.rule.camera_place(named.index, key);
        let uncertain = Uncertain::of(named, (self.rule.coverage_factor, false), &place)?;
        let (judged, uncertainty) = Uncertain::verdict(
            uncertain,
            value / self.pixels,
            (Shortfall::Pixels, true),
            &named.camera,
            &|camera| self.spoiled(camera, bands),
            &|camera| Ok(self.reached(camera, bands).1 / self.pixels),
        )?;
        let Judged { verdict, fails_by, undecided_by } = judged;
        let passes = verdict == Verdict::Meets;
        let evidence = Grade::Proved.guarded(verdict, uncertainty.as_ref());
        let speed_m_s = self.moving.map(|moving| moving.speed_m_s);
        let set = &self.rule.scenario.source.settings;
        let conditions = of_measured(
            diffraction(&named.camera, read).into_iter().collect(),
            (&named.camera, bands),
            (speed_m_s, is_timed(self.stop.as_ref().map(StopSpec::stop))),
            set,
            passes,
        );
        Ok(MeasuredVerdict {
            name: named.name.clone(),
            verdict,
            passes,
            fails_by,
            undecided_by,
            grade: evidence.under(&conditions),
            evidence,
            uncertainty,
            value: Some(value),
            margin: value / self.pixels,
            limiting: MeasuredScene { distance_m: Some(distance_m), ..MeasuredScene::default() },
            conditions,
            approach: self.approach(&named.camera, bands).map(|approach| approach.result),
            warnings: contradiction(&named.camera).into_iter().collect(),
        })
    }
}
