//! A clause that tells apart, answered beside the earlier ones of its rule: one that differs from another by speeds alone asks for the same worst
//! scenes, and for the same scenes of the ideal camera.
//!
//! The same is what is bit by bit the same: bands, surroundings, spectra, what is unknown, ranges, counts and noise. Distances of the ideal
//! camera, which has no noise but that of its photons, grow as √κ: those of one exposure are those of every other.
//!
//! Where many clauses are asked that differ hardly at all (the cells of a grid), it is enough that counts and noise are nearly the same. With κ counts
//! per radiance and the added variance v, a band tells
//!
//! √(κS + v) − √(κS′ + v) = (S − S′)/(√(S/κ + v/κ²) + √(S′/κ + v/κ²))
//!
//! of any two spectra, so that with κ(1 + ε) and v(1 + δ) no statistical distance is less than the share min(√(1 + ε), (1 + ε)/√(1 + δ)), the least of
//! all bands, of what it was: what was proved holds by that share, and the scene found is looked at again.

use super::apart::{Candidate, TellApart};
use super::asked::{Extent, RuleAsked};
use super::clauses::ApartAnswer;
use super::envelope::{Estimate, Sighted};
use super::ideal::Scenes;
use super::pairs::Searched;
use super::results::CameraVerdict;
use crate::Study;
use hadar::demand::{self, Reason, Skipping, Thing};
use hadar::error::Result;
use hadar::parallel;

/// The worst of all pairs, and what each has come to.
pub(super) type Worst = (Searched, Vec<Estimate>);

/// What one clause asked and found.
pub(super) struct Earlier<'a> {
    pub(super) apart: &'a TellApart,
    /// Of every camera, and whether no more than a verdict was asked for.
    pub(super) worst: Vec<(bool, Worst)>,
    pub(super) ideal: Option<Scenes<'a>>,
}

/// Share of a statistical distance that may be lost where clauses are nearly the same.
const NEARLY: f64 = 1e-3;

impl Earlier<'_> {
    /// The worst of a camera, if it was asked for in the same words.
    pub(super) fn worst<'b>(&'b self, of: &'b TellApart, index: usize, alone: bool) -> Option<&'b Worst> {
        let (pairs, worst) = self.asked_like(of, index, alone)?;
        pairs.into_iter().all(|(one, other)| one.sees_as(other)).then_some(worst)
    }

    /// The worst of a camera that counts nearly as much of the same, if that settles whether it is enough.
    pub(super) fn nearly_worst(&self, of: &TellApart, index: usize, alone: bool) -> Result<Option<Worst>> {
        let Some((pairs, (worst, all))) = self.asked_like(of, index, alone) else { return Ok(None) };
        let sighted: Vec<&Sighted> = pairs.iter().map(|(one, _)| *one).collect();
        let shares = pairs.into_iter().map(|(one, other)| one.share_left_of(other));
        let share = shares.fold(1.0, f64::min);
        if share < 1.0 - NEARLY || worst.between.is_some() {
            return Ok(None);
        }
        let again = |pair: &Estimate| -> Result<Estimate> {
            let Sighted { study, counting, .. } = sighted[pair.sighted];
            let (own, other) = (&study.target.emissivity, &study.alternatives[pair.alternative].emissivity);
            let found = sighted[pair.sighted].solver().with_counting(own, other, &pair.state, counting)?;
            Ok(Estimate { distance: found.distance, nearest: found.state, ..pair.clone() })
        };
        let pair = again(&worst.pair)?;
        let lower_bound = worst.lower_bound.map(|bound| (share * bound).min(pair.distance));
        let settled = pair.distance < of.required || lower_bound.is_some_and(|bound| bound >= of.required);
        let worst = Searched { pair, lower_bound, ..worst.clone() };
        Ok(if settled { Some((worst, all.iter().map(again).collect::<Result<_>>()?)) } else { None })
    }

    /// What was found of a camera by a clause that demands the same of it, with what both look at.
    fn asked_like<'b>(
        &'b self,
        of: &'b TellApart,
        index: usize,
        alone: bool,
    ) -> Option<(Vec<(&'b Sighted, &'b Sighted)>, &'b Worst)> {
        let (candidate, known) = (of.candidates.get(index)?, self.apart.candidates.get(index)?);
        let (was_alone, worst) = self.worst.get(index)?;
        let asked = |of: &TellApart, candidate: &Candidate| (of.required, of.decisive(candidate));
        let same = alone == *was_alone
            && asked(of, candidate) == asked(self.apart, known)
            && candidate.share == known.share
            && candidate.between.is_empty()
            && known.between.is_empty()
            && candidate.sighted.len() == known.sighted.len();
        same.then(|| (candidate.sighted.iter().zip(&known.sighted).collect(), worst))
    }
}

impl TellApart {
    /// What it says of every camera, and what a later clause may ask again; `progress` is told how many pairs of materials before a camera are
    /// done.
    pub(super) fn answer<'a>(
        &'a self,
        asked: &RuleAsked,
        earlier: &[Earlier<'a>],
        progress: &dyn Fn(usize),
    ) -> Result<(ApartAnswer, Earlier<'a>)> {
        let alone = asked.extent == Extent::Verdicts && asked.skipping == Skipping::On;
        let earlier = if asked.skipping == Skipping::On { earlier } else { &[] };
        let mut judged = Vec::with_capacity(self.candidates.len());
        let mut before = 0;
        // As many at a time as there are threads, so that progress can be told between them.
        for part in self.candidates.chunks(rayon::current_num_threads().max(1)) {
            let first = judged.len();
            if let [one] = part {
                let within = |done: usize| progress(before + done.min(one.pairs()));
                judged.push(self.judged(first, alone, (earlier, asked.nearly_alike), &within)?);
            } else {
                let one =
                    |index: usize| self.judged(first + index, alone, (earlier, asked.nearly_alike), &|_| ());
                judged.extend(parallel::booked(part.len(), one)?);
            }
            before += part.iter().map(Candidate::pairs).sum::<usize>();
            progress(before);
        }
        let (cameras, worst): (Vec<CameraVerdict>, Vec<(bool, Worst)>) = judged.into_iter().unzip();
        let (not_identifiable, ideal) = if alone || asked.extent == Extent::Margins {
            demand::spared(Thing::Sections, Reason::NotAsked, 1);
            (None, None)
        } else {
            demand::computed(Thing::Sections, 1);
            let (found, scenes) = self.not_identifiable(
                asked.seed,
                &earlier.iter().filter_map(|one| one.ideal.as_ref()).collect::<Vec<_>>(),
            )?;
            (Some(found), Some(scenes))
        };
        let envelope = self.envelope_result();
        let requirement = self.requirement(&cameras, &envelope, alone);
        let companions =
            if asked.extent == Extent::Everything { self.companions(&cameras)? } else { Vec::new() };
        let mut constants: Vec<String> = Vec::new();
        for study in self.candidates.iter().flat_map(|candidate| &candidate.near) {
            constants.extend(study.constants(|_| true));
        }
        constants.sort_unstable();
        constants.dedup();
        let found: Vec<&Searched> = worst.iter().map(|(_, (worst, _))| worst).collect();
        let safety = self.safety(&envelope, &cameras, &found, &constants)?;
        let answer = ApartAnswer { requirement, envelope, cameras, not_identifiable, companions, safety };
        Ok((answer, Earlier { apart: self, worst, ideal }))
    }
}

impl Sighted {
    /// Whether all that is searched here is what is searched there.
    fn sees_as(&self, other: &Self) -> bool {
        self.counting == other.counting && self.ranges == other.ranges && self.study.asks_as(&other.study)
    }

    /// No statistical distance here is less than this share of what it is there; 0 where other things are searched.
    fn share_left_of(&self, other: &Self) -> f64 {
        if self.ranges != other.ranges || !self.study.asks_as(&other.study) {
            return 0.0;
        }
        let counts = self.counting.counts_per_radiance / other.counting.counts_per_radiance;
        let of_noise = |w: usize| match (self.counting.var_added(w), other.counting.var_added(w)) {
            // Without noise but that of the photons.
            (0.0, 0.0) => f64::INFINITY,
            (own, known) if own <= known => counts.min(1.0),
            (own, known) => counts / (own / known).sqrt(),
        };
        let least = (0..self.study.bands.len()).map(of_noise).fold(counts.sqrt(), f64::min);
        if least.is_finite() { least.min(1.0) } else { 0.0 }
    }
}

impl Study {
    /// Whether the same states of the same materials are compared in the same bands.
    pub(super) fn asks_as(&self, other: &Self) -> bool {
        self.bands == other.bands
            && self.surroundings == other.surroundings
            && self.target == other.target
            && self.alternatives == other.alternatives
            && self.unknowns == other.unknowns
            && self.range == other.range
            && self.air == other.air
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Kind, RuleStudy};
    use super::*;
    use hadar::material::Library;
    use hadar_scenario::Rule;

    const RULE: &str = "cameras = [\"ideal-pnrd\"]\n[target]\nmaterial = \"skin\"\ntemperature = \"33 degC\"\n\
        [[environment]]\ntemperature = \"10 degC\"\nlighting = 0.5\n[alternatives]\nmaterials = [\"pmma\"]\n\
        [bands]\nranges = [[\"8 um\", \"9 um\"], [\"9 um\", \"10 um\"], [\"11 um\", \"12 um\"]]\n\
        [envelope]\ntemperature = [\"30 degC\", \"37 degC\"]\n";

    /// Shot noise alone leaves √κ, other noise alone κ/√v, and both together more than the share says: each against the distance itself.
    #[test]
    fn no_distance_is_less_than_the_share_says() {
        let study =
            RuleStudy::new(&Rule::from_toml(RULE, None).unwrap(), &Library::embedded().unwrap()).unwrap();
        let Some(Kind::Apart(apart)) = study.clauses.first() else { panic!() };
        let plain = &apart.candidates[0].sighted[0];
        let bands = plain.study.bands.len();
        let photons = plain.counting.counts_per_radiance
            * plain.study.bands.weigh(&vec![1e20; plain.study.bands.nodes_cm1().len()])[0];
        let seen = |counts: f64, var: f64| {
            let mut other = plain.clone();
            other.counting.counts_per_radiance *= counts;
            other.counting.var_added = vec![var; bands];
            other
        };
        let distance = |seen: &Sighted| {
            let (own, other) = (&seen.study.target.emissivity, &seen.study.alternatives[0].emissivity);
            seen.solver().with_counting(own, other, &seen.study.state, &seen.counting).unwrap().distance
        };
        let ratio = |from: &Sighted, to: &Sighted| distance(to) / distance(from);
        for (from, to, exact) in [
            (seen(1.0, 0.0), seen(0.9, 0.0), Some(0.9f64.sqrt())),
            (seen(1.0, 1e9 * photons), seen(0.9, 1e9 * photons), Some(0.9)),
            (seen(1.0, 1e9 * photons), seen(1.0, 1.2e9 * photons), Some(1.2f64.sqrt().recip())),
            (seen(1.0, photons), seen(0.9, 1.2 * photons), None),
            (seen(1.0, 0.1 * photons), seen(1.1, 0.2 * photons), None),
        ] {
            let (share, found) = (to.share_left_of(&from), ratio(&from, &to));
            assert!(found >= share * (1.0 - 1e-9), "{found} {share}");
            if let Some(exact) = exact {
                assert!((share / exact - 1.0).abs() < 1e-12, "{share} {exact}");
                assert!((found / exact - 1.0).abs() < 1e-4, "{found} {exact}");
            }
        }
        // Another scene is another question.
        let mut other = seen(1.0, 0.0);
        other.study.target.emissivity[0] *= 0.99;
        assert_eq!(other.share_left_of(plain), 0.0);
        // More light leaves all.
        assert_eq!(seen(1.1, 0.0).share_left_of(plain), 1.0);
    }
}
