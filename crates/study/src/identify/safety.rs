//! Where a category that matters for safety cannot be excluded, of a target against its alternatives.
//!
//! With the half separation d of the target and a member of the category, in units of the noise, no test that wrongly excludes the member
//! in at most 1 % of the readings excludes it more often than Φ(2d − z), z = Φ⁻¹(0.99) = 2.326 (Neyman and Pearson; many photons, the two
//! nearest states known). It is left among what 99 % leave with the probability Φ(z − 2d) at least, where d is that of a state that was
//! found. It counts as excluded only where the least d that is proved reaches z, and the camera tells the two as reliably as is demanded.
//! A member that was not compared, or no camera, excludes nothing.

use super::results::{PairResult, SafetyMaterial, SafetyOfTarget};
use crate::Study;
use crate::decision::YesNo;
use hadar::identifiability::detection;
use hadar_scenario::DistanceKind;
use hadar_scenario::decompose::CategorySpec;

/// Φ⁻¹(0.99).
pub(crate) const AT_99: f64 = 2.326_347_874_040_841;

impl Study {
    /// Of every category with `safety = true`.
    pub(super) fn safety(&self, pairs: &[PairResult]) -> Vec<SafetyOfTarget> {
        let all = self.scenario.categories.iter().filter(|spec| spec.safety);
        all.map(|spec| self.safety_of(spec, pairs)).collect()
    }

    fn safety_of(&self, spec: &CategorySpec, pairs: &[PairResult]) -> SafetyOfTarget {
        // A class stands for all of its members.
        let names = |i: usize| {
            let class = self.classes.get(i);
            [Some(&pairs[i].alternative), class.map(|class| &class.alternative.name)]
        };
        let own = [Some(&self.target.name), self.classes.first().map(|class| &class.target.name)];
        let is_target = own.into_iter().flatten().any(|name| spec.materials.contains(name));
        let material = |name: &String| {
            let is_own = |i: &usize| names(*i).into_iter().flatten().any(|other| other == name);
            let own: Vec<&PairResult> = (0..pairs.len()).filter(is_own).map(|i| &pairs[i]).collect();
            let left = own.iter().filter_map(|pair| {
                let found = pair.statistical_distance_bounds.map(|[_, upper]| upper);
                let d = pair.statistical_distance_nearest.or(found)?.max(found.unwrap_or(0.0));
                Some(detection::miss_probability(2.0 * d - AT_99))
            });
            SafetyMaterial {
                material: name.clone(),
                compared: !own.is_empty(),
                excluded: !own.is_empty() && own.iter().all(|pair| self.excludes(pair)),
                probability_left_at_least: left.max_by(f64::total_cmp),
            }
        };
        let materials: Vec<SafetyMaterial> = spec.materials.iter().map(material).collect();
        SafetyOfTarget {
            category: spec.name.clone(),
            target: self.target.name.clone(),
            is_target,
            excluded: !is_target && materials.iter().all(|one| one.excluded),
            materials,
        }
    }

    /// Only the nearest distance, with what is proved of it, excludes.
    fn excludes(&self, pair: &PairResult) -> bool {
        let lower = pair.statistical_distance_bounds.map_or(0.0, |[lower, _]| lower);
        self.scenario.requirement.by == DistanceKind::Nearest
            && pair.told == Some(YesNo::Yes)
            && lower >= AT_99
    }
}
