//! Distances between those that were searched: a worse one among them is looked for, and that there is none is proved.
//!
//! The range is cut into stretches, at the columns of the air's table too, since transmittances may bend there. Of every pair each
//! stretch is to have a lower bound that is no more than the tolerance below the least distance known
//! ([`lower_bound_along`]). Those that have not are halved, all of them, level by level; in the middle of the one of the lowest
//! bound a worse scene is looked for, from which all later proofs start.

use super::super::{Study, Surface};
use super::apart::{Candidate, DISTANCES, TellApart, steps};
use super::envelope::{Estimate, Sighted};
use super::pairs::{LOOSE, Searched, search_anew, search_near};
use super::search::TOLERANCE;
use hadar::demand::{self, Thing};
use hadar::error::Result;
use hadar::minimum::golden_section;
use hadar::parallel;
use hadar::policy::envelope::{Certificate, Effort, EnvelopeScene, LeastKnown, Stretch, lower_bound_along};

/// Golden sections of the distance, each to 0.62 of what it was.
const GOLDEN_STEPS: usize = 12;
/// Levels of halving; stretches that are bounded, and boxes that are looked at, at most, and where a scene that decides is known already;
/// and after how many stretches it is looked whether that is reached.
const LEVELS: u32 = 14;
const STRETCHES: u64 = 6_000;
const ALL_BOXES: u64 = 2_000_000;
const BOXES_OF_A_NO: u64 = 60_000;
const TOGETHER: usize = 64;
/// Boxes for one stretch, besides twice those of a distance, and at most: what takes more is sooner done in halves.
const FEW_BOXES: u64 = 64;
const MOST_BOXES: u64 = 20_000;
/// Shares of the requirement below which nothing more is proved, and nothing looked for: how far below matters little.
const FAR_BELOW: f64 = 0.01;
const NOTHING: f64 = 1e-6;
/// Relative difference up to which a distance is a column of the air's table, whichever stands first.
const SAME: f64 = 9e-13;

/// A stretch of distances before a pair, with what is proved of it.
#[derive(Debug, Clone)]
struct Piece<'c> {
    sighted: &'c Sighted,
    alternative: usize,
    ends_m: [f64; 2],
    bound: f64,
}

impl Piece<'_> {
    fn middle_m(&self) -> f64 {
        (self.ends_m[0] * self.ends_m[1]).sqrt()
    }

    fn halves(&self) -> [Self; 2] {
        let ([near, far], middle) = (self.ends_m, self.middle_m());
        [[near, middle], [middle, far]].map(|ends_m| Self { ends_m, ..self.clone() })
    }

    /// A distance below which no scene is from here, and the boxes that took; `None` if nothing can be proved.
    fn bounded(&self, known: &LeastKnown<'_>, boxes: u64) -> Result<Option<(f64, u64)>> {
        let along = self.sighted.along(self.ends_m)?;
        let surface = &self.sighted.study.alternatives[self.alternative];
        let scene =
            EnvelopeScene { bands: &along.near, counting: &along.counting, ..self.sighted.scene(surface) };
        let stretch = Stretch { far: &along.far, middle: &along.middle, sag: &along.sag };
        let effort = Effort { relative_tolerance: TOLERANCE, boxes };
        let found = lower_bound_along(&scene, &stretch, &self.sighted.ranges, known, &effort)?;
        Ok(found.map(|(bound, boxes)| (bound.max(self.bound), boxes)))
    }
}

impl TellApart {
    /// The worst of the distances between those of the candidate, and below what no scene is from any of them, if that is proved;
    /// `alone` asks for no more than whether one is below the requirement.
    pub(super) fn between(
        &self,
        candidate: &Candidate,
        worst: Searched,
        alone: bool,
        counts: &dyn Fn(&Surface, &Surface) -> bool,
    ) -> Result<(Searched, Option<f64>)> {
        // A stretch is no easier than a distance: what could not be proved there is not tried here.
        let boxes = (FEW_BOXES + 2 * worst.boxes).min(MOST_BOXES);
        let hard = worst.certificate != Some(Certificate::BranchAndBound);
        if worst.pair.distance < NOTHING * self.required {
            return Ok((worst, None));
        }
        let mut best = self.polished(candidate, worst)?;
        if hard {
            return Ok((best, None));
        }
        let mut waiting = self.pieces(candidate, counts);
        let (mut proved, mut left, mut looked_at, mut spent) = (f64::INFINITY, f64::INFINITY, 0, 0);
        for _ in 0..LEVELS {
            // What is enough for the verdict is enough.
            let enough = if alone { self.required / (1.0 - TOLERANCE) } else { f64::INFINITY };
            let least = if alone { self.required } else { FAR_BELOW * self.required };
            let Estimate { distance, state, nearest, .. } = &best.pair;
            let known = LeastKnown { distance: distance.min(enough), state, nearest };
            if waiting.is_empty() || known.distance < least {
                break;
            }
            let affordable = if known.distance < self.required { BOXES_OF_A_NO } else { ALL_BOXES };
            let mut failed = Vec::new();
            for pieces in waiting.chunks(TOGETHER) {
                if looked_at > STRETCHES || spent > affordable {
                    // As far as they are known from the stretch that they are halves of.
                    left = pieces.iter().fold(left, |left, piece| left.min(piece.bound));
                    continue;
                }
                looked_at += pieces.len() as u64;
                let bounds: Vec<Option<(f64, u64)>> =
                    parallel::try_map(pieces.len(), |i| pieces[i].bounded(&known, boxes))?;
                for (piece, bound) in pieces.iter().zip(bounds) {
                    let Some((bound, boxes)) = bound else { return Ok((best, None)) };
                    spent += boxes;
                    demand::computed(Thing::Boxes, boxes);
                    if bound >= known.distance * (1.0 - TOLERANCE) {
                        proved = proved.min(bound);
                    } else {
                        failed.push(Piece { bound, ..piece.clone() });
                    }
                }
            }
            if let Some(weakest) = failed.iter().min_by(|a, b| a.bound.total_cmp(&b.bound)) {
                best = self.or_worse(candidate, best, weakest)?;
            }
            waiting = failed.iter().flat_map(Piece::halves).collect();
        }
        let left = waiting.iter().fold(left, |left, piece| left.min(piece.bound));
        let bound = proved.min(left).min(best.pair.distance);
        Ok((best, Some(bound).filter(|bound| *bound > 0.0)))
    }

    /// All that is to be proved, in stretches no wider than the steps of the search.
    fn pieces<'c>(
        &self,
        candidate: &'c Candidate,
        counts: &dyn Fn(&Surface, &Surface) -> bool,
    ) -> Vec<Piece<'c>> {
        let Some([least, most]) = candidate.distance_m else { return Vec::new() };
        let mut pieces = Vec::new();
        for sighted in &candidate.between {
            let mut ends: Vec<f64> = steps([least, most]).collect();
            (ends[0], ends[DISTANCES - 1]) = (least, most);
            let air = sighted.study.atmosphere.iter();
            ends.extend(air.flat_map(|air| air.table.lengths_m()).filter(|z| (least..most).contains(*z)));
            ends.sort_by(f64::total_cmp);
            ends.dedup_by(|b, a| *b <= *a * (1.0 + SAME));
            match ends.last_mut().filter(|last| **last > least) {
                Some(last) => *last = most,
                None => ends = vec![least, most],
            }
            for (alternative, surface) in sighted.study.alternatives.iter().enumerate() {
                if counts(&sighted.study.target, surface) {
                    let piece =
                        |ends: &[f64]| Piece { sighted, alternative, ends_m: [ends[0], ends[1]], bound: 0.0 };
                    pieces.extend(ends.windows(2).map(piece));
                }
            }
        }
        pieces
    }

    /// The best known, or a worse one in the middle of a piece.
    fn or_worse(&self, candidate: &Candidate, best: Searched, piece: &Piece<'_>) -> Result<Searched> {
        let own = &piece.sighted.study;
        let seen = Sighted::new(own.at_distance(piece.middle_m())?, &self.envelope)?;
        let of_target = |sighted: &Sighted| sighted.study.target.name == own.target.name;
        let anew = Estimate {
            sighted: candidate.sighted.iter().position(of_target).unwrap_or(best.pair.sighted),
            alternative: piece.alternative,
            distance: f64::INFINITY,
            ..best.pair.clone()
        };
        let found = search_anew(&seen, anew, LOOSE)?;
        if found.pair.distance < best.pair.distance {
            return Ok(Searched { between: Some(Box::new(seen)), ..found });
        }
        Ok(best)
    }

    /// The worst distance next to that of the worst pair found, by golden sections of its logarithm.
    fn polished(&self, candidate: &Candidate, worst: Searched) -> Result<Searched> {
        let own = &candidate.sighted[worst.pair.sighted].study;
        let at = |study: &Study| study.scenario.target.distance_m.unwrap_or(f64::INFINITY);
        let middle = at(own);
        let of_target =
            candidate.sighted.iter().filter(|sighted| sighted.study.target.name == own.target.name);
        let distances: Vec<f64> = of_target.map(|sighted| at(&sighted.study)).collect();
        let low = distances.iter().copied().filter(|z| *z < middle).fold(0.0, f64::max);
        let high = distances.iter().copied().filter(|z| *z > middle).fold(f64::INFINITY, f64::min);
        let low = if low > 0.0 { low } else { middle };
        let high = if high.is_finite() { high } else { middle };
        if low >= high {
            return Ok(worst);
        }
        let mut best = worst;
        golden_section([low.ln(), high.ln()], GOLDEN_STEPS, |log_z| -> Result<f64> {
            let sighted = Sighted::new(own.at_distance(log_z.exp())?, &self.envelope)?;
            let anew = Estimate { distance: f64::INFINITY, ..best.pair.clone() };
            let searched = search_near(&sighted, anew, LOOSE)?;
            let distance = searched.pair.distance;
            if distance < best.pair.distance {
                best = Searched { between: Some(Box::new(sighted)), ..searched };
            }
            Ok(distance)
        })?;
        Ok(best)
    }
}
