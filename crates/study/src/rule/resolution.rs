//! A clause that demands pixels on the target: n = h/(z α), h the side of the target (m), z the distance (m), α what a pixel sees (rad):
//! its side over the focal length, or the view over the pixels across it, where that is coarser.
//!
//! That is geometry alone: neither optics that blur nor noise are in it; pixels that run into each other while a frame is exposed
//! count as one. It is least at the greatest distance from which a frame
//! is taken.

use super::approach::{Approach, Moving, is_timed};
use super::cameras::Named;
use super::clauses::{Definition, Measure, MeasuredAnswer, MeasuredScene, MeasuredVerdict};
use super::uncertainty::{Geometry, Judged, Uncertain};
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

/// What a camera has of the target.
struct Reached {
    /// From where, m.
    distance_m: f64,
    pixels: f64,
    /// How far the target moves while a frame is exposed, m, where that limits it.
    smear_m: Option<f64>,
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

    /// Every camera, with the number of bands that it reads.
    pub(super) fn looking(&self) -> Vec<(&Named, usize)> {
        self.cameras.iter().map(|(named, bands)| (named, bands.len())).collect()
    }

    fn approach(&self, camera: &Camera, bands: usize) -> Option<Approach> {
        self.stop.map(|spec| Approach::of(&spec, camera, bands))
    }

    /// The greatest distance from which a frame is taken, m, and the pixels across the target: from there, or as many as do not run into
    /// each other while a frame is exposed, where that is fewer: the target over its way meanwhile, the same from everywhere, and least at
    /// the highest speed.
    fn reached(&self, camera: &Camera, bands: usize) -> Reached {
        let approach = self.approach(camera, bands);
        let distance_m = approach.map_or(self.farthest_m, |approach| approach.distance_m[1]);
        let [_, coarser] = camera.pixel_angles_rad();
        let sharp = self.size_m / (distance_m * coarser);
        let smear_m = self.moving.and_then(|moving| moving.smear_m(camera, 1));
        let limits = smear_m.filter(|smear_m| self.size_m / smear_m < sharp);
        Reached { distance_m, pixels: limits.map_or(sharp, |smear_m| self.size_m / smear_m), smear_m: limits }
    }

    /// Frames that come too late, or of which it cannot be said how they blur.
    fn spoiled(&self, camera: &Camera, bands: usize) -> Vec<Shortfall> {
        let unknown = self.moving.is_some_and(|moving| moving.blur_pixels(camera, 1).is_none());
        let late = self.approach(camera, bands).and_then(|approach| approach.shortfall());
        let outside = self.moving.and_then(|moving| moving.out_of_view(camera));
        unknown.then_some(Shortfall::MotionUnknown).into_iter().chain(outside).chain(late).collect()
    }

    fn judged(&self, named: &Named, read: &Bands) -> Result<MeasuredVerdict> {
        let bands = read.len();
        let Reached { distance_m, pixels: value, smear_m } = self.reached(&named.camera, bands);
        let place = |key: &str| self.rule.camera_place(named.index, key);
        let uncertain = Uncertain::of(named, (self.rule.coverage_factor, false), &place)?;
        let (judged, uncertainty) = Uncertain::verdict(
            uncertain,
            value / self.pixels,
            Shortfall::Pixels,
            named,
            &|camera| self.spoiled(camera, bands),
            &Geometry(|camera: &Camera| self.reached(camera, bands).pixels / self.pixels),
        )?;
        let Judged { verdict, fails_by, undecided_by } = judged;
        let passes = verdict == Verdict::Meets;
        let evidence = Grade::Proved.guarded(verdict, uncertainty.as_ref());
        let speed_m_s = self.moving.map(|moving| moving.speed_m_s);
        let path = self.moving.and_then(|moving| moving.conditions(&named.camera));
        let set = &self.rule.scenario.source.settings;
        let conditions = of_measured(
            diffraction(&named.camera, read).into_iter().collect(),
            (&named.camera, bands),
            (speed_m_s, path, is_timed(self.stop.as_ref())),
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
            limiting: MeasuredScene { distance_m: Some(distance_m), smear_m, ..MeasuredScene::default() },
            conditions,
            approach: self.approach(&named.camera, bands).map(|approach| approach.result),
            warnings: contradiction(&named.camera).into_iter().collect(),
        })
    }
}
