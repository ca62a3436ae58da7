//! What is said of a decomposed cube: how many pixels are decided, what each material has, what was spared.

use super::DecomposeStudy;
use super::segmented::Segmented;
use super::vision::Vision;
pub use super::worth::TruthFound;
use crate::scenario::DecomposeScenario;
use crate::study::Warning;
use hadar::cube::{Found, Shape};
use hadar::decompose::{Maps, Method, Spatial, flag};
use hadar::demand::Work;
use serde::Serialize;

/// A cube decomposed.
#[derive(Debug, Clone, Serialize)]
pub struct Decomposed {
    /// The question.
    pub scenario: DecomposeScenario,
    /// By which method.
    pub method: Method,
    /// What the file of the cube was read as.
    pub read: Found,
    /// Rows, columns and bands.
    pub shape: Shape,
    /// Names of the materials, in the order of their indices.
    pub materials: Vec<String>,
    /// All pixels.
    pub pixels: usize,
    /// Pixels with one candidate.
    pub decided: usize,
    /// Pixels with several candidates, or of which nothing is known.
    pub undecided: usize,
    /// Pixels that were left out, a sample of which is missing.
    pub skipped: usize,
    /// Of each material that was found.
    pub found: Vec<MaterialRow>,
    /// Of each class of the library; empty without classes.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub classes: Vec<ClassRow>,
    /// How many pixels have each flag.
    pub flags: Vec<FlagCount>,
    /// What a prior over the image did, if there was one.
    pub spatial: Option<Spatial>,
    /// What is drawn of it.
    pub vision: Vision,
    /// What is there by categories; nothing without `[[category]]`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub segmentation: Option<Segmented>,
    /// How good the maps are, where that is known.
    pub truth: Option<TruthFound>,
    /// Time that it took, s.
    pub seconds: f64,
    /// What was done and what was spared.
    pub stats: Work,
    /// What the reader must know.
    pub warnings: Vec<Warning>,
    /// The maps.
    #[serde(skip)]
    pub maps: Maps,
}

/// What was found of one material.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MaterialRow {
    /// Its name.
    pub material: String,
    /// Pixels of which it is the most probable material.
    pub pixels: usize,
    /// Those of them that have no other candidate.
    pub decided: usize,
    /// Median of their temperatures, K.
    pub temperature_median_k: f64,
    /// Between a tenth and nine tenths of them, K.
    pub temperature_tenths_k: [f64; 2],
    /// Median of the deviations, K.
    pub temperature_sigma_median_k: f64,
}

/// What was found of a class.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct ClassRow {
    /// Its name.
    pub class: String,
    /// Spectra that it rests on.
    pub spectra: usize,
    /// Pixels of which one of its members is the most probable material.
    pub pixels: usize,
}

/// How many pixels have a flag.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct FlagCount {
    /// Its name.
    pub flag: &'static str,
    /// Its bit in `flags.npy`.
    pub bit: u8,
    /// Pixels.
    pub pixels: usize,
}

pub(super) fn summary(
    study: &DecomposeStudy,
    method: Method,
    maps: Maps,
    (truth, vision, segmentation): (Option<TruthFound>, Vision, Option<Segmented>),
    seconds: f64,
    mut warnings: Vec<Warning>,
) -> Decomposed {
    let pixels = maps.material.len();
    let has = |bit: u8| maps.flags.iter().filter(|flags| **flags & bit != 0).count();
    let skipped = has(flag::SKIPPED);
    let decided = (0..pixels).filter(|i| maps.is_decided(*i)).count();
    let mut rows = Vec::new();
    for (place, material) in study.names.iter().enumerate() {
        let own: Vec<usize> = (0..pixels).filter(|i| usize::from(maps.material[*i]) == place).collect();
        let sorted = |of: &[f32]| {
            let mut values: Vec<f64> =
                own.iter().map(|i| f64::from(of[*i])).filter(|value| value.is_finite()).collect();
            values.sort_by(f64::total_cmp);
            values
        };
        let at = |values: &[f64], share: f64| {
            let place = (share * values.len() as f64) as usize;
            values.get(place.min(values.len().saturating_sub(1))).copied().unwrap_or(f64::NAN)
        };
        if own.is_empty() {
            continue;
        }
        let temperatures = sorted(&maps.temperature_k);
        rows.push(MaterialRow {
            material: material.clone(),
            pixels: own.len(),
            decided: own.iter().filter(|i| maps.is_decided(**i)).count(),
            temperature_median_k: at(&temperatures, 0.5),
            temperature_tenths_k: [at(&temperatures, 0.1), at(&temperatures, 0.9)],
            temperature_sigma_median_k: at(&sorted(&maps.temperature_sigma_k), 0.5),
        });
    }
    rows.sort_by(|a, b| b.pixels.cmp(&a.pixels).then_with(|| a.material.cmp(&b.material)));
    let classes = study.classes.iter().map(|(class, members)| ClassRow {
        class: class.clone(),
        spectra: members.len(),
        pixels: (0..pixels).filter(|i| members.contains(&usize::from(maps.material[*i]))).count(),
    });
    let classes = classes.collect();
    let flags = flags(&maps, &mut warnings);
    if let Some(found) = &segmentation {
        let guessed = found.objects.iter().filter(|object| 2 * object.decided < object.pixels).count();
        if guessed > 0 {
            warnings.push(Warning::ObjectsUndecided { objects: guessed, of: found.objects.len() });
        }
    }
    Decomposed {
        scenario: study.scenario.clone(),
        method,
        read: study.read.clone(),
        shape: study.cube.shape(),
        materials: study.names.clone(),
        pixels,
        decided,
        undecided: pixels - decided - skipped,
        skipped,
        found: rows,
        classes,
        flags,
        spatial: maps.spatial,
        vision,
        segmentation,
        truth,
        seconds,
        stats: maps.spared.work(),
        warnings,
        maps,
    }
}

/// How many pixels have each flag, and what the reader must know of them.
pub(in crate::study) fn flags(maps: &Maps, warnings: &mut Vec<Warning>) -> Vec<FlagCount> {
    let pixels = maps.material.len();
    let has = |bit: u8| maps.flags.iter().filter(|flags| **flags & bit != 0).count();
    let skipped = has(flag::SKIPPED);
    let flags: Vec<FlagCount> = flag::NAMES
        .iter()
        .map(|(bit, flag)| FlagCount { flag, bit: *bit, pixels: has(*bit) })
        .filter(|count| count.pixels > 0)
        .collect();
    if maps.spared.unfinished > 0 {
        warnings.push(Warning::UnconvergedFits { fits: maps.spared.unfinished as usize });
    }
    if skipped > 0 {
        warnings.push(Warning::PixelsSkipped { pixels: skipped, of: pixels });
    }
    if let Some(Spatial { changed, settled, .. }) = maps.spatial {
        warnings.push(Warning::SpatialPrior { changed, pixels, settled });
    }
    let unfit = has(flag::NO_FIT);
    if unfit as f64 > 0.01 * (pixels - skipped) as f64 {
        warnings.push(Warning::LibraryDoesNotFit { pixels: unfit, of: pixels - skipped });
    }
    flags
}
