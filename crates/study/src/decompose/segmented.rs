//! What is there by categories: what pixels are told to be, the objects in it, and how it agrees with the truth.
//!
//! A pixel has a category only where it is told ([`claims`]); what is likeliest is kept beside it under that name.

use super::DecomposeStudy;
use super::kept::Block;
use super::safety::{self, SafetyRow};
use super::truth::Truth;
use hadar::error::Result;
use hadar_estimate::decompose::Maps;
use hadar_estimate::decompose::possible::OTHER;
use hadar_estimate::segmentation::{
    Agreement, ByBrightness, Group, NO_CATEGORY, Rule, Told, claims, groups, segment, smoothed,
};
use hadar_scenario::decompose::CategorySpec;
use serde::Serialize;

/// Number of a pixel whose truth is not known, unless it is a label.
const NOT_KNOWN: usize = 255;

/// A cube segmented.
#[derive(Debug, Clone, Serialize)]
pub struct Segmented {
    /// The rule by which pixels were segmented.
    pub rule: Rule,
    /// Whether the likeliest category of each pixel is the commonest of 5 × 5 in the end; no finding rests on it.
    pub smoothing: bool,
    /// What was found of each category.
    pub categories: Vec<CategoryRow>,
    /// Pixels all candidates of which are in no category.
    pub none: usize,
    /// Pixels without a category: their candidates are of several that their neighbours do not settle, or nothing fits, nothing tells, or a
    /// sample is missing.
    pub undecided: usize,
    /// Connected parts, the largest first: all that have a decided pixel, and all of `smallest_object` pixels or more.
    pub objects: Vec<ObjectRow>,
    /// Pixels from which on an object is listed for certain.
    pub smallest_object: usize,
    /// Objects that are not listed: smaller ones without a decided pixel.
    pub objects_not_listed: usize,
    /// Where each category with `safety = true` cannot be excluded; empty without such categories.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub safety: Vec<SafetyRow>,
    /// Against the truth, where it is known.
    pub agreement: Option<Agreement>,
    /// The likeliest categories against it.
    pub agreement_of_likeliest: Option<Agreement>,
    /// The best that the thermal image alone can say, laid out with the truth, against it.
    pub agreement_by_brightness: Option<Agreement>,
    /// The map, `[row][column]`; [`NO_CATEGORY`] where a pixel is of none or undecided.
    #[serde(skip)]
    pub map: Vec<u8>,
    /// Whether each pixel is undecided.
    #[serde(skip)]
    pub is_undecided: Vec<bool>,
    /// The likeliest category of each pixel.
    #[serde(skip)]
    pub likeliest: Vec<u8>,
}

/// What was found of a category.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct CategoryRow {
    /// Name of the category of materials.
    pub category: String,
    /// Number of pixels of the category.
    pub pixels: usize,
    /// Those of them that are decided by themselves: all their candidates are of this category alone; none while the cube does not follow
    /// its model.
    pub decided: usize,
    /// Its objects that are listed.
    pub objects: usize,
}

/// What was found of an object.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ObjectRow {
    /// The name of its category, or the names of all that it may be of with `or` between them.
    pub category: String,
    /// Number of pixels of the object.
    pub pixels: usize,
    /// Those of them that are decided by themselves: all their candidates are of this category alone; none while the cube does not follow
    /// its model.
    pub decided: usize,
    /// What it may be where that is not settled; empty where it has a category.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub possible: Vec<PossibleRow>,
    /// Its first row, and the one after its last.
    pub rows: [usize; 2],
    /// Its first column, and the one after its last.
    pub columns: [usize; 2],
    /// Median of the temperatures of its pixels that have one material left, K; NaN without.
    pub temperature_median_k: f64,
    /// Median of their deviations, each of a pixel, K.
    pub temperature_sigma_median_k: f64,
}

/// A category that an object may be of.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PossibleRow {
    /// Its name; `none` for materials in no category.
    pub category: String,
    /// Posterior of its materials by the counts of the object's pixels, in the mean over them; the posterior of a material of several
    /// categories in equal parts. It knows nothing of the object's form, and is none that the object as a whole is of the category.
    pub probability: f64,
}

impl Segmented {
    /// Takes back what rests on a model that the cube does not follow: nothing is decided, nothing that matters for safety excluded.
    pub(super) fn take_back(&mut self) {
        self.categories.iter_mut().for_each(|row| row.decided = 0);
        self.objects.iter_mut().for_each(|row| row.decided = 0);
        self.safety.iter_mut().for_each(SafetyRow::take_back);
    }

    /// Of the maps of all pixels of a study; nothing without categories.
    pub(super) fn of(study: &DecomposeStudy, block: &Block) -> Result<Option<Self>> {
        let (specs, spec) = (&study.scenario.categories, study.scenario.segmentation);
        if specs.is_empty() {
            return Ok(None);
        }
        let Block { maps, thermal, .. } = block;
        let columns = study.cube.shape().columns();
        let pixels = maps.material.len();
        let last = |map: Vec<u8>| if spec.smoothing { smoothed(&map, columns) } else { Ok(map) };
        let likeliest = last(segment(&maps.fitting_material(), columns, &study.categories, spec.rule)?)?;
        let possible: Vec<u64> = (0..pixels).map(|i| maps.possible(i).at_95).collect();
        let common: Vec<u64> = (0..pixels).map(|i| maps.possible(i).common_95).collect();
        let places = specs.iter().enumerate().filter(|(_, spec)| spec.safety);
        let safety = places.fold(0, |set, (place, _)| set | 1 << place);
        let claims = claims(&possible, &common, columns, &study.categories, spec.rule, safety)?;
        let is = |told: Told| claims.told.iter().map(move |one| *one == told);
        let is_decided: Vec<bool> = is(Told::ByItself).collect();
        let found = groups(&claims.sets(&possible), &is_decided, columns, spec.smallest_object)?;
        let mut categories: Vec<CategoryRow> = specs
            .iter()
            .map(|spec| CategoryRow { category: spec.name.clone(), pixels: 0, decided: 0, objects: 0 })
            .collect();
        for (category, is_decided) in claims.category.iter().zip(&is_decided) {
            if let Some(row) = categories.get_mut(usize::from(*category)) {
                row.pixels += 1;
                row.decided += usize::from(*is_decided);
            }
        }
        for group in found.all.iter().filter(|group| group.possible.is_power_of_two()) {
            if let Some(row) = categories.get_mut(group.possible.trailing_zeros() as usize) {
                row.objects += 1;
            }
        }
        let mut own: Vec<Vec<usize>> = vec![Vec::new(); found.all.len()];
        for (i, object) in found.of_pixel.iter().enumerate() {
            if let Some(pixels) = object.and_then(|object| own.get_mut(object as usize)) {
                pixels.push(i);
            }
        }
        let objects = found.all.iter().zip(&own).map(|(group, pixels)| row(group, pixels, maps, specs));
        let objects: Vec<ObjectRow> = objects.collect();
        let is_undecided: Vec<bool> = is(Told::Undecided).collect();
        let (mut agreement, mut agreement_of_likeliest, mut agreement_by_brightness) = (None, None, None);
        let there = study.truth.as_ref().map(Truth::all).transpose()?;
        if let Some(labels) = there.and_then(|there| there.category) {
            let truth: Vec<Option<u8>> = labels.iter().map(|label| of_label(specs, *label)).collect();
            let all = || truth.iter().copied();
            agreement = Some(Agreement::with_undecided(&claims.category, &is_undecided, all(), specs.len()));
            agreement_of_likeliest = Some(Agreement::of(&likeliest, all(), specs.len()));
            let known: Vec<u8> = truth.iter().map(|one| one.unwrap_or(NO_CATEGORY)).collect();
            let thermal = last(ByBrightness::learned(thermal, &known).of(thermal))?;
            agreement_by_brightness = Some(Agreement::of(&thermal, all(), specs.len()));
        }
        Ok(Some(Self {
            rule: spec.rule,
            smoothing: spec.smoothing,
            none: is(Told::OfNone).filter(|is| *is).count(),
            undecided: is_undecided.iter().filter(|is| **is).count(),
            categories,
            objects,
            smallest_object: spec.smallest_object,
            objects_not_listed: found.left_out,
            safety: safety::rows(study, maps, &claims)?,
            agreement,
            agreement_of_likeliest,
            agreement_by_brightness,
            map: claims.category,
            is_undecided,
            likeliest,
        }))
    }
}

fn row(group: &Group, pixels: &[usize], maps: &Maps, specs: &[CategorySpec]) -> ObjectRow {
    let median = |of: &[f32]| {
        let told = pixels.iter().filter(|i| maps.is_decided(**i));
        let mut values: Vec<f32> =
            told.filter_map(|i| of.get(*i).copied()).filter(|x| x.is_finite()).collect();
        values.sort_by(f32::total_cmp);
        values.get(values.len() / 2).map_or(f64::NAN, |x| f64::from(*x))
    };
    let possible = possible(group, pixels, maps, specs);
    let names: Vec<&str> = possible.iter().map(|row| row.category.as_str()).collect();
    ObjectRow {
        category: names.join(" or "),
        pixels: group.pixels,
        decided: group.decided,
        rows: group.rows,
        columns: group.columns,
        temperature_median_k: median(&maps.temperature_k),
        temperature_sigma_median_k: median(&maps.temperature_sigma_k),
        possible: if possible.len() > 1 { possible } else { Vec::new() },
    }
}

/// What an object may be, in the order of the categories.
fn possible(group: &Group, pixels: &[usize], maps: &Maps, specs: &[CategorySpec]) -> Vec<PossibleRow> {
    let categories = maps.category_shares.len() / maps.material.len().max(1);
    let shares =
        || pixels.iter().filter_map(|i| maps.category_shares.get(i * categories..(i + 1) * categories));
    let mean = |of: &dyn Fn(&[f32]) -> f64| shares().map(of).sum::<f64>() / shares().count().max(1) as f64;
    let is_possible = |place: usize| group.possible >> place & 1 == 1;
    let named =
        specs.iter().enumerate().filter(|(place, _)| is_possible(*place)).map(|(place, spec)| PossibleRow {
            category: spec.name.clone(),
            probability: mean(&|own| own.get(place).map_or(0.0, |share| f64::from(*share))),
        });
    let none = (group.possible & OTHER != 0).then(|| PossibleRow {
        category: "none".into(),
        probability: mean(&|own| (1.0 - own.iter().map(|share| f64::from(*share)).sum::<f64>()).max(0.0)),
    });
    named.chain(none).collect()
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
