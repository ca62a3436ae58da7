//! Where a category that matters for safety cannot be excluded, of a target against its alternatives, and of every material of a matrix.
//!
//! With the half separation d of the target and a member of the category, in units of the noise, no test that wrongly excludes the member
//! in at most 1 % of the readings excludes it more often than Φ(2d − z), z = Φ⁻¹(0.99) = 2.326 (Neyman and Pearson; many photons, the two
//! nearest states known). It is left among what 99 % leave with the probability Φ(z − 2d) at least, where d is that of a state that was
//! found. It counts as excluded only where the least d that is proved reaches z, the camera tells the two as reliably as is demanded, and
//! nothing spoils its readings (a full well, blur, a decision too late: what spoils a verdict); of a class only where that is proved of all
//! its members, and of all mixtures where they belong to it. A member that was not compared, or no camera, excludes nothing.
//!
//! An exclusion rests on conditions as a 'yes' does: those of a verdict that demands z of the materials that are excluded, whatever the
//! scenario demands and whatever its verdict on others is.

use super::results::{PairResult, SafetyMaterial, SafetyOfTarget};
use crate::classes::Members;
use crate::condition::Condition;
use crate::decision::YesNo;
use crate::{Shortfall, Study, Surface};
use hadar::error::{Error, Result};
use hadar::identifiability::detection;
use hadar::parallel;
use hadar_scenario::DistanceKind;
use hadar_scenario::decompose::CategorySpec;

/// Φ⁻¹(0.99).
pub(crate) const AT_99: f64 = 2.326_347_874_040_841;

/// A material of the category beside what is there.
#[derive(Debug, Clone, Copy)]
struct Beside {
    /// Its place among the alternatives.
    index: usize,
    /// d of the nearest state that was found; `None` without a camera.
    found: Option<f64>,
    /// What is proved of d, where that and the camera exclude it.
    excluded_by: Option<f64>,
}

impl Study {
    /// Of every category with `safety = true`.
    ///
    /// # Errors
    /// As [`Study::identify`].
    pub(crate) fn safety(&self, pairs: &[PairResult]) -> Result<Vec<SafetyOfTarget>> {
        if self.safety_specs().next().is_none() {
            return Ok(Vec::new());
        }
        let class = self.classes.first().map(|answer| &answer.target);
        let target = class.map_or(&self.target.name, |class| &class.name);
        let members = class.into_iter().flat_map(|class| &class.members);
        let own: Vec<&str> = members.chain([&self.target.name, target]).map(String::as_str).collect();
        // A class stands for all of its members.
        let names = |i: usize| {
            let class = self.classes.get(i);
            [Some(&pairs[i].alternative), class.map(|class| &class.alternative.name)]
        };
        let spoiled = self.spoiled_here();
        let beside = |name: &String| -> Vec<Beside> {
            let is_it = |i: &usize| names(*i).into_iter().flatten().any(|other| other == name);
            (0..pairs.len()).filter(is_it).map(|i| self.beside(i, &pairs[i], &spoiled)).collect()
        };
        self.safety_specs().map(|spec| self.safety_of(spec, target, &own, beside, (self, &spoiled))).collect()
    }

    /// The same of every material of a matrix as the target, by the distances that [`Study::identify`] would give it.
    ///
    /// # Errors
    /// As [`Study::identify`].
    pub(super) fn safety_of_matrix(&self, materials: &[&Surface]) -> Result<Vec<SafetyOfTarget>> {
        if self.safety_specs().next().is_none() {
            return Ok(Vec::new());
        }
        let is_asked = |surface: &Surface| {
            self.safety_specs().any(|spec| spec.materials.iter().any(|name| self.is_of(&surface.name, name)))
        };
        let rows = parallel::booked(materials.len(), |i| {
            let target = materials[i];
            let others = materials.iter().filter(|other| other.name != target.name && is_asked(other));
            let own = self.facing(target, others.copied());
            let spoiled = own.spoiled_here();
            let known = (0..own.alternatives.len()).map(|index| own.beside_surface(index, &spoiled));
            let known = known.collect::<Result<Vec<Beside>>>()?;
            let beside = |name: &String| -> Vec<Beside> {
                let is_it = |one: &&Beside| self.is_of(&own.alternatives[one.index].name, name);
                let mut found: Vec<Beside> = known.iter().filter(is_it).copied().collect();
                if self.is_mixed(name) {
                    // Members were compared one by one, and not their mixtures.
                    found.push(Beside { index: usize::MAX, found: None, excluded_by: None });
                }
                found
            };
            let name = target.name.as_str();
            let of = |spec| self.safety_of(spec, name, &[name], beside, (&own, &spoiled));
            self.safety_specs().map(of).collect::<Result<Vec<_>>>()
        })?;
        Ok(rows.into_iter().flatten().collect())
    }

    /// The same with one member as the target, and others as the alternatives, each by itself.
    fn facing<'s>(&self, target: &Surface, others: impl Iterator<Item = &'s Surface>) -> Self {
        let of = |surface: &Surface| {
            let own = |members: &&Members| members.surfaces.iter().any(|one| one.name == surface.name);
            let group = self.members.iter().flatten().find(own);
            let (surfaces, weights) = (vec![surface.clone()], vec![1.0]);
            match group {
                Some(group) => Members { surfaces, weights, ..group.clone() },
                None => Members::new(&surface.name, None, surfaces, weights),
            }
        };
        let alternatives: Vec<Surface> = others.cloned().collect();
        Self {
            target: target.clone(),
            members: [vec![of(target)], alternatives.iter().map(of).collect()],
            alternatives,
            paired: Vec::new(),
            classes: Vec::new(),
            ..self.clone()
        }
    }

    /// What spoils the readings of the scenario's camera.
    pub(crate) fn spoiled_here(&self) -> Vec<Shortfall> {
        self.spoiled(self.camera_result(self.photon_radiance()).as_ref())
    }

    /// Refuses `safety = true` where nothing can be said of it.
    pub(crate) fn no_safety(&self, found: &str) -> Result<()> {
        let Some(place) = self.scenario.categories.iter().position(|spec| spec.safety) else {
            return Ok(());
        };
        let instead = "leave the key out, and ask `hadar identify` where it cannot be excluded";
        let key = format!("category[{place}].safety");
        Err(Error::malformed(found, instead).at(self.scenario.place(&key)))
    }

    fn safety_specs(&self) -> impl Iterator<Item = &CategorySpec> {
        self.scenario.categories.iter().filter(|spec| spec.safety)
    }

    /// Whether a name of a category means a surface: its own name, that of its class, or that of the material within the class.
    fn is_of(&self, surface: &str, name: &str) -> bool {
        let own = |class: &&Members| class.is_class() && class.surfaces.iter().any(|one| one.name == surface);
        let within = |class: &Members| {
            let rest = surface.strip_prefix(class.name.as_str());
            class.name == name || rest.and_then(|rest| rest.strip_prefix('/')) == Some(name)
        };
        surface == name || self.members.iter().flatten().filter(own).any(within)
    }

    /// Surfaces that are entered as one number, of those that are asked for.
    pub(crate) fn constants(&self, is_asked: impl Fn(&str) -> bool) -> Vec<String> {
        let members = self.members.iter().flatten().flat_map(|class| &class.surfaces);
        let all = std::iter::once(&self.target).chain(&self.alternatives).chain(members);
        let mut names: Vec<String> = Vec::new();
        for surface in all.filter(|surface| surface.one_number.is_some() && is_asked(&surface.name)) {
            if !names.contains(&surface.name) {
                names.push(surface.name.clone());
            }
        }
        names
    }

    fn is_mixed(&self, name: &String) -> bool {
        self.members.iter().flatten().any(|members| members.name == *name && members.mixtures())
    }

    /// `own` are all names of what is there, `beside` says what is known of a material of the category by its place among the alternatives of
    /// `seen`, whose readings are `spoiled`.
    fn safety_of(
        &self,
        spec: &CategorySpec,
        target: &str,
        own: &[&str],
        beside: impl Fn(&String) -> Vec<Beside>,
        (seen, spoiled): (&Self, &[Shortfall]),
    ) -> Result<SafetyOfTarget> {
        let is_own = |name: &String| own.iter().any(|surface| self.is_of(surface, name));
        let is_target = spec.materials.iter().any(is_own);
        let mut proved: Vec<(usize, f64)> = Vec::new();
        let mut material = |name: &String| {
            let all = beside(name);
            let left =
                all.iter().filter_map(|one| one.found).map(|d| detection::miss_probability(2.0 * d - AT_99));
            let excluded = !all.is_empty() && all.iter().all(|one| one.excluded_by.is_some());
            if excluded {
                proved.extend(all.iter().filter_map(|one| Some((one.index, one.excluded_by?))));
            }
            SafetyMaterial {
                material: name.clone(),
                compared: !all.is_empty(),
                excluded,
                probability_left_at_least: left.max_by(f64::total_cmp),
            }
        };
        let materials: Vec<SafetyMaterial> = spec.materials.iter().map(&mut material).collect();
        Ok(SafetyOfTarget {
            category: spec.name.clone(),
            target: target.to_owned(),
            is_target,
            constants: self.constants(|name| {
                own.contains(&name) || spec.materials.iter().any(|one| self.is_of(name, one))
            }),
            excluded: !is_target && materials.iter().all(|one| one.excluded),
            materials,
            conditions: seen.conditions_of_exclusion(&proved)?,
            spoiled_by: spoiled.to_vec(),
        })
    }

    /// What it rests on that these alternatives are excluded, of each of which so much is proved.
    fn conditions_of_exclusion(&self, proved: &[(usize, f64)]) -> Result<Vec<Condition>> {
        match &self.camera {
            Some(camera) if !proved.is_empty() => {
                let strict = Self { required: self.required.max(AT_99), ..self.clone() };
                strict.conditions_of_told(camera, proved, &[])
            }
            _ => Ok(Vec::new()),
        }
    }

    /// Of the pair of an alternative, which of a class is its worst.
    fn beside(&self, index: usize, pair: &PairResult, spoiled: &[Shortfall]) -> Beside {
        let found = pair.statistical_distance_bounds.map(|[_, upper]| upper);
        let nearest = pair.statistical_distance_nearest.or(found);
        let lower = pair.statistical_distance_bounds.map_or(0.0, |[lower, _]| lower);
        let class = self.classes.get(index);
        let proved = class.map_or(lower, |class| lower.min(class.decisive()));
        let all_told = class.is_none_or(|class| class.told_apart == Some(true));
        let excludes = self.excludes(pair.told, proved, spoiled) && all_told;
        Beside {
            index,
            found: nearest.map(|d| d.max(found.unwrap_or(0.0))),
            excluded_by: excludes.then_some(proved),
        }
    }

    /// Of the target and an alternative that is looked at by itself.
    fn beside_surface(&self, index: usize, spoiled: &[Shortfall]) -> Result<Beside> {
        let (kind, other) = (self.scenario.requirement.by, &self.alternatives[index]);
        let Some(counting) = self.counting() else {
            return Ok(Beside { index, found: None, excluded_by: None });
        };
        self.book_distances(kind, 1);
        let decision = self.decided(kind, other, &counting)?;
        let [lower, upper] = decision.found.bounds();
        let nearest = match kind {
            DistanceKind::Nearest => upper,
            DistanceKind::Local | DistanceKind::LocalUnknownGain => {
                self.statistical_distance(DistanceKind::Nearest, other, &counting)?
            }
        };
        let excludes = self.excludes(Some(decision.told), lower, spoiled);
        Ok(Beside { index, found: Some(nearest.max(upper)), excluded_by: excludes.then_some(lower) })
    }

    /// Only the nearest distance, with what is proved of it, excludes, by readings that nothing spoils; of an object with the errors that its
    /// pixels share.
    fn excludes(&self, told: Option<YesNo>, lower: f64, spoiled: &[Shortfall]) -> bool {
        self.scenario.requirement.by == DistanceKind::Nearest
            && (self.errors_shared().is_some() || !self.scenario.is_of_object())
            && spoiled.is_empty()
            && told == Some(YesNo::Yes)
            && lower >= AT_99
    }
}
