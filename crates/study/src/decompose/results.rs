//! What is said of a decomposed cube: how many pixels are decided, what each material has, what was spared.

use super::DecomposeStudy;
use super::estimated::SharedFound;
use super::kept::Kept;
use super::ranks::ranked;
use super::segmented::Segmented;
use super::vision::{DRAWN, Vision, apart};
pub use super::worth::TruthFound;
use crate::Warning;
use crate::cube_bad::BadFound;
use crate::light_found::LightFound;
use crate::model_judged::{ModelJudged, ModelVerdict, p_values};
use hadar::cube::Shape;
use hadar::demand::Work;
use hadar::error::Result;
use hadar_estimate::decompose::{Maps, Method, NO_FIT, NO_MATERIAL, Spared, Spatial, flag};
use hadar_formats::cube::Found;
use hadar_scenario::DecomposeScenario;
use serde::Serialize;
use std::collections::BTreeMap;

/// A cube decomposed.
#[derive(Debug, Clone, Serialize)]
pub struct Decomposed {
    /// The question as it was asked, defaults filled in.
    pub scenario: DecomposeScenario,
    /// Name of the method by which it was decomposed.
    pub method: Method,
    /// What the file of the cube was read as.
    pub read: Found,
    /// Numbers of rows, columns and bands of the cube.
    pub shape: Shape,
    /// Names of the materials, in the order of their indices.
    pub materials: Vec<String>,
    /// Number of all pixels of the cube.
    pub pixels: usize,
    /// Pixels with one candidate; none while the cube does not follow its model.
    pub decided: usize,
    /// Pixels that are decided if the model holds.
    pub decided_if_model_holds: usize,
    /// Materials of the library that are entered as one number: what is decided for or against them rests on it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub constants: Vec<String>,
    /// Pixels with several candidates, or of which nothing is known.
    pub undecided: usize,
    /// Whether the cube follows its model, and what may be otherwise than told.
    pub model: ModelJudged,
    /// What was estimated for the whole cube; nothing where nothing is shared.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shared: Option<SharedFound>,
    /// Surroundings that were found in the cube, with their errors; empty where all are told.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub surroundings_found: Vec<LightFound>,
    /// Surfaces that are none of the library; nothing where that is not asked.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub none_of_these: Option<Besides>,
    /// Pixels of two surfaces; nothing where that is not asked.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mixed: Option<MixedFound>,
    /// Pixels that were left out: a sample of them is missing, or they were named or found to be bad.
    pub skipped: usize,
    /// What was named or found to be bad.
    pub bad: BadFound,
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
    /// What was done and what was spared.
    pub stats: Work,
    /// What the reader must know.
    pub warnings: Vec<Warning>,
    /// The maps.
    #[serde(skip)]
    pub kept: Kept,
}

/// Pixels that may be something else than one surface of the library.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Besides {
    /// Prior probability that a pixel is no single surface of the library.
    pub prior: f64,
    /// Pixels of which it is more probable than every material.
    pub likeliest: usize,
    /// Those of them that have no other candidate.
    pub alone: usize,
    /// Pixels of which its posterior probability is above 1 %.
    pub above_one_percent: usize,
}

/// Pixels that may hold two surfaces.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MixedFound {
    /// How many.
    #[serde(flatten)]
    pub besides: Besides,
    /// Pixels of which two surfaces are likeliest and do not fit either.
    pub unfitting: usize,
    /// The pairs of pixels of which two surfaces are likeliest, that of the most pixels first.
    pub pairs: Vec<PairRow>,
}

/// Pixels of the same two materials.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PairRow {
    /// Their names, that of the larger share in each pixel first.
    pub materials: [String; 2],
    /// Pixels of which they are the likeliest pair.
    pub pixels: usize,
    /// Mean share of the first.
    pub share_mean: f64,
}

/// What was found of one material.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MaterialRow {
    /// Name of the material in the library.
    pub material: String,
    /// Pixels of which it is the most probable material.
    pub pixels: usize,
    /// Those of them that have no other candidate; none while the cube does not follow its model.
    pub decided: usize,
    /// Those of them that are decided if the model holds.
    pub decided_if_model_holds: usize,
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
    /// Name of the class of materials.
    pub class: String,
    /// Spectra that it rests on.
    pub spectra: usize,
    /// Pixels of which one of its members is the most probable material.
    pub pixels: usize,
}

/// How many pixels have a flag.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct FlagCount {
    /// Name of the flag of a pixel.
    pub flag: &'static str,
    /// Number of its bit in `flags.npy`, counted from 0.
    pub bit: u8,
    /// Number of pixels that have the flag.
    pub pixels: usize,
}

/// What is counted of the maps, row after row.
#[derive(Debug, Default)]
pub(super) struct Counted {
    pixels: usize,
    decided: usize,
    /// Pixels of each bit of the flags.
    flags: [usize; 8],
    /// Pixels of each material that was found, and those of them that are decided.
    materials: BTreeMap<u16, [usize; 2]>,
    /// Pixels with a p-value that some material fits, the sum of these, and pixels that none fits.
    p_values: (usize, f64, usize),
    /// Pixels of which none of the library is likeliest, those without another candidate, and those that it has more than 1 % of.
    none_of_these: [usize; 3],
    /// The same of two surfaces, and of each pair its pixels and the sum of the larger shares.
    mixed: [usize; 3],
    unfitting: usize,
    pairs: BTreeMap<[u16; 2], (usize, f64)>,
    spared: Spared,
    spatial: Option<Spatial>,
}

impl Counted {
    pub(super) fn take(&mut self, maps: &Maps) {
        for (i, (material, flags)) in maps.material.iter().zip(&maps.flags).enumerate() {
            let is_decided = maps.is_decided(i);
            self.decided += usize::from(is_decided);
            for (bit, count) in self.flags.iter_mut().enumerate() {
                *count += usize::from(flags >> bit & 1);
            }
            let [pixels, decided] = self.materials.entry(*material).or_default();
            *pixels += 1;
            *decided += usize::from(is_decided);
        }
        let (fitting, sum, unfit) = p_values(maps);
        let so_far = self.p_values;
        self.p_values = (so_far.0 + fitting, so_far.1 + sum, so_far.2 + unfit);
        let is_likeliest = |i: usize, probability: f32| {
            maps.material[i] == NO_MATERIAL
                && maps.flags[i] & flag::NO_FIT != 0
                && maps.posterior[i] == probability
        };
        for (sums, all) in [(&mut self.none_of_these, &maps.other), (&mut self.mixed, &maps.mixed)] {
            for (i, probability) in all.iter().enumerate() {
                let is_likeliest = is_likeliest(i, *probability);
                let counts = [is_likeliest, is_likeliest && maps.candidates[i] == 1, *probability > 0.01];
                sums.iter_mut().zip(counts).for_each(|(sum, one)| *sum += usize::from(one));
            }
        }
        let pairs = maps.mixed_material.as_chunks::<2>().0.iter().zip(maps.mixed_share.chunks_exact(2));
        for (i, (materials, share)) in pairs.enumerate() {
            if is_likeliest(i, maps.mixed[i]) {
                let (pixels, sum) = self.pairs.entry(*materials).or_default();
                *pixels += 1;
                *sum += f64::from(share[0]);
                self.unfitting += usize::from(f64::from(maps.p_value[i]) < NO_FIT);
            }
        }
        self.pixels += maps.material.len();
        self.spared = self.spared + maps.spared;
        self.spatial = maps.spatial;
    }

    /// Pixels that some material fits, the sum of their p-values, and pixels that none fits.
    pub(super) fn p_values(&self) -> (usize, f64, usize) {
        self.p_values
    }

    fn has(&self, flag: u8) -> usize {
        self.flags.get(flag.trailing_zeros() as usize).copied().unwrap_or(0)
    }

    fn of(&self, material: usize) -> [usize; 2] {
        let found = u16::try_from(material).ok().and_then(|material| self.materials.get(&material));
        found.copied().unwrap_or_default()
    }

    /// How many pixels have each flag, and what the reader must know of them.
    fn flags(&self, warnings: &mut Vec<Warning>, bad: &BadFound) -> Vec<FlagCount> {
        let (pixels, skipped) = (self.pixels, self.has(flag::SKIPPED));
        let flags: Vec<FlagCount> = flag::NAMES
            .iter()
            .map(|(bit, flag)| FlagCount { flag, bit: *bit, pixels: self.has(*bit) })
            .filter(|count| count.pixels > 0)
            .collect();
        // Those that were found to be bad are told with their reason.
        let told: usize = bad.pixels.iter().filter(|bad| bad.why != "missing").map(|bad| bad.pixels).sum();
        if skipped > told {
            warnings.push(Warning::PixelsSkipped { pixels: skipped - told, of: pixels });
        }
        if let Some(Spatial { changed, settled, .. }) = self.spatial {
            warnings.push(Warning::SpatialPrior { changed, pixels, settled });
        }
        // Two surfaces that fit explain a pixel.
        let unfit = self.has(flag::NO_FIT) + self.unfitting - self.mixed[0];
        if unfit as f64 > 0.01 * (pixels - skipped) as f64 {
            warnings.push(Warning::LibraryDoesNotFit { pixels: unfit, of: pixels - skipped });
        }
        flags
    }
}

/// How many pixels of maps have each flag, and what the reader must know of them.
pub(crate) fn flags(maps: &Maps, bad: &BadFound, warnings: &mut Vec<Warning>) -> Vec<FlagCount> {
    let mut counted = Counted::default();
    counted.take(maps);
    counted.flags(warnings, bad)
}

/// Shares of the temperatures of a material, and of their deviations, that are said.
const TEMPERATURES: &[f64] = &[0.5, 0.1, 0.9];
const DEVIATIONS: &[f64] = &[0.5];

/// The temperatures of every material with pixels, and those between which a picture is drawn.
pub(super) fn rows(
    study: &DecomposeStudy,
    counted: &Counted,
    kept: &Kept,
) -> Result<(Vec<MaterialRow>, [f64; 2])> {
    let names = study.names.len();
    let mut shares: Vec<&[f64]> = vec![TEMPERATURES; names];
    shares.extend(vec![DEVIATIONS; names]);
    shares.push(&DRAWN);
    let rank = |share: f64, count: u64| (share * count as f64) as u64;
    let found = ranked(&shares, rank, &mut |count| {
        kept.each(&mut |block| {
            let maps = &block.maps;
            let each = maps.material.iter().zip(maps.temperature_k.iter().zip(&maps.temperature_sigma_k));
            for (i, (material, (temperature_k, sigma_k))) in each.enumerate() {
                let material = usize::from(*material);
                if material < names && temperature_k.is_finite() {
                    count(material, *temperature_k);
                }
                if material < names && sigma_k.is_finite() {
                    count(names + material, *sigma_k);
                }
                if temperature_k.is_finite() && maps.is_decided(i) {
                    count(2 * names, *temperature_k);
                }
            }
            Ok(())
        })
    })?;
    let at = |group: usize, i: usize| {
        found.get(group).and_then(|own| own.get(i).copied().flatten()).map(f64::from)
    };
    let kelvin = |group: usize, i: usize| at(group, i).unwrap_or(f64::NAN);
    let mut rows = Vec::new();
    for (place, material) in study.names.iter().enumerate() {
        let [pixels, decided] = counted.of(place);
        if pixels > 0 {
            rows.push(MaterialRow {
                material: material.clone(),
                pixels,
                decided,
                decided_if_model_holds: decided,
                temperature_median_k: kelvin(place, 0),
                temperature_tenths_k: [kelvin(place, 1), kelvin(place, 2)],
                temperature_sigma_median_k: kelvin(names + place, 0),
            });
        }
    }
    rows.sort_by(|a, b| b.pixels.cmp(&a.pixels).then_with(|| a.material.cmp(&b.material)));
    Ok((rows, apart([0, 1].map(|i| at(2 * names, i).unwrap_or(293.15)))))
}

/// What was found, put together.
pub(super) fn summary(
    study: &DecomposeStudy,
    method: Method,
    (counted, mut found, model, shared): (&Counted, Vec<MaterialRow>, ModelJudged, Option<SharedFound>),
    (truth, vision, mut segmentation): (Option<TruthFound>, Vision, Option<Segmented>),
    mut warnings: Vec<Warning>,
    kept: Kept,
) -> Decomposed {
    let (pixels, skipped) = (counted.pixels, counted.has(flag::SKIPPED));
    let mut decided = counted.decided;
    if model.verdict.takes_back() {
        decided = 0;
        found.iter_mut().for_each(|row| row.decided = 0);
        segmentation.iter_mut().for_each(Segmented::take_back);
    }
    if model.verdict == ModelVerdict::Rejected {
        warnings.push(Warning::ModelRejected {
            if_it_holds: counted.decided,
            causes: model.causes.iter().filter(|row| row.may_be).cloned().collect(),
        });
    }
    let classes = study.classes.iter().map(|(class, members)| ClassRow {
        class: class.clone(),
        spectra: members.len(),
        pixels: members.iter().map(|member| counted.of(*member)[0]).sum(),
    });
    let besides = |prior: f64, [likeliest, alone, above_one_percent]: [usize; 3]| Besides {
        prior,
        likeliest,
        alone,
        above_one_percent,
    };
    let library = &study.scenario.library;
    let none_of_these = library.none_of_these.map(|prior| besides(prior, counted.none_of_these));
    let mixed = library.mixed.map(|prior| MixedFound {
        besides: besides(prior, counted.mixed),
        unfitting: counted.unfitting,
        pairs: pair_rows(&counted.pairs, &study.names),
    });
    let flags = counted.flags(&mut warnings, &study.bad);
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
        decided_if_model_holds: counted.decided,
        model,
        shared,
        surroundings_found: study.found.clone(),
        none_of_these,
        mixed,
        constants: study.constants().map(|m| study.names[m].clone()).collect(),
        undecided: pixels - decided - skipped,
        skipped,
        bad: study.bad.clone(),
        found,
        classes: classes.collect(),
        flags,
        spatial: counted.spatial,
        vision,
        segmentation,
        truth,
        stats: counted.spared.work(),
        warnings,
        kept,
    }
}

fn pair_rows(pairs: &BTreeMap<[u16; 2], (usize, f64)>, names: &[String]) -> Vec<PairRow> {
    let name = |m: u16| names.get(usize::from(m)).cloned().unwrap_or_default();
    let row = |(materials, (pixels, sum)): (&[u16; 2], &(usize, f64))| PairRow {
        materials: materials.map(name),
        pixels: *pixels,
        share_mean: sum / *pixels as f64,
    };
    let mut rows: Vec<PairRow> = pairs.iter().map(row).collect();
    rows.sort_by_key(|row| std::cmp::Reverse(row.pixels));
    rows
}
