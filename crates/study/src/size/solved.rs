//! Every quantity of the camera solved for, and asked again at its solution.
//!
//! What is solved for one pair of materials may not do for another, and what tells the spectra apart may blur, or fill the well. At a
//! solution every pair is therefore asked, alternatives and members of classes, and solved for where it is not told there; the hardest
//! value counts. Motion, the time demanded and the well limit the quantity on either side ([`caps`]): the value is the nearest within
//! all of them that meets the task, if there is one.
//!
//! Assumption: the statistical distance is a monotone function of every quantity ([`hadar::policy`]), so that what is harder for one
//! pair does for all that were met before.

use super::reach::Reach;
use super::{Solutions, Study, Surface};
use crate::Shortfall;
use hadar::error::Result;
use hadar::instrument::Camera;
use hadar::policy::caps::{self, Circumstances, Limit};
use hadar::policy::{CameraTask, CapCode, Quantity, Solution, Trial};

/// Share by which a value keeps within a limit.
const WITHIN: f64 = 1e-9;

impl Study {
    /// What limits figures of the camera beside the statistical distance.
    pub(crate) fn circumstances<'a>(
        &'a self,
        brightest: &'a dyn Fn(&Trial) -> Result<f64>,
    ) -> Circumstances<'a> {
        let requirement = &self.scenario.requirement;
        Circumstances {
            bands: &self.bands,
            speed_m_s: requirement.speed_m_s,
            time_s: requirement.time_s,
            brightest,
        }
    }

    /// Every quantity solved for; `alternative` is the one that limits the camera as it is.
    pub(crate) fn solutions(&self, camera: &Camera, alternative: &Surface) -> Result<Solutions> {
        let mut found = self.solutions_of(camera, alternative, &Quantity::ALL)?;
        let brightest = |trial: &Trial| self.brightest(trial);
        let (task, given) = (self.task(camera), self.circumstances(&brightest));
        for (quantity, solution) in &mut found.0 {
            *solution = self.within_limits(solution.clone(), *quantity, &task, &given)?;
        }
        Ok(found)
    }

    /// The same of these quantities by what tells the spectra apart alone; what their values spoil is among their caps.
    pub(crate) fn solutions_of(
        &self,
        camera: &Camera,
        alternative: &Surface,
        quantities: &[Quantity],
    ) -> Result<Solutions> {
        let task = self.task(camera);
        let brightest = |trial: &Trial| self.brightest(trial);
        let given = self.circumstances(&brightest);
        let targets = self.other_targets();
        let mut first = Reach::new(self, alternative);
        let mut others = Vec::new();
        for study in std::iter::once(self).chain(&targets) {
            let is_new =
                |other: &&Surface| !std::ptr::eq(study, self) || other.emissivity != alternative.emissivity;
            others.extend(self.all_alternatives().filter(is_new).map(|other| Reach::new(study, other)));
        }
        let mut solved = Vec::with_capacity(quantities.len());
        for &quantity in quantities {
            let mut found = solve_all(&mut first, &mut others, &task, quantity)?;
            if let Some(value) = found.value {
                found.caps = caps::broken(quantity, value, &task, &given)?;
            }
            solved.push((quantity, found));
        }
        Ok(Solutions(solved))
    }

    /// The scene with every other member of the target's class.
    fn other_targets(&self) -> Vec<Self> {
        let members = self.members[0].iter().flat_map(|members| &members.surfaces);
        let others = members.filter(|member| member.emissivity != self.target.emissivity);
        if !self.has_classes() {
            return Vec::new();
        }
        others.map(|target| Self { target: target.clone(), ..self.clone() }).collect()
    }

    /// All alternatives, of classes all members.
    fn all_alternatives(&self) -> Box<dyn Iterator<Item = &Surface> + '_> {
        if self.has_classes() {
            Box::new(self.members[1].iter().flat_map(|members| &members.surfaces))
        } else {
            Box::new(self.alternatives.iter())
        }
    }

    /// The nearest value that keeps within what limits the quantity, or why there is none.
    fn within_limits(
        &self,
        mut solution: Solution,
        quantity: Quantity,
        task: &CameraTask<'_>,
        given: &Circumstances<'_>,
    ) -> Result<Solution> {
        let Some(value) = solution.value else { return Ok(solution) };
        let decides = |limit: &Limit| limit.code.decides();
        // The speed is what is solved for, at the exposure that it takes.
        let limits = match quantity {
            Quantity::Speed => Vec::new(),
            _ => caps::limits(quantity, &task.own(), given)?.into_iter().filter(decides).collect(),
        };
        let [mut least, mut most] = [(0.0, None), (f64::INFINITY, None)];
        for limit in &limits {
            if limit.is_least && limit.value > least.0 {
                least = (limit.value, Some(limit));
            } else if !limit.is_least && limit.value < most.0 {
                most = (limit.value, Some(limit));
            }
        }
        let (kept, by) = match quantity.is_least() {
            true if least.0 >= value => (least.0 * (1.0 + WITHIN), least.1),
            false if most.0 <= value => (most.0 * (1.0 - WITHIN), most.1),
            _ => (value, None),
        };
        solution.caps = caps::broken(quantity, kept, task, given)?;
        let blocks = if quantity.is_least() { most.1 } else { least.1 };
        if let (false, Some(limit)) = (kept >= least.0 && kept <= most.0, blocks) {
            solution.value = None;
            solution.reason = Some(limit.reason.clone());
            return Ok(solution);
        }
        let trial = match (quantity, solution.exposure_s) {
            (Quantity::Speed, Some(exposure_s)) => task.forward(Quantity::Exposure, exposure_s),
            _ => task.forward(quantity, kept),
        };
        let mut spoiled = self.spoiled_by(&trial.camera, trial.distance_m, (given.brightest)(&trial)?);
        if quantity == Quantity::Speed {
            // What moves faster or slower is another question.
            spoiled.retain(|by| !matches!(by, Shortfall::MotionBlur | Shortfall::MotionUnknown));
        }
        let frame_s = trial.camera.frame_s().unwrap_or(f64::INFINITY);
        if trial.camera.exposure_s > frame_s {
            spoiled.push(Shortfall::FrameRate);
        }
        if let Some(by) = spoiled.first() {
            solution.value = None;
            solution.reason = Some(CapCode::whatever(limit(*by)).into());
            return Ok(solution);
        }
        solution.value = Some(kept);
        if let Some(limit) = by {
            solution.reason = Some(limit.reason.clone());
        }
        Ok(solution)
    }
}

/// The limit that a shortfall is of; `None` where it is not known.
const fn limit(by: Shortfall) -> Option<CapCode> {
    match by {
        Shortfall::MotionBlur => Some(CapCode::Motion),
        Shortfall::FullWell => Some(CapCode::FullWell),
        Shortfall::FrameRate => Some(CapCode::FrameRate),
        Shortfall::DecisionTime => Some(CapCode::DecisionTime),
        _ => None,
    }
}

/// Solves for all pairs, those that turn out not to be told at the solution of the others one after the other.
fn solve_all(
    first: &mut Reach<'_>,
    others: &mut [Reach<'_>],
    task: &CameraTask<'_>,
    quantity: Quantity,
) -> Result<Solution> {
    let mut worst = first.solve(task, quantity)?;
    let mut open: Vec<&mut Reach<'_>> = others.iter_mut().collect();
    'again: loop {
        let value = match worst.value {
            Some(value) => value,
            // Any distance does, as far as is looked at.
            None if worst.statistical_distance >= task.required => task.looked_at_m(),
            // Where nothing suffices for one, nothing suffices for all.
            None => return Ok(worst),
        };
        let trial = task.forward(quantity, value);
        for place in 0..open.len() {
            if !open[place].is_met(&trial, task.required)? {
                let found = open.swap_remove(place).solve(task, quantity)?;
                let any = |one: &Solution| one.value.is_none() && one.statistical_distance >= task.required;
                worst = match (any(&worst), any(&found)) {
                    (true, _) => found,
                    (false, true) => worst,
                    (false, false) => found.or_harder(worst, quantity),
                };
                continue 'again;
            }
        }
        return Ok(worst);
    }
}
