//! Pairs of materials before one camera: an estimate of each, and its worst case no more exactly than is asked for.
//!
//! A few scenes of a pair give its distance from above. What was found of the same materials from one distance is where the
//! search begins from another one: a bound that is proved holds wherever its search began
//! ([`worst_case_near`](hadar::policy::envelope::worst_case_near)), and where none is, many scenes are searched.

use super::apart::Candidate;
use super::envelope::{Estimate, Sighted};
use hadar::demand::{self, Thing};
use hadar::error::Result;
use hadar::policy::envelope::{Certificate, Effort, WorstCase, worst_case, worst_case_near};
use std::borrow::Cow;

/// Tolerance from which on a pair is searched from its estimate alone, and of worst cases of which only the scene is wanted.
pub(super) const LOOSE: f64 = 0.1;
/// Boxes of the branch and bound for each pair at most: a second or so.
const BOXES: u64 = 200_000;

/// A pair's scene with what is known of it.
#[derive(Debug, Clone)]
pub(super) struct Searched {
    pub(super) pair: Estimate,
    /// Where it was found, if between the distances of the candidate.
    pub(super) between: Option<Box<Sighted>>,
    pub(super) certificate: Option<Certificate>,
    pub(super) lower_bound: Option<f64>,
    /// Boxes that its proof took.
    pub(super) boxes: u64,
}

impl Searched {
    /// What the estimate says alone.
    pub(super) fn estimated(pair: Estimate) -> Self {
        Self { pair, between: None, certificate: None, lower_bound: None, boxes: 0 }
    }
}

impl Candidate {
    /// The worst case of one pair, no worse than its estimate: from that alone where a bound far below it is enough, or from what was
    /// `found` of the same materials from elsewhere if that is proved to suffice, else from many scenes.
    pub(super) fn search(&self, found: &[Searched], pair: Estimate, tolerance: f64) -> Result<Searched> {
        let sighted = &self.sighted[pair.sighted];
        let of = |pair: &Estimate| (&self.sighted[pair.sighted].study.target.name, pair.alternative);
        let start = if tolerance >= LOOSE {
            Some(pair.clone())
        } else {
            let known = found.iter().map(|known| &known.pair).find(|known| of(known) == of(&pair)).cloned();
            known.map(|Estimate { state, nearest, .. }| Estimate {
                distance: f64::INFINITY,
                state,
                nearest,
                ..pair.clone()
            })
        };
        if let Some(start) = start {
            let near = search_near(sighted, start, tolerance)?;
            let is_proved = !matches!(near.certificate, Some(Certificate::Bounded { .. }));
            if is_proved && near.pair.distance <= pair.distance {
                return Ok(near);
            }
        }
        search_anew(sighted, pair, tolerance)
    }

    /// An estimate of every pair as `seen`: from those that are `known`, and the corners with so many scenes between them from the first
    /// distance and elsewhere, if any; what is nearest from one distance is tried from the others.
    pub(super) fn estimates<'s>(
        &self,
        known: &[Estimate],
        [scenes, elsewhere]: [Option<usize>; 2],
        seen: impl Fn(usize) -> Result<Cow<'s, Sighted>>,
    ) -> Result<Vec<Estimate>> {
        let target = |index: usize| &self.sighted[index].study.target.name;
        let mut all: Vec<Estimate> = Vec::new();
        for index in 0..self.sighted.len() {
            let same = |pair: &&Estimate| target(pair.sighted) == target(index);
            let first = !all.iter().any(|pair| same(&pair));
            let of_target = if first { known } else { &all };
            let of_target: Vec<Estimate> = of_target.iter().filter(same).cloned().collect();
            let (estimates, searched) =
                seen(index)?.estimates(index, &of_target, if first { scenes } else { elsewhere })?;
            demand::computed(Thing::NearestSearches, searched);
            all.extend(estimates);
        }
        Ok(all)
    }
}

/// From many scenes.
pub(super) fn search_anew(sighted: &Sighted, pair: Estimate, tolerance: f64) -> Result<Searched> {
    let scene = sighted.scene(&sighted.study.alternatives[pair.alternative]);
    let effort = Effort { relative_tolerance: tolerance, boxes: BOXES };
    Ok(searched(pair, worst_case(&scene, &sighted.ranges, &effort)?))
}

/// From the estimate, whose distance may be that of another scene.
pub(super) fn search_near(sighted: &Sighted, pair: Estimate, tolerance: f64) -> Result<Searched> {
    let scene = sighted.scene(&sighted.study.alternatives[pair.alternative]);
    let effort = Effort { relative_tolerance: tolerance, boxes: BOXES };
    let worst = worst_case_near(&scene, &sighted.ranges, [&pair.state, &pair.nearest], &effort)?;
    Ok(searched(pair, worst))
}

/// The worst case of a pair with what it took.
fn searched(pair: Estimate, worst: WorstCase) -> Searched {
    let WorstCase { distance, lower_bound, state, nearest, certificate, evaluations, boxes } = worst;
    demand::computed(Thing::WorstCases, 1);
    demand::computed(Thing::NearestSearches, evaluations);
    demand::computed(Thing::Boxes, boxes);
    let pair = if distance <= pair.distance { Estimate { distance, state, nearest, ..pair } } else { pair };
    let lower_bound = lower_bound.map(|bound| bound.min(pair.distance));
    Searched { pair, between: None, certificate: Some(certificate), lower_bound, boxes }
}
