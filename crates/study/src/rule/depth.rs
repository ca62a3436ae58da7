//! A clause that demands a distance: the depth of an object of a rendered street, known to an error in a share of its windows.
//!
//! The object is put at several distances, from the nearest to the farthest from which a frame is taken: those of `[stop]`, else that of the
//! clause's own scene, else those of the envelope. The bounds are those of [`crate::range`]. The least depth error grows with the
//! square of the distance as long as the picture stays as it is, so that the largest depth at which the demand would still be met gives
//! the margin. The picture does not stay as it is, and what is near may be known worse: the worst of the distances counts. A distance at
//! which no window shows the object is not met.

use super::apart::steps;
use super::approach::{Approach, Moving, is_timed, spoiled};
use super::cameras::Named;
use super::clauses::{Definition, Measure, MeasuredAnswer, MeasuredScene, MeasuredVerdict};
use crate::condition::Condition;
use crate::grade::Grade;
use crate::range::{Overfull, RangePlan, RangeStudy, Signal, SignalBounds};
use crate::rests_on::{of_figures, of_measured};
use crate::warn::contradiction;
use crate::warning::by_code;
use crate::{Shortfall, Warning};
use hadar::error::{Error, Result};
use hadar::material::Library;
use hadar::parallel;
use hadar_scenario::range::{Demand, RangeScenario, Subject};
use hadar_scenario::rule::{Clause, DepthDemand, DepthObject, Verdict};
use hadar_scenario::{BandsSpec, Rule, Setting};
use hadar_simulate::render::{StereoPair, StreetSpec};
use std::sync::Arc;

/// Ends of distances nearer to each other than by this factor have none between them.
const ALIKE: f64 = 1.05;

/// A clause with its cameras before the street.
#[derive(Debug)]
pub(super) struct DepthClause {
    demand: DepthDemand,
    cameras: Vec<Before>,
    /// What is set in the place of the rule's values.
    set: Vec<Setting>,
}

#[derive(Debug)]
struct Before {
    named: Named,
    /// From every distance (m), the least first.
    studies: Vec<(f64, RangeStudy)>,
    approach: Option<Approach>,
    spoiled: Vec<Shortfall>,
    /// Whether the rule has air, which the street has not.
    air: bool,
    bands: usize,
    /// At which speed, m s⁻¹, and whether the time of the decision is judged.
    asked: (Option<f64>, Option<Condition>, bool),
}

/// What is found from one distance.
#[derive(Clone)]
struct Seen {
    met: bool,
    margin: f64,
    /// Median of the object's windows, m; as asked for where none shows it.
    distance_m: f64,
    overfull: Option<Overfull>,
    /// What is to be said of it.
    warnings: Vec<Warning>,
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
            let stop = clause.stop.as_ref();
            let approach = stop.map(|stop| Approach::of(stop, &named.camera, bands));
            let distances_m = distances(clause, demand, approach.as_ref());
            let moving = Moving::of(clause).map(|moving| match stop {
                Some(_) => moving,
                None => Moving { distance_m: distances_m.first().copied(), ..moving },
            });
            let spoiled = spoiled(moving, stop, &named.camera, bands);
            let path = moving.and_then(|moving| moving.conditions(&named.camera));
            let (count, asked) = (bands, (moving.map(|moving| moving.speed_m_s), path, is_timed(stop)));
            let air = scenario.atmosphere.is_some();
            let bands = BandsSpec { source: scenario.bands.source.clone(), ..BandsSpec::default() };
            let mut range = RangeScenario {
                title: scenario.title.take(),
                subject: Subject::Scene(Box::new(demand.scene.clone())),
                bands: Some(bands),
                camera: scenario.camera.take(),
                stereo: demand.stereo.clone(),
                requirement: demand.requirement,
                source: scenario.source,
            };
            let from = |distance_m: f64| {
                let mut scene = demand.scene.clone();
                *demand.object.distance_m(&mut scene) = Some(distance_m);
                range.subject = Subject::Scene(Box::new(scene));
                Ok((distance_m, RangeStudy::new(&range, library)?))
            };
            let studies = distances_m.into_iter().map(from).collect::<Result<_>>()?;
            Ok(Before { named: named.clone(), studies, approach, spoiled, air, bands: count, asked })
        };
        let cameras = cameras.iter().enumerate().map(before).collect::<Result<_>>()?;
        Ok(Self { demand: demand.clone(), cameras, set: rule.scenario.source.settings.clone() })
    }

    /// Every camera, with the number of bands that it reads.
    pub(super) fn looking(&self) -> Vec<(&Named, usize)> {
        self.cameras.iter().map(|one| (&one.named, one.bands)).collect()
    }

    pub(super) fn answer(&self, progress: &dyn Fn(usize)) -> Result<MeasuredAnswer> {
        let mut seen: Vec<Vec<Seen>> = self.cameras.iter().map(|_| Vec::new()).collect();
        let alike = self.rendered_alike();
        let mut done = 0;
        // As many at a time as there are threads, so that progress can be told between them.
        for part in alike.chunks(rayon::current_num_threads().max(1)) {
            for found in parallel::booked(part.len(), |index| self.seen_alike(&part[index]))? {
                found.into_iter().for_each(|(camera, one)| seen[camera].push(one));
            }
            done += part.len();
            progress(self.cameras.len() * done / alike.len());
        }
        let verdicts = self
            .cameras
            .iter()
            .zip(seen)
            .map(|(camera, seen)| self.judged(camera, seen))
            .collect::<Result<_>>()?;
        let share = self.demand.requirement.share;
        let (quantity, demanded) = match self.demand.requirement.error {
            Demand::Absolute(error_m) => (Measure::DepthErrorM, error_m),
            Demand::Relative(part) => (Measure::RelativeDepthError, part),
        };
        let definition = Definition::Depth {
            object: self.demand.object.name(),
            error: self.demand.requirement.error,
            share,
            distances: self.cameras.iter().map(|camera| camera.studies.len()).max().unwrap_or(1),
            without_air: self.cameras.iter().any(|camera| camera.air),
            without_uncertainty: self.cameras.iter().any(|camera| !camera.named.uncertainty.is_empty()),
        };
        Ok(MeasuredAnswer { quantity, demanded, definition, cameras: verdicts })
    }

    /// All that is looked at, by camera and distance, what is rendered alike together.
    fn rendered_alike(&self) -> Vec<Vec<(usize, &(f64, RangeStudy))>> {
        let mut alike: Vec<Vec<(usize, &(f64, RangeStudy))>> = Vec::new();
        let all = self.cameras.iter().enumerate();
        for (camera, one) in all.flat_map(|(camera, own)| own.studies.iter().map(move |one| (camera, one))) {
            match alike
                .iter_mut()
                .find(|known| known.first().is_some_and(|(_, first)| one.1.is_rendered_as(&first.1)))
            {
                Some(known) => known.push((camera, one)),
                None => alike.push(vec![(camera, one)]),
            }
        }
        alike
    }

    /// What is found from one distance by cameras that see the same.
    fn seen_alike(&self, alike: &[(usize, &(f64, RangeStudy))]) -> Result<Vec<(usize, Seen)>> {
        let rendered = match alike {
            [(_, first), _, ..] => first.1.rendered(&|_, _| ())?,
            _ => None,
        };
        let one = |(camera, (distance_m, study)): &(usize, &(f64, RangeStudy))| {
            Ok((*camera, self.seen(*distance_m, study, rendered.as_ref())?))
        };
        alike.iter().map(one).collect()
    }

    /// What is found from one distance.
    fn seen(&self, distance_m: f64, study: &RangeStudy, rendered: Option<&Arc<StereoPair>>) -> Result<Seen> {
        let plan = RangePlan { bounds_alone: true, counted_alone: true, ..RangePlan::default() };
        let found = study.range_of(&plan, rendered, None, &|_, _| ())?;
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
        let power = match self.demand.requirement.error {
            Demand::Absolute(_) => 2,
            Demand::Relative(_) => 1,
        };
        let margin = reach.map_or(0.0, |reach| reach.powi(power));
        let overfull = study.overfull(&found);
        Ok(Seen {
            met,
            margin,
            distance_m: depth_m.unwrap_or(distance_m),
            overfull,
            warnings: found.warnings,
        })
    }

    /// The verdict, made of what was found from every distance; what is to be said of it is handed on and decides nothing.
    fn judged(&self, before: &Before, mut seen: Vec<Seen>) -> Result<MeasuredVerdict> {
        seen.sort_by(|a, b| a.met.cmp(&b.met).then(a.margin.total_cmp(&b.margin)));
        let overfull = seen.iter().any(|seen| seen.overfull.is_some());
        // The same is said from every distance.
        let said = by_code(seen.iter().flat_map(|seen| &seen.warnings)).into_iter();
        let mut warnings: Vec<Warning> =
            said.filter_map(|(_, of_code)| of_code.first().copied().cloned()).collect();
        warnings.extend(contradiction(&before.named.camera));
        let worst = seen
            .into_iter()
            .next()
            .ok_or_else(|| Error::malformed("a depth from no distance", "report this as a bug"))?;
        let Seen { met, margin, distance_m, .. } = worst;
        let demanded = match self.demand.requirement.error {
            Demand::Absolute(error_m) => error_m,
            Demand::Relative(part) => part,
        };
        let mut fails_by = Vec::new();
        if !met {
            fails_by.push(Shortfall::DepthError);
        }
        fails_by.extend(before.spoiled.iter().copied());
        if overfull {
            fails_by.push(Shortfall::FullWell);
        }
        // The street has no air, and is rendered for each camera as it is stated: who passes without either may not with them.
        let unasked = before.air || !before.named.uncertainty.is_empty();
        let (verdict, undecided_by) = match (fails_by.is_empty(), unasked) {
            (false, _) => (Verdict::Fails, Vec::new()),
            (true, true) => (Verdict::Undecided, vec![Shortfall::DepthError]),
            (true, false) => (Verdict::Meets, Vec::new()),
        };
        let passes = verdict == Verdict::Meets;
        let (camera, bands) = (&before.named.camera, before.bands);
        let mut figures = of_figures(camera, bands, None);
        figures.extend((!before.air).then_some(Condition::NoAir));
        figures.push(Condition::OneScene);
        figures.extend(camera.pattern.is_shared().then_some(Condition::PatternOfEachPixel));
        let conditions = of_measured(figures, (camera, bands), before.asked.clone(), &self.set, passes);
        Ok(MeasuredVerdict {
            name: before.named.name.clone(),
            verdict,
            passes,
            conditions,
            fails_by,
            undecided_by,
            uncertainty: None,
            value: (margin > 0.0).then(|| demanded / margin),
            margin,
            // The street is one scene, and nobody's: a picture with other texture has another bound.
            grade: Grade::Assumed,
            evidence: Grade::Assumed,
            limiting: MeasuredScene {
                distance_m: Some(distance_m),
                target: Some(self.demand.object.name().to_owned()),
                ..MeasuredScene::default()
            },
            approach: before.approach.as_ref().map(|approach| approach.result),
            warnings,
        })
    }
}

/// From where the object is looked at, m.
fn distances(clause: &Clause, demand: &DepthDemand, approach: Option<&Approach>) -> Vec<f64> {
    let own = *demand.object.distance_m(&mut demand.scene.clone());
    let street = StreetSpec::default();
    let [_, silent] = match demand.object {
        DepthObject::Person => street.person_at_m,
        DepthObject::Car => street.car_at_m,
    };
    let range = approach.map(|approach| approach.distance_m).or(own.map(|z| [z; 2]));
    match range.or(clause.envelope().distance_m).unwrap_or([silent; 2]) {
        [least, most] if least == most => vec![least],
        [least, most] if most < ALIKE * least => vec![least, most],
        ends => steps(ends).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const RULE: &str = "cameras = [\"flir-a325sc\"]\n[target]\nmaterial = \"skin\"\ntemperature = \"33 degC\"\n\
        [alternatives]\nmaterials = [\"aluminium\"]\n[bands]\nstep = \"20 cm^-1\"\n[[clause]]\nname = \"z\"\n\
        kind = \"depth-error\"\n[clause.requirement]\ndepth_error = \"0.2 m\"\n[clause.stereo]\nbaseline = \"0.5 m\"\n";

    /// The clause of the rule and its camera, from no distance.
    fn clause() -> (DepthClause, Before) {
        let rule = Rule::from_toml(RULE, None).unwrap();
        let hadar_scenario::rule::Demand::DepthError(demand) = &rule.clauses[0].demand else { panic!() };
        let library = Library::embedded().unwrap();
        let clause = DepthClause::new(&rule, &rule.clauses[0], demand, &[], &library).unwrap();
        let named = super::super::cameras::of(&rule).unwrap().remove(0);
        (
            clause,
            Before {
                named,
                studies: Vec::new(),
                approach: None,
                spoiled: Vec::new(),
                air: false,
                bands: 1,
                asked: (None, None, false),
            },
        )
    }

    proptest! {
        /// A verdict that is made without any remark, or with others, is the same.
        #[test]
        fn remarks_decide_nothing(
            looks in prop::collection::vec((any::<bool>(), 0.0..3.0f64, any::<bool>(), 0..3usize), 1..4),
        ) {
            let (clause, before) = clause();
            let overfull = Overfull { counts: 2.0, full_well: 1.0 };
            let seen: Vec<Seen> = looks
                .iter()
                .map(|&(met, margin, full, said)| Seen {
                    met,
                    margin,
                    distance_m: 5.0,
                    overfull: full.then_some(overfull),
                    warnings: [overfull.remark(), Warning::NoDepth].into_iter().take(said).collect(),
                })
                .collect();
            let without = seen.iter().map(|one| Seen { warnings: Vec::new(), ..one.clone() }).collect();
            let (with, without) = (clause.judged(&before, seen).unwrap(), clause.judged(&before, without).unwrap());
            let full = looks.iter().any(|look| look.2);
            prop_assert_eq!(with.fails_by.contains(&Shortfall::FullWell), full);
            prop_assert_eq!(with.verdict, without.verdict);
            prop_assert_eq!(with.fails_by, without.fails_by);
            prop_assert_eq!(with.undecided_by, without.undecided_by);
            prop_assert_eq!((with.margin, with.grade), (without.margin, without.grade));
        }
    }
}
