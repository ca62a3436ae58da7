//! A clause that demands a distance: the depth of an object of a rendered street, known to an error in a share of its windows.
//!
//! The object is put at the greatest distance from which the decision must stand (or, without `[stop]`, at that of the clause's own
//! scene); the bounds are those of [`crate::study::range`]. The least depth error grows with the square of the distance as long as
//! the picture stays as it is, so that the largest depth at which the demand would still be met gives the margin.

use super::approach::{Approach, Moving, spoiled};
use super::cameras::Named;
use super::clauses::{Measure, MeasuredAnswer, MeasuredScene, MeasuredVerdict};
use super::results::Grade;
use crate::scenario::range::{Demand, RangeScenario, Subject};
use crate::scenario::rule::{Clause, DepthDemand, DepthObject, StopSpec, Verdict};
use crate::scenario::{BandsSpec, Rule};
use crate::study::range::{RangePlan, RangeStudy, Signal, SignalBounds};
use crate::study::{Shortfall, Warning};
use hadar::error::Result;
use hadar::material::Library;

/// A clause with its cameras before the street.
#[derive(Debug)]
pub(super) struct DepthClause {
    demand: DepthDemand,
    cameras: Vec<Before>,
}

#[derive(Debug)]
struct Before {
    named: Named,
    study: RangeStudy,
    approach: Option<Approach>,
    spoiled: Vec<Shortfall>,
    /// Whether the rule has air, which the street has not.
    air: bool,
}

impl DepthClause {
    pub(super) fn new(
        rule: &Rule,
        clause: &Clause,
        demand: &DepthDemand,
        cameras: &[Named],
        library: &Library,
    ) -> Result<Self> {
        let before = |(index, named): (usize, &Named)| {
            let mut scenario = rule.with_camera(clause, index);
            let bands = named.bands(&scenario)?;
            let approach =
                clause.stop.as_ref().map(|spec| Approach::of(StopSpec::stop(spec), &named.camera, bands));
            let stop = clause.stop.as_ref().map(StopSpec::stop);
            let spoiled = spoiled(Moving::of(clause), stop, &named.camera, bands);
            let air = scenario.atmosphere.is_some();
            let mut scene = demand.scene.clone();
            if let Some(approach) = &approach {
                let [_, far] = approach.distance_m;
                match demand.object {
                    DepthObject::Person => scene.person_distance_m = Some(far),
                    DepthObject::Car => scene.car_distance_m = Some(far),
                }
            }
            let bands = BandsSpec { source: scenario.bands.source.clone(), ..BandsSpec::default() };
            let range = RangeScenario {
                title: scenario.title.take(),
                subject: Subject::Scene(scene),
                bands: Some(bands),
                camera: scenario.camera.take(),
                stereo: demand.stereo.clone(),
                requirement: demand.requirement,
                source: scenario.source,
            };
            Ok(Before {
                named: named.clone(),
                study: RangeStudy::new(&range, library)?,
                approach,
                spoiled,
                air,
            })
        };
        let cameras = cameras.iter().enumerate().map(before).collect::<Result<_>>()?;
        Ok(Self { demand: demand.clone(), cameras })
    }

    pub(super) fn answer(&self, progress: &dyn Fn(usize)) -> Result<MeasuredAnswer> {
        let mut verdicts = Vec::with_capacity(self.cameras.len());
        for (done, camera) in self.cameras.iter().enumerate() {
            verdicts.push(self.judged(camera)?);
            progress(done + 1);
        }
        let share = self.demand.requirement.share;
        let (quantity, demanded, error) = match self.demand.requirement.error {
            Demand::Absolute(error_m) => (Measure::DepthErrorM, error_m, hadar::words::length(error_m)),
            Demand::Relative(part) => (Measure::RelativeDepthError, part, hadar::words::share(part)),
        };
        let mut definition = format!(
            "least depth error of the {} within {error} in {} of its windows",
            self.demand.object.name(),
            hadar::words::share(share)
        );
        if self.cameras.iter().any(|camera| camera.air) {
            definition += " (the air of the rule is not in it: no camera is said to meet it)";
        }
        if self.cameras.iter().any(|camera| !camera.named.uncertainty.is_empty()) {
            definition +=
                " (uncertain figures are not carried into it: no camera that has some is said to meet it)";
        }
        Ok(MeasuredAnswer { quantity, demanded, definition, cameras: verdicts })
    }

    fn judged(&self, before: &Before) -> Result<MeasuredVerdict> {
        let found = before.study.range(&RangePlan::default(), &|_, _| ())?;
        let object = found.objects.iter().find(|object| object.name == self.demand.object.name());
        let by = |signal: Signal| {
            object.and_then(|object| object.signals.iter().find(|bounds| bounds.signal == signal))
        };
        let share = |bounds: &SignalBounds| bounds.share.unwrap_or(-1.0);
        let better = |a: &'_ SignalBounds, b: &'_ SignalBounds| share(a) > share(b);
        let cube = by(Signal::HeatCube);
        let bounds = match (cube, by(Signal::ThermalImage)) {
            (Some(cube), Some(image)) if better(image, cube) => Some(image),
            (cube, _) => cube,
        };
        let met = bounds.is_some_and(|bounds| share(bounds) >= self.demand.requirement.share);
        let depth_m = object.and_then(|object| object.depth_m).map(|[_, median, _]| median);
        let reach = bounds.and_then(|bounds| bounds.largest_depth_m).zip(depth_m).map(|(most, z)| most / z);
        let (demanded, power) = match self.demand.requirement.error {
            Demand::Absolute(error_m) => (error_m, 2),
            Demand::Relative(part) => (part, 1),
        };
        let margin = reach.map_or(0.0, |reach| reach.powi(power));
        let mut fails_by = Vec::new();
        if !met {
            fails_by.push(Shortfall::DepthError);
        }
        fails_by.extend(before.spoiled.iter().copied());
        if found.warnings.iter().any(|warning| matches!(warning, Warning::PixelFull { .. })) {
            fails_by.push(Shortfall::FullWell);
        }
        // The street has no air, and is rendered for each camera as it is stated: who passes without either may not with them.
        let unasked = before.air || !before.named.uncertainty.is_empty();
        let (verdict, undecided_by) = match (fails_by.is_empty(), unasked) {
            (false, _) => (Verdict::Fails, Vec::new()),
            (true, true) => (Verdict::Undecided, vec![Shortfall::DepthError]),
            (true, false) => (Verdict::Meets, Vec::new()),
        };
        Ok(MeasuredVerdict {
            name: before.named.name.clone(),
            verdict,
            passes: verdict == Verdict::Meets,
            fails_by,
            undecided_by,
            uncertainty: None,
            value: (margin > 0.0).then(|| demanded / margin),
            margin,
            // The street is one scene, and nobody's: a picture with other texture has another bound.
            grade: Grade::Assumed,
            limiting: MeasuredScene {
                distance_m: depth_m,
                target: Some(self.demand.object.name().to_owned()),
                ..MeasuredScene::default()
            },
            approach: before.approach.as_ref().map(|approach| approach.result),
            warnings: found.warnings,
        })
    }
}
