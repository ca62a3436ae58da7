//! Where a category that matters for safety cannot be excluded.
//!
//! It cannot where one of its materials is among what 99 % of the posterior leave, or would be were its prior a half
//! ([`hadar_estimate::decompose::possible`]); where nothing fits, nothing tells or a sample is missing, it cannot either. The bound on how
//! many of its pixels are missed is that of the model: if it and the library hold, one in a hundred of the pixels that it fills, not of the
//! objects; a pixel of several surfaces is none of the model, and fits something else now and then.

use super::DecomposeStudy;
use hadar::error::Result;
use hadar_estimate::decompose::Maps;
use hadar_estimate::decompose::possible::MISSED;
use hadar_estimate::segmentation::{Claims, Told, groups};
use serde::Serialize;

/// Where a category cannot be excluded.
#[derive(Debug, Clone, Serialize)]
pub struct SafetyRow {
    /// Name of the category that matters for safety.
    pub category: String,
    /// Pixels in which it cannot be excluded: all of them while the cube does not follow its model.
    pub pixels: usize,
    /// Their share of all pixels.
    pub share: f64,
    /// The share of the pixels in which it cannot be excluded if the model holds.
    pub share_if_model_holds: f64,
    /// Its materials that are entered as one number: that it is excluded rests on them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub constants: Vec<String>,
    /// Connected parts of them (by a side or a corner), of any size, the largest first.
    pub objects: Vec<NotExcluded>,
    /// Share of the pixels filled by the category in which it is excluded all the same, at most, if the model and the library hold; a bound
    /// of pixels, not of objects.
    pub bound_missed: f64,
    /// 1 where it cannot be excluded, 2 where it could be if the model held, `[row][column]`.
    #[serde(skip)]
    pub map: Vec<u8>,
}

/// Connected pixels in which a category cannot be excluded.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct NotExcluded {
    /// Number of connected pixels in this place.
    pub pixels: usize,
    /// Those of them that are decided to be of the category by themselves.
    pub decided: usize,
    /// Its first row, and the one after its last.
    pub rows: [usize; 2],
    /// Its first column, and the one after its last.
    pub columns: [usize; 2],
}

impl SafetyRow {
    /// Takes back what rests on a model that the cube does not follow.
    pub(super) fn take_back(&mut self) {
        (self.pixels, self.share) = (self.map.len(), 1.0);
        self.map.iter_mut().filter(|one| **one == 0).for_each(|one| *one = 2);
        self.objects.iter_mut().for_each(|object| object.decided = 0);
    }
}

/// Of every category with `safety = true`.
pub(super) fn rows(study: &DecomposeStudy, maps: &Maps, claims: &Claims) -> Result<Vec<SafetyRow>> {
    let columns = study.cube.shape().columns();
    let sets_of = study.categories.sets();
    let all = study.scenario.categories.iter().enumerate().filter(|(_, spec)| spec.safety);
    all.map(|(place, spec)| {
        let sets: Vec<u64> =
            (0..claims.category.len()).map(|i| maps.possible(i).at_99 >> place & 1).collect();
        let is_own =
            |(category, told): (&u8, &Told)| *told == Told::ByItself && usize::from(*category) == place;
        let is_decided: Vec<bool> = claims.category.iter().zip(&claims.told).map(is_own).collect();
        let found = groups(&sets, &is_decided, columns, 1)?;
        let pixels = sets.iter().filter(|one| **one == 1).count();
        let object = |group: hadar_estimate::segmentation::Group| NotExcluded {
            pixels: group.pixels,
            decided: group.decided,
            rows: group.rows,
            columns: group.columns,
        };
        let own = study.constants().filter(|m| sets_of.get(*m).is_some_and(|set| set >> place & 1 == 1));
        Ok(SafetyRow {
            category: spec.name.clone(),
            pixels,
            constants: own.map(|m| study.names[m].clone()).collect(),
            share: pixels as f64 / sets.len().max(1) as f64,
            share_if_model_holds: pixels as f64 / sets.len().max(1) as f64,
            objects: found.all.into_iter().map(object).collect(),
            bound_missed: MISSED,
            map: sets.into_iter().map(|one| one as u8).collect(),
        })
    })
    .collect()
}
