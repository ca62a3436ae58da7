//! A heat cube decomposed: names and files looked up, the maps, and what they are worth where the truth is known.

mod categories;
mod estimated;
mod judged;
mod kept;
mod looked_up;
mod ranks;
mod results;
mod safety;
mod segmented;
mod truth;
mod vision;
mod worth;

pub use crate::light_found::LightFound;
pub use crate::model_judged::{BandResidual, CauseRow, ModelJudged, ModelVerdict};
pub use estimated::{SharedFound, SharedRow};
pub use kept::{Block, Keep, Kept, MIXED, MIXED_MATERIALS, MapFiles, mixed_layers};
pub use looked_up::{CANDIDATES, DecomposeStudy};
pub use ranks::{Count, ranked};
pub(super) use results::flags;
pub use results::{Besides, ClassRow, Decomposed, FlagCount, MaterialRow, MixedFound, PairRow, TruthFound};
pub use safety::{NotExcluded, SafetyRow};
pub use segmented::{CategoryRow, ObjectRow, PossibleRow, Segmented};
pub(super) use truth::{There, Truth};
pub use vision::{DistilledTexture, Vision, hues_deg};

use self::estimated::Estimated;
use self::judged::{Asked, Wider};
use self::results::{Counted, rows, summary};
use self::worth::Held;
use super::{Warning, memory};
use hadar::cube::Shape;
use hadar::demand::Skipping;
use hadar::error::{Error, Result};
use hadar_estimate::decompose::{LibraryError, MOST_RANKED, Maps, Method, Options, decompose_by_rows, widen};
use std::sync::Arc;

/// Length over which errors of emissivities are correlated where nothing is said, cm⁻¹.
pub const CORRELATION_CM1: f64 = 50.0;

/// Pixels of a cube whose maps are kept in memory where they need not be.
const KEPT_PIXELS: usize = 1 << 20;

/// Bytes of a pixel that are kept in memory, and for each of the surroundings, measured with a report (200 with four; without one, half
/// as many); with a prior over the image, at least.
const KEPT: u64 = 160;
const KEPT_LIGHT: u64 = 18;
/// The same for each of the most probable materials that are kept.
const KEPT_CANDIDATE: u64 = 6;
const KEPT_BESIDE_OTHERS: u64 = 400;
/// The same for sets of categories, and for each category.
const KEPT_SETS: u64 = 100;
const KEPT_CATEGORY: u64 = 4;
/// The same for what a pixel is as two surfaces.
const KEPT_MIXED: u64 = 32;

/// Error of the emissivities over what the material reflects from which on deviations to first order hold too few temperatures (a twentieth
/// too few at 5 %, by draws).
const FIRST_ORDER: f64 = 0.03;

/// The error of an emissivity that errs by this share of itself, as a share of what it reflects; in the middle of the bands.
fn of_reflected(emissivity: &[f64], relative: f64) -> f64 {
    let count = emissivity.len().max(1) as f64;
    let mean = emissivity.iter().sum::<f64>() / count;
    relative * mean / (1.0 - mean).max(f64::MIN_POSITIVE)
}

impl DecomposeStudy {
    /// The same with the posteriors of so many of the most probable materials of each pixel, from 1 to [`MOST_RANKED`].
    #[must_use]
    pub fn with_candidates(self, candidates: usize) -> Self {
        Self { candidates: candidates.clamp(1, MOST_RANKED), ..self }
    }

    /// Whether the maps are better kept in files: they are many, and nothing needs all pixels together.
    #[must_use]
    pub fn wants_files(&self) -> bool {
        let shape = self.cube.shape();
        !self.needs_all() && shape.rows() * shape.columns() > KEPT_PIXELS
    }

    fn needs_all(&self) -> bool {
        let scenario = &self.scenario;
        scenario.spatial.is_some() || scenario.vision.sky.is_some() || !scenario.categories.is_empty()
    }

    /// Rows, columns and bands of the cube.
    #[must_use]
    pub fn shape(&self) -> Shape {
        self.cube.shape()
    }

    /// Decomposes the cube by a method; `done` is told how many rows are finished, of how many. The answer is the same wherever the
    /// maps are kept.
    ///
    /// # Errors
    /// Counts that are negative, a cube that cannot be read, an unknown gain with a method that takes none, no room for the maps.
    pub fn decompose(
        &self,
        method: Method,
        skipping: Skipping,
        keep: Keep<'_>,
        done: &(dyn Fn(usize, usize) + Sync),
    ) -> Result<Decomposed> {
        self.check(method)?;
        let shape = self.cube.shape();
        let lights = self.told.surroundings.len();
        let (files, height) = match keep {
            Keep::InFiles { folder, rows } if !self.needs_all() => {
                let library = &self.scenario.library;
                let besides = [library.none_of_these.is_some(), library.mixed.is_some()];
                let layers = (lights, self.candidates, besides);
                (Some(MapFiles::create(folder, rows, shape, layers)?), rows)
            }
            _ => (None, shape.rows()),
        };
        let _memory = match &files {
            Some(_) => None,
            None => Some(self.memory()?),
        };
        let options = self.options(skipping);
        let estimated = Estimated::of(self, method, &options)?;
        let told = estimated.as_ref().map_or(&self.told, |estimated| &estimated.told);
        let setting = told.setting();
        if setting.path.is_some() && method != Method::Ml {
            let found = format!("air before the camera and the method {}", method.name());
            let error = Error::malformed(found, "leave [atmosphere] out, or take --method ml");
            return Err(error.at(self.scenario.place("atmosphere")));
        }
        let finished = std::sync::atomic::AtomicUsize::new(0);
        let progress = |more: usize| {
            let so_far = finished.fetch_add(more, std::sync::atomic::Ordering::Relaxed) + more;
            done(so_far, shape.rows());
        };
        let (mut counted, mut whole) = (Counted::default(), Block::default());
        let mut held = self.truth.as_ref().map(|truth| (truth, Held::new(self, method)));
        let mut asked: Option<Asked> = None;
        let mut take = |first: usize, mut maps: Maps| {
            // The model is judged with the materials that are told.
            let is_plain = options.other.is_none() && options.mixed.is_none();
            let all = (height >= shape.rows() && is_plain).then_some(&maps);
            let asked = match &mut asked {
                Some(asked) => &*asked,
                none => none.insert(Asked::of(self, method, &setting, &options, (all, estimated.as_ref()))?),
            };
            let (together, to_hold) = (self.together.as_deref().unwrap_or_default(), asked.to_hold());
            if let Some(Wider { noise, .. }) = &to_hold {
                let of_shares = maps.mixed_share.iter_mut().skip(1).step_by(2);
                let all = [
                    &mut maps.temperature_sigma_k,
                    &mut maps.lighting_sigma,
                    &mut maps.texture_sigma,
                    &mut maps.mixed_temperature_sigma_k,
                ];
                all.into_iter().flatten().chain(of_shares).for_each(|sigma| *sigma *= *noise as f32);
            }
            let causes = to_hold.map_or_else(Vec::new, |to_hold| to_hold.causes);
            if method.has_likelihood() && !(together.is_empty() && causes.is_empty() && estimated.is_none()) {
                widen(&setting, &mut maps, together, &causes, estimated.as_ref().map(|one| &one.shared))
                    .map_err(|error| error.at(self.scenario.place("cube.noise")))?;
            }
            maps.leave_out_unknown_lighting(setting.lighting_total);
            counted.take(&maps);
            let block = Block::of(self, told, first, maps)?;
            if let Some((truth, held)) = &mut held {
                let rows = first..first + block.maps.material.len() / shape.columns();
                held.take(self, method, &block.maps, &truth.rows(rows)?);
            }
            match &files {
                Some(files) => files.put(&block)?,
                None => whole = block,
            }
            Ok(())
        };
        decompose_by_rows(method, &setting, &options, &self.cube, (height, &mut take), &progress)
            .map_err(|error| self.at_cube(error))?;
        let mut warnings = self.warnings.clone();
        if options.library_error.is_none() && method.names_materials() {
            warnings.push(Warning::LibraryTakenAsExact);
        }
        if let Some(error) = &options.library_error {
            let lights = !setting.surroundings.is_empty();
            let share = setting.library.iter().map(|e| of_reflected(e, error.relative)).fold(0.0, f64::max);
            if lights && share > FIRST_ORDER {
                warnings.push(Warning::LibraryErrorNotSmall { share });
            }
        }
        let truth = held.map(|(_, held)| held.found(self)).transpose()?;
        let kept = match files {
            Some(files) => Kept::InFiles(Arc::new(files)),
            None => Kept::InMemory(Box::new(whole)),
        };
        let (found, drawn_k) = rows(self, &counted, &kept)?;
        let all = match &kept {
            Kept::InMemory(block) => Some(&**block),
            Kept::InFiles(_) => None,
        };
        let vision = Vision::of(self, &setting, drawn_k, all.map(|block| &block.maps))
            .map_err(|error| self.at_cube(error))?;
        let segmented = all.map(|block| Segmented::of(self, block)).transpose()?.flatten();
        let answer = (truth, vision, segmented);
        let model = asked.unwrap_or_default().found(self, method, counted.p_values());
        let shared = estimated.as_ref().map(Estimated::found);
        Ok(summary(self, method, (&counted, found, model, shared), answer, warnings, kept))
    }

    /// Refuses what the scenario asks for and the method has not.
    fn check(&self, method: Method) -> Result<()> {
        let (scenario, likely) = (&self.scenario, method.has_likelihood());
        let refused = |key: &str, lack: &str, instead: &str| {
            let found = format!("the method {} {lack}", method.name());
            Err(Error::malformed(found, instead).at(scenario.place(key)))
        };
        if !likely && scenario.unknown.gain {
            let instead = "write gain = false, or take --method ml or te";
            return refused("unknown.gain", "does not know an unknown gain", instead);
        }
        if !method.names_materials() && !scenario.categories.is_empty() {
            return refused("category", "names no materials", "leave [[category]] out, or take --method ml");
        }
        if !likely && scenario.spatial.is_some() {
            let instead = "leave [spatial] out, or take --method ml or te";
            return refused("spatial", "knows no prior over the image", instead);
        }
        if !likely && scenario.library.none_of_these.is_some() {
            let instead = "leave library.none_of_these out, or take --method ml or te";
            return refused("library.none_of_these", "has no likelihood to compare that with", instead);
        }
        if !likely && scenario.library.mixed.is_some() {
            let instead = "leave library.mixed out, or take --method ml or te";
            return refused("library.mixed", "has no likelihood to compare that with", instead);
        }
        if !likely && scenario.vision.sky.is_some() {
            let instead = "leave vision.sky out, or take --method ml";
            return refused("vision.sky", "has no residue to distil a texture of", instead);
        }
        Ok(())
    }

    /// Room for the maps of all pixels.
    fn memory(&self) -> Result<memory::Promised<'static>> {
        let shape = self.cube.shape();
        let per_pixel = match &self.scenario.spatial {
            None => {
                KEPT + KEPT_LIGHT * self.told.surroundings.len() as u64
                    + KEPT_CANDIDATE * self.candidates as u64
            }
            Some(_) => KEPT_BESIDE_OTHERS,
        };
        let per_pixel = per_pixel
            + match self.categories.len() as u64 {
                0 => 0,
                count => KEPT_SETS + KEPT_CATEGORY * count,
            }
            + self.scenario.library.mixed.map_or(0, |_| KEPT_MIXED);
        let bytes = per_pixel * (shape.rows() * shape.columns()) as u64;
        let instead = "cut the cube into parts of fewer rows";
        memory::promise(bytes, "the maps of all pixels", instead)
            .map_err(|error| error.at(self.scenario.place("cube.data")))
    }

    fn options(&self, skipping: Skipping) -> Options {
        let (spec, spatial) = (&self.scenario.library, self.scenario.spatial);
        let library_error = spec.emissivity_error.filter(|error| *error > 0.0).map(|relative| LibraryError {
            relative,
            correlation_cm1: spec.emissivity_correlation_cm1.unwrap_or(CORRELATION_CM1),
        });
        let categories = if self.categories.is_empty() { Vec::new() } else { self.categories.sets() };
        let ranked = self.candidates;
        let (prior, alike) = (self.prior.clone(), self.alike.clone());
        let (other, mixed) = (spec.none_of_these, spec.mixed);
        Options { prior, library_error, other, mixed, alike, skipping, spatial, categories, ranked }
    }
}
