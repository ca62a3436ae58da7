//! What is there by categories: a map of materials segmented, the objects in it, and how it agrees with the truth.

use super::DecomposeStudy;
use super::kept::Block;
use super::truth::Truth;
use hadar::error::Result;
use hadar_estimate::decompose::Maps;
use hadar_estimate::segmentation::{
    Agreement, ByBrightness, NO_CATEGORY, Object, Rule, objects, segment, smoothed,
};
use hadar_scenario::decompose::CategorySpec;
use serde::Serialize;

/// Number of a pixel whose truth is not known, unless it is a label.
const NOT_KNOWN: usize = 255;

/// A cube segmented.
#[derive(Debug, Clone, Serialize)]
pub struct Segmented {
    /// By which rule.
    pub rule: Rule,
    /// Whether each pixel took the commonest category of 5 × 5 in the end.
    pub smoothing: bool,
    /// Of each category.
    pub categories: Vec<CategoryRow>,
    /// Pixels of no category.
    pub none: usize,
    /// Connected parts, the largest first.
    pub objects: Vec<ObjectRow>,
    /// Pixels of the smallest object that is listed.
    pub smallest_object: usize,
    /// Against the truth, where it is known.
    pub agreement: Option<Agreement>,
    /// The best that the thermal image alone can say, laid out with the truth, against it.
    pub agreement_by_brightness: Option<Agreement>,
    /// The map, `[row][column]`.
    #[serde(skip)]
    pub map: Vec<u8>,
}

/// What was found of a category.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct CategoryRow {
    /// Its name.
    pub category: String,
    /// Its pixels.
    pub pixels: usize,
    /// Those of them that have one material left, of this category.
    pub decided: usize,
    /// Its objects.
    pub objects: usize,
}

/// What was found of an object.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ObjectRow {
    /// The name of its category.
    pub category: String,
    /// Its pixels.
    pub pixels: usize,
    /// Those of them that have one material left, of this category.
    pub decided: usize,
    /// Its first row, and the one after its last.
    pub rows: [usize; 2],
    /// Its first column, and the one after its last.
    pub columns: [usize; 2],
    /// Median of the temperatures of its decided pixels, K; NaN without.
    pub temperature_median_k: f64,
    /// Median of their deviations, each of a pixel, K.
    pub temperature_sigma_median_k: f64,
}

impl Segmented {
    /// Of the maps of all pixels of a study; nothing without categories.
    pub(super) fn of(study: &DecomposeStudy, block: &Block) -> Result<Option<Self>> {
        let (specs, spec) = (&study.scenario.categories, study.scenario.segmentation);
        if specs.is_empty() {
            return Ok(None);
        }
        let Block { maps, thermal, .. } = block;
        let columns = study.cube.shape().columns();
        let last = |map: Vec<u8>| if spec.smoothing { smoothed(&map, columns) } else { Ok(map) };
        let map = last(segment(&maps.fitting_material(), columns, &study.categories, spec.rule)?)?;
        let found = objects(&map, columns, spec.smallest_object)?;
        // Decided to be of the category that the pixel was given.
        let is_decided: Vec<bool> = (0..map.len())
            .map(|i| maps.is_decided(i) && study.categories.contains(map[i], maps.material[i]))
            .collect();
        let mut categories: Vec<CategoryRow> = specs
            .iter()
            .map(|spec| CategoryRow { category: spec.name.clone(), pixels: 0, decided: 0, objects: 0 })
            .collect();
        for (category, is_decided) in map.iter().zip(&is_decided) {
            if let Some(row) = categories.get_mut(usize::from(*category)) {
                row.pixels += 1;
                row.decided += usize::from(*is_decided);
            }
        }
        let mut decided: Vec<Vec<usize>> = vec![Vec::new(); found.all.len()];
        for (i, object) in found.of_pixel.iter().enumerate().filter(|(i, _)| is_decided[*i]) {
            if let Some(pixels) = object.and_then(|object| decided.get_mut(object as usize)) {
                pixels.push(i);
            }
        }
        let objects: Vec<ObjectRow> = found
            .all
            .iter()
            .zip(&decided)
            .map(|(object, decided)| row(object, decided, maps, specs))
            .collect();
        for object in &found.all {
            if let Some(row) = categories.get_mut(usize::from(object.category)) {
                row.objects += 1;
            }
        }
        let (mut agreement, mut agreement_by_brightness) = (None, None);
        let there = study.truth.as_ref().map(Truth::all).transpose()?;
        if let Some(labels) = there.and_then(|there| there.category) {
            let truth: Vec<Option<u8>> = labels.iter().map(|label| of_label(specs, *label)).collect();
            agreement = Some(Agreement::of(&map, truth.iter().copied(), specs.len()));
            let known: Vec<u8> = truth.iter().map(|one| one.unwrap_or(NO_CATEGORY)).collect();
            let thermal = last(ByBrightness::learned(thermal, &known).of(thermal))?;
            agreement_by_brightness = Some(Agreement::of(&thermal, truth, specs.len()));
        }
        Ok(Some(Self {
            rule: spec.rule,
            smoothing: spec.smoothing,
            none: map.iter().filter(|category| **category == NO_CATEGORY).count(),
            categories,
            objects,
            smallest_object: spec.smallest_object,
            agreement,
            agreement_by_brightness,
            map,
        }))
    }
}

fn row(object: &Object, decided: &[usize], maps: &Maps, specs: &[CategorySpec]) -> ObjectRow {
    let median = |of: &[f32]| {
        let mut values: Vec<f32> =
            decided.iter().filter_map(|i| of.get(*i).copied()).filter(|x| x.is_finite()).collect();
        values.sort_by(f32::total_cmp);
        values.get(values.len() / 2).map_or(f64::NAN, |x| f64::from(*x))
    };
    ObjectRow {
        category: specs.get(usize::from(object.category)).map_or_else(String::new, |spec| spec.name.clone()),
        pixels: object.pixels,
        decided: decided.len(),
        rows: object.rows,
        columns: object.columns,
        temperature_median_k: median(&maps.temperature_k),
        temperature_sigma_median_k: median(&maps.temperature_sigma_k),
    }
}

/// What a number of the map of the truth stands for: a category, none of them, or that it is not known.
fn of_label(specs: &[CategorySpec], label: usize) -> Option<u8> {
    let has_labels = specs.iter().any(|spec| !spec.labels.is_empty());
    let place = match has_labels {
        true => specs.iter().position(|spec| spec.labels.contains(&label)),
        false => Some(label).filter(|label| *label < specs.len()),
    };
    match place {
        Some(place) => u8::try_from(place).ok(),
        None => (label != NOT_KNOWN).then_some(NO_CATEGORY),
    }
}
