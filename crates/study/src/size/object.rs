//! What the readings of an object say together, and where that ends.
//!
//! n = pixels × frames readings; n_eff = (d/d₁)², d₁ of one pixel in one frame, is how many independent ones they are worth. The
//! ceiling is d with frames without end: what patterns of the array, flicker and shared errors of the emissivities leave
//! ([`crate::shared_errors`]). What it is made of is each line's share of the variance that is left there, mean over the bands.
//!
//! Frames are worth having until [`WORTH`] of the ceiling is reached.

use super::Study;
use crate::Surface;
use crate::size::Reach;
use hadar::error::Result;
use hadar::identifiability::shared::EMISSIVITY_ERRORS;
use hadar::policy::{Quantity, Trial};
use hadar_scenario::{Scope, SensitivitySpec};

/// Share of the ceiling beyond which more frames are not worth their time.
const WORTH: f64 = 0.9;
/// A line that is less than this share of what is left is not named.
const NAMED: f64 = 1e-3;
/// Distances beyond this factor of that reached are no ceiling that anybody meets.
const NO_CEILING: f64 = 1e3;

/// The most frames of a curve, and its points.
const MOST_FRAMES: f64 = 1e6;
const POINTS: usize = 19;
/// The same where each takes a proof.
const POINTS_WITH_ERRORS: usize = 7;

/// Statistical distance over readings, frames varied.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ObjectCurve {
    /// Frames.
    pub frames: Vec<f64>,
    /// Readings: pixels × frames.
    pub readings: Vec<f64>,
    /// Of all pixels of the object.
    pub of_object: Vec<f64>,
    /// Of one pixel, without errors of the emissivities.
    pub of_pixel: Vec<f64>,
    /// Of as many readings of which none has anything in common with another.
    pub independent: Vec<f64>,
}

/// What all pixels of an object say together, against the limiting alternative.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct ObjectAnswer {
    /// Rows of pixels that the target fills.
    pub rows: f64,
    /// Number of columns of pixels that the object fills.
    pub columns: f64,
    /// Number of pixels that the object fills.
    pub pixels: f64,
    /// Number of frames that are averaged.
    pub frames: u32,
    /// Statistical distance of one pixel in one frame, as proved and as found.
    pub distance_of_one_bounds: [f64; 2],
    /// Statistical distance of all, as proved and as found.
    pub distance_bounds: [f64; 2],
    /// How many independent readings all are worth, (d/d₁)² of the distances that were found.
    pub effective_readings: f64,
    /// Statistical distance with frames without end, as proved and as found; `None` where it grows without end.
    pub ceiling_bounds: Option<[f64; 2]>,
    /// What the ceiling is made of.
    pub ceiling_made_of: Vec<CeilingShare>,
    /// Frames that reach most of the ceiling; `None` without a ceiling.
    pub frames_worth: Option<f64>,
    /// Root mean square error of the emissivities that is in all of this; `None` where they are taken as entered.
    pub emissivity_error: Option<f64>,
}

/// A line of what is left after frames without end.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct CeilingShare {
    /// Name of the noise that remains after any number of frames.
    pub label: &'static str,
    /// Its share of the variance.
    pub share: f64,
    /// The key that states it.
    pub source: &'static str,
}

impl Study {
    /// What the readings of the object say together; `None` of a pixel, or without a camera.
    pub(crate) fn object(&self, alternative: &Surface) -> Result<Option<ObjectAnswer>> {
        let Some(camera) = self.camera.as_ref().filter(|_| self.scenario.is_of_object()) else {
            return Ok(None);
        };
        let task = self.task(camera);
        let mut reach = Reach::new(self, alternative);
        let distance_bounds = reach.anew(&task.own())?;
        // Without the errors that readings share, which are no noise of one of them alone.
        let pixel = self.of_one_pixel();
        let once = Trial { camera: hadar::instrument::Camera { frames: 1, ..camera.clone() }, ..task.own() };
        let distance_of_one_bounds = Reach::new(&pixel, alternative).anew(&once)?;
        let endless = task.forward(Quantity::Frames, f64::from(u32::MAX));
        let ceiling_bounds = Some(reach.anew(&endless)?)
            .filter(|[_, found]| *found <= NO_CEILING * distance_bounds[1].max(f64::MIN_POSITIVE));
        let spec = self.errors_shared();
        let frames_worth = match ceiling_bounds {
            Some([_, found]) if found > 0.0 && spec.is_none() => {
                let most = hadar::policy::CameraTask { required: WORTH * found, ..task };
                most.solve(Quantity::Frames, |trial| reach.followed(trial))?.value
            }
            _ => None,
        };
        let ceiling_made_of = match ceiling_bounds {
            Some(_) => self.left_after(&endless, alternative, spec)?,
            None => Vec::new(),
        };
        let extent = self.extent(camera, task.distance_m);
        let [rows, columns] = extent.sides();
        let [one, all] = [distance_of_one_bounds[1], distance_bounds[1]];
        Ok(Some(ObjectAnswer {
            rows,
            columns,
            pixels: extent.pixels(),
            frames: camera.frames,
            distance_of_one_bounds,
            distance_bounds,
            effective_readings: if one > 0.0 { (all / one).powi(2) } else { 0.0 },
            ceiling_bounds,
            ceiling_made_of,
            frames_worth,
            emissivity_error: spec.map(|spec| spec.emissivity_error),
        }))
    }

    /// The distance over the number of readings, against an alternative; `None` of a pixel, or without a camera.
    ///
    /// # Errors
    /// As [`Study::size`].
    pub fn object_curve(&self, alternative: &Surface) -> Result<Option<ObjectCurve>> {
        let Some(camera) = self.camera.as_ref().filter(|_| self.scenario.is_of_object()) else {
            return Ok(None);
        };
        let (task, pixel) = (self.task(camera), self.of_one_pixel());
        let pixels = self.extent(camera, task.distance_m).pixels();
        let points = if self.errors_shared().is_some() { POINTS_WITH_ERRORS } else { POINTS };
        let steps = (0..points).map(|i| MOST_FRAMES.powf(i as f64 / (points - 1) as f64).round());
        let frames: Vec<f64> = steps.collect();
        let along = |study: &Self| -> Result<Vec<f64>> {
            let mut reach = Reach::new(study, alternative);
            frames.iter().map(|frames| reach.followed(&task.forward(Quantity::Frames, *frames))).collect()
        };
        let (of_object, of_pixel) = (along(self)?, along(&pixel)?);
        let readings: Vec<f64> = frames.iter().map(|frames| pixels * frames).collect();
        let independent = readings.iter().map(|n| of_pixel[0] * n.sqrt()).collect();
        Ok(Some(ObjectCurve { frames, readings, of_object, of_pixel, independent }))
    }

    /// The same question of one pixel.
    fn of_one_pixel(&self) -> Self {
        let mut pixel = self.clone();
        pixel.scenario.requirement.of = Some(Scope::Pixel);
        pixel
    }

    /// Shares of the variance of a trial, mean over the bands.
    fn left_after(
        &self,
        trial: &Trial,
        alternative: &Surface,
        spec: Option<SensitivitySpec>,
    ) -> Result<Vec<CeilingShare>> {
        let (camera, bands) = (&trial.camera, &self.bands);
        let lines = camera.noise_budget(bands, &self.target_signal(), &self.view_of(camera));
        let mut left: Vec<CeilingShare> = lines
            .into_iter()
            .map(|line| CeilingShare { label: line.label, share: line.var_counts, source: line.source })
            .collect();
        if let Some(spec) = spec {
            let var = self.var_of_errors(camera, alternative, spec)?;
            let (label, source) = (EMISSIVITY_ERRORS, "sensitivity.emissivity_error");
            left.push(CeilingShare { label, share: var, source });
        }
        let all: f64 = left.iter().map(|line| line.share).sum();
        left.iter_mut().for_each(|line| line.share /= all);
        left.retain(|line| line.share >= NAMED);
        left.sort_by(|a, b| b.share.total_cmp(&a.share));
        Ok(left)
    }
}
