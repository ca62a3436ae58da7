//! A heat cube decomposed: names and files looked up, the maps, and what they are worth where the truth is known.

mod categories;
mod looked_up;
mod results;
mod segmented;
mod truth;
mod vision;
mod worth;

pub use looked_up::DecomposeStudy;
pub(super) use results::flags;
pub use results::{ClassRow, Decomposed, FlagCount, MaterialRow, TruthFound};
pub use segmented::{CategoryRow, ObjectRow, Segmented};
pub(super) use truth::Truth;
pub use vision::{DistilledTexture, Vision, hues_deg};

use self::results::summary;
use super::{Warning, memory};
use hadar::decompose::{LibraryError, Method, Options, Setting, decompose_by, widen};
use hadar::demand::Skipping;
use hadar::error::{Error, Result};

/// Length over which errors of emissivities are correlated where nothing is said, cm⁻¹.
pub const CORRELATION_CM1: f64 = 50.0;

/// Bytes of a pixel that are kept, and for each of the surroundings, measured with a report (200 with four; without one, half as
/// many); with a prior over the image, at least.
const KEPT: u64 = 150;
const KEPT_LIGHT: u64 = 14;
const KEPT_BESIDE_OTHERS: u64 = 400;

impl DecomposeStudy {
    /// Decomposes the cube by a method; `done` is told how many rows are finished, of how many.
    ///
    /// # Errors
    /// Counts that are negative, a cube that cannot be read, an unknown gain with a method that takes none.
    pub fn decompose(
        &self,
        method: Method,
        skipping: Skipping,
        done: &(dyn Fn(usize, usize) + Sync),
    ) -> Result<Decomposed> {
        if !method.has_likelihood() && self.scenario.unknown.gain {
            let found = format!("the method {} does not know an unknown gain", method.name());
            let error = Error::malformed(found, "write gain = false, or take --method ml or te");
            return Err(error.at(self.scenario.place("unknown.gain")));
        }
        if !method.names_materials() && !self.scenario.categories.is_empty() {
            let found = format!("the method {} names no materials", method.name());
            let error = Error::malformed(found, "leave [[category]] out, or take --method ml");
            return Err(error.at(self.scenario.place("category")));
        }
        if !method.has_likelihood() && self.scenario.spatial.is_some() {
            let found = format!("the method {} knows no prior over the image", method.name());
            let error = Error::malformed(found, "leave [spatial] out, or take --method ml or te");
            return Err(error.at(self.scenario.place("spatial")));
        }
        if !method.has_likelihood() && self.scenario.vision.sky.is_some() {
            let found = format!("the method {} has no residue to distil a texture of", method.name());
            let error = Error::malformed(found, "leave vision.sky out, or take --method ml");
            return Err(error.at(self.scenario.place("vision.sky")));
        }
        let shape = self.cube.shape();
        let per_pixel = match &self.scenario.spatial {
            None => KEPT + KEPT_LIGHT * self.lights.len() as u64,
            Some(_) => KEPT_BESIDE_OTHERS,
        };
        let bytes = per_pixel * (shape.rows() * shape.columns()) as u64;
        let _memory =
            memory::promise(bytes, "the maps of all pixels", "cut the cube into parts of fewer rows")
                .map_err(|error| error.at(self.scenario.place("cube.data")))?;
        let start = std::time::Instant::now();
        let unknown = self.scenario.unknown;
        let setting = Setting {
            bands: &self.bands,
            library: &self.library,
            surroundings: &self.lights,
            counts_per_radiance: &self.counts_per_radiance,
            var_added: &self.var_added,
            units_per_count: self.units_per_count,
            temperature_k: unknown.temperature_k,
            lighting_total: unknown.lighting_total,
            gain: unknown.gain,
            bad_bands: &self.bad_bands,
        };
        let spec = &self.scenario.library;
        let library_error = spec.emissivity_error.filter(|error| *error > 0.0).map(|relative| LibraryError {
            relative,
            correlation_cm1: spec.emissivity_correlation_cm1.unwrap_or(CORRELATION_CM1),
        });
        let options =
            Options { prior: self.prior.clone(), library_error, skipping, spatial: self.scenario.spatial };
        let rows = self.cube.shape().rows();
        let finished = std::sync::atomic::AtomicUsize::new(0);
        let progress = |more: usize| {
            let so_far = finished.fetch_add(more, std::sync::atomic::Ordering::Relaxed) + more;
            done(so_far, rows);
        };
        let mut maps = decompose_by(method, &setting, &options, &self.cube, &progress)
            .map_err(|error| self.at_cube(error))?;
        if let Some(together) = self.together.as_ref().filter(|_| method.has_likelihood()) {
            widen(&setting, &mut maps, together)
                .map_err(|error| error.at(self.scenario.place("cube.noise")))?;
        }
        let seconds = start.elapsed().as_secs_f64();
        let mut warnings = self.warnings.clone();
        if library_error.is_none() && method.names_materials() {
            warnings.push(Warning::LibraryTakenAsExact);
        }
        let truth = self.truth.as_ref().map(|truth| truth.found(self, method, &maps)).transpose()?;
        let vision = Vision::of(self, &setting, &maps).map_err(|error| self.at_cube(error))?;
        let segmented = Segmented::of(self, &maps, &vision)?;
        Ok(summary(self, method, maps, (truth, vision, segmented), seconds, warnings))
    }
}
