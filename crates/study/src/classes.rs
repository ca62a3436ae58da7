//! Classes in a study: all members of target and alternatives looked at, and the pair that decides put in their place.
//!
//! The answer on two classes is that on their worst pair of members. Beside it, of members a of the target's class with weights w_a and
//! b of the alternative's with w_b: the share Σ w_a w_b [d_ab ≥ d_req] of the pairs that the camera tells, the mean detection
//! probability Σ w_a w_b Φ(d_ab), and the worst pair without the one or the other of its members. If the n members of a class and one
//! more are drawn alike, the one more is nearer than all n with a probability of 1/(n + 1) at most.
//!
//! Where mixtures of members belong to a class, the pair that decides is the worst mixture found, and what is proved holds for all
//! ([`hadar::identifiability::mixture`]). A class with a sample covariance stands as its mean; its scatter is what errors of the emissivity are
//! drawn of (`size::sensitivity`).

mod answer;
mod members;
mod mixtures;

pub use answer::{ClassAnswer, ClassSide, LeftOut, MixtureAnswer};
pub(super) use members::Members;

use super::{Study, Surface, Warning};
use hadar::demand::{Ledger, Skipping};
use hadar::error::{Error, Result};
use hadar::fisher::Counting;
use hadar::identifiability::detection;
use hadar::identifiability::multi::{ClassDistances, Classes, MemberPair};
use hadar::material::Library;
use hadar_scenario::{DistanceKind, Scenario, SensitivitySpec, Spread};
use std::borrow::Cow;

impl Study {
    /// Whether target or alternatives are classes.
    #[must_use]
    pub fn has_classes(&self) -> bool {
        self.members.iter().flatten().any(Members::is_class)
    }

    /// The classes among target and alternatives.
    pub(super) fn class_sides(&self) -> impl Iterator<Item = ClassSide> {
        self.members.iter().flatten().filter(|members| members.is_class()).map(Members::side)
    }

    /// The errors that classes state of their emissivities.
    pub(super) fn stated_spreads(&self) -> impl Iterator<Item = SensitivitySpec> {
        self.members.iter().flatten().filter_map(|members| match members.spec.as_ref()?.spread? {
            Spread::Stated { emissivity_error, correlation_cm1 } => {
                Some(SensitivitySpec { emissivity_error, correlation_cm1 })
            }
            Spread::Sample => None,
        })
    }

    /// What the members of classes say together, alternative by alternative; empty without classes.
    #[must_use]
    pub fn class_answers(&self) -> &[ClassAnswer] {
        &self.classes
    }

    /// Looks up a scenario ([`Study::new`]) with every member of the target's class in turn as the target; all members of the
    /// alternatives' classes are alternatives.
    ///
    /// # Errors
    /// As [`Study::new`]; a class whose mixtures belong to it.
    pub(super) fn of_each_target(scenario: &Scenario, library: &Library) -> Result<Vec<Self>> {
        let study = Self::with_members(scenario, library)?;
        if let Some(mixed) = study.members.iter().flatten().find(|members| members.mixtures()) {
            let found = "mixtures of a class are not proved over an envelope";
            let error = Error::malformed(found, "leave mixtures out: its members are searched one by one");
            return Err(error.at(study.scenario.place(&format!("class.{}.mixtures", mixed.name))));
        }
        let targets = study.members[0].iter().flat_map(|members| &members.surfaces).cloned();
        Ok(targets.map(|target| Self { target, ..study.clone() }).collect())
    }

    /// What the target may be of: the members of its class, or the target alone.
    pub(super) fn targets(&self) -> impl Iterator<Item = &Surface> {
        let members = self.members[0].iter().flat_map(|members| &members.surfaces);
        members.chain(std::iter::once(&self.target))
    }

    /// Every member of target and alternatives, each once.
    pub(super) fn all_members(&self) -> impl Iterator<Item = &Surface> {
        self.members.iter().flatten().flat_map(|members| &members.surfaces)
    }

    /// The same with every class of a sample covariance as its mean.
    pub(super) fn with_means(mut self) -> Result<Self> {
        self.members.iter_mut().flatten().try_for_each(Members::stand_as_mean)?;
        let [targets, alternatives] = &self.members;
        self.alternatives = alternatives.iter().flat_map(|members| members.surfaces.clone()).collect();
        if let Some(first) = targets.iter().find_map(|members| members.surfaces.first()) {
            self.target = first.clone();
        }
        Ok(self)
    }

    /// The study of the pairs of members that decide: the worst of all as target, and for every alternative the member that is nearest.
    pub(super) fn of_worst_members(mut self, skipping: Skipping) -> Result<Self> {
        if !self.has_classes() {
            return Ok(self);
        }
        let ledger = Ledger::open();
        self.members.iter_mut().flatten().try_for_each(Members::stand_as_mean)?;
        let [targets, alternatives] = self.members.clone();
        let (mut paired, mut answers) = (Vec::new(), Vec::new());
        for other in &alternatives {
            // The target is one material or class.
            let Some(own) = targets.first() else { continue };
            let (pair, answer) = self.worst_members(own, other, skipping)?;
            paired.push(pair);
            answers.push(answer);
        }
        let worst =
            (0..answers.len()).min_by(|a, b| answers[*a].decisive().total_cmp(&answers[*b].decisive()));
        if let Some(worst) = worst {
            self.target = paired[worst].0.clone();
        }
        (self.paired, self.alternatives) = paired.into_iter().unzip();
        self.classes = answers;
        self.looked_up.add(&ledger.close());
        Ok(self)
    }

    /// Of classes, the one alternative that is asked for by its name or that of its class.
    pub(super) fn paired_with(&self, against: &[String]) -> Option<usize> {
        let [name] = against else { return None };
        let is_asked = |answer: &ClassAnswer| answer.alternative.name == *name;
        let class = self.classes.iter().position(is_asked);
        class.or_else(|| self.alternatives.iter().position(|surface| surface.name == *name))
    }

    /// That not all members of classes are looked at, where it is so.
    pub(super) fn worst_members_alone(&self, against: &[String]) -> Option<Warning> {
        let asked = self.paired_with(against).and_then(|index| self.classes.get(index));
        let worst = || self.classes.iter().min_by(|a, b| a.decisive().total_cmp(&b.decisive()));
        let other = asked.or_else(worst)?;
        let [target, alternative] = other.worst.clone();
        Some(Warning::WorstMembers { target, alternative })
    }

    /// The study whose target is nearest to alternative `index`.
    pub(super) fn against(&self, index: usize) -> Cow<'_, Self> {
        match self.paired.get(index) {
            Some(target) if *target != self.target => {
                Cow::Owned(Self { target: target.clone(), ..self.clone() })
            }
            _ => Cow::Borrowed(self),
        }
    }

    /// The pair of members that decides between two classes.
    fn worst_members(
        &self,
        own: &Members,
        other: &Members,
        skipping: Skipping,
    ) -> Result<((Surface, Surface), ClassAnswer)> {
        let found = self.member_distances(own, other, skipping)?;
        let statistical = self.camera.is_some();
        let required = self.required_of_members(own);
        let sure = |pair: &MemberPair| match pair.distance {
            Some(distance) => self.sure(distance, pair.lower) * (1.0 - pair.relative_error),
            None => pair.lower,
        };
        // Rows and columns are those of members, so that every index is one.
        let (a, b) = found.worst(sure, |_, _| true).unwrap_or((0, 0));
        let distance_of = |place: (usize, usize)| {
            found.pair(place.0, place.1).map_or(f64::NAN, |pair| pair.distance.unwrap_or(pair.lower))
        };
        let without = |kept: &dyn Fn(usize, usize) -> bool| found.worst(sure, kept).map(distance_of);
        let mut leave_one_out = Vec::new();
        for (members, member, distance) in
            [(own, a, without(&|i, _| i != a)), (other, b, without(&|_, j| j != b))]
        {
            if members.surfaces.len() > 1 {
                let (class, member) = (members.name.clone(), members.surfaces[member].name.clone());
                leave_one_out.push(LeftOut { class, member, distance });
            }
        }
        let weighed = |value: &dyn Fn(&MemberPair) -> f64| {
            let pair = |(i, w): (usize, &f64)| {
                let of = |(j, v): (usize, &f64)| found.pair(i, j).map_or(0.0, |pair| w * v * value(pair));
                other.weights.iter().enumerate().map(of).sum::<f64>()
            };
            own.weights.iter().enumerate().map(pair).sum::<f64>()
        };
        let told = |pair: &MemberPair| f64::from(u8::from(sure(pair) >= required));
        let share_told = statistical.then(|| weighed(&told).clamp(0.0, 1.0));
        let mean_probability = statistical.then(|| {
            let most = |pair: &MemberPair| pair.distance.map_or(1.0, detection::probability);
            [weighed(&|pair| detection::probability(sure(pair).max(0.0))), weighed(&most)]
                .map(|probability| probability.clamp(0.0, 1.0))
        });
        // What any pair asks of hardware: (d² L)⁻¹, L the radiance of its target.
        let least_information = (!statistical).then(|| {
            let mut least = f64::INFINITY;
            for (i, target) in own.surfaces.iter().enumerate() {
                let radiance = Self { target: target.clone(), ..self.clone() }.photon_radiance();
                for pair in (0..other.surfaces.len()).filter_map(|j| found.pair(i, j)) {
                    least = least.min(sure(pair).max(0.0).powi(2) * radiance);
                }
            }
            least
        });
        let (mut target, mut alternative) = (own.surfaces[a].clone(), other.surfaces[b].clone());
        let worst = found.pair(a, b).copied();
        let distance = worst.map_or(f64::NAN, |pair| pair.distance.unwrap_or(pair.lower));
        let mut answer = ClassAnswer {
            target: own.side(),
            alternative: other.side(),
            pairs: own.surfaces.len() * other.surfaces.len(),
            searched: found.pairs.iter().filter(|pair| pair.distance.is_some()).count(),
            statistical,
            required: statistical.then_some(self.required),
            worst: [target.name.clone(), alternative.name.clone()],
            distance,
            distance_lower: worst.as_ref().map_or(0.0, sure),
            told_apart: statistical.then(|| found.pairs.iter().all(|pair| sure(pair) >= required)),
            share_of_pairs_told: share_told,
            mean_detection_probability: mean_probability,
            leave_one_out,
            mixtures: None,
            least_information,
            distances: found,
        };
        if own.mixtures() || other.mixtures() {
            if self.errors_shared().is_some() {
                let found =
                    "mixtures of a class are not proved with errors that the pixels of an object share";
                let error = Error::malformed(found, "leave mixtures or [sensitivity] out");
                let mixed = if own.mixtures() { own } else { other };
                return Err(error.at(self.scenario.place(&format!("class.{}.mixtures", mixed.name))));
            }
            let (pair, mixtures) = self.worst_mixture(own, other, (a, b), distance)?;
            (target, alternative) = pair;
            if let Some(told) = &mut answer.told_apart {
                *told &= mixtures.distance_lower >= required;
            }
            answer.mixtures = Some(mixtures);
        }
        Ok(((target, alternative), answer))
    }

    /// The statistical distance that surely suffices for every member of the target's class.
    fn required_of_members(&self, own: &Members) -> f64 {
        let of = |target: &Surface| {
            let study = Self { target: target.clone(), ..self.clone() };
            study.counting().map_or(self.required, |counting| study.surely_required(&counting))
        };
        own.surfaces.iter().map(of).fold(self.required, f64::max)
    }

    /// Distances of all pairs of members, by the distance that decides: with a camera statistical.
    fn member_distances(&self, own: &Members, other: &Members, skipping: Skipping) -> Result<ClassDistances> {
        let kind = self.scenario.requirement.by;
        let studies: Vec<Self> =
            own.surfaces.iter().map(|target| Self { target: target.clone(), ..self.clone() }).collect();
        if kind == DistanceKind::Nearest && !self.unknowns.has_priors() && self.errors_shared().is_none() {
            let countings: Option<Vec<Counting>> = studies.iter().map(Self::counting).collect();
            fn spectra(surfaces: &[Surface]) -> Vec<&[f64]> {
                surfaces.iter().map(|surface| surface.emissivity.as_slice()).collect()
            }
            let (targets, alternatives) = (spectra(&own.surfaces), spectra(&other.surfaces));
            let scene = self.library_scene();
            let classes = Classes { scene: &scene, targets: &targets, alternatives: &alternatives };
            let required = self.camera.as_ref().map(|_| self.required_of_members(own));
            return classes.distances(countings.as_deref(), required, skipping, &|_, _| ());
        }
        // Local distances take less time than bounds on them would, priors hang on the photons, and shared errors on the pair.
        let pair = |(study, alternative): (&Self, &Surface)| {
            let (distance, lower, relative_error) = match study.counting() {
                Some(counting) => {
                    let found = study.statistical(kind, alternative, &counting)?;
                    (found.distance, found.lower, found.relative_error.unwrap_or(0.0))
                }
                None if study.unknowns.has_priors() => {
                    let photons = study.photons_with_priors(kind, alternative)?;
                    let enough = match kind {
                        DistanceKind::Nearest => study.photons_enough_with_priors(alternative, photons)?,
                        _ => photons,
                    };
                    let [distance, lower] = [photons, enough]
                        .map(|photons| photons.map_or(0.0, |photons| study.required / photons.sqrt()));
                    (distance, lower, 0.0)
                }
                None => {
                    let distance = study.distance_per_photon(kind, alternative, f64::INFINITY)?;
                    (distance, distance, 0.0)
                }
            };
            Ok(MemberPair { distance: Some(distance), lower, relative_error })
        };
        let pairs =
            studies.iter().flat_map(|study| other.surfaces.iter().map(move |surface| (study, surface)));
        let pairs = pairs.map(pair).collect::<Result<_>>()?;
        Ok(ClassDistances { alternatives: other.surfaces.len(), pairs })
    }
}
